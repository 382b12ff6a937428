//! Harmonic coordinates, by boundary elements.

use homeo_core::planar::PlanarDomain;

use super::{CoordinateError, PlanarCoordinates};
use crate::harmonic::{
    BoundaryData, BoundaryElementFunctions, BoundaryElements, ElementParams, HarmonicFunctionError, HarmonicFunctions,
};

/// Harmonic coordinates (Joshi et al. 2007) of a polygon, with holes or without: each is the harmonic function that is 1
/// at its vertex, 0 at all others and linear on edges; positive inside.
///
/// # What is exact and what is not
/// Boundary elements reproduce linear functions whatever the elements: the coordinates sum to 1 and reproduce the point
/// to rounding, without being normalised. On vertices and edges (decided exactly) they are 1, 0 and linear to rounding.
/// Inside each one differs from the true harmonic function by at most the largest difference on the boundary, which
/// [`boundary_defect`](Self::boundary_defect) estimates: by so much the limit on an edge may differ from the linear
/// function, and a value may be negative. Gradients are given inside and on edges, not at vertices nor where elements
/// meet.
///
/// # Complexity
/// A dense factorization once; #E by #V products at a point.
///
/// ```
/// use homeo::coordinates::{HarmonicCoordinates, PlanarCoordinates};
/// use homeo::harmonic::ElementParams;
/// use homeo_core::planar::PlanarDomain;
/// let dart = PlanarDomain::new(vec![vec![[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]]])?;
/// let kind = HarmonicCoordinates::new(&dart, &ElementParams::default())?;
/// let mut values = [0.0; 4];
/// kind.values_into([1.5, 1.0], &mut values)?;
/// assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-13 && kind.boundary_defect() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct HarmonicCoordinates {
    functions: BoundaryElementFunctions,
    vertices: Vec<[f64; 2]>,
}

impl HarmonicCoordinates {
    /// Of all rings of a domain.
    ///
    /// # Errors
    /// A parameter is out of range, or there are too many elements.
    pub fn new(domain: &PlanarDomain, params: &ElementParams) -> Result<Self, HarmonicFunctionError> {
        let functions = BoundaryElements::new(domain, params)?.solve(&BoundaryData::hats(domain.vertex_count()))?;
        Ok(Self { functions, vertices: domain.vertices().collect() })
    }

    /// How much limits from inside differ from the values on the boundary: the most at five points of each element.
    pub fn boundary_defect(&self) -> f64 {
        self.functions.boundary_defect()
    }

    fn error(&self, error: HarmonicFunctionError) -> CoordinateError {
        match error {
            HarmonicFunctionError::NotFinite { point } => CoordinateError::NotFinite { point },
            HarmonicFunctionError::WrongLength { expected, found } => CoordinateError::WrongLength { expected, found },
            HarmonicFunctionError::NoGradient { point } => match self.vertices.iter().position(|&v| v == point) {
                Some(vertex) => CoordinateError::NoGradient { vertex },
                None => CoordinateError::Undefined { point },
            },
            HarmonicFunctionError::Outside { point } => CoordinateError::Undefined { point },
            // Nothing else comes from evaluation.
            _ => CoordinateError::Undefined { point: [f64::NAN; 2] },
        }
    }
}

impl PlanarCoordinates for HarmonicCoordinates {
    fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    fn values_into(&self, point: [f64; 2], values: &mut [f64]) -> Result<(), CoordinateError> {
        self.functions.values_into(point, values).map_err(|error| self.error(error))
    }

    fn gradients_into(
        &self,
        point: [f64; 2],
        values: &mut [f64],
        gradients: &mut [[f64; 2]],
    ) -> Result<(), CoordinateError> {
        self.functions.gradients_into(point, values, gradients).map_err(|error| self.error(error))
    }
}
