//! Writing a unit tangent bundle, with a section of it or without.

use std::io::{self, Seek, Write};

use homeo_manifold::bundle::{CircleBundle, Section};
use serde_json::json;
use sha2::{Digest, Sha256};
use zip::ZipWriter;

use super::Provenance;
use super::npy::Element;
use super::write::Archive;

/// What a map file holds of a section.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredSection {
    /// The level over each vertex of the base, but for singular ones.
    pub levels: Vec<Option<u32>>,
    /// A path of vertices of the bundle over each edge of the base whose ends both have levels.
    pub paths: Vec<Vec<u32>>,
    /// The index of each triangle of the base; 0 where a corner has no level.
    pub triangle_indices: Vec<i64>,
    /// The index of each vertex of the base; 0 where it has a level.
    pub vertex_indices: Vec<i64>,
}

impl StoredSection {
    /// That of a section.
    ///
    /// # Example
    /// ```
    /// use homeo::certificate::StoredSection;
    /// use homeo_manifold::bundle::{Section, TangentBundle};
    /// let tangent = TangentBundle::new(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], 4, 5)?;
    /// let section = Section::new(&tangent.bundle, vec![0; tangent.bundle.vertex_count()])?;
    /// let stored = StoredSection::new(&section);
    /// assert_eq!(stored.triangle_indices.iter().sum::<i64>(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(section: &Section) -> Self {
        let mut vertex_indices = vec![0; section.levels().len()];
        section.singular_vertices().into_iter().for_each(|(vertex, index)| vertex_indices[vertex as usize] = index);
        let triangles = 0..section.bundle().triangles().len() as u32;
        Self {
            levels: section.levels().to_vec(),
            paths: section.paths(),
            triangle_indices: triangles.map(|triangle| section.index(triangle)).collect(),
            vertex_indices,
        }
    }
}

/// Writes a bundle that claims to be the unit tangent bundle of its base, with what its certificate needs; and, if there is
/// one, a section of it, which the checker follows through the tetrahedra. The same bundle gives the same bytes.
///
/// # Errors
/// When `out` cannot be written.
///
/// # Example
/// ```
/// use homeo::certificate::{Provenance, StoredSection, write_bundle};
/// use homeo_manifold::bundle::{Section, TangentBundle};
/// let sphere = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let tangent = TangentBundle::new(&sphere, 4, 5)?;
/// let section = Section::new(&tangent.bundle, vec![0; tangent.bundle.vertex_count()])?;
/// let mut file = std::io::Cursor::new(Vec::new());
/// write_bundle(&tangent.bundle, Some(&StoredSection::new(&section)), &Provenance::default(), &mut file)?;
/// let verdict = homeo_verify::verify_bytes(&file.into_inner())?;
/// assert!(matches!(verdict, homeo_verify::Verdict::Certified(_)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_bundle(
    bundle: &CircleBundle,
    section: Option<&StoredSection>,
    provenance: &Provenance,
    out: &mut (impl Write + Seek),
) -> io::Result<()> {
    let (triangles, tetrahedra) = (bundle.triangles(), bundle.tetrahedra());
    let manifest = json!({
        "format": "homeo",
        "version": 1,
        "kind": "unit-tangent-bundle",
        "dimension": 3,
        "target": if section.is_some() { "unit-tangent-bundle-with-section" } else { "unit-tangent-bundle" },
        "centre": null,
        "source": {
            "name": provenance.source_name,
            "vertices": bundle.vertex_count(),
            "cells": triangles.len(),
            "content_sha256": base_sha256(bundle),
        },
        "construction": {"program": provenance.program, "options": provenance.options},
    });
    let mut archive = Archive { zip: ZipWriter::new(out) };
    archive.add("manifest.json", &serde_json::to_vec_pretty(&manifest).map_err(io::Error::other)?)?;
    archive.array("base_triangles", &[triangles.len(), 3], triangles.as_flattened().iter().copied())?;
    archive.array("layers", &[1], std::iter::once(bundle.layers()))?;
    let slopes = bundle.slopes().as_flattened().iter().map(|slope| slope % bundle.layers());
    archive.array("slopes", &[triangles.len(), 3], slopes)?;
    archive.array("tetrahedra", &[tetrahedra.len(), 4], tetrahedra.as_flattened().iter().copied())?;
    section.map_or(Ok(()), |section| section.write(bundle.layers(), &mut archive))?;
    archive.finish()
}

impl StoredSection {
    fn write<W: Write + Seek>(&self, layers: u32, archive: &mut Archive<'_, W>) -> io::Result<()> {
        let levels = self.levels.iter().map(|level| level.unwrap_or(layers));
        archive.array("section_levels", &[self.levels.len()], levels)?;
        let lengths = self.paths.iter().map(|path| path.len() as u32);
        archive.array("section_path_lengths", &[self.paths.len()], lengths)?;
        // From the lesser vertex of the edge to the greater.
        let mut vertices = Vec::with_capacity(self.paths.iter().map(Vec::len).sum());
        for path in &self.paths {
            let is_forward = path.first() < path.last();
            vertices.extend(path.iter().copied());
            if !is_forward {
                let start = vertices.len() - path.len();
                vertices[start..].reverse();
            }
        }
        archive.array("section_path_vertices", &[vertices.len()], vertices.into_iter())?;
        archive.array("triangle_indices", &[self.triangle_indices.len()], self.triangle_indices.iter().copied())?;
        archive.array("vertex_indices", &[self.vertex_indices.len()], self.vertex_indices.iter().copied())
    }
}

/// SHA-256 of the base as the file stores it, in hexadecimal digits.
fn base_sha256(bundle: &CircleBundle) -> String {
    let mut bytes = Vec::new();
    for count in [bundle.vertex_count(), 3, bundle.triangles().len()] {
        bytes.extend((count as u64).to_le_bytes());
    }
    bundle.triangles().as_flattened().iter().for_each(|corner| corner.put(&mut bytes));
    Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
