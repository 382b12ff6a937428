//! The surfaces that cut off the vertices, and orientation.

use crate::skeleton::{EDGES, Skeleton};
use crate::triangulation::Triangulation;

/// The link of a vertex: one triangle for each corner that belongs to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Link {
    /// Its triangles.
    pub triangles: usize,
    /// Its vertices less its edges plus its triangles.
    pub euler_characteristic: i64,
    /// Whether it has a boundary, which it has where the vertex is on the boundary.
    pub is_bounded: bool,
    /// Whether it has two sides' worth of orientation: its triangles can be turned so that they agree.
    pub is_orientable: bool,
}

impl Link {
    /// The genus of a closed orientable link.
    ///
    /// ```
    /// use homeo_manifold::Link;
    /// let torus = Link { triangles: 2, euler_characteristic: 0, is_bounded: false, is_orientable: true };
    /// assert_eq!(torus.genus(), Some(1));
    /// ```
    pub fn genus(&self) -> Option<usize> {
        let is_closed_and_orientable = self.is_orientable && !self.is_bounded;
        is_closed_and_orientable.then(|| usize::try_from((2 - self.euler_characteristic) / 2).unwrap_or(0))
    }

    /// Whether it is a sphere: then the vertex is an inner point of a manifold.
    pub fn is_sphere(&self) -> bool {
        self.euler_characteristic == 2 && !self.is_bounded
    }

    /// Whether it is a disk: then the vertex is a boundary point of a manifold.
    pub fn is_disk(&self) -> bool {
        self.euler_characteristic == 1 && self.is_bounded
    }
}

/// The links of all vertices.
///
/// # Example
/// ```
/// use homeo_manifold::{Links, Skeleton, Triangulation};
/// let ball = Triangulation::new(1);
/// let links = Links::new(&ball, &Skeleton::new(&ball));
/// assert!(links.all().iter().all(|link| link.is_disk()));
/// assert!(links.orientation().is_some());
/// ```
#[derive(Debug, Clone)]
pub struct Links {
    links: Vec<Link>,
    orientation: Option<Vec<bool>>,
}

impl Links {
    /// The links of the vertices of a triangulation, and its orientation. Linear cost.
    pub fn new(triangulation: &Triangulation, skeleton: &Skeleton) -> Self {
        let mut links = counted(triangulation, skeleton);
        let orientation = oriented(triangulation);
        if orientation.is_none() {
            mark_unorientable(triangulation, skeleton, &mut links);
        }
        Self { links, orientation }
    }

    /// The links, one for each vertex of the skeleton.
    pub fn all(&self) -> &[Link] {
        &self.links
    }

    /// For each tetrahedron whether its corners, in their order, agree with a common orientation; nothing if there is none.
    /// The first tetrahedron of each component agrees.
    pub fn orientation(&self) -> Option<&[bool]> {
        self.orientation.as_deref()
    }
}

/// The links with their counts; all taken for orientable ones.
fn counted(triangulation: &Triangulation, skeleton: &Skeleton) -> Vec<Link> {
    let empty = Link { triangles: 0, euler_characteristic: 0, is_bounded: false, is_orientable: true };
    let mut links = vec![empty; skeleton.vertex_count()];
    // Twice the number of sides: each is in two triangles, or once more in none.
    let mut sides = vec![0_i64; links.len()];
    for tetrahedron in 0..triangulation.len() as u32 {
        for (corner, vertex) in skeleton.vertices_of(tetrahedron).into_iter().enumerate() {
            let (link, sides) = (&mut links[vertex as usize], &mut sides[vertex as usize]);
            link.triangles += 1;
            for face in (0..4).filter(|&face| usize::from(face) != corner) {
                let is_open = triangulation.neighbour(tetrahedron, face).is_none();
                link.is_bounded |= is_open;
                *sides += if is_open { 2 } else { 1 };
            }
        }
    }
    for edge in skeleton.edges() {
        let Some(corner) = edge.corners.first() else { continue };
        let vertices = skeleton.vertices_of(corner.tetrahedron);
        // The two ends of an edge that is glued to itself end for end are one vertex of the link.
        let ends = EDGES[corner.edge()].map(|end| vertices[usize::from(end)] as usize);
        for &vertex in if edge.is_reversed { &ends[..1] } else { &ends[..] } {
            links[vertex].euler_characteristic += 1;
        }
    }
    for (link, sides) in links.iter_mut().zip(sides) {
        link.euler_characteristic += link.triangles as i64 - sides / 2;
    }
    links
}

/// Which tetrahedra agree with an orientation.
fn oriented(triangulation: &Triangulation) -> Option<Vec<bool>> {
    let mut agrees: Vec<Option<bool>> = vec![None; triangulation.len()];
    let mut waiting = Vec::new();
    for first in 0..triangulation.len() {
        if agrees[first].is_some() {
            continue;
        }
        agrees[first] = Some(true);
        waiting.push(first);
        while let Some(tetrahedron) = waiting.pop() {
            for face in 0..4 {
                let Some(gluing) = triangulation.neighbour(tetrahedron as u32, face) else { continue };
                let there = gluing.tetrahedron as usize;
                // Corners that are swapped an odd number of times lie on the two sides of the face.
                let wanted = agrees[tetrahedron].map(|here| here != gluing.corners.is_even());
                match agrees[there] {
                    None => {
                        agrees[there] = wanted;
                        waiting.push(there);
                    }
                    known if known != wanted => return None,
                    _ => {}
                }
            }
        }
    }
    agrees.into_iter().collect()
}

/// In a triangulation without orientation, finds the links without one.
fn mark_unorientable(triangulation: &Triangulation, skeleton: &Skeleton, links: &mut [Link]) {
    let mut agrees: Vec<[Option<bool>; 4]> = vec![[None; 4]; triangulation.len()];
    let mut waiting = Vec::new();
    for first in 0..triangulation.len() {
        for corner in 0..4 {
            if agrees[first][corner].is_some() {
                continue;
            }
            agrees[first][corner] = Some(true);
            waiting.push((first, corner));
            while let Some((tetrahedron, corner)) = waiting.pop() {
                let vertex = skeleton.vertices_of(tetrahedron as u32)[corner];
                for face in (0..4).filter(|&face| usize::from(face) != corner) {
                    let Some(gluing) = triangulation.neighbour(tetrahedron as u32, face) else { continue };
                    // A triangle of the link is seen from the corner: the sign of the whole permutation turns it.
                    let (there, to) = (gluing.tetrahedron as usize, usize::from(gluing.corners.image(corner as u8)));
                    let wanted = agrees[tetrahedron][corner].map(|here| here != gluing.corners.is_even());
                    match agrees[there][to] {
                        None => {
                            agrees[there][to] = wanted;
                            waiting.push((there, to));
                        }
                        known if known != wanted => links[vertex as usize].is_orientable = false,
                        _ => {}
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::permutation::Permutation;

    fn links(rows: &[(u32, u8, u32, [u8; 4])], tetrahedra: usize) -> (Vec<Link>, bool) {
        let rows: Vec<_> = rows.iter().map(|&(t, f, o, p)| (t, f, o, Permutation::new(p).unwrap())).collect();
        let triangulation = Triangulation::from_gluings(tetrahedra, &rows).unwrap();
        let links = Links::new(&triangulation, &Skeleton::new(&triangulation));
        (links.all().to_vec(), links.orientation().is_some())
    }

    #[test]
    fn the_link_of_the_tripus_has_genus_two() {
        let rows = [(0, 0, 1, [1, 2, 3, 0]), (0, 1, 1, [3, 0, 1, 2]), (0, 2, 1, [0, 3, 2, 1]), (0, 3, 1, [0, 2, 1, 3])];
        let (links, is_orientable) = links(&rows, 2);
        assert_eq!(links.len(), 1);
        assert_eq!((links[0].genus(), links[0].triangles), (Some(2), 8));
        assert!(is_orientable);
    }

    #[test]
    fn a_single_tetrahedron_folded_twice_is_a_sphere_with_spheres_as_links() {
        let (links, is_orientable) = links(&[(0, 0, 0, [1, 0, 2, 3]), (0, 2, 0, [0, 1, 3, 2])], 1);
        assert!(links.iter().all(Link::is_sphere));
        assert!(is_orientable);
    }

    #[test]
    fn the_gieseking_manifold_has_a_klein_bottle_as_link() {
        // One tetrahedron, one vertex, one edge of degree 6.
        let (links, is_orientable) = links(&[(0, 0, 0, [1, 2, 0, 3]), (0, 2, 0, [0, 2, 3, 1])], 1);
        assert!(!is_orientable);
        assert_eq!(links.len(), 1);
        assert_eq!(links[0].euler_characteristic, 0);
        assert!(!links[0].is_orientable && links[0].genus().is_none());
    }
}
