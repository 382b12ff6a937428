//! `homeo morph`: the frames between, each by a certified map.

mod animation;
mod between;
mod blend;
mod drawing;

pub use blend::blend;

use std::path::{Path, PathBuf};
use std::time::Duration;

use homeo::certificate::{Provenance, write_harmonic};
use homeo::construct::harmonic::harmonic_map;
use homeo::progress::Progress;
use homeo::warp::Placement;
use homeo_core::planar::{DomainPair, PlanarDomain};
use homeo_verify::Claim;
use image::ImageFormat;
use serde_json::json;

use crate::answer::Answer;
use crate::args::MorphArgs;
use crate::failure::{Failure, Result};
use crate::outputs::{Outputs, check_target};
use crate::proof;
use crate::session::Session;
use crate::text::{Lines, file_name, stages};
use crate::warp::picture::{self, Picture};
use crate::warp::{explain, filter, params, placement, polygons};

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// An animated GIF.
    Gif,
    /// An animated PNG.
    Png,
    /// The polygons.
    Json,
    /// A file for each frame.
    Separate,
}

/// Makes every frame and proves its map.
pub fn run(session: &Session, options: &MorphArgs, outputs: &mut Outputs) -> Result<Answer> {
    let kind = check_output(options)?;
    session.stage("read");
    let (pair, turn) = polygons::read(&options.polygons)?;
    let turn = polygons::turn_of_one_hole(&options.polygons, &pair, turn)?;
    let first = polygons::paths(&options.polygons).first().copied().unwrap_or(&options.input);
    session.fact("input", proof::domain_json(&pair.source, first));
    let picture = picture::read(&options.input)?;
    session.stage("path");
    let (path, frames) = between::frames(&pair, options, turn)?;
    let shapes: Vec<&PlanarDomain> = frames.iter().map(|frame| &frame.shape).collect();
    let place = placement(&options.polygons, &shapes, picture.size());
    let (mut claim, mut pictures) = (None, Vec::new());
    for (number, frame) in frames.iter().enumerate() {
        session.check()?;
        let step = Step { frame, place: &place };
        let (moved, proved) = step.make(session, options, &pair, &picture, outputs)?;
        claim = Some(proved);
        match kind {
            Kind::Separate => moved.stage(session, &numbered(&options.output, number, shapes.len()), outputs)?,
            _ => pictures.push(moved.into_image(ImageFormat::Png)?),
        }
    }
    if kind != Kind::Separate {
        session.stage("write");
        let delay = Duration::from_secs_f64(options.duration / f64::from(options.frames));
        let bytes = match kind {
            Kind::Gif => animation::gif(pictures, delay)?,
            Kind::Json => polygons_in_between(&shapes)?,
            _ => animation::png(&pictures, delay)?,
        };
        outputs
            .stage(session, &options.output, |out| std::io::Write::write_all(out, &bytes).map_err(|e| e.to_string()))?;
    }
    session.end_stage();
    let claim = claim.ok_or_else(|| Failure::bug("a morph without frames"))?;
    Ok(answer(session, options, path, shapes.len(), &claim))
}

fn check_output(options: &MorphArgs) -> Result<Kind> {
    let mut inputs = vec![options.input.as_path()];
    inputs.extend(polygons::paths(&options.polygons));
    check_target(&options.output, &inputs)?;
    if !picture::is_picture(&options.input) {
        return Err(Failure::usage(format!("{}: a picture is needed, .png or .jpg", options.input.display())));
    }
    let extension = options.output.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    match (extension.as_str(), options.separate) {
        ("gif", false) => Ok(Kind::Gif),
        ("png", false) => Ok(Kind::Png),
        ("json", false) => Ok(Kind::Json),
        ("png" | "jpg" | "jpeg", true) => Ok(Kind::Separate),
        _ => Err(Failure::usage(format!(
            "{}: a morph is .gif, .png or .json; with --separate its frames are .png or .jpg",
            options.output.display()
        ))),
    }
}

/// The polygons of all frames, ring by ring.
fn polygons_in_between(shapes: &[&PlanarDomain]) -> Result<Vec<u8>> {
    let frames: Vec<_> = shapes.iter().map(|shape| json!(shape.rings())).collect();
    serde_json::to_vec(&json!({"frames": frames})).map_err(|e| Failure::bug(e.to_string()))
}

/// `name.png` becomes `name_007.png`.
fn numbered(path: &Path, frame: usize, count: usize) -> PathBuf {
    let digits = (count - 1).to_string().len();
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}_{frame:0digits$}.{extension}"))
}

/// What a frame is made of.
struct Step<'a> {
    frame: &'a between::Frame,
    place: &'a Placement,
}

impl Step<'_> {
    fn make(
        &self,
        session: &Session,
        options: &MorphArgs,
        pair: &DomainPair,
        picture: &Picture,
        outputs: &mut Outputs,
    ) -> Result<(Picture, Claim)> {
        let pair = DomainPair { source: pair.source.clone(), target: self.frame.shape.clone() };
        let turn = self.frame.turn.filter(|_| pair.source.rings().len() == 2);
        let map = harmonic_map(&pair, params(&options.polygons, turn), session);
        let map = map.map_err(|error| explain(session, &error))?;
        let provenance = Provenance { source_name: file_name(&options.input), ..Provenance::default() };
        let claim =
            proof::write_and_check(session, None, outputs, |mut out| write_harmonic(&map, &provenance, &mut out))?;
        session.stage("warp");
        let moved = picture.warped(&map, self.place, filter(options.polygons.filter), session);
        Ok((moved.ok_or_else(|| session.stopped())?, claim))
    }
}

fn answer(session: &Session, options: &MorphArgs, path: &str, frames: usize, claim: &Claim) -> Answer {
    let mut lines = Lines::default();
    lines.add(
        "certificates",
        format!("{frames} hold, one for the map of each frame; the last: {}", proof::holds(claim)),
    );
    lines.add("path", path);
    lines.add("time", stages(&session.seconds()));
    lines.add("written", options.output.display());
    let fields = json!({
        "certificate": proof::claim_json(claim),
        "quality": {"frames": frames, "path": path},
        "output": options.output.display().to_string(),
    });
    Answer::new(fields, lines.below(&format!("{} morphed, one-to-one in every frame", options.input.display())))
}
