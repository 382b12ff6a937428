//! Mesh in: coordinates and cells that are known to fit together.

use homeo_core::mesh::SimplicialComplex;

/// A mesh with coordinates, as read.
#[derive(Clone, Debug)]
pub struct SourceMesh<const K: usize> {
    positions: Vec<[f64; 3]>,
    complex: SimplicialComplex<K>,
}

impl<const K: usize> SourceMesh<K> {
    /// Joins coordinates (`#V by 3`) and cells.
    ///
    /// # Panics
    /// If the numbers of vertices differ.
    pub fn new(positions: Vec<[f64; 3]>, complex: SimplicialComplex<K>) -> Self {
        assert_eq!(positions.len(), complex.vertex_count(), "one position for each vertex");
        Self { positions, complex }
    }

    /// Coordinates, `#V by 3`.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Cells.
    pub fn complex(&self) -> &SimplicialComplex<K> {
        &self.complex
    }
}
