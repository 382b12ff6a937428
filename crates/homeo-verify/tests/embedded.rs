//! Shells that claim not to overlap themselves: valid ones, negative controls for E1 and E2, and random mutations judged by
//! an oracle that looks at all pairs of tetrahedra.
#![allow(clippy::print_stdout)] // counts, for people

mod support;

use homeo_verify::{Verdict, verify_bytes};
use serde_json::json;
use support::clip::{Rational, cross, dot, minus};
use support::mutants::{is_small, mutate};
use support::random::Random;
use support::shells::{Exact, Mesh, all_shells, are_apart, is_valid, joined, octahedron, scaled, shell, tetrahedron};
use support::{Map, assert_refuted};

fn claiming(mut map: Map) -> Map {
    map.manifest["target"] = json!("embedded-shell");
    map
}

/// All tetrahedra of the stored decomposition, by the page: corners of columns before the pillar's are low, others high.
fn tetrahedra(map: &Map) -> Vec<[Rational; 4]> {
    let shell = Exact::new(map);
    let mut found = vec![];
    for cell in &map.prisms {
        let mut order = cell.clone();
        order.sort_unstable();
        let [i, j, k] = [order[0], order[1], order[2]];
        for low in [0, 1] {
            let up = low + 1;
            let cells = [
                [(i, low), (j, low), (k, low), (k, up)],
                [(i, low), (j, low), (j, up), (k, up)],
                [(i, low), (i, up), (j, up), (k, up)],
            ];
            found.extend(cells.map(|corners| corners.map(|corner| shell.at(corner).clone())));
        }
    }
    // At a pinched column some are flat.
    found.retain(|[a, b, c, d]| dot(&minus(d, a), &cross(&minus(b, a), &minus(c, a))) != 0.into());
    found
}

/// Whether the insides of two tetrahedra are disjoint: a plane along a face of one, or along an edge of each, separates them.
fn have_disjoint_insides(a: &[Rational; 4], b: &[Rational; 4]) -> bool {
    let edges = |t: &[Rational; 4]| -> Vec<Rational> {
        (0..4).flat_map(|i| (0..i).map(move |j| [i, j])).map(|[i, j]| minus(&t[i], &t[j])).collect()
    };
    let (of_a, of_b) = (edges(a), edges(b));
    let pairs = |u: &[Rational], v: &[Rational]| -> Vec<Rational> {
        u.iter().flat_map(|x| v.iter().map(move |y| cross(x, y))).collect()
    };
    let normals = [pairs(&of_a, &of_a), pairs(&of_b, &of_b), pairs(&of_a, &of_b)].concat();
    normals.iter().filter(|n| n.iter().any(|x| *x != 0.into())).any(|n| {
        let range = |t: &[Rational; 4]| {
            let mut heights = t.each_ref().map(|p| dot(n, p));
            heights.sort();
            let [least, .., most] = heights;
            [least, most]
        };
        let ([least, most], [other_least, other_most]) = (range(a), range(b));
        most <= other_least || other_most <= least
    })
}

fn is_embedded(map: &Map) -> bool {
    let cells = tetrahedra(map);
    let are_disjoint = |a: &[Rational; 4], b: &[Rational; 4]| are_apart(a, b) || have_disjoint_insides(a, b);
    (0..cells.len()).all(|k| cells[..k].iter().all(|other| are_disjoint(&cells[k], other)))
}

fn is_certified(map: &Map) -> bool {
    matches!(verify_bytes(&map.bytes()), Ok(Verdict::Certified(_)))
}

#[test]
fn shells_are_certified_only_if_they_do_not_overlap() {
    let mut counts = [0; 2];
    for (name, map) in all_shells() {
        let map = claiming(Map { section: None, ..map });
        if map.prisms.len() > 60 {
            continue; // the oracle is slow
        }
        let certified = is_certified(&map);
        assert_eq!(certified, is_embedded(&map), "{name}: {:?}", verify_bytes(&map.bytes()));
        counts[usize::from(certified)] += 1;
    }
    assert!(counts[1] >= 5, "{counts:?}");
}

/// Two similar surfaces, each with its own layer between two of its multiples.
fn two(mesh: &Mesh, second: f64, offset: [f64; 3], layers: [[f64; 2]; 2]) -> Map {
    let of = |factors: [f64; 2]| -> Mesh {
        let [first, other] =
            factors.map(|factor| (mesh.0.iter().map(|&p| scaled(p, factor)).collect(), mesh.1.clone()));
        joined(&first, &other, offset)
    };
    let source = of([1.0, second]);
    let [low, high] = [0, 1].map(|k| of([layers[0][k], layers[1][k]]).0);
    shell(&source, &source.1, [&low, &source.0, &high])
}

#[test]
fn layers_that_cross_are_refuted() {
    let layers = [[0.75, 1.25]; 2];
    for (distance, rule) in [(2.6, None), (2.35, Some("E1"))] {
        let map = two(&octahedron(), 1.0, [distance, 0.0, 0.0], layers);
        assert!(is_certified(&map), "as a shell that may overlap itself");
        let map = claiming(map);
        assert_eq!(is_embedded(&map), rule.is_none());
        match rule {
            None => assert!(is_certified(&map)),
            Some(rule) => _ = assert_refuted(&map, rule, "meet"),
        }
    }
}

/// One layer's top lies inside the other layer; their skins do not meet.
#[test]
fn layers_that_lie_in_one_another_are_refuted() {
    let map = two(&octahedron(), 0.5, [0.0; 3], [[0.6, 1.4], [0.45, 0.8]]);
    assert!(is_certified(&map), "as a shell that may overlap itself");
    assert!(!is_embedded(&map));
    assert_refuted(&claiming(map), "E2", "preimages");
}

/// What became of shells that claim to be embedded, each judged by the oracle.
#[derive(Debug, Default)]
struct Tally {
    certified: usize,
    /// Refuted by E1 or E2, by rule, and overlapping.
    overlapping: [usize; 2],
    /// Refuted by E1, and in contact only.
    touching: usize,
}

impl Tally {
    fn judge(&mut self, map: &Map) {
        match verify_bytes(&map.bytes()) {
            Ok(Verdict::Certified(_)) => {
                assert!(is_valid(map) && is_embedded(map), "{map:?}");
                self.certified += 1;
            }
            Ok(Verdict::Refuted(witness)) if witness.rule.starts_with('E') => {
                assert!(is_valid(map), "the other rules hold: {map:?}");
                match is_embedded(map) {
                    false => self.overlapping[usize::from(witness.rule == "E2")] += 1,
                    true => {
                        assert_eq!(witness.rule, "E1", "{witness:?}");
                        self.touching += 1;
                    }
                }
            }
            Ok(Verdict::Refuted(_)) => assert!(!is_valid(map), "{map:?}"),
            _ => {}
        }
    }
}

#[test]
fn random_pairs_of_layers_are_told_apart() {
    let (mut random, mut tally) = (Random(77), Tally::default());
    let t = tetrahedron();
    for _ in 0..150 {
        let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
        let layers = [[between(0.3, 0.9), between(1.1, 1.9)], [between(0.3, 0.9), between(1.1, 1.9)]];
        let second = between(0.2, 1.0);
        let is_nested = between(0.0, 1.0) < 0.5;
        let offset = [0; 3].map(|_| if is_nested { 0.0 } else { between(-3.0, 3.0) });
        // The second layer's factors are of the first surface's size.
        let layers = [layers[0], layers[1].map(|factor| second * factor)];
        tally.judge(&claiming(two(&t, second, offset, layers)));
    }
    println!("{tally:?}");
    assert!(tally.certified >= 10 && tally.overlapping.iter().all(|&count| count >= 5), "{tally:?}");
}

const MUTANTS: usize = 250;

#[test]
fn mutants_are_certified_only_if_the_oracle_finds_them_apart() {
    let all = all_shells().into_iter().map(|(_, map)| map).filter(|m| is_small(m) && m.section.is_none());
    let shells: Vec<Map> = all.map(claiming).filter(is_certified).collect();
    let (mut random, mut tally) = (Random(31), Tally::default());
    for _ in 0..MUTANTS {
        let mut map = random.pick(&shells).clone();
        mutate(&mut random, &mut map);
        map.sign();
        tally.judge(&map);
    }
    assert!(tally.certified >= 12, "{tally:?}");
}
