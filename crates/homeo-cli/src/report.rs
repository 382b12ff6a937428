//! `homeo report`, and `--report` of other verbs: one HTML page.

use std::collections::BTreeSet;
use std::path::Path;

use homeo::certificate::{FoliationMap, PlanarMap, StoredMap, kind_of, read_hyperbolic};
use homeo::export::{ReportData, VerdictWords, planar_page, report_of_map, report_of_shell, write_report};
use homeo::map::{PlanarBijection, Shell};
use homeo::progress::Progress;
use homeo_core::mesh::SimplicialComplex;
use homeo_core::spatial::Aabb;
use homeo_verify::Claim;
use serde_json::json;

use crate::answer::Answer;
use crate::args::ReportArgs;
use crate::failure::{Failure, Result};
use crate::hyperbolic::picture;
use crate::outputs::{Outputs, check_target};
use crate::proof;
use crate::sampled::{self, Sampled};
use crate::session::Session;
use crate::text::{self, Lines, ratio, stages};

/// Writes the page of a map file.
pub fn run(session: &Session, options: &ReportArgs, outputs: &mut Outputs) -> Result<Answer> {
    check_target(&options.output, &[&options.map])?;
    let bytes = proof::read_bytes(session, &options.map)?;
    if kind_of(&bytes).as_deref() == Some("hyperbolic") {
        return structure(session, options, &bytes, outputs);
    }
    let (map, claim) = proof::open_certified(session, &options.map)?;
    let (title, quality) = match map {
        StoredMap::Foliation(map) => {
            session.stage("sample");
            let sampled = sampled::sample(&map);
            session.check()?;
            session.stage("write");
            let title = title(&options.map, map.target().name());
            stage(session, &options.output, &title, &map, &claim, &sampled, outputs)?;
            (title, json!({"sampled": sampled.quality()}))
        }
        StoredMap::Shell(shell) => {
            session.stage("write");
            let title = title(&options.map, words_for_image(&shell));
            stage_shell(session, &options.output, &title, &shell, &claim, outputs)?;
            (title, json!({"prisms": shell.parts().prisms.len()}))
        }
        StoredMap::Planar(map) => {
            session.stage("write");
            let title = title(&options.map, "target polygon");
            stage_planar(session, &options.output, &title, map.as_bijection(), &claim, outputs)?;
            let size = match map {
                PlanarMap::Harmonic(map) => json!({"triangles": map.source_half().parts().triangles.len()}),
                PlanarMap::Composite(map) => json!({"steps": map.step_count()}),
                PlanarMap::Complex(map) => json!({"degree": map.speeds().degree()}),
            };
            (title, size)
        }
        StoredMap::Cages(_) => {
            let message = format!(
                "{} is a map between cages, which has no page: `homeo eval` moves points by it, `homeo verify` says what is proved",
                options.map.display()
            );
            return Err(Failure::input("wrong-kind", message));
        }
        StoredMap::Moved(_) => {
            let message = format!(
                "{} is a mesh that has moved: the mesh before and what `homeo warp -o` writes are ordinary meshes, which any viewer \
                 shows; `homeo verify` says what is proved",
                options.map.display()
            );
            return Err(Failure::input("wrong-kind", message));
        }
    };
    session.end_stage();
    let mut lines = Lines::default();
    lines.add("written", options.output.display());
    lines.add("time", stages(&session.seconds()));
    let fields = json!({
        "certificate": proof::claim_json(&claim),
        "quality": quality,
        "output": options.output.display().to_string(),
    });
    Ok(Answer::new(fields, lines.below(&format!("{title}: certified"))))
}

/// Writes the page of a hyperbolic structure.
fn structure(session: &Session, options: &ReportArgs, bytes: &[u8], outputs: &mut Outputs) -> Result<Answer> {
    let claim = proof::certified(session, &options.map, bytes)?;
    session.stage("prepare");
    let unreadable = |e| Failure::input("unreadable-map", format!("{}: {e}", options.map.display()));
    let stored = read_hyperbolic(bytes).map_err(unreadable)?;
    session.check()?;
    let title = if stored.name.is_empty() { text::file_name(&options.map) } else { stored.name };
    picture::stage_page(session, &options.output, &title, (&stored.triangulation, &stored.structure), &claim, outputs)?;
    session.end_stage();
    let mut lines = Lines::default();
    lines.add("written", options.output.display());
    lines.add("time", stages(&session.seconds()));
    let volume = stored.structure.volume();
    let fields = json!({
        "certificate": proof::claim_json(&claim),
        "quality": {"volume": {"low": volume.low(), "high": volume.high(), "value": volume.middle()}},
        "output": options.output.display().to_string(),
    });
    Ok(Answer::new(fields, lines.below(&format!("{title}: certified"))))
}

/// The heading of a page.
pub fn title(input: &Path, target: &str) -> String {
    let name = input.file_name().map_or_else(|| input.display().to_string(), |n| n.to_string_lossy().into_owned());
    format!("{name} onto the {target}")
}

/// What the source is mapped onto.
fn words_for_image(shell: &Shell) -> &'static str {
    if shell.section().is_some() { "section in its shell" } else { "middle surface of its shell" }
}

/// Stages the page of a map between planar domains.
///
/// # Errors
/// When it cannot be written.
pub fn stage_planar(
    session: &Session,
    path: &Path,
    title: &str,
    map: &dyn PlanarBijection,
    claim: &Claim,
    outputs: &mut Outputs,
) -> Result<()> {
    let page = planar_page(map, title, &claim.statement);
    outputs.stage(session, path, |out| std::io::Write::write_all(out, page.as_bytes()).map_err(|e| e.to_string()))?;
    Ok(())
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
    let mut data = report_of_map(map, title, &subtitle, verdict(claim, &claim.target));
    data.facts = facts(map, sampled);
    write(session, path, data, outputs)
}

/// Stages the page of a shell.
///
/// # Errors
/// When it cannot be written.
pub fn stage_shell(
    session: &Session,
    path: &Path,
    title: &str,
    shell: &Shell,
    claim: &Claim,
    outputs: &mut Outputs,
) -> Result<()> {
    let subtitle = format!("prismatic shell, homeo {}", env!("CARGO_PKG_VERSION"));
    let mut data = report_of_shell(
        shell,
        title,
        &subtitle,
        verdict(claim, if shell.section().is_some() { "section" } else { "middle surface" }),
    );
    data.facts = shell_facts(shell, claim);
    write(session, path, data, outputs)
}

fn write(session: &Session, path: &Path, mut data: ReportData, outputs: &mut Outputs) -> Result<()> {
    data.stage_seconds = session.seconds().into_iter().map(|(name, s)| (name.to_owned(), s)).collect();
    outputs.stage(session, path, |out| write_report(&data, out).map_err(|e| e.to_string()))?;
    session.check()
}

fn verdict(claim: &Claim, target: &str) -> VerdictWords {
    VerdictWords {
        holds: true,
        headline: format!("One-to-one and onto the {target}, proved"),
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

fn shell_facts(shell: &Shell, claim: &Claim) -> Vec<(String, String)> {
    let (source, parts) = (shell.source(), shell.parts());
    let columns: BTreeSet<u32> = parts.prisms.iter().flatten().copied().collect();
    let lengths = |ends: &[[f64; 3]]| {
        let length = |&v: &u32| {
            let (end, middle) = (ends[v as usize], parts.middle[v as usize]);
            (0..3).map(|axis| (end[axis] - middle[axis]).powi(2)).sum::<f64>().sqrt()
        };
        columns.iter().map(length).fold(0.0, f64::max)
    };
    let (below, above) = (lengths(&parts.bottom), lengths(&parts.top));
    let hull = Aabb::of(source.positions());
    let side = (0..3).map(|axis| hull.high[axis] - hull.low[axis]).fold(f64::MIN_POSITIVE, f64::max);
    let is_pinched = |v: &&u32| {
        let v = **v as usize;
        parts.bottom[v] == parts.middle[v] && parts.middle[v] == parts.top[v]
    };
    let checked = |what: &str| claim.checked.iter().find(|(name, _)| name.starts_with(what)).map(|(_, count)| *count);
    let fact = |label: &str, value: String| (label.to_owned(), value);
    let mut facts = vec![
        fact("vertices", source.complex().vertex_count().to_string()),
        fact("triangles", source.complex().cell_count().to_string()),
        fact(
            "triangles of the section",
            shell.section().map_or_else(|| "none".to_owned(), |section| section.complex().cell_count().to_string()),
        ),
        fact("prisms", parts.prisms.len().to_string()),
        fact("columns", columns.len().to_string()),
        fact("columns pinched to a point", columns.iter().filter(is_pinched).count().to_string()),
        fact("largest thickness", format!("{} of the longest side", ratio(below.max(above) / side))),
    ];
    let counts = [("components", "components of the source"), ("boundary edges", "boundary edges")];
    facts.extend(counts.iter().filter_map(|(label, what)| Some(fact(label, checked(what)?.to_string()))));
    facts
}

fn counts<const K: usize>(
    source: &SimplicialComplex<K>,
    refined: &SimplicialComplex<K>,
    what: &'static str,
) -> (usize, usize, usize, &'static str) {
    (source.vertex_count(), source.cell_count(), refined.cell_count(), what)
}
