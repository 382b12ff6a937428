//! Three by three matrices, by rows: rotations, their logarithms, polar decomposition.

use crate::coordinates::vectors::{minus, norm, scalar_product, vector_product};

type Point3 = [f64; 3];

/// A matrix by rows.
pub(super) type Matrix = [Point3; 3];

/// Steps of Newton's method for the polar decomposition before giving up; it converges quadratically.
const MOST_STEPS: usize = 100;

pub(super) fn identity() -> Matrix {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

pub(super) fn transposed(a: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| a[j][i]))
}

pub(super) fn apply(a: &Matrix, x: Point3) -> Point3 {
    a.map(|row| scalar_product(row, x))
}

pub(super) fn times(a: &Matrix, b: &Matrix) -> Matrix {
    let columns = transposed(b);
    a.map(|row| columns.map(|column| scalar_product(row, column)))
}

pub(super) fn add(a: &Matrix, b: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| a[i][j] + b[i][j]))
}

pub(super) fn scaled(a: &Matrix, factor: f64) -> Matrix {
    a.map(|row| row.map(|x| factor * x))
}

/// The inverse, transposed; `None` where it is not finite.
fn inverse_transposed(a: &Matrix) -> Option<Matrix> {
    let cofactors = [vector_product(a[1], a[2]), vector_product(a[2], a[0]), vector_product(a[0], a[1])];
    let determinant = scalar_product(a[0], cofactors[0]);
    let inverse = scaled(&cofactors, 1.0 / determinant);
    inverse.iter().flatten().all(|x| x.is_finite()).then_some(inverse)
}

/// The linear map that takes the edges of one triangle to those of another, and unit normal to unit normal.
pub(super) fn gradient(source: [Point3; 3], target: [Point3; 3]) -> Matrix {
    let frame = |[a, b, c]: [Point3; 3]| {
        let (p, q) = (minus(b, a), minus(c, a));
        let normal = vector_product(p, q);
        (p, q, normal.map(|x| x / norm(normal)))
    };
    let ((p, q, n), (u, v, m)) = (frame(source), frame(target));
    // Rows dual to the frame of the source.
    let area = scalar_product(vector_product(p, q), n);
    let (dual_p, dual_q) = (vector_product(q, n).map(|x| x / area), vector_product(n, p).map(|x| x / area));
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| u[i] * dual_p[j] + v[i] * dual_q[j] + m[i] * n[j]))
}

/// Rotation and symmetric stretch, `G = R S`, of a matrix with positive determinant (Higham 1986): the mean with the
/// inverse transposed, again and again.
pub(super) fn polar(g: &Matrix) -> Option<(Matrix, Matrix)> {
    let mut rotation = *g;
    for _ in 0..MOST_STEPS {
        let next = scaled(&add(&rotation, &inverse_transposed(&rotation)?), 0.5);
        let change = (0..9).map(|k| (next[k / 3][k % 3] - rotation[k / 3][k % 3]).abs()).fold(0.0, f64::max);
        rotation = next;
        if change < 1e-15 {
            break;
        }
    }
    let is_proper = scalar_product(rotation[0], vector_product(rotation[1], rotation[2])) > 0.5;
    is_proper.then(|| (rotation, times(&transposed(&rotation), g)))
}

/// The axis of a rotation times its angle, of at most a half turn.
pub(super) fn logarithm(r: &Matrix) -> Point3 {
    let skew = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]];
    let (sine, cosine) = (0.5 * norm(skew), 0.5 * (r[0][0] + r[1][1] + r[2][2] - 1.0));
    let angle = sine.atan2(cosine);
    if cosine > -0.5 {
        // angle / sin(angle), 1 at zero.
        let factor = if sine > 1e-9 { angle / sine } else { 1.0 };
        return skew.map(|x| 0.5 * factor * x);
    }
    // Near a half turn the axis is the longest column of R + R^t + (1 - trace) I.
    let shift = 1.0 - (r[0][0] + r[1][1] + r[2][2]);
    let column = |j: usize| [0, 1, 2].map(|i| r[i][j] + r[j][i] + if i == j { shift } else { 0.0 });
    let axis = (1..3).map(column).fold(column(0), |best, next| if norm(next) > norm(best) { next } else { best });
    let sign = if scalar_product(axis, skew) < 0.0 { -1.0 } else { 1.0 };
    axis.map(|x| sign * angle * x / norm(axis))
}

/// The rotation about a vector by its length (Rodrigues).
pub(super) fn exponential(v: Point3) -> Matrix {
    let angle = norm(v);
    if angle == 0.0 {
        return identity();
    }
    let [x, y, z] = v.map(|x| x / angle);
    let (s, half) = (angle.sin(), (0.5 * angle).sin());
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    // 1 - cos, without cancellation.
    add(&identity(), &add(&scaled(&cross, s), &scaled(&times(&cross, &cross), 2.0 * half * half)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distance(a: &Matrix, b: &Matrix) -> f64 {
        (0..9).map(|k| (a[k / 3][k % 3] - b[k / 3][k % 3]).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn logarithm_and_exponential_are_inverse() {
        for angle in [0.0, 1e-12, 1e-5, 0.3, 1.5, 2.2, 3.0, 3.13] {
            let v = [0.6, -0.48, 0.64].map(|x: f64| x * angle);
            let back = logarithm(&exponential(v));
            assert!(norm(minus(v, back)) < 1e-14 + 1e-15 * angle, "{angle} {v:?} {back:?}");
        }
    }

    #[test]
    fn polar_parts_multiply_to_the_whole() {
        let g = [[1.0, 2.0, 0.1], [-0.3, 0.8, 0.2], [0.0, 0.4, 3.0]];
        let (rotation, stretch) = polar(&g).unwrap();
        assert!(distance(&times(&rotation, &stretch), &g) < 1e-14);
        assert!(distance(&times(&rotation, &transposed(&rotation)), &identity()) < 1e-14);
        assert!(distance(&stretch, &transposed(&stretch)) < 1e-14);
        assert_eq!(polar(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]), None);
    }
}
