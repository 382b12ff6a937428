//! The page of a map between planar domains: a grid on the source, and where the map takes it.

use std::fmt::Write;

use homeo_core::planar::{PlanarDomain, Point2};
use rayon::prelude::*;

use crate::map::PlanarBijection;

/// Grid lines in either direction across the longer side.
const LINES: usize = 40;
/// Points on a grid line.
const SAMPLES: usize = 600;
/// Width of a panel in pixels.
const PANEL: f64 = 640.0;

/// One self-contained page: source and target side by side, with a grid and its image.
pub fn planar_page(map: &dyn PlanarBijection, title: &str, statement: &str) -> String {
    let (down, across) = (grid(map, 0), grid(map, 1));
    let panel = |name: &str, domain: &PlanarDomain, side: usize| {
        let view = View::of(domain);
        let mut lines = String::new();
        for (class, pieces) in [("u", &down), ("v", &across)] {
            for piece in pieces {
                let points: Vec<Point2> = piece.iter().map(|pair| pair[side]).collect();
                let _ = writeln!(lines, "<polyline class=\"{class}\" points=\"{}\"/>", view.path(&points));
            }
        }
        let outline = view.outline(domain);
        let [w, h] = view.size;
        format!(
            "<figure><svg viewBox=\"0 0 {w:.1} {h:.1}\" role=\"img\" aria-label=\"{name}\">{lines}<path class=\"edge\" d=\"{outline}\"/></svg>\
             <figcaption>{name}: {} vertices</figcaption></figure>",
            domain.vertex_count()
        )
    };
    let (source, target) = (panel("source", map.source(), 0), panel("target", map.target(), 1));
    let [title, statement] = [title, statement].map(escape);
    format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>{title}</title><style>{STYLE}</style><h1>{title}</h1><p class=\"holds\"><b>Certified.</b> {statement}</p>\
         <main>{source}{target}</main><p>Equal colours correspond: the grid on the left goes to that on the right. \
         No two lines of one colour meet, however close they come.</p>{PLAY}\
         <script type=\"application/json\" id=\"domains\">{}</script><script>{SCRIPT}</script></html>\n",
        domains(map)
    )
}

/// What can be played with below the map; see `planar.js`.
const PLAY: &str = "<h2>Try it</h2><p>Drag the vertices of the target. The grid follows by composite mean value maps along \
straight paths; more steps undo folds. This part is sampled on a grid and is no proof; the map above is the certified one.</p>\
<p class=\"tools\"><label>steps <select id=\"steps\"><option>auto<option>1<option>2<option>4<option>8<option>16<option>32<option>64</select></label> \
<label>show <select id=\"show\"><option>grid<option>picture</select></label> <label>picture <input type=\"file\" id=\"file\" accept=\"image/*\"></label> \
<button id=\"straight\">source</button> <button id=\"reset\">target</button> <output id=\"meter\"></output></p>\
<canvas id=\"play\" width=\"1100\" height=\"800\"></canvas>";

const SCRIPT: &str = include_str!("planar.js");

/// Both domains as JSON. Numbers need no escaping.
fn domains(map: &dyn PlanarBijection) -> String {
    serde_json::json!({"source": map.source().rings(), "target": map.target().rings()}).to_string()
}

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:1400px;margin:2em auto;padding:0 1em;background:#fff;color:#1b1b1b}\
main{display:flex;flex-wrap:wrap;gap:1.5em}figure{flex:1 1 420px;margin:0}svg{width:100%;max-height:80vh;background:#fafafa;border:1px solid #ddd}\
polyline{fill:none;stroke-width:.7}.u{stroke:#0072b2}.v{stroke:#d55e00}.edge{fill:none;stroke:#111;stroke-width:1.4}\
canvas{width:100%;max-width:1100px;border:1px solid #ddd;background:#fafafa;touch-action:none}.tools{display:flex;flex-wrap:wrap;gap:1em;align-items:center}\
.good{color:#007a58}.bad{color:#c0004f}output{font-weight:600}.holds{border-left:4px solid #009e73;padding-left:.8em}figcaption{color:#555}\
@media(prefers-color-scheme:dark){body{background:#161616;color:#eee}svg,canvas{background:#1f1f1f;border-color:#444}.good{color:#3ddc97}.bad{color:#ff6b9d}.edge{stroke:#eee}figcaption{color:#aaa}.u{stroke:#56b4e9}.v{stroke:#e69f00}}";

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Pieces of grid lines along an axis that lie in the source, with their images.
fn grid(map: &dyn PlanarBijection, axis: usize) -> Vec<Vec<[Point2; 2]>> {
    let [low, high] = map.source().bounds();
    let size = [high[0] - low[0], high[1] - low[1]];
    let step = size[0].max(size[1]) / LINES as f64;
    let count = (size[1 - axis] / step) as usize;
    let pieces_of = |line: usize| {
        let place = |sample: usize| {
            let mut point = [0.0; 2];
            point[axis] = low[axis] + size[axis] * sample as f64 / SAMPLES as f64;
            point[1 - axis] = low[1 - axis] + step * (line as f64 + 0.5);
            point
        };
        let points: Vec<Point2> = (0..=SAMPLES).map(place).collect();
        let mut images = vec![None; points.len()];
        map.forward_along(&points, &mut images);
        let pairs: Vec<_> = points.into_iter().zip(images).collect();
        let inside = pairs.split(|(_, image)| image.is_none());
        let pair = |&(point, image): &(Point2, Option<Point2>)| image.map(|image| [point, image]);
        inside.map(|piece| piece.iter().filter_map(pair).collect::<Vec<_>>()).collect::<Vec<_>>()
    };
    let mut pieces: Vec<_> = (0..=count).into_par_iter().flat_map_iter(pieces_of).collect();
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

/// Where points of the plane lie in a drawing.
struct View {
    low: Point2,
    high: Point2,
    scale: f64,
    size: [f64; 2],
}

impl View {
    fn of(domain: &PlanarDomain) -> Self {
        let [low, high] = domain.bounds();
        let longer = (high[0] - low[0]).max(high[1] - low[1]);
        let scale = PANEL / (1.06 * longer);
        let size = [0, 1].map(|axis| scale * (high[axis] - low[axis] + 0.06 * longer));
        Self { low, high, scale, size }
    }

    fn place(&self, [x, y]: Point2) -> Point2 {
        let margin = 0.5 * (self.size[0] - self.scale * (self.high[0] - self.low[0]));
        [margin + self.scale * (x - self.low[0]), margin + self.scale * (self.high[1] - y)]
    }

    fn path(&self, points: &[Point2]) -> String {
        let mut text = String::new();
        for &point in points {
            let [x, y] = self.place(point);
            let _ = write!(text, "{x:.2},{y:.2} ");
        }
        text
    }

    fn outline(&self, domain: &PlanarDomain) -> String {
        domain.rings().iter().map(|ring| format!("M{}Z", self.path(ring))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::construct::harmonic::{HarmonicParams, harmonic_map};
    use crate::progress::Silent;
    use homeo_core::planar::DomainPair;

    #[test]
    fn the_page_has_both_domains_and_needs_nothing_else() {
        let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
        let kite = vec![vec![[0.0, 0.0], [1.0, 0.1], [2.5, 2.5], [0.1, 1.0]]];
        let pair = DomainPair::new(square, kite).expect("a pair");
        let params = HarmonicParams { triangles: 50, ..HarmonicParams::default() };
        let map = harmonic_map(&pair, params, &Silent).expect("a map");
        let page = planar_page(&map, "a <b> & c", "it holds");
        assert!(page.contains("<h1>a &lt;b&gt; &amp; c</h1>") && page.contains("it holds"));
        assert!(!page.contains("http") && !page.contains("src="), "the page needs no network");
        assert_eq!(page.matches("<polyline class=\"u\"").count(), 80, "forty lines on either side");
        let json = page.split("id=\"domains\">").nth(1).and_then(|rest| rest.split("</script>").next()).expect("data");
        let value: serde_json::Value = serde_json::from_str(json).expect("JSON");
        assert_eq!(value["target"][0][2], serde_json::json!([2.5, 2.5]));
    }
}
