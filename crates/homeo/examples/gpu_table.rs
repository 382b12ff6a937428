//! Images of points under composite mean value maps and sampling of a picture, on a graphics processor and on the processor.
//!
//! Usage: `cargo run --release -p homeo --features gpu --example gpu_table -- [SIDE] [POINTS]`
//!
//! Prints the device, then a row of a Markdown table for each task: `SIDE` x `SIDE` (4096) points by a polygon of 20 vertices
//! with 100 steps, `POINTS` (1,000,000) by one of 200 vertices in a single step, and a picture of `SIDE` x `SIDE` pixels by each
//! filter. Seconds are those of the second of two runs, transfers included; the difference is the largest in a coordinate, as a
//! part of the error stated, or in a sample. Give small numbers for a software device. Ends with exit code 1 if there is no
//! device, or a difference is above what is stated.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

use std::process::ExitCode;
use std::time::Instant;

use homeo::composite::{CompositeMap, triangulate};
use homeo::gpu::{Gpu, GpuError};
use homeo::map::PlanarBijection;
use homeo::warp::{Filter, Raster, apply_field};
use homeo_core::planar::{PlanarDomain, Point2};

fn main() -> ExitCode {
    let numbers: Result<Vec<usize>, _> = std::env::args().skip(1).map(|text| text.parse()).collect();
    let Ok(numbers) = numbers else {
        eprintln!("usage: gpu_table [SIDE] [POINTS]: whole numbers");
        return ExitCode::from(2);
    };
    let number = |place: usize, usual: usize| numbers.get(place).copied().unwrap_or(usual);
    match run(number(0, 4096), number(1, 1_000_000)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => {
            eprintln!("a difference is above what is stated");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(side: usize, points: usize) -> Result<bool, GpuError> {
    let gpu = Gpu::new()?;
    let kind = if gpu.is_software() { "software" } else { "hardware" };
    println!("{} ({kind}); {} threads on the processor\n", gpu.adapter(), rayon::current_num_threads());
    println!("| task | device, s | processor, s | left to the processor | largest difference |");
    println!("|---|---:|---:|---:|---:|");
    let tasks = [("20 vertices, 100 steps", map(20, 100), side * side), ("200 vertices, 1 step", map(200, 1), points)];
    let mut is_as_stated = true;
    for (name, map, count) in &tasks {
        is_as_stated &= images(&gpu, name, map, &inside(map, *count))?;
    }
    for filter in [Filter::Linear, Filter::Bicubic, Filter::Lanczos] {
        is_as_stated &= picture(&gpu, side, filter)?;
    }
    Ok(is_as_stated)
}

/// A row for images of points.
fn images(gpu: &Gpu, name: &str, map: &CompositeMap, points: &[Point2]) -> Result<bool, GpuError> {
    gpu.images(map, points)?;
    let begin = Instant::now();
    let found = gpu.images(map, points)?;
    let device = begin.elapsed().as_secs_f64();
    let mut expected = vec![None; points.len()];
    let begin = Instant::now();
    map.forward_along(points, &mut expected);
    let processor = begin.elapsed().as_secs_f64();
    let miss = |pair: (&Option<Point2>, &Option<Point2>)| match pair {
        (Some(found), Some(expected)) => (0..2).map(|k| (found[k] - expected[k]).abs()).fold(0.0, f64::max),
        (None, None) => 0.0,
        _ => f64::INFINITY,
    };
    let worst = found.points.iter().zip(&expected).map(miss).fold(0.0, f64::max);
    let inside = expected.iter().flatten().count();
    println!(
        "| {} points, {inside} inside; {name} | {device:.2} | {processor:.2} | {} | {worst:.1e}, {:.0} % of {:.1e} |",
        points.len(),
        found.left_to_cpu,
        100.0 * worst / found.error,
        found.error,
    );
    Ok(worst <= found.error)
}

/// A row for a picture.
fn picture(gpu: &Gpu, side: usize, filter: Filter) -> Result<bool, GpuError> {
    let mut picture = Raster::zero(side, side, 4, true);
    let bytes = picture.samples.iter_mut().zip(0u32..);
    bytes.for_each(|(sample, k)| *sample = (k.wrapping_mul(2_654_435_761) >> 24) as u8 | 1);
    let wave = |k: usize| {
        let (x, y) = ((k % side) as f32, (k / side) as f32);
        [x + 9.0 * (y / 40.0).sin(), y + 9.0 * (x / 40.0).sin()]
    };
    let field: Vec<[f32; 2]> = (0..side * side).map(wave).collect();
    gpu.apply_field(&picture, &field, side, filter)?;
    let begin = Instant::now();
    let found = gpu.apply_field(&picture, &field, side, filter)?;
    let device = begin.elapsed().as_secs_f64();
    let begin = Instant::now();
    let expected = apply_field(&picture, &field, side, filter);
    let processor = begin.elapsed().as_secs_f64();
    let pixels = found.samples.chunks_exact(4).zip(expected.samples.chunks_exact(4));
    let seen = pixels.filter(|(found, expected)| found[3] > 0 && expected[3] > 0);
    let worst = seen.flat_map(|(a, b)| a.iter().zip(b)).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    println!("| picture of {side} x {side}, {filter:?} | {device:.2} | {processor:.2} | | {worst} of 255 |");
    Ok(worst <= 1)
}

/// From a star to a regular polygon, in equal steps. Its spikes are about as long as wide, whatever their number.
fn map(vertices: usize, steps: usize) -> CompositeMap {
    let domain = |step: usize| {
        let t = step as f64 / steps as f64;
        let vertex = |k: usize| {
            let angle = 0.3 * t + std::f64::consts::TAU * k as f64 / vertices as f64;
            let radius = if k.is_multiple_of(2) { 1.0 } else { 1.0 - 8.0 * (1.0 - t) / vertices as f64 };
            [radius * angle.cos(), radius * angle.sin()]
        };
        PlanarDomain::new(vec![(0..vertices).map(vertex).collect()]).expect("a star is simple")
    };
    let domains: Vec<PlanarDomain> = (0..=steps).map(domain).collect();
    let tilings = domains[..steps].iter().map(|domain| triangulate(domain).expect("a star has triangles")).collect();
    CompositeMap::from_domains(domains, tilings).expect("stars correspond")
}

/// About so many points on a grid over the source's bounds.
fn inside(map: &CompositeMap, count: usize) -> Vec<Point2> {
    let [low, high] = map.source().bounds();
    let side = (count as f64).sqrt().round() as usize;
    let at = |k: usize, axis: usize| low[axis] + (high[axis] - low[axis]) * (k as f64 + 0.5) / side as f64;
    (0..side * side).map(|k| [at(k % side, 0), at(k / side, 1)]).collect()
}
