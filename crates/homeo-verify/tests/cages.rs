//! Maps between cages: valid ones, a negative control for each rule, and random motions judged by weights of another source.
#![allow(clippy::print_stdout)] // counts, for people

mod support;

use homeo_verify::{SourceMatch, Verdict, compare_source, verify_bytes};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use support::moved::is_injective;
use support::random::Random;
use support::{Map, assert_refuted, spatial};

type Place = [f64; 3];

/// The map file of a map through cages of the same triangles.
fn between(stages: &[Vec<Place>], triangles: &[[u32; 3]]) -> Map {
    let rows = |points: &[Place]| points.iter().map(|p| p.to_vec()).collect::<Vec<_>>();
    let cells = triangles.iter().map(|t| t.to_vec()).collect();
    let mut map = Map::new("composite-cage", "polyhedron", rows(&stages[0]), cells);
    map.target_positions = stages[1..].iter().flat_map(|stage| rows(stage)).collect();
    map.sign();
    map
}

/// Two pyramids, the upper one over the square or below it.
fn dart(top: f64) -> Vec<Place> {
    vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, top], [0.0, 0.0, -1.5]]
}

const DART: [[u32; 3]; 8] = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn tetrahedron(apex: Place) -> Vec<Place> {
    vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], apex]
}

/// A prism over a triangle, the upper end turned. Faces are almost in one plane before.
fn prism(turn: f64) -> Vec<Place> {
    let corner = |k: u32| {
        let (height, turn) = if k < 3 { (0.0, 0.0) } else { (1.5, turn) };
        let (sine, cosine) = (TAU * f64::from(k % 3) / 3.0 + turn).sin_cos();
        [cosine, sine, height]
    };
    (0..6).map(corner).collect()
}

const PRISM: [[u32; 3]; 8] = [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]];

fn places(rows: &[Vec<f64>]) -> Vec<Place> {
    rows.iter().map(|p| [p[0], p[1], p[2]]).collect()
}

/// The cages of a map and its triangles.
fn cages(map: &Map) -> (Vec<Vec<Place>>, Vec<[u32; 3]>) {
    let rows = [&map.positions[..], &map.target_positions].concat();
    let stages = rows.chunks(map.positions.len()).map(places).collect();
    (stages, map.source_cells.iter().map(|t| [t[0], t[1], t[2]]).collect())
}

/// Why a map is none of those that the checker certifies, as far as definitions and samples show.
fn flaw(map: &Map, samples: usize) -> Option<String> {
    let (stages, triangles) = cages(map);
    let rows = |points: &[Place]| points.iter().map(|p| p.to_vec()).collect::<Vec<_>>();
    for (number, points) in stages.iter().enumerate() {
        if !points.as_flattened().iter().all(|x| x.is_finite()) || !is_injective(&rows(points), &map.source_cells) {
            return Some(format!("cage {number} meets itself"));
        }
        let volume: f64 = triangles.iter().map(|t| volume(t.map(|v| points[v as usize]))).sum();
        if volume <= 0.0 {
            return Some(format!("cage {number} is inside out"));
        }
    }
    let mut random = Random(3);
    for pair in stages.windows(2) {
        let range = |k: usize| {
            let all = || pair[0].iter().map(|p| p[k]);
            [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)]
        };
        for _ in 0..samples {
            let at = [0, 1, 2].map(range).map(|[low, high]| low + (high - low) * random.unit());
            if spatial::winding(&pair[0], &triangles, at) > 0.5 && folds(pair, &triangles, at) {
                return Some(format!("it folds round {at:?}"));
            }
        }
    }
    None
}

/// Six times that of the tetrahedron of a triangle and the origin.
fn volume([a, b, c]: [Place; 3]) -> f64 {
    (0..3).map(|k| a[k] * (b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3])).sum()
}

fn folds(pair: &[Vec<Place>], triangles: &[[u32; 3]], at: Place) -> bool {
    spatial::determinant([&pair[0], &pair[1]], triangles, at, 1e-5) < -1e-4
}

#[test]
fn maps_that_do_not_fold_are_certified() {
    let shrunk = |points: Vec<Place>| points.iter().map(|p| p.map(|x| 0.5 * x + 3.0)).collect::<Vec<_>>();
    let tetrahedra = [tetrahedron([0.0, 0.0, 2.0]), tetrahedron([1.0, 1.0, 3.0]), shrunk(tetrahedron([0.5, 0.0, 1.0]))];
    let cases = [
        ("two steps", between(&tetrahedra, &TETRAHEDRON)),
        ("a lid that sinks", between(&[dart(0.25), dart(0.05)], &DART)),
        ("a prism that turns", between(&[prism(0.0), prism(0.2)], &PRISM)),
    ];
    for (name, map) in cases {
        match verify_bytes(&map.bytes()) {
            Ok(Verdict::Certified(claim)) => {
                assert_eq!((&claim.kind[..], &claim.target[..]), ("composite-cage", "polyhedron"), "{name}");
                assert!(claim.checked.iter().all(|(_, n)| *n > 0), "{name}: {:?}", claim.checked);
                let steps = if name == "two steps" { "in 2 steps" } else { "in one step" };
                assert!(claim.statement.contains(steps), "{name}: {}", claim.statement);
            }
            other => panic!("{name}: {other:?}"),
        }
        assert_eq!(flaw(&map, 4000), None, "{name}");
    }
}

#[test]
fn sources_are_compared_bit_for_bit() {
    let map = between(&[dart(0.25), dart(0.5)], &DART);
    let (mut positions, cells) = (places(&map.positions), map.source_cells.concat());
    assert_eq!(compare_source(&map.bytes(), &positions, &cells, 3), Ok(SourceMatch::Same));
    positions[3][0] = positions[3][0].next_up();
    assert!(matches!(compare_source(&map.bytes(), &positions, &cells, 3), Ok(SourceMatch::Different(_))));
}

#[test]
fn what_is_no_closed_surface_is_refuted() {
    let still = || between(&[dart(0.5), dart(0.5)], &DART);
    let mut open = still();
    open.source_cells.pop();
    assert_refuted(&open, "Q1", "one triangle only");
    let mut turned = still();
    turned.source_cells[3].swap(0, 1);
    assert_refuted(&turned, "Q1", "use an edge alike");
    let mut crowded = still();
    crowded.source_cells.push(vec![0, 1, 2]);
    assert_refuted(&crowded, "Q1", "more than two");
    let mut empty = still();
    empty.source_cells.clear();
    assert_refuted(&empty, "Q1", "0 pieces");
    let mut apart = still();
    let far: Vec<Vec<f64>> = apart.positions.iter().map(|p| p.iter().map(|x| x + 9.0).collect()).collect();
    apart.positions.extend(far);
    apart.target_positions = apart.positions.clone();
    let other: Vec<Vec<u32>> = apart.source_cells.iter().map(|t| t.iter().map(|v| v + 6).collect()).collect();
    apart.source_cells.extend(other);
    assert_refuted(&apart, "Q1", "2 pieces");
    let mut pinched = apart.clone();
    pinched.source_cells[8..].iter_mut().flatten().filter(|v| **v == 6).for_each(|v| *v = 0);
    assert_refuted(&pinched, "Q1", "not connected");
    let mut unknown = still();
    unknown.source_cells[2][1] = 6;
    assert_refuted(&unknown, "S2", "does not exist");
    for bad in [f64::NAN, f64::INFINITY] {
        let [mut before, mut after] = [still(), still()];
        before.positions[4][2] = bad;
        after.target_positions[4][2] = bad;
        assert_eq!(assert_refuted(&before, "Q1", "cage 0 is not finite").vertices, [4]);
        assert_eq!(assert_refuted(&after, "Q1", "cage 1 is not finite").vertices, [4]);
    }
}

#[test]
fn cages_that_are_none_are_refuted() {
    let still = dart(0.5);
    let with_top = |top: Place| {
        let mut points = dart(0.5);
        points[4] = top;
        points
    };
    let [through, flat] = [[1.5, 1.5, -1.0], [0.5, 0.5, 0.0]].map(with_top);
    let inside_out: Vec<Place> = still.iter().map(|&[x, y, z]| [-x, y, z]).collect();
    for (bad, words) in [(through, "meet"), (flat, "flat"), (inside_out, "0 pieces of the boundary enclose")] {
        for (stages, number) in [([&bad, &still], 0), ([&still, &bad], 1)] {
            let map = between(&stages.map(Clone::clone), &DART);
            assert!(flaw(&map, 0).is_some_and(|what| what.contains(&format!("cage {number}"))), "{words}");
            let witness = assert_refuted(&map, "Q2", words);
            assert!(witness.message.contains(&format!("cage {number}")), "{witness:?}");
        }
    }
}

/// The witness is a point inside at which weights of another source show the fold.
#[test]
fn maps_that_fold_are_refuted() {
    for (before, after) in [(0.5, -1.2), (0.25, -0.25), (0.3, -0.6)] {
        let stages = [dart(before), dart(after)];
        let at = assert_refuted(&between(&stages, &DART), "Q3", "folds round the point").points[0];
        assert!(spatial::winding(&stages[0], &DART, at) > 0.5 && folds(&stages, &DART, at), "{before} {after} {at:?}");
    }
    let [whole, some] = [[dart(0.5), dart(0.4)], [dart(0.4), dart(-1.2)]].map(|stages| between(&stages, &DART));
    assert_eq!(flaw(&whole, 2000), None);
    assert!(flaw(&some, 2000).is_some());
    let witness = assert_refuted(&between(&[dart(0.5), dart(0.4), dart(-1.2)], &DART), "Q3", "step 1");
    assert!(witness.cells.is_empty());
}

/// Vertices of a prism are moved at random. What is certified has no flaw that samples show, what is refuted has one.
#[test]
fn random_motions_are_judged_rightly() {
    let mut random = Random(11);
    let mut counts = BTreeMap::<String, usize>::new();
    for number in 0..10 {
        let size = [2.0, 2.5][number % 2];
        let mut target = prism(0.0);
        target.as_flattened_mut().iter_mut().for_each(|x| *x += size * (random.unit() - 0.5));
        let stages = [prism(0.0), target];
        let map = between(&stages, &PRISM);
        let outcome = match verify_bytes(&map.bytes()) {
            Ok(Verdict::Certified(_)) => {
                assert_eq!(flaw(&map, 3000), None, "{map:?}");
                "certified".to_owned()
            }
            Ok(Verdict::Refuted(witness)) => {
                let at = witness.points.first().copied().unwrap_or_default();
                let is_seen = if witness.rule == "Q3" { folds(&stages, &PRISM, at) } else { flaw(&map, 0).is_some() };
                assert!(is_seen, "{witness:?}");
                witness.rule.to_string()
            }
            Ok(Verdict::Undecided(_)) => "undecided".to_owned(),
            Err(what) => panic!("{what}"),
        };
        *counts.entry(outcome).or_default() += 1;
    }
    println!("{counts:?}");
    assert!(
        ["certified", "Q2", "Q3"].iter().all(|&outcome| counts.get(outcome).copied().unwrap_or(0) >= 2),
        "{counts:?}"
    );
}
