//! Refusing a mesh: all that is wrong, with the first offending elements and what to do.

use homeo_core::topology::{Severity, Violation};
use serde_json::json;

use crate::failure::{Failure, Result};
use crate::mesh_input::MeshInput;
use crate::session::Session;

/// No reason to refuse, but often the cause of one.
const HINTS: [&str; 1] = ["coincident-vertices"];

/// What a construction asks of a mesh.
pub struct Need<'n> {
    /// For programs: what the mesh should be.
    pub name: &'n str,
    /// The code of the failure where no violation gives one.
    pub code: &'static str,
    /// What the mesh is not.
    pub heading: String,
    /// Codes of errors that are said, but no reason to refuse.
    pub harmless: &'n [&'n str],
    /// Codes of warnings that are a reason.
    pub grave: &'n [&'n str],
}

/// Refuses a mesh without coordinates, and one with larger polygons that were not to be cut.
///
/// # Errors
/// What is wrong with it.
pub fn unless_simplices(mesh: &MeshInput, triangulate: bool) -> Result<()> {
    if mesh.file.space == 0 {
        let message =
            "the file holds no coordinates; a map needs a mesh with coordinates (`homeo info` takes such files)";
        return Err(Failure::input("no-coordinates", message));
    }
    if mesh.polygon_count > 0 && !triangulate {
        return Err(
            Failure::input("polygon-not-triangle", polygons_message(mesh)).with("elements", mesh.polygons.clone())
        );
    }
    Ok(())
}

/// Refuses a mesh with violations that matter or another shape; says the others.
///
/// # Errors
/// All that is wrong with it.
pub fn unless_fit(session: &Session, violations: &[Violation], shape: Option<String>, need: &Need) -> Result<()> {
    let matters = |v: &&Violation| match v.severity {
        Severity::Error => !need.harmless.contains(&v.code),
        _ => need.grave.contains(&v.code),
    };
    let faults: Vec<&Violation> = violations.iter().filter(matters).collect();
    let is_fit = faults.is_empty() && shape.is_none();
    let is_hint = |v: &&Violation| !is_fit && !matters(v) && HINTS.contains(&v.code);
    for violation in violations.iter().filter(|v| !matters(v) && !is_hint(v) && v.severity != Severity::Info) {
        session.display().note(&sentence(violation));
    }
    if is_fit {
        return Ok(());
    }
    let mut message = need.heading.clone();
    let hints = violations.iter().filter(is_hint).map(sentence);
    let said = faults.iter().copied().map(sentence).chain(shape.iter().cloned()).chain(hints);
    said.for_each(|line| message.push_str(&format!("\n  {line}")));
    let code = faults.first().map_or(need.code, |v| v.code);
    Err(Failure::input(code, message).with("violations", json!(violations)).with("needed", need.name))
}

fn sentence(violation: &Violation) -> String {
    format!("{}: {}", violation.code, violation.message)
}

/// The sentence on polygons that are no triangles.
pub fn polygons_message(mesh: &MeshInput) -> String {
    let first: Vec<String> = mesh.polygons.iter().take(3).map(u32::to_string).collect();
    let more = if mesh.polygon_count > first.len() { ", ..." } else { "" };
    format!(
        "{} polygons ({}{more}) have other than three corners; give --triangulate to cut them",
        mesh.polygon_count,
        first.join(", ")
    )
}
