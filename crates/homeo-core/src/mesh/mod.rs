//! Simplicial meshes: connectivity here, coordinates beside it.
//!
//! A [`SimplicialComplex<K>`] lists cells of `K` vertices each: triangles for `K = 3`,
//! tetrahedra for `K = 4`. Facet `i` of a cell is the one opposite its vertex `i`.
//! [`Adjacency`] glues cells along facets and [`EdgeIndex`] numbers the edges.
//! None of them knows where the vertices lie.

mod adjacency;
mod complex;
mod edges;
mod id;

pub use adjacency::{Adjacency, CrowdedFacet, Facet};
pub use complex::{IndexOutOfRange, SimplicialComplex, TetrahedronComplex, TriangleComplex};
pub use edges::{CELL_EDGES, EdgeIndex};
pub use id::{CellId, EdgeId, VertexId};
