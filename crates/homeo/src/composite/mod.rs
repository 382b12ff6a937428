//! Composite mean value maps between planar domains.

mod bound;
mod chart;
mod evaluate;
mod invert;
mod map;
mod number;
mod partition;
#[cfg(test)]
mod tests;
mod triangulation;

pub use bound::{JacobianLimits, JacobianVerdict, bound_jacobian};
pub use evaluate::Jacobian;
pub use invert::InverseError;
pub use map::{CompositeError, CompositeInfo, CompositeMap, EnclosedPoint};
pub use partition::{LinearPath, PartitionError, PartitionParams, VertexPath};
pub use triangulation::{TriangulationError, check_triangles, triangulate};
