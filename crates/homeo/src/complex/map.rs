//! Complex maps with speeds, proved to be one-to-one.

use homeo_core::planar::{DomainPair, PlanarDomain, Point2};

use super::error::{ComplexError, SpeedError};
use super::invert::{self, Start};
use super::optimize::Search;
use super::speed::EdgeSpeeds;
use crate::composite::chart::Step;
use crate::composite::number::{Form, Number};
use crate::composite::{Jacobian, JacobianLimits, JacobianVerdict, Tiling, check_tiling, triangulate};
use crate::map::{Enclosed2, PlanarBijection, PlanarEvaluationError};
use crate::progress::Progress;

/// How a complex map is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComplexParams {
    /// Degree of the speeds, from 2 to 8; 1 has nothing to choose.
    pub degree: usize,
    /// So often a point where the proof failed is added to the samples, and the search goes on.
    pub rounds: usize,
    /// Limits of the proof.
    pub limits: JacobianLimits,
}

impl Default for ComplexParams {
    fn default() -> Self {
        let limits = JacobianLimits { boxes_per_chart: 20_000, ..JacobianLimits::default() };
        Self { degree: 4, rounds: 4, limits }
    }
}

/// How a complex map came about.
#[derive(Clone, Debug, PartialEq)]
pub struct ComplexInfo {
    /// The determinant is proved to be no less than this.
    pub least_determinant: f64,
    /// The least determinant at samples, and of linear speeds at the same.
    pub sampled: [f64; 2],
    /// Boxes that the proof evaluated.
    pub boxes: u64,
    /// How many times points were added to the samples.
    pub rounds: usize,
}

/// A homeomorphism between planar domains: `h(z) = sum γ_i(z) s_i(z) / sum γ_i(z)`, where
/// `s_i(z) = h_i + (h_{i+1} - h_i) (σ_i(Re τ_i) + i Im τ_i)`, `τ_i = (z - z_i) / e_i`, and `γ_i` is the complex weight of edge
/// `i` of mean value coordinates ([`ComplexCoordinates`](crate::coordinates::ComplexCoordinates) with `p = 1`).
///
/// # Guarantee
/// The vertices and control values stored define the map. It is proved to be a homeomorphism of the closed domains that
/// sends edges onto edges by their speeds `σ_i`, smooth inside; but for [`from_speeds`](Self::from_speeds), where a
/// certificate has to say so. Linear speeds give the mean value map.
///
/// ```
/// use homeo::complex::{ComplexMap, ComplexParams};
/// use homeo::progress::Silent;
/// use homeo_core::planar::DomainPair;
/// let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
/// let other = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.8, 0.9], [0.1, 1.0]]];
/// let pair = DomainPair::new(square, other)?;
/// let (map, info) = ComplexMap::build(&pair, &ComplexParams::default(), &Silent)?;
/// assert!(info.least_determinant > 0.0);
/// let image = map.forward([0.7, 0.6])?;
/// let back = map.inverse(image.point)?;
/// assert!((back.point[0] - 0.7).abs() < 1e-12 && back.radius < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ComplexMap {
    source: PlanarDomain,
    target: PlanarDomain,
    tiling: Tiling,
    step: Step,
    starts: Vec<Start>,
}

/// Bounds the Jacobian determinant of the complex map of given speeds from below.
///
/// # Guarantee
/// [`JacobianVerdict::Positive`] is proved in the open domain, and in the limit towards vertices and edges: the map is a
/// homeomorphism. [`JacobianVerdict::Negative`] is proved at its point, of the open domain. Nothing depends on the number of
/// threads.
///
/// # Errors
/// There are not as many speeds as edges; or the source was not cut into triangles.
///
/// # Complexity
/// Boxes times vertices.
///
/// ```
/// use homeo::complex::{EdgeSpeeds, bound_complex_jacobian};
/// use homeo::composite::{JacobianLimits, JacobianVerdict};
/// use homeo_core::planar::DomainPair;
/// let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
/// let arrow = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.1, 0.1], [0.0, 1.0]]];
/// let pair = DomainPair::new(square, arrow).unwrap();
/// let verdict = bound_complex_jacobian(&pair, &EdgeSpeeds::linear(4), &JacobianLimits::default()).unwrap();
/// assert!(matches!(verdict, JacobianVerdict::Negative { .. }));
/// ```
pub fn bound_complex_jacobian(
    pair: &DomainPair,
    speeds: &EdgeSpeeds,
    limits: &JacobianLimits,
) -> Result<JacobianVerdict, ComplexError> {
    let step = plain_step(pair, &triangulate(&pair.source)?);
    Ok(fitting(step, speeds.clone())?.bound(limits, 0, &|| false).0)
}

/// The mean value map, with the charts of triangles that tile the source.
fn plain_step(pair: &DomainPair, tiling: &Tiling) -> Step {
    Step::new(&pair.source, tiling, pair.target.vertices().collect())
}

fn fitting(step: Step, speeds: EdgeSpeeds) -> Result<Step, SpeedError> {
    let (edges, found) = (step.points.len(), speeds.control_values().len());
    if edges != found {
        return Err(SpeedError::Edges { edges, found });
    }
    Ok(step.with_speeds(speeds))
}

impl ComplexMap {
    /// Seeks speeds that make the least determinant as large as it can, and proves that it is positive.
    ///
    /// # Errors
    /// The map of the best speeds found folds, or is undecided, and where; the degree is none.
    ///
    /// # References
    /// Schneider 2017, (7.3), with a proof after each search.
    pub fn build(
        pair: &DomainPair,
        params: &ComplexParams,
        progress: &(dyn Progress + Sync),
    ) -> Result<(Self, ComplexInfo), ComplexError> {
        if !(1..=8).contains(&params.degree) {
            return Err(SpeedError::Degree { degree: params.degree }.into());
        }
        let is_cancelled = || progress.is_cancelled();
        progress.stage("speeds");
        let tiling = triangulate(&pair.source)?;
        let step = plain_step(pair, &tiling);
        let domains = [&pair.source, &pair.target];
        let mut search = Search::new(&step, domains, params.degree, &is_cancelled);
        let mut rounds = 0;
        loop {
            search.ascend(&is_cancelled);
            if is_cancelled() {
                return Err(ComplexError::Stopped);
            }
            progress.stage("proof");
            let proved = fitting(step.clone(), search.speeds()?)?;
            // Best speeds that fold at samples do not get better by more samples.
            let mut folds = search.folds().into_iter().filter(|&point| pair.source.contains(point));
            if let Some((point, at_most)) = folds.find_map(|point| Some((point, proved.fold_at(point)?))) {
                return Err(ComplexError::Folds { point, at_most });
            }
            let (verdict, _) = proved.bound(&params.limits, 0, &is_cancelled);
            if is_cancelled() {
                return Err(ComplexError::Stopped);
            }
            let (point, error) = match verdict {
                JacobianVerdict::Positive { least, boxes } => {
                    let info = ComplexInfo { least_determinant: least, sampled: search.sampled(), boxes, rounds };
                    return Ok((Self::of(pair, tiling, proved), info));
                }
                JacobianVerdict::Negative { point, at_most, .. } => (point, ComplexError::Folds { point, at_most }),
                JacobianVerdict::Undecided { point, .. } => (point, ComplexError::Undecided { point }),
            };
            if rounds >= params.rounds {
                return Err(error);
            }
            search.insist(point);
            rounds += 1;
        }
    }

    /// The map of given speeds, proved.
    ///
    /// # Errors
    /// The speeds do not fit; the map folds, or is undecided, and where.
    pub fn with_speeds(pair: &DomainPair, speeds: EdgeSpeeds, limits: &JacobianLimits) -> Result<Self, ComplexError> {
        match bound_complex_jacobian(pair, &speeds, limits)? {
            JacobianVerdict::Positive { .. } => Ok(Self::from_speeds(pair, speeds)?),
            JacobianVerdict::Negative { point, at_most, .. } => Err(ComplexError::Folds { point, at_most }),
            JacobianVerdict::Undecided { point, .. } => Err(ComplexError::Undecided { point }),
        }
    }

    /// The map of given speeds. That it is one-to-one is not proved here: a certificate of the map says so, or
    /// [`bound_complex_jacobian`].
    ///
    /// # Errors
    /// There are not as many speeds as edges; or the source was not cut into triangles.
    ///
    /// # Example
    /// ```
    /// use homeo::complex::{ComplexMap, EdgeSpeeds};
    /// use homeo_core::planar::DomainPair;
    /// let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
    /// let pair = DomainPair::new(square.clone(), square)?;
    /// let map = ComplexMap::from_speeds(&pair, EdgeSpeeds::linear(4))?;
    /// assert!((map.forward([0.25, 0.5])?.point[0] - 0.25).abs() < 1e-12);
    /// assert!(ComplexMap::from_speeds(&pair, EdgeSpeeds::linear(3)).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_speeds(pair: &DomainPair, speeds: EdgeSpeeds) -> Result<Self, ComplexError> {
        Self::from_parts(pair, triangulate(&pair.source)?, speeds)
    }

    /// As [`from_speeds`](Self::from_speeds), with triangles that tile the source.
    ///
    /// # Errors
    /// There are not as many speeds as edges; or the triangles do not tile the source.
    pub fn from_parts(pair: &DomainPair, tiling: Tiling, speeds: EdgeSpeeds) -> Result<Self, ComplexError> {
        check_tiling(&pair.source, &tiling)?;
        let step = fitting(plain_step(pair, &tiling), speeds)?;
        Ok(Self::of(pair, tiling, step))
    }

    fn of(pair: &DomainPair, tiling: Tiling, step: Step) -> Self {
        let (source, target) = (pair.source.clone(), pair.target.clone());
        let mut this = Self { source, target, tiling, step, starts: Vec::new() };
        this.starts = invert::starts(&this);
        this
    }

    /// The speeds.
    pub fn speeds(&self) -> &EdgeSpeeds {
        &self.step.speeds
    }

    /// The triangles in which the proof is made.
    pub fn tiling(&self) -> &Tiling {
        &self.tiling
    }

    pub(super) fn step(&self) -> &Step {
        &self.step
    }

    pub(super) fn start_points(&self) -> &[Start] {
        &self.starts
    }

    /// Image of a point of the source, with a bound of the error. Vertices go to vertices exactly.
    ///
    /// # Errors
    /// The point is not in the source, exactly, or not a number; or it is within rounding of a vertex.
    ///
    /// # Complexity
    /// Linear in #V.
    pub fn forward(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(PlanarEvaluationError::NotFinite);
        }
        if !self.source.contains(point) {
            return Err(PlanarEvaluationError::Outside("source"));
        }
        if let Some(image) = invert::along_edge(self, point) {
            return Ok(image);
        }
        let image = self.step.enclose(point.map(Form::of));
        let radius = image[0].radius().max(image[1].radius());
        if !radius.is_finite() {
            return Err(PlanarEvaluationError::NotProved(0));
        }
        Ok(Enclosed2 { point: image.map(|c| c.middle), radius })
    }

    /// The point of the source whose image is given, with a bound of the error.
    ///
    /// # Errors
    /// The point is not in the target, exactly, or not a number; or the preimage is not proved to be near.
    ///
    /// # Complexity
    /// Some ten to a hundred times [`forward`](Self::forward).
    pub fn inverse(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(PlanarEvaluationError::NotFinite);
        }
        if !self.target.contains(point) {
            return Err(PlanarEvaluationError::Outside("target"));
        }
        if let Some(preimage) = invert::back_along_edge(self, point) {
            return Ok(preimage);
        }
        invert::invert(self, point).ok_or(PlanarEvaluationError::NotProved(0))
    }

    /// The derivative at a point, rounded; rows are the gradients of the two coordinates of the image. `None` outside and
    /// at vertices.
    pub fn jacobian(&self, point: Point2) -> Option<Jacobian> {
        if !self.source.contains(point) || self.step.points.contains(&point) {
            return None;
        }
        let (_, rows) = self.step.value(point);
        rows.iter().flatten().all(|d| d.is_finite()).then_some(rows)
    }
}

impl PlanarBijection for ComplexMap {
    fn source(&self) -> &PlanarDomain {
        &self.source
    }

    fn target(&self) -> &PlanarDomain {
        &self.target
    }

    fn forward(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        ComplexMap::forward(self, point)
    }

    fn inverse(&self, point: Point2) -> Result<Enclosed2, PlanarEvaluationError> {
        ComplexMap::inverse(self, point)
    }
}
