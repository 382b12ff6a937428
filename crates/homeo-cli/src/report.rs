//! `homeo report`, and `--report` of other verbs: one HTML page.

use std::path::Path;

use homeo::certificate::{FoliationMap, StoredMap};
use homeo::export::{VerdictWords, report_of_map, write_report};
use homeo::map::{Bijection, Target};
use homeo::progress::Progress;
use homeo_core::mesh::SimplicialComplex;
use homeo_verify::Claim;
use serde_json::json;

use crate::answer::Answer;
use crate::args::ReportArgs;
use crate::failure::{Failure, Result};
use crate::outputs::{Outputs, check_target};
use crate::proof;
use crate::sampled::{self, Sampled};
use crate::session::Session;
use crate::text::{Lines, ratio, stages};

/// Writes the page of a map file.
pub fn run(session: &Session, options: &ReportArgs, outputs: &mut Outputs) -> Result<Answer> {
    check_target(&options.output, &[&options.map])?;
    let (map, claim) = proof::open_certified(session, &options.map)?;
    let StoredMap::Foliation(map) = map else {
        let message = "pages for shells are not made yet; write the layers of the shell with \
                       `homeo shell MESH --layers PREFIX` and open them in a mesh viewer";
        return Err(Failure::input("no-page", message));
    };
    session.stage("sample");
    let sampled = sampled::sample(&map);
    session.check()?;
    session.stage("write");
    let title = title(&options.map, map.target());
    stage(session, &options.output, &title, &map, &claim, &sampled, outputs)?;
    session.end_stage();
    let mut lines = Lines::default();
    lines.add("written", options.output.display());
    lines.add("time", stages(&session.seconds()));
    let fields = json!({
        "certificate": proof::claim_json(&claim),
        "quality": {"sampled": sampled.quality()},
        "output": options.output.display().to_string(),
    });
    Ok(Answer::new(fields, lines.below(&format!("{title}: certified"))))
}

/// The heading of a page.
pub fn title(input: &Path, target: Target) -> String {
    let name = input.file_name().map_or_else(|| input.display().to_string(), |n| n.to_string_lossy().into_owned());
    format!("{name} onto the {target}")
}

/// Stages a page.
///
/// # Errors
/// When it cannot be written.
pub fn stage(
    session: &Session,
    path: &Path,
    title: &str,
    map: &FoliationMap,
    claim: &Claim,
    sampled: &Sampled,
    outputs: &mut Outputs,
) -> Result<()> {
    let subtitle = format!("simplicial foliation, homeo {}", env!("CARGO_PKG_VERSION"));
    let mut data = report_of_map(map, title, &subtitle, verdict(claim));
    data.facts = facts(map, sampled);
    data.stage_seconds = session.seconds().into_iter().map(|(name, s)| (name.to_owned(), s)).collect();
    outputs.stage(session, path, |out| write_report(&data, out).map_err(|e| e.to_string()))?;
    session.check()
}

fn verdict(claim: &Claim) -> VerdictWords {
    VerdictWords {
        holds: true,
        headline: format!("One-to-one and onto the {}, proved", claim.target),
        sentences: vec![claim.statement.clone()],
        checked: claim.checked.iter().map(|&(what, count)| (what.to_owned(), count)).collect(),
        limits: claim.limits.clone(),
    }
}

fn facts(map: &FoliationMap, sampled: &Sampled) -> Vec<(String, String)> {
    let (vertices, cells, refined, what) = match map {
        FoliationMap::Surface(map) => counts(map.source().complex(), map.parts().mesh.complex(), "triangles"),
        FoliationMap::Volume(map) => counts(map.source().complex(), map.parts().mesh.complex(), "tetrahedra"),
    };
    let fact = |label: &str, value: String| (label.to_owned(), value);
    vec![
        fact("vertices", vertices.to_string()),
        fact(what, cells.to_string()),
        fact("cells of the foliated mesh", refined.to_string()),
        fact("stretch, median (sampled)", ratio(sampled.quantile(0.5))),
        fact("stretch, largest (sampled)", ratio(sampled.quantile(1.0))),
        fact("error of floating-point images", format!("at most {:.1e}", sampled.max_radius)),
    ]
}

fn counts<const K: usize>(
    source: &SimplicialComplex<K>,
    refined: &SimplicialComplex<K>,
    what: &'static str,
) -> (usize, usize, usize, &'static str) {
    (source.vertex_count(), source.cell_count(), refined.cell_count(), what)
}
