//! A foliation as data, and the tables that evaluation uses.

use homeo_core::mesh::{Adjacency, CellId, Facet, VertexId};

use super::locate::Locator;
use super::section::SectionIndex;
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
    pub(super) steps: Vec<Step>,
    pub(super) locator: Locator<K>,
    pub(super) section_index: SectionIndex,
}

/// What a leaf needs to know of a cell, in half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Step {
    /// The cell across each facet; [`Facet::NONE`] where the leaf ends (boundary or centre).
    pub across: [Facet; 4],
    /// The direction.
    pub direction: [i8; 4],
    /// For each facet, the number in the next cell of each vertex, two bits each.
    pub renumber: [u8; 4],
    /// Length per unit of direction.
    pub length: u32,
}

impl Step {
    /// Number in the cell across facet `i` of local vertex `k`.
    #[inline]
    pub fn renumbered(&self, i: usize, k: usize) -> usize {
        usize::from(self.renumber[i] >> (2 * k) & 3)
    }
}

impl<const K: usize> Foliation<K> {
    /// Joins the data of a map. What they must satisfy is checked by the certificate, not here.
    pub fn from_parts(source: SourceMesh<K>, adjacency: Adjacency<K>, parts: FoliationParts<K>) -> Self {
        let centre = parts.centre.map(|c| c.cell);
        let steps = parts.mesh.complex().cell_ids().map(|cell| step(&parts, &adjacency, centre, cell)).collect();
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

fn step<const K: usize>(
    parts: &FoliationParts<K>,
    adjacency: &Adjacency<K>,
    centre: Option<CellId>,
    cell: CellId,
) -> Step {
    let mut step =
        Step { across: [Facet::NONE; 4], direction: [0; 4], renumber: [0; 4], length: parts.lengths[cell.index()] };
    let here = parts.mesh.complex().cell(cell);
    for i in 0..K {
        step.direction[i] = parts.directions[cell.index()][i];
        let far = adjacency.across(cell, i);
        if far.is_none() {
            continue;
        }
        let there = parts.mesh.complex().cell(far.cell());
        step.renumber[i] = renumbering(here, i, there);
        if centre != Some(far.cell()) {
            step.across[i] = far;
        }
    }
    step
}

/// Where the vertices of facet `i` are in the cell across, two bits each.
pub(super) fn renumbering<const K: usize>(here: [VertexId; K], i: usize, there: [VertexId; K]) -> u8 {
    (0..K).filter(|&k| k != i).fold(0, |bits, k| {
        let number = (0..K).find(|&l| there[l] == here[k]).unwrap_or(0);
        bits | (number as u8) << (2 * k)
    })
}
