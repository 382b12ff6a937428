//! Triangles of a surface that meet where they should not.

use std::ops::ControlFlow;

use super::measure::{Point, coincident};
use crate::mesh::{CellId, TriangleComplex, VertexId};
use crate::predicate::{
    is_degenerate_triangle, triangles_meet, triangles_meet_beyond_edge, triangles_meet_beyond_vertex,
};
use crate::spatial::{Aabb, Tree};

/// The search stops after this many pairs, so that memory stays bounded.
const MOST_PAIRS: usize = 1_000_000;

/// Pairs of triangles that meet where they should not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SelfIntersections {
    /// The pairs, each ascending, in ascending order.
    pub pairs: Vec<[CellId; 2]>,
    /// Whether these are all of them; the search gives up after a million.
    pub complete: bool,
}

/// Pairs of triangles that share a point other than those of their common vertices or edge.
///
/// # Guarantee
/// Decided by exact signs. Vertices at equal points count as one here, so that the two banks of a cut
/// may touch; the analysis reports such vertices apart. Left out are copies of a triangle with the
/// same vertex numbers, triangles that repeat a vertex, and triangles of area zero against their
/// neighbours; the analysis of connectivity and degenerate cells reports those.
///
/// # Preconditions
/// One point for each vertex, with coordinates as [`crate::predicate`] asks for.
///
/// # Complexity
/// `O(n log n)` and linear in the number of bounding boxes that meet.
///
/// ```
/// use homeo_core::{mesh::TriangleComplex, topology::self_intersections};
/// let complex = TriangleComplex::from_indices(6, &[[0, 1, 2], [3, 4, 5]]).unwrap();
/// let mut positions = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
/// positions.extend([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]);
/// assert_eq!(self_intersections(&positions, &complex).pairs.len(), 1);
/// ```
pub fn self_intersections(positions: &[Point], complex: &TriangleComplex) -> SelfIntersections {
    find_with(positions, complex, &coincident(positions))
}

/// Same, with the pairs of [`coincident`] vertices at hand.
pub(super) fn find_with(positions: &[Point], complex: &TriangleComplex, same: &[[u32; 2]]) -> SelfIntersections {
    let cells = complex.cells();
    let boxes: Vec<Aabb> = cells.iter().map(|cell| Aabb::of(&cell.map(|v| positions[v.index()]))).collect();
    let merged: Option<Vec<[VertexId; 3]>> = (!same.is_empty()).then(|| {
        let mut first: Vec<u32> = (0..positions.len() as u32).collect();
        same.iter().for_each(|&[kept, copy]| first[copy as usize] = kept);
        cells.iter().map(|cell| cell.map(|v| VertexId::from(first[v.index()]))).collect()
    });
    let merged = merged.as_deref().unwrap_or(cells);
    let tree = Tree::new(&boxes);
    drop(boxes);
    let mut pairs = Vec::new();
    let complete = tree.overlapping_pairs(|first, second| {
        let is_copy = || cells[first].iter().all(|v| cells[second].contains(v));
        if meet_illegally(positions, merged[first], merged[second], is_copy) {
            pairs.push([CellId::new(first), CellId::new(second)]);
        }
        if pairs.len() < MOST_PAIRS { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    pairs.sort_unstable();
    SelfIntersections { pairs, complete }
}

/// Whether two triangles share a point that no common vertex or edge explains.
fn meet_illegally(
    positions: &[Point],
    first: [VertexId; 3],
    second: [VertexId; 3],
    is_copy: impl Fn() -> bool,
) -> bool {
    let is_common = first.map(|v| second.contains(&v));
    let common = is_common.iter().filter(|&&c| c).count();
    let at = |v: VertexId| positions[v.index()];
    if common == 0 {
        return !repeats(first) && !repeats(second) && triangles_meet(first.map(at), second.map(at));
    }
    if repeats(first) || repeats(second) {
        return false;
    }
    if common == 3 {
        return !is_copy();
    }
    if common == 1 {
        let [apex, a, b] = rotated(first, |v| second.contains(&v)).map(at);
        let [_, c, d] = rotated(second, |v| first.contains(&v)).map(at);
        return triangles_meet_beyond_vertex(apex, [a, b], [c, d])
            && !is_degenerate_triangle(apex, a, b)
            && !is_degenerate_triangle(apex, c, d);
    }
    let [a, u, v] = rotated(first, |v| !second.contains(&v)).map(at);
    let [b, _, _] = rotated(second, |v| !first.contains(&v)).map(at);
    triangles_meet_beyond_edge([u, v], a, b) && !is_degenerate_triangle(a, u, v) && !is_degenerate_triangle(b, u, v)
}

fn repeats([a, b, c]: [VertexId; 3]) -> bool {
    a == b || b == c || c == a
}

/// The triangle turned so that its first vertex is the one that is wanted.
fn rotated([a, b, c]: [VertexId; 3], is_wanted: impl Fn(VertexId) -> bool) -> [VertexId; 3] {
    if is_wanted(a) {
        [a, b, c]
    } else if is_wanted(b) {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
