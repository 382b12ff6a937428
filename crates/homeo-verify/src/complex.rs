//! Cells with their neighbours; no coordinates.
//!
//! A *slot* is one facet of one cell: slot `size * c + i` is the facet of cell `c` opposite its vertex `i`.
//! Construction checks that indices are in range, that a cell's vertices differ, that no facet has more than
//! two cells, and that no two cells have the same vertices: what makes a list of cells a pseudo-manifold.

use crate::verdict::{Checked, refuted, undecided};

/// "No cell on the other side."
pub(crate) const NONE: u32 = u32::MAX;

/// The vertices of a cell as sets of local indices, bit by bit.
pub(crate) const VERTICES: [u8; 4] = [0b0001, 0b0010, 0b0100, 0b1000];

/// The edges of a tetrahedron in the same way.
pub(crate) const EDGES: [u8; 6] = [0b0011, 0b0101, 0b1001, 0b0110, 0b1010, 0b1100];

/// A complex of cells with `size` vertices each: 4 tetrahedra, 3 triangles, 2 edges, 1 points.
pub(crate) struct Complex {
    pub(crate) size: usize,
    pub(crate) vertex_count: usize,
    vertices: Vec<u32>,
    across: Vec<u32>,
}

/// The names of the rules that a complex serves, for its witnesses.
#[derive(Clone, Copy)]
pub(crate) struct Rules {
    /// Indices in range, vertices of a cell different.
    pub(crate) cells: &'static str,
    /// At most two cells at a facet.
    pub(crate) facets: &'static str,
}

impl Complex {
    /// Finds the neighbours of all cells; `vertices` lists the cells one after the other.
    pub(crate) fn new(size: usize, vertices: Vec<u32>, vertex_count: usize, rules: Rules) -> Checked<Self> {
        if vertices.len() / size > 1 << 29 || vertex_count >= NONE as usize {
            return undecided("there are more than 2^29 cells or 2^32 - 2 vertices", "split the mesh");
        }
        let across = vec![NONE; vertices.len()];
        let mut complex = Complex { size, vertex_count, vertices, across };
        for c in 0..complex.count() {
            let cell = complex.cell(c);
            if cell.iter().any(|&v| v as usize >= vertex_count) {
                return refuted(rules.cells, format!("cell {c} has a vertex that does not exist"), &[c], &[]);
            }
            if (1..size).any(|i| cell[..i].contains(&cell[i])) {
                return refuted(rules.cells, format!("cell {c} has a vertex twice"), &[c], cell);
            }
        }
        complex.find_neighbours(rules)?;
        Ok(complex)
    }

    fn find_neighbours(&mut self, rules: Rules) -> Checked {
        let mut facets: Vec<u128> = (0..self.across.len()).map(|slot| pack(self.facet(slot), slot)).collect();
        facets.sort_unstable();
        for group in facets.chunk_by(is_same_face) {
            match *group {
                [_] => {}
                [a, b] => {
                    let (a, b) = (place(a), place(b));
                    self.across[a] = b as u32;
                    self.across[b] = a as u32;
                }
                _ => {
                    let cells: Vec<usize> = group.iter().map(|&key| place(key) / self.size).collect();
                    let (facet, length) = self.facet(place(group[0]));
                    return refuted(rules.facets, "more than two cells share a facet", &cells, &facet[..length]);
                }
            }
        }
        // Two cells with the same vertices are neighbours across all facets; two facets already tell.
        for c in 0..if self.size > 2 { self.count() } else { 0 } {
            if let (Some(a), Some(b)) = (self.beyond(c, 0), self.beyond(c, 1))
                && a == b
            {
                return refuted(
                    rules.cells,
                    format!("cells {c} and {a} have the same vertices"),
                    &[c, a],
                    self.cell(c),
                );
            }
        }
        Ok(())
    }

    /// The number of cells.
    pub(crate) fn count(&self) -> usize {
        self.vertices.len() / self.size
    }

    /// The vertices of a cell.
    pub(crate) fn cell(&self, c: usize) -> &[u32] {
        &self.vertices[c * self.size..(c + 1) * self.size]
    }

    /// The same facet as a slot of the neighbour.
    pub(crate) fn across(&self, slot: usize) -> Option<usize> {
        Some(self.across[slot] as usize).filter(|&other| other != NONE as usize)
    }

    /// The cell beyond facet `i` of cell `c`.
    pub(crate) fn beyond(&self, c: usize, i: usize) -> Option<usize> {
        self.across(c * self.size + i).map(|other| other / self.size)
    }

    /// The slots of all facets with two cells, each once, with the same facet as a slot of the other cell.
    pub(crate) fn inner_facets(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..self.across.len()).filter_map(|slot| self.across(slot).filter(|&other| slot < other).map(|o| (slot, o)))
    }

    /// The slots of all facets with one cell.
    pub(crate) fn boundary_slots(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.across.len()).filter(|&slot| self.across(slot).is_none())
    }

    /// The sorted vertices of a facet, and their number.
    pub(crate) fn facet(&self, slot: usize) -> ([u32; 3], usize) {
        self.face(slot / self.size, ((1 << self.size) - 1) ^ (1 << (slot % self.size)))
    }

    /// Whether the orientation that the cell's order induces on a facet is that of the facet's sorted vertices.
    pub(crate) fn induces_sorted_order(&self, slot: usize) -> bool {
        let (cell, opposite) = (self.cell(slot / self.size), slot % self.size);
        let mut odd = opposite % 2 == 1;
        for i in (0..self.size).filter(|&i| i != opposite) {
            for j in (i + 1..self.size).filter(|&j| j != opposite) {
                odd ^= cell[i] > cell[j];
            }
        }
        !odd
    }

    /// The complex of some facets.
    pub(crate) fn facet_complex(&self, slots: impl Iterator<Item = usize>, rule: &'static str) -> Checked<Complex> {
        let mut vertices = Vec::new();
        for slot in slots {
            let (facet, length) = self.facet(slot);
            vertices.extend_from_slice(&facet[..length]);
        }
        Complex::new(self.size - 1, vertices, self.vertex_count, Rules { cells: rule, facets: rule })
    }

    /// The kinds of faces of codimension two or more at which links and rule 5 are checked: vertices, edges of tetrahedra.
    pub(crate) fn small_faces(&self) -> [&'static [u8]; 2] {
        [&VERTICES[..self.size], if self.size == 4 { &EDGES } else { &[] }]
    }

    /// All faces of one kind of all cells, sorted, so that equal ones form a group; the place is `kind.len() * c + k`.
    pub(crate) fn sorted_faces(&self, kind: &[u8]) -> Vec<u128> {
        let mut faces = Vec::with_capacity(kind.len() * self.count());
        for c in 0..self.count() {
            faces.extend(kind.iter().enumerate().map(|(k, &mask)| pack(self.face(c, mask), kind.len() * c + k)));
        }
        faces.sort_unstable();
        faces
    }

    /// The sorted vertices of a face of at most three vertices, and their number.
    pub(crate) fn face(&self, c: usize, mask: u8) -> ([u32; 3], usize) {
        let (mut face, mut length) = ([0; 3], 0);
        for (_, &v) in self.cell(c).iter().enumerate().filter(|(i, _)| mask >> i & 1 == 1) {
            face[length] = v;
            length += 1;
        }
        face[..length].sort_unstable();
        (face, length)
    }
}

/// Vertices and place in one number, ordered by the vertices first.
fn pack((vertices, length): ([u32; 3], usize), place: usize) -> u128 {
    vertices[..length].iter().fold(0, |key, &v| key << 32 | u128::from(v)) << 32 | place as u128
}

/// The place, for facets the slot, of a sorted face.
pub(crate) fn place(key: u128) -> usize {
    (key & u128::from(u32::MAX)) as usize
}

/// Whether two sorted faces have the same vertices.
pub(crate) fn is_same_face(a: &u128, b: &u128) -> bool {
    a >> 32 == b >> 32
}

/// Sets that grow together; the smallest member stands for its set.
pub(crate) struct UnionFind(Vec<u32>);

impl UnionFind {
    /// `count` sets of one member.
    pub(crate) fn new(count: usize) -> Self {
        UnionFind((0..count).map(|member| member as u32).collect())
    }

    /// The member that stands for the set.
    pub(crate) fn find(&mut self, mut member: usize) -> usize {
        while self.0[member] as usize != member {
            self.0[member] = self.0[self.0[member] as usize];
            member = self.0[member] as usize;
        }
        member
    }

    /// Makes one set of two.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b)] = a.min(b) as u32;
    }
}
