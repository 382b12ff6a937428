//! Cells as lists of vertices.

use super::{Adjacency, CellId, CrowdedFacet, EdgeIndex, VertexId};

/// A pure simplicial complex given by its cells, each of `K` vertices.
///
/// Invariant: every index of a cell is below [`vertex_count`](Self::vertex_count).
/// Nothing else is assumed: cells may repeat vertices or overlap; [`crate::topology`] says so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SimplicialComplex<const K: usize> {
    vertex_count: usize,
    cells: Vec<[VertexId; K]>,
}

/// Triangles.
pub type TriangleComplex = SimplicialComplex<3>;
/// Tetrahedra.
pub type TetrahedronComplex = SimplicialComplex<4>;

/// A cell names a vertex that does not exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cell {cell} names vertex {vertex}, but there are only {vertex_count} vertices")]
pub struct IndexOutOfRange {
    /// The cell.
    pub cell: usize,
    /// The index that it names.
    pub vertex: u32,
    /// How many vertices there are.
    pub vertex_count: usize,
}

impl<const K: usize> SimplicialComplex<K> {
    /// The complex of `cells` (`#C by K`) on `vertex_count` vertices.
    ///
    /// # Errors
    /// The first cell with an index out of range.
    pub fn new(vertex_count: usize, cells: Vec<[VertexId; K]>) -> Result<Self, IndexOutOfRange> {
        for (cell, vertices) in cells.iter().enumerate() {
            if let Some(bad) = vertices.iter().find(|v| v.index() >= vertex_count) {
                return Err(IndexOutOfRange { cell, vertex: bad.raw(), vertex_count });
            }
        }
        Ok(Self { vertex_count, cells })
    }

    /// Same as [`new`](Self::new) from plain numbers.
    ///
    /// # Errors
    /// The first cell with an index out of range.
    pub fn from_indices(vertex_count: usize, cells: &[[u32; K]]) -> Result<Self, IndexOutOfRange> {
        Self::new(vertex_count, cells.iter().map(|c| c.map(VertexId::from)).collect())
    }

    /// How many vertices there are, those that no cell names included.
    #[inline]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// How many cells there are.
    #[inline]
    pub fn cell_count(&self) -> usize {
        self.cells.len()
    }

    /// All cells, `#C by K`.
    #[inline]
    pub fn cells(&self) -> &[[VertexId; K]] {
        &self.cells
    }

    /// The vertices of `cell`.
    #[inline]
    pub fn cell(&self, cell: CellId) -> [VertexId; K] {
        self.cells[cell.index()]
    }

    /// The ids of all cells, in order.
    pub fn cell_ids(&self) -> impl ExactSizeIterator<Item = CellId> + use<K> {
        (0..self.cells.len()).map(CellId::new)
    }

    /// Which cells lie on the two sides of each facet.
    ///
    /// # Errors
    /// A facet that belongs to three or more cells: the complex is no manifold.
    /// # Complexity
    /// Linear in the number of cells (bucket sort by lowest vertex).
    pub fn adjacency(&self) -> Result<Adjacency<K>, CrowdedFacet<K>> {
        Adjacency::new(self)
    }

    /// The edges, numbered.
    pub fn edges(&self) -> EdgeIndex<K> {
        EdgeIndex::new(self)
    }

    /// Vertices of the facet opposite vertex `opposite` of `cell`, in the order of the cell.
    #[inline]
    pub fn facet_vertices(&self, cell: CellId, opposite: usize) -> impl Iterator<Item = VertexId> {
        let vertices = self.cells[cell.index()];
        (0..K).filter(move |&i| i != opposite).map(move |i| vertices[i])
    }

    /// How many cells contain each vertex.
    pub fn vertex_degrees(&self) -> Vec<u32> {
        let mut degrees = vec![0; self.vertex_count];
        for cell in &self.cells {
            for vertex in cell {
                degrees[vertex.index()] += 1;
            }
        }
        degrees
    }
}
