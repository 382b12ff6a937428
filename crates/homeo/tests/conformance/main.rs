//! The conformance suite: every kind of mesh, onto every target, under every law.
//!
//! `shapes` makes meshes, `points` makes rational points, `laws` says what must hold for them, and
//! `moved` has meshes in space that move, `planar` has the laws of maps between polygons; `controls` shows that the laws notice maps that are wrong.

mod controls;
mod hostile;
mod laws;
mod moved;
mod order;
mod overlays;
mod planar;
mod planar_holes;
mod points;
mod random;
mod refinement;
mod refused;
mod shapes;
mod shells;
mod transfers;

use std::io::Cursor;

use homeo::certificate::{FoliationMap, Provenance, StoredMap, read_map, write_map};
use homeo::construct::foliation::{FoliationParams, build};
use homeo::input::SourceMesh;
use homeo::map::{Bijection, Foliation, Target};
use homeo::progress::Silent;
use homeo_verify::{Verdict, verify_bytes};

use points::{Places, target_sample};
use shapes::{Shape, balls, disks, hard};

/// Points per map; every kind of place gets some.
const POINTS: usize = 120;

fn built<const K: usize>(source: &SourceMesh<K>, target: Target) -> Foliation<K> {
    match build(source, target, &FoliationParams::default(), &Silent) {
        Ok((map, _)) => map,
        Err(error) => panic!("no map onto the {target}: {error}"),
    }
}

fn in_threads<T: Send>(count: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads").install(work)
}

fn bytes_of(map: &FoliationMap) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    write_map(map, &Provenance::default(), &mut bytes).expect("memory can be written");
    bytes.into_inner()
}

fn check<const K: usize>(shape: &Shape<K>, target: Target)
where
    FoliationMap: From<Foliation<K>>,
{
    let source = shape.mesh();
    let map = in_threads(1, || built(&source, target));
    let places = Places::new(&source);
    let from = places.sample(&map, POINTS, 1);
    let to = target_sample(target, POINTS, 2);
    let law = |what: &str, law: laws::Law| law.unwrap_or_else(|broken| panic!("{what}: {broken}"));

    law("there and back", laws::source_points_come_back(&map, &target, &from));
    law("back and there", laws::target_points_come_back(&map, &target, &to, &|p| places.is_on_boundary(p)));
    let compared =
        laws::floating_images_enclose(&map, &target, &from).unwrap_or_else(|broken| panic!("images: {broken}"));
    assert!(compared > 0, "no double lies in the mesh");
    law("preimages", laws::floating_preimages_enclose(&map, &target, &to));
    law("outside", laws::outside_is_refused(&map, &target, far_from(&source)));
    order::check_directions(&map);

    let map = FoliationMap::from(map);
    let bytes = bytes_of(&map);
    let again = in_threads(2, || FoliationMap::from(built(&source, target)));
    assert!(bytes == bytes_of(&again), "the file differs when built again with two threads");
    let Ok(StoredMap::Foliation(read)) = read_map(&bytes) else { panic!("what was written can be read") };
    assert!(bytes == bytes_of(&read), "the file differs when read and written");
    law("after reading", laws::answers_are_the_same([&map, &read], &target, &from, &to));
    match verify_bytes(&bytes) {
        Ok(Verdict::Certified(_)) => {}
        other => panic!("not certified: {other:?}"),
    }
    let doubles: Vec<[f64; 3]> = from.iter().map(|p| points::rounded(&p.at)).collect();
    let batches = [1, 2].map(|threads| in_threads(threads, || map.forward_batch(&doubles)));
    assert!(batches[0] == batches[1], "a batch depends on the threads");
    assert!(batches[0].iter().zip(&doubles).all(|(answer, &p)| *answer == map.forward(p)), "a batch differs");
}

fn far_from<const K: usize>(source: &SourceMesh<K>) -> [f64; 3] {
    let size = source.positions().iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    [3.0 * size, 0.0, 0.0]
}

/// One module per mesh with a test per target.
macro_rules! conformance {
    ($($name:ident: $shape:expr => $($test:ident $target:ident),+;)+) => {$(
        mod $name {
            use super::*;
            $(#[test]
            fn $test() {
                check(&$shape, Target::$target);
            })+
        }
    )+};
}

macro_rules! disk_conformance {
    ($($name:ident: $shape:expr;)+) => {
        conformance! { $($name: $shape => onto_square Square, onto_disk Disk;)+ }
    };
}

macro_rules! ball_conformance {
    ($($name:ident: $shape:expr;)+) => {
        conformance! { $($name: $shape => onto_cube Cube, onto_ball Ball;)+ }
    };
}

disk_conformance! {
    disk_of_one_triangle: disks::triangle();
    disk_of_two_triangles: disks::two_triangles();
    fan_of_three: disks::fan(3);
    fan_of_seven: disks::fan(7);
    fan_of_fifty: disks::fan(50);
    fan_at_the_boundary: disks::half_fan(9);
    strip: disks::strip(17);
    polygon_cut_along_chords: disks::chords(12, 5);
    large_polygon_cut_along_chords: disks::chords(60, 6);
    fan_with_ears: disks::with_ears(disks::fan(6), 0.4);
    ears_on_ears: disks::with_ears(disks::with_ears(disks::chords(7, 1), 0.3), 0.2);
    grid: disks::grid(6, 5);
    narrow_grid: disks::grid(20, 1);
    corner_of_squares: disks::l_shape(9);
    comb_with_dead_ends: disks::comb(5);
    wound_up_band: disks::spiral(40);
    bumpy_surface_in_space: disks::bumpy(8);
    folded_surface_in_space: disks::folded(6);
    small_random_disk: disks::random_splits(12, 3);
    random_disk: disks::random_splits(150, 4);
    shuffled_disk: disks::random_splits(60, 8).shuffled(9);
    barycentric_triangle: disks::triangle().barycentric();
    barycentric_polygon: disks::chords(9, 2).barycentric().barycentric();
    flat_slivers: disks::grid(5, 5).moved(|[x, y, z]| [x, 1e-9 * y, z]);
    extreme_slivers: disks::grid(5, 5).moved(|[x, y, z]| [x, 1e-25 * y, z]);
    nearly_degenerate_fan: disks::fan(8).moved(|[x, y, z]| if x == 0.0 && y == 0.0 { [1.0 - 1e-12, 0.0, z] } else { [x, y, z] });
    tiny_disk: disks::random_splits(30, 7).scaled(1e-30);
    huge_disk: disks::random_splits(30, 7).scaled(1e30);
    disk_far_from_the_origin: disks::random_splits(30, 7).offset(1e8);
}

ball_conformance! {
    ball_of_one_tetrahedron: balls::tetrahedron();
    ball_of_two_tetrahedra: balls::two_tetrahedra();
    cube_of_five: balls::cube_of_five();
    cube_of_six: balls::kuhn(1, 1, 1);
    cube_of_48: balls::kuhn(2, 2, 2);
    cube_of_162: balls::kuhn(3, 3, 3);
    jittered_cube: balls::jittered(4, 11);
    shuffled_cube: balls::jittered(3, 12).shuffled(13);
    octahedron_with_axis: balls::octahedron_with_axis();
    octahedron_with_centre: balls::octahedron(0.0);
    octahedron_with_centre_near_a_tip: balls::octahedron(1.0 - 1e-12);
    cone_over_a_sphere: balls::cone(2);
    long_bar: balls::bar(24);
    l_shaped_bar: balls::l_shape(5);
    horseshoe: balls::horseshoe(5);
    dumbbell: balls::dumbbell(3);
    tetrahedron_with_ears: balls::with_ears(balls::tetrahedron(), 0.3);
    cube_with_ears_on_ears: balls::with_ears(balls::with_ears(balls::cube_of_five(), 0.2), 0.02);
    prism_cut_along_chords: balls::chord_prism(9, 5);
    prism_over_a_fan: balls::prism(&disks::fan(8));
    split_tetrahedron: balls::random_splits(40, 2);
    shuffled_split_tetrahedron: balls::random_splits(15, 3).shuffled(4);
    barycentric_tetrahedron: balls::tetrahedron().barycentric();
    barycentric_cube: balls::cube_of_five().barycentric();
    flat_tetrahedra: balls::jittered(3, 14).moved(|[x, y, z]| [x, y, 1e-9 * z]);
    extremely_flat_tetrahedra: balls::kuhn(3, 3, 3).moved(|[x, y, z]| [x, 1e-12 * y, 1e-25 * z]);
    tiny_ball: balls::jittered(3, 15).scaled(1e-30);
    huge_ball: balls::jittered(3, 15).scaled(1e30);
    ball_far_from_the_origin: balls::jittered(3, 15).offset(1e8);
    rudin: hard::rudin();
    ziegler: hard::ziegler();
    lutz: hard::lutz();
}
