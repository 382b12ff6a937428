//! Meshes in space that move: the laws of all maps, surfaces and volumes, and motions that fold.

use std::io::Cursor;

use homeo::cage::{Moved, Verdict as Judgement, judge};
use homeo::certificate::{MovedMap, Provenance, StoredMap, read_map, write_moved};
use homeo::input::SourceMesh;
use homeo::map::{Bijection, EvaluationError, MovedMesh, MovedMeshError};
use homeo_core::mesh::SimplicialComplex;
use homeo_verify::{SourceMatch, Verdict, compare_source, verify_bytes};

use crate::laws;
use crate::points::{Places, Point, exact, rounded};
use crate::shapes::{Shape, balls, disks, hard};

const POINTS: usize = 60;

type Motion = fn([f64; 3]) -> [f64; 3];

fn stays(p: [f64; 3]) -> [f64; 3] {
    p
}

/// Affine, but for rounding.
fn sheared([x, y, z]: [f64; 3]) -> [f64; 3] {
    [2.0 * x + 0.1 * y, y - 0.3 * z, x + 0.7 * z]
}

/// A twist that also bends.
fn twisted([x, y, z]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = (0.1 * z + 0.05 * x).sin_cos();
    [cos * x - sin * y + 0.01 * z * z, sin * x + cos * y, 1.3 * z]
}

fn map_of<const K: usize>(shape: &Shape<K>, motion: Motion) -> MovedMesh<K> {
    let source = shape.mesh();
    let after = source.positions().iter().map(|&p| motion(p)).collect();
    MovedMesh::new(source, after).expect("a map")
}

fn bytes_of(map: &MovedMap) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    write_moved(map, &Provenance::default(), &mut bytes).expect("memory can be written");
    bytes.into_inner()
}

/// Map files of a surface and of a volume.
pub fn small_files() -> (Vec<u8>, Vec<u8>) {
    let surface = map_of(&disks::fan(5), twisted);
    (bytes_of(&surface.into()), bytes_of(&map_of(&balls::two_tetrahedra(), twisted).into()))
}

fn check<const K: usize>(shape: &Shape<K>, motion: Motion)
where
    MovedMap: From<MovedMesh<K>>,
{
    let map = map_of(shape, motion);
    let (source, image) = (map.source().clone(), map.moved().clone());
    let (before, after) = (Places::new(&source), Places::new(&image));
    let from = before.sample_cells(POINTS, 1);
    let to: Vec<Point> = after.sample_cells(POINTS, 2).into_iter().map(|point| point.at).collect();
    let law = |what: &str, law: laws::Law| law.unwrap_or_else(|broken| panic!("{what}: {broken}"));
    law("there and back", laws::source_points_come_back(&map, &after, &from));
    law("back and there", laws::target_points_come_back(&map, &after, &to, &|p| before.is_on_boundary(p)));
    let compared =
        laws::floating_images_enclose(&map, &after, &from).unwrap_or_else(|broken| panic!("images: {broken}"));
    assert!(compared > 0, "no double lies in the mesh");
    law("preimages", laws::floating_preimages_enclose(&map, &after, &to));
    law("outside", laws::outside_is_refused(&map, &after, before.far_points()[0]));

    let doubles: Vec<[f64; 3]> = from.iter().map(|p| rounded(&p.at)).collect();
    let batches = [1, 2].map(|threads| crate::in_threads(threads, || map.forward_batch(&doubles)));
    assert!(batches[0] == batches[1], "a batch depends on the threads");
    assert!(batches[0].iter().flatten().all(|answer| answer.radius <= 1e-7 * size(&image)), "a bound says little");

    let map = MovedMap::from(map);
    let bytes = bytes_of(&map);
    let Ok(StoredMap::Moved(read)) = read_map(&bytes) else { panic!("what was written can be read") };
    assert!(bytes == bytes_of(&read), "the file differs when read and written");
    let both = [map.as_bijection(), read.as_bijection()];
    law("after reading", laws::answers_are_the_same(both, &after, &from, &to));
    match verify_bytes(&bytes) {
        Ok(Verdict::Certified(claim)) => assert_eq!(claim.kind, "moved-mesh"),
        other => panic!("not certified: {other:?}"),
    }
    let cells: Vec<u32> = source.complex().cells().iter().flatten().map(|v| v.raw()).collect();
    assert_eq!(compare_source(&bytes, source.positions(), &cells, K), Ok(SourceMatch::Same));
}

fn size<const K: usize>(mesh: &SourceMesh<K>) -> f64 {
    mesh.positions().iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()))
}

macro_rules! moves {
    ($($name:ident: $shape:expr => $motion:expr;)+) => {$(
        #[test]
        fn $name() {
            check(&$shape, $motion);
        }
    )+};
}

moves! {
    one_triangle: disks::triangle() => twisted;
    grid: disks::grid(6, 5) => twisted;
    bumpy_surface: disks::bumpy(8) => twisted;
    spiral: disks::spiral(40) => sheared;
    random_disk: disks::random_splits(60, 4) => sheared;
    disk_of_slivers: disks::grid(5, 5).moved(|[x, y, z]| [x, 1e-9 * y, z]) => |[x, y, z]| [y, 1e9 * z, 3.0 * x];
    one_tetrahedron: balls::tetrahedron() => twisted;
    cube: balls::cube_of_five() => twisted;
    box_of_cubes: balls::kuhn(2, 2, 2) => twisted;
    jittered_box: balls::jittered(3, 12).shuffled(13) => twisted;
    horseshoe: balls::horseshoe(5) => twisted;
    dumbbell: balls::dumbbell(3) => twisted;
    split_tetrahedron: balls::random_splits(15, 3) => sheared;
    flat_tetrahedra: balls::jittered(3, 14).moved(|[x, y, z]| [x, y, 1e-9 * z]) => |[x, y, z]| [y, 2e9 * z, x];
    tiny_box: balls::jittered(2, 15).scaled(1e-30) => sheared;
    huge_box: balls::jittered(2, 15).scaled(1e30) => sheared;
    box_far_from_the_origin: balls::jittered(2, 15).offset(1e8) => |p| p.map(|x| x - 1e8);
    rudin: hard::rudin() => stays;
    lutz: hard::lutz() => sheared;
}

/// Cells of a mesh need not be positive, if they keep their sign.
#[test]
fn cells_of_either_sign_move() {
    let ball = balls::jittered(2, 5);
    let source = ball.mesh();
    let cells: Vec<[u32; 4]> = source.complex().cells().iter().map(|cell| cell.map(|v| v.raw())).collect();
    let turned: Vec<[u32; 4]> = cells
        .iter()
        .enumerate()
        .map(|(k, &[a, b, c, d])| if k % 2 == 0 { [a, b, c, d] } else { [b, a, c, d] })
        .collect();
    let complex = SimplicialComplex::from_indices(source.positions().len(), &turned).expect("indices");
    let source = SourceMesh::new(source.positions().to_vec(), complex);
    let after = source.positions().iter().map(|&p| twisted(p)).collect();
    let map = MovedMesh::new(source, after).expect("a map");
    let point = exact([0.3, 0.4, 0.5]);
    assert_eq!(map.inverse_exact(&map.forward_exact(&point).expect("inside")), Ok(point));
    assert!(matches!(verify_bytes(&bytes_of(&map.into())), Ok(Verdict::Certified(_))));
}

/// A motion that folds: the judge, the checker and the laws notice.
#[test]
fn motions_that_fold_are_noticed() {
    let ball = balls::kuhn(2, 2, 2);
    let folded: Motion = |[x, y, z]| [if x > 1.0 { 2.25 - x } else { x }, y, z];
    let map = map_of(&ball, folded);
    let (source, image) = (map.source().clone(), map.moved().clone());
    let verdict = judge(Moved::Volume(source.complex()), source.positions(), image.positions());
    assert!(matches!(verdict, Judgement::Folded { .. }), "{verdict:?}");
    let (before, after) = (Places::new(&source), Places::new(&image));
    let from = before.sample_cells(POINTS, 1);
    assert!(laws::source_points_come_back(&map, &after, &from).is_err(), "the laws take a fold");
    let ambiguous = map.inverse_exact(&exact([0.8, 0.3, 0.6]));
    assert!(matches!(ambiguous, Err(EvaluationError::Ambiguous(..))), "{ambiguous:?}");
    match verify_bytes(&bytes_of(&map.into())) {
        Ok(Verdict::Refuted(witness)) => assert_eq!(witness.rule, "M3"),
        other => panic!("not refuted: {other:?}"),
    }
}

/// What `judge` finds sound, the checker certifies; it refutes the rest. Random motions, by little and by much.
#[test]
fn judge_and_checker_agree() {
    let mut counts = [[0; 2]; 2];
    for seed in 0..60 {
        let size = [0.3, 0.8, 1.4][seed as usize % 3];
        let ball = balls::jittered(2, seed).mesh();
        let after = shaken(&ball, size, seed);
        let verdict = judge(Moved::Volume(ball.complex()), ball.positions(), &after);
        let certified = is_certified(MovedMesh::new(ball, after).expect("a map").into());
        assert_eq!(certified, verdict == Judgement::Embedded, "{verdict:?}");
        counts[0][usize::from(certified)] += 1;
        let disk = disks::grid(4, 3).mesh();
        let after = shaken(&disk, 2.0 * size, seed);
        let verdict = judge(Moved::Surface(disk.complex()), disk.positions(), &after);
        let certified = is_certified(MovedMesh::new(disk, after).expect("a map").into());
        assert_eq!(certified, verdict == Judgement::Embedded, "{verdict:?}");
        counts[1][usize::from(certified)] += 1;
    }
    assert!(counts.as_flattened().iter().all(|&count| count >= 10), "{counts:?}");
}

/// The vertices of a mesh, each moved at random by up to half of `size` along every axis.
fn shaken<const K: usize>(mesh: &SourceMesh<K>, size: f64, seed: u64) -> Vec<[f64; 3]> {
    let mut random = crate::random::Random::new(seed);
    let mut shift = || size * (random.below(1 << 20) as f64 / f64::from(1 << 20) - 0.5);
    mesh.positions().iter().map(|p| p.map(|x| x + shift())).collect()
}

fn is_certified(map: MovedMap) -> bool {
    matches!(verify_bytes(&bytes_of(&map)), Ok(Verdict::Certified(_)))
}

#[test]
fn what_cannot_be_evaluated_is_refused() {
    let source = || balls::tetrahedron().mesh();
    let places = |change: fn(&mut Vec<[f64; 3]>)| {
        let mut after = source().positions().to_vec();
        change(&mut after);
        MovedMesh::new(source(), after).map(|_| ()).expect_err("no map")
    };
    assert_eq!(places(|p| p.truncate(3)), MovedMeshError::WrongLength { expected: 4, found: 3 });
    assert_eq!(places(|p| p[2][0] = f64::NAN), MovedMeshError::OutOfRange(2));
    assert_eq!(places(|p| p[1][0] = 1e-200), MovedMeshError::OutOfRange(1));
    assert_eq!(places(|p| p[3] = [0.25, 0.5, 0.0]), MovedMeshError::Flat(0));
    let nothing = SourceMesh::new(vec![], SimplicialComplex::<4>::from_indices(0, &[]).expect("no cells"));
    let map = MovedMesh::new(nothing, vec![]).expect("an empty map");
    assert_eq!(map.forward([0.0; 3]), Err(EvaluationError::OutsideSource));
    assert_eq!(map.inverse_exact(&exact([0.0; 3])), Err(EvaluationError::OutsideMoved));
}
