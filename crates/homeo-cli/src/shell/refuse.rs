//! Which meshes get no shell, with the first offending elements and what to do.

use homeo_core::mesh::TriangleComplex;
use homeo_core::topology::{Intersections, Options, analyse_triangles};

use crate::failure::{Failure, Result};
use crate::mesh_input::{Cells, MeshInput};
use crate::refuse::{Need, unless_fit, unless_simplices};
use crate::session::Session;

/// A surface that touches itself in a vertex has no shell either.
const GRAVE: [&str; 1] = ["coincident-vertices"];

/// Refuses a mesh that is no closed surface, or crosses itself; gives its triangles.
///
/// # Errors
/// All that is wrong with it.
pub fn unfit<'m>(session: &Session, mesh: &'m MeshInput, triangulate: bool) -> Result<&'m TriangleComplex> {
    unless_simplices(mesh, triangulate)?;
    let Cells::Triangles(complex) = &mesh.cells else {
        let message = "this is a volume of tetrahedra, a shell needs a closed surface: give its boundary as triangles";
        return Err(Failure::input("wrong-dimension", message));
    };
    let options = Options { intersections: Intersections::Find };
    let report = analyse_triangles(&mesh.file.positions, complex, options);
    let is_open = report.edge_manifold && report.boundary_edges > 0;
    // The library builds shells of open surfaces; the checker does not prove them yet.
    let shape = is_open.then(|| {
        let edges = report.boundary_edges;
        format!("shape: the surface has a boundary, and shells of open surfaces are not made yet: close its {edges} boundary edges")
    });
    let need = Need {
        name: "closed-surface",
        code: "open-boundary",
        heading: "the mesh is not a closed surface that can have a shell:".to_owned(),
        harmless: &[],
        grave: &GRAVE,
    };
    unless_fit(session, &report.violations, shape, &need)?;
    Ok(complex)
}
