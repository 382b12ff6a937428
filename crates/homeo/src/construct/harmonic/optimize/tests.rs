//! The gradient against differences, and what optimizing keeps.

use super::*;
use crate::construct::harmonic::{HarmonicParams, MiddleShape, harmonic_map};
use crate::progress::Silent;
use homeo_core::planar::DomainPair;

fn pair() -> DomainPair {
    let square = vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0]];
    let bent = vec![[0.0, 0.0], [1.0, 0.5], [3.0, 0.0], [2.5, 1.0], [1.0, 1.2], [0.0, 1.0]];
    DomainPair::new(vec![square], vec![bent]).unwrap()
}

#[test]
fn the_gradient_is_that_of_the_energy() {
    let pair = pair();
    let [source, target] = [&pair.source, &pair.target].map(|d| Triangulated::new(d, 300, false, &Silent).unwrap());
    for kind in [Distortion::Conformal, Distortion::Isometric] {
        let area = 4.0 * 2.0;
        let sides = [Side::new(&source).unwrap(), Side::new(&target).unwrap()];
        let problem = Problem { sides, kind, area };
        let n = 6;
        let polygon: Vec<Point2> =
            (0..n).map(|i| TAU * (i as f64 + 0.1 * (i as f64).sin()) / n as f64).map(|t| [t.cos(), t.sin()]).collect();
        let state = problem.state(polygon.clone(), None);
        let gradient = problem.gradient(&state);
        let (mut miss, mut size) = (0.0f64, 0.0f64);
        for (v, axis) in (0..n).flat_map(|v| [(v, 0), (v, 1)]) {
            // With the same triangles meeting: only so is the energy differentiable.
            let at = |step: f64| {
                let mut moved = polygon.clone();
                moved[v][axis] += step;
                let middle = Middle::new(vec![moved]);
                let images = [0, 1].map(|k| problem.sides[k].images(&middle));
                let of = |(t, &met): (usize, &u32)| {
                    determinant(problem.sides[0].sides[t]) * kind.of(problem.jacobian(&images, t, met))
                };
                state.met.iter().enumerate().map(of).sum::<f64>() / area
            };
            let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
            miss = miss.max((slope - gradient[v][axis]).abs());
            size = size.max(slope.abs());
        }
        assert!(miss < 1e-6 * size && size > 1e-3, "{kind:?}: {miss:e} of {size:e}");
    }
}

#[test]
fn optimized_middles_distort_less_and_stay_convex() {
    for kind in [Distortion::Conformal, Distortion::Isometric] {
        let with = |middle| {
            harmonic_map(&pair(), HarmonicParams { triangles: 500, middle, turn_degrees: None }, &Silent).unwrap()
        };
        let (averaged, optimized) = (with(MiddleShape::AveragedLengths), with(MiddleShape::Optimized(kind)));
        let [before, after] = [&averaged, &optimized].map(|map| map.distortion(kind).mean);
        assert!(after < 0.999 * before, "{kind:?}: {after} {before}");
        assert!(is_convex(&optimized.middle().rings()[0]));
        assert_eq!(optimized.middle(), with(MiddleShape::Optimized(kind)).middle());
    }
}

#[test]
fn convexity_is_told_exactly() {
    let star: Vec<Point2> = (0..5).map(|i| TAU * 2.0 * i as f64 / 5.0).map(|t| [t.cos(), t.sin()]).collect();
    assert!(!is_convex(&star), "it turns left everywhere, but goes round twice");
    assert!(is_convex(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]));
    assert!(!is_convex(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0]]));
}

#[test]
fn stopping_is_heard() {
    struct Stopped;
    impl Progress for Stopped {
        fn is_cancelled(&self) -> bool {
            true
        }
    }
    let params =
        HarmonicParams { triangles: 50, middle: MiddleShape::Optimized(Distortion::Conformal), turn_degrees: None };
    assert_eq!(harmonic_map(&pair(), params, &Stopped).err(), Some(HarmonicError::Cancelled));
}
