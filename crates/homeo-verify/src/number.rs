//! Exact signs and sums of doubles.
//!
//! The predicate of `robust` is exact as long as nothing underflows or overflows. Outside
//! `2^-250 ..= 2^250` (zero aside) the same determinant is computed with integers in units of `2^-1074`.

use dashu_int::IBig;
use robust::{Coord3D, orient3d};
use std::cmp::Ordering;

/// A point, or a vertex' image; in the plane the last coordinate does not count.
pub(crate) type Point = [f64; 3];

/// The sign of `det(b - a, c - a, d - a)`, exact.
pub(crate) fn orientation_3d(a: Point, b: Point, c: Point, d: Point) -> Ordering {
    let (smallest, largest) = (f64::from_bits((1023 - 250) << 52), f64::from_bits((1023 + 250) << 52));
    if [a, b, c, d].iter().flatten().all(|&x| x == 0.0 || (smallest..=largest).contains(&x.abs())) {
        let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p[0], y: p[1], z: p[2] });
        let determinant = orient3d(b, a, c, d); // its convention is the opposite one
        return determinant.partial_cmp(&0.0).unwrap_or(Ordering::Equal);
    }
    let step = |p: Point| [0, 1, 2].map(|axis| in_finest_units(p[axis]) - in_finest_units(a[axis]));
    let [b, c, d] = [b, c, d].map(step);
    let minor = |x: usize, y: usize| &c[x] * &d[y] - &c[y] * &d[x];
    (&b[0] * minor(1, 2) + &b[1] * minor(2, 0) + &b[2] * minor(0, 1)).cmp(&IBig::ZERO)
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
            assert_eq!(orientation_2d(o, x, y), Ordering::Greater);
            assert!(is_flat_triangle(o, at(1., 2., 3.), at(2., 4., 6.)));
            assert!(!is_flat_triangle(o, at(1., 2., 3.), at(2., 4., 7.)));
        }
    }

    #[test]
    fn finest_units_are_exact() {
        assert_eq!(in_finest_units(1.0), IBig::ONE << FINEST_BITS);
        assert_eq!(in_finest_units(f64::from_bits(1)), IBig::ONE);
        assert_eq!(in_finest_units(-0.75), -(IBig::from(3) << (FINEST_BITS - 2)));
    }
}
