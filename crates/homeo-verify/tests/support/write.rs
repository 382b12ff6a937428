//! A tiny writer of zip and npy, with nothing of the checker in it.

use super::Map;
use sha2::{Digest, Sha256};

pub fn crc32(bytes: &[u8]) -> u32 {
    let mut state = u32::MAX;
    for byte in bytes {
        state ^= u32::from(*byte);
        for _ in 0..8 {
            state = if state & 1 == 1 { state >> 1 ^ 0xedb8_8320 } else { state >> 1 };
        }
    }
    !state
}

/// A zip archive of stored entries.
pub fn zip(entries: &[(String, Vec<u8>)]) -> Vec<u8> {
    let (mut file, mut directory) = (vec![], vec![]);
    for (name, content) in entries {
        let (offset, size) = (file.len() as u32, content.len() as u32);
        let mut common = vec![20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0]; // version, flags, method, time, date
        for number in [crc32(content), size, size] {
            common.extend(number.to_le_bytes());
        }
        common.extend((name.len() as u16).to_le_bytes());
        common.extend([0, 0]);
        file.extend(b"PK\x03\x04");
        file.extend(&common);
        file.extend(name.as_bytes());
        file.extend(content);
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&common);
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let (start, length, count) = (file.len() as u32, directory.len() as u32, entries.len() as u16);
    file.extend(directory);
    file.extend(b"PK\x05\x06\0\0\0\0");
    file.extend(count.to_le_bytes());
    file.extend(count.to_le_bytes());
    file.extend(length.to_le_bytes());
    file.extend(start.to_le_bytes());
    file.extend([0, 0]);
    file
}

/// An array; `shape` as Python writes it, for instance `(3,)` or `(3, 4)`.
pub fn npy(kind: &str, shape: &str, content: &[u8]) -> Vec<u8> {
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(content);
    bytes
}

macro_rules! little_endian {
    ($rows:expr) => {
        $rows.iter().flatten().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>()
    };
}

pub fn content_hash(map: &Map) -> String {
    let mut bytes = vec![];
    for count in [map.positions.len(), map.size(), map.source_cells.len()] {
        bytes.extend((count as u64).to_le_bytes());
    }
    bytes.extend(little_endian!(map.positions));
    bytes.extend(little_endian!(map.source_cells));
    sha256(&bytes)
}

pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// All entries of the file, in the order in which they are written.
pub fn entries(map: &Map) -> Vec<(String, Vec<u8>)> {
    let size = map.size();
    let manifest = serde_json::to_vec_pretty(&map.manifest).expect("a manifest");
    let mut entries = vec![("manifest.json".to_owned(), manifest)];
    let mut add = |name: &str, kind: &str, rows: usize, columns: usize, content: Vec<u8>| {
        let shape = if columns == 0 { format!("({rows},)") } else { format!("({rows}, {columns})") };
        entries.push((format!("{name}.npy"), npy(kind, &shape, &content)));
    };
    add("source_positions", "<f8", map.positions.len(), 3, little_endian!(map.positions));
    add("source_cells", "<u4", map.source_cells.len(), size, little_endian!(map.source_cells));
    if let Some(r) = &map.refinement {
        add("carrier_vertices", "<u4", r.carrier_vertices.len(), size, little_endian!(r.carrier_vertices));
        add("carrier_weights", "<i8", r.carrier_weights.len(), size, little_endian!(r.carrier_weights));
        add("cells", "<u4", r.cells.len(), size, little_endian!(r.cells));
        add("parents", "<u4", r.parents.len(), 0, little_endian!(std::slice::from_ref(&r.parents)));
    }
    if map.text("kind") == "shell" {
        for (name, level) in ["shell_bottom", "shell_middle", "shell_top"].into_iter().zip(&map.levels) {
            add(name, "<f8", level.len(), 3, little_endian!(level));
        }
        add("prisms", "<u4", map.prisms.len(), 3, little_endian!(map.prisms));
        if let Some((positions, cells)) = &map.section {
            add("section_positions", "<f8", positions.len(), 3, little_endian!(positions));
            add("section_cells", "<u4", cells.len(), 3, little_endian!(cells));
        }
        if let Some(pairs) = &map.pairs {
            add("shell_pairs", "<u4", pairs.len(), 2, little_endian!(pairs));
        }
        return entries;
    }
    if map.text("kind") == "moved-mesh" {
        add("target_positions", "<f8", map.target_positions.len(), 3, little_endian!(map.target_positions));
        return entries;
    }
    if map.text("kind") == "composite-cage" {
        add("stage_positions", "<f8", map.target_positions.len(), 3, little_endian!(map.target_positions));
        return entries;
    }
    if map.text("kind") == "piecewise-linear" {
        add("target_positions", "<f8", map.target_positions.len(), size - 1, little_endian!(map.target_positions));
        return entries;
    }
    add("directions", "|i1", map.directions.len(), size, little_endian!(map.directions));
    add("lengths", "<u4", map.lengths.len(), 0, little_endian!(std::slice::from_ref(&map.lengths)));
    if map.text("target") != "ball" {
        let columns = if map.text("target") == "cube" { 2 } else { 0 };
        add(
            "section_vertices",
            "<u4",
            map.section_vertices.len(),
            0,
            little_endian!(std::slice::from_ref(&map.section_vertices)),
        );
        let rows = map.section_coordinates.len();
        add("section_coordinates", "<f8", rows, columns, little_endian!(map.section_coordinates));
    }
    entries
}

/// Reads the entries of an archive by its directory, believing everything.
pub fn naive_unzip(bytes: &[u8]) -> Option<Vec<(String, Vec<u8>)>> {
    let end = bytes.len().checked_sub(22)?;
    let number = |at: usize, length: usize| {
        Some(bytes.get(at..at + length)?.iter().rev().fold(0usize, |value, byte| value << 8 | *byte as usize))
    };
    let mut at = number(end + 16, 4)?;
    let mut entries = vec![];
    for _ in 0..number(end + 10, 2)? {
        let (size, length, start) = (number(at + 20, 4)?, number(at + 28, 2)?, number(at + 42, 4)?);
        let name = String::from_utf8(bytes.get(at + 46..at + 46 + length)?.to_vec()).ok()?;
        at += 46 + length + number(at + 30, 2)? + number(at + 32, 2)?;
        let begin = start + 30 + number(start + 26, 2)? + number(start + 28, 2)?;
        entries.push((name, bytes.get(begin..begin + size)?.to_vec()));
    }
    Some(entries)
}
