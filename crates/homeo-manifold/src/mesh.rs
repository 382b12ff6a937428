//! From meshes, whose cells name vertices, to triangulations and back.
//!
//! A mesh becomes a triangulation by forgetting the names: cells that share a face are glued along it. The other way
//! round vertices need names such that a cell has four different ones and no two cells the same; barycentric
//! subdivision sees to that, once or twice.

use crate::link::Links;
use crate::permutation::Permutation;
use crate::skeleton::{EDGES, Skeleton};
use crate::subdivision::subdivided;
use crate::triangulation::Triangulation;
use homeo_core::mesh::{TetrahedronComplex, VertexId};
use thiserror::Error;

/// Why a mesh is no triangulation, or a triangulation too large for a mesh.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum MeshError {
    #[error("cell {cell} has the vertex {vertex} twice: remove cells that are degenerate")]
    RepeatedVertex { cell: u32, vertex: u32 },
    #[error("the face {vertices:?} belongs to {count} cells, {first:?} among them: remove all but two of them")]
    CrowdedFace { vertices: [u32; 3], count: usize, first: [u32; 3] },
    #[error("{tetrahedra} tetrahedra become {needed} cells, and 2^30 is the limit")]
    TooManyCells { tetrahedra: usize, needed: u64 },
}

/// Cells are numbered with two more bits for their faces.
const MOST_CELLS: u64 = 1 << 30;

impl Triangulation {
    /// The triangulation of a mesh: tetrahedron `c` is cell `c`, its corner `i` the `i`-th vertex of the cell, and
    /// cells with the same three vertices on a face are glued there.
    ///
    /// Cells that share a vertex or an edge only are not glued: where a mesh is no manifold, a vertex may come apart
    /// into several. Cost: linear for meshes of bounded degree.
    ///
    /// # Errors
    /// A cell that has a vertex twice, or a face of more than two cells.
    ///
    /// # Example
    /// ```
    /// use homeo_core::mesh::TetrahedronComplex;
    /// use homeo_manifold::{Homology, Triangulation};
    /// // The boundary of a simplex of four dimensions: a 3-sphere of five cells.
    /// let cells = [[0, 1, 2, 3], [0, 1, 2, 4], [0, 1, 3, 4], [0, 2, 3, 4], [1, 2, 3, 4]];
    /// let sphere = Triangulation::from_complex(&TetrahedronComplex::from_indices(5, &cells).unwrap()).unwrap();
    /// assert!(sphere.is_closed());
    /// assert_eq!(Homology::new(&sphere).to_string(), "0");
    /// ```
    pub fn from_complex(complex: &TetrahedronComplex) -> Result<Self, MeshError> {
        for (cell, vertices) in complex.cells().iter().enumerate() {
            let twice = EDGES.iter().find(|ends| vertices[usize::from(ends[0])] == vertices[usize::from(ends[1])]);
            if let Some(&[first, _]) = twice {
                let vertex = vertices[usize::from(first)].raw();
                return Err(MeshError::RepeatedVertex { cell: cell as u32, vertex });
            }
        }
        let adjacency = complex.adjacency().map_err(|crowded| MeshError::CrowdedFace {
            vertices: std::array::from_fn(|i| crowded.vertices[i].raw()),
            count: crowded.cells.len(),
            first: std::array::from_fn(|i| crowded.cells[i].raw()),
        })?;
        let mut triangulation = Self::new(complex.cell_count());
        for cell in complex.cell_ids() {
            for face in 0..4 {
                let there = adjacency.across(cell, usize::from(face));
                if there.is_none() || triangulation.neighbour(cell.raw(), face).is_some() {
                    continue;
                }
                let corners = matching(complex.cell(cell), face, complex.cell(there.cell()), there.opposite() as u8);
                // Both faces are free, as a face of the mesh has two cells, and the two are different.
                if let Some(corners) = corners {
                    let glued = triangulation.glue(cell.raw(), face, there.cell().raw(), corners);
                    debug_assert!(glued.is_ok(), "{glued:?}");
                }
            }
        }
        Ok(triangulation)
    }

    /// A mesh of the same space: a complex in which each cell has four different vertices, and no two cells, faces or
    /// edges have the same vertices.
    ///
    /// The triangulation itself is one, if no two simplices have the same vertices. It is subdivided barycentrically
    /// once where that is not so but each tetrahedron has four different vertices, and twice otherwise. Fewer do not
    /// suffice, as `docs/theory/triangulations.md` proves, but perhaps where an edge is glued to itself end for end.
    /// Links of vertices keep their kind, and the new vertices have spheres as links, or disks at the boundary; only
    /// the middle of an edge that is glued to itself end for end has a projective plane. If the triangulation is
    /// orientable, the cells are ordered consistently.
    ///
    /// Cost: linear in the number of cells, which is that of tetrahedra times 1, 24 or 576.
    ///
    /// # Errors
    /// [`MeshError::TooManyCells`].
    ///
    /// # Example
    /// ```
    /// use homeo_manifold::from_signature;
    /// let tripus = from_signature("cPcbbbihq").unwrap();
    /// let mesh = tripus.to_complex().unwrap();
    /// // A single vertex, so it is done twice.
    /// assert_eq!((mesh.subdivisions, mesh.complex.cell_count()), (2, 2 * 24 * 24));
    /// assert_eq!(mesh.tetrahedra[0], 0);
    /// ```
    pub fn to_complex(&self) -> Result<SubdividedMesh, MeshError> {
        let skeleton = Skeleton::new(self);
        let subdivisions = subdivisions_needed(self, &skeleton);
        let needed = (0..subdivisions).fold(self.len() as u64, |cells, _| cells.saturating_mul(24));
        if needed > MOST_CELLS {
            return Err(MeshError::TooManyCells { tetrahedra: self.len(), needed });
        }
        let (fine, skeleton) = match subdivisions {
            0 => (self.clone(), skeleton),
            1 => with_skeleton(subdivided(self)),
            _ => with_skeleton(subdivided(&subdivided(self))),
        };
        let parts = fine.len().checked_div(self.len()).unwrap_or(1);
        let tetrahedra = (0..fine.len()).map(|cell| (cell / parts) as u32).collect();
        Ok(SubdividedMesh { complex: named(&fine, &skeleton)?, tetrahedra, subdivisions })
    }
}

/// A mesh made from a triangulation.
#[derive(Debug, Clone)]
pub struct SubdividedMesh {
    /// The mesh; its vertices are numbered as in the skeleton of the subdivided triangulation.
    pub complex: TetrahedronComplex,
    /// The tetrahedron that each cell is a part of, `#C`.
    pub tetrahedra: Vec<u32>,
    /// How often the triangulation was subdivided.
    pub subdivisions: u32,
}

/// The corners that a gluing of two cells with three common vertices takes to one another.
fn matching(here: [VertexId; 4], face: u8, there: [VertexId; 4], other_face: u8) -> Option<Permutation> {
    let mut images = [other_face; 4];
    for corner in (0..4).filter(|&corner| corner != face) {
        let vertex = here[usize::from(corner)];
        images[usize::from(corner)] = there.iter().position(|&other| other == vertex)? as u8;
    }
    Permutation::new(images)
}

fn with_skeleton(triangulation: Triangulation) -> (Triangulation, Skeleton) {
    let skeleton = Skeleton::new(&triangulation);
    (triangulation, skeleton)
}

/// How many barycentric subdivisions make simplices known by their vertices.
fn subdivisions_needed(triangulation: &Triangulation, skeleton: &Skeleton) -> u32 {
    let corners = |t: u32| skeleton.vertices_of(t);
    let tetrahedra = 0..triangulation.len() as u32;
    let has_four = |t: u32| EDGES.iter().all(|&[a, b]| corners(t)[usize::from(a)] != corners(t)[usize::from(b)]);
    if !tetrahedra.clone().all(has_four) {
        return 2;
    }
    let edges = skeleton.edges().iter().filter_map(|edge| edge.corners.first());
    let ends = edges.map(|at| [0, 1].map(|end| corners(at.tetrahedron)[usize::from(at.corners.image(end))])).collect();
    // A face that is glued is one face.
    let is_first = |t: u32, f: u8| {
        triangulation.neighbour(t, f).is_none_or(|there| (t, f) < (there.tetrahedron, there.corners.image(f)))
    };
    let faces = triangulation.faces().filter(|&(t, f)| is_first(t, f));
    let of_face = |(t, f): (u32, u8)| [1, 2, 3].map(|step| corners(t)[(usize::from(f) + step) % 4]);
    let are_known =
        all_differ(ends) && all_differ(faces.map(of_face).collect()) && all_differ(tetrahedra.map(corners).collect());
    u32::from(!are_known)
}

/// Whether no two sets of vertices are equal.
fn all_differ<const K: usize>(mut sets: Vec<[u32; K]>) -> bool {
    sets.iter_mut().for_each(|set| set.sort_unstable());
    sets.sort_unstable();
    sets.windows(2).all(|pair| pair[0] != pair[1])
}

/// The complex of the classes of corners; cells are turned such that they agree, if they can.
fn named(triangulation: &Triangulation, skeleton: &Skeleton) -> Result<TetrahedronComplex, MeshError> {
    let links = Links::new(triangulation, skeleton);
    let agrees = |t: u32| links.orientation().is_none_or(|agrees| agrees[t as usize]);
    let cell = |t: u32| {
        let [a, b, c, d] = skeleton.vertices_of(t).map(|vertex| VertexId::new(vertex as usize));
        if agrees(t) { [a, b, c, d] } else { [a, b, d, c] }
    };
    let cells = (0..triangulation.len() as u32).map(cell).collect();
    let too_many = |_| MeshError::TooManyCells { tetrahedra: triangulation.len(), needed: triangulation.len() as u64 };
    // The classes are numbered below their count.
    TetrahedronComplex::new(skeleton.vertex_count(), cells).map_err(too_many)
}

#[cfg(test)]
pub(crate) mod tests;
