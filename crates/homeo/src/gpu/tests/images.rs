//! Images of points.

use homeo_core::planar::{PlanarDomain, Point2};

use super::{Numbers, gpu, gpu_with};
use crate::composite::{CompositeMap, triangulate};
use crate::gpu::{Gpu, GpuError, GpuImages};
use crate::map::PlanarBijection;

/// A map through domains at equal times; that it is one-to-one is of no concern here.
fn through(steps: usize, rings: impl Fn(f64) -> Vec<Vec<Point2>>) -> CompositeMap {
    let domain = |k: usize| PlanarDomain::new(rings(k as f64 / steps as f64)).unwrap();
    let domains: Vec<PlanarDomain> = (0..=steps).map(domain).collect();
    let tilings = domains[..steps].iter().map(|domain| triangulate(domain).unwrap()).collect();
    CompositeMap::from_domains(domains, tilings).unwrap()
}

/// A ring of so many vertices with radii by a rule.
fn round(count: usize, centre: Point2, turn: f64, radius: impl Fn(usize) -> f64) -> Vec<Point2> {
    let vertex = |k: usize| {
        let angle = turn + std::f64::consts::TAU * k as f64 / count as f64;
        [centre[0] + radius(k) * angle.cos(), centre[1] + radius(k) * angle.sin()]
    };
    (0..count).map(vertex).collect()
}

fn maps() -> Vec<(&'static str, CompositeMap)> {
    let star = |t: f64| vec![round(20, [300.0, -40.0], 0.3 * t, |k| if k % 2 == 0 { 7.0 } else { 3.0 + 4.0 * t })];
    let turning = |t: f64| {
        let mut hole = round(8, [0.2, 0.0], 0.8 * t, |_| 0.5);
        hole.reverse();
        vec![round(12, [0.0, 0.0], 0.0, |_| 2.0), hole]
    };
    let waves = |t: f64| vec![round(200, [0.5, 0.5], 0.0, |k| 1e-3 * (1.0 + 0.2 * t * (0.3 * k as f64).sin()))];
    let channel = |t: f64| {
        let lean = |[x, y]: Point2| [x + 0.7 * t * y, y - 0.2 * t * x];
        let corners = [[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [4.0, 4.0], [4.0, 0.5], [1.0, 0.5], [1.0, 4.0], [0.0, 4.0]];
        vec![corners.map(lean).to_vec()]
    };
    let far = |t: f64| vec![round(5, [1e6, 1e6], 0.2 * t, |k| 3.0 + 0.1 * t * k as f64)];
    vec![
        ("star of 20 in 100 steps", through(100, star)),
        ("a hole turned in 30 steps", through(30, turning)),
        ("waves of 200 in 4 steps", through(4, waves)),
        ("channel in 10 steps", through(10, channel)),
        ("pentagon far away in one step", through(1, far)),
    ]
}

/// So many points anywhere, also beyond the source.
const ANYWHERE: usize = 6000;

/// Points anywhere, then others ever closer to vertices and edges, then such as no place has.
fn points(map: &CompositeMap) -> Vec<Point2> {
    let [low, high] = map.source().bounds();
    let between = |s: f64, t: f64| [low[0] + s * (high[0] - low[0]), low[1] + t * (high[1] - low[1])];
    let mut random = Numbers(7);
    let mut points: Vec<Point2> =
        (0..ANYWHERE).map(|_| between(1.1 * random.next() - 0.05, 1.1 * random.next() - 0.05)).collect();
    let middle = between(0.5, 0.5);
    for [p, q] in map.source().edges() {
        for (s, power) in (0..12).flat_map(|power| [0.0, 0.3, 0.5, 1e-3].map(|s| (s, power))) {
            let on_edge = [0, 1].map(|k| p[k] + s * (q[k] - p[k]));
            points.push([0, 1].map(|k| on_edge[k] + 0.1f64.powi(power) * (middle[k] - on_edge[k])));
        }
        points.extend([p, [0, 1].map(|k| 0.5 * (p[k] + q[k]))]);
    }
    points.extend([[f64::NAN, 0.0], [f64::INFINITY, 0.0], [1e300, -1e300]]);
    points
}

/// What was compared: points inside and outside, images left to the processor, and the largest difference as a part of the
/// stated error; infinite if a point is inside for one alone.
#[derive(Debug, Default)]
struct Tally {
    inside: usize,
    outside: usize,
    left: usize,
    worst: f64,
}

fn compared(map: &CompositeMap, points: &[Point2], found: &GpuImages) -> Tally {
    let mut expected = vec![None; points.len()];
    map.forward_along(points, &mut expected);
    let mut tally = Tally { left: found.left_to_cpu, ..Tally::default() };
    for pair in found.points.iter().zip(expected) {
        let miss = match pair {
            (Some(image), Some(expected)) => {
                tally.inside += 1;
                (0..2).map(|k| (image[k] - expected[k]).abs()).fold(0.0, f64::max) / found.error
            }
            (None, None) => {
                tally.outside += 1;
                0.0
            }
            _ => f64::INFINITY,
        };
        tally.worst = tally.worst.max(miss);
    }
    tally
}

fn tally(gpu: &Gpu, map: &CompositeMap) -> Tally {
    let points = points(map);
    compared(map, &points, &gpu.images(map, &points).unwrap())
}

#[test]
fn images_are_those_of_the_processor_to_the_stated_error() {
    let Some(gpu) = gpu("images_are_those_of_the_processor_to_the_stated_error") else { return };
    for (name, map) in maps() {
        let tally = tally(&gpu, &map);
        eprintln!("{name}: {tally:?}");
        assert!(tally.worst <= 1.0, "{name}: {tally:?}");
        assert!(tally.inside > 2000 && tally.outside > 300, "{name}: {tally:?}");
        assert!(tally.left > 2 * map.source().vertex_count(), "points on vertices and edges: {name}: {tally:?}");
        let anywhere = &points(&map)[..ANYWHERE];
        let tally = compared(&map, anywhere, &gpu.images(&map, anywhere).unwrap());
        assert!(tally.left * 20 < tally.inside, "few others are left: {name}: {tally:?}");
    }
}

#[test]
fn wrong_weights_and_places_in_one_part_miss_the_stated_error() {
    let name = "wrong_weights_and_places_in_one_part_miss_the_stated_error";
    let wrong = [
        ["let safe = lengths + abs(cosine);", "let safe = lengths + 0.9 * abs(cosine);"],
        [
            "let tangent = select(cross, safe, is_wide) / select(safe, cross, is_wide);",
            "let tangent = cross / lengths;",
        ],
        ["return vec4<f32>(grid, (at.xy - grid) + rest);", "return vec4<f32>(grid, vec2<f32>(0.0));"],
    ];
    for exchange in wrong {
        let Some(gpu) = gpu_with(name, exchange) else { return };
        for (name, map) in maps() {
            let tally = tally(&gpu, &map);
            assert!(tally.worst > 1.0, "{name} with {exchange:?}: {tally:?}");
        }
    }
}

#[test]
fn images_do_not_depend_on_how_much_is_done_in_a_pass() {
    let Some(mut gpu) = gpu("images_do_not_depend_on_how_much_is_done_in_a_pass") else { return };
    for (name, map) in maps() {
        let points = points(&map);
        let at_once = gpu.images(&map, &points).unwrap();
        let most = std::mem::replace(&mut gpu.most_bytes, 16384);
        assert_eq!(gpu.images(&map, &points).unwrap(), at_once, "{name}");
        gpu.most_bytes = most;
    }
}

#[test]
fn what_is_too_large_is_refused_and_nothing_gives_nothing() {
    let Some(mut gpu) = gpu("what_is_too_large_is_refused_and_nothing_gives_nothing") else { return };
    let (_, map) = maps().remove(1);
    let none = gpu.images(&map, &[]).unwrap();
    assert!(none.points.is_empty() && none.left_to_cpu == 0);
    gpu.most_bytes = 64;
    let error = gpu.images(&map, &[[1.0, 1.0]]).unwrap_err();
    assert_eq!(error, GpuError::DomainTooLarge { vertices: 20, bytes: 22 * 32, most: 64 });
}
