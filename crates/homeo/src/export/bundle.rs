//! The page of a unit tangent bundle: the surface with its cuts, the solid tori over its disks, and a field as a section.

use super::chart::{Charts, ends};
use super::data::VerdictWords;
use super::pack::{Block, Frame, write_base64};
use super::page::{
    inside_json, inside_script, write_claim, write_facts, write_head, write_limit_list, write_verdict_line,
};
use homeo_manifold::bundle::{Side, TangentBundle};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io::{self, Write};

/// The viewer, written by hand.
const VIEWER: &str = concat!(include_str!("page.js"), include_str!("bundle.js"));
/// Paths beyond this are not drawn.
const MOST_PATHS: usize = 60_000;
const CAPTION: &str = "Left the surface with the paths along which it is cut; right the bundle over each disk that is left: a solid torus, disk times circle, cut open at level 0 when it is unrolled. A path has the same colour on the surface and on the tori, where both its sides are seen. Click on a triangle: the circle round it is the fibre over its middle, all unit tangent vectors there, and the same fibre is drawn in its solid torus. Drag to turn, scroll to come nearer.";
const SPHERE: &str = " The two solid tori are glued along their boundaries to projective space, which has no place in three dimensions: the dark curve on the second bounds a disk in the first (level 0 there), and winds twice round the fibres of the second while it goes once round the disk.";
const TORUS: &str =
    " Unrolled, the prism is a room of the 3-torus: floor and ceiling are glued, and walls of the same colour.";
const FIELD: &str = " Arrows are the field's directions along the surface; balls are its singular triangles and vertices, red where the index is positive, blue where it is negative. The orange lines in the tori are the section: one over each edge, turning as the field does.";

/// What a page of a bundle is made from.
#[derive(Clone, Copy, Debug)]
pub struct BundleReport<'a> {
    /// The heading.
    pub title: &'a str,
    /// The line below it.
    pub subtitle: &'a str,
    /// What was proved.
    pub verdict: &'a VerdictWords,
    /// The bundle.
    pub tangent: &'a TangentBundle,
    /// Where the vertices of the surface are that it was made from (`#V by 3`).
    pub positions: &'a [[f64; 3]],
    /// Its triangles (`#F by 3`).
    pub triangles: &'a [[u32; 3]],
    /// A field, where there is one.
    pub field: Option<FieldPicture<'a>>,
    /// Rows of a table.
    pub facts: &'a [(String, String)],
    /// Seconds of each stage.
    pub stage_seconds: &'a [(String, f64)],
}

/// A field of vectors and its section.
#[derive(Clone, Copy, Debug)]
pub struct FieldPicture<'a> {
    /// One vector for each vertex of the surface (`#V by 3`).
    pub vectors: &'a [[f64; 3]],
    /// Singular triangles and their indices.
    pub triangles: &'a [(u32, i64)],
    /// Singular vertices and their indices.
    pub vertices: &'a [(u32, i64)],
    /// The paths of the section, as [`homeo_manifold::bundle::Section::paths`] gives them.
    pub paths: &'a [Vec<u32>],
}

/// Writes the page of a unit tangent bundle. It needs no other file and no network.
///
/// # Errors
/// Those of `out`, and [`io::ErrorKind::InvalidInput`] for positions or vectors of another number.
///
/// # Example
/// ```
/// use homeo::export::{BundleReport, VerdictWords, write_bundle_page};
/// use homeo_manifold::bundle::TangentBundle;
/// let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let report = BundleReport {
///     title: "Projective space",
///     subtitle: "over a tetrahedron",
///     verdict: &VerdictWords { holds: true, ..VerdictWords::default() },
///     tangent: &TangentBundle::new(&triangles, 4, 8)?,
///     positions: &positions,
///     triangles: &triangles,
///     field: None,
///     facts: &[],
///     stage_seconds: &[],
/// };
/// let mut page = Vec::new();
/// write_bundle_page(&report, &mut page)?;
/// assert!(page.starts_with(b"<!doctype html>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_bundle_page(report: &BundleReport, out: &mut impl Write) -> io::Result<()> {
    let unfit = |what: &str| io::Error::new(io::ErrorKind::InvalidInput, what.to_owned());
    let tangent = report.tangent;
    let count = tangent.bundle.vertex_count() - tangent.added.len();
    if report.positions.len() != count || report.field.is_some_and(|field| field.vectors.len() != count) {
        return Err(unfit("positions and vectors are not one for each vertex of the surface"));
    }
    let charts = Charts::new(tangent).ok_or_else(|| unfit("the triangles of the bundle are no surface"))?;
    write_head(report.title, report.subtitle, out)?;
    write_verdict_line(report.verdict, out)?;
    out.write_all(b"<section id=\"viewer\" aria-label=\"Picture of the bundle\">\n")?;
    out.write_all(b"<p class=\"no-picture\">The picture needs JavaScript and WebGL 2. All text below is complete without it.</p>\n")?;
    let special = match tangent.bundle.euler_number() {
        Some(2) => SPHERE,
        Some(0) => TORUS,
        _ => "",
    };
    let field = if report.field.is_some() { FIELD } else { "" };
    writeln!(out, "</section>\n<p class=\"caption\">{CAPTION}{special}{field}</p>\n<div class=\"columns\">")?;
    write_claim(report.verdict, out)?;
    let drawn = "That this picture is exact: disks are laid out in floating point with their vertices at means of their neighbours, \
                 places are rounded to 16 bits, and the circle on the surface has no marks for levels. Of sections with more than 60,000 paths a part is drawn, and of fields \
                 about 2,500 arrows.";
    write_limit_list(&report.verdict.limits, drawn, out)?;
    write_facts(report.facts, report.stage_seconds, out)?;
    out.write_all(b"</div>\n</main>\n<footer>This page is self-contained and loads nothing from the network. The picture is a display; the claim rests on the mesh, which <code>homeo verify</code> checks as a certificate.</footer>\n")?;
    write_scene(report, &charts, out)?;
    writeln!(out, "<script>{}</script>\n</body>\n</html>", inside_script(VIEWER))
}

fn write_scene(report: &BundleReport, charts: &Charts, out: &mut impl Write) -> io::Result<()> {
    let (bundle, mut places) = (&report.tangent.bundle, report.positions.to_vec());
    for carrier in &report.tangent.added {
        places.push(carrier.point(&places));
    }
    let frame = Frame::around(places.iter());
    let unit = Frame { low: [-1.0; 3], high: [1.0; 3] };
    let mut block = Block::default();
    let boundary: Vec<u16> = (charts.boundary.iter())
        .flat_map(|&(side, cut)| {
            [0, 1]
                .map(|k| charts.corners[side.triangle as usize][usize::from(side.side + k) % 3] as u16)
                .into_iter()
                .chain([cut])
        })
        .collect();
    let manifest = json!({
        "layers": bundle.layers(),
        "genus": bundle.euler_number().map_or(0, |euler| 1 - euler / 2),
        "frame": frame,
        "unit": unit,
        "places": block.points(&frame, &places),
        "triangles": block.indices(places.len(), bundle.triangles().as_flattened()),
        "chart": block.points(&unit, &charts.points),
        "corners": block.indices(charts.points.len(), charts.corners.as_flattened()),
        "disks": block.words(&charts.disks),
        "boundary": if charts.points.len() <= 1 << 16 { json!(block.words(&boundary)) } else { Value::Null },
        "cuts": report.tangent.cuts,
        "seam": seam(report.tangent, charts),
        "field": report.field.map(|field| field_of(report, charts, &field, &mut block)),
    });
    let manifest = inside_json(&manifest.to_string());
    writeln!(out, "<script type=\"application/json\" id=\"homeo-scene\">{manifest}</script>")?;
    write!(out, "<script type=\"application/octet-stream;base64\" id=\"homeo-arrays\">")?;
    write_base64(&block.bytes, out)?;
    out.write_all(b"</script>\n")
}

/// For a sphere: at vertices of the second disk's boundary, in order, the level there of the first disk's level 0.
fn seam(tangent: &TangentBundle, charts: &Charts) -> Vec<[i64; 2]> {
    if tangent.bundle.euler_number() != Some(2) {
        return Vec::new();
    }
    let layers = i64::from(tangent.bundle.layers());
    let triangles = tangent.bundle.triangles();
    let corner = |side: Side| charts.corners[side.triangle as usize][usize::from(side.side)];
    let frame = |side: Side| i64::from(tangent.frame[side.triangle as usize][usize::from(side.side)]);
    let sides = || charts.boundary.iter().map(|&(side, _)| side);
    let first: HashMap<u32, i64> = sides()
        .filter(|&side| charts.disks[corner(side) as usize] == 0)
        .map(|side| (ends(triangles, side)[0], frame(side)))
        .collect();
    let mut height = None;
    let mut path = Vec::new();
    let second: Vec<Side> = sides().filter(|&side| charts.disks[corner(side) as usize] == 1).collect();
    for &side in second.iter().chain(second.first()) {
        let level = first.get(&ends(triangles, side)[0]).copied().unwrap_or(0) - frame(side);
        // Neighbours differ by one level at most.
        let here = height.map_or(level, |before: i64| before + nearest(level - before, layers));
        path.push([i64::from(corner(side)), here]);
        height = Some(here);
    }
    path
}

/// The representative of least size modulo the layers.
fn nearest(difference: i64, layers: i64) -> i64 {
    let rest = difference.rem_euclid(layers);
    if 2 * rest > layers { rest - layers } else { rest }
}

fn field_of(report: &BundleReport, charts: &Charts, field: &FieldPicture, block: &mut Block) -> Value {
    let middle = |corners: [u32; 3]| {
        [0, 1, 2].map(|axis| corners.iter().map(|&v| report.positions[v as usize][axis]).sum::<f64>() / 3.0)
    };
    let triangles = field.triangles.iter().filter_map(|&(triangle, index)| {
        let corners = *report.triangles.get(triangle as usize)?;
        Some(json!({"at": middle(corners), "index": index, "name": format!("triangle {triangle}")}))
    });
    let vertices = field.vertices.iter().filter_map(|&(vertex, index)| {
        let at = report.positions.get(vertex as usize)?;
        Some(json!({"at": at, "index": index, "name": format!("vertex {vertex}")}))
    });
    let directions: Vec<[f64; 3]> = field.vectors.iter().map(|&vector| normalized(vector)).collect();
    let lines = section_lines(report.tangent, charts, field.paths);
    let corners: Vec<u32> = lines.iter().flat_map(|&(corners, _)| corners).collect();
    // Heights in levels, shifted to be positive.
    let heights =
        |&(_, heights): &([u32; 2], [i64; 2])| heights.map(|height| (height.clamp(-30_000, 30_000) + 32_768) as u16);
    json!({
        "vectors": block.points(&Frame { low: [-1.0; 3], high: [1.0; 3] }, &directions),
        "singular": vertices.chain(triangles).collect::<Vec<_>>(),
        "lines": block.indices(charts.points.len(), &corners),
        "heights": block.words(&lines.iter().flat_map(heights).collect::<Vec<_>>()),
    })
}

fn normalized(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 && length.is_finite() { vector.map(|x| x / length) } else { [0.0; 3] }
}

/// The paths in the frames of the disks: the ends of each as vertices of the layout, and heights in levels.
fn section_lines(tangent: &TangentBundle, charts: &Charts, paths: &[Vec<u32>]) -> Vec<([u32; 2], [i64; 2])> {
    let (triangles, layers) = (tangent.bundle.triangles(), i64::from(tangent.bundle.layers()));
    let below = |vertex: u32| vertex / tangent.bundle.layers();
    let over: HashMap<[u32; 2], &Vec<u32>> =
        (paths.iter()).filter_map(|path| Some(([below(*path.first()?), below(*path.last()?)], path))).collect();
    let mut lines = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for side in (0..triangles.len() as u32).flat_map(|t| [0, 1, 2].map(|side| Side::new(t, side))) {
        let ([from, to], at) = (ends(triangles, side), side.triangle as usize);
        let corner = |k: u8| usize::from(side.side + k) % 3;
        let (path, [start, end]) = match (over.get(&[from, to]), over.get(&[to, from])) {
            (Some(path), _) => (path, [corner(0), corner(1)]),
            (None, Some(path)) => (path, [corner(1), corner(0)]),
            (None, None) => continue,
        };
        let frame = |vertex: u32| {
            let corner = if below(vertex) == triangles[at][start] { start } else { end };
            i64::from(vertex) - i64::from(below(vertex)) * layers - i64::from(tangent.frame[at][corner])
        };
        let ends = [charts.corners[at][start], charts.corners[at][end]];
        if !seen.insert([ends[0].min(ends[1]), ends[0].max(ends[1])]) {
            continue;
        }
        let first = frame(path[0]).rem_euclid(layers);
        let last =
            path.windows(2).fold(first, |height, step| height + nearest(frame(step[1]) - frame(step[0]), layers));
        lines.push((ends, [first, last]));
        if lines.len() == MOST_PATHS {
            break;
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use homeo_manifold::bundle::Section;

    const SPHERE: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    const PLACES: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    fn page(vectors: &[[f64; 3]]) -> io::Result<String> {
        let tangent = TangentBundle::new(&SPHERE, 4, 6).expect("a bundle");
        let section = Section::of_field(&tangent, &PLACES, &[[0.3, -0.2, 0.9]; 4]).expect("a section");
        let paths = section.paths();
        let report = BundleReport {
            title: "a <b>",
            subtitle: "test",
            verdict: &VerdictWords { holds: true, ..VerdictWords::default() },
            tangent: &tangent,
            positions: &PLACES,
            triangles: &SPHERE,
            field: Some(FieldPicture { vectors, triangles: &[(0, 2)], vertices: &[], paths: &paths }),
            facts: &[],
            stage_seconds: &[],
        };
        let mut page = Vec::new();
        write_bundle_page(&report, &mut page)?;
        Ok(String::from_utf8(page).expect("text"))
    }

    /// The curve that is glued to the boundary of a disk winds once round it and twice round the fibres.
    #[test]
    fn the_page_is_whole_and_its_seam_winds_twice() {
        let page = page(&[[0.3, -0.2, 0.9]; 4]).expect("a page");
        assert!(page.contains("<h1>a &lt;b&gt;</h1>"));
        assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("src="), "no network");
        let json = page.split("id=\"homeo-scene\">").nth(1).and_then(|rest| rest.split("</script>").next());
        let scene: Value = serde_json::from_str(json.expect("data")).expect("JSON");
        let seam = scene["seam"].as_array().expect("a seam");
        let height = |at: usize| seam[at][1].as_i64().expect("a height");
        assert_eq!(seam[0][0], seam[seam.len() - 1][0]);
        assert_eq!((height(seam.len() - 1) - height(0)).abs(), 2 * 6);
        assert_eq!(scene["field"]["singular"][0]["index"], 2);
    }

    #[test]
    fn vectors_of_another_number_are_refused() {
        assert!(page(&[[0.0; 3]; 3]).is_err());
    }
}
