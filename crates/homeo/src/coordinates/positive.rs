//! Positive mean value coordinates: mean value coordinates of what is visible.
//!
//! The directions to all vertices cut the view into sectors; in each the closest edge is seen. Neighbouring sectors with
//! the same edge are one visible piece, from a share `a` of the edge to a share `b`. A piece counts as an edge would:
//! the tangent of half its angle over the distances of its ends, which pass to the vertices of the edge by their shares.
//! Gaps between pieces lie on rays through the point: they are seen under the angle 0 and count for nothing.

use homeo_core::planar::PlanarDomain;

use super::mean_value::{HalfAngle, least, scaled_tangents};
use super::outline::{Outline, Sight, dot, length};
use super::real::Real;
use super::weighted::{self, Weighted};
use super::{CoordinateError, PlanarCoordinates};

/// How far outside a point may lie, in diagonals: as far as rounding carries.
const OUTSIDE: f64 = 1e-13;

/// Positive mean value coordinates (Lipman, Kopf, Cohen-Or, Levin 2007) of a polygon, with holes or without.
///
/// Positive everywhere, equal to mean value coordinates where all of the boundary is visible. Continuous; the gradient
/// jumps where the point crosses a line through two vertices one of which hides the other, and is one-sided there.
///
/// # Complexity
/// #V log #V and #V for each sector: at most quadratic.
///
/// ```
/// use homeo::coordinates::{PlanarCoordinates, PositiveMeanValue};
/// use homeo_core::planar::PlanarDomain;
/// let dart = PlanarDomain::new(vec![vec![[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]]])?;
/// let mut values = [0.0; 4];
/// PositiveMeanValue::new(&dart).values_into([3.0, 0.2], &mut values)?;
/// assert!(values.iter().all(|&v| v >= 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PositiveMeanValue {
    outline: Outline,
    domain: PlanarDomain,
}

/// A visible piece of an edge, between directions to two vertices.
struct Piece {
    edge: usize,
    from: usize,
    to: usize,
}

impl PositiveMeanValue {
    /// Of all rings of a domain.
    pub fn new(domain: &PlanarDomain) -> Self {
        Self { outline: Outline::new(domain), domain: domain.clone() }
    }

    /// Whether the point is in the domain, but for rounding.
    fn is_inside<T: Real<2>>(&self, sight: &Sight<T>) -> bool {
        let is_on = |i: usize| {
            let size = sight.distance[i].value().max(sight.distance[self.outline.next[i]].value());
            sight.dot[i].value() < 0.0 && sight.cross[i].value().abs() <= OUTSIDE * size
        };
        self.domain.contains(sight.point.map(|x| x / self.outline.scale)) || (0..self.outline.count()).any(is_on)
    }

    /// All visible pieces, in order.
    fn pieces<T: Real<2>>(&self, sight: &Sight<T>) -> Vec<Piece> {
        let n = self.outline.count();
        let angles: Vec<f64> = sight.offset.iter().map(|s| s[1].value().atan2(s[0].value())).collect();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&i, &j| angles[i].total_cmp(&angles[j]));
        let mut rank = vec![0; n];
        order.iter().enumerate().for_each(|(place, &i)| rank[i] = place);
        let ends = |m: usize| {
            let wrap = if m + 1 == n { std::f64::consts::TAU } else { 0.0 };
            (angles[order[m]], angles[order[(m + 1) % n]] + wrap)
        };
        let mut closest = vec![(f64::INFINITY, usize::MAX); n];
        for edge in (0..n).filter(|&i| self.is_front(i, sight)) {
            let [x, y] = self.outline.between(edge, self.outline.next[edge]);
            let mut m = rank[edge];
            while m != rank[self.outline.next[edge]] {
                let (from, to) = ends(m);
                let (sine, cosine) = (0.5 * (from + to)).sin_cos();
                let distance = sight.cross[edge].value() / (cosine * y - sine * x);
                if distance < closest[m].0 {
                    closest[m] = (distance, edge);
                }
                m = (m + 1) % n;
            }
        }
        let seen = |&m: &usize| closest[m].1 != usize::MAX && ends(m).0 < ends(m).1;
        let mut pieces: Vec<Piece> = Vec::new();
        for m in (0..n).filter(seen) {
            let (edge, from, to) = (closest[m].1, order[m], order[(m + 1) % n]);
            match pieces.last_mut() {
                Some(last) if last.edge == edge => last.to = to,
                _ => pieces.push(Piece { edge, from, to }),
            }
        }
        // The first and the last sector are neighbours.
        if pieces.len() > 1 && pieces[0].edge == pieces[pieces.len() - 1].edge {
            pieces[0].from = pieces.pop().map_or(0, |last| last.from);
        }
        pieces
    }

    /// Whether an edge has the point on its inner side, or on it.
    fn is_front<T: Real<2>>(&self, edge: usize, sight: &Sight<T>) -> bool {
        let cross = sight.cross[edge].value();
        cross > 0.0 || (sight.dot[edge].value() < 0.0 && cross >= -OUTSIDE)
    }

    /// At which share of an edge the direction to a vertex meets it.
    fn share<T: Real<2>>(&self, edge: usize, vertex: usize, sight: &Sight<T>) -> T {
        let next = self.outline.next[edge];
        if vertex == edge || vertex == next {
            return T::constant(if vertex == edge { 0.0 } else { 1.0 });
        }
        let left: T = self.outline.cross(edge, vertex, sight.point);
        let right: T = self.outline.cross(vertex, next, sight.point);
        left / (left + right)
    }
}

impl Weighted for PositiveMeanValue {
    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn weights<T: Real<2>>(&self, sight: &Sight<T>) -> Result<Vec<T>, CoordinateError> {
        if !self.is_inside(sight) {
            return Err(CoordinateError::Undefined { point: sight.point.map(|x| x / self.outline.scale) });
        }
        let pieces = self.pieces(sight);
        let mut halves = Vec::new();
        let mut ends: Vec<[(T, T); 2]> = Vec::new();
        for piece in &pieces {
            let edge = self.outline.between(piece.edge, self.outline.next[piece.edge]).map(T::constant);
            let shares = [piece.from, piece.to].map(|v| self.share(piece.edge, v, sight));
            let [a, b] = [(shares[0], piece.from), (shares[1], piece.to)].map(|(share, vertex)| {
                let of_edge = vertex == piece.edge || vertex == self.outline.next[piece.edge];
                let start = sight.offset[piece.edge];
                if of_edge { sight.offset[vertex] } else { [0, 1].map(|k| start[k] + share * edge[k]) }
            });
            let lengths = [length(a), length(b)];
            let cross = (shares[1] - shares[0]) * sight.cross[piece.edge];
            halves.push(HalfAngle::new(cross, lengths[0] * lengths[1], dot(a, b)));
            ends.push([(shares[0], lengths[0]), (shares[1], lengths[1])]);
        }
        let tangents = scaled_tangents(&halves);
        let near = least(ends.iter().flatten().map(|end| end.1.value()));
        let near = ends[near / 2][near % 2].1;
        let mut weights = vec![T::constant(0.0); self.outline.count()];
        for ((piece, tangent), ends) in pieces.iter().zip(tangents).zip(ends) {
            let next = self.outline.next[piece.edge];
            for (share, length) in ends {
                let weight = tangent * (near / length);
                weights[piece.edge] = weights[piece.edge] + weight * (T::constant(1.0) - share);
                weights[next] = weights[next] + weight * share;
            }
        }
        Ok(weights)
    }
}

impl PlanarCoordinates for PositiveMeanValue {
    fn vertex_count(&self) -> usize {
        self.outline.count()
    }

    fn values_into(&self, point: [f64; 2], values: &mut [f64]) -> Result<(), CoordinateError> {
        weighted::values(self, point, values)
    }

    fn gradients_into(
        &self,
        point: [f64; 2],
        values: &mut [f64],
        gradients: &mut [[f64; 2]],
    ) -> Result<(), CoordinateError> {
        weighted::gradients(self, point, values, gradients)
    }
}
