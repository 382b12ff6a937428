//! What a mesh is.
mod ball;
mod collapse;
mod connectivity;
mod gluing;
mod intersections;
mod links;
mod measure;
mod report;
mod shape;
mod surface;
#[cfg(test)]
mod tests;
mod violation;
mod volume;

pub use intersections::{SelfIntersections, self_intersections};
pub use report::*;
pub use surface::analyse_triangles;
pub use violation::{ElementKind, MOST_LISTED, Severity, Violation};
pub use volume::analyse_tetrahedra;
