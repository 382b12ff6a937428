//! The equations of a structure: round each edge the dihedral angles add up to 2π.

use super::enclosure::{Enclosure, Real};
use super::tetrahedron::Tetrahedron;
use crate::skeleton::Skeleton;

/// Which unknown each edge of each tetrahedron has.
#[derive(Debug, Clone)]
pub(super) struct Equations {
    classes: Vec<[u32; 6]>,
    edges: usize,
}

/// Excess of the angles at each edge over 2π, and its derivatives, row by row.
pub(super) struct Values<R> {
    pub(super) excess: Vec<R>,
    pub(super) slopes: Vec<R>,
    /// The first tetrahedron that is not proved to be one, and its number.
    pub(super) flat: Option<u32>,
}

impl Equations {
    pub(super) fn new(skeleton: &Skeleton) -> Self {
        let corners: usize = skeleton.edges().iter().map(|edge| edge.corners.len()).sum();
        let classes = (0..(corners / 6) as u32).map(|tetrahedron| skeleton.edges_of(tetrahedron)).collect();
        Self { classes, edges: skeleton.edges().len() }
    }

    pub(super) fn edges(&self) -> usize {
        self.edges
    }

    /// The tetrahedra, from the hyperbolic cosines of the lengths of the edges.
    pub(super) fn tetrahedra<R: Real>(&self, cosh: &[R]) -> impl Iterator<Item = Tetrahedron<R>> {
        self.classes.iter().map(|classes| Tetrahedron::new(classes.map(|class| cosh[class as usize])))
    }

    /// The extended equations; slopes are by lengths, and 0 for tetrahedra that are flat.
    pub(super) fn near(&self, lengths: &[f64], values: &mut Values<f64>) {
        values.excess.fill(-std::f64::consts::TAU);
        values.slopes.fill(0.0);
        values.flat = None;
        for (number, classes) in self.classes.iter().enumerate() {
            let tetrahedron = Tetrahedron::new(classes.map(|class| lengths[class as usize].cosh()));
            let angles = tetrahedron.extended_angles();
            classes.iter().zip(angles).for_each(|(&class, angle)| values.excess[class as usize] += angle);
            if tetrahedron.discriminant() > 0.0 {
                self.add_slopes(classes, &tetrahedron.jacobian(), &mut values.slopes);
            } else {
                values.flat = values.flat.or(Some(number as u32));
            }
        }
    }

    /// Enclosures, with slopes by the hyperbolic cosines of the lengths; everything where a tetrahedron is not proved to be
    /// one.
    pub(super) fn sure(&self, cosh: &[Enclosure]) -> Values<Enclosure> {
        let mut values = self.zero(-Enclosure::pi() * Enclosure::exact(2.0), Enclosure::exact(0.0));
        for (number, (classes, tetrahedron)) in self.classes.iter().zip(self.tetrahedra(cosh)).enumerate() {
            if !tetrahedron.discriminant().is_positive() {
                values.flat = values.flat.or(Some(number as u32));
            }
            for (&class, angle) in classes.iter().zip(tetrahedron.angles()) {
                values.excess[class as usize] = values.excess[class as usize] + angle;
            }
            let (sinh, mut slopes) = (tetrahedron.sinh(), tetrahedron.jacobian());
            slopes.iter_mut().for_each(|row| row.iter_mut().zip(sinh).for_each(|(slope, sinh)| *slope = *slope / sinh));
            self.add_slopes(classes, &slopes, &mut values.slopes);
        }
        values
    }

    /// Values of the right size.
    pub(super) fn zero<R: Real>(&self, excess: R, slope: R) -> Values<R> {
        Values { excess: vec![excess; self.edges], slopes: vec![slope; self.edges * self.edges], flat: None }
    }

    fn add_slopes<R: Real>(&self, classes: &[u32; 6], slopes: &[[R; 6]; 6], sum: &mut [R]) {
        for (&row, slopes) in classes.iter().zip(slopes) {
            for (&column, &slope) in classes.iter().zip(slopes) {
                let entry = &mut sum[row as usize * self.edges + column as usize];
                *entry = *entry + slope;
            }
        }
    }
}

/// The largest absolute value.
pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| value.abs().max(largest))
}
