//! Common refinements as meshes: what must hold for two meshes with one connectivity, exactly.

mod support;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use homeo::construct::section::{RemeshParams, SimplifyParams, remesh, simplify};
use homeo::construct::shell::{ShellParams, build};
use homeo::input::SourceMesh;
use homeo::map::{Shell, ShellParts, SurfacePoint};
use homeo::overlay::{ExactVertex, Refinement, refinement};
use homeo::progress::{Progress, Silent};
use homeo_core::mesh::SimplicialComplex;
use homeo_core::number::{Rational, Scalar};
use homeo_core::predicate::Sign;
use homeo_core::topology::{Options, SurfaceReport, analyse_triangles};
use support::{Point, surface, torus, turned_box, twisted_cubes};

type ExactPoint = [Rational; 3];

fn built(source: &SourceMesh<3>, rounds: usize) -> Shell {
    build(source, &ShellParams { rounds, ..ShellParams::default() }, &Silent).expect("a shell").0
}

fn refined(shell: &Shell) -> (Refinement, Vec<ExactVertex>) {
    let refined = refinement(shell, &Silent).expect("nobody stops it");
    let mut exact = Vec::new();
    assert!(refined.for_each_exact(shell, &Silent, |vertex| exact.push(vertex)));
    (refined, exact)
}

fn indices(mesh: &SourceMesh<3>) -> Vec<[u32; 3]> {
    mesh.complex().cells().iter().map(|cell| cell.map(|v| v.raw())).collect()
}

fn middle_of(parts: &ShellParts) -> SourceMesh<3> {
    surface(parts.middle.clone(), &parts.prisms)
}

fn topology(positions: &[Point], triangles: &[[u32; 3]]) -> SurfaceReport {
    let complex = SimplicialComplex::from_indices(positions.len(), triangles).expect("vertices exist");
    analyse_triangles(positions, &complex, Options::default())
}

/// Broken laws, in words; empty for a common refinement.
fn broken_laws(shell: &Shell, refined: &Refinement, exact: &[ExactVertex]) -> Vec<String> {
    let section = shell.section().cloned().unwrap_or_else(|| middle_of(shell.parts()));
    let places: [Vec<&SurfacePoint<Rational>>; 2] =
        [exact.iter().map(|v| &v.on_source).collect(), exact.iter().map(|v| &v.on_section).collect()];
    let mut broken = connectivity(shell.source(), refined);
    for (side, (mesh, places)) in [shell.source(), &section].into_iter().zip(&places).enumerate() {
        let parents: Vec<u32> = refined.parents.iter().map(|parents| parents[side]).collect();
        broken.extend(tiling(mesh, &refined.triangles, &parents, places));
        broken.extend(vertices(mesh, places, [&refined.source, &refined.section][side]));
    }
    broken.extend(the_map(shell, exact));
    broken
}

/// The surface is that of the source.
fn connectivity(source: &SourceMesh<3>, refined: &Refinement) -> Vec<String> {
    let mut broken = Vec::new();
    let mut sides = BTreeSet::new();
    for [a, b, c] in refined.triangles.iter().copied() {
        let is_new = [(a, b), (b, c), (c, a)].map(|side| sides.insert(side));
        if is_new != [true; 3] {
            broken.push(format!("two triangles run along a side of {a} {b} {c} alike"));
        }
    }
    let alone = sides.iter().filter(|&&(a, b)| !sides.contains(&(b, a))).count();
    let [before, after] = [(source.positions(), indices(source)), (&refined.source[..], refined.triangles.clone())]
        .map(|(positions, triangles)| topology(positions, &triangles));
    if !after.manifold || !after.consistently_oriented {
        broken.push("no oriented manifold".to_owned());
    }
    let used = |report: &SurfaceReport| (report.vertices - report.isolated_vertices) as i64;
    let of = |report: &SurfaceReport| {
        let characteristic = used(report) - report.edges as i64 + report.faces as i64;
        (report.components, characteristic, report.boundary_loops, report.genus)
    };
    if of(&before) != of(&after) {
        broken.push(format!("{:?} became {:?}", of(&before), of(&after)));
    }
    if before.closed != (alone == 0) {
        broken.push(format!("{alone} edges have one triangle"));
    }
    broken
}

/// The triangles in each parent are positive and cover it: their areas add up to exactly 1.
fn tiling(
    mesh: &SourceMesh<3>,
    triangles: &[[u32; 3]],
    parents: &[u32],
    places: &[&SurfacePoint<Rational>],
) -> Vec<String> {
    let mut broken = Vec::new();
    let mut sums: BTreeMap<u32, Rational> = BTreeMap::new();
    for (corners, &parent) in triangles.iter().zip(parents) {
        let frame = Frame::of(mesh, parent);
        let weights = corners.map(|v| frame.weights(&places[v as usize].point));
        let [Some(a), Some(b), Some(c)] = weights else {
            broken.push(format!("a corner of {corners:?} is not in the plane of triangle {parent}"));
            continue;
        };
        if [&a, &b, &c].iter().any(|weights| weights.iter().any(|w| w.sign() == Sign::Negative)) {
            broken.push(format!("a corner of {corners:?} is outside triangle {parent}"));
        }
        let area = determinant(&[a, b, c]);
        if area.sign() != Sign::Positive {
            broken.push(format!("{corners:?} has the area {area} in triangle {parent}"));
        }
        let sum = sums.entry(parent).or_insert(Rational::ZERO);
        *sum = &*sum + &area;
    }
    let is_one = |t: usize| sums.get(&(t as u32)).is_some_and(|sum| *sum == Rational::ONE);
    broken
        .extend((0..mesh.complex().cell_count()).filter(|&t| !is_one(t)).map(|t| format!("the area of triangle {t}")));
    broken
}

/// No place occurs twice, all vertices of the surface occur, bit for bit, and positions are rounded from the exact ones.
fn vertices(mesh: &SourceMesh<3>, places: &[&SurfacePoint<Rational>], rounded: &[Point]) -> Vec<String> {
    let mut broken = Vec::new();
    let cells = indices(mesh);
    let mut found: HashMap<Vec<(u32, Rational)>, usize> = HashMap::new();
    for (number, place) in places.iter().enumerate() {
        let corners = cells[place.triangle as usize];
        let held = (0..3).filter(|&k| !place.weights[k].is_zero());
        let mut key: Vec<(u32, Rational)> = held.map(|k| (corners[k], place.weights[k].clone())).collect();
        key.sort();
        if let Some(other) = found.insert(key, number) {
            broken.push(format!("vertices {other} and {number} are at the same place"));
        }
        let is_near = |axis: usize| (place.point[axis].to_f64() - rounded[number][axis]).abs() < 1e-10;
        if !(0..3).all(is_near) {
            broken.push(format!("vertex {number} is rounded to {:?}", rounded[number]));
        }
    }
    let used: BTreeSet<u32> = cells.into_iter().flatten().collect();
    for v in used {
        let there = found.get(&vec![(v, Rational::ONE)]);
        if there.is_none_or(|&number| rounded[number] != mesh.positions()[v as usize]) {
            broken.push(format!("vertex {v} of the surface is missing or moved"));
        }
    }
    broken
}

/// The shell's own map sends places on the source to those on the section.
fn the_map(shell: &Shell, exact: &[ExactVertex]) -> Vec<String> {
    let differs = |vertex: &&ExactVertex| {
        let at = shell.project_exact(&vertex.on_source.point);
        // Where several columns share a point of space, it does not tell which one is meant.
        at.is_ok_and(|at| shell.to_section_exact(&at).map(|image| image.point) != Ok(vertex.on_section.point.clone()))
    };
    let wrong = exact.iter().step_by(5).filter(differs);
    wrong.map(|vertex| format!("vertex {} goes elsewhere under the map", vertex.vertex)).collect()
}

/// A triangle in space, exactly.
struct Frame([ExactPoint; 3]);

impl Frame {
    fn of(mesh: &SourceMesh<3>, triangle: u32) -> Self {
        let corners = mesh.complex().cells()[triangle as usize];
        Self(corners.map(|v| mesh.positions()[v.index()].map(<Rational as Scalar>::from_f64)))
    }

    /// The weights of a point; `None` off the plane.
    fn weights(&self, point: &ExactPoint) -> Option<[Rational; 3]> {
        let Self([a, b, c]) = self;
        let normal = cross(&minus(b, a), &minus(c, a));
        if !dot(&normal, &minus(point, a)).is_zero() {
            return None;
        }
        let whole = dot(&normal, &normal);
        let part = |p: &ExactPoint, q: &ExactPoint| &dot(&cross(&minus(p, point), &minus(q, point)), &normal) / &whole;
        Some([part(b, c), part(c, a), part(a, b)])
    }
}

fn minus(a: &ExactPoint, b: &ExactPoint) -> ExactPoint {
    std::array::from_fn(|i| &a[i] - &b[i])
}

fn dot(a: &ExactPoint, b: &ExactPoint) -> Rational {
    (0..3).map(|i| &a[i] * &b[i]).sum()
}

fn cross(a: &ExactPoint, b: &ExactPoint) -> ExactPoint {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &(&a[i] * &b[j]) - &(&a[j] * &b[i]))
}

fn determinant([a, b, c]: &[[Rational; 3]; 3]) -> Rational {
    dot(a, &cross(b, c))
}

fn check(shell: &Shell) -> Refinement {
    let (refined, exact) = refined(shell);
    let broken = broken_laws(shell, &refined, &exact);
    assert!(broken.is_empty(), "{} laws are broken:\n{}", broken.len(), broken[..broken.len().min(20)].join("\n"));
    refined
}

/// A part of a torus, with two boundary loops. Small, as all numbers here are rationals of some thousand digits.
fn tube() -> SourceMesh<3> {
    let whole = torus(10, 6, 2.0);
    let is_kept = |cell: &[u32; 3]| cell.iter().all(|&v| whole.positions()[v as usize][0] > -0.2);
    let triangles: Vec<[u32; 3]> = indices(&whole).into_iter().filter(is_kept).collect();
    surface(whole.positions().to_vec(), &triangles)
}

/// Surfaces of all kinds: curved and flat, closed and open, with vertices that have no direction.
fn surfaces() -> [SourceMesh<3>; 4] {
    [torus(8, 6, 2.0), turned_box(2), tube(), twisted_cubes()]
}

#[test]
fn source_and_middle_surface() {
    for source in surfaces() {
        let first = check(&built(&source, 0));
        assert_eq!(first.triangles.len(), source.complex().cell_count(), "the first middle surface is the source");
        let refined = check(&built(&source, 10));
        assert!(refined.triangles.len() >= source.complex().cell_count());
    }
}

#[test]
fn source_and_simplified_section() {
    for source in surfaces() {
        let shell = built(&source, 10);
        let params = SimplifyParams { triangles: source.complex().cell_count() / 3, ..SimplifyParams::default() };
        let (section, _) = simplify(&shell, &source.clone().into(), &params, &Silent).expect("a section");
        check(&shell.with_section(section.surface));
    }
}

#[test]
fn source_and_remeshed_section() {
    for source in surfaces() {
        let shell = built(&source, 10);
        let params = RemeshParams { iterations: 1, ..RemeshParams::with_edge_length(0.5) };
        let (section, _) = remesh(&shell, &source.clone().into(), &params, &Silent).expect("a section");
        check(&shell.with_section(section.surface));
    }
}

/// All vertices and edges of the one surface are those of the other, in general position in the shell.
#[test]
fn a_surface_and_itself() {
    for source in surfaces() {
        let shell = built(&source, 10).with_section(source.clone());
        let refined = check(&shell);
        assert!(refined.parents.iter().all(|[source, section]| source == section));
        assert!(refined.for_each_exact(&shell, &Silent, |vertex| {
            assert_eq!(vertex.on_source.point, vertex.on_section.point, "the map is the identity");
        }));
    }
}

/// Some triangles are the same, others meet them in vertices only, edges cross three at a time: the section is the source
/// with flipped diagonals.
#[test]
fn a_surface_and_its_other_diagonals() {
    let source = turned_box(4);
    let cells = indices(&source);
    let flipped: Vec<[u32; 3]> = cells
        .chunks(2)
        .enumerate()
        .flat_map(|(k, pair)| {
            let [[a, b, c], [_, _, _]] = [pair[0], pair[1]];
            let d = *pair[1].iter().find(|v| !pair[0].contains(v)).expect("a square");
            let shared: Vec<u32> = pair[0].iter().copied().filter(|v| pair[1].contains(v)).collect();
            // The corner of the first triangle that is not on the diagonal.
            let apex = [a, b, c].into_iter().position(|v| !shared.contains(&v)).expect("a square");
            let [p, q, r] = [0, 1, 2].map(|i| [a, b, c][(apex + i) % 3]);
            if k % 3 == 0 { vec![pair[0], pair[1]] } else { vec![[p, q, d], [p, d, r]] }
        })
        .collect();
    let section = surface(source.positions().to_vec(), &flipped);
    for rounds in [0, 10] {
        let refined = check(&built(&source, rounds).with_section(section.clone()));
        assert!(refined.triangles.len() > source.complex().cell_count());
    }
}

#[test]
fn what_comes_out_does_not_depend_on_threads_and_can_be_stopped() {
    let shell = built(&tube(), 10);
    let in_threads = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads");
        pool.install(|| refined(&shell))
    };
    assert_eq!(in_threads(1), in_threads(2));
    struct Stopped;
    impl Progress for Stopped {
        fn is_cancelled(&self) -> bool {
            true
        }
    }
    assert_eq!(refinement(&shell, &Stopped), None);
    let (refined, exact) = refined(&shell);
    let mut count = 0;
    assert!(!refined.for_each_exact(&shell, &Stopped, |_| count += 1));
    assert_eq!((count, exact.len()), (0, refined.source.len()));
}

/// Negative controls: the laws notice what is missing, twice, turned over or elsewhere, and shells that are none.
#[test]
fn what_is_no_refinement_breaks_the_laws() {
    let shell = built(&torus(8, 6, 2.0), 3);
    let (good, exact) = refined(&shell);
    let spoilt: [fn(&mut Refinement, &mut Vec<ExactVertex>); 6] = [
        |refined, _| {
            refined.triangles.pop();
            refined.parents.pop();
        },
        |refined, _| refined.triangles[3].reverse(),
        |refined, _| {
            let (last, first) = (refined.source.len() as u32 - 1, refined.triangles[0][0]);
            refined.triangles.iter_mut().flatten().filter(|v| **v == last).for_each(|v| *v = first);
        },
        |refined, _| refined.source[5][1] += 1e-9,
        |_, exact| exact[7].on_section = exact[8].on_section.clone(),
        |_, exact| {
            let (a, b) = (exact[4].on_source.clone(), exact[5].on_source.clone());
            (exact[4].on_source, exact[5].on_source) = (b, a);
        },
    ];
    for (case, spoil) in spoilt.into_iter().enumerate() {
        let (mut refined, mut exact) = (good.clone(), exact.clone());
        spoil(&mut refined, &mut exact);
        assert!(!broken_laws(&shell, &refined, &exact).is_empty(), "case {case}");
    }
    let mut positions = shell.source().positions().to_vec();
    positions[3] = positions[3].map(|x| 3.0 * x);
    let moved = surface(positions, &indices(shell.source()));
    let invalid = Shell::from_parts(moved, shell.parts().clone());
    let (refined, exact) = refined(&invalid);
    assert!(!broken_laws(&invalid, &refined, &exact).is_empty());
}

/// A vertex so near an edge of the other surface that rounding moves it across: the exact triangles are positive all the
/// same, and the count says how many are not after rounding.
#[test]
fn triangles_that_rounding_turns_over_are_counted() {
    let source = turned_box(3);
    let shell = built(&source, 0);
    let mut refined = check(&shell);
    assert_eq!(refined.rounded_over(&shell), [0, 0]);
    let [a, b, c] = refined.triangles[0];
    // The corner goes to the far side of the opposite edge: this triangle turns over, and others do with it.
    let [p, q] = [b, c].map(|v| refined.section[v as usize]);
    let corner = refined.section[a as usize];
    refined.section[a as usize] = std::array::from_fn(|i| p[i] + q[i] - corner[i]);
    let [on_source, on_section] = refined.rounded_over(&shell);
    assert_eq!(on_source, 0);
    assert!(on_section >= 1);
    refined.section[a as usize] = p;
    let [_, flat] = refined.rounded_over(&shell);
    assert!(flat >= 2, "both triangles at the edge have no area");
}
