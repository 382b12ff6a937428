//! Affine forms: real functions on a box, enclosed by an affine function and a radius, in floating point rounded outwards.
//!
//! A form stands for all functions of `x`, `y` in `[-1, 1]` within `radius` of `middle + slopes . (x, y)`. A ball (`ball`)
//! forgets how a quantity moves with the others; forms remember it to first order, so what cancels in a formula cancels in its
//! enclosure, and enclosures of smooth functions are off by the square of the box only (de Figueiredo, Stolfi 2004). What
//! is of second order goes to the radius.
//!
//! *Rounding.* As in `ball`: one operation is off by `EPSILON / 2` of its result, or by `2^-1074`. Each middle and each
//! slope is a sum of products of at most six operations, so it is off by less than `4 EPSILON` times the sum of the sizes
//! of its terms; [`Form::rounded`] takes such a sum. A radius is a sum of products of numbers that are not negative, of fewer
//! than thirty operations. What is infinite or no number stays so, and passes no comparison.

use std::ops::{Add, Mul, Neg, Sub};

/// All functions within `radius` of `middle + slopes . (x, y)`, where `x` and `y` go from -1 to 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form {
    pub(crate) middle: f64,
    slopes: [f64; 2],
    radius: f64,
}

/// More than thirty underflows.
const UNDERFLOW: f64 = 1e-300;
/// Makes up for the rounding of a radius.
const UPWARDS: f64 = 1.0 + 32.0 * f64::EPSILON;
/// Of the sum of the sizes of its terms: more than a middle or a slope is off.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

impl Form {
    pub(crate) const ZERO: Form = Form::exact(0.0);
    pub(crate) const ONE: Form = Form::exact(1.0);
    const UNKNOWN: Form = Form { middle: 0.0, slopes: [0.0; 2], radius: f64::INFINITY };

    /// A double, exactly.
    pub(crate) const fn exact(value: f64) -> Form {
        Form { middle: value, slopes: [0.0; 2], radius: 0.0 }
    }

    /// The coordinate of the box with the number `axis`, from `low` to `high`.
    pub(crate) fn between([low, high]: [f64; 2], axis: usize) -> Form {
        let mut slopes = [0.0; 2];
        slopes[axis] = 0.5 * (high - low);
        Form::rounded(0.5 * low + 0.5 * high, slopes, 0.0, low.abs() + high.abs())
    }

    /// What an operation gives; `terms` is the sum of the sizes of all terms of the middle and the slopes.
    fn rounded(middle: f64, slopes: [f64; 2], radius: f64, terms: f64) -> Form {
        Form { middle, slopes, radius: (radius + terms * ROUNDED) * UPWARDS + UNDERFLOW }
    }

    /// At least how far values are from the middle.
    pub(crate) fn deviation(self) -> f64 {
        (self.slopes[0].abs() + self.slopes[1].abs() + self.radius) * UPWARDS
    }

    /// The sum of the sizes of middle and slopes.
    fn terms(self) -> f64 {
        self.middle.abs() + self.slopes[0].abs() + self.slopes[1].abs()
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
    pub(crate) fn inverse(self) -> Form {
        if self.middle < 0.0 {
            return -(-self).inverse();
        }
        let deviation = self.deviation();
        let low = (self.middle - deviation) * (1.0 - f64::EPSILON);
        let high = (self.middle + deviation) * (1.0 + f64::EPSILON);
        if !(low > 0.0 && high.is_finite()) {
            return Form::UNKNOWN;
        }
        let slope = 1.0 / (low * high);
        let (most, least) = ((1.0 / low + slope * low).max(1.0 / high + slope * high), 2.0 * slope.sqrt());
        let constant = 0.5 * (most + least);
        let error = 0.5 * (most - least).max(0.0) + ROUNDED * (most + constant);
        let terms = constant + slope * self.terms();
        let slopes = self.slopes.map(|a| -slope * a);
        Form::rounded(constant - slope * self.middle, slopes, slope * self.radius + error, terms)
    }
}

impl Add for Form {
    type Output = Form;
    fn add(self, other: Form) -> Form {
        let slopes = [0, 1].map(|k| self.slopes[k] + other.slopes[k]);
        let middle = self.middle + other.middle;
        let terms = middle.abs() + slopes[0].abs() + slopes[1].abs();
        Form::rounded(middle, slopes, self.radius + other.radius, terms)
    }
}

impl Neg for Form {
    type Output = Form;
    fn neg(self) -> Form {
        Form { middle: -self.middle, slopes: self.slopes.map(f64::neg), radius: self.radius }
    }
}

impl Sub for Form {
    type Output = Form;
    fn sub(self, other: Form) -> Form {
        self + -other
    }
}

impl Mul for Form {
    type Output = Form;
    /// Squares of coordinates lie between 0 and 1: half of what they are multiplied by goes to the middle.
    fn mul(self, other: Form) -> Form {
        let ([a, b], [c, d]) = (self.slopes, other.slopes);
        let (squares, mixed) = ([a * c, b * d], (a * d).abs() + (b * c).abs());
        let slopes = [0, 1].map(|k| self.middle * other.slopes[k] + other.middle * self.slopes[k]);
        let halves = 0.5 * (squares[0].abs() + squares[1].abs());
        let (own, others) = (a.abs() + b.abs(), c.abs() + d.abs());
        let (size, other_size) = (self.middle.abs(), other.middle.abs());
        let radius = halves
            + (a * d + b * c).abs()
            + ROUNDED * mixed
            + (size + own) * other.radius
            + (other_size + others + other.radius) * self.radius;
        let terms = size * (other_size + others) + other_size * own + halves;
        Form::rounded(self.middle * other.middle + 0.5 * (squares[0] + squares[1]), slopes, radius, terms)
    }
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
mod tests {
    use super::*;
    use dashu_ratio::RBig;

    fn exact(x: f64) -> RBig {
        RBig::try_from(x).expect("finite")
    }

    fn size(x: RBig) -> RBig {
        if x < RBig::ZERO { -x } else { x }
    }

    /// How far a number is from what a form says at a place, over its radius.
    fn miss(form: Form, at: [f64; 2], number: &RBig) -> f64 {
        let there = exact(form.middle) + exact(form.slopes[0]) * exact(at[0]) + exact(form.slopes[1]) * exact(at[1]);
        (size(number - there) / exact(form.radius)).to_f64().value()
    }

    /// Random doubles in `[-1, 1]`, from a fixed seed; some are at the ends.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let unit = (self.0 >> 11) as f64 / 2f64.powi(52) - 1.0;
            if (self.0 >> 60) < 4 { unit.signum() } else { unit }
        }

        fn form(&mut self) -> Form {
            let scale = 2f64.powi((self.next() * 40.0) as i32);
            let width = 2f64.powi((self.next() * 20.0 - 20.0) as i32);
            let [a, b, r] = [self.next() * width, self.next() * width, self.next().abs() * width * width];
            Form { middle: scale * self.next(), slopes: [scale * a, scale * b], radius: scale * r }
        }
    }

    /// A number that a form stands for at a place.
    fn value(form: Form, at: [f64; 2], share: f64) -> RBig {
        let there = exact(form.middle) + exact(form.slopes[0]) * exact(at[0]) + exact(form.slopes[1]) * exact(at[1]);
        there + exact(form.radius) * exact(share)
    }

    /// Exact values at places of the box are in the forms of all operations; in forms with a hundredth of the radius they often
    /// are not.
    #[test]
    fn values_stay_in_their_forms() {
        let mut random = Random(3);
        let (mut known, mut outside) = ([0; 5], 0);
        for _ in 0..6000 {
            let (u, v) = (random.form(), random.form());
            let at = [random.next(), random.next()];
            let [x, y] = [u, v].map(|form| value(form, at, random.next()));
            let zero = RBig::ZERO;
            let inverse = (x != zero).then(|| RBig::ONE / &x);
            // Three and four make five.
            let five = length([u * Form::exact(3.0), u * Form::exact(-4.0)]);
            let cases = [
                (u + v, Some(&x + &y)),
                (u - v, Some(&x - &y)),
                (u * v, Some(&x * &y)),
                (u.inverse(), inverse),
                (five, Some(exact(5.0) * size(x.clone()))),
            ];
            for (k, (form, number)) in cases.into_iter().enumerate() {
                let Some(number) = number.filter(|_| form.radius.is_finite()) else { continue };
                let miss = miss(form, at, &number);
                assert!(miss <= 1.0, "operation {k}: {u:?} {v:?} at {at:?} is off by {miss} radii");
                known[k] += 1;
                outside += usize::from(miss > 0.01);
            }
        }
        assert!(known.iter().all(|&count| count > 4000), "{known:?}");
        assert!(outside > 15_000, "{outside}");
    }

    /// Lengths of vectors whose coordinates move apart: squares are compared.
    #[test]
    fn lengths_are_in_their_forms() {
        let mut random = Random(9);
        let mut known = 0;
        for _ in 0..4000 {
            let vector = [random.form(), random.form()];
            let (at, found) = ([random.next(), random.next()], length(vector));
            if !found.radius.is_finite() {
                continue;
            }
            let [x, y] = vector.map(|form| value(form, at, random.next()));
            let square = &x * &x + &y * &y;
            let [low, high] = [-1.0, 1.0].map(|share| value(found, at, share));
            assert!(low < RBig::ZERO || &low * &low <= square, "{vector:?} {at:?}");
            assert!(high > RBig::ZERO && &high * &high >= square, "{vector:?} {at:?}");
            known += 1;
        }
        assert!(known > 3000, "{known}");
    }

    /// What cancels to first order leaves a radius of second order: `(1 + x) / (1 + x)`, `|(1, x)| - 1`.
    #[test]
    fn what_cancels_leaves_little() {
        for width in [1e-1, 1e-2, 1e-3] {
            let x = Form::between([-width, width], 0);
            let ratio = (Form::ONE + x) * (Form::ONE + x).inverse() - Form::ONE;
            let longer = length([Form::ONE, x]) - Form::ONE;
            for left in [ratio, longer] {
                assert!(left.deviation() < 2.0 * width * width + 1e-14, "{width}: {left:?}");
            }
            assert!(x.deviation() > 0.99 * width, "the width itself is kept");
        }
    }

    #[test]
    fn signs_are_claimed_only_when_known() {
        let between = |low, high| Form::between([low, high], 1);
        assert!(between(0.5, 2.0).is_positive() && between(-2.0, -0.5).is_negative());
        let no_number = Form { middle: f64::NAN, slopes: [0.0; 2], radius: 1.0 };
        for form in [between(0.0, 1.0), Form::UNKNOWN, no_number, Form::ZERO] {
            assert!(!form.is_positive() && !form.is_negative());
            assert!(!(form.inverse() * form).is_negative() && !form.inverse().is_positive());
        }
    }

    #[test]
    fn derivatives_follow_the_rules() {
        // u = 3 + 2 a, v = 5 - b, at a = b = 0.
        let (u, v) = (Dual([3.0, 2.0, 0.0].map(Form::exact)), Dual([5.0, 0.0, -1.0].map(Form::exact)));
        let near = |found: Dual, wanted: [f64; 3]| {
            assert!((0..3).all(|k| (found.0[k].middle - wanted[k]).abs() <= found.0[k].radius + 1e-15), "{found:?}");
        };
        near(u * v, [15.0, 10.0, -3.0]);
        near(u.over(v), [0.6, 0.4, 0.12]);
        near(u - v.scaled(Form::exact(2.0)), [-7.0, 2.0, 2.0]);
    }
}
