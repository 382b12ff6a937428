//! The example that `docs/certificate-format-v1.md` prints is a valid map, and the file it names holds it.

mod support;

use homeo_verify::{Verdict, verify_bytes};
use serde_json::{Value, from_value};
use support::{Map, write};

const PAGE: &str = include_str!("../../../docs/certificate-format-v1.md");
const FILE: &[u8] = include_bytes!("data/example.homeo");

/// The map printed between the first ```` ```json arrays ```` fence and its end.
fn printed() -> Map {
    let text = PAGE.split("```json arrays\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let mut arrays: Value = serde_json::from_str(text).expect("valid JSON");
    let mut take = |name: &str| arrays[name].take();
    let mut map = Map::new("", "square", vec![], vec![]);
    map.manifest = take("manifest.json");
    map.positions = from_value(take("source_positions")).expect("numbers");
    map.source_cells = from_value(take("source_cells")).expect("indices");
    map.directions = from_value(take("directions")).expect("small numbers");
    map.lengths = from_value(take("lengths")).expect("numbers");
    map.section_vertices = from_value(take("section_vertices")).expect("indices");
    let coordinates: Vec<f64> = from_value(take("section_coordinates")).expect("numbers");
    map.section_coordinates = coordinates.into_iter().map(|x| vec![x]).collect();
    map
}

#[test]
fn the_printed_example_is_certified_and_is_the_file() {
    let map = printed();
    assert_eq!(map.manifest["source"]["content_sha256"], write::content_hash(&map));
    let verdict = verify_bytes(&map.bytes());
    assert!(matches!(verdict, Ok(Verdict::Certified(_))), "{verdict:?}");
    if std::env::var_os("HOMEO_WRITE_EXAMPLE").is_some() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/example.homeo");
        std::fs::write(path, map.bytes()).expect("a place to write to");
        return;
    }
    assert!(
        map.bytes() == FILE,
        "regenerate the file: HOMEO_WRITE_EXAMPLE=1 cargo test -p homeo-verify worked_example"
    );
}
