//! One mean value map at points: in doubles, and as an enclosure.

use homeo_core::planar::Point2;

use super::chart::{Chart, Step};
use super::frame::{Frame, Local};
use super::guide::Guide;
use super::number::{Form, Number};
use super::vector::cross;

/// A box of the plane: ranges of both coordinates.
pub(crate) type Region = [Form; 2];

/// So many parts of a chart are enclosed each by itself where a box is as large as its distance from the vertex.
const DIRECTIONS: u32 = 32;

/// The derivative of a map at a point: rows are the gradients of the two coordinates.
pub type Jacobian = [[f64; 2]; 2];

impl Step {
    /// The chart of a point, and where in it; that of a nearby point of the domain for a point slightly outside.
    pub fn locate(&self, point: Point2) -> (&Chart, [f64; 2]) {
        let mut best = (f64::INFINITY, 0, [0.0; 2]);
        for (number, chart) in self.charts.iter().enumerate() {
            let [a, b] = self.coordinates(chart, point);
            // Zero and less inside: a from 0 to 1, b from 0 to a.
            let outside = (-b).max(b - a).max(a - 1.0).max(0.0);
            if outside < best.0 {
                best = (outside, number, [a, b]);
            }
        }
        let (_, number, [a, b]) = best;
        let s = a.clamp(0.0, 1.0);
        let lambda = if a > 0.0 { (b / a).clamp(0.0, 1.0) } else { 0.0 };
        (&self.charts[number], [s, lambda])
    }

    /// `s` and `s λ` of a point, rounded.
    fn coordinates(&self, chart: &Chart, point: Point2) -> [f64; 2] {
        let [v, p, q] = chart.corners.map(|corner| self.corner(corner));
        let side = [p[0] - v[0], p[1] - v[1]];
        let other = [q[0] - v[0], q[1] - v[1]];
        let offset = [point[0] - v[0], point[1] - v[1]];
        let turn = cross(side, other);
        // The offset is s (a side + λ ((b - a) side + c other)).
        let (along, across) = (cross(offset, other) / turn, cross(side, offset) / turn);
        let [a, b, c] = chart.part.factors().map(|[above, below]| above / below);
        let there = across / c;
        [(along - (b - a) * there) / a, there]
    }

    /// A point of the domain near a point, but for rounding.
    pub(super) fn nearby(&self, point: Point2) -> Point2 {
        let (chart, at) = self.locate(point);
        self.place(chart, at)
    }

    /// A point inside the domain near a point.
    pub(super) fn centre_near(&self, point: Point2) -> Point2 {
        let (chart, _) = self.locate(point);
        self.place(chart, [0.5, 0.5])
    }

    /// Image of a point, and the derivative there; at a vertex the derivative along one chart.
    pub fn value(&self, point: Point2) -> (Point2, Jacobian) {
        let (chart, [s, lambda]) = self.locate(point);
        let mut frame = Frame::<f64>::new(self, chart);
        let local = frame.evaluate(s, lambda, &Guide::NONE);
        (local.image, derivative(&local))
    }

    /// Calls `each` with the parts of all charts that a region may meet.
    fn meet(&self, at: Region, mut each: impl FnMut(&mut Frame<Form>, [Form; 2])) {
        for chart in &self.charts {
            // Quickly first, with room for rounding.
            let corners = chart.corners.map(|corner| self.corner(corner));
            let is_apart = |k: usize| {
                let (low, high) = (at[k].low(), at[k].high());
                corners.iter().all(|corner| corner[k] < low) || corners.iter().all(|corner| corner[k] > high)
            };
            if is_apart(0) || is_apart(1) {
                continue;
            }
            let mut frame = Frame::<Form>::new(self, chart);
            let Some([s, lambda]) = part_of_chart(frame.coordinates(at)) else { continue };
            // Where the box is large as seen from the vertex, directions are taken one after the other.
            if lambda.radius() <= 0.5 / f64::from(DIRECTIONS) {
                each(&mut frame, [s.along(0), lambda.along(1)]);
                continue;
            }
            let (low, width) = (lambda.low(), 2.0 * lambda.radius() / f64::from(DIRECTIONS));
            for part in 0..DIRECTIONS {
                let from = low + width * f64::from(part);
                // Overlapping, so that rounding leaves nothing out.
                let lambda = Form::between((from - 1e-9).max(0.0), (from + width + 1e-9).min(1.0));
                each(&mut frame, [s.along(0), lambda.along(1)]);
            }
        }
    }

    /// A box that holds the images of all points of the closed domain in a box; unknown where that is too large.
    pub fn enclose(&self, at: Region) -> Region {
        let mut hull: Option<Region> = None;
        self.meet(at, |frame, sides| {
            let guide = frame.guide(sides[0].middle, sides[1].middle);
            let image = frame.evaluate(sides[0], sides[1], &guide).image.map(Form::range);
            hull = Some(hull.map_or(image, |hull| [hull[0].hull(image[0]), hull[1].hull(image[1])]));
        });
        hull.unwrap_or([Form::UNKNOWN; 2])
    }

    /// An enclosure of the determinant at a point, if it lies in the domain, off its boundary.
    pub(super) fn determinant_at(&self, point: Point2) -> Option<Form> {
        let mut found: Option<Form> = None;
        self.meet(point.map(Form::of), |frame, sides| {
            let guide = frame.guide(sides[0].middle, sides[1].middle);
            let here = frame.evaluate(sides[0], sides[1], &guide).determinant.range();
            found = Some(found.map_or(here, |found| found.hull(here)));
        });
        found
    }

    /// How much faster than the image a point may move within a box, at most: a bound of the norm of the inverse of the
    /// derivative; NaN if there is none.
    pub(super) fn inverse_rate(&self, at: Region) -> f64 {
        let mut rate = 0.0;
        self.meet(at, |frame, sides| {
            let guide = frame.guide(sides[0].middle, sides[1].middle);
            let here = inverse_norm(&frame.evaluate(sides[0], sides[1], &guide));
            rate = if here > rate || here.is_nan() { here } else { rate };
        });
        rate
    }
}

/// Which part of a chart may have these coordinates `s` and `s λ`; `None` if surely none.
fn part_of_chart([a, b]: [Form; 2]) -> Option<[Form; 2]> {
    let behind = (b - a).low();
    if a.low() > 1.0 || a.high() < 0.0 || b.high() < 0.0 || behind > 0.0 {
        return None;
    }
    let s = a.meet(0.0, 1.0);
    let lambda = b / a;
    let whole = Form::between(0.0, 1.0);
    let is_small = lambda.radius() < 0.5 && lambda.low() <= 1.0 && lambda.high() >= 0.0;
    Some([s, if is_small { lambda.meet(0.0, 1.0) } else { whole }])
}

/// The derivative in the plane: it takes the axes of the chart to the columns.
fn derivative(local: &Local<f64>) -> Jacobian {
    let ([along, across], turn) = (local.axes, local.turn);
    let [first, second] = local.columns;
    std::array::from_fn(|k| {
        [(first[k] * across[1] - second[k] * along[1]) / turn, (second[k] * along[0] - first[k] * across[0]) / turn]
    })
}

/// An upper bound of the norm of the inverse of the derivative.
fn inverse_norm(local: &Local<Form>) -> f64 {
    let ([along, across], turn) = (local.axes, local.turn);
    let [first, second] = local.columns;
    let mut squares = 0.0;
    for k in 0..2 {
        let x = (first[k] * across[1] - second[k] * along[1]) / turn;
        let y = (second[k] * along[0] - first[k] * across[0]) / turn;
        squares += x.size() * x.size() + y.size() * y.size();
    }
    let least = local.determinant.low();
    if least > 0.0 { squares.sqrt() / least * (1.0 + 1e-12) } else { f64::NAN }
}
