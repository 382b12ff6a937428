//! Fields with a vector for each triangle: the indices of vertices are the turning of the field from triangle to triangle.

use super::super::middles::MiddleSurface;
use super::super::tangent::TangentBundle;
use super::field_tests::{
    Surface, Vector, ball, length, minus, normal, product, random, round_torus, unless_wound, whole,
};
use super::{Section, SectionError};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// The indices of vertices, from triangle to triangle in space: no middles, no fans, no bundle.
fn turning(surface: &Surface, vectors: &[Vector]) -> Vec<i64> {
    let Surface { places, triangles } = surface;
    let mut after: Vec<HashMap<u32, (u32, usize)>> = vec![HashMap::new(); places.len()];
    for (number, corners) in triangles.iter().enumerate() {
        for k in 0..3 {
            after[corners[k] as usize].insert(corners[(k + 1) % 3], (corners[(k + 2) % 3], number));
        }
    }
    let edge = |from: usize, to: u32| minus(places[to as usize], places[from]);
    // The angle of the vector of a triangle from an edge of it.
    let angle = |triangle: usize, edge: Vector| {
        let [a, b, c] = triangles[triangle].map(|v| places[v as usize]);
        let up = normal(minus(b, a), minus(c, a));
        let left = normal(up, edge);
        (product(vectors[triangle], left) / length(left)).atan2(product(vectors[triangle], edge) / length(edge))
    };
    let index = |(vertex, fan): (usize, &HashMap<u32, (u32, usize)>)| {
        let mut sum = TAU;
        for (&first, &(second, here)) in fan {
            let [e, f] = [edge(vertex, first), edge(vertex, second)];
            let there = fan[&second].1;
            let turn = angle(there, f) - angle(here, f);
            sum += turn.sin().atan2(turn.cos()) - (product(e, f) / (length(e) * length(f))).acos();
        }
        whole(sum)
    };
    after.iter().enumerate().map(index).collect()
}

fn made(surface: &Surface, layers: u32) -> (MiddleSurface, TangentBundle) {
    let middles = MiddleSurface::new(&surface.triangles, surface.places.len()).unwrap();
    let tangent = TangentBundle::new(middles.triangles(), middles.vertex_count(), layers).unwrap();
    (middles, tangent)
}

fn found(surface: &Surface, vectors: &[Vector], layers: u32) -> Vec<i64> {
    let (middles, tangent) = made(surface, layers);
    let section = middles.section(&tangent, &surface.places, vectors).unwrap();
    unless_wound(&tangent, &section);
    middles.indices(&tangent, &section)
}

#[test]
fn indices_are_the_turning_of_random_fields() {
    let (mut singular, mut elsewhere, mut added, mut fields) = (0, 0, 0, 0);
    for (surface, characteristic) in [(ball(), 2), (round_torus(9, 7), 0)] {
        for layers in [3, 8, 90] {
            let (middles, tangent) = made(&surface, layers);
            added += usize::from(!tangent.added.is_empty());
            for seed in 0..5 {
                let vectors = random(surface.triangles.len(), 40 + seed);
                let section = middles.section(&tangent, &surface.places, &vectors).unwrap();
                let indices = middles.indices(&tangent, &section);
                assert_eq!(indices, turning(&surface, &vectors), "{layers} layers, seed {seed}");
                assert_eq!(indices.iter().sum::<i64>(), characteristic);
                unless_wound(&tangent, &section);
                // Negative control: with one vector turned back some index is another one.
                let mut other = vectors.clone();
                other[7] = other[7].map(|x| -x);
                let changed = middles.section(&tangent, &surface.places, &other).unwrap();
                elsewhere += usize::from(middles.indices(&tangent, &changed) != indices);
                singular += indices.iter().filter(|index| **index != 0).count();
                fields += 1;
            }
        }
    }
    assert!(fields == 30 && singular > 300 && elsewhere >= 20 && added > 0, "{singular}, {elsewhere}, {added}");
}

/// The gradient of the height along an axis, on each triangle.
fn gradient(surface: &Surface, axis: Vector) -> Vec<Vector> {
    let on = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| surface.places[v as usize]);
        let up = normal(minus(b, a), minus(c, a));
        let share = product(axis, up) / product(up, up);
        [0, 1, 2].map(|k| axis[k] - share * up[k])
    };
    surface.triangles.iter().map(on).collect()
}

/// Highest and lowest vertices have index 1, saddles -1: all by comparing heights round a vertex, as Banchoff does.
#[test]
fn gradients_of_heights_have_the_indices_of_their_critical_vertices() {
    for (surface, expected) in [(round_torus(23, 16), vec![-1, -1, 1, 1]), (ball(), vec![1, 1])] {
        let axis = [1.0, 0.05, 0.02];
        let indices = found(&surface, &gradient(&surface, axis), 8);
        let mut singular: Vec<i64> = indices.iter().copied().filter(|&index| index != 0).collect();
        singular.sort_unstable();
        assert_eq!(singular, expected);
        let height = |v: u32| product(surface.places[v as usize], axis);
        for (vertex, &index) in (0..).zip(&indices) {
            let changes = surface.triangles.iter().filter(|corners| corners.contains(&vertex)).filter(|corners| {
                let others: Vec<bool> =
                    corners.iter().filter(|&&v| v != vertex).map(|&v| height(v) > height(vertex)).collect();
                others[0] != others[1]
            });
            assert_eq!(index, 1 - changes.count() as i64 / 2, "vertex {vertex}");
        }
    }
}

/// The field conj(z)^k on the parameters of a torus, with its zero at a vertex: a zero of index -k.
#[test]
fn zeros_at_vertices_have_their_index() {
    let (a, b, centre) = (24, 18, 12 * 18 + 9);
    let surface = round_torus(a, b);
    for (order, expected) in [(-2, 2), (-1, 1), (1, -1), (2, -2)] {
        let vector = |(number, corners): (usize, &[u32; 3])| {
            // Both triangles of a square begin with its first corner; the six round a vertex are equally far from one another.
            let (i, j) = (number as u32 / 2 / b, number as u32 / 2 % b);
            let thirds = if number % 2 == 0 { [2.0, 1.0] } else { [1.0, 2.0] };
            let [x, y] = [f64::from(i) + thirds[0] / 3.0 - 12.0, f64::from(j) + thirds[1] / 3.0 - 9.0];
            let [x, y] = [x - 0.5 * y, 0.75_f64.sqrt() * y];
            let angle = -f64::from(order) * y.atan2(x);
            let at = |v: u32| surface.places[v as usize];
            let [along, across] = if number % 2 == 0 {
                [minus(at(corners[1]), at(corners[0])), minus(at(corners[2]), at(corners[1]))]
            } else {
                [minus(at(corners[1]), at(corners[2])), minus(at(corners[2]), at(corners[0]))]
            };
            let [along, across] = [along, across].map(|v| v.map(|x| x / length(v)));
            [0, 1, 2].map(|k| angle.cos() * along[k] + angle.sin() * across[k])
        };
        let vectors: Vec<Vector> = surface.triangles.iter().enumerate().map(vector).collect();
        let indices = found(&surface, &vectors, 8);
        assert_eq!(indices[centre], expected, "order {order}");
        assert_eq!(indices, turning(&surface, &vectors));
    }
}

#[test]
fn what_says_nothing_of_an_index_is_refused_with_its_triangles() {
    let surface = ball();
    let (middles, tangent) = made(&surface, 5);
    let vectors = random(surface.triangles.len(), 3);
    let refused = |vectors: &[Vector]| middles.section(&tangent, &surface.places, vectors).unwrap_err();
    let with = |triangle: usize, vector: Vector| {
        let mut other = vectors.clone();
        other[triangle] = vector;
        other
    };
    let [a, b, c] = surface.triangles[11].map(|v| surface.places[v as usize]);
    let up = normal(minus(b, a), minus(c, a));
    for vector in [[0.0; 3], up, [0.0, f64::NAN, 1.0], [f64::INFINITY, 0.0, 0.0]] {
        assert_eq!(refused(&with(11, vector)), SectionError::NoVector { triangle: 11 });
    }
    // Along the common edge, and against it.
    let [first, second, _] = surface.triangles[11];
    let is_across = |corners: &[u32; 3]| (0..3).any(|k| [corners[k], corners[(k + 1) % 3]] == [second, first]);
    let other = surface.triangles.iter().position(is_across).unwrap();
    let mut opposite = with(11, minus(b, a));
    opposite[other] = minus(a, b);
    let SectionError::OppositeTriangles { first, second } = refused(&opposite) else { panic!("not opposite") };
    assert_eq!([first.min(second), first.max(second)], [other.min(11) as u32, other.max(11) as u32]);
    let count = surface.triangles.len();
    assert_eq!(refused(&vectors[1..]), SectionError::TriangleCount { given: count - 1, count });
    let mut places = surface.places.clone();
    places[surface.triangles[4][0] as usize] = places[surface.triangles[4][1] as usize];
    let flat = middles.section(&tangent, &places, &vectors).unwrap_err();
    assert!(matches!(flat, SectionError::FlatTriangle { .. }), "{flat}");
    let elsewhere = TangentBundle::new(&surface.triangles, surface.places.len(), 5).unwrap();
    let refused = middles.section(&elsewhere, &surface.places, &vectors).unwrap_err();
    assert!(matches!(refused, SectionError::NotMiddles { .. }), "{refused}");
    assert!(matches!(MiddleSurface::new(&surface.triangles[1..], 1000), Err(SectionError::NotClosed { .. })));
}

/// Middles lie in their triangles, and the surface is closed with the same Euler characteristic.
#[test]
fn the_surface_of_middles_is_the_same_surface() {
    for surface in [ball(), round_torus(5, 4)] {
        let middles = MiddleSurface::new(&surface.triangles, surface.places.len()).unwrap();
        let [faces, vertices] = [middles.triangles().len(), middles.vertex_count()].map(|count| count as i64);
        let source = surface.places.len() as i64 - surface.triangles.len() as i64 / 2;
        assert_eq!(vertices - faces / 2, source);
        let places = middles.places(&surface.places).unwrap();
        for (corners, middle) in surface.triangles.iter().zip(&places[surface.places.len()..]) {
            let [a, b, c] = corners.map(|v| places[v as usize]);
            // As far from each side.
            let distance = |a: Vector, b: Vector| length(normal(minus(b, a), minus(*middle, a))) / length(minus(b, a));
            let [p, q, r] = [distance(a, b), distance(b, c), distance(c, a)];
            assert!((p - q).abs() < 1e-12 && (q - r).abs() < 1e-12 && p > 0.0);
        }
    }
}

/// Sections of levels alone, over the same surface, have other indices: these are those of the field by its turns only.
#[test]
fn shortest_turns_have_other_indices() {
    let surface = ball();
    let (middles, tangent) = made(&surface, 8);
    let section = middles.section(&tangent, &surface.places, &random(surface.triangles.len(), 1)).unwrap();
    let levels = section.levels().iter().map(|level| level.unwrap_or(0)).collect();
    let shortest = Section::new(&tangent.bundle, levels).unwrap();
    assert_ne!(middles.indices(&tangent, &shortest), middles.indices(&tangent, &section));
}
