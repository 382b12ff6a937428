//! Time of warping a picture: making the map, asking it for every pixel, and sampling.
//!
//! `cargo bench -p homeo --bench warp`, with `RAYON_NUM_THREADS=1` for one core. The floor is copying the picture.
#![allow(clippy::print_stdout)]

use std::f64::consts::TAU;
use std::time::Instant;

use homeo::composite::{CompositeMap, triangulate};
use homeo::construct::harmonic::{HarmonicParams, harmonic_map};
use homeo::map::PlanarBijection;
use homeo::progress::Silent;
use homeo::warp::{Filter, Placement, Raster, apply_field, backward_field};
use homeo_core::planar::{DomainPair, PlanarDomain, Point2};

const WIDTH: usize = 3840;
const HEIGHT: usize = 2160;

/// A polygon near the frame, waved or not.
fn cage(n: usize, wave: f64) -> Vec<Vec<Point2>> {
    let place = |k: usize| {
        let angle = TAU * k as f64 / n as f64;
        let r = 0.95 + wave * (5.0 * angle).sin();
        [1900.0 + 1900.0 * r * angle.cos(), 1080.0 + 1070.0 * r * angle.sin()]
    };
    vec![(0..n).map(place).collect()]
}

fn least_of<T>(runs: usize, mut work: impl FnMut() -> T) -> (f64, T) {
    let mut timed = || {
        let start = Instant::now();
        let made = work();
        (start.elapsed().as_secs_f64(), made)
    };
    let first = timed();
    (1..runs).fold(first, |(best, _), _| {
        let (seconds, made) = timed();
        (best.min(seconds), made)
    })
}

fn main() {
    println!(
        "{WIDTH} x {HEIGHT} pixels, {} threads, seconds (the least of several runs)",
        rayon::current_num_threads()
    );
    let mut picture = Raster::<u8>::zero(WIDTH, HEIGHT, 3, false);
    picture.samples.iter_mut().enumerate().for_each(|(i, s)| *s = ((i * 2_654_435_761) >> 13) as u8);
    let (copy, _) = least_of(5, || picture.clone());
    println!("{copy:8.3}  copy of the picture (floor)");
    let placement = Placement { origin: [0.0, 0.0], scale: 1.0, is_upwards: false };
    for n in [20, 200] {
        let pair = DomainPair::new(cage(n, 0.0), cage(n, 0.04)).expect("a pair");
        let (made, map) = least_of(2, || harmonic_map(&pair, HarmonicParams::default(), &Silent).expect("a map"));
        println!("{made:8.3}  map of a {n}-gon");
        let (asked, field) = least_of(3, || backward_field(&map, &placement, WIDTH, HEIGHT));
        println!("{asked:8.3}  where every pixel comes from");
        for filter in [Filter::Linear, Filter::Bicubic, Filter::Lanczos] {
            let (sampled, _) = least_of(3, || apply_field(&picture, &field, WIDTH, filter));
            println!("{sampled:8.3}  ready warp applied, {filter:?}, 3 channels of 8 bits");
        }
    }
    composite();
}

/// Composite mean value maps: images of all pixels of a square picture by many steps, and of points of a large cage.
fn composite() {
    for (n, steps, side) in [(20, 100, 4096), (200, 1, 1000), (200, 10, 1000)] {
        let domain = |k: usize| PlanarDomain::new(cage(n, 0.04 * k as f64 / steps as f64)).expect("a domain");
        let domains: Vec<PlanarDomain> = (0..=steps).map(domain).collect();
        let tilings = domains[..steps].iter().map(|domain| triangulate(domain).expect("triangles")).collect();
        let map = CompositeMap::from_domains(domains, tilings).expect("a map");
        let points: Vec<Point2> = (0..side * side)
            .map(|k| [(k % side) as f64 * 3840.0 / side as f64, (k / side) as f64 * 2160.0 / side as f64])
            .collect();
        let mut images = vec![None; points.len()];
        let (seconds, ()) = least_of(1, || map.forward_along(&points, &mut images));
        let inside = images.iter().flatten().count();
        // The floor: one root and one division for each vertex and step.
        let sights = inside as f64 * (n * steps) as f64;
        let (floor, _) = least_of(3, || roots_and_divisions(20_000_000));
        println!(
            "{seconds:8.3}  images of {inside} points by {steps} steps of a {n}-gon (floor {:.3})",
            floor * sights / 20e6 / rayon::current_num_threads() as f64
        );
    }
}

/// So many roots and divisions, on one core.
fn roots_and_divisions(count: usize) -> f64 {
    let mut lanes = [1.0f64, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    for _ in 0..count / lanes.len() {
        lanes.iter_mut().for_each(|x| *x = 1.0 / (*x + 1.0).sqrt() + 0.5);
    }
    std::hint::black_box(lanes.iter().sum())
}
