//! Measures in `f64`, and the exact signs among them.

use super::report::AngleRange;
use super::violation::{ElementKind, Severity, Violations};
use crate::number::Rational;
use crate::predicate::Sign;
use crate::spatial::Aabb;

pub(super) type Point = [f64; 3];

/// Magnitudes for which signs are exact; zero is fine too.
const EXACT_RANGE: std::ops::RangeInclusive<f64> = pow2(-300)..=pow2(300);

/// Diagonals beyond these get a warning.
const USUAL_DIAGONALS: std::ops::RangeInclusive<f64> = 1e-12..=1e12;

/// A mesh that lies further from the origin than this many diagonals gets a warning.
const FAR_AWAY: f64 = 1e6;

/// `2^exponent`, for normal numbers.
const fn pow2(exponent: i64) -> f64 {
    f64::from_bits(((exponent + 1023) as u64) << 52)
}

/// Coordinates on which signs are exact.
#[derive(Clone, Copy)]
pub(super) struct Points<'a> {
    pub positions: &'a [Point],
    pub hull: Aabb,
    /// Length of the diagonal of the hull.
    pub diagonal: f64,
    /// A power of two that brings the diagonal near 1, so that squares and cubes stay in range.
    pub scale: f64,
}

impl<'a> Points<'a> {
    /// Checks the coordinates; `None` where there are none or signs would not be exact.
    pub(super) fn checked(positions: &'a [Point], vertices: usize, violations: &mut Violations) -> Option<Self> {
        if positions.is_empty() {
            return None;
        }
        if positions.len() != vertices {
            let message = format!(
                "there are {} points for {vertices} vertices: give one point for each vertex, or none at all",
                positions.len()
            );
            violations.add_general("positions-do-not-match", Severity::Error, 1, message);
            return None;
        }
        let exact = |point: &Point| point.iter().all(|&x| x == 0.0 || EXACT_RANGE.contains(&x.abs()));
        let bad: Vec<_> = (0..vertices).filter(|&v| !exact(&positions[v])).map(|v| [v as u32]).collect();
        if !bad.is_empty() {
            let advice = "coordinates must be zero or between 2^-300 and 2^300 in magnitude, so that signs are exact; \
                          scale the mesh or replace these coordinates by 0. Nothing was measured";
            violations.add("coordinate-out-of-range", Severity::Error, ElementKind::Vertex, &bad, advice);
            return None;
        }
        let points = Self::new(positions);
        points.warn_of_scale(violations);
        Some(points)
    }

    fn new(positions: &'a [Point]) -> Self {
        let hull = Aabb::of(positions);
        let longest = (0..3).map(|i| hull.high[i] - hull.low[i]).fold(0.0, f64::max);
        let exponent = if longest > 0.0 { (longest.to_bits() >> 52) as i64 - 1023 } else { 0 };
        let scale = pow2(-exponent);
        let diagonal = norm([0, 1, 2].map(|i| (hull.high[i] - hull.low[i]) * scale)) / scale;
        Self { positions, hull, diagonal, scale }
    }

    fn warn_of_scale(&self, violations: &mut Violations) {
        let farthest = (0..3).map(|i| self.hull.low[i].abs().max(self.hull.high[i].abs())).fold(0.0, f64::max);
        if self.diagonal == 0.0 {
            return;
        }
        let message = if !USUAL_DIAGONALS.contains(&self.diagonal) {
            format!(
                "the diagonal of the bounding box is {:e}: scale the mesh, or make sure that its unit is meant",
                self.diagonal
            )
        } else if farthest > FAR_AWAY * self.diagonal {
            format!(
                "coordinates reach {farthest:e} while the bounding box has diagonal {:e}: few digits are left for the \
                 shape; move the mesh to the origin before writing it",
                self.diagonal
            )
        } else {
            return;
        };
        violations.add_general("extreme-scale", Severity::Warning, 1, message);
    }

    /// The scaled vector from vertex `a` to vertex `b`.
    #[inline]
    pub(super) fn vector(&self, a: usize, b: usize) -> Point {
        let [p, q] = [self.positions[a], self.positions[b]];
        [0, 1, 2].map(|i| (q[i] - p[i]) * self.scale)
    }

    /// Six times the volume between the triangles and a corner of the hull: its exact sign and an
    /// estimate of the volume itself. For a closed oriented surface it is the volume enclosed.
    pub(super) fn enclosed_volume(&self, triangles: impl Iterator<Item = [usize; 3]> + Clone) -> (Sign, f64) {
        let corner = self.hull.low;
        let relative = |v: usize| [0, 1, 2].map(|i| (self.positions[v][i] - corner[i]) * self.scale);
        let (mut sum, mut magnitude, mut count) = (0.0f64, 0.0f64, 0.0f64);
        for triangle in triangles.clone() {
            let [a, b, c] = triangle.map(relative);
            sum += dot(a, cross(b, c));
            // All coordinates are positive: this is the sum of the magnitudes of all products.
            magnitude += dot(a, [b[1] * c[2] + b[2] * c[1], b[2] * c[0] + b[0] * c[2], b[0] * c[1] + b[1] * c[0]]);
            count += 1.0;
        }
        // Standard bound for sums of products, with slack for the roundings of the differences.
        let error = magnitude * (count + 32.0) * f64::EPSILON;
        let sign = if sum.abs() > error { Sign::of(sum) } else { self.exact_enclosed_sign(triangles) };
        (sign, sum / 6.0 / self.scale / self.scale / self.scale)
    }

    fn exact_enclosed_sign(&self, triangles: impl Iterator<Item = [usize; 3]>) -> Sign {
        let determinant = |triangle: [usize; 3]| {
            // Coordinates are finite here.
            let point = |v: usize| self.positions[v].map(|x| Rational::from_f64(x).unwrap_or(Rational::ZERO));
            let [a, b, c] = triangle.map(point);
            let minor = |i: usize, j: usize| &(&b[i] * &c[j]) - &(&b[j] * &c[i]);
            &(&(&a[0] * &minor(1, 2)) + &(&a[1] * &minor(2, 0))) + &(&a[2] * &minor(0, 1))
        };
        triangles.map(determinant).sum::<Rational>().sign()
    }
}

/// Each vertex at the point of an earlier one, after the first vertex there; ascending.
pub(super) fn coincident(positions: &[Point]) -> Vec<[u32; 2]> {
    // Adding zero makes -0 equal to 0.
    let key = |v: u32| positions[v as usize].map(|x| (x + 0.0).to_bits());
    let mut order: Vec<(u64, u32)> = (0..positions.len() as u32).map(|v| (key(v)[0], v)).collect();
    order.sort_unstable();
    let mut pairs = Vec::new();
    for same_x in order.chunk_by_mut(|a, b| a.0 == b.0).filter(|run| run.len() > 1) {
        same_x.sort_unstable_by_key(|&(_, v)| (key(v), v));
        for same in same_x.chunk_by(|a, b| key(a.1) == key(b.1)) {
            pairs.extend(same[1..].iter().map(|&(_, v)| [same[0].1, v]));
        }
    }
    pairs.sort_unstable();
    pairs
}

#[inline]
pub(super) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
pub(super) fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline]
pub(super) fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// Collects the range of angles by their cotangents, which fall steadily from 0 to 180 degrees and
/// resolve angles near both ends.
#[derive(Clone, Copy)]
pub(super) struct AngleTracker {
    least: f64,
    most: f64,
}

impl AngleTracker {
    pub(super) fn new() -> Self {
        Self { least: f64::INFINITY, most: f64::NEG_INFINITY }
    }

    /// Adds the angle with this cosine and sine, up to a common positive factor.
    #[inline]
    pub(super) fn add(&mut self, cosine: f64, sine: f64) {
        let cotangent = cosine / sine.abs();
        // Comparisons with NaN are false: angles that cannot be told leave no trace.
        if cotangent < self.least {
            self.least = cotangent;
        }
        if cotangent > self.most {
            self.most = cotangent;
        }
    }

    /// The range; `None` when no angle was added.
    pub(super) fn range(&self) -> Option<AngleRange> {
        let degrees = |cotangent: f64| 1f64.atan2(cotangent).to_degrees();
        (self.least <= self.most)
            .then(|| AngleRange { min_degrees: degrees(self.most), max_degrees: degrees(self.least) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_near_both_ends_are_resolved() {
        let mut tracker = AngleTracker::new();
        tracker.add(1.0, 1e-12);
        tracker.add(-1.0, 1e-12);
        let range = tracker.range().unwrap();
        assert!((range.min_degrees.to_radians() - 1e-12).abs() < 1e-20);
        assert!(range.max_degrees > 179.999 && range.max_degrees < 180.0);
        assert_eq!(AngleTracker::new().range(), None);
    }

    #[test]
    fn volumes_that_nearly_vanish_have_exact_signs() {
        // Two equal tetrahedra of opposite turns, the second one lifted by one unit in the last place.
        let mut positions =
            vec![[0.1, 0.1, 0.1], [1.1, 0.1, 0.1], [0.1, 1.1, 0.1], [0.1, 0.1, 1.1], [0.1, 0.1, 1.1f64]];
        let faces = |tip: usize| [[0, 2, 1], [0, 1, tip], [1, 2, tip], [2, 0, tip]];
        let both = || faces(3).into_iter().chain(faces(4).map(|[a, b, c]| [a, c, b]));
        assert_eq!(Points::new(&positions).enclosed_volume(both()).0, Sign::Zero);
        positions[3][2] = positions[3][2].next_up();
        assert_eq!(Points::new(&positions).enclosed_volume(both()).0, Sign::Positive);
        positions[4][2] = 1.2;
        assert_eq!(Points::new(&positions).enclosed_volume(both()).0, Sign::Negative);
    }
}
