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
use std::ops::{Add, Mul, Sub};

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
        let sum_is_one = match sum_in_machine_numbers(&volumes) {
            Some(sum) => sum == (1, 1),
            None => sum_is_one(&volumes)?,
        };
        if !sum_is_one {
            let message = format!("the cells in source cell {parent} do not have its volume together");
            let own: Vec<usize> = own.iter().map(|&c| c as usize).collect();
            return refuted("R4", message, &own, source.cell(parent));
        }
    }
    Ok(())
}

/// A positive fraction: a determinant over the product of weight sums.
enum Volume {
    Small(i128, i128),
    Large(IBig, UBig),
}

/// The volume of a cell in units of its parent's.
fn volume(map: &MapFile, refinement: &Refinement, parent: &[u32], cell: &[u32], c: usize) -> Checked<Volume> {
    let size = cell.len();
    let mut weights = [[0i64; 4]; 4];
    for (row, &vertex) in weights.iter_mut().zip(cell) {
        for (source_vertex, weight) in carrier(map, refinement, vertex) {
            // R2: every vertex of the cell lies in the parent.
            match parent.iter().position(|&v| v == source_vertex) {
                Some(column) => row[column] = weight,
                None => return refuted("R2", format!("cell {c} does not lie in its parent"), &[c], &[vertex]),
            }
        }
    }
    let small = weights.iter().flatten().all(|&weight| weight < 1 << 28);
    let volume = if small {
        let rows = weights.map(|row| row.map(i128::from));
        Volume::Small(determinant(&rows, size), rows[..size].iter().map(|row| row.iter().sum::<i128>()).product())
    } else {
        let rows = weights.map(|row| row.map(IBig::from));
        let denominator: IBig = rows[..size].iter().map(|row| row.iter().sum::<IBig>()).product();
        Volume::Large(determinant(&rows, size), UBig::try_from(denominator).unwrap_or(UBig::ONE))
    };
    // R3: the cell has the orientation of its parent.
    let positive = match &volume {
        Volume::Small(determinant, _) => *determinant > 0,
        Volume::Large(determinant, _) => *determinant > IBig::ZERO,
    };
    if positive { Ok(volume) } else { refuted("R3", format!("cell {c} is flat or turned over"), &[c], cell) }
}

/// The determinant of the upper left `size` by `size` block, by its first row.
fn determinant<T>(m: &[[T; 4]; 4], size: usize) -> T
where
    T: Clone + Add<Output = T> + Sub<Output = T> + Mul<Output = T>,
{
    let two =
        |r: usize, a: usize, b: usize| m[r][a].clone() * m[r + 1][b].clone() - m[r][b].clone() * m[r + 1][a].clone();
    let three = |r: usize, a: usize, b: usize, c: usize| {
        m[r][a].clone() * two(r + 1, b, c) - m[r][b].clone() * two(r + 1, a, c) + m[r][c].clone() * two(r + 1, a, b)
    };
    if size == 3 {
        return three(0, 0, 1, 2);
    }
    m[0][0].clone() * three(1, 1, 2, 3) - m[0][1].clone() * three(1, 0, 2, 3) + m[0][2].clone() * three(1, 0, 1, 3)
        - m[0][3].clone() * three(1, 0, 1, 2)
}

/// The sum in lowest terms, when nothing overflows.
fn sum_in_machine_numbers(volumes: &[Volume]) -> Option<(i128, i128)> {
    let mut sum = (0i128, 1i128);
    for volume in volumes {
        let Volume::Small(numerator, denominator) = volume else { return None };
        if sum.1 != *denominator {
            let left = sum.0.checked_mul(*denominator)?;
            sum = (left.checked_add(numerator.checked_mul(sum.1)?)?, sum.1.checked_mul(*denominator)?);
        } else {
            sum.0 = sum.0.checked_add(*numerator)?;
        }
        let divisor = greatest_common_divisor(sum.0, sum.1);
        sum = (sum.0 / divisor, sum.1 / divisor);
    }
    Some(sum)
}

fn greatest_common_divisor(mut a: i128, mut b: i128) -> i128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// The same with numbers of any length.
fn sum_is_one(volumes: &[Volume]) -> Checked<bool> {
    let mut sum = RBig::ZERO;
    for volume in volumes {
        sum += match volume {
            Volume::Small(numerator, denominator) => {
                RBig::from_parts(IBig::from(*numerator), UBig::try_from(*denominator).unwrap_or(UBig::ONE))
            }
            Volume::Large(numerator, denominator) => RBig::from_parts(numerator.clone(), denominator.clone()),
        };
        if sum.denominator().bit_len() > MAXIMUM_DENOMINATOR_BITS {
            return undecided(
                "the volumes in one source cell have a common denominator of more than 4096 bits",
                "place added vertices with fewer different weight sums, for instance powers of two",
            );
        }
    }
    Ok(sum == RBig::ONE)
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
