//! Composite mean value maps between planar domains, with a proof that they are one-to-one.
//!
//! Theorem:     rings of two domains correspond, and the Jacobian determinant of the mean value map is positive in the open
//!              domain => it is a homeomorphism of the closed domains, linear on every edge; so are compositions.
//! Source:      Schneider 2017, chapter 4, algorithm 1; Hormann, Floater 2006 (doi 10.1145/1183287.1183295) for mean value
//!              coordinates of domains with holes.
//! Differences: the determinant is proved to be positive up to vertices and edges, where the source samples it; nothing is
//!              asked at vertices; domains may have holes; the inverse is the exact one, enclosed.
//! Arithmetic:  domains and triangles are decided exactly; the determinant is bounded in affine forms, rounded outwards; what
//!              guides the search is rounded and decides nothing.
//! Cost:        for each step boxes times vertices; boxes are about a hundred for each vertex.
//! Fails when:  an intermediate polygon is not simple, or a step is not proved within its limits -> [`PartitionError`].
//! See:         `docs/theory/composite.md`.

mod bound;
pub(crate) mod chart;
mod evaluate;
pub(crate) mod frame;
pub(crate) mod guide;
pub(crate) mod invert;
pub(crate) mod line;
mod map;
pub(crate) mod number;
mod partition;
#[cfg(test)]
mod tests;
mod track;
mod triangulation;
mod vector;

pub use bound::{JacobianLimits, JacobianVerdict, bound_jacobian};
pub use evaluate::Jacobian;
pub use invert::InverseError;
pub use map::{CompositeError, CompositeInfo, CompositeMap, CompositePartsError};
pub use partition::{PartitionError, PartitionParams};
pub use triangulation::{Tiling, TriangulationError, check_tiling, triangulate};
