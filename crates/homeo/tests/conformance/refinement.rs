//! Refinement: the children of a cell tile it, exactly, and neighbours agree on their common facets.

use std::collections::BTreeMap;

use homeo::input::SourceMesh;
use homeo::refine::{RefinedMesh, Stars, spanning_simplices};
use homeo_core::mesh::VertexId;
use homeo_core::number::Rational;
use proptest::prelude::*;

use crate::points::rational;
use crate::random::Random;
use crate::shapes::{Shape, balls, disks};

/// Stars each simplex with the given probability, as often as asked.
fn refined<const K: usize>(source: &SourceMesh<K>, rounds: usize, share: f64, seed: u64) -> RefinedMesh<K> {
    let mut random = Random::new(seed);
    let mut mesh = RefinedMesh::unrefined(source);
    for _ in 0..rounds {
        let adjacency = mesh.complex().adjacency().expect("still a manifold");
        let edges = mesh.complex().edges();
        let mut stars = Stars::none(mesh.complex().cell_count(), edges.len());
        stars.cells.iter_mut().for_each(|star| *star = random.unit() < share);
        stars.edges.iter_mut().for_each(|star| *star = random.unit() < share);
        if K == 4 {
            stars.facets.iter_mut().for_each(|bits| *bits = random.bits() as u8 & random.bits() as u8 & 15);
        }
        mesh.star(source, &adjacency, &edges, &stars).expect("not too deep");
    }
    mesh
}

/// Barycentric coordinates of a refined vertex in a source cell.
fn coordinates<const K: usize>(mesh: &RefinedMesh<K>, parent: [VertexId; K], vertex: VertexId) -> [Rational; K] {
    let carrier = mesh.carrier(vertex);
    let mut row: [Rational; K] = std::array::from_fn(|_| Rational::ZERO);
    for (corner, weight) in carrier.terms() {
        let at = parent.iter().position(|&p| p == corner).expect("carriers lie in the parent");
        row[at] = rational(weight, carrier.total());
    }
    row
}

/// By elimination; slow and plain.
fn determinant(mut rows: Vec<Vec<Rational>>) -> Rational {
    let mut product = Rational::ONE;
    while let Some(pivot) = rows.iter().position(|row| !row[0].is_zero()) {
        if pivot % 2 == 1 {
            product = -product;
        }
        let top = rows.remove(pivot);
        product = &product * &top[0];
        for row in &mut rows {
            let factor = &row[0] / &top[0];
            *row = (1..row.len()).map(|k| &row[k] - &(&factor * &top[k])).collect();
        }
        if rows.is_empty() {
            return product;
        }
    }
    Rational::ZERO
}

/// The volumes of the children are positive and add up to 1.
fn check_tiling<const K: usize>(source: &SourceMesh<K>, mesh: &RefinedMesh<K>) -> Result<(), String> {
    let mut sums = vec![Rational::ZERO; source.complex().cell_count()];
    for (cell, parent) in mesh.complex().cells().iter().zip(mesh.parents()) {
        let corners = source.complex().cell(*parent);
        let rows = cell.iter().map(|&v| coordinates(mesh, corners, v).to_vec()).collect();
        let volume = determinant(rows);
        if volume <= Rational::ZERO {
            return Err(format!("{cell:?} in {parent} has volume {volume}"));
        }
        sums[parent.index()] = &sums[parent.index()] + &volume;
    }
    match sums.iter().position(|sum| *sum != Rational::ONE) {
        Some(cell) => Err(format!("the children of {cell} make up {} of it", sums[cell])),
        None => Ok(()),
    }
}

/// Every facet has two cells, or one and lies in the source's boundary; no two vertices are at one place.
fn check_gluing<const K: usize>(source: &SourceMesh<K>, mesh: &RefinedMesh<K>) -> Result<(), String> {
    let adjacency = mesh.complex().adjacency().map_err(|e| e.to_string())?;
    let before = source.complex().adjacency().map_err(|e| e.to_string())?;
    for facet in adjacency.boundary_facets() {
        let parent = mesh.parents()[facet.cell().index()];
        let corners = source.complex().cell(parent);
        let rows: Vec<_> = mesh
            .complex()
            .facet_vertices(facet.cell(), facet.opposite())
            .map(|v| coordinates(mesh, corners, v))
            .collect();
        let is_covered = |i: usize| before.across(parent, i).is_none() && rows.iter().all(|row| row[i].is_zero());
        if !(0..K).any(is_covered) {
            return Err(format!("facet {facet:?} is open inside the mesh"));
        }
    }
    let mut places = BTreeMap::new();
    for vertex in (0..mesh.complex().vertex_count()).map(VertexId::new) {
        let mut terms: Vec<_> = mesh.carrier(vertex).terms().collect();
        terms.sort_unstable();
        if let Some(other) = places.insert(terms, vertex) {
            return Err(format!("vertices {other} and {vertex} are one point"));
        }
    }
    Ok(())
}

fn check<const K: usize>(shape: &Shape<K>, rounds: usize, share: f64, seed: u64) -> Result<(), String> {
    let source = shape.mesh();
    let mesh = refined(&source, rounds, share, seed);
    check_tiling(&source, &mesh)?;
    check_gluing(&source, &mesh)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn stars_of_a_disk_tile_it(rounds in 1usize..4, share in 0.0..0.8, seed in any::<u64>()) {
        prop_assert_eq!(check(&disks::random_splits(5, seed), rounds, share, seed), Ok(()));
    }

    #[test]
    fn stars_of_a_ball_tile_it(rounds in 1usize..3, share in 0.0..0.6, seed in any::<u64>()) {
        prop_assert_eq!(check(&balls::random_splits(2, seed), rounds, share, seed), Ok(()));
    }

    #[test]
    fn a_refined_mesh_comes_back_from_its_parts(share in 0.0..0.8, seed in any::<u64>()) {
        let source = balls::two_tetrahedra().mesh();
        let mesh = refined(&source, 1, share, seed);
        let parts = (mesh.complex().clone(), mesh.added().to_vec(), mesh.parents().to_vec());
        let again = RefinedMesh::from_parts(&source, parts.0, parts.1, parts.2).expect("parts of a mesh");
        prop_assert_eq!(again.positions(), mesh.positions());
        prop_assert_eq!(again.complex(), mesh.complex());
    }

    /// What the front needs: after starring, no interior edge joins boundary to boundary, and no cell but a single one
    /// has two boundary facets.
    #[test]
    fn nothing_spans_after_starring(seed in any::<u64>(), count in 4usize..9) {
        let source = balls::chord_prism(count, seed).mesh();
        let mut mesh = RefinedMesh::unrefined(&source);
        let mut rounds = 0;
        loop {
            let adjacency = mesh.complex().adjacency().expect("a manifold");
            let edges = mesh.complex().edges();
            let stars = spanning_simplices(mesh.complex(), &adjacency, &edges);
            if stars.is_empty() {
                let most = mesh.complex().cell_ids().map(|c| (0..4).filter(|&i| adjacency.across(c, i).is_none()).count());
                prop_assert!(most.max() <= Some(1));
                break;
            }
            mesh.star(&source, &adjacency, &edges, &stars).expect("not too deep");
            rounds += 1;
            prop_assert!(rounds == 1, "starring once is not enough");
        }
        prop_assert_eq!(check_tiling(&source, &mesh), Ok(()));
        prop_assert_eq!(check_gluing(&source, &mesh), Ok(()));
    }
}

#[test]
fn checks_notice_a_cell_too_many_and_a_cell_turned_round() {
    let source = balls::two_tetrahedra().mesh();
    let mesh = refined(&source, 1, 1.0, 3);
    let damaged = |change: &dyn Fn(&mut Vec<[VertexId; 4]>)| {
        let mut cells = mesh.complex().cells().to_vec();
        change(&mut cells);
        let complex = homeo_core::mesh::SimplicialComplex::new(mesh.complex().vertex_count(), cells).expect("indices");
        let parts = RefinedMesh::from_parts(&source, complex, mesh.added().to_vec(), mesh.parents().to_vec());
        let parts = parts.expect("they still lie in their parents");
        check_tiling(&source, &parts).and_then(|()| check_gluing(&source, &parts))
    };
    assert_eq!(damaged(&|_| {}), Ok(()));
    assert!(damaged(&|cells| cells[1] = cells[0]).is_err());
    assert!(damaged(&|cells| cells[2].swap(0, 1)).is_err());
}
