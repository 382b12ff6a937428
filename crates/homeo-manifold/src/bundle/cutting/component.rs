//! Triangles that are connected across sides: whether a cycle passes them, and paths between them.

use super::super::walls::{Side, Walls};
use std::collections::{HashMap, VecDeque};

/// Triangles that are connected across sides.
pub(super) struct Component {
    pub triangles: Vec<u32>,
    /// Its boundary sides.
    pub open: Vec<Side>,
    /// A side that closes a cycle, seen from both triangles, if there is one.
    pub closing: Option<(Side, Side)>,
}

impl Component {
    pub fn of(walls: &Walls, first: u32) -> Self {
        let mut component = Self { triangles: vec![first], open: Vec::new(), closing: None };
        let mut entries = HashMap::from([(first, None)]);
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
pub(super) fn path_between(walls: &Walls, from: u32, to: u32, avoided: Option<Side>) -> Option<Vec<Side>> {
    let avoided_from_behind = avoided.and_then(|side| walls.across(side));
    // Found from the end, so that each triangle knows the side that leads on.
    let mut exits = HashMap::new();
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
