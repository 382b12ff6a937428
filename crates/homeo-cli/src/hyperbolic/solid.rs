//! From a tetrahedral mesh of a solid to a triangulation whose vertices are its boundary components, cut off.

use std::path::Path;

use homeo::progress::Progress;
use homeo_core::mesh::TetrahedronComplex;
use homeo_core::topology::{Options, VolumeReport, analyse_tetrahedra};
use homeo_manifold::simplify::{Simplifier, SimplifyError, coned, without_inner_vertices};
use homeo_manifold::{Homology, Triangulation};

use super::search::genera;
use crate::failure::{Failure, Result};
use crate::mesh_input::{self, Cells, Requested};
use crate::refuse::{Need, unless_fit};
use crate::session::Session;

/// Rounds of the search for few tetrahedra between two looks at the limits.
const ROUNDS: usize = 10;
/// The search ends after so many times this many rounds without a smaller triangulation.
const PATIENCE: usize = 5;

/// Reads a mesh, refuses what cannot have a structure by its boundary, and simplifies the rest.
///
/// # Errors
/// What is wrong with the mesh, and [`Exit::Bug`](crate::failure::Exit::Bug) if the manifold is another one afterwards.
pub fn read(session: &Session, path: &Path) -> Result<Triangulation> {
    let mesh = mesh_input::read(session, path, Requested::default())?;
    mesh.file.losses.iter().for_each(|loss| session.display().note(loss));
    session.stage("check");
    let Cells::Tetrahedra(complex) = &mesh.cells else {
        let message = "this is a surface, a hyperbolic metric needs a solid: give a mesh of tetrahedra";
        return Err(Failure::input("wrong-dimension", message));
    };
    let report = analyse_tetrahedra(&mesh.file.positions, complex, Options::default());
    session.check()?;
    unless_bounded_well(session, &report)?;
    session.stage("simplify");
    let simplified = triangulation_of_mesh(session, complex)?;
    session.stage("compare");
    unless_same(session, complex, &report, &simplified)?;
    Ok(simplified)
}

/// A triangulation with few tetrahedra of the inside of a mesh; its vertices are the boundary components.
///
/// # Errors
/// When no way is found, or the limits are reached.
fn triangulation_of_mesh(session: &Session, complex: &TetrahedronComplex) -> Result<Triangulation> {
    let stuck =
        |error: SimplifyError| Failure::limits("not-simplified", format!("the mesh cannot be simplified: {error}"));
    let closed = coned(&of_complex(complex)?).map_err(stuck)?;
    session.check()?;
    let few = without_inner_vertices(&closed).map_err(stuck)?;
    let mut simplifier = Simplifier::new(&few, session.common.seed).map_err(stuck)?;
    let mut idle = 0;
    while idle < PATIENCE {
        session.check()?;
        idle = if simplifier.run(ROUNDS) { 0 } else { idle + 1 };
    }
    Ok(simplifier.best().clone())
}

fn of_complex(complex: &TetrahedronComplex) -> Result<Triangulation> {
    Triangulation::from_complex(complex).map_err(|error| Failure::input("unfit-input", error.to_string()))
}

/// Refuses what is no compact manifold with boundary components of genus 2 and more.
fn unless_bounded_well(session: &Session, report: &VolumeReport) -> Result<()> {
    let need = Need {
        name: "solid with boundary of genus 2 or more",
        code: "no-metric",
        heading: "the mesh has no hyperbolic metric with geodesic boundary:".to_owned(),
        // Where the points are does not matter here.
        harmless: &[
            "positions-do-not-match",
            "coordinate-out-of-range",
            "degenerate-cell",
            "inverted-cell",
            "inconsistent-orientation",
            "self-intersection",
        ],
        grave: &[],
    };
    unless_fit(session, &report.violations, topological_fault(report), &need)
}

/// What the boundary, the pieces or the orientation say against a metric.
fn topological_fault(report: &VolumeReport) -> Option<String> {
    if report.components != 1 {
        return Some(format!("it has {} pieces: give one at a time", report.components));
    }
    if !report.manifold {
        return Some("it is no manifold: `homeo info` lists where".to_owned());
    }
    if !report.orientable {
        return Some("it cannot be oriented: give its orientation cover".to_owned());
    }
    if report.boundary.faces == 0 {
        return Some(
            "it is closed, so that there is no boundary to be geodesic: structures of closed manifolds are not supported; \
             drill out a graph"
                .to_owned(),
        );
    }
    let small = report.boundary.genera.iter().find(|genus| **genus < 2)?;
    let (name, remedy) = match small {
        0 => ("a sphere", "fill it by a ball"),
        _ => (
            "a torus",
            "a torus can only be a cusp, which is not in this version; fill it by a solid torus, or drill more",
        ),
    };
    Some(format!(
        "a component of its boundary is {name}, which cannot be totally geodesic: by Gauss and Bonnet its Euler characteristic \
         would be negative; {remedy}"
    ))
}

/// First homology and the genera of the boundary stay what they were.
fn unless_same(
    session: &Session,
    complex: &TetrahedronComplex,
    report: &VolumeReport,
    after: &Triangulation,
) -> Result<()> {
    let [before, now] = [Homology::new(&of_complex(complex)?), Homology::new(after)];
    session.check()?;
    let mut wanted: Vec<usize> =
        report.boundary.genera.iter().filter_map(|genus| usize::try_from(*genus).ok()).collect();
    wanted.sort_unstable();
    let found = genera(after);
    // The report lists the first hundred genera only.
    let are_listed = wanted.len() == report.boundary.components;
    if before == now && (found == wanted || !are_listed) {
        return Ok(());
    }
    Err(Failure::bug(format!(
        "simplifying changed the manifold: homology {before}, boundary genera {wanted:?} became {now}, {found:?}"
    )))
}
