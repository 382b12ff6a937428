//! Laws of paths of polyhedra.

use super::rotation::{apply, exponential};
use super::*;

type Point3 = [f64; 3];

fn octahedron() -> (Vec<Point3>, Vec<[u32; 3]>) {
    let corners =
        vec![[1.0, 0.1, 0.0], [-1.1, 0.0, 0.2], [0.0, 1.3, 0.0], [0.1, -1.0, 0.0], [0.0, 0.0, 1.2], [0.0, 0.1, -0.9]];
    (corners, vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
}

/// The images under a rotation and a stretch, moved.
fn similar(points: &[Point3], turn: Point3, stretch: f64, shift: Point3) -> Vec<Point3> {
    let rotation = exponential(turn);
    let image = |p: &Point3| apply(&rotation, p.map(|x| stretch * x));
    points.iter().map(|p| [0, 1, 2].map(|k| image(p)[k] + shift[k])).collect()
}

/// How much edges differ; the shift is left out.
fn edge_error(a: &[Point3], b: &[Point3]) -> f64 {
    let edge = |p: &[Point3], i: usize| [0, 1, 2].map(|k| p[i][k] - p[0][k]);
    (1..a.len()).flat_map(|i| (0..3).map(move |k| (edge(a, i)[k] - edge(b, i)[k]).abs())).fold(0.0, f64::max)
}

#[test]
fn ends_are_those_given_and_other_times_are_refused() {
    let (source, triangles) = octahedron();
    let target: Vec<Point3> = source.iter().map(|p| [p[0] + 0.1 * p[1], 2.0 * p[2], 0.3 - p[1]]).collect();
    let turning = TurningPolyhedra::new(source.clone(), target.clone(), &triangles).unwrap();
    let straight = StraightPolyhedra::new(source.clone(), target.clone()).unwrap();
    for path in [&turning as &dyn PolyhedronPath, &straight] {
        assert_eq!(path.at(0.0).unwrap(), source);
        assert_eq!(path.at(1.0).unwrap(), target);
        assert!(edge_error(&path.at(1e-9).unwrap(), &source) < 1e-8);
        assert!(edge_error(&path.at(1.0 - 1e-9).unwrap(), &target) < 1e-8);
        assert_eq!(path.at(1.5), Err(PolyhedronPathError::OutsideTime { t: 1.5 }));
        assert!(path.at(f64::NAN).is_err());
    }
}

/// A similarity with a turn of less than a half turn is reproduced at all times; the straight path, the control, is not.
#[test]
fn similarities_turn_evenly() {
    let (source, triangles) = octahedron();
    let mut tried = 0;
    for (angle, stretch) in [(0.4, 1.0), (1.7, 2.0), (3.1, 0.5)] {
        let axis = [0.6, -0.48, 0.64].map(|x: f64| angle * x);
        let target = similar(&source, axis, stretch, [3.0, -1.0, 0.5]);
        let path = TurningPolyhedra::new(source.clone(), target.clone(), &triangles).unwrap();
        let control = StraightPolyhedra::new(source.clone(), target).unwrap();
        for t in [0.25, 0.5, 0.9] {
            let truth = similar(&source, axis.map(|x| t * x), 1.0 + t * (stretch - 1.0), [0.0; 3]);
            assert!(edge_error(&path.at(t).unwrap(), &truth) < 1e-13);
            assert!(edge_error(&control.at(t).unwrap(), &truth) > 1e-3);
            tried += 1;
        }
    }
    assert_eq!(tried, 9);
}

#[test]
fn what_has_no_path_is_refused_by_element() {
    let (source, triangles) = octahedron();
    let error = |source: &[Point3], target: &[Point3], triangles: &[[u32; 3]]| {
        TurningPolyhedra::new(source.to_vec(), target.to_vec(), triangles).unwrap_err()
    };
    assert_eq!(error(&source, &source[1..], &triangles), PolyhedronPathError::VertexCounts { here: 6, there: 5 });
    let mut flat = source.clone();
    flat[2] = flat[0];
    assert_eq!(error(&source, &flat, &triangles), PolyhedronPathError::NoArea { triangle: 0 });
    assert_eq!(error(&source, &source, &[[0, 1, 9]]), PolyhedronPathError::NoSuchVertex { triangle: 0 });
    assert!(matches!(error(&source, &source, &triangles[..1]), PolyhedronPathError::Solve(_)));
    flat[2] = [f64::NAN; 3];
    assert_eq!(error(&source, &flat, &triangles), PolyhedronPathError::NotFinite { vertex: 2 });
}
