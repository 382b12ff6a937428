//! `homeo verify`: what is proved about a map, in words.

use std::path::Path;

use homeo::certificate::read_map;
use homeo::progress::Progress;
use homeo_verify::{Claim, SourceMatch, Verdict, compare_polygon, compare_source, verify_bytes};
use serde_json::{Value, json};

use crate::answer::Answer;
use crate::args::VerifyArgs;
use crate::failure::{Exit, Failure, Result};
use crate::mesh_input::{self, Requested};
use crate::proof;
use crate::session::Session;
use crate::warp::polygons;

/// Checks a map file, and whether it is about a given mesh.
pub fn run(session: &Session, options: &VerifyArgs) -> Result<Answer> {
    let bytes = proof::read_bytes(session, &options.map)?;
    session.check()?;
    session.stage("certificate");
    let verdict = verify_bytes(&bytes).map_err(|error| proof::unreadable(&options.map, &error))?;
    let claim = match verdict {
        Verdict::Certified(claim) => claim,
        Verdict::Refuted(witness) => {
            let what = format!("refuted: {} is not the map it claims to be", options.map.display());
            return Err(proof::refuted(Exit::Refuted, &what, &witness));
        }
        Verdict::Undecided(obstacle) => return Err(proof::undecided(&obstacle)),
    };
    session.check()?;
    let mut source = None;
    if let Some(mesh) = &options.source {
        if claim.kind == "hyperbolic" {
            return Err(Failure::input("other-source", NO_MESH));
        }
        let requested = Requested { weld: options.weld, triangulate: options.triangulate, orient: options.orient };
        if is_abstract(&claim) {
            let message =
                format!("a certificate of kind {} is about what is in the file; leave --source away", claim.kind);
            return Err(Failure::usage(message));
        }
        source = Some(match is_planar(&claim) {
            true => compare_domain(&bytes, mesh)?,
            false => compare(session, &bytes, mesh, requested)?,
        });
    }
    session.fact("input", described(&claim, &bytes, &options.map));
    let fields = json!({
        "certificate": proof::claim_json(&claim),
        "source": source,
    });
    Ok(Answer::new(fields, words(&claim, options)))
}

const NO_MESH: &str = "the certificate holds, but it is one of a hyperbolic structure on glued tetrahedra, which has no mesh as \
                       its source: leave out --source";

/// Whether the map is one between planar domains.
fn is_planar(claim: &Claim) -> bool {
    matches!(claim.target.as_str(), "polygon" | "annulus" | "domain")
}

/// Whether it is about complexes without places, which no mesh can be compared with.
fn is_abstract(claim: &Claim) -> bool {
    matches!(claim.kind.as_str(), "hyperbolic" | "unit-tangent-bundle")
}

/// Says what the mesh is, as the field `source` has it; a mesh that the map is not about is a failure.
fn compare(session: &Session, bytes: &[u8], path: &Path, requested: Requested) -> Result<Value> {
    let mesh = mesh_input::read(session, path, requested)?;
    mesh.changes.iter().for_each(|change| session.display().note(change));
    let source = |same: bool| {
        let mut source = mesh.described(path);
        source["same"] = json!(same);
        source
    };
    let (cells, size) = mesh.flat_cells();
    match compare_source(bytes, &mesh.file.positions, &cells, size) {
        Ok(SourceMatch::Same) => Ok(source(true)),
        Ok(SourceMatch::Different(what)) => Err(Failure::input(
            "other-source",
            format!("the certificate holds, but the map is not about {}: {what}", path.display()),
        )
        .with("source", source(false))),
        Err(error) => Err(Failure::bug(format!("a map that was certified became unreadable: {error}"))),
    }
}

/// The same for a map between planar domains and a polygon, or a pair whose source it is.
fn compare_domain(bytes: &[u8], path: &Path) -> Result<Value> {
    let domain = polygons::source(path)?;
    let described = |same: bool| {
        let mut described = proof::domain_json(&domain, path);
        described["same"] = json!(same);
        described
    };
    match compare_polygon(bytes, domain.rings()) {
        Ok(SourceMatch::Same) => Ok(described(true)),
        Ok(SourceMatch::Different(what)) => Err(Failure::input(
            "other-source",
            format!("the certificate holds, but the map is not about {}: {what}", path.display()),
        )
        .with("source", described(false))),
        Err(error) => Err(Failure::bug(format!("a map that was certified became unreadable: {error}"))),
    }
}

/// The counts of the source are among what was checked, but for shells and planar domains.
fn described(claim: &Claim, bytes: &[u8], path: &Path) -> Value {
    if let (true, Ok(map)) = (claim.kind == "shell" || is_planar(claim), read_map(bytes)) {
        return proof::map_json(&map, path);
    }
    let count = |what: &str| claim.checked.iter().find(|(name, _)| name.starts_with(what)).map(|&(_, n)| n);
    if matches!(claim.kind.as_str(), "moved-mesh" | "composite-cage") {
        let cells = if count("source triangles").is_some() { "triangles" } else { "tetrahedra" };
        let vertices = count("source vertices");
        return json!({"path": path.display().to_string(), "vertices": vertices, cells: count(&format!("source {cells}"))});
    }
    if claim.kind == "unit-tangent-bundle" {
        let (vertices, triangles) = (count("base vertices"), count("base triangles"));
        return json!({"path": path.display().to_string(), "vertices": vertices, "triangles": triangles});
    }
    if claim.kind == "hyperbolic" {
        return json!({"path": path.display().to_string(), "tetrahedra": count("tetrahedra")});
    }
    let cells = if matches!(claim.target.as_str(), "square" | "disk") { "triangles" } else { "tetrahedra" };
    json!({"path": path.display().to_string(), "vertices": count("source vertices"), cells: count("source cells")})
}

fn words(claim: &Claim, options: &VerifyArgs) -> String {
    let mut text = format!("certified: {}\n\nchecked\n", claim.statement);
    for (what, count) in claim.checked.iter().filter(|(_, count)| *count > 0) {
        text.push_str(&format!("  {count:>10}  {what}\n"));
    }
    text.push_str(&format!("\nsource  sha256 {}\n", claim.source_sha256));
    if let Some(path) = &options.source {
        let changed =
            [(options.weld, " --weld"), (options.triangulate, " --triangulate"), (options.orient, " --orient")];
        let asked: String = changed.iter().filter(|(is_asked, _)| *is_asked).map(|(_, option)| *option).collect();
        let after = if asked.is_empty() { asked } else { format!(", after{asked}") };
        let what = if is_planar(claim) { "polygon" } else { "mesh" };
        text.push_str(&format!("        bit for bit the {what} of {}{after}\n", path.display()));
    }
    text.push_str("\nlimits\n");
    for limit in &claim.limits {
        text.push_str(&format!("  {limit}\n"));
    }
    text
}
