//! Straight paths of vertices.

use homeo_core::planar::DomainPair;

use super::ring::check_points;
use super::{ShapeError, ShapePath, check_time, mix};

/// Every vertex moves straight and evenly: `(1 - t) a + t b`.
///
/// Depends on how the shapes are placed; a shape turned by a half turn shrinks to a point on the way.
///
/// # References
/// Schneider 2017, section 3.1.
///
/// # Example
/// ```
/// use homeo::shape::{LinearPath, ShapePath};
/// let triangle = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
/// let large = vec![[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]];
/// let path = LinearPath::new(vec![triangle], vec![large])?;
/// assert_eq!(path.at(0.5)?, [[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]]);
/// # Ok::<(), homeo::shape::ShapeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LinearPath {
    source: Vec<Vec<[f64; 2]>>,
    target: Vec<Vec<[f64; 2]>>,
}

impl LinearPath {
    /// The path between rings whose vertices correspond by number. Rings may run either way and meet themselves.
    ///
    /// # Errors
    /// Numbers of rings or vertices differ, or coordinates are out of range.
    pub fn new(source: Vec<Vec<[f64; 2]>>, target: Vec<Vec<[f64; 2]>>) -> Result<Self, ShapeError> {
        check_rings(&source, &target)?;
        Ok(Self { source, target })
    }

    /// The path between the rings of two domains.
    ///
    /// # Errors
    /// Coordinates are out of range.
    pub fn between(pair: &DomainPair) -> Result<Self, ShapeError> {
        Self::new(pair.source.rings().to_vec(), pair.target.rings().to_vec())
    }
}

/// Refuses rings that do not correspond, or coordinates that are out of range.
pub(super) fn check_rings(source: &[Vec<[f64; 2]>], target: &[Vec<[f64; 2]>]) -> Result<(), ShapeError> {
    if source.len() != target.len() {
        return Err(ShapeError::RingCounts { here: source.len(), there: target.len() });
    }
    for (ring, (a, b)) in source.iter().zip(target).enumerate() {
        if a.len() != b.len() {
            return Err(ShapeError::VertexCounts { ring, here: a.len(), there: b.len() });
        }
        check_points(a)?;
        check_points(b)?;
    }
    Ok(())
}

impl ShapePath for LinearPath {
    fn at(&self, t: f64) -> Result<Vec<Vec<[f64; 2]>>, ShapeError> {
        check_time(t)?;
        if t == 0.0 || t == 1.0 {
            return Ok(if t == 0.0 { self.source.clone() } else { self.target.clone() });
        }
        let between = |(a, b): (&[f64; 2], &[f64; 2])| [mix(t, a[0], b[0]), mix(t, a[1], b[1])];
        let ring = |(a, b): (&Vec<[f64; 2]>, &Vec<[f64; 2]>)| a.iter().zip(b).map(between).collect();
        Ok(self.source.iter().zip(&self.target).map(ring).collect())
    }
}
