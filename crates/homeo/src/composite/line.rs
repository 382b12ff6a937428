//! What speeds along the edges add to a mean value map: complex maps, `docs/theory/complex.md`.
//!
//! An edge with images `h` and `h'` of its ends adds `γ (h' - h) δ(x)` to the numerator, where `x` is the place of the point along
//! the line of the edge, `δ(x) = σ(x) - x = x (1 - x) q(x)` says by how much its speed is ahead, and, with the half tangent `t`
//! and the distances `r`, `r'` of the ends, `γ = t (1/r + 1/r') + i (1/r' - 1/r)`. At an apex `s γ` and `δ / s` stand in
//! their place.

use super::chart::{Step, Touch};
use super::frame::{AtApex, Frame, View};
use super::number::Number;
use super::vector::{Dual, Vector, dot, minus, of, opposite, scaled};

/// An edge and its speed.
pub(crate) struct Line<T> {
    /// The edge over the square of its length.
    measure: Vector<T>,
    /// From the image of its first vertex to that of the second.
    image: Vector<T>,
    /// Coefficients of `q`.
    pub quotient: Vec<T>,
}

/// More coefficients there are not.
const MOST: usize = 8;

impl Step {
    /// All edges with their speeds; nothing if these are linear.
    pub(super) fn lines<T: Number>(&self) -> Vec<Line<T>> {
        let count = if self.speeds.degree() > 1 { self.next.len() } else { 0 };
        (0..count).map(|edge| self.line(edge, self.speeds.quotient(edge))).collect()
    }

    /// An edge with a polynomial `q`.
    pub(crate) fn line<T: Number>(&self, edge: usize, quotient: Vec<T>) -> Line<T> {
        let ends = [edge, self.next[edge] as usize];
        let between = |points: &[[f64; 2]]| minus(of::<T>(points[ends[1]]), of(points[ends[0]]));
        let vector = between(&self.points);
        let measure = scaled(T::of(1.0) / dot(vector, vector), vector);
        Line { measure, image: between(&self.images), quotient }
    }
}

impl<T: Number> Line<T> {
    /// `q` and its derivative, expanded about a number near `x`, so that in a box powers of small numbers are taken.
    fn at(&self, x: T) -> [T; 2] {
        let mut shifted = [T::of(0.0); MOST];
        let count = self.quotient.len();
        shifted[..count].copy_from_slice(&self.quotient);
        let near = T::of(x.near());
        for begin in 0..count {
            for k in (begin..count - 1).rev() {
                shifted[k] = shifted[k] + near * shifted[k + 1];
            }
        }
        let (rest, zero) = (x - near, T::of(0.0));
        shifted[..count].iter().rev().fold([zero, zero], |[value, slope], &c| [value * rest + c, slope * rest + value])
    }

    /// `γ (h' - h) δ` by both parts of `γ`.
    fn term(&self, [real, imaginary]: [Dual<T>; 2], ahead: Dual<T>) -> [Dual<T>; 2] {
        let [real, imaginary] = [real.times(ahead), imaginary.times(ahead)];
        let [x, y] = self.image;
        let minus_y = y.opposite();
        [
            real.times_constant(x).plus(imaginary.times_constant(minus_y)),
            real.times_constant(y).plus(imaginary.times_constant(x)),
        ]
    }
}

impl<T: Number> Frame<'_, T> {
    /// What an edge adds to the numerator.
    pub(crate) fn added(&self, view: &View<T>, edge: usize, line: &Line<T>) -> [Dual<T>; 2] {
        let next = self.step.next[edge] as usize;
        let is_this = |at: &&AtApex<T>| match at.touch {
            Touch::Previous => at.end == edge && Some(next) == self.apex(),
            _ => at.end == next && Some(edge) == self.apex(),
        };
        match view.edges().find(is_this) {
            Some(at_apex) => self.added_at_apex(view, at_apex, line),
            None => self.added_elsewhere(view, [edge, next], line),
        }
    }

    fn added_elsewhere(&self, view: &View<T>, [edge, next]: [usize; 2], line: &Line<T>) -> [Dual<T>; 2] {
        let [before, after] = [edge, next].map(|vertex| self.inverse(view, vertex));
        let [value, x, y] = self.tangents[edge];
        let tangent = view.chain(value, [x, y]);
        let gamma = [tangent.times(before.plus(after)), after.minus(before)].map(|c| c.with(view.factor()));
        let place = dot(minus(view.position, self.offsets[edge][0]), line.measure);
        let [quotient, slope] = line.at(place);
        let (one, rest) = (T::of(1.0), T::of(1.0) - place);
        let product = place * rest;
        let rate = (one - place.by(2.0)) * quotient + product * slope;
        line.term(gamma, view.chain(product * quotient, scaled(rate, line.measure)))
    }

    /// The place is `s` times a rate from the apex.
    fn added_at_apex(&self, view: &View<T>, edge: &AtApex<T>, line: &Line<T>) -> [Dual<T>; 2] {
        let is_first = edge.touch == Touch::Next;
        let measure = if is_first { line.measure } else { opposite(line.measure) };
        let one = Dual([T::of(1.0), T::of(0.0), T::of(0.0)]);
        let rate = Dual([dot(view.along, measure), T::of(0.0), dot(self.axes[1], measure)]);
        let s = view.along_dual();
        let from_apex = s.times(rate);
        let place = if is_first { from_apex } else { one.minus(from_apex) };
        let [quotient, slope] = line.at(place.0[0]);
        let quotient = Dual([quotient, slope * place.0[1], slope * place.0[2]]);
        let ahead = rate.times(one.minus(from_apex)).times(quotient);
        let tangent = view.tangent(edge);
        let (own, far) = (one.over(view.length), s.times(self.inverse(view, edge.end)));
        let turned = if is_first { far.minus(own) } else { own.minus(far) };
        line.term([tangent.times(own.plus(far)), turned.with(view.factor())], ahead)
    }
}
