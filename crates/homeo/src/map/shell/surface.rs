//! A surface in a shell, with a tree over its triangles.

use homeo_core::number::Scalar;
use homeo_core::spatial::{Aabb, Tree};

use super::SurfacePoint;
use super::space::zero;
use crate::input::SourceMesh;

type Point = [f64; 3];

/// A box that holds some points.
pub(super) fn hull<T: Scalar>(points: &[[T; 3]]) -> Aabb {
    let ends = points.iter().flat_map(|point| {
        let ends = point.each_ref().map(T::enclosure);
        [ends.map(|end| end.low()), ends.map(|end| end.high())]
    });
    Aabb::of(&ends.collect::<Vec<_>>())
}

#[derive(Debug)]
pub(crate) struct ShellSurface {
    pub mesh: SourceMesh<3>,
    tree: Tree,
}

impl ShellSurface {
    pub fn new(mesh: SourceMesh<3>) -> Self {
        let corner = |v: homeo_core::mesh::VertexId| mesh.positions()[v.index()];
        let boxes: Vec<Aabb> = mesh.complex().cells().iter().map(|cell| Aabb::of(&cell.map(corner))).collect();
        Self { tree: Tree::new(&boxes), mesh }
    }

    pub fn corners(&self, triangle: u32) -> [Point; 3] {
        self.mesh.complex().cells()[triangle as usize].map(|v| self.mesh.positions()[v.index()])
    }

    /// The triangles whose boxes meet that of some points, ascending.
    pub fn near<T: Scalar>(&self, points: &[[T; 3]]) -> Vec<u32> {
        let region = hull(points);
        let mut candidates = Vec::new();
        self.tree.query_box(&region, |t| candidates.push(t as u32));
        candidates.sort_unstable();
        candidates
    }

    /// The vertex at a place that is a double.
    pub fn at_vertex<T: Scalar>(&self, candidates: &[u32], place: Point, point: &[T; 3]) -> Option<SurfacePoint<T>> {
        candidates.iter().find_map(|&triangle| {
            let k = self.corners(triangle).iter().position(|corner| *corner == place)?;
            let weights = std::array::from_fn(|i| if i == k { T::from_f64(1.0) } else { zero() });
            Some(SurfacePoint { triangle, weights, point: point.clone() })
        })
    }
}
