//! `homeo bundle`: what it writes, what it refuses, and what the checker says of it.

mod common;

use common::{CLOSED, Folder, cubes, quads, torus};
use homeo_core::mesh::TetrahedronComplex;
use homeo_manifold::{Homology, Triangulation, read_record};
use serde_json::Value;

fn rows<const K: usize>(value: &Value) -> Vec<[u32; K]> {
    let number = |value: &Value| value.as_u64().unwrap() as u32;
    let row = |row: &Value| std::array::from_fn(|k| number(&row[k]));
    value.as_array().unwrap().iter().map(row).collect()
}

#[test]
fn bundles_are_proved_and_reported() {
    for (mesh, genus, h1) in [(CLOSED.to_owned(), 0, "Z_2"), (torus(5, 4), 1, "3 Z")] {
        let folder = Folder::new();
        let name = if genus == 0 { "m.off" } else { "m.obj" };
        folder.write(name, mesh);
        let report = folder.line(&format!("bundle {name} --layers 5 -o b.homeo --json -q")).expect(0).json();
        let (bundle, certificate) = (&report["bundle"], &report["certificate"]);
        assert_eq!((&bundle["genus"], &bundle["euler_number"]), (&genus.into(), &(2 - 2 * genus).into()));
        assert_eq!((&bundle["layers"], &bundle["h1"]), (&5.into(), &h1.into()));
        assert_eq!((&certificate["kind"], &certificate["holds"]), (&"unit-tangent-bundle".into(), &true.into()));
        for stage in ["read", "check", "bundle", "homology", "write", "certificate", "total"] {
            assert!(report["seconds"][stage].is_number(), "{stage} is missing in {}", report["seconds"]);
        }
        let verified = folder.line("verify b.homeo --json -q").expect(0).json();
        assert_eq!(&verified["certificate"], certificate);
        assert_eq!(verified["input"]["triangles"], bundle["base"]["triangles"]);
        folder.line(&format!("verify b.homeo --source {name} -q")).expect(2);
        assert!(folder.line("verify b.homeo").expect(0).stdout.contains("unit tangent"));
    }
}

#[test]
fn both_forms_of_json_hold_the_same_manifold() {
    let folder = Folder::new();
    folder.write("m.off", CLOSED);
    let report = folder.line("bundle m.off --layers 4 -o b.json --json -q").expect(0).json();
    let json: Value = serde_json::from_str(&folder.text("b.json")).unwrap();
    let (tets, base, slopes) = (rows::<4>(&json["tets"]), rows::<3>(&json["base"]), rows::<3>(&json["slopes"]));
    assert_eq!((json["layers"].as_u64(), json["euler_number"].as_i64()), (Some(4), Some(2)));
    assert_eq!((tets.len(), slopes.len()), (12 * base.len(), base.len()));
    assert_eq!(json["parents"].as_array().unwrap().len(), base.len());
    let count = json["vertices"].as_u64().unwrap() as usize;
    assert_eq!(count, 4 * (4 + json["added"].as_array().unwrap().len()));
    assert_eq!(report["bundle"]["vertices"], count);
    let complex = TetrahedronComplex::from_indices(count, &tets).unwrap();
    let homology = Homology::new(&Triangulation::from_complex(&complex).unwrap());
    folder.line("bundle m.off --layers 4 --gluings -o g.json -q").expect(0);
    let record = read_record(&folder.text("g.json")).unwrap().triangulation;
    assert_eq!((record.len(), record.is_closed()), (tets.len(), true));
    assert_eq!((homology.to_string(), Homology::new(&record)), ("Z_2".to_owned(), homology));
}

#[test]
fn meshes_keep_base_and_level_as_attributes() {
    let folder = Folder::new();
    folder.write("m.obj", torus(4, 4));
    folder.line("bundle m.obj --layers 3 -o b.vtu -q").expect(0);
    let mesh = homeo_core::io::read_mesh(&folder.path("b.vtu")).unwrap();
    assert_eq!((mesh.vertex_count, mesh.tetrahedra.len()), (48, 288));
    assert_eq!(mesh.positions[3..6], [mesh.positions[3]; 3]);
    let names: Vec<&str> = mesh.attributes.iter().map(|attribute| attribute.name.as_str()).collect();
    assert!(names.contains(&"base") && names.contains(&"level"), "{names:?}");
}

#[test]
fn files_do_not_depend_on_threads() {
    let folder = Folder::new();
    folder.write("m.obj", torus(9, 7));
    for extension in ["json", "homeo"] {
        let make = |threads: usize| {
            folder.line(&format!("bundle m.obj -o b.{extension} --threads {threads} -q")).expect(0);
            folder.read(&format!("b.{extension}"))
        };
        assert_eq!(make(1), make(3));
    }
}

#[test]
fn what_is_no_closed_oriented_surface_is_refused_with_its_elements() {
    let closed = CLOSED.to_owned();
    let two = closed.replace("4 4 0", "8 8 0").replacen("0 0 1\n", "0 0 1\n5 0 0\n6 0 0\n5 1 0\n5 0 1\n", 1)
        + "3 4 6 5\n3 4 5 7\n3 5 6 7\n3 6 4 7\n";
    let cases = [
        ("open", closed.replace("4 4 0", "4 3 0").replace("3 2 0 3\n", ""), "not-a-closed-surface"),
        ("turned", closed.replace("3 2 0 3", "3 0 2 3"), "inconsistent-orientation"),
        ("two", two, "not-a-closed-surface"),
        ("isolated", closed.replace("4 4 0", "5 4 0").replace("0 0 1\n", "0 0 1\n9 9 9\n"), "isolated-vertex"),
    ];
    for (name, off, code) in cases {
        let folder = Folder::new();
        folder.write("m.off", off);
        let report = folder.line("bundle m.off -o b.json --json -q").expect(3).json();
        assert_eq!(report["error"]["code"], code, "{name}: {}", report["error"]["message"]);
        assert!(report["error"]["message"].as_str().unwrap().chars().any(|c| c.is_ascii_digit()), "{name}");
        assert_eq!(folder.names(), ["m.off"], "{name}");
    }
    let folder = Folder::new();
    folder.write("v.mesh", cubes(&[[0, 0, 0]])).write("q.obj", quads(2)).write("m.off", closed);
    assert_eq!(folder.line("bundle v.mesh --json -q").expect(3).json()["error"]["code"], "wrong-dimension");
    assert_eq!(folder.line("bundle q.obj --json -q").expect(3).json()["error"]["code"], "polygon-not-triangle");
    // Room for these was asked for at once, and the program was ended by the system.
    let large = folder.line("bundle m.off --layers 1000000 --json -q").expect(4).json();
    assert_eq!(large["error"]["code"], "too-large");
    for line in ["bundle m.off --layers 2", "bundle m.off -o b.obj", "bundle m.off --gluings -o b.vtu"] {
        folder.line(line).expect(2);
    }
}

/// The field of a constant vector on a torus, and its section as it is written: each fibre is met once, paths are paths of
/// edges, and indices add up to 0.
#[test]
fn fields_become_sections() {
    let folder = Folder::new();
    let vectors = |count: usize| format!("x,y,z\n{}", "1,0.31,0.17\n".repeat(count));
    folder.write("m.obj", torus(9, 7)).write("f.csv", vectors(63)).write("short.csv", vectors(62));
    let report = folder
        .line("bundle m.obj --layers 5 --field f.csv -o b.json --indices i.vtu --report p.html --json -q")
        .expect(0)
        .json();
    let field = &report["field"];
    assert_eq!((&field["sum"], &field["euler_characteristic"]), (&0.into(), &0.into()));
    let singular = field["singular_triangles"].as_array().unwrap();
    let squares: i64 = singular.iter().map(|one| one["index"].as_i64().unwrap().pow(2)).sum();
    assert!(squares >= 4, "{field}");
    let json: Value = serde_json::from_str(&folder.text("b.json")).unwrap();
    let edges: std::collections::HashSet<[u64; 2]> = rows::<4>(&json["tets"])
        .iter()
        .flat_map(|four| four.iter().flat_map(|&a| four.iter().map(move |&b| [u64::from(a), u64::from(b)])))
        .collect();
    let levels = json["section"]["levels"].as_array().unwrap();
    assert_eq!(levels.len() * 5, json["vertices"].as_u64().unwrap() as usize);
    let mut count = 0;
    for path in json["section"]["paths"].as_array().unwrap() {
        let path: Vec<u64> = path.as_array().unwrap().iter().map(|v| v.as_u64().unwrap()).collect();
        assert!(path.windows(2).all(|step| edges.contains(&[step[0], step[1]])), "{path:?}");
        for end in [path[0], path[path.len() - 1]] {
            assert_eq!(levels[end as usize / 5], end % 5);
        }
        count += 1;
    }
    assert_eq!(count, json["base"].as_array().unwrap().len() * 3 / 2);
    let surface = homeo_core::io::read_mesh(&folder.path("i.vtu")).unwrap();
    assert!(surface.attributes.iter().any(|attribute| attribute.name == "index"));
    assert!(folder.text("p.html").contains("sum of its indices"));
    // The field that the surface carries now gives the same.
    let again = folder.line("bundle i.vtu --layers 5 --field field --json -q").expect(0).json();
    assert_eq!(again["field"]["singular_triangles"], field["singular_triangles"]);
    folder.line("bundle m.obj --layers 5 --field f.csv -o b.vtu -q").expect(0);
    let mesh = homeo_core::io::read_mesh(&folder.path("b.vtu")).unwrap();
    let section = mesh.attributes.iter().find(|attribute| attribute.name == "section").unwrap();
    let homeo_core::io::Values::I64(met) = &section.values else { panic!("{section:?}") };
    assert!(met.chunks(5).all(|fibre| fibre.iter().sum::<i64>() == 1));
}

/// The section is in the map file, and the checker finds it there.
#[test]
fn map_files_hold_the_section() {
    let folder = Folder::new();
    folder.write("m.obj", torus(9, 7)).write("f.csv", format!("x,y,z\n{}", "1,0.31,0.17\n".repeat(63)));
    let report = folder.line("bundle m.obj --layers 5 --field f.csv -o b.homeo --json -q").expect(0).json();
    let verified = folder.line("verify b.homeo --json -q").expect(0).json();
    assert_eq!(verified["certificate"], report["certificate"]);
    assert_eq!(verified["certificate"]["target"], "unit-tangent-bundle-with-section");
    let (checked, paths) = (&verified["certificate"]["checked"], &report["field"]["checked"]["paths"]);
    assert_eq!(&checked["paths over edges between them (rule T9)"], paths, "{checked}");
    assert!(paths.as_u64().unwrap() >= 189);
}

/// A vector for each triangle: indices are at vertices, and the field that `--indices` writes is read again.
#[test]
fn vectors_on_triangles_become_sections() {
    let folder = Folder::new();
    folder.write("m.obj", torus(9, 7)).write("f.csv", format!("x,y,z\n{}", "1,0.31,0.17\n".repeat(126)));
    let options = "--layers 5 --field f.csv --indices i.vtu --report p.html --json -q";
    let report = folder.line(&format!("bundle m.obj -o b.homeo {options}")).expect(0).json();
    let field = &report["field"];
    assert_eq!((&field["vectors"], &field["sum"]), (&"triangles".into(), &0.into()));
    assert_eq!(field["singular_triangles"].as_array().unwrap().len(), 0);
    let singular = field["singular_vertices"].as_array().unwrap();
    assert!(singular.len() >= 4 && singular.iter().all(|one| one["vertex"].as_u64().unwrap() < 63), "{field}");
    let base = &report["bundle"]["base"];
    assert_eq!((&base["middles"], &base["triangles"]), (&126.into(), &378.into()));
    let verified = folder.line("verify b.homeo --json -q").expect(0).json();
    assert_eq!(verified["certificate"]["target"], "unit-tangent-bundle-with-section");
    assert!(folder.text("p.html").contains("sum of its indices"));
    let again = folder.line("bundle i.vtu --layers 4 --field field -o b.json --json -q").expect(0).json();
    assert_eq!(again["field"]["singular_vertices"], field["singular_vertices"]);
    let json: Value = serde_json::from_str(&folder.text("b.json")).unwrap();
    assert_eq!((json["middles"].as_u64(), json["vertices"].as_u64()), (Some(126), Some(4 * 189)));
}

#[test]
fn fields_that_do_not_fit_are_refused() {
    let folder = Folder::new();
    folder
        .write("m.obj", torus(5, 4))
        .write("short.csv", "x,y,z\n1,2,3\n")
        .write("zero.csv", format!("x,y,z\n{}", "0,0,0\n".repeat(20)))
        .write("flat.csv", format!("x,y\n{}", "1,0.3\n".repeat(20)));
    let triangles = "1,0.3,0.2\n".repeat(39);
    folder.write("still.csv", format!("x,y,z\n{triangles}0,0,0\n"));
    let cases = [
        ("short.csv", "20 vertices and 40 triangles"),
        ("flat.csv", "2 columns"),
        ("zero.csv", "neighbours"),
        ("still.csv", "triangle 39"),
        ("wind", "no field of the name"),
    ];
    for (name, word) in cases {
        let report = folder.line(&format!("bundle m.obj --field {name} -o b.json --json -q")).expect(3).json();
        assert_eq!(report["error"]["code"], "unfit-field");
        let message = report["error"]["message"].as_str().unwrap();
        assert!(message.contains(word), "{message}");
    }
    assert!(!folder.names().contains(&"b.json".to_owned()));
    for line in ["bundle m.obj --indices i.ply", "bundle m.obj --field zero.csv --indices i.obj"] {
        folder.line(line).expect(2);
    }
}

/// A second output of the same name took the place of the first, and the page that of the file with the field.
#[test]
fn outputs_take_no_others_place() {
    let folder = Folder::new();
    let field = format!("x,y,z\n{}", "1,0.31,0.17\n".repeat(20));
    folder.write("m.obj", torus(5, 4)).write("f.csv", &field);
    for outputs in ["-o b.vtu --indices b.vtu", "-o b.json --report ./b.json", "--report f.csv", "--indices m.obj"] {
        folder.line(&format!("bundle m.obj --field f.csv {outputs}")).expect(2);
        assert_eq!(
            (folder.names(), folder.text("f.csv")),
            (vec!["f.csv".to_owned(), "m.obj".to_owned()], field.clone())
        );
    }
}
