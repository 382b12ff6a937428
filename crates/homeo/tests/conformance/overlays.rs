//! Overlays: their cells tile both surfaces, exactly.

use std::collections::BTreeMap;

use homeo::map::Shell;
use homeo::overlay::{Cell, for_each_cell, shares};
use homeo::progress::{Progress, Silent};
use homeo_core::number::{Lazy, Rational, Scalar};
use homeo_core::predicate::Sign;

use crate::shells::{Surface, built, singular, sphere};

fn cells_of(shell: &Shell) -> Vec<Cell> {
    let mut cells = Vec::new();
    assert!(for_each_cell(shell, &Silent, |cell| cells.push(cell)));
    cells
}

/// The laws of a common refinement: shares of every triangle add up to 1, and all corners are the same points.
fn check(shell: &Shell, section_triangles: usize) {
    let shares = shares(shell, &Silent).expect("nobody stops it");
    let (mut of_source, mut of_section) = (BTreeMap::new(), BTreeMap::new());
    for share in &shares {
        let is_positive = |part: &Lazy| part.certain_sign() == Sign::Positive;
        assert!(is_positive(&share.of_source) && is_positive(&share.of_section), "{share:?}");
        let add = |sums: &mut BTreeMap<u32, Lazy>, key: u32, part: &Lazy| {
            let sum = sums.entry(key).or_insert_with(|| Lazy::from_f64(0.0));
            *sum = sum.plus(part);
        };
        add(&mut of_source, share.source, &share.of_source);
        add(&mut of_section, share.section, &share.of_section);
    }
    assert_eq!(of_source.len(), shell.source().complex().cell_count(), "every triangle of the source is met");
    assert_eq!(of_section.len(), section_triangles, "every triangle of the section is met");
    for (triangle, sum) in of_source.iter().chain(&of_section) {
        assert_eq!(*sum.exact(), Rational::ONE, "the shares of triangle {triangle}");
    }
    cells_of(shell).iter().step_by(7).for_each(|cell| check_corners(shell, cell));
}

/// The map takes each corner on the source to the one on the section, through the one on the middle surface.
fn check_corners(shell: &Shell, cell: &Cell) {
    for (corner, next) in cell.corners.iter().zip(cell.corners.iter().cycle().skip(1)) {
        let side = &cell.sides[cell.corners.iter().position(|other| other == corner).expect("it is one of them")];
        for (edge, ends) in [
            (side.of_source, [corner, next].map(|end| cell.on_source(end))),
            (side.of_section, [corner, next].map(|end| cell.on_section(end))),
        ] {
            let on_edge: Vec<u8> = (0..3).filter(|&k| ends.iter().all(|end| end[usize::from(k)].is_zero())).collect();
            assert_eq!(edge.into_iter().collect::<Vec<u8>>(), on_edge, "the edge on which a side lies");
        }
        let (on_source, on_section) = (cell.on_source(corner), cell.on_section(corner));
        let source = shell.source();
        let triangle = source.complex().cells()[cell.source as usize];
        let point: [Rational; 3] = std::array::from_fn(|axis| {
            let exact = |k: usize| crate::points::exact(source.positions()[triangle[k].index()])[axis].clone();
            (0..3).map(|k| on_source[k].exact() * &exact(k)).sum()
        });
        let at = shell.project_exact(&point).expect("on the source");
        if at.prism == cell.prism {
            assert_eq!(at.weights.each_ref(), corner.each_ref().map(Lazy::exact), "on the middle surface");
        }
        let image = shell.to_section_exact(&at).expect("on the section");
        if image.triangle == cell.section {
            assert_eq!(image.weights.each_ref(), on_section.each_ref().map(Lazy::exact), "on the section");
        }
    }
}

fn check_all(surface: &Surface, rounds: usize) {
    let shell = built(surface, rounds);
    check(&shell, shell.parts().prisms.len());
    let source = shell.source().clone();
    let count = source.complex().cell_count();
    let onto_itself = built(surface, rounds).with_section(source);
    check(&onto_itself, count);
    for share in shares(&onto_itself, &Silent).expect("nobody stops it") {
        assert_eq!(share.source, share.section, "the map of a surface onto itself is the identity");
    }
}

#[test]
fn overlays_of_a_sphere_and_its_shell() {
    check_all(&sphere(2), 0);
    check_all(&sphere(2), 30);
}

#[test]
fn overlays_at_a_singular_vertex() {
    check_all(&singular(), 0);
    check_all(&singular(), 30);
}

#[test]
fn overlays_do_not_depend_on_threads_and_can_be_stopped() {
    let shell = built(&sphere(2), 5);
    assert_eq!(crate::in_threads(1, || cells_of(&shell)), crate::in_threads(2, || cells_of(&shell)));
    struct Stopped;
    impl Progress for Stopped {
        fn is_cancelled(&self) -> bool {
            true
        }
    }
    assert_eq!(shares(&shell, &Stopped), None);
}

/// Negative control: a shell whose source leaves it has triangles that are not covered.
#[test]
fn shares_of_an_invalid_shell_do_not_add_up() {
    let shell = built(&sphere(2), 30);
    let mut positions = shell.source().positions().to_vec();
    positions[3] = positions[3].map(|x| 3.0 * x);
    let moved = homeo::input::SourceMesh::new(positions, shell.source().complex().clone());
    let broken = Shell::from_parts(moved, shell.parts().clone());
    let shares = shares(&broken, &Silent).expect("nobody stops it");
    let total: Rational = shares.iter().map(|share| share.of_source.exact().clone()).sum();
    assert_ne!(total, Rational::from(broken.source().complex().cell_count() as i64));
}
