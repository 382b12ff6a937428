//! The diagonal form of a matrix of integers of any size.

use dashu_base::{Abs, UnsignedAbs};
use dashu_int::{IBig, UBig};

/// The entries of a diagonal form, none of them zero; they need not divide one another. Rows and columns are added to
/// one another, which changes the basis of relations and generators and not the group.
///
/// The pivot is always an entry of least size, and rows and columns are reduced by it until it is alone: a remainder
/// that is not zero is smaller, and becomes the pivot.
pub(super) fn diagonal(mut rows: Vec<Vec<IBig>>) -> Vec<UBig> {
    let mut diagonal = Vec::new();
    while let Some((row, column)) = least(&rows) {
        if is_alone(&mut rows, row, column) {
            let pivot_row = rows.swap_remove(row);
            diagonal.push(pivot_row[column].clone().unsigned_abs());
            rows.iter_mut().for_each(|other| drop(other.swap_remove(column)));
            rows.retain(|other| other.iter().any(|entry| !entry.is_zero()));
        }
    }
    diagonal
}

/// The place of an entry of least size that is not zero.
fn least(rows: &[Vec<IBig>]) -> Option<(usize, usize)> {
    let places = rows.iter().enumerate().flat_map(|(i, row)| (0..row.len()).map(move |j| (i, j)));
    let nonzero = places.filter(|&(i, j)| !rows[i][j].is_zero());
    nonzero.min_by(|&(i, j), &(k, l)| (&rows[i][j]).abs().cmp(&(&rows[k][l]).abs()))
}

/// Reduces the row and the column of an entry by it; whether all else in them is zero then.
fn is_alone(rows: &mut [Vec<IBig>], row: usize, column: usize) -> bool {
    let pivot_row = rows[row].clone();
    let pivot = &pivot_row[column];
    let mut is_alone = true;
    for (number, other) in rows.iter_mut().enumerate() {
        if number == row || other[column].is_zero() {
            continue;
        }
        let quotient = &other[column] / pivot;
        for (entry, subtracted) in other.iter_mut().zip(&pivot_row) {
            *entry -= &quotient * subtracted;
        }
        is_alone &= other[column].is_zero();
    }
    if !is_alone {
        return false;
    }
    // The rest of the column is zero: a multiple of it changes nothing but the pivot's row.
    for (number, entry) in rows[row].iter_mut().enumerate() {
        if number != column {
            *entry %= pivot;
            is_alone &= entry.is_zero();
        }
    }
    is_alone
}
