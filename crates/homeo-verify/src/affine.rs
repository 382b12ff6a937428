//! Affine forms: real functions on a box, enclosed by an affine function and a radius, in floating point rounded outwards.
//!
//! A form stands for all functions of `N` coordinates in `[-1, 1]`, in the plane two, within `radius` of
//! `middle + slopes . coordinates`. A ball (`ball`)
//! forgets how a quantity moves with the others; forms remember it to first order, so what cancels in a formula cancels in its
//! enclosure, and enclosures of smooth functions are off by the square of the box only (de Figueiredo, Stolfi 2004). What
//! is of second order goes to the radius.
//!
//! *Rounding.* As in `ball`: one operation is off by `EPSILON / 2` of its result, or by `2^-1074`. Each middle and each
//! slope is a sum of products of at most six operations, so it is off by less than `4 EPSILON` times the sum of the sizes
//! of its terms; [`Self::rounded`] takes such a sum. A radius is a sum of products of numbers that are not negative, of fewer
//! than thirty operations. What is infinite or no number stays so, and passes no comparison.

use std::ops::{Add, Mul, Neg, Sub};

/// All functions within `radius` of `middle + slopes . coordinates`, where these go from -1 to 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form<const N: usize = 2> {
    pub(crate) middle: f64,
    pub(crate) slopes: [f64; N],
    pub(crate) radius: f64,
}

/// More than thirty underflows.
const UNDERFLOW: f64 = 1e-300;
/// Makes up for the rounding of a radius.
const UPWARDS: f64 = 1.0 + 32.0 * f64::EPSILON;
/// Of the sum of the sizes of its terms: more than a middle or a slope is off.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

impl<const N: usize> Form<N> {
    pub(crate) const ZERO: Self = Self::exact(0.0);
    pub(crate) const ONE: Self = Self::exact(1.0);
    pub(crate) const UNKNOWN: Self = Self { middle: 0.0, slopes: [0.0; N], radius: f64::INFINITY };

    /// A double, exactly.
    pub(crate) const fn exact(value: f64) -> Self {
        Self { middle: value, slopes: [0.0; N], radius: 0.0 }
    }

    /// The coordinate of the box with the number `axis`, from `low` to `high`.
    pub(crate) fn between([low, high]: [f64; 2], axis: usize) -> Self {
        let mut slopes = [0.0; N];
        slopes[axis] = 0.5 * (high - low);
        Self::rounded(0.5 * low + 0.5 * high, slopes, 0.0, low.abs() + high.abs())
    }

    /// What an operation gives; `terms` is the sum of the sizes of all terms of the middle and the slopes.
    pub(crate) fn rounded(middle: f64, slopes: [f64; N], radius: f64, terms: f64) -> Self {
        Self { middle, slopes, radius: (radius + terms * ROUNDED) * UPWARDS + UNDERFLOW }
    }

    /// At least how far values are from the middle.
    pub(crate) fn deviation(self) -> f64 {
        (size(self.slopes) + self.radius) * UPWARDS
    }

    /// No more than any value.
    pub(crate) fn least(self) -> f64 {
        let deviation = self.deviation();
        self.middle - deviation - f64::EPSILON * (self.middle.abs() + deviation)
    }

    /// No less than any value.
    pub(crate) fn most(self) -> f64 {
        -(-self).least()
    }

    /// No less than the size of any value.
    pub(crate) fn size(self) -> f64 {
        self.most().max(-self.least())
    }

    /// All functions that are no farther away than `by`, besides.
    pub(crate) fn widened(self, by: f64) -> Self {
        Self { radius: (self.radius + by) * UPWARDS, ..self }
    }

    /// `slope` times this and a constant, and all functions no farther from that than `radius`.
    pub(crate) fn on_line(self, slope: f64, constant: f64, radius: f64) -> Self {
        let terms = constant.abs() + slope.abs() * self.terms();
        let slopes = self.slopes.map(|a| slope * a);
        Self::rounded(constant + slope * self.middle, slopes, slope.abs() * self.radius + radius, terms)
    }

    /// The sum of the sizes of middle and slopes.
    pub(crate) fn terms(self) -> f64 {
        self.middle.abs() + size(self.slopes)
    }

    pub(crate) fn is_positive(self) -> bool {
        self.middle > self.deviation()
    }

    pub(crate) fn is_negative(self) -> bool {
        -self.middle > self.deviation()
    }

    /// The inverse, by the line of its secant: `1 / u + u / (l h)` is convex, and greatest at both ends of `[l, h]`, where it
    /// is `1 / l + 1 / h`, and least at the root of `l h`. With any other slope `-p` near this one, and a constant `c`, the
    /// error `1 / u + p u - c` lies between `2 sqrt p - c` and the greater one of its values at the ends.
    pub(crate) fn inverse(self) -> Self {
        if self.middle < 0.0 {
            return -(-self).inverse();
        }
        let [low, high] = [self.least(), self.most()];
        if !(low > 0.0 && high.is_finite()) {
            return Self::UNKNOWN;
        }
        let slope = 1.0 / (low * high);
        let (most, least) = ((1.0 / low + slope * low).max(1.0 / high + slope * high), 2.0 * slope.sqrt());
        let constant = 0.5 * (most + least);
        self.on_line(-slope, constant, 0.5 * (most - least).max(0.0) + ROUNDED * (most + constant))
    }
}

impl<const N: usize> Add for Form<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let slopes = std::array::from_fn(|k| self.slopes[k] + other.slopes[k]);
        let middle = self.middle + other.middle;
        let terms = middle.abs() + size(slopes);
        Self::rounded(middle, slopes, self.radius + other.radius, terms)
    }
}

impl<const N: usize> Neg for Form<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { middle: -self.middle, slopes: self.slopes.map(f64::neg), radius: self.radius }
    }
}

impl<const N: usize> Sub for Form<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const N: usize> Mul for Form<N> {
    type Output = Self;
    /// Squares of coordinates lie between 0 and 1: half of what they are multiplied by goes to the middle.
    #[inline]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.slopes, other.slopes);
        let slopes = std::array::from_fn(|k| self.middle * b[k] + other.middle * a[k]);
        let (mut squares, mut halves, mut mixed) = (0.0, 0.0, 0.0);
        for k in 0..N {
            squares += a[k] * b[k];
            halves += 0.5 * (a[k] * b[k]).abs();
            for l in 0..k {
                mixed += (a[k] * b[l] + a[l] * b[k]).abs();
            }
        }
        let (most, other_most) = (self.terms(), other.terms());
        let radius = (halves + mixed) + (most * other.radius + (other_most + other.radius) * self.radius);
        let terms = most * other_most;
        Self::rounded(self.middle * other.middle + 0.5 * squares, slopes, radius, terms)
    }
}

/// The sum of the sizes of numbers.
fn size<const N: usize>(numbers: [f64; N]) -> f64 {
    numbers.iter().map(|x| x.abs()).sum()
}

/// A vector of the plane.
pub(crate) type Vector = [Form; 2];

pub(crate) fn vector(of: impl Fn(usize) -> Form) -> Vector {
    [of(0), of(1)]
}

/// The length of a vector: `|p| = u . p + (u x p)^2 / (|p| + u . p)` for any unit vector `u` with `u . p > 0`. The last term
/// is no more than half its numerator over `u . p`, and no more than the size of `u x p`.
pub(crate) fn length(p: Vector) -> Form {
    let [x, y] = p.map(|c| c.middle);
    let size = (x * x + y * y).sqrt();
    let u = [x / size, y / size];
    let along = dot(u.map(Form::exact), p);
    let least = (along.middle - along.deviation()) * (1.0 - f64::EPSILON);
    if !(least > 0.0 && least.is_finite() && size > 1e-140) {
        return Form::UNKNOWN;
    }
    let across = cross(u.map(Form::exact), p);
    let most = (across.middle.abs() + across.deviation()) * UPWARDS;
    let half = 0.5 * most.min(most * most / (2.0 * least)) * UPWARDS;
    // `u` is rounded: its length is off by less than three units, which scales both products alike.
    let terms = along.terms() + along.radius + 2.0 * half;
    Form::rounded(along.middle + half, along.slopes, along.radius + half, terms)
}

pub(crate) fn dot(a: Vector, b: Vector) -> Form {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Form {
    a[0] * b[1] - a[1] * b[0]
}

/// A function's value and its derivatives along two directions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dual(pub(crate) [Form; 3]);

impl Dual {
    pub(crate) const ZERO: Dual = Dual([Form::ZERO; 3]);

    /// A constant.
    pub(crate) fn constant(value: Form) -> Dual {
        Dual([value, Form::ZERO, Form::ZERO])
    }

    pub(crate) fn scaled(self, factor: Form) -> Dual {
        Dual(self.0.map(|x| x * factor))
    }

    /// The quotient: `(a / b)' = (a' - (a / b) b') / b`.
    pub(crate) fn over(self, other: Dual) -> Dual {
        let inverse = other.0[0].inverse();
        let value = self.0[0] * inverse;
        let slope = |k: usize| (self.0[k] - value * other.0[k]) * inverse;
        Dual([value, slope(1), slope(2)])
    }
}

impl Add for Dual {
    type Output = Dual;
    fn add(self, other: Dual) -> Dual {
        Dual([0, 1, 2].map(|k| self.0[k] + other.0[k]))
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual(self.0.map(Form::neg))
    }
}

impl Sub for Dual {
    type Output = Dual;
    fn sub(self, other: Dual) -> Dual {
        self + -other
    }
}

impl Mul for Dual {
    type Output = Dual;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule has a sum")]
    fn mul(self, other: Dual) -> Dual {
        let ([a, ..], [b, ..]) = (self.0, other.0);
        let slope = |k: usize| a * other.0[k] + self.0[k] * b;
        Dual([a * b, slope(1), slope(2)])
    }
}

#[cfg(test)]
mod tests;
