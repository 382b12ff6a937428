//! Writing a map file.

use std::io::{self, Seek, Write};

use homeo_core::mesh::{TriangleComplex, VertexId};
use homeo_core::planar::{PlanarDomain, Point2};
use homeo_manifold::hyperbolic::{Structure, is_canonical};
use homeo_manifold::{Skeleton, Triangulation};
use serde_json::json;
use sha2::{Digest, Sha256};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::npy::{Element, encode};
use super::{FoliationMap, MovedMap, PlanarMap, Provenance, either};
use crate::cage::CageMap;
use crate::complex::ComplexMap;
use crate::composite::CompositeMap;
use crate::input::SourceMesh;
use crate::map::{Centre, Foliation, HarmonicMap, MovedMesh, PlanarBijection, Section, Shell};

/// Writes a map with its certificate. The same map gives the same bytes.
///
/// # Errors
/// When `out` cannot be written.
pub fn write_map(map: &FoliationMap, provenance: &Provenance, out: &mut (impl Write + Seek)) -> io::Result<()> {
    either!(map, map => write_foliation(map, provenance, out))
}

/// Writes a shell with what its certificate needs. The same shell gives the same bytes.
///
/// # Errors
/// When `out` cannot be written, and for a shell of a surface that may cross itself together with another section: the
/// format knows the one or the other.
pub fn write_shell(shell: &Shell, provenance: &Provenance, out: &mut (impl Write + Seek)) -> io::Result<()> {
    let (source, parts) = (shell.source(), shell.parts());
    let target = match (shell.section(), &parts.pairs) {
        (None, None) if parts.is_embedded => "embedded-shell",
        (None, None) => "shell",
        (Some(_), None) => "section",
        (None, Some(_)) => "immersed-shell",
        (Some(_), Some(_)) => return Err(io::Error::other("an immersed shell cannot be kept with another section")),
    };
    let claim = Claim { kind: "shell", target, centre: None, length_unit: 1.0 };
    let mut archive = Archive::begin(source, &claim, provenance, out)?;
    for (name, points) in [("bottom", &parts.bottom), ("middle", &parts.middle), ("top", &parts.top)] {
        let flat = points.as_flattened().iter().copied();
        archive.array(&format!("shell_{name}"), &[points.len(), 3], flat)?;
    }
    archive.array("prisms", &[parts.prisms.len(), 3], parts.prisms.as_flattened().iter().copied())?;
    if let Some(pairs) = &parts.pairs {
        archive.array("shell_pairs", &[pairs.len(), 2], pairs.as_flattened().iter().copied())?;
    }
    if let Some(section) = shell.section() {
        archive.mesh(["section_positions", "section_cells"], section)?;
    }
    archive.finish()
}

/// Writes a mesh that has moved, with what its certificate needs. The same map gives the same bytes.
///
/// # Errors
/// When `out` cannot be written.
///
/// # Example
/// ```
/// use homeo::certificate::{MovedMap, Provenance, StoredMap, read_map, write_moved};
/// use homeo::input::SourceMesh;
/// use homeo::map::MovedMesh;
/// use homeo_core::mesh::TriangleComplex;
/// let cells = TriangleComplex::from_indices(3, &[[0, 1, 2]])?;
/// let source = SourceMesh::new(vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], cells);
/// let after = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 2.0, 0.0]];
/// let map = MovedMap::from(MovedMesh::new(source, after.clone())?);
/// let mut file = std::io::Cursor::new(Vec::new());
/// write_moved(&map, &Provenance::default(), &mut file)?;
/// let Ok(StoredMap::Moved(MovedMap::Surface(back))) = read_map(file.get_ref()) else { panic!("another kind") };
/// assert_eq!(back.moved().positions(), after);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_moved(map: &MovedMap, provenance: &Provenance, out: &mut (impl Write + Seek)) -> io::Result<()> {
    match map {
        MovedMap::Surface(map) => write_moved_mesh(map, provenance, out),
        MovedMap::Volume(map) => write_moved_mesh(map, provenance, out),
    }
}

fn write_moved_mesh<const K: usize>(
    map: &MovedMesh<K>,
    provenance: &Provenance,
    out: &mut (impl Write + Seek),
) -> io::Result<()> {
    let claim = Claim { kind: "moved-mesh", target: "space", centre: None, length_unit: 1.0 };
    let mut archive = Archive::begin(map.source(), &claim, provenance, out)?;
    let after = map.moved().positions();
    archive.array("target_positions", &[after.len(), 3], after.as_flattened().iter().copied())?;
    archive.finish()
}

/// Writes a composite mean value map between cages, with what its certificate needs: triangles counter-clockwise from
/// outside. The same map gives the same bytes.
///
/// # Errors
/// When `out` cannot be written; when the triangles of the map make no mesh.
///
/// # Example
/// ```
/// use homeo::cage::{CageMap, CagePair};
/// use homeo::certificate::{Provenance, write_cages};
/// use homeo::shape::StraightPolyhedra;
/// use homeo_verify::{Verdict, verify_bytes};
/// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
/// let higher = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 8.0]];
/// let cages = CagePair::new(corners, higher, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let path = StraightPolyhedra::new(cages.source().to_vec(), cages.target().to_vec())?;
/// let mut file = std::io::Cursor::new(Vec::new());
/// write_cages(&CageMap::along(&cages, &path, 1)?, &Provenance::default(), &mut file)?;
/// assert!(matches!(verify_bytes(file.get_ref())?, Verdict::Certified(_)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_cages(map: &CageMap, provenance: &Provenance, out: &mut (impl Write + Seek)) -> io::Result<()> {
    let [first, later @ ..] = map.stages() else { return Err(io::Error::other("a map between cages has cages")) };
    let corner = |v: u32| first.get(v as usize).copied().unwrap_or_default();
    let volume: f64 = map.triangles().iter().map(|&[a, b, c]| determinant(corner(a), corner(b), corner(c))).sum();
    let is_outward = volume > 0.0;
    let outward = |&[a, b, c]: &[u32; 3]| if is_outward { [a, b, c] } else { [a, c, b] };
    let triangles: Vec<[u32; 3]> = map.triangles().iter().map(outward).collect();
    let complex = TriangleComplex::from_indices(first.len(), &triangles).map_err(io::Error::other)?;
    let source = SourceMesh::new(first.clone(), complex);
    let claim = Claim { kind: "composite-cage", target: "polyhedron", centre: None, length_unit: 1.0 };
    let mut archive = Archive::begin(&source, &claim, provenance, out)?;
    let later = later.concat();
    archive.array("stage_positions", &[later.len(), 3], later.as_flattened().iter().copied())?;
    archive.finish()
}

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * (b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3])).sum()
}

/// Writes a map between planar domains with what its certificate needs. The same map gives the same bytes.
///
/// # Errors
/// When `out` cannot be written; for complex maps as [`write_complex`].
pub fn write_planar(map: &PlanarMap, provenance: &Provenance, out: &mut (impl Write + Seek)) -> io::Result<()> {
    match map {
        PlanarMap::Harmonic(map) => write_harmonic(map, provenance, out),
        PlanarMap::Composite(map) => write_composite(map, provenance, out),
        PlanarMap::Complex(map) => write_complex(map, provenance, out),
    }
}

/// Writes a composite mean value map with what its certificate needs. The same map gives the same bytes.
///
/// # Errors
/// When `out` cannot be written.
pub fn write_composite(map: &CompositeMap, provenance: &Provenance, out: &mut (impl Write + Seek)) -> io::Result<()> {
    let kind = ["composite-mean-value", target_name(map.source())];
    let mut archive = Archive::begin_planar(map.source(), kind, provenance, out)?;
    archive.points("stage_points", &map.domains()[1..].iter().flat_map(|d| d.vertices()).collect::<Vec<_>>())?;
    let tilings = map.tilings();
    archive.array("added_counts", &[tilings.len()], tilings.iter().map(|tiling| tiling.added.len() as u32))?;
    archive.points("added_points", &tilings.iter().flat_map(|t| t.added.iter().copied()).collect::<Vec<_>>())?;
    archive.array("triangle_counts", &[tilings.len()], tilings.iter().map(|tiling| tiling.triangles.len() as u32))?;
    let triangles: Vec<u32> = tilings.iter().flat_map(|t| t.triangles.as_flattened()).copied().collect();
    archive.array("triangles", &[triangles.len() / 3, 3], triangles.into_iter())?;
    archive.finish()
}

/// The target of a map by its holes.
fn target_name(source: &PlanarDomain) -> &'static str {
    match source.rings().len() {
        1 => "polygon",
        2 => "annulus",
        _ => "domain",
    }
}

/// Writes a complex map with speeds, with what its certificate needs. The same map gives the same bytes.
///
/// # Errors
/// When `out` cannot be written.
///
/// # Example
/// ```
/// use homeo::certificate::{PlanarMap, Provenance, StoredMap, read_map, write_complex};
/// use homeo::complex::{ComplexMap, EdgeSpeeds};
/// use homeo::composite::JacobianLimits;
/// use homeo_core::planar::DomainPair;
/// let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
/// let kite = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.8, 0.8], [0.0, 1.0]]];
/// let pair = DomainPair::new(square, kite)?;
/// let speeds = EdgeSpeeds::new(2, vec![vec![0.5], vec![0.6], vec![0.4], vec![0.5]])?;
/// let map = ComplexMap::with_speeds(&pair, speeds, &JacobianLimits::default())?;
/// let mut file = std::io::Cursor::new(Vec::new());
/// write_complex(&map, &Provenance::default(), &mut file)?;
/// let Ok(StoredMap::Planar(PlanarMap::Complex(back))) = read_map(file.get_ref()) else { panic!("another kind") };
/// assert_eq!(back.speeds(), map.speeds());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_complex(map: &ComplexMap, provenance: &Provenance, out: &mut (impl Write + Seek)) -> io::Result<()> {
    let tiling = map.tiling();
    let kind = ["complex-barycentric", target_name(map.source())];
    let mut archive = Archive::begin_planar(map.source(), kind, provenance, out)?;
    archive.points("target_points", &map.target().vertices().collect::<Vec<_>>())?;
    let inner = map.speeds().control_values();
    let rows: Vec<f64> = inner.iter().flat_map(|row| [&[0.0], &row[..], &[1.0]].concat()).collect();
    archive.array("control_values", &[inner.len(), map.speeds().degree() + 1], rows.into_iter())?;
    archive.points("added_points", &tiling.added)?;
    let triangles = tiling.triangles.as_flattened().iter().copied();
    archive.array("triangles", &[tiling.triangles.len(), 3], triangles)?;
    archive.finish()
}

/// Writes a composite harmonic map with what its certificate needs. The same map gives the same bytes.
///
/// # Errors
/// When `out` cannot be written.
pub fn write_harmonic(map: &HarmonicMap, provenance: &Provenance, out: &mut (impl Write + Seek)) -> io::Result<()> {
    let kind = ["composite-harmonic", target_name(map.source())];
    let mut archive = Archive::begin_planar(map.source(), kind, provenance, out)?;
    archive.points("target_points", &map.target_half().parts().domain.vertices().collect::<Vec<_>>())?;
    if let Some(circuit) = map.middle().circuit() {
        archive.array("seams", &[circuit.seams().len(), 2], circuit.seams().as_flattened().iter().copied())?;
    }
    archive.points("middle_points", &map.middle().rings().concat())?;
    for (name, half) in [("source", map.source_half()), ("target", map.target_half())] {
        let parts = half.parts();
        let rows: Vec<u32> = parts.boundary.iter().flat_map(|p| [p.ring, p.edge, p.share]).collect();
        archive.array(&format!("{name}_boundary"), &[parts.boundary.len(), 3], rows.into_iter())?;
        if map.middle().circuit().is_some() {
            archive.points(&format!("{name}_seam_points"), &parts.seam_points)?;
        }
        archive.points(&format!("{name}_inner"), &parts.inner)?;
        archive.points(&format!("{name}_images"), &parts.images)?;
        let triangles = parts.triangles.as_flattened().iter().copied();
        archive.array(&format!("{name}_triangles"), &[parts.triangles.len(), 3], triangles)?;
        if map.middle().is_cylinder() {
            let shifts = parts.shifts.as_flattened().iter().copied();
            archive.array(&format!("{name}_shifts"), &[parts.shifts.len(), 3], shifts)?;
        }
    }
    archive.finish()
}

/// Writes a hyperbolic structure with what its certificate needs. The same structure gives the same bytes. If the triangulation
/// is proved to be the canonical decomposition of the manifold, the file claims this too.
///
/// # Errors
/// When `out` cannot be written, and for a triangulation with a face that is not glued, or with another number of edges than
/// the structure.
pub fn write_hyperbolic(
    triangulation: &Triangulation,
    structure: &Structure,
    provenance: &Provenance,
    out: &mut (impl Write + Seek),
) -> io::Result<()> {
    let skeleton = Skeleton::new(triangulation);
    if skeleton.edges().len() != structure.centre().len() {
        return Err(io::Error::other("the structure is that of another triangulation"));
    }
    let row = |(tetrahedron, face)| {
        let gluing = triangulation.neighbour(tetrahedron, face)?;
        let [a, b, c, d] = gluing.corners.images().map(u32::from);
        Some([gluing.tetrahedron, a, b, c, d])
    };
    let rows: Option<Vec<[u32; 5]>> = triangulation.faces().map(row).collect();
    let rows = rows.ok_or_else(|| io::Error::other("a face of the triangulation is not glued"))?;
    let mut hashed = Vec::new();
    for count in [skeleton.vertex_count(), 4, triangulation.len()] {
        hashed.extend((count as u64).to_le_bytes());
    }
    rows.as_flattened().iter().for_each(|x| x.put(&mut hashed));
    let content: String = Sha256::digest(&hashed).iter().map(|byte| format!("{byte:02x}")).collect();
    let manifest = json!({
        "format": "homeo",
        "version": 1,
        "kind": "hyperbolic",
        "dimension": 3,
        "target": if is_canonical(triangulation, structure) { "canonical-decomposition" } else { "geodesic-boundary" },
        "centre": null,
        "source": {
            "name": provenance.source_name,
            "vertices": skeleton.vertex_count(),
            "cells": triangulation.len(),
            "content_sha256": content,
        },
        "construction": {"program": provenance.program, "options": provenance.options},
    });
    let mut archive = Archive { zip: ZipWriter::new(out) };
    archive.add("manifest.json", &serde_json::to_vec_pretty(&manifest).map_err(io::Error::other)?)?;
    archive.array("gluings", &[rows.len(), 5], rows.as_flattened().iter().copied())?;
    archive.array("cosh_lengths", &[structure.centre().len()], structure.centre().iter().copied())?;
    archive.array("radius", &[1], std::iter::once(structure.radius()))?;
    archive.finish()
}

/// SHA-256 of the arrays of a planar source as the map file stores them, in hexadecimal digits.
pub fn domain_sha256(source: &PlanarDomain) -> String {
    let mut bytes = Vec::new();
    for count in [source.vertex_count(), 2, source.rings().len()] {
        bytes.extend((count as u64).to_le_bytes());
    }
    source.vertices().flatten().for_each(|x| x.put(&mut bytes));
    source.rings().iter().for_each(|ring| (ring.len() as u32).put(&mut bytes));
    Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// SHA-256 of the arrays of a source mesh as the map file stores them, in hexadecimal digits.
pub fn content_sha256<const K: usize>(source: &SourceMesh<K>) -> String {
    let mut hash = Sha256::new();
    for count in [source.positions().len(), K, source.complex().cell_count()] {
        hash.update((count as u64).to_le_bytes());
    }
    let mut bytes = Vec::with_capacity(1 << 16);
    source.positions().chunks(1024).for_each(|rows| {
        bytes.clear();
        rows.iter().flatten().for_each(|x| x.put(&mut bytes));
        hash.update(&bytes);
    });
    source.complex().cells().chunks(1024).for_each(|rows| {
        bytes.clear();
        rows.iter().flatten().for_each(|v| v.raw().put(&mut bytes));
        hash.update(&bytes);
    });
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

pub(super) struct Archive<'w, W: Write + Seek> {
    pub(super) zip: ZipWriter<&'w mut W>,
}

/// What the manifest says of a map beside its source and provenance.
struct Claim {
    kind: &'static str,
    target: &'static str,
    centre: Option<Centre>,
    length_unit: f64,
}

impl<'w, W: Write + Seek> Archive<'w, W> {
    /// Begins a map file: manifest and source.
    fn begin<const K: usize>(
        source: &SourceMesh<K>,
        claim: &Claim,
        provenance: &Provenance,
        out: &'w mut W,
    ) -> io::Result<Self> {
        let mut archive = Self { zip: ZipWriter::new(out) };
        let manifest = serde_json::to_vec_pretty(&manifest(source, claim, provenance)).map_err(io::Error::other)?;
        archive.add("manifest.json", &manifest)?;
        archive.mesh(["source_positions", "source_cells"], source)?;
        Ok(archive)
    }

    /// Begins the file of a map of this kind and target between planar domains: manifest and source.
    fn begin_planar(
        source: &PlanarDomain,
        [kind, target]: [&str; 2],
        provenance: &Provenance,
        out: &'w mut W,
    ) -> io::Result<Self> {
        let mut archive = Self { zip: ZipWriter::new(out) };
        let manifest = json!({
            "format": "homeo",
            "version": 1,
            "kind": kind,
            "dimension": 2,
            "target": target,
            "centre": null,
            "source": {
                "name": provenance.source_name,
                "vertices": source.vertex_count(),
                "cells": source.rings().len(),
                "content_sha256": domain_sha256(source),
            },
            "construction": {"program": provenance.program, "options": provenance.options},
        });
        archive.add("manifest.json", &serde_json::to_vec_pretty(&manifest).map_err(io::Error::other)?)?;
        archive.points("source_points", &source.vertices().collect::<Vec<_>>())?;
        let sizes = source.rings().iter().map(|ring| ring.len() as u32);
        archive.array("source_rings", &[source.rings().len()], sizes)?;
        Ok(archive)
    }

    fn mesh<const K: usize>(&mut self, names: [&str; 2], mesh: &SourceMesh<K>) -> io::Result<()> {
        let (positions, cells) = (mesh.positions(), mesh.complex().cells());
        self.array(names[0], &[positions.len(), 3], positions.as_flattened().iter().copied())?;
        self.array(names[1], &[cells.len(), K], numbers(cells).into_iter())
    }

    fn points(&mut self, name: &str, points: &[Point2]) -> io::Result<()> {
        self.array(name, &[points.len(), 2], points.as_flattened().iter().copied())
    }

    pub(super) fn finish(self) -> io::Result<()> {
        self.zip.finish().map_err(io::Error::other)?;
        Ok(())
    }

    pub(super) fn add(&mut self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        self.zip.start_file(name, options).map_err(io::Error::other)?;
        self.zip.write_all(bytes)
    }

    pub(super) fn array<T: Element>(
        &mut self,
        name: &str,
        shape: &[usize],
        elements: impl ExactSizeIterator<Item = T>,
    ) -> io::Result<()> {
        self.add(&format!("{name}.npy"), &encode(shape, elements))
    }
}

fn write_foliation<const K: usize>(
    map: &Foliation<K>,
    provenance: &Provenance,
    out: &mut (impl Write + Seek),
) -> io::Result<()> {
    let (source, parts) = (map.source(), map.parts());
    let (centre, length_unit) = (parts.centre, parts.length_unit);
    let claim = Claim { kind: "foliation", target: map.target().name(), centre, length_unit };
    let mut archive = Archive::begin(source, &claim, provenance, out)?;
    if !parts.mesh.is_unrefined() {
        write_refinement(map, &mut archive)?;
    }
    let count = parts.directions.len();
    let directions: Vec<i8> = parts.directions.iter().flatten().copied().collect();
    archive.array("directions", &[count, K], directions.into_iter())?;
    archive.array("lengths", &[count], parts.lengths.iter().copied())?;
    let ids = |vertices: &[VertexId]| -> Vec<u32> { vertices.iter().map(|v| v.raw()).collect() };
    match &parts.section {
        Section::Arc { vertices, parameters } | Section::Loop { vertices, parameters } => {
            archive.array("section_vertices", &[vertices.len()], ids(vertices).into_iter())?;
            archive.array("section_coordinates", &[parameters.len()], parameters.iter().copied())?;
        }
        Section::Square { vertices, coordinates } => {
            let flat: Vec<f64> = coordinates.iter().flatten().copied().collect();
            archive.array("section_vertices", &[vertices.len()], ids(vertices).into_iter())?;
            archive.array("section_coordinates", &[coordinates.len(), 2], flat.into_iter())?;
        }
        Section::Centre => {}
    }
    archive.finish()
}

fn write_refinement<const K: usize>(
    map: &Foliation<K>,
    archive: &mut Archive<'_, impl Write + Seek>,
) -> io::Result<()> {
    let mesh = &map.parts().mesh;
    let carriers: Vec<u32> = mesh.added().iter().flat_map(|c| c.vertices.map(VertexId::raw)).collect();
    let weights: Vec<i64> = mesh.added().iter().flat_map(|c| c.weights).collect();
    let shape = [mesh.added().len(), K];
    archive.array("carrier_vertices", &shape, carriers.into_iter())?;
    archive.array("carrier_weights", &shape, weights.into_iter())?;
    archive.array("cells", &[mesh.complex().cell_count(), K], numbers(mesh.complex().cells()).into_iter())?;
    archive.array("parents", &[mesh.parents().len()], mesh.parents().iter().map(|p| p.raw()))
}

fn numbers<const K: usize>(cells: &[[VertexId; K]]) -> Vec<u32> {
    cells.iter().flatten().map(|v| v.raw()).collect()
}

fn manifest<const K: usize>(source: &SourceMesh<K>, claim: &Claim, provenance: &Provenance) -> serde_json::Value {
    json!({
        "format": "homeo",
        "version": 1,
        "kind": claim.kind,
        "dimension": K - 1,
        "target": claim.target,
        "centre": claim.centre.map(|centre| json!({"cell": centre.cell.raw(), "length": centre.length})),
        "source": {
            "name": provenance.source_name,
            "vertices": source.positions().len(),
            "cells": source.complex().cell_count(),
            "content_sha256": content_sha256(source),
        },
        "length_unit": claim.length_unit,
        "construction": {"program": provenance.program, "options": provenance.options},
    })
}
