//! `homeo map`: what it makes, what it refuses, and what it leaves behind.

mod common;

use common::{CLOSED, Folder, cubes, quads};

#[test]
fn all_targets_are_certified() {
    let folder = Folder::new().with_testdata();
    for (mesh, target) in [("face.obj", "square"), ("face.obj", "disk"), ("spot.mesh", "cube"), ("spot.mesh", "ball")] {
        let line = format!("map testdata/meshes/{mesh} --onto {target} -o m.homeo --json -q");
        let report = folder.line(&line).expect(0).json();
        assert_eq!((&report["ok"], &report["certificate"]["holds"]), (&true.into(), &true.into()));
        assert_eq!(report["certificate"]["kind"], "foliation");
        let checked = report["certificate"]["checked"].as_object().unwrap();
        assert!(checked.values().filter_map(serde_json::Value::as_u64).sum::<u64>() > 1000);
        assert!(report["quality"]["cells"].as_u64().unwrap() >= 560);
        assert!(report["quality"]["sampled"]["stretch_ratio"]["median"].as_f64().unwrap() >= 1.0);
        for stage in ["read", "check", "prepare", "harmonic", "order", "directions", "certificate", "write", "total"] {
            assert!(report["seconds"][stage].is_number(), "{stage} is missing in {}", report["seconds"]);
        }
        folder.line("verify m.homeo -q").expect(0);
    }
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let folder = Folder::new().with_testdata();
    for (mesh, target) in [("face.obj", "disk"), ("spot.mesh", "cube"), ("spot.mesh", "ball")] {
        for threads in ["1", "2"] {
            let line = format!("map testdata/meshes/{mesh} --onto {target} -o {threads}.homeo --threads {threads} -q");
            folder.line(&line).expect(0);
        }
        assert!(folder.read("1.homeo") == folder.read("2.homeo"), "{mesh} onto {target}");
    }
}

#[test]
fn all_outputs_appear() {
    let folder = Folder::new().with_testdata();
    let line = "map testdata/meshes/face.obj --onto disk -o f.homeo --vtu f.vtk --report f.html --log f.log -q";
    folder.line(line).expect(0);
    assert_eq!(folder.names(), ["f.homeo", "f.html", "f.log", "f.vtk", "testdata"]);
    assert!(folder.text("f.html").starts_with("<!doctype html>"));
    assert!(folder.text("f.log").contains("stage certificate"));
    let vtk = String::from_utf8_lossy(&folder.read("f.vtk")).into_owned();
    assert!(vtk.contains("image") && vtk.contains("distortion"));
    folder.line("info f.vtk -q").expect(0);
}

#[test]
fn unfit_meshes_are_refused_with_their_elements() {
    let ring: Vec<[usize; 3]> = (0..9).map(|i| [i % 3, i / 3, 0]).filter(|c| *c != [1, 1, 0]).collect();
    let mut hole = quads(3);
    hole = hole.replace("f 6 7 11 10\n", "");
    let flipped = cubes(&[[0, 0, 0]]).replace("1 2 3 4 0\n", "1 3 2 4 0\n");
    let cases: [(&str, &str, &str, &str, &str); 8] = [
        ("closed.off", CLOSED, "disk", "not-a-disk", "closed"),
        ("closed.off", CLOSED, "cube", "wrong-dimension", "tetrahedra"),
        ("quads.obj", &quads(2), "square", "polygon-not-triangle", "--triangulate"),
        ("hole.obj", &hole, "square --triangulate", "not-a-disk", "2 boundary loops"),
        ("ring.mesh", &cubes(&ring), "ball", "not-a-ball", "genus 1"),
        ("two.mesh", &cubes(&[[0, 0, 0], [2, 2, 2]]), "ball", "not-a-ball", "2 pieces"),
        ("flipped.mesh", &flipped, "cube", "inconsistent-orientation", "--orient"),
        ("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "square", "degenerate-cell", "cell 0"),
    ];
    for (name, content, onto, code, words) in cases {
        let folder = Folder::new();
        let line = format!("map {name} --onto {onto} -o m.homeo --json");
        let run = folder.write(name, content).line(&line).expect(3);
        assert_eq!(run.json()["error"]["code"], code, "{name}: {}", run.stdout);
        assert!(run.stderr.contains(words), "{name}: {}", run.stderr);
        assert_eq!(folder.names(), [name], "nothing is left behind");
    }
}

#[test]
fn changes_are_made_on_request_and_told() {
    let folder = Folder::new();
    folder.write("quads.obj", quads(4));
    let report = folder.line("map quads.obj --onto square --triangulate -o q.homeo --json -q").expect(0).json();
    assert!(report["input"]["changes"][0].as_str().unwrap().contains("16 polygons"));
    folder.line("verify q.homeo --source quads.obj --triangulate -q").expect(0);
    let flipped = cubes(&[[0, 0, 0], [1, 0, 0]]).replace("1 2 3 4 0\n", "1 3 2 4 0\n");
    folder.write("flipped.mesh", flipped);
    let report = folder.line("map flipped.mesh --onto ball --orient -o b.homeo --json -q").expect(0).json();
    assert!(report["input"]["changes"][0].as_str().unwrap().contains("1 tetrahedra"));
    folder.line("verify b.homeo --source flipped.mesh --orient -q").expect(0);
    folder.line("verify b.homeo --source flipped.mesh -q").expect(3);
    let mixed = quads(3).replace("f 1 2 6 5\n", "f 1 5 6 2\n");
    folder.write("mixed.obj", mixed);
    folder.line("map mixed.obj --onto square --triangulate -q").expect(3);
    folder.line("map mixed.obj --onto square --triangulate --orient -q").expect(0);
}

#[test]
fn limits_end_the_work_and_leave_nothing() {
    let folder = Folder::new().with_testdata();
    for limit in ["--timeout 0.000001", "--memory 4K"] {
        let line = format!("map testdata/meshes/spot.mesh --onto cube -o m.homeo --vtu m.vtk --json {limit}");
        let run = folder.line(&line);
        // The watch looks every twentieth of a second: a run may be done before.
        if run.code != 0 {
            let report = run.expect(4).json();
            let code = report["error"]["code"].as_str().unwrap();
            assert!(code == "timeout" || code == "memory", "{report}");
            assert_eq!(folder.names(), ["testdata"]);
        } else {
            std::fs::remove_file(folder.path("m.homeo")).unwrap();
            std::fs::remove_file(folder.path("m.vtk")).unwrap();
        }
    }
}

#[test]
fn regions_are_used_or_refused() {
    let folder = Folder::new();
    folder.write("quads.obj", quads(4));
    folder.write("corners.json", "{\"corners\": [0, 4, 24, 20]}");
    folder.line("map quads.obj --onto square --triangulate --regions corners.json -o q.homeo -q").expect(0);
    folder.write("points.csv", "x,y,z\n0,0,0\n4,4,0\n");
    let images = folder.line("eval q.homeo --points points.csv -q").expect(0).stdout;
    let rows: Vec<&str> = images.lines().skip(1).collect();
    assert!(rows.iter().all(|row| row.split(',').all(|x| x == "0.0" || x == "1.0")), "corners go to corners: {images}");
    for bad in
        ["{}", "[]", "{\"corners\": [0, 1]}", "{\"corner\": [0, 1, 2, 3]}", "{\"corners\": [0, 12, 24, 20]}", "{\"cent"]
    {
        folder.write("bad.json", bad);
        let run = folder.line("map quads.obj --onto square --triangulate --regions bad.json --json -q").expect(3);
        assert_eq!(run.json()["error"]["code"], "regions");
    }
}

#[test]
fn wrong_usage_is_told_apart() {
    let folder = Folder::new();
    folder.write("quads.obj", quads(2));
    for line in [
        "",
        "frobnicate",
        "map quads.obj",
        "map quads.obj --onto sphere",
        "map quads.obj --onto square -o nowhere/m.homeo",
        "map quads.obj --onto square -o quads.obj",
        "map quads.obj --onto square -o m --report m",
        "map quads.obj --onto square --vtu m.obj",
        "map quads.obj --onto square --timeout 0",
        "map quads.obj --onto square --memory none",
        "map quads.obj --onto square --threads 0",
        "map quads.obj --onto square --restarts 0",
        "info quads.obj -q -v",
        "info",
    ] {
        folder.line(line).expect(2);
    }
    let report = folder.line("map quads.obj --json").expect(2).json();
    assert_eq!(
        (&report["verb"], &report["ok"], &report["error"]["code"]),
        (&"map".into(), &false.into(), &"usage".into())
    );
    assert_eq!(folder.names(), ["quads.obj"]);
}
