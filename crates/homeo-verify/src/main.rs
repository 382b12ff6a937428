//! `homeo-verify MAP`: checks one map file and says what was proved.

use homeo_verify::{Unreadable, Verdict, verify_file};
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
    let (text, code) = if arguments.iter().any(|argument| argument == "--help" || argument == "-h") {
        (HELP.to_owned(), 0)
    } else {
        run(&arguments).unwrap_or((HELP.to_owned(), 2))
    };
    // A reader that went away is no reason to fail: the verdict is in the exit code.
    let _ = if code == 2 { std::io::stderr().write_all(text.as_bytes()) } else { print(&text) };
    ExitCode::from(code)
}

fn print(text: &str) -> std::io::Result<()> {
    std::io::stdout().write_all(text.as_bytes())
}

/// What to print and the exit code; `None` for wrong usage.
fn run(arguments: &[String]) -> Option<(String, u8)> {
    let (mut map, mut as_json, mut source_hash) = (None, false, None);
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--json" => as_json = true,
            "--source-hash" => source_hash = Some(rest.next()?),
            option if option.starts_with("--") => return None,
            _ if map.is_some() => return None,
            _ => map = Some(argument),
        }
    }
    let (report, code) = report(verify_file(map?.as_ref()), source_hash);
    Some((if as_json { format!("{report}\n") } else { for_people(&report) }, code))
}

/// The verdict as an object whose first field is the answer, and the exit code.
fn report(answer: Result<Verdict, Unreadable>, source_hash: Option<&String>) -> (Value, u8) {
    match answer {
        Ok(Verdict::Certified(claim))
            if source_hash.is_some_and(|hash| !hash.eq_ignore_ascii_case(&claim.source_sha256)) =>
        {
            (
                json!({"verdict": "other source", "source_sha256": claim.source_sha256, "expected_sha256": source_hash}),
                3,
            )
        }
        Ok(Verdict::Certified(claim)) => {
            let checked: Vec<Value> =
                claim.checked.iter().map(|(what, count)| json!({"what": what, "count": count})).collect();
            let report = json!({
                "verdict": "certified", "statement": claim.statement, "kind": claim.kind, "target": claim.target,
                "checked": checked, "source_sha256": claim.source_sha256, "limits": claim.limits,
            });
            (report, 0)
        }
        Ok(Verdict::Refuted(witness)) => {
            let report = json!({
                "verdict": "refuted", "rule": witness.rule, "message": witness.message,
                "cells": witness.cells, "vertices": witness.vertices, "points": witness.points,
            });
            (report, 5)
        }
        Ok(Verdict::Undecided(obstacle)) => {
            (json!({"verdict": "undecided", "message": obstacle.message, "remedy": obstacle.remedy}), 4)
        }
        Err(error) => (json!({"verdict": "unreadable", "message": error.message}), 3),
    }
}

/// The same, one line for each field and each item of a list (at most twenty).
fn for_people(report: &Value) -> String {
    let mut text = format!("{}\n", report["verdict"].as_str().unwrap_or_default());
    for (key, value) in report.as_object().into_iter().flatten().filter(|(key, _)| *key != "verdict") {
        let plain = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        match value.as_array() {
            None => text += &format!("{key}: {}\n", plain(value)),
            Some(items) if items.is_empty() => {}
            Some(items) => {
                text += &format!("{key} ({}):\n", items.len());
                for item in items.iter().take(20) {
                    text += &match (item.get("count"), item.get("what").and_then(Value::as_str)) {
                        (Some(count), Some(what)) => format!("  {:>10}  {what}\n", count.to_string()),
                        _ => format!("  {}\n", plain(item)),
                    };
                }
            }
        }
    }
    text
}
