//! Intervals that hold the exact value, whatever was rounded.

use super::{Rational, Scalar};
use crate::predicate::Sign;

/// All numbers from `low` to `high`. Operations round outwards, so the result holds every exact result; what is certainly
/// zero stays so.
///
/// A result that nothing is known about (after a division by an interval that holds 0, say) is the [whole
/// line](Self::WHOLE).
///
/// ```
/// use homeo_core::number::{Interval, Scalar};
/// let third = Interval::from_f64(1.0).divide(&Interval::from_f64(3.0));
/// assert!(third.low() < third.high() && third.high() - third.low() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    /// All numbers: nothing is known.
    pub const WHOLE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// An interval round an exact number; a point where the number is a double.
    pub fn around(exact: &Rational) -> Self {
        let near = exact.to_f64();
        let is_exact = Rational::from_f64(near).is_some_and(|there| there == *exact);
        if is_exact { Self::from_f64(near) } else { Self::outward(near, near) }
    }

    /// The smallest interval that holds all numbers of both.
    #[must_use]
    pub fn hull_with(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The least number in it.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// The largest number in it.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// A number in the middle, and how far from it the ends are; the second is infinite where nothing is known.
    ///
    /// ```
    /// use homeo_core::number::{Interval, Scalar};
    /// assert_eq!(Interval::from_f64(0.5).middle_and_radius(), (0.5, 0.0));
    /// assert_eq!(Interval::WHOLE.middle_and_radius().1, f64::INFINITY);
    /// ```
    pub fn middle_and_radius(&self) -> (f64, f64) {
        if self.low == self.high {
            return (self.low, 0.0);
        }
        let middle = 0.5 * self.low + 0.5 * self.high;
        if middle.is_finite() {
            (middle, (self.high - middle).max(middle - self.low).next_up())
        } else {
            (0.0, f64::INFINITY)
        }
    }

    fn is_zero(&self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }

    /// The smallest interval between rounded ends, one step further out on either side.
    fn outward(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() { Self::WHOLE } else { Self { low: low.next_down(), high: high.next_up() } }
    }

    /// The least and largest of some rounded numbers, and a step further; the whole line if one of them is none.
    fn hull(rounded: [f64; 4]) -> Self {
        if rounded.iter().any(|x| x.is_nan()) {
            return Self::WHOLE;
        }
        let [a, b, c, d] = rounded;
        Self::outward(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
}

impl Scalar for Interval {
    /// The interval that holds just `value`; the whole line for NaN.
    fn from_f64(value: f64) -> Self {
        if value.is_nan() { Self::WHOLE } else { Self { low: value, high: value } }
    }

    fn plus(&self, other: &Self) -> Self {
        if self.is_zero() {
            return *other;
        }
        if other.is_zero() {
            return *self;
        }
        Self::outward(self.low + other.low, self.high + other.high)
    }

    fn minus(&self, other: &Self) -> Self {
        if other.is_zero() {
            return *self;
        }
        if self.is_zero() {
            return Self { low: -other.high, high: -other.low };
        }
        Self::outward(self.low - other.high, self.high - other.low)
    }

    fn times(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::from_f64(0.0);
        }
        let (a, b) = (self, other);
        Self::hull([a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high])
    }

    fn divide(&self, other: &Self) -> Self {
        if !matches!(other.sign(), Some(Sign::Positive | Sign::Negative)) {
            return Self::WHOLE;
        }
        if self.is_zero() {
            return *self;
        }
        let (a, b) = (self, other);
        Self::hull([a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high])
    }

    /// The sign that all numbers in it have; `None` if they differ.
    fn sign(&self) -> Option<Sign> {
        if self.low > 0.0 {
            Some(Sign::Positive)
        } else if self.high < 0.0 {
            Some(Sign::Negative)
        } else if self.is_zero() {
            Some(Sign::Zero)
        } else {
            None
        }
    }

    fn enclosure(&self) -> Interval {
        *self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holds(interval: Interval, exact: &Rational) -> bool {
        let end = |x: f64| Rational::from_f64(x);
        end(interval.low).is_none_or(|low| low <= *exact) && end(interval.high).is_none_or(|high| *exact <= high)
    }

    /// Numbers of all magnitudes, from a fixed seed.
    fn numbers() -> Vec<f64> {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state >> 11
        };
        let mut made: Vec<f64> =
            (0..60).map(|_| (next() as f64 / 2f64.powi(52) - 1.0) * 2f64.powi((next() % 600) as i32 - 300)).collect();
        made.extend([0.0, -0.0, 1.0, 3.0, f64::MAX, f64::MIN_POSITIVE, 5e-324]);
        made
    }

    #[test]
    fn the_exact_result_is_inside() {
        let numbers = numbers();
        let mut count = 0;
        for &x in &numbers {
            for &y in &numbers {
                let (a, b) = (Interval::from_f64(x), Interval::from_f64(y));
                let (p, q) = (Rational::from_f64(x).unwrap(), Rational::from_f64(y).unwrap());
                assert!(holds(a.plus(&b), &(&p + &q)), "{x} + {y}");
                assert!(holds(a.minus(&b), &(&p - &q)), "{x} - {y}");
                assert!(holds(a.times(&b), &(&p * &q)), "{x} * {y}");
                // Of results: intervals with a width.
                let (c, r) = (a.plus(&b), &p + &q);
                assert!(holds(c.times(&a.minus(&b)), &(&r * &(&p - &q))), "({x} + {y}) * ({x} - {y})");
                if y != 0.0 {
                    assert!(holds(a.divide(&b), &(&p / &q)), "{x} / {y}");
                    assert!(holds(c.divide(&b), &(&r / &q)), "({x} + {y}) / {y}");
                }
                count += 1;
            }
        }
        assert_eq!(count, 67 * 67);
    }

    #[test]
    fn signs_are_said_only_where_they_are_certain() {
        let (one, tiny) = (Interval::from_f64(1.0), Interval::from_f64(1e-30));
        assert_eq!(one.sign(), Some(Sign::Positive));
        assert_eq!(one.minus(&one.plus(&tiny)).sign(), None, "1 - (1 + 1e-30) is below 0, and too near to tell");
        assert_eq!(Interval::from_f64(-0.0).sign(), Some(Sign::Zero));
        assert_eq!(one.divide(&one.minus(&one)), Interval::WHOLE);
        assert_eq!(Interval::WHOLE.times(&Interval::WHOLE).sign(), None);
        assert_eq!(Interval::from_f64(f64::NAN), Interval::WHOLE);
    }
}
