//! First homology: the fundamental group made commutative, as a sum of cyclic groups.
//!
//! The relations of a [`FundamentalGroup`] are the rows of a matrix of integers. Its Smith normal form has the orders
//! of the cyclic groups on its diagonal. Rows with an entry 1 or -1 are used up first, in sparse form, lightest rows
//! first: in triangulations of manifolds they leave next to nothing. What is left is brought to diagonal form with
//! integers of any size.

mod dense;
mod sparse;
#[cfg(test)]
mod tests;

use crate::group::FundamentalGroup;
use crate::triangulation::Triangulation;
use dashu_base::Gcd;
use dashu_int::UBig;
use std::fmt;

/// A finitely generated commutative group: free ones and finite cyclic ones, each order a divisor of the next.
///
/// Printed as Regina does: `2 Z + Z_3`, `Z + 2 Z_2`, and `0` for the group of one element. Equal groups are equal
/// values.
///
/// # Example
/// ```
/// use homeo_manifold::Homology;
/// // Rows are relations of two generators: 2 a + 4 b = 0 and 6 b = 0.
/// let group = Homology::of_relations(2, &[vec![(0, 2), (1, 4)], vec![(1, 6)]]);
/// assert_eq!(group.to_string(), "Z_2 + Z_6");
/// assert_eq!(group.rank(), 0);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Homology {
    rank: usize,
    torsion: Vec<UBig>,
}

impl Homology {
    /// First homology of a triangulation with its vertices cut off; of a triangulation in pieces, the sum of theirs.
    ///
    /// Where all links of vertices are spheres or disks it is that of the manifold; other vertices become boundary.
    /// Cost: a little more than linear for triangulations of manifolds with small groups (a mesh of 100,000
    /// tetrahedra takes less than half a second); where nothing but large relations are left, the cube of their number.
    ///
    /// ```
    /// use homeo_manifold::{Homology, from_signature};
    /// let sister_of_the_figure_eight = from_signature("cPcbbbdxm")?;
    /// assert_eq!(Homology::new(&sister_of_the_figure_eight).to_string(), "Z + Z_5");
    /// # Ok::<(), homeo_manifold::SignatureError>(())
    /// ```
    pub fn new(triangulation: &Triangulation) -> Self {
        Self::of_group(&FundamentalGroup::new(triangulation))
    }

    /// A fundamental group made commutative. Cost as for [`Homology::new`].
    pub fn of_group(group: &FundamentalGroup) -> Self {
        let sign = |is_inverse| if is_inverse { -1 } else { 1 };
        let row = |word: &Vec<crate::group::Letter>| word.iter().map(|l| (l.generator, sign(l.is_inverse))).collect();
        let relations: Vec<_> = group.relations().iter().map(row).collect();
        Self::of_relations(group.generators().len(), &relations)
    }

    /// The group with these generators and relations, each a list of (generator, coefficient); a generator may occur
    /// several times in one.
    ///
    /// # Panics
    /// When a generator is not below `generators`.
    pub fn of_relations(generators: usize, relations: &[Vec<(u32, i64)>]) -> Self {
        let reduced = sparse::without_units(generators, relations);
        let diagonal: Vec<_> = reduced.blocks.into_iter().flat_map(dense::diagonal).collect();
        let rank = reduced.generators - diagonal.len();
        Self { rank, torsion: divisors(diagonal) }
    }

    /// The number of free summands.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// The orders of the finite cyclic summands, each above 1 and a divisor of the next.
    pub fn torsion(&self) -> &[UBig] {
        &self.torsion
    }
}

/// Orders of cyclic groups made into such that each divides the next; those of 1 are left out.
fn divisors(mut orders: Vec<UBig>) -> Vec<UBig> {
    orders.retain(|order| *order > UBig::ONE);
    orders.sort_unstable();
    // A pair (a, b) of orders may be replaced by their greatest common divisor and their least common multiple.
    for i in 0..orders.len() {
        for j in i + 1..orders.len() {
            let common = (&orders[i]).gcd(&orders[j]);
            if common != orders[i] {
                orders[j] = &orders[i] / &common * &orders[j];
                orders[i] = common;
            }
        }
    }
    orders.retain(|order| *order > UBig::ONE);
    orders
}

impl fmt::Display for Homology {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut summands = Vec::new();
        match self.rank {
            0 => {}
            1 => summands.push("Z".to_owned()),
            rank => summands.push(format!("{rank} Z")),
        }
        for equal in self.torsion.chunk_by(|a, b| a == b) {
            let order = &equal[0];
            summands.push(if equal.len() == 1 { format!("Z_{order}") } else { format!("{} Z_{order}", equal.len()) });
        }
        formatter.write_str(&if summands.is_empty() { "0".to_owned() } else { summands.join(" + ") })
    }
}
