//! Rational numbers of any size.

use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::str::FromStr;

use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

use crate::predicate::Sign;

/// An exact rational number, always reduced.
///
/// A newtype, so that the library behind it can change.
///
/// ```
/// use homeo_core::number::Rational;
/// let tenth = Rational::from_f64(0.1).unwrap();
/// assert_eq!(tenth.to_string(), "3602879701896397/36028797018963968");
/// assert_eq!("0.1".parse::<Rational>().unwrap().to_string(), "1/10");
/// assert_ne!(tenth, "1/10".parse().unwrap());
/// ```
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Rational(RBig);

impl Rational {
    /// Zero.
    pub const ZERO: Self = Self(RBig::ZERO);
    /// One.
    pub const ONE: Self = Self(RBig::ONE);

    /// The dyadic rational that `value` is. `None` for infinities and NaN.
    pub fn from_f64(value: f64) -> Option<Self> {
        RBig::try_from(value).ok().map(Self)
    }

    /// `numerator / denominator`; `None` when the denominator is zero.
    pub fn from_parts(numerator: IBig, denominator: IBig) -> Option<Self> {
        use dashu_base::Signed;
        if denominator.is_zero() {
            return None;
        }
        let numerator = if denominator.is_negative() { -numerator } else { numerator };
        let (_, magnitude) = denominator.into_parts();
        Some(Self(RBig::from_parts(numerator, magnitude)))
    }

    /// Numerator and (positive) denominator, reduced.
    pub fn into_parts(self) -> (IBig, UBig) {
        self.0.into_parts()
    }

    /// Numerator, reduced.
    pub fn numerator(&self) -> &IBig {
        self.0.numerator()
    }

    /// Denominator, reduced and positive.
    pub fn denominator(&self) -> &UBig {
        self.0.denominator()
    }

    /// The nearest `f64`, ties to even.
    pub fn to_f64(&self) -> f64 {
        self.0.to_f64().value()
    }

    /// The exact sign.
    pub fn sign(&self) -> Sign {
        use std::cmp::Ordering::{Equal, Greater, Less};
        match self.0.cmp(&RBig::ZERO) {
            Less => Sign::Negative,
            Equal => Sign::Zero,
            Greater => Sign::Positive,
        }
    }

    /// Whether it is zero.
    pub fn is_zero(&self) -> bool {
        self.0.is_zero()
    }
}

impl From<i64> for Rational {
    fn from(value: i64) -> Self {
        Self(RBig::from(value))
    }
}

impl From<IBig> for Rational {
    fn from(value: IBig) -> Self {
        Self(RBig::from(value))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for Rational {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
        impl $trait<&Rational> for &Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                Rational((&self.0).$method(&other.0))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Rational {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl std::iter::Sum for Rational {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::ZERO, |a, b| a + b)
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

impl fmt::Debug for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

/// A text that is neither `p/q` nor a plain decimal.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is neither a fraction p/q nor a decimal number")]
pub struct ParseRationalError(String);

/// Exponents beyond this are refused: the number would have that many digits.
const LARGEST_EXPONENT: i64 = 5_000;

impl FromStr for Rational {
    type Err = ParseRationalError;

    /// Reads `p/q`, an integer, or a decimal such as `-1.25e-3`, all of them exactly.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let text = text.trim();
        let error = || ParseRationalError(text.chars().take(40).collect());
        let integer = |digits: &str| -> Option<IBig> {
            let body = digits.strip_prefix(['+', '-']).unwrap_or(digits);
            if body.is_empty() || !body.bytes().all(|b| b.is_ascii_digit()) {
                return None;
            }
            digits.strip_prefix('+').unwrap_or(digits).parse().ok()
        };
        if let Some((p, q)) = text.split_once('/') {
            let (p, q) = (integer(p.trim()).ok_or_else(error)?, integer(q.trim()).ok_or_else(error)?);
            return Self::from_parts(p, q).ok_or_else(error);
        }
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i64>().map_err(|_| error())?),
            None => (text, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let has_digits = mantissa.bytes().any(|b| b.is_ascii_digit());
        let is_fraction = fraction.bytes().all(|b| b.is_ascii_digit());
        if !has_digits || !is_fraction || exponent.abs() > LARGEST_EXPONENT {
            return Err(error());
        }
        let sign = if whole.starts_with(['+', '-']) { &whole[..1] } else { "" };
        let digits = integer(&format!("{sign}0{}{fraction}", &whole[sign.len()..])).ok_or_else(error)?;
        let shift = exponent - fraction.len() as i64;
        let power = UBig::from(10u8).pow(shift.unsigned_abs() as usize);
        let one = IBig::from(1);
        let power = IBig::from(power);
        let (p, q) = if shift < 0 { (digits, power) } else { (digits * power, one) };
        Self::from_parts(p, q).ok_or_else(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> String {
        text.parse::<Rational>().unwrap().to_string()
    }

    #[test]
    fn fractions_and_decimals_are_exact() {
        assert_eq!(parsed("-6/4"), "-3/2");
        assert_eq!(parsed("3/-6"), "-1/2");
        assert_eq!(parsed("-1.25e-3"), "-1/800");
        assert_eq!(parsed(".5"), "1/2");
        assert_eq!(parsed("+7."), "7");
        assert_eq!(parsed("12e2"), "1200");
    }

    #[test]
    fn nonsense_is_refused() {
        for text in ["", ".", "-", "1/0", "1/", "nan", "inf", "1e999999999", "1.2.3", "--1", "1e", "0x10", "1_000"] {
            assert!(text.parse::<Rational>().is_err(), "{text} was taken for a number");
        }
    }

    #[test]
    fn every_double_goes_there_and_back() {
        for value in [0.1, -1e300, 5e-324, 1.0 / 3.0, f64::MIN_POSITIVE, 0.0] {
            assert_eq!(Rational::from_f64(value).unwrap().to_f64(), value);
        }
        assert!(Rational::from_f64(f64::NAN).is_none());
        assert!(Rational::from_f64(f64::INFINITY).is_none());
    }
}
