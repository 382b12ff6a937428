//! The ground floor of homeo: numbers, exact predicates, meshes, mesh files and topology.
//!
//! The modules follow the data. Nothing here knows of any construction of maps.
//!
//! | module | what it holds |
//! |---|---|
//! | [`number`] | rationals that are exact and intervals that enclose |
//! | [`predicate`] | signs that are decided exactly on `f64` and on rational coordinates |
//! | [`mesh`] | connectivity apart from coordinates, with typed ids |
//! | [`planar`] | polygons with holes, exactly simple |
//! | [`spatial`] | boxes and a tree over them, for overlap and point queries |
//! | [`io`] | one reader and one writer per file format; nothing is repaired |
//! | [`topology`] | what a mesh is: manifold, orientable, disk, ball, with every violation |
//!
//! ```
//! use homeo_core::mesh::{SimplicialComplex, VertexId};
//! // Two triangles that share the edge 1-2.
//! let square = SimplicialComplex::<3>::from_indices(4, &[[0, 1, 2], [2, 1, 3]]).unwrap();
//! let adjacency = square.adjacency().unwrap();
//! assert_eq!(adjacency.boundary_facets().count(), 4);
//! ```

pub mod io;
pub mod mesh;
pub mod number;
pub mod planar;
pub mod predicate;
pub mod spatial;
pub mod topology;
