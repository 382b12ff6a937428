//! Meshes that have moved: valid ones, a negative control for each rule, and random mutations judged by an oracle that
//! clips all pairs of cells.
#![allow(clippy::print_stdout)] // counts, for people

mod support;

use homeo_verify::{SourceMatch, Verdict, compare_source, verify_bytes};
use serde_json::json;
use std::collections::BTreeMap;
use support::moved::{fork, is_injective, is_valid, moved, moved_meshes, twisted};
use support::mutants::change_float;
use support::random::Random;
use support::{Map, assert_refuted, write};

#[test]
fn meshes_that_keep_apart_are_certified() {
    for (name, map) in moved_meshes() {
        assert!(is_valid(&map), "{name}");
        match verify_bytes(&map.bytes()) {
            Ok(Verdict::Certified(claim)) => {
                assert_eq!((&claim.kind[..], &claim.target[..]), ("moved-mesh", "space"));
                assert!(claim.checked.iter().any(|(what, n)| what.starts_with("source t") && *n > 0), "{name}");
            }
            other => panic!("{name}: {other:?}"),
        }
    }
}

#[test]
fn sources_are_compared_bit_for_bit() {
    let (_, map) = moved_meshes().swap_remove(4);
    let mut positions: Vec<[f64; 3]> = map.positions.iter().map(|p| [p[0], p[1], p[2]]).collect();
    let cells = map.source_cells.concat();
    assert_eq!(compare_source(&map.bytes(), &positions, &cells, 4), Ok(SourceMatch::Same));
    assert!(matches!(compare_source(&map.bytes(), &positions, &cells, 3), Ok(SourceMatch::Different(_))));
    positions[3][0] = positions[3][0].next_up();
    assert!(matches!(compare_source(&map.bytes(), &positions, &cells, 4), Ok(SourceMatch::Different(_))));
}

fn named(name: &str) -> Map {
    moved_meshes().into_iter().find(|(found, _)| *found == name).expect("a map of this name").1
}

#[test]
fn what_is_no_manifold_is_refuted() {
    let mut apart = named("one tetrahedron");
    apart.positions.extend(apart.positions.clone().iter().map(|p| p.iter().map(|x| x + 9.0).collect()));
    apart.target_positions = apart.positions.clone();
    apart.source_cells.push(vec![4, 5, 6, 7]);
    assert_refuted(&apart, "M1", "2 pieces");
    let mut pinched = apart.clone();
    pinched.source_cells[1] = vec![0, 5, 6, 7];
    assert_refuted(&pinched, "M1", "not connected");
    let mut empty = apart.clone();
    empty.source_cells.clear();
    assert_refuted(&empty, "M1", "0 pieces");
    let mut closed = named("one tetrahedron");
    closed.positions.push(vec![0.25; 3]);
    closed.target_positions = closed.positions.clone();
    closed.source_cells = (0..5).map(|i| (0..5).filter(|&v| v != i).collect()).collect();
    assert_refuted(&closed, "M2", "same side");
    let mut crowded = named("a triangle");
    crowded.positions.extend([vec![0.0, 0.0, 1.0], vec![0.0, 0.0, -1.0]]);
    crowded.target_positions = crowded.positions.clone();
    crowded.source_cells.extend([vec![0, 1, 3], vec![0, 1, 4]]);
    assert_refuted(&crowded, "M1", "more than two cells");
    crowded.source_cells.truncate(2);
    crowded.source_cells[1] = vec![1, 0, 2];
    assert_refuted(&crowded, "S2", "same vertices");
    crowded.source_cells[1] = vec![0, 1, 9];
    assert_refuted(&crowded, "S2", "does not exist");
    crowded.positions[1][1] = f64::NAN;
    assert_refuted(&crowded, "S1", "not finite");
}

#[test]
fn cells_that_are_flat_or_turn_over_are_refuted() {
    let fold = |map: &Map, after: bool| {
        let mut map = map.clone();
        // A corner goes across the planes of its neighbours.
        let points = if after { &mut map.target_positions } else { &mut map.positions };
        points[1] = vec![-1.0, 2.0, 0.0];
        map
    };
    let still = moved(&(points(&named("a cube")), named("a cube").source_cells), |p| p);
    assert_refuted(&fold(&still, false), "M2", "same side");
    let witness = assert_refuted(&fold(&still, true), "M3", "turned over");
    assert!(witness.points.contains(&[-1.0, 2.0, 0.0]), "drawn where it is after");
    let flat = |map: &Map| {
        let [mut before, mut after] = [map.clone(), map.clone()];
        before.positions.iter_mut().for_each(|p| p[2] = p[0] + p[1]);
        after.target_positions.iter_mut().for_each(|p| p[2] = p[0] + p[1]);
        assert_refuted(&before, "M2", "flat before");
        assert_refuted(&after, "M3", "flat after");
    };
    flat(&still);
    let mut line = named("a triangle");
    line.target_positions = vec![vec![0.0; 3], vec![1.0, 2.0, 3.0], vec![2.0, 4.0, 6.0]];
    assert_refuted(&line, "M3", "flat after");
    line.target_positions[1][0] = f64::INFINITY;
    assert_refuted(&line, "M3", "not finite");
    let mut mirrored = named("a cube");
    mirrored.target_positions.iter_mut().for_each(|p| p[0] = -p[0]);
    assert_refuted(&mirrored, "M3", "turned over");
}

fn points(map: &Map) -> Vec<[f64; 3]> {
    map.positions.iter().map(|p| [p[0], p[1], p[2]]).collect()
}

/// All cells are positive, and prongs run through one another.
#[test]
fn prongs_that_are_bent_through_one_another_are_refuted() {
    let bent = |reach: f64| {
        move |[x, y, z]: [f64; 3]| {
            let side = if x < 1.5 { 1.0 } else { -1.0 };
            [x + side * reach * (y - 1.0).max(0.0), y, z]
        }
    };
    for (reach, rule) in [(0.4375, None), (0.5, Some("M5")), (0.75, Some("M5"))] {
        let map = moved(&fork(), bent(reach));
        let cells = (&map.source_cells, &map.target_positions);
        assert_eq!(is_injective(cells.1, cells.0), rule.is_none(), "{reach}");
        let mut turned = map.clone();
        std::mem::swap(&mut turned.positions, &mut turned.target_positions);
        match rule {
            None => assert!(matches!(verify_bytes(&map.bytes()), Ok(Verdict::Certified(_)))),
            Some(rule) => {
                assert_eq!(assert_refuted(&map, rule, "meet after").vertices.len(), 6);
                assert_refuted(&turned, "M4", "meet before");
            }
        }
    }
}

/// Surfaces of several pieces: one moves until it touches the other.
#[test]
fn surfaces_that_touch_are_refuted() {
    let map = named("two sheets that almost touch");
    let mut touching = map.clone();
    touching.target_positions.iter_mut().for_each(|p| p[2] = 0.0);
    assert_refuted(&touching, "M5", "meet after");
    let mut corner = map.clone();
    corner.target_positions[4] = corner.target_positions[0].clone();
    assert_refuted(&corner, "M5", "meet after");
    let mut folded = named("a bumpy sheet");
    folded.target_positions[0] = vec![2.5, 2.25, 1.0];
    assert!(!is_valid(&folded));
    assert_refuted(&folded, "M5", "meet after");
}

#[test]
fn other_arrays_and_claims_are_unreadable() {
    let map = named("a cube");
    let unreadable = |bytes: &[u8], words: &str| {
        let error = verify_bytes(bytes).expect_err("unreadable");
        assert!(error.message.contains(words), "{error}");
    };
    for (key, value, words) in [
        ("target", json!("cube"), "belong together"),
        ("kind", json!("piecewise-linear"), "belong together"),
        ("dimension", json!(4), "dimension"),
        ("dimension", json!(1), "dimension"),
        ("centre", json!({"cell": 0, "length": 1}), "centre"),
    ] {
        let mut map = map.clone();
        map.manifest[key] = value;
        unreadable(&map.bytes(), words);
    }
    let mut planar = map.clone();
    planar.manifest["dimension"] = json!(2);
    assert!(verify_bytes(&planar.bytes()).is_err());
    let entries = write::entries(&map);
    for place in 0..entries.len() {
        let mut fewer = entries.clone();
        fewer.remove(place);
        assert!(verify_bytes(&write::zip(&fewer)).is_err(), "{}", entries[place].0);
        let mut more = entries.clone();
        more.push((format!("more_{}", entries[place].0), entries[place].1.clone()));
        unreadable(&write::zip(&more), "does not belong");
    }
    let mut refined = entries.clone();
    refined.push(("cells.npy".to_owned(), entries[2].1.clone()));
    unreadable(&write::zip(&refined), "does not belong");
    let mut short = map.clone();
    short.target_positions.pop();
    unreadable(&short.bytes(), "target_positions");
}

// Mutations.

/// How often each kind of mutant was certified, refuted or unreadable.
#[derive(Default)]
struct Tally(BTreeMap<&'static str, [usize; 3]>);

fn change_place(random: &mut Random, points: &mut [Vec<f64>]) -> &'static str {
    let (v, w, axis) = (random.below(points.len()), random.below(points.len()), random.below(3));
    match random.below(10) {
        0 => {
            points.swap(v, w);
            "two places swapped"
        }
        1 => {
            points[v] = points[w].clone();
            "one place made another"
        }
        2 => {
            let part = random.unit();
            points[v] = (0..3).map(|k| points[v][k] + part * (points[w][k] - points[v][k])).collect();
            "one place moved to another"
        }
        3..=5 => {
            let x = points[v][axis];
            points[v][axis] = if random.below(2) == 0 { x.next_up() } else { x.next_down() };
            "one step of the last place"
        }
        6 => {
            points[v].rotate_left(1);
            "axes of one place turned"
        }
        _ => {
            points[v][axis] = change_float(random, points[v][axis]);
            "one coordinate"
        }
    }
}

fn change_cells(random: &mut Random, map: &mut Map) -> &'static str {
    let (count, size) = (map.positions.len(), map.size());
    let cells = &mut map.source_cells;
    let (c, d, i, j) = (random.below(cells.len()), random.below(cells.len()), random.below(size), random.below(size));
    match random.below(8) {
        0 => drop(cells.remove(c)),
        1 => cells.push(cells[c].clone()),
        2 => cells[c].swap(i, j),
        3 => cells[c].rotate_left(1),
        4 => cells.swap(c, d),
        5 => cells[c][i] ^= 1 << random.below(32),
        6 => cells[c][i] = cells[d][j],
        _ => cells[c][i] = random.below(count + 1) as u32,
    }
    "cells"
}

fn mutate(random: &mut Random, map: &mut Map) -> &'static str {
    match random.below(16) {
        0..=4 => change_place(random, &mut map.positions),
        5..=9 => change_place(random, &mut map.target_positions),
        10..=12 => change_cells(random, map),
        13 => {
            let (v, w) = (random.below(map.positions.len()), random.below(map.positions.len()));
            map.positions.swap(v, w);
            map.target_positions.swap(v, w);
            "vertices swapped before and after"
        }
        14 => {
            let v = random.below(map.positions.len());
            let points = if random.below(2) == 0 { &mut map.positions } else { &mut map.target_positions };
            drop(points.remove(v));
            "a vertex dropped on one side"
        }
        _ => {
            std::mem::swap(&mut map.positions, &mut map.target_positions);
            let axis = random.below(3);
            map.positions.iter_mut().for_each(|p| p[axis] = -p[axis]);
            "before and after exchanged, one mirrored"
        }
    }
}

const MUTANTS: usize = 200;

#[test]
fn mutants_are_certified_exactly_when_the_oracle_finds_them_valid() {
    let (mut random, mut tally) = (Random(416), Tally::default());
    for (name, valid) in moved_meshes() {
        for _ in 0..MUTANTS {
            let mut map = valid.clone();
            let kind = mutate(&mut random, &mut map);
            map.sign();
            let verdict = verify_bytes(&map.bytes());
            let place = match &verdict {
                Ok(Verdict::Certified(_)) => 0,
                Ok(_) => 1,
                Err(_) => 2,
            };
            assert_eq!(place == 0, is_valid(&map), "{name}, {kind}: {verdict:?}\n{map:?}");
            tally.0.entry(kind).or_default()[place] += 1;
        }
    }
    println!("{:<42} {:>9} {:>9} {:>10}", "mutation of", "harmless", "refuted", "unreadable");
    tally.0.iter().for_each(|(kind, [a, b, c])| println!("{kind:<42} {a:>9} {b:>9} {c:>10}"));
    let total: usize = tally.0.values().flatten().sum();
    let [certified, refuted] = [0, 1].map(|place| tally.0.values().map(|counts| counts[place]).sum::<usize>());
    assert!(total == 15 * MUTANTS && certified >= 750 && refuted >= 750, "{total} {certified} {refuted}");
}

/// Meshes that all but touch or are all but flat: each coordinate by one step up and down.
#[test]
fn one_step_of_the_last_place_decides() {
    let names = [
        "a flat one, its neighbour of the other sign",
        "a fork whose prongs almost touch",
        "two sheets that almost touch",
    ];
    for (name, least) in names.into_iter().zip([2, 4, 8]) {
        let (valid, mut refuted) = (named(name), 0);
        for place in 0..12 * valid.positions.len() {
            let mut map = valid.clone();
            let points = if place % 2 == 0 { &mut map.positions } else { &mut map.target_positions };
            let x = &mut points[place / 12][place / 4 % 3];
            *x = if place / 2 % 2 == 0 { x.next_up() } else { x.next_down() };
            let verdict = verify_bytes(&map.signed_bytes());
            map.sign();
            assert_eq!(matches!(verdict, Ok(Verdict::Certified(_))), is_valid(&map), "{name}, {place}: {verdict:?}");
            refuted += usize::from(matches!(verdict, Ok(Verdict::Refuted(_))));
        }
        println!("{name}: {refuted} of {}", 12 * valid.positions.len());
        assert!(refuted >= least, "{name}: {refuted}");
    }
}

/// Random motions of one mesh, by little and by much: both verdicts, as the oracle says.
#[test]
fn random_motions_are_told_apart() {
    let (mut random, mut counts) = (Random(99), [0; 2]);
    for (name, valid) in moved_meshes() {
        for step in 0..16 {
            let size = [0.05, 0.3, 1.0, 3.0][step % 4];
            let mut map = moved(&(points(&valid), valid.source_cells.clone()), twisted);
            map.target_positions.iter_mut().flatten().for_each(|x| *x += size * (random.unit() - 0.5));
            let verdict = verify_bytes(&map.bytes());
            let is_certified = matches!(verdict, Ok(Verdict::Certified(_)));
            assert_eq!(is_certified, is_valid(&map), "{name}: {verdict:?}");
            counts[usize::from(is_certified)] += 1;
        }
    }
    println!("{counts:?}");
    assert!(counts.iter().all(|&count| count >= 50), "{counts:?}");
}

const CONTAINER_MUTANTS: usize = 1500;

/// Bytes changed anywhere: the file is unreadable, or a naive reader finds the same arrays in it.
#[test]
fn damaged_files_are_unreadable_or_the_same() {
    let map = named("a ring");
    let (original, mut random, mut readable) = (map.bytes(), Random(5), 0);
    let arrays = |bytes: &[u8]| {
        let mut entries = write::naive_unzip(bytes)?;
        entries.retain(|(name, _)| name.ends_with(".npy") && !name.starts_with("note_"));
        Some(entries)
    };
    for _ in 0..CONTAINER_MUTANTS {
        let mut bytes = original.clone();
        let at = random.below(bytes.len());
        match random.below(4) {
            0 => bytes.truncate(at),
            1 => drop(bytes.remove(at)),
            2 => bytes.insert(at, random.next() as u8),
            _ => bytes[at] ^= 1 << random.below(8),
        }
        if let Ok(Verdict::Certified(_)) = verify_bytes(&bytes) {
            assert_eq!(arrays(&bytes), arrays(&original), "another map is certified");
            readable += 1;
        }
    }
    assert!(readable < CONTAINER_MUTANTS / 20, "checksums cover the file");
}
