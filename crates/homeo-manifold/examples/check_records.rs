//! Reads files of records and compares the signatures that they state with those computed.
//!
//! ```sh
//! cargo run --release -p homeo-manifold --example check_records -- testdata/hyperbolic/census.json
//! ```
#![allow(clippy::print_stdout)] // a program that prints its findings

use homeo_manifold::{from_signature, read_records, signature};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut agreeing, mut differing) = (0, 0);
    for path in std::env::args().skip(1) {
        for (number, record) in read_records(&std::fs::read_to_string(&path)?)?.into_iter().enumerate() {
            let computed = signature(&record.triangulation);
            let stated = record.signature.unwrap_or_default();
            if computed == stated && signature(&from_signature(&stated)?) == stated {
                agreeing += 1;
            } else {
                differing += 1;
                println!("{path}, record {number}: {stated} is stated, {computed} is computed");
            }
        }
    }
    println!("{agreeing} agree, {differing} differ");
    if differing == 0 { Ok(()) } else { Err("signatures differ".into()) }
}
