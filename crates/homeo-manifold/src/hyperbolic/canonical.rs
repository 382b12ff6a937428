//! The canonical decomposition: the triangulation that a manifold has by its geometry alone.
//!
//! *Theorem.* If the sum of the tilts of both sides is negative for every face of a triangulation with a structure, then every
//! isometry from its manifold to another one with such a triangulation sends tetrahedra to tetrahedra. So, with Mostow's
//! theorem, two such manifolds are homeomorphic if and only if their triangulations are the same up to names: if and only if
//! they have the same [`signature`]. (Kojima 1990; proof for what is used here: `docs/theory/hyperbolic.md`.)

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};

use super::enclosure::Enclosure;
use super::equations::Equations;
use super::proof::Structure;
use crate::signature::signature;
use crate::simplify::flips;
use crate::skeleton::Skeleton;
use crate::triangulation::Triangulation;
use thiserror::Error;

/// A triangulation all of whose tilt sums are negative, proved.
#[derive(Debug, Clone)]
pub struct Canonical {
    /// The triangulation, unique up to names and mirror image.
    pub triangulation: Triangulation,
    /// Its structure.
    pub structure: Structure,
    /// How many triangulations were looked at.
    pub tried: usize,
}

/// Why the canonical decomposition was not found.
#[derive(Debug, Error, Clone, PartialEq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum NotCanonical {
    #[error(
        "the tilts at face {face} of tetrahedron {tetrahedron} add up to zero as far as doubles tell ({low:.1e} to {high:.1e}), \
         and to less at the others: most likely the canonical cells are no tetrahedra but larger ones"
    )]
    Undecided { tetrahedron: u32, face: u8, low: f64, high: f64 },
    #[error("none of {tried} triangulations near this one is canonical; try more")]
    NotFound { tried: usize },
}

/// The sums of the tilts of both sides, for each face of each tetrahedron: negative where the two cells bend as those of the
/// canonical decomposition do.
///
/// `structure` must be one of this triangulation; all faces must be glued.
///
/// # Example
/// ```
/// use homeo_manifold::hyperbolic::{Structure, tilt_sums};
/// use homeo_manifold::{Skeleton, from_signature};
/// let tripus = from_signature("cPcbbbihq")?;
/// let structure = Structure::find(&tripus, &Skeleton::new(&tripus))?;
/// assert!(tilt_sums(&tripus, &structure).iter().flatten().all(|sum| sum.high() < 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn tilt_sums(triangulation: &Triangulation, structure: &Structure) -> Vec<[Enclosure; 4]> {
    let equations = Equations::new(&Skeleton::new(triangulation));
    let tilts: Vec<_> = equations.tetrahedra(structure.cosh_lengths()).map(|tetrahedron| tetrahedron.tilts()).collect();
    let sum = |tetrahedron: u32, face: u8| {
        let own = tilts[tetrahedron as usize][usize::from(face)];
        let Some(gluing) = triangulation.neighbour(tetrahedron, face) else { return Enclosure::WHOLE };
        own + tilts[gluing.tetrahedron as usize][usize::from(gluing.corners.image(face))]
    };
    (0..tilts.len() as u32).map(|tetrahedron| [0, 1, 2, 3].map(|face| sum(tetrahedron, face))).collect()
}

/// Looks for the canonical decomposition, from a triangulation with its structure, if its cells are tetrahedra.
///
/// Moves are made at faces whose tilt sums are not negative, and triangulations with a structure kept; those with the fewest
/// such faces are gone on from first. At most `tries` triangulations are looked at; `go_on` is asked before each.
///
/// # Guarantee
/// What is returned has negative tilt sums at all faces: decided by enclosures. It depends on the manifold alone.
///
/// # Errors
/// When none is found. There may be none: the cells of the canonical decomposition may be other polyhedra.
///
/// # Example
/// ```
/// use homeo_manifold::hyperbolic::{Structure, find_canonical};
/// use homeo_manifold::{Skeleton, from_signature, signature, simplify::flips};
/// // The three tetrahedra of another triangulation of a manifold of two.
/// let other = flips(&from_signature("cPcbbbihq")?, &[(0, 0)])?.remove(0);
/// let structure = Structure::find(&other, &Skeleton::new(&other))?;
/// let canonical = find_canonical(&other, &structure, 100, || true)?;
/// assert_eq!(signature(&canonical.triangulation), "cPcbbbihq");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn find_canonical(
    triangulation: &Triangulation,
    structure: &Structure,
    tries: usize,
    mut go_on: impl FnMut() -> bool,
) -> Result<Canonical, NotCanonical> {
    let mut search = Search { seen: HashSet::from([signature(triangulation)]), waiting: BinaryHeap::new() };
    let mut flat = None;
    search.add(triangulation.clone(), structure.clone());
    while let Some(Candidate { triangulation, structure, faces, .. }) = search.next() {
        let Some(&(tetrahedron, face, sum)) = faces.first() else {
            return Ok(Canonical { triangulation, structure, tried: search.seen.len() });
        };
        if faces.iter().all(|(.., sum)| sum.low() <= 0.0) {
            // No sum is surely positive: a move would only exchange such faces.
            let (low, high) = (sum.low(), sum.high());
            flat = flat.or(Some(NotCanonical::Undecided { tetrahedron, face, low, high }));
            continue;
        }
        let faces: Vec<_> = faces.iter().map(|&(tetrahedron, face, _)| (tetrahedron, face)).collect();
        for other in flips(&triangulation, &faces).unwrap_or_default() {
            if search.seen.len() >= tries || !go_on() {
                return Err(flat.unwrap_or(NotCanonical::NotFound { tried: search.seen.len() }));
            }
            search.try_it(other);
        }
    }
    Err(flat.unwrap_or(NotCanonical::NotFound { tried: search.seen.len() }))
}

/// A triangulation with a structure, and its faces whose tilt sums are not proved to be negative.
struct Candidate {
    /// Fewer such faces first, then fewer tetrahedra, then older ones.
    rank: Reverse<(usize, usize, usize)>,
    triangulation: Triangulation,
    structure: Structure,
    faces: Vec<(u32, u8, Enclosure)>,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.rank == other.rank
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.rank.cmp(&other.rank)
    }
}

/// Triangulations to go on from.
struct Search {
    seen: HashSet<String>,
    waiting: BinaryHeap<Candidate>,
}

impl Search {
    fn next(&mut self) -> Option<Candidate> {
        self.waiting.pop()
    }

    /// Adds a triangulation if it is new and has a structure.
    fn try_it(&mut self, triangulation: Triangulation) {
        if self.seen.insert(signature(&triangulation))
            && let Ok(structure) = Structure::find(&triangulation, &Skeleton::new(&triangulation))
        {
            self.add(triangulation, structure);
        }
    }

    fn add(&mut self, triangulation: Triangulation, structure: Structure) {
        let mut faces = Vec::new();
        for (tetrahedron, sums) in (0..).zip(tilt_sums(&triangulation, &structure)) {
            for (face, sum) in (0..).zip(sums).filter(|(_, sum)| !(-*sum).is_positive()) {
                faces.push((tetrahedron, face, sum));
            }
        }
        let rank = Reverse((faces.len(), triangulation.len(), self.seen.len()));
        self.waiting.push(Candidate { rank, triangulation, structure, faces });
    }
}
