//! Feeds damaged mesh files to the readers, without any fuzzing tool.
//!
//! Usage: `cargo run --release -p homeo-core --example stress_readers -- SECONDS [FORMAT] [SEED_FILE…]`
//! The environment variable `STRESS_SEED` (a number) starts another sequence of damage.
//!
//! For each format (or the one named by its extension) valid files are damaged at random for the
//! given number of seconds. Reported: reads, how many succeeded, panics, the slowest read, and the
//! largest growth of the process's peak memory (Linux) in one read, beside the size of that input.
#![allow(clippy::print_stdout, reason = "a program")]

use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use homeo_core::io::{
    Attribute, Element, Encoding, Format, MeshFile, Values, WriteOptions, read_mesh_bytes, write_mesh_to,
};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let seconds = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(5.0);
    let only = arguments.get(1).and_then(|text| Format::of_path(format!("a.{text}").as_ref()));
    let files: Vec<PathBuf> = arguments.iter().skip(2).map(PathBuf::from).collect();
    // Panics are counted; the first bytes of the input are printed instead of the usual message.
    std::panic::set_hook(Box::new(|info| println!("panic: {info}")));
    for format in Format::ALL.into_iter().filter(|&format| only.is_none_or(|only| only == format)) {
        let mut seeds = seeds(format);
        let of_format = files.iter().filter(|file| Format::of_path(file) == Some(format));
        seeds.extend(of_format.filter_map(|file| std::fs::read(file).ok()).filter(|bytes| !bytes.is_empty()));
        stress(format, &seeds, Duration::from_secs_f64(seconds));
    }
}

/// A generator of numbers that repeats in every run (xorshift).
pub struct Random(pub u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % limit.max(1)
    }
}

fn stress(format: Format, seeds: &[Vec<u8>], duration: Duration) {
    let seed = std::env::var("STRESS_SEED").ok().and_then(|text| text.parse::<u64>().ok()).unwrap_or_default();
    let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
    let start = Instant::now();
    let (mut reads, mut successes, mut panics) = (0_u64, 0_u64, 0_u64);
    let mut slowest = (Duration::ZERO, 0);
    let mut widest = (0_u64, 0);
    while start.elapsed() < duration {
        let input = damaged(seeds, &mut random);
        // Asking for memory is slow: every 16th read is watched.
        let before = if reads.is_multiple_of(16) { reset_peak() } else { None };
        let begin = Instant::now();
        let result = catch_unwind(AssertUnwindSafe(|| read_mesh_bytes(format, "damaged".as_ref(), &input).is_ok()));
        slowest = slowest.max((begin.elapsed(), input.len()));
        if let (Some(before), Some(after)) = (before, status("VmHWM:")) {
            widest = widest.max((after.saturating_sub(before), input.len()));
        }
        reads += 1;
        match result {
            Ok(is_ok) => successes += u64::from(is_ok),
            Err(_) => {
                panics += 1;
                println!("  input: {}", String::from_utf8_lossy(&input[..input.len().min(2000)]).escape_debug());
            }
        }
    }
    println!(
        "{:16} {reads} reads, {successes} succeeded, {panics} panics, slowest {:.1} ms for {} bytes, \
         most memory {} KiB for {} bytes",
        format.name(),
        slowest.0.as_secs_f64() * 1e3,
        slowest.1,
        widest.0,
        widest.1
    );
}

/// Sets the peak memory to the present memory and gives that, in KiB.
fn reset_peak() -> Option<u64> {
    std::fs::File::create("/proc/self/clear_refs").ok()?.write_all(b"5").ok()?;
    status("VmRSS:")
}

fn status(field: &str) -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with(field))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

/// A seed with one to eight changes.
pub fn damaged(seeds: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    const WORDS: [&[u8]; 16] = [
        b"-1",
        b"0",
        b"nan",
        b"1e999",
        b"4294967295",
        b"4294967296",
        b"99999999999999999999",
        b"2147483648",
        b"#",
        b"\n",
        b"\\\n",
        b"",
        b"-",
        b"1000000",
        b"18446744073709551615",
        b"\x00\xff\xff\xff\xff\xff\xff\x7f",
    ];
    let mut bytes = seeds[random.below(seeds.len())].clone();
    for _ in 0..=random.below(8) {
        let length = bytes.len();
        let (from, to) = (random.below(length), random.below(length + 1));
        let end = (from + random.below(64)).min(length);
        match random.below(8) {
            0 => bytes.truncate(to),
            1 | 2 if length > 0 => bytes[from] = random.below(256) as u8,
            3 if length > 0 => bytes[from] ^= 1 << random.below(8),
            4 => drop(bytes.drain(from..end)),
            5 => drop(bytes.splice(to..to, bytes[from..end].to_vec())),
            6 => {
                let other = &seeds[random.below(seeds.len())];
                let start = random.below(other.len());
                let part = &other[start..(start + random.below(200)).min(other.len())];
                drop(bytes.splice(from..end, part.iter().copied()));
            }
            _ => replace_word(&mut bytes, from, WORDS[random.below(WORDS.len())]),
        }
    }
    bytes
}

/// Replaces the word around `at`.
fn replace_word(bytes: &mut Vec<u8>, at: usize, word: &[u8]) {
    let is_end = |byte: &u8| byte.is_ascii_whitespace() || b",[]\"<>".contains(byte);
    let start = bytes[..at].iter().rposition(is_end).map_or(0, |index| index + 1);
    let length = bytes[start..].iter().position(is_end).unwrap_or(bytes.len() - start);
    drop(bytes.splice(start..start + length, word.iter().copied()));
}

/// Valid files of several sizes and encodings.
pub fn seeds(format: Format) -> Vec<Vec<u8>> {
    let mut seeds = Vec::new();
    for size in [1, 4, 40] {
        for mesh in [grid(size, false), grid(size, true)] {
            for encoding in [Encoding::Text, Encoding::Binary] {
                let mut bytes = Vec::new();
                if write_mesh_to(&mut bytes, format, &mesh, &WriteOptions { encoding }).is_ok() {
                    seeds.push(bytes);
                }
            }
        }
    }
    seeds
}

/// A grid of `size × size` squares, each two triangles, with tetrahedra above if wished.
fn grid(size: u32, has_tetrahedra: bool) -> MeshFile {
    let side = size + 1;
    let point = |index: u32| [f64::from(index % side), f64::from(index / side) / 3.0, 0.1];
    let mut positions: Vec<[f64; 3]> = (0..side * side).map(point).collect();
    let squares = (0..size * size).map(|index| index / size * side + index % size);
    let triangles: Vec<[u32; 3]> =
        squares.flat_map(|a| [[a, a + 1, a + side], [a + 1, a + side + 1, a + side]]).collect();
    let apex = positions.len() as u32;
    if has_tetrahedra {
        positions.push([0.5, 0.5, 9.0]);
    }
    let mut mesh = MeshFile::from_triangles(positions, &triangles);
    if has_tetrahedra {
        mesh.tetrahedra = triangles.iter().map(|&[a, b, c]| [a, b, c, apex]).collect();
    }
    let attribute =
        |name: &str, element, components, values| Attribute { name: name.to_string(), element, components, values };
    let tags = (0..triangles.len() as i64).map(|index| index % 5).collect();
    let texture = (0..6 * triangles.len()).map(|index| index as f64 / 7.0).collect();
    let groups = (0..triangles.len()).map(|index| if index % 3 == 0 { "a".into() } else { "b".into() }).collect();
    let heat = (0..mesh.vertex_count).map(|index| index as f64 / 3.0).collect();
    mesh.attributes = vec![
        attribute("tag", Element::Polygon, 1, Values::I64(tags)),
        attribute("texture", Element::Corner, 2, Values::F64(texture)),
        attribute("group", Element::Polygon, 1, Values::Text(groups)),
        attribute("heat", Element::Vertex, 1, Values::F64(heat)),
    ];
    mesh
}
