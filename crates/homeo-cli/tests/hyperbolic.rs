//! `homeo hyperbolic`: metrics with their certificates, and refusals by their kind.

mod common;

use common::{Folder, cubes};
use homeo_manifold::{Links, Skeleton, Triangulation, from_signature, record::write_record, subdivision::subdivided};
use serde_json::{Value, json};

const TRIPUS: &str = "testdata/hyperbolic/tripus.json";
const CENSUS: &str = "testdata/hyperbolic/census.json";
/// Of all manifolds of two tetrahedra of this kind.
const VOLUME: f64 = 6.451990270835033;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// The volume, which must be in its bounds.
fn volume(answer: &Value) -> f64 {
    let volume = &answer["metric"]["volume"];
    let [low, value, high] = ["low", "value", "high"].map(|key| number(&volume[key]));
    assert!(low < value && value < high && high - low < 1e-9, "{volume}");
    value
}

#[test]
fn the_tripus_has_its_known_metric_and_a_certificate() {
    let folder = Folder::new().with_testdata();
    let answer = folder.line(&format!("hyperbolic {TRIPUS} -o tripus.homeo --json")).expect(0).json();
    assert!((volume(&answer) - VOLUME).abs() < 1e-12);
    let angles = answer["metric"]["dihedral_angles"].as_array().unwrap();
    assert_eq!(angles.len(), 2);
    for angle in angles.iter().flat_map(|row| row.as_array().unwrap()) {
        assert!((number(angle) - std::f64::consts::FRAC_PI_6).abs() < 1e-12, "{angle}");
    }
    let length = &answer["metric"]["edge_lengths"][0];
    assert!(number(&length["low"]) < 0.5961338948908373 && number(&length["high"]) > 0.5961338948908373);
    let triangulation =
        json!({"tetrahedra": 2, "signature": "cPcbbbihq", "h1": "2 Z", "boundary_genera": [2], "edge_degrees": [12]});
    assert_eq!(answer["triangulation"], triangulation);
    assert_eq!((&answer["certificate"]["kind"], &answer["certificate"]["holds"]), (&json!("hyperbolic"), &json!(true)));
    let claim = folder.line("verify tripus.homeo --json").expect(0).json();
    assert_eq!(claim["certificate"], answer["certificate"]);
}

#[test]
fn the_metric_is_that_of_the_census_for_every_entry() {
    let folder = Folder::new().with_testdata();
    let census: Value = serde_json::from_slice(&folder.read(CENSUS)).unwrap();
    let (mut metrics, mut refusals) = (0, 0);
    for record in census["triangulations"].as_array().unwrap() {
        let signature = record["isoSig"].as_str().unwrap();
        let run = folder.line(&format!("hyperbolic {CENSUS} --entry {signature} -o out.homeo --json"));
        if record["status"] == "positive" {
            let answer = run.expect(0).json();
            assert!((volume(&answer) - number(&record["volume"])).abs() < 1e-10, "{signature}");
            assert_eq!(answer["triangulation"]["edge_degrees"], record["edgeDegrees"]);
            std::fs::remove_file(folder.path("out.homeo")).unwrap();
            metrics += 1;
        } else {
            let answer = run.expect(3).json();
            assert_eq!(answer["error"]["code"], "no-metric", "{signature}");
            assert_eq!(answer["refusal"]["proved"], true, "{signature}");
            refusals += 1;
        }
        assert!(!folder.path("out.homeo").exists(), "{signature}");
    }
    assert!(metrics >= 10 && refusals >= 6, "{metrics} {refusals}");
}

#[test]
fn refusals_say_why_and_write_nothing() {
    let folder = Folder::new().with_testdata();
    let refused = |entry: &str, more: &str, code: i32, words: &[&str]| {
        let before = folder.names();
        let run = folder.line(&format!("hyperbolic {CENSUS} --entry {entry} -o out.homeo {more}")).expect(code);
        words.iter().for_each(|word| assert!(run.stderr.contains(word), "{word}: {}", run.stderr));
        assert_eq!(folder.names(), before);
    };
    // A handle body, with an edge of degree 1.
    refused("dLQabccbjcn", "", 3, &["free of rank 2", "edge 0 has degree 1"]);
    refused("dLQacccjcoc", "", 3, &["edge 1 has degree 2", "--retriangulate"]);
    // A trap: curvatures tend to 0 with a length that grows.
    refused("dLQacccjkfr", "", 3, &["the weights [0, 1] of the edges prove it"]);
    refused("dLQacccjkfr", "--retriangulate --tries 5", 4, &["proves nothing of the manifold", "--tries"]);
}

#[test]
fn bad_input_is_named() {
    let folder = Folder::new().with_testdata();
    folder.write("broken.json", r#"{"tetrahedra": 1, "gluings": [[0, 0, 0, [1, 0, 2, 3]]]}"#);
    folder.write("twice.json", r#"{"tetrahedra": 1, "gluings": [[0, 0, 0, [1, 1, 2, 3]]]}"#);
    folder.write("cut.json", r#"{"tetrahedra": 1, "#).write("signature.txt", "cPcbbbihqx\n");
    let cases = [
        ("broken.json", "row 0 is not given from its other side"),
        ("twice.json", "is no permutation"),
        ("cut.json", "line 1"),
        ("signature.txt", "is no signature"),
        ("missing.json", "cannot be read"),
        ("--signature cPcbbbiht", "is a torus"),
        ("testdata/meshes/spot.mesh", "a component of its boundary is a sphere, which cannot be totally geodesic"),
        ("testdata/meshes/torus.obj", "give a mesh of tetrahedra"),
        (CENSUS, "there are 16 records"),
        (&format!("{CENSUS} --entry cPcbbbihq"), "there are cMcabbjik, cPcbbbdhq"),
    ];
    for (arguments, words) in cases {
        let run = folder.line(&format!("hyperbolic {arguments}")).expect(3);
        assert!(run.stderr.contains(words), "{arguments}: {}", run.stderr);
    }
    // A record under another name was printed from its first line to its last, without the name of the file.
    folder.write("record.txt", folder.read(TRIPUS));
    let refused = folder.line("hyperbolic record.txt").expect(3).stderr;
    assert!(refused.contains("record.txt") && refused.contains(".json") && refused.len() < 400, "{refused}");
    folder.line("hyperbolic").expect(2);
    folder.line(&format!("hyperbolic {TRIPUS} --signature cPcbbbihq")).expect(2);
    folder.line(&format!("hyperbolic {TRIPUS} -o same.glb --picture same.glb")).expect(2);
    folder.line(&format!("hyperbolic {TRIPUS} -o same.html --report ./same.html")).expect(2);
    assert!(!folder.names().iter().any(|name| name.starts_with("same")));
}

#[test]
fn the_canonical_decomposition_is_the_name_of_the_manifold() {
    let folder = Folder::new().with_testdata();
    // A triangulation with three tetrahedra of a manifold whose canonical decomposition has two.
    let line = "hyperbolic --signature dLQacbcjgjj -o out.homeo --json";
    let kept = folder.line(line).expect(0).json();
    let taken = folder.line(&format!("{line} --canonical")).expect(0).json();
    assert_eq!((&kept["triangulation"]["tetrahedra"], &taken["triangulation"]["tetrahedra"]), (&json!(3), &json!(2)));
    assert_eq!(kept["certificate"]["target"], "geodesic-boundary");
    assert_eq!(taken["certificate"]["target"], "canonical-decomposition");
    let name = &taken["canonical"]["signature"];
    assert_eq!((&kept["canonical"]["signature"], &taken["triangulation"]["signature"]), (name, name));
    assert!((volume(&kept) - volume(&taken)).abs() < 1e-9);
    assert_eq!(folder.line("verify out.homeo --json").expect(0).json()["certificate"], taken["certificate"]);
    // The same for a mesh of it, whose triangulation nobody asked for.
    let three = from_signature("dLQacbcjgjj").unwrap();
    folder.write("three.json", solid(&three));
    let mesh = folder.line("hyperbolic three.json --json").expect(0).json();
    assert_eq!(&mesh["triangulation"]["signature"], name);
    assert_eq!(mesh["certificate"]["target"], "canonical-decomposition");
}

#[test]
fn a_signature_gives_the_same_as_its_record() {
    let folder = Folder::new().with_testdata();
    folder.write("signature.txt", "cPcbbbihq\n");
    let metrics = [TRIPUS, "signature.txt", "--signature cPcbbbihq"]
        .map(|input| folder.line(&format!("hyperbolic {input} --json")).expect(0).json()["metric"]["volume"].clone());
    assert_eq!(metrics[0], metrics[1]);
    assert_eq!(metrics[1], metrics[2]);
}

#[test]
fn inner_vertices_of_a_record_are_taken_away_on_request() {
    let folder = Folder::new();
    let fine = subdivided(&from_signature("cPcbbbihq").unwrap());
    folder.write("fine.json", write_record(&fine));
    let run = folder.line("hyperbolic fine.json").expect(3);
    assert!(run.stderr.contains("is a sphere") && run.stderr.contains("--retriangulate"), "{}", run.stderr);
    let answer = folder.line("hyperbolic fine.json --retriangulate --json").expect(0).json();
    assert!((volume(&answer) - VOLUME).abs() < 1e-9);
    assert!(answer["tried"].as_u64().unwrap() > 0);
}

/// The inside of a mesh, by facet lists: cells that touch a cut-off vertex are left out.
fn solid(triangulation: &Triangulation) -> String {
    let fine = subdivided(&subdivided(triangulation));
    let skeleton = Skeleton::new(&fine);
    let links = Links::new(&fine, &skeleton);
    let is_inside = |t: &u32| skeleton.vertices_of(*t).iter().all(|&vertex| links.all()[vertex as usize].is_sphere());
    let cells: Vec<[u32; 4]> = (0..fine.len() as u32).filter(is_inside).map(|t| skeleton.vertices_of(t)).collect();
    json!({"vertices": skeleton.vertex_count(), "facets": cells}).to_string()
}

#[test]
fn a_mesh_of_the_tripus_has_its_volume_whatever_its_triangulation() {
    let folder = Folder::new();
    folder.write("solid.json", solid(&from_signature("cPcbbbihq").unwrap()));
    for seed in [1, 2] {
        let answer = folder.line(&format!("hyperbolic solid.json --seed {seed} --json -o a.homeo")).expect(0).json();
        assert!((volume(&answer) - VOLUME).abs() < 1e-9);
        assert_eq!(answer["triangulation"]["h1"], "2 Z");
        assert_eq!(answer["triangulation"]["boundary_genera"], json!([2]));
        assert!(answer["input"]["tetrahedra"].as_u64().unwrap() > 500);
        folder.line("verify a.homeo").expect(0);
    }
}

#[test]
fn a_handle_body_is_refused_as_one() {
    let folder = Folder::new();
    let frame: Vec<[usize; 3]> = (0..5)
        .flat_map(|i| (0..3).map(move |j| [i, j, 0]))
        .filter(|cell| ![[1, 1, 0], [3, 1, 0]].contains(cell))
        .collect();
    folder.write("frame.mesh", cubes(&frame)).write("ring.mesh", cubes(&frame[..8]));
    let run = folder.line("hyperbolic frame.mesh -o out.homeo").expect(3);
    assert!(run.stderr.contains("free of rank 2"), "{}", run.stderr);
    let ring = folder.line("hyperbolic ring.mesh").expect(3);
    assert!(ring.stderr.contains("a torus") && ring.stderr.contains("cusp"), "{}", ring.stderr);
    assert_eq!(folder.names(), ["frame.mesh", "ring.mesh"]);
}

#[test]
fn pictures_and_pages_are_written_for_every_model() {
    let folder = Folder::new().with_testdata();
    for (name, more) in [("a.glb", ""), ("b.glb", "--depth 1"), ("c.gltf", "--model half-space")] {
        let line = format!("hyperbolic {TRIPUS} --picture {name} {more} --json");
        assert_eq!(folder.line(&line).expect(0).json()["picture"], name);
    }
    let [small, large] = ["a.glb", "b.glb"].map(|name| folder.read(name));
    assert!(small.starts_with(b"glTF") && large.len() > 3 * small.len());
    let document: Value = serde_json::from_slice(&folder.read("c.gltf")).unwrap();
    assert!(number(&document["accessors"][0]["min"][2]) > 0.0, "points of the half-space are above its boundary");
    let run = folder.line(&format!("hyperbolic {TRIPUS} --picture a.obj")).expect(2);
    assert!(run.stderr.contains(".glb or .gltf"), "{}", run.stderr);
}

#[test]
fn other_verbs_know_the_file() {
    let folder = Folder::new().with_testdata();
    let line = format!("hyperbolic {TRIPUS} -o a.homeo --report made.html");
    folder.line(&line).expect(0);
    let verified = folder.line("verify a.homeo --json").expect(0).json();
    assert_eq!(verified["input"]["tetrahedra"], 2);
    folder.line(&format!("verify a.homeo --source {TRIPUS}")).expect(3);
    let answer = folder.line("report a.homeo -o read.html --json").expect(0).json();
    assert!((number(&answer["quality"]["volume"]["value"]) - VOLUME).abs() < 1e-9);
    // The picture is the same but for the last digits of a second proof; the tables are there in both.
    for page in ["made.html", "read.html"].map(|name| folder.text(name)) {
        assert!(page.contains("cPcbbbihq") && page.contains("6.45199027083") && page.contains("Side pairings"));
    }
    folder.write("p.csv", "x,y,z\n0,0,0\n");
    for line in ["eval a.homeo --points p.csv", "pl a.homeo -o x.obj --image y.obj"] {
        let run = folder.line(line).expect(3);
        assert!(run.stderr.contains("is no map of points"), "{}", run.stderr);
    }
}

#[test]
fn bytes_are_the_same_for_every_number_of_threads() {
    let folder = Folder::new();
    folder.write("solid.json", solid(&from_signature("cPcbbbihq").unwrap()));
    for threads in [1, 3] {
        folder
            .line(&format!("hyperbolic solid.json --threads {threads} -o {threads}.homeo --picture {threads}.glb"))
            .expect(0);
    }
    assert_eq!(folder.read("1.homeo"), folder.read("3.homeo"));
    assert_eq!(folder.read("1.glb"), folder.read("3.glb"));
}

/// A file cut off or with other numbers is not certified, and gives no page.
#[test]
fn damaged_files_give_no_page() {
    let folder = Folder::new().with_testdata();
    folder.line(&format!("hyperbolic {TRIPUS} -o a.homeo")).expect(0);
    let whole = folder.read("a.homeo");
    let length = f64::to_le_bytes(1.1830127018922);
    let place = whole.windows(6).position(|bytes| bytes == &length[2..]).expect("the length is in the file");
    let mut changed = whole.clone();
    changed[place + 3] ^= 1;
    folder.write("cut.homeo", &whole[..whole.len() / 2]).write("changed.homeo", changed);
    for name in ["cut", "changed"] {
        let run = folder.line(&format!("report {name}.homeo -o {name}.html"));
        assert!(matches!(run.code, 3 | 5), "{}: {}", run.code, run.stderr);
        assert!(!folder.path(&format!("{name}.html")).exists());
    }
}
