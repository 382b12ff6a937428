//! Container rules of unit tangent bundles: which arrays there are, and the hash of the base.

use crate::archive::Archive;
use crate::manifest::Manifest;
use crate::map_file::source_hash;
use crate::npy::{Array, U4};
use crate::verdict::{Unreadable, readable};

/// The arrays of a unit tangent bundle. Shapes are right; values are still unchecked.
pub(crate) struct BundleData {
    /// The vertices of the base.
    pub(crate) vertex_count: usize,
    /// The corners of the triangles of the base.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The number of edges of each fibre.
    pub(crate) layers: u32,
    /// The slopes of the walls over the sides of each triangle.
    pub(crate) slopes: Vec<[u32; 3]>,
    pub(crate) tetrahedra: Vec<[u32; 4]>,
}

impl BundleData {
    /// Takes the arrays out of an archive.
    pub(crate) fn read(archive: &mut Archive, manifest: &Manifest) -> Result<Self, Unreadable> {
        let base = Array::take(archive, "base_triangles")?;
        let source = &manifest.source;
        let hash = source_hash([source.vertices, 3, source.cells], &[&base]);
        let triangles = base.read(U4, None, 3)?.as_chunks().0.to_vec();
        readable(triangles.len() == source.cells, "base_triangles has another number of rows than the manifest says")?;
        readable(hash == source.content_sha256, "base_triangles does not have the stated content_sha256")?;
        let layers = Array::take(archive, "layers")?.read(U4, Some(1), 1)?[0];
        let slopes = Array::take(archive, "slopes")?.read(U4, Some(triangles.len()), 3)?.as_chunks().0.to_vec();
        let tetrahedra = Array::take(archive, "tetrahedra")?.read(U4, None, 4)?.as_chunks().0.to_vec();
        Ok(Self { vertex_count: source.vertices, triangles, layers, slopes, tetrahedra })
    }
}
