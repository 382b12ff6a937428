//! One row of a table for each pair of polygons: what composite harmonic maps do with it.
//!
//! `cargo run --release -p homeo --example harmonic_table -- FOLDER [TRIANGLES]`

use std::error::Error;
use std::time::Instant;

use homeo::construct::harmonic::{HarmonicParams, harmonic_map};
use homeo::progress::Silent;
use homeo_core::planar::{DomainPair, read_pair};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("give a folder of pairs")?;
    let triangles = std::env::args().nth(2).map_or(Ok(HarmonicParams::default().triangles), |t| t.parse())?;
    let mut paths: Vec<_> = std::fs::read_dir(folder)?.map(|e| e.map(|e| e.path())).collect::<Result<_, _>>()?;
    paths.sort();
    println!("| pair | vertices | triangles | seconds |\n|---|---|---|---|");
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
            Ok(map) => {
                format!("{} + {}", map.source().parts().triangles.len(), map.target().parts().triangles.len())
            }
            Err(error) => error.to_string(),
        };
        println!("| {name} | {} | {outcome} | {:.2} |", pair.source.vertex_count(), start.elapsed().as_secs_f64());
    }
    Ok(())
}
