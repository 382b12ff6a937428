//! Which triangles in space meet, whether a triangle and a tetrahedron have an area in common, and which boxes meet.
//!
//! Everything is decided by exact signs; no triangle has area zero, no tetrahedron volume zero.

use crate::number::{Exact, Point, exact_orientation, orientation_2d, orientation_3d, steps_orientation};
use std::cmp::Ordering;

/// The corners of a triangle.
pub(crate) type Triangle = [Point; 3];

/// Whether two closed triangles meet: then an edge of one meets the other.
pub(crate) fn triangles_meet(a: &Triangle, b: &Triangle) -> bool {
    edges(a).iter().any(|&edge| meets_segment(b, edge)) || edges(b).iter().any(|&edge| meets_segment(a, edge))
}

/// Whether two closed triangles with the corner `p` meet anywhere else. A ray from `p` through a common point leaves
/// one of them first, through the edge opposite `p`, and is then still in the other.
pub(crate) fn triangles_meet_beyond(p: Point, a: &Triangle, b: &Triangle) -> bool {
    let is_opposite = |edge: &[Point; 2]| !edge.contains(&p);
    let meets = |a: &Triangle, b: &Triangle| edges(a).into_iter().filter(is_opposite).any(|e| meets_segment(b, e));
    meets(a, b) || meets(b, a)
}

/// Whether two triangles meet in more than their common corners and edge; corners are the same if their names are, and
/// those of one triangle lie apart.
pub(crate) fn do_clash<Name: Copy + Eq>([a, b]: [&[Name; 3]; 2], point: impl Fn(Name) -> Point) -> bool {
    let (common, rest): (Vec<Name>, Vec<Name>) = a.iter().partition(|corner| b.contains(corner));
    match common[..] {
        [] => triangles_meet(&a.map(&point), &b.map(&point)),
        [corner] => triangles_meet_beyond(point(corner), &a.map(&point), &b.map(&point)),
        [from, to] => {
            let other = b.iter().find(|corner| !common.contains(corner));
            let thirds = [rest[0], other.copied().unwrap_or(rest[0])];
            are_folded([from, to].map(&point), thirds.map(&point))
        }
        _ => true,
    }
}

/// Whether two triangles over a common edge lie in one plane, on the same side of it.
fn are_folded([from, to]: [Point; 2], [third, other]: [Point; 2]) -> bool {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let side = |p: Point, axis: Point| steps_orientation([[from, to], [from, p], [[0.0; 3], axis]]);
    orientation_3d(from, to, third, other) == Ordering::Equal
        && axes.into_iter().all(|axis| side(third, axis) == side(other, axis))
}

fn edges(&[a, b, c]: &Triangle) -> [[Point; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Whether a closed triangle and a closed segment meet.
fn meets_segment(triangle: &Triangle, [p, q]: [Point; 2]) -> bool {
    let &[a, b, c] = triangle;
    match [p, q].map(|end| orientation_3d(a, b, c, end)) {
        [Ordering::Equal, Ordering::Equal] => meets_segment_in_plane(triangle, [p, q]),
        [from, to] if from == to => false,
        // The segment reaches the plane in one point, which is in the triangle unless the line passes it by.
        _ => !have_both_signs(edges(triangle).map(|[x, y]| orientation_3d(p, q, x, y))),
    }
}

/// The same in one plane, by a shadow in which the triangle has an area.
fn meets_segment_in_plane(triangle: &Triangle, segment: [Point; 2]) -> bool {
    let shadow = |(x, y): (usize, usize)| (triangle.map(|p| [p[x], p[y], 0.0]), segment.map(|p| [p[x], p[y], 0.0]));
    let has_area = |(t, _): &(Triangle, _)| orientation_2d(t[0], t[1], t[2]) != Ordering::Equal;
    let Some((triangle, [p, q])) = [(0, 1), (1, 2), (2, 0)].map(shadow).into_iter().find(has_area) else { return true };
    let holds_end = !have_both_signs(edges(&triangle).map(|[a, b]| orientation_2d(a, b, p)));
    holds_end || edges(&triangle).into_iter().any(|edge| segments_meet(edge, [p, q]))
}

/// Whether two closed segments in the plane meet; neither is a point.
pub(crate) fn segments_meet([a, b]: [Point; 2], [p, q]: [Point; 2]) -> bool {
    let sides = [[p, q, a], [p, q, b], [a, b, p], [a, b, q]].map(|[x, y, z]| orientation_2d(x, y, z));
    if sides == [Ordering::Equal; 4] {
        return boxes_meet(&bounds(&[a, b]), &bounds(&[p, q])); // on one line
    }
    let is_crossed = |from: Ordering, to: Ordering| from != to || from == Ordering::Equal;
    is_crossed(sides[0], sides[1]) && is_crossed(sides[2], sides[3])
}

fn have_both_signs<const N: usize>(signs: [Ordering; N]) -> bool {
    signs.contains(&Ordering::Less) && signs.contains(&Ordering::Greater)
}

/// Whether a closed segment meets a closed tetrahedron, which is positive: it meets a face, or all of it is inside.
pub(crate) fn segment_meets_tetrahedron(segment: [Point; 2], tetrahedron: &[Point; 4]) -> bool {
    let [a, b, c, d] = *tetrahedron;
    let [p, _] = segment;
    let faces = [[p, b, c, d], [a, p, c, d], [a, b, p, d], [a, b, c, p]];
    let is_inside = faces.iter().all(|&[a, b, c, d]| orientation_3d(a, b, c, d) != Ordering::Less);
    is_inside || [[b, c, d], [a, c, d], [a, b, d], [a, b, c]].iter().any(|face| meets_segment(face, segment))
}

/// Whether a triangle and a closed tetrahedron have an area in common: no plane through three of their seven corners
/// separates them. (The first four planes are those of the tetrahedron's faces.)
pub(crate) fn have_common_area(tetrahedron: &[Point; 4], triangle: &Triangle) -> bool {
    let [a, b, c, d] = *tetrahedron;
    let [e, f, g] = *triangle;
    let points = [a, b, c, d, e, f, g];
    !(2..7).any(|i| (1..i).any(|j| (0..j).any(|k| separates(&points, [i, j, k]))))
}

/// Whether a plane has the tetrahedron, the first four points, on one closed side and the triangle on the other. A plane
/// that holds a face and the triangle does not count, for these may overlap.
fn separates(points: &[Point; 7], [i, j, k]: [usize; 3]) -> bool {
    let side = |m: usize| match [i, j, k].contains(&m) {
        true => Ordering::Equal,
        false => orientation_3d(points[i], points[j], points[k], points[m]),
    };
    let tetrahedron = [0, 1, 2, 3].map(side);
    let inside = tetrahedron.into_iter().find(|&sign| sign != Ordering::Equal); // none if the three are collinear
    if inside.is_none() || have_both_signs(tetrahedron) {
        return false;
    }
    let triangle = [4, 5, 6].map(side);
    let holds_both =
        triangle == [Ordering::Equal; 3] && tetrahedron.iter().filter(|&&s| s == Ordering::Equal).count() == 3;
    !holds_both && !triangle.iter().any(|&sign| Some(sign) == inside)
}

/// How often a polyline passes through the inside of a triangle; `None` if it meets an edge, runs along or turns back.
pub(crate) fn count_crossings(line: &[Exact], [a, b, c]: &[Exact; 3]) -> Option<usize> {
    let is_beyond = |axis: usize, order: Ordering| {
        line.iter().all(|p| [a, b, c].iter().all(|corner| corner[axis].cmp(&p[axis]) == order))
    };
    if (0..3).any(|axis| is_beyond(axis, Ordering::Less) || is_beyond(axis, Ordering::Greater)) {
        return Some(0);
    }
    let sides: Vec<Ordering> = line.iter().map(|p| exact_orientation(a, b, c, p)).collect();
    let mut count = 0;
    for (r, segment) in line.windows(2).enumerate() {
        let (from, to) = (sides[r], sides[r + 1]);
        if from == to && from != Ordering::Equal {
            continue;
        }
        let turns = [[a, b], [b, c], [c, a]].map(|[x, y]| exact_orientation(&segment[0], &segment[1], x, y));
        if have_both_signs(turns) {
            continue;
        }
        // A point of the polyline that lies in the triangle counts with the segment after it, if the line goes through.
        let before = if from == Ordering::Equal && r > 0 { sides[r - 1] } else { from };
        if turns.contains(&Ordering::Equal) || to != Ordering::Equal && before != to.reverse() {
            return None;
        }
        count += usize::from(to != Ordering::Equal);
    }
    Some(count)
}

/// The least and the greatest coordinates of some points.
pub(crate) type Bounds = [Point; 2];

/// The smallest box around points.
pub(crate) fn bounds(points: &[Point]) -> Bounds {
    let around = |b: Bounds, p: &Point| [[0, 1, 2].map(|x| b[0][x].min(p[x])), [0, 1, 2].map(|x| b[1][x].max(p[x]))];
    points.iter().fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], around)
}

pub(crate) fn boxes_meet(a: &Bounds, b: &Bounds) -> bool {
    (0..3).all(|x| a[0][x] <= b[1][x] && b[0][x] <= a[1][x])
}

/// A balanced binary tree of boxes. A node is followed by its first half, then its second half; with `n` boxes below
/// it has `2 n - 1` nodes, itself included.
pub(crate) struct BoxTree {
    nodes: Vec<Bounds>,
    order: Vec<usize>,
}

impl BoxTree {
    /// A tree of boxes, numbered as listed.
    pub(crate) fn new(boxes: &[Bounds]) -> Self {
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        let mut nodes = Vec::with_capacity(2 * boxes.len());
        add_node(&mut nodes, &mut order, boxes);
        BoxTree { nodes, order }
    }

    /// The numbers of the boxes that meet this one, in increasing order.
    pub(crate) fn meeting(&self, bounds: &Bounds) -> Vec<usize> {
        let mut found = vec![];
        let mut waiting = vec![(0, 0, self.order.len())]; // node, first box and number of boxes
        while let Some((node, first, count)) = waiting.pop() {
            if count == 0 || !boxes_meet(&self.nodes[node], bounds) {
                continue;
            }
            let half = count / 2;
            match half {
                0 => found.push(self.order[first]),
                _ => waiting.extend([(node + 1, first, half), (node + 2 * half, first + half, count - half)]),
            }
        }
        found.sort_unstable();
        found
    }
}

/// Adds the node of some boxes, halved along its longest side, and all nodes below.
fn add_node(nodes: &mut Vec<Bounds>, order: &mut [usize], boxes: &[Bounds]) {
    let corners: Vec<Point> = order.iter().flat_map(|&i| boxes[i]).collect();
    let whole = bounds(&corners);
    nodes.push(whole);
    if order.len() > 1 {
        let length = |x: &usize| whole[1][*x] - whole[0][*x];
        let axis = (0..3).max_by(|x, y| length(x).total_cmp(&length(y))).unwrap_or(0);
        let place = |i: usize| boxes[i][0][axis] + boxes[i][1][axis];
        order.select_nth_unstable_by(order.len() / 2, |&i, &j| place(i).total_cmp(&place(j)).then(i.cmp(&j)));
        let (before, after) = order.split_at_mut(order.len() / 2);
        add_node(nodes, before, boxes);
        add_node(nodes, after, boxes);
    }
}

#[cfg(test)]
#[path = "../tests/support/clip.rs"]
mod clip;

#[cfg(test)]
mod tests {
    use super::clip::{Rational, rational, span_an_area, within_tetrahedron, within_triangle};
    use super::*;
    use crate::number::{in_finest_units, is_flat_triangle};

    /// Splitmix64.
    struct Random(u64);

    impl Random {
        fn below(&mut self, count: u64) -> u64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb) % count
        }

        fn point(&mut self, size: u64) -> Point {
            [0; 3].map(|_| self.below(size) as f64)
        }

        fn triangle(&mut self, size: u64) -> Triangle {
            let triangle = [0; 3].map(|_| self.point(size));
            if is_flat_triangle(triangle[0], triangle[1], triangle[2]) { self.triangle(size) } else { triangle }
        }

        fn tetrahedron(&mut self, size: u64) -> [Point; 4] {
            let [a, b, c, d] = [0; 4].map(|_| self.point(size));
            match orientation_3d(a, b, c, d) {
                Ordering::Equal => self.tetrahedron(size),
                _ => [a, b, c, d],
            }
        }
    }

    /// How often something holds and does not hold.
    fn assert_balanced(counts: [usize; 2], least: usize) {
        assert!(counts[0] >= least && counts[1] >= least, "{counts:?}");
    }

    #[test]
    fn triangles_meet_as_clipping_finds() {
        let (mut random, mut meeting, mut beyond) = (Random(1), [0; 2], [0; 2]);
        for k in 0..6000 {
            let (a, mut b) = (random.triangle(2 + k % 4), random.triangle(2 + k % 4));
            let common = within_triangle(&a.map(rational), &b.map(rational));
            assert_eq!(triangles_meet(&a, &b), !common.is_empty(), "{a:?} {b:?}");
            meeting[usize::from(common.is_empty())] += 1;
            b[random.below(3) as usize] = a[0];
            if !is_flat_triangle(b[0], b[1], b[2]) {
                let common = within_triangle(&a.map(rational), &b.map(rational));
                let is_more = common.iter().any(|p| *p != rational(a[0]));
                assert_eq!(triangles_meet_beyond(a[0], &a, &b), is_more, "{a:?} {b:?}");
                beyond[usize::from(is_more)] += 1;
            }
        }
        assert_balanced(meeting, 1000);
        assert_balanced(beyond, 1000);
    }

    #[test]
    fn common_areas_are_as_clipping_finds() {
        let (mut random, mut counts) = (Random(2), [0; 2]);
        for k in 0..6000 {
            let (tetrahedron, triangle) = (random.tetrahedron(2 + k % 4), random.triangle(2 + k % 4));
            let has_area = span_an_area(&within_tetrahedron(&triangle.map(rational), &tetrahedron.map(rational)));
            assert_eq!(have_common_area(&tetrahedron, &triangle), has_area, "{tetrahedron:?} {triangle:?}");
            counts[usize::from(has_area)] += 1;
        }
        assert_balanced(counts, 1000);
    }

    #[test]
    fn segments_meet_tetrahedra_as_clipping_finds() {
        let (mut random, mut counts) = (Random(5), [0; 2]);
        for k in 0..6000 {
            let (mut tetrahedron, segment) = (random.tetrahedron(2 + k % 5), [0; 2].map(|_| random.point(2 + k % 5)));
            if segment[0] == segment[1] {
                continue;
            }
            let [a, b, c, d] = tetrahedron;
            if orientation_3d(a, b, c, d) == Ordering::Less {
                tetrahedron.swap(0, 1);
            }
            let common = within_tetrahedron(&segment.map(rational), &tetrahedron.map(rational));
            let do_meet = segment_meets_tetrahedron(segment, &tetrahedron);
            assert_eq!(do_meet, !common.is_empty(), "{segment:?} {tetrahedron:?}");
            counts[usize::from(do_meet)] += 1;
        }
        assert_balanced(counts, 1000);
    }

    #[test]
    fn crossings_are_as_clipping_finds() {
        let (mut random, mut counts, mut special) = (Random(3), [0; 2], 0);
        for _ in 0..6000 {
            let triangle = random.triangle(9);
            let mut line = [0; 4].map(|_| random.point(9));
            (0..4).for_each(|i| line[i][2] = 3.0 * i as f64 - 0.5 * (random.below(3) as f64)); // it rises
            let exact = |p: Point| p.map(in_finest_units);
            let Some(count) = count_crossings(&line.map(exact), &triangle.map(exact)) else {
                special += 1;
                continue;
            };
            let common = |s: &[Point]| within_triangle(&[rational(s[0]), rational(s[1])], &triangle.map(rational));
            let mut points: Vec<Rational> = line.windows(2).flat_map(common).collect();
            points.sort();
            points.dedup();
            // An end of the polyline does not count; in a shell it is on the bottom or the top.
            let ends = [rational(line[0]), rational(line[3])];
            points.retain(|p| !ends.contains(p));
            assert_eq!(count, points.len(), "{line:?} {triangle:?}");
            counts[usize::from(count > 0)] += 1;
        }
        assert_balanced(counts, 500);
        assert!(special >= 50, "{special}");
    }

    #[test]
    fn boxes_are_found_as_by_trying_all() {
        let mut random = Random(4);
        for count in (0..20).chain([500]) {
            let boxes: Vec<Bounds> = (0..count).map(|_| bounds(&[random.point(40), random.point(40)])).collect();
            let tree = BoxTree::new(&boxes);
            for _ in 0..20 {
                let other = bounds(&[random.point(40), random.point(40)]);
                let expected: Vec<usize> = (0..boxes.len()).filter(|&i| boxes_meet(&boxes[i], &other)).collect();
                assert_eq!(tree.meeting(&other), expected);
            }
        }
    }
}
