//! NumPy arrays of points: float64, two-dimensional, C order, little endian.

use super::Table;

const MAGIC: &[u8] = b"\x93NUMPY";

/// Reads an array of shape (n, 2) or (n, 3).
///
/// # Errors
/// A sentence that names what the array is instead.
pub fn decode(bytes: &[u8]) -> Result<Table<f64>, String> {
    let (header, data) = split(bytes)?;
    let compact: String = header.chars().filter(|c| !c.is_whitespace()).collect();
    let kind = between(&compact, "'descr':'", "'").ok_or("the header of the array has no plain type")?;
    if kind != "<f8" {
        return Err(format!(
            "the array is of type {kind}; points are float64, little endian (<f8): use .astype('<f8')"
        ));
    }
    if !compact.contains("'fortran_order':False") {
        return Err("the array is in Fortran order; use numpy.ascontiguousarray".to_owned());
    }
    let shape = between(&compact, "'shape':(", ")").ok_or("the header of the array has no shape")?;
    let sizes: Option<Vec<usize>> = shape.split(',').filter(|s| !s.is_empty()).map(|s| s.parse().ok()).collect();
    let (rows, columns) = match sizes.as_deref() {
        Some(&[rows, columns @ (2 | 3)]) => (rows, columns),
        _ => return Err(format!("the array has shape ({shape}); points are rows of 2 or 3 numbers, shape (n, 3)")),
    };
    if rows.checked_mul(columns * 8) != Some(data.len()) {
        return Err(format!("the array announces {rows} rows of {columns} and holds {} bytes of data", data.len()));
    }
    let mut numbers =
        data.chunks_exact(8).map(|b| f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]));
    let rows =
        (0..rows).map(|_| std::array::from_fn(|i| if i < columns { numbers.next().unwrap_or(0.0) } else { 0.0 }));
    Ok(Table { columns, rows: rows.collect() })
}

fn split(bytes: &[u8]) -> Result<(&str, &[u8]), String> {
    let short = || "the file ends within the header of the array".to_owned();
    if !bytes.starts_with(MAGIC) {
        return Err("this is no .npy array".to_owned());
    }
    let version = *bytes.get(6).ok_or_else(short)?;
    let (start, length): (usize, usize) = match version {
        1 => {
            let raw = bytes.get(8..10).ok_or_else(short)?;
            (10, usize::from(u16::from_le_bytes([raw[0], raw[1]])))
        }
        2 | 3 => {
            let raw = bytes.get(8..12).ok_or_else(short)?;
            (12, u32::from_le_bytes([raw[0], raw[1], raw[2], raw[3]]) as usize)
        }
        _ => return Err(format!("version {version} of .npy is not known")),
    };
    let header = bytes.get(start..start.saturating_add(length)).ok_or_else(short)?;
    let header = std::str::from_utf8(header).map_err(|_| "the header of the array is no text".to_owned())?;
    Ok((header, &bytes[start + length..]))
}

fn between<'a>(text: &'a str, before: &str, after: &str) -> Option<&'a str> {
    Some(text.split_once(before)?.1.split_once(after)?.0)
}

/// The bytes of an `.npy` file with the table.
pub fn encode(table: &Table<f64>) -> Vec<u8> {
    let (rows, columns) = (table.rows.len(), table.columns);
    let mut bytes = begin("<f8", &format!("({rows}, {columns})"), rows * columns * 8);
    for row in &table.rows {
        row[..columns].iter().for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
    }
    bytes
}

/// A field of pixel coordinates as float32 of shape (height, width, 2).
pub fn encode_field(field: &[[f32; 2]], width: usize) -> Vec<u8> {
    let height = field.len() / width.max(1);
    let mut bytes = begin("<f4", &format!("({height}, {width}, 2)"), field.len() * 8);
    field.as_flattened().iter().for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
    bytes
}

/// Magic and header of an array, with room for its elements.
fn begin(kind: &str, shape: &str, size: usize) -> Vec<u8> {
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    // The data begin at a multiple of 64 bytes.
    let padding = (64 - (MAGIC.len() + 4 + header.len() + 1) % 64) % 64;
    header.push_str(&" ".repeat(padding));
    header.push('\n');
    let mut bytes = Vec::with_capacity(10 + header.len() + size);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&[1, 0]);
    bytes.extend_from_slice(&(header.len() as u16).to_le_bytes());
    bytes.extend_from_slice(header.as_bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn altered(from: &str, to: &str) -> String {
        assert_eq!(from.len(), to.len());
        let table = Table { columns: 3, rows: vec![[1.0, 2.0, 3.0]] };
        let mut bytes = encode(&table);
        let at = bytes.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
        bytes[at..at + to.len()].copy_from_slice(to.as_bytes());
        decode(&bytes).unwrap_err()
    }

    #[test]
    fn tables_come_back() {
        for columns in [2, 3] {
            let row = [1.5, -0.0, if columns == 3 { f64::MAX } else { 0.0 }];
            let table = Table { columns, rows: vec![row; 5] };
            let bytes = encode(&table);
            assert_eq!((bytes.len() - 5 * columns * 8) % 64, 0);
            assert_eq!(decode(&bytes).unwrap(), table);
            assert!((0..bytes.len()).all(|end| decode(&bytes[..end]).is_err()));
        }
    }

    #[test]
    fn other_arrays_are_refused_by_name() {
        assert!(altered("<f8", "<f4").contains("type <f4"));
        assert!(altered("<f8", ">f8").contains("type >f8"));
        assert!(altered("False", " True").contains("Fortran"));
        assert!(altered("(1, 3)", "(1, 4)").contains("shape (1,4)"));
        assert!(altered("(1, 3)", "(9, 3)").contains("announces 9 rows"));
        assert!(altered("(1, 3)", "(3, ) ").contains("shape (3,)"));
        assert!(decode(b"x,y,z\n").is_err());
    }
}
