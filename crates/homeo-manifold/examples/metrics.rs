//! Finds and proves the structures of a file of records such as `testdata/hyperbolic/census.json`, and prints a table.
//!
//! ```sh
//! cargo run --release -p homeo-manifold --example metrics -- testdata/hyperbolic/census.json
//! ```
#![allow(clippy::print_stdout)]

use homeo_manifold::hyperbolic::{Enclosure, NoMetric, Structure, flow};
use homeo_manifold::{Permutation, Skeleton, Triangulation};
use serde_json::Value;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("give a file of records")?;
    let file: Value = serde_json::from_str(&std::fs::read_to_string(path)?)?;
    println!("| gluing | Newton steps | flow steps | ms | difference | width | volume | result |");
    println!("|---|---:|---:|---:|---:|---:|---|---|");
    for record in file["triangulations"].as_array().ok_or("there is no list \"triangulations\"")? {
        print_row(record)?;
    }
    Ok(())
}

fn print_row(record: &Value) -> Result<(), Box<dyn Error>> {
    let triangulation = read(record).ok_or("a record is not as the format says")?;
    let start = Instant::now();
    let skeleton = Skeleton::new(&triangulation);
    let result = Structure::find(&triangulation, &skeleton);
    let milliseconds = start.elapsed().as_secs_f64() * 1e3;
    let name = record["isoSig"].as_str().unwrap_or("?");
    match result {
        Ok(structure) => {
            let steps = structure.approximation().steps;
            let slow = flow(&triangulation, &skeleton).map_or(0, |found| found.steps);
            let (difference, width) = compare(record, &structure, &skeleton);
            let volume = structure.volume().middle();
            let agrees = if record["status"] == "positive" { "proved" } else { "proved, but the file says none" };
            println!(
                "| {name} | {steps} | {slow} | {milliseconds:.2} | {difference:.0e} | {width:.0e} | {volume:.10} | {agrees} |"
            );
        }
        Err(refusal) => {
            let proof = if refusal.is_proved() { "refused" } else { "not found" };
            let why = match refusal {
                NoMetric::LowDegree { edge, degree } => format!("edge {edge} has degree {degree}"),
                NoMetric::NoAngles { obstruction } => format!("weights {:?}", obstruction.weights()),
                other => other.to_string(),
            };
            println!(
                "| {name} | | | {milliseconds:.2} | | | | {proof}: {why} ({}) |",
                record["status"].as_str().unwrap_or("?")
            );
        }
    }
    Ok(())
}

fn read(record: &Value) -> Option<Triangulation> {
    let mut triangulation = Triangulation::new(usize::try_from(record["tetrahedra"].as_u64()?).ok()?);
    for row in record["gluings"].as_array()? {
        let number = |value: &Value| u32::try_from(value.as_u64()?).ok();
        let (tetrahedron, face, other) = (number(&row[0])?, number(&row[1])? as u8, number(&row[2])?);
        let images: Vec<u8> = row[3].as_array()?.iter().filter_map(number).map(|image| image as u8).collect();
        let corners = Permutation::new(images.try_into().ok()?)?;
        if triangulation.neighbour(tetrahedron, face).is_none() {
            triangulation.glue(tetrahedron, face, other, corners).ok()?;
        }
    }
    Some(triangulation)
}

/// The largest difference of an angle, length or the volume to the file, and the largest width of an enclosure.
fn compare(record: &Value, structure: &Structure, skeleton: &Skeleton) -> (f64, f64) {
    let mut all: Vec<(Enclosure, &Value)> = vec![(structure.volume(), &record["volume"])];
    for (tetrahedron, angles) in structure.angles().iter().enumerate() {
        for (edge, &angle) in angles.iter().enumerate() {
            all.push((angle, &record["dihedralAngles"][tetrahedron][edge]));
            let class = record["edgeClasses"][tetrahedron][edge].as_u64().unwrap_or(u64::MAX) as usize;
            let length = structure.lengths()[skeleton.edges_of(tetrahedron as u32)[edge] as usize];
            all.push((length, &record["edgeLengths"][class]));
        }
    }
    let difference = |(found, known): &(Enclosure, &Value)| (found.middle() - known.as_f64().unwrap_or(f64::NAN)).abs();
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    (largest(&mut all.iter().map(difference)), largest(&mut all.iter().map(|(found, _)| found.width())))
}
