//! Rule P (and 7 for the cube): a piecewise-linear map onto the box `[0, 1]^n` is a homeomorphism.
//!
//! *Theorem* (by degree; Lipman 2014, Floater 2003). Let every facet have at most two cells, every image cell be
//! non-degenerate, cells that share a facet have images on opposite sides of it, every facet with one cell lie in a
//! side of the box, its cell on the inner side, and the measures of these facets add up to that of the box's boundary.
//! Then the map is a homeomorphism onto the box. (Proof: `docs/certificate-format-v1.md`, rule P.)

use crate::complex::Complex;
use crate::number::{FINEST_BITS, Point, in_finest_units, orientation_2d, orientation_3d};
use crate::verdict::{Checked, check, refuted};
use dashu_base::Abs;
use dashu_int::IBig;
use std::cmp::Ordering;

/// Checks that the linear extension of `image` maps the complex homeomorphically onto `[0, 1]^n`, `n = size - 1`.
pub(crate) fn check_onto_box(complex: &Complex, image: impl Fn(u32) -> Point, rule: &'static str) -> Checked {
    let mut is_positive = Vec::with_capacity(complex.count());
    for (c, cell) in complex.cells().enumerate() {
        let is_finite = cell.iter().all(|&v| image(v).iter().all(|x| x.is_finite()));
        check(is_finite, rule, "the image of a vertex is not finite", &[c], cell)?;
        let sign = match *cell {
            [a, b, c] => orientation_2d(image(a), image(b), image(c)),
            [a, b, c, d] => orientation_3d(image(a), image(b), image(c), image(d)),
            _ => Ordering::Equal,
        };
        check(sign != Ordering::Equal, rule, "the image of a cell is flat", &[c], cell)?;
        is_positive.push(sign == Ordering::Greater);
    }
    complex.check_sides(rule, |_, _| true, |c| is_positive[c])?;
    check_boundary(complex, image, rule)
}

/// Boundary facets lie in sides of the box, their cells inside, and have the measure of all sides together.
fn check_boundary(complex: &Complex, image: impl Fn(u32) -> Point, rule: &'static str) -> Checked {
    let dimension = complex.size - 1;
    let mut measure = IBig::ZERO;
    for slot in complex.boundary_slots() {
        let (facet, c) = (complex.facet(slot), slot / complex.size);
        let inner = image(complex.cell(c)[slot % complex.size]);
        let points: Vec<Point> = facet.iter().map(|&v| image(v)).collect();
        let in_box = points.iter().flatten().all(|x| (0.0..=1.0).contains(x));
        let lies_in = |axis: usize, value: f64| points.iter().all(|p| p[axis] == value);
        let is_inside = |axis: usize, value: f64| if value == 0.0 { inner[axis] > 0.0 } else { inner[axis] < 1.0 };
        let side = (0..dimension).flat_map(|axis| [(axis, 0.0), (axis, 1.0)]).find(|&(axis, v)| lies_in(axis, v));
        let Some((axis, _)) = side.filter(|&(axis, value)| in_box && is_inside(axis, value)) else {
            let message = "a boundary facet does not go into a side of the box with its cell inside";
            return Err(refuted(rule, message, &[c], &facet));
        };
        measure += facet_measure(&points, axis, dimension);
    }
    // Four sides of length 1, or six squares of twice the area 2.
    let expected = if dimension == 2 { IBig::from(4) << FINEST_BITS } else { IBig::from(12) << (2 * FINEST_BITS) };
    check(measure == expected, rule, "the boundary does not run exactly once round the box", &[], &[])
}

/// The length of an edge, or twice the area of a triangle, that lies in a side; in finest units, exact.
fn facet_measure(points: &[Point], axis: usize, dimension: usize) -> IBig {
    let (x, y) = ((axis + 1) % dimension, (axis + 2) % dimension);
    let step = |i: usize, axis: usize| in_finest_units(points[i][axis]) - in_finest_units(points[0][axis]);
    match points {
        [_, _] => step(1, x).abs(),
        _ => (step(1, x) * step(2, y) - step(1, y) * step(2, x)).abs(),
    }
}
