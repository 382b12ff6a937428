//! Shapes of triangles in floating point. They guide; no guarantee rests on them.

use crate::construct::shell::directions::{dot, minus};
use crate::construct::shell::layer::area_and_sides;

type Point = [f64; 3];

/// The energy of a triangle: 2 for an equilateral one, without bound for flat ones (MIPS).
pub(super) fn energy(triangle: [Point; 3]) -> f64 {
    let (doubled_area, sides) = area_and_sides(triangle);
    sides / (3f64.sqrt() * doubled_area)
}

pub(super) fn cross(u: Point, v: Point) -> Point {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// Twice the area, along the normal.
pub(super) fn area_vector([a, b, c]: [Point; 3]) -> Point {
    cross(minus(b, a), minus(c, a))
}

/// The unit normal.
pub(super) fn normal(triangle: [Point; 3]) -> Point {
    unit(area_vector(triangle))
}

/// The vector of length 1; the zero vector for what has no direction.
pub(super) fn unit(v: Point) -> Point {
    let length = dot(v, v).sqrt();
    if length > 0.0 { v.map(|x| x / length) } else { [0.0; 3] }
}

pub(super) fn distance(a: Point, b: Point) -> f64 {
    let step = minus(a, b);
    dot(step, step).sqrt()
}

/// The point of a segment with the given share of the way.
pub(super) fn between(a: Point, b: Point, share: f64) -> Point {
    std::array::from_fn(|axis| a[axis] + share * (b[axis] - a[axis]))
}
