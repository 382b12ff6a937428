//! What can be wrong with a file.

use std::path::PathBuf;

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
#[error("{}: {message}", path.display())]
pub struct WriteError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub message: String,
    /// The error of the operating system, where it is one.
    #[source]
    pub source: Option<std::io::Error>,
}
