//! Laws of meshes that move with cages.

use homeo_core::mesh::{TetrahedronComplex, TriangleComplex};
use homeo_core::predicate::{Sign, orient3d};

use super::*;
use crate::progress::Silent;
use crate::shape::{PolyhedronPath, StraightPolyhedra, TurningPolyhedra};

type Point3 = [f64; 3];

/// A cube from -2 to 2, its faces cut into triangles.
fn cube() -> (Vec<Point3>, Vec<[u32; 3]>) {
    let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|bit| 4.0 * f64::from(bit) - 2.0);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    ((0..8).map(corner).collect(), quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

/// The cube from -1 to 1 in `n^3` boxes of six tetrahedra each (Kuhn 1960).
fn grid(n: u32) -> (Vec<Point3>, TetrahedronComplex) {
    let place = |k: u32| 2.0 * f64::from(k) / f64::from(n) - 1.0;
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    let number = |[i, j, k]: [u32; 3]| (i * (n + 1) + j) * (n + 1) + k;
    for i in 0..=n {
        for j in 0..=n {
            (0..=n).for_each(|k| points.push([place(i), place(j), place(k)]));
        }
    }
    let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    for corner in 0..n.pow(3) {
        let base = [corner / (n * n), corner / n % n, corner % n];
        for (which, order) in orders.iter().enumerate() {
            let mut at = base;
            let mut cell = [number(at); 4];
            for (slot, &axis) in order.iter().enumerate() {
                at[axis] += 1;
                cell[slot + 1] = number(at);
            }
            if which >= 3 {
                cell.swap(2, 3);
            }
            cells.push(cell);
        }
    }
    let complex = TetrahedronComplex::from_indices(points.len(), &cells).unwrap();
    (points, complex)
}

/// A bar of twelve storeys, each floor turned against the one below.
fn twisted(degrees: f64) -> CagePair {
    let ring = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let floor = |level: u32, turn: f64| {
        let (s, c) = (turn * f64::from(level)).to_radians().sin_cos();
        ring.map(|[x, y]: [f64; 2]| [c * x - s * y, s * x + c * y, f64::from(level) / 3.0 - 2.0])
    };
    let bar = |turn: f64| (0..13).flat_map(|level| floor(level, turn)).collect::<Vec<Point3>>();
    let mut triangles = vec![[0, 2, 1], [0, 3, 2], [48, 49, 50], [48, 50, 51]];
    for level in 0..12 {
        for i in 0..4 {
            let (a, b) = (4 * level + i, 4 * level + (i + 1) % 4);
            triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
        }
    }
    CagePair::new(bar(0.0), bar(degrees), triangles).unwrap()
}

fn straight(cages: &CagePair) -> StraightPolyhedra {
    StraightPolyhedra::new(cages.source().to_vec(), cages.target().to_vec()).unwrap()
}

#[test]
fn cages_that_stay_leave_points_to_the_last_bit() {
    let (source, triangles) = cube();
    let cages = CagePair::new(source.clone(), source, triangles).unwrap();
    let (points, mesh) = grid(3);
    let moved = deform(&cages, &straight(&cages), Moved::Volume(&mesh), &points, Steps::default(), &Silent).unwrap();
    assert_eq!((moved.positions, moved.steps, moved.verdict), (points, 1, Verdict::Embedded));
}

#[test]
fn affine_maps_are_reproduced() {
    let (source, triangles) = cube();
    let image = |p: &Point3| [1.5 * p[0] + 0.4 * p[1] - 3.0, p[1] - 0.3 * p[2], 0.2 * p[0] + 0.7 * p[2] + 5.0];
    let cages = CagePair::new(source.clone(), source.iter().map(image).collect(), triangles).unwrap();
    let (points, mesh) = grid(3);
    for first in [1, 5] {
        let steps = Steps { first, most: 64 };
        let moved = deform(&cages, &straight(&cages), Moved::Volume(&mesh), &points, steps, &Silent).unwrap();
        assert_eq!((&moved.verdict, moved.steps, moved.crossing_cage), (&Verdict::Embedded, first, None));
        for (place, point) in moved.positions.iter().zip(&points) {
            let truth = image(point);
            assert!((0..3).all(|k| (place[k] - truth[k]).abs() < 1e-13), "{place:?} {truth:?}");
        }
    }
}

/// A twist by most of a turn turns cells over in one step, and not in several.
#[test]
fn steps_are_made_until_no_cell_is_folded() {
    let cages = twisted(25.0);
    let path = TurningPolyhedra::new(cages.source().to_vec(), cages.target().to_vec(), cages.triangles()).unwrap();
    let (points, mesh) = grid(6);
    let points: Vec<Point3> = points.iter().map(|p| p.map(|x| 1.9 * x)).collect();
    let run = |most| deform(&cages, &path, Moved::Volume(&mesh), &points, Steps { first: 1, most }, &Silent).unwrap();
    let one = run(1);
    let Verdict::Folded { cells } = &one.verdict else { panic!("{:?}", one.verdict) };
    assert!(!cells.is_empty() && one.steps == 1);
    for &cell in cells {
        let [a, b, c, d] = mesh.cell(cell).map(|v| one.positions[v.index()]);
        assert_ne!(orient3d(a, b, c, d), Sign::Positive);
    }
    let many = run(64);
    assert_eq!(many.verdict, Verdict::Embedded);
    assert!(many.steps > 1, "{} steps", many.steps);
}

/// No point lies in two cells of a mesh that was found sound; in those that were not, some often do.
#[test]
fn sound_meshes_cover_no_point_twice() {
    let (points, mesh) = grid(2);
    let mut state = 88u64;
    let mut unit = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let (mut sound, mut folded, mut doubled) = (0, 0, 0);
    for round in 0..60 {
        let size = 0.04 * f64::from(round % 20);
        let after: Vec<Point3> = points.iter().map(|p| p.map(|x| x + size * (unit() - 0.5) * 2.0)).collect();
        let verdict = judge(Moved::Volume(&mesh), &points, &after);
        let covers = |q: Point3| mesh.cells().iter().filter(|cell| contains(cell.map(|v| after[v.index()]), q)).count();
        let most = (0..400).map(|_| covers([(); 3].map(|()| 3.0 * unit() - 1.5))).max().unwrap();
        match verdict {
            Verdict::Embedded => {
                sound += 1;
                assert!(most <= 1, "round {round}: a point in {most} cells");
            }
            Verdict::Folded { .. } => {
                folded += 1;
                doubled += usize::from(most > 1);
            }
            other => panic!("{other:?}"),
        }
    }
    assert!(sound >= 10 && folded >= 20 && doubled >= 10, "{sound} sound, {folded} folded, {doubled} doubled");
}

/// A hollow cage; many points are on it, on planes of its faces or on lines of its edges.
#[test]
fn points_are_inside_of_a_cage_or_not() {
    let triangles = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];
    let corners =
        vec![[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [-2.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, -2.0]];
    let cages = CagePair::new(corners.clone(), corners.clone(), triangles).unwrap();
    let is_in = |q: Point3| {
        // Between two pyramids, closed.
        let below = |apex: f64| apex + 0.5 * -apex * (q[0].abs() + q[1].abs());
        q[0].abs() + q[1].abs() <= 2.0 && below(-2.0) <= q[2] && q[2] <= below(-1.0)
    };
    let steps = || (-10..=10).map(|k| 0.25 * f64::from(k));
    let mut counts = [0; 2];
    for q in steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| [x, y, z]))) {
        assert_eq!(cages.contains(q), is_in(q), "{q:?}");
        counts[usize::from(is_in(q))] += 1;
    }
    assert!(counts[1] > 200, "{counts:?}");
}

/// Whether a point is inside, of tetrahedra of either sign.
fn contains([a, b, c, d]: [Point3; 4], q: Point3) -> bool {
    let signs = [orient3d(q, b, c, d), orient3d(a, q, c, d), orient3d(a, b, q, d), orient3d(a, b, c, q)];
    signs[0] != Sign::Zero && signs.iter().all(|&s| s == signs[0])
}

/// Two prongs of a fork that are bent into one another: every cell is positive, the boundary meets itself.
#[test]
fn positive_cells_do_not_suffice() {
    let (points, mesh) = fork();
    assert_eq!(judge(Moved::Volume(&mesh), &points, &points), Verdict::Embedded);
    let bent = |p: &Point3| if p[0].abs() > 0.5 && p[2] > 0.5 { [p[0] - 1.2 * p[0].signum(), p[1], p[2]] } else { *p };
    let after: Vec<Point3> = points.iter().map(bent).collect();
    let Verdict::Meets { pairs, count } = judge(Moved::Volume(&mesh), &points, &after) else { panic!() };
    assert!(count > 0 && !pairs.is_empty());
}

/// A bar with a tetrahedron standing at each end.
fn fork() -> (Vec<Point3>, TetrahedronComplex) {
    let points = vec![
        [-1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, -1.0],
        [-0.8, 0.2, 1.0],
        [0.8, 0.2, 1.1],
        [0.0, 0.2, 0.0],
    ];
    let mut cells = vec![[0, 6, 2, 4], [6, 1, 2, 5], [0, 6, 2, 3], [6, 1, 2, 3]];
    for cell in &mut cells {
        let [a, b, c, d] = cell.map(|v: u32| points[v as usize]);
        if orient3d(a, b, c, d) == Sign::Negative {
            cell.swap(2, 3);
        }
    }
    let mesh = TetrahedronComplex::from_indices(points.len(), &cells).unwrap();
    (points, mesh)
}

#[test]
fn surfaces_that_meet_themselves_are_found() {
    let (points, triangles) = cube();
    let mesh = TriangleComplex::from_indices(8, &triangles).unwrap();
    let judged = |change: &dyn Fn(&mut Vec<Point3>)| {
        let mut after = points.clone();
        change(&mut after);
        judge(Moved::Surface(&mesh), &points, &after)
    };
    assert_eq!(judged(&|_| {}), Verdict::Embedded);
    assert!(matches!(judged(&|p| p[7] = [-1.0, -1.0, -9.0]), Verdict::Meets { .. }));
    assert!(matches!(judged(&|p| p[1] = p[0]), Verdict::Folded { .. }));
    assert!(matches!(judged(&|p| p[7] = [1e300; 3]), Verdict::Undecided { .. }));
    assert_eq!(judge(Moved::Points, &points, &points), Verdict::NothingToJudge);
}

#[test]
fn cages_that_are_none_are_refused() {
    let (source, triangles) = cube();
    let refused = |target: Vec<Point3>| CagePair::new(source.clone(), target, triangles.clone()).unwrap_err();
    assert_eq!(refused(source[1..].to_vec()), CageError::VertexCounts { here: 8, there: 7 });
    let mut crossed = source.clone();
    crossed[7] = [-1.0, -1.0, -9.0];
    assert!(matches!(refused(crossed), CageError::NotEmbedded { side: CageSide::Target, .. }));
    let open = CagePair::new(source.clone(), source.clone(), triangles[1..].to_vec());
    assert!(matches!(open, Err(CageError::NotClosed { side: CageSide::Source, .. })));
    let mut other = triangles.clone();
    other[3].rotate_left(1);
    let both = CagePair::of_meshes([source.clone(), source.clone()], [triangles, other]);
    assert_eq!(both.unwrap_err(), CageError::OtherTriangles { triangle: 3 });
}

/// Inside a boundary that moves linearly all moves linearly; what is judged folded has a witness.
#[test]
fn harmonic_extensions_are_judged() {
    let (points, mesh) = grid(4);
    let linear: Vec<Point3> = points.iter().map(|p| [p[0] + 0.5 * p[1], p[1], 2.0 * p[2]]).collect();
    let places = harmonic_extension(&mesh, &points, &linear).unwrap();
    assert_eq!(judge(Moved::Volume(&mesh), &points, &places), Verdict::Embedded);
    // A dent deeper than half the body is more than this mesh can take.
    let dent = |p: &Point3| if p[2] == 1.0 && p[0].hypot(p[1]) < 0.1 { [p[0], p[1], -0.95] } else { *p };
    let dented: Vec<Point3> = points.iter().map(dent).collect();
    let places = harmonic_extension(&mesh, &points, &dented).unwrap();
    let Verdict::Folded { cells } = judge(Moved::Volume(&mesh), &points, &places) else { panic!() };
    let [a, b, c, d] = mesh.cell(cells[0]).map(|v| places[v.index()]);
    assert_ne!(orient3d(a, b, c, d), Sign::Positive);
    assert!(harmonic_extension(&mesh, &points, &points[1..]).is_err());
}

/// A path on which the cage meets itself.
struct Detour(Vec<Point3>);

impl PolyhedronPath for Detour {
    fn at(&self, _: f64) -> Result<Vec<Point3>, crate::shape::PolyhedronPathError> {
        Ok(self.0.clone())
    }
}

#[test]
fn crossing_cages_on_the_way_are_told() {
    let (source, triangles) = cube();
    let mut crossed = source.clone();
    crossed[7] = [-1.0, -1.0, -9.0];
    let cages = CagePair::new(source.clone(), source, triangles).unwrap();
    let run = |path: &dyn PolyhedronPath, first| {
        deform(&cages, path, Moved::Points, &[[0.1, 0.2, 0.3]], Steps { first, most: 64 }, &Silent).unwrap()
    };
    let told = run(&Detour(crossed), 4);
    assert_eq!((told.verdict, told.crossing_cage), (Verdict::NothingToJudge, Some(0.25)));
    assert_eq!(run(&straight(&cages), 4).crossing_cage, None);
}
