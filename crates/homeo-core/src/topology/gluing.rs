//! Which cells share which facets, and which way they turn; nothing is refused.

use std::borrow::Cow;

use crate::mesh::{CellId, Facet, SimplicialComplex, VertexId};

/// A facet and how its cells see it.
#[derive(Clone, Copy, Default)]
struct Slot {
    /// The vertices of the facet but the lowest, ascending, packed.
    key: u64,
    /// Cell and opposite vertex, packed as in [`Facet`].
    facet: u32,
    /// Whether the cell induces the odd orientation of the ascending vertices.
    odd: bool,
}

/// Cells glued along facets. In contrast to [`crate::mesh::Adjacency`] it exists for every complex.
pub(super) struct Gluing<const K: usize> {
    /// What lies across each facet; nothing at the boundary and at crowded facets.
    pub across: Vec<[Facet; K]>,
    /// Bit `i`: facet `i` is glued to a cell that turns the same way; bit `4 + i`: it is crowded.
    flags: Vec<u8>,
    /// All cells of each facet that has more than two.
    pub crowded: Vec<Vec<Facet>>,
    /// Number of distinct facets.
    pub facet_count: usize,
    /// Number of facets of exactly one cell.
    pub boundary_count: usize,
    /// Number of distinct facets at each vertex.
    pub facets_at: Vec<u32>,
    /// Whether a vertex lies on a facet of exactly one cell.
    pub on_boundary: Vec<bool>,
    /// Cells with the same vertices as an earlier one, ascending.
    pub duplicates: Vec<u32>,
}

impl<const K: usize> Gluing<K> {
    /// Glues the cells of a complex in which no cell repeats a vertex.
    ///
    /// Linear for meshes of bounded degree: facets are bucketed by their lowest vertex and sorted
    /// inside the bucket.
    pub(super) fn new(complex: &SimplicialComplex<K>) -> Self {
        let cells = complex.cells();
        let mut gluing = Self {
            across: vec![[Facet::NONE; K]; cells.len()],
            flags: vec![0; cells.len()],
            crowded: Vec::new(),
            facet_count: 0,
            boundary_count: 0,
            facets_at: vec![0; complex.vertex_count()],
            on_boundary: vec![false; complex.vertex_count()],
            duplicates: Vec::new(),
        };
        let (starts, mut slots) = bucketed(complex);
        for (low, window) in starts.windows(2).enumerate() {
            let bucket = &mut slots[window[0] as usize..window[1] as usize];
            bucket.sort_unstable_by_key(|slot| (slot.key, slot.facet));
            for group in bucket.chunk_by(|a, b| a.key == b.key) {
                gluing.record(cells, VertexId::new(low), group);
            }
        }
        gluing.duplicates.sort_unstable();
        gluing.duplicates.dedup();
        gluing
    }

    fn record(&mut self, cells: &[[VertexId; K]], low: VertexId, group: &[Slot]) {
        self.facet_count += 1;
        let rest = [(group[0].key >> 32) as u32, group[0].key as u32].map(VertexId::from);
        let vertices = [low, rest[1], rest[0]];
        for vertex in &vertices[..K - 1] {
            self.facets_at[vertex.index()] += 1;
        }
        match group {
            [_] => {
                self.boundary_count += 1;
                for vertex in &vertices[..K - 1] {
                    self.on_boundary[vertex.index()] = true;
                }
            }
            [first, second] => {
                let [a, b] = [facet(first), facet(second)];
                self.across[a.cell().index()][a.opposite()] = b;
                self.across[b.cell().index()][b.opposite()] = a;
                if first.odd != second.odd {
                    self.flags[a.cell().index()] |= 1 << a.opposite();
                    self.flags[b.cell().index()] |= 1 << b.opposite();
                }
            }
            many => {
                for slot in many {
                    self.flags[facet(slot).cell().index()] |= 16 << facet(slot).opposite();
                }
                self.crowded.push(many.iter().map(facet).collect());
            }
        }
        if group.len() > 1 {
            self.note_duplicates(cells, group);
        }
    }

    /// Cells on one facet with the same opposite vertex have the same vertices.
    fn note_duplicates(&mut self, cells: &[[VertexId; K]], group: &[Slot]) {
        let tip = |slot: &Slot| cells[facet(slot).cell().index()][facet(slot).opposite()];
        if let [first, second] = group {
            if tip(first) == tip(second) {
                self.duplicates.push(facet(second).cell().raw());
            }
            return;
        }
        let mut tips: Vec<_> = group.iter().map(|slot| (tip(slot), facet(slot).cell().raw())).collect();
        tips.sort_unstable();
        for same in tips.chunk_by(|a, b| a.0 == b.0) {
            self.duplicates.extend(same[1..].iter().map(|&(_, cell)| cell));
        }
    }

    /// Whether the cells on both sides of a glued facet turn the same way.
    #[inline]
    pub(super) fn agrees(&self, cell: usize, opposite: usize) -> bool {
        self.flags[cell] >> opposite & 1 == 1
    }

    /// Whether no other cell has this facet.
    #[inline]
    pub(super) fn is_boundary(&self, cell: usize, opposite: usize) -> bool {
        self.across[cell][opposite].is_none() && self.flags[cell] >> (4 + opposite) & 1 == 0
    }

    /// Facets of exactly one cell, by ascending cell.
    pub(super) fn boundary_facets(&self) -> impl Iterator<Item = Facet> + '_ {
        (0..self.across.len())
            .flat_map(|cell| (0..K).map(move |i| (cell, i)))
            .filter(|&(cell, i)| self.is_boundary(cell, i))
            .map(|(cell, i)| Facet::new(CellId::new(cell), i))
    }
}

#[inline]
fn facet(slot: &Slot) -> Facet {
    Facet::new(CellId::from(slot.facet >> 2), (slot.facet & 3) as usize)
}

/// All facets of all cells, bucketed by their lowest vertex.
fn bucketed<const K: usize>(complex: &SimplicialComplex<K>) -> (Vec<u32>, Vec<Slot>) {
    let mut starts = vec![0u32; complex.vertex_count() + 1];
    for cell in complex.cells() {
        // All facets but one have the lowest vertex of the cell as theirs.
        let mut sorted = cell.map(VertexId::raw);
        sorted.sort_unstable();
        starts[sorted[0] as usize + 1] += K as u32 - 1;
        starts[sorted[1] as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut slots = vec![Slot::default(); complex.cell_count() * K];
    let mut fill = starts.clone();
    for (index, cell) in complex.cells().iter().enumerate() {
        for opposite in 0..K {
            let (low, key, odd) = facet_key(cell, opposite);
            let place = &mut fill[low as usize];
            slots[*place as usize] = Slot { key, facet: (index << 2 | opposite) as u32, odd };
            *place += 1;
        }
    }
    (starts, slots)
}

/// The lowest vertex of a facet, the others packed, and the parity of the induced orientation.
#[inline]
fn facet_key<const K: usize>(cell: &[VertexId; K], opposite: usize) -> (u32, u64, bool) {
    let mut rest = [u32::MAX; 3];
    let mut count = 0;
    for (i, vertex) in cell.iter().enumerate() {
        if i != opposite {
            rest[count] = vertex.raw();
            count += 1;
        }
    }
    let mut odd = opposite % 2 == 1;
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if j < count && rest[i] > rest[j] {
            rest.swap(i, j);
            odd = !odd;
        }
    }
    let high = if K == 4 { u64::from(rest[1]) << 32 | u64::from(rest[2]) } else { u64::from(rest[1]) };
    (rest[0], high, odd)
}

/// The cells that the analysis of connectivity can use: no repeated vertices, no copies.
pub(super) struct ProperCells<'a, const K: usize> {
    /// The complex of these cells.
    pub complex: Cow<'a, SimplicialComplex<K>>,
    /// How they are glued.
    pub gluing: Gluing<K>,
    /// Their numbers in the mesh, where some were left out.
    original: Option<Vec<u32>>,
    /// Cells that repeat a vertex.
    pub repeating: Vec<u32>,
    /// Cells with the vertices of an earlier cell.
    pub duplicates: Vec<u32>,
}

impl<'a, const K: usize> ProperCells<'a, K> {
    pub(super) fn new(complex: &'a SimplicialComplex<K>) -> Self {
        let repeats = |cell: &[VertexId; K]| (1..K).any(|i| cell[..i].contains(&cell[i]));
        let of_kind = |wanted: bool| {
            let cells = complex.cells().iter().enumerate();
            cells.filter(move |(_, cell)| repeats(cell) == wanted).map(|(index, _)| index as u32)
        };
        let repeating: Vec<u32> = of_kind(true).collect();
        let mut proper = Self {
            complex: Cow::Borrowed(complex),
            gluing: empty_gluing(),
            original: None,
            repeating,
            duplicates: Vec::new(),
        };
        if !proper.repeating.is_empty() {
            proper.keep(complex, of_kind(false).collect());
        }
        proper.gluing = Gluing::new(&proper.complex);
        if !proper.gluing.duplicates.is_empty() {
            let copies = std::mem::take(&mut proper.gluing.duplicates);
            let kept = (0..proper.complex.cell_count() as u32).filter(|c| copies.binary_search(c).is_err());
            let kept = kept.map(|cell| proper.original(cell)).collect();
            proper.duplicates = copies.iter().map(|&cell| proper.original(cell)).collect();
            proper.keep(complex, kept);
            proper.gluing = Gluing::new(&proper.complex);
        }
        proper
    }

    /// Restricts the complex to the cells `kept` of the mesh.
    fn keep(&mut self, mesh: &SimplicialComplex<K>, kept: Vec<u32>) {
        let cells = kept.iter().map(|&cell| mesh.cells()[cell as usize]).collect();
        let complex = SimplicialComplex::new(mesh.vertex_count(), cells);
        self.complex = Cow::Owned(complex.expect("indices were in range before; please report this"));
        self.original = Some(kept);
    }

    /// The number of a cell in the mesh as given.
    #[inline]
    pub(super) fn original(&self, cell: u32) -> u32 {
        self.original.as_ref().map_or(cell, |map| map[cell as usize])
    }

    /// Whether no cell of the mesh was left out.
    pub(super) fn is_complete(&self) -> bool {
        self.original.is_none()
    }
}

fn empty_gluing<const K: usize>() -> Gluing<K> {
    Gluing {
        across: Vec::new(),
        flags: Vec::new(),
        crowded: Vec::new(),
        facet_count: 0,
        boundary_count: 0,
        facets_at: Vec::new(),
        on_boundary: Vec::new(),
        duplicates: Vec::new(),
    }
}
