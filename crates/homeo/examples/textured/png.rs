//! A writer of images, just large enough.

use std::io;
use std::path::Path;

/// Writes pixels, row by row from the top.
pub fn write(path: &Path, width: usize, pixels: &[[u8; 3]]) -> io::Result<()> {
    let height = pixels.len() / width;
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    let size = [width as u32, height as u32].map(u32::to_be_bytes).concat();
    chunk(&mut bytes, b"IHDR", &[size.as_slice(), &[8, 2, 0, 0, 0]].concat());
    // No differences: pixels repeat more often than they change evenly.
    let row = |row: &[[u8; 3]]| std::iter::once(0).chain(row.iter().flatten().copied()).collect::<Vec<u8>>();
    let rows: Vec<u8> = pixels.chunks_exact(width).flat_map(row).collect();
    chunk(&mut bytes, b"IDAT", &miniz_oxide::deflate::compress_to_vec_zlib(&rows, 10));
    chunk(&mut bytes, b"IEND", &[]);
    std::fs::write(path, bytes)
}

fn chunk(bytes: &mut Vec<u8>, name: &[u8; 4], content: &[u8]) {
    bytes.extend((content.len() as u32).to_be_bytes());
    let from = bytes.len();
    bytes.extend(name);
    bytes.extend(content);
    let sum = checksum(&bytes[from..]);
    bytes.extend(sum.to_be_bytes());
}

/// CRC-32.
fn checksum(bytes: &[u8]) -> u32 {
    let step = |sum: u32, _| if sum & 1 == 1 { sum >> 1 ^ 0xEDB8_8320 } else { sum >> 1 };
    !bytes.iter().fold(u32::MAX, |sum, &byte| (0..8).fold(sum ^ u32::from(byte), step))
}
