//! Complex maps with speeds.

use homeo::complex::{ComplexError, ComplexInfo, ComplexMap, ComplexParams};
use homeo_core::planar::DomainPair;
use serde_json::json;

use crate::failure::{Failure, Result};
use crate::session::Session;

/// The degree of speeds, unless another is asked for.
pub const DEGREE: usize = 4;

/// The map of the best speeds found, or why there is none.
pub fn map(
    session: &Session,
    pair: &DomainPair,
    degree: usize,
    turn: Option<f64>,
) -> Result<(ComplexMap, ComplexInfo)> {
    let refused = |what: String| {
        let message = format!("no complex map with speeds of degree {degree} was found; nothing was written. {what}");
        Failure::limits("no-map", message)
    };
    if turn.is_some_and(|turn| turn.abs() > 180.0) {
        let what = "In one step a hole does not turn by more than a half turn: take --method mean-value or harmonic";
        return Err(refused(what.to_owned()));
    }
    ComplexMap::build(pair, &ComplexParams { degree, ..ComplexParams::default() }, session).map_err(|error| {
        let failure = refused(format!("{error} (--method mean-value)"));
        match error {
            ComplexError::Stopped => session.stopped(),
            ComplexError::Folds { point, at_most } => {
                failure.with("fold", json!({"point": point, "determinant_at_most": at_most}))
            }
            ComplexError::Undecided { point } => failure.with("undecided_near", json!(point)),
            ComplexError::Triangles(_) => failure,
            ComplexError::Speeds(_) => Failure::usage(error.to_string()),
        }
    })
}
