//! Rules that composite mean value maps keep.

use homeo_core::planar::{PlanarDomain, Point2};

use super::chart::{Frame, Step};
use super::number::Ball;
use super::{JacobianLimits, JacobianVerdict, triangulate};

fn step(rings: Vec<Vec<Point2>>, images: &[Point2]) -> Step {
    let domain = PlanarDomain::new(rings).unwrap();
    let triangles = triangulate(&domain).unwrap();
    Step::new(&domain, &triangles, images.to_vec())
}

fn l_shape() -> Vec<Point2> {
    vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 1.5], [1.0, 2.0], [0.0, 2.0]]
}

fn regular(n: usize, radius: f64) -> Vec<Point2> {
    let at = |k: usize| (k as f64 / n as f64 * std::f64::consts::TAU).sin_cos();
    (0..n).map(|k| [radius * at(k).1, radius * at(k).0]).collect()
}

#[test]
fn speed() {
    for n in [20, 64, 200] {
        let source = regular(n, 1.0);
        for amount in [0.0, 0.02, 0.1, 0.3] {
            let images: Vec<Point2> =
                source.iter().enumerate().map(|(k, p)| p.map(|c| c * (1.0 + amount * (5.0 * k as f64 / n as f64 * std::f64::consts::TAU).sin()))).collect();
            let step = step(vec![source.clone()], &images);
            let start = std::time::Instant::now();
            let verdict = step.bound(&JacobianLimits::default(), &|| false);
            let time = start.elapsed().as_secs_f64();
            let boxes = match verdict { JacobianVerdict::Positive { boxes, .. } | JacobianVerdict::Negative { boxes, .. } | JacobianVerdict::Undecided { boxes, .. } => boxes };
            println!("{n} {amount}: {verdict:?} {time} {} us/box/vertex", time * 1e6 / boxes as f64 / n as f64);
        }
    }
}
