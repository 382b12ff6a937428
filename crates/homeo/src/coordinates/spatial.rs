//! What coordinates of polyhedra have in common.

use rayon::prelude::*;

use super::CoordinateError;
use super::weighted::check_length;

/// Coordinates of points in space with respect to the vertices of a polyhedron with triangular faces.
///
/// `#V` functions that sum to 1, reproduce the point from the vertices, are linear on triangles and 1 at their own vertex.
///
/// ```
/// use homeo::coordinates::{MeanValuePolyhedron, SpatialCoordinates, WachspressPolyhedron};
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let kinds: [Box<dyn SpatialCoordinates>; 2] = [
///     Box::new(WachspressPolyhedron::new(&corners, &triangles)?),
///     Box::new(MeanValuePolyhedron::new(&corners, &triangles)?),
/// ];
/// for kind in &kinds {
///     let mut values = [0.0; 4];
///     kind.values_into([0.2, 0.3, 0.1], &mut values)?;
///     assert!((values[0] - 0.4).abs() < 1e-15 && (values[2] - 0.3).abs() < 1e-15);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait SpatialCoordinates: Send + Sync {
    /// How many vertices there are: #V.
    fn vertex_count(&self) -> usize;

    /// Values (#V) at a point where the kind is defined.
    ///
    /// # Errors
    /// The point is not finite or the kind is not defined there, or the buffer has another length.
    fn values_into(&self, point: [f64; 3], values: &mut [f64]) -> Result<(), CoordinateError>;

    /// Values (#V) and gradients (#V by 3), per unit of length.
    ///
    /// # Errors
    /// As for the values, and where the kind has no gradient: most have none at vertices.
    fn gradients_into(
        &self,
        point: [f64; 3],
        values: &mut [f64],
        gradients: &mut [[f64; 3]],
    ) -> Result<(), CoordinateError>;

    /// `sum phi_i(x) rows_i` for each of the points (#P by 3), with `rows` (#V by 3) on the vertices: images under a
    /// barycentric map, or displacements.
    ///
    /// In parallel, with one buffer for each thread; the result does not depend on their number.
    ///
    /// # Errors
    /// `rows` has another length than #V, or the kind is not defined at a point: the first such one.
    fn combine(&self, rows: &[[f64; 3]], points: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, CoordinateError> {
        check_length(self.vertex_count(), rows.len())?;
        let buffer = || vec![0.0; rows.len()];
        let sums: Vec<Result<[f64; 3], CoordinateError>> = points
            .par_iter()
            .map_init(buffer, |values, &point| {
                self.values_into(point, values)?;
                Ok([0, 1, 2].map(|k| values.iter().zip(rows).map(|(value, row)| value * row[k]).sum()))
            })
            .collect();
        sums.into_iter().collect()
    }
}
