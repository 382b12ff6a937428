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

use dashu_base::{Gcd, UnsignedAbs};
use dashu_int::{IBig, UBig};

use super::program::largest_sum;
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

/// Larger triangulations are not searched: the program has 7 rows for each tetrahedron.
const MOST_TETRAHEDRA: usize = 40;
/// The edges of each face.
const FACES: [[usize; 3]; 4] = [[0, 1, 3], [0, 2, 4], [1, 2, 5], [3, 4, 5]];
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

    /// Searches among all weights that are not negative, by a linear program in integers.
    ///
    /// # Guarantee
    /// It finds weights if there are any without a negative one, and there are if lengths of a minimizing sequence of the energy
    /// are not bounded; unless the ones it comes upon have no common divisor that brings them below 2^30. Beyond 40 tetrahedra
    /// it does not search.
    ///
    /// # Complexity
    /// That of the simplex method with `7 #T` rows: a millisecond for ten tetrahedra, some tens for 40 where weights are found.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::Obstruction;
    /// use homeo_manifold::{Skeleton, from_signature};
    /// // One of the traps: a length grows without bound while curvatures tend to 0.
    /// let trap = Obstruction::search(&Skeleton::new(&from_signature("dLQacccjcog")?)).unwrap();
    /// assert_eq!(trap.weights(), [0, 1]);
    /// assert!(Obstruction::search(&Skeleton::new(&from_signature("cPcbbbihq")?)).is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn search(skeleton: &Skeleton) -> Option<Self> {
        let (edges, tetrahedra) = (skeleton.edges().len(), tetrahedra_of(skeleton) as usize);
        if tetrahedra > MOST_TETRAHEDRA {
            return None;
        }
        // The weights, then twice the bound of each tetrahedron.
        let (width, mut rows) = (edges + tetrahedra + 1, Vec::with_capacity(7 * tetrahedra + 2));
        for t in 0..tetrahedra {
            let classes = skeleton.edges_of(t as u32).map(|edge| edge as usize);
            let mut row = |corner: &[usize], size: i64| {
                let mut row = vec![0; width];
                corner.iter().for_each(|&edge| row[classes[edge]] += size);
                row[edges + t] = -1;
                rows.push(row);
            };
            (0..3).for_each(|edge| row(&[edge, 5 - edge], 2));
            FACES.iter().for_each(|face| row(face, 1));
        }
        let sums = |of_weights: i64, of_bounds: i64, bound: i64| {
            let column = |column: usize| if column < edges { of_weights } else { of_bounds };
            (0..width - 1).map(column).chain([bound]).collect::<Vec<i64>>()
        };
        rows.extend([sums(-4, 1, 0), sums(1, 0, 1)]);
        let weights = largest_sum(edges, rows)?;
        let divisor = weights.iter().fold(UBig::ZERO, |divisor, weight| {
            if *weight == IBig::ZERO { divisor } else { divisor.gcd(weight.unsigned_abs()) }
        });
        let weights: Option<Vec<i64>> =
            weights.into_iter().map(|weight| i64::try_from(weight / &divisor).ok()).collect();
        Self::new(skeleton, weights?)
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
    let faces = FACES.into_iter().map(|face| face.map(|edge| z[edge]).iter().sum());
    single.chain(opposite).chain(faces).fold(0, i64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperbolic::{NoMetric, Structure, testing};
    use crate::simplify::flips;
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

    /// Over all triangulations of three tetrahedra, and those with one more that are near them.
    #[test]
    fn the_program_finds_weights_exactly_where_there_is_no_structure() {
        let (mut with, mut without) = (0, 0);
        for entry in testing::census() {
            let faces: Vec<_> = entry.triangulation.faces().collect();
            for triangulation in
                [vec![entry.triangulation.clone()], flips(&entry.triangulation, &faces).unwrap()].concat()
            {
                let skeleton = Skeleton::new(&triangulation);
                match (Structure::find(&triangulation, &skeleton), Obstruction::search(&skeleton)) {
                    (Ok(_), Some(found)) => panic!("{}: {:?}", entry.name, found.weights()),
                    (Ok(_), None) => with += 1,
                    (Err(refusal), Some(_)) => {
                        assert!(refusal.is_proved(), "{}: {refusal}", entry.name);
                        without += 1;
                    }
                    // The minimum of the energy is at a flat tetrahedron.
                    (Err(refusal), None) => assert!(matches!(refusal, NoMetric::Degenerate { .. }), "{refusal}"),
                }
            }
        }
        assert!(with >= 90 && without >= 60, "{with} {without}");
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
