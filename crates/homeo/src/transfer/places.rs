//! Which points of one disk correspond to those of another that is mapped onto the same shape.

use homeo_core::mesh::CellId;
use homeo_core::number::Rational;
use rayon::prelude::*;

use super::TransferError;
use super::correspondence::At;
use crate::map::{EvaluationError, Foliation};
use crate::progress::Progress;

/// So many points are looked for between two questions whether to stop.
const CHUNK: usize = 256;

/// So often the way from a corner to the middle is cut to a sixteenth, at most.
const MOST_CUTS: u32 = 64;

/// A triangle and exact weights of its corners.
pub(super) type Place = (CellId, [Rational; 3]);

/// The composite of one map and the inverse of the other.
pub(super) struct Composite<'m> {
    from: &'m Foliation<3>,
    onto: &'m Foliation<3>,
    /// The triangles of `from` at each vertex, ascending.
    around: Vec<Vec<u32>>,
}

impl<'m> Composite<'m> {
    pub fn new(from: &'m Foliation<3>, onto: &'m Foliation<3>) -> Self {
        let mut around = vec![Vec::new(); from.source().positions().len()];
        for (t, cell) in from.source().complex().cells().iter().enumerate() {
            cell.iter().for_each(|v| around[v.index()].push(t as u32));
        }
        Self { from, onto, around }
    }

    /// The place of each vertex of `onto`; none for one in no triangle.
    pub fn of_vertices(&self, progress: &(dyn Progress + Sync)) -> Result<Vec<Option<Place>>, TransferError> {
        let mut first: Vec<Option<(usize, usize)>> = vec![None; self.onto.source().positions().len()];
        for (t, cell) in self.onto.source().complex().cells().iter().enumerate() {
            (0..3).for_each(|k| {
                first[cell[k].index()].get_or_insert((t, k));
            });
        }
        in_chunks(&first, progress, |corner| match *corner {
            None => Ok(None),
            Some((t, k)) => {
                let unit = std::array::from_fn(|i| if i == k { Rational::ONE } else { Rational::ZERO });
                self.place(CellId::new(t), &unit)
                    .map(Some)
                    .map_err(|reason| TransferError::NoImage { triangle: t, reason })
            }
        })
    }

    /// The corners of all triangles of `onto`, each in a triangle of `from` that lies partly under its own.
    pub fn of_corners(
        &self,
        vertices: &[Option<Place>],
        progress: &(dyn Progress + Sync),
    ) -> Result<Vec<[Option<At>; 3]>, TransferError> {
        let all: Vec<usize> = (0..self.onto.source().complex().cell_count()).collect();
        in_chunks(&all, progress, |&triangle| {
            let cell = self.onto.source().complex().cells()[triangle];
            let corner = |k: usize| {
                let place = vertices[cell[k].index()].as_ref();
                place.map(|place| self.seen_from_inside(CellId::new(triangle), k, place)).transpose()
            };
            let [a, b, c] = [0, 1, 2].map(corner);
            let failed = |reason| TransferError::NoImage { triangle, reason };
            Ok([a.map_err(failed)?, b.map_err(failed)?, c.map_err(failed)?])
        })
    }

    /// The triangles of `from` in which the middles of those of `onto` lie.
    pub fn of_middles(&self, progress: &(dyn Progress + Sync)) -> Result<Vec<Option<At>>, TransferError> {
        let all: Vec<usize> = (0..self.onto.source().complex().cell_count()).collect();
        in_chunks(&all, progress, |&triangle| {
            let place = self.place(CellId::new(triangle), &[Rational::ONE, Rational::ONE, Rational::ONE]);
            let (cell, _) = place.map_err(|reason| TransferError::NoImage { triangle, reason })?;
            // Only the triangle counts.
            Ok(Some(At { triangle: cell.raw(), weights: [1.0, 0.0, 0.0] }))
        })
    }

    /// The point of `from` for one of a triangle of `onto`.
    fn place(&self, triangle: CellId, weights: &[Rational; 3]) -> Result<Place, EvaluationError> {
        self.from.locate_preimage(&self.onto.image_in_cell(triangle, weights)?)
    }

    /// The place of a corner. Where it lies on an edge or vertex, and so in several triangles, it is given in one that the
    /// way from the corner to the middle enters near the corner: that triangle is under the one of `onto`.
    fn seen_from_inside(&self, triangle: CellId, corner: usize, place: &Place) -> Result<At, EvaluationError> {
        let (cell, weights) = place;
        let around = self.around_place(*cell, weights);
        let here = match around[..] {
            [only] => only,
            _ => self.side(triangle, corner, &around)?,
        };
        let cells = self.from.source().complex().cells();
        let weight = |v| (0..3).find(|&k| cells[cell.index()][k] == v).map_or(0.0, |k| weights[k].to_f64());
        Ok(At { triangle: here, weights: cells[here as usize].map(weight) })
    }

    /// The triangles of `from` that contain a place.
    fn around_place(&self, cell: CellId, weights: &[Rational; 3]) -> Vec<u32> {
        let corners = self.from.source().complex().cell(cell);
        let held: Vec<usize> = (0..3).filter(|&k| !weights[k].is_zero()).map(|k| corners[k].index()).collect();
        let [first, others @ ..] = &held[..] else { return Vec::new() };
        let has = |t: &&u32| others.iter().all(|&v| self.around[v].contains(t));
        self.around[*first].iter().filter(has).copied().collect()
    }

    /// One of the triangles around a place that contains points of `triangle` as near to its corner as need be: the map is
    /// continuous, so near enough to the corner all points go into these.
    fn side(&self, triangle: CellId, corner: usize, around: &[u32]) -> Result<u32, EvaluationError> {
        let mut apart = Rational::ONE;
        for _ in 0..MOST_CUTS {
            apart = &apart / &Rational::from(16);
            let near = std::array::from_fn(|k| if k == corner { Rational::ONE } else { apart.clone() });
            let (cell, _) = self.place(triangle, &near)?;
            if around.contains(&cell.raw()) {
                return Ok(cell.raw());
            }
        }
        Err(EvaluationError::NotCovered(triangle.raw()))
    }
}

/// One answer for each item, in parallel and in order, or the first error.
fn in_chunks<I: Sync, O: Send>(
    items: &[I],
    progress: &(dyn Progress + Sync),
    answer: impl Fn(&I) -> Result<O, TransferError> + Sync,
) -> Result<Vec<O>, TransferError> {
    let mut answers = Vec::with_capacity(items.len());
    for chunk in items.chunks(CHUNK) {
        if progress.is_cancelled() {
            return Err(TransferError::Cancelled);
        }
        // Collected before errors are looked for, so that the first one does not depend on the number of threads.
        let found: Vec<Result<O, TransferError>> = chunk.par_iter().map(&answer).collect();
        for answer in found {
            answers.push(answer?);
        }
    }
    Ok(answers)
}
