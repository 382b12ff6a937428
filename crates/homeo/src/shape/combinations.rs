//! Vertices of a triangulation as convex combinations of their neighbours, in two drawings.

use std::collections::BTreeMap;

use homeo_core::planar::Point2;

use super::compatible::{CompatibleError, FRAME};
use super::mix;

/// Two matrices of positive weights with row sums 1, one row for each vertex that is no corner of the frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Combinations {
    /// Where each row begins, and the last one ends.
    starts: Vec<usize>,
    /// Neighbours, ascending.
    neighbours: Vec<u32>,
    /// Their weights in both drawings.
    weights: Vec<[f64; 2]>,
}

impl Combinations {
    /// Mean value weights: `(tan(a / 2) + tan(b / 2)) / r` for the angles `a` and `b` on both sides of an edge of length
    /// `r`. They are positive wherever angles are below a half turn, and reproduce the vertex.
    ///
    /// # Errors
    /// A triangle is so flat that a weight is not positive and finite.
    pub fn new(drawings: &[Vec<Point2>; 2], triangles: &[[u32; 3]]) -> Result<Self, CompatibleError> {
        let count = drawings[0].len() - FRAME;
        let mut rows: Vec<BTreeMap<u32, [f64; 2]>> = vec![BTreeMap::new(); count];
        for &corners in triangles {
            for k in 0..3 {
                let [here, one, two] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
                let Some(row) = (here as usize).checked_sub(FRAME) else { continue };
                for (side, drawing) in drawings.iter().enumerate() {
                    let parts = parts([here, one, two].map(|vertex| drawing[vertex as usize]));
                    if !parts.iter().all(|part| part.is_finite() && *part > 0.0) {
                        return Err(CompatibleError::Flat { corners });
                    }
                    rows[row].entry(one).or_default()[side] += parts[0];
                    rows[row].entry(two).or_default()[side] += parts[1];
                }
            }
        }
        let mut found = Self { starts: vec![0], neighbours: Vec::new(), weights: Vec::new() };
        for row in rows {
            let sums = [0, 1].map(|side| row.values().map(|weights| weights[side]).sum::<f64>());
            for (neighbour, weights) in row {
                found.neighbours.push(neighbour);
                found.weights.push([0, 1].map(|side| weights[side] / sums[side]));
            }
            found.starts.push(found.neighbours.len());
        }
        Ok(found)
    }

    /// How many rows.
    pub fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// Calls with each row, each neighbour of its vertex and the mixed weight.
    pub fn for_each(&self, t: f64, mut visit: impl FnMut(usize, usize, f64)) {
        for row in 0..self.count() {
            for entry in self.starts[row]..self.starts[row + 1] {
                let [a, b] = self.weights[entry];
                visit(row, self.neighbours[entry] as usize, mix(t, a, b));
            }
        }
    }
}

/// What a triangle gives to the weights of its second and third corner at the first: `tan(angle / 2) / distance`.
fn parts([here, one, two]: [Point2; 3]) -> [f64; 2] {
    let [u, v] = [one, two].map(|there| [there[0] - here[0], there[1] - here[1]]);
    let [r, s] = [u, v].map(|edge| edge[0].hypot(edge[1]));
    let (cross, dot) = (u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
    let tangent = if dot > 0.0 { cross / (r * s + dot) } else { (r * s - dot) / cross };
    [tangent / r, tangent / s]
}

#[cfg(test)]
impl Combinations {
    /// Spoils the weights of the first row, which still add up to 1.
    pub fn reverse_first_weights(&mut self) {
        let row = &mut self.weights[..self.starts[1]];
        let last = row.len() - 1;
        for side in 0..2 {
            row[0][side] += 40.0;
            row[last][side] -= 40.0;
        }
    }
}
