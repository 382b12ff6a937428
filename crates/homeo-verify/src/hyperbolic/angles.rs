//! Dihedral angles of truncated tetrahedra with their derivatives, from minors of the Gram matrix.
//!
//! `G` has 1 on its diagonal and `-cosh l_ij` elsewhere. The angle at the edge `ij` is that of the point
//! `(cofactor of G at kl, sinh l_ij sqrt(-det G))`, where `k`, `l` are the other corners. Derivatives come from the rules for
//! sums and products, not from closed formulas.

use crate::ball::Ball;
use std::ops::{Add, Mul, Neg, Sub};

/// The corners at the edges of a tetrahedron.
pub(super) const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// A value and its derivatives by six variables.
#[derive(Clone, Copy)]
pub(super) struct Jet {
    pub(super) value: Ball,
    pub(super) slopes: [Ball; 6],
}

impl Jet {
    fn constant(value: Ball) -> Self {
        Self { value, slopes: [Ball::ZERO; 6] }
    }

    pub(super) fn variable(value: Ball, number: usize) -> Self {
        let mut slopes = [Ball::ZERO; 6];
        slopes[number] = Ball::ONE;
        Self { value, slopes }
    }

    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        let factor = (value + value).inverse();
        Self { value, slopes: self.slopes.map(|slope| slope * factor) }
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let slope = |k: usize| self.slopes[k] + other.slopes[k];
        Self { value: self.value + other.value, slopes: [0, 1, 2, 3, 4, 5].map(slope) }
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, slopes: self.slopes.map(|slope| -slope) }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule has a sum")]
    fn mul(self, other: Self) -> Self {
        let slope = |k: usize| self.value * other.slopes[k] + self.slopes[k] * other.value;
        Self { value: self.value * other.value, slopes: [0, 1, 2, 3, 4, 5].map(slope) }
    }
}

/// The Gram matrix.
fn gram(cosh: &[Jet; 6]) -> [[Jet; 4]; 4] {
    let mut matrix = [[Jet::constant(Ball::ONE); 4]; 4];
    for (edge, [i, j]) in EDGES.into_iter().enumerate() {
        (matrix[i][j], matrix[j][i]) = (-cosh[edge], -cosh[edge]);
    }
    matrix
}

/// The determinant of the matrix without a row and a column, with its sign.
fn cofactor(matrix: &[[Jet; 4]; 4], row: usize, column: usize) -> Jet {
    let without = |number: usize| [0, 1, 2].map(|k| if k < number { k } else { k + 1 });
    let ([p, q, r], [x, y, z]) = (without(row), without(column));
    let minor = |a: usize, b: usize| matrix[q][a] * matrix[r][b] - matrix[q][b] * matrix[r][a];
    let determinant = matrix[p][x] * minor(y, z) - matrix[p][y] * minor(x, z) + matrix[p][z] * minor(x, y);
    if (row + column).is_multiple_of(2) { determinant } else { -determinant }
}

/// Minus the determinant of the Gram matrix.
pub(super) fn discriminant(cosh: &[Jet; 6]) -> Jet {
    let matrix = gram(cosh);
    let term = |column: usize| matrix[0][column] * cofactor(&matrix, 0, column);
    -(term(0) + term(1) + term(2) + term(3))
}

/// The dihedral angles, for a positive discriminant.
pub(super) fn angles(cosh: &[Jet; 6], discriminant: Jet) -> [Jet; 6] {
    let (matrix, root) = (gram(cosh), discriminant.sqrt());
    let one = Jet::constant(Ball::ONE);
    [0, 1, 2, 3, 4, 5].map(|edge| {
        let [k, l] = EDGES[5 - edge];
        let along = cofactor(&matrix, k, l);
        let across = (cosh[edge] * cosh[edge] - one).sqrt() * root;
        let quarter = Ball::pi() * Ball::exact(0.5);
        let value = quarter - (along.value * across.value.inverse()).arctangent();
        let scale = (along.value * along.value + across.value * across.value).inverse();
        let slope = |m: usize| (along.value * across.slopes[m] - across.value * along.slopes[m]) * scale;
        Jet { value, slopes: [0, 1, 2, 3, 4, 5].map(slope) }
    })
}

/// The tilts of the faces, for a positive discriminant: the rows of the inverse of the Gram matrix are the inward normals of
/// the faces as products with the four vertices, and their sums the products with the covector that is 1 at each.
pub(super) fn tilts(cosh: [Ball; 6]) -> [Ball; 4] {
    let cosh = cosh.map(Jet::constant);
    let (matrix, determinant) = (gram(&cosh), -discriminant(&cosh).value);
    let entry = |row: usize, column: usize| cofactor(&matrix, row, column).value * determinant.inverse();
    [0, 1, 2, 3].map(|face| {
        let sum = (0..4).fold(Ball::ZERO, |sum, column| sum + entry(face, column));
        sum * entry(face, face).sqrt().inverse()
    })
}
