//! Container rules: arrays in NumPy's format 1.0 or 2.0, little endian, C order.
//!
//! Only the header that NumPy itself writes is accepted, so that its meaning is not a matter of parsing.

use crate::archive::Archive;
use crate::verdict::{Unreadable, unreadable};

/// A number type that an array may hold.
pub(crate) trait Element: Sized {
    /// NumPy's name of the type.
    const NAME: &'static str;
    /// Bytes of one element.
    const SIZE: usize;
    /// The element that these `SIZE` bytes mean.
    fn decode(bytes: &[u8]) -> Self;
}

macro_rules! element {
    ($type:ty, $name:literal) => {
        impl Element for $type {
            const NAME: &'static str = $name;
            const SIZE: usize = size_of::<$type>();
            fn decode(bytes: &[u8]) -> Self {
                let mut buffer = [0; size_of::<$type>()];
                buffer.copy_from_slice(bytes);
                <$type>::from_le_bytes(buffer)
            }
        }
    };
}
element!(f64, "<f8");
element!(i64, "<i8");
element!(u32, "<u4");
element!(i8, "|i1");

/// An array that is still bytes.
pub(crate) struct RawArray<'a> {
    name: &'a str,
    kind: &'a str,
    shape: Vec<usize>,
    /// The elements as stored.
    pub(crate) content: &'a [u8],
}

/// Finds the array `name` in the archive and reads its header.
pub(crate) fn find<'a>(archive: &Archive<'a>, name: &'a str) -> Result<RawArray<'a>, Unreadable> {
    let Some(bytes) = archive.entry(&format!("{name}.npy")) else {
        return unreadable(format!("array {name} is missing"));
    };
    match parse(bytes) {
        Some((kind, shape, content)) => Ok(RawArray { name, kind, shape, content }),
        None => unreadable(format!("array {name} does not begin with a header as NumPy writes it (C order)")),
    }
}

/// Splits an array into type, shape and elements.
fn parse(bytes: &[u8]) -> Option<(&str, Vec<usize>, &[u8])> {
    let rest = bytes.strip_prefix(b"\x93NUMPY")?;
    let (length, rest) = match rest {
        [1, 0, a, b, rest @ ..] => (u32::from_le_bytes([*a, *b, 0, 0]), rest),
        [2, 0, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]), rest),
        _ => return None,
    };
    let (header, content) = rest.split_at_checked(usize::try_from(length).ok()?)?;
    let header = std::str::from_utf8(header).ok()?.strip_suffix('\n')?.trim_end_matches(' ');
    let (kind, rest) = header.strip_prefix("{'descr': '")?.split_once('\'')?;
    let dimensions = rest.strip_prefix(", 'fortran_order': False, 'shape': (")?.strip_suffix("), }")?;
    let shape = match dimensions.strip_suffix(',') {
        Some(single) => vec![dimension(single)?],
        None => dimensions.split(", ").map(dimension).collect::<Option<Vec<usize>>>()?,
    };
    (dimensions.contains(',')).then_some((kind, shape, content))
}

/// A plain decimal number.
fn dimension(text: &str) -> Option<usize> {
    let plain = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    text.parse().ok().filter(|_| plain)
}

impl RawArray<'_> {
    /// The elements, when type and shape are as stated; `None` in `expected` admits any number of rows.
    pub(crate) fn read<T: Element>(&self, expected: &[Option<usize>]) -> Result<Vec<T>, Unreadable> {
        let name = self.name;
        if self.kind != T::NAME {
            return unreadable(format!("array {name} has type {:?} instead of {:?}", self.kind, T::NAME));
        }
        let fits = |(found, expected): (&usize, &Option<usize>)| expected.is_none_or(|n| n == *found);
        if self.shape.len() != expected.len() || !self.shape.iter().zip(expected).all(fits) {
            return unreadable(format!("array {name} has shape {:?}, which the manifest does not allow", self.shape));
        }
        let length = self.shape.iter().try_fold(T::SIZE, |product, &n| product.checked_mul(n));
        if length != Some(self.content.len()) {
            return unreadable(format!("array {name} has another number of bytes than its shape says"));
        }
        Ok(self.content.chunks_exact(T::SIZE).map(T::decode).collect())
    }
}
