//! Convex polygons, exactly.

use homeo_core::number::{Lazy, Scalar};
use homeo_core::predicate::Sign;

/// On which edges of triangles a side of a polygon lies, by the corners opposite to them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Edges {
    /// Of the source's triangle.
    pub of_source: Option<u8>,
    /// Of the section's triangle.
    pub of_section: Option<u8>,
}

impl Edges {
    /// What either knows.
    fn and(self, other: Self) -> Self {
        Self { of_source: self.of_source.or(other.of_source), of_section: self.of_section.or(other.of_section) }
    }
}

/// A corner of a polygon in some affine coordinates, and the side from it to the next corner.
#[derive(Clone, Debug)]
pub(super) struct Corner<const N: usize> {
    pub at: [Lazy; N],
    pub side: Edges,
}

/// Twice the area of the triangle of three points of the plane.
pub(super) fn turn(a: &[Lazy; 2], b: &[Lazy; 2], p: &[Lazy; 2]) -> Lazy {
    let (u, v) = ([b[0].minus(&a[0]), b[1].minus(&a[1])], [p[0].minus(&a[0]), p[1].minus(&a[1])]);
    u[0].times(&v[1]).minus(&u[1].times(&v[0]))
}

/// Twice the area of a convex polygon.
pub(super) fn doubled_area(corners: &[&[Lazy; 2]]) -> Lazy {
    let fan = corners.windows(2).skip(1).map(|pair| turn(corners[0], pair[0], pair[1]));
    fan.fold(Lazy::from_f64(0.0), |sum, area| sum.plus(&area))
}

/// The part of a convex polygon in another one, both counter-clockwise; empty without an area.
pub(super) fn intersection(polygon: &[Corner<2>], other: &[Corner<2>]) -> Vec<Corner<2>> {
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

/// The part of a convex polygon on the closed positive side of a line that lies on some edges, given the heights of its
/// corners over the line and their signs; `None` if it has no area.
pub(super) fn clipped<const N: usize>(
    corners: Vec<Corner<N>>,
    signs: &[Sign],
    heights: &[Lazy],
    line: Edges,
) -> Option<Vec<Corner<N>>> {
    use Sign::{Negative, Positive, Zero};
    if !signs.contains(&Positive) {
        return None;
    }
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (k, corner) in corners.iter().enumerate() {
        let next = (k + 1) % corners.len();
        let crossing = || between([corner, &corners[next]], [&heights[k], &heights[next]]);
        match (signs[k], signs[next]) {
            // The side goes on along the line.
            (Zero, Zero) => kept.push(Corner { side: corner.side.and(line), ..corner.clone() }),
            (Zero, Negative) => kept.push(Corner { side: line, ..corner.clone() }),
            (Positive, Negative) => {
                kept.push(corner.clone());
                kept.push(Corner { at: crossing(), side: line });
            }
            (Negative, Positive) => kept.push(Corner { at: crossing(), side: corner.side }),
            (Negative, _) => {}
            _ => kept.push(corner.clone()),
        }
    }
    (kept.len() >= 3).then_some(kept)
}

/// The point between two corners where the height, linear, is zero.
fn between<const N: usize>([a, b]: [&Corner<N>; 2], heights: [&Lazy; 2]) -> [Lazy; N] {
    let share = heights[0].divide(&heights[0].minus(heights[1]));
    std::array::from_fn(|i| a.at[i].plus(&share.times(&b.at[i].minus(&a.at[i]))))
}
