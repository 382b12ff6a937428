//! Whether triangles in space meet.
//!
//! All answers follow from signs of [`orient2d`] and [`orient3d`] alone, so they are exact for the
//! stored coordinates. Sets are closed: touching is meeting.

use super::{Sign, orient2d, orient3d};

type Point = [f64; 3];

/// The pairs of axes onto which a plane in space can be projected.
const PROJECTIONS: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Whether two numbers, neither zero, have opposite signs.
#[inline]
fn opposite(a: Sign, b: Sign) -> bool {
    a != Sign::Zero && a == b.reversed()
}

/// Whether the signs hold no two opposite ones.
#[inline]
fn weakly_alike(signs: [Sign; 3]) -> bool {
    !signs.contains(&Sign::Positive) || !signs.contains(&Sign::Negative)
}

#[inline]
fn flat(point: Point, [u, v]: [usize; 2]) -> [f64; 2] {
    [point[u], point[v]]
}

/// Axes of a projection under which `a b c` keeps a positive or negative area; `None` when the
/// three points are collinear. It is then one-to-one on the plane of the triangle.
///
/// ```
/// use homeo_core::predicate::faithful_projection;
/// // In the plane x = 0, the first two coordinates do not tell.
/// let corners = [[0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// assert_eq!(faithful_projection(corners[0], corners[1], corners[2]), Some([1, 2]));
/// assert_eq!(faithful_projection(corners[0], corners[1], corners[1]), None);
/// ```
#[inline]
pub fn faithful_projection(a: Point, b: Point, c: Point) -> Option<[usize; 2]> {
    PROJECTIONS.into_iter().find(|&axes| orient2d(flat(a, axes), flat(b, axes), flat(c, axes)) != Sign::Zero)
}

/// Whether the closed segment and the closed triangle share a point.
///
/// The triangle may be degenerate (a segment or a point), and so may the segment.
///
/// ```
/// use homeo_core::predicate::segment_meets_triangle;
/// let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// assert!(segment_meets_triangle([[0.25, 0.25, -1.0], [0.25, 0.25, 1.0]], triangle));
/// assert!(!segment_meets_triangle([[0.75, 0.75, -1.0], [0.75, 0.75, 1.0]], triangle));
/// ```
pub fn segment_meets_triangle([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    // Saves exact signs among neighbours in one plane, where they are slow.
    if !boxes_meet([p, q], [a, b, c]) {
        return false;
    }
    let sides = [orient3d(a, b, c, p), orient3d(a, b, c, q)];
    segment_at_sides_meets([p, q], sides, [a, b, c])
}

/// Whether the bounding boxes of a segment and of a triangle share a point.
#[inline]
fn boxes_meet([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    (0..3).all(|i| p[i].min(q[i]) <= a[i].max(b[i]).max(c[i]) && a[i].min(b[i]).min(c[i]) <= p[i].max(q[i]))
}

/// Same, when the sides of the triangle's plane on which the ends lie are already known.
fn segment_at_sides_meets([p, q]: [Point; 2], sides: [Sign; 2], [a, b, c]: [Point; 3]) -> bool {
    if sides[0] == sides[1] {
        return sides[0] == Sign::Zero && coplanar_segment_meets([p, q], [a, b, c]);
    }
    // The line p q crosses the plane in one point of the segment. It lies in the triangle when
    // the line does not pass two edges on opposite hands.
    weakly_alike([orient3d(p, q, a, b), orient3d(p, q, b, c), orient3d(p, q, c, a)])
}

/// A segment in the plane of a triangle, or any segment and a degenerate triangle.
fn coplanar_segment_meets([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    let edges = [[a, b], [b, c], [c, a]];
    let Some(axes) = faithful_projection(a, b, c) else {
        return edges.iter().any(|&edge| segments_meet([p, q], edge));
    };
    let [p, q, a, b, c] = [p, q, a, b, c].map(|point| flat(point, axes));
    point_in_flat_triangle(p, [a, b, c])
        || point_in_flat_triangle(q, [a, b, c])
        || [[a, b], [b, c], [c, a]].iter().any(|&edge| flat_segments_meet([p, q], edge))
}

fn point_in_flat_triangle(p: [f64; 2], [a, b, c]: [[f64; 2]; 3]) -> bool {
    weakly_alike([orient2d(a, b, p), orient2d(b, c, p), orient2d(c, a, p)])
}

/// Two closed segments of the plane, degenerate ones included.
fn flat_segments_meet([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let boxes_meet = (0..2).all(|i| a[i].min(b[i]) <= c[i].max(d[i]) && c[i].min(d[i]) <= a[i].max(b[i]));
    let separated = |[p, q]: [[f64; 2]; 2], [r, s]: [[f64; 2]; 2]| {
        let side = orient2d(p, q, r);
        side != Sign::Zero && side == orient2d(p, q, s)
    };
    boxes_meet && !separated([a, b], [c, d]) && !separated([c, d], [a, b])
}

/// Whether two closed segments in space share a point; both may be degenerate.
///
/// ```
/// use homeo_core::predicate::segments_meet;
/// let along = [[0.0; 3], [3.0, 3.0, 3.0]];
/// assert!(segments_meet(along, [[1.0, 1.0, 1.0], [1.0, 1.0, 9.0]]));
/// assert!(!segments_meet(along, [[1.0, 1.0, 2.0], [1.0, 1.0, 9.0]]));
/// ```
pub fn segments_meet([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    if orient3d(a, b, c, d) != Sign::Zero {
        return false;
    }
    // The four points lie in a plane; a triple that is not collinear says how to look at it.
    let triples = [[a, b, c], [a, b, d], [c, d, a], [c, d, b]];
    match triples.iter().find_map(|&[x, y, z]| faithful_projection(x, y, z)) {
        Some(axes) => flat_segments_meet([flat(a, axes), flat(b, axes)], [flat(c, axes), flat(d, axes)]),
        None => (0..3).all(|i| a[i].min(b[i]) <= c[i].max(d[i]) && c[i].min(d[i]) <= a[i].max(b[i])),
    }
}

/// Whether `d` may lie in the plane of `a b c`; decided in floating point, erring towards yes.
#[inline]
fn may_be_coplanar(a: Point, b: Point, c: Point, d: Point) -> bool {
    let [x, y, z] = [a, b, c].map(|p| [p[0] - d[0], p[1] - d[1], p[2] - d[2]]);
    let (mut determinant, mut magnitude) = (0.0, 0.0);
    for [i, j, k] in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
        let (p, q) = (y[i] * z[j], y[j] * z[i]);
        determinant += x[k] * (p - q);
        magnitude += x[k].abs() * (p.abs() + q.abs());
    }
    // Above Shewchuk's bound 7.8e-16; a wrong answer costs time, nothing else.
    determinant.abs() <= 1e-15 * magnitude
}

/// The projection along the longest component of a normal, as good as floating point finds it.
#[inline]
fn likely_projection([a, b, c]: [Point; 3]) -> [usize; 2] {
    let area = |[u, v]: [usize; 2]| ((b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u])).abs();
    let best = |x, y| if area(y) > area(x) { y } else { x };
    PROJECTIONS.into_iter().reduce(best).unwrap_or([0, 1])
}

/// Whether some line along one of the `edges` of the triangle keeps `others` strictly off it, on the
/// far side. An edge is given by the number of the corner opposite to it.
fn is_cut_off(triangle: [[f64; 2]; 3], edges: &[usize], others: &[[f64; 2]]) -> bool {
    let [a, b, c] = triangle;
    let side = orient2d(a, b, c);
    side != Sign::Zero
        && edges.iter().any(|&i| {
            let [p, q] = [triangle[(i + 1) % 3], triangle[(i + 2) % 3]];
            others.iter().all(|&other| opposite(side, orient2d(p, q, other)))
        })
}

/// Whether two closed triangles share a point; both may be degenerate.
///
/// They do if and only if an edge of one meets the other.
///
/// # Complexity
/// Two to twelve signs for triangles in general position.
///
/// ```
/// use homeo_core::predicate::triangles_meet;
/// let floor = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let standing = [[0.5, 0.5, 0.0], [0.5, 0.5, 1.0], [2.0, 2.0, 1.0]];
/// assert!(triangles_meet(floor, standing), "they touch in one point");
/// assert!(!triangles_meet(floor, standing.map(|[x, y, z]| [x + 0.001, y, z])));
/// ```
pub fn triangles_meet(first: [Point; 3], second: [Point; 3]) -> bool {
    // In one plane, signs in space are slow; there a line that separates the two is found sooner.
    if may_be_coplanar(first[0], first[1], first[2], second[0]) {
        let axes = likely_projection(first);
        let [p, q] = [first, second].map(|t| t.map(|point| flat(point, axes)));
        if is_cut_off(p, &[0, 1, 2], &q) || is_cut_off(q, &[0, 1, 2], &p) {
            return false;
        }
    }
    let sides = |[a, b, c]: [Point; 3], other: [Point; 3]| other.map(|p| orient3d(a, b, c, p));
    let apart = |s: [Sign; 3]| s[0] != Sign::Zero && s[0] == s[1] && s[1] == s[2];
    let second_sides = sides(first, second);
    if apart(second_sides) {
        return false;
    }
    let first_sides = sides(second, first);
    if apart(first_sides) {
        return false;
    }
    let any_edge = |of: [Point; 3], sides: [Sign; 3], other: [Point; 3]| {
        (0..3).any(|i| {
            let j = (i + 1) % 3;
            segment_at_sides_meets([of[i], of[j]], [sides[i], sides[j]], other)
        })
    };
    any_edge(first, first_sides, second) || any_edge(second, second_sides, first)
}

/// Whether the triangles `apex, first` and `apex, second` share more than the apex.
///
/// # Preconditions
/// Neither triangle is degenerate.
///
/// Their common part is convex and holds the apex. If it holds another point, the ray from the apex
/// through it leaves one of the triangles first, across the edge opposite the apex: hence the test
/// of these two edges decides.
///
/// ```
/// use homeo_core::predicate::triangles_meet_beyond_vertex;
/// let (apex, first) = ([0.0; 3], [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
/// assert!(triangles_meet_beyond_vertex(apex, first, [[1.0, 1.0, 1.0], [1.0, 1.0, -1.0]]));
/// assert!(!triangles_meet_beyond_vertex(apex, first, [[-1.0, 1.0, 1.0], [-1.0, 1.0, -1.0]]));
/// ```
pub fn triangles_meet_beyond_vertex(apex: Point, first: [Point; 2], second: [Point; 2]) -> bool {
    // As in `triangles_meet`; a line through the apex separates, too, as it meets the other triangle
    // in the apex alone.
    if may_be_coplanar(apex, first[0], first[1], second[0]) {
        let triangles = [[apex, first[0], first[1]], [apex, second[0], second[1]]];
        let axes = likely_projection(triangles[0]);
        let [p, q] = triangles.map(|t| t.map(|point| flat(point, axes)));
        if is_cut_off(p, &[1, 2], &q[1..]) || is_cut_off(q, &[1, 2], &p[1..]) {
            return false;
        }
    }
    segment_meets_triangle(first, [apex, second[0], second[1]])
        || segment_meets_triangle(second, [apex, first[0], first[1]])
}

/// Whether the triangles `edge, first` and `edge, second` share more than the edge.
///
/// # Preconditions
/// Neither triangle is degenerate.
///
/// They do if and only if they lie in one plane on the same side of the edge.
///
/// ```
/// use homeo_core::predicate::triangles_meet_beyond_edge;
/// let edge = [[0.0; 3], [1.0, 0.0, 0.0]];
/// assert!(triangles_meet_beyond_edge(edge, [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]), "folded flat");
/// assert!(!triangles_meet_beyond_edge(edge, [0.0, 1.0, 0.0], [1.0, -1.0, 0.0]));
/// ```
pub fn triangles_meet_beyond_edge([u, v]: [Point; 2], first: Point, second: Point) -> bool {
    if orient3d(u, v, first, second) != Sign::Zero {
        return false;
    }
    faithful_projection(u, v, first).is_some_and(|axes| {
        let [u, v, first, second] = [u, v, first, second].map(|p| flat(p, axes));
        !opposite(orient2d(u, v, first), orient2d(u, v, second))
    })
}
