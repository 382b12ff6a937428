//! Pictures as arrays of samples.

/// A sample of one channel: `u8` or `u16`.
pub trait Sample: Copy + Default + Send + Sync {
    /// The largest value.
    const MOST: f32;
    /// As a number from 0 to [`MOST`](Self::MOST).
    fn value(self) -> f32;
    /// The nearest sample; what is out of range becomes the end of the range.
    fn nearest(value: f32) -> Self;
}

impl Sample for u8 {
    const MOST: f32 = 255.0;
    fn value(self) -> f32 {
        f32::from(self)
    }
    fn nearest(value: f32) -> Self {
        (value + 0.5) as Self // saturates
    }
}

impl Sample for u16 {
    const MOST: f32 = 65535.0;
    fn value(self) -> f32 {
        f32::from(self)
    }
    fn nearest(value: f32) -> Self {
        (value + 0.5) as Self // saturates
    }
}

/// A picture: rows from above, pixels from the left, channels together.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster<T> {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Samples of a pixel: 1 to 4.
    pub channels: usize,
    /// Whether the last channel is opacity. Colours are not multiplied by it.
    pub has_alpha: bool,
    /// All samples.
    pub samples: Vec<T>,
}

impl<T: Sample> Raster<T> {
    /// A picture of zeros.
    pub fn zero(width: usize, height: usize, channels: usize, has_alpha: bool) -> Self {
        Self { width, height, channels, has_alpha, samples: vec![T::default(); width * height * channels] }
    }

    /// The samples of a pixel; the nearest one for a place outside.
    pub(super) fn pixel(&self, x: i64, y: i64) -> &[T] {
        let column = x.clamp(0, self.width as i64 - 1) as usize;
        let row = y.clamp(0, self.height as i64 - 1) as usize;
        let first = (row * self.width + column) * self.channels;
        &self.samples[first..first + self.channels]
    }
}
