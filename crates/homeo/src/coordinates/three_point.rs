//! The three-point family: Wachspress, mean value and discrete harmonic coordinates and all between and beyond.
//!
//! Weights are `N_i / (A_{i-1} A_i)` with `N_i = r_{i+1}^p A_{i-1} - r_i^p B_i + r_{i-1}^p A_i`. Since
//! `A_{i-1} + A_i - B_i` is the area `C_i` of the corner,
//! `N_i = r_i^p C_i + (r_{i+1}^p - r_i^p) A_{i-1} + (r_{i-1}^p - r_i^p) A_i`,
//! whose differences are computed from `r_{i+1}^2 - r_i^2 = (s_i + s_{i+1}) . e_i`: without cancellation for short edges.
//! Halfway there are two more such sums; the one of the smallest terms is taken. Instead of the products of all areas of (6.1) to (6.4), which under- and overflow, the
//! weights are multiplied by the areas of the closest edge and the closer one of its neighbours: no other can vanish.

use homeo_core::planar::PlanarDomain;

use super::accurate::{cross, cross_of_differences};
use super::mean_value::least;
use super::outline::{Outline, Sight, dot};
use super::real::Real;
use super::weighted::{self, Weighted};
use super::{CoordinateError, PlanarCoordinates};

/// How far outside a point may lie, in diagonals: as far as rounding carries.
const OUTSIDE: f64 = 1e-12;

/// The three-point coordinates of an exponent `p` (Floater, Hormann, Kós 2006) of a strictly convex polygon.
///
/// Wachspress for `p = 0`, mean value for 1, discrete harmonic for 2. Positive for `0 <= p <= 1`. Smooth but at vertices,
/// and for `p < 1` once differentiable there too.
///
/// # Complexity
/// Linear in #V; powers are slow, but for `p` of 0, 1 and 2.
///
/// ```
/// use homeo::coordinates::{PlanarCoordinates, ThreePoint};
/// use homeo_core::planar::PlanarDomain;
/// let square = PlanarDomain::new(vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]])?;
/// let mut values = [0.0; 4];
/// ThreePoint::new(&square, 0.5)?.values_into([0.25, 0.0], &mut values)?;
/// assert!((values[0] - 0.75).abs() < 1e-15 && values[2] == 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ThreePoint {
    outline: Outline,
    exponent: f64,
    /// Twice the areas of the corners.
    corners: Vec<f64>,
    /// Lengths of the edges.
    lengths: Vec<f64>,
}

impl ThreePoint {
    /// Of a polygon that is strictly convex.
    ///
    /// # Errors
    /// Names the first vertex with an inner angle of a half turn or more; refuses holes and exponents that are not
    /// finite.
    pub fn new(domain: &PlanarDomain, exponent: f64) -> Result<Self, CoordinateError> {
        if !exponent.is_finite() {
            return Err(CoordinateError::BadExponent { exponent });
        }
        if domain.rings().len() > 1 {
            return Err(CoordinateError::HasHoles);
        }
        let outline = Outline::new(domain);
        if let Some(vertex) = outline.first_not_convex() {
            return Err(CoordinateError::NotConvex { vertex });
        }
        let v = |i: usize| outline.vertices[i];
        let corner = |i: usize| cross(v(outline.next[i]), v(outline.previous[i]), v(i));
        let corners = (0..outline.count()).map(corner).collect();
        let length = |i: usize| outline.between(i, outline.next[i])[0].hypot(outline.between(i, outline.next[i])[1]);
        let lengths = (0..outline.count()).map(length).collect();
        Ok(Self { outline, exponent, corners, lengths })
    }

    /// The `N_i` of a vertex, by the one of four sums that cancels least: the first near vertices, the next where an
    /// edge of the vertex is short, the last where both are or the corner is flat.
    fn numerator<T: Real<2>>(&self, i: usize, sight: &Sight<T>) -> T {
        let (h, j) = (self.outline.previous[i], self.outline.next[i]);
        if self.exponent == 0.0 {
            return T::constant(self.corners[i]);
        }
        let [before, own, after] = [h, i, j].map(|v| power(sight.distance[v], self.exponent));
        let (left, right) = (sight.cross[h], sight.cross[i]);
        let across = self.outline.cross::<T>(h, j, sight.point);
        // `A_{i-1} - B_i` and `A_i - B_i`.
        let v = |i: usize| self.outline.vertices[i];
        let turn = |[from, to]: [usize; 2], k: usize| {
            let [x, y] = self.outline.between(from, to);
            T::variable(cross_of_differences([v(to), v(from)], [v(k), sight.point]), [y, -x])
        };
        let (past_after, past_before) = (turn([i, j], h), turn([h, i], j));
        let to_after = self.growth(i, j, sight) * left;
        let to_before = self.growth(i, h, sight) * right;
        let sums = [
            [after * left, before * right, -(own * across)],
            [to_after, before * right, own * past_after],
            [after * left, to_before, own * past_before],
            [to_after, to_before, own * self.corners[i]],
        ];
        // Of nearly equal sums the later: where values tie, its gradients are smaller.
        let size = |(terms, handicap): (&[T; 3], f64)| handicap * terms.iter().map(|t| t.value().abs()).sum::<f64>();
        let [first, second, third] = sums[least(sums.iter().zip([1.0, 0.5, 0.5, 0.25]).map(size))];
        first + second + third
    }

    /// `r_j^p - r_i^p` of two neighbours.
    fn growth<T: Real<2>>(&self, i: usize, j: usize, sight: &Sight<T>) -> T {
        let edge = self.outline.between(i, j).map(T::constant);
        let (near, far) = (sight.offset[i], sight.offset[j]);
        let squares = dot([near[0] + far[0], near[1] + far[1]], edge);
        let (r, other, p) = (sight.distance[i], sight.distance[j], self.exponent);
        if p == 1.0 {
            return squares / (r + other);
        }
        if p == 2.0 {
            return squares;
        }
        let relative = squares / (r * r);
        match (-0.5..1.0).contains(&relative.value()) {
            true => power(r, p) * (relative.ln_1p() * (0.5 * p)).exp_m1(),
            false => power(other, p) - power(r, p),
        }
    }
}

/// A power, without work for the common ones.
fn power<T: Real<2>>(r: T, exponent: f64) -> T {
    match exponent {
        0.0 => T::constant(1.0),
        1.0 => r,
        2.0 => r * r,
        _ => r.powf(exponent),
    }
}

impl Weighted for ThreePoint {
    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn weights<T: Real<2>>(&self, sight: &Sight<T>) -> Result<Vec<T>, CoordinateError> {
        let outline = &self.outline;
        let area = |i: usize| sight.cross[i];
        // Not the areas themselves count: that of a short edge is small everywhere, and grows as slowly.
        let height = |i: usize| area(i).value() / self.lengths[i];
        let closest = least((0..outline.count()).map(height));
        if height(closest) < -OUTSIDE {
            return Err(CoordinateError::Undefined { point: sight.point.map(|x| x / outline.scale) });
        }
        let (before, after) = (outline.previous[closest], outline.next[closest]);
        // The corner at the two closest neighbouring edges, `j` and `k`.
        let corner = if height(before) < height(after) { closest } else { after };
        let (j, k) = (outline.previous[corner], corner);
        let weight = |i: usize| {
            let (before, numerator) = (outline.previous[i], self.numerator(i, sight));
            match (before == j || before == k, i == j || i == k) {
                (true, true) => numerator,
                (true, false) => numerator * area(j + k - before) / area(i),
                (false, true) => numerator * area(j + k - i) / area(before),
                (false, false) => numerator * (area(j) / area(before)) * (area(k) / area(i)),
            }
        };
        Ok((0..outline.count()).map(weight).collect())
    }

    /// Lemma 1 of chapter 6, for `p < 1`: those of the triangle of the corner.
    fn vertex_gradients(&self, vertex: usize, gradients: &mut [[f64; 2]]) -> Result<(), CoordinateError> {
        if self.exponent >= 1.0 {
            return Err(CoordinateError::NoGradient { vertex });
        }
        let (before, after) = (self.outline.previous[vertex], self.outline.next[vertex]);
        let normal = |[x, y]: [f64; 2]| [-y / self.corners[vertex], x / self.corners[vertex]];
        gradients.fill([0.0; 2]);
        gradients[before] = normal(self.outline.between(vertex, after));
        gradients[after] = normal(self.outline.between(before, vertex));
        weighted::balance(vertex, gradients);
        Ok(())
    }
}

impl PlanarCoordinates for ThreePoint {
    fn vertex_count(&self) -> usize {
        self.outline.count()
    }

    fn values_into(&self, point: [f64; 2], values: &mut [f64]) -> Result<(), CoordinateError> {
        weighted::values(self, point, values)
    }

    fn gradients_into(
        &self,
        point: [f64; 2],
        values: &mut [f64],
        gradients: &mut [[f64; 2]],
    ) -> Result<(), CoordinateError> {
        weighted::gradients(self, point, values, gradients)
    }
}

/// Wachspress coordinates of a strictly convex polygon: the [`ThreePoint`] ones of exponent 0, rational functions.
///
/// Positive and smooth everywhere, vertices included. Maps between convex polygons are injective (Floater, Kosinka 2010).
#[derive(Clone, Debug)]
pub struct Wachspress(ThreePoint);

impl Wachspress {
    /// Of a polygon that is strictly convex.
    ///
    /// # Errors
    /// As [`ThreePoint::new`].
    pub fn new(domain: &PlanarDomain) -> Result<Self, CoordinateError> {
        ThreePoint::new(domain, 0.0).map(Self)
    }
}

/// Discrete harmonic coordinates of a strictly convex polygon: the [`ThreePoint`] ones of exponent 2, the cotangent
/// weights.
///
/// They may be negative, and have no gradient at vertices.
#[derive(Clone, Debug)]
pub struct DiscreteHarmonic(ThreePoint);

impl DiscreteHarmonic {
    /// Of a polygon that is strictly convex.
    ///
    /// # Errors
    /// As [`ThreePoint::new`].
    pub fn new(domain: &PlanarDomain) -> Result<Self, CoordinateError> {
        ThreePoint::new(domain, 2.0).map(Self)
    }
}

/// Passes everything on to the family.
macro_rules! member_of_family {
    ($kind:ty) => {
        impl PlanarCoordinates for $kind {
            fn vertex_count(&self) -> usize {
                self.0.vertex_count()
            }

            fn values_into(&self, point: [f64; 2], values: &mut [f64]) -> Result<(), CoordinateError> {
                self.0.values_into(point, values)
            }

            fn gradients_into(
                &self,
                point: [f64; 2],
                values: &mut [f64],
                gradients: &mut [[f64; 2]],
            ) -> Result<(), CoordinateError> {
                self.0.gradients_into(point, values, gradients)
            }
        }
    };
}

member_of_family!(Wachspress);
member_of_family!(DiscreteHarmonic);
