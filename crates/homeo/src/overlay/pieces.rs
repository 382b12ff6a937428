//! How the triangles of a section lie over one middle triangle.

use homeo_core::number::{Interval, Lazy, Rational, Scalar};
use homeo_core::predicate::{Sign, orient3d};
use homeo_core::spatial::Aabb;

use super::names::{Line, Maker, Origin, Post, Side};
use super::polygon::{Corner, Place, Sides, clipped};
use crate::map::{Shell, ShellSurface};

type Point = [f64; 3];

/// The image of the part of a triangle that lies in one tetrahedron: a convex polygon, counter-clockwise.
pub(super) struct Piece {
    pub triangle: u32,
    pub corners: Vec<Corner<3>>,
    pub hull: Aabb,
    /// Where the triangle's corners would be if all of it lay in the tetrahedron.
    pub frame: [Place; 3],
    role: Role,
    maker: Maker,
}

/// Which of the two surfaces pieces belong to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Source,
    Section,
}

impl Role {
    fn sides(self, side: Side) -> Sides {
        match self {
            Self::Source => Sides { of_source: Some(side), of_section: None },
            Self::Section => Sides { of_source: None, of_section: Some(side) },
        }
    }

    fn of(self, sides: Sides) -> Option<Side> {
        match self {
            Self::Source => sides.of_source,
            Self::Section => sides.of_section,
        }
    }
}

/// The edge that goes from a corner of a triangle to the next one.
fn edge_from(corner: usize) -> Side {
    (corner as Side + 2) % 3
}

impl Piece {
    fn new(corners: Vec<Corner<3>>, frame: [Place; 3], role: Role, maker: Maker) -> Self {
        let ends = corners.iter().flat_map(|corner| {
            let ends = corner.at.each_ref().map(Lazy::interval);
            [ends.map(|end| end.low()), ends.map(|end| end.high())]
        });
        let hull = Aabb::of(&ends.collect::<Vec<_>>());
        Self { triangle: maker.triangle, hull, corners, frame, role, maker }
    }

    /// A triangle of the middle surface itself, on these columns.
    pub fn whole_prism(prism: u32, columns: [u32; 3]) -> Self {
        let frame: [Place; 3] =
            std::array::from_fn(|k| [0, 1, 2].map(|column| Lazy::from_f64(if k == column { 1.0 } else { 0.0 })));
        let corner = |k: usize| Corner {
            at: frame[k].clone(),
            side: Role::Section.sides(edge_from(k)),
            is_new: false,
            mark: Some(k as u8),
        };
        let maker = Maker { triangle: prism, vertices: columns, tetrahedron: 0, posts: [0; 4] };
        Self::new((0..3).map(corner).collect(), frame.clone(), Role::Section, maker)
    }

    /// Its corner between two sides that meet, and what that is; `None` if they are the same, or not both known.
    pub fn corner_between(&self, before: Sides, after: Sides) -> Option<(&Corner<3>, Origin)> {
        let (before, after) = (self.role.of(before)?, self.role.of(after)?);
        let ends_side = |k: usize| self.role.of(self.corners[(k + self.corners.len() - 1) % self.corners.len()].side);
        let k = (0..self.corners.len())
            .find(|&k| ends_side(k) == Some(before) && self.role.of(self.corners[k].side) == Some(after))?;
        let corner = &self.corners[k];
        let origin = match corner.mark {
            Some(mark) => Origin::Vertex(self.maker.vertices[usize::from(mark)]),
            None => self.maker.origin(before, after),
        };
        Some((corner, origin))
    }

    /// The line of one of its sides, of two of which at most one is its own.
    pub fn line(&self, before: Sides, after: Sides) -> Option<Line> {
        self.role.of(before).or(self.role.of(after)).map(|side| self.maker.line(side))
    }
}

/// The pieces of a surface in a prism. Where a triangle lies in the face between two tetrahedra, it counts for the one
/// above it.
pub(super) fn pieces_in(shell: &Shell, surface: &ShellSurface, role: Role, prism: u32) -> Vec<Piece> {
    let slabs = [2 * prism as usize, 2 * prism as usize + 1];
    let mut pieces = Vec::new();
    let cells = slabs.into_iter().flat_map(|slab| shell.slab_cells(slab));
    for (number, (columns, corners)) in cells.enumerate() {
        let whole = orient3d(corners[0], corners[1], corners[2], corners[3]);
        if whole == Sign::Zero {
            continue; // a pinched column
        }
        let posts = std::array::from_fn(|i| post(shell, shell.parts().prisms[prism as usize][columns[i]], corners[i]));
        let is_reversed = whole == Sign::Negative;
        let body = Tetrahedron { number: number as u8, corners, columns, posts, is_reversed, role };
        pieces.extend(
            surface
                .near(&corners.map(|p| p.map(Interval::from_f64)))
                .into_iter()
                .filter(|&t| role != Role::Source || shell.parts().are_paired(t, prism))
                .filter_map(|t| body.piece_of(surface, t)),
        );
    }
    pieces
}

/// The number of a point of a column. All three of a pinched column are one.
fn post(shell: &Shell, column: u32, point: Point) -> Post {
    let parts = shell.parts();
    let level = [&parts.bottom, &parts.middle, &parts.top].iter().position(|level| level[column as usize] == point);
    3 * column + level.unwrap_or_default() as u32
}

/// A tetrahedron of a slab.
struct Tetrahedron {
    /// In its prism.
    number: u8,
    corners: [Point; 4],
    posts: [Post; 4],
    /// The column of the prism on which each corner lies.
    columns: [usize; 4],
    is_reversed: bool,
    role: Role,
}

impl Tetrahedron {
    /// The part of a triangle in it; `None` without an area.
    fn piece_of(&self, surface: &ShellSurface, number: u32) -> Option<Piece> {
        let triangle = surface.corners(number);
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
        let rest = self.part(&weights, &signs)?;
        let corners = rest.into_iter().map(|corner| Corner {
            at: self.place(&corner.at),
            side: corner.side,
            is_new: false,
            mark: corner.mark,
        });
        let vertices = surface.mesh.complex().cells()[number as usize].map(|v| v.raw());
        let maker = Maker { triangle: number, vertices, tetrahedron: self.number, posts: self.posts };
        Some(Piece::new(corners.collect(), frame, self.role, maker))
    }

    /// The part of a triangle in it, by the weights of the triangle's corners and their signs.
    fn part(&self, weights: &[[Lazy; 4]; 3], signs: &[[Sign; 3]; 4]) -> Option<Vec<Corner<4>>> {
        let corner = |k: usize| Corner {
            at: weights[k].clone(),
            side: self.role.sides(edge_from(k)),
            is_new: false,
            mark: Some(k as u8),
        };
        let mut rest: Vec<Corner<4>> = (0..3).map(corner).collect();
        for face in (0..4).filter(|&face| signs[face].contains(&Sign::Negative)) {
            let heights: Vec<Lazy> = rest.iter().map(|corner| corner.at[face].clone()).collect();
            let signs: Vec<Sign> = heights.iter().map(Lazy::certain_sign).collect();
            rest = clipped(rest, &signs, &heights, self.role.sides(3 + face as Side))?;
            // What was cut off ends where this weight is zero, which is worth knowing without computing it.
            rest.iter_mut().filter(|corner| corner.is_new).for_each(|corner| corner.at[face] = Lazy::from_f64(0.0));
        }
        Some(rest)
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
