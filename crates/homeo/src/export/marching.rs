//! Zero sets of functions that are linear on each cell: marching tetrahedra and marching triangles.

use super::data::{CellList, CellMesh};
use std::collections::HashMap;

/// A piece of a zero set with its vertices in the source and in the target.
#[derive(Clone, Debug, Default)]
pub(super) struct Patch {
    /// Vertices in the source.
    pub source: Vec<[f64; 3]>,
    /// The same vertices in the target.
    pub image: Vec<[f64; 3]>,
    /// Triangles (three per element) or segments (two per element).
    pub elements: Vec<u32>,
}

impl Patch {
    /// Bytes after packing: two quantized points per vertex and the indices.
    pub fn packed_bytes(&self) -> usize {
        let index_bytes = if self.source.len() <= 1 << 16 { 2 } else { 4 };
        12 * self.source.len() + index_bytes * self.elements.len()
    }
}

/// Vertices of a patch by the mesh edge that they lie on.
struct Cutter<'a> {
    mesh: &'a CellMesh,
    values: &'a [f64],
    patch: Patch,
    on_edge: HashMap<(u32, u32), u32>,
}

impl Cutter<'_> {
    /// The vertex where the function vanishes on the edge from `a` to `b`, at which its signs differ.
    fn vertex(&mut self, a: u32, b: u32) -> u32 {
        let edge = (a.min(b), a.max(b));
        if let Some(&vertex) = self.on_edge.get(&edge) {
            return vertex;
        }
        let (a, b) = (edge.0 as usize, edge.1 as usize);
        // The signs differ, so the denominator is not zero; the quotient lies in [0, 1] up to rounding.
        let share = (self.values[a] / (self.values[a] - self.values[b])).clamp(0.0, 1.0);
        let between = |p: [f64; 3], q: [f64; 3]| std::array::from_fn(|i| p[i] + share * (q[i] - p[i]));
        let vertex = self.patch.source.len() as u32;
        self.patch.source.push(between(self.mesh.positions[a], self.mesh.positions[b]));
        self.patch.image.push(between(self.mesh.images[a], self.mesh.images[b]));
        self.on_edge.insert(edge, vertex);
        vertex
    }

    fn cut_triangle(&mut self, corners: &[u32; 3]) {
        let (above, below) = self.split(corners);
        if let ([one], [x, y]) | ([x, y], [one]) = (above.as_slice(), below.as_slice()) {
            let segment = [self.vertex(*one, *x), self.vertex(*one, *y)];
            self.patch.elements.extend(segment);
        }
    }

    fn cut_tetrahedron(&mut self, corners: &[u32; 4]) {
        let (above, below) = self.split(corners);
        match (above.as_slice(), below.as_slice()) {
            ([one], [x, y, z]) | ([x, y, z], [one]) => {
                let triangle = [self.vertex(*one, *x), self.vertex(*one, *y), self.vertex(*one, *z)];
                self.patch.elements.extend(triangle);
            }
            ([a, b], [x, y]) => {
                let [ax, ay] = [self.vertex(*a, *x), self.vertex(*a, *y)];
                let [by, bx] = [self.vertex(*b, *y), self.vertex(*b, *x)];
                self.patch.elements.extend([ax, ay, by, ax, by, bx]);
            }
            _ => {}
        }
    }

    /// Corners where the function is not negative, and the others.
    fn split(&self, corners: &[u32]) -> (Vec<u32>, Vec<u32>) {
        corners.iter().partition(|&&corner| self.values[corner as usize] >= 0.0)
    }
}

/// The set where the function with these vertex values vanishes: triangles in a volume, segments on a surface.
pub(super) fn zero_set(mesh: &CellMesh, values: &[f64]) -> Patch {
    let mut cutter = Cutter { mesh, values, patch: Patch::default(), on_edge: HashMap::new() };
    let crossed = |corners: &[u32]| {
        let above = corners.iter().filter(|&&corner| values[corner as usize] >= 0.0).count();
        above != 0 && above != corners.len()
    };
    match &mesh.cells {
        CellList::Triangles(cells) => {
            cells.iter().filter(|cell| crossed(*cell)).for_each(|cell| cutter.cut_triangle(cell));
        }
        CellList::Tetrahedra(cells) => {
            cells.iter().filter(|cell| crossed(*cell)).for_each(|cell| cutter.cut_tetrahedron(cell));
        }
    }
    cutter.patch
}
