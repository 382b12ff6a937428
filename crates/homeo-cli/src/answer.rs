//! The one place that prints an answer: JSON or text on standard output, errors on standard error.

use std::io::{self, Write};

use serde_json::{Map, Value, json};

use crate::failure::{Exit, Failure};
use crate::session::Session;

/// What a verb has to say.
pub struct Answer {
    /// 0, or 5 where a certificate does not hold.
    pub exit: Exit,
    /// Fields of the JSON object.
    pub fields: Map<String, Value>,
    /// Text for people, or the result itself.
    pub text: Vec<u8>,
}

impl Answer {
    /// An answer with exit code 0.
    pub fn new(fields: Value, text: impl Into<Vec<u8>>) -> Self {
        let fields = match fields {
            Value::Object(fields) => fields,
            _ => Map::new(),
        };
        Self { exit: Exit::Done, fields, text: text.into() }
    }
}

/// Prints an answer; returns the exit code.
pub fn print_answer(session: &Session, answer: Answer) -> u8 {
    session.end_stage();
    if session.common.json {
        let mut fields = session.fields(answer.exit == Exit::Done);
        fields.extend(answer.fields);
        print_object(fields);
    } else {
        print_bytes(&answer.text);
    }
    answer.exit.code()
}

/// Prints a failure; returns the exit code.
pub fn print_failure(session: &Session, failure: Failure) -> u8 {
    let exit = failure.exit;
    if session.common.json {
        let mut fields = session.fields(false);
        fields.extend(failure.fields);
        fields.insert("error".to_owned(), json!({"code": failure.code, "message": failure.message}));
        print_object(fields);
    }
    print_error(exit, &failure.message);
    exit.code()
}

/// Prints a failure before there is a session: wrong usage.
pub fn print_early(verb: Option<&str>, json: bool, code: &str, message: &str) {
    if json {
        let mut fields = Map::new();
        fields.insert("verb".to_owned(), json!(verb));
        fields.insert("version".to_owned(), json!(env!("CARGO_PKG_VERSION")));
        fields.insert("ok".to_owned(), json!(false));
        fields.insert("error".to_owned(), json!({"code": code, "message": message}));
        print_object(fields);
    }
}

/// An error for people.
pub fn print_error(exit: Exit, message: &str) {
    eprintln!("homeo: {message}");
    if exit == Exit::Bug {
        eprintln!(
            "homeo: this is a bug in homeo {}. Please report it with the command line, the input and the lines above at {}",
            env!("CARGO_PKG_VERSION"),
            env!("CARGO_PKG_REPOSITORY")
        );
    }
}

fn print_object(fields: Map<String, Value>) {
    let mut text = Value::Object(fields).to_string().into_bytes();
    text.push(b'\n');
    print_bytes(&text);
}

/// A reader that went away is no error of ours.
fn print_bytes(bytes: &[u8]) {
    let mut out = io::stdout().lock();
    let _ = out.write_all(bytes).and_then(|()| out.flush());
}
