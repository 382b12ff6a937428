//! The domain between source and target: which convex polygon, or how a cylinder is divided.

use std::f64::consts::TAU;

use homeo_core::planar::{DomainPair, Point2};

use super::MiddleShape;
use crate::map::{Circuit, Middle};

/// How much of the boundary of the middle is shared out equally, whatever the edges' lengths: no edge becomes so short
/// that rounding could take away a corner.
const EQUAL_PART: f64 = 0.1;

/// The middle of a pair, and how far the inner ring begins ahead of the outer one, in turns.
pub(super) fn middle(pair: &DomainPair, shape: MiddleShape, ahead: f64) -> Middle {
    let shares: Vec<Vec<f64>> = pair
        .source
        .rings()
        .iter()
        .zip(pair.target.rings())
        .map(|(s, t)| shares([s, t].map(|ring| lengths(ring)), shape))
        .collect();
    if let [shares] = &shares[..] {
        return Middle::new(vec![on_circle(shares)]);
    }
    let outer = shares[0].iter().map(|&share| [share, 0.0]).collect();
    let inner = shares[1].iter().map(|&share| [ahead - share, 1.0]).collect();
    Middle::new(vec![outer, inner])
}

/// The middle of domains that are slit open, by the lengths of the sides in both: a side of a seam counts like an edge.
pub(super) fn slit(circuit: Circuit, lengths: [Vec<f64>; 2], shape: MiddleShape) -> Middle {
    Middle::slit(circuit, on_circle(&shares(lengths, shape)))
}

fn on_circle(shares: &[f64]) -> Vec<Point2> {
    shares.iter().map(|share| [(TAU * share).cos(), (TAU * share).sin()]).collect()
}

/// Of the edges of a ring.
fn lengths(ring: &[Point2]) -> Vec<f64> {
    let length = |i: usize| {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    (0..ring.len()).map(length).collect()
}

/// Where the vertices of a ring lie on a circle, by its edges' lengths in source and target: from 0, below 1.
fn shares(lengths: [Vec<f64>; 2], shape: MiddleShape) -> Vec<f64> {
    let n = lengths[0].len();
    let totals = [0, 1].map(|k| lengths[k].iter().sum::<f64>());
    let equal = match shape {
        MiddleShape::Regular => 1.0,
        MiddleShape::AveragedLengths | MiddleShape::Optimized(_) => EQUAL_PART,
    };
    let part = |i: usize| {
        let average = 0.5 * (lengths[0][i] / totals[0] + lengths[1][i] / totals[1]);
        equal / n as f64 + (1.0 - equal) * average
    };
    (0..n).scan(0.0, |sum, i| Some(std::mem::replace(sum, *sum + part(i)))).collect()
}
