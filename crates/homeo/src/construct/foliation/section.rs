//! Section maps: the source region onto an interval, a circle's worth of parameters, or the square.

use homeo_core::mesh::{Adjacency, Facet, SimplicialComplex, VertexId};
use homeo_core::predicate::{Sign, orient2d};

use super::boundary::{BoundarySurface, boundary_loop, edge_end, edge_start};
use super::field::{cotangent_weights, difference, dot};
use super::regions::equal_arcs;
use crate::linear::GraphLaplacian;
use crate::map::Section;

/// Coordinates of sections are multiples of this, which keeps exact images short.
const GRID: f64 = (1u64 << 40) as f64;

/// No embedding of the source region was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the source region could not be embedded in the square with double precision")]
pub struct NotEmbedded;

/// Arc length along a run of boundary edges, from 0 to `length`, as multiples of 2^-40.
///
/// Parameters increase strictly whatever the lengths of the edges.
fn arc_parameters(edge_lengths: &[f64], length: f64) -> Vec<f64> {
    let total: f64 = edge_lengths.iter().sum();
    let count = edge_lengths.len();
    let mut parameters = Vec::with_capacity(count + 1);
    let (mut reached, mut last) = (0.0, -1.0);
    for k in 0..=count {
        let fraction = if total > 0.0 { reached / total } else { k as f64 / count as f64 };
        let left = (count - k) as f64;
        let wanted = (fraction * length * GRID).round().max(last + 1.0).min(length * GRID - left);
        parameters.push(wanted / GRID);
        last = wanted;
        reached += edge_lengths.get(k).copied().unwrap_or(0.0);
    }
    parameters
}

fn edge_length<const K: usize>(complex: &SimplicialComplex<K>, positions: &[[f64; 3]], facet: Facet) -> f64 {
    let [a, b] = [edge_start(complex, facet), edge_end(complex, facet)].map(|v| positions[v.index()]);
    let edge = difference(b, a);
    dot(edge, edge).sqrt()
}

/// Arc length on the source side of a square.
pub(super) fn square_section<const K: usize>(
    complex: &SimplicialComplex<K>,
    adjacency: &Adjacency<K>,
    positions: &[[f64; 3]],
    source: &[u8],
) -> Section {
    let facets = boundary_loop(complex, adjacency);
    let is_source = |facet: &Facet| source[facet.cell().index()] >> facet.opposite() & 1 == 1;
    let n = facets.len();
    let first = (0..n).find(|&k| is_source(&facets[k]) && !is_source(&facets[(k + n - 1) % n])).unwrap_or(0);
    let arc: Vec<Facet> = (0..n).map(|k| facets[(first + k) % n]).take_while(is_source).collect();
    let lengths: Vec<f64> = arc.iter().map(|&f| edge_length(complex, positions, f)).collect();
    let mut vertices: Vec<VertexId> = arc.iter().map(|&f| edge_start(complex, f)).collect();
    vertices.extend(arc.last().map(|&f| edge_end(complex, f)));
    Section::Arc { vertices, parameters: arc_parameters(&lengths, 1.0) }
}

/// Arc length on the boundary loop of a disk, from 0 to 4.
pub(super) fn disk_section<const K: usize>(
    complex: &SimplicialComplex<K>,
    adjacency: &Adjacency<K>,
    positions: &[[f64; 3]],
) -> Section {
    let facets = boundary_loop(complex, adjacency);
    let lengths: Vec<f64> = facets.iter().map(|&f| edge_length(complex, positions, f)).collect();
    let mut parameters = arc_parameters(&lengths, 4.0);
    parameters.pop();
    Section::Loop { vertices: facets.iter().map(|&f| edge_start(complex, f)).collect(), parameters }
}

/// Tutte's embedding of the source region of a cube: boundary by arc length round the square,
/// interior by positive weights. The sign of every triangle is decided exactly on the rounded points.
///
/// # Errors
/// When neither cotangent nor uniform weights give an embedding in `f64`.
pub(super) fn cube_section(surface: &BoundarySurface, positions: &[[f64; 3]]) -> Result<Section, NotEmbedded> {
    let positions = surface.positions(positions);
    let triangles = &surface.triangles;
    let adjacency = triangles.adjacency().map_err(|_| NotEmbedded)?;
    let edges = triangles.edges();
    let boundary = boundary_on_square(triangles, &adjacency, &positions).ok_or(NotEmbedded)?;
    let uniform = vec![1.0; edges.len()];
    for weights in [cotangent_weights(triangles, &positions, &edges), uniform] {
        let laplacian = GraphLaplacian::new(triangles.vertex_count(), edges.ends(), &weights);
        let Ok(coordinates) = laplacian.harmonic_direct(&boundary) else { continue };
        let rounded: Vec<[f64; 2]> = coordinates.iter().map(|p| p.map(|x| (x * GRID).round() / GRID)).collect();
        for coordinates in [rounded, coordinates] {
            let is_embedded = triangles.cells().iter().all(|cell| {
                let [a, b, c] = cell.map(|v| coordinates[v.index()]);
                orient2d(a, b, c) == Sign::Positive
            });
            if is_embedded {
                return Ok(Section::Square { vertices: surface.vertices.clone(), coordinates });
            }
        }
    }
    Err(NotEmbedded)
}

/// Images of the boundary vertices of a disk on the boundary of the unit square.
fn boundary_on_square(
    triangles: &SimplicialComplex<3>,
    adjacency: &Adjacency<3>,
    positions: &[[f64; 3]],
) -> Option<Vec<Option<[f64; 2]>>> {
    let facets = boundary_loop(triangles, adjacency);
    let n = facets.len();
    if n < 4 {
        return None;
    }
    let corners = equal_arcs(triangles, &facets, positions);
    let mut images = vec![None; triangles.vertex_count()];
    for side in 0..4 {
        let (from, to) = (corners[side], if side == 3 { n } else { corners[side + 1] });
        let lengths: Vec<f64> = facets[from..to].iter().map(|&f| edge_length(triangles, positions, f)).collect();
        for (facet, s) in facets[from..to].iter().zip(arc_parameters(&lengths, 1.0)) {
            let point = [[s, 0.0], [1.0, s], [1.0 - s, 1.0], [0.0, 1.0 - s]][side];
            images[edge_start(triangles, *facet).index()] = Some(point);
        }
    }
    Some(images)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arc_parameters_increase_even_where_edges_have_no_length() {
        let parameters = arc_parameters(&[0.0, 1.0, 0.0, 0.0], 1.0);
        assert_eq!((parameters[0], parameters[4]), (0.0, 1.0));
        assert!(parameters.windows(2).all(|w| w[0] < w[1]));
        assert!(arc_parameters(&[0.0; 3], 4.0).windows(2).all(|w| w[0] < w[1]));
    }
}
