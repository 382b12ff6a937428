//! Integrals of the logarithmic kernel and of its normal derivative over a straight element, in closed form.
//!
//! In the frame of an element `t` runs from -1 to 1 along it and the point is the complex number `z`; the domain is above.
//! With `C_k = integral of t^k / (z - t)`, where `C_0 = ln((z + 1) / (z - 1))` and `C_{k+1} = z C_k - integral of t^k`,
//! the normal derivative of `-ln |x - y| / 2 pi` integrates to `Im C_k / 2 pi`, and by parts the logarithm to
//! `(ln(z - 1) + (-1)^k ln(z + 1) + C_{k+1}) / (k + 1)`. On the element itself the imaginary part of `C_0` is `-pi`, its
//! limit from above: all formulas hold on the boundary as limits from inside.

use faer::c64;
use std::f64::consts::TAU;

/// From this square of the distance on, in half lengths, series are summed: the recursion would lose digits.
const FAR: f64 = 36.0;

/// Terms of the series: `FAR` to the minus this is below rounding.
const TERMS: usize = 10;

/// Integrals of `t^k` times the kernels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    /// Of the kernel, `k = 0, 1`.
    pub single: [f64; 2],
    /// Of its derivative along the outer normal, `k = 0, 1, 2`.
    pub double: [f64; 3],
}

/// A point as an element sees it, in half lengths: how far ahead of the element's beginning and of its end it is, and how
/// far above, which is not `-0`. Beside either end these are small and known to their last digits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    pub left: f64,
    pub right: f64,
    pub height: f64,
}

impl Local {
    fn z(self) -> c64 {
        c64::new(0.5 * (self.left + self.right), self.height)
    }
}

/// `C_0`, `C_1` and `C_2` at a point.
pub(super) fn cauchy(local: Local) -> [c64; 3] {
    let z = local.z();
    let squared = z.re * z.re + z.im * z.im;
    if squared > FAR {
        let inverse = c64::new(z.re / squared, -z.im / squared);
        let w = inverse * inverse;
        let sum = (1..=TERMS).rev().fold(c64::new(0.0, 0.0), |sum, k| w * (sum + 2.0 / (2 * k + 1) as f64));
        return [(sum + 2.0) * inverse, sum, sum * z];
    }
    let Local { left, right, .. } = local;
    let height = z.im * z.im;
    let modulus = 0.5 * ((left * left + height) / (right * right + height)).ln();
    let argument = f64::atan2(-2.0 * z.im, left * right + height);
    let first = c64::new(modulus, argument);
    let second = z * first - 2.0;
    [first, second, z * second]
}

/// All integrals, over an element of a half length.
pub(super) fn moments(local: Local, half: f64) -> Moments {
    let [zeroth, first, second] = cauchy(local);
    let height = local.height * local.height;
    let (left, right) = (local.left * local.left + height, local.right * local.right + height);
    let logarithm = 0.5 * (left * right).ln() + 2.0 * half.ln();
    Moments {
        single: [-half * (logarithm + first.re) / TAU, 0.5 * half * (zeroth.re - second.re) / TAU],
        double: [zeroth.im / TAU, first.im / TAU, second.im / TAU],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(z: c64) -> Local {
        Local { left: z.re + 1.0, right: z.re - 1.0, height: z.im }
    }

    /// Midpoint sums of the definitions.
    fn by_sums(z: c64, half: f64) -> Moments {
        let n = 200_000;
        let (mut single, mut double) = ([0.0; 2], [0.0; 3]);
        for i in 0..n {
            let t = (2 * i + 1) as f64 / n as f64 - 1.0;
            let (dx, dy) = (z.re - t, z.im);
            let weight = 2.0 / n as f64;
            let kernel = -((dx * dx + dy * dy).sqrt() * half).ln() / TAU;
            // The outer normal is (0, -1): the derivative by y of -ln |z - y| / 2 pi along it.
            let derivative = -dy / (dx * dx + dy * dy) / TAU;
            (0..2).for_each(|k| single[k] += weight * half * kernel * t.powi(k as i32));
            (0..3).for_each(|k| double[k] += weight * derivative * t.powi(k as i32));
        }
        Moments { single, double }
    }

    fn miss(a: &Moments, b: &Moments) -> f64 {
        let pairs = a.single.iter().zip(&b.single).chain(a.double.iter().zip(&b.double));
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn closed_forms_are_the_integrals() {
        let mut tried = 0;
        for (x, y) in [(0.3, 0.5), (-0.7, 0.2), (1.5, 1.0), (5.9, 0.8), (6.1, 0.8), (-30.0, 40.0), (0.2, -0.6)] {
            let z = c64::new(x, y);
            let truth = by_sums(z, 0.37);
            assert!(miss(&moments(at(z), 0.37), &truth) < 1e-9, "{x} {y}: {:?} {truth:?}", moments(at(z), 0.37));
            // The control: the kernel of the wrong sign, and the point mirrored.
            assert!(miss(&moments(at(-z), 0.37), &truth) > 1e-5);
            tried += 1;
        }
        assert_eq!(tried, 7);
    }

    #[test]
    fn limits_from_above_are_those_of_the_element() {
        for x in [-0.99, -0.3, 0.0, 0.6] {
            let (on, above) = (moments(at(c64::new(x, 0.0)), 0.5), moments(at(c64::new(x, 1e-13)), 0.5));
            assert!(miss(&on, &above) < 1e-11 && (on.double[0] + 0.5).abs() < 1e-15);
            assert!(miss(&on, &moments(at(c64::new(x, -1e-13)), 0.5)) > 0.1);
        }
    }
}
