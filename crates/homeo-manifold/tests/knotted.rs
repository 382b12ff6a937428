//! From meshes of solids with tunnels to hyperbolic structures: the mesh must not matter.

#[path = "common/lattice.rs"]
mod lattice;

use homeo_core::mesh::TetrahedronComplex;
use homeo_manifold::hyperbolic::{NoMetric, find_by_retriangulating, find_canonical};
use homeo_manifold::simplify::{Simplifier, coned, without_inner_vertices};
use homeo_manifold::{Homology, Triangulation, from_signature, signature};
use lattice::Place;

fn mesh(paths: &[Vec<Place>], renumber: impl Fn(usize, usize) -> usize) -> Triangulation {
    let (vertices, cells) = lattice::tunnelled(paths);
    let mut renamed = vec![[0; 4]; cells.len()];
    for (number, cell) in cells.iter().enumerate() {
        renamed[renumber(number, cells.len())] = *cell;
    }
    Triangulation::from_complex(&TetrahedronComplex::from_indices(vertices.len(), &renamed).unwrap()).unwrap()
}

/// Few tetrahedra with truncated vertices, from many.
fn truncated(mesh: &Triangulation, seed: u64) -> Triangulation {
    let coarse = without_inner_vertices(&coned(mesh).unwrap()).unwrap();
    assert_eq!(Homology::new(&coarse), Homology::new(mesh), "the first homology has changed");
    let mut simplifier = Simplifier::new(&coarse, seed).unwrap();
    simplifier.run(200);
    simplifier.best().clone()
}

fn swapped(paths: &[Vec<Place>], axes: [usize; 3]) -> Vec<Vec<Place>> {
    paths.iter().map(|path| path.iter().map(|place| axes.map(|axis| place[axis])).collect()).collect()
}

#[test]
fn the_knotted_y_is_the_tripus_whatever_its_mesh() {
    let paths = lattice::knotted_y();
    let tripus = signature(&from_signature("cPcbbbihq").unwrap());
    let straight = truncated(&mesh(&paths, |number, _| number), 1);
    assert_eq!(signature(&straight), tripus);
    // Another order of the cells, another seed.
    let shuffled = truncated(&mesh(&paths, |number, count| number * 7919 % count), 2);
    assert_eq!(signature(&shuffled), tripus);
    // The mirror image, which another diagonal of the cubes meshes: signatures do not tell mirror images apart.
    let mirrored = truncated(&mesh(&swapped(&paths, [1, 0, 2]), |number, _| number), 3);
    assert_eq!(signature(&mirrored), tripus);
    let found = find_by_retriangulating(&straight, 1, 10, || true).unwrap();
    assert!((found.structure.volume().middle() - 6.451_990_270_8).abs() < 1e-9);
}

#[test]
fn fingers_that_hold_nothing_leave_a_handle_body_without_structure() {
    // The last finger goes back before it is round the first arm.
    let mut paths = lattice::knotted_y();
    let knotted_arm = paths[2].len();
    paths[2].retain(|place| place[1] > 3);
    assert_eq!(paths[2].len(), knotted_arm - 2);
    for place in paths[2].iter_mut().filter(|place| place[0] < 4) {
        place[0] = 4;
    }
    let small = truncated(&mesh(&paths, |number, _| number), 1);
    assert_eq!(Homology::new(&small).to_string(), "2 Z");
    let refusal = find_by_retriangulating(&small, 1, 30, || true).unwrap_err();
    assert!(matches!(refusal, NoMetric::LowDegree { .. } | NoMetric::NoAngles { .. }), "{refusal}");
}

#[test]
fn four_entangled_arms_have_one_volume_in_all_meshes() {
    let paths = lattice::knotted_x();
    let volume = |axes, seed| {
        let small = truncated(&mesh(&swapped(&paths, axes), |number, count| number * 104_729 % count), seed);
        assert_eq!(Homology::new(&small).to_string(), "3 Z");
        find_by_retriangulating(&small, seed, 300, || true).unwrap().structure.volume().middle()
    };
    let volumes = [volume([0, 1, 2], 1), volume([0, 1, 2], 2), volume([1, 0, 2], 3)];
    assert!(volumes.iter().all(|volume| (volume - volumes[0]).abs() < 1e-8), "{volumes:?}");
}

#[test]
fn arms_in_a_row_have_one_name_in_all_meshes() {
    let paths = lattice::entangled(3, &[(0, 1), (1, 2), (2, 0)]);
    let name = |axes, seed| {
        let small = truncated(&mesh(&swapped(&paths, axes), |number, count| number * 104_729 % count), seed);
        let found = find_by_retriangulating(&small, seed, 300, || true).unwrap();
        let canonical = find_canonical(&found.triangulation, &found.structure, 1000, || true).unwrap();
        (signature(&canonical.triangulation), canonical.structure.volume().middle())
    };
    let (first, volume) = name([0, 1, 2], 1);
    // In the census, and not the tripus.
    assert!((volume - 8.375_485_953_1).abs() < 1e-8, "{volume}");
    assert_eq!(first, name([1, 0, 2], 2).0);
}
