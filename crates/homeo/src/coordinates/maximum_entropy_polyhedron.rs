//! Maximum entropy coordinates of polyhedra.
//!
//! As in the plane: `phi_i = m_i exp(-lambda . s_i) / Z`, `lambda` the minimum of the convex function `ln Z`. The prior of a
//! vertex is `m_i = 1 / prod rho_T` over the triangles at it, with `rho_T` what the areas of the triangles from the point to
//! the edges of `T` exceed that of `T` by: positive, and zero on `T` only. All is done in the frame of the closest triangle,
//! whose corners have the same height there to the last bit.

use super::CoordinateError;
use super::face_mesh::FaceMesh;
use super::face_view::{Face, Point3};
use super::real::{Jet, Real};
use super::space::PolyhedronError;
use super::spatial::SpatialCoordinates;
use super::vectors::{minus, scalar_product, vector_product};
use super::weighted::{balance, check_length, lagrange};

/// Steps of Newton's method before giving up.
const MOST_STEPS: usize = 500;

/// Closer to a triangle than this share of the diagonal coordinates are those of its closest point, up to rounding.
const ON_FACE: f64 = 1e-15;

/// Maximum entropy coordinates (Hormann, Sukumar 2008) of a closed triangle mesh of any shape and genus, with priors from the
/// triangles. The source has priors from edges of polygons; these are their counterpart.
///
/// Positive inside, linear on triangles, Lagrange. Smooth off the lines through edges, across which priors have kinks.
/// Gradients are given inside, not on the boundary. Points outside that lie in the convex hull of the vertices get
/// coordinates, too; others do not converge.
///
/// # Complexity
/// Each step takes #V exponentials; some ten steps for a point, more close to edges and vertices.
///
/// ```
/// use homeo::coordinates::{MaximumEntropyPolyhedron, SpatialCoordinates};
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let kind = MaximumEntropyPolyhedron::new(&corners, &triangles)?;
/// let mut values = [0.0; 4];
/// kind.values_into([0.2, 0.3, 0.1], &mut values)?;
/// assert!((values[1] - 0.2).abs() < 1e-14 && (values[0] - 0.4).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct MaximumEntropyPolyhedron {
    mesh: FaceMesh,
}

/// What is minimised at one point: logarithms of priors and vectors to the vertices.
struct Problem {
    priors: Vec<f64>,
    places: Vec<Point3>,
}

/// The state at one `lambda`: coordinates, `ln Z`, their mean place and the covariance of places.
struct State {
    values: Vec<f64>,
    potential: f64,
    mean: Point3,
    covariance: [Point3; 3],
}

impl MaximumEntropyPolyhedron {
    /// Of a closed mesh.
    ///
    /// # Errors
    /// What is wrong with the mesh, the first thing found, as for mean value coordinates.
    pub fn new(vertices: &[Point3], triangles: &[[u32; 3]]) -> Result<Self, PolyhedronError> {
        Ok(Self { mesh: FaceMesh::new(vertices, triangles)? })
    }

    /// Logarithms of priors up to a common summand, the closest triangle and the height over it.
    fn priors<T: Real<3>>(&self, local: Point3) -> (Vec<T>, usize, f64) {
        let mut priors = vec![T::constant(0.0); self.mesh.vertices.len()];
        let (mut closest, mut least, mut height) = (0, f64::INFINITY, 0.0);
        for (number, face) in self.mesh.faces.iter().enumerate() {
            let view = face.view::<T>(local);
            let excess = view.excess();
            if excess.value() < least {
                (closest, least, height) = (number, excess.value(), view.height.value());
            }
            let logarithm = excess.ln();
            face.corners.iter().for_each(|&v| priors[v] = priors[v] - logarithm);
        }
        (priors, closest, height)
    }

    /// Linear values on a triangle that the point lies on.
    fn on_face(&self, face: &Face, local: Point3, height: f64, values: &mut [f64]) -> bool {
        let shares = [0, 1, 2].map(|i| face.share(i, local).0);
        let is_on = height.abs() < ON_FACE && shares.iter().all(|&s| s > -ON_FACE);
        if is_on {
            values.fill(0.0);
            (0..3).for_each(|i| values[face.corners[i]] = shares[i].max(0.0));
        }
        is_on
    }

    /// Two axes in the plane of a triangle, and its normal.
    fn frame(face: &Face) -> [Point3; 3] {
        [face.outer[0], vector_product(face.normal, face.outer[0]), face.normal]
    }

    fn problem<T: Real<3>>(&self, priors: &[T], face: &Face, height: f64, local: Point3) -> Problem {
        let frame = Self::frame(face);
        let place = |(v, vertex): (usize, &Point3)| {
            let offset = minus(*vertex, local);
            let [a, b, c] = frame.map(|axis| scalar_product(axis, offset));
            [a, b, if face.corners.contains(&v) { height } else { c }]
        };
        let places = self.mesh.vertices.iter().enumerate().map(place).collect();
        Problem { priors: priors.iter().map(|p| p.value()).collect(), places }
    }
}

impl Problem {
    fn state(&self, lambda: Point3) -> State {
        let exponent = |(prior, y): (&f64, &Point3)| prior - scalar_product(lambda, *y);
        let mut values: Vec<f64> = self.priors.iter().zip(&self.places).map(exponent).collect();
        let most = values.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
        values.iter_mut().for_each(|v| *v = (*v - most).exp());
        let total: f64 = values.iter().sum();
        values.iter_mut().for_each(|v| *v /= total);
        let all = || values.iter().zip(&self.places);
        let mean = [0, 1, 2].map(|k| all().map(|(v, y)| v * y[k]).sum::<f64>());
        // About the mean, not by the difference of squares: it may be far smaller.
        let product = |k: usize, l: usize| all().map(|(v, y)| v * (y[k] - mean[k]) * (y[l] - mean[l])).sum::<f64>();
        let covariance = [0, 1, 2].map(|k| [0, 1, 2].map(|l| product(k, l)));
        State { values, potential: most + total.ln(), mean, covariance }
    }

    /// The state whose mean place is the point; none where Newton's method does not get there.
    fn minimum(&self) -> Option<State> {
        let mut lambda = [0.0, 0.0, self.across()?];
        let mut state = self.state(lambda);
        let mut last = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let step = solve(&state.covariance, state.mean)?;
            let largest = self.places.iter().map(|y| scalar_product(*y, step).abs()).fold(0.0, f64::max);
            let slope = scalar_product(step, state.mean);
            let mut share = 1.0;
            loop {
                let tried = [0, 1, 2].map(|k| lambda[k] + share * step[k]);
                let next = self.state(tried);
                // Short steps are safe for exponentials; long ones must gain.
                if share * largest < 0.5 || next.potential <= state.potential - 1e-4 * share * slope {
                    (lambda, state) = (tried, next);
                    break;
                }
                share *= 0.5;
            }
            if largest < 1e-9 || (largest < 1e-4 && largest > 0.5 * last) {
                return Some(state);
            }
            last = largest;
        }
        None
    }

    /// The third part of `lambda` at which the mean height vanishes while the others are zero: beside a triangle it grows
    /// as the logarithm of the distance. It decreases steadily: bisection.
    fn across(&self) -> Option<f64> {
        let height = |mu: f64| self.state([0.0, 0.0, mu]).mean[2];
        let sign = if height(0.0) > 0.0 { 1.0 } else { -1.0 };
        let (mut low, mut high) = (0.0, 1.0);
        while sign * height(sign * high) > 0.0 {
            (low, high) = (high, 2.0 * high);
            if high > 1e12 {
                return None;
            }
        }
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            if sign * height(sign * middle) > 0.0 { low = middle } else { high = middle }
        }
        Some(sign * 0.5 * (low + high))
    }

    /// Gradients of the coordinates at the minimum, from those of the logarithms of priors: the constraint differentiated.
    fn gradients(&self, state: &State, slopes: &[Point3], gradients: &mut [Point3]) -> Option<()> {
        for axis in 0..3 {
            let (mut mean, mut moment) = (0.0, [0.0; 3]);
            for ((v, slope), y) in state.values.iter().zip(slopes).zip(&self.places) {
                mean += v * slope[axis];
                (0..3).for_each(|k| moment[k] += v * slope[axis] * y[k]);
            }
            moment[axis] -= 1.0;
            let step = solve(&state.covariance, moment)?;
            for (i, y) in self.places.iter().enumerate() {
                gradients[i][axis] = state.values[i] * (slopes[i][axis] - mean - scalar_product(step, *y));
            }
        }
        Some(())
    }
}

/// Solves a symmetric positive system of three equations, by Cholesky's method: rows may be of very different sizes.
fn solve(a: &[Point3; 3], b: Point3) -> Option<Point3> {
    let l00 = a[0][0].sqrt();
    let (l10, l20) = (a[1][0] / l00, a[2][0] / l00);
    let l11 = (a[1][1] - l10 * l10).sqrt();
    let l21 = (a[2][1] - l20 * l10) / l11;
    let l22 = (a[2][2] - l20 * l20 - l21 * l21).sqrt();
    let y0 = b[0] / l00;
    let y1 = (b[1] - l10 * y0) / l11;
    let y2 = (b[2] - l20 * y0 - l21 * y1) / l22;
    let x2 = y2 / l22;
    let x1 = (y1 - l21 * x2) / l11;
    let x0 = (y0 - l10 * x1 - l20 * x2) / l00;
    [x0, x1, x2].iter().all(|x| x.is_finite()).then_some([x0, x1, x2])
}

impl SpatialCoordinates for MaximumEntropyPolyhedron {
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
        let (priors, closest, height) = self.priors::<f64>(local);
        let face = &self.mesh.faces[closest];
        if self.on_face(face, local, height, values) {
            return Ok(());
        }
        let state = self.problem(&priors, face, height, local).minimum();
        let state = state.ok_or(CoordinateError::NotConvergedInSpace { point, steps: MOST_STEPS })?;
        values.copy_from_slice(&state.values);
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
        let (priors, closest, height) = self.priors::<Jet<3>>(local);
        let face = &self.mesh.faces[closest];
        if self.on_face(face, local, height, values) {
            return Err(CoordinateError::UndefinedInSpace { point });
        }
        let problem = self.problem(&priors, face, height, local);
        let failed = || CoordinateError::NotConvergedInSpace { point, steps: MOST_STEPS };
        let state = problem.minimum().ok_or_else(failed)?;
        let frame = Self::frame(face);
        let slopes: Vec<Point3> = priors.iter().map(|p| frame.map(|axis| scalar_product(axis, p.gradient))).collect();
        problem.gradients(&state, &slopes, gradients).ok_or_else(failed)?;
        for gradient in gradients.iter_mut() {
            let turned = *gradient;
            let back = |k: usize| (0..3).map(|m| frame[m][k] * turned[m]).sum::<f64>();
            *gradient = [0, 1, 2].map(|k| self.mesh.scale * back(k));
        }
        values.copy_from_slice(&state.values);
        let largest = (0..values.len()).fold(0, |best, i| if values[i] > values[best] { i } else { best });
        balance(largest, gradients);
        Ok(())
    }
}
