//! Where the search looks at the determinant: in all charts of the source.

use homeo_core::planar::Point2;

use crate::composite::chart::{Chart, Step};
use crate::composite::frame::Frame;
use crate::composite::guide::Guide;

/// A point, by the coordinates of its chart.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub chart: &'a Chart,
    pub at: [f64; 2],
}

/// Parts of both sides of a chart.
pub(super) type Density = [usize; 2];

/// Enough to begin with: towards the apex, and at the far side.
pub(super) const COARSE: Density = [1, 1];
/// To see what was missed.
pub(super) const FINE: Density = [4, 8];

impl<'a> Place<'a> {
    /// Of a point of the source.
    pub fn of(step: &'a Step, point: Point2) -> Self {
        let (chart, at) = step.locate(point);
        Self { chart, at }
    }

    /// In the plane, rounded.
    pub fn point(&self, step: &Step) -> Point2 {
        step.place(self.chart, self.at)
    }

    /// The determinant there, rounded.
    pub fn determinant(&self, step: &Step) -> f64 {
        Frame::<f64>::new(step, self.chart).evaluate(self.at[0], self.at[1], &Guide::NONE).determinant
    }
}

/// Places of a chart; denser towards a vertex.
pub(super) fn places(chart: &Chart, [radial, across]: Density) -> impl Iterator<Item = Place<'_>> {
    (0..=radial).flat_map(move |k| {
        let s = (k as f64 / radial as f64).powi(2);
        (0..=across).map(move |l| Place { chart, at: [s, l as f64 / across as f64] })
    })
}
