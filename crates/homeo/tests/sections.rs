//! Sections of shells of generated surfaces: whatever simplification and remeshing give is certified by the checker.

mod support;

use std::io::Cursor;

use homeo::certificate::{Provenance, write_shell};
use homeo::construct::section::{
    Fault, InShellError, RemeshParams, SectionError, SimplifyEnd, SimplifyParams, Texture, TexturedSurface, check,
    remesh, shells_in_turn, simplify, simplify_in_shells,
};
use homeo::construct::shell::{ShellError, ShellParams, build};
use homeo::input::SourceMesh;
use homeo::map::Shell;
use homeo::progress::{Progress, Silent};
use homeo_core::predicate::{Sign, orient2d};
use homeo_core::topology::self_intersections;
use homeo_verify::{Verdict, verify_bytes};
use support::{Point, half_torus, surface, torus, turned_box, twisted_cubes};

fn built(source: &SourceMesh<3>) -> Shell {
    build(source, &ShellParams { rounds: 10, ..ShellParams::default() }, &Silent).expect("a shell").0
}

fn indices(mesh: &SourceMesh<3>) -> Vec<[u32; 3]> {
    mesh.complex().cells().iter().map(|cell| cell.map(|v| v.raw())).collect()
}

/// The checker's proof that a surface is a section, and a second opinion on self-intersections.
fn assert_section(shell: &Shell, section: &SourceMesh<3>) {
    let mut bytes = Cursor::new(Vec::new());
    let whole = Shell::from_parts(section.clone(), shell.parts().clone());
    write_shell(&whole, &Provenance::default(), &mut bytes).expect("memory");
    match verify_bytes(bytes.get_ref()) {
        Ok(Verdict::Certified(_)) => {}
        other => panic!("{other:?}"),
    }
    let crossing = self_intersections(section.positions(), section.complex());
    assert!(crossing.pairs.is_empty(), "{} pairs of triangles meet", crossing.pairs.len());
}

/// Boundary edges as pairs of points, in order.
fn boundary(mesh: &SourceMesh<3>) -> Vec<[[u64; 3]; 2]> {
    let sides: Vec<[u32; 2]> = indices(mesh).into_iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let alone = sides.iter().filter(|[a, b]| !sides.contains(&[*b, *a]));
    let mut edges: Vec<[[u64; 3]; 2]> =
        alone.map(|edge| edge.map(|v| mesh.positions()[v as usize].map(f64::to_bits))).collect();
    edges.sort_unstable();
    edges
}

fn mean_edge(mesh: &SourceMesh<3>) -> f64 {
    let length = |[a, b]: [u32; 2]| {
        let [p, q] = [a, b].map(|v| mesh.positions()[v as usize]);
        (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt()
    };
    let sides: Vec<[u32; 2]> = indices(mesh).into_iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    sides.iter().map(|&side| length(side)).sum::<f64>() / sides.len() as f64
}

fn fewer(triangles: usize) -> SimplifyParams {
    SimplifyParams { triangles, ..SimplifyParams::default() }
}

#[test]
fn simplified_surfaces_are_sections() {
    for (source, wanted) in [(torus(32, 16, 5.0), 120), (turned_box(6), 40), (half_torus(), 80)] {
        let shell = built(&source);
        let (section, info) = simplify(&shell, &source.clone().into(), &fewer(wanted), &Silent).expect("a section");
        assert_eq!(info.end, SimplifyEnd::Reached, "{info:?}");
        assert!(info.triangles <= wanted && info.triangles == section.surface.complex().cell_count(), "{info:?}");
        assert_eq!(info.first_triangles - info.triangles, 2 * info.collapses);
        assert_eq!(boundary(&section.surface), boundary(&source));
        assert_section(&shell, &section.surface);
    }
}

#[test]
fn what_cannot_become_simpler_is_still_a_section() {
    for source in [torus(16, 9, 3.0), turned_box(4), half_torus(), twisted_cubes()] {
        let shell = built(&source);
        let (section, info) = simplify(&shell, &source.clone().into(), &fewer(0), &Silent).expect("a section");
        assert_eq!(info.end, SimplifyEnd::Exhausted);
        assert_eq!(boundary(&section.surface), boundary(&source));
        assert_section(&shell, &section.surface);
    }
}

#[test]
fn loosened_surfaces_are_sections_and_become_simpler() {
    for source in [torus(16, 9, 3.0), half_torus()] {
        let shell = built(&source);
        // With a bound for the error nothing is loosened, and this one does not bind.
        let params = SimplifyParams { largest_error: Some(f64::MAX), ..fewer(0) };
        let (_, collapsed) = simplify(&shell, &source.clone().into(), &params, &Silent).expect("a section");
        assert_eq!([collapsed.rounds, collapsed.flips, collapsed.moves], [0; 3]);
        let (section, info) = simplify(&shell, &source.clone().into(), &fewer(0), &Silent).expect("a section");
        assert!(info.rounds > 1 && info.flips > 0 && info.moves > 0, "{info:?}");
        assert!(info.triangles < collapsed.triangles, "{info:?}, without {collapsed:?}");
        assert_eq!(info.first_triangles - info.triangles, 2 * info.collapses);
        assert_eq!(info.triangles, section.surface.complex().cell_count());
        assert_eq!(boundary(&section.surface), boundary(&source));
        assert_section(&shell, &section.surface);
    }
}

#[test]
fn texture_stays_embedded_when_a_surface_is_loosened() {
    let source = torus(32, 16, 3.0);
    let shell = built(&source);
    let texture = square_texture(32, 16);
    let [a, b, c] = places(&texture)[0];
    let sign = orient2d(a, b, c);
    let start = TexturedSurface { surface: source, texture: Some(texture) };
    let (section, info) = simplify(&shell, &start, &fewer(0), &Silent).expect("a section");
    assert!(info.rounds > 1 && info.flips > 0 && info.moves > 0 && info.refusals.texture > 0, "{info:?}");
    assert_section(&shell, &section.surface);
    assert_embedded(section.texture.as_ref().expect("a texture"), sign);
    assert_two_crossing_circles(&section);
}

/// The shells that `homeo simplify` tries, with fewer rounds.
fn two_shells() -> [ShellParams; 2] {
    shells_in_turn().map(|params| ShellParams { rounds: 10, ..params })
}

#[test]
fn the_shell_with_the_coarsest_section_is_kept() {
    let start = TexturedSurface::from(torus(12, 8, 3.0));
    let [usual, steep] = two_shells();
    let mut kept = Vec::new();
    for [first, second] in [[&usual, &steep], [&steep, &usual]] {
        let others = std::slice::from_ref(second);
        let made = simplify_in_shells(&start, first, others, &fewer(0), &Silent).expect("a section");
        let angles: Vec<f64> = made.attempts.iter().map(|attempt| attempt.largest_angle).collect();
        assert_eq!(angles, [first.largest_angle, second.largest_angle]);
        let counts: Vec<usize> = made.attempts.iter().flat_map(|a| &a.outcome).map(|o| o.triangles).collect();
        assert_ne!(counts[0], counts[1], "there is nothing to choose");
        assert_eq!(made.kept, usize::from(counts[1] < counts[0]));
        assert_eq!([made.info.triangles, made.section.surface.complex().cell_count()], [counts[made.kept]; 2]);
        assert_section(&made.shell, &made.section.surface);
        kept.push((made.kept, counts));
        // Where the first shell is enough, there is no other.
        let enough = start.surface.complex().cell_count() - 10;
        let made = simplify_in_shells(&start, first, others, &fewer(enough), &Silent).expect("a section");
        assert_eq!((made.info.end, made.kept, made.attempts.len()), (SimplifyEnd::Reached, 0, 1));
    }
    // In the other order it is the same shell.
    kept[1].1.reverse();
    assert_eq!((kept[0].0, &kept[0].1), (1 - kept[1].0, &kept[1].1));
}

#[test]
fn without_a_second_shell_the_first_is_kept() {
    /// Stops as soon as the second shell is begun.
    #[derive(Default)]
    struct Once(std::sync::atomic::AtomicBool);
    impl Progress for Once {
        fn stage(&self, name: &'static str) {
            self.0.store(name == "again", std::sync::atomic::Ordering::Relaxed);
        }
        fn is_cancelled(&self) -> bool {
            self.0.load(std::sync::atomic::Ordering::Relaxed)
        }
    }
    let start = TexturedSurface::from(torus(12, 8, 0.0));
    let [usual, steep] = two_shells();
    let impossible = ShellParams { thickness: f64::NAN, ..steep.clone() };
    let never = SimplifyParams { feature_angle: Some(f64::NAN), ..fewer(0) };
    let stopped = simplify_in_shells(&start, &usual, std::slice::from_ref(&steep), &fewer(0), &Once::default());
    let refused = simplify_in_shells(&start, &usual, std::slice::from_ref(&impossible), &fewer(0), &Silent);
    for (made, why) in [(stopped, ShellError::Cancelled), (refused, ShellError::Thickness)] {
        let made = made.expect("the first section");
        assert_eq!((made.kept, made.info.end), (0, SimplifyEnd::Exhausted));
        assert_eq!(made.attempts[1].outcome, Err(why));
        assert_section(&made.shell, &made.section.surface);
    }
    let none = simplify_in_shells(&start, &impossible, &[steep], &fewer(0), &Silent);
    assert_eq!(none.expect_err("no first shell"), InShellError::Shell(ShellError::Thickness));
    let none = simplify_in_shells(&start, &usual, &[], &never, &Silent);
    assert!(matches!(none.expect_err("no section"), InShellError::Section(SectionError::Parameter(_))));
}

#[test]
fn remeshed_surfaces_are_sections() {
    for source in [torus(16, 9, 3.0), turned_box(4), half_torus(), twisted_cubes()] {
        let shell = built(&source);
        let mut counts = Vec::new();
        for factor in [0.5, 1.0, 2.0] {
            let length = factor * mean_edge(&source);
            let params = RemeshParams { iterations: 3, ..RemeshParams::with_edge_length(length) };
            let (section, info) = remesh(&shell, &source.clone().into(), &params, &Silent).expect("a section");
            assert_eq!(info.triangles, section.surface.complex().cell_count());
            assert_eq!(boundary(&section.surface), boundary(&source));
            assert_section(&shell, &section.surface);
            counts.push(info.triangles);
        }
        assert!(counts[0] > counts[1] && counts[1] > counts[2], "{counts:?}");
    }
}

#[test]
fn a_pinched_vertex_stays() {
    let source = twisted_cubes();
    let shell = built(&source);
    let fine = RemeshParams { feature_angle: Some(0.5), ..RemeshParams::with_edge_length(0.3) };
    let (fine, info) = remesh(&shell, &source.into(), &fine, &Silent).expect("a section");
    assert!(info.splits > 100);
    let (coarse, _) = simplify(&shell, &fine, &fewer(60), &Silent).expect("a section");
    for section in [&fine, &coarse] {
        assert!(section.surface.positions().contains(&[0.0; 3]));
        assert_section(&shell, &section.surface);
    }
}

#[test]
fn sizes_vary_with_the_factors() {
    let source = torus(16, 9, 0.0);
    let shell = built(&source);
    let factor = |p: &Point| if p[0] > 0.0 { 0.5 } else { 1.5 };
    let sizing = Some(source.positions().iter().map(factor).collect());
    let params = RemeshParams { sizing, ..RemeshParams::with_edge_length(mean_edge(&source)) };
    let (section, _) = remesh(&shell, &source.into(), &params, &Silent).expect("a section");
    let right = section.surface.positions().iter().filter(|p| p[0] > 0.0).count();
    assert!(right > 3 * (section.surface.positions().len() - right), "{right}");
    assert_section(&shell, &section.surface);
}

#[test]
fn features_keep_their_points() {
    let source = turned_box(6);
    let shell = built(&source);
    let params = SimplifyParams { feature_angle: Some(0.5), ..fewer(40) };
    let (section, info) = simplify(&shell, &source.clone().into(), &params, &Silent).expect("a section");
    assert_eq!(info.end, SimplifyEnd::Reached, "{info:?}");
    // The box is still the box: every vertex that is left is near its sides, and the eight corners are there.
    assert!(info.largest_error < 1e-6, "{}", info.largest_error);
    let corners = |mesh: &SourceMesh<3>| {
        let many = |v: u32| {
            let around = mesh.complex().cells().iter().filter(|cell| cell.iter().any(|w| w.raw() == v));
            let mut normals: Vec<[i64; 3]> = around
                .map(|cell| {
                    let [a, b, c] = cell.map(|v| mesh.positions()[v.index()]);
                    let [u, w] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
                    let n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
                    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
                    n.map(|x| (1e3 * x / length).round() as i64)
                })
                .collect();
            normals.sort_unstable();
            normals.dedup();
            normals.len() >= 3
        };
        let mut found: Vec<[u64; 3]> = (0..mesh.positions().len() as u32)
            .filter(|&v| many(v))
            .map(|v| mesh.positions()[v as usize].map(f64::to_bits))
            .collect();
        found.sort_unstable();
        found
    };
    assert_eq!(corners(&source).len(), 8);
    assert_eq!(corners(&section.surface), corners(&source));
    assert_section(&shell, &section.surface);
}

#[test]
fn the_largest_error_is_kept() {
    let source = torus(32, 16, 0.0);
    let shell = built(&source);
    let params = SimplifyParams { largest_error: Some(0.01), ..fewer(0) };
    let (section, info) = simplify(&shell, &source.into(), &params, &Silent).expect("a section");
    assert!(info.largest_error <= 0.01 && info.end == SimplifyEnd::Exhausted && info.collapses > 100, "{info:?}");
    assert!(info.triangles > 60, "without the limit it goes further: {info:?}");
    assert_section(&shell, &section.surface);
}

#[test]
fn triangles_that_leave_the_shell_or_turn_over_are_refused() {
    let source = torus(16, 9, 3.0);
    let shell = built(&source);
    assert_eq!(check(&shell, &source), Ok(()));
    let fault = |mesh: &SourceMesh<3>| match check(&shell, mesh) {
        Err(SectionError::NotASection { fault, .. }) => fault,
        other => panic!("{other:?}"),
    };
    let moved = |v: usize, place: Point| {
        let mut positions = source.positions().to_vec();
        positions[v] = place;
        surface(positions, &indices(&source))
    };
    let far = source.positions()[3].map(|x| 2.0 * x);
    assert!(matches!(fault(&moved(3, far)), Fault::Cap | Fault::Crossing));
    // A vertex on the far side of its neighbours folds a triangle over, within the shell.
    let (a, b) = (source.positions()[3], source.positions()[4]);
    let folded = moved(3, std::array::from_fn(|i| a[i] + 1.5 * (b[i] - a[i])));
    assert!(matches!(fault(&folded), Fault::Crossing | Fault::Cap));
    let flat = moved(3, b);
    assert_eq!(fault(&flat), Fault::NoArea);
    let turned: Vec<[u32; 3]> = indices(&source).into_iter().map(|[a, b, c]| [a, c, b]).collect();
    assert_eq!(fault(&surface(source.positions().to_vec(), &turned)), Fault::Crossing);
    let mut holed = indices(&source);
    holed.pop();
    assert_eq!(check(&shell, &surface(source.positions().to_vec(), &holed)), Err(SectionError::Boundary));
    holed.push([holed[0][0], holed[0][1], 100]);
    assert!(matches!(
        check(&shell, &surface(source.positions().to_vec(), &holed)),
        Err(SectionError::NotASurface { .. })
    ));
}

#[test]
fn a_boundary_that_moves_and_a_triangle_beyond_a_wall_are_refused() {
    let source = half_torus();
    let shell = built(&source);
    assert_eq!(check(&shell, &source), Ok(()));
    let on_boundary = boundary(&source)[0][0].map(f64::from_bits);
    let v = source.positions().iter().position(|p| *p == on_boundary).expect("a vertex");
    let mut positions = source.positions().to_vec();
    positions[v][0] += 1e-3;
    assert_eq!(check(&shell, &surface(positions, &indices(&source))), Err(SectionError::Boundary));
    // The neighbours of a boundary vertex behind the boundary.
    let cells = indices(&source);
    let cell = cells.iter().find(|cell| cell.contains(&(v as u32))).expect("a triangle");
    let edge_points = boundary(&source).concat();
    let is_inner = |w: &u32| !edge_points.contains(&source.positions()[*w as usize].map(f64::to_bits));
    let inner = cells.iter().filter(|c| c.contains(&(v as u32))).flatten().copied().find(is_inner);
    let inner = inner.unwrap_or(cell[0]) as usize;
    let mut positions = source.positions().to_vec();
    let (p, q) = (positions[v], positions[inner]);
    positions[inner] = std::array::from_fn(|i| p[i] + 0.3 * (p[i] - q[i]));
    assert!(matches!(check(&shell, &surface(positions, &cells)), Err(SectionError::NotASection { .. })));
}

#[test]
fn parameters_and_textures_that_do_not_fit_are_errors() {
    let source = torus(12, 8, 0.0);
    let shell = built(&source);
    let start = TexturedSurface::from(source);
    let negative = SimplifyParams { largest_error: Some(-1.0), ..fewer(0) };
    assert!(matches!(simplify(&shell, &start, &negative, &Silent), Err(SectionError::Parameter(_))));
    let angle = SimplifyParams { feature_angle: Some(f64::NAN), ..fewer(0) };
    assert!(matches!(simplify(&shell, &start, &angle, &Silent), Err(SectionError::Parameter(_))));
    let zero = RemeshParams::with_edge_length(0.0);
    assert!(matches!(remesh(&shell, &start, &zero, &Silent), Err(SectionError::Parameter(_))));
    let sizing = RemeshParams { sizing: Some(vec![1.0]), ..RemeshParams::with_edge_length(1.0) };
    assert!(matches!(remesh(&shell, &start, &sizing, &Silent), Err(SectionError::Parameter(_))));
    let texture = Some(Texture { coordinates: vec![[0.0; 2]], corners: vec![[0, 0, 1]; 192] });
    let textured = TexturedSurface { texture, ..start };
    assert!(matches!(simplify(&shell, &textured, &fewer(0), &Silent), Err(SectionError::Texture(_))));
}

#[test]
fn cancelled_work_leaves_a_section() {
    struct After(std::sync::atomic::AtomicUsize);
    impl Progress for After {
        fn is_cancelled(&self) -> bool {
            self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed) > 40
        }
    }
    let source = torus(16, 9, 3.0);
    let shell = built(&source);
    let (section, info) =
        simplify(&shell, &source.clone().into(), &fewer(0), &After(Default::default())).expect("a section");
    assert_eq!(info.end, SimplifyEnd::Cancelled);
    assert!(info.collapses > 5);
    assert_section(&shell, &section.surface);
    let params = RemeshParams::with_edge_length(0.5 * mean_edge(&source));
    let (section, info) = remesh(&shell, &source.into(), &params, &After(Default::default())).expect("a section");
    assert!(info.iterations == 0 && info.splits > 5);
    assert_section(&shell, &section.surface);
}

/// The torus cut open along two circles: one chart, the unit square.
fn square_texture(n: u32, m: u32) -> Texture {
    let coordinates = (0..(n + 1) * (m + 1))
        .map(|k| [f64::from(k / (m + 1)) / f64::from(n), f64::from(k % (m + 1)) / f64::from(m)])
        .collect();
    let at = |i: u32, j: u32| i * (m + 1) + j;
    let corners = (0..n * m)
        .flat_map(|k| {
            let (i, j) = (k / m, k % m);
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        })
        .collect();
    Texture { coordinates, corners }
}

fn places(texture: &Texture) -> Vec<[[f64; 2]; 3]> {
    texture.corners.iter().map(|corners| corners.map(|k| texture.coordinates[k as usize])).collect()
}

/// All triangles have the given sign, and no two of them have inner points in common: by every pair, exactly.
fn assert_embedded(texture: &Texture, sign: Sign) {
    let triangles = places(texture);
    assert!(triangles.iter().all(|&[a, b, c]| orient2d(a, b, c) == sign), "a triangle is turned over");
    // Disjoint inner parts are parted by the line through a side of one of the two.
    let parts = |[a, b, c]: [[f64; 2]; 3], other: [[f64; 2]; 3]| {
        let beyond = |p, q| other.iter().all(|&x| matches!(orient2d(p, q, x), s if s != sign));
        beyond(a, b) || beyond(b, c) || beyond(c, a)
    };
    for (k, &one) in triangles.iter().enumerate() {
        assert!(triangles[..k].iter().all(|&other| parts(one, other) || parts(other, one)), "an overlap at {k}");
    }
}

/// Ends in space of the edges where corners differ, in order.
fn seams(section: &TexturedSurface) -> Vec<[u32; 2]> {
    let texture = section.texture.as_ref().expect("a texture");
    let mut sides = std::collections::HashMap::new();
    for (t, corners) in indices(&section.surface).into_iter().enumerate() {
        for k in 0..3 {
            let marks = [k, (k + 1) % 3].map(|k| texture.corners[t][k]);
            sides.insert([corners[k], corners[(k + 1) % 3]], marks);
        }
    }
    let differs =
        |(&[a, b], &[i, j]): (&[u32; 2], &[u32; 2])| (a < b && sides.get(&[b, a]) != Some(&[j, i])).then_some([a, b]);
    sides.iter().filter_map(differs).collect()
}

/// Whether all seam vertices have two seam edges, but one that has four: two circles that cross.
fn assert_two_crossing_circles(section: &TexturedSurface) {
    let seams = seams(section);
    let mut degree = vec![0; section.surface.positions().len()];
    seams.iter().flatten().for_each(|&v| degree[v as usize] += 1);
    assert_eq!(degree.iter().filter(|d| **d == 4).count(), 1);
    assert!(degree.iter().all(|d| [0, 2, 4].contains(d)));
    assert!(seams.len() >= 6);
}

#[test]
fn texture_stays_embedded_under_simplification() {
    for sign in [Sign::Positive, Sign::Negative] {
        let (n, m) = (32, 16);
        let source = torus(n, m, 3.0);
        let shell = built(&source);
        let mut texture = square_texture(n, m);
        if orient2d(places(&texture)[0][0], places(&texture)[0][1], places(&texture)[0][2]) != sign {
            texture.coordinates.iter_mut().for_each(|p| p[0] = -p[0]);
        }
        // Waves along the seams, so that their short cuts lie inside and outside.
        let turn = std::f64::consts::TAU;
        for [u, v] in &mut texture.coordinates {
            [*u, *v] = [*u + 0.04 * (3.0 * turn * *v).sin(), *v + 0.04 * (2.0 * turn * *u).sin()];
        }
        assert_embedded(&texture, sign);
        let start = TexturedSurface { surface: source, texture: Some(texture) };
        assert_two_crossing_circles(&start);
        let (section, info) = simplify(&shell, &start, &fewer(150), &Silent).expect("a section");
        assert_eq!(info.end, SimplifyEnd::Reached, "{info:?}");
        assert_section(&shell, &section.surface);
        assert_embedded(section.texture.as_ref().expect("a texture"), sign);
        assert_two_crossing_circles(&section);
        assert!(seams(&section).len() < seams(&start).len() / 2, "seams become simpler, too");
    }
}

#[test]
fn texture_stays_embedded_under_remeshing() {
    let (n, m) = (16, 9);
    let source = torus(n, m, 3.0);
    let shell = built(&source);
    let start = TexturedSurface { texture: Some(square_texture(n, m)), surface: source };
    let sign = Sign::Positive;
    assert_embedded(start.texture.as_ref().expect("a texture"), sign);
    for factor in [0.6, 1.0, 1.8] {
        let params =
            RemeshParams { iterations: 3, ..RemeshParams::with_edge_length(factor * mean_edge(&start.surface)) };
        let (section, _) = remesh(&shell, &start, &params, &Silent).expect("a section");
        assert_section(&shell, &section.surface);
        assert_embedded(section.texture.as_ref().expect("a texture"), sign);
        assert_two_crossing_circles(&section);
    }
}

/// Two charts, with seams that end on the boundary of the surface.
#[test]
fn texture_of_an_open_surface_stays_embedded() {
    let whole = torus(20, 12, 3.0);
    let all = square_texture(20, 12);
    let is_kept = |cell: &[u32; 3]| cell.iter().all(|&v| whole.positions()[v as usize][0] > -0.2);
    let kept = indices(&whole).into_iter().zip(&all.corners).filter(|(cell, _)| is_kept(cell));
    let texture = Texture { corners: kept.map(|(_, corners)| *corners).collect(), ..all };
    let source = half_torus();
    let shell = built(&source);
    let start = TexturedSurface { texture: Some(texture), surface: source };
    let (coarse, info) = simplify(&shell, &start, &fewer(120), &Silent).expect("a section");
    assert!(info.triangles < 160, "{info:?}");
    let params = RemeshParams { iterations: 2, ..RemeshParams::with_edge_length(0.8 * mean_edge(&start.surface)) };
    let (fine, _) = remesh(&shell, &start, &params, &Silent).expect("a section");
    for section in [coarse, fine] {
        assert_section(&shell, &section.surface);
        assert_embedded(section.texture.as_ref().expect("a texture"), Sign::Positive);
        assert_eq!(boundary(&section.surface), boundary(&start.surface));
        assert!(!seams(&section).is_empty());
    }
}

/// The texture of what moved is that of the source at the point over which it lies.
#[test]
fn texture_follows_the_source() {
    let (n, m) = (32, 16);
    let source = torus(n, m, 0.0);
    let shell = built(&source);
    let start = TexturedSurface { texture: Some(square_texture(n, m)), surface: source };
    let (section, _) = simplify(&shell, &start, &fewer(300), &Silent).expect("a section");
    let texture = section.texture.as_ref().expect("a texture");
    for (cell, corners) in section.surface.complex().cells().iter().zip(&texture.corners) {
        for k in 0..3 {
            let [x, y, _] = section.surface.positions()[cell[k].index()];
            let turn = y.atan2(x).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
            let [u, _] = texture.coordinates[corners[k] as usize];
            let off = (u - turn).abs().min(1.0 - (u - turn).abs());
            assert!(off < 0.01, "{u} at {turn}");
        }
    }
}

#[test]
fn results_do_not_depend_on_threads() {
    let source = torus(16, 9, 3.0);
    let shell = built(&source);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let start = source.clone().into();
            let (coarse, info) = simplify(&shell, &start, &fewer(0), &Silent).expect("a section");
            assert!(info.rounds > 0 && info.moves > 0, "{info:?}");
            let params = RemeshParams { iterations: 2, ..RemeshParams::with_edge_length(0.2) };
            let (fine, _) = remesh(&shell, &start, &params, &Silent).expect("a section");
            [coarse, fine].map(|section| (section.surface.positions().to_vec(), indices(&section.surface)))
        })
    };
    assert_eq!(run(1), run(3));
}
