//! Vectors in space.

pub(super) type Vector = [f64; 3];

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

pub(super) fn plus(a: Vector, b: Vector, factor: f64) -> Vector {
    [0, 1, 2].map(|k| a[k] + factor * b[k])
}
