//! Circle bundles over triangulated surfaces, the unit tangent bundle first of all.

mod cutting;
mod walls;

pub use cutting::{Diagonal, Obstruction, cutting_pattern};
pub use walls::{Side, WallError, Walls};
