//! Linear programs in integers, by the simplex method.
//!
//! All entries of the tableau have one denominator, the last pivot, and are integers: minors of the matrix at the start
//! (Edmonds 1967). Bland's rule picks the pivots, so that it ends.

use dashu_base::Sign;
use dashu_int::IBig;

/// A place where the sum of `x_1 ... x_count` is largest, over all `x >= 0` with `rows x <= bounds`; scaled to integers.
///
/// Each row has its bound as last entry, which must not be negative; the sum must be bounded there. `x` may have more entries
/// than `count`. Nothing if the largest sum is 0.
///
/// # Complexity
/// A pivot costs one product for each entry of the rows. Their number is small in general, and exponential in the worst case.
pub(super) fn largest_sum(count: usize, rows: Vec<Vec<i64>>) -> Option<Vec<IBig>> {
    let mut tableau = Tableau::new(count, rows);
    while let Some(column) = tableau.entering() {
        let row = tableau.leaving(column)?;
        tableau.pivot(row, column);
    }
    let place = tableau.place(count);
    place.iter().any(|x| *x != IBig::ZERO).then_some(place)
}

/// `x_basic + Σ a x_other = b`, row by row, times the denominator; the last row is that of the sum.
struct Tableau {
    rows: Vec<Vec<IBig>>,
    denominator: IBig,
    basic: Vec<usize>,
    others: Vec<usize>,
}

impl Tableau {
    fn new(count: usize, rows: Vec<Vec<i64>>) -> Self {
        let variables = rows.first().map_or(0, |row| row.len() - 1);
        debug_assert!(rows.iter().all(|row| row.len() == variables + 1 && row[variables] >= 0), "0 is allowed");
        let basic = (variables..variables + rows.len()).collect();
        let sum = (0..=variables).map(|column| if column < count { -IBig::ONE } else { IBig::ZERO }).collect();
        let mut rows: Vec<Vec<IBig>> = rows.into_iter().map(|row| row.into_iter().map(IBig::from).collect()).collect();
        rows.push(sum);
        Self { rows, denominator: IBig::ONE, basic, others: (0..variables).collect() }
    }

    /// The column of the first variable along which the sum grows.
    fn entering(&self) -> Option<usize> {
        let sum = &self.rows[self.basic.len()];
        (0..self.others.len()).filter(|&column| is_negative(&sum[column])).min_by_key(|&column| self.others[column])
    }

    /// The row that bounds the variable of a column most; of several the one of the first variable.
    fn leaving(&self, column: usize) -> Option<usize> {
        let last = self.others.len();
        let mut best: Option<usize> = None;
        for row in (0..self.basic.len()).filter(|&row| is_positive(&self.rows[row][column])) {
            best = match best {
                None => Some(row),
                Some(other) => {
                    let [here, there] =
                        [(row, other), (other, row)].map(|(a, b)| &self.rows[a][last] * &self.rows[b][column]);
                    let is_better = here.cmp(&there).then(self.basic[row].cmp(&self.basic[other])).is_lt();
                    Some(if is_better { row } else { other })
                }
            };
        }
        best
    }

    fn pivot(&mut self, row: usize, column: usize) {
        let pivot = self.rows[row][column].clone();
        let leaving = std::mem::take(&mut self.rows[row]);
        for other in self.rows.iter_mut().filter(|other| !other.is_empty()) {
            let factor = std::mem::take(&mut other[column]);
            for (entry, of_row) in other.iter_mut().zip(&leaving) {
                *entry *= &pivot;
                if factor != IBig::ZERO {
                    *entry -= &factor * of_row;
                }
                // Without a rest: it is a minor.
                *entry /= &self.denominator;
            }
            other[column] = -factor;
        }
        self.rows[row] = leaving;
        self.rows[row][column] = std::mem::replace(&mut self.denominator, pivot);
        std::mem::swap(&mut self.basic[row], &mut self.others[column]);
    }

    /// The first variables, times the denominator.
    fn place(&self, count: usize) -> Vec<IBig> {
        let last = self.others.len();
        let mut place = vec![IBig::ZERO; count];
        for (row, &variable) in self.basic.iter().enumerate().filter(|(_, variable)| **variable < count) {
            place[variable] = self.rows[row][last].clone();
        }
        place
    }
}

fn is_negative(x: &IBig) -> bool {
    x.sign() == Sign::Negative
}

fn is_positive(x: &IBig) -> bool {
    !is_negative(x) && *x != IBig::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::Random;

    /// The largest sum over all corners of the region in two unknowns, times the denominator of the place.
    fn by_corners(rows: &[Vec<i64>]) -> (i64, i64) {
        let lines: Vec<[i64; 3]> =
            rows.iter().map(|row| [row[0], row[1], row[2]]).chain([[-1, 0, 0], [0, -1, 0]]).collect();
        let mut best = (0, 1);
        for (number, a) in lines.iter().enumerate() {
            for b in &lines[..number] {
                let determinant = a[0] * b[1] - a[1] * b[0];
                let sign = determinant.signum();
                let (x, y) = (sign * (a[2] * b[1] - a[1] * b[2]), sign * (a[0] * b[2] - a[2] * b[0]));
                let is_inside = lines.iter().all(|line| line[0] * x + line[1] * y <= line[2] * determinant.abs());
                if determinant != 0 && is_inside && (x + y) * best.1 > best.0 * determinant.abs() {
                    best = (x + y, determinant.abs());
                }
            }
        }
        best
    }

    #[test]
    fn the_sum_is_that_of_the_best_corner() {
        let mut random = Random(5);
        let (mut nothing, mut something) = (0, 0);
        for _ in 0..2000 {
            let number = |random: &mut Random| random.below(11) as i64 - 4;
            let mut rows: Vec<Vec<i64>> =
                (0..3).map(|_| vec![number(&mut random), number(&mut random), random.below(3) as i64]).collect();
            rows.push(vec![1, 1, 7]);
            let best = by_corners(&rows);
            match largest_sum(2, rows.clone()) {
                None => {
                    assert_eq!(best.0, 0, "{rows:?}");
                    nothing += 1;
                }
                Some(place) => {
                    // A multiple of the best corner, or of one that is as good.
                    assert!(best.0 > 0, "{rows:?}");
                    let [x, y] = [0, 1].map(|k| i64::try_from(place[k].clone()).unwrap());
                    let scale = (x + y) as f64 * best.1 as f64 / best.0 as f64;
                    let is_allowed = rows
                        .iter()
                        .all(|row| (row[0] * x + row[1] * y) as f64 <= row[2] as f64 * scale * (1.0 + 1e-12));
                    assert!(x >= 0 && y >= 0 && is_allowed, "{rows:?} {x} {y}");
                    something += 1;
                }
            }
        }
        assert!(nothing > 100 && something > 1000, "{nothing} {something}");
    }
}
