//! Which point and which part of the source each element of the section is.

use std::collections::{BTreeMap, BTreeSet};

use homeo_core::mesh::VertexId;
use homeo_core::number::{Interval, Scalar};
use homeo_core::predicate::Sign;
use rayon::prelude::*;

use crate::input::SourceMesh;
use crate::map::{Shell, SurfacePoint};
use crate::overlay::{Cell, for_each_cell};
use crate::progress::Progress;

/// A point of the source: a triangle, and the weights of its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct At {
    pub triangle: u32,
    pub weights: [f64; 3],
}

impl At {
    /// The corner that the point is, if it is one. A weight that is only nearly 1 may be rounded to it; the others are then
    /// not zero.
    pub fn corner(&self) -> Option<usize> {
        (0..3).find(|&k| (0..3).all(|i| self.weights[i] == if i == k { 1.0 } else { 0.0 }))
    }

    /// The corner with the largest weight, the first of equals.
    pub fn nearest(&self) -> usize {
        (1..3).fold(0, |best, k| if self.weights[k] > self.weights[best] { k } else { best })
    }
}

/// A part of a triangle of the section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    /// The triangle of the source.
    pub source: u32,
    pub of_source: f64,
    pub of_section: f64,
}

/// An edge of the source: a triangle and the corner opposite to it.
pub(super) type Side = (u32, usize);

/// See the module's documentation. Where a sign decides, it was exact; places and areas are
/// rounded.
pub(super) struct Correspondence<'s> {
    pub source: &'s SourceMesh<3>,
    pub section: &'s SourceMesh<3>,
    /// Where the corners of each triangle of the section are on the source: seen from inside that triangle.
    pub corners: Vec<[Option<At>; 3]>,
    /// The parts of each triangle of the section, by source triangle.
    pub parts: Vec<Vec<Part>>,
    /// The edges of the source that go through the inside of each triangle of the section.
    pub crossed: Vec<BTreeSet<Side>>,
}

impl<'s> Correspondence<'s> {
    /// `None` when stopped.
    pub fn new(shell: &'s Shell, section: &'s SourceMesh<3>, progress: &(dyn Progress + Sync)) -> Option<Self> {
        let count = section.complex().cell_count();
        let mut shares: Vec<BTreeMap<u32, [f64; 2]>> = vec![BTreeMap::new(); count];
        let mut crossed = vec![BTreeSet::new(); count];
        let is_complete = for_each_cell(shell, progress, |cell| {
            let triangle = cell.section as usize;
            let parts = shares[triangle].entry(cell.source).or_insert([0.0; 2]);
            *parts = [parts[0] + cell.share_of_source().near(), parts[1] + cell.share_of_section().near()];
            crossed[triangle].extend(sides_inside(&cell));
        });
        if !is_complete {
            return None;
        }
        normalize(&mut shares, shell.source().complex().cell_count());
        let part = |(source, [of_source, of_section]): (u32, [f64; 2])| Part { source, of_source, of_section };
        let parts: Vec<Vec<Part>> = shares.into_iter().map(|parts| parts.into_iter().map(part).collect()).collect();
        let places: Vec<Option<SurfacePoint<Interval>>> =
            section.positions().par_iter().map(|&place| shell.on_source(place).ok()).collect();
        let source = shell.source();
        let corner = |t: usize, v: usize| seen_from_inside(source, places[v].as_ref()?, &parts[t]);
        let cells = section.complex().cells().iter().enumerate();
        let corners = cells.map(|(t, cell)| cell.map(|v| corner(t, v.index()))).collect();
        Some(Self { source, section, corners, parts, crossed })
    }
}

/// Divides rounded shares by their sums, which are exactly 1 before rounding: so nothing is lost or doubled in total.
fn normalize(shares: &mut [BTreeMap<u32, [f64; 2]>], source_count: usize) {
    let mut of_source = vec![0.0; source_count];
    shares.iter().flatten().for_each(|(&source, share)| of_source[source as usize] += share[0]);
    for parts in shares {
        let of_section: f64 = parts.values().map(|share| share[1]).sum();
        for (&source, share) in parts {
            *share = [share[0] / of_source[source as usize], share[1] / of_section];
        }
    }
}

/// A point of the source as one of a triangle that lies under a triangle of the section: one of several where the point
/// lies on an edge or is a vertex.
fn seen_from_inside(source: &SourceMesh<3>, at: &SurfacePoint<Interval>, parts: &[Part]) -> Option<At> {
    let cells = source.complex().cells();
    let is_held = |k: usize| at.weights[k].sign().is_none_or(|sign| sign != Sign::Zero);
    let held: Vec<(VertexId, f64)> =
        (0..3).filter(|&k| is_held(k)).map(|k| (cells[at.triangle as usize][k], at.weights[k].near())).collect();
    let has_all = |part: &&Part| held.iter().all(|(v, _)| cells[part.source as usize].contains(v));
    let triangle = parts.iter().find(has_all)?.source;
    let weight = |v: VertexId| held.iter().find(|(other, _)| *other == v).map_or(0.0, |(_, weight)| *weight);
    Some(At { triangle, weights: cells[triangle as usize].map(weight) })
}

/// The sides of a cell that lie on an edge of the source, and not on one of the section.
fn sides_inside(cell: &Cell) -> impl Iterator<Item = Side> + '_ {
    let inside = cell.sides.iter().filter(|side| side.of_section.is_none());
    inside.filter_map(|side| Some((cell.source, usize::from(side.of_source?))))
}
