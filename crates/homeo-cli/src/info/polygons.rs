//! Polygons, and pairs of polygons or rings that correspond by number.

use std::path::Path;

use homeo::progress::Progress;
use homeo_core::planar::{Point2 as Point, meeting_edges, turn};
use homeo_core::predicate::Sign;
use serde_json::{Value, json};

use super::{violation, violations_text};
use crate::answer::Answer;
use crate::failure::{Failure, Result};
use crate::session::Session;
use crate::text::{Lines, yes_no};

/// Magnitudes on which signs are exact.
const EXACT_RANGE: std::ops::RangeInclusive<f64> = 1e-90..=1e90;

/// Whether this looks like a polygon, or a pair of them.
pub fn is_polygons(value: &Value) -> bool {
    let is_list = |v: &Value| v.as_array().is_some_and(|a| a.first().is_some_and(Value::is_array));
    is_list(value) || (value.get("source").is_some() && value.get("target").is_some())
}

/// What is known of one closed polygon.
struct Ring {
    name: String,
    points: Vec<Point>,
    /// Sign of the area, exactly.
    turn: Sign,
    /// Edges that meet where they should not.
    crossings: Vec<[u32; 2]>,
}

/// Describes them.
pub fn describe(session: &Session, value: &Value, path: &Path) -> Result<Answer> {
    session.stage("check");
    let mut rings = Vec::new();
    collect(value, "", &mut rings)
        .map_err(|what| Failure::input("bad-syntax", format!("{}: {what}", path.display())))?;
    let rings: Vec<Ring> = rings
        .into_iter()
        .map(|(name, points)| Ring { turn: turn(&points), crossings: crossings(&points), name, points })
        .collect();
    session.check()?;
    let violations = violations(&rings);
    session.end_stage();
    let is_pair = value.get("source").is_some();
    let kind = match (value.get("kind").and_then(Value::as_str), is_pair) {
        (Some("annulus"), _) => "annulus-pair",
        (_, true) => "polygon-pair",
        _ => "polygon",
    };
    let mut lines = Lines::default();
    for ring in &rings {
        lines.add(
            &ring.name,
            format!(
                "{} vertices, simple: {}, {}",
                ring.points.len(),
                yes_no(ring.crossings.is_empty()),
                turn_word(ring.turn)
            ),
        );
    }
    let text = lines.below(&format!("{}: {kind}", path.display())) + &violations_text(&violations);
    let described: Vec<Value> = rings
        .iter()
        .map(|ring| {
            json!({
                "name": ring.name, "vertices": ring.points.len(), "simple": ring.crossings.is_empty(),
                "orientation": turn_word(ring.turn),
            })
        })
        .collect();
    let vertices: usize = rings.iter().map(|r| r.points.len()).sum();
    let fields = json!({
        "kind": kind, "name": value.get("name"), "vertices": vertices, "polygons": described,
        "simple": rings.iter().all(|r| r.crossings.is_empty()), "violations": violations,
        "input": {"path": path.display().to_string(), "vertices": vertices},
    });
    Ok(Answer::new(fields, text))
}

fn turn_word(turn: Sign) -> &'static str {
    match turn {
        Sign::Positive => "counter-clockwise",
        Sign::Negative => "clockwise",
        Sign::Zero => "flat",
    }
}

/// All rings in a value, by their names.
fn collect(value: &Value, name: &str, rings: &mut Vec<(String, Vec<Point>)>) -> std::result::Result<(), String> {
    if value.is_array() {
        let name = if name.is_empty() { "polygon" } else { name };
        rings.push((name.to_owned(), ring(value).map_err(|what| format!("{name}: {what}"))?));
        return Ok(());
    }
    for part in ["source", "target", "outer", "inner"] {
        if let Some(inside) = value.get(part) {
            let name = if name.is_empty() { part.to_owned() } else { format!("{name} {part}") };
            collect(inside, &name, rings)?;
        }
    }
    for (number, hole) in value.get("holes").and_then(Value::as_array).into_iter().flatten().enumerate() {
        collect(hole, format!("{name} hole {number}").trim_start(), rings)?;
    }
    if rings.is_empty() { Err(format!("{name} holds no polygon")) } else { Ok(()) }
}

/// Pairs of edges that meet away from a common end, the first hundred of them.
fn crossings(points: &[Point]) -> Vec<[u32; 2]> {
    meeting_edges(&[points.to_vec()], 100).into_iter().map(|[i, j]| [i.edge, j.edge]).collect()
}

fn ring(value: &Value) -> std::result::Result<Vec<Point>, String> {
    let rows = value.as_array().into_iter().flatten().enumerate();
    let point = |(row, value): (usize, &Value)| {
        let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
        let point: Point = numbers?.try_into().ok()?;
        point.iter().all(|x| *x == 0.0 || EXACT_RANGE.contains(&x.abs())).then_some(point).ok_or(row).ok()
    };
    rows.map(|row| point(row).ok_or_else(|| format!("vertex {} is no pair [x, y] of numbers of usual size", row.0)))
        .collect()
}

fn violations(rings: &[Ring]) -> Vec<Value> {
    let mut all = Vec::new();
    for ring in rings {
        let name = &ring.name;
        if ring.points.len() < 3 {
            let message = format!("{name} has {} vertices; a polygon needs three", ring.points.len());
            all.push(violation("too-few-corners", "error", "mesh", Vec::new(), 1, message));
            continue;
        }
        if let Some([i, j]) = ring.crossings.first() {
            let count = ring.crossings.len();
            let elements = ring.crossings.iter().take(10).flatten().copied().collect();
            let message = format!(
                "{name} is not simple: edges {i} and {j} meet ({count} such pairs); move vertices until none do"
            );
            all.push(violation("not-simple", "error", "edge-pair", elements, count, message));
        } else if ring.turn == Sign::Negative {
            let message = format!("{name} runs clockwise; reverse the order of its vertices");
            all.push(violation("clockwise", "warning", "mesh", Vec::new(), 1, message));
        }
    }
    for ring in rings {
        let Some(rest) = ring.name.strip_prefix("source") else { continue };
        let partner = rings.iter().find(|other| other.name.strip_prefix("target") == Some(rest));
        let (have, want) = (ring.points.len(), partner.map_or(0, |p| p.points.len()));
        if have != want {
            let message = format!(
                "{} has {have} vertices and target{rest} {want}; they correspond by number and must agree",
                ring.name
            );
            all.push(violation("counts-differ", "error", "mesh", Vec::new(), 1, message));
        }
    }
    all
}
