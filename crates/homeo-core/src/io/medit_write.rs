//! MEDIT `.mesh` (text, version 2), writing.
//!
//! Written: vertices in two or three dimensions, triangles, quadrilaterals and tetrahedra with the
//! whole-number attribute `tag` as their reference (0 where there is none).

use std::io::Write;

use super::error::WriteError;
use super::mesh_file::{Attribute, Element, Values};
use super::text::write_point;
use super::write::{Parcel, WriteOptions};

pub(super) fn write(out: &mut dyn Write, parcel: &mut Parcel<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    parcel.text_only(options)?;
    let is_tag = |attribute: &Attribute| attribute.components == 1 && matches!(attribute.values, Values::I64(_));
    let vertex_tags = parcel.take("tag", Element::Vertex, is_tag);
    let polygon_tags = parcel.take("tag", Element::Polygon, is_tag);
    let tetrahedron_tags = parcel.take("tag", Element::Tetrahedron, is_tag);
    let mesh = parcel.mesh;
    writeln!(out, "MeshVersionFormatted 2\nDimension {}\nVertices\n{}", mesh.space, mesh.vertex_count)?;
    for (vertex, position) in mesh.positions.iter().enumerate() {
        write_point(out, &position[..mesh.space])?;
        writeln!(out, " {}", tag(vertex_tags, vertex))?;
    }
    write_polygons(out, parcel, polygon_tags)?;
    if !mesh.tetrahedra.is_empty() {
        writeln!(out, "Tetrahedra\n{}", mesh.tetrahedra.len())?;
    }
    for (index, [a, b, c, d]) in mesh.tetrahedra.iter().enumerate() {
        let tag = tag(tetrahedron_tags, index);
        writeln!(out, "{} {} {} {} {tag}", a + 1, b + 1, c + 1, d + 1)?;
    }
    writeln!(out, "End")?;
    Ok(())
}

fn tag(tags: Option<&Attribute>, index: usize) -> i64 {
    match tags.map(|attribute| &attribute.values) {
        Some(Values::I64(values)) => values[index],
        _ => 0,
    }
}

/// Runs of triangles and of quadrilaterals become one section each, so that the order is kept.
fn write_polygons(out: &mut dyn Write, parcel: &mut Parcel<'_>, tags: Option<&Attribute>) -> Result<(), WriteError> {
    let polygons = &parcel.mesh.polygons;
    let sizes: Vec<u32> = polygons.starts.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if let Some(index) = sizes.iter().position(|&size| size != 3 && size != 4) {
        let size = sizes[index];
        return Err(WriteError::of_mesh(format!(
            "MEDIT holds triangles and quadrilaterals, and polygon {index} has {size} corners; triangulate first"
        )));
    }
    let mut first = 0;
    for run in sizes.chunk_by(|a, b| a == b) {
        let word = if run[0] == 3 { "Triangles" } else { "Quadrilaterals" };
        writeln!(out, "{word}\n{}", run.len())?;
        for index in first..first + run.len() {
            for vertex in polygons.polygon(index) {
                write!(out, "{} ", vertex + 1)?;
            }
            writeln!(out, "{}", tag(tags, index))?;
        }
        first += run.len();
    }
    Ok(())
}
