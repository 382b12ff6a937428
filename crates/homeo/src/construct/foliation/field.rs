//! The harmonic field that the front follows, and its weights.

use homeo_core::mesh::{CELL_EDGES, CellId, EdgeIndex, Facet, SimplicialComplex, VertexId};

use crate::linear::GraphLaplacian;

type Vector = [f64; 3];

pub(super) fn difference(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Gradients of the barycentric coordinates of a simplex and its measure (area or volume).
///
/// Gradients of a triangle lie in its plane. A flat simplex gives infinities or NaN.
pub(super) fn gradients<const K: usize>(corners: [Vector; K]) -> ([Vector; K], f64) {
    let mut gradients = [[0.0; 3]; K];
    if K == 4 {
        let [a, b, c] = [1, 2, 3].map(|i| difference(corners[i], corners[0]));
        let normals = [cross(b, c), cross(c, a), cross(a, b)];
        let six_volumes = dot(a, normals[0]);
        for i in 0..3 {
            gradients[i + 1] = normals[i].map(|x| x / six_volumes);
        }
        gradients[0] = [0, 1, 2].map(|axis| -(gradients[1][axis] + gradients[2][axis] + gradients[3][axis]));
        return (gradients, six_volumes / 6.0);
    }
    let [u, v] = [1, 2].map(|i| difference(corners[i], corners[0]));
    let normal = cross(u, v);
    let square = dot(normal, normal);
    gradients[1] = cross(v, normal).map(|x| x / square);
    gradients[2] = cross(normal, u).map(|x| x / square);
    gradients[0] = [0, 1, 2].map(|axis| -(gradients[1][axis] + gradients[2][axis]));
    (gradients, square.sqrt() / 2.0)
}

/// Cotangent weights of all edges: `w_ij = -sum over cells of measure * (grad i . grad j)`.
pub(super) fn cotangent_weights<const K: usize>(
    complex: &SimplicialComplex<K>,
    positions: &[Vector],
    edges: &EdgeIndex<K>,
) -> Vec<f64> {
    let mut weights = vec![0.0; edges.len()];
    for cell in complex.cell_ids() {
        let (gradients, measure) = gradients(complex.cell(cell).map(|v| positions[v.index()]));
        for (local, edge) in edges.of_cell(cell).iter().enumerate() {
            let [a, b] = CELL_EDGES[local];
            let weight = -measure * dot(gradients[a], gradients[b]);
            if weight.is_finite() {
                weights[edge.index()] += weight;
            }
        }
    }
    weights
}

/// A field at the vertices that grows along the flow and is harmonic inside.
///
/// Leaves come in through the source facets and go out through the sink facets with a flux in
/// proportion to the facets' size, so that every part of both regions gets its share; a centre takes up the rest.
/// (Constant values on the regions, as the source paper has it, send next to no leaves to the far end
/// of a long region.)
pub(super) fn guiding_field<const K: usize>(
    complex: &SimplicialComplex<K>,
    positions: &[Vector],
    edges: &EdgeIndex<K>,
    source: &[Facet],
    sink: &[Facet],
    centre: Option<CellId>,
) -> Vec<f64> {
    let mut fixed = vec![None; complex.vertex_count()];
    let mut load = vec![0.0; complex.vertex_count()];
    for (facets, sign) in [(source, -1.0), (sink, 1.0)] {
        let total: f64 = facets.iter().map(|&f| facet_measure(complex, f, positions)).sum();
        for &facet in facets {
            let share =
                sign * facet_measure(complex, facet, positions) / (total.max(f64::MIN_POSITIVE) * (K - 1) as f64);
            complex.facet_vertices(facet.cell(), facet.opposite()).for_each(|v| load[v.index()] += share);
        }
    }
    // Something must be fixed: the field is known up to a constant.
    match (centre, source.first()) {
        (Some(cell), _) => complex.cell(cell).iter().for_each(|v| fixed[v.index()] = Some(0.0)),
        (None, Some(facet)) => {
            complex.facet_vertices(facet.cell(), facet.opposite()).take(1).for_each(|v| fixed[v.index()] = Some(0.0));
        }
        (None, None) => {}
    }
    let weights = cotangent_weights(complex, positions, edges);
    let laplacian = GraphLaplacian::new(complex.vertex_count(), edges.ends(), &weights);
    laplacian.solve_iterative(&fixed, &load, 1e-7)
}

/// Length or area of a facet.
fn facet_measure<const K: usize>(complex: &SimplicialComplex<K>, facet: Facet, positions: &[Vector]) -> f64 {
    let mut corners = [[0.0; 3]; K];
    for (corner, vertex) in corners.iter_mut().zip(complex.facet_vertices(facet.cell(), facet.opposite())) {
        *corner = positions[vertex.index()];
    }
    let first = difference(corners[1], corners[0]);
    let span = if K == 4 { cross(first, difference(corners[2], corners[0])).map(|x| x / 2.0) } else { first };
    dot(span, span).sqrt()
}

/// The gradient of a field in each cell, smoothed: the mean over the cell's vertices of the mean over
/// the cells around each (by measure), which slivers cannot spoil.
pub(super) fn smoothed_gradients<const K: usize>(
    complex: &SimplicialComplex<K>,
    positions: &[Vector],
    field: &[f64],
) -> Vec<[f32; 3]> {
    let mut sums = vec![([0.0; 3], 0.0); complex.vertex_count()];
    for cell in complex.cells() {
        let (gradients, measure) = gradients(cell.map(|v| positions[v.index()]));
        let weighted: Vector =
            std::array::from_fn(|axis| (0..K).map(|i| measure * field[cell[i].index()] * gradients[i][axis]).sum());
        if !weighted.iter().all(|x| x.is_finite()) {
            continue;
        }
        for vertex in cell {
            let (sum, total) = &mut sums[vertex.index()];
            (0..3).for_each(|axis| sum[axis] += weighted[axis]);
            *total += measure.abs();
        }
    }
    let mean = |v: VertexId| {
        let (sum, total) = sums[v.index()];
        if total > 0.0 { sum.map(|x| x / total) } else { [0.0; 3] }
    };
    complex
        .cells()
        .iter()
        .map(|cell| {
            let means = cell.map(mean);
            std::array::from_fn(|axis| (means.iter().map(|m| m[axis]).sum::<f64>() / K as f64) as f32)
        })
        .collect()
}

/// Rank of each cell by the mean of a field over its vertices.
pub(super) fn cell_means<const K: usize>(complex: &SimplicialComplex<K>, field: &[f64]) -> Vec<f64> {
    complex.cells().iter().map(|cell| cell.iter().map(|v| field[v.index()]).sum()).collect()
}

/// Ranks `0..n` of values; ties go by index.
pub(super) fn ranks(values: &[f64]) -> Vec<u32> {
    let mut order: Vec<CellId> = (0..values.len()).map(CellId::new).collect();
    order.sort_unstable_by(|a, b| values[a.index()].total_cmp(&values[b.index()]).then(a.cmp(b)));
    super::front::positions_in(&order, values.len())
}
