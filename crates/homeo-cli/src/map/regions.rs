//! The regions file: which part of the boundary goes where.

use std::path::Path;

use homeo::construct::foliation::RequestedRegions;
use serde_json::Value;

use crate::failure::{Failure, Result};

/// Reads `{"corners": [4 vertices]}`, `{"source": [[a, b, c], ...], "sink": [...]}` or `{"centre": cell}`.
///
/// # Errors
/// When the file is none of these.
pub fn read(path: &Path) -> Result<RequestedRegions> {
    let wrong = |what: String| Failure::input("regions", format!("{}: {what}", path.display()));
    let bytes = std::fs::read(path).map_err(|e| wrong(format!("cannot be read: {e}")))?;
    let value: Value = serde_json::from_slice(&bytes).map_err(|e| wrong(e.to_string()))?;
    let object = value
        .as_object()
        .filter(|o| !o.is_empty())
        .ok_or_else(|| wrong("an object with regions is needed".to_owned()))?;
    let mut regions = RequestedRegions::default();
    for (key, value) in object {
        let parsed = match key.as_str() {
            "corners" => numbers::<4>(value).map(|corners| regions.corners = Some(corners)),
            "source" => triangles(value).map(|triangles| regions.source = Some(triangles)),
            "sink" => triangles(value).map(|triangles| regions.sink = Some(triangles)),
            "centre" => number(value).map(|cell| regions.centre = Some(cell)),
            _ => return Err(wrong(format!("`{key}` is none of corners, source, sink, centre"))),
        };
        parsed.ok_or_else(|| wrong(format!("`{key}` is not as it should be: {}", shape_of(key))))?;
    }
    Ok(regions)
}

fn shape_of(key: &str) -> &'static str {
    match key {
        "corners" => "four vertex numbers",
        "centre" => "one cell number",
        _ => "a list of triangles, each by three vertex numbers",
    }
}

fn number(value: &Value) -> Option<u32> {
    value.as_u64().and_then(|n| u32::try_from(n).ok())
}

fn numbers<const N: usize>(value: &Value) -> Option<[u32; N]> {
    let list: Vec<u32> = value.as_array()?.iter().map(number).collect::<Option<_>>()?;
    list.try_into().ok()
}

fn triangles(value: &Value) -> Option<Vec<[u32; 3]>> {
    value.as_array()?.iter().map(numbers::<3>).collect()
}
