//! Shells of generated surfaces that cross themselves: certified, and one-to-one in the abstract surface, exactly.

mod support;

use std::collections::BTreeMap;
use std::io::Cursor;

use homeo::certificate::{Provenance, StoredMap, read_map, write_shell};
use homeo::construct::shell::{ShellError, ShellParams, build};
use homeo::input::SourceMesh;
use homeo::map::{Shell, ShellEvaluationError, ShellPoint};
use homeo::overlay::shares;
use homeo::progress::Silent;
use homeo_core::number::{Lazy, Rational, Scalar};
use homeo_core::topology::self_intersections;
use homeo_verify::{Claim, Verdict, verify_bytes};
use support::{Point, half_torus, surface, torus, turned_box, twisted_cubes};

/// A tube round a closed curve in the plane, which it crosses where the curve does. `turns` is how often the curve winds.
fn tube(n: u32, m: u32, turns: f64, radius: f64, curve: impl Fn(f64) -> [f64; 2]) -> SourceMesh<3> {
    let angle = |i: u32, n: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    let point = |k: u32| {
        let (s, t) = (turns * angle(k / m, n), angle(k % m, m));
        let ([x, y], [before, after]) = (curve(s), [s - 1e-4, s + 1e-4].map(&curve));
        let along = [after[0] - before[0], after[1] - before[1]];
        let length = along[0].hypot(along[1]);
        let out = radius * t.cos() / length;
        [x + out * along[1], y - out * along[0], radius * t.sin()]
    };
    let at = |i: u32, j: u32| i % n * m + j % m;
    let cells = (0..n * m)
        .map(|k| (k / m, k % m))
        .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]);
    surface((0..n * m).map(point).collect(), &cells.collect::<Vec<_>>())
}

/// A tube round a lying eight: two sheets cross in the middle.
fn figure_eight() -> SourceMesh<3> {
    tube(61, 9, 1.0, 0.3, |s| [2.0 * s.sin(), (2.0 * s).sin()])
}

/// A tube that winds twice round the third axis and crosses itself all the way.
fn winding_twice() -> SourceMesh<3> {
    let radius = |s: f64| 1.0 + 0.0625 * (s / 2.0 + 0.1).cos();
    tube(64, 9, 2.0, 0.3, |s| [radius(s) * s.cos(), radius(s) * s.sin()])
}

/// Two surfaces in one mesh, the second moved.
fn joined(a: &SourceMesh<3>, b: &SourceMesh<3>, offset: Point) -> SourceMesh<3> {
    let moved = b.positions().iter().map(|p| [0, 1, 2].map(|axis| p[axis] + offset[axis]));
    let positions: Vec<Point> = a.positions().iter().copied().chain(moved).collect();
    let first = a.positions().len() as u32;
    let of = |mesh: &SourceMesh<3>, first: u32| -> Vec<[u32; 3]> {
        mesh.complex().cells().iter().map(|cell| cell.map(|v| v.raw() + first)).collect()
    };
    surface(positions, &[of(a, 0), of(b, first)].concat())
}

/// A torus with one vertex pulled through the other side of the tube.
fn pulled() -> SourceMesh<3> {
    let whole = torus(24, 12, 0.0);
    let mut positions = whole.positions().to_vec();
    positions[0][0] -= 0.9;
    surface(positions, &whole.complex().cells().iter().map(|cell| cell.map(|v| v.raw())).collect::<Vec<_>>())
}

/// All of them cross themselves.
fn surfaces() -> Vec<(&'static str, SourceMesh<3>)> {
    vec![
        ("figure eight", figure_eight()),
        ("winding twice", winding_twice()),
        ("pulled vertex", pulled()),
        ("two boxes", joined(&turned_box(4), &turned_box(3), [0.3, 0.2, 0.1])),
        ("two with a pinched vertex", joined(&twisted_cubes(), &twisted_cubes(), [0.3, 0.2, 0.1])),
        ("open and closed", joined(&half_torus(), &torus(20, 11, 3.0), [0.4, 0.1, 0.2])),
    ]
}

fn params(rounds: usize) -> ShellParams {
    ShellParams { rounds, immersed: true, ..ShellParams::default() }
}

fn built(source: &SourceMesh<3>, rounds: usize) -> Shell {
    build(source, &params(rounds), &Silent).expect("a shell").0
}

fn bytes_of(shell: &Shell) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    write_shell(shell, &Provenance::default(), &mut bytes).expect("memory");
    bytes.into_inner()
}

fn certified(name: &str, shell: &Shell) -> Claim {
    match verify_bytes(&bytes_of(shell)) {
        Ok(Verdict::Certified(claim)) => claim,
        other => panic!("{name}: {other:?}"),
    }
}

#[test]
fn surfaces_that_cross_themselves_get_certified_shells() {
    for (name, source) in surfaces() {
        assert!(!self_intersections(source.positions(), source.complex()).pairs.is_empty(), "{name}");
        for rounds in [0, 10] {
            let shell = built(&source, rounds);
            assert_eq!(certified(name, &shell).target, "immersed-shell", "{name}");
            let (prisms, triangles) = (shell.parts().prisms.len(), source.complex().cell_count());
            assert!(if rounds == 0 { prisms >= triangles } else { prisms < triangles }, "{name}: {prisms}");
        }
    }
}

#[test]
fn without_the_option_there_is_no_shell() {
    for (name, source) in surfaces() {
        let refused = build(&source, &ShellParams { rounds: 0, ..ShellParams::default() }, &Silent);
        assert!(matches!(refused, Err(ShellError::Stuck { .. })), "{name}");
    }
}

/// What does not cross itself gets the same shell, but with its pairs.
#[test]
fn embedded_surfaces_keep_their_shells() {
    for source in [torus(16, 9, 3.0), turned_box(4), half_torus()] {
        let shell = built(&source, 0);
        let plain = build(&source, &ShellParams { rounds: 0, ..ShellParams::default() }, &Silent).expect("a shell").0;
        let pairs = shell.parts().pairs.clone().expect("pairs");
        assert!((0..source.complex().cell_count() as u32).all(|c| pairs.contains(&[c, c])));
        let mut parts = shell.parts().clone();
        parts.pairs = None;
        assert_eq!((&parts, certified("embedded", &shell).target), (plain.parts(), "immersed-shell".to_owned()));
        assert_eq!(certified("embedded", &plain).target, "shell");
    }
}

/// A point with the given weights.
fn weights(parts: [i64; 3]) -> [Rational; 3] {
    let sum: i64 = parts.iter().sum();
    parts.map(|part| &Rational::from(part) / &Rational::from(sum))
}

/// From the abstract source to the middle and back, and the other way round.
#[test]
fn every_point_goes_there_and_back() {
    for (name, source) in surfaces() {
        let shell = built(&source, 10);
        let mut ambiguous = 0;
        for triangle in (0..source.complex().cell_count() as u32).step_by(3) {
            for parts in [[1, 1, 1], [7, 2, 1]].map(weights) {
                let at = shell.lift_exact(triangle, &parts).expect("a point of the source");
                let back = shell.to_source_exact(&ShellPoint { height: Rational::ZERO, ..at }).expect("a point");
                assert_eq!((back.triangle, &back.weights), (triangle, &parts), "{name}");
                match shell.project_exact(&back.point) {
                    Ok(at) => {
                        let again = shell.to_source_exact(&at).expect("a point");
                        assert_eq!((again.triangle, again.point), (triangle, back.point), "{name}");
                    }
                    Err(ShellEvaluationError::Ambiguous(..)) => ambiguous += 1,
                    Err(error) => panic!("{name}: {error}"),
                }
            }
        }
        assert!(ambiguous > 0, "{name}: where sheets cross, points of space do not tell");
        for prism in 0..shell.parts().prisms.len() as u32 {
            let at = ShellPoint { prism, weights: weights([5, 3, 2]), height: Rational::ZERO };
            let there = shell.to_source_exact(&at).expect("a point of the source");
            let lifted = shell.lift_exact(there.triangle, &there.weights).expect("a point of the shell");
            assert_eq!((lifted.prism, lifted.weights), (prism, at.weights), "{name}");
        }
    }
}

#[test]
fn lifts_of_what_is_no_point_are_errors() {
    let shell = built(&figure_eight(), 0);
    let count = shell.source().complex().cell_count() as u32;
    assert_eq!(shell.lift_exact(count, &weights([1, 1, 1])), Err(ShellEvaluationError::NoSuchPoint));
    assert_eq!(shell.lift_exact(0, &weights([2, -1, 1])), Err(ShellEvaluationError::NoSuchPoint));
    assert_eq!(shell.lift_exact(0, &[(); 3].map(|()| Rational::ONE)), Err(ShellEvaluationError::NoSuchPoint));
}

/// The parts of each triangle in the prisms that belong to it are all of it, exactly.
#[test]
fn cells_of_the_overlay_tile_both_surfaces() {
    for (name, source) in surfaces() {
        let shell = built(&source, 5);
        let (mut of_source, mut of_middle) = (BTreeMap::new(), BTreeMap::new());
        for share in shares(&shell, &Silent).expect("nobody stops it") {
            for (sums, key, part) in
                [(&mut of_source, share.source, &share.of_source), (&mut of_middle, share.section, &share.of_section)]
            {
                let sum = sums.entry(key).or_insert_with(|| Lazy::from_f64(0.0));
                *sum = sum.plus(part);
            }
        }
        let counts = [source.complex().cell_count(), shell.parts().prisms.len()];
        assert_eq!([of_source.len(), of_middle.len()], counts, "{name}");
        for sum in of_source.values().chain(of_middle.values()) {
            assert_eq!(*sum.exact(), Rational::ONE, "{name}");
        }
    }
}

#[test]
fn files_keep_the_pairs() {
    let shell = built(&figure_eight(), 5);
    let bytes = bytes_of(&shell);
    let Ok(StoredMap::Shell(read)) = read_map(&bytes) else { panic!("a shell") };
    assert_eq!((read.parts(), bytes_of(&read)), (shell.parts(), bytes));
    let with_section = read.with_section(figure_eight());
    let refused = write_shell(&with_section, &Provenance::default(), &mut Cursor::new(Vec::new()));
    assert!(refused.is_err_and(|error| error.to_string().contains("section")));
}

/// Where the surface is folded onto a point it is no immersion: the tube is wider than the circle that it goes round.
#[test]
fn surfaces_that_are_no_immersions_are_refused() {
    let spindle = tube(24, 15, 1.0, 1.25, |s| [s.cos(), s.sin()]);
    assert!(matches!(build(&spindle, &params(0), &Silent), Err(ShellError::Stuck { .. })));
    let folded = surface(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2], [0, 2, 1]]);
    assert!(matches!(build(&folded, &params(0), &Silent), Err(ShellError::Stuck { .. })));
}
