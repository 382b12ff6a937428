//! Vertex links of a tetrahedral complex.

use super::connectivity::{Corners, LinkWalk, number_of};
use super::gluing::Gluing;
use crate::mesh::{Facet, TetrahedronComplex, VertexId};

/// Distinct edges of a tetrahedral complex, counted.
pub(super) struct EdgeCounts {
    /// All of them.
    pub total: usize,
    /// Those at each vertex.
    pub at: Vec<u32>,
    /// Those with both ends on the boundary.
    pub between_boundary_vertices: usize,
}

impl EdgeCounts {
    /// Linear: each vertex marks its neighbours.
    pub(super) fn new(complex: &TetrahedronComplex, corners: &Corners, on_boundary: &[bool]) -> Self {
        let vertex_count = complex.vertex_count();
        let mut counts = Self { total: 0, at: vec![0; vertex_count], between_boundary_vertices: 0 };
        let mut marked_by = vec![u32::MAX; vertex_count];
        for vertex in 0..vertex_count {
            for corner in corners.at(vertex) {
                for other in complex.cell(corner.cell()) {
                    let other = other.index();
                    if other > vertex && marked_by[other] != vertex as u32 {
                        marked_by[other] = vertex as u32;
                        counts.total += 1;
                        counts.at[vertex] += 1;
                        counts.at[other] += 1;
                        counts.between_boundary_vertices += usize::from(on_boundary[vertex] && on_boundary[other]);
                    }
                }
            }
        }
        counts
    }
}

/// Vertices whose link is neither a sphere nor a disk.
///
/// The link of a vertex is a complex of triangles, one for each cell there. Where no facet is
/// crowded its edges have at most two triangles. Take it apart at its pinch points: what hangs
/// together by edges becomes a connected surface, whose Euler characteristic is at most 2, at most 1
/// with boundary, and drops by at least one for each pinch point closed again. Hence a link that hangs
/// together by edges is a sphere if and only if it has no boundary and the number is 2, and a disk if
/// and only if it has boundary and the number is 1.
pub(super) fn bad_links(
    complex: &TetrahedronComplex,
    gluing: &Gluing<4>,
    corners: &Corners,
    edges_at: &[u32],
) -> Vec<u32> {
    let mut walk = LinkWalk::new(complex.cell_count());
    let is_bad = |&vertex: &u32| {
        let v = vertex as usize;
        let fan = corners.at(v);
        if fan.is_empty() {
            return false;
        }
        let euler = i64::from(edges_at[v]) - i64::from(gluing.facets_at[v]) + fan.len() as i64;
        let wanted = if gluing.on_boundary[v] { 1 } else { 2 };
        !walk.is_connected(complex, gluing, fan) || euler != wanted
    };
    (0..complex.vertex_count() as u32).filter(is_bad).collect()
}

/// Edges at the given vertices whose cells form more than one fan, each once.
pub(super) fn split_edges(
    complex: &TetrahedronComplex,
    gluing: &Gluing<4>,
    corners: &Corners,
    vertices: &[u32],
) -> Vec<[u32; 2]> {
    let mut edges = Vec::new();
    for &vertex in vertices {
        // All (far end, cell) at the vertex, by far end.
        let mut fans: Vec<(u32, u32)> = Vec::new();
        for corner in corners.at(vertex as usize) {
            let others = complex.facet_vertices(corner.cell(), corner.opposite());
            fans.extend(others.map(|other| (other.raw(), corner.cell().raw())));
        }
        fans.sort_unstable();
        for fan in fans.chunk_by(|a, b| a.0 == b.0) {
            let ends = [VertexId::from(vertex), VertexId::from(fan[0].0)];
            let cells: Vec<u32> = fan.iter().map(|&(_, cell)| cell).collect();
            if !is_one_fan(complex, gluing, ends, &cells) {
                edges.push([vertex.min(fan[0].0), vertex.max(fan[0].0)]);
            }
        }
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Whether the cells at an edge (ascending) hang together by facets at the edge.
fn is_one_fan(complex: &TetrahedronComplex, gluing: &Gluing<4>, ends: [VertexId; 2], cells: &[u32]) -> bool {
    let mut reached = vec![false; cells.len()];
    reached[0] = true;
    let mut stack = vec![0];
    let mut count = 1;
    while let Some(index) = stack.pop() {
        let cell = cells[index] as usize;
        let numbers = ends.map(|end| number_of(&complex.cells()[cell], end));
        let at_edge = |&i: &usize| !numbers.contains(&i);
        for facet in (0..4).filter(at_edge).map(|i| gluing.across[cell][i]).filter(|f: &Facet| f.is_some()) {
            if let Ok(next) = cells.binary_search(&facet.cell().raw())
                && !reached[next]
            {
                reached[next] = true;
                count += 1;
                stack.push(next);
            }
        }
    }
    count == cells.len()
}
