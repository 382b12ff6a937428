//! Every example in `--help` runs.

mod common;

use common::Folder;

/// As `homeo --help` lists them.
const VERBS: [&str; 16] = [
    "info",
    "map",
    "shell",
    "simplify",
    "remesh",
    "transfer",
    "pl",
    "warp",
    "morph",
    "blend",
    "hyperbolic",
    "bundle",
    "eval",
    "compose",
    "verify",
    "report",
];

#[test]
fn examples_run_as_printed() {
    for verb in [""].iter().chain(&VERBS) {
        let folder = Folder::new().with_testdata();
        let help = folder.line(&format!("{verb} --help")).expect(0).stdout;
        let examples: Vec<&str> = help
            .lines()
            .filter_map(|line| line.strip_prefix("  homeo "))
            .filter(|line| !line.starts_with('['))
            .collect();
        assert!(!examples.is_empty(), "`homeo {verb} --help` shows no example");
        for example in examples {
            folder.line(example).expect(0);
        }
    }
}

#[test]
fn verbs_are_those_that_exist() {
    let help = Folder::new().line("--help").expect(0).stdout;
    for verb in VERBS {
        assert!(help.contains(&format!("\n  {verb} ")), "{verb}");
    }
    assert!(!help.contains("polycube"), "`polycube` does not exist yet");
    assert!(Folder::new().line("--version").expect(0).stdout.starts_with("homeo "));
}
