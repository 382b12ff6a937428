//! Tables and pictures of two limits: there and back over many steps, and curvature from samples.
//!
//! Usage: `cargo run --release -p homeo --example curve_tables -- inverse | curvature | squares [FOLDER]`
//!
//! Prints a Markdown table; the first two write a picture into the folder, too, if one is given. Ends with exit code 2 if it
//! is called otherwise, and 1 if a map is not proved or a file cannot be written.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::process::ExitCode;
use std::time::Instant;

use homeo::composite::{CompositeMap, JacobianLimits, PartitionParams};
use homeo::coordinates::{MeanValue, PlanarCoordinates};
use homeo::progress::Silent;
use homeo::shape::{CurvatureProfile, LinearPath, ShapePath, sample_closed};
use homeo_core::planar::{DomainPair, PlanarDomain, Point2};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [table, folder @ ..] = arguments.as_slice() else {
        eprintln!("usage: curve_tables inverse | curvature | squares [FOLDER]");
        return ExitCode::from(2);
    };
    let done = match table.as_str() {
        "inverse" => inverse(),
        "curvature" => curvature(),
        "squares" => squares().map(|()| Vec::new()),
        other => Err(format!("there is no table {other}: take inverse, curvature or squares").into()),
    };
    let written = done.and_then(|lines| match folder.first() {
        Some(folder) if !lines.is_empty() => {
            Ok(std::fs::write(format!("{folder}/{table}.svg"), picture(table, &lines))?)
        }
        _ => Ok(()),
    });
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Numbers from 0 to 1, from a fixed seed.
fn random() -> impl FnMut() -> f64 {
    let mut state = 5u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 2f64.powi(53)
    }
}

/// A line of a diagram: what it is, and its points.
type Line = (String, Vec<[f64; 2]>);

/// A star whose teeth turn by a quarter of one: figure 4.7 has such a thing.
fn star(turn: f64) -> Vec<Point2> {
    let corner = |k: u32| {
        let radius = if k.is_multiple_of(2) { 1.0 } else { 0.5 };
        let angle = TAU * (f64::from(k) / 10.0 + turn);
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..10).map(corner).collect()
}

/// A square that becomes a dart: the straight way, on which a single step folds.
fn dart() -> [Vec<Point2>; 2] {
    let square = vec![[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let dart = vec![[1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.0, -1.0]];
    [square, dart]
}

/// `max |x - g_m(f_m(x))|` with the same uniform steps there and back.
fn inverse() -> Outcome<Vec<Line>> {
    let swollen: Vec<Point2> = star(0.08).into_iter().map(|[x, y]| [1.3 * x + 0.1 * y * y, y]).collect();
    let [square, dart] = dart();
    let mut lines = Vec::new();
    println!("| steps | star: greatest distance | order | square to dart | order |\n|---:|---:|---:|---:|---:|");
    for (name, source, target) in [("star", star(0.0), swollen), ("square to dart", square, dart)] {
        let pair = DomainPair::new(vec![source], vec![target])?;
        let path = LinearPath::between(&pair)?;
        let points = inside(&pair.source, 10_000);
        let mut line = Vec::new();
        for exponent in 0..10 {
            let steps = 1usize << exponent;
            line.push([steps as f64, there_and_back(&path, steps, &points)?]);
        }
        lines.push((name.to_owned(), line));
    }
    let order = |line: &[[f64; 2]], row: usize| match row {
        0 => String::new(),
        _ => format!("{:.3}", (line[row - 1][1] / line[row][1]).log2()),
    };
    for row in 0..10 {
        let columns = lines.iter().map(|(_, line)| format!("{:.3e} | {}", line[row][1], order(line, row)));
        println!("| {} | {} |", 1 << row, columns.collect::<Vec<_>>().join(" | "));
    }
    Ok(lines)
}

/// Random points of a domain.
fn inside(domain: &PlanarDomain, count: usize) -> Vec<Point2> {
    let (mut next, [low, high]) = (random(), domain.bounds());
    let draws = std::iter::repeat_with(|| std::array::from_fn(|k| low[k] + next() * (high[k] - low[k])));
    draws.filter(|&point| domain.contains(point)).take(count).collect()
}

fn there_and_back(path: &LinearPath, steps: usize, points: &[Point2]) -> Outcome<f64> {
    let domain = |k: usize| -> Outcome<PlanarDomain> { Ok(PlanarDomain::new(path.at(k as f64 / steps as f64)?)?) };
    let domains = (0..=steps).map(domain).collect::<Outcome<Vec<_>>>()?;
    let mut moved = points.to_vec();
    let there = (0..steps).map(|k| (k, k + 1));
    let back = (0..steps).rev().map(|k| (k + 1, k));
    for (from, to) in there.chain(back) {
        let kind = MeanValue::new(&domains[from]);
        let images: Vec<Point2> = domains[to].vertices().collect();
        let mut values = vec![0.0; images.len()];
        for point in &mut moved {
            kind.values_into(*point, &mut values)?;
            *point = std::array::from_fn(|k| values.iter().zip(&images).map(|(value, image)| value * image[k]).sum());
        }
    }
    let distance = |(a, b): (&Point2, &Point2)| (a[0] - b[0]).hypot(a[1] - b[1]);
    Ok(points.iter().zip(&moved).map(distance).fold(0.0, f64::max))
}

/// A curve by its parameter from 0 to 1: the point, and its first and second derivative.
type Curve = fn(f64) -> [[f64; 2]; 3];

fn ellipse(u: f64) -> [[f64; 2]; 3] {
    let (s, c) = (TAU * u).sin_cos();
    [[2.0 * c, s], [-2.0 * TAU * s, TAU * c], [-2.0 * TAU * TAU * c, -TAU * TAU * s]]
}

/// A limaçon without a loop: `(3 + 2 cos v)` along the direction `v`.
fn limacon(u: f64) -> [[f64; 2]; 3] {
    let v = TAU * u;
    let ((s, c), (s2, c2)) = (v.sin_cos(), (2.0 * v).sin_cos());
    let point = [3.0 * c + 1.0 + c2, 3.0 * s + s2];
    let first = [TAU * (-3.0 * s - 2.0 * s2), TAU * (3.0 * c + 2.0 * c2)];
    [point, first, [TAU * TAU * (-3.0 * c - 4.0 * c2), TAU * TAU * (-3.0 * s - 4.0 * s2)]]
}

/// A closed curve that crosses itself, of curvatures of both signs.
fn eight(u: f64) -> [[f64; 2]; 3] {
    let ((s, c), (s2, c2)) = ((TAU * u).sin_cos(), (2.0 * TAU * u).sin_cos());
    let square = TAU * TAU;
    [[2.0 * c, s2], [-2.0 * TAU * s, 2.0 * TAU * c2], [-2.0 * square * c, -4.0 * square * s2]]
}

/// The error of curvature in the mean of squares over the arc length, for length 1.
fn curvature() -> Outcome<Vec<Line>> {
    let curves: [(&str, Curve); 3] = [("ellipse", ellipse), ("limaçon", limacon), ("eight", eight)];
    let mut lines: Vec<Line> = Vec::new();
    for (name, curve) in curves {
        let counts = [10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10_000, 20_000, 50_000];
        let line = counts.iter().map(|&count| Ok([count as f64, curvature_error(curve, count)?]));
        lines.push((name.to_owned(), line.collect::<Outcome<_>>()?));
    }
    println!("| samples | ellipse | order | limaçon | order | eight | order |\n|---:|---:|---:|---:|---:|---:|---:|");
    for row in 0..lines[0].1.len() {
        let column = |line: &Vec<[f64; 2]>| {
            let order = |[n, e]: [f64; 2]| format!("{:.3}", (e / line[row][1]).ln() / (line[row][0] / n).ln());
            format!("{:.3e} | {}", line[row][1], if row == 0 { String::new() } else { order(line[row - 1]) })
        };
        let columns: Vec<String> = lines.iter().map(|(_, line)| column(line)).collect();
        println!("| {} | {} |", lines[0].1[row][0], columns.join(" | "));
    }
    Ok(lines)
}

fn curvature_error(curve: Curve, count: usize) -> Outcome<f64> {
    let profile = CurvatureProfile::new(&sample_closed(|u| curve(u)[0], count))?;
    // The true length: even steps of a periodic analytic function, exact to rounding.
    let speed = |u: f64| curve(u)[1][0].hypot(curve(u)[1][1]);
    let length = (0..4096).map(|i| speed(f64::from(i) / 4096.0)).sum::<f64>() / 4096.0;
    let true_curvature = |u: f64| {
        let [_, [a, b], [c, d]] = curve(u);
        length * (a * d - b * c) / a.hypot(b).powi(3)
    };
    let (nodes, values) = (profile.nodes(), profile.values());
    let error = |i: usize| values[i] - true_curvature(i as f64 / count as f64);
    let weight = |i: usize| 0.5 * (nodes[i + 1] - if i == 0 { nodes[count - 1] - 1.0 } else { nodes[i - 1] });
    Ok((0..count).map(|i| weight(i) * error(i).powi(2)).sum::<f64>().sqrt())
}

/// Figure 4.6: an inner square that turns by a right angle in 1000 uniform steps, each proved.
fn squares() -> Outcome<()> {
    let outer = vec![[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let inner = vec![[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
    let mut turned = inner.clone();
    turned.rotate_left(1);
    let path = LinearPath::new(vec![outer.clone(), inner], vec![outer, turned])?;
    println!("| steps | least determinant | boxes | seconds |\n|---:|---:|---:|---:|");
    for steps in [10, 100, 1000] {
        let limits = JacobianLimits { sharpness: 0.0, ..JacobianLimits::default() };
        let params = PartitionParams { steps, limits, ..PartitionParams::default() };
        let times: Vec<f64> = (0..=steps).map(|k| k as f64 / steps as f64).collect();
        let start = Instant::now();
        match CompositeMap::at_times(&path, &times, &params, &Silent) {
            Ok((_, info)) => {
                let seconds = start.elapsed().as_secs_f64();
                println!("| {steps} | {:.3e} | {} | {seconds:.1} |", info.least_determinant, info.boxes);
            }
            Err(error) => println!("| {steps} | {error} | | {:.1} |", start.elapsed().as_secs_f64()),
        }
    }
    Ok(())
}

/// Colours that are told apart on white and on black.
const COLOURS: [&str; 3] = ["#1f7fd0", "#d9661f", "#3a9d4f"];

/// A diagram with logarithmic axes.
fn picture(table: &str, lines: &[Line]) -> String {
    let down = match table {
        "inverse" => "steps, against the greatest distance from there and back",
        _ => "samples, against the error of curvature in the mean of squares",
    };
    let all = || lines.iter().flat_map(|(_, line)| line.iter().map(|point| point.map(f64::log10)));
    let ends = |k: usize| {
        let (low, high) = all().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p[k]), high.max(p[k])));
        [low.floor(), high.ceil()]
    };
    let ranges = [ends(0), ends(1)];
    let place = |p: [f64; 2]| {
        let part = |k: usize| (p[k] - ranges[k][0]) / (ranges[k][1] - ranges[k][0]);
        [70.0 + 480.0 * part(0), 350.0 - 310.0 * part(1)]
    };
    let mut text = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 400\" font-family=\"sans-serif\" font-size=\"14\" \
         fill=\"#808080\">\n",
    );
    for (k, [low, high]) in ranges.into_iter().enumerate() {
        for decade in low as i32..=high as i32 {
            let mut ends = [[ranges[0][0], ranges[1][0]], [ranges[0][1], ranges[1][1]]];
            ends.iter_mut().for_each(|end| end[k] = f64::from(decade));
            let [[a, b], [c, d]] = ends.map(place);
            let _ =
                writeln!(text, "<path d=\"M{a:.1} {b:.1}L{c:.1} {d:.1}\" stroke=\"#808080\" stroke-opacity=\".4\"/>");
            let [x, y] = if k == 0 { [a - 14.0, b + 20.0] } else { [a - 52.0, b + 5.0] };
            let _ = writeln!(text, "<text x=\"{x:.1}\" y=\"{y:.1}\">1e{decade}</text>");
        }
    }
    for ((number, (name, line)), colour) in lines.iter().enumerate().zip(COLOURS.iter().cycle()) {
        let points = line.iter().map(|point| place(point.map(f64::log10)));
        let points: Vec<String> = points.map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let points = points.join(" ");
        let _ =
            writeln!(text, "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2.5\"/>");
        let y = 60 + 20 * number;
        let _ = writeln!(text, "<text x=\"420\" y=\"{y}\" fill=\"{colour}\">{name}</text>");
    }
    let _ = writeln!(text, "<text x=\"70\" y=\"392\">{down}</text>\n</svg>");
    text
}
