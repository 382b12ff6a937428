//! Affine forms: functions on a box, enclosed by a linear function and a radius.
//!
//! What varies over a box is written by the two coordinates `x`, `y` of the box, from -1 to 1. Linear parts are kept, so that
//! they cancel where they cancel in the formula; the rest goes into the radius, which is therefore of second order in the
//! size of the box (de Figueiredo, Stolfi 2004). What is seen of vertices and edges is not put together from single
//! operations, but expanded by hand, with a bound of the rest of the series: `docs/theory/composite.md`.
//!
//! # Rounding
//! A rounded sum, product, quotient or root is within `EPSILON / 2` of its own size of the exact one, or within `5e-324`
//! where it underflows. [`Form::new`] takes the sizes of all that was rounded and makes up for the roundings in radii,
//! which are sums of products of non-negative numbers, fewer than sixty operations deep.
//!
//! A radius that is NaN says that nothing is known, and stays: sums and products hand it on, so no check on the way is
//! needed. (Minima and maxima, which would lose it, do not occur.)
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "what is not a number must fail")]

use std::ops::{Add, Div, Mul, Sub};

use homeo_core::number::{Interval, Rational};

use super::{Edge, Motion, Number, Sight, Swing, times};

/// All functions of `x` and `y` from -1 to 1 that are within `radius` of `middle + slopes . (x, y)`. Every operation holds every
/// exact result.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form {
    pub middle: f64,
    slopes: [f64; 2],
    radius: f64,
}

/// More than all underflows of one operation.
const TINY: f64 = 1e-290;
/// Makes up for the rounding of a radius.
const UPWARD: f64 = 1.0 + 64.0 * f64::EPSILON;
/// Boxes that come nearer to a vertex than this part of their distance are not bounded: so divisors are known well.
const LEAST_LEFT: f64 = 0.01;

impl Form {
    /// Nothing is known.
    pub const UNKNOWN: Self = Self { middle: 0.0, slopes: [0.0; 2], radius: f64::NAN };

    /// A result that was rounded by no more than `rounded * EPSILON`, with operands that were off by as much as makes
    /// `radius`.
    #[inline(always)]
    fn new(middle: f64, slopes: [f64; 2], radius: f64, rounded: f64) -> Self {
        Self { middle, slopes, radius: (radius + rounded * f64::EPSILON) * UPWARD + TINY }
    }

    /// A rational number.
    pub fn around(exact: &Rational) -> Self {
        let around = Interval::around(exact);
        Self::between(around.low(), around.high())
    }

    /// Any number from `low` to `high`.
    pub fn between(low: f64, high: f64) -> Self {
        if low == high {
            return Self::of(low);
        }
        let middle = 0.5 * low + 0.5 * high;
        Self::new(middle, [0.0; 2], (high - middle).max(middle - low), middle.abs())
    }

    /// Any number within `radius` of another.
    pub fn within(radius: f64, middle: f64) -> Self {
        Self { middle, slopes: [0.0; 2], radius }
    }

    /// The same numbers, as the coordinate of a box with the number `axis`: it moves with what depends on it.
    pub fn along(self, axis: usize) -> Self {
        let mut slopes = [0.0; 2];
        slopes[axis] = self.radius();
        // What is unknown stays so.
        Self { middle: self.middle, slopes, radius: 0.0 * self.radius }
    }

    /// The same numbers, whatever the box.
    pub fn range(self) -> Self {
        Self { middle: self.middle, slopes: [0.0; 2], radius: self.radius() }
    }

    /// How far it may be from the middle; NaN if nothing is known.
    #[inline(always)]
    pub fn radius(self) -> f64 {
        (self.varied() + self.radius) * UPWARD
    }

    /// A lower bound; NaN if nothing is known.
    #[inline(always)]
    pub fn low(self) -> f64 {
        (self.middle - self.radius()).next_down()
    }

    /// An upper bound; NaN if nothing is known.
    #[inline(always)]
    pub fn high(self) -> f64 {
        (self.middle + self.radius()).next_up()
    }

    /// An upper bound of the absolute value.
    pub fn size(self) -> f64 {
        (self.middle.abs() + self.radius()).next_up()
    }

    /// What is known to be in both, whatever the box; unknown if one is. There must be a number in common.
    pub fn meet(self, low: f64, high: f64) -> Self {
        if self.radius.is_nan() {
            self
        } else {
            Self::between(self.low().clamp(low, high), self.high().clamp(low, high))
        }
    }

    /// All numbers of both, whatever the box; unknown if one is.
    pub fn hull(self, other: Self) -> Self {
        if self.radius.is_nan() || other.radius.is_nan() {
            return Self::UNKNOWN;
        }
        Self::between(self.low().min(other.low()), self.high().max(other.high()))
    }

    /// By how much the linear part varies, rounded.
    #[inline(always)]
    fn varied(self) -> f64 {
        self.slopes[0].abs() + self.slopes[1].abs()
    }

    /// `1 / (m + d) = 1 / m - d / m^2 + d^2 / (m^2 (m + d))`: the last term has the sign of `m`, and half of what it is at most
    /// goes into the middle.
    #[inline(always)]
    fn inverse(self) -> Self {
        let inverse = 1.0 / self.middle;
        let part = self.radius() * inverse.abs();
        let left = 1.0 - part;
        if !(left > 1e-6 && inverse.is_finite()) {
            return Self::UNKNOWN;
        }
        // The difference is known to 1e-9 of itself.
        let half = 0.5 * part * part * inverse / left * (1.0 + 1e-9);
        let square = inverse * inverse;
        let radius = square * self.radius + half.abs();
        Self::new(inverse + half, self.slopes.map(|a| -square * a), radius, 8.0 * (inverse.abs() + half.abs()))
    }
}

impl Add for Form {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let middle = self.middle + other.middle;
        let slopes = [self.slopes[0] + other.slopes[0], self.slopes[1] + other.slopes[1]];
        Self::new(middle, slopes, self.radius + other.radius, middle.abs() + slopes[0].abs() + slopes[1].abs())
    }
}

impl Sub for Form {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "a difference is a sum with an opposite")]
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + other.opposite()
    }
}

impl Mul for Form {
    type Output = Self;
    /// `x^2` and `y^2` are between 0 and 1: half of what they are multiplied by goes into the middle.
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.slopes, other.slopes);
        let (m, n) = (self.middle, other.middle);
        let (first, second, mixed) = (0.5 * (a * c), 0.5 * (b * d), a * d + b * c);
        let (size, others) = (m.abs() + self.varied(), n.abs() + other.varied());
        let radius = first.abs()
            + second.abs()
            + mixed.abs()
            + size * (other.radius + 4.0 * f64::EPSILON * others)
            + self.radius * (others + other.radius);
        Self::new(m * n + (first + second), [m * c + n * a, m * d + n * b], radius, 0.0)
    }
}

impl Div for Form {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "a quotient is a product with an inverse")]
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self * other.inverse()
    }
}

impl Number for Form {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self { middle: value, slopes: [0.0; 2], radius: 0.0 }
    }
    #[inline(always)]
    fn of_form(value: Form) -> Self {
        value
    }
    #[inline(always)]
    fn by(self, factor: f64) -> Self {
        let (middle, slopes) = (self.middle * factor, self.slopes.map(|a| a * factor));
        Self::new(middle, slopes, self.radius * factor.abs(), middle.abs() + slopes[0].abs() + slopes[1].abs())
    }
    #[inline(always)]
    fn times_constant(self, constant: Self) -> Self {
        debug_assert!(constant.varied() == 0.0, "{constant:?} is no constant");
        let factor = constant.middle;
        let size = self.middle.abs() + self.varied();
        let radius = self.radius * factor.abs() + (size + self.radius) * constant.radius;
        Self::new(self.middle * factor, self.slopes.map(|a| a * factor), radius, size * factor.abs())
    }
    #[inline(always)]
    fn opposite(self) -> Self {
        Self { middle: -self.middle, slopes: self.slopes.map(|a| -a), radius: self.radius }
    }
    /// With the unit vector `u` of the middle, `|z| = u . z + (u x z)^2 / (|z| + u . z)`; the last term is between 0 and
    /// `(u x z)^2 / (2 u . z)`.
    #[inline(always)]
    fn length(x: Self, y: Self) -> Self {
        let length = f64::length(x.middle, y.middle);
        let [u, v] = [x.middle / length, y.middle / length];
        let rest = x.radius + y.radius;
        let along = [0, 1].map(|k| u * x.slopes[k] + v * y.slopes[k]);
        let across = [0, 1].map(|k| u * y.slopes[k] - v * x.slopes[k]);
        let turned = across[0].abs() + across[1].abs() + rest + 8.0 * f64::EPSILON * (x.varied() + y.varied() + length);
        let least = length * (1.0 - 16.0 * f64::EPSILON) - (along[0].abs() + along[1].abs() + rest) * UPWARD;
        // Above 1e-140 squares do not underflow by much; the difference is known well where it is not small.
        if !(least > 1e-6 * length && length > 1e-140 && length < 1e140) {
            return Self::UNKNOWN;
        }
        let half = 0.25 * turned * turned / least * (1.0 + 1e-9);
        let rounded = 8.0 * (length + half + x.varied() + y.varied());
        Self::new(length + half, along, rest + half, rounded)
    }
    fn motion([x, y]: [Self; 2]) -> Motion {
        let slopes = [0, 1].map(|k| [x.slopes[k], y.slopes[k]]);
        let rest_length = f64::length(x.radius, y.radius) * UPWARD + TINY.sqrt();
        let [first, second] = slopes.map(|[a, b]| f64::length(a, b) * UPWARD + TINY.sqrt());
        Motion { slopes, rest: [x.radius, y.radius], rest_length, reach: (first + second + rest_length) * UPWARD }
    }
    /// With `z = m (1 + w)`, `|w| <= e < 1`: `1 / |z|`, `z / |z|` and `1 / conj z` differ from `(1 - Re w) / |m|`, `(1 + i Im w) m / |m|`
    /// and `(1 - conj w) / conj m` by no more than `e^2 / (1 - e)` of their sizes.
    #[inline(always)]
    fn sight([x, y]: [Self; 2], motion: &Motion) -> Sight<Self> {
        let inverse = 1.0 / f64::length(x.middle, y.middle);
        let [u, v] = [x.middle * inverse, y.middle * inverse];
        let own = (x.radius - motion.rest[0]).abs() + (y.radius - motion.rest[1]).abs();
        let part = (motion.reach + own) * inverse * UPWARD;
        let left = 1.0 - part;
        if !(left > LEAST_LEFT && inverse > 1e-140 && inverse < 1e140) {
            let unknown = [Self::UNKNOWN; 2];
            return Sight { unit: unknown, inverse: Self::UNKNOWN, pull: unknown, slack: f64::NAN, left: f64::NAN };
        }
        let along = [0, 1].map(|k| (u * x.slopes[k] + v * y.slopes[k]) * inverse);
        let across = [0, 1].map(|k| (u * y.slopes[k] - v * x.slopes[k]) * inverse);
        let off = (x.radius + y.radius) * inverse + part * part / left + 16.0 * f64::EPSILON;
        let turned = |c: f64| across.map(|a| a * c);
        let pull = [u * inverse, v * inverse];
        let pulled = |p: f64, q: f64| [0, 1].map(|k| q * across[k] - p * along[k]);
        let far = off * inverse;
        Sight {
            unit: [Self::new(u, turned(-v), off, 0.0), Self::new(v, turned(u), off, 0.0)],
            inverse: Self::new(inverse, along.map(|a| -a * inverse), far, 0.0),
            pull: [
                Self::new(pull[0], pulled(pull[0], -pull[1]), far, 0.0),
                Self::new(pull[1], pulled(pull[1], pull[0]), far, 0.0),
            ],
            slack: own * inverse / left * UPWARD,
            left,
        }
    }
    /// The difference of `1 / (m + d)` and `1 / (n + d)` by powers of `d`: the term of order `k` has at most the size of
    /// `|m - n| / |m n|` times the sum of all products of `k` factors `|d / m|` or `|d / n|`; and that of angles, its integral.
    #[inline(always)]
    fn swing(from: &Sight<Self>, to: &Sight<Self>, edge: &Edge<Self>, motion: &Motion) -> Swing<Self> {
        let [p, q] = [from.pull, to.pull].map(|pull| pull.map(|c| c.middle));
        let pull = times(times(p, q), edge.vector.map(|c| c.middle));
        let [r, s] = [from.inverse.middle, to.inverse.middle];
        let size = edge.length * r * s * UPWARD;
        let [a, b] = [motion.reach * r * UPWARD, motion.reach * s * UPWARD];
        // Both factors are known to 1e-13 of themselves, as they are not small.
        let left = (1.0 - a) * (1.0 - b) * (1.0 - 1e-12);
        let second = times(pull, [p[0] + q[0], p[1] + q[1]]);
        // Conjugated.
        let slopes = motion.slopes.map(|[x, y]| times(second, [x, -y]));
        let rounded = 128.0 * f64::EPSILON;
        let own = from.slack * r / from.left + to.slack * s / to.left;
        let both = a + b;
        let off = own + size * ((r + s) * motion.rest_length + (both * both - a * b * (1.0 + both)) / left + rounded);
        let turned = motion.slopes.map(|[x, y]| pull[1] * x - pull[0] * y);
        let slack = from.slack + to.slack + rounded;
        let radius = size * (motion.rest_length + 0.5 * motion.reach * (both - a * b) / left) + slack;
        let component = |k: usize| Self::new(pull[k], [slopes[0][k], slopes[1][k]], off, 0.0);
        Swing { pull: [component(0), component(1)], angle: Self::new(0.0, turned, radius, 0.0) }
    }
    /// `tan(a + h) - tan a = (1 + t^2) u / (1 - t u)` with `t = tan a`, `u = tan h`; less `(1 + t^2) h` this is
    /// `(1 + t^2) (u - h + t u h) / (1 - t u)`, where `|u - h| <= 0.4 |h|^3` for `|h| <= 1/2`, and `t u h` has the sign of `t`.
    #[inline(always)]
    fn half_tangent(from: &Sight<Self>, to: &Sight<Self>, swing: &Swing<Self>) -> Self {
        let middle = super::half_tangent(from.unit.map(|c| c.middle), to.unit.map(|c| c.middle));
        let half = 0.5 * swing.angle.radius();
        if !(half < 0.5) {
            return Self::UNKNOWN;
        }
        let cube = 0.4 * half * half * half;
        let tangent = half + cube;
        let size = middle.abs();
        let left = 1.0 - size * tangent * UPWARD;
        // Known to 1e-9 of itself if it is not small.
        if !(left > 1e-6) {
            return Self::UNKNOWN;
        }
        let rate = 1.0 + middle * middle;
        let scale = rate / left * (1.0 + 1e-9);
        let shift = 0.5 * scale * size * tangent * half;
        let slopes = swing.angle.slopes.map(|a| 0.5 * rate * a);
        let radius = 0.5 * rate * swing.angle.radius + scale * cube + shift;
        Self::new(middle + shift.copysign(middle), slopes, radius, 16.0 * (size + shift + rate * half))
    }
    fn most(self) -> f64 {
        self.high()
    }
    #[inline(always)]
    fn near(self) -> f64 {
        self.middle
    }
}

#[cfg(test)]
mod tests;
