//! Reads files of records and compares what they state with what is computed: signatures, both ways, automorphisms,
//! first homology, and the homology of coverings.
//!
//! ```sh
//! cargo run --release -p homeo-manifold --example check_records -- testdata/hyperbolic/census.json
//! ```
#![allow(clippy::print_stdout)] // a program that prints its findings

use homeo_manifold::{Homology, Triangulation, automorphism_count, covers, from_signature, read_records, signature};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut differing = 0;
    for path in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&path)?;
        let file: Value = serde_json::from_str(&text)?;
        let mut compared: BTreeMap<&str, usize> = BTreeMap::new();
        for (number, record) in read_records(&text)?.into_iter().enumerate() {
            let rows = [file["triangulations"].get(number), file.get("triangulation")];
            let stated = rows.into_iter().flatten().next().unwrap_or(&file);
            for (field, computed) in computed(&record.triangulation, stated)? {
                *compared.entry(field).or_default() += 1;
                if stated[field] != computed {
                    differing += 1;
                    println!("{path}, record {number}: {field} is stated as {}, computed as {computed}", stated[field]);
                }
            }
        }
        println!("{path}: compared {compared:?}");
    }
    println!("{differing} differ");
    if differing == 0 { Ok(()) } else { Err("what is stated and what is computed differ".into()) }
}

/// The fields that a record states, as computed.
fn computed(triangulation: &Triangulation, stated: &Value) -> Result<Vec<(&'static str, Value)>, Box<dyn Error>> {
    let name = signature(triangulation);
    let decoded = signature(&from_signature(&name)?);
    let mut fields = vec![("isoSig", json!(if decoded == name { name } else { decoded }))];
    fields.push(("automorphisms", json!(automorphism_count(triangulation))));
    fields.push(("H1", json!(Homology::new(triangulation).to_string())));
    let mut lists = Vec::new();
    for sheets in stated["covers"].as_array().into_iter().flatten().filter_map(|list| list[0].as_u64()) {
        let mut groups: BTreeMap<String, usize> = BTreeMap::new();
        for cover in covers(triangulation, sheets as usize)? {
            *groups.entry(Homology::new(&cover).to_string()).or_default() += 1;
        }
        lists.push(json!([sheets, groups.into_iter().collect::<Vec<_>>()]));
    }
    if !lists.is_empty() {
        fields.push(("covers", Value::Array(lists)));
    }
    fields.retain(|(field, _)| !stated[field].is_null());
    Ok(fields)
}
