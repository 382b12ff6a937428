//! Speed of barycentric coordinates on one core: `cargo bench -p homeo --bench coordinates`.
//!
//! Nanoseconds for a point, by kind and number of vertices, next to the floor of the machine: one square root and one
//! division for each vertex, as fast as the processor has them. Words after `--`: names of rows to measure.
#![allow(clippy::print_stdout)]

use std::hint::black_box;
use std::time::Instant;

use homeo::coordinates::{
    DiscreteHarmonic, MaximumEntropy, MeanValue, PlanarCoordinates, PositiveMeanValue, ThreePoint, Wachspress,
};
use homeo_core::planar::PlanarDomain;

const SIZES: [usize; 4] = [8, 64, 200, 256];

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let is_asked = |name: &str| words.is_empty() || words.iter().any(|w| name.contains(w.as_str()));
    println!("ns per point, one thread");
    println!("{:28} {}", "vertices", SIZES.map(|n| format!("{n:>9}")).join(" "));
    pool.install(|| {
        for (name, measure) in ROWS.into_iter().filter(|(name, _)| is_asked(name)) {
            println!("{name:28} {}", SIZES.map(|n| format!("{:>9.1}", measure(n))).join(" "));
        }
        let million = points(1_000_000);
        let (kind, data) = (MeanValue::new(&polygon(200)), vec![[1.0, 2.0]; 200]);
        let begin = Instant::now();
        black_box(kind.apply(&million, &data).expect("images"));
        println!("1M points of a 200-gon, mapped: {:.3} s", begin.elapsed().as_secs_f64());
    });
}

/// What is measured, by name.
type Row = (&'static str, fn(usize) -> f64);

const ROWS: [Row; 12] = [
    ("floor: roots + divisions", floor),
    ("mean value, map", |n| {
        let (kind, data) = (MeanValue::new(&polygon(n)), vec![[1.0, 2.0]; n]);
        many(|points| drop(black_box(kind.apply(points, &data).expect("images"))))
    }),
    ("mean value, batch", |n| {
        let kind = MeanValue::new(&polygon(n));
        let mut values = vec![0.0; n * 1024];
        many(|points| kind.values_of_many(points, black_box(&mut values[..n * points.len()])).expect("values"))
    }),
    ("mean value, single", |n| values(&MeanValue::new(&polygon(n)))),
    ("mean value, gradients", |n| gradients(&MeanValue::new(&polygon(n)))),
    ("Wachspress", |n| values(&Wachspress::new(&polygon(n)).expect("convex"))),
    ("Wachspress, gradients", |n| gradients(&Wachspress::new(&polygon(n)).expect("convex"))),
    ("discrete harmonic", |n| values(&DiscreteHarmonic::new(&polygon(n)).expect("convex"))),
    ("three-point, p = 1/2", |n| values(&ThreePoint::new(&polygon(n), 0.5).expect("convex"))),
    ("positive mean value", |n| values(&PositiveMeanValue::new(&polygon(n)))),
    ("maximum entropy", |n| values(&MaximumEntropy::new(&polygon(n)))),
    ("maximum entropy, gradients", |n| gradients(&MaximumEntropy::new(&polygon(n)))),
];

/// A convex polygon with uneven edges.
fn polygon(n: usize) -> PlanarDomain {
    let place = |i: usize| {
        let t = (i as f64 + 0.4 * (i as f64).sin()) * std::f64::consts::TAU / n as f64;
        [2.0 * t.cos(), 1.5 * t.sin()]
    };
    PlanarDomain::new(vec![(0..n).map(place).collect()]).expect("a polygon")
}

/// Points in the middle of it, on a spiral.
fn points(count: usize) -> Vec<[f64; 2]> {
    let place = |i: usize| {
        let (t, r) = (i as f64 * 2.4, (i as f64 / count as f64).sqrt());
        [1.6 * r * t.cos(), 1.2 * r * t.sin()]
    };
    (0..count).map(place).collect()
}

/// The best of several times for 1024 points, in nanoseconds for one.
fn many(mut work: impl FnMut(&[[f64; 2]])) -> f64 {
    let points = points(1024);
    let mut best = f64::INFINITY;
    let begin = Instant::now();
    while begin.elapsed().as_secs_f64() < 0.3 {
        let start = Instant::now();
        work(&points);
        best = best.min(start.elapsed().as_secs_f64() * 1e9 / points.len() as f64);
    }
    best
}

fn values(kind: &dyn PlanarCoordinates) -> f64 {
    let mut values = vec![0.0; kind.vertex_count()];
    many(|points| points.iter().for_each(|&p| kind.values_into(p, black_box(&mut values)).expect("values")))
}

fn gradients(kind: &dyn PlanarCoordinates) -> f64 {
    let (mut values, mut gradients) = (vec![0.0; kind.vertex_count()], vec![[0.0; 2]; kind.vertex_count()]);
    many(|points| {
        points
            .iter()
            .for_each(|&p| kind.gradients_into(p, black_box(&mut values), black_box(&mut gradients)).expect("values"));
    })
}

/// As many square roots and divisions as mean value coordinates of `n` vertices need, in vectors, and nothing else.
fn floor(n: usize) -> f64 {
    many(|points| {
        let mut sums = [0.0; 8];
        for p in points {
            for i in 0..n / 8 {
                let x = p[0].abs() + 1.0 + i as f64;
                for (lane, sum) in sums.iter_mut().enumerate() {
                    *sum += (x + lane as f64).sqrt() + 1.0 / (x - 0.5 + lane as f64);
                }
            }
        }
        black_box(sums);
    })
}
