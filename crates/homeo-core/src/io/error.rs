//! What can be wrong with a file.

use std::path::{Path, PathBuf};

/// Where in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
    /// The file as a whole.
    File,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}: "),
            Self::Byte(byte) => write!(f, "byte {byte}: "),
            Self::File => Ok(()),
        }
    }
}

/// A file that cannot be taken as the mesh it claims to be.
#[derive(Debug, thiserror::Error)]
#[error("{}: {place}{message}", path.display())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// Where it goes wrong.
    pub place: Place,
    /// A short stable code, such as `unexpected-end` or `non-finite-coordinate`.
    pub code: &'static str,
    /// What is wrong and what to do about it.
    pub message: String,
    /// The error of the operating system, where it is one.
    #[source]
    pub source: Option<std::io::Error>,
}

/// A mesh that cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{}{message}", Self::prefix(path))]
pub struct WriteError {
    /// The file; empty where the output is not a file.
    pub path: PathBuf,
    /// What is wrong.
    pub message: String,
    /// The error of the operating system, where it is one.
    #[source]
    pub source: Option<std::io::Error>,
}

impl WriteError {
    /// An error about the mesh itself, before any file is involved.
    pub(super) fn of_mesh(message: impl Into<String>) -> Self {
        Self { path: PathBuf::new(), message: message.into(), source: None }
    }

    /// An error of the operating system on `path`.
    pub(super) fn of_file(path: &Path, message: &str, source: std::io::Error) -> Self {
        Self { path: path.to_path_buf(), message: format!("{message}: {source}"), source: Some(source) }
    }

    fn prefix(path: &Path) -> String {
        if path.as_os_str().is_empty() { String::new() } else { format!("{}: ", path.display()) }
    }
}

impl From<std::io::Error> for WriteError {
    fn from(source: std::io::Error) -> Self {
        Self::of_file(Path::new(""), "the output cannot be written", source)
    }
}

/// A [`ReadError`] that does not know its file yet: what the readers of single formats return.
#[derive(Debug)]
pub(super) struct Fault {
    pub place: Place,
    pub code: &'static str,
    pub message: String,
}

/// What the readers of single formats return.
pub(super) type Outcome<T> = Result<T, Fault>;

impl Fault {
    /// A fault of the file as a whole.
    pub fn of_file(code: &'static str, message: impl Into<String>) -> Self {
        Self { place: Place::File, code, message: message.into() }
    }

    /// A fault at a byte of a binary file.
    pub fn at_byte(byte: usize, code: &'static str, message: impl Into<String>) -> Self {
        Self { place: Place::Byte(byte as u64), code, message: message.into() }
    }

    /// A fault at the line of a text file that holds byte `at`.
    ///
    /// Lines are counted here, once, so that readers need not count them as they go.
    pub fn at_line_of(bytes: &[u8], at: usize, code: &'static str, message: impl Into<String>) -> Self {
        Self { place: Place::Line(line_of(bytes, at)), code, message: message.into() }
    }

    /// The error that users see.
    pub fn in_file(self, path: &Path) -> ReadError {
        ReadError { path: path.to_path_buf(), place: self.place, code: self.code, message: self.message, source: None }
    }
}

/// The line that holds byte `at`, counted from 1; ends are LF, CRLF or CR.
fn line_of(bytes: &[u8], at: usize) -> u64 {
    let before = &bytes[..at.min(bytes.len())];
    let mut line = 1;
    for (index, &byte) in before.iter().enumerate() {
        let lone_return = byte == b'\r' && bytes.get(index + 1) != Some(&b'\n');
        line += u64::from(byte == b'\n' || lone_return);
    }
    line
}
