//! Numbers of 32 digits with gradients, for references: nothing of the library is used.
#![allow(clippy::suspicious_arithmetic_impl)]

use std::ops::{Add, Div, Mul, Neg, Sub};

/// An unevaluated sum of two numbers.
#[derive(Clone, Copy, Debug)]
pub struct Double(pub f64, pub f64);

fn sum(a: f64, b: f64) -> Double {
    let s = a + b;
    let t = s - a;
    Double(s, (a - (s - t)) + (b - t))
}

impl Double {
    pub fn sqrt(self) -> Self {
        let root = self.0.sqrt();
        let rest = self - Self(root, 0.0) * Self(root, 0.0);
        let first = sum(root, rest.0 / (2.0 * root));
        let rest = self - first * first;
        first + Self(rest.0 / (2.0 * root), 0.0)
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        let (high, low) = (sum(self.0, b.0), sum(self.1, b.1));
        let first = sum(high.0, high.1 + low.0);
        sum(first.0, first.1 + low.1)
    }
}

impl Neg for Double {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let p = self.0 * b.0;
        sum(p, self.0.mul_add(b.0, -p) + (self.0 * b.1 + self.1 * b.0))
    }
}

impl Div for Double {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let first = Self(self.0 / b.0, 0.0);
        let rest = self - b * first;
        let second = Self(rest.0 / b.0, 0.0);
        let rest = rest - b * second;
        first + second + Self(rest.0 / b.0, 0.0)
    }
}

/// Such a number and its gradient.
#[derive(Clone, Copy, Debug)]
pub struct Dual {
    pub value: Double,
    pub gradient: [Double; 2],
}

impl Dual {
    pub fn constant(x: f64) -> Self {
        Self { value: Double(x, 0.0), gradient: [Double(0.0, 0.0); 2] }
    }

    pub fn variable(x: f64, axis: usize) -> Self {
        let mut this = Self::constant(x);
        this.gradient[axis].0 = 1.0;
        this
    }

    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self { value: root, gradient: self.gradient.map(|g| g / (root + root)) }
    }

    fn with(self, b: Self, value: Double, f: impl Fn(Double, Double) -> Double) -> Self {
        Self { value, gradient: [f(self.gradient[0], b.gradient[0]), f(self.gradient[1], b.gradient[1])] }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        self.with(b, self.value + b.value, |x, y| x + y)
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self.with(b, self.value - b.value, |x, y| x - y)
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        self.with(b, self.value * b.value, |x, y| x * b.value + self.value * y)
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let value = self.value / b.value;
        self.with(b, value, |x, y| (x - value * y) / b.value)
    }
}
