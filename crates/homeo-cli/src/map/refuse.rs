//! Which meshes cannot be mapped, with the first offending elements and what to do.

use homeo::map::Target;
use homeo_core::topology::{Answer, Options, SurfaceReport, VolumeReport, analyse_tetrahedra, analyse_triangles};

use crate::failure::{Failure, Result};
use crate::mesh_input::{Cells, MeshInput};
use crate::refuse::{Need, unless_fit, unless_simplices};
use crate::session::Session;

/// Faults that do not touch the complex itself.
const HARMLESS: [&str; 1] = ["self-intersection"];

/// Refuses a mesh that is not what the target needs.
///
/// # Errors
/// All that is wrong with it.
pub fn unfit(session: &Session, mesh: &MeshInput, target: Target, triangulate: bool) -> Result<()> {
    unless_simplices(mesh, triangulate)?;
    let (violations, shape) = match (&mesh.cells, target.dimension()) {
        (Cells::Triangles(complex), 2) => {
            let report = analyse_triangles(&mesh.file.positions, complex, Options::default());
            let shape = not_a_disk(&report);
            (report.violations, shape)
        }
        (Cells::Tetrahedra(complex), 3) => {
            let report = analyse_tetrahedra(&mesh.file.positions, complex, Options::default());
            let shape = not_a_ball(&report);
            (report.violations, shape)
        }
        (cells, _) => return Err(wrong_dimension(cells, target)),
    };
    let needed = if target.dimension() == 2 { "disk" } else { "ball" };
    let need = Need {
        name: needed,
        code: if needed == "disk" { "not-a-disk" } else { "not-a-ball" },
        heading: format!("the mesh is not a {needed} that can be mapped onto the {target}:"),
        harmless: &HARMLESS,
        grave: &[],
    };
    unless_fit(session, &violations, shape, &need)
}

fn wrong_dimension(cells: &Cells, target: Target) -> Failure {
    let message = match cells {
        Cells::Triangles(_) => format!(
            "this is a surface of triangles, the {target} needs tetrahedra: mesh its inside first (fTetWild, TetGen, Gmsh), \
             or map a disk onto the square or disk"
        ),
        Cells::Tetrahedra(_) => format!(
            "this is a volume of tetrahedra, the {target} needs a surface: choose --onto cube or ball, or give triangles"
        ),
    };
    Failure::input("wrong-dimension", message)
}

/// Why a surface is no disk, if manifold faults do not say it already.
fn not_a_disk(report: &SurfaceReport) -> Option<String> {
    if report.is_disk || !report.manifold {
        return None;
    }
    let mut reasons = Vec::new();
    if report.components > 1 {
        let first: Vec<String> = report.parts.iter().take(3).map(|part| part.cell.to_string()).collect();
        reasons.push(format!(
            "it has {} pieces (at triangles {}, ...): pass them one by one",
            report.components,
            first.join(", ")
        ));
    }
    if report.closed {
        reasons.push("it is closed, a disk has one boundary loop: cut it open, or take a triangle out".to_owned());
    }
    if let Some(loops) = report.boundary_loops.filter(|&n| n > 1 && report.components <= 1) {
        let first: Vec<String> = report
            .boundary
            .iter()
            .flatten()
            .take(3)
            .map(|l| format!("{} edges at vertex {}", l.edges, l.vertex))
            .collect();
        let more = if loops > 3 { "; ..." } else { "" };
        reasons.push(format!(
            "it has {loops} boundary loops ({}{more}), a disk has one: fill the other holes",
            first.join("; ")
        ));
    }
    if let Some(genus) = report.genus.filter(|&g| g > 0) {
        reasons.push(format!("it has genus {genus}, a disk has none: cut it open along its handles"));
    }
    if reasons.is_empty() && report.orientable {
        reasons.push(format!("its Euler characteristic is {}, that of a disk is 1", report.euler_characteristic));
    }
    (!reasons.is_empty()).then(|| format!("shape: {}", reasons.join("; ")))
}

/// Why a volume is no ball, if manifold faults do not say it already. Where that is unknown the certificate decides.
fn not_a_ball(report: &VolumeReport) -> Option<String> {
    if report.ball.answer != Answer::No || !report.manifold {
        return None;
    }
    let boundary = &report.boundary;
    let advice = if report.components > 1 {
        "pass the pieces one by one".to_owned()
    } else if boundary.components > 1 {
        format!("its boundary has {} pieces: fill the cavities with tetrahedra", boundary.components)
    } else if boundary.genus.is_some_and(|g| g > 0) {
        format!(
            "a solid with {} handles is no ball: cut the handles through, or fill them",
            boundary.genus.unwrap_or_default()
        )
    } else {
        "see `homeo info`".to_owned()
    };
    Some(format!("shape: {}; {advice}", report.ball.reason))
}
