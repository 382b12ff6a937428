//! Polygons from files.

use std::path::Path;

use homeo::shape::{ClosedSpline, sample_closed};
use homeo_core::planar::{DomainPair, PairError, PlanarDomain, Point2, RingPair, read_pair, read_rings, read_svg};
use serde_json::Value;

use crate::args::{MethodName, PolygonArgs, WarpArgs};
use crate::failure::{Failure, Result};

/// Refuses options of another method than the one that is asked for.
pub fn check_method(options: &WarpArgs) -> Result<()> {
    if options.degree.is_some() && options.method != Some(MethodName::Complex) {
        return Err(Failure::usage("--degree is that of the speeds of --method complex"));
    }
    let asked = match options.method {
        Some(MethodName::MeanValue) => "--method mean-value",
        Some(MethodName::Complex) => "--method complex",
        _ if options.landmarks.is_some() => "--landmarks",
        _ => return Ok(()),
    };
    match options.polygons.harmonic_option() {
        Some(name) => Err(Failure::usage(format!("{name} is for --method harmonic, not for {asked}"))),
        None => Ok(()),
    }
}

/// The pair that is asked for, and by how many degrees its hole shall turn.
pub fn read(options: &PolygonArgs) -> Result<(DomainPair, Option<f64>)> {
    let (rings, path) = match (&options.pair, &options.from, &options.to) {
        (Some(path), _, _) => (pair(path)?, path),
        (None, Some(from), Some(to)) => {
            (RingPair { source: rings(from)?, target: rings(to)?, turn_degrees: None }, from)
        }
        _ => return Err(Failure::usage("give --pair, or --from and --to: the polygons before and after")),
    };
    let turn = options.turn.or(rings.turn_degrees);
    let pair = DomainPair::new(rings.source, rings.target).map_err(|error| explain(path, &error))?;
    Ok((pair, turn))
}

/// By how many degrees harmonic maps turn a hole: they do as they are asked for one hole only.
pub fn turn_of_one_hole(options: &PolygonArgs, pair: &DomainPair, turn: Option<f64>) -> Result<Option<f64>> {
    match (pair.source.rings().len() > 2, options.turn) {
        (false, _) => Ok(turn),
        (true, None) => Ok(None),
        (true, Some(_)) => Err(Failure::usage(
            "--turn is for one hole; with several, harmonic maps take short ways between the holes to short ways",
        )),
    }
}

/// The source of a pair, or a polygon by itself. Like those of pairs, its rings may run either way round.
pub fn source(path: &Path) -> Result<PlanarDomain> {
    let rings = match is_drawing(path) {
        true => rings(path)?,
        false => {
            // Once, as it may be a pipe.
            let value = json(path)?;
            match value.get("source") {
                Some(_) => read_pair(&value).map(|pair| pair.source),
                None => read_rings(&value),
            }
            .map_err(|e| syntax(path, &e.to_string()))?
        }
    };
    Ok(DomainPair::new(rings.clone(), rings).map_err(|error| explain(path, &error))?.source)
}

/// So many samples are taken of a spline for each of its control points.
const SAMPLES: usize = 8;

/// A closed curve as a list of points; it may cross itself. One that is given by control points is sampled.
pub fn curve(path: &Path) -> Result<Vec<Point2>> {
    let mut rings = match is_drawing(path) {
        true => rings(path)?,
        false => {
            // Once, as it may be a pipe.
            let value = json(path)?;
            match value.get("control") {
                Some(control) => vec![sampled(path, control)?],
                None => read_rings(&value).map_err(|e| syntax(path, &e.to_string()))?,
            }
        }
    };
    match rings.pop() {
        Some(ring) if rings.is_empty() => Ok(ring),
        _ => {
            Err(Failure::input("bad-syntax", format!("{}: one closed curve is needed, without holes", path.display())))
        }
    }
}

/// Samples of the spline of some control points.
fn sampled(path: &Path, control: &Value) -> Result<Vec<Point2>> {
    let control: Vec<Point2> =
        serde_json::from_value(control.clone()).map_err(|e| syntax(path, &format!("control: {e}")))?;
    let spline = ClosedSpline::new(control).map_err(|e| syntax(path, &e.to_string()))?;
    Ok(sample_closed(|u| spline.at(u)[0], SAMPLES * spline.control().len()))
}

/// The files that are read.
pub fn paths(options: &PolygonArgs) -> Vec<&Path> {
    [&options.pair, &options.from, &options.to].into_iter().filter_map(|path| path.as_deref()).collect()
}

/// Curves of drawings become edges this near, as a part of the diagonal of their shape.
const TOLERANCE: f64 = 1e-3;

fn is_drawing(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg"))
}

/// The rings of a file, JSON or SVG.
pub fn rings(path: &Path) -> Result<Vec<Vec<Point2>>> {
    let found = match is_drawing(path) {
        true => read_svg(&text(path)?, TOLERANCE),
        false => read_rings(&json(path)?),
    };
    found.map_err(|e| syntax(path, &e.to_string()))
}

fn text(path: &Path) -> Result<String> {
    std::fs::read_to_string(path)
        .map_err(|e| Failure::input("cannot-open", format!("{} cannot be read: {e}", path.display())))
}

fn pair(path: &Path) -> Result<RingPair> {
    read_pair(&json(path)?).map_err(|e| syntax(path, &e.to_string()))
}

fn json(path: &Path) -> Result<Value> {
    let bytes = std::fs::read(path)
        .map_err(|e| Failure::input("cannot-open", format!("{} cannot be read: {e}", path.display())))?;
    serde_json::from_slice(&bytes).map_err(|e| syntax(path, &format!("not JSON: {e}")))
}

fn syntax(path: &Path, what: &str) -> Failure {
    Failure::input("bad-syntax", format!("{}: {what}", path.display()))
}

fn explain(path: &Path, error: &PairError) -> Failure {
    let code = match error {
        PairError::RingCounts(..) | PairError::VertexCounts { .. } => "counts-differ",
        PairError::Source(_) | PairError::Target(_) => "no-domain",
    };
    Failure::input(code, format!("{}: {error}", path.display()))
}
