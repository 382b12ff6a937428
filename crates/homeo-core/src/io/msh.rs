//! Gmsh MSH, reading: version 2.2 and 4.1, text and binary.
//!
//! Kept: 3-node triangles and 4-node quadrangles as polygons, 4-node tetrahedra, in the file's order
//! within each kind; the physical tag as the attribute `tag` and the elementary tag as `entity` (left
//! away where all are 0); physical names; `$NodeData` and `$ElementData` of numbers.
//! Points and lines are counted in the losses. Elements of higher order, hexahedra, prisms and
//! pyramids are refused by name. Node numbers may have gaps; they are numbered anew in order.

use std::collections::HashMap;

use super::build::{close_polygon, left_out, tags};
use super::error::{Fault, Outcome};
use super::mesh_file::{Element, MeshFile, PhysicalName};
use super::msh_data::read_data;
use super::msh_numbers::{NodeNumbers, Numbers};
use super::scan::{Scanner, parse_f64, show};

pub(super) fn read(bytes: &[u8]) -> Outcome<MeshFile> {
    let mut numbers = Numbers::new(bytes);
    let version = read_header(&mut numbers)?;
    let mut reader = Reader { version, data_budget: bytes.len(), ..Reader::default() };
    while let Some(section) = numbers.scanner.token() {
        let Some(name) = section.strip_prefix(b"$") else {
            let message = format!("expected a section such as $Nodes, found \"{}\"", show(section));
            return Err(numbers.scanner.fault("bad-syntax", message));
        };
        reader.read_section(&mut numbers, name)?;
    }
    reader.finish()
}

/// The version of the format.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Version {
    #[default]
    Two,
    Four,
}

fn read_header(numbers: &mut Numbers<'_>) -> Outcome<Version> {
    let scanner = &mut numbers.scanner;
    if scanner.token() != Some(b"$MeshFormat") {
        return Err(scanner.fault("bad-header", "an MSH file begins with $MeshFormat (version 2.2 or 4.1)"));
    }
    let token = scanner.expect("the version")?;
    let version = match parse_f64(token) {
        Some(version) if (2.0..3.0).contains(&version) => Version::Two,
        Some(4.1) => Version::Four,
        _ => {
            let message = format!(
                "MSH version {} is not read; save the mesh as version 2.2 or 4.1 (gmsh -save -format msh41)",
                show(token)
            );
            return Err(scanner.fault("unsupported-variant", message));
        }
    };
    let is_binary = scanner.unsigned("the file type")? == 1;
    let size = scanner.unsigned("the size of numbers")?;
    if size != 8 {
        return Err(scanner.fault("unsupported-variant", format!("numbers of {size} bytes are not read; expected 8")));
    }
    if is_binary {
        scanner.line();
        numbers.begin_binary()?;
    }
    numbers.end_section("MeshFormat")?;
    Ok(version)
}

/// A map from what a file numbers to what is kept of it.
#[derive(Default)]
pub(super) struct Reader {
    version: Version,
    pub mesh: MeshFile,
    pub nodes: NodeNumbers,
    has_nodes: bool,
    has_elements: bool,
    /// Physical tags of entities, by dimension and tag (version 4.1).
    physical: HashMap<(i32, i32), i64>,
    polygon_tags: Vec<i64>,
    polygon_entities: Vec<i64>,
    tetrahedron_tags: Vec<i64>,
    tetrahedron_entities: Vec<i64>,
    /// Element numbers in the file, for `$ElementData`.
    pub polygon_numbers: Vec<u64>,
    pub tetrahedron_numbers: Vec<u64>,
    /// How many entries the attributes from data sections may still have.
    pub data_budget: usize,
    points: usize,
    lines: usize,
    several_physical: usize,
}

impl Reader {
    fn read_section(&mut self, numbers: &mut Numbers<'_>, name: &[u8]) -> Outcome<()> {
        match (name, self.version) {
            (b"PhysicalNames", _) => self.read_names(numbers)?,
            (b"Entities", Version::Four) => self.read_entities(numbers)?,
            (b"Nodes", version) => {
                if std::mem::replace(&mut self.has_nodes, true) {
                    return Err(numbers.scanner.fault("bad-syntax", "the section $Nodes comes twice"));
                }
                numbers.next_line();
                match version {
                    Version::Two => self.read_nodes_2(numbers)?,
                    Version::Four => self.read_nodes_4(numbers)?,
                }
                self.nodes.close(&numbers.scanner)?;
            }
            (b"Elements", version) => {
                if !self.has_nodes || std::mem::replace(&mut self.has_elements, true) {
                    let message = "the section $Elements comes twice or before $Nodes";
                    return Err(numbers.scanner.fault("bad-syntax", message));
                }
                numbers.next_line();
                match version {
                    Version::Two => self.read_elements_2(numbers)?,
                    Version::Four => self.read_elements_4(numbers)?,
                }
            }
            (b"NodeData", _) => read_data(self, numbers, Element::Vertex)?,
            (b"ElementData", _) => read_data(self, numbers, Element::Tetrahedron)?,
            _ => {
                let sentence = format!("the section ${} was left out", show(name));
                if self.mesh.losses.len() < 100 {
                    self.mesh.losses.push(sentence);
                }
                return numbers.skip_section(name);
            }
        }
        numbers.end_section(&show(name))
    }

    fn read_names(&mut self, numbers: &mut Numbers<'_>) -> Outcome<()> {
        let scanner = &mut numbers.scanner;
        let count = scanner.unsigned("the number of physical names")?;
        for _ in 0..scanner.claim(count, 6, "physical names")? {
            let dimension = scanner.unsigned("a dimension")?;
            let tag = scanner.integer("a physical tag")?;
            let text = scanner.line().unwrap_or_default().trim_ascii();
            let text = text.strip_prefix(b"\"").and_then(|text| text.strip_suffix(b"\"")).unwrap_or(text);
            let Some(dimension) = u8::try_from(dimension).ok().filter(|&dimension| dimension <= 3) else {
                return Err(scanner.fault("bad-syntax", "the dimension of a physical name must be 0 to 3"));
            };
            let name = String::from_utf8_lossy(text).into_owned();
            self.mesh.names.push(PhysicalName { dimension, tag, name });
        }
        Ok(())
    }

    /// Entities say which physical group the elements on them belong to.
    fn read_entities(&mut self, numbers: &mut Numbers<'_>) -> Outcome<()> {
        numbers.next_line();
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = numbers.size("the number of entities")?;
        }
        for (dimension, count) in counts.into_iter().enumerate() {
            let least = if dimension == 0 { 4 } else { 8 };
            for _ in 0..numbers.claim(count, 2 * least, 4 * least, "entities")? {
                let tag = numbers.int("the tag of an entity")?;
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    numbers.float("the bounding box of an entity")?;
                }
                let physical = self.read_int_list(numbers)?;
                self.several_physical += usize::from(physical.1 > 1);
                if let Some(first) = physical.0 {
                    self.physical.insert((dimension as i32, tag), i64::from(first));
                }
                if dimension > 0 {
                    self.read_int_list(numbers)?;
                }
            }
        }
        Ok(())
    }

    /// The first of a list of integers, and how many there are.
    fn read_int_list(&mut self, numbers: &mut Numbers<'_>) -> Outcome<(Option<i32>, usize)> {
        let count = numbers.size("the length of a list")?;
        let count = numbers.claim(count, 2, 4, "tags")?;
        let mut first = None;
        for _ in 0..count {
            let tag = numbers.int("a tag")?;
            first = first.or(Some(tag));
        }
        Ok((first, count))
    }

    fn read_position(&mut self, numbers: &mut Numbers<'_>) -> Outcome<()> {
        let mut position = [0.0; 3];
        for x in &mut position {
            *x = numbers.coordinate()?;
        }
        self.mesh.positions.push(position);
        Ok(())
    }

    fn read_nodes_2(&mut self, numbers: &mut Numbers<'_>) -> Outcome<()> {
        let count = numbers.scanner.unsigned("the number of nodes")?;
        numbers.next_line();
        let count = numbers.claim(count, 8, 28, "nodes")?;
        self.mesh.positions.reserve_exact(count);
        self.nodes.reserve(count);
        for _ in 0..count {
            let number = numbers.int_as_size("the number of a node")?;
            self.nodes.push(number);
            self.read_position(numbers)?;
        }
        Ok(())
    }

    fn read_nodes_4(&mut self, numbers: &mut Numbers<'_>) -> Outcome<()> {
        let blocks = numbers.size("the number of blocks")?;
        let count = numbers.size("the number of nodes")?;
        numbers.size("the lowest node number")?;
        numbers.size("the highest node number")?;
        let blocks = numbers.claim(blocks, 8, 20, "blocks of nodes")?;
        let count = numbers.claim(count, 8, 32, "nodes")?;
        self.mesh.positions.reserve_exact(count);
        self.nodes.reserve(count);
        for _ in 0..blocks {
            let dimension = numbers.int("a dimension")?;
            numbers.int("the tag of an entity")?;
            let is_parametric = numbers.int("whether nodes are parametric")? != 0;
            let in_block = numbers.size("the number of nodes")?;
            let in_block = numbers.claim(in_block, 8, 32, "nodes of a block")?;
            if self.mesh.positions.len() + in_block > count {
                return Err(numbers.scanner.fault("bad-syntax", "the blocks hold more nodes than announced"));
            }
            for _ in 0..in_block {
                let number = numbers.size("the number of a node")?;
                self.nodes.push(number);
            }
            for _ in 0..in_block {
                self.read_position(numbers)?;
                for _ in 0..if is_parametric { dimension.clamp(0, 3) } else { 0 } {
                    numbers.float("a parameter")?;
                }
            }
        }
        Ok(())
    }

    fn read_elements_2(&mut self, numbers: &mut Numbers<'_>) -> Outcome<()> {
        let count = numbers.scanner.unsigned("the number of elements")?;
        numbers.next_line();
        let count = numbers.claim(count, 6, 8, "elements")?;
        let mut done = 0;
        while done < count {
            // Text: number, type, tags for each element. Binary: type, count, tags once for a block.
            let (mut number, kind, in_block) = if numbers.is_binary() {
                let kind = numbers.int("an element type")?;
                let in_block = numbers.int_as_size("the number of elements")?;
                (0, kind, numbers.claim(in_block, 4, 4, "elements of a block")?)
            } else {
                (numbers.size("the number of an element")?, numbers.int("an element type")?, 1)
            };
            let tag_count = numbers.int_as_size("the number of tags")?;
            let tag_count = numbers.claim(tag_count, 2, 4, "tags")?;
            if in_block == 0 || in_block > count - done {
                return Err(numbers.scanner.fault("bad-syntax", "the blocks do not hold the announced elements"));
            }
            for _ in 0..in_block {
                if numbers.is_binary() {
                    number = numbers.int_as_size("the number of an element")?;
                }
                let mut tags = [0; 2];
                for index in 0..tag_count {
                    let tag = numbers.int("a tag")?;
                    tags.get_mut(index).into_iter().for_each(|slot| *slot = i64::from(tag));
                }
                self.read_element(numbers, kind, number, tags)?;
            }
            done += in_block;
        }
        Ok(())
    }

    fn read_elements_4(&mut self, numbers: &mut Numbers<'_>) -> Outcome<()> {
        let blocks = numbers.size("the number of blocks")?;
        let count = numbers.size("the number of elements")?;
        numbers.size("the lowest element number")?;
        numbers.size("the highest element number")?;
        let blocks = numbers.claim(blocks, 8, 20, "blocks of elements")?;
        numbers.claim(count, 4, 16, "elements")?;
        for _ in 0..blocks {
            let dimension = numbers.int("a dimension")?;
            let entity = numbers.int("the tag of an entity")?;
            let kind = numbers.int("an element type")?;
            let in_block = numbers.size("the number of elements")?;
            let physical = self.physical.get(&(dimension, entity)).copied().unwrap_or(0);
            for _ in 0..numbers.claim(in_block, 4, 16, "elements of a block")? {
                let number = numbers.size("the number of an element")?;
                self.read_element(numbers, kind, number, [physical, i64::from(entity)])?;
            }
        }
        Ok(())
    }

    fn read_element(&mut self, numbers: &mut Numbers<'_>, kind: i32, number: u64, tags: [i64; 2]) -> Outcome<()> {
        let wide = self.version == Version::Four;
        let mut corners = [0_u32; 4];
        let count = match kind {
            1 => 2,
            2 => 3,
            3 | 4 => 4,
            15 => 1,
            8 => 3,
            _ => return Err(refused(&numbers.scanner, kind, number)),
        };
        for corner in &mut corners[..count] {
            let node = if wide { numbers.size("a node")? } else { numbers.int_as_size("a node")? };
            let Some(index) = self.nodes.index(node) else {
                let message = format!("element {number} names node {node}, which does not exist");
                return Err(numbers.scanner.fault("index-out-of-range", message));
            };
            *corner = index;
        }
        match kind {
            15 => self.points += 1,
            1 | 8 => self.lines += 1,
            2 | 3 => {
                self.mesh.polygons.corners.extend_from_slice(&corners[..count]);
                if self.mesh.polygons.corners.len() >= u32::MAX as usize {
                    return Err(numbers
                        .scanner
                        .fault("too-large", "the polygons have more corners than 32 bits can number"));
                }
                close_polygon(&mut self.mesh.polygons);
                self.polygon_tags.push(tags[0]);
                self.polygon_entities.push(tags[1]);
                self.polygon_numbers.push(number);
            }
            _ => {
                self.mesh.tetrahedra.push(corners);
                self.tetrahedron_tags.push(tags[0]);
                self.tetrahedron_entities.push(tags[1]);
                self.tetrahedron_numbers.push(number);
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Outcome<MeshFile> {
        if !self.has_nodes {
            return Err(Fault::of_file("bad-syntax", "the section $Nodes is missing"));
        }
        let mut attributes = Vec::new();
        attributes.extend(tags("tag", Element::Polygon, self.polygon_tags));
        attributes.extend(tags("tag", Element::Tetrahedron, self.tetrahedron_tags));
        attributes.extend(tags("entity", Element::Polygon, self.polygon_entities));
        attributes.extend(tags("entity", Element::Tetrahedron, self.tetrahedron_entities));
        attributes.append(&mut self.mesh.attributes);
        self.mesh.attributes = attributes;
        self.mesh.space = 3;
        for (count, singular, plural) in [
            (self.points, "point element", "point elements"),
            (self.lines, "line element", "line elements"),
            (self.several_physical, "second physical tag", "further physical tags of entities"),
        ] {
            self.mesh.losses.extend((count > 0).then(|| left_out(count, singular, plural)));
        }
        Ok(self.mesh)
    }
}

#[cold]
fn refused(scanner: &Scanner<'_>, kind: i32, number: u64) -> Fault {
    let name = match kind {
        5 => "an 8-node hexahedron",
        6 => "a 6-node prism",
        7 => "a 5-node pyramid",
        9 => "a 6-node triangle",
        10 => "a 9-node quadrangle",
        11 => "a 10-node tetrahedron",
        12 => "a 27-node hexahedron",
        13 => "an 18-node prism",
        14 => "a 14-node pyramid",
        16 => "an 8-node quadrangle",
        17 => "a 20-node hexahedron",
        18 => "a 15-node prism",
        19 => "a 13-node pyramid",
        20..=25 => "a triangle of order 3 or more",
        26..=28 => "a line of order 3 or more",
        29..=31 => "a tetrahedron of order 3 or more",
        _ => "of a type that is not known",
    };
    let message = format!(
        "element {number} is {name} (type {kind}); homeo reads 3-node triangles, 4-node quadrangles and 4-node tetrahedra"
    );
    scanner.fault("unsupported-element", message)
}
