//! Whether a point lies inside of a closed mesh, exactly.

use super::outline::Point;
use crate::number::{orientation_2d, orientation_3d};
use std::cmp::Ordering;

/// Whether a point that is on no triangle lies inside: whether an odd number of triangles is above it. It counts as moved a
/// little in `x` and less in `y`, so that no line up from it meets an edge.
pub(super) fn is_inside(triangles: impl Iterator<Item = [Point; 3]>, at: Point) -> bool {
    triangles.filter(|triangle| is_below(at, triangle)).count() % 2 == 1
}

fn is_below(at: Point, &[a, b, c]: &[Point; 3]) -> bool {
    let is_over = [[a, b], [b, c], [c, a]].into_iter().filter(|&side| is_left(at, side)).count() % 2 == 1;
    is_over && orientation_3d(a, b, c, at) != orientation_2d(a, b, c)
}

/// Whether a ray from the point in the direction of `x` crosses a segment, in the first two coordinates.
fn is_left(at: Point, [a, b]: [Point; 2]) -> bool {
    let [low, high] = if a[1] <= b[1] { [a, b] } else { [b, a] };
    low[1] <= at[1] && at[1] < high[1] && orientation_2d(low, high, at) == Ordering::Greater
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube with a corner cut out, so that coordinates of vertices coincide with those of points.
    #[test]
    fn points_are_inside_or_not() {
        let corner = |k: u32| [k & 1, k >> 1 & 1, k >> 2].map(f64::from);
        let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[Point; 3]> =
            squares.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t: [u32; 3]| t.map(corner)).collect();
        let mut count = [0; 2];
        let steps = [-0.5, 0.0, 0.25, 0.5, 0.75, 1.0, 1.5];
        for at in steps.iter().flat_map(|&x| steps.iter().flat_map(move |&y| steps.map(|z| [x, y, z]))) {
            let is_within = |low: f64, high: f64| at.iter().all(|&x| low < x && x < high);
            let on_surface = at.iter().all(|&x| (0.0..=1.0).contains(&x)) && !is_within(0.0, 1.0);
            if !on_surface {
                assert_eq!(is_inside(triangles.iter().copied(), at), is_within(0.0, 1.0), "{at:?}");
                count[usize::from(is_within(0.0, 1.0))] += 1;
            }
        }
        assert!(count[0] > 100 && count[1] == 27, "{count:?}");
    }
}
