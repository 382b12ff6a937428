//! The common refinement of two surfaces that a shell maps onto one another.
//!
//! Theorem:     the projections of both sections onto the middle surface are homeomorphisms, affine where a triangle lies
//!              in one tetrahedron of the shell. So the convex pieces `triangle x tetrahedron` of either section tile the
//!              middle surface, and so do the intersections of a piece of the one with a piece of the other, the *cells*.
//!              On a cell the map from source to section is affine.
//! Source:      Jiang, Schneider, Zorin, Panozzo 2020 (doi 10.1145/3414685.3417769), section 4 (transfer); the exact
//!              subdivision is ours.
//! Arithmetic:  exact; rationals are computed only where intervals leave a sign open.
//! Cost:        about linear in the cells; each takes some hundred operations on intervals. 64 prisms are held at a time.
//! Fails when:  the shell's certificate does not hold: then pieces overlap or leave gaps, and shares do not add up to 1.
//! See:         `docs/theory/shells.md`.

mod names;
mod patch;
mod pieces;
mod polygon;
mod refinement;
mod rounding;
mod shares;

use homeo_core::number::{Lazy, Scalar};
use rayon::prelude::*;

use crate::map::Shell;
use crate::progress::Progress;

use names::{Names, Side};
use pieces::{Piece, Role, pieces_in};
use polygon::{Corner, Place, Sides, doubled_area, turn};

pub(crate) use refinement::rounded_to;
pub use refinement::{ExactVertex, Refinement, refinement};
pub use shares::{Share, shares};

/// On which edges a side of a cell lies: the corner of the triangle that is opposite to the edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CellSide {
    /// Of the source's triangle.
    pub of_source: Option<u8>,
    /// Of the section's triangle.
    pub of_section: Option<u8>,
}

/// A convex polygon on which the map from the source to the section is affine.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// The prism.
    pub prism: u32,
    /// The triangle of the source.
    pub source: u32,
    /// The triangle of the section; the prism where the shell has no other section.
    pub section: u32,
    /// At least three corners, counter-clockwise, no three of them on a line. Each is given by the weights of the prism's
    /// columns.
    pub corners: Vec<[Lazy; 3]>,
    /// From each corner to the next one.
    pub sides: Vec<CellSide>,
    frame_of_source: [[Lazy; 3]; 3],
    frame_of_section: [[Lazy; 3]; 3],
    /// Of the corners.
    names: Vec<Names>,
}

impl Cell {
    /// The weights in the source's triangle of a place over the prism.
    pub fn on_source(&self, place: &[Lazy; 3]) -> [Lazy; 3] {
        weights_in(&self.frame_of_source, place)
    }

    /// The weights in the section's triangle of a place over the prism.
    pub fn on_section(&self, place: &[Lazy; 3]) -> [Lazy; 3] {
        weights_in(&self.frame_of_section, place)
    }

    /// Its area as a part of that of its triangle of the source.
    pub fn share_of_source(&self) -> Lazy {
        self.area().divide(&whole(&self.frame_of_source))
    }

    /// Its area as a part of that of its triangle of the section.
    pub fn share_of_section(&self) -> Lazy {
        self.area().divide(&whole(&self.frame_of_section))
    }

    fn area(&self) -> Lazy {
        doubled_area(&self.corners.iter().collect::<Vec<_>>())
    }
}

fn whole([a, b, c]: &[Place; 3]) -> Lazy {
    turn(a, b, c)
}

/// The weights of the corners of a triangle at a place.
fn weights_in([a, b, c]: &[Place; 3], place: &Place) -> [Lazy; 3] {
    let whole = turn(a, b, c);
    [turn(b, c, place), turn(c, a, place), turn(a, b, place)].map(|part| part.divide(&whole))
}

/// Prisms that are worked on before their cells are handed over.
const CHUNK: u32 = 64;

/// Hands over the cells of the common refinement, one prism after the other, in an order that does not depend on the number
/// of threads. Ends early when `progress` says so; the answer tells whether all were handed over.
///
/// ```
/// # use homeo::{construct::shell::{ShellParams, build}, input::SourceMesh, overlay::for_each_cell, progress::Silent};
/// # use homeo_core::mesh::SimplicialComplex;
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let surface = SourceMesh::new(corners, SimplicialComplex::from_indices(4, &triangles).unwrap());
/// let (shell, _) = build(&surface, &ShellParams { rounds: 0, ..ShellParams::default() }, &Silent).unwrap();
/// let mut count = 0;
/// assert!(for_each_cell(&shell, &Silent, |cell| {
///     assert_eq!(cell.source, cell.section, "the middle of the first shell is the source");
///     count += 1;
/// }));
/// assert_eq!(count, 4);
/// ```
pub fn for_each_cell(shell: &Shell, progress: &(dyn Progress + Sync), mut visit: impl FnMut(Cell)) -> bool {
    let count = shell.parts().prisms.len() as u32;
    for begin in (0..count).step_by(CHUNK as usize) {
        if progress.is_cancelled() {
            return false;
        }
        let prisms: Vec<u32> = (begin..count.min(begin + CHUNK)).collect();
        let cells: Vec<Vec<Cell>> = prisms.into_par_iter().map(|prism| cells_of(shell, prism)).collect();
        cells.into_iter().flatten().for_each(&mut visit);
    }
    true
}

/// The cells over one triangle of the middle surface.
fn cells_of(shell: &Shell, prism: u32) -> Vec<Cell> {
    let of_source = pieces_in(shell, &shell.source, Role::Source, prism);
    let of_section = match &shell.section {
        Some(section) => pieces_in(shell, section, Role::Section, prism),
        None => vec![Piece::whole_prism(prism, shell.parts().prisms[prism as usize])],
    };
    let mut cells = Vec::new();
    for piece in &of_source {
        for other in of_section.iter().filter(|other| piece.hull.meets(&other.hull)) {
            let corners = polygon::intersection(&piece.corners, &other.corners);
            if !corners.is_empty() {
                cells.push(joined(prism, piece, other, corners));
            }
        }
    }
    cells
}

fn joined(prism: u32, piece: &Piece, other: &Piece, corners: Vec<Corner<3>>) -> Cell {
    let edge = |side: Option<Side>| side.filter(|side| *side < 3);
    let sides = corners.iter().map(|corner| corner.side);
    let sides = sides
        .map(|Sides { of_source, of_section }| CellSide { of_source: edge(of_source), of_section: edge(of_section) });
    let known = (0..corners.len()).map(|k| {
        let before = corners[(k + corners.len() - 1) % corners.len()].side;
        recognized(piece, other, before, &corners[k])
    });
    let (names, at) = known.unzip();
    Cell {
        prism,
        source: piece.triangle,
        section: other.triangle,
        sides: sides.collect(),
        corners: at,
        frame_of_source: piece.frame.clone(),
        frame_of_section: other.frame.clone(),
        names,
    }
}

/// The names of a cell's corner, and its place by the shortest formula.
fn recognized(piece: &Piece, other: &Piece, before: Sides, corner: &Corner<3>) -> (Names, Place) {
    let [on_source, on_section] = [piece, other].map(|piece| piece.corner_between(before, corner.side));
    match Names::of_corner(on_source.map(|found| found.1), on_section.map(|found| found.1)) {
        Some(names) => {
            let known = on_source.or(on_section).map_or(corner, |found| found.0);
            (names, known.at.clone())
        }
        None => {
            let [source, section] = [piece, other].map(|piece| piece.line(before, corner.side));
            (Names::of_crossing(source, section), corner.at.clone())
        }
    }
}
