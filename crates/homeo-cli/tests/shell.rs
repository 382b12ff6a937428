//! `homeo shell`: what it makes, what it refuses, and what others do with it.

mod common;

use common::{CLOSED, Folder, cubes, quads, rationals, torus, vertices};
use homeo_core::number::Rational;

/// The boundary of four cubes in a chain round a point at which no direction leaves the surface, as OBJ.
fn singular() -> String {
    let cubes = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]];
    let number = |[x, y, z]: [i32; 3]| 9 * x + 3 * y + z + 1;
    let mut text = String::new();
    (0..27).for_each(|i| text.push_str(&format!("v {} {} {}\n", i / 9, i / 3 % 3, i % 3)));
    for cube in cubes {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut beyond = cube;
            beyond[axis] += 2 * side - 1;
            let corner = |u: i32, v: i32| {
                let mut corner = cube;
                corner[axis] += side;
                corner[(axis + 1) % 3] += u;
                corner[(axis + 2) % 3] += v;
                number(corner)
            };
            let mut quad = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            if side == 0 {
                quad.reverse();
            }
            let [a, b, c, d] = quad;
            if !cubes.contains(&beyond) {
                text.push_str(&format!("f {a} {b} {c}\nf {a} {c} {d}\n"));
            }
        }
    }
    text
}

#[test]
fn shells_are_certified() {
    for (obj, pinched) in [(torus(24, 10), 0), (singular(), 1)] {
        let folder = Folder::new();
        let first = obj.lines().next().unwrap();
        folder.write("m.obj", &obj).write("other.obj", obj.replacen(first, &format!("{first}1"), 1));
        let report = folder.line("shell m.obj -o m.homeo --json -q").expect(0).json();
        let (certificate, quality) = (&report["certificate"], &report["quality"]);
        assert_eq!((&report["ok"], &certificate["holds"]), (&true.into(), &true.into()));
        assert_eq!((&certificate["kind"], &report["target"]), (&"shell".into(), &"shell".into()));
        assert_eq!(report["input"]["triangles"], quality["first_prisms"]);
        assert_eq!((&quality["pinched"], &quality["cut_short"]), (&pinched.into(), &false.into()));
        assert_eq!(quality["prisms"], quality["middle"]["triangles"]);
        for count in ["collapses", "flips", "rounds"] {
            assert!(quality[count].is_u64(), "{count} is missing in {quality}");
        }
        let [prisms, first, columns] = [&quality["prisms"], &quality["first_prisms"], &quality["middle"]["vertices"]]
            .map(|count| count.as_u64().unwrap());
        assert!(prisms <= first && columns >= 4);
        for stage in ["read", "check", "directions", "thickness", "simplify", "write", "certificate", "total"] {
            assert!(report["seconds"][stage].is_number(), "{stage} is missing in {}", report["seconds"]);
        }
        let verified = folder.line("verify m.homeo --source m.obj --json -q").expect(0).json();
        assert_eq!((&verified["source"]["same"], &verified["certificate"]), (&true.into(), certificate));
        assert_eq!(verified["input"]["triangles"], report["input"]["triangles"]);
        assert_eq!(verified["input"]["vertices"], report["input"]["vertices"]);
        let refused = folder.line("verify m.homeo --source other.obj --json -q").expect(3).json();
        assert_eq!(refused["error"]["code"], "other-source");
    }
}

#[test]
fn exact_round_trip_gives_the_source_vertices() {
    for obj in [torus(24, 10), singular()] {
        let folder = Folder::new();
        let used: Vec<&str> = obj.lines().filter(|line| line.starts_with('f')).collect();
        let is_used = |number: usize| used.iter().any(|f| f.split(' ').any(|corner| corner == number.to_string()));
        let lines = obj.lines().filter(|line| line.starts_with('v')).enumerate().filter(|(v, _)| is_used(v + 1));
        let points = vertices(&lines.fold(String::new(), |text, (_, line)| text + line + "\n"));
        folder.write("m.obj", &obj).write("p.csv", &points);
        folder.line("shell m.obj -o m.homeo -q").expect(0);
        folder.line("eval m.homeo --points p.csv --exact -o middle.csv -q").expect(0);
        folder.line("eval m.homeo --points middle.csv --exact --inverse -o back.csv -q").expect(0);
        folder.line("eval m.homeo --points middle.csv --exact -o again.csv -q").expect(0);
        assert_eq!(rationals(&folder.text("back.csv")), rationals(&points), "there and back");
        assert_eq!(folder.read("again.csv"), folder.read("middle.csv"), "the middle stays where it is");
        folder.line("eval m.homeo --points p.csv --exact --inverse -o same.csv -q").expect(0);
        assert_eq!(rationals(&folder.text("same.csv")), rationals(&points), "the source stays where it is");
        let report = folder.line("eval m.homeo --points p.csv -o float.csv --json -q").expect(0).json();
        assert!(report["error"]["max_radius"].as_f64().unwrap() < 1e-12);
        let exact = rationals(&folder.text("middle.csv"));
        let float = folder.text("float.csv");
        let float = float.lines().skip(1).flat_map(|row| row.split(',')).map(|x| x.parse::<f64>().unwrap());
        assert!(float.zip(&exact).all(|(near, exact)| (near - exact.to_f64()).abs() < 1e-12));
    }
}

#[test]
fn points_outside_are_errors_or_counted() {
    let folder = Folder::new();
    folder.write("m.obj", torus(16, 8)).write("p.csv", "x,y,z\n9,9,9\n0,0,0\n");
    folder.line("shell m.obj -o m.homeo -q").expect(0);
    let run = folder.line("eval m.homeo --points p.csv").expect(3);
    assert!(run.stderr.contains("row 1") && run.stderr.contains("outside the shell"), "{}", run.stderr);
    for options in ["", "--inverse", "--exact", "--inverse --exact"] {
        let run = folder.line(&format!("eval m.homeo --points p.csv --outside nan {options}")).expect(0);
        assert!(run.stderr.contains("2 of 2 points"), "{}", run.stderr);
        assert_eq!(run.stdout, "x,y,z\nNaN,NaN,NaN\nNaN,NaN,NaN\n");
    }
    folder.write("flat.csv", "x,y\n1,0\n");
    let run = folder.line("eval m.homeo --points flat.csv").expect(3);
    assert!(run.stderr.contains("three coordinates"), "{}", run.stderr);
}

#[test]
fn unfit_meshes_are_refused_with_their_elements() {
    let moved = |[x, y, z]: [f64; 3], first: usize| {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let points = corners.map(|c| format!("v {} {} {}\n", c[0] + x, c[1] + y, c[2] + z)).concat();
        let face = |f: [usize; 3]| format!("f {} {} {}\n", f[0] + first, f[1] + first, f[2] + first);
        points + &[[1, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]].map(face).concat()
    };
    let two = |offset: [f64; 3]| moved([0.0; 3], 0) + &moved(offset, 4);
    let cases: [(&str, &str, &str, &str); 7] = [
        ("solid.mesh", &cubes(&[[0, 0, 0]]), "wrong-dimension", "tetrahedra"),
        ("quads.obj", &quads(2), "polygon-not-triangle", "--triangulate"),
        ("crossing.obj", &two([0.25, 0.125, 0.125]), "self-intersection", "cell"),
        ("touching.obj", &two([1.0, 0.0, 0.0]), "coincident-vertices", "vertex 4"),
        ("flipped.off", &CLOSED.replace("3 0 2 1", "3 0 1 2"), "inconsistent-orientation", "0"),
        ("empty.off", "OFF\n0 0 0\n", "no-elements", "neither"),
        ("cut.off", "OFF\n4 4 0\n0 0 0\n1 0", "unexpected-end", "cut.off"),
    ];
    for (name, content, code, words) in cases {
        let folder = Folder::new();
        let run = folder.write(name, content).homeo(&["shell", name, "-o", "m.homeo", "--layers", "m", "--json"]);
        let run = run.expect(3);
        assert_eq!(run.json()["error"]["code"], code, "{name}: {}", run.stdout);
        assert!(run.stderr.contains(words), "{name}: {}", run.stderr);
        assert_eq!(folder.names(), [name], "nothing is left behind");
    }
    let folder = Folder::new();
    folder.write("flipped.off", CLOSED.replace("3 0 2 1", "3 0 1 2"));
    folder.line("shell flipped.off --orient -o m.homeo -q").expect(0);
    folder.line("verify m.homeo --source flipped.off --orient -q").expect(0);
    folder.line("verify m.homeo --source flipped.off -q").expect(3);
}

/// Two tetrahedra that cross, as OBJ, the second moved.
fn two_tetrahedra(offset: [f64; 3]) -> String {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let moved = corners.map(|c: [f64; 3]| [0, 1, 2].map(|axis| c[axis] + offset[axis]));
    let points = corners.iter().chain(&moved).map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = [[1, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]];
    let faces = [0, 4].into_iter().flat_map(|first| faces.map(|face| face.map(|v| v + first)));
    points.chain(faces.map(|[a, b, c]| format!("f {a} {b} {c}\n"))).collect()
}

#[test]
fn surfaces_that_cross_themselves_need_the_option() {
    let folder = Folder::new();
    let crossing = two_tetrahedra([0.25, 0.125, 0.125]);
    folder.write("c.obj", &crossing);
    let run = folder.line("shell c.obj -o m.homeo").expect(3);
    assert!(run.stderr.contains("self-intersection") && run.stderr.contains("--immersed"), "{}", run.stderr);
    let made = folder.line("shell c.obj --immersed -o m.homeo --report m.html --json -q").expect(0).json();
    assert_eq!([&made["target"], &made["certificate"]["target"]], ["immersed-shell"; 2]);
    let statement = made["certificate"]["statement"].as_str().expect("a text");
    assert!(statement.contains("immersed shells") && statement.contains("abstract surfaces"), "{statement}");
    let verified = folder.line("verify m.homeo --source c.obj --json -q").expect(0).json();
    assert_eq!(verified["certificate"], made["certificate"]);
    folder.line("report m.homeo -o again.html -q").expect(0);
    assert!(["m.html", "again.html"].iter().all(|page| folder.text(page).contains("abstract surfaces")));
    folder.line("shell c.obj --immersed --embedded -o m.homeo").expect(2);
    for verb in ["simplify c.obj --to 50%", "remesh c.obj --edge 1"] {
        let run = folder.line(&format!("{verb} -o s.obj")).expect(3);
        assert!(run.stderr.contains("only `homeo shell --immersed`"), "{}", run.stderr);
    }
    let run = folder.line("transfer m.homeo --from c.obj --onto c.obj -o s.obj --json").expect(3);
    assert_eq!(run.json()["error"]["code"], "wrong-kind");
    assert!(run.stderr.contains("--immersed"), "{}", run.stderr);
}

#[test]
fn the_option_excuses_crossings_only() {
    for (content, code) in [
        (two_tetrahedra([1.0, 0.0, 0.0]), "coincident-vertices"),
        (CLOSED.replace("3 0 2 1", "3 0 1 2"), "inconsistent-orientation"),
    ] {
        let folder = Folder::new();
        let name = if content.starts_with("OFF") { "m.off" } else { "m.obj" };
        folder.write(name, &content);
        let run = folder.line(&format!("shell {name} --immersed -o m.homeo --json -q")).expect(3);
        assert_eq!(run.json()["error"]["code"], code);
    }
}

/// Where sheets cross, a point of space has no one image; elsewhere it has.
#[test]
fn points_in_two_sheets_are_ambiguous() {
    let folder = Folder::new();
    folder.write("c.obj", two_tetrahedra([0.25, 0.125, 0.125]));
    folder.line("shell c.obj --immersed --rounds 0 --thickness 0.01 -o m.homeo -q").expect(0);
    folder.write("apart.csv", "x,y,z\n0,0,0\n1,0,0\n0,1,0\n1.25,0.125,0.125\n0.25,0.125,1.125\n");
    folder.line("eval m.homeo --points apart.csv --exact -o middle.csv -q").expect(0);
    folder.line("eval m.homeo --points middle.csv --exact --inverse -o back.csv -q").expect(0);
    assert_eq!(rationals(&folder.text("back.csv")), rationals(&folder.text("apart.csv")));
    // On the slanted face of the first and the lower one of the second.
    folder.write("cross.csv", "x,y,z\n0.5,0.375,0.125\n");
    for options in ["", "--exact", "--outside nan"] {
        let run = folder.line(&format!("eval m.homeo --points cross.csv {options}")).expect(3);
        assert!(run.stderr.contains("row 1") && run.stderr.contains("overlap"), "{}", run.stderr);
    }
}

#[test]
fn an_open_surface_keeps_its_boundary() {
    let folder = Folder::new();
    folder.write("open.obj", torus(16, 8).replacen("f 1 9 10\n", "", 1));
    let run = folder.line("shell open.obj -o m.homeo --layers m --json").expect(0);
    assert!(run.json()["quality"]["prisms"].as_u64().is_some_and(|prisms| prisms < 255));
    folder.line("verify m.homeo --source open.obj -q").expect(0);
    folder.line("verify m.homeo --source m_middle.obj -q").expect(3);
}

#[test]
fn a_time_limit_gives_a_valid_shell_or_nothing() {
    let folder = Folder::new();
    folder.write("m.obj", torus(90, 40));
    for limit in ["0.000001", "0.1", "0.2", "0.4", "0.8", "1.6"] {
        let run = folder.line(&format!("shell m.obj -o m.homeo --layers m --json --timeout {limit}"));
        let report = run.json();
        if run.code == 0 {
            assert_eq!(report["certificate"]["holds"], true);
            assert_eq!(report["quality"]["cut_short"], run.stderr.contains("cut simplification short"));
            folder.line("verify m.homeo --source m.obj -q").expect(0);
            folder.names().iter().filter(|name| *name != "m.obj").for_each(|name| {
                std::fs::remove_file(folder.path(name)).unwrap();
            });
        } else {
            let report = run.expect(4).json();
            assert_eq!(report["error"]["code"], "timeout");
            assert_eq!(folder.names(), ["m.obj"]);
        }
    }
    let run = folder.line("shell m.obj -o m.homeo --json --memory 4K");
    if run.code != 0 {
        assert_eq!(run.expect(4).json()["error"]["code"], "memory");
        assert_eq!(folder.names(), ["m.obj"]);
    }
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let folder = Folder::new();
    folder.write("m.obj", torus(24, 10)).write("p.csv", vertices(&torus(24, 10)));
    for threads in ["1", "2"] {
        folder.line(&format!("shell m.obj -o {threads}.homeo --threads {threads} -q")).expect(0);
        folder.line(&format!("eval 1.homeo --points p.csv -o {threads}.csv --threads {threads} -q")).expect(0);
    }
    assert!(folder.read("1.homeo") == folder.read("2.homeo"), "the shells differ");
    assert_eq!(folder.text("1.csv"), folder.text("2.csv"));
}

#[test]
fn layers_are_meshes_and_limits_are_kept() {
    let folder = Folder::new();
    folder.write("m.obj", torus(24, 10));
    let all = folder.line("shell m.obj --rounds 0 --layers all --json -q").expect(0).json();
    assert_eq!(all["layers"], serde_json::json!(["all_bottom.obj", "all_middle.obj", "all_top.obj"]));
    assert_eq!((&all["quality"]["prisms"], &all["quality"]["rounds"]), (&480.into(), &0.into()));
    assert_eq!(folder.names(), ["all_bottom.obj", "all_middle.obj", "all_top.obj", "m.obj"]);
    let points = |name: &str| rationals(&vertices(&folder.text(name)));
    let sorted = |mut numbers: Vec<Rational>| {
        numbers.sort();
        numbers
    };
    assert_eq!(sorted(points("all_middle.obj")), sorted(points("m.obj")), "the middle is the source");
    for layer in ["bottom", "middle", "top"] {
        let info = folder.line(&format!("info all_{layer}.obj --json -q")).expect(0).json();
        assert_eq!((&info["triangles"], &info["closed"], &info["genus"]), (&480.into(), &true.into(), &1.into()));
    }
    let few = folder.line("shell m.obj --prisms 400 --json -q").expect(0).json();
    let prisms = few["quality"]["prisms"].as_u64().unwrap();
    assert!(prisms <= 400 && prisms > 300, "{prisms}");
    let text = folder.line("shell m.obj --thickness 0.01 -q").expect(0).stdout;
    assert!(text.contains("one-to-one and onto, proved") && text.contains("give -o FILE.homeo"), "{text}");
}

#[test]
fn an_embedded_shell_says_so_and_is_used_like_others() {
    let folder = Folder::new();
    folder.write("t.obj", torus(24, 10)).write("p.csv", vertices(&torus(24, 10)));
    let made = folder.line("shell t.obj --embedded -o t.homeo --layers t --json -q").expect(0).json();
    assert_eq!(made["certificate"]["target"], "embedded-shell");
    let said = folder.line("verify t.homeo --source t.obj").expect(0).stdout;
    assert!(said.contains("no point of space is in it twice") && said.contains("E1 and E2"), "{said}");
    for layer in ["t_bottom.obj", "t_top.obj"] {
        let info = folder.line(&format!("info {layer} --intersections --json -q")).expect(0).json();
        assert_eq!(info["self_intersections"], 0);
    }
    folder.line("eval t.homeo --points p.csv --exact -o m.csv").expect(0);
    folder.line("report t.homeo -o t.html -q").expect(0);
    folder.line("transfer t.homeo --from t.obj --onto t.obj -o same.ply -q").expect(0);
}

#[test]
fn what_is_to_stay_stays() {
    let folder = Folder::new();
    folder.write("t.obj", torus(24, 10)).write("keep.json", "[0, 17, 200]").write("no.json", "[0, 17000]");
    folder.write("not.json", "{}");
    let line = "shell t.obj --frozen keep.json --features 60 --largest-angle 60 -o t.homeo --layers t --json -q";
    let report = folder.line(line).expect(0).json();
    let angle = report["quality"]["largest_angle"].as_f64().unwrap();
    assert!(angle < 60.0 + 1e-9, "{angle}");
    let (source, middle) = (torus(24, 10), folder.text("t_middle.obj"));
    let point = |line: &str| -> Vec<f64> { line[2..].split(' ').map(|x| x.parse().unwrap()).collect() };
    let points = |obj: &str| -> Vec<Vec<f64>> { obj.lines().filter(|l| l.starts_with("v ")).map(point).collect() };
    let middle = points(&middle);
    assert!([0, 17, 200].iter().all(|&v: &usize| middle.contains(&points(&source)[v])));
    let refused = folder.line("shell t.obj --frozen no.json -o no.homeo --json -q").expect(3).json();
    assert_eq!((&refused["error"]["code"], &refused["elements"]), (&"frozen".into(), &serde_json::json!([17000])));
    folder.line("shell t.obj --frozen not.json -o no.homeo").expect(3);
    assert!(!folder.names().contains(&"no.homeo".to_owned()));
}

#[test]
fn a_page_shows_the_shell() {
    for (obj, pinched) in [(torus(24, 10), 0), (singular(), 1), (torus(16, 8).replacen("f 1 9 10\n", "", 1), 0)] {
        let folder = Folder::new();
        folder.write("m.obj", &obj);
        let made = folder.line("shell m.obj -o m.homeo --report made.html --json -q").expect(0).json();
        assert!(made["seconds"]["report"].is_number());
        let report = folder.line("report m.homeo -o m.html --json -q").expect(0).json();
        assert_eq!((&report["output"], &report["certificate"]), (&"m.html".into(), &made["certificate"]));
        assert_eq!(report["quality"]["prisms"], made["quality"]["prisms"]);
        let facts = |page: &str| {
            let from = page.find("<section id=\"facts\">").unwrap();
            page[from..from + page[from..].find("</table>").unwrap()].to_owned()
        };
        let (page, first) = (folder.text("m.html"), folder.text("made.html"));
        assert_eq!(facts(&page), facts(&first), "the page of the file is that of the shell");
        assert!(page.contains("One-to-one and onto the middle surface, proved") && page.contains("id=\"distortion\""));
        let fact = |label: &str, value: &str| {
            let row = format!("<th scope=\"row\">{label}</th><td>{value}");
            assert!(page.contains(&row), "{row} is missing in {}", facts(&page));
        };
        fact("triangles", &made["input"]["triangles"].to_string());
        fact("prisms", &made["quality"]["prisms"].to_string());
        fact("columns pinched to a point", &pinched.to_string());
        fact("components", "1");
        fact("largest thickness", "0.");
        let same = folder.line("shell m.obj -o same.html --report same.html").expect(2);
        assert!(same.stderr.contains("two outputs"), "{}", same.stderr);
    }
}

#[test]
fn wrong_usage_is_told_apart() {
    let folder = Folder::new();
    folder.write("m.obj", CLOSED);
    for options in [
        "--thickness 0",
        "--thickness -1",
        "--thickness nan",
        "--thickness inf",
        "--prisms -1",
        "--largest-angle 91",
        "--features -1",
        "-o m.obj",
        "-o nowhere/m.homeo",
        "--layers nowhere/m",
        "-o m_top.obj --layers m",
        "--onto cube",
    ] {
        folder.line(&format!("shell m.obj {options}")).expect(2);
    }
    folder.line("shell").expect(2);
    assert_eq!(folder.names(), ["m.obj"]);
}
