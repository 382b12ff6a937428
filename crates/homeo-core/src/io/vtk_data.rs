//! The attributes of VTK legacy files.

use super::binary::Scalar;
use super::error::Outcome;
use super::mesh_file::{Attribute, Element, Values};
use super::scan::show;
use super::vtk::{Reader, Target};

/// Reads the attribute that `keyword` begins.
pub(super) fn read_attribute(reader: &mut Reader<'_>, keyword: &[u8]) -> Outcome<()> {
    let components = match keyword {
        b"SCALARS" => return read_scalars(reader),
        b"FIELD" => return read_field(reader),
        b"LOOKUP_TABLE" => return read_lookup_table(reader),
        b"COLOR_SCALARS" => return read_colors(reader),
        b"TEXTURE_COORDINATES" => 0,
        b"VECTORS" | b"NORMALS" => 3,
        b"TENSORS" => 9,
        b"TENSORS6" => 6,
        b"GLOBAL_IDS" | b"PEDIGREE_IDS" => 1,
        _ => {
            let message = format!("the section \"{}\" is not known", show(keyword));
            return Err(reader.scanner.fault("bad-syntax", message));
        }
    };
    let name = read_name(reader)?;
    let components = if components == 0 { read_components(reader)? } else { components };
    let scalar = reader.read_scalar()?;
    read_rows(reader, name, components, scalar)
}

/// Names hold blanks and the like as `%20`.
fn read_name(reader: &mut Reader<'_>) -> Outcome<String> {
    let token = reader.scanner.expect("the name of an attribute")?;
    let mut name = Vec::with_capacity(token.len());
    let mut rest = token;
    while let Some((&byte, behind)) = rest.split_first() {
        let code = behind.get(..2).and_then(|digits| u8::from_str_radix(str::from_utf8(digits).ok()?, 16).ok());
        match (byte, code) {
            (b'%', Some(code)) => {
                name.push(code);
                rest = &behind[2..];
            }
            _ => {
                name.push(byte);
                rest = behind;
            }
        }
    }
    Ok(String::from_utf8_lossy(&name).into_owned())
}

fn read_components(reader: &mut Reader<'_>) -> Outcome<usize> {
    let components = reader.scanner.unsigned("the number of components")?;
    if (1..=1 << 16).contains(&components) {
        return Ok(components as usize);
    }
    Err(reader.scanner.fault("bad-syntax", format!("an attribute of {components} components is not read")))
}

fn read_scalars(reader: &mut Reader<'_>) -> Outcome<()> {
    let name = read_name(reader)?;
    let scalar = read_scalar_or_bit(reader)?;
    let components = match reader.scanner.clone().token_in_line() {
        Some(_) => read_components(reader)?,
        None => 1,
    };
    if reader.scanner.peek().is_some_and(|token| token.eq_ignore_ascii_case(b"LOOKUP_TABLE")) {
        reader.scanner.token();
        reader.scanner.expect("the name of a lookup table")?;
    }
    read_rows(reader, name, components, scalar)
}

fn read_scalar_or_bit(reader: &mut Reader<'_>) -> Outcome<Scalar> {
    let is_bit = reader.scanner.peek().is_some_and(|token| token.eq_ignore_ascii_case(b"bit"));
    if is_bit && !reader.is_binary() {
        reader.scanner.token();
        return Ok(Scalar::U8);
    }
    reader.read_scalar()
}

fn read_rows(reader: &mut Reader<'_>, name: String, components: usize, scalar: Scalar) -> Outcome<()> {
    let count = reader.target_count as u64 * components as u64;
    let values = reader.read_values(scalar, count, "values of an attribute")?;
    add(reader, name, components, values);
    Ok(())
}

fn add(reader: &mut Reader<'_>, name: String, components: usize, values: Values) {
    match reader.target {
        Target::Nothing => reader.mesh.losses.push(format!("the data \"{name}\" of the file as a whole was left out")),
        Target::Points => {
            reader.mesh.attributes.push(Attribute { name, element: Element::Vertex, components, values });
        }
        Target::Cells => {
            let parts = reader.cells.split(&name, components, values);
            reader.mesh.attributes.extend(parts);
        }
    }
}

/// Colours are bytes in binary files and numbers from 0 to 1 in text.
fn read_colors(reader: &mut Reader<'_>) -> Outcome<()> {
    let name = read_name(reader)?;
    let components = read_components(reader)?;
    read_rows(reader, name, components, if reader.is_binary() { Scalar::U8 } else { Scalar::F32 })
}

fn read_lookup_table(reader: &mut Reader<'_>) -> Outcome<()> {
    let name = read_name(reader)?;
    let size = reader.scanner.unsigned("the size of a lookup table")?;
    let scalar = if reader.is_binary() { Scalar::U8 } else { Scalar::F32 };
    reader.read_values(scalar, size.saturating_mul(4), "entries of a lookup table")?;
    reader.mesh.losses.push(format!("the lookup table \"{name}\" was left out"));
    Ok(())
}

fn read_field(reader: &mut Reader<'_>) -> Outcome<()> {
    read_name(reader)?;
    let count = reader.scanner.unsigned("the number of arrays")?;
    for _ in 0..count {
        // Between arrays there may be METADATA, which ends with an empty line.
        if reader.scanner.peek() == Some(b"METADATA") {
            reader.scanner.token();
            reader.scanner.line();
            while reader.scanner.line().is_some_and(|line| !line.trim_ascii().is_empty()) {}
        }
        read_array(reader)?;
    }
    Ok(())
}

fn read_array(reader: &mut Reader<'_>) -> Outcome<()> {
    let name = read_name(reader)?;
    let components = reader.scanner.unsigned("the number of components")?;
    let rows = reader.scanner.unsigned("the number of rows")?;
    if reader.scanner.peek().is_some_and(|token| token.eq_ignore_ascii_case(b"string")) {
        return skip_strings(reader, name, components.saturating_mul(rows));
    }
    let scalar = read_scalar_or_bit(reader)?;
    let values = reader.read_values(scalar, components.saturating_mul(rows), "values of an array")?;
    if reader.target == Target::Nothing || (rows == reader.target_count as u64 && (1..=1 << 16).contains(&components)) {
        add(reader, name, components as usize, values);
    } else {
        reader.mesh.losses.push(format!("the array \"{name}\" was left out: it does not have a row for each element"));
    }
    Ok(())
}

/// Text arrays: a line for each text, or a length of one to eight bytes and the text.
fn skip_strings(reader: &mut Reader<'_>, name: String, count: u64) -> Outcome<()> {
    reader.scanner.line();
    for _ in 0..reader.scanner.claim(count, 1, "texts")? {
        if !reader.is_binary() {
            reader.scanner.line();
            continue;
        }
        // The two highest bits of the first byte say how many bytes the length has.
        let first = reader.take_bytes(1, 1, "a text")?[0];
        let more = [7, 3, 1, 0][usize::from(first >> 6)];
        let behind = reader.take_bytes(more, 1, "a text")?;
        let length = behind.iter().fold(u64::from(first & 63), |length, &byte| length << 8 | u64::from(byte));
        reader.take_bytes(length, 1, "a text")?;
    }
    reader.mesh.losses.push(format!("the texts \"{name}\" were left out"));
    Ok(())
}
