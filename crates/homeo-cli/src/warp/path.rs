//! How one polygon becomes another: the ways that there are, in the order in which they are tried.

use homeo::shape::{CurvaturePath, LengthsAndAngles, LinearPath, ShapePath, SimplePath, TurningPath};
use homeo_core::planar::DomainPair;

use crate::args::PathName;

/// A way from one polygon to another.
pub struct Way {
    pub name: &'static str,
    pub path: Box<dyn ShapePath>,
    /// By how many degrees the hole turns against the outer ring in all, if the way says so.
    pub turn: Option<f64>,
}

/// The ways of a name, or why there is none. `turn` is by how many degrees a hole shall turn.
pub fn ways(pair: &DomainPair, name: PathName, turn: Option<f64>) -> impl Iterator<Item = Result<Way, String>> {
    let names = match name {
        PathName::Straight => vec!["straight"],
        PathName::Angles => vec!["angles"],
        PathName::Curvature => vec!["curvature"],
        PathName::Turning => vec!["turning"],
        PathName::Simple => vec!["simple"],
        PathName::Auto if pair.source.rings().len() > 1 => vec!["turning", "straight", "simple"],
        PathName::Auto => vec!["angles", "straight", "turning", "simple"],
    };
    // One after the other, as long as they are asked for.
    names.into_iter().map(move |name| way(pair, name, turn).map_err(|error| format!("{name}: {error}")))
}

fn way(pair: &DomainPair, name: &'static str, turn: Option<f64>) -> Result<Way, String> {
    match name {
        "straight" => {
            let path = LinearPath::between(pair).map_err(|e| e.to_string())?;
            Ok(Way { name, path: Box::new(path), turn: None })
        }
        "turning" => {
            let path = turning(pair, turn).map_err(|e| e.to_string())?;
            let turns = path.turns_in_degrees();
            Ok(Way { name, path: Box::new(path), turn: turns.get(1).map(|inner| inner - turns[0]) })
        }
        "simple" => {
            let path = SimplePath::between(pair).map_err(|e| e.to_string())?;
            Ok(Way { name, path: Box::new(path), turn: None })
        }
        _ => {
            let [source, target] = [&pair.source, &pair.target].map(|domain| domain.rings());
            let ([source], [target]) = (source, target) else {
                return Err("it is for polygons without holes".to_owned());
            };
            let (source, target) = (source.clone(), target.clone());
            let path: Box<dyn ShapePath> = match name {
                "curvature" => Box::new(CurvaturePath::new(source, target).map_err(|e| e.to_string())?),
                _ => Box::new(LengthsAndAngles::new(source, target).map_err(|e| e.to_string())?),
            };
            Ok(Way { name, path, turn: None })
        }
    }
}

/// Holes turn by as much more than the outer ring as is asked for.
fn turning(pair: &DomainPair, turn: Option<f64>) -> Result<TurningPath, homeo::shape::ShapeError> {
    let outer = TurningPath::between(pair, &[])?.turns_in_degrees()[0];
    let mut degrees = vec![outer + turn.unwrap_or(0.0); pair.source.rings().len()];
    degrees[0] = outer;
    TurningPath::between(pair, &degrees)
}
