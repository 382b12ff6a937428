//! Numbers that a chart is evaluated with: doubles, and disks of reals that hold the exact result.

use std::ops::{Add, Div, Mul, Sub};

use homeo_core::number::{Interval, Rational};

/// What the formulas of a chart need: the four operations, and lengths.
pub(super) trait Number:
    Copy + Send + Sync + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// A stored number, exactly.
    fn of(value: f64) -> Self;
    /// A number that is known by an enclosure.
    fn of_ball(value: Ball) -> Self;
    /// Length of a vector.
    fn length(x: Self, y: Self) -> Self;
    /// A number near it, by which one of two equal formulas is chosen.
    fn near(self) -> f64;
    /// Its opposite.
    fn opposite(self) -> Self;
}

impl Number for f64 {
    fn of(value: f64) -> Self {
        value
    }
    fn of_ball(value: Ball) -> Self {
        value.middle
    }
    fn length(x: Self, y: Self) -> Self {
        (x * x + y * y).sqrt()
    }
    fn near(self) -> f64 {
        self
    }
    fn opposite(self) -> Self {
        -self
    }
}

/// All reals within `radius` of `middle`. Every operation holds every exact result.
///
/// A radius that is NaN says that nothing is known, and stays: sums and products hand it on, so no check on the way is
/// needed. (Minima and maxima, which would lose it, do not occur.)
///
/// # Rounding
/// A rounded sum, product, quotient or root `m` is within `EPSILON / 2 |m|` of the exact one, or within `5e-324` where it
/// underflows. Radii are sums of products of non-negative numbers, at most eight operations deep, so each is at least
/// `(1 - EPSILON / 2)^8` of its exact value. [`Ball::new`] makes up for both. Middle and radius take fewer operations than
/// lower and upper end do, and no branches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub middle: f64,
    pub radius: f64,
}

/// More than all underflows of one operation.
const TINY: f64 = 1e-290;
/// Makes up for the rounding of up to eight operations with non-negative numbers.
const UPWARD: f64 = 1.0 + 8.0 * f64::EPSILON;

impl Ball {
    /// Nothing is known.
    pub const UNKNOWN: Self = Self { middle: 0.0, radius: f64::NAN };

    /// A result rounded to `middle` whose operands were off by as much as makes `radius`.
    #[inline(always)]
    fn new(middle: f64, radius: f64) -> Self {
        Self { middle, radius: (radius + middle.abs() * f64::EPSILON) * UPWARD + TINY }
    }

    /// A ball that holds a rational number.
    pub fn around(exact: &Rational) -> Self {
        let around = Interval::around(exact);
        Self::between(around.low(), around.high())
    }

    /// A ball that holds all numbers from `low` to `high`.
    pub fn between(low: f64, high: f64) -> Self {
        let middle = 0.5 * low + 0.5 * high;
        let radius = (high - middle).max(middle - low);
        if low == high { Self { middle: low, radius: 0.0 } } else { Self::new(middle, radius) }
    }

    /// A lower bound; NaN if nothing is known.
    #[inline(always)]
    pub fn low(self) -> f64 {
        (self.middle - self.radius).next_down()
    }

    /// An upper bound; NaN if nothing is known.
    #[inline(always)]
    pub fn high(self) -> f64 {
        (self.middle + self.radius).next_up()
    }

    /// An upper bound of the absolute value.
    pub fn size(self) -> f64 {
        (self.middle.abs() + self.radius).next_up()
    }

    /// What is known to be in both; unknown if one is. The balls must have a number in common.
    pub fn meet(self, low: f64, high: f64) -> Self {
        if self.radius.is_nan() { self } else { Self::between(self.low().clamp(low, high), self.high().clamp(low, high)) }
    }

    /// A ball that holds both; unknown if one is.
    pub fn hull(self, other: Self) -> Self {
        if self.radius.is_nan() || other.radius.is_nan() {
            return Self::UNKNOWN;
        }
        Self::between(self.low().min(other.low()), self.high().max(other.high()))
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        let least = (self.middle.abs() - self.radius).next_down();
        if !(least > 0.0 && self.radius.is_finite()) {
            return Self::UNKNOWN;
        }
        // |1/x - 1/m| = |x - m| / |x m|.
        let middle = 1.0 / self.middle;
        Self::new(middle, self.radius * middle.abs() / least)
    }
}

impl Add for Ball {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.middle + other.middle, self.radius + other.radius)
    }
}

impl Sub for Ball {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.middle - other.middle, self.radius + other.radius)
    }
}

impl Mul for Ball {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let radius = self.middle.abs() * other.radius + self.radius * (other.middle.abs() + other.radius);
        Self::new(self.middle * other.middle, radius)
    }
}

impl Div for Ball {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self * other.inverse()
    }
}

impl Number for Ball {
    fn of(value: f64) -> Self {
        Self { middle: value, radius: 0.0 }
    }
    #[inline(always)]
    fn of_ball(value: Ball) -> Self {
        value
    }
    /// Lengths change no faster than vectors do.
    #[inline(always)]
    fn length(x: Self, y: Self) -> Self {
        let middle = (x.middle * x.middle + y.middle * y.middle).sqrt();
        // Three roundings under the root, where an underflow of 5e-324 may grow to 1e-161, and one of it.
        let radius = (x.radius * x.radius + y.radius * y.radius).sqrt() + 1e-150 + middle * (2.0 * f64::EPSILON);
        Self::new(middle, radius)
    }
    #[inline(always)]
    fn near(self) -> f64 {
        self.middle
    }
    #[inline(always)]
    fn opposite(self) -> Self {
        Self { middle: -self.middle, radius: self.radius }
    }
}



#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of many magnitudes, from a fixed seed.
    fn numbers() -> Vec<f64> {
        let mut state = 11u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state >> 11
        };
        let mut made: Vec<f64> = (0..60)
            .map(|_| (next() as f64 / 2f64.powi(52) - 1.0) * 2f64.powi((next() % 400) as i32 - 200))
            .collect();
        made.extend([0.0, 1.0, -3.0, f64::MIN_POSITIVE, 5e-324, 1e300, -1e300]);
        made
    }

    fn holds(ball: Ball, exact: &Rational) -> bool {
        let end = |x: f64| Rational::from_f64(x);
        ball.radius.is_nan()
            || (end(ball.low()).is_none_or(|low| low <= *exact) && end(ball.high()).is_none_or(|high| *exact <= high))
    }

    #[test]
    fn exact_results_are_inside() {
        let numbers = numbers();
        let mut known = 0;
        for &x in &numbers {
            for &y in &numbers {
                // Wide operands: y within a ball of radius |x|, by one of its ends.
                let wide = Ball { middle: y, radius: x.abs() };
                let (p, q) = (Rational::from_f64(x).unwrap(), Rational::from_f64(y).unwrap());
                let end = &q + &p;
                let point = Ball::of(x);
                assert!(holds(point + wide, &(&p + &end)), "{x} + ({y} + {x})");
                assert!(holds(point - wide, &(&p - &end)), "{x} - ({y} + {x})");
                assert!(holds(wide * wide, &(&end * &end)), "({y} + {x})^2");
                assert!(holds(point * wide, &(&p * &end)), "{x} * ({y} + {x})");
                let quotient = point / wide;
                if !end.is_zero() {
                    assert!(holds(quotient, &(&p / &end)), "{x} / ({y} + {x})");
                    known += usize::from(!quotient.radius.is_nan());
                }
                let length = Ball::length(point, wide);
                if length.low() > 0.0 {
                    let square = &(&p * &p) + &(&end * &end);
                    let low = Rational::from_f64(length.low()).unwrap();
                    assert!(&low * &low <= square, "|{x}, {y} + {x}|");
                }
            }
        }
        assert!(known > 1000, "most quotients of points are known: {known}");
    }

    #[test]
    fn what_is_unknown_stays_so() {
        let unknown = Ball::of(1.0) / Ball { middle: 1.0, radius: 1.0 };
        assert!(unknown.radius.is_nan());
        for other in [Ball::of(0.0), Ball::of(1e300), Ball { middle: 1.0, radius: f64::INFINITY }] {
            for result in [unknown + other, other - unknown, unknown * other, other / unknown, Ball::length(unknown, other)] {
                assert!(result.radius.is_nan() && !(result.low() > 0.0) && !(result.high() < 0.0));
            }
        }
        let infinite = Ball::of(1e300) * Ball::of(1e300);
        assert!(!(infinite.low() > 0.0), "an overflow is no number: {infinite:?}");
    }
}
