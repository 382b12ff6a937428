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
use crate::simplify::{Simplifier, flips};
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
        "the tilts at face {face} of tetrahedron {tetrahedron} add up to 0 as far as doubles tell ({low:.0e} to {high:.0e}): most \
         likely the canonical cells are larger than tetrahedra"
    )]
    Undecided { tetrahedron: u32, face: u8, low: f64, high: f64 },
    #[error("none of {tried} triangulations near this one is canonical; try more")]
    NotFound { tried: usize },
}

/// The sums of the tilts of both sides, for each face of each tetrahedron: negative where the two cells bend as those of the
/// canonical decomposition do. They are enclosed on the whole box in which the structure is proved to be, like in its certificate.
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
    let radius = structure.radius();
    let side = |&cosh: &f64| Enclosure::between((cosh - radius).next_down(), (cosh + radius).next_up());
    let cosh: Vec<_> = structure.centre().iter().map(side).collect();
    let tilts: Vec<_> = equations.tetrahedra(&cosh).map(|tetrahedron| tetrahedron.tilts()).collect();
    let sum = |tetrahedron: u32, face: u8| {
        let own = tilts[tetrahedron as usize][usize::from(face)];
        let Some(gluing) = triangulation.neighbour(tetrahedron, face) else { return Enclosure::WHOLE };
        own + tilts[gluing.tetrahedron as usize][usize::from(gluing.corners.image(face))]
    };
    (0..tilts.len() as u32).map(|tetrahedron| [0, 1, 2, 3].map(|face| sum(tetrahedron, face))).collect()
}

/// Whether all tilt sums are proved to be negative: the triangulation is the canonical decomposition then. (Otherwise it may be,
/// all the same.)
pub fn is_canonical(triangulation: &Triangulation, structure: &Structure) -> bool {
    tilt_sums(triangulation, structure).iter().flatten().all(|sum| sum.high() < 0.0)
}

/// Looks for the canonical decomposition, from a triangulation with its structure, if its cells are tetrahedra.
///
/// Moves are made at faces whose tilt sums are not negative, and triangulations with a structure kept; those with the fewest
/// such faces are gone on from first. If this leads nowhere the search begins again at another triangulation of the manifold,
/// as by [`Simplifier`], always the same ones. At most `tries` triangulations are looked at; `go_on` is asked before each.
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
    search.add(triangulation.clone(), structure.clone());
    let mut simplifier = Simplifier::new(triangulation, 1).ok();
    for attempt in 0.. {
        match search.run(tries, &mut go_on) {
            Some(Candidate { triangulation, structure, faces, .. }) => match faces.first() {
                None => return Ok(Canonical { triangulation, structure, tried: search.seen.len() }),
                Some(&(tetrahedron, face, sum)) => {
                    let (low, high) = (sum.low(), sum.high());
                    return Err(NotCanonical::Undecided { tetrahedron, face, low, high });
                }
            },
            None if attempt < MOST_STARTS && search.seen.len() < tries && go_on() => {
                let other = simplifier.as_mut().map(|simplifier| match attempt {
                    0 => simplifier.best().clone(),
                    _ => simplifier.shaken(1 + attempt % 8),
                });
                other.into_iter().for_each(|other| search.try_it(other));
            }
            None => return Err(NotCanonical::NotFound { tried: search.seen.len() }),
        }
    }
    Err(NotCanonical::NotFound { tried: search.seen.len() })
}

/// How often the search begins anew.
const MOST_STARTS: usize = 100;

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
    /// Goes on until there is a triangulation of which no tilt sum is surely positive.
    fn run(&mut self, tries: usize, go_on: &mut impl FnMut() -> bool) -> Option<Candidate> {
        while let Some(candidate) = self.waiting.pop() {
            if candidate.faces.iter().all(|(.., sum)| sum.low() <= 0.0) {
                return Some(candidate);
            }
            let faces: Vec<_> = candidate.faces.iter().map(|&(tetrahedron, face, _)| (tetrahedron, face)).collect();
            for other in flips(&candidate.triangulation, &faces).unwrap_or_default() {
                if self.seen.len() >= tries || !go_on() {
                    return None;
                }
                self.try_it(other);
            }
        }
        None
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::from_signature;
    use crate::hyperbolic::Embedding;
    use crate::hyperbolic::minkowski::{Vector, product};

    fn structure(triangulation: &Triangulation) -> Structure {
        Structure::find(triangulation, &Skeleton::new(triangulation)).unwrap()
    }

    /// The vector with product 1 with four others, by Cramer's rule.
    fn one_on(normals: [Vector; 4]) -> Vector {
        // Rows of the equations, with the sign of the time.
        let mut rows = normals.map(|[t, x, y, z]| [-t, x, y, z, 1.0]);
        for column in 0..4 {
            let pivot = (column..4).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs())).unwrap();
            rows.swap(column, pivot);
            for row in (0..4).filter(|&row| row != column) {
                let factor = rows[row][column] / rows[column][column];
                for k in 0..5 {
                    rows[row][k] -= factor * rows[column][k];
                }
            }
        }
        [0, 1, 2, 3].map(|k| rows[k][4] / rows[k][k])
    }

    /// In the cover, the vertex on the other side of a face is beyond the plane through the vertices on this side exactly if the
    /// tilts add up to less than zero.
    #[test]
    fn tilt_sums_tell_on_which_side_the_next_vertex_lies() {
        let (mut convex, mut concave) = (0, 0);
        for name in ["cPcbbbihq", "dLQbcccdefo", "dLQbcccdeko", "dLQbcccdhsn", "dLQacbcjgjj", "dLQacccjnfo"] {
            let Ok(first) = from_signature(name) else { panic!("{name}") };
            let faces: Vec<_> = first.faces().collect();
            for triangulation in [vec![first.clone()], flips(&first, &faces).unwrap()].concat() {
                let skeleton = Skeleton::new(&triangulation);
                let Ok(structure) = Structure::find(&triangulation, &skeleton) else { continue };
                let embedding = Embedding::new(&triangulation, &skeleton, &structure).unwrap();
                let sums = tilt_sums(&triangulation, &structure);
                for (tetrahedron, face) in triangulation.faces() {
                    let covector = one_on(embedding.planes()[tetrahedron as usize]);
                    let gluing = triangulation.neighbour(tetrahedron, face).unwrap();
                    let next = embedding.planes_across(tetrahedron, face)[usize::from(gluing.corners.image(face))];
                    let sum = sums[tetrahedron as usize][usize::from(face)];
                    let beyond = product(covector, next) - 1.0;
                    assert!(beyond.abs() > 1e-9, "{name}: {beyond}");
                    assert_eq!(sum.high() < 0.0, beyond > 0.0, "{name}: {sum:?} {beyond}");
                    assert_eq!(sum.low() > 0.0, beyond < 0.0, "{name}: {sum:?} {beyond}");
                    if beyond > 0.0 { convex += 1 } else { concave += 1 }
                }
            }
        }
        assert!(convex > 100 && concave > 10, "{convex} {concave}");
    }

    #[test]
    fn a_search_that_may_not_go_on_finds_nothing() {
        let other = flips(&from_signature("cPcbbbihq").unwrap(), &[(0, 0)]).unwrap().remove(0);
        let structure = structure(&other);
        assert!(!is_canonical(&other, &structure));
        let stopped = find_canonical(&other, &structure, 1000, || false).unwrap_err();
        assert_eq!(stopped, NotCanonical::NotFound { tried: 1 });
    }
}
