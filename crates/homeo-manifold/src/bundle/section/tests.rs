//! Sections of all kinds: indices add up to Euler numbers, paths are paths of the mesh.

use super::super::surfaces::{glued_handles, torus};
use super::super::tangent::TangentBundle;
use super::*;
use std::collections::HashSet;

fn bundle(triangles: &[[u32; 3]], layers: u32) -> CircleBundle {
    let count = triangles.iter().flatten().max().map_or(0, |&most| most as usize + 1);
    TangentBundle::new(triangles, count, layers).unwrap().bundle
}

fn surfaces() -> Vec<Vec<[u32; 3]>> {
    let sphere = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    vec![sphere, torus(4, 3), glued_handles(2), glued_handles(3), glued_handles(5)]
}

/// A multiplicative generator; the high bits are good enough here.
fn random_levels(count: usize, layers: u32, seed: u64) -> Vec<u32> {
    let mut state = seed;
    let next = |_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) % u64::from(layers)) as u32
    };
    (0..count).map(next).collect()
}

#[test]
fn indices_add_up_to_the_euler_number() {
    let (mut sections, mut singular, mut ties) = (0, 0, 0);
    for triangles in surfaces() {
        for layers in [3, 4, 5, 8, 13] {
            let bundle = bundle(&triangles, layers);
            let walls = closed_walls(&bundle).unwrap();
            for seed in 0..8 {
                let section = Section::new(&bundle, random_levels(bundle.vertex_count(), layers, seed)).unwrap();
                let indices: Vec<i64> = section.singularities().map(|(_, index)| index).collect();
                assert!(indices.iter().all(|index| index.abs() == 1));
                assert_eq!(Some(indices.iter().sum()), bundle.euler_number(), "{layers} layers");
                for side in walls.sides() {
                    let turn = section.turn(side);
                    assert_eq!(turn, -section.turn(walls.across(side).unwrap()));
                    assert!(turn % 2 != 0 && turn.abs() <= i64::from(layers));
                    ties += usize::from(turn.abs() == i64::from(layers));
                }
                sections += 1;
                singular += indices.len();
            }
        }
    }
    assert!(sections == 200 && singular > 5000 && ties > 1000, "{sections}, {singular}, {ties}");
}

/// Negative control: with ties that are not antisymmetric the sum is another one.
#[test]
fn ties_that_are_not_antisymmetric_break_the_sum() {
    let bundle = bundle(&glued_handles(2), 3);
    let mut broken = 0;
    for seed in 0..8 {
        let section = Section::new(&bundle, random_levels(bundle.vertex_count(), 3, seed)).unwrap();
        let turns = |triangle: u32| -> i64 {
            let turn = |side| section.turn(Side::new(triangle, side));
            [0, 1, 2].map(|side| if turn(side) == -3 { 3 } else { turn(side) }).into_iter().sum()
        };
        let sum: i64 = (0..bundle.triangles().len() as u32).map(|t| (turns(t) + bundle.turns(t).unwrap()) / 6).sum();
        broken += usize::from(Some(sum) != bundle.euler_number());
    }
    assert!(broken >= 6, "{broken}");
}

#[test]
fn paths_are_edges_of_the_mesh_and_reverse() {
    let mut steps = 0;
    for triangles in surfaces() {
        for layers in [3, 7, 10] {
            let bundle = bundle(&triangles, layers);
            let walls = closed_walls(&bundle).unwrap();
            let edges: HashSet<[u32; 2]> = (bundle.tetrahedra().iter())
                .flat_map(|four| four.iter().flat_map(|&a| four.iter().map(move |&b| [a, b])))
                .collect();
            let section = Section::new(&bundle, random_levels(bundle.vertex_count(), layers, 9)).unwrap();
            for side in walls.sides() {
                let path = section.path(side);
                let [from, to] = super::super::charts::ends(bundle.triangles(), side);
                let at = |vertex: u32| bundle.vertex(vertex, section.levels()[vertex as usize].unwrap());
                assert_eq!((path[0], path[path.len() - 1]), (at(from), at(to)));
                assert!(path.windows(2).all(|step| step[0] != step[1] && edges.contains(&[step[0], step[1]])));
                assert!(path.len() as u32 <= 2 + layers / 2);
                let mut back = section.path(walls.across(side).unwrap());
                back.reverse();
                assert_eq!(path, back);
                steps += path.len() - 1;
            }
        }
    }
    assert!(steps > 3000, "{steps}");
}

#[test]
fn what_is_no_section_is_told() {
    let bundle = bundle(&torus(3, 3), 4);
    assert_eq!(Section::new(&bundle, vec![0; 8]).unwrap_err(), SectionError::Count { given: 8, count: 9 });
    let far = Section::new(&bundle, vec![0, 0, 4, 0, 0, 0, 0, 0, 0]).unwrap_err();
    assert_eq!(far, SectionError::NoLevel { vertex: 2, level: 4, layers: 4 });
    let flat = Section::from_vectors(&bundle, &[[0.0; 3]; 9], &[[1.0, 0.0, 0.0]; 9]).unwrap_err();
    assert_eq!(flat, SectionError::Flat { vertex: 0 });
}

#[test]
fn a_base_with_vertices_beyond_all_numbers_is_told() {
    let bundle = bundle(&torus(3, 3), 4);
    let section = Section::new(&bundle, vec![0; 9]).unwrap();
    let mut base = bundle.triangles().to_vec();
    let wound = |base: &[[u32; 3]]| WoundPaths::new(base, 4, &bundle.tetrahedra(), &section.paths());
    assert!(wound(&base).is_ok());
    base[0][0] = u32::MAX;
    let fault = PathFault::TooLarge { triangle: 0, vertex: u32::MAX, layers: 4 };
    assert_eq!(wound(&base).unwrap_err(), fault);
}

/// An octahedron with its eight triangles split into four, three times, on the unit sphere.
pub(super) fn sphere() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut places: Vec<[f64; 3]> =
        (0..6).map(|k| [0, 1, 2].map(|axis| f64::from(k / 2 == axis) * f64::from(1 - k % 2 * 2))).collect();
    let mut triangles: Vec<[u32; 3]> =
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]].to_vec();
    for _ in 0..3 {
        let mut middles = std::collections::HashMap::new();
        let mut finer = vec![];
        for [a, b, c] in triangles {
            let [d, e, f] = [[a, b], [b, c], [c, a]].map(|[a, b]| {
                *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    let sum = [0, 1, 2].map(|axis| places[a as usize][axis] + places[b as usize][axis]);
                    let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                    places.push(sum.map(|x| x / length));
                    places.len() as u32 - 1
                })
            });
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        triangles = finer;
    }
    (places, triangles)
}

/// The rotation about an axis on a sphere: whatever the axis, indices add up to 2.
#[test]
fn fields_on_a_sphere_have_indices_that_add_up_to_two() {
    let (mut places, triangles) = sphere();
    let tangent = TangentBundle::new(&triangles, places.len(), 8).unwrap();
    for carrier in &tangent.added {
        places.push(carrier.point(&places));
    }
    for axis in [[0.3, 0.2, 0.9], [-0.5, 0.6, 0.1]] {
        let turned = |p: &[f64; 3]| {
            [0, 1, 2].map(|k: usize| axis[(k + 1) % 3] * p[(k + 2) % 3] - axis[(k + 2) % 3] * p[(k + 1) % 3])
        };
        let vectors: Vec<_> = places.iter().map(turned).collect();
        let section = Section::from_vectors(&tangent.bundle, &places, &vectors).unwrap();
        assert_eq!(section.singularities().map(|(_, index)| index).sum::<i64>(), 2);
        // Turning the field by half the number of layers changes no index.
        let opposite: Vec<_> = vectors.iter().map(|v| v.map(|x| -x)).collect();
        let half = Section::from_vectors(&tangent.bundle, &places, &opposite).unwrap();
        let agree =
            section.levels().iter().zip(half.levels()).filter(|(a, b)| (a.unwrap() + 4) % 8 == b.unwrap()).count();
        assert!(agree * 10 >= 9 * places.len(), "{agree} of {}", places.len());
    }
    let zero = Section::from_vectors(&tangent.bundle, &places, &vec![[0.0; 3]; places.len()]).unwrap_err();
    assert!(matches!(zero, SectionError::Zeros { .. }), "{zero}");
}
