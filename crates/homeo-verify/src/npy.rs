//! Container rules: arrays in NumPy's format 1.0 or 2.0, little endian, C order.
//!
//! The header is compared with the only text that is right for the expected type and shape and the number of bytes,
//! spelled as NumPy spells it; so its meaning is not a matter of parsing.

use crate::archive::Archive;
use crate::number::Point;
use crate::verdict::{Unreadable, readable, unreadable};

/// A number type that an array may hold: NumPy's name for it, and what its bytes mean.
pub(crate) struct Number<T, const SIZE: usize>(&'static str, fn([u8; SIZE]) -> T);
pub(crate) const F8: Number<f64, 8> = Number("<f8", f64::from_le_bytes);
pub(crate) const I8: Number<i64, 8> = Number("<i8", i64::from_le_bytes);
pub(crate) const U4: Number<u32, 4> = Number("<u4", u32::from_le_bytes);
pub(crate) const I1: Number<i8, 1> = Number("|i1", i8::from_le_bytes);

/// An array that is still bytes.
pub(crate) struct Array<'a> {
    name: &'a str,
    header: &'a str,
    /// The elements as stored.
    pub(crate) content: &'a [u8],
}

impl<'a> Array<'a> {
    /// Takes the array `name` out of the archive.
    pub(crate) fn take(archive: &mut Archive<'a>, name: &'a str) -> Result<Self, Unreadable> {
        let array = archive.0.remove(format!("{name}.npy").as_str());
        let bytes = array.ok_or_else(|| unreadable(format!("array {name} is missing")))?;
        let no_header = || unreadable(format!("array {name} has no header of NumPy's format 1.0 or 2.0"));
        let (header, content) = split(bytes).ok_or_else(no_header)?;
        Ok(Array { name, header, content })
    }

    /// The elements, when type and shape are as stated; any number of rows without `rows`. One column means one dimension.
    pub(crate) fn read<T, const SIZE: usize>(
        &self,
        Number(kind, decode): Number<T, SIZE>,
        rows: Option<usize>,
        columns: usize,
    ) -> Result<Vec<T>, Unreadable> {
        let rows = rows.unwrap_or(self.content.len() / (SIZE * columns));
        let shape = if columns == 1 { format!("({rows},)") } else { format!("({rows}, {columns})") };
        let expected = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
        let (name, found) = (self.name, self.header);
        let message = format!("the header of array {name} has to be {expected} (C order), not {found}");
        readable(found == expected, &message)?;
        let is_full = self.content.len() == rows * columns * SIZE;
        readable(is_full, &format!("array {name} has another number of bytes than its shape says"))?;
        Ok(self.content.as_chunks().0.iter().map(|&bytes| decode(bytes)).collect())
    }

    /// Rows of one to three coordinates; the others are 0.
    pub(crate) fn read_points(&self, rows: Option<usize>, columns: usize) -> Result<Vec<Point>, Unreadable> {
        let numbers = self.read(F8, rows, columns)?;
        Ok(numbers.chunks_exact(columns).map(|row| [0, 1, 2].map(|i| row.get(i).copied().unwrap_or(0.0))).collect())
    }
}

/// Splits an array into the text of its header, without padding, and its elements.
fn split(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let (length, rest) = match bytes.strip_prefix(b"\x93NUMPY")? {
        [1, 0, a, b, rest @ ..] => (u32::from_le_bytes([*a, *b, 0, 0]), rest),
        [2, 0, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]), rest),
        _ => return None,
    };
    let (header, content) = rest.split_at_checked(usize::try_from(length).ok()?)?;
    Some((std::str::from_utf8(header).ok()?.strip_suffix('\n')?.trim_end_matches(' '), content))
}
