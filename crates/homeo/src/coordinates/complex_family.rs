//! Complex coordinates by edges: the recipe of Weber, Ben-Chen, Gotsman and Hormann 2011, with the three-point family and
//! Cauchy's coordinates as members.
//!
//! With `ρ_i` the vector from the point to vertex `i`, `e_i = ρ_{i+1} - ρ_i`, `r_i = |ρ_i|`, `c_i` the cross and `d_i`
//! the dot product of `ρ_i` and `ρ_{i+1}`, the source has for an exponent `p`
//! `γ_i = e_i / c_i (r_{i+1}^p / ρ_{i+1} - r_i^p / ρ_i)`. Multiplied out,
//!
//! ```text
//! γ_i = (r_{i+1}^{p-2} ρ_{i+1} . e_i - r_i^{p-2} ρ_i . e_i) / c_i + i (r_{i+1}^{p-2} - r_i^{p-2}),
//! ```
//!
//! where the first term is `t_i (1 / r_i + 1 / r_{i+1})` for `p = 1`, `t_i` the tangent of half the angle: no division by
//! zero off the edge. Imaginary parts telescope, so the sum is real. All are multiplied by a number that vanishes on the
//! edge that is seen at the widest angle (`p = 1`) or is closest, and by the least distance.

use homeo_core::planar::PlanarDomain;
use std::f64::consts::TAU;

use super::mean_value::least;
use super::outline::{Outline, Sight, dot};
use super::real::{Jet, Real};
use super::weighted::check_length;
use super::{Cauchy, Complex, CoordinateError, MeanValue, PlanarCoordinates, ThreePoint};

/// Which complex coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ComplexFamily {
    /// The three-point coordinates of an exponent: Wachspress for 0, mean value for 1, discrete harmonic for 2.
    ThreePoint(f64),
    /// Cauchy's: `γ_i = ln(ρ_{i+1} / ρ_i)`, which sum to `2 pi i`.
    Cauchy,
}

/// Complex barycentric coordinates by edges (section 1.2 of Schneider 2017): a map is the mean, by complex shares `g_i` of
/// the edges that sum to 1, of the similarities that send each edge to its image.
///
/// `h(z) = sum g_i(z) s_i(z)` with `s_i(z) = h_i + (h_{i+1} - h_i) (z - z_i) / e_i`; or, by vertices, `h = sum φ_i h_i` with
/// `φ_i = g_i ρ_{i+1} / e_i - g_{i-1} ρ_{i-1} / e_{i-1}`. Both reproduce similarities of the plane, and complex numbers as
/// data; orientation-reversing linear maps only where `φ_i` is real.
///
/// # Guarantee
/// For the three-point family `φ_i` is real, and is the coordinate of [`ThreePoint`] (of [`MeanValue`] for `p = 1`): the
/// shares of edges are what is new. On an open edge its own share is 1 and the others vanish, so `h` is the similarity of
/// this edge there; towards a vertex the shares have limits by direction only, while `h` tends to its image. Cauchy's shares
/// are holomorphic, and do not interpolate.
///
/// # Complexity
/// Linear in #V.
///
/// ```
/// use homeo::coordinates::{Complex, ComplexCoordinates, ComplexFamily};
/// use homeo_core::planar::PlanarDomain;
/// let square = PlanarDomain::new(vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]])?;
/// let kind = ComplexCoordinates::new(&square, ComplexFamily::ThreePoint(1.0))?;
/// let mut shares = [Complex::default(); 4];
/// kind.shares_into([0.5, 0.5], &mut shares)?;
/// assert!((shares[0] - Complex::new([0.25, 0.0])).size() < 1e-15);
/// kind.shares_into([0.3, 0.0], &mut shares)?;
/// assert!((shares[0] - Complex::new([1.0, 0.0])).size() < 1e-15 && shares[2].size() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ComplexCoordinates {
    outline: Outline,
    family: ComplexFamily,
    vertices: ByVertices,
}

/// The coordinates of vertices, which the kinds compute that have them.
#[derive(Clone, Debug)]
enum ByVertices {
    MeanValue(MeanValue),
    ThreePoint(ThreePoint),
    Cauchy(Cauchy),
}

/// A complex number whose parts depend on a point.
type Pair<T> = [T; 2];

impl ComplexCoordinates {
    /// Of all rings of a domain; of a strictly convex polygon for exponents other than 1.
    ///
    /// # Errors
    /// As [`ThreePoint::new`], for exponents other than 1.
    pub fn new(domain: &PlanarDomain, family: ComplexFamily) -> Result<Self, CoordinateError> {
        let vertices = match family {
            ComplexFamily::Cauchy => ByVertices::Cauchy(Cauchy::new(domain)),
            ComplexFamily::ThreePoint(1.0) => ByVertices::MeanValue(MeanValue::new(domain)),
            ComplexFamily::ThreePoint(p) => ByVertices::ThreePoint(ThreePoint::new(domain, p)?),
        };
        Ok(Self { outline: Outline::new(domain), family, vertices })
    }

    /// How many vertices there are, and edges: #V.
    pub fn vertex_count(&self) -> usize {
        self.outline.count()
    }

    /// Coordinates of the vertices (#V) at a point where the family has them; real but for Cauchy's.
    ///
    /// # Errors
    /// The point is not finite or the kind is not defined there; the buffer has the wrong length.
    pub fn values_into(&self, point: [f64; 2], values: &mut [Complex]) -> Result<(), CoordinateError> {
        check_length(self.vertex_count(), values.len())?;
        let kind: &dyn PlanarCoordinates = match &self.vertices {
            ByVertices::MeanValue(kind) => kind,
            ByVertices::ThreePoint(kind) => kind,
            ByVertices::Cauchy(kind) => {
                return kind.derivatives_into(point, values, &mut vec![Complex::default(); values.len()]);
            }
        };
        let mut real = vec![0.0; values.len()];
        kind.values_into(point, &mut real)?;
        values.iter_mut().zip(real).for_each(|(value, re)| *value = Complex { re, im: 0.0 });
        Ok(())
    }

    /// Shares of the edges (#V, that from vertex `i` to the next one at `i`) at a point that is no vertex.
    ///
    /// # Errors
    /// The point is not finite or a vertex, or the kind is not defined there (Cauchy's on the boundary and outside); the
    /// buffer has the wrong length.
    pub fn shares_into(&self, point: [f64; 2], shares: &mut [Complex]) -> Result<(), CoordinateError> {
        check_length(self.vertex_count(), shares.len())?;
        let found = self.shares::<f64>(point)?;
        shares.iter_mut().zip(&found).for_each(|(share, &parts)| *share = Complex::new(parts));
        check(point, shares)
    }

    /// Shares of the edges (#V) and their derivatives by `z` and by its conjugate (#V each). The latter vanish for
    /// Cauchy's.
    ///
    /// # Errors
    /// As [`shares_into`](Self::shares_into).
    pub fn derivatives_into(
        &self,
        point: [f64; 2],
        shares: &mut [Complex],
        by_z: &mut [Complex],
        by_conjugate: &mut [Complex],
    ) -> Result<(), CoordinateError> {
        for length in [shares.len(), by_z.len(), by_conjugate.len()] {
            check_length(self.vertex_count(), length)?;
        }
        let mut found = self.shares::<Jet<2>>(point)?;
        balance(&mut found);
        for (i, [re, im]) in found.into_iter().enumerate() {
            shares[i] = Complex::new([re.value, im.value]);
            let ([a, b], [c, d]) = (re.gradient, im.gradient);
            let half = 0.5 * self.outline.scale;
            by_z[i] = Complex::new([half * (a + d), half * (c - b)]);
            by_conjugate[i] = Complex::new([half * (a - d), half * (c + b)]);
        }
        check(point, shares)?;
        check(point, by_z)?;
        check(point, by_conjugate)
    }

    fn shares<T: Real<2>>(&self, point: [f64; 2]) -> Result<Vec<Pair<T>>, CoordinateError> {
        let local = self.outline.local(point)?;
        if self.outline.vertex_at(local).is_some() {
            return Err(CoordinateError::Undefined { point });
        }
        let sight = self.outline.sight::<T>(local);
        let weights = match self.family {
            ComplexFamily::Cauchy => return self.cauchy(point, &sight),
            ComplexFamily::ThreePoint(1.0) => self.mean_value(&sight),
            ComplexFamily::ThreePoint(p) => self.three_point(p, point, &sight)?,
        };
        let total = weights.iter().fold(T::constant(0.0), |sum, weight| sum + weight[0]);
        Ok(weights.into_iter().map(|weight| weight.map(|part| part / total)).collect())
    }

    /// `t_i (1 / r_i + 1 / r_{i+1}) + i (1 / r_{i+1} - 1 / r_i)`, times the least distance and the cotangent of half the
    /// widest angle.
    fn mean_value<T: Real<2>>(&self, sight: &Sight<T>) -> Vec<Pair<T>> {
        let product = |i: usize| sight.distance[i] * sight.distance[self.outline.next[i]];
        let widest = least((0..self.vertex_count()).map(|i| (sight.dot[i] / product(i)).value()));
        let is_wide = sight.dot[widest].value() < 0.0;
        let cotangent = |i: usize| sight.cross[i] / (product(i) - sight.dot[i]);
        let factor = if is_wide { cotangent(widest) } else { T::constant(1.0) };
        let nearest = T::constant(sight.distance.iter().fold(f64::INFINITY, |least, r| least.min(r.value())));
        let weight = |i: usize| {
            let (own, after) = (sight.distance[i], sight.distance[self.outline.next[i]]);
            let tangent = match sight.dot[i].value() < 0.0 {
                true if i == widest => T::constant(1.0),
                true => factor / cotangent(i),
                false => factor * (sight.cross[i] / (product(i) + sight.dot[i])),
            };
            let difference = -(self.growth(i, sight) / after) * (nearest / own);
            [tangent * (nearest / own + nearest / after), factor * difference]
        };
        (0..self.vertex_count()).map(weight).collect()
    }

    /// `r_{i+1} - r_i`.
    fn growth<T: Real<2>>(&self, i: usize, sight: &Sight<T>) -> T {
        let k = self.outline.next[i];
        let edge = self.outline.between(i, k).map(T::constant);
        let (near, far) = (sight.offset[i], sight.offset[k]);
        dot([near[0] + far[0], near[1] + far[1]], edge) / (sight.distance[i] + sight.distance[k])
    }

    /// As the source has them, multiplied out, times the cross product of the closest edge.
    fn three_point<T: Real<2>>(
        &self,
        exponent: f64,
        point: [f64; 2],
        sight: &Sight<T>,
    ) -> Result<Vec<Pair<T>>, CoordinateError> {
        let length = |i: usize| {
            let [x, y] = self.outline.between(i, self.outline.next[i]);
            x.hypot(y)
        };
        let height = |i: usize| sight.cross[i].value() / length(i);
        let closest = least((0..self.vertex_count()).map(height));
        if height(closest) < -1e-12 {
            return Err(CoordinateError::Undefined { point });
        }
        let factor = sight.cross[closest];
        let weight = |i: usize| {
            let k = self.outline.next[i];
            let edge = self.outline.between(i, k).map(T::constant);
            let [own, after] = [i, k].map(|j| sight.distance[j].powf(exponent - 2.0));
            let real = after * dot(sight.offset[k], edge) - own * dot(sight.offset[i], edge);
            let real = if i == closest { real } else { real * (factor / sight.cross[i]) };
            [real, factor * (after - own)]
        };
        Ok((0..self.vertex_count()).map(weight).collect())
    }

    /// `ln(ρ_{i+1} / ρ_i) / 2 pi i`; inside, where they sum to 1.
    fn cauchy<T: Real<2>>(&self, point: [f64; 2], sight: &Sight<T>) -> Result<Vec<Pair<T>>, CoordinateError> {
        let is_on = |i: usize| sight.cross[i].value() == 0.0 && sight.dot[i].value() <= 0.0;
        let share = |i: usize| {
            let (own, after) = (sight.distance[i], sight.distance[self.outline.next[i]]);
            let (cross, dot) = (sight.cross[i], sight.dot[i]);
            let square = (own * own * after * after).value();
            let slope = |k: usize| (dot.value() * cross.gradient()[k] - cross.value() * dot.gradient()[k]) / square;
            let angle = T::variable(cross.value().atan2(dot.value()), std::array::from_fn(slope));
            let growth = self.growth(i, sight);
            // By the shorter of both: nothing cancels.
            let logarithm = match own.value() <= after.value() {
                true => (growth / own).ln_1p(),
                false => -(-growth / after).ln_1p(),
            };
            [angle * (1.0 / TAU), -logarithm * (1.0 / TAU)]
        };
        let shares: Vec<Pair<T>> = (0..self.vertex_count()).map(share).collect();
        let turns: f64 = shares.iter().map(|share| share[0].value()).sum();
        let is_inside = turns > 0.5 && !(0..self.vertex_count()).any(is_on);
        if is_inside { Ok(shares) } else { Err(CoordinateError::Undefined { point }) }
    }
}

/// Makes the gradients sum to zero by those of the largest share: beside its edge a small difference of large numbers.
fn balance(shares: &mut [Pair<Jet<2>>]) {
    let size = |share: &Pair<Jet<2>>| share[0].value.hypot(share[1].value);
    let largest = least(shares.iter().map(|share| -size(share)));
    for part in 0..2 {
        shares[largest][part].gradient = [0.0; 2];
        let sum = |k: usize| shares.iter().map(|share| share[part].gradient[k]).sum::<f64>();
        shares[largest][part].gradient = [-sum(0), -sum(1)];
    }
}

fn check(point: [f64; 2], numbers: &[Complex]) -> Result<(), CoordinateError> {
    let is_good = numbers.iter().all(|c| c.re.is_finite() && c.im.is_finite());
    if is_good { Ok(()) } else { Err(CoordinateError::Undefined { point }) }
}
