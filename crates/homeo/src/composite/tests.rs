//! Rules that composite mean value maps keep.

use homeo_core::planar::{DomainPair, PlanarDomain, Point2};

use super::chart::{Part, Step};
use super::frame::{Frame, Local};
use super::guide::Guide;
use super::number::Form;
use super::{
    CompositeMap, JacobianLimits, JacobianVerdict, PartitionError, PartitionParams, Tiling, TriangulationError,
    check_tiling, triangulate,
};
use crate::progress::Silent;
use crate::shape::LinearPath;

fn step(rings: Vec<Vec<Point2>>, images: &[Point2]) -> Step {
    let domain = PlanarDomain::new(rings).unwrap();
    let tiling = triangulate(&domain).unwrap();
    Step::new(&domain, &tiling, images.to_vec())
}

fn verdict(step: &Step) -> JacobianVerdict {
    step.bound(&JacobianLimits::default(), 0, &|| false).0
}

/// With a reflex vertex and one inside a straight side.
fn hook() -> Vec<Point2> {
    vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 1.5], [1.0, 2.0], [0.0, 2.0]]
}

fn square(radius: f64) -> Vec<Point2> {
    vec![[-radius, -radius], [radius, -radius], [radius, radius], [-radius, radius]]
}

fn hole(radius: f64) -> Vec<Point2> {
    square(radius).into_iter().rev().collect()
}

/// Where points are added inside.
fn round() -> Vec<Point2> {
    let angles = (0..16).map(|k| std::f64::consts::TAU * f64::from(k) / 16.0);
    angles.map(|angle| [angle.cos(), angle.sin()]).collect()
}

/// A hook, a frame and a round polygon, with images that differ a little from an affine image of theirs.
fn examples() -> Vec<Step> {
    let moved = |rings: &[Vec<Point2>]| -> Vec<Point2> {
        let wave = |p: &Point2| [p[0] + 0.2 * p[1] + 0.05 * (3.0 * p[1]).sin(), 1.1 * p[1] + 0.04 * (5.0 * p[0]).cos()];
        rings.iter().flatten().map(wave).collect()
    };
    let frame = vec![square(2.0), hole(1.0)];
    [vec![hook()], frame, vec![round()]].into_iter().map(|rings| step(rings.clone(), &moved(&rings))).collect()
}

/// Numbers from 0 to 1, from a fixed seed.
fn random() -> impl FnMut() -> f64 {
    let mut state = 5u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 2f64.powi(53)
    }
}

/// Angles between directions to the ends of each edge, as the definition has it.
fn by_definition(step: &Step, x: Point2) -> Point2 {
    let towards = |i: usize| -> Point2 { std::array::from_fn(|k| step.points[i][k] - x[k]) };
    let tangent = |i: usize| {
        let ([a, b], [c, d]) = (towards(i), towards(step.next[i] as usize));
        (0.5 * (a * d - b * c).atan2(a * c + b * d)).tan()
    };
    let weight = |i: usize| {
        let [a, b] = towards(i);
        (tangent(i) + tangent(step.previous[i] as usize)) / a.hypot(b)
    };
    let weights: Vec<f64> = (0..step.points.len()).map(weight).collect();
    let total: f64 = weights.iter().sum();
    std::array::from_fn(|k| weights.iter().zip(&step.images).map(|(w, image)| w * image[k]).sum::<f64>() / total)
}

fn holds(form: Form, value: f64) -> bool {
    let slack = 1e-10 * value.abs().max(1.0);
    form.low() <= value + slack && value - slack <= form.high()
}

#[test]
fn charts_give_mean_value_coordinates_and_their_derivative() {
    let mut next = random();
    for step in examples() {
        for chart in &step.charts {
            for _ in 0..20 {
                let point = step.place(chart, [0.02 + 0.96 * next(), 0.02 + 0.96 * next()]);
                let (image, derivative) = step.value(point);
                let wanted = by_definition(&step, point);
                let rate = |axis: usize| {
                    let mut ends = [point, point];
                    ends[0][axis] -= 1e-6;
                    ends[1][axis] += 1e-6;
                    let [low, high] = ends.map(|end| by_definition(&step, end));
                    [(high[0] - low[0]) / 2e-6, (high[1] - low[1]) / 2e-6]
                };
                for k in 0..2 {
                    assert!((image[k] - wanted[k]).abs() < 1e-11, "{point:?}: {image:?}, not {wanted:?}");
                    for axis in 0..2 {
                        let difference = (derivative[k][axis] - rate(axis)[k]).abs();
                        assert!(
                            difference < 1e-3,
                            "{point:?}: derivative {derivative:?}, differences {:?}",
                            rate(axis)
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn enclosures_hold_values_up_to_vertices_and_edges() {
    let mut next = random();
    let mut known = 0;
    for step in examples() {
        for chart in &step.charts {
            let mut boxes = Frame::<Form>::new(&step, chart);
            let mut points = Frame::<f64>::new(&step, chart);
            for round in 0..60 {
                let side = |x: f64, width: f64| [x * (1.0 - width), x * (1.0 - width) + width];
                let width = 0.5f64.powi(round % 6 + 2);
                // Every third box at the vertex, every fifth at λ = 0.
                let at = [if round % 3 == 0 { 0.0 } else { next() }, if round % 5 == 0 { 0.0 } else { next() }];
                let [s, lambda] = [side(at[0], width), side(at[1], width)];
                let sides = [0, 1].map(|axis| Form::between([s, lambda][axis][0], [s, lambda][axis][1]).along(axis));
                let guide = boxes.guide(sides[0].middle, sides[1].middle);
                let around = boxes.evaluate(sides[0], sides[1], &guide);
                let inside = |[low, high]: [f64; 2], part: f64| low + part * (high - low);
                for part in [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [next(), next()]] {
                    let Local { image, determinant, .. } =
                        points.evaluate(inside(s, part[0]), inside(lambda, part[1]), &Guide::NONE);
                    if !around.determinant.radius().is_nan() {
                        known += 1;
                        assert!(
                            holds(around.determinant, determinant),
                            "{s:?} {lambda:?} {part:?}: {determinant}, not {:?} in {chart:?}, {guide:?}",
                            around.determinant
                        );
                        assert!((0..2).all(|k| holds(around.image[k], image[k])), "{s:?} {lambda:?}: {image:?}");
                    }
                }
            }
        }
    }
    assert!(known > 5000, "most boxes are bounded: {known}");
}

#[test]
fn affine_maps_have_their_determinant() {
    let affine = |p: &Point2| [2.0 * p[0] - p[1] + 3.0, 0.5 * p[0] + p[1] - 7.0];
    let sharp = JacobianLimits { sharpness: 0.99, ..JacobianLimits::default() };
    let verdict = |step: &Step| step.bound(&sharp, 0, &|| false).0;
    for rings in [vec![hook()], vec![square(2.0), hole(1.0)]] {
        let points: Vec<Point2> = rings.iter().flatten().copied().collect();
        let identity = verdict(&step(rings.clone(), &points));
        assert!(
            matches!(identity, JacobianVerdict::Positive { least, .. } if (0.98..=1.0).contains(&least)),
            "{identity:?}"
        );
        let images: Vec<Point2> = points.iter().map(affine).collect();
        let found = verdict(&step(rings, &images));
        assert!(matches!(found, JacobianVerdict::Positive { least, .. } if (2.45..=2.5).contains(&least)), "{found:?}");
    }
}

#[test]
fn proved_steps_have_no_negative_sample() {
    let mut next = random();
    for step in examples() {
        let JacobianVerdict::Positive { least, .. } = verdict(&step) else { panic!("not proved") };
        for _ in 0..100_000 / step.charts.len() + 1 {
            for chart in &step.charts {
                let mut frame = Frame::<f64>::new(&step, chart);
                // Squares of squares: many near the vertex and the edge.
                let here = frame.evaluate(next().powi(4), next().powi(4), &Guide::NONE).determinant;
                assert!(here > least * (1.0 - 1e-9), "{here} is less than {least}");
            }
        }
    }
}

#[test]
fn folds_are_refuted_with_a_witness() {
    // A vertex of a square goes beyond the centre: figure 2.3 of Schneider 2017.
    let diamond: Vec<Point2> = vec![[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let mut images = diamond.clone();
    images[2] = [1.0 / 3.0, 0.0];
    let folding = step(vec![diamond.clone()], &images);
    let centre = by_definition(&folding, [0.0, 0.0]);
    assert!((centre[0] - 1.0 / 3.0).abs() < 1e-12, "the centre goes where the vertex goes: {centre:?}");
    let JacobianVerdict::Negative { point, at_most, .. } = verdict(&folding) else { panic!("not refuted") };
    let [[a, b], [c, d]] = folding.value(point).1;
    assert!(at_most < 0.0 && a * d - b * c <= at_most + 1e-9, "a true witness");
    // Two vertices exchanged: a control of the proof, which must not accept what is no domain's map.
    for mut example in examples() {
        assert!(matches!(verdict(&example), JacobianVerdict::Positive { .. }));
        example.images.swap(2, 4);
        assert!(!matches!(verdict(&example), JacobianVerdict::Positive { .. }), "vertices 2 and 4 exchanged");
    }
}

#[test]
fn bounds_do_not_depend_on_threads() {
    for step in examples() {
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| verdict(&step))
        };
        assert_eq!(with(1), with(3));
    }
}

#[test]
fn examples_have_charts_of_all_kinds() {
    let charts: Vec<_> = examples().into_iter().flat_map(|step| step.charts).collect();
    for part in [Part::Whole, Part::Half, Part::Sixth] {
        assert!(charts.iter().any(|chart| chart.part == part), "{part:?}");
    }
    let round = step(vec![round()], &round());
    assert!(round.charts.iter().any(|chart| !round.is_vertex(chart.corners[0])), "an apex is an added point");
}

#[test]
fn triangles_that_do_not_tile_are_refused() {
    let domain = PlanarDomain::new(vec![square(2.0), hole(1.0)]).unwrap();
    let tiling = triangulate(&domain).unwrap();
    let inside = |triangles: &[[u32; 3]]| Tiling { added: tiling.added.clone(), triangles: triangles.to_vec() };
    let triangles = tiling.triangles.clone();
    assert!(triangles.len() >= 8);
    assert!(check_tiling(&domain, &tiling).is_ok());
    assert!(matches!(check_tiling(&domain, &inside(&triangles[1..])), Err(TriangulationError::Unpaired(..))));
    let twice: Vec<_> = triangles.iter().chain(&triangles[..1]).copied().collect();
    assert!(matches!(check_tiling(&domain, &inside(&twice)), Err(TriangulationError::Unpaired(..))));
    let mut turned = triangles.clone();
    turned[3].swap(0, 1);
    assert_eq!(check_tiling(&domain, &inside(&turned)), Err(TriangulationError::NotPositive(3)));
    let mut strange = triangles;
    strange[0][0] = 9999;
    assert_eq!(check_tiling(&domain, &inside(&strange)), Err(TriangulationError::NotPositive(0)));
}

/// A frame whose inner square turns by a right angle.
fn turning_frame() -> DomainPair {
    let mut turned = hole(0.5);
    turned.rotate_left(1);
    // By straight lines: only as far as the squares stay simple.
    let part = |(a, b): (&Point2, &Point2)| std::array::from_fn(|k| 0.75 * a[k] + 0.25 * b[k]);
    let inner = hole(0.5).iter().zip(&turned).map(part).collect();
    DomainPair::new(vec![square(2.0), hole(0.5)], vec![square(2.0), inner]).unwrap()
}

fn kite() -> DomainPair {
    let kite = vec![[0.0, 0.0], [1.0, 0.0], [0.35, 0.35], [0.0, 1.0]];
    DomainPair::new(vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]], vec![kite]).unwrap()
}

#[test]
fn composite_maps_go_there_and_back() {
    let mut next = random();
    for pair in [kite(), turning_frame()] {
        let path = LinearPath::between(&pair).unwrap();
        let (map, info) = CompositeMap::build(&path, &PartitionParams::default(), &Silent).unwrap();
        assert!(info.least_determinant > 0.0 && info.bounds.len() == map.step_count());
        let [low, high] = pair.source.bounds();
        let mut count = 0;
        while count < 200 {
            let point = std::array::from_fn(|k| low[k] + next() * (high[k] - low[k]));
            if !pair.source.contains(point) {
                continue;
            }
            count += 1;
            let image = map.forward(point).unwrap();
            assert!(image.radius < 1e-6, "{point:?} goes to {image:?}");
            if !pair.target.contains(image.point) {
                continue;
            }
            let back = map.inverse(image.point).unwrap();
            assert!(back.radius < 1e-6, "{point:?}: {back:?}");
            let miss = (back.point[0] - point[0]).hypot(back.point[1] - point[1]);
            assert!(miss < 1e-6, "{point:?} comes back as {:?}", back.point);
            let distortion = map.distortion(point).unwrap();
            assert!(distortion >= 2.0 - 1e-9, "distortion {distortion}");
        }
        for ([a, b], [c, d]) in pair.source.edges().zip(pair.target.edges()) {
            assert_eq!(map.forward(a).unwrap().point, c);
            assert_eq!(map.inverse(d).unwrap().point, b);
        }
    }
}

#[test]
fn near_vertices_and_edges_there_and_back() {
    let (map, _) =
        CompositeMap::build(&LinearPath::between(&kite()).unwrap(), &PartitionParams::default(), &Silent).unwrap();
    for distance in [1e-3, 1e-8, 1e-14] {
        for point in [[distance, distance], [1.0 - distance, 1.0 - distance], [0.3, distance], [1.0 - distance, 0.6]] {
            let image = map.forward(point).unwrap();
            assert!(image.radius < 1e-5, "{point:?}: {image:?}");
        }
    }
    assert!(map.forward([-1e-300, 0.5]).is_err() && map.inverse([1.0, 1.0]).is_err());
}

#[test]
fn what_stops_a_partition_is_said() {
    let turned: Vec<Point2> = square(1.0).iter().map(|p| p.map(|c| -c)).collect();
    let build = |pair: DomainPair, params: &PartitionParams| {
        CompositeMap::build(&LinearPath::between(&pair).unwrap(), params, &Silent).map(|(map, _)| map.step_count())
    };
    let through_a_point = DomainPair::new(vec![square(1.0)], vec![turned]).unwrap();
    let usual = PartitionParams::default();
    assert!(build(through_a_point, &usual).is_ok(), "half a turn is one linear map");
    let few = PartitionParams { steps: 1, ..usual };
    assert!(matches!(build(kite(), &few), Err(PartitionError::TooManySteps(1, _))));
    let late = PartitionParams { timeout: Some(std::time::Duration::ZERO), ..usual };
    assert!(matches!(build(kite(), &late), Err(PartitionError::Stopped(..))));
    let mut shifted = hook();
    shifted.rotate_left(3);
    let pair = DomainPair::new(vec![hook()], vec![shifted]).unwrap();
    assert!(matches!(build(pair, &usual), Err(PartitionError::NotADomain { .. })));
}
