//! Barycentric subdivision.

use crate::permutation::Permutation;
use crate::triangulation::Triangulation;

/// The barycentric subdivision of a triangulation: 24 tetrahedra for each.
///
/// Tetrahedron `24 t + k` is the part of tetrahedron `t` that belongs to the `k`-th permutation `p` of
/// [`Permutation::all`]: its corner 0 is the corner `p(0)`, its corner 1 the middle of the edge from there to
/// `p(1)`, its corner 2 the centre of the face of `p(0)`, `p(1)`, `p(2)`, its corner 3 the centre of `t`. All gluings
/// are the identity of corners, so the corners of a vertex are all of one number. Cost: linear.
///
/// # Example
/// ```
/// use homeo_manifold::{Homology, Skeleton, from_signature, subdivided};
/// let sister = from_signature("cPcbbbdxm")?;
/// let fine = subdivided(&sister);
/// assert_eq!(fine.len(), 48);
/// // A vertex, two edges, four faces, two tetrahedra.
/// assert_eq!(Skeleton::new(&fine).vertex_count(), 1 + 2 + 4 + 2);
/// assert_eq!(Homology::new(&fine), Homology::new(&sister));
/// # Ok::<(), homeo_manifold::SignatureError>(())
/// ```
///
/// # Panics
/// When there are more than 2^32 / 24 tetrahedra.
pub fn subdivided(triangulation: &Triangulation) -> Triangulation {
    assert!(triangulation.len() <= u32::MAX as usize / 24, "{} tetrahedra are too many", triangulation.len());
    let all: Vec<_> = Permutation::all().collect();
    let part =
        |tetrahedron: u32, order: Permutation| 24 * tetrahedron + all.partition_point(|&other| other < order) as u32;
    let mut fine = Triangulation::new(24 * triangulation.len());
    let mut glue = |here: u32, face: u8, there: u32| {
        if fine.neighbour(here, face).is_none() {
            let glued = fine.glue(here, face, there, Permutation::IDENTITY);
            debug_assert!(glued.is_ok(), "{glued:?}");
        }
    };
    for tetrahedron in 0..triangulation.len() as u32 {
        for &order in &all {
            let here = part(tetrahedron, order);
            for corner in 0..3 {
                // The neighbour has another face of this dimension between the same lower and higher ones.
                glue(here, corner, part(tetrahedron, order * Permutation::transposition(corner, corner + 1)));
            }
            if let Some(there) = triangulation.neighbour(tetrahedron, order.image(3)) {
                glue(here, 3, part(there.tetrahedron, there.corners * order));
            }
        }
    }
    fine
}
