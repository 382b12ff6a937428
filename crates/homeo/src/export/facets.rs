//! The surface that is drawn: the triangles of a surface mesh, or the boundary facets of a volume.

use super::data::CellList;

/// Triangles with the cell that each belongs to.
#[derive(Clone, Debug, Default)]
pub(super) struct Facets {
    /// Vertices of the triangles, seen from outside in counter-clockwise order.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle its cell.
    pub cells: Vec<u32>,
}

/// Facet `i` is opposite vertex `i`; in this order its normal points out of a positive tetrahedron.
const OUTWARD: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The facets that belong to exactly one tetrahedron, or all triangles.
pub(super) fn visible_facets(cells: &CellList) -> Facets {
    match cells {
        CellList::Triangles(triangles) => {
            Facets { triangles: triangles.clone(), cells: (0..triangles.len() as u32).collect() }
        }
        CellList::Tetrahedra(tetrahedra) => boundary_facets(tetrahedra),
    }
}

/// Sorts all facets by their vertices, so that the two copies of an inner facet become neighbours.
fn boundary_facets(tetrahedra: &[[u32; 4]]) -> Facets {
    let mut sorted: Vec<([u32; 3], u32, u8)> = Vec::with_capacity(4 * tetrahedra.len());
    for (cell, corners) in tetrahedra.iter().enumerate() {
        for (facet, local) in OUTWARD.iter().enumerate() {
            let mut key = local.map(|i| corners[i]);
            key.sort_unstable();
            sorted.push((key, cell as u32, facet as u8));
        }
    }
    sorted.sort_unstable();
    let mut facets = Facets::default();
    for run in sorted.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, cell, facet)] = run {
            let corners = &tetrahedra[*cell as usize];
            facets.triangles.push(OUTWARD[*facet as usize].map(|i| corners[i]));
            facets.cells.push(*cell);
        }
    }
    facets
}
