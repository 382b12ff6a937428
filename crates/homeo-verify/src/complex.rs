//! Cells with their neighbours; no coordinates.
//!
//! A *slot* is one facet of one cell: slot `size * c + i` is the facet of cell `c` opposite its vertex `i`.
//! Construction checks that indices are in range, that a cell's vertices differ, that no facet has more than
//! two cells, and that no two cells have the same vertices: what makes a list of cells a pseudo-manifold.

use crate::verdict::{Checked, check, decidable, refuted};
use std::ops::{Deref, Range};

/// "No cell on the other side."
const NONE: u32 = u32::MAX;

/// The vertices of a cell, and the edges of a tetrahedron, as sets of local indices, bit by bit.
const VERTICES: [u8; 4] = [0b0001, 0b0010, 0b0100, 0b1000];
pub(crate) const EDGES: [u8; 6] = [0b0011, 0b0101, 0b1001, 0b0110, 0b1010, 0b1100];

/// A complex of cells with `size` vertices each: 4 tetrahedra, 3 triangles, 2 edges, 1 points.
pub(crate) struct Complex {
    pub(crate) size: usize,
    pub(crate) vertex_count: usize,
    vertices: Vec<u32>,
    across: Vec<u32>,
}

impl Complex {
    /// Finds the neighbours of all cells; `vertices` lists the cells one after the other. The two rules, for witnesses:
    /// indices are in range, vertices of a cell and of two cells differ; a facet has at most two cells.
    pub(crate) fn new(size: usize, vertices: Vec<u32>, vertex_count: usize, rules: [&'static str; 2]) -> Checked<Self> {
        let is_small = vertices.len() / size <= 1 << 29 && vertex_count < NONE as usize;
        decidable(is_small, "there are more than 2^29 cells or 2^32 - 2 vertices", "split the mesh")?;
        let across = vec![NONE; vertices.len()];
        let mut complex = Complex { size, vertex_count, vertices, across };
        for (c, cell) in complex.cells().enumerate() {
            let exists = cell.iter().all(|&v| (v as usize) < vertex_count);
            check(exists, rules[0], "a cell has a vertex that does not exist", &[c], &[])?;
            let differ = (1..size).all(|i| !cell[..i].contains(&cell[i]));
            check(differ, rules[0], "a cell has a vertex twice", &[c], cell)?;
        }
        let mut facets: Vec<u128> = (0..complex.across.len()).map(|slot| pack(complex.facet(slot), slot)).collect();
        facets.sort_unstable();
        for group in facets.chunk_by(is_same_face) {
            if let [a, b] = *group {
                complex.across[place(a)] = place(b) as u32;
                complex.across[place(b)] = place(a) as u32;
            } else if group.len() > 2 {
                let cells: Vec<usize> = group.iter().map(|&key| place(key) / size).collect();
                let facet = complex.facet(place(group[0]));
                return Err(refuted(rules[1], "more than two cells share a facet", &cells, &facet));
            }
        }
        // Two cells with the same vertices are neighbours across all facets; two facets already tell.
        for (c, cell) in complex.cells().enumerate().take_while(|_| size > 2) {
            let [a, b] = [0, 1].map(|i| complex.across(size * c + i).map(|other| other / size));
            let differ = a.is_none() || a != b;
            check(differ, rules[0], "two cells have the same vertices", &[c, a.unwrap_or(c)], cell)?;
        }
        Ok(complex)
    }

    /// The number of cells.
    pub(crate) fn count(&self) -> usize {
        self.vertices.len() / self.size
    }

    /// The vertices of a cell.
    pub(crate) fn cell(&self, c: usize) -> &[u32] {
        &self.vertices[self.slots(c)]
    }

    /// The vertices of all cells.
    pub(crate) fn cells(&self) -> impl Iterator<Item = &[u32]> {
        self.vertices.chunks_exact(self.size)
    }

    /// The same facet as a slot of the neighbour.
    pub(crate) fn across(&self, slot: usize) -> Option<usize> {
        Some(self.across[slot] as usize).filter(|&other| other != NONE as usize)
    }

    /// The slots of a cell.
    pub(crate) fn slots(&self, c: usize) -> Range<usize> {
        c * self.size..(c + 1) * self.size
    }

    /// The facets with two cells, each once, as a slot of either cell.
    pub(crate) fn inner_facets(&self) -> impl Iterator<Item = (usize, usize)> {
        let pairs = (0..self.across.len()).filter_map(|slot| self.across(slot).map(|other| (slot, other)));
        pairs.filter(|(slot, other)| slot < other)
    }

    /// The slots of all facets with one cell.
    pub(crate) fn boundary_slots(&self) -> impl Iterator<Item = usize> {
        (0..self.across.len()).filter(|&slot| self.across(slot).is_none())
    }

    /// A facet.
    pub(crate) fn facet(&self, slot: usize) -> Face {
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

    /// Cells that share a facet, as far as `applies` to the two, lie on opposite sides of it: the orientations that they
    /// induce differ. Cells that are not `is_positive` count as turned over.
    pub(crate) fn check_sides(
        &self,
        rule: &'static str,
        applies: impl Fn(usize, usize) -> bool,
        is_positive: impl Fn(usize) -> bool,
    ) -> Checked {
        for (a, b) in self.inner_facets() {
            let (c, d) = (a / self.size, b / self.size);
            let is_sorted = |slot: usize| self.induces_sorted_order(slot) == is_positive(slot / self.size);
            if applies(c, d) && is_sorted(a) == is_sorted(b) {
                let message = "two cells, or their images, lie on the same side of their common facet";
                return Err(refuted(rule, message, &[c, d], &self.facet(a)));
            }
        }
        Ok(())
    }

    /// The complex of some facets.
    pub(crate) fn facet_complex(&self, slots: impl Iterator<Item = usize>) -> Checked<Complex> {
        let vertices = slots.flat_map(|slot| self.facet(slot).to_vec()).collect();
        Complex::new(self.size - 1, vertices, self.vertex_count, ["8"; 2])
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

    /// The face of cell `c` with these vertices.
    pub(crate) fn face(&self, c: usize, mask: u8) -> Face {
        let mut face = Face { vertices: [0; 3], length: 0 };
        for (_, &v) in self.cell(c).iter().enumerate().filter(|(i, _)| mask >> i & 1 == 1) {
            face.vertices[face.length] = v;
            face.length += 1;
        }
        face.vertices[..face.length].sort_unstable();
        face
    }

    /// Which vertices lie in these cells or faces.
    pub(crate) fn vertices_of(&self, faces: impl Iterator<Item = impl Deref<Target = [u32]>>) -> Vec<bool> {
        let mut lies_in_one = vec![false; self.vertex_count];
        faces.for_each(|face| face.iter().for_each(|&v| lies_in_one[v as usize] = true));
        lies_in_one
    }
}

/// The sorted vertices of a face: at most three.
#[derive(PartialEq, Eq)]
pub(crate) struct Face {
    vertices: [u32; 3],
    length: usize,
}

impl Deref for Face {
    type Target = [u32];
    fn deref(&self) -> &[u32] {
        &self.vertices[..self.length]
    }
}

/// Vertices and place in one number, ordered by the vertices first.
fn pack(face: Face, place: usize) -> u128 {
    face.iter().fold(0, |key, &v| key << 32 | u128::from(v)) << 32 | place as u128
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
