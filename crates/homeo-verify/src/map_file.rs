//! Container rules: which arrays a map file holds, with which types and shapes, and the hash of its source.

use crate::archive::Archive;
use crate::manifest::{Manifest, Target};
use crate::npy::find;
use crate::number::Point;
use crate::verdict::{Unreadable, unreadable};
use sha2::{Digest, Sha256};
use std::fmt::Write;

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
    pub(crate) carrier_vertices: Vec<u32>,
    pub(crate) carrier_weights: Vec<i64>,
    pub(crate) cells: Vec<u32>,
    pub(crate) parents: Vec<u32>,
}

/// The arrays that define the map on the refined complex.
pub(crate) enum MapData {
    Foliation(FoliationData),
    /// Images of the vertices, `dimension` numbers each.
    PiecewiseLinear(Vec<f64>),
}

/// The arrays of a foliation; the section is empty for the ball.
pub(crate) struct FoliationData {
    pub(crate) directions: Vec<i8>,
    pub(crate) lengths: Vec<u32>,
    pub(crate) section_vertices: Vec<u32>,
    pub(crate) section_coordinates: Vec<f64>,
}

const REFINEMENT: [&str; 4] = ["carrier_vertices", "carrier_weights", "cells", "parents"];

impl MapFile {
    /// Decodes a map file and checks its hash.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, Unreadable> {
        let archive = Archive::open(bytes)?;
        let Some(text) = archive.entry("manifest.json") else {
            return unreadable("there is no manifest.json");
        };
        let manifest = Manifest::parse(text)?;
        let is_refined = archive.entry("cells.npy").is_some();
        check_names(&archive, &manifest, is_refined)?;
        let size = manifest.target.dimension() + 1;
        let raw_positions = find(&archive, "source_positions")?;
        let raw_cells = find(&archive, "source_cells")?;
        let positions = points(&raw_positions.read(&[None, Some(3)])?);
        let cells: Vec<u32> = raw_cells.read(&[None, Some(size)])?;
        let counts = [positions.len() as u64, size as u64, (cells.len() / size) as u64];
        if [counts[0], counts[2]] != [manifest.source_vertices, manifest.source_cells] {
            return unreadable("the source has another number of vertices or cells than the manifest says");
        }
        if content_hash(counts, raw_positions.content, raw_cells.content) != manifest.source_sha256 {
            return unreadable("the source arrays do not have the stated content_sha256");
        }
        let refinement = if is_refined { Some(Refinement::read(&archive, size)?) } else { None };
        let mut map = MapFile { manifest, positions, cells, refinement, data: MapData::PiecewiseLinear(vec![]) };
        map.data = map.read_data(&archive)?;
        Ok(map)
    }

    fn read_data(&self, archive: &Archive) -> Result<MapData, Unreadable> {
        let target = self.manifest.target;
        if !self.manifest.is_foliation {
            let shape = [Some(self.vertex_count()), Some(target.dimension())];
            return Ok(MapData::PiecewiseLinear(find(archive, "target_positions")?.read(&shape)?));
        }
        let count = self.refinement.as_ref().map_or(self.cells.len(), |r| r.cells.len()) / self.cell_size();
        let mut data = FoliationData {
            directions: find(archive, "directions")?.read(&[Some(count), Some(self.cell_size())])?,
            lengths: find(archive, "lengths")?.read(&[Some(count)])?,
            section_vertices: vec![],
            section_coordinates: vec![],
        };
        if target != Target::Ball {
            data.section_vertices = find(archive, "section_vertices")?.read(&[None])?;
            let rows = Some(data.section_vertices.len());
            let shape = if target == Target::Cube { vec![rows, Some(2)] } else { vec![rows] };
            data.section_coordinates = find(archive, "section_coordinates")?.read(&shape)?;
        }
        Ok(MapData::Foliation(data))
    }

    /// Vertices of a cell: 3 or 4.
    pub(crate) fn cell_size(&self) -> usize {
        self.manifest.target.dimension() + 1
    }

    /// Vertices of the refined complex.
    pub(crate) fn vertex_count(&self) -> usize {
        let added = self.refinement.as_ref().map_or(0, |r| r.carrier_vertices.len() / self.cell_size());
        self.positions.len() + added
    }

    /// Where a vertex lies, rounded, for drawings only; `None` if nowhere.
    pub(crate) fn place(&self, vertex: u32) -> Option<Point> {
        let Some(row) = (vertex as usize).checked_sub(self.positions.len()) else {
            return self.positions.get(vertex as usize).copied();
        };
        let (refinement, size) = (self.refinement.as_ref()?, self.cell_size());
        let mut sum = [0.0; 4];
        for i in row * size..(row + 1) * size {
            let position = self.positions.get(*refinement.carrier_vertices.get(i)? as usize)?;
            let weight = *refinement.carrier_weights.get(i)? as f64;
            (0..3).for_each(|axis| sum[axis] += weight * position[axis]);
            sum[3] += weight;
        }
        Some([sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]]).filter(|p| p.iter().all(|x| x.is_finite()))
    }
}

impl Refinement {
    fn read(archive: &Archive, size: usize) -> Result<Self, Unreadable> {
        let carrier_vertices: Vec<u32> = find(archive, "carrier_vertices")?.read(&[None, Some(size)])?;
        let rows = carrier_vertices.len() / size;
        let cells: Vec<u32> = find(archive, "cells")?.read(&[None, Some(size)])?;
        let parents = find(archive, "parents")?.read(&[Some(cells.len() / size)])?;
        let carrier_weights = find(archive, "carrier_weights")?.read(&[Some(rows), Some(size)])?;
        Ok(Refinement { carrier_vertices, carrier_weights, cells, parents })
    }
}

/// Every entry is one that the kind and target ask for, or a note. (Missing ones are found when read.)
fn check_names(archive: &Archive, manifest: &Manifest, is_refined: bool) -> Result<(), Unreadable> {
    let mut allowed = vec!["source_positions", "source_cells"];
    if is_refined {
        allowed.extend(REFINEMENT);
    }
    match (manifest.is_foliation, manifest.target) {
        (false, _) => allowed.push("target_positions"),
        (true, Target::Ball) => allowed.extend(["directions", "lengths"]),
        (true, _) => allowed.extend(["directions", "lengths", "section_vertices", "section_coordinates"]),
    }
    let known = |name: &str| {
        name == "manifest.json"
            || name.starts_with("note_")
            || name.strip_suffix(".npy").is_some_and(|stem| allowed.contains(&stem))
    };
    match archive.names().find(|name| !known(name)) {
        Some(name) => unreadable(format!("entry {name:?} does not belong into this kind of map")),
        None => Ok(()),
    }
}

fn points(numbers: &[f64]) -> Vec<Point> {
    numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}

/// SHA-256 of three counts and two arrays, as stored.
pub(crate) fn content_hash(counts: [u64; 3], positions: &[u8], cells: &[u8]) -> String {
    let mut hasher = Sha256::new();
    counts.iter().for_each(|count| hasher.update(count.to_le_bytes()));
    hasher.update(positions);
    hasher.update(cells);
    hasher.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}"); // writing to a String cannot fail
        text
    })
}
