//! The boundary element method for given values: one factorization for all functions.

use std::sync::Arc;

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, MatRef};
use homeo_core::planar::{PlanarDomain, Point2};
use rayon::prelude::*;

use super::condition::BoundaryData;
use super::elements::{COLLOCATION, ElementParams, Elements};
use super::evaluate::{BoundaryElementFunctions, COEFFICIENTS, Trace};
use super::kernel::moments;
use super::{HarmonicFunctionError, Profile};

/// A domain whose boundary is divided into elements, factored: ready for any values on its boundary.
///
/// Normal derivatives are linear in each element and may jump between elements. Green's third identity is required in
/// the limit from inside at two points of each element (zeros of a Legendre polynomial); corners, where there are two
/// normals, are none of them. Functions whose normal derivatives are linear in each element, such as all linear
/// functions, are reproduced to rounding.
///
/// # Complexity
/// `2 (2 #E)^3 / 3` operations for the factorization, `2 (2 #E)^2` for each function; `(2 #E)^2` numbers of memory.
///
/// ```
/// use homeo::harmonic::{BoundaryData, BoundaryElements, ElementParams, HarmonicFunctions, Profile};
/// use homeo_core::planar::PlanarDomain;
/// let square = PlanarDomain::new(vec![vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]])?;
/// let elements = BoundaryElements::new(&square, &ElementParams::default())?;
/// // 1 at one vertex and 0 at the others: a quarter in the middle.
/// let data = BoundaryData::new(&[[1.0], [0.0], [0.0], [0.0]], Profile::Linear)?;
/// let functions = elements.solve(&data)?;
/// let (mut values, mut gradients) = ([0.0], [[0.0; 2]]);
/// functions.gradients_into([1.0, 1.0], &mut values, &mut gradients)?;
/// assert!((values[0] - 0.25).abs() < 1e-9 && (gradients[0][0] - gradients[0][1]).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct BoundaryElements {
    elements: Arc<Elements>,
    factor: PartialPivLu<f64>,
}

impl BoundaryElements {
    /// Divides the edges of a domain and factors the matrix of the single layer.
    ///
    /// # Errors
    /// A parameter is out of range, or there would be more than 20,000 unknowns.
    pub fn new(domain: &PlanarDomain, params: &ElementParams) -> Result<Self, HarmonicFunctionError> {
        let elements = Elements::new(domain, params)?;
        let n = 2 * elements.all.len();
        let rows: Vec<Vec<f64>> = (0..n)
            .into_par_iter()
            .map(|i| {
                let mut row = vec![0.0; n];
                at_collocation(&elements, i, |e, single, _| row[2 * e..2 * e + 2].copy_from_slice(&single));
                row
            })
            .collect();
        let factor = Mat::from_fn(n, n, |i, j| rows[i][j]).partial_piv_lu();
        Ok(Self { elements: Arc::new(elements), factor })
    }

    /// How many unknowns each function has: two for each element.
    pub fn unknown_count(&self) -> usize {
        2 * self.elements.all.len()
    }

    /// The harmonic functions with these values.
    ///
    /// # Errors
    /// There is not one row of values for each vertex, or numbers are so large that the solution is not finite.
    pub fn solve(&self, data: &BoundaryData) -> Result<BoundaryElementFunctions, HarmonicFunctionError> {
        let elements = &self.elements;
        data.check(elements.domain.vertex_count())?;
        let (count, functions) = (elements.all.len(), data.functions);
        let rows: Vec<Vec<f64>> = (0..2 * count).into_par_iter().map(|i| right_side(elements, i, data)).collect();
        let flux = self.factor.solve(&Mat::from_fn(2 * count, functions, |i, f| rows[i][f]));
        let coefficients = coefficients(elements, data, flux.as_ref());
        BoundaryElementFunctions::new(elements.clone(), functions, coefficients, Trace::Given(data.clone()))
    }

    /// The harmonic functions (`functions` of them) whose values at points of the boundary `values` writes: they must be
    /// continuous. In each element they are taken at its ends and its middle, and interpolated by a quadratic polynomial.
    ///
    /// # Errors
    /// A value is not finite.
    pub fn solve_sampled(
        &self,
        functions: usize,
        values: impl Fn(Point2, &mut [f64]),
    ) -> Result<BoundaryElementFunctions, HarmonicFunctionError> {
        let count = self.elements.all.len();
        let mut coefficients = sampled(&self.elements, functions, values)?;
        let rows: Vec<Vec<f64>> = (0..2 * count)
            .into_par_iter()
            .map(|i| right_side_of_sampled(&self.elements, i, functions, &coefficients))
            .collect();
        let flux = self.factor.solve(&Mat::from_fn(2 * count, functions, |i, f| rows[i][f]));
        for (e, block) in coefficients.chunks_exact_mut(COEFFICIENTS * functions.max(1)).enumerate() {
            (0..2 * functions).for_each(|k| block[k] = flux[(2 * e + k / functions, k % functions)]);
        }
        BoundaryElementFunctions::new(self.elements.clone(), functions, coefficients, Trace::Sampled)
    }
}

/// Normal derivatives that were found and given values, element by element.
fn coefficients(elements: &Elements, data: &BoundaryData, flux: MatRef<'_, f64>) -> Vec<f64> {
    let functions = data.functions;
    let mut coefficients = vec![0.0; COEFFICIENTS * elements.all.len() * functions];
    for (e, (element, block)) in
        elements.all.iter().zip(coefficients.chunks_exact_mut(COEFFICIENTS * functions.max(1))).enumerate()
    {
        let edge = &elements.edges[element.edge];
        let [middle, half] = element.shares(edge);
        let going = data.profile.on(middle, half);
        let [begin, end] = edge.vertices.map(|v| data.at_vertex(v));
        for f in 0..functions {
            let rise = end[f] - begin[f];
            let numbers =
                [flux[(2 * e, f)], flux[(2 * e + 1, f)], begin[f] + rise * going[0], rise * going[1], rise * going[2]];
            numbers.into_iter().enumerate().for_each(|(k, x)| block[k * functions + f] = x);
        }
    }
    coefficients
}

/// Coefficients of the values in each element; those of the normal derivatives are 0.
fn sampled(
    elements: &Elements,
    functions: usize,
    values: impl Fn(Point2, &mut [f64]),
) -> Result<Vec<f64>, HarmonicFunctionError> {
    let mut coefficients = vec![0.0; COEFFICIENTS * elements.all.len() * functions];
    let mut samples = [0; 3].map(|_| vec![0.0; functions]);
    for (element, block) in elements.all.iter().zip(coefficients.chunks_exact_mut(COEFFICIENTS * functions.max(1))) {
        let edge = &elements.edges[element.edge];
        for (sample, t) in samples.iter_mut().zip([-1.0, 0.0, 1.0]) {
            let point = edge.point(element.from_end, element.middle + t * element.half);
            values(point.map(|x| x / elements.scale), sample);
        }
        let [begin, middle, end] = &samples;
        for f in 0..functions {
            block[2 * functions + f] = middle[f];
            block[3 * functions + f] = 0.5 * (end[f] - begin[f]);
            block[4 * functions + f] = 0.5 * (begin[f] + end[f]) - middle[f];
        }
    }
    match coefficients.iter().position(|c| !c.is_finite()) {
        Some(entry) => Err(HarmonicFunctionError::BadData { entry, value: coefficients[entry] }),
        None => Ok(coefficients),
    }
}

/// The value and the double layer of all values at collocation point `i`, by the coefficients in each element (#F).
fn right_side_of_sampled(elements: &Elements, i: usize, functions: usize, coefficients: &[f64]) -> Vec<f64> {
    let given = |e: usize, k: usize, f: usize| coefficients[(COEFFICIENTS * e + 2 + k) * functions + f];
    let (own, t) = (i / 2, COLLOCATION[i % 2]);
    let mut row: Vec<f64> =
        (0..functions).map(|f| given(own, 0, f) + t * (given(own, 1, f) + t * given(own, 2, f))).collect();
    at_collocation(elements, i, |e, _, double| {
        for (f, sum) in row.iter_mut().enumerate() {
            *sum += (0..3).map(|k| double[k] * given(e, k, f)).sum::<f64>();
        }
    });
    row
}

/// Calls with the number of every element and its integrals (single and double layer) at collocation point `i`.
pub(super) fn at_collocation(elements: &Elements, i: usize, mut visit: impl FnMut(usize, [f64; 2], [f64; 3])) {
    elements.for_each(elements.place(i / 2, COLLOCATION[i % 2]), |e, element, local| {
        let found = moments(local, element.half);
        visit(e, found.single, found.double);
    });
}

/// The given value and the double layer of all given values at collocation point `i` (#F).
fn right_side(elements: &Elements, i: usize, data: &BoundaryData) -> Vec<f64> {
    let mut row = vec![0.0; data.functions];
    let mut add = |vertices: [usize; 2], weights: [f64; 2]| {
        for (vertex, weight) in vertices.into_iter().zip(weights) {
            row.iter_mut().zip(data.at_vertex(vertex)).for_each(|(sum, value)| *sum += weight * value);
        }
    };
    let mut sums: Vec<[f64; 2]> = vec![[0.0; 2]; elements.edges.len()];
    at_collocation(elements, i, |e, _, double| {
        let element = &elements.all[e];
        let [middle, half] = element.shares(&elements.edges[element.edge]);
        let going = data.profile.on(middle, half);
        let gone = going[0] * double[0] + going[1] * double[1] + going[2] * double[2];
        sums[element.edge][0] += double[0] - gone;
        sums[element.edge][1] += gone;
    });
    elements.edges.iter().zip(sums).for_each(|(edge, weights)| add(edge.vertices, weights));
    let own = &elements.all[i / 2];
    let edge = &elements.edges[own.edge];
    let [middle, half] = own.shares(edge);
    let gone = Profile::at(data.profile, middle + half * COLLOCATION[i % 2]);
    add(edge.vertices, [1.0 - gone, gone]);
    row
}
