use super::*;

const TRIPUS: &str = include_str!("../../../../testdata/hyperbolic/tripus.json");
const CENSUS: &str = include_str!("../../../../testdata/hyperbolic/census.json");

fn one(rows: &str) -> Result<Record, RecordError> {
    read_record(&format!("{{\"tetrahedra\": 2, \"gluings\": [{rows}]}}"))
}

#[test]
fn files_of_all_three_shapes_are_read() {
    let tripus = read_record(TRIPUS).unwrap();
    assert_eq!(tripus.signature.as_deref(), Some("cPcbbbihq"));
    assert!(tripus.triangulation.is_closed());
    let census = read_records(CENSUS).unwrap();
    assert_eq!(census.len(), 16);
    assert_eq!(read_record(CENSUS), Err(RecordError::SeveralRecords { count: 16 }));
    let picked = read_record_of(CENSUS, "dLQacccjcog").unwrap();
    assert_eq!(picked.triangulation.len(), 3);
    assert!(census.contains(&picked));
    assert_eq!(read_record_of(TRIPUS, "cPcbbbihq").unwrap(), tripus);
    let absent = RecordError::NoSignature { signature: "a".to_owned() };
    assert_eq!(read_record_of(CENSUS, "a"), Err(absent.clone()));
    assert_eq!(read_record_of(TRIPUS, "a"), Err(absent));
}

#[test]
fn what_is_written_is_read() {
    for record in read_records(CENSUS).unwrap() {
        let again = read_record(&write_record(&record.triangulation)).unwrap();
        assert_eq!(again, Record { signature: None, ..record });
    }
    let lone = Triangulation::new(3);
    assert_eq!(read_record(&write_record(&lone)).unwrap().triangulation, lone);
}

#[test]
fn wrong_rows_are_named() {
    let good = "[0, 0, 1, [0, 1, 2, 3]], [1, 0, 0, [0, 1, 2, 3]]";
    assert!(one(good).is_ok());
    let row = |images| RecordError::NoPermutation { row: 0, images };
    assert_eq!(one("[0, 0, 1, [0, 1, 2, 2]]"), Err(row([0, 1, 2, 2])));
    assert_eq!(one("[0, 0, 1, [0, 1, 2, 9]]"), Err(row([0, 1, 2, 9])));
    let gluing = |row, source| Err(RecordError::Gluing { row, source });
    assert_eq!(one("[0, 4, 1, [0, 1, 2, 3]]"), gluing(0, GluingError::NoFace { tetrahedron: 0, face: 4 }));
    assert_eq!(one("[0, 0, 2, [0, 1, 2, 3]]"), gluing(0, GluingError::NoTetrahedron { tetrahedron: 2, count: 2 }));
    assert_eq!(one("[7, 0, 1, [0, 1, 2, 3]]"), gluing(0, GluingError::NoTetrahedron { tetrahedron: 7, count: 2 }));
    assert_eq!(one("[0, 0, 0, [0, 2, 1, 3]]"), gluing(0, GluingError::FaceToItself { tetrahedron: 0, face: 0 }));
    assert_eq!(one("[0, 0, 1, [0, 1, 2, 3]]"), Err(RecordError::OneSided { row: 0, tetrahedron: 1, face: 0 }));
    let repeated = format!("{good}, [0, 0, 1, [0, 1, 2, 3]]");
    assert_eq!(one(&repeated), Err(RecordError::Contradiction { row: 2, other: 0 }));
    let turned = "[0, 0, 1, [0, 1, 2, 3]], [1, 0, 0, [0, 2, 1, 3]]";
    assert_eq!(one(turned), Err(RecordError::Contradiction { row: 1, other: 0 }));
    let taken = format!("{good}, [0, 1, 1, [1, 0, 2, 3]]");
    assert_eq!(one(&taken), gluing(2, GluingError::FaceTaken { tetrahedron: 1, face: 0 }));
}

#[test]
fn files_that_are_no_records_are_refused() {
    let is_json = |text: &str| matches!(read_record(text), Err(RecordError::Json { .. }));
    assert!(is_json("") && is_json("[") && is_json("{\"tetrahedra\": -1, \"gluings\": []}"));
    assert!(is_json("{\"tetrahedra\": 1, \"gluings\": [[0, 0, 0]]}"));
    assert!(is_json(&"[".repeat(100_000)));
    assert!(is_json(&format!("{{\"other\": {}", "[".repeat(100_000))));
    assert_eq!(read_record("{}"), Err(RecordError::NoRecord));
    assert_eq!(read_record("{\"triangulations\": []}"), Err(RecordError::NoRecord));
    assert_eq!(read_record("{\"tetrahedra\": 1}"), Err(RecordError::NoField { field: "gluings" }));
    let listed = "{\"triangulations\": [{\"tetrahedra\": 1, \"gluings\": []}, {\"gluings\": []}]}";
    let source = Box::new(RecordError::NoField { field: "tetrahedra" });
    assert_eq!(read_records(listed), Err(RecordError::InList { record: 1, source }));
}

#[test]
fn an_announced_number_takes_no_memory() {
    for count in [100_000, u64::from(u32::MAX) + 1, u64::MAX] {
        let text = format!("{{\"tetrahedra\": {count}, \"gluings\": []}}");
        assert_eq!(read_record(&text), Err(RecordError::TooManyTetrahedra { count, rows: 0 }));
    }
}

#[test]
fn damaged_files_do_not_panic() {
    let bytes = TRIPUS.as_bytes();
    let (mut read, mut refused) = (0, 0);
    for position in 0..bytes.len() {
        for replacement in *b"09-[]\", " {
            let mut damaged = bytes.to_vec();
            damaged[position] = replacement;
            match read_record(&String::from_utf8_lossy(&damaged)) {
                Ok(_) => read += 1,
                Err(_) => refused += 1,
            }
        }
        assert!(position + 3 > bytes.len() || read_record(&TRIPUS[..position]).is_err());
    }
    assert!(read > 5_000 && refused > 5_000, "{read} read, {refused} refused");
}
