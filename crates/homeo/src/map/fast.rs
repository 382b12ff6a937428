//! Leaves in floating point, with a filter that never guesses.
//!
//! A leaf chains projections, and intervals would double their width at each of them. So the error
//! is kept as the image of a box under the chain's own derivative (Lohner's method): the true point
//! on a facet differs from the computed one by `J x` with `|x_1| <= a_1`, `|x_2| <= a_2`, where the
//! columns of `J` are carried along exactly like points, and each step's rounding is pulled back through
//! `J` and added to `a`. Where the next facet is not certain within that error, the leaf
//! reports [`Undecided`] and the caller follows it exactly: fast and exact leaves never differ.

use homeo_core::mesh::{CellId, Facet};

use super::Foliation;
use super::exact::Sense;
use super::locate::FloatLocation;
use super::steps::Step;

/// Rounding cannot tell through which facet the leaf goes on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Undecided;

/// Bound of the rounding of one step, in barycentric coordinates (all are at most 1): half an ulp each for a quotient, a
/// product and a difference of two weights, and for the third all of theirs and the four of its own sum.
const STEP_ROUNDING: f64 = 5.0 * f64::EPSILON;
/// The box of errors is turned when the columns of the derivative are this close to parallel.
const NEARLY_PARALLEL: f64 = 0.05;
/// For leaves ahead and leaves back: the reciprocal of each offset that leads out of a cell, as a positive number, by
/// its bits; 0 for the others.
static RECIPROCALS: [[f64; 256]; 2] = {
    let mut table = [[0.0; 256]; 2];
    let mut offset = 1;
    while offset <= 128 {
        // Ahead, weights on the way out have negative offsets.
        table[0][256 - offset] = 1.0 / offset as f64;
        if offset < 128 {
            table[1][offset] = 1.0 / offset as f64;
        }
        offset += 1;
    }
    table
};
/// Errors beyond this mean that nothing is known any more.
const LARGEST_ERROR: f64 = 0.125;

/// Two vertices of a cell besides `i`.
#[inline(always)]
const fn two_others(i: usize) -> (usize, usize) {
    (if i == 0 { 1 } else { 0 }, if i <= 1 { 2 } else { 1 })
}

/// A leaf being followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct FastLeaf<const K: usize> {
    /// Where the leaf is, as a slot of the table of steps.
    pub slot: CellId,
    /// Barycentric coordinates.
    pub weights: [f64; K],
    /// Bit per weight that is exactly 0.
    zeros: u8,
    derivative: [[f64; 2]; K],
    reach: [f64; 2],
    /// Bounds of the errors of all weights; 0 for those that are exactly 0.
    errors: [f64; K],
    /// Whether the first facet is still to come, with no box yet but plain bounds.
    is_starting: bool,
    /// Length travelled.
    pub length: f64,
    /// Bound of its error.
    pub length_error: f64,
    pub steps: usize,
}

impl<const K: usize> FastLeaf<K> {
    pub fn new(map: &Foliation<K>, at: &FloatLocation<K>) -> Self {
        let zeros = (0..K).filter(|&i| at.errors[i] == 0.0 && at.weights[i] == 0.0).fold(0, |bits, i| bits | 1 << i);
        Self {
            slot: map.steps.slot(at.cell),
            weights: at.weights,
            zeros,
            derivative: [[0.0; 2]; K],
            reach: [0.0; 2],
            errors: at.errors,
            is_starting: true,
            length: 0.0,
            length_error: 0.0,
            steps: 0,
        }
    }

    /// The cell where the leaf is.
    pub fn cell(&self, map: &Foliation<K>) -> CellId {
        map.steps.cell(self.slot)
    }

    /// Bound of the error of weight `i`.
    #[inline(always)]
    pub fn error(&self, i: usize) -> f64 {
        self.errors[i]
    }

    /// Bounds of all errors from the box.
    #[inline(always)]
    fn bound_errors(&mut self) {
        for j in 0..K {
            let [u, v] = self.derivative[j];
            // The factor covers the rounding of this very bound.
            let bound = 1.0000001 * (u.abs() * self.reach[0] + v.abs() * self.reach[1]);
            self.errors[j] = if self.zeros >> j & 1 == 1 { 0.0 } else { bound };
        }
    }

    /// The facet through which the leaf leaves the current cell.
    #[inline(always)]
    pub fn exit(&self, step: &Step, sense: Sense) -> Result<usize, Undecided> {
        // Which offsets lead out is as good as random: no branch depends on it.
        let reciprocals = &RECIPROCALS[usize::from(sense == Sense::Backward)];
        let (mut arrival, mut slack) = ([f64::INFINITY; K], [0.0; K]);
        let mut best = 0;
        for j in 0..K {
            let reciprocal = reciprocals[usize::from(step.direction[j].cast_unsigned())];
            let leads_out = reciprocal > 0.0;
            // Three roundings, of the reciprocal, the product and, below, the sum; and those of this very bound.
            slack[j] = reciprocal * (1.0000001 * self.errors[j] + 3.0 * f64::EPSILON * self.weights[j].abs());
            arrival[j] = if leads_out { self.weights[j] * reciprocal } else { f64::INFINITY };
            best = if arrival[j] < arrival[best] { j } else { best };
        }
        let latest = arrival[best] + slack[best];
        let rivals: usize = (0..K).map(|j| usize::from(arrival[j] - slack[j] <= latest)).sum();
        if rivals == 1 { Ok(best) } else { self.exit_among_rivals(step, sense) }
    }

    /// The same where several facets are reached at about the same time, as on edges and vertices.
    #[cold]
    fn exit_among_rivals(&self, step: &Step, sense: Sense) -> Result<usize, Undecided> {
        let direction = &step.direction;
        let sign = sense.exit_sign();
        let mut best = K;
        for j in (0..K).filter(|&j| direction[j].signum() == sign) {
            if best == K || self.zeros >> j & 1 == 1 {
                best = j;
                continue;
            }
            if self.zeros >> best & 1 == 1 {
                continue;
            }
            let (here, there) = (f64::from(direction[best].unsigned_abs()), f64::from(direction[j].unsigned_abs()));
            let (mine, other) = (self.weights[best] * there, self.weights[j] * here);
            let error =
                there * self.error(best) + here * self.error(j) + 4.0 * f64::EPSILON * (mine.abs() + other.abs());
            if other + error < mine {
                best = j;
            } else if mine + error >= other {
                return Err(Undecided);
            }
        }
        debug_assert!(best < K, "a direction has offsets of both signs");
        Ok(best)
    }

    /// How long the leaf will be at facet `i` of the current cell.
    #[inline(always)]
    fn length_at(&self, step: &Step, i: usize) -> f64 {
        if self.zeros >> i & 1 == 1 {
            return self.length;
        }
        self.length + f64::from(step.length) * (self.weights[i] / f64::from(step.direction[i])).abs()
    }

    /// Moves to facet `i` of the current cell.
    #[inline(always)]
    pub fn move_to(&mut self, step: &Step, i: usize) -> Result<(), Undecided> {
        if self.zeros >> i & 1 == 1 {
            return self.settle(i);
        }
        let offset = f64::from(step.direction[i]);
        let error = self.error(i);
        // Weights move to b_j - (b_i / d_i) d_j, backwards and forwards alike.
        let along = self.weights[i] / offset;
        let reciprocal = 1.0 / offset;
        let h = f64::from(step.length);
        self.length += h * along.abs();
        self.length_error += h * error * reciprocal.abs() + 4.0 * f64::EPSILON * self.length;
        let column = self.derivative[i];
        let mut stays_zero = 0;
        for j in 0..K {
            let direction = f64::from(step.direction[j]);
            if step.direction[j] == 0 && self.zeros >> j & 1 == 1 {
                stays_zero |= 1 << j;
                continue;
            }
            self.weights[j] -= along * direction;
            let ratio = direction * reciprocal;
            if self.is_starting {
                self.errors[j] += ratio.abs() * error + STEP_ROUNDING;
            } else {
                self.derivative[j][0] -= ratio * column[0];
                self.derivative[j][1] -= ratio * column[1];
            }
        }
        self.weights[i] = 0.0;
        self.derivative[i] = [0.0; 2];
        self.zeros = stays_zero | 1 << i;
        self.normalize(i);
        if self.is_starting { self.settle(i) } else { self.add_rounding(i) }
    }

    /// Makes the weights add up to 1 again: rounding must not build up.
    #[inline(always)]
    fn normalize(&mut self, i: usize) {
        let (p, q) = two_others(i);
        if self.zeros == 1 << i {
            // The third weight takes what the others leave.
            self.weights[if K == 4 { 6 - i - p - q } else { q }] =
                if K == 4 { 1.0 - (self.weights[p] + self.weights[q]) } else { 1.0 - self.weights[p] };
            return;
        }
        // Weights that are exactly 0 stay so.
        let sum: f64 = self.weights.iter().sum();
        let largest = (0..K).fold(0, |best, j| if self.weights[j] > self.weights[best] { j } else { best });
        self.weights[largest] += 1.0 - sum;
    }

    /// Turns plain bounds into the box on the first facet.
    #[inline]
    fn settle(&mut self, i: usize) -> Result<(), Undecided> {
        if !self.is_starting {
            return Ok(());
        }
        self.is_starting = false;
        self.rebuild(i)
    }

    /// A box whose sides are two of the facet's own coordinates.
    #[cold]
    fn rebuild(&mut self, i: usize) -> Result<(), Undecided> {
        let errors = self.errors;
        let mut others = (0..K).filter(|&j| j != i);
        let [p, q] = [others.next().unwrap_or(0), others.next().unwrap_or(0)];
        self.derivative = [[0.0; 2]; K];
        let bound = |j: usize| if self.zeros >> j & 1 == 1 { 0.0 } else { errors[j] + STEP_ROUNDING };
        self.reach = [bound(p), if K == 4 { bound(q) } else { 0.0 }];
        self.derivative[p] = [1.0, 0.0];
        if K == 4 {
            self.derivative[q] = [0.0, 1.0];
            self.derivative[K - 1 - usize::from(i == K - 1)] = [-1.0, -1.0];
        } else {
            self.derivative[q] = [-1.0, 0.0];
        }
        self.bound_errors();
        if self.reach[0].max(self.reach[1]) < LARGEST_ERROR { Ok(()) } else { Err(Undecided) }
    }

    /// Adds the rounding of one step, pulled back through the derivative.
    #[inline(always)]
    fn add_rounding(&mut self, i: usize) -> Result<(), Undecided> {
        // The rows of the derivative add up to zero: any two of them will do.
        let (p, q) = two_others(i);
        let (u, v) = (self.derivative[p], self.derivative[q]);
        if K == 3 {
            let steepness = u[0].abs();
            if !(1e-150..1e150).contains(&steepness) {
                self.bound_errors();
                return self.rebuild(i);
            }
            self.reach[0] += STEP_ROUNDING / steepness;
        } else {
            let determinant = (u[0] * v[1] - u[1] * v[0]).abs();
            let size = (u[0].abs() + v[0].abs()) * (u[1].abs() + v[1].abs());
            if !(1e-150..1e150).contains(&determinant) || determinant < NEARLY_PARALLEL * size {
                self.turn_box(i, p, q);
                return self.still_known();
            }
            let scale = 1.001 * STEP_ROUNDING / determinant;
            self.reach[0] += scale * (u[1].abs() + v[1].abs());
            self.reach[1] += scale * (u[0].abs() + v[0].abs());
        }
        self.still_known()
    }

    #[inline(always)]
    fn still_known(&mut self) -> Result<(), Undecided> {
        self.bound_errors();
        if (0..K).all(|j| self.error(j) < LARGEST_ERROR) { Ok(()) } else { Err(Undecided) }
    }

    /// Encloses the box of errors in one with perpendicular sides, the first along its longest side
    /// (the wrapping of Lohner's QR variant: a thin box stays thin).
    #[cold]
    fn turn_box(&mut self, i: usize, p: usize, q: usize) {
        let side = |k: usize| [self.derivative[p][k] * self.reach[k], self.derivative[q][k] * self.reach[k]];
        let sides = [side(0), side(1)];
        let length = |s: [f64; 2]| s[0].hypot(s[1]);
        let longest = if length(sides[0]) >= length(sides[1]) { sides[0] } else { sides[1] };
        let size = length(longest);
        let along = if size > 0.0 { [longest[0] / size, longest[1] / size] } else { [1.0, 0.0] };
        let across = [-along[1], along[0]];
        let extent = |axis: [f64; 2]| {
            sides.iter().map(|s| (s[0] * axis[0] + s[1] * axis[1]).abs()).sum::<f64>()
                + 8.0 * f64::EPSILON * (length(sides[0]) + length(sides[1]))
                + 2.0 * STEP_ROUNDING
        };
        self.reach = [extent(along), extent(across)];
        let r = 6 - i - p - q;
        self.derivative = [[0.0; 2]; K];
        self.derivative[p] = [along[0], across[0]];
        self.derivative[q] = [along[1], across[1]];
        self.derivative[r] = [-(along[0] + along[1]), -(across[0] + across[1])];
    }

    /// Crosses facet `i`; gives the facet, of the slot, when the leaf ends there.
    #[inline(always)]
    pub fn cross(&mut self, step: &Step, i: usize) -> Option<Facet> {
        self.steps += 1;
        let far = step.across[i];
        if far.is_none() {
            return Some(Facet::new(self.slot, i));
        }
        debug_assert!(self.weights[i] == 0.0 && self.errors[i] == 0.0 && self.zeros >> i & 1 == 1);
        self.weights = step.carried(i, &self.weights);
        self.errors = step.carried(i, &self.errors);
        // The row of `i` is zero but after a step of no length, where it keeps the rows' sum at zero.
        self.derivative = step.carried(i, &self.derivative);
        let zeros: [u8; K] = std::array::from_fn(|k| self.zeros >> k & 1);
        self.zeros = step.carried(i, &zeros).iter().rev().fold(0, |bits, bit| bits << 1 | bit);
        self.slot = far.cell();
        None
    }

    /// Goes on to the next cell; gives the facet, of the slot, when the leaf ends.
    #[inline(always)]
    pub fn advance(&mut self, step: &Step, sense: Sense) -> Result<Option<Facet>, Undecided> {
        let i = self.exit(step, sense)?;
        self.move_to(step, i)?;
        Ok(self.cross(step, i))
    }

    /// Follows the leaf to its end; gives the facet there.
    pub fn follow(&mut self, map: &Foliation<K>, sense: Sense) -> Result<Facet, Undecided> {
        loop {
            if let Some(end) = self.advance(map.steps.at(self.slot), sense)? {
                return Ok(map.steps.facet(end));
            }
        }
    }

    /// Follows a leaf to both ends by turns, so that the processor works on one while it waits for the other.
    /// Gives the facets at the ends.
    pub fn follow_both(map: &Foliation<K>, back: &mut Self, ahead: &mut Self) -> Result<[Facet; 2], Undecided> {
        loop {
            let start = back.advance(map.steps.at(back.slot), Sense::Backward)?;
            let end = ahead.advance(map.steps.at(ahead.slot), Sense::Forward)?;
            match (start, end) {
                (None, None) => {}
                (Some(start), Some(end)) => return Ok([start, end].map(|facet| map.steps.facet(facet))),
                (Some(start), None) => return Ok([map.steps.facet(start), ahead.follow(map, Sense::Forward)?]),
                (None, Some(end)) => return Ok([back.follow(map, Sense::Backward)?, map.steps.facet(end)]),
            }
        }
    }

    /// Follows the leaf from its source end until `wanted` has been travelled, and moves inside the
    /// cell where that happens. `wanted_error` bounds the error of `wanted`.
    /// Gives bounds of the errors of the weights.
    pub fn follow_for(&mut self, map: &Foliation<K>, wanted: f64, wanted_error: f64) -> Result<[f64; K], Undecided> {
        loop {
            let step = map.steps.at(self.slot);
            let i = self.exit(step, Sense::Forward)?;
            if self.length_at(step, i) >= wanted {
                return Ok(self.go_inside(map, wanted, wanted_error));
            }
            self.move_to(step, i)?;
            if self.cross(step, i).is_some() {
                // Rounding only: the leaf ends here.
                return Ok(self.errors);
            }
        }
    }

    fn go_inside(&mut self, map: &Foliation<K>, wanted: f64, wanted_error: f64) -> [f64; K] {
        let step = map.steps.at(self.slot);
        let h = f64::from(step.length);
        let along = (wanted - self.length).max(0.0) / h;
        let slack = (wanted_error + self.length_error + 4.0 * f64::EPSILON * wanted) / h;
        let mut errors = [0.0; K];
        for j in 0..K {
            let direction = f64::from(step.direction[j]);
            errors[j] = self.error(j) + slack * direction.abs() + STEP_ROUNDING;
            self.weights[j] = (self.weights[j] + along * direction).max(0.0);
        }
        errors
    }
}
