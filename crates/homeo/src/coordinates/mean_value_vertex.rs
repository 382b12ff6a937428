//! Derivatives of mean value coordinates at vertices, where they have no gradient but derivatives by direction.

use homeo_core::planar::PlanarDomain;

use super::CoordinateError;
use super::mean_value::{HalfAngle, scaled_tangents};
use super::outline::{Outline, dot};

/// Derivatives (#V) of all mean value coordinates at a vertex in a direction, of any length; vertices are numbered ring
/// after ring.
///
/// With `T_j` the tangents of half the angles under which edges are seen from the vertex `k`, and those of its own two
/// edges as seen from a point moved a little: `|d| (T_{j-1} + T_j) / (s_j (T_{k-1} + T_k))` for `j != k`, where `s_j` is
/// the distance of vertex `j`. On the directions of the two edges coordinates are linear. Differs from the source, 6.2.1,
/// where the derivative of the second coordinate lacks a factor of 2, and which has no holes.
///
/// # Errors
/// The direction is zero or not finite, or there is no such vertex.
///
/// # Complexity
/// Linear in #V.
///
/// ```
/// use homeo::coordinates::mean_value_derivative_at_vertex;
/// use homeo_core::planar::PlanarDomain;
/// let domain = PlanarDomain::new(vec![vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]])?;
/// let along_edge = mean_value_derivative_at_vertex(&domain, 0, [1.0, 0.0])?;
/// assert!((along_edge[0] + 0.25).abs() < 1e-15 && (along_edge[1] - 0.25).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn mean_value_derivative_at_vertex(
    domain: &PlanarDomain,
    vertex: usize,
    direction: [f64; 2],
) -> Result<Vec<f64>, CoordinateError> {
    let outline = Outline::new(domain);
    let n = outline.count();
    if vertex >= n {
        return Err(CoordinateError::NoSuchVertex { vertex, count: n });
    }
    let length = direction[0].hypot(direction[1]);
    if !(length > 0.0 && length.is_finite()) {
        return Err(CoordinateError::NotFinite { point: direction });
    }
    let to = |i: usize| match i == vertex {
        true => direction.map(|x| -x / length),
        false => outline.between(vertex, i),
    };
    let half = |i: usize| {
        let (a, b) = (to(i), to(outline.next[i]));
        let cross = match i == vertex || outline.next[i] == vertex {
            true => a[0] * b[1] - a[1] * b[0],
            false => outline.cross::<f64>(i, outline.next[i], outline.vertices[vertex]),
        };
        HalfAngle::new(cross, a[0].hypot(a[1]) * b[0].hypot(b[1]), dot(a, b))
    };
    let tangents = scaled_tangents(&(0..n).map(half).collect::<Vec<_>>());
    let weight = |i: usize| tangents[outline.previous[i]] + tangents[i];
    let factor = length * outline.scale / weight(vertex);
    let derivative = |i: usize| match i == vertex {
        true => 0.0,
        false => factor * weight(i) / to(i)[0].hypot(to(i)[1]),
    };
    let mut derivatives: Vec<f64> = (0..n).map(derivative).collect();
    derivatives[vertex] = -derivatives.iter().sum::<f64>();
    Ok(derivatives)
}
