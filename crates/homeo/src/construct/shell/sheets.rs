//! Which triangles belong to which prisms, where the surface may cross itself.
//!
//! A prism begins with the triangle over which it stands. Whatever goes on from there over an edge that meets the prism, or
//! through a wall into the next prism, belongs too: rules I3 and I4 of `docs/theory/shells.md`. Other sheets in the same
//! place do not, and are not looked at. Operations keep what belongs complete, or are refused.

use std::collections::HashSet;

use homeo_core::mesh::{Adjacency, CellId};
use rayon::prelude::*;

use super::ShellError;
use super::layer::{Contents, Layer};
use super::prism::{Failure, FailureIn, Prism, sides};
use crate::input::SourceMesh;

type Point = [f64; 3];

/// How the source's triangles are joined.
pub(super) struct Sheets {
    neighbours: Adjacency<3>,
}

impl Sheets {
    /// # Errors
    /// When more than two triangles share an edge.
    pub fn new(source: &SourceMesh<3>) -> Result<Self, ShellError> {
        let reason = "more than two triangles share an edge";
        let neighbours = source.complex().adjacency().map_err(|_| ShellError::Stuck { triangle: 0, reason })?;
        Ok(Self { neighbours })
    }

    /// The triangles beyond the edges of a triangle, each with the position of the corner opposite its edge.
    fn beyond(&self, triangle: u32) -> impl Iterator<Item = (usize, u32)> + '_ {
        let across = move |k| self.neighbours.across(CellId::from(triangle), k);
        (0..3).map(move |k| (k, across(k))).filter(|(_, facet)| facet.is_some()).map(|(k, f)| (k, f.cell().raw()))
    }
}

impl Layer {
    /// Like [`fill`](Self::fill): what belongs to the prisms, and L3 and L4 for that. Prisms beside them may come to hold
    /// more; they are checked too, and the order of those that fail is that of their numbers.
    pub fn fill_by_sheets(&mut self, prisms: &[u32], parents: &[u32]) -> Vec<(u32, FailureIn)> {
        let Some(sheets) = &self.sheets else { return Vec::new() };
        let first = |&prism: &u32| self.spread(sheets, prism, vec![parents[prism as usize]]);
        let found: Vec<Vec<u32>> = prisms.par_iter().map(first).collect();
        for (&prism, found) in prisms.iter().zip(found) {
            self.contents[prism as usize].triangles = found;
        }
        let mut filled = prisms.to_vec();
        filled.extend(self.exchange(prisms));
        filled.sort_unstable();
        filled.dedup();
        let checked: Vec<_> = filled.par_iter().map(|&prism| (prism, self.check_belonging(prism))).collect();
        let mut failures = Vec::new();
        for (prism, checked) in checked {
            match checked {
                Ok(cosine) => self.contents[prism as usize].cosine = cosine,
                Err(failure) => failures.push((prism, failure)),
            }
        }
        failures
    }

    /// All triangles that are joined to some of those that belong to a prism over edges that meet it, ascending.
    fn spread(&self, sheets: &Sheets, prism: u32, mut found: Vec<u32>) -> Vec<u32> {
        let corners = self.prisms[prism as usize];
        let body = self.prism(corners);
        let mut known: HashSet<u32> = found.iter().copied().collect();
        let mut next = 0;
        while next < found.len() {
            let triangle = found[next];
            for (k, other) in sheets.beyond(triangle) {
                if !known.contains(&other) && body.meets_segment(self.edge(triangle, k)) {
                    known.insert(other);
                    found.push(other);
                }
            }
            next += 1;
        }
        found.sort_unstable();
        found
    }

    /// The edge of a source triangle opposite one of its corners.
    fn edge(&self, triangle: u32, opposite: usize) -> [Point; 2] {
        let corners = self.surface.corners[triangle as usize];
        [corners[(opposite + 1) % 3], corners[(opposite + 2) % 3]]
    }

    /// Lets triangles through the walls of some prisms, both ways, and on from there. Returns the prisms that hold more.
    fn exchange(&mut self, prisms: &[u32]) -> HashSet<u32> {
        let mut changed = HashSet::new();
        let around = prisms.iter().flat_map(|&prism| self.prisms[prism as usize]);
        let mut waiting: Vec<u32> = around.flat_map(|column| self.around[column as usize].iter().copied()).collect();
        waiting.sort_unstable();
        waiting.dedup();
        while let Some(prism) = waiting.pop() {
            for k in 0..3 {
                let corners = self.prisms[prism as usize];
                let Some(other) = self.prism_beyond(corners, k, &[prism]) else { continue };
                let through =
                    self.missing_beyond(&self.prism(corners), k, &self.contents[prism as usize].triangles, other);
                let Some(sheets) = self.sheets.as_ref().filter(|_| !through.is_empty()) else { continue };
                let all = [through, self.contents[other as usize].triangles.clone()].concat();
                self.contents[other as usize].triangles = self.spread(sheets, other, all);
                changed.insert(other);
                waiting.push(other);
            }
        }
        changed
    }

    /// The prism beyond a side that is none of the given ones.
    fn prism_beyond(&self, corners: [u32; 3], k: usize, not: &[u32]) -> Option<u32> {
        let [a, b] = sides(corners)[k];
        let mut around = self.around[a as usize].iter().copied();
        around.find(|p| !not.contains(p) && sides(self.prisms[*p as usize]).contains(&[b, a]))
    }

    /// Those of some triangles that meet the walls over a side, but do not belong to the prism beyond.
    fn missing_beyond(&self, body: &Prism, k: usize, triangles: &[u32], other: u32) -> Vec<u32> {
        let others = &self.contents[other as usize].triangles;
        let is_missing = |t: &u32| others.binary_search(t).is_err();
        let goes_through = |t: &u32| body.meets_wall(k, self.surface.corners[*t as usize]);
        triangles.iter().copied().filter(|t| is_missing(t) && goes_through(t)).collect()
    }

    /// L3 and L4 for what belongs to a prism. Returns the least cosine between pillars and normals.
    pub fn check_belonging(&self, prism: u32) -> Result<f64, FailureIn> {
        let (corners, contents) = (self.prisms[prism as usize], &self.contents[prism as usize].triangles);
        let body = self.prism(corners);
        self.check_l3(&body, corners, Some(contents))?;
        self.surface.contents(&body, contents).map(|found| found.cosine)
    }

    /// Whether nothing is missing in a prism: rules I3 and I4.
    pub fn is_complete(&self, prism: u32) -> bool {
        let corners = self.prisms[prism as usize];
        self.check_complete(&self.prism(corners), corners, &self.contents[prism as usize].triangles, &[prism]).is_ok()
    }

    /// Those of some triangles that may belong to a prism instead of the prisms that held them, if they satisfy L4.
    pub fn belonging(&self, body: &Prism, held: &[u32]) -> Result<Contents, FailureIn> {
        let Contents { triangles, cosine } = self.surface.contents(body, held)?;
        // Those that merely touch it belong, too.
        let is_off = |t: &u32| body.is_clearly_off(&self.surface.corners[*t as usize]);
        let belongs = |t: &u32| triangles.binary_search(t).is_ok() || !is_off(t);
        Ok(Contents { triangles: held.iter().copied().filter(belongs).collect(), cosine })
    }

    /// L3 for prisms in the place of others, and whether what belongs to them is complete.
    pub fn check_replaced(
        &self,
        old: &[u32],
        bodies: &[Prism],
        new: &[[u32; 3]],
        contents: &[Contents],
    ) -> Result<(), FailureIn> {
        for ((body, &corners), contents) in bodies.iter().zip(new).zip(contents) {
            self.check_l3(body, corners, Some(&contents.triangles))?;
            self.check_complete(body, corners, &contents.triangles, old)?;
        }
        Ok(())
    }

    /// I4 for a prism, and I3 for its walls to prisms that are none of the given ones. (Between new prisms it holds: what
    /// meets a wall is off neither of the prisms beside it.)
    fn check_complete(&self, body: &Prism, corners: [u32; 3], contents: &[u32], not: &[u32]) -> Result<(), FailureIn> {
        let Some(sheets) = &self.sheets else { return Ok(()) };
        let is_met = |edge: [Point; 2]| !body.is_clearly_off(&edge) && body.meets_segment(edge);
        let is_missing = |t: u32| contents.binary_search(&t).is_err();
        let goes_on = |&t: &u32| sheets.beyond(t).any(|(k, other)| is_missing(other) && is_met(self.edge(t, k)));
        let goes_through = |k: usize| {
            let beyond = self.prism_beyond(corners, k, not);
            beyond.is_some_and(|other| !self.missing_beyond(body, k, contents, other).is_empty())
        };
        let is_complete = !contents.iter().any(goes_on) && !(0..3).any(goes_through);
        if is_complete { Ok(()) } else { Err((Failure::Cap, 0)) }
    }

    /// The pairs of a triangle and a prism that belong together and meet, with the prisms numbered as they are written.
    pub fn pairs(&self) -> Vec<[u32; 2]> {
        let left: Vec<usize> = (0..self.prisms.len()).filter(|&prism| self.exists[prism]).collect();
        let of_prism = |(number, &prism): (usize, &usize)| {
            let body = self.prism(self.prisms[prism]);
            let met = |t: &&u32| body.meets(self.surface.corners[**t as usize]);
            let met = self.contents[prism].triangles.iter().filter(met);
            met.map(|&t| [t, number as u32]).collect::<Vec<_>>()
        };
        let mut pairs: Vec<[u32; 2]> = left.par_iter().enumerate().flat_map_iter(of_prism).collect();
        pairs.sort_unstable();
        pairs
    }
}
