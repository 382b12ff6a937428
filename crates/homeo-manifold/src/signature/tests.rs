use super::*;
use crate::record::{read_record, read_records};
use crate::sample::{Random, random_gluings, relabelled, with_one_gluing_turned};
use crate::triangulation::GluingError;

const TRIPUS: &str = include_str!("../../../../testdata/hyperbolic/tripus.json");
const CENSUS: &str = include_str!("../../../../testdata/hyperbolic/census.json");

#[test]
fn signatures_are_those_of_the_census() {
    let mut records = read_records(CENSUS).unwrap();
    records.push(read_record(TRIPUS).unwrap());
    let file: serde_json::Value = serde_json::from_str(CENSUS).unwrap();
    for (number, record) in records.iter().enumerate() {
        let stated = record.signature.as_deref().unwrap();
        assert_eq!(signature(&record.triangulation), stated);
        assert_eq!(signature(&from_signature(stated).unwrap()), stated);
        if let Some(row) = file["triangulations"].get(number) {
            assert_eq!(automorphism_count(&record.triangulation), row["automorphisms"].as_u64().map(|n| n as usize));
        }
    }
    assert_eq!(records.len(), 17);
}

#[test]
fn signatures_known_from_elsewhere() {
    // The complement of the figure eight knot and its sister, as SnapPy and Regina print them; nothing at all.
    for known in ["cPcbbbiht", "cPcbbbdxm", "a"] {
        assert_eq!(signature(&from_signature(known).unwrap()), known);
    }
    assert_eq!(signature(&Triangulation::new(1)), "baa");
}

#[test]
fn labels_make_no_difference_and_gluings_do() {
    let mut random = Random(1);
    let (mut same, mut other) = (0, 0);
    for round in 0..400 {
        let triangulation = random_gluings(&mut random, 1 + round % 9, round % 3);
        let text = signature(&triangulation);
        let renamed = relabelled(&mut random, &triangulation);
        assert_eq!(signature(&renamed), text);
        let decoded = from_signature(&text).unwrap();
        assert_eq!(decoded.len(), triangulation.len());
        assert_eq!(signature(&decoded), text);
        same += usize::from(renamed == triangulation);
        // The control: one gluing turned gives another signature, but for the few where that is a symmetry.
        let Some(turned) = with_one_gluing_turned(&triangulation) else { continue };
        other += usize::from(signature(&turned) != text);
    }
    assert!(same < 40, "{same} of 400 relabellings change nothing");
    assert!(other > 300, "only {other} of 400 turned gluings are told apart");
}

#[test]
fn large_ones_are_signed_too() {
    let mut random = Random(2);
    for tetrahedra in [62, 63, 64, 200, 5_000] {
        let triangulation = random_gluings(&mut random, tetrahedra, 0);
        assert_eq!(components(&triangulation).len(), 1);
        let text = signature(&triangulation);
        assert_eq!(text.starts_with('-'), tetrahedra > 62);
        assert_eq!(signature(&from_signature(&text).unwrap()), text);
        assert_eq!(signature(&relabelled(&mut random, &triangulation)), text);
    }
}

#[test]
fn pieces_are_signed_one_by_one() {
    let text = signature(&from_signature("cPcbbbihtbaabkaagj").unwrap());
    assert_eq!(text, "baabkaagjcPcbbbiht");
    let decoded = from_signature(&text).unwrap();
    assert_eq!((decoded.len(), components(&decoded).len()), (4, 3));
    assert_eq!(automorphism_count(&decoded), None);
}

#[test]
fn what_is_no_signature_is_refused() {
    use SignatureError::*;
    assert_eq!(from_signature(""), Err(Short { length: 0 }));
    assert_eq!(from_signature("c!"), Err(Character { place: 1, found: '!' }));
    assert_eq!(from_signature("cPcbbbih"), Err(Short { length: 8 }));
    assert_eq!(from_signature("cPcbbbih9"), Err(Permutation { place: 8, value: 61 }));
    assert_eq!(from_signature("cPcccbihq"), Err(Destination { place: 3, destination: 2 }));
    assert_eq!(from_signature("cdcbbbihq"), Err(Faces { place: 1 }));
    assert_eq!(from_signature("zzz"), Err(Size { place: 0, count: 25 }));
    let huge = format!("-{}{}", "9", "9".repeat(60));
    assert!(matches!(from_signature(&huge), Err(Size { place: 0, .. } | Short { .. })));
    // Face 0 of the tetrahedron onto itself: the first gluing of a single one, by the identity.
    let to_itself = GluingError::FaceToItself { tetrahedron: 0, face: 0 };
    assert_eq!(from_signature("bkaaaa"), Err(Gluing { place: 4, source: to_itself }));
}

#[test]
fn damaged_signatures_do_not_panic() {
    let mut random = Random(3);
    let (mut read, mut refused) = (0, 0);
    for round in 0..200 {
        let text = signature(&random_gluings(&mut random, 1 + round % 80, round % 2));
        for _ in 0..200 {
            let mut damaged = text.clone().into_bytes();
            let place = random.below(damaged.len());
            damaged[place] = CHARACTERS[random.below(64)];
            damaged.truncate(1 + random.below(8 * text.len()));
            match from_signature(std::str::from_utf8(&damaged).unwrap()) {
                Ok(_) => read += 1,
                Err(_) => refused += 1,
            }
        }
    }
    assert!(read > 1_000 && refused > 1_000, "{read} read, {refused} refused");
}
