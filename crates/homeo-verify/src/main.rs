//! `homeo-verify MAP`: checks one map file and says what was proved.

#![allow(clippy::print_stdout, clippy::print_stderr)] // this is what a command-line program is for

use homeo_verify::{Claim, Unreadable, Verdict, Witness, verify_file};
use serde_json::json;
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

struct Arguments {
    map: String,
    as_json: bool,
    source_hash: Option<String>,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "--help" || argument == "-h") {
        print!("{HELP}");
        return ExitCode::SUCCESS;
    }
    let Some(arguments) = parse(&arguments) else {
        eprint!("{HELP}");
        return ExitCode::from(2);
    };
    let answer = verify_file(arguments.map.as_ref());
    let code = match (&answer, &arguments.source_hash) {
        (Ok(Verdict::Certified(claim)), Some(hash)) if !claim.source_sha256.eq_ignore_ascii_case(hash) => {
            report_other_mesh(claim, hash, arguments.as_json);
            return ExitCode::from(3);
        }
        (Ok(Verdict::Certified(_)), _) => 0,
        (Err(_), _) => 3,
        (Ok(Verdict::Undecided(_)), _) => 4,
        (Ok(Verdict::Refuted(_)), _) => 5,
    };
    if arguments.as_json {
        println!("{}", as_json(&answer));
    } else {
        print_for_people(&answer);
    }
    ExitCode::from(code)
}

fn parse(arguments: &[String]) -> Option<Arguments> {
    let (mut map, mut as_json, mut source_hash) = (None, false, None);
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--json" => as_json = true,
            "--source-hash" => source_hash = Some(rest.next()?.clone()),
            option if option.starts_with("--") => return None,
            _ if map.is_some() => return None,
            _ => map = Some(argument.clone()),
        }
    }
    Some(Arguments { map: map?, as_json, source_hash })
}

fn report_other_mesh(claim: &Claim, expected: &str, in_json: bool) {
    let found = &claim.source_sha256;
    if in_json {
        println!("{}", json!({"verdict": "other source", "source_sha256": found, "expected_sha256": expected}));
    } else {
        println!("other source: the map is about the mesh {found}, not {expected}");
    }
}

fn as_json(answer: &Result<Verdict, Unreadable>) -> serde_json::Value {
    match answer {
        Ok(Verdict::Certified(claim)) => json!({
            "verdict": "certified", "statement": claim.statement, "kind": claim.kind, "target": claim.target,
            "checked": claim.checked.iter().map(|(what, count)| json!({"what": what, "count": count})).collect::<Vec<_>>(),
            "source_sha256": claim.source_sha256, "limits": claim.limits,
        }),
        Ok(Verdict::Refuted(witness)) => json!({
            "verdict": "refuted", "rule": witness.rule, "message": witness.message,
            "cells": witness.cells, "vertices": witness.vertices, "points": witness.points,
        }),
        Ok(Verdict::Undecided(obstacle)) => {
            json!({"verdict": "undecided", "message": obstacle.message, "remedy": obstacle.remedy})
        }
        Err(error) => json!({"verdict": "unreadable", "message": error.message}),
    }
}

fn print_for_people(answer: &Result<Verdict, Unreadable>) {
    match answer {
        Ok(Verdict::Certified(claim)) => {
            println!("certified: {}", claim.statement);
            println!("checked:");
            claim.checked.iter().for_each(|(what, count)| println!("  {count:>10}  {what}"));
            println!("source: sha256 {}", claim.source_sha256);
            println!("limits:");
            claim.limits.iter().for_each(|limit| println!("  {limit}"));
        }
        Ok(Verdict::Refuted(witness)) => print_witness(witness),
        Ok(Verdict::Undecided(obstacle)) => {
            println!("undecided: {}\nremedy: {}", obstacle.message, obstacle.remedy);
        }
        Err(error) => println!("{error}"),
    }
}

fn print_witness(witness: &Witness) {
    println!("refuted by rule {}: {}", witness.rule, witness.message);
    let shown = 20;
    let list = |name: &str, numbers: &[u32]| {
        let more = if numbers.len() > shown { ", ..." } else { "" };
        let text: Vec<String> = numbers.iter().take(shown).map(u32::to_string).collect();
        if !numbers.is_empty() {
            println!("  {name}: {}{more}", text.join(", "));
        }
    };
    list("cells", &witness.cells);
    list("vertices", &witness.vertices);
    witness.points.iter().take(shown).for_each(|[x, y, z]| println!("  at {x} {y} {z}"));
}
