//! Writing a unit tangent bundle.

use std::io::{self, Seek, Write};

use homeo_manifold::bundle::CircleBundle;
use serde_json::json;
use sha2::{Digest, Sha256};
use zip::ZipWriter;

use super::Provenance;
use super::npy::Element;
use super::write::Archive;

/// Writes a bundle that claims to be the unit tangent bundle of its base, with what its certificate needs. The same
/// bundle gives the same bytes.
///
/// # Errors
/// When `out` cannot be written.
///
/// # Example
/// ```
/// use homeo::certificate::{Provenance, write_bundle};
/// use homeo_manifold::bundle::TangentBundle;
/// let sphere = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let tangent = TangentBundle::new(&sphere, 4, 5)?;
/// let mut file = std::io::Cursor::new(Vec::new());
/// write_bundle(&tangent.bundle, &Provenance::default(), &mut file)?;
/// let verdict = homeo_verify::verify_bytes(&file.into_inner())?;
/// assert!(matches!(verdict, homeo_verify::Verdict::Certified(_)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_bundle(bundle: &CircleBundle, provenance: &Provenance, out: &mut (impl Write + Seek)) -> io::Result<()> {
    let (triangles, tetrahedra) = (bundle.triangles(), bundle.tetrahedra());
    let manifest = json!({
        "format": "homeo",
        "version": 1,
        "kind": "unit-tangent-bundle",
        "dimension": 3,
        "target": "unit-tangent-bundle",
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
    archive.finish()
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
