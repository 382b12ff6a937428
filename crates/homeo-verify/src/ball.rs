//! Real numbers known up to a radius, in floating point rounded outwards.
//!
//! *Rounding.* A double `m` that comes out of one operation is within `EPSILON / 2 |m|` of the exact result, or within
//! `2^-1074` if it underflows. A radius is a sum of products of numbers that are not negative, of fewer than sixteen
//! operations, so it is at least `(1 - EPSILON / 2)^16` of its exact value. [`Ball::rounded`] makes up for both. What is
//! infinite or no number stays so, and passes no comparison: nothing is claimed of it.

use std::ops::{Add, Mul, Neg, Sub};

/// All numbers within `radius` of `middle`. Operations give balls that hold all exact results.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(crate) middle: f64,
    pub(crate) radius: f64,
}

/// More than sixteen underflows.
const UNDERFLOW: f64 = 1e-300;
/// Makes up for the rounding of a radius.
const UPWARDS: f64 = 1.0 + 16.0 * f64::EPSILON;

impl Ball {
    pub(crate) const ZERO: Ball = Ball { middle: 0.0, radius: 0.0 };
    pub(crate) const ONE: Ball = Ball { middle: 1.0, radius: 0.0 };
    const UNKNOWN: Ball = Ball { middle: 0.0, radius: f64::INFINITY };

    /// A double, exactly.
    pub(crate) fn exact(value: f64) -> Ball {
        Ball { middle: value, radius: 0.0 }
    }

    /// What an operation gives whose middle was rounded once.
    fn rounded(middle: f64, radius: f64) -> Ball {
        Ball { middle, radius: (radius + middle.abs() * f64::EPSILON) * UPWARDS + UNDERFLOW }
    }

    pub(crate) fn is_positive(self) -> bool {
        self.middle > self.radius
    }

    pub(crate) fn is_negative(self) -> bool {
        -self.middle > self.radius
    }

    pub(crate) fn inverse(self) -> Ball {
        // |1/x - 1/m| = |x - m| / |x m| for x in the ball; the subtraction is rounded once.
        let least = (self.middle.abs() - self.radius) * (1.0 - f64::EPSILON);
        if !(least > 0.0 && least.is_finite()) {
            return Ball::UNKNOWN;
        }
        let middle = 1.0 / self.middle;
        Ball::rounded(middle, self.radius * middle.abs() / least)
    }

    /// The circle's number; the constant is the double next to it.
    pub(crate) fn pi() -> Ball {
        Ball { middle: std::f64::consts::PI, radius: 2.0 * f64::EPSILON }
    }

    /// The square root; unknown unless all numbers in the ball are positive.
    pub(crate) fn sqrt(self) -> Ball {
        if !self.is_positive() {
            return Ball::UNKNOWN;
        }
        // |sqrt x - sqrt m| = |x - m| / (sqrt x + sqrt m) <= r / sqrt m.
        let middle = self.middle.sqrt();
        Ball::rounded(middle, self.radius / middle)
    }

    /// The angle with this tangent, between minus and plus a quarter turn.
    pub(crate) fn arctangent(self) -> Ball {
        let mut tangent = Ball::exact(self.middle);
        for _ in 0..HALVINGS {
            // tan(a / 2) = t / (1 + sqrt(1 + t^2))
            tangent = tangent * (Ball::ONE + (Ball::ONE + tangent * tangent).sqrt()).inverse();
        }
        let square = tangent * tangent;
        let mut sum = Ball::ZERO;
        for k in (0..TERMS).rev() {
            sum = Ball::exact(f64::from(2 * k + 1)).inverse() - sum * square;
        }
        // The series alternates: what is left out is below its first term, |t| 0.1^20 / 21.
        sum.radius += 1e-21;
        let middle = sum * tangent * Ball::exact(f64::from(1 << HALVINGS));
        // The slope is 1 / (1 + x^2).
        let least = ((self.middle.abs() - self.radius) * (1.0 - f64::EPSILON)).max(0.0);
        let radius = middle.radius + self.radius / (1.0 + least * least);
        Ball { middle: middle.middle, radius: radius * UPWARDS }
    }
}

/// Halvings of an angle: from a quarter turn to less than 0.0982, whose tangent is below 0.1.
const HALVINGS: u32 = 4;
/// Terms of the arctangent's series.
const TERMS: u32 = 10;

impl Add for Ball {
    type Output = Ball;
    fn add(self, other: Ball) -> Ball {
        Ball::rounded(self.middle + other.middle, self.radius + other.radius)
    }
}

impl Neg for Ball {
    type Output = Ball;
    fn neg(self) -> Ball {
        Ball { middle: -self.middle, radius: self.radius }
    }
}

impl Sub for Ball {
    type Output = Ball;
    fn sub(self, other: Ball) -> Ball {
        self + -other
    }
}

impl Mul for Ball {
    type Output = Ball;
    fn mul(self, other: Ball) -> Ball {
        let radius = self.middle.abs() * other.radius + self.radius * (other.middle.abs() + other.radius);
        Ball::rounded(self.middle * other.middle, radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_ratio::RBig;

    fn exact(x: f64) -> RBig {
        RBig::try_from(x).expect("finite")
    }

    /// Whether a ball holds a rational number, exactly; nothing known is no answer.
    fn holds(ball: Ball, number: &RBig) -> Option<bool> {
        (ball.radius.is_finite() && ball.middle.is_finite()).then(|| {
            let gap = number - exact(ball.middle);
            let size = if gap < RBig::ZERO { -gap } else { gap };
            size <= exact(ball.radius)
        })
    }

    /// Doubles of many sizes, from a fixed seed.
    fn doubles() -> Vec<f64> {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            state >> 11
        };
        let mut made: Vec<f64> =
            (0..70).map(|_| (next() as f64 / 2f64.powi(52) - 1.0) * 2f64.powi((next() % 300) as i32 - 150)).collect();
        made.extend([0.0, 1.0, -1.0, 3.0, f64::MIN_POSITIVE, 1e200, -1e-200]);
        made
    }

    #[test]
    fn results_are_in_their_balls() {
        let mut answers = 0;
        for &x in &doubles() {
            for &y in &doubles() {
                // One end of a wide ball round y.
                let wide = Ball { middle: y, radius: x.abs() / 4.0 };
                let (p, q) = (exact(x), exact(y) + exact(x.abs() / 4.0));
                let mut check = |ball: Ball, number: RBig| {
                    let answer = holds(ball, &number);
                    assert_ne!(answer, Some(false), "{x} {y}");
                    answers += usize::from(answer.is_some());
                };
                check(Ball::exact(x) + wide, &p + &q);
                check(Ball::exact(x) - wide, &p - &q);
                check(Ball::exact(x) * wide, &p * &q);
                check(wide * wide, &q * &q);
                if q != RBig::ZERO {
                    check(wide.inverse(), RBig::ONE / &q);
                }
            }
        }
        assert!(answers > 20_000, "{answers}");
    }

    #[test]
    fn signs_are_claimed_only_when_known() {
        let between = |low: f64, high: f64| Ball { middle: 0.5 * (low + high), radius: 0.5 * (high - low) };
        assert!(between(0.5, 2.0).is_positive() && between(-2.0, -0.5).is_negative());
        for ball in [between(0.0, 1.0), Ball::UNKNOWN, Ball { middle: f64::NAN, radius: 1.0 }, Ball::ZERO] {
            assert!(!ball.is_positive() && !ball.is_negative());
            assert!(!(ball.inverse() * ball).is_negative() && !ball.inverse().is_positive());
        }
    }

    #[test]
    fn roots_and_angles_are_in_their_balls() {
        let mut count = 0;
        for &x in doubles().iter().filter(|x| (1e-20..1e20).contains(&x.abs())) {
            let root = Ball::exact(x.abs()).sqrt();
            assert_eq!(holds(root * root, &exact(x.abs())), Some(true), "{x}");
            // The addition theorem, and no other: arctan x + arctan(1/x) is a quarter turn.
            let sum = Ball::exact(x.abs()).arctangent() + Ball::exact(x.abs()).inverse().arctangent();
            let gap = sum + sum - Ball::pi();
            assert!(gap.middle.abs() <= gap.radius && gap.radius < 1e-13, "{x} {gap:?}");
            assert!((Ball::exact(x).arctangent().middle - x.atan()).abs() < 1e-14);
            count += 1;
        }
        assert!(count > 5, "{count}");
        assert!(!Ball::ZERO.sqrt().is_positive() && !Ball { middle: 0.5, radius: 1.5 }.sqrt().is_positive());
    }
}
