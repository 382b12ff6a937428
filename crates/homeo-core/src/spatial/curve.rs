//! An order of points in which neighbours in the order are neighbours in space.

use super::Aabb;
use crate::mesh::{CellId, SimplicialComplex, VertexId};

/// Bits per axis: three of them fit a 64-bit key, and 2 million steps along an axis are fine enough for any mesh.
const BITS: u32 = 21;

/// The numbers of `points` in the order in which a Hilbert curve through their box meets them.
///
/// Tables of cells and vertices in this order keep what is used together close together in memory, whatever
/// order a file had. Ties (points in one grid cell) keep their order, so the result is a function of the input alone.
/// Points that are not finite come somewhere. Cost: `O(n log n)`.
///
/// ```
/// use homeo_core::spatial::curve_order;
/// let corners = [[0.0, 0.0, 0.0], [9.0, 9.0, 9.0], [0.1, 0.0, 0.0], [9.0, 9.0, 8.9]];
/// let order = curve_order(&corners);
/// assert!(order == [0, 2, 1, 3] || order == [0, 2, 3, 1]);
/// ```
pub fn curve_order(points: &[[f64; 3]]) -> Vec<u32> {
    let hull = Aabb::of(points);
    let extent = (0..3).map(|axis| hull.high[axis] - hull.low[axis]).fold(0.0, f64::max);
    let scale = if extent > 0.0 { f64::from((1u32 << BITS) - 1) / extent } else { 0.0 };
    // A cast of what is not a number, or too large, gives 0 or the largest value.
    let grid = |p: &[f64; 3]| [0, 1, 2].map(|axis| ((p[axis] - hull.low[axis]) * scale) as u32);
    let mut keys: Vec<(u64, u32)> = points.iter().zip(0..).map(|(p, number)| (hilbert_key(grid(p)), number)).collect();
    keys.sort_unstable();
    keys.into_iter().map(|(_, number)| number).collect()
}

/// The cells of a complex in the order in which the curve meets their centroids.
pub fn cells_along_curve<const K: usize>(complex: &SimplicialComplex<K>, positions: &[[f64; 3]]) -> Vec<CellId> {
    let centroid = |cell: &[VertexId; K]| {
        [0, 1, 2].map(|axis| cell.iter().map(|v| positions[v.index()][axis] / K as f64).sum::<f64>())
    };
    let centroids: Vec<[f64; 3]> = complex.cells().iter().map(centroid).collect();
    curve_order(&centroids).into_iter().map(CellId::from).collect()
}

/// How far along the Hilbert curve a grid point comes (Skilling 2004, "Programming the Hilbert curve").
fn hilbert_key(mut x: [u32; 3]) -> u64 {
    const TOP: u32 = 1 << (BITS - 1);
    x = x.map(|value| value.min(2 * TOP - 1));
    let mut bit = TOP;
    while bit > 1 {
        let below = bit - 1;
        for axis in 0..3 {
            if x[axis] & bit != 0 {
                x[0] ^= below;
            } else {
                let exchanged = (x[0] ^ x[axis]) & below;
                x[0] ^= exchanged;
                x[axis] ^= exchanged;
            }
        }
        bit >>= 1;
    }
    x[1] ^= x[0];
    x[2] ^= x[1];
    let mut turned = 0;
    let mut bit = TOP;
    while bit > 1 {
        if x[2] & bit != 0 {
            turned ^= bit - 1;
        }
        bit >>= 1;
    }
    x = x.map(|value| value ^ turned);
    (0..BITS).rev().fold(0, |key, bit| x.iter().fold(key, |key, &value| key << 1 | u64::from(value >> bit & 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On a grid of `2^k` points per axis a Hilbert curve moves to a neighbour at every step.
    #[test]
    fn consecutive_grid_points_are_neighbours() {
        let side = 8;
        let points: Vec<[f64; 3]> =
            (0..side * side * side).map(|k| [k % side, k / side % side, k / side / side].map(f64::from)).collect();
        let order = curve_order(&points);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(0..512), "every point once");
        for pair in order.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|number| points[number as usize]);
            let distance: f64 = (0..3).map(|axis| (a[axis] - b[axis]).abs()).sum();
            assert_eq!(distance, 1.0, "from {a:?} to {b:?}");
        }
    }

    #[test]
    fn degenerate_and_infinite_points_are_ordered_somehow() {
        assert!(curve_order(&[]).is_empty());
        assert_eq!(curve_order(&[[1.0; 3]; 3]), [0, 1, 2]);
        assert_eq!(curve_order(&[[f64::NAN; 3], [f64::INFINITY; 3], [0.0; 3]]).len(), 3);
        assert_eq!(curve_order(&[[f64::MAX; 3], [-f64::MAX; 3]]).len(), 2);
    }
}
