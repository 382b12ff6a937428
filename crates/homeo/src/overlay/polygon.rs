//! Convex polygons, exactly.

use homeo_core::number::{Interval, Lazy, Rational, Scalar};
use homeo_core::predicate::Sign;

/// On which sides of the two pieces that it comes from a side of a polygon lies, by their [numbers](super::names::Side).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Sides {
    /// Of the source's piece.
    pub of_source: Option<u8>,
    /// Of the section's piece.
    pub of_section: Option<u8>,
}

impl Sides {
    /// What either knows.
    fn and(self, other: Self) -> Self {
        Self { of_source: self.of_source.or(other.of_source), of_section: self.of_section.or(other.of_section) }
    }
}

/// A corner of a polygon in some affine coordinates, and the side from it to the next corner.
#[derive(Clone, Debug)]
pub(super) struct Corner<const N: usize> {
    pub at: [Lazy; N],
    pub side: Sides,
    /// Whether the last cut made it.
    pub is_new: bool,
    /// Which corner of the triangle it is, if it is one.
    pub mark: Option<u8>,
}

/// A place in a middle triangle: the weights of the prism's columns.
pub(super) type Place = [Lazy; 3];

/// Twice the area of the triangle of three places, that of the whole middle triangle being 1.
pub(super) fn turn(a: &Place, b: &Place, c: &Place) -> Lazy {
    formula([a, b, c].map(Clone::clone), determinant::<Interval>, determinant::<Rational>)
}

fn determinant<T: Scalar>([a, b, c]: &[[T; 3]; 3]) -> T {
    let minor = |y: usize, z: usize| b[y].times(&c[z]).minus(&b[z].times(&c[y]));
    a[0].times(&minor(1, 2)).plus(&a[1].times(&minor(2, 0))).plus(&a[2].times(&minor(0, 1)))
}

/// The value of a formula, for lazy numbers.
fn formula<const M: usize, const N: usize>(
    numbers: [[Lazy; N]; M],
    near: fn(&[[Interval; N]; M]) -> Interval,
    exact: fn(&[[Rational; N]; M]) -> Rational,
) -> Lazy {
    let around = near(&numbers.each_ref().map(|row| row.each_ref().map(Lazy::interval)));
    Lazy::of_formula(around, move || exact(&numbers.each_ref().map(|row| row.each_ref().map(|x| x.exact().clone()))))
}

/// Twice the area of a convex polygon.
pub(super) fn doubled_area(corners: &[&Place]) -> Lazy {
    let fan = corners.windows(2).skip(1).map(|pair| turn(corners[0], pair[0], pair[1]));
    fan.fold(Lazy::from_f64(0.0), |sum, area| sum.plus(&area))
}

/// The part of a convex polygon in another one, both counter-clockwise; empty without an area.
pub(super) fn intersection(polygon: &[Corner<3>], other: &[Corner<3>]) -> Vec<Corner<3>> {
    let mut rest = polygon.to_vec();
    for (k, from) in other.iter().enumerate() {
        let to = &other[(k + 1) % other.len()].at;
        let heights: Vec<Lazy> = rest.iter().map(|corner| turn(&from.at, to, &corner.at)).collect();
        let sides: Vec<Sign> = heights.iter().map(Lazy::certain_sign).collect();
        let Some(kept) = clipped(rest, &sides, &heights, from.side) else { return Vec::new() };
        rest = kept;
    }
    rest
}

/// The part of a convex polygon on the closed positive side of a line that lies on some sides, given the heights of its
/// corners over the line and their signs; `None` if it has no area.
pub(super) fn clipped<const N: usize>(
    corners: Vec<Corner<N>>,
    signs: &[Sign],
    heights: &[Lazy],
    line: Sides,
) -> Option<Vec<Corner<N>>> {
    use Sign::{Negative, Positive, Zero};
    if !signs.contains(&Positive) {
        return None;
    }
    let old = |corner: &Corner<N>| Corner { is_new: false, ..corner.clone() };
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (k, corner) in corners.iter().enumerate() {
        let next = (k + 1) % corners.len();
        let crossing = || between([corner, &corners[next]], [&heights[k], &heights[next]]);
        match (signs[k], signs[next]) {
            // The side goes on along the line.
            (Zero, Zero) => kept.push(Corner { side: corner.side.and(line), ..old(corner) }),
            (Zero, Negative) => kept.push(Corner { side: line, ..old(corner) }),
            (Positive, Negative) => {
                kept.push(old(corner));
                kept.push(Corner { at: crossing(), side: line, is_new: true, mark: None });
            }
            (Negative, Positive) => kept.push(Corner { at: crossing(), side: corner.side, is_new: true, mark: None }),
            (Negative, _) => {}
            _ => kept.push(old(corner)),
        }
    }
    (kept.len() >= 3).then_some(kept)
}

/// The point between two corners where the height, linear, is zero.
fn between<const N: usize>([a, b]: [&Corner<N>; 2], heights: [&Lazy; 2]) -> [Lazy; N] {
    std::array::from_fn(|i| {
        let numbers = [[&a.at[i], heights[0]].map(Clone::clone), [&b.at[i], heights[1]].map(Clone::clone)];
        if numbers.iter().all(|[at, _]| at.is_plainly(0.0)) {
            return Lazy::from_f64(0.0);
        }
        formula(numbers, at_zero::<Interval>, at_zero::<Rational>)
    })
}

/// The value where the height is zero, given value and height at two points.
fn at_zero<T: Scalar>([[a, height_a], [b, height_b]]: &[[T; 2]; 2]) -> T {
    a.plus(&height_a.divide(&height_a.minus(height_b)).times(&b.minus(a)))
}
