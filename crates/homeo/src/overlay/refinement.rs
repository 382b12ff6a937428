//! The common refinement as two meshes with one connectivity.

use std::collections::HashMap;

use homeo_core::number::{Interval, Lazy, Rational};
use rayon::prelude::*;

use super::names::Name;
use super::patch::{Border, Patch, PatchVertex};
use super::rounding::{Rounding, combined, corners_of_section, exactly, has_same_side};
use super::{CHUNK, Cell, cells_of};
use crate::map::{Shell, SurfacePoint};
use crate::progress::Progress;

type Point = [f64; 3];

/// How far a position may be from the exact one, as a part of the size of the source's coordinates: what is less certain is
/// computed exactly, which takes most of the time where it happens often.
const ACCURACY: f64 = 1e-10;

/// The map from source to section, or to the middle surface where the shell has no other section, as two meshes with the
/// same triangles: it is affine on each of them.
///
/// The triangles are those of the exact places, of which [`for_each_exact`](Self::for_each_exact) gives all numbers: a
/// manifold, homeomorphic to the source, in which each triangle lies in one triangle of the source and in one of the
/// section, with their orientation. The positions kept here are rounded (vertices of either surface are kept bit for bit), and a triangle that is smaller than the last
/// digits may be flat in them or turned over; [`rounded_over`](Self::rounded_over) counts these.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Refinement {
    /// Places of the vertices on the source, `#V by 3`.
    pub source: Vec<Point>,
    /// Places of the vertices on the section, `#V by 3`.
    pub section: Vec<Point>,
    /// Places of the vertices on the middle surface, `#V by 3`.
    pub middle: Vec<Point>,
    /// Corners of the triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Of each triangle, the one of the source and the one of the section that it lies in.
    pub parents: Vec<[u32; 2]>,
    /// Of each triangle, the prism that it lies in; ascending.
    pub prisms: Vec<u32>,
    /// Where each vertex was first seen; ascending.
    seen_at: Vec<Seen>,
}

/// A corner of a cell of a prism.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    prism: u32,
    cell: u32,
    corner: u32,
}

/// A vertex of a refinement, without any error.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactVertex {
    /// Its number.
    pub vertex: u32,
    /// A prism that it lies in.
    pub prism: u32,
    /// The weights of the prism's columns.
    pub weights: [Rational; 3],
    /// Its place on the source, in one of the triangles there.
    pub on_source: SurfacePoint<Rational>,
    /// Its place on the section, in one of the triangles there.
    pub on_section: SurfacePoint<Rational>,
}

/// The common refinement of source and section as two meshes with one connectivity; `None` when stopped.
///
/// Which corners of cells are the same vertex is decided by what they are, and otherwise by exact numbers; cells are cut into
/// triangles from one of their corners. Pieces of either surface meet edge to edge, so cells do (see
/// `docs/theory/shells.md`), and no vertex lies inside an edge.
///
/// ```
/// # use homeo::{construct::shell::{ShellParams, build}, input::SourceMesh, overlay::refinement, progress::Silent};
/// # use homeo_core::mesh::SimplicialComplex;
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let surface = SourceMesh::new(corners, SimplicialComplex::from_indices(4, &triangles).unwrap());
/// let (shell, _) = build(&surface, &ShellParams { rounds: 0, ..ShellParams::default() }, &Silent).unwrap();
/// let refined = refinement(&shell, &Silent).unwrap();
/// assert_eq!((refined.source.len(), refined.triangles.len()), (4, 4), "the first middle surface is the source");
/// assert_eq!(refined.source, refined.section);
/// assert_eq!(refined.rounded_over(&shell), [0, 0]);
/// ```
///
/// # Complexity
/// About linear in the cells. Prisms are worked on in parallel and joined in order, so the result does not depend on the
/// number of threads.
pub fn refinement(shell: &Shell, progress: &(dyn Progress + Sync)) -> Option<Refinement> {
    rounded_to(ACCURACY, shell, progress)
}

/// The same, with positions that are as near to the exact ones as wanted, as a part of the size of coordinates.
pub(crate) fn rounded_to(accuracy: f64, shell: &Shell, progress: &(dyn Progress + Sync)) -> Option<Refinement> {
    let count = shell.parts().prisms.len() as u32;
    let rounding = Rounding::new(shell, accuracy);
    let mut joined = Joined::default();
    for begin in (0..count).step_by(CHUNK as usize) {
        if progress.is_cancelled() {
            return None;
        }
        let prisms: Vec<u32> = (begin..count.min(begin + CHUNK)).collect();
        let patch = |&prism: &u32| Patch::new(shell, prism, &cells_of(shell, prism), &rounding);
        let patches: Vec<Patch> = prisms.par_iter().map(patch).collect();
        prisms.into_iter().zip(patches).for_each(|(prism, patch)| joined.add(prism, patch));
    }
    Some(joined.refinement)
}

/// The patches so far, joined along the edges of the middle surface.
#[derive(Default)]
struct Joined {
    refinement: Refinement,
    columns: HashMap<u32, u32>,
    /// Edges of which one prism has come.
    sides: HashMap<[u32; 2], Side>,
}

/// The vertices inside an edge of the middle surface.
#[derive(Default)]
struct Side {
    named: HashMap<Name, u32>,
    placed: Vec<(Lazy, u32)>,
}

impl Side {
    fn find(&self, names: &[Name], weight: &Lazy) -> Option<u32> {
        let meets = |a: Interval, b: Interval| a.low() <= b.high() && b.low() <= a.high();
        let is_there = |(other, _): &&(Lazy, u32)| meets(other.interval(), weight.interval()) && other == weight;
        let named = names.iter().find_map(|name| self.named.get(name).copied());
        named.or_else(|| self.placed.iter().find(is_there).map(|(_, vertex)| *vertex))
    }

    fn add(&mut self, names: &[Name], weight: Lazy, vertex: u32) {
        // A crossing has its name in one prism only.
        let lasting = names.iter().filter(|name| !matches!(name, Name::Crossing(..)));
        self.named.extend(lasting.map(|name| (*name, vertex)));
        self.placed.push((weight, vertex));
    }
}

impl Joined {
    fn add(&mut self, prism: u32, patch: Patch) {
        let Patch { columns: [a, b, c], vertices, triangles, parents } = patch;
        let ends = [[a, b], [b, c], [c, a]].map(|[i, j]| [i.min(j), i.max(j)]);
        let known = ends.map(|ends| self.sides.remove(&ends));
        let mut numbers = Vec::with_capacity(vertices.len());
        for vertex in vertices {
            let met = match &vertex.border {
                Border::Inside => None,
                Border::Column(column) => self.columns.get(column).copied(),
                Border::Side(side, weight) => {
                    let known = ends.iter().position(|other| other == side).and_then(|k| known[k].as_ref());
                    known.and_then(|known| known.find(&vertex.names, weight))
                }
            };
            numbers.push(met.unwrap_or_else(|| self.new_vertex(prism, vertex)));
        }
        let refinement = &mut self.refinement;
        refinement.triangles.extend(triangles.into_iter().map(|corners| corners.map(|v| numbers[v as usize])));
        refinement.prisms.extend(std::iter::repeat_n(prism, parents.len()));
        refinement.parents.extend(parents);
        // The second prism at an edge is the last one.
        for ends in ends.iter().zip(&known).filter(|(_, known)| known.is_some()).map(|(ends, _)| ends) {
            self.sides.remove(ends);
        }
    }

    fn new_vertex(&mut self, prism: u32, vertex: PatchVertex) -> u32 {
        let number = self.refinement.source.len() as u32;
        self.refinement.source.push(vertex.on_source);
        self.refinement.section.push(vertex.on_section);
        self.refinement.middle.push(vertex.on_middle);
        let [cell, corner] = vertex.seen_at;
        self.refinement.seen_at.push(Seen { prism, cell, corner });
        match vertex.border {
            Border::Inside => {}
            Border::Column(column) => _ = self.columns.insert(column, number),
            Border::Side(ends, weight) => self.sides.entry(ends).or_default().add(&vertex.names, weight, number),
        }
        number
    }
}

impl Refinement {
    /// How many triangles are flat or turned over on the source, and on the section, because positions are rounded: those
    /// whose normal does not point to the same side as that of the triangle in which they lie. Decided exactly.
    pub fn rounded_over(&self, shell: &Shell) -> [usize; 2] {
        let of_section = |parent| corners_of_section(shell, shell.section.as_ref(), parent);
        [
            self.turned_over(&self.source, 0, |parent| shell.source.corners(parent)),
            self.turned_over(&self.section, 1, of_section),
        ]
    }

    fn turned_over(&self, places: &[Point], surface: usize, parent: impl Fn(u32) -> [Point; 3] + Sync) -> usize {
        let is_over = |(corners, parents): (&[u32; 3], &[u32; 2])| {
            !has_same_side(corners.map(|v| places[v as usize]), parent(parents[surface]))
        };
        self.triangles.par_iter().zip(&self.parents).map(is_over).filter(|is_over| *is_over).count()
    }

    /// Hands over all vertices in rationals, in their order. Ends early when `progress` says so; the answer tells whether all
    /// were handed over.
    ///
    /// They are computed anew from the shell, which must be the one that the refinement is of: kept, they would take some
    /// hundred times the memory of the meshes.
    ///
    /// # Complexity
    /// Linear, but rationals take some ten times as long as the refinement itself.
    pub fn for_each_exact(
        &self,
        shell: &Shell,
        progress: &(dyn Progress + Sync),
        mut visit: impl FnMut(ExactVertex),
    ) -> bool {
        let runs: Vec<&[Seen]> = self.seen_at.chunk_by(|a, b| a.prism == b.prism).collect();
        let mut vertex = 0;
        for chunk in runs.chunks(CHUNK as usize) {
            if progress.is_cancelled() {
                return false;
            }
            let exact: Vec<Vec<ExactVertex>> = chunk.par_iter().map(|run| exact_vertices(shell, run)).collect();
            for made in exact.into_iter().flatten() {
                visit(ExactVertex { vertex, ..made });
                vertex += 1;
            }
        }
        true
    }
}

/// Some vertices of a prism; their numbers are left open.
fn exact_vertices(shell: &Shell, run: &[Seen]) -> Vec<ExactVertex> {
    let Some(Seen { prism, .. }) = run.first().copied() else { return Vec::new() };
    let cells = cells_of(shell, prism);
    run.iter().map(|seen| exact_vertex(shell, &cells[seen.cell as usize], seen.corner as usize)).collect()
}

fn exact_vertex(shell: &Shell, cell: &Cell, corner: usize) -> ExactVertex {
    let place = &cell.corners[corner];
    let on = |triangle: u32, corners: [Point; 3], weights: [Rational; 3]| {
        let point = std::array::from_fn(|axis| combined(&weights, corners, axis));
        SurfacePoint { triangle, weights, point }
    };
    let of_section = corners_of_section(shell, shell.section.as_ref(), cell.section);
    ExactVertex {
        vertex: 0,
        prism: cell.prism,
        weights: exactly(place),
        on_source: on(cell.source, shell.source.corners(cell.source), exactly(&cell.on_source(place))),
        on_section: on(cell.section, of_section, exactly(&cell.on_section(place))),
    }
}
