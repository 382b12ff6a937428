//! How directions cross triangles, and whether solids and triangles have an area in common.

use dashu_int::IBig;

use super::{Sign, orient3d};
use crate::number::Rational;

type Point = [f64; 3];

/// The sign of `n . (to - from)` where `n` is the normal of the triangle `a b c` by the order of its corners.
///
/// ```
/// use homeo_core::predicate::{Sign, crossing_sign};
/// let floor = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// assert_eq!(crossing_sign(floor, [[5.0, 5.0, 7.0], [9.0, 9.0, 8.0]]), Sign::Positive);
/// assert_eq!(crossing_sign(floor, [[5.0, 5.0, 7.0], [9.0, 9.0, 7.0]]), Sign::Zero);
/// ```
pub fn crossing_sign(triangle: [Point; 3], segment: [Point; 2]) -> Sign {
    let [a, b, c] = triangle;
    quick_crossing_sign(triangle, segment).unwrap_or_else(|| exact_sign([[a, b], [a, c], segment]))
}

/// The same where floating point can tell; `None` where only exact arithmetic can, as always for zero.
///
/// ```
/// use homeo_core::predicate::{Sign, quick_crossing_sign};
/// let floor = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// assert_eq!(quick_crossing_sign(floor, [[5.0, 5.0, 7.0], [9.0, 9.0, 8.0]]), Some(Sign::Positive));
/// assert_eq!(quick_crossing_sign(floor, [[5.0, 5.0, 7.0], [9.0, 9.0, 7.0]]), None);
/// ```
pub fn quick_crossing_sign([a, b, c]: [Point; 3], [from, to]: [Point; 2]) -> Option<Sign> {
    let step = |p: Point, q: Point| [0, 1, 2].map(|axis| q[axis] - p[axis]);
    let (u, v, w) = (step(a, b), step(a, c), step(from, to));
    let [terms, size] = determinant_and_size(u, v, w);
    // Each difference has half an ulp of relative error, each product of three another two, the sum of six five:
    // together less than 8 ulps of the sum of the absolute values.
    (terms.abs() > 8.0 * f64::EPSILON * size && size > 1e-250 && size < 1e250).then(|| Sign::of(terms))
}

/// The determinant in floating point, and the sum of the absolute values of its terms.
fn determinant_and_size(u: Point, v: Point, w: Point) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for (x, y, z) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let (p, q) = (u[x] * v[y] * w[z], u[x] * v[z] * w[y]);
        sum = [sum[0] + (p - q), sum[1] + (p.abs() + q.abs())];
    }
    sum
}

#[cold]
fn exact_sign(steps: [[Point; 2]; 3]) -> Sign {
    // Values that are not finite have no sign.
    let exact = |x: f64| Rational::from_f64(x).unwrap_or(Rational::ZERO);
    let rows = steps.map(|[p, q]| [0, 1, 2].map(|axis| &exact(q[axis]) - &exact(p[axis])));
    let minor = |y: usize, z: usize| &(&rows[1][y] * &rows[2][z]) - &(&rows[1][z] * &rows[2][y]);
    let terms = [(0, 1, 2), (1, 2, 0), (2, 0, 1)].map(|(x, y, z)| &rows[0][x] * &minor(y, z));
    match terms.into_iter().sum::<Rational>().numerator().cmp(&IBig::ZERO) {
        std::cmp::Ordering::Less => Sign::Negative,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Greater => Sign::Positive,
    }
}

/// Whether a tetrahedron and a triangle have a common part with an area.
///
/// # Preconditions
/// The tetrahedron has a volume and the triangle an area.
///
/// They have none if and only if a plane through three of the seven corners has the tetrahedron on one closed side and the
/// triangle on the other. A plane that holds the whole triangle and a face of the tetrahedron does not count: there they
/// may share an area.
///
/// # Complexity
/// Up to 35 planes of 4 signs each; the faces of the tetrahedron come first and mostly decide.
///
/// ```
/// use homeo_core::predicate::share_area;
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let slab = |z: f64| [[-9.0, -9.0, z], [9.0, -9.0, z], [0.0, 9.0, z]];
/// assert!(share_area(corners, slab(0.5)) && share_area(corners, slab(0.0)));
/// assert!(!share_area(corners, slab(1.0)), "they touch in a point");
/// ```
pub fn share_area(tetrahedron: [Point; 4], triangle: [Point; 3]) -> bool {
    let points: [Point; 7] = std::array::from_fn(|i| if i < 4 { tetrahedron[i] } else { triangle[i - 4] });
    // Faces of the tetrahedron first.
    let faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
    let others = (0..7usize).flat_map(|k| (0..k).flat_map(move |j| (0..j).map(move |i| [i, j, k])));
    let others = others.filter(|triple| triple[2] >= 4);
    !faces.into_iter().chain(others).any(|triple| separates(&points, triple))
}

/// Whether the plane through three of the points has the first four of them on one closed side and the others on the
/// other, without holding a face of the tetrahedron and the triangle both.
fn separates(points: &[Point; 7], triple: [usize; 3]) -> bool {
    let [a, b, c] = triple.map(|i| points[i]);
    let mut seen = [[false; 3]; 2]; // by body: whether there are corners below, in and above the plane
    let mut held = [0; 2];
    for (i, &point) in points.iter().enumerate() {
        // Corners of the plane, and corners of the other body at the same points: the predicate is slowest for zero.
        let sign = if [a, b, c].contains(&point) { Sign::Zero } else { orient3d(a, b, c, point) };
        let body = usize::from(i >= 4);
        seen[body][sign as usize] = true;
        held[body] += usize::from(sign == Sign::Zero);
        if (seen[0][0] || seen[1][2]) && (seen[0][2] || seen[1][0]) {
            return false;
        }
    }
    // A plane in which everything lies is no plane: its three points are collinear.
    let is_plane = held[0] < 4;
    is_plane && !(held[0] == 3 && held[1] == 3)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area in common by clipping the triangle with the tetrahedron's faces, in rationals.
    fn has_area_by_clipping(tetrahedron: [Point; 4], triangle: [Point; 3]) -> bool {
        type Exact = [Rational; 3];
        let exact = |p: Point| p.map(|x| Rational::from_f64(x).unwrap());
        let corners = tetrahedron.map(exact);
        let minus = |p: &Exact, q: &Exact| [0, 1, 2].map(|i| &p[i] - &q[i]);
        let cross = |u: &Exact, v: &Exact| [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &(&u[i] * &v[j]) - &(&u[j] * &v[i]));
        let dot = |u: &Exact, v: &Exact| (0..3).map(|i| &u[i] * &v[i]).sum::<Rational>();
        let mut polygon: Vec<Exact> = triangle.map(exact).to_vec();
        for i in 0..4 {
            let face: Vec<&Exact> = (0..4).filter(|&j| j != i).map(|j| &corners[j]).collect();
            let normal = cross(&minus(face[1], face[0]), &minus(face[2], face[0]));
            let inside = dot(&normal, &minus(&corners[i], face[0]));
            let height = |p: &Exact| {
                let h = dot(&normal, &minus(p, face[0]));
                if inside < Rational::ZERO { &Rational::ZERO - &h } else { h }
            };
            let mut clipped = Vec::new();
            for (k, p) in polygon.iter().enumerate() {
                let q = &polygon[(k + 1) % polygon.len()];
                let (h, g) = (height(p), height(q));
                if h >= Rational::ZERO {
                    clipped.push(p.clone());
                }
                if (h < Rational::ZERO && g > Rational::ZERO) || (h > Rational::ZERO && g < Rational::ZERO) {
                    let t = &h / &(&h - &g);
                    clipped.push([0, 1, 2].map(|i| &p[i] + &(&t * &(&q[i] - &p[i]))));
                }
            }
            polygon = clipped;
        }
        (2..polygon.len()).any(|k| {
            let area = cross(&minus(&polygon[k - 1], &polygon[0]), &minus(&polygon[k], &polygon[0]));
            area.iter().any(|x| !x.is_zero())
        })
    }

    #[test]
    fn common_area_agrees_with_clipping() {
        let mut state = 11u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % 4) as f64
        };
        let (mut with, mut without) = (0, 0);
        while with < 400 || without < 400 {
            let mut point = || [next(), next(), next()];
            let (tetrahedron, triangle) = ([point(), point(), point(), point()], [point(), point(), point()]);
            let [a, b, c, d] = tetrahedron;
            let [u, v, w] = triangle;
            if orient3d(a, b, c, d) == Sign::Zero || super::super::is_degenerate_triangle(u, v, w) {
                continue;
            }
            let expected = has_area_by_clipping(tetrahedron, triangle);
            assert_eq!(share_area(tetrahedron, triangle), expected, "{tetrahedron:?} {triangle:?}");
            *if expected { &mut with } else { &mut without } += 1;
        }
    }

    #[test]
    fn crossings_are_exact() {
        let triangle = [[0.1, 0.2, 0.3], [1.1, 0.2, 0.3], [0.1, 1.2, 0.3]];
        let from = [0.7, 0.9, 0.1];
        let to = |z: f64| [5.0, 6.0, z];
        assert_eq!(crossing_sign(triangle, [from, to(0.1)]), Sign::Zero);
        assert_eq!(crossing_sign(triangle, [from, to(0.1f64.next_up())]), Sign::Positive);
        assert_eq!(crossing_sign(triangle, [from, to(0.1f64.next_down())]), Sign::Negative);
    }
}
