//! Small dense symmetric systems. Unknowns are edges: a few, at most some hundred.

/// The factor `L` of `A + shift I = L Lᵀ`, row by row, if that is positive definite.
pub(super) fn factor(matrix: &[f64], size: usize, shift: f64) -> Option<Vec<f64>> {
    let mut lower = matrix.to_vec();
    for row in 0..size {
        for column in 0..=row {
            let (before, here) = lower.split_at(row * size);
            let known: f64 = if row == column {
                here[..column].iter().map(|x| x * x).sum()
            } else {
                let other = &before[column * size..column * size + column];
                here[..column].iter().zip(other).map(|(x, y)| x * y).sum()
            };
            let rest = lower[row * size + column] - known;
            lower[row * size + column] = if row < column + 1 {
                let pivot = rest + shift;
                // What is left by rounding is no pivot.
                let is_definite = pivot > 4.0 * f64::EPSILON * matrix[row * size + row].abs() && pivot.is_finite();
                if !is_definite {
                    return None;
                }
                pivot.sqrt()
            } else {
                rest / lower[column * size + column]
            };
        }
    }
    Some(lower)
}

/// Solves `L Lᵀ x = b` in place.
pub(super) fn substitute(lower: &[f64], vector: &mut [f64]) {
    let size = vector.len();
    for row in 0..size {
        let known: f64 = (0..row).map(|k| lower[row * size + k] * vector[k]).sum();
        vector[row] = (vector[row] - known) / lower[row * size + row];
    }
    for row in (0..size).rev() {
        let known: f64 = (row + 1..size).map(|k| lower[k * size + row] * vector[k]).sum();
        vector[row] = (vector[row] - known) / lower[row * size + row];
    }
}

/// The inverse from the factor, row by row.
pub(super) fn inverse(lower: &[f64], size: usize) -> Vec<f64> {
    let mut inverse = vec![0.0; size * size];
    for (number, row) in inverse.chunks_exact_mut(size).enumerate() {
        row[number] = 1.0;
        substitute(lower, row);
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factor_and_inverse_undo_the_matrix() {
        let matrix = [4.0, 1.0, -2.0, 1.0, 3.0, 0.5, -2.0, 0.5, 5.0];
        let lower = factor(&matrix, 3, 0.0).unwrap();
        let inverse = inverse(&lower, 3);
        for row in 0..3 {
            for column in 0..3 {
                let product: f64 = (0..3).map(|k| matrix[3 * row + k] * inverse[3 * k + column]).sum();
                assert!((product - f64::from(u8::from(row == column))).abs() < 1e-14);
            }
        }
        assert!(factor(&[1.0, 2.0, 2.0, 1.0], 2, 0.0).is_none(), "not definite");
        assert!(factor(&[1.0, 2.0, 2.0, 1.0], 2, 2.0).is_some());
    }
}
