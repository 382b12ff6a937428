//! The page of a hyperbolic structure: its fundamental domain in the ball, and the numbers.

use super::cover::{CoverPicture, FaceKind, Model};
use super::data::VerdictWords;
use super::glb::colour;
use super::pack::{Block, Frame, write_base64};
use super::page::{
    inside_json, inside_script, write_claim, write_facts, write_head, write_limit_list, write_verdict_line,
};
use homeo_manifold::hyperbolic::minkowski::mobius;
use homeo_manifold::hyperbolic::{Embedding, Enclosure, Structure};
use homeo_manifold::{Homology, Skeleton, Triangulation, signature};
use serde_json::json;
use std::io::{self, Write};

/// The viewer, written by hand: it draws triangles and nothing else.
const VIEWER: &str = concat!(include_str!("page.js"), include_str!("hyperbolic.js"));
const CAPTION: &str = "The truncated tetrahedra of a fundamental domain in the unit ball, Poincaré's model: angles are true, lengths are not, and geodesic planes are parts of spheres that meet the unit sphere at right angles. Pale triangles are on the geodesic boundary of the manifold; hexagons of the same colour are glued by a side pairing, grey ones inside of the domain. Drag to turn, scroll to come nearer.";
/// A depth is drawn if there are no more pieces than this.
const MOST_PIECES: usize = 700;
/// Rows of tables beyond this are left out; the file has all.
const MOST_ROWS: usize = 60;

/// What a page of a structure is made from.
#[derive(Clone, Copy, Debug)]
pub struct HyperbolicReport<'a> {
    /// The heading.
    pub title: &'a str,
    /// The line below it.
    pub subtitle: &'a str,
    /// What was proved.
    pub verdict: &'a VerdictWords,
    /// The gluings.
    pub triangulation: &'a Triangulation,
    /// Their structure.
    pub structure: &'a Structure,
    /// Seconds of each stage.
    pub stage_seconds: &'a [(String, f64)],
}

/// Writes the page of a hyperbolic structure: the fundamental domain and pieces of the universal cover to be turned and
/// pulled apart, and tables of angles, lengths and side pairings. It needs no other file and no network.
///
/// # Errors
/// Those of `out`, and [`io::ErrorKind::InvalidInput`] for a structure of another triangulation.
///
/// # Example
/// ```
/// use homeo::export::{HyperbolicReport, VerdictWords, write_hyperbolic_page};
/// use homeo_manifold::{Skeleton, from_signature, hyperbolic::Structure};
/// let tripus = from_signature("cPcbbbihq")?;
/// let structure = Structure::find(&tripus, &Skeleton::new(&tripus))?;
/// let report = HyperbolicReport {
///     title: "The tripus",
///     subtitle: "two truncated tetrahedra",
///     verdict: &VerdictWords { holds: true, ..VerdictWords::default() },
///     triangulation: &tripus,
///     structure: &structure,
///     stage_seconds: &[],
/// };
/// let mut page = Vec::new();
/// write_hyperbolic_page(&report, &mut page)?;
/// assert!(page.starts_with(b"<!doctype html>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_hyperbolic_page(report: &HyperbolicReport, out: &mut impl Write) -> io::Result<()> {
    let skeleton = Skeleton::new(report.triangulation);
    let other = || io::Error::new(io::ErrorKind::InvalidInput, "the structure is that of another triangulation");
    let embedding = Embedding::new(report.triangulation, &skeleton, report.structure).ok_or_else(other)?;
    let residual = embedding.residuals(&skeleton).into_iter().fold(0.0, f64::max);
    write_head(report.title, report.subtitle, out)?;
    write_verdict_line(report.verdict, out)?;
    out.write_all(b"<section id=\"viewer\" aria-label=\"Picture of the fundamental domain\">\n")?;
    out.write_all(b"<p class=\"no-picture\">The picture needs JavaScript and WebGL 2. All text below is complete without it.</p>\n")?;
    writeln!(out, "</section>\n<p class=\"caption\">{CAPTION}</p>\n<div class=\"columns\">")?;
    write_claim(report.verdict, out)?;
    let drawn = format!(
        "That this picture is exact: places are computed in floating point, and rounded to 16 bits. Round each edge the \
         isometries are the identity but for {residual:.1e}."
    );
    write_limit_list(&report.verdict.limits, &drawn, out)?;
    write_facts(&facts(report, &skeleton), report.stage_seconds, out)?;
    write_edges(report.structure, &skeleton, out)?;
    write_angles(report.structure, out)?;
    write_pairings(&embedding, out)?;
    out.write_all(b"</div>\n</main>\n<footer>This page is self-contained and loads nothing from the network. The picture is a display; the claim rests on the file, which <code>homeo verify</code> checks.</footer>\n")?;
    write_scene(&embedding, out)?;
    writeln!(out, "<script>{}</script>\n</body>\n</html>", inside_script(VIEWER))
}

fn facts(report: &HyperbolicReport, skeleton: &Skeleton) -> Vec<(String, String)> {
    let structure = report.structure;
    let fact = |label: &str, value: String| (label.to_owned(), value);
    let links = homeo_manifold::Links::new(report.triangulation, skeleton);
    let genera: Vec<String> =
        links.all().iter().filter_map(|link| link.genus()).map(|genus| genus.to_string()).collect();
    vec![
        fact("volume", bounds(structure.volume())),
        fact("tetrahedra", report.triangulation.len().to_string()),
        fact("isomorphism signature", signature(report.triangulation)),
        fact("first homology", Homology::new(report.triangulation).to_string()),
        fact("genus of the boundary", genera.join(", ")),
        fact("edges", skeleton.edges().len().to_string()),
    ]
}

/// A value to twelve decimals, and how far the exact one is from what is printed at most.
fn bounds(enclosure: Enclosure) -> String {
    let printed = format!("{:.12}", enclosure.middle());
    let middle: f64 = printed.parse().unwrap_or(f64::NAN);
    // Two digits are at most a twentieth too small, and the differences are rounded.
    let radius = 1.06 * (enclosure.high() - middle).max(middle - enclosure.low());
    format!("{printed} ± {radius:.1e}")
}

fn write_edges(structure: &Structure, skeleton: &Skeleton, out: &mut impl Write) -> io::Result<()> {
    out.write_all(b"<section id=\"edges\">\n<h2>Edges</h2>\n<table>\n<thead><tr><th scope=\"col\">edge</th><td>degree</td><td>length</td></tr></thead>\n<tbody>\n")?;
    for (number, (edge, length)) in skeleton.edges().iter().zip(structure.lengths()).enumerate().take(MOST_ROWS) {
        let degree = edge.corners.len();
        writeln!(out, "<tr><th scope=\"row\">{number}</th><td>{degree}</td><td>{}</td></tr>", bounds(*length))?;
    }
    end_table(skeleton.edges().len(), out)
}

fn write_angles(structure: &Structure, out: &mut impl Write) -> io::Result<()> {
    out.write_all(b"<section id=\"angles\">\n<h2>Dihedral angles, in degrees</h2>\n<table>\n<thead><tr><th scope=\"col\">tetrahedron</th>")?;
    ["01", "02", "03", "12", "13", "23"].iter().try_for_each(|edge| write!(out, "<td>{edge}</td>"))?;
    out.write_all(b"<td>volume</td></tr></thead>\n<tbody>\n")?;
    let rows = structure.angles().iter().zip(structure.volumes()).enumerate();
    for (number, (angles, volume)) in rows.take(MOST_ROWS) {
        write!(out, "<tr><th scope=\"row\">{number}</th>")?;
        angles.iter().try_for_each(|angle| write!(out, "<td>{:.4}</td>", angle.middle().to_degrees()))?;
        writeln!(out, "<td>{:.6}</td></tr>", volume.middle())?;
    }
    end_table(structure.angles().len(), out)
}

fn write_pairings(embedding: &Embedding, out: &mut impl Write) -> io::Result<()> {
    out.write_all(b"<section id=\"pairings\">\n<h2>Side pairings</h2>\n<p>Each takes its second face to the first, and is a generator of the fundamental group: a matrix of SL(2, C), up to its sign, which acts on the upper half-space.</p>\n<table>\n<tbody>\n")?;
    for (number, side) in embedding.side_pairings().iter().enumerate().take(MOST_ROWS) {
        let [r, g, b] = colour(FaceKind::Side(number as u32));
        let face = |(tetrahedron, face): (u32, u8)| format!("{tetrahedron}:{face}");
        let matrix = mobius(&side.isometry).map_or_else(|| "out of range".to_owned(), matrix);
        writeln!(
            out,
            "<tr><th scope=\"row\"><span style=\"display:inline-block;width:1em;height:1em;border-radius:3px;vertical-align:-2px;background:rgb({r},{g},{b})\"></span> {} from {}</th><td>{matrix}</td></tr>",
            face(side.from),
            face(side.to)
        )?;
    }
    end_table(embedding.side_pairings().len(), out)
}

/// Rows of a matrix of complex numbers.
fn matrix(entries: [[[f64; 2]; 2]; 2]) -> String {
    let number = |[re, im]: [f64; 2]| format!("{re:.4} {} {:.4}\u{202f}i", if im < 0.0 { '−' } else { '+' }, im.abs());
    entries.map(|row| row.map(number).join(",\u{2003}")).join("<br>").replace('-', "−")
}

fn end_table(rows: usize, out: &mut impl Write) -> io::Result<()> {
    out.write_all(b"</tbody>\n</table>\n")?;
    if rows > MOST_ROWS {
        writeln!(out, "<p>And {} more.</p>", rows - MOST_ROWS)?;
    }
    out.write_all(b"</section>\n")
}

/// The vertices, triangles and lines of the deepest cover that is not too large, with where each depth ends.
fn write_scene(embedding: &Embedding, out: &mut impl Write) -> io::Result<()> {
    let counts: Vec<usize> = (0..=2).map(|depth| embedding.cover(depth).len()).collect();
    let depth = counts.iter().rposition(|&count| count <= MOST_PIECES).unwrap_or(0);
    let parts = if counts[depth] <= 60 { 7 } else { 3 };
    let picture = CoverPicture::new(embedding, depth, Model::Ball, parts);
    let frame = Frame { low: [-1.0; 3], high: [1.0; 3] };
    let mut block = Block::default();
    let sides = embedding.side_pairings().len() as u32;
    let kind = |kind: &FaceKind| match kind {
        FaceKind::Boundary => 0,
        FaceKind::Inner => 1,
        FaceKind::Side(number) => 2 + *number as u16,
    };
    let kinds = [FaceKind::Boundary, FaceKind::Inner].into_iter().chain((0..sides).map(FaceKind::Side));
    let per_piece = |total: usize| total / picture.middles.len().max(1);
    let vertices = picture.positions.len();
    let manifest = json!({
        "frame": frame,
        "pieces": counts[..=depth],
        "trianglesPerPiece": per_piece(picture.triangles.len()),
        "linesPerPiece": per_piece(picture.lines.len()),
        "colours": kinds.map(colour).collect::<Vec<_>>(),
        "positions": block.points(&frame, &picture.positions),
        "normals": block.points(&frame, &picture.normals),
        "middles": block.points(&frame, &picture.middles),
        "kinds": block.words(&picture.kinds.iter().map(kind).collect::<Vec<_>>()),
        "owners": block.indices(picture.middles.len(), &picture.pieces),
        "triangles": block.indices(vertices, picture.triangles.as_flattened()),
        "lines": block.indices(vertices, picture.lines.as_flattened()),
    });
    writeln!(
        out,
        "<script type=\"application/json\" id=\"homeo-scene\">{}</script>",
        inside_json(&manifest.to_string())
    )?;
    write!(out, "<script type=\"application/octet-stream;base64\" id=\"homeo-arrays\">")?;
    write_base64(&block.bytes, out)?;
    out.write_all(b"</script>\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use homeo_manifold::from_signature;

    fn page(signature: &str, title: &str) -> String {
        let triangulation = from_signature(signature).expect("a signature");
        let structure = Structure::find(&triangulation, &Skeleton::new(&triangulation)).expect("a structure");
        let verdict = VerdictWords { holds: true, limits: vec!["a limit".into()], ..VerdictWords::default() };
        let report = HyperbolicReport {
            title,
            subtitle: "test",
            verdict: &verdict,
            triangulation: &triangulation,
            structure: &structure,
            stage_seconds: &[],
        };
        let mut page = Vec::new();
        write_hyperbolic_page(&report, &mut page).expect("memory can be written");
        String::from_utf8(page).expect("text")
    }

    #[test]
    fn the_page_has_all_numbers_and_needs_nothing_else() {
        let page = page("cPcbbbihq", "a <b>");
        assert!(page.contains("<h1>a &lt;b&gt;</h1>") && page.contains("6.451990270835 ±"));
        assert_eq!(page.matches("<td>30.0000</td>").count(), 12);
        assert_eq!(page.matches("border-radius:3px").count(), 3, "three side pairings");
        assert!(
            !page.contains("http:") && !page.contains("https:") && !page.contains("src="),
            "the page needs no network"
        );
        let json = page.split("id=\"homeo-scene\">").nth(1).and_then(|rest| rest.split("</script>").next());
        let scene: serde_json::Value = serde_json::from_str(json.expect("data")).expect("JSON");
        assert_eq!(scene["pieces"], json!([2, 8, 26]));
        assert_eq!(scene["triangles"]["length"], 26 * 28 * 49 * 3);
        assert_eq!(scene["colours"].as_array().map(Vec::len), Some(5));
    }

    /// What is printed holds the exact value, also where it is known better than to twelve decimals.
    #[test]
    fn printed_bounds_hold_both_ends() {
        for (low, high) in [(0.1, 0.1), (1.0 / 3.0, 1.0 / 3.0), (6.451990270833518, 6.451990270836548), (0.5, 0.75)] {
            let text = bounds(Enclosure::between(low, high));
            let (middle, radius) = text.split_once(" ± ").expect("a radius");
            let [middle, radius] = [middle, radius].map(|x| x.parse::<f64>().expect("a number"));
            assert!((low - middle).abs() <= radius && (high - middle).abs() <= radius, "{text}");
        }
        assert_eq!(bounds(Enclosure::between(0.5, 0.75)), "0.625000000000 ± 1.3e-1");
    }

    #[test]
    fn a_structure_of_another_triangulation_is_refused() {
        let [small, large] = ["cPcbbbihq", "dLQbcccdefo"].map(|text| from_signature(text).expect("a signature"));
        let structure = Structure::find(&small, &Skeleton::new(&small)).expect("a structure");
        let report = HyperbolicReport {
            title: "",
            subtitle: "",
            verdict: &VerdictWords::default(),
            triangulation: &large,
            structure: &structure,
            stage_seconds: &[],
        };
        let mut page = Vec::new();
        assert!(write_hyperbolic_page(&report, &mut page).is_err() && page.is_empty());
    }
}
