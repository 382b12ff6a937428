//! Foliation of a disk or ball by segments, and the map onto square, disk, cube or ball.
//!
//! Theorem:     a direction per cell whose dual graph is acyclic and locally bipolar gives a homeomorphism onto (source region) x [0, 1].
//! Source:      Campen, Silva, Zorin 2016 (doi 10.1145/2897824.2925890), propositions 1-4 and 7, algorithm 1.
//! Differences: the proof is by induction over the cells (page of the map file) and holds on the boundary without genericity;
//!              source and sink grow as disks instead of being repaired; directions are 8-bit whole numbers;
//!              facets are turned round by a test that also keeps an explicit order.
//! Arithmetic:  the order is combinatorial; signs, zero sums and lengths are whole numbers; fields and smoothing are floating point and only guide.
//! Cost:        linear in the cells, but for the harmonic field (conjugate gradients) and a sort.
//! Fails when:  the greedy front gets stuck after all restarts and refinements -> [`FoliationError::Stuck`].
//! See:         `docs/methods/foliation.md`.

mod boundary;
mod build;
mod directions;
mod field;
mod front;
mod numbering;
mod regions;
mod section;

pub use directions::OFFSET_SUM;
pub use regions::{RegionError, RequestedRegions};
pub use section::NotEmbedded;

use crate::input::SourceMesh;
use crate::map::{Foliation, Target};
use crate::progress::Progress;
use crate::refine::TooDeep;

/// How to build a foliation.
#[derive(Clone, Debug)]
pub struct FoliationParams {
    /// Sweeps of smoothing over the direction field, each followed by turning of facets.
    pub smoothing_sweeps: usize,
    /// Runs of the front before the mesh is refined (fewer on large meshes): alternately from the source
    /// and from the sink, from the third on with the paper's field, from the fifth on with it disturbed.
    pub restarts: usize,
    /// Refinements before the construction gives up.
    pub refinements: usize,
    /// No refinement that would make more cells than this is tried.
    pub most_cells: usize,
    /// Seed of the disturbances.
    pub seed: u64,
    /// Regions that the user asks for.
    pub regions: RequestedRegions,
}

impl Default for FoliationParams {
    fn default() -> Self {
        Self {
            smoothing_sweeps: 10,
            restarts: 16,
            refinements: 6,
            most_cells: 4_000_000,
            seed: 1,
            regions: RequestedRegions::default(),
        }
    }
}

/// What happened during a construction.
#[derive(Clone, Debug, Default)]
pub struct FoliationInfo {
    /// Runs of the front that got stuck.
    pub restarts: usize,
    /// Refinements round stuck cells.
    pub local_refinements: usize,
    /// Barycentric refinements of the whole mesh.
    pub barycentric_refinements: usize,
    /// Facets turned round while smoothing.
    pub facets_turned: usize,
    /// Cells that the last front could not take (0 when it succeeded).
    pub stuck_cells: usize,
    /// Cells of the foliated mesh.
    pub cells: usize,
    /// Vertices of the foliated mesh.
    pub vertices: usize,
    /// Seconds per stage, in order; a stage may occur more than once.
    pub seconds: Vec<(&'static str, f64)>,
}

/// Why no foliation was made.
#[derive(Clone, Debug, thiserror::Error)]
pub enum FoliationError {
    /// The mesh is not what the construction needs.
    #[error("{0}")]
    Input(String),
    /// The target has another dimension than the mesh.
    #[error("a {mesh} cannot be mapped onto a {target}")]
    WrongTarget {
        /// What the mesh is.
        mesh: &'static str,
        /// What was asked for.
        target: Target,
    },
    /// A region cannot be used or found.
    #[error(transparent)]
    Region(#[from] RegionError),
    /// No order of the cells was found within the limits.
    #[error(
        "no order of the cells was found: after {} runs, {} local and {} barycentric refinements the front still stops with {} of {} cells left. \
         The mesh may have no shelling near this refinement (knotted holes do that); more --refinements or another mesh may help",
        .0.restarts, .0.local_refinements, .0.barycentric_refinements, .0.stuck_cells, .0.cells
    )]
    Stuck(FoliationInfo),
    /// The source region has no embedding in double precision.
    #[error(transparent)]
    Section(#[from] NotEmbedded),
    /// Refinement went too deep for exact weights.
    #[error(transparent)]
    TooDeep(#[from] TooDeep),
    /// Stopped from outside (time limit, interrupt).
    #[error("stopped before a map was found, during stage `{}`", .0.seconds.last().map_or("start", |s| s.0))]
    Cancelled(FoliationInfo),
}

/// Builds a bijective map of a triangle mesh that is a disk onto the square or disk, or of a
/// tetrahedral mesh that is a ball onto the cube or ball.
///
/// # Preconditions
/// The mesh is a disk (`K = 3`) or ball (`K = 4`) by its links, without degenerate cells.
///
/// # Errors
/// See [`FoliationError`].
pub fn build<const K: usize>(
    source: &SourceMesh<K>,
    target: Target,
    params: &FoliationParams,
    progress: &dyn Progress,
) -> Result<(Foliation<K>, FoliationInfo), FoliationError> {
    if target.dimension() + 1 != K {
        return Err(FoliationError::WrongTarget { mesh: if K == 3 { "surface" } else { "volume" }, target });
    }
    build::build(source, target, params, progress)
}
