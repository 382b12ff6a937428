use super::*;
use crate::homology::Homology;
use crate::link::Link;
use crate::record::read_records;
use crate::sample::{Random, random_gluings};
use crate::signature::{from_signature, signature};

const CENSUS: &str = include_str!("../../../../testdata/hyperbolic/census.json");

/// The cube with opposite sides glued, in `m` by `m` by `m` cubes of six cells: a torus of three dimensions for `m`
/// from 3.
pub(crate) fn torus(m: u32) -> TetrahedronComplex {
    let mut cells = Vec::new();
    let axes = Permutation::all().map(Permutation::images).filter(|images| images[3] == 3);
    let axes: Vec<_> = axes.collect();
    for place in 0..m * m * m {
        for order in &axes {
            let mut at = [place % m, place / m % m, place / m / m];
            let mut cell = [place; 4];
            for (step, &axis) in order[..3].iter().enumerate() {
                at[usize::from(axis)] = (at[usize::from(axis)] + 1) % m;
                cell[step + 1] = at[0] + m * (at[1] + m * at[2]);
            }
            cells.push(cell);
        }
    }
    TetrahedronComplex::from_indices((m * m * m) as usize, &cells).unwrap()
}

fn links_of(triangulation: &Triangulation) -> Vec<Link> {
    Links::new(triangulation, &Skeleton::new(triangulation)).all().to_vec()
}

/// Euler characteristics of links that are neither spheres nor disks, sorted.
fn singular(triangulation: &Triangulation) -> Vec<(i64, bool)> {
    let links = links_of(triangulation);
    let singular = links.iter().filter(|link| !link.is_sphere() && !link.is_disk());
    let mut kinds: Vec<_> = singular.map(|link| (link.euler_characteristic, link.is_orientable)).collect();
    kinds.sort_unstable();
    kinds
}

#[test]
fn a_torus_is_glued_as_its_mesh() {
    let mesh = torus(3);
    let triangulation = Triangulation::from_complex(&mesh).unwrap();
    let skeleton = Skeleton::new(&triangulation);
    assert_eq!((triangulation.len(), skeleton.vertex_count(), skeleton.edges().len()), (162, 27, 189));
    assert!(triangulation.is_closed() && Links::new(&triangulation, &skeleton).all().iter().all(Link::is_sphere));
    assert_eq!(Homology::new(&triangulation).to_string(), "3 Z");
    // Corners are vertices: each class has one name.
    let mut name_of = vec![None; 27];
    for cell in mesh.cell_ids() {
        for (class, vertex) in skeleton.vertices_of(cell.raw()).into_iter().zip(mesh.cell(cell)) {
            assert_eq!(*name_of[class as usize].get_or_insert(vertex), vertex);
        }
    }
}

#[test]
fn a_mesh_comes_back_as_it_is() {
    let triangulation = Triangulation::from_complex(&torus(3)).unwrap();
    let again = triangulation.to_complex().unwrap();
    assert_eq!((again.subdivisions, again.complex.cell_count()), (0, 162));
    assert_eq!(signature(&Triangulation::from_complex(&again.complex).unwrap()), signature(&triangulation));
    // Two cubes round: edges with the same ends, though cells have four vertices.
    let tight = Triangulation::from_complex(&torus(2));
    assert!(matches!(tight, Err(MeshError::CrowdedFace { .. })), "{tight:?}");
}

#[test]
fn meshes_that_are_no_triangulations_are_refused() {
    let complex = |cells: &[[u32; 4]]| TetrahedronComplex::from_indices(6, cells).unwrap();
    let twice = Triangulation::from_complex(&complex(&[[0, 1, 2, 3], [1, 2, 4, 2]]));
    assert_eq!(twice, Err(MeshError::RepeatedVertex { cell: 1, vertex: 2 }));
    let three = Triangulation::from_complex(&complex(&[[0, 1, 2, 3], [4, 2, 1, 0], [0, 5, 2, 1]]));
    assert_eq!(three, Err(MeshError::CrowdedFace { vertices: [0, 1, 2], count: 3, first: [0, 1, 2] }));
}

#[test]
fn a_doubled_tetrahedron_is_subdivided_once() {
    // Two tetrahedra with the same four vertices: a sphere, but no complex.
    let mut doubled = Triangulation::new(2);
    (0..4).for_each(|face| doubled.glue(0, face, 1, Permutation::IDENTITY).unwrap());
    let mesh = doubled.to_complex().unwrap();
    assert_eq!((mesh.subdivisions, mesh.complex.cell_count()), (1, 48));
    assert_is_complex(&mesh.complex);
}

/// No two cells, faces or edges have the same vertices, and a cell has four.
fn assert_is_complex(complex: &TetrahedronComplex) {
    let triangulation = Triangulation::from_complex(complex).unwrap();
    let skeleton = Skeleton::new(&triangulation);
    assert_eq!(skeleton.vertex_count(), complex.vertex_count(), "a vertex came apart");
    assert_eq!(skeleton.edges().len(), complex.edges().len(), "two edges have the same ends");
    assert_eq!(subdivisions_needed(&triangulation, &skeleton), 0);
}

#[test]
fn links_and_homology_survive() {
    let mut random = Random(21);
    let mut triangulations: Vec<_> = read_records(CENSUS).unwrap().into_iter().map(|r| r.triangulation).collect();
    triangulations.extend((0..40).map(|round| random_gluings(&mut random, 1 + round % 4, round % 3)));
    triangulations.push(from_signature("cPcbbbiht").unwrap());
    let mut done = [0; 3];
    for triangulation in &triangulations {
        if Skeleton::new(triangulation).edges().iter().any(|edge| edge.is_reversed) {
            continue;
        }
        let mesh = triangulation.to_complex().unwrap();
        done[mesh.subdivisions as usize] += 1;
        assert_is_complex(&mesh.complex);
        let again = Triangulation::from_complex(&mesh.complex).unwrap();
        assert_eq!(Homology::new(&again), Homology::new(triangulation));
        if triangulation.is_closed() {
            assert_eq!(singular(&again), singular(triangulation));
        }
        let orientable = |t: &Triangulation| Links::new(t, &Skeleton::new(t)).orientation().map(<[bool]>::to_vec);
        assert_eq!(orientable(&again).is_some(), orientable(triangulation).is_some());
        assert!(orientable(&again).is_none_or(|agrees| agrees.iter().all(|&agrees| agrees)), "cells do not agree");
        assert!(mesh.tetrahedra.chunks(24).all(|parts| parts.iter().all(|part| *part == parts[0])));
        // The control: one subdivision is not enough where two were made.
        let once = subdivided(triangulation);
        assert!(mesh.subdivisions < 2 || subdivisions_needed(&once, &Skeleton::new(&once)) == 1);
    }
    assert!(done[2] > 25, "{done:?}");
}

#[test]
fn an_edge_glued_end_for_end_becomes_a_projective_plane() {
    let flip = Permutation::new([1, 0, 3, 2]).unwrap();
    let one = Triangulation::from_gluings(1, &[(0, 3, 0, flip)]).unwrap();
    let mesh = one.to_complex().unwrap();
    assert_is_complex(&mesh.complex);
    let again = Triangulation::from_complex(&mesh.complex).unwrap();
    assert!(singular(&again).contains(&(1, false)));
    assert_eq!(Homology::new(&again), Homology::new(&one));
}

#[test]
fn too_many_cells_are_refused() {
    let many = Triangulation::from_complex(&torus(3)).unwrap();
    assert!(many.to_complex().is_ok());
    let mut rows = Triangulation::new(2_000_000);
    rows.glue(0, 0, 0, Permutation::transposition(0, 1)).unwrap();
    let needed = 2_000_000 * 576;
    assert_eq!(rows.to_complex().unwrap_err(), MeshError::TooManyCells { tetrahedra: 2_000_000, needed });
}
