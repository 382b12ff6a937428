//! The shape of a triangle complex, without coordinates.

use super::connectivity::{Corners, LinkWalk, Sheets};
use super::gluing::Gluing;
use crate::mesh::{CellId, Facet, TriangleComplex, VertexId};

/// A piece of the surface and its counts.
#[derive(Clone, Default)]
pub(super) struct Piece {
    pub lowest_cell: u32,
    pub vertices: usize,
    pub faces: usize,
    pub boundary_edges: usize,
    pub loops: usize,
    pub orientable: bool,
}

impl Piece {
    /// Vertices minus edges plus triangles; each edge has two triangles or lies on the boundary.
    pub(super) fn euler_characteristic(&self) -> i64 {
        let edges = (3 * self.faces + self.boundary_edges) / 2;
        self.vertices as i64 - edges as i64 + self.faces as i64
    }

    /// The number of handles of an orientable piece.
    pub(super) fn genus(&self) -> Option<i64> {
        self.orientable.then(|| (2 - self.loops as i64 - self.euler_characteristic()) / 2)
    }
}

/// A loop of the boundary: its facets in order, each as (triangle, opposite vertex).
pub(super) struct Loop {
    pub facets: Vec<Facet>,
}

/// Everything about a triangle complex that does not need coordinates.
pub(super) struct SurfaceShape {
    pub corners: Corners,
    pub sheets: Sheets,
    pub components: usize,
    /// Vertices with more than one fan, apart from those on crowded edges.
    pub pinched: Vec<[u32; 1]>,
    /// Empty unless no edge is crowded.
    pub loops: Vec<Loop>,
    /// The sheets with their counts; empty unless the complex is a manifold.
    pub pieces: Vec<Piece>,
    pub used_vertices: usize,
    pub manifold: bool,
}

impl SurfaceShape {
    /// Linear in the number of triangles.
    pub(super) fn new(complex: &TriangleComplex, gluing: &Gluing<3>) -> Self {
        let corners = Corners::new(complex);
        let sheets = Sheets::new(gluing);
        let components = sheets.components(complex);
        let pinched = pinched_vertices(complex, gluing, &corners);
        let used_vertices = (0..complex.vertex_count()).filter(|&v| !corners.at(v).is_empty()).count();
        let loops = if gluing.crowded.is_empty() { boundary_loops(complex, gluing) } else { Vec::new() };
        let manifold = gluing.crowded.is_empty() && pinched.is_empty();
        let mut shape =
            Self { corners, sheets, components, pinched, loops, pieces: Vec::new(), used_vertices, manifold };
        if manifold {
            shape.pieces = shape.count_pieces(complex);
        }
        shape
    }

    fn count_pieces(&self, complex: &TriangleComplex) -> Vec<Piece> {
        let mut pieces = vec![Piece { lowest_cell: u32::MAX, orientable: true, ..Piece::default() }; self.sheets.count];
        for (cell, &sheet) in self.sheets.of_cell.iter().enumerate() {
            let piece = &mut pieces[sheet as usize];
            piece.faces += 1;
            piece.lowest_cell = piece.lowest_cell.min(cell as u32);
        }
        for vertex in 0..complex.vertex_count() {
            if let Some(corner) = self.corners.at(vertex).first() {
                pieces[self.sheet_of(corner.cell())].vertices += 1;
            }
        }
        for boundary in &self.loops {
            let piece = &mut pieces[self.sheet_of(boundary.facets[0].cell())];
            piece.loops += 1;
            piece.boundary_edges += boundary.facets.len();
        }
        for &[cell, _] in &self.sheets.contradictions {
            pieces[self.sheets.of_cell[cell as usize] as usize].orientable = false;
        }
        pieces
    }

    /// The triangles of each sheet.
    pub(super) fn sheet_cells(&self) -> SheetCells {
        let mut starts = vec![0u32; self.sheets.count + 1];
        for &sheet in &self.sheets.of_cell {
            starts[sheet as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut fill = starts.clone();
        let mut cells = vec![0; self.sheets.of_cell.len()];
        for (cell, &sheet) in self.sheets.of_cell.iter().enumerate() {
            cells[fill[sheet as usize] as usize] = cell as u32;
            fill[sheet as usize] += 1;
        }
        SheetCells { starts, cells }
    }

    fn sheet_of(&self, cell: CellId) -> usize {
        self.sheets.of_cell[cell.index()] as usize
    }

    /// Whether some choice of turns is consistent across edges of two triangles.
    pub(super) fn orientable(&self) -> bool {
        self.sheets.contradictions.is_empty()
    }
}

/// The triangles of each sheet, ascending.
pub(super) struct SheetCells {
    starts: Vec<u32>,
    cells: Vec<u32>,
}

impl SheetCells {
    /// The triangles of one sheet as vertex numbers.
    pub(super) fn triangles<'a>(
        &'a self,
        sheet: usize,
        complex: &'a TriangleComplex,
    ) -> impl Iterator<Item = [usize; 3]> + Clone + 'a {
        let cells = &self.cells[self.starts[sheet] as usize..self.starts[sheet + 1] as usize];
        cells.iter().map(|&cell| complex.cells()[cell as usize].map(VertexId::index))
    }
}

/// Vertices whose triangles form more than one fan, where no crowded edge ends there.
fn pinched_vertices(complex: &TriangleComplex, gluing: &Gluing<3>, corners: &Corners) -> Vec<[u32; 1]> {
    let excused = vertices_on_crowded_facets(complex, gluing);
    let mut walk = LinkWalk::new(complex.cell_count());
    (0..complex.vertex_count())
        .filter(|&v| !walk.is_connected(complex, gluing, corners.at(v)) && excused.binary_search(&(v as u32)).is_err())
        .map(|v| [v as u32])
        .collect()
}

/// Vertices on facets of more than two cells, ascending.
pub(super) fn vertices_on_crowded_facets<const K: usize>(
    complex: &crate::mesh::SimplicialComplex<K>,
    gluing: &Gluing<K>,
) -> Vec<u32> {
    let facets = gluing.crowded.iter().filter_map(|group| group.first());
    let mut vertices: Vec<u32> =
        facets.flat_map(|f| complex.facet_vertices(f.cell(), f.opposite())).map(VertexId::raw).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// The loops of the boundary. At a vertex with several fans the loop stays in its fan.
fn boundary_loops(complex: &TriangleComplex, gluing: &Gluing<3>) -> Vec<Loop> {
    let mut done = vec![0u8; complex.cell_count()];
    let mut loops = Vec::new();
    for start in gluing.boundary_facets() {
        if done[start.cell().index()] >> start.opposite() & 1 == 1 {
            continue;
        }
        let mut facets = Vec::new();
        // The pivot is the end of the edge around which the walk goes on.
        let (mut edge, mut pivot) = (start, (start.opposite() + 2) % 3);
        while done[edge.cell().index()] >> edge.opposite() & 1 == 0 {
            done[edge.cell().index()] |= 1 << edge.opposite();
            facets.push(edge);
            (edge, pivot) = next_boundary_edge(complex, gluing, edge, pivot);
        }
        loops.push(Loop { facets });
    }
    loops
}

/// Turns around the vertex number `pivot` of the triangle of `edge` to the other boundary edge of
/// the fan; returns it with the number of its end away from the pivot.
fn next_boundary_edge(complex: &TriangleComplex, gluing: &Gluing<3>, edge: Facet, pivot: usize) -> (Facet, usize) {
    let centre = complex.cell(edge.cell())[pivot];
    let (mut cell, mut entered, mut pivot) = (edge.cell(), edge.opposite(), pivot);
    loop {
        // The edge at the pivot through which the triangle was not entered.
        let leave = 3 - pivot - entered;
        let across = gluing.across[cell.index()][leave];
        if across.is_none() {
            return (Facet::new(cell, leave), entered);
        }
        cell = across.cell();
        entered = across.opposite();
        pivot = super::connectivity::number_of(&complex.cell(cell), centre);
    }
}
