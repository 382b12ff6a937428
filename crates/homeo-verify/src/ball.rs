//! Real numbers known up to a radius, and functions with two derivatives, in floating point rounded outwards.
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

    /// All numbers from `low` to `high`.
    pub(crate) fn between(low: f64, high: f64) -> Ball {
        Ball::rounded(0.5 * low + 0.5 * high, 0.5 * (high - low))
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

/// A vector of the plane.
pub(crate) type Vector = [Ball; 2];

pub(crate) fn vector(of: impl Fn(usize) -> Ball) -> Vector {
    [of(0), of(1)]
}

/// The length of a vector, which changes no faster than the vector does.
pub(crate) fn length([x, y]: Vector) -> Ball {
    let hypotenuse = |a: f64, b: f64| (a * a + b * b).sqrt();
    // Squares that underflow are far below the square of this, three more roundings below two units in the last place.
    let radius = hypotenuse(x.radius, y.radius) + 1e-150;
    let middle = hypotenuse(x.middle, y.middle);
    Ball::rounded(middle, radius + 2.0 * f64::EPSILON * middle)
}

pub(crate) fn dot(a: Vector, b: Vector) -> Ball {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Ball {
    a[0] * b[1] - a[1] * b[0]
}

/// The value of a function at a point, and its derivatives along two directions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dual(pub(crate) [Ball; 3]);

impl Dual {
    pub(crate) const ZERO: Dual = Dual([Ball::ZERO; 3]);

    /// A constant.
    pub(crate) fn constant(value: Ball) -> Dual {
        Dual([value, Ball::ZERO, Ball::ZERO])
    }

    pub(crate) fn scaled(self, factor: Ball) -> Dual {
        Dual(self.0.map(|x| x * factor))
    }

    /// The quotient: `(a / b)' = (a' - (a / b) b') / b`.
    pub(crate) fn over(self, other: Dual) -> Dual {
        let inverse = other.0[0].inverse();
        let value = self.0[0] * inverse;
        let slope = |k: usize| (self.0[k] - value * other.0[k]) * inverse;
        Dual([value, slope(1), slope(2)])
    }
}

impl Add for Dual {
    type Output = Dual;
    fn add(self, other: Dual) -> Dual {
        Dual([0, 1, 2].map(|k| self.0[k] + other.0[k]))
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual(self.0.map(Ball::neg))
    }
}

impl Sub for Dual {
    type Output = Dual;
    fn sub(self, other: Dual) -> Dual {
        self + -other
    }
}

impl Mul for Dual {
    type Output = Dual;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule has a sum")]
    fn mul(self, other: Dual) -> Dual {
        let ([a, ..], [b, ..]) = (self.0, other.0);
        let slope = |k: usize| a * other.0[k] + self.0[k] * b;
        Dual([a * b, slope(1), slope(2)])
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
                // Three and four make five.
                let five = length([wide * Ball::exact(3.0), wide * Ball::exact(-4.0)]);
                check(five, exact(5.0) * if q < RBig::ZERO { -q } else { q });
            }
        }
        assert!(answers > 20_000, "{answers}");
    }

    #[test]
    fn signs_are_claimed_only_when_known() {
        assert!(Ball::between(0.5, 2.0).is_positive() && Ball::between(-2.0, -0.5).is_negative());
        for ball in [Ball::between(0.0, 1.0), Ball::UNKNOWN, Ball { middle: f64::NAN, radius: 1.0 }, Ball::ZERO] {
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
        assert!(!Ball::ZERO.sqrt().is_positive() && !Ball::between(-1.0, 2.0).sqrt().is_positive());
    }

    #[test]
    fn derivatives_follow_the_rules() {
        // u = 3 + 2 a, v = 5 - b, at a = b = 0.
        let (u, v) = (Dual([3.0, 2.0, 0.0].map(Ball::exact)), Dual([5.0, 0.0, -1.0].map(Ball::exact)));
        let near = |found: Dual, wanted: [f64; 3]| {
            assert!((0..3).all(|k| (found.0[k].middle - wanted[k]).abs() <= found.0[k].radius + 1e-15), "{found:?}");
        };
        near(u * v, [15.0, 10.0, -3.0]);
        near(u.over(v), [0.6, 0.4, 0.12]);
        near(u - v.scaled(Ball::exact(2.0)), [-7.0, 2.0, 2.0]);
    }
}
