//! The reference data of the tests.

use crate::permutation::Permutation;
use crate::triangulation::Triangulation;
use serde_json::Value;

/// A triangulation with what is known of it.
pub(crate) struct Entry {
    pub(crate) name: String,
    pub(crate) triangulation: Triangulation,
    pub(crate) geometry: Option<Geometry>,
}

/// The known structure, by tetrahedra.
pub(crate) struct Geometry {
    pub(crate) lengths: Vec<[f64; 6]>,
    pub(crate) angles: Vec<[f64; 6]>,
    pub(crate) volume: f64,
}

/// The census in the test data, and the tripus as its last entry.
pub(crate) fn census() -> Vec<Entry> {
    let read = |text: &str| serde_json::from_str::<Value>(text).unwrap();
    let census = read(include_str!("../../../../testdata/hyperbolic/census.json"));
    let tripus = read(include_str!("../../../../testdata/hyperbolic/tripus.json"));
    let records = census["triangulations"].as_array().unwrap().iter().chain([&tripus["triangulation"]]);
    records.map(entry).collect()
}

fn entry(record: &Value) -> Entry {
    let tetrahedra = record["tetrahedra"].as_u64().unwrap() as usize;
    let mut triangulation = Triangulation::new(tetrahedra);
    for row in record["gluings"].as_array().unwrap() {
        let [tetrahedron, face, other] = [0, 1, 2].map(|k| row[k].as_u64().unwrap() as u32);
        let corners = Permutation::new([0, 1, 2, 3].map(|k| row[3][k].as_u64().unwrap() as u8)).unwrap();
        if triangulation.neighbour(tetrahedron, face as u8).is_none() {
            triangulation.glue(tetrahedron, face as u8, other, corners).unwrap();
        }
    }
    let geometry = (record["status"] == "positive").then(|| {
        let six = |row: &Value, of: &dyn Fn(&Value) -> f64| [0, 1, 2, 3, 4, 5].map(|k| of(&row[k]));
        let length = |class: &Value| record["edgeLengths"][class.as_u64().unwrap() as usize].as_f64().unwrap();
        let rows = |name: &str, of: &dyn Fn(&Value) -> f64| {
            record[name].as_array().unwrap().iter().map(|row| six(row, of)).collect::<Vec<_>>()
        };
        Geometry {
            lengths: rows("edgeClasses", &length),
            angles: rows("dihedralAngles", &|value| value.as_f64().unwrap()),
            volume: record["volume"].as_f64().unwrap(),
        }
    });
    Entry { name: record["isoSig"].as_str().unwrap_or_default().to_owned(), triangulation, geometry }
}
