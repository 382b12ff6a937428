//! VTK legacy, reading: file versions 1.0 to 5.1, text and binary.
//!
//! Read: `UNSTRUCTURED_GRID` and `POLYDATA` with both layouts of cells (sizes in the list, or
//! `OFFSETS` and `CONNECTIVITY`). Triangles, quadrilaterals, pixels, polygons and triangle strips
//! become polygons; 4-node tetrahedra are kept; points and lines are counted in the losses; all
//! others are refused by name. All attributes of points and cells are kept under their names, but
//! for texts and lookup tables. Other data sets (structured grids, images) are refused by name.

use super::binary::{Cursor, Order, Scalar};
use super::error::{Fault, Outcome};
use super::mesh_file::{MeshFile, Values};
use super::scan::{Scanner, parse_f64, show};
use super::vtk_cells::{BadCell, Cells};

pub(super) fn read(bytes: &[u8]) -> Outcome<MeshFile> {
    let mut reader = Reader::new(bytes)?;
    while let Some(keyword) = reader.scanner.token() {
        let keyword = keyword.to_ascii_uppercase();
        reader.read_section(&keyword)?;
    }
    reader.finish()
}

/// What the attributes that follow belong to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Target {
    /// The file as a whole: read and left out.
    Nothing,
    Points,
    Cells,
}

pub(super) struct Reader<'a> {
    bytes: &'a [u8],
    pub scanner: Scanner<'a>,
    is_binary: bool,
    is_poly_data: bool,
    has_points: bool,
    pub mesh: MeshFile,
    pub cells: Cells,
    /// The corner lists of an unstructured grid, until their types are known.
    pending: Option<Lists>,
    pub target: Target,
    pub target_count: usize,
}

/// Lists of corners: where each begins in `corners`, and where in the file its first corner is.
struct Lists {
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl<'a> Reader<'a> {
    fn new(bytes: &'a [u8]) -> Outcome<Self> {
        let mut scanner = Scanner::new(bytes);
        let first = scanner.line().unwrap_or_default();
        let lower = first.to_ascii_lowercase();
        let Some(version) = lower.strip_prefix(b"# vtk datafile version") else {
            return Err(scanner.fault("bad-header", "a VTK legacy file begins with \"# vtk DataFile Version\""));
        };
        match parse_f64(version.trim_ascii()) {
            Some(version) if (1.0..6.0).contains(&version) => {}
            _ => {
                let message = format!("VTK file version \"{}\" is not read; known are 1.0 to 5.1", show(version));
                return Err(scanner.fault("unsupported-variant", message));
            }
        }
        scanner.line();
        let kind = scanner.expect("ASCII or BINARY")?;
        let is_binary = kind.eq_ignore_ascii_case(b"BINARY");
        if !is_binary && !kind.eq_ignore_ascii_case(b"ASCII") {
            let message = format!("expected ASCII or BINARY on the third line, found \"{}\"", show(kind));
            return Err(scanner.fault("bad-header", message));
        }
        Ok(Self {
            bytes,
            scanner,
            is_binary,
            is_poly_data: false,
            has_points: false,
            mesh: MeshFile { space: 3, ..MeshFile::default() },
            cells: Cells::default(),
            pending: None,
            target: Target::Nothing,
            target_count: 0,
        })
    }

    fn read_section(&mut self, keyword: &[u8]) -> Outcome<()> {
        match keyword {
            b"DATASET" => {
                let kind = self.scanner.expect("the kind of data set")?;
                self.is_poly_data = kind.eq_ignore_ascii_case(b"POLYDATA");
                if !self.is_poly_data && !kind.eq_ignore_ascii_case(b"UNSTRUCTURED_GRID") {
                    let message =
                        format!("the data set {} is not read; known are UNSTRUCTURED_GRID and POLYDATA", show(kind));
                    return Err(self.scanner.fault("unsupported-variant", message));
                }
                Ok(())
            }
            b"POINTS" => self.read_points(),
            b"CELLS" if !self.is_poly_data => {
                let lists = self.read_lists()?;
                if self.pending.replace(lists).is_some() {
                    return Err(self.scanner.fault("bad-syntax", "the section CELLS comes twice"));
                }
                Ok(())
            }
            b"CELL_TYPES" => self.read_types(),
            b"VERTICES" if self.is_poly_data => self.read_poly(2),
            b"LINES" if self.is_poly_data => self.read_poly(4),
            b"POLYGONS" if self.is_poly_data => self.read_poly(7),
            b"TRIANGLE_STRIPS" if self.is_poly_data => self.read_poly(6),
            b"POINT_DATA" => {
                (self.target, self.target_count) = (Target::Points, self.mesh.positions.len());
                self.check_data_count()
            }
            b"CELL_DATA" => {
                (self.target, self.target_count) = (Target::Cells, self.cells.len());
                self.check_data_count()
            }
            b"METADATA" => {
                // Ends with an empty line.
                self.scanner.line();
                while self.scanner.line().is_some_and(|line| !line.trim_ascii().is_empty()) {}
                Ok(())
            }
            _ => super::vtk_data::read_attribute(self, keyword),
        }
    }

    fn check_data_count(&mut self) -> Outcome<()> {
        let count = self.scanner.unsigned("the number of rows")?;
        if count == self.target_count as u64 {
            return Ok(());
        }
        let what = if self.target == Target::Points { "points" } else { "cells" };
        let message = format!("there is data for {count} {what}, but the file has {}", self.target_count);
        Err(self.scanner.fault("bad-syntax", message))
    }

    /// The bytes of `count` binary numbers behind the end of this line.
    pub fn take_bytes(&mut self, count: u64, size: usize, what: &str) -> Outcome<&'a [u8]> {
        let mut cursor = Cursor::new(self.bytes, self.scanner.position(), Order::Big);
        let taken = cursor.take(count, size, what);
        self.scanner.seek(cursor.position());
        taken
    }

    /// `count` numbers of an attribute, text or binary.
    pub fn read_values(&mut self, scalar: Scalar, count: u64, what: &str) -> Outcome<Values> {
        if self.is_binary {
            self.scanner.line();
            return Ok(scalar.decode(self.take_bytes(count, scalar.size(), what)?, Order::Big));
        }
        let count = self.scanner.claim(count, 2, what)?;
        scalar.read_text(&mut self.scanner, count, what)
    }

    pub fn is_binary(&self) -> bool {
        self.is_binary
    }

    fn read_points(&mut self) -> Outcome<()> {
        if std::mem::replace(&mut self.has_points, true) {
            return Err(self.scanner.fault("bad-syntax", "the section POINTS comes twice"));
        }
        let count = self.scanner.unsigned("the number of points")?;
        let scalar = self.read_scalar()?;
        if !self.is_binary {
            let count = self.scanner.claim(count, 6, "points")?;
            self.mesh.positions.reserve_exact(count);
            for _ in 0..count {
                // Read in double precision whatever is announced: the text has all digits.
                let scanner = &mut self.scanner;
                self.mesh.positions.push([scanner.coordinate()?, scanner.coordinate()?, scanner.coordinate()?]);
            }
            return Ok(());
        }
        self.scanner.claim(count, 3 * scalar.size(), "points")?;
        self.scanner.line();
        let start = self.scanner.position();
        let numbers = scalar.decode_f64(self.take_bytes(3 * count, scalar.size(), "coordinates")?, Order::Big);
        if let Some(bad) = numbers.iter().position(|x| !x.is_finite()) {
            let message = format!("point {} has a coordinate that is not finite", bad / 3);
            return Err(Fault::at_byte(start + bad * scalar.size(), "non-finite-coordinate", message));
        }
        self.mesh.positions = numbers.as_chunks::<3>().0.to_vec();
        Ok(())
    }

    /// The type of numbers that the next token names.
    pub fn read_scalar(&mut self) -> Outcome<Scalar> {
        let token = self.scanner.expect("the type of numbers")?;
        match scalar_of(&token.to_ascii_lowercase()) {
            Some(scalar) => Ok(scalar),
            None => {
                let message = format!("numbers of type \"{}\" are not read", show(token));
                Err(self.scanner.fault("unsupported-variant", message))
            }
        }
    }

    /// Indices, text or binary; those that do not fit become `u32::MAX`.
    fn read_indices(&mut self, scalar: Scalar, count: u64, what: &str) -> Outcome<Vec<u32>> {
        if self.is_binary {
            self.scanner.line();
            return Ok(scalar.decode_indices(self.take_bytes(count, scalar.size(), what)?, Order::Big));
        }
        let count = self.scanner.claim(count, 2, what)?;
        let mut indices = Vec::with_capacity(count);
        for _ in 0..count {
            indices.push(u32::try_from(self.scanner.integer(what)?).unwrap_or(u32::MAX));
        }
        Ok(indices)
    }

    /// Lists of corners in either layout.
    fn read_lists(&mut self) -> Outcome<Lists> {
        let count = self.scanner.unsigned("the number of cells")?;
        let size = self.scanner.unsigned("the size of the list of cells")?;
        if self.scanner.peek().is_some_and(|token| token.eq_ignore_ascii_case(b"OFFSETS")) {
            return self.read_offset_lists(count, size);
        }
        let raw = self.read_indices(Scalar::I32, size, "entries of the list of cells")?;
        let mut lists = Lists { starts: vec![0], corners: raw };
        // The sizes are squeezed out in place.
        let (mut from, mut to) = (0, 0);
        for cell in 0..count {
            let length = lists.corners.get(from).map_or(usize::MAX, |&length| length as usize);
            if length > lists.corners.len().saturating_sub(from + 1) {
                let message = format!("the list of cells ends within cell {cell}");
                return Err(self.scanner.fault("bad-syntax", message));
            }
            lists.corners.copy_within(from + 1..from + 1 + length, to);
            from += 1 + length;
            to += length;
            lists.starts.push(to as u32);
        }
        if from != lists.corners.len() {
            return Err(self.scanner.fault("bad-syntax", "the list of cells is longer than its cells"));
        }
        lists.corners.truncate(to);
        Ok(lists)
    }

    /// The layout of version 5: `count` offsets, of which the last is the length of the other list.
    fn read_offset_lists(&mut self, count: u64, size: u64) -> Outcome<Lists> {
        self.scanner.token();
        let scalar = self.read_scalar()?;
        let starts = self.read_indices(scalar, count, "offsets")?;
        let word = self.scanner.expect("CONNECTIVITY")?;
        if !word.eq_ignore_ascii_case(b"CONNECTIVITY") {
            return Err(self.scanner.fault("bad-syntax", "expected CONNECTIVITY behind OFFSETS"));
        }
        let scalar = self.read_scalar()?;
        let corners = self.read_indices(scalar, size, "entries of the list of cells")?;
        let is_partition = match (starts.first(), starts.last()) {
            (Some(&first), Some(&last)) => first == 0 && last as usize == corners.len(),
            _ => corners.is_empty(),
        };
        if !is_partition || starts.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err(self.scanner.fault("bad-syntax", "the offsets of the cells do not rise from 0 to the length"));
        }
        Ok(Lists { starts, corners })
    }

    fn read_types(&mut self) -> Outcome<()> {
        let count = self.scanner.unsigned("the number of cell types")?;
        let Some(lists) = self.pending.take() else {
            return Err(self.scanner.fault("bad-syntax", "the section CELL_TYPES comes before CELLS"));
        };
        if count != lists.starts.len().saturating_sub(1) as u64 {
            return Err(self.scanner.fault("bad-syntax", "there are not as many cell types as cells"));
        }
        let kinds = self.read_indices(Scalar::I32, count, "cell types")?;
        if kinds.iter().all(|&kind| kind == 10) {
            self.cells.reserve_tetrahedra(kinds.len(), &mut self.mesh);
        }
        for (pair, &kind) in lists.starts.windows(2).zip(&kinds) {
            let corners = &lists.corners[pair[0] as usize..pair[1] as usize];
            self.push_cell(i64::from(kind), corners)?;
        }
        Ok(())
    }

    fn read_poly(&mut self, kind: i64) -> Outcome<()> {
        let lists = self.read_lists()?;
        for pair in lists.starts.windows(2) {
            self.push_cell(kind, &lists.corners[pair[0] as usize..pair[1] as usize])?;
        }
        Ok(())
    }

    fn push_cell(&mut self, kind: i64, corners: &[u32]) -> Outcome<()> {
        let vertices = self.mesh.positions.len();
        self.cells.push(kind, corners, vertices, &mut self.mesh).map_err(|bad| {
            let BadCell { code, message, corner } = bad;
            // The element is named; its line is that of the section's end, which helps nobody.
            let message =
                if code == "index-out-of-range" { format!("{message} (its corner {corner})") } else { message };
            Fault::of_file(code, message)
        })
    }

    fn finish(mut self) -> Outcome<MeshFile> {
        if self.pending.is_some() {
            return Err(self.scanner.end_fault("the section CELL_TYPES"));
        }
        self.mesh.losses.extend(self.cells.losses());
        Ok(self.mesh)
    }
}

/// The names of number types in legacy files.
fn scalar_of(name: &[u8]) -> Option<Scalar> {
    Some(match name {
        b"char" | b"signed_char" => Scalar::I8,
        b"unsigned_char" => Scalar::U8,
        b"short" => Scalar::I16,
        b"unsigned_short" => Scalar::U16,
        b"int" => Scalar::I32,
        b"unsigned_int" => Scalar::U32,
        b"long" | b"vtktypeint64" | b"vtkidtype" | b"long_long" => Scalar::I64,
        b"unsigned_long" | b"vtktypeuint64" | b"unsigned_long_long" => Scalar::U64,
        b"float" => Scalar::F32,
        b"double" => Scalar::F64,
        _ => return None,
    })
}
