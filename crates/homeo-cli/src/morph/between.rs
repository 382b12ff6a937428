//! The polygons in between.

use homeo::shape::{LengthsAndAngles, LinearPath, ShapePath};
use homeo_core::planar::{DomainPair, PlanarDomain};

use crate::args::{MorphArgs, PathName};
use crate::failure::{Failure, Result};

/// When a frame is, from 0 to 1.
fn time(frame: usize, frames: usize) -> f64 {
    frame as f64 / (frames - 1) as f64
}

/// Which path was taken, and the polygon of every frame, each of which bounds a domain.
pub fn shapes(pair: &DomainPair, options: &MorphArgs) -> Result<(&'static str, Vec<PlanarDomain>)> {
    let (source, target) = (pair.source.rings(), pair.target.rings());
    let straight = || {
        let path = LinearPath::new(source.to_vec(), target.to_vec()).map_err(|e| e.to_string());
        ("straight", path.and_then(|path| frames(&path, options.frames as usize)))
    };
    let angles = || {
        if source.len() > 1 {
            return ("angles", Err("it is for polygons without holes".to_owned()));
        }
        let path = LengthsAndAngles::new(source[0].clone(), target[0].clone()).map_err(|e| e.to_string());
        ("angles", path.and_then(|path| frames(&path, options.frames as usize)))
    };
    let tries = match options.path {
        PathName::Straight => vec![straight()],
        PathName::Angles => vec![angles()],
        PathName::Auto => {
            let first = angles();
            if first.1.is_ok() { vec![first] } else { vec![first, straight()] }
        }
    };
    let mut reasons = Vec::new();
    for (name, found) in tries {
        match found {
            Ok(shapes) => return Ok((name, shapes)),
            Err(reason) => reasons.push(format!("{name}: {reason}")),
        }
    }
    let message = format!(
        "the polygons in between are not simple; nothing was written. {}. `homeo warp` needs no path",
        reasons.join("; ")
    );
    Err(Failure::limits("no-path", message))
}

fn frames(path: &dyn ShapePath, count: usize) -> std::result::Result<Vec<PlanarDomain>, String> {
    (0..count)
        .map(|frame| {
            let time = time(frame, count);
            let rings = path.at(time).map_err(|e| e.to_string())?;
            PlanarDomain::new(rings).map_err(|e| format!("at time {time:.3} {e}"))
        })
        .collect()
}
