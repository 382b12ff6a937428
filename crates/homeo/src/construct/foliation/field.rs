//! The harmonic field that the front follows, and its weights.

use homeo_core::mesh::{CELL_EDGES, CellId, EdgeIndex, SimplicialComplex, VertexId};

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

/// Rank of each cell by a field that is harmonic, 0 at `source` and 1 at `sink` vertices.
///
/// The cell's value is the mean of its vertices. Ties go by cell number.
pub(super) fn harmonic_rank<const K: usize>(
    complex: &SimplicialComplex<K>,
    positions: &[Vector],
    edges: &EdgeIndex<K>,
    source: &[VertexId],
    sink: &[VertexId],
) -> Vec<f64> {
    let mut fixed = vec![None; complex.vertex_count()];
    source.iter().for_each(|v| fixed[v.index()] = Some(0.0));
    sink.iter().for_each(|v| fixed[v.index()] = Some(1.0));
    let weights = cotangent_weights(complex, positions, edges);
    let laplacian = GraphLaplacian::new(complex.vertex_count(), edges.ends(), &weights);
    let field = laplacian.harmonic_iterative(&fixed, 1e-8);
    complex.cells().iter().map(|cell| cell.iter().map(|v| field[v.index()]).sum()).collect()
}

/// Ranks `0..n` of values; ties go by index.
pub(super) fn ranks(values: &[f64]) -> Vec<u32> {
    let mut order: Vec<CellId> = (0..values.len()).map(CellId::new).collect();
    order.sort_unstable_by(|a, b| values[a.index()].total_cmp(&values[b.index()]).then(a.cmp(b)));
    super::front::positions_in(&order, values.len())
}
