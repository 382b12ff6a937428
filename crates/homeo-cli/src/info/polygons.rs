//! Polygons, and pairs of polygons or rings that correspond by number.

use std::path::Path;

use homeo::progress::Progress;
use homeo_core::number::Rational;
use homeo_core::predicate::{Sign, orient2d};
use serde_json::{Value, json};

use super::{violation, violations_text};
use crate::answer::Answer;
use crate::failure::{Failure, Result};
use crate::session::Session;
use crate::text::{Lines, yes_no};

type Point = [f64; 2];

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
    if rings.is_empty() { Err(format!("{name} holds no polygon")) } else { Ok(()) }
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

/// The exact sign of the area.
fn turn(points: &[Point]) -> Sign {
    let exact = |x: f64| Rational::from_f64(x).unwrap_or(Rational::ZERO);
    let n = points.len();
    let area: Rational = (0..n)
        .map(|i| {
            let ([ax, ay], [bx, by]) = (points[i].map(exact), points[(i + 1) % n].map(exact));
            ax * by - bx * ay
        })
        .sum();
    area.sign()
}

/// Pairs of edges that meet away from a common end, the first hundred of them.
fn crossings(points: &[Point]) -> Vec<[u32; 2]> {
    let n = points.len();
    let edge = |i: usize| (points[i], points[(i + 1) % n]);
    let low = |i: usize, axis: usize| edge(i).0[axis].min(edge(i).1[axis]);
    let high = |i: usize, axis: usize| edge(i).0[axis].max(edge(i).1[axis]);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| low(i, 0).total_cmp(&low(j, 0)).then(i.cmp(&j)));
    let mut found = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        for &j in order[place + 1..].iter().take_while(|&&j| low(j, 0) <= high(i, 0)) {
            let apart = low(j, 1) > high(i, 1) || high(j, 1) < low(i, 1);
            if !apart && edges_meet(points, i.min(j), i.max(j)) {
                found.push([i.min(j) as u32, i.max(j) as u32]);
                if found.len() == 100 {
                    return found;
                }
            }
        }
    }
    found.sort_unstable();
    found
}

/// Whether edges `i < j` meet elsewhere than in a common end.
fn edges_meet(points: &[Point], i: usize, j: usize) -> bool {
    let n = points.len();
    let [a, b, c, d] = [i, (i + 1) % n, j, (j + 1) % n];
    let is_between = |p: Point, q: Point, r: Point| (0..2).all(|k| p[k].min(q[k]) <= r[k] && r[k] <= p[k].max(q[k]));
    let on = |p: usize, q: usize, r: usize| {
        orient2d(points[p], points[q], points[r]) == Sign::Zero && is_between(points[p], points[q], points[r])
    };
    if n < 3 || b == c && a == d {
        return true;
    }
    if b == c {
        // Neighbours: only a fold back on itself counts, or an edge of length zero.
        return on(a, b, d) || on(c, d, a);
    }
    if a == d {
        return on(a, b, c) || on(c, d, b);
    }
    let side = |p: usize, q: usize, r: usize| orient2d(points[p], points[q], points[r]);
    let (s, t, u, v) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    let opposite = |x: Sign, y: Sign| x != Sign::Zero && y == x.reversed();
    opposite(s, t) && opposite(u, v) || on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simplicity_is_exact() {
        assert!(crossings(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]).is_empty());
        assert_eq!(crossings(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]), [[0, 2]]);
        // A vertex on another edge, an edge that folds back, a repeated vertex.
        assert!(!crossings(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]]).is_empty());
        assert!(!crossings(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]]).is_empty());
        assert!(!crossings(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).is_empty());
        // Nearly touching, but not.
        let gap = 1.0f64.next_up();
        assert!(crossings(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, gap - 1.0], [0.0, 4.0]]).is_empty());
    }

    #[test]
    fn orientation_is_exact() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(turn(&square), Sign::Positive);
        let reversed: Vec<Point> = square.into_iter().rev().collect();
        assert_eq!(turn(&reversed), Sign::Negative);
    }
}
