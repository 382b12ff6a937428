//! Values given on some edges, no flow across the others.

use std::sync::Arc;

use faer::Mat;
use faer::linalg::solvers::Solve;
use homeo_core::planar::PlanarDomain;
use rayon::prelude::*;

use super::boundary_element::at_collocation;
use super::condition::EdgeCondition;
use super::elements::{COLLOCATION, ElementParams, Elements};
use super::evaluate::{BoundaryElementFunctions, COEFFICIENTS, Trace};
use super::{HarmonicFunctionError, check_length};

/// The harmonic function with values given on some edges and no flow across the others (section 5.4), by boundary
/// elements: one condition for each edge, ring after ring.
///
/// Values on edges without flow are found, linear in each element; between elements they may jump by the error of the
/// method. Two such functions map a domain with four corners to the unit square: one is 0 and 1 on two opposite sides and
/// has no flow across the others, the other the other way round.
///
/// # Errors
/// No edge has values, there is not one condition for each edge, or a parameter is out of range.
///
/// # Complexity
/// A factorization of its own: `2 (2 #E)^3 / 3` operations.
///
/// ```
/// use homeo::harmonic::{EdgeCondition::{NoFlux, Values}, ElementParams, HarmonicFunctions, solve_mixed};
/// use homeo_core::planar::PlanarDomain;
/// let square = PlanarDomain::new(vec![vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]])?;
/// let sides = [NoFlux, Values([1.0, 1.0]), NoFlux, Values([0.0, 0.0])];
/// let across = solve_mixed(&square, &ElementParams::default(), &sides)?;
/// let mut value = [0.0];
/// across.values_into([0.5, 1.3], &mut value)?;
/// assert!((value[0] - 0.25).abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve_mixed(
    domain: &PlanarDomain,
    params: &ElementParams,
    conditions: &[EdgeCondition],
) -> Result<BoundaryElementFunctions, HarmonicFunctionError> {
    let elements = Elements::new(domain, params)?;
    check(conditions, elements.edges.len())?;
    let n = 2 * elements.all.len();
    let rows: Vec<(Vec<f64>, f64)> = (0..n).into_par_iter().map(|i| equation(&elements, conditions, i)).collect();
    let matrix = Mat::from_fn(n, n, |i, j| rows[i].0[j]);
    let solution = matrix.partial_piv_lu().solve(&Mat::from_fn(n, 1, |i, _| rows[i].1));
    let mut coefficients = vec![0.0; COEFFICIENTS * elements.all.len()];
    for (e, block) in coefficients.chunks_exact_mut(COEFFICIENTS).enumerate() {
        let found = [solution[(2 * e, 0)], solution[(2 * e + 1, 0)]];
        match given(&elements, conditions, e) {
            Some(values) => block[..4].copy_from_slice(&[found[0], found[1], values[0], values[1]]),
            None => block[2..4].copy_from_slice(&found),
        }
    }
    BoundaryElementFunctions::new(Arc::new(elements), 1, coefficients, Trace::Found)
}

fn check(conditions: &[EdgeCondition], edges: usize) -> Result<(), HarmonicFunctionError> {
    check_length(conditions.len(), edges)?;
    let mut is_given = false;
    for (entry, condition) in conditions.iter().enumerate() {
        let EdgeCondition::Values(values) = condition else { continue };
        is_given = true;
        if let Some(&value) = values.iter().find(|v| !v.is_finite()) {
            return Err(HarmonicFunctionError::BadData { entry, value });
        }
    }
    if is_given { Ok(()) } else { Err(HarmonicFunctionError::NothingGiven) }
}

/// The given values on an element: 1 and `t`.
fn given(elements: &Elements, conditions: &[EdgeCondition], element: usize) -> Option<[f64; 2]> {
    let element = &elements.all[element];
    let EdgeCondition::Values([begin, end]) = conditions[element.edge] else { return None };
    let [middle, half] = element.shares(&elements.edges[element.edge]);
    Some([begin + (end - begin) * middle, (end - begin) * half])
}

/// Green's identity at collocation point `i`: normal derivatives are unknown where values are given, and values where
/// they are not.
fn equation(elements: &Elements, conditions: &[EdgeCondition], i: usize) -> (Vec<f64>, f64) {
    let (mut row, mut right) = (vec![0.0; 2 * elements.all.len()], 0.0);
    at_collocation(elements, i, |e, single, double| {
        row[2 * e..2 * e + 2].copy_from_slice(&match given(elements, conditions, e) {
            Some(values) => {
                right += double[0] * values[0] + double[1] * values[1];
                single
            }
            None => [-double[0], -double[1]],
        });
    });
    let t = COLLOCATION[i % 2];
    match given(elements, conditions, i / 2) {
        Some(values) => right += values[0] + t * values[1],
        None => {
            row[i / 2 * 2] -= 1.0;
            row[i / 2 * 2 + 1] -= t;
        }
    }
    (row, right)
}
