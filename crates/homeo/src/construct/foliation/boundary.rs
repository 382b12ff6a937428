//! The boundary of a mesh as a mesh of its own: a loop of edges or a surface of triangles.

use homeo_core::mesh::{Adjacency, CellId, Facet, SimplicialComplex, TriangleComplex, VertexId};

/// The boundary facets that follow one another round the boundary of a triangle mesh, with the mesh
/// on the left, beginning at the lowest vertex. Empty when the boundary is not one loop.
pub(super) fn boundary_loop<const K: usize>(complex: &SimplicialComplex<K>, adjacency: &Adjacency<K>) -> Vec<Facet> {
    debug_assert_eq!(K, 3);
    let mut next = vec![Facet::NONE; complex.vertex_count()];
    let mut count = 0;
    for facet in adjacency.boundary_facets() {
        next[edge_start(complex, facet).index()] = facet;
        count += 1;
    }
    let Some(&first) = next.iter().find(|facet| facet.is_some()) else { return Vec::new() };
    let mut facets = vec![first];
    loop {
        let facet = next[edge_end(complex, *facets.last().expect("not empty")).index()];
        if facet == first {
            return if facets.len() == count { facets } else { Vec::new() };
        }
        if facet.is_none() || facets.len() == count {
            return Vec::new();
        }
        facets.push(facet);
    }
}

/// First vertex of an edge facet, the mesh being on the left.
pub(super) fn edge_start<const K: usize>(complex: &SimplicialComplex<K>, facet: Facet) -> VertexId {
    complex.cell(facet.cell())[(facet.opposite() + 1) % 3]
}

/// Last vertex of an edge facet, the mesh being on the left.
pub(super) fn edge_end<const K: usize>(complex: &SimplicialComplex<K>, facet: Facet) -> VertexId {
    complex.cell(facet.cell())[(facet.opposite() + 2) % 3]
}

/// Part of the boundary of a tetrahedral mesh as a triangle mesh with vertices of its own.
#[derive(Clone, Debug)]
pub(super) struct BoundarySurface {
    /// The boundary facet that each triangle is.
    pub facets: Vec<Facet>,
    /// Triangles; their orientation shows the inside of the volume when counter-clockwise.
    pub triangles: TriangleComplex,
    /// The vertex of the volume that each vertex is.
    pub vertices: Vec<VertexId>,
}

/// Corners of each facet of a positive tetrahedron, counter-clockwise when seen from inside.
const INWARD_FACETS: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

impl BoundarySurface {
    /// The surface made of the given facets, in their order.
    pub fn new<const K: usize>(complex: &SimplicialComplex<K>, facets: Vec<Facet>) -> Self {
        debug_assert_eq!(K, 4);
        let mut number = vec![u32::MAX; complex.vertex_count()];
        let mut vertices = Vec::new();
        let triangles: Vec<[VertexId; 3]> = facets
            .iter()
            .map(|facet| {
                let corners = complex.cell(facet.cell());
                INWARD_FACETS[facet.opposite()].map(|i| {
                    let vertex = corners[i];
                    if number[vertex.index()] == u32::MAX {
                        number[vertex.index()] = vertices.len() as u32;
                        vertices.push(vertex);
                    }
                    VertexId::from(number[vertex.index()])
                })
            })
            .collect();
        let triangles = SimplicialComplex::new(vertices.len(), triangles).expect("numbered above (please report this)");
        Self { facets, triangles, vertices }
    }

    /// Coordinates of its vertices.
    pub fn positions(&self, positions: &[[f64; 3]]) -> Vec<[f64; 3]> {
        self.vertices.iter().map(|v| positions[v.index()]).collect()
    }
}

/// A mask per cell with a bit for each of the given facets.
pub(super) fn facet_masks(cell_count: usize, facets: impl IntoIterator<Item = Facet>) -> Vec<u8> {
    let mut masks = vec![0; cell_count];
    for facet in facets {
        masks[facet.cell().index()] |= 1 << facet.opposite();
    }
    masks
}

/// The facets that masks mark, by ascending cell.
pub(super) fn marked_facets(masks: &[u8]) -> impl Iterator<Item = Facet> + '_ {
    masks.iter().enumerate().filter(|&(_, &mask)| mask != 0).flat_map(|(cell, &mask)| {
        (0..4).filter(move |i| mask >> i & 1 == 1).map(move |i| Facet::new(CellId::new(cell), i))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use homeo_core::predicate::{Sign, orient3d};

    #[test]
    fn inward_facets_show_the_opposite_vertex_above() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for (opposite, facet) in INWARD_FACETS.iter().enumerate() {
            let [a, b, c] = facet.map(|i| corners[i]);
            assert_eq!(orient3d(a, b, c, corners[opposite]), Sign::Positive);
        }
    }

    #[test]
    fn loop_of_a_square_runs_with_the_mesh_on_the_left() {
        let complex = SimplicialComplex::<3>::from_indices(4, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let adjacency = complex.adjacency().unwrap();
        let starts: Vec<_> =
            boundary_loop(&complex, &adjacency).iter().map(|&f| edge_start(&complex, f).raw()).collect();
        assert_eq!(starts, [0, 1, 2, 3]);
    }
}
