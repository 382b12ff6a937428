//! Mean value coordinates of closed triangle meshes.

use super::CoordinateError;
use super::face_mesh::FaceMesh;
use super::face_view::{Face, Point3, Weights};
use super::real::{Jet, Real};
use super::space::PolyhedronError;
use super::spatial::SpatialCoordinates;
use super::vectors::{minus, norm, scalar_product};
use super::weighted::{balance, check_length, lagrange};

/// Where the error of a gradient by quotients, which grows with `phi / distance`, is worth another formula.
const CLOSE: f64 = 1e3;

/// Mean value coordinates of a closed triangle mesh of any shape and genus (Ju, Schaefer, Warren 2005; Floater, Kós,
/// Reimers 2005), triangles counter-clockwise as seen from outside.
///
/// The weight of a vertex is the integral of its hat function divided by the distance, over all directions. Defined in all
/// of space, smooth off the triangles, linear on each of them. Positive inside convex polyhedra and inside kernels of
/// star-shaped ones, not in others. The mesh may have several pieces and cavities; it should not cross itself.
///
/// Values and gradients hold to some `1e-13` also beside triangles, edges and vertices and in planes of far triangles, as
/// long as no triangle is thousands of times as long as wide. Gradients are given off edges and vertices; on triangles they
/// are the limits from inside.
///
/// # Complexity
/// Linear in the number of triangles; no memory is allocated for a point.
///
/// ```
/// use homeo::coordinates::{MeanValuePolyhedron, SpatialCoordinates};
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let kind = MeanValuePolyhedron::new(&corners, &triangles)?;
/// let (mut values, mut gradients) = ([0.0; 4], [[0.0; 3]; 4]);
/// kind.gradients_into([0.2, 0.3, 1e-15], &mut values, &mut gradients)?;
/// assert!((values[1] - 0.2).abs() < 1e-14 && (gradients[3][2] - 1.0).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct MeanValuePolyhedron {
    mesh: FaceMesh,
}

/// Where the sums of weights go: values alone, or with gradients.
trait Sink<T> {
    fn add(&mut self, vertex: usize, weight: T);
}

struct ValueSink<'a>(&'a mut [f64]);

impl Sink<f64> for ValueSink<'_> {
    fn add(&mut self, vertex: usize, weight: f64) {
        self.0[vertex] += weight;
    }
}

struct JetSink<'a>(&'a mut [f64], &'a mut [Point3]);

impl Sink<Jet<3>> for JetSink<'_> {
    fn add(&mut self, vertex: usize, weight: Jet<3>) {
        self.0[vertex] += weight.value;
        (0..3).for_each(|k| self.1[vertex][k] += weight.gradient[k]);
    }
}

/// What is found on the way through the triangles.
enum Seen {
    /// The point lies on edge `.1` of face `.0`.
    Edge(usize, usize),
    /// The triangle with the largest weight.
    Largest(usize),
}

impl MeanValuePolyhedron {
    /// Of a closed mesh.
    ///
    /// # Errors
    /// What is wrong with the mesh, the first thing found: an edge with other than two triangles that run along it in
    /// opposite directions, a triangle without area.
    pub fn new(vertices: &[Point3], triangles: &[[u32; 3]]) -> Result<Self, PolyhedronError> {
        Ok(Self { mesh: FaceMesh::new(vertices, triangles)? })
    }

    /// Adds up the weights of all triangles.
    fn gather<T: Real<3>>(&self, point: Point3, sink: &mut impl Sink<T>) -> Seen {
        let (mut largest, mut most) = (0, -1.0);
        for (number, face) in self.mesh.faces.iter().enumerate() {
            let view = face.view::<T>(point);
            if let Some(edge) = view.edge_under() {
                return Seen::Edge(number, edge);
            }
            let weights = match view.weights(face) {
                Weights::Low(weights) => weights.map(|w| w * view.height),
                Weights::High(weights) => weights.map(|w| w / view.divisor()),
            };
            let total = weights.iter().map(|w| w.value()).sum::<f64>().abs();
            if total > most {
                (largest, most) = (number, total);
            }
            (0..3).for_each(|i| sink.add(face.corners[i], weights[i]));
        }
        Seen::Largest(largest)
    }

    /// Values on an edge: linear.
    fn on_edge(&self, face: usize, edge: usize, point: Point3, values: &mut [f64]) -> [usize; 2] {
        let face = &self.mesh.faces[face];
        let (i, j) = ((edge + 1) % 3, (edge + 2) % 3);
        let [a, b] = [i, j].map(|k| norm(minus(face.places[k], point)));
        values.fill(0.0);
        (values[face.corners[i]], values[face.corners[j]]) = (b / (a + b), a / (a + b));
        [face.corners[i], face.corners[j]]
    }

    /// Gradients at the corners of the triangle close by, from all others: what reproduces points on it.
    fn complete(&self, face: &Face, distance: f64, values: &[f64], gradients: &mut [Point3]) {
        let is_close = |i: usize| values[face.corners[i]] > CLOSE * distance;
        let close = [0, 1, 2].map(is_close);
        match close.iter().filter(|&&c| c).count() {
            3 => {
                let share = |i: usize, y: Point3| face.share(i, y);
                self.reproduce(&[0, 1, 2].map(|i| (i, face.corners[i])), share, gradients);
            }
            2 => {
                let third = close.iter().position(|&c| !c).unwrap_or(0);
                let ends = [(third + 1) % 3, (third + 2) % 3];
                let share = |k: usize, y: Point3| {
                    let (own, other) = (face.places[ends[k]], face.places[ends[1 - k]]);
                    let slope = minus(own, other).map(|x| x / face.lengths[third].powi(2));
                    (scalar_product(slope, minus(y, other)), slope)
                };
                self.reproduce(&[0, 1].map(|k| (k, face.corners[ends[k]])), share, gradients);
            }
            _ => {}
        }
    }

    /// `grad phi_a = grad lambda_a - sum of lambda_a(v_j) grad phi_j` over all other vertices.
    fn reproduce(
        &self,
        dominant: &[(usize, usize)],
        share: impl Fn(usize, Point3) -> (f64, Point3),
        gradients: &mut [Point3],
    ) {
        for &(number, vertex) in dominant {
            let (_, mut sum) = share(number, self.mesh.vertices[vertex]);
            for (j, &place) in self.mesh.vertices.iter().enumerate() {
                if dominant.iter().all(|&(_, v)| v != j) {
                    let (lambda, _) = share(number, place);
                    (0..3).for_each(|k| sum[k] -= lambda * gradients[j][k]);
                }
            }
            gradients[vertex] = sum;
        }
    }
}

impl SpatialCoordinates for MeanValuePolyhedron {
    fn vertex_count(&self) -> usize {
        self.mesh.vertices.len()
    }

    fn values_into(&self, point: Point3, values: &mut [f64]) -> Result<(), CoordinateError> {
        check_length(self.mesh.vertices.len(), values.len())?;
        let local = self.mesh.local(point)?;
        if let Some(vertex) = self.mesh.vertex_at(local) {
            lagrange(vertex, values);
            return Ok(());
        }
        values.fill(0.0);
        if let Seen::Edge(face, edge) = self.gather::<f64>(local, &mut ValueSink(values)) {
            self.on_edge(face, edge, local, values);
            return Ok(());
        }
        let total = checked(values.iter().sum(), point)?;
        values.iter_mut().for_each(|value| *value /= total);
        Ok(())
    }

    fn gradients_into(
        &self,
        point: Point3,
        values: &mut [f64],
        gradients: &mut [Point3],
    ) -> Result<(), CoordinateError> {
        check_length(self.mesh.vertices.len(), values.len())?;
        check_length(self.mesh.vertices.len(), gradients.len())?;
        let local = self.mesh.local(point)?;
        if let Some(vertex) = self.mesh.vertex_at(local) {
            return Err(CoordinateError::NoGradient { vertex });
        }
        values.fill(0.0);
        gradients.fill([0.0; 3]);
        let face = match self.gather::<Jet<3>>(local, &mut JetSink(values, gradients)) {
            Seen::Edge(face, edge) => {
                let [a, b] = self.on_edge(face, edge, local, values);
                return Err(CoordinateError::NoGradientOnEdge { from: a.min(b), to: a.max(b) });
            }
            Seen::Largest(face) => &self.mesh.faces[face],
        };
        let total = checked(values.iter().sum(), point)?;
        let sum: Point3 = std::array::from_fn(|k| gradients.iter().map(|g| g[k]).sum::<f64>() / total);
        let mut largest = 0;
        for (i, value) in values.iter_mut().enumerate() {
            *value /= total;
            gradients[i] = std::array::from_fn(|k| gradients[i][k] / total - *value * sum[k]);
        }
        for (i, value) in values.iter().enumerate() {
            largest = if value.abs() > values[largest].abs() { i } else { largest };
        }
        balance(largest, gradients);
        // Beside a triangle the sum of weights is that of a half sphere, divided by the distance.
        self.complete(face, std::f64::consts::PI / total.abs(), values, gradients);
        gradients.iter_mut().flatten().for_each(|g| *g *= self.mesh.scale);
        Ok(())
    }
}

fn checked(total: f64, point: Point3) -> Result<f64, CoordinateError> {
    if total != 0.0 && total.is_finite() { Ok(total) } else { Err(CoordinateError::UndefinedInSpace { point }) }
}
