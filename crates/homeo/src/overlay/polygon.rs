//! Convex polygons in a middle triangle, exactly.

use homeo_core::number::{Interval, Rational, Scalar};
use homeo_core::predicate::Sign;

/// A point of a middle triangle: the weights of the prism's second and third column.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Place {
    pub exact: [Rational; 2],
    near: [Interval; 2],
}

/// A corner of a polygon that lies in a triangle of a surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Corner {
    pub place: Place,
    /// The weights of that triangle's corners.
    pub weights: [Rational; 3],
}

impl Place {
    pub fn new(exact: [Rational; 2]) -> Self {
        Self { near: exact.each_ref().map(Interval::around), exact }
    }

    pub fn on_middle(&self) -> [Rational; 3] {
        let [a, b] = self.exact.clone();
        [&(&Rational::ONE - &a) - &b, a, b]
    }

    /// The ends of its box in floating point.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        [self.near.each_ref().map(Interval::low), self.near.each_ref().map(Interval::high)]
    }
}

/// Twice the area of the triangle of three points.
fn turn<T: Scalar>(a: &[T; 2], b: &[T; 2], p: &[T; 2]) -> T {
    let (u, v) = ([b[0].minus(&a[0]), b[1].minus(&a[1])], [p[0].minus(&a[0]), p[1].minus(&a[1])]);
    u[0].times(&v[1]).minus(&u[1].times(&v[0]))
}

/// On which side of the line from `a` to `b` a point lies; positive on the left.
fn side(a: &Place, b: &Place, p: &Place) -> Sign {
    turn(&a.near, &b.near, &p.near).sign().unwrap_or_else(|| turn(&a.exact, &b.exact, &p.exact).sign())
}

/// Twice the area of a polygon.
pub(super) fn doubled_area<'n>(corners: impl IntoIterator<Item = [&'n Rational; 2]>) -> Rational {
    let corners: Vec<[&Rational; 2]> = corners.into_iter().collect();
    let Some((first, rest)) = corners.split_first() else { return Rational::ZERO };
    let from_first = |p: &[&Rational; 2]| [p[0] - first[0], p[1] - first[1]];
    let steps: Vec<[Rational; 2]> = rest.iter().map(from_first).collect();
    steps.windows(2).map(|pair| &(&pair[0][0] * &pair[1][1]) - &(&pair[0][1] * &pair[1][0])).sum()
}

/// The part of a convex polygon in another one, both counter-clockwise, with the first one's weights; empty without an
/// area.
pub(super) fn intersection(polygon: &[Corner], other: &[Corner]) -> Vec<Corner> {
    let mut rest = polygon.to_vec();
    for (k, from) in other.iter().enumerate() {
        let to = &other[(k + 1) % other.len()].place;
        let sides: Vec<Sign> = rest.iter().map(|corner| side(&from.place, to, &corner.place)).collect();
        let height = |corner: &Corner| turn(&from.place.exact, &to.exact, &corner.place.exact);
        let Some(kept) = clipped(rest, &sides, height) else { return Vec::new() };
        rest = kept;
    }
    rest
}

/// The part of a convex polygon on the closed positive side of a line, given the signs and, where needed, the exact heights
/// of its corners; `None` if it has no area. The sides of the polygon may be straight in between.
pub(super) fn clipped(
    corners: Vec<Corner>,
    sides: &[Sign],
    height: impl Fn(&Corner) -> Rational,
) -> Option<Vec<Corner>> {
    if !sides.contains(&Sign::Positive) {
        return None;
    }
    if !sides.contains(&Sign::Negative) {
        return Some(corners);
    }
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (k, corner) in corners.iter().enumerate() {
        let next = (k + 1) % corners.len();
        if sides[k] != Sign::Negative {
            kept.push(corner.clone());
        }
        if matches!((sides[k], sides[next]), (Sign::Positive, Sign::Negative) | (Sign::Negative, Sign::Positive)) {
            kept.push(between(corner, &corners[next], &height(corner), &height(&corners[next])));
        }
    }
    (kept.len() >= 3).then_some(kept)
}

/// The point between two corners where the height, linear, is zero.
fn between(a: &Corner, b: &Corner, height_a: &Rational, height_b: &Rational) -> Corner {
    let share = height_a / &(height_a - height_b);
    let mix = |x: &Rational, y: &Rational| x + &(&share * &(y - x));
    Corner {
        place: Place::new([0, 1].map(|axis| mix(&a.place.exact[axis], &b.place.exact[axis]))),
        weights: [0, 1, 2].map(|k| mix(&a.weights[k], &b.weights[k])),
    }
}
