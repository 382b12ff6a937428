//! CSV tables of points, with the header `x,y,z` or `x,y`.

use std::fmt::Write as _;

use homeo_core::number::Rational;

use super::Table;

/// Reads a table; every cell is a number by `number`.
///
/// # Errors
/// A sentence that names the row, counted from 1 below the header.
pub fn parse<T: Zero>(bytes: &[u8], number: impl Fn(&str) -> Result<T, String>) -> Result<Table<T>, String> {
    let text = std::str::from_utf8(bytes).map_err(|e| format!("byte {} is no text", e.valid_up_to()))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines();
    let header = lines.next().unwrap_or_default();
    let names: Vec<&str> = header.split(',').map(str::trim).collect();
    let columns = match names.as_slice() {
        ["x", "y", "z"] => 3,
        ["x", "y"] => 2,
        _ => {
            let found: String = header.chars().take(40).collect();
            return Err(format!("the first line must be the header x,y,z or x,y; found `{found}`"));
        }
    };
    let mut rows = Vec::new();
    for (row, line) in lines.enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let mut point = [T::zero(), T::zero(), T::zero()];
        let mut count = 0;
        for field in line.split(',') {
            if count < columns {
                point[count] = number(field.trim()).map_err(|what| format!("row {}: {what}", row + 1))?;
            }
            count += 1;
        }
        if count != columns {
            return Err(format!("row {}: {count} columns instead of {columns}", row + 1));
        }
        rows.push(point);
    }
    Ok(Table { columns, rows })
}

/// What a column that is not there holds.
pub trait Zero {
    /// Zero.
    fn zero() -> Self;
}

impl Zero for f64 {
    fn zero() -> Self {
        0.0
    }
}

impl Zero for Rational {
    fn zero() -> Self {
        Self::ZERO
    }
}

/// A decimal number as the nearest double.
///
/// # Errors
/// When it is none.
pub fn double(text: &str) -> Result<f64, String> {
    let shown = || text.chars().take(40).collect::<String>();
    text.parse().map_err(|_| {
        let advice = if text.contains('/') { "; give --exact for rationals" } else { "" };
        format!("`{}` is no decimal number{advice}", shown())
    })
}

/// A fraction or decimal, exactly.
///
/// # Errors
/// When it is none.
pub fn rational(text: &str) -> Result<Rational, String> {
    text.parse().map_err(|e: homeo_core::number::ParseRationalError| e.to_string())
}

/// Writes a table of doubles, each so that it reads back bit for bit.
pub fn write_doubles(table: &Table<f64>) -> Vec<u8> {
    let mut text = header(table.columns);
    for row in &table.rows {
        for (index, x) in row[..table.columns].iter().enumerate() {
            let comma = if index > 0 { "," } else { "" };
            // Writing to a String cannot fail.
            let _ = write!(text, "{comma}{x:?}");
        }
        text.push('\n');
    }
    text.into_bytes()
}

/// Writes rationals as `p/q`; a point that does not exist is a row of NaN.
pub fn write_rationals(columns: usize, rows: &[Option<[Rational; 3]>]) -> Vec<u8> {
    let mut text = header(columns);
    for row in rows {
        for index in 0..columns {
            let comma = if index > 0 { "," } else { "" };
            let _ = match row {
                Some(point) => write!(text, "{comma}{}", point[index]),
                None => write!(text, "{comma}NaN"),
            };
        }
        text.push('\n');
    }
    text.into_bytes()
}

fn header(columns: usize) -> String {
    (if columns == 2 { "x,y\n" } else { "x,y,z\n" }).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back() {
        let table = Table { columns: 3, rows: vec![[0.1, -0.0, 1e300], [5e-324, 1.0 / 3.0, f64::MAX]] };
        let bytes = write_doubles(&table);
        let back = parse(&bytes, double).unwrap();
        let bits = |t: &Table<f64>| t.rows.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&back), bits(&table));
    }

    #[test]
    fn windows_files_and_blank_lines_are_fine() {
        let table = parse(b"\xef\xbb\xbfx, y\r\n1,2\r\n\r\n3,4\r\n", double).unwrap();
        assert_eq!(table, Table { columns: 2, rows: vec![[1.0, 2.0, 0.0], [3.0, 4.0, 0.0]] });
    }

    #[test]
    fn faults_name_their_row() {
        assert!(parse(b"a,b\n1,2\n", double).unwrap_err().contains("header"));
        assert!(parse(b"", double).unwrap_err().contains("header"));
        assert!(parse(b"x,y\n1,2\n1\n", double).unwrap_err().contains("row 2: 1 columns instead of 2"));
        assert!(parse(b"x,y\n1,2,3\n", double).unwrap_err().contains("row 1: 3 columns instead of 2"));
        assert!(parse(b"x,y\n1,1/2\n", double).unwrap_err().contains("--exact"));
        assert!(parse(b"x,y\n1,two\n", rational).unwrap_err().contains("row 1"));
        assert_eq!(parse(b"x,y\n1/2,0.5\n", rational).unwrap().rows[0][0], "0.5".parse().unwrap());
    }
}
