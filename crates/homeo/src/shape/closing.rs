//! Least corrections that close a ring: of lengths for given directions, and of turning angles for given lengths.

use std::f64::consts::TAU;

/// The least part of its length that a corrected edge keeps.
const LEAST_PART: f64 = 0.1;

/// What may be left open, as a part of the perimeter.
const OPEN: f64 = 1e-14;

/// Changes of curvature, in the mean, below which steps that shrink are taken whole: the merit is rounded by then.
const SMALL_CHANGE: f64 = 1e-2;

/// Changes of curvature, in the mean, below which steps may end.
const LEAST_CHANGE: f64 = 1e-9;

/// Steps at most.
const MOST_STEPS: usize = 300;

/// A correction that was not found: what is left open, as a part of the perimeter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Open(pub f64);

/// Lengths `m` for edges of given directions (unit vectors) that close the ring, `sum m u = 0`, with
/// `sum ((m - l) / w)^2` least among those with `m >= l / 10`.
///
/// With multipliers `x` in the plane, `m = max(l + w^2 x . u, l / 10)`: the ring closes where a convex function of `x`,
/// of which `sum m u` is the gradient, is least. Newton's method, with exact search on each line.
pub(super) fn closing_lengths(lengths: &[f64], weights: &[f64], units: &[[f64; 2]]) -> Result<Vec<f64>, Open> {
    let squares: Vec<f64> = weights.iter().map(|w| w * w).collect();
    let free = |i: usize, x: [f64; 2]| lengths[i] + squares[i] * dot(x, units[i]);
    let length = |i: usize, x: [f64; 2]| free(i, x).max(LEAST_PART * lengths[i]);
    let all = || 0..lengths.len();
    let gap = |x: [f64; 2]| all().fold([0.0; 2], |sum, i| along(sum, length(i, x), units[i]));
    let total: f64 = lengths.iter().sum();
    let (mut x, mut best) = ([0.0; 2], f64::INFINITY);
    for _ in 0..200 {
        let open = gap(x);
        best = open[0].hypot(open[1]) / total;
        if best <= OPEN {
            return Ok(all().map(|i| length(i, x)).collect());
        }
        let is_free = |&i: &usize| free(i, x) > LEAST_PART * lengths[i];
        let regular = 1e-12 * squares.iter().sum::<f64>();
        let [a, b, c] = all().filter(is_free).fold([regular, 0.0, regular], |[a, b, c], i| {
            let ([ux, uy], s) = (units[i], squares[i]);
            [a + s * ux * ux, b + s * ux * uy, c + s * uy * uy]
        });
        let determinant = a * c - b * b;
        let step = [(b * open[1] - c * open[0]) / determinant, (b * open[0] - a * open[1]) / determinant];
        let part = least_on_line(|part| dot(gap(along(x, part, step)), step));
        let next = along(x, part, step);
        if next == x {
            break;
        }
        x = next;
    }
    // Rounding may keep the last digits from settling.
    match best <= 100.0 * OPEN {
        true => Ok(all().map(|i| length(i, x)).collect()),
        false => Err(Open(best)),
    }
}

/// The part of a step at which a slope, negative at 0 and growing, is nearly 0; 1 where it has not come there.
fn least_on_line(slope: impl Fn(f64) -> f64) -> f64 {
    if slope(1.0) <= 0.5 * slope(0.0).abs() {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match slope(middle) < 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    high
}

/// Turning angles `b` that close a ring of edges of given lengths, and turn it a given number of times, with
/// `sum (b - a)^2 / w` least near the given angles `a`: a stationary point.
///
/// Sequential quadratic steps with the constraints made linear; then steps that only close.
pub(super) fn closing_turns(turns: &[f64], weights: &[f64], lengths: &[f64], whole: f64) -> Result<Vec<f64>, Open> {
    let problem = Turning { wanted: turns, weights, lengths, whole };
    let mut current = problem.nearest()?;
    for _ in 0..20 {
        let open = problem.open(&current);
        if size(open) <= OPEN {
            break;
        }
        let (step, _) = problem.step(&current, open, Towards::Closed).ok_or(Open(size(open)))?;
        current = moved(&current, 1.0, &step);
    }
    let open = size(problem.open(&current));
    match open <= 100.0 * OPEN {
        true => Ok(current),
        false => Err(Open(open)),
    }
}

/// What a step shall reach, under the linear constraints.
#[derive(Clone, Copy, PartialEq)]
enum Towards {
    /// The angles nearest to the wanted ones.
    Wanted,
    /// The angles nearest to the current ones.
    Closed,
}

/// Angles near wanted ones that close a ring.
struct Turning<'a> {
    wanted: &'a [f64],
    weights: &'a [f64],
    lengths: &'a [f64],
    whole: f64,
}

impl Turning<'_> {
    /// Angles at which steps vanish. Small steps that shrink are taken whole; others are shortened until a merit falls
    /// that counts the distance and what is open.
    fn nearest(&self) -> Result<Vec<f64>, Open> {
        let mut current = self.wanted.to_vec();
        let (mut penalty, mut last) = (0.0, f64::INFINITY);
        for _ in 0..MOST_STEPS {
            let open = self.open(&current);
            let (step, multipliers) = self.step(&current, open, Towards::Wanted).ok_or(Open(size(open)))?;
            let change = step.iter().zip(self.weights).map(|(s, w)| s * s / w).sum::<f64>().sqrt();
            let shrinks = change < SMALL_CHANGE && change < 0.8 * last;
            if change < LEAST_CHANGE && !shrinks {
                return Ok(current);
            }
            penalty = f64::max(penalty, 2.0 * size(multipliers));
            let part = if shrinks { 1.0 } else { self.falling_part(&current, &step, penalty) };
            current = moved(&current, part, &step);
            last = change;
        }
        Err(Open(size(self.open(&current))))
    }

    /// A part of a step that lets the merit fall, halved from 1 as often as need be.
    fn falling_part(&self, turns: &[f64], step: &[f64], penalty: f64) -> f64 {
        let merit = |b: &[f64]| 0.5 * self.distance_squared(b) + penalty * one_norm(self.open(b));
        let before = merit(turns);
        let mut part = 1.0;
        while part > 1e-6 && merit(&moved(turns, part, step)) > before {
            part *= 0.5;
        }
        part
    }

    /// Squared distance of angles from the wanted ones.
    fn distance_squared(&self, turns: &[f64]) -> f64 {
        (0..turns.len()).map(|i| (turns[i] - self.wanted[i]).powi(2) / self.weights[i]).sum()
    }

    /// Places of the vertices, and of the end of the last edge. The first edge's direction is the first turning angle.
    fn places(&self, turns: &[f64]) -> Vec<[f64; 2]> {
        let (mut direction, mut here) = (0.0, [0.0; 2]);
        let mut places = vec![here];
        for (turn, length) in turns.iter().zip(self.lengths) {
            direction += turn;
            let (sine, cosine) = f64::sin_cos(direction);
            here = along(here, *length, [cosine, sine]);
            places.push(here);
        }
        places
    }

    /// What angles leave open: the place of the end, and by what part of a turn they miss.
    fn open(&self, turns: &[f64]) -> [f64; 3] {
        let end = self.places(turns)[turns.len()];
        [end[0], end[1], turns.iter().sum::<f64>() / TAU - self.whole]
    }

    /// The step that closes the ring to first order, and the multipliers.
    fn step(&self, turns: &[f64], open: [f64; 3], towards: Towards) -> Option<(Vec<f64>, [f64; 3])> {
        let (n, places) = (turns.len(), self.places(turns));
        // Turning at a vertex turns all after it, the end too.
        let row = |i: usize| [places[i][1] - places[n][1], places[n][0] - places[i][0], 1.0 / TAU];
        let back = |i: usize| if towards == Towards::Wanted { self.wanted[i] - turns[i] } else { 0.0 };
        let (mut matrix, mut right) = ([[0.0; 3]; 3], open.map(|x| -x));
        for i in 0..n {
            let row = row(i);
            for j in 0..3 {
                right[j] -= row[j] * back(i);
                for k in 0..3 {
                    matrix[j][k] += self.weights[i] * row[j] * row[k];
                }
            }
        }
        let multipliers = solve(matrix, right)?;
        let sum = |row: [f64; 3]| row[0] * multipliers[0] + row[1] * multipliers[1] + row[2] * multipliers[2];
        Some(((0..n).map(|i| back(i) + self.weights[i] * sum(row(i))).collect(), multipliers))
    }
}

/// Solves a positive definite system; none where it is singular to working precision.
fn solve(mut matrix: [[f64; 3]; 3], mut right: [f64; 3]) -> Option<[f64; 3]> {
    let diagonal = [matrix[0][0], matrix[1][1], matrix[2][2]];
    for k in 0..3 {
        if matrix[k][k].is_nan() || matrix[k][k] <= 1e-14 * diagonal[k] {
            return None;
        }
        for j in k + 1..3 {
            let factor = matrix[j][k] / matrix[k][k];
            for l in k..3 {
                matrix[j][l] -= factor * matrix[k][l];
            }
            right[j] -= factor * right[k];
        }
    }
    for k in (0..3).rev() {
        right[k] = (right[k] - (k + 1..3).map(|l| matrix[k][l] * right[l]).sum::<f64>()) / matrix[k][k];
    }
    Some(right)
}

fn moved(from: &[f64], part: f64, step: &[f64]) -> Vec<f64> {
    from.iter().zip(step).map(|(x, s)| x + part * s).collect()
}

fn size(x: [f64; 3]) -> f64 {
    x.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn one_norm(x: [f64; 3]) -> f64 {
    x.iter().map(|x| x.abs()).sum()
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// `a + part * b`.
fn along(a: [f64; 2], part: f64, b: [f64; 2]) -> [f64; 2] {
    [a[0] + part * b[0], a[1] + part * b[1]]
}
