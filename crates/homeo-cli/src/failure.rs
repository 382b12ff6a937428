//! What can go wrong, with the exit code that scripts see.

use serde_json::{Map, Value};

/// The exit codes of the interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    Done,
    Bug,
    Usage,
    Input,
    Limits,
    Refuted,
    /// Ctrl-C or a termination signal, as shells count it.
    Interrupted,
}

impl Exit {
    /// The number.
    pub fn code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::Bug => 1,
            Self::Usage => 2,
            Self::Input => 3,
            Self::Limits => 4,
            Self::Refuted => 5,
            Self::Interrupted => 130,
        }
    }
}

/// An answer that is not the one asked for.
#[derive(Debug)]
pub struct Failure {
    /// For the shell.
    pub exit: Exit,
    /// For programs: short and stable.
    pub code: &'static str,
    /// For people: what is wrong, which elements first, what to do.
    pub message: String,
    /// More fields of the JSON object.
    pub fields: Map<String, Value>,
}

/// What everything here returns.
pub type Result<T> = std::result::Result<T, Failure>;

impl Failure {
    /// A failure of any kind.
    pub fn new(exit: Exit, code: &'static str, message: impl Into<String>) -> Self {
        Self { exit, code, message: message.into(), fields: Map::new() }
    }

    /// The command line asks for something that makes no sense.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::new(Exit::Usage, "usage", message)
    }

    /// The input is not what the verb needs.
    pub fn input(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Exit::Input, code, message)
    }

    /// No map within the limits.
    pub fn limits(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Exit::Limits, code, message)
    }

    /// Something that cannot happen.
    pub fn bug(message: impl Into<String>) -> Self {
        Self::new(Exit::Bug, "bug", message)
    }

    /// The same failure with one more field.
    pub fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.fields.insert(name.to_owned(), value.into());
        self
    }
}
