//! `homeo warp`: pictures and points, certified, and what is refused.

mod common;

use common::Folder;
use image::{GenericImageView, ImageBuffer, Luma, Rgba};

const PIXELS: &str = "--from testdata/polygons/square.json --to testdata/polygons/arrow.json";

fn folder() -> Folder {
    Folder::new().with_testdata()
}

#[test]
fn points_move_and_the_map_is_checked_again() {
    let folder = folder();
    let line =
        "warp testdata/points/star.csv --pair testdata/polygons/star_to_circle.json -o moved.csv --map star.homeo";
    let report = folder.line(&format!("{line} --json")).expect(0).json();
    assert_eq!(report["certificate"]["holds"], true);
    assert_eq!(report["quality"]["moved"]["points"], 4);
    assert_eq!(report["input"]["vertices"], 10);
    folder.line("verify star.homeo --source testdata/polygons/star_to_circle.json").expect(0);
    let other = folder.line("verify star.homeo --source testdata/polygons/hole_turned.json --json").expect(3).json();
    assert_eq!(other["error"]["code"], "other-source");
    // The same points by `eval`, and back again.
    folder.line("eval star.homeo --points testdata/points/star.csv -o again.csv").expect(0);
    assert_eq!(folder.text("moved.csv"), folder.text("again.csv"));
    folder.line("eval star.homeo --points testdata/points/star.csv --exact -o exact.csv").expect(0);
    folder.line("eval star.homeo --points exact.csv --inverse --exact -o back.csv").expect(0);
    assert_eq!(folder.text("back.csv"), "x,y\n1/10,1/5\n-1/4,1/8\n0,0\n3/10,-1/5\n");
    folder.line("report star.homeo -o star.html").expect(0);
    assert!(folder.text("star.html").contains("Certified"));
}

#[test]
fn drawings_are_polygons_too() {
    let folder = folder();
    folder
        .write("a.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=\"M10 10h90v90h-90z\"/></svg>")
        .write("b.svg", "<svg><g transform=\"translate(10 0)\"><polygon points=\"0,10 90,10 40,40 0,100\"/></g></svg>")
        .write("a.json", "[[10,10],[100,10],[100,100],[10,100]]")
        .write("b.json", "[[10,10],[100,10],[50,40],[10,100]]");
    for name in ["svg", "json"] {
        let line =
            format!("warp testdata/images/checker.png --from a.{name} --to b.{name} -o {name}.png --map {name}.homeo");
        folder.line(&line).expect(0);
    }
    assert_eq!(folder.read("svg.png"), folder.read("json.png"));
    folder.line("verify svg.homeo --source a.svg").expect(0);
    let report = folder.line("info b.svg --json").expect(0).json();
    assert_eq!((&report["kind"], &report["vertices"]), (&"polygon".into(), &4.into()));
    folder.write("text.svg", "<svg><text>no shape</text></svg>");
    let report = folder.line("info text.svg --json").expect(3).json();
    assert!(report["error"]["message"].as_str().unwrap().contains("no path"), "{report}");
}

/// A hole turns; the same map with the same answers, however it is asked.
#[test]
fn mean_value_maps_are_certified_and_checked_again() {
    let folder = folder();
    let pair = "--pair testdata/polygons/hole_turned.json --method mean-value";
    let line = format!("warp testdata/images/checker.png {pair} --map turned.homeo");
    let report = folder.line(&format!("{line} -o a.png --threads 1 --json")).expect(0).json();
    assert_eq!((&report["certificate"]["holds"], &report["target"]), (&true.into(), &"annulus".into()));
    assert!(
        report["quality"]["steps"].as_u64() > Some(1) && report["quality"]["least_determinant"].as_f64() > Some(0.0)
    );
    folder.line(&format!("{line} -o b.png --threads 2")).expect(0);
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    let line = "verify turned.homeo --source testdata/polygons/hole_turned.json --json";
    let report = folder.line(line).expect(0).json();
    assert_eq!(report["certificate"]["kind"], "composite-mean-value");
    folder.write("points.csv", "x,y\n0.5,0.25\n-0.25,-0.5\n");
    folder.line("eval turned.homeo --points points.csv -o images.csv").expect(0);
    let back = folder.line("eval turned.homeo --points images.csv --inverse").expect(0).stdout;
    let numbers: Vec<f64> = back.split(['\n', ',']).filter_map(|word| word.trim().parse().ok()).collect();
    let wanted = [0.5, 0.25, -0.25, -0.5];
    assert!(numbers.len() == 4 && numbers.iter().zip(wanted).all(|(x, y)| (x - y).abs() < 1e-9), "{back}");
    let report = folder.line("eval turned.homeo --points points.csv --exact -o d.csv --json").expect(3).json();
    assert_eq!(report["error"]["code"], "no-exact-images");
    folder.line("report turned.homeo -o turned.html").expect(0);
    assert!(folder.text("turned.html").contains("Certified"));
    // On a straight way the hole does not turn by more than a half turn.
    let line = format!("warp points.csv {pair} --path straight --turn 400 -o c.csv --json");
    assert_eq!(folder.line(&line).expect(4).json()["error"]["code"], "no-map");
    assert!(!folder.path("c.csv").exists());
}

#[test]
fn holes_turn_in_every_frame_of_a_morph() {
    let folder = folder();
    let line =
        "morph testdata/images/checker.png --pair testdata/polygons/hole_turned.json --turn 417 --frames 5 -o f.json";
    let report = folder.line(&format!("{line} --json")).expect(0).json();
    assert_eq!(report["quality"]["path"], "turning");
    let frames: serde_json::Value = serde_json::from_str(&folder.text("f.json")).unwrap();
    let angle = |frame: usize| {
        let place = |k: usize| frames["frames"][frame][1][0][k].as_f64().unwrap();
        place(1).atan2(place(0)).to_degrees()
    };
    let turns: Vec<f64> = (1..5).map(|frame| (angle(frame) - angle(frame - 1)).rem_euclid(360.0)).collect();
    assert!(turns.iter().all(|turn| (turn - turns[0]).abs() < 1e-9) && turns[0] > 90.0, "{turns:?}");
}

/// Two holes that change places, as a pair file and as two files; the path of a morph does as well.
#[test]
fn several_holes_move() {
    let folder = folder();
    let hole = |x: f64, y: f64| format!("[[{x}, {y}], [{x}, {}], [{}, {y}]]", y + 12.0, x + 12.0);
    let domain =
        |a: String, b: String| format!("{{\"outer\": [[2, 2], [60, 2], [60, 60], [2, 60]], \"holes\": [{a}, {b}]}}");
    let (a, b) = (domain(hole(10.0, 24.0), hole(40.0, 24.0)), domain(hole(24.0, 40.0), hole(28.0, 10.0)));
    folder.write("pair.json", format!("{{\"source\": {a}, \"target\": {b}, \"winding_hint\": 30}}"));
    folder.write("a.json", a).write("b.json", b).write("points.csv", "x,y\n5,5\n10,24\n52,24\n59,59\n");
    let line = "warp points.csv --triangles 500 -o out.csv --map out.homeo --json";
    let report = folder.line(&format!("{line} --pair pair.json")).expect(0).json();
    assert_eq!((&report["target"], &report["certificate"]["holds"]), (&"domain".into(), &true.into()));
    let points = folder.text("out.csv");
    assert!(points.contains("\n24.0,40.0\n40.0,10.0\n"), "corners of holes go to corners of holes: {points}");
    folder.line("verify out.homeo --source a.json").expect(0);
    folder.line(&format!("{line} --from a.json --to b.json")).expect(0);
    assert_eq!(folder.text("out.csv"), points);
    folder.line(&format!("{line} --pair pair.json --turn 360")).expect(2);
    let morph = "morph testdata/images/checker.png --pair pair.json --frames 4 --triangles 500 -o f.json --json";
    assert_eq!(folder.line(morph).expect(0).json()["quality"]["frames"], 4);
    folder.line(&format!("{morph} --turn 360")).expect(2);
}

#[test]
fn optimized_middles_are_certified_too() {
    let folder = folder();
    let line = "warp testdata/points/star.csv --pair testdata/polygons/star_to_circle.json --triangles 1000";
    for middle in ["optimized", "lengths"] {
        let report = folder.line(&format!("{line} --middle {middle} -o {middle}.csv --map {middle}.homeo --json"));
        assert_eq!(report.expect(0).json()["certificate"]["holds"], true);
        folder.line(&format!("verify {middle}.homeo --source testdata/polygons/star_to_circle.json")).expect(0);
    }
    assert_ne!(folder.text("optimized.csv"), folder.text("lengths.csv"));
}

#[test]
fn a_picture_keeps_its_corners_and_loses_what_is_outside() {
    let folder = folder();
    let run = format!("warp testdata/images/checker.png {PIXELS} -o warped.png --field field.npy --json");
    let report = folder.line(&run).expect(0).json();
    assert_eq!((&report["quality"]["moved"]["width"], &report["quality"]["moved"]["bits"]), (&128.into(), &8.into()));
    let (before, after) =
        (image::open(folder.path("testdata/images/checker.png")), image::open(folder.path("warped.png")));
    let (before, after) = (before.unwrap().to_rgba8(), after.unwrap().to_rgba8());
    assert_eq!(after.dimensions(), (128, 128));
    // Right below the notch of the arrow, and left of the square, nothing is to be seen.
    for (x, y) in [(110, 110), (2, 60), (60, 60)] {
        assert_eq!(after.get_pixel(x, y)[3], 0, "({x}, {y})");
    }
    // Next to a corner that stays the picture is almost the same.
    let (a, b) = (before.get_pixel(9, 9), after.get_pixel(9, 9));
    assert!((0..3).all(|k| a[k].abs_diff(b[k]) < 40) && b[3] == 255, "{a:?} became {b:?}");
    let field = folder.read("field.npy");
    assert!(String::from_utf8_lossy(&field[..128]).contains("'shape': (128, 128, 2)"));
    assert_eq!(field.len() % 64, 0);
}

#[test]
fn a_polygon_that_does_not_move_leaves_the_picture_as_it_is() {
    let folder = folder();
    let line =
        "warp testdata/images/checker.png --from testdata/polygons/square.json --to testdata/polygons/square.json";
    for filter in ["linear", "bicubic", "lanczos"] {
        folder.line(&format!("{line} --filter {filter} -o same.png")).expect(0);
        let (before, after) =
            (image::open(folder.path("testdata/images/checker.png")), image::open(folder.path("same.png")));
        let (before, after) = (before.unwrap(), after.unwrap());
        for (x, y) in (9..119).flat_map(|x| (9..119).map(move |y| (x, y))) {
            let (a, b) = (before.get_pixel(x, y), after.get_pixel(x, y));
            assert!((0..4).all(|k| a[k].abs_diff(b[k]) <= 1), "{filter}: ({x}, {y}): {a:?} became {b:?}");
        }
    }
}

#[test]
fn sixteen_bits_and_grey_stay() {
    let folder = folder();
    let grey = ImageBuffer::from_fn(128, 128, |x, y| Luma([(300 * x + 40 * y) as u16]));
    grey.save(folder.path("grey.png")).unwrap();
    folder.line(&format!("warp grey.png {PIXELS} -o warped.png")).expect(0);
    let warped = image::open(folder.path("warped.png")).unwrap();
    assert_eq!(warped.color(), image::ColorType::La16);
    let colours: ImageBuffer<Rgba<u16>, _> = ImageBuffer::from_fn(128, 128, |x, _| Rgba([500 * x as u16, 1, 2, 60000]));
    colours.save(folder.path("colours.png")).unwrap();
    folder.line(&format!("warp colours.png {PIXELS} -o warped.png")).expect(0);
    let warped = image::open(folder.path("warped.png")).unwrap();
    assert_eq!(warped.color(), image::ColorType::Rgba16);
    assert_eq!(warped.to_rgba16().get_pixel(20, 20)[3], 60000);
    folder.line(&format!("warp colours.png {PIXELS} -o warped.jpg")).expect(0);
    assert_eq!(image::open(folder.path("warped.jpg")).unwrap().color(), image::ColorType::Rgb8);
}

#[test]
fn holes_turn_and_results_do_not_depend_on_threads() {
    let folder = folder();
    let line = "warp testdata/images/checker.png --pair testdata/polygons/hole_turned.json --turn 400";
    folder.line(&format!("{line} -o a.png --map a.homeo --threads 1")).expect(0);
    folder.line(&format!("{line} -o b.png --map b.homeo --threads 2")).expect(0);
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    assert_eq!(folder.read("a.homeo"), folder.read("b.homeo"));
    let report = folder.line("verify a.homeo --json").expect(0).json();
    assert_eq!(report["certificate"]["target"], "annulus");
}

#[test]
fn what_is_no_pair_is_refused_and_nothing_is_written() {
    let folder = folder();
    folder
        .write("bow.json", "[[0,0],[9,9],[9,0],[0,9]]")
        .write("four.json", "[[0,0],[9,0],[9,9],[0,9]]")
        .write("clockwise.json", "[[0,0],[0,9],[9,9],[9,0]]")
        .write("five.json", "[[0,0],[9,0],[9,9],[5,12],[0,9]]")
        .write("text.json", "[[0,0],[9,\"x\"],[9,9]]")
        .write("points.csv", "x,y\n1,1\n10,10\n")
        .write("fake.png", "no picture");
    let cases = [
        ("points.csv", "four", "bow", "no-domain", "edge 0 of ring 0 and edge 2 of ring 0 meet"),
        ("points.csv", "four", "five", "counts-differ", "4 vertices"),
        ("points.csv", "four", "clockwise", "no-domain", "runs clockwise"),
        ("points.csv", "text", "four", "bad-syntax", "vertex 1"),
        ("points.csv", "four", "missing", "cannot-open", "missing.json"),
        ("points.csv", "four", "four", "outside", "row 2"),
        ("fake.png", "four", "four", "unreadable-picture", "fake.png"),
    ];
    for (input, from, to, code, words) in cases {
        let output = if input.ends_with("png") { "out.png" } else { "out.csv" };
        let line = format!("warp {input} --from {from}.json --to {to}.json -o {output} --map m.homeo --json");
        let report = folder.line(&line).expect(3).json();
        assert_eq!(report["error"]["code"], code, "{line}");
        assert!(report["error"]["message"].as_str().unwrap().contains(words), "{line}: {report}");
    }
    let names = folder.names();
    assert!(!names.iter().any(|name| name.starts_with("out") || name.contains("homeo")), "{names:?}");
    folder.line("warp points.csv --from four.json -o out.csv").expect(2);
    folder.line("warp points.csv --from four.json --to four.json").expect(2);
    folder.line("warp points.csv --from four.json --to four.json -o out.png").expect(2);
}

#[test]
fn landmarks_move_the_picture_unless_they_fold_it() {
    let folder = folder();
    let table = |shift: f64| {
        let mut text = String::from("x,y,u,v\n");
        for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
            let (x, y) = (f64::from(i) * 30.0 + 2.0, f64::from(j) * 30.0 + 2.0);
            let moved = if (i, j) == (2, 2) { shift } else { 0.0 };
            text.push_str(&format!("{x},{y},{},{}\n", x + moved, y + 0.5 * moved));
        }
        text
    };
    folder.write("few.csv", table(12.0)).write("fold.csv", table(50.0));
    let line = "warp testdata/images/checker.png -o out.png --map m.homeo --json";
    let report = folder.line(&format!("{line} --landmarks few.csv")).expect(0).json();
    assert_eq!(report["certificate"]["holds"], true);
    folder.line("verify m.homeo").expect(0);
    let image = image::open(folder.path("out.png")).unwrap().to_rgba8();
    assert!(image.get_pixel(60, 60)[3] == 255 && image.get_pixel(0, 0)[3] == 0);
    std::fs::remove_file(folder.path("out.png")).unwrap();
    let report = folder.line(&format!("{line} --landmarks fold.csv")).expect(3).json();
    assert_eq!(report["error"]["code"], "folded");
    // Landmark 12 is the one in the middle; every triangle that is turned over has it.
    let folded = report["folded"].as_array().unwrap();
    assert!(!folded.is_empty() && folded.iter().all(|t| t.as_array().unwrap().contains(&12.into())), "{report}");
    assert!(!folder.path("out.png").exists());
}

#[test]
fn a_morph_has_all_its_frames() {
    let folder = folder();
    let line =
        "morph testdata/images/checker.png --pair testdata/polygons/star_to_circle.json --frames 4 --triangles 500";
    let report = folder.line(&format!("{line} -o m.png --json")).expect(0).json();
    assert_eq!((&report["quality"]["frames"], &report["certificate"]["holds"]), (&4.into(), &true.into()));
    let bytes = folder.read("m.png");
    assert_eq!(bytes.windows(4).filter(|w| w == b"fcTL").count(), 4, "an animated PNG of four frames");
    folder.line(&format!("{line} -o m.gif")).expect(0);
    assert!(folder.read("m.gif").starts_with(b"GIF89a"));
    folder.line(&format!("{line} -o f.png --separate")).expect(0);
    let (first, last) = (image::open(folder.path("f_0.png")).unwrap(), image::open(folder.path("f_3.png")).unwrap());
    assert!(first != last && folder.path("f_2.png").exists() && !folder.path("f_4.png").exists());
    folder.line(&format!("{line} -o m.json")).expect(0);
    let shapes: serde_json::Value = serde_json::from_str(&folder.text("m.json")).unwrap();
    let pair: serde_json::Value = serde_json::from_str(&folder.text("testdata/polygons/star_to_circle.json")).unwrap();
    assert_eq!((&shapes["frames"][0][0], &shapes["frames"][3][0]), (&pair["source"], &pair["target"]));
    assert_eq!(shapes["frames"].as_array().unwrap().len(), 4);
    folder.line(&format!("{line} -o m.csv")).expect(2);
}

#[test]
fn a_path_that_crosses_itself_is_refused() {
    let folder = folder();
    // On straight lines vertices pass one another.
    let pair = r#"{"source": [[2,0],[5,0],[9,7],[2,7],[6,3]], "target": [[3,9],[0,5],[3,7],[4,2],[8,7]]}"#;
    folder.write("pair.json", pair);
    let line = "morph testdata/images/checker.png --pair pair.json --frames 9 -o m.gif --path straight --json";
    let report = folder.line(line).expect(4).json();
    assert_eq!(report["error"]["code"], "no-path");
    assert!(report["error"]["message"].as_str().unwrap().contains("at time"), "{report}");
    assert!(!folder.path("m.gif").exists());
    let simple = line.replace("straight", "simple");
    let report = folder.line(&format!("{simple} --triangles 500")).expect(0).json();
    assert_eq!((&report["quality"]["path"], &report["certificate"]["holds"]), (&"simple".into(), &true.into()));
}

#[test]
fn polygons_move_by_curvature() {
    let folder = folder();
    let line = "testdata/images/checker.png --pair testdata/polygons/star_to_circle.json --path curvature";
    let report = folder.line(&format!("morph {line} --frames 3 --triangles 500 -o m.json --json -q")).expect(0).json();
    assert_eq!(report["quality"]["path"], "curvature");
    let frames: serde_json::Value = serde_json::from_str(&folder.text("m.json")).unwrap();
    let pair: serde_json::Value = serde_json::from_str(&folder.text("testdata/polygons/star_to_circle.json")).unwrap();
    let ring = |k: usize| frames["frames"][k][0].clone();
    assert_eq!(ring(0).as_array().unwrap().len(), ring(1).as_array().unwrap().len());
    assert_eq!((&ring(0), &ring(2)), (&pair["source"], &pair["target"]));
    let said = folder.line(&format!("warp {line} --method mean-value -o w.png")).expect(0).stdout;
    assert!(said.contains("certificate") && said.contains("on the path `curvature`"), "{said}");
    let line = line.replace("star_to_circle", "hole_turned");
    let refused = folder.line(&format!("warp {line} --method mean-value -o w.png --json")).expect(4).json();
    assert!(refused["error"]["message"].as_str().unwrap().contains("without holes"), "{refused}");
}
