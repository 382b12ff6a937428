//! Hyperbolic structures with geodesic boundary: every tetrahedron a truncated one in hyperbolic space.
//!
//! | what | where |
//! |---|---|
//! | [`Tetrahedron`], [`Volumes`] | one tetrahedron: angles, their slopes, volume |
//! | [`solve`](solve()), [`flow`] | lengths for which angles add up to 2π round every edge, in floating point |
//! | [`Structure`], [`prove`] | the same with a proof, in enclosures ([`Enclosure`]) |
//! | [`find_by_retriangulating`] | the same for a manifold, by triangulations of it that have one |
//! | [`NoMetric`], [`Obstruction`] | why there is none, with a proof where there is one |
//! | [`find_canonical`], [`is_canonical`], [`tilt_sums`] | the triangulation that a manifold has by its geometry alone |
//! | [`Embedding`], [`minkowski`] | fundamental domain and universal cover in hyperbolic space |
//!
//! Source: Yin 2010, sections 4.3 and 4.4. Theorems and proofs: `docs/theory/hyperbolic.md`; for users:
//! `docs/methods/hyperbolic.md`.

mod canonical;
mod clausen;
mod dense;
mod embedding;
mod enclosure;
mod equations;
pub mod minkowski;
mod obstruction;
mod program;
mod proof;
mod refusal;
mod retriangulate;
mod solve;
#[cfg(test)]
pub(crate) mod testing;
mod tetrahedron;
mod volume;

pub use canonical::{Canonical, NotCanonical, find_canonical, is_canonical, tilt_sums};
pub use embedding::{Embedding, Patches, Piece, SidePairing};
pub use enclosure::{Enclosure, Real};
pub use obstruction::Obstruction;
pub use proof::{Structure, prove};
pub use refusal::NoMetric;
pub use retriangulate::{Retriangulated, find_by_retriangulating};
pub use solve::{Approximation, Method, flow, solve};
pub use tetrahedron::Tetrahedron;
pub use volume::Volumes;
