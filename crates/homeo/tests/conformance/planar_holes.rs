//! Composite harmonic maps of domains with several holes: the laws of all maps, and what seams must do.

use std::f64::consts::TAU;

use homeo::construct::harmonic::{HarmonicError, HarmonicParams, MiddleShape, harmonic_map};
use homeo::map::{CircuitSide, Distortion, Half, HarmonicMap, PlanarBijection, SHARE_BITS};
use homeo::progress::Silent;
use homeo_core::number::Rational;
use homeo_core::planar::{DomainPair, PlanarDomain, Point2};
use homeo_verify::{Verdict, verify_bytes};

use crate::planar::{Rings, build, bytes_of, check, exact, pair, round, square};

/// A hole with so many corners, clockwise.
fn hole(n: usize, [x, y]: Point2, radius: f64, turn: f64) -> Vec<Point2> {
    round(n, |_| radius, turn).into_iter().rev().map(|[dx, dy]| [x + dx, y + dy]).collect()
}

fn square_with(holes: impl IntoIterator<Item = Vec<Point2>>) -> Rings {
    square().into_iter().chain(holes).collect()
}

/// A map with few triangles.
pub fn small_file() -> Vec<u8> {
    let rings = |turn: f64| square_with([hole(3, [0.3, 0.5], 0.15, 0.0), hole(3, [0.7, 0.5], 0.15, turn)]);
    let params = HarmonicParams { triangles: 4, ..HarmonicParams::default() };
    bytes_of(&harmonic_map(&pair(rings(0.0), rings(1.0)), params, &Silent).expect("a map"))
}

#[test]
fn two_holes_move_turn_and_change_their_size() {
    let source = square_with([hole(3, [0.3, 0.5], 0.15, 0.0), hole(4, [0.7, 0.5], 0.1, 0.3)]);
    let target = square_with([hole(3, [0.35, 0.3], 0.1, 1.0), hole(4, [0.6, 0.7], 0.2, -0.5)]);
    for middle in [MiddleShape::Regular, MiddleShape::AveragedLengths] {
        check(&pair(source.clone(), target.clone()), None, middle);
    }
}

#[test]
fn three_holes_change_places() {
    let outer = || round(7, |_| 1.0, 0.2);
    let rings = |turn: f64| -> Rings {
        let place = |k: usize| {
            let angle = turn + TAU * k as f64 / 3.0;
            [0.5 * angle.cos(), 0.5 * angle.sin()]
        };
        std::iter::once(outer()).chain((0..3).map(|k| hole(3 + k, place(k), 0.2, turn))).collect()
    };
    check(&pair(rings(0.0), rings(TAU / 3.0)), None, MiddleShape::default());
}

/// Holes so near to one another and to the outer ring that edges of a coarse triangulation span every gap.
#[test]
fn narrow_gaps_are_slit_too() {
    let block = |[x, y]: Point2, [u, v]: Point2| vec![[x, y], [x, v], [u, v], [u, y]];
    let tight = square_with([block([0.002, 0.3], [0.499, 0.7]), block([0.501, 0.3], [0.998, 0.7])]);
    let loose = square_with([block([0.1, 0.1], [0.3, 0.9]), block([0.6, 0.3], [0.9, 0.6])]);
    check(&pair(tight.clone(), loose.clone()), None, MiddleShape::default());
    check(&pair(loose, tight.clone()), None, MiddleShape::default());
    check(&pair(tight.clone(), tight), None, MiddleShape::default());
}

/// Five holes round a triangle and a triangle in a triangle: vertices for seams are scarce.
#[test]
fn triangles_have_vertices_enough_for_all_seams() {
    let outer = || vec![[0.0, 0.0], [1.0, 0.0], [0.5, 0.9]];
    let places = [[0.3, 0.15], [0.5, 0.15], [0.7, 0.15], [0.4, 0.4], [0.6, 0.4], [0.5, 0.65]];
    let rings = |turn: f64| -> Rings {
        std::iter::once(outer()).chain(places.map(|place| hole(3, place, 0.07, turn))).collect()
    };
    check(&pair(rings(0.0), rings(2.0)), None, MiddleShape::default());
}

/// Holes at random places that do not touch, the same number of corners for each number of holes.
fn random_domain(holes: usize, random: &mut impl FnMut() -> f64) -> Rings {
    let mut disks: Vec<(Point2, f64)> = Vec::new();
    while disks.len() < holes {
        let (place, radius) = ([2.0 * random() - 1.0, 2.0 * random() - 1.0], 0.05 + 0.2 * random());
        let is_inside = place[0].hypot(place[1]) + radius < 0.9;
        let is_apart = |&([x, y], other): &(Point2, f64)| (place[0] - x).hypot(place[1] - y) > radius + other + 0.01;
        if is_inside && disks.iter().all(is_apart) {
            disks.push((place, radius));
        }
    }
    let corners = |k: usize| 3 + k % 4;
    let around = disks.iter().enumerate().map(|(k, &(place, radius))| hole(corners(k), place, radius, TAU * random()));
    std::iter::once(round(11, |_| 1.0, 0.0)).chain(around.collect::<Rings>()).collect()
}

#[test]
fn random_domains_with_two_to_six_holes() {
    let mut state = 7u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / 2f64.powi(24)
    };
    for holes in 2..=6 {
        let [source, target] = [0, 1].map(|_| random_domain(holes, &mut random));
        check(&pair(source, target), None, MiddleShape::default());
    }
}

/// Points on one side of a seam, as shares and places, with its ends.
fn along_seam(half: &Half, side: usize, circuit_length: usize) -> Vec<(u32, Point2)> {
    let boundary = &half.parts().boundary;
    let first = boundary.iter().position(|point| point.edge as usize == side).expect("every side has a beginning");
    let inside = boundary[first..].iter().take_while(|point| point.edge as usize == side).count();
    let mut points: Vec<(u32, Point2)> =
        (first..first + inside).map(|row| (boundary[row].share, half.position(row as u32))).collect();
    let end = boundary.iter().position(|point| point.edge as usize == (side + 1) % circuit_length).expect("the next");
    points.push((1 << SHARE_BITS, half.position(end as u32)));
    points
}

/// The point of a share on a broken line.
fn at(line: &[(u32, Point2)], share: u32) -> [Rational; 2] {
    let link = line.windows(2).find(|link| link[0].0 <= share && share <= link[1].0).expect("shares reach to the end");
    let [(s, p), (t, q)] = [link[0], link[1]];
    let (p, q) = (exact(p), exact(q));
    let part = &Rational::from(i64::from(share - s)) / &Rational::from(i64::from(t - s));
    [0, 1].map(|axis| &p[axis] + &(&part * &(&q[axis] - &p[axis])))
}

/// Exactly, and on both sides of it alike.
#[test]
fn seams_go_to_seams() {
    let source = square_with([hole(3, [0.3, 0.5], 0.15, 0.0), hole(4, [0.7, 0.5], 0.1, 0.3)]);
    let target = square_with([hole(3, [0.7, 0.3], 0.1, 1.0), hole(4, [0.3, 0.7], 0.2, -0.5)]);
    let map = build(&pair(source, target), None, MiddleShape::default());
    let circuit = map.middle().circuit().expect("two holes are slit open");
    assert_eq!(circuit.seams().len(), 2);
    let (mut tried, length) = (0, circuit.sides().len());
    for side in (0..length).filter(|&side| matches!(circuit.sides()[side], CircuitSide::Seam { .. })) {
        let [here, there] = [map.source_half(), map.target_half()].map(|half| along_seam(half, side, length));
        for &(share, point) in &here {
            assert_eq!(map.forward_exact(&exact(point)), Ok(at(&there, share)), "side {side}, share {share}");
            tried += 1;
        }
        for &(share, point) in &there {
            assert_eq!(map.inverse_exact(&exact(point)), Ok(at(&here, share)), "side {side}, share {share}");
            tried += 1;
        }
    }
    assert!(tried > 40, "{tried} points of seams");
}

/// Next to a seam, on both sides of it, images are next to each other: the map does not tear there.
#[test]
fn nothing_tears_at_a_seam() {
    let source = square_with([hole(3, [0.3, 0.5], 0.15, 0.0), hole(4, [0.7, 0.5], 0.1, 0.3)]);
    let target = square_with([hole(3, [0.5, 0.2], 0.1, 1.0), hole(4, [0.4, 0.7], 0.2, -0.5)]);
    let map = build(&pair(source, target), None, MiddleShape::default());
    let circuit = map.middle().circuit().expect("two holes are slit open");
    let is_forward = |side: &CircuitSide| matches!(side, CircuitSide::Seam { is_back: false, .. });
    let length = circuit.sides().len();
    let mut tried = 0;
    for side in (0..length).filter(|&side| is_forward(&circuit.sides()[side])) {
        for link in along_seam(map.source_half(), side, length).windows(2) {
            let ([ax, ay], [bx, by]) = (link[0].1, link[1].1);
            let beside = |step: f64| [0.5 * (ax + bx) - step * (by - ay), 0.5 * (ay + by) + step * (bx - ax)];
            let images = [-1e-9, 1e-9].map(|step| map.forward(beside(step)).expect("inside").point);
            let parted = (images[1][0] - images[0][0]).hypot(images[1][1] - images[0][1]);
            assert!(parted < 1e-6, "the sides of the seam at {:?} go {parted} apart", beside(0.0));
            tried += 1;
        }
    }
    assert!(tried > 10, "{tried} links of seams");
}

#[test]
fn optimized_middles_distort_less_with_holes_too() {
    let source = square_with([hole(3, [0.3, 0.5], 0.15, 0.0), hole(4, [0.7, 0.5], 0.1, 0.3)]);
    let target = square_with([hole(3, [0.35, 0.3], 0.1, 0.3), hole(4, [0.6, 0.7], 0.2, 0.0)]);
    let pair = pair(source, target);
    let kind = Distortion::Conformal;
    let with = |middle| build(&pair, None, middle);
    let (averaged, optimized) = (with(MiddleShape::AveragedLengths), with(MiddleShape::Optimized(kind)));
    let [before, after] = [&averaged, &optimized].map(|map: &HarmonicMap| map.distortion(kind).mean);
    assert!(after < 0.999 * before, "{after} {before}");
    assert!(matches!(verify_bytes(&bytes_of(&optimized)), Ok(Verdict::Certified(_))));
}

/// By how much a hole turns is asked for one hole only.
#[test]
fn turns_of_several_holes_are_refused() {
    let rings = square_with([hole(3, [0.3, 0.5], 0.1, 0.0), hole(3, [0.7, 0.5], 0.1, 0.0)]);
    let pair: DomainPair = pair(rings.clone(), rings);
    let asked = HarmonicParams { turn_degrees: Some(360.0), ..HarmonicParams::default() };
    assert_eq!(harmonic_map(&pair, asked, &Silent).err(), Some(HarmonicError::TurnOfSeveralHoles(2)));
}

/// The size of coordinates does not matter.
#[test]
fn sizes_do_no_harm() {
    let rings = square_with([hole(3, [0.3, 0.5], 0.1, 0.0), hole(3, [0.7, 0.5], 0.1, 0.5)]);
    for scale in [1e-80, 1e80] {
        let scaled: Rings = rings.iter().map(|r| r.iter().map(|p| p.map(|x| x * scale)).collect()).collect();
        assert!(PlanarDomain::new(scaled.clone()).is_ok());
        let map = build(&pair(rings.clone(), scaled), None, MiddleShape::default());
        assert!(matches!(verify_bytes(&bytes_of(&map)), Ok(Verdict::Certified(_))), "{scale:e}");
    }
}
