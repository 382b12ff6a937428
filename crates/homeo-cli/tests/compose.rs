//! `homeo compose`: under one map and back under another.

mod common;

use common::{Folder, cubes};

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
