//! How the triangles of a section lie over one middle triangle.

use homeo_core::number::{Interval, Lazy, Rational, Scalar};
use homeo_core::predicate::{Sign, orient3d};
use homeo_core::spatial::Aabb;

use super::polygon::{Corner, Edges, Place, clipped};
use crate::map::{Shell, ShellSurface};

type Point = [f64; 3];

/// The image of the part of a triangle that lies in one tetrahedron: a convex polygon, counter-clockwise.
pub(super) struct Piece {
    pub triangle: u32,
    pub corners: Vec<Corner<3>>,
    pub hull: Aabb,
    /// Where the triangle's corners would be if all of it lay in the tetrahedron.
    pub frame: [Place; 3],
}

/// Which of the two surfaces pieces belong to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Source,
    Section,
}

impl Role {
    fn edge(self, opposite: usize) -> Edges {
        let edge = Some(opposite as u8);
        match self {
            Self::Source => Edges { of_source: edge, of_section: None },
            Self::Section => Edges { of_source: None, of_section: edge },
        }
    }
}

impl Piece {
    fn new(triangle: u32, corners: Vec<Corner<3>>, frame: [Place; 3]) -> Self {
        let ends = corners.iter().flat_map(|corner| {
            let ends = corner.at.each_ref().map(Lazy::interval);
            [ends.map(|end| end.low()), ends.map(|end| end.high())]
        });
        Self { triangle, hull: Aabb::of(&ends.collect::<Vec<_>>()), corners, frame }
    }

    /// A triangle of the middle surface itself.
    pub fn whole_prism(prism: u32) -> Self {
        let frame: [Place; 3] =
            std::array::from_fn(|k| [0, 1, 2].map(|column| Lazy::from_f64(if k == column { 1.0 } else { 0.0 })));
        let corner = |k: usize| Corner { at: frame[k].clone(), side: Role::Section.edge((k + 2) % 3), is_new: false };
        Self::new(prism, (0..3).map(corner).collect(), frame.clone())
    }
}

/// The pieces of a surface in a prism. Where a triangle lies in the face between two tetrahedra, it counts for the one
/// above it.
pub(super) fn pieces_in(shell: &Shell, surface: &ShellSurface, role: Role, prism: u32) -> Vec<Piece> {
    let slabs = [2 * prism as usize, 2 * prism as usize + 1];
    let mut pieces = Vec::new();
    for (columns, corners) in slabs.into_iter().flat_map(|slab| shell.slab_cells(slab)) {
        let whole = orient3d(corners[0], corners[1], corners[2], corners[3]);
        if whole == Sign::Zero {
            continue; // a pinched column
        }
        let body = Tetrahedron { corners, columns, is_reversed: whole == Sign::Negative, role };
        pieces.extend(
            surface
                .near(&corners.map(|p| p.map(Interval::from_f64)))
                .into_iter()
                .filter(|&t| role != Role::Source || shell.parts().are_paired(t, prism))
                .filter_map(|t| body.piece_of(t, surface.corners(t))),
        );
    }
    pieces
}

/// A tetrahedron of a slab.
struct Tetrahedron {
    corners: [Point; 4],
    /// The column of the prism on which each corner lies.
    columns: [usize; 4],
    is_reversed: bool,
    role: Role,
}

impl Tetrahedron {
    /// The part of a triangle in it; `None` without an area.
    fn piece_of(&self, number: u32, triangle: [Point; 3]) -> Option<Piece> {
        let signs: [[Sign; 3]; 4] = std::array::from_fn(|face| triangle.map(|point| self.sign(face, point)));
        for (face, signs) in signs.iter().enumerate() {
            if signs.iter().all(|sign| *sign != Sign::Positive) {
                let is_in_face = signs.iter().all(|sign| *sign == Sign::Zero);
                if !(is_in_face && self.is_above(face, triangle)) {
                    return None;
                }
            }
        }
        let weights: [[Lazy; 4]; 3] = std::array::from_fn(|k| self.weights(triangle[k], signs.map(|face| face[k])));
        let frame = weights.each_ref().map(|weights| self.place(weights));
        let corner = |k: usize| Corner { at: weights[k].clone(), side: self.role.edge((k + 2) % 3), is_new: false };
        let mut rest: Vec<Corner<4>> = (0..3).map(corner).collect();
        for face in (0..4).filter(|&face| signs[face].contains(&Sign::Negative)) {
            let heights: Vec<Lazy> = rest.iter().map(|corner| corner.at[face].clone()).collect();
            let signs: Vec<Sign> = heights.iter().map(Lazy::certain_sign).collect();
            rest = clipped(rest, &signs, &heights, Edges::default())?;
            // What was cut off ends where this weight is zero, which is worth knowing without computing it.
            rest.iter_mut().filter(|corner| corner.is_new).for_each(|corner| corner.at[face] = Lazy::from_f64(0.0));
        }
        let corners =
            rest.into_iter().map(|corner| Corner { at: self.place(&corner.at), side: corner.side, is_new: false });
        Some(Piece::new(number, corners.collect(), frame))
    }

    /// The place of a point in the middle triangle.
    fn place(&self, weights: &[Lazy; 4]) -> Place {
        let on = |column: usize| {
            let parts = (0..4).filter(|&i| self.columns[i] == column).map(|i| &weights[i]);
            parts.fold(Lazy::from_f64(0.0), |sum, part| sum.plus(part))
        };
        [on(0), on(1), on(2)]
    }

    /// On which side of a face, opposite to the corner of that number, a point lies: positive inside.
    fn sign(&self, face: usize, point: Point) -> Sign {
        let mut moved = self.corners;
        if moved.iter().enumerate().any(|(i, corner)| i != face && *corner == point) {
            return Sign::Zero; // the predicate is slowest for zero
        }
        moved[face] = point;
        let sign = orient3d(moved[0], moved[1], moved[2], moved[3]);
        if self.is_reversed { sign.reversed() } else { sign }
    }

    /// Whether the tetrahedron lies above a triangle in the plane of one of its faces.
    fn is_above(&self, face: usize, [a, b, c]: [Point; 3]) -> bool {
        orient3d(a, b, c, self.corners[face]) == Sign::Positive
    }

    /// The barycentric weights of a point, inside or not, of which the signs are known.
    fn weights(&self, point: Point, signs: [Sign; 4]) -> [Lazy; 4] {
        let corners = self.corners;
        std::array::from_fn(|i| match signs[i] {
            Sign::Zero => Lazy::from_f64(0.0),
            _ => Lazy::of_formula(weight::<Interval>(corners, i, point), move || weight::<Rational>(corners, i, point)),
        })
    }
}

/// The barycentric weight of a point at a corner of a tetrahedron.
fn weight<T: Scalar>(corners: [Point; 4], i: usize, point: Point) -> T {
    let mut moved = corners;
    moved[i] = point;
    volume::<T>(moved).divide(&volume(corners))
}

/// Six times the volume of a tetrahedron.
fn volume<T: Scalar>([a, b, c, d]: [Point; 4]) -> T {
    let step = |p: Point| -> [T; 3] { std::array::from_fn(|i| T::from_f64(p[i]).minus(&T::from_f64(a[i]))) };
    let [u, v, w] = [step(b), step(c), step(d)];
    let minor = |y: usize, z: usize| v[y].times(&w[z]).minus(&v[z].times(&w[y]));
    u[0].times(&minor(1, 2)).plus(&u[1].times(&minor(2, 0))).plus(&u[2].times(&minor(0, 1)))
}
