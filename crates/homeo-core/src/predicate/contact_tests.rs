//! Contact of triangles against an oracle in rational numbers that clips one triangle by the other.

use super::*;
use crate::number::Rational;

type Point = [f64; 3];
type Exact = [Rational; 3];

fn exact(p: Point) -> Exact {
    p.map(|x| Rational::from_f64(x).unwrap())
}

fn minus(a: &Exact, b: &Exact) -> Exact {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

fn dot(a: &Exact, b: &Exact) -> Rational {
    (0..3).map(|i| &a[i] * &b[i]).sum()
}

fn cross(a: &Exact, b: &Exact) -> Exact {
    [[1, 2], [2, 0], [0, 1]].map(|[i, j]| &(&a[i] * &b[j]) - &(&a[j] * &b[i]))
}

/// The part of a convex polygon where `normal · (x - origin) >= 0`.
fn clipped(polygon: &[Exact], normal: &Exact, origin: &Exact) -> Vec<Exact> {
    let heights: Vec<Rational> = polygon.iter().map(|p| dot(normal, &minus(p, origin))).collect();
    let mut kept = Vec::new();
    for i in 0..polygon.len() {
        let j = (i + 1) % polygon.len();
        if heights[i].sign() != Sign::Negative {
            kept.push(polygon[i].clone());
        }
        let signs = [heights[i].sign(), heights[j].sign()];
        if signs == [Sign::Negative, Sign::Positive] || signs == [Sign::Positive, Sign::Negative] {
            let t = &heights[i] / &(&heights[i] - &heights[j]);
            kept.push([0, 1, 2].map(|k| &polygon[i][k] + &(&t * &(&polygon[j][k] - &polygon[i][k]))));
        }
    }
    kept
}

fn negated(v: &Exact) -> Exact {
    v.clone().map(|x| -x)
}

/// Corners of the common part of a polygon (or segment, or point) and a proper triangle.
fn common_part(polygon: &[Point], triangle: [Point; 3]) -> Vec<Exact> {
    let [a, b, c] = triangle.map(exact);
    let normal = cross(&minus(&b, &a), &minus(&c, &a));
    let mut part: Vec<Exact> = polygon.iter().map(|&p| exact(p)).collect();
    part = clipped(&part, &normal, &a);
    part = clipped(&part, &negated(&normal), &a);
    for (from, to) in [(&a, &b), (&b, &c), (&c, &a)] {
        part = clipped(&part, &cross(&normal, &minus(to, from)), from);
    }
    part
}

/// Small numbers from a linear congruential generator.
struct Dice(u64);

impl Dice {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % bound
    }

    /// A point of a small grid (`kind` 0 to 2: flat, cube, wide) or one with full mantissas.
    fn point(&mut self, kind: u64) -> Point {
        match kind {
            0 => [self.below(4) as f64, self.below(4) as f64, 0.1],
            1 => [0, 1, 2].map(|_| self.below(3) as f64 * 0.1),
            2 => [0, 1, 2].map(|_| self.below(6) as f64 - 2.0),
            _ => [0, 1, 2].map(|_| self.below(1 << 30) as f64 / 1_073_741_827.0),
        }
    }

    /// A triangle of positive area.
    fn triangle(&mut self, kind: u64) -> [Point; 3] {
        loop {
            let triangle = [0, 1, 2].map(|_| self.point(kind));
            if !is_degenerate_triangle(triangle[0], triangle[1], triangle[2]) {
                return triangle;
            }
        }
    }
}

const CASES: usize = 6_000;

#[test]
fn triangles_meet_as_the_oracle_says() {
    let mut dice = Dice(1);
    let mut hits = [0; 4];
    for case in 0..CASES {
        let kind = case % 4;
        let (first, second) = (dice.triangle(kind as u64), dice.triangle(kind as u64));
        let expected = !common_part(&first, second).is_empty();
        assert_eq!(triangles_meet(first, second), expected, "{first:?} {second:?}");
        assert_eq!(triangles_meet(second, first), expected, "{second:?} {first:?}");
        hits[kind] += usize::from(expected);
    }
    // Negative control: both answers occur often in each kind.
    assert!(hits.iter().all(|&h| h > CASES / 80 && h < CASES / 4 - 20), "{hits:?}");
}

#[test]
fn segments_meet_triangles_as_the_oracle_says() {
    let mut dice = Dice(2);
    let mut hits = 0;
    for case in 0..CASES {
        let kind = case as u64 % 4;
        let (segment, triangle) = ([dice.point(kind), dice.point(kind)], dice.triangle(kind));
        let expected = !common_part(&segment, triangle).is_empty();
        assert_eq!(segment_meets_triangle(segment, triangle), expected, "{segment:?} {triangle:?}");
        hits += usize::from(expected);
    }
    assert!(hits > CASES / 20 && hits < CASES / 2, "{hits}");
}

/// A segment as a degenerate triangle takes the path for degenerate triangles.
#[test]
fn degenerate_triangles_meet_as_the_oracle_says() {
    let mut dice = Dice(3);
    for case in 0..CASES {
        let kind = case as u64 % 3;
        let [p, q] = [dice.point(kind), dice.point(kind)];
        let middle = if case % 2 == 0 { p } else { q };
        let triangle = dice.triangle(kind);
        let expected = !common_part(&[p, q], triangle).is_empty();
        assert_eq!(triangles_meet([p, middle, q], triangle), expected, "{p:?} {q:?} {triangle:?}");
        assert_eq!(triangles_meet(triangle, [middle, q, p]), expected);
    }
}

/// Two segments meet when the triangles over a far apex do so away from it; the oracle is the
/// triangle over one of them and an apex out of the plane of both.
#[test]
fn segments_meet_as_the_oracle_says() {
    let mut dice = Dice(4);
    let mut hits = 0;
    for case in 0..CASES {
        let kind = case as u64 % 3;
        let [a, b, c, d] = [0; 4].map(|_| dice.point(kind));
        // An apex that is in general position to all grids used above.
        let apex = [101.0, 1009.0, 10_007.0];
        if is_degenerate_triangle(a, b, apex) || orient3d(a, b, apex, c) == Sign::Zero {
            continue;
        }
        // The segment c d starts off the plane of a, b, apex: it meets that triangle in at most one
        // point, which lies on a b or not.
        let part = common_part(&[c, d], [a, b, apex]);
        let direction = minus(&exact(b), &exact(a));
        let expected = part.iter().any(|p| cross(&direction, &minus(p, &exact(a))).iter().all(|x| x.is_zero()));
        assert_eq!(segments_meet([a, b], [c, d]), expected, "{a:?} {b:?} {c:?} {d:?}");
        hits += usize::from(expected);
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn neighbours_at_a_vertex_as_the_oracle_says() {
    let mut dice = Dice(5);
    let mut hits = [0; 2];
    for case in 0..CASES {
        let kind = case as u64 % 4;
        let first = dice.triangle(kind);
        let mut second = dice.triangle(kind);
        second[0] = first[0];
        if is_degenerate_triangle(second[0], second[1], second[2]) {
            continue;
        }
        let apex = exact(first[0]);
        let expected = common_part(&first, second).iter().any(|p| *p != apex);
        let found = triangles_meet_beyond_vertex(first[0], [first[1], first[2]], [second[1], second[2]]);
        assert_eq!(found, expected, "{first:?} {second:?}");
        hits[usize::from(expected)] += 1;
    }
    assert!(hits[0] > 500 && hits[1] > 500, "{hits:?}");
}

#[test]
fn neighbours_at_an_edge_as_the_oracle_says() {
    let mut dice = Dice(6);
    let mut hits = [0; 2];
    for case in 0..CASES {
        let kind = case as u64 % 4;
        let first = dice.triangle(kind);
        let [u, v, a] = first;
        let b = dice.point(kind);
        if is_degenerate_triangle(u, v, b) {
            continue;
        }
        let direction = minus(&exact(v), &exact(u));
        let off_edge = |p: &Exact| !cross(&direction, &minus(p, &exact(u))).iter().all(|x| x.is_zero());
        let expected = common_part(&first, [u, v, b]).iter().any(off_edge);
        assert_eq!(triangles_meet_beyond_edge([u, v], a, b), expected, "{first:?} {b:?}");
        hits[usize::from(expected)] += 1;
    }
    assert!(hits[0] > 500 && hits[1] > 500, "{hits:?}");
}

#[test]
fn a_nudge_of_one_unit_in_the_last_place_separates() {
    let floor = [[0.1, 0.1, 0.3], [1.1, 0.1, 0.3], [0.1, 1.1, 0.3]];
    let standing = [[0.2, 0.2, 0.3], [0.2, 0.2, 1.3], [0.4, 0.2, 1.3]];
    assert!(triangles_meet(floor, standing));
    let mut lifted = standing;
    lifted[0][2] = lifted[0][2].next_up();
    assert!(!triangles_meet(floor, lifted));
}
