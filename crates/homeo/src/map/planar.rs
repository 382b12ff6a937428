//! Maps between planar domains: one trait for all of them.

use homeo_core::planar::{PlanarDomain, Point2};
use rayon::prelude::*;

/// A floating-point answer in the plane with a bound of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosed2 {
    /// The answer.
    pub point: Point2,
    /// The exact answer differs from `point` by at most this in each coordinate.
    pub radius: f64,
}

/// Why a point has no image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlanarEvaluationError {
    /// It lies outside.
    #[error("the point lies outside the {0}")]
    Outside(&'static str),
    /// A coordinate is not finite.
    #[error("the point has a coordinate that is not a finite number")]
    NotFinite,
    /// The answer could not be enclosed: the point is within rounding of a vertex, after this many steps.
    #[error("rounding leaves the answer open after step {0}")]
    NotProved(usize),
}

/// A homeomorphism between planar domains whose vertices correspond; every edge goes onto its edge, linearly but for
/// [complex maps](crate::complex), which have speeds.
pub trait PlanarBijection: Send + Sync {
    /// What is mapped.
    fn source(&self) -> &PlanarDomain;

    /// What it is mapped onto.
    fn target(&self) -> &PlanarDomain;

    /// Image of a point of the source, with a bound of the error.
    ///
    /// # Errors
    /// When the point does not lie in the source, exactly.
    fn forward(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError>;

    /// The point of the source whose image is given, with a bound of the error.
    ///
    /// # Errors
    /// When the point does not lie in the target, exactly.
    fn inverse(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError>;

    /// Preimages of points that follow one another closely, as those of a row of pixels: fast, without a bound of the
    /// error; `None` for points outside the target, up to rounding.
    fn inverse_along(&self, points: &[Point2], preimages: &mut [Option<Point2>]) {
        for (preimage, &point) in preimages.iter_mut().zip(points) {
            *preimage = self.inverse(point).ok().map(|answer| answer.point);
        }
    }

    /// Images of points that follow one another closely: fast, without a bound of the error; `None` for points outside the
    /// source, up to rounding.
    fn forward_along(&self, points: &[Point2], images: &mut [Option<Point2>]) {
        for (image, &point) in images.iter_mut().zip(points) {
            *image = self.forward(point).ok().map(|answer| answer.point);
        }
    }

    /// Images of many points, in parallel; the results do not depend on the number of threads.
    fn forward_batch(&self, points: &[Point2]) -> Vec<Result<Enclosed2, PlanarEvaluationError>> {
        points.par_iter().map(|&point| self.forward(point)).collect()
    }

    /// Preimages of many points, in parallel; the results do not depend on the number of threads.
    fn inverse_batch(&self, points: &[Point2]) -> Vec<Result<Enclosed2, PlanarEvaluationError>> {
        points.par_iter().map(|&point| self.inverse(point)).collect()
    }
}
