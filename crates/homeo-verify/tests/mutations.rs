//! The checker under attack: random mutations of valid maps, each judged by the oracle or by a naive reader.
//!
//! Values: one number, index, order or sign changed; rows swapped, dropped, doubled; manifest fields edited. Hash and
//! counts are recomputed, so that they do not hide a weak rule. The checker has to certify exactly the mutants
//! that the oracle finds valid. Containers: bytes and entries changed; a mutant may be certified only if a naive reader still
//! finds the same arrays and the same manifest in it.

#![allow(clippy::print_stdout)] // counts, for people

mod support;

use homeo_verify::{Verdict, verify_bytes};
use serde_json::json;
use std::collections::BTreeMap;
use support::build::all_maps;
use support::random::Random;
use support::shells::all_shells;
use support::{Map, oracle, write};

const VALUE_MUTANTS_PER_MAP: usize = 800;
const CONTAINER_MUTANTS_PER_MAP: usize = 400;

/// How often each kind of mutant was certified (harmless), refuted, undecided or unreadable.
#[derive(Default)]
struct Tally(BTreeMap<&'static str, [usize; 4]>);

impl Tally {
    fn count(&mut self, kind: &'static str, place: usize) {
        self.0.entry(kind).or_default()[place] += 1;
    }

    fn total(&self) -> usize {
        self.0.values().flatten().sum()
    }

    fn print(&self) {
        println!("{:<28} {:>9} {:>9} {:>9} {:>10}", "mutation of", "harmless", "refuted", "undecided", "unreadable");
        for (kind, [a, b, c, d]) in &self.0 {
            println!("{kind:<28} {a:>9} {b:>9} {c:>9} {d:>10}");
        }
        println!("total {}", self.total());
    }
}

fn place_of(bytes: &[u8]) -> usize {
    match verify_bytes(bytes) {
        Ok(Verdict::Certified(_)) => 0,
        Ok(Verdict::Refuted(_)) => 1,
        Ok(Verdict::Undecided(_)) => 2,
        Err(_) => 3,
    }
}

// Mutations of values.

fn change_float(random: &mut Random, x: f64) -> f64 {
    let special = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1.0, 4.0, -1.0, 5e-324, 1e-310, 1e300, 0.5];
    match random.below(6) {
        0 => *random.pick(&special),
        1 => -x,
        2 => f64::from_bits(x.to_bits() ^ 1 << random.below(64)),
        3 => f64::from_bits(x.to_bits().wrapping_add(1)),
        4 => x + random.unit() - 0.5,
        _ => x * 2f64.powi(random.below(9) as i32 - 4),
    }
}

fn change_index(random: &mut Random, v: u32, count: usize) -> u32 {
    match random.below(6) {
        0 => u32::MAX - random.below(2) as u32,
        1 => v ^ 1 << random.below(32),
        2 => v.wrapping_add(1),
        _ => random.below(count + 1) as u32,
    }
}

fn change_small(random: &mut Random, d: i8) -> i8 {
    match random.below(4) {
        0 => d.wrapping_neg(),
        1 => 0,
        2 => d.wrapping_add(if random.below(2) == 0 { 1 } else { -1 }),
        _ => random.next() as i8,
    }
}

fn change_weight(random: &mut Random, w: i64) -> i64 {
    match random.below(5) {
        0 => w.wrapping_neg(),
        1 => *random.pick(&[0, i64::MAX, i64::MIN, 1 << 62, -1]),
        2 => w + 1,
        3 => w ^ 1 << random.below(64),
        _ => w.wrapping_mul(2),
    }
}

/// Swaps, drops, doubles or overwrites rows.
fn shuffle_rows<T: Clone>(random: &mut Random, rows: &mut Vec<T>) {
    let (i, j) = (random.below(rows.len()), random.below(rows.len()));
    match (rows.len(), random.below(4)) {
        (0, _) => {}
        (_, 0) => drop(rows.remove(i)),
        (_, 1) => rows.push(rows[i].clone()),
        (_, 2) => rows[i] = rows[j].clone(),
        _ => rows.swap(i, j),
    }
}

/// Changes one number, or swaps two, or swaps rows.
fn change_table<T: Clone>(random: &mut Random, rows: &mut Vec<Vec<T>>, change: impl Fn(&mut Random, &T) -> T) {
    let (i, action) = (random.below(rows.len()), random.below(4));
    if rows.is_empty() || rows[i].is_empty() {
        return;
    }
    let (j, k) = (random.below(rows[i].len()), random.below(rows[i].len()));
    match action {
        0 => rows[i].swap(j, k),
        1 => shuffle_rows(random, rows),
        _ => rows[i][j] = change(random, &rows[i][j]),
    }
}

/// Keeps a direction's sum: moves some from one entry to another, or scales, turns or permutes the row.
fn change_direction(random: &mut Random, row: &mut [i8]) {
    let (i, j) = (random.below(row.len()), random.below(row.len()));
    let amount = 1 + random.below(3) as i8;
    match random.below(5) {
        0 => row.iter_mut().for_each(|d| *d = d.wrapping_neg()),
        1 => row.iter_mut().for_each(|d| *d = d.wrapping_mul(2)),
        2 => row.swap(i, j),
        3 => drop(support::build::turn(row, i)),
        _ => {
            row[i] = row[i].wrapping_add(amount);
            row[j] = row[j].wrapping_sub(amount);
        }
    }
}

/// Drops or doubles a cell with everything that belongs to it.
fn change_whole_cell(random: &mut Random, map: &mut Map) {
    let (c, doubles) = (random.below(map.cells().len()), random.below(2) == 0);
    fn edit<T: Clone>(rows: &mut Vec<T>, c: usize, doubles: bool) {
        if c < rows.len() && doubles {
            rows.push(rows[c].clone());
        } else if c < rows.len() {
            rows.remove(c);
        }
    }
    edit(map.cells_mut(), c, doubles);
    edit(&mut map.directions, c, doubles);
    edit(&mut map.lengths, c, doubles);
    if let Some(r) = &mut map.refinement {
        edit(&mut r.parents, c, doubles);
    }
}

/// Swaps two cells with everything that belongs to them: harmless.
fn swap_whole_cells(random: &mut Random, map: &mut Map) {
    let (c, d) = (random.below(map.cells().len()), random.below(map.cells().len()));
    map.cells_mut().swap(c, d);
    if !map.directions.is_empty() {
        map.directions.swap(c, d);
        map.lengths.swap(c, d);
    }
    if let Some(r) = &mut map.refinement {
        r.parents.swap(c, d);
    }
    let centre = map.manifest["centre"]["cell"].as_u64();
    if let Some(at) = [(c, d), (d, c)].iter().find(|pair| centre == Some(pair.0 as u64)) {
        map.manifest["centre"]["cell"] = json!(at.1);
    }
}

fn mutate_values(random: &mut Random, map: &mut Map) -> &'static str {
    let (count, cell_count) = (map.vertex_count(), map.source_cells.len());
    match random.below(16) {
        0 => {
            change_table(random, &mut map.positions, |random, x| change_float(random, *x));
            "source positions"
        }
        1 => {
            change_table(random, &mut map.source_cells, |random, v| change_index(random, *v, count));
            "source cells"
        }
        2 | 3 => {
            change_table(random, &mut map.directions, |random, d| change_small(random, *d));
            "directions, one number"
        }
        4 | 5 if !map.directions.is_empty() => {
            let c = random.below(map.directions.len());
            change_direction(random, &mut map.directions[c]);
            "directions, sum kept"
        }
        6 => {
            let mut rows: Vec<Vec<u32>> = map.lengths.iter().map(|h| vec![*h]).collect();
            change_table(random, &mut rows, |random, h| change_index(random, *h, 3));
            map.lengths = rows.concat();
            "lengths"
        }
        7 => {
            let mut rows: Vec<Vec<u32>> = map.section_vertices.iter().map(|v| vec![*v]).collect();
            change_table(random, &mut rows, |random, v| change_index(random, *v, count));
            map.section_vertices = rows.concat();
            "section vertices"
        }
        8 => {
            change_table(random, &mut map.section_coordinates, |random, x| change_float(random, *x));
            "section coordinates"
        }
        9 => {
            let pairs = map.section_vertices.iter().copied().zip(map.section_coordinates.iter().cloned());
            let mut rows: Vec<(u32, Vec<f64>)> = pairs.collect();
            shuffle_rows(random, &mut rows);
            (map.section_vertices, map.section_coordinates) = rows.into_iter().unzip();
            "section rows"
        }
        10 | 11 if !map.target_positions.is_empty() => {
            change_table(random, &mut map.target_positions, |random, x| change_float(random, *x));
            "target positions"
        }
        12 => {
            change_whole_cell(random, map);
            "whole cells dropped, doubled"
        }
        13 => {
            swap_whole_cells(random, map);
            "whole cells swapped"
        }
        _ => mutate_refinement(random, map, count, cell_count),
    }
}

fn mutate_refinement(random: &mut Random, map: &mut Map, count: usize, cell_count: usize) -> &'static str {
    let Some(r) = &mut map.refinement else {
        change_table(random, &mut map.source_cells, |random, v| change_index(random, *v, count));
        return "source cells";
    };
    match random.below(4) {
        0 => change_table(random, &mut r.cells, |random, v| change_index(random, *v, count)),
        1 => change_table(random, &mut r.carrier_vertices, |random, v| change_index(random, *v, map.positions.len())),
        2 => change_table(random, &mut r.carrier_weights, |random, w| change_weight(random, *w)),
        _ => {
            let c = random.below(r.parents.len());
            r.parents[c] = change_index(random, r.parents[c], cell_count);
        }
    }
    "refinement"
}

fn mutate_manifest(random: &mut Random, map: &mut Map) {
    let m = &mut map.manifest;
    let values =
        [json!(null), json!(-1), json!(0), json!(1.0), json!(1), json!(2), json!(3), json!("x"), json!([]), json!({})];
    let names = ["square", "disk", "cube", "ball", "foliation", "piecewise-linear", "homeo"].map(|name| json!(name));
    let keys: Vec<String> = m.as_object().expect("an object").keys().cloned().collect();
    let key = random.pick(&keys).clone();
    match random.below(8) {
        0 => drop(m.as_object_mut().expect("an object").remove(&key)),
        1 => m[&key] = random.pick(&values).clone(),
        2 => m[&key] = random.pick(&names).clone(),
        3 => m["centre"] = json!({"cell": random.below(60), "length": random.next() >> random.below(64)}),
        4 => {
            let inner = *random.pick(&["vertices", "cells", "content_sha256", "name"]);
            m["source"][inner] = random.pick(&values).clone();
        }
        5 => {
            let hash = m["source"]["content_sha256"].as_str().expect("a hash");
            m["source"]["content_sha256"] = json!(hash.replacen(['0', '1', '2'], "3", 1));
        }
        6 => m["length_unit"] = json!(random.unit()),
        _ => m[*random.pick(&["extra", "note_extra", "Version"])] = json!(1),
    }
}

#[test]
fn mutants_are_certified_exactly_when_the_oracle_finds_them_valid() {
    let (mut random, mut tally) = (Random(2024), Tally::default());
    for (name, valid) in all_maps() {
        let original = valid.bytes();
        let mut made = 0;
        while made < VALUE_MUTANTS_PER_MAP {
            let mut map = valid.clone();
            let kind = if random.below(8) == 0 {
                mutate_manifest(&mut random, &mut map);
                "manifest"
            } else {
                let kind = mutate_values(&mut random, &mut map);
                map.sign();
                kind
            };
            let bytes = map.bytes();
            if bytes == original {
                continue; // this kind of map does not have what was changed
            }
            made += 1;
            let place = place_of(&bytes);
            tally.count(kind, place);
            let expected = oracle::is_valid(&map);
            assert_eq!(place == 0, expected, "{name}, {kind}: {:?}\n{map:?}", verify_bytes(&bytes));
        }
    }
    tally.print();
    assert!(tally.total() >= 11_000 && tally.0.values().all(|counts| counts.iter().sum::<usize>() >= 50));
}

// Mutations of the container.

fn mutate_entries(random: &mut Random, entries: &mut Vec<(String, Vec<u8>)>) -> &'static str {
    let (i, j) = (random.below(entries.len()), random.below(entries.len()));
    match random.below(8) {
        0 => drop(entries.remove(i)),
        1 => entries.push(entries[i].clone()),
        2 => entries[i].0 = random.pick(&["cells.npy", "extra.npy", "lengths", "note_1", "../x", ""]).to_string(),
        3 => entries.push(("note_anything".to_owned(), vec![1, 2, 3])),
        4 => entries.swap(i, j),
        5 => {
            let content = entries[i].1.clone();
            entries[j].1 = content;
        }
        6 => {
            let length = random.below(entries[i].1.len());
            entries[i].1.truncate(length);
        }
        _ => {
            let header = random.below(entries[i].1.len().min(128));
            entries[i].1[header] ^= 1 << random.below(8);
        }
    }
    "entries"
}

fn mutate_bytes(random: &mut Random, bytes: &mut Vec<u8>) -> &'static str {
    let at = if random.below(2) == 0 { random.below(bytes.len()) } else { bytes.len() - 1 - random.below(600) };
    match random.below(5) {
        0 => bytes.truncate(at),
        1 => drop(bytes.remove(at)),
        2 => bytes.insert(at, random.next() as u8),
        3 => bytes[at] = random.next() as u8,
        _ => bytes[at] ^= 1 << random.below(8),
    }
    "bytes of the file"
}

/// The entries that count, sorted; of the manifest what claims rest on.
fn content(bytes: &[u8]) -> Option<Vec<(String, Vec<u8>)>> {
    let mut entries = write::naive_unzip(bytes)?;
    entries.retain(|(name, _)| !name.starts_with("note_"));
    let (_, manifest) = entries.iter_mut().find(|(name, _)| name == "manifest.json")?;
    let mut value: serde_json::Value = serde_json::from_slice(manifest).ok()?;
    let top = value.as_object_mut()?;
    top.retain(|key, _| !key.starts_with("note_") && key != "length_unit" && key != "construction");
    top.get_mut("source")?
        .as_object_mut()?
        .retain(|key, _| ["vertices", "cells", "content_sha256"].contains(&&key[..]));
    if let Some(centre) = top.get_mut("centre")?.as_object_mut() {
        centre.remove("length");
    }
    *manifest = serde_json::to_vec(&value).ok()?;
    entries.sort();
    Some(entries)
}

#[test]
fn damaged_containers_are_unreadable_or_hold_the_same_map() {
    let (mut random, mut tally) = (Random(7), Tally::default());
    for (name, valid) in all_maps().into_iter().chain(all_shells().into_iter().take(1)) {
        let original = valid.bytes();
        for _ in 0..CONTAINER_MUTANTS_PER_MAP {
            let (kind, bytes) = if random.below(2) == 0 {
                let mut entries = write::entries(&valid);
                (mutate_entries(&mut random, &mut entries), write::zip(&entries))
            } else {
                let mut bytes = original.clone();
                (mutate_bytes(&mut random, &mut bytes), bytes)
            };
            let place = place_of(&bytes);
            tally.count(kind, place);
            assert!(place != 0 || content(&bytes) == content(&original), "{name}, {kind}: another map is certified");
        }
    }
    tally.print();
    assert!(tally.total() >= 5_000);
}
