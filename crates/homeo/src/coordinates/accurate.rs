//! Cross products of differences, accurate to their last digits also where they nearly vanish.
//!
//! Everything that is singular on an edge is a quotient by such a product: its relative error is that of the
//! coordinates.

/// Below this share of its terms a determinant is computed again, in pairs of numbers.
const SAFE_SHARE: f64 = 1.0 / 64.0;

/// `(a - x) x (b - x)`: twice the area of the triangle `x, a, b`, to a relative error of some `1e-14`, as long as it is
/// above `1e-30` of `|a - x| |b - x|`.
pub(super) fn cross(a: [f64; 2], b: [f64; 2], x: [f64; 2]) -> f64 {
    cross_of_differences([a, x], [b, x])
}

/// `(a - b) x (c - d)`, as accurately.
pub(super) fn cross_of_differences([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> f64 {
    let (px, py, qx, qy) = (a[0] - b[0], a[1] - b[1], c[0] - d[0], c[1] - d[1]);
    let (first, second) = (px * qy, py * qx);
    let quick = first - second;
    if quick.abs() > SAFE_SHARE * (first.abs() + second.abs()) {
        return quick;
    }
    let (px, py) = (difference(a[0], b[0]), difference(a[1], b[1]));
    let (qx, qy) = (difference(c[0], d[0]), difference(c[1], d[1]));
    let (first, second) = (product(px.0, qy.0), product(py.0, qx.0));
    let high = difference(first.0, second.0);
    let low = (px.0 * qy.1 - py.0 * qx.1) + (px.1 * qy.0 - py.1 * qx.0) + (first.1 - second.1);
    high.0 + (high.1 + low)
}

/// `a - b` as a rounded number and what it lacks, exactly.
pub(super) fn difference(a: f64, b: f64) -> (f64, f64) {
    let rounded = a - b;
    let back = a - rounded;
    (rounded, (a - (rounded + back)) + (back - b))
}

/// `a * b` as a rounded number and what it lacks, exactly, short of overflow and underflow (Dekker 1971).
pub(super) fn product(a: f64, b: f64) -> (f64, f64) {
    let rounded = a * b;
    let ((a1, a0), (b1, b0)) = (halves(a), halves(b));
    (rounded, ((a1 * b1 - rounded) + a1 * b0 + a0 * b1) + a0 * b0)
}

fn halves(a: f64) -> (f64, f64) {
    let shifted = 134_217_729.0 * a;
    let high = shifted - (shifted - a);
    (high, a - high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use homeo_core::number::Rational;

    #[test]
    fn small_areas_have_small_relative_errors() {
        let exact = |x: f64| Rational::from_f64(x).unwrap();
        for (step, scale) in [(1e-3, 1.0), (1e-9, 0.3), (1e-13, 7.1), (3e-16, 0.9)] {
            let (a, b) = ([0.1 * scale, 0.7], [-0.9, 0.3 * scale]);
            let x = [0.4 * a[0] + 0.6 * b[0] + step, 0.4 * a[1] + 0.6 * b[1] - step];
            let minus = |p: f64, q: f64| exact(p) - exact(q);
            let truth = minus(a[0], x[0]) * minus(b[1], x[1]) - minus(a[1], x[1]) * minus(b[0], x[0]);
            let error = (exact(cross(a, b, x)) - truth.clone()) / truth;
            assert!(error.to_f64().abs() < 1e-13, "{step} {}", error.to_f64());
        }
    }
}
