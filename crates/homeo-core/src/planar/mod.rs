//! Planar domains: what a simple polygon bounds, with or without holes.
//!
//! A [`PlanarDomain`] that exists is valid: its rings are simple and apart from one another, decided exactly on the
//! stored coordinates; the outer ring runs counter-clockwise and those of the holes clockwise, so that the domain is to
//! the left of every edge.

mod domain;
mod meeting;
mod read;
mod svg;

pub use domain::{DomainError, PlanarDomain, turn};
pub use meeting::{EdgeId, meeting_edges};
pub use read::{DomainPair, PairError, PolygonFileError, RingPair, read_pair, read_rings};
pub use svg::read_svg;

/// A point of the plane.
pub type Point2 = [f64; 2];
