//! Drawings of curves that are blended.

use std::fmt::Write as _;

use homeo_core::planar::Point2;

use super::blend::Between;

/// All curves in one drawing, from blue to red; those whose samples meet themselves dashed. Splines are paths of cubic
/// Bezier segments, curves without one polygons.
pub fn svg(curves: &[Between]) -> String {
    let pieces: Vec<Vec<[Point2; 4]>> = curves.iter().map(pieces).collect();
    let all = || curves.iter().flat_map(|curve| &curve.points).chain(pieces.iter().flatten().flatten());
    let low = [0, 1].map(|k| all().map(|p| p[k]).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|k| all().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max));
    let size = [0, 1].map(|k| high[k] - low[k]);
    let scale = 800.0 / size[0].max(size[1]);
    let place = |[x, y]: &Point2| format!("{:.2},{:.2}", 10.0 + (x - low[0]) * scale, 10.0 + (high[1] - y) * scale);
    let [width, height] = size.map(|s| s * scale + 20.0);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.1} {height:.1}\" fill=\"none\" stroke-width=\"1.5\">\n"
    );
    for (curve, pieces) in curves.iter().zip(&pieces) {
        let hue = 220.0 + 140.0 * curve.time;
        let dashes = if curve.is_simple { "" } else { " stroke-dasharray=\"4 3\"" };
        let (element, attribute, shape) = match pieces.first() {
            Some(first) => ("path", "d", path(&first[0], pieces, place)),
            None => ("polygon", "points", curve.points.iter().map(|p| place(p) + " ").collect()),
        };
        let _ = writeln!(text, "<{element} stroke=\"hsl({hue:.0} 70% 45%)\"{dashes} {attribute}=\"{shape}\"/>");
    }
    text + "</svg>\n"
}

fn pieces(curve: &Between) -> Vec<[Point2; 4]> {
    curve.fit.as_ref().map_or_else(Vec::new, |fit| fit.spline.bezier_pieces())
}

/// Segments from a start; each begins where the one before ended.
fn path(start: &Point2, pieces: &[[Point2; 4]], place: impl Fn(&Point2) -> String) -> String {
    let mut text = format!("M{}", place(start));
    for [_, a, b, end] in pieces {
        let _ = write!(text, " C{} {} {}", place(a), place(b), place(end));
    }
    text + " Z"
}
