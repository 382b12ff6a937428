//! Three methods for one harmonic function: errors and times against unknowns (Schneider 2017, table 5.1).
//!
//! `cargo run --release -p homeo --example harmonic_methods`

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use std::f64::consts::PI;
use std::time::Instant;

use homeo::harmonic::{
    BoundaryData, BoundaryElements, ElementParams, FiniteElements, FundamentalParams, FundamentalSolutions,
    HarmonicFunctions, Profile,
};
use homeo_core::planar::{PlanarDomain, Point2};

/// How far inside points near the boundary lie, as a share of the diagonal.
const NEAR: f64 = 1e-4;

/// Points at which methods are compared: inside, and along the boundary, a little off it.
struct Points {
    inside: Vec<Point2>,
    near: Vec<(Point2, f64)>,
}

fn points(domain: &PlanarDomain, data: &[[f64; 1]]) -> Points {
    let [low, high] = domain.bounds();
    let at = |i: usize, axis: usize| low[axis] + (high[axis] - low[axis]) * (i as f64 + 0.37) / 20.0;
    let inside = (0..400).map(|k| [at(k % 20, 0), at(k / 20, 1)]).filter(|&p| domain.contains(p)).collect();
    let step = NEAR * domain.diagonal();
    let n = domain.vertex_count();
    let along = |(i, [a, b]): (usize, [Point2; 2])| {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        (0..97).map(move |j| (j as f64 + 0.31) / 97.0).map(move |s| {
            let place = |k: usize| a[k] + s * (b[k] - a[k]);
            let point = [place(0) - step * (b[1] - a[1]) / length, place(1) + step * (b[0] - a[0]) / length];
            (point, i, s)
        })
    };
    let value = |i: usize, s: f64| data[i][0] * (1.0 - s) + data[(i + 1) % n][0] * s;
    let near = domain.edges().enumerate().flat_map(along).filter(|(p, ..)| domain.contains(*p));
    Points { inside, near: near.map(|(p, i, s)| (p, value(i, s))).collect() }
}

fn row(
    name: &str,
    unknowns: usize,
    made: f64,
    functions: &dyn HarmonicFunctions,
    points: &Points,
    truth: &dyn HarmonicFunctions,
) {
    let value = |of: &dyn HarmonicFunctions, point: Point2| {
        let mut value = [f64::NAN];
        of.values_into(point, &mut value).map_or(f64::NAN, |()| value[0])
    };
    let miss = |a: f64, b: f64| if (a - b).is_nan() { f64::INFINITY } else { (a - b).abs() };
    let inside = points.inside.iter().map(|&p| miss(value(functions, p), value(truth, p))).fold(0.0, f64::max);
    let near = points.near.iter().map(|&(p, known)| miss(value(functions, p), known)).fold(0.0, f64::max);
    let start = Instant::now();
    let sum: f64 = points.inside.iter().map(|&p| value(functions, p)).sum();
    let each = start.elapsed().as_secs_f64() / points.inside.len() as f64;
    assert!(sum.is_finite());
    println!("| {name} | {unknowns} | {inside:.1e} | {near:.1e} | {made:.3} | {:.1} |", 1e6 * each);
}

fn table(name: &str, domain: &PlanarDomain, values: &[[f64; 1]]) -> Result<(), Box<dyn Error>> {
    let data = BoundaryData::new(values, Profile::Linear)?;
    let fine = ElementParams { per_half_edge: 24, longest: 0.02, grading: 4.0 };
    let truth = BoundaryElements::new(domain, &fine)?.solve(&data)?;
    let points = points(domain, values);
    println!(
        "\n{name}: the reference has {} elements and a defect of {:.1e}\n",
        truth.element_count(),
        truth.boundary_defect()
    );
    println!("| method | unknowns | error inside | error by the boundary | seconds | microseconds a point |");
    println!("|---|---:|---:|---:|---:|---:|");
    for triangles in [1_000, 10_000, 100_000] {
        let start = Instant::now();
        let functions = FiniteElements::new(domain, &data, triangles)?;
        row("FEM", functions.unknown_count(), start.elapsed().as_secs_f64(), &functions, &points, &truth);
    }
    for per_half_edge in [2, 4, 8, 16] {
        let start = Instant::now();
        let params = ElementParams { per_half_edge, longest: f64::INFINITY, grading: 4.0 };
        let elements = BoundaryElements::new(domain, &params)?;
        let functions = elements.solve(&data)?;
        row("BEM", elements.unknown_count(), start.elapsed().as_secs_f64(), &functions, &points, &truth);
    }
    for sites in [50, 100, 200, 400] {
        let start = Instant::now();
        let functions = FundamentalSolutions::new(domain, &data, &FundamentalParams { sites, ..Default::default() })?;
        row("MFS", functions.unknown_count(), start.elapsed().as_secs_f64(), &functions, &points, &truth);
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let hexagon: Vec<[f64; 1]> = (0..6).map(|i| [(PI * f64::from(i) / 3.0).cos()]).collect();
    let ell = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [0.0, -1.0]];
    table("L, to the first coordinate of a regular hexagon", &PlanarDomain::new(vec![ell])?, &hexagon)?;
    let star: Vec<Point2> = (0..10)
        .map(|i| (PI * f64::from(i) / 5.0, if i % 2 == 0 { 1.0 } else { 0.4 }))
        .map(|(t, r)| [r * t.cos(), r * t.sin()])
        .collect();
    let decagon: Vec<[f64; 1]> = (0..10).map(|i| [(PI * f64::from(i) / 5.0).cos()]).collect();
    table(
        "Star of ten vertices, to the first coordinate of a regular decagon",
        &PlanarDomain::new(vec![star])?,
        &decagon,
    )
}
