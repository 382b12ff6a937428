//! Which meshes get no shell, with the first offending elements and what to do.

use homeo_core::mesh::TriangleComplex;
use homeo_core::topology::{Intersections, Options, analyse_triangles};

use crate::failure::{Failure, Result};
use crate::mesh_input::{Cells, MeshInput};
use crate::refuse::{Need, unless_fit, unless_simplices};
use crate::session::Session;

/// A surface that touches itself in a vertex has no shell either.
const GRAVE: [&str; 1] = ["coincident-vertices"];

/// What becomes of a surface that crosses itself.
#[derive(Clone, Copy)]
pub enum Crossings {
    /// It is taken as an abstract surface.
    Allowed,
    /// It is refused.
    Refused {
        /// What to do, where nothing else is wrong.
        advice: &'static str,
    },
}

/// Refuses a mesh that is no surface, or crosses or touches itself, which may be allowed; gives its triangles.
///
/// # Errors
/// All that is wrong with it.
pub fn unfit<'m>(
    session: &Session,
    mesh: &'m MeshInput,
    triangulate: bool,
    crossings: Crossings,
) -> Result<&'m TriangleComplex> {
    unless_simplices(mesh, triangulate)?;
    let Cells::Triangles(complex) = &mesh.cells else {
        let message = "this is a volume of tetrahedra, a shell needs a surface: give its boundary as triangles";
        return Err(Failure::input("wrong-dimension", message));
    };
    let options = Options {
        intersections: match crossings {
            Crossings::Allowed => Intersections::WhereNeeded,
            Crossings::Refused { .. } => Intersections::Find,
        },
    };
    let report = analyse_triangles(&mesh.file.positions, complex, options);
    let need = Need {
        name: "surface",
        code: "unfit-input",
        heading: "the mesh is not a surface that can have a shell:".to_owned(),
        harmless: &[],
        grave: &GRAVE,
    };
    let advised = |failure: Failure| match crossings {
        Crossings::Refused { advice } if failure.code == "self-intersection" => {
            Failure { message: format!("{}\n  {advice}", failure.message), ..failure }
        }
        _ => failure,
    };
    unless_fit(session, &report.violations, None, &need).map_err(advised)?;
    Ok(complex)
}
