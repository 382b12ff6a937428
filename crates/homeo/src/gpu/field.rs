//! Pictures sampled where a field says.

use std::ops::Range;

use rayon::prelude::*;

use super::device::{CHANGED, FETCHED, Gpu, MOST_IN_PASS, PARAMETERS, READ};
use super::error::GpuError;
use crate::warp::{Filter, Raster};

pub(super) const PROGRAM: &str = include_str!("field.wgsl");

/// Samples beyond an edge are those on it: origins farther out than this are as good as here.
const BEYOND: f32 = 8.0;
/// Stands for no origin: below what the program takes for one.
const NOWHERE: [f32; 2] = [-2000.0; 2];

impl Gpu {
    /// Applies a [`backward_field`](crate::warp::backward_field), as [`apply_field`](crate::warp::apply_field) does on the
    /// processor. Pixels whose origin is not finite become zero.
    ///
    /// # Guarantee
    /// None that is proved. Samples differ by no more than 1 of 255 from the processor's, tested; where the resulting opacity
    /// rounds to zero nothing is seen, and colours may be others.
    ///
    /// # Errors
    /// The picture has other samples than its size says; the device gives up.
    ///
    /// # Complexity
    /// 4 samples (linear), 16 (bicubic) or 36 (Lanczos) for each pixel on the device. The result is cut into tiles, until the
    /// part of the picture that each needs fits into a buffer: few for a field that is smooth, many for one that is random
    /// and a picture of more than 32 million pixels.
    ///
    /// ```
    /// use homeo::gpu::{Gpu, GpuError};
    /// use homeo::warp::{Filter, Raster};
    /// let picture = Raster { width: 2, height: 1, channels: 1, has_alpha: false, samples: vec![0u8, 200] };
    /// match Gpu::new() {
    ///     Ok(gpu) => {
    ///         let field = [[1.0, 0.5], [f32::NAN; 2]];
    ///         let result = gpu.apply_field(&picture, &field, 2, Filter::Linear)?;
    ///         assert_eq!(result.samples, [100, 0]);
    ///     }
    ///     Err(GpuError::NoAdapter(_)) => {} // no Vulkan driver on this machine
    ///     Err(error) => return Err(error),
    /// }
    /// # Ok::<(), GpuError>(())
    /// ```
    pub fn apply_field(
        &self,
        picture: &Raster<u8>,
        field: &[[f32; 2]],
        width: usize,
        filter: Filter,
    ) -> Result<Raster<u8>, GpuError> {
        check(picture)?;
        let height = field.len() / width.max(1);
        let mut warped = Raster::zero(width, height, picture.channels, picture.has_alpha);
        let sampling = Sampling { gpu: self, picture, field, width, filter };
        let mut open = vec![Rectangle { columns: 0..width, rows: 0..height }];
        self.guarded(|| {
            while let Some(tile) = open.pop() {
                if tile.area() > MOST_IN_PASS.min(self.most_bytes as usize / size_of::<[f32; 2]>()) {
                    open.extend(tile.halves());
                    continue;
                }
                // Without origins in it a tile stays zero.
                let Some(window) = sampling.window(&tile) else { continue };
                if window.area() as u64 * 4 > self.most_bytes {
                    open.extend(tile.halves());
                } else {
                    sampling.sample(&tile, &window, &mut warped)?;
                }
            }
            Ok(())
        })?;
        Ok(warped)
    }
}

fn check(picture: &Raster<u8>) -> Result<(), GpuError> {
    let &Raster { width, height, channels, ref samples, .. } = picture;
    let expected = width.checked_mul(height).and_then(|pixels| pixels.checked_mul(channels));
    // Beyond this columns have no exact number in f32.
    let is_small = width.max(height) < 1 << 23;
    if is_small && expected == Some(samples.len()) && !samples.is_empty() && channels <= 4 {
        return Ok(());
    }
    Err(GpuError::Picture { width, height, channels, samples: samples.len() })
}

/// Part of a picture.
#[derive(Clone, Debug)]
struct Rectangle {
    columns: Range<usize>,
    rows: Range<usize>,
}

impl Rectangle {
    fn area(&self) -> usize {
        self.columns.len() * self.rows.len()
    }

    /// Both halves, cut across the longer side.
    fn halves(self) -> [Self; 2] {
        let Self { columns, rows } = self;
        let cut = |range: Range<usize>| {
            let middle = range.start + range.len() / 2;
            [range.start..middle, middle..range.end]
        };
        if columns.len() > rows.len() {
            cut(columns).map(|columns| Self { columns, rows: rows.clone() })
        } else {
            cut(rows).map(|rows| Self { columns: columns.clone(), rows })
        }
    }
}

struct Sampling<'a> {
    gpu: &'a Gpu,
    picture: &'a Raster<u8>,
    field: &'a [[f32; 2]],
    width: usize,
    filter: Filter,
}

impl Sampling<'_> {
    /// Where a pixel comes from, moved near to the picture if it is far outside; `None` if it comes from nowhere.
    fn origin(&self, [x, y]: [f32; 2]) -> Option<[f32; 2]> {
        let near = |x: f32, size: usize| x.clamp(-BEYOND, size as f32 + BEYOND);
        let is_finite = x.is_finite() && y.is_finite();
        is_finite.then(|| [near(x, self.picture.width), near(y, self.picture.height)])
    }

    /// Origins of a row of a tile.
    fn row(&self, tile: &Rectangle, row: usize) -> &[[f32; 2]] {
        &self.field[row * self.width..][tile.columns.clone()]
    }

    /// The part of the picture that a tile needs; `None` if it needs nothing.
    fn window(&self, tile: &Rectangle) -> Option<Rectangle> {
        let bounds = |row: usize| {
            let origins = self.row(tile, row).iter().filter_map(|&origin| self.origin(origin));
            origins.fold(NOTHING, |bounds, [x, y]| both(bounds, [[x, y], [x, y]]))
        };
        let [low, high] = tile.rows.clone().into_par_iter().map(bounds).reduce(|| NOTHING, both);
        let reach = self.filter.width() as f32 / 2.0 + 1.0;
        let part = |axis: usize, size: usize| {
            let last = size - 1;
            // Conversions saturate at zero.
            let [low, high] = [(low[axis] - reach).floor(), (high[axis] + reach).ceil()].map(|x| x as usize);
            low.min(last)..high.min(last) + 1
        };
        let is_anything = low[0] <= high[0];
        is_anything.then(|| Rectangle { columns: part(0, self.picture.width), rows: part(1, self.picture.height) })
    }

    fn sample(&self, tile: &Rectangle, window: &Rectangle, warped: &mut Raster<u8>) -> Result<(), GpuError> {
        let gpu = self.gpu;
        let samples = self.samples(window);
        let nowhere = |&origin: &[f32; 2]| self.origin(origin).unwrap_or(NOWHERE);
        let rows = tile.rows.clone();
        let origins: Vec<[f32; 2]> = rows.flat_map(|row| self.row(tile, row).iter().map(nowhere)).collect();
        let parameters = self.parameters(tile, window);
        let bytes = |count: usize, each: usize| (count * each) as u64;
        let buffers = [
            gpu.buffer(bytes(parameters.len(), 4), PARAMETERS),
            gpu.buffer(bytes(samples.len(), 4), READ),
            gpu.buffer(bytes(origins.len(), 8), READ),
            gpu.buffer(bytes(origins.len(), 4), CHANGED),
        ];
        gpu.write(&buffers[0], &parameters);
        gpu.write(&buffers[1], &samples);
        gpu.write(&buffers[2], &origins);
        gpu.start(&gpu.field, &buffers.each_ref(), origins.len());
        let results = gpu.buffer(bytes(origins.len(), 4), FETCHED);
        gpu.fetch(&buffers[3], &results, origins.len(), |pixels: &[u32]| place(pixels, tile, warped))
    }

    /// In the order of the program.
    fn parameters(&self, tile: &Rectangle, window: &Rectangle) -> [u32; 12] {
        let opacity = if self.picture.has_alpha { self.picture.channels - 1 } else { 4 };
        let size = [self.picture.width, self.picture.height];
        let corner = [window.columns.start, window.rows.start];
        let part = [window.columns.len(), window.rows.len()];
        let numbers = [[tile.area(), self.filter.width()], [opacity, 0], size, corner, part, [0, 0]];
        let mut parameters = [0; 12];
        parameters.iter_mut().zip(numbers.as_flattened()).for_each(|(parameter, &number)| *parameter = number as u32);
        parameters
    }

    /// The pixels of a window, four bytes for each.
    fn samples(&self, window: &Rectangle) -> Vec<u32> {
        let channels = self.picture.channels;
        let mut words = vec![0; window.area()];
        let rows = words.par_chunks_mut(window.columns.len()).zip(window.rows.clone());
        rows.for_each(|(words, row)| {
            let first = (row * self.picture.width + window.columns.start) * channels;
            let pixels = self.picture.samples[first..].chunks_exact(channels);
            for (word, pixel) in words.iter_mut().zip(pixels) {
                let mut bytes = [0; 4];
                bytes[..channels].copy_from_slice(pixel);
                *word = u32::from_le_bytes(bytes);
            }
        });
        words
    }
}

type Bounds = [[f32; 2]; 2];

const NOTHING: Bounds = [[f32::INFINITY; 2], [f32::NEG_INFINITY; 2]];

/// Bounds of what both bound.
fn both([low, high]: Bounds, [other_low, other_high]: Bounds) -> Bounds {
    [[0, 1].map(|k| low[k].min(other_low[k])), [0, 1].map(|k| high[k].max(other_high[k]))]
}

/// Puts the pixels of a tile into a picture.
fn place(pixels: &[u32], tile: &Rectangle, warped: &mut Raster<u8>) {
    let (width, channels) = (warped.width, warped.channels);
    for (row, pixels) in tile.rows.clone().zip(pixels.chunks_exact(tile.columns.len())) {
        let first = (row * width + tile.columns.start) * channels;
        let samples = warped.samples[first..].chunks_exact_mut(channels);
        samples.zip(pixels).for_each(|(sample, pixel)| sample.copy_from_slice(&pixel.to_le_bytes()[..channels]));
    }
}
