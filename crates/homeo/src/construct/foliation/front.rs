//! The advancing front: an order of the cells that is a bishelling.
//!
//! Cells are removed one by one, from the source region towards the sink. A cell may go when it is
//! *free*: around each of its vertices and edges the removed cells stay connected through facets and
//! so do the remaining ones, the source and sink regions counting as one virtual cell each. That is
//! local bipolarity of the resulting order (the document of the map file has the theorem that rests
//! on it). Among the free cells the one with the lowest rank goes first.
//!
//! A cell and its facets decide freedom alone, but for a few vertices and edges that must be
//! *untouched* (no cell around them removed) or *last* (no other cell around them left). Counters
//! answer both at once, so a test costs constant time; see [`Conditions`].
//!
//! Around a vertex or edge of a parallel facet the cells form a half-ball. There the removed and
//! the remaining ones must also meet the boundary in one piece each, which comes down to this: the
//! first cell removed has a parallel facet there itself. (A front that reaches the boundary from
//! inside would cut the remaining cells in two; the later conditions then never hold.)

use homeo_core::mesh::{Adjacency, CELL_EDGES, CellId, EdgeIndex, SimplicialComplex};

/// What surrounds the cells: which boundary facets are source or sink, and what is centre.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// For each cell, a bit for each boundary facet in the source region.
    pub source: Vec<u8>,
    /// For each cell, a bit for each boundary facet in the sink region.
    pub sink: Vec<u8>,
    /// The centre, if any, and the side of the flow that it is on.
    pub centre: Option<(CellId, Side)>,
}

/// One end of the flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Where leaves begin.
    Source,
    /// Where they end.
    Sink,
}

impl Surroundings {
    /// The same with source and sink exchanged.
    pub fn reversed(&self) -> Self {
        let flip = |side| if side == Side::Source { Side::Sink } else { Side::Source };
        Self {
            source: self.sink.clone(),
            sink: self.source.clone(),
            centre: self.centre.map(|(cell, side)| (cell, flip(side))),
        }
    }
}

/// For which vertices and edges of a cell freedom depends on more than its facets.
///
/// Let `f` be a vertex or edge. If no facet of the cell that contains `f` is an inflow facet, the
/// cell starts a new component around `f` unless `f` is untouched. If none is an outflow facet, the
/// cell leaves `f` for good, which only the last cell around `f` may do.
#[derive(Clone, Copy, Debug, Default)]
struct Conditions {
    vertex_untouched: u8,
    vertex_last: u8,
    edge_untouched: u8,
    edge_last: u8,
    /// Those of the untouched that the cell's own parallel facet does not contain.
    vertex_inner: u8,
    edge_inner: u8,
}

impl Conditions {
    fn new<const K: usize>(inflow: u8, parallel: u8) -> Self {
        let all = (1u8 << K) - 1;
        let outflow = all & !inflow & !parallel;
        let mut conditions = Self::default();
        for vertex in 0..K {
            let containing = all & !(1 << vertex);
            conditions.vertex_untouched |= u8::from(containing & inflow == 0) << vertex;
            conditions.vertex_last |= u8::from(containing & outflow == 0) << vertex;
            conditions.vertex_inner |= u8::from(containing & (inflow | parallel) == 0) << vertex;
        }
        if K == 4 {
            for (edge, &[a, b]) in CELL_EDGES.iter().enumerate() {
                let containing = all & !(1 << a) & !(1 << b);
                conditions.edge_untouched |= u8::from(containing & inflow == 0) << edge;
                conditions.edge_last |= u8::from(containing & outflow == 0) << edge;
                conditions.edge_inner |= u8::from(containing & (inflow | parallel) == 0) << edge;
            }
        }
        conditions
    }
}

/// Removed and remaining cells around each vertex, or each edge.
struct Stars {
    /// Cells that remain, the virtual sink included.
    remaining: Vec<u32>,
    touched: Vec<bool>,
    /// Whether it lies on a parallel facet, so that the cells around are a half-ball.
    halved: Vec<bool>,
    /// Exclusive or of the remaining cells: when one remains, its id.
    last: Vec<u32>,
}

impl Stars {
    fn new(count: usize) -> Self {
        Self {
            remaining: vec![0; count],
            touched: vec![false; count],
            halved: vec![false; count],
            last: vec![0; count],
        }
    }

    fn add(&mut self, index: usize, cell: CellId) {
        self.remaining[index] += 1;
        self.last[index] ^= cell.raw();
    }

    /// Whether the local vertices or edges that masks mark are untouched, not halved, and last.
    #[inline]
    fn allow(&self, at: impl Fn(usize) -> usize, [untouched, inner, last]: [u8; 3]) -> bool {
        bits(untouched).all(|local| !self.touched[at(local)])
            && bits(inner).all(|local| !self.halved[at(local)])
            && bits(last).all(|local| self.remaining[at(local)] == 1)
    }

    /// Removes a cell; gives the last one if one cell remains.
    fn remove(&mut self, index: usize, cell: CellId) -> Option<CellId> {
        self.touched[index] = true;
        self.remaining[index] -= 1;
        self.last[index] ^= cell.raw();
        (self.remaining[index] == 1).then(|| CellId::from(self.last[index]))
    }
}

/// The state of the front.
pub struct Front<'a, const K: usize> {
    complex: &'a SimplicialComplex<K>,
    adjacency: &'a Adjacency<K>,
    edges: &'a EdgeIndex<K>,
    conditions: Vec<Conditions>,
    inflow: Vec<u8>,
    parallel: Vec<u8>,
    removed: Vec<bool>,
    vertices: Stars,
    edge_stars: Stars,
    order: Vec<CellId>,
    to_remove: usize,
    centre: Option<CellId>,
}

/// No cell is free any more although some remain.
#[derive(Clone, Debug)]
pub struct Stuck {
    /// Cells that were removed, in order.
    pub removed: Vec<CellId>,
    /// Cells that remain.
    pub remaining: Vec<CellId>,
}

impl<'a, const K: usize> Front<'a, K> {
    /// A front at the source region.
    pub fn new(
        complex: &'a SimplicialComplex<K>,
        adjacency: &'a Adjacency<K>,
        edges: &'a EdgeIndex<K>,
        surroundings: &Surroundings,
    ) -> Self {
        let count = complex.cell_count();
        let mut front = Self {
            complex,
            adjacency,
            edges,
            conditions: (0..256).map(|masks| Conditions::new::<K>(masks as u8 & 15, masks as u8 >> 4)).collect(),
            inflow: surroundings.source.clone(),
            parallel: vec![0; count],
            removed: vec![false; count],
            vertices: Stars::new(complex.vertex_count()),
            edge_stars: Stars::new(if K == 4 { edges.len() } else { 0 }),
            order: Vec::with_capacity(count),
            to_remove: count - usize::from(surroundings.centre.is_some()),
            centre: surroundings.centre.map(|(cell, _)| cell),
        };
        for cell in complex.cell_ids() {
            front.for_each_star(cell, |stars, index| stars.add(index, cell));
        }
        front.surround(surroundings);
        front
    }

    fn surround(&mut self, surroundings: &Surroundings) {
        let mut in_sink = [vec![false; self.vertices.touched.len()], vec![false; self.edge_stars.touched.len()]];
        for facet in self.adjacency.boundary_facets() {
            let (cell, bit) = (facet.cell().index(), 1u8 << facet.opposite());
            let is_source = surroundings.source[cell] & bit != 0;
            let is_sink = surroundings.sink[cell] & bit != 0;
            debug_assert!(!(is_source && is_sink), "a facet is source or sink, not both");
            let is_parallel = !is_source && !is_sink;
            self.parallel[cell] |= if is_parallel { bit } else { 0 };
            let mark = |stars: &mut Stars, in_sink: &mut [bool], index: usize| {
                stars.touched[index] |= is_source;
                stars.halved[index] |= is_parallel;
                in_sink[index] |= is_sink;
            };
            for vertex in self.complex.facet_vertices(facet.cell(), facet.opposite()) {
                mark(&mut self.vertices, &mut in_sink[0], vertex.index());
            }
            if K == 4 {
                for local in crate::refine::facet_edges::<K>(facet) {
                    mark(&mut self.edge_stars, &mut in_sink[1], self.edges.of_cell(facet.cell())[local].index());
                }
            }
        }
        for (stars, flags) in [&mut self.vertices, &mut self.edge_stars].into_iter().zip(&in_sink) {
            for (index, _) in flags.iter().enumerate().filter(|&(_, &flag)| flag) {
                // The virtual sink never goes: the last cell around is never the last.
                stars.remaining[index] += 1;
                stars.last[index] ^= u32::MAX;
            }
        }
        if let Some((cell, Side::Source)) = surroundings.centre {
            self.take_away(cell, |_| {});
        }
    }

    fn for_each_star(&mut self, cell: CellId, mut visit: impl FnMut(&mut Stars, usize)) {
        for vertex in self.complex.cell(cell) {
            visit(&mut self.vertices, vertex.index());
        }
        if K == 4 {
            for edge in self.edges.of_cell(cell) {
                visit(&mut self.edge_stars, edge.index());
            }
        }
    }

    /// Whether removing `cell` keeps both sides connected around each of its vertices and edges.
    fn is_free(&self, cell: CellId) -> bool {
        let index = cell.index();
        let (inflow, parallel) = (self.inflow[index], self.parallel[index]);
        let outflow = ((1u8 << K) - 1) & !inflow & !parallel;
        if inflow == 0 || outflow == 0 {
            return false;
        }
        let conditions = self.conditions[usize::from(parallel << 4 | inflow)];
        let c = conditions;
        let corners = self.complex.cell(cell);
        self.vertices.allow(|i| corners[i].index(), [c.vertex_untouched, c.vertex_inner, c.vertex_last])
            && (K < 4 || {
                let edges = self.edges.of_cell(cell);
                self.edge_stars.allow(|i| edges[i].index(), [c.edge_untouched, c.edge_inner, c.edge_last])
            })
    }

    /// Removes `cell` and names the cells that may have become free.
    fn take_away(&mut self, cell: CellId, mut candidate: impl FnMut(CellId)) {
        self.removed[cell.index()] = true;
        for i in 0..K {
            let far = self.adjacency.across(cell, i);
            if far.is_some() && !self.removed[far.cell().index()] {
                self.inflow[far.cell().index()] |= 1 << far.opposite();
                candidate(far.cell());
            }
        }
        self.for_each_star(cell, |stars, index| {
            if let Some(last) = stars.remove(index, cell).filter(|last| last.raw() != u32::MAX) {
                candidate(last);
            }
        });
    }

    /// Removes free cells by ascending rank until none is left or none is free.
    ///
    /// `rank` is a permutation of the cells. Linear time.
    ///
    /// # Errors
    /// [`Stuck`] with the cells that remain.
    pub fn advance(mut self, rank: &[u32]) -> Result<Vec<CellId>, Stuck> {
        let mut cell_of_rank = vec![CellId::new(0); rank.len()];
        for (cell, &rank) in rank.iter().enumerate() {
            cell_of_rank[rank as usize] = CellId::new(cell);
        }
        let mut queue = RankQueue::new(rank.len());
        for cell in self.complex.cell_ids().filter(|cell| self.inflow[cell.index()] != 0) {
            queue.insert(rank[cell.index()]);
        }
        while let Some(lowest) = queue.take_lowest() {
            let cell = cell_of_rank[lowest as usize];
            if self.removed[cell.index()] || self.centre == Some(cell) || !self.is_free(cell) {
                continue;
            }
            self.order.push(cell);
            self.take_away(cell, |next| queue.insert(rank[next.index()]));
        }
        if self.order.len() == self.to_remove {
            return Ok(self.order);
        }
        let centre = self.centre;
        let remaining = self.complex.cell_ids().filter(|&c| !self.removed[c.index()] && centre != Some(c)).collect();
        Err(Stuck { removed: self.order, remaining })
    }
}

/// The set bits of a mask, as numbers.
fn bits(mask: u8) -> impl Iterator<Item = usize> {
    (0..8).filter(move |&bit| mask >> bit & 1 == 1)
}

/// A set of small numbers with the lowest at hand: a tree of 64-bit words.
struct RankQueue {
    levels: Vec<Vec<u64>>,
}

impl RankQueue {
    fn new(size: usize) -> Self {
        let mut levels = Vec::new();
        let mut words = size;
        loop {
            words = words.div_ceil(64).max(1);
            levels.push(vec![0; words]);
            if words == 1 {
                return Self { levels };
            }
        }
    }

    fn insert(&mut self, rank: u32) {
        let mut index = rank as usize;
        for level in &mut self.levels {
            let word = &mut level[index / 64];
            let was_empty = *word == 0;
            *word |= 1 << (index % 64);
            if !was_empty {
                return;
            }
            index /= 64;
        }
    }

    fn take_lowest(&mut self) -> Option<u32> {
        let mut index = 0;
        for level in self.levels.iter().rev() {
            let word = level[index];
            if word == 0 {
                return None;
            }
            index = index * 64 + word.trailing_zeros() as usize;
        }
        let lowest = index as u32;
        for level in &mut self.levels {
            let word = &mut level[index / 64];
            *word &= !(1 << (index % 64));
            if *word != 0 {
                break;
            }
            index /= 64;
        }
        Some(lowest)
    }
}

/// Position of each cell in an order; cells that are not in it get the largest number.
pub fn positions_in(order: &[CellId], cell_count: usize) -> Vec<u32> {
    let mut positions = vec![u32::MAX; cell_count];
    for (position, cell) in order.iter().enumerate() {
        positions[cell.index()] = position as u32;
    }
    positions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn queue_gives_ranks_in_order() {
        let mut queue = RankQueue::new(10_000);
        for rank in [9_999, 3, 64, 63, 4_096, 3] {
            queue.insert(rank);
        }
        let mut taken = Vec::new();
        while let Some(rank) = queue.take_lowest() {
            taken.push(rank);
            if rank == 63 {
                queue.insert(1);
            }
        }
        assert_eq!(taken, [3, 63, 1, 64, 4_096, 9_999]);
    }
}
