//! Affine forms in space: functions on a cube, enclosed by an affine function and a radius.
//!
//! What varies is written by the coordinates of the cube, from -1 to 1; what is of second order goes to the radius (de
//! Figueiredo, Stolfi 2004).
//!
//! # Rounding
//! A rounded operation is within `EPSILON / 2` of its result, or within `2^-1074`. A middle and each slope are sums of products
//! of at most six operations, so they are off by less than `4 EPSILON` times the sizes of their terms, of which
//! [`Form::rounded`] takes the sum. Radii are sums of products of non-negative numbers, of fewer than thirty operations.
//! A radius that is NaN or infinite says that nothing is known; comparisons with it fail.

use std::ops::{Add, Mul, Neg, Sub};

/// All functions within `radius` of `middle + slopes . coordinates`.
#[derive(Clone, Copy, Debug)]
pub(in crate::cage) struct Form {
    pub middle: f64,
    pub slopes: [f64; 3],
    pub radius: f64,
}

/// More than all underflows of an operation.
const UNDERFLOW: f64 = 1e-300;
/// Makes up for the rounding of a radius.
const UPWARDS: f64 = 1.0 + 32.0 * f64::EPSILON;

impl Form {
    pub const ZERO: Self = Self::exact(0.0);
    pub const ONE: Self = Self::exact(1.0);
    pub const UNKNOWN: Self = Self { middle: 0.0, slopes: [0.0; 3], radius: f64::INFINITY };

    /// A double, exactly.
    pub const fn exact(value: f64) -> Self {
        Self { middle: value, slopes: [0.0; 3], radius: 0.0 }
    }

    /// The coordinate with the number `axis`, no farther than `by` from a place.
    pub fn about(place: f64, by: f64, axis: usize) -> Self {
        let mut slopes = [0.0; 3];
        slopes[axis] = by;
        Self { middle: place, slopes, radius: 0.0 }
    }

    /// What an operation gives; `terms` is the sum of the sizes of all terms of middle and slopes.
    pub fn rounded(middle: f64, slopes: [f64; 3], radius: f64, terms: f64) -> Self {
        Self { middle, slopes, radius: (radius + 4.0 * f64::EPSILON * terms) * UPWARDS + UNDERFLOW }
    }

    /// At least how far values are from the middle.
    pub fn deviation(self) -> f64 {
        (self.varied() + self.radius) * UPWARDS
    }

    /// No more than any value.
    pub fn least(self) -> f64 {
        (self.middle - self.deviation()).next_down()
    }

    /// No less than any value.
    pub fn most(self) -> f64 {
        (self.middle + self.deviation()).next_up()
    }

    /// No less than the size of any value.
    pub fn size(self) -> f64 {
        (self.middle.abs() + self.deviation()).next_up()
    }

    pub fn is_negative(self) -> bool {
        self.most() < 0.0
    }

    /// Whether no value is zero.
    pub fn has_sign(self) -> bool {
        self.most() < 0.0 || self.least() > 0.0
    }

    /// All functions no farther away than `by`, besides.
    pub fn widened(self, by: f64) -> Self {
        Self { radius: (self.radius + by) * UPWARDS, ..self }
    }

    pub fn square(self) -> Self {
        self * self
    }

    /// `1 / (m + d) = 1 / m - d / m^2 + d^2 / (m^2 (m + d))`; half of the greatest last term goes to the middle.
    pub fn inverse(self) -> Self {
        let deviation = self.deviation();
        let left = self.middle.abs() - deviation;
        if !(left > 1e-6 * self.middle.abs() && left > 1e-200) {
            return Self::UNKNOWN;
        }
        let inverse = 1.0 / self.middle;
        let square = inverse * inverse;
        // The difference is known to 1e-9 of itself.
        let half = 0.5 * square * deviation * deviation / left * (1.0 + 1e-9);
        let slopes = self.slopes.map(|x| -square * x);
        let terms = inverse.abs() + half + square * self.varied();
        Self::rounded(inverse + half.copysign(inverse), slopes, square * self.radius + half, terms)
    }

    /// The length of a vector: between `u . p` and `u . p + |u x p|^2 / (2 u . p)`, for a unit vector `u` with `u . p > 0`.
    pub fn length(p: [Form; 3]) -> Self {
        let middles = p.map(|c| c.middle);
        let norm = dot_of(middles, middles).sqrt();
        let unit = middles.map(|x| Form::exact(x / norm));
        let near = dot(unit, p);
        let least = near.least();
        if !(least > 1e-6 * norm && norm > 1e-140 && norm < 1e140) {
            return Self::UNKNOWN;
        }
        let across = cross(unit, p).map(|c| c.size() * c.size()).iter().sum::<f64>();
        let half = 0.25 * across / least * (1.0 + 1e-9);
        // `u` is rounded, too: its length is off by less than three units.
        let terms = near.middle.abs() + near.varied() + half;
        Self::rounded(near.middle + half, near.slopes, near.radius + half, 2.0 * terms)
    }

    fn varied(self) -> f64 {
        self.slopes[0].abs() + self.slopes[1].abs() + self.slopes[2].abs()
    }
}

impl Add for Form {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let slopes = [0, 1, 2].map(|k| self.slopes[k] + other.slopes[k]);
        let middle = self.middle + other.middle;
        let terms = middle.abs() + slopes.iter().map(|x| x.abs()).sum::<f64>();
        Self::rounded(middle, slopes, self.radius + other.radius, terms)
    }
}

impl Neg for Form {
    type Output = Self;
    fn neg(self) -> Self {
        Self { middle: -self.middle, slopes: self.slopes.map(|x| -x), radius: self.radius }
    }
}

impl Sub for Form {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Form {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (m, n) = (self.middle, other.middle);
        let slopes = [0, 1, 2].map(|k| m * other.slopes[k] + n * self.slopes[k]);
        let (varied, others) = (self.varied(), other.varied());
        let radius =
            varied * others + (m.abs() + varied) * other.radius + self.radius * (n.abs() + others + other.radius);
        let terms = (m.abs() + varied) * (n.abs() + others);
        Self::rounded(m * n, slopes, radius, terms)
    }
}

pub(in crate::cage) fn dot(a: [Form; 3], b: [Form; 3]) -> Form {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(in crate::cage) fn cross(a: [Form; 3], b: [Form; 3]) -> [Form; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(k, l)| a[k] * b[l] - a[l] * b[k])
}

pub(in crate::cage) fn minus(a: [Form; 3], b: [Form; 3]) -> [Form; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub(in crate::cage) fn times(factor: Form, a: [Form; 3]) -> [Form; 3] {
    a.map(|x| factor * x)
}

fn dot_of(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use homeo_core::number::Rational;

    struct Random(u64);

    impl Random {
        /// In `[-1, 1]`, sometimes at the ends.
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let unit = (self.0 >> 11) as f64 / 2f64.powi(52) - 1.0;
            if self.0 >> 60 < 4 { unit.signum() } else { unit }
        }

        fn form(&mut self) -> Form {
            let (scale, width) =
                (2f64.powi((20.0 * self.next()) as i32), 2f64.powi((20.0 * self.next() - 20.0) as i32));
            let slopes = [(); 3].map(|()| scale * width * self.next());
            Form { middle: scale * self.next(), slopes, radius: scale * width * width * self.next().abs() }
        }
    }

    fn exact(x: f64) -> Rational {
        Rational::from_f64(x).unwrap()
    }

    /// A number that a form stands for at a place.
    fn value(form: Form, at: [f64; 3], share: f64) -> Rational {
        let parts = (0..3).map(|k| exact(form.slopes[k]) * exact(at[k]));
        parts.fold(exact(form.middle) + exact(form.radius) * exact(share), |sum, part| sum + part)
    }

    fn holds(form: Form, at: [f64; 3], number: &Rational, share: f64) -> bool {
        *number >= value(form, at, -share) && *number <= value(form, at, share)
    }

    /// Exact values are in the forms of all operations; in forms with a hundredth of the radius they often are not.
    #[test]
    fn values_stay_in_their_forms() {
        let mut random = Random(3);
        let (mut known, mut outside) = ([0; 4], 0);
        for _ in 0..3000 {
            let (u, v) = (random.form(), random.form());
            let at = [(); 3].map(|()| random.next());
            let [x, y] = [u, v].map(|form| value(form, at, random.next()));
            let mut cases =
                vec![(u + v, x.clone() + y.clone()), (u - v, x.clone() - y.clone()), (u * v, x.clone() * y.clone())];
            if !x.is_zero() {
                cases.push((u.inverse(), exact(1.0) / x));
            }
            for (k, (form, number)) in cases.into_iter().enumerate().filter(|(_, (form, _))| form.radius.is_finite()) {
                assert!(holds(form, at, &number, 1.0), "operation {k}: {u:?} {v:?} {at:?}");
                known[k] += 1;
                outside += usize::from(!holds(form, at, &number, 0.01));
            }
        }
        assert!(known.iter().all(|&count| count > 1500) && outside > 4000, "{known:?} {outside}");
    }

    /// By squares.
    #[test]
    fn lengths_are_in_their_forms() {
        let mut random = Random(9);
        let (mut known, mut outside) = (0, 0);
        for _ in 0..3000 {
            let vector = [(); 3].map(|()| random.form());
            let (at, found) = ([(); 3].map(|()| random.next()), Form::length(vector));
            if !found.radius.is_finite() {
                continue;
            }
            let square = vector.map(|form| value(form, at, random.next())).into_iter();
            let square = square.map(|x| x.clone() * x).fold(exact(0.0), |sum, part| sum + part);
            let is_between = |share: f64| {
                let [low, high] = [-share, share].map(|share| value(found, at, share));
                low.clone() * low <= square && square <= high.clone() * high
            };
            assert!(is_between(1.0), "{vector:?} {at:?} {found:?}");
            known += 1;
            outside += usize::from(!is_between(0.01));
        }
        assert!(known > 1500 && outside > 300, "{known} {outside}");
    }
}
