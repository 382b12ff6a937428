//! Laws of paths by the curvature at given vertices, with a control that must fail.

use std::f64::consts::{PI, TAU};

use super::ring::Measures;
use super::{CurvatureBlend, CurvaturePath, ShapeError, ShapePath, sample_closed};

type Ring = Vec<[f64; 2]>;

/// Samples of a flower and of an ellipse that is turned, not at the same parts of the length.
fn pair() -> [Ring; 2] {
    let flower = |u: f64| {
        let radius = 1.0 + 0.3 * (3.0 * TAU * u).cos();
        [radius * (TAU * u).cos(), radius * (TAU * u).sin()]
    };
    let ellipse = |u: f64| [3.0 + (TAU * u + 1.0).cos(), 2.0 * (TAU * u + 1.0).sin()];
    [sample_closed(flower, 60), sample_closed(ellipse, 60)]
}

fn farthest(a: &Ring, b: &Ring) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}

#[test]
fn ends_are_the_stored_ones_and_shapes_tend_to_them() {
    let [source, target] = pair();
    let path = CurvaturePath::new(source.clone(), target.clone()).unwrap();
    let shape = |t: f64| path.at(t).unwrap().remove(0);
    assert_eq!((&shape(0.0), &shape(1.0)), (&source, &target));
    for (t, end) in [(1e-9, &source), (1.0 - 1e-9, &target)] {
        assert!(farthest(&shape(t), end) < 1e-7, "{t}");
    }
    // The control: on a joint partition the vertices are others, and more.
    let blend = CurvatureBlend::new(source.clone(), target).unwrap();
    assert!(blend.at(1e-9).unwrap()[0].len() > source.len());
}

#[test]
fn shapes_are_closed_and_keep_mixed_parts_of_the_length() {
    let [source, target] = pair();
    let [a, b] = [&source, &target].map(|ring| Measures::new(ring).unwrap());
    let path = CurvaturePath::new(source, target).unwrap();
    for t in [0.1, 0.5, 0.8] {
        let shape = Measures::new(&path.at(t).unwrap()[0]).unwrap();
        let error = |i: usize| (shape.lengths[i] - (1.0 - t) * a.lengths[i] - t * b.lengths[i]).abs();
        // A ring that is open shows in its last edge.
        assert!((0..60).all(|i| error(i) < 1e-12), "{t}");
        assert_eq!(shape.turning_number, 1);
        assert!((shape.perimeter - (1.0 - t) * a.perimeter - t * b.perimeter).abs() < 1e-11);
    }
}

#[test]
fn with_the_same_parts_of_the_length_it_is_the_blend_of_curves() {
    let [source, target] = pair();
    let joint = CurvatureBlend::new(source.clone(), target.clone()).unwrap();
    let [a, b] = [0.2, 0.9].map(|t| joint.at(t).unwrap().remove(0));
    let (path, blend) = (CurvaturePath::new(a.clone(), b.clone()).unwrap(), CurvatureBlend::new(a, b).unwrap());
    let [here, there] = [path.at(0.4).unwrap().remove(0), blend.at(0.4).unwrap().remove(0)];
    assert!(farthest(&here, &there) < 1e-6, "{:e}", farthest(&here, &there));
    // The control: with other parts the two are not the same.
    let [here, there] = [CurvaturePath::new(source.clone(), target.clone()).unwrap().at(0.4), joint.at(0.4)];
    assert_ne!(here.unwrap()[0].len(), there.unwrap()[0].len());
}

#[test]
fn a_turned_copy_turns_rigidly() {
    let [source, _] = pair();
    let turned = |angle: f64| -> Ring {
        let (sine, cosine) = angle.sin_cos();
        source.iter().map(|[x, y]| [cosine * x - sine * y, sine * x + cosine * y]).collect()
    };
    let path = CurvaturePath::new(source.clone(), turned(0.8 * PI)).unwrap();
    assert!(farthest(&path.at(0.5).unwrap()[0], &turned(0.4 * PI)) < 1e-11);
}

#[test]
fn rings_that_do_not_correspond_are_refused() {
    let [source, mut target] = pair();
    let reversed: Ring = target.iter().rev().copied().collect();
    let error = CurvaturePath::new(source.clone(), reversed).unwrap_err();
    assert_eq!(error, ShapeError::TurningNumbers { here: 1, there: -1 });
    target.pop();
    let error = CurvaturePath::new(source, target).unwrap_err();
    assert_eq!(error, ShapeError::VertexCounts { ring: 0, here: 60, there: 59 });
}
