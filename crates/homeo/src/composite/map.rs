//! Composite maps: several mean value maps, one after the other, each proved to be one-to-one.

use homeo_core::number::{Interval, Rational};
use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::predicate::{Sign, orient2d};

use super::chart::Step;
use super::evaluate::{Jacobian, Region};
use super::invert::{InverseError, invert};
use super::number::{Form, Number};
use super::partition::{Partition, PartitionError, PartitionParams, Stage, binary_partition, given_partition};
use super::track::{self, Track};
use super::triangulation::{Tiling, TriangulationError, check_tiling, triangulate};
use crate::map::{Enclosed2, PlanarBijection, PlanarEvaluationError};
use crate::progress::Progress;
use crate::shape::ShapePath;

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
#[derive(Clone, Debug, PartialEq)]
pub struct CompositeInfo {
    /// The times of all domains on the path.
    pub times: Vec<f64>,
    /// For each step a number that its Jacobian determinant is proved to be no less than.
    pub bounds: Vec<f64>,
    /// The least of them.
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
/// The numbers stored define the map: the vertices of all domains. [`build`](Self::build) proves that the Jacobian determinant
/// of every step is positive, so that it is a homeomorphism of the closed domains, linear on every edge. A map that was
/// put together by [`from_domains`](Self::from_domains), or read from a file, is as good as its certificate.
///
/// ```
/// use homeo::composite::{CompositeMap, PartitionParams};
/// use homeo::progress::Silent;
/// use homeo::shape::LinearPath;
/// use homeo_core::planar::DomainPair;
/// let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
/// let kite = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.4, 0.4], [0.0, 1.0]]];
/// let path = LinearPath::between(&DomainPair::new(square, kite).unwrap()).unwrap();
/// let (map, info) = CompositeMap::build(&path, &PartitionParams::default(), &Silent).unwrap();
/// assert!(map.step_count() > 1 && info.least_determinant > 0.0);
/// let image = map.forward([0.7, 0.6]).unwrap();
/// let back = map.inverse(image.point).unwrap();
/// assert!((back.point[0] - 0.7).abs() < 1e-12 && back.radius < 1e-9);
/// ```
#[derive(Clone, Debug)]
pub struct CompositeMap {
    domains: Vec<PlanarDomain>,
    tilings: Vec<Tiling>,
    steps: Vec<Step>,
    /// From each domain to the one before: near the inverse, to begin the search for it with.
    backward: Vec<Step>,
}

/// Why domains and triangles make no composite map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CompositePartsError {
    /// Two domains are needed, and triangles for each but the last.
    #[error(
        "{domains} domains and {tilings} tilings were given; a map has two domains or more, and a tiling for each but the last"
    )]
    Counts {
        /// How many domains there are.
        domains: usize,
        /// How many tilings.
        tilings: usize,
    },
    /// The rings of a domain do not correspond to those of the first.
    #[error("domain {0} has rings of other numbers of vertices than the first")]
    OtherRings(usize),
    /// Triangles do not tile their domain, or the last domain could not be cut into triangles.
    #[error("domain {domain}: {error}")]
    Tiling {
        /// The domain.
        domain: usize,
        /// What is wrong.
        error: TriangulationError,
    },
}

impl CompositeMap {
    /// Finds a composite map by bisection of time: one step if that is one-to-one.
    ///
    /// # Errors
    /// At which time the vertices bound no domain, or which limit was reached where.
    pub fn build(
        path: &dyn ShapePath,
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
        path: &dyn ShapePath,
        times: &[f64],
        params: &PartitionParams,
        progress: &(dyn Progress + Sync),
    ) -> Result<(Self, CompositeInfo), PartitionError> {
        Ok(Self::from_partition(given_partition(path, times, params, progress)?))
    }

    /// The map by domains and tilings that are known already. That it is one-to-one is not proved here: a certificate of the map
    /// says so, or [`bound_jacobian`](super::bound_jacobian) for each step.
    ///
    /// # Errors
    /// What does not fit together.
    pub fn from_domains(domains: Vec<PlanarDomain>, mut tilings: Vec<Tiling>) -> Result<Self, CompositePartsError> {
        if domains.len() < 2 || tilings.len() + 1 != domains.len() {
            return Err(CompositePartsError::Counts { domains: domains.len(), tilings: tilings.len() });
        }
        let sizes = |domain: &PlanarDomain| domain.rings().iter().map(Vec::len).collect::<Vec<_>>();
        if let Some(number) = domains.iter().position(|domain| sizes(domain) != sizes(&domains[0])) {
            return Err(CompositePartsError::OtherRings(number));
        }
        let wrong = |domain: usize| move |error: TriangulationError| CompositePartsError::Tiling { domain, error };
        for (number, tiling) in tilings.iter().enumerate() {
            check_tiling(&domains[number], tiling).map_err(wrong(number))?;
        }
        // Only the way back needs triangles of the target; no claim rests on them.
        let last = domains.len() - 1;
        tilings.push(triangulate(&domains[last]).map_err(wrong(last))?);
        Ok(Self::new(domains, tilings))
    }

    fn from_partition(partition: Partition) -> (Self, CompositeInfo) {
        let Partition { stages, bounds, boxes: [boxes, all], tried } = partition;
        let least_determinant = bounds.iter().copied().fold(f64::INFINITY, f64::min);
        let times = stages.iter().map(|stage| stage.time).collect();
        let info = CompositeInfo { times, bounds, least_determinant, boxes, boxes_in_vain: all - boxes, tried };
        let (domains, tilings) = stages.into_iter().map(|Stage { domain, tiling, .. }| (domain, tiling)).unzip();
        (Self::new(domains, tilings), info)
    }

    /// Tilings of all domains, of the last one too.
    fn new(domains: Vec<PlanarDomain>, mut tilings: Vec<Tiling>) -> Self {
        let step = |from: usize, to: usize| Step::new(&domains[from], &tilings[from], domains[to].vertices().collect());
        let steps = (1..domains.len()).map(|number| step(number - 1, number)).collect();
        let backward = (1..domains.len()).map(|number| step(number, number - 1)).collect();
        tilings.pop();
        Self { domains, tilings, steps, backward }
    }

    /// How many steps it has.
    pub fn step_count(&self) -> usize {
        self.steps.len()
    }

    /// All domains, from the source to the target.
    pub fn domains(&self) -> &[PlanarDomain] {
        &self.domains
    }

    /// For each domain but the last the triangles that tile it, in which the proof is made.
    pub fn tilings(&self) -> &[Tiling] {
        &self.tilings
    }

    pub(super) fn steps(&self) -> &[Step] {
        &self.steps
    }

    pub(super) fn backward(&self) -> &[Step] {
        &self.backward
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
        let mut here: Region = point.map(Form::of);
        for (number, step) in self.steps.iter().enumerate() {
            here = step.enclose(here);
            if here.iter().any(|c| c.radius().is_nan()) {
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
            let domains = [&self.domains[number], &self.domains[number + 1]];
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
        &self.domains[0]
    }

    fn target(&self) -> &PlanarDomain {
        &self.domains[self.steps.len()]
    }

    fn forward(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        Ok(CompositeMap::forward(self, point)?)
    }

    fn inverse(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        Ok(CompositeMap::inverse(self, point)?)
    }

    fn forward_along(&self, points: &[Point2], images: &mut [Option<Point2>]) {
        images.iter_mut().zip(track::images(self, points)).for_each(|(image, found)| *image = found);
    }

    /// By Newton's method from the point before.
    fn inverse_along(&self, points: &[Point2], preimages: &mut [Option<Point2>]) {
        let mut track = Track::new(self);
        for (preimage, &point) in preimages.iter_mut().zip(points) {
            *preimage = track.preimage(point);
        }
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

fn enclosed(point: Region) -> Enclosed2 {
    Enclosed2 { point: point.map(|c| c.middle), radius: point[0].radius().max(point[1].radius()) }
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
