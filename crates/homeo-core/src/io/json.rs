//! Reading JSON without building it in memory: just what facet lists need.

use super::error::{Fault, Outcome};
use super::scan::{is_blank, parse_f64, parse_u64, show};

/// A place in a JSON text, moving forward.
pub(super) struct Json<'a> {
    bytes: &'a [u8],
    at: usize,
    last: usize,
}

/// A list or object that is being read.
pub(super) struct Items {
    is_first: bool,
}

impl<'a> Json<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { bytes, at, last: at }
    }

    /// Where the value that was read last begins.
    pub fn last(&self) -> usize {
        self.last
    }

    #[cold]
    pub fn fault(&self, code: &'static str, message: impl Into<String>) -> Fault {
        Fault::at_line_of(self.bytes, self.last, code, message)
    }

    fn peek(&mut self) -> Option<u8> {
        while self.bytes.get(self.at).is_some_and(|&byte| is_blank(byte)) {
            self.at += 1;
        }
        self.last = self.at;
        self.bytes.get(self.at).copied()
    }

    fn expect(&mut self, byte: u8) -> Outcome<()> {
        if self.peek() == Some(byte) {
            self.at += 1;
            return Ok(());
        }
        Err(self.unexpected(&format!("\"{}\"", char::from(byte))))
    }

    #[cold]
    fn unexpected(&mut self, wanted: &str) -> Fault {
        match self.peek() {
            None => {
                self.fault("unexpected-end", format!("the file ends where {wanted} should be; it may be cut short"))
            }
            Some(_) => {
                let rest = &self.bytes[self.at..self.bytes.len().min(self.at + 12)];
                self.fault("bad-syntax", format!("expected {wanted}, found \"{}\"", show(rest)))
            }
        }
    }

    /// Whether a list comes next.
    pub fn is_list(&mut self) -> bool {
        self.peek() == Some(b'[')
    }

    pub fn begin_list(&mut self) -> Outcome<Items> {
        self.expect(b'[')?;
        Ok(Items { is_first: true })
    }

    /// Moves to the next item of the list; false behind its end.
    pub fn next_item(&mut self, items: &mut Items) -> Outcome<bool> {
        self.next(items, b']')
    }

    fn next(&mut self, items: &mut Items, end: u8) -> Outcome<bool> {
        let is_first = std::mem::replace(&mut items.is_first, false);
        match self.peek() {
            Some(byte) if byte == end => {
                self.at += 1;
                Ok(false)
            }
            Some(b',') if !is_first => {
                self.at += 1;
                Ok(true)
            }
            Some(_) if is_first => Ok(true),
            _ => Err(self.unexpected("\",\" or the end of a list")),
        }
    }

    pub fn begin_object(&mut self) -> Outcome<Items> {
        if self.peek() != Some(b'{') {
            return Err(self.fault(
                "bad-header",
                "a facet list is a JSON object such as {\"vertices\": 4, \"facets\": [[0, 1, 2, 3]]}",
            ));
        }
        self.expect(b'{')?;
        Ok(Items { is_first: true })
    }

    /// The name of the next member as it is spelled, or `None` behind the end of the object.
    pub fn next_member(&mut self, items: &mut Items) -> Outcome<Option<&'a [u8]>> {
        if !self.next(items, b'}')? {
            return Ok(None);
        }
        let name = self.string()?;
        self.expect(b':')?;
        Ok(Some(name))
    }

    /// The bytes between the quotes.
    fn string(&mut self) -> Outcome<&'a [u8]> {
        self.expect(b'"')?;
        let start = self.at;
        while let Some(&byte) = self.bytes.get(self.at) {
            self.at += 1;
            match byte {
                b'"' => return Ok(&self.bytes[start..self.at - 1]),
                b'\\' => self.at = (self.at + 1).min(self.bytes.len()),
                _ => {}
            }
        }
        Err(self.unexpected("the end of a string"))
    }

    /// A number or a word such as `true`.
    fn scalar(&mut self) -> Outcome<&'a [u8]> {
        self.peek();
        let rest = &self.bytes[self.at..];
        let is_end = |byte: &u8| is_blank(*byte) || b",:[]{}\"".contains(byte);
        let length = rest.iter().position(is_end).unwrap_or(rest.len());
        if length == 0 {
            return Err(self.unexpected("a value"));
        }
        self.at += length;
        Ok(&rest[..length])
    }

    pub fn unsigned(&mut self) -> Outcome<u64> {
        let token = self.scalar()?;
        let message = || format!("expected a whole number that is not negative, found \"{}\"", show(token));
        parse_u64(token).ok_or_else(|| self.fault("bad-number", message()))
    }

    pub fn coordinate(&mut self) -> Outcome<f64> {
        let token = self.scalar()?;
        let message = || format!("expected a number, found \"{}\"", show(token));
        let value = parse_f64(token).ok_or_else(|| self.fault("bad-number", message()))?;
        if value.is_finite() {
            return Ok(value);
        }
        let message = format!("the coordinate \"{}\" is not a finite number in double precision", show(token));
        Err(self.fault("non-finite-coordinate", message))
    }

    /// Moves behind the next value, however deep, without recursion.
    pub fn skip_value(&mut self) -> Outcome<()> {
        let mut depth = 0_usize;
        loop {
            match self.peek() {
                Some(b'[' | b'{') => {
                    depth += 1;
                    self.at += 1;
                }
                Some(b']' | b'}') if depth > 0 => {
                    depth -= 1;
                    self.at += 1;
                }
                Some(b',' | b':') if depth > 0 => self.at += 1,
                Some(b'"') => drop(self.string()?),
                _ => drop(self.scalar()?),
            }
            if depth == 0 {
                return Ok(());
            }
        }
    }

    /// Nothing but blanks may follow.
    pub fn end(&mut self) -> Outcome<()> {
        match self.peek() {
            None => Ok(()),
            Some(_) => Err(self.unexpected("the end of the file")),
        }
    }
}
