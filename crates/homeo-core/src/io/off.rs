//! OFF, the Object File Format of Geomview.
//!
//! Read: `OFF` and the prefixes `ST`, `C`, `N` (texture coordinates, colours, normals), or no header
//! word; counts on the first line or the next; comments; polygons of any size; colours behind faces.
//! Text only; the binary, 4-dimensional and n-dimensional variants are refused by name.
//!
//! Written: text with the prefixes that the vertex attributes `normal` (3), `color` (3 or 4) and
//! `texture` (2) need, and the polygon attribute `color`.

use std::io::Write;

use super::build::{PartialRows, read_polygon};
use super::error::{Outcome, WriteError};
use super::mesh_file::{Attribute, Element, MeshFile, Values};
use super::scan::{Scanner, parse_f64, parse_u64, show};
use super::text::{write_entry, write_point, write_row};
use super::write::{Parcel, WriteOptions};

/// What the header word announces behind the position of each vertex.
#[derive(Clone, Copy, Default)]
struct Layout {
    texture: bool,
    color: bool,
    normal: bool,
}

pub(super) fn read(bytes: &[u8]) -> Outcome<MeshFile> {
    let mut scanner = Scanner::with_comments(bytes);
    let layout = read_header(&mut scanner)?;
    let vertex_count = scanner.unsigned("the number of vertices")?;
    let polygon_count = scanner.unsigned("the number of faces")?;
    // The number of edges is not needed and sometimes missing.
    scanner.token_in_line();
    let vertex_count = scanner.claim(vertex_count, 6, "vertices")?;
    let mut mesh = MeshFile { space: 3, ..MeshFile::default() };
    read_vertices(&mut scanner, &mut mesh, vertex_count, layout)?;
    read_faces(&mut scanner, &mut mesh, polygon_count)?;
    if scanner.token().is_some() {
        return Err(scanner.fault(
            "bad-syntax",
            "there is data after the last face; vertices with normals, colours or texture coordinates need a header \
             word that says so, such as COFF",
        ));
    }
    Ok(mesh)
}

fn read_header(scanner: &mut Scanner<'_>) -> Outcome<Layout> {
    let mut layout = Layout::default();
    let first = scanner.peek().unwrap_or_default();
    if parse_u64(first).is_some() {
        return Ok(layout);
    }
    let word = scanner.expect("the header word")?;
    let Some(mut prefix) = word.strip_suffix(b"OFF") else {
        return Err(scanner.fault("bad-header", format!("an OFF file begins with OFF, not with \"{}\"", show(word))));
    };
    for (letters, flag) in [(&b"ST"[..], &mut layout.texture), (b"C", &mut layout.color), (b"N", &mut layout.normal)] {
        if let Some(rest) = prefix.strip_prefix(letters) {
            (prefix, *flag) = (rest, true);
        }
    }
    if !prefix.is_empty() || scanner.peek() == Some(b"BINARY") {
        return Err(scanner.fault(
            "unsupported-variant",
            "only three-dimensional text variants of OFF are read (OFF, COFF, NOFF, STOFF and their combinations)",
        ));
    }
    Ok(layout)
}

fn read_vertices(scanner: &mut Scanner<'_>, mesh: &mut MeshFile, count: usize, layout: Layout) -> Outcome<()> {
    mesh.positions.reserve_exact(count);
    if !(layout.texture || layout.color || layout.normal) {
        for _ in 0..count {
            mesh.positions.push([scanner.coordinate()?, scanner.coordinate()?, scanner.coordinate()?]);
        }
        return Ok(());
    }
    let (mut normals, mut colors, mut textures) = (Vec::new(), PartialRows::default(), Vec::new());
    for _ in 0..count {
        mesh.positions.push([scanner.coordinate()?, scanner.coordinate()?, scanner.coordinate()?]);
        if layout.normal {
            for _ in 0..3 {
                normals.push(scanner.float("a normal")?);
            }
        }
        let (row, length, has_fraction) = read_extras::<8>(scanner)?;
        let behind = if layout.texture { 2 } else { 0 };
        if length < behind || length - behind > if layout.color { 4 } else { 0 } {
            let message = "the line of this vertex holds more or fewer numbers than the header word announces";
            return Err(scanner.fault("bad-syntax", message));
        }
        let (color, texture) = row[..length].split_at(length - behind);
        colors.push(color);
        textures.extend_from_slice(texture);
        if has_fraction && !layout.texture {
            colors.mark_fraction();
        }
    }
    // With texture coordinates on the line the spelling of the colours is not told apart: keep doubles.
    if layout.texture {
        colors.mark_fraction();
    }
    let attribute = |name: &str, components, values: Vec<f64>| {
        let values = Values::F64(values);
        Attribute { name: name.to_string(), element: Element::Vertex, components, values }
    };
    mesh.attributes.extend(layout.normal.then(|| attribute("normal", 3, normals)));
    mesh.attributes.extend(colors.finish("color", Element::Vertex));
    mesh.attributes.extend(layout.texture.then(|| attribute("texture", 2, textures)));
    Ok(())
}

fn read_faces(scanner: &mut Scanner<'_>, mesh: &mut MeshFile, count: u64) -> Outcome<()> {
    let count = scanner.claim(count, 8, "faces")?;
    let vertex_count = mesh.positions.len();
    mesh.polygons.starts.reserve_exact(count + 1);
    mesh.polygons.corners.reserve(3 * count);
    let mut colors = PartialRows::default();
    for _ in 0..count {
        let corners = scanner.unsigned("the number of corners of a face")?;
        read_polygon(scanner, &mut mesh.polygons, corners, vertex_count)?;
        let (row, length, has_fraction) = read_extras::<4>(scanner)?;
        colors.push(&row[..length]);
        if has_fraction {
            colors.mark_fraction();
        }
    }
    mesh.attributes.extend(colors.finish("color", Element::Polygon));
    Ok(())
}

/// The numbers left on this line, at most `N`: how many, and whether one is not a whole number.
fn read_extras<const N: usize>(scanner: &mut Scanner<'_>) -> Outcome<([f64; N], usize, bool)> {
    let mut row = [0.0; N];
    let mut length = 0;
    let mut has_fraction = false;
    while let Some(token) = scanner.token_in_line() {
        let Some(value) = parse_f64(token) else {
            return Err(scanner.fault("bad-number", format!("expected a number, found \"{}\"", show(token))));
        };
        if length == N {
            return Err(scanner.fault("bad-syntax", "there are more numbers on this line than OFF allows"));
        }
        row[length] = value;
        length += 1;
        has_fraction |= super::scan::parse_i64(token).is_none() || value.abs() > 1e15;
    }
    Ok((row, length, has_fraction))
}

/// Numbers that OFF can hold as colours.
fn is_color(attribute: &Attribute) -> bool {
    let is_small = match &attribute.values {
        Values::F64(values) => values.iter().all(|value| !value.is_nan()),
        Values::I64(values) => values.iter().all(|value| value.abs() <= 1_000_000_000_000_000),
        Values::F32(_) | Values::Text(_) => false,
    };
    is_small && matches!(attribute.components, 3 | 4)
}

fn is_f64(attribute: &Attribute, components: usize) -> bool {
    attribute.components == components && matches!(attribute.values, Values::F64(_))
}

pub(super) fn write(out: &mut dyn Write, parcel: &mut Parcel<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    parcel.text_only(options)?;
    parcel.surface_only()?;
    parcel.three_coordinates();
    let normal = parcel.take("normal", Element::Vertex, |a| is_f64(a, 3));
    let texture = parcel.take("texture", Element::Vertex, |a| is_f64(a, 2));
    let color = parcel.take("color", Element::Vertex, is_color);
    let face_color = parcel.take("color", Element::Polygon, is_color);
    let mesh = parcel.mesh;
    let word = [(texture, "ST"), (color, "C"), (normal, "N")];
    for (attribute, letters) in word {
        out.write_all(if attribute.is_some() { letters.as_bytes() } else { b"" })?;
    }
    writeln!(out, "OFF\n{} {} 0", mesh.vertex_count, mesh.polygons.len())?;
    for (vertex, position) in mesh.positions.iter().enumerate() {
        write_point(out, position)?;
        for attribute in [normal, color, texture].into_iter().flatten() {
            out.write_all(b" ")?;
            write_row(out, &attribute.values, attribute.components, vertex)?;
        }
        out.write_all(b"\n")?;
    }
    for (index, polygon) in mesh.polygons.iter().enumerate() {
        write!(out, "{}", polygon.len())?;
        for vertex in polygon {
            write!(out, " {vertex}")?;
        }
        if let Some(attribute) = face_color {
            for component in 0..attribute.components {
                out.write_all(b" ")?;
                write_entry(out, &attribute.values, index * attribute.components + component)?;
            }
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}
