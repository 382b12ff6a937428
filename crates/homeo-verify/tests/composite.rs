//! Composite mean value maps: valid ones are certified, folds are refuted with a witness, and each mutation is rejected or
//! found harmless by an oracle that knows coordinates by their definition only, and no charts, tilings or enclosures.
#![allow(clippy::print_stdout)]

mod support;

use homeo_verify::{SourceMatch, Unreadable, Verdict, compare_polygon, verify_bytes};
use serde_json::json;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use support::plane::{self, Point};
use support::random::Random;
use support::write::{npy, sha256, zip};

const MUTATIONS: usize = 800;

/// The arrays of a map, free to be wrong.
#[derive(Clone)]
struct Arrays {
    sizes: Vec<u32>,
    stages: Vec<Vec<Point>>,
    added: Vec<Vec<Point>>,
    triangles: Vec<Vec<[u32; 3]>>,
}

impl Arrays {
    fn bytes(&self) -> Vec<u8> {
        let points = |points: &[Point]| points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
        let numbers = |numbers: &[u32]| numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
        let source = &self.stages[0];
        let mut hashed: Vec<u8> =
            [source.len() as u64, 2, self.sizes.len() as u64].iter().flat_map(|x| x.to_le_bytes()).collect();
        hashed.extend(points(source));
        hashed.extend(numbers(&self.sizes));
        let target = ["polygon", "annulus", "domain"][(self.sizes.len() - 1).min(2)];
        let manifest = json!({
            "format": "homeo", "version": 1, "kind": "composite-mean-value", "dimension": 2, "target": target,
            "centre": null,
            "source": {"name": "made", "vertices": source.len(), "cells": self.sizes.len(), "content_sha256": sha256(&hashed)},
        });
        let mut entries = vec![("manifest.json".to_owned(), manifest.to_string().into_bytes())];
        let mut add = |name: &str, kind: &str, shape: String, content: Vec<u8>| {
            entries.push((format!("{name}.npy"), npy(kind, &shape, &content)));
        };
        let later = self.stages[1..].concat();
        let (added, triangles) = (self.added.concat(), self.triangles.concat());
        let counts = |lengths: Vec<usize>| lengths.iter().map(|&n| n as u32).collect::<Vec<u32>>();
        let added_counts = counts(self.added.iter().map(Vec::len).collect());
        let triangle_counts = counts(self.triangles.iter().map(Vec::len).collect());
        add("source_points", "<f8", format!("({}, 2)", source.len()), points(source));
        add("source_rings", "<u4", format!("({},)", self.sizes.len()), numbers(&self.sizes));
        add("stage_points", "<f8", format!("({}, 2)", later.len()), points(&later));
        add("added_counts", "<u4", format!("({},)", added_counts.len()), numbers(&added_counts));
        add("added_points", "<f8", format!("({}, 2)", added.len()), points(&added));
        add("triangle_counts", "<u4", format!("({},)", triangle_counts.len()), numbers(&triangle_counts));
        add("triangles", "<u4", format!("({}, 3)", triangles.len()), numbers(triangles.as_flattened()));
        zip(&entries)
    }

    fn verdict(&self) -> Result<Verdict, Unreadable> {
        verify_bytes(&self.bytes())
    }

    fn edges(&self) -> Vec<[usize; 2]> {
        plane::edges(&self.sizes)
    }
}

/// A square whose corner is pulled in; the second step is from a kite, tiled round an added point.
fn kite() -> Arrays {
    let with = |x: f64| vec![[0.0, 0.0], [1.0, 0.0], [x, x], [0.0, 1.0]];
    Arrays {
        sizes: vec![4],
        stages: vec![with(1.0), with(0.6), with(0.4)],
        added: vec![vec![], vec![[0.3, 0.3]]],
        triangles: vec![vec![[0, 1, 2], [0, 2, 3]], vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]],
    }
}

/// A square in a square, which turns.
fn annulus() -> Arrays {
    let hole = |turn: f64| (0..4).map(move |k| TAU * (0.125 - 0.25 * k as f64) + turn);
    let with = |turn: f64| {
        let outer = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        outer.into_iter().chain(hole(turn).map(|angle| [0.4 * angle.cos(), 0.4 * angle.sin()])).collect::<Vec<_>>()
    };
    // Hole vertices run the other way: 4 faces corner 0, 7 corner 1, 6 corner 2, 5 corner 3.
    let ring = [[0, 4], [1, 7], [2, 6], [3, 5]];
    let triangles: Vec<[u32; 3]> = (0..4)
        .flat_map(|k| {
            let ([a, p], [b, q]) = (ring[k], ring[(k + 1) % 4]);
            [[a, b, p], [b, q, p]]
        })
        .collect();
    Arrays {
        sizes: vec![4, 4],
        stages: vec![with(0.0), with(0.3), with(0.5)],
        added: vec![vec![]; 2],
        triangles: vec![triangles.clone(), triangles],
    }
}

#[test]
fn valid_maps_are_certified() {
    for (name, arrays) in [("kite", kite()), ("annulus", annulus())] {
        match arrays.verdict() {
            Ok(Verdict::Certified(claim)) => {
                assert_eq!(claim.kind, "composite-mean-value");
                assert!(claim.statement.contains("in 2 steps"), "{}", claim.statement);
                assert!(claim.checked.iter().all(|(_, count)| *count > 0), "{:?}", claim.checked);
            }
            other => panic!("{name}: {other:?}"),
        }
        let mut first = 0;
        let rings: Vec<Vec<Point>> = arrays
            .sizes
            .iter()
            .map(|&n| {
                first += n as usize;
                arrays.stages[0][first - n as usize..first].to_vec()
            })
            .collect();
        assert_eq!(compare_polygon(&arrays.bytes(), &rings), Ok(SourceMatch::Same));
        flaw(&arrays).map_or(Ok(()), Err).unwrap_or_else(|what| panic!("{name}: {what}"));
    }
}

/// A square onto a kite with a deep corner: mean value coordinates of the square have one of it go too far.
#[test]
fn one_large_step_folds() {
    let mut arrays = kite();
    arrays.stages = vec![arrays.stages[0].clone(), vec![[0.0, 0.0], [1.0, 0.0], [0.05, 0.05], [0.0, 1.0]]];
    arrays.added.pop();
    arrays.triangles.pop();
    let witness = match arrays.verdict() {
        Ok(Verdict::Refuted(witness)) => witness,
        other => panic!("{other:?} is no fold"),
    };
    assert_eq!(witness.rule, "C3");
    assert!(witness.message.contains("folds round the point"), "{}", witness.message);
    assert!(flaw(&arrays).is_some_and(|what| what.contains("folds")));
}

#[test]
fn every_mutation_is_rejected_or_harmless() {
    let (mut counts, mut seen) = (BTreeMap::<String, usize>::new(), 0);
    for (name, valid) in [("kite", kite()), ("annulus", annulus())] {
        let mut random = Random(5);
        for _ in 0..MUTATIONS {
            let mut mutant = valid.clone();
            let what = mutate(&mut mutant, &mut random);
            let outcome = match mutant.verdict() {
                Err(_) => "unreadable".to_owned(),
                Ok(Verdict::Refuted(witness)) => {
                    seen += usize::from(witness.rule == "C3" && flaw(&mutant).is_some());
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
    for rule in ["C1", "C2", "C3", "D"] {
        let found = counts.get(&format!("refuted by {rule}")).copied().unwrap_or(0);
        assert!(found >= 20, "only {found} mutations fail by {rule}: the test tests little");
    }
    let harmless = counts.get("harmless").copied().unwrap_or(0);
    assert!((100..3 * MUTATIONS / 2).contains(&harmless), "{harmless} are harmless");
    let by_folds = counts["refuted by C3"];
    assert!(2 * seen > by_folds, "the oracle sees only {seen} of {by_folds} folds");
}

/// Changes something, and says what.
fn mutate(arrays: &mut Arrays, random: &mut Random) -> String {
    let step = random.below(arrays.triangles.len());
    let stage = random.below(arrays.stages.len());
    let vertex = random.below(arrays.stages[0].len());
    let (t, u) = (random.below(arrays.triangles[step].len()), random.below(arrays.triangles[step].len()));
    let corner = random.below(3);
    let count = arrays.stages[0].len() + arrays.added[step].len();
    let kind = random.below(14);
    match kind {
        0..=4 => {
            let size = if kind < 2 { 10f64.powi(-(random.below(14) as i32)) } else { 0.6 };
            let point = &mut arrays.stages[stage][vertex];
            *point = [0, 1].map(|k| point[k] + size * (2.0 * random.unit() - 1.0));
        }
        5 => {
            let bad = [f64::NAN, f64::INFINITY, -f64::INFINITY][random.below(3)];
            arrays.stages[stage][vertex][random.below(2)] = bad;
        }
        6 => {
            let other = random.below(arrays.stages[0].len());
            arrays.stages[stage].swap(vertex, other);
        }
        7 => arrays.triangles[step][t][corner] = random.below(count + 1) as u32,
        8 => arrays.triangles[step][t].swap(corner, (corner + 1) % 3),
        9 => arrays.triangles[step].swap(t, u),
        10 => {
            let removed = arrays.triangles[step].remove(t);
            if random.below(2) == 0 {
                arrays.triangles[step].extend([removed; 2]);
            }
        }
        11 => {
            let point = match arrays.added[step].first_mut() {
                Some(point) => point,
                None => {
                    arrays.added[step].push([0.5, 0.5]);
                    return "an added point in no triangle".to_owned();
                }
            };
            point[random.below(2)] += random.unit() - 0.4;
        }
        12 => arrays.stages.swap(stage, 0),
        _ => {
            let ring = random.below(arrays.sizes.len());
            arrays.sizes[ring] = (arrays.sizes[ring] + 5 - random.below(3) as u32).saturating_sub(4);
        }
    }
    format!("kind {kind} at step {step}, stage {stage}, vertex {vertex}")
}

/// What is wrong with a map, as far as samples show.
fn flaw(arrays: &Arrays) -> Option<String> {
    let edges = arrays.edges();
    let mut random = Random(1);
    for (number, points) in arrays.stages.iter().enumerate() {
        let is_last = number + 1 == arrays.stages.len();
        for k in 0..2500 {
            let at = plane::sample(&mut random, k, &edges, points);
            let windings = plane::windings(&edges, points, at);
            if !(0..=1).contains(&windings) {
                return Some(format!("domain {number} winds {windings} times round {at:?}"));
            }
            if is_last {
                continue;
            }
            let all: Vec<Point> = points.iter().chain(&arrays.added[number]).copied().collect();
            if plane::is_covered_otherwise(&arrays.triangles[number], &all, at, windings) {
                return Some(format!("not {windings} triangles of step {number} are over {at:?}"));
            }
            let map = |at: Point| image(&edges, points, &arrays.stages[number + 1], at);
            if windings == 1 && plane::determinant(&edges, points, map, at) < -1e-3 {
                return Some(format!("step {number} folds at {at:?}"));
            }
        }
    }
    None
}

/// The mean value map by its definition: weights `(tan(α/2) + tan(α'/2)) / r`.
fn image(edges: &[[usize; 2]], points: &[Point], images: &[Point], at: Point) -> Point {
    let (mut total, mut sum) = (0.0, [0.0; 2]);
    for &[p, q] in edges {
        let tangent = (plane::angle(points[p], points[q], at) / 2.0).tan();
        for v in [p, q] {
            let weight = tangent / (points[v][0] - at[0]).hypot(points[v][1] - at[1]);
            total += weight;
            sum = [0, 1].map(|k| sum[k] + weight * images[v][k]);
        }
    }
    sum.map(|x| x / total)
}
