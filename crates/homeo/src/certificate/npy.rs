//! NumPy arrays as bytes: version 1.0, little endian, C order.

use super::read::MapFileError;

/// Array types of map files.
pub(super) trait Element: Sized + Copy {
    /// NumPy's name of the type.
    const DESCRIPTION: &'static str;
    /// Bytes of one element.
    const SIZE: usize;
    fn put(self, bytes: &mut Vec<u8>);
    fn take(bytes: &[u8]) -> Self;
}

macro_rules! element {
    ($type:ty, $description:literal) => {
        impl Element for $type {
            const DESCRIPTION: &'static str = $description;
            const SIZE: usize = size_of::<$type>();
            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
            fn take(bytes: &[u8]) -> Self {
                let mut raw = [0; size_of::<$type>()];
                raw.copy_from_slice(bytes);
                Self::from_le_bytes(raw)
            }
        }
    };
}

element!(f64, "<f8");
element!(u32, "<u4");
element!(i64, "<i8");
element!(i8, "|i1");

/// An array of `shape` as the bytes of an `.npy` file.
pub(super) fn encode<T: Element>(shape: &[usize], elements: impl ExactSizeIterator<Item = T>) -> Vec<u8> {
    debug_assert_eq!(shape.iter().product::<usize>(), elements.len());
    // To the letter as NumPy writes it.
    let dimensions = match shape {
        [rows] => format!("{rows},"),
        _ => shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", "),
    };
    let mut header = format!("{{'descr': '{}', 'fortran_order': False, 'shape': ({dimensions}), }}", T::DESCRIPTION);
    // The data begin at a multiple of 64 bytes.
    let padding = (64 - (10 + header.len() + 1) % 64) % 64;
    header.extend(std::iter::repeat_n(' ', padding));
    header.push('\n');
    let mut bytes = Vec::with_capacity(10 + header.len() + elements.len() * T::SIZE);
    bytes.extend_from_slice(b"\x93NUMPY\x01\x00");
    bytes.extend_from_slice(&(header.len() as u16).to_le_bytes());
    bytes.extend_from_slice(header.as_bytes());
    elements.for_each(|element| element.put(&mut bytes));
    bytes
}

/// Rows of an array with `columns` entries per row (one-dimensional arrays have one).
pub(super) fn decode<T: Element>(name: &str, bytes: &[u8], columns: usize) -> Result<Vec<T>, MapFileError> {
    let wrong = |what: &str| MapFileError::Array { name: name.to_owned(), what: what.to_owned() };
    let prefix = bytes.get(..10).filter(|p| &p[..6] == b"\x93NUMPY").ok_or_else(|| wrong("is no .npy array"))?;
    let (start, length) = if prefix[6] == 1 {
        (10, usize::from(u16::from_le_bytes([prefix[8], prefix[9]])))
    } else {
        let raw = bytes.get(8..12).ok_or_else(|| wrong("is truncated"))?;
        (12, u32::from_le_bytes([raw[0], raw[1], raw[2], raw[3]]) as usize)
    };
    let end = start + length;
    let header =
        bytes.get(start..end).and_then(|h| std::str::from_utf8(h).ok()).ok_or_else(|| wrong("has a broken header"))?;
    let compact: String = header.chars().filter(|c| !c.is_whitespace()).collect();
    if !compact.contains(&format!("'descr':'{}'", T::DESCRIPTION)) || !compact.contains("'fortran_order':False") {
        return Err(wrong(&format!("must be of type {} in C order", T::DESCRIPTION)));
    }
    let shape = shape_of(&compact).ok_or_else(|| wrong("has no readable shape"))?;
    let fits = match shape[..] {
        [_] => columns == 1,
        [_, second] => second == columns,
        _ => false,
    };
    if !fits {
        return Err(wrong(&format!("has shape {shape:?} where rows of {columns} belong")));
    }
    let data = &bytes[end..];
    let expected = shape.iter().try_fold(T::SIZE, |product, &n| product.checked_mul(n));
    if expected != Some(data.len()) {
        return Err(wrong("holds another number of bytes than its shape says"));
    }
    Ok(data.chunks_exact(T::SIZE).map(T::take).collect())
}

fn shape_of(header: &str) -> Option<Vec<usize>> {
    let after = header.split_once("'shape':(")?.1;
    let inside = after.split_once(')')?.0;
    inside.split(',').filter(|part| !part.is_empty()).map(|part| part.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_come_back() {
        let bytes = encode(&[2, 3], [1.5f64, -0.0, 3.0, f64::MIN_POSITIVE, 5.0, 6.0].into_iter());
        assert_eq!((bytes.len() - 48) % 64, 0);
        assert_eq!(decode::<f64>("a", &bytes, 3).unwrap()[3], f64::MIN_POSITIVE);
        assert!(decode::<f64>("a", &bytes, 2).is_err());
        assert!(decode::<u32>("a", &bytes, 3).is_err());
        assert!(decode::<f64>("a", &bytes[..bytes.len() - 1], 3).is_err());
        assert!(decode::<f64>("a", &bytes[..9], 3).is_err());
    }
}
