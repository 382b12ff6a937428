//! Where the vertices of a half lie, and their images.

use homeo_core::number::Scalar;
use homeo_core::planar::Point2;

use super::half::{HalfParts, Side};
use super::middle::{Middle, between};

/// The numbers of a half, with what follows from them.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub parts: HalfParts,
    /// The domain's vertices along its rings, or along the circuit.
    outline: Vec<Vec<Point2>>,
    /// For each point of the boundary its place, if inside a seam.
    on_seams: Vec<Option<Point2>>,
}

impl Layout {
    /// Where the sides of a seam do not list the same points, these are put on straight lines: rule H6 refutes them.
    pub fn new(parts: HalfParts, middle: &Middle) -> Self {
        let (outline, on_seams) = match middle.circuit() {
            None => (parts.domain.rings().to_vec(), Vec::new()),
            Some(circuit) => (
                vec![circuit.outline(&parts.domain)],
                circuit.places(&parts.boundary, &parts.seam_points).unwrap_or_default(),
            ),
        };
        Self { parts, outline, on_seams }
    }

    /// Where a vertex lies in the domain.
    pub fn position<T: Scalar>(&self, vertex: u32) -> [T; 2] {
        let Some(point) = self.parts.boundary.get(vertex as usize) else {
            return self.parts.inner[vertex as usize - self.parts.boundary.len()].map(T::from_f64);
        };
        if let Some(Some(place)) = self.on_seams.get(vertex as usize) {
            return place.map(T::from_f64);
        }
        let ring = &self.outline[point.ring as usize];
        let ends = [ring[point.edge as usize], ring[(point.edge as usize + 1) % ring.len()]];
        between(&ends.map(|end| end.map(T::from_f64)), point.share)
    }

    /// The corners of a triangle, or of its image.
    pub fn corners<T: Scalar>(&self, middle: &Middle, side: Side, triangle: usize) -> [[T; 2]; 3] {
        let parts = &self.parts;
        let vertices = parts.triangles[triangle];
        if side == Side::Domain {
            return vertices.map(|v| self.position(v));
        }
        std::array::from_fn(|corner| {
            let vertex = vertices[corner] as usize;
            let mut image: [T; 2] = match parts.boundary.get(vertex) {
                Some(point) => between(&middle.edge(point.ring as usize, point.edge as usize), point.share),
                None => parts.images[vertex - parts.boundary.len()].map(T::from_f64),
            };
            if middle.is_cylinder() {
                image[0] = image[0].plus(&T::from_f64(f64::from(parts.shifts[triangle][corner])));
            }
            image
        })
    }
}
