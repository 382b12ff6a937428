//! Extrusion directions at vertices.
//!
//! The direction that makes the smallest cosine with the incident triangles' normals as large as possible is the point
//! of their convex hull that is nearest to the origin; the hull holds the origin if and only if no direction will do.

use homeo_core::mesh::{SimplicialComplex, VertexId};
use homeo_core::predicate::{Sign, crossing_sign};

type Point = [f64; 3];

/// A unit vector per vertex that crosses all its triangles in the positive sense, decided exactly for the stored
/// numbers (seen from the origin); `None` where none was found, at *singular* vertices, and for vertices without
/// triangles.
pub(super) fn extrusion_directions(complex: &SimplicialComplex<3>, positions: &[Point]) -> Vec<Option<Point>> {
    let corners = |t: usize| complex.cells()[t].map(|v| positions[v.index()]);
    let normals: Vec<Point> = (0..complex.cell_count()).map(|t| unit_normal(corners(t))).collect();
    let around = triangles_around(complex);
    let direction = |v: VertexId| {
        let triangles = &around[v.index()];
        let fan: Vec<Point> = triangles.iter().map(|&t| normals[t as usize]).collect();
        let direction = unit(nearest_to_origin(&fan)?)?;
        let crosses = |&t: &u32| crossing_sign(corners(t as usize), [[0.0; 3], direction]) == Sign::Positive;
        triangles.iter().all(crosses).then_some(direction)
    };
    (0..positions.len()).map(|v| direction(VertexId::new(v))).collect()
}

/// The triangles at each vertex, ascending.
pub(super) fn triangles_around(complex: &SimplicialComplex<3>) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); complex.vertex_count()];
    for (t, corners) in (0..).zip(complex.cells()) {
        corners.iter().for_each(|v| around[v.index()].push(t));
    }
    around
}

/// Wolfe's algorithm in three dimensions: the point nearest to the origin of the convex hull of `points`.
/// `None` for no points. A few steps per corner of the hull; the answer is only as good as rounding allows.
fn nearest_to_origin(points: &[Point]) -> Option<Point> {
    let mut simplex: Vec<Point> = vec![*points.first()?];
    let mut nearest = simplex[0];
    for _ in 0..4 * points.len() + 8 {
        let lowest = points.iter().min_by(|a, b| dot(**a, nearest).total_cmp(&dot(**b, nearest)))?;
        if dot(*lowest, nearest) >= dot(nearest, nearest) - 1e-14 || simplex.contains(lowest) {
            break;
        }
        simplex.push(*lowest);
        (simplex, nearest) = nearest_of_simplex(&simplex);
    }
    Some(nearest)
}

/// The face of a simplex of at most four points that is nearest to the origin, and its nearest point.
fn nearest_of_simplex(simplex: &[Point]) -> (Vec<Point>, Point) {
    let mut best: Option<(f64, Vec<Point>, Point)> = None;
    for mask in 1u32..1 << simplex.len() {
        let face: Vec<Point> = (0..simplex.len()).filter(|k| mask >> k & 1 == 1).map(|k| simplex[k]).collect();
        let Some(point) = foot_inside(&face) else { continue };
        let size = dot(point, point);
        if best.as_ref().is_none_or(|(least, ..)| size < *least) {
            best = Some((size, face, point));
        }
    }
    best.map_or_else(|| (simplex[..1].to_vec(), simplex[0]), |(_, face, point)| (face, point))
}

/// The foot of the perpendicular from the origin onto the hull of a face, if it lies in it; the origin for four points
/// round it.
fn foot_inside(face: &[Point]) -> Option<Point> {
    let base = face[0];
    let edges: Vec<Point> = face[1..].iter().map(|p| minus(*p, base)).collect();
    // Normal equations of base + sum(x_i edge_i), by elimination with the largest pivot.
    let n = edges.len();
    let mut rows: Vec<[f64; 4]> = edges
        .iter()
        .map(|e| {
            std::array::from_fn(|j| {
                if j < n {
                    dot(*e, edges[j])
                } else if j == n {
                    -dot(*e, base)
                } else {
                    0.0
                }
            })
        })
        .collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()))?;
        rows.swap(k, pivot);
        if rows[k][k].abs() < 1e-14 {
            return None;
        }
        for i in (0..n).filter(|&i| i != k) {
            let factor = rows[i][k] / rows[k][k];
            (k..=n).for_each(|j| rows[i][j] -= factor * rows[k][j]);
        }
    }
    let weights: Vec<f64> = (0..n).map(|k| rows[k][n] / rows[k][k]).collect();
    if weights.iter().any(|w| *w < 0.0) || weights.iter().sum::<f64>() > 1.0 {
        return None;
    }
    let moved = |axis: usize| base[axis] + weights.iter().zip(&edges).map(|(w, e)| w * e[axis]).sum::<f64>();
    Some([moved(0), moved(1), moved(2)])
}

pub(super) fn unit_normal([a, b, c]: [Point; 3]) -> Point {
    let (u, v) = (minus(b, a), minus(c, a));
    unit([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]).unwrap_or([0.0; 3])
}

fn unit(v: Point) -> Option<Point> {
    // Scaled first: squares of small numbers vanish.
    let size = v.iter().fold(0.0f64, |size, x| size.max(x.abs()));
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let v = v.map(|x| x / size);
    let length = dot(v, v).sqrt();
    Some(v.map(|x| x / length))
}

pub(in crate::construct) fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

pub(in crate::construct) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corner_of_a_cube_points_along_its_diagonal() {
        let normals = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
        let direction = unit(nearest_to_origin(&normals).unwrap()).unwrap();
        assert!(direction.iter().all(|x| (x - 1.0 / 3f64.sqrt()).abs() < 1e-12), "{direction:?}");
    }

    #[test]
    fn opposite_normals_have_no_direction() {
        let normals = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let nearest = nearest_to_origin(&normals).unwrap();
        assert!(dot(nearest, nearest) < 1e-20);
    }

    #[test]
    fn the_smallest_cosine_is_the_largest_possible() {
        // Against a search over many directions.
        let normals: Vec<Point> = (0..7)
            .map(|k| {
                let angle = f64::from(k) * 0.9;
                unit([angle.cos(), angle.sin() * 0.7, 0.8 + 0.3 * f64::from(k % 3)]).unwrap()
            })
            .collect();
        let smallest = |d: Point| normals.iter().map(|n| dot(*n, d)).fold(f64::INFINITY, f64::min);
        let found = smallest(unit(nearest_to_origin(&normals).unwrap()).unwrap());
        for k in 0..20_000 {
            let (s, t) = (f64::from(k) * 0.0137, f64::from(k) * 0.6180);
            let tried = smallest([t.cos() * s.sin(), t.sin() * s.sin(), s.cos()]);
            assert!(tried <= found + 1e-12);
        }
    }
}
