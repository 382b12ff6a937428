//! Numbers that a chart is evaluated with: doubles, and disks of reals that hold the exact result.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "what is not a number must fail")]

use std::ops::{Add, Div, Mul, Sub};

use homeo_core::number::{Interval, Rational};

/// What the formulas of a chart need: the four operations, and lengths.
pub(crate) trait Number:
    Copy + Send + Sync + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// A stored number, exactly.
    fn of(value: f64) -> Self;
    /// A number that is known by an enclosure.
    fn of_ball(value: Ball) -> Self;
    /// Length of a vector.
    fn length(x: Self, y: Self) -> Self;
    /// What is seen of a vertex that lies by `vector`, not zero, from the point one looks from; of which `common` is what
    /// is the same for all vertices: where the point is.
    fn sight(vector: [Self; 2], common: [Self; 2]) -> Sight<Self>;
    /// `tan(α / 2)` of the angle from one vertex to another, seen from a point that is within `reach` of the middle of
    /// where it may be; the vertices are no further apart than `length`.
    fn half_tangent(from: &Sight<Self>, to: &Sight<Self>, length: f64, reach: f64) -> Self;
    /// Sine and cosine of the same angle.
    fn sine_cosine(from: &Sight<Self>, to: &Sight<Self>, length: f64, reach: f64) -> [Self; 2];
    /// How far from the middle a vector may be.
    fn reach(vector: [Self; 2]) -> f64;
    /// A number that is not smaller.
    fn most(self) -> f64;
    /// A number near it, by which one of two equal formulas is chosen.
    fn near(self) -> f64;

    /// Its opposite.
    fn opposite(self) -> Self;
}

/// What of a vertex is seen from a point.
#[derive(Clone, Copy)]
pub(crate) struct Sight<T> {
    /// Unit vector towards it.
    pub unit: [T; 2],
    /// One over its distance.
    pub inverse: T,
    /// The product of both: the gradient of `log (1 / distance)`; turned by a right angle, that of the direction.
    pub pull: [T; 2],
    /// By how large an angle its direction may be off for other reasons than where the point is.
    pub slack: f64,
    /// At least `1 / sqrt(r (r - d))`, where `r` is its distance from the middle and the point within `d` of it.
    pub width: f64,
}

/// Sine and cosine of the angle from one unit vector to another.
#[inline(always)]
pub(crate) fn sine_cosine<T: Number>(from: [T; 2], to: [T; 2]) -> [T; 2] {
    [from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]]
}

/// `tan(α / 2)` of the angle from one unit vector to another, by that of two equal formulas whose divisor is not small.
#[inline(always)]
pub(crate) fn half_tangent<T: Number>(from: [T; 2], to: [T; 2]) -> T {
    let [sine, cosine] = sine_cosine(from, to);
    let one = T::of(1.0);
    if cosine.near() < 0.0 { (one - cosine) / sine } else { sine / (one + cosine) }
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
    fn sight([x, y]: [Self; 2], _: [Self; 2]) -> Sight<Self> {
        let inverse = 1.0 / Self::length(x, y);
        let unit = [x * inverse, y * inverse];
        Sight { unit, inverse, pull: unit.map(|c| c * inverse), slack: 0.0, width: 0.0 }
    }
    #[inline(always)]
    fn half_tangent(from: &Sight<Self>, to: &Sight<Self>, _: f64, _: f64) -> Self {
        half_tangent(from.unit, to.unit)
    }
    fn sine_cosine(from: &Sight<Self>, to: &Sight<Self>, _: f64, _: f64) -> [Self; 2] {
        sine_cosine(from.unit, to.unit)
    }
    fn reach(_: [Self; 2]) -> f64 {
        0.0
    }
    fn most(self) -> f64 {
        self
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
pub(crate) struct Ball {
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
        if self.radius.is_nan() {
            self
        } else {
            Self::between(self.low().clamp(low, high), self.high().clamp(low, high))
        }
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
    #[allow(clippy::suspicious_arithmetic_impl, reason = "a quotient is a product with an inverse")]
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
    /// A disk of vectors round `m`, of radius `d`, with `|m| = r > d`: directions differ from that of `m` by an angle whose
    /// sine is `d / r` at most, and `v / |v|^2`, the inversion, from that of `m` by `|v - m| / (|v| |m|)`.
    #[inline(always)]
    fn sight([x, y]: [Self; 2], common: [Self; 2]) -> Sight<Self> {
        let reach = Self::reach([x, y]);
        let length = (x.middle * x.middle + y.middle * y.middle).sqrt();
        let least = (length - reach) * (1.0 - 16.0 * f64::EPSILON) - 1e-150;
        if !(least > 0.0 && length < 1e150) {
            return Sight {
                unit: [Self::UNKNOWN; 2],
                inverse: Self::UNKNOWN,
                pull: [Self::UNKNOWN; 2],
                slack: f64::NAN,
                width: f64::NAN,
            };
        }
        let inverse = 1.0 / length;
        let unit = [x.middle * inverse, y.middle * inverse];
        // Middles are rounded four times.
        let relative = reach / least + 8.0 * f64::EPSILON;
        let turned = reach * inverse + 8.0 * f64::EPSILON;
        let rounded = |value: f64, other: f64| {
            Self::new(value, (other.abs() + value.abs() * turned) * turned + 8.0 * f64::EPSILON)
        };
        let own = (x.radius - common[0].radius).abs() + (y.radius - common[1].radius).abs();
        // Distances at the middle, and at the end of a path from there.
        let at_middle = (length - own) * (1.0 - 16.0 * f64::EPSILON) - 1e-150;
        let at_end = ((length - reach - own) * (1.0 - 16.0 * f64::EPSILON) - 1e-150).max(0.0);
        Sight {
            width: UPWARD / (at_middle * at_end).sqrt(),
            unit: [rounded(unit[0], unit[1]), rounded(unit[1], unit[0])],
            inverse: Self::new(inverse, relative * inverse),
            pull: unit.map(|c| Self::new(c * inverse, relative * inverse)),
            slack: (own + reach * (4.0 * f64::EPSILON)) / least,
        }
    }
    #[inline(always)]
    fn half_tangent(from: &Sight<Self>, to: &Sight<Self>, length: f64, reach: f64) -> Self {
        let [[a, b], [c, d]] = [from, to].map(|sight| sight.unit.map(|c| c.middle));
        let (cosine, sine) = (a * c + b * d, a * d - b * c);
        let middle = if cosine < 0.0 { (1.0 - cosine) / sine } else { sine / (1.0 + cosine) };
        let half = 0.5 * spread(from, to, length, reach);
        if !(half < 0.5) {
            return Self::UNKNOWN;
        }
        // tan h <= h (1 + h^2 / 2) for h < 1/2; |tan(a + h) - tan a| <= (1 + tan^2 a) tan h / (1 - |tan a| tan h).
        let tangent = half * (1.0 + 0.5 * half * half) * UPWARD;
        let left = 1.0 - middle.abs() * tangent * UPWARD;
        if !(left > 0.0) {
            return Self::UNKNOWN;
        }
        Self::new(middle, (1.0 + middle * middle) * tangent / (left * (1.0 - 8.0 * f64::EPSILON)))
    }
    /// `|sin(a + h) - sin a| <= |cos a| h + |sin a| h^2 / 2`, and the other way round.
    #[inline(always)]
    fn sine_cosine(from: &Sight<Self>, to: &Sight<Self>, length: f64, reach: f64) -> [Self; 2] {
        let [sine, cosine] = sine_cosine(from.unit.map(|c| c.middle), to.unit.map(|c| c.middle));
        let angle = spread(from, to, length, reach);
        let ball = |value: f64, other: f64| Self::new(value, (other.abs() + value.abs() * angle) * angle);
        [ball(sine, cosine), ball(cosine, sine)]
    }
    #[inline(always)]
    fn reach([x, y]: [Self; 2]) -> f64 {
        (x.radius * x.radius + y.radius * y.radius).sqrt() * UPWARD + 1e-150
    }
    fn most(self) -> f64 {
        self.high()
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

/// By how much the angle from one vertex to another may differ from the one between the middles, and this be rounded.
///
/// Its gradient has the size `length / (r r')` with the distances `r`, `r'` of the vertices. On a path of length `d` from the
/// middle they are at least `r - t` and `r' - t`. By Cauchy and Schwarz the integral of `1 / ((r - t) (r' - t))` is at most
/// the root of the product of those of the squares, `d / (r (r - d))` and `d / (r' (r' - d))`.
#[inline(always)]
fn spread(from: &Sight<Ball>, to: &Sight<Ball>, length: f64, reach: f64) -> f64 {
    (length * reach * from.width * to.width + from.slack + to.slack + 64.0 * f64::EPSILON) * UPWARD
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
        let mut made: Vec<f64> =
            (0..60).map(|_| (next() as f64 / 2f64.powi(52) - 1.0) * 2f64.powi((next() % 400) as i32 - 200)).collect();
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
            for result in
                [unknown + other, other - unknown, unknown * other, other / unknown, Ball::length(unknown, other)]
            {
                assert!(result.radius.is_nan() && !(result.low() > 0.0) && !(result.high() < 0.0));
            }
        }
        let infinite = Ball::of(1e300) * Ball::of(1e300);
        assert!(!(infinite.low() > 0.0), "an overflow is no number: {infinite:?}");
    }
}
