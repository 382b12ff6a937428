//! Solving for the images of the inner vertices: factored once, for any images of the boundary.

use std::collections::BTreeMap;

use faer::Side;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use homeo_core::planar::Point2;

use super::HarmonicError;

/// Weights of the discrete Laplace equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weights {
    /// Linear finite elements. In a Delaunay triangulation none is negative.
    Cotangent,
    /// All the same.
    Equal,
}

/// The least weight: a share of the mean. Zero weights, of four points on a circle, would still do in exact arithmetic.
const LEAST_WEIGHT: f64 = 1e-6;

/// The discrete Laplace equation of a triangulation, factored: each inner vertex is the weighted average of its
/// neighbours.
pub(crate) struct Laplace {
    /// How many vertices, the first ones, have given images.
    known: usize,
    count: usize,
    /// From the lower to the higher vertex, with weight and jump.
    edges: BTreeMap<[u32; 2], (f64, f64)>,
    /// None where there is no inner vertex.
    factor: Option<Llt<usize, f64>>,
}

impl Laplace {
    /// The first `known` vertices have given images. `jumps` says how many turns each triangle's corners are ahead of the
    /// images of their vertices; nothing jumps where it is empty.
    pub fn new(
        positions: &[Point2],
        known: usize,
        triangles: &[[u32; 3]],
        jumps: &[[i8; 3]],
        weights: Weights,
    ) -> Result<Self, HarmonicError> {
        let count = positions.len() - known;
        let edges = weighted_edges(positions, triangles, jumps, weights);
        let factor = if count == 0 { None } else { Some(factor(known, count, &edges)?) };
        Ok(Self { known, count, edges, factor })
    }

    /// Images of the inner vertices.
    pub fn solve(&self, fixed: &[Point2]) -> Vec<Point2> {
        let Some(factor) = &self.factor else { return Vec::new() };
        let mut right = faer::Mat::<f64>::zeros(self.count, 2);
        self.for_each_row(|row, there, weight, jump| {
            // `jump` turns are added there to go on from here.
            right[(row, 0)] += weight * jump;
            if there < self.known {
                (0..2).for_each(|axis| right[(row, axis)] += weight * fixed[there][axis]);
            }
        });
        let solution = factor.solve(&right);
        (0..self.count).map(|i| [solution[(i, 0)], solution[(i, 1)]]).collect()
    }

    /// What a function of the images of all vertices depends on those that are given: its gradient by all of them is
    /// pulled back, by the transposed equation.
    pub fn pull_back(&self, gradient: &[Point2]) -> Vec<Point2> {
        let mut given = gradient[..self.known].to_vec();
        let Some(factor) = &self.factor else { return given };
        let right = faer::Mat::from_fn(self.count, 2, |i, axis| gradient[self.known + i][axis]);
        let solution = factor.solve(&right);
        self.for_each_row(|row, there, weight, _| {
            if there < self.known {
                (0..2).for_each(|axis| given[there][axis] += weight * solution[(row, axis)]);
            }
        });
        given
    }

    /// Calls with the row of an inner vertex, a neighbour, the weight and the jump between them.
    fn for_each_row(&self, mut visit: impl FnMut(usize, usize, f64, f64)) {
        for (&[a, b], &(weight, jump)) in &self.edges {
            for (here, there, jump) in [(a as usize, b as usize, jump), (b as usize, a as usize, -jump)] {
                if let Some(row) = here.checked_sub(self.known) {
                    visit(row, there, weight, jump);
                }
            }
        }
    }
}

/// Factors the rows of the inner vertices.
fn factor(
    known: usize,
    count: usize,
    edges: &BTreeMap<[u32; 2], (f64, f64)>,
) -> Result<Llt<usize, f64>, HarmonicError> {
    let mut diagonal = vec![0.0; count];
    let mut triplets = Vec::with_capacity(edges.len() + count);
    for (&[a, b], &(weight, _)) in edges {
        for (here, there) in [(a as usize, b as usize), (b as usize, a as usize)] {
            let Some(row) = here.checked_sub(known) else { continue };
            diagonal[row] += weight;
            if let Some(column) = there.checked_sub(known).filter(|&column| column < row) {
                triplets.push(Triplet::new(row, column, -weight));
            }
        }
    }
    triplets.extend(diagonal.iter().enumerate().map(|(i, &d)| Triplet::new(i, i, d)));
    let failed = || HarmonicError::Solve;
    let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(count, count, &triplets).map_err(|_| failed())?;
    let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower).map_err(|_| failed())?;
    Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower).map_err(|_| failed())
}

/// All edges from the lower to the higher vertex, with their weight and jump.
fn weighted_edges(
    positions: &[Point2],
    triangles: &[[u32; 3]],
    jumps: &[[i8; 3]],
    weights: Weights,
) -> BTreeMap<[u32; 2], (f64, f64)> {
    let mut edges: BTreeMap<[u32; 2], (f64, f64)> = BTreeMap::new();
    for (number, corners) in triangles.iter().enumerate() {
        for k in 0..3 {
            let [i, j] = [(k + 1) % 3, (k + 2) % 3];
            let jump = jumps.get(number).map_or(0.0, |jump| f64::from(jump[j] - jump[i]));
            let weight = match weights {
                Weights::Cotangent => 0.5 * cotangent(corners.map(|v| positions[v as usize]), k),
                Weights::Equal => 1.0,
            };
            let (ends, jump) = match corners[i] < corners[j] {
                true => ([corners[i], corners[j]], jump),
                false => ([corners[j], corners[i]], -jump),
            };
            let entry = edges.entry(ends).or_insert((0.0, jump));
            entry.0 += weight;
        }
    }
    let mean = edges.values().map(|(weight, _)| weight.abs()).sum::<f64>() / edges.len() as f64;
    edges.values_mut().for_each(|(weight, _)| *weight = weight.max(LEAST_WEIGHT * mean));
    edges
}

/// The cotangent of the angle at a corner.
fn cotangent(corners: [Point2; 3], at: usize) -> f64 {
    let apex = corners[at];
    let [u, v] = [1, 2].map(|k| {
        let end = corners[(at + k) % 3];
        [end[0] - apex[0], end[1] - apex[1]]
    });
    (u[0] * v[0] + u[1] * v[1]) / (u[0] * v[1] - u[1] * v[0])
}
