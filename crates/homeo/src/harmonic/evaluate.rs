//! Values and gradients of what the boundary element method found.

use std::f64::consts::TAU;
use std::sync::Arc;

use faer::c64;
use homeo_core::planar::{PlanarDomain, Point2};
use rayon::prelude::*;

use super::condition::BoundaryData;
use super::elements::{Elements, Place};
use super::kernel::{cauchy, moments};
use super::{HarmonicFunctionError, HarmonicFunctions, check_length};

/// Numbers for each element and function: normal derivative (1, `t`), value (1, `t`, `t^2`).
pub(super) const COEFFICIENTS: usize = 5;

/// What is known of the values on the boundary.
#[derive(Clone, Debug)]
pub(super) enum Trace {
    /// Given everywhere, and continuous.
    Given(BoundaryData),
    /// Interpolated in each element, and continuous.
    Sampled,
    /// Found in part: it may jump between elements.
    Found,
}

/// Functions that are sums of layers on the elements: harmonic inside to rounding.
///
/// # On the boundary
/// [`values_into`](HarmonicFunctions::values_into) returns the given values on the boundary (decided exactly). The limit
/// from inside differs from them by the [defect](Self::boundary_defect), and by the maximum principle values inside
/// differ from those of the true harmonic function by no more than the largest defect. Gradients on the boundary are
/// limits from inside; where elements meet there are none, and close by they have an error that grows as the logarithm of
/// the distance.
///
/// # Complexity
/// A logarithm and an arctangent for each near element, a short sum for each far one; #E by #F products.
#[derive(Clone, Debug)]
pub struct BoundaryElementFunctions {
    elements: Arc<Elements>,
    functions: usize,
    /// Element by element, coefficient by coefficient, all functions.
    coefficients: Vec<f64>,
    trace: Trace,
}

/// In the frame of an element: where the limit from inside is compared with what is given.
const DEFECT_POINTS: [f64; 5] = [-0.97, -0.85, 0.0, 0.85, 0.97];

impl BoundaryElementFunctions {
    pub(super) fn new(
        elements: Arc<Elements>,
        functions: usize,
        coefficients: Vec<f64>,
        trace: Trace,
    ) -> Result<Self, HarmonicFunctionError> {
        match coefficients.iter().all(|c| c.is_finite()) {
            true => Ok(Self { elements, functions, coefficients, trace }),
            false => Err(HarmonicFunctionError::Singular("the solution is not finite")),
        }
    }

    /// What they are functions of.
    pub fn domain(&self) -> &PlanarDomain {
        &self.elements.domain
    }

    /// The edge on which a point of the closed domain lies, exactly, and at which share of it.
    pub(super) fn edge_of(&self, point: Point2) -> Result<Option<(usize, f64)>, HarmonicFunctionError> {
        Ok(self.elements.edge_at(self.elements.scaled(point)?))
    }

    /// How many elements there are.
    pub fn element_count(&self) -> usize {
        self.elements.all.len()
    }

    /// How much the limits from inside differ from the values on the boundary: the most of all functions, at five points
    /// of each element.
    ///
    /// An estimate of the error inside, not a bound: it is sampled. For functions of [mixed](super::solve_mixed)
    /// conditions it says nothing about the error that comes from edges without given values.
    pub fn boundary_defect(&self) -> f64 {
        let of_element = |e: usize| {
            let (mut values, mut worst) = (vec![0.0; self.functions], 0.0f64);
            for t in DEFECT_POINTS {
                self.layers(self.elements.place(e, t), &mut values);
                for (f, value) in values.iter().enumerate() {
                    let [a, b, c] = [2, 3, 4].map(|k| self.coefficient(e, k)[f]);
                    worst = worst.max((value - (a + t * (b + t * c))).abs());
                }
            }
            worst
        };
        (0..self.element_count()).into_par_iter().map(of_element).reduce(|| 0.0, f64::max)
    }

    /// With the single layer of the wrong sign: a control.
    #[cfg(test)]
    pub(super) fn with_wrong_sign(mut self) -> Self {
        for block in self.coefficients.chunks_exact_mut(COEFFICIENTS * self.functions) {
            block[..2 * self.functions].iter_mut().for_each(|c| *c = -*c);
        }
        self
    }

    fn coefficient(&self, element: usize, which: usize) -> &[f64] {
        let begin = (COEFFICIENTS * element + which) * self.functions;
        &self.coefficients[begin..begin + self.functions]
    }

    /// The sum of all layers.
    fn layers(&self, place: Place, values: &mut [f64]) {
        values.fill(0.0);
        self.elements.for_each(place, |e, element, local| {
            let found = moments(local, element.half);
            let [a, b, c] = found.double;
            for (which, moment) in [found.single[0], found.single[1], -a, -b, -c].into_iter().enumerate() {
                values.iter_mut().zip(self.coefficient(e, which)).for_each(|(sum, x)| *sum += moment * x);
            }
        });
    }

    /// The values on the boundary.
    fn on_edge(&self, edge: usize, share: f64, values: &mut [f64]) {
        let edge = &self.elements.edges[edge];
        if let Trace::Given(data) = &self.trace {
            let gone = data.profile.at(share);
            let [begin, end] = edge.vertices.map(|v| data.at_vertex(v));
            for (f, value) in values.iter_mut().enumerate() {
                *value = begin[f] * (1.0 - gone) + end[f] * gone;
            }
            return;
        }
        let last = edge.elements.end - 1;
        let holds = |&e: &usize| {
            let [middle, half] = self.elements.all[e].shares(edge);
            share <= middle + half
        };
        let e = edge.elements.clone().find(holds).unwrap_or(last);
        let [middle, half] = self.elements.all[e].shares(edge);
        let t = ((share - middle) / half).clamp(-1.0, 1.0);
        for (f, value) in values.iter_mut().enumerate() {
            let [a, b, c] = [2, 3, 4].map(|k| self.coefficient(e, k)[f]);
            *value = a + t * (b + t * c);
        }
    }

    /// Gradients of all layers at a scaled point, per unit of the scaled length: conjugates of complex derivatives. Double
    /// layers are integrated by parts: what is left at the ends of elements cancels where values do not jump.
    fn slopes(&self, point: Point2, gradients: &mut [Point2]) {
        gradients.fill([0.0; 2]);
        let jumps = matches!(self.trace, Trace::Found);
        self.elements.for_each(Place::new(point), |e, element, local| {
            let [zeroth, first, _] = cauchy(local);
            let direction = self.elements.edges[element.edge].direction.conj();
            let single = direction * (-1.0 / TAU);
            let double = direction * c64::new(0.0, 1.0 / (TAU * element.half));
            let weights = [single * zeroth, single * first, double * zeroth, double * first * 2.0];
            for (k, weight) in [0, 1, 3, 4].into_iter().zip(weights) {
                add(gradients, weight, self.coefficient(e, k).iter().copied());
            }
            if jumps {
                let of = |e: usize, k: usize, f: usize| self.coefficient(e, k)[f];
                let end = |e: usize, t: f64, f: usize| of(e, 2, f) + t * (of(e, 3, f) + t * of(e, 4, f));
                let jump = |f: usize| end(element.next, -1.0, f) - end(e, 1.0, f);
                add(gradients, double / c64::new(local.right, local.height), (0..self.functions).map(jump));
            }
        });
    }
}

/// Adds the conjugate of a weight times a number to each gradient.
fn add(gradients: &mut [Point2], weight: c64, factors: impl Iterator<Item = f64>) {
    gradients.iter_mut().zip(factors).for_each(|(sum, x)| *sum = [sum[0] + weight.re * x, sum[1] - weight.im * x]);
}

impl HarmonicFunctions for BoundaryElementFunctions {
    fn function_count(&self) -> usize {
        self.functions
    }

    fn values_into(&self, point: Point2, values: &mut [f64]) -> Result<(), HarmonicFunctionError> {
        check_length(values.len(), self.functions)?;
        let scaled = self.elements.scaled(point)?;
        match self.elements.edge_at(scaled) {
            Some((edge, share)) => self.on_edge(edge, share, values),
            None => self.layers(Place::new(scaled), values),
        }
        Ok(())
    }

    fn gradients_into(
        &self,
        point: Point2,
        values: &mut [f64],
        gradients: &mut [Point2],
    ) -> Result<(), HarmonicFunctionError> {
        check_length(gradients.len(), self.functions)?;
        self.values_into(point, values)?;
        self.slopes(self.elements.scaled(point)?, gradients);
        gradients.iter_mut().for_each(|g| *g = g.map(|x| x * self.elements.scale));
        let is_known = gradients.iter().flatten().all(|g| g.is_finite());
        if is_known { Ok(()) } else { Err(HarmonicFunctionError::NoGradient { point }) }
    }
}
