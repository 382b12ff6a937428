//! Composite mean value maps.

use homeo::composite::{CompositeInfo, CompositeMap, PartitionError, PartitionParams};
use homeo::shape::first_not_simple;
use homeo_core::planar::DomainPair;

use super::path::{Way, ways};
use crate::args::PolygonArgs;
use crate::failure::{Failure, Result};
use crate::session::Session;

/// So many polygons on a way are looked at before any of its maps is made.
const LOOKS: usize = 64;

/// How a map was made.
pub struct Made {
    pub path: &'static str,
    pub info: CompositeInfo,
}

/// The map by the first way on which there is one.
pub fn map(
    session: &Session,
    pair: &DomainPair,
    options: &PolygonArgs,
    turn: Option<f64>,
) -> Result<(CompositeMap, Made)> {
    let mut reasons = Vec::new();
    for way in ways(pair, options.path, turn) {
        match way.and_then(|way| along(session, way, turn)) {
            Ok(found) => return Ok(found),
            Err(reason) => reasons.push(reason),
        }
        session.check()?;
    }
    let message = format!(
        "no composite mean value map was found; nothing was written. {}. --method harmonic needs no path",
        reasons.join("; ")
    );
    Err(Failure::limits("no-map", message))
}

fn along(session: &Session, way: Way, turn: Option<f64>) -> std::result::Result<(CompositeMap, Made), String> {
    let named = |what: String| format!("{}: {what}", way.name);
    if way.turn.is_none() && turn.is_some_and(|turn| turn.abs() > 180.0) {
        return Err(named("the hole does not turn so far on this way".to_owned()));
    }
    if let Some(crossing) = first_not_simple(&*way.path, LOOKS).map_err(|e| named(e.to_string()))? {
        return Err(named(crossing.to_string()));
    }
    match CompositeMap::build(&*way.path, &PartitionParams::default(), session) {
        Ok((map, info)) => Ok((map, Made { path: way.name, info })),
        Err(PartitionError::Stopped(..)) => Err(named("stopped".to_owned())),
        Err(error) => Err(named(error.to_string())),
    }
}
