//! How many boxes it takes to prove that mean value maps of regular polygons are one-to-one.
//!
//! Usage: `cargo run --release -p homeo --example composite_boxes -- [VERTICES]...`
//!
//! Prints one row of a Markdown table for each number of vertices (20, 64 and 200): triangles, then boxes and seconds for the
//! identity, and for radii changed by 2 % in five waves.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

use std::process::ExitCode;
use std::time::Instant;

use homeo::composite::{JacobianLimits, JacobianVerdict, bound_jacobian, triangulate};
use homeo_core::planar::{PlanarDomain, Point2};

fn main() -> ExitCode {
    let counts: Result<Vec<usize>, _> = std::env::args().skip(1).map(|text| text.parse()).collect();
    let Ok(mut counts) = counts else {
        eprintln!("usage: composite_boxes [VERTICES]...");
        return ExitCode::from(2);
    };
    if counts.is_empty() {
        counts = vec![20, 64, 200];
    }
    println!("| vertices | triangles | identity: boxes | seconds | 2 %: boxes | seconds |");
    println!("|---:|---:|---:|---:|---:|---:|");
    for count in counts {
        println!("{}", row(count).unwrap_or_else(|message| format!("| {count} | {message} |")));
    }
    ExitCode::SUCCESS
}

fn row(count: usize) -> Result<String, String> {
    let polygon = ring(count, 0.0);
    let domain = PlanarDomain::new(vec![polygon.clone()]).map_err(|error| error.to_string())?;
    let tiling = triangulate(&domain).map_err(|error| error.to_string())?;
    let measured = |images: &[Point2]| -> Result<String, String> {
        let start = Instant::now();
        let verdict = bound_jacobian(&domain, &tiling, images, &JacobianLimits::default());
        let verdict = verdict.map_err(|error| error.to_string())?;
        let word = match verdict {
            JacobianVerdict::Positive { .. } => "",
            JacobianVerdict::Negative { .. } => " (negative)",
            JacobianVerdict::Undecided { .. } => " (undecided)",
        };
        Ok(format!("{}{word} | {:.2}", verdict.boxes(), start.elapsed().as_secs_f64()))
    };
    let (identity, changed) = (measured(&polygon)?, measured(&ring(count, 0.02))?);
    Ok(format!("| {count} | {} | {identity} | {changed} |", tiling.triangles.len()))
}

/// A regular polygon whose radius is changed by a part of it, in five waves.
fn ring(count: usize, change: f64) -> Vec<Point2> {
    let vertex = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / count as f64;
        let radius = 1.0 + change * (5.0 * angle).sin();
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..count).map(vertex).collect()
}
