//! Warping images by maps between planar domains (Schneider 2017, chapter 8).
//!
//! Every pixel of the result asks the inverse map where it comes from, and the picture is sampled there. A map that is
//! one-to-one shows every part of the picture inside the source exactly once: nothing folds, nothing is lost.

mod filter;
mod raster;

pub use filter::Filter;
pub use raster::{Raster, Sample};

use homeo_core::planar::{PlanarDomain, Point2};
use rayon::prelude::*;

use crate::map::PlanarBijection;
use crate::progress::Progress;

/// Where pixels lie in the plane of the domains: pixel coordinates run right and down from the upper left corner, whose
/// pixel has its centre at `(0.5, 0.5)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The pixel coordinates of the domains' origin.
    pub origin: Point2,
    /// Pixels for one unit of the domains.
    pub scale: f64,
    /// Whether the second coordinate of the domains grows upwards, against that of the pixels.
    pub is_upwards: bool,
}

impl Placement {
    /// Puts domains into the middle of a picture, as large as they fit, upwards.
    ///
    /// ```
    /// use homeo::warp::Placement;
    /// use homeo_core::planar::PlanarDomain;
    /// let triangle = vec![vec![[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]]];
    /// let domain = PlanarDomain::new(triangle).unwrap();
    /// let placement = Placement::fit(&[&domain], 200, 200);
    /// assert_eq!((placement.scale, placement.origin), (100.0, [0.0, 150.0]));
    /// ```
    pub fn fit(domains: &[&PlanarDomain], width: usize, height: usize) -> Self {
        let bounds = || domains.iter().map(|domain| domain.bounds());
        let low = [0, 1].map(|axis| bounds().map(|[low, _]| low[axis]).fold(f64::INFINITY, f64::min));
        let high = [0, 1].map(|axis| bounds().map(|[_, high]| high[axis]).fold(f64::NEG_INFINITY, f64::max));
        let size = [width as f64, height as f64];
        let scale = (size[0] / (high[0] - low[0])).min(size[1] / (high[1] - low[1]));
        let middle = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
        Self { origin: [0.5 * size[0] - scale * middle[0], 0.5 * size[1] + scale * middle[1]], scale, is_upwards: true }
    }

    fn down(&self) -> f64 {
        if self.is_upwards { -1.0 } else { 1.0 }
    }

    /// The point of the domains' plane at a pixel coordinate.
    pub fn to_plane(&self, [x, y]: Point2) -> Point2 {
        [(x - self.origin[0]) / self.scale, self.down() * (y - self.origin[1]) / self.scale]
    }

    /// The pixel coordinate of a point of the domains' plane.
    pub fn to_pixels(&self, [x, y]: Point2) -> Point2 {
        [self.origin[0] + self.scale * x, self.origin[1] + self.down() * self.scale * y]
    }
}

/// Where the pixels of a warped picture come from: pixel coordinates in the source, row by row; `NaN` for pixels outside
/// the target. This is what `remap` functions of image libraries take.
///
/// # Complexity
/// A walk of a few triangles for each pixel of a [`HarmonicMap`](crate::map::HarmonicMap); parallel over rows.
pub fn backward_field(map: &dyn PlanarBijection, placement: &Placement, width: usize, height: usize) -> Vec<[f32; 2]> {
    let mut field = vec![[f32::NAN; 2]; width * height];
    field.par_chunks_mut(width.max(1)).enumerate().for_each(|(row, pixels)| {
        for (pixel, point) in pixels.iter_mut().zip(origins(map, placement, row, width)) {
            if let Some(point) = point {
                *pixel = placement.to_pixels(point).map(|x| x as f32);
            }
        }
    });
    field
}

/// Where the pixels of a row come from, in the plane of the domains.
fn origins(map: &dyn PlanarBijection, placement: &Placement, row: usize, width: usize) -> Vec<Option<Point2>> {
    let points: Vec<Point2> =
        (0..width).map(|column| placement.to_plane([column as f64 + 0.5, row as f64 + 0.5])).collect();
    let mut found = vec![None; width];
    map.inverse_along(&points, &mut found);
    found
}

/// The warped picture, of the same size; pixels outside the target become zero in all channels. `None` when asked to stop.
///
/// Give a picture with alpha, so that zero means transparent.
///
/// # Complexity
/// As for [`backward_field`], and 4 samples (linear), 16 (bicubic) or 36 (Lanczos) for each pixel and channel. Memory for
/// source and result only.
pub fn warp_image<T: Sample>(
    map: &dyn PlanarBijection,
    picture: &Raster<T>,
    placement: &Placement,
    filter: Filter,
    progress: &(impl Progress + Sync),
) -> Option<Raster<T>> {
    let (width, channels) = (picture.width, picture.channels);
    let mut warped = Raster::zero(width, picture.height, channels, picture.has_alpha);
    warped.samples.par_chunks_mut((width * channels).max(1)).enumerate().for_each(|(row, pixels)| {
        if progress.is_cancelled() {
            return;
        }
        let origins = origins(map, placement, row, width);
        for (pixel, origin) in pixels.chunks_exact_mut(channels.max(1)).zip(origins) {
            if let Some(origin) = origin {
                filter.sample(picture, placement.to_pixels(origin), pixel);
            }
        }
    });
    (!progress.is_cancelled()).then_some(warped)
}

/// Applies a [`backward_field`] that is known already. Pixels whose origin is not finite become zero.
pub fn apply_field<T: Sample>(picture: &Raster<T>, field: &[[f32; 2]], width: usize, filter: Filter) -> Raster<T> {
    let (height, channels) = (field.len() / width.max(1), picture.channels);
    let mut warped = Raster::zero(width, height, channels, picture.has_alpha);
    let rows = warped.samples.par_chunks_mut((width * channels).max(1)).zip(field.par_chunks(width.max(1)));
    rows.for_each(|(pixels, origins)| {
        for (pixel, origin) in pixels.chunks_exact_mut(channels.max(1)).zip(origins) {
            if origin.iter().all(|x| x.is_finite()) {
                filter.sample(picture, origin.map(f64::from), pixel);
            }
        }
    });
    warped
}
