//! Lengths, angles and place of one ring.

use std::f64::consts::{PI, TAU};
use std::ops::RangeInclusive;

use homeo_core::predicate::{Sign, orient2d};

use super::{ShapeError, mix};

/// Magnitudes on which signs are exact, as for planar domains.
const EXACT_RANGE: RangeInclusive<f64> = 1e-90..=1e90;

/// What a ring is made of: all that a path interpolates.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measures {
    /// Lengths of edges, of sum 1; edge `i` begins in vertex `i`.
    pub lengths: Vec<f64>,
    /// Turning angles at vertices, between `-PI` and `PI`.
    pub turns: Vec<f64>,
    /// Directions of edges, each the one before and a turning angle.
    pub directions: Vec<f64>,
    /// How often the ring turns, counter-clockwise.
    pub turning_number: i64,
    /// Sum of the lengths of edges.
    pub perimeter: f64,
    /// Centroid of the edges.
    pub centroid: [f64; 2],
}

impl Measures {
    /// Measures a ring. The sign of each turning angle is exact.
    pub fn new(ring: &[[f64; 2]]) -> Result<Self, ShapeError> {
        check_points(ring)?;
        let n = ring.len();
        let edge = |i: usize| minus(ring[(i + 1) % n], ring[i]);
        let raw: Vec<f64> = (0..n).map(|i| edge(i)[0].hypot(edge(i)[1])).collect();
        if let Some(vertex) = raw.iter().position(|&length| length == 0.0) {
            return Err(ShapeError::EdgeOfLengthZero { vertex });
        }
        let turns = (0..n).map(|i| turn_at(ring, i)).collect::<Result<Vec<_>, _>>()?;
        let mut directions = vec![edge(0)[1].atan2(edge(0)[0])];
        for i in 1..n {
            // Nearest to the sum, but without its rounding errors.
            let (expected, angle) = (directions[i - 1] + turns[i], edge(i)[1].atan2(edge(i)[0]));
            directions.push(angle + TAU * ((expected - angle) / TAU).round());
        }
        let perimeter: f64 = raw.iter().sum();
        Ok(Self {
            lengths: raw.iter().map(|length| length / perimeter).collect(),
            turning_number: (turns.iter().sum::<f64>() / TAU).round() as i64,
            turns,
            directions,
            perimeter,
            centroid: centroid(ring),
        })
    }

    /// The mean of the directions of edges, by length.
    pub fn mean_direction(&self) -> f64 {
        self.lengths.iter().zip(&self.directions).map(|(length, direction)| length * direction).sum()
    }
}

/// An angle less whole turns, in `(-PI, PI]`: the shorter way round.
pub(super) fn shorter_way(angle: f64) -> f64 {
    angle - TAU * ((angle - PI) / TAU).ceil()
}

/// Refuses rings of fewer than three vertices and coordinates out of range.
pub(super) fn check_points(ring: &[[f64; 2]]) -> Result<(), ShapeError> {
    if ring.len() < 3 {
        return Err(ShapeError::TooFewVertices { count: ring.len() });
    }
    let is_good = |x: &f64| *x == 0.0 || EXACT_RANGE.contains(&x.abs());
    match ring.iter().position(|p| !p.iter().all(is_good)) {
        Some(vertex) => Err(ShapeError::OutOfRange { vertex, point: ring[vertex] }),
        None => Ok(()),
    }
}

/// The turning angle at a vertex whose edges have a length.
fn turn_at(ring: &[[f64; 2]], vertex: usize) -> Result<f64, ShapeError> {
    let n = ring.len();
    let (before, here, after) = (ring[(vertex + n - 1) % n], ring[vertex], ring[(vertex + 1) % n]);
    let (a, b) = (minus(here, before), minus(after, here));
    let (cross, dot) = (a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    let angle = cross.abs().atan2(dot);
    match orient2d(before, here, after) {
        Sign::Positive => Ok(angle),
        Sign::Negative => Ok(-angle),
        Sign::Zero if dot > 0.0 => Ok(0.0),
        Sign::Zero => Err(ShapeError::TurnsBack { vertex }),
    }
}

/// The centroid of the edges of a ring: middles, weighted by lengths.
fn centroid(ring: &[[f64; 2]]) -> [f64; 2] {
    // From the first vertex, lest places far from the origin cost digits.
    let (n, origin) = (ring.len(), ring[0]);
    let (mut sum, mut total) = ([0.0; 2], 0.0);
    for i in 0..n {
        let (a, b) = (minus(ring[i], origin), minus(ring[(i + 1) % n], origin));
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        sum = [sum[0] + length * 0.5 * (a[0] + b[0]), sum[1] + length * 0.5 * (a[1] + b[1])];
        total += length;
    }
    [origin[0] + sum[0] / total, origin[1] + sum[1] / total]
}

/// The ring of edges of given directions and of lengths that are scaled to a perimeter, with its centroid in place.
pub(super) fn ring_of_edges(lengths: &[f64], directions: &[f64], perimeter: f64, place: [f64; 2]) -> Vec<[f64; 2]> {
    let factor = perimeter / lengths.iter().sum::<f64>();
    let mut here = [0.0; 2];
    let mut ring = Vec::with_capacity(lengths.len());
    for (length, direction) in lengths.iter().zip(directions) {
        ring.push(here);
        let (sine, cosine) = direction.sin_cos();
        here = [here[0] + factor * length * cosine, here[1] + factor * length * sine];
    }
    let shift = minus(place, centroid(&ring));
    ring.iter().map(|p| [p[0] + shift[0], p[1] + shift[1]]).collect()
}

/// Where the centroid is at a time, on a straight way.
pub(super) fn place_at(t: f64, source: &Measures, target: &Measures) -> [f64; 2] {
    [0, 1].map(|axis| mix(t, source.centroid[axis], target.centroid[axis]))
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}
