//! Thinning of surfaces that are too large for a page, for display only.

use super::data::CellMesh;
use super::facets::Facets;
use std::collections::HashMap;

/// Merges vertices of the same box of a grid, with coarser and coarser grids, until at most `max_triangles` are left.
/// Kept vertices stay where they are, so that position and image still belong together.
pub(super) fn simplify(mesh: &CellMesh, facets: Facets, max_triangles: usize) -> Facets {
    let mut boxes_per_side = 1024.0;
    let mut kept = facets.clone();
    while kept.triangles.len() > max_triangles && boxes_per_side > 4.0 {
        kept = merge_by_grid(mesh, &facets, boxes_per_side);
        boxes_per_side *= 0.8;
    }
    kept
}

/// One round: each vertex becomes the first vertex seen in its box; triangles that collapse are dropped.
fn merge_by_grid(mesh: &CellMesh, facets: &Facets, boxes_per_side: f64) -> Facets {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for &vertex in facets.triangles.iter().flatten() {
        for (axis, &coordinate) in mesh.positions[vertex as usize].iter().enumerate() {
            low[axis] = low[axis].min(coordinate);
            high[axis] = high[axis].max(coordinate);
        }
    }
    let side = (0..3).map(|axis| high[axis] - low[axis]).fold(f64::MIN_POSITIVE, f64::max);
    let mut first_in_box: HashMap<[u32; 3], u32> = HashMap::new();
    let mut representative = |vertex: u32| {
        let position = mesh.positions[vertex as usize];
        let key = std::array::from_fn(|axis| ((position[axis] - low[axis]) / side * boxes_per_side) as u32);
        *first_in_box.entry(key).or_insert(vertex)
    };
    let mut merged = Facets::default();
    for (&triangle, &cell) in facets.triangles.iter().zip(&facets.cells) {
        let [a, b, c] = triangle.map(&mut representative);
        if a != b && b != c && c != a {
            merged.triangles.push([a, b, c]);
            merged.cells.push(cell);
        }
    }
    merged
}
