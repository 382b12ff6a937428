//! Composite mean value maps between planar domains.

mod bound;
mod chart;
mod evaluate;
mod number;
#[cfg(test)]
mod tests;
mod triangulation;

pub use bound::{JacobianLimits, JacobianVerdict, bound_jacobian};
pub use evaluate::Jacobian;
pub use triangulation::{TriangulationError, check_triangles, triangulate};
