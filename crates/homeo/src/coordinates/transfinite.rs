//! Mean value coordinates of closed curves, and maps by them.
//!
//! With `s = γ(u) - x` the weight of the parameter `u` is `w(u) = s x γ'(u) / |s|^3`: the angle under which a piece of the
//! curve is seen, over its distance. The interpolant of data `g` is `∫ g w / ∫ w`. Beside the curve both integrals grow like
//! one over the distance; what is computed is `g(u*) + ∫ (g - g(u*)) w / ∫ w` with `u*` the parameter of the nearest point:
//! the second term is small there, and so are its errors. Pieces end at `u*`, so that the peak is at their ends.

use std::f64::consts::TAU;

use super::gauss_kronrod::integrate;

/// A closed curve by a parameter from 0 to 1: the point and the velocity. Any function that gives both is one.
///
/// # Invariants
/// `at(0)` and `at(1)` are the same point; the curve is simple and runs counter-clockwise, and the velocity is its
/// derivative, piecewise continuous. None of this is checked.
///
/// ```
/// use std::f64::consts::TAU;
/// use homeo::coordinates::ClosedCurve;
/// let circle = |u: f64| [[(TAU * u).cos(), (TAU * u).sin()], [-TAU * (TAU * u).sin(), TAU * (TAU * u).cos()]];
/// assert_eq!(circle.at(0.0)[0], [1.0, 0.0]);
/// ```
pub trait ClosedCurve: Send + Sync {
    /// Point and velocity.
    fn at(&self, parameter: f64) -> [[f64; 2]; 2];
}

impl<F: Fn(f64) -> [[f64; 2]; 2] + Send + Sync> ClosedCurve for F {
    fn at(&self, parameter: f64) -> [[f64; 2]; 2] {
        self(parameter)
    }
}

/// How carefully integrals are computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransfiniteParams {
    /// The estimated error of an image may be so large, as a part of the diagonal of the data on the curve.
    pub tolerance: f64,
    /// Into so many pieces the parameter is cut at most.
    pub pieces: usize,
}

impl Default for TransfiniteParams {
    fn default() -> Self {
        Self { tolerance: 1e-10, pieces: 400 }
    }
}

/// Why a point has no image.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TransfiniteError {
    /// The curve does not wind round the point once, as far as the integral tells.
    #[error(
        "the curve winds {turns} times round {point:?}: take a point inside a simple curve that runs counter-clockwise"
    )]
    NotInside {
        /// The point.
        point: [f64; 2],
        /// How often it winds, computed.
        turns: f64,
    },
    /// The limit of pieces was reached.
    #[error(
        "the image of {point:?} is known to an estimated {estimate:e} only: allow more pieces or a larger tolerance"
    )]
    NotReached {
        /// The point.
        point: [f64; 2],
        /// The estimated error, in the units of the data.
        estimate: f64,
    },
    /// A map needs two curves.
    #[error("{0} curves make no map: two or more are needed")]
    TooFewCurves(usize),
}

/// How many points of the curve are known from the beginning, to look for the nearest.
const SAMPLES: usize = 512;
/// Points so close to the curve, as a part of its diagonal, are on it.
const ON_CURVE: f64 = 1e-13;

/// Transfinite mean value coordinates of a closed curve.
///
/// # Guarantee
/// None that is proved: integrals are floating point with an estimate of their error, the difference of the rules of 7 and
/// 15 points, which in smooth pieces is far above the error. Linear functions are reproduced to the tolerance.
///
/// # References
/// Schneider 2017, sections 1.3 and 4.4.1, after Ju, Schaefer, Warren 2005.
///
/// ```
/// use std::f64::consts::TAU;
/// use homeo::coordinates::{TransfiniteMeanValue, TransfiniteParams};
/// let circle = |u: f64| [[(TAU * u).cos(), (TAU * u).sin()], [-TAU * (TAU * u).sin(), TAU * (TAU * u).cos()]];
/// let kind = TransfiniteMeanValue::new(circle, TransfiniteParams::default());
/// let [x, y] = kind.interpolate([0.3, -0.2], |u| [2.0 * (TAU * u).cos(), (TAU * u).sin() + 1.0])?;
/// assert!((x - 0.6).abs() < 1e-9 && (y - 0.8).abs() < 1e-9);
/// # Ok::<(), homeo::coordinates::TransfiniteError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TransfiniteMeanValue<C> {
    curve: C,
    params: TransfiniteParams,
    samples: Vec<[f64; 2]>,
    diagonal: f64,
}

impl<C: ClosedCurve> TransfiniteMeanValue<C> {
    /// The coordinates of a curve.
    pub fn new(curve: C, params: TransfiniteParams) -> Self {
        let samples: Vec<_> = (0..SAMPLES).map(|i| curve.at(i as f64 / SAMPLES as f64)[0]).collect();
        let diagonal = diagonal(samples.iter().copied());
        Self { curve, params, samples, diagonal }
    }

    /// The curve.
    pub fn curve(&self) -> &C {
        &self.curve
    }

    /// The value at a point inside of what interpolates `data`, a function of the parameter; on the curve, the data.
    ///
    /// # Errors
    /// The point is not inside, as far as is computed, or the tolerance was not reached.
    ///
    /// # Complexity
    /// Some 15 evaluations of curve and data for each piece; 20 pieces in the middle of an ellipse, two more for each time
    /// that the distance from the curve is halved.
    pub fn interpolate(&self, point: [f64; 2], data: impl Fn(f64) -> [f64; 2]) -> Result<[f64; 2], TransfiniteError> {
        let (nearest, distance) = self.nearest(point);
        let base = data(nearest);
        if distance <= ON_CURVE * self.diagonal {
            return Ok(base);
        }
        let spread = diagonal((0..32).map(|i| data(f64::from(i) / 32.0)));
        let integrand = |u: f64| {
            let ([at, [dx, dy]], value) = (self.curve.at(u.rem_euclid(1.0)), data(u.rem_euclid(1.0)));
            let [x, y] = [at[0] - point[0], at[1] - point[1]];
            let (r, cross) = (x.hypot(y), x * dy - y * dx);
            // Multiplied by the least distance, so that nothing overflows.
            let weight = cross / (r * r) * (distance / r);
            [(value[0] - base[0]) * weight, (value[1] - base[1]) * weight, weight, cross / (r * r)]
        };
        let places = self.places(nearest, distance);
        // An error of the denominator counts as much as the image is away from `base`. Where to bisect a guess of that decides.
        let guess = spread * (10.0 * distance / self.diagonal).min(1.0);
        let estimate =
            |[a, b, w, _]: [f64; 4], off: [f64; 4]| (off[0].hypot(off[1]) + (a / w).hypot(b / w) * off[2]) / w.abs();
        let target = self.params.tolerance * spread;
        let whole = integrate(
            &places,
            self.params.pieces.max(places.len()),
            integrand,
            |piece| piece.difference[0].hypot(piece.difference[1]) + guess * piece.difference[2],
            |all| estimate(all.value, all.difference) <= target && all.difference[3] < 0.01,
        );
        let (value, turns) = (whole.value, whole.value[3] / TAU);
        if whole.difference[3] < 1.0 && (turns - 1.0).abs() > 0.25 {
            return Err(TransfiniteError::NotInside { point, turns });
        }
        let missed = estimate(value, whole.difference);
        // Not a number is not reached, either.
        if missed <= target {
            Ok([base[0] + value[0] / value[2], base[1] + value[1] / value[2]])
        } else {
            Err(TransfiniteError::NotReached { point, estimate: missed })
        }
    }

    /// Where the parameter is cut: in eighths, and closer and closer to the nearest point, down to the width of the peak there.
    /// Without these a rule may have no point in the peak and take it for nothing.
    fn places(&self, nearest: f64, distance: f64) -> Vec<f64> {
        let [_, [dx, dy]] = self.curve.at(nearest);
        let width = (distance / dx.hypot(dy)).max(f64::EPSILON);
        let steps: Vec<f64> = (4..52).map(|k| 0.5f64.powi(k)).take_while(|&step| step > 0.25 * width).collect();
        let eighths = (1..8).map(|k| f64::from(k) / 8.0);
        let near = steps.iter().rev().copied();
        let places = near.chain(eighths).chain(steps.iter().map(|step| 1.0 - step));
        std::iter::once(nearest).chain(places.map(|part| nearest + part)).chain([nearest + 1.0]).collect()
    }

    /// The parameter of a nearest point of the curve, and its distance. From the nearest sample by sections of the interval
    /// between its neighbours: it says where to cut, and errors do no harm.
    fn nearest(&self, point: [f64; 2]) -> (f64, f64) {
        let squared = |p: [f64; 2]| (p[0] - point[0]).powi(2) + (p[1] - point[1]).powi(2);
        let closer = |&a: &usize, &b: &usize| squared(self.samples[a]).total_cmp(&squared(self.samples[b]));
        let sample = (0..SAMPLES).min_by(closer).unwrap_or(0);
        let [mut low, mut high] = [-1.0, 1.0].map(|side| (sample as f64 + side) / SAMPLES as f64);
        for _ in 0..52 {
            let middle = 0.5 * (low + high);
            let [[x, y], [dx, dy]] = self.curve.at(middle.rem_euclid(1.0));
            let is_behind = (x - point[0]) * dx + (y - point[1]) * dy > 0.0;
            if is_behind { high = middle } else { low = middle }
        }
        let found = |u: f64| (u, squared(self.curve.at(u)[0]).sqrt());
        let (section, known) = (found((0.5 * (low + high)).rem_euclid(1.0)), found(sample as f64 / SAMPLES as f64));
        if section.1 <= known.1 { section } else { known }
    }
}

fn diagonal(points: impl Iterator<Item = [f64; 2]>) -> f64 {
    let around = |[low, high]: [[f64; 2]; 2], p: [f64; 2]| {
        [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
    };
    let [low, high] = points.fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], around);
    (high[0] - low[0]).hypot(high[1] - low[1])
}

/// Mean value maps from each of some closed curves to the next, one after the other; parameters correspond.
///
/// # Guarantee
/// On the curve the map is that of the parameters. Inside **nothing is proved**, neither that it is one-to-one nor that the
/// inside goes inside; with enough steps it is one-to-one, if curves and weights depend smoothly on time (4.4.1). For a
/// proof sample the curves and take a [composite map](crate::composite) of the polygons.
///
/// # References
/// Schneider 2017, section 4.4.1.
///
/// ```
/// use std::f64::consts::TAU;
/// use homeo::coordinates::{TransfiniteComposite, TransfiniteParams};
/// let ellipse = |a: f64| {
///     move |u: f64| [[a * (TAU * u).cos(), (TAU * u).sin()], [-a * TAU * (TAU * u).sin(), TAU * (TAU * u).cos()]]
/// };
/// let curves = (0..=4).map(|k| ellipse(1.0 + 0.25 * f64::from(k))).collect();
/// let map = TransfiniteComposite::new(curves, TransfiniteParams::default())?;
/// let [x, y] = map.forward([0.5, 0.5])?;
/// assert!((x - 1.0).abs() < 1e-8 && (y - 0.5).abs() < 1e-8, "an affine map is met exactly");
/// # Ok::<(), homeo::coordinates::TransfiniteError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TransfiniteComposite<C> {
    stages: Vec<TransfiniteMeanValue<C>>,
}

impl<C: ClosedCurve> TransfiniteComposite<C> {
    /// The map from the first curve over all others to the last.
    ///
    /// # Errors
    /// There are fewer than two curves.
    pub fn new(curves: Vec<C>, params: TransfiniteParams) -> Result<Self, TransfiniteError> {
        if curves.len() < 2 {
            return Err(TransfiniteError::TooFewCurves(curves.len()));
        }
        Ok(Self { stages: curves.into_iter().map(|curve| TransfiniteMeanValue::new(curve, params)).collect() })
    }

    /// The image of a point inside the first curve.
    ///
    /// # Errors
    /// As [`TransfiniteMeanValue::interpolate`], at the first step where it is so.
    pub fn forward(&self, point: [f64; 2]) -> Result<[f64; 2], TransfiniteError> {
        self.stages.windows(2).try_fold(point, |at, pair| pair[0].interpolate(at, |u| pair[1].curve.at(u)[0]))
    }

    /// The image of a point inside the last curve under the same steps the other way: near the inverse for many steps, but
    /// not the inverse.
    ///
    /// # Errors
    /// As [`Self::forward`].
    pub fn backward(&self, point: [f64; 2]) -> Result<[f64; 2], TransfiniteError> {
        self.stages.windows(2).rev().try_fold(point, |at, pair| pair[1].interpolate(at, |u| pair[0].curve.at(u)[0]))
    }
}
