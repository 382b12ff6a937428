//! Cells and vertices in an order that suits the processor's caches.
//!
//! Files come in any order, and on a large mesh in random order every look at a neighbour waits for memory: the whole
//! construction takes three times as long. So it runs on the same mesh numbered along a curve through space, and
//! what it made is numbered back. The map that comes out refers to the source as the user gave it.

use homeo_core::mesh::{Adjacency, CellId, SimplicialComplex, VertexId};
use homeo_core::spatial::cells_along_curve;

use crate::input::SourceMesh;
use crate::map::{Centre, FoliationParts, Section};

/// A mesh numbered along a curve.
pub(super) struct CurveNumbering<const K: usize> {
    /// The mesh in its new numbering.
    pub source: SourceMesh<K>,
    /// The original vertex and cell of each new one.
    vertices: Vec<VertexId>,
    cells: Vec<CellId>,
}

impl<const K: usize> CurveNumbering<K> {
    /// Numbers the cells of a mesh by their centroids, and its vertices as those cells first use them.
    pub fn new(original: &SourceMesh<K>) -> Self {
        let (complex, positions) = (original.complex(), original.positions());
        let cells = cells_along_curve(complex, positions);
        let mut number = vec![None; positions.len()];
        let mut vertices = Vec::with_capacity(positions.len());
        for vertex in cells.iter().flat_map(|&cell| complex.cell(cell)).chain((0..positions.len()).map(VertexId::new)) {
            number[vertex.index()].get_or_insert_with(|| {
                vertices.push(vertex);
                VertexId::new(vertices.len() - 1)
            });
        }
        let renumbered = |v: VertexId| number[v.index()].unwrap_or(v);
        let corners = cells.iter().map(|&cell| complex.cell(cell).map(renumbered)).collect();
        let complex = SimplicialComplex::new(positions.len(), corners).expect("a numbering of the same vertices");
        let source = SourceMesh::new(vertices.iter().map(|v| positions[v.index()]).collect(), complex);
        Self { source, vertices, cells }
    }

    /// A map of the renumbered mesh as a map of the original one.
    pub fn restored(
        &self,
        original: &SourceMesh<K>,
        parts: &FoliationParts<K>,
        adjacency: &Adjacency<K>,
    ) -> (FoliationParts<K>, Adjacency<K>) {
        let (mesh, order) = parts.mesh.renumbered(original, &self.vertices, &self.cells);
        let centre = parts.centre.map(|centre| Centre {
            cell: CellId::new(order.iter().position(|&cell| cell == centre.cell).expect("the centre is a cell")),
            ..centre
        });
        let restored = FoliationParts {
            target: parts.target,
            mesh,
            directions: order.iter().map(|cell| parts.directions[cell.index()]).collect(),
            lengths: order.iter().map(|cell| parts.lengths[cell.index()]).collect(),
            length_unit: parts.length_unit,
            centre,
            section: self.restored_section(parts.section.clone()),
        };
        (restored, adjacency.reordered(&order))
    }

    fn restored_section(&self, mut section: Section) -> Section {
        match &mut section {
            Section::Arc { vertices, .. } | Section::Loop { vertices, .. } | Section::Square { vertices, .. } => {
                for vertex in vertices {
                    // Vertices that were added have the same number in both.
                    *vertex = self.vertices.get(vertex.index()).copied().unwrap_or(*vertex);
                }
            }
            Section::Centre => {}
        }
        section
    }
}
