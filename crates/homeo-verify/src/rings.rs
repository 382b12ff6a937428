//! Rule D: closed polygons bound a domain.
//!
//! The rings are simple and do not meet; the first runs counter-clockwise and contains the others, which run clockwise
//! and contain none. Then the rings together wind once round every point of the domain and not at all round others.

use crate::number::{Point, in_finest_units, orientation_2d};
use crate::triangles::{BoxTree, bounds, segments_meet};
use crate::verdict::{Checked, check, refuted};
use dashu_int::IBig;
use std::cmp::Ordering;

/// Closed polygons, all vertices one after the other.
pub(crate) struct Rings<'a> {
    /// The vertices, with third coordinates 0.
    pub(crate) points: &'a [Point],
    /// How many vertices each ring has.
    pub(crate) sizes: &'a [u32],
}

impl<'a> Rings<'a> {
    /// The vertices of a ring.
    pub(crate) fn ring(&self, number: usize) -> &'a [Point] {
        let first: usize = self.sizes[..number].iter().map(|&n| n as usize).sum();
        &self.points[first..first + self.sizes[number] as usize]
    }

    /// Applies the rule; `what` is named in messages.
    pub(crate) fn check_domain(&self, what: &str) -> Checked {
        let refuse = |message: &str, vertices: &[u32]| refuted("D", format!("{message} ({what})"), &[], vertices);
        let edges: Vec<[u32; 2]> = self.edges().collect();
        let place = |v: u32| self.points[v as usize];
        let boxes: Vec<_> = edges.iter().map(|edge| bounds(&edge.map(place))).collect();
        let tree = BoxTree::new(&boxes);
        for (i, &[a, b]) in edges.iter().enumerate() {
            if place(a) == place(b) {
                return Err(refuse("an edge has length zero", &[a, b]));
            }
            for j in tree.meeting(&boxes[i]).into_iter().filter(|&j| j > i) {
                let [c, d] = edges[j];
                let meet = match (b == c, a == d) {
                    (true, true) => true,
                    (true, false) => folds_back([a, b, d].map(place)),
                    (false, true) => folds_back([c, a, b].map(place)),
                    (false, false) => segments_meet([a, b].map(place), [c, d].map(place)),
                };
                if meet {
                    return Err(refuse("two edges meet where they should not", &[a, b, c, d]));
                }
            }
        }
        (0..self.sizes.len()).try_for_each(|ring| {
            let wanted = if ring == 0 { Ordering::Greater } else { Ordering::Less };
            check(turn(self.ring(ring)) == wanted, "D", &format!("ring {ring} runs the wrong way ({what})"), &[], &[])?;
            // Rings that do not meet lie inside or outside one another as a whole.
            let is_in = |other: usize| winding(self.ring(other), self.ring(ring)[0]) != 0;
            let is_placed = ring == 0 || is_in(0) && (1..self.sizes.len()).all(|other| other == ring || !is_in(other));
            check(is_placed, "D", &format!("ring {ring} is no hole of the domain ({what})"), &[], &[])
        })
    }

    /// First and second vertex of every edge, ring after ring.
    pub(crate) fn edges(&self) -> impl Iterator<Item = [u32; 2]> {
        let firsts = self.sizes.iter().scan(0, |sum, &n| Some(std::mem::replace(sum, *sum + n)));
        firsts.zip(self.sizes).flat_map(|(first, &n)| (0..n).map(move |i| [first + i, first + (i + 1) % n]))
    }
}

/// Whether the path from `a` by `b` to `c` turns back on itself.
fn folds_back([a, b, c]: [Point; 3]) -> bool {
    let is_in_box = |p: Point, q: Point, r: Point| (0..2).all(|x| p[x].min(q[x]) <= r[x] && r[x] <= p[x].max(q[x]));
    orientation_2d(a, b, c) == Ordering::Equal && (is_in_box(a, b, c) || is_in_box(b, c, a))
}

/// The sign of the area, exact.
fn turn(ring: &[Point]) -> Ordering {
    let exact = |v: usize| ring[v % ring.len()].map(in_finest_units);
    let double_area: IBig = (0..ring.len())
        .map(|v| {
            let ([ax, ay, _], [bx, by, _]) = (exact(v), exact(v + 1));
            ax * by - bx * ay
        })
        .sum();
    double_area.cmp(&IBig::ZERO)
}

/// How often a ring winds round a point that is not on it.
fn winding(ring: &[Point], point: Point) -> i32 {
    let crossing = |v: usize| {
        let (a, b) = (ring[v], ring[(v + 1) % ring.len()]);
        match (a[1] <= point[1], b[1] <= point[1], orientation_2d(a, b, point)) {
            (true, false, Ordering::Greater) => 1,
            (false, true, Ordering::Less) => -1,
            _ => 0,
        }
    };
    (0..ring.len()).map(crossing).sum()
}
