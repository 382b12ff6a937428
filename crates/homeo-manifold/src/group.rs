//! The fundamental group: a generator for each face off a tree, a relation for each inner edge.

mod free;

use crate::skeleton::{EdgeClass, Skeleton};
use crate::triangulation::Triangulation;
use std::fmt;

/// A generator or its inverse, in a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Letter {
    /// The number of the generator.
    pub generator: u32,
    /// Whether its inverse is meant.
    pub is_inverse: bool,
}

/// A presentation of the fundamental group of a triangulation.
///
/// The base point is in the first tetrahedron. A tree of glued faces joins all tetrahedra; each other glued face `(t,
/// f)` is a generator: go through the tree to tetrahedron `t`, pass its face `f`, and go back through the tree. Round
/// an inner edge no face is passed in earnest, which is a relation. Vertices are cut off, whatever their links; for
/// vertices with spheres or disks as links that changes nothing. The middle of an edge that is glued to itself end for
/// end is cut off likewise. Of a triangulation in several pieces it is the free product of the groups of the pieces.
///
/// Printed, generators are `g0`, `g1`, and so on, however many: `< g0 g1 | g0 g1 g0^-1 g1^-1 >`.
///
/// # Example
/// ```
/// use homeo_manifold::{FundamentalGroup, from_signature};
/// let figure_eight = from_signature("cPcbbbiht")?;
/// let group = FundamentalGroup::new(&figure_eight);
/// assert_eq!((group.generators().len(), group.relations().len()), (3, 2));
/// assert!(group.to_string().starts_with("< g0 g1 g2 | "));
/// # Ok::<(), homeo_manifold::SignatureError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FundamentalGroup {
    generators: Vec<(u32, u8)>,
    letters: Vec<[Option<Letter>; 4]>,
    relations: Vec<Vec<Letter>>,
    pieces: usize,
}

impl FundamentalGroup {
    /// The presentation of a triangulation. Linear cost.
    pub fn new(triangulation: &Triangulation) -> Self {
        Self::with_skeleton(triangulation, &Skeleton::new(triangulation))
    }

    /// The same, where the skeleton is at hand.
    pub fn with_skeleton(triangulation: &Triangulation, skeleton: &Skeleton) -> Self {
        let (is_in_tree, pieces) = tree(triangulation);
        let mut letters = vec![[None; 4]; triangulation.len()];
        let mut generators = Vec::new();
        for (tetrahedron, face) in triangulation.faces() {
            let Some(there) = triangulation.neighbour(tetrahedron, face) else { continue };
            let (here, side) = (tetrahedron as usize, usize::from(face));
            let (other, other_side) = (there.tetrahedron as usize, usize::from(there.corners.image(face)));
            if is_in_tree[here][side] || letters[here][side].is_some() {
                continue;
            }
            let generator = generators.len() as u32;
            letters[here][side] = Some(Letter { generator, is_inverse: false });
            letters[other][other_side] = Some(Letter { generator, is_inverse: true });
            generators.push((tetrahedron, face));
        }
        let inner = skeleton.edges().iter().filter(|edge| !edge.is_boundary);
        let relations = inner.map(|edge| round(edge, &letters)).collect();
        Self { generators, letters, relations, pieces }
    }

    /// The face of each generator: it is passed from the tetrahedron that names it to the other side.
    pub fn generators(&self) -> &[(u32, u8)] {
        &self.generators
    }

    /// The letter that is written when a face is passed from its tetrahedron to the other side; nothing for boundary
    /// and for faces of the tree.
    pub fn letter(&self, tetrahedron: u32, face: u8) -> Option<Letter> {
        self.letters[tetrahedron as usize][usize::from(face)]
    }

    /// The relations, one for each inner edge in the order of the skeleton; some may be empty words.
    pub fn relations(&self) -> &[Vec<Letter>] {
        &self.relations
    }

    /// The number of pieces of the triangulation.
    pub fn pieces(&self) -> usize {
        self.pieces
    }
}

/// Which faces are in a tree of each piece, found breadth first; the number of pieces.
fn tree(triangulation: &Triangulation) -> (Vec<[bool; 4]>, usize) {
    let mut is_in_tree = vec![[false; 4]; triangulation.len()];
    let mut is_reached = vec![false; triangulation.len()];
    let mut order = Vec::with_capacity(triangulation.len());
    let mut pieces = 0;
    for first in 0..triangulation.len() as u32 {
        if std::mem::replace(&mut is_reached[first as usize], true) {
            continue;
        }
        pieces += 1;
        let mut next = order.len();
        order.push(first);
        while let Some(&tetrahedron) = order.get(next) {
            next += 1;
            for face in 0..4 {
                let Some(there) = triangulation.neighbour(tetrahedron, face) else { continue };
                if !std::mem::replace(&mut is_reached[there.tetrahedron as usize], true) {
                    is_in_tree[tetrahedron as usize][usize::from(face)] = true;
                    is_in_tree[there.tetrahedron as usize][usize::from(there.corners.image(face))] = true;
                    order.push(there.tetrahedron);
                }
            }
        }
    }
    (is_in_tree, pieces)
}

/// The word of the faces that are passed round an inner edge.
fn round(edge: &EdgeClass, letters: &[[Option<Letter>; 4]]) -> Vec<Letter> {
    // The next tetrahedron is behind the face opposite the corner 2 of the walk.
    let letter = |corner: &crate::skeleton::EdgeCorner| {
        letters[corner.tetrahedron as usize][usize::from(corner.corners.image(2))]
    };
    let mut word: Vec<_> = edge.corners.iter().filter_map(letter).collect();
    if edge.is_reversed {
        // Once round leads to the other end of the edge, twice round back.
        word.extend_from_within(..);
    }
    word
}

impl fmt::Display for Letter {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "g{}{}", self.generator, if self.is_inverse { "^-1" } else { "" })
    }
}

impl fmt::Display for FundamentalGroup {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("<")?;
        (0..self.generators.len()).try_for_each(|generator| write!(formatter, " g{generator}"))?;
        let mut separator = " |";
        for relation in self.relations.iter().filter(|relation| !relation.is_empty()) {
            formatter.write_str(separator)?;
            separator = ",";
            relation.iter().try_for_each(|letter| write!(formatter, " {letter}"))?;
        }
        formatter.write_str(if separator == "," { " >" } else { " | >" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signature::from_signature;

    #[test]
    fn a_solid_torus_of_one_tetrahedron_has_one_generator_and_no_relation() {
        // Two faces of a tetrahedron glued with a turn.
        let turn = crate::Permutation::new([1, 2, 3, 0]).unwrap();
        let torus = Triangulation::from_gluings(1, &[(0, 0, 0, turn)]).unwrap();
        let group = FundamentalGroup::new(&torus);
        assert_eq!(group.to_string(), "< g0 | >");
        assert_eq!(group.generators(), [(0, 0)]);
        assert_eq!(group.letter(0, 1), Some(Letter { generator: 0, is_inverse: true }));
        assert_eq!(group.letter(0, 2), None);
    }

    #[test]
    fn relations_pass_each_face_three_times() {
        // A glued face has three edges.
        let figure_eight = from_signature("cPcbbbiht").unwrap();
        let group = FundamentalGroup::new(&figure_eight);
        assert_eq!(group.pieces(), 1);
        for generator in 0..3 {
            let passed = group.relations().iter().flatten().filter(|letter| letter.generator == generator).count();
            assert_eq!(passed, 3);
        }
    }

    #[test]
    fn a_reversed_edge_is_gone_round_twice() {
        let flip = crate::Permutation::new([1, 0, 3, 2]).unwrap();
        let one = Triangulation::from_gluings(1, &[(0, 3, 0, flip)]).unwrap();
        assert_eq!(FundamentalGroup::new(&one).to_string(), "< g0 | g0 g0 >");
    }
}
