//! Shells of surfaces that cross themselves: valid ones, negative controls for the rules on pairs, and random mutations
//! judged by an oracle.
#![allow(clippy::print_stdout)] // counts, for people

mod support;

use homeo_verify::{Verdict, verify_bytes};
use serde_json::json;
use support::immersed::{TUBE_TRIANGLES, around_tube_twice, immersed, immersed_shells, tube_round, uneven};
use support::mutants::{is_small, judge, mutate};
use support::random::Random;
use support::shells::{Exact, around, is_valid, joined, octahedron, over_plane, shell};
use support::{Map, assert_refuted, write};

fn named(name: &str) -> Map {
    immersed_shells().into_iter().find(|(other, _)| *other == name).expect("a name from the list").1
}

/// A shell with all pairs listed.
fn with_all_pairs(mut map: Map) -> Map {
    let (cells, prisms) = (map.source_cells.len() as u32, map.prisms.len() as u32);
    map.pairs = Some((0..cells).flat_map(|c| (0..prisms).map(move |q| [c, q])).collect());
    map.manifest["target"] = json!("immersed-shell");
    map
}

#[test]
fn surfaces_that_cross_themselves_are_certified() {
    for (name, map) in immersed_shells() {
        let Ok(Verdict::Certified(claim)) = verify_bytes(&map.bytes()) else {
            panic!("{name}: {:?}", verify_bytes(&map.bytes()))
        };
        assert_eq!([&claim.kind[..], &claim.target], ["shell", "immersed-shell"], "{name}");
        assert!(claim.statement.contains("theorem on immersed shells, rules L1-L6 and I1-I4"), "{}", claim.statement);
        assert!(claim.statement.contains("abstract surfaces"), "{}", claim.statement);
        let pairs = claim.checked.iter().find(|(what, _)| what.starts_with("pairs")).map(|(_, count)| *count as usize);
        assert_eq!(pairs, map.pairs.map(|pairs| pairs.len()), "{name}");
    }
}

#[test]
fn the_oracle_accepts_the_same_shells() {
    for (name, map) in immersed_shells() {
        assert!(is_valid(&map), "{name}");
    }
}

/// Without a list of pairs the theorem is that of embedded surfaces, and with all pairs it is the same.
#[test]
fn surfaces_that_cross_themselves_need_their_pairs() {
    for (name, mut map) in immersed_shells() {
        (map.manifest["target"], map.pairs) = (json!("shell"), None);
        let does_cross = name != "octahedron";
        for map in [with_all_pairs(map.clone()), map] {
            let verdict = verify_bytes(&map.signed_bytes());
            assert_eq!(matches!(verdict, Ok(Verdict::Refuted(_))), does_cross, "{name}: {verdict:?}");
        }
    }
}

#[test]
fn containers_of_immersed_shells() {
    let unreadable = |map: &Map, words: &str| match verify_bytes(&map.bytes()) {
        Err(error) => assert!(error.message.contains(words), "{error}"),
        Ok(verdict) => panic!("readable: {verdict:?}"),
    };
    let mut map = named("octahedron");
    map.pairs = None;
    unreadable(&map, "shell_pairs is missing");
    for target in ["shell", "section"] {
        let mut map = named("octahedron");
        map.manifest["target"] = json!(target);
        map.section = (target == "section").then(|| (map.positions.clone(), map.source_cells.clone()));
        unreadable(&map, "does not belong");
    }
    let mut map = named("octahedron");
    map.manifest["kind"] = json!("piecewise-linear");
    unreadable(&map, "belong together");
    let mut entries = write::entries(&named("octahedron"));
    let pairs = entries.iter_mut().find(|entry| entry.0 == "shell_pairs.npy").expect("it is there");
    pairs.1 = write::npy("<u4", "(2,)", &[0; 8]);
    let error = verify_bytes(&write::zip(&entries)).expect_err("the pairs have no columns");
    assert!(error.message.contains("header"), "{error}");
}

#[test]
fn rule_i1_pairs_exist_and_ascend() {
    let with = |change: &dyn Fn(&mut Vec<[u32; 2]>)| {
        let mut map = named("ramp");
        change(map.pairs.as_mut().expect("it has pairs"));
        map
    };
    assert_refuted(&with(&|pairs| pairs.push([10, 0])), "I1", "does not exist");
    assert_refuted(&with(&|pairs| pairs.push([9, 10])), "I1", "does not exist");
    assert_refuted(&with(&|pairs| pairs.push([u32::MAX, u32::MAX])), "I1", "does not exist");
    assert_refuted(&with(&|pairs| pairs.push(pairs[pairs.len() - 1])), "I1", "ascending");
    let witness = assert_refuted(&with(&|pairs| pairs.swap(2, 3)), "I1", "ascending");
    assert_eq!(witness.cells.len(), 2);
}

/// Every pair of these lists is needed: a lift would end without it.
#[test]
fn any_pair_that_is_missing_is_found() {
    let mut rules = std::collections::BTreeMap::new();
    for (name, map) in immersed_shells().into_iter().filter(|(_, map)| is_small(map)) {
        for k in 0..map.pairs.as_ref().expect("it has pairs").len() {
            let mut map = map.clone();
            let [c, q] = map.pairs.as_mut().expect("it has pairs").remove(k);
            let Ok(Verdict::Refuted(witness)) = verify_bytes(&map.bytes()) else { panic!("{name}: {c} {q}") };
            assert_eq!(witness.cells, [c, map.source_cells.len() as u32 + q], "{name}: {witness:?}");
            *rules.entry(witness.rule).or_insert(0) += 1;
        }
    }
    println!("{rules:?}");
    assert!(["I2", "I3", "I4"].iter().all(|rule| rules.get(rule).is_some_and(|&count| count >= 10)), "{rules:?}");
}

/// A second sheet in the pairs of the first.
#[test]
fn pairs_of_another_sheet_are_refuted() {
    let mut added = 0;
    for name in ["ramp", "octahedra that cross", "hexagons that cross"] {
        let map = named(name);
        let exact = Exact::new(&map);
        let own = map.pairs.clone().expect("it has pairs");
        for pair in (0..map.source_cells.len()).flat_map(|c| (0..map.prisms.len()).map(move |q| [c, q])) {
            let pair32 = pair.map(|n| n as u32);
            if own.contains(&pair32) || exact.beside(pair).is_empty() {
                continue; // it does no harm where the two do not meet
            }
            let other = immersed(map.clone(), own.iter().copied().chain([pair32]));
            let verdict = verify_bytes(&other.bytes());
            let Ok(Verdict::Refuted(witness)) = verdict else { panic!("{name} with {pair:?}: {verdict:?}") };
            assert!(["L3", "L4", "L5"].contains(&witness.rule), "{name} with {pair:?}: {witness:?}");
            added += 1;
        }
    }
    assert!(added >= 20, "{added}");
}

/// A closed surface that crosses itself.
#[test]
fn a_tube_that_winds_twice_is_certified() {
    let map = around_tube_twice(&tube_round(2, uneven));
    assert_refuted(&with_all_pairs(map.clone()), "L5", "has 2 preimages");
    let map = immersed(map, (0..2 * TUBE_TRIANGLES).map(|c| [c, c]));
    assert!(matches!(verify_bytes(&map.bytes()), Ok(Verdict::Certified(_))));
}

/// Locally all is well, but the tube goes round twice in a shell that goes round once.
#[test]
fn surfaces_that_cover_the_middle_twice_are_refuted() {
    let level = |factor: f64| tube_round(1, |_| factor);
    let once = shell(&tube_round(2, uneven), &level(1.0).1, [&level(0.5).0, &level(1.0).0, &level(1.5).0]);
    let seeds = (0..2 * TUBE_TRIANGLES).map(|c| [c, c % TUBE_TRIANGLES]);
    assert_refuted(&immersed(once.clone(), seeds), "L6", "in 2 points");
    assert_refuted(&with_all_pairs(once), "L6", "in 2 points");
}

/// The other way round: the shell goes round twice, and holds each point of the surface in two prisms.
#[test]
fn shells_that_cover_the_surface_twice_are_refuted() {
    let twice = around_tube_twice(&tube_round(1, |_| 1.0));
    let seeds = (0..2 * TUBE_TRIANGLES).map(|q| [q % TUBE_TRIANGLES, q]);
    let all = immersed(twice.clone(), seeds);
    assert_refuted(&all, "L5", "has 2 preimages");
    // Half of the pairs are not complete: what begins in one place goes round into the other.
    assert_eq!(immersed(twice, [[0, 0]]).pairs, all.pairs);
}

#[test]
fn copies_are_counted_by_their_pairs() {
    let o = octahedron();
    let twice = joined(&o, &o, [0.0; 3]);
    let level = |factor: f64| -> Vec<[f64; 3]> { twice.0.iter().map(|p| p.map(|x| factor * x)).collect() };
    let same = || (0..8).map(|c| [c, c]);
    // Two shells in one place: each copy of the surface has its own.
    let both = shell(&twice, &twice.1, [&level(0.75), &twice.0, &level(1.25)]);
    let apart = immersed(both.clone(), (0..16).map(|c| [c, c]));
    assert!(matches!(verify_bytes(&apart.bytes()), Ok(Verdict::Certified(_))) && is_valid(&apart));
    let crosswise = immersed(both.clone(), (0..16).map(|c| [c, (c + 8) % 16]));
    assert!(matches!(verify_bytes(&crosswise.bytes()), Ok(Verdict::Certified(_))) && is_valid(&crosswise));
    assert_refuted(&immersed(both, same()), "L5", "has 0 preimages");
    let one_surface = shell(&o, &twice.1, [&level(0.75), &twice.0, &level(1.25)]);
    assert_refuted(&immersed(one_surface.clone(), same()), "L6", "in 0 points");
    assert_refuted(&with_all_pairs(one_surface), "L5", "has 2 preimages");
    let one_shell = around(&twice, &o, [0.75, 1.25]);
    assert_refuted(&immersed(one_shell.clone(), same()), "L5", "has 0 preimages");
    assert_refuted(&with_all_pairs(one_shell), "L6", "in 2 points");
}

/// A vertex pulled through bottom, top or a wall of its own prisms is refuted; through those of another sheet it is not.
#[test]
fn only_own_sheets_count() {
    let ramp = support::immersed::ramp();
    let seeds = || (0..10).map(|c| [c, c]);
    let map = named("finer ramp");
    for z in [2.0, -2.0] {
        let mut pulled = map.clone();
        pulled.positions[12][2] = z;
        assert_refuted(&pulled, "L3", "bottom or the top");
    }
    let shifted = |by: f64| {
        let mut mesh = ramp.clone();
        mesh.0[8..].iter_mut().for_each(|p| p[2] += by);
        over_plane(&mesh, &mesh, [-0.5, 0.5])
    };
    for by in [-1.0, -0.5, 0.0, 0.5, 1.0] {
        let map = immersed(shifted(by), seeds());
        assert!(matches!(verify_bytes(&map.bytes()), Ok(Verdict::Certified(_))), "{by}");
    }
}

const MUTANTS: usize = 1500;

fn mutate_pairs(random: &mut Random, map: &mut Map) -> &'static str {
    let [c, q] = [map.source_cells.len(), map.prisms.len()].map(|count| random.below(count) as u32);
    let pairs = map.pairs.as_mut().expect("it has pairs");
    let (k, l) = (random.below(pairs.len()), random.below(pairs.len()));
    match random.below(6) {
        0 => {
            pairs.remove(k);
            "pairs dropped"
        }
        1 | 2 => {
            pairs.push([c, q]);
            pairs.sort_unstable();
            pairs.dedup(); // often they do not meet
            "pairs added"
        }
        3 => {
            pairs[k] = if random.below(2) == 0 { [c, pairs[k][1]] } else { [pairs[k][0], q] };
            pairs.sort_unstable();
            "pairs moved"
        }
        4 => {
            pairs.swap(k, l);
            "pairs in disorder"
        }
        _ => {
            pairs[k][random.below(2)] ^= 1 << random.below(32);
            "pairs with a bit flipped"
        }
    }
}

#[test]
fn mutants_are_certified_exactly_when_the_oracle_finds_them_valid() {
    let shells = immersed_shells().into_iter().filter(|(_, map)| is_small(map)).collect();
    let tally = judge(shells, MUTANTS, 21, |random, map| match random.below(2) {
        0 => mutate_pairs(random, map),
        _ => mutate(random, map),
    });
    assert!(tally.kinds.len() == 13 && tally.kinds.values().all(|counts| counts.iter().sum::<usize>() >= 30));
    let (added, moved) = (tally.kinds["pairs added"], tally.kinds["source positions"]);
    assert!(added[0] >= 30 && added[1] >= 30 && moved[0] >= 10 && moved[1] >= 50, "{added:?} {moved:?}");
    for rule in ["I1", "I2", "I3", "I4", "L3", "L4"] {
        let count: usize = tally.rules.iter().filter(|(what, _)| what.starts_with(rule)).map(|(_, n)| n).sum();
        assert!(count >= 10, "{rule}: {count}");
    }
}
