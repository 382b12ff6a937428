//! `homeo eval`: images of points, both ways, in floating point or exactly.

pub mod compose;
mod images;

use homeo::certificate::{FoliationMap, PlanarMap, StoredMap};
use homeo::progress::Progress;
use homeo_core::number::Rational;
use homeo_verify::Claim;
use serde_json::json;

use crate::answer::Answer;
use crate::args::{EvalArgs, Outside};
use crate::failure::{Failure, Result};
use crate::outputs::{Outputs, check_target};
use crate::points::{self, PointFormat, Table, csv, npy};
use crate::proof;
use crate::session::Session;
use crate::text::{Lines, stages};

use images::{Direction, Image, NoImage};

/// Points that are evaluated between two looks at the clock.
const CHUNK: usize = 4096;
/// The same for exact points, which take longer.
const EXACT_CHUNK: usize = 64;

/// Evaluates a map at points.
pub fn run(session: &Session, options: &EvalArgs, outputs: &mut Outputs) -> Result<Answer> {
    let format = check_options(session, options)?;
    let (map, claim) = proof::open_certified(session, &options.map)?;
    session.stage("read");
    let done = if options.exact { exact(session, options, &map)? } else { floating(session, options, &map, format)? };
    if done.outside > 0 {
        session.display().note(&format!("{} of {} points lie outside and became NaN", done.outside, done.count));
    }
    answer(session, options, &claim, done, outputs)
}

/// What came out.
struct Done {
    bytes: Vec<u8>,
    count: usize,
    outside: usize,
    max_radius: f64,
}

fn check_options(session: &Session, options: &EvalArgs) -> Result<PointFormat> {
    let input = PointFormat::of_path(&options.points)?;
    let output = options.output.as_deref().map_or(Ok(PointFormat::Csv), PointFormat::of_path)?;
    if options.exact && (input, output) != (PointFormat::Csv, PointFormat::Csv) {
        return Err(Failure::usage("--exact reads and writes .csv: .npy cannot hold rationals"));
    }
    match &options.output {
        Some(path) => check_target(path, &[&options.map, &options.points])?,
        None if session.common.json => {
            return Err(Failure::usage("--json takes standard output: give -o OUT for the points"));
        }
        None => {}
    }
    Ok(output)
}

fn answer(session: &Session, options: &EvalArgs, claim: &Claim, done: Done, outputs: &mut Outputs) -> Result<Answer> {
    let Some(path) = &options.output else {
        return Ok(Answer::new(json!({}), done.bytes));
    };
    session.stage("write");
    outputs.stage(session, path, |out| std::io::Write::write_all(out, &done.bytes).map_err(|e| e.to_string()))?;
    session.end_stage();
    let mut lines = Lines::default();
    lines.add("points", done.count);
    if done.outside > 0 {
        lines.add("outside", done.outside);
    }
    lines.add(
        "error",
        if options.exact { "none (rationals)".to_owned() } else { format!("at most {:.1e}", done.max_radius) },
    );
    lines.add("time", stages(&session.seconds()));
    lines.add("written", path.display());
    let fields = json!({
        "points": done.count, "outside": done.outside, "exact": options.exact,
        "direction": if options.inverse { "inverse" } else { "forward" },
        "error": {"max_radius": done.max_radius},
        "certificate": proof::claim_json(claim),
        "output": path.display().to_string(),
    });
    let way = if options.inverse { "inverse images" } else { "images" };
    Ok(Answer::new(fields, lines.below(&format!("{way} under {}", options.map.display()))))
}

fn direction_of(options: &EvalArgs) -> Direction {
    if options.inverse { Direction::Inverse } else { Direction::Forward }
}

fn floating(session: &Session, options: &EvalArgs, map: &StoredMap, format: PointFormat) -> Result<Done> {
    let points = points::read(&options.points)?;
    check_columns(options, map, points.columns, |row| points.rows[row][2] == 0.0, points.rows.len())?;
    let answers = in_chunks(session, &points.rows, CHUNK, |rows| images::floating(map, direction_of(options), rows))?;
    let outside = count_outside(options, &answers)?;
    let max_radius = answers.iter().flatten().map(|a| a.radius).fold(0.0, f64::max);
    let rows = answers.into_iter().map(|a| a.map_or([f64::NAN; 3], |a| a.point)).collect();
    let table = Table { columns: output_columns(options, map), rows };
    let bytes = match format {
        PointFormat::Npy => npy::encode(&table),
        PointFormat::Csv => csv::write_doubles(&table),
    };
    Ok(Done { bytes, count: table.rows.len(), outside, max_radius })
}

fn exact(session: &Session, options: &EvalArgs, map: &StoredMap) -> Result<Done> {
    if let StoredMap::Planar(PlanarMap::Composite(_) | PlanarMap::Complex(_)) | StoredMap::Cages(_) = map {
        let message = "composite mean value maps and complex maps take rational points to others that are not: leave out \
                       --exact for images with a bound of their error";
        return Err(Failure::input("no-exact-images", message));
    }
    let bytes = points::bytes_of(&options.points)?;
    let points = csv::parse(&bytes, csv::rational)
        .map_err(|what| Failure::input("points", format!("{}: {what}", options.points.display())))?;
    check_columns(options, map, points.columns, |row| points.rows[row][2].is_zero(), points.rows.len())?;
    let answers =
        in_chunks(session, &points.rows, EXACT_CHUNK, |rows| images::exact(map, direction_of(options), rows))?;
    let outside = count_outside(options, &answers)?;
    let rows: Vec<Option<[Rational; 3]>> = answers.into_iter().map(std::result::Result::ok).collect();
    let bytes = csv::write_rationals(output_columns(options, map), &rows);
    Ok(Done { bytes, count: rows.len(), outside, max_radius: 0.0 })
}

fn in_chunks<P, A>(session: &Session, rows: &[P], size: usize, batch: impl Fn(&[P]) -> Vec<A>) -> Result<Vec<A>> {
    session.stage("evaluate");
    session.display().begin_count(rows.len() as u64, "evaluate");
    let mut answers = Vec::with_capacity(rows.len());
    for chunk in rows.chunks(size) {
        answers.extend(batch(chunk));
        session.display().advance(chunk.len() as u64);
        session.check()?;
    }
    session.display().end_count();
    Ok(answers)
}

/// Two columns are points of the plane; three are points of space, in the plane `z = 0` where a plane shape is asked for.
fn check_columns(
    options: &EvalArgs,
    map: &StoredMap,
    columns: usize,
    is_planar: impl Fn(usize) -> bool,
    rows: usize,
) -> Result<()> {
    let wrong = |what: String| Failure::input("points", format!("{}: {what}", options.points.display()));
    let (name, dimension, flat_source) = match map {
        StoredMap::Foliation(map) => (map.target().name(), map.target().dimension(), is_flat(map)),
        StoredMap::Shell(_) => ("shell", 3, false),
        StoredMap::Planar(_) => ("polygon", 2, true),
        StoredMap::Moved(_) => ("moved mesh", 3, false),
        StoredMap::Cages(_) => ("cage", 3, false),
    };
    if dimension == 2 && (options.inverse || matches!(map, StoredMap::Planar(_))) {
        return match (0..rows).find(|&row| !is_planar(row)) {
            Some(row) => {
                Err(wrong(format!("row {}: the third coordinate of a point of the {name} must be 0", row + 1)))
            }
            None => Ok(()),
        };
    }
    if columns == 2 && (options.inverse || !flat_source) {
        let is_in_target = options.inverse || matches!(map, StoredMap::Shell(_));
        let where_to = if is_in_target { name } else { "mesh" };
        return Err(wrong(format!("points of the {where_to} have three coordinates: x,y,z")));
    }
    Ok(())
}

/// Whether the source lies in the plane `z = 0`.
fn is_flat(map: &FoliationMap) -> bool {
    match map {
        FoliationMap::Surface(map) => map.source().positions().iter().all(|p| p[2] == 0.0),
        FoliationMap::Volume(_) => false,
    }
}

fn output_columns(options: &EvalArgs, map: &StoredMap) -> usize {
    match map {
        StoredMap::Foliation(map) if !options.inverse => map.target().dimension(),
        StoredMap::Planar(_) => 2,
        _ => 3,
    }
}

/// How many points have no image; an error where that is not allowed.
fn count_outside<I>(options: &EvalArgs, answers: &[Image<I>]) -> Result<usize> {
    let tolerated = |error: &NoImage| options.outside == Outside::Nan && !error.is_ambiguous();
    let mut wrong = answers.iter().enumerate().filter_map(|(row, a)| a.as_ref().err().map(|e| (row, e)));
    if let Some((row, error)) = wrong.clone().find(|(_, e)| !tolerated(e)) {
        let others = wrong.clone().count() - 1;
        let more = if others > 0 { format!(" ({others} more rows have no image)") } else { String::new() };
        let advice = if error.is_ambiguous() { "" } else { "; --outside nan gives NaN instead" };
        let message = format!("{}: row {}: {error}{more}{advice}", options.points.display(), row + 1);
        return Err(Failure::input("outside", message).with("row", row + 1).with("rows_without_image", others + 1));
    }
    Ok(wrong.by_ref().count())
}
