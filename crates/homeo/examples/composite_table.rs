//! Composite mean value maps of all pairs of polygons in a folder, each checked by the independent checker.
//!
//! Usage: `cargo run --release -p homeo --example composite_table -- FOLDER [STEPS] [SECONDS]`
//!
//! Prints one row of a Markdown table for each file `*.json`: vertices, path and steps, the least Jacobian determinant that is
//! proved, boxes that were evaluated, seconds; boxes, seconds and verdict of the checker; or why there is no map within so many
//! steps (1000) and seconds (60) on any of the paths. Ends with exit code 1 if a file cannot be read.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

use std::io::Cursor;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use homeo::certificate::{Provenance, write_composite};
use homeo::composite::{CompositeMap, PartitionParams};
use homeo::progress::Silent;
use homeo::shape::first_not_simple;
use homeo_core::planar::{DomainPair, read_pair};
use homeo_verify::{Verdict, verify_bytes};
use paths::paths;

mod paths;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some(folder) = arguments.first() else {
        eprintln!("usage: composite_table FOLDER [STEPS] [SECONDS]");
        return ExitCode::from(2);
    };
    let number = |place: usize, usual: u64| arguments.get(place).map_or(Ok(usual), |text| text.parse::<u64>());
    let (Ok(steps), Ok(seconds)) = (number(1, 1000), number(2, 60)) else {
        eprintln!("steps and seconds are whole numbers");
        return ExitCode::from(2);
    };
    let timeout = Some(Duration::from_secs(seconds));
    let params = PartitionParams { steps: steps as usize, timeout, ..PartitionParams::default() };
    match run(folder.as_ref(), &params) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(folder: &Path, params: &PartitionParams) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    println!(
        "| pair | vertices | path | steps | least determinant | boxes | in vain | seconds | checker: boxes | seconds | verdict |"
    );
    println!("|---|---:|---|---:|---:|---:|---:|---:|---:|---:|---|");
    for path in files {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        println!("| {name} | {}", row(&path, params).map_err(|message| format!("{name}: {message}"))?);
    }
    Ok(())
}

fn row(path: &Path, params: &PartitionParams) -> Result<String, String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let value = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    let rings = read_pair(&value).map_err(|error| error.to_string())?;
    let pair = match DomainPair::new(rings.source, rings.target) {
        Ok(pair) => pair,
        Err(error) => return Ok(format!(" | | | | | | | | | {error} |")),
    };
    let count = pair.source.vertex_count();
    let mut reasons = Vec::new();
    for (name, path) in paths(&pair, rings.turn_degrees)? {
        if let Ok(Some(crossing)) = first_not_simple(&*path, 64) {
            reasons.push(format!("{name}: {crossing}"));
            continue;
        }
        let start = Instant::now();
        let built = CompositeMap::build(&*path, params, &Silent);
        let seconds = start.elapsed().as_secs_f64();
        match built {
            Ok((map, info)) => {
                let columns = [
                    name.to_owned(),
                    map.step_count().to_string(),
                    format!("{:.3e}", info.least_determinant),
                    info.boxes.to_string(),
                    info.boxes_in_vain.to_string(),
                    format!("{seconds:.1}"),
                ];
                return Ok(format!("{count} | {} | {} |", columns.join(" | "), checked(&map)?));
            }
            Err(error) => reasons.push(format!("{name}: {error} ({seconds:.1} s)")),
        }
    }
    Ok(format!("{count} | | | | | | | | | {} |", reasons.join("; ")))
}

/// What the checker says: boxes, seconds, verdict.
fn checked(map: &CompositeMap) -> Result<String, String> {
    let mut bytes = Cursor::new(Vec::new());
    write_composite(map, &Provenance::default(), &mut bytes).map_err(|error| error.to_string())?;
    let start = Instant::now();
    let verdict = verify_bytes(bytes.get_ref()).map_err(|error| error.to_string())?;
    let seconds = start.elapsed().as_secs_f64();
    Ok(match verdict {
        Verdict::Certified(claim) => {
            let boxes = claim.checked.last().map_or(0, |(_, count)| *count);
            format!("{boxes} | {seconds:.1} | certified")
        }
        Verdict::Refuted(witness) => format!("| {seconds:.1} | refuted: {}", witness.message),
        Verdict::Undecided(obstacle) => format!("| {seconds:.1} | undecided: {}", obstacle.message),
    })
}
