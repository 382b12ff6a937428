//! Records of gluings as JSON: what a census of triangulations is kept in.
//!
//! A record is an object with the fields `tetrahedra` and `gluings`, and perhaps `isoSig`; other fields are passed
//! over. A row of `gluings` is `[tetrahedron, face, other tetrahedron, [p0, p1, p2, p3]]`: the face opposite the corner
//! `face` is glued to the face of the other tetrahedron opposite `p[face]`, and the corner `i` goes to the corner
//! `p[i]`. Every gluing has two rows, one from each side; a face without a row is boundary. A file is one record, an
//! object with a record under `triangulation`, or an object with a list of records under `triangulations`.

use crate::permutation::Permutation;
use crate::triangulation::{Gluing, GluingError, Triangulation};
use serde::Deserialize;
use std::fmt::Write;
use thiserror::Error;

/// A triangulation with the signature that its record states.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Record {
    /// The signature as stated; it is not compared with the triangulation (see [`signature`](crate::signature())).
    pub signature: Option<String>,
    /// The gluings.
    pub triangulation: Triangulation,
}

/// Why a record cannot be read.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum RecordError {
    #[error(
        "line {line}, column {column}: {reason}; a record has `tetrahedra` and rows [tet, face, tet, [p0, p1, p2, p3]]"
    )]
    Json { line: usize, column: usize, reason: String },
    #[error(
        "there is no record: give `tetrahedra` and `gluings`, or records under `triangulation` or `triangulations`"
    )]
    NoRecord,
    #[error("the record has no field `{field}`")]
    NoField { field: &'static str },
    #[error("there are {count} records: pick one by its isoSig")]
    SeveralRecords { count: usize },
    #[error("no record has the isoSig {signature}")]
    NoSignature { signature: String },
    #[error("{count} tetrahedra are announced and {rows} rows of gluings given: that is no connected triangulation")]
    TooManyTetrahedra { count: u64, rows: usize },
    #[error("row {row}: {images:?} is no permutation of 0, 1, 2, 3")]
    NoPermutation { row: usize, images: [u8; 4] },
    #[error("row {row}: {source}")]
    Gluing { row: usize, source: GluingError },
    #[error("row {row} and row {other} are of the same face or do not agree: a face has one row, and one other side")]
    Contradiction { row: usize, other: usize },
    #[error("row {row} is not given from its other side: add the row of face {face} of tetrahedron {tetrahedron}")]
    OneSided { row: usize, tetrahedron: u32, face: u8 },
    #[error("record {record}, counted from 0: {source}")]
    InList { record: usize, source: Box<RecordError> },
}

type Row = (u32, u8, u32, [u8; 4]);

#[derive(Deserialize)]
struct Stored {
    #[serde(rename = "isoSig")]
    signature: Option<String>,
    tetrahedra: Option<u64>,
    gluings: Option<Vec<Row>>,
}

#[derive(Deserialize)]
struct File {
    #[serde(rename = "isoSig")]
    signature: Option<String>,
    tetrahedra: Option<u64>,
    gluings: Option<Vec<Row>>,
    triangulation: Option<Stored>,
    triangulations: Option<Vec<Stored>>,
}

/// Tetrahedra beyond those that rows speak of that a record may announce.
const LONE_TETRAHEDRA: u64 = 1 << 16;

/// Reads the one record of a file.
///
/// # Errors
/// What is wrong, with the row; [`RecordError::SeveralRecords`] when there are several.
///
/// # Example
/// ```
/// use homeo_manifold::record::{read_record, write_record};
/// let text = r#"{"tetrahedra": 1, "gluings": [[0, 0, 0, [1, 0, 2, 3]], [0, 1, 0, [1, 0, 2, 3]]]}"#;
/// let ball = read_record(text)?.triangulation;
/// assert_eq!(ball.boundary_faces().count(), 2);
/// assert_eq!(read_record(&write_record(&ball))?.triangulation, ball);
/// # Ok::<(), homeo_manifold::record::RecordError>(())
/// ```
pub fn read_record(text: &str) -> Result<Record, RecordError> {
    let mut records = read_records(text)?;
    match (records.pop(), records.len()) {
        (Some(record), 0) => Ok(record),
        (None, _) => Err(RecordError::NoRecord),
        (Some(_), others) => Err(RecordError::SeveralRecords { count: others + 1 }),
    }
}

/// Reads all records of a file, in their order.
///
/// Memory is within a small multiple of the file. Cost: linear.
///
/// # Errors
/// What is wrong, with the row, and with the record if there is a list.
pub fn read_records(text: &str) -> Result<Vec<Record>, RecordError> {
    let file = parsed(text)?;
    if let Some(list) = file.triangulations {
        let in_list = |record| move |source| RecordError::InList { record, source: Box::new(source) };
        return list.into_iter().enumerate().map(|(number, stored)| record(stored).map_err(in_list(number))).collect();
    }
    single(file).map(|record| vec![record])
}

/// Reads the record with a signature; the others are not looked into beyond their JSON.
///
/// # Errors
/// What is wrong with it, or [`RecordError::NoSignature`].
pub fn read_record_of(text: &str, signature: &str) -> Result<Record, RecordError> {
    let mut file = parsed(text)?;
    let is_meant = |stated: &Option<String>| stated.as_deref() == Some(signature);
    match file.triangulations.take() {
        Some(list) => match list.into_iter().find(|stored| is_meant(&stored.signature)) {
            Some(stored) => record(stored),
            None => Err(RecordError::NoSignature { signature: signature.to_owned() }),
        },
        None => {
            let record = single(file)?;
            let is_found = is_meant(&record.signature);
            is_found.then_some(record).ok_or_else(|| RecordError::NoSignature { signature: signature.to_owned() })
        }
    }
}

/// The record of a triangulation: `tetrahedra`, and `gluings` with a row on each line. No signature is stated.
pub fn write_record(triangulation: &Triangulation) -> String {
    let mut text = format!("{{\"tetrahedra\": {}, \"gluings\": [", triangulation.len());
    let glued = triangulation.faces().filter_map(|(t, face)| Some((t, face, triangulation.neighbour(t, face)?)));
    for (row, (tetrahedron, face, there)) in glued.enumerate() {
        let comma = if row == 0 { "" } else { "," };
        let (other, images) = (there.tetrahedron, there.corners.images());
        // Writing into a string does not fail.
        let _ = write!(text, "{comma}\n [{tetrahedron}, {face}, {other}, {images:?}]");
    }
    text.push_str("]}\n");
    text
}

fn parsed(text: &str) -> Result<File, RecordError> {
    serde_json::from_str(text).map_err(|error| RecordError::Json {
        line: error.line(),
        column: error.column(),
        reason: error.to_string(),
    })
}

fn single(file: File) -> Result<Record, RecordError> {
    if let Some(stored) = file.triangulation {
        return record(stored);
    }
    if file.tetrahedra.is_none() && file.gluings.is_none() {
        return Err(RecordError::NoRecord);
    }
    record(Stored { signature: file.signature, tetrahedra: file.tetrahedra, gluings: file.gluings })
}

fn record(stored: Stored) -> Result<Record, RecordError> {
    let count = stored.tetrahedra.ok_or(RecordError::NoField { field: "tetrahedra" })?;
    let rows = stored.gluings.ok_or(RecordError::NoField { field: "gluings" })?;
    // A number in a file must not make the memory that it asks for; 2^32 and more cannot be numbered.
    let bound = (rows.len() as u64 + LONE_TETRAHEDRA).min(u64::from(u32::MAX));
    if count > bound {
        return Err(RecordError::TooManyTetrahedra { count, rows: rows.len() });
    }
    let triangulation = glued(count as usize, &rows)?;
    Ok(Record { signature: stored.signature, triangulation })
}

fn glued(count: usize, rows: &[Row]) -> Result<Triangulation, RecordError> {
    let mut triangulation = Triangulation::new(count);
    // The row of each face that has one.
    let mut row_of = vec![[None; 4]; count];
    for (row, &(tetrahedron, face, other, images)) in rows.iter().enumerate() {
        let at_row = |source| RecordError::Gluing { row, source };
        let corners = Permutation::new(images).ok_or(RecordError::NoPermutation { row, images })?;
        let faces =
            row_of.get_mut(tetrahedron as usize).ok_or(at_row(GluingError::NoTetrahedron { tetrahedron, count }))?;
        let slot = faces.get_mut(usize::from(face)).ok_or(at_row(GluingError::NoFace { tetrahedron, face }))?;
        if let Some(other) = slot.replace(row) {
            return Err(RecordError::Contradiction { row, other });
        }
        match triangulation.neighbour(tetrahedron, face) {
            None => triangulation.glue(tetrahedron, face, other, corners).map_err(at_row)?,
            Some(known) if known == (Gluing { tetrahedron: other, corners }) => {}
            Some(known) => {
                let other = row_of[known.tetrahedron as usize][usize::from(known.corners.image(face))].unwrap_or(row);
                return Err(RecordError::Contradiction { row, other });
            }
        }
    }
    for (row, &(_, face, tetrahedron, images)) in rows.iter().enumerate() {
        let face = images[usize::from(face)];
        if row_of[tetrahedron as usize][usize::from(face)].is_none() {
            return Err(RecordError::OneSided { row, tetrahedron, face });
        }
    }
    Ok(triangulation)
}

#[cfg(test)]
mod tests;
