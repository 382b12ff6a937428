//! Circle bundles over triangulated surfaces, the unit tangent bundle first of all.
//!
//! | type | what it is |
//! |---|---|
//! | [`Walls`], [`cutting_pattern`] | which triangles meet, and how the prisms over them fall into tetrahedra |
//! | [`CircleBundle`] | a bundle with regular structure, its tetrahedra and its Euler number |
//! | [`TangentBundle`] | that of the unit tangent vectors of a closed surface |
//! | [`Section`] | one level over each vertex; that of a field of vectors; indices, and paths in the bundle |
//! | [`MiddleSurface`] | the surface over which a field with a vector for each triangle is a section |
//! | [`WoundPaths`] | indices once more, from tetrahedra and paths alone |
//!
//! Source: Yin 2010, chapters 5 to 7. Theory: `docs/theory/bundles.md`.

mod charts;
mod circle;
mod cutting;
mod field;
mod identification;
mod middles;
mod polar;
mod refine;
mod section;
#[cfg(test)]
mod surfaces;
mod tangent;
#[cfg(test)]
mod tests;
mod vector;
mod walls;

pub use circle::{BundleError, CircleBundle};
pub use cutting::{Diagonal, Obstruction, cutting_pattern};
pub use middles::MiddleSurface;
pub use refine::Carrier;
pub use section::{PathFault, Section, SectionError, WoundPaths};
pub use tangent::TangentBundle;
pub use walls::{Side, WallError, Walls};
