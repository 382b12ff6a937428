//! `homeo info`: facts, violations, and files that cannot be read.

mod common;

use common::{CLOSED, Folder, cubes, quads};
use serde_json::Value;

fn info(name: &str, content: impl AsRef<[u8]>) -> Value {
    let folder = Folder::new();
    folder.write(name, content).homeo(&["info", name, "--json", "-q"]).expect(0).json()
}

fn codes(report: &Value) -> Vec<&str> {
    report["violations"].as_array().unwrap().iter().map(|v| v["code"].as_str().unwrap()).collect()
}

#[test]
fn a_ball_has_all_its_facts() {
    let folder = Folder::new().with_testdata();
    let report = folder.line("info testdata/meshes/spot.mesh --json").expect(0).json();
    assert_eq!(report["verb"], "info");
    assert_eq!(report["ok"], true);
    assert_eq!(report["input"]["vertices"], 966);
    assert_eq!(report["input"]["tetrahedra"], 3020);
    assert_eq!((&report["kind"], &report["ball"], &report["genus"]), (&"tetrahedra".into(), &true.into(), &0.into()));
    assert_eq!((&report["positive"], &report["negative"]), (&3020.into(), &0.into()));
    assert_eq!(codes(&report), [""; 0]);
    assert!(report["seconds"]["total"].as_f64().unwrap() > 0.0);
    assert!(report["seconds"]["read"].is_number() && report["seconds"]["check"].is_number());
}

#[test]
fn people_get_lines_and_nothing_else() {
    let folder = Folder::new().with_testdata();
    let run = folder.line("info testdata/meshes/face.obj -q").expect(0);
    assert!(run.stdout.contains("a disk") && run.stderr.is_empty());
    let run = folder.line("info testdata/meshes/face.obj").expect(0);
    assert!(run.stderr.contains("check"), "plain stage lines where there is no terminal");
}

#[test]
fn solid_with_a_handle_is_no_ball() {
    let ring: Vec<[usize; 3]> = (0..9).map(|i| [i % 3, i / 3, 0]).filter(|c| *c != [1, 1, 0]).collect();
    let report = info("ring.mesh", cubes(&ring));
    assert_eq!((&report["ball"], &report["handle_body"]), (&false.into(), &true.into()));
    assert_eq!(report["boundary"]["genera"], serde_json::json!([1]));
}

#[test]
fn faults_of_readable_files_are_violations() {
    let report = info("edge.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n");
    assert!(codes(&report).contains(&"non-manifold-edge"));
    assert_eq!(report["manifold"], false);
    let report = info("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    assert!(codes(&report).contains(&"degenerate-cell"));
    let report = info("quads.obj", quads(2));
    assert_eq!(codes(&report)[0], "polygon-not-triangle");
    assert_eq!(report["violations"][0]["elements"], serde_json::json!([0, 1, 2, 3]));
    let moebius = "OFF\n5 5 0\n0 0 0\n1 0 0\n2 1 0\n1 2 1\n0 1 1\n3 0 1 2\n3 1 2 3\n3 2 3 4\n3 3 4 0\n3 4 0 1\n";
    assert!(codes(&info("moebius.off", moebius)).contains(&"non-orientable"));
    assert!(codes(&info("closed.off", CLOSED)).is_empty());
}

#[test]
fn unreadable_files_are_refused_with_a_place() {
    let cases: [(&str, &[u8], &str); 9] = [
        ("nan.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n", "non-finite-coordinate"),
        ("cut.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n", "unexpected-end"),
        ("empty.obj", b"", "empty-file"),
        ("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "index-out-of-range"),
        ("zero.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "index-zero"),
        ("faces.off", b"OFF\n1 0 0\n0 0 0\n", "no-elements"),
        ("part.docx", b"x", "unknown-format"),
        ("broken.json", b"{\"source\": [[0,", "bad-syntax"),
        ("image.png", b"\x89PNG\r\n\x1a\n\0\0", "unexpected-end"),
    ];
    for (name, content, code) in cases {
        let folder = Folder::new();
        let run = folder.write(name, content).homeo(&["info", name, "--json"]).expect(3);
        let report = run.json();
        assert_eq!((&report["ok"], &report["error"]["code"]), (&false.into(), &code.into()), "{name}: {}", run.stdout);
        assert_eq!(report["input"]["path"], name);
        assert!(run.stderr.contains(name), "{}", run.stderr);
    }
    let missing = Folder::new().line("info nowhere.obj --json").expect(3).json();
    assert_eq!(missing["error"]["code"], "cannot-open");
}

#[test]
fn polygons_are_judged_exactly() {
    let square = "[[0, 0], [1, 0], [1, 1], [0, 1]]";
    let pair = |source: &str| format!("{{\"name\": \"p\", \"source\": {source}, \"target\": {square}}}");
    let report = info("pair.json", pair(square));
    assert_eq!((&report["kind"], &report["simple"]), (&"polygon-pair".into(), &true.into()));
    assert!(codes(&report).is_empty());
    assert_eq!(codes(&info("bowtie.json", pair("[[0, 0], [1, 1], [1, 0], [0, 1]]"))), ["not-simple"]);
    assert_eq!(codes(&info("count.json", pair("[[0, 0], [1, 0], [1, 1]]"))), ["counts-differ"]);
    assert_eq!(codes(&info("turn.json", pair("[[0, 1], [1, 1], [1, 0], [0, 0]]"))), ["clockwise"]);
    let rings = format!("{{\"outer\": {square}, \"inner\": [[0.2, 0.2], [0.4, 0.2], [0.3, 0.4]]}}");
    let annulus = format!("{{\"kind\": \"annulus\", \"source\": {rings}, \"target\": {rings}}}");
    let report = info("ring.json", annulus);
    assert_eq!(report["kind"], "annulus-pair");
    assert_eq!(report["polygons"].as_array().unwrap().len(), 4);
}

#[test]
fn other_kinds_have_their_counts() {
    let report = info("ball.json", "{\"vertices\": 4, \"facets\": [[0, 1, 2, 3]]}");
    assert_eq!(
        (&report["kind"], &report["ball"], &report["coordinates"]),
        (&"tetrahedra".into(), &true.into(), &0.into())
    );
    let gluing =
        "{\"triangulations\": [{\"tetrahedra\": 1, \"gluings\": [[0, 0, 0, [1, 0, 2, 3]], [0, 1, 0, [1, 0, 2, 3]]]}]}";
    let report = info("census.json", gluing);
    assert_eq!(
        (&report["kind"], &report["tetrahedra"], &report["free_faces"]),
        (&"gluing".into(), &1.into(), &2.into())
    );
    let png = [b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR".as_slice(), &[0, 0, 1, 0, 0, 0, 0, 9, 8, 2, 0, 0, 0]].concat();
    let report = info("image.png", png);
    assert_eq!((&report["width"], &report["height"]), (&256.into(), &9.into()));
}

/// The log was made before anything was read, and the mesh was gone.
#[test]
fn a_log_does_not_take_the_place_of_another_file() {
    let folder = Folder::new();
    folder.write("m.off", CLOSED);
    for line in [
        "info m.off --log m.off",
        "info m.off --log=./m.off",
        "bundle m.off -o b.json --log b.json",
        "info --log m.off m.off",
    ] {
        folder.line(line).expect(2);
        assert_eq!((folder.names(), folder.text("m.off")), (vec!["m.off".to_owned()], CLOSED.to_owned()), "{line}");
    }
    folder.line("info m.off --log l.txt").expect(0);
    assert!(folder.text("l.txt").contains("stage"));
}
