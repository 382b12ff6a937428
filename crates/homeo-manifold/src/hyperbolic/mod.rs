//! Hyperbolic structures with geodesic boundary: every tetrahedron a truncated one in hyperbolic space.

mod clausen;
mod dense;
mod embedding;
mod enclosure;
mod equations;
pub mod minkowski;
mod obstruction;
mod proof;
mod refusal;
mod solve;
#[cfg(test)]
pub(crate) mod testing;
mod tetrahedron;
mod volume;

pub use embedding::{Embedding, Patches, Piece, SidePairing};
pub use enclosure::{Enclosure, Real};
pub use obstruction::Obstruction;
pub use proof::{Structure, prove};
pub use refusal::NoMetric;
pub use solve::{Approximation, Method, flow, solve};
pub use tetrahedron::Tetrahedron;
pub use volume::Volumes;
