//! Proofs that a triangulation has no hyperbolic structure: weights of edges against which no angles can be.
//!
//! Dihedral angles of truncated tetrahedra are positive, and at each corner their sum is less than π, the angle sum of the
//! triangle there. In a structure they add up to 2π round each edge. For weights `z` of the edges and a tetrahedron let
//! `m(z)` be the largest of: 0; the weight of an edge; the sum of those of two opposite edges; half the sum of those of the
//! edges of a face. These are the values of `Σ z θ / π` at the corners of the polytope of all angles that are not negative
//! and have sums at most π at each corner. So
//!
//! ```text
//! 2π Σ_edges z_e = Σ_tetrahedra Σ z θ < π Σ_tetrahedra m(z)       unless z = 0,
//! ```
//!
//! as positive angles with sums below π are an inner point of the polytope. Weights with `2 Σ z_e >= Σ m(z)` therefore prove
//! that there is no structure. *Conversely* such weights exist whenever lengths of a minimizing sequence of the energy are
//! not bounded: they are its direction of recession (proof: `docs/theory/hyperbolic.md`). An edge of degree 1 or 2 with
//! weight 1 is the simplest case.

use crate::skeleton::Skeleton;

/// Weights of the edges that prove that there are no angles.
///
/// # Example
/// ```
/// use homeo_manifold::hyperbolic::Obstruction;
/// use homeo_manifold::{Permutation, Skeleton, Triangulation};
/// // One tetrahedron folded twice: its edges 01 and 23 have degree 1.
/// let folded = |a, b| Permutation::transposition(a, b);
/// let sphere = Triangulation::from_gluings(1, &[(0, 0, 0, folded(0, 1)), (0, 2, 0, folded(2, 3))])?;
/// let skeleton = Skeleton::new(&sphere);
/// assert!(Obstruction::new(&skeleton, vec![1, 0, 0]).is_some());
/// # Ok::<(), homeo_manifold::GluingError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Obstruction {
    weights: Vec<i64>,
}

/// Directions are tried with so many sizes of the largest weight.
const LARGEST_WEIGHT: i32 = 12;

impl Obstruction {
    /// The weights, one for each edge, if they are a proof; decided exactly. Linear cost.
    ///
    /// They are none if one is above 2^30 in absolute value.
    pub fn new(skeleton: &Skeleton, weights: Vec<i64>) -> Option<Self> {
        let are_usable = weights.len() == skeleton.edges().len() && weights.iter().all(|z| z.abs() <= 1 << 30);
        if !are_usable || weights.iter().all(|&z| z == 0) {
            return None;
        }
        let tetrahedra = tetrahedra_of(skeleton);
        let bound: i64 = (0..tetrahedra).map(|t| doubled_bound(skeleton, t, &weights)).sum();
        (4 * weights.iter().sum::<i64>() >= bound).then_some(Self { weights })
    }

    /// Searches among the single edges.
    pub fn of_one_edge(skeleton: &Skeleton) -> Option<(usize, Self)> {
        let low_degrees = skeleton.edges().iter().enumerate().filter(|(_, edge)| edge.corners.len() < 3);
        low_degrees.map(|(number, _)| number).find_map(|number| {
            let weights = (0..skeleton.edges().len()).map(|edge| i64::from(edge == number)).collect();
            Some((number, Self::new(skeleton, weights)?))
        })
    }

    /// Searches among small multiples of a direction, rounded: lengths that grow without bound show such a direction.
    ///
    /// ```
    /// # use homeo_manifold::{Permutation, Skeleton, Triangulation};
    /// use homeo_manifold::hyperbolic::Obstruction;
    /// # let folded = |a, b| Permutation::transposition(a, b);
    /// # let sphere = Triangulation::from_gluings(1, &[(0, 0, 0, folded(0, 1)), (0, 2, 0, folded(2, 3))])?;
    /// let found = Obstruction::along(&Skeleton::new(&sphere), &[9.5, 0.2, 0.1]).unwrap();
    /// assert_eq!(found.weights(), [1, 0, 0]);
    /// # Ok::<(), homeo_manifold::GluingError>(())
    /// ```
    pub fn along(skeleton: &Skeleton, direction: &[f64]) -> Option<Self> {
        let largest = direction.iter().copied().fold(0.0, f64::max);
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        let rounded = |size: i32| {
            direction.iter().map(|x| (x / largest * f64::from(size)).round().max(0.0) as i64).collect::<Vec<_>>()
        };
        (1..=LARGEST_WEIGHT).find_map(|size| Self::new(skeleton, rounded(size)))
    }

    /// The weights of the edges.
    pub fn weights(&self) -> &[i64] {
        &self.weights
    }
}

/// The number of tetrahedra: each has six edges.
fn tetrahedra_of(skeleton: &Skeleton) -> u32 {
    let corners: usize = skeleton.edges().iter().map(|edge| edge.corners.len()).sum();
    (corners / 6) as u32
}

/// Twice `m(z)` of a tetrahedron.
fn doubled_bound(skeleton: &Skeleton, tetrahedron: u32, weights: &[i64]) -> i64 {
    let z = skeleton.edges_of(tetrahedron).map(|edge| weights[edge as usize]);
    let single = z.into_iter().map(|z| 2 * z);
    let opposite = (0..3).map(|edge| 2 * (z[edge] + z[5 - edge]));
    let faces =
        [[0, 1, 3], [0, 2, 4], [1, 2, 5], [3, 4, 5]].into_iter().map(|face| face.map(|edge| z[edge]).iter().sum());
    single.chain(opposite).chain(faces).fold(0, i64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperbolic::testing;
    use proptest::prelude::*;

    proptest! {
        /// The bound is the largest value on the polytope: no angles in it exceed it.
        #[test]
        fn angles_stay_below_the_bound(z in proptest::array::uniform6(-4_i64..9), raw in proptest::array::uniform6(0.0..1.0_f64)) {
            let corners = [[0, 1, 2], [0, 3, 4], [1, 3, 5], [2, 4, 5]];
            let largest = corners.map(|at| at.map(|edge| raw[edge]).iter().sum::<f64>()).into_iter().fold(0.0, f64::max);
            let skeleton = Skeleton::new(&crate::Triangulation::new(1));
            let value: f64 = (0..6).map(|edge| z[edge] as f64 * raw[edge] / largest).sum();
            prop_assert!(2.0 * value <= doubled_bound(&skeleton, 0, &z) as f64 + 1e-9);
        }
    }

    #[test]
    fn triangulations_with_a_structure_have_no_obstruction() {
        let (mut tried, mut free) = (0, 0);
        for entry in testing::census().into_iter().filter(|entry| entry.geometry.is_some()) {
            let skeleton = Skeleton::new(&entry.triangulation);
            let edges = skeleton.edges().len();
            for number in 0..1_i64 << (4 * edges).min(12) {
                let weights = (0..edges).map(|edge| (number >> (4 * edge) & 15) - 5).collect();
                assert_eq!(Obstruction::new(&skeleton, weights), None, "{}", entry.name);
                tried += 1;
            }
            free += 1;
        }
        assert!(tried > 1500 && free >= 10, "{tried} {free}");
    }
}
