//! Collapsing a tetrahedral complex to a graph: a certificate for balls and handle bodies.
//!
//! An elementary collapse takes a cell off together with a face that no other cell has; it does not
//! change the homotopy type. A manifold that collapses to a subcomplex is a regular neighbourhood
//! of it (J. H. C. Whitehead, Simplicial spaces, nuclei and m-groups, 1939; Rourke and Sanderson,
//! Introduction to piecewise-linear topology, 1972, chapter 3): a ball for a point, hence for a tree,
//! and a handle body for a connected graph, where the manifold is orientable.
//!
//! The search is greedy and may miss a collapse that exists. Tetrahedra go first, if possible so
//! that what is left stays a manifold of the same shape (a shelling step). Triangles go next; for
//! them every greedy order is as good as any other.

use std::collections::VecDeque;

use super::gluing::Gluing;
use crate::mesh::{EdgeIndex, TetrahedronComplex};

/// The search tries again in other orders until it has taken this many tetrahedra off.
const MOST_STEPS: usize = 4_000_000;

/// The local edges of the facet opposite each vertex, by [`crate::mesh::CELL_EDGES`].
const FACET_EDGES: [[usize; 3]; 4] = [[2, 4, 5], [1, 3, 5], [0, 3, 4], [0, 1, 2]];

/// The local edge between two local vertices.
const EDGE_BETWEEN: [[usize; 4]; 4] = [[6, 0, 1, 3], [0, 6, 2, 4], [1, 2, 6, 5], [3, 4, 5, 6]];

/// Which candidate goes next.
#[derive(Clone, Copy)]
enum Order {
    /// The one that waits longest: layer by layer.
    Oldest,
    /// The newest: along a path.
    Newest,
    /// Any, by a generator with this state.
    Random(u64),
}

/// Whether a greedy search collapses the complex to a graph. `false` does not mean that there is no
/// collapse.
///
/// # Preconditions
/// No facet is crowded, and there is a boundary facet in each sheet.
///
/// # Complexity
/// Linear for each of at most 64 tries, and at most a few million steps in all.
pub(super) fn collapses_to_graph(complex: &TetrahedronComplex, gluing: &Gluing<4>) -> bool {
    let lattice = Lattice::new(complex, gluing);
    let tries = (MOST_STEPS / complex.cell_count().max(1)).clamp(2, 64);
    (0..tries).any(|attempt| {
        let order = match attempt {
            0 => Order::Oldest,
            1 => Order::Newest,
            seed => Order::Random(seed as u64),
        };
        let entered = Peeling::new(complex, gluing, &lattice, order).run();
        lattice.rest_collapses(&entered)
    })
}

/// The facets and edges of the complex, numbered.
struct Lattice {
    edges: EdgeIndex<4>,
    /// The facets of each cell.
    cell_facets: Vec<[u32; 4]>,
    /// The edges of each facet.
    facet_edges: Vec<[u32; 3]>,
}

impl Lattice {
    fn new(complex: &TetrahedronComplex, gluing: &Gluing<4>) -> Self {
        let edges = complex.edges();
        let mut cell_facets = vec![[u32::MAX; 4]; complex.cell_count()];
        let mut facet_edges = Vec::with_capacity(gluing.facet_count);
        for cell in complex.cell_ids() {
            for opposite in 0..4 {
                if cell_facets[cell.index()][opposite] != u32::MAX {
                    continue;
                }
                let number = facet_edges.len() as u32;
                facet_edges.push(FACET_EDGES[opposite].map(|local| edges.of_cell(cell)[local].raw()));
                cell_facets[cell.index()][opposite] = number;
                let across = gluing.across[cell.index()][opposite];
                if across.is_some() {
                    cell_facets[across.cell().index()][across.opposite()] = number;
                }
            }
        }
        Self { edges, cell_facets, facet_edges }
    }

    /// Whether the triangles that were not entered collapse to edges, given that all tetrahedra went.
    fn rest_collapses(&self, entered: &[bool]) -> bool {
        // For each edge, how many triangles are left there and the exclusive-or of their numbers.
        let mut at_edge = vec![(0u32, 0u32); self.edges.len()];
        let mut left = 0usize;
        for (facet, edges) in self.facet_edges.iter().enumerate().filter(|&(facet, _)| !entered[facet]) {
            left += 1;
            for &edge in edges {
                let (count, mix) = &mut at_edge[edge as usize];
                *count += 1;
                *mix ^= facet as u32;
            }
        }
        let mut free: Vec<u32> = (0..at_edge.len() as u32).filter(|&e| at_edge[e as usize].0 == 1).collect();
        while let Some(edge) = free.pop() {
            let (count, facet) = at_edge[edge as usize];
            if count != 1 {
                continue;
            }
            left -= 1;
            for &edge in &self.facet_edges[facet as usize] {
                let (count, mix) = &mut at_edge[edge as usize];
                *count -= 1;
                *mix ^= facet;
                if *count == 1 {
                    free.push(edge);
                }
            }
        }
        left == 0
    }
}

/// Tetrahedra taken off one by one, each through a facet that no other one has any more.
struct Peeling<'a> {
    complex: &'a TetrahedronComplex,
    gluing: &'a Gluing<4>,
    lattice: &'a Lattice,
    order: Order,
    gone: Vec<bool>,
    /// Number of facets at each vertex with one tetrahedron left.
    skin_at_vertex: Vec<u32>,
    /// The same at each edge.
    skin_at_edge: Vec<u32>,
    /// Facets through which a tetrahedron went.
    entered: Vec<bool>,
    /// Tetrahedra with a free facet that may be a shelling step.
    ready: VecDeque<u32>,
    /// Tetrahedra with a free facet that were none when last looked at.
    waiting: VecDeque<u32>,
}

impl<'a> Peeling<'a> {
    fn new(complex: &'a TetrahedronComplex, gluing: &'a Gluing<4>, lattice: &'a Lattice, order: Order) -> Self {
        let mut peeling = Self {
            complex,
            gluing,
            lattice,
            order,
            gone: vec![false; complex.cell_count()],
            skin_at_vertex: vec![0; complex.vertex_count()],
            skin_at_edge: vec![0; lattice.edges.len()],
            entered: vec![false; lattice.facet_edges.len()],
            ready: VecDeque::new(),
            waiting: VecDeque::new(),
        };
        for facet in gluing.boundary_facets() {
            peeling.grow_skin(facet.cell().index(), facet.opposite(), 1);
            peeling.ready.push_back(facet.cell().raw());
        }
        peeling
    }

    /// Takes all tetrahedra off; returns the facets through which they went.
    fn run(mut self) -> Vec<bool> {
        loop {
            if let Some(cell) = take(&mut self.ready, &mut self.order) {
                let cell = cell as usize;
                if self.gone[cell] {
                    continue;
                }
                if self.is_shelling_step(cell) {
                    self.remove(cell);
                } else {
                    self.waiting.push_back(cell as u32);
                }
            } else if let Some(cell) = take(&mut self.waiting, &mut self.order) {
                if !self.gone[cell as usize] {
                    self.remove(cell as usize);
                }
            } else {
                return self.entered;
            }
        }
    }

    fn is_free(&self, cell: usize, opposite: usize) -> bool {
        let across = self.gluing.across[cell][opposite];
        across.is_none() || self.gone[across.cell().index()]
    }

    /// Whether the tetrahedron meets the others in a disk that is new to the skin.
    fn is_shelling_step(&self, cell: usize) -> bool {
        let free = [0, 1, 2, 3].map(|i| self.is_free(cell, i));
        let numbers = |wanted: bool| (0..4).filter(move |&i| free[i] == wanted);
        match numbers(true).count() {
            1 => numbers(true).all(|i| self.skin_at_vertex[self.complex.cells()[cell][i].index()] == 0),
            2 => {
                let mut ends = numbers(true);
                let (Some(i), Some(j)) = (ends.next(), ends.next()) else { return false };
                let edge = self.lattice.edges.cell_edges()[cell * 6 + EDGE_BETWEEN[i][j]];
                self.skin_at_edge[edge.index()] == 0
            }
            count => count >= 3,
        }
    }

    fn remove(&mut self, cell: usize) {
        let free = [0, 1, 2, 3].map(|i| self.is_free(cell, i));
        self.gone[cell] = true;
        let mut has_entered = false;
        for (i, &is_free) in free.iter().enumerate() {
            if is_free {
                self.grow_skin(cell, i, -1);
                if !has_entered {
                    has_entered = true;
                    self.entered[self.lattice.cell_facets[cell][i] as usize] = true;
                }
            } else {
                self.grow_skin(cell, i, 1);
                self.ready.push_back(self.gluing.across[cell][i].cell().raw());
            }
        }
    }

    fn grow_skin(&mut self, cell: usize, opposite: usize, by: i32) {
        for i in (0..4).filter(|&i| i != opposite) {
            let count = &mut self.skin_at_vertex[self.complex.cells()[cell][i].index()];
            *count = count.wrapping_add_signed(by);
        }
        for &edge in &self.lattice.facet_edges[self.lattice.cell_facets[cell][opposite] as usize] {
            let count = &mut self.skin_at_edge[edge as usize];
            *count = count.wrapping_add_signed(by);
        }
    }
}

/// Takes the next candidate out of the queue.
fn take(queue: &mut VecDeque<u32>, order: &mut Order) -> Option<u32> {
    match order {
        Order::Oldest => queue.pop_front(),
        Order::Newest => queue.pop_back(),
        Order::Random(state) => {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let place = (*state >> 33) as usize % queue.len().max(1);
            queue.swap_remove_back(place)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::CELL_EDGES;

    #[test]
    fn tables_agree_with_the_numbering_of_edges() {
        for (opposite, edges) in FACET_EDGES.iter().enumerate() {
            assert!(edges.iter().all(|&edge| !CELL_EDGES[edge].contains(&opposite)));
        }
        for (edge, &[i, j]) in CELL_EDGES.iter().enumerate() {
            assert_eq!((EDGE_BETWEEN[i][j], EDGE_BETWEEN[j][i]), (edge, edge));
        }
    }
}
