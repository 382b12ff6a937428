//! Builds a shell and sends the source's vertices to the middle surface and back, exactly and in floating point.
//!
//! Usage: `cargo run --release -p homeo --example shell_round_trips -- MESH [THICKNESS] [ROUNDS] [VERTICES]`
//!
//! Prints one row of a Markdown table: triangles, prisms, pinched vertices, processor seconds of the construction
//! (wall seconds where the system does not tell), vertices tried (at
//! most 2,000 unless said otherwise), how many did not come back exactly, and the largest distance by which the
//! floating-point round trip misses, relative to the diagonal of the box. Exit code 1 if a vertex did not come back.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

use std::process::ExitCode;
use std::time::Instant;

use homeo::construct::shell::{ShellParams, build};
use homeo::input::SourceMesh;
use homeo::map::Shell;
use homeo::progress::Silent;
use homeo_core::mesh::SimplicialComplex;
use homeo_core::number::Rational;
use homeo_core::spatial::Aabb;
use rayon::prelude::*;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok((row, failures)) => {
            println!("{row}");
            if failures == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        Err(message) => {
            eprintln!("{}: {message}", arguments.first().map_or("usage: shell_round_trips MESH", |path| path));
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<(String, usize), String> {
    let path = arguments.first().ok_or("no mesh")?;
    let number =
        |k: usize| arguments.get(k).map(|text| text.parse::<f64>().map_err(|error| format!("{text}: {error}")));
    let mut params = ShellParams::default();
    if let Some(thickness) = number(1) {
        params.thickness = thickness?;
    }
    if let Some(rounds) = number(2) {
        params.rounds = rounds? as usize;
    }
    let most = number(3).transpose()?.unwrap_or(2000.0) as usize;
    let file = homeo_core::io::read_mesh(path.as_ref()).map_err(|error| error.to_string())?;
    let polygons = file.polygons.iter().map(|corners| corners.try_into().map_err(|_| "a polygon is no triangle"));
    let triangles = polygons.collect::<Result<Vec<[u32; 3]>, _>>()?;
    let complex =
        SimplicialComplex::from_indices(file.positions.len(), &triangles).map_err(|error| error.to_string())?;
    let source = SourceMesh::new(file.positions, complex);
    let (clock, before) = (Instant::now(), processor_seconds());
    let (shell, info) = build(&source, &params, &Silent).map_err(|error| error.to_string())?;
    let seconds = match (before, processor_seconds()) {
        (Some(before), Some(after)) => after - before,
        _ => clock.elapsed().as_secs_f64(),
    };
    let (tried, failures, miss) = try_vertices(&shell, most);
    let name = std::path::Path::new(path).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let row = format!(
        "| {name} | {} | {} | {} | {seconds:.2} | {tried} | {failures} | {miss:.1e} |",
        triangles.len(),
        info.prisms,
        info.pinched
    );
    Ok((row, failures))
}

/// Seconds that processors have spent on this process (Linux).
fn processor_seconds() -> Option<f64> {
    let tasks = std::fs::read_dir("/proc/self/task").ok()?.flatten();
    let nanoseconds = tasks.filter_map(|task| {
        let text = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    });
    Some(nanoseconds.sum::<f64>() / 1e9)
}

/// How many vertices were tried, how many did not come back exactly, and the worst floating-point miss.
fn try_vertices(shell: &Shell, most: usize) -> (usize, usize, f64) {
    let source = shell.source();
    let mut used: Vec<u32> = source.complex().cells().iter().flatten().map(|v| v.raw()).collect();
    used.sort_unstable();
    used.dedup();
    let hull = Aabb::of(source.positions());
    let diagonal = (0..3).map(|axis| (hull.high[axis] - hull.low[axis]).powi(2)).sum::<f64>().sqrt();
    let step = used.len().div_ceil(most.max(1)).max(1);
    let chosen: Vec<u32> = used.into_iter().step_by(step).collect();
    let misses: Vec<Option<f64>> =
        chosen.par_iter().map(|&v| round_trip(shell, source.positions()[v as usize])).collect();
    let worst = misses.iter().flatten().fold(0.0f64, |worst, miss| worst.max(*miss));
    (chosen.len(), misses.iter().filter(|miss| miss.is_none()).count(), worst / diagonal)
}

/// By how much the floating-point round trip misses; `None` if the exact one does not come back.
fn round_trip(shell: &Shell, point: [f64; 3]) -> Option<f64> {
    let exact = point.map(|x| Rational::from_f64(x).unwrap_or(Rational::ZERO));
    let there = shell.to_middle_exact(&exact).ok()?;
    if shell.to_source_exact(&there).ok()?.point != exact {
        return None;
    }
    let middle = shell.to_middle(point).ok()?.point;
    // The rounded middle point may lie outside an open shell, where there is no answer to compare.
    let back = shell.to_source(middle).map_or(point, |back| back.point);
    Some((0..3).map(|axis| (back[axis] - point[axis]).powi(2)).sum::<f64>().sqrt())
}
