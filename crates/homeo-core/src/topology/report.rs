//! What an analysis says of a mesh.

use serde::Serialize;

use super::Violation;

/// Whether to look for triangles that meet where they should not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Intersections {
    /// Only where another answer depends on it: whether a volume is embedded, hence perhaps a ball.
    #[default]
    WhereNeeded,
    /// Find them.
    Find,
}

/// How much to look at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Whether to look for self-intersections.
    pub intersections: Intersections,
}

/// An answer that may be out of reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Answer {
    /// Proved.
    Yes,
    /// Disproved.
    No,
    /// Neither.
    Unknown,
}

/// An answer and the argument for it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// The answer.
    pub answer: Answer,
    /// Why, in a sentence.
    pub reason: String,
}

impl Finding {
    pub(super) fn new(answer: Answer, reason: impl Into<String>) -> Self {
        Self { answer, reason: reason.into() }
    }
}

/// The smallest and the largest of some angles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AngleRange {
    /// Smallest, in degrees.
    pub min_degrees: f64,
    /// Largest, in degrees.
    pub max_degrees: f64,
}

/// A closed chain of boundary edges.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoundaryLoop {
    /// How many edges it has.
    pub edges: usize,
    /// Its length in the mesh's units, where there are coordinates.
    pub length: Option<f64>,
    /// One of its vertices.
    pub vertex: u32,
}

/// A piece of a surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfacePart {
    /// Its lowest triangle.
    pub cell: u32,
    /// How many vertices it has.
    pub vertices: usize,
    /// How many triangles it has.
    pub faces: usize,
    /// Number of its boundary loops.
    pub boundary_loops: usize,
    /// Vertices minus edges plus triangles.
    pub euler_characteristic: i64,
    /// Whether its triangles can turn consistently.
    pub orientable: bool,
    /// Number of handles; for orientable pieces only.
    pub genus: Option<i64>,
    /// The volume that it encloses, positive when its normals point outwards; for closed pieces
    /// that turn consistently and have coordinates.
    pub enclosed_volume: Option<f64>,
}

/// What is measured in `f64`; these are estimates with a few digits less than the coordinates.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceGeometry {
    /// Lowest coordinates of all vertices.
    pub lowest: [f64; 3],
    /// Highest coordinates of all vertices.
    pub highest: [f64; 3],
    /// Length of the diagonal of the bounding box.
    pub diagonal: f64,
    /// Total area.
    pub area: f64,
    /// Triangles of area zero, exactly.
    pub flat_cells: usize,
    /// Angles of the triangles that are not flat.
    pub triangle_angles: Option<AngleRange>,
    /// Angles between neighbours that are not flat: 180 where the surface goes on straight, small
    /// where it is folded, to either side.
    pub dihedral_angles: Option<AngleRange>,
    /// The volume enclosed by the closed pieces that turn consistently.
    pub enclosed_volume: Option<f64>,
}

/// What a triangle mesh is.
///
/// Connectivity is judged without cells that repeat a vertex and without copies of earlier cells;
/// both are violations. Isolated vertices do not count for the Euler characteristic.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceReport {
    /// Number of vertices, isolated ones included.
    pub vertices: usize,
    /// Number of distinct edges.
    pub edges: usize,
    /// Number of triangles, as in the mesh.
    pub faces: usize,
    /// Vertices of no triangle.
    pub isolated_vertices: usize,
    /// Pieces that have no vertex in common.
    pub components: usize,
    /// No edge has more than two triangles, no triangle repeats a vertex or another triangle.
    pub edge_manifold: bool,
    /// The triangles at each vertex form one fan.
    pub vertex_manifold: bool,
    /// Both.
    pub manifold: bool,
    /// Some choice of turns is consistent.
    pub orientable: bool,
    /// Neighbours turn the same way.
    pub consistently_oriented: bool,
    /// There are triangles and each edge has exactly two or more.
    pub closed: bool,
    /// Edges with exactly one triangle.
    pub boundary_edges: usize,
    /// The first thousand loops of the boundary, by ascending cell; `None` where some edge has three triangles or more.
    pub boundary: Option<Vec<BoundaryLoop>>,
    /// Number of all boundary loops, likewise.
    pub boundary_loops: Option<usize>,
    /// Vertices minus edges plus triangles.
    pub euler_characteristic: i64,
    /// Number of handles of all pieces together; for orientable manifolds only.
    pub genus: Option<i64>,
    /// A manifold in one piece that is a disk.
    pub is_disk: bool,
    /// A manifold in one piece that is a sphere.
    pub is_sphere: bool,
    /// The pieces of a manifold, the first hundred of them by their lowest triangles.
    pub parts: Vec<SurfacePart>,
    /// Measures; `None` without coordinates, or where some are out of range.
    pub geometry: Option<SurfaceGeometry>,
    /// Pairs of triangles that meet where they should not; `None` where not looked for.
    pub self_intersections: Option<usize>,
    /// All that is wrong.
    pub violations: Vec<Violation>,
}

/// What is measured of a tetrahedral mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VolumeGeometry {
    /// Lowest coordinates of all vertices.
    pub lowest: [f64; 3],
    /// Highest coordinates of all vertices.
    pub highest: [f64; 3],
    /// Length of the diagonal of the bounding box.
    pub diagonal: f64,
    /// Sum of the signed volumes, estimated.
    pub volume: f64,
    /// Tetrahedra of positive volume, exactly.
    pub positive_cells: usize,
    /// Tetrahedra of negative volume, exactly.
    pub negative_cells: usize,
    /// Tetrahedra of volume zero, exactly.
    pub flat_cells: usize,
    /// Dihedral angles of the tetrahedra that are not flat, estimated.
    pub dihedral_angles: Option<AngleRange>,
    /// Angles of all triangles that are not flat, estimated.
    pub triangle_angles: Option<AngleRange>,
}

/// The boundary of a tetrahedral mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VolumeBoundary {
    /// Vertices on it.
    pub vertices: usize,
    /// Edges on it.
    pub edges: usize,
    /// Triangles of exactly one tetrahedron.
    pub faces: usize,
    /// Whether it is a closed manifold.
    pub manifold: bool,
    /// Number of its pieces.
    pub components: usize,
    /// Genus of each piece (the first hundred of them); empty where it is no orientable manifold.
    pub genera: Vec<i64>,
    /// Sum of all genera; `None` where it is no orientable manifold.
    pub genus: Option<i64>,
}

/// What a tetrahedral mesh is.
///
/// Connectivity is judged without cells that repeat a vertex and without copies of earlier cells;
/// both are violations. Isolated vertices do not count for the Euler characteristic.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VolumeReport {
    /// Number of vertices, isolated ones included.
    pub vertices: usize,
    /// Number of distinct edges.
    pub edges: usize,
    /// Number of distinct triangles.
    pub faces: usize,
    /// Number of tetrahedra, as in the mesh.
    pub cells: usize,
    /// Vertices of no tetrahedron.
    pub isolated_vertices: usize,
    /// Pieces that have no vertex in common.
    pub components: usize,
    /// No triangle has more than two tetrahedra, no cell repeats a vertex or another cell.
    pub facet_manifold: bool,
    /// Each vertex link is a sphere or a disk.
    pub vertex_manifold: bool,
    /// Both.
    pub manifold: bool,
    /// Vertices whose link is neither a sphere nor a disk.
    pub bad_vertex_links: usize,
    /// Some choice of orders of the vertices is consistent.
    pub orientable: bool,
    /// Neighbours are ordered alike.
    pub consistently_oriented: bool,
    /// Vertices minus edges plus triangles minus tetrahedra.
    pub euler_characteristic: i64,
    /// Vertices that do not lie on the boundary.
    pub interior_vertices: usize,
    /// The boundary.
    pub boundary: VolumeBoundary,
    /// Tetrahedra with all four vertices on the boundary.
    pub cells_with_all_vertices_on_boundary: usize,
    /// Edges inside with both ends on the boundary.
    pub interior_edges_between_boundary_vertices: usize,
    /// Triangles inside with all vertices on the boundary.
    pub interior_faces_with_all_vertices_on_boundary: usize,
    /// Measures; `None` without coordinates, or where some are out of range.
    pub geometry: Option<VolumeGeometry>,
    /// Pairs of boundary triangles that meet where they should not; `None` where not looked for.
    pub boundary_self_intersections: Option<usize>,
    /// Whether the coordinates place the complex in space one-to-one.
    pub embedded: Finding,
    /// Whether it is a ball.
    pub ball: Finding,
    /// Whether it is a handle body (a ball counts, with no handles).
    pub handle_body: Finding,
    /// All that is wrong.
    pub violations: Vec<Violation>,
}
