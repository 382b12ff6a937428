//! `homeo map`: a certified bijective map, or the reason why there is none.

mod refuse;
mod regions;
mod vtu;

use std::path::Path;

use homeo::certificate::{FoliationMap, Provenance, write_map};
use homeo::construct::foliation::{FoliationError, FoliationInfo, FoliationParams, build};
use homeo::map::Target;
use homeo::progress::Progress;
use homeo_verify::Claim;
use serde_json::{Value, json};

use crate::answer::Answer;
use crate::args::{MapArgs, TargetName};
use crate::failure::{Failure, Result};
use crate::mesh_input::{self, Cells, MeshInput, Requested, source_mesh};
use crate::outputs::{Outputs, check_targets};
use crate::proof;
use crate::report;
use crate::sampled::{self, Sampled};
use crate::session::Session;
use crate::text::{Lines, counted, file_name, ratio, stages};

/// Makes a map, proves it and stages its files.
pub fn run(session: &Session, options: &MapArgs, outputs: &mut Outputs) -> Result<Answer> {
    let target = target_of(options.onto);
    check_outputs(options)?;
    let regions = options.regions.as_deref().map(regions::read).transpose()?.unwrap_or_default();
    let params = FoliationParams {
        smoothing_sweeps: options.smoothing,
        restarts: options.restarts,
        refinements: options.refinements,
        seed: session.common.seed,
        regions,
        ..FoliationParams::default()
    };
    let requested = Requested { weld: options.weld, triangulate: options.triangulate, orient: options.orient };
    let mesh = mesh_input::read(session, &options.input, requested)?;
    for note in mesh.changes.iter().chain(&mesh.file.losses) {
        session.display().note(note);
    }
    session.stage("check");
    refuse::unfit(session, &mesh, target, options.triangulate)?;
    session.check()?;
    let (map, info) = construct(session, &mesh, target, &params)?;
    let provenance = provenance(options, &params);
    let claim = proof::write_and_check(session, options.output.as_deref(), outputs, |mut out| {
        write_map(&map, &provenance, &mut out)
    })?;
    session.stage("sample");
    let sampled = sampled::sample(&map);
    session.check()?;
    if let Some(path) = &options.vtu {
        session.stage("images");
        let images = sampled::all(&map);
        session.check()?;
        session.stage("write");
        vtu::stage(session, path, &mesh.file, &images, outputs)?;
    }
    if let Some(path) = &options.report {
        session.stage("report");
        let title = report::title(&options.input, target.name());
        report::stage(session, path, &title, &map, &claim, &sampled, outputs)?;
    }
    session.end_stage();
    let fields = json!({
        "target": target.name(),
        "certificate": proof::claim_json(&claim),
        "quality": quality(&info, &sampled),
        "output": options.output.as_ref().map(|path| path.display().to_string()),
    });
    Ok(Answer::new(fields, words(session, options, target, &info, &claim, &sampled)))
}

fn target_of(name: TargetName) -> Target {
    match name {
        TargetName::Square => Target::Square,
        TargetName::Disk => Target::Disk,
        TargetName::Cube => Target::Cube,
        TargetName::Ball => Target::Ball,
    }
}

fn check_outputs(options: &MapArgs) -> Result<()> {
    let mut inputs = vec![options.input.as_path()];
    inputs.extend(options.regions.as_deref());
    let outputs: Vec<&Path> =
        [&options.output, &options.report, &options.vtu].into_iter().filter_map(|path| path.as_deref()).collect();
    check_targets(&outputs, &inputs)?;
    options.vtu.as_deref().map_or(Ok(()), vtu::check_name)
}

fn construct(
    session: &Session,
    mesh: &MeshInput,
    target: Target,
    params: &FoliationParams,
) -> Result<(FoliationMap, FoliationInfo)> {
    let built = match &mesh.cells {
        Cells::Triangles(complex) => build(&source_mesh(&mesh.file, complex), target, params, session)
            .map(|(map, info)| (FoliationMap::Surface(map), info)),
        Cells::Tetrahedra(complex) => build(&source_mesh(&mesh.file, complex), target, params, session)
            .map(|(map, info)| (FoliationMap::Volume(map), info)),
    };
    built.map_err(|error| explain(session, error))
}

fn explain(session: &Session, error: FoliationError) -> Failure {
    let message = error.to_string();
    match error {
        FoliationError::Input(_) => Failure::input("unfit-input", message),
        FoliationError::WrongTarget { .. } => Failure::input("wrong-dimension", message),
        FoliationError::Region(_) => Failure::input("regions", message),
        FoliationError::Stuck(info) => Failure::limits("stuck", message).with("quality", construction(&info)),
        FoliationError::Section(_) => Failure::limits("section", message),
        FoliationError::TooDeep(_) => Failure::limits("too-deep", message),
        FoliationError::Cancelled(info) => session.stopped().with("quality", construction(&info)),
    }
}

/// Nothing that depends on the machine, so that a run repeats bit for bit.
fn provenance(options: &MapArgs, params: &FoliationParams) -> Provenance {
    Provenance {
        source_name: file_name(&options.input),
        program: format!("homeo {}", env!("CARGO_PKG_VERSION")),
        options: json!({
            "seed": params.seed, "refinements": params.refinements, "restarts": params.restarts,
            "smoothing": params.smoothing_sweeps, "weld": options.weld, "triangulate": options.triangulate,
            "orient": options.orient, "regions": options.regions.is_some(),
        }),
    }
}

fn construction(info: &FoliationInfo) -> Value {
    json!({
        "cells": info.cells, "vertices": info.vertices, "restarts": info.restarts,
        "local_refinements": info.local_refinements, "barycentric_refinements": info.barycentric_refinements,
        "facets_turned": info.facets_turned, "stuck_cells": info.stuck_cells,
    })
}

fn quality(info: &FoliationInfo, sampled: &Sampled) -> Value {
    let mut quality = construction(info);
    quality["sampled"] = sampled.quality();
    quality
}

fn words(
    session: &Session,
    options: &MapArgs,
    target: Target,
    info: &FoliationInfo,
    claim: &Claim,
    sampled: &Sampled,
) -> String {
    let mut lines = Lines::default();
    lines.add("certificate", proof::holds(claim));
    let refined = match info.local_refinements + info.barycentric_refinements {
        0 => String::new(),
        extra => format!(", {} where the front got stuck", counted(extra, "refinement", "refinements")),
    };
    lines.add("cells", format!("{} after preparation{refined}", info.cells));
    let [median, high, largest] = [0.5, 0.99, 1.0].map(|share| ratio(sampled.quantile(share)));
    let flat = if sampled.flat > 0 { format!("; {} flat between their corners", sampled.flat) } else { String::new() };
    lines.add("stretch", format!("median {median}, 99 % below {high}, largest {largest} (sampled{flat})"));
    lines.add("float error", format!("at most {:.1e} (sampled)", sampled.max_radius));
    lines.add("time", stages(&session.seconds()));
    let written = [&options.output, &options.vtu, &options.report];
    for path in written.into_iter().flatten() {
        lines.add("written", path.display());
    }
    if options.output.is_none() {
        lines.add("written", "no map: give -o FILE.homeo to keep it");
    }
    let name = options.input.display();
    lines.below(&format!("{name} onto the {target}: one-to-one and onto, proved"))
}
