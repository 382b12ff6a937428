//! The polygons in between.

use homeo::shape::ShapePath;
use homeo_core::planar::{DomainPair, PlanarDomain};

use crate::args::MorphArgs;
use crate::failure::{Failure, Result};
use crate::warp::path::ways;

/// A polygon on the way, and by how many degrees its hole has turned, if the way says so.
pub struct Frame {
    pub shape: PlanarDomain,
    pub turn: Option<f64>,
}

/// When a frame is, from 0 to 1.
fn time(frame: usize, frames: usize) -> f64 {
    frame as f64 / (frames - 1) as f64
}

/// Which path was taken, and the polygon of every frame, each of which bounds a domain.
pub fn frames(pair: &DomainPair, options: &MorphArgs, turn: Option<f64>) -> Result<(&'static str, Vec<Frame>)> {
    let count = options.frames as usize;
    let mut reasons = Vec::new();
    for way in ways(pair, options.polygons.path, turn) {
        let found = way.and_then(|way| {
            // On other ways a hole turns by less than a half turn.
            if way.turn.is_none() && turn.is_some_and(|turn| turn.abs() > 180.0) {
                return Err(format!("{}: the hole does not turn so far on this way", way.name));
            }
            let shapes = shapes(&*way.path, count).map_err(|error| format!("{}: {error}", way.name))?;
            let turn = |frame: usize| way.turn.map(|turn| turn * time(frame, count));
            let frames = shapes.into_iter().enumerate().map(|(k, shape)| Frame { shape, turn: turn(k) });
            Ok((way.name, frames.collect()))
        });
        match found {
            Ok(found) => return Ok(found),
            Err(reason) => reasons.push(reason),
        }
    }
    let message = format!(
        "the polygons in between are not simple; nothing was written. {}. `homeo warp` needs no path",
        reasons.join("; ")
    );
    Err(Failure::limits("no-path", message))
}

fn shapes(path: &dyn ShapePath, count: usize) -> std::result::Result<Vec<PlanarDomain>, String> {
    (0..count)
        .map(|frame| {
            let time = time(frame, count);
            let rings = path.at(time).map_err(|e| e.to_string())?;
            PlanarDomain::new(rings).map_err(|e| format!("at time {time:.3} {e}"))
        })
        .collect()
}
