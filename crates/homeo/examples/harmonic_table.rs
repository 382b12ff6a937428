//! One row of a table for each pair of polygons: what composite harmonic maps do with it.
//!
//! `cargo run --release -p homeo --example harmonic_table -- FOLDER [TRIANGLES]`

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::io::Cursor;
use std::time::Instant;

use homeo::certificate::{Provenance, write_harmonic};
use homeo::construct::harmonic::{HarmonicParams, harmonic_map};
use homeo::map::{HalfParts, HarmonicMap, PlanarBijection};
use homeo::progress::Silent;
use homeo_core::number::Rational;
use homeo_core::planar::{DomainPair, read_pair};
use homeo_verify::{Verdict, verify_bytes};

/// Points that go there and back, exactly.
const TRIPS: usize = 200;

/// Triangles, certificate and round trips.
fn row(map: &HarmonicMap, start: Instant) -> Result<String, Box<dyn Error>> {
    let made = start.elapsed().as_secs_f64();
    let mut file = Cursor::new(Vec::new());
    write_harmonic(map, &Provenance::default(), &mut file)?;
    let start = Instant::now();
    let verdict = match verify_bytes(file.get_ref())? {
        Verdict::Certified(_) => "holds".to_owned(),
        other => format!("{other:?}"),
    };
    let checked = start.elapsed().as_secs_f64();
    let (mut exact, mut worst) = (0, 0.0f64);
    for point in inner_points(map.source_half().parts()) {
        let there = map.forward_exact(&point.map(|x| Rational::from_f64(x).unwrap_or(Rational::ZERO)))?;
        let back = map.inverse_exact(&there)?;
        exact += usize::from(back.each_ref().map(Rational::to_f64) == point);
        worst = worst.max(map.forward(point)?.radius);
    }
    let [source, target] = [map.source_half(), map.target_half()].map(|half| half.parts().triangles.len());
    Ok(format!("{source} + {target} | {made:.2} | {verdict} | {checked:.2} | {exact} of {TRIPS} | {worst:.1e}"))
}

/// Points inside, a little off the vertices of the triangulation.
fn inner_points(parts: &HalfParts) -> impl Iterator<Item = [f64; 2]> {
    let [low, high] = parts.domain.bounds();
    let mut state = 7u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 2f64.powi(53)
    };
    let anywhere = move || Some([0, 1].map(|axis| low[axis] + random() * (high[axis] - low[axis])));
    std::iter::from_fn(anywhere).filter(|&point| parts.domain.contains(point)).take(TRIPS)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("give a folder of pairs")?;
    let triangles = std::env::args().nth(2).map_or(Ok(HarmonicParams::default().triangles), |t| t.parse())?;
    let mut paths: Vec<_> = std::fs::read_dir(folder)?.map(|e| e.map(|e| e.path())).collect::<Result<_, _>>()?;
    paths.sort();
    println!("| pair | vertices | triangles | seconds | certificate | seconds | round trips | worst error |");
    println!("|---|---|---|---|---|---|---|---|");
    for path in paths.iter().filter(|p| p.extension().is_some_and(|e| e == "json")) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let rings = read_pair(&serde_json::from_slice(&std::fs::read(path)?)?)?;
        let pair = match DomainPair::new(rings.source, rings.target) {
            Ok(pair) => pair,
            Err(error) => {
                println!("| {name} | | refused: {error} | |");
                continue;
            }
        };
        let start = Instant::now();
        let params = HarmonicParams { triangles, turn_degrees: rings.turn_degrees, ..HarmonicParams::default() };
        let outcome = match harmonic_map(&pair, params, &Silent) {
            Ok(map) => row(&map, start)?,
            Err(error) => error.to_string(),
        };
        println!("| {name} | {} | {outcome} |", pair.source.vertex_count());
    }
    Ok(())
}
