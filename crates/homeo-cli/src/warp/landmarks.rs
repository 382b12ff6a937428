//! Landmarks from a table.

use std::path::Path;

use homeo::construct::harmonic::{Landmark, LandmarkError, landmark_map};
use homeo::map::HarmonicMap;
use serde_json::json;

use crate::failure::{Failure, Result};
use crate::points::{bytes_of, csv};

/// How many folded triangles are listed.
const SHOWN: usize = 10;

/// The map of the landmarks in a file.
pub fn map(path: &Path) -> Result<HarmonicMap> {
    let bytes = bytes_of(path)?;
    let landmarks = parse(&bytes).map_err(|what| Failure::input("landmarks", format!("{}: {what}", path.display())))?;
    landmark_map(&landmarks).map_err(|error| {
        let message = format!("{}: {error}", path.display());
        match error {
            LandmarkError::Folded { folded, of } => Failure::input("folded", message)
                .with("folded", json!(folded.iter().take(SHOWN).collect::<Vec<_>>()))
                .with("folded_count", folded.len())
                .with("triangles", of),
            LandmarkError::Outline(_) => Failure::input("folded", message),
            _ => Failure::input("landmarks", message),
        }
    })
}

fn parse(bytes: &[u8]) -> std::result::Result<Vec<Landmark>, String> {
    let text = std::str::from_utf8(bytes).map_err(|e| format!("byte {} is no text", e.valid_up_to()))?;
    let mut lines = text.trim_start_matches('\u{feff}').lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').map(str::trim).collect();
    if header != ["x", "y", "u", "v"] {
        return Err("the first line must be the header x,y,u,v".to_owned());
    }
    let row = |(row, line): (usize, &str)| {
        let numbers: std::result::Result<Vec<f64>, String> =
            line.split(',').map(|field| csv::double(field.trim())).collect();
        match numbers.map_err(|what| format!("row {}: {what}", row + 1))?[..] {
            [x, y, u, v] => Ok([[x, y], [u, v]]),
            ref other => Err(format!("row {}: {} columns instead of 4", row + 1, other.len())),
        }
    };
    lines.enumerate().filter(|(_, line)| !line.trim().is_empty()).map(row).collect()
}
