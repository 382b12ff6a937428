//! Polygons as JSON: `[[x, y], …]`, an object of an outer ring and holes, or a pair of such.

use serde_json::Value;

use super::{DomainError, PlanarDomain, Point2, turn};
use crate::predicate::Sign;

/// Why a JSON value or a drawing holds no polygons.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct PolygonFileError(pub(super) String);

/// The rings of a value: a list of points is one; an object has the outer ring as `outer`, a hole as `inner` or several
/// as `holes`. Orders are kept as they are.
///
/// # Errors
/// Names the vertex that is no pair of numbers.
///
/// ```
/// use homeo_core::planar::read_rings;
/// let value = serde_json::json!({"outer": [[0, 0], [9, 0], [0, 9]], "inner": [[1, 1], [2, 1], [1, 2]]});
/// assert_eq!(read_rings(&value).unwrap().len(), 2);
/// ```
pub fn read_rings(value: &Value) -> Result<Vec<Vec<Point2>>, PolygonFileError> {
    if value.is_array() {
        return Ok(vec![ring(value, "polygon")?]);
    }
    let outer = value.get("outer").ok_or_else(|| {
        PolygonFileError("a polygon is a list of points [[x, y], ...] or an object with a list \"outer\"".to_owned())
    })?;
    let mut rings = vec![ring(outer, "outer")?];
    if let Some(inner) = value.get("inner") {
        rings.push(ring(inner, "inner")?);
    }
    for (number, hole) in value.get("holes").and_then(Value::as_array).into_iter().flatten().enumerate() {
        rings.push(ring(hole, &format!("hole {number}"))?);
    }
    Ok(rings)
}

fn ring(value: &Value, name: &str) -> Result<Vec<Point2>, PolygonFileError> {
    let rows = value.as_array().ok_or_else(|| PolygonFileError(format!("{name} is no list of points [x, y]")))?;
    let point = |value: &Value| -> Option<Point2> {
        let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
        numbers?.try_into().ok()
    };
    let read = |(row, value)| {
        point(value).ok_or_else(|| PolygonFileError(format!("vertex {row} of {name} is no pair [x, y] of numbers")))
    };
    rows.iter().enumerate().map(read).collect()
}

/// The rings of two polygons as a file has them; nothing is known of them.
#[derive(Clone, Debug, PartialEq)]
pub struct RingPair {
    /// Rings of the source.
    pub source: Vec<Vec<Point2>>,
    /// Rings of the target.
    pub target: Vec<Vec<Point2>>,
    /// By how many degrees the inner ring shall turn against the outer one, where the file says so.
    pub turn_degrees: Option<f64>,
}

/// Reads `{"source": …, "target": …, "winding_hint": degrees}`.
///
/// # Errors
/// Says what is missing or which vertex is no pair of numbers.
pub fn read_pair(value: &Value) -> Result<RingPair, PolygonFileError> {
    let side = |name: &str| {
        let there = value.get(name).ok_or_else(|| PolygonFileError(format!("the pair has no \"{name}\"")))?;
        read_rings(there).map_err(|PolygonFileError(what)| PolygonFileError(format!("{name}: {what}")))
    };
    let turn_degrees = value.get("winding_hint").and_then(Value::as_f64);
    Ok(RingPair { source: side("source")?, target: side("target")?, turn_degrees })
}

/// Two domains whose rings and vertices correspond by number.
#[derive(Clone, Debug, PartialEq)]
pub struct DomainPair {
    /// From here.
    pub source: PlanarDomain,
    /// To there.
    pub target: PlanarDomain,
}

/// Why two lists of rings are no pair.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PairError {
    /// There are not as many rings here as there.
    #[error("the source has {0} rings and the target {1}: they correspond by number")]
    RingCounts(usize, usize),
    /// A ring has not as many vertices here as there.
    #[error("ring {ring} has {here} vertices in the source and {there} in the target: they correspond by number")]
    VertexCounts {
        /// The ring.
        ring: usize,
        /// How many in the source.
        here: usize,
        /// How many in the target.
        there: usize,
    },
    /// The source is no domain.
    #[error("source: {0}")]
    Source(DomainError),
    /// The target is no domain.
    #[error("target: {0}")]
    Target(DomainError),
}

impl DomainPair {
    /// A pair of domains with corresponding rings. These may run either way round, but the same way in both: where both
    /// run the wrong way both are turned, first vertices kept.
    ///
    /// # Errors
    /// What does not correspond, or is no domain.
    pub fn new(mut source: Vec<Vec<Point2>>, mut target: Vec<Vec<Point2>>) -> Result<Self, PairError> {
        if source.len() != target.len() {
            return Err(PairError::RingCounts(source.len(), target.len()));
        }
        for (ring, (a, b)) in source.iter_mut().zip(&mut target).enumerate() {
            if a.len() != b.len() {
                return Err(PairError::VertexCounts { ring, here: a.len(), there: b.len() });
            }
            let wrong = if ring == 0 { Sign::Negative } else { Sign::Positive };
            if turn(a) == wrong && turn(b) == wrong {
                a[1..].reverse();
                b[1..].reverse();
            }
        }
        Ok(Self {
            source: PlanarDomain::new(source).map_err(PairError::Source)?,
            target: PlanarDomain::new(target).map_err(PairError::Target)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_is_no_polygon_is_named() {
        let message = |value: Value| read_rings(&value).unwrap_err().to_string();
        assert_eq!(message(json!([[0, 0], [1, "x"]])), "vertex 1 of polygon is no pair [x, y] of numbers");
        assert_eq!(message(json!({"outer": [[0, 0, 0]]})), "vertex 0 of outer is no pair [x, y] of numbers");
        assert!(message(json!({"inner": []})).contains("outer"));
        assert!(read_pair(&json!({"source": [[0, 0]]})).unwrap_err().to_string().contains("target"));
    }

    #[test]
    fn rings_may_run_either_way_round() {
        let outer = vec![[-4.0, -4.0], [4.0, -4.0], [0.0, 4.0]];
        let hole = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let rings = vec![outer.clone(), hole.clone()];
        let pair = DomainPair::new(rings.clone(), rings).unwrap();
        assert_eq!(pair.source.rings()[1], [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]);
        let clockwise = vec![vec![[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]];
        let pair = DomainPair::new(clockwise.clone(), clockwise.clone()).unwrap();
        assert_eq!(pair.source.rings()[0], [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        let other_way = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]];
        assert!(matches!(DomainPair::new(clockwise, other_way), Err(PairError::Source(DomainError::WrongWay { .. }))));
        let turned: Vec<_> = hole.iter().rev().copied().collect();
        let error = DomainPair::new(vec![outer.clone(), hole.clone()], vec![outer.clone(), turned]).unwrap_err();
        assert!(matches!(error, PairError::Source(DomainError::WrongWay { ring: 1, .. })));
        assert_eq!(DomainPair::new(vec![outer.clone(), hole], vec![outer]), Err(PairError::RingCounts(2, 1)));
    }
}
