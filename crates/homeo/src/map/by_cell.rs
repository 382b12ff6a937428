//! Exact evaluation for points that are given by a cell and weights, in the place of coordinates.

use homeo_core::mesh::CellId;
use homeo_core::number::Rational;
use homeo_core::predicate::Sign;

use super::exact::{fractions, whole};
use super::{EvaluationError, Foliation};

impl<const K: usize> Foliation<K> {
    /// Image of the point of a source cell with given weights of the cell's vertices, exactly.
    ///
    /// Only their ratio counts. Unlike a point in space this is never ambiguous: the mesh may cross itself.
    ///
    /// # Errors
    /// [`OutsideSource`](EvaluationError::OutsideSource) where there is no such cell, a weight is negative, or all are
    /// zero.
    ///
    /// # Example
    /// See [`locate_preimage`](Self::locate_preimage).
    pub fn image_in_cell(&self, cell: CellId, weights: &[Rational; K]) -> Result<[Rational; 3], EvaluationError> {
        let is_point = weights.iter().all(|w| w.sign() != Sign::Negative) && weights.iter().any(|w| !w.is_zero());
        if !is_point || cell.index() >= self.source().complex().cell_count() {
            return Err(EvaluationError::OutsideSource);
        }
        let at = self.locator.child_exact(self.source(), &self.parts().mesh, cell, &whole(weights))?;
        Ok(self.image_exact(&at))
    }

    /// The point of the mesh whose image is given: a source cell that contains it, and its weights there, of sum 1.
    ///
    /// # Guarantee
    /// `locate_preimage(image_in_cell(cell, weights))` is the same point of the abstract mesh: the same cell and weights
    /// or, on a facet, those in a cell beyond it.
    ///
    /// # Errors
    /// When the point does not lie in the target, exactly.
    ///
    /// # Example
    /// ```
    /// use homeo::construct::foliation::{FoliationParams, build};
    /// use homeo::input::SourceMesh;
    /// use homeo::map::Target;
    /// use homeo::progress::Silent;
    /// use homeo_core::mesh::{CellId, TriangleComplex};
    /// use homeo_core::number::Rational;
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.4, 0.0]];
    /// let cells = TriangleComplex::from_indices(5, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])?;
    /// let mesh = SourceMesh::new(corners, cells);
    /// let (map, _) = build(&mesh, Target::Square, &FoliationParams::default(), &Silent)?;
    /// let weights = [Rational::from(1), Rational::from(2), Rational::from(5)];
    /// let (cell, found) = map.locate_preimage(&map.image_in_cell(CellId::new(2), &weights)?)?;
    /// assert_eq!((cell, found), (CellId::new(2), weights.map(|w| &w / &Rational::from(8))));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn locate_preimage(&self, point: &[Rational; 3]) -> Result<(CellId, [Rational; K]), EvaluationError> {
        let at = self.preimage_exact(point)?;
        let (cell, weights) = self.locator.source_weights_exact(self.source(), &self.parts().mesh, &at);
        Ok((cell, fractions(&weights)))
    }
}
