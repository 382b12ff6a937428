//! Files of hyperbolic structures: what is proved here is certified by the independent checker.

use homeo::certificate::{Provenance, write_hyperbolic};
use homeo_manifold::hyperbolic::Structure;
use homeo_manifold::{Permutation, Skeleton, Triangulation};
use homeo_verify::{Verdict, verify_bytes};
use serde_json::Value;
use std::io::Cursor;

fn triangulations() -> Vec<Triangulation> {
    let census: Value = serde_json::from_str(include_str!("../../../testdata/hyperbolic/census.json")).unwrap();
    let records = census["triangulations"].as_array().unwrap().iter();
    let number = |value: &Value| value.as_u64().unwrap() as u32;
    let triangulation = |record: &Value| {
        let mut triangulation = Triangulation::new(number(&record["tetrahedra"]) as usize);
        for row in record["gluings"].as_array().unwrap() {
            let (tetrahedron, face) = (number(&row[0]), number(&row[1]) as u8);
            let corners = Permutation::new([0, 1, 2, 3].map(|k| number(&row[3][k]) as u8)).unwrap();
            if triangulation.neighbour(tetrahedron, face).is_none() {
                triangulation.glue(tetrahedron, face, number(&row[2]), corners).unwrap();
            }
        }
        triangulation
    };
    records.filter(|record| record["status"] == "positive").map(triangulation).collect()
}

#[test]
fn files_of_structures_are_certified_and_the_same_each_time() {
    let mut count = 0;
    for triangulation in triangulations() {
        let structure = Structure::find(&triangulation, &Skeleton::new(&triangulation)).unwrap();
        let write = || {
            let mut out = Cursor::new(Vec::new());
            write_hyperbolic(&triangulation, &structure, &Provenance::default(), &mut out).unwrap();
            out.into_inner()
        };
        let bytes = write();
        assert_eq!(bytes, write());
        let verdict = verify_bytes(&bytes);
        assert!(matches!(verdict, Ok(Verdict::Certified(_))), "{verdict:?}");
        count += 1;
    }
    assert!(count >= 10, "{count}");
}

/// Negative control: the structure of one triangulation is none of another.
#[test]
fn a_structure_of_another_triangulation_is_not_certified() {
    let all = triangulations();
    let [large, small] = [18, 12].map(|degree| {
        all.iter()
            .find(|t| Skeleton::new(t).edges()[0].corners.len() == degree && Skeleton::new(t).edges().len() == 1)
            .unwrap()
    });
    let structure = Structure::find(small, &Skeleton::new(small)).unwrap();
    let mut out = Cursor::new(Vec::new());
    write_hyperbolic(large, &structure, &Provenance::default(), &mut out).unwrap();
    match verify_bytes(&out.into_inner()) {
        Ok(Verdict::Refuted(witness)) => assert_eq!(witness.rule, "Y7"),
        other => panic!("{other:?}"),
    }
}
