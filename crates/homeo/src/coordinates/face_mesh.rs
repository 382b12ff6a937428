//! A closed mesh of triangles, as coordinates of polyhedra take it.

use homeo_core::predicate::is_degenerate_triangle;

use super::CoordinateError;
use super::face_view::{Face, Point3};
use super::space::{PolyhedronError, check_closed};
use super::vectors::norm;

/// Points farther than this many diagonals away are refused: their squares would overflow.
const FARTHEST: f64 = 1e70;

/// Vertices and triangles with areas, multiplied by a power of two that makes the diagonal about 1.
#[derive(Clone, Debug)]
pub(super) struct FaceMesh {
    pub vertices: Vec<Point3>,
    pub faces: Vec<Face>,
    pub scale: f64,
}

impl FaceMesh {
    pub fn new(vertices: &[Point3], triangles: &[[u32; 3]]) -> Result<Self, PolyhedronError> {
        check_closed(vertices, triangles)?;
        let range = |k: usize| {
            let all = || vertices.iter().map(|v| v[k]);
            all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
        };
        let diagonal = norm([range(0), range(1), range(2)]);
        let scale = if diagonal > 0.0 { 2.0f64.powi(-diagonal.log2().floor() as i32) } else { 1.0 };
        let vertices: Vec<Point3> = vertices.iter().map(|v| v.map(|x| scale * x)).collect();
        let places = |corners: &[u32; 3]| corners.map(|v| vertices[v as usize]);
        let is_flat = |corners: &[u32; 3]| {
            let [a, b, c] = places(corners);
            is_degenerate_triangle(a, b, c)
        };
        if let Some(triangle) = triangles.iter().position(is_flat) {
            return Err(PolyhedronError::NoArea { triangle });
        }
        let faces = triangles.iter().map(|t| Face::new(t.map(|v| v as usize), places(t))).collect();
        Ok(Self { vertices, faces, scale })
    }

    /// A point in the scale of the mesh.
    pub fn local(&self, point: Point3) -> Result<Point3, CoordinateError> {
        let local = point.map(|x| self.scale * x);
        let is_near = local.iter().all(|x| x.abs() < FARTHEST);
        if is_near { Ok(local) } else { Err(CoordinateError::UndefinedInSpace { point }) }
    }

    /// The vertex at a point in that scale.
    pub fn vertex_at(&self, local: Point3) -> Option<usize> {
        self.vertices.iter().position(|&v| v == local)
    }
}
