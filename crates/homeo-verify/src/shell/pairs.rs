//! Rules I1 to I4: the pairs of a triangle and a prism, where the source may cross itself in space.
//!
//! A *lift* of a point of a triangle is a point of a prism paired with it that `phi` sends there. Under these rules a lift
//! goes on into every triangle and every prism that it comes to: no sheet of the source ends inside the shell.

use super::{Shell, edge};
use crate::triangles::{bounds, boxes_meet, segment_meets_tetrahedron, triangles_meet};
use crate::verdict::{Checked, Stop, check, refuted};

impl Shell<'_> {
    /// I1 to I4. Returns the number of pairs, if the file has any.
    pub(super) fn check_pairs(&self) -> Checked<Option<u64>> {
        let Some(pairs) = self.pairs else { return Ok(None) };
        let counts = [self.source.count(), self.prisms.count()];
        for (k, &pair) in pairs.iter().enumerate() {
            let [c, q] = pair.map(|number| number as usize);
            let exist = c < counts[0] && q < counts[1];
            check(exist, "I1", "a pair names a triangle or a prism that does not exist", &[], &[])?;
            let is_next = k == 0 || pairs[k - 1] < pair;
            check(is_next, "I1", "pairs are not in ascending order", &[c, counts[0] + q], &[])?;
        }
        for &[slot, prism_slot] in &self.boundary {
            if !self.are_paired(slot / 3, prism_slot / 3) {
                return Err(self.missing("I2", "over a common boundary edge", slot / 3, prism_slot / 3));
            }
        }
        for [c, q] in pairs.iter().map(|pair| pair.map(|number| number as usize)) {
            self.check_neighbouring_prisms(c, q)?;
            self.check_neighbouring_triangles(c, q)?;
        }
        Ok(Some(pairs.len() as u64))
    }

    fn missing(&self, rule: &'static str, which: &str, c: usize, q: usize) -> Stop {
        let message = format!("a triangle and a prism {which} are no pair");
        refuted(rule, message, &[c, self.source.count() + q], self.source.cell(c))
    }

    /// I3: a triangle that meets the wall to another prism belongs to that too.
    fn check_neighbouring_prisms(&self, c: usize, q: usize) -> Checked {
        let triangle = self.triangle(c);
        let region = bounds(&triangle);
        for slot in self.prisms.slots(q) {
            let Some(other) = self.prisms.across(slot).map(|other| other / 3) else { continue };
            let is_met = |low| {
                let mut walls = self.walls(slot, low).into_iter();
                walls.any(|wall| boxes_meet(&bounds(&wall), &region) && triangles_meet(&triangle, &wall))
            };
            if !self.are_paired(c, other) && [0, 1].into_iter().any(is_met) {
                return Err(self.missing("I3", "beyond a wall that the triangle meets", c, other));
            }
        }
        Ok(())
    }

    /// I4: the triangle beyond an edge that meets the prism belongs to it too.
    fn check_neighbouring_triangles(&self, c: usize, q: usize) -> Checked {
        for slot in self.source.slots(c) {
            let Some(other) = self.source.across(slot).map(|other| other / 3) else { continue };
            let segment = edge(&self.source, slot).map(|v| self.positions[v as usize]);
            let is_met = |slab| {
                let is_near = boxes_meet(&bounds(&self.slab_points(slab)), &bounds(&segment));
                let cells = is_near.then(|| self.tetrahedra(slab)).into_iter().flatten();
                cells.into_iter().any(|t| segment_meets_tetrahedron(segment, &t.map(|corner| self.point(corner))))
            };
            if !self.are_paired(other, q) && [2 * q, 2 * q + 1].into_iter().any(is_met) {
                return Err(self.missing("I4", "that meets an edge of the triangle", other, q));
            }
        }
        Ok(())
    }
}
