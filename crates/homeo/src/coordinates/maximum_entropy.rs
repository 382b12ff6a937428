//! Maximum entropy coordinates: the closest to a prior, in the sense of relative entropy, that reproduce the point.
//!
//! `phi_i = m_i exp(-lambda . s_i) / Z`, where `lambda` is the minimum of the convex function `ln Z`: Newton's method with
//! a line search. The priors are products of edge functions `rho_j = r_j + r_{j+1} - |e_j|`, all but those of the two edges
//! at the vertex: `m_i = 1 / (rho_{i-1} rho_i)`. As `rho` vanishes on its edge with the square of the distance it is
//! computed as `2 c^2 / ((r r' - d) (r + r' + |e|))`, `c` and `d` the cross and dot product. All is done in the frame of the
//! closest edge, whose ends have the same height there to the last bit: near it the small moment that is to vanish is a
//! sum of numbers of its own size.

use homeo_core::planar::PlanarDomain;

use super::mean_value::least;
use super::outline::{Outline, Sight};
use super::real::Real;
use super::weighted::{self, Weighted};
use super::{CoordinateError, PlanarCoordinates};

/// Steps of Newton's method before giving up.
const MOST_STEPS: usize = 200;

/// Maximum entropy coordinates (Hormann, Sukumar 2008) of a polygon, with holes or without, with priors from the edges.
///
/// Positive and smooth inside. Gradients are given inside, not on the boundary.
///
/// # Complexity
/// #V exponentials for each step, some five steps for a point.
///
/// ```
/// use homeo::coordinates::{MaximumEntropy, PlanarCoordinates};
/// use homeo_core::planar::PlanarDomain;
/// let square = PlanarDomain::new(vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]])?;
/// let mut values = [0.0; 4];
/// MaximumEntropy::new(&square).values_into([0.25, 0.0], &mut values)?;
/// assert!((values[0] - 0.75).abs() < 1e-15 && values[2] == 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct MaximumEntropy {
    outline: Outline,
    lengths: Vec<f64>,
    domain: PlanarDomain,
}

/// What is minimised at one point: logarithms of priors and vectors to the vertices.
struct Problem {
    priors: Vec<f64>,
    places: Vec<[f64; 2]>,
}

/// The state at one `lambda`: coordinates, `ln Z`, their mean place and the covariance of places.
struct State {
    values: Vec<f64>,
    potential: f64,
    mean: [f64; 2],
    /// `[xx, xy, yy]`.
    covariance: [f64; 3],
}

impl MaximumEntropy {
    /// Of all rings of a domain.
    pub fn new(domain: &PlanarDomain) -> Self {
        let outline = Outline::new(domain);
        let length = |i: usize| outline.between(i, outline.next[i])[0].hypot(outline.between(i, outline.next[i])[1]);
        let lengths = (0..outline.count()).map(length).collect();
        Self { outline, lengths, domain: domain.clone() }
    }

    /// The function of an edge that vanishes on it.
    fn edge_function<T: Real<2>>(&self, i: usize, sight: &Sight<T>) -> T {
        let (r, other) = (sight.distance[i], sight.distance[self.outline.next[i]]);
        let sum = r + other + T::constant(self.lengths[i]);
        if sight.dot[i].value() < 0.0 {
            return (sight.cross[i] * sight.cross[i]) * 2.0 / ((r * other - sight.dot[i]) * sum);
        }
        (r * other + sight.dot[i]) * 2.0 / sum
    }

    /// Vectors to vertices in the frame of an edge: along it and to its left.
    fn places<T: Real<2>>(&self, edge: usize, sight: &Sight<T>) -> ([f64; 2], Vec<[f64; 2]>) {
        let next = self.outline.next[edge];
        let [x, y] = self.outline.between(edge, next).map(|x| x / self.lengths[edge]);
        let height = -sight.cross[edge].value() / self.lengths[edge];
        let place = |i: usize| {
            let [a, b] = sight.offset[i].map(T::value);
            [x * a + y * b, if i == edge || i == next { height } else { x * b - y * a }]
        };
        ([x, y], (0..self.outline.count()).map(place).collect())
    }
}

impl Weighted for MaximumEntropy {
    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn weights<T: Real<2>>(&self, sight: &Sight<T>) -> Result<Vec<T>, CoordinateError> {
        let (n, outline) = (self.outline.count(), &self.outline);
        let point = sight.point.map(|x| x / outline.scale);
        let functions: Vec<T> = (0..n).map(|i| self.edge_function(i, sight)).collect();
        let edge = least(functions.iter().map(|f| f.value()));
        let next = outline.next[edge];
        let height = sight.cross[edge].value() / self.lengths[edge];
        if height.abs() < 1e-100 && sight.dot[edge].value() < 0.0 {
            // On the edge. The limits of gradients are not computed: what is not a number is refused by the caller.
            let mut weights = vec![T::variable(0.0, [f64::NAN; 2]); n];
            (weights[edge], weights[next]) = (sight.distance[next], sight.distance[edge]);
            return Ok(weights);
        }
        let is_rounded = height < 0.0 && height > -1e-13 && sight.dot[edge].value() < 0.0;
        if is_rounded {
            let mut weights = vec![T::variable(0.0, [f64::NAN; 2]); n];
            (weights[edge], weights[next]) = (sight.distance[next], sight.distance[edge]);
            return Ok(weights);
        }
        if !self.domain.contains(point) {
            return Err(CoordinateError::Undefined { point });
        }
        let logarithms: Vec<T> = functions.iter().map(|f| f.ln()).collect();
        // Multiplied by the function of the closest edge, which may be tiny.
        let prior = |i: usize| match (i == edge, i == next) {
            (true, _) => -logarithms[outline.previous[i]],
            (_, true) => -logarithms[i],
            _ => logarithms[edge] - logarithms[i] - logarithms[outline.previous[i]],
        };
        let priors: Vec<T> = (0..n).map(prior).collect();
        let (axis, places) = self.places(edge, sight);
        let problem = Problem { priors: priors.iter().map(|p| p.value()).collect(), places };
        let state = problem.minimum().ok_or(CoordinateError::NotConverged { point, steps: MOST_STEPS })?;
        let slopes: Vec<[f64; 2]> = priors
            .iter()
            .map(|p| {
                let [a, b] = p.gradient();
                [axis[0] * a + axis[1] * b, axis[0] * b - axis[1] * a]
            })
            .collect();
        let turned = problem.gradients(&state, &slopes);
        let back = |i: usize| {
            let [a, b] = turned[i];
            T::variable(state.values[i], [axis[0] * a - axis[1] * b, axis[1] * a + axis[0] * b])
        };
        Ok((0..n).map(back).collect())
    }
}

impl Problem {
    fn state(&self, lambda: [f64; 2]) -> State {
        let exponent = |(prior, y): (&f64, &[f64; 2])| prior - lambda[0] * y[0] - lambda[1] * y[1];
        let exponents: Vec<f64> = self.priors.iter().zip(&self.places).map(exponent).collect();
        let most = exponents.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
        let mut values: Vec<f64> = exponents.iter().map(|e| (e - most).exp()).collect();
        let total: f64 = values.iter().sum();
        values.iter_mut().for_each(|v| *v /= total);
        let sum =
            |term: &dyn Fn(&[f64; 2]) -> f64| values.iter().zip(&self.places).map(|(v, y)| v * term(y)).sum::<f64>();
        let mean = [sum(&|y| y[0]), sum(&|y| y[1])];
        // About the mean, not by the difference of squares: it may be far smaller.
        let product = |k: usize, l: usize| sum(&|y| (y[k] - mean[k]) * (y[l] - mean[l]));
        let covariance = [product(0, 0), product(0, 1), product(1, 1)];
        State { values, potential: most + total.ln(), mean, covariance }
    }

    /// The state whose mean place is the point.
    fn minimum(&self) -> Option<State> {
        let mut lambda = [0.0, self.across()?];
        let mut state = self.state(lambda);
        let mut last = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let step = solve(state.covariance, state.mean)?;
            let largest = self.places.iter().map(|y| (y[0] * step[0] + y[1] * step[1]).abs()).fold(0.0, f64::max);
            let mut share = 1.0;
            // Short steps are safe for exponentials; long ones must gain.
            let slope = step[0] * state.mean[0] + step[1] * state.mean[1];
            loop {
                let tried = [lambda[0] + share * step[0], lambda[1] + share * step[1]];
                let next = self.state(tried);
                if share * largest < 0.5 || next.potential <= state.potential - 1e-4 * share * slope {
                    (lambda, state) = (tried, next);
                    break;
                }
                share *= 0.5;
            }
            // Beside short edges `lambda` is so large that exponents are noise above `1e-9`: then no step gets shorter.
            if largest < 1e-9 || (largest < 1e-4 && largest > 0.5 * last) {
                return Some(state);
            }
            last = largest;
            if !largest.is_finite() {
                return None;
            }
        }
        None
    }

    /// The second part of `lambda` at which the mean height vanishes while the first is zero: near an edge it grows as
    /// the logarithm of the distance, far from where Newton's method would start. It decreases steadily: bisection.
    fn across(&self) -> Option<f64> {
        let height = |mu: f64| self.state([0.0, mu]).mean[1];
        let sign = if height(0.0) > 0.0 { 1.0 } else { -1.0 };
        let (mut low, mut high) = (0.0, 1.0);
        while sign * height(sign * high) > 0.0 {
            (low, high) = (high, 2.0 * high);
            if high > 1e12 {
                return None;
            }
        }
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            if sign * height(sign * middle) > 0.0 { low = middle } else { high = middle }
        }
        Some(sign * 0.5 * (low + high))
    }

    /// Gradients of the coordinates at the minimum, from those of the logarithms of priors: the constraint differentiated.
    fn gradients(&self, state: &State, slopes: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut gradients = vec![[0.0; 2]; slopes.len()];
        for axis in 0..2 {
            let (mut mean, mut moment) = (0.0, [0.0; 2]);
            for ((v, slope), y) in state.values.iter().zip(slopes).zip(&self.places) {
                mean += v * slope[axis];
                moment = [moment[0] + v * slope[axis] * y[0], moment[1] + v * slope[axis] * y[1]];
            }
            moment[axis] -= 1.0;
            let step = solve(state.covariance, moment).unwrap_or([f64::NAN; 2]);
            for (i, y) in self.places.iter().enumerate() {
                let relative = slopes[i][axis] - mean - (step[0] * y[0] + step[1] * y[1]);
                gradients[i][axis] = state.values[i] * relative;
            }
        }
        gradients
    }
}

/// Solves a symmetric system of two equations.
fn solve([xx, xy, yy]: [f64; 3], right: [f64; 2]) -> Option<[f64; 2]> {
    let determinant = xx * yy - xy * xy;
    let solution = [(yy * right[0] - xy * right[1]) / determinant, (xx * right[1] - xy * right[0]) / determinant];
    solution.iter().all(|x| x.is_finite()).then_some(solution)
}

impl PlanarCoordinates for MaximumEntropy {
    fn vertex_count(&self) -> usize {
        self.outline.count()
    }

    fn values_into(&self, point: [f64; 2], values: &mut [f64]) -> Result<(), CoordinateError> {
        weighted::values(self, point, values)
    }

    fn gradients_into(
        &self,
        point: [f64; 2],
        values: &mut [f64],
        gradients: &mut [[f64; 2]],
    ) -> Result<(), CoordinateError> {
        weighted::gradients(self, point, values, gradients)?;
        let is_known = gradients.iter().flatten().all(|g| g.is_finite());
        if is_known { Ok(()) } else { Err(CoordinateError::Undefined { point }) }
    }
}
