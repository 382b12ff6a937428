//! Boxes in space and a tree over them.
//!
//! Boxes hold `f64` bounds exactly (no rounding happens when points are enclosed), so what a query
//! leaves out is certainly apart, and what it visits is a candidate for an exact test.

mod aabb;
mod curve;
mod tree;

pub use aabb::Aabb;
pub use curve::{cells_along_curve, curve_order};
pub use tree::Tree;
