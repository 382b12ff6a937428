//! The binary blocks of VTK XML files: raw or base64, plain or compressed by zlib.

use std::borrow::Cow;

use super::binary::{Cursor, Order};
use super::error::{Fault, Outcome};

/// How blocks are stored, as the first tag of the file says.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    pub order: Order,
    /// Bytes of the numbers in front of a block: 4 or 8.
    pub header_size: usize,
    pub is_compressed: bool,
}

/// How many bytes the blocks of a file may have in all, so that a small file stays small in memory.
pub(super) struct Budget {
    /// Bytes in the file: blocks do not overlap.
    stored: usize,
    /// Bytes after decompression.
    plain: usize,
}

impl Budget {
    pub fn new(file_size: usize) -> Self {
        let plain = file_size.saturating_mul(64).saturating_add(1 << 26);
        Self { stored: file_size, plain }
    }
}

/// Bytes that follow each other in the file.
pub(super) enum Source<'a> {
    Raw { bytes: &'a [u8], at: usize },
    Base64(Base64<'a>),
}

impl<'a> Source<'a> {
    fn position(&self) -> usize {
        match self {
            Self::Raw { at, .. } => *at,
            Self::Base64(base64) => base64.at,
        }
    }

    #[cold]
    fn fault(&self, code: &'static str, message: impl Into<String>) -> Fault {
        Fault::at_byte(self.position(), code, message)
    }

    fn take(&mut self, count: u64) -> Outcome<Cow<'a, [u8]>> {
        let taken = match self {
            Self::Raw { bytes, at } => {
                let rest = &bytes[(*at).min(bytes.len())..];
                usize::try_from(count).ok().and_then(|count| rest.get(..count)).map(|taken| {
                    *at += taken.len();
                    Cow::Borrowed(taken)
                })
            }
            Self::Base64(base64) => base64.take(count).map(Cow::Owned),
        };
        taken.ok_or_else(|| {
            self.fault(
                "unexpected-end",
                format!("a block announces {count} bytes, more than follow; the file may be cut short"),
            )
        })
    }

    fn number(&mut self, layout: Layout) -> Outcome<u64> {
        let bytes = self.take(layout.header_size as u64)?;
        let mut cursor = Cursor::new(&bytes, 0, layout.order);
        if layout.header_size == 8 { cursor.u64("") } else { cursor.u32("").map(u64::from) }
    }

    /// The bytes of one block.
    pub fn block(mut self, layout: Layout, budget: &mut Budget) -> Outcome<Cow<'a, [u8]>> {
        let start = self.position();
        let block = if layout.is_compressed {
            Cow::Owned(self.compressed_block(layout, budget)?)
        } else {
            let length = self.number(layout)?;
            self.take(length)?
        };
        let stored = self.position() - start;
        match budget.stored.checked_sub(stored) {
            Some(left) => budget.stored = left,
            None => return Err(self.fault("bad-syntax", "the blocks of this file overlap")),
        }
        Ok(block)
    }

    fn compressed_block(&mut self, layout: Layout, budget: &mut Budget) -> Outcome<Vec<u8>> {
        let [count, _, _] = [self.number(layout)?, self.number(layout)?, self.number(layout)?];
        let sizes = self.take(count.saturating_mul(layout.header_size as u64))?;
        let mut sizes = Cursor::new(&sizes, 0, layout.order);
        let mut plain = Vec::new();
        for _ in 0..count {
            let size = if layout.header_size == 8 { sizes.u64("")? } else { u64::from(sizes.u32("")?) };
            let packed = self.take(size)?;
            match miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(&packed, budget.plain) {
                Ok(part) => {
                    budget.plain -= part.len();
                    plain.extend_from_slice(&part);
                }
                Err(error) if error.status == miniz_oxide::inflate::TINFLStatus::HasMoreOutput => {
                    return Err(
                        self.fault("too-large", "the file holds more than 64 times its size; it is not decompressed")
                    );
                }
                Err(_) => return Err(self.fault("bad-syntax", "a compressed block is damaged")),
            }
        }
        Ok(plain)
    }
}

/// Decodes base64; padding may come at the end of any group of four, blanks anywhere.
pub(super) struct Base64<'a> {
    bytes: &'a [u8],
    at: usize,
    waiting: Vec<u8>,
}

impl<'a> Base64<'a> {
    pub fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at: at.min(bytes.len()), waiting: Vec::new() }
    }

    fn take(&mut self, count: u64) -> Option<Vec<u8>> {
        let possible = self.waiting.len() as u64 + (self.bytes.len() - self.at) as u64 / 4 * 3 + 3;
        if count > possible {
            return None;
        }
        let mut taken = Vec::with_capacity(count as usize + 3);
        taken.append(&mut self.waiting);
        while (taken.len() as u64) < count {
            self.group(&mut taken)?;
        }
        self.waiting = taken.split_off(count as usize);
        Some(taken)
    }

    /// Decodes four digits into up to three bytes.
    fn group(&mut self, out: &mut Vec<u8>) -> Option<()> {
        if let Some(&group) = self.bytes[self.at..].first_chunk::<4>() {
            let values = group.map(|byte| VALUES[usize::from(byte)]);
            if values.iter().all(|&value| value < 64) {
                let bits = values.iter().fold(0, |bits, &value| bits << 6 | u32::from(value));
                out.extend_from_slice(&bits.to_be_bytes()[1..]);
                self.at += 4;
                return Some(());
            }
        }
        self.broken_group(out)
    }

    /// A group with padding or blanks in it.
    #[cold]
    fn broken_group(&mut self, out: &mut Vec<u8>) -> Option<()> {
        let mut bits = 0_u32;
        let mut digits = 0;
        let mut seen = 0;
        while seen < 4 {
            let byte = *self.bytes.get(self.at)?;
            if byte.is_ascii_whitespace() {
                self.at += 1;
                continue;
            }
            if byte == b'=' {
                bits <<= 6;
            } else {
                bits = bits << 6 | u32::from(digit(byte)?);
                digits = seen + 1;
            }
            self.at += 1;
            seen += 1;
        }
        let bytes = bits.to_be_bytes();
        out.extend_from_slice(&bytes[1..1 + (digits * 3 / 4).min(3)]);
        (digits >= 2).then_some(())
    }
}

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// The value of each digit; 255 for bytes that are none.
const VALUES: [u8; 256] = {
    let mut values = [255; 256];
    let mut index = 0;
    while index < 64 {
        values[DIGITS[index] as usize] = index as u8;
        index += 1;
    }
    values
};

fn digit(byte: u8) -> Option<u8> {
    Some(VALUES[usize::from(byte)]).filter(|&value| value < 64)
}

/// Encodes bytes as base64 with padding.
pub(super) fn encode_base64(bytes: &[u8]) -> Vec<u8> {
    let mut text = Vec::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let mut group = [0; 4];
        group[1..=chunk.len()].copy_from_slice(chunk);
        let bits = u32::from_be_bytes(group);
        for index in 0..4 {
            let is_padding = index > chunk.len();
            text.push(if is_padding { b'=' } else { DIGITS[(bits >> (18 - 6 * index)) as usize & 63] });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_reads_back_also_where_header_and_data_are_padded_apart() {
        for length in 0..20_u8 {
            let bytes: Vec<u8> = (0..length).map(|byte| byte.wrapping_mul(73)).collect();
            let text = encode_base64(&bytes);
            assert_eq!(Base64::new(&text, 0).take(u64::from(length)), Some(bytes.clone()));
            let apart = [encode_base64(b"head"), b" \n".to_vec(), text].concat();
            let mut decoder = Base64::new(&apart, 0);
            assert_eq!(decoder.take(4).unwrap(), b"head");
            assert_eq!(decoder.take(u64::from(length)), Some(bytes));
            assert_eq!(decoder.take(1), None);
        }
    }
}
