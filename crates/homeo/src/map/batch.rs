//! Many leaves at once.
//!
//! Which cell comes next on a leaf is known only when the last one has been crossed, so that on a large mesh
//! a leaf waits for memory at most of its cells. Different leaves need not wait for one another: the cells where
//! a band of leaves stand are fetched together, then each leaf crosses its own. Answers are those of
//! one leaf after the other, to the last bit.

use homeo_core::mesh::{CellId, Facet};
use rayon::prelude::*;

use super::exact::Sense;
use super::fast::{FastLeaf, Undecided};
use super::{Enclosed, EvaluationError, Foliation};

/// Leaves that are followed together.
const BAND: usize = 16;
/// Points that are located before their leaves are followed.
const CHUNK: usize = 128;
/// With fewer cells than this (2 MiB of them) all are at hand in the processor's cache, and no leaf waits.
const FEW_CELLS: usize = 1 << 16;

impl<const K: usize> Foliation<K> {
    pub(super) fn forward_all(&self, points: &[[f64; 3]]) -> Vec<Result<Enclosed, EvaluationError>> {
        if self.steps.len() < FEW_CELLS {
            return points.par_iter().map(|&point| self.forward_float(point)).collect();
        }
        points.par_chunks(CHUNK).flat_map_iter(|chunk| self.forward_chunk(chunk)).collect()
    }

    fn forward_chunk(&self, points: &[[f64; 3]]) -> Vec<Result<Enclosed, EvaluationError>> {
        let locate = |&point: &[f64; 3]| self.locator.float(self.source(), &self.parts().mesh, point);
        let located: Vec<_> = points.iter().map(locate).collect();
        // Two for each point: the first goes back, the second ahead.
        let starts = located.iter().flatten().filter_map(|located| self.fast_start(located));
        let mut leaves: Vec<FastLeaf<K>> =
            starts.flat_map(|at| [FastLeaf::new(self, at), FastLeaf::new(self, at)]).collect();
        let ends = self.follow_all(&mut leaves);
        let mut images = leaves.chunks_exact(2).zip(ends.chunks_exact(2)).map(|(leaves, ends)| {
            let [start, end] = [ends[0]?, ends[1]?];
            debug_assert!(start.is_some() && end.is_some());
            self.image_of_ends(start, &leaves[0], &leaves[1])
        });
        let answer = |(located, &point): (Result<_, _>, &[f64; 3])| {
            let located = located?;
            let fast = self.fast_start(&located).and_then(|_| images.next()?.ok());
            self.forward_from(&located, fast, point)
        };
        located.into_iter().zip(points).map(answer).collect()
    }

    /// Follows leaves to their ends, those with an even number back and the others ahead.
    fn follow_all(&self, leaves: &mut [FastLeaf<K>]) -> Vec<Result<Facet, Undecided>> {
        let mut ends = vec![Err(Undecided); leaves.len()];
        let mut band: Vec<usize> = (0..leaves.len().min(BAND)).collect();
        let mut next = band.len();
        let mut steps = [*self.steps.at(CellId::new(0)); BAND];
        while !band.is_empty() {
            for (step, &number) in steps.iter_mut().zip(&band) {
                *step = *self.steps.at(leaves[number].slot);
            }
            for place in (0..band.len()).rev() {
                let number = band[place];
                let sense = if number.is_multiple_of(2) { Sense::Backward } else { Sense::Forward };
                ends[number] = match leaves[number].advance(&steps[place], sense) {
                    Ok(None) => continue,
                    Ok(Some(end)) => Ok(self.steps.facet(end)),
                    Err(undecided) => Err(undecided),
                };
                if next < leaves.len() {
                    band[place] = next;
                    next += 1;
                } else {
                    band.swap_remove(place);
                }
            }
        }
        ends
    }
}

#[cfg(test)]
mod tests {
    use homeo_core::mesh::SimplicialComplex;

    use crate::construct::foliation::{FoliationParams, build};
    use crate::input::SourceMesh;
    use crate::map::{Bijection, EvaluationError, Target};
    use crate::progress::Silent;

    #[test]
    fn bands_answer_as_single_leaves_do() {
        let positions = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from)).collect();
        let cells = [[0, 1, 2, 4], [3, 2, 1, 7], [5, 4, 7, 1], [6, 2, 7, 4], [1, 2, 4, 7]];
        let source = SourceMesh::new(positions, SimplicialComplex::<4>::from_indices(8, &cells).unwrap());
        for target in [Target::Cube, Target::Ball] {
            let (map, _) = build(&source, target, &FoliationParams::default(), &Silent).unwrap();
            let points: Vec<[f64; 3]> =
                (0..500).map(|k| [17, 29, 61].map(|step| f64::from(k * step % 103) / 100.0)).collect();
            let answers = map.forward_chunk(&points);
            assert!(answers.contains(&Err(EvaluationError::OutsideSource)), "some points lie outside");
            for (answer, &point) in answers.iter().zip(&points) {
                assert_eq!(*answer, map.forward(point));
            }
        }
    }
}
