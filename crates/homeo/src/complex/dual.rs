//! Numbers that carry two derivatives, plain or enclosed.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::composite::number::Number;

/// A function of the two coordinates of a chart: its value and both derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dual<T> {
    pub value: T,
    pub by: [T; 2],
}

impl<T: Number> Dual<T> {
    pub fn constant(value: T) -> Self {
        Self { value, by: [T::of(0.0); 2] }
    }

    pub fn times(self, factor: T) -> Self {
        Self { value: self.value * factor, by: self.by.map(|d| d * factor) }
    }

    /// The length of a vector.
    pub fn length([x, y]: [Self; 2]) -> Self {
        let value = T::length(x.value, y.value);
        let slope = |k: usize| (x.value * x.by[k] + y.value * y.by[k]) / value;
        Self { value, by: [slope(0), slope(1)] }
    }
}

impl<T: Number> Add for Dual<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, by: std::array::from_fn(|k| self.by[k] + other.by[k]) }
    }
}

impl<T: Number> Sub for Dual<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, by: std::array::from_fn(|k| self.by[k] - other.by[k]) }
    }
}

impl<T: Number> Neg for Dual<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: self.value.opposite(), by: self.by.map(T::opposite) }
    }
}

impl<T: Number> Mul for Dual<T> {
    type Output = Self;
    // The rule for products has a sum in it.
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn mul(self, other: Self) -> Self {
        let slope = |k: usize| self.by[k] * other.value + self.value * other.by[k];
        Self { value: self.value * other.value, by: [slope(0), slope(1)] }
    }
}

impl<T: Number> Div for Dual<T> {
    type Output = Self;
    // The rule for quotients has products in it.
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let slope = |k: usize| (self.by[k] - value * other.by[k]) / other.value;
        Self { value, by: [slope(0), slope(1)] }
    }
}

/// The dot product.
pub(super) fn dot<T: Number>(a: [Dual<T>; 2], b: [Dual<T>; 2]) -> Dual<T> {
    a[0] * b[0] + a[1] * b[1]
}

/// The cross product.
pub(super) fn cross<T: Number>(a: [Dual<T>; 2], b: [Dual<T>; 2]) -> Dual<T> {
    a[0] * b[1] - a[1] * b[0]
}
