//! The boundary of a texture's charts, and whether a part of it may take a short cut.
//!
//! Why this and positive triangles exclude overlap. Let all triangles of a chart be positive in the texture plane (of a
//! mirrored chart: after reflection). For a point `q` off the images of edges, the number of triangles over `q` is then
//! the winding number of the chart's boundary round `q`: both are the degree of the chart's map over `q`. So what happens
//! inside a chart cannot change how often `q` is covered as long as the triangles stay positive; only a change of the
//! boundary can. Let the boundary's `p, g, k` be replaced by `p, k`, or the other way round. The winding number changes by
//! one inside of the triangle `p g k`, all at once, and nowhere else. If no other edge of any chart's boundary meets the
//! closed triangle but in `p` or `k`, the number of triangles over its inner points, of all charts together, is one number
//! `c` before. If the chart lies on the triangle's side of the chain, `c` goes down. If it lies on the other side, the
//! points on that side, near the chain, were covered `c + 1` times, as nothing but this chart ends there: where nothing
//! was covered twice, `c` was 0 and becomes 1.
//! (A coverage, being a number of triangles, is never negative, so mirrored charts need no other argument.)

use homeo_core::predicate::{Sign, orient2d};

type Place = [f64; 2];

/// A part of the boundary that changes: a chain `from, via, to` of texture indices becomes the edge `from, to`, or the
/// other way round.
#[derive(Clone, Copy, Debug)]
pub(super) struct Detour {
    pub from: u32,
    pub via: u32,
    pub to: u32,
}

/// The edges of all charts' boundaries, as pairs of texture indices, the lower one first.
#[derive(Default)]
pub(super) struct Outline {
    edges: Vec<[u32; 2]>,
}

impl Outline {
    pub fn add(&mut self, a: u32, b: u32) {
        self.edges.push([a.min(b), a.max(b)]);
    }

    fn remove(&mut self, a: u32, b: u32) {
        if let Some(found) = self.edges.iter().position(|edge| *edge == [a.min(b), a.max(b)]) {
            self.edges.swap_remove(found);
        }
    }

    pub fn shorten(&mut self, Detour { from, via, to }: Detour) {
        self.remove(from, via);
        self.remove(via, to);
        self.add(from, to);
    }

    pub fn lengthen(&mut self, Detour { from, via, to }: Detour) {
        self.remove(from, to);
        self.add(from, via);
        self.add(via, to);
    }

    /// Whether no edge but those of the detour itself meets its closed triangle, except in its two ends.
    ///
    /// Linear in the number of edges, by boxes; seams are short beside the surface.
    pub fn is_clear(&self, detour: Detour, place: impl Fn(u32) -> Place) -> bool {
        let Detour { from, via, to } = detour;
        let own = [[from, via], [via, to], [from, to]].map(|[a, b]| [a.min(b), a.max(b)]);
        let corners = [from, via, to].map(&place);
        let low: Place = std::array::from_fn(|i| corners.iter().map(|p| p[i]).fold(f64::INFINITY, f64::min));
        let high: Place = std::array::from_fn(|i| corners.iter().map(|p| p[i]).fold(f64::NEG_INFINITY, f64::max));
        self.edges.iter().filter(|edge| !own.contains(edge)).all(|edge| {
            let [a, b] = edge.map(&place);
            let is_apart = (0..2).any(|i| a[i].max(b[i]) < low[i] || a[i].min(b[i]) > high[i]);
            is_apart || !meets_beyond_ends([a, b], corners)
        })
    }
}

/// Whether a segment meets a closed triangle elsewhere than in the triangle's first or last corner, exactly. The triangle
/// may be flat.
fn meets_beyond_ends([a, b]: [Place; 2], corners: [Place; 3]) -> bool {
    let [p, g, k] = corners;
    let is_end = |q: Place| q == p || q == k;
    match (is_end(a), is_end(b)) {
        // A copy of the new edge, or a segment without length.
        (true, true) => true,
        (true, false) => starts_into(a, b, if a == p { [g, k] } else { [p, g] }),
        (false, true) => starts_into(b, a, if b == p { [g, k] } else { [p, g] }),
        (false, false) => {
            let sides = [[p, g], [g, k], [k, p]];
            sides.into_iter().any(|side| segments_meet([a, b], side)) || is_within(a, corners)
        }
    }
}

/// Whether a segment from a corner of a triangle begins inside of it or along one of its sides to `others`. As triangles
/// are convex it meets the triangle beyond the corner just if it does.
fn starts_into(corner: Place, far: Place, others: [Place; 2]) -> bool {
    let [first, second] = others;
    let turn = orient2d(corner, first, second);
    if turn != Sign::Zero {
        let fits = |sign: Sign| sign == turn || sign == Sign::Zero;
        return fits(orient2d(corner, first, far)) && fits(orient2d(corner, far, second));
    }
    // A flat triangle is met only along its line, and in the direction of one of its corners.
    others.into_iter().any(|other| {
        let is_along = (0..2)
            .all(|i| (far[i] >= corner[i] && other[i] >= corner[i]) || (far[i] <= corner[i] && other[i] <= corner[i]));
        is_along && orient2d(corner, other, far) == Sign::Zero
    })
}

fn is_within(q: Place, [a, b, c]: [Place; 3]) -> bool {
    let signs = [orient2d(a, b, q), orient2d(b, c, q), orient2d(c, a, q)];
    // Of a flat triangle the sides are asked for, not the inside.
    orient2d(a, b, c) != Sign::Zero && !(signs.contains(&Sign::Positive) && signs.contains(&Sign::Negative))
}

fn segments_meet([a, b]: [Place; 2], [c, d]: [Place; 2]) -> bool {
    let sides = [orient2d(a, b, c), orient2d(a, b, d), orient2d(c, d, a), orient2d(c, d, b)];
    let in_box = |q: Place, [u, v]: [Place; 2]| (0..2).all(|i| u[i].min(v[i]) <= q[i] && q[i] <= u[i].max(v[i]));
    let touches = [(c, [a, b]), (d, [a, b]), (a, [c, d]), (b, [c, d])];
    let crosses = |s: Sign, t: Sign| s != Sign::Zero && s == t.reversed();
    sides.iter().zip(touches).any(|(side, (q, segment))| *side == Sign::Zero && in_box(q, segment))
        || (crosses(sides[0], sides[1]) && crosses(sides[2], sides[3]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Place; 3] = [[0.0, 0.0], [1.0, 2.0], [2.0, 0.0]];

    #[test]
    fn segments_may_touch_only_the_ends() {
        let meets = |a: Place, b: Place| meets_beyond_ends([a, b], CORNERS);
        assert!(!meets([-1.0, 0.0], [0.0, 0.0]) && !meets([2.0, 0.0], [3.0, 5.0]), "at an end, outside");
        assert!(meets([0.0, 0.0], [1.0, 0.5]) && meets([1.0, 0.0], [2.0, 0.0]), "at an end, inside and along a side");
        assert!(
            meets([0.0, 0.0], [2.0, 0.0]) && meets([1.0, 2.0], [1.0, 3.0]),
            "a copy of the short cut, and at the tip"
        );
        assert!(meets([0.9, 0.5], [1.1, 0.5]) && meets([-1.0, 1.0], [3.0, 1.0]), "inside, and across");
        assert!(!meets([-1.0, -0.1], [3.0, -0.1]) && meets([-1.0, -1.0], [1.0, 1.0]), "past it, and through an end");
    }

    #[test]
    fn flat_triangles_are_met_along_their_line() {
        let meets = |a: Place, b: Place| meets_beyond_ends([a, b], [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]);
        assert!(!meets([-1.0, -1.0], [0.0, 0.0]) && !meets([2.0, 2.0], [2.0, 3.0]));
        assert!(meets([0.0, 0.0], [0.5, 0.5]) && meets([0.0, 2.0], [2.0, 0.0]) && meets([1.5, 1.5], [1.5, 9.0]));
    }
}
