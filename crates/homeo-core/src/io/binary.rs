//! Reading numbers from the bytes of a binary file.

use super::error::{Fault, Outcome};
use super::mesh_file::Values;
use super::scan::{Scanner, announced, too_large};

/// The order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

/// A type of numbers in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// Decodes all whole numbers in `bytes` with the reader that fits the order.
macro_rules! decode {
    ($bytes:expr, $order:expr, $type:ty, $width:literal) => {{
        let chunks = $bytes.as_chunks::<$width>().0.iter();
        let little = |chunk: &[u8; $width]| <$type>::from_le_bytes(*chunk);
        let big = |chunk: &[u8; $width]| <$type>::from_be_bytes(*chunk);
        match $order {
            Order::Little => chunks.map(little).collect::<Vec<$type>>(),
            Order::Big => chunks.map(big).collect::<Vec<$type>>(),
        }
    }};
}

macro_rules! decode_wide {
    ($bytes:expr, $order:expr, $type:ty, $width:literal, $wide:ty) => {{
        let chunks = $bytes.as_chunks::<$width>().0.iter();
        let little = |chunk: &[u8; $width]| <$type>::from_le_bytes(*chunk) as $wide;
        let big = |chunk: &[u8; $width]| <$type>::from_be_bytes(*chunk) as $wide;
        match $order {
            Order::Little => chunks.map(little).collect::<Vec<$wide>>(),
            Order::Big => chunks.map(big).collect::<Vec<$wide>>(),
        }
    }};
}

impl Scalar {
    /// Bytes of one number.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Whether these are whole numbers.
    pub fn is_whole(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// All numbers in `bytes`, in the type that holds them; unsigned ones beyond 63 bits become doubles.
    pub fn decode(self, bytes: &[u8], order: Order) -> Values {
        match self {
            Self::I8 => Values::I64(decode_wide!(bytes, order, i8, 1, i64)),
            Self::U8 => Values::I64(decode_wide!(bytes, order, u8, 1, i64)),
            Self::I16 => Values::I64(decode_wide!(bytes, order, i16, 2, i64)),
            Self::U16 => Values::I64(decode_wide!(bytes, order, u16, 2, i64)),
            Self::I32 => Values::I64(decode_wide!(bytes, order, i32, 4, i64)),
            Self::U32 => Values::I64(decode_wide!(bytes, order, u32, 4, i64)),
            Self::I64 => Values::I64(decode!(bytes, order, i64, 8)),
            Self::U64 => {
                let values = decode_wide!(bytes, order, u64, 8, i64);
                if values.iter().all(|&value| value >= 0) {
                    Values::I64(values)
                } else {
                    Values::F64(values.into_iter().map(|value| value as u64 as f64).collect())
                }
            }
            Self::F32 => Values::F32(decode!(bytes, order, f32, 4)),
            Self::F64 => Values::F64(decode!(bytes, order, f64, 8)),
        }
    }

    /// All numbers in `bytes` as doubles, which is exact but for whole numbers beyond 53 bits.
    pub fn decode_f64(self, bytes: &[u8], order: Order) -> Vec<f64> {
        match self {
            Self::F32 => decode_wide!(bytes, order, f32, 4, f64),
            Self::F64 => decode!(bytes, order, f64, 8),
            _ => match self.decode(bytes, order) {
                Values::I64(values) => values.into_iter().map(|value| value as f64).collect(),
                Values::F64(values) => values,
                Values::F32(_) | Values::Text(_) => Vec::new(),
            },
        }
    }

    /// All numbers in `bytes` as indices; those that do not fit become `u32::MAX`, which names nothing.
    pub fn decode_indices(self, bytes: &[u8], order: Order) -> Vec<u32> {
        let mut indices = Vec::with_capacity(bytes.len() / self.size());
        self.decode_indices_into(bytes, order, &mut indices);
        indices
    }

    /// The same, added to a list.
    pub fn decode_indices_into(self, bytes: &[u8], order: Order, indices: &mut Vec<u32>) {
        match self {
            Self::U32 | Self::I32 => {
                let largest = if self == Self::I32 { i32::MAX as u32 } else { u32::MAX };
                let chunks = bytes.as_chunks::<4>().0.iter();
                let narrow = |index: u32| if index > largest { u32::MAX } else { index };
                match order {
                    Order::Little => indices.extend(chunks.map(|chunk| narrow(u32::from_le_bytes(*chunk)))),
                    Order::Big => indices.extend(chunks.map(|chunk| narrow(u32::from_be_bytes(*chunk)))),
                }
            }
            Self::I64 | Self::U64 => {
                let chunks = bytes.as_chunks::<8>().0.iter();
                let narrow = |index: u64| u32::try_from(index).unwrap_or(u32::MAX);
                match order {
                    Order::Little => indices.extend(chunks.map(|chunk| narrow(u64::from_le_bytes(*chunk)))),
                    Order::Big => indices.extend(chunks.map(|chunk| narrow(u64::from_be_bytes(*chunk)))),
                }
            }
            _ => match self.decode(bytes, order) {
                Values::I64(values) => {
                    indices.extend(values.into_iter().map(|value| u32::try_from(value).unwrap_or(u32::MAX)));
                }
                other => indices.resize(indices.len() + other.len(), u32::MAX),
            },
        }
    }

    /// `count` numbers from a text.
    pub fn read_text(self, scanner: &mut Scanner<'_>, count: usize, what: &str) -> Outcome<Values> {
        match self {
            Self::F64 => {
                let mut values = Vec::with_capacity(count);
                for _ in 0..count {
                    values.push(scanner.float(what)?);
                }
                Ok(Values::F64(values))
            }
            Self::F32 => {
                let mut values = Vec::with_capacity(count);
                for _ in 0..count {
                    values.push(scanner.single(what)?);
                }
                Ok(Values::F32(values))
            }
            _ => {
                let mut values = Vec::with_capacity(count);
                for _ in 0..count {
                    values.push(scanner.integer(what)?);
                }
                Ok(Values::I64(values))
            }
        }
    }
}

/// A place in the bytes of a binary file, moving forward.
#[derive(Clone)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    pub order: Order,
}

impl<'a> Cursor<'a> {
    pub fn new(bytes: &'a [u8], at: usize, order: Order) -> Self {
        Self { bytes, at: at.min(bytes.len()), order }
    }

    /// The byte that comes next.
    pub fn position(&self) -> usize {
        self.at
    }

    /// How many bytes are left.
    pub fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The next `count` items of `size` bytes.
    pub fn take(&mut self, count: u64, size: usize, what: &str) -> Outcome<&'a [u8]> {
        let length = count.saturating_mul(size as u64);
        if length > self.remaining() as u64 {
            return Err(self.fault("unexpected-end", announced(count, what, self.remaining())));
        }
        let bytes = &self.bytes[self.at..self.at + length as usize];
        self.at += length as usize;
        Ok(bytes)
    }

    /// Takes an announced count of things of at least `bytes_each` bytes; see [`Scanner::claim`].
    pub fn claim(&self, count: u64, bytes_each: usize, what: &str) -> Outcome<usize> {
        if count >= u64::from(u32::MAX) {
            return Err(self.fault("too-large", too_large(count, what)));
        }
        if count.saturating_mul(bytes_each as u64) > self.remaining() as u64 {
            return Err(self.fault("unexpected-end", announced(count, what, self.remaining())));
        }
        Ok(count as usize)
    }

    fn chunk<const N: usize>(&mut self, what: &str) -> Outcome<[u8; N]> {
        match self.bytes[self.at..].first_chunk::<N>() {
            Some(chunk) => {
                self.at += N;
                Ok(*chunk)
            }
            None => {
                Err(self.fault("unexpected-end", format!("the file ends where {what} should be; it may be cut short")))
            }
        }
    }

    pub fn u32(&mut self, what: &str) -> Outcome<u32> {
        let chunk = self.chunk(what)?;
        Ok(if self.order == Order::Little { u32::from_le_bytes(chunk) } else { u32::from_be_bytes(chunk) })
    }

    pub fn i32(&mut self, what: &str) -> Outcome<i32> {
        Ok(self.u32(what)? as i32)
    }

    pub fn u64(&mut self, what: &str) -> Outcome<u64> {
        let chunk = self.chunk(what)?;
        Ok(if self.order == Order::Little { u64::from_le_bytes(chunk) } else { u64::from_be_bytes(chunk) })
    }

    pub fn f64(&mut self, what: &str) -> Outcome<f64> {
        Ok(f64::from_bits(self.u64(what)?))
    }

    /// A fault at the next byte.
    #[cold]
    pub fn fault(&self, code: &'static str, message: impl Into<String>) -> Fault {
        Fault::at_byte(self.at, code, message)
    }
}
