//! Minkowski space: vectors, isometries, and the models of hyperbolic space.

/// A vector `(t, x, y, z)` with the product `-t t' + x x' + y y' + z z'`.
pub type Vector = [f64; 4];

/// An isometry, as a matrix, row by row.
pub type Isometry = [[f64; 4]; 4];

/// The product of two vectors.
///
/// ```
/// use homeo_manifold::hyperbolic::minkowski::product;
/// assert_eq!(product([2.0, 1.0, 0.0, 0.0], [3.0, 4.0, 5.0, 0.0]), -2.0);
/// ```
pub fn product(a: Vector, b: Vector) -> f64 {
    a[1] * b[1] + a[2] * b[2] + a[3] * b[3] - a[0] * b[0]
}

/// The image of a vector.
///
/// ```
/// use homeo_manifold::hyperbolic::minkowski::{IDENTITY, apply};
/// assert_eq!(apply(&IDENTITY, [2.0, 1.0, 0.0, 0.0]), [2.0, 1.0, 0.0, 0.0]);
/// ```
pub fn apply(isometry: &Isometry, vector: Vector) -> Vector {
    isometry.map(|row| (0..4).map(|k| row[k] * vector[k]).sum())
}

/// The second isometry first.
///
/// ```
/// use homeo_manifold::hyperbolic::minkowski::{IDENTITY, compose};
/// assert_eq!(compose(&IDENTITY, &IDENTITY), IDENTITY);
/// ```
pub fn compose(a: &Isometry, b: &Isometry) -> Isometry {
    a.map(|row| std::array::from_fn(|column| (0..4).map(|k| row[k] * b[k][column]).sum()))
}

/// Every point stays.
pub const IDENTITY: Isometry = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The isometry that undoes it: its transpose, with signs of the time changed.
///
/// ```
/// use homeo_manifold::hyperbolic::minkowski::{IDENTITY, inverse};
/// assert_eq!(inverse(&IDENTITY), IDENTITY);
/// ```
pub fn inverse(isometry: &Isometry) -> Isometry {
    let sign = |k: usize| if k == 0 { -1.0 } else { 1.0 };
    std::array::from_fn(|row| std::array::from_fn(|column| sign(row) * sign(column) * isometry[column][row]))
}

/// The point of the hyperboloid on the ray of a vector inside the light cone.
///
/// ```
/// use homeo_manifold::hyperbolic::minkowski::normalized;
/// assert_eq!(normalized([2.0, 0.0, 0.0, 0.0]), [1.0, 0.0, 0.0, 0.0]);
/// ```
pub fn normalized(vector: Vector) -> Vector {
    let size = (-product(vector, vector)).sqrt();
    vector.map(|x| x / size)
}

/// A point of the hyperboloid in the unit ball, Poincaré's model.
///
/// ```
/// use homeo_manifold::hyperbolic::minkowski::in_ball;
/// let [x, _, _] = in_ball([1.0_f64.cosh(), 1.0_f64.sinh(), 0.0, 0.0]);
/// assert!((x - 0.5_f64.tanh()).abs() < 1e-15);
/// ```
pub fn in_ball([t, x, y, z]: Vector) -> [f64; 3] {
    [x, y, z].map(|x| x / (1.0 + t))
}

/// A point of the hyperboloid in the upper half-space; the middle of the ball goes to `(0, 0, 1)`.
///
/// ```
/// use homeo_manifold::hyperbolic::minkowski::in_half_space;
/// let [_, _, height] = in_half_space([1.0_f64.cosh(), 0.0, 0.0, 1.0_f64.sinh()]);
/// assert!((height - 1.0_f64.exp()).abs() < 1e-14);
/// ```
pub fn in_half_space([t, x, y, z]: Vector) -> [f64; 3] {
    // t - z is (1 + x² + y²) / (t + z), which does not cancel high up.
    let below = if z > 0.0 { (1.0 + x * x + y * y) / (t + z) } else { t - z };
    [x / below, y / below, 1.0 / below]
}

/// The matrix in SL(2, C), up to its sign, of an isometry that keeps orientation and the direction of time, entries as real and
/// imaginary parts; nothing if no entry of it is large enough, which rounding alone does not do.
///
/// Vectors are the Hermitian matrices `[[t + z, x + iy], [x - iy, t - z]]`, on which `A` acts by `X -> A X A*`. It acts on the upper
/// half-space by `w -> (a w + b) / (c w + d)`, with `w` the complex number `x + iy` on its boundary.
///
/// ```
/// use homeo_manifold::hyperbolic::minkowski::{IDENTITY, mobius};
/// assert_eq!(mobius(&IDENTITY), Some([[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [1.0, 0.0]]]));
/// ```
pub fn mobius(isometry: &Isometry) -> Option<[[[f64; 2]; 2]; 2]> {
    // Images of e_11 = (1, 0, 0, 1) / 2 and the other units, as X -> A X A*: entries a_i conj(a_j) of the columns of A.
    let image = |vector: Vector| {
        let [t, x, y, z] = apply(isometry, vector);
        [[[t + z, 0.0], [x, y]], [[x, -y], [t - z, 0.0]]]
    };
    let first = image([0.5, 0.0, 0.0, 0.5]);
    // E_12 = (e_x - i e_y) / 2 goes to (first column) (second column)*.
    let (by_x, by_y) = (image([0.0, 0.5, 0.0, 0.0]), image([0.0, 0.0, 0.5, 0.0]));
    // The pivot is the larger entry of the first column, taken as real and positive.
    let pivot = usize::from(first[1][1][0] > first[0][0][0]);
    let size = first[pivot][pivot][0].sqrt();
    if size.is_nan() || size <= 1e-8 {
        return None;
    }
    let column = [0, 1].map(|row| first[row][pivot].map(|x| x / size));
    let second = [0, 1].map(|row| {
        let (x, y) = (by_x[pivot][row], by_y[pivot][row]);
        // conj of ((x - i y) entry) / pivot
        [(x[0] + y[1]) / size, -(x[1] - y[0]) / size]
    });
    let times = |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
    let (p, q) = (times(column[0], second[1]), times(second[0], column[1]));
    // Make the determinant 1: divide by a root of it. The sign is that with a real part that is not negative.
    let determinant = [p[0] - q[0], p[1] - q[1]];
    let angle = -0.5 * determinant[1].atan2(determinant[0]);
    let scale = determinant[0].hypot(determinant[1]).sqrt().recip();
    let turn = [angle.cos() * scale, angle.sin() * scale];
    Some([0, 1].map(|row| [times(column[row], turn), times(second[row], turn)]))
}
