//! Truncated hyperbolic tetrahedra from the lengths of their edges.
//!
//! Four planes cut the corners off; their outward unit normals `v_0 ... v_3` in Minkowski space have the products
//! `⟨v_i, v_i⟩ = 1` and `⟨v_i, v_j⟩ = -c_ij`, where `c_ij = cosh l_ij` and `l_ij > 0` is the distance of the planes `i` and
//! `j`: the length of the edge `ij`. With the Gram matrix `G` of these products, and `k`, `l` the other two corners,
//!
//! ```text
//! D_ijk = c_ij² + c_ik² + c_jk² + 2 c_ij c_ik c_jk - 1       (minus a principal minor of G; always positive)
//! N_ij  = c_ij (c_ik c_jl + c_il c_jk) + c_ik c_il + c_jk c_jl - (c_ij² - 1) c_kl     (a cofactor)
//! Δ     = -det G
//! cos θ_ij = N_ij / sqrt(D_ijk D_ijl),   sin θ_ij = sinh l_ij sqrt(Δ) / sqrt(D_ijk D_ijl).
//! ```
//!
//! *Theorem.* Six positive lengths are those of a truncated tetrahedron if and only if `Δ > 0`; it is then unique up to
//! isometry and its dihedral angles are `θ_ij`. Proof, and the agreement with the triangle and hexagon laws of
//! Yin 2010, section 4.3.1 (whose hexagon law (4.3) is right and whose Möbius condition in 4.4.1 should read
//! `ad - bc = 1`): `docs/theory/hyperbolic.md`.

use super::enclosure::Real;
use crate::skeleton::{EDGES, edge_between};

/// The quantities that angles and their derivatives are made of.
///
/// # Example
/// ```
/// use homeo_manifold::hyperbolic::Tetrahedron;
/// // All edges of one length: cos θ = c / (2 c - 1).
/// let regular = Tetrahedron::new([1.5_f64; 6]);
/// assert!(regular.discriminant() > 0.0);
/// assert!((regular.angles()[3].cos() - 0.75).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Tetrahedron<R> {
    sinh: [R; 6],
    /// `D` of the face opposite each corner.
    faces: [R; 4],
    cofactors: [R; 6],
    discriminant: R,
}

impl<R: Real> Tetrahedron<R> {
    /// From the hyperbolic cosines of the lengths, each above 1, in the order of [`EDGES`].
    pub fn new(cosh: [R; 6]) -> Self {
        let one = R::from_f64(1.0);
        let squares = cosh.map(|c| c * c);
        let face = |f: u8| {
            let [a, b, c] = face_edges(f);
            let triple = cosh[a] * cosh[b] * cosh[c];
            squares[a] + squares[b] + squares[c] + triple + triple - one
        };
        let cofactor = |edge: usize| {
            let (c, [ik, il, jk, jl]) = (cosh, neighbours(edge));
            c[edge] * (c[ik] * c[jl] + c[il] * c[jk]) + c[ik] * c[il] + c[jk] * c[jl]
                - (squares[edge] - one) * c[5 - edge]
        };
        Self {
            sinh: squares.map(|square| (square - one).sqrt()),
            faces: [0, 1, 2, 3].map(face),
            cofactors: [0, 1, 2, 3, 4, 5].map(cofactor),
            discriminant: discriminant(cosh, squares),
        }
    }

    /// `Δ`: positive exactly if the lengths belong to a truncated tetrahedron.
    pub fn discriminant(&self) -> R {
        self.discriminant
    }

    /// The hyperbolic sines of the lengths.
    pub fn sinh(&self) -> [R; 6] {
        self.sinh
    }

    /// The dihedral angles in radians, where `Δ` is positive.
    pub fn angles(&self) -> [R; 6] {
        let root = self.discriminant.sqrt();
        [0, 1, 2, 3, 4, 5].map(|edge| R::angle(self.cofactors[edge], self.sinh[edge] * root))
    }

    /// Cosine and sine of each dihedral angle, where `Δ` is positive.
    pub(super) fn directions(&self) -> [[R; 2]; 6] {
        let root = self.discriminant.sqrt();
        [0, 1, 2, 3, 4, 5].map(|edge| {
            let [k, l] = EDGES[5 - edge].map(usize::from);
            let size = (self.faces[k] * self.faces[l]).sqrt();
            [self.cofactors[edge] / size, self.sinh[edge] * root / size]
        })
    }

    /// The tilts of the faces opposite the corners, where `Δ` is positive.
    ///
    /// With the covector `m` that is 1 on all four normals `v_i`, and `u` the unit normal of the face that points inwards, the
    /// tilt is `⟨m, u⟩`; opposite corner `k` it is `(D - sum of N over the edges of the face) / sqrt(Δ D)`.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::Tetrahedron;
    /// // All edges of one length: sqrt((1 + c) / ((2 c - 1) (3 c - 1))), and negative.
    /// let tilt = Tetrahedron::new([1.5_f64; 6]).tilts()[2];
    /// assert!((tilt + (2.5_f64 / (2.0 * 3.5)).sqrt()).abs() < 1e-15);
    /// ```
    pub fn tilts(&self) -> [R; 4] {
        [0, 1, 2, 3].map(|face| {
            let size = self.faces[usize::from(face)];
            let [a, b, c] = face_edges(face).map(|edge| self.cofactors[edge]);
            (size - a - b - c) / (size * self.discriminant).sqrt()
        })
    }

    /// The root of minus the determinant of the Gram matrix of the angles: `Δ sqrt(Δ) / sqrt(D_0 D_1 D_2 D_3)`.
    pub(super) fn angle_root(&self) -> R {
        let [a, b, c, d] = self.faces;
        self.discriminant * self.discriminant.sqrt() / (a * b * c * d).sqrt()
    }

    /// The derivatives of the angles (rows) by the lengths, where `Δ` is positive; symmetric by Schläfli's formula, and
    /// positive definite.
    ///
    /// ```text
    /// ∂θ_ij/∂l_kl = sinh l_ij sinh l_kl / sqrt(Δ)
    /// ∂θ_ij/∂l_ik = -sinh l_ij sinh l_ik N_jk / (D_ijk sqrt(Δ))
    /// ∂θ_ij/∂l_ij = (N_ik N_jl + N_il N_jk + N_ij (N_ik N_jk / D_ijk + N_il N_jl / D_ijl)) / (Δ sqrt(Δ))
    /// ```
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::Tetrahedron;
    /// let lengths = [0.5, 0.6, 0.7, 0.8, 0.9, 1.0_f64];
    /// let angles = |lengths: [f64; 6]| Tetrahedron::new(lengths.map(f64::cosh)).angles();
    /// let mut longer = lengths;
    /// longer[2] += 1e-7;
    /// let slope = (angles(longer)[4] - angles(lengths)[4]) / 1e-7;
    /// assert!((Tetrahedron::new(lengths.map(f64::cosh)).jacobian()[4][2] - slope).abs() < 1e-6);
    /// ```
    pub fn jacobian(&self) -> [[R; 6]; 6] {
        let (s, n) = (self.sinh, self.cofactors);
        let root = self.discriminant.sqrt();
        let mut jacobian = [[R::from_f64(0.0); 6]; 6];
        for edge in 0..6 {
            jacobian[edge][5 - edge] = s[edge] * s[5 - edge] / root;
            let [ik, il, jk, jl] = neighbours(edge);
            let [k, l] = EDGES[5 - edge].map(usize::from);
            let on_faces = n[ik] * n[jk] / self.faces[l] + n[il] * n[jl] / self.faces[k];
            jacobian[edge][edge] = (n[ik] * n[jl] + n[il] * n[jk] + n[edge] * on_faces) / (self.discriminant * root);
        }
        for face in 0..4 {
            let [a, b, c] = face_edges(face);
            for (a, b, c) in [(a, b, c), (b, c, a), (c, a, b)] {
                let slope = -(s[a] * s[b] * n[c] / (self.faces[usize::from(face)] * root));
                (jacobian[a][b], jacobian[b][a]) = (slope, slope);
            }
        }
        jacobian
    }
}

impl Tetrahedron<f64> {
    /// The angles where `Δ` is positive, and their limits where it is not: two opposite edges have π, the others 0.
    ///
    /// With these the energy of a triangulation is convex on all positive lengths (Luo and Yang), and its gradient is
    /// continuous: what a line search meets outside tells how to come back.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::Tetrahedron;
    /// // One pair of opposite edges much too long.
    /// let flat = Tetrahedron::new([9.0, 1.2, 1.2, 1.2, 1.2, 9.0]);
    /// assert!(flat.discriminant() < 0.0);
    /// let pi = std::f64::consts::PI;
    /// assert_eq!(flat.extended_angles(), [pi, 0.0, 0.0, 0.0, 0.0, pi]);
    /// ```
    pub fn extended_angles(&self) -> [f64; 6] {
        if self.discriminant > 0.0 {
            return self.angles();
        }
        self.cofactors.map(|cofactor| if cofactor < 0.0 { std::f64::consts::PI } else { 0.0 })
    }
}

/// `-det G`.
fn discriminant<R: Real>(cosh: [R; 6], squares: [R; 6]) -> R {
    let [p, q, r] = [0, 1, 2].map(|edge| cosh[edge] * cosh[5 - edge]);
    let double = |x: R| x + x;
    let mut sum = -R::from_f64(1.0);
    for square in squares {
        sum = sum + square;
    }
    for face in 0..4 {
        let [a, b, c] = face_edges(face);
        sum = sum + double(cosh[a] * cosh[b] * cosh[c]);
    }
    sum - (p - q) * (p - q) - r * r + double(r * (p + q))
}

/// The edges of the face opposite a corner.
fn face_edges(face: u8) -> [usize; 3] {
    let [a, b, c] = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]][usize::from(face)];
    [edge_between(a, b), edge_between(b, c), edge_between(c, a)]
}

/// The edges `ik`, `il`, `jk`, `jl` that meet the edge `ij`, where `kl` is the opposite one in the order of [`EDGES`].
fn neighbours(edge: usize) -> [usize; 4] {
    let ([i, j], [k, l]) = (EDGES[edge], EDGES[5 - edge]);
    [edge_between(i, k), edge_between(i, l), edge_between(j, k), edge_between(j, l)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperbolic::Enclosure;
    use proptest::prelude::*;

    /// The angles by the laws of hexagons and triangles, at both ends of each edge.
    fn by_cosine_laws(lengths: [f64; 6]) -> Option<[[f64; 2]; 6]> {
        let length = |a: u8, b: u8| lengths[edge_between(a, b)];
        // The side at corner i of the hexagon of the face i, j, k.
        let side = |i: u8, j: u8, k: u8| {
            let (a, b, c) = (length(i, j), length(i, k), length(j, k));
            ((c.cosh() + a.cosh() * b.cosh()) / (a.sinh() * b.sinh())).acosh()
        };
        let at = |i: u8, j: u8, k: u8, l: u8| {
            let (a, b, c) = (side(i, j, k), side(i, j, l), side(i, k, l));
            let is_triangle = a + b > c && b + c > a && c + a > b;
            let cosine = (a.cosh() * b.cosh() - c.cosh()) / (a.sinh() * b.sinh());
            is_triangle.then(|| cosine.acos())
        };
        let mut angles = [[0.0; 2]; 6];
        for edge in 0..6 {
            let ([i, j], [k, l]) = (EDGES[edge], EDGES[5 - edge]);
            angles[edge] = [at(i, j, k, l)?, at(j, i, k, l)?];
        }
        Some(angles)
    }

    fn lengths() -> impl Strategy<Value = [f64; 6]> {
        proptest::array::uniform6(0.2..4.0)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(800))]

        #[test]
        fn angles_are_those_of_the_cosine_laws_and_exist_where_these_do(lengths in lengths()) {
            let tetrahedron = Tetrahedron::new(lengths.map(f64::cosh));
            // Too near the border rounding decides.
            prop_assume!(tetrahedron.discriminant().abs() > 1e-6 * tetrahedron.faces[0]);
            let expected = by_cosine_laws(lengths);
            prop_assert_eq!(expected.is_some(), tetrahedron.discriminant() > 0.0);
            for (found, ends) in tetrahedron.angles().into_iter().zip(expected.unwrap_or_default()) {
                for end in ends {
                    prop_assert!(tetrahedron.discriminant() < 0.0 || (found - end).abs() < 1e-6, "{found} {end}");
                }
            }
        }

        #[test]
        fn enclosures_hold_angles_and_slopes(lengths in lengths()) {
            let cosh = lengths.map(f64::cosh);
            let (near, sure) = (Tetrahedron::new(cosh), Tetrahedron::new(cosh.map(Enclosure::exact)));
            prop_assume!(sure.discriminant().is_positive());
            let (slopes, angles) = (near.jacobian(), near.angles());
            for edge in 0..6 {
                let angle = sure.angles()[edge];
                prop_assert!((angle.middle() - angles[edge]).abs() <= angle.width() + 1e-9);
                for other in 0..6 {
                    let slope = sure.jacobian()[edge][other];
                    prop_assert!((slope.middle() - slopes[edge][other]).abs() <= slope.width().max(1e-9));
                }
            }
        }

        #[test]
        fn slopes_are_differences(lengths in lengths()) {
            let tetrahedron = Tetrahedron::new(lengths.map(f64::cosh));
            prop_assume!(tetrahedron.discriminant() > 0.05 * tetrahedron.faces[0]);
            let jacobian = tetrahedron.jacobian();
            for by in 0..6 {
                let moved = |step: f64| {
                    let mut moved = lengths;
                    moved[by] += step;
                    Tetrahedron::new(moved.map(f64::cosh)).angles()
                };
                let (after, before) = (moved(1e-5), moved(-1e-5));
                for edge in 0..6 {
                    let difference = (after[edge] - before[edge]) / 2e-5;
                    prop_assert!((jacobian[edge][by] - difference).abs() < 1e-5 * (1.0 + difference.abs()));
                    prop_assert!((jacobian[edge][by] - jacobian[by][edge]).abs() < 1e-9 * (1.0 + difference.abs()));
                }
            }
        }
    }

    #[test]
    fn flat_tetrahedra_have_two_opposite_straight_angles() {
        let (mut flat, mut round) = (0, 0);
        for k in 0..4096_u32 {
            let digit = |place: u32| 0.3 + 1.1 * f64::from(k / 4_u32.pow(place) % 4);
            let tetrahedron = Tetrahedron::new([0, 1, 2, 3, 4, 5].map(|place| digit(place).cosh()));
            if tetrahedron.discriminant() > -1e-9 {
                round += 1;
                continue;
            }
            let angles = tetrahedron.extended_angles();
            let straight: Vec<usize> = (0..6).filter(|&edge| angles[edge] > 3.0).collect();
            assert_eq!(straight.len(), 2, "{angles:?}");
            assert_eq!(straight[0] + straight[1], 5);
            flat += 1;
        }
        assert!(flat > 100 && round > 100, "{flat} {round}");
    }
}
