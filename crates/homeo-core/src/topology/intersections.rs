//! Triangles of a surface that meet where they should not.

use std::ops::ControlFlow;

use super::measure::Point;
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
/// Decided by exact signs. Vertices are the same when their numbers are: triangles that touch along
/// equal coordinates with different numbers are reported. Left out are copies of a triangle,
/// triangles that repeat a vertex, and triangles of area zero against their neighbours; the analysis
/// of connectivity and degenerate cells reports those.
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
    let corners = |cell: usize| complex.cells()[cell].map(|v| positions[v.index()]);
    let boxes: Vec<Aabb> = (0..complex.cell_count()).map(|cell| Aabb::of(&corners(cell))).collect();
    let tree = Tree::new(&boxes);
    drop(boxes);
    let mut pairs = Vec::new();
    let complete = tree.overlapping_pairs(|first, second| {
        if meet_illegally(positions, complex.cells()[first], complex.cells()[second]) {
            pairs.push([CellId::new(first), CellId::new(second)]);
        }
        if pairs.len() < MOST_PAIRS { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    pairs.sort_unstable();
    SelfIntersections { pairs, complete }
}

/// Whether two triangles share a point that no common vertex or edge explains.
fn meet_illegally(positions: &[Point], first: [VertexId; 3], second: [VertexId; 3]) -> bool {
    let is_common = first.map(|v| second.contains(&v));
    let common = is_common.iter().filter(|&&c| c).count();
    let at = |v: VertexId| positions[v.index()];
    if common == 0 {
        return !repeats(first) && !repeats(second) && triangles_meet(first.map(at), second.map(at));
    }
    if repeats(first) || repeats(second) || common == 3 {
        return false;
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
