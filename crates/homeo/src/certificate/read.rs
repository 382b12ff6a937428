//! Reading a map file, far enough to evaluate the map safely.
//!
//! Everything that evaluation indexes with is checked here, so that a hostile file gives an error
//! and neither a panic nor an endless leaf. Whether the map is a homeomorphism is the checker's business.

use std::io::{Cursor, Read};

use homeo_core::mesh::{Adjacency, CellId, SimplicialComplex, VertexId};
use homeo_core::planar::{DomainPair, PlanarDomain, Point2};
use serde_json::Value;
use zip::{CompressionMethod, ZipArchive};

use super::npy::decode;
use super::{FoliationMap, MovedMap, StoredMap};
use crate::cage::CageMap;
use crate::complex::{ComplexMap, EdgeSpeeds};
use crate::composite::{CompositeMap, Tiling};
use crate::input::SourceMesh;
use crate::map::{
    BoundaryPoint, Centre, Circuit, Foliation, FoliationParts, HalfParts, HarmonicMap, Middle, MovedMesh, SHARE_BITS,
    Section, Shell, ShellParts, Target, is_flat,
};
use crate::refine::{Carrier, RefinedMesh};

/// Why a file is no map that can be evaluated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MapFileError {
    /// No zip archive of stored entries.
    #[error("not a map file: {0}")]
    Archive(String),
    /// The manifest is missing, broken, or of a version or kind that this program does not know.
    #[error("manifest.json: {0}")]
    Manifest(String),
    /// A hyperbolic structure, which [`read_hyperbolic`](super::read_hyperbolic) reads.
    #[error(
        "it holds a hyperbolic structure, which is no map of points: `homeo verify` checks it, `homeo report` shows it, \
         `homeo hyperbolic` makes one"
    )]
    NoMap,
    /// An array is missing or has another type or shape.
    #[error("array {name} {what}")]
    Array {
        /// Its name.
        name: String,
        /// What is wrong.
        what: String,
    },
    /// The arrays do not fit together.
    #[error("the map file is inconsistent: {0}")]
    Inconsistent(String),
}

/// Reads a map from the bytes of its file.
///
/// # Errors
/// [`MapFileError`]; memory stays within a small multiple of the file's size.
pub fn read_map(bytes: &[u8]) -> Result<StoredMap, MapFileError> {
    let mut file = File::open(bytes)?;
    let manifest = file.manifest()?;
    let text = |key: &str| manifest.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
    let number = |key: &str| manifest.get(key).and_then(Value::as_u64);
    if text("format") != "homeo" || number("version") != Some(1) {
        return Err(MapFileError::Manifest("this program reads format `homeo`, version 1".to_owned()));
    }
    let is_of_dimension = |target: &str, dimension: usize| {
        let what = || MapFileError::Manifest(format!("a map onto a {target} has dimension {dimension}"));
        if number("dimension") == Some(dimension as u64) { Ok(()) } else { Err(what()) }
    };
    match text("kind").as_str() {
        "foliation" => {
            let target: Target = text("target").parse().map_err(|e| MapFileError::Manifest(format!("target: {e}")))?;
            is_of_dimension(target.name(), target.dimension())?;
            Ok(StoredMap::Foliation(match target.dimension() {
                2 => FoliationMap::Surface(file.foliation::<3>(target, &manifest)?),
                _ => FoliationMap::Volume(file.foliation::<4>(target, &manifest)?),
            }))
        }
        "shell" => {
            is_of_dimension(&text("target"), 2)?;
            let shell = file.shell(&text("target"))?;
            match text("target").as_str() {
                "shell" | "immersed-shell" | "embedded-shell" => Ok(StoredMap::Shell(shell)),
                "section" => {
                    let section = file.mesh::<3>(["section_positions", "section_cells"])?;
                    Ok(StoredMap::Shell(shell.with_section(section)))
                }
                _ => Err(MapFileError::Manifest(
                    "a shell has the target `shell`, `section`, `immersed-shell` or `embedded-shell`".to_owned(),
                )),
            }
        }
        "composite-harmonic" => {
            is_of_dimension(&text("target"), 2)?;
            Ok(StoredMap::Planar(file.harmonic(&text("target"))?.into()))
        }
        "composite-mean-value" => {
            is_of_dimension(&text("target"), 2)?;
            Ok(StoredMap::Planar(file.composite()?.into()))
        }
        "complex-barycentric" => {
            is_of_dimension(&text("target"), 2)?;
            Ok(StoredMap::Planar(file.complex()?.into()))
        }
        "moved-mesh" => match number("dimension") {
            Some(2) => Ok(StoredMap::Moved(MovedMap::Surface(file.moved()?))),
            Some(3) => Ok(StoredMap::Moved(MovedMap::Volume(file.moved()?))),
            _ => Err(MapFileError::Manifest("a mesh that has moved has dimension 2 or 3".to_owned())),
        },
        "hyperbolic" => Err(MapFileError::NoMap),
        "composite-cage" => {
            is_of_dimension(&text("target"), 2)?;
            Ok(StoredMap::Cages(file.cages()?))
        }
        other => Err(MapFileError::Manifest(format!("maps of kind `{other}` are not known"))),
    }
}

pub(super) struct File<'b> {
    zip: ZipArchive<Cursor<&'b [u8]>>,
}

/// Rows cut into parts of these sizes, which add up to no more than there are.
fn cut<T: Clone>(rows: &[T], sizes: &[u32]) -> Vec<Vec<T>> {
    let mut rest = rows;
    sizes.iter().map(|&n| rest.split_off(..n as usize).unwrap_or_default().to_vec()).collect()
}

fn inconsistent<T>(what: impl Into<String>) -> Result<T, MapFileError> {
    Err(MapFileError::Inconsistent(what.into()))
}

impl<'b> File<'b> {
    pub(super) fn open(bytes: &'b [u8]) -> Result<Self, MapFileError> {
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(|e| MapFileError::Archive(e.to_string()))?;
        Ok(Self { zip })
    }

    fn entry(&mut self, name: &str) -> Result<Option<Vec<u8>>, MapFileError> {
        let Ok(entry) = self.zip.by_name(name) else { return Ok(None) };
        let error = |what: String| MapFileError::Archive(format!("{name}: {what}"));
        if entry.compression() != CompressionMethod::Stored {
            return Err(error("entries must be stored, not compressed".to_owned()));
        }
        let mut bytes = Vec::new();
        // A stored entry cannot be longer than the archive, whatever its header says.
        let mut limited = entry.take(u64::from(u32::MAX) * 4);
        limited.read_to_end(&mut bytes).map_err(|e| error(e.to_string()))?;
        Ok(Some(bytes))
    }

    pub(super) fn manifest(&mut self) -> Result<Value, MapFileError> {
        let bytes = self.entry("manifest.json")?.ok_or_else(|| MapFileError::Manifest("is missing".to_owned()))?;
        serde_json::from_slice(&bytes).map_err(|e| MapFileError::Manifest(e.to_string()))
    }

    fn has(&mut self, name: &str) -> bool {
        self.zip.by_name(&format!("{name}.npy")).is_ok()
    }

    pub(super) fn array<T: super::npy::Element>(&mut self, name: &str, columns: usize) -> Result<Vec<T>, MapFileError> {
        let bytes = self.entry(&format!("{name}.npy"))?;
        let missing = || MapFileError::Array { name: name.to_owned(), what: "is missing".to_owned() };
        decode(name, &bytes.ok_or_else(missing)?, columns)
    }

    pub(super) fn rows<T: super::npy::Element + Default, const N: usize>(
        &mut self,
        name: &str,
    ) -> Result<Vec<[T; N]>, MapFileError> {
        let flat = self.array::<T>(name, N)?;
        Ok(flat.chunks_exact(N).map(|row| std::array::from_fn(|i| row[i])).collect())
    }

    fn cells<const K: usize>(&mut self, name: &str, vertices: usize) -> Result<SimplicialComplex<K>, MapFileError> {
        let cells = self.rows::<u32, K>(name)?;
        if cells.len() >= 1 << 30 {
            return inconsistent("more cells than this program can number");
        }
        if let Some(cell) = cells.iter().position(|cell| (0..K).any(|i| cell[..i].contains(&cell[i]))) {
            return inconsistent(format!("cell {cell} of {name} repeats a vertex"));
        }
        SimplicialComplex::from_indices(vertices, &cells).map_err(|e| MapFileError::Inconsistent(e.to_string()))
    }

    fn points(&mut self, name: &str) -> Result<Vec<[f64; 3]>, MapFileError> {
        let points = self.rows::<f64, 3>(name)?;
        match points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
            Some(row) => inconsistent(format!("row {row} of {name} is not finite")),
            None => Ok(points),
        }
    }

    fn source<const K: usize>(&mut self) -> Result<SourceMesh<K>, MapFileError> {
        self.mesh(["source_positions", "source_cells"])
    }

    fn mesh<const K: usize>(&mut self, names: [&str; 2]) -> Result<SourceMesh<K>, MapFileError> {
        let positions = self.points(names[0])?;
        let complex = self.cells::<K>(names[1], positions.len())?;
        let flat = complex.cells().iter().position(|cell| is_flat(&cell.map(|v| positions[v.index()])));
        match flat {
            Some(cell) => inconsistent(format!("cell {cell} of {} is flat", names[1])),
            None => Ok(SourceMesh::new(positions, complex)),
        }
    }

    fn harmonic(&mut self, target: &str) -> Result<HarmonicMap, MapFileError> {
        let sizes = self.array::<u32>("source_rings", 1)?;
        let is_as_said = match target {
            "polygon" => sizes.len() == 1,
            "annulus" => sizes.len() == 2,
            _ => target == "domain" && sizes.len() > 2,
        };
        if !is_as_said {
            return inconsistent("a polygon has one ring, an annulus two, a domain more");
        }
        let [source, target] = ["source", "target"].map(|name| {
            let rings = self.rings(&format!("{name}_points"), &sizes)?;
            PlanarDomain::new(rings).map_err(|e| MapFileError::Inconsistent(format!("{name}: {e}")))
        });
        let (source, target) = (source?, target?);
        let middle = self.middle(&sizes)?;
        let [source, target] =
            [("source", source), ("target", target)].map(|(name, domain)| self.half(name, domain, &middle));
        Ok(HarmonicMap::new(middle, source?, target?))
    }

    /// With more than one hole there are seams.
    fn middle(&mut self, sizes: &[u32]) -> Result<Middle, MapFileError> {
        if sizes.len() < 3 {
            return Ok(Middle::new(self.rings("middle_points", sizes)?));
        }
        let sizes: Vec<usize> = sizes.iter().map(|&size| size as usize).collect();
        let Some(circuit) = Circuit::new(&sizes, &self.rows::<u32, 2>("seams")?) else {
            return inconsistent("the seams do not join all rings as a tree, each by vertices without another seam");
        };
        let polygon = self.points_2d("middle_points")?;
        match polygon.len() == circuit.sides().len() {
            true => Ok(Middle::slit(circuit, polygon)),
            false => inconsistent("middle_points does not have a row for each edge and two for each seam"),
        }
    }

    fn composite(&mut self) -> Result<CompositeMap, MapFileError> {
        let sizes = self.array::<u32>("source_rings", 1)?;
        let source = self.rings("source_points", &sizes)?;
        let count: usize = sizes.iter().map(|&n| n as usize).sum();
        let stages = self.points_2d("stage_points")?;
        if !stages.len().is_multiple_of(count.max(1)) {
            return inconsistent("stage_points does not have as many points for each domain as the source");
        }
        let later = stages.chunks_exact(count.max(1)).map(|points| cut(points, &sizes));
        let domains = std::iter::once(source).chain(later).enumerate().map(|(number, rings)| {
            PlanarDomain::new(rings).map_err(|e| MapFileError::Inconsistent(format!("domain {number}: {e}")))
        });
        let domains = domains.collect::<Result<Vec<_>, _>>()?;
        let (added, triangles) = (self.points_2d("added_points")?, self.rows::<u32, 3>("triangles")?);
        let added = self.parts(&added, "added_counts")?;
        let triangles = self.parts(&triangles, "triangle_counts")?;
        let tilings = added.into_iter().zip(triangles).map(|(added, triangles)| Tiling { added, triangles });
        CompositeMap::from_domains(domains, tilings.collect()).map_err(|e| MapFileError::Inconsistent(e.to_string()))
    }

    fn complex(&mut self) -> Result<ComplexMap, MapFileError> {
        let sizes = self.array::<u32>("source_rings", 1)?;
        let domains = ["source", "target"].map(|name| {
            let rings = self.rings(&format!("{name}_points"), &sizes)?;
            PlanarDomain::new(rings).map_err(|e| MapFileError::Inconsistent(format!("{name}: {e}")))
        });
        let [source, target] = domains;
        let pair = DomainPair { source: source?, target: target? };
        let speeds = self.speeds()?;
        let tiling = Tiling { added: self.points_2d("added_points")?, triangles: self.rows::<u32, 3>("triangles")? };
        ComplexMap::from_parts(&pair, tiling, speeds).map_err(|e| MapFileError::Inconsistent(e.to_string()))
    }

    /// Speeds of whatever degree.
    fn speeds(&mut self) -> Result<EdgeSpeeds, MapFileError> {
        let name = "control_values";
        let found = (1..=8).find_map(|degree| Some((degree, self.array::<f64>(name, degree + 1).ok()?)));
        let Some((degree, values)) = found else {
            self.array::<f64>(name, 2)?;
            return inconsistent(format!("{name} has no rows of two to nine numbers"));
        };
        let rows = values.chunks_exact(degree + 1);
        if let Some(edge) = rows.clone().position(|row| row[0] != 0.0 || row[degree] != 1.0) {
            return inconsistent(format!("the control values of edge {edge} do not begin with 0 and end with 1"));
        }
        let inner = rows.map(|row| row[1..degree].to_vec()).collect();
        EdgeSpeeds::new(degree, inner).map_err(|e| MapFileError::Inconsistent(e.to_string()))
    }

    /// Rows cut into parts of as many as an array says.
    fn parts<T: Clone>(&mut self, rows: &[T], counts: &str) -> Result<Vec<Vec<T>>, MapFileError> {
        let sizes = self.array::<u32>(counts, 1)?;
        if sizes.iter().map(|&n| u64::from(n)).sum::<u64>() != rows.len() as u64 {
            return inconsistent(format!("{counts} do not add up to the number of rows"));
        }
        Ok(cut(rows, &sizes))
    }

    fn rings(&mut self, name: &str, sizes: &[u32]) -> Result<Vec<Vec<Point2>>, MapFileError> {
        let points = self.points_2d(name)?;
        if sizes.iter().map(|&n| u64::from(n)).sum::<u64>() != points.len() as u64 || sizes.iter().any(|&n| n < 3) {
            return inconsistent(format!("the rows of {name} are not those of rings of three vertices or more"));
        }
        Ok(cut(&points, sizes))
    }

    fn points_2d(&mut self, name: &str) -> Result<Vec<Point2>, MapFileError> {
        let points = self.rows::<f64, 2>(name)?;
        match points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
            Some(row) => inconsistent(format!("row {row} of {name} is not finite")),
            None => Ok(points),
        }
    }

    fn half(&mut self, name: &str, domain: PlanarDomain, middle: &Middle) -> Result<HalfParts, MapFileError> {
        let is_cylinder = middle.is_cylinder();
        let named = |what: &str| format!("{name}_{what}");
        let boundary: Vec<BoundaryPoint> = self
            .rows::<u32, 3>(&named("boundary"))?
            .into_iter()
            .map(|[ring, edge, share]| BoundaryPoint { ring, edge, share })
            .collect();
        let exists = |p: &BoundaryPoint| {
            middle.rings().get(p.ring as usize).is_some_and(|ring| (p.edge as usize) < ring.len())
                && p.share < 1 << SHARE_BITS
        };
        if !boundary.iter().all(exists) {
            return inconsistent(format!("a row of {name}_boundary is no point on an edge"));
        }
        let mut seam_points = Vec::new();
        if let Some(circuit) = middle.circuit() {
            seam_points = self.points_2d(&named("seam_points"))?;
            if circuit.places(&boundary, &seam_points).is_none() {
                return inconsistent(format!("both sides of a seam of the {name} do not have the same points"));
            }
        }
        let (inner, images) = (self.points_2d(&named("inner"))?, self.points_2d(&named("images"))?);
        let triangles = self.rows::<u32, 3>(&named("triangles"))?;
        let shifts = if is_cylinder { self.rows::<i8, 3>(&named("shifts"))? } else { Vec::new() };
        let count = boundary.len() + inner.len();
        if images.len() != inner.len() || is_cylinder && shifts.len() != triangles.len() {
            return inconsistent(format!(
                "the arrays of the {name}'s triangulation do not have the same number of rows"
            ));
        }
        if triangles.is_empty() || triangles.iter().flatten().any(|&v| v as usize >= count) {
            return inconsistent(format!(
                "there is no triangle, or a row of {name}_triangles names a vertex that does not exist"
            ));
        }
        Ok(HalfParts { domain, boundary, seam_points, inner, images, triangles, shifts })
    }

    fn moved<const K: usize>(&mut self) -> Result<MovedMesh<K>, MapFileError> {
        let (source, after) = (self.source::<K>()?, self.points("target_positions")?);
        MovedMesh::new(source, after).map_err(|e| MapFileError::Inconsistent(e.to_string()))
    }

    fn cages(&mut self) -> Result<CageMap, MapFileError> {
        let source = self.source::<3>()?;
        let (first, later) = (source.positions(), self.points("stage_positions")?);
        if first.is_empty() || !later.len().is_multiple_of(first.len()) {
            return inconsistent("stage_positions has no cages of as many vertices as the source");
        }
        let stages = first.chunks(first.len()).chain(later.chunks(first.len())).map(<[_]>::to_vec).collect();
        let triangles = source.complex().cells().iter().map(|cell| cell.map(VertexId::raw)).collect();
        CageMap::from_stages(stages, triangles).map_err(|e| MapFileError::Inconsistent(e.to_string()))
    }

    fn shell(&mut self, target: &str) -> Result<Shell, MapFileError> {
        let pairs = if target == "immersed-shell" { Some(self.pairs()?) } else { None };
        let is_embedded = target == "embedded-shell";
        let source = self.source::<3>()?;
        let [bottom, middle, top] = ["shell_bottom", "shell_middle", "shell_top"].map(|name| self.points(name));
        let (bottom, middle, top) = (bottom?, middle?, top?);
        if bottom.len() != middle.len() || middle.len() != top.len() {
            return inconsistent("every column of a shell needs a bottom, a middle and a top");
        }
        let prisms = self.cells::<3>("prisms", middle.len())?;
        let prisms = prisms.cells().iter().map(|corners| corners.map(VertexId::raw)).collect();
        Ok(Shell::from_parts(source, ShellParts { bottom, middle, top, prisms, pairs, is_embedded }))
    }

    /// Which triangles of a surface that may cross itself belong to which prisms.
    fn pairs(&mut self) -> Result<Vec<[u32; 2]>, MapFileError> {
        let pairs = self.rows::<u32, 2>("shell_pairs")?;
        if pairs.is_sorted() { Ok(pairs) } else { inconsistent("the rows of shell_pairs are not in ascending order") }
    }

    fn foliation<const K: usize>(&mut self, target: Target, manifest: &Value) -> Result<Foliation<K>, MapFileError> {
        let source = self.source::<K>()?;
        let mesh = if self.has("cells") { self.refined(&source)? } else { RefinedMesh::unrefined(&source) };
        let adjacency = mesh.complex().adjacency().map_err(|e| MapFileError::Inconsistent(e.to_string()))?;
        let count = mesh.complex().cell_count();
        let directions = self.rows::<i8, K>("directions")?;
        let lengths = self.array::<u32>("lengths", 1)?;
        if directions.len() != count || lengths.len() != count {
            return inconsistent(format!("{count} cells need as many directions and lengths"));
        }
        if lengths.contains(&0) {
            return inconsistent("a length is 0");
        }
        let centre = centre(target, manifest, count)?;
        let section = self.section(target, mesh.complex().vertex_count())?;
        let length_unit = manifest.get("length_unit").and_then(Value::as_f64).unwrap_or(1.0);
        let parts = FoliationParts { target, mesh, directions, lengths, length_unit, centre, section };
        check_directions(&parts, &adjacency)?;
        check_section(&parts, &adjacency)?;
        Ok(Foliation::from_parts(source, adjacency, parts))
    }

    fn refined<const K: usize>(&mut self, source: &SourceMesh<K>) -> Result<RefinedMesh<K>, MapFileError> {
        let vertices = self.rows::<u32, K>("carrier_vertices")?;
        let weights = self.rows::<i64, K>("carrier_weights")?;
        if vertices.len() != weights.len() {
            return inconsistent("as many carrier weights as carrier vertices are needed");
        }
        let added: Vec<Carrier<K>> = vertices
            .iter()
            .zip(&weights)
            .map(|(v, &weights)| Carrier { vertices: v.map(VertexId::from), weights })
            .collect();
        let complex = self.cells::<K>("cells", source.positions().len() + added.len())?;
        let parents: Vec<CellId> = self.array::<u32>("parents", 1)?.into_iter().map(CellId::from).collect();
        RefinedMesh::from_parts(source, complex, added, parents).map_err(MapFileError::Inconsistent)
    }

    fn section(&mut self, target: Target, vertex_count: usize) -> Result<Section, MapFileError> {
        if target == Target::Ball {
            return Ok(Section::Centre);
        }
        let vertices: Vec<VertexId> =
            self.array::<u32>("section_vertices", 1)?.into_iter().map(VertexId::from).collect();
        if vertices.iter().any(|v| v.index() >= vertex_count) {
            return inconsistent("the section names a vertex that does not exist");
        }
        if target == Target::Cube {
            let coordinates = self.rows::<f64, 2>("section_coordinates")?;
            let finite = coordinates.iter().flatten().all(|x| (0.0..=1.0).contains(x));
            return if coordinates.len() == vertices.len() && finite {
                Ok(Section::Square { vertices, coordinates })
            } else {
                inconsistent("the section needs one point of the unit square for each of its vertices")
            };
        }
        let parameters = self.array::<f64>("section_coordinates", 1)?;
        let increasing = parameters.windows(2).all(|w| w[0] < w[1]) && parameters.first() == Some(&0.0);
        let ends_well = |last: &f64| if target == Target::Square { *last == 1.0 } else { *last < 4.0 };
        if parameters.len() != vertices.len() || parameters.len() < 2 || !increasing {
            return inconsistent("the section needs one parameter for each of its vertices, increasing from 0");
        }
        if !parameters.last().is_some_and(ends_well) {
            return inconsistent("the section's parameters must end at 1 for a square and below 4 for a disk");
        }
        Ok(if target == Target::Square {
            Section::Arc { vertices, parameters }
        } else {
            Section::Loop { vertices, parameters }
        })
    }
}

fn centre(target: Target, manifest: &Value, count: usize) -> Result<Option<Centre>, MapFileError> {
    let value = manifest.get("centre").filter(|value| !value.is_null());
    match (target.is_radial(), value) {
        (false, None) => Ok(None),
        (true, Some(value)) => {
            let number = |key: &str| value.get(key).and_then(Value::as_u64);
            match (number("cell"), number("length").map(u32::try_from)) {
                (Some(cell), Some(Ok(length))) if cell < count as u64 && length > 0 => {
                    Ok(Some(Centre { cell: CellId::new(cell as usize), length }))
                }
                _ => inconsistent("the centre needs a cell that exists and a positive length"),
            }
        }
        _ => {
            inconsistent(format!("a map onto a {target} {} a centre", if value.is_some() { "has no" } else { "needs" }))
        }
    }
}

/// Signs agree across facets and flow in no cycle: leaves end.
fn check_directions<const K: usize>(parts: &FoliationParts<K>, adjacency: &Adjacency<K>) -> Result<(), MapFileError> {
    let centre = parts.centre.map(|c| c.cell);
    let complex = parts.mesh.complex();
    let mut waiting = vec![0u8; complex.cell_count()];
    for cell in complex.cell_ids().filter(|&cell| centre != Some(cell)) {
        let direction = parts.directions[cell.index()];
        let both = direction.iter().any(|&d| d > 0) && direction.iter().any(|&d| d < 0);
        if !both || direction.contains(&i8::MIN) || direction.iter().map(|&d| i32::from(d)).sum::<i32>() != 0 {
            return inconsistent(format!("the direction of cell {cell} does not add up to zero with both signs"));
        }
        for i in 0..K {
            let far = adjacency.across(cell, i);
            if far.is_none() || centre == Some(far.cell()) {
                continue;
            }
            let there = parts.directions[far.cell().index()][far.opposite()];
            if direction[i].signum() != -there.signum() || direction[i] == 0 {
                return inconsistent(format!("directions of cells {cell} and {} disagree", far.cell()));
            }
            waiting[cell.index()] += u8::from(direction[i] > 0);
        }
    }
    let mut ready: Vec<CellId> = complex.cell_ids().filter(|&c| waiting[c.index()] == 0 && centre != Some(c)).collect();
    let mut done = usize::from(centre.is_some());
    while let Some(cell) = ready.pop() {
        done += 1;
        for i in (0..K).filter(|&i| parts.directions[cell.index()][i] < 0) {
            let far = adjacency.across(cell, i);
            if far.is_some() && centre != Some(far.cell()) {
                waiting[far.cell().index()] -= 1;
                if waiting[far.cell().index()] == 0 {
                    ready.push(far.cell());
                }
            }
        }
    }
    if done == complex.cell_count() { Ok(()) } else { inconsistent("leaves run in circles") }
}

/// Leaves begin and end where the section and the centre say.
fn check_section<const K: usize>(parts: &FoliationParts<K>, adjacency: &Adjacency<K>) -> Result<(), MapFileError> {
    let complex = parts.mesh.complex();
    let mut number = vec![None; complex.vertex_count()];
    let mut edges = 0;
    if let Section::Arc { vertices, .. } | Section::Loop { vertices, .. } | Section::Square { vertices, .. } =
        &parts.section
    {
        vertices.iter().enumerate().for_each(|(k, v)| number[v.index()] = Some(k));
        edges = vertices.len() - usize::from(matches!(parts.section, Section::Arc { .. }));
    }
    let mut sources = 0;
    let mut at_ends = vec![0u8; complex.vertex_count()];
    for facet in adjacency.boundary_facets() {
        if parts.centre.is_some_and(|c| c.cell == facet.cell()) {
            return inconsistent("the centre lies on the boundary");
        }
        let sign = parts.directions[facet.cell().index()][facet.opposite()].signum();
        let expected = match parts.target {
            Target::Disk => sign > 0,
            Target::Ball => sign < 0,
            _ => true,
        };
        let corners = || complex.facet_vertices(facet.cell(), facet.opposite());
        let numbers: Vec<usize> = corners().filter_map(|v| number[v.index()]).collect();
        let section_known = sign <= 0 || is_section_facet::<K>(&parts.section, &numbers);
        if !expected || (parts.target != Target::Ball && !section_known) {
            return inconsistent(format!("leaves begin or end wrongly at boundary facet {facet:?}"));
        }
        corners().for_each(|v| at_ends[v.index()] |= u8::from(sign > 0) | u8::from(sign < 0) << 1);
        sources += usize::from(sign > 0);
    }
    if matches!(parts.section, Section::Arc { .. } | Section::Loop { .. }) && sources != edges {
        return inconsistent("the section has another number of edges than the source region");
    }
    if let Some(vertex) = at_ends.iter().position(|&ends| ends == 3) {
        return inconsistent(format!("vertex {vertex} lies on source and sink, where a leaf would have no length"));
    }
    let Some(centre) = parts.centre else { return Ok(()) };
    for i in 0..K {
        let far = adjacency.across(centre.cell, i);
        let inward = far.is_some() && parts.directions[far.cell().index()][far.opposite()] < 0;
        if inward != (parts.target == Target::Disk) {
            return inconsistent("leaves do not end at, or begin from, the centre as the target asks");
        }
    }
    Ok(())
}

/// Whether a source facet, by the numbers of its vertices in the section, is one that evaluation will look up there.
fn is_section_facet<const K: usize>(section: &Section, numbers: &[usize]) -> bool {
    let follow = |count: usize, closes: bool| {
        let gap = numbers[0].abs_diff(numbers[1]);
        gap == 1 || (closes && gap == count - 1)
    };
    numbers.len() == K - 1
        && match section {
            Section::Arc { vertices, .. } => follow(vertices.len(), false),
            Section::Loop { vertices, .. } => follow(vertices.len(), true),
            Section::Square { .. } | Section::Centre => true,
        }
}
