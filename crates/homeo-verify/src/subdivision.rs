//! Rules R1 to R6: the refined complex is a subdivision of the source.
//!
//! *Theorem.* Let the source be a manifold by its links. Then the map that sends each refined cell linearly into its
//! parent is a homeomorphism of the complexes (proof in `docs/certificate-format-v1.md`): crossing an inner facet does
//! not change the number of cells over a point (R5, R6), and this number has mean 1 (R3, R4).

use crate::complex::Complex;
use crate::map_file::{MapFile, Refinement};
use crate::verdict::{Checked, check, decidable, refuted};
use dashu_base::BitTest;
use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

/// Checks the refinement and returns the refined complex with its neighbours.
pub(crate) fn check_subdivision(map: &MapFile, refinement: &Refinement, source: &Complex) -> Checked<Complex> {
    check_carriers(map, refinement)?;
    let refined = Complex::new(source.size, refinement.cells.clone(), map.vertex_count(), ["R2", "2"])?;
    check_volumes(map, &refinement.parents, source, &refined)?;
    check_facets(map, &refinement.parents, source, &refined)?;
    Ok(refined)
}

/// R1: weights are not negative, not all zero, and belong to different source vertices.
fn check_carriers(map: &MapFile, refinement: &Refinement) -> Checked {
    for (row, carrier) in refinement.carriers.iter().enumerate() {
        let is_possible = carrier.iter().all(|&(v, weight)| (v as usize) < map.positions.len() && weight >= 0);
        let vertex = (map.positions.len() + row) as u32;
        let present: Vec<u32> = map.carrier(vertex).map(|(v, _)| v).collect();
        let is_repeated = (0..present.len()).any(|i| present[..i].contains(&present[i]));
        let is_valid = is_possible && !present.is_empty() && !is_repeated;
        check(is_valid, "R1", "an added vertex has no valid carrier", &[], &[vertex])?;
    }
    Ok(())
}

/// R2 to R4, parent by parent.
fn check_volumes(map: &MapFile, parents: &[u32], source: &Complex, refined: &Complex) -> Checked {
    for (c, &parent) in parents.iter().enumerate() {
        let exists = (parent as usize) < source.count();
        check(exists, "R2", "a cell has a parent that does not exist", &[c], refined.cell(c))?;
    }
    let mut children: Vec<usize> = (0..refined.count()).collect();
    children.sort_by_key(|&c| parents[c]);
    let mut rest = children.as_slice();
    for parent in 0..source.count() {
        let (own, later) = rest.split_at(rest.partition_point(|&c| parents[c] as usize <= parent));
        rest = later;
        let volumes = own.iter().map(|&c| volume(map, source.cell(parent), refined.cell(c), c));
        // R4: the children's volumes, in units of the parent's, add up to exactly 1.
        let mut sum = RBig::ZERO;
        for volume in volumes.collect::<Checked<Vec<RBig>>>()? {
            sum += volume;
            let is_short = sum.denominator().bit_len() <= 4096;
            let message = "the volumes in one source cell have a common denominator of more than 4096 bits";
            let remedy = "place added vertices with fewer different weight sums, for instance powers of two";
            decidable(is_short, message, remedy)?;
        }
        let message = "the cells in a source cell do not have its volume together";
        check(sum == RBig::ONE, "R4", message, own, source.cell(parent))?;
    }
    Ok(())
}

/// The volume of a cell in units of its parent's: a determinant over the product of weight sums.
fn volume(map: &MapFile, parent: &[u32], cell: &[u32], c: usize) -> Checked<RBig> {
    if cell == parent {
        return Ok(RBig::ONE); // a cell that was not divided
    }
    let mut weights: [[IBig; 4]; 4] = Default::default();
    let mut product = UBig::ONE;
    for (row, &vertex) in weights.iter_mut().zip(cell) {
        let mut total = 0u128;
        for (source_vertex, weight) in map.carrier(vertex) {
            // R2: every vertex of the cell lies in the parent.
            match parent.iter().position(|&v| v == source_vertex) {
                Some(column) => row[column] = IBig::from(weight),
                None => return Err(refuted("R2", "a cell does not lie in its parent", &[c], &[vertex])),
            }
            total += u128::from(weight.unsigned_abs());
        }
        product *= UBig::from(total);
    }
    // R3: the cell has the orientation of its parent.
    let determinant = determinant(&weights, 0, &[0, 1, 2, 3][..cell.len()]);
    let is_positive = determinant > IBig::ZERO && product > UBig::ZERO;
    check(is_positive, "R3", "a cell is flat or turned over", &[c], cell)?;
    Ok(RBig::from_parts(determinant, product))
}

/// The determinant of the rows from `row` on and of these columns, by its first row; most entries are zero.
fn determinant(matrix: &[[IBig; 4]; 4], row: usize, columns: &[usize]) -> IBig {
    if columns.is_empty() {
        return IBig::ONE;
    }
    let mut sum = IBig::ZERO;
    for (k, &column) in columns.iter().enumerate().filter(|&(_, &column)| matrix[row][column] != IBig::ZERO) {
        let others: Vec<usize> = columns.iter().copied().filter(|&other| other != column).collect();
        let term = &matrix[row][column] * determinant(matrix, row + 1, &others);
        sum += if k % 2 == 0 { term } else { -term };
    }
    sum
}

/// R5 and R6: facets have a cell on either side, or lie in the boundary of the source.
fn check_facets(map: &MapFile, parents: &[u32], source: &Complex, refined: &Complex) -> Checked {
    // R5: cells in one parent lie on opposite sides of their common facet.
    refined.check_sides("R5", |c, d| parents[c] == parents[d], |_| true)?;
    let size = refined.size;
    for slot in refined.boundary_slots() {
        // R6: a facet with one cell lies in a facet of its parent that is a boundary facet of the source.
        let (facet, parent) = (refined.facet(slot), parents[slot / size] as usize);
        let carriers: Vec<u32> = facet.iter().flat_map(|&v| map.carrier(v)).map(|(v, _)| v).collect();
        let mut in_boundary = source.slots(parent).filter(|&slot| source.across(slot).is_none());
        let lies_in_one = in_boundary.any(|slot| !carriers.contains(&source.cell(parent)[slot % size]));
        check(lies_in_one, "R6", "a facet inside the source has one cell only", &[slot / size], &facet)?;
    }
    Ok(())
}
