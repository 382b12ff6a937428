//! From many tetrahedra to few: meshes to truncated tetrahedra.
//!
//! A mesh of a solid becomes a triangulation whose vertices are all truncated: [`coned`] adds a vertex over each boundary
//! component, [`without_inner_vertices`] collapses edges until no other vertex is left, and [`Simplifier`] takes away tetrahedra by
//! moves. Source: Yin 2010, section 4.2.2, which merges vertices before the coning as well; with the cones first there is no
//! boundary in any later step.

mod collapse;
mod cone;
mod editor;
mod flips;
mod moves;
mod search;

pub use cone::coned;
pub use flips::flips;
pub use search::{Simplifier, without_inner_vertices};

use crate::triangulation::GluingError;
use thiserror::Error;

/// Why a triangulation cannot be simplified.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum SimplifyError {
    #[error("face {face} of tetrahedron {tetrahedron} is not glued: cone the boundary first")]
    Open { tetrahedron: u32, face: u8 },
    #[error("edge {edge} of tetrahedron {tetrahedron} is glued to itself end for end: this is no manifold")]
    Reversed { tetrahedron: u32, edge: usize },
    #[error("{left} vertices inside cannot be collapsed: the moves do not find a way")]
    Stuck { left: usize },
    #[error(transparent)]
    Gluing(#[from] GluingError),
}
