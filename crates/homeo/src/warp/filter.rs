//! Sampling pictures between their pixels.

use homeo_core::planar::Point2;

use super::{Raster, Sample};

/// How a picture is read between its pixels. None of them averages over many: where a map shrinks a picture a lot, make
/// the result larger and scale it down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// Linear in both directions.
    Linear,
    /// Cubic in both directions (Catmull-Rom).
    #[default]
    Bicubic,
    /// Lanczos with three lobes.
    Lanczos,
}

/// The most samples in one direction.
const WIDEST: usize = 6;

impl Filter {
    /// How many samples it takes in one direction.
    pub(crate) fn width(self) -> usize {
        match self {
            Self::Linear => 2,
            Self::Bicubic => 4,
            Self::Lanczos => WIDEST,
        }
    }

    /// Weights of the samples round a place that is `t` of the way from one to the next; their sum is 1.
    fn weights(self, t: f32) -> [f32; WIDEST] {
        match self {
            Self::Linear => [1.0 - t, t, 0.0, 0.0, 0.0, 0.0],
            Self::Bicubic => {
                let (t2, t3) = (t * t, t * t * t);
                let first = -0.5 * t3 + t2 - 0.5 * t;
                let second = 1.5 * t3 - 2.5 * t2 + 1.0;
                let third = -1.5 * t3 + 2.0 * t2 + 0.5 * t;
                [first, second, third, 0.5 * (t3 - t2), 0.0, 0.0]
            }
            Self::Lanczos => {
                let all: [f32; WIDEST] = std::array::from_fn(|k| lanczos(t + 2.0 - k as f32));
                let sum: f32 = all.iter().sum();
                all.map(|w| w / sum)
            }
        }
    }

    /// The picture at a pixel coordinate; beyond its edges it goes on as it ends. Colours count by their opacity.
    pub fn sample<T: Sample>(self, picture: &Raster<T>, [x, y]: Point2, pixel: &mut [T]) {
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let across = self.weights((x - left) as f32);
        let down = self.weights((y - top) as f32);
        let width = self.width();
        let before = width as i64 / 2 - 1;
        // Far outside of any picture all is alike.
        let [left, top] = [left, top].map(|c| c.clamp(-1e15, 1e15) as i64 - before);
        let mut sum = [0.0f32; 4];
        let last = picture.channels - 1;
        for (j, &weight_down) in down[..width].iter().enumerate() {
            for (i, &weight) in across[..width].iter().enumerate() {
                let samples = picture.pixel(left + i as i64, top + j as i64);
                let mut weight = weight * weight_down;
                if picture.has_alpha {
                    weight *= samples[last].value();
                    sum[last] += weight;
                    samples[..last].iter().zip(&mut sum).for_each(|(s, sum)| *sum += weight * s.value());
                } else {
                    samples.iter().zip(&mut sum).for_each(|(s, sum)| *sum += weight * s.value());
                }
            }
        }
        if picture.has_alpha {
            let opacity = sum[last];
            let scale = if opacity > 0.0 { 1.0 / opacity } else { 0.0 };
            sum[..last].iter_mut().for_each(|x| *x *= scale);
        }
        pixel.iter_mut().zip(sum).for_each(|(sample, value)| *sample = T::nearest(value));
    }
}

/// The windowed sinc with three lobes.
fn lanczos(x: f32) -> f32 {
    let pi = std::f32::consts::PI * x;
    if x.abs() < 1e-4 {
        1.0
    } else if x.abs() >= 3.0 {
        0.0
    } else {
        3.0 * pi.sin() * (pi / 3.0).sin() / (pi * pi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Filter; 3] = [Filter::Linear, Filter::Bicubic, Filter::Lanczos];

    /// A picture with a slope in each of three channels, and opacity.
    fn slope(opacity: u16) -> Raster<u16> {
        let mut picture = Raster::zero(20, 16, 4, true);
        for (k, pixel) in picture.samples.chunks_exact_mut(4).enumerate() {
            let (x, y) = (k % 20, k / 20);
            pixel.copy_from_slice(&[1000 * x as u16, 2000 * y as u16, 30000, opacity]);
        }
        picture
    }

    #[test]
    fn pixels_keep_their_values_at_their_centres() {
        let picture = slope(65535);
        for filter in ALL {
            let mut pixel = [0; 4];
            filter.sample(&picture, [7.5, 9.5], &mut pixel);
            assert_eq!(pixel, [7000, 18000, 30000, 65535], "{filter:?}");
        }
    }

    #[test]
    fn slopes_are_read_between_pixels() {
        let picture = slope(40000);
        for (filter, error) in [(Filter::Linear, 1), (Filter::Bicubic, 1), (Filter::Lanczos, 120)] {
            let mut pixel = [0; 4];
            filter.sample(&picture, [7.8, 9.1], &mut pixel);
            for (found, expected) in pixel.into_iter().zip([7300u16, 17200, 30000, 40000]) {
                assert!(found.abs_diff(expected) <= error, "{filter:?}: {pixel:?}");
            }
        }
    }

    #[test]
    fn what_is_transparent_has_no_colour() {
        let mut picture = slope(65535);
        // Right of column 10 nothing is to be seen, but there are colours.
        for (k, pixel) in picture.samples.chunks_exact_mut(4).enumerate() {
            if k % 20 > 10 {
                pixel.copy_from_slice(&[65535, 65535, 65535, 0]);
            }
        }
        let mut pixel = [0; 4];
        Filter::Linear.sample(&picture, [11.0, 8.5], &mut pixel);
        assert_eq!(pixel, [10000, 16000, 30000, 32768]);
    }

    #[test]
    fn weights_add_up_to_one() {
        for filter in ALL {
            for k in 0..10 {
                let sum: f32 = filter.weights(k as f32 / 10.0).iter().sum();
                assert!((sum - 1.0).abs() < 1e-6, "{filter:?}");
            }
        }
    }
}
