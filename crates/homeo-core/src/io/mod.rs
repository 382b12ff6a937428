//! Mesh files: one reader and one writer per format. Nothing is merged, reordered or repaired.
//!
//! [`read_mesh`] gives a [`MeshFile`]: what the file says, in the file's order, with its data.
//! Broken, truncated or non-finite files give a [`ReadError`] with the line or byte; memory stays
//! within a small multiple of the file's size whatever its header announces.

mod error;
mod mesh_file;

pub use error::{Place, ReadError, WriteError};
pub use mesh_file::{Attribute, Element, MeshFile, PhysicalName, PolygonList, Values};
