//! Random changes of shells, and what the checker and the oracle say of them.
#![allow(clippy::print_stdout)] // counts, for people

use super::Map;
use super::random::Random;
use super::shells::is_valid;
use homeo_verify::{Verdict, verify_bytes};
use std::collections::BTreeMap;

/// Whether the oracle can judge a map many times.
pub fn is_small(map: &Map) -> bool {
    map.prisms.len() <= 20 && map.source_cells.len() <= 32
}

pub fn change_float(random: &mut Random, x: f64) -> f64 {
    match random.below(8) {
        0 => *random.pick(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300, 5e-324, 0.0, -0.0]),
        1 => -x,
        2 => f64::from_bits(x.to_bits() ^ 1 << random.below(64)),
        3 => f64::from_bits(x.to_bits().wrapping_add(1)),
        4 | 5 => x + 0.25 * (random.unit() - 0.5),
        6 => x + random.unit() - 0.5,
        _ => x * 2f64.powi(random.below(5) as i32 - 2),
    }
}

pub fn change_points(random: &mut Random, points: &mut [Vec<f64>]) {
    let (i, j, axis) = (random.below(points.len()), random.below(points.len()), random.below(3));
    match random.below(8) {
        0 => points.swap(i, j),
        1 => points[i] = points[j].clone(),
        2 => points[i].iter_mut().for_each(|x| *x *= 1.0 + 0.5 * (random.unit() - 0.5)),
        3 => points[i].rotate_left(1),
        _ => points[i][axis] = change_float(random, points[i][axis]),
    }
}

pub fn change_cells(random: &mut Random, cells: &mut Vec<Vec<u32>>, vertex_count: usize) {
    let (c, d, i) = (random.below(cells.len()), random.below(cells.len()), random.below(3));
    match random.below(8) {
        0 => drop(cells.remove(c)),
        1 => cells.push(cells[c].clone()),
        2 => cells[c].swap(i, (i + 1) % 3),
        3 => cells[c].rotate_left(1), // harmless
        4 => cells.swap(c, d),        // harmless
        5 => cells[c][i] ^= 1 << random.below(32),
        _ => cells[c][i] = random.below(vertex_count + 1) as u32,
    }
}

pub fn mutate(random: &mut Random, map: &mut Map) -> &'static str {
    let (vertex_count, column_count, level) = (map.positions.len(), map.levels[0].len(), random.below(3));
    let (v, w) = (random.below(column_count), random.below(column_count));
    match random.below(12) {
        0..=2 => {
            change_points(random, &mut map.positions);
            "source positions"
        }
        3..=5 => {
            change_points(random, &mut map.levels[level]);
            "points of columns"
        }
        6 => {
            change_cells(random, &mut map.source_cells, vertex_count);
            "source triangles"
        }
        7 => {
            change_cells(random, &mut map.prisms, column_count);
            "prisms"
        }
        8 => {
            map.levels.iter_mut().for_each(|level| level.swap(v, w));
            "whole columns swapped"
        }
        9 => {
            let rename = |u: &mut u32| {
                *u = if *u == v as u32 {
                    w as u32
                } else if *u == w as u32 {
                    v as u32
                } else {
                    *u
                }
            };
            map.levels.iter_mut().for_each(|level| level.swap(v, w));
            map.prisms.iter_mut().flatten().for_each(rename); // harmless, but another decomposition
            "columns renumbered"
        }
        10 => {
            let point = map.levels[level][v].clone();
            map.levels.iter_mut().for_each(|level| level[v] = point.clone());
            "columns pinched"
        }
        _ => {
            let other = random.below(3);
            map.levels[level][v] = map.levels[other][v].clone();
            "columns half pinched"
        }
    }
}

/// How many mutants were certified, refuted, undecided, unreadable, by their kind; and refuted, by rule and message.
#[derive(Default)]
pub struct Tally {
    pub kinds: BTreeMap<&'static str, [usize; 4]>,
    pub rules: BTreeMap<String, usize>,
}

/// Compares verdicts on mutants with those of the oracle.
pub fn judge(
    shells: Vec<(&str, Map)>,
    count: usize,
    seed: u64,
    mutate: impl Fn(&mut Random, &mut Map) -> &'static str,
) -> Tally {
    let (mut random, mut tally) = (Random(seed), Tally::default());
    let mut made = 0;
    while made < count {
        let (name, valid) = random.pick(&shells);
        let mut map = valid.clone();
        let kind = mutate(&mut random, &mut map);
        map.sign();
        let is_slow_to_judge = map.source_cells.len() > 12 && random.below(4) > 0;
        if is_slow_to_judge || map.bytes() == valid.bytes() {
            continue;
        }
        made += 1;
        let verdict = verify_bytes(&map.bytes());
        let place = match &verdict {
            Ok(Verdict::Certified(_)) => 0,
            Ok(Verdict::Refuted(_)) => 1,
            Ok(Verdict::Undecided(_)) => 2,
            Err(_) => 3,
        };
        tally.kinds.entry(kind).or_default()[place] += 1;
        if let Ok(Verdict::Refuted(witness)) = &verdict {
            *tally.rules.entry(format!("{} {}", witness.rule, witness.message)).or_default() += 1;
        }
        assert_eq!(place == 0, is_valid(&map), "{name}, {kind}: {verdict:?}\n{map:?}");
    }
    println!("{:<24} {:>9} {:>9} {:>9} {:>10}", "mutation of", "harmless", "refuted", "undecided", "unreadable");
    for (kind, [a, b, c, d]) in &tally.kinds {
        println!("{kind:<24} {a:>9} {b:>9} {c:>9} {d:>10}");
    }
    tally.rules.iter().for_each(|(rule, n)| println!("{n:>6} {rule}"));
    tally
}
