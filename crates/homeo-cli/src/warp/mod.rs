//! `homeo warp`: pictures and points move with a polygon, meshes and points in space with a cage, one-to-one.

mod cage;
mod complex;
mod composite;
#[cfg(feature = "gpu")]
mod device;
mod landmarks;
mod moved;
pub mod path;
pub mod picture;
pub mod polygons;

use std::path::Path;

use homeo::certificate::{PlanarMap, Provenance, write_planar};
use homeo::construct::harmonic::{HarmonicError, HarmonicParams, MiddleShape, harmonic_map};
use homeo::map::{Distortion, PlanarBijection};
use homeo::progress::Progress;
use homeo::warp::{Filter, Placement, backward_field};
use homeo_core::planar::PlanarDomain;
use homeo_verify::Claim;
use serde_json::{Value, json};

use crate::answer::Answer;
use crate::args::{Coordinates, FilterName, MethodName, MiddleName, PolygonArgs, WarpArgs};
use crate::failure::{Failure, Result};
use crate::outputs::{Outputs, check_targets};
use crate::points::{self, PointFormat, Table, csv, npy};
use crate::proof;
use crate::session::Session;
use crate::text::{Lines, file_name, stages};

use picture::Picture;

/// Makes the map, proves it and moves what is to be moved.
pub fn run(session: &Session, options: &WarpArgs, outputs: &mut Outputs) -> Result<Answer> {
    if cage::is_wanted(options) {
        return cage::run(session, options, outputs);
    }
    cage::refuse_options(options)?;
    check_outputs(options)?;
    polygons::check_method(options)?;
    session.stage("read");
    let input = Input::read(&options.input)?;
    #[cfg(feature = "gpu")]
    device::check(options, &input)?;
    let first = options.landmarks.as_deref().or_else(|| polygons::paths(&options.polygons).first().copied());
    let first = first.unwrap_or(&options.input);
    let made = make(session, options)?;
    let map = made.map.as_bijection();
    session.fact("input", proof::domain_json(map.source(), first));
    let provenance = Provenance {
        source_name: file_name(first),
        program: format!("homeo {}", env!("CARGO_PKG_VERSION")),
        options: made.options.clone(),
    };
    let claim = proof::write_and_check(session, options.map.as_deref(), outputs, |mut out| {
        write_planar(&made.map, &provenance, &mut out)
    })?;
    session.stage("warp");
    let done = input.warp(session, options, map, outputs)?;
    session.end_stage();
    Ok(answer(session, options, &made, &claim, done))
}

/// A map and what is said of it.
struct Made {
    map: PlanarMap,
    /// With which options it was made.
    options: Value,
    quality: Value,
    words: [(&'static str, String); 1],
}

fn make(session: &Session, options: &WarpArgs) -> Result<Made> {
    if let Some(path) = &options.landmarks {
        return Ok(piecewise_linear(landmarks::map(path)?.into(), json!({"landmarks": file_name(path)})));
    }
    let (pair, turn) = polygons::read(&options.polygons)?;
    if options.method == Some(MethodName::MeanValue) {
        let (map, made) = composite::map(session, &pair, &options.polygons, turn)?;
        let composite::Made { path, info } = made;
        return Ok(Made {
            words: [(
                "steps",
                format!(
                    "{} on the path `{path}`, determinant at least {:.2e}",
                    map.step_count(),
                    info.least_determinant
                ),
            )],
            quality: json!({"steps": map.step_count(), "least_determinant": info.least_determinant}),
            options: json!({"method": "mean-value", "path": path, "turn_degrees": turn, "times": info.times}),
            map: map.into(),
        });
    }
    if options.method == Some(MethodName::Complex) {
        let degree = options.degree.unwrap_or(complex::DEGREE);
        let (map, info) = complex::map(session, &pair, degree, turn)?;
        let least = info.least_determinant;
        return Ok(Made {
            words: [("speeds", format!("of degree {degree}, determinant at least {least:.2e}"))],
            quality: json!({"degree": degree, "least_determinant": least, "boxes": info.boxes}),
            options: json!({"method": "complex", "degree": degree}),
            map: map.into(),
        });
    }
    let turn = polygons::turn_of_one_hole(&options.polygons, &pair, turn)?;
    let map =
        harmonic_map(&pair, params(&options.polygons, turn), session).map_err(|error| explain(session, &error))?;
    let made = json!({
        "method": "harmonic", "triangles": options.polygons.triangles(), "turn_degrees": turn,
        "middle": name(options.polygons.middle()),
    });
    Ok(piecewise_linear(map.into(), made))
}

fn piecewise_linear(map: PlanarMap, options: Value) -> Made {
    let triangles = match &map {
        PlanarMap::Harmonic(map) => [map.source_half(), map.target_half()].map(|half| half.parts().triangles.len()),
        PlanarMap::Composite(_) | PlanarMap::Complex(_) => [0; 2],
    };
    Made {
        map,
        options,
        quality: json!({"triangles": {"source": triangles[0], "target": triangles[1]}}),
        words: [("triangles", format!("{} on the source, {} on the target", triangles[0], triangles[1]))],
    }
}

/// What is moved.
enum Input {
    Picture(Picture),
    Points(Table<f64>),
}

fn check_outputs(options: &WarpArgs) -> Result<()> {
    let mut inputs = vec![options.input.as_path()];
    inputs.extend(options.landmarks.as_deref());
    inputs.extend(polygons::paths(&options.polygons));
    let paths: Vec<&Path> =
        [&options.output, &options.map, &options.field].into_iter().filter_map(|path| path.as_deref()).collect();
    check_targets(&paths, &inputs)?;
    let is_picture = picture::is_picture(&options.input);
    match &options.output {
        Some(output) if is_picture && !picture::is_picture(output) => {
            Err(Failure::usage(format!("{}: pictures are .png or .jpg", output.display())))
        }
        Some(output) if !is_picture => PointFormat::of_path(output).map(|_| ()),
        None if paths.is_empty() => Err(Failure::usage("give -o OUT for what is warped, or --map for the map")),
        _ if !is_picture && options.field.is_some() => Err(Failure::usage("--field is about the pixels of a picture")),
        _ => Ok(()),
    }
}

/// What is asked of the map.
pub fn params(options: &PolygonArgs, turn: Option<f64>) -> HarmonicParams {
    HarmonicParams { triangles: options.triangles(), middle: shape(options.middle()), turn_degrees: turn }
}

fn shape(name: MiddleName) -> MiddleShape {
    match name {
        MiddleName::Lengths => MiddleShape::AveragedLengths,
        MiddleName::Regular => MiddleShape::Regular,
        MiddleName::Optimized => MiddleShape::Optimized(Distortion::Conformal),
    }
}

fn name(middle: MiddleName) -> &'static str {
    match middle {
        MiddleName::Lengths => "lengths",
        MiddleName::Regular => "regular",
        MiddleName::Optimized => "optimized",
    }
}

/// The filter of this name.
pub fn filter(name: FilterName) -> Filter {
    match name {
        FilterName::Linear => Filter::Linear,
        FilterName::Bicubic => Filter::Bicubic,
        FilterName::Lanczos => Filter::Lanczos,
    }
}

/// Why there is no map.
pub fn explain(session: &Session, error: &HarmonicError) -> Failure {
    match error {
        HarmonicError::Cancelled => session.stopped(),
        HarmonicError::TurnOfSeveralHoles(_) => Failure::usage(error.to_string()),
        _ => Failure::limits("no-map", format!("{error}; nothing was written")),
    }
}

/// What was moved.
struct Done {
    fields: Value,
    words: String,
    outside: usize,
}

impl Input {
    fn read(path: &Path) -> Result<Self> {
        if picture::is_picture(path) {
            return picture::read(path).map(Self::Picture);
        }
        let points = points::read(path)?;
        match points.rows.iter().position(|p| p[2] != 0.0) {
            Some(row) => {
                let message = format!("{}: row {}: points of the plane have two coordinates", path.display(), row + 1);
                Err(Failure::input("points", message))
            }
            None => Ok(Self::Points(points)),
        }
    }

    fn warp(
        self,
        session: &Session,
        options: &WarpArgs,
        map: &dyn PlanarBijection,
        outputs: &mut Outputs,
    ) -> Result<Done> {
        match self {
            Self::Picture(picture) => warp_picture(session, options, map, picture, outputs),
            Self::Points(points) => warp_points(session, options, map, points, outputs),
        }
    }
}

fn warp_picture(
    session: &Session,
    options: &WarpArgs,
    map: &dyn PlanarBijection,
    picture: Picture,
    outputs: &mut Outputs,
) -> Result<Done> {
    let [width, height] = picture.size();
    let placement = placement(&options.polygons, &[map.source(), map.target()], [width, height]);
    let bits = picture.bits();
    if let Some(path) = &options.field {
        let field = backward_field(map, &placement, width, height);
        let bytes = npy::encode_field(&field, width);
        outputs.stage(session, path, |out| std::io::Write::write_all(out, &bytes).map_err(|e| e.to_string()))?;
    }
    if let Some(path) = &options.output {
        let warped = warped(session, options, map, &picture, &placement)?;
        session.stage("write");
        warped.stage(session, path, outputs)?;
    }
    let fields = json!({"width": width, "height": height, "bits": bits});
    Ok(Done { fields, words: format!("{width} x {height} pixels of {bits} bits"), outside: 0 })
}

/// The picture, sampled by what `--device` names.
fn warped(
    session: &Session,
    options: &WarpArgs,
    map: &dyn PlanarBijection,
    picture: &Picture,
    placement: &Placement,
) -> Result<Picture> {
    let filter = filter(options.polygons.filter);
    #[cfg(feature = "gpu")]
    if options.device == crate::args::DeviceName::Gpu {
        return device::warped(session, map, picture, placement, filter);
    }
    picture.warped(map, placement, filter, session).ok_or_else(|| session.stopped())
}

/// Where the polygons lie on a picture.
pub fn placement(options: &PolygonArgs, domains: &[&PlanarDomain], [width, height]: [usize; 2]) -> Placement {
    let default = if options.pair.is_some() { Coordinates::Fit } else { Coordinates::Pixels };
    match options.coordinates.unwrap_or(default) {
        Coordinates::Fit => Placement::fit(domains, width, height),
        Coordinates::Pixels => Placement { origin: [0.0, 0.0], scale: 1.0, is_upwards: false },
    }
}

fn warp_points(
    session: &Session,
    options: &WarpArgs,
    map: &dyn PlanarBijection,
    points: Table<f64>,
    outputs: &mut Outputs,
) -> Result<Done> {
    let count = points.rows.len();
    let flat: Vec<[f64; 2]> = points.rows.iter().map(|&[x, y, _]| [x, y]).collect();
    let images = map.forward_batch(&flat);
    session.check()?;
    let outside = images.iter().filter(|image| image.is_err()).count();
    if let Some(row) = images.iter().position(|image| image.is_err()) {
        let message = format!(
            "{}: row {}: the point lies outside the polygon ({outside} such rows); remove them, or make the polygon larger",
            options.input.display(),
            row + 1
        );
        return Err(Failure::input("outside", message).with("row", row + 1).with("rows_without_image", outside));
    }
    let radius = images.iter().flatten().map(|image| image.radius).fold(0.0, f64::max);
    if let Some(path) = &options.output {
        session.stage("write");
        let rows = images.into_iter().flatten().map(|image| [image.point[0], image.point[1], 0.0]).collect();
        let table = Table { columns: 2, rows };
        let bytes = match PointFormat::of_path(path)? {
            PointFormat::Npy => npy::encode(&table),
            PointFormat::Csv => csv::write_doubles(&table),
        };
        outputs.stage(session, path, |out| std::io::Write::write_all(out, &bytes).map_err(|e| e.to_string()))?;
    }
    let fields = json!({"points": count, "error": {"max_radius": radius}});
    Ok(Done { fields, words: format!("{count} points, error at most {radius:.1e}"), outside })
}

fn answer(session: &Session, options: &WarpArgs, made: &Made, claim: &Claim, done: Done) -> Answer {
    let mut lines = Lines::default();
    lines.add("certificate", proof::holds(claim));
    made.words.iter().for_each(|(name, words)| lines.add(name, words));
    lines.add("moved", &done.words);
    lines.add("time", stages(&session.seconds()));
    let shown = |path: &Option<std::path::PathBuf>| path.as_ref().map(|path| path.display().to_string());
    for path in [&options.output, &options.map, &options.field].into_iter().flatten() {
        lines.add("written", path.display());
    }
    let mut quality = made.quality.clone();
    quality["moved"] = done.fields;
    let fields = json!({
        "target": claim.target,
        "certificate": proof::claim_json(claim),
        "quality": quality,
        "outside": done.outside,
        "output": shown(&options.output), "map": shown(&options.map), "field": shown(&options.field),
    });
    Answer::new(fields, lines.below(&format!("{} warped, one-to-one", options.input.display())))
}
