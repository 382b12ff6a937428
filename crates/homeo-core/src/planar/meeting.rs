//! Which edges of closed polygons meet where they should not.

use super::Point2;
use crate::predicate::{Sign, orient2d};

/// An edge by its ring and the number of its first vertex in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeId {
    /// Number of the ring.
    pub ring: u32,
    /// Number of the first vertex; the second is the next of the ring.
    pub edge: u32,
}

/// Pairs of edges that meet elsewhere than neighbours do in their common end, the first `limit` found, in order.
///
/// Neighbours count where one folds back on the other; so does an edge of length zero.
///
/// # Complexity
/// A sweep: `O(n log n)` and the number of pairs whose shadows on the first axis overlap.
///
/// ```
/// use homeo_core::planar::meeting_edges;
/// let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let bow_tie = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
/// assert!(meeting_edges(&[square], 10).is_empty());
/// assert_eq!(meeting_edges(&[bow_tie], 10).len(), 1);
/// ```
pub fn meeting_edges(rings: &[Vec<Point2>], limit: usize) -> Vec<[EdgeId; 2]> {
    let all = |(ring, points): (usize, &Vec<Point2>)| {
        (0..points.len() as u32).map(move |edge| EdgeId { ring: ring as u32, edge })
    };
    let mut order: Vec<EdgeId> = rings.iter().enumerate().flat_map(all).collect();
    let ends = |id: EdgeId| {
        let points = &rings[id.ring as usize];
        [points[id.edge as usize], points[(id.edge as usize + 1) % points.len()]]
    };
    let low = |id: EdgeId, axis: usize| ends(id).map(|p| p[axis]).into_iter().fold(f64::INFINITY, f64::min);
    let high = |id: EdgeId, axis: usize| ends(id).map(|p| p[axis]).into_iter().fold(f64::NEG_INFINITY, f64::max);
    order.sort_by(|&i, &j| low(i, 0).total_cmp(&low(j, 0)).then(i.cmp(&j)));
    let mut found = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        for &j in order[place + 1..].iter().take_while(|&&j| low(j, 0) <= high(i, 0)) {
            let apart = low(j, 1) > high(i, 1) || high(j, 1) < low(i, 1);
            let (first, second) = (i.min(j), i.max(j));
            if !apart && meet(first, second, rings[first.ring as usize].len(), ends(first), ends(second)) {
                found.push([first, second]);
                if found.len() == limit {
                    found.sort_unstable();
                    return found;
                }
            }
        }
    }
    found.sort_unstable();
    found
}

/// Whether two edges meet elsewhere than in the end that they share as neighbours of a ring of `n` vertices.
fn meet(first: EdgeId, second: EdgeId, n: usize, [a, b]: [Point2; 2], [c, d]: [Point2; 2]) -> bool {
    let follows = |x: EdgeId, y: EdgeId| x.ring == y.ring && (x.edge as usize + 1) % n == y.edge as usize;
    if first.ring == second.ring && n < 3 {
        return true;
    }
    if follows(first, second) {
        return is_on(a, b, d) || is_on(c, d, a);
    }
    if follows(second, first) {
        return is_on(a, b, c) || is_on(c, d, b);
    }
    let opposite = |x: Sign, y: Sign| x != Sign::Zero && y == x.reversed();
    let crosses = opposite(orient2d(a, b, c), orient2d(a, b, d)) && opposite(orient2d(c, d, a), orient2d(c, d, b));
    crosses || is_on(a, b, c) || is_on(a, b, d) || is_on(c, d, a) || is_on(c, d, b)
}

/// Whether a point lies on a closed segment.
fn is_on(p: Point2, q: Point2, point: Point2) -> bool {
    let is_between = (0..2).all(|k| p[k].min(q[k]) <= point[k] && point[k] <= p[k].max(q[k]));
    is_between && orient2d(p, q, point) == Sign::Zero
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(points: &[Point2]) -> usize {
        meeting_edges(&[points.to_vec()], 100).len()
    }

    #[test]
    fn simplicity_is_exact() {
        let edge = |ring, edge| EdgeId { ring, edge };
        assert_eq!(count(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), 0);
        let bow_tie = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(meeting_edges(&[bow_tie], 9), [[edge(0, 0), edge(0, 2)]]);
        // A vertex on another edge, an edge that folds back, a repeated vertex.
        assert!(count(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]]) > 0);
        assert!(count(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]]) > 0);
        assert!(count(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) > 0);
        assert!(count(&[[0.0, 0.0], [1.0, 0.0]]) > 0);
        // Nearly touching, but not.
        let gap = 1.0f64.next_up();
        assert_eq!(count(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, gap - 1.0], [0.0, 4.0]]), 0);
    }

    #[test]
    fn rings_may_not_touch() {
        let square = |r: f64| vec![[-r, -r], [r, -r], [r, r], [-r, r]];
        assert!(meeting_edges(&[square(2.0), square(1.0)], 9).is_empty());
        let touching = vec![[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]];
        assert!(!meeting_edges(&[square(2.0), touching], 9).is_empty());
        assert!(!meeting_edges(&[square(2.0), square(2.0)], 9).is_empty());
    }
}
