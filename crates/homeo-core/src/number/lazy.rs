//! Exact numbers that are computed only where an interval does not decide.

use std::sync::{Arc, OnceLock};

use super::{Interval, Rational, Scalar};
use crate::predicate::Sign;

/// An exact number: an [`Interval`] round it, and how to compute it.
///
/// Its sign is always decided: by the interval, or else by the exact value, which is then kept. A formula costs little more
/// than in intervals, and is as exact as in rationals.
///
/// ```
/// use homeo_core::number::{Lazy, Scalar};
/// let tenth = Lazy::from_f64(1.0).divide(&Lazy::from_f64(10.0));
/// let sum = (0..10).fold(Lazy::from_f64(0.0), |sum, _| sum.plus(&tenth));
/// assert!(sum.minus(&Lazy::from_f64(1.0)).is_zero());
/// ```
#[derive(Clone, Debug)]
pub struct Lazy(Arc<Node>);

#[derive(Debug)]
struct Node {
    near: Interval,
    rule: Rule,
    exact: OnceLock<Rational>,
}

/// What `near` is allowed to miss, relative to the number.
const LARGEST_RADIUS: f64 = 1e-9;

/// How a number comes about.
#[derive(Debug)]
enum Rule {
    Stored(f64),
    Known,
    Sum(Lazy, Lazy),
    Difference(Lazy, Lazy),
    Product(Lazy, Lazy),
    Quotient(Lazy, Lazy),
    Formula(Formula),
}

/// A formula in rationals.
struct Formula(Box<dyn Fn() -> Rational + Send + Sync>);

impl std::fmt::Debug for Formula {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Formula")
    }
}

impl Lazy {
    fn new(near: Interval, rule: Rule) -> Self {
        Self(Arc::new(Node { near, rule, exact: OnceLock::new() }))
    }

    /// The value of a formula: what it gives in intervals, and how to compute it in rationals. Cheaper than to compute with
    /// lazy numbers, step by step. That both are the same formula is up to the caller: write it once, for any [`Scalar`].
    ///
    /// ```
    /// use homeo_core::number::{Interval, Lazy, Rational, Scalar};
    /// fn product<T: Scalar>([a, b]: [f64; 2]) -> T {
    ///     T::from_f64(a).times(&T::from_f64(b))
    /// }
    /// let pair = [0.1, 0.3];
    /// let lazy = Lazy::of_formula(product::<Interval>(pair), move || product::<Rational>(pair));
    /// assert_eq!(lazy, Lazy::from_f64(0.1).times(&Lazy::from_f64(0.3)));
    /// ```
    pub fn of_formula(near: Interval, exact: impl Fn() -> Rational + Send + Sync + 'static) -> Self {
        Self::new(near, Rule::Formula(Formula(Box::new(exact))))
    }

    /// An interval round the number; a point where the exact value has been computed and is a double.
    pub fn interval(&self) -> Interval {
        self.0.exact.get().map_or(self.0.near, Interval::around)
    }

    /// The number itself.
    ///
    /// # Complexity
    /// That of all operations it comes from that have not been computed yet; they are nested as deep as the formula.
    pub fn exact(&self) -> &Rational {
        self.0.exact.get_or_init(|| match &self.0.rule {
            Rule::Stored(value) => <Rational as Scalar>::from_f64(*value),
            Rule::Known => Rational::ZERO, // its value is there from the beginning
            Rule::Sum(a, b) => a.exact() + b.exact(),
            Rule::Difference(a, b) => a.exact() - b.exact(),
            Rule::Product(a, b) => a.exact() * b.exact(),
            Rule::Quotient(a, b) => a.exact() / b.exact(),
            Rule::Formula(formula) => formula.0(),
        })
    }

    /// Whether it is zero, exactly.
    pub fn is_zero(&self) -> bool {
        self.certain_sign() == Sign::Zero
    }

    /// Its sign.
    pub fn certain_sign(&self) -> Sign {
        self.0.near.sign().unwrap_or_else(|| self.exact().sign())
    }

    /// Whether it is known, without any work, to be this double.
    pub fn is_plainly(&self, value: f64) -> bool {
        self.0.near.low() == value && self.0.near.high() == value
    }
}

impl From<Rational> for Lazy {
    fn from(exact: Rational) -> Self {
        Self(Arc::new(Node { near: Interval::around(&exact), rule: Rule::Known, exact: OnceLock::from(exact) }))
    }
}

impl Scalar for Lazy {
    fn from_f64(value: f64) -> Self {
        // The exact value of what is not finite is zero.
        let value = if value.is_finite() { value } else { 0.0 };
        Self::new(Interval::from_f64(value), Rule::Stored(value))
    }

    fn plus(&self, other: &Self) -> Self {
        if self.is_plainly(0.0) {
            return other.clone();
        }
        if other.is_plainly(0.0) {
            return self.clone();
        }
        Self::new(self.0.near.plus(&other.0.near), Rule::Sum(self.clone(), other.clone()))
    }

    fn minus(&self, other: &Self) -> Self {
        if other.is_plainly(0.0) {
            return self.clone();
        }
        if Arc::ptr_eq(&self.0, &other.0) {
            return Self::from_f64(0.0);
        }
        Self::new(self.0.near.minus(&other.0.near), Rule::Difference(self.clone(), other.clone()))
    }

    fn times(&self, other: &Self) -> Self {
        if self.is_plainly(0.0) || other.is_plainly(1.0) {
            return self.clone();
        }
        if other.is_plainly(0.0) || self.is_plainly(1.0) {
            return other.clone();
        }
        Self::new(self.0.near.times(&other.0.near), Rule::Product(self.clone(), other.clone()))
    }

    fn divide(&self, other: &Self) -> Self {
        if self.is_plainly(0.0) || other.is_plainly(1.0) {
            return self.clone();
        }
        Self::new(self.0.near.divide(&other.0.near), Rule::Quotient(self.clone(), other.clone()))
    }

    fn sign(&self) -> Option<Sign> {
        Some(self.certain_sign())
    }

    fn enclosure(&self) -> Interval {
        self.interval()
    }

    /// Of a wide interval the middle says nothing: then the exact value is rounded.
    fn near(&self) -> f64 {
        let (middle, radius) = self.interval().middle_and_radius();
        if radius <= LARGEST_RADIUS * middle.abs() { middle } else { self.exact().to_f64() }
    }
}

impl PartialEq for Lazy {
    fn eq(&self, other: &Self) -> bool {
        self.minus(other).is_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_rationals() {
        let numbers = [0.0, 1.0, -1.0, 0.1, 3.0, 1e-200, -7e100, 0.3];
        let mut count = 0;
        for a in numbers {
            for b in numbers {
                for c in numbers {
                    let formula = |[a, b, c]: [Lazy; 3]| a.times(&b).minus(&c.plus(&a)).times(&b.minus(&c)).plus(&a);
                    let exactly = |[a, b, c]: [Rational; 3]| &(&(&(&a * &b) - &(&c + &a)) * &(&b - &c)) + &a;
                    let lazy = formula([a, b, c].map(Lazy::from_f64));
                    let exact = exactly([a, b, c].map(<Rational as Scalar>::from_f64));
                    assert_eq!(lazy.certain_sign(), exact.sign(), "{a} {b} {c}");
                    assert_eq!(*lazy.exact(), exact, "{a} {b} {c}");
                    count += 1;
                }
            }
        }
        assert_eq!(count, 512);
    }

    #[test]
    fn what_is_near_is_near_also_where_the_interval_says_nothing() {
        let [one, tiny] = [1.0, 1e-20].map(Lazy::from_f64);
        let left = one.plus(&tiny).minus(&one);
        assert!(left.interval().low() < 0.0, "the interval cannot tell");
        assert_eq!(left.near(), 1e-20);
        let quotient = tiny.divide(&left);
        assert_eq!(quotient.interval(), Interval::WHOLE, "a divisor that may be zero");
        assert_eq!(quotient.near(), 1.0);
    }

    #[test]
    fn what_cancels_is_zero() {
        let (third, three) = (Lazy::from_f64(1.0).divide(&Lazy::from_f64(3.0)), Lazy::from_f64(3.0));
        let one = third.times(&three);
        assert!(one.interval().low() < 1.0 && one == Lazy::from_f64(1.0));
        assert_eq!(one.minus(&Lazy::from_f64(1.0)).certain_sign(), Sign::Zero);
        assert_eq!(Lazy::from(one.exact().clone()).interval(), Interval::from_f64(1.0));
    }
}
