//! Hand-made maps of every kind are certified.
#![allow(clippy::print_stdout)]

mod support;

use homeo_verify::{SourceMatch, Verdict, compare_source, verify_bytes};
use support::build::{all_maps, square_grid};
use support::{Map, Refinement};

#[test]
fn every_kind_of_map_is_certified() {
    for (name, map) in all_maps() {
        match verify_bytes(&map.bytes()) {
            Ok(Verdict::Certified(claim)) => assert_eq!(claim.target, map.text("target"), "{name}"),
            other => panic!("{name}: {other:?}"),
        }
    }
}

#[test]
fn the_oracle_accepts_the_same_maps() {
    for (name, map) in all_maps() {
        assert!(support::oracle::is_valid(&map), "{name}");
    }
}

/// Directions and topology do not depend on the scale; the signs of tiny and huge volumes are still exact.
#[test]
fn any_scale_of_coordinates_is_certified() {
    for (name, map) in all_maps() {
        for scale in [2f64.powi(-1070), 2f64.powi(-400), 1e-3, 2f64.powi(300), 2f64.powi(1000)] {
            let mut scaled = map.clone();
            scaled.positions.iter_mut().flatten().for_each(|x| *x *= scale);
            let verdict = verify_bytes(&scaled.signed_bytes());
            assert!(matches!(verdict, Ok(Verdict::Certified(_))), "{name} times {scale}: {verdict:?}");
        }
    }
}

#[test]
fn the_largest_weights_are_certified() {
    let (positions, cells) = square_grid(1);
    let mut map = Map::new("piecewise-linear", "square", positions, cells);
    map.refinement = Some(Refinement {
        carrier_vertices: vec![vec![3, 0, 1]],
        carrier_weights: vec![vec![i64::MAX, i64::MAX - 2, 0]],
        cells: vec![vec![0, 1, 4], vec![1, 3, 4], vec![0, 4, 2], vec![4, 3, 2]],
        parents: vec![0, 0, 1, 1],
    });
    map.target_positions = [[0., 0.], [1., 0.], [0., 1.], [1., 1.], [0.25, 0.25]].map(|p| p.to_vec()).to_vec();
    let verdict = verify_bytes(&map.signed_bytes());
    assert!(matches!(verdict, Ok(Verdict::Certified(_))), "{verdict:?}");
}

#[test]
fn sources_are_compared_bit_for_bit() {
    let (_, map) = all_maps().swap_remove(3);
    let (bytes, mut cells) = (map.bytes(), map.source_cells.concat());
    let mut positions: Vec<[f64; 3]> = map.positions.iter().map(|p| [p[0], p[1], p[2]]).collect();
    let compare = |positions: &[[f64; 3]], cells: &[u32], size: usize| {
        compare_source(&bytes, positions, cells, size).expect("a readable map") == SourceMatch::Same
    };
    assert!(compare(&positions, &cells, 4));
    assert!(!compare(&positions, &cells, 3));
    assert!(!compare(&positions, &cells, 0));
    assert!(!compare(&positions[1..], &cells, 4));
    assert!(!compare(&positions, &cells[4..], 4));
    cells.swap(0, 1);
    assert!(!compare(&positions, &cells, 4));
    cells.swap(0, 1);
    positions[0][0] = -0.0;
    assert!(!compare(&positions, &cells, 4));
}
