//! Cutting patterns: how the walls of prisms over triangles are cut so that every prism falls into three tetrahedra.
//!
//! # The theorem
//! Over each triangle stands a prism; the wall over a side is cut along one of its diagonals, which is *rising* if it
//! goes from the bottom at the side's start to the top at its end. Seen from the triangle on the other side, whose side runs
//! the other way, it is *falling*. A prism falls into three tetrahedra along its three diagonals if and only if not all three
//! rise and not all three fall. So a cutting pattern is an orientation of the graph whose nodes are the triangles and whose edges
//! are the inner edges, with the boundary sides as half edges of fixed or free direction, such that no node is a source and
//! none a sink.
//!
//! *A component of triangles (connected across sides) has a cutting pattern if and only if the graph has a cycle, or a
//! boundary side is free, or the prescribed ones do not all say the same.* It is found by a first path or cycle that has
//! what is needed, and ears from then on: linear in all. For a disk the graph has no cycle exactly if no vertex is
//! inside. Proof: `docs/theory/bundles.md`, theorem 1. Yin 2010, chapter 5, reaches the same for disks by dividing them
//! into strips; here the surface may have any topology.

mod component;
#[cfg(test)]
mod tests;

use super::walls::{Side, Walls};
use component::{Component, path_between};
use std::ops::Neg;
use thiserror::Error;

/// How the wall over a side is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Diagonal {
    /// From the bottom at the side's start to the top at its end (+1 in the source).
    Rising,
    /// From the top at the side's start to the bottom at its end (-1 in the source).
    Falling,
}

impl Neg for Diagonal {
    type Output = Self;

    fn neg(self) -> Self {
        match self {
            Self::Rising => Self::Falling,
            Self::Falling => Self::Rising,
        }
    }
}

/// Triangles that have no cutting pattern: they have no cycle across their sides, and all their boundary sides are
/// prescribed to be cut in the same way.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[error(
    "triangle {} and the {} others that are connected with it have no cutting pattern: no vertex is inside and all boundary \
     sides are {diagonal:?}; prescribe one of them otherwise, or add a vertex inside",
    triangles[0], triangles.len() - 1
)]
pub struct Obstruction {
    /// The triangles, at least one.
    pub triangles: Vec<u32>,
    /// What all boundary sides are prescribed to be.
    pub diagonal: Diagonal,
}

/// Cuts the walls over all sides, with those prescribed that are listed; the diagonals of the three sides of each triangle.
///
/// A prescription of a side that is not at the boundary has no effect, and of several for one side the last counts.
/// Boundary sides that are not prescribed are free. Cost: linear.
///
/// # Guarantee
/// The same diagonal from both sides of every wall, and not three times the same in any triangle.
///
/// # Errors
/// The first component that has no cutting pattern, by the theorem of the module.
///
/// # Example
/// ```
/// use homeo_manifold::bundle::{Diagonal, Side, Walls, cutting_pattern};
/// let triangle = Walls::new(&[[0, 1, 2]])?;
/// let rising = |side| (Side::new(0, side), Diagonal::Rising);
/// let pattern = cutting_pattern(&triangle, &[rising(0), rising(1)])?;
/// assert_eq!(pattern[0], [Diagonal::Rising, Diagonal::Rising, Diagonal::Falling]);
/// let obstruction = cutting_pattern(&triangle, &[rising(0), rising(1), rising(2)]).unwrap_err();
/// assert_eq!(obstruction.triangles, [0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn cutting_pattern(walls: &Walls, prescribed: &[(Side, Diagonal)]) -> Result<Vec<[Diagonal; 3]>, Obstruction> {
    let mut cutting = Cutting::new(walls);
    for &(side, diagonal) in prescribed {
        if walls.across(side).is_none() {
            *cutting.slot(side) = Some(diagonal);
        }
    }
    for triangle in 0..walls.len() as u32 {
        cutting.settle_if_mixed(triangle);
    }
    cutting.grow();
    for triangle in 0..walls.len() as u32 {
        if !cutting.is_settled[triangle as usize] {
            cutting.start(triangle)?;
            cutting.grow();
        }
    }
    Ok(cutting.finished())
}

struct Cutting<'a> {
    walls: &'a Walls,
    diagonals: Vec<[Option<Diagonal>; 3]>,
    /// Whether a triangle has a rising and a falling side.
    is_settled: Vec<bool>,
    /// Settled triangles from which no ears have been grown.
    waiting: Vec<u32>,
    /// The walk that last passed a triangle.
    passed_by: Vec<u32>,
    walks: u32,
}

/// How a walk ends.
enum End {
    /// Anywhere that leaves its direction open.
    Open,
    /// At a boundary side that is free.
    Free(Side),
    /// At a boundary side that is prescribed.
    Prescribed(Diagonal),
}

impl<'a> Cutting<'a> {
    fn new(walls: &'a Walls) -> Self {
        let count = walls.len();
        let (diagonals, is_settled) = (vec![[None; 3]; count], vec![false; count]);
        Self { walls, diagonals, is_settled, waiting: Vec::new(), passed_by: vec![0; count], walks: 0 }
    }

    fn slot(&mut self, side: Side) -> &mut Option<Diagonal> {
        &mut self.diagonals[side.triangle as usize][usize::from(side.side)]
    }

    fn get(&self, side: Side) -> Option<Diagonal> {
        self.diagonals[side.triangle as usize][usize::from(side.side)]
    }

    /// Cuts the wall over a side, seen from both triangles.
    fn cut(&mut self, side: Side, diagonal: Diagonal) {
        *self.slot(side) = Some(diagonal);
        if let Some(other) = self.walls.across(side) {
            *self.slot(other) = Some(-diagonal);
        }
    }

    fn settle_if_mixed(&mut self, triangle: u32) {
        let has = |diagonal| self.diagonals[triangle as usize].contains(&Some(diagonal));
        if has(Diagonal::Rising) && has(Diagonal::Falling) && !self.is_settled[triangle as usize] {
            self.is_settled[triangle as usize] = true;
            self.waiting.push(triangle);
        }
    }

    /// Grows ears from settled triangles until everything that is connected with them is settled.
    fn grow(&mut self) {
        while let Some(triangle) = self.waiting.pop() {
            for side in (0..3).map(|side| Side { triangle, side }) {
                if let (None, Some(entry)) = (self.get(side), self.walls.across(side)) {
                    self.grow_ear(entry);
                }
            }
        }
    }

    /// Walks from a triangle that is settled into the side `entry` of another, to an end.
    fn grow_ear(&mut self, entry: Side) {
        let (entries, end) = self.walk(entry);
        let diagonal = match end {
            End::Prescribed(diagonal) => -diagonal,
            End::Open | End::Free(_) => Diagonal::Rising,
        };
        for &entry in &entries {
            self.cut(entry, diagonal);
        }
        if let End::Free(side) = end {
            self.cut(side, -diagonal);
        }
        for entry in entries {
            self.settle_if_mixed(entry.triangle);
        }
    }

    /// The sides by which the walk enters triangles, and its end.
    fn walk(&mut self, first: Side) -> (Vec<Side>, End) {
        self.walks += 1;
        let mut entries = vec![first];
        let mut entry = first;
        loop {
            let triangle = entry.triangle as usize;
            // Of a triangle of its own, the walk has entered and left it before: the way round is a cycle.
            if self.is_settled[triangle] || self.passed_by[triangle] == self.walks {
                return (entries, End::Open);
            }
            self.passed_by[triangle] = self.walks;
            let others = entry.others();
            if let Some(diagonal) = others.iter().find_map(|&side| self.get(side)) {
                return (entries, End::Prescribed(diagonal));
            }
            if let Some(&side) = others.iter().find(|&&side| self.walls.across(side).is_none()) {
                return (entries, End::Free(side));
            }
            // Neither of the others is at the boundary.
            let Some(next) = self.walls.across(others[0]) else { return (entries, End::Free(others[0])) };
            entries.push(next);
            entry = next;
        }
    }

    /// Settles the first triangles of a component: a cycle, or a path between boundary sides.
    fn start(&mut self, triangle: u32) -> Result<(), Obstruction> {
        let component = Component::of(self.walls, triangle);
        let (from, to, closing) = match component.closing {
            // Round the cycle: across the side that closes it, and back without it.
            Some((side, other)) => (other, side, Some(side)),
            None => {
                let (from, to) = self.ends(component)?;
                (from, to, None)
            }
        };
        let diagonal = self.get(from).unwrap_or(Diagonal::Rising);
        self.cut(from, diagonal);
        self.cut(to, -diagonal);
        let path = path_between(self.walls, from.triangle, to.triangle, closing);
        debug_assert!(path.is_some(), "a component falls apart");
        for exit in path.unwrap_or_default() {
            self.cut(exit, -diagonal);
            self.settle_if_mixed(exit.triangle);
        }
        self.settle_if_mixed(to.triangle);
        Ok(())
    }

    /// Two boundary sides of a component that can be cut in different ways.
    fn ends(&self, component: Component) -> Result<(Side, Side), Obstruction> {
        let find = |diagonal| component.open.iter().copied().find(|&side| self.get(side) == diagonal);
        let known = [Diagonal::Rising, Diagonal::Falling].map(|diagonal| find(Some(diagonal)));
        match (known, find(None)) {
            ([Some(rising), Some(falling)], _) => Ok((rising, falling)),
            ([Some(side), None] | [None, Some(side)], Some(free)) => Ok((side, free)),
            ([None, None], Some(free)) => {
                let other = component.open.iter().copied().find(|&side| side != free);
                Ok((other.unwrap_or(free), free))
            }
            ([rising, _], None) => {
                let diagonal = if rising.is_some() { Diagonal::Rising } else { Diagonal::Falling };
                Err(Obstruction { triangles: component.triangles, diagonal })
            }
        }
    }

    /// All diagonals; sides that are still open are those of triangles that have both kinds.
    fn finished(mut self) -> Vec<[Diagonal; 3]> {
        for side in self.walls.sides() {
            if self.get(side).is_none() {
                self.cut(side, Diagonal::Rising);
            }
        }
        let complete = |sides: &[Option<Diagonal>; 3]| sides.map(|side| side.unwrap_or(Diagonal::Rising));
        let pattern: Vec<_> = self.diagonals.iter().map(complete).collect();
        debug_assert!(pattern.iter().all(|sides| sides.iter().any(|&side| side != sides[0])), "a prism is twisted");
        pattern
    }
}
