//! A rigorous lower bound of the Jacobian determinant over the closed domain.

use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::predicate::{Sign, orient2d};
use rayon::prelude::*;

use super::chart::{Cover, Piece};
use super::frame::{Chart, Frame, Outline};
use super::guide::Guide;
use super::speed::EdgeSpeeds;
use crate::composite::number::{Form, Number};
use crate::composite::{JacobianLimits, JacobianVerdict};

/// Pieces that are bounded before it is seen whether to go on: a fixed number, lest the answer depend on threads.
const CHUNK: usize = 16;
/// Where pieces are sampled before anything is proved, as parts of their sides.
const SAMPLES: [[f64; 2]; 5] = [[0.0, 0.0], [0.0, 1.0], [0.5, 0.5], [1.0, 0.0], [1.0, 1.0]];

/// What is bounded.
pub(super) struct Problem<'a> {
    pub outline: &'a Outline,
    pub domain: &'a PlanarDomain,
    pub speeds: &'a EdgeSpeeds,
}

enum Outcome {
    Positive(f64),
    Negative(Point2, f64),
    Undecided(Point2),
}

impl Problem<'_> {
    /// The verdict, from all pieces in order. `is_cancelled` is asked now and then; what was not reached is undecided.
    pub fn bound(&self, limits: &JacobianLimits, is_cancelled: &(dyn Fn() -> bool + Sync)) -> JacobianVerdict {
        let cover = Cover::new(self.outline, self.domain);
        if let Some((point, at_most)) = self.sampled_fold(&cover) {
            return JacobianVerdict::Negative { point, at_most, boxes: 0 };
        }
        let (mut least, mut boxes) = (f64::INFINITY, 0);
        for chunk in cover.pieces.chunks(CHUNK) {
            let bound = |piece: &Piece| self.bound_piece(piece, &cover.disks, limits, is_cancelled);
            let bounded: Vec<(Outcome, u32)> = chunk.par_iter().map(bound).collect();
            boxes += bounded.iter().map(|(_, boxes)| u64::from(*boxes)).sum::<u64>();
            for (outcome, _) in bounded {
                match outcome {
                    Outcome::Positive(here) => least = least.min(here),
                    Outcome::Negative(point, at_most) => return JacobianVerdict::Negative { point, at_most, boxes },
                    Outcome::Undecided(point) => return JacobianVerdict::Undecided { point, boxes },
                }
            }
        }
        JacobianVerdict::Positive { least, boxes }
    }

    /// The first point of some at which the map is proved to fold, with an upper bound of the determinant.
    pub fn first_fold(&self, points: &[Point2]) -> Option<(Point2, f64)> {
        points.iter().find_map(|&point| Some((point, self.proved_fold(point)?)))
    }

    /// A point where the map is proved to fold, if one of some samples is such: that of the least determinant.
    fn sampled_fold(&self, cover: &Cover) -> Option<(Point2, f64)> {
        let mut frame = Frame::<f64>::new(self.outline, self.speeds);
        let mut found: Vec<(f64, Point2)> = Vec::new();
        for piece in &cover.pieces {
            for shares in SAMPLES {
                let at = [0, 1].map(|k| piece.sides[k][0] + shares[k] * (piece.sides[k][1] - piece.sides[k][0]));
                // Off the vertex, towards which determinants may have limits by direction only.
                let at = if piece.vertex().is_some() { [at[0].max(1e-3), at[1].clamp(1e-3, 0.999)] } else { at };
                let point = piece.place(self.outline, at);
                let guide = Guide::at(self.outline, point, piece.vertex(), piece.direction(at[1]));
                let value = frame.evaluate(&piece.rounded(), at, &guide).determinant();
                if value < 0.0 && self.domain.contains(point) {
                    found.push((value, point));
                }
            }
        }
        let (_, point) = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some((point, self.proved_fold(point)?))
    }

    /// An upper bound of the determinant at a point, if that is negative and the point in the domain.
    fn proved_fold(&self, point: Point2) -> Option<f64> {
        if !self.domain.contains(point) {
            return None;
        }
        let guide = Guide::at(self.outline, point, None, [0.0; 2]);
        let mut frame = Frame::<Form>::new(self.outline, self.speeds);
        let at_most = frame.evaluate(&Chart::Plane, point.map(Form::of), &guide).determinant().high();
        (at_most < 0.0).then_some(at_most)
    }

    /// Bisects a piece until the determinant is bounded in each box.
    fn bound_piece(
        &self,
        piece: &Piece,
        disks: &[f64],
        limits: &JacobianLimits,
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> (Outcome, u32) {
        let mut frame = Frame::<Form>::new(self.outline, self.speeds);
        let mut waiting = vec![piece.sides];
        let (mut least, mut boxes) = (f64::INFINITY, 0);
        while let Some(sides) = waiting.pop() {
            if piece.vertex().is_none() && self.is_elsewhere(sides, disks) {
                continue;
            }
            let middle = sides.map(|[low, high]| 0.5 * low + 0.5 * high);
            let point = piece.place(self.outline, middle);
            if boxes == limits.boxes_per_chart || boxes % 256 == 255 && is_cancelled() {
                return (Outcome::Undecided(point), boxes);
            }
            boxes += 1;
            let at = [0, 1].map(|axis| Form::between(sides[axis][0], sides[axis][1]).along(axis));
            let guide = Guide::at(self.outline, point, piece.vertex(), piece.direction(middle[1]));
            let determinant = frame.evaluate(&piece.chart, at, &guide).determinant();
            let (low, high) = (determinant.low(), determinant.high());
            if low > 0.0 && low >= limits.sharpness * high {
                least = least.min(low);
                continue;
            }
            if high < 0.0
                && let Some(at_most) = self.proved_fold(point)
            {
                return (Outcome::Negative(point, at_most), boxes);
            }
            let axis = longer_side(piece, sides);
            for half in [[middle[axis], sides[axis][1]], [sides[axis][0], middle[axis]]] {
                let mut part = sides;
                part[axis] = half;
                waiting.push(part);
            }
        }
        (Outcome::Positive(least), boxes)
    }

    /// Whether a box of the plane is outside of the domain, exactly, or in the disk of a vertex, which is covered.
    fn is_elsewhere(&self, [[left, right], [low, high]]: [[f64; 2]; 2], disks: &[f64]) -> bool {
        let corners = [[left, low], [right, low], [right, high], [left, high]];
        let is_in = |(v, radius): (&Point2, &f64)| corners.iter().all(|c| (c[0] - v[0]).hypot(c[1] - v[1]) < *radius);
        if self.outline.vertices.iter().zip(disks).any(is_in) {
            return true;
        }
        let meets = |[p, q]: [Point2; 2]| {
            let is_apart =
                p[0].max(q[0]) < left || p[0].min(q[0]) > right || p[1].max(q[1]) < low || p[1].min(q[1]) > high;
            let signs = corners.map(|corner| orient2d(p, q, corner));
            let is_beside = [Sign::Positive, Sign::Negative].iter().any(|side| signs.iter().all(|sign| sign == side));
            !(is_apart || is_beside)
        };
        !self.domain.edges().any(meets) && !self.domain.contains(corners[0])
    }
}

/// Along which coordinate a box is longer in the plane.
fn longer_side(piece: &Piece, sides: [[f64; 2]; 2]) -> usize {
    let size = sides.map(|[low, high]| high - low);
    let Chart::Corner { a, b, .. } = &piece.chart else { return usize::from(size[1] > size[0]) };
    let e = piece.direction(0.5 * (sides[1][0] + sides[1][1]));
    let across = [b[0].middle - a[0].middle, b[1].middle - a[1].middle];
    // Directions matter up to the vertex; distances less, as nothing else is near.
    usize::from(across[0].hypot(across[1]) * size[1] > 0.5 * e[0].hypot(e[1]) * size[0])
}
