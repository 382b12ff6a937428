//! Pictures sampled on a graphics processor: `--device gpu`.

use homeo::gpu::{Gpu, GpuError};
use homeo::map::PlanarBijection;
use homeo::progress::Progress;
use homeo::warp::{Filter, Placement, backward_field};

use super::Input;
use super::picture::Picture;
use crate::args::{DeviceName, WarpArgs};
use crate::failure::{Failure, Result};
use crate::session::Session;

/// What is said where it is asked for and there is nothing for it to do.
pub const ONLY_PICTURES: &str = "--device gpu samples pictures of 8 bits; leave it out for what is moved here";

/// Refuses what a graphics processor does not do, before anything is made.
pub fn check(options: &WarpArgs, input: &Input) -> Result<()> {
    let is_possible = matches!(input, Input::Picture(Picture::Bytes(_))) && options.output.is_some();
    match options.device {
        DeviceName::Gpu if !is_possible => Err(Failure::usage(ONLY_PICTURES)),
        _ => Ok(()),
    }
}

/// The warped picture: where pixels come from is found by the processor, and rounded to single precision as in `--field`.
pub fn warped(
    session: &Session,
    map: &dyn PlanarBijection,
    picture: &Picture,
    placement: &Placement,
    filter: Filter,
) -> Result<Picture> {
    let Picture::Bytes(raster) = picture else { return Err(Failure::usage(ONLY_PICTURES)) };
    let failed = |error: GpuError| Failure::limits("no-device", format!("{error}; nothing was written"));
    let gpu = Gpu::new().map_err(failed)?;
    let field = backward_field(map, placement, raster.width, raster.height);
    if session.is_cancelled() {
        return Err(session.stopped());
    }
    gpu.apply_field(raster, &field, raster.width, filter).map(Picture::Bytes).map_err(failed)
}
