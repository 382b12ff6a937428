//! Convex polygons cut by half-spaces, with rational numbers: what triangles, segments and tetrahedra have in common.

use dashu_ratio::RBig;

pub type Rational = [RBig; 3];

pub fn rational(point: [f64; 3]) -> Rational {
    point.map(|x| RBig::try_from(x).expect("a finite number"))
}

pub fn minus(a: &Rational, b: &Rational) -> Rational {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

pub fn cross(a: &Rational, b: &Rational) -> Rational {
    [0, 1, 2].map(|i| &a[(i + 1) % 3] * &b[(i + 2) % 3] - &a[(i + 2) % 3] * &b[(i + 1) % 3])
}

pub fn dot(a: &Rational, b: &Rational) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub fn normal([a, b, c]: &[Rational; 3]) -> Rational {
    cross(&minus(b, a), &minus(c, a))
}

/// The part of a convex polygon (or segment, or point) where `normal . (x - origin) >= 0`.
fn cut(polygon: Vec<Rational>, normal: &Rational, origin: &Rational) -> Vec<Rational> {
    let heights: Vec<RBig> = polygon.iter().map(|p| dot(normal, &minus(p, origin))).collect();
    let mut kept = vec![];
    for (i, p) in polygon.iter().enumerate() {
        let j = (i + 1) % polygon.len();
        if heights[i] >= RBig::ZERO {
            kept.push(p.clone());
        }
        if &heights[i] * &heights[j] < RBig::ZERO {
            let part = &heights[i] / (&heights[i] - &heights[j]);
            kept.push([0, 1, 2].map(|x| &p[x] + &part * (&polygon[j][x] - &p[x])));
        }
    }
    kept
}

/// Corners of what a convex polygon has in common with a triangle; some more than once.
pub fn within_triangle(polygon: &[Rational], triangle: &[Rational; 3]) -> Vec<Rational> {
    let up = normal(triangle);
    let down = minus(&triangle[0], &[0, 1, 2].map(|i| &triangle[0][i] + &up[i]));
    let mut rest = cut(cut(polygon.to_vec(), &up, &triangle[0]), &down, &triangle[0]);
    for i in 0..3 {
        let edge = minus(&triangle[(i + 1) % 3], &triangle[i]);
        rest = cut(rest, &cross(&up, &edge), &triangle[i]);
    }
    rest
}

/// The same for a tetrahedron.
pub fn within_tetrahedron(polygon: &[Rational], corners: &[Rational; 4]) -> Vec<Rational> {
    let mut rest = polygon.to_vec();
    for i in 0..4 {
        let [a, b, c] = [1, 2, 3].map(|j| corners[(i + j) % 4].clone());
        let mut inward = normal(&[a.clone(), b, c]);
        if dot(&inward, &minus(&corners[i], &a)) < RBig::ZERO {
            inward = inward.map(|x| -x);
        }
        rest = cut(rest, &inward, &a);
    }
    rest
}

/// Whether the points are not all on one line.
pub fn span_an_area(points: &[Rational]) -> bool {
    let steps: Vec<Rational> = points.iter().map(|p| minus(p, &points[0])).collect();
    steps.iter().any(|a| steps.iter().any(|b| cross(a, b) != [RBig::ZERO; 3]))
}
