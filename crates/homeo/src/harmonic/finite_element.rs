//! Linear finite elements, for comparison (section 5.1.1).

use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::spatial::{Aabb, Tree};

use super::condition::BoundaryData;
use super::{HarmonicFunctionError, HarmonicFunctions, check_length};
use crate::construct::harmonic::{Laplace, Triangulated, Weights};
use crate::progress::Silent;

/// Functions that are linear in the triangles of a constrained Delaunay triangulation, with cotangent weights: those of
/// [`harmonic_map`](crate::construct::harmonic::harmonic_map).
///
/// Given values are met at vertices on the boundary, and linear between them. The gradient is that of a triangle that
/// holds the point.
///
/// # Complexity
/// A sparse factorization; a point is found in a tree.
///
/// ```
/// use homeo::harmonic::{BoundaryData, FiniteElements, HarmonicFunctions, Profile};
/// use homeo_core::planar::PlanarDomain;
/// let square = PlanarDomain::new(vec![vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]])?;
/// let data = BoundaryData::new(&[[0.0], [2.0], [2.0], [0.0]], Profile::Linear)?;
/// let functions = FiniteElements::new(&square, &data, 500)?;
/// let (mut value, mut gradient) = ([0.0], [[0.0; 2]]);
/// functions.gradients_into([0.3, 1.9], &mut value, &mut gradient)?;
/// assert!((value[0] - 0.3).abs() < 1e-5 && (gradient[0][0] - 1.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct FiniteElements {
    domain: PlanarDomain,
    positions: Vec<Point2>,
    triangles: Vec<[u32; 3]>,
    tree: Tree,
    functions: usize,
    /// Vertex by vertex, all functions.
    values: Vec<f64>,
    unknowns: usize,
}

/// Boxes are looked up with so much room, as a share of the diagonal: points on edges are rounded.
const ROOM: f64 = 1e-12;

impl FiniteElements {
    /// Triangulates the domain, with about so many triangles, and solves.
    ///
    /// # Errors
    /// There is not one row of values for each vertex, or the domain cannot be triangulated.
    pub fn new(domain: &PlanarDomain, data: &BoundaryData, triangles: usize) -> Result<Self, HarmonicFunctionError> {
        data.check(domain.vertex_count())?;
        let failed =
            |error: crate::construct::harmonic::HarmonicError| HarmonicFunctionError::Triangulation(error.to_string());
        let mesh = Triangulated::new(domain, triangles, false, &Silent).map_err(failed)?;
        let known = mesh.boundary.len();
        let laplace =
            Laplace::new(&mesh.positions, known, mesh.triangles(), &[], Weights::Cotangent).map_err(failed)?;
        let firsts: Vec<usize> =
            domain.rings().iter().scan(0, |sum, ring| Some(std::mem::replace(sum, *sum + ring.len()))).collect();
        let mut values = vec![0.0; mesh.positions.len() * data.functions];
        for pair in 0..data.functions.div_ceil(2) {
            let both = [2 * pair, (2 * pair + 1).min(data.functions - 1)];
            let fixed: Vec<Point2> = mesh
                .boundary
                .iter()
                .map(|point| {
                    let (first, n) = (firsts[point.ring as usize], domain.rings()[point.ring as usize].len());
                    let ends = [point.edge as usize, (point.edge as usize + 1) % n].map(|v| data.at_vertex(first + v));
                    let gone = data.profile.at(point.fraction());
                    both.map(|f| ends[0][f] * (1.0 - gone) + ends[1][f] * gone)
                })
                .collect();
            for (vertex, image) in fixed.iter().copied().chain(laplace.solve(&fixed)).enumerate() {
                both.into_iter().zip(image).for_each(|(f, x)| values[vertex * data.functions + f] = x);
            }
        }
        let boxes: Vec<Aabb> = mesh
            .triangles()
            .iter()
            .map(|t| Aabb::of(&t.map(|v| mesh.positions[v as usize]).map(|[x, y]| [x, y, 0.0])))
            .collect();
        Ok(Self {
            domain: domain.clone(),
            triangles: mesh.triangles().to_vec(),
            tree: Tree::new(&boxes),
            functions: data.functions,
            values,
            unknowns: mesh.positions.len() - known,
            positions: mesh.positions,
        })
    }

    /// How many unknowns each function has: one for each inner vertex.
    pub fn unknown_count(&self) -> usize {
        self.unknowns
    }

    /// The triangle that holds a point, or does so but for rounding, and the point's barycentric coordinates there.
    fn find(&self, point: Point2) -> Result<([u32; 3], [f64; 3]), HarmonicFunctionError> {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(HarmonicFunctionError::NotFinite { point });
        }
        if !self.domain.contains(point) {
            return Err(HarmonicFunctionError::Outside { point });
        }
        let room = ROOM * self.domain.diagonal();
        let region =
            Aabb { low: [point[0] - room, point[1] - room, 0.0], high: [point[0] + room, point[1] + room, 0.0] };
        let mut best: Option<(f64, [u32; 3], [f64; 3])> = None;
        self.tree.query_box(&region, |t| {
            let weights = self.weights(self.triangles[t], point);
            let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
            if best.is_none_or(|(known, ..)| least > known) {
                best = Some((least, self.triangles[t], weights));
            }
        });
        best.map(|(_, corners, weights)| (corners, weights)).ok_or(HarmonicFunctionError::Outside { point })
    }

    fn weights(&self, corners: [u32; 3], x: Point2) -> [f64; 3] {
        let [a, b, c] = corners.map(|v| self.positions[v as usize]);
        let cross = |p: Point2, q: Point2, r: Point2| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let area = cross(a, b, c);
        [cross(x, b, c) / area, cross(a, x, c) / area, cross(a, b, x) / area]
    }
}

impl HarmonicFunctions for FiniteElements {
    fn function_count(&self) -> usize {
        self.functions
    }

    fn values_into(&self, point: Point2, values: &mut [f64]) -> Result<(), HarmonicFunctionError> {
        check_length(values.len(), self.functions)?;
        let (corners, weights) = self.find(point)?;
        for (f, value) in values.iter_mut().enumerate() {
            *value = (0..3).map(|k| weights[k] * self.values[corners[k] as usize * self.functions + f]).sum();
        }
        Ok(())
    }

    fn gradients_into(
        &self,
        point: Point2,
        values: &mut [f64],
        gradients: &mut [Point2],
    ) -> Result<(), HarmonicFunctionError> {
        check_length(gradients.len(), self.functions)?;
        self.values_into(point, values)?;
        let (corners, _) = self.find(point)?;
        let [a, b, c] = corners.map(|v| self.positions[v as usize]);
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let area = u[0] * v[1] - u[1] * v[0];
        for (f, gradient) in gradients.iter_mut().enumerate() {
            let at = |k: usize| self.values[corners[k] as usize * self.functions + f];
            let (p, q) = (at(1) - at(0), at(2) - at(0));
            *gradient = [(p * v[1] - q * u[1]) / area, (q * u[0] - p * v[0]) / area];
        }
        Ok(())
    }
}
