//! Laws of closed splines that are fitted to points.

use std::f64::consts::TAU;

use homeo::shape::{
    ClosedSpline, CurvatureBlend, CurvatureProfile, ShapePath, SplineError, SplineParams, fit_closed_spline,
    sample_closed,
};

fn flower(u: f64) -> [f64; 2] {
    let (v, r) = (TAU * u, 1.0 + 0.3 * (3.0 * TAU * u).cos());
    [2.0 * r * v.cos(), r * v.sin()]
}

/// With this tolerance every fit is refused, as none is exact: what was found is what is measured.
fn distance(points: &[[f64; 2]], controls: usize, corrections: usize) -> f64 {
    let params = SplineParams { controls, tolerance: 0.0, corrections };
    match fit_closed_spline(points, &params) {
        Err(SplineError::NotReached { found }) => found.distance,
        other => panic!("{other:?}"),
    }
}

#[test]
fn derivatives_are_those_of_the_point_and_continuous_at_knots() {
    let control = vec![[0.0, 0.0], [3.0, 1.0], [2.0, 4.0], [-1.0, 3.0], [-2.0, 0.5]];
    let spline = ClosedSpline::new(control.clone()).unwrap();
    let step = 1e-5;
    let mut jumps = 0.0f64;
    for i in 0..50 {
        let u = f64::from(i) / 50.0;
        let [before, here, after] = [u - step, u, u + step].map(|u| spline.at(u));
        for k in 0..2 {
            let (slope, bend) =
                ((after[0][k] - before[0][k]) / (2.0 * step), (after[1][k] - before[1][k]) / (2.0 * step));
            assert!((slope - here[1][k]).abs() < 1e-6 && (bend - here[2][k]).abs() < 0.1, "{u}: {here:?}");
            jumps = jumps.max((after[2][k] - before[2][k]).abs());
        }
    }
    assert!(jumps < 0.1, "the second derivative is continuous: {jumps}");
    let moved = ClosedSpline::new(control.iter().map(|[x, y]| [2.0 * x - y + 1.0, x + 3.0]).collect()).unwrap();
    let ([x, y], [a, b]) = (spline.at(0.3)[0], moved.at(0.3)[0]);
    assert!((a - (2.0 * x - y + 1.0)).abs() < 1e-14 && (b - (x + 3.0)).abs() < 1e-14, "affine maps go through");
    assert!(ClosedSpline::new(control[..3].to_vec()).is_err());
}

/// Fourth order in the distance of control points.
#[test]
fn fits_converge_with_order_four() {
    let points = sample_closed(|u| [2.0 * (TAU * u).cos(), (TAU * u).sin()], 2000);
    let [coarse, fine] = [80, 320].map(|controls| distance(&points, controls, 0));
    let order = (coarse / fine).log2() / 2.0;
    assert!(fine < 1e-7 && (3.8..4.4).contains(&order), "{coarse:e} {fine:e}: order {order}");
}

#[test]
fn corrected_parameters_are_better_and_in_order() {
    let points = sample_closed(flower, 500);
    let [plain, better] = [0, 20].map(|corrections| distance(&points, 30, corrections));
    assert!(better < 0.5 * plain, "{plain:e} {better:e}");
    let fit = fit_closed_spline(&points, &SplineParams { controls: 100, tolerance: 5e-5, corrections: 20 }).unwrap();
    assert!(fit.parameters.windows(2).all(|pair| pair[0] < pair[1]), "feet are in order");
    assert!(fit.parameters[499] < fit.parameters[0] + 1.0);
    let foot = |(point, &u): (&[f64; 2], &f64)| {
        let [[x, y], ..] = fit.spline.at(u);
        (x - point[0]).hypot(y - point[1])
    };
    let farthest = points.iter().zip(&fit.parameters).map(foot).fold(0.0, f64::max);
    assert!(farthest == fit.distance, "the distance is that of the feet");
}

/// Section 3.3.1: what lies between two curves becomes smooth, and its curvature stays that of the blend.
#[test]
fn a_blended_curve_is_fitted() {
    let ellipse = |u: f64| [1.5 * (TAU * u).cos(), (TAU * u).sin()];
    let path = CurvatureBlend::new(sample_closed(ellipse, 300), sample_closed(flower, 300)).unwrap();
    let ring = &path.at(0.5).unwrap()[0];
    let profile = CurvatureProfile::new(ring).unwrap();
    let curvature = |spline: &ClosedSpline, u: f64| {
        let [_, [a, b], [c, d]] = spline.at(u);
        (a * d - b * c) / a.hypot(b).powi(3)
    };
    let greatest = profile.values().iter().fold(0.0f64, |all, value| all.max(value.abs())) / profile.length();
    let worst = |controls: usize, tolerance: f64| {
        let fit = fit_closed_spline(ring, &SplineParams { controls, tolerance, corrections: 20 }).unwrap();
        let rows = profile.values().iter().zip(&fit.parameters);
        let missed = rows.map(|(value, &u)| (value / profile.length() - curvature(&fit.spline, u)).abs());
        missed.fold(0.0, f64::max) / greatest
    };
    // Figure 3.7: more control points bring the curvature nearer.
    let [few, many] = [worst(20, 1e-2), worst(120, 1e-4)];
    assert!(many < 0.2 && few > 3.0 * many, "of the greatest curvature {few} with few, {many} with many");
}

#[test]
fn what_cannot_be_fitted_is_said() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let params = |controls| SplineParams { controls, tolerance: 1e-6, corrections: 5 };
    assert!(matches!(fit_closed_spline(&square, &params(5)), Err(SplineError::Controls { controls: 5, points: 4 })));
    assert!(matches!(fit_closed_spline(&[[0.0; 2]; 4], &params(4)), Err(SplineError::Ring(_))));
    // Many points on one short piece leave other control points free.
    let mut uneven: Vec<[f64; 2]> = (0..20).map(|i| [0.001 * f64::from(i), 0.0]).collect();
    uneven.extend([[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    assert!(matches!(fit_closed_spline(&uneven, &params(20)), Err(SplineError::TooSparse { controls: 20 })));
    let coarse = fit_closed_spline(&sample_closed(flower, 100), &params(8));
    assert!(matches!(&coarse, Err(SplineError::NotReached { found }) if found.distance > 1e-3), "{coarse:?}");
}

/// The cubic of four Bezier points.
fn cubic(piece: &[[f64; 2]; 4], t: f64) -> [f64; 2] {
    let u = 1.0 - t;
    let weights = [u * u * u, 3.0 * u * u * t, 3.0 * u * t * t, t * t * t];
    [0, 1].map(|k| weights.iter().zip(piece).map(|(weight, point)| weight * point[k]).sum())
}

#[test]
fn bezier_pieces_are_the_spline_and_close() {
    let control = vec![[0.0, 0.0], [3.0, 1.0], [2.0, 4.0], [-1.0, 3.0], [-2.0, 0.5]];
    let spline = ClosedSpline::new(control.clone()).unwrap();
    let farthest = |pieces: &[[[f64; 2]; 4]]| {
        let away = |i: usize| {
            let (piece, t) = (i / 8, (i % 8) as f64 / 8.0);
            let ([x, y], [a, b]) = (cubic(&pieces[piece], t), spline.at((piece as f64 + t) / 5.0)[0]);
            (x - a).hypot(y - b)
        };
        (0..40).map(away).fold(0.0, f64::max)
    };
    let pieces = spline.bezier_pieces();
    assert!(pieces.len() == 5 && farthest(&pieces) < 1e-14, "{:e}", farthest(&pieces));
    assert!((0..5).all(|i| pieces[i][3] == pieces[(i + 1) % 5][0]), "pieces join bit for bit");
    // The control: points of the spline with its control points between, as a careless drawing has it.
    let careless: Vec<_> =
        (0..5).map(|i| [pieces[i][0], control[(i + 1) % 5], control[(i + 2) % 5], pieces[i][3]]).collect();
    assert!(farthest(&careless) > 0.1);
}
