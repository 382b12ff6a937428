//! Points move with a cage, in as many steps as it takes.

use super::map::CageMap;
use super::pair::CagePair;
use super::verdict::{Moved, Verdict, judge};
use crate::coordinates::{CoordinateError, PolyhedronError};
use crate::progress::Progress;
use crate::shape::{PolyhedronPath, PolyhedronPathError};

type Point3 = [f64; 3];

/// How many steps are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Steps {
    /// At first; at least 1.
    pub first: usize,
    /// At most: while the result is folded, the number is doubled up to this.
    pub most: usize,
}

impl Default for Steps {
    /// One, doubled up to 64.
    fn default() -> Self {
        Self { first: 1, most: 64 }
    }
}

/// Why nothing could be moved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DeformError {
    /// A cage in between has triangles without area.
    #[error("the cage at time {time}: {error}; take another number of steps, or another path")]
    Between {
        /// Between 0 and 1.
        time: f64,
        /// What is wrong.
        error: PolyhedronError,
    },
    /// A point has no image.
    #[error("at time {time}: {error}; put all points inside of the cage")]
    NoImage {
        /// Between 0 and 1.
        time: f64,
        /// Which point, where it was at that time.
        error: CoordinateError,
    },
    /// There is no cage at a time.
    #[error(transparent)]
    Path(#[from] PolyhedronPathError),
    /// The work was stopped.
    #[error("stopped")]
    Cancelled,
}

/// What has moved.
#[derive(Clone, Debug, PartialEq)]
pub struct Deformed {
    /// Places after, #P by 3.
    pub positions: Vec<Point3>,
    /// How many steps were made.
    pub steps: usize,
    /// What is decided of the mesh.
    pub verdict: Verdict,
    /// The first time at which a cage in between meets itself. No claim rests on cages in between.
    pub crossing_cage: Option<f64>,
}

/// Moves points (#P by 3) with a cage along a path of cages, by mean value coordinates of each cage towards the next, and
/// judges the mesh that they are the vertices of. While the verdict is bad the number of steps is doubled.
///
/// A point on the cage moves with its triangle, up to rounding. The mesh before must be sound: [`judge`].
///
/// # Errors
/// A cage in between without area, a point where weights sum to zero (outside of the cage only), a stop.
///
/// # Complexity
/// #P times #F for each step; in parallel, with the same result on every number of threads.
pub fn deform(
    cages: &CagePair,
    path: &dyn PolyhedronPath,
    mesh: Moved<'_>,
    points: &[Point3],
    steps: Steps,
    progress: &dyn Progress,
) -> Result<Deformed, DeformError> {
    let mut count = steps.first.max(1);
    loop {
        let map = CageMap::along(cages, path, count)?;
        let positions = map.forward(points, progress)?;
        let verdict = judge(mesh, points, &positions);
        let is_sound = matches!(verdict, Verdict::Embedded | Verdict::NothingToJudge);
        if is_sound || matches!(verdict, Verdict::Undecided { .. }) || 2 * count > steps.most {
            return Ok(Deformed { positions, steps: count, verdict, crossing_cage: map.crossing() });
        }
        count *= 2;
    }
}
