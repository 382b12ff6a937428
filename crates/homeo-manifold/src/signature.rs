//! Isomorphism signatures: a short name of a triangulation that does not depend on its labels.
//!
//! Two triangulations have the same signature if and only if one becomes the other by renaming tetrahedra and corners;
//! mirror images have the same signature. The format is that of Regina and SnapPy (Burton, *Simplification paths in the
//! Pachner graphs of closed orientable 3-manifold triangulations*, 2011, section 3 and appendix): for the gluings of
//! the reference data in `testdata/hyperbolic`, which Regina signed, the signatures here are the same letter by letter.
//!
//! **How it is made.** Choose a tetrahedron and an order of its corners. Number the other tetrahedra as they are met
//! when faces are gone through in order; the first gluing to a new tetrahedron names its corners, namely such that it
//! is the identity. Write down for each face, unless it has been seen from its other side, whether it is boundary (0),
//! leads to a new tetrahedron (1) or to a known one (2), then for the faces of the last kind the tetrahedra, then the
//! numbers of their permutations. Of the 24 strings for each tetrahedron the least one is the signature. Components
//! are signed one by one, and their signatures are sorted and put one after the other.

mod decode;
mod encode;
#[cfg(test)]
mod tests;

pub use decode::{SignatureError, from_signature};

use crate::triangulation::Triangulation;
use encode::Search;

/// The signature of a triangulation.
///
/// Cost: for `n` tetrahedra 24 `n` strings are begun and each is given up where it is larger than the least one so far,
/// so it is little more than linear in `n` for most triangulations and quadratic at worst, for symmetric ones: a torus
/// of 6,000 tetrahedra, each like each, takes half a minute.
///
/// # Example
/// ```
/// use homeo_manifold::{Permutation, Triangulation, signature};
/// let gluings = [(0, [1, 2, 3, 0]), (1, [3, 0, 1, 2]), (2, [0, 3, 2, 1]), (3, [0, 2, 1, 3])];
/// let rows: Vec<_> =
///     gluings.iter().filter_map(|&(face, images)| Some((0, face, 1, Permutation::new(images)?))).collect();
/// let tripus = Triangulation::from_gluings(2, &rows)?;
/// assert_eq!(signature(&tripus), "cPcbbbihq");
/// # Ok::<(), homeo_manifold::GluingError>(())
/// ```
pub fn signature(triangulation: &Triangulation) -> String {
    if triangulation.is_empty() {
        return "a".to_owned();
    }
    let mut search = Search::new(triangulation);
    let mut parts: Vec<String> = components(triangulation).iter().map(|component| search.least(component).0).collect();
    parts.sort_unstable();
    parts.concat()
}

/// In how many ways a connected triangulation is like itself, the identity and mirror images counted; nothing if it is
/// empty or in several pieces.
///
/// It is the number of labellings that give the least string, as two of them differ by an automorphism. Cost as for
/// [`signature`].
///
/// ```
/// use homeo_manifold::{Triangulation, automorphism_count};
/// assert_eq!(automorphism_count(&Triangulation::new(1)), Some(24));
/// assert_eq!(automorphism_count(&Triangulation::new(2)), None);
/// ```
pub fn automorphism_count(triangulation: &Triangulation) -> Option<usize> {
    signature_and_automorphisms(triangulation).map(|(_, count)| count)
}

/// Both of a connected triangulation.
pub(crate) fn signature_and_automorphisms(triangulation: &Triangulation) -> Option<(String, usize)> {
    match &components(triangulation)[..] {
        [component] => Some(Search::new(triangulation).least(component)),
        _ => None,
    }
}

/// The tetrahedra of each piece, in the order of their first ones.
pub(crate) fn components(triangulation: &Triangulation) -> Vec<Vec<u32>> {
    let mut is_seen = vec![false; triangulation.len()];
    let mut components = Vec::new();
    for first in 0..triangulation.len() as u32 {
        if std::mem::replace(&mut is_seen[first as usize], true) {
            continue;
        }
        let mut component = vec![first];
        let mut next = 0;
        while let Some(&tetrahedron) = component.get(next) {
            next += 1;
            for there in (0..4).filter_map(|face| triangulation.neighbour(tetrahedron, face)) {
                if !std::mem::replace(&mut is_seen[there.tetrahedron as usize], true) {
                    component.push(there.tetrahedron);
                }
            }
        }
        components.push(component);
    }
    components
}

/// The 64 characters, by their value.
const CHARACTERS: &[u8; 64] = b"abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-";

/// How a count below 63 is told from a larger one, which this value announces.
const LARGE: usize = 63;

/// What is across a face.
const BOUNDARY: u8 = 0;
const NEW: u8 = 1;
const KNOWN: u8 = 2;
