//! Coning the boundary: one new vertex for each component of it.

use super::SimplifyError;
use crate::permutation::Permutation;
use crate::skeleton::{EDGES, EdgeCorner, edge_between};
use crate::triangulation::Triangulation;
use std::collections::HashMap;

/// A closed triangulation with a cone over each component of the boundary.
///
/// One tetrahedron is added for each boundary face, after the others and in the order of
/// [`Triangulation::boundary_faces`], and has the same corners, the one opposite the face being the apex. Cut off the apex, and a
/// collar of the boundary is added, which is no change of the manifold. Linear cost.
///
/// # Errors
/// None but for triangulations of more than 2^32 tetrahedra.
///
/// # Example
/// ```
/// use homeo_manifold::{Links, Skeleton, Triangulation, simplify::coned};
/// let sphere = coned(&Triangulation::new(1))?;
/// assert!(sphere.is_closed() && sphere.len() == 5);
/// let links = Links::new(&sphere, &Skeleton::new(&sphere));
/// assert!(links.all().iter().all(|link| link.is_sphere()));
/// # Ok::<(), homeo_manifold::simplify::SimplifyError>(())
/// ```
pub fn coned(triangulation: &Triangulation) -> Result<Triangulation, SimplifyError> {
    let mut result = triangulation.clone();
    let mut cones = HashMap::new();
    for (tetrahedron, face) in triangulation.boundary_faces() {
        cones.insert((tetrahedron, face), result.add_tetrahedron());
    }
    for (tetrahedron, face) in triangulation.boundary_faces() {
        let cone = cones[&(tetrahedron, face)];
        for third in (0..4).filter(|&corner| corner != face) {
            let [a, b] = EDGES[5 - edge_between(face, third)];
            let Some(corners) = Permutation::new([a, b, third, face]) else { continue };
            let last = last_at(triangulation, EdgeCorner { tetrahedron, corners });
            // Its open face is the one opposite the corner 2.
            let Some(&other) = cones.get(&(last.tetrahedron, last.corners.image(2))) else { continue };
            if result.neighbour(cone, third).is_none() {
                let names = corners * Permutation::transposition(2, 3);
                result.glue(cone, third, other, last.corners * names.inverse())?;
            }
        }
        result.glue(tetrahedron, face, cone, Permutation::IDENTITY)?;
    }
    Ok(result)
}

/// The last tetrahedron round an edge, before the boundary.
fn last_at(triangulation: &Triangulation, first: EdgeCorner) -> EdgeCorner {
    let mut here = first;
    while let Some(next) = here.next(triangulation) {
        here = next;
    }
    here
}
