//! The answer of `homeo hyperbolic`, as JSON and in words.

use homeo_manifold::hyperbolic::Enclosure;
use homeo_manifold::{Homology, Skeleton, Triangulation, signature};
use homeo_verify::Claim;
use serde_json::{Value, json};

use super::input::Input;
use super::search::{Found, genera};
use crate::args::HyperbolicArgs;
use crate::proof;
use crate::session::Session;
use crate::text::{Lines, counted, stages};

/// The fields of the JSON object.
pub fn fields(options: &HyperbolicArgs, found: &Found, claim: &Claim) -> Value {
    let middles = |angles: &[Enclosure; 6]| angles.map(Enclosure::middle);
    let structure = &found.structure;
    let path = |path: &Option<std::path::PathBuf>| path.as_ref().map(|path| path.display().to_string());
    json!({
        "triangulation": triangulation(&found.triangulation, &found.skeleton),
        "tried": found.tried,
        "canonical": canonical(found),
        "metric": {
            "edge_lengths": structure.lengths().iter().copied().map(bounds).collect::<Vec<_>>(),
            "dihedral_angles": structure.angles().iter().map(middles).collect::<Vec<_>>(),
            "volume": bounds(structure.volume()),
        },
        "certificate": proof::claim_json(claim),
        "output": path(&options.output),
        "report": path(&options.report),
        "picture": path(&options.picture),
    })
}

fn triangulation(triangulation: &Triangulation, skeleton: &Skeleton) -> Value {
    json!({
        "tetrahedra": triangulation.len(),
        "signature": signature(triangulation),
        "h1": Homology::new(triangulation).to_string(),
        "boundary_genera": genera(triangulation),
        "edge_degrees": degrees(skeleton),
    })
}

fn canonical(found: &Found) -> Value {
    match &found.canonical {
        Ok(canonical) => json!({
            "found": true,
            "signature": signature(&canonical.triangulation),
            "tetrahedra": canonical.triangulation.len(),
            "tried": canonical.tried,
        }),
        Err(reason) => json!({"found": false, "reason": reason.to_string()}),
    }
}

fn canonical_in_words(found: &Found) -> String {
    let canonical = match &found.canonical {
        Ok(canonical) => &canonical.triangulation,
        Err(reason) => return reason.to_string(),
    };
    let name = signature(canonical);
    if name == signature(&found.triangulation) {
        return "yes: the signature is the name of the manifold".to_owned();
    }
    format!("{name} ({} tetrahedra) is the name of the manifold; --canonical takes it", canonical.len())
}

fn degrees(skeleton: &Skeleton) -> Vec<usize> {
    skeleton.edges().iter().map(|edge| edge.corners.len()).collect()
}

fn bounds(enclosure: Enclosure) -> Value {
    json!({"low": enclosure.low(), "high": enclosure.high(), "value": enclosure.middle()})
}

/// A short table.
pub fn text(session: &Session, options: &HyperbolicArgs, input: &Input, found: &Found, claim: &Claim) -> String {
    let (structure, triangulation) = (&found.structure, &found.triangulation);
    let mut lines = Lines::default();
    lines.add("tetrahedra", format!("{}, signature {}", triangulation.len(), signature(triangulation)));
    if found.tried > 0 {
        lines.add("retriangulated", format!("{} before this one", counted(found.tried - 1, "other", "others")));
    }
    lines.add("homology", Homology::new(triangulation));
    lines.add("boundary", format!("genus {}", list(genera(triangulation).iter())));
    for (degree, length) in degrees(&found.skeleton).into_iter().zip(structure.lengths()).take(MOST_LINES) {
        lines.add("edge", format!("length {}, degree {degree}", digits(*length)));
    }
    if structure.lengths().len() > MOST_LINES {
        lines.add("", format!("and {} more (--json has all)", structure.lengths().len() - MOST_LINES));
    }
    let angles = || structure.angles().iter().flatten().map(|angle| angle.middle().to_degrees());
    let (least, largest) = (angles().fold(f64::INFINITY, f64::min), angles().fold(0.0, f64::max));
    lines.add("dihedral angles", format!("{least:.3} to {largest:.3} degrees"));
    lines.add("volume", digits(structure.volume()));
    lines.add("canonical", canonical_in_words(found));
    lines.add("certificate", proof::holds(claim));
    lines.add("time", stages(&session.seconds()));
    for path in [&options.output, &options.report, &options.picture].into_iter().flatten() {
        lines.add("written", path.display());
    }
    lines.below(&format!("{}: hyperbolic with geodesic boundary", input.name))
}

/// Edges that people see.
const MOST_LINES: usize = 12;

/// As many digits as are proved, at most thirteen decimals.
fn digits(enclosure: Enclosure) -> String {
    let decimals = (0..=13)
        .rev()
        .find(|&decimals| format!("{:.decimals$}", enclosure.low()) == format!("{:.decimals$}", enclosure.high()));
    match decimals {
        Some(decimals) => format!("{:.decimals$}", enclosure.middle()),
        None => format!("{} to {}", enclosure.low(), enclosure.high()),
    }
}

fn list<'a>(numbers: impl Iterator<Item = &'a usize>) -> String {
    numbers.map(usize::to_string).collect::<Vec<_>>().join(", ")
}
