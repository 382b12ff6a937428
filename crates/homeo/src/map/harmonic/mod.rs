//! Composite harmonic maps between planar domains, in their piecewise-linear form.
//!
//! Source and target are triangulated, each for itself, and flattened onto one domain between them: a convex polygon, or
//! a flat cylinder if there is a hole. With several holes both are first slit open along seams, and glued again in the end.
//! The map goes from the source to the middle and from there back to the target. `docs/theory/polygons.md` has the theorem.

mod circuit;
pub(crate) mod distortion;
mod half;
mod layout;
mod middle;
mod walk;

pub use circuit::{Circuit, CircuitSide};
pub use distortion::{Distortion, DistortionSummary};
pub(crate) use half::neighbours;
pub use half::{BoundaryPoint, Half, HalfParts};
pub use middle::{Middle, SHARE_BITS};

use half::Side;
use homeo_core::number::{Interval, Rational, Scalar};
use homeo_core::planar::{PlanarDomain, Point2};

use super::planar::{Enclosed2, PlanarBijection, PlanarEvaluationError};
use walk::Walk;

/// A homeomorphism between planar domains whose vertices correspond; linear on every edge.
#[derive(Clone, Debug)]
pub struct HarmonicMap {
    middle: Middle,
    source: Half,
    target: Half,
}

impl HarmonicMap {
    /// Of a middle and two triangulations flattened onto it.
    pub fn new(middle: Middle, source: HalfParts, target: HalfParts) -> Self {
        let [source, target] = [source, target].map(|parts| Half::new(parts, &middle));
        Self { middle, source, target }
    }

    /// The domain between source and target.
    pub fn middle(&self) -> &Middle {
        &self.middle
    }

    /// The triangulated source.
    pub fn source_half(&self) -> &Half {
        &self.source
    }

    /// The triangulated target.
    pub fn target_half(&self) -> &Half {
        &self.target
    }

    /// Image of a rational point, exactly.
    ///
    /// # Errors
    /// When the point does not lie in the source.
    pub fn forward_exact(&self, point: &[Rational; 2]) -> Result<[Rational; 2], PlanarEvaluationError> {
        self.exact(point, [&self.source, &self.target]).ok_or(PlanarEvaluationError::Outside("source"))
    }

    /// The point of the source whose image is given, exactly: `inverse_exact(forward_exact(p)) == p`.
    ///
    /// # Errors
    /// When the point does not lie in the target.
    pub fn inverse_exact(&self, point: &[Rational; 2]) -> Result<[Rational; 2], PlanarEvaluationError> {
        self.exact(point, [&self.target, &self.source]).ok_or(PlanarEvaluationError::Outside("target"))
    }

    /// First in intervals, and exactly where these leave something open.
    fn enclosed(&self, point: Point2, halves: [&Half; 2]) -> Result<Option<Enclosed2>, PlanarEvaluationError> {
        let finite = |x: f64| Rational::from_f64(x).ok_or(PlanarEvaluationError::NotFinite);
        let exact = [finite(point[0])?, finite(point[1])?];
        let image = match self.carry(&point.map(Interval::from_f64), halves) {
            Some(image) => image,
            None => self.exact(&exact, halves).map(|p| p.each_ref().map(Interval::around)),
        };
        Ok(image.map(|[x, y]| {
            let ((x, rx), (y, ry)) = (x.middle_and_radius(), y.middle_and_radius());
            Enclosed2 { point: [x, y], radius: rx.max(ry) }
        }))
    }

    fn exact(&self, point: &[Rational; 2], halves: [&Half; 2]) -> Option<[Rational; 2]> {
        self.carry(point, halves).flatten()
    }

    /// By one half to the middle, and by the other from there. `None` where rounding leaves something open; an empty
    /// answer for a point outside.
    fn carry<T: Scalar>(&self, point: &[T; 2], [here, there]: [&Half; 2]) -> Option<Option<[T; 2]>> {
        let Some([x, y]) = here.carry(&self.middle, Side::Domain, point)? else { return Some(None) };
        for turns in there.turns_to_try(&self.middle, &x) {
            let ahead = [x.plus(&T::from_f64(f64::from(turns))), y.clone()];
            if let Some(image) = there.carry(&self.middle, Side::Image, &ahead)? {
                return Some(Some(image));
            }
        }
        // The halves cover the same middle: only rounding can have missed it.
        None
    }
}

impl PlanarBijection for HarmonicMap {
    fn source(&self) -> &PlanarDomain {
        &self.source.parts().domain
    }

    fn target(&self) -> &PlanarDomain {
        &self.target.parts().domain
    }

    fn forward(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        self.enclosed(point, [&self.source, &self.target])?.ok_or(PlanarEvaluationError::Outside("source"))
    }

    fn inverse(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        self.enclosed(point, [&self.target, &self.source])?.ok_or(PlanarEvaluationError::Outside("target"))
    }

    fn inverse_along(&self, points: &[Point2], preimages: &mut [Option<Point2>]) {
        let (mut to_middle, mut from_middle) =
            (Walk::new(&self.target, Side::Domain), Walk::new(&self.source, Side::Image));
        for (preimage, &point) in preimages.iter_mut().zip(points) {
            *preimage = to_middle.carry(point).and_then(|middle| from_middle.carry(middle));
        }
    }
}
