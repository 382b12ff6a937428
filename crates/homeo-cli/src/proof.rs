//! What the independent checker says, as JSON and in words.

use std::io::{self, Cursor, Seek, Write};
use std::path::Path;

use homeo::certificate::{FoliationMap, MapFileError, MovedMap, StoredMap, read_map};
use homeo::input::SourceMesh;
use homeo::progress::Progress;
use homeo_core::planar::PlanarDomain;
use homeo_verify::{Claim, Obstacle, Unreadable, Verdict, Witness, verify_bytes};
use serde_json::{Map, Value, json};

use crate::failure::{Exit, Failure, Result};
use crate::outputs::Outputs;
use crate::session::Session;

/// How many elements of a witness people see.
const SHOWN: usize = 10;

/// The `certificate` field where it holds.
pub fn claim_json(claim: &Claim) -> Value {
    let checked: Map<String, Value> = claim.checked.iter().map(|&(what, n)| (what.to_owned(), json!(n))).collect();
    json!({
        "kind": claim.kind, "target": claim.target, "holds": true, "checked": checked,
        "statement": claim.statement, "limits": claim.limits, "source_sha256": claim.source_sha256,
    })
}

/// That it holds, in words.
pub fn holds(claim: &Claim) -> String {
    let checks: u64 = claim.checked.iter().map(|c| c.1).sum();
    format!("holds ({checks} exact checks in {} rules)", claim.checked.len())
}

/// The witness as JSON.
pub fn witness_json(witness: &Witness) -> Value {
    json!({
        "rule": witness.rule, "message": witness.message, "cells": witness.cells,
        "vertices": witness.vertices, "points": witness.points,
    })
}

/// The witness in words.
pub fn witness_text(witness: &Witness) -> String {
    let list = |name: &str, numbers: &[u32]| {
        let shown: Vec<String> = numbers.iter().take(SHOWN).map(u32::to_string).collect();
        let more = if numbers.len() > SHOWN { ", ..." } else { "" };
        if numbers.is_empty() { String::new() } else { format!("\n  {name}: {}{more}", shown.join(", ")) }
    };
    let mut text = format!("rule {}: {}", witness.rule, witness.message);
    text.push_str(&list("cells", &witness.cells));
    text.push_str(&list("vertices", &witness.vertices));
    for [x, y, z] in witness.points.iter().take(SHOWN) {
        text.push_str(&format!("\n  at {x} {y} {z}"));
    }
    text
}

/// The failure for a map that is refuted.
pub fn refuted(exit: Exit, what: &str, witness: &Witness) -> Failure {
    let mut failure = Failure::new(exit, "refuted", format!("{what}: {}", witness_text(witness)));
    failure.fields.insert("witness".to_owned(), witness_json(witness));
    failure.with("certificate", json!({"holds": false, "rule": witness.rule}))
}

/// The failure for a map that cannot be decided.
pub fn undecided(obstacle: &Obstacle) -> Failure {
    Failure::limits("undecided", format!("the certificate is undecided: {}\n  {}", obstacle.message, obstacle.remedy))
        .with("certificate", json!({"holds": null, "obstacle": obstacle.message, "remedy": obstacle.remedy}))
}

/// The failure for bytes that are no map file.
pub fn unreadable(path: &Path, error: &Unreadable) -> Failure {
    Failure::input("unreadable-map", format!("{}: {error}", path.display()))
}

/// Where the bytes of a map go.
pub trait Sink: Write + Seek {}
impl<W: Write + Seek> Sink for W {}

/// Writes a map where it will be, or only into memory, reads it back and has it checked.
///
/// # Errors
/// When it cannot be written, or its certificate does not hold.
pub fn write_and_check(
    session: &Session,
    path: Option<&Path>,
    outputs: &mut Outputs,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> Result<Claim> {
    let bytes = written(session, path, outputs, write)?;
    session.stage("certificate");
    let claim = check_own(&bytes)?;
    session.check()?;
    Ok(claim)
}

/// The same for a map that need not be one: the checker's witness is the answer then, as exit code 4.
///
/// # Errors
/// When it cannot be written, or has no certificate.
pub fn write_and_decide(
    session: &Session,
    path: &Path,
    outputs: &mut Outputs,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> Result<Claim> {
    let bytes = written(session, Some(path), outputs, write)?;
    session.stage("certificate");
    let claim = decide(&bytes)?;
    session.check()?;
    Ok(claim)
}

/// Checks a map that this program has made and that need not be one.
///
/// # Errors
/// When it has no certificate.
pub fn decide(bytes: &[u8]) -> Result<Claim> {
    match verify_bytes(bytes) {
        Ok(Verdict::Refuted(witness)) => {
            let what = "the map has no certificate; nothing was written";
            Err(refuted(Exit::Limits, what, &witness))
        }
        _ => check_own(bytes),
    }
}

/// Writes the bytes of a map that were checked, and reads them back.
///
/// # Errors
/// When they cannot be written.
pub fn keep(session: &Session, path: &Path, outputs: &mut Outputs, bytes: &[u8]) -> Result<()> {
    match written(session, Some(path), outputs, |out| out.write_all(bytes))? == bytes {
        true => Ok(()),
        false => {
            Err(Failure::limits("cannot-write", format!("{} reads back other than it was written", path.display())))
        }
    }
}

/// The bytes of a map's file, as they are there or would be.
fn written(
    session: &Session,
    path: Option<&Path>,
    outputs: &mut Outputs,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> Result<Vec<u8>> {
    session.stage("write");
    let bytes = match path {
        Some(path) => {
            let partial = outputs.stage(session, path, |out| write(out).map_err(|e| e.to_string()))?;
            std::fs::read(&partial)
                .map_err(|e| Failure::limits("cannot-write", format!("{} cannot be read back: {e}", path.display())))?
        }
        None => {
            let mut memory = Cursor::new(Vec::new());
            write(&mut memory).map_err(|e| Failure::bug(e.to_string()))?;
            memory.into_inner()
        }
    };
    session.check()?;
    Ok(bytes)
}

/// Checks a map that this program has just made: anything but a proof is a bug.
fn check_own(bytes: &[u8]) -> Result<Claim> {
    let bug = |what: String| {
        Failure::bug(format!("the map that was made does not pass its check; nothing was written: {what}"))
    };
    match verify_bytes(bytes) {
        Ok(Verdict::Certified(claim)) => Ok(claim),
        Ok(Verdict::Refuted(witness)) => Err(bug(witness_text(&witness)).with("witness", witness_json(&witness))),
        Ok(Verdict::Undecided(obstacle)) => Err(undecided(&obstacle)),
        Err(error) => Err(bug(error.to_string())),
    }
}

/// Reads the bytes of a map file.
pub fn read_bytes(session: &Session, path: &Path) -> Result<Vec<u8>> {
    session.stage("read");
    session.fact("input", json!({"path": path.display().to_string()}));
    std::fs::read(path).map_err(|e| Failure::input("cannot-open", format!("{} cannot be read: {e}", path.display())))
}

/// Checks the certificate of a file that is to be used.
///
/// # Errors
/// When it does not hold, or is undecided.
pub fn certified(session: &Session, path: &Path, bytes: &[u8]) -> Result<Claim> {
    session.stage("certificate");
    let claim = match verify_bytes(bytes) {
        Ok(Verdict::Certified(claim)) => claim,
        Ok(Verdict::Refuted(witness)) => {
            let what = format!("the certificate of {} does not hold", path.display());
            return Err(refuted(Exit::Refuted, &what, &witness));
        }
        Ok(Verdict::Undecided(obstacle)) => return Err(undecided(&obstacle)),
        Err(error) => return Err(unreadable(path, &error)),
    };
    session.check()?;
    Ok(claim)
}

/// Reads a map that is to be used, and checks its certificate first.
pub fn open_certified(session: &Session, path: &Path) -> Result<(StoredMap, Claim)> {
    let bytes = read_bytes(session, path)?;
    let claim = certified(session, path, &bytes)?;
    session.stage("prepare");
    let map = read_map(&bytes).map_err(|error| match error {
        MapFileError::NoMap => Failure::input("no-map", format!("{}: {error}", path.display())),
        _ => Failure::input("unreadable-map", format!("{}: {error}", path.display())),
    })?;
    session.fact("input", map_json(&map, path));
    session.check()?;
    Ok((map, claim))
}

/// The `input` field for a map.
pub fn map_json(map: &StoredMap, path: &Path) -> Value {
    match map {
        StoredMap::Foliation(FoliationMap::Surface(map)) => source_json(map.source(), path),
        StoredMap::Foliation(FoliationMap::Volume(map)) => source_json(map.source(), path),
        StoredMap::Shell(shell) => source_json(shell.source(), path),
        StoredMap::Planar(map) => domain_json(map.as_bijection().source(), path),
        StoredMap::Moved(MovedMap::Surface(map)) => source_json(map.source(), path),
        StoredMap::Moved(MovedMap::Volume(map)) => source_json(map.source(), path),
        StoredMap::Cages(map) => json!({
            "path": path.display().to_string(), "vertices": map.stages()[0].len(), "triangles": map.triangles().len(),
        }),
    }
}

/// The `input` field for a polygon.
pub fn domain_json(domain: &PlanarDomain, path: &Path) -> Value {
    json!({
        "path": path.display().to_string(), "vertices": domain.vertex_count(), "rings": domain.rings().len(),
    })
}

fn source_json<const K: usize>(source: &SourceMesh<K>, path: &Path) -> Value {
    let cells = if K == 3 { "triangles" } else { "tetrahedra" };
    json!({
        "path": path.display().to_string(), "vertices": source.positions().len(), cells: source.complex().cell_count(),
    })
}
