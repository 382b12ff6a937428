//! The surface over which the first shell stands: the source, with edges split where two neighbours cannot both have a
//! column of some length.
//!
//! A prism bears one pinched column. The middle of a split edge is rounded, so this surface may differ from the source in
//! the last digits; the source need not be the middle of its shell, only lie in it.

use homeo_core::mesh::{SimplicialComplex, VertexId};

use super::directions::{extrusion_directions, triangles_around};
use crate::input::SourceMesh;

/// See the module's documentation.
pub(super) struct Base {
    pub mesh: SourceMesh<3>,
    /// The source's triangle of each triangle.
    pub parents: Vec<u32>,
    /// Extrusion directions at the vertices.
    pub directions: Vec<Option<[f64; 3]>>,
}

impl Base {
    /// The source, with the edges between singular vertices split.
    pub fn new(source: &SourceMesh<3>) -> Self {
        let parents = (0..source.complex().cell_count() as u32).collect();
        let directions = extrusion_directions(source.complex(), source.positions());
        let mut base = Self { mesh: source.clone(), parents, directions };
        let pairs = base.singular_pairs();
        if !pairs.is_empty() {
            base.split(&pairs);
        }
        base
    }

    /// Edges, not on the boundary, between two vertices without a direction.
    fn singular_pairs(&self) -> Vec<[u32; 2]> {
        let is_singular = |v: VertexId| self.directions[v.index()].is_none();
        let sides = self.mesh.complex().cells().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let pairs = sides.filter(|&[a, b]| is_singular(a) && is_singular(b));
        let mut pairs: Vec<[u32; 2]> = pairs.map(|[a, b]| [a.raw(), b.raw()]).filter(|[a, b]| a < b).collect();
        pairs.sort_unstable();
        pairs
    }

    /// Splits edges at their middles, one after the other. Those on the boundary stay: the theorem needs them. Returns how
    /// many were split.
    pub fn split(&mut self, edges: &[[u32; 2]]) -> usize {
        let mut positions = self.mesh.positions().to_vec();
        let mut cells: Vec<[u32; 3]> = self.mesh.complex().cells().iter().map(|cell| cell.map(|v| v.raw())).collect();
        let mut around = triangles_around(self.mesh.complex());
        let before = positions.len();
        for &[a, b] in edges {
            let [p, q] = [a, b].map(|v| positions[v as usize]);
            let middle = [0, 1, 2].map(|axis| 0.5 * p[axis] + 0.5 * q[axis]);
            let both: Vec<u32> =
                around[a as usize].iter().copied().filter(|&t| cells[t as usize].contains(&b)).collect();
            if both.len() != 2 || middle == p || middle == q {
                continue;
            }
            let new = positions.len() as u32;
            positions.push(middle);
            around.push(Vec::new());
            for t in both {
                let with = |gone: u32| cells[t as usize].map(|v| if v == gone { new } else { v });
                let [first, second] = [with(b), with(a)];
                let added = cells.len() as u32;
                cells[t as usize] = first;
                cells.push(second);
                self.parents.push(self.parents[t as usize]);
                around[b as usize].retain(|&other| other != t);
                around[new as usize].push(t);
                second.iter().for_each(|&v| around[v as usize].push(added));
            }
        }
        let split = positions.len() - before;
        let complex = SimplicialComplex::from_indices(positions.len(), &cells);
        // Every corner is a vertex from before or one that was just added.
        debug_assert!(complex.is_ok(), "corners exist");
        if let Ok(complex) = complex {
            self.directions = extrusion_directions(&complex, &positions);
            self.mesh = SourceMesh::new(positions, complex);
        }
        split
    }
}
