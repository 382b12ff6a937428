//! Closed cubic B-splines near the points of a curve.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use super::{ShapeError, ring::Measures};

/// A closed cubic B-spline with even knots: twice continuously differentiable, by a parameter from 0 to 1.
///
/// # Example
/// ```
/// use homeo::shape::ClosedSpline;
/// let spline = ClosedSpline::new(vec![[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])?;
/// let [point, velocity, _] = spline.at(0.0);
/// assert!((point[1] - 2.0 / 3.0).abs() < 1e-15 && velocity[0] < 0.0);
/// # Ok::<(), homeo::shape::SplineError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedSpline {
    control: Vec<[f64; 2]>,
}

/// What a fit may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplineParams {
    /// How many control points: from 4 to the number of points.
    pub controls: usize,
    /// No point is farther from its foot on the spline, as a part of the length of the curve.
    pub tolerance: f64,
    /// So often parameters are corrected at most.
    pub corrections: usize,
}

impl Default for SplineParams {
    fn default() -> Self {
        Self { controls: 50, tolerance: 1e-4, corrections: 20 }
    }
}

/// A spline that was fitted to points.
#[derive(Clone, Debug, PartialEq)]
pub struct SplineFit {
    /// The spline.
    pub spline: ClosedSpline,
    /// The parameter of the foot of each point (#points), increasing.
    pub parameters: Vec<f64>,
    /// The greatest distance of a point from its foot, in the units of the points.
    pub distance: f64,
    /// After how many corrections of parameters it was found.
    pub corrections: usize,
}

/// Why there is no spline.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SplineError {
    /// A closed cubic spline has four control points or more, and no more than there are points.
    #[error("{controls} control points for {points} points: there must be 4 or more, and no more than points")]
    Controls {
        /// How many control points are asked for.
        controls: usize,
        /// How many points there are.
        points: usize,
    },
    /// The points are no ring.
    #[error(transparent)]
    Ring(#[from] ShapeError),
    /// Some control points are not determined: a long edge passes over several knots.
    #[error("points are too sparse for {controls} control points: sample the long edges more densely")]
    TooSparse {
        /// How many control points are asked for.
        controls: usize,
    },
    /// The best spline found is farther away than allowed.
    #[error(
        "a spline with {} control points came within {:e} only: allow more control points", found.spline.control.len(), found.distance
    )]
    NotReached {
        /// What was found.
        found: Box<SplineFit>,
    },
}

impl ClosedSpline {
    /// The spline of some control points.
    ///
    /// # Errors
    /// There are fewer than four.
    pub fn new(control: Vec<[f64; 2]>) -> Result<Self, SplineError> {
        match control.len() {
            0..4 => Err(SplineError::Controls { controls: control.len(), points: control.len() }),
            _ => Ok(Self { control }),
        }
    }

    /// The control points (#C by 2).
    pub fn control(&self) -> &[[f64; 2]] {
        &self.control
    }

    /// The same curve in Bezier pieces (#C by 4 by 2), as drawings hold it: one for each interval between knots, in order,
    /// each beginning where the one before ends, bit for bit.
    ///
    /// With control points `p, q, r, s` a piece is `(p + 4q + r) / 6, (2q + r) / 3, (q + 2r) / 3, (q + 4r + s) / 6`: an
    /// identity of polynomials, so that nothing but rounding is lost.
    ///
    /// # Example
    /// ```
    /// use homeo::shape::ClosedSpline;
    /// let spline = ClosedSpline::new(vec![[3.0, 0.0], [0.0, 3.0], [-3.0, 0.0], [0.0, -3.0]])?;
    /// let pieces = spline.bezier_pieces();
    /// assert_eq!(pieces[0], [[0.0, 2.0], [-1.0, 2.0], [-2.0, 1.0], [-2.0, 0.0]]);
    /// assert_eq!(pieces[3][3], pieces[0][0]);
    /// # Ok::<(), homeo::shape::SplineError>(())
    /// ```
    pub fn bezier_pieces(&self) -> Vec<[[f64; 2]; 4]> {
        let n = self.control.len();
        let at = |i: usize| self.control[i % n];
        let knot = |i: usize| [0, 1].map(|k| (at(i)[k] + 4.0 * at(i + 1)[k] + at(i + 2)[k]) / 6.0);
        let third = |q: [f64; 2], r: [f64; 2]| [0, 1].map(|k| (2.0 * q[k] + r[k]) / 3.0);
        (0..n).map(|i| [knot(i), third(at(i + 1), at(i + 2)), third(at(i + 2), at(i + 1)), knot(i + 1)]).collect()
    }

    /// Point, first and second derivative. Parameters outside of 0 to 1 run on.
    pub fn at(&self, parameter: f64) -> [[f64; 2]; 3] {
        let n = self.control.len();
        let (first, rows) = basis(parameter, n);
        rows.map(|row| {
            let sum = |k: usize| (0..4).map(|j| row[j] * self.control[(first + j) % n][k]).sum();
            [sum(0), sum(1)]
        })
    }
}

impl crate::coordinates::ClosedCurve for ClosedSpline {
    fn at(&self, parameter: f64) -> [[f64; 2]; 2] {
        let [point, velocity, _] = ClosedSpline::at(self, parameter);
        [point, velocity]
    }
}

/// The first control point that matters, and what four of them count in the point and its first and second derivative.
fn basis(parameter: f64, n: usize) -> (usize, [[f64; 4]; 3]) {
    let along = parameter.rem_euclid(1.0) * n as f64;
    // `rem_euclid` may give 1 for tiny negative numbers.
    let first = (along as usize).min(n - 1);
    let t = along - first as f64;
    let (u, scale) = (1.0 - t, n as f64);
    let point = [
        u * u * u / 6.0,
        (3.0 * t - 6.0) * t * t / 6.0 + 2.0 / 3.0,
        (3.0 * u - 6.0) * u * u / 6.0 + 2.0 / 3.0,
        t * t * t / 6.0,
    ];
    let velocity = [-0.5 * u * u, (1.5 * t - 2.0) * t, (2.0 - 1.5 * u) * u, 0.5 * t * t].map(|b| b * scale);
    let second = [u, 3.0 * t - 2.0, 1.0 - 3.0 * t, t].map(|b| b * scale * scale);
    (first, [point, velocity, second])
}

/// The closed cubic B-spline that is nearest to the points of a ring, by least squares over control points and parameters in
/// turn.
///
/// Parameters begin as parts of the length of the ring. After each fit each moves to the foot of its point by a Newton step,
/// at most a third of the way to its neighbours, so that they stay in order.
///
/// # Guarantee
/// No point is farther from the spline than the tolerance times the length; how far is computed at the feet. Parts of the
/// spline between feet may be farther from the ring. Nothing depends on the number of threads.
///
/// # Errors
/// Numbers of control points that do not fit, points that are no ring, points too sparse; or the tolerance was not reached:
/// then the error holds the best that was found.
///
/// # Complexity
/// For each correction that of a dense system of as many unknowns as control points.
///
/// # References
/// Schneider 2017, section 3.3.1, after Hoschek 1988; there the spline is quintic.
///
/// # Example
/// ```
/// use std::f64::consts::TAU;
/// use homeo::shape::{SplineParams, fit_closed_spline, sample_closed};
/// let circle = sample_closed(|u| [(TAU * u).cos(), (TAU * u).sin()], 100);
/// let fit = fit_closed_spline(&circle, &SplineParams { controls: 12, ..SplineParams::default() })?;
/// assert!(fit.distance < 1e-3);
/// let [point, ..] = fit.spline.at(0.37);
/// assert!((point[0].hypot(point[1]) - 1.0).abs() < 1e-3);
/// # Ok::<(), homeo::shape::SplineError>(())
/// ```
pub fn fit_closed_spline(points: &[[f64; 2]], params: &SplineParams) -> Result<SplineFit, SplineError> {
    if params.controls < 4 || params.controls > points.len() {
        return Err(SplineError::Controls { controls: params.controls, points: points.len() });
    }
    let measures = Measures::new(points)?;
    let mut parameters: Vec<f64> = Vec::with_capacity(points.len());
    let mut along = 0.0;
    for length in &measures.lengths {
        parameters.push(along);
        along += length;
    }
    let allowed = params.tolerance * measures.perimeter;
    let mut last = fitted(points, parameters, params.controls, 0)?;
    let mut best = last.clone();
    while best.distance > allowed && last.corrections < params.corrections {
        last = fitted(points, corrected(points, &last), params.controls, last.corrections + 1)?;
        // The sum of squares falls, the greatest distance not always.
        if last.distance < best.distance {
            best = last.clone();
        }
    }
    match best.distance <= allowed {
        true => Ok(best),
        false => Err(SplineError::NotReached { found: Box::new(best) }),
    }
}

/// The least-squares spline for given parameters, by normal equations: those of cubic B-splines are well conditioned where
/// points are dense.
fn fitted(
    points: &[[f64; 2]],
    parameters: Vec<f64>,
    controls: usize,
    corrections: usize,
) -> Result<SplineFit, SplineError> {
    let (mut matrix, mut right) = (Mat::<f64>::zeros(controls, controls), Mat::<f64>::zeros(controls, 2));
    for (point, &parameter) in points.iter().zip(&parameters) {
        let (first, [row, ..]) = basis(parameter, controls);
        for (i, a) in row.iter().enumerate() {
            let here = (first + i) % controls;
            for (j, b) in row.iter().enumerate() {
                matrix[(here, (first + j) % controls)] += a * b;
            }
            (0..2).for_each(|k| right[(here, k)] += a * point[k]);
        }
    }
    let factor = matrix.llt(Side::Lower).map_err(|_| SplineError::TooSparse { controls })?;
    let solution = factor.solve(&right);
    let spline = ClosedSpline { control: (0..controls).map(|i| [solution[(i, 0)], solution[(i, 1)]]).collect() };
    let away = |(point, &parameter): (&[f64; 2], &f64)| {
        let [[x, y], ..] = spline.at(parameter);
        (x - point[0]).hypot(y - point[1])
    };
    let distance = points.iter().zip(&parameters).map(away).fold(0.0, f64::max);
    if distance.is_finite() {
        Ok(SplineFit { spline, parameters, distance, corrections })
    } else {
        Err(SplineError::TooSparse { controls })
    }
}

/// Parameters moved towards the feet of their points.
fn corrected(points: &[[f64; 2]], fit: &SplineFit) -> Vec<f64> {
    let n = points.len();
    let gap = |i: usize| (fit.parameters[(i + 1) % n] - fit.parameters[i]).rem_euclid(1.0);
    let step = |i: usize| {
        let [at, [dx, dy], [ax, ay]] = fit.spline.at(fit.parameters[i]);
        let [x, y] = [at[0] - points[i][0], at[1] - points[i][1]];
        let (slope, square) = (x * dx + y * dy, dx * dx + dy * dy);
        let bend = square + x * ax + y * ay;
        // Where the spline bends round the point Newton's step goes the wrong way: there without the second derivative.
        let step = if square == 0.0 { 0.0 } else { -slope / if bend > 0.5 * square { bend } else { square } };
        step.clamp(-gap((i + n - 1) % n) / 3.0, gap(i) / 3.0)
    };
    (0..n).map(|i| fit.parameters[i] + step(i)).collect()
}
