//! Complex maps: formulas against the definition, enclosures, covers, proofs, and what must fail.

use std::sync::atomic::{AtomicUsize, Ordering};

use homeo_core::planar::{DomainPair, PlanarDomain, Point2};

use super::optimize::{STAGES, Search};
use super::*;
use crate::composite::chart::Step;
use crate::composite::frame::{Frame, Local};
use crate::composite::guide::Guide;
use crate::composite::number::Form;
use crate::composite::{JacobianLimits, JacobianVerdict, triangulate};
use crate::coordinates::{Complex, ComplexCoordinates, ComplexFamily};
use crate::progress::{Progress, Silent};

/// Numbers between 0 and 1 from a fixed seed.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / 2f64.powi(53)
    }

    fn speeds(&mut self, edges: usize, degree: usize) -> EdgeSpeeds {
        let mut edge = |_| {
            let parts: Vec<f64> = (0..degree).map(|_| 0.1 + self.unit()).collect();
            let total: f64 = parts.iter().sum();
            (1..degree).map(|k| parts[..k].iter().sum::<f64>() / total).collect()
        };
        EdgeSpeeds::new(degree, (0..edges).map(&mut edge).collect()).unwrap()
    }

    fn inside(&mut self, domain: &PlanarDomain) -> Point2 {
        let [low, high] = domain.bounds();
        loop {
            let point = [0, 1].map(|k| low[k] + (high[k] - low[k]) * self.unit());
            if domain.contains(point) {
                return point;
            }
        }
    }
}

fn square() -> Vec<Point2> {
    vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
}

fn dart(corner: f64) -> Vec<Point2> {
    vec![[0.0, 0.0], [1.0, 0.0], [corner, corner], [0.0, 1.0]]
}

fn polygon(n: usize, radius: impl Fn(usize) -> f64, turn: f64) -> Vec<Point2> {
    let place = |k: usize| {
        let (y, x) = (turn + std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
        [radius(k) * x, radius(k) * y]
    };
    (0..n).map(place).collect()
}

fn pair(source: Vec<Vec<Point2>>, target: Vec<Vec<Point2>>) -> DomainPair {
    DomainPair::new(source, target).unwrap()
}

/// Pairs of many classes: convex, not convex, straight corners, a needle, a hole.
fn pairs() -> Vec<(&'static str, DomainPair)> {
    let hole = |turn: f64| polygon(5, |_| 0.35, turn).into_iter().rev().collect::<Vec<_>>();
    let star = |k: usize| if k.is_multiple_of(2) { 1.0 } else { 0.45 };
    let straight = vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.2], [0.0, 1.0]];
    vec![
        ("dart", pair(vec![square()], vec![dart(0.45)])),
        ("star", pair(vec![polygon(10, star, 0.1)], vec![polygon(10, |k| 0.8 * star(k + 1) + 0.2, 0.0)])),
        ("straight", pair(vec![straight], vec![polygon(6, |_| 1.0, 4.0)])),
        ("needle", pair(vec![vec![[0.0, 0.0], [9.0, -0.02], [9.0, 0.02]]], vec![polygon(3, |_| 1.0, 3.0)])),
        ("hole", pair(vec![polygon(7, |_| 1.0, 0.0), hole(0.3)], vec![polygon(7, |_| 1.1, 0.2), hole(0.6)])),
    ]
}

fn step(pair: &DomainPair, speeds: &EdgeSpeeds) -> Step {
    let tiling = triangulate(&pair.source).unwrap();
    Step::new(&pair.source, &tiling, pair.target.vertices().collect()).with_speeds(speeds.clone())
}

fn at_point(step: &Step, point: Point2) -> Local<f64> {
    let (chart, [s, lambda]) = step.locate(point);
    Frame::<f64>::new(step, chart).evaluate(s, lambda, &Guide::NONE)
}

/// `h = sum g_i s_i`, and `|h_z|^2 - |h_zbar|^2`, by shares of edges and speeds as they are defined.
fn by_definition(pair: &DomainPair, step: &Step, speeds: &EdgeSpeeds, point: Point2) -> (Complex, f64) {
    let kind = ComplexCoordinates::new(&pair.source, ComplexFamily::ThreePoint(1.0)).unwrap();
    let n = step.points.len();
    let zero = vec![Complex::default(); n];
    let (mut g, mut by_z, mut by_conjugate) = (zero.clone(), zero.clone(), zero);
    kind.derivatives_into(point, &mut g, &mut by_z, &mut by_conjugate).unwrap();
    let (mut value, mut first, mut second) = (Complex::default(), Complex::default(), Complex::default());
    let real = |re: f64| Complex { re, im: 0.0 };
    let half = real(0.5);
    for i in 0..n {
        let k = step.next[i] as usize;
        let [a, b, h, j] = [step.points[i], step.points[k], step.images[i], step.images[k]].map(Complex::new);
        let tau = (Complex::new(point) - a) / (b - a);
        let width = 1e-5;
        let slope = (speeds.at(i, tau.re + width) - speeds.at(i, tau.re - width)) / (2.0 * width);
        let s = h + (j - h) * Complex { re: speeds.at(i, tau.re), im: tau.im };
        // Re τ = (τ + conj τ) / 2, i Im τ = (τ - conj τ) / 2.
        let (e, conjugate) = (b - a, Complex { re: (b - a).re, im: -(b - a).im });
        let s_z = (j - h) * half * real(slope + 1.0) / e;
        let s_conjugate = (j - h) * half * real(slope - 1.0) / conjugate;
        value = value + g[i] * s;
        first = first + by_z[i] * s + g[i] * s_z;
        second = second + by_conjugate[i] * s + g[i] * s_conjugate;
    }
    (value, first.size().powi(2) - second.size().powi(2))
}

#[test]
fn values_and_determinants_are_those_of_the_definition() {
    let mut random = Random(5);
    let mut tried = 0;
    for (name, pair) in pairs().into_iter().filter(|(name, _)| *name != "needle") {
        let edges = pair.source.vertex_count();
        for degree in [1, 2, 3, 5] {
            let speeds = random.speeds(edges, degree);
            let (own, other) = (step(&pair, &speeds), step(&pair, &random.speeds(edges, degree + 1)));
            let mut apart = 0.0f64;
            for _ in 0..40 {
                let point = random.inside(&pair.source);
                let (value, determinant) = by_definition(&pair, &own, &speeds, point);
                let found = at_point(&own, point);
                let size: f64 = 1.0 + found.columns.iter().flatten().map(|d| d * d).sum::<f64>();
                assert!((Complex::new(found.image) - value).size() < 1e-12 * size, "{name} {degree} {point:?}");
                assert!((found.determinant - determinant).abs() < 1e-6 * size, "{name} {degree} {point:?}");
                apart = apart.max((Complex::new(at_point(&other, point).image) - value).size());
                tried += 1;
            }
            assert!(apart > 1e-3, "other speeds give another map: {apart}");
        }
    }
    assert_eq!(tried, 640);
}

/// What is proved is not contradicted by samples; both verdicts occur, and witnesses are true by the definition.
#[test]
fn verdicts_are_true() {
    let mut random = Random(17);
    let (mut positive, mut negative, mut folded) = (0, 0, 0);
    for round in 0..40 {
        let corner = 0.2 + 0.6 * random.unit();
        let pair = pair(vec![square()], vec![dart(corner)]);
        let speeds = random.speeds(4, 2 + round % 3);
        let own = step(&pair, &speeds);
        let sampled = |random: &mut Random| at_point(&own, random.inside(&pair.source)).determinant;
        let least = (0..2000).map(|_| sampled(&mut random)).fold(f64::INFINITY, f64::min);
        match bound_complex_jacobian(&pair, &speeds, &JacobianLimits::default()).unwrap() {
            JacobianVerdict::Positive { least: bound, .. } => {
                assert!(bound > 0.0 && bound <= least, "{corner} {speeds:?}: {bound} {least}");
                positive += 1;
            }
            JacobianVerdict::Negative { point, at_most, .. } => {
                assert!(at_most < 0.0 && pair.source.contains(point));
                let (_, determinant) = by_definition(&pair, &own, &speeds, point);
                assert!(determinant < 1e-6 && determinant <= at_most + 1e-6, "{point:?} {determinant} {at_most}");
                negative += 1;
            }
            JacobianVerdict::Undecided { .. } => {}
        }
        folded += usize::from(least < 0.0);
    }
    assert!(positive >= 5 && negative >= 10 && folded >= 5, "{positive} {negative} {folded}");
}

#[test]
fn the_search_repairs_what_folds_at_linear_speeds() {
    let pair = pair(vec![square()], vec![dart(0.4)]);
    let linear = bound_complex_jacobian(&pair, &EdgeSpeeds::linear(4), &JacobianLimits::default()).unwrap();
    assert!(matches!(linear, JacobianVerdict::Negative { at_most, .. } if at_most < -0.05), "{linear:?}");
    for degree in [2, 3, 4] {
        let params = ComplexParams { degree, ..ComplexParams::default() };
        let (map, info) = ComplexMap::build(&pair, &params, &Silent).unwrap();
        assert!(info.least_determinant > 1e-3 && info.sampled[0] > info.sampled[1], "{info:?}");
        assert!(info.least_determinant <= info.sampled[0]);
        assert_eq!(map.speeds().degree(), degree);
    }
    // Linear speeds only: nothing can be done; and nothing for a corner that is too deep.
    let params = ComplexParams { degree: 1, ..ComplexParams::default() };
    assert!(matches!(ComplexMap::build(&pair, &params, &Silent), Err(ComplexError::Folds { .. })));
    let deep = DomainPair::new(vec![square()], vec![dart(0.1)]).unwrap();
    assert!(matches!(ComplexMap::build(&deep, &ComplexParams::default(), &Silent), Err(ComplexError::Folds { .. })));
}

#[test]
fn limits_that_are_too_small_leave_it_undecided() {
    let pair = pair(vec![square()], vec![dart(0.45)]);
    let limits = JacobianLimits { boxes_per_chart: 3, ..JacobianLimits::default() };
    let params = ComplexParams { limits, rounds: 0, ..ComplexParams::default() };
    let error = ComplexMap::build(&pair, &params, &Silent).err();
    assert!(matches!(error, Some(ComplexError::Undecided { .. })), "{error:?}");
}

#[test]
fn edges_are_run_along_by_their_speeds_and_back() {
    let pair = pair(vec![square()], vec![dart(0.45)]);
    let (map, _) = ComplexMap::build(&pair, &ComplexParams::default(), &Silent).unwrap();
    let mut off_linear = 0.0f64;
    for (edge, ([a, b], [c, d])) in pair.source.edges().zip(pair.target.edges()).enumerate() {
        for share in [0.0, 0.125, 0.5, 0.75] {
            let point = [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
            let speed = map.speeds().at(edge, share);
            let goal = [0, 1].map(|k| c[k] + speed * (d[k] - c[k]));
            let image = map.forward(point).unwrap();
            assert!((0..2).all(|k| (image.point[k] - goal[k]).abs() < 1e-14), "{edge} {share}");
            off_linear = off_linear.max((speed - share).abs());
            // Beside the edge, by the formulas off edges.
            let beside = [0, 1].map(|k| point[k] + 1e-9 * (0.5 - point[k]));
            let image = map.forward(beside).unwrap();
            assert!((0..2).all(|k| (image.point[k] - goal[k]).abs() < 1e-7), "{edge} {share}: {image:?}");
            assert!(image.radius < 1e-12, "{image:?}");
        }
        // Points of the target's axes lie on its edges exactly.
        if edge == 0 {
            let back = map.inverse([0.25, 0.0]).unwrap();
            assert!((map.speeds().at(0, back.point[0]) - 0.25).abs() < 1e-14 && back.radius < 1e-13, "{back:?}");
        }
    }
    assert!(off_linear > 0.02, "speeds are not linear: {off_linear}");
}

#[test]
fn results_do_not_depend_on_threads() {
    let pair = pair(vec![square()], vec![dart(0.45)]);
    let built = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (map, info) = pool.install(|| ComplexMap::build(&pair, &ComplexParams::default(), &Silent)).unwrap();
        (map.speeds().clone(), info)
    };
    assert_eq!(built(1), built(3));
}

#[test]
fn speeds_that_are_none_are_refused() {
    assert_eq!(EdgeSpeeds::new(0, Vec::new()), Err(SpeedError::Degree { degree: 0 }));
    let count = SpeedError::Count { edge: 1, expected: 2, found: 1 };
    assert_eq!(EdgeSpeeds::new(3, vec![vec![0.2, 0.4], vec![0.5]]), Err(count));
    for values in [[0.4, 0.2], [0.0, 0.5], [0.5, 1.0], [f64::NAN, 0.5]] {
        assert_eq!(EdgeSpeeds::new(3, vec![values.to_vec()]), Err(SpeedError::NotIncreasing { edge: 0 }));
    }
    let pair = pair(vec![square()], vec![dart(0.8)]);
    let found = bound_complex_jacobian(&pair, &EdgeSpeeds::linear(3), &JacobianLimits::default());
    assert_eq!(found, Err(SpeedError::Edges { edges: 4, found: 3 }.into()));
}

/// What was not reached is undecided, not proved.
#[test]
fn a_cancelled_proof_proves_nothing() {
    let pair = pair(vec![square()], vec![dart(0.55)]);
    let own = step(&pair, &EdgeSpeeds::linear(4));
    // Many boxes: it is asked now and then.
    let limits = JacobianLimits { sharpness: 0.99, boxes_per_chart: 100_000 };
    assert!(matches!(own.bound(&limits, 0, &|| true).0, JacobianVerdict::Undecided { .. }));
    assert!(matches!(own.bound(&limits, 0, &|| false).0, JacobianVerdict::Positive { .. }));
}

/// Up to vertices and edges, where factors cancel.
#[test]
fn enclosures_hold_samples() {
    let mut random = Random(11);
    let (mut known, mut missed) = (0, 0);
    for (name, pair) in pairs() {
        let own = step(&pair, &random.speeds(pair.source.vertex_count(), 4));
        for chart in &own.charts {
            let (mut wide, mut exact) = (Frame::<Form>::new(&own, chart), Frame::<f64>::new(&own, chart));
            for size in [0.2, 0.02, 1e-3] {
                // Every third at the end.
                let from = [0, 1].map(|_| (1.0 - size) * random.unit() * f64::from(random.unit() > 0.3));
                let at = from.map(|low| Form::between(low, low + size));
                let guide = wide.guide(at[0].middle, at[1].middle);
                let found = wide.evaluate(at[0].along(0), at[1].along(1), &guide);
                if !found.determinant.radius().is_finite() {
                    continue;
                }
                known += 1;
                for _ in 0..8 {
                    let shares = [random.unit(), random.unit()];
                    let sample = exact.evaluate(from[0] + size * shares[0], from[1] + size * shares[1], &Guide::NONE);
                    let pairs = [
                        (found.image[0], sample.image[0]),
                        (found.image[1], sample.image[1]),
                        (found.determinant, sample.determinant),
                    ];
                    for (form, value) in pairs {
                        let off = (form.middle - value).abs();
                        assert!(off <= form.radius() + 1e-9 * (1.0 + value.abs()), "{name} {chart:?} {form:?} {value}");
                        missed += usize::from(off > 0.05 * form.radius());
                    }
                }
            }
        }
    }
    assert!(known > 300, "{known} boxes have enclosures");
    assert!(missed > 100, "forms a twentieth as large miss samples: {missed}");
}

#[test]
fn slopes_of_the_search_are_those_of_differences() {
    let mut random = Random(23);
    for (name, pair) in pairs() {
        let plain = step(&pair, &EdgeSpeeds::linear(pair.source.vertex_count()));
        for degree in [2, 3, 5] {
            let search = Search::new(&plain, [&pair.source, &pair.target], degree, &|| false);
            let [free, elsewhere] = [0, 1]
                .map(|_| -> Vec<f64> { (0..degree * plain.points.len()).map(|_| 2.0 * random.unit() - 1.0).collect() });
            for sharpness in [1.0, 10.0] {
                let (_, slopes) = search.rise(&free, sharpness);
                let (_, others) = search.rise(&elsewhere, sharpness);
                let (mut off, mut off_others) = (0.0f64, 0.0f64);
                for k in 0..free.len() {
                    let at = |step: f64| {
                        let mut moved = free.clone();
                        moved[k] += step;
                        search.rise(&moved, sharpness).0
                    };
                    let difference = (at(1e-5) - at(-1e-5)) / 2e-5;
                    off = off.max((slopes[k] - difference).abs());
                    off_others = off_others.max((others[k] - difference).abs());
                }
                let size = slopes.iter().fold(0.0f64, |size, slope| size.max(slope.abs()));
                assert!(size > 0.0 && off < 1e-5 * (1.0 + size), "{name} {degree} {sharpness}: {off} of {size}");
                assert!(off_others > 1e-2 * size, "elsewhere slopes are others: {name} {off_others} of {size}");
            }
        }
    }
}

/// The least determinant at many places of all charts, which are not those that the search looks at.
fn least_determinant(plain: &Step, speeds: EdgeSpeeds) -> f64 {
    let own = plain.clone().with_speeds(speeds);
    let mut least = f64::INFINITY;
    for chart in &own.charts {
        let mut frame = Frame::<f64>::new(&own, chart);
        for k in 0..23 * 23 {
            let [s, lambda] = [k / 23, k % 23].map(|k| f64::from(k) / 22.0);
            least = least.min(frame.evaluate(s, lambda, &Guide::NONE).determinant);
        }
    }
    least
}

/// The control: with samples as they were to begin with the search takes speeds for good that are worse between them.
#[test]
fn what_is_missed_between_samples_is_added() {
    let pair = pair(vec![square()], vec![dart(0.4)]);
    let plain = step(&pair, &EdgeSpeeds::linear(4));
    let new = || Search::new(&plain, [&pair.source, &pair.target], 4, &|| false);
    let (mut blind, mut seeing) = (new(), new());
    STAGES.into_iter().for_each(|sharpness| blind.climb(sharpness, &|| false));
    seeing.ascend(&|| false);
    let [missed, found] = [&blind, &seeing].map(|search| least_determinant(&plain, search.speeds().unwrap()));
    assert!(missed < 0.5 * blind.sampled()[0], "{missed} {:?}", blind.sampled());
    assert!(found > missed && found > 0.95 * seeing.sampled()[0], "{found} {:?}", seeing.sampled());
}

/// Cancels when it is asked for the given time.
struct Impatient {
    asked: AtomicUsize,
    limit: usize,
}

impl Progress for Impatient {
    fn is_cancelled(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) >= self.limit
    }
}

#[test]
fn a_cancelled_search_says_nothing_of_folds() {
    let pair = pair(vec![square()], vec![dart(0.1)]);
    let built = |limit: usize| {
        let progress = Impatient { asked: AtomicUsize::new(0), limit };
        let error = ComplexMap::build(&pair, &ComplexParams::default(), &progress).err();
        (error, progress.asked.into_inner())
    };
    let (error, asked) = built(usize::MAX);
    assert!(matches!(error, Some(ComplexError::Folds { .. })) && asked > 100, "{error:?} {asked}");
    for limit in [0, 1, 20, asked / 2] {
        assert_eq!(built(limit).0, Some(ComplexError::Stopped), "asked {limit} times");
    }
}
