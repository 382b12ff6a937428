//! What is no disk or ball: constructions end, with an error, and soon.

use homeo::construct::foliation::{FoliationError, FoliationParams, build};
use homeo::input::SourceMesh;
use homeo::map::{Foliation, Target};
use homeo::progress::Silent;
use homeo_core::mesh::SimplicialComplex;

use crate::shapes::{Shape, balls, disks};

/// Without the generator's own orientation.
fn mesh<const K: usize>(shape: &Shape<K>) -> SourceMesh<K> {
    let complex = SimplicialComplex::from_indices(shape.positions.len(), &shape.cells).expect("indices");
    SourceMesh::new(shape.positions.clone(), complex)
}

fn answer<const K: usize>(shape: &Shape<K>, target: Target) -> Result<Foliation<K>, FoliationError> {
    build(&mesh(shape), target, &FoliationParams::default(), &Silent).map(|(map, _)| map)
}

fn refuse_surface(shape: &Shape<3>) {
    for target in [Target::Square, Target::Disk] {
        assert!(matches!(answer(shape, target), Err(FoliationError::Input(_))), "mapped onto a {target}");
    }
}

/// The same shape twice, side by side.
fn twice<const K: usize>(shape: &Shape<K>) -> Shape<K> {
    let n = shape.positions.len() as u32;
    let moved = shape.clone().offset(3.0);
    let positions = [shape.positions.clone(), moved.positions].concat();
    let cells = [shape.cells.clone(), shape.cells.iter().map(|cell| cell.map(|v| v + n)).collect()].concat();
    Shape { positions, cells }
}

#[test]
fn a_triangle_turned_round_is_refused() {
    let mut disk = disks::grid(3, 3);
    disk.cells[4].swap(0, 1);
    refuse_surface(&disk);
}

#[test]
fn two_pieces_are_refused() {
    refuse_surface(&twice(&disks::fan(5)));
    for target in [Target::Cube, Target::Ball] {
        assert!(answer(&twice(&balls::tetrahedron()), target).is_err(), "mapped onto a {target}");
    }
}

#[test]
fn an_annulus_is_refused() {
    refuse_surface(&disks::grid_where(3, 3, |x, y| (x, y) != (1, 1)));
}

#[test]
fn a_sphere_is_refused() {
    let mut sphere = disks::triangle();
    sphere.positions.push([0.3, 0.3, 1.0]);
    sphere.cells = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    refuse_surface(&sphere);
}

#[test]
fn the_wrong_dimension_is_refused() {
    assert!(matches!(answer(&disks::fan(4), Target::Cube), Err(FoliationError::WrongTarget { .. })));
    assert!(matches!(answer(&balls::tetrahedron(), Target::Disk), Err(FoliationError::WrongTarget { .. })));
}

/// A solid torus is no ball: no cap on its boundary leaves an annulus, whatever else may be found there.
#[test]
fn a_solid_torus_gets_no_certified_map() {
    let ring = balls::kuhn_where([3, 3, 1], |p| (p[0], p[1]) != (1, 1));
    for target in [Target::Cube, Target::Ball] {
        let params = FoliationParams { refinements: 1, restarts: 2, ..FoliationParams::default() };
        if let Ok((map, _)) = build(&mesh(&ring), target, &params, &Silent) {
            let verdict = homeo_verify::verify_bytes(&crate::bytes_of(&map.into()));
            assert!(matches!(verdict, Ok(homeo_verify::Verdict::Refuted(_))), "{target}: {verdict:?}");
        }
    }
}
