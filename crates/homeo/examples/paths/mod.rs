//! Paths that composite maps of pairs of polygons are sought along.

use homeo::shape::{LengthsAndAngles, LinearPath, ShapeError, ShapePath, SimplePath, TurningPath};
use homeo_core::planar::DomainPair;

pub type NamedPath = (&'static str, Box<dyn ShapePath>);

/// The paths that are tried, in this order: a hole turns first.
pub fn paths(pair: &DomainPair, turn: Option<f64>) -> Result<Vec<NamedPath>, String> {
    let text = |error: ShapeError| error.to_string();
    let straight: Box<dyn ShapePath> = Box::new(LinearPath::between(pair).map_err(text)?);
    let outer = TurningPath::between(pair, &[]).map_err(text)?.turns_in_degrees()[0];
    let turning = TurningPath::between(pair, &[outer, outer + turn.unwrap_or(0.0)]).map_err(text)?;
    let turning: Box<dyn ShapePath> = Box::new(turning);
    let [source, target] = [&pair.source, &pair.target].map(|domain| domain.rings()[0].clone());
    let simple = SimplePath::between(pair).map(|path| Box::new(path) as Box<dyn ShapePath>);
    let simple = simple.into_iter().map(|path| ("simple", path));
    Ok(match pair.source.rings().len() {
        1 => {
            let angles = LengthsAndAngles::new(source, target).map(|path| Box::new(path) as Box<dyn ShapePath>);
            let angles = angles.into_iter().map(|path| ("angles", path));
            angles.chain([("straight", straight), ("turning", turning)]).chain(simple).collect()
        }
        _ => vec![("turning", turning), ("straight", straight)],
    })
}
