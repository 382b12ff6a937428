//! Curvature of sampled closed curves.

use super::ShapeError;
use super::ring::Measures;

/// Points of a closed curve, at parameters `0, 1 / count, 2 / count, ...`; 1, where it closes, is left out.
///
/// # Example
/// ```
/// use std::f64::consts::TAU;
/// let circle = homeo::shape::sample_closed(|u| [(TAU * u).cos(), (TAU * u).sin()], 4);
/// assert!((circle[1][1] - 1.0).abs() < 1e-15);
/// ```
pub fn sample_closed(curve: impl Fn(f64) -> [f64; 2], count: usize) -> Vec<[f64; 2]> {
    (0..count).map(|i| curve(i as f64 / count as f64)).collect()
}

/// Signed curvature of a sampled closed curve, scaled to length 1, by arc length from 0 to 1.
///
/// At a sample it is the turning angle over half the length of the two edges, between samples linear.
///
/// # Guarantee
/// For samples of a curve of class `C^4` at even steps of a regular parameter the error is of second order in the step.
///
/// # References
/// Schneider 2017, (3.3).
///
/// # Example
/// ```
/// use std::f64::consts::TAU;
/// use homeo::shape::{CurvatureProfile, sample_closed};
/// let circle = sample_closed(|u| [3.0 * (TAU * u).cos(), 3.0 * (TAU * u).sin()], 100);
/// let profile = CurvatureProfile::new(&circle)?;
/// assert!((profile.at(0.123) - TAU).abs() < 1e-12);
/// # Ok::<(), homeo::shape::ShapeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CurvatureProfile {
    nodes: Vec<f64>,
    values: Vec<f64>,
    perimeter: f64,
}

impl CurvatureProfile {
    /// The curvature of a sampled closed curve.
    ///
    /// # Errors
    /// Coordinates are out of range, or an edge has length zero or runs back on the one before.
    pub fn new(samples: &[[f64; 2]]) -> Result<Self, ShapeError> {
        Ok(Self::of(&Measures::new(samples)?))
    }

    /// The curvature of a ring that was measured.
    pub(super) fn of(measures: &Measures) -> Self {
        let (lengths, n) = (&measures.lengths, measures.lengths.len());
        let value = |i: usize| 2.0 * measures.turns[i] / (lengths[(i + n - 1) % n] + lengths[i]);
        let start = |place: &mut f64, length: &f64| Some(std::mem::replace(place, *place + length));
        let mut nodes: Vec<f64> = lengths.iter().scan(0.0, start).collect();
        let mut values: Vec<f64> = (0..n).map(value).collect();
        nodes.push(1.0);
        values.push(values[0]);
        Self { nodes, values, perimeter: measures.perimeter }
    }

    /// Where samples lie, by arc length: from 0 to 1, the first sample twice (#samples + 1).
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Curvatures at the nodes.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Length of the sampled curve: divide curvatures by it for those of the curve as it is.
    pub fn length(&self) -> f64 {
        self.perimeter
    }

    /// The curvature at an arc length, from 0 to 1; beyond, that of the ends.
    ///
    /// # Complexity
    /// Logarithmic.
    pub fn at(&self, arc_length: f64) -> f64 {
        let after = self.nodes.partition_point(|&node| node <= arc_length).clamp(1, self.nodes.len() - 1);
        let (low, high) = (self.nodes[after - 1], self.nodes[after]);
        let part = ((arc_length - low) / (high - low)).clamp(0.0, 1.0);
        self.values[after - 1] + part * (self.values[after] - self.values[after - 1])
    }
}
