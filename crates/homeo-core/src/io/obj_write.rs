//! Wavefront OBJ, writing.
//!
//! Written: vertices with the attribute `color`, corners with `texture` and `normal` (each distinct
//! row once), the polygon texts `object`, `group`, `smoothing` and `material`, material libraries.

use std::collections::HashMap;
use std::io::Write;

use super::error::WriteError;
use super::mesh_file::{Attribute, Element, Values};
use super::text::{write_f64, write_point, write_row};
use super::write::{Parcel, WriteOptions};

pub(super) fn write(out: &mut dyn Write, parcel: &mut Parcel<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    parcel.text_only(options)?;
    parcel.surface_only()?;
    parcel.three_coordinates();
    parcel.take_libraries();
    for library in &parcel.mesh.material_libraries {
        writeln!(out, "mtllib {}", one_line(library))?;
    }
    write_vertices(out, parcel)?;
    let texture = take_corner_table(parcel, "texture", &[2, 3]);
    let normal = take_corner_table(parcel, "normal", &[3]);
    for (table, keyword) in [(&texture, "vt"), (&normal, "vn")] {
        for row in table.iter().flat_map(|table| &table.rows) {
            write!(out, "{keyword} ")?;
            write_point(out, row)?;
            out.write_all(b"\n")?;
        }
    }
    let texts = take_texts(parcel);
    write_faces(out, parcel, [texture.as_ref(), normal.as_ref()], &texts)
}

fn write_vertices(out: &mut dyn Write, parcel: &mut Parcel<'_>) -> Result<(), WriteError> {
    let color = parcel.take("color", Element::Vertex, |attribute| {
        matches!(attribute.components, 3 | 4) && !matches!(attribute.values, Values::Text(_))
    });
    if color.is_some_and(|color| matches!(color.values, Values::I64(_))) {
        parcel.lose("OBJ holds colours from 0 to 1; whole numbers were divided by 255");
    }
    for (vertex, position) in parcel.mesh.positions.iter().enumerate() {
        out.write_all(b"v ")?;
        write_point(out, position)?;
        if let Some(color) = color {
            write_color(out, color, vertex)?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

/// A colour with a missing entry is left out: the reader then finds it missing.
fn write_color(out: &mut dyn Write, color: &Attribute, vertex: usize) -> std::io::Result<()> {
    let range = vertex * color.components..(vertex + 1) * color.components;
    let row: Vec<f64> = match &color.values {
        Values::F64(values) => values[range].to_vec(),
        Values::F32(values) => values[range].iter().map(|&value| f64::from(value)).collect(),
        Values::I64(values) => values[range].iter().map(|&value| value as f64 / 255.0).collect(),
        Values::Text(_) => return Ok(()),
    };
    let length = row.iter().position(|value| value.is_nan()).unwrap_or(row.len());
    for &value in &row[..if length >= 3 { length } else { 0 }] {
        out.write_all(b" ")?;
        write_f64(out, value)?;
    }
    Ok(())
}

/// The distinct rows of a corner attribute, and the row of each corner counted from 1 (0 for none).
struct CornerTable {
    rows: Vec<Vec<f64>>,
    corners: Vec<usize>,
}

fn take_corner_table(parcel: &mut Parcel<'_>, name: &str, components: &[usize]) -> Option<CornerTable> {
    let fits = |attribute: &Attribute| {
        components.contains(&attribute.components) && matches!(attribute.values, Values::F64(_) | Values::F32(_))
    };
    let corners = &parcel.mesh.polygons.corners;
    let (attribute, row_of_corner): (_, Vec<usize>) = match parcel.take(name, Element::Corner, fits) {
        Some(attribute) => (attribute, (0..corners.len()).collect()),
        None => {
            let attribute = parcel.take(name, Element::Vertex, fits)?;
            parcel.lose(format!("OBJ holds the attribute \"{name}\" on corners; it was moved there from the vertices"));
            (attribute, corners.iter().map(|&vertex| vertex as usize).collect())
        }
    };
    let width = attribute.components;
    let entry = |index: usize| match &attribute.values {
        Values::F64(values) => values[index],
        Values::F32(values) => f64::from(values[index]),
        Values::I64(_) | Values::Text(_) => f64::NAN,
    };
    let mut table = CornerTable { rows: Vec::new(), corners: Vec::with_capacity(corners.len()) };
    let mut known = HashMap::new();
    for row in row_of_corner {
        let values: Vec<f64> = (0..width).map(|component| entry(row * width + component)).collect();
        if values.iter().any(|value| value.is_nan()) {
            table.corners.push(0);
            continue;
        }
        let bits: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        let index = *known.entry(bits).or_insert_with(|| {
            table.rows.push(values);
            table.rows.len()
        });
        table.corners.push(index);
    }
    Some(table)
}

fn take_texts<'a>(parcel: &mut Parcel<'a>) -> Vec<(&'static str, &'a Attribute)> {
    let is_text = |attribute: &Attribute| attribute.components == 1 && matches!(attribute.values, Values::Text(_));
    let names = [("object", "o"), ("group", "g"), ("smoothing", "s"), ("material", "usemtl")];
    let mut texts = Vec::new();
    for (name, keyword) in names {
        let Some(attribute) = parcel.take(name, Element::Polygon, is_text) else { continue };
        let Values::Text(values) = &attribute.values else { continue };
        if values.iter().any(|text| one_line(text) != **text) {
            parcel.lose(format!("OBJ holds names of one line without #; some of \"{name}\" were changed"));
        }
        texts.push((keyword, attribute));
    }
    texts
}

/// A name that survives in one line of OBJ.
fn one_line(text: &str) -> String {
    let clean: String = text.trim().chars().map(|c| if c.is_control() || c == '#' { '_' } else { c }).collect();
    match clean.strip_suffix('\\') {
        Some(rest) => format!("{rest}_"),
        None => clean,
    }
}

fn write_faces(
    out: &mut dyn Write,
    parcel: &Parcel<'_>,
    [texture, normal]: [Option<&CornerTable>; 2],
    texts: &[(&str, &Attribute)],
) -> Result<(), WriteError> {
    let mut corner = 0;
    for (index, polygon) in parcel.mesh.polygons.iter().enumerate() {
        for (keyword, attribute) in texts {
            write_text_change(out, keyword, attribute, index)?;
        }
        out.write_all(b"f")?;
        for vertex in polygon {
            let texture = texture.map_or(0, |table| table.corners[corner]);
            let normal = normal.map_or(0, |table| table.corners[corner]);
            let vertex = vertex + 1;
            match (texture, normal) {
                (0, 0) => write!(out, " {vertex}")?,
                (_, 0) => write!(out, " {vertex}/{texture}")?,
                (0, _) => write!(out, " {vertex}//{normal}")?,
                _ => write!(out, " {vertex}/{texture}/{normal}")?,
            }
            corner += 1;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

fn write_text_change(out: &mut dyn Write, keyword: &str, attribute: &Attribute, index: usize) -> std::io::Result<()> {
    let Values::Text(texts) = &attribute.values else { return Ok(()) };
    if index > 0 && texts[index] == texts[index - 1] {
        return Ok(());
    }
    write!(out, "{keyword} ")?;
    write_row(out, &Values::Text(vec![one_line(&texts[index]).into()]), 1, 0)?;
    out.write_all(b"\n")
}
