//! `homeo pl`: two files with one connectivity, and the exact weights.

mod common;

use std::collections::BTreeSet;

use common::{Folder, torus};
use homeo_core::io::{Element, MeshFile, Values, read_mesh};
use homeo_core::number::Rational;
use serde_json::Value;

fn mesh(folder: &Folder, name: &str) -> MeshFile {
    read_mesh(&folder.path(name)).unwrap()
}

fn triangles(mesh: &MeshFile) -> Vec<[u32; 3]> {
    mesh.polygons.iter().map(|corners| corners.try_into().unwrap()).collect()
}

fn parents(mesh: &MeshFile, name: &str) -> Vec<usize> {
    match &mesh.attribute(name, Element::Polygon).unwrap().values {
        Values::I64(values) => values.iter().map(|&t| t as usize).collect(),
        Values::F64(_) | Values::F32(_) | Values::Text(_) => panic!("{name} is a number of a triangle"),
    }
}

fn count(value: &Value) -> usize {
    value.as_u64().unwrap() as usize
}

/// Edges with one triangle; none may have more than two, or two that run along it alike.
fn boundary_edges(triangles: &[[u32; 3]]) -> usize {
    let sides: Vec<[u32; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let distinct: BTreeSet<[u32; 2]> = sides.iter().copied().collect();
    assert_eq!(distinct.len(), sides.len(), "two triangles run along an edge alike");
    distinct.iter().filter(|[a, b]| !distinct.contains(&[*b, *a])).count()
}

fn characteristic(triangles: &[[u32; 3]]) -> i64 {
    let vertices: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let edges: BTreeSet<[u32; 2]> =
        triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    vertices.len() as i64 - edges.len() as i64 + triangles.len() as i64
}

/// A row of the exact file: a triangle and three weights on either surface.
fn exact_rows(folder: &Folder, name: &str) -> Vec<[(usize, [Rational; 3]); 2]> {
    let text = folder.text(name);
    let (header, rows) = text.split_once('\n').unwrap();
    let columns = ["triangle", "a", "b", "c"];
    let wanted: Vec<String> =
        ["source", "section"].iter().flat_map(|side| columns.map(|column| format!("{side}_{column}"))).collect();
    assert_eq!(header, wanted.join(","));
    let parsed = rows.lines().map(|row| {
        let fields: Vec<&str> = row.split(',').collect();
        assert_eq!(fields.len(), 8, "{row}");
        [0, 4].map(|k| {
            let weights = [1, 2, 3].map(|i| fields[k + i].parse::<Rational>().unwrap());
            (fields[k].parse().unwrap(), weights)
        })
    });
    parsed.collect()
}

/// Each exact row gives the rounded position in the files, and the weights of each add up to exactly 1.
fn check_exact(rows: &[[(usize, [Rational; 3]); 2]], surfaces: [&MeshFile; 2], refined: [&MeshFile; 2]) {
    for (k, (surface, refined)) in surfaces.into_iter().zip(refined).enumerate() {
        assert_eq!(rows.len(), refined.positions.len());
        let cells = triangles(surface);
        for (row, position) in rows.iter().zip(&refined.positions) {
            let (triangle, weights) = &row[k];
            assert_eq!(weights.iter().cloned().sum::<Rational>(), Rational::ONE);
            assert!(weights.iter().all(|weight| *weight >= Rational::ZERO));
            let corners = cells[*triangle].map(|v| surface.positions[v as usize]);
            for axis in 0..3 {
                let term = |i: usize| &weights[i] * &Rational::from_f64(corners[i][axis]).unwrap();
                let exact: Rational = (0..3).map(term).sum();
                assert!((exact.to_f64() - position[axis]).abs() < 1e-9, "{row:?} {position:?}");
            }
        }
    }
}

#[test]
fn a_simplified_surface_and_its_source_get_one_connectivity() {
    let folder = Folder::new();
    folder.write("t.obj", torus(16, 8));
    folder.line("simplify t.obj --to 40% -o s.ply --map s.homeo -q").expect(0);
    let report = folder.line("pl s.homeo -o a.ply --image b.vtu --exact w.csv --json -q").expect(0).json();
    let (source, image) = (mesh(&folder, "a.ply"), mesh(&folder, "b.vtu"));
    assert_eq!(triangles(&source), triangles(&image));
    let quality = &report["quality"];
    assert_eq!(count(&quality["vertices"]), source.positions.len());
    assert_eq!(count(&quality["triangles"]), triangles(&source).len());
    assert_eq!((&report["target"], &report["certificate"]["holds"]), (&"section".into(), &true.into()));
    assert_eq!((boundary_edges(&triangles(&source)), characteristic(&triangles(&source))), (0, 0), "a torus");
    let (before, section) = (mesh(&folder, "t.obj"), mesh(&folder, "s.ply"));
    for (surface, refined, name) in [(&before, &source, "source_triangle"), (&section, &image, "section_triangle")] {
        let parents: BTreeSet<usize> = parents(refined, name).into_iter().collect();
        assert_eq!(parents, (0..triangles(surface).len()).collect(), "every triangle is covered");
        let points =
            |mesh: &MeshFile| -> BTreeSet<[u64; 3]> { mesh.positions.iter().map(|p| p.map(f64::to_bits)).collect() };
        assert!(points(surface).is_subset(&points(refined)), "every vertex occurs, bit for bit");
    }
    check_exact(&exact_rows(&folder, "w.csv"), [&before, &section], [&source, &image]);
    assert_eq!(folder.names(), ["a.ply", "b.vtu", "s.homeo", "s.ply", "t.obj", "w.csv"]);
}

#[test]
fn textured_and_open_surfaces_keep_their_shape() {
    let folder = Folder::new().with_testdata();
    for (name, is_closed) in [("knot.obj", true), ("face.obj", false)] {
        folder.line(&format!("simplify testdata/meshes/{name} --to 40% -o s.ply --map s.homeo -q")).expect(0);
        let report = folder.line("pl s.homeo -o a.ply --image b.ply --json -q").expect(0).json();
        let before = triangles(&mesh(&folder, &format!("testdata/meshes/{name}")));
        let after = triangles(&mesh(&folder, "a.ply"));
        assert_eq!(count(&report["quality"]["triangles"]), after.len());
        assert_eq!(characteristic(&after), characteristic(&before), "{name}");
        assert_eq!((boundary_edges(&after) == 0, boundary_edges(&before) == 0), (is_closed, is_closed), "{name}");
    }
}

#[test]
fn the_image_under_a_shell_is_its_middle_surface() {
    let folder = Folder::new();
    folder.write("t.obj", torus(12, 8));
    folder.line("shell t.obj --rounds 0 -o t.homeo -q").expect(0);
    let report = folder.line("pl t.homeo -o a.off --image b.obj --json -q").expect(0).json();
    assert_eq!((&report["target"], &report["exact"]), (&"middle".into(), &Value::Null));
    assert_eq!(report["quality"]["rounded_over"], serde_json::json!({"source": 0, "image": 0}));
    let (a, b) = (mesh(&folder, "a.off"), mesh(&folder, "b.obj"));
    assert_eq!((&a.positions, triangles(&a)), (&b.positions, triangles(&b)), "the first middle surface is the source");
    assert_eq!(count(&report["quality"]["triangles"]), 192);
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let folder = Folder::new();
    folder.write("t.obj", torus(16, 8));
    folder.line("remesh t.obj --edge 0.4 -o s.ply --map s.homeo -q").expect(0);
    for (threads, names) in [(1, ["a.ply", "b.ply", "c.csv"]), (2, ["d.ply", "e.ply", "f.csv"])] {
        let [a, b, c] = names;
        folder.line(&format!("pl s.homeo -o {a} --image {b} --exact {c} --threads {threads} -q")).expect(0);
    }
    for [one, other] in [["a.ply", "d.ply"], ["b.ply", "e.ply"], ["c.csv", "f.csv"]] {
        assert!(folder.read(one) == folder.read(other), "{one} and {other} differ");
    }
}

#[test]
fn what_cannot_be_done_leaves_nothing_behind() {
    let folder = Folder::new().with_testdata();
    folder.line("map testdata/meshes/face.obj --onto square -o m.homeo -q").expect(0);
    let foliation = folder.line("pl m.homeo -o a.ply --image b.ply --json").expect(3);
    assert_eq!(foliation.json()["error"]["code"], "wrong-kind");
    assert!(foliation.stderr.contains("homeo eval"), "{}", foliation.stderr);
    folder.write("t.obj", torus(12, 8));
    folder.line("shell t.obj -o t.homeo -q").expect(0);
    for wrong in ["-o a.ply --image a.ply", "-o a.stl --image b.ply", "-o a.ply", "-o t.homeo --image b.ply"] {
        folder.line(&format!("pl t.homeo {wrong}")).expect(2);
    }
    let late = folder.line("pl t.homeo -o a.ply --image b.ply --timeout 0.000001 --json").expect(4);
    assert_eq!(late.json()["error"]["code"], "timeout");
    let mut bytes = folder.read("t.homeo");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x55;
    folder.write("broken.homeo", bytes);
    let broken = folder.line("pl broken.homeo -o a.ply --image b.ply");
    assert!(matches!(broken.code, 3 | 5), "{} {}", broken.code, broken.stderr);
    assert_eq!(folder.names(), ["broken.homeo", "m.homeo", "t.homeo", "t.obj", "testdata"]);
}
