//! Hand-made maps of every kind are certified.
#![allow(clippy::print_stdout)]

mod support;

use homeo_verify::{Verdict, verify_bytes};
use support::build::all_maps;

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
        let start = std::time::Instant::now();
        assert!(support::oracle::is_valid(&map), "{name}");
        println!("{name}: {} cells, {:?}", map.cells().len(), start.elapsed());
    }
}
