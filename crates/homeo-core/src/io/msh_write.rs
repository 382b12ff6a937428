//! Gmsh MSH, writing: version 2.2, text unless binary is asked for.
//!
//! Written: triangles and quadrangles, then tetrahedra, with the whole-number attributes `tag`
//! (physical) and `entity` (elementary), physical names, and floating-point attributes of vertices
//! (`$NodeData`) and of polygons and tetrahedra (`$ElementData`) with up to nine components.

use std::io::Write;

use super::error::WriteError;
use super::mesh_file::{Attribute, Element, MeshFile, Values};
use super::text::{write_f64, write_point};
use super::write::{Encoding, Parcel, WriteOptions};

pub(super) fn write(out: &mut dyn Write, parcel: &mut Parcel<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    parcel.three_coordinates();
    let mesh = parcel.mesh;
    if let Some(polygon) = mesh.polygons.iter().find(|polygon| polygon.len() != 3 && polygon.len() != 4) {
        let count = polygon.len();
        return Err(WriteError::of_mesh(format!(
            "Gmsh MSH holds triangles and quadrangles, and a polygon has {count} corners; triangulate first"
        )));
    }
    if mesh.polygons.len() + mesh.tetrahedra.len() > i32::MAX as usize || mesh.vertex_count > i32::MAX as usize {
        return Err(WriteError::of_mesh("the mesh is too large for Gmsh MSH 2.2 (31 bits)"));
    }
    let is_text = options.encoding != Encoding::Binary;
    writeln!(out, "$MeshFormat\n2.2 {} 8", u8::from(!is_text))?;
    if !is_text {
        out.write_all(&1_i32.to_le_bytes())?;
        out.write_all(b"\n")?;
    }
    writeln!(out, "$EndMeshFormat")?;
    write_names(out, parcel)?;
    write_nodes(out, mesh, is_text)?;
    write_elements(out, parcel, is_text)?;
    write_data(out, parcel, is_text)
}

fn write_names(out: &mut dyn Write, parcel: &mut Parcel<'_>) -> Result<(), WriteError> {
    parcel.take_names();
    let names = &parcel.mesh.names;
    if names.is_empty() {
        return Ok(());
    }
    let clean = |name: &str| name.replace(|c: char| c.is_control() || c == '"', "_");
    if names.iter().any(|physical| clean(&physical.name) != physical.name) {
        parcel.lose("Gmsh MSH holds names of one line without quotes; some were changed");
    }
    writeln!(out, "$PhysicalNames\n{}", names.len())?;
    for physical in names {
        writeln!(out, "{} {} \"{}\"", physical.dimension, physical.tag, clean(&physical.name))?;
    }
    writeln!(out, "$EndPhysicalNames")?;
    Ok(())
}

fn write_nodes(out: &mut dyn Write, mesh: &MeshFile, is_text: bool) -> Result<(), WriteError> {
    writeln!(out, "$Nodes\n{}", mesh.vertex_count)?;
    for (vertex, position) in mesh.positions.iter().enumerate() {
        if is_text {
            write!(out, "{} ", vertex + 1)?;
            write_point(out, position)?;
            out.write_all(b"\n")?;
        } else {
            out.write_all(&(vertex as u32 + 1).to_le_bytes())?;
            position.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        }
    }
    out.write_all(if is_text { b"" } else { b"\n" })?;
    writeln!(out, "$EndNodes")?;
    Ok(())
}

fn write_elements(out: &mut dyn Write, parcel: &mut Parcel<'_>, is_text: bool) -> Result<(), WriteError> {
    let is_tag = |attribute: &Attribute| match &attribute.values {
        Values::I64(values) => attribute.components == 1 && values.iter().all(|&tag| i32::try_from(tag).is_ok()),
        _ => false,
    };
    let mut take = |name, element| parcel.take(name, element, is_tag).map(|attribute| &attribute.values);
    let polygon_tags = [take("tag", Element::Polygon), take("entity", Element::Polygon)];
    let tetrahedron_tags = [take("tag", Element::Tetrahedron), take("entity", Element::Tetrahedron)];
    let mesh = parcel.mesh;
    writeln!(out, "$Elements\n{}", mesh.polygons.len() + mesh.tetrahedra.len())?;
    let tags_of = |columns: [Option<&Values>; 2], index: usize| {
        columns.map(|column| match column {
            Some(Values::I64(tags)) => tags[index] as i32,
            _ => 0,
        })
    };
    let polygons = mesh.polygons.iter().enumerate().map(|(index, corners)| (corners, tags_of(polygon_tags, index)));
    let tetrahedra =
        mesh.tetrahedra.iter().enumerate().map(|(index, corners)| (&corners[..], tags_of(tetrahedron_tags, index)));
    let kinds = mesh.polygons.iter().map(|corners| corners.len() as i32 - 1);
    let kinds = kinds.chain(std::iter::repeat_n(4, mesh.tetrahedra.len()));
    for (index, ((corners, tags), kind)) in polygons.chain(tetrahedra).zip(kinds).enumerate() {
        let number = index as i32 + 1;
        if is_text {
            write!(out, "{number} {kind} 2 {} {}", tags[0], tags[1])?;
            corners.iter().try_for_each(|vertex| write!(out, " {}", vertex + 1))?;
            out.write_all(b"\n")?;
        } else {
            // A block for each element: larger ones would have to share type and number of tags.
            for value in [kind, 1, 2, number, tags[0], tags[1]] {
                out.write_all(&value.to_le_bytes())?;
            }
            corners.iter().try_for_each(|vertex| out.write_all(&(vertex + 1).to_le_bytes()))?;
        }
    }
    out.write_all(if is_text { b"" } else { b"\n" })?;
    writeln!(out, "$EndElements")?;
    Ok(())
}

fn write_data(out: &mut dyn Write, parcel: &mut Parcel<'_>, is_text: bool) -> Result<(), WriteError> {
    let fits = |attribute: &Attribute| {
        attribute.element != Element::Corner
            && (1..=9).contains(&attribute.components)
            && matches!(attribute.values, Values::F64(_))
            && !attribute.name.contains(|c: char| c.is_control() || c == '"')
    };
    while let Some(first) = parcel.take_where(fits) {
        let (name, components) = (&first.name, first.components);
        let is_node = first.element == Element::Vertex;
        let second = parcel.take_where(|other| {
            let is_pair = !is_node && other.element != Element::Vertex && other.element != first.element;
            is_pair && fits(other) && other.name == *name && other.components == components
        });
        let offset = |element| if element == Element::Tetrahedron { parcel.mesh.polygons.len() } else { 0 };
        let count = parcel.mesh.count(first.element) + second.map_or(0, |second| parcel.mesh.count(second.element));
        let section = if is_node { "NodeData" } else { "ElementData" };
        writeln!(out, "${section}\n1\n\"{name}\"\n1\n0.0\n3\n0\n{components}\n{count}")?;
        for attribute in [Some(first), second].into_iter().flatten() {
            let Values::F64(values) = &attribute.values else { continue };
            for (row, values) in values.chunks_exact(components).enumerate() {
                write_data_row(out, (offset(attribute.element) + row) as u32 + 1, values, is_text)?;
            }
        }
        out.write_all(if is_text { b"" } else { b"\n" })?;
        writeln!(out, "$End{section}")?;
    }
    Ok(())
}

fn write_data_row(out: &mut dyn Write, number: u32, values: &[f64], is_text: bool) -> std::io::Result<()> {
    if !is_text {
        out.write_all(&number.to_le_bytes())?;
        return values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()));
    }
    write!(out, "{number}")?;
    for &value in values {
        out.write_all(b" ")?;
        write_f64(out, value)?;
    }
    out.write_all(b"\n")
}
