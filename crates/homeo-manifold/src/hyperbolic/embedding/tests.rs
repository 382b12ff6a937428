//! Planes at the right distances, edges that close, isometries that keep the product, covers without duplicates.

use super::*;
use crate::hyperbolic::minkowski::{in_ball, in_half_space, mobius};
use crate::hyperbolic::testing;

fn embeddings() -> Vec<(Triangulation, Skeleton, Structure, Embedding)> {
    let entries = testing::census().into_iter().filter(|entry| entry.geometry.is_some());
    entries
        .map(|entry| {
            let skeleton = Skeleton::new(&entry.triangulation);
            let structure = Structure::find(&entry.triangulation, &skeleton).unwrap();
            let embedding = Embedding::new(&entry.triangulation, &skeleton, &structure).unwrap();
            (entry.triangulation, skeleton, structure, embedding)
        })
        .collect()
}

#[test]
fn planes_have_the_lengths_as_distances_and_edges_close() {
    let all = embeddings();
    assert!(all.len() >= 10);
    for (triangulation, skeleton, structure, embedding) in &all {
        for t in 0..triangulation.len() {
            for (edge, [i, j]) in EDGES.map(|ends| ends.map(usize::from)).into_iter().enumerate() {
                let known = structure.cosh_lengths()[skeleton.edges_of(t as u32)[edge] as usize].middle();
                let [a, b] = [i, j].map(|k| embedding.planes()[t][k]);
                assert!((product(a, b) + known).abs() < 1e-10 && (product(a, a) - 1.0).abs() < 1e-10);
            }
        }
        assert!(embedding.residuals(skeleton).iter().all(|&gap| gap < 1e-8), "{:?}", embedding.residuals(skeleton));
        assert_eq!(embedding.side_pairings().len(), triangulation.len() + 1);
        for pairing in embedding.side_pairings() {
            let product = compose(&pairing.isometry, &inverse(&pairing.isometry));
            let gaps = product.as_flattened().iter().zip(IDENTITY.as_flattened()).map(|(a, b)| (a - b).abs());
            assert!(gaps.fold(0.0, f64::max) < 1e-9);
        }
    }
    // Negative control: with one isometry left out an edge does not close.
    let (_, skeleton, _, mut broken) = all.into_iter().next().unwrap();
    broken.across[0][0] = IDENTITY;
    assert!(broken.residuals(&skeleton)[0] > 0.1);
}

#[test]
fn covers_have_each_piece_once() {
    for (triangulation, _, _, embedding) in embeddings().into_iter().take(4) {
        let sizes: Vec<usize> = (0..4).map(|depth| embedding.cover(depth).len()).collect();
        assert_eq!(sizes[0], triangulation.len());
        assert!(sizes.windows(2).all(|pair| pair[0] < pair[1]), "{sizes:?}");
        let pieces = embedding.cover(3);
        let distance = |a: &Piece, b: &Piece| (-product(embedding.middle(a), embedding.middle(b))).max(1.0).acosh();
        for (number, piece) in pieces.iter().enumerate() {
            assert!(pieces[..number].iter().all(|other| distance(piece, other) > 0.1));
        }
        // A neighbour of a piece inside is there.
        let near = pieces.iter().filter(|piece| distance(piece, &pieces[0]) < 1e-6).count();
        assert_eq!(near, 1);
    }
}

#[test]
fn surfaces_lie_on_their_planes_and_in_the_models() {
    let (_, _, _, embedding) = embeddings().pop().unwrap();
    for piece in embedding.cover(1) {
        let patches = embedding.surface(&piece, 4);
        assert_eq!(patches.triangles.len(), (24 + 4) * 16);
        let planes = embedding.planes()[piece.tetrahedron as usize].map(|plane| apply(&piece.isometry, plane));
        for (triangle, &face) in patches.triangles.iter().zip(&patches.faces) {
            for point in triangle.map(|corner| patches.positions[corner as usize]) {
                assert!((product(point, point) + 1.0).abs() < 1e-8 * point[0] * point[0]);
                // On the side of all cutting planes; on that of a cut corner.
                assert!(planes.iter().all(|&plane| product(plane, point) < 1e-8 * point[0]));
                if face >= 4 {
                    assert!(product(planes[usize::from(face) - 4], point).abs() < 1e-8 * point[0]);
                }
                assert!(in_ball(point).iter().map(|x| x * x).sum::<f64>() < 1.0 && in_half_space(point)[2] > 0.0);
            }
        }
    }
}

/// The action on the hyperboloid is that of the matrix on the half-space: `w -> ((a w + b) conj(c w + d) + a conj(c) h²) / ...`.
#[test]
fn mobius_matrices_move_points_of_the_half_space_alike() {
    let times = |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
    let conjugate = |a: [f64; 2]| [a[0], -a[1]];
    let mut count = 0;
    for (_, _, _, embedding) in embeddings() {
        for pairing in embedding.side_pairings() {
            let [[a, b], [c, d]] = mobius(&pairing.isometry).unwrap();
            let start = normalized([2.0, 0.3, -0.5, 0.4]);
            let ([x, y, h], expected) = (in_half_space(start), in_half_space(apply(&pairing.isometry, start)));
            let add = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
            let (above, below) = (add(times(a, [x, y]), b), add(times(c, [x, y]), d));
            let size = times(below, conjugate(below))[0] + h * h * times(c, conjugate(c))[0];
            let moved =
                add(times(above, conjugate(below)), times(a, conjugate(c)).map(|x| x * h * h)).map(|x| x / size);
            let found = [moved[0], moved[1], h / size];
            assert!(
                (0..3).all(|k| (found[k] - expected[k]).abs() < 1e-8 * (1.0 + expected[k].abs())),
                "{found:?} {expected:?}"
            );
            count += 1;
        }
    }
    assert!(count > 20, "{count}");
}
