//! From weights to coordinates: `w_i / W`, with its gradient.

use super::CoordinateError;
use super::outline::{Outline, Sight};
use super::real::{Jet, Real};

/// A kind of coordinates that is given by weights at points that are no vertices.
pub(super) trait Weighted {
    fn outline(&self) -> &Outline;

    /// Numbers proportional to the coordinates; any common factor will do, so that it keeps them finite and their
    /// gradients too wherever those of the coordinates are.
    fn weights<T: Real<2>>(&self, sight: &Sight<T>) -> Result<Vec<T>, CoordinateError>;

    /// Gradients (#V by 2) at a vertex, in the scale of the outline.
    fn vertex_gradients(&self, vertex: usize, _: &mut [[f64; 2]]) -> Result<(), CoordinateError> {
        Err(CoordinateError::NoGradient { vertex })
    }
}

/// Values of the coordinates, everywhere.
pub(super) fn values<K: Weighted>(kind: &K, point: [f64; 2], values: &mut [f64]) -> Result<(), CoordinateError> {
    let outline = kind.outline();
    check_length(outline.count(), values.len())?;
    let local = outline.local(point)?;
    if let Some(vertex) = outline.vertex_at(local) {
        lagrange(vertex, values);
        return Ok(());
    }
    let weights = kind.weights::<f64>(&outline.sight(local))?;
    let total: f64 = weights.iter().sum();
    check_total(total, point)?;
    values.iter_mut().zip(&weights).for_each(|(value, weight)| *value = weight / total);
    Ok(())
}

/// Values and gradients of the coordinates, at points that are no vertices.
pub(super) fn gradients<K: Weighted>(
    kind: &K,
    point: [f64; 2],
    values: &mut [f64],
    gradients: &mut [[f64; 2]],
) -> Result<(), CoordinateError> {
    let outline = kind.outline();
    check_length(outline.count(), values.len())?;
    check_length(outline.count(), gradients.len())?;
    let local = outline.local(point)?;
    if let Some(vertex) = outline.vertex_at(local) {
        lagrange(vertex, values);
        kind.vertex_gradients(vertex, gradients)?;
    } else {
        let weights = kind.weights::<Jet<2>>(&outline.sight(local))?;
        check_total(normalise(&weights, values, gradients), point)?;
    }
    gradients.iter_mut().flatten().for_each(|g| *g *= outline.scale);
    Ok(())
}

/// Divides weights by their sum, which is returned.
///
/// The gradient of the largest coordinate is minus the sum of the others: near its vertex it is a small difference of
/// large numbers, but that of no other is.
pub(super) fn normalise<const D: usize>(weights: &[Jet<D>], values: &mut [f64], gradients: &mut [[f64; D]]) -> f64 {
    let total: f64 = weights.iter().map(|w| w.value).sum();
    let sum: [f64; D] = std::array::from_fn(|k| weights.iter().map(|w| w.gradient[k]).sum());
    let mut largest = 0;
    for (i, weight) in weights.iter().enumerate() {
        values[i] = weight.value / total;
        gradients[i] = std::array::from_fn(|k| (weight.gradient[k] - values[i] * sum[k]) / total);
        if values[i].abs() > values[largest].abs() {
            largest = i;
        }
    }
    balance(largest, gradients);
    total
}

/// Makes gradients sum to zero by the one of vertex `largest`.
pub(super) fn balance<const D: usize>(largest: usize, gradients: &mut [[f64; D]]) {
    gradients[largest] = [0.0; D];
    gradients[largest] = std::array::from_fn(|k| -gradients.iter().map(|g| g[k]).sum::<f64>());
}

/// One at a vertex, zero at the others.
pub(super) fn lagrange(vertex: usize, values: &mut [f64]) {
    values.fill(0.0);
    values[vertex] = 1.0;
}

/// Refuses a buffer of the wrong length.
pub(super) fn check_length(expected: usize, found: usize) -> Result<(), CoordinateError> {
    if expected == found { Ok(()) } else { Err(CoordinateError::WrongLength { expected, found }) }
}

/// Refuses a sum of weights that cannot be divided by.
pub(super) fn check_total(total: f64, point: [f64; 2]) -> Result<(), CoordinateError> {
    if total != 0.0 && total.is_finite() { Ok(()) } else { Err(CoordinateError::Undefined { point }) }
}
