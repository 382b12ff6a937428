//! VTU, writing: inline base64 unless text is asked for; polygons first and then tetrahedra.
//!
//! Attributes of vertices become point data, those of polygons and tetrahedra cell data, as in VTK
//! legacy. Corners and texts are not held.

use std::io::Write;

use super::error::WriteError;
use super::mesh_file::Values;
use super::text::write_entry;
use super::vtk_write::{DataArray, cell_types, take_cell_data, take_point_data};
use super::vtu_blocks::encode_base64;
use super::write::{Encoding, Parcel, WriteOptions};
use super::xml::escape;

pub(super) fn write(out: &mut dyn Write, parcel: &mut Parcel<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    parcel.three_coordinates();
    let mesh = parcel.mesh;
    let mut writer = ArrayWriter { out, is_text: options.encoding == Encoding::Text };
    let count = mesh.polygons.len() + mesh.tetrahedra.len();
    writer.out.write_all(
        b"<?xml version=\"1.0\"?>\n\
          <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
          <UnstructuredGrid>\n",
    )?;
    writeln!(writer.out, "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{count}\">", mesh.vertex_count)?;
    writer.section("PointData", &take_point_data(parcel))?;
    writer.section("CellData", &take_cell_data(parcel))?;
    let array = |name: &str, components, values| DataArray { name: name.to_string(), components, values };
    let positions = Values::F64(mesh.positions.as_flattened().to_vec());
    writer.section("Points", &[array("Points", 3, positions)])?;
    let cells = || mesh.polygons.iter().chain(mesh.tetrahedra.iter().map(|corners| &corners[..]));
    let connectivity = cells().flatten().map(|&vertex| i64::from(vertex)).collect();
    let ends = cells().scan(0, |end, cell| {
        *end += cell.len() as i64;
        Some(*end)
    });
    let kinds = cell_types(mesh).map(i64::from).collect();
    writer.section(
        "Cells",
        &[
            array("connectivity", 1, Values::I64(connectivity)),
            array("offsets", 1, Values::I64(ends.collect())),
            array("types", 1, Values::I64(kinds)),
        ],
    )?;
    writer.out.write_all(b"</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")?;
    Ok(())
}

struct ArrayWriter<'a> {
    out: &'a mut dyn Write,
    is_text: bool,
}

impl ArrayWriter<'_> {
    fn section(&mut self, name: &str, arrays: &[DataArray]) -> std::io::Result<()> {
        writeln!(self.out, "<{name}>")?;
        for array in arrays {
            self.array(array, name == "Cells" && array.name == "types")?;
        }
        writeln!(self.out, "</{name}>")
    }

    /// The types of cells are bytes by convention.
    fn array(&mut self, array: &DataArray, is_bytes: bool) -> std::io::Result<()> {
        let DataArray { name, components, values } = array;
        let kind = match values {
            Values::F64(_) => "Float64",
            Values::F32(_) => "Float32",
            Values::I64(_) | Values::Text(_) if is_bytes => "UInt8",
            Values::I64(_) | Values::Text(_) => "Int64",
        };
        let format = if self.is_text { "ascii" } else { "binary" };
        let name = escape(name);
        writeln!(
            self.out,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"{format}\">"
        )?;
        if self.is_text {
            for index in 0..values.len() {
                write_entry(self.out, values, index)?;
                self.out.write_all(if (index + 1) % components == 0 { b"\n" } else { b" " })?;
            }
        } else {
            self.out.write_all(&encode_base64(&block_of(values, is_bytes)))?;
            self.out.write_all(b"\n")?;
        }
        writeln!(self.out, "</DataArray>")
    }
}

/// The numbers with the length of their bytes in front.
fn block_of(values: &Values, is_bytes: bool) -> Vec<u8> {
    let size = match values {
        Values::F64(_) => 8,
        Values::F32(_) => 4,
        Values::I64(_) | Values::Text(_) => {
            if is_bytes {
                1
            } else {
                8
            }
        }
    };
    let length = values.len() * size;
    let mut block = Vec::with_capacity(length + 8);
    block.extend_from_slice(&(length as u64).to_le_bytes());
    match values {
        Values::F64(values) => values.iter().for_each(|value| block.extend_from_slice(&value.to_le_bytes())),
        Values::F32(values) => values.iter().for_each(|value| block.extend_from_slice(&value.to_le_bytes())),
        Values::I64(values) if is_bytes => values.iter().for_each(|&value| block.push(value as u8)),
        Values::I64(values) => values.iter().for_each(|value| block.extend_from_slice(&value.to_le_bytes())),
        Values::Text(_) => {}
    }
    block
}
