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

/// Rounding cannot tell through which facet the leaf goes on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Undecided;

/// Bound of the rounding of one step, in barycentric coordinates (all are at most 1): an inverse, two
/// products and a difference for each weight, and the sum that normalizes them, half an ulp each.
const STEP_ROUNDING: f64 = 6.0 * f64::EPSILON;
/// The box of errors is turned when the columns of the derivative are this close to parallel.
const NEARLY_PARALLEL: f64 = 0.05;
/// Errors beyond this mean that nothing is known any more.
const LARGEST_ERROR: f64 = 0.125;

/// A leaf being followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct FastLeaf<const K: usize> {
    pub cell: CellId,
    /// Barycentric coordinates.
    pub weights: [f64; K],
    /// Bit per weight that is exactly 0.
    zeros: u8,
    /// The two columns of the derivative.
    columns: [[f64; K]; 2],
    reach: [f64; 2],
    /// Before the first facet: plain bounds of the errors of all weights.
    start: Option<[f64; K]>,
    /// Length travelled.
    pub length: f64,
    /// Bound of its error.
    pub length_error: f64,
    pub steps: usize,
}

impl<const K: usize> FastLeaf<K> {
    pub fn new(at: &FloatLocation<K>) -> Self {
        let zeros = (0..K).filter(|&i| at.errors[i] == 0.0 && at.weights[i] == 0.0).fold(0, |bits, i| bits | 1 << i);
        Self {
            cell: at.cell,
            weights: at.weights,
            zeros,
            columns: [[0.0; K]; 2],
            reach: [0.0; 2],
            start: Some(at.errors),
            length: 0.0,
            length_error: 0.0,
            steps: 0,
        }
    }

    /// Bound of the error of weight `i`.
    #[inline]
    pub fn error(&self, i: usize) -> f64 {
        if self.zeros >> i & 1 == 1 {
            return 0.0;
        }
        match &self.start {
            Some(errors) => errors[i],
            None => {
                let [u, v] = [self.columns[0][i], self.columns[1][i]];
                // The factor covers the rounding of this very bound.
                1.0000001 * (u.abs() * self.reach[0] + v.abs() * self.reach[1])
            }
        }
    }

    /// The facet through which the leaf leaves the current cell.
    #[inline]
    pub fn exit(&self, map: &Foliation<K>, sense: Sense) -> Result<usize, Undecided> {
        let direction = &map.steps[self.cell.index()].direction;
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

    /// Moves to facet `i` of the current cell.
    #[inline]
    pub fn move_to(&mut self, map: &Foliation<K>, i: usize) -> Result<(), Undecided> {
        if self.zeros >> i & 1 == 1 {
            return self.settle(i);
        }
        let step = &map.steps[self.cell.index()];
        let directions: [f64; K] = std::array::from_fn(|j| f64::from(step.direction[j]));
        let inverse = 1.0 / directions[i];
        let error = self.error(i);
        let h = f64::from(step.length);
        // Weights move to b_j - (b_i / d_i) d_j, backwards and forwards alike.
        let along = self.weights[i] * inverse;
        self.length += h * along.abs();
        self.length_error += h * error * inverse.abs() + 4.0 * f64::EPSILON * self.length;
        for j in 0..K {
            self.weights[j] -= along * directions[j];
        }
        self.weights[i] = 0.0;
        let stays_zero = (0..K).filter(|&j| step.direction[j] == 0).fold(0, |bits, j| bits | 1 << j);
        self.zeros = self.zeros & stays_zero | 1 << i;
        self.normalize();
        if let Some(errors) = &mut self.start {
            for j in 0..K {
                errors[j] += (directions[j] * inverse).abs() * error + STEP_ROUNDING;
            }
            return self.settle(i);
        }
        for column in &mut self.columns {
            let along = column[i] * inverse;
            for j in 0..K {
                column[j] -= along * directions[j];
            }
            column[i] = 0.0;
        }
        self.add_rounding(i)
    }

    /// Makes the weights add up to 1 again by the largest of them.
    #[inline]
    fn normalize(&mut self) {
        let mut largest = 0;
        let mut sum = 0.0;
        for j in 0..K {
            sum += self.weights[j];
            if self.weights[j] > self.weights[largest] {
                largest = j;
            }
        }
        self.weights[largest] += 1.0 - sum;
    }

    /// Turns plain bounds into the box on the first facet.
    fn settle(&mut self, i: usize) -> Result<(), Undecided> {
        let Some(errors) = self.start else { return Ok(()) };
        self.rebuild(i, errors)?;
        self.start = None;
        Ok(())
    }

    /// A box whose sides are two of the facet's own coordinates.
    fn rebuild(&mut self, i: usize, errors: [f64; K]) -> Result<(), Undecided> {
        let [p, q] = two_others(i);
        let bound = |j: usize| if self.zeros >> j & 1 == 1 { 0.0 } else { errors[j] + STEP_ROUNDING };
        if K == 4 {
            self.reach = [bound(p), bound(q)];
            self.set_box(i, [1.0, 0.0], [0.0, 1.0]);
        } else {
            self.reach = [bound(p), 0.0];
            self.columns = [[0.0; K]; 2];
            self.columns[0][p] = 1.0;
            self.columns[0][q] = -1.0;
        }
        if self.reach[0].max(self.reach[1]) < LARGEST_ERROR { Ok(()) } else { Err(Undecided) }
    }

    /// Sets the columns of a box in a triangular facet by their first two coordinates; all three add up to 0.
    fn set_box(&mut self, i: usize, first: [f64; 2], second: [f64; 2]) {
        let [p, q] = two_others(i);
        let r = 6 - i - p - q;
        for (column, [x, y]) in self.columns.iter_mut().zip([first, second]) {
            *column = [0.0; K];
            (column[p], column[q], column[r]) = (x, y, -(x + y));
        }
    }

    /// Adds the rounding of one step, pulled back through the derivative.
    #[inline]
    fn add_rounding(&mut self, i: usize) -> Result<(), Undecided> {
        // The rows of the derivative add up to zero: any two of them will do.
        let [p, q] = two_others(i);
        let [u, v] = [[self.columns[0][p], self.columns[1][p]], [self.columns[0][q], self.columns[1][q]]];
        if K == 3 {
            let steepness = u[0].abs();
            if !(1e-150..1e150).contains(&steepness) {
                let errors = std::array::from_fn(|j| self.error(j));
                return self.rebuild(i, errors);
            }
            self.reach[0] += STEP_ROUNDING / steepness;
            return self.still_known();
        }
        let determinant = (u[0] * v[1] - u[1] * v[0]).abs();
        let sizes = [u[0].abs() + v[0].abs(), u[1].abs() + v[1].abs()];
        if !(1e-150..1e150).contains(&determinant) || determinant < NEARLY_PARALLEL * sizes[0] * sizes[1] {
            self.turn_box(i);
            return self.still_known();
        }
        let scale = 1.001 * STEP_ROUNDING / determinant;
        self.reach[0] += scale * sizes[1];
        self.reach[1] += scale * sizes[0];
        // Errors grow slowly: a look now and then is enough, and each comparison looks for itself.
        if self.steps % 16 == 0 { self.still_known() } else { Ok(()) }
    }

    fn still_known(&self) -> Result<(), Undecided> {
        if (0..K).all(|j| self.error(j) < LARGEST_ERROR) { Ok(()) } else { Err(Undecided) }
    }

    /// Encloses the box of errors in one with perpendicular sides, the first along its longest side
    /// (the wrapping of Lohner's QR variant: a thin box stays thin).
    fn turn_box(&mut self, i: usize) {
        let [p, q] = two_others(i);
        let side = |k: usize| [self.columns[k][p] * self.reach[k], self.columns[k][q] * self.reach[k]];
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
        self.set_box(i, along, across);
    }

    /// Crosses facet `i`; gives the facet when the leaf ends there.
    #[inline]
    pub fn cross(&mut self, map: &Foliation<K>, i: usize) -> Option<Facet> {
        self.steps += 1;
        let step = &map.steps[self.cell.index()];
        let far = step.across[i];
        if far.is_none() {
            return Some(Facet::new(self.cell, i));
        }
        let (weights, columns, zeros) = (self.weights, self.columns, self.zeros);
        let new = far.opposite();
        self.weights[new] = 0.0;
        // Zero but after a step of no length, where it keeps the rows' sum at zero.
        (self.columns[0][new], self.columns[1][new]) = (columns[0][i], columns[1][i]);
        self.zeros = 1 << new;
        for k in (0..K).filter(|&k| k != i) {
            let there = step.renumbered(i, k);
            self.weights[there] = weights[k];
            self.columns[0][there] = columns[0][k];
            self.columns[1][there] = columns[1][k];
            self.zeros |= (zeros >> k & 1) << there;
        }
        self.cell = far.cell();
        None
    }

    /// Follows the leaf to its end; gives the facet there.
    pub fn follow(&mut self, map: &Foliation<K>, sense: Sense) -> Result<Facet, Undecided> {
        loop {
            let i = self.exit(map, sense)?;
            self.move_to(map, i)?;
            if let Some(end) = self.cross(map, i) {
                return Ok(end);
            }
        }
    }

    /// Follows the leaf from its source end until `wanted` has been travelled, and moves inside the
    /// cell where that happens. `wanted_error` bounds the error of `wanted`.
    /// Gives bounds of the errors of the weights.
    pub fn follow_for(&mut self, map: &Foliation<K>, wanted: f64, wanted_error: f64) -> Result<[f64; K], Undecided> {
        loop {
            let i = self.exit(map, Sense::Forward)?;
            let before = *self;
            self.move_to(map, i)?;
            if self.length >= wanted {
                *self = before;
                return Ok(self.go_inside(map, wanted, wanted_error));
            }
            if self.cross(map, i).is_some() {
                // Rounding only: the leaf ends here.
                return Ok(std::array::from_fn(|j| self.error(j)));
            }
        }
    }

    fn go_inside(&mut self, map: &Foliation<K>, wanted: f64, wanted_error: f64) -> [f64; K] {
        let step = &map.steps[self.cell.index()];
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

/// Two local vertices of facet `i`.
#[inline]
fn two_others(i: usize) -> [usize; 2] {
    match i {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}
