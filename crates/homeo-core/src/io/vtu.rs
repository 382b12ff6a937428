//! VTU, the XML format of VTK for unstructured grids, reading.
//!
//! Read: one piece; data arrays as text, inline base64, appended raw or appended base64; both byte
//! orders and header sizes; plain or compressed by zlib (LZ4 and LZMA are refused by name).
//! Cells as in VTK legacy. All arrays of numbers on points and cells are kept under their names.

use std::borrow::Cow;

use super::binary::{Order, Scalar};
use super::error::{Fault, Outcome};
use super::mesh_file::{Attribute, Element, MeshFile, Values};
use super::scan::{Scanner, show};
use super::vtk_cells::Cells;
use super::vtu_blocks::{Base64, Budget, Layout, Source};
use super::xml::{Tag, TagKind, Xml};

pub(super) fn read(bytes: &[u8]) -> Outcome<MeshFile> {
    let outline = Outline::read(bytes)?;
    let budget = Budget::new(bytes.len());
    let mut decoder = Decoder { bytes, layout: outline.layout, appended: outline.appended, budget };
    let mut mesh = MeshFile { space: 3, ..MeshFile::default() };
    mesh.positions = decoder.points(&outline)?;
    let cells = decoder.cells(&outline, &mut mesh)?;
    for array in outline.arrays.iter().filter(|array| matches!(array.parent, Parent::PointData | Parent::CellData)) {
        let count = if array.parent == Parent::PointData { outline.point_count } else { outline.cell_count };
        decoder.attribute(array, count, &cells, &mut mesh)?;
    }
    mesh.losses.extend(outline.losses);
    mesh.losses.extend(cells.losses());
    Ok(mesh)
}

/// The tag around a data array.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Parent {
    PointData,
    CellData,
    Points,
    Cells,
    Other,
}

/// Where the numbers of an array are.
#[derive(Clone, Copy)]
enum Storage {
    /// Text in these bytes.
    Text(usize, usize),
    /// Base64 in these bytes.
    Base64(usize, usize),
    /// In the appended data, from this byte on.
    Appended(u64),
}

struct ArrayTag {
    parent: Parent,
    name: String,
    scalar: Option<Scalar>,
    components: u64,
    storage: Storage,
    /// The byte of the tag, for messages.
    at: usize,
}

#[derive(Clone, Copy)]
enum Appended {
    Raw(usize),
    Base64(usize),
}

/// What the tags of the file say.
struct Outline {
    layout: Layout,
    point_count: u64,
    cell_count: u64,
    has_piece: bool,
    arrays: Vec<ArrayTag>,
    appended: Option<Appended>,
    losses: Vec<String>,
}

impl Outline {
    fn read(bytes: &[u8]) -> Outcome<Self> {
        let mut xml = Xml::new(bytes);
        let mut outline = match xml.next_tag()? {
            Some(tag) if tag.name == b"VTKFile" => Self::begin(&xml, &tag)?,
            _ => return Err(xml.fault("bad-header", "a VTU file begins with the tag VTKFile")),
        };
        let mut parent = Parent::Other;
        while let Some(tag) = xml.next_tag()? {
            match (tag.name, tag.kind) {
                (b"VTKFile", TagKind::Close) => return outline.finish(&xml),
                (b"Piece", TagKind::Open | TagKind::Empty) => outline.begin_piece(&xml, &tag)?,
                (b"PointData", TagKind::Open) => parent = Parent::PointData,
                (b"CellData", TagKind::Open) => parent = Parent::CellData,
                (b"Points", TagKind::Open) => parent = Parent::Points,
                (b"Cells", TagKind::Open) => parent = Parent::Cells,
                (b"PointData" | b"CellData" | b"Points" | b"Cells", TagKind::Close) => parent = Parent::Other,
                (b"FieldData", TagKind::Open) => {
                    outline.losses.push("the data of the file as a whole was left out".to_string());
                }
                (b"DataArray" | b"Array", TagKind::Open | TagKind::Empty) if parent != Parent::Other => {
                    outline.add_array(&mut xml, &tag, parent)?;
                }
                (b"AppendedData", TagKind::Open) => {
                    outline.begin_appended(bytes, &xml, &tag)?;
                    return outline.finish(&xml);
                }
                _ => {}
            }
        }
        Err(xml.end_fault("the tag </VTKFile>"))
    }

    fn begin(xml: &Xml<'_>, tag: &Tag<'_>) -> Outcome<Self> {
        let kind = tag.attribute(b"type").unwrap_or_default();
        if kind != "UnstructuredGrid" {
            let message = format!("the data set \"{}\" is not read; expected UnstructuredGrid", show(kind.as_bytes()));
            return Err(xml.fault("unsupported-variant", message));
        }
        let is_compressed = match tag.attribute(b"compressor").as_deref() {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                let name = show(other.as_bytes());
                let message = format!("compression by {name} is not read; save with zlib or without compression");
                return Err(xml.fault("unsupported-variant", message));
            }
        };
        let is_big = tag.attribute(b"byte_order").is_some_and(|order| order == "BigEndian");
        let is_wide = tag.attribute(b"header_type").is_some_and(|kind| kind == "UInt64");
        let order = if is_big { Order::Big } else { Order::Little };
        Ok(Self {
            layout: Layout { order, header_size: if is_wide { 8 } else { 4 }, is_compressed },
            point_count: 0,
            cell_count: 0,
            has_piece: false,
            arrays: Vec::new(),
            appended: None,
            losses: Vec::new(),
        })
    }

    fn begin_piece(&mut self, xml: &Xml<'_>, tag: &Tag<'_>) -> Outcome<()> {
        if std::mem::replace(&mut self.has_piece, true) {
            return Err(xml.fault("unsupported-variant", "files of several pieces are not read; merge them first"));
        }
        let count = |name: &[u8]| {
            let count = tag.attribute(name).and_then(|text| text.trim().parse::<u64>().ok());
            count.ok_or_else(|| xml.fault("bad-syntax", format!("the tag Piece has no count {}", show(name))))
        };
        self.point_count = count(b"NumberOfPoints")?;
        self.cell_count = count(b"NumberOfCells")?;
        for (count, what) in [(self.point_count, "points"), (self.cell_count, "cells")] {
            if count >= u64::from(u32::MAX) {
                return Err(xml.fault("too-large", super::scan::too_large(count, what)));
            }
        }
        Ok(())
    }

    fn add_array(&mut self, xml: &mut Xml<'_>, tag: &Tag<'_>, parent: Parent) -> Outcome<()> {
        let name = tag.attribute(b"Name").unwrap_or_default();
        let components = tag.attribute(b"NumberOfComponents").map_or(Some(1), |text| text.trim().parse::<u64>().ok());
        let Some(components) = components.filter(|count| (1..=1 << 16).contains(count)) else {
            let message =
                format!("the array \"{}\" has a number of components that is not read", show(name.as_bytes()));
            return Err(xml.fault("bad-syntax", message));
        };
        let end = tag.behind + if tag.kind == TagKind::Open { xml.text().len() } else { 0 };
        let storage = match tag.attribute(b"format").as_deref() {
            None | Some("ascii") => Storage::Text(tag.behind, end),
            Some("binary") => Storage::Base64(tag.behind, end),
            Some("appended") => {
                let offset = tag.attribute(b"offset").and_then(|text| text.trim().parse::<u64>().ok());
                Storage::Appended(offset.ok_or_else(|| xml.fault("bad-syntax", "an appended array has no offset"))?)
            }
            Some(other) => {
                let message = format!("arrays in the format \"{}\" are not read", show(other.as_bytes()));
                return Err(xml.fault("unsupported-variant", message));
            }
        };
        let scalar = scalar_of(&tag.attribute(b"type").unwrap_or_default());
        self.arrays.push(ArrayTag { parent, name, scalar, components, storage, at: tag.behind });
        Ok(())
    }

    fn begin_appended(&mut self, bytes: &[u8], xml: &Xml<'_>, tag: &Tag<'_>) -> Outcome<()> {
        let Some(mark) = bytes[tag.behind..].iter().position(|&byte| byte == b'_') else {
            return Err(xml.end_fault("the appended data"));
        };
        let start = tag.behind + mark + 1;
        let is_raw = tag.attribute(b"encoding").is_some_and(|encoding| encoding == "raw");
        self.appended = Some(if is_raw { Appended::Raw(start) } else { Appended::Base64(start) });
        Ok(())
    }

    fn finish(self, xml: &Xml<'_>) -> Outcome<Self> {
        if self.has_piece { Ok(self) } else { Err(xml.fault("bad-syntax", "the tag Piece is missing")) }
    }

    fn find(&self, parent: Parent, name: Option<&str>) -> Outcome<&ArrayTag> {
        let fits = |array: &&ArrayTag| array.parent == parent && name.is_none_or(|name| array.name == name);
        self.arrays.iter().find(fits).ok_or_else(|| {
            let name = name.unwrap_or("Points");
            Fault::of_file("bad-syntax", format!("the data array \"{name}\" is missing"))
        })
    }
}

/// The names of number types in XML files.
fn scalar_of(name: &str) -> Option<Scalar> {
    Some(match name {
        "Int8" => Scalar::I8,
        "UInt8" => Scalar::U8,
        "Int16" => Scalar::I16,
        "UInt16" => Scalar::U16,
        "Int32" => Scalar::I32,
        "UInt32" => Scalar::U32,
        "Int64" => Scalar::I64,
        "UInt64" => Scalar::U64,
        "Float32" => Scalar::F32,
        "Float64" => Scalar::F64,
        _ => return None,
    })
}

struct Decoder<'a> {
    bytes: &'a [u8],
    layout: Layout,
    appended: Option<Appended>,
    budget: Budget,
}

impl<'a> Decoder<'a> {
    #[cold]
    fn fault(&self, array: &ArrayTag, code: &'static str, message: impl Into<String>) -> Fault {
        Fault::at_line_of(self.bytes, array.at, code, message)
    }

    fn scalar(&self, array: &ArrayTag) -> Outcome<Scalar> {
        let message = || format!("the array \"{}\" has a type that is not known", show(array.name.as_bytes()));
        array.scalar.ok_or_else(|| self.fault(array, "bad-syntax", message()))
    }

    /// The bytes of an array that is not text, a whole number of numbers.
    fn block(&mut self, array: &ArrayTag) -> Outcome<Cow<'a, [u8]>> {
        let source = match (array.storage, self.appended) {
            (Storage::Base64(start, end), _) => Source::Base64(Base64::new(&self.bytes[..end], start)),
            (Storage::Appended(offset), Some(appended)) => {
                let offset = usize::try_from(offset).unwrap_or(usize::MAX);
                match appended {
                    Appended::Raw(start) => Source::Raw { bytes: self.bytes, at: start.saturating_add(offset) },
                    Appended::Base64(start) => Source::Base64(Base64::new(self.bytes, start.saturating_add(offset))),
                }
            }
            _ => return Err(self.fault(array, "unexpected-end", "the appended data is missing")),
        };
        source.block(self.layout, &mut self.budget)
    }

    /// `count` numbers; another number of them is an error.
    fn values(&mut self, array: &ArrayTag, count: u64) -> Outcome<Values> {
        let scalar = self.scalar(array)?;
        let values = match array.storage {
            Storage::Text(start, end) => {
                let mut scanner = Scanner::new(&self.bytes[..end]);
                scanner.seek(start);
                // Coordinates are read in double precision whatever is announced.
                let scalar = if array.parent == Parent::Points { Scalar::F64 } else { scalar };
                let count = scanner.claim(count, 2, "numbers of an array")?;
                let values = scalar.read_text(&mut scanner, count, "a number of an array")?;
                if scanner.token().is_some() {
                    return Err(scanner.fault("bad-syntax", "the array holds more numbers than announced"));
                }
                values
            }
            _ => {
                let block = self.block(array)?;
                if block.len() as u64 != count * scalar.size() as u64 {
                    let (found, size) = (block.len(), scalar.size());
                    let message = format!(
                        "the array \"{}\" has {found} bytes instead of {count} numbers of {size} bytes",
                        show(array.name.as_bytes())
                    );
                    return Err(self.fault(array, "bad-syntax", message));
                }
                scalar.decode(&block, self.layout.order)
            }
        };
        Ok(values)
    }

    /// Whole numbers as indices, however many there are; those that do not fit become `u32::MAX`.
    fn indices(&mut self, array: &ArrayTag) -> Outcome<Vec<u32>> {
        let scalar = self.scalar(array)?;
        let Storage::Text(start, end) = array.storage else {
            let block = self.block(array)?;
            return Ok(scalar.decode_indices(&block, self.layout.order));
        };
        let mut scanner = Scanner::new(&self.bytes[..end]);
        scanner.seek(start);
        let mut indices = Vec::new();
        while scanner.peek().is_some() {
            indices.push(u32::try_from(scanner.integer("an index")?).unwrap_or(u32::MAX));
        }
        Ok(indices)
    }

    fn points(&mut self, outline: &Outline) -> Outcome<Vec<[f64; 3]>> {
        let array = outline.find(Parent::Points, None)?;
        if array.components != 3 {
            return Err(self.fault(array, "bad-syntax", "points must have three components"));
        }
        let numbers = match self.values(array, 3 * outline.point_count)? {
            Values::F64(values) => values,
            Values::F32(values) => values.into_iter().map(f64::from).collect(),
            Values::I64(values) => values.into_iter().map(|value| value as f64).collect(),
            Values::Text(_) => Vec::new(),
        };
        if let Some(bad) = numbers.iter().position(|x| !x.is_finite()) {
            let message = format!("point {} has a coordinate that is not a finite number in double precision", bad / 3);
            return Err(self.fault(array, "non-finite-coordinate", message));
        }
        Ok(numbers.as_chunks::<3>().0.to_vec())
    }

    fn cells(&mut self, outline: &Outline, mesh: &mut MeshFile) -> Outcome<Cells> {
        let connectivity = outline.find(Parent::Cells, Some("connectivity"))?;
        let corners = self.indices(connectivity)?;
        let array = outline.find(Parent::Cells, Some("offsets"))?;
        let ends = self.indices(array)?;
        let kinds = self.indices(outline.find(Parent::Cells, Some("types"))?)?;
        if ends.len() as u64 != outline.cell_count || kinds.len() != ends.len() {
            let message =
                format!("there are {} offsets and {} types for {} cells", ends.len(), kinds.len(), outline.cell_count);
            return Err(self.fault(array, "bad-syntax", message));
        }
        let mut cells = Cells::default();
        let mut start = 0;
        for (cell, (&end, &kind)) in ends.iter().zip(&kinds).enumerate() {
            let Some(list) = corners.get(start..end as usize) else {
                let message =
                    format!("the offset of cell {cell} is {end}: offsets must rise to at most {}", corners.len());
                return Err(self.fault(array, "bad-syntax", message));
            };
            cells
                .push(i64::from(kind), list, mesh.positions.len(), mesh)
                .map_err(|bad| self.fault(connectivity, bad.code, bad.message))?;
            start = end as usize;
        }
        Ok(cells)
    }

    fn attribute(&mut self, array: &ArrayTag, count: u64, cells: &Cells, mesh: &mut MeshFile) -> Outcome<()> {
        let name = array.name.clone();
        if array.scalar.is_none() {
            mesh.losses.push(format!("the array \"{name}\" was left out: it does not hold numbers"));
            return Ok(());
        }
        let values = self.values(array, count * array.components)?;
        let components = array.components as usize;
        if array.parent == Parent::CellData {
            mesh.attributes.extend(cells.split(&name, components, values));
        } else {
            mesh.attributes.push(Attribute { name, element: Element::Vertex, components, values });
        }
        Ok(())
    }
}
