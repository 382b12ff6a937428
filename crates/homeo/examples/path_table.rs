//! Which paths keep all pairs of polygons in a folder simple.
//!
//! Usage: `cargo run --release -p homeo --example path_table -- FOLDER [STEPS]`
//!
//! Prints one row of a Markdown table for each file `*.json`: vertices; for each path *yes*, or the first of the times
//! `0, 1 / STEPS, ..., 1` (64 steps) at which the shape bounds no domain, exactly, or `-` where there is no such path; of
//! the simple path the vertices of its triangulation, and seconds to make it and for each shape. Ends with exit code 1 if a
//! file cannot be read.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use homeo::shape::{
    CurvaturePath, LengthsAndAngles, LinearPath, ShapeError, ShapePath, SimplePath, TurningPath, first_not_simple,
};
use homeo_core::planar::{DomainPair, read_pair};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some(folder) = arguments.first() else {
        eprintln!("usage: path_table FOLDER [STEPS]");
        return ExitCode::from(2);
    };
    let Ok(steps) = arguments.get(1).map_or(Ok(64), |text| text.parse::<usize>()) else {
        eprintln!("steps are a whole number");
        return ExitCode::from(2);
    };
    match run(folder.as_ref(), steps) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(folder: &Path, steps: usize) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    println!(
        "| pair | vertices | angles | curvature | straight | turning | simple | all vertices | seconds | for each shape |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for path in files {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        println!("| {name} | {} |", row(&path, steps).map_err(|message| format!("{name}: {message}"))?);
    }
    Ok(())
}

fn row(path: &Path, steps: usize) -> Result<String, String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let value = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    let rings = read_pair(&value).map_err(|error| error.to_string())?;
    let pair = match DomainPair::new(rings.source, rings.target) {
        Ok(pair) => pair,
        Err(error) => return Ok(format!("| | | | | | | | {error}")),
    };
    let [source, target] = [&pair.source, &pair.target].map(|domain| domain.rings());
    let by_bends = match (source, target) {
        ([source], [target]) => [
            said(LengthsAndAngles::new(source.clone(), target.clone()), steps),
            said(CurvaturePath::new(source.clone(), target.clone()), steps),
        ],
        _ => ["-", "-"].map(str::to_owned),
    };
    let straight = [said(LinearPath::between(&pair), steps), said(TurningPath::between(&pair, &[]), steps)];
    let columns = [by_bends, straight].concat().join(" | ");
    let start = Instant::now();
    let simple = SimplePath::between(&pair);
    let made = start.elapsed().as_secs_f64();
    let vertices = simple.as_ref().ok().and_then(|path| Some(path.drawing(0.5).ok()?.len().to_string()));
    let start = Instant::now();
    let simple = said(simple, steps);
    let each = start.elapsed().as_secs_f64() / (steps + 1) as f64;
    let (count, vertices) = (pair.source.vertex_count(), vertices.unwrap_or_default());
    Ok(format!("{count} | {columns} | {simple} | {vertices} | {made:.2} | {each:.4}"))
}

/// Whether a path stays simple.
fn said(path: Result<impl ShapePath, ShapeError>, steps: usize) -> String {
    match path.and_then(|path| first_not_simple(&path, steps)) {
        Ok(None) => "yes".to_owned(),
        Ok(Some(crossing)) => format!("{:.3}", crossing.t),
        Err(error) => error.to_string(),
    }
}
