//! Circle bundles over triangulated surfaces, the unit tangent bundle first of all.

mod charts;
mod circle;
mod cutting;
#[cfg(test)]
mod surfaces;
mod walls;

pub use circle::{BundleError, CircleBundle};
pub use cutting::{Diagonal, Obstruction, cutting_pattern};
pub use walls::{Side, WallError, Walls};
