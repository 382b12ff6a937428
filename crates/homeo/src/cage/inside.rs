//! Whether points are inside of a closed mesh or on it, exactly; and where points on it go.

use homeo_core::number::{Interval, Rational};
use homeo_core::predicate::{Sign, faithful_projection, orient2d, orient3d, segment_meets_triangle};

use crate::map::Enclosed;

type Point3 = [f64; 3];

/// Whether signs are decided exactly for a point: coordinates are zero or between `2^-300` and `2^300` in size.
pub(super) fn is_fit(point: &Point3) -> bool {
    let range = 2f64.powi(-300)..=2f64.powi(300);
    point.iter().all(|x| *x == 0.0 || range.contains(&x.abs()))
}

/// Whether a point is inside of a closed mesh or on it.
pub(super) fn contains(points: &[Point3], triangles: &[[u32; 3]], point: Point3) -> bool {
    let corners = || triangles.iter().map(|triangle| triangle.map(|v| points[v as usize]));
    corners().any(|triangle| segment_meets_triangle([point; 2], triangle))
        || corners().filter(|&triangle| is_above(triangle, point)).count() % 2 == 1
}

/// Whether a triangle is above a point that is not on it. The point counts as moved a little in `x` and less in `y`, so
/// that no line up from it meets an edge.
fn is_above([a, b, c]: [Point3; 3], point: Point3) -> bool {
    let flat = |p: Point3| [p[0], p[1]];
    let is_left_of = |p: Point3, q: Point3| {
        let [low, high] = if p[1] <= q[1] { [p, q] } else { [q, p] };
        low[1] <= point[1] && point[1] < high[1] && orient2d(flat(low), flat(high), flat(point)) == Sign::Positive
    };
    let sides = [[a, b], [b, c], [c, a]];
    // Counter-clockwise from above, a triangle is above what it sees from behind.
    sides.into_iter().filter(|&[p, q]| is_left_of(p, q)).count() % 2 == 1
        && orient3d(a, b, c, point) != orient2d(flat(a), flat(b), flat(c))
}

/// Where a point on a triangle of one mesh is on the same triangle of another, in rationals but for the last rounding; none off
/// the mesh.
pub(super) fn along_triangle([from, to]: [&[Point3]; 2], triangles: &[[u32; 3]], point: Point3) -> Option<Enclosed> {
    let is_on = |triangle: &&[u32; 3]| segment_meets_triangle([point; 2], triangle.map(|v| from[v as usize]));
    let triangle = triangles.iter().find(is_on)?;
    let corners = triangle.map(|v| from[v as usize]);
    let axes = faithful_projection(corners[0], corners[1], corners[2])?;
    let exact = |x: f64| Rational::from_f64(x).unwrap_or(Rational::ZERO);
    let flat = |p: Point3| axes.map(|axis| exact(p[axis]));
    let area = |p: Point3, q: Point3| {
        let ([a, b], [c, d], [x, y]) = (flat(p), flat(q), flat(point));
        (a - x.clone()) * (d - y.clone()) - (b - y) * (c - x)
    };
    let [a, b, c] = corners;
    let weights = [area(b, c), area(c, a), area(a, b)];
    let whole = weights.iter().fold(Rational::ZERO, |sum, weight| sum + weight.clone());
    let image = [0, 1, 2].map(|axis| {
        let parts = weights.iter().zip(triangle).map(|(weight, &v)| weight * &exact(to[v as usize][axis]));
        let sum = parts.fold(Rational::ZERO, |sum, part| sum + part);
        Interval::around(&(sum / whole.clone())).middle_and_radius()
    });
    let radius = image.iter().fold(0.0, |most: f64, &(_, radius)| most.max(radius));
    Some(Enclosed { point: image.map(|(middle, _)| middle), radius })
}
