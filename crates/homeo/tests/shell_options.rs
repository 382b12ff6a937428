//! What a shell is asked to keep, and the bound of its angles.

mod support;

use homeo::construct::shell::{ShellError, ShellInfo, ShellParams, build};
use homeo::input::SourceMesh;
use homeo::map::Shell;
use homeo::progress::Silent;
use support::{Point, torus, turned_box};

fn built(source: &SourceMesh<3>, params: ShellParams) -> (Shell, ShellInfo) {
    build(source, &params, &Silent).expect("a shell")
}

fn distance(a: Point, b: Point) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn frozen_vertices_stay_where_they_are() {
    let source = torus(24, 12, 3.0);
    let frozen = vec![3, 50, 51, 200];
    let is_kept = |shell: &Shell, v: &u32| shell.parts().middle.contains(&source.positions()[*v as usize]);
    let (free, _) = built(&source, ShellParams::default());
    assert!(!frozen.iter().all(|v| is_kept(&free, v)), "they would not stay by themselves");
    let (shell, info) = built(&source, ShellParams { frozen: frozen.clone(), ..ShellParams::default() });
    assert!(frozen.iter().all(|v| is_kept(&shell, v)));
    assert!(info.prisms < info.first_prisms / 2, "the others do not");
    let missing = ShellParams { frozen: vec![7, 999_999], ..ShellParams::default() };
    assert_eq!(build(&source, &missing, &Silent).err(), Some(ShellError::NoSuchVertex(999_999)));
}

/// The part of the box's twelve edges that edges of the middle surface cover.
fn covered_edges(shell: &Shell, n: usize) -> f64 {
    let source = turned_box(n as i32);
    let mut sharp = 0.0;
    let mut covered = 0.0;
    let corners = box_corners(&source);
    for (i, &a) in corners.iter().enumerate() {
        for &b in &corners[..i] {
            // Of the segments between two corners the edges are those with n - 1 vertices of the source inside.
            let is_between =
                |p: &&Point| distance(a, **p) > 1e-9 && distance(b, **p) > 1e-9 && off_segment([a, b], **p) < 1e-9;
            if source.positions().iter().filter(is_between).count() != n - 1 || is_diagonal(&source, [a, b]) {
                continue;
            }
            sharp += distance(a, b);
            for prism in &shell.parts().prisms {
                for k in 0..3 {
                    let [p, q] = [prism[k], prism[(k + 1) % 3]].map(|v| shell.parts().middle[v as usize]);
                    if off_segment([a, b], p) < 1e-9 && off_segment([a, b], q) < 1e-9 {
                        covered += 0.5 * distance(p, q); // each edge is in two prisms
                    }
                }
            }
        }
    }
    covered / sharp
}

/// How much longer the way from one end to the other becomes over a point.
fn off_segment([a, b]: [Point; 2], p: Point) -> f64 {
    distance(a, p) + distance(p, b) - distance(a, b)
}

/// Vertices where three sides meet: those at which the triangles have three normals.
fn box_corners(source: &SourceMesh<3>) -> Vec<Point> {
    let mut normals: Vec<Vec<Point>> = vec![Vec::new(); source.positions().len()];
    for cell in source.complex().cells() {
        let normal = unit_normal(cell.map(|v| source.positions()[v.index()]));
        for v in cell {
            if !normals[v.index()].iter().any(|other| distance(*other, normal) < 1e-6) {
                normals[v.index()].push(normal);
            }
        }
    }
    (0..normals.len()).filter(|&v| normals[v].len() == 3).map(|v| source.positions()[v]).collect()
}

fn unit_normal([a, b, c]: [Point; 3]) -> Point {
    let step = |p: Point| [0, 1, 2].map(|axis| p[axis] - a[axis]);
    let (u, v) = (step(b), step(c));
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = distance(normal, [0.0; 3]);
    normal.map(|x| x / length)
}

/// Whether a segment with vertices in it runs across a side of the box: a vertex in it lies on one side only.
fn is_diagonal(source: &SourceMesh<3>, ends: [Point; 2]) -> bool {
    let sides = |v: usize| {
        let mut normals: Vec<Point> = Vec::new();
        for cell in source.complex().cells().iter().filter(|cell| cell.iter().any(|w| w.index() == v)) {
            let normal = unit_normal(cell.map(|w| source.positions()[w.index()]));
            if !normals.iter().any(|other| distance(*other, normal) < 1e-6) {
                normals.push(normal);
            }
        }
        normals.len()
    };
    (0..source.positions().len()).any(|v| off_segment(ends, source.positions()[v]) < 1e-9 && sides(v) < 2)
}

#[test]
fn sharp_edges_stay_edges() {
    let n = 4;
    let source = turned_box(n as i32);
    let corners = box_corners(&source);
    assert_eq!(corners.len(), 8);
    let (shell, info) = built(&source, ShellParams { feature_angle: Some(0.3), ..ShellParams::default() });
    assert!(info.prisms < info.first_prisms / 2, "{} of {}", info.prisms, info.first_prisms);
    assert!(corners.iter().all(|corner| shell.parts().middle.contains(corner)));
    assert!((covered_edges(&shell, n) - 1.0).abs() < 1e-9);
    // Without being asked to they do not all stay.
    let thick = ShellParams { thickness: 0.3, ..ShellParams::default() };
    assert!(covered_edges(&built(&source, thick).0, n) < 0.999);
}

#[test]
fn angles_stay_below_the_bound_or_what_they_were() {
    let source = torus(24, 12, 3.0);
    let (_, first) = built(&source, ShellParams { rounds: 0, ..ShellParams::default() });
    let bound = 50f64.to_radians();
    assert!(first.largest_angle < bound, "{}", first.largest_angle.to_degrees());
    let (_, bounded) = built(&source, ShellParams { largest_angle: bound, ..ShellParams::default() });
    assert!(bounded.largest_angle <= bound && bounded.prisms < first.prisms);
    let (_, free) = built(&source, ShellParams::default());
    assert!(free.largest_angle > bound && free.prisms <= bounded.prisms);
    for wrong in [-0.1, 2.0, f64::NAN] {
        let params = ShellParams { largest_angle: wrong, ..ShellParams::default() };
        assert_eq!(build(&source, &params, &Silent).err(), Some(ShellError::Angle));
    }
}
