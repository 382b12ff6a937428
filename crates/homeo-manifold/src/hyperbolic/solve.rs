//! Lengths of the edges for which the angles add up to 2π round each: Newton's method, and Luo's flow.
//!
//! Source: Yin 2010, sections 4.3.2 and 4.3.3; convexity of the extended energy: Luo and Yang 2018. The *curvature* of an
//! edge is `K = 2π - Σ θ`. It is minus the gradient of the energy `E(l) = Σ_tetrahedra (2 V + Σ θ l) - 2π Σ l`, by Schläfli's
//! formula `dV = -½ Σ l dθ`; the Hessian of `E`, the matrix `∂θ/∂l`, is positive definite where all tetrahedra are
//! proper, and `E` is convex on all lengths. So a structure is the minimum of `E`, there is at most one, and steps that do
//! not pass the minimum on their line lead down. Nothing found here is a proof: that is [`prove`](super::prove()).

use super::dense;
use super::equations::{Equations, Values, largest};
use super::obstruction::Obstruction;
use super::refusal::{NoMetric, check_topology};
use crate::skeleton::Skeleton;
use crate::triangulation::Triangulation;

/// Newton's method stops after so many steps; it takes fewer than 20 on all gluings of three tetrahedra.
const NEWTON_STEPS: usize = 200;
/// The flow stops after so many steps.
const FLOW_STEPS: usize = 20_000;
/// Lengths above this are taken for unbounded. The discriminant has terms of the size `exp(4 l)` that cancel to `exp(2 l)`:
/// from here on less than a digit of the angles would be left in doubles, so no solution could be told from none.
const LONGEST: f64 = 16.0;
/// Curvatures below this are rounding: some tens of angles, each rounded to `4e-16`, amplified by flat tetrahedra.
const NO_CURVATURE: f64 = 1e-12;

/// How lengths were found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Newton's method on the extended energy.
    Newton,
    /// The flow `dl/dt = K`.
    Flow,
}

/// Lengths whose curvatures vanish but for rounding.
#[derive(Debug, Clone, PartialEq)]
pub struct Approximation {
    /// The length of each edge.
    pub lengths: Vec<f64>,
    /// The largest absolute curvature, in radians.
    pub curvature: f64,
    /// The steps that were taken.
    pub steps: usize,
    /// By which method.
    pub method: Method,
}

/// Lengths near the structure of a triangulation, by Newton's method, with the flow as fallback.
///
/// # Errors
/// When there is no structure, with a proof where [`NoMetric::is_proved`] says so, and when none is found in the stated numbers
/// of steps (200, then 20,000 of the flow).
///
/// # Complexity
/// A step costs `O(#T + #E^3)`.
///
/// # Example
/// ```
/// use homeo_manifold::hyperbolic::solve;
/// use homeo_manifold::{Permutation, Skeleton, Triangulation};
/// let rows = [(0, [1, 2, 3, 0]), (1, [3, 0, 1, 2]), (2, [0, 3, 2, 1]), (3, [0, 2, 1, 3])];
/// let rows = rows.map(|(face, images)| (0, face, 1, Permutation::new(images).unwrap()));
/// let tripus = Triangulation::from_gluings(2, &rows)?;
/// let found = solve(&tripus, &Skeleton::new(&tripus))?;
/// // cosh l = cos t / (2 cos t - 1), for the angles t = π / 6.
/// let cosine = std::f64::consts::FRAC_PI_6.cos();
/// assert!((found.lengths[0].cosh() - cosine / (2.0 * cosine - 1.0)).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve(triangulation: &Triangulation, skeleton: &Skeleton) -> Result<Approximation, NoMetric> {
    check_topology(triangulation, skeleton)?;
    let equations = Equations::new(skeleton);
    let end = newton(&equations);
    match end {
        End::Solved(found) => Ok(found),
        End::Escaped(lengths) => Err(escape(skeleton, &lengths)),
        End::Flat(lengths, tetrahedron) => {
            Err(NoMetric::obstructed(skeleton, &lengths).unwrap_or(NoMetric::Degenerate { tetrahedron }))
        }
        End::Exhausted(lengths) => {
            NoMetric::obstructed(skeleton, &lengths).map_or_else(|| finish_flow(skeleton, &equations, FLOW_STEPS), Err)
        }
    }
}

/// Lengths near the structure of a triangulation, by Luo's flow `dl/dt = K` alone, from lengths 1.
///
/// Explicit steps of `1 / ‖∂θ/∂l‖`, the maximum norm, in which no length changes by more than a half of it: curvatures then
/// decrease like a heat flow. It takes hundreds of steps where Newton's method takes five; it is there to compare with, and
/// when Newton's method fails.
///
/// # Errors
/// As [`solve`].
///
/// ```
/// # use homeo_manifold::hyperbolic::{flow, solve};
/// # use homeo_manifold::{Permutation, Skeleton, Triangulation};
/// # let rows = [(0, [1, 2, 3, 0]), (1, [3, 0, 1, 2]), (2, [0, 3, 2, 1]), (3, [0, 2, 1, 3])];
/// # let rows = rows.map(|(face, images)| (0, face, 1, Permutation::new(images).unwrap()));
/// # let tripus = Triangulation::from_gluings(2, &rows)?;
/// # let skeleton = Skeleton::new(&tripus);
/// let (slow, fast) = (flow(&tripus, &skeleton)?, solve(&tripus, &skeleton)?);
/// assert!((slow.lengths[0] - fast.lengths[0]).abs() < 1e-11);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn flow(triangulation: &Triangulation, skeleton: &Skeleton) -> Result<Approximation, NoMetric> {
    check_topology(triangulation, skeleton)?;
    finish_flow(skeleton, &Equations::new(skeleton), FLOW_STEPS)
}

/// How an iteration ends.
enum End {
    Solved(Approximation),
    Escaped(Vec<f64>),
    Flat(Vec<f64>, u32),
    Exhausted(Vec<f64>),
}

/// What is said when lengths grow without bound.
fn escape(skeleton: &Skeleton, lengths: &[f64]) -> NoMetric {
    let searched = || Obstruction::search(skeleton).map(|obstruction| NoMetric::NoAngles { obstruction });
    NoMetric::obstructed(skeleton, lengths).or_else(searched).unwrap_or_else(|| {
        let longest = |a: &usize, b: &usize| lengths[*a].total_cmp(&lengths[*b]);
        NoMetric::Escapes { edge: (0..lengths.len()).max_by(longest).unwrap_or(0), length: largest(lengths) }
    })
}

fn newton(equations: &Equations) -> End {
    let mut lengths = vec![1.0; equations.edges()];
    let (mut values, mut trial) = (equations.zero(0.0, 0.0), equations.zero(0.0, 0.0));
    let mut next = lengths.clone();
    equations.near(&lengths, &mut values);
    for steps in 0..NEWTON_STEPS {
        if let Some(end) = ended(&lengths, &values, steps, Method::Newton) {
            return end;
        }
        let Some(step) = newton_step(equations, &values) else { return End::Exhausted(lengths) };
        search(equations, [&lengths, &step], &values, &mut next, &mut trial);
        std::mem::swap(&mut lengths, &mut next);
        std::mem::swap(&mut values, &mut trial);
    }
    End::Exhausted(lengths)
}

/// Whether an iteration is at its end.
fn ended(lengths: &[f64], values: &Values<f64>, steps: usize, method: Method) -> Option<End> {
    let curvature = largest(&values.excess);
    if largest(lengths) > LONGEST {
        return Some(End::Escaped(lengths.to_vec()));
    }
    if curvature >= NO_CURVATURE {
        return None;
    }
    Some(match values.flat {
        Some(tetrahedron) => End::Flat(lengths.to_vec(), tetrahedron),
        None => End::Solved(Approximation { lengths: lengths.to_vec(), curvature, steps, method }),
    })
}

/// Minus the inverse of the Hessian, made definite where tetrahedra are flat, times the gradient.
fn newton_step(equations: &Equations, values: &Values<f64>) -> Option<Vec<f64>> {
    let size = equations.edges();
    let scale = (0..size).map(|k| values.slopes[k * size + k]).fold(1e-3, f64::max);
    let shifts = std::iter::once(0.0).chain((0..10).map(|power| scale * 1e-9 * 10f64.powi(power)));
    let lower = shifts.into_iter().find_map(|shift| dense::factor(&values.slopes, size, shift))?;
    let mut step: Vec<f64> = values.excess.iter().map(|excess| -excess).collect();
    dense::substitute(&lower, &mut step);
    step.iter().all(|x| x.is_finite()).then_some(step)
}

/// The largest change of a length in one step.
const LARGEST_CHANGE: f64 = 1.5;
/// A step is halved at most so many times.
const HALVINGS: usize = 40;

/// Goes along a step until the slope on this line is half of what it was, or less: as the energy is convex, the minimum of the
/// line is then not passed by far.
fn search(
    equations: &Equations,
    [lengths, step]: [&[f64]; 2],
    values: &Values<f64>,
    next: &mut [f64],
    trial: &mut Values<f64>,
) {
    let slope = |values: &Values<f64>| values.excess.iter().zip(step).map(|(g, d)| g * d).sum::<f64>();
    // Lengths stay positive, and no change is large.
    let within = |(length, change): (&f64, &f64)| {
        let most = if *change < 0.0 { (0.8 * length).min(LARGEST_CHANGE) } else { LARGEST_CHANGE };
        most / change.abs()
    };
    let mut share = lengths.iter().zip(step).map(within).fold(1.0, f64::min);
    let steepness = slope(values).abs();
    for _ in 0..HALVINGS {
        next.iter_mut().zip(lengths).zip(step).for_each(|((next, length), change)| *next = length + share * change);
        equations.near(next, trial);
        // Near the minimum rounding decides; there the whole step is right.
        if slope(trial) <= 0.5 * steepness || steepness < 1e-22 {
            return;
        }
        share *= 0.5;
    }
}

/// The flow, and what its end means.
fn finish_flow(skeleton: &Skeleton, equations: &Equations, limit: usize) -> Result<Approximation, NoMetric> {
    let size = equations.edges();
    let mut lengths = vec![1.0_f64; size];
    let mut values = equations.zero(0.0, 0.0);
    for steps in 0..limit {
        equations.near(&lengths, &mut values);
        match ended(&lengths, &values, steps, Method::Flow) {
            Some(End::Solved(found)) => return Ok(found),
            Some(End::Flat(lengths, tetrahedron)) => {
                let found = NoMetric::obstructed(skeleton, &lengths);
                return Err(found.unwrap_or(NoMetric::Degenerate { tetrahedron }));
            }
            Some(_) => return Err(escape(skeleton, &lengths)),
            None => {}
        }
        let norm = values.slopes.chunks_exact(size).map(|row| row.iter().map(|x| x.abs()).sum()).fold(1.0, f64::max);
        for (length, excess) in lengths.iter_mut().zip(&values.excess) {
            *length += (-excess / norm).clamp(-0.5 * *length, 0.5 * *length);
        }
    }
    let curvature = largest(&values.excess);
    Err(NoMetric::obstructed(skeleton, &lengths).unwrap_or(NoMetric::NotFound { steps: limit, curvature }))
}

impl NoMetric {
    /// The refusal with a proof along a direction, if there is one.
    fn obstructed(skeleton: &Skeleton, direction: &[f64]) -> Option<Self> {
        Obstruction::along(skeleton, direction).map(|obstruction| Self::NoAngles { obstruction })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperbolic::testing;

    #[test]
    fn the_known_lengths_are_found_by_newton_and_by_the_flow() {
        let mut count = 0;
        for entry in testing::census() {
            let Some(known) = &entry.geometry else { continue };
            let skeleton = Skeleton::new(&entry.triangulation);
            let fast = solve(&entry.triangulation, &skeleton).unwrap();
            let slow = flow(&entry.triangulation, &skeleton).unwrap();
            assert_eq!((fast.method, slow.method), (Method::Newton, Method::Flow));
            for tetrahedron in 0..entry.triangulation.len() as u32 {
                let classes = skeleton.edges_of(tetrahedron);
                for (class, known) in classes.into_iter().zip(known.lengths[tetrahedron as usize]) {
                    assert!((fast.lengths[class as usize] - known).abs() < 1e-11, "{}", entry.name);
                    assert!((slow.lengths[class as usize] - known).abs() < 1e-10, "{}", entry.name);
                }
            }
            // With one edge the flow's step is Newton's.
            let is_faster =
                if skeleton.edges().len() == 1 { fast.steps <= slow.steps } else { fast.steps < slow.steps };
            assert!(is_faster && fast.steps <= 20, "{} {}", fast.steps, slow.steps);
            count += 1;
        }
        assert!(count >= 10, "{count}");
    }

    #[test]
    fn every_entry_without_a_structure_is_refused_with_a_proof() {
        let (mut degrees, mut angles) = (0, 0);
        for entry in testing::census().into_iter().filter(|entry| entry.geometry.is_none()) {
            let skeleton = Skeleton::new(&entry.triangulation);
            let refusal = solve(&entry.triangulation, &skeleton).unwrap_err();
            assert!(refusal.is_proved(), "{}: {refusal}", entry.name);
            match refusal {
                NoMetric::LowDegree { edge, degree } => {
                    assert!(degree < 3 && skeleton.edges()[edge].corners.len() == degree);
                    degrees += 1;
                }
                NoMetric::NoAngles { obstruction } => {
                    // It is a proof: made again from its numbers alone.
                    assert!(Obstruction::new(&skeleton, obstruction.weights().to_vec()).is_some());
                    angles += 1;
                }
                other => panic!("{}: {other}", entry.name),
            }
        }
        assert!(degrees >= 3 && angles >= 2, "{degrees} {angles}");
    }
}
