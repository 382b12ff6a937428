//! What a geometric formula needs of its numbers, so that it is written once for exact and for fast arithmetic.

use super::{Interval, Rational};
use crate::predicate::Sign;

/// A number of a field, or an enclosure of one.
///
/// A formula over scalars that branches only on certain [signs](Self::sign) gives with [`Interval`] an enclosure of what it
/// gives with [`Rational`], or stops where rounding leaves a sign open: it never takes another branch.
///
/// ```
/// use homeo_core::number::{Interval, Rational, Scalar};
/// fn cross<T: Scalar>([a, b]: [f64; 2], [c, d]: [f64; 2]) -> T {
///     let [a, b, c, d] = [a, b, c, d].map(T::from_f64);
///     a.times(&d).minus(&b.times(&c))
/// }
/// let (u, v) = ([0.1, 0.3], [0.2, 0.6]);
/// assert!(cross::<Rational>(u, v).is_zero(), "0.2 is twice 0.1, and 0.6 twice 0.3, as stored numbers too");
/// assert_eq!(cross::<Interval>(u, v).sign(), None, "not certain in floating point");
/// ```
pub trait Scalar: Clone + Send + Sync {
    /// A stored number, exactly. Those that are not finite give 0 or the whole line.
    fn from_f64(value: f64) -> Self;
    /// The sum.
    #[must_use]
    fn plus(&self, other: &Self) -> Self;
    /// The difference.
    #[must_use]
    fn minus(&self, other: &Self) -> Self;
    /// The product.
    #[must_use]
    fn times(&self, other: &Self) -> Self;
    /// The quotient. Whoever divides knows that the divisor is not zero; an enclosure may still hold 0.
    #[must_use]
    fn divide(&self, other: &Self) -> Self;
    /// The sign, where it is certain.
    fn sign(&self) -> Option<Sign>;
    /// An interval that holds the number.
    fn enclosure(&self) -> Interval;
    /// A double near the number.
    fn near(&self) -> f64 {
        self.enclosure().middle_and_radius().0
    }
}

impl Scalar for Rational {
    fn from_f64(value: f64) -> Self {
        Self::from_f64(value).unwrap_or(Self::ZERO)
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
    fn divide(&self, other: &Self) -> Self {
        self / other
    }
    fn sign(&self) -> Option<Sign> {
        Some(self.sign())
    }
    fn enclosure(&self) -> Interval {
        Interval::around(self)
    }
    fn near(&self) -> f64 {
        self.to_f64()
    }
}
