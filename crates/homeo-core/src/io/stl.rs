//! STL, the format of stereolithography.
//!
//! Read: binary and text. STL holds no connectivity: corners at equal coordinates become one vertex
//! (exactly equal; 0 and -0 are equal), numbered by first appearance. This is recorded in the losses.
//! Kept: the names of solids as the polygon attribute `group`, the two bytes behind each binary
//! triangle as `attribute` unless all are 0. Normals are not kept: they follow from the triangles.
//!
//! Written: binary (single precision) or text (double precision); polygons are cut into triangles.

use std::collections::HashMap;
use std::io::Write;

use super::binary::{Cursor, Order};
use super::build::{TextColumn, tags};
use super::error::{Fault, Outcome, WriteError};
use super::mesh_file::{Element, MeshFile, Values};
use super::scan::Scanner;
use super::text::write_point;
use super::write::{Encoding, Parcel, WriteOptions};

const HEADER: usize = 84;
const TRIANGLE: usize = 50;

pub(super) fn read(bytes: &[u8]) -> Outcome<MeshFile> {
    let mut mesh = if is_binary(bytes) { read_binary(bytes)? } else { read_text(bytes)? };
    mesh.losses.push(format!(
        "STL holds no connectivity: the {} corners were joined into {} vertices where coordinates are equal",
        mesh.polygons.corners.len(),
        mesh.positions.len()
    ));
    Ok(mesh)
}

/// Text files begin with `solid`, but so do the headers of many binary files.
fn is_binary(bytes: &[u8]) -> bool {
    let announced = Cursor::new(bytes, HEADER - 4, Order::Little).u32("").map_or(0, u64::from);
    if bytes.len() as u64 == HEADER as u64 + announced * TRIANGLE as u64 {
        return true;
    }
    let start = bytes.trim_ascii_start();
    let is_solid = start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    !is_solid || start[..start.len().min(512)].contains(&0)
}

/// Joins corners at equal coordinates.
#[derive(Default)]
struct Welder {
    known: HashMap<[u64; 3], u32>,
    mesh: MeshFile,
}

impl Welder {
    fn push(&mut self, position: [f64; 3]) -> Result<(), &'static str> {
        if self.mesh.polygons.corners.len() >= u32::MAX as usize - 1 {
            return Err("there are more corners than 32 bits can number");
        }
        // Adding 0 turns -0 into 0 and changes nothing else.
        let key = position.map(|x| (x + 0.0).to_bits());
        let next = self.mesh.positions.len() as u32;
        let vertex = *self.known.entry(key).or_insert(next);
        if vertex == next {
            self.mesh.positions.push(position);
        }
        self.mesh.polygons.corners.push(vertex);
        Ok(())
    }

    fn finish(mut self) -> MeshFile {
        self.mesh.polygons.starts = (0..=self.mesh.polygons.corners.len() as u32).step_by(3).collect();
        self.mesh.space = 3;
        self.mesh
    }
}

fn read_binary(bytes: &[u8]) -> Outcome<MeshFile> {
    if bytes.len() < HEADER {
        let message = "the file is too short for the header of a binary STL file and does not begin with \"solid\"";
        return Err(Fault::at_byte(bytes.len(), "unexpected-end", message));
    }
    let mut cursor = Cursor::new(bytes, HEADER - 4, Order::Little);
    let count = u64::from(cursor.u32("the number of triangles")?);
    let triangles = cursor.take(count, TRIANGLE, "triangles")?;
    let mut welder = Welder::default();
    let mut attributes = Vec::new();
    for (index, record) in triangles.as_chunks::<TRIANGLE>().0.iter().enumerate() {
        let numbers = record[12..48].as_chunks::<4>().0;
        for (corner, chunk) in numbers.as_chunks::<3>().0.iter().enumerate() {
            let position = chunk.map(|number| f64::from(f32::from_le_bytes(number)));
            let byte = HEADER + index * TRIANGLE + 12 * (corner + 1);
            if position.iter().any(|x| !x.is_finite()) {
                let message = format!("triangle {index} has a coordinate that is not finite");
                return Err(Fault::at_byte(byte, "non-finite-coordinate", message));
            }
            welder.push(position).map_err(|message| Fault::at_byte(byte, "too-large", message))?;
        }
        attributes.push(i64::from(u16::from_le_bytes([record[48], record[49]])));
    }
    let mut mesh = welder.finish();
    mesh.attributes.extend(tags("attribute", Element::Polygon, attributes));
    if cursor.remaining() > 0 {
        mesh.losses.push(format!("{} bytes behind the last triangle were left out", cursor.remaining()));
    }
    Ok(mesh)
}

fn read_text(bytes: &[u8]) -> Outcome<MeshFile> {
    let mut scanner = Scanner::new(bytes);
    let mut welder = Welder::default();
    let mut groups = TextColumn::default();
    let mut has_names = false;
    while let Some(word) = scanner.token() {
        if !word.eq_ignore_ascii_case(b"solid") {
            return Err(scanner.fault("bad-syntax", "expected \"solid\""));
        }
        let name = scanner.line().unwrap_or_default().trim_ascii();
        let triangles = welder.mesh.polygons.corners.len() / 3;
        has_names |= !name.is_empty() || triangles > 0;
        groups.set(name, triangles);
        read_solid(&mut scanner, &mut welder)?;
    }
    let mut mesh = welder.finish();
    if has_names {
        mesh.attributes.extend(groups.finish("group", Element::Polygon, mesh.polygons.len()));
    }
    Ok(mesh)
}

fn read_solid(scanner: &mut Scanner<'_>, welder: &mut Welder) -> Outcome<()> {
    loop {
        let word = scanner.expect("\"facet\" or \"endsolid\"")?;
        if word.eq_ignore_ascii_case(b"endsolid") {
            scanner.line();
            return Ok(());
        }
        if !word.eq_ignore_ascii_case(b"facet") {
            return Err(scanner.fault("bad-syntax", "expected \"facet\" or \"endsolid\""));
        }
        // The normal is not used: some programs write nan here.
        expect_word(scanner, "normal")?;
        for _ in 0..3 {
            scanner.float("a normal")?;
        }
        expect_word(scanner, "outer")?;
        expect_word(scanner, "loop")?;
        for _ in 0..3 {
            expect_word(scanner, "vertex")?;
            let position = [scanner.coordinate()?, scanner.coordinate()?, scanner.coordinate()?];
            welder.push(position).map_err(|message| scanner.fault("too-large", message))?;
        }
        expect_word(scanner, "endloop")?;
        expect_word(scanner, "endfacet")?;
    }
}

fn expect_word(scanner: &mut Scanner<'_>, word: &str) -> Outcome<()> {
    let token = scanner.expect(&format!("\"{word}\""))?;
    if token.eq_ignore_ascii_case(word.as_bytes()) {
        return Ok(());
    }
    Err(scanner.fault("bad-syntax", format!("expected \"{word}\"; STL facets are triangles with one loop")))
}

pub(super) fn write(out: &mut dyn Write, parcel: &mut Parcel<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    parcel.surface_only()?;
    parcel.three_coordinates();
    let is_single = |x: &f64| f64::from(*x as f32) == *x;
    let fits = parcel.mesh.positions.iter().flatten().all(is_single);
    let is_text = match options.encoding {
        Encoding::Auto => !fits,
        Encoding::Text => true,
        Encoding::Binary => false,
    };
    let mesh = parcel.mesh;
    let triangles = super::triangulate::fan_triangles(&mesh.polygons);
    if triangles.len() != mesh.polygons.len() {
        let count = mesh.polygons.len();
        parcel.lose(format!("STL holds triangles only: {count} polygons were cut into {} triangles", triangles.len()));
    }
    parcel.lose("STL holds no connectivity: vertices are numbered anew when it is read, by equal coordinates");
    if is_text {
        write_text(out, parcel, &triangles)
    } else {
        if !fits {
            parcel.lose("binary STL holds single precision: coordinates were rounded");
        }
        write_binary(out, parcel, &triangles)
    }
}

fn write_text(out: &mut dyn Write, parcel: &mut Parcel<'_>, triangles: &[([u32; 3], u32)]) -> Result<(), WriteError> {
    let is_name = |text: &str| text == text.trim() && !text.contains(char::is_control);
    let group = parcel.take("group", Element::Polygon, |attribute| match &attribute.values {
        Values::Text(texts) => attribute.components == 1 && texts.iter().all(|text| is_name(text)),
        _ => false,
    });
    let name_of = |polygon: u32| match group.map(|attribute| &attribute.values) {
        Some(Values::Text(texts)) => &*texts[polygon as usize],
        _ => "",
    };
    let mut current = triangles.first().map_or("", |&(_, polygon)| name_of(polygon));
    writeln!(out, "solid {current}")?;
    for &(triangle, polygon) in triangles {
        if name_of(polygon) != current {
            writeln!(out, "endsolid {current}\nsolid {}", name_of(polygon))?;
            current = name_of(polygon);
        }
        let points = triangle.map(|vertex| parcel.mesh.positions[vertex as usize]);
        out.write_all(b"facet normal ")?;
        write_point(out, &unit_normal(points))?;
        out.write_all(b"\nouter loop\n")?;
        for point in points {
            out.write_all(b"vertex ")?;
            write_point(out, &point)?;
            out.write_all(b"\n")?;
        }
        out.write_all(b"endloop\nendfacet\n")?;
    }
    writeln!(out, "endsolid {current}")?;
    Ok(())
}

fn write_binary(out: &mut dyn Write, parcel: &mut Parcel<'_>, triangles: &[([u32; 3], u32)]) -> Result<(), WriteError> {
    let attribute = parcel.take("attribute", Element::Polygon, |attribute| match &attribute.values {
        Values::I64(values) => attribute.components == 1 && values.iter().all(|&value| u16::try_from(value).is_ok()),
        _ => false,
    });
    let mut header = [b' '; HEADER - 4];
    header[..10].copy_from_slice(b"binary STL");
    out.write_all(&header)?;
    let count = u32::try_from(triangles.len()).map_err(|_| WriteError::of_mesh("STL counts triangles by 32 bits"))?;
    out.write_all(&count.to_le_bytes())?;
    for &(triangle, polygon) in triangles {
        let points = triangle.map(|vertex| parcel.mesh.positions[vertex as usize]);
        for x in unit_normal(points).into_iter().chain(points.into_iter().flatten()) {
            let single = x as f32;
            if !single.is_finite() {
                return Err(WriteError::of_mesh(format!(
                    "the coordinate {x:?} is too large for binary STL; write text"
                )));
            }
            out.write_all(&single.to_le_bytes())?;
        }
        let extra = match attribute.map(|attribute| &attribute.values) {
            Some(Values::I64(values)) => values[polygon as usize] as u16,
            _ => 0,
        };
        out.write_all(&extra.to_le_bytes())?;
    }
    Ok(())
}

/// The normal of a triangle, for programs that look at it; 0 where it is not defined.
fn unit_normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let u: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
    let v: [f64; 3] = std::array::from_fn(|i| c[i] - a[i]);
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    let is_usable = length.is_finite() && length > 0.0;
    if is_usable { normal.map(|x| x / length) } else { [0.0; 3] }
}
