//! Complex coordinates: those of Cauchy and of Green.
//!
//! Both come from integrals over edges. With `b`, `b'` the ends of an edge less the point, `a = b' - b` and
//! `l = ln(b' / b)`, Cauchy's integral of the linear function that is 1 at the second end is `1 - (b / a) l`, of the other
//! `(b' / a) l - 1`, over `2 pi i`; Green's coordinates of vertices are the real parts of their sums.

use homeo_core::planar::PlanarDomain;
use std::f64::consts::TAU;
use std::ops::{Add, Div, Mul, Sub};

use super::CoordinateError;
use super::weighted::check_length;

/// A complex number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex {
    /// Its real part.
    pub re: f64,
    /// Its imaginary part.
    pub im: f64,
}

impl Complex {
    /// Of a point of the plane.
    pub fn new([re, im]: [f64; 2]) -> Self {
        Self { re, im }
    }

    /// Its absolute value.
    pub fn size(self) -> f64 {
        self.re.hypot(self.im)
    }

    fn ln(self) -> Self {
        Self { re: self.size().ln(), im: self.im.atan2(self.re) }
    }

    fn times(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self { re: self.re + b.re, im: self.im + b.im }
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self { re: self.re - b.re, im: self.im - b.im }
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self { re: self.re * b.re - self.im * b.im, im: self.re * b.im + self.im * b.re }
    }
}

impl Div for Complex {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let square = b.re * b.re + b.im * b.im;
        Self { re: (self.re * b.re + self.im * b.im) / square, im: (self.im * b.re - self.re * b.im) / square }
    }
}

/// Cauchy coordinates (Weber, Ben-Chen, Gotsman 2009): the holomorphic functions `sum_i c_i(z) w_i` that Cauchy's
/// integral makes of the polygon with vertices `w_i`.
///
/// They sum to 1 and reproduce the point, but do not interpolate: not Lagrange, not linear on edges. Defined inside.
///
/// # Complexity
/// Linear in #V: one logarithm for each edge.
///
/// ```
/// use homeo::coordinates::{Cauchy, Complex};
/// use homeo_core::planar::PlanarDomain;
/// let ring = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let kind = Cauchy::new(&PlanarDomain::new(vec![ring])?);
/// let (mut values, mut derivatives) = ([Complex::default(); 4], [Complex::default(); 4]);
/// kind.derivatives_into([0.3, 0.4], &mut values, &mut derivatives)?;
/// let sum = values.iter().fold(Complex::default(), |a, &b| a + b);
/// assert!((sum - Complex::new([1.0, 0.0])).size() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Cauchy {
    edges: Vec<Edge>,
    domain: PlanarDomain,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    ends: [usize; 2],
    from: Complex,
    to: Complex,
}

/// What an edge gives to its two ends, and by how much that grows.
struct Shares {
    values: [Complex; 2],
    derivatives: [Complex; 2],
    /// `l / a`, and `l b' / a`.
    logarithms: [Complex; 2],
}

impl Edge {
    fn shares(&self, z: Complex) -> Shares {
        let (b, c, a) = (self.from - z, self.to - z, self.to - self.from);
        let one = Complex { re: 1.0, im: 0.0 };
        let slope = (c / b).ln() / a;
        let values = [c * slope - one, one - b * slope];
        Shares { values, derivatives: [one / b - slope, slope - one / c], logarithms: [slope, c * slope] }
    }
}

impl Cauchy {
    /// Of all rings of a domain.
    pub fn new(domain: &PlanarDomain) -> Self {
        let mut edges = Vec::new();
        let mut begin = 0;
        for ring in domain.rings() {
            for i in 0..ring.len() {
                let j = (i + 1) % ring.len();
                let [from, to] = [ring[i], ring[j]].map(Complex::new);
                edges.push(Edge { ends: [begin + i, begin + j], from, to });
            }
            begin += ring.len();
        }
        Self { edges, domain: domain.clone() }
    }

    /// How many vertices there are: #V.
    pub fn vertex_count(&self) -> usize {
        self.edges.len()
    }

    /// Values (#V) and complex derivatives (#V) at a point inside.
    ///
    /// # Errors
    /// The point is outside, on the boundary or not finite; a buffer has the wrong length.
    pub fn derivatives_into(
        &self,
        point: [f64; 2],
        values: &mut [Complex],
        derivatives: &mut [Complex],
    ) -> Result<(), CoordinateError> {
        check_length(self.edges.len(), values.len())?;
        check_length(self.edges.len(), derivatives.len())?;
        self.check_inside(point)?;
        values.fill(Complex::default());
        derivatives.fill(Complex::default());
        // 1 / (2 pi i)
        let factor = Complex { re: 0.0, im: -1.0 / TAU };
        for edge in &self.edges {
            let shares = edge.shares(Complex::new(point));
            for (k, &end) in edge.ends.iter().enumerate() {
                values[end] = values[end] + shares.values[k] * factor;
                derivatives[end] = derivatives[end] + shares.derivatives[k] * factor;
            }
        }
        check_finite(point, values.iter().chain(&*derivatives))
    }

    fn check_inside(&self, point: [f64; 2]) -> Result<(), CoordinateError> {
        match (point.iter().all(|x| x.is_finite()), self.domain.contains(point)) {
            (false, _) => Err(CoordinateError::NotFinite { point }),
            (_, false) => Err(CoordinateError::Undefined { point }),
            _ => Ok(()),
        }
    }
}

/// Green coordinates (Lipman, Levin, Cohen-Or 2008): `sum_i phi_i v_i + sum_j psi_j n_j`, with one coordinate for each
/// vertex and one for the outer unit normal of each edge.
///
/// Deformed vertices `w_i` and normals, those scaled by how much their edges are stretched, give conformal maps. The
/// `phi_i` sum to 1; the point is reproduced by both together. Defined inside.
///
/// # Complexity
/// Linear in #V: one logarithm for each edge.
///
/// ```
/// use homeo::coordinates::Green;
/// use homeo_core::planar::PlanarDomain;
/// let ring = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let kind = Green::new(&PlanarDomain::new(vec![ring])?);
/// let (mut vertices, mut edges) = ([0.0; 4], [0.0; 4]);
/// kind.values_into([0.5, 0.5], &mut vertices, &mut edges)?;
/// assert!((vertices[0] - 0.25).abs() < 1e-15 && (edges[0] - edges[2]).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Green(Cauchy);

impl Green {
    /// Of all rings of a domain.
    pub fn new(domain: &PlanarDomain) -> Self {
        Self(Cauchy::new(domain))
    }

    /// Values at a point inside, of vertices (#V) and of edges (#V).
    ///
    /// # Errors
    /// The point is outside, on the boundary or not finite; a buffer has the wrong length.
    pub fn values_into(&self, point: [f64; 2], vertices: &mut [f64], edges: &mut [f64]) -> Result<(), CoordinateError> {
        let mut gradients = vec![[0.0; 2]; 2 * vertices.len()];
        let (of_vertices, of_edges) = gradients.split_at_mut(vertices.len());
        self.gradients_into(point, vertices, edges, of_vertices, of_edges)
    }

    /// Values (#V and #V) and gradients (#V by 2 and #V by 2) at a point inside, of vertices and of edges.
    ///
    /// # Errors
    /// As for the values.
    pub fn gradients_into(
        &self,
        point: [f64; 2],
        vertices: &mut [f64],
        edges: &mut [f64],
        vertex_gradients: &mut [[f64; 2]],
        edge_gradients: &mut [[f64; 2]],
    ) -> Result<(), CoordinateError> {
        let n = self.0.edges.len();
        for found in [vertices.len(), edges.len(), vertex_gradients.len(), edge_gradients.len()] {
            check_length(n, found)?;
        }
        let (mut values, mut derivatives) = (vec![Complex::default(); n], vec![Complex::default(); n]);
        self.0.derivatives_into(point, &mut values, &mut derivatives)?;
        // The real part of a holomorphic function: its gradient is the conjugate of the derivative.
        let gradient = |d: Complex| [d.re, -d.im];
        for (j, edge) in self.0.edges.iter().enumerate() {
            (vertices[j], vertex_gradients[j]) = (values[j].re, gradient(derivatives[j]));
            let logarithms = edge.shares(Complex::new(point)).logarithms;
            let factor = (edge.to - edge.from).size() / TAU;
            // Less the integral of ln|.| over the edge.
            let mean = (edge.from - Complex::new(point)).size().ln() + logarithms[1].re - 1.0;
            (edges[j], edge_gradients[j]) = (-factor * mean, gradient(logarithms[0].times(factor)));
        }
        Ok(())
    }
}

fn check_finite<'a>(point: [f64; 2], mut numbers: impl Iterator<Item = &'a Complex>) -> Result<(), CoordinateError> {
    let is_good = numbers.all(|c| c.re.is_finite() && c.im.is_finite());
    if is_good { Ok(()) } else { Err(CoordinateError::Undefined { point }) }
}
