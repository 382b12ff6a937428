//! Points on edges both ways, and preimages by Newton's method, proved to be near.
//!
//! The proof is that of composite maps: the preimage of a short path from the image of the point found to the point asked
//! for cannot leave a box in which the inverse of the derivative is bounded.

use homeo_core::number::{Interval, Rational};
use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::predicate::{Sign, orient2d};

use super::map::ComplexMap;
use crate::composite::invert::prove_near;
use crate::composite::number::{Form, Number};
use crate::map::Enclosed2;

/// A point and its image, to begin a search with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    point: Point2,
    image: Point2,
}

/// Starts along the longer side.
const GRID: usize = 32;
/// So many of the nearest starts are tried.
const ATTEMPTS: usize = 8;

/// Points of the source on a grid, and beside the vertices.
pub(super) fn starts(map: &ComplexMap) -> Vec<Start> {
    let domain = crate::map::PlanarBijection::source(map);
    let [low, high] = domain.bounds();
    let step = (high[0] - low[0]).max(high[1] - low[1]) / GRID as f64;
    let grid = (0..=GRID).flat_map(|x| (0..=GRID).map(move |y| [x, y]));
    let on_grid = grid.map(|at| [0, 1].map(|k| low[k] + (at[k] as f64 + 0.437) * step));
    let vertices = &map.step().points;
    let beside = (0..vertices.len()).flat_map(|i| {
        let (v, step) = (vertices[i], map.step());
        let [p, q] = [step.previous[i], step.next[i]].map(|j| vertices[j as usize]);
        [0.01, 0.1, -0.01, -0.1].map(|t| [0, 1].map(|k| v[k] + t * (p[k] + q[k] - 2.0 * v[k])))
    });
    let inside = on_grid.chain(beside).filter(|&point| domain.contains(point));
    inside
        .map(|point| Start { point, image: map.step().value(point).0 })
        .filter(|s| size(s.image).is_finite())
        .collect()
}

/// The edge that a point lies on, exactly, and how far along it is; `None` off all edges.
fn edge_of(domain: &PlanarDomain, point: Point2) -> Option<(usize, Rational)> {
    let is_between = |p: Point2, q: Point2, k: usize| p[k].min(q[k]) <= point[k] && point[k] <= p[k].max(q[k]);
    let is_on = |[p, q]: [Point2; 2]| (0..2).all(|k| is_between(p, q, k)) && orient2d(p, q, point) == Sign::Zero;
    let (number, [a, b]) = domain.edges().enumerate().find(|(_, edge)| is_on(*edge))?;
    let axis = usize::from((b[0] - a[0]).abs() < (b[1] - a[1]).abs());
    let exact = |x: f64| Rational::from_f64(x).unwrap_or(Rational::ZERO);
    let share = (exact(point[axis]) - exact(a[axis])) / (exact(b[axis]) - exact(a[axis]));
    Some((number, share))
}

/// The image of a point on an edge.
pub(super) fn along_edge(map: &ComplexMap, point: Point2) -> Option<Enclosed2> {
    let (edge, share) = edge_of(crate::map::PlanarBijection::source(map), point)?;
    let step = map.step();
    let ends = [edge, step.next[edge] as usize].map(|i| step.images[i]);
    Some(between(ends, &share, map.speeds().enclose(edge, Form::around(&share))))
}

/// The preimage of a point on an edge of the target.
pub(super) fn back_along_edge(map: &ComplexMap, point: Point2) -> Option<Enclosed2> {
    let (edge, share) = edge_of(crate::map::PlanarBijection::target(map), point)?;
    let wanted = Interval::around(&share);
    let certain = |t: f64| {
        let there = map.speeds().enclose(edge, Form::of(t));
        (there.high() <= wanted.low(), there.low() >= wanted.high())
    };
    let low = bisect(|t| certain(t).0, [0.0, 1.0]);
    let high = bisect(|t| certain(t).1, [1.0, 0.0]);
    let step = map.step();
    let ends = [edge, step.next[edge] as usize].map(|i| step.points[i]);
    Some(between(ends, &share, Form::between(low, high)))
}

/// The last number, going from the first end to the second, for which something holds that holds on the way up to some
/// place; the first end itself may do without.
fn bisect(holds: impl Fn(f64) -> bool, [mut good, mut bad]: [f64; 2]) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (good + bad);
        if middle == good || middle == bad {
            break;
        }
        if holds(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    good
}

/// The point that lies by a part between two; the ends themselves where the place on the other edge is one.
fn between([a, b]: [Point2; 2], share: &Rational, part: Form) -> Enclosed2 {
    if share.is_zero() || *share == Rational::ONE {
        return Enclosed2 { point: if share.is_zero() { a } else { b }, radius: 0.0 };
    }
    let one = Form::of(1.0);
    let at: [Form; 2] = std::array::from_fn(|k| Form::of(a[k]) * (one - part) + Form::of(b[k]) * part);
    Enclosed2 { point: at.map(|c| c.middle), radius: at[0].radius().max(at[1].radius()) }
}

/// The preimage of a point off the edges of the target.
pub(super) fn invert(map: &ComplexMap, image: Point2) -> Option<Enclosed2> {
    let target = crate::map::PlanarBijection::target(map);
    prove_near(map.step(), target, search(map, image)?, Enclosed2 { point: image, radius: 0.0 }).ok()
}

/// A point of the source whose image is as near as rounding allows, from the nearest starts.
fn search(map: &ComplexMap, image: Point2) -> Option<Point2> {
    let distance = |p: Point2| size([p[0] - image[0], p[1] - image[1]]);
    let mut nearest: Vec<(f64, Point2)> = Vec::with_capacity(ATTEMPTS + 1);
    for start in map.start_points() {
        let here = distance(start.image);
        let place = nearest.partition_point(|(other, _)| *other <= here);
        if place < ATTEMPTS {
            nearest.insert(place, (here, start.point));
            nearest.truncate(ATTEMPTS);
        }
    }
    let scale = crate::map::PlanarBijection::target(map).diagonal();
    let mut best: Option<(f64, Point2)> = None;
    for (_, start) in nearest {
        let (missed, point) = newton(map, start, image);
        if best.is_none_or(|(least, _)| missed < least) {
            best = Some((missed, point));
        }
        if missed <= 1e-12 * scale {
            break;
        }
    }
    best.map(|(_, point)| point)
}

/// Newton's method from a point, with steps halved until they stay in the closed source and gain; and by how much the end
/// misses.
fn newton(map: &ComplexMap, mut at: Point2, image: Point2) -> (f64, Point2) {
    let source = crate::map::PlanarBijection::source(map);
    let miss_at = |at: Point2| {
        let (there, derivative) = map.step().value(at);
        ([image[0] - there[0], image[1] - there[1]], derivative)
    };
    let (mut miss, mut derivative) = miss_at(at);
    for _ in 0..60 {
        let [[a, b], [c, d]] = derivative;
        let determinant = a * d - b * c;
        let way = [(d * miss[0] - b * miss[1]) / determinant, (a * miss[1] - c * miss[0]) / determinant];
        let attempts = (0..30).map(|halvings| 0.5f64.powi(halvings));
        let better = attempts.map(|part| [at[0] + part * way[0], at[1] + part * way[1]]).find_map(|next| {
            let (next_miss, next_derivative) = source.contains(next).then(|| miss_at(next))?;
            (size(next_miss) < size(miss)).then_some((next, next_miss, next_derivative))
        });
        let Some(next) = better else { break };
        (at, miss, derivative) = next;
    }
    (size(miss), at)
}

fn size([x, y]: Point2) -> f64 {
    x.hypot(y)
}
