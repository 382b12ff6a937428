//! One row for each pair of polygons: how much maps of different kinds distort (Schneider 2017, table 5.2).
//!
//! `cargo run --release -p homeo --example distortion_table -- FOLDER [TRIANGLES] [SECONDS]`
//!
//! Mean by area and maximum over the centroids of the source's triangles: of composite harmonic maps over a regular
//! polygon, over one with averaged lengths, over one optimized for the figure that is shown, and of composite mean value
//! maps where one is found within so many seconds for each path (with 0 none is looked for).

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use std::time::{Duration, Instant};

use homeo::composite::{CompositeMap, PartitionParams};
use homeo::construct::harmonic::{HarmonicParams, MiddleShape, harmonic_map};
use homeo::map::{Distortion, DistortionSummary, HarmonicMap};
use homeo::progress::Silent;
use homeo::shape::first_not_simple;
use homeo_core::planar::{DomainPair, Point2, read_pair};
use paths::paths;

mod paths;

const KINDS: [Distortion; 2] = [Distortion::Conformal, Distortion::Isometric];

/// Centroids of the source's triangles with their areas.
fn centroids(map: &HarmonicMap) -> Vec<(Point2, f64)> {
    let half = map.source_half();
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| half.position(v));
        let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        ([0, 1].map(|k| (a[k] + b[k] + c[k]) / 3.0), area)
    };
    half.parts().triangles.iter().map(of).collect()
}

fn mean_value(
    pair: &DomainPair,
    turn: Option<f64>,
    points: &[(Point2, f64)],
    seconds: u64,
) -> Option<[DistortionSummary; 2]> {
    if seconds == 0 {
        return None;
    }
    let params = PartitionParams { timeout: Some(Duration::from_secs(seconds)), ..PartitionParams::default() };
    let simple =
        paths(pair, turn).ok()?.into_iter().filter(|(_, path)| matches!(first_not_simple(&**path, 64), Ok(None)));
    let (map, _) = simple.map(|(_, path)| path).find_map(|path| CompositeMap::build(&*path, &params, &Silent).ok())?;
    let mut sums = [DistortionSummary { mean: 0.0, largest: 0.0 }; 2];
    let mut total = 0.0;
    for &(point, area) in points {
        let Some(jacobian) = map.jacobian(point) else { continue };
        for (sum, kind) in sums.iter_mut().zip(KINDS) {
            let value = kind.of(jacobian);
            *sum = DistortionSummary { mean: sum.mean + area * value, largest: sum.largest.max(value) };
        }
        total += area;
    }
    Some(sums.map(|sum| DistortionSummary { mean: sum.mean / total, ..sum }))
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("give a folder of pairs")?;
    let triangles = arguments.next().map_or(Ok(10_000), |text| text.parse())?;
    let seconds: u64 = arguments.next().map_or(Ok(0), |text| text.parse())?;
    let mut paths: Vec<_> = std::fs::read_dir(folder)?.map(|e| e.map(|e| e.path())).collect::<Result<_, _>>()?;
    paths.sort();
    println!("| pair | figure | mean value | regular | averaged | optimized | seconds |");
    println!("|---|---|---:|---:|---:|---:|---:|");
    for path in paths.iter().filter(|p| p.extension().is_some_and(|e| e == "json")) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let rings = read_pair(&serde_json::from_slice(&std::fs::read(path)?)?)?;
        let Ok(pair) = DomainPair::new(rings.source, rings.target) else { continue };
        let of = |middle| {
            let params = HarmonicParams { triangles, middle, turn_degrees: rings.turn_degrees };
            harmonic_map(&pair, params, &Silent)
        };
        let (regular, averaged) = (of(MiddleShape::Regular)?, of(MiddleShape::AveragedLengths)?);
        let composite = mean_value(&pair, rings.turn_degrees, &centroids(&averaged), seconds);
        for (k, kind) in KINDS.into_iter().enumerate() {
            let start = Instant::now();
            let optimized = of(MiddleShape::Optimized(kind))?;
            let took = start.elapsed().as_secs_f64();
            let show = |s: DistortionSummary| format!("{:.3} ({:.3e})", s.mean, s.largest);
            let all = [&regular, &averaged, &optimized].map(|map| show(map.distortion(kind)));
            let first = composite.map_or(String::new(), |found| show(found[k]));
            println!("| {name} | {kind:?} | {first} | {} | {took:.1} |", all.join(" | "));
        }
    }
    Ok(())
}
