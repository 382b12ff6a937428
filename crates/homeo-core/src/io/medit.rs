//! MEDIT `.mesh` (text), reading.
//!
//! Read: versions 1 to 4 in two or three dimensions; `Vertices`, `Triangles`, `Quadrilaterals` and
//! `Tetrahedra` in any order of sections, each with its reference as the attribute `tag` (left away
//! where all are 0). `Corners`, `Ridges`, `Edges`, `Required…`, normals, tangents and sections with
//! unknown names are skipped and listed in the losses. Hexahedra, prisms, pyramids and elements of
//! higher order are refused by name.

use super::build::{close_polygon, tags};
use super::error::{Fault, Outcome};
use super::mesh_file::{Element, MeshFile};
use super::scan::{Scanner, out_of_range, parse_i64, parse_u64, show};

pub(super) fn read(bytes: &[u8]) -> Outcome<MeshFile> {
    let mut reader = Reader::default();
    let mut scanner = Scanner::with_comments(bytes);
    read_version(&mut scanner)?;
    let mut has_end = false;
    while let Some(keyword) = scanner.token() {
        if keyword.eq_ignore_ascii_case(b"End") {
            has_end = true;
            break;
        }
        reader.read_section(&mut scanner, keyword)?;
    }
    reader.check_indices(bytes)?;
    if !has_end {
        reader.mesh.losses.push("the keyword End is missing; the file may be cut short".to_string());
    }
    Ok(reader.finish())
}

fn read_version(scanner: &mut Scanner<'_>) -> Outcome<()> {
    let word = scanner.expect("MeshVersionFormatted")?;
    if !word.eq_ignore_ascii_case(b"MeshVersionFormatted") {
        let message = format!("a MEDIT file begins with MeshVersionFormatted, not with \"{}\"", show(word));
        return Err(scanner.fault("bad-header", message));
    }
    let version = scanner.unsigned("the version")?;
    if (1..=4).contains(&version) {
        return Ok(());
    }
    Err(scanner.fault("unsupported-variant", format!("MEDIT version {version} is not read; known are 1 to 4")))
}

/// Where the elements of a section are, for naming the line of a bad index.
struct Section {
    at: usize,
    first: usize,
    count: usize,
    corners: usize,
    word: &'static str,
}

#[derive(Default)]
struct Reader {
    mesh: MeshFile,
    dimension: usize,
    polygon_sections: Vec<Section>,
    tetrahedron_sections: Vec<Section>,
    vertex_tags: Vec<i64>,
    polygon_tags: Vec<i64>,
    tetrahedron_tags: Vec<i64>,
}

impl Reader {
    fn read_section(&mut self, scanner: &mut Scanner<'_>, keyword: &[u8]) -> Outcome<()> {
        let lower = keyword.to_ascii_lowercase();
        match lower.as_slice() {
            b"dimension" => {
                let dimension = scanner.unsigned("the dimension")?;
                if !(2..=3).contains(&dimension) {
                    let message = format!("the dimension is {dimension}; it must be 2 or 3");
                    return Err(scanner.fault("unsupported-variant", message));
                }
                if self.dimension != 0 {
                    return Err(scanner.fault("bad-syntax", "the dimension is given twice"));
                }
                self.dimension = dimension as usize;
                self.mesh.space = self.dimension;
                Ok(())
            }
            b"vertices" => self.read_vertices(scanner),
            b"triangles" => self.read_polygons(scanner, 3, "triangle"),
            b"quadrilaterals" => self.read_polygons(scanner, 4, "quadrilateral"),
            b"tetrahedra" => self.read_tetrahedra(scanner),
            _ => match unsupported(&lower) {
                Some(name) => self.refuse(scanner, name),
                None => self.skip_section(scanner, keyword),
            },
        }
    }

    /// A section of elements that are not supported is fine as long as it is empty.
    fn refuse(&self, scanner: &mut Scanner<'_>, name: &str) -> Outcome<()> {
        if scanner.unsigned("the number of elements")? == 0 {
            return Ok(());
        }
        let message = format!("the file holds {name}; homeo reads triangles, quadrilaterals and 4-node tetrahedra");
        Err(scanner.fault("unsupported-element", message))
    }

    fn skip_section(&mut self, scanner: &mut Scanner<'_>, keyword: &[u8]) -> Outcome<()> {
        if !keyword.first().is_some_and(u8::is_ascii_alphabetic) {
            let message = format!("expected the name of a section, found \"{}\"", show(keyword));
            return Err(scanner.fault("bad-syntax", message));
        }
        let is_empty = scanner.peek() == Some(b"0");
        while let Some(token) = scanner.peek() {
            if token.first().is_some_and(u8::is_ascii_alphabetic) {
                break;
            }
            scanner.token();
        }
        let sentence = format!("the section {} was left out", show(keyword));
        // Hostile files may repeat a section a million times.
        if !is_empty && self.mesh.losses.len() < 100 && !self.mesh.losses.contains(&sentence) {
            self.mesh.losses.push(sentence);
        }
        Ok(())
    }

    fn read_vertices(&mut self, scanner: &mut Scanner<'_>) -> Outcome<()> {
        if self.dimension == 0 {
            return Err(scanner.fault("bad-header", "the section Vertices comes before Dimension"));
        }
        let count = scanner.unsigned("the number of vertices")?;
        let count = scanner.claim(count, 2 * (self.dimension + 1), "vertices")?;
        if self.mesh.positions.len() + count >= u32::MAX as usize {
            return Err(scanner.fault("too-large", "there are more vertices than 32 bits can number"));
        }
        self.mesh.positions.reserve(count);
        self.vertex_tags.reserve(count);
        for _ in 0..count {
            let (x, y) = (scanner.coordinate()?, scanner.coordinate()?);
            let z = if self.dimension == 3 { scanner.coordinate()? } else { 0.0 };
            self.mesh.positions.push([x, y, z]);
            self.vertex_tags.push(scanner.integer("the reference of a vertex")?);
        }
        Ok(())
    }

    /// The count of a section, and where its elements are.
    fn begin(scanner: &mut Scanner<'_>, corners: usize, word: &'static str, first: usize) -> Outcome<Section> {
        let count = scanner.unsigned("the number of elements")?;
        let count = scanner.claim(count, 2 * (corners + 1), "elements")?;
        if (first + count).saturating_mul(corners) >= u32::MAX as usize {
            return Err(scanner.fault("too-large", "the elements have more corners than 32 bits can number"));
        }
        Ok(Section { at: scanner.position(), first, count, corners, word })
    }

    fn read_polygons(&mut self, scanner: &mut Scanner<'_>, corners: usize, word: &'static str) -> Outcome<()> {
        let section = Self::begin(scanner, corners, word, self.mesh.polygons.len())?;
        self.mesh.polygons.corners.reserve(corners * section.count);
        self.mesh.polygons.starts.reserve(section.count + 1);
        for _ in 0..section.count {
            for _ in 0..corners {
                self.mesh.polygons.corners.push(read_index(scanner)?);
            }
            close_polygon(&mut self.mesh.polygons);
            self.polygon_tags.push(scanner.integer("the reference of an element")?);
        }
        if section.count > 0 {
            self.polygon_sections.push(section);
        }
        Ok(())
    }

    fn read_tetrahedra(&mut self, scanner: &mut Scanner<'_>) -> Outcome<()> {
        let section = Self::begin(scanner, 4, "tetrahedron", self.mesh.tetrahedra.len())?;
        self.mesh.tetrahedra.reserve(section.count);
        for _ in 0..section.count {
            let mut corners = [0; 4];
            for corner in &mut corners {
                *corner = read_index(scanner)?;
            }
            self.mesh.tetrahedra.push(corners);
            self.tetrahedron_tags.push(scanner.integer("the reference of an element")?);
        }
        self.tetrahedron_sections.push(section);
        Ok(())
    }

    fn check_indices(&mut self, bytes: &[u8]) -> Outcome<()> {
        let limit = self.mesh.positions.len();
        let is_bad = |index: &u32| *index == 0 || *index as usize > limit;
        let MeshFile { polygons, tetrahedra, .. } = &mut self.mesh;
        for section in &self.polygon_sections {
            let start = polygons.starts[section.first] as usize;
            let corners = &polygons.corners[start..start + section.count * section.corners];
            if let Some(bad) = corners.iter().position(is_bad) {
                return Err(bad_index(bytes, section, bad, limit));
            }
        }
        for section in &self.tetrahedron_sections {
            let corners = tetrahedra[section.first..section.first + section.count].as_flattened();
            if let Some(bad) = corners.iter().position(is_bad) {
                return Err(bad_index(bytes, section, bad, limit));
            }
        }
        polygons.corners.iter_mut().for_each(|corner| *corner -= 1);
        tetrahedra.as_flattened_mut().iter_mut().for_each(|corner| *corner -= 1);
        Ok(())
    }

    fn finish(mut self) -> MeshFile {
        let attributes = &mut self.mesh.attributes;
        attributes.extend(tags("tag", Element::Vertex, self.vertex_tags));
        attributes.extend(tags("tag", Element::Polygon, self.polygon_tags));
        attributes.extend(tags("tag", Element::Tetrahedron, self.tetrahedron_tags));
        self.mesh
    }
}

/// An index counted from 1, not yet held against the number of vertices; too large ones are `u32::MAX`.
fn read_index(scanner: &mut Scanner<'_>) -> Outcome<u32> {
    let token = scanner.expect("a vertex index")?;
    match parse_u64(token) {
        Some(index) => Ok(u32::try_from(index).unwrap_or(u32::MAX)),
        None if parse_i64(token).is_some() => Ok(u32::MAX),
        None => Err(scanner.fault("bad-number", format!("expected a vertex index, found \"{}\"", show(token)))),
    }
}

/// The fault of the index at flat position `bad` of a section: finds its line.
#[cold]
fn bad_index(bytes: &[u8], section: &Section, bad: usize, vertices: usize) -> Fault {
    let mut scanner = Scanner::with_comments(bytes);
    scanner.seek(section.at);
    let (element, corner) = (bad / section.corners, bad % section.corners);
    for _ in 0..element * (section.corners + 1) + corner {
        scanner.token();
    }
    let token = scanner.token().unwrap_or_default();
    if parse_u64(token) == Some(0) {
        let message = format!("{} {} names vertex 0, but MEDIT counts from 1", section.word, element + 1);
        return scanner.fault("index-zero", message);
    }
    scanner.fault("index-out-of-range", out_of_range(section.word, element, &show(token), vertices, 1))
}

/// The elements of sections that are refused.
fn unsupported(lower: &[u8]) -> Option<&'static str> {
    match lower {
        b"hexahedra" => Some("hexahedra"),
        b"prisms" | b"pentahedra" => Some("prisms"),
        b"pyramids" => Some("pyramids"),
        b"trianglesp2" => Some("6-node triangles"),
        b"trianglesp3" => Some("10-node triangles"),
        b"quadrilateralsq2" => Some("9-node quadrilaterals"),
        b"tetrahedrap2" => Some("10-node tetrahedra"),
        b"tetrahedrap3" => Some("20-node tetrahedra"),
        b"hexahedraq2" => Some("27-node hexahedra"),
        _ => None,
    }
}
