//! Tables of points: `.npy` and `.csv`.

pub mod csv;
pub mod npy;

use std::path::Path;

use crate::failure::{Failure, Result};

/// Points with two or three columns; the third coordinate is zero where there are two.
#[derive(Clone, Debug, PartialEq)]
pub struct Table<T> {
    /// 2 or 3.
    pub columns: usize,
    /// One point per row.
    pub rows: Vec<[T; 3]>,
}

/// A format of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointFormat {
    Npy,
    Csv,
}

impl PointFormat {
    /// By the extension.
    ///
    /// # Errors
    /// Wrong usage where it is neither.
    pub fn of_path(path: &Path) -> Result<Self> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        match extension.as_str() {
            "npy" => Ok(Self::Npy),
            "csv" => Ok(Self::Csv),
            _ => Err(Failure::usage(format!("{}: points are .npy or .csv", path.display()))),
        }
    }
}

/// Reads points as doubles.
///
/// # Errors
/// When the file cannot be read as points.
pub fn read(path: &Path) -> Result<Table<f64>> {
    let format = PointFormat::of_path(path)?;
    let bytes = bytes_of(path)?;
    let table = match format {
        PointFormat::Npy => npy::decode(&bytes),
        PointFormat::Csv => csv::parse(&bytes, csv::double),
    };
    table.map_err(|what| Failure::input("points", format!("{}: {what}", path.display())))
}

/// The bytes of a file of points.
///
/// # Errors
/// When it cannot be read.
pub fn bytes_of(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|e| Failure::input("cannot-open", format!("{} cannot be read: {e}", path.display())))
}
