//! The numbers of MSH files, text or binary, and the numbering of nodes.

use super::binary::{Cursor, Order};
use super::error::Outcome;
use super::scan::{Scanner, show};

/// Numbers that follow each other in the text or in the bytes of a file.
pub(super) struct Numbers<'a> {
    bytes: &'a [u8],
    pub scanner: Scanner<'a>,
    order: Option<Order>,
}

impl<'a> Numbers<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, scanner: Scanner::new(bytes), order: None }
    }

    pub fn is_binary(&self) -> bool {
        self.order.is_some()
    }

    /// Reads the number 1 that tells the order of bytes.
    pub fn begin_binary(&mut self) -> Outcome<()> {
        let mut cursor = Cursor::new(self.bytes, self.scanner.position(), Order::Little);
        let one = cursor.u32("the number 1 that tells the order of bytes")?;
        self.order = match one {
            1 => Some(Order::Little),
            0x0100_0000 => Some(Order::Big),
            _ => return Err(cursor.fault("bad-header", "the number 1 that tells the order of bytes is missing")),
        };
        self.scanner.seek(cursor.position());
        Ok(())
    }

    /// Binary data begins behind the end of the line.
    pub fn next_line(&mut self) {
        if self.is_binary() {
            self.scanner.line();
        }
    }

    /// Runs `text` or, on the bytes, `binary`.
    fn read<T>(
        &mut self,
        text: impl FnOnce(&mut Scanner<'a>) -> Outcome<T>,
        binary: impl FnOnce(&mut Cursor<'a>) -> Outcome<T>,
    ) -> Outcome<T> {
        let Some(order) = self.order else { return text(&mut self.scanner) };
        let mut cursor = Cursor::new(self.bytes, self.scanner.position(), order);
        let value = binary(&mut cursor);
        self.scanner.seek(cursor.position());
        value
    }

    /// A whole number of 32 bits.
    pub fn int(&mut self, what: &str) -> Outcome<i32> {
        self.read(
            |scanner| {
                let value = scanner.integer(what)?;
                i32::try_from(value)
                    .map_err(|_| scanner.fault("too-large", format!("{what}: {value} does not fit 32 bits")))
            },
            |cursor| cursor.i32(what),
        )
    }

    /// A whole number that is 32 bits wide in binary files and not negative.
    pub fn int_as_size(&mut self, what: &str) -> Outcome<u64> {
        self.read(
            |scanner| scanner.unsigned(what),
            |cursor| {
                let value = cursor.i32(what)?;
                u64::try_from(value).map_err(|_| cursor.fault("bad-number", format!("{what} is negative: {value}")))
            },
        )
    }

    /// A whole number of 64 bits that is not negative.
    pub fn size(&mut self, what: &str) -> Outcome<u64> {
        self.read(|scanner| scanner.unsigned(what), |cursor| cursor.u64(what))
    }

    pub fn float(&mut self, what: &str) -> Outcome<f64> {
        self.read(|scanner| scanner.float(what), |cursor| cursor.f64(what))
    }

    pub fn coordinate(&mut self) -> Outcome<f64> {
        self.read(Scanner::coordinate, |cursor| {
            let value = cursor.f64("a coordinate")?;
            let message = || format!("the coordinate {value} is not finite");
            if value.is_finite() { Ok(value) } else { Err(cursor.fault("non-finite-coordinate", message())) }
        })
    }

    /// Holds an announced count against the rest of the file; see [`Scanner::claim`].
    pub fn claim(&mut self, count: u64, text_bytes: usize, binary_bytes: usize, what: &str) -> Outcome<usize> {
        self.read(|scanner| scanner.claim(count, text_bytes, what), |cursor| cursor.claim(count, binary_bytes, what))
    }

    /// The mark that ends a section.
    pub fn end_section(&mut self, name: &str) -> Outcome<()> {
        let wanted = format!("$End{name}");
        let token = self.scanner.expect(&wanted)?;
        if token == wanted.as_bytes() {
            return Ok(());
        }
        Err(self.scanner.fault("bad-syntax", format!("expected {wanted}, found \"{}\"", show(token))))
    }

    /// Moves behind the mark that ends a section.
    pub fn skip_section(&mut self, name: &[u8]) -> Outcome<()> {
        let mark = [b"$End", name].concat();
        while let Some(line) = self.scanner.line() {
            if line.trim_ascii() == mark || (self.is_binary() && line.ends_with(&mark)) {
                return Ok(());
            }
        }
        Err(self.scanner.end_fault(&show(&mark)))
    }
}

/// The vertex of each node number.
#[derive(Default)]
pub(super) struct NodeNumbers {
    numbers: Vec<u64>,
    /// Sorted by number, where the numbers do not follow each other.
    sorted: Vec<(u64, u32)>,
}

impl NodeNumbers {
    pub fn reserve(&mut self, count: usize) {
        self.numbers.reserve_exact(count);
    }

    pub fn push(&mut self, number: u64) {
        self.numbers.push(number);
    }

    /// The numbers in the order of the vertices.
    pub fn iter(&self) -> impl Iterator<Item = u64> + '_ {
        self.numbers.iter().copied()
    }

    /// Makes the numbers findable; two equal ones are an error.
    pub fn close(&mut self, scanner: &Scanner<'_>) -> Outcome<()> {
        let is_run = self.numbers.windows(2).all(|pair| pair[0].checked_add(1) == Some(pair[1]));
        if is_run {
            return Ok(());
        }
        self.sorted = self.numbers.iter().zip(0..).map(|(&number, index)| (number, index)).collect();
        self.sorted.sort_unstable();
        match self.sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => {
                Err(scanner.fault("bad-syntax", format!("there are two nodes with the number {}", pair[0].0)))
            }
            None => Ok(()),
        }
    }

    /// The vertex of a node.
    pub fn index(&self, number: u64) -> Option<u32> {
        if self.sorted.is_empty() {
            let index = number.checked_sub(*self.numbers.first()?)?;
            return (index < self.numbers.len() as u64).then_some(index as u32);
        }
        let found = self.sorted.binary_search_by_key(&number, |&(number, _)| number).ok()?;
        Some(self.sorted[found].1)
    }
}
