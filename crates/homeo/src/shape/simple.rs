//! Whether shapes bound domains.

use homeo_core::planar::{DomainError, PlanarDomain};

use super::{ShapeError, ShapePath};

/// Whether rings bound a domain, exactly: the outer one, counter-clockwise, then those of holes, clockwise; all simple
/// and apart.
///
/// # Errors
/// The first thing that is wrong with them.
///
/// # Complexity
/// That of [`PlanarDomain::new`]: a sweep.
///
/// # Example
/// ```
/// use homeo::shape::check_simple;
/// assert!(check_simple(&[vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]]).is_ok());
/// assert!(check_simple(&[vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]]).is_err());
/// ```
pub fn check_simple(rings: &[Vec<[f64; 2]>]) -> Result<(), DomainError> {
    PlanarDomain::new(rings.to_vec()).map(drop)
}

/// A shape on a path that bounds no domain.
#[derive(Clone, Debug, PartialEq)]
pub struct NotSimple {
    /// When.
    pub t: f64,
    /// What is wrong with it.
    pub why: DomainError,
}

impl std::fmt::Display for NotSimple {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "at time {:.3} {}", self.t, self.why)
    }
}

/// The first of the times `0, 1 / steps, 2 / steps, ..., 1` at which the shape bounds no domain.
///
/// # Guarantee
/// Exact at each of these times, on the stored numbers. `None` is **no proof** for the times between them.
///
/// # Errors
/// The path has no shape at one of the times before.
///
/// # Complexity
/// `steps + 1` shapes and sweeps; 0 steps count as 1.
///
/// # Example
/// ```
/// use homeo::shape::{LinearPath, first_not_simple};
/// let square = vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
/// let half_turn = square.iter().map(|p| p.map(|x| -x)).collect();
/// let path = LinearPath::new(vec![square], vec![half_turn])?;
/// assert_eq!(first_not_simple(&path, 10)?.map(|shape| shape.t), Some(0.5));
/// assert_eq!(first_not_simple(&path, 9)?, None);
/// # Ok::<(), homeo::shape::ShapeError>(())
/// ```
pub fn first_not_simple(path: &dyn ShapePath, steps: usize) -> Result<Option<NotSimple>, ShapeError> {
    let steps = steps.max(1);
    for t in (0..=steps).map(|i| i as f64 / steps as f64) {
        if let Err(why) = PlanarDomain::new(path.at(t)?) {
            return Ok(Some(NotSimple { t, why }));
        }
    }
    Ok(None)
}
