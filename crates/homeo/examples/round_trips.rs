//! Sends random rational points through a map and back, exactly and in floating point.
//!
//! Usage: `cargo run --release -p homeo --example round_trips -- MESH TARGET [POINTS]`
//!
//! Checked for each point `p` (10,000 unless said otherwise): `inverse(forward(p)) == p` as rationals; the image lies
//! in the target, and in its boundary if `p` is one of the boundary points (every fourth is); the floating-point
//! image of the nearest double encloses its exact image (cube only: the exact ball is a polyhedron).
//! Prints one row of a Markdown table, and ends with exit code 1 at the first failure.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

use std::process::ExitCode;

use homeo::construct::foliation::{FoliationParams, build};
use homeo::input::SourceMesh;
use homeo::map::{BALL_CORNERS, Bijection, Enclosed, EvaluationError, Foliation, Target};
use homeo::progress::Silent;
use homeo_core::mesh::{CellId, SimplicialComplex};
use homeo_core::number::Rational;
use rayon::prelude::*;

type Point = [Rational; 3];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [path, target, rest @ ..] = arguments.as_slice() else {
        eprintln!("usage: round_trips MESH TARGET [POINTS]");
        return ExitCode::from(2);
    };
    match run(path, target, rest.first()) {
        Ok(row) => {
            println!("{row}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{path} onto {target}: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(path: &str, target: &str, points: Option<&String>) -> Result<String, String> {
    let file = homeo_core::io::read_mesh(path.as_ref()).map_err(|error| error.to_string())?;
    let target: Target = target.parse().map_err(|error| format!("{error}"))?;
    let points: usize = points.map_or(Ok(10_000), |text| text.parse()).map_err(|error| format!("{error}"))?;
    let name = std::path::Path::new(path).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let row = if file.tetrahedra.is_empty() {
        let polygons =
            file.polygons.iter().map(|corners| corners.try_into().map_err(|_| "a polygon is no triangle".into()));
        let triangles = polygons.collect::<Result<Vec<[u32; 3]>, String>>()?;
        try_points::<3>(file.positions, &triangles, target, points)
    } else {
        try_points::<4>(file.positions, &file.tetrahedra, target, points)
    }?;
    Ok(format!("| {name} | {target} | {row} |"))
}

/// What became of one point.
struct Trip {
    cells: usize,
    /// Distance by which the floating-point round trip misses, and what it had stated.
    float_miss: f64,
    float_radius: f64,
}

fn try_points<const K: usize>(
    positions: Vec<[f64; 3]>,
    cells: &[[u32; K]],
    target: Target,
    count: usize,
) -> Result<String, String> {
    let complex = SimplicialComplex::<K>::from_indices(positions.len(), cells).map_err(|error| error.to_string())?;
    let source = SourceMesh::new(positions, complex);
    let (map, _) = build(&source, target, &FoliationParams::default(), &Silent).map_err(|error| error.to_string())?;
    let adjacency = source.complex().adjacency().map_err(|error| error.to_string())?;
    let boundary: Vec<(CellId, usize)> =
        adjacency.boundary_facets().map(|facet| (facet.cell(), facet.opposite())).collect();
    let trips: Vec<Trip> = (0..count as u64)
        .into_par_iter()
        .map(|number| {
            let mut random = Random(number.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
            let is_boundary = number % 4 == 0;
            let (cell, facet) = if is_boundary {
                let (cell, opposite) = boundary[random.below(boundary.len())];
                (cell, Some(opposite))
            } else {
                (CellId::new(random.below(source.complex().cell_count())), None)
            };
            let point = point_in(&source, cell, facet, &mut random);
            try_point(&map, &point, is_boundary)
        })
        .collect::<Result<_, String>>()?;
    let largest = |of: fn(&Trip) -> f64| trips.iter().map(of).fold(0.0, f64::max);
    let crossed: usize = trips.iter().map(|trip| trip.cells).sum();
    Ok(format!(
        "{} | {count} | {:.1} | {:.1e} | {:.1e}",
        source.complex().cell_count(),
        crossed as f64 / count as f64,
        largest(|trip| trip.float_miss),
        largest(|trip| trip.float_radius)
    ))
}

/// A rational point of a cell, or of one of its facets.
fn point_in<const K: usize>(
    source: &SourceMesh<K>,
    cell: CellId,
    without: Option<usize>,
    random: &mut Random,
) -> Point {
    let corners = source.complex().cell(cell).map(|v| source.positions()[v.index()]);
    let mut weights = [0; K].map(|_| random.below(1000) as i64 + 1);
    if let Some(corner) = without {
        weights[corner] = 0;
    }
    let sum = Rational::from(weights.iter().sum::<i64>());
    std::array::from_fn(|axis| {
        let terms = (0..K).map(|k| &Rational::from(weights[k]) * &exact(corners[k][axis]));
        &terms.sum::<Rational>() / &sum
    })
}

fn try_point<const K: usize>(map: &Foliation<K>, point: &Point, is_boundary: bool) -> Result<Trip, String> {
    let place = point.each_ref().map(Rational::to_f64);
    let failed = |what: &str| format!("{what} at {place:?}");
    let image = map.forward_exact(point).map_err(|error| failed(&error.to_string()))?;
    let heights = heights(map.target(), &image);
    if heights.iter().any(|height| *height < Rational::ZERO) {
        return Err(failed("the image lies outside the target"));
    }
    if is_boundary && !heights.contains(&Rational::ZERO) {
        return Err(failed("the image of a boundary point lies inside the target"));
    }
    if map.inverse_exact(&image).map_err(|error| failed(&error.to_string()))? != *point {
        return Err(failed("the exact round trip leads elsewhere"));
    }
    let cells = map.leaf_cells(point).map_err(|error| failed(&error.to_string()))?;
    // The double nearest to a boundary point may lie outside a solid.
    let Ok(forward) = map.forward(place) else {
        return if is_boundary && K == 4 {
            Ok(Trip { cells, float_miss: 0.0, float_radius: 0.0 })
        } else {
            Err(failed("no floating-point image"))
        };
    };
    if K == 4 && !map.target().is_radial() {
        // A boundary point's double may lie outside, by rounding: its answer is then that of a near point of the mesh.
        match map.forward_exact(&place.map(exact)) {
            Err(EvaluationError::OutsideSource) if is_boundary => {}
            Err(error) => return Err(failed(&error.to_string())),
            Ok(truth) if is_enclosed(&forward, &truth) => {}
            Ok(_) => return Err(failed("the floating-point image is further off than stated")),
        }
    }
    let back = map.inverse(forward.point).map_err(|error| failed(&error.to_string()))?;
    let float_miss = (0..3).map(|axis| (back.point[axis] - place[axis]).abs()).fold(0.0, f64::max);
    Ok(Trip { cells, float_miss, float_radius: forward.radius })
}

/// Whether the exact point lies within the stated radius.
fn is_enclosed(answer: &Enclosed, truth: &Point) -> bool {
    let radius = exact(answer.radius);
    (0..3).all(|axis| {
        let (there, here) = (&truth[axis], exact(answer.point[axis]));
        there - &here <= radius && &here - there <= radius
    })
}

/// Heights above the sides of the exact target: none negative inside, one of them 0 on the boundary.
fn heights(target: Target, q: &Point) -> Vec<Rational> {
    let one = &Rational::ONE;
    let sum =
        |signs: [i32; 3]| -> Rational { (0..3).map(|axis| &Rational::from(i64::from(signs[axis])) * &q[axis]).sum() };
    match target {
        Target::Square | Target::Cube => q.iter().take(target.dimension()).flat_map(|x| [x.clone(), one - x]).collect(),
        Target::Disk => [[1, 1, 0], [1, -1, 0], [-1, 1, 0], [-1, -1, 0]].map(|signs| one - &sum(signs)).to_vec(),
        Target::Ball => BALL_CORNERS.map(|corner| &(one / &Rational::from(2)) + &sum(corner)).to_vec(),
    }
}

fn exact(value: f64) -> Rational {
    Rational::from_f64(value).unwrap_or(Rational::ZERO)
}

/// A generator of numbers that repeats in every run (xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % limit
    }
}
