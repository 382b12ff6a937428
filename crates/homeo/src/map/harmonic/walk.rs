//! Following points that lie close to one another through a triangulation, in floating point.

use homeo_core::planar::Point2;
use homeo_core::spatial::Aabb;

use super::half::{Half, Side};

/// Steps from triangle to triangle before the tree is asked.
const MOST_STEPS: usize = 24;
/// A point this much outside a triangle, as a share of its area, still counts as in it.
const ROUNDING: f64 = 1e-11;

/// Where the last point was found.
pub(super) struct Walk<'m> {
    half: &'m Half,
    from: Side,
    triangle: usize,
}

impl<'m> Walk<'m> {
    pub fn new(half: &'m Half, from: Side) -> Self {
        Self { half, from, triangle: 0 }
    }

    /// Takes a point to the other side; `None` if it lies in no triangle.
    pub fn carry(&mut self, point: Point2) -> Option<Point2> {
        if !self.half.is_cylinder() || self.from == Side::Domain {
            return self.step_to(point).or_else(|| self.look_up(point));
        }
        // On a cylinder triangles lie in one of several turns: first in that of the last point.
        let [turn, height] = point;
        let here = self.half.rounded(self.from, self.triangle)[0][0];
        self.step_to([turn + (here - turn).round(), height]).or_else(|| {
            let [low, high] = self.half.reach();
            let first = turn + (low - turn).ceil();
            (0..=(high - low).min(1e3) as u32).find_map(|k| self.look_up([first + f64::from(k), height]))
        })
    }

    /// The triangle in which a point was found.
    pub fn find(&mut self, point: Point2) -> Option<usize> {
        self.carry(point).map(|_| self.triangle)
    }

    /// By steps over the edges that have the point on their far side.
    fn step_to(&mut self, point: Point2) -> Option<Point2> {
        for _ in 0..MOST_STEPS {
            let weights = self.weights(self.triangle, point);
            let worst = (0..3).min_by(|&i, &j| weights[i].total_cmp(&weights[j]))?;
            if weights[worst] >= -ROUNDING {
                return Some(self.combine(self.triangle, weights));
            }
            // On a cylinder the next triangle may lie in another turn: then the walk goes astray and ends.
            self.triangle = self.half.neighbour(self.triangle, worst)?;
        }
        None
    }

    fn look_up(&mut self, point: Point2) -> Option<Point2> {
        let mut found = None;
        let place = [point[0], point[1], 0.0];
        self.half.tree(self.from).query_box(&Aabb { low: place, high: place }, |triangle| {
            if found.is_none() {
                let weights = self.weights(triangle, point);
                if weights.iter().all(|&w| w >= -ROUNDING) {
                    found = Some((triangle, weights));
                }
            }
        });
        let (triangle, weights) = found?;
        self.triangle = triangle;
        Some(self.combine(triangle, weights))
    }

    /// Barycentric coordinates.
    fn weights(&self, triangle: usize, point: Point2) -> [f64; 3] {
        let [a, b, c] = self.half.rounded(self.from, triangle);
        let cross = |p: Point2, q: Point2, r: Point2| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let inverse = 1.0 / cross(a, b, c);
        let (u, v) = (cross(point, b, c) * inverse, cross(a, point, c) * inverse);
        [u, v, 1.0 - u - v]
    }

    fn combine(&self, triangle: usize, weights: [f64; 3]) -> Point2 {
        let to = if self.from == Side::Domain { Side::Image } else { Side::Domain };
        let corners = self.half.rounded(to, triangle);
        [0, 1].map(|axis| (0..3).map(|k| weights[k] * corners[k][axis]).sum())
    }
}
