//! Container rules: a zip archive of stored entries in which every byte belongs to exactly one part.
//!
//! The reader copies nothing and accepts one layout only: local entries one after the other from byte 0,
//! then the central directory, then its end record. So entries cannot overlap or hide, and no two readers
//! can see different contents.

use crate::verdict::{Unreadable, unreadable};
use std::collections::BTreeMap;

/// The entries of a map file, by name.
pub(crate) struct Archive<'a> {
    entries: BTreeMap<&'a str, &'a [u8]>,
}

/// One line of the central directory, with the range of bytes that the entry takes.
struct Entry<'a> {
    name: &'a str,
    content: &'a [u8],
    start: usize,
    end: usize,
}

const END_LENGTH: usize = 22;
const CENTRAL_LENGTH: usize = 46;
const LOCAL_LENGTH: usize = 30;
const UTF8_NAME: usize = 0x0800;

impl<'a> Archive<'a> {
    /// Reads the directory and checks that the entries tile the file.
    pub(crate) fn open(bytes: &'a [u8]) -> Result<Self, Unreadable> {
        let Some(end) = bytes.len().checked_sub(END_LENGTH) else {
            return unreadable("it is too short for a zip archive");
        };
        if bytes[end..].get(..4) != Some(b"PK\x05\x06") || number(bytes, end + 20, 2)? != 0 {
            return unreadable("it does not end with a zip end record without comment (truncated?)");
        }
        if number(bytes, end + 4, 4)? != 0 || number(bytes, end + 8, 2)? != number(bytes, end + 10, 2)? {
            return unreadable("the zip archive is split over several disks");
        }
        let count = number(bytes, end + 8, 2)?;
        let directory = number(bytes, end + 16, 4)?;
        if directory.checked_add(number(bytes, end + 12, 4)?) != Some(end) {
            return unreadable("the zip directory is not where the end record says");
        }
        let mut parts = Vec::new();
        let mut at = directory;
        for _ in 0..count {
            parts.push(read_entry(bytes, &mut at, directory)?);
        }
        if at != end {
            return unreadable("the zip directory has another length than stated");
        }
        Self::from_tiling(parts, directory)
    }

    fn from_tiling(mut parts: Vec<Entry<'a>>, directory: usize) -> Result<Self, Unreadable> {
        parts.sort_by_key(|part| part.start);
        let mut covered = 0;
        let mut entries = BTreeMap::new();
        for part in parts {
            if part.start != covered {
                return unreadable(format!("entry {:?} overlaps another one or leaves a gap", part.name));
            }
            covered = part.end;
            if entries.insert(part.name, part.content).is_some() {
                return unreadable(format!("two entries are called {:?}", part.name));
            }
        }
        if covered != directory {
            return unreadable("there are bytes between the entries and the zip directory");
        }
        Ok(Archive { entries })
    }

    /// The content of one entry.
    pub(crate) fn entry(&self, name: &str) -> Option<&'a [u8]> {
        self.entries.get(name).copied()
    }

    /// The names of all entries.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'a str> + '_ {
        self.entries.keys().copied()
    }
}

/// Reads the directory line at `at`, moves on, and compares it with the local header.
fn read_entry<'a>(bytes: &'a [u8], at: &mut usize, directory: usize) -> Result<Entry<'a>, Unreadable> {
    let line = *at;
    if bytes.get(line..line + 4) != Some(b"PK\x01\x02") {
        return unreadable("the zip directory is broken");
    }
    let (flags, method) = (number(bytes, line + 8, 2)?, number(bytes, line + 10, 2)?);
    let (checksum, stored) = (number(bytes, line + 16, 4)?, number(bytes, line + 20, 4)?);
    let (size, name_length) = (number(bytes, line + 24, 4)?, number(bytes, line + 28, 2)?);
    let rest = number(bytes, line + 30, 2)? + number(bytes, line + 32, 2)?;
    let start = number(bytes, line + 42, 4)?;
    let name_bytes = slice(bytes, line + CENTRAL_LENGTH, name_length)?;
    *at = line + CENTRAL_LENGTH + name_length + rest;
    let Ok(name) = std::str::from_utf8(name_bytes) else { return unreadable("the name of an entry is not UTF-8") };
    if method != 0 || flags & !UTF8_NAME != 0 || stored != size {
        return unreadable(format!("entry {name:?} is compressed, encrypted or streamed; it has to be stored"));
    }
    let same = |offset: usize, expected: usize, placeholder: Option<usize>| -> Result<bool, Unreadable> {
        let found = number(bytes, start + offset, 4)?;
        Ok(found == expected || Some(found) == placeholder)
    };
    let zip64 = Some(0xffff_ffff); // NumPy writes the sizes of local headers into an extra field
    let local_method = number(bytes, start + 8, 2)?;
    let local_name = number(bytes, start + 26, 2)?;
    if slice(bytes, start, 4)? != b"PK\x03\x04"
        || number(bytes, start + 6, 2)? != flags
        || local_method != 0
        || slice(bytes, start + LOCAL_LENGTH, local_name)? != name_bytes
        || !same(14, checksum, None)?
        || !same(18, size, zip64)?
        || !same(22, size, zip64)?
    {
        return unreadable(format!("entry {name:?} differs between the zip directory and its header"));
    }
    let begin = start + LOCAL_LENGTH + local_name + number(bytes, start + 28, 2)?;
    let content = slice(bytes, begin, size)?;
    let end = begin + size;
    if end > directory || crc32(content) as usize != checksum {
        return unreadable(format!("entry {name:?} is damaged (its checksum does not match)"));
    }
    Ok(Entry { name, content, start, end })
}

/// The little-endian number of `length` bytes at `at`.
fn number(bytes: &[u8], at: usize, length: usize) -> Result<usize, Unreadable> {
    Ok(slice(bytes, at, length)?.iter().rev().fold(0, |value, &byte| value << 8 | usize::from(byte)))
}

/// A range of bytes, or the answer that the file is too short.
fn slice(bytes: &[u8], at: usize, length: usize) -> Result<&[u8], Unreadable> {
    match at.checked_add(length).and_then(|end| bytes.get(at..end)) {
        Some(found) => Ok(found),
        None => unreadable("the zip archive is truncated"),
    }
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
