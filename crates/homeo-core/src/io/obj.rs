//! Wavefront OBJ, reading.
//!
//! Read: `v` (two or three coordinates, colours behind them), `vt`, `vn`, `f` with any number of
//! corners and negative indices, `o`, `g`, `s`, `usemtl`, `mtllib`, comments, lines continued by a
//! backslash. Texture coordinates and normals are kept for each corner, so that seams survive:
//! the attributes `texture` and `normal` on corners. `color` sits on vertices; `object`, `group`,
//! `smoothing` and `material` are texts on polygons. Points, lines and free-form geometry are
//! counted in the losses.

use std::borrow::Cow;

use super::build::{PartialRows, TextColumn, close_polygon, left_out, too_few_corners};
use super::error::{Fault, Outcome};
use super::mesh_file::{Attribute, Element, MeshFile, Values};
use super::scan::{Scanner, out_of_range, parse_f64, parse_i64, show};

pub(super) fn read(bytes: &[u8]) -> Outcome<MeshFile> {
    let mut reader = Reader { bytes, announced: count_statements(bytes), ..Reader::default() };
    let mut lines = Lines::new(bytes);
    while let Some((at, line)) = lines.next_line() {
        reader.at = at;
        reader.read_statement(&line)?;
    }
    Ok(reader.finish())
}

/// The lines of the file, comments removed and continued lines joined.
struct Lines<'a> {
    scanner: Scanner<'a>,
}

impl<'a> Lines<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { scanner: Scanner::new(bytes) }
    }

    /// The byte where the next line begins, and the line.
    fn next_line(&mut self) -> Option<(usize, Cow<'a, [u8]>)> {
        let at = self.scanner.position();
        let line = self.scanner.line()?;
        if line.last() != Some(&b'\\') || line.contains(&b'#') {
            return Some((at, Cow::Borrowed(without_comment(line))));
        }
        let mut joined = line[..line.len() - 1].to_vec();
        while let Some(next) = self.scanner.line() {
            joined.push(b' ');
            joined.extend_from_slice(next);
            if joined.last() != Some(&b'\\') {
                break;
            }
            joined.pop();
        }
        Some((at, Cow::Owned(without_comment(&joined).to_vec())))
    }
}

fn without_comment(line: &[u8]) -> &[u8] {
    match line.iter().position(|&byte| byte == b'#') {
        Some(at) => &line[..at],
        None => line,
    }
}

/// How many `v`, `vt`, `vn` and `f` statements there are: faces may name vertices that come later.
fn count_statements(bytes: &[u8]) -> [usize; 4] {
    let mut counts = [0; 4];
    let mut lines = Lines::new(bytes);
    while let Some((_, line)) = lines.next_line() {
        let kind = match Scanner::new(&line).token() {
            Some(b"v") => 0,
            Some(b"vt") => 1,
            Some(b"vn") => 2,
            Some(b"f") => 3,
            _ => continue,
        };
        counts[kind] += 1;
    }
    counts
}

#[derive(Default)]
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Vertices, texture coordinates, normals and faces in the whole file.
    announced: [usize; 4],
    mesh: MeshFile,
    colors: PartialRows,
    textures: Vec<[f64; 3]>,
    has_third_texture: bool,
    normals: Vec<[f64; 3]>,
    /// For each corner the texture coordinates and the normal, 0 where there is none.
    corner_texture: Vec<u32>,
    corner_normal: Vec<u32>,
    object: TextColumn,
    group: TextColumn,
    smoothing: TextColumn,
    material: TextColumn,
    weights: usize,
    points_and_lines: usize,
    unknown: usize,
}

impl Reader<'_> {
    #[cold]
    fn fault(&self, code: &'static str, message: impl Into<String>) -> Fault {
        Fault::at_line_of(self.bytes, self.at, code, message)
    }

    fn read_statement(&mut self, line: &[u8]) -> Outcome<()> {
        let mut words = Scanner::new(line);
        let Some(keyword) = words.token() else { return Ok(()) };
        let polygons = self.mesh.polygons.len();
        match keyword {
            b"v" => self.read_vertex(&mut words)?,
            b"vt" => self.read_texture(&mut words)?,
            b"vn" => {
                let (row, count) = self.numbers::<3>(&mut words)?;
                if count != 3 {
                    return Err(self.fault("bad-syntax", "a normal needs three numbers"));
                }
                self.normals.push(row);
            }
            b"f" | b"fo" => self.read_face(&mut words)?,
            b"o" => self.object.set(name_of(&words), polygons),
            b"g" => self.group.set(name_of(&words), polygons),
            b"s" => self.smoothing.set(name_of(&words), polygons),
            b"usemtl" => self.material.set(name_of(&words), polygons),
            b"mtllib" => self.mesh.material_libraries.push(String::from_utf8_lossy(name_of(&words)).into_owned()),
            b"p" | b"l" => self.points_and_lines += 1,
            _ => self.unknown += 1,
        }
        Ok(())
    }

    /// Up to `N` numbers; more is an error.
    fn numbers<const N: usize>(&self, words: &mut Scanner<'_>) -> Outcome<([f64; N], usize)> {
        let mut row = [0.0; N];
        let mut count = 0;
        while let Some(token) = words.token() {
            let Some(value) = parse_f64(token) else {
                return Err(self.fault("bad-number", format!("expected a number, found \"{}\"", show(token))));
            };
            let Some(slot) = row.get_mut(count) else {
                return Err(self.fault("bad-syntax", format!("there are more than {N} numbers on this line")));
            };
            *slot = value;
            count += 1;
        }
        Ok((row, count))
    }

    fn read_vertex(&mut self, words: &mut Scanner<'_>) -> Outcome<()> {
        let (row, count) = self.numbers::<8>(words)?;
        if count < 2 || count == 5 || count == 8 {
            let message = format!("a vertex has {count} numbers; expected 2, 3 or 4, or 6 or 7 with a colour");
            return Err(self.fault("bad-syntax", message));
        }
        let dimension = count.min(3);
        if row[..dimension].iter().any(|value| !value.is_finite()) {
            let message = "a coordinate is not a finite number in double precision";
            return Err(self.fault("non-finite-coordinate", message));
        }
        if self.mesh.positions.len() >= u32::MAX as usize - 1 {
            return Err(self.fault("too-large", "there are more vertices than 32 bits can number"));
        }
        self.weights += usize::from(count == 4 && row[3] != 1.0);
        self.mesh.space = self.mesh.space.max(dimension);
        self.mesh.positions.push([row[0], row[1], row[2]]);
        self.colors.push(if count >= 6 { &row[3..count] } else { &[] });
        Ok(())
    }

    fn read_texture(&mut self, words: &mut Scanner<'_>) -> Outcome<()> {
        let (row, count) = self.numbers::<3>(words)?;
        if count == 0 {
            return Err(self.fault("bad-syntax", "texture coordinates need one to three numbers"));
        }
        // Many programs write a third coordinate that is always 0.
        self.has_third_texture |= row[2] != 0.0;
        self.textures.push(row);
        Ok(())
    }

    fn read_face(&mut self, words: &mut Scanner<'_>) -> Outcome<()> {
        let number = self.mesh.polygons.len();
        let first = self.mesh.polygons.corners.len();
        while let Some(token) = words.token() {
            self.read_corner(token, number)?;
        }
        let count = self.mesh.polygons.corners.len() - first;
        if count < 3 {
            return Err(self.fault("too-few-corners", too_few_corners(number, count)));
        }
        if self.mesh.polygons.corners.len() >= u32::MAX as usize {
            return Err(self.fault("too-large", "the polygons have more corners than 32 bits can number"));
        }
        close_polygon(&mut self.mesh.polygons);
        Ok(())
    }

    /// A corner `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn read_corner(&mut self, token: &[u8], polygon: usize) -> Outcome<()> {
        let mut parts = token.split(|&byte| byte == b'/');
        let vertex = parts.next().unwrap_or_default();
        let vertex = self.resolve(vertex, 0, self.mesh.positions.len(), polygon)?;
        let texture = match parts.next() {
            None | Some(b"") => 0,
            Some(part) => self.resolve(part, 1, self.textures.len(), polygon)? + 1,
        };
        let normal = match parts.next() {
            None | Some(b"") => 0,
            Some(part) => self.resolve(part, 2, self.normals.len(), polygon)? + 1,
        };
        if parts.next().is_some() {
            return Err(self.fault("bad-syntax", format!("the corner \"{}\" has too many parts", show(token))));
        }
        let corner = self.mesh.polygons.corners.len();
        self.mesh.polygons.corners.push(vertex);
        push_late(&mut self.corner_texture, texture, corner);
        push_late(&mut self.corner_normal, normal, corner);
        Ok(())
    }

    /// The index counted from 0: positive ones count from the first of the file, negative ones back
    /// from the last of the `current` that came before.
    fn resolve(&self, token: &[u8], kind: usize, current: usize, polygon: usize) -> Outcome<u32> {
        let thing = ["a vertex", "texture coordinates", "a normal"][kind];
        let Some(index) = parse_i64(token) else {
            let message = format!("expected the index of {thing}, found \"{}\"", show(token));
            return Err(self.fault("bad-number", message));
        };
        if index == 0 {
            let message = format!("polygon {} names {thing} by index 0, but OBJ counts from 1", polygon + 1);
            return Err(self.fault("index-zero", message));
        }
        let count = self.announced[kind] as i64;
        let resolved = if index > 0 { index - 1 } else { (current as i64).saturating_add(index) };
        if resolved < 0 || resolved >= count {
            let message = match kind {
                0 => out_of_range("polygon", polygon, &show(token), self.announced[0], 1),
                _ => format!("polygon {} names {thing} {}, but there are {count}", polygon + 1, show(token)),
            };
            return Err(self.fault("index-out-of-range", message));
        }
        u32::try_from(resolved).map_err(|_| self.fault("too-large", "an index does not fit 32 bits"))
    }

    fn finish(mut self) -> MeshFile {
        let mut mesh = self.mesh;
        let polygons = mesh.polygons.len();
        mesh.attributes.extend({
            self.colors.mark_fraction();
            self.colors.finish("color", Element::Vertex)
        });
        let width = if self.has_third_texture { 3 } else { 2 };
        mesh.attributes.extend(corner_attribute("texture", &self.corner_texture, &self.textures, width, &mesh));
        mesh.attributes.extend(corner_attribute("normal", &self.corner_normal, &self.normals, 3, &mesh));
        mesh.attributes.extend(self.object.finish("object", Element::Polygon, polygons));
        mesh.attributes.extend(self.group.finish("group", Element::Polygon, polygons));
        mesh.attributes.extend(self.smoothing.finish("smoothing", Element::Polygon, polygons));
        mesh.attributes.extend(self.material.finish("material", Element::Polygon, polygons));
        let texture_is_unused = self.corner_texture.is_empty() && !self.textures.is_empty();
        let normal_is_unused = self.corner_normal.is_empty() && !self.normals.is_empty();
        for (count, singular, plural) in [
            (self.weights, "weight of a vertex", "weights of vertices"),
            (self.points_and_lines, "statement with points or lines", "statements with points or lines"),
            (self.unknown, "statement other than polygons", "statements other than polygons"),
            (if texture_is_unused { self.textures.len() } else { 0 }, "unused texture point", "unused texture points"),
            (if normal_is_unused { self.normals.len() } else { 0 }, "unused normal", "unused normals"),
        ] {
            mesh.losses.extend((count > 0).then(|| left_out(count, singular, plural)));
        }
        mesh
    }
}

/// Adds `value` for a corner, beginning with the first that is not 0.
fn push_late(column: &mut Vec<u32>, value: u32, corner: usize) {
    if column.is_empty() && value == 0 {
        return;
    }
    column.resize(corner, 0);
    column.push(value);
}

fn corner_attribute(
    name: &str,
    indices: &[u32],
    table: &[[f64; 3]],
    components: usize,
    mesh: &MeshFile,
) -> Option<Attribute> {
    if indices.is_empty() {
        return None;
    }
    let mut values = Vec::with_capacity(mesh.polygons.corners.len() * components);
    for &index in indices {
        let row = if index == 0 { [f64::NAN; 3] } else { table[index as usize - 1] };
        values.extend_from_slice(&row[..components]);
    }
    values.resize(mesh.polygons.corners.len() * components, f64::NAN);
    Some(Attribute { name: name.to_string(), element: Element::Corner, components, values: Values::F64(values) })
}

/// The rest of the line without blanks around it.
fn name_of<'a>(words: &Scanner<'a>) -> &'a [u8] {
    words.rest().trim_ascii()
}
