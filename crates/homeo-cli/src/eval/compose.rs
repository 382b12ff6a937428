//! `homeo compose`: images under one map, and back under another onto the same shape.

use std::path::Path;

use homeo::certificate::StoredMap;
use homeo::map::Enclosed;
use homeo::progress::Progress;
use homeo_core::number::Rational;
use serde_json::json;

use super::images::{self, Direction, Image};
use super::{CHUNK, EXACT_CHUNK, check_columns, check_options, count_outside, in_chunks};
use crate::answer::Answer;
use crate::args::{ComposeArgs, EvalArgs};
use crate::failure::{Failure, Result};
use crate::inside;
use crate::outputs::{Outputs, check_target};
use crate::points::{self, PointFormat, Table, csv, npy};
use crate::proof;
use crate::session::Session;
use crate::text::{Lines, stages};

/// Evaluates the composite at points, or moves what a mesh carries.
pub fn run(session: &Session, options: &ComposeArgs, outputs: &mut Outputs) -> Result<Answer> {
    match &options.points {
        Some(points) => at_points(session, options, points, outputs),
        None => across(session, options, outputs),
    }
}

fn across(session: &Session, options: &ComposeArgs, outputs: &mut Outputs) -> Result<Answer> {
    let (first, first_claim) = proof::open_certified(session, &options.first)?;
    let (second, second_claim) = proof::open_certified(session, &options.second)?;
    check_targets(options, &first, &second)?;
    let certificates = json!([proof::claim_json(&first_claim), proof::claim_json(&second_claim)]);
    inside::across(session, options, [&first, &second], certificates, outputs)
}

fn at_points(session: &Session, options: &ComposeArgs, points: &Path, outputs: &mut Outputs) -> Result<Answer> {
    let forward = EvalArgs {
        map: options.first.clone(),
        points: points.to_path_buf(),
        inverse: false,
        exact: options.exact,
        outside: options.outside,
        output: options.output.clone(),
    };
    let format = check_options(session, &forward)?;
    if let Some(path) = &options.output {
        check_target(path, &[&options.second])?;
    }
    let (first, first_claim) = proof::open_certified(session, &options.first)?;
    let (second, second_claim) = proof::open_certified(session, &options.second)?;
    session.stage("read");
    check_targets(options, &first, &second)?;
    let done = if options.exact {
        exact(session, &forward, &first, &second)?
    } else {
        floating(session, &forward, [&first, &second], format)?
    };
    if done.outside > 0 {
        session.display().note(&format!("{} of {} points lie outside and became NaN", done.outside, done.count));
    }
    let certificates = json!([proof::claim_json(&first_claim), proof::claim_json(&second_claim)]);
    answer(session, options, certificates, done, outputs)
}

/// What came out.
struct Done {
    bytes: Vec<u8>,
    count: usize,
    outside: usize,
    /// The largest error in the common shape, and of the way back from there.
    radii: [f64; 2],
}

/// Both maps must lead to one standard shape.
fn check_targets(options: &ComposeArgs, first: &StoredMap, second: &StoredMap) -> Result<()> {
    let (StoredMap::Foliation(a), StoredMap::Foliation(b)) = (first, second) else {
        let message = "maps onto a square, disk, cube or ball can be composed, by `homeo map`: one of the files has another \
                       kind of map";
        return Err(Failure::input("kind", message));
    };
    if a.target() != b.target() {
        let message = format!(
            "{} leads to the {}, {} to the {}: make one of them anew with the other's --onto",
            options.first.display(),
            a.target(),
            options.second.display(),
            b.target()
        );
        return Err(Failure::input("targets", message));
    }
    Ok(())
}

fn floating(session: &Session, options: &EvalArgs, maps: [&StoredMap; 2], format: PointFormat) -> Result<Done> {
    let [first, second] = maps;
    let points = points::read(&options.points)?;
    check_columns(options, first, points.columns, |row| points.rows[row][2] == 0.0, points.rows.len())?;
    let answers = in_chunks(session, &points.rows, CHUNK, |rows| there_and_back(first, second, rows))?;
    let outside = count_outside(options, &answers)?;
    let largest = |part: fn(&(Enclosed, f64)) -> f64| answers.iter().flatten().map(part).fold(0.0, f64::max);
    let radii = [largest(|(_, middle)| *middle), largest(|(image, _)| image.radius)];
    let rows = answers.into_iter().map(|a| a.map_or([f64::NAN; 3], |(image, _)| image.point)).collect();
    let table = Table { columns: 3, rows };
    let bytes = match format {
        PointFormat::Npy => npy::encode(&table),
        PointFormat::Csv => csv::write_doubles(&table),
    };
    Ok(Done { bytes, count: table.rows.len(), outside, radii })
}

/// Images with their errors, and the errors in between.
fn there_and_back(first: &StoredMap, second: &StoredMap, rows: &[[f64; 3]]) -> Vec<Image<(Enclosed, f64)>> {
    let between = images::floating(first, Direction::Forward, rows);
    let reached: Vec<[f64; 3]> = between.iter().flatten().map(|image| image.point).collect();
    let mut back = images::floating(second, Direction::Inverse, &reached).into_iter();
    let mut go_on = |image: Enclosed| back.next().map(|end| end.map(|end| (end, image.radius)));
    between.into_iter().map(|image| image.map(&mut go_on)).filter_map(transposed).collect()
}

/// There is an end for each image; an image without one would be a bug, and is left out.
fn transposed<T>(image: Image<Option<Image<T>>>) -> Option<Image<T>> {
    match image {
        Ok(Some(end)) => Some(end),
        Ok(None) => None,
        Err(none) => Some(Err(none)),
    }
}

fn exact(session: &Session, options: &EvalArgs, first: &StoredMap, second: &StoredMap) -> Result<Done> {
    let bytes = points::bytes_of(&options.points)?;
    let points = csv::parse(&bytes, csv::rational)
        .map_err(|what| Failure::input("points", format!("{}: {what}", options.points.display())))?;
    check_columns(options, first, points.columns, |row| points.rows[row][2].is_zero(), points.rows.len())?;
    let answers = in_chunks(session, &points.rows, EXACT_CHUNK, |rows| {
        let back = |image: [Rational; 3]| images::exact(second, Direction::Inverse, &[image]).into_iter().next();
        let between = images::exact(first, Direction::Forward, rows);
        between.into_iter().map(|image| image.map(back)).filter_map(transposed).collect()
    })?;
    let outside = count_outside(options, &answers)?;
    let rows: Vec<Option<[Rational; 3]>> = answers.into_iter().map(std::result::Result::ok).collect();
    let bytes = csv::write_rationals(3, &rows);
    Ok(Done { bytes, count: rows.len(), outside, radii: [0.0; 2] })
}

fn answer(
    session: &Session,
    options: &ComposeArgs,
    certificates: serde_json::Value,
    done: Done,
    outputs: &mut Outputs,
) -> Result<Answer> {
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
    let [middle, back] = done.radii;
    lines.add(
        "error",
        if options.exact {
            "none (rationals)".to_owned()
        } else {
            format!("at most {middle:.1e} in the common shape, {back:.1e} on the way back")
        },
    );
    lines.add("time", stages(&session.seconds()));
    lines.add("written", path.display());
    let fields = json!({
        "points": done.count, "outside": done.outside, "exact": options.exact,
        "error": {"max_radius_between": middle, "max_radius": back},
        "certificates": certificates,
        "output": path.display().to_string(),
    });
    let title = format!("images under {} and back under {}", options.first.display(), options.second.display());
    Ok(Answer::new(fields, lines.below(&title)))
}
