//! How the triangles of a section lie over one middle triangle.

use homeo_core::number::Rational;
use homeo_core::predicate::{Sign, orient3d};

use super::polygon::{Corner, Place, clipped};
use crate::map::{Shell, ShellSurface};

type Point = [f64; 3];

/// The image of the part of a triangle that lies in one tetrahedron: a convex polygon, counter-clockwise.
pub(super) struct Piece {
    pub triangle: u32,
    pub corners: Vec<Corner>,
    pub hull: Hull,
}

/// A box round a polygon.
#[derive(Clone, Copy)]
pub(super) struct Hull {
    low: [f64; 2],
    high: [f64; 2],
}

impl Hull {
    fn of(corners: &[Corner]) -> Self {
        let start = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };
        corners.iter().fold(start, |hull, corner| {
            let [low, high] = corner.place.bounds();
            Self {
                low: [0, 1].map(|axis| hull.low[axis].min(low[axis])),
                high: [0, 1].map(|axis| hull.high[axis].max(high[axis])),
            }
        })
    }

    pub fn meets(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.low[axis] <= other.high[axis] && other.low[axis] <= self.high[axis])
    }
}

impl Piece {
    fn new(triangle: u32, corners: Vec<Corner>) -> Self {
        Self { triangle, hull: Hull::of(&corners), corners }
    }

    /// A triangle of the middle surface itself.
    pub fn whole_prism(prism: u32) -> Self {
        let corners = [0, 1, 2].map(|k| {
            let weights = unit(k);
            Corner { place: Place::new([weights[1].clone(), weights[2].clone()]), weights }
        });
        Self::new(prism, corners.to_vec())
    }

    /// The weights in the piece's triangle of some places: an affine map, known at its corners.
    pub fn weights_at<'p>(&self, places: impl Iterator<Item = &'p Place>) -> Vec<[Rational; 3]> {
        let from = &self.corners[0];
        let step = |corner: &Corner| [0, 1].map(|axis| &corner.place.exact[axis] - &from.place.exact[axis]);
        let cross = |u: &[Rational; 2], v: &[Rational; 2]| &(&u[0] * &v[1]) - &(&u[1] * &v[0]);
        let steps: Vec<[Rational; 2]> = self.corners.iter().map(step).collect();
        // A piece has an area, so one of the triangles of its fan has.
        let fan = (1..self.corners.len() - 1).map(|k| (k, cross(&steps[k], &steps[k + 1])));
        let Some((k, whole)) = fan.into_iter().find(|(_, whole)| !whole.is_zero()) else { return Vec::new() };
        let [u, v] = [k, k + 1].map(|k| &self.corners[k].weights);
        let at = |place: &Place| -> [Rational; 3] {
            if let Some(corner) = self.corners.iter().find(|corner| corner.place.exact == place.exact) {
                return corner.weights.clone();
            }
            let p = [0, 1].map(|axis| &place.exact[axis] - &from.place.exact[axis]);
            let (x, y) = (&cross(&p, &steps[k + 1]) / &whole, &cross(&steps[k], &p) / &whole);
            [0, 1, 2].map(|i| {
                let base = &from.weights[i];
                &(base + &(&x * &(&u[i] - base))) + &(&y * &(&v[i] - base))
            })
        };
        places.map(at).collect()
    }
}

/// The pieces of a surface in a prism. Where a triangle lies in the face between two tetrahedra, it counts for the one
/// above it.
pub(super) fn pieces_in(shell: &Shell, surface: &ShellSurface, prism: u32) -> Vec<Piece> {
    let slabs = [2 * prism as usize, 2 * prism as usize + 1];
    let points: Vec<Point> = slabs.iter().flat_map(|&slab| shell.slab_cells(slab)).flat_map(|(_, cell)| cell).collect();
    let near = surface.near(&points);
    let mut pieces = Vec::new();
    for slab in slabs {
        for (columns, cell) in shell.slab_cells(slab) {
            let whole = orient3d(cell[0], cell[1], cell[2], cell[3]);
            if whole == Sign::Zero {
                continue; // a pinched column
            }
            let body = Tetrahedron { corners: cell, columns, is_reversed: whole == Sign::Negative };
            pieces.extend(near.iter().filter_map(|&t| Some(Piece::new(t, body.part_of(surface.corners(t))?))));
        }
    }
    pieces
}

fn unit(k: usize) -> [Rational; 3] {
    [0, 1, 2].map(|i| if i == k { Rational::ONE } else { Rational::ZERO })
}

/// A tetrahedron of a slab.
struct Tetrahedron {
    corners: [Point; 4],
    /// The column of the prism on which each corner lies.
    columns: [usize; 4],
    is_reversed: bool,
}

impl Tetrahedron {
    /// The part of a triangle in it, as a polygon with an area; `None` without one.
    fn part_of(&self, triangle: [Point; 3]) -> Option<Vec<Corner>> {
        let signs: [[Sign; 3]; 4] = std::array::from_fn(|face| triangle.map(|point| self.sign(face, point)));
        for (face, signs) in signs.iter().enumerate() {
            if signs.iter().all(|sign| *sign != Sign::Positive) {
                let is_in_face = signs.iter().all(|sign| *sign == Sign::Zero);
                if !(is_in_face && self.is_above(face, triangle)) {
                    return None;
                }
            }
        }
        let weights: [[Rational; 4]; 3] = triangle.map(|point| self.weights(point));
        let place = |weights: &[Rational; 4]| {
            let on = |column: usize| (0..4).filter(|&i| self.columns[i] == column).map(|i| weights[i].clone()).sum();
            Place::new([on(1), on(2)])
        };
        let mut rest: Vec<Corner> = (0..3).map(|k| Corner { place: place(&weights[k]), weights: unit(k) }).collect();
        for (face, signs) in signs.iter().enumerate().filter(|(_, signs)| signs.contains(&Sign::Negative)) {
            let height = |corner: &Corner| -> Rational { (0..3).map(|k| &corner.weights[k] * &weights[k][face]).sum() };
            let sides: Vec<Sign> = rest.iter().map(|corner| corner_sign(corner, signs, &height)).collect();
            rest = clipped(rest, &sides, height)?;
        }
        Some(rest)
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

    /// The barycentric weights of a point, inside or not.
    fn weights(&self, point: Point) -> [Rational; 4] {
        let exact = |p: Point| p.map(|x| Rational::from_f64(x).unwrap_or(Rational::ZERO));
        let corners = self.corners.map(exact);
        let step = |p: &[Rational; 3]| [0, 1, 2].map(|axis| &p[axis] - &corners[0][axis]);
        let [u, v, w, p] = [step(&corners[1]), step(&corners[2]), step(&corners[3]), step(&exact(point))];
        let whole = determinant(&u, &v, &w);
        let parts = [determinant(&p, &v, &w), determinant(&u, &p, &w), determinant(&u, &v, &p)].map(|d| &d / &whole);
        let [b, c, d] = parts;
        [&(&(&Rational::ONE - &b) - &c) - &d, b, c, d]
    }
}

/// The sign of a corner's height: known for the triangle's own corners.
fn corner_sign(corner: &Corner, signs: &[Sign; 3], height: &impl Fn(&Corner) -> Rational) -> Sign {
    match corner.weights.iter().position(|weight| *weight == Rational::ONE) {
        Some(k) => signs[k],
        None => height(corner).sign(),
    }
}

fn determinant(u: &[Rational; 3], v: &[Rational; 3], w: &[Rational; 3]) -> Rational {
    let minor = |y: usize, z: usize| &(&v[y] * &w[z]) - &(&v[z] * &w[y]);
    [(0, 1, 2), (1, 2, 0), (2, 0, 1)].into_iter().map(|(x, y, z)| &u[x] * &minor(y, z)).sum()
}
