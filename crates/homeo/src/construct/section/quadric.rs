//! Sums of squared distances to planes (Garland and Heckbert 1997).

use crate::construct::shell::directions::{dot, minus};

type Point = [f64; 3];

/// A weighted sum of squared distances to planes, in coordinates round a fixed origin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Quadric {
    /// `xx, yy, zz, xy, yz, zx`.
    square: [f64; 6],
    linear: Point,
    constant: f64,
    /// Sum of the weights.
    pub weight: f64,
}

/// How strongly the minimum is drawn to the middle of the edge, relative to the quadric: it decides where the planes leave
/// a choice, and nowhere else.
const PULL: f64 = 1e-4;

impl Quadric {
    /// The plane through a point with a unit normal.
    pub fn plane(point: Point, normal: Point, weight: f64) -> Self {
        let [x, y, z] = normal;
        let offset = -dot(point, normal);
        Self {
            square: [x * x, y * y, z * z, x * y, y * z, z * x].map(|a| weight * a),
            linear: normal.map(|a| weight * offset * a),
            constant: weight * offset * offset,
            weight,
        }
    }

    pub fn plus(&self, other: &Self) -> Self {
        Self {
            square: std::array::from_fn(|i| self.square[i] + other.square[i]),
            linear: std::array::from_fn(|i| self.linear[i] + other.linear[i]),
            constant: self.constant + other.constant,
            weight: self.weight + other.weight,
        }
    }

    fn times(&self, p: Point) -> Point {
        let [xx, yy, zz, xy, yz, zx] = self.square;
        let rows = [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]];
        rows.map(|row| dot(row, p))
    }

    /// The sum at a point; rounding does not make it negative.
    pub fn at(&self, p: Point) -> f64 {
        (dot(self.times(p), p) + 2.0 * dot(self.linear, p) + self.constant).max(0.0)
    }

    /// The root of the mean squared distance at a point.
    pub fn distance(&self, p: Point) -> f64 {
        if self.weight > 0.0 { (self.at(p) / self.weight).sqrt() } else { 0.0 }
    }

    /// About where the sum is least: near `middle` if there are several such places. `None` where numbers are too bad.
    pub fn lowest(&self, middle: Point) -> Option<Point> {
        let [xx, yy, zz, xy, yz, zx] = self.square;
        let pull = PULL * (xx + yy + zz);
        // (A + pull) step = -(A middle + linear)
        let residual = self.times(middle);
        let right: Point = std::array::from_fn(|i| -(residual[i] + self.linear[i]));
        let columns = [[xx + pull, xy, zx], [xy, yy + pull, yz], [zx, yz, zz + pull]];
        let cross = super::shape::cross;
        let determinant = dot(columns[0], cross(columns[1], columns[2]));
        let step: Point = std::array::from_fn(|i| {
            let mut replaced = columns;
            replaced[i] = right;
            dot(replaced[0], cross(replaced[1], replaced[2])) / determinant
        });
        let place: Point = std::array::from_fn(|i| middle[i] + step[i]);
        place.iter().all(|x| x.is_finite()).then_some(place)
    }
}

/// Coordinates round an origin, to keep digits.
pub(super) fn relative(point: Point, origin: Point) -> Point {
    minus(point, origin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_planes_meet_where_the_sum_is_least() {
        let corner = [0.5, -0.25, 2.0];
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let sum = axes.iter().fold(Quadric::default(), |sum, &axis| sum.plus(&Quadric::plane(corner, axis, 2.0)));
        let found = sum.lowest([0.6, -0.2, 1.9]).unwrap();
        assert!((0..3).all(|i| (found[i] - corner[i]).abs() < 1e-4), "{found:?}");
        assert!((sum.distance([0.5, -0.25, 5.0]) - 3f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn one_plane_leaves_the_middle_in_place() {
        let sum = Quadric::plane([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], 1.0);
        let found = sum.lowest([3.0, 4.0, 1.5]).unwrap();
        assert!((found[0] - 3.0).abs() < 1e-9 && (found[1] - 4.0).abs() < 1e-9 && (found[2] - 1.0).abs() < 1e-3);
    }
}
