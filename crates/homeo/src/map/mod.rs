//! Maps: one trait for all of them, and what each is made of.
//!
//! A map that exists is complete: it can be evaluated both ways, in `f64` with a stated error and
//! exactly in rationals. What is proved about it lives in its certificate, not here.

mod batch;
mod by_cell;
mod evaluate;
mod exact;
mod fast;
mod float;
mod foliation;
mod harmonic;
mod locate;
mod moved;
mod nearest;
mod planar;
mod sample;
mod section;
mod shell;
mod steps;
mod target;

pub use foliation::{Centre, DEFAULT_ACCURACY, Foliation, FoliationParts};
pub use harmonic::{
    BoundaryPoint, Circuit, CircuitSide, Distortion, DistortionSummary, Half, HalfParts, HarmonicMap, Middle,
    SHARE_BITS,
};
pub(crate) use harmonic::{distortion as planar_distortion, neighbours};
pub use moved::{MovedMesh, MovedMeshError};
pub(crate) use nearest::is_flat;
pub use planar::{Enclosed2, PlanarBijection, PlanarEvaluationError};
pub use sample::{LeafPolyline, distortions};
pub use section::Section;
pub(crate) use shell::ShellSurface;
pub use shell::{Shell, ShellEvaluationError, ShellParts, ShellPoint, SurfacePoint};
pub use target::{BALL_CORNERS, Target, UnknownTarget};

use homeo_core::number::Rational;
use rayon::prelude::*;

/// A floating-point answer with a bound of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosed {
    /// The answer; the third coordinate of a plane point is 0.
    pub point: [f64; 3],
    /// The exact answer differs from `point` by at most this in each coordinate.
    pub radius: f64,
}

/// Why a point has no image.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EvaluationError {
    /// The point does not lie in the source.
    #[error("the point lies outside the mesh")]
    OutsideSource,
    /// The point does not lie in the target.
    #[error("the point lies outside the {0}")]
    OutsideTarget(Target),
    /// The point does not lie in the mesh after it has moved.
    #[error("the point lies outside the moved mesh")]
    OutsideMoved,
    /// A coordinate is not finite.
    #[error("the point has a coordinate that is not a finite number")]
    NotFinite,
    /// Different cells that overlap in space contain the point.
    #[error("the point lies in cells {0} and {1}, which overlap in space: the mesh crosses itself there")]
    Ambiguous(u32, u32),
    /// The refined cells leave a hole: the map comes from a damaged file.
    #[error("no refined cell contains the point of cell {0}: the map is damaged")]
    NotCovered(u32),
}

/// A homeomorphism from a mesh onto a standard shape, or onto where the mesh has moved to.
pub trait Bijection: Send + Sync {
    /// Image of a point of the mesh, with a bound of the error.
    ///
    /// A point near a surface in space stands for the nearest point of the surface.
    ///
    /// # Errors
    /// When the point does not lie in the mesh.
    fn forward(&self, point: [f64; 3]) -> Result<Enclosed, EvaluationError>;

    /// The point of the mesh whose image is given, with a bound of the error.
    ///
    /// # Errors
    /// When the point does not lie in the target.
    fn inverse(&self, point: [f64; 3]) -> Result<Enclosed, EvaluationError>;

    /// Image of a rational point, exactly. For disk and ball the exact target is the polyhedral one.
    ///
    /// # Errors
    /// When the point does not lie in the mesh, exactly.
    fn forward_exact(&self, point: &[Rational; 3]) -> Result<[Rational; 3], EvaluationError>;

    /// The point of the mesh whose image is the given rational point of the exact target.
    ///
    /// # Guarantee
    /// `inverse_exact(forward_exact(p)) == p`, as rationals.
    ///
    /// # Errors
    /// When the point does not lie in the target, exactly.
    fn inverse_exact(&self, point: &[Rational; 3]) -> Result<[Rational; 3], EvaluationError>;

    /// Images of many points, in parallel; the results do not depend on the number of threads.
    fn forward_batch(&self, points: &[[f64; 3]]) -> Vec<Result<Enclosed, EvaluationError>> {
        points.par_iter().map(|&p| self.forward(p)).collect()
    }

    /// Preimages of many points, in parallel; the results do not depend on the number of threads.
    fn inverse_batch(&self, points: &[[f64; 3]]) -> Vec<Result<Enclosed, EvaluationError>> {
        points.par_iter().map(|&p| self.inverse(p)).collect()
    }
}
