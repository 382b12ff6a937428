//! Planar domains by their definitions: angles, windings, triangles over a point, derivatives by differences.

use super::random::Random;
use std::f64::consts::TAU;

pub type Point = [f64; 2];

/// First and second vertex of every edge, ring after ring.
pub fn edges(sizes: &[u32]) -> Vec<[usize; 2]> {
    let mut first = 0;
    let mut edges = Vec::new();
    for &n in sizes {
        let n = n as usize;
        edges.extend((0..n).map(|i| [first + i, first + (i + 1) % n]));
        first += n;
    }
    edges
}

/// A point anywhere, or beside an edge, near its first vertex often.
pub fn sample(random: &mut Random, k: usize, edges: &[[usize; 2]], points: &[Point]) -> Point {
    let [a, b] = edges[random.below(edges.len())];
    let share = if k.is_multiple_of(3) { random.unit() } else { 10f64.powf(-4.0 * random.unit()) };
    let off = 10f64.powf(-3.0 * random.unit());
    match k % 2 {
        0 => [0, 1].map(|_| 3.0 * random.unit() - 1.5),
        _ => [0, 1].map(|i| {
            let j = 1 - i;
            let normal = (points[b][j] - points[a][j]) * if i == 0 { -1.0 } else { 1.0 };
            points[a][i] + share * (points[b][i] - points[a][i]) + off * normal
        }),
    }
}

/// How often the rings wind round a point.
pub fn windings(edges: &[[usize; 2]], points: &[Point], at: Point) -> i64 {
    let turns: f64 = edges.iter().map(|&[p, q]| angle(points[p], points[q], at) / TAU).sum();
    turns.round() as i64
}

/// The angle from `p` to `q` seen from a point, between minus and plus a half turn.
pub fn angle(p: Point, q: Point, at: Point) -> f64 {
    let ([a, b], [c, d]) = ([p[0] - at[0], p[1] - at[1]], [q[0] - at[0], q[1] - at[1]]);
    f64::atan2(a * d - b * c, a * c + b * d)
}

/// Whether so many triangles are not over a point, which is not near their sides.
pub fn is_covered_otherwise(triangles: &[[u32; 3]], points: &[Point], at: Point, windings: i64) -> bool {
    let covering = triangles.iter().filter(|t| is_in(t.map(|v| points[v as usize]), at)).count();
    covering as i64 != windings && !is_near_sides(triangles, points, at)
}

fn is_in([a, b, c]: [Point; 3], at: Point) -> bool {
    [[a, b], [b, c], [c, a]].iter().all(|&[p, q]| angle(p, q, at) > 0.0)
}

/// Whether a point is so near a side that rounding decides in which triangle it is.
fn is_near_sides(triangles: &[[u32; 3]], points: &[Point], at: Point) -> bool {
    let near = |&t: &[u32; 3]| {
        (0..3).any(|k| {
            let turned = angle(points[t[k] as usize], points[t[(k + 1) % 3] as usize], at).abs();
            !(1e-9..=TAU / 2.0 - 1e-9).contains(&turned)
        })
    };
    triangles.iter().any(near)
}

/// The determinant of a map by differences over a length that is small against the distance from all edges.
pub fn determinant(edges: &[[usize; 2]], points: &[Point], map: impl Fn(Point) -> Point, at: Point) -> f64 {
    let distance = |&[p, q]: &[usize; 2]| {
        let side = [points[q][0] - points[p][0], points[q][1] - points[p][1]];
        let offset = [at[0] - points[p][0], at[1] - points[p][1]];
        let share = (side[0] * offset[0] + side[1] * offset[1]) / (side[0] * side[0] + side[1] * side[1]);
        let share = share.clamp(0.0, 1.0);
        (offset[0] - share * side[0]).hypot(offset[1] - share * side[1])
    };
    let step = 1e-3 * edges.iter().map(distance).fold(f64::INFINITY, f64::min);
    let f = |x: f64, y: f64| map([at[0] + x, at[1] + y]);
    let ([right, left], [up, down]) = ([f(step, 0.0), f(-step, 0.0)], [f(0.0, step), f(0.0, -step)]);
    let [u, v] = [(right, left), (up, down)].map(|(a, b)| [0, 1].map(|k| (a[k] - b[k]) / (2.0 * step)));
    u[0] * v[1] - u[1] * v[0]
}
