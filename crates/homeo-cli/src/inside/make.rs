//! `homeo simplify` and `homeo remesh`: a surface, its shell, another surface in it, and the certified map between them.

use std::path::Path;

use homeo::certificate::Provenance;
use homeo::construct::section::{
    self, Refusals, RemeshParams, SectionError, SimplifyEnd, SimplifyParams, Texture, TexturedSurface,
};
use homeo::map::Shell;
use homeo::progress::Progress;
use homeo_core::io::{Element, MeshFile};
use homeo_verify::Claim;
use serde_json::{Value, json};

use super::{Targets, attributes, certify, mesh_file, shells, sizing, stage_mesh, texture};
use crate::answer::Answer;
use crate::args::{InsideArgs, RemeshArgs, SimplifyArgs};
use crate::failure::{Failure, Result};
use crate::mesh_input::{self, MeshInput, Requested, source_mesh};
use crate::outputs::Outputs;
use crate::proof;
use crate::session::Session;
use crate::shell;
use crate::text::{Lines, file_name, stages};

/// What a construction made of the surface.
struct Made {
    shell: Shell,
    section: TexturedSurface,
    quality: Value,
    lines: Lines,
}

/// Fewer triangles.
pub fn simplify(session: &Session, options: &SimplifyArgs, outputs: &mut Outputs) -> Result<Answer> {
    let construction = json!({
        "to": options.to.map(|to| to.to_string()), "error": options.error,
        "largest_angle": options.largest_angle, "features": options.common.features,
    });
    run(session, &options.common, construction, outputs, |start, _| {
        let first = start.surface.complex().cell_count();
        let params = SimplifyParams {
            triangles: options.to.map_or(0, |to| to.of(first)),
            largest_error: options.error,
            feature_angle: feature_angle(&options.common),
        };
        let found = shells::search(session, start, options, &params)?;
        let info = &found.info;
        let mut lines = Lines::default();
        let share = 100.0 * info.triangles as f64 / first.max(1) as f64;
        lines.add("triangles", format!("{} of {first} ({share:.1} %)", info.triangles));
        shells::tell(&found, &mut lines);
        // Without a number the error ends it, as it should.
        let reached = options.to.map(|_| info.end == SimplifyEnd::Reached);
        if reached == Some(false) {
            let within = if options.error.is_some() { "shell with this error" } else { "shell" };
            lines.add(
                "ended",
                match info.end {
                    SimplifyEnd::Cancelled => "cut short by the time limit".to_owned(),
                    _ => format!("no edge is left that could be collapsed in this {within}"),
                },
            );
            let Refusals { links, shape, shell, texture } = info.refusals;
            lines.add(
                "refused",
                format!("{shell} by the shell, {texture} by the texture, {shape} by shape, {links} by links"),
            );
        }
        lines.add("error", format!("{:.2e} at most (root of the mean squared distance to planes)", info.largest_error));
        let quality = json!({
            "triangles": info.triangles, "first_triangles": first, "collapses": info.collapses,
            "largest_error": info.largest_error, "reached": reached, "refused": refused(&info.refusals),
            "shells": shells::described(&found), "shell": found.kept,
        });
        Ok(Made { shell: found.shell, section: found.section, quality, lines })
    })
}

/// Triangles of about equal size.
pub fn remesh(session: &Session, options: &RemeshArgs, outputs: &mut Outputs) -> Result<Answer> {
    let construction = json!({
        "edge": options.edge, "sizing": options.sizing, "adaptive": options.adaptive,
        "iterations": options.iterations, "features": options.common.features,
    });
    run(session, &options.common, construction, outputs, |start, file| {
        let usual = shells::usual(&options.common);
        let shell = shell::construct_in_time(session, &start.surface, &usual)?;
        let (edge_length, sizing) = sizing::wanted(options, &start.surface, file)?;
        let feature_angle = feature_angle(&options.common);
        let params = RemeshParams { edge_length, sizing, feature_angle, iterations: options.iterations };
        let (section, info) = section::remesh(&shell, start, &params, &Sections(session)).map_err(explain)?;
        let mean = texture::mean_edge(&section.surface);
        let mut lines = Lines::default();
        lines.add("triangles", format!("{} instead of {}", info.triangles, info.first_triangles));
        let bound = if options.adaptive.is_some() { "at most" } else { "on average" };
        lines.add("edges", format!("{mean:.4} long on average, {edge_length:.4} wanted {bound}"));
        let quality = json!({
            "triangles": info.triangles, "first_triangles": info.first_triangles, "edge_length": edge_length,
            "mean_edge_length": mean, "splits": info.splits, "collapses": info.collapses, "flips": info.flips,
            "moves": info.moves, "iterations": info.iterations, "refused": refused(&info.refusals),
        });
        Ok(Made { shell, section, quality, lines })
    })
}

fn refused(refusals: &Refusals) -> Value {
    let Refusals { links, shape, shell, texture } = refusals;
    json!({"links": links, "shape": shape, "shell": shell, "texture": texture})
}

fn feature_angle(options: &InsideArgs) -> Option<f64> {
    options.features.map(f64::to_radians)
}

/// The session, with the stages of sections told apart from those of the shell.
struct Sections<'s>(&'s Session);

impl Progress for Sections<'_> {
    fn stage(&self, _: &'static str) {
        self.0.stage("section");
    }

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

fn run(
    session: &Session,
    options: &InsideArgs,
    construction: Value,
    outputs: &mut Outputs,
    make: impl FnOnce(&TexturedSurface, &MeshFile) -> Result<Made>,
) -> Result<Answer> {
    let targets = Targets { mesh: &options.output, map: options.map.as_deref() };
    let format = targets.check(&[&options.input])?;
    let mesh = read(session, options)?;
    session.stage("check");
    let advice = "only `homeo shell --immersed` takes surfaces that cross themselves";
    let crossings = shell::Crossings::Refused { advice };
    let source = source_mesh(&mesh.file, shell::unfit(session, &mesh, options.triangulate, crossings)?);
    let carried = texture::of_file(&mesh.file);
    if carried.is_none() && mesh.file.attribute("texture", Element::Corner).is_some() {
        session.display().note(
            "the texture has corners without coordinates, or not two of them each: its seams are not kept, its values are moved",
        );
    }
    let start = TexturedSurface { surface: source, texture: carried.as_ref().map(|(texture, _)| texture.clone()) };
    let made = make(&start, &mesh.file)?;
    session.check()?;
    let shell = made.shell.with_section(made.section.surface.clone());
    let provenance = provenance(options, construction);
    let claim = certify(session, &shell, &provenance, targets.map, outputs)?;
    // The construction itself carried the texture; the others are looked for on the source.
    let mut others = mesh.file.attributes.clone();
    let carried = carried.zip(made.section.texture.as_ref()).map(|((_, like), texture)| {
        let place = mesh.file.attributes.iter().position(|other| std::ptr::eq(other, like)).unwrap_or(0);
        others.remove(place);
        (place, texture::carried(texture, like))
    });
    let mut moved = attributes::moved(session, &shell, &others, &options.density)?;
    if let Some((place, texture)) = carried {
        moved.insert(place.min(moved.len()), texture);
    }
    let textures = (start.texture.as_ref(), made.section.texture.as_ref());
    let described = attributes::described(&moved);
    let mut lines = words(&claim, &shell, made.lines);
    attributes::tell(&moved, &mut lines);
    let file = mesh_file(&made.section.surface, attributes::for_file(moved, options.status), &mesh.file);
    stage_mesh(session, targets.mesh, format, &file, outputs)?;
    session.end_stage();
    let mut quality = made.quality;
    quality["prisms"] = json!(shell.parts().prisms.len());
    quality["texture"] = described_texture(textures);
    Ok(answer(session, options, &claim, quality, described, lines, &targets))
}

fn read(session: &Session, options: &InsideArgs) -> Result<MeshInput> {
    let requested = Requested { weld: options.weld, triangulate: options.triangulate, orient: options.orient };
    let mesh = mesh_input::read(session, &options.input, requested)?;
    for note in mesh.changes.iter().chain(&mesh.file.losses) {
        session.display().note(note);
    }
    Ok(mesh)
}

pub(super) fn explain(error: SectionError) -> Failure {
    match error {
        SectionError::Parameter(_) => Failure::usage(error.to_string()),
        SectionError::Texture(_) => Failure::input("texture", error.to_string()),
        // It begins with the source, which the shell was made for.
        SectionError::NotASurface { .. } | SectionError::Boundary | SectionError::NotASection { .. } => {
            Failure::bug(error.to_string())
        }
    }
}

/// Nothing that depends on the machine, so that a run repeats bit for bit.
fn provenance(options: &InsideArgs, construction: Value) -> Provenance {
    Provenance {
        source_name: file_name(&options.input),
        program: format!("homeo {}", env!("CARGO_PKG_VERSION")),
        options: json!({
            "thickness": shells::usual(options).thickness, "section": construction,
            "weld": options.weld, "triangulate": options.triangulate, "orient": options.orient,
        }),
    }
}

fn described_texture((before, after): (Option<&Texture>, Option<&Texture>)) -> Value {
    match (before, after) {
        (Some(before), Some(after)) => {
            json!({"before": texture::orientations(before), "after": texture::orientations(after)})
        }
        _ => Value::Null,
    }
}

fn words(claim: &Claim, shell: &Shell, made: Lines) -> Lines {
    let mut lines = Lines::default();
    lines.add("certificate", proof::holds(claim));
    lines.add("prisms", shell.parts().prisms.len());
    lines.extend(made);
    lines
}

fn answer(
    session: &Session,
    options: &InsideArgs,
    claim: &Claim,
    quality: Value,
    transferred: Value,
    mut lines: Lines,
    targets: &Targets,
) -> Answer {
    lines.add("time", stages(&session.seconds()));
    targets.paths().for_each(|path| lines.add("written", path.display()));
    let shown = |path: &Path| path.display().to_string();
    let fields = json!({
        "target": "section",
        "certificate": proof::claim_json(claim),
        "quality": quality,
        "transfer": transferred,
        "output": shown(targets.mesh),
        "map": targets.map.map(shown),
    });
    let heading = format!("{} onto {}: one-to-one and onto, proved", options.input.display(), targets.mesh.display());
    Answer::new(fields, lines.below(&heading))
}
