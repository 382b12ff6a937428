//! PLY, the polygon file format of Stanford, reading: text, binary little endian and big endian.
//!
//! Vertices: `x y z` (or `x y`); faces: the list `vertex_indices` or `vertex_index`. All other
//! properties are kept. Conventional ones become the attributes `normal` (`nx ny nz`), `color`
//! (`red green blue`, `alpha`) and `texture` (`s t`, `u v` or `texture_u texture_v`); the face list
//! `texcoord` becomes `texture` on corners, and any other list with as many entries as corners, or a
//! multiple, an attribute of corners. Properties `name_0 name_1 …` become one attribute `name`.
//! Elements other than vertices and faces are listed in the losses.

use super::binary::{Cursor, Order, Scalar};
use super::build::too_few_corners;
use super::error::{Fault, Outcome};
use super::mesh_file::{Attribute, Element, MeshFile, PolygonList, Values};
use super::ply_header::{ElementHeader, Encoding, Header, Kind, Property};
use super::scan::{Scanner, out_of_range};

pub(super) fn read(bytes: &[u8]) -> Outcome<MeshFile> {
    let mut scanner = Scanner::new(bytes);
    let header = Header::read(&mut scanner)?;
    let mut mesh = MeshFile::default();
    let mut body = Body { bytes, scanner, encoding: header.encoding };
    let mut faces = None;
    let mut has_vertices = false;
    for element in &header.elements {
        let start = body.scanner.position();
        let columns = body.read_element(element)?;
        match element.name.as_str() {
            "vertex" if !has_vertices => {
                has_vertices = true;
                take_vertices(&mut mesh, columns).map_err(|row| body.fault_at_row(element, start, row))?;
            }
            "face" if faces.is_none() => faces = Some((element, start, columns)),
            _ if element.count > 0 => {
                mesh.losses.push(format!("{} elements \"{}\" were left out", element.count, element.name));
            }
            _ => {}
        }
    }
    if !has_vertices {
        return Err(Fault::of_file("bad-header", "the header announces no element \"vertex\""));
    }
    if let Some((element, start, columns)) = faces {
        take_faces(&mut mesh, columns).map_err(|row| body.fault_at_row(element, start, row))?;
    }
    if mesh.space == 0 {
        return Err(Fault::of_file("bad-header", "the vertices have no properties \"x\" and \"y\""));
    }
    Ok(mesh)
}

/// The values of one property over all rows of an element.
struct Column {
    name: String,
    values: Values,
    /// For lists: where the list of each row begins, and the end of the last.
    starts: Option<Vec<u32>>,
    indices: Vec<u32>,
    /// Whether the list names vertices: then it is kept as indices.
    is_indices: bool,
}

/// A row that cannot be taken.
struct BadRow {
    row: usize,
    code: &'static str,
    message: String,
}

struct Body<'a> {
    bytes: &'a [u8],
    scanner: Scanner<'a>,
    encoding: Encoding,
}

impl<'a> Body<'a> {
    fn cursor(&self, order: Order) -> Cursor<'a> {
        Cursor::new(self.bytes, self.scanner.position(), order)
    }

    fn read_element(&mut self, element: &ElementHeader) -> Outcome<Vec<Column>> {
        let mut columns: Vec<Column> =
            element.properties.iter().map(|property| Column::new(property, self.encoding)).collect();
        // Rows of nothing take no bytes, so their number is not to be trusted.
        if columns.is_empty() {
            return Ok(columns);
        }
        match self.encoding {
            Encoding::Text => {
                let count = self.scanner.claim(element.count, 2 * columns.len(), &element.name)?;
                columns.iter_mut().for_each(|column| column.reserve(count));
                for _ in 0..count {
                    for (column, property) in columns.iter_mut().zip(&element.properties) {
                        column.push_text(&mut self.scanner, &property.kind)?;
                    }
                }
            }
            Encoding::Binary(order) => {
                let mut cursor = self.cursor(order);
                let least = element.properties.iter().map(|property| property.kind.least_size()).sum();
                let count = cursor.claim(element.count, least, &element.name)?;
                if element.properties.iter().all(|property| matches!(property.kind, Kind::Scalar(_))) {
                    let rows = cursor.take(count as u64, least, &element.name)?;
                    fill_columns(&mut columns, element, rows, least, order);
                } else {
                    columns.iter_mut().for_each(|column| column.reserve(count));
                    for _ in 0..count {
                        for (column, property) in columns.iter_mut().zip(&element.properties) {
                            column.push_binary(&mut cursor, &property.kind)?;
                        }
                    }
                }
                self.scanner.seek(cursor.position());
            }
        }
        Ok(columns)
    }

    /// Finds the row in the file again: only reached once, on the way out.
    #[cold]
    fn fault_at_row(&self, element: &ElementHeader, start: usize, bad: BadRow) -> Fault {
        let mut again = Body { bytes: self.bytes, scanner: self.scanner.clone(), encoding: self.encoding };
        again.scanner.seek(start);
        let before = ElementHeader { count: bad.row as u64, ..element.clone() };
        // These rows were read before without a fault.
        let _ = again.read_element(&before);
        match self.encoding {
            Encoding::Text => {
                again.scanner.token();
                again.scanner.fault(bad.code, bad.message)
            }
            Encoding::Binary(_) => Fault::at_byte(again.scanner.position(), bad.code, bad.message),
        }
    }
}

/// Rows of a fixed size are read column by column.
fn fill_columns(columns: &mut [Column], element: &ElementHeader, rows: &[u8], row_size: usize, order: Order) {
    let mut offset = 0;
    for (column, property) in columns.iter_mut().zip(&element.properties) {
        let scalar = property.kind.scalar();
        let size = scalar.size();
        let mut packed = Vec::with_capacity(rows.len() / row_size * size);
        for row in rows.chunks_exact(row_size) {
            packed.extend_from_slice(&row[offset..offset + size]);
        }
        column.values = scalar.decode(&packed, order);
        offset += size;
    }
}

impl Column {
    fn new(property: &Property, encoding: Encoding) -> Self {
        let name = property.name.clone();
        // Text has all digits of a coordinate, whatever precision is announced.
        let is_axis = encoding == Encoding::Text && matches!(name.as_str(), "x" | "y" | "z");
        let values = match property.kind.scalar() {
            Scalar::F32 if !is_axis => Values::F32(Vec::new()),
            Scalar::F32 | Scalar::F64 => Values::F64(Vec::new()),
            _ => Values::I64(Vec::new()),
        };
        let starts = property.kind.is_list().then(|| vec![0]);
        let is_whole = property.kind.scalar().is_whole();
        let is_indices = starts.is_some() && is_whole && matches!(name.as_str(), "vertex_indices" | "vertex_index");
        Self { name, values, starts, indices: Vec::new(), is_indices }
    }

    fn reserve(&mut self, count: usize) {
        if let Some(starts) = &mut self.starts {
            starts.reserve_exact(count);
            return;
        }
        match &mut self.values {
            Values::F64(values) => values.reserve_exact(count),
            Values::F32(values) => values.reserve_exact(count),
            Values::I64(values) => values.reserve_exact(count),
            Values::Text(_) => {}
        }
    }

    fn close_list(&mut self) -> bool {
        let length = if self.is_indices { self.indices.len() } else { self.values.len() };
        if let Some(starts) = &mut self.starts {
            starts.push(length as u32);
        }
        length < u32::MAX as usize
    }

    fn push_text(&mut self, scanner: &mut Scanner<'_>, kind: &Kind) -> Outcome<()> {
        if !kind.is_list() {
            return self.push_text_number(scanner);
        }
        let count = scanner.unsigned("the length of a list")?;
        for _ in 0..scanner.claim(count, 2, "entries of a list")? {
            if self.is_indices {
                let index = scanner.integer("a vertex index")?;
                self.indices.push(u32::try_from(index).unwrap_or(u32::MAX));
            } else {
                self.push_text_number(scanner)?;
            }
        }
        if self.close_list() { Ok(()) } else { Err(scanner.fault("too-large", "the lists are too long for 32 bits")) }
    }

    fn push_text_number(&mut self, scanner: &mut Scanner<'_>) -> Outcome<()> {
        match &mut self.values {
            Values::F64(values) => values.push(scanner.float(&self.name)?),
            Values::F32(values) => values.push(scanner.single(&self.name)?),
            Values::I64(values) => values.push(scanner.integer(&self.name)?),
            Values::Text(_) => {}
        }
        Ok(())
    }

    fn push_binary(&mut self, cursor: &mut Cursor<'_>, kind: &Kind) -> Outcome<()> {
        let order = cursor.order;
        let Kind::List(length, scalar) = kind else {
            let scalar = kind.scalar();
            let bytes = cursor.take(1, scalar.size(), "a number")?;
            self.extend(scalar.decode(bytes, order));
            return Ok(());
        };
        let bytes = cursor.take(1, length.size(), "the length of a list")?;
        let count = match bytes {
            &[count] if *length == Scalar::U8 => u32::from(count),
            _ => length.decode_indices(bytes, order).first().copied().unwrap_or(u32::MAX),
        };
        let bytes = cursor.take(u64::from(count), scalar.size(), "entries of a list")?;
        if self.is_indices {
            scalar.decode_indices_into(bytes, order, &mut self.indices);
        } else {
            self.extend(scalar.decode(bytes, order));
        }
        if self.close_list() { Ok(()) } else { Err(cursor.fault("too-large", "the lists are too long for 32 bits")) }
    }

    fn extend(&mut self, read: Values) {
        match (&mut self.values, read) {
            (Values::F64(values), Values::F64(read)) => values.extend(read),
            (Values::F32(values), Values::F32(read)) => values.extend(read),
            (Values::I64(values), Values::I64(read)) => values.extend(read),
            // The column was made for this type.
            _ => {}
        }
    }

    fn take_f64(&mut self) -> Vec<f64> {
        match std::mem::replace(&mut self.values, Values::I64(Vec::new())) {
            Values::F64(values) => values,
            Values::F32(values) => values.into_iter().map(f64::from).collect(),
            Values::I64(values) => values.into_iter().map(|value| value as f64).collect(),
            Values::Text(_) => Vec::new(),
        }
    }
}

fn take_vertices(mesh: &mut MeshFile, mut columns: Vec<Column>) -> Result<(), BadRow> {
    let mut axis = |name: &str| {
        let index = columns.iter().position(|column| column.name == name && column.starts.is_none())?;
        Some(columns.remove(index).take_f64())
    };
    let (Some(x), Some(y)) = (axis("x"), axis("y")) else { return Ok(()) };
    let z = axis("z");
    mesh.space = if z.is_some() { 3 } else { 2 };
    let z = z.unwrap_or_else(|| vec![0.0; x.len()]);
    mesh.positions = x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect();
    if let Some(row) = mesh.positions.iter().position(|position| position.iter().any(|x| !x.is_finite())) {
        let message = format!("vertex {row} has a coordinate that is not a finite number in double precision");
        return Err(BadRow { row, code: "non-finite-coordinate", message });
    }
    for list in columns.extract_if(.., |column| column.starts.is_some()) {
        mesh.losses.push(format!("the list \"{}\" of vertices was left out", list.name));
    }
    mesh.attributes.extend(group_columns(columns, Element::Vertex));
    Ok(())
}

fn take_faces(mesh: &mut MeshFile, mut columns: Vec<Column>) -> Result<(), BadRow> {
    let Some(index) = columns.iter().position(|column| column.is_indices) else {
        let message = "the faces have no list \"vertex_indices\" of whole numbers".to_string();
        return Err(BadRow { row: 0, code: "bad-header", message });
    };
    let column = columns.remove(index);
    let starts = column.starts.unwrap_or_default();
    let limit = mesh.positions.len();
    for (row, pair) in starts.windows(2).enumerate() {
        let corners = &column.indices[pair[0] as usize..pair[1] as usize];
        if corners.len() < 3 {
            return Err(BadRow { row, code: "too-few-corners", message: too_few_corners(row, corners.len()) });
        }
        if let Some(&bad) = corners.iter().find(|&&index| index as usize >= limit) {
            let shown = if bad == u32::MAX { "(not 32 bits)".to_string() } else { bad.to_string() };
            return Err(BadRow {
                row,
                code: "index-out-of-range",
                message: out_of_range("face", row, &shown, limit, 0),
            });
        }
    }
    mesh.polygons = PolygonList { starts: if starts.len() > 1 { starts } else { Vec::new() }, corners: column.indices };
    for list in columns.extract_if(.., |column| column.starts.is_some()) {
        match corner_attribute(&list, &mesh.polygons) {
            Some(components) => {
                let name = if list.name == "texcoord" { "texture".to_string() } else { list.name };
                mesh.attributes.push(Attribute { name, element: Element::Corner, components, values: list.values });
            }
            None => mesh
                .losses
                .push(format!("the list \"{}\" of faces was left out: it does not fit the corners", list.name)),
        }
    }
    mesh.attributes.extend(group_columns(columns, Element::Polygon));
    Ok(())
}

/// How many entries each corner has, where that is the same for all.
fn corner_attribute(list: &Column, polygons: &PolygonList) -> Option<usize> {
    let starts = list.starts.as_ref()?;
    let components = list.values.len().checked_div(polygons.corners.len())?;
    let fits = starts.iter().zip(&polygons.starts).all(|(&a, &b)| u64::from(a) == u64::from(b) * components as u64);
    (fits && components > 0 && starts.len() == polygons.starts.len()).then_some(components)
}

/// Joins properties that belong together, by convention or by number.
fn group_columns(columns: Vec<Column>, element: Element) -> Vec<Attribute> {
    const KNOWN: [(&str, &[&str]); 6] = [
        ("normal", &["nx", "ny", "nz"]),
        ("color", &["red", "green", "blue", "alpha"]),
        ("color", &["red", "green", "blue"]),
        ("texture", &["s", "t"]),
        ("texture", &["u", "v"]),
        ("texture", &["texture_u", "texture_v"]),
    ];
    let mut attributes: Vec<Attribute> = Vec::new();
    let mut rest = columns.as_slice();
    while let Some(first) = rest.first() {
        let starts_with = |names: &[&str]| {
            rest.len() >= names.len() && names.iter().zip(rest).all(|(name, column)| column.name == *name)
        };
        let known = KNOWN.iter().find(|(_, names)| starts_with(names));
        let (name, count) = match known {
            Some((name, names)) => (name.to_string(), names.len()),
            None => numbered_run(rest).unwrap_or((first.name.clone(), 1)),
        };
        let (group, behind) = rest.split_at(count);
        match interleave(group) {
            Some(values) => attributes.push(Attribute { name, element, components: count, values }),
            None => {
                let single = |column: &Column| Attribute {
                    name: column.name.clone(),
                    element,
                    components: 1,
                    values: column.values.clone(),
                };
                attributes.extend(group.iter().map(single));
            }
        }
        rest = behind;
    }
    attributes
}

/// The name and length of a run `name_0 name_1 …` at the beginning.
fn numbered_run(columns: &[Column]) -> Option<(String, usize)> {
    let base = columns.first()?.name.strip_suffix("_0")?;
    let belongs = |(index, column): &(usize, &Column)| {
        column
            .name
            .strip_prefix(base)
            .and_then(|rest| rest.strip_prefix('_'))
            .is_some_and(|rest| rest == index.to_string())
    };
    let count = columns.iter().enumerate().take_while(belongs).count();
    (count > 1 && !base.is_empty()).then(|| (base.to_string(), count))
}

/// The rows of columns of one type.
fn interleave(columns: &[Column]) -> Option<Values> {
    fn rows<T: Copy>(columns: &[Column], of: impl Fn(&Column) -> Option<&Vec<T>>) -> Option<Vec<T>> {
        let columns: Vec<&Vec<T>> = columns.iter().map(of).collect::<Option<_>>()?;
        let count = columns.first().map_or(0, |column| column.len());
        let mut rows = Vec::with_capacity(count * columns.len());
        for row in 0..count {
            rows.extend(columns.iter().map(|column| column[row]));
        }
        Some(rows)
    }
    match &columns.first()?.values {
        Values::F64(_) => {
            rows(columns, |c| if let Values::F64(v) = &c.values { Some(v) } else { None }).map(Values::F64)
        }
        Values::F32(_) => {
            rows(columns, |c| if let Values::F32(v) = &c.values { Some(v) } else { None }).map(Values::F32)
        }
        Values::I64(_) => {
            rows(columns, |c| if let Values::I64(v) = &c.values { Some(v) } else { None }).map(Values::I64)
        }
        Values::Text(_) => None,
    }
}
