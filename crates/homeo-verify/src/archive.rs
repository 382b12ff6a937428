//! Container rules: a zip archive of stored entries in which every byte belongs to exactly one part.
//!
//! The reader copies nothing and accepts one layout only: local entries one after the other from byte 0, then the
//! central directory that lists them in this order, then its end record. It walks through entries and directory
//! side by side, so entries cannot overlap or hide, and no two readers can see different contents.

use crate::verdict::{Unreadable, readable, unreadable};
use std::collections::BTreeMap;

/// The entries of a map file that nobody has asked for yet, by name.
pub(crate) struct Archive<'a>(pub(crate) BTreeMap<&'a str, &'a [u8]>);

impl<'a> Archive<'a> {
    /// Splits the file into its entries.
    pub(crate) fn open(bytes: &'a [u8]) -> Result<Self, Unreadable> {
        let too_short = || unreadable("it is too short for a zip archive");
        let (body, end) = bytes.split_last_chunk::<22>().ok_or_else(too_short)?;
        let is_end = end.starts_with(b"PK\x05\x06") && end[20..] == [0; 2];
        readable(is_end, "it does not end with a zip end record without comment (truncated?)")?;
        let is_whole = end[4..8] == [0; 4] && end[8..10] == end[10..12];
        readable(is_whole, "the zip archive is split over several disks")?;
        let (count, length, start) = (number(&end[8..10]), number(&end[12..16]), number(&end[16..20]));
        readable(body.len().checked_sub(start) == Some(length), "the zip directory is not where the end record says")?;
        let (mut locals, mut directory) = body.split_at(start);
        let mut entries = BTreeMap::new();
        for _ in 0..count {
            let offset = start - locals.len();
            let (name, content) = take_entry(&mut directory, &mut locals, offset)?;
            if entries.insert(name, content).is_some() {
                return Err(unreadable(format!("two entries are called {name:?}")));
            }
        }
        let is_tiled = locals.is_empty() && directory.is_empty();
        readable(is_tiled, "there are bytes between the entries, the zip directory and its end record")?;
        Ok(Archive(entries))
    }
}

/// Takes the next line of the directory and the local entry at `offset`, which have to agree: name and content.
fn take_entry<'a>(
    directory: &mut &'a [u8],
    locals: &mut &'a [u8],
    offset: usize,
) -> Result<(&'a str, &'a [u8]), Unreadable> {
    let line = take(directory, 46)?;
    let name = take(directory, number(&line[28..30]))?;
    take(directory, number(&line[30..32]) + number(&line[32..34]))?; // extra field and comment
    readable(line.starts_with(b"PK\x01\x02"), "the zip directory is broken")?;
    let text = std::str::from_utf8(name).map_err(|_| unreadable("the name of an entry is not UTF-8"))?;
    let check = |holds: bool, message: &str| readable(holds, &format!("entry {text:?} {message}"));
    // Flags: none, or that the name is UTF-8. Method: stored.
    let is_stored = matches!(line[8..12], [0, 0 | 8, 0, 0]) && line[20..24] == line[24..28];
    check(is_stored, "is compressed, encrypted or streamed; it has to be stored")?;
    check(number(&line[42..46]) == offset, "overlaps another one or leaves a gap")?;
    let header = take(locals, 30)?;
    let local_name = take(locals, number(&header[26..28]))?;
    let extra = take(locals, number(&header[28..30]))?;
    // Flags, method, time, date and checksum; then the sizes, which NumPy writes into a zip64 extra field.
    let agrees = header.starts_with(b"PK\x03\x04") && header[6..18] == line[8..20] && local_name == name;
    let size: &[u8] = &[&line[20..24], &[0; 4]].concat();
    let is_zip64 = header[18..26] == [0xff; 8] && extra == [&[1, 0, 16, 0], size, size].concat();
    let has_size = is_zip64 || header[18..26] == line[20..28];
    check(agrees && has_size, "differs between the zip directory and its header")?;
    let content = take(locals, number(size))?;
    check(crc32(content) as usize == number(&line[16..20]), "is damaged (its checksum does not match)")?;
    Ok((text, content))
}

/// Takes so many bytes away from the beginning.
fn take<'a>(bytes: &mut &'a [u8], length: usize) -> Result<&'a [u8], Unreadable> {
    bytes.split_off(..length).ok_or_else(|| unreadable("the zip archive is truncated"))
}

/// A little-endian number.
fn number(bytes: &[u8]) -> usize {
    bytes.iter().rev().fold(0, |value, &byte| value << 8 | usize::from(byte))
}

/// The checksum that zip uses.
fn crc32(bytes: &[u8]) -> u32 {
    let mut table = [0; 256];
    for (byte, entry) in (0u32..).zip(&mut table) {
        *entry = (0..8).fold(byte, |value, _| (value >> 1) ^ (0xedb8_8320 * (value & 1)));
    }
    let step = |state: u32, byte: &u8| table[usize::from(state.to_le_bytes()[0] ^ byte)] ^ (state >> 8);
    !bytes.iter().fold(u32::MAX, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksum_of_the_standard_test_string() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    }
}
