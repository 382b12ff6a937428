//! `homeo blend`: closed curves between two others, by curvature.

use homeo::progress::Progress;
use homeo::shape::{
    CurvatureBlend, CurvatureProfile, ShapeError, ShapePath, SplineError, SplineFit, SplineParams, check_simple,
    fit_closed_spline,
};
use homeo_core::planar::Point2;
use serde_json::json;

use crate::answer::Answer;
use crate::args::BlendArgs;
use crate::failure::{Failure, Result};
use crate::outputs::{Outputs, check_target};
use crate::session::Session;
use crate::text::{Lines, stages};
use crate::warp::polygons;

use super::drawing;

/// A curve between, and when.
pub struct Between {
    pub time: f64,
    pub points: Vec<Point2>,
    /// Whether the points, joined by edges, do not meet themselves.
    pub is_simple: bool,
    /// The spline near the points, where splines are asked for.
    pub fit: Option<SplineFit>,
}

/// Computes the curves and writes them.
pub fn blend(session: &Session, options: &BlendArgs, outputs: &mut Outputs) -> Result<Answer> {
    check_target(&options.output, &[&options.from, &options.to])?;
    let extension = options.output.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if !["json", "svg"].contains(&extension.as_str()) {
        return Err(Failure::usage(format!("{}: curves are .json or .svg", options.output.display())));
    }
    session.stage("read");
    let [source, target] = [&options.from, &options.to].map(|path| polygons::curve(path));
    let (source, target) = (source?, target?);
    let vertices = source.len();
    session.fact("input", json!({"path": options.from.display().to_string(), "vertices": vertices}));
    session.stage("path");
    let path = path_between(options, source, target)?;
    let mut curves = Vec::new();
    for frame in 0..options.frames {
        session.check()?;
        let time = f64::from(frame) / f64::from(options.frames - 1);
        let rings = path.at(time).map_err(|e| Failure::limits("no-path", format!("{e}; nothing was written")))?;
        let is_simple = check_simple(&rings).is_ok();
        let points = rings.concat();
        let fit = options.spline.map(|controls| fitted(&points, controls, time)).transpose()?;
        curves.push(Between { time, points, is_simple, fit });
    }
    session.stage("write");
    let text = if extension == "svg" { drawing::svg(&curves) } else { frames(&curves) };
    outputs.stage(session, &options.output, |out| {
        std::io::Write::write_all(out, text.as_bytes()).map_err(|e| e.to_string())
    })?;
    session.end_stage();
    Ok(answer(session, options, &curves))
}

/// The path; what is wrong with one curve is said of its file.
fn path_between(options: &BlendArgs, source: Vec<Point2>, target: Vec<Point2>) -> Result<CurvatureBlend> {
    let unfit = |of: String, error: ShapeError| Failure::input("unfit-input", format!("{of}: {error}"));
    let [from, to] = [&options.from, &options.to].map(|path| path.display().to_string());
    CurvatureProfile::new(&source).map_err(|error| unfit(from.clone(), error))?;
    CurvatureProfile::new(&target).map_err(|error| unfit(to.clone(), error))?;
    CurvatureBlend::new(source, target).map_err(|error| unfit(format!("{from} and {to}"), error))
}

/// The spline near a curve; how near is said, whatever it is.
fn fitted(points: &[Point2], controls: usize, time: f64) -> Result<SplineFit> {
    match fit_closed_spline(points, &SplineParams { controls, ..SplineParams::default() }) {
        Ok(fit) => Ok(fit),
        Err(SplineError::NotReached { found }) => Ok(*found),
        Err(error) => {
            Err(Failure::input("no-spline", format!("the curve at time {time:.3}: {error}; nothing was written")))
        }
    }
}

fn answer(session: &Session, options: &BlendArgs, curves: &[Between]) -> Answer {
    let crossing: Vec<f64> = curves.iter().filter(|curve| !curve.is_simple).map(|curve| curve.time).collect();
    if let Some(first) = crossing.first() {
        session.display().note(&format!(
            "{} of {} curves meet themselves, the first at time {first:.3}: blending by curvature does not prevent this",
            crossing.len(),
            curves.len()
        ));
    }
    let mut lines = Lines::default();
    lines.add("curves", curves.len());
    lines.add("simple", format!("{} of {}, exactly", curves.len() - crossing.len(), curves.len()));
    let distance = curves.iter().filter_map(|curve| Some(curve.fit.as_ref()?.distance)).fold(0.0, f64::max);
    if let Some(controls) = options.spline {
        lines.add("splines", format!("{controls} control points each; no sample is farther away than {distance:.2e}"));
    }
    lines.add("time", stages(&session.seconds()));
    lines.add("written", options.output.display());
    let splines = options.spline.map(|controls| json!({"control_points": controls, "max_distance": distance}));
    let fields = json!({
        "quality": {"frames": curves.len(), "not_simple_at": crossing, "splines": splines},
        "output": options.output.display().to_string(),
    });
    Answer::new(fields, lines.below(&format!("{} blended into {}", options.from.display(), options.to.display())))
}

fn frames(curves: &[Between]) -> String {
    let frame = |c: &Between| {
        let mut frame = json!({"time": c.time, "points": c.points, "simple": c.is_simple});
        if let Some(fit) = &c.fit {
            frame["spline"] = json!({"control": fit.spline.control(), "distance": fit.distance});
        }
        frame
    };
    json!({"frames": curves.iter().map(frame).collect::<Vec<_>>()}).to_string()
}
