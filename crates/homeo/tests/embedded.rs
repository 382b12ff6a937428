//! Shells that must not overlap themselves, by looking at all pairs of triangles of their skin.

mod support;

use homeo::construct::shell::{ShellError, ShellParams, build};
use homeo::input::SourceMesh;
use homeo::map::Shell;
use homeo::progress::Silent;
use homeo_core::predicate::triangles_meet;
use support::{Point, half_torus, roll, sphere, together, twisted_cubes};

/// Columns and points of a triangle of the skin.
type Face = [(u32, Point); 3];

fn faces(shell: &Shell) -> Vec<Face> {
    let parts = shell.parts();
    let caps = |level: &Vec<Point>| -> Vec<Face> {
        parts.prisms.iter().map(|prism| prism.map(|v| (v, level[v as usize]))).collect()
    };
    let sides = |prism: &[u32; 3]| [0, 1, 2].map(|k| [prism[k], prism[(k + 1) % 3]]);
    let all: Vec<[u32; 2]> = parts.prisms.iter().flat_map(sides).collect();
    let boundary = all.iter().filter(|[a, b]| !all.contains(&[*b, *a]));
    let walls = boundary.flat_map(|&[a, b]| {
        [[&parts.bottom, &parts.middle], [&parts.middle, &parts.top]].into_iter().flat_map(move |[low, high]| {
            let corner = |level: &Vec<Point>, v: u32| (v, level[v as usize]);
            let [p, q, r, s] = [corner(low, a), corner(low, b), corner(high, b), corner(high, a)];
            [[p, q, r], [p, r, s]]
        })
    });
    [caps(&parts.bottom), caps(&parts.top), walls.collect()].concat()
}

/// How many pairs of triangles without a column in common meet.
fn meeting_pairs(shell: &Shell) -> usize {
    let faces = faces(shell);
    let meet = |a: &Face, b: &Face| {
        !a.iter().any(|(v, _)| b.iter().any(|(w, _)| v == w)) && triangles_meet(a.map(|c| c.1), b.map(|c| c.1))
    };
    (0..faces.len()).map(|k| faces[..k].iter().filter(|other| meet(&faces[k], other)).count()).sum()
}

fn built(source: &SourceMesh<3>, embedded: bool) -> Shell {
    let params = ShellParams { thickness: 0.3, rounds: 6, embedded, ..ShellParams::default() };
    build(source, &params, &Silent).expect("a shell").0
}

#[test]
fn embedded_shells_do_not_overlap_and_others_do() {
    for source in [roll(2.6, 40), together(&[1.0, 0.97].map(|radius| sphere(10, 14, radius)))] {
        assert!(meeting_pairs(&built(&source, false)) > 0);
        let shell = built(&source, true);
        assert_eq!(meeting_pairs(&shell), 0);
        assert!(source.positions().iter().all(|&point| shell.to_middle(point).is_ok()));
    }
}

#[test]
fn open_and_singular_surfaces_have_embedded_shells() {
    for source in [half_torus(), twisted_cubes()] {
        let shell = built(&source, true);
        assert_eq!(meeting_pairs(&shell), 0);
        assert!(shell.parts().prisms.len() < source.complex().cell_count(), "it was simplified");
    }
}

#[test]
fn no_shell_is_both_embedded_and_immersed() {
    let params = ShellParams { embedded: true, immersed: true, ..ShellParams::default() };
    assert_eq!(build(&half_torus(), &params, &Silent).err(), Some(ShellError::Contradiction));
}
