//! The preimage of a point under one step, found by Newton's method and proved to be near.
//!
//! Let `x` be a point of the source domain with image near `y`. The preimage of a path from `f(x)` to `y` inside the target
//! domain begins at `x` and is at most `L` times as long, as long as it stays in a box where `L` bounds the norm of the
//! inverse of the derivative. If `L` times the length of the path is less than the distance of `x` from the sides of the
//! box, it cannot leave the box, and ends within that of `x`: at the only preimage of `y`.

use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::predicate::{Sign, orient2d};

use super::chart::Step;
use super::evaluate::Region;
use super::number::{Form, Number};
use crate::map::Enclosed2;

/// Why a preimage is not proved to be near.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InverseError {
    /// The search left the domain.
    #[error("no point near it was found inside the domain")]
    NotFound,
    /// The image of the point found is not known well enough, or the derivative round it.
    #[error("the map is not bounded well enough near the preimage")]
    NotBounded,
    /// More than two edges, or distant ones, are as near as the error.
    #[error("several edges of the domain are as near as the error")]
    Crowded,
}

/// The preimage of what is enclosed.
pub(super) fn invert(
    step: &Step,
    backward: &Step,
    [source, target]: [&PlanarDomain; 2],
    image: Enclosed2,
) -> Result<Enclosed2, InverseError> {
    let point = newton(step, backward, source, image.point).ok_or(InverseError::NotFound)?;
    prove_near(step, target, point, image)
}

/// That the preimage of what is enclosed is near a point.
pub(crate) fn prove_near(
    step: &Step,
    target: &PlanarDomain,
    point: Point2,
    image: Enclosed2,
) -> Result<Enclosed2, InverseError> {
    let there = step.enclose(point.map(Form::of));
    let wanted = image.point.map(|c| Form::within(image.radius, c));
    let both: Region = std::array::from_fn(|k| there[k].hull(wanted[k]));
    if both.iter().any(|c| c.radius().is_nan()) {
        return Err(InverseError::NotBounded);
    }
    let diameter = 2.0 * both[0].radius().hypot(both[1].radius()) * (1.0 + 1e-12);
    let path = if meeting_edges(target, both).ok_or(InverseError::Crowded)? < 2 { diameter } else { 2.0 * diameter };
    let box_of = |radius: f64| point.map(|c| Form::within(radius, c));
    // The rate in the box must hold what made the box; a few attempts.
    let mut rate = 2.0;
    for _ in 0..40 {
        let radius = 1.5 * rate * path;
        let here = step.inverse_rate(box_of(radius));
        if here * path * (1.0 + 1e-12) < radius {
            return Ok(Enclosed2 { point, radius: here * path * (1.0 + 1e-12) });
        }
        rate = if here.is_nan() { return Err(InverseError::NotBounded) } else { here.max(2.0 * rate) };
    }
    Err(InverseError::NotBounded)
}

/// How many edges of a domain a box may meet, if it is so few that its part of the domain is connected by paths of twice
/// its diameter: none or one, when the part is convex, or two at a vertex in the box, which is seen from everywhere in it.
fn meeting_edges(domain: &PlanarDomain, at: [Form; 2]) -> Option<usize> {
    let [low, high]: [Point2; 2] = [at.map(Form::low), at.map(Form::high)];
    let corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
    let meets = |[p, q]: &[Point2; 2]| {
        let is_apart = (0..2).any(|k| p[k].max(q[k]) < low[k] || p[k].min(q[k]) > high[k]);
        let signs = corners.map(|corner| orient2d(*p, *q, corner));
        !(is_apart || signs.iter().all(|s| *s == Sign::Positive) || signs.iter().all(|s| *s == Sign::Negative))
    };
    let meeting: Vec<[Point2; 2]> = domain.edges().filter(meets).collect();
    let is_inside = |p: Point2| (0..2).all(|k| low[k] <= p[k] && p[k] <= high[k]);
    match meeting.as_slice() {
        [] => Some(0),
        [_] => Some(1),
        [[a, b], [c, d]] if (b == c && is_inside(*b)) || (d == a && is_inside(*a)) => Some(2),
        _ => None,
    }
}

/// A point of the closed domain whose image is as near as rounding allows.
fn newton(step: &Step, backward: &Step, source: &PlanarDomain, image: Point2) -> Option<Point2> {
    let guess = backward.value(image).0;
    let mut at = [guess, step.nearby(guess), step.centre_near(guess)].into_iter().find(|&p| source.contains(p))?;
    let miss_at = |at: Point2| {
        let (there, derivative) = step.value(at);
        ([image[0] - there[0], image[1] - there[1]], derivative)
    };
    let (mut miss, mut derivative) = miss_at(at);
    for _ in 0..60 {
        let [[a, b], [c, d]] = derivative;
        let determinant = a * d - b * c;
        let way = [(d * miss[0] - b * miss[1]) / determinant, (a * miss[1] - c * miss[0]) / determinant];
        // Shorter and shorter, until it is an improvement inside the domain.
        let attempts = (0..30).map(|halvings| 0.5f64.powi(halvings));
        let better = attempts.map(|part| [at[0] + part * way[0], at[1] + part * way[1]]).find_map(|next| {
            let (next_miss, next_derivative) = source.contains(next).then(|| miss_at(next))?;
            (size(next_miss) < size(miss)).then_some((next, next_miss, next_derivative))
        });
        let Some(next) = better else { break };
        (at, miss, derivative) = next;
    }
    Some(at)
}

fn size([x, y]: Point2) -> f64 {
    x.hypot(y)
}
