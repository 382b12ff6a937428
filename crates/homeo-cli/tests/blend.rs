//! `homeo blend`: curves between, and splines near them.

mod common;

use common::Folder;

fn folder() -> Folder {
    Folder::new().with_testdata()
}

#[test]
fn curves_are_blended_and_closed() {
    let folder = folder();
    let line = "blend testdata/polygons/ellipse.json testdata/polygons/bean.json --frames 5";
    let report = folder.line(&format!("{line} -o b.json --json")).expect(0).json();
    assert_eq!(report["quality"]["frames"], 5);
    let curves: serde_json::Value = serde_json::from_str(&folder.text("b.json")).unwrap();
    let first: serde_json::Value = serde_json::from_str(&folder.text("testdata/polygons/ellipse.json")).unwrap();
    assert_eq!((&curves["frames"][0]["points"], &curves["frames"][2]["simple"]), (&first, &true.into()));
    folder.line(&format!("{line} -o b.svg")).expect(0);
    assert_eq!(folder.text("b.svg").matches("<polygon").count(), 5);
    folder.write("eight.json", "[[0,0],[2,2],[2,0],[0,2]]");
    let report = folder.line("blend testdata/polygons/ellipse.json eight.json -o c.svg --json").expect(3).json();
    assert_eq!(report["error"]["code"], "unfit-input");
    folder.line(&format!("{line} -o b.png")).expect(2);
    // What is wrong with the second curve was said of the first.
    folder.write("twice.json", "[[0,0],[0,0],[2,0],[0,2]]");
    let refused = folder.line("blend testdata/polygons/ellipse.json twice.json -o c.svg").expect(3).stderr;
    assert!(refused.contains("twice.json: vertex 0") && !refused.contains("ellipse.json"), "{refused}");
}

#[test]
fn splines_are_written_with_their_distances_and_drawn_as_they_are() {
    let folder = folder();
    let line = "blend testdata/polygons/ellipse.json testdata/polygons/bean.json --frames 3";
    let report = folder.line(&format!("{line} --spline 24 -o s.json --json")).expect(0).json();
    let most = report["quality"]["splines"]["max_distance"].as_f64().unwrap();
    let frames: serde_json::Value = serde_json::from_str(&folder.text("s.json")).unwrap();
    let mut distances = 0.0_f64;
    for frame in frames["frames"].as_array().unwrap() {
        let control: Vec<[f64; 2]> = serde_json::from_value(frame["spline"]["control"].clone()).unwrap();
        let points: Vec<[f64; 2]> = serde_json::from_value(frame["points"].clone()).unwrap();
        let spline = homeo::shape::ClosedSpline::new(control.clone()).unwrap();
        assert_eq!(control.len(), 24);
        let dense = homeo::shape::sample_closed(|u| spline.at(u)[0], 20_000);
        let near = |p: &[f64; 2]| dense.iter().map(|q| (p[0] - q[0]).hypot(p[1] - q[1])).fold(f64::INFINITY, f64::min);
        let distance = frame["spline"]["distance"].as_f64().unwrap();
        let found = points.iter().map(near).fold(0.0, f64::max);
        assert!(distance > 0.0 && found <= distance + 1e-3, "{found} {distance}");
        // The control: of the polygon of control points this does not hold.
        let near =
            |p: &[f64; 2]| control.iter().map(|q| (p[0] - q[0]).hypot(p[1] - q[1])).fold(f64::INFINITY, f64::min);
        assert!(points.iter().map(near).fold(0.0, f64::max) > distance + 1e-3);
        distances = distances.max(distance);
    }
    assert_eq!(distances, most);
    folder.line(&format!("{line} --spline -o s.svg")).expect(0);
    let drawing = folder.text("s.svg");
    assert_eq!((drawing.matches("<path").count(), drawing.matches(" C").count()), (3, 3 * 50));
    // The first spline as input.
    folder.write("control.json", serde_json::json!({"control": frames["frames"][0]["spline"]["control"]}).to_string());
    folder.line("blend control.json testdata/polygons/bean.json --spline 24 -o again.json").expect(0);
    folder.write("few.json", "{\"control\": [[0,0],[1,0],[0,1]]}");
    folder.line("blend few.json testdata/polygons/bean.json -o no.json").expect(3);
    let refused = folder.line(&format!("{line} --spline 1000 -o no.json --json")).expect(3).json();
    assert_eq!(refused["error"]["code"], "no-spline");
    folder.line(&format!("{line} --spline 3 -o no.json")).expect(2);
}

/// They were read twice, which a pipe cannot be.
#[cfg(unix)]
#[test]
fn curves_are_read_from_pipes() {
    use std::io::Write;
    use std::process::{Command, Stdio};
    let folder = folder();
    let mut command = Command::new(env!("CARGO_BIN_EXE_homeo"));
    let arguments = ["blend", "/dev/stdin", "testdata/polygons/bean.json", "--frames", "3", "-o", "p.json", "-q"];
    let mut child = command.args(arguments).current_dir(folder.path("")).stdin(Stdio::piped()).spawn().unwrap();
    let ellipse = folder.read("testdata/polygons/ellipse.json");
    child.stdin.take().unwrap().write_all(&ellipse).unwrap();
    assert!(child.wait().unwrap().success());
    folder.line("blend testdata/polygons/ellipse.json testdata/polygons/bean.json --frames 3 -o f.json -q").expect(0);
    assert_eq!(folder.text("p.json"), folder.text("f.json"));
}
