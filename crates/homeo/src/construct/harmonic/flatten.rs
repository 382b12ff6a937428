//! Solving for the images of the inner vertices.

use std::collections::BTreeMap;

use faer::Side;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use homeo_core::planar::Point2;

use super::HarmonicError;

/// Weights of the discrete Laplace equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weights {
    /// Linear finite elements. In a Delaunay triangulation none is negative.
    Cotangent,
    /// All the same.
    Equal,
}

/// The least weight: a share of the mean. Zero weights, of four points on a circle, would still do in exact arithmetic.
const LEAST_WEIGHT: f64 = 1e-6;

/// Images of the inner vertices: each is the weighted average of its neighbours'. `jumps` says how many turns each
/// triangle's corners are ahead of the images of their vertices; nothing jumps where it is empty.
pub(super) fn inner_images(
    positions: &[Point2],
    fixed: &[Point2],
    triangles: &[[u32; 3]],
    jumps: &[[i8; 3]],
    weights: Weights,
) -> Result<Vec<Point2>, HarmonicError> {
    let (known, count) = (fixed.len(), positions.len() - fixed.len());
    if count == 0 {
        return Ok(Vec::new());
    }
    let edges = weighted_edges(positions, triangles, jumps, weights);
    let mut right = faer::Mat::<f64>::zeros(count, 2);
    let mut diagonal = vec![0.0; count];
    let mut triplets = Vec::with_capacity(edges.len() + count);
    for (&[a, b], &(weight, jump)) in &edges {
        // `jump` turns are added at `b` to go on from `a`.
        for (here, there, jump) in [(a as usize, b as usize, jump), (b as usize, a as usize, -jump)] {
            let Some(row) = here.checked_sub(known) else { continue };
            diagonal[row] += weight;
            right[(row, 0)] += weight * jump;
            match there.checked_sub(known) {
                Some(column) if column < row => triplets.push(Triplet::new(row, column, -weight)),
                Some(_) => {}
                None => (0..2).for_each(|axis| right[(row, axis)] += weight * fixed[there][axis]),
            }
        }
    }
    triplets.extend(diagonal.iter().enumerate().map(|(i, &d)| Triplet::new(i, i, d)));
    let failed = || HarmonicError::Solve;
    let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(count, count, &triplets).map_err(|_| failed())?;
    let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower).map_err(|_| failed())?;
    let factor = Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower).map_err(|_| failed())?;
    let solution = factor.solve(&right);
    Ok((0..count).map(|i| [solution[(i, 0)], solution[(i, 1)]]).collect())
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
