//! The table that leaves walk through.

use homeo_core::mesh::{Adjacency, CellId, Facet, VertexId};
use homeo_core::spatial::cells_along_curve;

use super::FoliationParts;

/// What a leaf needs to know of a cell, in half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Step {
    /// The slot across each facet; [`Facet::NONE`] where the leaf ends (boundary or centre).
    pub across: [Facet; 4],
    /// The direction.
    pub direction: [i8; 4],
    /// For each facet, the number in the next cell of each vertex, two bits each.
    pub renumber: [u8; 4],
    /// The other way round: for each facet, the number in this cell of each vertex of the next, two bits each;
    /// the vertex opposite the facet stands for the one opposite it here.
    pub gather: [u8; 4],
    /// Length per unit of direction.
    pub length: u32,
}

impl Step {
    /// Number in the cell across facet `i` of local vertex `k`.
    #[inline]
    pub fn renumbered(&self, i: usize, k: usize) -> usize {
        usize::from(self.renumber[i] >> (2 * k) & 3)
    }

    /// Values of the vertices of this cell, as values of the vertices of the cell across facet `i`.
    #[inline(always)]
    pub fn carried<T: Copy, const K: usize>(&self, i: usize, values: &[T; K]) -> [T; K] {
        let gather = self.gather[i];
        std::array::from_fn(|k| values[usize::from(gather >> (2 * k) & 3)])
    }
}

/// The steps of all cells in slots along a curve through space, so that a leaf stays in one part of memory
/// whatever order the cells of the file have.
#[derive(Debug)]
pub(super) struct Steps {
    table: Vec<Step>,
    slots: Vec<CellId>,
    cells: Vec<CellId>,
}

impl Steps {
    pub fn new<const K: usize>(parts: &FoliationParts<K>, adjacency: &Adjacency<K>) -> Self {
        let cells = cells_along_curve(parts.mesh.complex(), parts.mesh.positions());
        let mut slots = vec![CellId::new(0); cells.len()];
        cells.iter().enumerate().for_each(|(slot, cell)| slots[cell.index()] = CellId::new(slot));
        let table = cells.iter().map(|&cell| step(parts, adjacency, &slots, cell)).collect();
        Self { table, slots, cells }
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.table.len()
    }

    /// The slot of a cell.
    #[inline]
    pub fn slot(&self, cell: CellId) -> CellId {
        self.slots[cell.index()]
    }

    /// The cell in a slot.
    #[inline]
    pub fn cell(&self, slot: CellId) -> CellId {
        self.cells[slot.index()]
    }

    /// A facet of a slot as a facet of its cell.
    pub fn facet(&self, facet: Facet) -> Facet {
        Facet::new(self.cell(facet.cell()), facet.opposite())
    }

    /// What is in a slot.
    #[inline(always)]
    pub fn at(&self, slot: CellId) -> &Step {
        &self.table[slot.index()]
    }

    /// The step of a cell.
    #[inline]
    pub fn of(&self, cell: CellId) -> &Step {
        self.at(self.slot(cell))
    }
}

fn step<const K: usize>(parts: &FoliationParts<K>, adjacency: &Adjacency<K>, slots: &[CellId], cell: CellId) -> Step {
    let centre = parts.centre.map(|centre| centre.cell);
    let length = parts.lengths[cell.index()];
    let mut step = Step { across: [Facet::NONE; 4], direction: [0; 4], renumber: [0; 4], gather: [0; 4], length };
    let here = parts.mesh.complex().cell(cell);
    for i in 0..K {
        step.direction[i] = parts.directions[cell.index()][i];
        let far = adjacency.across(cell, i);
        if far.is_none() {
            continue;
        }
        let there = parts.mesh.complex().cell(far.cell());
        step.renumber[i] = renumbering(here, i, there);
        let opposite = (i << (2 * far.opposite())) as u8;
        step.gather[i] =
            (0..K).filter(|&k| k != i).fold(opposite, |bits, k| bits | (k as u8) << (2 * step.renumbered(i, k)));
        if centre != Some(far.cell()) {
            step.across[i] = Facet::new(slots[far.cell().index()], far.opposite());
        }
    }
    step
}

/// Where the vertices of facet `i` are in the cell across, two bits each.
fn renumbering<const K: usize>(here: [VertexId; K], i: usize, there: [VertexId; K]) -> u8 {
    (0..K).filter(|&k| k != i).fold(0, |bits, k| {
        let number = (0..K).find(|&l| there[l] == here[k]).unwrap_or(0);
        bits | (number as u8) << (2 * k)
    })
}
