//! The licences of everything that the default build links: each must leave a permissive choice. With the feature `gpu` the
//! same for what that adds.
//!
//! `scripts/licences` runs this with `--nocapture` and shows the table. A licence that is not on the
//! list fails the test, whatever it is: copyleft, unknown, or missing.
#![allow(clippy::print_stdout)] // the table is for people

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::process::Command;

use serde_json::Value;

/// Licences that ask for no more than their text and notices. SPDX names.
const PERMISSIVE: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// The permissive licences that satisfy an SPDX expression, or why there are none.
///
/// `OR` is a choice, `AND` asks for both, `/` is the old way to write `OR`.
fn permitted(expression: &str) -> Result<BTreeSet<String>, String> {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut at = 0;
    let found = choice(&words, &mut at)?;
    if at < words.len() { Err(format!("`{expression}` is no licence expression")) } else { found }
}

type Satisfied = Result<BTreeSet<String>, String>;

fn choice(words: &[&str], at: &mut usize) -> Result<Satisfied, String> {
    let mut best = both(words, at)?;
    while words.get(*at) == Some(&"OR") {
        *at += 1;
        let other = both(words, at)?;
        best = best.or(other);
    }
    Ok(best)
}

fn both(words: &[&str], at: &mut usize) -> Result<Satisfied, String> {
    let mut all = single(words, at)?;
    while words.get(*at) == Some(&"AND") {
        *at += 1;
        let other = single(words, at)?;
        all = all.and_then(|mut names| {
            names.extend(other?);
            Ok(names)
        });
    }
    Ok(all)
}

fn single(words: &[&str], at: &mut usize) -> Result<Satisfied, String> {
    let word = *words.get(*at).ok_or("a licence expression ends early")?;
    *at += 1;
    if word == "(" {
        let inside = choice(words, at)?;
        if words.get(*at) != Some(&")") {
            return Err("a parenthesis is not closed".to_owned());
        }
        *at += 1;
        return Ok(inside);
    }
    if matches!(word, ")" | "OR" | "AND" | "WITH") {
        return Err(format!("`{word}` stands where a licence is expected"));
    }
    let mut name = word.to_owned();
    if words.get(*at) == Some(&"WITH") {
        let exception = words.get(*at + 1).ok_or("a licence expression ends early")?;
        name = format!("{word} WITH {exception}");
        *at += 2;
    }
    let is_permissive = PERMISSIVE.contains(&name.as_str());
    Ok(if is_permissive { Ok(BTreeSet::from([name])) } else { Err(format!("{name} is not on the list")) })
}

/// What `cargo metadata` says of this workspace, for this machine's platform and the default features; with `gpu`, if this
/// test is built with it.
fn metadata() -> Value {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let version = Command::new(&cargo).arg("-vV").output().expect("cargo runs");
    let text = String::from_utf8_lossy(&version.stdout).into_owned();
    let host = text.lines().find_map(|line| line.strip_prefix("host: ")).expect("cargo names its host");
    let arguments = ["metadata", "--format-version=1", "--locked", "--filter-platform", host, "--manifest-path"];
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    let features: &[&str] = if cfg!(feature = "gpu") { &["--features", "gpu"] } else { &[] };
    let output = Command::new(&cargo).args(arguments).arg(manifest).args(features).output().expect("cargo runs");
    assert!(output.status.success(), "cargo metadata: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// The packages that the workspace's libraries and programs need, tests aside.
fn closure(metadata: &Value) -> BTreeSet<String> {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let nodes: HashMap<String, Value> =
        list(&metadata["resolve"]["nodes"]).into_iter().map(|node| (text(&node["id"]), node)).collect();
    let mut open: Vec<String> = list(&metadata["workspace_members"]).iter().map(text).collect();
    let mut reached = BTreeSet::new();
    while let Some(id) = open.pop() {
        if !reached.insert(id.clone()) {
            continue;
        }
        for dependency in nodes.get(&id).map_or_else(Vec::new, |node| list(&node["deps"])) {
            let is_for_tests_only = list(&dependency["dep_kinds"]).iter().all(|kind| kind["kind"] == "dev");
            if !is_for_tests_only {
                open.push(text(&dependency["pkg"]));
            }
        }
    }
    reached
}

#[test]
fn every_dependency_of_the_default_build_leaves_a_permissive_choice() {
    let metadata = metadata();
    let reached = closure(&metadata);
    let mut table: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut refused = Vec::new();
    for package in metadata["packages"].as_array().expect("packages") {
        if !reached.contains(package["id"].as_str().unwrap_or_default()) {
            continue;
        }
        let name =
            format!("{} {}", package["name"].as_str().unwrap_or("?"), package["version"].as_str().unwrap_or("?"));
        let expression = package["license"].as_str().unwrap_or("(none stated)");
        if let Err(why) = permitted(expression) {
            refused.push(format!("{name}: {expression}: {why}"));
        }
        table.entry(expression.to_owned()).or_default().push(name);
    }
    let count: usize = table.values().map(Vec::len).sum();
    let build = if cfg!(feature = "gpu") { "the build with `gpu`" } else { "the default build" };
    println!("{count} packages in {build}, by stated licence:");
    for (expression, names) in &table {
        println!("  {expression}: {}", names.join(", "));
    }
    assert!(count > 20, "the dependency graph was read (found {count} packages)");
    let has_wgpu = table.values().flatten().any(|name| name.starts_with("wgpu "));
    assert_eq!(has_wgpu, cfg!(feature = "gpu"), "wgpu is for the feature `gpu` alone");
    assert!(refused.is_empty(), "not permissive:\n{}", refused.join("\n"));
}

#[test]
fn copyleft_unknown_and_missing_licences_are_refused() {
    let refused = [
        "GPL-3.0-only",
        "GPL-2.0+",
        "LGPL-3.0-only",
        "LGPL-2.1-or-later",
        "AGPL-3.0",
        "MPL-2.0",
        "EPL-2.0",
        "EUPL-1.2",
        "CC-BY-SA-4.0",
        "SSPL-1.0",
        "MIT AND GPL-3.0-only",
        "(MIT OR Apache-2.0) AND MPL-2.0",
        "GPL-2.0-only WITH Classpath-exception-2.0",
        "GPL-3.0 OR LGPL-3.0",
        "GPL-3.0/MPL-2.0",
        "mit",
        "Proprietary",
        "(none stated)",
        "",
        "MIT OR",
        "(MIT",
        "MIT)",
        "MIT MIT",
    ];
    for expression in refused {
        assert!(permitted(expression).is_err(), "`{expression}` must be refused");
    }
}

#[test]
fn a_permissive_choice_is_found() {
    let accepted = [
        ("MIT", "MIT"),
        ("MIT/Apache-2.0", "MIT"),
        ("LGPL-3.0 OR MIT", "MIT"),
        ("Unlicense OR MIT", "Unlicense"),
        ("(MIT OR Apache-2.0) AND Unicode-3.0", "MIT + Unicode-3.0"),
        ("GPL-3.0-only OR (BSD-3-Clause AND ISC)", "BSD-3-Clause + ISC"),
        ("Apache-2.0 WITH LLVM-exception", "Apache-2.0 WITH LLVM-exception"),
    ];
    for (expression, expected) in accepted {
        let names: Vec<String> = permitted(expression).unwrap().into_iter().collect();
        assert_eq!(names.join(" + "), expected, "{expression}");
    }
}
