//! Arrays in the page: quantized to 16 bits, concatenated, written as base64.

use serde::Serialize;
use std::io::{self, Write};

/// The box in which points are quantized: each coordinate becomes `0..=65535` between its bounds.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Frame {
    /// Lower corner.
    pub low: [f64; 3],
    /// Upper corner.
    pub high: [f64; 3],
}

impl Frame {
    /// The smallest box around the points; the unit box where there are none.
    pub fn around<'a>(points: impl Iterator<Item = &'a [f64; 3]>) -> Self {
        let mut frame = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        for point in points {
            for (axis, &coordinate) in point.iter().enumerate() {
                frame.low[axis] = frame.low[axis].min(coordinate);
                frame.high[axis] = frame.high[axis].max(coordinate);
            }
        }
        if frame.low[0] > frame.high[0] { Self { low: [0.0; 3], high: [1.0; 3] } } else { frame }
    }

    /// A coordinate as a step of its axis. Halving first keeps boxes near the end of the range of doubles finite.
    fn step(&self, axis: usize, coordinate: f64) -> u16 {
        let half_width = 0.5 * self.high[axis] - 0.5 * self.low[axis];
        let half_offset = 0.5 * coordinate - 0.5 * self.low[axis];
        if half_width > 0.0 { (half_offset / half_width * 65535.0).round() as u16 } else { 0 }
    }
}

/// Where an array lies in the block of bytes.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Slot {
    /// First byte, a multiple of four.
    pub offset: usize,
    /// Number of entries.
    pub length: usize,
    /// `u8`, `u16` or `u32`, little endian.
    pub kind: &'static str,
}

/// All arrays of the page, one after the other.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    /// The bytes.
    pub bytes: Vec<u8>,
}

impl Block {
    /// Adds quantized points, three entries each.
    pub fn points(&mut self, frame: &Frame, points: &[[f64; 3]]) -> Slot {
        let steps = points.iter().flat_map(|point| (0..3).map(move |axis| frame.step(axis, point[axis]).to_le_bytes()));
        self.push("u16", 3 * points.len(), steps.flatten())
    }

    /// Adds indices below `bound`, in 16 bits where that is enough.
    pub fn indices(&mut self, bound: usize, indices: &[u32]) -> Slot {
        if bound <= 1 << 16 {
            self.push("u16", indices.len(), indices.iter().flat_map(|&index| (index as u16).to_le_bytes()))
        } else {
            self.push("u32", indices.len(), indices.iter().flat_map(|index| index.to_le_bytes()))
        }
    }

    /// Adds numbers of 16 bits.
    pub fn words(&mut self, words: &[u16]) -> Slot {
        self.push("u16", words.len(), words.iter().flat_map(|word| word.to_le_bytes()))
    }

    /// Adds bytes.
    pub fn octets(&mut self, octets: &[u8]) -> Slot {
        self.push("u8", octets.len(), octets.iter().copied())
    }

    fn push(&mut self, kind: &'static str, length: usize, bytes: impl Iterator<Item = u8>) -> Slot {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        Slot { offset, length, kind }
    }
}

const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Writes bytes as base64 (RFC 4648, with padding, in one line).
pub(super) fn write_base64(bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
    // A multiple of three, so that only the last piece is padded.
    for piece in bytes.chunks(3 * 4096) {
        let mut text = Vec::with_capacity(piece.len().div_ceil(3) * 4);
        for triple in piece.chunks(3) {
            let [a, b, c] = [triple[0], *triple.get(1).unwrap_or(&0), *triple.get(2).unwrap_or(&0)];
            let bits = u32::from(a) << 16 | u32::from(b) << 8 | u32::from(c);
            let digit = |shift: u32| ALPHABET[(bits >> shift & 63) as usize];
            text.extend([digit(18), digit(12)]);
            text.push(if triple.len() > 1 { digit(6) } else { b'=' });
            text.push(if triple.len() > 2 { digit(0) } else { b'=' });
        }
        out.write_all(&text)?;
    }
    Ok(())
}
