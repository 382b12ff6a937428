//! Speeds: how the image of a point runs along the image of its edge.

use super::SpeedError;
use crate::composite::number::{Form, Number};

/// For each edge an increasing polynomial `σ` from `[0, 1]` onto `[0, 1]`, in Bernstein form of one degree `d` for all:
/// `σ(t) = sum c_ν b_{ν,d}(t)` with control values `0 = c_0 < c_1 < ... < c_d = 1`.
///
/// # Guarantee
/// `σ' = d sum (c_{ν+1} - c_ν) b_{ν,d-1}` has positive coefficients, so `σ` increases strictly on `[0, 1]`; outside nothing
/// is said. Also the mirror image `1 - σ(1 - t)` is of this kind, with control values `1 - c_{d-ν}`: there is no need to try
/// all combinations of both, as the source does.
///
/// ```
/// use homeo::complex::EdgeSpeeds;
/// let speeds = EdgeSpeeds::new(3, vec![vec![0.1, 0.5], vec![0.4, 0.7]])?;
/// assert_eq!(speeds.at(0, 0.0), 0.0);
/// assert!((speeds.at(0, 0.5) - (1.0 + 3.0 * 0.1 + 3.0 * 0.5) / 8.0).abs() < 1e-15);
/// assert!(EdgeSpeeds::new(3, vec![vec![0.5, 0.5]]).is_err(), "they must increase");
/// # Ok::<(), homeo::complex::SpeedError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeSpeeds {
    degree: usize,
    inner: Vec<Vec<f64>>,
}

impl EdgeSpeeds {
    /// Of control values `c_1 ... c_{d-1}` for each edge (#E by `d - 1`); `d` from 1, which is linear, to 8.
    ///
    /// # Errors
    /// The first edge with another number of them, or with control values that do not increase strictly between 0 and 1.
    pub fn new(degree: usize, inner: Vec<Vec<f64>>) -> Result<Self, SpeedError> {
        if !(1..=8).contains(&degree) {
            return Err(SpeedError::Degree { degree });
        }
        for (edge, values) in inner.iter().enumerate() {
            if values.len() + 1 != degree {
                return Err(SpeedError::Count { edge, expected: degree - 1, found: values.len() });
            }
            let all: Vec<f64> = [0.0].into_iter().chain(values.iter().copied()).chain([1.0]).collect();
            if !all.windows(2).all(|pair| pair[0] < pair[1]) {
                return Err(SpeedError::NotIncreasing { edge });
            }
        }
        Ok(Self { degree, inner })
    }

    /// Linear, as in mean value maps: the control values `c_ν = ν / d`, with which the source begins (it prints
    /// `c_{ν-1} = ν / d`, which would not end at 1).
    pub fn linear(edges: usize) -> Self {
        Self { degree: 1, inner: vec![Vec::new(); edges] }
    }

    /// The degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Inner control values of each edge (#E by `d - 1`).
    pub fn control_values(&self) -> &[Vec<f64>] {
        &self.inner
    }

    /// `σ` of an edge at `t`, rounded.
    pub fn at(&self, edge: usize, t: f64) -> f64 {
        t + t * (1.0 - t) * horner(&self.quotient::<f64>(edge), t)
    }

    /// The same for all numbers of a form.
    pub(super) fn enclose(&self, edge: usize, t: Form) -> Form {
        t + t * (Form::of(1.0) - t) * horner(&self.quotient::<Form>(edge), t)
    }

    /// Coefficients of the polynomial `(σ(t) - t) / (t (1 - t))`, from the constant one on; `d - 1` of them.
    pub(crate) fn quotient<T: Number>(&self, edge: usize) -> Vec<T> {
        let part = |numerator: usize| T::of(numerator as f64) / T::of(self.degree as f64);
        let deviations: Vec<T> =
            self.inner[edge].iter().enumerate().map(|(k, &value)| T::of(value) - part(k + 1)).collect();
        power_form(self.degree, &deviations)
    }
}

/// Coefficients of `sum_ν D_ν binom(d, ν) t^{ν-1} (1 - t)^{d-1-ν}`, `ν` from 1 to `d - 1`.
pub(super) fn power_form<T: Number>(degree: usize, deviations: &[T]) -> Vec<T> {
    let mut coefficients = vec![T::of(0.0); degree - 1];
    for (k, &deviation) in deviations.iter().enumerate() {
        let rest = degree - 2 - k;
        for l in 0..=rest {
            let sign = if l % 2 == 0 { 1.0 } else { -1.0 };
            let factor = sign * binomial(degree, k + 1) * binomial(rest, l);
            coefficients[k + l] = coefficients[k + l] + deviation * T::of(factor);
        }
    }
    coefficients
}

fn horner<T: Number>(coefficients: &[T], t: T) -> T {
    coefficients.iter().rev().fold(T::of(0.0), |sum, &c| sum * t + c)
}

/// Exact for degrees up to 8.
fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}
