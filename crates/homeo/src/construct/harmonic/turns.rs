//! Turns round a hole: which of the maps between two annuli, and what jumps where the angle does.

use std::f64::consts::TAU;

use homeo_core::planar::{DomainPair, PlanarDomain, Point2};

use super::mesh::{Mesh, triangulate};

/// How the rings of a pair turn against one another.
pub(super) struct Turns {
    /// How far the first inner vertex is ahead of the first outer one in the middle.
    pub ahead: f64,
    /// How many whole turns the inner ring of the target is put ahead.
    pub of_target: i8,
}

/// Splits the turn of a pair between its halves. Nothing turns but for one hole.
///
/// From the first outer to the first inner vertex the angle grows by `a` in the source and by `b`, both up to whole
/// turns. The map turns by `t`, which is `b - a` up to whole turns: as asked for, or as little as possible. The middle
/// has the inner vertex `a + t / 2` ahead, and in the target, where that is `b - t / 2`, by whole turns more or less.
pub(super) fn of_pair(pair: &DomainPair, degrees: Option<f64>) -> Turns {
    if pair.source.rings().len() != 2 {
        return Turns { ahead: 0.0, of_target: 0 };
    }
    let [a, b] = [&pair.source, &pair.target].map(|domain| {
        let centre = centre_of_hole(domain);
        angle(centre, domain.rings()[1][0]) - angle(centre, domain.rings()[0][0])
    });
    let wanted = degrees.unwrap_or(0.0) / 360.0;
    let turn = (b - a) + (wanted - (b - a)).round();
    Turns { ahead: a + 0.5 * turn, of_target: ((b - a) - turn).round() as i8 }
}

/// In turns, from 0 to 1.
fn angle(centre: Point2, point: Point2) -> f64 {
    ((point[1] - centre[1]).atan2(point[0] - centre[0]) / TAU).rem_euclid(1.0)
}

/// A point well inside the hole: the centre of the largest triangle there.
fn centre_of_hole(domain: &PlanarDomain) -> Point2 {
    let hole: Vec<Point2> = domain.rings()[1].iter().rev().copied().collect();
    let inside = triangulate(std::slice::from_ref(&hole), f64::INFINITY, 0);
    let corners = |t: &[u32; 3]| t.map(|v| hole[v as usize]);
    let size = |[a, b, c]: [Point2; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let largest =
        inside.ok().and_then(|mesh| mesh.triangles.iter().map(corners).max_by(|s, t| size(*s).total_cmp(&size(*t))));
    let [a, b, c] = largest.unwrap_or([hole[0]; 3]);
    [0, 1].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0)
}

/// For the corners of each triangle: how many turns they are ahead of the images of their vertices.
///
/// Angles round the hole jump by a turn somewhere; along an edge the true angle changes by less than half a turn, so the
/// jump is known. Images of boundary vertices do not jump but where their ring begins.
pub(super) fn shifts(domain: &PlanarDomain, mesh: &Mesh, rings: &[Vec<Point2>], turns: i8) -> Vec<[i8; 3]> {
    let centre = centre_of_hole(domain);
    let angles: Vec<f64> = mesh.boundary.iter().chain(&mesh.inner).map(|&p| angle(centre, p)).collect();
    let jump = |i: usize, j: usize| -(angles[j] - angles[i]).round() as i8;
    // By how many turns the angle that goes on along the ring is ahead of the one that jumps.
    let mut ahead = vec![0i8; angles.len()];
    let mut first = 0;
    for (ring, points) in rings.iter().enumerate() {
        ahead[first] = if ring == 0 { 0 } else { -turns };
        for v in first + 1..first + points.len() {
            ahead[v] = ahead[v - 1] + jump(v - 1, v);
        }
        first += points.len();
    }
    let shift = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| v as usize);
        let jumps = [0, jump(a, b), jump(a, c)];
        [(a, jumps[0]), (b, jumps[1]), (c, jumps[2])].map(|(v, jump)| jump - ahead[v])
    };
    mesh.triangles.iter().map(shift).collect()
}
