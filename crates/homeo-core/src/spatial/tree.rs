//! A binary tree over boxes, split at the median.

use super::Aabb;

/// How many boxes a leaf holds at most.
const LEAF: usize = 4;

/// A part of the tree: its hull and what it holds.
#[derive(Clone, Copy, Debug)]
struct Node {
    hull: Aabb,
    /// The boxes `order[start..end]` lie below this node.
    start: u32,
    end: u32,
    /// The right child; the left one follows the node itself. 0 for a leaf.
    right: u32,
}

impl Node {
    fn is_leaf(&self) -> bool {
        self.right == 0
    }
}

/// A tree over boxes, for overlap and point queries.
///
/// # Guarantee
/// A query visits every box that meets what was asked for, exactly once, in an order that depends
/// on the boxes alone. Boxes with a bound that is not a number are never visited.
///
/// ```
/// use homeo_core::spatial::{Aabb, Tree};
/// let boxes = [[0.0; 3], [1.0; 3], [2.0; 3]].map(|low| Aabb { low, high: low.map(|x| x + 0.5) });
/// let tree = Tree::new(&boxes);
/// let mut found = Vec::new();
/// tree.query_point([1.2; 3], |index| found.push(index));
/// assert_eq!(found, [1]);
/// ```
#[derive(Clone, Debug)]
pub struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    boxes: Vec<Aabb>,
}

impl Tree {
    /// The tree over `boxes`, which are numbered from 0.
    ///
    /// # Complexity
    /// `O(n log n)` time, about 120 bytes for each box.
    pub fn new(boxes: &[Aabb]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..boxes.len() as u32).collect(), boxes: boxes.to_vec() };
        if !boxes.is_empty() {
            tree.nodes.reserve(boxes.len());
            tree.build(0, boxes.len());
            // Leaves then read their boxes from consecutive memory.
            tree.boxes = tree.order.iter().map(|&i| boxes[i as usize]).collect();
        }
        tree
    }

    /// How many boxes there are.
    pub fn len(&self) -> usize {
        self.boxes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.boxes.is_empty()
    }

    /// The smallest box around all boxes; an empty one if there is none.
    pub fn hull(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, |root| root.hull)
    }

    /// Builds the node over `order[start..end]` and all below it; the depth is logarithmic.
    fn build(&mut self, start: usize, end: usize) -> u32 {
        let members = &mut self.order[start..end];
        let mut hull = Aabb::EMPTY;
        let mut centres = Aabb::EMPTY;
        for &index in members.iter() {
            let member = &self.boxes[index as usize];
            hull = hull.joined(member);
            let centre = [0, 1, 2].map(|axis| member.doubled_centre(axis));
            centres = centres.joined(&Aabb { low: centre, high: centre });
        }
        let node = self.nodes.len() as u32;
        self.nodes.push(Node { hull, start: start as u32, end: end as u32, right: 0 });
        if end - start > LEAF {
            let extent = [0, 1, 2].map(|axis| centres.high[axis] - centres.low[axis]);
            let axis = (1..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
            let half = (end - start) / 2;
            let boxes = &self.boxes;
            members.select_nth_unstable_by(half, |&a, &b| {
                let [x, y] = [a, b].map(|i| boxes[i as usize].doubled_centre(axis));
                x.total_cmp(&y).then(a.cmp(&b))
            });
            self.build(start, start + half);
            self.nodes[node as usize].right = self.build(start + half, end);
        }
        node
    }

    /// Visits every box that contains `point`.
    ///
    /// # Complexity
    /// Logarithmic in the number of boxes where few of them contain the point.
    pub fn query_point(&self, point: [f64; 3], visit: impl FnMut(usize)) {
        self.query_box(&Aabb { low: point, high: point }, visit);
    }

    /// Visits every box that meets `region`.
    ///
    /// # Complexity
    /// Logarithmic in the number of boxes, and linear in the number of those visited.
    pub fn query_box(&self, region: &Aabb, mut visit: impl FnMut(usize)) {
        // Medians halve: the tree is at most 32 levels deep, and one node waits per level.
        let mut waiting = [0u32; 40];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let mut index = waiting[count];
            // Down the left children at once, leaving the right ones for later.
            loop {
                let node = &self.nodes[index as usize];
                if !node.hull.meets(region) {
                    break;
                }
                if node.is_leaf() {
                    for slot in node.start as usize..node.end as usize {
                        if self.boxes[slot].meets(region) {
                            visit(self.order[slot] as usize);
                        }
                    }
                    break;
                }
                waiting[count] = node.right;
                count += 1;
                index += 1;
            }
        }
    }

    /// Visits every pair of distinct boxes that meet, once, until `visit` asks to stop.
    ///
    /// The lower number comes first. Returns whether all pairs were visited.
    ///
    /// # Complexity
    /// `O(n log n)` and linear in the number of pairs, for boxes of similar size.
    pub fn overlapping_pairs(&self, mut visit: impl FnMut(usize, usize) -> std::ops::ControlFlow<()>) -> bool {
        let mut stack = Vec::with_capacity(128);
        if !self.nodes.is_empty() {
            stack.push((0u32, 0u32));
        }
        while let Some((first, second)) = stack.pop() {
            let [a, b] = [first, second].map(|i| &self.nodes[i as usize]);
            if first == second {
                if !a.is_leaf() {
                    stack.extend([(first + 1, a.right), (a.right, a.right), (first + 1, first + 1)]);
                    continue;
                }
            } else if !a.hull.meets(&b.hull) {
                continue;
            }
            // Descend in the larger of the two, so that hulls of similar size are compared.
            if !a.is_leaf() && (b.is_leaf() || a.end - a.start >= b.end - b.start) {
                stack.extend([(a.right, second), (first + 1, second)]);
            } else if !b.is_leaf() {
                stack.extend([(first, b.right), (first, second + 1)]);
            } else if self.leaf_pairs(a, b, &mut visit).is_break() {
                return false;
            }
        }
        true
    }

    /// Pairs between two leaves, or inside one.
    fn leaf_pairs(
        &self,
        a: &Node,
        b: &Node,
        visit: &mut impl FnMut(usize, usize) -> std::ops::ControlFlow<()>,
    ) -> std::ops::ControlFlow<()> {
        for i in a.start..a.end {
            let from = if a.start == b.start { i + 1 } else { b.start };
            for j in from..b.end {
                if self.boxes[i as usize].meets(&self.boxes[j as usize]) {
                    let [p, q] = [i, j].map(|slot| self.order[slot as usize] as usize);
                    visit(p.min(q), p.max(q))?;
                }
            }
        }
        std::ops::ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ops::ControlFlow;

    /// Boxes on a coarse grid, so that many of them touch.
    fn scattered(count: usize) -> Vec<Aabb> {
        let mut state = 7u64;
        let mut next = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % below) as f64
        };
        (0..count)
            .map(|_| {
                let low = [next(12), next(12), next(12)];
                Aabb { low, high: low.map(|x| x + next(4)) }
            })
            .collect()
    }

    #[test]
    fn pairs_agree_with_all_against_all() {
        for count in [0, 1, 4, 5, 9, 200] {
            let boxes = scattered(count);
            let mut found = Vec::new();
            let complete = Tree::new(&boxes).overlapping_pairs(|a, b| {
                found.push((a, b));
                ControlFlow::Continue(())
            });
            found.sort_unstable();
            let naive: Vec<_> = (0..count)
                .flat_map(|a| (a + 1..count).map(move |b| (a, b)))
                .filter(|&(a, b)| boxes[a].meets(&boxes[b]))
                .collect();
            assert!(complete);
            assert_eq!(found, naive);
        }
    }

    #[test]
    fn the_search_stops_when_asked() {
        let boxes = [Aabb { low: [0.0; 3], high: [1.0; 3] }; 40];
        let mut seen = 0;
        let complete = Tree::new(&boxes).overlapping_pairs(|_, _| {
            seen += 1;
            if seen == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(!complete);
        assert_eq!(seen, 3);
    }

    #[test]
    fn points_and_regions_agree_with_all() {
        let boxes = scattered(300);
        let tree = Tree::new(&boxes);
        for probe in scattered(40) {
            let mut found = Vec::new();
            tree.query_box(&probe, |i| found.push(i));
            found.sort_unstable();
            assert_eq!(found, (0..boxes.len()).filter(|&i| boxes[i].meets(&probe)).collect::<Vec<_>>());
            found.clear();
            tree.query_point(probe.low, |i| found.push(i));
            found.sort_unstable();
            assert_eq!(found, (0..boxes.len()).filter(|&i| boxes[i].contains(probe.low)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_bound_that_is_no_number_does_no_harm() {
        let mut boxes = scattered(30);
        boxes[3].low[1] = f64::NAN;
        boxes[9] = Aabb::EMPTY;
        let tree = Tree::new(&boxes);
        tree.query_box(&Aabb { low: [-1.0; 3], high: [99.0; 3] }, |i| assert!(i != 3 && i != 9));
    }
}
