//! Writing numbers as text so that they read back bit for bit.

use std::io::{Result, Write};

use super::mesh_file::Values;

/// Writes the shortest decimal that reads back as `value`; it always has a point or an exponent.
pub(super) fn write_f64(out: &mut dyn Write, value: f64) -> Result<()> {
    if value.is_nan() { out.write_all(b"nan") } else { write!(out, "{value:?}") }
}

/// Writes the shortest decimal that reads back as `value` in single precision.
pub(super) fn write_f32(out: &mut dyn Write, value: f32) -> Result<()> {
    if value.is_nan() { out.write_all(b"nan") } else { write!(out, "{value:?}") }
}

/// Writes numbers with a blank between each two.
pub(super) fn write_point(out: &mut dyn Write, point: &[f64]) -> Result<()> {
    for (index, &value) in point.iter().enumerate() {
        if index > 0 {
            out.write_all(b" ")?;
        }
        write_f64(out, value)?;
    }
    Ok(())
}

/// Writes entry `index`; texts are written as they are.
pub(super) fn write_entry(out: &mut dyn Write, values: &Values, index: usize) -> Result<()> {
    match values {
        Values::F64(v) => write_f64(out, v[index]),
        Values::F32(v) => write_f32(out, v[index]),
        Values::I64(v) => write!(out, "{}", v[index]),
        Values::Text(v) => out.write_all(v[index].as_bytes()),
    }
}

/// Writes the entries of row `row` with a blank between each two.
pub(super) fn write_row(out: &mut dyn Write, values: &Values, components: usize, row: usize) -> Result<()> {
    for component in 0..components {
        if component > 0 {
            out.write_all(b" ")?;
        }
        write_entry(out, values, row * components + component)?;
    }
    Ok(())
}
