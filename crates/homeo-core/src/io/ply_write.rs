//! PLY, writing: binary little endian unless text is asked for.
//!
//! Written: vertices in double precision (two or three coordinates), faces, all attributes of
//! numbers on vertices, polygons and corners, under the conventional property names where there are
//! some (see the reader), else as `name` or `name_0 name_1 …`. Whole numbers take the narrowest
//! type that holds them all. Texts, tetrahedra and names of tags are not held.

use std::io::Write;

use super::error::WriteError;
use super::mesh_file::{Attribute, Element, Values};
use super::text::{write_entry, write_point};
use super::write::{Encoding, Parcel, WriteOptions};

pub(super) fn write(out: &mut dyn Write, parcel: &mut Parcel<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    parcel.surface_only()?;
    let mesh = parcel.mesh;
    let mut taken: Vec<String> = ["x", "y", "z"][..mesh.space].iter().map(|name| name.to_string()).collect();
    let on_vertices = take_columns(parcel, Element::Vertex, &mut taken);
    let mut taken = vec!["vertex_indices".to_string(), "vertex_index".to_string()];
    let on_polygons = take_columns(parcel, Element::Polygon, &mut taken);
    let on_corners = take_columns(parcel, Element::Corner, &mut taken);
    let is_text = options.encoding == Encoding::Text;
    let format = if is_text { "ascii" } else { "binary_little_endian" };
    writeln!(out, "ply\nformat {format} 1.0\nelement vertex {}", mesh.vertex_count)?;
    for axis in &["x", "y", "z"][..mesh.space] {
        writeln!(out, "property double {axis}")?;
    }
    write_properties(out, &on_vertices)?;
    writeln!(out, "element face {}\nproperty list uint uint vertex_indices", mesh.polygons.len())?;
    for Columns { attribute, names, kind } in &on_corners {
        let _ = attribute;
        writeln!(out, "property list uint {kind} {}", names[0])?;
    }
    write_properties(out, &on_polygons)?;
    writeln!(out, "end_header")?;
    let mut row = Row { out, is_text };
    for (vertex, position) in mesh.positions.iter().enumerate() {
        row.coordinates(&position[..mesh.space])?;
        row.entries(&on_vertices, vertex)?;
        row.end()?;
    }
    let mut corner = 0;
    for (index, polygon) in mesh.polygons.iter().enumerate() {
        row.list(polygon)?;
        for Columns { attribute, kind, .. } in &on_corners {
            let width = attribute.components;
            row.length(polygon.len() * width)?;
            for entry in corner * width..(corner + polygon.len()) * width {
                row.entry(&attribute.values, kind, entry)?;
            }
        }
        corner += polygon.len();
        row.entries(&on_polygons, index)?;
        row.end()?;
    }
    Ok(())
}

/// An attribute as the properties that it becomes.
struct Columns<'a> {
    attribute: &'a Attribute,
    names: Vec<String>,
    kind: &'static str,
}

/// Takes all attributes of an element that PLY can hold; names stay unique.
fn take_columns<'a>(parcel: &mut Parcel<'a>, element: Element, taken: &mut Vec<String>) -> Vec<Columns<'a>> {
    let mut columns = Vec::new();
    loop {
        let is_free = |attribute: &Attribute| {
            attribute.element == element
                && kind_of(&attribute.values).is_some()
                && property_names(attribute).is_some_and(|names| names.iter().all(|name| !taken.contains(name)))
        };
        let Some(attribute) = parcel.take_where(is_free) else { return columns };
        let (Some(names), Some(kind)) = (property_names(attribute), kind_of(&attribute.values)) else { return columns };
        taken.extend(names.iter().cloned());
        columns.push(Columns { attribute, names, kind });
    }
}

/// The names of the properties, or `None` where PLY cannot spell them.
fn property_names(attribute: &Attribute) -> Option<Vec<String>> {
    let name = attribute.name.as_str();
    let words = |words: &[&str]| Some(words.iter().map(|word| word.to_string()).collect());
    if name.is_empty() || !name.chars().all(|c| c.is_ascii_graphic()) {
        return None;
    }
    match (attribute.element, name, attribute.components) {
        (Element::Corner, "texture", 2) => words(&["texcoord"]),
        (Element::Corner, _, _) => words(&[name]),
        (_, "normal", 3) => words(&["nx", "ny", "nz"]),
        (_, "color", 3) => words(&["red", "green", "blue"]),
        (_, "color", 4) => words(&["red", "green", "blue", "alpha"]),
        (_, "texture", 2) => words(&["s", "t"]),
        (_, _, 1) => words(&[name]),
        (_, _, count) if count <= 64 => Some((0..count).map(|index| format!("{name}_{index}")).collect()),
        _ => None,
    }
}

/// The narrowest type, or `None` for what PLY cannot hold.
fn kind_of(values: &Values) -> Option<&'static str> {
    match values {
        Values::F64(_) => Some("double"),
        Values::F32(_) => Some("float"),
        Values::I64(values) => {
            let low = values.iter().copied().min().unwrap_or(0);
            let high = values.iter().copied().max().unwrap_or(0);
            match (low, high) {
                (0.., ..=255) => Some("uchar"),
                (-2_147_483_648.., ..=2_147_483_647) => Some("int"),
                (0.., ..=4_294_967_295) => Some("uint"),
                _ => None,
            }
        }
        Values::Text(_) => None,
    }
}

fn write_properties(out: &mut dyn Write, columns: &[Columns<'_>]) -> std::io::Result<()> {
    for Columns { names, kind, .. } in columns {
        for name in names {
            writeln!(out, "property {kind} {name}")?;
        }
    }
    Ok(())
}

/// Writes the numbers of a row, text or binary.
struct Row<'a> {
    out: &'a mut dyn Write,
    is_text: bool,
}

impl Row<'_> {
    fn coordinates(&mut self, position: &[f64]) -> std::io::Result<()> {
        if self.is_text {
            return write_point(self.out, position);
        }
        position.iter().try_for_each(|x| self.out.write_all(&x.to_le_bytes()))
    }

    fn length(&mut self, length: usize) -> std::io::Result<()> {
        let length = u32::try_from(length).map_err(|_| std::io::Error::other("a list is too long for PLY"))?;
        if self.is_text { write!(self.out, " {length}") } else { self.out.write_all(&length.to_le_bytes()) }
    }

    fn list(&mut self, vertices: &[u32]) -> std::io::Result<()> {
        if self.is_text {
            write!(self.out, "{}", vertices.len())?;
            return vertices.iter().try_for_each(|vertex| write!(self.out, " {vertex}"));
        }
        self.length(vertices.len())?;
        vertices.iter().try_for_each(|vertex| self.out.write_all(&vertex.to_le_bytes()))
    }

    fn entries(&mut self, columns: &[Columns<'_>], row: usize) -> std::io::Result<()> {
        for Columns { attribute, kind, .. } in columns {
            for entry in row * attribute.components..(row + 1) * attribute.components {
                self.entry(&attribute.values, kind, entry)?;
            }
        }
        Ok(())
    }

    fn entry(&mut self, values: &Values, kind: &str, index: usize) -> std::io::Result<()> {
        if self.is_text {
            self.out.write_all(b" ")?;
            return write_entry(self.out, values, index);
        }
        match values {
            Values::F64(values) => self.out.write_all(&values[index].to_le_bytes()),
            Values::F32(values) => self.out.write_all(&values[index].to_le_bytes()),
            // The narrow types hold all values: see `kind_of`.
            Values::I64(values) if kind == "uchar" => self.out.write_all(&[values[index] as u8]),
            Values::I64(values) => self.out.write_all(&(values[index] as u32).to_le_bytes()),
            Values::Text(_) => Ok(()),
        }
    }

    fn end(&mut self) -> std::io::Result<()> {
        if self.is_text { self.out.write_all(b"\n") } else { Ok(()) }
    }
}
