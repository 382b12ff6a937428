//! `homeo shell`: a certified shell round a closed surface, or the reason why there is none.

mod frozen;
mod layers;
mod refuse;

pub use refuse::{Crossings, unfit};

use std::cell::Cell;
use std::path::Path;

use homeo::certificate::{Provenance, write_shell};
use homeo::construct::shell::{ShellError, ShellInfo, ShellParams, build};
use homeo::input::SourceMesh;
use homeo::map::Shell;
use homeo::progress::Progress;
use homeo_verify::Claim;
use serde_json::{Value, json};

use crate::answer::Answer;
use crate::args::ShellArgs;
use crate::failure::{Failure, Result};
use crate::mesh_input::{self, Requested, source_mesh};
use crate::outputs::{Outputs, check_targets};
use crate::proof;
use crate::report;
use crate::session::Session;
use crate::text::{Lines, counted, file_name, stages};

/// Makes a shell, proves its projection and stages its files.
pub fn run(session: &Session, options: &ShellArgs, outputs: &mut Outputs) -> Result<Answer> {
    let layer_paths = options.layers.as_deref().map(layers::paths);
    check_outputs(options, layer_paths.as_ref().map_or(&[], |paths| paths.as_slice()))?;
    let params = ShellParams {
        thickness: options.thickness,
        prisms: options.prisms,
        rounds: options.rounds,
        immersed: options.immersed,
        embedded: options.embedded,
        may_thin: true,
        largest_angle: options.largest_angle.to_radians(),
        feature_angle: options.features.map(f64::to_radians),
        frozen: options.frozen.as_deref().map(frozen::read).transpose()?.unwrap_or_default(),
    };
    let requested = Requested { weld: options.weld, triangulate: options.triangulate, orient: options.orient };
    let mesh = mesh_input::read(session, &options.input, requested)?;
    for note in mesh.changes.iter().chain(&mesh.file.losses) {
        session.display().note(note);
    }
    session.stage("check");
    let crossings = match options.immersed {
        true => Crossings::Allowed,
        false => Crossings::Refused { advice: "or give --immersed: the shell is then one of the abstract surface" },
    };
    let complex = unfit(session, &mesh, options.triangulate, crossings)?;
    session.check()?;
    let made = construct(session, &source_mesh(&mesh.file, complex), &params)?;
    let provenance = provenance(options, &params);
    let claim = proof::write_and_check(session, options.output.as_deref(), outputs, |mut out| {
        write_shell(&made.shell, &provenance, &mut out)
    })?;
    if let Some(paths) = &layer_paths {
        session.stage("layers");
        layers::stage(session, paths, made.shell.parts(), outputs)?;
    }
    if let Some(path) = &options.report {
        session.stage("report");
        let title = report::title(&options.input, "middle surface of its shell");
        report::stage_shell(session, path, &title, &made.shell, &claim, outputs)?;
    }
    session.end_stage();
    let shown = |path: &std::path::PathBuf| path.display().to_string();
    let fields = json!({
        "target": claim.target,
        "certificate": proof::claim_json(&claim),
        "quality": quality(&made),
        "output": options.output.as_ref().map(shown),
        "layers": layer_paths.as_ref().map(|paths| paths.iter().map(shown).collect::<Vec<_>>()),
    });
    let written = [&options.output, &options.report].into_iter().flatten().chain(layer_paths.iter().flatten());
    let written: Vec<&Path> = written.map(|path| path.as_path()).collect();
    Ok(Answer::new(fields, words(session, options, &made, &claim, &written)))
}

fn check_outputs(options: &ShellArgs, layers: &[std::path::PathBuf]) -> Result<()> {
    let outputs = options.output.iter().chain(&options.report).chain(layers);
    let outputs: Vec<&Path> = outputs.map(|path| path.as_path()).collect();
    let inputs: Vec<&Path> =
        std::iter::once(&options.input).chain(&options.frozen).map(|path| path.as_path()).collect();
    check_targets(&outputs, &inputs)
}

/// A shell, and how it came about.
struct Made {
    shell: Shell,
    info: ShellInfo,
    /// The time limit ended its simplification.
    was_cut_short: bool,
}

/// The session, with a time limit that ends the simplification and not the run once there is a shell.
struct Simplifying<'s> {
    session: &'s Session,
    has_shell: Cell<bool>,
    was_cut_short: Cell<bool>,
}

impl Progress for Simplifying<'_> {
    fn stage(&self, name: &'static str) {
        if name == "simplify" {
            self.has_shell.set(true);
            self.session.let_time_end_work();
        }
        self.session.stage(name);
    }

    fn is_cancelled(&self) -> bool {
        let is_cancelled = self.session.is_cancelled();
        self.was_cut_short.set(self.was_cut_short.get() || (is_cancelled && self.has_shell.get()));
        is_cancelled
    }
}

/// Builds a shell; the time limit ends its simplification.
///
/// # Errors
/// When there is none within the limits.
fn construct(session: &Session, source: &SourceMesh<3>, params: &ShellParams) -> Result<Made> {
    let progress = Simplifying { session, has_shell: Cell::new(false), was_cut_short: Cell::new(false) };
    let (shell, info) = build(source, params, &progress).map_err(|error| explain(session, &error))?;
    session.lift_time_limit();
    session.check()?;
    let was_cut_short = progress.was_cut_short.get();
    if was_cut_short {
        session.display().note(&format!(
            "the time limit cut simplification short after {}: the shell has {} prisms",
            counted(info.rounds, "round", "rounds"),
            info.prisms
        ));
    }
    Ok(Made { shell, info, was_cut_short })
}

/// Builds a shell that others go on with; the time limit ends the run.
///
/// # Errors
/// When there is none within the limits.
pub fn construct_in_time(session: &Session, source: &SourceMesh<3>, params: &ShellParams) -> Result<Shell> {
    let (shell, _) = build(source, params, session).map_err(|error| explain(session, &error))?;
    session.check()?;
    Ok(shell)
}

pub fn explain(session: &Session, error: &ShellError) -> Failure {
    let message = error.to_string();
    match error {
        ShellError::Thickness | ShellError::Angle | ShellError::Contradiction => Failure::usage(message),
        ShellError::NoSuchVertex(vertex) => Failure::input("frozen", message).with("elements", json!([vertex])),
        ShellError::Stuck { triangle, .. } => Failure::limits("stuck", message).with("elements", json!([triangle])),
        ShellError::Cancelled => session.stopped(),
    }
}

/// Nothing that depends on the machine, so that a run repeats bit for bit.
fn provenance(options: &ShellArgs, params: &ShellParams) -> Provenance {
    Provenance {
        source_name: file_name(&options.input),
        program: format!("homeo {}", env!("CARGO_PKG_VERSION")),
        options: json!({
            "thickness": params.thickness, "prisms": params.prisms, "rounds": params.rounds, "immersed": params.immersed, "embedded": params.embedded,
            "largest_angle": options.largest_angle, "features": options.features, "frozen": options.frozen.is_some(),
            "weld": options.weld, "triangulate": options.triangulate, "orient": options.orient,
        }),
    }
}

fn quality(made: &Made) -> Value {
    let (info, parts) = (&made.info, made.shell.parts());
    json!({
        "prisms": info.prisms, "first_prisms": info.first_prisms, "pinched": info.pinched,
        "collapses": info.collapses, "flips": info.flips, "rounds": info.rounds, "cut_short": made.was_cut_short,
        "largest_angle": info.largest_angle.to_degrees(),
        "middle": {"vertices": parts.middle.len(), "triangles": parts.prisms.len()},
    })
}

fn words(session: &Session, options: &ShellArgs, made: &Made, claim: &Claim, written: &[&Path]) -> String {
    let (info, parts) = (&made.info, made.shell.parts());
    let mut lines = Lines::default();
    lines.add("certificate", proof::holds(claim));
    let share = 100.0 * info.prisms as f64 / info.first_prisms.max(1) as f64;
    lines.add("prisms", format!("{} of {} ({share:.1} %)", info.prisms, info.first_prisms));
    lines.add("middle", format!("{} vertices, {} triangles", parts.middle.len(), parts.prisms.len()));
    let angle = info.largest_angle.to_degrees();
    lines.add("angle", format!("{angle:.2} degrees at most between pillars and normals"));
    if info.pinched > 0 {
        lines.add("pinched", counted(info.pinched, "vertex without a direction", "vertices without a direction"));
    }
    let short = if made.was_cut_short { ", cut short by the time limit" } else { "" };
    lines.add(
        "simplified",
        format!(
            "{} and {} in {}{short}",
            counted(info.collapses, "collapse", "collapses"),
            counted(info.flips, "flip", "flips"),
            counted(info.rounds, "round", "rounds")
        ),
    );
    lines.add("time", stages(&session.seconds()));
    for path in written {
        lines.add("written", path.display());
    }
    if options.output.is_none() {
        lines.add("written", "no map: give -o FILE.homeo to keep it");
    }
    let name = options.input.display();
    let meant = if options.immersed { ", both as abstract surfaces" } else { "" };
    lines.below(&format!("{name} onto the middle surface of its shell{meant}: one-to-one and onto, proved"))
}
