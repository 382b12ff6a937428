//! Charts of a triangulated domain in which a mean value map has no singularity.
//!
//! Half a corner of a triangle: the points `v + s e(λ)` with `e(λ) = p - v + λ (q - p)`, for `s` and `λ` from 0 to 1, where
//! `v` is a vertex of the domain, `p` the midpoint of a side of the triangle at `v` and `q` the centroid. What is singular
//! in the formulas of mean value coordinates, at the vertex and, if the side is one of the domain, along `λ = 0`, cancels
//! by hand; the proof is in `docs/theory/composite.md`. What is left is analytic on the closed chart, so that it is
//! evaluated, with its derivatives, in doubles and in balls by one text, [`Frame::evaluate`].

use homeo_core::number::Rational;
use homeo_core::planar::{PlanarDomain, Point2};

use super::number::{Ball, Number, Sight, half_tangent, sine_cosine};
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

/// The product of complex numbers.
fn times<T: Number>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn opposite<T: Number>(a: Vector<T>) -> Vector<T> {
    a.map(T::opposite)
}

fn of<T: Number>(a: Point2) -> Vector<T> {
    a.map(T::of)
}

/// A function of `s` and `λ`: its value and its derivatives `∂/∂s` and `∂/∂λ - skew s ∂/∂s`.
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
    fn times_constant(self, factor: T) -> Self {
        Self(self.0.map(|c| c * factor))
    }
    fn with(self, factor: Option<Self>) -> Self {
        factor.map_or(self, |factor| self.times(factor))
    }
    fn over(self, other: Self) -> Self {
        let ([a, a1, a2], [b, b1, b2]) = (self.0, other.0);
        let quotient = a / b;
        Self([quotient, (a1 - quotient * b1) / b, (a2 - quotient * b2) / b])
    }
}

/// A linear map near the map: what of it is reproduced exactly is not left to sums of enclosures.
pub(super) type Linear = [[f64; 2]; 2];

/// What makes enclosures narrow; nothing depends on it in exact arithmetic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guide {
    /// A linear map that takes vertices nearby close to their images.
    pub linear: Linear,
    /// The edge, by its first vertex, that is seen at the largest angle, if more than a right one: its weight dominates,
    /// and is factored out.
    pub near_edge: Option<usize>,
    /// The nearest vertex but `v`, whose distance is factored out as well.
    pub near_vertex: Option<usize>,
    /// How near it is.
    pub nearest: f64,
}

impl Guide {
    /// No help.
    pub const NONE: Self = Self { linear: [[1.0, 0.0], [0.0, 1.0]], near_edge: None, near_vertex: None, nearest: 1.0 };
}

/// A chart and all vertices as seen from its own.
pub(super) struct Frame<'a, T> {
    step: &'a Step,
    chart: &'a Chart,
    /// `p - v` and `q - p`.
    pub axes: [Vector<T>; 2],
    pub turn: T,
    /// Of each vertex: where it is, and where it goes, less the same for `v`.
    offsets: Vec<[Vector<T>; 2]>,
    /// Of each edge, by its first vertex: its vector, reversed and conjugated.
    edges: Vec<Vector<T>>,
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
    /// Two vectors with the determinant of `e` and `q - p`.
    pub axes: [Vector<T>; 2],
    /// Their images under the derivative.
    pub columns: [Vector<T>; 2],
}

impl<'a, T: Number> Frame<'a, T> {
    pub fn new(step: &'a Step, chart: &'a Chart) -> Self {
        let [v, p, q] = chart.corners.map(|corner| of::<T>(step.points[corner as usize]));
        let image = of::<T>(step.images[chart.corners[0] as usize]);
        let (side, other) = (minus(p, v), minus(q, v));
        let axes = [scaled(T::of(0.5), side), std::array::from_fn(|k| (T::of(2.0) * other[k] - side[k]) / T::of(6.0))];
        let offset = |(&at, &to): (&Point2, &Point2)| [minus(of(at), v), minus(of(to), image)];
        let offsets: Vec<_> = step.points.iter().zip(&step.images).map(offset).collect();
        let edge = |(from, &to): (&Point2, &u32)| {
            let [x, y] = minus(of::<T>(*from), of(step.points[to as usize]));
            [x, y.opposite()]
        };
        let edges = step.points.iter().zip(&step.next).map(edge).collect();
        let nothing = Sight { unit: of([0.0; 2]), inverse: T::of(0.0), pull: of([0.0; 2]), slack: 0.0 };
        let sights = vec![nothing; offsets.len()];
        let tangents = vec![[T::of(0.0); 3]; offsets.len()];
        Self { step, chart, axes, turn: T::of_ball(chart.turn), offsets, edges, sights, tangents }
    }

    /// Two coordinates of a point: `s`, and `s λ`.
    pub fn coordinates(&self, point: Vector<T>) -> Vector<T> {
        let v = of(self.step.points[self.chart.corners[0] as usize]);
        let offset = minus(point, v);
        [cross(offset, self.axes[1]) / self.turn, cross(self.axes[0], offset) / self.turn]
    }

    /// The map and its derivative at `v + s e(λ)`; unknown where a divisor may be zero.
    ///
    /// Any guide gives the same exact result.
    pub fn evaluate(&mut self, s: T, lambda: T, guide: &Guide) -> Local<T> {
        let along = plus(self.axes[0], scaled(lambda, self.axes[1]));
        let towards = T::sight(along, along).unit;
        let length = T::length(along[0], along[1]);
        // Instead of ∂/∂λ the derivative almost across e, lest determinants be differences of large numbers.
        let skew = T::of(dot(self.axes[1], along).near() / dot(along, along).near());
        let across = minus(self.axes[1], scaled(skew, along));
        let length = Dual([length, T::of(0.0), dot(towards, self.axes[1])]);
        let view = View { s, along, across, skew, length };
        self.look(scaled(s, along), opposite(towards), guide.near_edge);
        let mut edges = Vec::with_capacity(3);
        for touch in [Touch::Next, Touch::Previous] {
            let edge = self.edge_at_vertex(touch);
            edges.push(self.special_at_vertex(touch, &view, lambda, guide.near_edge == Some(edge)));
        }
        if let Some(edge) = guide.near_edge.filter(|&edge| !self.is_at_vertex(edge)) {
            edges.push(self.special_edge(edge, T::reach(scaled(s, along)), &view));
        }
        let [weight, first, second, own] = self.sums(&edges, &view, guide);
        let total = own.plus(Dual([s, T::of(1.0), (skew * s).opposite()]).times(weight));
        let rest = [first.over(total), second.over(total)];
        self.assemble(&view, rest, &guide.linear)
    }

    /// Sums of weights, and of weights times residuals, of all vertices but `v`; and the weight of `v`, times `s`. All
    /// times the factors of all special edges.
    fn sums(&self, edges: &[Special<T>], view: &View<T>, guide: &Guide) -> [Dual<T>; 4] {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let distance = guide.near_vertex.map(|vertex| {
            let [x, y] = minus(self.offsets[vertex][0], scaled(view.s, view.along));
            view.chain(T::length(x, y), opposite(self.sights[vertex].unit))
        });
        let whole = edges.iter().fold(Dual([one, zero, zero]), |all, edge| all.with(edge.factor));
        let [others, near] = self.regular_sums(guide);
        let chained = |[value, x, y]: [T; 3]| view.chain(value, [x, y]);
        let regular = |k: usize| whole.times(chained(others[k]).with(distance).plus(chained(near[k])));
        let [mut weight, mut first, mut second] = [regular(0), regular(1), regular(2)];
        let mut own = Dual([zero; 3]);
        for (number, edge) in edges.iter().enumerate() {
            let factors = edges.iter().enumerate().filter(|(other, _)| *other != number);
            let tangent = factors.fold(edge.tangent, |product, (_, other)| product.with(other.factor));
            for k in edge.ends.into_iter().flatten() {
                let Sight { inverse, pull, .. } = self.sights[k];
                let share = if guide.near_vertex == Some(k) {
                    tangent
                } else {
                    tangent.times(view.chain(inverse, scaled(inverse, pull)).with(distance))
                };
                let [x, y] = self.residual(k, &guide.linear);
                weight = weight.plus(share);
                first = first.plus(share.times_constant(x));
                second = second.plus(share.times_constant(y));
            }
            if edge.ends.iter().flatten().count() == 1 {
                own = own.plus(tangent.over(view.length).with(distance));
            }
        }
        [weight, first, second, own]
    }

    /// From `G` to the map: `f = image of v + s (M e + G)`.
    fn assemble(&self, view: &View<T>, rest: [Dual<T>; 2], linear: &Linear) -> Local<T> {
        let s = view.s;
        let value: Vector<T> = std::array::from_fn(|k| rest[k].0[0]);
        let by_s: Vector<T> = std::array::from_fn(|k| rest[k].0[0] + s * rest[k].0[1]);
        let by_across: Vector<T> = std::array::from_fn(|k| rest[k].0[2] - view.skew * rest[k].0[0]);
        let axes = [view.along, view.across];
        let [along, across] = axes.map(|axis| apply(linear, axis));
        // det(M e + g, M e' + h), where det(M e, M e') is det M times that of the axes, which is constant.
        let mixed = cross(along, by_across) + cross(by_s, across) + cross(by_s, by_across);
        let own = cross(of::<T>(linear[0]), of(linear[1]));
        let at = of::<T>(self.step.images[self.chart.corners[0] as usize]);
        Local {
            image: plus(at, scaled(s, plus(along, value))),
            determinant: own + mixed / self.turn,
            columns: [plus(along, by_s), plus(across, by_across)],
            axes,
        }
    }

    fn neighbour(&self, touch: Touch) -> usize {
        let v = self.chart.corners[0] as usize;
        (if touch == Touch::Next { self.step.next[v] } else { self.step.previous[v] }) as usize
    }

    /// The number of an edge at `v`: that of its first vertex.
    fn edge_at_vertex(&self, touch: Touch) -> usize {
        if touch == Touch::Next { self.chart.corners[0] as usize } else { self.neighbour(touch) }
    }

    fn is_at_vertex(&self, edge: usize) -> bool {
        let v = self.chart.corners[0] as usize;
        edge == v || self.step.next[edge] as usize == v
    }

    /// How far a vertex misses its image under the linear map.
    #[inline(always)]
    fn residual(&self, vertex: usize, linear: &Linear) -> Vector<T> {
        let [offset, image] = self.offsets[vertex];
        minus(image, apply(linear, offset))
    }

    /// Looks at all vertices and edges from `v + offset`; at `v` itself in the direction `towards`.
    fn look(&mut self, offset: Vector<T>, towards: Vector<T>, near_edge: Option<usize>) {
        let v = self.chart.corners[0] as usize;
        for (sight, [at, _]) in self.sights.iter_mut().zip(&self.offsets) {
            *sight = T::sight(minus(*at, offset), offset);
        }
        self.sights[v] = Sight { unit: towards, inverse: T::of(0.0), pull: of([0.0; 2]), slack: 0.0 };
        let (half, reach) = (T::of(0.5), T::reach(offset));
        for (i, tangent) in self.tangents.iter_mut().enumerate() {
            let k = self.step.next[i] as usize;
            if i == v || k == v {
                continue;
            }
            if near_edge == Some(i) {
                *tangent = [T::of(0.0); 3];
                continue;
            }
            let (from, to) = (&self.sights[i], &self.sights[k]);
            // The difference of pulls 1 / conj(z) as a product: far edges are seen to be small.
            let turning = times(times(from.pull, to.pull), self.edges[i]);
            let t = T::half_tangent(from, to, turning, reach);
            let rate = half + half * (t * t);
            *tangent = [t, rate * turning[1], (rate * turning[0]).opposite()];
        }
    }

    /// Sums over all other vertices, of edges that are not special only: of the weights, and of weights times residuals; each
    /// with its gradient in the plane. First those of all vertices but a near one, then those of this, times its distance.
    fn regular_sums(&self, guide: &Guide) -> [[[T; 3]; 3]; 2] {
        let v = self.chart.corners[0] as usize;
        let mut sums = [[[T::of(0.0); 3]; 3]; 2];
        for (i, sight) in self.sights.iter().enumerate() {
            if i == v {
                continue;
            }
            let (before, after) = (&self.tangents[self.step.previous[i] as usize], &self.tangents[i]);
            let tangent: [T; 3] = std::array::from_fn(|k| before[k] + after[k]);
            let is_near = guide.near_vertex == Some(i);
            let weight = if is_near {
                tangent
            } else {
                let [value, x, y] = tangent;
                [value, x + value * sight.pull[0], y + value * sight.pull[1]].map(|c| sight.inverse * c)
            };
            let [x, y] = self.residual(i, &guide.linear);
            let sums = &mut sums[usize::from(is_near)];
            for k in 0..3 {
                sums[0][k] = sums[0][k] + weight[k];
                sums[1][k] = sums[1][k] + weight[k] * x;
                sums[2][k] = sums[2][k] + weight[k] * y;
            }
        }
        sums
    }

    /// An edge that does not end at `v`, times the sine of its angle.
    fn special_edge(&self, edge: usize, reach: f64, view: &View<T>) -> Special<T> {
        let other = self.step.next[edge] as usize;
        let (from, to) = (&self.sights[edge], &self.sights[other]);
        let turning = times(times(from.pull, to.pull), self.edges[edge]);
        let [sine, cosine] = T::sine_cosine(from, to, turning, reach);
        let angle = view.chain(T::of(0.0), [turning[1], turning[0].opposite()]);
        Special::near(sine, cosine, angle, [Some(edge), Some(other)])
    }

    /// An edge that ends at `v`; if the chart touches it, times `λ`, which cancels.
    fn special_at_vertex(&self, touch: Touch, view: &View<T>, lambda: T, is_near: bool) -> Special<T> {
        let k = self.neighbour(touch);
        let ends = [Some(k), None];
        let Sight { unit, inverse, pull, .. } = self.sights[k];
        let View { s, along, across, skew, length: Dual([size, _, growth]) } = *view;
        if self.chart.touch == touch {
            // (|e| r + e . there) / |2 turn|.
            let there = minus(self.offsets[k][0], scaled(s, along));
            let distance = T::of(1.0) / inverse;
            let value = size * distance + dot(along, there);
            let by_s = (size * dot(unit, along) + size * size).opposite();
            let side = self.axes[1];
            let by_lambda = growth * distance - s * (size * dot(unit, side)) + dot(side, there) - s * dot(along, side);
            let by_across = by_lambda - skew * (s * by_s);
            let sign = if touch == Touch::Next { 2.0 } else { -2.0 };
            let divisor = T::of(sign) * self.turn;
            let factor = Some(Dual([lambda, T::of(0.0), T::of(1.0)]));
            return Special { factor, tangent: Dual([value, by_s, by_across].map(|c| c / divisor)), ends };
        }
        let towards = self.sights[self.chart.corners[0] as usize].unit;
        let turning = s * cross(across, pull) - self.turn / (size * size);
        let angle = Dual([T::of(0.0), cross(along, pull), turning]);
        let (from, to, angle) = match touch {
            Touch::Next => (towards, unit, angle),
            _ => (unit, towards, Dual(angle.0.map(T::opposite))),
        };
        if is_near {
            let [sine, cosine] = sine_cosine(from, to);
            return Special::near(sine, cosine, angle, ends);
        }
        let t = half_tangent(from, to);
        let rate = T::of(0.5) + T::of(0.5) * (t * t);
        Special { factor: None, tangent: Dual([t, rate * angle.0[1], rate * angle.0[2]]), ends }
    }
}

/// An edge that is treated by itself: its half tangent times a factor that makes it smooth.
struct Special<T> {
    /// What all other edges are multiplied by; `None` for one.
    factor: Option<Dual<T>>,
    /// The half tangent times the factor.
    tangent: Dual<T>,
    /// Its ends but `v`.
    ends: [Option<usize>; 2],
}

impl<T: Number> Special<T> {
    /// With the sine as factor: `sin α tan(α / 2) = 1 - cos α`.
    fn near(sine: T, cosine: T, Dual([_, by_s, by_lambda]): Dual<T>, ends: [Option<usize>; 2]) -> Self {
        let factor = Some(Dual([sine, cosine * by_s, cosine * by_lambda]));
        Self { factor, tangent: Dual([T::of(1.0) - cosine, sine * by_s, sine * by_lambda]), ends }
    }
}

/// Where one looks from.
struct View<T> {
    s: T,
    /// `e`, and `q - p - skew e`.
    along: Vector<T>,
    across: Vector<T>,
    skew: T,
    /// Of `e`.
    length: Dual<T>,
}

impl<T: Number> View<T> {
    /// A function of the plane by `s` and `λ`.
    fn chain(&self, value: T, gradient: Vector<T>) -> Dual<T> {
        Dual([value, dot(self.along, gradient), self.s * dot(self.across, gradient)])
    }
}

fn apply<T: Number>(linear: &Linear, vector: Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| T::of(linear[k][0]) * vector[0] + T::of(linear[k][1]) * vector[1])
}

impl Frame<'_, Ball> {
    /// A guide for the surroundings of a point of the chart.
    pub fn guide(&self, s: f64, lambda: f64) -> Guide {
        let axis = |axis: usize, k: usize| self.axes[axis][k].middle;
        let at: Point2 = std::array::from_fn(|k| s * (axis(0, k) + lambda * axis(1, k)));
        let there = |i: usize| -> Point2 { std::array::from_fn(|k| self.offsets[i][0][k].middle - at[k]) };
        let (linear, near_vertex, nearest) = self.fit(at);
        let mut near = (0.0, None);
        for i in 0..self.offsets.len() {
            let k = self.step.next[i] as usize;
            let (a, b) = (there(i), there(k));
            let product = dot(a, b);
            if product < 0.0 {
                let square = product * product / (dot(a, a) * dot(b, b));
                let is_touched = match self.chart.touch {
                    Touch::Nothing => false,
                    touch => self.edge_at_vertex(touch) == i,
                };
                if square > near.0 && !is_touched {
                    near = (square, Some(i));
                }
            }
        }
        Guide { linear, near_edge: near.1, near_vertex, nearest }
    }

    /// A linear map that takes vertices near a point close to their images, and how near the nearest vertex but `v` is.
    /// Least squares, weighted by the inverse fourth power of distances.
    fn fit(&self, at: Point2) -> (Linear, Option<usize>, f64) {
        let v = self.chart.corners[0] as usize;
        let mut nearest = (f64::INFINITY, None);
        let (mut normal, mut mixed) = ([0.0; 3], [[0.0; 2]; 2]);
        for (i, &[offset, image]) in self.offsets.iter().enumerate() {
            if i == v {
                continue;
            }
            let ([x, y], image) = (offset.map(|c| c.middle), image.map(|c| c.middle));
            let square = (x - at[0]) * (x - at[0]) + (y - at[1]) * (y - at[1]);
            if square < nearest.0 {
                nearest = (square, Some(i));
            }
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
        (if is_good { linear } else { Guide::NONE.linear }, nearest.1, nearest.0.sqrt())
    }
}
