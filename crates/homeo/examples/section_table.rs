//! Simplifies a mesh to 2 % in a shell, as `homeo simplify --to 2%` does, and remeshes it with three lengths of edges in
//! the first shell.
//!
//! Usage: `cargo run --release -p homeo --example section_table -- MESH [FEATURE_DEGREES] [FACTORS]`
//!
//! `FACTORS` are the lengths, relative to the mean length of edges, with commas between them: `0.5,1,2` unless said
//! otherwise; none, as `""`, to simplify only. Without features give 180 for their angle.
//!
//! Prints rows of a Markdown table: mesh, operation, triangles before and after, processor seconds (wall seconds where the
//! system does not tell; where 2 % are not reached in the first shell, those for the second shell and the section in it
//! count for the section), whether the independent checker certifies the result as a section of the same shell, pairs of
//! triangles of the result that meet in space, and, if the file has texture coordinates at corners, the triangles turned
//! over and the overlapping pairs in the texture plane, before and after. Exit code 1 if a result is not certified.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

use std::cell::RefCell;
use std::io::Cursor;
use std::ops::ControlFlow;
use std::process::ExitCode;
use std::time::Instant;

use homeo::certificate::{Provenance, write_shell};
use homeo::construct::section::{
    RemeshParams, SimplifyEnd, SimplifyParams, Texture, TexturedSurface, remesh, shells_in_turn, simplify_in_shells,
};
use homeo::construct::shell::build;
use homeo::input::SourceMesh;
use homeo::map::Shell;
use homeo::progress::{Progress, Silent};
use homeo_core::io::{Element, MeshFile, Values};
use homeo_core::mesh::SimplicialComplex;
use homeo_core::predicate::{Sign, orient2d};
use homeo_core::spatial::{Aabb, Tree};
use homeo_core::topology::self_intersections;
use homeo_verify::{Verdict, verify_bytes};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("{}: {message}", arguments.first().map_or("usage: section_table MESH", |path| path));
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<bool, String> {
    let path = arguments.first().ok_or("no mesh")?;
    let degrees = arguments.get(1).map(|text| text.parse::<f64>().map_err(|error| format!("{text}: {error}")));
    let feature_angle = degrees.transpose()?.map(f64::to_radians);
    let file = homeo_core::io::read_mesh(path.as_ref()).map_err(|error| error.to_string())?;
    let name = std::path::Path::new(path).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let start = textured(file)?;
    let count = start.surface.complex().cell_count();
    let [usual, steep] = shells_in_turn();
    let params = SimplifyParams { triangles: count / 50, feature_angle, largest_error: None };
    let timer = Timer::default();
    let made = simplify_in_shells(&start, &usual, &[steep], &params, &timer).map_err(|error| error.to_string())?;
    let [spent, on_section] = timer.seconds();
    for (number, attempt) in made.attempts.iter().enumerate() {
        let kept = if number == made.kept { "kept" } else { "tried" };
        let angle = attempt.largest_angle.to_degrees();
        match &attempt.outcome {
            Ok(outcome) => println!(
                "| {name} | shell {kept}, {angle:.2} degrees | {count} | {} prisms, {} triangles | {spent:.1} | | | |",
                outcome.prisms, outcome.triangles
            ),
            Err(error) => println!("| {name} | shell {kept}, {angle:.2} degrees | {count} | none: {error} | | | | |"),
        }
    }
    let mut is_all_certified = true;
    let mut row = |operation: &str, shell: &Shell, result: &TexturedSurface, seconds: f64| {
        let outcome = certified(shell, &result.surface);
        is_all_certified &= outcome == "yes";
        let crossing = self_intersections(result.surface.positions(), result.surface.complex()).pairs.len();
        let texture = match (&start.texture, &result.texture) {
            (Some(before), Some(after)) => {
                let ([f, o], [g, p]) = (turned_and_overlapping(before), turned_and_overlapping(after));
                format!("{f} to {g}, {o} to {p}")
            }
            _ => "-".to_owned(),
        };
        let after = result.surface.complex().cell_count();
        println!("| {name} | {operation} | {count} | {after} | {seconds:.1} | {outcome} | {crossing} | {texture} |");
    };
    let end = if made.info.end == SimplifyEnd::Reached { "simplify to 2 %" } else { "simplify to 2 %, none left" };
    row(end, &made.shell, &made.section, on_section);
    eprintln!("{:?}", made.info);
    let factors = arguments.get(2).map_or("0.5,1,2", |text| text);
    let factors: Vec<&str> = factors.split(',').filter(|text| !text.is_empty()).collect();
    let shell = match made.kept {
        0 => made.shell,
        _ if factors.is_empty() => return Ok(is_all_certified),
        _ => build(&start.surface, &usual, &Silent).map_err(|error| error.to_string())?.0,
    };
    for factor in factors {
        let factor: f64 = factor.parse().map_err(|error| format!("{factor}: {error}"))?;
        let begin = clock();
        let length = factor * mean_edge(&start.surface);
        let params = RemeshParams { feature_angle, ..RemeshParams::with_edge_length(length) };
        let (result, info) = remesh(&shell, &start, &params, &Silent).map_err(|error| error.to_string())?;
        row(&format!("remesh, {factor} x mean edge"), &shell, &result, seconds_since(&begin));
        eprintln!("{info:?}");
    }
    Ok(is_all_certified)
}

/// The triangles of a file, with the texture coordinates at their corners.
fn textured(file: MeshFile) -> Result<TexturedSurface, String> {
    let polygons = file.polygons.iter().map(|corners| corners.try_into().map_err(|_| "a polygon is no triangle"));
    let triangles = polygons.collect::<Result<Vec<[u32; 3]>, _>>()?;
    let texture = file.attributes.iter().find(|a| a.name == "texture" && a.element == Element::Corner);
    let texture = texture.and_then(|attribute| match &attribute.values {
        Values::F64(values) if attribute.components >= 2 && values.iter().all(|x| x.is_finite()) => {
            let coordinates = values.chunks(attribute.components).map(|row| [row[0], row[1]]).collect();
            let corners = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
            Some(Texture { coordinates, corners })
        }
        _ => None,
    });
    let complex =
        SimplicialComplex::from_indices(file.positions.len(), &triangles).map_err(|error| error.to_string())?;
    Ok(TexturedSurface { surface: SourceMesh::new(file.positions, complex), texture })
}

fn certified(shell: &Shell, section: &SourceMesh<3>) -> &'static str {
    let mut bytes = Cursor::new(Vec::new());
    let whole = Shell::from_parts(section.clone(), shell.parts().clone());
    if write_shell(&whole, &Provenance::default(), &mut bytes).is_err() {
        return "unwritten";
    }
    match verify_bytes(bytes.get_ref()) {
        Ok(Verdict::Certified(_)) => "yes",
        Ok(Verdict::Refuted(_)) => "NO",
        Ok(Verdict::Undecided(_)) => "undecided",
        Err(_) => "unreadable",
    }
}

/// Triangles that are turned over or flat in the texture plane, taking the more frequent orientation of each chart for the
/// right one, and pairs that have inner points in common, exactly.
fn turned_and_overlapping(texture: &Texture) -> [usize; 2] {
    let triangles: Vec<[[f64; 2]; 3]> =
        texture.corners.iter().map(|corners| corners.map(|k| texture.coordinates[k as usize])).collect();
    let signs: Vec<Sign> = triangles.iter().map(|&[a, b, c]| orient2d(a, b, c)).collect();
    let charts = charts(&triangles);
    let mut counts = vec![[0usize; 3]; triangles.len()];
    charts.iter().zip(&signs).for_each(|(&chart, &sign)| counts[chart][sign as usize] += 1);
    let turned = counts.iter().map(|[negative, flat, positive]| flat + negative.min(positive)).sum();
    let parts = |k: usize, other: [[f64; 2]; 3]| {
        let [a, b, c] = triangles[k];
        let beyond = |p, q| other.iter().all(|&x| orient2d(p, q, x) != signs[k]);
        beyond(a, b) || beyond(b, c) || beyond(c, a)
    };
    let boxes: Vec<Aabb> = triangles.iter().map(|t| Aabb::of(&t.map(|[x, y]| [x, y, 0.0]))).collect();
    let mut overlapping = 0;
    Tree::new(&boxes).overlapping_pairs(|i, j| {
        let are_solid = signs[i] != Sign::Zero && signs[j] != Sign::Zero;
        overlapping += usize::from(are_solid && !parts(i, triangles[j]) && !parts(j, triangles[i]));
        ControlFlow::Continue(())
    });
    [turned, overlapping]
}

/// A number for each triangle, the same for those that are joined by common edges in the texture plane.
fn charts(triangles: &[[[f64; 2]; 3]]) -> Vec<usize> {
    let mut edges: Vec<([[u64; 2]; 2], usize)> = Vec::with_capacity(3 * triangles.len());
    for (t, corners) in triangles.iter().enumerate() {
        for k in 0..3 {
            let mut ends = [k, (k + 1) % 3].map(|k| corners[k].map(f64::to_bits));
            ends.sort_unstable();
            edges.push((ends, t));
        }
    }
    edges.sort_unstable();
    let mut parent: Vec<usize> = (0..triangles.len()).collect();
    fn root(parent: &mut [usize], mut t: usize) -> usize {
        while parent[t] != t {
            parent[t] = parent[parent[t]];
            t = parent[t];
        }
        t
    }
    for pair in edges.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        let [a, b] = [pair[0].1, pair[1].1].map(|t| root(&mut parent, t));
        parent[a.max(b)] = a.min(b);
    }
    (0..triangles.len()).map(|t| root(&mut parent, t)).collect()
}

fn mean_edge(mesh: &SourceMesh<3>) -> f64 {
    let mut sum = 0.0;
    for cell in mesh.complex().cells() {
        for k in 0..3 {
            let [p, q] = [cell[k], cell[(k + 1) % 3]].map(|v| mesh.positions()[v.index()]);
            sum += (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt();
        }
    }
    sum / (3 * mesh.complex().cell_count()).max(1) as f64
}

/// When the first section was begun.
#[derive(Default)]
struct Timer(RefCell<Vec<(Instant, Option<f64>)>>);

impl Timer {
    /// Seconds until the first section was begun, and since then.
    fn seconds(&self) -> [f64; 2] {
        let moments = self.0.borrow();
        let [Some(first), Some(second)] = [moments.first(), moments.get(1)] else { return [0.0; 2] };
        let since = seconds_since(second);
        [seconds_since(first) - since, since]
    }
}

impl Progress for Timer {
    fn stage(&self, name: &'static str) {
        let mut moments = self.0.borrow_mut();
        if moments.is_empty() || (moments.len() == 1 && name == "section") {
            moments.push(clock());
        }
    }
}

/// Wall clock, and seconds that processors have spent on this process (Linux).
fn clock() -> (Instant, Option<f64>) {
    (Instant::now(), processor_seconds())
}

fn seconds_since((wall, processor): &(Instant, Option<f64>)) -> f64 {
    match (processor, processor_seconds()) {
        (Some(before), Some(after)) => after - before,
        _ => wall.elapsed().as_secs_f64(),
    }
}

fn processor_seconds() -> Option<f64> {
    let tasks = std::fs::read_dir("/proc/self/task").ok()?.flatten();
    let nanoseconds = tasks.filter_map(|task| {
        let text = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    });
    Some(nanoseconds.sum::<f64>() / 1e9)
}
