//! What a report shows of a foliation map.

use homeo_core::mesh::{CellId, VertexId};

use super::{CellList, CellMesh, Leaf, ReportData, TargetShape, VerdictWords};
use crate::certificate::{FoliationMap, either};
use crate::map::{Foliation, Target, distortions};

/// How many leaves a report draws at most.
const LEAVES: usize = 160;

/// The drawable part of a report on a map: mesh, images of its vertices, leaves, distortion. Facts and
/// seconds are empty and for the caller to add.
///
/// # Complexity
/// One leaf for each vertex of the foliated mesh, in parallel.
pub fn report_of_map(map: &FoliationMap, title: &str, subtitle: &str, verdict: VerdictWords) -> ReportData {
    let target = match map.target() {
        Target::Square => TargetShape::Square,
        Target::Disk => TargetShape::Disk,
        Target::Cube => TargetShape::Cube,
        Target::Ball => TargetShape::Ball,
    };
    let (cells, leaves, distortion) = either!(map, map => drawable(map));
    ReportData {
        title: title.to_owned(),
        subtitle: subtitle.to_owned(),
        target,
        verdict,
        facts: Vec::new(),
        stage_seconds: Vec::new(),
        cells,
        leaves,
        distortion,
        shell: None,
    }
}

fn drawable<const K: usize>(map: &Foliation<K>) -> (CellMesh, Vec<Leaf>, Vec<f64>) {
    let mesh = &map.parts().mesh;
    let mut images = map.vertex_images();
    // Vertices that no cell names have no image; they are not drawn, but must be finite.
    images.iter_mut().filter(|p| p[0].is_nan()).for_each(|p| *p = [0.0; 3]);
    let cells = mesh.complex().cells();
    let distortion = distortions(cells, mesh.positions(), &images);
    let stride = (cells.len() / LEAVES).max(1);
    let leaves = (0..cells.len())
        .step_by(stride)
        .filter_map(|cell| map.leaf_through(CellId::new(cell)))
        .map(|leaf| Leaf { source: leaf.source, target: leaf.target.to_vec() })
        .collect();
    (CellMesh { positions: mesh.positions().to_vec(), images, cells: cell_list(cells) }, leaves, distortion)
}

fn cell_list<const K: usize>(cells: &[[VertexId; K]]) -> CellList {
    let numbers = |cell: &[VertexId; K], i: usize| cell[i].raw();
    if K == 3 {
        CellList::Triangles(cells.iter().map(|c| std::array::from_fn(|i| numbers(c, i))).collect())
    } else {
        CellList::Tetrahedra(cells.iter().map(|c| std::array::from_fn(|i| numbers(c, i))).collect())
    }
}
