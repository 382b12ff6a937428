//! Pieces that cover a domain: triangles about its vertices, in corners, and squares of the plane for the rest.

use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::predicate::{Sign, orient2d};

use super::frame::{Chart, Outline};
use crate::composite::number::{Form, Number};

/// A corner's triangles reach so far, as a part of the distance to the nearest other edge or vertex.
const REACH: f64 = 0.4;
/// The angle of a corner is cut into parts of no more than this, in radians.
const WIDEST_PART: f64 = 1.0;
/// What is rounded in distances here is far less than this part of them.
const SAFE: f64 = 0.99;
/// Squares along the longer side of the domain, to begin with.
const SQUARES: usize = 8;

/// A part of the domain, to be bounded by itself.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub chart: Chart<Form>,
    pub sides: [[f64; 2]; 2],
}

/// The pieces, and the disks about vertices in which triangles cover the domain.
pub(super) struct Cover {
    pub pieces: Vec<Piece>,
    /// Radius of the disk about each vertex.
    pub disks: Vec<f64>,
}

impl Cover {
    pub fn new(outline: &Outline, domain: &PlanarDomain) -> Self {
        let mut cover = Self { pieces: Vec::new(), disks: Vec::with_capacity(outline.count()) };
        for vertex in 0..outline.count() {
            cover.add_corner(outline, vertex);
        }
        cover.add_squares(domain);
        cover
    }

    /// Triangles with an apex at a vertex, between its edges. The first and the last vector are exact parts of the edges,
    /// enclosed, so nothing is left out; the triangles hold all of the corner within the distance of their far sides.
    fn add_corner(&mut self, outline: &Outline, vertex: usize) {
        let (before, after) = (outline.previous[vertex], outline.next[vertex]);
        let v = outline.vertices[vertex];
        let others = (0..outline.count()).filter(|&i| i != vertex && i != before);
        let distance = |i: usize| from_segment(v, [outline.vertices[i], outline.vertices[outline.next[i]]]);
        let clear = others.map(distance).fold(f64::INFINITY, f64::min);
        let ends = [after, before].map(|i| shortened(v, outline.vertices[i], REACH * clear));
        let middle = |end: &[Form; 2]| end.map(|c| c.middle);
        let [first, last] = [middle(&ends[0]), middle(&ends[1])];
        let from = first[1].atan2(first[0]);
        let angle = (last[1].atan2(last[0]) - from).rem_euclid(std::f64::consts::TAU);
        let parts = (angle / WIDEST_PART).ceil().max(1.0) as usize;
        let length = first[0].hypot(first[1]).min(last[0].hypot(last[1]));
        let inner = |k: usize| {
            let (y, x) = (from + angle * k as f64 / parts as f64).sin_cos();
            [length * x, length * y].map(Form::of)
        };
        let vectors: Vec<[Form; 2]> = (0..=parts)
            .map(|k| {
                if k == 0 {
                    ends[0]
                } else if k == parts {
                    ends[1]
                } else {
                    inner(k)
                }
            })
            .collect();
        let mut reach = f64::INFINITY;
        for pair in vectors.windows(2) {
            let chart = Chart::Corner { vertex, a: pair[0], b: pair[1] };
            self.pieces.push(Piece { chart, sides: [[0.0, 1.0]; 2] });
            reach = reach.min(from_segment([0.0; 2], [middle(&pair[0]), middle(&pair[1])]));
        }
        // In a needle rounding may take the angle for a whole turn less: then nothing is said to be covered.
        let is_misjudged = match orient2d(outline.vertices[before], v, outline.vertices[after]) {
            Sign::Positive => angle > 4.0,
            Sign::Negative => angle < 2.0,
            Sign::Zero => false,
        };
        self.disks.push(if is_misjudged { 0.0 } else { SAFE * reach });
    }

    /// Squares over the bounding box; those outside are dropped later.
    fn add_squares(&mut self, domain: &PlanarDomain) {
        let [low, high] = domain.bounds();
        let size = [high[0] - low[0], high[1] - low[1]];
        let counts = size.map(|s| (SQUARES as f64 * s / size[0].max(size[1])).ceil().max(1.0) as usize);
        let side = |axis: usize, k: usize| {
            let at = |k: usize| match k == counts[axis] {
                true => high[axis],
                false => low[axis] + size[axis] * (k as f64 / counts[axis] as f64),
            };
            [at(k), at(k + 1)]
        };
        for x in 0..counts[0] {
            for y in 0..counts[1] {
                self.pieces.push(Piece { chart: Chart::Plane, sides: [side(0, x), side(1, y)] });
            }
        }
    }
}

impl Piece {
    /// Where a point of the chart is, rounded.
    pub fn place(&self, outline: &Outline, [s, lambda]: [f64; 2]) -> Point2 {
        match &self.chart {
            Chart::Plane => [s, lambda],
            Chart::Corner { vertex, .. } => {
                let (v, e) = (outline.vertices[*vertex], self.direction(lambda));
                [v[0] + s * e[0], v[1] + s * e[1]]
            }
        }
    }

    /// The vector that a corner's second coordinate stands for, rounded; nothing in the plane.
    pub fn direction(&self, lambda: f64) -> Point2 {
        match &self.chart {
            Chart::Plane => [0.0; 2],
            Chart::Corner { a, b, .. } => [0, 1].map(|k| a[k].middle + lambda * (b[k].middle - a[k].middle)),
        }
    }

    /// The vertex of a corner.
    pub fn vertex(&self) -> Option<usize> {
        match self.chart {
            Chart::Plane => None,
            Chart::Corner { vertex, .. } => Some(vertex),
        }
    }

    /// The chart in doubles.
    pub fn rounded(&self) -> Chart<f64> {
        match self.chart {
            Chart::Plane => Chart::Plane,
            Chart::Corner { vertex, a, b } => Chart::Corner { vertex, a: a.map(|c| c.middle), b: b.map(|c| c.middle) },
        }
    }
}

/// An exact part, `2^-k`, of the vector from one vertex to another, no longer than `reach`; enclosed.
fn shortened(from: Point2, to: Point2, reach: f64) -> [Form; 2] {
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let halvings = (length / reach).log2().ceil().clamp(1.0, 200.0) as i32;
    let factor = Form::of(0.5f64.powi(halvings));
    std::array::from_fn(|k| (Form::of(to[k]) - Form::of(from[k])) * factor)
}

/// How far a point is from a segment, rounded.
fn from_segment(point: Point2, [p, q]: [Point2; 2]) -> f64 {
    let (e, d) = ([q[0] - p[0], q[1] - p[1]], [point[0] - p[0], point[1] - p[1]]);
    let share = ((e[0] * d[0] + e[1] * d[1]) / (e[0] * e[0] + e[1] * e[1])).clamp(0.0, 1.0);
    (d[0] - share * e[0]).hypot(d[1] - share * e[1])
}
