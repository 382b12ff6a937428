//! The header of PLY files.

use super::binary::{Order, Scalar};
use super::error::Outcome;
use super::scan::{Scanner, parse_u64, show};

/// How the numbers behind the header are stored.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Binary(Order),
}

/// The type of a property.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Scalar),
    /// The type of the length and of the entries.
    List(Scalar, Scalar),
}

impl Kind {
    pub fn is_list(self) -> bool {
        matches!(self, Self::List(..))
    }

    /// The type of the number or of the entries.
    pub fn scalar(self) -> Scalar {
        match self {
            Self::Scalar(scalar) | Self::List(_, scalar) => scalar,
        }
    }

    /// The least number of bytes that it takes in a binary file.
    pub fn least_size(self) -> usize {
        match self {
            Self::Scalar(scalar) | Self::List(scalar, _) => scalar.size(),
        }
    }
}

#[derive(Clone)]
pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
}

#[derive(Clone)]
pub(super) struct ElementHeader {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<ElementHeader>,
}

impl Header {
    /// Reads the header; `scanner` is then at the first byte behind it.
    pub fn read(scanner: &mut Scanner<'_>) -> Outcome<Self> {
        if scanner.line().unwrap_or_default().trim_ascii() != b"ply" {
            return Err(scanner.fault("bad-header", "a PLY file begins with a line \"ply\""));
        }
        let mut encoding = None;
        let mut elements = Vec::new();
        loop {
            let Some(line) = scanner.line() else { return Err(scanner.end_fault("end_header")) };
            let mut words = Scanner::new(line);
            match words.token() {
                None | Some(b"comment" | b"obj_info") => {}
                Some(b"format") => encoding = Some(read_encoding(scanner, &mut words)?),
                Some(b"element") => elements.push(read_element(scanner, &mut words)?),
                Some(b"property") => {
                    let property = read_property(scanner, &mut words)?;
                    let Some(element) = elements.last_mut() else {
                        return Err(scanner.fault("bad-header", "a property comes before any element"));
                    };
                    let properties: &mut Vec<Property> = &mut element.properties;
                    if properties.iter().any(|other| other.name == property.name) {
                        let message = format!("the property \"{}\" comes twice", property.name);
                        return Err(scanner.fault("bad-header", message));
                    }
                    // Names are compared one by one: hostile headers must not make that slow.
                    if properties.len() >= 1024 {
                        return Err(scanner.fault("bad-header", "there are more than 1024 properties"));
                    }
                    properties.push(property);
                }
                Some(b"end_header") => break,
                Some(word) => {
                    let message = format!("the header line \"{}\" is not known", show(word));
                    return Err(scanner.fault("bad-header", message));
                }
            }
        }
        match encoding {
            Some(encoding) => Ok(Self { encoding, elements }),
            None => Err(scanner.fault("bad-header", "the header has no line \"format\"")),
        }
    }
}

fn read_encoding(scanner: &Scanner<'_>, words: &mut Scanner<'_>) -> Outcome<Encoding> {
    match words.token() {
        Some(b"ascii") => Ok(Encoding::Text),
        Some(b"binary_little_endian") => Ok(Encoding::Binary(Order::Little)),
        Some(b"binary_big_endian") => Ok(Encoding::Binary(Order::Big)),
        other => {
            let message = format!("the format \"{}\" is not known", show(other.unwrap_or_default()));
            Err(scanner.fault("unsupported-variant", message))
        }
    }
}

fn read_element(scanner: &Scanner<'_>, words: &mut Scanner<'_>) -> Outcome<ElementHeader> {
    let name = String::from_utf8_lossy(words.token().unwrap_or_default()).into_owned();
    match words.token().and_then(parse_u64) {
        Some(count) => Ok(ElementHeader { name, count, properties: Vec::new() }),
        None => Err(scanner.fault("bad-header", format!("the element \"{}\" has no count", show(name.as_bytes())))),
    }
}

fn read_property(scanner: &Scanner<'_>, words: &mut Scanner<'_>) -> Outcome<Property> {
    let mut word = || words.token().unwrap_or_default();
    let first = word();
    let kind = if first == b"list" {
        match (scalar_of(word()), scalar_of(word())) {
            (Some(length), Some(entry)) if length.is_whole() => Some(Kind::List(length, entry)),
            _ => None,
        }
    } else {
        scalar_of(first).map(Kind::Scalar)
    };
    let name = String::from_utf8_lossy(word()).into_owned();
    match kind {
        Some(kind) if !name.is_empty() => Ok(Property { name, kind }),
        _ => Err(scanner.fault("bad-header", "a property needs a type that is known and a name")),
    }
}

fn scalar_of(name: &[u8]) -> Option<Scalar> {
    Some(match name {
        b"char" | b"int8" => Scalar::I8,
        b"uchar" | b"uint8" => Scalar::U8,
        b"short" | b"int16" => Scalar::I16,
        b"ushort" | b"uint16" => Scalar::U16,
        b"int" | b"int32" => Scalar::I32,
        b"uint" | b"uint32" => Scalar::U32,
        b"int64" => Scalar::I64,
        b"float" | b"float32" => Scalar::F32,
        b"double" | b"float64" => Scalar::F64,
        _ => return None,
    })
}
