//! Speeds of the largest least determinant.
//!
//! Derivatives of the map are linear in the deviations of control values from those of linear speeds, so determinants are
//! quadratic; their parts are computed once for each sample. The least of them is made smooth,
//! `-1/β log mean exp(-β det)`, with `β` growing by stages. Control values are sums of increments, which are positive and
//! add up to 1 for each edge: a softmax of variables that are free, so monotony holds at every step. After each stage places
//! between samples where the determinant is less become samples, too. What is found is a proposal, and proved apart.

use super::SpeedError;
use super::ascent;
use super::speed::{EdgeSpeeds, power_form};
use crate::composite::chart::{Chart, Step};
use crate::composite::frame::Frame;
use crate::composite::guide::Guide;
use crate::composite::line::Line;
use homeo_core::planar::{PlanarDomain, Point2};

/// Sharpness of the smooth minimum by stages, in units of one over the ratio of areas.
pub(super) const STAGES: [f64; 6] = [10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0];
/// No increment is less than this part of that of linear speeds, lest rounding make two control values one.
const LEAST_INCREMENT: f64 = 1e-4;

/// Parts of both sides of a chart: enough to begin with, towards the apex and at the far side; and to see what was missed.
const COARSE: [usize; 2] = [1, 1];
const FINE: [usize; 2] = [4, 8];

type Pair = [[f64; 2]; 2];

/// The derivatives at a sample, and how they change with each deviation.
struct Sample {
    point: Point2,
    along: Pair,
    by: Vec<Pair>,
    /// Over the turn of the chart and the ratio of areas.
    factor: f64,
}

/// A search that can go on when points are added.
pub(super) struct Search<'a> {
    /// The mean value map.
    step: &'a Step,
    degree: usize,
    /// Derivatives by control values are for a map of areas with this ratio.
    ratio: f64,
    samples: Vec<Sample>,
    /// Of each edge, for each inner control value: what a deviation of it adds.
    basis: Vec<Vec<Line<f64>>>,
    /// `d` for each edge; zeros make linear speeds.
    free: Vec<f64>,
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

impl<'a> Search<'a> {
    /// From linear speeds, with samples in all charts; in fewer if it is cancelled.
    pub fn new(
        step: &'a Step,
        domains: [&PlanarDomain; 2],
        degree: usize,
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Self {
        let [source, target] = domains.map(area);
        let count = step.points.len();
        let unit = |k: usize| (0..degree - 1).map(|l| f64::from(u8::from(k == l))).collect::<Vec<f64>>();
        let quotients: Vec<Vec<f64>> = (0..degree - 1).map(|k| power_form(degree, &unit(k))).collect();
        let lines = |edge: usize| quotients.iter().map(|quotient| step.line(edge, quotient.clone())).collect();
        let basis = (0..count).map(lines).collect();
        let free = vec![0.0; degree * count];
        let mut this = Self { step, degree, ratio: target / source, samples: Vec::new(), basis, free };
        for chart in step.charts.iter().take_while(|_| !is_cancelled()) {
            places(COARSE).for_each(|at| this.add(chart, at));
        }
        this
    }

    /// One more sample, where the search was too kind.
    pub fn insist(&mut self, point: Point2) {
        let (chart, at) = self.step.locate(point);
        self.add(chart, at);
    }

    /// One more sample, by the coordinates of its chart.
    fn add(&mut self, chart: &Chart, at: [f64; 2]) {
        let mut frame = Frame::<f64>::new(self.step, chart);
        let view = frame.look(at[0], at[1]);
        let sums = frame.sums(&view, &Guide::NONE);
        let plain = frame.local(&view, &sums, &Guide::NONE);
        let response = |(edge, line): (usize, &Line<f64>)| {
            view.columns(frame.added(&view, edge, line).map(|added| added.over(sums.total)))
        };
        let all = self.basis.iter().enumerate().flat_map(|(edge, lines)| lines.iter().map(move |line| (edge, line)));
        let by: Vec<Pair> = all.map(response).collect();
        let factor = 1.0 / (plain.turn * self.ratio);
        let is_good = plain.columns.iter().chain(by.iter().flatten()).flatten().all(|x| x.is_finite());
        if is_good && factor.is_finite() {
            self.samples.push(Sample { point: self.step.place(chart, at), along: plain.columns, by, factor });
        }
    }

    /// Adds where the determinant is less than at all samples: of each chart the worst place of many. Returns the least
    /// determinant seen, over the ratio of areas.
    fn refine(&mut self, is_cancelled: &(dyn Fn() -> bool + Sync)) -> f64 {
        let least = self.least();
        let Ok(speeds) = self.speeds() else { return f64::NEG_INFINITY };
        let step = self.step.clone().with_speeds(speeds);
        let mut found: Vec<(f64, &Chart, [f64; 2])> = Vec::new();
        for chart in self.step.charts.iter().take_while(|_| !is_cancelled()) {
            let mut frame = Frame::<f64>::new(&step, chart);
            let mut value = |at: [f64; 2]| frame.evaluate(at[0], at[1], &Guide::NONE).determinant / self.ratio;
            let valued = places(FINE).map(|at| (value(at), chart, at)).filter(|(value, ..)| *value < least);
            found.extend(valued.min_by(|a, b| a.0.total_cmp(&b.0)));
        }
        found.iter().for_each(|(_, chart, at)| self.add(chart, *at));
        found.iter().map(|(value, ..)| *value).fold(least, f64::min)
    }

    /// Of each edge `d` positive numbers that add up to 1: the softmax of its variables, above the least increment.
    fn increments(&self, free: &[f64]) -> Vec<f64> {
        let [floor, scale] = self.range();
        let edge = |own: &[f64]| {
            let most = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let grown: Vec<f64> = own.iter().map(|x| (x - most).exp()).collect();
            let total: f64 = grown.iter().sum();
            grown.into_iter().map(move |x| floor + scale * x / total)
        };
        free.chunks(self.degree).flat_map(edge).collect()
    }

    /// The least increment, and what all increments of an edge share beyond it.
    fn range(&self) -> [f64; 2] {
        [LEAST_INCREMENT / self.degree as f64, 1.0 - LEAST_INCREMENT]
    }

    /// Inner control values of each edge.
    fn control_values(&self, increments: &[f64]) -> Vec<Vec<f64>> {
        let sums = |edge: &[f64]| {
            let sum = |sum: &mut f64, d: &f64| {
                *sum += d;
                Some(*sum)
            };
            edge[..self.degree - 1].iter().scan(0.0, sum).collect()
        };
        increments.chunks(self.degree).map(sums).collect()
    }

    /// Deviations of all control values, edge by edge.
    fn deviations(&self, free: &[f64]) -> Vec<f64> {
        let values = self.control_values(&self.increments(free));
        let off = |(k, value): (usize, &f64)| value - (k + 1) as f64 / self.degree as f64;
        values.iter().flat_map(|edge| edge.iter().enumerate().map(off)).collect()
    }

    /// Of each sample the derivatives, and the determinant over the ratio of areas.
    fn sent(&self, deviations: &[f64]) -> Vec<(Pair, f64)> {
        let send = |sample: &Sample| {
            let mut along = sample.along;
            for (by, d) in sample.by.iter().zip(deviations) {
                (0..2).for_each(|a| (0..2).for_each(|c| along[a][c] += by[a][c] * d));
            }
            (along, cross(along[0], along[1]) * sample.factor)
        };
        self.samples.iter().map(send).collect()
    }

    /// Samples at which the determinant is negative, the least one first.
    pub fn folds(&self) -> Vec<Point2> {
        let sent = self.sent(&self.deviations(&self.free));
        let mut found: Vec<(f64, Point2)> =
            sent.iter().zip(&self.samples).map(|((_, value), sample)| (*value, sample.point)).collect();
        found.retain(|(value, _)| *value < 0.0);
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.into_iter().map(|(_, point)| point).collect()
    }

    /// The smooth minimum, and its slopes by deviations.
    fn value(&self, deviations: &[f64], sharpness: f64) -> (f64, Vec<f64>) {
        let sent = self.sent(deviations);
        let least = sent.iter().map(|(_, value)| *value).fold(f64::INFINITY, f64::min);
        let weights: Vec<f64> = sent.iter().map(|(_, value)| (-sharpness * (value - least)).exp()).collect();
        let total: f64 = weights.iter().sum();
        let mut slopes = vec![0.0; deviations.len()];
        // What is below rounding adds nothing.
        let counts = self.samples.iter().zip(&sent).zip(&weights).filter(|(_, weight)| **weight > f64::EPSILON);
        for ((sample, (along, _)), weight) in counts {
            let share = weight / total * sample.factor;
            for (slope, by) in slopes.iter_mut().zip(&sample.by) {
                *slope += share * (cross(by[0], along[1]) + cross(along[0], by[1]));
            }
        }
        (least - (total / self.samples.len() as f64).ln() / sharpness, slopes)
    }

    /// The least determinant at samples, over the ratio of areas.
    fn least(&self) -> f64 {
        self.least_of(&self.free)
    }

    fn least_of(&self, free: &[f64]) -> f64 {
        self.sent(&self.deviations(free)).iter().map(|(_, value)| *value).fold(f64::INFINITY, f64::min)
    }

    /// The least determinant at samples, and that of linear speeds.
    pub fn sampled(&self) -> [f64; 2] {
        [self.least(), self.least_of(&vec![0.0; self.free.len()])].map(|share| share * self.ratio)
    }

    /// Ascends, until it was done or cancelled.
    pub fn ascend(&mut self, is_cancelled: &(dyn Fn() -> bool + Sync)) {
        let mut best = (f64::NEG_INFINITY, self.free.clone());
        for sharpness in STAGES {
            self.climb(sharpness, is_cancelled);
            let least = self.refine(is_cancelled);
            if least > best.0 {
                best = (least, self.free.clone());
            }
        }
        self.free = best.1;
    }

    /// One stage, with samples as they are.
    pub fn climb(&mut self, sharpness: f64, is_cancelled: &(dyn Fn() -> bool + Sync)) {
        self.free = ascent::ascend(self, &self.free, sharpness, is_cancelled);
    }

    /// The smooth minimum for some free variables, and its slopes by them.
    pub fn rise(&self, free: &[f64], sharpness: f64) -> (f64, Vec<f64>) {
        let inner = self.degree - 1;
        let (value, by_deviation) = self.value(&self.deviations(free), sharpness);
        let (increments, [floor, scale]) = (self.increments(free), self.range());
        let mut slopes = vec![0.0; free.len()];
        for (edge, slopes) in slopes.chunks_mut(self.degree).enumerate() {
            // By an increment all control values from its own on grow, but not the last one, which is 1.
            for k in (0..inner).rev() {
                slopes[k] = slopes[k + 1] + by_deviation[edge * inner + k];
            }
            let own = &increments[edge * self.degree..][..self.degree];
            let mean: f64 = own.iter().zip(&*slopes).map(|(d, slope)| (d - floor) / scale * slope).sum();
            slopes.iter_mut().zip(own).for_each(|(slope, d)| *slope = (d - floor) * (*slope - mean));
        }
        (value, slopes)
    }

    /// What was found.
    ///
    /// # Errors
    /// None is known; control values are checked.
    pub fn speeds(&self) -> Result<EdgeSpeeds, SpeedError> {
        EdgeSpeeds::new(self.degree, self.control_values(&self.increments(&self.free)))
    }
}

/// Where a chart is looked at; denser towards its apex.
fn places([radial, across]: [usize; 2]) -> impl Iterator<Item = [f64; 2]> {
    (0..=radial).flat_map(move |k| {
        let s = (k as f64 / radial as f64).powi(2);
        (0..=across).map(move |l| [s, l as f64 / across as f64])
    })
}

/// Twice the area.
fn area(domain: &PlanarDomain) -> f64 {
    let Some(&[x, y]) = domain.rings().first().and_then(|ring| ring.first()) else { return 0.0 };
    domain.edges().map(|[p, q]| (p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x)).sum()
}
