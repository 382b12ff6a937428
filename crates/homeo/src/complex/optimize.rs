//! Speeds of the largest least determinant at samples: entropic mirror ascent.
//!
//! Derivatives of the map are linear in the deviations of control values from those of linear speeds, so determinants are
//! quadratic; their parts are computed once for each sample. The least of them is made smooth,
//! `-1/β log mean exp(-β det)`, with `β` growing by stages. Control values are sums of increments, which are positive and
//! add up to 1 for each edge: a step multiplies each by the exponential of its slope and divides by the sum (Beck,
//! Teboulle 2003), so monotony holds at every step without a projection. What it finds is a proposal, and proved apart.

use super::SpeedError;
use super::speed::{EdgeSpeeds, power_form};
use crate::composite::chart::{Chart, Step};
use crate::composite::frame::Frame;
use crate::composite::guide::Guide;
use crate::composite::line::Line;
use homeo_core::planar::{PlanarDomain, Point2};

/// Sharpness of the smooth minimum by stages, in units of one over the ratio of areas, and steps for each.
const STAGES: [f64; 6] = [10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0];
const STEPS: usize = 150;
/// No increment is less than this part of that of linear speeds, lest rounding make two control values one.
const LEAST_INCREMENT: f64 = 1e-4;
/// A chart of a vertex is sampled here, in its own coordinates.
const CORNER: [[f64; 2]; 5] = [[0.0, 0.0], [0.0, 0.5], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
/// An edge is sampled at multiples of one over this.
const EDGE: usize = 16;

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
    /// Of each edge `d` positive numbers that add up to 1.
    increments: Vec<Vec<f64>>,
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

impl<'a> Search<'a> {
    /// From linear speeds, with samples in the charts of vertices, on edges and on a grid of so many points along the longer side; with fewer
    /// if it is cancelled.
    pub fn new(
        step: &'a Step,
        domains: [&PlanarDomain; 2],
        degree: usize,
        grid: usize,
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Self {
        let [source, target] = domains.map(area);
        let count = step.points.len();
        let increments = vec![vec![1.0 / degree as f64; degree]; count];
        let unit = |k: usize| (0..degree - 1).map(|l| f64::from(u8::from(k == l))).collect::<Vec<f64>>();
        let quotients: Vec<Vec<f64>> = (0..degree - 1).map(|k| power_form(degree, &unit(k))).collect();
        let lines = |edge: usize| quotients.iter().map(|quotient| step.line(edge, quotient.clone())).collect();
        let basis = (0..count).map(lines).collect();
        let mut this = Self { step, degree, ratio: target / source, samples: Vec::new(), basis, increments };
        for chart in step.charts.iter().filter(|chart| step.is_vertex(chart.corners[0])) {
            if is_cancelled() {
                return this;
            }
            CORNER.into_iter().for_each(|at| this.add(chart, at));
        }
        for [p, q] in domains[0].edges() {
            if is_cancelled() {
                return this;
            }
            for share in (1..EDGE).map(|k| k as f64 / EDGE as f64) {
                this.insist([0, 1].map(|k| p[k] + share * (q[k] - p[k])));
            }
        }
        let [low, high] = domains[0].bounds();
        let step = (high[0] - low[0]).max(high[1] - low[1]) / grid as f64;
        let count = |axis: usize| ((high[axis] - low[axis]) / step).ceil() as usize;
        for (x, y) in (0..count(0)).flat_map(|x| (0..count(1)).map(move |y| (x, y))) {
            let point = [low[0] + (x as f64 + 0.5) * step, low[1] + (y as f64 + 0.5) * step];
            if is_cancelled() {
                return this;
            }
            if domains[0].contains(point) {
                this.insist(point);
            }
        }
        this
    }

    /// One more sample, where the search was too kind.
    pub fn insist(&mut self, point: Point2) {
        let (chart, at) = self.step.locate(point);
        self.add(chart, at);
    }

    fn add(&mut self, chart: &Chart, [s, lambda]: [f64; 2]) {
        let mut frame = Frame::<f64>::new(self.step, chart);
        let view = frame.look(s, lambda);
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
            self.samples.push(Sample { point: self.step.place(chart, [s, lambda]), along: plain.columns, by, factor });
        }
    }

    /// Deviations of all control values, edge by edge.
    fn deviations(&self, increments: &[Vec<f64>]) -> Vec<f64> {
        let mut all = Vec::with_capacity(increments.len() * (self.degree - 1));
        for edge in increments {
            let mut sum = 0.0;
            for (k, increment) in edge[..self.degree - 1].iter().enumerate() {
                sum += increment;
                all.push(sum - (k + 1) as f64 / self.degree as f64);
            }
        }
        all
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
        let sent = self.sent(&self.deviations(&self.increments));
        let mut found: Vec<(f64, Point2)> =
            sent.iter().zip(&self.samples).map(|((_, value), sample)| (*value, sample.point)).collect();
        found.retain(|(value, _)| *value < 0.0);
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.into_iter().map(|(_, point)| point).collect()
    }

    /// The smooth minimum, and its slopes by deviations.
    fn value(&self, deviations: &[f64], sharpness: f64, slopes: Option<&mut [f64]>) -> f64 {
        let sent = self.sent(deviations);
        let least = sent.iter().map(|(_, value)| *value).fold(f64::INFINITY, f64::min);
        let weight = |value: f64| (-sharpness * (value - least)).exp();
        let total: f64 = sent.iter().map(|(_, value)| weight(*value)).sum();
        if let Some(slopes) = slopes {
            slopes.fill(0.0);
            for (sample, (along, value)) in self.samples.iter().zip(&sent) {
                let share = weight(*value) / total * sample.factor;
                for (slope, by) in slopes.iter_mut().zip(&sample.by) {
                    *slope += share * (cross(by[0], along[1]) + cross(along[0], by[1]));
                }
            }
        }
        least - (total / self.samples.len() as f64).ln() / sharpness
    }

    /// The ratio of areas, in which values are given.
    pub fn ratio(&self) -> f64 {
        self.ratio
    }

    /// The least determinant at samples, over the ratio of areas.
    pub fn least(&self) -> f64 {
        self.value(&self.deviations(&self.increments), 1e12, None)
    }

    /// Ascends, until it was done or cancelled.
    pub fn ascend(&mut self, is_cancelled: &(dyn Fn() -> bool + Sync)) {
        let mut slopes = vec![0.0; self.step.points.len() * (self.degree - 1)];
        for sharpness in STAGES {
            let mut rate = 0.1;
            for _ in 0..STEPS {
                if is_cancelled() {
                    return;
                }
                let here = self.value(&self.deviations(&self.increments), sharpness, Some(&mut slopes));
                let better = (0..20).map(|halvings| rate * 0.5f64.powi(halvings)).find_map(|rate| {
                    let next = self.stepped(&slopes, rate);
                    let value = self.value(&self.deviations(&next), sharpness, None);
                    (value > here).then_some((next, rate))
                });
                let Some((next, taken)) = better else { break };
                self.increments = next;
                rate = 2.0 * taken;
            }
        }
    }

    fn stepped(&self, slopes: &[f64], rate: f64) -> Vec<Vec<f64>> {
        let inner = self.degree - 1;
        let edge = |(i, own): (usize, &Vec<f64>)| {
            // By an increment all control values from its own on grow, but not the last one, which is 1.
            let mut sum = 0.0;
            let mut exponents = vec![0.0; self.degree];
            for k in (0..inner).rev() {
                sum += slopes[i * inner + k];
                exponents[k] = sum;
            }
            let most = exponents.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let floor = LEAST_INCREMENT / self.degree as f64;
            let grown: Vec<f64> = own.iter().zip(&exponents).map(|(d, e)| d * (rate * (e - most)).exp()).collect();
            let total: f64 = grown.iter().sum();
            grown.iter().map(|d| floor + (1.0 - self.degree as f64 * floor) * d / total).collect()
        };
        self.increments.iter().enumerate().map(edge).collect()
    }

    /// What was found.
    ///
    /// # Errors
    /// None is known; control values are checked.
    pub fn speeds(&self) -> Result<EdgeSpeeds, SpeedError> {
        let sums = |edge: &Vec<f64>| {
            edge[..self.degree - 1]
                .iter()
                .scan(0.0, |sum, d| {
                    *sum += d;
                    Some(*sum)
                })
                .collect()
        };
        EdgeSpeeds::new(self.degree, self.increments.iter().map(sums).collect())
    }
}

/// Twice the area.
fn area(domain: &PlanarDomain) -> f64 {
    let Some(&[x, y]) = domain.rings().first().and_then(|ring| ring.first()) else { return 0.0 };
    domain.edges().map(|[p, q]| (p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x)).sum()
}
