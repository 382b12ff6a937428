//! Frames in one file.

use std::time::Duration;

use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, DynamicImage, Frame};

use crate::failure::{Failure, Result};

fn failed(what: impl std::fmt::Display) -> Failure {
    Failure::limits("cannot-write", what.to_string())
}

/// An animated GIF that runs for ever: 256 colours, pixels seen or not.
pub fn gif(frames: Vec<DynamicImage>, delay: Duration) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = GifEncoder::new_with_speed(&mut bytes, 10);
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    let delay = Delay::from_saturating_duration(delay);
    encoder
        .encode_frames(frames.into_iter().map(|frame| Frame::from_parts(frame.into_rgba8(), 0, 0, delay)))
        .map_err(failed)?;
    drop(encoder);
    Ok(bytes)
}

/// An animated PNG that runs for ever, with the colours and bits of its frames.
pub fn png(frames: &[DynamicImage], delay: Duration) -> Result<Vec<u8>> {
    let Some(first) = frames.first() else { return Err(Failure::bug("an animation without frames")) };
    let (colours, bits) = match first.color() {
        image::ColorType::La8 => (png::ColorType::GrayscaleAlpha, png::BitDepth::Eight),
        image::ColorType::La16 => (png::ColorType::GrayscaleAlpha, png::BitDepth::Sixteen),
        image::ColorType::Rgba16 => (png::ColorType::Rgba, png::BitDepth::Sixteen),
        _ => (png::ColorType::Rgba, png::BitDepth::Eight),
    };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, first.width(), first.height());
    encoder.set_color(colours);
    encoder.set_depth(bits);
    encoder.set_animated(frames.len() as u32, 0).map_err(failed)?;
    encoder.set_frame_delay(delay.as_millis().min(65_535) as u16, 1000).map_err(failed)?;
    let mut writer = encoder.write_header().map_err(failed)?;
    for frame in frames {
        writer.write_image_data(&samples(frame, bits)).map_err(failed)?;
    }
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// Samples as PNG has them: the high byte first.
fn samples(frame: &DynamicImage, bits: png::BitDepth) -> Vec<u8> {
    let bytes = frame.as_bytes();
    if bits == png::BitDepth::Eight {
        return bytes.to_vec();
    }
    bytes.as_chunks::<2>().0.iter().flat_map(|&pair| u16::from_ne_bytes(pair).to_be_bytes()).collect()
}
