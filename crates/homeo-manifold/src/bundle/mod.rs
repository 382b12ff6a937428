//! Circle bundles over triangulated surfaces, the unit tangent bundle first of all.
//!
//! | type | what it is |
//! |---|---|
//! | [`Walls`], [`cutting_pattern`] | which triangles meet, and how the prisms over them fall into tetrahedra |
//! | [`CircleBundle`] | a bundle with regular structure, its tetrahedra and its Euler number |
//! | [`TangentBundle`] | that of the unit tangent vectors of a closed surface |
//!
//! Source: Yin 2010, chapters 5 to 7.

mod charts;
mod circle;
mod cutting;
mod refine;
#[cfg(test)]
mod surfaces;
mod tangent;
mod walls;

pub use circle::{BundleError, CircleBundle};
pub use cutting::{Diagonal, Obstruction, cutting_pattern};
pub use refine::Carrier;
pub use tangent::TangentBundle;
pub use walls::{Side, WallError, Walls};
