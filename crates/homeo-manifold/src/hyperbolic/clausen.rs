//! Clausen's function `Cl(x) = -∫_0^x ln |2 sin(t/2)| dt = Σ sin(k x) / k²`, with enclosures.
//!
//! For `|x| < 2π`
//!
//! ```text
//! Cl(x) = x (1 - ln |x| + 2 Σ_{n>=1} ζ(2n) / (2n (2n+1)) (x / 2π)^2n),
//! ```
//!
//! by integrating `ln (2 sin(t/2) / t) = -Σ ζ(2n)/n (t/2π)^2n`, the logarithm of Euler's product.

use super::enclosure::Enclosure;

/// Terms of the series. For angles up to 3.3 the rest is below `2.2 / (56 · 57) · 0.276^28 / 0.724 < 3e-19`.
const TERMS: usize = 27;
/// Sums for ζ have so many terms.
const ADDENDS: usize = 30;
/// No value is larger: `Cl(π/3) = 1.01494...`.
const LARGEST: f64 = 1.015;

/// The coefficients `2 ζ(2n) / (2n (2n+1) (2π)^2n)` of the powers `x^2n`, `n` from 1.
pub(super) struct Clausen {
    coefficients: [Enclosure; TERMS],
}

impl Clausen {
    /// Computes the coefficients.
    pub(super) fn new() -> Self {
        let full = Enclosure::pi() * Enclosure::exact(2.0);
        let (square, mut power) = (full * full, Enclosure::exact(1.0));
        let zeta = zeta();
        let coefficients = std::array::from_fn(|index| {
            let order = 2.0 * (index as f64 + 1.0);
            power = power * square;
            Enclosure::exact(2.0) * zeta[index] / (Enclosure::exact(order * (order + 1.0)) * power)
        });
        Self { coefficients }
    }

    /// The values at all angles of an enclosure, in radians.
    pub(super) fn at(&self, angle: Enclosure) -> Enclosure {
        let turns = (angle.middle() / std::f64::consts::TAU).round();
        let angle = angle - Enclosure::pi() * Enclosure::exact(2.0 * turns);
        let radius = (angle.high() - angle.middle()).max(angle.middle() - angle.low()).next_up();
        if !(angle.magnitude() < 3.3 && radius < 0.3) {
            return Enclosure::between(-LARGEST, LARGEST);
        }
        let least = angle.middle().abs() - radius;
        let change = if least > radius {
            // The slope is -ln |2 sin(x/2)|: at most ln 2, or |ln (2 x / π)|, where that is below 0.
            let steepness =
                Enclosure::exact(0.7) + Enclosure::between(0.0, Enclosure::exact(0.6 * least).ln().magnitude());
            Enclosure::exact(radius) * steepness
        } else {
            // All angles are below three radii in size, and Cl is odd and grows up to π/3.
            self.value(3.01 * radius) * Enclosure::exact(2.0)
        };
        let most = change.magnitude();
        self.value(angle.middle()) + Enclosure::between(-most, most)
    }

    /// The value at one angle of at most 3.3 in size.
    fn value(&self, angle: f64) -> Enclosure {
        if angle == 0.0 {
            return Enclosure::exact(0.0);
        }
        let x = Enclosure::exact(angle);
        let square = x * x;
        let mut series = Enclosure::between(0.0, 0.0);
        for &coefficient in self.coefficients.iter().rev() {
            series = (series + coefficient) * square;
        }
        let rest = Enclosure::between(0.0, 3e-19);
        x * (Enclosure::exact(1.0) - Enclosure::exact(angle.abs()).ln() + series + rest)
    }
}

/// `ζ(2), ζ(4), ...`: the first four by powers of π, the others by sums whose rest lies between two integrals.
fn zeta() -> [Enclosure; TERMS] {
    const EVEN: [f64; 4] = [6.0, 90.0, 945.0, 9450.0];
    let one = Enclosure::exact(1.0);
    let square = Enclosure::pi() * Enclosure::pi();
    let (mut of_pi, mut powers) = (one, [one; ADDENDS]);
    std::array::from_fn(|index| {
        for (number, power) in powers.iter_mut().enumerate() {
            let base = number as f64 + 1.0;
            *power = *power / Enclosure::exact(base * base);
        }
        if let Some(&denominator) = EVEN.get(index) {
            of_pi = of_pi * square;
            return of_pi / Enclosure::exact(denominator);
        }
        let sum = powers.iter().rev().fold(Enclosure::exact(0.0), |sum, &power| sum + power);
        // The integral of t^-k from N on is N^-k N / (k - 1); for the rest after N terms it starts between N and N + 1.
        let order = 2.0 * (index as f64 + 1.0);
        let most = powers[ADDENDS - 1] * Enclosure::exact(ADDENDS as f64) / Enclosure::exact(order - 1.0);
        sum + Enclosure::between(0.0, most.high())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_the_sum_and_of_the_laws() {
        let clausen = Clausen::new();
        let catalan = clausen.at(Enclosure::pi() * Enclosure::exact(0.5));
        assert!(catalan.holds(0.915_965_594_177_219) && catalan.width() < 1e-14, "{catalan:?}");
        assert!(clausen.at(Enclosure::pi()).holds(0.0));
        for k in 1..100 {
            let x = 0.06 * f64::from(k);
            // What is left of the sum is below 1 / (N² sin(x/2)).
            let sum: f64 = (1..30_000).rev().map(|n| (x * f64::from(n)).sin() / f64::from(n).powi(2)).sum();
            let found = clausen.at(Enclosure::exact(x));
            assert!((found.middle() - sum).abs() < 1e-7 && found.width() < 3e-14, "{x} {sum} {found:?}");
            // Cl(2x) = 2 Cl(x) - 2 Cl(π - x): enclosures of both sides meet.
            let two = Enclosure::exact(2.0);
            let right = two * (found - clausen.at(Enclosure::pi() - Enclosure::exact(x)));
            assert!(clausen.at(two * Enclosure::exact(x)).common(right).is_some(), "{x}");
            // Negative control: not with another factor.
            let wrong = right * Enclosure::exact(1.0 + 1e-10);
            assert!(right.magnitude() < 1e-3 || clausen.at(two * Enclosure::exact(x)).common(wrong).is_none(), "{x}");
        }
    }

    #[test]
    fn wide_enclosures_hold_the_values_at_points() {
        let clausen = Clausen::new();
        for k in -60..60 {
            for width in [1e-3, 0.05, 0.2, 0.7] {
                let low = 0.113 * f64::from(k);
                let wide = clausen.at(Enclosure::between(low, low + width));
                for step in 0..=10 {
                    let point = clausen.at(Enclosure::exact(low + width * f64::from(step) / 10.0));
                    assert!(wide.low() <= point.high() && point.low() <= wide.high(), "{low} {width}");
                }
            }
        }
    }
}
