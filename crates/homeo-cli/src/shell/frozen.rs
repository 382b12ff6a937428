//! The file of vertices that stay.

use std::path::Path;

use crate::failure::{Failure, Result};

/// Reads `[0, 5, 7]`.
///
/// # Errors
/// When the file is no JSON list of vertex numbers.
pub fn read(path: &Path) -> Result<Vec<u32>> {
    let wrong = |what: String| Failure::input("frozen", format!("{}: {what}", path.display()));
    let bytes = std::fs::read(path).map_err(|e| wrong(format!("cannot be read: {e}")))?;
    serde_json::from_slice(&bytes).map_err(|e| wrong(format!("a list of vertex numbers is needed: {e}")))
}
