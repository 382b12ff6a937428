//! How long edges may be for a surface that bends.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use super::shape::{area_vector, distance, normal};
use crate::construct::shell::directions::dot;
use crate::construct::shell::prism::sides;
use crate::input::SourceMesh;

/// How much longer edges may become per length.
const GROWTH: f64 = 0.5;

/// Lengths of edges, one per vertex, with which chords stay within about `error` of a surface: `sqrt(6 e / k - 3 e^2)` for
/// the curvature `k` and the error `e`, between the `shortest` and the `longest`, and growing by at most one half of the
/// way between neighbours.
///
/// The curvature at a vertex is the largest one across its edges, the angle between the normals by the distance of the
/// centroids. Edges with a larger angle than `feature_angle` (in radians) do not count: they are meant to be sharp.
/// A guide, without a guarantee; for [`RemeshParams::sizing`](super::RemeshParams), which takes them relative to its length.
///
/// # Source
/// Dunyach, Vanderhaeghe, Barthe, Botsch 2013 (doi 10.2312/conf/EG2013/short/029-032), section 3.
///
/// # Example
/// ```
/// use homeo::{construct::section::lengths_by_curvature, input::SourceMesh};
/// use homeo_core::mesh::SimplicialComplex;
///
/// // A square, folded a little along a diagonal, and one that is not.
/// let corners = |height| vec![[0.0, 0.0, 0.0], [1.0, 0.0, height], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let complex = SimplicialComplex::from_indices(4, &[[0, 1, 2], [0, 2, 3]])?;
/// let lengths = |height| {
///     lengths_by_curvature(&SourceMesh::new(corners(height), complex.clone()), 0.01, [0.1, 1.0], None)
/// };
/// assert_eq!(lengths(0.0), [1.0; 4]);
/// assert!(lengths(0.3)[0] < 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn lengths_by_curvature(
    surface: &SourceMesh<3>,
    error: f64,
    [shortest, longest]: [f64; 2],
    feature_angle: Option<f64>,
) -> Vec<f64> {
    let wanted = |curvature: f64| {
        let squared = 6.0 * error / curvature - 3.0 * error * error;
        if squared > 0.0 { squared.sqrt().clamp(shortest, longest) } else { shortest }
    };
    let mut lengths: Vec<f64> = largest_curvatures(surface, feature_angle).into_iter().map(wanted).collect();
    limit_growth(surface, &mut lengths);
    lengths
}

/// At each vertex the largest curvature across one of its edges; 0 where there are only edges of one triangle.
fn largest_curvatures(surface: &SourceMesh<3>, feature_angle: Option<f64>) -> Vec<f64> {
    let mut largest = vec![0.0f64; surface.positions().len()];
    let mut first = HashMap::new();
    for cell in surface.complex().cells() {
        let corners = cell.map(|v| surface.positions()[v.index()]);
        let (direction, doubled_area) = (normal(corners), dot(area_vector(corners), area_vector(corners)).sqrt());
        for [a, b] in sides(cell.map(|v| v.raw())) {
            let Some((other, other_area)) = first.remove(&[b, a]) else {
                first.insert([a, b], (direction, doubled_area));
                continue;
            };
            let angle = dot(direction, other).clamp(-1.0, 1.0).acos();
            let length = distance(surface.positions()[a as usize], surface.positions()[b as usize]);
            // A third of either height.
            let way = (doubled_area + other_area) / (3.0 * length);
            if feature_angle.is_none_or(|sharp| angle <= sharp) && angle > 0.0 {
                for v in [a, b] {
                    largest[v as usize] = largest[v as usize].max(angle / way);
                }
            }
        }
    }
    largest
}

/// Shortens lengths so that along every edge they grow by at most [`GROWTH`] times its own: the shortest first.
fn limit_growth(surface: &SourceMesh<3>, lengths: &mut [f64]) {
    let mut neighbours = vec![Vec::new(); lengths.len()];
    for [a, b] in surface.complex().cells().iter().flat_map(|cell| sides(cell.map(|v| v.raw()))) {
        // Edges on the boundary have one direction only.
        neighbours[a as usize].push(b);
        neighbours[b as usize].push(a);
    }
    // Positive numbers are in the order of their bits.
    let mut queue: BinaryHeap<_> = (0u32..).zip(&*lengths).map(|(v, length)| Reverse((length.to_bits(), v))).collect();
    while let Some(Reverse((bits, v))) = queue.pop() {
        if lengths[v as usize].to_bits() != bits {
            continue;
        }
        for &other in &neighbours[v as usize] {
            let way = distance(surface.positions()[v as usize], surface.positions()[other as usize]);
            let allowed = lengths[v as usize] + GROWTH * way;
            if allowed < lengths[other as usize] {
                lengths[other as usize] = allowed;
                queue.push(Reverse((allowed.to_bits(), other)));
            }
        }
    }
}
