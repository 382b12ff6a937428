//! `homeo compose`: under one map and back under another.

mod common;

use common::{Folder, cubes, rationals};
use homeo_core::io::{Attribute, Element, MeshFile, Values, WriteOptions, read_mesh, write_mesh};

/// A folder with two maps of one row of cubes onto the cube, and one of another row.
fn mapped() -> Folder {
    let folder = Folder::new();
    folder.write("two.mesh", cubes(&[[0, 0, 0], [1, 0, 0]]));
    folder.write("three.mesh", cubes(&[[0, 0, 0], [0, 1, 0], [0, 2, 0]]));
    folder.line("map two.mesh --onto cube -o a.homeo -q").expect(0);
    folder.line("map three.mesh --onto cube -o b.homeo -q").expect(0);
    folder.write("p.csv", "x,y,z\n0.25,0.5,0.125\n1.75,0.3,0.9\n1,1,1\n");
    folder
}

#[test]
fn there_and_back_is_the_identity_exactly() {
    let folder = mapped();
    folder.line("compose a.homeo b.homeo --points p.csv --exact -o q.csv -q").expect(0);
    folder.line("compose b.homeo a.homeo --points q.csv --exact -o back.csv -q").expect(0);
    folder.line("compose a.homeo a.homeo --points p.csv --exact -o same.csv -q").expect(0);
    assert_ne!(folder.text("q.csv"), folder.text("back.csv"));
    assert_eq!(folder.text("back.csv"), folder.text("same.csv"));
    assert_eq!(folder.text("same.csv").lines().nth(1), Some("1/4,1/2,1/8"));
}

#[test]
fn floating_answers_are_near_the_exact_ones_and_in_the_other_mesh() {
    let folder = mapped();
    let report = folder.line("compose a.homeo b.homeo --points p.csv -o q.npy --json -q").expect(0).json();
    assert_eq!(report["points"], 3);
    assert!(report["error"]["max_radius_between"].as_f64().unwrap() < 1e-6);
    assert_eq!(report["certificates"].as_array().unwrap().len(), 2);
    folder.line("compose b.homeo a.homeo --points q.npy -o back.csv -q").expect(0);
    let numbers = |text: String| -> Vec<f64> {
        text.lines().skip(1).flat_map(|row| row.split(',').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()).collect()
    };
    let pairs = numbers(folder.text("back.csv")).into_iter().zip(numbers(folder.text("p.csv")));
    assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-6));
}

#[test]
fn points_outside_and_maps_that_do_not_fit_are_told() {
    let folder = mapped();
    folder.write("out.csv", "x,y,z\n0.5,0.5,0.5\n5,5,5\n");
    let refused = folder.line("compose a.homeo b.homeo --points out.csv -o q.csv").expect(3);
    assert!(refused.stderr.contains("row 2") && !folder.path("q.csv").exists());
    let counted = folder.line("compose a.homeo b.homeo --points out.csv --outside nan -q").expect(0);
    assert!(counted.stdout.lines().nth(2).unwrap().contains("NaN"));
    folder.line("map two.mesh --onto ball -o ball.homeo -q").expect(0);
    let refused = folder.line("compose a.homeo ball.homeo --points p.csv").expect(3);
    assert!(refused.stderr.contains("the ball"), "{}", refused.stderr);
}

/// A square of `n` by `n` quads, each cut in two, that bulges; the first corner and the coordinates are dyadic. The
/// texture jumps by 10 at the line x = 1/2.
fn patch(n: usize, is_textured: bool) -> String {
    let at = |i: usize| i as f64 / n as f64;
    let mut text = String::new();
    for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
        text += &format!("v {} {} {}\n", at(i), at(j), at(i) * (1.0 - at(i)) * at(j));
    }
    for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))).filter(|_| is_textured) {
        text += &format!("vt {} {}\nvt {} {}\n", at(i), at(j), at(i) + 10.0, at(j));
    }
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let number = |i: usize, j: usize| i * (n + 1) + j + 1;
        let quad = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        for corners in [[0, 1, 2], [0, 2, 3]] {
            let texture = |v: usize| 2 * v - usize::from(2 * i < n);
            let corner = |k: usize| match is_textured {
                true => format!(" {}/{}", quad[k], texture(quad[k])),
                false => format!(" {}", quad[k]),
            };
            text += &format!("f{}\n", corners.map(corner).concat());
        }
    }
    text
}

/// Two patches and their maps onto the disk; the first also with its places as a field, and with labels of triangles.
fn patches() -> Folder {
    let folder = Folder::new();
    folder.write("a.obj", patch(8, true)).write("b.obj", patch(4, false));
    folder.line("map a.obj --onto disk -o a.homeo -q").expect(0);
    folder.line("map b.obj --onto disk -o b.homeo -q").expect(0);
    let mesh = read_mesh(&folder.path("a.obj")).unwrap();
    let places = Values::F64(mesh.positions.iter().flatten().copied().collect());
    let is_right =
        |polygon: &[u32]| i64::from(polygon.iter().map(|&v| mesh.positions[v as usize][0]).sum::<f64>() > 1.5);
    let sides = Values::I64(mesh.polygons.iter().map(is_right).collect());
    let attribute =
        |name: &str, element, components, values| Attribute { name: name.to_owned(), element, components, values };
    let attributes =
        vec![attribute("place", Element::Vertex, 3, places), attribute("side", Element::Polygon, 1, sides)];
    let fields = MeshFile { attributes, ..mesh.clone() };
    write_mesh(&folder.path("fields.vtu"), &fields, &WriteOptions::default()).unwrap();
    folder
}

fn doubles(mesh: &MeshFile, name: &str, element: Element) -> Vec<f64> {
    match &mesh.attribute(name, element).unwrap_or_else(|| panic!("{name} is missing")).values {
        Values::F64(values) => values.clone(),
        Values::F32(values) => values.iter().map(|&x| x.into()).collect(),
        Values::I64(values) => values.iter().map(|&x| x as f64).collect(),
        Values::Text(_) => panic!("{name} is text"),
    }
}

fn mesh(folder: &Folder, name: &str) -> MeshFile {
    read_mesh(&folder.path(name)).unwrap()
}

/// Points under B and back under A, exactly.
fn places_in_a(folder: &Folder, rows: impl Iterator<Item = String>) -> Vec<[f64; 3]> {
    folder.write("rows.csv", "x,y,z\n".to_owned() + &rows.collect::<String>());
    folder.line("compose b.homeo a.homeo --points rows.csv --exact -o places.csv -q").expect(0);
    let numbers = rationals(&folder.text("places.csv"));
    numbers.chunks_exact(3).map(|row| [0, 1, 2].map(|k| row[k].to_f64())).collect()
}

#[test]
fn fields_are_those_of_the_corresponding_places() {
    let folder = patches();
    let line = "compose a.homeo b.homeo --from fields.vtu --onto b.obj -o out.vtu --json -q";
    let report = folder.line(line).expect(0).json();
    assert_eq!(report["transfer"][0]["name"], "place");
    let bytes = folder.read("out.vtu");
    for threads in [1, 2] {
        folder.line(&format!("{line} --threads {threads}")).expect(0);
        assert_eq!(folder.read("out.vtu"), bytes, "{threads} threads");
    }
    let (b, out) = (mesh(&folder, "b.obj"), mesh(&folder, "out.vtu"));
    assert_eq!((&out.positions, &out.polygons), (&b.positions, &b.polygons));
    let expected = places_in_a(&folder, b.positions.iter().map(|[x, y, z]| format!("{x},{y},{z}\n")));
    let (found, own) = (doubles(&out, "place", Element::Vertex), b.positions.as_flattened());
    let farthest = |other: &[f64]| other.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(farthest(expected.as_flattened()) < 1e-14, "{:e}", farthest(expected.as_flattened()));
    // The control: the maps do something.
    assert!(farthest(own) > 0.01, "{}", farthest(own));

    let middle = |polygon: &[u32]| {
        let thirds = |axis: usize| {
            // Of eighths squared: whole numbers in floating point.
            let sum: f64 = polygon.iter().map(|&v| b.positions[v as usize][axis] * 512.0).sum();
            format!("{sum}/1536")
        };
        format!("{},{},{}\n", thirds(0), thirds(1), thirds(2))
    };
    let middles = places_in_a(&folder, b.polygons.iter().map(middle));
    let sides: Vec<f64> = middles.iter().map(|p| f64::from(u8::from(p[0] > 0.5))).collect();
    assert_eq!(doubles(&out, "side", Element::Polygon), sides);
    let right = sides.iter().filter(|side| **side == 1.0).count();
    assert!((4..28).contains(&right) && sides.len() == 32, "{right} of {}", sides.len());
}

#[test]
fn the_identity_returns_fields_bit_for_bit_and_keeps_what_is_there() {
    let folder = patches();
    folder.line("compose a.homeo a.homeo --from fields.vtu --onto a.obj --status -o same.vtu -q").expect(0);
    let (before, after) = (mesh(&folder, "fields.vtu"), mesh(&folder, "same.vtu"));
    for (name, element) in [("place", Element::Vertex), ("side", Element::Polygon)] {
        assert_eq!(after.attribute(name, element).unwrap().values, before.attribute(name, element).unwrap().values);
        let status = doubles(&after, &format!("{name}_status"), element);
        assert!(!status.is_empty() && status.iter().all(|status| *status == 0.0));
    }
    let line = "compose a.homeo a.homeo --from fields.vtu --onto fields.vtu -o both.vtu --json -q";
    assert_eq!(folder.line(line).expect(0).json()["renamed"], serde_json::json!(["place", "side"]));
    let both = mesh(&folder, "both.vtu");
    assert_eq!(doubles(&both, "place", Element::Vertex), doubles(&both, "from_place", Element::Vertex));
}

#[test]
fn texture_keeps_to_its_side_of_a_seam() {
    let folder = patches();
    folder.line("compose a.homeo a.homeo --from a.obj --onto fields.vtu -o same.obj -q").expect(0);
    let (before, after) = (mesh(&folder, "a.obj"), mesh(&folder, "same.obj"));
    let texture = |mesh: &MeshFile| doubles(mesh, "texture", Element::Corner);
    assert_eq!(texture(&after), texture(&before));
    // The control: vertices on the seam have two values, so that one for each vertex would not do.
    let jumps = |mesh: &MeshFile| {
        let rows: Vec<f64> = texture(mesh).chunks_exact(2).map(|row| row[0]).collect();
        let corners = &mesh.polygons.corners;
        (0..rows.len()).filter(|&i| (0..i).any(|j| corners[i] == corners[j] && rows[i] != rows[j])).count()
    };
    assert!(jumps(&before) >= 9, "{}", jumps(&before));

    let report = folder.line("compose a.homeo b.homeo --from a.obj --onto b.obj -o out.obj --json -q").expect(0).json();
    let split = report["transfer"][0]["split"].as_u64().unwrap();
    assert!((3..96).contains(&split) && split.is_multiple_of(3), "{report}");
    let b = mesh(&folder, "b.obj");
    let places = places_in_a(&folder, b.positions.iter().map(|[x, y, z]| format!("{x},{y},{z}\n")));
    let out = mesh(&folder, "out.obj");
    for (corner, row) in texture(&out).chunks_exact(2).enumerate() {
        let [x, y, _] = places[out.polygons.corners[corner] as usize];
        let right = if row[0] > 5.0 { 10.0 } else { 0.0 };
        assert!((row[0] - right - x).abs() < 1e-13 && (row[1] - y).abs() < 1e-13, "{corner}: {row:?} {x} {y}");
        assert!(x == 0.5 || (x > 0.5) == (right == 10.0), "{corner}: {row:?} {x}");
    }
}

#[test]
fn other_meshes_and_volumes_are_refused() {
    let folder = patches();
    let moved = folder.text("a.obj").replacen("v 0 0 0", "v 0 0 0.001", 1);
    folder.write("moved.obj", moved);
    for meshes in ["--from b.obj --onto b.obj", "--from a.obj --onto a.obj", "--from moved.obj --onto b.obj"] {
        let refused = folder.line(&format!("compose a.homeo b.homeo {meshes} -o no.vtu --json")).expect(3).json();
        assert_eq!(refused["error"]["code"], "other-mesh", "{meshes}");
    }
    folder.line("map b.obj --onto square -o square.homeo -q").expect(0);
    let line = "--from a.obj --onto b.obj -o no.vtu --json";
    assert_eq!(
        folder.line(&format!("compose a.homeo square.homeo {line}")).expect(3).json()["error"]["code"],
        "targets"
    );
    folder.write("two.mesh", cubes(&[[0, 0, 0], [1, 0, 0]]));
    folder.line("map two.mesh --onto cube -o two.homeo -q").expect(0);
    let line = "compose two.homeo two.homeo --from two.mesh --onto two.mesh -o no.vtu --json";
    assert_eq!(folder.line(line).expect(3).json()["error"]["code"], "wrong-kind");
    folder.line("compose a.homeo b.homeo --from a.obj -o no.vtu").expect(2);
    // These are of points: they were taken, and did nothing.
    for option in ["--exact", "--outside nan"] {
        folder.line(&format!("compose a.homeo b.homeo --from a.obj --onto b.obj -o no.vtu {option}")).expect(2);
    }
    folder.line("compose a.homeo b.homeo --from a.obj --onto b.obj -o no.csv").expect(2);
    folder.line("compose a.homeo b.homeo").expect(2);
    assert!(folder.names().iter().all(|name| !name.starts_with("no.")));
}
