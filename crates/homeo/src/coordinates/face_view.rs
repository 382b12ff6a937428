//! A triangle as it is seen from a point: what integrals of `lambda_i / r` over the directions to it are made of.
//!
//! Let `h` be the height of the point over the plane of the triangle, `q` its foot, `r` the distance to a point `y` of the
//! triangle. The directions to an element of area `dA` fill a solid angle `h dA / r^3`, so that the mean value weights are
//!
//! `w_i = h * integral of lambda_i / r^4 dA`, with `lambda_i(y) = lambda_i(q) + grad lambda_i . (y - q)`.
//!
//! Both parts are integrals over edges. With the signed distance `b` of `q` from an edge (positive on the inner side),
//! `d^2 = b^2 + h^2`, the outer normal `nu` and the angle `theta` at which the point sees the edge, by the divergence theorem
//!
//! * `integral of (y - q) / r^4 = -1/2 sum nu theta / d`, and
//! * `integral of 1 / r^4 = 1/(2 h^2) sum b theta / d`.
//!
//! The last sum is a small difference of large numbers where the point lies beside the triangle and almost in its plane.
//! There `q` is outside, the angles `alpha` at which `q` sees the edges sum to zero, and so
//!
//! * `integral of 1 / r^4 = -1/2 sum b J`, with `J = (alpha / b - theta / d) / h^2`.
//!
//! Both angles are written by tangents of their halves, `L b / S'` and `L d / S` with `S = r_1 r_2 + p_1 . p_2` and `S'`
//! likewise in the plane. Then `h^2` divides out in closed form: what is left has no singularity at `h = 0` nor at `b = 0`.

use super::accurate::{cross, difference, product};
use super::real::Real;
use super::vectors::{minus, norm, scalar_product, vector_product};

pub(super) type Point3 = [f64; 3];

/// Below this share of the distance from the triangle a height counts as small.
const LOW: f64 = 0.1;

/// Heights below this are replaced by it where they are divided by; coordinates differ by as much.
const LEAST_HEIGHT: f64 = 1e-60;

/// A triangle, counter-clockwise as seen from outside. Edge `k` is opposite corner `k`.
#[derive(Clone, Debug)]
pub(super) struct Face {
    pub corners: [usize; 3],
    pub places: [Point3; 3],
    pub normal: Point3,
    /// The normal times the double area, in pairs of numbers.
    area_vector: [(f64, f64); 3],
    pub double_area: f64,
    pub lengths: [f64; 3],
    /// Of each edge the unit normal in the plane, outwards.
    pub outer: [Point3; 3],
}

/// The weights of the three corners: `Low` still to be multiplied by the height, `High` to be divided by it.
pub(super) enum Weights<T> {
    Low([T; 3]),
    High([T; 3]),
}

/// An edge as it is seen from a point.
struct EdgeView<T> {
    length: f64,
    /// Distance of the foot from the line, signed.
    inset: T,
    square_distance: T,
    dot: T,
    radii: [T; 2],
    /// `theta / d`.
    spread: T,
    /// `S = r_1 r_2 + p_1 . p_2`.
    span: T,
}

/// A triangle as it is seen from a point.
pub(super) struct FaceView<T> {
    /// Positive on the inner side.
    pub height: T,
    edges: [EdgeView<T>; 3],
}

impl Face {
    pub fn new(corners: [usize; 3], places: [Point3; 3]) -> Self {
        let [a, b, c] = places;
        let area_vector = [[1, 2], [2, 0], [0, 1]].map(|[k, l]| wide_cross(a, b, c, k, l));
        let rounded = area_vector.map(|(high, _)| high);
        let double_area = norm(rounded);
        let normal = rounded.map(|x| x / double_area);
        let edge = |k: usize| minus(places[(k + 2) % 3], places[(k + 1) % 3]);
        let lengths = [0, 1, 2].map(|k| norm(edge(k)));
        let outer = [0, 1, 2].map(|k| vector_product(edge(k), normal).map(|x| x / lengths[k]));
        Self { corners, places, normal, area_vector, double_area, lengths, outer }
    }

    /// The triangle as it is seen from a point that is none of its corners.
    pub fn view<T: Real<3>>(&self, point: Point3) -> FaceView<T> {
        let offsets = self.places.map(|place| minus(place, point));
        let radii = offsets.map(|p| {
            let radius = norm(p);
            T::variable(radius, p.map(|x| -x / radius))
        });
        let height = T::variable(self.height(point), self.normal.map(|x| -x));
        let edges = [0, 1, 2].map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let area = area_vector::<T>(self.places[i], self.places[j], point);
            let length = self.lengths[k];
            let squares = area[0] * area[0] + area[1] * area[1] + area[2] * area[2];
            let along = area[0] * self.normal[0] + area[1] * self.normal[1] + area[2] * self.normal[2];
            let (p, q) = (offsets[i], offsets[j]);
            let dot = T::variable(scalar_product(p, q), [0, 1, 2].map(|m| -p[m] - q[m]));
            EdgeView::new(
                length,
                along * (1.0 / length),
                squares * (length * length).recip(),
                dot,
                [radii[i], radii[j]],
            )
        });
        FaceView { height, edges }
    }

    /// The distance from the plane to the last digits, positive on the inner side.
    fn height(&self, point: Point3) -> f64 {
        let mut sum = (0.0, 0.0);
        for (k, &normal) in self.area_vector.iter().enumerate() {
            sum = wide_sum(sum, wide_product(normal, difference(self.places[0][k], point[k])));
        }
        (sum.0 + sum.1) / self.double_area
    }

    /// `lambda_i` of the foot of a point, and the gradient of `lambda_i`.
    pub fn share(&self, i: usize, point: Point3) -> (f64, Point3) {
        let slope = self.outer[i].map(|x| -x * self.lengths[i] / self.double_area);
        (scalar_product(slope, minus(point, self.places[(i + 1) % 3])), slope)
    }
}

impl<T: Real<3>> EdgeView<T> {
    fn new(length: f64, inset: T, square_distance: T, dot: T, radii: [T; 2]) -> Self {
        let span = span(radii[0] * radii[1], dot, square_distance * (length * length));
        let square_tangent = square_distance * (length * length) / (span * span);
        let spread = arc_ratio(square_tangent) * (2.0 * length) / span;
        Self { length, inset, square_distance, dot, radii, spread, span }
    }

    /// `J = (alpha / b - theta / d) / h^2`, by `S`, `S'` and the divided difference of `atan(t) / t` in `t^2`.
    fn difference_of_angles(&self, square_height: T) -> T {
        let (square_length, square_inset) = (self.length * self.length, self.inset * self.inset);
        let squares = self.radii.map(|r| r * r - square_height);
        let (far, flat) = (self.radii[0] * self.radii[1], (squares[0] * squares[1]).sqrt());
        let flat_span = span(flat, self.dot - square_height, square_inset * square_length);
        // (S - S') / h^2.
        let growth = T::constant(1.0) + (squares[0] + squares[1] + square_height) / (far + flat);
        let flat_tangent = square_inset * square_length / (flat_span * flat_span);
        let tangent = self.square_distance * square_length / (self.span * self.span);
        let slope = arc_difference(flat_tangent, tangent);
        let inner = flat_span * flat_span - square_inset * growth * (self.span + flat_span);
        let second = slope * square_length * inner / (self.span * self.span * flat_span);
        (arc_ratio(flat_tangent) * growth + second) * (2.0 * self.length) / (self.span * flat_span)
    }

    /// Distance of the foot from the edge.
    fn foot_distance(&self, square_height: f64) -> f64 {
        let squares = self.radii.map(|r| r.value() * r.value());
        // The foot is beside the edge where both angles at its ends are acute.
        let is_beside = (squares[0] - squares[1]).abs() < self.length * self.length;
        if is_beside {
            return self.inset.value().abs();
        }
        (squares[0].min(squares[1]) - square_height).max(0.0).sqrt()
    }
}

impl<T: Real<3>> FaceView<T> {
    /// The mean value weights of the corners, as seen from the point.
    pub fn weights(&self, face: &Face) -> Weights<T> {
        let square_height = self.height * self.height;
        let half = T::constant(0.5);
        let turn = |i: usize| {
            let part = |e: usize| self.edges[e].spread * scalar_product(face.outer[i], face.outer[e]);
            (part(0) + part(1) + part(2)) * half
        };
        let scale = |i: usize| face.lengths[i] / face.double_area;
        if self.is_low(square_height.value()) {
            let part = |e: usize| self.edges[e].inset * self.edges[e].difference_of_angles(square_height);
            let mass = -(part(0) + part(1) + part(2)) * half;
            return Weights::Low([0, 1, 2].map(|i| (self.edges[i].inset * mass + turn(i)) * scale(i)));
        }
        let part = |e: usize| self.edges[e].inset * self.edges[e].spread;
        let mass = (part(0) + part(1) + part(2)) * half;
        Weights::High([0, 1, 2].map(|i| (self.edges[i].inset * mass + square_height * turn(i)) * scale(i)))
    }

    /// Twice what the areas of the triangles from the point to the edges exceed that of the triangle by: zero on it and
    /// positive off it, of the order of the square of the height.
    pub fn excess(&self) -> T {
        let square_height = self.height * self.height;
        let part = |edge: &EdgeView<T>| {
            // On the line of an edge there is a kink.
            let is_kink = edge.square_distance.value() < 1e-200;
            let distance = if is_kink { T::constant(0.0) } else { edge.square_distance.sqrt() };
            let gap =
                if edge.inset.value() > 0.0 { square_height / (distance + edge.inset) } else { distance - edge.inset };
            gap * edge.length
        };
        part(&self.edges[0]) + part(&self.edges[1]) + part(&self.edges[2])
    }

    /// The height, or a tiny one in place of none.
    pub fn divisor(&self) -> T {
        if self.height.value().abs() < LEAST_HEIGHT {
            return T::variable(LEAST_HEIGHT, self.height.gradient());
        }
        self.height
    }

    /// Of the edge that the point lies on, its number.
    pub fn edge_under(&self) -> Option<usize> {
        // Areas are exact to 1e-30 of the products that they are made of.
        let is_on = |edge: &EdgeView<T>| edge.dot.value() < 0.0 && edge.square_distance.value() < 1e-56;
        self.edges.iter().position(is_on)
    }

    /// Whether the foot lies outside, many heights away.
    fn is_low(&self, square_height: f64) -> bool {
        let is_inside = self.edges.iter().all(|edge| edge.inset.value() >= 0.0);
        let distance = || self.edges.iter().map(|e| e.foot_distance(square_height)).fold(f64::INFINITY, f64::min);
        !is_inside && square_height < LOW * LOW * distance().powi(2)
    }
}

/// `R + c`, with `R^2 - c^2` given for where they almost cancel.
fn span<T: Real<3>>(product: T, dot: T, difference_of_squares: T) -> T {
    if dot.value() >= 0.0 { product + dot } else { difference_of_squares / (product - dot) }
}

/// `atan(sqrt(u)) / sqrt(u)`.
fn arc_ratio<T: Real<3>>(u: T) -> T {
    let x = u.value();
    if x > 0.25 {
        let value = x.sqrt().atan() / x.sqrt();
        return u.chain(value, (1.0 / (1.0 + x) - value) / (2.0 * x));
    }
    let (mut value, mut slope) = (0.0, 0.0);
    for k in (0..=30).rev() {
        slope = value - x * slope;
        value = 1.0 / f64::from(2 * k + 1) - x * value;
    }
    // By Horner's rule in `-x`.
    u.chain(value, -slope)
}

/// `(A(u) - A(v)) / (v - u)` of the function above, for `u < v` close to one another.
fn arc_difference<T: Real<3>>(u: T, v: T) -> T {
    if u.value() > 0.25 {
        let (s, t) = (u.sqrt(), v.sqrt());
        let mixed = T::constant(1.0) + s * t;
        let turn = (v - u) / ((s + t) * mixed);
        return (arc_ratio(u) - arc_ratio(turn * turn) / mixed) / (t * (s + t));
    }
    let (mut powers, mut complete) = (T::constant(1.0), T::constant(1.0));
    let (mut sum, mut sign) = (T::constant(1.0 / 3.0), 1.0);
    for k in 2..=30 {
        powers = powers * v;
        complete = complete * u + powers;
        sign = -sign;
        sum = sum + complete * (sign / f64::from(2 * k + 1));
    }
    sum
}

/// `(a - x) x (b - x)`, each component to its last digits, with its gradient.
fn area_vector<T: Real<3>>(a: Point3, b: Point3, x: Point3) -> [T; 3] {
    let e = minus(b, a);
    let part = |k: usize, l: usize| cross([a[k], a[l]], [b[k], b[l]], [x[k], x[l]]);
    [
        T::variable(part(1, 2), [0.0, -e[2], e[1]]),
        T::variable(part(2, 0), [e[2], 0.0, -e[0]]),
        T::variable(part(0, 1), [-e[1], e[0], 0.0]),
    ]
}

/// One component of `(b - a) x (c - a)` as a pair of numbers.
fn wide_cross(a: Point3, b: Point3, c: Point3, k: usize, l: usize) -> (f64, f64) {
    let first = wide_product(difference(b[k], a[k]), difference(c[l], a[l]));
    let second = wide_product(difference(b[l], a[l]), difference(c[k], a[k]));
    wide_sum(first, (-second.0, -second.1))
}

fn wide_product(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let (high, low) = product(a.0, b.0);
    renormalised(high, low + (a.0 * b.1 + a.1 * b.0))
}

fn wide_sum(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let (high, low) = difference(a.0, -b.0);
    let (tail, rest) = difference(a.1, -b.1);
    let (high, low) = renormalised(high, low + tail);
    renormalised(high, low + rest)
}

fn renormalised(high: f64, low: f64) -> (f64, f64) {
    let sum = high + low;
    (sum, low - (sum - high))
}
