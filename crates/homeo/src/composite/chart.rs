//! Charts of a tiled domain in which a mean value map has no singularity.
//!
//! A chart is a triangle: the points `v + s e(λ)` with `e(λ) = p - v + λ (q - p)`, for `s` and `λ` from 0 to 1. Its apex `v`
//! is the only vertex of the domain in it, if there is one. What is singular in the formulas of mean value coordinates, at
//! the vertex and, if the side to `p` is part of an edge of the domain, along `λ = 0`, cancels by hand; the proof is in
//! `docs/theory/composite.md`. What is left is analytic on the closed chart, so that it is evaluated, with its derivatives,
//! in doubles and in affine forms by one text, [`Frame::evaluate`](super::frame::Frame::evaluate).

use homeo_core::number::Rational;
use homeo_core::planar::{PlanarDomain, Point2};

use super::number::{Form, Number};
use super::triangulation::{Tiling, next_vertices};
use crate::complex::EdgeSpeeds;

/// Which edge of the domain a chart touches along `λ = 0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Touch {
    /// None: only the vertex is on the boundary, if anything.
    Nothing,
    /// The edge from the vertex to the next one of its ring.
    Next,
    /// The edge from the vertex before.
    Previous,
}

/// Which part of its triangle a chart is: where `p` and `q` are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// The triangle, where at most the apex is a vertex of the domain.
    Whole,
    /// Half of it, `p` the middle of a side, where the third corner is no vertex of the domain.
    Half,
    /// A sixth of it, `p` the middle of a side and `q` the centroid, where all corners are vertices of the domain.
    Sixth,
}

impl Part {
    /// The factors `a`, `b` and `c` of `p = v + a (from - v)` and `q = v + b (from - v) + c (to - v)`, as fractions.
    pub fn factors(self) -> [[f64; 2]; 3] {
        match self {
            Self::Whole => [[1.0, 1.0], [0.0, 1.0], [1.0, 1.0]],
            Self::Half => [[1.0, 2.0], [0.0, 1.0], [1.0, 1.0]],
            Self::Sixth => [[1.0, 2.0], [1.0, 3.0], [1.0, 3.0]],
        }
    }

    /// How many times smaller than its triangle it is.
    fn divisor(self) -> i64 {
        match self {
            Self::Whole => 1,
            Self::Half => 2,
            Self::Sixth => 6,
        }
    }
}

/// Part of a triangle.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    /// Numbers of the apex `v`, of the corner on whose side `p` lies, and of the third.
    pub corners: [u32; 3],
    pub part: Part,
    pub touch: Touch,
    /// Twice the signed area of `(v, p, q)`.
    pub turn: Form,
}

/// A mean value map from one domain to another, or a complex map, and the charts of the first.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    /// Vertices of the domain.
    pub points: Vec<Point2>,
    /// Corners of triangles that are no vertices; numbered after these.
    pub added: Vec<Point2>,
    pub images: Vec<Point2>,
    pub next: Vec<u32>,
    pub previous: Vec<u32>,
    pub charts: Vec<Chart>,
    /// Linear, but for complex maps.
    pub speeds: EdgeSpeeds,
}

impl Step {
    /// The map of a domain whose vertices go to `images`, with the charts of triangles that tile it.
    pub fn new(domain: &PlanarDomain, tiling: &Tiling, images: Vec<Point2>) -> Self {
        let points: Vec<Point2> = domain.vertices().collect();
        let next = next_vertices(domain);
        let mut previous = vec![0; next.len()];
        for (from, &to) in next.iter().enumerate() {
            previous[to as usize] = from as u32;
        }
        let (added, speeds) = (tiling.added.clone(), EdgeSpeeds::linear(next.len()));
        let mut step = Self { points, added, images, next, previous, charts: Vec::new(), speeds };
        step.charts = tiling.triangles.iter().flat_map(|&triangle| step.charts_of(triangle)).collect();
        step
    }

    /// The complex map of the same domains with such speeds, one for each edge.
    pub fn with_speeds(self, speeds: EdgeSpeeds) -> Self {
        Self { speeds, ..self }
    }

    /// Where a corner of a triangle is.
    pub fn corner(&self, number: u32) -> Point2 {
        let number = number as usize;
        if number < self.points.len() { self.points[number] } else { self.added[number - self.points.len()] }
    }

    /// The image that others are compared with in a chart: that of the apex, or of the first vertex if it is none.
    pub fn base_image(&self, chart: &Chart) -> Point2 {
        self.images[if self.is_vertex(chart.corners[0]) { chart.corners[0] as usize } else { 0 }]
    }

    /// Whether a corner is a vertex of the domain.
    pub fn is_vertex(&self, number: u32) -> bool {
        (number as usize) < self.points.len()
    }

    /// The charts of a triangle, as few as leave each at most one vertex of the domain.
    fn charts_of(&self, [a, b, c]: [u32; 3]) -> Vec<Chart> {
        let [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(|corner| self.corner(corner).map(exact));
        let area = (&bx - &ax) * (&cy - &ay) - (&by - &ay) * (&cx - &ax);
        let turned = [[a, b, c], [b, c, a], [c, a, b]];
        let with =
            |vertices: &[bool; 3]| turned.into_iter().find(|corners| corners.map(|k| self.is_vertex(k)) == *vertices);
        if let Some(corners) = with(&[false, false, false]).or_else(|| with(&[true, false, false])) {
            return vec![self.chart(corners, Part::Whole, false, &area)];
        }
        match with(&[true, true, false]) {
            Some(corners) => self.halves(corners, Part::Half, &area).into(),
            None => turned.into_iter().flat_map(|corners| self.halves(corners, Part::Sixth, &area)).collect(),
        }
    }

    /// The charts on both sides of the middle of the first side, for halves, or at the first corner, for sixths.
    fn halves(&self, [v, from, to]: [u32; 3], part: Part, area: &Rational) -> [Chart; 2] {
        let other = if part == Part::Half { [from, v, to] } else { [v, to, from] };
        [self.chart([v, from, to], part, false, area), self.chart(other, part, true, area)]
    }

    /// A chart; `is_mirrored` if its corners run clockwise.
    fn chart(&self, corners: [u32; 3], part: Part, is_mirrored: bool, area: &Rational) -> Chart {
        let turn = Form::around(&(area / &Rational::from(part.divisor())));
        let turn = if is_mirrored { turn.opposite() } else { turn };
        let is_edge = |from: u32, to: u32| self.is_vertex(from) && self.next[from as usize] == to;
        let touch = match corners {
            [v, from, _] if part != Part::Whole && is_edge(v, from) => Touch::Next,
            [v, from, _] if part != Part::Whole && is_edge(from, v) => Touch::Previous,
            _ => Touch::Nothing,
        };
        Chart { corners, part, touch, turn }
    }
}

fn exact(value: f64) -> Rational {
    Rational::from_f64(value).unwrap_or(Rational::ZERO)
}
