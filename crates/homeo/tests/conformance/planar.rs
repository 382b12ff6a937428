//! Maps between planar domains: the same laws for every kind of map and every pair.

use std::f64::consts::TAU;
use std::io::Cursor;

use homeo::certificate::{
    PlanarMap, Provenance, StoredMap, read_map, write_complex, write_composite, write_harmonic, write_planar,
};
use homeo::complex::{ComplexMap, ComplexParams, EdgeSpeeds};
use homeo::composite::{CompositeMap, JacobianLimits, PartitionParams};
use homeo::construct::harmonic::{HarmonicParams, MiddleShape, harmonic_map};
use homeo::map::{Enclosed2, HarmonicMap, PlanarBijection, PlanarEvaluationError};
use homeo::progress::Silent;
use homeo::shape::{LinearPath, TurningPath};
use homeo_core::number::Rational;
use homeo_core::planar::{DomainPair, PlanarDomain, Point2};
use homeo_verify::{SourceMatch, Verdict, compare_polygon, verify_bytes};

use crate::in_threads;

/// Points of each kind of place.
const POINTS: usize = 40;

pub type Rings = Vec<Vec<Point2>>;

pub fn round(n: usize, radius: impl Fn(f64) -> f64, turn: f64) -> Vec<Point2> {
    (0..n)
        .map(|k| {
            let angle = TAU * k as f64 / n as f64;
            let r = radius(angle);
            [r * (angle + turn).cos(), r * (angle + turn).sin()]
        })
        .collect()
}

pub fn square() -> Rings {
    vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]]
}

fn star(spikes: usize, turn: f64) -> Rings {
    let tip = |k: usize| if k.is_multiple_of(2) { 1.0 } else { 0.35 };
    let place = |k: usize| {
        let angle = TAU * k as f64 / (2 * spikes) as f64 + turn;
        [tip(k) * angle.cos(), tip(k) * angle.sin()]
    };
    vec![(0..2 * spikes).map(place).collect()]
}

/// A band that winds in; the inside of a long corridor.
fn spiral() -> Rings {
    let arm = |inner: bool, k: usize| {
        let angle = 2.0 * TAU * k as f64 / 19.0;
        let r = 0.3 + 0.11 * angle - if inner { 0.12 } else { 0.0 };
        [r * angle.cos(), r * angle.sin()]
    };
    let outer = (0..20).map(|k| arm(false, k));
    let back = (0..20).rev().map(|k| arm(true, k));
    vec![outer.chain(back).collect()]
}

/// A triangle with points in the middles of its edges, on straight lines.
fn with_straight_corners() -> Rings {
    vec![vec![[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [2.0, 1.5], [0.0, 3.0], [0.0, 1.5]]]
}

fn ring(turn: f64, centre: Point2) -> Rings {
    let hole = round(6, |_| 0.4, turn).into_iter().rev().map(|[x, y]| [x + centre[0], y + centre[1]]);
    vec![round(9, |_| 1.0, 0.1), hole.collect()]
}

pub fn pair(source: Rings, target: Rings) -> DomainPair {
    DomainPair::new(source, target).expect("a pair")
}

pub fn build(pair: &DomainPair, turn_degrees: Option<f64>, middle: MiddleShape) -> HarmonicMap {
    let params = HarmonicParams { triangles: 300, turn_degrees, middle };
    harmonic_map(pair, params, &Silent).expect("a map")
}

pub fn bytes_of(map: &HarmonicMap) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    write_harmonic(map, &Provenance::default(), &mut bytes).expect("memory can be written");
    bytes.into_inner()
}

/// A map with few triangles, of a polygon or of an annulus.
pub fn small_file(has_hole: bool) -> Vec<u8> {
    let pair = match has_hole {
        true => pair(ring(0.0, [0.0, 0.0]), ring(1.0, [0.1, 0.0])),
        false => pair(square(), star(2, 0.3)),
    };
    let params = HarmonicParams { triangles: 4, ..HarmonicParams::default() };
    bytes_of(&harmonic_map(&pair, params, &Silent).expect("a map"))
}

pub fn exact(point: Point2) -> [Rational; 2] {
    point.map(|x| Rational::from_f64(x).expect("finite"))
}

/// Random points inside, and some on edges, at exact shares.
fn points(domain: &PlanarDomain) -> (Vec<Point2>, Vec<([Point2; 2], Rational)>) {
    let mut state = 3u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / 2f64.powi(24)
    };
    let [low, high] = domain.bounds();
    let mut inside = Vec::new();
    while inside.len() < POINTS {
        let point = [0, 1].map(|axis| low[axis] + random() * (high[axis] - low[axis]));
        if domain.contains(point) {
            inside.push(point);
        }
    }
    let share = |k: usize| Rational::from_parts((k % 7).into(), 7u32.into()).expect("a share");
    (inside, domain.edges().enumerate().map(|(k, edge)| (edge, share(k))).collect())
}

fn along([a, b]: [Point2; 2], share: &Rational) -> [Rational; 2] {
    let (a, b) = (exact(a), exact(b));
    [0, 1].map(|axis| &a[axis] + &(share * &(&b[axis] - &a[axis])))
}

pub fn check(pair: &DomainPair, turn: Option<f64>, middle: MiddleShape) {
    let map = in_threads(1, || build(pair, turn, middle));
    let (inside, on_edges) = points(&pair.source);
    for &point in &inside {
        let there = map.forward_exact(&exact(point)).expect("inside");
        assert_eq!(map.inverse_exact(&there), Ok(exact(point)), "{point:?} comes back");
        let quick = map.forward(point).expect("inside");
        let is_near = |k: usize| (there[k].to_f64() - quick.point[k]).abs() <= quick.radius.next_up();
        assert!(is_near(0) && is_near(1), "{point:?}: {quick:?} is not {there:?}");
    }
    check_any(&map, pair);
    // Edges go to edges, linearly.
    for ((edge, share), goal) in on_edges.iter().zip(pair.target.edges()) {
        assert_eq!(map.forward_exact(&along(*edge, share)), Ok(along(goal, share)), "{edge:?} at {share:?}");
    }
    check_file(&map, pair, || build(pair, turn, middle));
}

/// What every map between planar domains must do.
fn check_any(map: &dyn PlanarBijection, pair: &DomainPair) {
    assert_eq!((map.source(), map.target()), (&pair.source, &pair.target));
    let (inside, on_edges) = points(&pair.source);
    let images = map.forward_batch(&inside);
    for (&point, image) in inside.iter().zip(images) {
        let image = image.expect("inside");
        assert_eq!(map.forward(point), Ok(image), "a batch differs");
        assert!(image.radius < 1e-7, "{image:?}");
        let back = map.inverse(image.point).expect("the image is inside, or next to it");
        assert!(back.radius < 1e-6, "{back:?}");
        assert!((back.point[0] - point[0]).hypot(back.point[1] - point[1]) < 1e-6, "{point:?} -> {back:?}");
    }
    for (&([a, _], _), [goal, _]) in on_edges.iter().zip(pair.target.edges()) {
        assert_eq!(map.forward(a).map(|image| image.point), Ok(goal), "a vertex goes to its vertex");
        assert_eq!(map.inverse(goal).map(|image| image.point), Ok(a), "and back");
    }
    let far = pair.source.diagonal() * 3.0;
    assert_eq!(map.forward([far, far]), Err(PlanarEvaluationError::Outside("source")));
    assert_eq!(map.inverse([far, -far]), Err(PlanarEvaluationError::Outside("target")));
    assert!(map.forward([f64::NAN, 0.0]).is_err());
    check_rows(map, &pair.target);
}

/// Rows of points are the same points one by one, up to rounding.
fn check_rows(map: &dyn PlanarBijection, target: &PlanarDomain) {
    let [low, high] = target.bounds();
    let mut found = 0;
    for row in 1..8 {
        let y = low[1] + (high[1] - low[1]) * f64::from(row) / 8.0;
        let row: Vec<Point2> = (0..60).map(|k| [low[0] + (high[0] - low[0]) * f64::from(k) / 59.0, y]).collect();
        let mut along = vec![None; row.len()];
        map.inverse_along(&row, &mut along);
        for (&point, preimage) in row.iter().zip(along) {
            match (map.inverse(point), preimage) {
                (Ok(one), Some(other)) => {
                    let error = (one.point[0] - other[0]).hypot(one.point[1] - other[1]);
                    assert!(error < 1e-6, "{point:?}: {one:?} is not {other:?}");
                    found += 1;
                }
                // On the boundary rounding decides.
                (Err(_), None) => {}
                (answer, _) => assert!(is_near_boundary(target, point), "{point:?}: {answer:?} or {preimage:?}"),
            }
        }
    }
    assert!(found > 50, "{found} points of rows lie inside");
}

fn is_near_boundary(domain: &PlanarDomain, [x, y]: Point2) -> bool {
    let step = 1e-7 * domain.diagonal();
    let around = [[x - step, y], [x + step, y], [x, y - step], [x, y + step]];
    let inside = around.iter().filter(|&&p| domain.contains(p)).count();
    inside > 0 && inside < 4
}

fn check_file(map: &HarmonicMap, pair: &DomainPair, again: impl FnOnce() -> HarmonicMap + Send) {
    let bytes = bytes_of(map);
    assert!(bytes == bytes_of(&in_threads(2, again)), "the file differs when built again with two threads");
    let Ok(StoredMap::Planar(PlanarMap::Harmonic(read))) = read_map(&bytes) else {
        panic!("what was written can be read")
    };
    assert!(bytes == bytes_of(&read), "the file differs when read and written");
    match verify_bytes(&bytes) {
        Ok(Verdict::Certified(claim)) => assert_eq!(claim.kind, "composite-harmonic"),
        other => panic!("not certified: {other:?}"),
    }
    assert_eq!(compare_polygon(&bytes, pair.source.rings()), Ok(SourceMatch::Same));
    let other = compare_polygon(&bytes, pair.target.rings()).expect("readable");
    assert_eq!(other == SourceMatch::Same, pair.source == pair.target);
}

#[test]
fn a_square_becomes_an_arrow() {
    let arrow = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.3, 0.2], [0.0, 1.0]]];
    for middle in [MiddleShape::Regular, MiddleShape::AveragedLengths] {
        check(&pair(square(), arrow.clone()), None, middle);
    }
}

#[test]
fn a_star_moves_on_by_a_spike() {
    check(&pair(star(5, 0.0), star(5, TAU / 5.0)), None, MiddleShape::default());
}

#[test]
fn a_spiral_unwinds() {
    check(&pair(spiral(), vec![round(40, |_| 1.0, 0.0)]), None, MiddleShape::default());
}

#[test]
fn straight_corners_are_corners() {
    check(&pair(with_straight_corners(), vec![round(6, |_| 2.0, 0.0)]), None, MiddleShape::default());
}

#[test]
fn a_hole_turns_as_asked() {
    let there = pair(ring(0.0, [0.0, 0.0]), ring(1.2, [0.3, -0.2]));
    for turn in [None, Some(400.0), Some(-300.0)] {
        check(&there, turn, MiddleShape::default());
    }
}

/// The angle round the hole grows by the turn that was asked for along a path from the outer ring to the inner one.
#[test]
fn turns_are_those_asked_for() {
    let there = pair(ring(0.0, [0.0, 0.0]), ring(0.5, [0.0, 0.0]));
    for (asked, turned) in [(None, 0.5), (Some(360.0), 0.5 + TAU), (Some(-360.0), 0.5 - TAU)] {
        let map = build(&there, asked, MiddleShape::default());
        let mut angles: Vec<f64> = Vec::new();
        // From near the middle of the first outer edge to near the hole; a whole turn more or less shows.
        let direction = [(TAU / 18.0 + 0.1).cos(), (TAU / 18.0 + 0.1).sin()];
        let steps = 400;
        for k in 0..=steps {
            let r = 0.93 - 0.52 * f64::from(k) / f64::from(steps);
            let Ok(image) = map.forward([r * direction[0], r * direction[1]]) else { continue };
            let angle = image.point[1].atan2(image.point[0]);
            let before = angles.last().copied().unwrap_or(angle);
            angles.push(before + (angle - before + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0);
        }
        let turn = angles[angles.len() - 1] - angles[0];
        assert!((turn - turned).abs() < 1.5, "{asked:?}: turned by {turn}, not by {turned}");
    }
}

#[test]
fn composite_mean_value_maps_obey_the_same_laws() {
    let arrow = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.35, 0.3], [0.0, 1.0]]];
    for pair in [pair(square(), arrow), pair(ring(0.0, [0.0, 0.0]), ring(0.4, [0.1, 0.0]))] {
        let path = LinearPath::between(&pair).expect("a path");
        let (map, info) = CompositeMap::build(&path, &PartitionParams::default(), &Silent).expect("a map");
        assert!(info.least_determinant > 0.0 && info.bounds.iter().all(|&bound| bound > 0.0));
        check_any(&map, &pair);
        check_composite_file(&map, &pair);
    }
}

#[test]
fn complex_maps_obey_the_same_laws() {
    let arrow = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.45, 0.4], [0.0, 1.0]]];
    let rounder = vec![round(10, |angle| 0.9 + 0.1 * (5.0 * angle).cos(), 0.1)];
    let turned = pair(ring(0.0, [0.0, 0.0]), ring(0.3, [0.05, 0.0]));
    for pair in [pair(square(), arrow), pair(vec![round(10, |_| 1.0, 0.0)], rounder), turned] {
        let (map, info) = ComplexMap::build(&pair, &ComplexParams::default(), &Silent).expect("a map");
        assert!(info.least_determinant > 0.0);
        check_any(&map, &pair);
        check_complex_file(&map, &pair);
        let again = || ComplexMap::build(&pair, &ComplexParams::default(), &Silent).expect("a map").0;
        let bytes = [1, 2].map(|threads| complex_bytes(&in_threads(threads, again)));
        assert!(bytes[0] == bytes[1], "the file differs when built with two threads");
    }
}

fn complex_bytes(map: &ComplexMap) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    write_complex(map, &Provenance::default(), &mut bytes).expect("memory can be written");
    bytes.into_inner()
}

/// A complex map of few vertices.
pub fn small_complex_file() -> Vec<u8> {
    let triangle = |x: f64| vec![vec![[0.0, 0.0], [1.0, 0.0], [x, 1.0]]];
    let speeds = EdgeSpeeds::new(2, vec![vec![0.5], vec![0.45], vec![0.55]]).expect("speeds");
    let pair = pair(triangle(0.0), triangle(0.3));
    complex_bytes(&ComplexMap::with_speeds(&pair, speeds, &JacobianLimits::default()).expect("a map"))
}

fn check_complex_file(map: &ComplexMap, pair: &DomainPair) {
    let bytes = complex_bytes(map);
    let Ok(StoredMap::Planar(read)) = read_map(&bytes) else { panic!("what was written can be read") };
    let mut again = Cursor::new(Vec::new());
    write_planar(&read, &Provenance::default(), &mut again).expect("memory can be written");
    assert!(bytes == again.into_inner(), "the file differs when read and written");
    let PlanarMap::Complex(read) = read else { panic!("another kind of map was read") };
    assert_eq!(read.speeds(), map.speeds());
    for point in points(&pair.source).0 {
        assert_eq!(read.forward(point), map.forward(point));
        assert_eq!(read.inverse(point), map.inverse(point));
    }
    match verify_bytes(&bytes) {
        Ok(Verdict::Certified(claim)) => assert_eq!(claim.kind, "complex-barycentric"),
        other => panic!("not certified: {other:?}"),
    }
    assert_eq!(compare_polygon(&bytes, pair.source.rings()), Ok(SourceMatch::Same));
    let other = compare_polygon(&bytes, pair.target.rings()).expect("readable");
    assert_eq!(other == SourceMatch::Same, pair.source == pair.target);
}

/// Read without a proof, a map that folds can be asked; the checker refutes its file.
#[test]
fn a_complex_map_that_folds_is_refuted() {
    let arrow = |corner: f64| vec![vec![[0.0, 0.0], [1.0, 0.0], [corner, corner], [0.0, 1.0]]];
    for (corner, holds) in [(0.8, true), (0.2, false)] {
        let map = ComplexMap::from_speeds(&pair(square(), arrow(corner)), EdgeSpeeds::linear(4)).expect("a map");
        match verify_bytes(&complex_bytes(&map)) {
            Ok(Verdict::Certified(_)) => assert!(holds),
            Ok(Verdict::Refuted(witness)) => assert_eq!((holds, witness.rule), (false, "K3")),
            other => panic!("{corner}: {other:?}"),
        }
    }
}

/// A map whose inverse is off by little.
struct Shifted(ComplexMap);

impl PlanarBijection for Shifted {
    fn source(&self) -> &PlanarDomain {
        self.0.source()
    }

    fn target(&self) -> &PlanarDomain {
        self.0.target()
    }

    fn forward(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        self.0.forward(point)
    }

    fn inverse(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        let Enclosed2 { point: [x, y], radius } = self.0.inverse(point)?;
        Ok(Enclosed2 { point: [x + 1e-5, y], radius })
    }
}

#[test]
#[should_panic(expected = "->")]
fn an_inverse_that_is_off_breaks_the_laws() {
    let pair = pair(square(), vec![vec![[0.0, 0.0], [1.0, 0.0], [0.8, 0.9], [0.0, 1.0]]]);
    let (map, _) = ComplexMap::build(&pair, &ComplexParams::default(), &Silent).expect("a map");
    check_any(&Shifted(map), &pair);
}

/// Several holes are no obstacle to these.
#[test]
fn composite_mean_value_maps_take_several_holes() {
    let hole = |x: f64, turn: f64| -> Vec<Point2> {
        let corner = |k: usize| {
            let angle = turn - TAU * k as f64 / 3.0;
            [x + 0.12 * angle.cos(), 0.5 + 0.12 * angle.sin()]
        };
        (0..3).map(corner).collect()
    };
    let rings = |turn: f64| vec![square()[0].clone(), hole(0.3, turn), hole(0.7, -turn)];
    let pair = pair(rings(0.0), rings(0.5));
    let path = TurningPath::between(&pair, &[]).expect("a path");
    let (map, _) = CompositeMap::build(&path, &PartitionParams::default(), &Silent).expect("a map");
    check_any(&map, &pair);
    check_composite_file(&map, &pair);
}

fn check_composite_file(map: &CompositeMap, pair: &DomainPair) {
    let written = |map: &CompositeMap| {
        let mut bytes = Cursor::new(Vec::new());
        write_composite(map, &Provenance::default(), &mut bytes).expect("memory can be written");
        bytes.into_inner()
    };
    let bytes = written(map);
    let Ok(StoredMap::Planar(PlanarMap::Composite(read))) = read_map(&bytes) else {
        panic!("what was written can be read")
    };
    assert!(bytes == written(&read), "the file differs when read and written");
    let point = points(&pair.source).0[0];
    assert_eq!(PlanarBijection::forward(&read, point), PlanarBijection::forward(map, point));
    match verify_bytes(&bytes) {
        Ok(Verdict::Certified(claim)) => assert_eq!(claim.kind, "composite-mean-value"),
        other => panic!("not certified: {other:?}"),
    }
    assert_eq!(compare_polygon(&bytes, pair.source.rings()), Ok(SourceMatch::Same));
}

/// The size of coordinates does not matter, nor how thin a shape is.
#[test]
fn sizes_and_thin_spikes_do_no_harm() {
    for scale in [1e-80, 1e-30, 1e30, 1e80] {
        let scaled = |rings: Rings| rings.iter().map(|r| r.iter().map(|p| p.map(|x| x * scale)).collect()).collect();
        let pair = pair(scaled(square()), scaled(star(2, 0.3)));
        let map = build(&pair, None, MiddleShape::default());
        let point = exact([0.25 * scale, 0.5 * scale]);
        assert_eq!(map.inverse_exact(&map.forward_exact(&point).expect("inside")), Ok(point), "{scale:e}");
        assert!(matches!(verify_bytes(&bytes_of(&map)), Ok(Verdict::Certified(_))), "{scale:e}");
    }
    // Thousands of times as long as wide, everywhere.
    let spiky = |k: usize| if k.is_multiple_of(2) { 1.0 } else { 0.002 };
    let place = |k: usize| {
        let angle = TAU * k as f64 / 120.0;
        [spiky(k) * angle.cos(), spiky(k) * angle.sin()]
    };
    let spikes = vec![(0..120).map(place).collect()];
    let map = build(&pair(spikes, vec![round(120, |_| 1.0, 0.0)]), None, MiddleShape::default());
    assert!(map.source_half().vertex_count() < 50_000, "{} vertices", map.source_half().vertex_count());
    assert!(matches!(verify_bytes(&bytes_of(&map)), Ok(Verdict::Certified(_))));
}

/// What is not certified: the laws above notice it, or the checker does.
#[test]
fn a_map_with_two_images_exchanged_is_refuted() {
    let map = build(&pair(square(), star(2, 0.3)), None, MiddleShape::default());
    let (middle, source, target) =
        (map.middle().clone(), map.source_half().parts().clone(), map.target_half().parts().clone());
    let mut wrong = source.clone();
    wrong.images.swap(0, 1);
    for (name, parts) in [("right", source), ("wrong", wrong)] {
        let bytes = bytes_of(&HarmonicMap::new(middle.clone(), parts, target.clone()));
        match verify_bytes(&bytes) {
            Ok(Verdict::Certified(_)) => assert_eq!(name, "right"),
            Ok(Verdict::Refuted(witness)) => assert_eq!((name, witness.rule), ("wrong", "H5")),
            other => panic!("{name}: {other:?}"),
        }
    }
}
