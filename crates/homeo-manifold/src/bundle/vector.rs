//! Vectors in space.

pub(super) type Vector = [f64; 3];

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

pub(super) fn plus(a: Vector, b: Vector, factor: f64) -> Vector {
    [0, 1, 2].map(|k| a[k] + factor * b[k])
}

/// Vectors times one power of two, so that the largest part of them is near 1: products neither overflow nor vanish, and
/// directions stay what they are.
pub(super) fn near_one(vectors: &[Vector]) -> Vec<Vector> {
    let largest = vectors.as_flattened().iter().filter(|x| x.is_finite()).fold(0.0_f64, |most, x| most.max(x.abs()));
    if largest == 0.0 {
        return vectors.to_vec();
    }
    let exponent = largest.log2().round() as i32;
    // Beyond 2^1023 there is no power of two: in two steps.
    let [first, second] = [exponent / 2, exponent - exponent / 2].map(|part| 2_f64.powi(-part));
    vectors.iter().map(|vector| vector.map(|x| x * first * second)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_of_every_size_come_near_one_and_keep_their_directions() {
        for size in [5e-324, f64::MIN_POSITIVE / 4.0, 1e-200, 0.1, 1.0, 3.0, 1e200, f64::MAX] {
            let [scaled] = near_one(&[[size, -size, 0.5 * size]])[..] else { panic!("one vector") };
            assert!(scaled[0] == -scaled[1] && (0.6..1.6).contains(&scaled[0]), "{size:e}: {scaled:?}");
            // Half of the least number there is is none.
            assert_eq!(scaled[2], if size == 5e-324 { 0.0 } else { 0.5 * scaled[0] }, "{size:e}");
        }
        assert_eq!(near_one(&[[0.0; 3]]), [[0.0; 3]]);
        assert!(near_one(&[[f64::INFINITY, 1.0, 0.0]])[0][0].is_infinite());
    }
}
