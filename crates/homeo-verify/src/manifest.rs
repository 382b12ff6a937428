//! Container rules: `manifest.json`, which says what the arrays claim to be.

use crate::verdict::{Unreadable, unreadable};
use serde_json::{Map, Value};

/// The canonical domain that the map claims to reach.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Target {
    Square,
    Disk,
    Cube,
    Ball,
}

impl Target {
    /// The name as in the manifest.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Target::Square => "square",
            Target::Disk => "disk",
            Target::Cube => "cube",
            Target::Ball => "ball",
        }
    }

    /// Two or three.
    pub(crate) fn dimension(self) -> usize {
        if matches!(self, Target::Square | Target::Disk) { 2 } else { 3 }
    }

    /// Whether leaves meet in the middle of a cell.
    pub(crate) fn is_radial(self) -> bool {
        matches!(self, Target::Disk | Target::Ball)
    }
}

/// What the manifest claims; fields on which no claim rests are left out.
#[derive(Debug)]
pub(crate) struct Manifest {
    pub(crate) is_foliation: bool,
    pub(crate) target: Target,
    /// The centre's cell, for disk and ball. (Its length is at least 1, and nothing else matters.)
    pub(crate) centre: Option<u64>,
    pub(crate) source_vertices: u64,
    pub(crate) source_cells: u64,
    pub(crate) source_sha256: String,
}

const MAXIMUM_BYTES: usize = 1 << 20;
const FIELDS: [&str; 9] =
    ["format", "version", "kind", "dimension", "target", "centre", "source", "length_unit", "construction"];

impl Manifest {
    /// Reads the manifest; every departure from the format is an error.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, Unreadable> {
        if bytes.len() > MAXIMUM_BYTES {
            return unreadable("manifest.json is longer than 1 MiB");
        }
        let value: Value = match serde_json::from_slice(bytes) {
            Ok(value) => value,
            Err(error) => return unreadable(format!("manifest.json is not JSON: {error}")),
        };
        if count_keys(&value) != count_colons(bytes) {
            return unreadable("manifest.json repeats a key");
        }
        let Some(top) = value.as_object() else { return unreadable("manifest.json is not an object") };
        if let Some(key) = top.keys().find(|key| !FIELDS.contains(&key.as_str()) && !key.starts_with("note_")) {
            return unreadable(format!("manifest.json has an unknown field {key:?}"));
        }
        if top.get("format").and_then(Value::as_str) != Some("homeo") {
            return unreadable("the format is not \"homeo\"");
        }
        if integer(top, "version")? != 1 {
            return unreadable("this checker reads version 1 only");
        }
        Self::from_fields(top)
    }

    fn from_fields(top: &Map<String, Value>) -> Result<Self, Unreadable> {
        let target = match text(top, "target")? {
            "square" => Target::Square,
            "disk" => Target::Disk,
            "cube" => Target::Cube,
            "ball" => Target::Ball,
            other => return unreadable(format!("unknown target {other:?}")),
        };
        let is_foliation = match text(top, "kind")? {
            "foliation" => true,
            "piecewise-linear" if !target.is_radial() => false,
            other => return unreadable(format!("unknown kind {other:?} for this target")),
        };
        if integer(top, "dimension")? != target.dimension() as u64 {
            return unreadable("dimension and target disagree");
        }
        let Some(source) = top.get("source").and_then(Value::as_object) else {
            return unreadable("manifest.json has no object \"source\"");
        };
        let source_sha256 = text(source, "content_sha256")?.to_owned();
        if source_sha256.len() != 64 || !source_sha256.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f')) {
            return unreadable("content_sha256 is not 64 lower-case hexadecimal digits");
        }
        Ok(Manifest {
            is_foliation,
            target,
            centre: centre(top.get("centre"), target)?,
            source_vertices: integer(source, "vertices")?,
            source_cells: integer(source, "cells")?,
            source_sha256,
        })
    }
}

/// `null`, or the cell and the length of the centre.
fn centre(value: Option<&Value>, target: Target) -> Result<Option<u64>, Unreadable> {
    match value {
        Some(Value::Null) if !target.is_radial() => Ok(None),
        Some(Value::Object(centre)) if target.is_radial() => {
            let length = integer(centre, "length")?;
            if length == 0 || length > u64::from(u32::MAX) || centre.len() != 2 {
                return unreadable("the centre needs a cell and a length from 1 to 2^32 - 1");
            }
            Ok(Some(integer(centre, "cell")?))
        }
        _ => unreadable("\"centre\" has to be null for square and cube, and an object for disk and ball"),
    }
}

fn text<'a>(object: &'a Map<String, Value>, key: &str) -> Result<&'a str, Unreadable> {
    match object.get(key).and_then(Value::as_str) {
        Some(text) => Ok(text),
        None => unreadable(format!("manifest.json has no text {key:?}")),
    }
}

fn integer(object: &Map<String, Value>, key: &str) -> Result<u64, Unreadable> {
    match object.get(key).and_then(Value::as_u64) {
        Some(number) => Ok(number),
        None => unreadable(format!("manifest.json has no natural number {key:?}")),
    }
}

/// The number of keys that the parser kept.
fn count_keys(value: &Value) -> usize {
    match value {
        Value::Object(object) => object.len() + object.values().map(count_keys).sum::<usize>(),
        Value::Array(array) => array.iter().map(count_keys).sum(),
        _ => 0,
    }
}

/// The number of keys in valid JSON text: colons that are not inside a string.
fn count_colons(bytes: &[u8]) -> usize {
    let (mut colons, mut inside, mut escaped) = (0, false, false);
    for &byte in bytes {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if inside => escaped = true,
            b'"' => inside = !inside,
            b':' if !inside => colons += 1,
            _ => {}
        }
    }
    colons
}
