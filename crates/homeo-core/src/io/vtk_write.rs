//! VTK legacy, writing: version 3.0, an unstructured grid of polygons and then tetrahedra.
//!
//! Binary unless text is asked for. Attributes of vertices become point data; those of polygons and
//! tetrahedra cell data (an attribute that only one of the two kinds has is filled up on the other,
//! which is reported). Corners and texts are not held.

use std::io::Write;

use super::error::WriteError;
use super::mesh_file::{Attribute, Element, MeshFile, Values};
use super::text::{write_entry, write_point};
use super::write::{Encoding, Parcel, WriteOptions};

pub(super) fn write(out: &mut dyn Write, parcel: &mut Parcel<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    parcel.three_coordinates();
    let mesh = parcel.mesh;
    let is_text = options.encoding == Encoding::Text;
    let word = if is_text { "ASCII" } else { "BINARY" };
    write!(out, "# vtk DataFile Version 3.0\nhomeo\n{word}\nDATASET UNSTRUCTURED_GRID\n")?;
    writeln!(out, "POINTS {} double", mesh.vertex_count)?;
    for position in &mesh.positions {
        if is_text {
            write_point(out, position)?;
            out.write_all(b"\n")?;
        } else {
            position.iter().try_for_each(|x| out.write_all(&x.to_be_bytes()))?;
        }
    }
    if !is_text {
        out.write_all(b"\n")?;
    }
    write_cells(out, mesh, is_text)?;
    let points = take_point_data(parcel);
    write_data(out, "POINT_DATA", mesh.vertex_count, &points, is_text)?;
    let cells = take_cell_data(parcel);
    write_data(out, "CELL_DATA", mesh.polygons.len() + mesh.tetrahedra.len(), &cells, is_text)
}

fn write_int(out: &mut dyn Write, value: u32, is_text: bool, end: &[u8]) -> std::io::Result<()> {
    if is_text {
        write!(out, "{value}")?;
        out.write_all(end)
    } else {
        out.write_all(&value.to_be_bytes())
    }
}

fn write_cells(out: &mut dyn Write, mesh: &MeshFile, is_text: bool) -> Result<(), WriteError> {
    let count = mesh.polygons.len() + mesh.tetrahedra.len();
    let size = count + mesh.polygons.corners.len() + 4 * mesh.tetrahedra.len();
    if mesh.vertex_count > i32::MAX as usize || size > i32::MAX as usize {
        return Err(WriteError::of_mesh("the mesh is too large for VTK legacy 3.0 (31 bits); write VTU"));
    }
    writeln!(out, "CELLS {count} {size}")?;
    let cells = || mesh.polygons.iter().chain(mesh.tetrahedra.iter().map(|corners| &corners[..]));
    for cell in cells() {
        write_int(out, cell.len() as u32, is_text, b" ")?;
        for (index, &vertex) in cell.iter().enumerate() {
            write_int(out, vertex, is_text, if index + 1 == cell.len() { b"\n" } else { b" " })?;
        }
    }
    out.write_all(if is_text { b"" } else { b"\n" })?;
    writeln!(out, "CELL_TYPES {count}")?;
    for kind in cell_types(mesh) {
        write_int(out, u32::from(kind), is_text, b"\n")?;
    }
    out.write_all(if is_text { b"" } else { b"\n" })?;
    Ok(())
}

/// The VTK type of each cell.
pub(super) fn cell_types(mesh: &MeshFile) -> impl Iterator<Item = u8> + '_ {
    let of_size = |size: usize| match size {
        3 => 5,
        4 => 9,
        _ => 7,
    };
    let polygons = mesh.polygons.iter().map(move |polygon| of_size(polygon.len()));
    polygons.chain(std::iter::repeat_n(10, mesh.tetrahedra.len()))
}

/// A named table of numbers on all points or cells.
pub(super) struct DataArray {
    pub name: String,
    pub components: usize,
    pub values: Values,
}

pub(super) fn take_point_data(parcel: &mut Parcel<'_>) -> Vec<DataArray> {
    let mut arrays = Vec::new();
    let fits = |attribute: &Attribute| attribute.element == Element::Vertex && is_numeric(&attribute.values);
    while let Some(attribute) = parcel.take_where(fits) {
        let Attribute { name, components, values, .. } = attribute.clone();
        arrays.push(DataArray { name, components, values });
    }
    arrays
}

fn is_numeric(values: &Values) -> bool {
    !matches!(values, Values::Text(_))
}

/// Joins what polygons and tetrahedra have under one name.
pub(super) fn take_cell_data(parcel: &mut Parcel<'_>) -> Vec<DataArray> {
    let mut arrays = Vec::new();
    let is_cell = |element| matches!(element, Element::Polygon | Element::Tetrahedron);
    while let Some(first) = parcel.take_where(|a| is_cell(a.element) && is_numeric(&a.values)) {
        let second = parcel.take_where(|other| {
            is_cell(other.element)
                && other.element != first.element
                && other.name == first.name
                && other.components == first.components
                && std::mem::discriminant(&other.values) == std::mem::discriminant(&first.values)
        });
        let (polygons, tetrahedra) =
            if first.element == Element::Polygon { (Some(first), second) } else { (second, Some(first)) };
        let missing = match (polygons, tetrahedra) {
            (None, _) => Some(Element::Polygon),
            (_, None) => Some(Element::Tetrahedron),
            _ => None,
        };
        if let Some(element) = missing.filter(|&element| parcel.mesh.count(element) > 0) {
            let filler = if matches!(first.values, Values::I64(_)) { "0" } else { "NaN" };
            let (name, on) = (&first.name, element.plural());
            parcel
                .lose(format!("cell data covers all cells: the attribute \"{name}\" was filled with {filler} on {on}"));
        }
        let rows = |element| parcel.mesh.count(element) * first.components;
        let values = join(
            polygons.map(|attribute| &attribute.values),
            rows(Element::Polygon),
            tetrahedra.map(|attribute| &attribute.values),
            rows(Element::Tetrahedron),
        );
        arrays.push(DataArray { name: first.name.clone(), components: first.components, values });
    }
    arrays
}

fn join(first: Option<&Values>, first_length: usize, second: Option<&Values>, second_length: usize) -> Values {
    fn both<T: Copy>(first: Option<&Vec<T>>, second: Option<&Vec<T>>, lengths: [usize; 2], filler: T) -> Vec<T> {
        let mut joined = Vec::with_capacity(lengths[0] + lengths[1]);
        for (part, length) in [first, second].into_iter().zip(lengths) {
            match part {
                Some(values) => joined.extend_from_slice(values),
                None => joined.resize(joined.len() + length, filler),
            }
        }
        joined
    }
    let lengths = [first_length, second_length];
    match (first, second) {
        (Some(Values::F64(a)), Some(Values::F64(b))) => Values::F64(both(Some(a), Some(b), lengths, f64::NAN)),
        (Some(Values::F32(a)), Some(Values::F32(b))) => Values::F32(both(Some(a), Some(b), lengths, f32::NAN)),
        (Some(Values::I64(a)), Some(Values::I64(b))) => Values::I64(both(Some(a), Some(b), lengths, 0)),
        (Some(Values::F64(a)), _) => Values::F64(both(Some(a), None, lengths, f64::NAN)),
        (Some(Values::F32(a)), _) => Values::F32(both(Some(a), None, lengths, f32::NAN)),
        (Some(Values::I64(a)), _) => Values::I64(both(Some(a), None, lengths, 0)),
        (_, Some(Values::F64(b))) => Values::F64(both(None, Some(b), lengths, f64::NAN)),
        (_, Some(Values::F32(b))) => Values::F32(both(None, Some(b), lengths, f32::NAN)),
        (_, Some(Values::I64(b))) => Values::I64(both(None, Some(b), lengths, 0)),
        _ => Values::I64(Vec::new()),
    }
}

fn write_data(
    out: &mut dyn Write,
    section: &str,
    count: usize,
    arrays: &[DataArray],
    is_text: bool,
) -> Result<(), WriteError> {
    if arrays.is_empty() {
        return Ok(());
    }
    writeln!(out, "{section} {count}\nFIELD FieldData {}", arrays.len())?;
    for DataArray { name, components, values } in arrays {
        let kind = match values {
            Values::F64(_) => "double",
            Values::F32(_) => "float",
            Values::I64(_) | Values::Text(_) => "vtktypeint64",
        };
        writeln!(out, "{} {components} {count} {kind}", encode_name(name))?;
        for index in 0..values.len() {
            match values {
                _ if is_text => {
                    write_entry(out, values, index)?;
                    out.write_all(if (index + 1) % components == 0 { b"\n" } else { b" " })?;
                }
                Values::F64(values) => out.write_all(&values[index].to_be_bytes())?,
                Values::F32(values) => out.write_all(&values[index].to_be_bytes())?,
                Values::I64(values) => out.write_all(&values[index].to_be_bytes())?,
                Values::Text(_) => {}
            }
        }
        out.write_all(if is_text { b"" } else { b"\n" })?;
    }
    Ok(())
}

/// A name without blanks: VTK reads `%20` as one.
fn encode_name(name: &str) -> String {
    let mut encoded = String::new();
    for byte in name.bytes() {
        if byte.is_ascii_graphic() && byte != b'%' && byte != b'"' {
            encoded.push(char::from(byte));
        } else {
            encoded.push_str(&format!("%{byte:02X}"));
        }
    }
    if encoded.is_empty() { "%20".to_string() } else { encoded }
}
