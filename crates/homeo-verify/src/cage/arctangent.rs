//! The quotient `arctan(x) / x` as a function of `u = x^2`, with its derivatives, enclosed.
//!
//! It is the first of `m_k(u) = ∫ t^(2k) / (1 + u t^2)^(k+1) dt`, `0 <= t <= 1`. These are positive and convex for `u >= 0`, for
//! `m_k' = -(k + 1) m_(k+1)`, and no more than `1 / (2 k + 1)` and `(1 + u)^-k`, for `t^2 / (1 + u t^2) <= 1 / (1 + u)`. By parts
//! `(2 k - 1) m_(k-1) = 2 k u m_k + (1 + u)^-k`.

use super::jet::{Form, Jet, three};

/// More than the relative errors of `moments`, which are below `10^-14`.
const ROUNDED: f64 = 1e-13;
/// `m_0`, `m_1`, `m_2`, in doubles. From above, where `(1 + u)^-k` is left out for a `k` with `(u / (1 + u))^k < 10^-17`, all
/// terms are positive; from below, for `u > 1/4`, differences lose less than a digit each.
fn moments(u: f64) -> [f64; 3] {
    let inverse = 1.0 / (1.0 + u);
    if u <= 0.25 {
        let first = if u < 0.01 { 10 } else { 26 };
        let (mut below, mut power) = ([0.0; 3], inverse.powi(first));
        for k in (1..=first).rev() {
            let k = f64::from(k);
            below = [(2.0 * k * u * below[0] + power) / (2.0 * k - 1.0), below[0], below[1]];
            power *= 1.0 + u;
        }
        return below;
    }
    let zeroth = whole(u);
    let first = (zeroth - inverse) / (2.0 * u);
    [zeroth, first, (3.0 * first - inverse * inverse) / (4.0 * u)]
}

/// `m_0`, by half of the angle until `u` is small.
fn whole(u: f64) -> f64 {
    if u <= 0.25 {
        return moments(u)[0];
    }
    let root = 1.0 + (1.0 + u).sqrt();
    2.0 / root * whole(u / root / root)
}

/// Encloses `m_k` for each of the given `k <= 2`, where `u` is known not to be negative: by its chord, above which it is not, and
/// below which it is not farther than an eighth of the greatest second derivative times the square of the width.
fn enclosed<const N: usize>(orders: [usize; N], u: Form) -> [Form; N] {
    let [low, high] = [u.least().max(0.0), u.most()];
    if !(high >= low && high.is_finite()) {
        return [Form::UNKNOWN; N];
    }
    let [first, last] = [low, high].map(moments);
    let width = high - low;
    orders.map(|k| {
        let [first, last, order] = [first[k], last[k], k as f64];
        let slope = if width > 0.0 { (last - first) / width } else { 0.0 };
        let bend = (order + 1.0) * (order + 2.0) * (1.0 / (2.0 * order + 5.0)).min((1.0 + low).powi(-(k as i32) - 2));
        let below = 0.125 * bend * width * width * (1.0 + 16.0 * f64::EPSILON);
        let rounded = ROUNDED * (first + slope.abs() * (low + width));
        u.on_line(slope, first - slope * low - 0.5 * below, 0.5 * below + rounded)
    })
}

/// `arctan(√u) / √u`.
pub(super) fn arctangent(u: Jet) -> Jet {
    let [value, slope] = enclosed([0, 1], u.value);
    Jet { value, slopes: u.slopes.map(|x| -(slope * x)) }
}

/// The difference quotient of the same function between two places: at their middle its derivative, but for a 24th of the third
/// derivative times the square of the difference; slopes by either place are half the second derivative there, but for an
/// eighth of the third derivative times the difference. The third derivative is `6 m_3`, greatest at the lesser place.
pub(super) fn quotient(u: Jet, other: Jet) -> Jet {
    let middle = (u.value + other.value) * Form::exact(0.5);
    let apart = (u.value - other.value).size();
    let [slope, bend] = enclosed([1, 2], middle);
    let least = u.value.least().min(other.value.least()).max(0.0);
    let third = 6.0 * (1.0f64 / 7.0).min((1.0 + least).powi(-3)) * (1.0 + 16.0 * f64::EPSILON);
    let slopes = three(|k| {
        let (a, b) = (u.slopes[k], other.slopes[k]);
        (bend * (a + b)).widened(0.125 * third * apart * (a.size() + b.size()))
    });
    Jet { value: (-slope).widened(third / 24.0 * apart * apart), slopes }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simpson's rule.
    fn integral(k: i32, u: f64) -> f64 {
        let count = 20_000;
        let at = |i: i32| {
            let t = f64::from(i) / f64::from(count);
            (t * t).powi(k) / (1.0 + u * t * t).powi(k + 1)
        };
        (0..count / 2).map(|i| at(2 * i) + 4.0 * at(2 * i + 1) + at(2 * i + 2)).sum::<f64>() / f64::from(3 * count)
    }

    #[test]
    fn moments_are_integrals() {
        for u in [0.0, 1e-9, 0.1, 0.3, 0.5, 0.500001, 1.0, 2.0, 7.0, 40.0, 900.0] {
            for (k, found) in (0..).zip(moments(u)) {
                let expected = integral(k, u);
                assert!((found - expected).abs() < 1e-9 * expected, "{k} {u} {found} {expected}");
            }
            let root = u.sqrt();
            let expected = if u > 0.0 { root.atan() / root } else { 1.0 };
            assert!((moments(u)[0] - expected).abs() < 16.0 * f64::EPSILON * expected, "{u}");
        }
    }

    #[test]
    fn values_lie_in_their_enclosures() {
        for low in [0.0, 0.01, 0.3, 0.49, 1.0, 5.0, 80.0] {
            for width in [0.0, 1e-6, 0.01, 0.3] {
                let high = low + width * (1.0 + low);
                let form = Form::between([low, high], 1);
                for k in 0..3 {
                    let [found] = enclosed([k], form);
                    let steps = [0.0, 0.2, 0.5, 0.7, 1.0];
                    let places = steps.map(|t| (low + t * (high - low), 2.0 * t - 1.0));
                    let misses = places.map(|(u, at)| (found.middle + found.slopes[1] * at - moments(u)[k]).abs());
                    let most = misses.into_iter().fold(0.0, f64::max);
                    let radius = found.radius;
                    assert!(most <= radius, "{k} {low} {width}: {most} {radius}");
                    // The control: a third of the radius is too little, where it is not all rounding.
                    assert!(width < 0.01 || low > 1.0 || most > radius / 3.0, "{k} {low} {width}: {most} {radius}");
                }
            }
        }
    }

    #[test]
    fn quotients_hold_differences() {
        let values = [0.0f64, 0.2, 0.21, 0.9, 3.0, 3.5];
        for u in values {
            for other in values.into_iter().filter(|&other| (other - u).abs() < 1.0 && other != u) {
                let jet = |x: f64, slopes: [f64; 3]| Jet { value: Form::exact(x), slopes: slopes.map(Form::exact) };
                let of = |a: f64, b: f64| (moments(a)[0] - moments(b)[0]) / (a - b);
                let found = quotient(jet(u, [1.0, 0.0, 1.0]), jet(other, [0.0, 1.0, 1.0]));
                let h = 1e-5;
                let [by, by_other] = [of(u + h, other) - of(u, other), of(u, other + h) - of(u, other)].map(|d| d / h);
                let misses = [(found.value, of(u, other)), (found.slopes[0], by), (found.slopes[1], by_other)];
                for (form, expected) in misses {
                    assert!((form.middle - expected).abs() <= form.deviation() + 1e-4, "{u} {other}");
                    assert!(form.deviation() < 0.2, "{u} {other}");
                }
            }
        }
    }
}
