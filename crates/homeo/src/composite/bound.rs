//! A rigorous lower bound of the Jacobian determinant of a mean value map over the whole closed domain.

use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::predicate::orient2d;
use rayon::prelude::*;

use super::chart::{Chart, Step};
use super::frame::Frame;
use super::guide::Guide;
use super::number::Form;
use super::triangulation::{Tiling, TriangulationError, check_tiling};

/// How long [`bound_jacobian`] tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JacobianLimits {
    /// So many boxes are evaluated in one chart at most. There are up to six charts for each triangle.
    pub boxes_per_chart: u32,
    /// A box is accepted if its lower bound is positive and at least this part of its upper bound; from 0 to 1. With 0 the
    /// sign is proved by the fewest boxes; the larger, the closer is the bound to the minimum, and the more boxes it takes.
    pub sharpness: f64,
}

impl Default for JacobianLimits {
    fn default() -> Self {
        Self { boxes_per_chart: 4000, sharpness: 0.1 }
    }
}

/// What is known of the Jacobian determinant of a mean value map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub enum JacobianVerdict {
    /// It is positive everywhere: the map is a homeomorphism of the closed domains.
    Positive {
        /// It is at least this at every point of the open domain.
        least: f64,
        /// So many boxes were evaluated.
        boxes: u64,
    },
    /// It is negative at a point: the map folds there.
    Negative {
        /// The point, of the open domain.
        point: Point2,
        /// There it is at most this, a negative number.
        at_most: f64,
        /// So many boxes were evaluated.
        boxes: u64,
    },
    /// The limit was reached.
    Undecided {
        /// A point of the box where it was; an approximation.
        point: Point2,
        /// So many boxes were evaluated.
        boxes: u64,
    },
}

impl JacobianVerdict {
    /// How many boxes were evaluated.
    pub fn boxes(&self) -> u64 {
        match *self {
            Self::Positive { boxes, .. } | Self::Negative { boxes, .. } | Self::Undecided { boxes, .. } => boxes,
        }
    }
}

/// Bounds the Jacobian determinant of the mean value map that sends the vertices of a domain to `images`, both numbered
/// ring after ring, from below.
///
/// # Guarantee
/// [`JacobianVerdict::Positive`] is proved at every point of the open domain, up to vertices and edges, and in the limit
/// towards them. [`JacobianVerdict::Negative`] is proved at its point. Nothing depends on the number of threads.
///
/// # Errors
/// There are not as many images as vertices, or the triangles do not tile the domain. They only say in which pieces to prove; [`triangulate`](super::triangulate)
/// makes some.
///
/// # Complexity
/// Boxes times vertices, 0.1 to 0.2 µs each; boxes are some 80 to 170 for each vertex of a regular polygon when the map is near
/// a linear one.
///
/// # References
/// The determinant is that of Schneider 2017, section 4.5.3, who samples it. Charts and proof: `docs/theory/composite.md`.
///
/// ```
/// use homeo::composite::{JacobianLimits, JacobianVerdict, bound_jacobian, triangulate};
/// use homeo_core::planar::PlanarDomain;
/// let square = PlanarDomain::new(vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]]).unwrap();
/// let tiling = triangulate(&square).unwrap();
/// let limits = JacobianLimits { sharpness: 0.99, ..JacobianLimits::default() };
/// let bound = |images| bound_jacobian(&square, &tiling, images, &limits).unwrap();
/// let verdict = bound(&[[0.0, 0.0], [3.0, 0.0], [4.0, 2.0], [1.0, 2.0]]);
/// assert!(matches!(verdict, JacobianVerdict::Positive { least, .. } if least > 5.9 && least <= 6.0));
/// let verdict = bound(&[[0.0, 0.0], [1.0, 0.0], [0.1, 0.1], [0.0, 1.0]]);
/// assert!(matches!(verdict, JacobianVerdict::Negative { .. }));
/// assert!(bound_jacobian(&square, &tiling, &[[0.0, 0.0]], &limits).is_err(), "four images are needed");
/// ```
pub fn bound_jacobian(
    domain: &PlanarDomain,
    tiling: &Tiling,
    images: &[Point2],
    limits: &JacobianLimits,
) -> Result<JacobianVerdict, TriangulationError> {
    let vertices = domain.vertex_count();
    if images.len() != vertices {
        return Err(TriangulationError::OtherCount { vertices, images: images.len() });
    }
    check_tiling(domain, tiling)?;
    Ok(Step::new(domain, tiling, images.to_vec()).bound(limits, 0, &|| false).0)
}

/// Charts that are bounded before it is seen whether to go on: a fixed number, lest the answer depend on threads.
const CHUNK: usize = 16;
/// Where charts are sampled before anything is proved: `s` and `λ`.
const SAMPLES: [[f64; 2]; 5] = [[0.0, 0.0], [0.0, 1.0], [0.5, 0.4], [1.0, 0.0], [1.0, 1.0]];

/// What is known of a chart.
enum Outcome {
    Positive(f64),
    Negative([f64; 2]),
    Undecided([f64; 2]),
}

impl Step {
    /// See [`bound_jacobian`]. `is_cancelled` is asked now and then; what was not reached by then is undecided.
    ///
    /// Charts are bounded in chunks, that of number `first` before all others; also returned is which one ended the attempt.
    /// A step that failed there fails there again if it is shortened by too little.
    pub fn bound(
        &self,
        limits: &JacobianLimits,
        first: usize,
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> (JacobianVerdict, usize) {
        if let Some((point, at_most)) = self.sampled_fold() {
            return (JacobianVerdict::Negative { point, at_most, boxes: 0 }, first);
        }
        let (mut least, mut boxes) = (f64::INFINITY, 0);
        let chunks: Vec<&[Chart]> = self.charts.chunks(CHUNK).collect();
        let others = (0..chunks.len()).filter(|&number| number != first);
        for number in std::iter::once(first).filter(|&number| number < chunks.len()).chain(others) {
            let chunk = chunks[number];
            let bounded: Vec<_> = chunk.par_iter().map(|chart| self.bound_chart(chart, limits, is_cancelled)).collect();
            boxes += bounded.iter().map(|(_, boxes)| u64::from(*boxes)).sum::<u64>();
            for ((outcome, _), chart) in bounded.into_iter().zip(chunk) {
                match outcome {
                    Outcome::Positive(here) => least = least.min(here),
                    Outcome::Negative(at) => return (self.witnessed(chart, at, boxes), number),
                    Outcome::Undecided(at) => {
                        return (JacobianVerdict::Undecided { point: self.place(chart, at), boxes }, number);
                    }
                }
            }
        }
        (JacobianVerdict::Positive { least, boxes }, first)
    }

    /// An upper bound of the determinant at a point of the domain, if that is proved to be negative.
    pub fn fold_at(&self, point: Point2) -> Option<f64> {
        self.determinant_at(point).map(Form::high).filter(|&high| high < 0.0)
    }

    /// A point where the map is proved to fold, if one of some samples is such.
    fn sampled_fold(&self) -> Option<(Point2, f64)> {
        let worst_of = |chart: &Chart| {
            let mut frame = Frame::<f64>::new(self, chart);
            let sample = |at: [f64; 2]| (frame.evaluate(at[0], at[1], &Guide::NONE).determinant, at);
            SAMPLES.map(sample).into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let worst: Vec<_> = self.charts.par_iter().map(worst_of).collect();
        let folds = worst.into_iter().zip(&self.charts).filter_map(|(worst, chart)| Some((worst?, chart)));
        let ((value, at), chart) = folds.min_by(|a, b| a.0.0.total_cmp(&b.0.0))?;
        if value >= 0.0 {
            return None;
        }
        // Off the vertex, into the chart: still negative, unless it was hardly.
        let inside = [at[0].clamp(1e-6, 1.0 - 1e-6), at[1].clamp(1e-6, 1.0 - 1e-6)];
        self.proved_fold(chart, self.place(chart, inside))
    }

    /// The point, if it is inside the triangle of a chart, exactly, and the determinant is proved to be negative there.
    fn proved_fold(&self, chart: &Chart, point: Point2) -> Option<(Point2, f64)> {
        let [a, b, c] = chart.corners.map(|corner| self.corner(corner));
        let sign = orient2d(a, b, c);
        if [[a, b], [b, c], [c, a]].iter().any(|&[from, to]| orient2d(from, to, point) != sign) {
            return None;
        }
        Some((point, self.fold_at(point)?))
    }

    fn witnessed(&self, chart: &Chart, at: [f64; 2], boxes: u64) -> JacobianVerdict {
        let point = self.place(chart, at);
        match self.proved_fold(chart, point) {
            Some((point, at_most)) => JacobianVerdict::Negative { point, at_most, boxes },
            None => JacobianVerdict::Undecided { point, boxes },
        }
    }

    /// Bisects a chart until the determinant is bounded in each box.
    fn bound_chart(
        &self,
        chart: &Chart,
        limits: &JacobianLimits,
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> (Outcome, u32) {
        let mut frame = Frame::<Form>::new(self, chart);
        let mut waiting = vec![[[0.0, 1.0], [0.0, 1.0]]];
        let (mut least, mut boxes) = (f64::INFINITY, 0);
        while let Some(sides) = waiting.pop() {
            let [s, lambda] = sides.map(|[low, high]: [f64; 2]| 0.5 * (low + high));
            if boxes == limits.boxes_per_chart || boxes % 256 == 255 && is_cancelled() {
                return (Outcome::Undecided([s, lambda]), boxes);
            }
            boxes += 1;
            let at = [0, 1].map(|axis| Form::between(sides[axis][0], sides[axis][1]).along(axis));
            let guide = frame.guide(s, lambda);
            let determinant = frame.evaluate(at[0], at[1], &guide).determinant;
            let (low, high) = (determinant.low(), determinant.high());
            if low > 0.0 && low >= limits.sharpness * high {
                least = least.min(low);
            } else if high < 0.0 {
                return (Outcome::Negative([s, lambda]), boxes);
            } else {
                let axis = frame.longer_side(sides, &guide);
                for half in [[s, lambda][axis], sides[axis][1]].into_iter().zip([sides[axis][0], [s, lambda][axis]]) {
                    let mut part = sides;
                    part[axis] = [half.1, half.0];
                    waiting.push(part);
                }
            }
        }
        (Outcome::Positive(least), boxes)
    }

    /// Where a point of a chart is, rounded.
    pub fn place(&self, chart: &Chart, [s, lambda]: [f64; 2]) -> Point2 {
        let [v, from, to] = chart.corners.map(|corner| self.corner(corner));
        let [a, b, c] = chart.part.factors().map(|[above, below]| above / below);
        std::array::from_fn(|k| {
            let (side, other) = (from[k] - v[k], to[k] - v[k]);
            v[k] + s * (a * side + lambda * ((b - a) * side + c * other))
        })
    }
}

impl Frame<'_, Form> {
    /// Along which of `s` and `λ` a box is longer, in lengths that matter: those in the plane against the distance of the
    /// nearest vertex, and the angle at `v`.
    fn longer_side(&self, sides: [[f64; 2]; 2], guide: &Guide) -> usize {
        let [from, across] = self.axes.map(|axis| axis.map(|c| c.middle));
        let lambda = 0.5 * (sides[1][0] + sides[1][1]);
        let length = (from[0] + lambda * across[0]).hypot(from[1] + lambda * across[1]);
        let width = across[0].hypot(across[1]) * (sides[1][1] - sides[1][0]);
        let along = length * (sides[0][1] - sides[0][0]) / guide.nearest;
        // Directions matter at a vertex only.
        let turned = if self.apex().is_some() { width / length } else { 0.0 };
        usize::from((sides[0][1] * width / guide.nearest).max(turned) > along)
    }
}
