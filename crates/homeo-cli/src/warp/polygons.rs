//! Polygons from files.

use std::path::Path;

use homeo_core::planar::{DomainPair, PairError, PlanarDomain, Point2, RingPair, read_pair, read_rings};
use serde_json::Value;

use crate::args::PolygonArgs;
use crate::failure::{Failure, Result};

/// The pair that is asked for, and by how many degrees its hole shall turn.
pub fn read(options: &PolygonArgs) -> Result<(DomainPair, Option<f64>)> {
    let (rings, path) = match (&options.pair, &options.from, &options.to) {
        (Some(path), _, _) => (pair(path)?, path),
        (None, Some(from), Some(to)) => {
            let rings = |path: &Path| read_rings(&json(path)?).map_err(|e| syntax(path, &e.to_string()));
            (RingPair { source: rings(from)?, target: rings(to)?, turn_degrees: None }, from)
        }
        _ => return Err(Failure::usage("give --pair, or --from and --to: the polygons before and after")),
    };
    let turn = options.turn.or(rings.turn_degrees);
    let pair = DomainPair::new(rings.source, rings.target).map_err(|error| explain(path, &error))?;
    Ok((pair, turn))
}

/// The source of a pair, or a polygon by itself. Like those of pairs, its rings may run either way round.
pub fn source(path: &Path) -> Result<PlanarDomain> {
    let value = json(path)?;
    let rings = match value.get("source") {
        Some(_) => pair(path)?.source,
        None => read_rings(&value).map_err(|e| syntax(path, &e.to_string()))?,
    };
    Ok(DomainPair::new(rings.clone(), rings).map_err(|error| explain(path, &error))?.source)
}

/// A closed curve as a list of points; it may cross itself.
pub fn curve(path: &Path) -> Result<Vec<Point2>> {
    let mut rings = read_rings(&json(path)?).map_err(|e| syntax(path, &e.to_string()))?;
    match rings.pop() {
        Some(ring) if rings.is_empty() => Ok(ring),
        _ => {
            Err(Failure::input("bad-syntax", format!("{}: one closed curve is needed, without holes", path.display())))
        }
    }
}

/// The files that are read.
pub fn paths(options: &PolygonArgs) -> Vec<&Path> {
    [&options.pair, &options.from, &options.to].into_iter().filter_map(|path| path.as_deref()).collect()
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
