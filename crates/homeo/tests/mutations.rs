//! Attack on the checker: more than 10,000 mutations of valid map files, each rejected or proved harmless.
//!
//! A mutation changes a number, swaps, drops or doubles rows, or cuts the file; the content hash is made
//! again, so that hashes hide no weak check. What the checker still certifies must be a valid map of the
//! stated kind, by a reason that is decided here without it: see [`harmless`].
#![allow(clippy::print_stdout)]

use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};

use homeo::certificate::{FoliationMap, Provenance, write_map};
use homeo::construct::foliation::{FoliationParams, build};
use homeo::input::SourceMesh;
use homeo::map::{Foliation, Target};
use homeo::progress::Silent;
use homeo_core::mesh::SimplicialComplex;
use homeo_core::number::Rational;
use homeo_core::predicate::{Sign, orient2d};
use homeo_verify::{SourceMatch, Verdict, compare_source, verify_bytes};
use sha2::{Digest, Sha256};

/// Entries of a map file by name.
type Entries = BTreeMap<String, Vec<u8>>;

const MUTATIONS_PER_MAP: usize = 2_600;

#[test]
fn every_mutation_is_rejected_or_harmless() {
    let mut counts = BTreeMap::<String, usize>::new();
    let mut total = 0;
    for (name, valid) in maps() {
        assert!(matches!(verify_bytes(&pack(&valid)), Ok(Verdict::Certified(_))), "{name} is valid to begin with");
        let mut random = Random(0x5eed + total as u64);
        for _ in 0..MUTATIONS_PER_MAP {
            let (mutant, what) = mutate(&valid, &mut random);
            total += 1;
            let outcome = match verify_bytes(&mutant) {
                Err(_) => "unreadable".to_owned(),
                Ok(Verdict::Refuted(witness)) => format!("refuted by {}", witness.rule),
                Ok(Verdict::Undecided(_)) => "undecided".to_owned(),
                Ok(Verdict::Certified(_)) => match harmless(&valid, &unpack(&mutant)) {
                    Ok(reason) => format!("harmless: {reason}"),
                    Err(problem) => panic!("{name}: {what} was certified although {problem}"),
                },
            };
            *counts.entry(outcome).or_default() += 1;
        }
    }
    counts.iter().for_each(|(outcome, count)| println!("{count:>6} {outcome}"));
    println!("{total:>6} mutations in all");
    assert!(total >= 10_000);
    let rejected: usize = counts.iter().filter(|(o, _)| !o.starts_with("harmless")).map(|(_, n)| n).sum();
    assert!(rejected * 2 > total, "most mutations change the claim");
}

/// Why a certified mutant is a valid map, although it is not the original.
///
/// Theorems allow any positive lengths, any directions of the same signs with zero sum, any section
/// that is a homeomorphism, and any positions that leave the cells positive: these are recomputed here.
fn harmless(valid: &Entries, mutant: &Entries) -> Result<&'static str, String> {
    let mut reason = "nothing of the map changed";
    let names = valid.keys().chain(mutant.keys()).filter(|n| !n.starts_with("note_"));
    for name in names.filter(|n| valid.get(*n) != mutant.get(*n)) {
        let (Some(before), Some(after)) = (valid.get(name), mutant.get(name)) else {
            return Err(format!("{name} came or went"));
        };
        reason = match name.as_str() {
            "manifest.json" => same_claim(before, after)?,
            "lengths.npy" if numbers(after, 4).contains(&0) => return Err("a length is 0".to_owned()),
            "lengths.npy" => "other lengths, all positive",
            "directions.npy" => same_signs(data(before), data(after))?,
            "section_coordinates.npy" => section_is_homeomorphism(mutant)?,
            "source_positions.npy" => other_source(valid, mutant)?,
            "carrier_weights.npy" | "carrier_vertices.npy" => subdivision_is_exact(mutant)?,
            _ => return Err(format!("{name} changed")),
        };
    }
    Ok(reason)
}

fn same_claim(before: &[u8], after: &[u8]) -> Result<&'static str, String> {
    let parse = |bytes: &[u8]| serde_json::from_slice::<serde_json::Value>(bytes).map_err(|e| e.to_string());
    let (mut before, mut after) = (parse(before)?, parse(after)?);
    for manifest in [&mut before, &mut after] {
        for key in ["length_unit", "construction"] {
            manifest.as_object_mut().ok_or("no object")?.remove(key);
        }
        let source = manifest["source"].as_object_mut().ok_or("no source")?;
        source.remove("name");
        source.remove("content_sha256");
        if let Some(length) = manifest["centre"]["length"].as_u64().filter(|&l| l >= 1) {
            debug_assert!(length >= 1);
            manifest["centre"]["length"] = 1.into();
        }
    }
    if before == after {
        Ok("no claim rests on it, or another radius of the centre")
    } else {
        Err("the manifest claims something else".into())
    }
}

fn same_signs(before: &[u8], after: &[u8]) -> Result<&'static str, String> {
    let signs = |bytes: &[u8]| bytes.iter().map(|&b| (b as i8).signum()).collect::<Vec<_>>();
    if signs(before) == signs(after) { Ok("another direction of the same signs") } else { Err("a sign changed".into()) }
}

fn section_is_homeomorphism(mutant: &Entries) -> Result<&'static str, String> {
    let values = doubles(&mutant["section_coordinates.npy"]);
    let target = target(mutant);
    if target != Target::Cube {
        let increasing = values.windows(2).all(|w| w[0] < w[1]) && values[0] == 0.0;
        let ends = if target == Target::Square { values.last() == Some(&1.0) } else { values.last() < Some(&4.0) };
        return if increasing && ends {
            Ok("another section, strictly increasing")
        } else {
            Err("the section is not monotone".into())
        };
    }
    let vertices = numbers(&mutant["section_vertices.npy"], 4);
    let place = |v: i64| vertices.iter().position(|&s| s == v).map(|k| [values[2 * k], values[2 * k + 1]]);
    let sign = |[a, b, c]: [[f64; 2]; 3]| orient2d(a, b, c);
    let (cells, directions) = (foliated_cells(mutant), data(&mutant["directions.npy"]));
    let mut signs = Vec::new();
    for (c, cell) in cells.chunks(4).enumerate() {
        for i in (0..4).filter(|&i| directions[4 * c + i] as i8 > 0) {
            // A source facet: no other cell contains its three vertices.
            let facet: Vec<i64> = (0..4).filter(|&k| k != i).map(|k| cell[k]).collect();
            if cells.chunks(4).filter(|other| facet.iter().all(|v| other.contains(v))).count() == 1 {
                let corners: Option<Vec<_>> = facet.iter().map(|&v| place(v)).collect();
                let corners: [[f64; 2]; 3] = corners.and_then(|c| c.try_into().ok()).ok_or("a vertex has no image")?;
                // Cells are positive, so facets take turns in how their vertices run as seen from inside.
                signs.push(if i % 2 == 0 { sign(corners) } else { sign(corners).reversed() });
            }
        }
    }
    let agree = signs.iter().all(|&s| s == signs[0]) && signs[0] != Sign::Zero;
    let framed = values.iter().all(|x| (0.0..=1.0).contains(x));
    if agree && framed {
        Ok("another section of positive triangles in the square")
    } else {
        Err("the section folds".into())
    }
}

fn other_source(valid: &Entries, mutant: &Entries) -> Result<&'static str, String> {
    let positions = |entries: &Entries| -> Vec<[f64; 3]> {
        doubles(&entries["source_positions.npy"]).chunks(3).map(|p| [p[0], p[1], p[2]]).collect()
    };
    let k = if target(valid).dimension() == 2 { 3 } else { 4 };
    let cells: Vec<u32> = numbers(&valid["source_cells.npy"], 4).iter().map(|&v| v as u32).collect();
    let matches = compare_source(&pack(mutant), &positions(valid), &cells, k).map_err(|e| e.to_string())?;
    if matches!(matches, SourceMatch::Same) {
        return Err("the other source passes for the original".into());
    }
    let moved = positions(mutant);
    if k == 4
        && !cells.chunks(4).all(|c| exact_volume(&[0, 1, 2, 3].map(|i| moved[c[i] as usize])).sign() == Sign::Positive)
    {
        return Err("a cell of the other source is not positive".into());
    }
    Ok("a valid map of another source, which does not pass for the original")
}

fn exact_volume(corners: &[[f64; 3]; 4]) -> Rational {
    let exact = |x: f64| Rational::from_f64(x).expect("finite");
    let span = |i: usize, axis: usize| &exact(corners[i][axis]) - &exact(corners[0][axis]);
    let [a, b, c] = [1, 2, 3].map(|i| [0, 1, 2].map(|axis| span(i, axis)));
    determinant(&[a.to_vec(), b.to_vec(), c.to_vec()])
}

fn determinant(rows: &[Vec<Rational>]) -> Rational {
    if rows.is_empty() {
        return Rational::ONE;
    }
    let mut sum = Rational::ZERO;
    for column in 0..rows.len() {
        let minor: Vec<Vec<Rational>> = rows[1..]
            .iter()
            .map(|row| row.iter().enumerate().filter(|&(j, _)| j != column).map(|(_, x)| x.clone()).collect())
            .collect();
        let term = &rows[0][column] * &determinant(&minor);
        sum = if column % 2 == 0 { &sum + &term } else { &sum - &term };
    }
    sum
}

/// The refined cells of each source cell are positive and their volumes add up to exactly 1.
fn subdivision_is_exact(mutant: &Entries) -> Result<&'static str, String> {
    let k = if target(mutant).dimension() == 2 { 3 } else { 4 };
    let source_cells = numbers(&mutant["source_cells.npy"], 4);
    let (carriers, weights) = (numbers(&mutant["carrier_vertices.npy"], 4), numbers(&mutant["carrier_weights.npy"], 8));
    let parents = numbers(&mutant["parents.npy"], 4);
    let source_vertices = data(&mutant["source_positions.npy"]).len() / 24;
    let mut sums = vec![Rational::ZERO; source_cells.len() / k];
    for (cell, parent) in foliated_cells(mutant).chunks(k).zip(parents) {
        let corners = &source_cells[parent as usize * k..][..k];
        let row = |&v: &i64| -> Vec<Rational> {
            let mut row = vec![Rational::ZERO; k];
            let mut add = |vertex: i64, weight: i64, total: i64| {
                if let Some(j) = corners.iter().position(|&c| c == vertex) {
                    row[j] = &row[j] + &(&Rational::from(weight) / &Rational::from(total));
                }
            };
            match (v as usize).checked_sub(source_vertices) {
                None => add(v, 1, 1),
                Some(added) => {
                    let range = added * k..(added + 1) * k;
                    let total: i64 = weights[range.clone()].iter().sum();
                    range.filter(|&i| weights[i] != 0).for_each(|i| add(carriers[i], weights[i], total));
                }
            }
            row
        };
        let volume = determinant(&cell.iter().map(row).collect::<Vec<_>>());
        if volume.sign() != Sign::Positive {
            return Err("a refined cell is not positive".into());
        }
        sums[parent as usize] = &sums[parent as usize] + &volume;
    }
    if sums.iter().all(|s| *s == Rational::ONE) {
        Ok("another exact subdivision")
    } else {
        Err("the refined cells do not fill their parents".into())
    }
}

fn foliated_cells(entries: &Entries) -> Vec<i64> {
    numbers(entries.get("cells.npy").unwrap_or(&entries["source_cells.npy"]), 4)
}

fn target(entries: &Entries) -> Target {
    let manifest: serde_json::Value = serde_json::from_slice(&entries["manifest.json"]).expect("a manifest");
    manifest["target"].as_str().expect("a target").parse().expect("a target")
}

/// The bytes behind the header of an array.
fn data(array: &[u8]) -> &[u8] {
    &array[10 + usize::from(u16::from_le_bytes([array[8], array[9]]))..]
}

fn numbers(array: &[u8], size: usize) -> Vec<i64> {
    let value = |c: &[u8]| {
        if size == 4 {
            i64::from(u32::from_le_bytes(c.try_into().unwrap()))
        } else {
            i64::from_le_bytes(c.try_into().unwrap())
        }
    };
    data(array).chunks_exact(size).map(value).collect()
}

fn doubles(array: &[u8]) -> Vec<f64> {
    data(array).chunks_exact(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect()
}

/// One random change of a valid file, and what it was.
fn mutate(valid: &Entries, random: &mut Random) -> (Vec<u8>, String) {
    let mut entries = valid.clone();
    let names: Vec<String> = entries.keys().cloned().collect();
    let name = names[random.below(names.len())].clone();
    let bytes = entries.get_mut(&name).expect("listed");
    if name == "manifest.json" {
        let what = mutate_manifest(bytes, random);
        return (pack(&entries), what);
    }
    let (size, header) = (element_size(&name), bytes.len() - data(bytes).len());
    let count = data(bytes).len() / size;
    let [a, b] = [random.below(count), random.below(count)].map(|i| header + i * size);
    let kind = random.below(8);
    match kind {
        0 => (0..size).for_each(|k| bytes.swap(a + k, b + k)),
        1 => bytes.copy_within(b..b + size, a),
        2 => bytes[a + random.below(size)] ^= 1 << random.below(8),
        3 if size == 1 => bytes[a] = (bytes[a] as i8).wrapping_neg() as u8,
        3 => bytes[a + size - 1] ^= 0x80,
        4 if size == 1 => {
            // Another direction with the same sum.
            bytes[a] = bytes[a].wrapping_add(1);
            bytes[b] = bytes[b].wrapping_sub(1);
        }
        4 | 5 => bytes[a] = bytes[a].wrapping_add(1 + random.below(3) as u8),
        6 => {
            // A row fewer or more, with a header that says so.
            let (text, rest) = (String::from_utf8_lossy(&bytes[10..header]).into_owned(), bytes[header..].to_vec());
            *bytes = reshaped(&text, rest, size, random.below(2) == 0);
        }
        _ => {
            let mut file = pack(&entries);
            let cut = random.below(file.len());
            if random.below(2) == 0 {
                file.truncate(cut)
            } else {
                file[cut] ^= 1 << random.below(8)
            }
            return (file, format!("damage at byte {cut}"));
        }
    }
    renew_hash(&mut entries);
    (pack(&entries), format!("{name}: mutation {kind} at {a} and {b}"))
}

fn element_size(name: &str) -> usize {
    match name {
        "directions.npy" => 1,
        "source_positions.npy" | "section_coordinates.npy" | "carrier_weights.npy" => 8,
        _ => 4,
    }
}

/// The array with its last row dropped or doubled.
fn reshaped(header: &str, mut rest: Vec<u8>, size: usize, drop: bool) -> Vec<u8> {
    let shape =
        header.split_once('(').and_then(|(_, s)| s.split_once(')')).map(|(s, _)| s.to_owned()).unwrap_or_default();
    let dimensions: Vec<usize> = shape.split(',').filter_map(|n| n.trim().parse().ok()).collect();
    let row = size * dimensions.get(1).copied().unwrap_or(1);
    let rows = if drop { dimensions[0] - 1 } else { dimensions[0] + 1 };
    if drop {
        rest.truncate(rest.len() - row);
    } else {
        rest.extend_from_within(rest.len() - row..);
    }
    let other = dimensions.get(1).map_or(format!("{rows},"), |columns| format!("{rows}, {columns}"));
    let mut text = header.replace(&format!("({shape})"), &format!("({other})")).trim_end().to_owned();
    while (10 + text.len() + 1) % 64 != 0 {
        text.push(' ');
    }
    text.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend_from_slice(&(text.len() as u16).to_le_bytes());
    bytes.extend_from_slice(text.as_bytes());
    bytes.extend(rest);
    bytes
}

fn mutate_manifest(bytes: &mut Vec<u8>, random: &mut Random) -> String {
    let mut manifest: serde_json::Value = serde_json::from_slice(bytes).expect("a manifest");
    let choice = random.below(9);
    match choice {
        0 => manifest["target"] = ["square", "disk", "cube", "ball", "torus"][random.below(5)].into(),
        1 => manifest["dimension"] = random.below(5).into(),
        2 => manifest["version"] = random.below(3).into(),
        3 => manifest["kind"] = ["piecewise-linear", "shell", "foliation"][random.below(3)].into(),
        4 => manifest["source"]["vertices"] = random.below(100).into(),
        5 => manifest["centre"] = serde_json::json!({"cell": random.below(60), "length": random.below(3)}),
        6 => manifest["length_unit"] = 2.5.into(),
        7 => manifest["source"]["content_sha256"] = "0".repeat(64).into(),
        _ => manifest["source"]["cells"] = random.below(100).into(),
    }
    *bytes = serde_json::to_vec(&manifest).expect("serializable");
    format!("manifest, choice {choice}")
}

fn renew_hash(entries: &mut Entries) {
    let mut manifest: serde_json::Value = serde_json::from_slice(&entries["manifest.json"]).expect("a manifest");
    let (positions, cells) = (data(&entries["source_positions.npy"]), data(&entries["source_cells.npy"]));
    let k = manifest["dimension"].as_u64().expect("a number") + 1;
    let mut hash = Sha256::new();
    for count in [positions.len() as u64 / 24, k, cells.len() as u64 / 4 / k] {
        hash.update(count.to_le_bytes());
    }
    hash.update(positions);
    hash.update(cells);
    let digits: String = hash.finalize().iter().map(|b| format!("{b:02x}")).collect();
    manifest["source"]["content_sha256"] = digits.into();
    manifest["source"]["vertices"] = (positions.len() / 24).into();
    manifest["source"]["cells"] = (cells.len() as u64 / 4 / k).into();
    entries.insert("manifest.json".to_owned(), serde_json::to_vec(&manifest).expect("serializable"));
}

fn pack(entries: &Entries) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let stored = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    for (name, bytes) in entries {
        zip.start_file(name.as_str(), stored).expect("writable");
        zip.write_all(bytes).expect("writable");
    }
    zip.finish().expect("writable").into_inner()
}

fn unpack(file: &[u8]) -> Entries {
    let mut zip = zip::ZipArchive::new(Cursor::new(file)).expect("an archive");
    (0..zip.len())
        .map(|i| {
            let mut entry = zip.by_index(i).expect("listed");
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).expect("readable");
            (entry.name().expect("a name").into_owned(), bytes)
        })
        .collect()
}

/// Valid maps onto all four targets, with and without refinement.
fn maps() -> Vec<(&'static str, Entries)> {
    let n = 4u32;
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let grid: Vec<[f64; 3]> =
        (0..=n).flat_map(|i| (0..=n).map(move |j| [f64::from(i), f64::from(j), 0.1 * f64::from(i * j)])).collect();
    let triangles: Vec<[u32; 3]> = (0..n)
        .flat_map(|i| {
            (0..n).flat_map(move |j| {
                [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
            })
        })
        .collect();
    let m = 2u32;
    let corner = |i: u32, j: u32, k: u32| (i * (m + 1) + j) * (m + 1) + k;
    let cube: Vec<[f64; 3]> = (0..=m)
        .flat_map(|i| (0..=m).flat_map(move |j| (0..=m).map(move |k| [f64::from(i), f64::from(j), f64::from(k)])))
        .collect();
    let mut tetrahedra = Vec::new();
    for (i, j, k) in (0..m).flat_map(|i| (0..m).flat_map(move |j| (0..m).map(move |k| (i, j, k)))) {
        for [a, b, c] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let step = |taken: &[usize]| {
                let on = |axis: usize| u32::from(taken.contains(&axis));
                corner(i + on(0), j + on(1), k + on(2))
            };
            let path = [step(&[]), step(&[a]), step(&[a, b]), step(&[a, b, c])];
            let even = [[0, 1, 2], [1, 2, 0], [2, 0, 1]].contains(&[a, b, c]);
            tetrahedra.push(if even { path } else { [path[1], path[0], path[2], path[3]] });
        }
    }
    vec![
        ("square", entries::<3>(&grid, &triangles, Target::Square)),
        ("disk", entries::<3>(&grid, &triangles, Target::Disk)),
        ("cube", entries::<4>(&cube, &tetrahedra, Target::Cube)),
        ("ball", entries::<4>(&cube, &tetrahedra, Target::Ball)),
    ]
}

fn entries<const K: usize>(positions: &[[f64; 3]], cells: &[[u32; K]], target: Target) -> Entries
where
    FoliationMap: From<Foliation<K>>,
{
    let complex = SimplicialComplex::<K>::from_indices(positions.len(), cells).expect("indices fit");
    let source = SourceMesh::new(positions.to_vec(), complex);
    let (map, _) = build(&source, target, &FoliationParams::default(), &Silent).expect("a map");
    let mut file = Cursor::new(Vec::new());
    write_map(&FoliationMap::from(map), &Provenance::default(), &mut file).expect("writable");
    unpack(&file.into_inner())
}

/// Numbers from a linear congruence: the campaign repeats.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound
    }
}
