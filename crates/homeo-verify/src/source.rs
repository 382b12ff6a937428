//! Rules S1 to S4 and 8: the source is a complex of non-degenerate cells and, topologically, a ball candidate.

use crate::complex::{Complex, Rules};
use crate::links::{Shape, check_manifold, shape};
use crate::map_file::MapFile;
use crate::number::{is_flat_triangle, orientation_3d};
use crate::verdict::{Checked, refuted};
use std::cmp::Ordering;

/// Checks everything about the source mesh alone and returns it with its neighbours.
pub(crate) fn check_source(map: &MapFile) -> Checked<Complex> {
    // S1: coordinates are finite.
    if let Some(v) = map.positions.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
        return refuted("S1", format!("vertex {v} has a coordinate that is not finite"), &[], &[v as u32]);
    }
    // S2: indices; and the first part of 8, facets with at most two cells.
    let rules = Rules { cells: "S2", facets: "8" };
    let source = Complex::new(map.cell_size(), map.cells.clone(), map.positions.len(), rules)?;
    check_geometry(map, &source)?;
    check_topology(&source)?;
    Ok(source)
}

fn check_geometry(map: &MapFile, source: &Complex) -> Checked {
    for c in 0..source.count() {
        let cell = source.cell(c);
        let at = |i: usize| map.positions[cell[i] as usize];
        // S3: positive orientation (n = 3), area other than zero (n = 2).
        if source.size == 4 && orientation_3d(at(0), at(1), at(2), at(3)) != Ordering::Greater {
            return refuted("S3", format!("cell {c} is not positively oriented"), &[c], cell);
        }
        if source.size == 3 && is_flat_triangle(at(0), at(1), at(2)) {
            return refuted("S3", format!("cell {c} has area zero"), &[c], cell);
        }
    }
    // S4: tetrahedra that share a facet lie on opposite sides of it.
    for (a, b) in source.inner_facets().take_while(|_| source.size == 4) {
        if source.induces_sorted_order(a) == source.induces_sorted_order(b) {
            let message = "two cells lie on the same side of their common facet";
            return refuted("S4", message, &[a / 4, b / 4], &source.facet(a).0);
        }
    }
    Ok(())
}

/// Rule 8 for the source itself: links, connected, Euler number 1, boundary connected and for n = 3 a sphere.
fn check_topology(source: &Complex) -> Checked {
    let found = check_manifold(source, "8", "source")?;
    let expected = Shape { components: 1, euler: 1, boundaries: 1 };
    if found != expected {
        let message = format!("the source is not a ball: it has {found:?} instead of {expected:?}");
        return refuted("8", message, &[], &[]);
    }
    if source.size == 4 {
        let boundary = source.facet_complex(source.boundary_slots(), "8")?;
        let euler = shape(&boundary, 0, "8")?.euler;
        if euler != 2 {
            return refuted("8", format!("the boundary of the source has Euler number {euler}, not 2"), &[], &[]);
        }
    }
    Ok(())
}
