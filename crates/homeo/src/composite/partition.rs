//! Domains between two, so close that every step is proved to be one-to-one.

use std::time::{Duration, Instant};

use homeo_core::planar::{DomainError, PlanarDomain};

use super::bound::{JacobianLimits, JacobianVerdict};
use super::chart::Step;
use super::triangulation::{Tiling, TriangulationError, triangulate};
use crate::progress::Progress;
use crate::shape::{ShapeError, ShapePath};

/// What a partition may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartitionParams {
    /// At most so many steps.
    pub steps: usize,
    /// No step is shorter than this, in time.
    pub shortest: f64,
    /// How long one step is tried before it is bisected.
    pub limits: JacobianLimits,
    /// How long the search may take; what it finds does not depend on it otherwise.
    pub timeout: Option<Duration>,
}

impl Default for PartitionParams {
    fn default() -> Self {
        Self { steps: 1000, shortest: 2f64.powi(-20), limits: JacobianLimits::default(), timeout: None }
    }
}

/// Why there is no composite map.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PartitionError {
    /// The vertices at a time bound no domain.
    #[error("at time {time} the vertices bound no domain: {error}")]
    NotADomain {
        /// The time.
        time: f64,
        /// What is wrong there.
        error: DomainError,
    },
    /// There is no shape at a time.
    #[error("at time {time}: {error}")]
    NoShape {
        /// The time.
        time: f64,
        /// What is wrong there.
        error: ShapeError,
    },
    /// A domain was not cut into triangles.
    #[error("at time {time}: {error}")]
    NoTriangles {
        /// The time.
        time: f64,
        /// What is wrong there.
        error: TriangulationError,
    },
    /// More steps are needed than allowed.
    #[error("{0} steps reach to time {1} only")]
    TooManySteps(usize, f64),
    /// A step is not proved to be one-to-one, and as short as allowed.
    #[error("the step from time {from} to {to} is not proved to be one-to-one: {verdict:?}")]
    NotProved {
        /// Where it begins.
        from: f64,
        /// Where it ends.
        to: f64,
        /// What is known of it.
        verdict: JacobianVerdict,
    },
    /// The time allowed is over, or the work was cancelled.
    #[error("stopped at time {0} of the path, after {1} steps")]
    Stopped(f64, usize),
}

/// One domain on the way.
#[derive(Clone, Debug)]
pub(super) struct Stage {
    pub time: f64,
    pub domain: PlanarDomain,
    pub tiling: Tiling,
}

impl Stage {
    pub fn at(path: &dyn ShapePath, time: f64) -> Result<Self, PartitionError> {
        let rings = path.at(time).map_err(|error| PartitionError::NoShape { time, error })?;
        let domain = PlanarDomain::new(rings).map_err(|error| PartitionError::NotADomain { time, error })?;
        let tiling = triangulate(&domain).map_err(|error| PartitionError::NoTriangles { time, error })?;
        Ok(Self { time, domain, tiling })
    }

    /// The mean value map to another stage.
    pub fn step_to(&self, next: &Self) -> Step {
        Step::new(&self.domain, &self.tiling, next.domain.vertices().collect())
    }
}

/// A partition: all stages, and what is proved of each step.
pub(super) struct Partition {
    pub stages: Vec<Stage>,
    pub bounds: Vec<f64>,
    /// Boxes evaluated for accepted steps, and for all that were tried.
    pub boxes: [u64; 2],
    /// Steps that were tried.
    pub tried: usize,
}

/// Bisects time until every step is proved to be one-to-one: the fewest steps of this kind.
///
/// # References
/// Schneider 2017, algorithm 1, with a proof in the place of samples.
pub(super) fn binary_partition(
    path: &dyn ShapePath,
    params: &PartitionParams,
    progress: &(dyn Progress + Sync),
) -> Result<Partition, PartitionError> {
    let start = Instant::now();
    let is_stopped = || progress.is_cancelled() || params.timeout.is_some_and(|limit| start.elapsed() > limit);
    progress.stage("partition");
    let mut partition = Partition { stages: vec![Stage::at(path, 0.0)?], bounds: Vec::new(), boxes: [0; 2], tried: 0 };
    let mut ahead = vec![Stage::at(path, 1.0)?];
    // Where the last attempt from the same domain failed.
    let mut suspect = 0;
    while let (Some(next), Some(here)) = (ahead.last(), partition.stages.last()) {
        let (from, to) = (here.time, next.time);
        let (verdict, chunk) = here.step_to(next).bound(&params.limits, suspect, &is_stopped);
        suspect = chunk;
        if is_stopped() {
            return Err(PartitionError::Stopped(from, partition.bounds.len()));
        }
        partition.tried += 1;
        partition.boxes[1] += verdict.boxes();
        if let JacobianVerdict::Positive { least, boxes } = verdict {
            partition.bounds.push(least);
            partition.boxes[0] += boxes;
            partition.stages.extend(ahead.pop());
        } else if to - from <= params.shortest {
            return Err(PartitionError::NotProved { from, to, verdict });
        } else {
            ahead.push(between(path, from, to)?);
        }
        if partition.bounds.len() + ahead.len() > params.steps {
            return Err(PartitionError::TooManySteps(params.steps, from));
        }
    }
    Ok(partition)
}

/// Where an interval is cut, as parts of it: in the middle, or, where that is no domain, elsewhere.
const CUTS: [f64; 7] = [0.5, 0.25, 0.75, 0.375, 0.625, 0.125, 0.875];

/// A domain between two times, as near their middle as there is one; what is wrong in the middle if there is none.
fn between(path: &dyn ShapePath, from: f64, to: f64) -> Result<Stage, PartitionError> {
    let mut stages = CUTS.iter().map(|part| Stage::at(path, from + part * (to - from)));
    let middle = stages.next().unwrap_or_else(|| Stage::at(path, to));
    middle.or_else(|error| stages.find_map(Result::ok).ok_or(error))
}

/// Proves every step of given times.
pub(super) fn given_partition(
    path: &dyn ShapePath,
    times: &[f64],
    params: &PartitionParams,
    progress: &(dyn Progress + Sync),
) -> Result<Partition, PartitionError> {
    let start = Instant::now();
    let is_stopped = || progress.is_cancelled() || params.timeout.is_some_and(|limit| start.elapsed() > limit);
    let stages = times.iter().map(|&time| Stage::at(path, time)).collect::<Result<Vec<_>, _>>()?;
    let mut partition = Partition { stages, bounds: Vec::new(), boxes: [0; 2], tried: times.len().saturating_sub(1) };
    for pair in partition.stages.windows(2) {
        let (from, to) = (pair[0].time, pair[1].time);
        let (verdict, _) = pair[0].step_to(&pair[1]).bound(&params.limits, 0, &is_stopped);
        if is_stopped() {
            return Err(PartitionError::Stopped(from, partition.bounds.len()));
        }
        let JacobianVerdict::Positive { least, boxes } = verdict else {
            return Err(PartitionError::NotProved { from, to, verdict });
        };
        partition.bounds.push(least);
        partition.boxes = partition.boxes.map(|all| all + boxes);
    }
    Ok(partition)
}
