//! The classes of corners, edges and faces under the gluings.

use crate::permutation::Permutation;
use crate::triangulation::Triangulation;

/// The corners at the ends of the six edges of a tetrahedron.
pub const EDGES: [[u8; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The number in [`EDGES`] of the edge between two different corners.
///
/// ```
/// assert_eq!(homeo_manifold::skeleton::edge_between(3, 1), 4);
/// ```
pub fn edge_between(a: u8, b: u8) -> usize {
    let (low, high) = (a.min(b), a.max(b));
    debug_assert!(low < high && high < 4, "{a} and {b} are not two corners");
    usize::from(if low == 0 { high - 1 } else { low + high })
}

/// One tetrahedron at an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EdgeCorner {
    /// The tetrahedron.
    pub tetrahedron: u32,
    /// Its corners 0 and 1 under this permutation are start and end of the edge; the next tetrahedron round the edge is
    /// on the other side of the face opposite the corner 2.
    pub corners: Permutation,
}

impl EdgeCorner {
    /// The number of the edge in its tetrahedron.
    pub fn edge(self) -> usize {
        edge_between(self.corners.image(0), self.corners.image(1))
    }

    /// The next one round the edge, as the gluing says; nothing at the boundary.
    pub(crate) fn next(self, triangulation: &Triangulation) -> Option<Self> {
        let gluing = triangulation.neighbour(self.tetrahedron, self.corners.image(2))?;
        let corners = gluing.corners * self.corners * Permutation::transposition(2, 3);
        Some(Self { tetrahedron: gluing.tetrahedron, corners })
    }

    /// The same edge of the same tetrahedron, for a walk the other way round.
    pub(crate) fn turned(self) -> Self {
        Self { corners: self.corners * Permutation::transposition(2, 3), ..self }
    }
}

/// An edge of the triangulation: edges of tetrahedra that are glued together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EdgeClass {
    /// The tetrahedra round the edge, in order, each as often as the edge is an edge of it.
    pub corners: Vec<EdgeCorner>,
    /// Whether the edge is on the boundary; the corners then run from one boundary face to the other.
    pub is_boundary: bool,
    /// Whether the edge is glued to itself end for end. Its middle then is no point of a manifold.
    pub is_reversed: bool,
}

/// The classes of corners and edges.
///
/// Classes are numbered in the order in which they appear, tetrahedron by tetrahedron. Cost: linear.
///
/// # Example
/// ```
/// use homeo_manifold::{Permutation, Skeleton, Triangulation};
/// let one = Skeleton::new(&Triangulation::new(1));
/// assert_eq!((one.vertex_count(), one.edges().len()), (4, 6));
/// ```
#[derive(Debug, Clone)]
pub struct Skeleton {
    vertex_of: Vec<[u32; 4]>,
    vertex_count: usize,
    edge_of: Vec<[u32; 6]>,
    edges: Vec<EdgeClass>,
}

impl Skeleton {
    /// The classes of a triangulation.
    pub fn new(triangulation: &Triangulation) -> Self {
        let (vertex_of, vertex_count) = vertex_classes(triangulation);
        let (edge_of, edges) = edge_classes(triangulation);
        Self { vertex_of, vertex_count, edge_of, edges }
    }

    /// The number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// The vertices that the corners of a tetrahedron belong to.
    pub fn vertices_of(&self, tetrahedron: u32) -> [u32; 4] {
        self.vertex_of[tetrahedron as usize]
    }

    /// The edges.
    pub fn edges(&self) -> &[EdgeClass] {
        &self.edges
    }

    /// The edges that the six edges of a tetrahedron belong to, in the order of [`EDGES`].
    pub fn edges_of(&self, tetrahedron: u32) -> [u32; 6] {
        self.edge_of[tetrahedron as usize]
    }

    /// Vertices less edges plus faces less tetrahedra; vertices are points here, whatever their links.
    ///
    /// ```
    /// use homeo_manifold::{Skeleton, Triangulation};
    /// let ball = Triangulation::new(1);
    /// assert_eq!(Skeleton::new(&ball).euler_characteristic(&ball), 1);
    /// ```
    pub fn euler_characteristic(&self, triangulation: &Triangulation) -> i64 {
        let boundary = triangulation.boundary_faces().count();
        let faces = (4 * triangulation.len() + boundary) / 2;
        self.vertex_count as i64 - self.edges.len() as i64 + faces as i64 - triangulation.len() as i64
    }
}

const UNSEEN: u32 = u32::MAX;

fn vertex_classes(triangulation: &Triangulation) -> (Vec<[u32; 4]>, usize) {
    let mut class_of = vec![[UNSEEN; 4]; triangulation.len()];
    let mut count = 0;
    let mut waiting = Vec::new();
    for first in 0..triangulation.len() as u32 {
        for corner in 0..4 {
            if class_of[first as usize][usize::from(corner)] != UNSEEN {
                continue;
            }
            class_of[first as usize][usize::from(corner)] = count;
            waiting.push((first, corner));
            while let Some((tetrahedron, corner)) = waiting.pop() {
                for face in (0..4).filter(|&face| face != corner) {
                    let Some(gluing) = triangulation.neighbour(tetrahedron, face) else { continue };
                    let there = gluing.corners.image(corner);
                    let class = &mut class_of[gluing.tetrahedron as usize][usize::from(there)];
                    if *class == UNSEEN {
                        *class = count;
                        waiting.push((gluing.tetrahedron, there));
                    }
                }
            }
            count += 1;
        }
    }
    (class_of, count as usize)
}

fn edge_classes(triangulation: &Triangulation) -> (Vec<[u32; 6]>, Vec<EdgeClass>) {
    let mut class_of = vec![[UNSEEN; 6]; triangulation.len()];
    let mut edges = Vec::new();
    for tetrahedron in 0..triangulation.len() as u32 {
        for (edge, [start, end]) in EDGES.into_iter().enumerate() {
            if class_of[tetrahedron as usize][edge] != UNSEEN {
                continue;
            }
            let others = EDGES[5 - edge];
            let Some(corners) = Permutation::new([start, end, others[0], others[1]]) else { continue };
            let class = edge_class(triangulation, EdgeCorner { tetrahedron, corners });
            for corner in &class.corners {
                class_of[corner.tetrahedron as usize][corner.edge()] = edges.len() as u32;
            }
            edges.push(class);
        }
    }
    (class_of, edges)
}

/// Walks round an edge from one of its corners.
fn edge_class(triangulation: &Triangulation, first: EdgeCorner) -> EdgeClass {
    let (round, is_closed) = walk(triangulation, first);
    let (mut corners, is_boundary) = if is_closed {
        (round, false)
    } else {
        let last = *round.last().unwrap_or(&first);
        (walk(triangulation, last.turned()).0, true)
    };
    // An edge that is glued to itself end for end is passed twice: as often in one direction as in the other.
    let mut seen: Vec<_> = corners.iter().map(|corner| (corner.tetrahedron, corner.edge())).collect();
    seen.sort_unstable();
    seen.dedup();
    let is_reversed = seen.len() < corners.len();
    if is_reversed {
        corners.truncate(seen.len());
    }
    EdgeClass { corners, is_boundary, is_reversed }
}

/// The corners from a first one on, until it comes again (then `true`) or the boundary is met.
fn walk(triangulation: &Triangulation, first: EdgeCorner) -> (Vec<EdgeCorner>, bool) {
    let mut corners = vec![first];
    let mut here = first;
    while let Some(next) = here.next(triangulation) {
        if next == first {
            return (corners, true);
        }
        corners.push(next);
        here = next;
    }
    (corners, false)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tripus as in Yin 2010, figure 4.7, with a, b, c, d as 0, 1, 2, 3.
    pub(crate) fn tripus() -> Triangulation {
        let gluings = [(0, [1, 2, 3, 0]), (1, [3, 0, 1, 2]), (2, [0, 3, 2, 1]), (3, [0, 2, 1, 3])];
        let rows = gluings.map(|(face, images)| (0, face, 1, Permutation::new(images).unwrap()));
        Triangulation::from_gluings(2, &rows).unwrap()
    }

    #[test]
    fn edges_are_numbered_as_listed() {
        for (number, [a, b]) in EDGES.into_iter().enumerate() {
            assert_eq!(edge_between(a, b), number);
            assert_eq!(edge_between(b, a), number);
        }
    }

    #[test]
    fn the_tripus_has_one_vertex_and_one_edge_of_degree_twelve() {
        let tripus = tripus();
        let skeleton = Skeleton::new(&tripus);
        assert_eq!(skeleton.vertex_count(), 1);
        assert_eq!(skeleton.edges().len(), 1);
        let edge = &skeleton.edges()[0];
        assert_eq!(edge.corners.len(), 12);
        assert!(!edge.is_boundary && !edge.is_reversed);
        assert_eq!(skeleton.euler_characteristic(&tripus), 2);
    }

    #[test]
    fn each_tetrahedron_edge_is_in_one_class_once() {
        for triangulation in [tripus(), Triangulation::new(3)] {
            let skeleton = Skeleton::new(&triangulation);
            let total: usize = skeleton.edges().iter().map(|edge| edge.corners.len()).sum();
            assert_eq!(total, 6 * triangulation.len());
        }
    }

    #[test]
    fn an_edge_that_is_glued_to_itself_end_for_end_is_told() {
        // The face 012 onto 103: the edge 01 onto itself, end for end.
        let flip = Permutation::new([1, 0, 3, 2]).unwrap();
        let one = Triangulation::from_gluings(1, &[(0, 3, 0, flip)]).unwrap();
        let skeleton = Skeleton::new(&one);
        let reversed: Vec<_> = skeleton.edges().iter().filter(|edge| edge.is_reversed).collect();
        assert_eq!(reversed.len(), 1);
        assert_eq!(reversed[0].corners.len(), 1);
    }
}
