//! All meshes of the development data, held against its manifest, where that data is there.

use std::path::PathBuf;

use crate::io::read_mesh;

fn data_folder() -> Option<PathBuf> {
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let folder = here.ancestors().map(|folder| folder.join("shared/data")).find(|folder| folder.is_dir());
    folder.filter(|folder| folder.join("manifest.json").is_file())
}

/// The code that a deliberately broken file must give, if any.
fn expected_code(file: &str) -> Option<&'static str> {
    Some(match file.rsplit('/').next()? {
        "nan_coordinate.off" | "inf_coordinate.obj" => "non-finite-coordinate",
        "truncated.off" | "truncated_binary.stl" => "unexpected-end",
        "empty.obj" => "empty-file",
        "no_faces.off" => "no-elements",
        "index_out_of_range.obj" => "index-out-of-range",
        "negative_zero_index.obj" => "index-zero",
        _ => return None,
    })
}

#[test]
#[expect(clippy::print_stderr, reason = "says that the test did nothing")]
fn counts_agree_with_the_manifest() {
    let Some(folder) = data_folder() else {
        eprintln!("skipped: there is no folder shared/data next to a folder above this crate");
        return;
    };
    let manifest = std::fs::read(folder.join("manifest.json")).unwrap();
    let entries: Vec<serde_json::Value> = serde_json::from_slice(&manifest).unwrap();
    let mut checked = 0;
    for entry in &entries {
        let file = entry["file"].as_str().unwrap();
        let is_mesh = file.starts_with("surfaces/") || file.starts_with("volumes/");
        if !is_mesh || file.contains("polygon_") || !folder.join(file).is_file() {
            continue;
        }
        let result = read_mesh(&folder.join(file));
        if let Some(code) = expected_code(file) {
            assert_eq!(result.unwrap_err().code, code, "{file}");
            continue;
        }
        let mesh = result.unwrap_or_else(|error| panic!("{error}"));
        let counts = [("vertices", mesh.vertex_count), ("faces", mesh.polygons.len()), ("tets", mesh.tetrahedra.len())];
        for (name, count) in counts {
            let expected = entry[name].as_u64();
            assert!(
                expected.is_none_or(|expected| expected == count as u64),
                "{file}: {count} {name}, not {expected:?}"
            );
        }
        checked += 1;
    }
    assert!(checked > 100, "only {checked} files of the manifest were read");
}
