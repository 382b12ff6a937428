//! Laws of the paths, with controls that must fail.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use homeo_core::planar::DomainError;

use super::closing::{closing_lengths, closing_turns};
use super::ring::Measures;
use super::*;

type Ring = Vec<[f64; 2]>;

const TIMES: [f64; 7] = [1e-3, 0.1, 0.25, 0.5, 0.7, 0.9, 0.999];

/// A ring turned, scaled and moved.
fn similar(ring: &Ring, angle: f64, scale: f64, shift: [f64; 2]) -> Ring {
    let (sine, cosine) = angle.sin_cos();
    let (c, s) = (scale * cosine, scale * sine);
    ring.iter().map(|p| [c * p[0] - s * p[1] + shift[0], s * p[0] + c * p[1] + shift[1]]).collect()
}

fn farthest(a: &Ring, b: &Ring) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}

fn square() -> Ring {
    vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
}

/// Points on rays at even angles.
fn polar(count: usize, radius: impl Fn(f64) -> f64) -> Ring {
    sample_closed(|u| [radius(u) * (TAU * u).cos(), radius(u) * (TAU * u).sin()], count)
}

fn star(tips: usize) -> Ring {
    (0..2 * tips)
        .map(|i| {
            let (radius, angle) = (if i % 2 == 0 { 2.0 } else { 0.6 }, PI * i as f64 / tips as f64);
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect()
}

/// A crooked ring that is convex nowhere in particular.
fn crooked() -> Ring {
    vec![[0.0, 0.0], [2.0, -0.5], [4.0, 0.3], [2.5, 0.8], [3.0, 3.0], [1.5, 1.2], [0.2, 2.5]]
}

fn other() -> Ring {
    vec![[0.0, 0.0], [1.0, 0.4], [3.0, -0.6], [3.5, 2.0], [2.0, 1.1], [1.0, 3.0], [-0.5, 1.0]]
}

fn ellipse(count: usize, [a, b]: [f64; 2], turned: f64) -> Ring {
    similar(&sample_closed(|u| [a * (TAU * u).cos(), b * (TAU * u).sin()], count), turned, 1.0, [0.0; 2])
}

fn bits(rings: &[Ring]) -> Vec<[u64; 2]> {
    rings.iter().flatten().map(|p| p.map(f64::to_bits)).collect()
}

/// The only ring at a time.
fn one(path: &dyn ShapePath, t: f64) -> Ring {
    path.at(t).unwrap().remove(0)
}

#[test]
fn ends_are_the_stored_shapes_bit_for_bit() {
    let source: Ring = crooked().iter().map(|p| p.map(|x| x / 3.0 - 0.1)).chain([[-0.0, 0.05]]).collect();
    let target = other().into_iter().chain([[-0.1, 0.1]]).collect::<Ring>();
    let paths: [Box<dyn ShapePath>; 3] = [
        Box::new(LinearPath::new(vec![source.clone()], vec![target.clone()]).unwrap()),
        Box::new(LengthsAndAngles::new(source.clone(), target.clone()).unwrap()),
        Box::new(CurvatureBlend::new(source.clone(), target.clone()).unwrap()),
    ];
    for path in &paths {
        assert_eq!(bits(&path.at(0.0).unwrap()), bits(std::slice::from_ref(&source)));
        assert_eq!(bits(&path.at(1.0).unwrap()), bits(std::slice::from_ref(&target)));
        for t in [-1e-300, 1.0 + f64::EPSILON, f64::NAN] {
            assert!(matches!(path.at(t), Err(ShapeError::OutsideTime { .. })));
        }
    }
    // And they are limits of the shapes between.
    for path in &paths[..2] {
        assert!(farthest(&one(path.as_ref(), 1e-12), &source) < 1e-11);
        assert!(farthest(&one(path.as_ref(), 1.0 - 1e-12), &target) < 1e-11);
    }
}

#[test]
fn a_square_turned_by_a_right_angle_keeps_its_size_by_angles_but_shrinks_by_places() {
    let turned = similar(&square(), FRAC_PI_2, 1.0, [0.0; 2]);
    let rigid = LengthsAndAngles::new(square(), turned.clone()).unwrap();
    let linear = LinearPath::new(vec![square()], vec![turned]).unwrap();
    for t in TIMES {
        let expected = similar(&square(), t * FRAC_PI_2, 1.0, [0.0; 2]);
        assert!(farthest(&one(&rigid, t), &expected) < 1e-14);
    }
    let side = Measures::new(&one(&linear, 0.5)).unwrap().perimeter / 4.0;
    assert!((side - 2f64.sqrt()).abs() < 1e-15);
}

#[test]
fn the_shorter_way_round_is_taken() {
    for degrees in [170.0, -170.0, 190.0_f64, 350.0, 10.0] {
        let angle = degrees.to_radians();
        let short = if angle > PI { angle - TAU } else { angle };
        let path = LengthsAndAngles::new(crooked(), similar(&crooked(), angle, 1.0, [0.0; 2])).unwrap();
        let expected = Measures::new(&similar(&crooked(), 0.5 * short, 1.0, [0.0; 2])).unwrap();
        let found = Measures::new(&one(&path, 0.5)).unwrap();
        assert!((found.directions[0] - expected.directions[0]).abs() < 1e-12, "{degrees}");
    }
}

#[test]
fn copies_are_reproduced_on_the_way() {
    let centroid = Measures::new(&crooked()).unwrap().centroid;
    let centred = similar(&crooked(), 0.0, 1.0, centroid.map(|x| -x));
    let target = similar(&centred, 2.5, 3.0, [10.0, -4.0]);
    let path = LengthsAndAngles::new(centred.clone(), target).unwrap();
    for t in TIMES {
        let expected = similar(&centred, 2.5 * t, 1.0 + 2.0 * t, [10.0 * t, -4.0 * t]);
        assert!(farthest(&one(&path, t), &expected) < 1e-13);
    }
}

/// How far shapes on the way to a target are from being similar to those on the way to a similar target.
fn similarity_defect(path: impl Fn(Ring, Ring) -> Box<dyn ShapePath>, angle: f64, scale: f64, shift: [f64; 2]) -> f64 {
    let plain = path(crooked(), other());
    let moved = path(crooked(), similar(&other(), angle, scale, shift));
    let shape = |path: &dyn ShapePath, t: f64| Measures::new(&one(path, t)).unwrap();
    let mut worst = 0.0_f64;
    for t in TIMES {
        let (a, b) = (shape(plain.as_ref(), t), shape(moved.as_ref(), t));
        for i in 0..a.turns.len() {
            worst = worst.max((a.turns[i] - b.turns[i]).abs()).max((a.lengths[i] - b.lengths[i]).abs());
        }
        let direction = a.directions[0] + t * angle - b.directions[0];
        worst = worst.max((direction - TAU * (direction / TAU).round()).abs());
        let place = [0, 1].map(|k| b.centroid[k] - b_centroid(t, angle, scale, shift)[k]);
        worst = worst.max(place[0].hypot(place[1]) / scale.max(1.0));
    }
    worst
}

/// Where the centroid must be on the way to a similar target.
fn b_centroid(t: f64, angle: f64, scale: f64, shift: [f64; 2]) -> [f64; 2] {
    let there = Measures::new(&similar(&other(), angle, scale, shift)).unwrap().centroid;
    let here = Measures::new(&crooked()).unwrap().centroid;
    [0, 1].map(|k| mix(t, here[k], there[k]))
}

#[test]
fn shapes_do_not_depend_on_place_direction_and_size_of_the_target() {
    let angles = |a: Ring, b: Ring| Box::new(LengthsAndAngles::new(a, b).unwrap()) as Box<dyn ShapePath>;
    let curvature = |a: Ring, b: Ring| Box::new(CurvatureBlend::new(a, b).unwrap()) as Box<dyn ShapePath>;
    let linear = |a: Ring, b: Ring| Box::new(LinearPath::new(vec![a], vec![b]).unwrap()) as Box<dyn ShapePath>;
    for (angle, scale, shift) in
        [(0.0, 1.0, [7.0, -3.0]), (0.8, 1.0, [0.0; 2]), (0.0, 5.0, [0.0; 2]), (-1.1, 0.3, [2.0; 2])]
    {
        assert!(similarity_defect(angles, angle, scale, shift) < 1e-12);
        let defect = similarity_defect(curvature, angle, scale, shift);
        assert!(defect < 1e-9, "{defect:e} {angle} {scale} {shift:?}");
    }
    assert!(similarity_defect(linear, 0.8, 1.0, [0.0; 2]) > 0.01);
}

#[test]
fn turning_angles_move_evenly_and_rings_close() {
    let pairs =
        [(crooked(), other()), (star(7), polar(14, |_| 1.0)), (other(), similar(&crooked(), 2.0, 9.0, [1.0; 2]))];
    for (source, target) in pairs {
        let path = LengthsAndAngles::new(source.clone(), target.clone()).unwrap();
        let (a, b) = (Measures::new(&source).unwrap(), Measures::new(&target).unwrap());
        for t in TIMES {
            let shape = Measures::new(&one(&path, t)).unwrap();
            for i in 0..source.len() {
                // An open ring shows in the turns at the ends of the last edge.
                assert!((shape.turns[i] - mix(t, a.turns[i], b.turns[i])).abs() < 1e-12);
            }
            assert!((shape.perimeter / mix(t, a.perimeter, b.perimeter) - 1.0).abs() < 1e-13);
        }
    }
}

#[test]
fn corrections_of_lengths_are_least() {
    let units: Ring = [0.1, 0.9, 2.0, 3.0, 4.4, 5.5].iter().map(|a: &f64| [a.cos(), a.sin()]).collect();
    let cost = |m: &[f64], l: &[f64], w: &[f64]| (0..6).map(|i| ((m[i] - l[i]) / w[i]).powi(2)).sum::<f64>();
    // The second needs the bound: a plain least correction is negative.
    for lengths in [[1.0, 1.2, 0.8, 1.1, 0.9, 1.0], [0.01, 0.02, 3.0, 3.0, 0.02, 0.01]] {
        let weights = [1.0, 0.5, 2.0, 1.0, 1.0, 0.7];
        let found = closing_lengths(&lengths, &weights, &units).unwrap();
        let gap = |m: &[f64]| [0, 1].map(|k| (0..6).map(|i| m[i] * units[i][k]).sum::<f64>());
        assert!(gap(&found).iter().all(|x| x.abs() < 1e-12));
        assert!((0..6).all(|i| found[i] >= 0.1 * lengths[i]));
        let is_bound = (0..6).any(|i| found[i] == 0.1 * lengths[i]);
        assert_eq!(is_bound, lengths[0] < 0.1);
        // Three neighbours can change by the areas of their unit vectors, and nothing closed is cheaper.
        let cross = |i: usize, j: usize| units[i][0] * units[j][1] - units[i][1] * units[j][0];
        for (i, j, k) in [(0, 1, 2), (1, 2, 3), (2, 3, 4), (3, 4, 5), (0, 2, 4), (1, 3, 5)] {
            for part in [-1e-3, 1e-3] {
                let mut near = found.clone();
                near[i] += part * cross(j, k);
                near[j] += part * cross(k, i);
                near[k] += part * cross(i, j);
                assert!(gap(&near).iter().all(|x| x.abs() < 1e-12));
                let is_allowed = (0..6).all(|i| near[i] >= 0.1 * lengths[i]);
                assert!(!is_allowed || cost(&near, &lengths, &weights) > cost(&found, &lengths, &weights));
            }
        }
    }
    // Directions in a half plane close with no lengths.
    let half: Ring = [0.1, 0.9, 2.0].iter().map(|a: &f64| [a.cos(), a.sin()]).collect();
    assert!(closing_lengths(&[1.0; 3], &[1.0; 3], &half).is_err());
}

#[test]
fn corrections_of_turns_close_and_are_stationary() {
    let n = 60;
    let (lengths, weights) = (vec![1.0 / n as f64; n], vec![1.0 / n as f64; n]);
    let wanted: Vec<f64> =
        (0..n).map(|i| (TAU + 5.0 * (TAU * i as f64 / n as f64 + 0.3).cos() + 1.0) / n as f64).collect();
    let found = closing_turns(&wanted, &weights, &lengths, 1.0).unwrap();
    let ring = |turns: &[f64]| {
        let (mut direction, mut here, mut places) = (0.0_f64, [0.0; 2], Vec::new());
        for turn in turns {
            direction += turn;
            places.push(here);
            here = [here[0] + direction.cos() / n as f64, here[1] + direction.sin() / n as f64];
        }
        (places, here, direction)
    };
    let (places, end, direction) = ring(&found);
    assert!(end[0].hypot(end[1]) < 1e-12 && (direction - TAU).abs() < 1e-12);
    assert!(ring(&wanted).1.iter().any(|x| x.abs() > 0.1));
    // At a stationary point the change of curvature is linear in the place.
    let change: Vec<f64> = (0..n).map(|i| (found[i] - wanted[i]) / weights[i]).collect();
    let basis = |i: usize| [1.0, places[i][0], places[i][1]];
    let mut rest = change.clone();
    let mut base: Vec<Vec<f64>> = Vec::new();
    for k in 0..3 {
        let mut row: Vec<f64> = (0..n).map(|i| basis(i)[k]).collect();
        for earlier in &base {
            let part: f64 = row.iter().zip(earlier).map(|(x, y)| x * y).sum();
            row.iter_mut().zip(earlier).for_each(|(x, y)| *x -= part * y);
        }
        let size = row.iter().map(|x| x * x).sum::<f64>().sqrt();
        row.iter_mut().for_each(|x| *x /= size);
        let part: f64 = rest.iter().zip(&row).map(|(x, y)| x * y).sum();
        rest.iter_mut().zip(&row).for_each(|(x, y)| *x -= part * y);
        base.push(row);
    }
    let worst = |x: &[f64]| x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(worst(&change) > 0.1 && worst(&rest) < 1e-8, "{} {}", worst(&change), worst(&rest));
}

#[test]
fn a_star_becomes_a_circle_and_stays_simple() {
    let path = LengthsAndAngles::new(star(7), similar(&polar(14, |_| 1.0), 1.0, 2.0, [3.0, 0.0])).unwrap();
    assert_eq!(first_not_simple(&path, 64), Ok(None));
    let curves = CurvatureBlend::new(polar(300, |u| 1.0 + 0.5 * (7.0 * TAU * u).cos()), polar(200, |_| 1.0)).unwrap();
    assert_eq!(first_not_simple(&curves, 16), Ok(None));
}

#[test]
fn a_path_through_a_point_is_not_simple() {
    let half_turn = square().iter().map(|p| p.map(|x| -x)).collect();
    let path = LinearPath::new(vec![square()], vec![half_turn]).unwrap();
    let found = first_not_simple(&path, 4).unwrap().unwrap();
    assert_eq!(found.t, 0.5);
    let clockwise: Ring = square().into_iter().rev().collect();
    assert!(matches!(check_simple(&[clockwise]), Err(DomainError::WrongWay { .. })));
    assert!(check_simple(&[square()]).is_ok());
}

/// The error of the curvature of a sampled curve, in the mean; `first` and `second` derivatives are given.
fn curvature_error(
    count: usize,
    curve: fn(f64) -> [f64; 2],
    first: fn(f64) -> [f64; 2],
    second: fn(f64) -> [f64; 2],
) -> f64 {
    let fine = 32_768;
    let speed = |u: f64| first(u)[0].hypot(first(u)[1]);
    // Midpoints on a closed curve: as good as exact.
    let length = (0..fine).map(|i| speed((i as f64 + 0.5) / fine as f64)).sum::<f64>() / fine as f64;
    let profile = CurvatureProfile::new(&sample_closed(curve, count)).unwrap();
    let (mut arc, mut sum) = (0.0, 0.0);
    for i in 0..fine {
        let u = (i as f64 + 0.5) / fine as f64;
        let part = speed(u) / fine as f64 / length;
        let ([x, y], [xx, yy]) = (first(u), second(u));
        let exact = (x * yy - y * xx) / speed(u).powi(3) * length;
        sum += part * (profile.at(arc + 0.5 * part) - exact).powi(2);
        arc += part;
    }
    sum.sqrt()
}

#[test]
fn curvature_converges_with_order_two() {
    let on_ellipse = |count| {
        curvature_error(
            count,
            |u| [2.0 * (TAU * u).cos(), (TAU * u).sin()],
            |u| [-2.0 * TAU * (TAU * u).sin(), TAU * (TAU * u).cos()],
            |u| [-2.0 * TAU * TAU * (TAU * u).cos(), -TAU * TAU * (TAU * u).sin()],
        )
    };
    let on_bean = |count| {
        curvature_error(
            count,
            |u| [(TAU * u).cos() + 0.3 * (2.0 * TAU * u).cos(), (TAU * u).sin()],
            |u| [-TAU * (TAU * u).sin() - 0.6 * TAU * (2.0 * TAU * u).sin(), TAU * (TAU * u).cos()],
            |u| [-TAU * TAU * ((TAU * u).cos() + 1.2 * (2.0 * TAU * u).cos()), -TAU * TAU * (TAU * u).sin()],
        )
    };
    for errors in [[100, 200, 400, 800].map(on_ellipse), [100, 200, 400, 800].map(on_bean)] {
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((1.8..2.2).contains(&order), "{order} {errors:?}");
        }
    }
}

/// Laws of a blend, and its greatest correction.
fn blend_laws(path: &CurvatureBlend) -> f64 {
    let mut most = 0.0_f64;
    for t in TIMES {
        let shape = Measures::new(&one(path, t)).unwrap();
        assert_eq!((shape.turning_number, shape.turns.len()), (1, path.vertex_count()));
        // An open ring shows in the length of the last edge.
        let parts = path.parts_of_length();
        assert!((0..parts.len()).all(|i| (shape.lengths[i] - parts[i]).abs() < 1e-12));
        most = most.max(path.correction(t).unwrap());
    }
    assert_eq!(first_not_simple(path, 10), Ok(None));
    most
}

#[test]
fn ellipses_blend_in_closed_curves() {
    for (here, there) in [(160, 160), (150, 210), (80, 333)] {
        let mut target = ellipse(there, [2.0, 0.7], 1.0);
        target.rotate_left(there / 7);
        let path = CurvatureBlend::new(ellipse(here, [2.0, 1.0], 0.0), target).unwrap();
        // Curvatures of period one half close without a correction, but for sampling.
        assert!(blend_laws(&path) < 0.05);
    }
}

#[test]
fn curves_without_symmetry_blend_in_closed_curves() {
    let bean = |count: usize| {
        sample_closed(
            |u| [(TAU * u).cos() + 0.3 * (2.0 * TAU * u).cos(), (TAU * u).sin() + 0.1 * (3.0 * TAU * u).cos()],
            count,
        )
    };
    for (here, there) in [(160, 160), (200, 300)] {
        let mut target = similar(&bean(there), -2.0, 1.5, [4.0, 1.0]);
        target.rotate_left(there / 3);
        let path = CurvatureBlend::new(bean(here), target).unwrap();
        let most = blend_laws(&path);
        assert!((0.01..1.0).contains(&most), "{most}");
    }
}

#[test]
fn curvature_blends_move_on_from_the_samples() {
    // The same nodes: no jump. Others: a jump of second order.
    let same = CurvatureBlend::new(polar(100, |_| 1.0), polar(100, |_| 3.0)).unwrap();
    assert!(farthest(&one(&same, 1e-12), &polar(100, |_| 1.0)) < 1e-10);
    assert!(farthest(&one(&same, 0.5), &polar(100, |_| 2.0)) < 1e-12);
    let jump = |count: usize| {
        let source = ellipse(count, [2.0, 1.0], 0.0);
        let path = CurvatureBlend::new(source.clone(), ellipse(count + count / 2 + 1, [1.0, 2.0], 0.0)).unwrap();
        let near = one(&path, 1e-12);
        let distance =
            |p: &[f64; 2]| near.iter().map(|q| (p[0] - q[0]).hypot(p[1] - q[1])).fold(f64::INFINITY, f64::min);
        source.iter().map(distance).fold(0.0, f64::max)
    };
    let order = (jump(100) / jump(400)).log2() / 2.0;
    assert!((1.7..2.3).contains(&order), "{order}");
}

#[test]
fn what_is_no_pair_is_refused() {
    let backwards: Ring = square().into_iter().rev().collect();
    let opposite = ShapeError::TurningNumbers { here: 1, there: -1 };
    assert_eq!(LengthsAndAngles::new(square(), backwards.clone()), Err(opposite.clone()));
    assert_eq!(CurvatureBlend::new(square(), backwards.clone()).unwrap_err(), opposite);
    assert!(LengthsAndAngles::new(backwards.clone(), backwards).is_ok());
    let eight = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    assert_eq!(LengthsAndAngles::new(eight.clone(), eight), Err(ShapeError::DoesNotTurn));
    let error = |ring: Ring| LengthsAndAngles::new(ring, square()).unwrap_err();
    assert_eq!(error(crooked()), ShapeError::VertexCounts { ring: 0, here: 7, there: 4 });
    let with = |point| vec![[-1.0, -1.0], [1.0, -1.0], point, [-1.0, 1.0]];
    assert_eq!(error(with([1.0, -1.0])), ShapeError::EdgeOfLengthZero { vertex: 1 });
    assert_eq!(error(with([0.0, -1.0])), ShapeError::TurnsBack { vertex: 1 });
    assert!(matches!(error(with([f64::NAN, 0.0])), ShapeError::OutOfRange { vertex: 2, .. }));
    assert_eq!(CurvatureProfile::new(&square()[..2]), Err(ShapeError::TooFewVertices { count: 2 }));
    let linear = LinearPath::new(vec![square()], vec![]);
    assert_eq!(linear, Err(ShapeError::RingCounts { here: 1, there: 0 }));
}

/// Numbers from 0 to 1, the same on every machine.
fn generator(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The greatest speed of a vertex between times a small step apart.
fn speed(path: &dyn ShapePath, steps: usize, step: f64) -> f64 {
    let at = |i: usize| (i as f64 + 0.5) / steps as f64;
    (0..steps).map(|i| farthest(&one(path, at(i)), &one(path, at(i) + step)) / step).fold(0.0, f64::max)
}

#[test]
fn crooked_pairs_at_random_close_and_do_not_jump() {
    let mut next = generator(7);
    for _ in 0..100 {
        let mut ring = |count: usize| {
            let radii: Vec<f64> = (0..count).map(|_| 0.1 + next()).collect();
            polar(count, |u| radii[(count as f64 * u).round() as usize])
        };
        let source = ring(12);
        assert!(speed(&LengthsAndAngles::new(source.clone(), ring(12)).unwrap(), 40, 1e-4) < 10.0);
        assert!(speed(&CurvatureBlend::new(source, ring(17)).unwrap(), 10, 1e-4) < 10.0);
    }
}

#[test]
fn curves_at_random_close() {
    let mut next = generator(11);
    for size in [0.2, 1.0, 2.0] {
        for _ in 0..30 {
            let mut curve = |count: usize| {
                let terms: Vec<[f64; 2]> = (1..6).map(|k| [0; 2].map(|_| size * (next() - 0.5) / k as f64)).collect();
                let term = |u: f64, k: usize| {
                    let (sine, cosine) = ((k + 1) as f64 * TAU * u).sin_cos();
                    terms[k][0] * cosine + terms[k][1] * sine
                };
                polar(count, |u| (0..5).map(|k| term(u, k)).sum::<f64>().exp())
            };
            let path = CurvatureBlend::new(curve(200), curve(300)).unwrap();
            for t in TIMES {
                assert!(path.correction(t).unwrap() < 2.0);
            }
        }
    }
}

#[test]
fn curves_that_turn_twice_or_not_at_all_blend_too() {
    let eight =
        |count, a: f64| sample_closed(|u| [(TAU * u).sin(), (2.0 * TAU * u).sin() * a + 0.1 * (TAU * u).sin()], count);
    let twice = |count, a: f64| {
        let radius = move |u: f64| 1.0 + a * (TAU * u).cos();
        sample_closed(|u| [radius(u) * (2.0 * TAU * u).cos(), radius(u) * (2.0 * TAU * u).sin()], count)
    };
    for (turns, path) in [
        (0, CurvatureBlend::new(eight(200, 1.0), eight(150, 0.3))),
        (2, CurvatureBlend::new(twice(200, 0.5), twice(150, 0.8))),
    ] {
        assert_eq!(Measures::new(&one(&path.unwrap(), 0.5)).unwrap().turning_number, turns);
    }
}
