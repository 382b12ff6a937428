//! `homeo simplify`, `homeo remesh`, `homeo transfer`: what they make, carry along, refuse and leave alone.

mod common;

use std::collections::{BTreeSet, HashMap};

use common::{CLOSED, Folder, cubes, quads, rationals, torus, vertices};
use homeo_core::io::{Attribute, Element, MeshFile, Values, WriteOptions, read_mesh, write_mesh};
use homeo_core::number::Rational;
use serde_json::Value;

const N: usize = 16;
const M: usize = 8;

/// Of totals.
const ROUNDING: f64 = 1e-12;

/// The torus, its texture cut along both loops: a grid on the unit square.
fn textured() -> String {
    let plain = torus(N, M);
    let (points, faces) = plain.split_at(plain.find("f ").unwrap());
    let mut text = points.to_owned();
    for (i, j) in (0..=N).flat_map(|i| (0..=M).map(move |j| (i, j))) {
        text += &format!("vt {} {}\n", i as f64 / N as f64, j as f64 / M as f64);
    }
    for (quad, pair) in faces.lines().collect::<Vec<_>>().chunks(2).enumerate() {
        let (i, j) = (quad / M, quad % M);
        let place = |i: usize, j: usize| i * (M + 1) + j + 1;
        let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
        for (face, places) in pair.iter().zip([[a, b, c], [a, c, d]]) {
            let corners = face.split(' ').skip(1).zip(places).map(|(v, vt)| format!(" {v}/{vt}"));
            text += &format!("f{}\n", corners.collect::<String>());
        }
    }
    text
}

/// The torus as a mesh, with attributes.
fn with_attributes(folder: &Folder, name: &str, attributes: Vec<Attribute>) {
    folder.write("plain.obj", torus(N, M));
    let mesh = MeshFile { attributes, ..read_mesh(&folder.path("plain.obj")).unwrap() };
    write_mesh(&folder.path(name), &mesh, &WriteOptions::default()).unwrap();
    std::fs::remove_file(folder.path("plain.obj")).unwrap();
}

fn attribute(name: &str, element: Element, values: Values) -> Attribute {
    Attribute { name: name.to_owned(), element, components: 1, values }
}

fn mesh(folder: &Folder, name: &str) -> MeshFile {
    read_mesh(&folder.path(name)).unwrap()
}

/// The vertices as they are stored: decimals would be near them only.
fn exact_vertices(mesh: &MeshFile) -> String {
    let row = |p: &[f64; 3]| p.map(|x| Rational::from_f64(x).unwrap().to_string()).join(",") + "\n";
    "x,y,z\n".to_owned() + &mesh.positions.iter().map(row).collect::<String>()
}

fn numbers(mesh: &MeshFile, name: &str, element: Element) -> Vec<f64> {
    match &mesh.attribute(name, element).unwrap_or_else(|| panic!("no {name} in {:?}", mesh.attributes)).values {
        Values::F64(values) => values.clone(),
        Values::F32(values) => values.iter().map(|&x| x.into()).collect(),
        Values::I64(values) => values.iter().map(|&x| x as f64).collect(),
        Values::Text(_) => panic!("{name} is a text"),
    }
}

fn areas(mesh: &MeshFile) -> Vec<f64> {
    let area = |corners: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[corners[k] as usize]);
        let [p, q] = [b, c].map(|end| [0, 1, 2].map(|k| end[k] - a[k]));
        let cross = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        cross.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
    };
    mesh.polygons.iter().map(area).collect()
}

/// Edges that belong to one triangle, by their ends' coordinates.
fn boundary(mesh: &MeshFile) -> BTreeSet<[String; 2]> {
    let sides = || mesh.polygons.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
    let directed: BTreeSet<(u32, u32)> = sides().collect();
    let alone = sides().filter(|&(a, b)| !directed.contains(&(b, a)));
    alone.map(|(a, b)| [a, b].map(|v| format!("{:?}", mesh.positions[v as usize]))).collect()
}

fn count(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is no count"))
}

fn moved<'v>(report: &'v Value, name: &str) -> &'v Value {
    let all = report["transfer"].as_array().unwrap();
    all.iter().find(|moved| moved["name"] == name).unwrap_or_else(|| panic!("no {name} in {all:?}"))
}

fn total(moved: &Value) -> u64 {
    ["copied", "interpolated", "largest", "split", "missing"].iter().map(|status| count(&moved[status])).sum()
}

#[test]
fn simplify_ends_where_it_is_told() {
    let folder = Folder::new();
    folder.write("t.obj", torus(N, M));
    for (options, most, least) in [("--to 40%", 102, 90), ("--to 150", 150, 140), ("--error 0.02", 255, 20)] {
        let report =
            folder.line(&format!("simplify t.obj {options} -o s.obj --map s.homeo --json -q")).expect(0).json();
        let quality = &report["quality"];
        let triangles = count(&quality["triangles"]);
        assert!((least..=most).contains(&triangles), "{options}: {triangles}");
        assert_eq!(mesh(&folder, "s.obj").polygons.len() as u64, triangles);
        assert_eq!((&report["certificate"]["holds"], &report["certificate"]["kind"]), (&true.into(), &"shell".into()));
        assert_eq!((&report["certificate"]["target"], &report["transfer"]), (&"section".into(), &Value::Array(vec![])));
        let reached = if options.starts_with("--to") { true.into() } else { Value::Null };
        assert_eq!((&quality["reached"], &quality["first_triangles"]), (&reached, &256.into()));
        assert!(quality["largest_error"].as_f64().unwrap() <= if options == "--error 0.02" { 0.02 } else { 1.0 });
        let info = folder.line("info s.obj --intersections --json -q").expect(0).json();
        assert_eq!((&info["closed"], &info["genus"]), (&true.into(), &1.into()));
        assert_eq!((&info["consistently_oriented"], &info["self_intersections"]), (&true.into(), &0.into()));
        let verified = folder.line("verify s.homeo --source t.obj --json -q").expect(0).json();
        assert_eq!(verified["certificate"], report["certificate"]);
    }
    let few = folder.line("simplify t.obj --to 4 -o s.obj --json").expect(0);
    assert_eq!(few.json()["quality"]["reached"], false);
    let few = folder.line("simplify t.obj --to 4 -o s.obj -q").expect(0);
    assert!(few.stdout.contains("one-to-one and onto, proved") && few.stdout.contains("no edge is left"));
    let none = folder.line("simplify t.obj --to 4 --timeout 0.000001 -o no.obj --json").expect(4);
    assert_eq!(none.json()["error"]["code"], "timeout");
    assert_eq!(folder.names(), ["s.homeo", "s.obj", "t.obj"]);
}

#[test]
fn a_second_shell_is_tried_where_the_first_falls_short() {
    let folder = Folder::new();
    folder.write("t.obj", torus(N, M));
    // The angle and the thickness that are given are those of the one shell there is.
    for (options, tried) in [
        ("--to 4", vec![89.95, 60.0]),
        ("--to 40%", vec![89.95]),
        ("--to 4 --largest-angle 60", vec![60.0]),
        ("--to 4 --thickness 0.1", vec![89.95]),
        ("--error 0.02", vec![89.95]),
    ] {
        let report = folder.line(&format!("simplify t.obj {options} -o s.obj --json -q")).expect(0).json();
        let quality = &report["quality"];
        let shells = quality["shells"].as_array().unwrap();
        let angles: Vec<f64> = shells.iter().map(|shell| shell["largest_angle"].as_f64().unwrap()).collect();
        assert_eq!(angles, tried, "{options}");
        let counts: Vec<u64> = shells.iter().map(|shell| count(&shell["triangles"])).collect();
        let kept = counts.iter().position(|triangles| Some(triangles) == counts.iter().min()).unwrap();
        assert_eq!((count(&quality["shell"]), count(&quality["triangles"])), (kept as u64, counts[kept]), "{options}");
        assert_eq!(quality["prisms"], shells[kept]["prisms"], "{options}");
        assert_eq!(mesh(&folder, "s.obj").polygons.len() as u64, counts[kept]);
    }
    let text = folder.line("simplify t.obj --to 4 -o s.obj -q").expect(0).stdout;
    assert_eq!((text.matches("shell kept").count(), text.matches("shell tried").count()), (1, 1), "{text}");
    let text = folder.line("simplify t.obj --to 40% -o s.obj -q").expect(0).stdout;
    assert!(!text.contains("shell kept"), "{text}");
    folder.line("simplify t.obj --to 4 --largest-angle 91 -o no.obj").expect(2);
}

#[test]
fn remesh_makes_edges_even() {
    let folder = Folder::new();
    folder.write("t.obj", torus(N, M));
    for (options, wanted) in [("--edge 0.3", Some(0.3)), ("--iterations 2", None)] {
        let report = folder.line(&format!("remesh t.obj {options} -o s.ply --map s.homeo --json -q")).expect(0).json();
        let quality = &report["quality"];
        let [wanted_here, mean] = ["edge_length", "mean_edge_length"].map(|name| quality[name].as_f64().unwrap());
        assert!(wanted.is_none_or(|wanted| wanted == wanted_here));
        assert!((mean / wanted_here - 1.0).abs() < 0.25, "{mean} instead of {wanted_here}");
        assert_eq!(mesh(&folder, "s.ply").polygons.len() as u64, count(&quality["triangles"]));
        let info = folder.line("info s.ply --intersections --json -q").expect(0).json();
        assert_eq!((&info["genus"], &info["self_intersections"]), (&1.into(), &0.into()));
        folder.line("verify s.homeo --source t.obj -q").expect(0);
    }
}

#[test]
fn edges_are_as_long_as_a_field_says() {
    let folder = Folder::new();
    folder.write("t.obj", torus(N, M));
    // Short edges where x is positive.
    let length = |p: &[f64; 3]| if p[0] > 0.0 { 0.12 } else { 0.4 };
    let wanted = mesh(&folder, "t.obj").positions.iter().map(length).collect();
    with_attributes(&folder, "t.ply", vec![attribute("wanted", Element::Vertex, Values::F64(wanted))]);
    folder.line("remesh t.ply --sizing wanted -o s.ply -q").expect(0);
    let remeshed = mesh(&folder, "s.ply");
    let right = remeshed.positions.iter().filter(|p| p[0] > 0.0).count();
    assert!(right > 4 * (remeshed.positions.len() - right), "{right} of {}", remeshed.positions.len());
    let refused = folder.line("remesh t.obj --sizing wanted -o no.ply --json -q").expect(3).json();
    assert_eq!(refused["error"]["code"], "no-sizing");
    with_attributes(&folder, "zero.ply", vec![attribute("wanted", Element::Vertex, Values::F64(vec![0.0; N * M]))]);
    let refused = folder.line("remesh zero.ply --sizing wanted -o no.ply --json -q").expect(3).json();
    assert_eq!(refused["elements"], serde_json::json!([0]));
    // The torus bends more round its tube than along it: a chord of edges of 0.5 would leave it by more than this.
    let counted = |line: &str| folder.line(line).expect(0).json()["quality"]["triangles"].as_u64().unwrap();
    let even = counted("remesh t.obj --edge 0.5 -o even.ply --json -q");
    assert!(counted("remesh t.obj --edge 0.5 --adaptive 0.01 -o bent.ply --json -q") > 2 * even);
}

#[test]
fn wrong_usage_is_told_apart() {
    let folder = Folder::new();
    folder.write("t.obj", torus(N, M));
    for line in [
        "simplify t.obj -o s.obj",
        "simplify t.obj --to 40%",
        "simplify t.obj --to 101% -o s.obj",
        "simplify t.obj --to some -o s.obj",
        "simplify t.obj --error 0 -o s.obj",
        "simplify t.obj --error nan -o s.obj",
        "simplify t.obj --to 40% -o s",
        "simplify t.obj --to 40% -o s.json",
        "simplify t.obj --to 40% -o t.obj",
        "simplify t.obj --to 40% -o s.obj --map s.obj",
        "simplify t.obj --to 40% -o s.obj --map t.obj",
        "simplify t.obj --to 40% -o nowhere/s.obj",
        "simplify t.obj --to 40% --features 200 -o s.obj",
        "remesh t.obj --edge 0 -o s.obj",
        "remesh t.obj --iterations 0 -o s.obj",
        "remesh t.obj --adaptive 0 -o s.obj",
        "remesh t.obj --sizing s --edge 1 -o s.obj",
        "transfer t.homeo -o s.obj",
        "transfer t.homeo --from t.obj",
        "transfer t.homeo --from t.obj --onto t.obj --inverse -o s.obj",
        "transfer t.homeo --from t.obj -o t.obj",
    ] {
        let run = folder.line(line).expect(2);
        assert!(!run.stderr.is_empty(), "{line}");
    }
    assert_eq!(folder.names(), ["t.obj"]);
}

#[test]
fn unfit_meshes_are_refused_and_outputs_left_alone() {
    let crossing: String = [0.0, 0.25]
        .iter()
        .enumerate()
        .map(|(i, x)| {
            let points = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
            let points = points.map(|p: [f64; 3]| format!("v {} {} {}\n", p[0] + x, p[1] + x / 2., p[2] + x / 2.));
            let faces = [[1, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]];
            points.concat() + &faces.map(|f| format!("f {} {} {}\n", f[0] + 4 * i, f[1] + 4 * i, f[2] + 4 * i)).concat()
        })
        .collect();
    let cases: [(&str, &str, &str); 6] = [
        ("solid.mesh", &cubes(&[[0, 0, 0]]), "wrong-dimension"),
        ("quads.obj", &quads(2), "polygon-not-triangle"),
        ("crossing.obj", &crossing, "self-intersection"),
        ("flipped.off", &CLOSED.replace("3 0 2 1", "3 0 1 2"), "inconsistent-orientation"),
        ("empty.off", "OFF\n0 0 0\n", "no-elements"),
        ("cut.off", "OFF\n4 4 0\n0 0 0\n1 0", "unexpected-end"),
    ];
    for (name, content, code) in cases {
        for verb in ["simplify", "remesh"] {
            let folder = Folder::new();
            folder.write(name, content).write("s.obj", "old").write("s.homeo", "old map");
            let to = if verb == "simplify" { "--to 50%" } else { "--edge 1" };
            let run = folder.line(&format!("{verb} {name} {to} -o s.obj --map s.homeo --json -q")).expect(3);
            assert_eq!(run.json()["error"]["code"], code, "{verb} {name}");
            assert_eq!((folder.text("s.obj"), folder.text("s.homeo")), ("old".into(), "old map".into()));
            assert_eq!(folder.names().len(), 3, "{:?}", folder.names());
        }
    }
    let folder = Folder::new();
    folder.write("t.obj", torus(N, M)).write("s.obj", "old").write("s.homeo", "old map");
    let run = folder.line("simplify t.obj --to 50% --density mass -o s.obj --map s.homeo --json -q").expect(3);
    assert_eq!(run.json()["error"]["code"], "no-density");
    assert_eq!((folder.text("s.obj"), folder.text("s.homeo")), ("old".into(), "old map".into()));
    assert_eq!(folder.names().len(), 3, "{:?}", folder.names());
    folder.write("flipped.off", CLOSED.replace("3 0 2 1", "3 0 1 2"));
    folder.line("simplify flipped.off --orient --to 50% -o s.obj -q").expect(0);
    assert_ne!(folder.text("s.obj"), "old", "what is there already is replaced when all is well");
}

#[test]
fn points_go_there_and_back_exactly() {
    let folder = Folder::new();
    let points = vertices(&torus(N, M));
    folder.write("t.obj", torus(N, M)).write("p.csv", &points);
    folder.line("simplify t.obj --to 40% -o s.obj --map s.homeo -q").expect(0);
    let there_and_back = |points: &str, there: &str, back: &str| {
        folder.write("p.csv", points);
        folder.line(&format!("eval s.homeo --points p.csv --exact {there} -o images.csv -q")).expect(0);
        folder.line(&format!("eval s.homeo --points images.csv --exact {back} -o back.csv -q")).expect(0);
        assert_eq!(rationals(&folder.text("back.csv")), rationals(points), "{there}, then {back}");
        assert_ne!(rationals(&folder.text("images.csv")), rationals(points));
    };
    there_and_back(&points, "", "--inverse");
    there_and_back(&exact_vertices(&mesh(&folder, "s.obj")), "--inverse", "");
    folder.write("p.csv", &points).line("eval s.homeo --points p.csv -o near.csv -q").expect(0);
    let report = folder.line("report s.homeo -o s.html --json -q").expect(0).json();
    assert_eq!(report["certificate"]["holds"], true);
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let folder = Folder::new();
    folder.write("t.obj", textured());
    for (verb, options) in [("simplify", "--to 40%"), ("remesh", "--edge 0.5 --iterations 2")] {
        for threads in ["1", "2"] {
            let outputs = format!("-o {threads}.obj --map {threads}.homeo");
            folder.line(&format!("{verb} t.obj {options} {outputs} --threads {threads} -q")).expect(0);
        }
        assert_eq!(folder.text("1.obj"), folder.text("2.obj"), "{verb}");
        assert!(folder.read("1.homeo") == folder.read("2.homeo"), "{verb}: the maps differ");
    }
}

#[test]
fn an_open_surface_keeps_its_boundary() {
    let folder = Folder::new();
    folder.write("open.obj", torus(N, M).replacen("f 1 9 10\n", "", 1));
    for line in ["simplify open.obj --to 40%", "remesh open.obj --edge 0.5 --iterations 2"] {
        folder.line(&format!("{line} -o s.obj --map s.homeo -q")).expect(0);
        let (first, last) = (mesh(&folder, "open.obj"), mesh(&folder, "s.obj"));
        assert_eq!(boundary(&first).len(), 3);
        assert_eq!(boundary(&last), boundary(&first), "{line}");
        folder.line("verify s.homeo --source open.obj -q").expect(0);
    }
}

#[test]
fn textures_keep_their_seams_and_turn_nothing_over() {
    let folder = Folder::new();
    folder.write("t.obj", textured());
    for line in ["simplify t.obj --to 40%", "remesh t.obj --edge 0.5"] {
        let report = folder.line(&format!("{line} -o s.obj --json -q")).expect(0).json();
        let triangles = report["quality"]["triangles"].clone();
        let flips = &report["quality"]["texture"];
        assert_eq!(flips["before"], serde_json::json!({"counter_clockwise": 256, "clockwise": 0, "flat": 0}));
        assert_eq!(flips["after"], serde_json::json!({"counter_clockwise": triangles, "clockwise": 0, "flat": 0}));
        assert_eq!(total(moved(&report, "texture")), 3 * count(&triangles));
        let mesh = mesh(&folder, "s.obj");
        let rows: Vec<[f64; 2]> =
            numbers(&mesh, "texture", Element::Corner).chunks(2).map(|row| [row[0], row[1]]).collect();
        let doubled = |[a, b, c]: [[f64; 2]; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let area: f64 = rows.chunks(3).map(|t| doubled([t[0], t[1], t[2]]) / 2.0).sum();
        assert!((area - 1.0).abs() < 1e-12, "{line}: the chart still covers the square: {area}");
        // Across an edge coordinates are the same, or differ by one turn along a loop.
        let mut sides = HashMap::new();
        for (t, corners) in mesh.polygons.iter().enumerate() {
            (0..3).for_each(|k| {
                let l = (k + 1) % 3;
                sides.insert((corners[k], corners[l]), [rows[3 * t + k], rows[3 * t + l]]);
            });
        }
        let mut seams = 0;
        for (&(a, b), ends) in &sides {
            let [q, p] = sides[&(b, a)];
            for (here, there) in ends.iter().zip([p, q]) {
                let turns = [here[0] - there[0], here[1] - there[1]];
                assert!(turns.iter().all(|turn| (turn - turn.round()).abs() < 1e-12), "{line}: {turns:?}");
            }
            seams += usize::from(*ends != [p, q]);
        }
        assert!((2 * 3..2 * (N + M + 20)).contains(&seams), "{line}: {seams} sides of seams");
    }
}

#[test]
fn a_texture_that_cannot_be_kept_is_said_so() {
    let folder = Folder::new();
    let whole = textured();
    let bare: String = whole
        .lines()
        .map(|line| if line == "f 1/1 9/10 10/11" { "f 1 9 10\n".into() } else { format!("{line}\n") })
        .collect();
    assert_ne!(bare, whole);
    folder.write("whole.obj", whole).write("bare.obj", bare);
    let run = folder.line("simplify bare.obj --to 90% -o s.obj --json").expect(0);
    assert!(run.stderr.contains("its seams are not kept"), "{}", run.stderr);
    assert_eq!((total(moved(&run.json(), "texture")) % 3, &run.json()["quality"]["texture"]), (0, &Value::Null));
    let run = folder.line("simplify whole.obj --to 2 -o s.obj").expect(0);
    assert!(!run.stderr.contains("its seams are not kept"), "{}", run.stderr);
    assert!(run.stdout.contains("by the texture"), "why it ended is said: {}", run.stdout);
}

#[test]
fn fields_and_labels_come_through_ply() {
    let folder = Folder::new();
    let first = torus(N, M);
    let heights: Vec<f64> =
        vertices(&first).lines().skip(1).map(|row| row.rsplit(',').next().unwrap().parse().unwrap()).collect();
    let parts: Vec<i64> = (0..2 * N * M).map(|t| if t < N * M { 3 } else { 7 }).collect();
    let fields = vec![
        attribute("height", Element::Vertex, Values::F64(heights.clone())),
        attribute("single", Element::Vertex, Values::F32(heights.iter().map(|_| 2.5).collect())),
        attribute("part", Element::Polygon, Values::I64(parts)),
    ];
    with_attributes(&folder, "t.ply", fields);
    let report = folder.line("simplify t.ply --to 40% -o s.ply --json -q").expect(0).json();
    let mesh = mesh(&folder, "s.ply");
    let range = |values: &[f64]| values.iter().fold([f64::MAX, f64::MIN], |[l, h], &x| [l.min(x), h.max(x)]);
    let [low, high] = range(&heights);
    let [new_low, new_high] = range(&numbers(&mesh, "height", Element::Vertex));
    assert!(new_low >= low && new_high <= high && new_high - new_low > 0.8 * (high - low), "{new_low} to {new_high}");
    assert!(matches!(mesh.attribute("single", Element::Vertex).unwrap().values, Values::F32(_)));
    assert!(numbers(&mesh, "single", Element::Vertex).iter().all(|x| (x - 2.5).abs() < 1e-6));
    let part = numbers(&mesh, "part", Element::Polygon);
    assert!(part.iter().all(|part| [3.0, 7.0].contains(part)), "{part:?}");
    assert!([3.0, 7.0].iter().all(|label| part.iter().filter(|part| *part == label).count() > part.len() / 4));
    let (part, height) = (moved(&report, "part"), moved(&report, "height"));
    assert_eq!((&part["element"], &height["element"]), (&"polygons".into(), &"vertices".into()));
    assert_eq!((total(part), total(height)), (mesh.polygons.len() as u64, mesh.vertex_count as u64));
    assert_eq!((&part["interpolated"], &part["missing"]), (&0.into(), &0.into()));
    assert!(count(&part["copied"]) > 0 && count(&part["largest"]) > 0);
}

#[test]
fn masses_are_conserved_and_every_value_has_a_status() {
    let folder = Folder::new();
    let loads: Vec<f64> = (0..2 * N * M).map(|t| 1.0 + (t * t % 17) as f64).collect();
    let fields = ["load", "mean"].map(|name| attribute(name, Element::Polygon, Values::F64(loads.clone())));
    with_attributes(&folder, "t.vtu", fields.to_vec());
    let mass = |mesh: &MeshFile, loads: &[f64]| areas(mesh).iter().zip(loads).map(|(a, load)| a * load).sum::<f64>();
    let first = mass(&mesh(&folder, "t.vtu"), &loads);
    let line = "simplify t.vtu --to 40% --density load --status -o s.vtu --map s.homeo --json -q";
    let report = folder.line(line).expect(0).json();
    let small = mesh(&folder, "s.vtu");
    let last = mass(&small, &numbers(&small, "load", Element::Polygon));
    assert!((last / first - 1.0).abs() < ROUNDING, "{last} instead of {first}");
    let means = numbers(&small, "mean", Element::Polygon);
    assert!(means.iter().all(|mean| (1.0..=17.0).contains(mean)));
    assert!(
        (mass(&small, &means) / first - 1.0).abs() > 100.0 * ROUNDING,
        "the area changes, so averages keep no total"
    );
    for name in ["load", "mean"] {
        let status = numbers(&small, &format!("{name}_status"), Element::Polygon);
        for (number, word) in ["copied", "interpolated", "largest", "split", "missing"].iter().enumerate() {
            let here = status.iter().filter(|&&status| status == number as f64).count() as u64;
            assert_eq!(here, count(&moved(&report, name)[word]), "{name}: {word}");
        }
    }
    // Back again, and nothing is lost on the way.
    let back = "transfer s.homeo --from s.vtu --inverse --density load -o back.vtu --json -q";
    folder.line(back).expect(0);
    let back = mesh(&folder, "back.vtu");
    assert_eq!(back.polygons, mesh(&folder, "t.vtu").polygons);
    assert_eq!(back.positions, mesh(&folder, "t.vtu").positions);
    let again = mass(&back, &numbers(&back, "load", Element::Polygon));
    assert!((again / first - 1.0).abs() < ROUNDING, "{again} instead of {first}");
    for density in ["nothing", "load_status"] {
        let line = format!("transfer s.homeo --from s.vtu --inverse --density {density} -o no.vtu --json -q");
        assert_eq!(folder.line(&line).expect(3).json()["error"]["code"], "no-density", "{density}");
    }
    assert_eq!(folder.names(), ["back.vtu", "s.homeo", "s.vtu", "t.vtu"]);
}

#[test]
fn a_format_that_rounds_is_said_so() {
    let folder = Folder::new();
    folder.write("t.obj", torus(N, M));
    let run = folder.line("simplify t.obj --to 40% -o s.stl --map s.homeo --json").expect(0);
    assert!(run.stderr.contains("the certificate is about the surface in the map file only"), "{}", run.stderr);
    let losses = run.json()["losses"].to_string();
    assert!(losses.contains("map file only"), "{losses}");
    folder.line("verify s.homeo --source t.obj -q").expect(0);
    let exact = folder.line("simplify t.obj --to 40% -o s.off --json").expect(0);
    assert_eq!((&exact.json()["losses"], exact.stderr.contains("map file only")), (&Value::Array(vec![]), false));
}

#[test]
fn attributes_move_both_ways_along_a_map() {
    let folder = Folder::new();
    folder.write("t.obj", textured());
    folder.line("simplify t.obj --to 40% -o s.obj --map s.homeo -q").expect(0);
    let there = folder.line("transfer s.homeo --from t.obj -o there.obj --json -q").expect(0).json();
    assert_eq!(there["certificate"]["holds"], true);
    let (made, moved_there) = (mesh(&folder, "s.obj"), mesh(&folder, "there.obj"));
    assert_eq!((&made.positions, &made.polygons), (&moved_there.positions, &moved_there.polygons));
    let corners = 3 * made.polygons.len() as u64;
    assert_eq!(total(moved(&there, "texture")), corners);
    assert_eq!(moved(&there, "texture")["missing"], 0);
    let back = folder.line("transfer s.homeo --from s.obj --inverse --status -o back.vtu --json -q").expect(0).json();
    assert_eq!(total(moved(&back, "texture")), 3 * 256);
    assert_eq!(mesh(&folder, "back.vtu").positions, mesh(&folder, "t.obj").positions);
    // Another surface in the same shell.
    folder.line("simplify t.obj --to 60% -o other.obj -q").expect(0);
    let onto = folder.line("transfer s.homeo --from t.obj --onto other.obj -o onto.obj --json -q").expect(0).json();
    assert_eq!(mesh(&folder, "onto.obj").positions, mesh(&folder, "other.obj").positions);
    assert!(onto["certificate"]["statement"].as_str().unwrap().contains("other section"));
    // The source lies in its shell, too: all is copied.
    folder.line("shell t.obj -o shell.homeo -q").expect(0);
    let same = folder.line("transfer shell.homeo --from t.obj --onto t.obj -o same.obj --json -q").expect(0).json();
    assert_eq!(moved(&same, "texture")["copied"], 3 * 256);
    let row = |name: &str| numbers(&mesh(&folder, name), "texture", Element::Corner);
    assert_eq!(row("same.obj"), row("t.obj"));
}

#[test]
fn what_is_no_section_is_refused() {
    let folder = Folder::new();
    let plain = torus(N, M);
    let far: String = plain.lines().map(|line| line.replacen("v ", "v 1", 1).replace("v 1-", "v -1") + "\n").collect();
    let inside_out: String = plain
        .lines()
        .map(|line| match line.split(' ').collect::<Vec<_>>().as_slice() {
            ["f", a, b, c] => format!("f {a} {c} {b}\n"),
            _ => format!("{line}\n"),
        })
        .collect();
    let open = plain.replacen("f 1 9 10\n", "", 1);
    let twice = plain.replacen("f 1 9 10\n", "f 1 9 10\nf 1 9 10\n", 1);
    folder.write("t.obj", &plain).write("far.obj", &far).write("inside_out.obj", &inside_out);
    folder.write("open.obj", &open).write("twice.obj", &twice).write("closed.off", CLOSED);
    folder.write("solid.mesh", cubes(&[[0, 0, 0]])).write("quads.obj", quads(2));
    folder.line("simplify t.obj --to 40% -o s.obj --map s.homeo -q").expect(0);
    folder.line("shell t.obj -o shell.homeo -q").expect(0);
    let before = folder.names();
    let refused = |line: &str, codes: &[&str]| {
        let run = folder.line(&format!("{line} -o no.obj --json -q")).expect(3);
        let report = run.json();
        let code = report["error"]["code"].as_str().unwrap();
        assert!(codes.contains(&code), "{line}: {code}: {}", run.stderr);
        if line.contains("--onto") && code == "no-section" {
            let own = |kind: &str| report["elements"][kind].as_array().unwrap().clone();
            let (triangles, vertices) = (own("triangles"), own("vertices"));
            assert!(!triangles.is_empty() && triangles.iter().all(|t| count(t) <= 256), "{report}");
            assert!(!vertices.is_empty() && vertices.iter().all(|v| count(v) < 128), "{report}");
        }
        assert_eq!(folder.names(), before, "{line} leaves nothing behind");
    };
    for onto in ["far.obj", "inside_out.obj", "open.obj", "closed.off", "twice.obj"] {
        refused(&format!("transfer s.homeo --from t.obj --onto {onto}"), &["no-section"]);
    }
    refused("transfer s.homeo --from t.obj --onto solid.mesh", &["wrong-dimension"]);
    refused("transfer s.homeo --from t.obj --onto quads.obj", &["polygon-not-triangle"]);
    refused("transfer shell.homeo --from t.obj", &["no-section"]);
    refused("transfer shell.homeo --from t.obj --inverse", &["no-section"]);
    for (from, options) in [("s.obj", ""), ("t.obj", "--inverse"), ("far.obj", ""), ("inside_out.obj", "")] {
        refused(&format!("transfer s.homeo --from {from} {options}"), &["other-mesh"]);
    }
    folder.line("shell t.obj --thickness 0.02 -o thin.homeo -q").expect(0);
    let thin = folder.line("transfer thin.homeo --from t.obj --onto s.obj -o no.obj --json -q");
    assert_eq!((thin.code, &thin.json()["error"]["code"]), (3, &"no-section".into()), "{}", thin.stderr);
}

#[test]
fn other_maps_and_broken_ones_are_refused() {
    let folder = Folder::new();
    folder.write("q.obj", quads(2)).write("t.obj", torus(N, M));
    folder.line("map q.obj --triangulate --onto square -o q.homeo -q").expect(0);
    let wrong = folder.line("transfer q.homeo --from q.obj --triangulate -o no.obj --json -q").expect(3).json();
    assert_eq!(wrong["error"]["code"], "wrong-kind");
    folder.line("simplify t.obj --to 40% -o s.obj --map s.homeo -q").expect(0);
    let bytes = folder.read("s.homeo");
    folder.write("cut.homeo", &bytes[..bytes.len() / 2]);
    folder.line("transfer cut.homeo --from t.obj -o no.obj -q").expect(3);
    folder.line("transfer none.homeo --from t.obj -o no.obj -q").expect(3);
    assert!(!folder.names().iter().any(|name| name.starts_with("no.")));
}
