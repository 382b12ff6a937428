//! The domain between source and target: which convex polygon, or how a cylinder is divided.

use std::f64::consts::TAU;

use homeo_core::planar::{DomainPair, Point2};

use super::MiddleShape;
use crate::map::Middle;

/// How much of the boundary of the middle is shared out equally, whatever the edges' lengths: no edge becomes so short
/// that rounding could take away a corner.
const EQUAL_PART: f64 = 0.1;

/// The middle of a pair, and how far the inner ring begins ahead of the outer one, in turns.
pub(super) fn middle(pair: &DomainPair, shape: MiddleShape, ahead: f64) -> Middle {
    let shares: Vec<Vec<f64>> =
        pair.source.rings().iter().zip(pair.target.rings()).map(|(s, t)| shares([s, t], shape)).collect();
    if let [shares] = &shares[..] {
        return Middle::new(vec![shares.iter().map(|share| [(TAU * share).cos(), (TAU * share).sin()]).collect()]);
    }
    let outer = shares[0].iter().map(|&share| [share, 0.0]).collect();
    let inner = shares[1].iter().map(|&share| [ahead - share, 1.0]).collect();
    Middle::new(vec![outer, inner])
}

/// Where the vertices of a ring lie on a circle: from 0, below 1.
fn shares(rings: [&Vec<Point2>; 2], shape: MiddleShape) -> Vec<f64> {
    let n = rings[0].len();
    let lengths = rings.map(|ring| {
        let length = |i: usize| {
            let (a, b) = (ring[i], ring[(i + 1) % n]);
            (b[0] - a[0]).hypot(b[1] - a[1])
        };
        (0..n).map(length).collect::<Vec<f64>>()
    });
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
