//! `homeo pl`: the map of a shell as two meshes with one connectivity.

use std::io::Write;
use std::path::Path;

use homeo::certificate::StoredMap;
use homeo::map::Shell;
use homeo::overlay::{ExactVertex, Refinement, refinement};
use homeo::progress::Progress;
use homeo_core::io::{Attribute, Element, Format, MeshFile, Values};
use homeo_core::number::Rational;
use homeo_verify::Claim;
use serde_json::json;

use super::staged;
use crate::answer::Answer;
use crate::args::PlArgs;
use crate::failure::{Failure, Result};
use crate::outputs::{Outputs, check_targets};
use crate::proof;
use crate::session::Session;
use crate::text::{Lines, stages};

/// What the columns of the exact file hold.
const HEADER: &str = "source_triangle,source_a,source_b,source_c,section_triangle,section_a,section_b,section_c";

/// Writes the common refinement of source and section.
pub fn run(session: &Session, options: &PlArgs, outputs: &mut Outputs) -> Result<Answer> {
    let formats = check_outputs(options)?;
    let (map, claim) = proof::open_certified(session, &options.map)?;
    let StoredMap::Shell(shell) = map else {
        let message = format!(
            "{} is no shell: the piecewise-linear form of other maps is not supported yet; `homeo eval` gives images of points, exactly with --exact",
            options.map.display()
        );
        return Err(Failure::input("wrong-kind", message));
    };
    session.stage("refine");
    let refined = refinement(&shell, session).ok_or_else(|| session.stopped())?;
    let over = refined.rounded_over(&shell);
    session.check()?;
    session.stage("write");
    for ((path, positions), format) in names(options).into_iter().zip([&refined.source, &refined.section]).zip(formats)
    {
        let losses = staged(session, path, format, &mesh(&refined, positions), outputs)?;
        session.fact(if path == options.output { "losses" } else { "image_losses" }, losses);
    }
    if let Some(path) = &options.exact {
        session.stage("exact");
        stage_exact(session, path, &shell, &refined, outputs)?;
    }
    session.end_stage();
    Ok(answer(session, options, &claim, &shell, &refined, over))
}

fn names(options: &PlArgs) -> [&Path; 2] {
    [&options.output, &options.image]
}

fn check_outputs(options: &PlArgs) -> Result<[Format; 2]> {
    let paths: Vec<&Path> = names(options).into_iter().chain(options.exact.as_deref()).collect();
    check_targets(&paths, &[&options.map])?;
    let [source, image] = names(options).map(format_of);
    Ok([source?, image?])
}

/// STL has no vertices, so no connectivity that two files could share.
fn format_of(path: &Path) -> Result<Format> {
    match Format::of_path(path) {
        Some(format @ (Format::Obj | Format::Ply | Format::Off | Format::Vtu | Format::Vtk)) => Ok(format),
        _ => {
            let message = format!("{}: give a name that ends in .ply, .vtu, .vtk, .obj or .off", path.display());
            Err(Failure::usage(message))
        }
    }
}

/// The refinement in one of its places, with the triangles that its triangles lie in.
fn mesh(refined: &Refinement, positions: &[[f64; 3]]) -> MeshFile {
    let parents = |name: &str, k: usize| Attribute {
        name: name.to_owned(),
        element: Element::Polygon,
        components: 1,
        values: Values::I64(refined.parents.iter().map(|parents| parents[k].into()).collect()),
    };
    let attributes = vec![parents("source_triangle", 0), parents("section_triangle", 1)];
    MeshFile { attributes, ..MeshFile::from_triangles(positions.to_vec(), &refined.triangles) }
}

/// Writes all vertices in rationals.
fn stage_exact(
    session: &Session,
    path: &Path,
    shell: &Shell,
    refined: &Refinement,
    outputs: &mut Outputs,
) -> Result<()> {
    outputs.stage(session, path, |out| {
        let mut written = writeln!(out, "{HEADER}");
        refined.for_each_exact(shell, session, |vertex| {
            if written.is_ok() {
                written = writeln!(out, "{}", row(&vertex));
            }
        });
        written.map_err(|e| e.to_string())
    })?;
    session.check()
}

fn row(vertex: &ExactVertex) -> String {
    let at = |triangle: u32, [a, b, c]: &[Rational; 3]| format!("{triangle},{a},{b},{c}");
    let (source, section) = (&vertex.on_source, &vertex.on_section);
    at(source.triangle, &source.weights) + "," + &at(section.triangle, &section.weights)
}

fn answer(
    session: &Session,
    options: &PlArgs,
    claim: &Claim,
    shell: &Shell,
    refined: &Refinement,
    over: [usize; 2],
) -> Answer {
    let [on_source, on_image] = over;
    if over != [0, 0] {
        session.display().note(&format!(
            "rounding to doubles makes some triangles flat or turns them over: {on_source} in {}, {on_image} in {}; the map itself is exact, see --exact",
            options.output.display(),
            options.image.display()
        ));
    }
    let mut lines = Lines::default();
    lines.add("certificate", proof::holds(claim));
    lines.add("vertices", refined.source.len());
    lines.add("triangles", refined.triangles.len());
    lines.add("rounded over", format!("{on_source} on the source, {on_image} on the image"));
    lines.add("time", stages(&session.seconds()));
    let written = names(options).into_iter().chain(options.exact.as_deref());
    written.for_each(|path| lines.add("written", path.display()));
    let shown = |path: &Path| path.display().to_string();
    let fields = json!({
        "target": if shell.section().is_some() { "section" } else { "middle" },
        "certificate": proof::claim_json(claim),
        "quality": {
            "vertices": refined.source.len(), "triangles": refined.triangles.len(),
            "rounded_over": {"source": on_source, "image": on_image},
        },
        "output": shown(&options.output),
        "image": shown(&options.image),
        "exact": options.exact.as_deref().map(shown),
    });
    Answer::new(fields, lines.below(&format!("{} as two meshes with one connectivity", options.map.display())))
}
