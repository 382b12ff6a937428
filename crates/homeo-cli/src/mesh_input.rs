//! From a mesh file to a complex that a construction takes: triangles or tetrahedra, and what was changed on request.

use std::path::Path;

use homeo::input::SourceMesh;
use homeo::progress::Progress;
use homeo_core::io::{Attribute, Element, MeshFile, ReadError, Values, WeldReport, read_mesh};
use homeo_core::mesh::{CellId, SimplicialComplex, TetrahedronComplex, TriangleComplex};
use homeo_core::predicate::{Sign, orient3d};
use serde_json::{Value, json};

use crate::failure::{Failure, Result};
use crate::session::Session;
use crate::welded;

/// Changes that the user asks for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Requested {
    pub weld: bool,
    pub triangulate: bool,
    pub orient: bool,
}

/// A mesh file and the complex of its cells.
pub struct MeshInput {
    /// The file, with the requested changes.
    pub file: MeshFile,
    /// Its cells.
    pub cells: Cells,
    /// Polygons that are no triangles in the file, the first of them.
    pub polygons: Vec<u32>,
    /// How many those are.
    pub polygon_count: usize,
    /// What was changed on request, one sentence each.
    pub changes: Vec<String>,
    /// Which vertices were merged, where that was asked for.
    pub welded: Option<WeldReport>,
}

/// The cells of highest dimension.
pub enum Cells {
    Triangles(TriangleComplex),
    Tetrahedra(TetrahedronComplex),
}

/// Reads a mesh file. Larger polygons are cut into triangles; the caller refuses them where that was not asked for.
///
/// # Errors
/// When the file cannot be read.
pub fn read(session: &Session, path: &Path, requested: Requested) -> Result<MeshInput> {
    session.stage("read");
    session.fact("input", json!({"path": path.display().to_string()}));
    let file = read_mesh(path).map_err(|error| unreadable(&error))?;
    let input = MeshInput::new(file, requested)?;
    session.fact("input", input.described(path));
    session.check()?;
    Ok(input)
}

/// The failure for a file that cannot be read.
pub fn unreadable(error: &ReadError) -> Failure {
    Failure::input(error.code, error.to_string())
}

impl MeshInput {
    fn new(mut file: MeshFile, requested: Requested) -> Result<Self> {
        // Comes first: the other changes depend on which vertices elements have in common.
        let welded = requested.weld.then(|| file.weld());
        let is_volume = file.is_volume();
        let larger: Vec<u32> = if is_volume {
            Vec::new()
        } else {
            (0..file.polygons.len()).filter(|&p| file.polygons.polygon(p).len() != 3).map(|p| p as u32).collect()
        };
        let mut changes = welded.as_ref().map_or_else(Vec::new, welded::sentences);
        let mut file = if larger.is_empty() { file } else { file.triangulated().mesh };
        if requested.triangulate && !larger.is_empty() {
            changes.push(format!("{} polygons were cut into triangles", larger.len()));
        }
        if requested.orient {
            let turned = if is_volume { orient_tetrahedra(&mut file) } else { orient_triangles(&mut file)? };
            changes.push(format!("{turned} {} were turned", if is_volume { "tetrahedra" } else { "triangles" }));
        }
        let cells = cells_of(&file)?;
        let polygon_count = larger.len();
        Ok(Self { cells, polygon_count, polygons: larger.into_iter().take(10).collect(), changes, welded, file })
    }

    /// The `input` field of JSON objects.
    pub fn described(&self, path: &Path) -> Value {
        let mut described = json!({"path": path.display().to_string(), "vertices": self.file.vertex_count});
        match &self.cells {
            Cells::Triangles(complex) => described["triangles"] = json!(complex.cell_count()),
            Cells::Tetrahedra(complex) => described["tetrahedra"] = json!(complex.cell_count()),
        }
        if self.polygon_count > 0 {
            described["polygons_not_triangles"] = json!(self.polygon_count);
        }
        if let Some(report) = &self.welded {
            described["welded"] = welded::described(report);
        }
        if !self.changes.is_empty() {
            described["changes"] = json!(self.changes);
        }
        if !self.file.losses.is_empty() {
            described["losses"] = json!(self.file.losses);
        }
        described
    }

    /// All cells one after the other, and how many vertices each has.
    pub fn flat_cells(&self) -> (Vec<u32>, usize) {
        match &self.cells {
            Cells::Triangles(complex) => (flat(complex), 3),
            Cells::Tetrahedra(complex) => (flat(complex), 4),
        }
    }
}

fn flat<const K: usize>(complex: &SimplicialComplex<K>) -> Vec<u32> {
    complex.cells().iter().flatten().map(|v| v.raw()).collect()
}

/// The mesh in the form that constructions take.
pub fn source_mesh<const K: usize>(file: &MeshFile, complex: &SimplicialComplex<K>) -> SourceMesh<K> {
    SourceMesh::new(file.positions.clone(), complex.clone())
}

fn cells_of(file: &MeshFile) -> Result<Cells> {
    let broken = |error: homeo_core::mesh::IndexOutOfRange| Failure::input("index-out-of-range", error.to_string());
    Ok(if file.is_volume() {
        Cells::Tetrahedra(TetrahedronComplex::from_indices(file.vertex_count, &file.tetrahedra).map_err(broken)?)
    } else {
        Cells::Triangles(TriangleComplex::from_indices(file.vertex_count, &triangles(file)).map_err(broken)?)
    })
}

fn triangles(file: &MeshFile) -> Vec<[u32; 3]> {
    file.polygons.iter().filter_map(|polygon| polygon.try_into().ok()).collect()
}

/// Swaps two vertices of every tetrahedron of negative volume; returns how many.
fn orient_tetrahedra(file: &mut MeshFile) -> usize {
    if file.positions.is_empty() {
        return 0;
    }
    let positions = &file.positions;
    let mut turned = 0;
    for cell in &mut file.tetrahedra {
        let [a, b, c, d] = cell.map(|v| positions[v as usize]);
        if orient3d(a, b, c, d) == Sign::Negative {
            cell.swap(2, 3);
            turned += 1;
        }
    }
    turned
}

/// Turns triangles so that they agree with the first of their piece; returns how many.
fn orient_triangles(file: &mut MeshFile) -> Result<usize> {
    let cells = triangles(file);
    let complex = TriangleComplex::from_indices(file.vertex_count, &cells)
        .map_err(|e| Failure::input("index-out-of-range", e.to_string()))?;
    let adjacency = complex.adjacency().map_err(|e| {
        Failure::input(
            "non-manifold-facet",
            format!("{e}: such a surface cannot be oriented; take the extra triangles away"),
        )
    })?;
    let edge = |cell: usize, opposite: usize| (cells[cell][(opposite + 1) % 3], cells[cell][(opposite + 2) % 3]);
    let mut turn: Vec<Option<bool>> = vec![None; cells.len()];
    for seed in 0..cells.len() {
        if turn[seed].is_some() {
            continue;
        }
        turn[seed] = Some(false);
        let mut stack = vec![seed];
        while let Some(cell) = stack.pop() {
            for opposite in 0..3 {
                let far = adjacency.across(CellId::new(cell), opposite);
                if far.is_none() || turn[far.cell().index()].is_some() {
                    continue;
                }
                let there = far.cell().index();
                let disagree = edge(cell, opposite) == edge(there, far.opposite());
                turn[there] = turn[cell].map(|here| here ^ disagree);
                stack.push(there);
            }
        }
    }
    let turned: Vec<usize> = (0..cells.len()).filter(|&c| turn[c] == Some(true)).collect();
    turn_polygons(file, &turned);
    Ok(turned.len())
}

/// Swaps the last two corners of triangles, with what belongs to corners.
fn turn_polygons(file: &mut MeshFile, turned: &[usize]) {
    for &polygon in turned {
        file.polygons.corners.swap(3 * polygon + 1, 3 * polygon + 2);
    }
    let on_corners = |attribute: &&mut Attribute| attribute.element == Element::Corner;
    for attribute in file.attributes.iter_mut().filter(on_corners) {
        let width = attribute.components;
        for &polygon in turned {
            let (a, b) = ((3 * polygon + 1) * width, (3 * polygon + 2) * width);
            for k in 0..width {
                match &mut attribute.values {
                    Values::F64(values) => values.swap(a + k, b + k),
                    Values::F32(values) => values.swap(a + k, b + k),
                    Values::I64(values) => values.swap(a + k, b + k),
                    Values::Text(values) => values.swap(a + k, b + k),
                }
            }
        }
    }
}
