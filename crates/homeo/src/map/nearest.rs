//! The point of a triangle in space that is nearest to a point: with bounds in floating point, and exactly.

use homeo_core::number::Rational;
use homeo_core::predicate::{Sign, orient3d};

pub(super) type ExactVector = [Rational; 3];

/// A point's foot on the plane of a triangle. For bounds, each number comes with one of its error.
pub(super) struct Projection<const K: usize> {
    /// Barycentric coordinates of the foot.
    pub weights: [f64; K],
    /// Bounds of their errors.
    pub errors: [f64; K],
    /// The point is at least this far from the triangle.
    pub distance_at_least: f64,
    /// The point is at most this far from the foot, which lies in the triangle; infinite where that is not certain.
    pub distance_at_most: f64,
}

/// A number and a bound of its error.
#[derive(Clone, Copy, Debug)]
struct Near {
    value: f64,
    error: f64,
}

/// Bound of the rounding of a few operations, relative to the sum of the magnitudes.
const FEW: f64 = 4.0 * f64::EPSILON;
/// Squares of normals below this may have lost digits to underflow, and nothing is certain then.
const LEAST_SQUARE: f64 = 1e-250;

impl Near {
    /// A difference of two given numbers.
    fn difference(a: f64, b: f64) -> Self {
        let value = a - b;
        Self { value, error: f64::EPSILON * value.abs() }
    }

    /// `a b + sign c d`.
    fn products([a, b]: [Self; 2], sign: f64, [c, d]: [Self; 2]) -> Self {
        let (first, second) = (a.times(b), c.times(d));
        let magnitude = first.value.abs() + second.value.abs();
        Self { value: first.value + sign * second.value, error: first.error + second.error + FEW * magnitude }
    }

    fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.abs() * other.error + self.error * (other.value.abs() + other.error);
        Self { value, error: error + FEW * value.abs() }
    }

    fn plus(self, other: Self) -> Self {
        let value = self.value + other.value;
        Self { value, error: self.error + other.error + FEW * (self.value.abs() + other.value.abs()) }
    }

    fn at_least(self) -> f64 {
        self.value - self.error * (1.0 + FEW)
    }

    fn magnitude_at_most(self) -> f64 {
        (self.value.abs() + self.error) * (1.0 + FEW)
    }
}

type NearVector = [Near; 3];

fn difference(a: [f64; 3], b: [f64; 3]) -> NearVector {
    [0, 1, 2].map(|axis| Near::difference(a[axis], b[axis]))
}

fn cross(a: &NearVector, b: &NearVector) -> NearVector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| Near::products([a[i], b[j]], -1.0, [a[j], b[i]]))
}

fn dot(a: &NearVector, b: &NearVector) -> Near {
    Near::products([a[0], b[0]], 1.0, [a[1], b[1]]).plus(a[2].times(b[2]))
}

impl<const K: usize> Projection<K> {
    pub fn new(corners: &[[f64; 3]; K], point: [f64; 3]) -> Self {
        let [u, v, w] = [(1, 0), (2, 1), (0, 2)].map(|(to, from)| difference(corners[to], corners[from]));
        let offsets = [0, 1, 2].map(|i| difference(point, corners[i]));
        let normal = cross(&u, &v);
        let square = dot(&normal, &normal);
        let safe = square.at_least();
        let mut foot =
            Self { weights: [0.0; K], errors: [0.0; K], distance_at_least: 0.0, distance_at_most: f64::INFINITY };
        if !(safe > LEAST_SQUARE && square.value.is_finite()) {
            return foot;
        }
        // The side opposite corner 2 is u, and so on.
        let (sides, size) = ([v, w, u], square.value.sqrt());
        let mut is_inside = true;
        for i in 0..3 {
            let area = dot(&cross(&sides[i], &offsets[(i + 1) % 3]), &normal);
            let weight = area.value / square.value;
            let error = (area.error + weight.abs() * square.error) / safe + FEW * weight.abs();
            (foot.weights[i], foot.errors[i]) = (weight, error * (1.0 + FEW));
            is_inside &= weight > foot.errors[i];
            let beyond = -(weight + foot.errors[i]);
            if beyond > 0.0 {
                let side = dot(&sides[i], &sides[i]).magnitude_at_most().sqrt();
                foot.distance_at_least = foot.distance_at_least.max(beyond * size / side * (1.0 - 1e-9));
            }
        }
        let height = dot(&offsets[0], &normal);
        let above = (height.value.abs() - height.error).max(0.0) / size * (1.0 - 1e-9);
        foot.distance_at_least = foot.distance_at_least.max(above);
        if is_inside {
            foot.distance_at_most = height.magnitude_at_most() / safe.sqrt() * (1.0 + 1e-9);
        }
        foot
    }
}

pub(super) fn minus(a: &ExactVector, b: &ExactVector) -> ExactVector {
    [0, 1, 2].map(|axis| &a[axis] - &b[axis])
}

pub(super) fn exact_cross(a: &ExactVector, b: &ExactVector) -> ExactVector {
    let entry = |i: usize, j: usize| &(&a[i] * &b[j]) - &(&a[j] * &b[i]);
    [entry(1, 2), entry(2, 0), entry(0, 1)]
}

pub(super) fn exact_dot(a: &ExactVector, b: &ExactVector) -> Rational {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

/// Whether a triangle or tetrahedron has no area or volume, exactly.
pub(crate) fn is_flat<const K: usize>(corners: &[[f64; 3]; K]) -> bool {
    if K == 4 && orient3d(corners[0], corners[1], corners[2], corners[K - 1]) != Sign::Zero {
        return false;
    }
    let [u, v] = [1, 2].map(|i| difference(corners[i], corners[0]));
    if K == 3 && dot(&cross(&u, &v), &cross(&u, &v)).at_least() > LEAST_SQUARE {
        return false;
    }
    // Few get here, and where numbers underflow only exact ones tell.
    let exact = corners.map(|corner| corner.map(|x| Rational::from_f64(x).unwrap_or(Rational::ZERO)));
    let normal = exact_cross(&minus(&exact[1], &exact[0]), &minus(&exact[2], &exact[0]));
    if K == 4 {
        exact_dot(&normal, &minus(&exact[K - 1], &exact[0])).is_zero()
    } else {
        normal.iter().all(Rational::is_zero)
    }
}

/// Square of the distance from a triangle, and barycentric coordinates of its nearest point. `None` for a flat one.
pub(super) fn nearest_exactly<const K: usize>(
    corners: &[[f64; 3]; K],
    point: &ExactVector,
) -> Option<(Rational, [Rational; K])> {
    let mut exact = Vec::with_capacity(K);
    for corner in corners {
        let [x, y, z] = corner.map(Rational::from_f64);
        exact.push([x?, y?, z?]);
    }
    let normal = exact_cross(&minus(&exact[1], &exact[0]), &minus(&exact[2], &exact[0]));
    let square = exact_dot(&normal, &normal);
    if square.is_zero() {
        return None;
    }
    let weights: [Rational; K] = std::array::from_fn(|i| {
        let (from, to) = (&exact[(i + 1) % K], &exact[(i + 2) % K]);
        &exact_dot(&exact_cross(&minus(to, from), &minus(point, from)), &normal) / &square
    });
    if weights.iter().all(|w| w.sign() != Sign::Negative) {
        let height = exact_dot(&minus(point, &exact[0]), &normal);
        return Some((&(&height * &height) / &square, weights));
    }
    (0..K).map(|i| nearest_on_side(&exact, i, point)).min_by(|a, b| a.0.cmp(&b.0))
}

/// Square of the distance from the side opposite corner `i`, and the coordinates of its nearest point.
fn nearest_on_side<const K: usize>(
    corners: &[ExactVector],
    i: usize,
    point: &ExactVector,
) -> (Rational, [Rational; K]) {
    let (a, b) = ((i + 1) % K, (i + 2) % K);
    let side = minus(&corners[b], &corners[a]);
    let offset = minus(point, &corners[a]);
    let along = (&exact_dot(&offset, &side) / &exact_dot(&side, &side)).clamp(Rational::ZERO, Rational::ONE);
    let off = minus(&offset, &side.each_ref().map(|x| x * &along));
    let mut weights: [Rational; K] = std::array::from_fn(|_| Rational::ZERO);
    weights[a] = &Rational::ONE - &along;
    weights[b] = along;
    (exact_dot(&off, &off), weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floating_feet_enclose_exact_ones() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for round in 0..2000 {
            let thin = [1.0, 1e-6, 1e-12][round % 3];
            let mut corners = [[0.0; 3]; 3];
            corners.iter_mut().for_each(|c| *c = [random(), thin * random(), 1e-3 * random()]);
            let off = [0.0, 1e-9, 1e-2][round / 3 % 3];
            let point = [random(), thin * random(), off * random()];
            let foot = Projection::new(&corners, point);
            let exact_point = point.map(|x| Rational::from_f64(x).unwrap());
            let Some((square, weights)) = nearest_exactly(&corners, &exact_point) else { continue };
            let distance = square.to_f64().sqrt();
            assert!(foot.distance_at_least <= distance * (1.0 + 1e-12));
            if foot.distance_at_most < f64::INFINITY {
                assert!(distance <= foot.distance_at_most * (1.0 + 1e-12));
                for (i, weight) in weights.iter().enumerate() {
                    let off = weight - &Rational::from_f64(foot.weights[i]).unwrap();
                    assert!(off.to_f64().abs() <= foot.errors[i], "weight {i}: {} > {}", off.to_f64(), foot.errors[i]);
                }
            }
        }
    }
}
