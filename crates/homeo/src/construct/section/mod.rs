//! Sections: other surfaces in the shell of a surface, by simplification and remeshing.
//!
//! Theorem:     a surface `S` that satisfies L1 and L3 to L6 in the place of the source is mapped onto the middle surface,
//!              and so onto the source, by the projection along pillars: a homeomorphism.
//! Source:      Jiang, Schneider, Zorin, Panozzo 2020 (doi 10.1145/3414685.3417769), section 4; Garland, Heckbert 1997
//!              (doi 10.1145/258734.258849) for the order of collapses; Botsch, Kobbelt 2004
//!              (doi 10.1145/1057432.1057457) for remeshing.
//! Differences: every operation is checked against the shell exactly; edges of the boundary and vertices at pinched
//!              columns stay as they are; texture coordinates are carried along.
//! Arithmetic:  every accepted operation is decided by exact signs; errors, lengths and shapes only guide.
//! Cost:        proportional to the operations tried, times the prisms that a triangle meets.
//! Fails when:  the surface to begin with is no section of the shell -> [`SectionError`].
//! See:         `docs/theory/shells.md`.
//!
//! # Why every operation leaves a section
//!
//! It begins with a section, mostly the source itself. An operation takes some triangles away and puts others in their
//! place, with the same outer edges.
//!
//! * **L1** by the link condition; and triangles without an area are refused. Boundary edges never change.
//! * **L3, L4** speak of one triangle and one prism at a time. All new triangles are checked against all prisms whose boxes
//!   they meet; the others were checked when they were made.
//! * **L5.** The number of preimages of a point under the shell's map `phi`, counted with local degrees, is constant on
//!   connected sets that avoid `phi(boundary)`, and it is 1 on the surface before. By L3 the new triangles avoid it, too
//!   (but in points of pinched columns and of boundary edges, without which they are still connected), and they have
//!   vertices or edges in common with what is left of the old surface. So it is 1 on them.
//! * **L6.** The degree of the projection from the surface to the middle surface is the number of times that it meets a
//!   fibre. A fibre which meets neither the old triangles nor the new ones is met as often as before. There is one unless
//!   the few triangles of one operation cover a whole component between them.
//!
//! None of this is believed afterwards: the checker establishes L1 to L6 again on the finished surface, from
//! `Shell::from_parts(section, shell.parts().clone())`.
//!
//! # Texture
//!
//! Every triangle that is made keeps, exactly, the orientation that most triangles of its chart have, and the boundaries
//! of charts only take short cuts that nothing lies in. Together that excludes new overlap; the proof is in
//! `section/outline.rs`. Vertices that move get their coordinates from the texture to begin with, by the map through the
//! shell.

mod atlas;
mod editor;
mod loosen;
mod operations;
mod outline;
mod quadric;
mod remesh;
mod shape;
mod shells;
mod simplify;
mod sizing;
mod stage;
mod surface;

pub use remesh::{RemeshInfo, RemeshParams, remesh};
pub use shells::{Attempt, InShellError, Outcome, SimplifiedInShell, shells_in_turn, simplify_in_shells};
pub use simplify::{SimplifyEnd, SimplifyInfo, SimplifyParams, simplify};
pub use sizing::lengths_by_curvature;

use rayon::prelude::*;

use crate::construct::shell::prism::sides;
use crate::input::SourceMesh;
use crate::map::Shell;
use stage::{Stage, key};
use surface::Surface;

/// Texture coordinates of the corners of triangles.
///
/// An edge whose two triangles use different coordinates at one of its ends is a seam; what seams and boundary edges
/// enclose is a chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Texture {
    /// Coordinates, `#U by 2`.
    pub coordinates: Vec<[f64; 2]>,
    /// For each corner of each triangle an index into the coordinates, `#T by 3`.
    pub corners: Vec<[u32; 3]>,
}

/// A surface, perhaps with texture coordinates.
#[derive(Clone, Debug)]
pub struct TexturedSurface {
    /// The triangles in space.
    pub surface: SourceMesh<3>,
    /// Their texture.
    pub texture: Option<Texture>,
}

impl From<SourceMesh<3>> for TexturedSurface {
    fn from(surface: SourceMesh<3>) -> Self {
        Self { surface, texture: None }
    }
}

/// Why a triangle cannot be part of a section.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// Its area is zero, or a coordinate is not a finite number.
    #[error("it has no area")]
    NoArea,
    /// It meets the top or the bottom of the shell (L3).
    #[error("it meets the top or the bottom of the shell")]
    Cap,
    /// It meets the walls over the boundary, or lies beyond them at the boundary (L3).
    #[error("it meets the walls of the shell")]
    Wall,
    /// A pillar does not cross it from below (L4).
    #[error("a pillar of the shell does not cross it from below")]
    Crossing,
}

/// Why no section was made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SectionError {
    /// The triangles round a vertex form no circle or path.
    #[error("the triangles at vertex {vertex} do not form an oriented surface")]
    NotASurface {
        /// A vertex of the surface to begin with.
        vertex: u32,
    },
    /// The boundary of the surface is not that of the shell's middle surface.
    #[error("the boundary of the surface is not that of the shell's middle surface")]
    Boundary,
    /// A triangle cannot be part of a section.
    #[error("triangle {triangle} does not lie well in the shell: {fault}")]
    NotASection {
        /// A triangle of the surface to begin with.
        triangle: u32,
        /// What is wrong with it.
        fault: Fault,
    },
    /// The texture does not fit the triangles.
    #[error("the texture does not fit the triangles: {0}")]
    Texture(&'static str),
    /// A parameter is out of range.
    #[error("{0}")]
    Parameter(&'static str),
}

/// How many operations were refused, by the first reason that was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Refusals {
    /// The result would be no surface.
    pub links: usize,
    /// A triangle would be too thin, or turn too far.
    pub shape: usize,
    /// A triangle would not be part of a section (L3, L4).
    pub shell: usize,
    /// A triangle would be turned over in the texture, or charts might overlap.
    pub texture: usize,
}

impl Refusals {
    /// All of them.
    pub fn total(&self) -> usize {
        self.links + self.shape + self.shell + self.texture
    }
}

/// Checks of a surface what can be checked triangle by triangle for it to be a section: L1, L3 and L4.
///
/// # Guarantee
/// Exact. A surface that passes is a section if L5 and L6 hold, too, which the checker `homeo-verify` decides for
/// `Shell::from_parts(surface, shell.parts().clone())`; for surfaces made by [`simplify`] and [`remesh`] they do.
///
/// # Errors
/// The first thing that is wrong.
///
/// # Complexity
/// Proportional to the pairs, of a triangle and a prism, whose boxes meet.
pub fn check(shell: &Shell, surface: &SourceMesh<3>) -> Result<(), SectionError> {
    let start = TexturedSurface::from(surface.clone());
    check_start(&Stage::new(shell.parts()), &Surface::new(surface), &start, shell)
}

fn check_start(stage: &Stage, surface: &Surface, start: &TexturedSurface, shell: &Shell) -> Result<(), SectionError> {
    if let Some(vertex) = surface.singular_vertex() {
        return Err(SectionError::NotASurface { vertex });
    }
    let source_boundary = boundary(&surface.triangles, &surface.positions);
    if source_boundary != boundary(&shell.parts().prisms, &shell.parts().middle) {
        return Err(SectionError::Boundary);
    }
    if let Some(texture) = &start.texture {
        if texture.corners.len() != surface.triangles.len() {
            return Err(SectionError::Texture("there are not as many rows of corners as triangles"));
        }
        if texture.corners.iter().flatten().any(|&index| index as usize >= texture.coordinates.len()) {
            return Err(SectionError::Texture("a corner names coordinates that do not exist"));
        }
        if texture.coordinates.iter().flatten().any(|x| !x.is_finite()) {
            return Err(SectionError::Texture("a coordinate is not a finite number"));
        }
    }
    let fault = |triangle: u32| {
        let outcome = stage.check(surface.points(triangle));
        outcome.err().map(|fault| SectionError::NotASection { triangle, fault })
    };
    (0..surface.triangles.len() as u32).into_par_iter().find_map_first(fault).map_or(Ok(()), Err)
}

/// The boundary edges as pairs of points, in the triangles' direction, in order.
fn boundary(triangles: &[[u32; 3]], positions: &[[f64; 3]]) -> Vec<[[u64; 3]; 2]> {
    let directed: std::collections::HashSet<[u32; 2]> = triangles.iter().flat_map(|&t| sides(t)).collect();
    let alone = directed.iter().filter(|[a, b]| !directed.contains(&[*b, *a]));
    let mut edges: Vec<[[u64; 3]; 2]> = alone.map(|edge| edge.map(|v| key(positions[v as usize]))).collect();
    edges.sort_unstable();
    edges
}
