//! The sections `$NodeData` and `$ElementData` of MSH files.

use std::collections::HashMap;

use super::error::Outcome;
use super::mesh_file::{Attribute, Element, Values};
use super::msh::Reader;
use super::msh_numbers::Numbers;
use super::scan::show;

/// Reads one section behind its opening mark, as attributes of vertices, or of polygons and
/// tetrahedra; rows that the section does not give are NaN.
pub(super) fn read_data(reader: &mut Reader, numbers: &mut Numbers<'_>, element: Element) -> Outcome<()> {
    let (name, components, count) = read_head(numbers)?;
    let count = numbers.claim(count, 2 * (components + 1), 4 + 8 * components, "rows of data")?;
    let mut rows = HashMap::with_capacity(count);
    let mut values = Vec::with_capacity(count * components);
    for row in 0..count as u32 {
        rows.insert(numbers.int_as_size("the number of a node or element")?, row);
        for _ in 0..components {
            values.push(numbers.float("a value")?);
        }
    }
    let mesh = &reader.mesh;
    // An attribute is as large as the mesh however short its section is: that must not multiply.
    let elements = match element {
        Element::Vertex => mesh.positions.len(),
        _ => mesh.polygons.len() + mesh.tetrahedra.len(),
    };
    let Some(left) = reader.data_budget.checked_sub(elements * components) else {
        reader.mesh.losses.push(format!("the data \"{name}\" was left out: there is too much data of few elements"));
        return Ok(());
    };
    reader.data_budget = left;
    let (polygons, tetrahedra) = (&reader.polygon_numbers, &reader.tetrahedron_numbers);
    let gather = |element: Element, of: &mut dyn Iterator<Item = u64>| {
        let mut column = Vec::with_capacity(mesh.count(element) * components);
        let mut is_empty = true;
        for number in of {
            match rows.get(&number) {
                Some(&row) => {
                    let start = row as usize * components;
                    column.extend_from_slice(&values[start..start + components]);
                    is_empty = false;
                }
                None => column.resize(column.len() + components, f64::NAN),
            }
        }
        let values = Values::F64(column);
        (!is_empty).then(|| Attribute { name: name.clone(), element, components, values })
    };
    let attributes = match element {
        Element::Vertex => [gather(Element::Vertex, &mut reader.nodes.iter()), None],
        _ => [
            gather(Element::Polygon, &mut polygons.iter().copied()),
            gather(Element::Tetrahedron, &mut tetrahedra.iter().copied()),
        ],
    };
    reader.mesh.attributes.extend(attributes.into_iter().flatten());
    Ok(())
}

/// The name, the components of a row and the number of rows.
fn read_head(numbers: &mut Numbers<'_>) -> Outcome<(String, usize, u64)> {
    let scanner = &mut numbers.scanner;
    let strings = scanner.unsigned("the number of names")?;
    scanner.line();
    let mut name = String::new();
    for index in 0..scanner.claim(strings, 1, "names")? {
        let line = scanner.line().unwrap_or_default().trim_ascii();
        let text = line.strip_prefix(b"\"").and_then(|line| line.strip_suffix(b"\"")).unwrap_or(line);
        if index == 0 {
            name = String::from_utf8_lossy(text).into_owned();
        }
    }
    let reals = scanner.unsigned("the number of real tags")?;
    for _ in 0..scanner.claim(reals, 2, "real tags")? {
        scanner.float("a real tag")?;
    }
    let integers = scanner.unsigned("the number of integer tags")?;
    let mut tags = [0, 1, 0];
    for index in 0..scanner.claim(integers, 2, "integer tags")? {
        let tag = scanner.unsigned("an integer tag")?;
        tags.get_mut(index).into_iter().for_each(|slot| *slot = tag);
    }
    if !(1..=9).contains(&tags[1]) {
        let message = format!("data \"{}\" has {} components; expected 1 to 9", show(name.as_bytes()), tags[1]);
        return Err(scanner.fault("bad-syntax", message));
    }
    numbers.next_line();
    Ok((name, tags[1] as usize, tags[2]))
}
