//! Edges, numbered.

use super::{CellId, EdgeId, SimplicialComplex, VertexId};

/// The two local vertices of each local edge of a cell, in the order of [`EdgeIndex::cell_edges`].
/// A triangle uses the first three rows.
pub const CELL_EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [1, 2], [0, 3], [1, 3], [2, 3]];

/// All edges of a complex and the edges of each cell.
#[derive(Clone, Debug)]
pub struct EdgeIndex<const K: usize> {
    edges: Vec<[VertexId; 2]>,
    cell_edges: Vec<EdgeId>,
}

impl<const K: usize> EdgeIndex<K> {
    /// How many edges a cell has.
    pub const PER_CELL: usize = K * (K - 1) / 2;

    pub(super) fn new(complex: &SimplicialComplex<K>) -> Self {
        let per_cell = Self::PER_CELL;
        let mut starts = vec![0u32; complex.vertex_count() + 1];
        let ends = |cell: &[VertexId; K], local: usize| {
            let [a, b] = CELL_EDGES[local].map(|i| cell[i]);
            (a.min(b), a.max(b))
        };
        for cell in complex.cells() {
            for local in 0..per_cell {
                starts[ends(cell, local).0.index() + 1] += 1;
            }
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut slots = vec![(0u32, 0u32); complex.cell_count() * per_cell];
        let mut fill = starts.clone();
        for (index, cell) in complex.cells().iter().enumerate() {
            for local in 0..per_cell {
                let (low, high) = ends(cell, local);
                slots[fill[low.index()] as usize] = (high.raw(), (index * per_cell + local) as u32);
                fill[low.index()] += 1;
            }
        }
        let mut edges = Vec::new();
        let mut cell_edges = vec![EdgeId::new(0); complex.cell_count() * per_cell];
        for (low, window) in starts.windows(2).enumerate() {
            let bucket = &mut slots[window[0] as usize..window[1] as usize];
            bucket.sort_unstable();
            for run in bucket.chunk_by(|a, b| a.0 == b.0) {
                let id = EdgeId::new(edges.len());
                edges.push([VertexId::new(low), VertexId::from(run[0].0)]);
                for &(_, slot) in run {
                    cell_edges[slot as usize] = id;
                }
            }
        }
        Self { edges, cell_edges }
    }

    /// How many edges there are.
    #[inline]
    pub fn len(&self) -> usize {
        self.edges.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// The ends of all edges, `#E by 2`, lower vertex first, in lexicographic order.
    #[inline]
    pub fn ends(&self) -> &[[VertexId; 2]] {
        &self.edges
    }

    /// The edges of `cell`, in the order of [`CELL_EDGES`].
    #[inline]
    pub fn of_cell(&self, cell: CellId) -> &[EdgeId] {
        &self.cell_edges[cell.index() * Self::PER_CELL..][..Self::PER_CELL]
    }

    /// The edges of all cells, one row of [`PER_CELL`](Self::PER_CELL) after the other.
    #[inline]
    pub fn cell_edges(&self) -> &[EdgeId] {
        &self.cell_edges
    }

    /// The edge between two vertices, if there is one. Logarithmic in the number of edges.
    pub fn between(&self, a: VertexId, b: VertexId) -> Option<EdgeId> {
        self.edges.binary_search(&[a.min(b), a.max(b)]).ok().map(EdgeId::new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_has_six_edges() {
        let complex = SimplicialComplex::<4>::from_indices(4, &[[3, 1, 0, 2]]).unwrap();
        let edges = complex.edges();
        assert_eq!(edges.len(), 6);
        for (local, &edge) in edges.of_cell(CellId::new(0)).iter().enumerate() {
            let [a, b] = CELL_EDGES[local].map(|i| complex.cells()[0][i]);
            assert_eq!(edges.between(a, b), Some(edge));
        }
    }
}
