//! `homeo eval`: both ways, exactly and in floating point.

mod common;

use common::{Folder, cubes, quads};

/// A folder with a map of two cubes onto the cube, `m.homeo`.
fn mapped() -> Folder {
    let folder = Folder::new();
    folder.write("two.mesh", cubes(&[[0, 0, 0], [1, 0, 0]]));
    folder.line("map two.mesh --onto cube -o m.homeo -q").expect(0);
    folder
}

#[test]
fn exact_round_trip_gives_the_same_text() {
    let folder = Folder::new().with_testdata();
    for target in ["cube", "ball"] {
        folder.line(&format!("map testdata/meshes/spot.mesh --onto {target} -o m.homeo -q")).expect(0);
        folder.line("eval m.homeo --points testdata/points/spot.csv --exact -o there.csv -q").expect(0);
        folder.line("eval m.homeo --points there.csv --exact --inverse -o back.csv -q").expect(0);
        folder.line("eval m.homeo --points back.csv --exact -o again.csv -q").expect(0);
        assert!(folder.read("there.csv") == folder.read("again.csv"));
        let rational = |text: &str| -> Vec<f64> {
            let value = |x: &str| {
                x.split_once('/')
                    .map_or_else(|| x.parse().unwrap(), |(p, q)| p.parse::<f64>().unwrap() / q.parse::<f64>().unwrap())
            };
            text.lines().skip(1).flat_map(|row| row.split(',').map(value).collect::<Vec<f64>>()).collect()
        };
        assert_eq!(rational(&folder.text("back.csv")), rational(&folder.text("testdata/points/spot.csv")));
    }
}

#[test]
fn floating_answers_are_near_the_exact_ones() {
    let folder = mapped();
    folder.write("p.csv", "x,y,z\n0.25,0.5,0.125\n1.75,0.3,0.9\n1,1,1\n");
    let float = folder.line("eval m.homeo --points p.csv -q").expect(0).stdout;
    folder.line("eval m.homeo --points p.csv --exact -o e.csv -q").expect(0);
    let exact = folder.text("e.csv");
    for (a, b) in float.lines().zip(exact.lines()).skip(1).flat_map(|(a, b)| a.split(',').zip(b.split(','))) {
        let exact = b
            .split_once('/')
            .map_or_else(|| b.parse().unwrap(), |(p, q)| p.parse::<f64>().unwrap() / q.parse::<f64>().unwrap());
        assert!((a.parse::<f64>().unwrap() - exact).abs() < 1e-9, "{a} is not near {b}");
    }
    folder.line("eval m.homeo --points p.csv -o one.npy --threads 1 -q").expect(0);
    folder.line("eval m.homeo --points p.csv -o two.npy --threads 2 -q").expect(0);
    assert_eq!(folder.read("one.npy"), folder.read("two.npy"));
    let report = folder.line("eval m.homeo --points one.npy --inverse -o back.csv --json -q").expect(0).json();
    assert_eq!((&report["points"], &report["outside"]), (&3.into(), &0.into()));
    assert!(report["error"]["max_radius"].as_f64().unwrap() < 1e-6);
    assert!(folder.text("back.csv").starts_with("x,y,z\n"));
}

#[test]
fn points_outside_are_errors_or_counted() {
    let folder = mapped();
    folder.write("p.csv", "x,y,z\n0.5,0.5,0.5\n5,5,5\n0.5,0.5,0.25\n");
    let run = folder.line("eval m.homeo --points p.csv -o o.csv").expect(3);
    assert!(run.stderr.contains("row 2") && run.stderr.contains("outside"), "{}", run.stderr);
    assert!(!folder.names().contains(&"o.csv".to_owned()));
    let run = folder.line("eval m.homeo --points p.csv -o o.csv --outside nan").expect(0);
    assert!(run.stderr.contains("1 of 3 points"), "{}", run.stderr);
    assert_eq!(folder.text("o.csv").lines().nth(2), Some("NaN,NaN,NaN"));
    let run = folder.line("eval m.homeo --points p.csv --outside nan --exact -q").expect(0);
    assert_eq!(run.stdout.lines().nth(2), Some("NaN,NaN,NaN"));
    folder.write("q.csv", "x,y,z\n0.5,0.5,1.5\n");
    folder.line("eval m.homeo --points q.csv --inverse -q").expect(3);
}

#[test]
fn plane_targets_have_two_columns() {
    let folder = Folder::new().with_testdata();
    folder.line("map testdata/meshes/face.obj --onto square -o s.homeo -q").expect(0);
    let run = folder.line("eval s.homeo --points testdata/points/square.csv --inverse -q").expect(0);
    assert!(run.stdout.starts_with("x,y,z\n"));
    folder.write("p.csv", &run.stdout);
    let run = folder.line("eval s.homeo --points p.csv -q").expect(0);
    assert!(run.stdout.starts_with("x,y\n"));
    for (a, b) in run.stdout.lines().zip(folder.text("testdata/points/square.csv").lines()).skip(1) {
        let near = |(x, y): (&str, &str)| (x.parse::<f64>().unwrap() - y.parse::<f64>().unwrap()).abs() < 1e-6;
        assert!(a.split(',').zip(b.split(',')).all(near), "{a} is not near {b}");
    }
    folder.write("flat.obj", quads(3));
    folder.line("map flat.obj --onto disk --triangulate -o d.homeo -q").expect(0);
    folder.write("p.csv", "x,y\n1.5,0.5\n");
    folder.line("eval d.homeo --points p.csv -q").expect(0);
    folder.write("p.csv", "x,y,z\n0.5,0.1,0.1\n");
    folder.line("eval d.homeo --points p.csv --inverse -q").expect(3);
}

#[test]
fn wrong_tables_are_refused() {
    let folder = mapped();
    for (content, words) in [
        ("a,b,c\n1,2,3\n", "header"),
        ("x,y,z\n1,2\n", "row 1"),
        ("x,y,z\n0.5,0.5,0.5\n1,2,three\n", "row 2"),
        ("x,y,z\n1/2,1/2,1/2\n", "--exact"),
        ("x,y,z\nnan,0,0\n", "row 1"),
        ("x,y\n0.5,0.5\n", "three coordinates"),
    ] {
        let run = folder.write("p.csv", content).line("eval m.homeo --points p.csv").expect(3);
        assert!(run.stderr.contains(words), "{content}: {}", run.stderr);
    }
    folder.write("p.npy", b"\x93NUMPY\x01\x00");
    folder.line("eval m.homeo --points p.npy -q").expect(3);
    folder.write("p.csv", "x,y,z\n0.5,0.5,0.5\n");
    folder.line("eval m.homeo --points p.csv --json").expect(2);
    folder.line("eval m.homeo --points p.txt").expect(2);
    folder.line("eval m.homeo --points p.csv --exact -o o.npy").expect(2);
    folder.line("eval m.homeo --points p.csv -o p.csv").expect(2);
    folder.line("eval two.mesh --points p.csv -q").expect(3);
}
