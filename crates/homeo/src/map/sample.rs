//! Samples of a map for pictures and statistics: images of vertices, leaves as polylines, distortion.
//! Sampled, not certified.

use homeo_core::mesh::{CellId, Facet};
use rayon::prelude::*;

use super::exact::{ExactLocation, Sense};
use super::fast::{FastLeaf, Undecided};
use super::locate::FloatLocation;
use super::{Bijection, Foliation};
use dashu_int::IBig;

/// A leaf as polylines in the mesh and in the target (round, for disk and ball).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafPolyline {
    /// Points in the mesh, from the source region to the sink region.
    pub source: Vec<[f64; 3]>,
    /// The images of the two ends; the image of the leaf is the segment between them.
    pub target: [[f64; 3]; 2],
}

impl<const K: usize> Foliation<K> {
    /// Images of all vertices of the foliated mesh, `#V by 3`, in `f64` (round form for disk and ball).
    ///
    /// Vertices that no cell names get the image of nothing: NaN.
    ///
    /// # Complexity
    /// One leaf for each vertex, in parallel.
    pub fn vertex_images(&self) -> Vec<[f64; 3]> {
        let complex = self.parts().mesh.complex();
        let mut corner = vec![None; complex.vertex_count()];
        for cell in complex.cell_ids() {
            for (local, vertex) in complex.cell(cell).iter().enumerate() {
                corner[vertex.index()].get_or_insert((cell, local));
            }
        }
        corner
            .par_iter()
            .map(|at| at.map_or([f64::NAN; 3], |(cell, local)| self.image_of_corner(cell, local)))
            .collect()
    }

    fn image_of_corner(&self, cell: CellId, local: usize) -> [f64; 3] {
        let weights = std::array::from_fn(|k| f64::from(u8::from(k == local)));
        if !self.is_centre(cell) {
            let at = FloatLocation { cell, weights, errors: [0.0; K], is_exact: true };
            if let Ok(enclosed) = self.fast_image(&at) {
                return enclosed.point;
            }
        }
        let weights = std::array::from_fn(|k| IBig::from(u8::from(k == local)));
        self.rounded_image(&self.image_exact(&ExactLocation { cell, weights })).point
    }

    /// The leaf through the centroid of a cell; `None` for the centre and where rounding is in doubt.
    pub fn leaf_through(&self, cell: CellId) -> Option<LeafPolyline> {
        if self.is_centre(cell) {
            return None;
        }
        let weights = [1.0 / K as f64; K];
        let at = FloatLocation { cell, weights, errors: [f64::EPSILON; K], is_exact: true };
        let (mut back, start) = self.polyline(&at, Sense::Backward).ok()?;
        let (ahead, end) = self.polyline(&at, Sense::Forward).ok()?;
        back.reverse();
        back.extend(ahead.into_iter().skip(1));
        let ends = [start, end].map(|at| self.forward(at).map(|image| image.point));
        let [Ok(first), Ok(last)] = ends else { return None };
        Some(LeafPolyline { source: back, target: [first, last] })
    }

    /// Points of a leaf where it crosses facets, and the last of them.
    #[allow(clippy::type_complexity)]
    fn polyline(&self, at: &FloatLocation<K>, sense: Sense) -> Result<(Vec<[f64; 3]>, [f64; 3]), Undecided> {
        let mut leaf = FastLeaf::new(self, at);
        let mut points = vec![self.point(leaf.cell(self), &leaf.weights)];
        loop {
            let step = self.steps.at(leaf.slot);
            let i = leaf.exit(step, sense)?;
            leaf.move_to(step, i)?;
            let point = self.point(leaf.cell(self), &leaf.weights);
            points.push(point);
            let end: Option<Facet> = leaf.cross(step, i);
            if end.is_some() {
                return Ok((points, point));
            }
        }
    }

    fn point(&self, cell: CellId, weights: &[f64; K]) -> [f64; 3] {
        let corners = self.parts().mesh.complex().cell(cell).map(|v| self.parts().mesh.positions()[v.index()]);
        std::array::from_fn(|axis| (0..K).map(|k| weights[k] * corners[k][axis]).sum())
    }
}

/// Below this ratio of stretches rounding leaves nothing of the smaller one: the image counts as flat.
const FLAT: f64 = 1e-15;

/// Ratio of the largest to the smallest stretch of the linear map that takes the corners of each cell
/// to the given images; infinite where the image is flat.
pub fn distortions<const K: usize>(
    cells: &[[homeo_core::mesh::VertexId; K]],
    positions: &[[f64; 3]],
    images: &[[f64; 3]],
) -> Vec<f64> {
    cells
        .par_iter()
        .map(|cell| distortion(cell.map(|v| positions[v.index()]), cell.map(|v| images[v.index()])))
        .collect()
}

type Vector = [f64; 3];

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn distortion<const K: usize>(source: [Vector; K], image: [Vector; K]) -> f64 {
    // An orthonormal frame of the source cell, by Gram and Schmidt.
    let mut frame = [[0.0; 3]; 3];
    let mut coordinates = [[0.0; 3]; 3];
    for i in 0..K - 1 {
        let mut rest = minus(source[i + 1], source[0]);
        for j in 0..i {
            coordinates[i][j] = dot(rest, frame[j]);
            (0..3).for_each(|axis| rest[axis] -= coordinates[i][j] * frame[j][axis]);
        }
        coordinates[i][i] = dot(rest, rest).sqrt();
        frame[i] = rest.map(|x| x / coordinates[i][i]);
    }
    // Columns of the linear map in that frame, by forward substitution.
    let mut columns = [[0.0; 3]; 3];
    for i in 0..K - 1 {
        let mut value = minus(image[i + 1], image[0]);
        for j in 0..i {
            (0..3).for_each(|axis| value[axis] -= coordinates[i][j] * columns[j][axis]);
        }
        columns[i] = value.map(|x| x / coordinates[i][i]);
    }
    let values = singular_values::<K>(columns);
    if values[1] > FLAT * values[0] { values[0] / values[1] } else { f64::INFINITY }
}

/// Largest and smallest singular value of a matrix with `K - 1` columns (Jacobi rotations on the columns).
fn singular_values<const K: usize>(mut columns: [Vector; 3]) -> [f64; 2] {
    for _ in 0..30 {
        let mut turned = false;
        for i in 0..K - 1 {
            for j in i + 1..K - 1 {
                let (a, b, c) = (dot(columns[i], columns[i]), dot(columns[j], columns[j]), dot(columns[i], columns[j]));
                if c.abs() <= 1e-15 * (a * b).sqrt() || c == 0.0 {
                    continue;
                }
                turned = true;
                let zeta = (b - a) / (2.0 * c);
                let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
                let cosine = 1.0 / (1.0 + t * t).sqrt();
                for axis in 0..3 {
                    let (x, y) = (columns[i][axis], columns[j][axis]);
                    columns[i][axis] = cosine * (x - t * y);
                    columns[j][axis] = cosine * (t * x + y);
                }
            }
        }
        if !turned {
            break;
        }
    }
    let sizes = columns[..K - 1].iter().map(|&c| dot(c, c).sqrt());
    [sizes.clone().fold(0.0, f64::max), sizes.fold(f64::INFINITY, f64::min)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distortion_of_a_stretch_is_its_ratio() {
        let source = [[0.0; 3], [1.0, 0.0, 0.0], [0.3, 1.0, 0.0], [0.2, 0.1, 1.0]];
        let image = source.map(|[x, y, z]| [2.0 * y, 6.0 * x, 3.0 * z]);
        assert!((distortion(source, image) - 3.0).abs() < 1e-12);
        let flat = source.map(|[x, y, _]| [x, y, 0.0]);
        assert!(distortion(source, flat) > 1e12);
    }
}
