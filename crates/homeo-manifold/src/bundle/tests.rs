//! Unit tangent bundles as manifolds: links, orientation, homology, and the group of the sphere's.

use super::TangentBundle;
use super::surfaces::{glued_handles, torus};
use crate::{FundamentalGroup, Homology, Links, Skeleton, Triangulation};
use homeo_core::mesh::TetrahedronComplex;

const SPHERE: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn manifold(triangles: &[[u32; 3]], layers: u32) -> Triangulation {
    let count = triangles.iter().flatten().max().map_or(0, |&most| most as usize + 1);
    let bundle = TangentBundle::new(triangles, count, layers).unwrap().bundle;
    let vertices = bundle.vertex_count() * layers as usize;
    Triangulation::from_complex(&TetrahedronComplex::from_indices(vertices, &bundle.tetrahedra()).unwrap()).unwrap()
}

#[test]
fn bundles_are_closed_oriented_manifolds_with_the_right_homology() {
    let surfaces = [
        (SPHERE.to_vec(), "Z_2"),
        (torus(4, 3), "3 Z"),
        (glued_handles(2), "4 Z + Z_2"),
        (glued_handles(3), "6 Z + Z_4"),
        (glued_handles(5), "10 Z + Z_8"),
    ];
    for (triangles, expected) in surfaces {
        for layers in [3, 6] {
            let manifold = manifold(&triangles, layers);
            assert!(manifold.is_closed());
            let links = Links::new(&manifold, &Skeleton::new(&manifold));
            assert!(links.orientation().is_some() && links.all().iter().all(|link| link.is_sphere()));
            assert_eq!(Homology::new(&manifold).to_string(), expected, "{layers} layers");
        }
    }
}

type Word = Vec<(u32, bool)>;

fn inverse(word: &[(u32, bool)]) -> Word {
    word.iter().rev().map(|&(generator, is_inverse)| (generator, !is_inverse)).collect()
}

/// Without letters beside their inverses, at the ends of the word too.
fn reduced(word: impl IntoIterator<Item = (u32, bool)>) -> Word {
    let mut short: Word = vec![];
    for (generator, is_inverse) in word {
        if short.last() == Some(&(generator, !is_inverse)) {
            short.pop();
        } else {
            short.push((generator, is_inverse));
        }
    }
    while short.len() > 1 && short[0] == (short[short.len() - 1].0, !short[short.len() - 1].1) {
        short.pop();
        short.remove(0);
    }
    short
}

/// The relations that are left, and the number of generators, when each that a relation has once is expressed by the others,
/// shortest relations first (moves of Tietze: the group stays the same).
fn presentation(manifold: &Triangulation) -> (usize, Vec<Word>) {
    let group = FundamentalGroup::new(manifold);
    let mut generators = group.generators().len();
    let mut words: Vec<Word> = (group.relations().iter())
        .map(|word| reduced(word.iter().map(|letter| (letter.generator, letter.is_inverse))))
        .collect();
    loop {
        words.retain(|word| !word.is_empty());
        words.sort_by(|a, b| (a.len(), a).cmp(&(b.len(), b)));
        words.dedup();
        let single = words.iter().enumerate().find_map(|(number, word)| {
            let is_single = |&at: &usize| word.iter().filter(|letter| letter.0 == word[at].0).count() == 1;
            (0..word.len()).find(is_single).map(|at| (number, at))
        });
        let Some((number, at)) = single else { return (generators, words) };
        let word = words.remove(number);
        // The letter times the rest, run round from it, is 1.
        let (generator, is_inverse) = word[at];
        let rest: Word = word[at + 1..].iter().chain(&word[..at]).copied().collect();
        let value = if is_inverse { rest } else { inverse(&rest) };
        for word in &mut words {
            let substituted = word.iter().flat_map(|&letter| match letter.0 == generator {
                true if letter.1 => inverse(&value),
                true => value.clone(),
                false => vec![letter],
            });
            *word = reduced(substituted);
        }
        generators -= 1;
    }
}

#[test]
fn the_group_of_the_sphere_has_two_elements() {
    for layers in [3, 4] {
        let (generators, words) = presentation(&manifold(&SPHERE, layers));
        assert_eq!(generators, 1);
        // The square of the generator, or of its inverse, and nothing else.
        assert!(!words.is_empty() && words.iter().all(|word| word.len() == 2 && word[0] == word[1]), "{words:?}");
    }
}

/// Negative control: the torus has a group of more than one generator.
#[test]
fn the_group_of_the_torus_needs_more_generators() {
    assert!(presentation(&manifold(&torus(3, 3), 3)).0 >= 3);
}
