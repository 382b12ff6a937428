//! Why a triangulation has no hyperbolic structure, or why none was found.

use super::obstruction::Obstruction;
use crate::link::{Link, Links};
use crate::skeleton::Skeleton;
use crate::triangulation::Triangulation;
use thiserror::Error;

/// Why there is no structure of truncated tetrahedra, or why none was found.
#[derive(Debug, Error, Clone, PartialEq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum NoMetric {
    #[error("there are no tetrahedra: glue some")]
    Empty,
    #[error(
        "face {face} of tetrahedron {tetrahedron} is not glued: glue it, the boundary is made of cut-off vertices only"
    )]
    OpenFace { tetrahedron: u32, face: u8 },
    #[error(
        "edge {edge} is glued to itself end for end: this is no manifold with hyperbolic structure; subdivide the edge"
    )]
    ReversedEdge { edge: usize },
    #[error(
        "the link of vertex {vertex} is {link}, where a surface of negative Euler characteristic is wanted: the triangles \
         that cut off the vertex have angle sums below π, so by Gauss and Bonnet it is one in every structure; {remedy}"
    )]
    VertexLink { vertex: usize, link: &'static str, remedy: &'static str },
    #[error("the tetrahedra cannot be oriented: take the orientation cover, of twice as many")]
    NotOrientable,
    #[error(
        "edge {edge} has degree {degree}: dihedral angles are below π and cannot add up to 2π there; \
         retriangulate the manifold"
    )]
    LowDegree { edge: usize, degree: usize },
    #[error(
        "no dihedral angles add up to 2π round every edge with sums below π at every corner: the weights {:?} of the edges \
         prove it; retriangulate the manifold, which may be hyperbolic all the same", obstruction.weights()
    )]
    NoAngles { obstruction: Obstruction },
    #[error(
        "the length of edge {edge} grows without bound (it is {length:.1}) while curvatures tend to 0: most likely there is no \
         structure, but this is no proof; retriangulate"
    )]
    Escapes { edge: usize, length: f64 },
    #[error(
        "the energy is least where tetrahedron {tetrahedron} is flat: most likely this triangulation has no structure, but this \
         is no proof; retriangulate"
    )]
    Degenerate { tetrahedron: u32 },
    #[error("no structure was found in {steps} steps (curvature {curvature:.1e}); this proves nothing; retriangulate")]
    NotFound { steps: usize, curvature: f64 },
    #[error(
        "Krawczyk's test does not prove that there is a structure near the lengths, whose curvatures are {curvature:.1e} in \
         floating point: tetrahedra are too nearly flat for doubles, or there is none; retriangulate"
    )]
    NotProved { curvature: f64 },
}

impl NoMetric {
    /// Whether it is proved that the triangulation has no structure of truncated tetrahedra. The manifold may have one, with
    /// another triangulation.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::NoMetric;
    /// assert!(NoMetric::LowDegree { edge: 3, degree: 2 }.is_proved());
    /// assert!(!NoMetric::Escapes { edge: 3, length: 16.5 }.is_proved());
    /// ```
    pub fn is_proved(&self) -> bool {
        match self {
            Self::Empty | Self::OpenFace { .. } | Self::ReversedEdge { .. } => true,
            Self::VertexLink { .. } | Self::LowDegree { .. } | Self::NoAngles { .. } => true,
            Self::NotProved { .. }
            | Self::NotOrientable
            | Self::Escapes { .. }
            | Self::Degenerate { .. }
            | Self::NotFound { .. } => false,
        }
    }
}

impl NoMetric {
    /// Whether no other triangulation of the manifold can have a structure of this kind either.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::NoMetric;
    /// assert!(NoMetric::NotOrientable.is_of_the_manifold());
    /// assert!(!NoMetric::LowDegree { edge: 3, degree: 2 }.is_of_the_manifold());
    /// ```
    pub fn is_of_the_manifold(&self) -> bool {
        match self {
            Self::Empty | Self::OpenFace { .. } | Self::ReversedEdge { .. } | Self::NotOrientable => true,
            Self::VertexLink { link, .. } => *link != SPHERE,
            _ => false,
        }
    }
}

const SPHERE: &str = "a sphere";

/// What is decided without a single length.
pub(super) fn check_topology(triangulation: &Triangulation, skeleton: &Skeleton) -> Result<(), NoMetric> {
    if triangulation.is_empty() {
        return Err(NoMetric::Empty);
    }
    if let Some((tetrahedron, face)) = triangulation.boundary_faces().next() {
        return Err(NoMetric::OpenFace { tetrahedron, face });
    }
    if let Some(edge) = skeleton.edges().iter().position(|edge| edge.is_reversed) {
        return Err(NoMetric::ReversedEdge { edge });
    }
    let links = Links::new(triangulation, skeleton);
    let refused = links.all().iter().enumerate().find_map(|(vertex, link)| refuse_link(vertex, link));
    if let Some(refusal) = refused {
        return Err(refusal);
    }
    if links.orientation().is_none() {
        return Err(NoMetric::NotOrientable);
    }
    match Obstruction::of_one_edge(skeleton) {
        Some((edge, _)) => Err(NoMetric::LowDegree { edge, degree: skeleton.edges()[edge].corners.len() }),
        None => Ok(()),
    }
}

/// The reason why a vertex cannot be cut off by a geodesic surface.
fn refuse_link(vertex: usize, link: &Link) -> Option<NoMetric> {
    let cusp = "a cusp of a complete structure has ideal corners, which are not in this version";
    let (link, remedy) = match (link.euler_characteristic, link.is_orientable) {
        (2.., _) => (SPHERE, "remove this vertex, an inner point of the manifold, by retriangulating"),
        (1, _) => ("a projective plane", "this is no manifold"),
        (0, true) => ("a torus", cusp),
        (0, false) => ("a Klein bottle", cusp),
        (..0, _) => return None,
    };
    Some(NoMetric::VertexLink { vertex, link, remedy })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::permutation::Permutation;

    fn refusal(tetrahedra: usize, rows: &[(u32, u8, u32, [u8; 4])]) -> NoMetric {
        let rows: Vec<_> = rows.iter().map(|&(t, f, o, p)| (t, f, o, Permutation::new(p).unwrap())).collect();
        let triangulation = Triangulation::from_gluings(tetrahedra, &rows).unwrap();
        check_topology(&triangulation, &Skeleton::new(&triangulation)).unwrap_err()
    }

    #[test]
    fn each_reason_is_named() {
        assert_eq!(refusal(0, &[]), NoMetric::Empty);
        assert_eq!(refusal(1, &[]), NoMetric::OpenFace { tetrahedron: 0, face: 0 });
        let reversed = refusal(1, &[(0, 3, 0, [1, 0, 3, 2]), (0, 0, 0, [1, 0, 2, 3])]);
        assert_eq!(reversed, NoMetric::ReversedEdge { edge: 0 });
        // Folded twice: a sphere. The Gieseking manifold: a Klein bottle.
        let is_link = |refusal: NoMetric, name: &str| match refusal {
            NoMetric::VertexLink { link, .. } => assert_eq!(link, name),
            other => panic!("{other}"),
        };
        is_link(refusal(1, &[(0, 0, 0, [1, 0, 2, 3]), (0, 2, 0, [0, 1, 3, 2])]), "a sphere");
        is_link(refusal(1, &[(0, 0, 0, [1, 2, 0, 3]), (0, 2, 0, [0, 2, 3, 1])]), "a Klein bottle");
    }

    #[test]
    fn all_oriented_gluings_of_two_tetrahedra_face_by_face_are_refused_or_have_large_links() {
        let odd: Vec<_> = Permutation::all().filter(|p| !p.is_even()).collect();
        let (mut spheres, mut tori, mut degrees, mut good) = (0, 0, 0, 0);
        for number in 0..12_usize.pow(4) {
            let mut two = Triangulation::new(2);
            let are_glued =
                (0..4).all(|face| two.glue(0, face, 1, odd[number / 12_usize.pow(face.into()) % 12]).is_ok());
            if !are_glued {
                continue;
            }
            match check_topology(&two, &Skeleton::new(&two)) {
                Err(NoMetric::VertexLink { link: "a sphere", .. }) => spheres += 1,
                Err(NoMetric::VertexLink { link: "a torus", .. }) => tori += 1,
                Err(NoMetric::LowDegree { .. }) => degrees += 1,
                Ok(()) => good += 1,
                Err(other) => assert!(matches!(other, NoMetric::ReversedEdge { .. }), "{other}"),
            }
        }
        assert!(spheres > 0 && tori > 0 && good > 0, "{spheres} {tori} {degrees} {good}");
    }
}
