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

use super::walls::{Side, Walls};
use std::collections::VecDeque;
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

/// Triangles that are connected across sides.
struct Component {
    triangles: Vec<u32>,
    /// Its boundary sides.
    open: Vec<Side>,
    /// A side that closes a cycle, seen from both triangles, if there is one.
    closing: Option<(Side, Side)>,
}

impl Component {
    fn of(walls: &Walls, first: u32) -> Self {
        let mut component = Self { triangles: vec![first], open: Vec::new(), closing: None };
        let mut entries = std::collections::HashMap::from([(first, None)]);
        let mut next = 0;
        while let Some(&triangle) = component.triangles.get(next) {
            next += 1;
            for side in (0..3).map(|side| Side { triangle, side }) {
                match walls.across(side) {
                    None => component.open.push(side),
                    Some(other) if entries.contains_key(&other.triangle) => {
                        let is_tree_edge = entries[&triangle] == Some(side) || entries[&other.triangle] == Some(other);
                        if !is_tree_edge {
                            component.closing = Some((side, other));
                            return component;
                        }
                    }
                    Some(other) => {
                        entries.insert(other.triangle, Some(other));
                        component.triangles.push(other.triangle);
                    }
                }
            }
        }
        component
    }
}

/// The sides by which a shortest path leaves triangles, from the first to before the last.
fn path_between(walls: &Walls, from: u32, to: u32, avoided: Option<Side>) -> Option<Vec<Side>> {
    let avoided_from_behind = avoided.and_then(|side| walls.across(side));
    // Found from the end, so that each triangle knows the side that leads on.
    let mut exits = std::collections::HashMap::new();
    let mut waiting = VecDeque::from([to]);
    while let Some(triangle) = waiting.pop_front() {
        if triangle == from {
            break;
        }
        for side in (0..3).map(|side| Side { triangle, side }) {
            let is_avoided = Some(side) == avoided || Some(side) == avoided_from_behind;
            let Some(other) = walls.across(side).filter(|_| !is_avoided) else { continue };
            if other.triangle != to && !exits.contains_key(&other.triangle) {
                exits.insert(other.triangle, other);
                waiting.push_back(other.triangle);
            }
        }
    }
    let mut path = Vec::new();
    let mut here = from;
    while here != to {
        let &exit = exits.get(&here)?;
        path.push(exit);
        here = walls.across(exit)?.triangle;
    }
    Some(path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A connected surface of `count` triangles: each is glued by one side to an earlier one; then some more sides.
    fn random_surface(count: usize, seeds: &[u32]) -> Walls {
        let mut walls =
            Walls::new(&(0..count as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect::<Vec<_>>()).unwrap();
        for triangle in 1..count as u32 {
            let open: Vec<_> = walls.open_sides().filter(|side| side.triangle < triangle).collect();
            let place = seeds[triangle as usize] as usize;
            walls.join(open[place % open.len()], Side::new(triangle, (place % 3) as u8));
        }
        for &seed in seeds.iter().skip(count) {
            let open: Vec<_> = walls.open_sides().collect();
            let (a, b) = (seed as usize % 97 % open.len().max(1), seed as usize / 97 % open.len().max(1));
            if open.len() > 4 && open[a].triangle != open[b].triangle {
                walls.join(open[a], open[b]);
            }
        }
        walls
    }

    fn is_valid(walls: &Walls, prescribed: &[(Side, Diagonal)], pattern: &[[Diagonal; 3]]) -> bool {
        let at = |side: Side| pattern[side.triangle as usize][usize::from(side.side)];
        let agree = walls.sides().all(|side| walls.across(side).is_none_or(|other| at(other) == -at(side)));
        let mixed = pattern.iter().all(|sides| sides.iter().any(|&side| side != sides[0]));
        agree && mixed && prescribed.iter().all(|&(side, diagonal)| at(side) == diagonal)
    }

    /// Whether any of all assignments is a pattern.
    fn has_pattern(walls: &Walls, prescribed: &[(Side, Diagonal)]) -> bool {
        let fixed = |side| prescribed.iter().any(|&(other, _)| other == side);
        let chosen: Vec<_> =
            walls.sides().filter(|&side| !fixed(side) && walls.across(side).is_none_or(|other| side < other)).collect();
        (0..1_u32 << chosen.len()).any(|bits| {
            let mut pattern = vec![[Diagonal::Rising; 3]; walls.len()];
            let free = chosen
                .iter()
                .enumerate()
                .map(|(bit, &side)| (side, if bits >> bit & 1 == 1 { Diagonal::Rising } else { Diagonal::Falling }));
            for (side, diagonal) in free.chain(prescribed.iter().copied()) {
                pattern[side.triangle as usize][usize::from(side.side)] = diagonal;
                if let Some(other) = walls.across(side) {
                    pattern[other.triangle as usize][usize::from(other.side)] = -diagonal;
                }
            }
            is_valid(walls, prescribed, &pattern)
        })
    }

    fn prescriptions(walls: &Walls, kind: u32, seeds: &[u32]) -> Vec<(Side, Diagonal)> {
        let diagonal = |seed: u32| if seed.is_multiple_of(2) { Diagonal::Rising } else { Diagonal::Falling };
        let all = walls.open_sides().zip(seeds.iter().cycle().skip(3));
        match kind {
            0 => all.map(|(side, &seed)| (side, diagonal(seed / 5))).collect(),
            1 => all.map(|(side, _)| (side, diagonal(seeds[0]))).collect(),
            2 => Vec::new(),
            _ => all.filter(|&(_, seed)| seed % 3 != 0).map(|(side, &seed)| (side, diagonal(seed / 7))).collect(),
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// A pattern is found exactly when brute force finds one, and an obstruction is minimal.
        #[test]
        fn patterns_are_found_whenever_there_are_any(
            count in 1_usize..6, kind in 0_u32..4, seeds in prop::collection::vec(0_u32..100_000, 6..9),
        ) {
            let walls = random_surface(count, &seeds);
            let prescribed = prescriptions(&walls, kind, &seeds);
            match cutting_pattern(&walls, &prescribed) {
                Ok(pattern) => prop_assert!(is_valid(&walls, &prescribed, &pattern)),
                Err(obstruction) => {
                    prop_assert!(!has_pattern(&walls, &prescribed));
                    for &left_out in &obstruction.triangles {
                        let rest: Vec<_> = prescribed.iter().copied().filter(|(side, _)| side.triangle != left_out).collect();
                        let mut without = walls.clone();
                        (0..3).for_each(|side| without.cut(Side::new(left_out, side)));
                        prop_assert!(has_pattern(&without, &rest));
                    }
                }
            }
        }
    }

    #[test]
    fn both_answers_occur_in_the_random_surfaces() {
        // The property above would hold for an empty set of obstructions, too.
        let mut found = [0, 0];
        for seed in 0..2000_u32 {
            let seeds: Vec<_> =
                (0..8).map(|i| seed.wrapping_mul(2_654_435_761).wrapping_add(i * 40_503) % 99_991).collect();
            let walls = random_surface(1 + seed as usize % 5, &seeds);
            let answer = cutting_pattern(&walls, &prescriptions(&walls, seed % 4, &seeds));
            found[usize::from(answer.is_err())] += 1;
        }
        assert!(found[0] > 1000 && found[1] > 50, "{found:?}");
    }

    #[test]
    fn a_fan_without_a_vertex_inside_is_an_obstruction_and_with_one_is_none() {
        let fan: Vec<_> = (1..7).map(|i| [0, i, i + 1]).collect();
        let walls = Walls::new(&fan).unwrap();
        let rising: Vec<_> = walls.open_sides().map(|side| (side, Diagonal::Rising)).collect();
        assert_eq!(cutting_pattern(&walls, &rising).unwrap_err().triangles.len(), 6);
        let closed = Walls::new(&[fan, vec![[0, 7, 1]]].concat()).unwrap();
        let rising: Vec<_> = closed.open_sides().map(|side| (side, Diagonal::Rising)).collect();
        let pattern = cutting_pattern(&closed, &rising).unwrap();
        assert!(is_valid(&closed, &rising, &pattern));
    }
}
