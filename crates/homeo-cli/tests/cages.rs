//! `homeo warp` with cages: what moves, what is kept, what is refused.

mod common;

use common::Folder;
use homeo_core::io::{Element, read_mesh};
use homeo_core::mesh::TetrahedronComplex;
use homeo_core::number::Rational;
use homeo_core::predicate::orient3d;
use homeo_core::topology::{Answer, Options, analyse_tetrahedra};

const BARS: &str = "--from testdata/cages/bar.obj --to testdata/cages/bar_twisted.obj";

fn folder() -> Folder {
    Folder::new().with_testdata()
}

#[test]
fn a_tetrahedral_mesh_is_twisted_and_no_cell_turns_over() {
    let folder = folder();
    for path in ["straight", "angles"] {
        let line = format!("warp testdata/meshes/spot.mesh {BARS} --path {path} -o twisted.vtu --json");
        let report = folder.line(&line).expect(0).json();
        assert_eq!(report["checked"]["holds"], true);
        assert_eq!(report["input"]["tetrahedra"], 3020);
        let before = read_mesh(&folder.path("testdata/meshes/spot.mesh")).unwrap();
        let after = read_mesh(&folder.path("twisted.vtu")).unwrap();
        assert_eq!(before.tetrahedra, after.tetrahedra);
        assert_ne!(before.positions, after.positions);
        let sign = |points: &[[f64; 3]], cell: &[u32; 4]| {
            let [a, b, c, d] = cell.map(|v| points[v as usize]);
            orient3d(a, b, c, d)
        };
        let kept = |cell: &&[u32; 4]| sign(&before.positions, cell) == sign(&after.positions, cell);
        assert_eq!(after.tetrahedra.iter().filter(kept).count(), 3020);
        let complex = TetrahedronComplex::from_indices(after.vertex_count, &after.tetrahedra).unwrap();
        let report = analyse_tetrahedra(&after.positions, &complex, Options::default());
        assert_eq!(report.embedded.answer, Answer::Yes);
    }
}

/// The same bytes whatever the number of threads.
#[test]
fn threads_make_no_difference() {
    let folder = folder();
    for (threads, name) in [(1, "one.mesh"), (3, "three.mesh")] {
        folder.line(&format!("warp testdata/meshes/spot.mesh {BARS} --threads {threads} -o {name}")).expect(0);
    }
    assert_eq!(folder.read("one.mesh"), folder.read("three.mesh"));
}

/// A cage that is turned inside out at one end: nothing is written, and the cells are named.
#[test]
fn folded_cells_are_named_and_nothing_is_written() {
    let folder = folder();
    let bar = folder.text("testdata/cages/bar.obj");
    // The last floor is pushed through the body, and the cage stays embedded: its end is hollow.
    let mut lines: Vec<String> = bar.lines().map(str::to_owned).collect();
    for line in &mut lines[20..24] {
        let numbers: Vec<f64> = line.split_whitespace().skip(1).map(|x| x.parse().unwrap()).collect();
        *line = format!("v {} {} {}", 0.5 * numbers[0], 0.5 * (numbers[1] - 0.15) + 0.15, -0.5);
    }
    folder.write("hollow.obj", lines.join("\n"));
    let line =
        "warp testdata/meshes/spot.mesh --from testdata/cages/bar.obj --to hollow.obj --most-steps 1 -o out.mesh";
    let run = folder.line(&format!("{line} --json")).expect(4);
    let report = run.json();
    assert_eq!(report["error"]["code"], "folded");
    let folded = report["folded"].as_array().unwrap();
    assert!(!folded.is_empty() && report["folded_count"].as_u64().unwrap() >= folded.len() as u64);
    assert!(run.stderr.contains("Nothing was written") && !folder.path("out.mesh").exists());
}

#[test]
fn data_of_surfaces_is_kept() {
    let folder = folder();
    let big = |name: &str, stretch: f64| {
        let bar = folder.text("testdata/cages/bar.obj");
        let place = |line: &str| match line.strip_prefix("v ") {
            Some(rest) => {
                let numbers: Vec<f64> = rest.split_whitespace().map(|x| 9.0 * x.parse::<f64>().unwrap()).collect();
                format!("v {} {} {}", numbers[0], numbers[1] - 1.0, stretch * (numbers[2] - 2.0))
            }
            None => line.to_owned(),
        };
        folder.write(name, bar.lines().map(place).collect::<Vec<_>>().join("\n"));
    };
    big("before.obj", 1.0);
    big("after.obj", 2.0);
    folder.line("warp testdata/meshes/knot.ply --from before.obj --to after.obj --steps 3 -o knot.ply").expect(0);
    let (before, after) =
        (read_mesh(&folder.path("testdata/meshes/knot.ply")).unwrap(), read_mesh(&folder.path("knot.ply")).unwrap());
    assert_eq!((&before.polygons, &before.attributes), (&after.polygons, &after.attributes));
    assert!(after.attributes.iter().any(|a| a.element == Element::Vertex));
    for (p, q) in before.positions.iter().zip(&after.positions) {
        assert!((q[2] - 2.0 * p[2]).abs() < 1e-11 * (1.0 + p[2].abs()) && (q[0] - p[0]).abs() < 1e-11);
    }
}

#[test]
fn points_move_and_are_not_judged() {
    let folder = folder();
    folder.write("points.csv", "x,y,z\n0.1,0.2,0.3\n-0.2,0.5,0.9\n");
    let report = folder.line(&format!("warp points.csv {BARS} -o moved.csv --json")).expect(0).json();
    assert_eq!(report["checked"]["holds"], false);
    assert_eq!(folder.text("moved.csv").lines().count(), 3);
    folder.write("flat.csv", "x,y\n0.1,0.2\n");
    folder.line(&format!("warp flat.csv {BARS} -o moved.csv")).expect(3);
}

#[test]
fn cages_that_are_none_are_refused_with_an_element() {
    let folder = folder();
    let bar = folder.text("testdata/cages/bar.obj");
    let open: Vec<&str> = bar.lines().take(bar.lines().count() - 1).collect();
    folder.write("open.obj", open.join("\n"));
    folder.write("crossed.obj", bar.replacen("v -0.6 -0.85 -0.8", "v 3 3 3", 1));
    let refused = |from: &str, to: &str| {
        let run = folder.line(&format!("warp testdata/meshes/spot.mesh --from {from} --to {to} -o out.mesh --json"));
        let report = run.expect(3).json();
        (report["error"]["code"].as_str().unwrap().to_owned(), report["error"]["message"].as_str().unwrap().to_owned())
    };
    let (code, message) = refused("open.obj", "open.obj");
    assert!(code == "not-closed" && message.contains("edge"), "{message}");
    let (code, _) = refused("testdata/cages/bar.obj", "open.obj");
    assert_eq!(code, "other-triangles");
    let (code, _) = refused("testdata/cages/bar.obj", "crossed.obj");
    assert_eq!(code, "self-intersection");
    let (code, _) = refused("testdata/cages/bar.obj", "testdata/meshes/torus.obj");
    assert_eq!(code, "counts-differ");
    let (code, _) = refused("testdata/cages/bar.obj", "testdata/meshes/spot.mesh");
    assert_eq!(code, "no-surface");
    let still = "--from testdata/cages/bar.obj --to testdata/cages/bar.obj";
    let run = folder.line(&format!("warp testdata/meshes/torus.obj {still} -o out.stl")).expect(2);
    assert!(run.stderr.contains("bit for bit") && !folder.path("out.stl").exists());
}

/// The map is kept, checked again, and evaluated both ways exactly.
#[test]
fn the_map_of_a_mesh_is_kept_with_its_certificate() {
    let folder = folder();
    let line = format!("warp testdata/meshes/spot.mesh {BARS} -o twisted.mesh --map twisted.homeo --json");
    let report = folder.line(&line).expect(0).json();
    assert_eq!((&report["certificate"]["holds"], &report["certificate"]["kind"]), (&true.into(), &"moved-mesh".into()));
    assert_eq!(report["map"], "twisted.homeo");
    let verified = folder.line("verify twisted.homeo --source testdata/meshes/spot.mesh --json").expect(0).json();
    assert_eq!((&verified["input"]["tetrahedra"], &verified["source"]["same"]), (&3020.into(), &true.into()));
    folder.line("verify twisted.homeo --source twisted.mesh").expect(3);
    folder.line("eval twisted.homeo --points testdata/points/spot.csv --exact -o images.csv").expect(0);
    folder.line("eval twisted.homeo --points images.csv --exact --inverse -o back.csv").expect(0);
    folder.line("eval twisted.homeo --points back.csv --exact -o again.csv").expect(0);
    assert_eq!(folder.read("images.csv"), folder.read("again.csv"));
    let (before, after) = (rows(&folder.text("testdata/points/spot.csv")), rows(&folder.text("back.csv")));
    assert!(before == after && !before.is_empty(), "{before:?} {after:?}");
    let near = folder.line("eval twisted.homeo --points testdata/points/spot.csv -o near.csv --json").expect(0).json();
    assert!(near["error"]["max_radius"].as_f64().unwrap() < 1e-9);
    // Vertices go where the mesh has them.
    let mesh = read_mesh(&folder.path("testdata/meshes/spot.mesh")).unwrap();
    let moved = read_mesh(&folder.path("twisted.mesh")).unwrap();
    let exact = |p: &[f64; 3]| p.map(|x| Rational::from_f64(x).unwrap());
    let text = |points: &[[f64; 3]]| {
        let line = |all: String, [x, y, z]: [Rational; 3]| format!("{all}{x},{y},{z}\n");
        points.iter().take(40).map(exact).fold("x,y,z\n".to_owned(), line)
    };
    folder.write("vertices.csv", text(&mesh.positions));
    folder.line("eval twisted.homeo --points vertices.csv --exact -o corners.csv").expect(0);
    assert_eq!(rows(&folder.text("corners.csv")), rows(&text(&moved.positions)));
    let far = folder.line("eval twisted.homeo --points testdata/points/cube.csv --inverse -o out.csv").expect(3);
    assert!(far.stderr.contains("outside the moved mesh"), "{}", far.stderr);
    folder.line("report twisted.homeo -o page.html").expect(3);
    folder.line("pl twisted.homeo -o a.ply --image b.ply").expect(3);
}

const TENTS: &str = "--from testdata/cages/tent.obj --to testdata/cages/tent_leaning.obj";

fn doubles(text: &str) -> Vec<[f64; 3]> {
    let row = |line: &str| {
        let mut numbers = line.split(',').map(|x| x.parse().unwrap());
        [(); 3].map(|()| numbers.next().unwrap())
    };
    text.lines().skip(1).map(row).collect()
}

/// Of points the smooth map between the cages is kept, and proved everywhere inside.
#[test]
fn the_map_of_points_is_kept_with_its_certificate() {
    let folder = folder();
    let line = format!("warp testdata/points/tent.csv {TENTS} -o moved.csv --map tent.homeo --json");
    let report = folder.line(&line).expect(0).json();
    let certificate = &report["certificate"];
    assert_eq!((&certificate["holds"], &certificate["kind"]), (&true.into(), &"composite-cage".into()));
    assert_eq!((&report["steps"], &report["checked"]["holds"]), (&1.into(), &false.into()));
    folder.line(&format!("warp testdata/points/tent.csv {TENTS} -o plain.csv")).expect(0);
    assert_eq!(folder.read("moved.csv"), folder.read("plain.csv"));
    let verified = folder.line("verify tent.homeo --source testdata/cages/tent.obj --json").expect(0).json();
    assert_eq!((&verified["input"]["vertices"], &verified["input"]["triangles"]), (&5.into(), &6.into()));
    folder.line("verify tent.homeo --source testdata/cages/tent_leaning.obj").expect(3);
    // There and back, with bounds; the last point is on the base and stays there.
    let eval = "eval tent.homeo --points testdata/points/tent.csv -o images.csv --json";
    let report = folder.line(eval).expect(0).json();
    assert!(report["error"]["max_radius"].as_f64().unwrap() < 1e-10, "{report}");
    let near = |a: &str, b: &str| {
        let rows = |name: &str| doubles(&folder.text(name));
        rows(a).iter().zip(rows(b)).all(|(p, q)| (0..3).all(|k| (p[k] - q[k]).abs() < 1e-9))
    };
    assert!(near("images.csv", "moved.csv"));
    folder.line("eval tent.homeo --points images.csv --inverse -o back.csv").expect(0);
    assert!(near("back.csv", "testdata/points/tent.csv"));
    let run = folder.line("eval tent.homeo --points testdata/points/tent.csv --exact").expect(3);
    assert!(run.stderr.contains("leave out"), "{}", run.stderr);
    folder.write("far.csv", "x,y,z\n0,0,0\n0,0,9\n");
    let run = folder.line("eval tent.homeo --points far.csv").expect(3);
    assert!(run.stderr.contains("row 2") && run.stderr.contains("outside the source cage"), "{}", run.stderr);
    folder.line("report tent.homeo -o page.html").expect(3);
}

/// An apex that is pressed through the base of a cage that is not convex: more steps do not help within the limit.
#[test]
fn a_map_of_points_that_folds_is_refused() {
    let folder = folder();
    let dart = |top: f64| {
        format!(
            "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0 0 {top}\nv 0 0 -1.5\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 2 1 6\nf 3 2 6\nf 4 3 6\nf 1 4 6\n"
        )
    };
    folder.write("before.obj", dart(0.5)).write("after.obj", dart(-1.2));
    folder.write("points.csv", "x,y,z\n0,0,0\n0.1,0.2,-0.3\n");
    let line = "warp points.csv --from before.obj --to after.obj -o moved.csv --map m.homeo --most-steps 2 --json";
    let report = folder.line(line).expect(4).json();
    assert_eq!((&report["error"]["code"], &report["witness"]["rule"]), (&"refuted".into(), &"Q3".into()));
    assert_eq!((&report["steps"], report["witness"]["points"].as_array().unwrap().len()), (&2.into(), 1));
    folder.write("outside.csv", "x,y,z\n0,0,0\n3,0,0\n0,0,9\n");
    let line = line.replace("points.csv", "outside.csv");
    let report = folder.line(&line).expect(3).json();
    assert_eq!((&report["error"]["code"], &report["row"]), (&"outside".into(), &2.into()));
    assert_eq!(report["rows_without_image"], 2);
    assert!(!folder.path("moved.csv").exists() && !folder.path("m.homeo").exists());
    folder.line(&format!("warp testdata/points/star.csv {TENTS} --map m.homeo")).expect(3);
}

/// The rows of a table, as rationals.
fn rows(text: &str) -> Vec<Vec<Rational>> {
    let row = |line: &str| line.split(',').map(|x| x.parse().unwrap()).collect();
    text.lines().skip(1).map(row).collect()
}

#[test]
fn the_map_of_a_surface_is_kept_with_its_certificate() {
    let folder = folder();
    folder.line(&format!("warp testdata/meshes/torus.obj {BARS} --map torus.homeo")).expect(0);
    let described = folder.line("verify torus.homeo --json").expect(0).json();
    assert_eq!((&described["input"]["triangles"], &described["input"]["vertices"]), (&1440.into(), &720.into()));
    folder.line("verify torus.homeo --source testdata/meshes/torus.obj").expect(0);
}

/// Two banks of a seam: the moved surface is sound, but the map of its points is not one that the checker certifies.
#[test]
fn a_surface_with_a_seam_has_no_certificate() {
    let folder = folder();
    let seam = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0.1 0 0\nv 0 0.1 0\nv 0.1 0.1 0\nf 1 2 3\nf 4 6 5\n";
    folder.write("seam.obj", seam);
    folder.line(&format!("warp seam.obj {BARS} -o moved.obj")).expect(0);
    let run = folder.line(&format!("warp seam.obj {BARS} -o other.obj --map seam.homeo --json")).expect(4);
    let report = run.json();
    assert_eq!((&report["error"]["code"], &report["witness"]["rule"]), (&"refuted".into(), &"M4".into()));
    assert_eq!(report["witness"]["vertices"].as_array().unwrap().len(), 6);
    assert!(!folder.path("other.obj").exists() && !folder.path("seam.homeo").exists());
}

/// A tetrahedral mesh that follows its own boundary, stretched.
#[test]
fn the_inside_follows_the_boundary() {
    let folder = folder();
    let mesh = read_mesh(&folder.path("testdata/meshes/spot.mesh")).unwrap();
    let mut obj = String::new();
    for p in &mesh.positions {
        obj.push_str(&format!("v {} {} {}\n", 1.5 * p[0], p[1], p[2] + 0.1 * p[1]));
    }
    folder.write("stretched.obj", obj + "f 1 2 3\n");
    let line = "warp testdata/meshes/spot.mesh --to stretched.obj --method harmonic -o out.mesh --json";
    let report = folder.line(line).expect(0).json();
    assert_eq!((&report["checked"]["holds"], &report["target"]), (&true.into(), &"boundary".into()));
    folder.line("warp testdata/meshes/spot.mesh --to stretched.obj --method harmonic --map out.homeo").expect(0);
    folder.line("verify out.homeo").expect(0);
    folder.line("warp testdata/meshes/torus.obj --to stretched.obj --method harmonic -o out.obj").expect(3);
    folder.line("warp testdata/meshes/spot.mesh --to testdata/cages/bar.obj --method harmonic -o out.mesh").expect(3);
}
