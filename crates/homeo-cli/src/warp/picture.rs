//! Pictures from files and into them.

use std::io::{BufReader, BufWriter, Cursor};
use std::path::Path;

use homeo::map::PlanarBijection;
use homeo::progress::Progress;
use homeo::warp::{Filter, Placement, Raster, Sample, warp_image};
use image::{ColorType, DynamicImage, ImageFormat, ImageReader, Limits};

use crate::failure::{Failure, Result};
use crate::outputs::Outputs;
use crate::session::Session;

/// Pixels that a picture may have at most: what their decoding needs stays below the usual memory.
const MOST_BYTES: u64 = 16 << 30;

/// A picture with opacity.
pub enum Picture {
    Bytes(Raster<u8>),
    Words(Raster<u16>),
}

/// Whether this is the name of a picture.
pub fn is_picture(path: &Path) -> bool {
    ImageFormat::from_path(path).is_ok_and(|format| matches!(format, ImageFormat::Png | ImageFormat::Jpeg))
}

/// Reads a picture; opacity is added where it has none.
pub fn read(path: &Path) -> Result<Picture> {
    let wrong = |what: String| Failure::input("unreadable-picture", format!("{}: {what}", path.display()));
    let file = std::fs::File::open(path)
        .map_err(|e| Failure::input("cannot-open", format!("{} cannot be read: {e}", path.display())))?;
    let mut reader = ImageReader::new(BufReader::new(file)).with_guessed_format().map_err(|e| wrong(e.to_string()))?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(MOST_BYTES);
    reader.limits(limits);
    let image = reader.decode().map_err(|e| wrong(e.to_string()))?;
    Ok(match image.color() {
        ColorType::L8 | ColorType::La8 => Picture::Bytes(raster(&image, 2, image.to_luma_alpha8().into_raw())),
        ColorType::L16 | ColorType::La16 => Picture::Words(raster(&image, 2, image.to_luma_alpha16().into_raw())),
        ColorType::Rgb16 | ColorType::Rgba16 => Picture::Words(raster(&image, 4, image.to_rgba16().into_raw())),
        _ => Picture::Bytes(raster(&image, 4, image.to_rgba8().into_raw())),
    })
}

fn raster<T>(image: &DynamicImage, channels: usize, samples: Vec<T>) -> Raster<T> {
    Raster { width: image.width() as usize, height: image.height() as usize, channels, has_alpha: true, samples }
}

impl Picture {
    /// Width and height.
    pub fn size(&self) -> [usize; 2] {
        match self {
            Self::Bytes(raster) => [raster.width, raster.height],
            Self::Words(raster) => [raster.width, raster.height],
        }
    }

    /// Bits of a sample.
    pub fn bits(&self) -> u32 {
        if matches!(self, Self::Bytes(_)) { 8 } else { 16 }
    }

    /// The warped picture.
    pub fn warped(
        &self,
        map: &dyn PlanarBijection,
        placement: &Placement,
        filter: Filter,
        progress: &(impl Progress + Sync),
    ) -> Option<Self> {
        Some(match self {
            Self::Bytes(raster) => Self::Bytes(warp_image(map, raster, placement, filter, progress)?),
            Self::Words(raster) => Self::Words(warp_image(map, raster, placement, filter, progress)?),
        })
    }

    /// Writes it.
    pub fn stage(self, session: &Session, path: &Path, outputs: &mut Outputs) -> Result<()> {
        let format = ImageFormat::from_path(path)
            .map_err(|_| Failure::usage(format!("{}: pictures are .png or .jpg", path.display())))?;
        let image = self.into_image(format)?;
        outputs.stage(session, path, |out: &mut BufWriter<_>| {
            let mut bytes = Cursor::new(Vec::new());
            image.write_to(&mut bytes, format).map_err(|e| e.to_string())?;
            std::io::Write::write_all(out, bytes.get_ref()).map_err(|e| e.to_string())
        })?;
        Ok(())
    }

    /// For a format. JPEG has no opacity and 8 bits: the picture is laid on white.
    pub fn into_image(self, format: ImageFormat) -> Result<DynamicImage> {
        let image = match (format, self) {
            (ImageFormat::Jpeg, Self::Bytes(raster)) => on_white(&raster),
            (ImageFormat::Jpeg, Self::Words(raster)) => on_white(&raster),
            (_, Self::Bytes(raster)) => bytes_image(raster),
            (_, Self::Words(raster)) => words_image(raster),
        };
        image.ok_or_else(|| Failure::bug("a picture has another size than its samples"))
    }
}

fn bytes_image(raster: Raster<u8>) -> Option<DynamicImage> {
    let (w, h) = (raster.width as u32, raster.height as u32);
    match raster.channels {
        2 => image::GrayAlphaImage::from_raw(w, h, raster.samples).map(DynamicImage::ImageLumaA8),
        _ => image::RgbaImage::from_raw(w, h, raster.samples).map(DynamicImage::ImageRgba8),
    }
}

fn words_image(raster: Raster<u16>) -> Option<DynamicImage> {
    let (w, h) = (raster.width as u32, raster.height as u32);
    match raster.channels {
        2 => image::ImageBuffer::from_raw(w, h, raster.samples).map(DynamicImage::ImageLumaA16),
        _ => image::ImageBuffer::from_raw(w, h, raster.samples).map(DynamicImage::ImageRgba16),
    }
}

/// A picture of 8 bits without opacity.
fn on_white<T: Sample>(raster: &Raster<T>) -> Option<DynamicImage> {
    let last = raster.channels - 1;
    let blend = |pixel: &[T]| -> Vec<u8> {
        let opacity = pixel[last].value() / T::MOST;
        let on_white = |s: &T| (255.0 * (opacity * s.value() / T::MOST + 1.0 - opacity) + 0.5) as u8;
        pixel[..last].iter().map(on_white).collect()
    };
    let samples = raster.samples.chunks_exact(raster.channels).flat_map(blend).collect();
    let (w, h) = (raster.width as u32, raster.height as u32);
    match last {
        1 => image::GrayImage::from_raw(w, h, samples).map(DynamicImage::ImageLuma8),
        _ => image::RgbImage::from_raw(w, h, samples).map(DynamicImage::ImageRgb8),
    }
}
