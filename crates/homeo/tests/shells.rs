//! Shells of generated surfaces: every law of the projection, exactly.

mod support;

use homeo::construct::shell::{ShellError, ShellParams, build};
use homeo::input::SourceMesh;
use homeo::map::{Shell, ShellEvaluationError, ShellPoint};
use homeo::progress::Silent;
use homeo_core::number::Rational;
use support::{Point, half_torus, surface, torus, turned_box, twisted_cubes};

fn exact(point: Point) -> [Rational; 3] {
    point.map(|x| Rational::from_f64(x).expect("finite"))
}

fn built(source: &SourceMesh<3>, rounds: usize) -> Shell {
    build(source, &ShellParams { rounds, ..ShellParams::default() }, &Silent).expect("a shell").0
}

/// A point of a source triangle with the given weights.
fn inside(source: &SourceMesh<3>, triangle: usize, weights: [i64; 3]) -> [Rational; 3] {
    let corners = source.complex().cells()[triangle].map(|v| exact(source.positions()[v.index()]));
    let sum = Rational::from(weights.iter().sum::<i64>());
    std::array::from_fn(|axis| {
        let terms = (0..3).map(|k| &Rational::from(weights[k]) * &corners[k][axis]);
        &terms.sum::<Rational>() / &sum
    })
}

/// From the source to the middle and back, and from the middle to the source and back, without any difference.
fn check_round_trips(shell: &Shell, step: usize) {
    let source = shell.source();
    for triangle in (0..source.complex().cell_count()).step_by(step) {
        for weights in [[1, 0, 0], [1, 1, 0], [1, 1, 1], [7, 2, 1]] {
            let point = inside(source, triangle, weights);
            let middle = shell.to_middle_exact(&point).expect("on the source");
            assert_eq!(middle.height, Rational::ZERO);
            assert_eq!(shell.to_source_exact(&middle).expect("a point").point, point);
        }
    }
    for prism in (0..shell.parts().prisms.len() as u32).step_by(step) {
        let weight = |k: i64| &Rational::from(k) / &Rational::from(10);
        let at = ShellPoint { prism, weights: [weight(5), weight(3), weight(2)], height: Rational::ZERO };
        let there = shell.to_source_exact(&at).expect("a point of the source");
        assert_eq!(shell.to_middle_exact(&there.point).expect("in the shell"), at);
    }
}

/// `project` and `unproject` are inverse to one another at all heights.
fn check_heights(shell: &Shell, step: usize) {
    let part = |a: i64, b: i64| &Rational::from(a) / &Rational::from(b);
    for prism in (0..shell.parts().prisms.len() as u32).step_by(step) {
        for height in [part(-1, 1), part(-2, 3), part(-1, 5), part(0, 1), part(1, 7), part(5, 6), part(1, 1)] {
            let at = ShellPoint { prism, weights: [part(1, 2), part(1, 3), part(1, 6)], height };
            let point = shell.unproject_exact(&at).expect("in the shell");
            match shell.project_exact(&point) {
                Ok(found) => assert_eq!(found, at),
                Err(ShellEvaluationError::Ambiguous(..)) => {}
                Err(error) => panic!("{error} at {at:?}"),
            }
        }
    }
}

#[test]
fn the_first_shell_of_every_surface_is_bijective() {
    for source in [torus(16, 9, 3.0), turned_box(4), twisted_cubes(), half_torus()] {
        let shell = built(&source, 0);
        assert_eq!(shell.parts().prisms.len(), source.complex().cell_count());
        check_round_trips(&shell, 3);
        check_heights(&shell, 5);
    }
}

#[test]
fn simplified_shells_are_bijective() {
    for (source, most) in [(torus(32, 16, 5.0), 400), (turned_box(6), 300), (twisted_cubes(), 36), (half_torus(), 150)]
    {
        let shell = built(&source, 10);
        assert!(shell.parts().prisms.len() <= most, "{} prisms", shell.parts().prisms.len());
        check_round_trips(&shell, 7);
        check_heights(&shell, 3);
    }
}

#[test]
fn a_singular_vertex_is_pinched_and_maps_to_itself() {
    let source = twisted_cubes();
    let (shell, info) = build(&source, &ShellParams::default(), &Silent).expect("a shell");
    assert_eq!(info.pinched, 1);
    let apex = exact([0.0; 3]);
    let middle = shell.to_middle_exact(&apex).expect("in the shell");
    assert_eq!(shell.unproject_exact(&middle).expect("a point"), apex);
    assert_eq!(shell.to_source_exact(&middle).expect("a point").point, apex);
}

#[test]
fn rounded_images_lie_within_their_radius() {
    let shell = built(&torus(16, 9, 3.0), 10);
    for &point in shell.source().positions().iter().step_by(7) {
        let middle = shell.to_middle(point).expect("in the shell");
        let at = shell.to_middle_exact(&exact(point)).expect("in the shell");
        let truth = shell.unproject_exact(&at).expect("a point");
        for axis in 0..3 {
            let off = (middle.point[axis] - truth[axis].to_f64()).abs();
            assert!(off <= middle.radius);
        }
    }
}

#[test]
fn a_wanted_number_of_prisms_ends_the_simplification() {
    let source = torus(24, 12, 3.0);
    let (shell, info) =
        build(&source, &ShellParams { prisms: 300, ..ShellParams::default() }, &Silent).expect("a shell");
    assert!(shell.parts().prisms.len() >= 299 && info.prisms == shell.parts().prisms.len());
}

#[test]
fn what_has_no_shell_is_refused() {
    let nearly_closed = [[0, 1, 2], [0, 2, 1]];
    let folded = surface(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &nearly_closed);
    assert!(matches!(build(&folded, &ShellParams::default(), &Silent), Err(ShellError::Stuck { .. })));
    let thin = ShellParams { thickness: 0.0, ..ShellParams::default() };
    assert_eq!(build(&torus(8, 6, 0.0), &thin, &Silent).err(), Some(ShellError::Thickness));
}

#[test]
fn points_outside_and_impossible_places_are_errors() {
    let shell = built(&torus(12, 8, 0.0), 0);
    assert_eq!(shell.project_exact(&exact([9.0, 9.0, 9.0])), Err(ShellEvaluationError::Outside));
    assert!(!shell.is_inside([9.0, 9.0, 9.0]) && shell.is_inside(shell.source().positions()[5]));
    assert_eq!(shell.to_middle([f64::NAN, 0.0, 0.0]), Err(ShellEvaluationError::NotFinite));
    let [zero, one] = [Rational::ZERO, Rational::ONE];
    let at = |prism: u32, weights: [Rational; 3], height: Rational| ShellPoint { prism, weights, height };
    let corner = [one.clone(), zero.clone(), zero.clone()];
    let many = shell.parts().prisms.len() as u32;
    for wrong in [
        at(many, corner.clone(), zero.clone()),
        at(0, [one.clone(), one.clone(), zero.clone()], zero.clone()),
        at(0, corner.clone(), &one + &one),
        at(0, [&zero - &one, &one + &one, zero.clone()], zero.clone()),
    ] {
        assert_eq!(shell.unproject_exact(&wrong), Err(ShellEvaluationError::NoSuchPoint));
        assert!(shell.to_source_exact(&wrong).is_err());
    }
}

/// A strip rolled up in more than two turns: its sheets lie close over one another, with one orientation.
fn roll(turns: f64, n: u32) -> SourceMesh<3> {
    let point = |i: u32| {
        let angle = f64::from(i / 3) / f64::from(n) * turns * std::f64::consts::TAU;
        let radius = 1.0 + 0.05 * angle / std::f64::consts::TAU;
        [radius * angle.cos(), radius * angle.sin(), 0.4 * f64::from(i % 3)]
    };
    let squares = (0..n).flat_map(|i| (0..2).map(move |j| 3 * i + j));
    let triangles: Vec<[u32; 3]> = squares.flat_map(|v| [[v, v + 3, v + 4], [v, v + 4, v + 1]]).collect();
    surface((0..3 * (n + 1)).map(point).collect(), &triangles)
}

/// A sphere of `n` by `m` quadrilaterals round an axis.
fn sphere(n: u32, m: u32, radius: f64) -> SourceMesh<3> {
    let point = |i: u32, j: u32| {
        let [s, t] = [[i, n], [2 * j, m]].map(|[k, of]| std::f64::consts::PI * f64::from(k) / f64::from(of));
        [s.sin() * t.cos(), s.sin() * t.sin(), s.cos()].map(|x| radius * x)
    };
    let mut points: Vec<Point> = (1..n).flat_map(|i| (0..m).map(move |j| point(i, j))).collect();
    points.extend([[0.0, 0.0, radius], [0.0, 0.0, -radius]]);
    let at = |i: u32, j: u32| (i - 1) * m + j % m;
    let poles = (n - 1) * m;
    let caps = (0..m).flat_map(|j| [[poles, at(1, j), at(1, j + 1)], [poles + 1, at(n - 1, j + 1), at(n - 1, j)]]);
    let squares = (1..n - 1).flat_map(|i| (0..m).map(move |j| (i, j)));
    let sides = squares
        .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]);
    surface(points, &caps.chain(sides).collect::<Vec<_>>())
}

/// Several surfaces as one.
fn together(parts: &[SourceMesh<3>]) -> SourceMesh<3> {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for part in parts {
        let shift = points.len() as u32;
        triangles.extend(part.complex().cells().iter().map(|cell| cell.map(|v| v.raw() + shift)));
        points.extend_from_slice(part.positions());
    }
    surface(points, &triangles)
}

#[test]
fn sheets_of_one_orientation_are_told_apart() {
    let nested = [1.0, 0.97, 0.94].map(|radius| sphere(10, 14, radius));
    for source in [together(&nested), roll(2.6, 40)] {
        for thickness in [0.1, 0.5] {
            let params = ShellParams { thickness, rounds: 4, ..ShellParams::default() };
            let shell = build(&source, &params, &Silent).expect("a shell").0;
            check_round_trips(&shell, 17);
        }
    }
}
