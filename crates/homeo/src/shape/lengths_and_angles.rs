//! Intrinsic paths of polygons.

use super::closing::closing_lengths;
use super::ring::{Measures, place_at, ring_of_edges, shorter_way};
use super::{ShapeError, ShapePath, check_time, mix};

/// Turning angles move evenly, and so do the lengths of edges but for a least correction that closes the ring.
///
/// Directions of edges are `(1 - t) a + t b`, unwrapped along the ring: that is, turning angles and the direction of a
/// reference edge move evenly, whichever edge it is. Whole turns are taken off so that the mean turn of the edges, by
/// length, is in `(-PI, PI]`. Lengths, as parts of the perimeter, are corrected by `d` with `sum (d / w)^2` least,
/// where `w` is how much the length changes from source to target, but not below a thousandth of the greatest change.
/// The perimeter and the centroid of the edges move evenly.
///
/// # Guarantee
/// Such lengths exist, at all times: as each turning angle is below a half turn and their sum is a whole number of
/// turns other than 0, directions of edges are in no half plane. Before the perimeter is set each edge keeps a tenth of
/// its part or more. If the target is moved, turned (the shorter way still being the same) or scaled, so are all shapes
/// on the way, but for rounding. Shapes may meet themselves: see [`first_not_simple`](super::first_not_simple).
///
/// # References
/// Schneider 2017, section 3.1; Sederberg, Gao, Wang, Mu 1993. There lengths are not parts of the perimeter, so that
/// the result depends on the target's size, and corrected ones may be negative.
///
/// # Example
/// ```
/// use homeo::shape::{LengthsAndAngles, ShapePath};
/// let thin = vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]];
/// let turned = vec![[0.0, 0.0], [0.0, 3.0], [-1.0, 3.0], [-1.0, 0.0]];
/// let ring = &LengthsAndAngles::new(thin, turned)?.at(0.25)?[0];
/// let length = (ring[1][0] - ring[0][0]).hypot(ring[1][1] - ring[0][1]);
/// assert!((length - 3.0).abs() < 1e-14);
/// # Ok::<(), homeo::shape::ShapeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LengthsAndAngles {
    rings: [Vec<[f64; 2]>; 2],
    source: Measures,
    target: Measures,
    /// By how much edges turn.
    rotations: Vec<f64>,
    weights: Vec<f64>,
}

impl LengthsAndAngles {
    /// The path between two rings whose vertices correspond by number.
    ///
    /// # Errors
    /// Numbers of vertices differ; coordinates are out of range; an edge has length zero or runs back on the one
    /// before; the rings do not turn the same number of times, or do not turn (an eight).
    ///
    /// # Complexity
    /// Linear.
    pub fn new(source: Vec<[f64; 2]>, target: Vec<[f64; 2]>) -> Result<Self, ShapeError> {
        if source.len() != target.len() {
            return Err(ShapeError::VertexCounts { ring: 0, here: source.len(), there: target.len() });
        }
        let (a, b) = (Measures::new(&source)?, Measures::new(&target)?);
        match (a.turning_number, b.turning_number) {
            (0, 0) => return Err(ShapeError::DoesNotTurn),
            (here, there) if here != there => return Err(ShapeError::TurningNumbers { here, there }),
            _ => (),
        }
        let raw: Vec<f64> = b.directions.iter().zip(&a.directions).map(|(b, a)| b - a).collect();
        let mean = (0..raw.len()).map(|i| 0.5 * (a.lengths[i] + b.lengths[i]) * raw[i]).sum::<f64>();
        let shift = shorter_way(mean) - mean;
        Ok(Self {
            rotations: raw.iter().map(|rotation| rotation + shift).collect(),
            weights: weights(&a.lengths, &b.lengths),
            rings: [source, target],
            source: a,
            target: b,
        })
    }
}

impl ShapePath for LengthsAndAngles {
    /// # Complexity
    /// Linear for each step of the iteration: two steps, or some more where lengths come to their bounds.
    fn at(&self, t: f64) -> Result<Vec<Vec<[f64; 2]>>, ShapeError> {
        check_time(t)?;
        if t == 0.0 || t == 1.0 {
            return Ok(vec![self.rings[t as usize].clone()]);
        }
        let all = 0..self.weights.len();
        let directions: Vec<f64> = all.clone().map(|i| self.source.directions[i] + t * self.rotations[i]).collect();
        let units: Vec<[f64; 2]> = directions.iter().map(|d| [d.cos(), d.sin()]).collect();
        let lengths: Vec<f64> = all.map(|i| mix(t, self.source.lengths[i], self.target.lengths[i])).collect();
        let lengths = closing_lengths(&lengths, &self.weights, &units)
            .map_err(|open| ShapeError::NotClosed { t, residual: open.0 })?;
        let perimeter = mix(t, self.source.perimeter, self.target.perimeter);
        Ok(vec![ring_of_edges(&lengths, &directions, perimeter, place_at(t, &self.source, &self.target))])
    }
}

/// How readily lengths are corrected: by how much they change, and all alike where rounding makes the changes.
fn weights(source: &[f64], target: &[f64]) -> Vec<f64> {
    let change = |(a, b): (&f64, &f64)| (b - a).abs();
    let most = source.iter().zip(target).map(change).fold(0.0, f64::max);
    let least = f64::max(1e-3 * most, 1e-9 / source.len() as f64);
    source.iter().zip(target).map(|lengths| change(lengths).max(least)).collect()
}
