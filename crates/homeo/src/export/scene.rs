//! What the page's picture is made from: one block of bytes and a description of it.

use super::data::{CellList, CellMesh, ReportData, ShellPicture, TargetShape};
use super::facets::{Facets, visible_facets};
use super::histogram::Statistics;
use super::leaves::{PairedLeaves, pair_leaves};
use super::levels::{Coordinate, LevelSet, fit, level_sets};
use super::overlay::weights_near;
use super::pack::{Block, Frame, Slot};
use super::page::grouped;
use super::simplify::simplify;
use crate::map::ShellParts;
use serde::Serialize;
use std::collections::HashMap;

/// Bytes of arrays before base64, which adds a third.
const BUDGET_BYTES: usize = 7_000_000;
const MAX_SURFACE_TRIANGLES: usize = 200_000;
const MAX_LEAF_POINTS: usize = 100_000;
const MAX_LAYER_TRIANGLES: usize = 60_000;

/// The layers of a shell, from below.
const LAYERS: [&str; 3] = ["bottom", "middle", "top"];

/// The picture: arrays and their description.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    /// The arrays.
    pub block: Block,
    /// Their description, embedded as JSON.
    pub manifest: Manifest,
}

/// The description that the viewer reads.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Manifest {
    target: &'static str,
    dimension: usize,
    coordinates: Vec<&'static str>,
    source_frame: Frame,
    image_frame: Frame,
    vertices: PointPair,
    /// The drawn triangles.
    surface: Slot,
    /// For each drawn triangle 0..=254 on the logarithmic scale, 255 where the cell collapses.
    distortion: Option<Slot>,
    /// The ratio shown as 254.
    distortion_end: f64,
    /// Tetrahedra, for sections; absent where they do not fit.
    volume: Option<Slot>,
    levels: Vec<LevelEntry>,
    leaves: Option<LeafEntry>,
    /// For each vertex two barycentric weights in the prism of its triangles; only for shells.
    weights: Option<Slot>,
    shell: Option<ShellEntry>,
    /// What the picture leaves out, in words.
    pub notes: Vec<String>,
}

/// The same points on both sides.
#[derive(Clone, Copy, Debug, Serialize)]
struct PointPair {
    source: Slot,
    image: Slot,
}

#[derive(Clone, Debug, Serialize)]
struct LevelEntry {
    coordinate: &'static str,
    checker_axis: usize,
    label: String,
    points: PointPair,
    elements: Slot,
}

#[derive(Clone, Copy, Debug, Serialize)]
struct LeafEntry {
    points: PointPair,
    starts: Slot,
}

#[derive(Clone, Copy, Debug, Serialize)]
struct ShellEntry {
    prisms: usize,
    /// Those of the image.
    triangles: usize,
}

/// Vertices that the page holds, with triangles (and perhaps tetrahedra) that refer to them.
#[derive(Default)]
struct Selection {
    positions: Vec<[f64; 3]>,
    images: Vec<[f64; 3]>,
    triangles: Vec<u32>,
    tetrahedra: Option<Vec<u32>>,
    /// Weights in prisms, packed; only for shells.
    weights: Vec<u16>,
}

/// Bottom, middle and top of a shell, on the same triangles.
#[derive(Default)]
struct Layers {
    points: [Vec<[f64; 3]>; 3],
    triangles: Vec<u32>,
}

impl Scene {
    /// Chooses what fits, and packs it.
    pub fn build(data: &ReportData) -> Self {
        let mut notes = Vec::new();
        let facets = drawn_facets(&data.cells, &mut notes);
        let (leaves, shown_leaves) = pair_leaves(&data.leaves, MAX_LEAF_POINTS);
        if shown_leaves < data.leaves.len() {
            notes.push(format!("{} of {} leaves are drawn.", grouped(shown_leaves), grouped(data.leaves.len())));
        }
        let layers = data.shell.as_ref().map(|shell| drawn_layers(&shell.parts, &mut notes));
        let left = BUDGET_BYTES.saturating_sub(12 * (leaves.source.len() + facets.triangles.len()));
        let selection = match &data.shell {
            Some(shell) => select_in_prisms(&data.cells, &facets, shell),
            None => select(&data.cells, &facets, left / 2, &mut notes),
        };
        let used = 12 * selection.positions.len() + selection.tetrahedra.as_ref().map_or(0, |cells| 4 * cells.len());
        let mut levels = level_sets(data.target, &data.cells);
        if fit(&mut levels, left.saturating_sub(used)) {
            notes.push("Some level sets are left out to keep the page small.".into());
        }
        pack(data, &facets, &selection, &levels, &leaves, layers.as_ref(), notes)
    }
}

/// The boundary or the surface, thinned if need be.
fn drawn_facets(mesh: &CellMesh, notes: &mut Vec<String>) -> Facets {
    let facets = visible_facets(&mesh.cells);
    let all = facets.triangles.len();
    if all <= MAX_SURFACE_TRIANGLES {
        return facets;
    }
    let facets = simplify(mesh, facets, MAX_SURFACE_TRIANGLES);
    let shown = facets.triangles.len();
    notes.push(format!("The surface is simplified for the picture: {} of {} triangles.", grouped(shown), grouped(all)));
    facets
}

/// All vertices and cells where the volume fits into so many bytes; otherwise the vertices of the drawn triangles.
fn select(mesh: &CellMesh, facets: &Facets, volume_bytes: usize, notes: &mut Vec<String>) -> Selection {
    let index_bytes = if mesh.positions.len() <= 1 << 16 { 2 } else { 4 };
    if let CellList::Tetrahedra(cells) = &mesh.cells {
        if 12 * mesh.positions.len() + 4 * index_bytes * cells.len() <= volume_bytes {
            return Selection {
                positions: mesh.positions.clone(),
                images: mesh.images.clone(),
                triangles: facets.triangles.as_flattened().to_vec(),
                tetrahedra: Some(cells.as_flattened().to_vec()),
                weights: Vec::new(),
            };
        }
        notes.push("The inside is too large for the page: a cut shows level sets and leaves, but no section.".into());
    }
    let mut new_index = vec![u32::MAX; mesh.positions.len()];
    let mut selection = Selection::default();
    for &vertex in facets.triangles.as_flattened() {
        let index = &mut new_index[vertex as usize];
        if *index == u32::MAX {
            *index = selection.positions.len() as u32;
            selection.positions.push(mesh.positions[vertex as usize]);
            selection.images.push(mesh.images[vertex as usize]);
        }
        selection.triangles.push(*index);
    }
    selection
}

/// The vertices of the drawn triangles, once for each prism that they are drawn in.
fn select_in_prisms(mesh: &CellMesh, facets: &Facets, shell: &ShellPicture) -> Selection {
    let mut selection = Selection::default();
    let mut numbers = HashMap::new();
    for (triangle, &cell) in facets.triangles.iter().zip(&facets.cells) {
        let prism = shell.prism_of_cell[cell as usize];
        let middle = shell.parts.prisms[prism as usize].map(|v| shell.parts.middle[v as usize]);
        for &vertex in triangle {
            let number = *numbers.entry((vertex, prism)).or_insert_with(|| {
                selection.positions.push(mesh.positions[vertex as usize]);
                selection.images.push(mesh.images[vertex as usize]);
                let place = shell.middle_of_vertex[vertex as usize];
                selection.weights.extend(weights_near(&middle, place).into_iter().take(2).map(packed_weight));
                selection.positions.len() as u32 - 1
            });
            selection.triangles.push(number);
        }
    }
    selection
}

/// Weights from -0.5 to 1.5 in 16 bits: those of a simplified triangle may lie outside its prism.
fn packed_weight(weight: f64) -> u16 {
    ((weight + 0.5) / 2.0 * 65535.0).clamp(0.0, 65535.0).round() as u16
}

/// The layers, thinned if need be; all three alike.
fn drawn_layers(parts: &ShellParts, notes: &mut Vec<String>) -> Layers {
    let cells = CellList::Triangles(parts.prisms.clone());
    let mesh = CellMesh { positions: parts.middle.clone(), images: parts.middle.clone(), cells };
    let facets = simplify(&mesh, visible_facets(&mesh.cells), MAX_LAYER_TRIANGLES);
    let (shown, all) = (facets.triangles.len(), parts.prisms.len());
    if shown < all {
        notes.push(format!(
            "The layers are simplified for the picture: {} of {} prisms.",
            grouped(shown),
            grouped(all)
        ));
    }
    let mut layers = Layers::default();
    let mut numbers = HashMap::new();
    for &column in facets.triangles.as_flattened() {
        let number = *numbers.entry(column).or_insert_with(|| {
            for (layer, points) in layers.points.iter_mut().zip([&parts.bottom, &parts.middle, &parts.top]) {
                layer.push(points[column as usize]);
            }
            layers.points[0].len() as u32 - 1
        });
        layers.triangles.push(number);
    }
    layers
}

/// The box of the target; images that leave it (they should not) widen it.
fn target_frame(target: TargetShape, images: &[[f64; 3]]) -> Frame {
    let depth = if target.dimension() == 2 { 0.0 } else { 1.0 };
    let corners = match target {
        TargetShape::Square | TargetShape::Cube => [[0.0; 3], [1.0, 1.0, depth]],
        TargetShape::Disk | TargetShape::Ball => [[-1.0, -1.0, -depth], [1.0, 1.0, depth]],
        TargetShape::Middle | TargetShape::Section => return Frame::around(images.iter()),
    };
    Frame::around(corners.iter().chain(images))
}

fn pack(
    data: &ReportData,
    facets: &Facets,
    selection: &Selection,
    levels: &[LevelSet],
    leaves: &PairedLeaves,
    layers: Option<&Layers>,
    notes: Vec<String>,
) -> Scene {
    let mut source_frame = Frame::around(data.cells.positions.iter().chain(&leaves.source));
    let mut image_frame = target_frame(data.target, &data.cells.images);
    if let Some(layers) = layers {
        // Both sides and the layers lie in the same space, and are drawn in the same place.
        let corners = [source_frame.low, source_frame.high, image_frame.low, image_frame.high];
        source_frame = Frame::around(corners.iter().chain(layers.points.iter().flatten()));
        image_frame = source_frame;
    }
    let mut block = Block::default();
    let pair = |block: &mut Block, source: &[[f64; 3]], image: &[[f64; 3]]| PointPair {
        source: block.points(&source_frame, source),
        image: block.points(&image_frame, image),
    };
    let vertices = pair(&mut block, &selection.positions, &selection.images);
    let surface = block.indices(selection.positions.len(), &selection.triangles);
    let volume = selection.tetrahedra.as_ref().map(|cells| block.indices(selection.positions.len(), cells));
    let distortion_end = Statistics::of(&data.distortion).map_or(10.0, |statistics| statistics.colour_end());
    let distortion = (!data.distortion.is_empty()).then(|| {
        let shade = |&cell: &u32| shade(data.distortion[cell as usize], distortion_end);
        block.octets(&facets.cells.iter().map(shade).collect::<Vec<u8>>())
    });
    let mut levels: Vec<LevelEntry> = levels
        .iter()
        .map(|set| LevelEntry {
            coordinate: set.coordinate.name(data.target),
            checker_axis: set.coordinate.checker_axis(),
            label: set.label.clone(),
            points: pair(&mut block, &set.patch.source, &set.patch.image),
            elements: block.indices(set.patch.source.len(), &set.patch.elements),
        })
        .collect();
    if let Some(layers) = layers {
        let elements = block.indices(layers.points[0].len(), &layers.triangles);
        for (name, points) in LAYERS.into_iter().zip(&layers.points) {
            let place = block.points(&source_frame, points);
            let points = PointPair { source: place, image: place };
            levels.push(LevelEntry { coordinate: name, checker_axis: 0, label: name.into(), points, elements });
        }
    }
    let weights = (!selection.weights.is_empty()).then(|| block.words(&selection.weights));
    let leaves = (!leaves.source.is_empty()).then(|| LeafEntry {
        points: pair(&mut block, &leaves.source, &leaves.image),
        starts: block.indices(leaves.source.len() + 1, &leaves.starts),
    });
    let coordinates = match layers {
        Some(_) => LAYERS.to_vec(),
        None => Coordinate::of(data.target).iter().map(|coordinate| coordinate.name(data.target)).collect(),
    };
    let shell = data
        .shell
        .as_ref()
        .map(|shell| ShellEntry { prisms: shell.parts.prisms.len(), triangles: shell.image_triangles });
    let (target, dimension) = (data.target.name(), data.target.space_dimension());
    let manifest = Manifest {
        target,
        dimension,
        coordinates,
        source_frame,
        image_frame,
        vertices,
        surface,
        distortion,
        distortion_end,
        volume,
        levels,
        leaves,
        weights,
        shell,
        notes,
    };
    Scene { block, manifest }
}

/// A distortion as 0..=254 on a logarithmic scale from 1 to `end`, or 255 where it is not finite.
fn shade(distortion: f64, end: f64) -> u8 {
    if distortion.is_finite() {
        (distortion.max(1.0).ln() / end.ln() * 254.0).clamp(0.0, 254.0).round() as u8
    } else {
        255
    }
}
