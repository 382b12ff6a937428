//! Rules Y1-Y8: a hyperbolic structure with geodesic boundary on glued tetrahedra.
//!
//! *Theorem.* Let the hyperbolic cosines of lengths be such that the Gram matrix of every tetrahedron has a negative
//! determinant, and let the dihedral angles round each edge add up to 2π. Then the truncated tetrahedra with these lengths fit
//! together to a complete hyperbolic structure with totally geodesic boundary. Krawczyk's test shows that such numbers are in
//! the box. If tilts add up to less than zero at every face, the triangulation is the canonical decomposition of the manifold.
//! (Proofs: `docs/theory/hyperbolic.md`.)

mod angles;
mod gluing;

use crate::ball::Ball;
use crate::map_file::HyperbolicData;
use crate::verdict::{Checked, check, decidable, refuted};
use angles::{Jet, angles, discriminant, tilts};
use gluing::Gluing;

/// More edges are beyond this checker: its time grows with the cube.
const MOST_EDGES: usize = 1000;

/// Applies the rules and counts what was checked.
pub(crate) fn check_hyperbolic(
    data: &HyperbolicData,
    vertices: usize,
    is_canonical: bool,
) -> Checked<Vec<(&'static str, u64)>> {
    let gluing = Gluing::new(&data.gluings)?;
    let edges = gluing.edges()?;
    gluing.check_orientation()?;
    gluing.check_links(&edges, vertices)?;
    let count = edges.count;
    let has_all = data.cosh_lengths.len() == count;
    check(has_all, "Y5", &format!("there are {count} edges, not as many lengths"), &[], &[])?;
    let radius = data.radius;
    check(radius.is_finite() && radius > 0.0, "Y5", "the radius is not a positive number", &[], &[])?;
    for (edge, &cosh) in data.cosh_lengths.iter().enumerate() {
        let is_length = cosh.is_finite() && (Ball { middle: cosh, radius } - Ball::ONE).is_positive();
        check(is_length, "Y5", &format!("the box of edge {edge} holds no lengths only"), &[], &[])?;
    }
    decidable(count <= MOST_EDGES, "there are more than 1000 edges", "a triangulation with fewer tetrahedra")?;
    let system = System { of: &edges.of, centre: &data.cosh_lengths, radius };
    system.check_sums()?;
    let mut checked = vec![
        ("tetrahedra, glued face to face and oriented (rules Y1, Y3)", (data.gluings.len() / 4) as u64),
        ("edges not glued to themselves end for end (rule Y2)", count as u64),
        ("vertices with links of negative Euler characteristic (rule Y4)", vertices as u64),
        ("tetrahedra that are truncated ones on the whole box (rules Y5, Y6)", (data.gluings.len() / 4) as u64),
        ("angle sums round edges that are 2π at one point of the box (rule Y7)", count as u64),
    ];
    if is_canonical {
        system.check_tilts(&gluing)?;
        checked.push(("faces whose tilts add up to less than zero (rule Y8)", (data.gluings.len() / 2) as u64));
    }
    Ok(checked)
}

/// The equations of the angle sums.
struct System<'a> {
    /// The edges of the tetrahedra.
    of: &'a [[u32; 6]],
    centre: &'a [f64],
    radius: f64,
}

impl System<'_> {
    /// Angle sums less 2π with their slopes; rule Y6 on the way.
    fn sums(&self, radius: f64) -> Checked<(Vec<Ball>, Vec<Vec<Ball>>)> {
        let count = self.centre.len();
        let (mut sums, mut slopes) = (vec![-(Ball::pi() + Ball::pi()); count], vec![vec![Ball::ZERO; count]; count]);
        for (t, classes) in self.of.iter().enumerate() {
            let variable = |k: usize| Jet::variable(Ball { middle: self.centre[classes[k] as usize], radius }, k);
            let cosh = [0, 1, 2, 3, 4, 5].map(variable);
            let discriminant = discriminant(&cosh);
            let is_flat = discriminant.value.is_negative();
            check(!is_flat, "Y6", "lengths in the box belong to no truncated tetrahedron", &[t], &[])?;
            let message = format!("rule Y6: whether tetrahedron {t} is one on the whole box is not known");
            decidable(discriminant.value.is_positive(), &message, "better lengths, and a smaller radius")?;
            for (row, angle) in angles(&cosh, discriminant).into_iter().enumerate() {
                let row = classes[row] as usize;
                sums[row] = sums[row] + angle.value;
                for (column, slope) in angle.slopes.into_iter().enumerate() {
                    let entry = &mut slopes[row][classes[column] as usize];
                    *entry = *entry + slope;
                }
            }
        }
        Ok((sums, slopes))
    }

    /// Rule Y8.
    fn check_tilts(&self, gluing: &Gluing) -> Checked {
        let of = |classes: &[u32; 6]| {
            tilts(classes.map(|class| Ball { middle: self.centre[class as usize], radius: self.radius }))
        };
        let tilts: Vec<[Ball; 4]> = self.of.iter().map(of).collect();
        for (number, (face, other)) in gluing.faces().enumerate() {
            let sum = tilts[face.0][face.1] + tilts[other.0][other.1];
            let message = format!("the tilts at face {} add up to more than zero", number % 4);
            check(!sum.is_positive(), "Y8", &message, &[face.0, other.0], &[])?;
            let message = format!("rule Y8: the sign of the sum of tilts at face {} is not known", number % 4);
            decidable(sum.is_negative(), &message, "better lengths, or the target geodesic-boundary")?;
        }
        Ok(())
    }

    /// Rule Y7.
    fn check_sums(&self) -> Checked {
        let (wide, slopes) = self.sums(self.radius)?;
        for (edge, sum) in wide.iter().enumerate() {
            if sum.is_positive() || sum.is_negative() {
                let tetrahedra: Vec<usize> =
                    (0..self.of.len()).filter(|&t| self.of[t].contains(&(edge as u32))).collect();
                let message = format!("the angles round edge {edge} add up to 2π nowhere in the box");
                return Err(refuted("Y7", message, &tetrahedra, &[]));
            }
        }
        let (sums, at_centre) = self.sums(0.0)?;
        let remedy = "better lengths, or another radius";
        let inverse = inverse(at_centre.iter().map(|row| row.iter().map(|x| x.middle).collect()).collect());
        let Some(inverse) = inverse else {
            return decidable(false, "rule Y7: the slopes of the angle sums cannot be inverted", remedy);
        };
        let count = self.centre.len();
        let offset = Ball { middle: 0.0, radius: self.radius };
        for (row, weights) in inverse.iter().enumerate() {
            let total = |terms: &mut dyn Iterator<Item = Ball>| terms.fold(Ball::ZERO, |sum, term| sum + term);
            let weights: Vec<Ball> = weights.iter().map(|&x| Ball::exact(x)).collect();
            // K - x = -C F(x) + (I - C J) (X - x), one row.
            let mut image = -total(&mut weights.iter().zip(&sums).map(|(&c, &f)| c * f));
            for column in 0..count {
                let product = total(&mut weights.iter().enumerate().map(|(k, &c)| c * slopes[k][column]));
                let unit = if row == column { Ball::ONE } else { Ball::ZERO };
                image = image + (unit - product) * offset;
            }
            let is_inside =
                (image + Ball::exact(self.radius)).is_positive() && (Ball::exact(self.radius) - image).is_positive();
            let message = format!("rule Y7: Krawczyk's operator leaves the box in the direction of edge {row}");
            decidable(is_inside, &message, remedy)?;
        }
        Ok(())
    }
}

/// The inverse of a matrix, nearly, by elimination with pivots; any matrix would do for the proof.
fn inverse(mut matrix: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    let count = matrix.len();
    let unit = |row: usize| (0..count).map(|column| f64::from(u8::from(row == column))).collect();
    let mut inverse: Vec<Vec<f64>> = (0..count).map(unit).collect();
    for column in 0..count {
        let pivot = (column..count).max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))?;
        matrix.swap(column, pivot);
        inverse.swap(column, pivot);
        let scale = 1.0 / matrix[column][column];
        if !scale.is_finite() {
            return None;
        }
        matrix[column].iter_mut().chain(&mut inverse[column]).for_each(|x| *x *= scale);
        let (pivot_row, pivot_inverse) = (matrix[column].clone(), inverse[column].clone());
        for row in (0..count).filter(|&row| row != column) {
            let factor = matrix[row][column];
            matrix[row].iter_mut().zip(&pivot_row).for_each(|(x, p)| *x -= factor * p);
            inverse[row].iter_mut().zip(&pivot_inverse).for_each(|(x, p)| *x -= factor * p);
        }
    }
    Some(inverse)
}
