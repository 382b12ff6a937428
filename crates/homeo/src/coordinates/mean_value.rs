//! Mean value coordinates: values and gradients, without breakdown at the boundary.
//!
//! Weights are `(t_{i-1} + t_i) / r_i` with `t_i = tan(alpha_i / 2)`, where edge `i` is seen under the angle `alpha_i` and
//! vertex `i` at the distance `r_i`. With `c`, `d` the cross and dot product of the vectors to the ends of an edge and `r`,
//! `r'` their lengths, `t = c / (r r' + d) = (r r' - d) / c`; the first has no cancellation for angles below 90 degrees,
//! the second above. The paper (4.5.3) has the first only, which breaks down near edges.

use homeo_core::planar::PlanarDomain;

use super::outline::{Outline, Sight};
use super::real::Real;
use super::weighted::{self, Weighted};
use super::{CoordinateError, PlanarCoordinates};

/// Mean value coordinates (Floater 2003; Hormann, Floater 2006) of a polygon, with holes or without.
///
/// Defined in all of the plane, also outside. Positive inside convex polygons, and smooth except at vertices, where they
/// are continuous and have [derivatives by direction](super::mean_value_derivative_at_vertex).
///
/// # Accuracy
/// Values from [`values_into`](PlanarCoordinates::values_into) and the batch functions are accurate to some `1e-13` of the
/// largest; those that come with gradients, and the gradients, to some `1e-13` of their own sizes, near edges and
/// vertices too (of the sizes of their terms, where the polygon is not convex).
///
/// # Complexity
/// Linear in #V: one root and one division for each vertex. Gradients cost some ten times as much.
///
/// ```
/// use homeo::coordinates::{MeanValue, PlanarCoordinates};
/// use homeo_core::planar::PlanarDomain;
/// let outer = vec![[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]];
/// let hole = vec![[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
/// let kind = MeanValue::new(&PlanarDomain::new(vec![outer, hole])?);
/// let mut values = [0.0; 8];
/// kind.values_into([1.0, 0.5], &mut values)?;
/// assert!((values[6] - 0.75).abs() < 1e-15 && (values[7] - 0.25).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct MeanValue {
    outline: Outline,
}

impl MeanValue {
    /// Of all rings of a domain.
    pub fn new(domain: &PlanarDomain) -> Self {
        Self { outline: Outline::new(domain) }
    }
}

impl PlanarCoordinates for MeanValue {
    fn vertex_count(&self) -> usize {
        self.outline.count()
    }

    fn values_into(&self, point: [f64; 2], values: &mut [f64]) -> Result<(), CoordinateError> {
        weighted::check_length(self.outline.count(), values.len())?;
        let local = self.outline.local(point)?;
        if self.quick_values(local, values) { Ok(()) } else { weighted::values(self, point, values) }
    }

    fn gradients_into(
        &self,
        point: [f64; 2],
        values: &mut [f64],
        gradients: &mut [[f64; 2]],
    ) -> Result<(), CoordinateError> {
        weighted::gradients(self, point, values, gradients)
    }
}

impl Weighted for MeanValue {
    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn weights<T: Real<2>>(&self, sight: &Sight<T>) -> Result<Vec<T>, CoordinateError> {
        let outline = &self.outline;
        let halves = |i: usize| {
            HalfAngle::new(sight.cross[i], sight.distance[i] * sight.distance[outline.next[i]], sight.dot[i])
        };
        let tangents = scaled_tangents(&(0..outline.count()).map(halves).collect::<Vec<_>>());
        // Near a vertex all others matter as much as its distance: multiplied by that, nothing grows.
        let near = least(sight.distance.iter().map(|r| r.value()));
        let share = |i: usize| if i == near { T::constant(1.0) } else { sight.distance[near] / sight.distance[i] };
        Ok((0..outline.count()).map(|i| (tangents[outline.previous[i]] + tangents[i]) * share(i)).collect())
    }
}

/// The tangent of half an angle of at most 90 degrees, or the cotangent of half an angle of more.
#[derive(Clone, Copy)]
pub(super) enum HalfAngle<T> {
    Tangent(T),
    Cotangent(T),
}

impl<T: Real<2>> HalfAngle<T> {
    /// Of the angle between vectors with this cross product, product of lengths and dot product.
    pub fn new(cross: T, lengths: T, dot: T) -> Self {
        if dot.value() < 0.0 {
            Self::Cotangent(cross / (lengths - dot))
        } else {
            Self::Tangent(cross / (lengths + dot))
        }
    }
}

/// Tangents of half angles, all multiplied by the cotangent of the widest: 1 for that, less for all others, and smooth
/// where it is a half turn.
pub(super) fn scaled_tangents<T: Real<2>>(halves: &[HalfAngle<T>]) -> Vec<T> {
    let cotangent = |half: &HalfAngle<T>| match half {
        HalfAngle::Cotangent(c) => c.value().abs(),
        HalfAngle::Tangent(_) => f64::INFINITY,
    };
    let widest = least(halves.iter().map(cotangent));
    let factor = match halves[widest] {
        HalfAngle::Cotangent(c) => c,
        HalfAngle::Tangent(_) => T::constant(1.0),
    };
    let scaled = |(i, &half): (usize, &HalfAngle<T>)| match half {
        HalfAngle::Cotangent(_) if i == widest => T::constant(1.0),
        HalfAngle::Cotangent(c) => factor / c,
        HalfAngle::Tangent(t) => factor * t,
    };
    halves.iter().enumerate().map(scaled).collect()
}

/// Where the least number is; 0 where there is none.
pub(super) fn least(numbers: impl Iterator<Item = f64>) -> usize {
    numbers.enumerate().fold((0, f64::INFINITY), |best, (i, x)| if x < best.1 { (i, x) } else { best }).0
}
