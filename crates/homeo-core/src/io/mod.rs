//! Mesh files: one reader and one writer per format. Nothing is merged, reordered or repaired.
//!
//! [`read_mesh`] gives a [`MeshFile`]: what the file says, in the file's order, with its data.
//! Broken, truncated or non-finite files give a [`ReadError`] with the line or byte; memory stays
//! within a small multiple of the file's size whatever its header announces.
//!
//! [`MeshFile::triangulated`] and [`MeshFile::weld`] change a mesh on request, and say how.
//!
//! [`write_mesh`] writes numbers so that they read back bit for bit, and reports in a
//! [`WriteReport`] what the format could not hold.

mod binary;
mod build;
mod error;
mod facets;
mod json;
mod medit;
mod medit_write;
mod mesh_file;
mod msh;
mod msh_data;
mod msh_numbers;
mod msh_write;
mod obj;
mod obj_write;
mod off;
mod ply;
mod ply_header;
mod ply_write;
mod read;
mod scan;
mod stl;
mod text;
mod triangulate;
mod vtk;
mod vtk_cells;
mod vtk_data;
mod vtk_write;
mod vtu;
mod vtu_blocks;
mod vtu_write;
mod weld;
mod write;
mod xml;

pub use error::{Place, ReadError, WriteError};
pub use mesh_file::{Attribute, Element, MeshFile, PhysicalName, PolygonList, Values};
pub use read::{Format, read_mesh, read_mesh_bytes};
pub use triangulate::Triangulated;
pub use weld::{DifferingAttribute, WeldReport};
#[cfg(test)]
mod tests;

pub use write::{Encoding, WriteOptions, WriteReport, write_mesh, write_mesh_to};
