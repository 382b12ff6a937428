//! `homeo-verify MAP`: checks one map file and says what was proved.

use homeo_verify::{Verdict, verify_file};
use serde_json::{Value, json};
use std::io::Write;
use std::process::ExitCode;

const HELP: &str = "\
Checks a map file (.homeo) by exact arithmetic, independently of the program that wrote it.

Usage: homeo-verify MAP [--json] [--source-hash HEX]

  --json              print the verdict as one JSON object
  --source-hash HEX   also require that the map is about the mesh with this content_sha256
  --help              print this text

Exit code: 0 certified, 2 wrong usage, 3 unreadable or about another mesh, 4 undecided, 5 refuted.

Example: homeo-verify spot.homeo --json
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    // A reader that went away is no reason to fail: the verdict is in the exit code.
    let (code, _) = match run(&arguments) {
        Some((text, code)) => (code, std::io::stdout().write_all(text.as_bytes())),
        None if arguments == ["--help"] => (0, std::io::stdout().write_all(HELP.as_bytes())),
        None => (2, std::io::stderr().write_all(HELP.as_bytes())),
    };
    ExitCode::from(code)
}

/// What to print and the exit code; `None` for wrong usage.
fn run(arguments: &[String]) -> Option<(String, u8)> {
    let (mut map, mut as_json, mut source_hash) = (None, false, None);
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--json" => as_json = true,
            "--source-hash" => source_hash = Some(rest.next()?),
            option if option.starts_with('-') => return None,
            _ if map.is_some() => return None,
            _ => map = Some(argument),
        }
    }
    let is_other = |hash: &str| source_hash.is_some_and(|expected| !expected.eq_ignore_ascii_case(hash));
    let (report, code) = match verify_file(map?.as_ref()) {
        Err(error) => (json!({"verdict": "unreadable", "message": error.message}), 3),
        Ok(Verdict::Certified(claim)) if is_other(&claim.source_sha256) => {
            (json!({"verdict": "other source", "source_sha256": claim.source_sha256}), 3)
        }
        Ok(verdict @ Verdict::Certified(_)) => (json!(verdict), 0),
        Ok(verdict @ Verdict::Undecided(_)) => (json!(verdict), 4),
        Ok(verdict @ Verdict::Refuted(_)) => (json!(verdict), 5),
    };
    Some((if as_json { format!("{report}\n") } else { lines("", &report) }, code))
}

/// The same for people: a line `key: value` for each text, number and list.
fn lines(key: &str, value: &Value) -> String {
    match value {
        Value::Object(fields) => fields.iter().map(|(key, value)| lines(key, value)).collect(),
        Value::Array(items) if items.iter().all(Value::is_string) => {
            items.iter().map(|item| lines(key, item)).collect()
        }
        Value::String(text) => format!("{key}: {text}\n"),
        other => format!("{key}: {other}\n"),
    }
}
