//! Rounded positions of exact places, and what rounding does to triangles.

use homeo_core::number::{Interval, Lazy, Rational, Scalar};
use homeo_core::predicate::Sign;

use super::Cell;
use super::polygon::Place;
use crate::map::{Shell, ShellSurface};

type Point = [f64; 3];

/// Weights that may be zero are smaller.
const SMALL: f64 = 1e-9;

/// Rounds places of a shell's surfaces.
pub(super) struct Rounding {
    accuracy: f64,
}

impl Rounding {
    /// To be as near to the exact positions as this part of the size of the source's coordinates.
    pub fn new(shell: &Shell, accuracy: f64) -> Self {
        let coordinates = shell.source().positions().as_flattened().iter();
        Self { accuracy: accuracy * coordinates.fold(0.0, |size: f64, x| size.max(x.abs())) }
    }

    /// The point of the source at a place in a cell; that of a vertex is known.
    pub fn on_source(&self, shell: &Shell, cell: &Cell, place: &Place, vertex: Option<u32>) -> Point {
        match vertex {
            Some(v) => shell.source().positions()[v as usize],
            None => self.rounded(shell.source.corners(cell.source), &cell.on_source(place)),
        }
    }

    /// The point of the section, or else of the middle surface, likewise.
    pub fn on_section(&self, shell: &Shell, cell: &Cell, place: &Place, vertex: Option<u32>) -> Point {
        match (vertex, &shell.section) {
            (Some(v), Some(section)) => section.mesh.positions()[v as usize],
            (Some(v), None) => shell.parts().middle[v as usize],
            (None, section) => {
                self.rounded(corners_of_section(shell, section.as_ref(), cell.section), &cell.on_section(place))
            }
        }
    }

    /// The point of the middle surface at a place in a prism.
    pub fn on_middle(&self, shell: &Shell, prism: u32, place: &Place) -> Point {
        self.rounded(corners_of_section(shell, None, prism), place)
    }

    fn rounded(&self, corners: [Point; 3], weights: &[Lazy; 3]) -> Point {
        if let Some(k) = corner_at(weights) {
            return corners[k];
        }
        let near = weights.each_ref().map(Lazy::interval);
        let mut exact = None;
        std::array::from_fn(|axis| {
            let (middle, radius) = combined(&near, corners, axis).middle_and_radius();
            if radius <= self.accuracy {
                return middle;
            }
            let exact = exact.get_or_insert_with(|| exactly(weights));
            combined(exact, corners, axis).to_f64()
        })
    }
}

/// Weights in rationals; the third is what is missing to 1, which costs less than to compute it.
pub(super) fn exactly([a, b, _]: &[Lazy; 3]) -> [Rational; 3] {
    let [a, b] = [a, b].map(Lazy::exact);
    [a.clone(), b.clone(), &(&Rational::ONE - a) - b]
}

/// The corner of a triangle that a place is, if it is one.
fn corner_at(weights: &[Lazy; 3]) -> Option<usize> {
    let is_small = |number: &Lazy| number.interval().low() < SMALL && number.interval().high() > -SMALL;
    (0..3).find(|&k| {
        let mut others = [(k + 1) % 3, (k + 2) % 3].into_iter().map(|i| &weights[i]);
        others.clone().all(is_small) && others.all(Lazy::is_zero)
    })
}

/// A coordinate of the point with the given weights.
pub(super) fn combined<T: Scalar>(weights: &[T; 3], corners: [Point; 3], axis: usize) -> T {
    let term = |k: usize| weights[k].times(&T::from_f64(corners[k][axis]));
    term(0).plus(&term(1)).plus(&term(2))
}

/// The corners of a triangle of the section, or of the middle surface where there is none.
pub(super) fn corners_of_section(shell: &Shell, section: Option<&ShellSurface>, triangle: u32) -> [Point; 3] {
    match section {
        Some(section) => section.corners(triangle),
        None => shell.parts().prisms[triangle as usize].map(|v| shell.parts().middle[v as usize]),
    }
}

/// Whether the normals of two triangles point to the same side.
pub(super) fn has_same_side(triangle: [Point; 3], other: [Point; 3]) -> bool {
    let near = product_of_normals::<Interval>(triangle, other).sign();
    near.unwrap_or_else(|| product_of_normals::<Rational>(triangle, other).sign()) == Sign::Positive
}

fn product_of_normals<T: Scalar>(triangle: [Point; 3], other: [Point; 3]) -> T {
    let [n, m] = [triangle, other].map(normal::<T>);
    n[0].times(&m[0]).plus(&n[1].times(&m[1])).plus(&n[2].times(&m[2]))
}

fn normal<T: Scalar>([a, b, c]: [Point; 3]) -> [T; 3] {
    let step = |p: Point| -> [T; 3] { std::array::from_fn(|i| T::from_f64(p[i]).minus(&T::from_f64(a[i]))) };
    let [u, v] = [step(b), step(c)];
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| u[i].times(&v[j]).minus(&u[j].times(&v[i])))
}
