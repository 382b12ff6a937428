//! The commands of the tutorial run as they stand there and say what it says.
#![cfg(unix)] // it is written for a shell

mod common;

use std::path::Path;
use std::process::Command;

use common::{Folder, testdata};
use homeo_core::io::read_mesh;

/// The blocks of a document in one language.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let mut blocks = Vec::new();
    let mut open: Option<String> = None;
    for line in text.lines() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(language)) => open = Some(format!("{language}\n")),
            (Some(block), None) => *block += &format!("{line}\n"),
            (_, Some(_)) => blocks.extend(open.take()),
            (None, None) => {}
        }
    }
    let of_language = |block: String| block.strip_prefix(&format!("{language}\n")).map(str::to_owned);
    blocks.into_iter().filter_map(of_language).collect()
}

#[test]
fn commands_run_and_say_what_is_written() {
    let tutorial = std::fs::read_to_string(testdata("../docs/tutorial.md")).unwrap();
    // What builds is left out: the program is here already.
    let is_run = |line: &&str| !line.starts_with("cargo ") && !line.starts_with("export ");
    let commands: Vec<String> = blocks(&tutorial, "sh")
        .iter()
        .map(|block| block.lines().filter(is_run).map(|line| format!("{line}\n")).collect())
        .collect();
    let script = commands.concat();
    for verb in ["info", "simplify", "verify", "eval", "transfer", "report"] {
        assert!(script.contains(&format!("homeo {verb} ")), "{verb} is in no command: {script}");
    }
    let folder = Folder::new().with_testdata();
    let program = Path::new(env!("CARGO_BIN_EXE_homeo")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    let run = Command::new("sh").args(["-e", "-c", &script]).env("PATH", path).current_dir(folder.path("")).output();
    let run = run.unwrap();
    let said = String::from_utf8(run.stdout).unwrap();
    assert!(run.status.success(), "{said}\n{}", String::from_utf8_lossy(&run.stderr));
    let shown: Vec<String> = blocks(&tutorial, "text").iter().flat_map(|t| t.lines()).map(str::to_owned).collect();
    assert!(shown.len() > 15, "the answers were found");
    let missing: Vec<&String> = shown.iter().filter(|line| !said.lines().any(|other| other == **line)).collect();
    assert!(missing.is_empty(), "{missing:#?} is not in\n{said}");
    let small = read_mesh(&folder.path("out/small.obj")).unwrap();
    assert_eq!((small.polygons.len(), small.material_libraries), (460, vec!["knot.mtl".to_owned()]));
    assert!(folder.text("out/small.html").contains("One-to-one and onto"));
    assert_eq!(read_mesh(&folder.path("out/back.vtu")).unwrap().polygons.len(), 2304);
}

/// `knot.ply` must stay the mesh of `knot.obj`.
#[test]
fn both_files_of_the_model_hold_the_same_mesh() {
    let [obj, ply] = ["knot.obj", "knot.ply"].map(|name| read_mesh(&testdata("meshes").join(name)).unwrap());
    assert_eq!((obj.positions, obj.polygons), (ply.positions, ply.polygons));
}
