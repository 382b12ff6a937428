//! Which meshes have no unit tangent bundle as a closed manifold, with the first offending elements and what to do.

use homeo_core::mesh::TriangleComplex;
use homeo_core::topology::{Options, SurfaceReport, analyse_triangles};

use crate::failure::{Failure, Result};
use crate::mesh_input::{Cells, MeshInput};
use crate::refuse::{Need, unless_fit, unless_simplices};
use crate::session::Session;

/// Faults of places, not of the complex.
const HARMLESS: [&str; 2] = ["self-intersection", "degenerate-cell"];
/// Over a vertex in no triangle there would be a circle by itself.
const GRAVE: [&str; 1] = ["isolated-vertex"];

/// Refuses a mesh that is no closed connected oriented surface; gives its triangles.
///
/// # Errors
/// All that is wrong with it.
pub fn unfit<'m>(session: &Session, mesh: &'m MeshInput, triangulate: bool) -> Result<&'m TriangleComplex> {
    unless_simplices(mesh, triangulate)?;
    let Cells::Triangles(complex) = &mesh.cells else {
        let message = "this is a volume of tetrahedra, a bundle needs a surface: give its boundary as triangles";
        return Err(Failure::input("wrong-dimension", message));
    };
    let report = analyse_triangles(&mesh.file.positions, complex, Options::default());
    let need = Need {
        name: "closed surface",
        code: "not-a-closed-surface",
        heading: "the mesh is not a closed, connected, oriented surface:".to_owned(),
        harmless: &HARMLESS,
        grave: &GRAVE,
    };
    let shape = not_closed(&report);
    unless_fit(session, &report.violations, shape, &need)?;
    Ok(complex)
}

/// Why a surface is not closed and connected.
fn not_closed(report: &SurfaceReport) -> Option<String> {
    let mut reasons = Vec::new();
    if report.components > 1 {
        let first: Vec<String> = report.parts.iter().take(3).map(|part| part.cell.to_string()).collect();
        let at = first.join(", ");
        reasons.push(format!("it has {} pieces (at triangles {at}, ...): pass them one by one", report.components));
    }
    if report.boundary_edges > 0 {
        let loops = report.boundary.iter().flatten().take(3);
        let first: Vec<String> = loops.map(|l| format!("{} edges at vertex {}", l.edges, l.vertex)).collect();
        let at = if first.is_empty() { String::new() } else { format!(" ({})", first.join("; ")) };
        reasons.push(format!("it has {} boundary edges{at}: fill the holes", report.boundary_edges));
    }
    (!reasons.is_empty()).then(|| format!("shape: {}", reasons.join("; ")))
}
