//! The formulas of the map in a chart: value and both derivatives, in doubles or in affine forms.

use homeo_core::planar::{PlanarDomain, Point2};

use super::dual::{Dual, cross, dot};
use super::guide::Guide;
use super::speed::EdgeSpeeds;
use crate::composite::number::Number;

type Vector<T> = [T; 2];

/// Vertices, their images and who follows whom.
#[derive(Clone, Debug)]
pub(super) struct Outline {
    pub vertices: Vec<Point2>,
    pub images: Vec<Point2>,
    pub next: Vec<usize>,
    pub previous: Vec<usize>,
}

impl Outline {
    pub fn new(source: &PlanarDomain, target: &PlanarDomain) -> Self {
        let mut next = Vec::new();
        for ring in source.rings() {
            let begin = next.len();
            next.extend((0..ring.len()).map(|i| begin + (i + 1) % ring.len()));
        }
        let mut previous = vec![0; next.len()];
        next.iter().enumerate().for_each(|(i, &k)| previous[k] = i);
        Self { vertices: source.vertices().collect(), images: target.vertices().collect(), next, previous }
    }

    pub fn count(&self) -> usize {
        self.vertices.len()
    }
}

/// Where the coordinates of a box lie.
#[derive(Clone, Copy, Debug)]
pub(super) enum Chart<T> {
    /// Coordinates are those of the plane.
    Plane,
    /// `v + s (a + λ (b - a))` for a vertex `v`.
    Corner { vertex: usize, a: Vector<T>, b: Vector<T> },
}

/// What a chart shows of the map at a point or in a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local<T> {
    pub value: Vector<T>,
    /// Derivatives along two vectors: the axes of the plane; `e = a + λ (b - a)` and `b - a` in a corner.
    pub along: [Vector<T>; 2],
    /// The cross product of these vectors.
    pub turn: T,
}

impl<T: Number> Local<T> {
    /// The Jacobian determinant.
    pub fn determinant(&self) -> T {
        let [a, b] = self.along;
        (a[0] * b[1] - a[1] * b[0]) / self.turn
    }
}

/// What does not depend on the point, and room for what does.
pub(super) struct Frame<'a, T> {
    outline: &'a Outline,
    /// `e_i / |e_i|^2`, and the same of images: `h_{i+1} - h_i`.
    directions: Vec<[Vector<T>; 2]>,
    /// Of each edge the coefficients of `(σ(t) - t) / (t (1 - t))`.
    quotients: Vec<Vec<T>>,
    seen: Vec<Seen<T>>,
    tangents: Vec<Dual<T>>,
    /// The factor of the tangents, and the sum of all weights, where the map was evaluated last.
    factor: Dual<T>,
    weight: Dual<T>,
}

/// A vertex as seen from the point; its own vertex in a corner with everything over `s`.
#[derive(Clone, Copy)]
struct Seen<T> {
    offset: [Dual<T>; 2],
    unit: [Dual<T>; 2],
    /// One over the distance.
    inverse: Dual<T>,
}

/// Sums over vertices and edges.
struct Sums<T> {
    numerator: [Dual<T>; 2],
    weight: Dual<T>,
}

fn difference<T: Number>(a: Point2, b: Point2) -> Vector<T> {
    std::array::from_fn(|k| T::of(a[k]) - T::of(b[k]))
}

fn apply<T: Number>(linear: [[f64; 2]; 2], v: Vector<T>) -> Vector<T> {
    linear.map(|row| T::of(row[0]) * v[0] + T::of(row[1]) * v[1])
}

/// The coordinates of a corner as functions of themselves: `s`, and both coordinates of `e = a + λ (b - a)`.
fn polar<T: Number>([a, b]: [Vector<T>; 2], [s, lambda]: Vector<T>) -> [Dual<T>; 3] {
    let (zero, one) = (T::of(0.0), T::of(1.0));
    let e = |k: usize| {
        let across = b[k] - a[k];
        Dual { value: a[k] + lambda * across, by: [zero, across] }
    };
    [Dual { value: s, by: [one, zero] }, e(0), e(1)]
}

impl<'a, T: Number> Frame<'a, T> {
    pub fn new(outline: &'a Outline, speeds: &EdgeSpeeds) -> Self {
        let quotients = (0..outline.count()).map(|i| speeds.quotient(i)).collect();
        Self::with_quotients(outline, quotients)
    }

    pub fn with_quotients(outline: &'a Outline, quotients: Vec<Vec<T>>) -> Self {
        let direction = |i: usize| {
            let k = outline.next[i];
            let [x, y]: Vector<T> = difference(outline.vertices[k], outline.vertices[i]);
            let square = x * x + y * y;
            [[x / square, y / square], difference(outline.images[k], outline.images[i])]
        };
        let directions = (0..outline.count()).map(direction).collect();
        let one = Dual::constant(T::of(1.0));
        Self { outline, directions, quotients, seen: Vec::new(), tangents: Vec::new(), factor: one, weight: one }
    }

    pub fn quotients_mut(&mut self) -> &mut [Vec<T>] {
        &mut self.quotients
    }

    /// The map in a chart.
    pub fn evaluate(&mut self, chart: &Chart<T>, at: Vector<T>, guide: &Guide) -> Local<T> {
        match *chart {
            Chart::Plane => self.in_plane(at, guide),
            Chart::Corner { vertex, a, b } => self.in_corner(vertex, [a, b], at, guide),
        }
    }

    /// How the derivatives change with the quotient of an edge, where the map was evaluated last, with other quotients: they
    /// are linear in all of them.
    pub fn response(&self, edge: usize, chart: &Chart<T>, at: Vector<T>) -> [Vector<T>; 2] {
        let corner = match *chart {
            Chart::Plane => None,
            Chart::Corner { vertex, a, b } => {
                let [s, x, y] = polar([a, b], at);
                Some((vertex, s, [x, y]))
            }
        };
        let rest = self.correction(edge, corner, self.factor).map(|n| n / self.weight);
        match corner {
            None => [0, 1].map(|l| rest.map(|r| r.by[l])),
            Some((_, s, _)) => [rest.map(|r| r.value + s.value * r.by[0]), rest.map(|r| r.by[1])],
        }
    }

    /// `h = k + M (z - o) + N / W`.
    fn in_plane(&mut self, at: Vector<T>, guide: &Guide) -> Local<T> {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let variable = |k: usize| Dual { value: at[k], by: if k == 0 { [one, zero] } else { [zero, one] } };
        let point = [variable(0), variable(1)];
        let outline = self.outline;
        self.look(|i| std::array::from_fn(|k| Dual::constant(T::of(outline.vertices[i][k])) - point[k]));
        let factor = self.measure_angles(guide.wide);
        let sums = self.sum(None, factor, guide);
        (self.factor, self.weight) = (factor, sums.weight);
        let rest = sums.numerator.map(|n| n / sums.weight);
        let base = apply(guide.linear, std::array::from_fn(|k| at[k] - T::of(guide.origin[k])));
        let column = |l: usize| std::array::from_fn(|k| T::of(guide.linear[k][l]) + rest[k].by[l]);
        Local {
            value: std::array::from_fn(|k| T::of(guide.image[k]) + base[k] + rest[k].value),
            along: [column(0), column(1)],
            turn: one,
        }
    }

    /// `h = h_v + s (M e + G)`, `G = N / (s W)`; derivatives are `M e + G + s G_s` and `M (b - a) + G_λ`.
    fn in_corner(&mut self, vertex: usize, [a, b]: [Vector<T>; 2], [s, lambda]: Vector<T>, guide: &Guide) -> Local<T> {
        let across: Vector<T> = std::array::from_fn(|k| b[k] - a[k]);
        let [s, x, y] = polar([a, b], [s, lambda]);
        let e = [x, y];
        let outline = self.outline;
        self.look(|i| {
            let far: Vector<T> = difference(outline.vertices[i], outline.vertices[vertex]);
            std::array::from_fn(|k| if i == vertex { -e[k] } else { Dual::constant(far[k]) - s * e[k] })
        });
        let factor = self.measure_angles(guide.wide);
        let sums = self.sum(Some((vertex, s, e)), factor, guide);
        (self.factor, self.weight) = (factor, sums.weight);
        let rest = sums.numerator.map(|n| n / sums.weight);
        let e = e.map(|c| c.value);
        let (along_e, along_side) = (apply(guide.linear, e), apply(guide.linear, across));
        let image = outline.images[vertex];
        Local {
            value: std::array::from_fn(|k| T::of(image[k]) + s.value * (along_e[k] + rest[k].value)),
            along: [
                std::array::from_fn(|k| along_e[k] + rest[k].value + s.value * rest[k].by[0]),
                std::array::from_fn(|k| along_side[k] + rest[k].by[1]),
            ],
            turn: a[0] * b[1] - a[1] * b[0],
        }
    }

    fn look(&mut self, offset: impl Fn(usize) -> [Dual<T>; 2]) {
        let one = Dual::constant(T::of(1.0));
        self.seen.clear();
        self.seen.extend((0..self.outline.count()).map(|i| {
            let offset = offset(i);
            let inverse = one / Dual::length(offset);
            Seen { offset, unit: offset.map(|c| c * inverse), inverse }
        }));
    }

    /// Tangents of half the angles of all edges, times the factor that is returned: the sine of the angle of the wide
    /// edge, or 1.
    fn measure_angles(&mut self, wide: Option<usize>) -> Dual<T> {
        let one = Dual::constant(T::of(1.0));
        let units = |i: usize| (self.seen[i].unit, self.seen[self.outline.next[i]].unit);
        let factor = wide.map(|i| {
            let (u, v) = units(i);
            cross(u, v)
        });
        self.tangents.clear();
        self.tangents.extend((0..self.outline.count()).map(|i| {
            let (u, v) = units(i);
            let cosine = dot(u, v);
            if wide == Some(i) {
                return one - cosine;
            }
            let sine = cross(u, v);
            let tangent = if cosine.value.near() < 0.0 { (one - cosine) / sine } else { sine / (one + cosine) };
            factor.map_or(tangent, |factor| factor * tangent)
        }));
        factor.unwrap_or(one)
    }

    /// `N` and `W`, or `s W` in a corner, both times the factor.
    fn sum(&self, corner: Option<(usize, Dual<T>, [Dual<T>; 2])>, factor: Dual<T>, guide: &Guide) -> Sums<T> {
        let mut sums = Sums { numerator: [Dual::constant(T::of(0.0)); 2], weight: Dual::constant(T::of(0.0)) };
        let outline = self.outline;
        for i in 0..outline.count() {
            let weight = (self.tangents[outline.previous[i]] + self.tangents[i]) * self.seen[i].inverse;
            match corner {
                // Its datum is zero.
                Some((vertex, ..)) if vertex == i => sums.weight = sums.weight + weight,
                Some((_, s, _)) => sums.weight = sums.weight + s * weight,
                None => sums.weight = sums.weight + weight,
            }
            if corner.is_none_or(|(vertex, ..)| vertex != i) {
                let offset = apply(guide.linear, difference(outline.vertices[i], guide.origin));
                let image: Vector<T> = difference(outline.images[i], guide.image);
                for k in 0..2 {
                    sums.numerator[k] = sums.numerator[k] + weight.times(image[k] - offset[k]);
                }
            }
            if !self.quotients[i].is_empty() {
                let [x, y] = self.correction(i, corner, factor);
                sums.numerator = [sums.numerator[0] + x, sums.numerator[1] + y];
            }
        }
        sums
    }

    /// `γ_i (h_{i+1} - h_i) (σ_i(x) - x)` of an edge, where `x` is the place of the point along it; in a corner at one of
    /// its ends `s γ_i` is multiplied by `(σ_i(x) - x) / s`.
    fn correction(&self, i: usize, corner: Option<(usize, Dual<T>, [Dual<T>; 2])>, factor: Dual<T>) -> [Dual<T>; 2] {
        let one = Dual::constant(T::of(1.0));
        let k = self.outline.next[i];
        let [direction, image] = self.directions[i];
        let place = |v: [Dual<T>; 2]| v[0].times(direction[0]) + v[1].times(direction[1]);
        let (mut own, mut after) = (self.seen[i].inverse, self.seen[k].inverse);
        let (x, product) = match corner {
            Some((vertex, s, e)) if vertex == i => {
                let rate = place(e);
                after = s * after;
                (s * rate, rate * (one - s * rate))
            }
            Some((vertex, s, e)) if vertex == k => {
                let rate = -place(e);
                own = s * own;
                (one - s * rate, rate * (one - s * rate))
            }
            _ => {
                let x = -place(self.seen[i].offset);
                (x, x * (one - x))
            }
        };
        let deviation = product * self.quotient(i, x);
        let real = self.tangents[i] * (own + after) * deviation;
        let imaginary = factor * (after - own) * deviation;
        [real.times(image[0]) - imaginary.times(image[1]), real.times(image[1]) + imaginary.times(image[0])]
    }

    /// `(σ_i(x) - x) / (x (1 - x))`, expanded about a number near `x`, so that in a box powers of small numbers are taken.
    fn quotient(&self, i: usize, x: Dual<T>) -> Dual<T> {
        let mut shifted = [T::of(0.0); 8];
        let coefficients = &self.quotients[i];
        let count = coefficients.len();
        shifted[..count].copy_from_slice(coefficients);
        let near = T::of(x.value.near());
        for begin in 0..count {
            for k in (begin..count - 1).rev() {
                shifted[k] = shifted[k] + near * shifted[k + 1];
            }
        }
        let rest = x - Dual::constant(near);
        shifted[..count].iter().rev().fold(Dual::constant(T::of(0.0)), |sum, &c| sum * rest + Dual::constant(c))
    }
}
