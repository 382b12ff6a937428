//! A foliation as data, and the tables that evaluation uses.

use homeo_core::mesh::{Adjacency, CellId};

use super::locate::Locator;
use super::section::SectionIndex;
use super::steps::Steps;
use super::{Section, Target};
use crate::input::SourceMesh;
use crate::refine::RefinedMesh;

/// Accuracy of floating-point evaluation unless asked otherwise.
pub const DEFAULT_ACCURACY: f64 = 1e-8;

/// The cell that holds the centre of a disk or ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Centre {
    /// The cell.
    pub cell: CellId,
    /// Length of every leaf inside it, from its boundary to its centroid.
    pub length: u32,
}

/// The data that define a foliation map of a mesh.
#[derive(Clone, Debug)]
pub struct FoliationParts<const K: usize> {
    /// What the mesh is mapped onto.
    pub target: Target,
    /// The foliated mesh.
    pub mesh: RefinedMesh<K>,
    /// Directions in barycentric offsets, `#C by K`: rows add up to zero.
    pub directions: Vec<[i8; K]>,
    /// Leaf length in each cell per unit of its direction.
    pub lengths: Vec<u32>,
    /// What a length of 1 is in units of the mesh's box (for people).
    pub length_unit: f64,
    /// The centre, for disk and ball.
    pub centre: Option<Centre>,
    /// The map of the source region.
    pub section: Section,
}

/// A bijective map of a disk (`K = 3`) or ball (`K = 4`) along the leaves of a foliation.
#[derive(Debug)]
pub struct Foliation<const K: usize> {
    source: SourceMesh<K>,
    adjacency: Adjacency<K>,
    parts: FoliationParts<K>,
    accuracy: f64,
    pub(super) steps: Steps,
    pub(super) locator: Locator<K>,
    pub(super) section_index: SectionIndex,
}

impl<const K: usize> Foliation<K> {
    /// Joins the data of a map. What they must satisfy is checked by the certificate, not here.
    pub fn from_parts(source: SourceMesh<K>, adjacency: Adjacency<K>, parts: FoliationParts<K>) -> Self {
        let steps = Steps::new(&parts, &adjacency);
        let locator = Locator::new(&source, &parts.mesh);
        let section_index = SectionIndex::new(&parts, &adjacency);
        Self { source, adjacency, parts, accuracy: DEFAULT_ACCURACY, steps, locator, section_index }
    }

    /// The same map with another accuracy of floating-point evaluation.
    ///
    /// Answers whose error bound exceeds `accuracy` (relative to the size of the target, or of the
    /// mesh's box for the inverse) are computed exactly instead, which takes some hundred times longer.
    /// Bounds are worst cases: true errors are usually a thousand times smaller. Not finite or
    /// negative values count as 0: everything exactly.
    #[must_use]
    pub fn with_accuracy(mut self, accuracy: f64) -> Self {
        self.accuracy = if accuracy >= 0.0 { accuracy } else { 0.0 };
        self
    }

    /// See [`with_accuracy`](Self::with_accuracy).
    pub(super) fn accuracy(&self) -> f64 {
        self.accuracy
    }

    /// The mesh that is mapped.
    pub fn source(&self) -> &SourceMesh<K> {
        &self.source
    }

    /// What the mesh is mapped onto.
    pub fn target(&self) -> Target {
        self.parts.target
    }

    /// Gluing of the foliated mesh.
    pub fn adjacency(&self) -> &Adjacency<K> {
        &self.adjacency
    }

    /// The data that define the map.
    pub fn parts(&self) -> &FoliationParts<K> {
        &self.parts
    }

    /// Whether a cell is the centre.
    pub(super) fn is_centre(&self, cell: CellId) -> bool {
        self.parts.centre.is_some_and(|centre| centre.cell == cell)
    }
}
