//! What of the source stays in the middle surface: vertices, and chains of sharp edges.

use std::collections::HashMap;

use super::directions::{dot, unit_normal};
use super::prism::sides;
use crate::construct::crease::{Creases, Kind};
use crate::input::SourceMesh;

/// See the module's documentation. Numbers are those of columns.
pub(super) struct Kept {
    creases: Creases,
    is_pinned: Vec<bool>,
}

impl Kept {
    /// Everything that is asked for of a surface: some vertices, and the edges where normals differ by more than an angle.
    pub fn new(surface: &SourceMesh<3>, vertices: &[u32], feature_angle: Option<f64>) -> Self {
        let mut is_pinned = vec![false; surface.positions().len()];
        vertices.iter().for_each(|&v| is_pinned[v as usize] = true);
        let edges = feature_angle.map_or_else(Vec::new, |angle| sharp_edges(surface, angle));
        let kept = edges.into_iter().map(|edge| (edge, Kind::Feature));
        Self { creases: Creases::new(surface.positions().len(), kept), is_pinned }
    }

    /// Whether the middle of a column stays where it is.
    pub fn is_fixed(&self, column: u32) -> bool {
        self.is_pinned[column as usize] || !self.creases.at(column).is_empty()
    }

    /// Whether an edge stays an edge.
    pub fn is_edge(&self, a: u32, b: u32) -> bool {
        self.creases.kind(a, b).is_some()
    }

    /// Whether a column may go into its neighbour: if nothing is to stay there, or along a chain of sharp edges.
    pub fn may_go(&self, gone: u32, kept: u32) -> bool {
        if self.is_pinned[gone as usize] {
            return false;
        }
        match self.creases.at(gone) {
            [] => true,
            [_, _] => {
                let before = self.creases.before(gone, kept);
                // Two kept edges must not become one.
                self.is_edge(gone, kept) && before.is_some_and(|before| !self.is_edge(before, kept))
            }
            _ => false,
        }
    }

    /// Column `gone`, which was allowed to, has gone into `kept`.
    pub fn collapse(&mut self, gone: u32, kept: u32) {
        if let Some(before) = self.creases.before(gone, kept) {
            self.creases.shorten(before, gone, kept);
        }
    }
}

/// The edges of a surface where the normals of their two triangles differ by more than an angle, in radians.
fn sharp_edges(surface: &SourceMesh<3>, angle: f64) -> Vec<[u32; 2]> {
    let mut first = HashMap::new();
    let mut sharp = Vec::new();
    for cell in surface.complex().cells() {
        let normal = unit_normal(cell.map(|v| surface.positions()[v.index()]));
        for [a, b] in sides(cell.map(|v| v.raw())) {
            match first.remove(&[b, a]) {
                Some(other) if dot(normal, other) < angle.cos() => sharp.push([b, a]),
                Some(_) => {}
                None => {
                    first.insert([a, b], normal);
                }
            }
        }
    }
    sharp
}
