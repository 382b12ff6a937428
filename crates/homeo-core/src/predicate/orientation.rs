//! Orientation of triangles and tetrahedra.

use super::Sign;

/// Sign of the area of the triangle `a b c`: positive when it runs counter-clockwise.
///
/// ```
/// use homeo_core::predicate::{orient2d, Sign};
/// assert_eq!(orient2d([0.0, 0.0], [1.0, 0.0], [0.0, 1.0]), Sign::Positive);
/// // 0.1 + 0.2 is not 0.3 in floating point, and the predicate sees it.
/// assert_ne!(orient2d([0.0, 0.0], [1.0, 1.0], [0.1 + 0.2, 0.3]), Sign::Zero);
/// ```
#[inline]
pub fn orient2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    let point = |p: [f64; 2]| robust::Coord { x: p[0], y: p[1] };
    Sign::of(robust::orient2d(point(a), point(b), point(c)))
}

/// Sign of the volume of the tetrahedron `a b c d`, that is of `det(b - a, c - a, d - a)`.
///
/// ```
/// use homeo_core::predicate::{orient3d, Sign};
/// let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// assert_eq!(orient3d(o, x, y, z), Sign::Positive);
/// assert_eq!(orient3d(o, y, x, z), Sign::Negative);
/// ```
#[inline]
pub fn orient3d(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> Sign {
    let point = |p: [f64; 3]| robust::Coord3D { x: p[0], y: p[1], z: p[2] };
    // `robust` follows Shewchuk: positive when d lies below the plane through a, b, c.
    Sign::of(robust::orient3d(point(a), point(b), point(c), point(d))).reversed()
}

/// Whether the triangle `a b c` in space has area zero, exactly.
///
/// Its area vector vanishes if and only if its projections on the three coordinate planes do.
pub fn is_degenerate_triangle(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> bool {
    [[0, 1], [1, 2], [2, 0]].iter().all(|&[u, v]| orient2d([a[u], a[v]], [b[u], b[v]], [c[u], c[v]]) == Sign::Zero)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn collinear_in_space_is_degenerate() {
        assert!(is_degenerate_triangle([0.0; 3], [1.0, 2.0, 3.0], [2.0, 4.0, 6.0]));
        assert!(!is_degenerate_triangle([0.0; 3], [1.0, 2.0, 3.0], [2.0, 4.0, 6.0 + 1e-15]));
    }

    #[test]
    fn coplanar_points_give_zero_and_a_nudge_does_not() {
        let plane = [[0.1, 0.2, 0.3], [1.1, 0.2, 0.3], [0.1, 1.2, 0.3], [0.7, 0.9, 0.3]];
        let [a, b, c, mut d] = plane;
        assert_eq!(orient3d(a, b, c, d), Sign::Zero);
        d[2] = d[2].next_up();
        assert_eq!(orient3d(a, b, c, d), Sign::Positive);
    }
}
