//! Feeds damaged map files to the checker for a while: it must neither panic, nor hang, nor ask for much memory.
//!
//! `cargo run --release -p homeo-verify --example stress_map_reader -- 300` (seconds). Half of the mutants are mended
//! (checksums, hash and counts recomputed by the writer), so that they get past the container. Prints
//! executions, the answers, the slowest one and by how much the peak of memory grew.
#![allow(clippy::print_stdout)]

#[path = "../tests/support/mod.rs"]
mod support;

use homeo_verify::{Verdict, verify_bytes};
use serde_json::json;
use std::time::{Duration, Instant};
use support::{Map, build, random::Random, shells, write};

/// The largest resident memory so far in kilobytes, where the system tells (Linux).
fn peak_kilobytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|text| text.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(0.0)
}

/// Overwrites, flips, inserts, removes or copies a few bytes.
fn damage(random: &mut Random, bytes: &mut Vec<u8>) {
    for _ in 0..1 + random.below(4) {
        if bytes.is_empty() {
            return;
        }
        let (at, from) = (random.below(bytes.len()), random.below(bytes.len()));
        match random.below(7) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = *random.pick(&[0, 1, 0x7f, 0x80, 0xff, b'9', b'{', b'"']),
            2 => bytes.truncate(at),
            3 => bytes.insert(at, random.next() as u8),
            4 => drop(bytes.remove(at)),
            5 => {
                let end = (from + random.below(64)).min(bytes.len());
                let copied = bytes[from..end].to_vec();
                bytes.splice(at..at, copied);
            }
            _ => bytes.iter_mut().skip(at).take(8).for_each(|byte| *byte = 0xff),
        }
    }
}

/// A damaged file: as bytes, as entries with right checksums, or as arrays with the right hash too.
fn mutant(random: &mut Random, map: &Map) -> Vec<u8> {
    let mut entries = write::entries(map);
    match random.below(4) {
        0 => {
            let mut bytes = write::zip(&entries);
            damage(random, &mut bytes);
            return bytes;
        }
        1 => {
            let i = random.below(entries.len());
            damage(random, &mut entries[i].1);
            return write::zip(&entries);
        }
        _ => {}
    }
    for _ in 0..1 + random.below(3) {
        let i = 1 + random.below(entries.len() - 1);
        let content = &mut entries[i].1;
        let begin = 10 + usize::from(u16::from_le_bytes([content[8], content[9]]));
        let last = content.len() - begin;
        if last > 0 {
            let at = begin + random.below(last);
            content[at] = if random.below(2) == 0 { random.below(30) as u8 } else { random.next() as u8 };
        }
    }
    let mut hashed = vec![];
    for count in [map.positions.len(), map.size(), map.source_cells.len()] {
        hashed.extend((count as u64).to_le_bytes());
    }
    for (_, content) in &entries[1..3] {
        hashed.extend(&content[10 + usize::from(u16::from_le_bytes([content[8], content[9]]))..]);
    }
    let mut manifest = map.manifest.clone();
    manifest["source"]["content_sha256"] = serde_json::json!(write::sha256(&hashed));
    entries[0].1 = serde_json::to_vec(&manifest).expect("a manifest");
    write::zip(&entries)
}

fn main() {
    let seconds: u64 = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(10);
    let seed = std::env::args().nth(2).and_then(|text| text.parse().ok()).unwrap_or(1);
    let (maps, mut random) = (all_maps(), Random(seed));
    let (start, mut executions, mut answers) = (Instant::now(), 0u64, [0u64; 4]);
    let (mut slowest, mut largest, before) = (Duration::ZERO, 0, peak_kilobytes());
    while start.elapsed() < Duration::from_secs(seconds) {
        let bytes = mutant(&mut random, &random_map(&maps, executions));
        let begin = Instant::now();
        let answer = match verify_bytes(&bytes) {
            Ok(Verdict::Certified(_)) => 0,
            Ok(Verdict::Refuted(_)) => 1,
            Ok(Verdict::Undecided(_)) => 2,
            Err(_) => 3,
        };
        slowest = slowest.max(begin.elapsed());
        largest = largest.max(bytes.len());
        answers[answer] += 1;
        executions += 1;
    }
    println!("{executions} executions in {seconds} s, none panicked; slowest {slowest:?}");
    println!("certified {}, refuted {}, undecided {}, unreadable {}", answers[0], answers[1], answers[2], answers[3]);
    let growth = peak_kilobytes() - before;
    println!("peak memory grew by {growth} kB over all executions; the largest file had {} kB", largest / 1024);
}

/// Maps of every kind: onto standard shapes, shells, and shells with another section.
fn all_maps() -> Vec<(&'static str, Map)> {
    let mut maps = build::all_maps();
    for (name, shell) in shells::all_shells() {
        let mut onto_itself = shell.clone();
        onto_itself.section = Some((shell.positions.clone(), shell.source_cells.clone()));
        onto_itself.manifest["target"] = json!("section");
        maps.extend([(name, shell), (name, onto_itself)]);
    }
    maps
}

fn random_map(maps: &[(&'static str, Map)], execution: u64) -> Map {
    maps[(execution % maps.len() as u64) as usize].1.clone()
}
