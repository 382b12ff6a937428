//! Charts of a triangulated domain in which a mean value map has no singularity.
//!
//! Half a corner of a triangle: the points `v + s e(λ)` with `e(λ) = p - v + λ (q - p)`, for `s` and `λ` from 0 to 1, where
//! `v` is a vertex of the domain, `p` the midpoint of a side of the triangle at `v` and `q` the centroid. What is singular
//! in the formulas of mean value coordinates, at the vertex and, if the side is one of the domain, along `λ = 0`, cancels
//! by hand; the proof is in `docs/theory/composite.md`. What is left is analytic on the closed chart, so that it is
//! evaluated, with its derivatives, in doubles and in balls by one text, [`Frame::evaluate`].

use homeo_core::number::Rational;
use homeo_core::planar::{PlanarDomain, Point2};

use super::number::{Ball, Number};
use super::triangulation::next_vertices;

/// Which edge of the domain a chart touches along `λ = 0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Touch {
    /// None: only the vertex is on the boundary.
    Nothing,
    /// The edge from the vertex to the next one of its ring.
    Next,
    /// The edge from the vertex before.
    Previous,
}

/// Half a corner of a triangle.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    /// Number of the vertex `v`, the one whose half side `p` ends, and the third.
    pub corners: [u32; 3],
    pub touch: Touch,
    /// Twice the signed area of `(v, p, q)`: a sixth of that of the triangle, negative for every other chart.
    turn: Ball,
}

/// A mean value map from one domain to another, and the charts of the first.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub points: Vec<Point2>,
    pub images: Vec<Point2>,
    pub next: Vec<u32>,
    pub previous: Vec<u32>,
    pub charts: Vec<Chart>,
}

impl Step {
    /// The map of a domain whose vertices go to `images`, with the charts of triangles that tile it.
    pub fn new(domain: &PlanarDomain, triangles: &[[u32; 3]], images: Vec<Point2>) -> Self {
        let points: Vec<Point2> = domain.vertices().collect();
        let next = next_vertices(domain);
        let mut previous = vec![0; next.len()];
        for (from, &to) in next.iter().enumerate() {
            previous[to as usize] = from as u32;
        }
        let charts = triangles.iter().flat_map(|&triangle| charts_of(triangle, &points, &next)).collect();
        Self { points, images, next, previous, charts }
    }
}

/// The six charts of a triangle, two for each corner.
fn charts_of([a, b, c]: [u32; 3], points: &[Point2], next: &[u32]) -> Vec<Chart> {
    let [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(|corner| points[corner as usize].map(exact));
    let area = (&bx - &ax) * (&cy - &ay) - (&by - &ay) * (&cx - &ax);
    let turn = Ball::around(&(area / Rational::from(6)));
    let halves = |[v, from, to]: [u32; 3]| {
        let touch_next = if next[v as usize] == from { Touch::Next } else { Touch::Nothing };
        let touch_previous = if next[to as usize] == v { Touch::Previous } else { Touch::Nothing };
        [
            Chart { corners: [v, from, to], touch: touch_next, turn },
            Chart { corners: [v, to, from], touch: touch_previous, turn: turn.opposite() },
        ]
    };
    [[a, b, c], [b, c, a], [c, a, b]].into_iter().flat_map(halves).collect()
}

fn exact(value: f64) -> Rational {
    Rational::from_f64(value).unwrap_or(Rational::ZERO)
}

type Vector<T> = [T; 2];

fn dot<T: Number>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn cross<T: Number>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[1] - a[1] * b[0]
}

fn plus<T: Number>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] + b[0], a[1] + b[1]]
}

fn minus<T: Number>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] - b[0], a[1] - b[1]]
}

fn scaled<T: Number>(factor: T, a: Vector<T>) -> Vector<T> {
    [factor * a[0], factor * a[1]]
}

fn opposite<T: Number>(a: Vector<T>) -> Vector<T> {
    a.map(T::opposite)
}

fn of<T: Number>(a: Point2) -> Vector<T> {
    a.map(T::of)
}

/// A function of `s` and `λ`: its value and its two derivatives.
#[derive(Clone, Copy)]
struct Dual<T>([T; 3]);

impl<T: Number> Dual<T> {
    fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
    fn times(self, other: Self) -> Self {
        let ([a, a1, a2], [b, b1, b2]) = (self.0, other.0);
        Self([a * b, a1 * b + a * b1, a2 * b + a * b2])
    }
    fn over(self, other: Self) -> Self {
        let ([a, a1, a2], [b, b1, b2]) = (self.0, other.0);
        let quotient = a / b;
        Self([quotient, (a1 - quotient * b1) / b, (a2 - quotient * b2) / b])
    }
}

/// What of a vertex is seen from a point `x`.
#[derive(Clone, Copy)]
struct Sight<T> {
    /// Unit vector towards it.
    unit: Vector<T>,
    /// One over its distance.
    inverse: T,
    /// The product of both: the gradient of `log (1 / distance)`; turned by a right angle, that of the direction.
    pull: Vector<T>,
}

/// `tan(α / 2)` of the angle from one unit vector to another, by that of two equal formulas whose divisor is not small.
#[inline(always)]
fn half_tangent<T: Number>(from: Vector<T>, to: Vector<T>) -> T {
    let (cosine, sine) = (dot(from, to), cross(from, to));
    let one = T::of(1.0);
    if cosine.near() < 0.0 { (one - cosine) / sine } else { sine / (one + cosine) }
}

/// A linear map near the map: what of it is reproduced exactly is not left to sums of enclosures.
pub(super) type Linear = [[f64; 2]; 2];

/// A chart and all vertices as seen from its own.
pub(super) struct Frame<'a, T> {
    step: &'a Step,
    chart: &'a Chart,
    /// `p - v` and `q - p`.
    pub axes: [Vector<T>; 2],
    pub turn: T,
    /// Of each vertex: where it is, and where it goes, less the same for `v`.
    offsets: Vec<[Vector<T>; 2]>,
    sights: Vec<Sight<T>>,
    /// Of each edge, by its first vertex: the half tangent and its gradient.
    tangents: Vec<[T; 3]>,
}

/// A mean value map near a point of a chart.
#[derive(Clone, Copy)]
pub(super) struct Local<T> {
    /// Where the point goes.
    pub image: Vector<T>,
    /// The determinant of the derivative.
    pub determinant: T,
    /// `∂f/∂s` and `1/s ∂f/∂λ`: the images of the next two under the derivative.
    pub columns: [Vector<T>; 2],
    /// `e` and `q - p`.
    pub axes: [Vector<T>; 2],
}

impl<'a, T: Number> Frame<'a, T> {
    pub fn new(step: &'a Step, chart: &'a Chart) -> Self {
        let [v, p, q] = chart.corners.map(|corner| of::<T>(step.points[corner as usize]));
        let image = of::<T>(step.images[chart.corners[0] as usize]);
        let (side, other) = (minus(p, v), minus(q, v));
        let axes = [
            scaled(T::of(0.5), side),
            std::array::from_fn(|k| (T::of(2.0) * other[k] - side[k]) / T::of(6.0)),
        ];
        let offset = |(&at, &to): (&Point2, &Point2)| [minus(of(at), v), minus(of(to), image)];
        let offsets: Vec<_> = step.points.iter().zip(&step.images).map(offset).collect();
        let nothing = Sight { unit: of([0.0; 2]), inverse: T::of(0.0), pull: of([0.0; 2]) };
        let sights = vec![nothing; offsets.len()];
        let tangents = vec![[T::of(0.0); 3]; offsets.len()];
        Self { step, chart, axes, turn: T::of_ball(chart.turn), offsets, sights, tangents }
    }

    /// Two coordinates of a point: `s`, and `s λ`.
    pub fn coordinates(&self, point: Vector<T>) -> Vector<T> {
        let v = of(self.step.points[self.chart.corners[0] as usize]);
        let offset = minus(point, v);
        [cross(offset, self.axes[1]) / self.turn, cross(self.axes[0], offset) / self.turn]
    }

    /// The map and its derivative at `v + s e(λ)`; unknown where a divisor may be zero.
    ///
    /// Any `linear` gives the same exact result; enclosures are narrow where it is close to the map.
    pub fn evaluate(&mut self, s: T, lambda: T, linear: &Linear) -> Local<T> {
        let across = self.axes[1];
        let along = plus(self.axes[0], scaled(lambda, across));
        let length = T::length(along[0], along[1]);
        let direction = [along[0] / length, along[1] / length];
        self.look(scaled(s, along), opposite(direction));
        let regular = self.regular_sums(linear);
        // Chain rule: from gradients in the plane to derivatives by s and λ.
        let chain = |[value, x, y]: [T; 3]| Dual([value, dot(along, [x, y]), s * dot(across, [x, y])]);
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let factor = if self.chart.touch == Touch::Nothing { Dual([one, zero, zero]) } else { Dual([lambda, zero, one]) };
        let [mut weight, mut first, mut second] = regular.map(|sum| factor.times(chain(sum)));
        let length = Dual([length, zero, dot(direction, across)]);
        let mut own = Dual([zero; 3]);
        for touch in [Touch::Next, Touch::Previous] {
            let tangent = self.tangent_at_vertex(touch, factor, [along, across], length, s);
            let k = self.neighbour(touch);
            let Sight { inverse, pull, .. } = self.sights[k];
            let nearness = Dual([inverse, inverse * dot(pull, along), inverse * (s * dot(pull, across))]);
            let share = tangent.times(nearness);
            let [x, y] = self.residual(k, linear).map(|d| Dual([d, zero, zero]));
            (first, second) = (first.plus(share.times(x)), second.plus(share.times(y)));
            weight = weight.plus(share);
            own = own.plus(tangent.over(length));
        }
        let total = own.plus(Dual([s, one, zero]).times(weight));
        let rest = [first.over(total), second.over(total)];
        self.assemble(s, rest, [along, across], linear)
    }

    /// From `G` to the map: `f = image of v + s (M e + G)`.
    fn assemble(&self, s: T, rest: [Dual<T>; 2], axes: [Vector<T>; 2], linear: &Linear) -> Local<T> {
        let value: Vector<T> = std::array::from_fn(|k| rest[k].0[0]);
        let by_s: Vector<T> = std::array::from_fn(|k| rest[k].0[0] + s * rest[k].0[1]);
        let by_lambda: Vector<T> = std::array::from_fn(|k| rest[k].0[2]);
        let linear_images = axes.map(|axis| apply(linear, axis));
        let [along, across] = linear_images;
        // det(M e + g, M e' + h), where det(M e, M e') is det M times that of the axes, which is constant.
        let mixed = cross(along, by_lambda) + cross(by_s, across) + cross(by_s, by_lambda);
        let own = cross(of::<T>(linear[0]), of(linear[1]));
        let at = of::<T>(self.step.images[self.chart.corners[0] as usize]);
        Local {
            image: plus(at, scaled(s, plus(along, value))),
            determinant: own + mixed / self.turn,
            columns: [plus(along, by_s), plus(across, by_lambda)],
            axes,
        }
    }

    fn neighbour(&self, touch: Touch) -> usize {
        let v = self.chart.corners[0] as usize;
        (if touch == Touch::Next { self.step.next[v] } else { self.step.previous[v] }) as usize
    }

    /// How far a vertex misses its image under the linear map.
    #[inline(always)]
    fn residual(&self, vertex: usize, linear: &Linear) -> Vector<T> {
        let [offset, image] = self.offsets[vertex];
        minus(image, apply(linear, offset))
    }

    /// Looks at all vertices and edges from `v + offset`; at `v` itself in the direction `towards`.
    fn look(&mut self, offset: Vector<T>, towards: Vector<T>) {
        let v = self.chart.corners[0] as usize;
        for (sight, [at, _]) in self.sights.iter_mut().zip(&self.offsets) {
            let there = minus(*at, offset);
            let inverse = T::of(1.0) / T::length(there[0], there[1]);
            let unit = scaled(inverse, there);
            *sight = Sight { unit, inverse, pull: scaled(inverse, unit) };
        }
        self.sights[v] = Sight { unit: towards, inverse: T::of(0.0), pull: of([0.0; 2]) };
        let half = T::of(0.5);
        for (i, tangent) in self.tangents.iter_mut().enumerate() {
            let k = self.step.next[i] as usize;
            if i == v || k == v {
                continue;
            }
            let (from, to) = (&self.sights[i], &self.sights[k]);
            let t = half_tangent(from.unit, to.unit);
            let rate = half + half * (t * t);
            let turning = minus(to.pull, from.pull);
            *tangent = [t, rate * turning[1], (rate * turning[0]).opposite()];
        }
    }

    /// Sums over all other vertices, of the edges not at `v` only: of the weights, and of weights times residuals; each
    /// with its gradient in the plane.
    fn regular_sums(&self, linear: &Linear) -> [[T; 3]; 3] {
        let v = self.chart.corners[0] as usize;
        let mut sums = [[T::of(0.0); 3]; 3];
        for (i, sight) in self.sights.iter().enumerate() {
            if i == v {
                continue;
            }
            let (before, after) = (&self.tangents[self.step.previous[i] as usize], &self.tangents[i]);
            let tangent = before[0] + after[0];
            let weight = [
                sight.inverse * tangent,
                sight.inverse * (before[1] + after[1] + tangent * sight.pull[0]),
                sight.inverse * (before[2] + after[2] + tangent * sight.pull[1]),
            ];
            let [x, y] = self.residual(i, linear);
            for k in 0..3 {
                sums[0][k] = sums[0][k] + weight[k];
                sums[1][k] = sums[1][k] + weight[k] * x;
                sums[2][k] = sums[2][k] + weight[k] * y;
            }
        }
        sums
    }

    /// The half tangent of an edge at `v`, times the factor of the chart, which cancels if the chart touches the edge.
    fn tangent_at_vertex(
        &self,
        touch: Touch,
        factor: Dual<T>,
        [along, across]: [Vector<T>; 2],
        length: Dual<T>,
        s: T,
    ) -> Dual<T> {
        let k = self.neighbour(touch);
        let Sight { unit, inverse, pull } = self.sights[k];
        if self.chart.touch == touch {
            // (|e| r + e . there) / |2 turn|.
            let there = minus(self.offsets[k][0], scaled(s, along));
            let distance = T::of(1.0) / inverse;
            let [size, _, growth] = length.0;
            let value = size * distance + dot(along, there);
            let by_s = opposite([size * dot(unit, along), size * size]);
            let by_lambda = growth * distance - s * (size * dot(unit, across)) + dot(across, there) - s * dot(along, across);
            let sign = if touch == Touch::Next { 2.0 } else { -2.0 };
            let divisor = T::of(sign) * self.turn;
            return Dual([value / divisor, (by_s[0] + by_s[1]) / divisor, by_lambda / divisor]);
        }
        let towards = self.sights[self.chart.corners[0] as usize].unit;
        let (t, sign) = match touch {
            Touch::Next => (half_tangent(towards, unit), T::of(0.5)),
            _ => (half_tangent(unit, towards), T::of(-0.5)),
        };
        let rate = sign + sign * (t * t);
        let size = length.0[0];
        let turning = s * cross(across, pull) - self.turn / (size * size);
        factor.times(Dual([t, rate * cross(along, pull), rate * turning]))
    }
}

fn apply<T: Number>(linear: &Linear, vector: Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| T::of(linear[k][0]) * vector[0] + T::of(linear[k][1]) * vector[1])
}

impl Frame<'_, Ball> {
    /// A linear map that takes vertices near a point of the chart close to their images, and how near the nearest vertex
    /// but `v` is. Least squares, weighted by the inverse fourth power of distances.
    pub fn fit(&self, s: f64, lambda: f64) -> (Linear, f64) {
        let axis = |axis: usize, k: usize| self.axes[axis][k].middle;
        let at: Point2 = std::array::from_fn(|k| s * (axis(0, k) + lambda * axis(1, k)));
        let v = self.chart.corners[0] as usize;
        let mut nearest = f64::INFINITY;
        let (mut normal, mut mixed) = ([0.0; 3], [[0.0; 2]; 2]);
        for (i, &[offset, image]) in self.offsets.iter().enumerate() {
            if i == v {
                continue;
            }
            let ([x, y], image) = (offset.map(|c| c.middle), image.map(|c| c.middle));
            let square = (x - at[0]) * (x - at[0]) + (y - at[1]) * (y - at[1]);
            nearest = nearest.min(square);
            let weight = 1.0 / (square * square);
            let (wx, wy) = (weight * x, weight * y);
            normal = [normal[0] + wx * x, normal[1] + wx * y, normal[2] + wy * y];
            for k in 0..2 {
                mixed[k] = [mixed[k][0] + image[k] * wx, mixed[k][1] + image[k] * wy];
            }
        }
        // A little of the identity, where vertices are almost in line.
        let ridge = 1e-6 * (normal[0] + normal[2]);
        let [a, b, c] = [normal[0] + ridge, normal[1], normal[2] + ridge];
        mixed[0][0] += ridge;
        mixed[1][1] += ridge;
        let determinant = a * c - b * b;
        let row = |m: [f64; 2]| [(m[0] * c - m[1] * b) / determinant, (m[1] * a - m[0] * b) / determinant];
        let linear = mixed.map(row);
        let is_good = linear.iter().flatten().all(|x| x.is_finite());
        (if is_good { linear } else { [[1.0, 0.0], [0.0, 1.0]] }, nearest.sqrt())
    }
}
