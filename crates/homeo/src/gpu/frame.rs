//! The frame in which a map is computed in single precision.

use homeo_core::planar::{PlanarDomain, Point2};

/// Places are split at multiples of one part in so many; the programs say the same.
const GRID: f64 = 4096.0;

/// A square about all domains of a map, in which coordinates run from -1 to 1.
///
/// A place is a multiple of `1 / 4096` and a remainder of up to half of that. Differences of the first are exact in f32, and
/// remainders are known to `2^-37`: vectors between places keep 24 digits even if they are as short as `2^-13`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    centre: Point2,
    /// Half the side of the square.
    half: f64,
}

impl Frame {
    /// The least frame about domains.
    pub fn about(domains: &[PlanarDomain]) -> Self {
        let bounds = || domains.iter().map(PlanarDomain::bounds);
        let low = [0, 1].map(|k| bounds().map(|[low, _]| low[k]).fold(f64::INFINITY, f64::min));
        let high = [0, 1].map(|k| bounds().map(|[_, high]| high[k]).fold(f64::NEG_INFINITY, f64::max));
        let half = [0, 1].map(|k| 0.5 * high[k] - 0.5 * low[k]);
        Self { centre: [0, 1].map(|k| 0.5 * high[k] + 0.5 * low[k]), half: half[0].max(half[1]) }
    }

    /// Half the side of the square, in the unit of the domains.
    pub fn half(&self) -> f64 {
        self.half
    }

    /// A place: both coordinates' multiples, then both remainders.
    pub fn split(&self, point: Point2) -> [f32; 4] {
        let local = [0, 1].map(|k| (point[k] - self.centre[k]) / self.half);
        let grid = local.map(|x| (x * GRID).round() / GRID);
        [grid[0] as f32, grid[1] as f32, (local[0] - grid[0]) as f32, (local[1] - grid[1]) as f32]
    }

    /// The point at a place.
    pub fn join(&self, place: [f32; 4]) -> Point2 {
        [0, 1].map(|k| self.centre[k] + self.half * (f64::from(place[k]) + f64::from(place[k + 2])))
    }

    /// A displacement in the frame.
    pub fn scaled(&self, way: Point2) -> [f32; 2] {
        way.map(|x| (x / self.half) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_kept_to_the_digits_stated() {
        let square = vec![vec![[1e6, -3.0], [1e6 + 7.0, -3.0], [1e6 + 7.0, 4.0], [1e6, 4.0]]];
        let frame = Frame::about(&[PlanarDomain::new(square).unwrap()]);
        assert_eq!((frame.centre, frame.half), ([1e6 + 3.5, 0.5], 3.5));
        let (mut farthest, mut with_one_part) = (0.0, 0.0);
        for k in 0..1000 {
            let point = [1e6 + 7.0 * f64::from(k) / 1000.0, -3.0 + 7.0 * f64::from(k * k % 1000) / 1000.0];
            let place = frame.split(point);
            assert!(place[2].abs().max(place[3].abs()) <= 0.5 / 4096.0);
            let miss = |back: Point2| (back[1] - point[1]).abs() / frame.half;
            farthest = f64::max(farthest, miss(frame.join(place)));
            with_one_part =
                f64::max(with_one_part, miss(frame.join([place[0] + place[2], place[1] + place[3], 0.0, 0.0])));
        }
        // The bound is met, and it is one that a single f32 does not meet.
        assert!(farthest <= 2f64.powi(-37) && with_one_part > 2f64.powi(-37), "{farthest:e} {with_one_part:e}");
    }
}
