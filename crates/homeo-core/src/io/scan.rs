//! Reading numbers and words from the bytes of a text file.
//!
//! Files need not be UTF-8. Nothing is allocated on the word of a header: [`Scanner::claim`] holds
//! every announced count against the bytes that are left.

use super::error::{Fault, Outcome};

/// A place in the bytes of a text file, moving forward.
#[derive(Clone)]
pub(super) struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Where the token that was read last begins.
    last: usize,
    /// Whether `#` begins a comment that ends with the line.
    comments: bool,
}

/// Whether a byte separates tokens.
pub(super) fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c)
}

impl<'a> Scanner<'a> {
    /// Starts at the first byte, behind a byte order mark.
    pub fn new(bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { bytes, at, last: at, comments: false }
    }

    /// The same, and `#` begins a comment.
    pub fn with_comments(bytes: &'a [u8]) -> Self {
        Self { comments: true, ..Self::new(bytes) }
    }

    /// The byte that comes next.
    pub fn position(&self) -> usize {
        self.at
    }

    /// Goes on at byte `at` (no further than the end).
    pub fn seek(&mut self, at: usize) {
        self.at = at.min(self.bytes.len());
        self.last = self.at;
    }

    /// How many bytes are left.
    pub fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The bytes that are left.
    pub fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// Skips separators and comments.
    pub fn skip_blank(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            if is_blank(byte) {
                self.at += 1;
            } else if byte == b'#' && self.comments {
                self.at = self.end_of_line();
            } else {
                break;
            }
        }
    }

    /// The next token, or `None` at the end.
    pub fn token(&mut self) -> Option<&'a [u8]> {
        self.skip_blank();
        self.token_here()
    }

    fn token_here(&mut self) -> Option<&'a [u8]> {
        let start = self.at;
        let stop_at_hash = self.comments;
        let rest = &self.bytes[start..];
        let length = rest.iter().position(|&b| is_blank(b) || (b == b'#' && stop_at_hash)).unwrap_or(rest.len());
        self.last = start;
        self.at = start + length;
        (length > 0).then(|| &rest[..length])
    }

    /// The next token; its absence is an unexpected end.
    pub fn expect(&mut self, what: &str) -> Outcome<&'a [u8]> {
        match self.token() {
            Some(token) => Ok(token),
            None => Err(self.end_fault(what)),
        }
    }

    /// The next token without moving.
    pub fn peek(&self) -> Option<&'a [u8]> {
        self.clone().token()
    }

    /// The next token of this line.
    pub fn token_in_line(&mut self) -> Option<&'a [u8]> {
        while self.bytes.get(self.at).is_some_and(|&b| is_blank(b) && b != b'\n' && b != b'\r') {
            self.at += 1;
        }
        match self.bytes.get(self.at) {
            None | Some(b'\n' | b'\r') => None,
            Some(b'#') if self.comments => None,
            Some(_) => self.token_here(),
        }
    }

    /// Where this line ends (at its end mark, or the end of the file).
    fn end_of_line(&self) -> usize {
        let rest = self.rest();
        self.at + rest.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(rest.len())
    }

    /// The rest of this line without its end, and moves behind the end.
    pub fn line(&mut self) -> Option<&'a [u8]> {
        if self.at == self.bytes.len() {
            return None;
        }
        self.last = self.at;
        let end = self.end_of_line();
        let line = &self.bytes[self.at..end];
        self.at = end;
        if self.bytes.get(self.at) == Some(&b'\r') {
            self.at += 1;
        }
        // Behind CR this is CRLF; behind nothing else than CR it is the LF of this line.
        if self.bytes.get(self.at) == Some(&b'\n') {
            self.at += 1;
        }
        Some(line)
    }

    /// A whole number that is not negative.
    pub fn unsigned(&mut self, what: &str) -> Outcome<u64> {
        let token = self.expect(what)?;
        parse_u64(token).ok_or_else(|| self.bad_number(what, "a whole number that is not negative", token))
    }

    /// A whole number.
    pub fn integer(&mut self, what: &str) -> Outcome<i64> {
        let token = self.expect(what)?;
        parse_i64(token).ok_or_else(|| self.bad_number(what, "a whole number", token))
    }

    /// A number, possibly NaN or infinite.
    pub fn float(&mut self, what: &str) -> Outcome<f64> {
        let token = self.expect(what)?;
        parse_f64(token).ok_or_else(|| self.bad_number(what, "a number", token))
    }

    /// A number in single precision, possibly NaN or infinite.
    pub fn single(&mut self, what: &str) -> Outcome<f32> {
        let token = self.expect(what)?;
        parse_f32(token).ok_or_else(|| self.bad_number(what, "a number", token))
    }

    /// A finite number.
    pub fn coordinate(&mut self) -> Outcome<f64> {
        let value = self.float("a coordinate")?;
        if value.is_finite() { Ok(value) } else { Err(self.non_finite()) }
    }

    /// An index below `limit`, counted from 0.
    pub fn index(&mut self, limit: usize, element: &str, number: usize) -> Outcome<u32> {
        let token = self.expect(element)?;
        match parse_u64(token) {
            Some(index) if index < limit as u64 => Ok(index as u32),
            _ if parse_i64(token).is_some() || all_digits(token) => {
                Err(self.fault("index-out-of-range", out_of_range(element, number, &show(token), limit, 0)))
            }
            _ => Err(self.bad_number(element, "a vertex index", token)),
        }
    }

    /// Takes an announced count of things that need at least `bytes_each` bytes, separators included.
    ///
    /// Refuses counts that do not fit 32 bits or the rest of the file, so that it may be allocated.
    pub fn claim(&self, count: u64, bytes_each: usize, what: &str) -> Outcome<usize> {
        if count >= u64::from(u32::MAX) {
            return Err(self.fault("too-large", too_large(count, what)));
        }
        let needed = count.saturating_mul(bytes_each as u64).saturating_sub(1);
        if needed > self.remaining() as u64 {
            return Err(self.fault("unexpected-end", announced(count, what, self.remaining())));
        }
        Ok(count as usize)
    }

    /// A fault at the token that was read last.
    #[cold]
    pub fn fault(&self, code: &'static str, message: impl Into<String>) -> Fault {
        Fault::at_line_of(self.bytes, self.last, code, message)
    }

    #[cold]
    fn bad_number(&self, what: &str, wanted: &str, token: &[u8]) -> Fault {
        self.fault("bad-number", format!("{what}: expected {wanted}, found \"{}\"", show(token)))
    }

    #[cold]
    pub fn non_finite(&self) -> Fault {
        let token = self.bytes[self.last..self.at].to_vec();
        self.fault(
            "non-finite-coordinate",
            format!("the coordinate \"{}\" is not a finite number in double precision", show(&token)),
        )
    }

    /// The file ends where `what` is needed.
    #[cold]
    pub fn end_fault(&self, what: &str) -> Fault {
        let message = format!("the file ends where {what} should be; it may be cut short");
        Fault::at_line_of(self.bytes, self.bytes.trim_ascii_end().len(), "unexpected-end", message)
    }
}

/// The sentence for a count that 32 bits do not hold.
pub(super) fn too_large(count: u64, what: &str) -> String {
    format!("the file announces {count} {what}; at most {} are supported", u32::MAX - 1)
}

/// The sentence for a count that the file cannot hold.
pub(super) fn announced(count: u64, what: &str, remaining: usize) -> String {
    format!(
        "the file announces {count} {what}, more than its remaining {remaining} bytes can hold; it may be cut short"
    )
}

/// The sentence for an index that names no vertex; `first` is the number of the first vertex.
pub(super) fn out_of_range(element: &str, number: usize, index: &str, vertices: usize, first: usize) -> String {
    if vertices == 0 {
        return format!("{element} {} names vertex {index}, but there are no vertices", number + first);
    }
    let last = vertices - 1 + first;
    format!("{element} {} names vertex {index}, but vertices are numbered {first} to {last}", number + first)
}

/// The first bytes of a token, fit for a message.
pub(super) fn show(token: &[u8]) -> String {
    let text = String::from_utf8_lossy(&token[..token.len().min(40)]).escape_debug().to_string();
    if token.len() > 40 { text + "..." } else { text }
}

fn all_digits(token: &[u8]) -> bool {
    !token.is_empty() && token.iter().all(u8::is_ascii_digit)
}

/// A whole number that is not negative and fits 64 bits.
pub(super) fn parse_u64(token: &[u8]) -> Option<u64> {
    let digits = token.strip_prefix(b"+").unwrap_or(token);
    if digits.is_empty() {
        return None;
    }
    let mut value = 0_u64;
    for &byte in digits {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            return None;
        }
        value = value.checked_mul(10)?.checked_add(u64::from(digit))?;
    }
    Some(value)
}

/// A whole number that fits 64 bits.
pub(super) fn parse_i64(token: &[u8]) -> Option<i64> {
    match token.strip_prefix(b"-") {
        Some(digits) if digits.first().is_some_and(u8::is_ascii_digit) => {
            0_i64.checked_sub_unsigned(parse_u64(digits)?)
        }
        Some(_) => None,
        None => i64::try_from(parse_u64(token)?).ok(),
    }
}

/// The double nearest to the decimal number, which is all of `token`.
pub(super) fn parse_f64(token: &[u8]) -> Option<f64> {
    fast_float2::parse::<f64, _>(token).ok().or_else(|| parse_unusual(token))
}

/// The single nearest to the decimal number, which is all of `token`.
pub(super) fn parse_f32(token: &[u8]) -> Option<f32> {
    fast_float2::parse::<f32, _>(token).ok().or_else(|| parse_unusual(token).map(|value| value as f32))
}

/// What Fortran (`1.5D+3`) and old C libraries (`-1.#IND`, `nan(ind)`) write.
#[cold]
fn parse_unusual(token: &[u8]) -> Option<f64> {
    let lower = token.to_ascii_lowercase();
    let text = std::str::from_utf8(&lower).ok()?;
    let unsigned = text.trim_start_matches(['+', '-']);
    if unsigned.starts_with("1.#inf") {
        return Some(if text.starts_with('-') { f64::NEG_INFINITY } else { f64::INFINITY });
    }
    if unsigned.starts_with("1.#") || unsigned.starts_with("nan(") {
        return Some(f64::NAN);
    }
    let is_fortran = unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.') && unsigned.contains('d');
    if is_fortran { fast_float2::parse::<f64, _>(text.replacen('d', "e", 1)).ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_exactly() {
        for text in ["0.1", "-0.0", "1e-300", "4.9e-324", "1.7976931348623157e308", "0.3333333333333333", "+2.5", "7"] {
            let expected: f64 = text.parse().unwrap();
            assert_eq!(parse_f64(text.as_bytes()).unwrap().to_bits(), expected.to_bits(), "{text}");
        }
        assert_eq!(parse_f64(b"1.5D+3"), Some(1500.0));
        assert_eq!(parse_f64(b"1e999"), Some(f64::INFINITY));
        assert!(parse_f64(b"-1.#IND").unwrap().is_nan());
        for broken in ["", "-", "1.2.3", "0x10", "1e", "abc", "1d"] {
            assert_eq!(parse_f64(broken.as_bytes()), None, "{broken}");
        }
    }

    #[test]
    fn whole_numbers_do_not_overflow() {
        assert_eq!(parse_u64(b"18446744073709551615"), Some(u64::MAX));
        assert_eq!(parse_u64(b"18446744073709551616"), None);
        assert_eq!(parse_i64(b"-9223372036854775808"), Some(i64::MIN));
        assert_eq!(parse_i64(b"-+1"), None);
        assert_eq!(parse_i64(b"--1"), None);
    }

    #[test]
    fn lines_end_in_every_usual_way() {
        let mut scanner = Scanner::new(b"a\r\nb\rc\n\nd");
        let mut lines = Vec::new();
        while let Some(line) = scanner.line() {
            lines.push(line);
        }
        assert_eq!(lines, [&b"a"[..], b"b", b"c", b"", b"d"]);
    }
}
