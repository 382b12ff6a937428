//! `homeo blend`: closed curves between two others, by curvature.

use std::fmt::Write as _;

use homeo::progress::Progress;
use homeo::shape::{CurvatureBlend, ShapePath, check_simple};
use homeo_core::planar::Point2;
use serde_json::json;

use crate::answer::Answer;
use crate::args::BlendArgs;
use crate::failure::{Failure, Result};
use crate::outputs::{Outputs, check_target};
use crate::session::Session;
use crate::text::{Lines, stages};
use crate::warp::polygons;

/// A curve between, and when.
struct Between {
    time: f64,
    points: Vec<Point2>,
    is_simple: bool,
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
    let unfit = |e: homeo::shape::ShapeError| Failure::input("unfit-input", format!("{}: {e}", options.from.display()));
    let path = CurvatureBlend::new(source, target).map_err(unfit)?;
    let mut curves = Vec::new();
    for frame in 0..options.frames {
        session.check()?;
        let time = f64::from(frame) / f64::from(options.frames - 1);
        let rings = path.at(time).map_err(|e| Failure::limits("no-path", format!("{e}; nothing was written")))?;
        let is_simple = check_simple(&rings).is_ok();
        curves.push(Between { time, points: rings.concat(), is_simple });
    }
    session.stage("write");
    let text = if extension == "svg" { svg(&curves) } else { frames(&curves) };
    outputs.stage(session, &options.output, |out| {
        std::io::Write::write_all(out, text.as_bytes()).map_err(|e| e.to_string())
    })?;
    session.end_stage();
    Ok(answer(session, options, &curves))
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
    lines.add("time", stages(&session.seconds()));
    lines.add("written", options.output.display());
    let fields = json!({
        "quality": {"frames": curves.len(), "not_simple_at": crossing},
        "output": options.output.display().to_string(),
    });
    Answer::new(fields, lines.below(&format!("{} blended into {}", options.from.display(), options.to.display())))
}

fn frames(curves: &[Between]) -> String {
    let frame = |c: &Between| json!({"time": c.time, "points": c.points, "simple": c.is_simple});
    json!({"frames": curves.iter().map(frame).collect::<Vec<_>>()}).to_string()
}

/// All curves in one drawing, from blue to red; those that meet themselves dashed.
fn svg(curves: &[Between]) -> String {
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let low = [0, 1].map(|k| all().map(|p| p[k]).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|k| all().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max));
    let size = [0, 1].map(|k| high[k] - low[k]);
    let scale = 800.0 / size[0].max(size[1]);
    let [width, height] = size.map(|s| s * scale + 20.0);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.1} {height:.1}\" fill=\"none\" stroke-width=\"1.5\">\n"
    );
    for curve in curves {
        let hue = 220.0 + 140.0 * curve.time;
        let dashes = if curve.is_simple { "" } else { " stroke-dasharray=\"4 3\"" };
        let _ = write!(text, "<polygon stroke=\"hsl({hue:.0} 70% 45%)\"{dashes} points=\"");
        for [x, y] in &curve.points {
            let _ = write!(text, "{:.2},{:.2} ", 10.0 + (x - low[0]) * scale, 10.0 + (high[1] - y) * scale);
        }
        text.push_str("\"/>\n");
    }
    text + "</svg>\n"
}
