//! Container rules: which arrays a map file holds, with which types and shapes, and the hash of its source.

use crate::archive::Archive;
use crate::bundle::BundleData;
use crate::complex_barycentric::ComplexData;
use crate::manifest::{Kind, Manifest, Target};
use crate::npy::{Array, F8, I1, I8, U4};
use crate::number::Point;
use crate::verdict::{Unreadable, readable, unreadable};
use sha2::{Digest, Sha256};

/// A decoded map file. Shapes are right; values are still unchecked.
pub(crate) struct MapFile {
    pub(crate) manifest: Manifest,
    pub(crate) positions: Vec<Point>,
    pub(crate) cells: Vec<u32>,
    pub(crate) refinement: Option<Refinement>,
    pub(crate) data: MapData,
}

/// The arrays of a refinement.
pub(crate) struct Refinement {
    /// Source vertices with their weights, for each added vertex.
    pub(crate) carriers: Vec<[(u32, i64); 4]>,
    pub(crate) cells: Vec<u32>,
    pub(crate) parents: Vec<u32>,
}

/// The arrays that define the map on the refined complex.
pub(crate) enum MapData {
    Foliation(FoliationData),
    /// Images of the vertices.
    PiecewiseLinear(Vec<Point>),
    Shell(ShellData),
    Harmonic(Box<HarmonicData>),
    Composite(CompositeData),
    Complex(ComplexData),
    Hyperbolic(HyperbolicData),
    Bundle(BundleData),
    /// Where the vertices have moved to.
    Moved(Vec<Point>),
    /// The vertices of the cages after the source.
    Cages(Vec<Vec<Point>>),
}

/// The arrays of a foliation; the section is empty for the ball.
pub(crate) struct FoliationData {
    pub(crate) directions: Vec<i8>,
    pub(crate) lengths: Vec<u32>,
    pub(crate) section_vertices: Vec<u32>,
    pub(crate) section_coordinates: Vec<Point>,
}

/// The arrays of a shell.
pub(crate) struct ShellData {
    /// The bottom, middle and top points of the columns.
    pub(crate) levels: [Vec<Point>; 3],
    /// The columns of the prisms, one prism after the other.
    pub(crate) prisms: Vec<u32>,
    /// The points and triangles of another section, if it is the target.
    pub(crate) section: Option<(Vec<Point>, Vec<u32>)>,
    /// A triangle and a prism each that belong together, if the source may cross itself.
    pub(crate) pairs: Option<Vec<[u32; 2]>>,
    /// Whether it claims not to overlap itself.
    pub(crate) is_embedded: bool,
}

/// The arrays of a composite harmonic map. Third coordinates are 0.
pub(crate) struct HarmonicData {
    /// How many vertices the rings of the domains have.
    pub(crate) ring_sizes: Vec<u32>,
    pub(crate) source_points: Vec<Point>,
    pub(crate) target_points: Vec<Point>,
    /// Where both have their vertices in the middle, or the corners of the circuit.
    pub(crate) middle_points: Vec<Point>,
    /// Both ends of each seam; empty unless there are several holes.
    pub(crate) seams: Vec<[u32; 2]>,
    pub(crate) is_cylinder: bool,
    /// Of the source and of the target.
    pub(crate) halves: [HalfData; 2],
}

/// The arrays of a composite mean value map. Third coordinates are 0.
pub(crate) struct CompositeData {
    /// How many vertices the rings of all domains have.
    pub(crate) ring_sizes: Vec<u32>,
    /// The vertices of each domain, from the source to the target: two domains or more.
    pub(crate) stages: Vec<Vec<Point>>,
    /// Of each domain but the last.
    pub(crate) tilings: Vec<TilingData>,
}

/// The arrays of a hyperbolic structure.
pub(crate) struct HyperbolicData {
    /// For each face of each tetrahedron the other tetrahedron, and where the corners go.
    pub(crate) gluings: Vec<[u32; 5]>,
    /// Hyperbolic cosines of the lengths of the edges: the centre of a box.
    pub(crate) cosh_lengths: Vec<f64>,
    /// Half the side of the box.
    pub(crate) radius: f64,
}

/// Triangles that tile a domain.
pub(crate) struct TilingData {
    /// Corners that are no vertices of the domain, numbered after these.
    pub(crate) added: Vec<Point>,
    pub(crate) triangles: Vec<u32>,
}

/// A triangulated domain.
pub(crate) struct HalfData {
    /// Ring, edge and share of each vertex on the boundary.
    pub(crate) boundary: Vec<u32>,
    /// The points inside seams, seam after seam.
    pub(crate) seam_points: Vec<Point>,
    pub(crate) inner: Vec<Point>,
    pub(crate) images: Vec<Point>,
    pub(crate) triangles: Vec<u32>,
    /// For the corners of each triangle; empty unless the middle is a cylinder.
    pub(crate) shifts: Vec<i8>,
}

impl MapFile {
    /// Decodes a map file and checks its hash. Arrays are taken out of the archive; in the end only notes may be left.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, Unreadable> {
        let mut archive = Archive::open(bytes)?;
        let text = archive.0.remove("manifest.json").ok_or_else(|| unreadable("there is no manifest.json"))?;
        let manifest = Manifest::parse(text)?;
        if manifest.kind == Kind::CompositeHarmonic {
            let (data, positions) = HarmonicData::read(&mut archive, &manifest)?;
            all_taken(&archive)?;
            let data = MapData::Harmonic(Box::new(data));
            return Ok(MapFile { manifest, positions, cells: vec![], refinement: None, data });
        }
        if manifest.kind == Kind::CompositeMeanValue {
            let data = CompositeData::read(&mut archive, &manifest)?;
            all_taken(&archive)?;
            let positions = data.stages[0].clone();
            let data = MapData::Composite(data);
            return Ok(MapFile { manifest, positions, cells: vec![], refinement: None, data });
        }
        if manifest.kind == Kind::ComplexBarycentric {
            let data = ComplexData::read(&mut archive, &manifest)?;
            all_taken(&archive)?;
            let positions = data.domains[0].clone();
            let data = MapData::Complex(data);
            return Ok(MapFile { manifest, positions, cells: vec![], refinement: None, data });
        }
        if manifest.kind == Kind::Hyperbolic {
            let data = HyperbolicData::read(&mut archive, &manifest)?;
            all_taken(&archive)?;
            let data = MapData::Hyperbolic(data);
            return Ok(MapFile { manifest, positions: vec![], cells: vec![], refinement: None, data });
        }
        if manifest.kind == Kind::UnitTangentBundle {
            let data = BundleData::read(&mut archive, &manifest)?;
            all_taken(&archive)?;
            let data = MapData::Bundle(data);
            return Ok(MapFile { manifest, positions: vec![], cells: vec![], refinement: None, data });
        }
        let (positions, cells) = read_source(&mut archive, &manifest)?;
        let size = manifest.cell_size();
        let may_be_refined = !matches!(manifest.kind, Kind::Shell | Kind::MovedMesh | Kind::CompositeCage);
        let refinement = match may_be_refined && archive.0.contains_key("cells.npy") {
            true => Some(Refinement::read(&mut archive, size)?),
            false => None,
        };
        let data = if manifest.kind == Kind::Shell {
            MapData::Shell(ShellData::read(&mut archive, manifest.target)?)
        } else if manifest.kind == Kind::MovedMesh {
            MapData::Moved(Array::take(&mut archive, "target_positions")?.read_points(Some(positions.len()), 3)?)
        } else if manifest.kind == Kind::CompositeCage {
            MapData::Cages(read_stages(&mut archive, positions.len())?)
        } else if manifest.kind == Kind::PiecewiseLinear {
            let count = positions.len() + refinement.as_ref().map_or(0, |r| r.carriers.len());
            MapData::PiecewiseLinear(Array::take(&mut archive, "target_positions")?.read_points(Some(count), size - 1)?)
        } else {
            let count = refinement.as_ref().map_or(cells.len(), |r| r.cells.len()) / size;
            MapData::Foliation(FoliationData::read(&mut archive, &manifest, count)?)
        };
        all_taken(&archive)?;
        Ok(MapFile { manifest, positions, cells, refinement, data })
    }

    /// Vertices of the refined complex.
    pub(crate) fn vertex_count(&self) -> usize {
        self.positions.len() + self.refinement.as_ref().map_or(0, |r| r.carriers.len())
    }

    /// The source vertices that carry a vertex, with their weights; none if it does not exist.
    pub(crate) fn carrier(&self, vertex: u32) -> impl Iterator<Item = (u32, i64)> {
        let carrier = match ((vertex as usize).checked_sub(self.positions.len()), &self.refinement) {
            (None, _) => [(vertex, 1), (0, 0), (0, 0), (0, 0)],
            (Some(row), Some(refinement)) => refinement.carriers.get(row).copied().unwrap_or_default(),
            (Some(_), None) => Default::default(),
        };
        carrier.into_iter().filter(|&(_, weight)| weight > 0)
    }

    /// Where a vertex, the middle of a column, or a vertex of the other section lies, rounded, for drawings only; `None` if nowhere.
    pub(crate) fn place(&self, vertex: u32) -> Option<Point> {
        if let (MapData::Shell(shell), Some(v)) = (&self.data, (vertex as usize).checked_sub(self.positions.len())) {
            let on_section = |v: usize| shell.section.as_ref()?.0.get(v).copied();
            let place = shell.levels[1].get(v).copied().or_else(|| on_section(v.checked_sub(shell.levels[1].len())?));
            return place.filter(|p| p.iter().all(|x| x.is_finite()));
        }
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for (source_vertex, weight) in self.carrier(vertex) {
            let position = self.positions.get(source_vertex as usize)?;
            (0..3).for_each(|axis| sum[axis] += weight as f64 * position[axis]);
            total += weight as f64;
        }
        Some(sum.map(|x| x / total)).filter(|p| p.iter().all(|x| x.is_finite()))
    }
}

/// Only notes may be left in the archive.
fn all_taken(archive: &Archive) -> Result<(), Unreadable> {
    match archive.0.keys().find(|name| !name.starts_with("note_")) {
        Some(name) => Err(unreadable(format!("entry {name:?} does not belong into this kind of map"))),
        None => Ok(()),
    }
}

/// SHA-256 of the arrays of a source: its counts, then the elements as stored.
pub(crate) fn source_hash(counts: [usize; 3], arrays: &[&Array]) -> String {
    let mut hasher = Sha256::new();
    counts.iter().for_each(|&count| hasher.update((count as u64).to_le_bytes()));
    arrays.iter().for_each(|array| hasher.update(array.content));
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The source mesh, when it is the one of the manifest.
fn read_source(archive: &mut Archive, manifest: &Manifest) -> Result<(Vec<Point>, Vec<u32>), Unreadable> {
    let (positions, cells) = (Array::take(archive, "source_positions")?, Array::take(archive, "source_cells")?);
    let (source, size) = (&manifest.source, manifest.cell_size());
    let hash = source_hash([source.vertices, size, source.cells], &[&positions, &cells]);
    let source_arrays = (positions.read_points(None, 3)?, cells.read(U4, None, size)?);
    let is_counted = (source_arrays.0.len(), source_arrays.1.len() / size) == (source.vertices, source.cells);
    readable(is_counted, "the source has another number of vertices or cells than the manifest says")?;
    readable(hash == source.content_sha256, "the source arrays do not have the stated content_sha256 (lower-case)")?;
    Ok(source_arrays)
}

/// The vertices of the cages after the source, one or more.
fn read_stages(archive: &mut Archive, count: usize) -> Result<Vec<Vec<Point>>, Unreadable> {
    let all = Array::take(archive, "stage_positions")?.read_points(None, 3)?;
    let is_whole = count > 0 && !all.is_empty() && all.len() % count == 0;
    readable(is_whole, "stage_positions does not have one or more cages of as many vertices as the source")?;
    Ok(all.chunks_exact(count).map(<[Point]>::to_vec).collect())
}

impl Refinement {
    fn read(archive: &mut Archive, size: usize) -> Result<Self, Unreadable> {
        let vertices = Array::take(archive, "carrier_vertices")?.read(U4, None, size)?;
        let weights = Array::take(archive, "carrier_weights")?.read(I8, Some(vertices.len() / size), size)?;
        let cells = Array::take(archive, "cells")?.read(U4, None, size)?;
        let parents = Array::take(archive, "parents")?.read(U4, Some(cells.len() / size), 1)?;
        let pairs: Vec<(u32, i64)> = vertices.into_iter().zip(weights).collect();
        let row = |row: &[(u32, i64)]| [0, 1, 2, 3].map(|i| row.get(i).copied().unwrap_or_default());
        Ok(Refinement { carriers: pairs.chunks_exact(size).map(row).collect(), cells, parents })
    }
}

impl FoliationData {
    fn read(archive: &mut Archive, manifest: &Manifest, count: usize) -> Result<Self, Unreadable> {
        let target = manifest.target;
        let directions = Array::take(archive, "directions")?.read(I1, Some(count), manifest.cell_size())?;
        let lengths = Array::take(archive, "lengths")?.read(U4, Some(count), 1)?;
        let (mut section_vertices, mut section_coordinates) = (vec![], vec![]);
        if target != Target::Ball {
            let columns = if target == Target::Cube { 2 } else { 1 };
            section_vertices = Array::take(archive, "section_vertices")?.read(U4, None, 1)?;
            let rows = Some(section_vertices.len());
            section_coordinates = Array::take(archive, "section_coordinates")?.read_points(rows, columns)?;
        }
        Ok(FoliationData { directions, lengths, section_vertices, section_coordinates })
    }
}

/// The vertices of a planar source and the sizes of its rings, when it is the one of the manifest.
pub(crate) fn read_planar_source(
    archive: &mut Archive,
    manifest: &Manifest,
) -> Result<(Vec<Point>, Vec<u32>), Unreadable> {
    let (points, rings) = (Array::take(archive, "source_points")?, Array::take(archive, "source_rings")?);
    let hash = source_hash([manifest.source.vertices, 2, manifest.source.cells], &[&points, &rings]);
    let (source_points, ring_sizes) = (points.read_points(None, 2)?, rings.read(U4, None, 1)?);
    let is_counted = (source_points.len(), ring_sizes.len()) == (manifest.source.vertices, manifest.source.cells);
    readable(is_counted, "the source has another number of vertices or rings than the manifest says")?;
    readable(hash == manifest.source.content_sha256, "the source arrays do not have the stated content_sha256")?;
    let total: u64 = ring_sizes.iter().map(|&n| u64::from(n)).sum();
    let are_rings = total == source_points.len() as u64 && ring_sizes.iter().all(|&n| n >= 3);
    readable(are_rings, "the rings do not have three vertices each, and all of them together")?;
    let is_as_said = match manifest.target {
        Target::Polygon => ring_sizes.len() == 1,
        Target::Annulus => ring_sizes.len() == 2,
        _ => ring_sizes.len() > 2,
    };
    readable(is_as_said, "a polygon has one ring, an annulus two, a domain more")?;
    Ok((source_points, ring_sizes))
}

impl HyperbolicData {
    fn read(archive: &mut Archive, manifest: &Manifest) -> Result<Self, Unreadable> {
        let array = Array::take(archive, "gluings")?;
        let source = &manifest.source;
        let hash = source_hash([source.vertices, 4, source.cells], &[&array]);
        let gluings = array.read(U4, None, 5)?.as_chunks().0.to_vec();
        let is_counted = gluings.len() % 4 == 0 && gluings.len() / 4 == source.cells;
        readable(is_counted, "gluings does not have four rows for each tetrahedron of the manifest")?;
        readable(hash == source.content_sha256, "the gluings do not have the stated content_sha256")?;
        let cosh_lengths = Array::take(archive, "cosh_lengths")?.read(F8, None, 1)?;
        let radius = Array::take(archive, "radius")?.read(F8, Some(1), 1)?[0];
        Ok(HyperbolicData { gluings, cosh_lengths, radius })
    }
}

impl CompositeData {
    fn read(archive: &mut Archive, manifest: &Manifest) -> Result<Self, Unreadable> {
        let (source, ring_sizes) = read_planar_source(archive, manifest)?;
        let count = source.len();
        let flat = Array::take(archive, "stage_points")?.read_points(None, 2)?;
        let is_whole = !flat.is_empty() && flat.len() % count == 0;
        readable(is_whole, "stage_points does not have one or more domains of as many vertices as the source")?;
        let steps = flat.len() / count;
        let stages = std::iter::once(source).chain(flat.chunks_exact(count).map(<[Point]>::to_vec)).collect();
        let added_counts = Array::take(archive, "added_counts")?.read(U4, Some(steps), 1)?;
        let triangle_counts = Array::take(archive, "triangle_counts")?.read(U4, Some(steps), 1)?;
        let added = in_parts(&Array::take(archive, "added_points")?.read_points(None, 2)?, &added_counts, 1)?;
        let triangles = in_parts(&Array::take(archive, "triangles")?.read(U4, None, 3)?, &triangle_counts, 3)?;
        let tilings = added.into_iter().zip(triangles).map(|(added, triangles)| TilingData { added, triangles });
        Ok(CompositeData { ring_sizes, stages, tilings: tilings.collect() })
    }
}

/// A list cut into parts of given numbers of rows.
fn in_parts<T: Clone>(list: &[T], counts: &[u32], row: usize) -> Result<Vec<Vec<T>>, Unreadable> {
    let total: u64 = counts.iter().map(|&count| u64::from(count)).sum();
    readable(total == (list.len() / row) as u64, "the counts of a tiling do not add up to its rows")?;
    let mut rest = list;
    let parts = counts.iter().map(|&count| {
        let (part, after) = rest.split_at(row * count as usize);
        rest = after;
        part.to_vec()
    });
    Ok(parts.collect())
}

impl HarmonicData {
    /// Reads the map; also the vertices of the source as points.
    fn read(archive: &mut Archive, manifest: &Manifest) -> Result<(Self, Vec<Point>), Unreadable> {
        let (source_points, ring_sizes) = read_planar_source(archive, manifest)?;
        let seams = match manifest.target {
            Target::Domain => Array::take(archive, "seams")?.read(U4, None, 2)?.as_chunks().0.to_vec(),
            _ => vec![],
        };
        let count = source_points.len();
        let target_points = Array::take(archive, "target_points")?.read_points(Some(count), 2)?;
        let middle_points = Array::take(archive, "middle_points")?.read_points(Some(count + 2 * seams.len()), 2)?;
        let [source, target] = HALF_NAMES.map(|names| HalfData::read(archive, names, manifest.target));
        let (is_cylinder, halves) = (manifest.target == Target::Annulus, [source?, target?]);
        let positions = source_points.clone();
        let data = HarmonicData { ring_sizes, source_points, target_points, middle_points, seams, is_cylinder, halves };
        Ok((data, positions))
    }
}

/// The arrays of the halves of a composite harmonic map.
const HALF_NAMES: [[&str; 6]; 2] = [
    ["source_boundary", "source_inner", "source_images", "source_triangles", "source_shifts", "source_seam_points"],
    ["target_boundary", "target_inner", "target_images", "target_triangles", "target_shifts", "target_seam_points"],
];

impl HalfData {
    fn read(archive: &mut Archive, names: [&'static str; 6], target: Target) -> Result<Self, Unreadable> {
        let [boundary, inner, images, triangles, shifts, seam_points] = names;
        let boundary = Array::take(archive, boundary)?.read(U4, None, 3)?;
        let inner = Array::take(archive, inner)?.read_points(None, 2)?;
        let images = Array::take(archive, images)?.read_points(Some(inner.len()), 2)?;
        let triangles = Array::take(archive, triangles)?.read(U4, None, 3)?;
        let shifts = match target {
            Target::Annulus => Array::take(archive, shifts)?.read(I1, Some(triangles.len() / 3), 3)?,
            _ => vec![],
        };
        let seam_points = match target {
            Target::Domain => Array::take(archive, seam_points)?.read_points(None, 2)?,
            _ => vec![],
        };
        Ok(HalfData { boundary, seam_points, inner, images, triangles, shifts })
    }
}

impl ShellData {
    fn read(archive: &mut Archive, target: Target) -> Result<Self, Unreadable> {
        let bottom = Array::take(archive, "shell_bottom")?.read_points(None, 3)?;
        let count = Some(bottom.len());
        let middle = Array::take(archive, "shell_middle")?.read_points(count, 3)?;
        let top = Array::take(archive, "shell_top")?.read_points(count, 3)?;
        let prisms = Array::take(archive, "prisms")?.read(U4, None, 3)?;
        let section = if target == Target::Section {
            let positions = Array::take(archive, "section_positions")?.read_points(None, 3)?;
            Some((positions, Array::take(archive, "section_cells")?.read(U4, None, 3)?))
        } else {
            None
        };
        let pairs = match target {
            Target::ImmersedShell => Some(Array::take(archive, "shell_pairs")?.read(U4, None, 2)?),
            _ => None,
        };
        let pairs = pairs.map(|flat| flat.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect());
        Ok(ShellData {
            levels: [bottom, middle, top],
            prisms,
            section,
            pairs,
            is_embedded: target == Target::EmbeddedShell,
        })
    }
}
