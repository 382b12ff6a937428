//! `homeo warp --method complex` and what becomes of its map files.

mod common;

use common::Folder;

const PAIR: &str = "--from testdata/polygons/square.json --to kite.json --method complex";

/// A square in pixels becomes a kite whose corner lies at the same place along both axes.
fn folder(corner: u32) -> Folder {
    let folder = Folder::new().with_testdata();
    folder
        .write("kite.json", format!("[[8, 8], [120, 8], [{corner}, {corner}], [8, 120]]"))
        .write("points.csv", "x,y\n60,60\n100,30\n8,64\n");
    folder
}

#[test]
fn maps_are_certified_and_checked_again() {
    let folder = folder(80);
    let line = format!("warp testdata/images/checker.png {PAIR} --map step.homeo");
    let report = folder.line(&format!("{line} -o a.png --threads 1 --json")).expect(0).json();
    assert_eq!((&report["certificate"]["holds"], &report["target"]), (&true.into(), &"polygon".into()));
    assert_eq!(report["certificate"]["kind"], "complex-barycentric");
    assert_eq!(report["quality"]["degree"], 4);
    assert!(report["quality"]["least_determinant"].as_f64() > Some(0.0));
    let bytes = folder.read("step.homeo");
    folder.line(&format!("{line} -o b.png --threads 2")).expect(0);
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    assert_eq!(folder.read("step.homeo"), bytes);
    let report = folder.line("verify step.homeo --source testdata/polygons/square.json --json").expect(0).json();
    assert_eq!((&report["source"]["same"], &report["input"]["vertices"]), (&true.into(), &4.into()));
    let other = folder.line("verify step.homeo --source kite.json --json").expect(3).json();
    assert_eq!(other["error"]["code"], "other-source");
    folder.line("report step.homeo -o step.html").expect(0);
    assert!(folder.text("step.html").contains("Certified"));
}

#[test]
fn points_go_there_and_back() {
    let folder = folder(80);
    folder.line(&format!("warp points.csv {PAIR} --degree 3 -o moved.csv --map step.homeo")).expect(0);
    folder.line("eval step.homeo --points points.csv -o again.csv").expect(0);
    assert_eq!(folder.text("moved.csv"), folder.text("again.csv"));
    let back = folder.line("eval step.homeo --points moved.csv --inverse").expect(0).stdout;
    let numbers: Vec<f64> = back.split(['\n', ',']).filter_map(|word| word.trim().parse().ok()).collect();
    let wanted = [60.0, 60.0, 100.0, 30.0, 8.0, 64.0];
    assert!(numbers.len() == 6 && numbers.iter().zip(wanted).all(|(x, y)| (x - y).abs() < 1e-8), "{back}");
    let report = folder.line("eval step.homeo --points points.csv --exact -o d.csv --json").expect(3).json();
    assert_eq!(report["error"]["code"], "no-exact-images");
}

/// Several holes are taken as well as none.
#[test]
fn holes_are_kept() {
    let folder = Folder::new();
    let hole = |x: f64| format!("[[{x}, 1], [{x}, 2], [{}, 1]]", x + 1.0);
    let domain =
        |x: f64| format!("{{\"outer\": [[0,0],[8,0],[8,4],[0,4]], \"holes\": [{}, {}]}}", hole(x), hole(x + 3.0));
    let one = |x: f64| format!("{{\"outer\": [[0,0],[8,0],[8,4],[0,4]], \"inner\": {}}}", hole(x));
    folder.write("a.json", domain(1.0)).write("b.json", domain(1.25));
    folder.write("c.json", one(1.0)).write("d.json", one(1.25)).write("points.csv", "x,y\n0.5,0.5\n");
    let line =
        "warp points.csv --from c.json --to d.json --method complex --degree 2 -o out.csv --map ring.homeo --json";
    assert_eq!(folder.line(line).expect(0).json()["target"], "annulus");
    folder.line("verify ring.homeo --source c.json").expect(0);
    let line =
        "warp points.csv --from a.json --to b.json --method complex --degree 2 -o out.csv --map two.homeo --json";
    assert_eq!(folder.line(line).expect(0).json()["target"], "domain");
    folder.line("verify two.homeo --source a.json").expect(0);
}

/// A corner that is too deep: a witness, and no file.
#[test]
fn folds_are_told_and_nothing_is_written() {
    let folder = folder(16);
    let line = format!("warp points.csv {PAIR} --degree 2 -o out.csv --map out.homeo --json");
    let report = folder.line(&line).expect(4).json();
    assert_eq!(report["error"]["code"], "no-map");
    assert!(report["fold"]["determinant_at_most"].as_f64() < Some(0.0), "{report}");
    assert_eq!(report["fold"]["point"].as_array().map(Vec::len), Some(2));
    assert!(!folder.path("out.csv").exists() && !folder.path("out.homeo").exists());
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = folder(80);
    folder.write("bowtie.json", "[[8, 8], [120, 120], [120, 8], [8, 120]]");
    folder.write("three.json", "[[8, 8], [120, 120], [120, 8]]");
    for (degree, exit) in [("0", 2), ("9", 2), ("x", 2), ("1", 0), ("8", 0)] {
        folder.line(&format!("warp points.csv {PAIR} --degree {degree} -o {degree}.csv")).expect(exit);
    }
    let polygons = "--from testdata/polygons/square.json --to kite.json";
    folder.line(&format!("warp points.csv {polygons} --degree 3 -o out.csv")).expect(2);
    folder.line(&format!("warp points.csv {polygons} --method mean-value --degree 3 -o out.csv")).expect(2);
    for target in ["bowtie", "three"] {
        let line = format!("--from testdata/polygons/square.json --to {target}.json --method complex -o out.csv");
        folder.line(&format!("warp points.csv {line}")).expect(3);
    }
    let cages = "--from testdata/cages/bar.obj --to testdata/cages/bar_twisted.obj --method complex";
    folder.line(&format!("warp testdata/meshes/spot.mesh {cages} -o out.vtu")).expect(2);
    // A hole that turns too far for one step.
    let turn = "--pair testdata/polygons/hole_turned.json --method complex --turn 400 --json";
    let report = folder.line(&format!("warp points.csv {turn} -o out.csv")).expect(4).json();
    assert!(report["error"]["message"].as_str().is_some_and(|text| text.contains("half turn")), "{report}");
    assert!(!folder.path("out.csv").exists());
}

/// Options of harmonic maps say nothing of other maps: each is refused by its name and the method, and taken without one.
#[test]
fn options_of_another_method_are_refused() {
    let folder = folder(80);
    folder.write("landmarks.csv", "x,y,u,v\n0,0,0,0\n1,0,1,0\n0,1,0,1\n");
    let polygons = "--from testdata/polygons/square.json --to kite.json";
    for option in ["--triangles 500", "--middle regular"] {
        let name = option.split(' ').next().unwrap();
        for method in ["--method mean-value", "--method complex", "--landmarks"] {
            let of =
                if method == "--landmarks" { "--landmarks landmarks.csv" } else { &format!("{polygons} {method}") };
            let error = folder.line(&format!("warp points.csv {of} {option} -o out.csv --json")).expect(2).json();
            let message = error["error"]["message"].as_str().unwrap_or_default();
            assert!(message.contains(name) && message.contains(method), "{message}");
        }
        folder.line(&format!("warp points.csv {polygons} --method harmonic {option} -o taken.csv")).expect(0);
        folder.line(&format!("warp points.csv {polygons} {option} -o taken.csv")).expect(0);
    }
    let cages = "--from testdata/cages/bar.obj --to testdata/cages/bar_twisted.obj --triangles 500";
    folder.line(&format!("warp testdata/meshes/spot.mesh {cages} -o out.vtu")).expect(2);
    assert!(!folder.path("out.csv").exists() && !folder.path("out.vtu").exists());
}

/// A file whose control values were changed is refused by the command, too.
#[test]
fn damaged_files_are_refused() {
    let folder = folder(80);
    folder.line(&format!("warp points.csv {PAIR} -o moved.csv --map step.homeo")).expect(0);
    let bytes = folder.read("step.homeo");
    std::fs::write(folder.path("cut.homeo"), &bytes[..bytes.len() / 2]).unwrap();
    let report = folder.line("eval cut.homeo --points points.csv --json -o out.csv").expect(3).json();
    assert_eq!(report["error"]["code"], "unreadable-map");
}
