//! Simple paths stay simple, also where straight ones do not.

use std::f64::consts::{PI, TAU};

use super::*;
use crate::shape::{LinearPath, check_simple, first_not_simple};

type Ring = Vec<Point2>;

/// So many steps from time 0 to 1.
const STEPS: usize = 64;

/// Numbers between 0 and 1, always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() * end as f64) as usize
    }
}

/// Points on rays at even angles, begun at ray `first`.
fn polar(count: usize, first: usize, mut radius: impl FnMut(usize) -> f64) -> Ring {
    let point = |i: usize| {
        let (r, angle) = (radius(i), TAU * ((i + first) % count) as f64 / count as f64);
        [r * angle.cos(), r * angle.sin()]
    };
    (0..count).map(point).collect()
}

/// A band that winds `turns` times: its outer side inwards, then its inner side outwards.
fn spiral(count: usize, turns: f64) -> Ring {
    let side = |i: usize, shift: f64| {
        let part = i as f64 / (count - 1) as f64;
        let (r, angle) = (0.2 + (1.0 - part) * turns + shift, -TAU * turns * part);
        [r * angle.cos(), r * angle.sin()]
    };
    let ring: Ring = (0..count).map(|i| side(i, -0.2)).chain((0..count).rev().map(|i| side(i, 0.2))).collect();
    ring
}

/// The mirror image; sides change places, so that it runs the same way round.
fn mirrored(ring: &Ring) -> Ring {
    ring.iter().rev().map(|p| [p[0], -p[1]]).collect()
}

/// A comb of so many teeth.
fn comb(teeth: usize) -> Ring {
    let top = (0..teeth).rev().flat_map(|i| {
        let x = 2.0 * i as f64;
        [[x + 1.0, 1.0], [x + 1.0, 9.0], [x, 9.0], [x, 1.0]]
    });
    [[0.0, 0.0], [2.0 * teeth as f64 - 1.0, 0.0]].into_iter().chain(top).collect()
}

fn pair(source: Ring, target: Ring) -> DomainPair {
    DomainPair::new(vec![source], vec![target]).unwrap()
}

/// Checks that all shapes are simple; whether those of the straight path are, too.
fn check(pair: &DomainPair) -> bool {
    let path = SimplePath::between(pair).unwrap();
    assert_eq!(first_not_simple(&path, STEPS).unwrap(), None);
    let near = [(1e-9, &pair.source), (1.0 - 1e-9, &pair.target)];
    for (t, end) in near {
        let shape = path.at(t).unwrap();
        let apart = shape.iter().flatten().zip(end.vertices()).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
        let most = apart.fold(0.0, f64::max);
        assert!(most < 1e-5 * end.diagonal(), "at time {t} a vertex is {most:e} from its end");
    }
    first_not_simple(&LinearPath::between(pair).unwrap(), STEPS).unwrap().is_none()
}

#[test]
fn random_stars_stay_simple() {
    let mut random = Random(7);
    let (mut straight, mut crossed) = (0, 0);
    for _ in 0..24 {
        let count = 5 + random.below(36);
        let first = random.below(count);
        let source = polar(count, 0, |_| 0.15 + random.next());
        let target = polar(count, first, |_| 0.15 + random.next());
        if check(&pair(source, target)) { straight += 1 } else { crossed += 1 }
    }
    assert!(crossed > 10, "straight paths must cross for the test to say anything: {straight} {crossed}");
}

#[test]
fn a_spiral_becomes_its_mirror_image() {
    for turns in [1.0, 2.0, 3.0] {
        let band = spiral(20 * turns as usize, turns);
        let is_straight = check(&pair(band.clone(), mirrored(&band)));
        assert!(!is_straight, "the straight path must cross");
    }
}

#[test]
fn combs_become_round_and_shift() {
    let teeth = comb(8);
    let count = teeth.len();
    check(&pair(teeth.clone(), polar(count, 3 * count / 4, |_| 1.0)));
    let shifted: Ring = (0..count).map(|i| teeth[(i + 9) % count]).collect();
    assert!(!check(&pair(teeth.clone(), shifted)));
    assert!(!check(&pair(teeth, spiral(17, 2.0))));
}

#[test]
fn rings_with_a_hole_stay_rings() {
    let outer = |first| polar(12, first, |i| if i % 2 == 0 { 4.0 } else { 2.5 });
    let inner = |first: usize, shift: f64| -> Ring {
        polar(9, first, |_| 1.0).into_iter().rev().map(|p| [p[0] + shift, 0.5 * p[1]]).collect()
    };
    let pair = DomainPair::new(vec![outer(0), inner(0, -1.0)], vec![outer(3), inner(2, 1.2)]).unwrap();
    check(&pair);
    let two = vec![outer(0), inner(0, -1.3), inner(0, 1.3)];
    let pair = DomainPair::new(two.clone(), two).unwrap();
    assert_eq!(SimplePath::between(&pair).err(), Some(ShapeError::TooManyHoles { count: 2 }));
}

#[test]
fn ends_are_stored_and_place_and_size_do_not_matter() {
    let (source, target) = (comb(3), spiral(7, 1.2));
    let plain = SimplePath::between(&pair(source.clone(), target.clone())).unwrap();
    assert_eq!(plain.at(0.0).unwrap(), std::slice::from_ref(&source));
    assert_eq!(plain.at(1.0).unwrap(), std::slice::from_ref(&target));
    for t in [-1e-300, 1.0 + f64::EPSILON, f64::NAN] {
        assert!(matches!(plain.at(t), Err(ShapeError::OutsideTime { .. })));
    }
    let moved: Ring = target.iter().map(|p| [64.0 * p[0] + 7.0, 64.0 * p[1] - 3.0]).collect();
    let far = SimplePath::between(&pair(source, moved)).unwrap();
    let (a, b) = (plain.at(0.3).unwrap().remove(0), far.at(0.3).unwrap().remove(0));
    let ratio = |i: usize, j: usize| (b[i][0] - b[j][0]) / (a[i][0] - a[j][0]);
    assert!((ratio(0, 1) / ratio(2, 9) - 1.0).abs() < 1e-9);
}

#[test]
fn drawings_tile_the_frame_at_all_times() {
    let path = SimplePath::between(&pair(comb(4), mirrored(&spiral(9, 1.5)))).unwrap();
    for t in [0.0, 0.01, 0.5, 1.0] {
        let drawing = path.drawing(t).unwrap();
        let area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| drawing[corner as usize]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        };
        let frame = (drawing[2][0] - drawing[0][0]) * (drawing[2][1] - drawing[0][1]);
        let sum: f64 = path.triangles().iter().map(area).sum();
        assert!((sum / frame - 1.0).abs() < 1e-12);
    }
    // Every vertex but those of the frame has triangles all round it.
    let vertices = path.drawing(0.5).unwrap().len();
    assert_eq!(path.triangles().len(), 2 * (vertices - FRAME) + FRAME - 2);
}

#[test]
fn weights_that_are_not_positive_are_found_out() {
    let band = spiral(20, 1.0);
    let mut path = SimplePath::between(&pair(band.clone(), mirrored(&band))).unwrap();
    assert!(path.drawing(0.5).is_ok());
    path.combinations.reverse_first_weights();
    assert!(matches!(path.drawing(0.5), Err(ShapeError::TurnedOver { .. })), "the control must fail");
}

#[test]
fn shapes_of_any_size_are_taken() {
    for scale in [1e-60, 1e60] {
        let scaled = |ring: Ring| -> Ring { ring.into_iter().map(|p| p.map(|x| x * scale)).collect() };
        let pair = pair(scaled(comb(3)), scaled(polar(14, 10, |i| 1.0 + 0.5 * (PI * i as f64).cos())));
        assert_eq!(first_not_simple(&SimplePath::between(&pair).unwrap(), 8).unwrap(), None);
    }
    assert!(check_simple(&[comb(3)]).is_ok());
}

#[test]
fn sides_with_vertices_in_a_line_are_taken() {
    // A turned square with 16 vertices on each side: nearly in a line, to the right or to the left by rounding.
    let side = |i: usize| [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]][i / 16 % 4];
    for angle in [0.0_f64, 0.3, 1.1] {
        let (sine, cosine) = angle.sin_cos();
        let point = |i: usize| {
            let [x, y] = [0, 1].map(|axis| mix((i % 16) as f64 / 16.0, side(i)[axis], side(i + 16)[axis]));
            [cosine * x - sine * y, sine * x + cosine * y]
        };
        check(&pair((0..64).map(point).collect(), polar(64, 40, |_| 1.0)));
    }
}
