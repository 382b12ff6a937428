//! Rules R1 to R6: the refined complex is a subdivision of the source.
//!
//! *Theorem.* Let the source be a manifold by its links. Then the map that sends each refined cell linearly into its
//! parent is a homeomorphism of the complexes (proof in `docs/certificate-format-v1.md`): crossing an inner facet does not
//! change the number of cells over a point (R5, R6), and this number has mean 1 (R3, R4).

use crate::complex::{Complex, Rules};
use crate::map_file::{MapFile, Refinement};
use crate::verdict::{Checked, refuted, undecided};
use dashu_base::BitTest;
use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;
use std::collections::BTreeSet;

/// Sums of volumes with longer denominators than this are not attempted.
const MAXIMUM_DENOMINATOR_BITS: usize = 4096;

/// Checks the refinement and returns the refined complex with its neighbours.
pub(crate) fn check_subdivision(map: &MapFile, refinement: &Refinement, source: &Complex) -> Checked<Complex> {
    check_carriers(map, refinement)?;
    let vertex_count = map.vertex_count();
    let rules = Rules { cells: "R2", facets: "2" };
    let refined = Complex::new(source.size, refinement.cells.clone(), vertex_count, rules)?;
    check_volumes(map, refinement, source, &refined)?;
    check_facets(map, refinement, source, &refined)?;
    Ok(refined)
}

/// R1: weights are not negative, not all zero, and belong to different source vertices.
fn check_carriers(map: &MapFile, refinement: &Refinement) -> Checked {
    let size = map.cell_size();
    let rows = refinement.carrier_vertices.chunks_exact(size).zip(refinement.carrier_weights.chunks_exact(size));
    for (row, (vertices, weights)) in rows.enumerate() {
        let present = |i: &usize| weights[*i] > 0;
        let repeated = (0..size).filter(present).any(|i| (0..i).filter(present).any(|j| vertices[i] == vertices[j]));
        let outside = vertices.iter().any(|&v| v as usize >= map.positions.len());
        if weights.iter().any(|&w| w < 0) || !(0..size).any(|i| present(&i)) || repeated || outside {
            let vertex = (map.positions.len() + row) as u32;
            return refuted("R1", format!("added vertex {vertex} has no valid carrier (row {row})"), &[], &[vertex]);
        }
    }
    Ok(())
}

/// The source vertices that carry a vertex, with their weights.
fn carrier<'a>(map: &MapFile, refinement: &'a Refinement, vertex: u32) -> impl Iterator<Item = (u32, i64)> + 'a {
    let itself = ((vertex as usize) < map.positions.len()).then_some((vertex, 1));
    let size = map.cell_size();
    let start = (vertex as usize).checked_sub(map.positions.len()).map_or(usize::MAX, |row| row * size);
    let vertices = refinement.carrier_vertices.iter().skip(start).take(size);
    let weights = refinement.carrier_weights.iter().skip(start);
    itself.into_iter().chain(vertices.copied().zip(weights.copied()).filter(|&(_, weight)| weight > 0))
}

/// R2 to R4, parent by parent.
fn check_volumes(map: &MapFile, refinement: &Refinement, source: &Complex, refined: &Complex) -> Checked {
    if let Some(c) = refinement.parents.iter().position(|&parent| parent as usize >= source.count()) {
        return refuted("R2", format!("cell {c} has a parent that does not exist"), &[c], refined.cell(c));
    }
    let mut children: Vec<u32> = (0..refined.count() as u32).collect();
    children.sort_by_key(|&c| refinement.parents[c as usize]);
    let mut rest = children.as_slice();
    for parent in 0..source.count() {
        let count = rest.iter().take_while(|&&c| refinement.parents[c as usize] as usize == parent).count();
        let (own, later) = rest.split_at(count);
        rest = later;
        let mut volumes = Vec::with_capacity(count);
        for &c in own {
            volumes.push(volume(map, refinement, source.cell(parent), refined.cell(c as usize), c as usize)?);
        }
        // R4: the children's volumes, in units of the parent's, add up to exactly 1.
        if sum(&volumes)? != RBig::ONE {
            let message = format!("the cells in source cell {parent} do not have its volume together");
            let own: Vec<usize> = own.iter().map(|&c| c as usize).collect();
            return refuted("R4", message, &own, source.cell(parent));
        }
    }
    Ok(())
}

/// The volume of a cell in units of its parent's: a determinant over the product of weight sums.
fn volume(map: &MapFile, refinement: &Refinement, parent: &[u32], cell: &[u32], c: usize) -> Checked<RBig> {
    if cell == parent {
        return Ok(RBig::ONE); // a cell that was not divided
    }
    let mut weights: [[IBig; 4]; 4] = Default::default();
    let mut product = UBig::ONE;
    for (row, &vertex) in weights.iter_mut().zip(cell) {
        let mut total = 0u128;
        for (source_vertex, weight) in carrier(map, refinement, vertex) {
            // R2: every vertex of the cell lies in the parent.
            match parent.iter().position(|&v| v == source_vertex) {
                Some(column) => row[column] = IBig::from(weight),
                None => return refuted("R2", format!("cell {c} does not lie in its parent"), &[c], &[vertex]),
            }
            total += u128::from(weight.unsigned_abs());
        }
        product *= UBig::from(total);
    }
    // R3: the cell has the orientation of its parent.
    let determinant = determinant(&weights, 0, &[0, 1, 2, 3][..cell.len()]);
    if determinant <= IBig::ZERO || product == UBig::ZERO {
        return refuted("R3", format!("cell {c} is flat or turned over"), &[c], cell);
    }
    Ok(RBig::from_parts(determinant, product))
}

/// The determinant of the rows from `row` on and of these columns, by its first row; most entries are zero.
fn determinant(matrix: &[[IBig; 4]; 4], row: usize, columns: &[usize]) -> IBig {
    let mut sum = IBig::ZERO;
    for (k, &column) in columns.iter().enumerate().filter(|&(_, &column)| matrix[row][column] != IBig::ZERO) {
        let others: Vec<usize> = columns.iter().copied().filter(|&other| other != column).collect();
        let term =
            &matrix[row][column] * if others.is_empty() { IBig::ONE } else { determinant(matrix, row + 1, &others) };
        sum += if k % 2 == 0 { term } else { -term };
    }
    sum
}

/// The sum of fractions, unless their common denominator grows too long.
fn sum(volumes: &[RBig]) -> Checked<RBig> {
    let mut sum = RBig::ZERO;
    for volume in volumes {
        sum += volume;
        if sum.denominator().bit_len() > MAXIMUM_DENOMINATOR_BITS {
            return undecided(
                "the volumes in one source cell have a common denominator of more than 4096 bits",
                "place added vertices with fewer different weight sums, for instance powers of two",
            );
        }
    }
    Ok(sum)
}

/// R5 and R6: facets have a cell on either side, or lie in the boundary of the source.
fn check_facets(map: &MapFile, refinement: &Refinement, source: &Complex, refined: &Complex) -> Checked {
    let size = refined.size;
    for (a, b) in refined.inner_facets() {
        let (c, d) = (a / size, b / size);
        // R5: cells in one parent lie on opposite sides of their common facet.
        if refinement.parents[c] == refinement.parents[d]
            && refined.induces_sorted_order(a) == refined.induces_sorted_order(b)
        {
            let message = format!("cells {c} and {d} lie on the same side of their common facet");
            return refuted("R5", message, &[c, d], &refined.facet(a).0[..size - 1]);
        }
    }
    for slot in refined.boundary_slots() {
        let (facet, length) = refined.facet(slot);
        let carriers = facet[..length].iter().flat_map(|&v| carrier(map, refinement, v));
        let support: BTreeSet<u32> = carriers.map(|(vertex, _)| vertex).collect();
        // R6: a facet with one cell lies in a facet of its parent that is a boundary facet of the source.
        let parent = refinement.parents[slot / size] as usize;
        let inside = |i: usize| source.beyond(parent, i).is_none() && !support.contains(&source.cell(parent)[i]);
        if !(0..size).any(inside) {
            let message = "a facet inside the source has one cell only";
            return refuted("R6", message, &[slot / size], &facet[..length]);
        }
    }
    Ok(())
}
