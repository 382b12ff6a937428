//! Reading the subset of XML that VTK files use: tags with attributes, and text between them.

use super::error::{Fault, Outcome};

/// A place in an XML text, moving forward.
pub(super) struct Xml<'a> {
    bytes: &'a [u8],
    at: usize,
    last: usize,
}

/// A tag.
pub(super) struct Tag<'a> {
    pub name: &'a [u8],
    pub kind: TagKind,
    /// Where the text behind the tag begins.
    pub behind: usize,
    attributes: &'a [u8],
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum TagKind {
    Open,
    Close,
    /// Opened and closed at once.
    Empty,
}

impl<'a> Xml<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, last: 0 }
    }

    /// A fault at the tag that was read last.
    #[cold]
    pub fn fault(&self, code: &'static str, message: impl Into<String>) -> Fault {
        Fault::at_line_of(self.bytes, self.last, code, message)
    }

    #[cold]
    pub fn end_fault(&self, what: &str) -> Fault {
        let message = format!("the file ends where {what} should be; it may be cut short");
        Fault::at_line_of(self.bytes, self.bytes.trim_ascii_end().len(), "unexpected-end", message)
    }

    /// The text from here to the next tag, which becomes the next one.
    pub fn text(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&byte| byte == b'<').unwrap_or(rest.len());
        self.at += length;
        &rest[..length]
    }

    /// The next tag; comments, declarations and text are skipped. `None` at the end of the file.
    pub fn next_tag(&mut self) -> Outcome<Option<Tag<'a>>> {
        loop {
            self.text();
            self.last = self.at;
            let rest = &self.bytes[self.at..];
            let mark: &[u8] = match rest {
                [] => return Ok(None),
                [b'<', b'!', b'-', b'-', ..] => b"-->",
                [b'<', b'?', ..] => b"?>",
                [b'<', b'!', ..] => b">",
                _ => break,
            };
            let Some(length) = rest.windows(mark.len()).position(|window| window == mark) else {
                return Err(self.end_fault("the end of a comment or declaration"));
            };
            self.at += length + mark.len();
        }
        self.read_tag().map(Some)
    }

    fn read_tag(&mut self) -> Outcome<Tag<'a>> {
        let rest = &self.bytes[self.at + 1..];
        let mut quote = None;
        let end = rest.iter().position(|&byte| {
            match quote {
                Some(open) if byte == open => quote = None,
                None if byte == b'"' || byte == b'\'' => quote = Some(byte),
                None if byte == b'>' => return true,
                _ => {}
            }
            false
        });
        let Some(end) = end else { return Err(self.end_fault("the end of a tag")) };
        let mut inner = &rest[..end];
        self.at += end + 2;
        let mut kind = TagKind::Open;
        if let Some(shorter) = inner.strip_prefix(b"/") {
            (inner, kind) = (shorter, TagKind::Close);
        } else if let Some(shorter) = inner.strip_suffix(b"/") {
            (inner, kind) = (shorter, TagKind::Empty);
        }
        let length = inner.iter().position(u8::is_ascii_whitespace).unwrap_or(inner.len());
        let (name, attributes) = inner.split_at(length);
        if name.is_empty() {
            return Err(self.fault("bad-syntax", "a tag has no name"));
        }
        Ok(Tag { name, kind, behind: self.at, attributes })
    }
}

impl Tag<'_> {
    /// The value of an attribute, entities resolved.
    pub fn attribute(&self, name: &[u8]) -> Option<String> {
        let mut rest = self.attributes.trim_ascii_start();
        while !rest.is_empty() {
            let equals = rest.iter().position(|&byte| byte == b'=')?;
            let found = rest[..equals].trim_ascii();
            let behind = rest[equals + 1..].trim_ascii_start();
            let (&quote, behind) = behind.split_first().filter(|(quote, _)| matches!(quote, b'"' | b'\''))?;
            let end = behind.iter().position(|&byte| byte == quote)?;
            if found == name {
                return Some(unescape(&behind[..end]));
            }
            rest = behind[end + 1..].trim_ascii_start();
        }
        None
    }
}

fn unescape(value: &[u8]) -> String {
    let text = String::from_utf8_lossy(value);
    if !text.contains('&') {
        return text.into_owned();
    }
    let mut plain = String::new();
    let mut rest = &*text;
    while let Some(start) = rest.find('&') {
        plain.push_str(&rest[..start]);
        rest = &rest[start..];
        let end = rest.bytes().take(12).position(|byte| byte == b';');
        match end.and_then(|end| Some((entity(&rest[1..end])?, end))) {
            Some((character, end)) => {
                plain.push(character);
                rest = &rest[end + 1..];
            }
            None => {
                plain.push('&');
                rest = &rest[1..];
            }
        }
    }
    plain + rest
}

fn entity(name: &str) -> Option<char> {
    match name {
        "amp" => Some('&'),
        "lt" => Some('<'),
        "gt" => Some('>'),
        "quot" => Some('"'),
        "apos" => Some('\''),
        _ => match (name.strip_prefix("#x"), name.strip_prefix('#')) {
            (Some(digits), _) => char::from_u32(u32::from_str_radix(digits, 16).ok()?),
            (None, Some(digits)) => char::from_u32(digits.parse().ok()?),
            (None, None) => None,
        },
    }
}

/// A text that may stand between quotes in a tag.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::new();
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c if c.is_control() => escaped.push_str(&format!("&#{};", u32::from(c))),
            c => escaped.push(c),
        }
    }
    escaped
}
