//! Functions of three parameters with their derivatives, enclosed in affine forms.

use crate::affine;
use std::ops::{Add, Mul, Neg, Sub};

pub(super) type Form = affine::Form<3>;

/// Three of a kind, written out: `map` of arrays moves much memory.
#[inline(always)]
pub(super) fn three<T>(of: impl Fn(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}

/// A vector in space.
pub(super) type Vector<T> = [T; 3];

/// A function's value and its derivatives by the parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub value: Form,
    pub slopes: [Form; 3],
}

impl Jet {
    pub const ZERO: Jet = Jet::constant(Form::ZERO);
    pub const ONE: Jet = Jet::constant(Form::ONE);

    pub const fn constant(value: Form) -> Jet {
        Jet { value, slopes: [Form::ZERO; 3] }
    }

    /// The parameter with the number `axis`, from `low` to `high`.
    pub fn parameter(interval: [f64; 2], axis: usize) -> Jet {
        let mut slopes = [Form::ZERO; 3];
        slopes[axis] = Form::ONE;
        Jet { value: Form::between(interval, axis), slopes }
    }

    #[inline]
    pub fn scaled(self, factor: Form) -> Jet {
        Jet { value: self.value * factor, slopes: three(|k| self.slopes[k] * factor) }
    }

    pub fn doubled(self) -> Jet {
        self + self
    }

    pub fn halved(self) -> Jet {
        self.scaled(Form::exact(0.5))
    }

    #[inline]
    pub fn square(self) -> Jet {
        let twice = self.value + self.value;
        Jet { value: self.value * self.value, slopes: three(|k| twice * self.slopes[k]) }
    }

    pub fn inverse(self) -> Jet {
        let value = self.value.inverse();
        let factor = -(value * value);
        Jet { value, slopes: three(|k| factor * self.slopes[k]) }
    }

    pub fn over(self, other: Jet) -> Jet {
        self * other.inverse()
    }
}

impl Add for Jet {
    type Output = Jet;
    #[inline]
    fn add(self, other: Jet) -> Jet {
        let slopes = three(|k| self.slopes[k] + other.slopes[k]);
        Jet { value: self.value + other.value, slopes }
    }
}

impl Neg for Jet {
    type Output = Jet;
    #[inline]
    fn neg(self) -> Jet {
        Jet { value: -self.value, slopes: three(|k| -self.slopes[k]) }
    }
}

impl Sub for Jet {
    type Output = Jet;
    #[inline]
    fn sub(self, other: Jet) -> Jet {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Jet;
    #[inline]
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule has a sum")]
    fn mul(self, other: Jet) -> Jet {
        let slopes = three(|k| self.value * other.slopes[k] + self.slopes[k] * other.value);
        Jet { value: self.value * other.value, slopes }
    }
}

pub(super) fn difference(a: Vector<f64>, b: Vector<f64>) -> Vector<Form> {
    three(|k| Form::exact(a[k]) - Form::exact(b[k]))
}

pub(super) fn constant(a: Vector<Form>) -> Vector<Jet> {
    a.map(Jet::constant)
}

pub(super) fn plus<T: Copy + Add<Output = T>>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    three(|k| a[k] + b[k])
}

pub(super) fn minus<T: Copy + Sub<Output = T>>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    three(|k| a[k] - b[k])
}

pub(super) fn times<T: Copy + Mul<Output = T>>(factor: T, a: Vector<T>) -> Vector<T> {
    three(|k| factor * a[k])
}

pub(super) fn dot<T: Copy + Add<Output = T> + Mul<Output = T>>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The product with a vector that does not change.
pub(super) fn along(a: Vector<Jet>, b: Vector<Form>) -> Jet {
    a[0].scaled(b[0]) + a[1].scaled(b[1]) + a[2].scaled(b[2])
}

pub(super) fn cross<T: Copy + Sub<Output = T> + Mul<Output = T>>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    let minor = |k: usize, l: usize| a[k] * b[l] - a[l] * b[k];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The cross product with a vector that does not change.
pub(super) fn across(a: Vector<Jet>, b: Vector<Form>) -> Vector<Jet> {
    let minor = |k: usize, l: usize| a[k].scaled(b[l]) - a[l].scaled(b[k]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

pub(super) fn determinant(columns: [Vector<Form>; 3]) -> Form {
    dot(columns[0], cross(columns[1], columns[2]))
}

/// The length of a vector: between `u . p` and `u . p + |u x p|^2 / (2 u . p)`, for any unit vector `u` with `u . p > 0`.
pub(super) fn size(p: Vector<Form>) -> Form {
    let middles = p.map(|c| c.middle);
    let norm = dot(middles, middles).sqrt();
    let unit = middles.map(|x| Form::exact(x / norm));
    let near = dot(unit, p);
    let least = near.least();
    if !(least > 0.0 && least.is_finite() && norm > 1e-140) {
        return Form::UNKNOWN;
    }
    let square: f64 = cross(unit, p).iter().map(|c| c.size() * c.size()).sum();
    // `u` is rounded: its length is off by less than three units, which scales both products alike.
    let half = 0.25 * square / least * (1.0 + 16.0 * f64::EPSILON);
    let terms = near.terms() + 2.0 * half;
    Form::rounded(near.middle + half, near.slopes, near.radius + half, terms)
}

/// The length of a vector, with its derivatives.
pub(super) fn length(p: Vector<Jet>) -> Jet {
    let values = three(|k| p[k].value);
    let value = size(values);
    let inverse = value.inverse();
    let slopes = three(|k| dot(values, three(|l| p[l].slopes[k])) * inverse);
    Jet { value, slopes }
}
