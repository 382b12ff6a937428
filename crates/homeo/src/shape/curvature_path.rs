//! Paths of polygons by the curvature at their vertices.

use super::bent::{Ends, half_edges};
use super::{ShapeError, ShapePath, check_time, mix};

/// Edges keep their parts of the length, which move evenly, and so do turning angles, but for a least correction that
/// closes the polygon.
///
/// What [`CurvatureBlend`](super::CurvatureBlend) is for curves, for polygons whose vertices correspond by number, as
/// [maps](crate::composite) need it: vertex `i` of every shape between belongs to vertex `i` of both ends. The turning
/// angle at a vertex is the curvature there, over half of both edges; the correction is least in the same mean,
/// `sum (b - a)^2 / w` with `w` half the edges' lengths of the time. It is the counterpart of
/// [`LengthsAndAngles`](super::LengthsAndAngles), which keeps angles and corrects lengths.
///
/// # Guarantee
/// The polygons as given at times 0 and 1, bit for bit. They are closed, so that nothing is corrected there, and shapes
/// near these times tend to them but for rounding: unlike a blend on a joint partition the path does not jump. Between
/// polygons with the same parts of the length it is that blend. Shapes close to `1e-12` of their length and turn as
/// often as the ends. They may meet themselves: see [`first_not_simple`](super::first_not_simple).
///
/// # References
/// Schneider 2017, section 3.3, with given vertices in the place of parts of the length.
///
/// # Example
/// ```
/// use homeo::shape::{CurvaturePath, ShapePath};
/// let square = vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
/// let kite = vec![[0.0, -2.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
/// let path = CurvaturePath::new(square.clone(), kite)?;
/// assert_eq!(path.at(0.0)?, [square]);
/// assert_eq!(path.at(0.5)?[0].len(), 4);
/// # Ok::<(), homeo::shape::ShapeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CurvaturePath {
    ends: Ends,
}

impl CurvaturePath {
    /// The path between two rings of corresponding vertices.
    ///
    /// # Errors
    /// The rings do not have the same number of vertices; coordinates are out of range; an edge has length zero or runs
    /// back on the one before; the rings do not turn the same number of times.
    pub fn new(source: Vec<[f64; 2]>, target: Vec<[f64; 2]>) -> Result<Self, ShapeError> {
        if source.len() != target.len() {
            return Err(ShapeError::VertexCounts { ring: 0, here: source.len(), there: target.len() });
        }
        Ok(Self { ends: Ends::new(source, target)? })
    }
}

impl ShapePath for CurvaturePath {
    /// # Complexity
    /// Linear for each step of the iteration: ten steps, as a rule.
    fn at(&self, t: f64) -> Result<Vec<Vec<[f64; 2]>>, ShapeError> {
        check_time(t)?;
        if let Some(ring) = self.ends.stored(t) {
            return Ok(vec![ring]);
        }
        let [a, b] = self.ends.measures();
        let mixed = |p: &[f64], q: &[f64]| -> Vec<f64> { p.iter().zip(q).map(|(p, q)| mix(t, *p, *q)).collect() };
        let (lengths, wanted) = (mixed(&a.lengths, &b.lengths), mixed(&a.turns, &b.turns));
        let turns = self.ends.closed(t, &wanted, &half_edges(&lengths), &lengths)?;
        Ok(vec![self.ends.ring(t, &lengths, &turns)])
    }
}
