//! Weighted graph Laplacians and the problems posed with them.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};
use homeo_core::mesh::VertexId;

/// A linear problem that could not be solved.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("linear solver: {0}")]
pub struct SolveError(String);

impl SolveError {
    pub(super) fn new(what: &str) -> Self {
        Self(what.to_owned())
    }
}

/// Laplacian `(L u)_i = sum_j w_ij (u_i - u_j)` of a graph with positive weights.
///
/// Stored by rows; the rows of a vertex list its neighbours in ascending order of edges.
#[derive(Clone, Debug)]
pub struct GraphLaplacian {
    starts: Vec<u32>,
    columns: Vec<u32>,
    weights: Vec<f64>,
    diagonal: Vec<f64>,
}

/// Weights below this fraction of the mean at their vertices are raised to it.
const LEAST_RELATIVE_WEIGHT: f64 = 1e-2;

impl GraphLaplacian {
    /// Laplacian of the graph with `vertex_count` vertices, the given edges and their weights.
    ///
    /// Weights that are negative, tiny or not finite are raised to a hundredth of the mean magnitude
    /// around their ends.
    pub fn new(vertex_count: usize, ends: &[[VertexId; 2]], weights: &[f64]) -> Self {
        let weights = positive_weights(vertex_count, ends, weights);
        let mut starts = vec![0u32; vertex_count + 1];
        for [a, b] in ends {
            starts[a.index() + 1] += 1;
            starts[b.index() + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut fill = starts.clone();
        let mut columns = vec![0; 2 * ends.len()];
        let mut values = vec![0.0; 2 * ends.len()];
        let mut diagonal = vec![0.0; vertex_count];
        for ([a, b], &weight) in ends.iter().zip(&weights) {
            for (row, column) in [(a, b), (b, a)] {
                let slot = fill[row.index()] as usize;
                columns[slot] = column.raw();
                values[slot] = weight;
                diagonal[row.index()] += weight;
                fill[row.index()] += 1;
            }
        }
        Self { starts, columns, weights: values, diagonal }
    }

    fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.columns[range.clone()].iter().zip(&self.weights[range]).map(|(&j, &w)| (j as usize, w))
    }

    fn vertex_count(&self) -> usize {
        self.diagonal.len()
    }

    /// The field that takes the given values where they are given and satisfies `L u = load` elsewhere.
    ///
    /// Conjugate gradients to a residual of `relative_residual` of the first one, or 2,000 steps. The
    /// preconditioner is a two-level cycle: a Gauss-Seidel sweep, a correction that is constant on
    /// aggregates of vertices (solved directly), and the sweep backwards.
    /// Vertices without edges get 0.
    pub fn solve_iterative(&self, fixed: &[Option<f64>], load: &[f64], relative_residual: f64) -> Vec<f64> {
        let free: Vec<bool> = fixed.iter().zip(&self.diagonal).map(|(f, &d)| f.is_none() && d > 0.0).collect();
        let mut u: Vec<f64> = fixed.iter().map(|value| value.unwrap_or(0.0)).collect();
        let n = u.len();
        let mut r = vec![0.0; n];
        for i in (0..n).filter(|&i| free[i]) {
            r[i] = load[i] + self.row(i).map(|(j, w)| w * u[j]).sum::<f64>() - self.diagonal[i] * u[i];
        }
        let coarse = Coarse::new(self, &free);
        let (mut z, mut q) = (vec![0.0; n], vec![0.0; n]);
        self.precondition(&free, &coarse, &r, &mut z);
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        let target = rz * relative_residual * relative_residual;
        for _ in 0..2_000 {
            if rz <= target || rz <= 0.0 {
                break;
            }
            self.apply(&free, &p, &mut q);
            let alpha = rz / dot(&p, &q);
            for i in 0..n {
                u[i] += alpha * p[i];
                r[i] -= alpha * q[i];
            }
            self.precondition(&free, &coarse, &r, &mut z);
            let next = dot(&r, &z);
            let beta = next / rz;
            rz = next;
            for i in 0..n {
                p[i] = z[i] + beta * p[i];
            }
        }
        self.smooth(&free, load, &mut u);
        u
    }

    fn apply(&self, free: &[bool], x: &[f64], y: &mut [f64]) {
        for i in (0..x.len()).filter(|&i| free[i]) {
            y[i] = self.diagonal[i] * x[i] - self.row(i).map(|(j, w)| w * x[j]).sum::<f64>();
        }
    }

    /// One symmetric two-level cycle from zero.
    fn precondition(&self, free: &[bool], coarse: &Coarse, r: &[f64], z: &mut [f64]) {
        let n = r.len();
        for i in (0..n).filter(|&i| free[i]) {
            let lower: f64 = self.row(i).filter(|&(j, _)| j < i).map(|(j, w)| w * z[j]).sum();
            z[i] = (r[i] + lower) / self.diagonal[i];
        }
        coarse.correct(self, free, r, z);
        for i in (0..n).rev().filter(|&i| free[i]) {
            let around: f64 = self.row(i).map(|(j, w)| w * z[j]).sum();
            z[i] = (r[i] + around) / self.diagonal[i];
        }
    }

    /// A few Gauss-Seidel sweeps: they make each value an average of its neighbours, which removes
    /// the spurious extrema that the iteration's residual leaves where the field is tiny.
    fn smooth(&self, free: &[bool], load: &[f64], u: &mut [f64]) {
        let n = u.len();
        for sweep in 0..4 {
            let relax = |u: &mut [f64], i: usize| {
                if free[i] {
                    u[i] = (load[i] + self.row(i).map(|(j, w)| w * u[j]).sum::<f64>()) / self.diagonal[i];
                }
            };
            if sweep % 2 == 0 { (0..n).for_each(|i| relax(u, i)) } else { (0..n).rev().for_each(|i| relax(u, i)) }
        }
    }

    /// Harmonic extension of several fields at once by one sparse factorization (for surfaces).
    ///
    /// `fixed[i]` gives the values of vertex `i` (`D` of them) or `None` where it is free.
    ///
    /// # Errors
    /// When a free vertex is not connected to a fixed one.
    pub fn harmonic_direct<const D: usize>(&self, fixed: &[Option<[f64; D]>]) -> Result<Vec<[f64; D]>, SolveError> {
        let mut number = vec![usize::MAX; self.vertex_count()];
        let free: Vec<usize> = (0..self.vertex_count()).filter(|&i| fixed[i].is_none()).collect();
        for (k, &i) in free.iter().enumerate() {
            number[i] = k;
        }
        let mut result: Vec<[f64; D]> = fixed.iter().map(|value| value.unwrap_or([0.0; D])).collect();
        if free.is_empty() {
            return Ok(result);
        }
        let mut right = Mat::<f64>::zeros(free.len(), D);
        for (k, &i) in free.iter().enumerate() {
            for (j, w) in self.row(i) {
                if let Some(value) = fixed[j] {
                    (0..D).for_each(|d| right[(k, d)] += w * value[d]);
                }
            }
        }
        let solution = self.factor(&number, &free, 0.0)?.solve(&right);
        for (k, &i) in free.iter().enumerate() {
            (0..D).for_each(|d| result[i][d] = solution[(k, d)]);
        }
        Ok(result)
    }

    fn factor(&self, number: &[usize], free: &[usize], shift: f64) -> Result<Llt<usize, f64>, SolveError> {
        let mut triplets = Vec::with_capacity(self.columns.len() / 2 + free.len());
        for (k, &i) in free.iter().enumerate() {
            triplets.push(Triplet::new(k, k, self.diagonal[i] * (1.0 + shift)));
            for (j, w) in self.row(i).filter(|&(j, _)| number[j] != usize::MAX && number[j] < k) {
                triplets.push(Triplet::new(k, number[j], -w));
            }
        }
        let failed = SolveError::new;
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(free.len(), free.len(), &triplets)
            .map_err(|_| failed("the matrix could not be built"))?;
        let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower)
            .map_err(|_| failed("the symbolic factorization failed"))?;
        Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower)
            .map_err(|_| failed("the matrix is not positive definite: a part of the mesh touches no fixed vertex"))
    }

    /// The smoothest field that is not constant, scaled to `[0, 1]`: an approximation of the Fiedler
    /// vector by inverse iteration with the given vertex masses, from `start`.
    ///
    /// # Errors
    /// When the graph is not connected.
    pub fn fiedler(&self, masses: &[f64], start: &[f64]) -> Result<Vec<f64>, SolveError> {
        let n = self.vertex_count();
        let all: Vec<usize> = (0..n).collect();
        // A tiny shift makes the singular matrix definite; constants are projected out exactly.
        let factor = self.factor(&all, &all, 1e-9)?;
        let total: f64 = masses.iter().sum();
        let center = |x: &mut [f64]| {
            let mean = x.iter().zip(masses).map(|(x, m)| x * m).sum::<f64>() / total;
            x.iter_mut().for_each(|x| *x -= mean);
            let norm = x.iter().zip(masses).map(|(x, m)| x * x * m).sum::<f64>().sqrt();
            if norm > 0.0 {
                x.iter_mut().for_each(|x| *x /= norm);
            }
        };
        let mut x = start.to_vec();
        center(&mut x);
        for _ in 0..30 {
            let right = Mat::from_fn(n, 1, |i, _| masses[i] * x[i]);
            let solution = factor.solve(&right);
            let mut next: Vec<f64> = (0..n).map(|i| solution[(i, 0)]).collect();
            center(&mut next);
            let overlap: f64 = next.iter().zip(&x).zip(masses).map(|((a, b), m)| a * b * m).sum();
            x = next;
            if 1.0 - overlap.abs() < 1e-8 {
                break;
            }
        }
        let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(l, h), &v| (l.min(v), h.max(v)));
        let range = if high > low { high - low } else { 1.0 };
        Ok(x.iter().map(|v| (v - low) / range).collect())
    }
}

/// Aggregates of free vertices and the matrix between them, factored.
struct Coarse {
    aggregate: Vec<u32>,
    factor: Option<Llt<usize, f64>>,
    count: usize,
}

/// Aggregates are made so large that there are about this many of them.
const AGGREGATES: usize = 3_000;
const NO_AGGREGATE: u32 = u32::MAX;

impl Coarse {
    fn new(fine: &GraphLaplacian, free: &[bool]) -> Self {
        let free_count = free.iter().filter(|&&f| f).count();
        let size = free_count.div_ceil(AGGREGATES).max(8);
        let (aggregate, count) = aggregates(fine, free, size);
        let mut triplets = Vec::new();
        let mut diagonal = vec![0.0; count];
        for i in (0..free.len()).filter(|&i| free[i]) {
            let here = aggregate[i] as usize;
            for (j, w) in fine.row(i) {
                let there = aggregate[j];
                if there as usize == here {
                    continue;
                }
                diagonal[here] += w;
                if there != NO_AGGREGATE && (there as usize) < here {
                    triplets.push(Triplet::new(here, there as usize, -w));
                }
            }
        }
        // A touch more than the sum keeps parts that touch no fixed vertex definite.
        triplets.extend(
            diagonal.iter().enumerate().map(|(k, &d)| Triplet::new(k, k, d * (1.0 + 1e-10) + f64::MIN_POSITIVE)),
        );
        let factor =
            SparseColMat::<usize, f64>::try_new_from_triplets(count, count, &triplets).ok().and_then(|matrix| {
                let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower).ok()?;
                Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower).ok()
            });
        Self { aggregate, factor, count }
    }

    /// Adds the aggregates' correction of the residual of `z`.
    fn correct(&self, fine: &GraphLaplacian, free: &[bool], r: &[f64], z: &mut [f64]) {
        let Some(factor) = &self.factor else { return };
        let mut right = Mat::<f64>::zeros(self.count, 1);
        for i in (0..r.len()).filter(|&i| free[i]) {
            let residual = r[i] - fine.diagonal[i] * z[i] + fine.row(i).map(|(j, w)| w * z[j]).sum::<f64>();
            right[(self.aggregate[i] as usize, 0)] += residual;
        }
        let correction = factor.solve(&right);
        for i in (0..r.len()).filter(|&i| free[i]) {
            z[i] += correction[(self.aggregate[i] as usize, 0)];
        }
    }
}

/// Connected groups of about `size` free vertices, grown breadth first in the order of the vertices.
fn aggregates(fine: &GraphLaplacian, free: &[bool], size: usize) -> (Vec<u32>, usize) {
    let mut aggregate = vec![NO_AGGREGATE; free.len()];
    let mut count = 0;
    let mut queue = std::collections::VecDeque::new();
    for seed in 0..free.len() {
        if !free[seed] || aggregate[seed] != NO_AGGREGATE {
            continue;
        }
        let mut members = 1;
        aggregate[seed] = count;
        queue.clear();
        queue.push_back(seed);
        while let Some(i) = queue.pop_front() {
            for (j, _) in fine.row(i) {
                if members < size && free[j] && aggregate[j] == NO_AGGREGATE {
                    aggregate[j] = count;
                    members += 1;
                    queue.push_back(j);
                }
            }
        }
        count += 1;
    }
    (aggregate, count as usize)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn positive_weights(vertex_count: usize, ends: &[[VertexId; 2]], weights: &[f64]) -> Vec<f64> {
    let magnitude = |w: f64| if w.is_finite() { w.abs() } else { 0.0 };
    let mut sums = vec![(0.0, 0u32); vertex_count];
    for (ends, &weight) in ends.iter().zip(weights) {
        for end in ends {
            sums[end.index()].0 += magnitude(weight);
            sums[end.index()].1 += 1;
        }
    }
    let mean = |v: VertexId| sums[v.index()].0 / f64::from(sums[v.index()].1.max(1));
    ends.iter()
        .zip(weights)
        .map(|([a, b], &weight)| {
            let least = LEAST_RELATIVE_WEIGHT * mean(*a).min(mean(*b));
            let least = if least > 0.0 { least } else { 1.0 };
            if weight.is_finite() { weight.max(least) } else { least }
        })
        .collect()
}
