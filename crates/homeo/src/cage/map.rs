//! Mean value maps between cages, one after the other.

use super::deform::DeformError;
use super::inside::is_fit;
use super::pair::{CagePair, first_fault};
use crate::coordinates::{MeanValuePolyhedron, SpatialCoordinates};
use crate::progress::Progress;
use crate::shape::PolyhedronPath;

type Point3 = [f64; 3];

/// Why cages make no map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StagesError {
    /// Two are needed, a source and a target.
    #[error("{0} cages were given; a map has two or more")]
    Few(usize),
    /// A cage has another number of vertices than the first.
    #[error("cage {0} has another number of vertices than the first")]
    OtherVertices(usize),
    /// A vertex of a cage has a coordinate that is neither zero nor between `2^-300` and `2^300` in size.
    #[error("a vertex of cage {0} has a coordinate that is not finite, or too large or too small to decide signs")]
    NotFinite(usize),
    /// A triangle has a vertex that does not exist.
    #[error("triangle {0} has a vertex that does not exist")]
    NoVertex(usize),
}

/// A composite mean value map: from a cage to the next along a path, in steps.
///
/// # Guarantee
/// None by itself. Whether it is a homeomorphism from the inside of the first cage onto that of the last is decided by the
/// independent checker, for the file that [`write_cages`](crate::certificate::write_cages) makes of it; rules Q1 to Q3 of
/// `docs/theory/cages.md`. It is linear on every triangle.
///
/// # Example
/// ```
/// use homeo::cage::{CageMap, CagePair};
/// use homeo::progress::Silent;
/// use homeo::shape::StraightPolyhedra;
/// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
/// let higher = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 8.0]];
/// let cages = CagePair::new(corners, higher, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let path = StraightPolyhedra::new(cages.source().to_vec(), cages.target().to_vec())?;
/// let map = CageMap::along(&cages, &path, 2)?;
/// let moved = map.forward(&[[1.0, 1.0, 1.0]], &Silent)?;
/// let expected = [1.25, 1.25, 2.0];
/// assert!((0..3).all(|k| (moved[0][k] - expected[k]).abs() < 1e-12));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CageMap {
    triangles: Vec<[u32; 3]>,
    stages: Vec<Vec<Point3>>,
}

impl CageMap {
    /// Along a path, by cages at even times; `steps` is at least 1.
    ///
    /// # Errors
    /// There is no cage at a time.
    pub fn along(cages: &CagePair, path: &dyn PolyhedronPath, steps: usize) -> Result<Self, DeformError> {
        let mut stages = vec![cages.source().to_vec()];
        for step in 1..steps {
            stages.push(path.at(step as f64 / steps as f64)?);
        }
        stages.push(cages.target().to_vec());
        Ok(Self { triangles: cages.triangles().to_vec(), stages })
    }

    /// By cages (#V by 3 each) that are known already, with the same triangles (#F by 3). That it is one-to-one is not proved
    /// here: a certificate says so.
    ///
    /// # Errors
    /// When there are fewer than two cages, they have different numbers of vertices, coordinates are not finite or of no
    /// reasonable size, or triangles name vertices that do not exist.
    pub fn from_stages(stages: Vec<Vec<Point3>>, triangles: Vec<[u32; 3]>) -> Result<Self, StagesError> {
        let count = stages.first().map_or(0, Vec::len);
        if stages.len() < 2 {
            return Err(StagesError::Few(stages.len()));
        }
        if let Some(number) = stages.iter().position(|stage| stage.len() != count) {
            return Err(StagesError::OtherVertices(number));
        }
        if let Some(number) = stages.iter().position(|stage| !stage.iter().all(is_fit)) {
            return Err(StagesError::NotFinite(number));
        }
        match triangles.iter().position(|triangle| triangle.iter().any(|&v| v as usize >= count)) {
            Some(triangle) => Err(StagesError::NoVertex(triangle)),
            None => Ok(Self { triangles, stages }),
        }
    }

    /// The triangles of all cages, #F by 3: counter-clockwise or clockwise from outside, as they were given.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The vertices of each cage from the first to the last, #V by 3.
    pub fn stages(&self) -> &[Vec<Point3>] {
        &self.stages
    }

    /// How many maps there are.
    pub fn step_count(&self) -> usize {
        self.stages.len() - 1
    }

    /// When the cage with this number is reached: from 0 to 1.
    fn time(&self, stage: usize) -> f64 {
        stage as f64 / self.step_count() as f64
    }

    /// When a cage in between meets itself, first.
    pub fn crossing(&self) -> Option<f64> {
        let crosses = |&stage: &usize| first_fault(&self.stages[stage], &self.triangles).is_some();
        (1..self.step_count()).find(crosses).map(|stage| self.time(stage))
    }

    /// Where points go, #P by 3: rounded in every step, so to some `10^-15` of the size of the cages unless coordinates are
    /// badly conditioned.
    ///
    /// # Errors
    /// A cage in between has triangles without area; a point where weights add up to zero, outside of the cage only; a stop.
    ///
    /// # Complexity
    /// #P times #F for each step; in parallel, with the same result on every number of threads.
    pub fn forward(&self, points: &[Point3], progress: &dyn Progress) -> Result<Vec<Point3>, DeformError> {
        let mut places = points.to_vec();
        for (step, pair) in self.stages.windows(2).enumerate() {
            if progress.is_cancelled() {
                return Err(DeformError::Cancelled);
            }
            let time = self.time(step);
            let kind = MeanValuePolyhedron::new(&pair[0], &self.triangles)
                .map_err(|error| DeformError::Between { time, error })?;
            // By displacements: where nothing moves, points stay to the last bit.
            let shift = |(a, b): (&Point3, &Point3)| [0, 1, 2].map(|k| b[k] - a[k]);
            let shifts: Vec<Point3> = pair[0].iter().zip(&pair[1]).map(shift).collect();
            let sums = kind.combine(&shifts, &places).map_err(|error| DeformError::NoImage { time, error })?;
            places.iter_mut().zip(&sums).for_each(|(place, sum)| (0..3).for_each(|k| place[k] += sum[k]));
        }
        Ok(places)
    }
}
