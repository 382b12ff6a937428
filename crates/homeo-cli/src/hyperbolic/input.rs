//! What `homeo hyperbolic` reads: records of gluings, signatures, meshes of solids.

use std::path::Path;

use homeo::progress::Progress;
use homeo_core::io::Format;
use homeo_manifold::{
    RecordError, SignatureError, Triangulation, from_signature, read_record, read_record_of, read_records, signature,
};
use serde_json::{Value, json};

use super::solid;
use crate::args::HyperbolicArgs;
use crate::failure::{Failure, Result};
use crate::session::Session;
use crate::text::file_name;

/// So many entries of a file are named where one that was asked for is not there.
const NAMED: usize = 8;

/// So many characters are shown of what is no signature.
const SHOWN: usize = 60;

/// A triangulation and where it is from.
pub struct Input {
    /// Its faces glued as the input says, or those of a simplified triangulation of a solid.
    pub triangulation: Triangulation,
    /// What to call it.
    pub name: String,
    /// Whether the triangulation was made here, so that another one of the manifold is as good.
    pub is_free: bool,
}

/// Reads what the command line names.
///
/// # Errors
/// What is wrong with it.
pub fn read(session: &Session, options: &HyperbolicArgs) -> Result<Input> {
    session.stage("read");
    if let Some(text) = &options.signature {
        session.fact("input", json!({"signature": text}));
        let triangulation = of_signature(text, "")?;
        return Ok(Input { triangulation, name: text.trim().to_owned(), is_free: false });
    }
    let Some(path) = options.input.as_deref() else {
        return Err(Failure::usage("give INPUT, or --signature"));
    };
    let input = match Format::of_path(path) {
        Some(Format::Json) => match gluings(session, path)? {
            Some(text) => of_records(session, &text, path, options.entry.as_deref())?,
            None => of_mesh(session, path)?,
        },
        Some(_) => of_mesh(session, path)?,
        None => {
            let text = text_of(session, path)?;
            let triangulation = of_signature(&text, &format!("{}: ", path.display()))?;
            Input { triangulation, name: file_name(path), is_free: false }
        }
    };
    if options.entry.is_some() && input.is_free {
        return Err(Failure::usage("--entry picks a record of a JSON file; a mesh has none"));
    }
    session.check()?;
    Ok(input)
}

fn of_mesh(session: &Session, path: &Path) -> Result<Input> {
    let triangulation = solid::read(session, path)?;
    Ok(Input { triangulation, name: file_name(path), is_free: true })
}

/// The triangulation of a signature from `place`; files that hold something else may be long.
fn of_signature(text: &str, place: &str) -> Result<Triangulation> {
    let refused = |error: SignatureError| {
        let start: String = text.trim().chars().take(SHOWN).collect();
        let rest = if text.trim().chars().nth(SHOWN).is_some() { "..." } else { "" };
        let advice = if text.trim_start().starts_with(['{', '[']) { "; records are read from files .json" } else { "" };
        Failure::input("bad-signature", format!("{place}{start:?}{rest} is no signature: {error}{advice}"))
    };
    from_signature(text).map_err(refused)
}

fn text_of(session: &Session, path: &Path) -> Result<String> {
    session.fact("input", json!({"path": path.display().to_string()}));
    std::fs::read_to_string(path)
        .map_err(|e| Failure::input("cannot-open", format!("{} cannot be read: {e}", path.display())))
}

/// The text of a JSON file, if it is one of gluings.
fn gluings(session: &Session, path: &Path) -> Result<Option<String>> {
    let text = text_of(session, path)?;
    let value: Value =
        serde_json::from_str(&text).map_err(|e| Failure::input("bad-syntax", format!("{}: {e}", path.display())))?;
    Ok(value.get("facets").is_none().then_some(text))
}

fn of_records(session: &Session, text: &str, path: &Path, entry: Option<&str>) -> Result<Input> {
    let record = match entry {
        Some(entry) => read_record_of(text, entry),
        None => read_record(text),
    };
    let record = record.map_err(|error| refused(&error, text, path))?;
    let found = signature(&record.triangulation);
    if let Some(stated) = record.signature.as_ref().filter(|stated| **stated != found) {
        session.display().note(&format!("the record states isoSig {stated}, but its gluings have {found}"));
    }
    let name = record.signature.map_or_else(|| file_name(path), |stated| format!("{} ({stated})", file_name(path)));
    Ok(Input { triangulation: record.triangulation, name, is_free: false })
}

/// The failure for records, with names of those that there are where one has to be picked.
fn refused(error: &RecordError, text: &str, path: &Path) -> Failure {
    let (code, advice) = match error {
        RecordError::SeveralRecords { .. } => ("several-records", format!(" with --entry: {}", entries(text))),
        RecordError::NoSignature { .. } => ("unknown-entry", format!("; there are {}", entries(text))),
        _ => ("bad-record", String::new()),
    };
    Failure::input(code, format!("{}: {error}{advice}", path.display()))
}

/// The first signatures that are stated.
fn entries(text: &str) -> String {
    let records = read_records(text).unwrap_or_default();
    let stated: Vec<String> = records.into_iter().filter_map(|record| record.signature).collect();
    let more = if stated.len() > NAMED { format!(", and {} more", stated.len() - NAMED) } else { String::new() };
    let first: Vec<&str> = stated.iter().take(NAMED).map(String::as_str).collect();
    if first.is_empty() { "none that states an isoSig".to_owned() } else { first.join(", ") + &more }
}
