//! Gluing of cells along facets.

use super::{CellId, SimplicialComplex, VertexId};

/// One side of a facet: a cell and the number of its vertex opposite the facet.
///
/// Stored in 32 bits; [`Facet::NONE`] marks "nothing on that side".
#[repr(transparent)]
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Facet(u32);

impl Facet {
    /// No cell on that side: the facet lies on the boundary.
    pub const NONE: Self = Self(u32::MAX);

    /// Facet of `cell` opposite its vertex number `opposite`.
    #[inline]
    pub fn new(cell: CellId, opposite: usize) -> Self {
        debug_assert!(opposite < 4 && cell.index() < (1 << 30) - 1);
        Self(cell.raw() << 2 | opposite as u32)
    }

    /// Whether there is a cell on that side.
    #[inline]
    pub fn is_some(self) -> bool {
        self != Self::NONE
    }

    /// Whether there is none.
    #[inline]
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// The cell. Meaningless for [`Facet::NONE`].
    #[inline]
    pub fn cell(self) -> CellId {
        debug_assert!(self.is_some(), "the boundary has no cell on its far side");
        CellId::from(self.0 >> 2)
    }

    /// The number, in the cell, of the vertex opposite the facet.
    #[inline]
    pub fn opposite(self) -> usize {
        (self.0 & 3) as usize
    }
}

impl std::fmt::Debug for Facet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.is_none() { f.write_str("boundary") } else { write!(f, "{}/{}", self.cell(), self.opposite()) }
    }
}

/// A facet with more than two cells.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("facet {vertices:?} belongs to {} cells, the first being {:?}", cells.len(), &cells[..cells.len().min(4)])]
pub struct CrowdedFacet<const K: usize> {
    /// Its `K - 1` vertices, ascending.
    pub vertices: Vec<VertexId>,
    /// All its cells, ascending.
    pub cells: Vec<CellId>,
}

/// For each facet of each cell, the cell on the other side.
#[derive(Clone, Debug)]
pub struct Adjacency<const K: usize> {
    across: Vec<[Facet; K]>,
}

impl<const K: usize> Adjacency<K> {
    pub(super) fn new(complex: &SimplicialComplex<K>) -> Result<Self, CrowdedFacet<K>> {
        let mut across = vec![[Facet::NONE; K]; complex.cell_count()];
        let mut crowded = None;
        for_each_shared_facet(complex, |facets| match facets {
            [_] => {}
            &[first, second] => {
                across[first.cell().index()][first.opposite()] = second;
                across[second.cell().index()][second.opposite()] = first;
            }
            many => {
                crowded.get_or_insert_with(|| CrowdedFacet {
                    vertices: sorted_facet(complex, many[0]),
                    cells: many.iter().map(|f| f.cell()).collect(),
                });
            }
        });
        match crowded {
            None => Ok(Self { across }),
            Some(facet) => Err(facet),
        }
    }

    /// What lies across facet `opposite` of `cell`: the neighbour and the facet's number there.
    #[inline]
    pub fn across(&self, cell: CellId, opposite: usize) -> Facet {
        self.across[cell.index()][opposite]
    }

    /// All of it, `#C by K`.
    #[inline]
    pub fn table(&self) -> &[[Facet; K]] {
        &self.across
    }

    /// The same gluing with cells in another order: `order` lists the present numbers of all cells.
    #[must_use]
    pub fn reordered(&self, order: &[CellId]) -> Self {
        let mut place = vec![CellId::new(0); order.len()];
        order.iter().enumerate().for_each(|(new, old)| place[old.index()] = CellId::new(new));
        let moved = |facet: Facet| {
            if facet.is_none() { facet } else { Facet::new(place[facet.cell().index()], facet.opposite()) }
        };
        Self { across: order.iter().map(|old| self.across[old.index()].map(moved)).collect() }
    }

    /// Facets with nothing on the other side, by ascending cell.
    pub fn boundary_facets(&self) -> impl Iterator<Item = Facet> + '_ {
        self.across
            .iter()
            .enumerate()
            .flat_map(|(cell, row)| (0..K).filter(|&i| row[i].is_none()).map(move |i| Facet::new(CellId::new(cell), i)))
    }

    /// Whether each vertex lies on a boundary facet.
    pub fn boundary_vertices(&self, complex: &SimplicialComplex<K>) -> Vec<bool> {
        let mut on_boundary = vec![false; complex.vertex_count()];
        for facet in self.boundary_facets() {
            for vertex in complex.facet_vertices(facet.cell(), facet.opposite()) {
                on_boundary[vertex.index()] = true;
            }
        }
        on_boundary
    }
}

/// Vertices of a facet, ascending.
pub(crate) fn sorted_facet<const K: usize>(complex: &SimplicialComplex<K>, facet: Facet) -> Vec<VertexId> {
    let mut vertices: Vec<_> = complex.facet_vertices(facet.cell(), facet.opposite()).collect();
    vertices.sort_unstable();
    vertices
}

/// Calls `visit` once for each facet with all the cells' sides of it, ascending.
///
/// Facets are bucketed by their lowest vertex and sorted inside the bucket, which is linear for
/// meshes of bounded degree and independent of hashing.
pub(crate) fn for_each_shared_facet<const K: usize>(complex: &SimplicialComplex<K>, mut visit: impl FnMut(&[Facet])) {
    let key = |cell: &[VertexId; K], opposite: usize| -> (u32, u64) {
        let mut rest = [0u32; K];
        let mut count = 0;
        for (i, vertex) in cell.iter().enumerate() {
            if i != opposite {
                rest[count] = vertex.raw();
                count += 1;
            }
        }
        rest[..count].sort_unstable();
        let low = rest[0];
        let high = rest[1..count].iter().fold(0u64, |key, &v| key << 32 | u64::from(v));
        (low, high)
    };

    let mut starts = vec![0u32; complex.vertex_count() + 1];
    for cell in complex.cells() {
        for opposite in 0..K {
            starts[key(cell, opposite).0 as usize + 1] += 1;
        }
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut slots = vec![(0u64, Facet::NONE); complex.cell_count() * K];
    let mut fill = starts.clone();
    for (index, cell) in complex.cells().iter().enumerate() {
        for opposite in 0..K {
            let (low, high) = key(cell, opposite);
            slots[fill[low as usize] as usize] = (high, Facet::new(CellId::new(index), opposite));
            fill[low as usize] += 1;
        }
    }
    let mut group = Vec::new();
    for window in starts.windows(2) {
        let bucket = &mut slots[window[0] as usize..window[1] as usize];
        bucket.sort_unstable();
        for run in bucket.chunk_by(|a, b| a.0 == b.0) {
            group.clear();
            group.extend(run.iter().map(|&(_, facet)| facet));
            visit(&group);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_tetrahedra_share_one_facet() {
        let complex = SimplicialComplex::<4>::from_indices(5, &[[0, 1, 2, 3], [1, 2, 3, 4]]).unwrap();
        let adjacency = complex.adjacency().unwrap();
        let facet = adjacency.across(CellId::new(0), 0);
        assert_eq!((facet.cell(), facet.opposite()), (CellId::new(1), 3));
        assert_eq!(adjacency.across(CellId::new(1), 3), Facet::new(CellId::new(0), 0));
        assert_eq!(adjacency.boundary_facets().count(), 6);
    }

    #[test]
    fn three_triangles_on_an_edge_are_named() {
        let complex = SimplicialComplex::<3>::from_indices(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]).unwrap();
        let crowded = complex.adjacency().unwrap_err();
        assert_eq!(crowded.vertices, [VertexId::new(0), VertexId::new(1)]);
        assert_eq!(crowded.cells.len(), 3);
    }

    #[test]
    fn boundary_vertices_of_a_fan() {
        let complex = SimplicialComplex::<3>::from_indices(4, &[[0, 1, 2], [0, 2, 3], [0, 3, 1]]).unwrap();
        let adjacency = complex.adjacency().unwrap();
        assert_eq!(adjacency.boundary_vertices(&complex), [false, true, true, true]);
    }
}
