//! The page's text: HTML around the picture.

use super::data::{ReportData, TargetShape, VerdictWords};
use super::histogram::{Statistics, histogram_svg};
use super::pack::write_base64;
use super::scene::Scene;
use std::io::{self, Write};

/// Style sheet, written by hand.
const STYLE: &str = include_str!("page.css");
/// The viewer, generated from `viewer/` by `scripts/build-viewer`.
const VIEWER: &str = include_str!("viewer.js");
/// What is seen on the page of a map onto a standard shape.
const CAPTION: &str = "A point has the same colour on both sides: the colours and squares are those of the target, pulled back by the map. For display the map is interpolated linearly from the images of the vertices.";
/// What is seen on the page of a shell, scene by scene.
const SHELL_CAPTION: &str = "Surface: a point has the same colour on both sides; the pattern cuts each triangle of the middle surface into equal ones and is carried to the source along the pillars, and dark lines are the sides of the prisms. Layers: bottom (orange) and top (blue) of the shell, cut open, with the source between them on the left and the middle surface on the right. Pillars: the edges of the prisms from bottom to top, along which points move. Distortion: how much the projection stretches most over how much it stretches least, at each place of the source.";
/// The same where the image is another section.
const SECTION_CAPTION: &str = "Surface: a point has the same colour on both sides; the pattern cuts each triangle of the middle surface, which lies between the two, into equal ones and is carried to both along the pillars, and dark lines are the sides of the prisms. Layers: bottom (orange) and top (blue) of the shell, cut open, with the source between them on the left and the section on the right. Pillars: the edges of the prisms from bottom to top, along which points move. Distortion: how much the map from source to section stretches most over how much it stretches least, at each place of the source.";
/// The browser itself is told to load nothing from anywhere.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

/// Writes the whole page.
pub(super) fn write_page(data: &ReportData, scene: &Scene, out: &mut impl Write) -> io::Result<()> {
    write_head(&data.title, &data.subtitle, out)?;
    write_verdict_line(&data.verdict, out)?;
    write_viewer(data, scene, out)?;
    out.write_all(b"<div class=\"columns\">\n")?;
    write_claim(&data.verdict, out)?;
    write_limits(data, out)?;
    write_distortion(data, out)?;
    write_facts(&data.facts, &data.stage_seconds, out)?;
    out.write_all(b"</div>\n</main>\n<footer>This page is self-contained and loads nothing from the network. The picture is a display; the claim rests on the map file, which <code>homeo verify</code> checks.</footer>\n")?;
    write_data(scene, out)?;
    writeln!(out, "<script>{}</script>\n</body>\n</html>", inside_script(VIEWER))
}

pub(super) fn write_head(title: &str, subtitle: &str, out: &mut impl Write) -> io::Result<()> {
    let (title, subtitle) = (escape(title), escape(subtitle));
    write!(out, "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n")?;
    writeln!(out, "<meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">")?;
    writeln!(out, "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">")?;
    writeln!(out, "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>")?;
    writeln!(out, "<link rel=\"icon\" href=\"data:,\">\n<style>\n{STYLE}</style>\n</head>\n<body>")?;
    writeln!(out, "<header>\n<div><h1>{title}</h1>\n<p class=\"subtitle\">{subtitle}</p></div>")?;
    writeln!(out, "<div id=\"page-tools\"></div>\n</header>\n<main>")
}

pub(super) fn write_verdict_line(verdict: &VerdictWords, out: &mut impl Write) -> io::Result<()> {
    let (class, sign, word) =
        if verdict.holds { ("holds", "✓", "Certified") } else { ("fails", "✕", "Not certified") };
    writeln!(out, "<section class=\"verdict {class}\" aria-label=\"Verdict\">")?;
    writeln!(out, "<span class=\"sign\" aria-hidden=\"true\">{sign}</span>")?;
    writeln!(out, "<p><strong>{word}.</strong> {}</p>", escape(&verdict.headline))?;
    let claim = if verdict.holds { "What was proved" } else { "What was found" };
    writeln!(out, "<nav><a href=\"#claim\">{claim}</a> <a href=\"#limits\">What is not claimed</a></nav>\n</section>")
}

fn write_viewer(data: &ReportData, scene: &Scene, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "<section id=\"viewer\" aria-label=\"Picture of the map\">")?;
    writeln!(
        out,
        "<p class=\"no-picture\">The picture needs JavaScript and WebGL 2. All text below is complete without it.</p>"
    )?;
    writeln!(
        out,
        "</section>\n<p class=\"caption\">Left the source, right the {}. {}",
        data.target.name(),
        caption(data.target)
    )?;
    for note in &scene.manifest.notes {
        write!(out, " {}", escape(note))?;
    }
    out.write_all(b"</p>\n")
}

fn caption(target: TargetShape) -> &'static str {
    match target {
        TargetShape::Middle => SHELL_CAPTION,
        TargetShape::Section => SECTION_CAPTION,
        _ => CAPTION,
    }
}

pub(super) fn write_claim(verdict: &VerdictWords, out: &mut impl Write) -> io::Result<()> {
    let heading = if verdict.holds { "What was proved" } else { "What was found" };
    writeln!(out, "<section id=\"claim\">\n<h2>{heading}</h2>")?;
    for sentence in &verdict.sentences {
        writeln!(out, "<p>{}</p>", escape(sentence))?;
    }
    if !verdict.checked.is_empty() {
        writeln!(out, "<table class=\"counts\">\n<caption>Checked, and how many</caption>\n<tbody>")?;
        for (what, count) in &verdict.checked {
            let count = grouped(*count as usize);
            writeln!(out, "<tr><th scope=\"row\">{}</th><td>{count}</td></tr>", escape(what))?;
        }
        out.write_all(b"</tbody>\n</table>\n")?;
    }
    out.write_all(b"</section>\n")
}

fn write_limits(data: &ReportData, out: &mut impl Write) -> io::Result<()> {
    // True of every report, whatever the caller says.
    let how = match data.target {
        TargetShape::Middle => "the source is cut along the prisms in floating point",
        TargetShape::Section => "parts of triangles that are too small to be seen are left out",
        _ => "the map is interpolated linearly in each cell",
    };
    let drawn = format!("That this picture is exact: coordinates are rounded to 16 bits per axis, and {how}.");
    write_limit_list(&data.verdict.limits, &drawn, out)
}

/// What is not claimed, the picture last.
pub(super) fn write_limit_list(limits: &[String], drawn: &str, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "<section id=\"limits\">\n<h2>What is not claimed</h2>\n<ul>")?;
    for limit in limits {
        writeln!(out, "<li>{}</li>", escape(limit))?;
    }
    writeln!(out, "<li>{}</li>\n</ul>\n</section>", escape(drawn))
}

fn write_distortion(data: &ReportData, out: &mut impl Write) -> io::Result<()> {
    let Some(statistics) = Statistics::of(&data.distortion) else { return Ok(()) };
    writeln!(out, "<section id=\"distortion\">\n<h2>Distortion</h2>")?;
    writeln!(out, "<figure>{}<figcaption>", histogram_svg(&statistics))?;
    let (cells, cell) = match data.target {
        TargetShape::Middle => ("parts of source triangles, on each of which the projection is linear", "part"),
        TargetShape::Section => (
            "parts of source triangles, on each of which the map is linear (those with less than a millionth of the area of \
             their triangle are left out)",
            "part",
        ),
        _ => ("cells, interpolated linearly", "cell"),
    };
    write!(
        out,
        "{} {cells}. 1 means that the {cell} keeps its shape. Largest finite value {}",
        grouped(statistics.cells),
        rounded(statistics.largest)
    )?;
    match statistics.collapsed {
        0 => writeln!(out, "; no {cell} collapses.</figcaption></figure>")?,
        n => writeln!(
            out,
            "; {} without a finite value: the linear interpolant collapses them, which says nothing against the map itself.</figcaption></figure>",
            grouped(n)
        )?,
    }
    out.write_all(b"</section>\n")
}

pub(super) fn write_facts(
    facts: &[(String, String)],
    stage_seconds: &[(String, f64)],
    out: &mut impl Write,
) -> io::Result<()> {
    writeln!(out, "<section id=\"facts\">\n<h2>Facts</h2>\n<table>\n<tbody>")?;
    for (label, value) in facts {
        writeln!(out, "<tr><th scope=\"row\">{}</th><td>{}</td></tr>", escape(label), escape(value))?;
    }
    out.write_all(b"</tbody>\n</table>\n")?;
    if !stage_seconds.is_empty() {
        writeln!(out, "<table class=\"stages\">\n<caption>Seconds by stage (wall clock)</caption>\n<tbody>")?;
        let parts = stage_seconds.iter().filter(|(stage, _)| stage != "total");
        let longest = parts.map(|(_, seconds)| *seconds).fold(f64::MIN_POSITIVE, f64::max);
        for (stage, seconds) in stage_seconds {
            write!(
                out,
                "<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"bar\">",
                escape(stage),
                rounded(*seconds)
            )?;
            if stage != "total" {
                write!(out, "<span style=\"width:{:.1}%\"></span>", (100.0 * seconds / longest).clamp(0.0, 100.0))?;
            }
            out.write_all(b"</td></tr>\n")?;
        }
        out.write_all(b"</tbody>\n</table>\n")?;
    }
    out.write_all(b"</section>\n")
}

fn write_data(scene: &Scene, out: &mut impl Write) -> io::Result<()> {
    let manifest = serde_json::to_string(&scene.manifest).map_err(io::Error::other)?;
    writeln!(out, "<script type=\"application/json\" id=\"homeo-scene\">{}</script>", inside_json(&manifest))?;
    write!(out, "<script type=\"application/octet-stream;base64\" id=\"homeo-arrays\">")?;
    write_base64(&scene.block.bytes, out)?;
    out.write_all(b"</script>\n")
}

/// Text as HTML text or attribute value.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// A program inside `<script>`: no end tag and no comment start may occur in it.
pub(super) fn inside_script(program: &str) -> String {
    // In strings, templates and regular expressions, the only places where it can occur, `<\/` means `</`.
    program.replace("</script", "<\\/script").replace("<!--", "<\\!--")
}

/// JSON inside `<script>`.
pub(super) fn inside_json(json: &str) -> String {
    json.replace('<', "\\u003c")
}

/// A count with thin spaces between groups of three digits.
pub(super) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// Three significant digits, without an exponent where that reads well.
pub(super) fn rounded(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".into()
    } else if !value.is_finite() {
        "∞".into()
    } else if !(1e-4..1e6).contains(&size) {
        format!("{value:.2e}")
    } else if size >= 1000.0 {
        grouped(value.round() as usize)
    } else {
        let decimals = (2 - size.log10().floor() as i32).max(0) as usize;
        let text = format!("{value:.decimals$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
    }
}
