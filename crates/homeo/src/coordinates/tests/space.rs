//! Laws of coordinates of polyhedra.

use super::shapes::Random;
use crate::coordinates::*;

type Solid = (&'static str, Vec<[f64; 3]>, Vec<[u32; 3]>);

fn solids() -> Vec<Solid> {
    let cube: Vec<[f64; 3]> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1].map(f64::from)).collect();
    let of_cube = vec![
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    let octahedron =
        vec![[1.0, 0.1, 0.0], [-1.1, 0.0, 0.2], [0.0, 1.3, 0.0], [0.1, -1.0, 0.0], [0.0, 0.0, 1.2], [0.0, 0.1, -0.9]];
    let of_octahedron = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let tetrahedron = vec![[0.0, 0.0, 0.0], [1.0, 0.2, 0.0], [0.0, 1.0, 0.3], [0.1, 0.0, 1.0]];
    let of_tetrahedron = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    vec![
        ("cube", cube, of_cube),
        ("octahedron", octahedron, of_octahedron),
        ("tetrahedron", tetrahedron, of_tetrahedron),
    ]
}

fn mix(points: &[[f64; 3]], shares: &[f64]) -> [f64; 3] {
    let total: f64 = shares.iter().sum();
    [0, 1, 2].map(|k| points.iter().zip(shares).map(|(p, s)| p[k] * s / total).sum())
}

#[test]
fn wachspress_obeys_the_laws_in_space() {
    let mut random = Random(9);
    for (shape, vertices, triangles) in solids() {
        let kind = WachspressPolyhedron::new(&vertices, &triangles).unwrap();
        let n = vertices.len();
        let (mut values, mut gradients) = (vec![0.0; n], vec![[0.0; 3]; n]);
        let mut points: Vec<[f64; 3]> =
            (0..60).map(|_| mix(&vertices, &(0..n).map(|_| random.unit() + 1e-3).collect::<Vec<_>>())).collect();
        let middle = mix(&vertices, &vec![1.0; n]);
        for corners in &triangles {
            let face = corners.map(|v| vertices[v as usize]);
            for share in [1e-3, 1e-6, 1e-9, 1e-12] {
                let on = mix(&face, &[0.2, 0.5, 0.3]);
                points.push(mix(&[on, middle], &[1.0 - share, share]));
                points.push(mix(&[face[0], middle], &[1.0 - share, share]));
            }
        }
        for point in points {
            kind.gradients_into(point, &mut values, &mut gradients).unwrap();
            let steepest = gradients.iter().flatten().fold(1.0, |a: f64, g| a.max(g.abs()));
            assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-13, "{shape}");
            assert!(values.iter().all(|&v| v > -1e-12), "{shape} {point:?} {values:?}");
            for k in 0..3 {
                let place: f64 = values.iter().zip(&vertices).map(|(v, p)| v * (p[k] - point[k])).sum();
                assert!(place.abs() < 1e-12, "{shape} {point:?} {place:e}");
                for l in 0..3 {
                    let slope: f64 = gradients.iter().zip(&vertices).map(|(g, p)| g[l] * (p[k] - point[k])).sum();
                    let truth = if k == l { 1.0 } else { 0.0 };
                    // Distances from planes are rounded: what is left of a gradient at 1e-12 has four digits.
                    let height = points_height(&vertices, &triangles, point).max(1e-14);
                    assert!((slope - truth).abs() < 1e-12 * steepest + 1e-14 / height, "{shape} {point:?} {slope}");
                }
            }
        }
        for (vertex, &place) in vertices.iter().enumerate() {
            kind.values_into(place, &mut values).unwrap();
            assert!(values.iter().enumerate().all(|(i, &v)| v == if i == vertex { 1.0 } else { 0.0 }));
        }
        for corners in &triangles {
            let on = mix(&corners.map(|v| vertices[v as usize]), &[0.25, 0.0, 0.75]);
            kind.values_into(on, &mut values).unwrap();
            let is_face_edge = shape != "cube";
            if is_face_edge {
                assert!((values[corners[0] as usize] - 0.25).abs() < 1e-12, "{shape} {values:?}");
            }
        }
        assert!(kind.values_into([9.0; 3], &mut values).is_err());
    }
}

fn points_height(vertices: &[[f64; 3]], triangles: &[[u32; 3]], point: [f64; 3]) -> f64 {
    let height = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| vertices[v as usize]);
        let (p, q, r) =
            ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]), [0, 1, 2].map(|k| point[k] - a[k]));
        let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        ((0..3).map(|k| n[k] * r[k]).sum::<f64>() / n[0].hypot(n[1]).hypot(n[2])).abs()
    };
    triangles.iter().map(height).fold(f64::INFINITY, f64::min)
}

/// On the unit cube they are the trilinear functions.
#[test]
fn wachspress_of_a_cube_is_trilinear() {
    let (_, vertices, triangles) = solids().remove(0);
    let kind = WachspressPolyhedron::new(&vertices, &triangles).unwrap();
    let mut values = [0.0; 8];
    for point in [[0.2, 0.7, 0.4], [0.5, 0.0, 0.9], [1e-13, 0.3, 1e-12]] {
        kind.values_into(point, &mut values).unwrap();
        for (value, vertex) in values.iter().zip(&vertices) {
            let truth: f64 = (0..3).map(|k| if vertex[k] == 1.0 { point[k] } else { 1.0 - point[k] }).product();
            assert!((value - truth).abs() < 1e-15, "{point:?} {value} {truth}");
        }
    }
}

#[test]
fn meshes_that_bound_nothing_convex_are_refused() {
    let (_, vertices, mut triangles) = solids().remove(2);
    let mut dented = solids().remove(1);
    dented.1[4] = [0.0, 0.0, -0.5];
    assert!(matches!(WachspressPolyhedron::new(&dented.1, &dented.2), Err(PolyhedronError::NotConvex { .. })));
    let inside_out: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert!(matches!(WachspressPolyhedron::new(&vertices, &inside_out), Err(PolyhedronError::NotConvex { .. })));
    triangles.pop();
    assert!(matches!(WachspressPolyhedron::new(&vertices, &triangles), Err(PolyhedronError::NotClosed { .. })));
    assert!(matches!(
        WachspressPolyhedron::new(&vertices, &[[0, 1, 7]]),
        Err(PolyhedronError::NoSuchVertex { triangle: 0, count: 4 })
    ));
}
