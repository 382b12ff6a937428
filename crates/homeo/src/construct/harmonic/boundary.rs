//! Where the boundary of a domain gets vertices.

use homeo_core::planar::{PlanarDomain, Point2};

use crate::map::{BoundaryPoint, SHARE_BITS};

/// Edges are halved at most this often: shares stay whole multiples of `2^-SHARE_BITS`.
const MOST_HALVINGS: u32 = 16;

/// Parts of edges are at most so many times as long as the domain is wide there: the first number that gives few enough.
const LONGEST: [f64; 5] = [2.0, 4.0, 8.0, 16.0, f64::INFINITY];

/// Vertices along all edges, no further apart than `spacing`, and closer where the domain is narrow: at most twice as far
/// as the nearest edge that is no neighbour, or farther where this takes more than `most` vertices.
pub(super) fn boundary_points(domain: &PlanarDomain, spacing: f64, most: usize) -> Vec<BoundaryPoint> {
    let tries = LONGEST.iter().map(|&longest| points_with(domain, spacing, longest, most));
    let fewest = || points_with(domain, spacing, f64::INFINITY, usize::MAX);
    tries.flatten().next().or_else(fewest).unwrap_or_default()
}

/// The vertices for one such number; none if they are too many.
fn points_with(domain: &PlanarDomain, spacing: f64, longest: f64, most: usize) -> Option<Vec<BoundaryPoint>> {
    let edges: Vec<(usize, usize, [Point2; 2])> = domain
        .rings()
        .iter()
        .enumerate()
        .flat_map(|(r, ring)| (0..ring.len()).map(move |e| (r, e, [ring[e], ring[(e + 1) % ring.len()]])))
        .collect();
    let mut points = Vec::new();
    for &(ring, edge, ends) in &edges {
        let n = domain.rings()[ring].len();
        let is_neighbour =
            |&&(r, e, _): &&(usize, usize, _)| r == ring && [0, 1, n - 1].contains(&((e + n - edge) % n));
        let others: Vec<[Point2; 2]> = edges.iter().filter(|other| !is_neighbour(other)).map(|e| e.2).collect();
        let mut push = |share| points.push(BoundaryPoint { ring: ring as u32, edge: edge as u32, share });
        halve(ends, &others, [spacing, longest], [0, 1 << SHARE_BITS], MOST_HALVINGS, &mut push);
        if points.len() > most {
            return None;
        }
    }
    Some(points)
}

/// Visits the beginnings of the parts of an edge, in order.
fn halve(
    ends: [Point2; 2],
    others: &[[Point2; 2]],
    [spacing, longest]: [f64; 2],
    [from, to]: [u32; 2],
    halvings: u32,
    push: &mut impl FnMut(u32),
) {
    let at = |share: u32| {
        let s = f64::from(share) / f64::from(1 << SHARE_BITS);
        [0, 1].map(|axis| ends[0][axis] * (1.0 - s) + ends[1][axis] * s)
    };
    let part = [at(from), at(to)];
    let length = distance(part[0], part[1]);
    // Only what is near the whole part can be near its halves.
    let near: Vec<[Point2; 2]> =
        others.iter().filter(|other| longest * distance_of_segments(&part, other) < length).copied().collect();
    if halvings > 0 && (length > spacing || !near.is_empty()) {
        let middle = from + (to - from) / 2;
        let others = if length > spacing { others } else { &near };
        halve(ends, others, [spacing, longest], [from, middle], halvings - 1, push);
        halve(ends, others, [spacing, longest], [middle, to], halvings - 1, push);
    } else {
        push(from);
    }
}

fn distance([a, b]: Point2, [c, d]: Point2) -> f64 {
    (c - a).hypot(d - b)
}

/// Of segments that do not cross.
fn distance_of_segments(first: &[Point2; 2], second: &[Point2; 2]) -> f64 {
    let to = |point: Point2, [a, b]: &[Point2; 2]| {
        let (along, to) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
        let squared = along[0] * along[0] + along[1] * along[1];
        let s = ((along[0] * to[0] + along[1] * to[1]) / squared).clamp(0.0, 1.0);
        distance(point, [a[0] + s * along[0], a[1] + s * along[1]])
    };
    let [a, b] = first.map(|p| to(p, second));
    let [c, d] = second.map(|p| to(p, first));
    a.min(b).min(c.min(d))
}
