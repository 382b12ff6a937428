//! `--weld`: halves that touch in vertices of their own become one mesh, and what was done is told.

mod common;

use common::Folder;
use serde_json::json;

/// The surface of a cube as an OBJ of twelve triangles that share no vertex.
fn soup() -> String {
    const SIDES: [[usize; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut text = String::new();
    for [a, b, c, d] in SIDES {
        for corner in [a, b, c, a, c, d] {
            text.push_str(&format!("v {} {} {}\n", corner & 1, corner >> 1 & 1, corner >> 2));
        }
    }
    (0..12).for_each(|triangle| {
        text.push_str(&format!("f {} {} {}\n", 3 * triangle + 1, 3 * triangle + 2, 3 * triangle + 3))
    });
    text
}

/// Two tetrahedra on the two sides of a triangle, each with its own vertices.
const APART: &str = "MeshVersionFormatted 2\nDimension 3\nVertices\n8\n\
    0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n1 -0 0 2\n0 1 0 1\n-0 0 1 1\n1 1 1 1\n\
    Tetrahedra\n2\n1 2 3 4 0\n5 6 7 8 0\nEnd\n";

#[test]
fn a_soup_becomes_a_closed_surface() {
    let folder = Folder::new();
    folder.write("soup.obj", soup());
    let apart = folder.line("info soup.obj --json -q").expect(0).json();
    assert_eq!((&apart["components"], &apart["closed"]), (&12.into(), &false.into()));
    assert!(apart["input"].get("welded").is_none());
    let report = folder.line("info soup.obj --weld --json -q").expect(0).json();
    assert_eq!((&report["sphere"], &report["closed"], &report["vertices"]), (&true.into(), &true.into(), &8.into()));
    assert_eq!(report["violations"], json!([]));
    let welded = &report["input"]["welded"];
    assert_eq!((&welded["merged"], &welded["examples"][0]), (&28.into(), &json!([0, 3])));
    assert_eq!(report["input"]["vertices"], 8);
    let text = folder.line("info soup.obj --weld -q").expect(0).stdout;
    assert!(text.contains("note: 28 vertices were merged") && text.contains("a sphere"), "{text}");
}

#[test]
fn tetrahedra_apart_are_mapped_as_one_ball() {
    let folder = Folder::new();
    folder.write("apart.mesh", APART);
    let run = folder.line("map apart.mesh --onto ball -o m.homeo --json -q").expect(3);
    assert_eq!(run.json()["error"]["code"], "not-a-ball");
    assert!(run.stderr.contains("`--weld`"), "{}", run.stderr);
    assert_eq!(folder.names(), ["apart.mesh"]);

    let report = folder.line("map apart.mesh --onto ball --weld -o m.homeo --vtu m.vtk --json -q").expect(0).json();
    assert_eq!((&report["certificate"]["holds"], &report["input"]["vertices"]), (&true.into(), &5.into()));
    let welded = &report["input"]["welded"];
    assert_eq!((&welded["merged"], &welded["examples"]), (&3.into(), &json!([[1, 4], [2, 5], [3, 6]])));
    assert_eq!(welded["differing_attributes"], json!([{"name": "tag", "vertices": 1, "first": [1, 4]}]));
    let changes = report["input"]["changes"].as_array().unwrap();
    assert!(changes[0].as_str().unwrap().contains("3 vertices") && changes[1].as_str().unwrap().contains("\"tag\""));
    assert_eq!(folder.line("info m.vtk --json -q").expect(0).json()["ball"], true);

    let report = folder.line("verify m.homeo --source apart.mesh --weld --json -q").expect(0).json();
    assert_eq!((&report["source"]["same"], &report["source"]["welded"]["merged"]), (&true.into(), &3.into()));
    let run = folder.line("verify m.homeo --source apart.mesh --weld").expect(0);
    assert!(run.stderr.contains("3 vertices were merged"), "{}", run.stderr);
    assert!(run.stdout.contains("the mesh of apart.mesh, after --weld\n"), "{}", run.stdout);
    let report = folder.line("verify m.homeo --source apart.mesh --json -q").expect(3).json();
    assert_eq!((&report["error"]["code"], &report["source"]["same"]), (&"other-source".into(), &false.into()));
    folder.line("verify m.homeo --weld").expect(2);
}

#[test]
fn elements_that_collapse_are_told_and_refused() {
    let folder = Folder::new();
    folder.write("thin.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nf 1 2 3\nf 3 2 4\n");
    let run = folder.line("map thin.obj --onto square --weld --json").expect(3);
    let report = run.json();
    assert_eq!(report["error"]["code"], "repeated-vertex");
    assert_eq!(report["input"]["welded"]["collapsed_polygons"], json!({"count": 1, "elements": [1]}));
    assert!(run.stderr.contains("1 polygon names a vertex twice (1)"), "{}", run.stderr);
}

#[test]
fn meshes_without_such_vertices_stay_as_they_are() {
    let folder = Folder::new().with_testdata();
    folder.line("map testdata/meshes/face.obj --onto disk --weld -o f.homeo -q").expect(0);
    folder.line("verify f.homeo --source testdata/meshes/face.obj -q").expect(0);
    let report = folder.line("info testdata/meshes/spot.mesh --weld --json -q").expect(0).json();
    assert_eq!(report["input"]["welded"]["merged"], 0);
}
