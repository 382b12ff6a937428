//! Numbers that a formula is written for once: plain ones for values, and ones that carry a gradient.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What formulas of coordinates need of a number that depends on a point of `D`-space.
pub(super) trait Real<const D: usize>:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
{
    /// A number and its gradient at the point.
    fn variable(value: f64, gradient: [f64; D]) -> Self;
    /// The number.
    fn value(self) -> f64;
    /// The gradient; zero where none is carried.
    fn gradient(self) -> [f64; D];
    /// A function of the number, by its value and its derivative there.
    fn chain(self, value: f64, slope: f64) -> Self;

    /// A number that does not depend on the point.
    fn constant(value: f64) -> Self {
        Self::variable(value, [0.0; D])
    }

    /// The square root, of a positive number.
    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.chain(root, 0.5 / root)
    }

    /// The natural logarithm, of a positive number.
    fn ln(self) -> Self {
        self.chain(self.value().ln(), 1.0 / self.value())
    }

    /// `ln(1 + x)`, to full accuracy for small `x`.
    fn ln_1p(self) -> Self {
        self.chain(self.value().ln_1p(), 1.0 / (1.0 + self.value()))
    }

    /// `exp(x) - 1`, to full accuracy for small `x`.
    fn exp_m1(self) -> Self {
        let value = self.value().exp_m1();
        self.chain(value, value + 1.0)
    }

    /// A real power, of a positive number.
    fn powf(self, exponent: f64) -> Self {
        let value = self.value().powf(exponent);
        self.chain(value, exponent * value / self.value())
    }
}

impl<const D: usize> Real<D> for f64 {
    fn variable(value: f64, _: [f64; D]) -> Self {
        value
    }
    fn value(self) -> f64 {
        self
    }
    fn gradient(self) -> [f64; D] {
        [0.0; D]
    }
    fn chain(self, value: f64, _: f64) -> Self {
        value
    }
}

/// A number with its gradient.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet<const D: usize> {
    pub value: f64,
    pub gradient: [f64; D],
}

impl<const D: usize> Jet<D> {
    fn combine(value: f64, a: &Self, by_a: f64, b: &Self, by_b: f64) -> Self {
        Self { value, gradient: std::array::from_fn(|k| by_a * a.gradient[k] + by_b * b.gradient[k]) }
    }
}

impl<const D: usize> Real<D> for Jet<D> {
    fn variable(value: f64, gradient: [f64; D]) -> Self {
        Self { value, gradient }
    }
    fn value(self) -> f64 {
        self.value
    }
    fn gradient(self) -> [f64; D] {
        self.gradient
    }
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, gradient: self.gradient.map(|g| slope * g) }
    }
}

impl<const D: usize> Add for Jet<D> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::combine(self.value + other.value, &self, 1.0, &other, 1.0)
    }
}

impl<const D: usize> Sub for Jet<D> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::combine(self.value - other.value, &self, 1.0, &other, -1.0)
    }
}

impl<const D: usize> Mul for Jet<D> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::combine(self.value * other.value, &self, other.value, &other, self.value)
    }
}

impl<const D: usize> Div for Jet<D> {
    type Output = Self;
    // The rule for quotients has products in it.
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn div(self, other: Self) -> Self {
        // Subtract before dividing: a quotient of equal numbers has gradient zero to the last bit.
        let value = self.value / other.value;
        let slope = |k: usize| (self.gradient[k] - value * other.gradient[k]) / other.value;
        Self { value, gradient: std::array::from_fn(slope) }
    }
}

impl<const D: usize> Neg for Jet<D> {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl<const D: usize> Mul<f64> for Jet<D> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.chain(self.value * factor, factor)
    }
}
