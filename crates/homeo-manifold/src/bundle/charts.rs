//! Where a closed surface is cut so that disks are left: two for a sphere, one otherwise.

use super::circle::BundleError;
use super::walls::{Side, Walls};
use std::collections::{BTreeMap, VecDeque};

/// Paths along edges of the surface, each given by its vertices.
///
/// Two paths meet at most at their ends. Cut open along all of them the surface is one disk, or two if it is a sphere;
/// the only path then returns to its start.
pub(super) type Cuts = Vec<Vec<u32>>;

/// The cuts of a closed connected surface. Linear cost, but for a logarithm.
///
/// # Errors
/// A triangle that is at the boundary or is not connected with the first.
pub(super) fn cuts(triangles: &[[u32; 3]], walls: &Walls) -> Result<Cuts, BundleError> {
    if let Some(side) = walls.open_sides().next() {
        return Err(BundleError::Open { triangle: side.triangle });
    }
    let left_over = sides_off_the_tree(walls)?;
    let mut graph = Graph::default();
    for side in left_over {
        let [from, to] = ends(triangles, side);
        graph.join(from, to);
    }
    graph.prune();
    Ok(if graph.is_empty() { vec![equator(triangles, walls)] } else { graph.paths() })
}

/// The vertices that a side runs from and to.
pub(super) fn ends(triangles: &[[u32; 3]], side: Side) -> [u32; 2] {
    let corners = triangles[side.triangle as usize];
    [corners[usize::from(side.side)], corners[usize::from(side.side + 1) % 3]]
}

/// The sides that a breadth-first tree of all triangles does not cross, each once.
fn sides_off_the_tree(walls: &Walls) -> Result<Vec<Side>, BundleError> {
    let mut entries: Vec<Option<Side>> = vec![None; walls.len()];
    let mut is_reached = vec![false; walls.len()];
    let mut waiting = VecDeque::new();
    if let Some(first) = is_reached.first_mut() {
        *first = true;
        waiting.push_back(0);
    }
    while let Some(triangle) = waiting.pop_front() {
        for side in (0..3).map(|side| Side { triangle, side }) {
            let Some(other) = walls.across(side) else { continue };
            if !std::mem::replace(&mut is_reached[other.triangle as usize], true) {
                entries[other.triangle as usize] = Some(other);
                waiting.push_back(other.triangle);
            }
        }
    }
    if let Some(triangle) = is_reached.iter().position(|&is_reached| !is_reached) {
        return Err(BundleError::Apart { triangle: triangle as u32 });
    }
    let is_entry = |side: Side| entries[side.triangle as usize] == Some(side);
    let is_off =
        |&side: &Side| walls.across(side).is_some_and(|other| side < other && !is_entry(side) && !is_entry(other));
    Ok(walls.sides().filter(is_off).collect())
}

/// A graph whose nodes are vertices of the surface.
#[derive(Default)]
struct Graph {
    // In order, so that the paths do not depend on anything but the surface.
    neighbours: BTreeMap<u32, Vec<u32>>,
}

impl Graph {
    fn join(&mut self, a: u32, b: u32) {
        self.neighbours.entry(a).or_default().push(b);
        self.neighbours.entry(b).or_default().push(a);
    }

    fn is_empty(&self) -> bool {
        self.neighbours.is_empty()
    }

    /// Takes away edges with a free end until there are none.
    fn prune(&mut self) {
        let mut ends: Vec<u32> =
            self.neighbours.iter().filter(|(_, to)| to.len() == 1).map(|(&node, _)| node).collect();
        while let Some(end) = ends.pop() {
            for neighbour in self.neighbours.remove(&end).unwrap_or_default() {
                let Some(others) = self.neighbours.get_mut(&neighbour) else { continue };
                others.retain(|&other| other != end);
                if others.len() == 1 {
                    ends.push(neighbour);
                }
            }
        }
        self.neighbours.retain(|_, to| !to.is_empty());
    }

    /// The paths between nodes of three neighbours and more.
    fn paths(&self) -> Cuts {
        let mut paths = Vec::new();
        for (&node, neighbours) in self.neighbours.iter().filter(|(_, to)| to.len() > 2) {
            for &second in neighbours {
                let path = self.path(node, second);
                // Each is found from both ends; one that returns to its start in both directions.
                let behind = path.len() - 2;
                if (path[0], path[1]) < (path[path.len() - 1], path[behind]) {
                    paths.push(path);
                }
            }
        }
        paths
    }

    fn path(&self, first: u32, second: u32) -> Vec<u32> {
        let mut path = vec![first, second];
        while let [.., before, here] = path[..]
            && let [a, b] = self.neighbours[&here][..]
        {
            path.push(if a == before { b } else { a });
        }
        path
    }
}

/// A closed path along edges of a sphere with a disk of about half of the triangles on its left.
///
/// The disk grows by triangles that meet it in one side and no other vertex, or in two sides. Triangulated spheres are
/// extendably shellable (Danaraj and Klee 1978): it does not get stuck.
fn equator(triangles: &[[u32; 3]], walls: &Walls) -> Vec<u32> {
    let mut is_inside = vec![false; triangles.len()];
    let mut is_touched = std::collections::HashSet::new();
    let mut waiting = VecDeque::from([0]);
    let mut count = 0;
    while let Some(triangle) = waiting.pop_front() {
        if 2 * count >= triangles.len() {
            break;
        }
        let sides = [0, 1, 2].map(|side| Side { triangle, side });
        let is_open = |side: &Side| walls.across(*side).is_none_or(|other| !is_inside[other.triangle as usize]);
        let free = match sides.iter().filter(|side| !is_open(side)).count() {
            // The vertex opposite the only side that the disk has.
            1 => sides.iter().position(|side| !is_open(side)).map(|side| triangles[triangle as usize][(side + 2) % 3]),
            _ => None,
        };
        let grows = match sides.iter().filter(|side| is_open(side)).count() {
            3 => count == 0,
            2 => free.is_some_and(|vertex| !is_touched.contains(&vertex)),
            1 => true,
            _ => false,
        };
        if is_inside[triangle as usize] || !grows {
            continue;
        }
        is_inside[triangle as usize] = true;
        count += 1;
        is_touched.extend(triangles[triangle as usize]);
        waiting.extend(sides.iter().filter_map(|&side| walls.across(side)).map(|other| other.triangle));
    }
    debug_assert!(2 * count >= triangles.len(), "the disk is stuck at {count} of {} triangles", triangles.len());
    boundary_of(triangles, walls, &is_inside)
}

/// The boundary of a disk of triangles, which it has on its left; the first vertex again at the end.
fn boundary_of(triangles: &[[u32; 3]], walls: &Walls, is_inside: &[bool]) -> Vec<u32> {
    let is_at_boundary = |&side: &Side| {
        is_inside[side.triangle as usize] && walls.across(side).is_none_or(|other| !is_inside[other.triangle as usize])
    };
    let next: BTreeMap<u32, u32> =
        walls.sides().filter(is_at_boundary).map(|side| ends(triangles, side).into()).collect();
    let mut path: Vec<u32> = next.keys().copied().take(1).collect();
    while let Some(&here) = path.last()
        && (path.len() == 1 || here != path[0])
        && path.len() <= next.len()
    {
        path.push(next[&here]);
    }
    path
}

#[cfg(test)]
mod tests {
    use super::super::surfaces::{glued_handles, torus};
    use super::*;

    /// The number of disks that are left, and whether the paths meet at their ends only.
    fn pieces(triangles: &[[u32; 3]]) -> (usize, bool) {
        let mut walls = Walls::new(triangles).unwrap();
        let cuts = cuts(triangles, &walls).unwrap();
        let sides = super::super::walls::sides_by_ends(triangles).unwrap();
        for step in cuts.iter().flat_map(|path| path.windows(2)) {
            walls.cut(sides[&[step[0], step[1]]]);
        }
        let inner: Vec<_> = cuts.iter().flat_map(|path| &path[1..path.len() - 1]).copied().collect();
        let mut distinct = inner.clone();
        distinct.sort_unstable();
        distinct.dedup();
        let nodes: Vec<_> = cuts.iter().flat_map(|path| [path[0], path[path.len() - 1]]).collect();
        let apart = distinct.len() == inner.len() && nodes.iter().all(|node| !inner.contains(node));
        (super::super::surfaces::disks(triangles, &walls), apart)
    }

    #[test]
    fn cuts_leave_disks() {
        let octahedron: Vec<_> = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]).collect();
        assert_eq!(pieces(&octahedron), (2, true));
        assert_eq!(pieces(&torus(5, 4)), (1, true));
        for genus in 2..5 {
            assert_eq!(pieces(&glued_handles(genus)), (1, true), "genus {genus}");
        }
    }

    #[test]
    fn surfaces_that_are_open_or_in_pieces_are_told() {
        let open = [[0, 1, 2]];
        assert_eq!(cuts(&open, &Walls::new(&open).unwrap()), Err(BundleError::Open { triangle: 0 }));
        let two: Vec<_> =
            [0, 9].iter().flat_map(|first| torus(3, 3).into_iter().map(move |t| t.map(|v| v + first))).collect();
        assert_eq!(cuts(&two, &Walls::new(&two).unwrap()), Err(BundleError::Apart { triangle: 18 }));
    }
}
