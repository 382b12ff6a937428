//! Vectors of the plane, and functions of a chart's two coordinates with their derivatives.

use homeo_core::planar::Point2;

use super::number::Number;

pub(crate) type Vector<T> = [T; 2];

pub(crate) fn dot<T: Number>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn cross<T: Number>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[1] - a[1] * b[0]
}

pub(crate) fn plus<T: Number>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] + b[0], a[1] + b[1]]
}

pub(crate) fn minus<T: Number>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn scaled<T: Number>(factor: T, a: Vector<T>) -> Vector<T> {
    [factor * a[0], factor * a[1]]
}

pub(crate) fn opposite<T: Number>(a: Vector<T>) -> Vector<T> {
    a.map(T::opposite)
}

pub(crate) fn of<T: Number>(a: Point2) -> Vector<T> {
    a.map(T::of)
}

/// A function of `s` and `λ`: its value and its derivatives `∂/∂s` and `∂/∂λ - skew s ∂/∂s`.
#[derive(Clone, Copy)]
pub(crate) struct Dual<T>(pub [T; 3]);

impl<T: Number> Dual<T> {
    pub fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
    pub fn minus(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }
    pub fn times(self, other: Self) -> Self {
        let ([a, a1, a2], [b, b1, b2]) = (self.0, other.0);
        Self([a * b, a1 * b + a * b1, a2 * b + a * b2])
    }
    pub fn times_constant(self, factor: T) -> Self {
        Self(self.0.map(|c| c.times_constant(factor)))
    }
    pub fn with(self, factor: Option<Self>) -> Self {
        factor.map_or(self, |factor| self.times(factor))
    }
    pub fn over(self, other: Self) -> Self {
        let ([a, a1, a2], [b, b1, b2]) = (self.0, other.0);
        let quotient = a / b;
        Self([quotient, (a1 - quotient * b1) / b, (a2 - quotient * b2) / b])
    }
}
