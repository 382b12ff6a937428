//! Moving the middle's vertices to where the map distorts less (section 5.3).
//!
//! Within given triangulations all images depend linearly on the middle's vertices, by equations that are factored once.
//! The gradient of the mean distortion by all of them at once is pulled back by the transposed equations, at the cost of
//! two evaluations; the source takes finite differences by one vertex at a time. It is that of the triangles that meet
//! now: which ones these are changes along the way, and every step is accepted by its energy only.
//!
//! First vertices move along the circle, by the logarithms of their arcs: no order of steps can make that polygon other
//! than convex. Then they leave it, each as far as convexity lets it, decided exactly.

use std::f64::consts::TAU;

use homeo_core::planar::Point2;
use homeo_core::predicate::{Sign, orient2d};

use super::{HarmonicError, Laplace, Triangulated, Weights, go_on};
use crate::map::planar_distortion::{Distortion, Matrix, determinant, inverse, product, sides, transposed};
use crate::map::{Middle, neighbours};
use crate::progress::Progress;

/// Accepted steps, of each of both ways, at most.
const MOST_STEPS: usize = 40;
/// Halvings of a step before giving up.
const MOST_HALVINGS: usize = 12;
/// What a step must gain, as a share, for another one to follow.
const LEAST_GAIN: f64 = 1e-4;
/// The most by which the logarithm of an arc changes in one step.
const LONGEST_STEP: f64 = 0.5;
/// No arc becomes shorter than this share of an equal one: rounding must not take away corners.
const LEAST_ARC: f64 = 0.02;

/// One triangulated domain: what its images depend on.
struct Side<'a> {
    of: &'a Triangulated,
    laplace: Laplace,
    /// Sides of its triangles in the domain.
    sides: Vec<Matrix>,
    neighbours: Vec<[u32; 3]>,
}

impl<'a> Side<'a> {
    fn new(of: &'a Triangulated) -> Result<Self, HarmonicError> {
        let laplace = Laplace::new(&of.positions, of.boundary.len(), of.triangles(), &[], Weights::Cotangent)?;
        let sides = of.triangles().iter().map(|t| sides(t.map(|v| of.positions[v as usize]))).collect();
        Ok(Self { of, laplace, sides, neighbours: neighbours(of.triangles()) })
    }

    fn images(&self, middle: &Middle) -> Vec<Point2> {
        let mut images: Vec<Point2> = self.of.boundary.iter().map(|point| middle.point(point)).collect();
        images.extend(self.laplace.solve(&images));
        images
    }

    /// Adds the gradient by the middle's vertices of what has this gradient by the images.
    fn pull_back(&self, gradient: &[Point2], sum: &mut [Point2]) {
        let n = sum.len();
        for (point, given) in self.of.boundary.iter().zip(self.laplace.pull_back(gradient)) {
            let edge = point.edge as usize;
            let share = point.fraction();
            for (vertex, weight) in [(edge, 1.0 - share), ((edge + 1) % n, share)] {
                (0..2).for_each(|axis| sum[vertex][axis] += weight * given[axis]);
            }
        }
    }
}

/// The middle's vertices with all that follows from them.
struct State {
    polygon: Vec<Point2>,
    images: [Vec<Point2>; 2],
    /// For each triangle of the source: the one of the target that holds its centroid in the middle.
    met: Vec<u32>,
    energy: f64,
}

struct Problem<'a> {
    sides: [Side<'a>; 2],
    kind: Distortion,
    area: f64,
}

/// The middle's polygon with the least distortion that was found, begun with a convex one.
pub(super) fn optimized(
    halves: &[&Triangulated; 2],
    begin: &[Point2],
    kind: Distortion,
    progress: &impl Progress,
) -> Result<Vec<Point2>, HarmonicError> {
    let sides = [Side::new(halves[0])?, Side::new(halves[1])?];
    let area = sides[0].sides.iter().map(|&m| determinant(m)).sum();
    let problem = Problem { sides, kind, area };
    let mut state = problem.state(begin.to_vec(), None);
    for is_free in [false, true] {
        state = problem.descend(state, is_free, progress)?;
    }
    Ok(state.polygon)
}

impl Problem<'_> {
    fn descend(&self, mut state: State, is_free: bool, progress: &impl Progress) -> Result<State, HarmonicError> {
        let mut step = 1.0;
        for _ in 0..MOST_STEPS {
            let before = state.energy;
            let gradient = self.gradient(&state);
            for _ in 0..MOST_HALVINGS {
                go_on(progress)?;
                let polygon = match is_free {
                    true => moved_freely(&state.polygon, &gradient, step),
                    false => moved_on_circle(&state.polygon, &gradient, step),
                };
                if is_convex(&polygon) {
                    let tried = self.state(polygon, Some(&state.met));
                    if tried.energy < state.energy {
                        state = tried;
                        break;
                    }
                }
                step *= 0.5;
            }
            step *= 2.0;
            if before - state.energy <= LEAST_GAIN * before || !before.is_finite() {
                break;
            }
        }
        Ok(state)
    }

    fn state(&self, polygon: Vec<Point2>, hints: Option<&[u32]>) -> State {
        let middle = Middle::new(vec![polygon.clone()]);
        let images = [0, 1].map(|k| self.sides[k].images(&middle));
        let mut last = 0;
        let mut met = Vec::with_capacity(self.sides[0].sides.len());
        let mut sum = 0.0;
        for t in 0..self.sides[0].sides.len() {
            let corners = self.corners(&images, 0, t);
            let centroid = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).sum::<f64>() / 3.0);
            last = self.find(&images, centroid, hints.map_or(last, |hints| hints[t]));
            met.push(last);
            sum += determinant(self.sides[0].sides[t]) * self.kind.of(self.jacobian(&images, t, last));
        }
        State { polygon, images, met, energy: sum / self.area }
    }

    fn corners(&self, images: &[Vec<Point2>; 2], side: usize, triangle: usize) -> [Point2; 3] {
        self.sides[side].of.triangles()[triangle].map(|v| images[side][v as usize])
    }

    /// The Jacobian where a triangle of the source and one of the target meet.
    fn jacobian(&self, images: &[Vec<Point2>; 2], source: usize, target: u32) -> Matrix {
        let there = inverse(sides(self.corners(images, 1, target as usize)));
        let here = product(sides(self.corners(images, 0, source)), inverse(self.sides[0].sides[source]));
        product(product(self.sides[1].sides[target as usize], there), here)
    }

    /// The target's triangle that holds a point of the middle, by walking; on the boundary the last one on the way.
    fn find(&self, images: &[Vec<Point2>; 2], point: Point2, hint: u32) -> u32 {
        let mut triangle = hint;
        let least = |t: u32| {
            let [a, b, c] = self.corners(images, 1, t as usize);
            let cross =
                |p: Point2, q: Point2| (p[0] - point[0]) * (q[1] - point[1]) - (p[1] - point[1]) * (q[0] - point[0]);
            let parts = [cross(b, c), cross(c, a), cross(a, b)];
            (0..3).fold((0, f64::INFINITY), |least, k| if parts[k] < least.1 { (k, parts[k]) } else { least })
        };
        for _ in 0..self.sides[1].neighbours.len() {
            let (worst, value) = least(triangle);
            let next = self.sides[1].neighbours[triangle as usize][worst];
            if value >= 0.0 || next == u32::MAX {
                break;
            }
            triangle = next;
        }
        triangle
    }

    /// Of the energy, by the middle's vertices.
    fn gradient(&self, state: &State) -> Vec<Point2> {
        let mut by_images = [0, 1].map(|k| vec![[0.0; 2]; state.images[k].len()]);
        for (t, &met) in state.met.iter().enumerate() {
            let from = inverse(self.sides[0].sides[t]);
            let back = inverse(sides(self.corners(&state.images, 1, met as usize)));
            let outer = product(self.sides[1].sides[met as usize], back);
            let inner = product(sides(self.corners(&state.images, 0, t)), from);
            let weight = determinant(self.sides[0].sides[t]) / self.area;
            let by_jacobian = self.kind.gradient(product(outer, inner)).map(|row| row.map(|x| weight * x));
            let pulled = product(transposed(outer), by_jacobian);
            let source = product(pulled, transposed(from));
            let target = product(pulled, transposed(product(back, inner))).map(|row| row.map(|x| -x));
            scatter(&mut by_images[0], self.sides[0].of.triangles()[t], source);
            scatter(&mut by_images[1], self.sides[1].of.triangles()[met as usize], target);
        }
        let mut sum = vec![[0.0; 2]; state.polygon.len()];
        (0..2).for_each(|k| self.sides[k].pull_back(&by_images[k], &mut sum));
        sum
    }
}

/// Adds a gradient by the sides of a triangle to those by its corners.
fn scatter(gradient: &mut [Point2], corners: [u32; 3], by_sides: Matrix) {
    let [a, b, c] = corners.map(|v| v as usize);
    for axis in 0..2 {
        let [first, second] = by_sides[axis];
        gradient[a][axis] -= first + second;
        gradient[b][axis] += first;
        gradient[c][axis] += second;
    }
}

/// Against the gradient by the logarithms of the arcs, of a polygon on the unit circle that begins at angle 0.
fn moved_on_circle(polygon: &[Point2], gradient: &[Point2], step: f64) -> Vec<Point2> {
    let n = polygon.len();
    let angles: Vec<f64> = polygon.iter().map(|p| p[1].atan2(p[0]).rem_euclid(TAU)).collect();
    let arcs: Vec<f64> = (0..n).map(|i| if i + 1 < n { angles[i + 1] } else { TAU } - angles[i]).collect();
    let by_angle: Vec<f64> = polygon.iter().zip(gradient).map(|(p, g)| p[0] * g[1] - p[1] * g[0]).collect();
    // When an arc grows by a share, angles after it grow by the arc, and all shrink to fit.
    let all: f64 = by_angle.iter().zip(&angles).map(|(g, angle)| g * angle).sum::<f64>() / TAU;
    let mut after: f64 = by_angle.iter().sum();
    let by_share: Vec<f64> = by_angle
        .iter()
        .map(|g| {
            after -= g;
            after - all
        })
        .collect();
    let largest = by_share.iter().fold(0.0f64, |most, x| most.max(x.abs())).max(f64::MIN_POSITIVE);
    let least = LEAST_ARC * TAU / n as f64;
    let change = |slope: &f64| (-LONGEST_STEP * step.min(1.0) * slope / largest).exp();
    let grown: Vec<f64> = arcs.iter().zip(&by_share).map(|(arc, slope)| (arc * change(slope)).max(least)).collect();
    let total: f64 = grown.iter().sum();
    let mut angle = 0.0;
    grown
        .iter()
        .map(|arc| {
            let here: f64 = angle;
            angle += TAU * arc / total;
            [here.cos(), here.sin()]
        })
        .collect()
}

/// Against the gradient, each vertex as far as the polygon stays convex.
fn moved_freely(polygon: &[Point2], gradient: &[Point2], step: f64) -> Vec<Point2> {
    let n = polygon.len();
    let largest = gradient.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs())).max(f64::MIN_POSITIVE);
    let mut moved = polygon.to_vec();
    for v in 0..n {
        let mut share = 0.1 * step / largest;
        for _ in 0..MOST_HALVINGS {
            let there = [0, 1].map(|axis| polygon[v][axis] - share * gradient[v][axis]);
            // Of a triangle, both neighbours' neighbours are the other neighbour.
            let at = |ahead: usize| moved[(v + ahead) % n];
            let ring = [at(n - 2), at(n - 1), there, at(1), at(2)];
            if ring.windows(3).all(|w| orient2d(w[0], w[1], w[2]) == Sign::Positive) {
                moved[v] = there;
                break;
            }
            share *= 0.5;
        }
    }
    moved
}

/// Whether every vertex turns left, exactly, and the whole once round.
fn is_convex(polygon: &[Point2]) -> bool {
    let n = polygon.len();
    let side = |i: usize| [0, 1].map(|axis| polygon[(i + 1) % n][axis] - polygon[i][axis]);
    let is_left = |i: usize| orient2d(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]) == Sign::Positive;
    // Turning left all the way, the direction points up after down as often as it goes round.
    let is_up = |i: usize| side(i)[1] > 0.0 || (side(i)[1] == 0.0 && side(i)[0] > 0.0);
    (0..n).all(is_left) && (0..n).filter(|&i| !is_up(i) && is_up((i + 1) % n)).count() == 1
}

#[cfg(test)]
mod tests;
