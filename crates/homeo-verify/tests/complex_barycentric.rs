//! Complex maps with speeds: valid ones are certified, folds are refuted with a witness, and each mutation is rejected,
//! undecided, or found harmless by an oracle that knows shares of edges by the printed definition only, in complex numbers,
//! and no charts, tilings, quotients or enclosures.
#![allow(clippy::print_stdout)]

mod support;

use homeo_verify::{SourceMatch, Unreadable, Verdict, compare_polygon, verify_bytes};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use support::plane::{self, Point};
use support::random::Random;
use support::write::{npy, sha256, zip};

/// Of the kite, and of the annulus, whose proofs take longer.
const MUTATIONS: [usize; 2] = [1800, 300];

/// The arrays of a map, free to be wrong.
#[derive(Clone)]
struct Arrays {
    /// What replaces fields of the manifest.
    manifest: Vec<(&'static str, Value)>,
    sizes: Vec<u32>,
    domains: [Vec<Point>; 2],
    speeds: Vec<Vec<f64>>,
    added: Vec<Point>,
    triangles: Vec<[u32; 3]>,
}

impl Arrays {
    fn bytes(&self) -> Vec<u8> {
        let points = |points: &[Point]| points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
        let numbers = |numbers: &[u32]| numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
        let [source, goal] = &self.domains;
        let mut hashed: Vec<u8> =
            [source.len() as u64, 2, self.sizes.len() as u64].iter().flat_map(|x| x.to_le_bytes()).collect();
        hashed.extend(points(source));
        hashed.extend(numbers(&self.sizes));
        let target = ["polygon", "annulus", "domain"][self.sizes.len().clamp(1, 3) - 1];
        let mut manifest = json!({
            "format": "homeo", "version": 1, "kind": "complex-barycentric", "dimension": 2, "target": target,
            "centre": null,
            "source": {"name": "made", "vertices": source.len(), "cells": self.sizes.len(), "content_sha256": sha256(&hashed)},
        });
        self.manifest.iter().for_each(|(key, value)| manifest[*key] = value.clone());
        let mut entries = vec![("manifest.json".to_owned(), manifest.to_string().into_bytes())];
        let mut add = |name: &str, kind: &str, shape: String, content: Vec<u8>| {
            entries.push((format!("{name}.npy"), npy(kind, &shape, &content)));
        };
        let columns = self.speeds.first().map_or(0, Vec::len);
        let values = self.speeds.concat().iter().flat_map(|x| x.to_le_bytes()).collect();
        add("source_points", "<f8", format!("({}, 2)", source.len()), points(source));
        add("source_rings", "<u4", format!("({},)", self.sizes.len()), numbers(&self.sizes));
        add("target_points", "<f8", format!("({}, 2)", goal.len()), points(goal));
        add("control_values", "<f8", format!("({}, {columns})", self.speeds.len()), values);
        add("added_points", "<f8", format!("({}, 2)", self.added.len()), points(&self.added));
        add("triangles", "<u4", format!("({}, 3)", self.triangles.len()), numbers(self.triangles.as_flattened()));
        zip(&entries)
    }

    fn verdict(&self) -> Result<Verdict, Unreadable> {
        verify_bytes(&self.bytes())
    }
}

/// A square onto a kite, with an added point: speeds towards the corner that is pulled in are slow at its end.
fn kite() -> Arrays {
    let with = |x: f64| vec![[0.0, 0.0], [1.0, 0.0], [x, x], [0.0, 1.0]];
    let slow = vec![0.0, 0.33, 0.66, 0.9, 1.0];
    let mirrored: Vec<f64> = slow.iter().rev().map(|c| 1.0 - c).collect();
    let even = vec![0.0, 0.25, 0.5, 0.75, 1.0];
    Arrays {
        manifest: vec![],
        sizes: vec![4],
        domains: [with(1.0), with(0.75)],
        speeds: vec![even.clone(), slow, mirrored, even],
        added: vec![[0.6, 0.5]],
        triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    }
}

/// A square in a square, which turns, with speeds of degree 3 that differ from edge to edge.
fn annulus() -> Arrays {
    let hole = |turn: f64| (0..4).map(move |k| TAU * (0.125 - 0.25 * k as f64) + turn);
    let with = |turn: f64| {
        let outer = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        outer.into_iter().chain(hole(turn).map(|angle| [0.4 * angle.cos(), 0.4 * angle.sin()])).collect::<Vec<_>>()
    };
    // Hole vertices run the other way: 4 faces corner 0, 7 corner 1, 6 corner 2, 5 corner 3.
    let ring = [[0, 4], [1, 7], [2, 6], [3, 5]];
    let triangles = (0..4).flat_map(|k| {
        let ([a, p], [b, q]) = (ring[k], ring[(k + 1) % 4]);
        [[a, b, p], [b, q, p]]
    });
    let speeds = (0..8).map(|k| vec![0.0, 0.31 + 0.005 * f64::from(k), 0.67 - 0.005 * f64::from(k), 1.0]);
    Arrays {
        manifest: vec![],
        sizes: vec![4, 4],
        domains: [with(0.0), with(0.1)],
        speeds: speeds.collect(),
        added: vec![],
        triangles: triangles.collect(),
    }
}

/// Two triangular holes, which turn a little; linear speeds, as a polynomial of degree 1.
fn two_holes() -> Arrays {
    let hole = |x: f64, turn: f64| {
        (0..3).map(move |k| {
            let angle = turn - TAU * f64::from(k) / 3.0;
            [x + 0.2 * angle.cos(), 0.2 * angle.sin()]
        })
    };
    let with = |turn: f64| {
        let outer = [[-1.0, -0.5], [1.0, -0.5], [1.0, 0.5], [-1.0, 0.5]];
        outer.into_iter().chain(hole(-0.5, turn)).chain(hole(0.5, -turn)).collect::<Vec<_>>()
    };
    // The holes run clockwise, from the vertex on the right.
    let triangles = vec![
        [0, 1, 5],
        [1, 8, 5],
        [5, 8, 4],
        [1, 7, 8],
        [1, 2, 7],
        [2, 9, 7],
        [8, 9, 4],
        [4, 9, 6],
        [9, 2, 6],
        [2, 3, 6],
        [3, 0, 5],
        [3, 5, 6],
    ];
    Arrays {
        manifest: vec![],
        sizes: vec![4, 3, 3],
        domains: [with(0.0), with(0.1)],
        speeds: vec![vec![0.0, 1.0]; 10],
        added: vec![],
        triangles,
    }
}

#[test]
fn valid_maps_are_certified() {
    for (name, arrays) in [("kite", kite()), ("annulus", annulus()), ("two holes", two_holes())] {
        match arrays.verdict() {
            Ok(Verdict::Certified(claim)) => {
                println!("{name}: {:?}", claim.checked);
                assert_eq!(claim.kind, "complex-barycentric");
                assert!(claim.statement.contains("at its stored speed"), "{}", claim.statement);
                assert!(claim.checked.iter().all(|(_, count)| *count > 0), "{:?}", claim.checked);
            }
            other => panic!("{name}: {other:?}"),
        }
        let mut rest = &arrays.domains[0][..];
        let ring = |&n: &u32| rest.split_off(..n as usize).map(<[Point]>::to_vec);
        let rings: Vec<Vec<Point>> = arrays.sizes.iter().filter_map(ring).collect();
        assert_eq!(compare_polygon(&arrays.bytes(), &rings), Ok(SourceMatch::Same));
        flaw(&arrays).map_or(Ok(()), Err).unwrap_or_else(|what| panic!("{name}: {what}"));
    }
}

/// Onto a kite with a deeper corner linear speeds fold, of whatever degree.
#[test]
fn linear_speeds_fold() {
    for degree in [1u32, 2, 4, 8] {
        let mut arrays = kite();
        arrays.domains[1][2] = [0.4, 0.4];
        arrays.speeds = vec![(0..=degree).map(|k| f64::from(k) / f64::from(degree)).collect(); 4];
        let witness = match arrays.verdict() {
            Ok(Verdict::Refuted(witness)) => witness,
            other => panic!("degree {degree}: {other:?} is no fold"),
        };
        assert_eq!(witness.rule, "K3");
        assert!(witness.message.contains("the complex map folds round the point"), "{}", witness.message);
        assert!(flaw(&arrays).is_some_and(|what| what.contains("folds")));
    }
}

/// Degrees that the format does not have.
#[test]
fn degrees_are_from_one_to_eight() {
    for columns in [1, 2, 9, 10] {
        let mut arrays = kite();
        arrays.domains[1] = arrays.domains[0].clone();
        arrays.speeds = vec![(0..columns).map(|k| f64::from(k) / f64::from((columns - 1).max(1))).collect(); 4];
        let is_certified = matches!(arrays.verdict(), Ok(Verdict::Certified(_)));
        assert_eq!(is_certified, (2..=9).contains(&columns), "{columns} columns: {:?}", arrays.verdict());
    }
}

#[test]
fn every_mutation_is_rejected_or_harmless() {
    let (mut counts, mut seen) = (BTreeMap::<String, usize>::new(), 0);
    for ((name, valid), count) in [("kite", kite()), ("annulus", annulus())].into_iter().zip(MUTATIONS) {
        let mut random = Random(5);
        for _ in 0..count {
            let mut mutant = valid.clone();
            let what = mutate(&mut mutant, &mut random);
            let outcome = match mutant.verdict() {
                Err(_) => "unreadable".to_owned(),
                Ok(Verdict::Refuted(witness)) => {
                    seen += usize::from(witness.rule == "K3" && flaw(&mutant).is_some());
                    format!("refuted by {}", witness.rule)
                }
                Ok(Verdict::Undecided(_)) => "undecided".to_owned(),
                Ok(Verdict::Certified(_)) => match flaw(&mutant) {
                    None => "harmless".to_owned(),
                    Some(flaw) => panic!("{name}: {what} was certified although {flaw}"),
                },
            };
            *counts.entry(outcome).or_default() += 1;
        }
    }
    counts.iter().for_each(|(outcome, count)| println!("{count:>6} {outcome}"));
    for rule in ["refuted by K1", "refuted by K2", "refuted by K3", "refuted by D", "unreadable"] {
        let found = counts.get(rule).copied().unwrap_or(0);
        assert!(found >= 20, "only {found} mutations are {rule}: the test tests little");
    }
    let all: usize = counts.values().sum();
    assert_eq!(all, 2100);
    let harmless = counts.get("harmless").copied().unwrap_or(0);
    assert!((100..3 * all / 4).contains(&harmless), "{harmless} are harmless");
    let by_folds = counts["refuted by K3"];
    assert!(2 * seen > by_folds, "the oracle sees only {seen} of {by_folds} folds");
}

/// Changes something, and says what.
fn mutate(arrays: &mut Arrays, random: &mut Random) -> String {
    let kind = random.below(30).saturating_sub(8);
    let domain = random.below(2);
    let vertex = random.below(arrays.domains[0].len());
    match kind {
        0..=3 => {
            let size = if kind > 0 { 10f64.powi(-(random.below(14) as i32)) } else { 0.6 };
            let point = &mut arrays.domains[domain][vertex];
            *point = [0, 1].map(|k| point[k] + size * (2.0 * random.unit() - 1.0));
        }
        4 => {
            let bad = [f64::NAN, f64::INFINITY, -f64::INFINITY][random.below(3)];
            arrays.domains[domain][vertex][random.below(2)] = bad;
        }
        5 => {
            let other = random.below(arrays.domains[0].len());
            arrays.domains[domain].swap(vertex, other);
        }
        6 => arrays.domains.swap(0, 1),
        7..=12 => mutate_speeds(&mut arrays.speeds, kind, random),
        13..=16 => mutate_tiling(arrays, kind, random),
        17 => {
            let ring = random.below(arrays.sizes.len());
            arrays.sizes[ring] = (arrays.sizes[ring] + 5 - random.below(3) as u32).saturating_sub(4);
        }
        18 => drop(arrays.domains[domain].remove(vertex)),
        19 => drop(arrays.speeds.remove(vertex)),
        20 => arrays.speeds.iter_mut().for_each(|row| {
            row.pop();
        }),
        _ => {
            let changes = [
                ("kind", json!("composite-mean-value")),
                ("kind", json!("complex")),
                ("target", json!("domain")),
                ("target", json!("square")),
                ("dimension", json!(3)),
                ("version", json!(2)),
                ("centre", json!({"cell": 0, "length": 1})),
                ("source", json!({"vertices": 4, "cells": 1, "content_sha256": "0"})),
                ("degree", json!(4)),
            ];
            arrays.manifest.push(random.pick(&changes).clone());
        }
    }
    format!("kind {kind} at domain {domain}, vertex {vertex}")
}

fn mutate_speeds(speeds: &mut [Vec<f64>], kind: usize, random: &mut Random) {
    let row = random.below(speeds.len());
    let values = &mut speeds[row];
    let (k, other) = (random.below(values.len()), random.below(values.len()));
    match kind {
        7 => values[k] += 10f64.powi(-(random.below(17) as i32)) * (2.0 * random.unit() - 1.0),
        8 => {
            let inner = values.len() - 2;
            let mut new: Vec<f64> = (0..inner).map(|_| random.unit()).collect();
            new.sort_by(f64::total_cmp);
            values[1..=inner].copy_from_slice(&new);
        }
        9 => values.swap(k, other),
        10 => values[k] = values[other],
        11 => values[k] = [f64::NAN, f64::INFINITY, -1.0, 2.0, f64::MIN_POSITIVE, 1.0 - f64::EPSILON][random.below(6)],
        _ => {
            let taken = speeds[random.below(speeds.len())].clone();
            speeds[row] = taken;
        }
    }
}

fn mutate_tiling(arrays: &mut Arrays, kind: usize, random: &mut Random) {
    let (t, corner) = (random.below(arrays.triangles.len()), random.below(3));
    match kind {
        13 => {
            let count = arrays.domains[0].len() + arrays.added.len();
            arrays.triangles[t][corner] = random.below(count + 1) as u32;
        }
        14 => arrays.triangles[t].swap(corner, (corner + 1) % 3),
        15 => {
            let removed = arrays.triangles.remove(t);
            if random.below(2) == 0 {
                arrays.triangles.extend([removed; 2]);
            }
        }
        _ => match arrays.added.first_mut() {
            Some(point) => point[random.below(2)] += random.unit() - 0.4,
            None => arrays.added.push([0.5, 0.5]),
        },
    }
}

/// What is wrong with a map, as far as samples show.
fn flaw(arrays: &Arrays) -> Option<String> {
    if let Some((key, _)) = arrays.manifest.first() {
        return Some(format!("the manifest has another {key}"));
    }
    let [points, images] = &arrays.domains;
    if arrays.speeds.len() != points.len() || images.len() != points.len() {
        return Some("counts differ".to_owned());
    }
    for (edge, values) in arrays.speeds.iter().enumerate() {
        if let Some(k) =
            (1..100).find(|&k| speed(values, f64::from(k) / 100.0) <= speed(values, f64::from(k - 1) / 100.0))
        {
            return Some(format!("the speed of edge {edge} stands still or goes back at {k} of 100"));
        }
        if (speed(values, 0.0), speed(values, 1.0)) != (0.0, 1.0) {
            return Some(format!("the speed of edge {edge} does not go from 0 to 1"));
        }
    }
    let edges = plane::edges(&arrays.sizes);
    let mut random = Random(1);
    for k in 0..2500 {
        let at = plane::sample(&mut random, k, &edges, points);
        let windings = plane::windings(&edges, points, at);
        let goal = plane::sample(&mut random, k, &edges, images);
        for (windings, at) in [(windings, at), (plane::windings(&edges, images, goal), goal)] {
            if !(0..=1).contains(&windings) {
                return Some(format!("a domain winds {windings} times round {at:?}"));
            }
        }
        let all: Vec<Point> = points.iter().chain(&arrays.added).copied().collect();
        if plane::is_covered_otherwise(&arrays.triangles, &all, at, windings) {
            return Some(format!("not {windings} triangles are over {at:?}"));
        }
        let map = |at: Point| image(&edges, arrays, at);
        if windings == 1 && plane::determinant(&edges, points, map, at) < -1e-3 {
            return Some(format!("it folds at {at:?}"));
        }
    }
    None
}

/// A sum of control values times Bernstein polynomials.
fn speed(values: &[f64], x: f64) -> f64 {
    let degree = values.len() - 1;
    let mut binomial = 1.0;
    let mut sum = 0.0;
    for (k, value) in values.iter().enumerate() {
        sum += binomial * value * x.powi(k as i32) * (1.0 - x).powi((degree - k) as i32);
        binomial *= (degree - k) as f64 / (k + 1) as f64;
    }
    sum
}

fn product([a, b]: Point, [c, d]: Point) -> Point {
    [a * c - b * d, a * d + b * c]
}

fn quotient(p: Point, [c, d]: Point) -> Point {
    product(p, [c, -d]).map(|x| x / (c * c + d * d))
}

fn minus(p: Point, q: Point) -> Point {
    [p[0] - q[0], p[1] - q[1]]
}

/// The map by its definition: similarities with speeds, weighed by `e / Im(conj(ρ) ρ') (r' / ρ' - r / ρ)`.
fn image(edges: &[[usize; 2]], arrays: &Arrays, at: Point) -> Point {
    let [points, images] = &arrays.domains;
    let (mut total, mut sum) = ([0.0; 2], [0.0; 2]);
    for &[p, q] in edges {
        let [rho, next] = [p, q].map(|v| minus(points[v], at));
        let (edge, goal) = (minus(points[q], points[p]), minus(images[q], images[p]));
        let unit = |v: Point| quotient([v[0].hypot(v[1]), 0.0], v);
        let doubled_area = rho[0] * next[1] - rho[1] * next[0];
        let weight = product(edge, minus(unit(next), unit(rho))).map(|x| x / doubled_area);
        let place = quotient(minus(at, points[p]), edge);
        let moved = product(goal, [speed(&arrays.speeds[p], place[0]), place[1]]);
        let similar = [images[p][0] + moved[0], images[p][1] + moved[1]];
        let term = product(weight, similar);
        total = [total[0] + weight[0], total[1] + weight[1]];
        sum = [sum[0] + term[0], sum[1] + term[1]];
    }
    quotient(sum, total)
}
