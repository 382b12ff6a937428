//! Cross products of differences, accurate to their last digits also where they nearly vanish.
//!
//! Everything that is singular on an edge is a quotient by such a product: its relative error is that of the
//! coordinates.

/// Below this share of its terms a determinant is computed again, in pairs of numbers.
const SAFE_SHARE: f64 = 1.0 / 64.0;

/// `(a - x) x (b - x)`: twice the area of the triangle `x, a, b`, to a relative error of some `1e-14`, as long as it is
/// above `1e-30` of `|a - x| |b - x|`.
pub(super) fn cross(a: [f64; 2], b: [f64; 2], x: [f64; 2]) -> f64 {
    let (ax, ay, bx, by) = (a[0] - x[0], a[1] - x[1], b[0] - x[0], b[1] - x[1]);
    let (p, q) = (ax * by, ay * bx);
    let quick = p - q;
    if quick.abs() > SAFE_SHARE * (p.abs() + q.abs()) {
        return quick;
    }
    let [ax, ay, bx, by] =
        [difference(a[0], x[0]), difference(a[1], x[1]), difference(b[0], x[0]), difference(b[1], x[1])];
    let (p, q) = (product(ax.0, by.0), product(ay.0, bx.0));
    let high = difference(p.0, q.0);
    let low = (ax.0 * by.1 - ay.0 * bx.1) + (ax.1 * by.0 - ay.1 * bx.0) + (p.1 - q.1);
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
