//! The local operations, each as a change to be accepted or refused.

use super::editor::{Change, Editor, Face, Marking, Rank};
use super::outline::Detour;
use crate::construct::crease::Kind;

type Point = [f64; 3];

/// Where the vertex of a collapsed edge goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Target {
    /// Where the kept vertex is.
    Kept,
    /// Another place; for two free vertices.
    At(Point),
}

impl Editor<'_> {
    /// Whether vertex `gone` may go into its neighbour `kept`, as far as kept edges are concerned.
    pub fn may_go(&self, gone: u32, kept: u32) -> bool {
        match self.rank(gone) {
            Rank::Free => true,
            Rank::Chain => self.creases.kind(gone, kept).is_some(),
            Rank::Fixed => false,
        }
    }

    /// Collapses an edge: vertex `gone`, which may go, becomes its neighbour `kept`.
    pub fn collapse(&mut self, gone: u32, kept: u32, target: Target) -> bool {
        let change = self.collapse_change(gone, kept, target);
        let Some(change) = change else {
            self.refusals.links += 1;
            return false;
        };
        let before = self.creases.before(gone, kept).filter(|_| self.rank(gone) == Rank::Chain);
        let is_done = self.apply(change);
        if let (true, Some(before)) = (is_done, before) {
            self.creases.shorten(before, gone, kept);
        }
        is_done
    }

    pub fn collapse_change(&self, gone: u32, kept: u32, target: Target) -> Option<Change> {
        if !self.surface.can_collapse(gone, kept) {
            return None;
        }
        let ends = self.surface.both_sides(gone, kept)?;
        // What the indices of the vertex that goes become, on either side.
        let renamed = ends.map(|t| [self.mark(t, gone), self.mark(t, kept)]);
        if renamed[0][0] == renamed[1][0] && renamed[0][1] != renamed[1][1] {
            return None;
        }
        let detours = match self.rank(gone) {
            Rank::Chain => self.detours(gone, kept, renamed)?,
            _ => Vec::new(),
        };
        let mut change = Change { old: self.surface.around[gone as usize].clone(), detours, ..Change::default() };
        for &t in change.old.iter().filter(|t| !ends.contains(t)) {
            let (corners, marks) = (self.surface.triangles[t as usize], self.marks(t));
            let corners = corners.map(|v| if v == gone { kept } else { v });
            let marks = marks.map(|m| renamed.iter().find(|pair| pair[0] == m).map_or(m, |pair| pair[1]));
            change.new.push(Face { corners, marks, parent: t });
        }
        if let Target::At(place) = target {
            let further = self.surface.around[kept as usize].iter().copied().filter(|t| !ends.contains(t));
            for t in further {
                change.new.push(Face { corners: self.surface.triangles[t as usize], marks: self.marks(t), parent: t });
                change.old.push(t);
            }
            change.moved = Some((kept, place));
            change.marking = Marking::FromFirst(renamed[0][1]);
        }
        Some(change)
    }

    /// The short cuts of the charts' boundaries when a vertex of a chain goes into a neighbour on it.
    fn detours(&self, gone: u32, kept: u32, renamed: [[u32; 2]; 2]) -> Option<Vec<Detour>> {
        let before = self.creases.before(gone, kept)?;
        // Two kept edges would become one.
        if self.creases.kind(before, kept).is_some() {
            return None;
        }
        if self.creases.kind(gone, kept) != Some(Kind::Seam) {
            return Some(Vec::new());
        }
        let behind = self.surface.both_sides(before, gone)?;
        let detour = |[via, to]: [u32; 2]| {
            let side = behind.into_iter().find(|&t| self.mark(t, gone) == via)?;
            Some(Detour { from: self.mark(side, before), via, to })
        };
        // A seam that is closed at this vertex has one index there for both sides.
        (renamed[0][0] != renamed[1][0]).then_some(())?;
        renamed.into_iter().map(detour).collect()
    }

    /// Exchanges an edge that is not kept for the other diagonal of its two triangles.
    pub fn flip(&mut self, a: u32, b: u32) -> bool {
        let Some(change) = self.flip_change(a, b) else {
            self.refusals.links += 1;
            return false;
        };
        self.apply(change)
    }

    pub fn flip_change(&self, a: u32, b: u32) -> Option<Change> {
        let [left, right] = self.surface.both_sides(a, b)?;
        let (c, d) = (self.surface.third(left, a, b)?, self.surface.third(right, a, b)?);
        let valence = |v: u32| self.surface.neighbours(v).len();
        let is_fit = self.creases.kind(a, b).is_none()
            && valence(a) > 3
            && valence(b) > 3
            && self.surface.neighbours(c).binary_search(&d).is_err();
        let [at_a, at_b, at_c] = [a, b, c].map(|v| self.mark(left, v));
        let at_d = self.mark(right, d);
        let new = vec![
            Face { corners: [a, d, c], marks: [at_a, at_d, at_c], parent: left },
            Face { corners: [d, b, c], marks: [at_d, at_b, at_c], parent: right },
        ];
        is_fit.then(|| Change { old: vec![left, right], new, ..Change::default() })
    }

    /// Puts a new vertex on an edge that is not on the boundary; its number is returned.
    pub fn split(&mut self, a: u32, b: u32, place: Point) -> Option<u32> {
        let mut change = self.split_change(a, b, place)?;
        let middle = self.surface.positions.len() as u32;
        // Along a seam the texture is halved; elsewhere it is the first one, if that fits.
        let halved = std::mem::take(&mut change.marking);
        let is_seam = self.creases.kind(a, b) == Some(Kind::Seam);
        if let (Marking::Given(given), false) = (&halved, is_seam) {
            let index = given.first()?.0;
            let exact = Change { marking: Marking::FromFirst(index), ..change.clone() };
            if self.apply(exact) {
                self.creases.lengthen(a, middle, b);
                return Some(middle);
            }
        }
        change.marking = halved;
        let is_done = self.apply(change);
        is_done.then(|| {
            self.creases.lengthen(a, middle, b);
            middle
        })
    }

    fn split_change(&self, a: u32, b: u32, place: Point) -> Option<Change> {
        let [left, right] = self.surface.both_sides(a, b)?;
        let (c, d) = (self.surface.third(left, a, b)?, self.surface.third(right, a, b)?);
        let m = self.surface.positions.len() as u32;
        let first = self.atlas.as_ref().map_or(0, |atlas| atlas.coordinates.len() as u32);
        let is_seam = self.creases.kind(a, b) == Some(Kind::Seam);
        let middle = [first, first + u32::from(is_seam)];
        let ends = [left, right].map(|t| [a, b].map(|v| self.mark(t, v)));
        let [at_c, at_d] = [self.mark(left, c), self.mark(right, d)];
        let face = |corners, marks, parent| Face { corners, marks, parent };
        let new = vec![
            face([a, m, c], [ends[0][0], middle[0], at_c], left),
            face([b, m, d], [ends[1][1], middle[1], at_d], right),
            face([m, b, c], [middle[0], ends[0][1], at_c], left),
            face([m, a, d], [middle[1], ends[1][0], at_d], right),
        ];
        let mut change = Change { old: vec![left, right], new, moved: Some((m, place)), ..Change::default() };
        if let Some(atlas) = &self.atlas {
            let half = |side: usize| {
                let [p, q] = ends[side].map(|index| atlas.place(index));
                (middle[side], [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])])
            };
            let sides = 0..1 + usize::from(is_seam);
            change.marking = Marking::Given(sides.clone().map(half).collect());
            if is_seam {
                let detour = |side: usize| Detour { from: ends[side][0], via: middle[side], to: ends[side][1] };
                change.detours = sides.map(detour).collect();
            }
        }
        Some(change)
    }

    /// Moves a free vertex.
    pub fn shift(&mut self, vertex: u32, place: Point) -> bool {
        let change = self.shift_change(vertex, place);
        change.is_some_and(|change| self.apply(change))
    }

    pub fn shift_change(&self, vertex: u32, place: Point) -> Option<Change> {
        let old = self.surface.around[vertex as usize].clone();
        let first = *old.first()?;
        let face = |&t: &u32| Face { corners: self.surface.triangles[t as usize], marks: self.marks(t), parent: t };
        let new = old.iter().map(face).collect();
        let marking = Marking::FromFirst(self.mark(first, vertex));
        Some(Change { old, new, moved: Some((vertex, place)), marking, detours: Vec::new() })
    }
}
