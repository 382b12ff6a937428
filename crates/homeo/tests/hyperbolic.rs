//! Files of hyperbolic structures: what is proved here is certified by the independent checker.

use homeo::certificate::{MapFileError, Provenance, kind_of, read_hyperbolic, read_map, write_hyperbolic};
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

fn written(triangulation: &Triangulation) -> Vec<u8> {
    let structure = Structure::find(triangulation, &Skeleton::new(triangulation)).unwrap();
    let mut out = Cursor::new(Vec::new());
    write_hyperbolic(triangulation, &structure, &Provenance::default(), &mut out).unwrap();
    out.into_inner()
}

#[test]
fn what_was_written_is_read_and_proved_again() {
    let mut count = 0;
    for triangulation in triangulations() {
        let bytes = written(&triangulation);
        assert_eq!(kind_of(&bytes).as_deref(), Some("hyperbolic"));
        assert!(matches!(read_map(&bytes), Err(MapFileError::NoMap)));
        let read = read_hyperbolic(&bytes).unwrap();
        assert_eq!(read.triangulation, triangulation);
        let first = Structure::find(&triangulation, &Skeleton::new(&triangulation)).unwrap();
        for (again, length) in read.structure.lengths().iter().zip(first.lengths()) {
            assert!(again.common(*length).is_some() && again.width() < 1e-9, "{again:?} {length:?}");
        }
        count += 1;
    }
    assert!(count >= 10, "{count}");
}

/// Damaged files: an error, or the structure, as there is only one; never another one, and no panic.
#[test]
fn damaged_files_are_refused_or_hold_the_same_structure() {
    let triangulation = &triangulations()[0];
    let bytes = written(triangulation);
    let volume = read_hyperbolic(&bytes).unwrap().structure.volume();
    let (mut refused, mut same, mut other) = (0, 0, 0);
    for place in 0..bytes.len() {
        for change in [0x01, 0x10, 0xff] {
            let mut damaged = bytes.clone();
            damaged[place] ^= change;
            match read_hyperbolic(&damaged) {
                Err(_) => refused += 1,
                Ok(read) if read.triangulation == *triangulation => {
                    assert!(read.structure.volume().common(volume).is_some());
                    same += 1;
                }
                Ok(_) => other += 1,
            }
        }
    }
    for length in 0..bytes.len() {
        assert!(read_hyperbolic(&bytes[..length]).is_err(), "{length}");
    }
    // Sums of the archive are over each array.
    assert!(refused > 1000 && same > 100 && other == 0, "{refused} {same} {other}");
}
