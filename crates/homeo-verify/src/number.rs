//! Exact signs and sums of doubles.
//!
//! The predicate of `robust` is exact as long as nothing underflows or overflows. Outside
//! `2^-250 ..= 2^250` (zero aside) the same determinant is computed with integers in units of `2^-1074`.
//! Points with rational coordinates become [`Exact`] ones when all points are multiplied by one denominator.

use dashu_int::IBig;
use robust::{Coord3D, orient3d};
use std::cmp::Ordering;

/// A point, or a vertex' image; in the plane the last coordinate does not count.
pub(crate) type Point = [f64; 3];

/// A point in whole units: those of `2^-1074`, or a fraction of them that all points of a computation share.
pub(crate) type Exact = [IBig; 3];

/// The sign of `det(b - a, c - a, d - a)`, exact.
pub(crate) fn orientation_3d(a: Point, b: Point, c: Point, d: Point) -> Ordering {
    if are_moderate(&[a, b, c, d]) {
        let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p[0], y: p[1], z: p[2] });
        let determinant = orient3d(b, a, c, d); // its convention is the opposite one
        return determinant.partial_cmp(&0.0).unwrap_or(Ordering::Equal);
    }
    determinant_sign([b, c, d].map(|p| exact_step(a, p)))
}

/// The sign of `det(b - a, d - c, f - e)` for the steps `[a, b]`, `[c, d]`, `[e, f]`, exact.
pub(crate) fn steps_orientation(steps: [[Point; 2]; 3]) -> Ordering {
    if are_moderate(steps.as_flattened()) {
        let [a, b, c] = steps.map(|[from, to]| [0, 1, 2].map(|axis| to[axis] - from[axis]));
        let (mut determinant, mut magnitude) = (0.0, 0.0);
        for (x, y, z) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            let (plus, minus) = (b[y] * c[z], b[z] * c[y]);
            determinant += a[x] * (plus - minus);
            magnitude += a[x].abs() * (plus.abs() + minus.abs());
        }
        // Every term went through at most 9 roundings, each by a factor within `1 +- EPSILON / 2`.
        if determinant.abs() > 16.0 * f64::EPSILON * magnitude {
            return determinant.total_cmp(&0.0);
        }
    }
    determinant_sign(steps.map(|[from, to]| exact_step(from, to)))
}

/// The sign of `det(b - a, c - a, d - a)`.
pub(crate) fn exact_orientation(a: &Exact, b: &Exact, c: &Exact, d: &Exact) -> Ordering {
    determinant_sign([b, c, d].map(|p| [0, 1, 2].map(|axis| &p[axis] - &a[axis])))
}

/// Whether products of three differences of these coordinates neither underflow nor overflow.
fn are_moderate(points: &[Point]) -> bool {
    let (smallest, largest) = (f64::from_bits((1023 - 250) << 52), f64::from_bits((1023 + 250) << 52));
    points.iter().flatten().all(|&x| x == 0.0 || (smallest..=largest).contains(&x.abs()))
}

fn exact_step(from: Point, to: Point) -> Exact {
    [0, 1, 2].map(|axis| in_finest_units(to[axis]) - in_finest_units(from[axis]))
}

fn determinant_sign([a, b, c]: [Exact; 3]) -> Ordering {
    let minor = |x: usize, y: usize| &b[x] * &c[y] - &b[y] * &c[x];
    (&a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)).cmp(&IBig::ZERO)
}

/// The sign of `det(b - a, c - a)` of the first two coordinates, exact: that of a prism of height 1.
pub(crate) fn orientation_2d(a: Point, b: Point, c: Point) -> Ordering {
    let [a, b, c] = [a, b, c].map(|p| [p[0], p[1], 0.0]);
    orientation_3d(a, b, c, [a[0], a[1], 1.0])
}

/// Whether a triangle in space has area zero: its three shadows have.
pub(crate) fn is_flat_triangle(a: Point, b: Point, c: Point) -> bool {
    [(0, 1), (1, 2), (2, 0)].iter().all(|&(x, y)| {
        let [a, b, c] = [a, b, c].map(|p| [p[x], p[y], 0.0]);
        orientation_2d(a, b, c) == Ordering::Equal
    })
}

/// All finite doubles are whole multiples of `2^-1074`.
pub(crate) const FINEST_BITS: usize = 1074;

/// A finite double in units of `2^-1074`.
pub(crate) fn in_finest_units(value: f64) -> IBig {
    let bits = value.to_bits();
    let (exponent, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
    let magnitude = match exponent {
        0 => IBig::from(fraction),
        _ => IBig::from(fraction | 1 << 52) << (exponent - 1) as usize,
    };
    if value.is_sign_negative() { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_agree_inside_and_outside_the_range_of_robust() {
        for scale in [1.0, 2f64.powi(-400), 2f64.powi(320), f64::from_bits(1)] {
            let at = |x: f64, y: f64, z: f64| [x * scale, y * scale, z * scale];
            let (o, x, y, z) = (at(0., 0., 0.), at(1., 0., 0.), at(0., 1., 0.), at(0., 0., 1.));
            assert_eq!(orientation_3d(o, x, y, z), Ordering::Greater);
            assert_eq!(orientation_3d(x, o, y, z), Ordering::Less);
            assert_eq!(orientation_3d(o, x, y, at(5., 9., 0.)), Ordering::Equal);
            assert_eq!(steps_orientation([[o, x], [x, y], [y, z]]), Ordering::Greater);
            assert_eq!(steps_orientation([[o, x], [y, x], [y, z]]), Ordering::Less);
            assert_eq!(steps_orientation([[o, x], [y, x], [z, at(3., 7., 1.)]]), Ordering::Equal);
            assert_eq!(orientation_2d(o, x, y), Ordering::Greater);
            assert!(is_flat_triangle(o, at(1., 2., 3.), at(2., 4., 6.)));
            assert!(!is_flat_triangle(o, at(1., 2., 3.), at(2., 4., 7.)));
        }
    }

    /// Steps in one plane, moved by one unit in the last place or not at all.
    #[test]
    fn signs_of_almost_flat_steps_are_exact() {
        let (mut state, mut undecided) = (1u64, 0);
        for k in 0..3000 {
            let mut coordinate = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (state >> 40) as f64 / 1024.0
            };
            let mut points = [0; 6].map(|_| [coordinate(), coordinate(), 0.0]);
            points.iter_mut().for_each(|p| p[2] = p[0] + 3.0 * p[1]);
            points[k % 6][k % 3] = f64::from_bits(points[k % 6][k % 3].to_bits() + (k as u64 / 18) % 2);
            let [a, b, c, d, e, f] = points;
            let exact = determinant_sign([exact_step(a, b), exact_step(c, d), exact_step(e, f)]);
            assert_eq!(steps_orientation([[a, b], [c, d], [e, f]]), exact, "{points:?}");
            undecided += usize::from(exact == Ordering::Equal);
        }
        assert!((500..2500).contains(&undecided), "{undecided}");
    }

    #[test]
    fn finest_units_are_exact() {
        assert_eq!(in_finest_units(1.0), IBig::ONE << FINEST_BITS);
        assert_eq!(in_finest_units(f64::from_bits(1)), IBig::ONE);
        assert_eq!(in_finest_units(-0.75), -(IBig::from(3) << (FINEST_BITS - 2)));
    }
}
