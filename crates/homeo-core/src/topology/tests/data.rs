//! Agreement with the manifest of the development data, where it is at hand.

// Times are printed on request.
#![allow(clippy::print_stderr)]

use std::path::{Path, PathBuf};
use std::time::Instant;

use serde_json::Value;

use super::plain_readers::{PlainMesh, read};
use crate::mesh::{TetrahedronComplex, TriangleComplex};
use crate::topology::*;

/// The folder named by `HOMEO_DATA`, or the usual place beside the checkout.
pub fn folder() -> Option<PathBuf> {
    let usual = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("HOMEO_DATA").map_or(usual, PathBuf::from);
    folder.join("manifest.json").is_file().then_some(folder)
}

/// The entries of the manifest in a folder, with their files.
fn entries(folder: &Path, under: &str) -> Vec<(String, Value, PathBuf)> {
    let text = std::fs::read_to_string(folder.join("manifest.json")).unwrap();
    let manifest: Vec<Value> = serde_json::from_str(&text).unwrap();
    let named = manifest.into_iter().filter_map(|entry| {
        let file = entry["file"].as_str()?.to_owned();
        let path = folder.join(&file);
        file.starts_with(under).then_some((file, entry, path))
    });
    named.collect()
}

/// Differences between a manifest entry and what was found; keys that the entry lacks are skipped.
fn compare(file: &str, entry: &Value, found: &Value, pairs: &[(&str, &str)]) -> Vec<String> {
    let close = |a: &Value, b: &Value| match (a.as_f64(), b.as_f64()) {
        (Some(x), Some(y)) => (x - y).abs() <= 2e-3 * x.abs().max(1e-2),
        _ => a == b,
    };
    let mut differences = Vec::new();
    for &(key, pointer) in pairs {
        let expected = &entry[key];
        let actual = found.pointer(pointer).unwrap_or(&Value::Null);
        if !expected.is_null() && !close(expected, actual) {
            differences.push(format!("{file}: {key} should be {expected}, found {actual}"));
        }
    }
    differences
}

fn surface(mesh: &PlainMesh) -> SurfaceReport {
    let complex = TriangleComplex::from_indices(mesh.positions.len(), &mesh.triangles).unwrap();
    analyse_triangles(&mesh.positions, &complex, Options { intersections: Intersections::Find })
}

fn volume(mesh: &PlainMesh, is_abstract: bool) -> VolumeReport {
    let largest = mesh.tetrahedra.iter().flatten().max().map_or(0, |&v| v as usize + 1);
    let complex = TetrahedronComplex::from_indices(largest.max(mesh.positions.len()), &mesh.tetrahedra).unwrap();
    let positions = if is_abstract { &[][..] } else { &mesh.positions };
    analyse_tetrahedra(positions, &complex, Options { intersections: Intersections::Find })
}

const SURFACE: [(&str, &str); 14] = [
    ("vertices", "/vertices"),
    ("faces", "/faces"),
    ("genus", "/genus"),
    ("boundary_loops", "/boundary_loops"),
    ("components", "/components"),
    ("manifold", "/manifold"),
    ("closed", "/closed"),
    ("consistently_oriented", "/consistently_oriented"),
    ("self_intersecting_pairs", "/self_intersections"),
    ("zero_area_faces", "/geometry/flat_cells"),
    ("min_angle_deg", "/geometry/triangle_angles/min_degrees"),
    ("max_angle_deg", "/geometry/triangle_angles/max_degrees"),
    ("min_dihedral_deg", "/geometry/dihedral_angles/min_degrees"),
    ("orientable", "/orientable"),
];

#[test]
fn surfaces_agree_with_the_manifest() {
    let Some(folder) = folder() else { return };
    let mut differences = Vec::new();
    let mut count = 0;
    for (file, entry, path) in entries(&folder, "surfaces/").into_iter().filter(|(f, ..)| !f.contains("invalid")) {
        let mesh = read(&path).unwrap();
        let start = Instant::now();
        let report = surface(&mesh);
        if std::env::var_os("HOMEO_TIMES").is_some() {
            eprintln!("{file}: {} triangles, {:?}", report.faces, start.elapsed());
        }
        let found = serde_json::to_value(&report).unwrap();
        differences.extend(compare(&file, &entry, &found, &SURFACE));
        let errors = report.violations.iter().filter(|v| v.severity == Severity::Error);
        differences.extend(errors.map(|v| format!("{file}: {} {}", v.code, v.message)));
        count += 1;
    }
    assert!(differences.is_empty(), "{}", differences.join("\n"));
    assert!(count >= 72);
}

const VOLUME: [(&str, &str); 21] = [
    ("tets", "/cells"),
    ("components", "/components"),
    ("boundary_genus", "/boundary/genus"),
    ("boundary_components", "/boundary/components"),
    ("boundary_faces", "/boundary/faces"),
    ("interior_vertices", "/interior_vertices"),
    ("manifold", "/manifold"),
    ("boundary_self_intersections", "/boundary_self_intersections"),
    ("min_dihedral_deg", "/geometry/dihedral_angles/min_degrees"),
    ("max_dihedral_deg", "/geometry/dihedral_angles/max_degrees"),
    ("bad_vertex_links", "/bad_vertex_links"),
    ("positive_tets", "/geometry/positive_cells"),
    ("negative_tets", "/geometry/negative_cells"),
    ("flat_tets", "/geometry/flat_cells"),
    ("positive", "/geometry/positive_cells"),
    ("negative", "/geometry/negative_cells"),
    ("flat", "/geometry/flat_cells"),
    ("tets_with_4_boundary_vertices", "/cells_with_all_vertices_on_boundary"),
    ("interior_edges_between_boundary_vertices", "/interior_edges_between_boundary_vertices"),
    ("vertices", "/vertices"),
    ("ball_answer", "/ball/answer"),
];

#[test]
fn volumes_agree_with_the_manifest() {
    let Some(folder) = folder() else { return };
    let mut differences = Vec::new();
    let mut count = 0;
    for (file, mut entry, path) in entries(&folder, "volumes/") {
        let mesh = read(&path).unwrap();
        if let Some(ball) = entry["ball"].as_bool() {
            entry["ball_answer"] = Value::from(if ball { "yes" } else { "no" });
        }
        let start = Instant::now();
        let report = volume(&mesh, false);
        if std::env::var_os("HOMEO_TIMES").is_some() {
            let (ball, handles) = (&report.ball, &report.handle_body);
            eprintln!("{file}: {} cells, {:?}: ball {:?}: {}", report.cells, start.elapsed(), ball.answer, ball.reason);
            eprintln!(
                "    embedded {:?}; handle body {:?}: {}",
                report.embedded.answer, handles.answer, handles.reason
            );
            let start = Instant::now();
            let ball = volume(&mesh, true).ball;
            eprintln!("    without coordinates: {:?}: ball {:?}: {}", start.elapsed(), ball.answer, ball.reason);
        }
        let found = serde_json::to_value(&report).unwrap();
        differences.extend(compare(&file, &entry, &found, &VOLUME));
        count += 1;
    }
    assert!(differences.is_empty(), "{}", differences.join("\n"));
    assert!(count >= 56);
}
