//! Leaves in exact arithmetic.
//!
//! A point is a cell with whole-number weights. Following the direction `d` to facet `i` turns the
//! weights `b` into `b_j |d_i| -+ b_i d_j`: no division, and the weights grow by the bits of one
//! offset (seven at most). The length travelled is kept over the same denominator, the weight sum.

use dashu_base::{Abs, Gcd};
use dashu_int::IBig;
use homeo_core::mesh::{CellId, Facet};
use homeo_core::number::Rational;

use super::Foliation;

/// A point of the foliated mesh: weights of the cell's vertices, not negative, not all 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ExactLocation<const K: usize> {
    pub cell: CellId,
    pub weights: [IBig; K],
}

/// Which way along a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sense {
    /// Towards the source region.
    Backward,
    /// Towards the sink region.
    Forward,
}

impl Sense {
    /// The sign of the offsets of the facets through which a leaf leaves a cell in this sense.
    #[inline]
    pub fn exit_sign(self) -> i8 {
        if self == Self::Backward { 1 } else { -1 }
    }
}

/// A leaf being followed.
#[derive(Clone, Debug)]
pub(super) struct ExactLeaf<const K: usize> {
    pub at: ExactLocation<K>,
    /// Length travelled, over the sum of the weights.
    length: IBig,
    /// Facets crossed.
    pub steps: usize,
}

/// Weights beyond this many bits are reduced now and then.
const REDUCE_EVERY: usize = 32;

impl<const K: usize> ExactLeaf<K> {
    pub fn new(at: ExactLocation<K>) -> Self {
        Self { at, length: IBig::ZERO, steps: 0 }
    }

    /// Length travelled so far.
    pub fn travelled(&self) -> Rational {
        ratio(self.length.clone(), self.at.weights.iter().sum())
    }

    /// The facet through which the leaf leaves the current cell.
    pub fn exit(&self, map: &Foliation<K>, sense: Sense) -> usize {
        let direction = &map.steps.of(self.at.cell).direction;
        let sign = sense.exit_sign();
        let mut best: Option<usize> = None;
        for i in (0..K).filter(|&i| direction[i].signum() == sign) {
            let sooner = |j: usize| {
                let (here, there) = (direction[i].unsigned_abs(), direction[j].unsigned_abs());
                &self.at.weights[i] * IBig::from(there) < &self.at.weights[j] * IBig::from(here)
            };
            if best.is_none_or(sooner) {
                best = Some(i);
            }
        }
        best.expect("a direction has offsets of both signs (please report this)")
    }

    /// Moves to facet `i` of the current cell.
    pub fn move_to(&mut self, map: &Foliation<K>, i: usize) {
        let step = map.steps.of(self.at.cell);
        if self.at.weights[i] == IBig::ZERO {
            return;
        }
        let out = self.at.weights[i].clone();
        let scale = IBig::from(step.direction[i].unsigned_abs());
        let backward = step.direction[i] > 0;
        for j in 0..K {
            let change = &out * IBig::from(step.direction[j]);
            let kept = &self.at.weights[j] * &scale;
            self.at.weights[j] = if backward { kept - change } else { kept + change };
        }
        self.length = &self.length * &scale + &out * IBig::from(step.length);
    }

    /// Crosses facet `i`; gives the facet when the leaf ends there.
    pub fn cross(&mut self, map: &Foliation<K>, i: usize) -> Option<Facet> {
        self.steps += 1;
        if self.steps.is_multiple_of(REDUCE_EVERY) {
            self.reduce();
        }
        let step = map.steps.of(self.at.cell);
        let far = step.across[i];
        if far.is_none() {
            return Some(Facet::new(self.at.cell, i));
        }
        let mut weights: [IBig; K] = std::array::from_fn(|_| IBig::ZERO);
        for k in (0..K).filter(|&k| k != i) {
            weights[step.renumbered(i, k)] = std::mem::take(&mut self.at.weights[k]);
        }
        self.at = ExactLocation { cell: map.steps.cell(far.cell()), weights };
        None
    }

    /// Follows the leaf to its end; gives the facet there.
    pub fn follow(&mut self, map: &Foliation<K>, sense: Sense) -> Facet {
        loop {
            let i = self.exit(map, sense);
            self.move_to(map, i);
            if let Some(end) = self.cross(map, i) {
                return end;
            }
        }
    }

    /// Follows the leaf from its source end until `wanted` has been travelled.
    pub fn follow_for(&mut self, map: &Foliation<K>, wanted: &Rational) {
        loop {
            let i = self.exit(map, Sense::Forward);
            let before = self.clone();
            self.move_to(map, i);
            if self.travelled() >= *wanted {
                *self = before;
                self.go_inside(map, wanted);
                return;
            }
            if self.cross(map, i).is_some() {
                return;
            }
        }
    }

    /// Moves inside the current cell until `wanted` has been travelled in all.
    fn go_inside(&mut self, map: &Foliation<K>, wanted: &Rational) {
        let step = map.steps.of(self.at.cell);
        let left = wanted - &self.travelled();
        // Weights b / W move to b / W + (left / h) d.
        let (p, q) = (&left / &Rational::from(i64::from(step.length))).into_parts();
        let q = IBig::from(q);
        let sum: IBig = self.at.weights.iter().sum();
        let shift = &p * &sum;
        let moved = std::array::from_fn(|j| &self.at.weights[j] * &q + &shift * IBig::from(step.direction[j]));
        self.at.weights = reduced(moved);
    }

    fn reduce(&mut self) {
        let divisor = self.at.weights.iter().fold(self.length.clone(), |d, w| gcd(&d, w));
        if divisor > IBig::ONE {
            self.length = &self.length / &divisor;
            self.at.weights.iter_mut().for_each(|w| *w = &*w / &divisor);
        }
    }
}

fn gcd(a: &IBig, b: &IBig) -> IBig {
    if *a == IBig::ZERO {
        return b.clone().abs();
    }
    if *b == IBig::ZERO {
        return a.clone().abs();
    }
    IBig::from(a.gcd(b))
}

/// Divides by the greatest common divisor.
pub(super) fn reduced<const K: usize>(numbers: [IBig; K]) -> [IBig; K] {
    let divisor = numbers.iter().fold(IBig::ZERO, |d, w| gcd(&d, w));
    if divisor > IBig::ONE { numbers.map(|w| w / &divisor) } else { numbers }
}

/// Whole numbers in the ratio of the given rationals (with a positive factor).
pub(super) fn whole<const K: usize>(values: &[Rational; K]) -> [IBig; K] {
    let common = values.iter().fold(IBig::ONE, |common, v| {
        let denominator = IBig::from(v.denominator().clone());
        let shared = gcd(&common, &denominator);
        common / shared * denominator
    });
    reduced(std::array::from_fn(|i| values[i].numerator() * (&common / IBig::from(values[i].denominator().clone()))))
}

/// `numerator / denominator`, which is not zero.
pub(super) fn ratio(numerator: IBig, denominator: IBig) -> Rational {
    Rational::from_parts(numerator, denominator).expect("weights add up to more than 0 (please report this)")
}

/// Weights as rationals that add up to 1.
pub(super) fn fractions<const K: usize>(weights: &[IBig; K]) -> [Rational; K] {
    let sum: IBig = weights.iter().sum();
    std::array::from_fn(|i| ratio(weights[i].clone(), sum.clone()))
}
