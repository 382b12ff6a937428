//! `arctan(√u) / √u` and its difference quotients, enclosed.
//!
//! It is `m_0`, with `m_k(u) = ∫ t^2k / (1 + u t^2)^(k+1) dt` from 0 to 1: positive, `m_k' = -(k+1) m_(k+1)`, no more than
//! `1 / (2k+1)` and `(1+u)^-k`; by parts `(2k-1) m_(k-1) = 2 k u m_k + (1+u)^-k`. The difference quotient of `m_0` between `c - d` and
//! `c + d` is the integral of `-t^2 / ((1 + c t^2)^2 - d^2 t^4)`, so it is `-(m_1 + d^2 m_3 + d^4 m_5 + ...)` at `c`.

use super::form::Form;

/// More than the errors of what is computed in doubles here.
const ROUNDED: f64 = 1e-14;
/// Orders that are used; powers of `1/10` beyond are below rounding.
const ORDERS: usize = 18;
/// Of `1 + c`: the most of `d` for which the series is taken.
const NEAR: f64 = 0.1;

/// `m_0`, `m_1`, ..., in doubles; `u` is not negative. From above, terms are positive and what is left out is below `5^-22` of
/// them; from below errors grow by up to `1/u` each time, and the powers of `d` by less.
fn moments(u: f64) -> [f64; ORDERS] {
    let mut moments = [0.0; ORDERS];
    if u <= 0.25 {
        let mut above = 0.0;
        for k in (1..ORDERS + 22).rev() {
            let order = k as f64;
            above = (2.0 * order * u * above + (1.0 + u).powi(-(k as i32))) / (2.0 * order - 1.0);
            if k <= ORDERS {
                moments[k - 1] = above;
            }
        }
        return moments;
    }
    moments[0] = u.sqrt().atan() / u.sqrt();
    for k in 1..ORDERS {
        let order = k as f64;
        moments[k] = ((2.0 * order - 1.0) * moments[k - 1] - (1.0 + u).powi(-(k as i32))) / (2.0 * order * u);
    }
    moments
}

/// By the tangent at the middle, above which the function is by no more than `m_2` times the square of the deviation.
pub(super) fn arctangent(u: Form) -> Form {
    let Some((at, deviation, low)) = place(u) else { return Form::UNKNOWN };
    let [value, slope, ..] = moments(at);
    let above = bound(2, low) * deviation * deviation;
    on_tangent(u, at, value, -slope, above)
}

/// The difference quotient between two places.
pub(super) fn quotient(u: Form, other: Form) -> Form {
    let half = Form::exact(0.5);
    let [middle, apart] = [half * (u + other), half * (u - other)];
    if apart.middle.abs() > NEAR * (1.0 + middle.middle.abs()) {
        return half * (arctangent(u) - arctangent(other)) * apart.inverse();
    }
    let Some((at, deviation, low)) = place(middle) else { return Form::UNKNOWN };
    // Of the terms after the first the slopes are bounded only: they add up to less than these geometric sums.
    let share = apart.size() / (1.0 + low);
    if share.is_nan() || share >= 2.0 * NEAR {
        return Form::UNKNOWN;
    }
    let sums = (1.0 - share * share).powi(-2);
    let slack = (4.0 * share * share * deviation + 2.0 * share * apart.deviation()) * sums;
    let moments = moments(at);
    let square = apart.middle * apart.middle;
    let later = (1..ORDERS / 2).rev().fold(0.0, |sum, n| (sum + moments[2 * n + 1]) * square);
    // `-m_1` is concave.
    let below = 3.0 * bound(3, low) * deviation * deviation;
    let first = on_tangent(middle, at, -moments[1], 2.0 * moments[2], -below);
    (first - Form::exact(later)).widened((slack + ROUNDED) * (1.0 + 1e-12))
}

/// The middle, the deviation from it and the least place; none if little is known.
fn place(u: Form) -> Option<(f64, f64, f64)> {
    let at = if u.middle > 0.0 { u.middle } else { 0.0 };
    let deviation = u.deviation() + (at - u.middle);
    let low = if u.least() > 0.0 { u.least() } else { 0.0 };
    (deviation.is_finite() && at.is_finite()).then_some((at, deviation, low))
}

/// No less than `m_k` from a place on.
fn bound(k: i32, low: f64) -> f64 {
    let (a, b) = (1.0 / f64::from(2 * k + 1), (1.0 + low).powi(-k));
    (if a < b { a } else { b }) * (1.0 + 1e-12)
}

/// `value + slope (u - at)`, and up to `more` besides, which may be negative.
fn on_tangent(u: Form, at: f64, value: f64, slope: f64, more: f64) -> Form {
    let line = Form::exact(value) + Form::exact(slope) * (u - Form::exact(at));
    let half = 0.5 * more * (1.0 + 1e-12);
    (line + Form::exact(half)).widened(half.abs() + ROUNDED * (1.0 + u.deviation()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_quotients_lie_in_their_enclosures() {
        let exact = |u: f64| if u > 0.0 { u.sqrt().atan() / u.sqrt() } else { 1.0 };
        let mut telling = 0;
        for (at, apart) in [0.0, 0.05, 0.24, 0.26, 0.7, 3.0, 40.0]
            .into_iter()
            .flat_map(|at| [0.1, 0.15, 0.5, 2.0].map(|apart| (at, apart)))
        {
            for by in [0.0, 1e-9, 0.001, 0.01] {
                let form = Form::about(at + by, by, 1);
                for t in [-1.0, -0.3, 0.5, 1.0] {
                    let [value, other] = [arctangent(form), quotient(form, Form::exact(at + apart))];
                    let u = at + by + by * t;
                    let miss = (value.middle + t * value.slopes[1] - exact(u)).abs();
                    assert!(miss <= value.radius, "{at} {by} {t}");
                    telling += usize::from(miss > 0.3 * value.radius && by > 1e-3);
                    let expected = (exact(u) - exact(at + apart)) / (u - at - apart);
                    assert!(
                        (other.middle + t * other.slopes[1] - expected).abs() <= other.radius + 1e-14,
                        "{at} {by} {t}"
                    );
                    assert!(other.radius < 1e-13 + 0.2 * by, "{at} {by} {t} {other:?}");
                }
            }
        }
        assert!(telling > 10, "{telling}");
    }
}
