//! Documents and sources as a whole: links lead somewhere, and nothing tells of the machine it was made on.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the repository")
}

/// The files under version control; in a plain copy of the sources, all but build products.
fn files() -> Vec<PathBuf> {
    let listed = std::process::Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output();
    let mut files: Vec<PathBuf> = match listed {
        Ok(output) if output.status.success() && !output.stdout.is_empty() => {
            let names = String::from_utf8_lossy(&output.stdout).into_owned();
            names.split_terminator('\0').map(|name| root().join(name)).filter(|path| path.is_file()).collect()
        }
        _ => walked(),
    };
    files.sort();
    files
}

fn walked() -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut open = vec![root()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).expect("a readable folder").flatten() {
            let name = entry.file_name();
            let is_product = matches!(name.to_string_lossy().as_ref(), ".git" | "target" | "out" | "node_modules");
            match entry.path() {
                _ if is_product => {}
                path if path.is_dir() => open.push(path),
                path => files.push(path),
            }
        }
    }
    files
}

fn documents() -> Vec<(PathBuf, String)> {
    let is_markdown = |path: &PathBuf| path.extension().is_some_and(|e| e == "md");
    files().into_iter().filter(is_markdown).map(|p| (p.clone(), std::fs::read_to_string(&p).expect("UTF-8"))).collect()
}

/// The text outside fenced blocks and code spans.
fn prose(text: &str) -> String {
    let mut prose = String::new();
    let mut fenced = false;
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            let outside = line.split('`').step_by(2);
            prose.push_str(&outside.collect::<Vec<_>>().join("`"));
        }
        prose.push('\n');
    }
    prose
}

/// Targets of inline links.
fn links(text: &str) -> Vec<String> {
    let prose = prose(text);
    let after = prose.split("](").skip(1);
    after.filter_map(|rest| rest.split_once(')').map(|(target, _)| target.to_owned())).collect()
}

/// The name by which a heading is linked to.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase();
    let kept = kept.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

fn anchors(text: &str) -> HashSet<String> {
    let mut fenced = false;
    let mut found: HashMap<String, usize> = HashMap::new();
    let mut all = HashSet::new();
    for line in text.lines() {
        fenced ^= line.trim_start().starts_with("```");
        if let Some(heading) = line.strip_prefix('#').filter(|_| !fenced) {
            let name = anchor(heading.trim_start_matches('#'));
            let seen = found.entry(name.clone()).or_default();
            all.insert(if *seen == 0 { name } else { format!("{name}-{seen}") });
            *seen += 1;
        }
    }
    all
}

/// Links of a document that lead nowhere in this repository.
fn broken(path: &Path, text: &str) -> Vec<String> {
    let mut broken = Vec::new();
    for link in links(text) {
        if link.contains("://") || link.starts_with("mailto:") {
            continue;
        }
        let (file, heading) = link.split_once('#').unwrap_or((&link, ""));
        let target = if file.is_empty() { path.to_owned() } else { path.with_file_name("").join(file) };
        let is_there = target.exists();
        let has_heading = || {
            let text = std::fs::read_to_string(&target).unwrap_or_default();
            heading.is_empty() || anchors(&text).contains(heading)
        };
        if !is_there || !has_heading() {
            broken.push(format!("{}: {link}", path.display()));
        }
    }
    broken
}

#[test]
fn links_lead_to_files_and_headings() {
    let documents = documents();
    assert!(documents.len() > 5, "the documents were found");
    let broken: Vec<String> = documents.iter().flat_map(|(path, text)| broken(path, text)).collect();
    assert!(broken.is_empty(), "links that lead nowhere:\n{}", broken.join("\n"));
}

#[test]
fn broken_links_are_seen() {
    let readme = root().join("README.md");
    let seen = broken(&readme, "[a](no-such-file.md) and [b](README.md#no-such-heading) but [c](README.md), `[d](x)`");
    assert_eq!(seen.len(), 2, "{seen:?}");
    assert!(
        broken(&readme, "[there](ARCHITECTURE.md) [outside](https://example.org/x)\n```\n[code](nowhere)\n```\n")
            .is_empty()
    );
}

/// Code blocks without a language would be compiled as Rust where documents are tested.
#[test]
fn code_blocks_name_their_language() {
    let mut nameless = Vec::new();
    for (path, text) in documents() {
        let mut fenced = false;
        for (number, line) in text.lines().enumerate() {
            if let Some(language) = line.trim_start().strip_prefix("```") {
                if !fenced && language.trim().is_empty() {
                    nameless.push(format!("{}:{}", path.display(), number + 1));
                }
                fenced = !fenced;
            }
        }
    }
    assert!(nameless.is_empty(), "code blocks without a language:\n{}", nameless.join("\n"));
}

/// What a file must not hold: folders of somebody's machine, and keys. Assembled here so that this file passes.
fn forbidden() -> Vec<String> {
    let folders = ["root", "home", "work", "Users"].map(|folder| format!("/{folder}/"));
    let keys = [["-----BEGIN ", "PRIVATE KEY"], ["gh", "p_"], ["AK", "IA"], ["xox", "b-"]].map(|parts| parts.concat());
    folders.into_iter().chain(keys).collect()
}

fn told(text: &str) -> Vec<String> {
    let is_name = |c: char| c.is_alphanumeric() || matches!(c, '.' | '_' | '-' | '~' | '/' | '}' | '*');
    let starts_here = |at: usize| !text[..at].ends_with(is_name);
    forbidden().into_iter().filter(|word| text.match_indices(word.as_str()).any(|(at, _)| starts_here(at))).collect()
}

#[test]
fn no_file_tells_of_a_machine_or_holds_a_key() {
    let mut found = Vec::new();
    for path in files() {
        // What is no text, or was bundled from elsewhere, is left out.
        let is_bundle = path.ends_with("viewer.js") || path.ends_with("package-lock.json");
        let Ok(text) = std::fs::read_to_string(&path) else { continue };
        if !is_bundle {
            found.extend(told(&text).into_iter().map(|word| format!("{}: {word}", path.display())));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn machine_paths_and_keys_are_seen() {
    for word in forbidden() {
        assert_eq!(told(&format!("see {word}x")), std::slice::from_ref(&word), "{word}");
    }
    assert!(told("a relative path: docs/home/page, ../work/x").is_empty());
}
