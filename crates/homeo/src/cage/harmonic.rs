//! The inside of a tetrahedral mesh when its boundary is given.

use homeo_core::mesh::{CrowdedFacet, TetrahedronComplex};

use crate::linear::{GraphLaplacian, SolveError};

type Point3 = [f64; 3];

/// Why there is no extension.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExtensionError {
    /// The mesh is no manifold.
    #[error("{0}: such a mesh has no boundary; take the extra tetrahedra away")]
    Crowded(CrowdedFacet<4>),
    /// There are not as many points as vertices.
    #[error("there are {found} points for {expected} vertices: give one for each")]
    WrongLength {
        /// How many vertices there are.
        expected: usize,
        /// How many points.
        found: usize,
    },
    /// The system could not be solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

/// Places of all vertices (#V by 3) such that each vertex inside moves by the mean of the displacements of its neighbours,
/// weighted by the inverse of squared distances in `before`; places on the boundary are taken from `after`, of which no
/// other entries are read.
///
/// Displacements obey the discrete maximum principle: none is outside the convex hull of those of the boundary. In space
/// that does not make the map injective, not even onto convex targets: ask [`judge`](super::judge).
///
/// # Errors
/// See [`ExtensionError`].
///
/// # Complexity
/// One sparse factorization in the number of inner vertices.
///
/// # Source
/// Schneider 2017, section 5.5: a harmonic map of polyhedra. *Differences*: piecewise linear; displacements are harmonic, not
/// places, so that a boundary that stays leaves the inside as it is; and in one piece, not composed of two by way of a
/// convex middle.
///
/// ```
/// use homeo::cage::harmonic_extension;
/// use homeo_core::mesh::TetrahedronComplex;
/// let mesh = TetrahedronComplex::from_indices(5, &[[4, 1, 2, 3], [0, 4, 2, 3], [0, 1, 4, 3], [0, 1, 2, 4]])?;
/// let before = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0], [1.0, 1.0, 1.0]];
/// let after = before.map(|p: [f64; 3]| [p[0], p[1], p[2] + 8.0]);
/// let places = harmonic_extension(&mesh, &before, &after)?;
/// assert_eq!(places[3], [0.0, 0.0, 12.0]);
/// assert!(places[4][2] > 8.0 && places[4][2] < 12.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn harmonic_extension(
    mesh: &TetrahedronComplex,
    before: &[Point3],
    after: &[Point3],
) -> Result<Vec<Point3>, ExtensionError> {
    for points in [before, after] {
        if points.len() != mesh.vertex_count() {
            return Err(ExtensionError::WrongLength { expected: mesh.vertex_count(), found: points.len() });
        }
    }
    let is_boundary = mesh.adjacency().map_err(ExtensionError::Crowded)?.boundary_vertices(mesh);
    let edges = mesh.edges();
    let mut is_used = vec![false; mesh.vertex_count()];
    edges.ends().iter().flatten().for_each(|v| is_used[v.index()] = true);
    let weight = |[a, b]: &[homeo_core::mesh::VertexId; 2]| {
        let (p, q) = (before[a.index()], before[b.index()]);
        1.0 / (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>()
    };
    let weights: Vec<f64> = edges.ends().iter().map(weight).collect();
    let laplacian = GraphLaplacian::new(mesh.vertex_count(), edges.ends(), &weights);
    // Vertices of no cell have no neighbours, and stay.
    let fixed = |v: usize| match (is_boundary[v], is_used[v]) {
        (true, _) => Some([0, 1, 2].map(|k| after[v][k] - before[v][k])),
        (false, false) => Some([0.0; 3]),
        (false, true) => None,
    };
    let fixed: Vec<Option<Point3>> = (0..mesh.vertex_count()).map(fixed).collect();
    let mut places = laplacian.harmonic_direct(&fixed)?;
    for (v, place) in places.iter_mut().enumerate() {
        // Boundary places are taken over bit for bit.
        *place = if is_boundary[v] { after[v] } else { [0, 1, 2].map(|k| before[v][k] + place[k]) };
    }
    Ok(places)
}
