//! Numbers of the hyperbolic formulas: doubles, and enclosures with roots, logarithms and angles.

use homeo_core::number::{Interval, Scalar};
use homeo_core::predicate::Sign;
use std::f64::consts::{FRAC_PI_2, LN_2, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number or an enclosure of one, so that each formula is written once.
///
/// ```
/// use homeo_manifold::hyperbolic::{Enclosure, Real};
/// fn diagonal<R: Real>() -> R {
///     R::from_f64(2.0).sqrt()
/// }
/// assert!(diagonal::<Enclosure>().holds(diagonal::<f64>()));
/// ```
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A stored number, exactly.
    fn from_f64(value: f64) -> Self;
    /// The square root; nothing is known of that of a number that may be negative.
    fn sqrt(self) -> Self;
    /// The angle in radians of the point `(cosine, sine)`, which need not be on the unit circle, up to full turns. For a
    /// positive sine it is between 0 and π.
    fn angle(cosine: Self, sine: Self) -> Self;
}

impl Real for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    fn angle(cosine: Self, sine: Self) -> Self {
        sine.atan2(cosine)
    }
}

/// All numbers from a least to a largest; every operation rounds outwards. Where nothing is known it is the whole line.
///
/// Roots rest on IEEE 754 (correctly rounded); logarithms and angles are computed here, from series with bounded
/// remainders, and not with the functions of the platform, of which no error bound is promised.
///
/// ```
/// use homeo_manifold::hyperbolic::Enclosure;
/// let third = Enclosure::exact(1.0) / Enclosure::exact(3.0);
/// assert!(third.low() < third.high() && third.width() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enclosure(Interval);

impl Enclosure {
    /// All numbers.
    pub const WHOLE: Self = Self(Interval::WHOLE);

    /// Just this number; everything for one that is not finite.
    pub fn exact(value: f64) -> Self {
        if value.is_finite() { Self(Interval::from_f64(value)) } else { Self::WHOLE }
    }

    /// All numbers between two.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::Enclosure;
    /// let unit = Enclosure::between(1.0, 0.0);
    /// assert_eq!((unit.low(), unit.high()), (0.0, 1.0));
    /// ```
    pub fn between(a: f64, b: f64) -> Self {
        Self(Interval::from_f64(a).hull_with(&Interval::from_f64(b)))
    }

    /// The circle's number.
    pub fn pi() -> Self {
        // The constant is rounded to the nearest double.
        Self::between(PI.next_down(), PI.next_up())
    }

    /// The least number in it.
    pub fn low(self) -> f64 {
        self.0.low()
    }

    /// The largest number in it.
    pub fn high(self) -> f64 {
        self.0.high()
    }

    /// A number in the middle.
    pub fn middle(self) -> f64 {
        self.0.middle_and_radius().0
    }

    /// How far the ends are from one another at most.
    pub fn width(self) -> f64 {
        if self.low() == self.high() { 0.0 } else { (self.high() - self.low()).next_up() }
    }

    /// Whether a number is in it.
    pub fn holds(self, value: f64) -> bool {
        self.low() <= value && value <= self.high()
    }

    /// Whether all numbers in it are above 0.
    pub fn is_positive(self) -> bool {
        self.0.sign() == Some(Sign::Positive)
    }

    /// Whether it lies in another one and touches neither end of it.
    pub fn is_inside(self, other: Self) -> bool {
        other.low() < self.low() && self.high() < other.high()
    }

    /// The numbers in both; nothing if there are none.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::Enclosure;
    /// let [a, b] = [Enclosure::between(0.0, 2.0), Enclosure::between(1.0, 3.0)];
    /// assert_eq!(a.common(b), Some(Enclosure::between(1.0, 2.0)));
    /// assert_eq!(a.common(Enclosure::exact(5.0)), None);
    /// ```
    pub fn common(self, other: Self) -> Option<Self> {
        let (low, high) = (self.low().max(other.low()), self.high().min(other.high()));
        (low <= high).then(|| Self::between(low, high))
    }

    /// The largest absolute value in it.
    pub fn magnitude(self) -> f64 {
        self.low().abs().max(self.high().abs())
    }

    /// The natural logarithm; everything unless all numbers in it are positive.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::Enclosure;
    /// let two = Enclosure::exact(2.0).ln();
    /// assert!(two.holds(std::f64::consts::LN_2) && two.width() < 1e-15);
    /// ```
    #[must_use]
    pub fn ln(self) -> Self {
        if !self.is_positive() || !self.high().is_finite() {
            return Self::WHOLE;
        }
        Self(logarithm(self.low()).0.hull_with(&logarithm(self.high()).0))
    }

    /// The number whose hyperbolic cosine it is, at least 0.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::Enclosure;
    /// let length = Enclosure::exact(1.5).inverse_cosh();
    /// assert!(length.holds(1.5_f64.acosh()) && length.width() < 1e-14);
    /// ```
    #[must_use]
    pub fn inverse_cosh(self) -> Self {
        (self + (self * self - Self::exact(1.0)).sqrt()).ln()
    }

    /// The angle whose tangent it is, between -π/2 and π/2.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::Enclosure;
    /// let eighth = Enclosure::exact(1.0).arctangent() * Enclosure::exact(4.0);
    /// assert!(eighth.holds(std::f64::consts::PI) && eighth.width() < 1e-13);
    /// ```
    #[must_use]
    pub fn arctangent(self) -> Self {
        if !self.low().is_finite() || !self.high().is_finite() {
            return Self::between(-FRAC_PI_2.next_up(), FRAC_PI_2.next_up());
        }
        if self.low() == self.high() {
            return arctangent(self.low());
        }
        Self(arctangent(self.low()).0.hull_with(&arctangent(self.high()).0))
    }
}

/// The logarithm of a positive double: `x = 2^k m` with `m` near 1, `ln m = 2 (w + w^3/3 + w^5/5 + ...)` with
/// `w = (m - 1) / (m + 1)`.
fn logarithm(x: f64) -> Enclosure {
    const TERMS: u32 = 12;
    // Also for numbers below the normal range the products with powers of two are exact: they only grow.
    let (mut mantissa, mut exponent) = (x, 0.0);
    if mantissa < f64::MIN_POSITIVE {
        (mantissa, exponent) = (mantissa * 2f64.powi(60), -60.0);
    }
    let bits = mantissa.to_bits();
    exponent += (bits >> 52) as f64 - 1023.0;
    mantissa = f64::from_bits((bits & ((1 << 52) - 1)) | 1023 << 52);
    if mantissa > std::f64::consts::SQRT_2 {
        (mantissa, exponent) = (mantissa / 2.0, exponent + 1.0);
    }
    let one = Enclosure::exact(1.0);
    let w = (Enclosure::exact(mantissa) - one) / (Enclosure::exact(mantissa) + one);
    let square = w * w;
    let mut sum = Enclosure::exact(0.0);
    for k in (0..TERMS).rev() {
        sum = sum * square + one / Enclosure::exact(f64::from(2 * k + 1));
    }
    // |w| < 0.172, so what is left is below w^24 |w| / 25 (1 + 0.03 + 0.03^2 + ...) < |w| 5e-20.
    sum = (sum + Enclosure::between(-5e-20, 5e-20)) * w;
    let ln_2 = Enclosure::between(LN_2.next_down(), LN_2.next_up());
    sum * Enclosure::exact(2.0) + Enclosure::exact(exponent) * ln_2
}

/// The arctangent of a double: three times `tan(a / 2) = t / (1 + sqrt(1 + t^2))`, then the alternating series.
fn arctangent(tangent: f64) -> Enclosure {
    const TERMS: u32 = 12;
    if tangent.abs() > 1e100 {
        let quarter = Enclosure::pi() * Enclosure::exact(0.5);
        let nearly = quarter + Enclosure::between(-1e-100, 0.0);
        return if tangent > 0.0 { nearly } else { -nearly };
    }
    let one = Enclosure::exact(1.0);
    let mut t = Enclosure::exact(tangent);
    for _ in 0..3 {
        t = t / (one + (one + t * t).sqrt());
    }
    let square = t * t;
    let mut sum = Enclosure::exact(0.0);
    for k in (0..TERMS).rev() {
        sum = one / Enclosure::exact(f64::from(2 * k + 1)) - sum * square;
    }
    // |t| < tan(π/16) < 0.199: the first term that is left out is below |t| 0.199^24 / 25 < |t| 6e-19.
    (sum + Enclosure::between(-6e-19, 6e-19)) * t * Enclosure::exact(8.0)
}

impl Real for Enclosure {
    fn from_f64(value: f64) -> Self {
        Self::exact(value)
    }

    fn sqrt(self) -> Self {
        if !(self.low() >= 0.0 && self.high().is_finite()) {
            return Self::WHOLE;
        }
        // Correctly rounded: the root is within one step.
        Self::between(self.low().sqrt().next_down().max(0.0), self.high().sqrt().next_up())
    }

    fn angle(cosine: Self, sine: Self) -> Self {
        // Each branch is right only where the sign of what it divides by is known.
        let divisor = if cosine.middle().abs() >= sine.middle().abs() { cosine } else { sine };
        if !divisor.is_positive() && !(-divisor).is_positive() {
            return Self::WHOLE;
        }
        if cosine.middle().abs() >= sine.middle().abs() {
            let near_axis = (sine / cosine).arctangent();
            return if cosine.middle() > 0.0 { near_axis } else { near_axis + Self::pi() };
        }
        let from_quarter = (cosine / sine).arctangent();
        let quarter = Self::pi() * Self::exact(if sine.middle() > 0.0 { 0.5 } else { -0.5 });
        quarter - from_quarter
    }
}

impl Add for Enclosure {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.plus(&other.0))
    }
}

impl Sub for Enclosure {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0.minus(&other.0))
    }
}

impl Mul for Enclosure {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0.times(&other.0))
    }
}

impl Div for Enclosure {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self(self.0.divide(&other.0))
    }
}

impl Neg for Enclosure {
    type Output = Self;
    fn neg(self) -> Self {
        Self(Interval::from_f64(0.0).minus(&self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_and_angles_hold_the_library_values_and_are_narrow() {
        let mut count = 0;
        for k in -400..400 {
            let x = 1.05_f64.powi(k);
            let (ln, angle) = (Enclosure::exact(x).ln(), Enclosure::exact(x).arctangent());
            // The library is good to a unit in the last place or two; the enclosure is wider than that.
            let near = |found: Enclosure, wanted: f64| {
                (found.middle() - wanted).abs() <= found.width() + 2.0 * f64::EPSILON * wanted.abs()
            };
            assert!(near(ln, x.ln()) && ln.width() <= 4e-15 * (1.0 + x.ln().abs()), "{x}: {ln:?}");
            assert!(near(angle, x.atan()) && angle.width() <= 1e-14 * x.atan(), "{x}: {angle:?}");
            count += 1;
        }
        assert_eq!(count, 800);
        assert_eq!(Enclosure::between(-1.0, 1.0).ln(), Enclosure::WHOLE);
        assert_eq!(Enclosure::between(-1e-300, 1.0).sqrt(), Enclosure::WHOLE);
        assert!(Enclosure::exact(5e-324).ln().holds(-744.440_071_921_381_3));
    }

    #[test]
    fn angles_of_all_directions_agree_with_their_library_values_up_to_turns() {
        for k in 0..360 {
            let turn = f64::from(k).to_radians();
            let (cosine, sine) = (3.0 * turn.cos(), 3.0 * turn.sin());
            let found = Enclosure::angle(Enclosure::exact(cosine), Enclosure::exact(sine));
            let off = (found.middle() - sine.atan2(cosine)).rem_euclid(std::f64::consts::TAU);
            assert!(off.min(std::f64::consts::TAU - off) < 1e-14 && found.width() < 1e-14, "{k}: {found:?}");
            if sine > 0.0 {
                assert!(found.low() > -1e-14 && found.high() < PI + 1e-14);
            }
        }
    }

    #[test]
    fn nothing_is_said_of_the_angle_of_a_box_round_the_origin() {
        let (cosine, sine) = (Enclosure::between(-1.0, 3.0), Enclosure::between(0.5, 1.0));
        assert_eq!(Enclosure::angle(cosine, sine), Enclosure::WHOLE);
    }

    #[test]
    fn a_wrong_series_would_be_seen() {
        // Negative control: the exact value of a quarter turn is not in an enclosure of something else.
        let quarter = Enclosure::exact(1.0).arctangent();
        assert!(!quarter.holds(0.785_398_163_397_5) && quarter.holds(std::f64::consts::FRAC_PI_4));
        assert!(!Enclosure::exact(2.0).ln().holds(LN_2 + 1e-14));
    }
}
