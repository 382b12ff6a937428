//! Rules S1 to S4 and 8: the source is a complex of non-degenerate cells and, topologically, a ball candidate.

use crate::complex::Complex;
use crate::links::{Shape, check_manifold, shape};
use crate::map_file::MapFile;
use crate::number::{Point, is_flat_triangle, orientation_3d};
use crate::verdict::{Checked, check};
use std::cmp::Ordering;

/// Checks everything about the source mesh alone and returns it with its neighbours.
pub(crate) fn check_source(map: &MapFile) -> Checked<Complex> {
    check_finite(&map.positions)?;
    // S2: indices; and the first part of 8, facets with at most two cells.
    let size = map.manifest.cell_size();
    let source = Complex::new(size, map.cells.clone(), map.positions.len(), ["S2", "8"])?;
    // S3: positive orientation (n = 3), area other than zero (n = 2).
    for (c, cell) in source.cells().enumerate() {
        let at = |i: usize| map.positions[cell[i] as usize];
        if size == 4 {
            let is_positive = orientation_3d(at(0), at(1), at(2), at(3)) == Ordering::Greater;
            check(is_positive, "S3", "a cell is not positively oriented", &[c], cell)?;
        } else {
            check(!is_flat_triangle(at(0), at(1), at(2)), "S3", "a cell has area zero", &[c], cell)?;
        }
    }
    // S4: tetrahedra that share a facet lie on opposite sides of it.
    source.check_sides("S4", |_, _| size == 4, |_| true)?;
    // 8: links, connected, Euler number 1, boundary connected and for n = 3 a sphere.
    let found = check_manifold(&source, "source", "8")?;
    let expected = Shape { components: 1, euler: 1, boundaries: 1 };
    let message = format!("the source is not a ball: it has {found:?} instead of {expected:?}");
    check(found == expected, "8", &message, &[], &[])?;
    if size == 4 {
        let euler = shape(&source.facet_complex(source.boundary_slots())?, 0)?.euler;
        check(euler == 2, "8", "the boundary of the source does not have Euler number 2", &[], &[])?;
    }
    Ok(source)
}

/// S1: coordinates are finite.
pub(crate) fn check_finite(points: &[Point]) -> Checked {
    for (v, point) in (0..).zip(points) {
        check(point.iter().all(|x| x.is_finite()), "S1", "a vertex has a coordinate that is not finite", &[], &[v])?;
    }
    Ok(())
}
