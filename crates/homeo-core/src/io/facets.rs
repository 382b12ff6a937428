//! Facet lists in JSON: connectivity without coordinates, or with.
//!
//! Read: an object with `"facets"`, `"triangles"`, `"tetrahedra"` or `"tets"`, each a list of lists
//! of three (triangles) or four (tetrahedra) vertices counted from 0, and `"vertices"`: their number, or
//! a list of points of two or three coordinates. Without it the highest index tells the number.
//! Other members are skipped.
//!
//! Written: `"vertices"` (the number, or the points) and `"facets"`.

use std::io::Write;

use super::build::close_polygon;
use super::error::{Fault, Outcome, WriteError};
use super::json::Json;
use super::mesh_file::MeshFile;
use super::text::write_point;
use super::write::{Parcel, WriteOptions};

pub(super) fn read(bytes: &[u8]) -> Outcome<MeshFile> {
    let mut json = Json::new(bytes);
    let mut reader = Reader::default();
    let mut members = json.begin_object()?;
    while let Some(name) = json.next_member(&mut members)? {
        match name {
            b"vertices" => reader.read_vertices(&mut json)?,
            b"facets" | b"triangles" | b"tetrahedra" | b"tets" => reader.read_facets(&mut json)?,
            _ => json.skip_value()?,
        }
    }
    json.end()?;
    reader.finish(bytes)
}

#[derive(Default)]
struct Reader {
    mesh: MeshFile,
    announced: Option<u64>,
    /// The highest index and the byte where it is.
    highest: Option<(u32, usize)>,
}

impl Reader {
    fn read_vertices(&mut self, json: &mut Json<'_>) -> Outcome<()> {
        if !json.is_list() {
            self.announced = Some(json.unsigned()?);
            return Ok(());
        }
        let mut points = json.begin_list()?;
        while json.next_item(&mut points)? {
            let mut position = [0.0; 3];
            let mut count = 0;
            let mut numbers = json.begin_list()?;
            while json.next_item(&mut numbers)? {
                let Some(x) = position.get_mut(count) else {
                    return Err(json.fault("bad-syntax", "a point has more than three coordinates"));
                };
                *x = json.coordinate()?;
                count += 1;
            }
            if count < 2 || (self.mesh.space != 0 && self.mesh.space != count) {
                return Err(json.fault("bad-syntax", "points must all have two coordinates, or all three"));
            }
            self.mesh.space = count;
            self.mesh.positions.push(position);
        }
        Ok(())
    }

    fn read_facets(&mut self, json: &mut Json<'_>) -> Outcome<()> {
        let mut facets = json.begin_list()?;
        while json.next_item(&mut facets)? {
            let mut corners = [0_u32; 4];
            let mut count = 0;
            let mut indices = json.begin_list()?;
            while json.next_item(&mut indices)? {
                let Some(corner) = corners.get_mut(count) else {
                    return Err(json.fault("unsupported-element", "a facet has more than four vertices"));
                };
                let index = json.unsigned()?;
                *corner = u32::try_from(index).ok().filter(|&index| index < u32::MAX - 1).ok_or_else(|| {
                    json.fault(
                        "index-out-of-range",
                        format!("a facet names vertex {index}, which does not fit 32 bits"),
                    )
                })?;
                if self.highest.is_none_or(|(highest, _)| *corner > highest) {
                    self.highest = Some((*corner, json.last()));
                }
                count += 1;
            }
            match count {
                4 => self.mesh.tetrahedra.push(corners),
                3 => {
                    self.mesh.polygons.corners.extend_from_slice(&corners[..3]);
                    close_polygon(&mut self.mesh.polygons);
                }
                _ => {
                    let message = format!("a facet has {count} vertices; triangles have three, tetrahedra four");
                    return Err(json.fault("unsupported-element", message));
                }
            }
        }
        Ok(())
    }

    fn finish(mut self, bytes: &[u8]) -> Outcome<MeshFile> {
        let needed = self.highest.map_or(0, |(highest, _)| u64::from(highest) + 1);
        let count = match (self.mesh.space, self.announced) {
            (0, None) => needed,
            (0, Some(announced)) => announced,
            _ => self.mesh.positions.len() as u64,
        };
        if let Some((highest, at)) = self.highest.filter(|_| needed > count) {
            let message = format!("a facet names vertex {highest}, but there are {count} vertices, numbered from 0");
            return Err(Fault::at_line_of(bytes, at, "index-out-of-range", message));
        }
        if count >= u64::from(u32::MAX) {
            return Err(Fault::of_file("too-large", super::scan::too_large(count, "vertices")));
        }
        self.mesh.vertex_count = count as usize;
        Ok(self.mesh)
    }
}

pub(super) fn write(out: &mut dyn Write, parcel: &mut Parcel<'_>, options: &WriteOptions) -> Result<(), WriteError> {
    parcel.text_only(options)?;
    let mesh = parcel.mesh;
    if mesh.polygons.iter().any(|polygon| polygon.len() != 3) {
        return Err(WriteError::of_mesh("JSON facet lists hold triangles and tetrahedra only; triangulate first"));
    }
    if mesh.space == 0 {
        write!(out, "{{\"vertices\": {},\n\"facets\": [", mesh.vertex_count)?;
    } else {
        write!(out, "{{\"vertices\": [")?;
        for (index, position) in mesh.positions.iter().enumerate() {
            let numbers = &position[..mesh.space];
            write!(out, "{}[", if index > 0 { ",\n" } else { "" })?;
            for (axis, x) in numbers.iter().enumerate() {
                out.write_all(if axis > 0 { b", " } else { b"" })?;
                write_point(out, &[*x])?;
            }
            out.write_all(b"]")?;
        }
        write!(out, "],\n\"facets\": [")?;
    }
    let facets = mesh.polygons.iter().chain(mesh.tetrahedra.iter().map(|corners| &corners[..]));
    for (index, facet) in facets.enumerate() {
        let corners: Vec<String> = facet.iter().map(u32::to_string).collect();
        write!(out, "{}[{}]", if index > 0 { ",\n" } else { "" }, corners.join(", "))?;
    }
    writeln!(out, "]}}")?;
    Ok(())
}
