//! Composite maps: several mean value maps, one after the other, each proved to be one-to-one.

use homeo_core::number::{Interval, Rational};
use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::predicate::{Sign, orient2d};

use super::chart::Step;
use super::evaluate::{BallPoint, Jacobian};
use super::invert::{InverseError, invert};
use super::number::{Ball, Number};
use super::partition::{
    Partition, PartitionError, PartitionParams, Stage, VertexPath, binary_partition, given_partition,
};
use super::triangulation::Tiling;
use crate::map::{Enclosed2, PlanarBijection, PlanarEvaluationError};
use crate::progress::Progress;

/// Why a point has no image.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CompositeError {
    /// The point is not in the source, exactly.
    #[error("the point lies outside the source")]
    OutsideSource,
    /// The point is not in the target, exactly.
    #[error("the point lies outside the target")]
    OutsideTarget,
    /// Enclosures grew too large on the way.
    #[error("the image after step {0} is not known: the enclosure is too large")]
    TooWide(usize),
    /// The preimage was not proved to be near the point found.
    #[error("the preimage under step {0} is not proved: {1}")]
    NotProved(usize, InverseError),
}

/// How a composite map came about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompositeInfo {
    /// The least determinant that is proved for a step; every step has its own in [`CompositeMap::bounds`].
    pub least_determinant: f64,
    /// Boxes that the proof evaluated.
    pub boxes: u64,
    /// Boxes evaluated for steps that were not kept.
    pub boxes_in_vain: u64,
    /// Steps that were tried.
    pub tried: usize,
}

/// A homeomorphism between planar domains, analytic inside: mean value maps from each domain of a list to the next.
///
/// # Guarantee
/// The numbers stored define the map: the vertices of all domains. Every step has a Jacobian determinant proved to be
/// at least its [bound](Self::bounds), so that it is a homeomorphism of the closed domains, linear on every edge.
///
/// ```
/// use homeo::composite::{CompositeMap, LinearPath, PartitionParams};
/// use homeo::progress::Silent;
/// use homeo_core::planar::DomainPair;
/// let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
/// let kite = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.4, 0.4], [0.0, 1.0]]];
/// let path = LinearPath::new(DomainPair::new(square, kite).unwrap());
/// let (map, info) = CompositeMap::build(&path, &PartitionParams::default(), &Silent).unwrap();
/// assert!(map.step_count() > 1 && info.least_determinant > 0.0);
/// let image = map.forward([0.7, 0.6]).unwrap();
/// let back = map.inverse(image.point).unwrap();
/// assert!((back.point[0] - 0.7).abs() < 1e-12 && back.radius < 1e-9);
/// ```
#[derive(Clone, Debug)]
pub struct CompositeMap {
    stages: Vec<Stage>,
    bounds: Vec<f64>,
    steps: Vec<Step>,
    /// From each stage to the one before: near the inverse, to begin the search for it with.
    backward: Vec<Step>,
}

impl CompositeMap {
    /// Finds a composite map by bisection of time: one step if that is one-to-one.
    ///
    /// # Errors
    /// At which time the vertices bound no domain, or which limit was reached where.
    pub fn build(
        path: &dyn VertexPath,
        params: &PartitionParams,
        progress: &(dyn Progress + Sync),
    ) -> Result<(Self, CompositeInfo), PartitionError> {
        Ok(Self::from_partition(binary_partition(path, params, progress)?))
    }

    /// The composite map of given times, from 0 to 1 and increasing, each step proved.
    ///
    /// # Errors
    /// As [`build`](Self::build), and the first step that is not proved.
    pub fn at_times(
        path: &dyn VertexPath,
        times: &[f64],
        params: &PartitionParams,
        progress: &(dyn Progress + Sync),
    ) -> Result<(Self, CompositeInfo), PartitionError> {
        Ok(Self::from_partition(given_partition(path, times, params, progress)?))
    }

    fn from_partition(partition: Partition) -> (Self, CompositeInfo) {
        let Partition { stages, bounds, boxes: [boxes, all], tried } = partition;
        let least_determinant = bounds.iter().copied().fold(f64::INFINITY, f64::min);
        let info = CompositeInfo { least_determinant, boxes, boxes_in_vain: all - boxes, tried };
        let steps = stages.windows(2).map(|pair| pair[0].step_to(&pair[1])).collect();
        let backward = stages.windows(2).map(|pair| pair[1].step_to(&pair[0])).collect();
        (Self { stages, bounds, steps, backward }, info)
    }

    /// How many steps it has.
    pub fn step_count(&self) -> usize {
        self.steps.len()
    }

    /// All domains, from the source to the target.
    pub fn domains(&self) -> impl Iterator<Item = &PlanarDomain> {
        self.stages.iter().map(|stage| &stage.domain)
    }

    /// The times of all domains on the path.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.stages.iter().map(|stage| stage.time)
    }

    /// For each domain the triangles that tile it, in which the proof was made.
    pub fn tilings(&self) -> impl Iterator<Item = &Tiling> {
        self.stages.iter().map(|stage| &stage.tiling)
    }

    /// For each step a number that its Jacobian determinant is proved to be no less than.
    pub fn bounds(&self) -> &[f64] {
        &self.bounds
    }

    /// Image of a point of the source, with a bound of the error.
    ///
    /// # Guarantee
    /// The exact image lies within the radius. Points on edges are sent along their edge, in rationals.
    ///
    /// # Errors
    /// When the point is not in the source, exactly; or enclosures became useless, near a vertex of a later domain.
    ///
    /// # Complexity
    /// Linear in vertices and steps.
    pub fn forward(&self, point: Point2) -> Result<Enclosed2, CompositeError> {
        if !self.source().contains(point) {
            return Err(CompositeError::OutsideSource);
        }
        if let Some(image) = along_edge(self.source(), self.target(), point) {
            return Ok(image);
        }
        let mut here: BallPoint = point.map(Ball::of);
        for (number, step) in self.steps.iter().enumerate() {
            here = step.enclose(here);
            if here.iter().any(|c| c.radius.is_nan()) {
                return Err(CompositeError::TooWide(number));
            }
        }
        Ok(enclosed(here))
    }

    /// The point of the source whose image is given, with a bound of the error.
    ///
    /// # Guarantee
    /// The exact preimage lies within the radius.
    ///
    /// # Errors
    /// When the point is not in the target, exactly, or the preimage is not proved.
    ///
    /// # Complexity
    /// Some ten times [`forward`](Self::forward).
    pub fn inverse(&self, point: Point2) -> Result<Enclosed2, CompositeError> {
        if !self.target().contains(point) {
            return Err(CompositeError::OutsideTarget);
        }
        if let Some(preimage) = along_edge(self.target(), self.source(), point) {
            return Ok(preimage);
        }
        let mut here = Enclosed2 { point, radius: 0.0 };
        for number in (0..self.steps.len()).rev() {
            let domains = [&self.stages[number].domain, &self.stages[number + 1].domain];
            here = invert(&self.steps[number], &self.backward[number], domains, here)
                .map_err(|error| CompositeError::NotProved(number, error))?;
        }
        Ok(here)
    }

    /// The derivative at a point, rounded; rows are the gradients of the two coordinates of the image. `None` outside.
    ///
    /// # References
    /// Schneider 2017, equation 4.2, by the chain rule over steps.
    pub fn jacobian(&self, point: Point2) -> Option<Jacobian> {
        if !self.source().contains(point) {
            return None;
        }
        let (mut at, mut product) = (point, [[1.0, 0.0], [0.0, 1.0]]);
        for step in &self.steps {
            let (next, own) = step.value(at);
            at = next;
            product = own.map(|[a, b]| std::array::from_fn(|k| a * product[0][k] + b * product[1][k]));
        }
        Some(product)
    }

    /// Distortion at a point, rounded: `σ1/σ2 + σ2/σ1` of the singular values of the derivative, 2 where it is conformal.
    /// `None` outside.
    pub fn distortion(&self, point: Point2) -> Option<f64> {
        let [[a, b], [c, d]] = self.jacobian(point)?;
        Some((a * a + b * b + c * c + d * d) / (a * d - b * c))
    }
}

impl PlanarBijection for CompositeMap {
    fn source(&self) -> &PlanarDomain {
        &self.stages[0].domain
    }

    fn target(&self) -> &PlanarDomain {
        &self.stages[self.steps.len()].domain
    }

    fn forward(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        Ok(CompositeMap::forward(self, point)?)
    }

    fn inverse(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        Ok(CompositeMap::inverse(self, point)?)
    }
}

impl From<CompositeError> for PlanarEvaluationError {
    fn from(error: CompositeError) -> Self {
        match error {
            CompositeError::OutsideSource => Self::Outside("source"),
            CompositeError::OutsideTarget => Self::Outside("target"),
            CompositeError::TooWide(step) | CompositeError::NotProved(step, _) => Self::NotProved(step),
        }
    }
}

fn enclosed(point: BallPoint) -> Enclosed2 {
    Enclosed2 { point: point.map(|c| c.middle), radius: point[0].radius.max(point[1].radius) }
}

/// Where a point on an edge of one domain lies on the same edge of another; `None` off all edges.
fn along_edge(from: &PlanarDomain, to: &PlanarDomain, point: Point2) -> Option<Enclosed2> {
    let is_between = |p: Point2, q: Point2, k: usize| p[k].min(q[k]) <= point[k] && point[k] <= p[k].max(q[k]);
    let is_on = |[p, q]: [Point2; 2]| (0..2).all(|k| is_between(p, q, k)) && orient2d(p, q, point) == Sign::Zero;
    let ([a, b], [c, d]) = from.edges().zip(to.edges()).find(|(edge, _)| is_on(*edge))?;
    let exact = |x: f64| Rational::from_f64(x).unwrap_or(Rational::ZERO);
    let axis = usize::from((b[0] - a[0]).abs() < (b[1] - a[1]).abs());
    let ratio = (exact(point[axis]) - exact(a[axis])) / (exact(b[axis]) - exact(a[axis]));
    let there: [Interval; 2] =
        std::array::from_fn(|k| Interval::around(&(exact(c[k]) + &ratio * &(exact(d[k]) - exact(c[k])))));
    let [x, y] = there.map(|interval| interval.middle_and_radius());
    Some(Enclosed2 { point: [x.0, y.0], radius: x.1.max(y.1) })
}
