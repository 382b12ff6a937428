//! Which point and which part of the source each element of the section is.

use std::collections::{BTreeMap, BTreeSet};

use homeo_core::number::Rational;

use crate::input::SourceMesh;
use crate::map::Shell;
use crate::overlay::{Cell, for_each_cell};
use crate::progress::Progress;

/// A point of the source: a triangle, and the weights of its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct At {
    pub triangle: u32,
    pub weights: [f64; 3],
}

impl At {
    /// The corner that the point is, if it is one.
    pub fn corner(&self) -> Option<usize> {
        self.weights.iter().position(|&weight| weight == 1.0)
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

/// See the module's documentation. Places and areas were exact before they were rounded.
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
        let mut shares: Vec<BTreeMap<u32, [Rational; 2]>> = vec![BTreeMap::new(); count];
        let (mut corners, mut crossed) = (vec![[None; 3]; count], vec![BTreeSet::new(); count]);
        let is_complete = for_each_cell(shell, progress, |cell| {
            let triangle = cell.section as usize;
            let parts = shares[triangle].entry(cell.source).or_insert([Rational::ZERO, Rational::ZERO]);
            *parts = [&parts[0] + &cell.share_of_source(), &parts[1] + &cell.share_of_section()];
            corners_in(&cell, &mut corners[triangle]);
            crossed[triangle].extend(sides_inside(&cell));
        });
        let part = |(source, [of_source, of_section]): (u32, [Rational; 2])| Part {
            source,
            of_source: of_source.to_f64(),
            of_section: of_section.to_f64(),
        };
        let parts = shares.into_iter().map(|parts| parts.into_iter().map(part).collect()).collect();
        is_complete.then_some(Self { source: shell.source(), section, corners, parts, crossed })
    }
}

/// Notes where corners of the section's triangle are.
fn corners_in(cell: &Cell, found: &mut [Option<At>; 3]) {
    for corner in &cell.corners {
        let Some(k) = corner.on_section.iter().position(|weight| *weight == Rational::ONE) else { continue };
        let here = At { triangle: cell.source, weights: corner.on_source.each_ref().map(Rational::to_f64) };
        // A triangle of which the corner is a corner comes first: its value needs no rounding.
        if found[k].is_none_or(|before: At| before.corner().is_none() && here.corner().is_some()) {
            found[k] = Some(here);
        }
    }
}

/// The sides of a cell that lie on an edge of the source, and not on one of the section.
fn sides_inside(cell: &Cell) -> impl Iterator<Item = Side> + '_ {
    let count = cell.corners.len();
    (0..count).filter_map(move |k| {
        let ends = [&cell.corners[k], &cell.corners[(k + 1) % count]];
        let common = |weights: [&[Rational; 3]; 2]| (0..3).find(|&i| weights.iter().all(|w| w[i].is_zero()));
        let on_section = common(ends.map(|end| &end.on_section));
        let opposite = common(ends.map(|end| &end.on_source))?;
        on_section.is_none().then_some((cell.source, opposite))
    })
}
