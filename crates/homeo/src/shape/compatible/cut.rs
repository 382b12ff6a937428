//! Where a region between two rings is cut open.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use homeo_core::planar::Point2;

use super::region::{Region, edges};

/// Ways through a triangulated region: over middles of edges, from one to the next through a triangle.
struct Ways<'a> {
    points: &'a [Point2],
    /// Inner edges with the two corners opposite to them.
    inner: Vec<([u32; 2], [u32; 2])>,
    /// Inner edges that have a vertex opposite to them.
    seen_from: BTreeMap<u32, Vec<usize>>,
    numbers: BTreeMap<[u32; 2], usize>,
}

/// Shortest ways from one vertex.
struct Tree {
    from: u32,
    /// Length of the way to the middle of each inner edge, and the edge before.
    reached: Vec<(f64, Option<usize>)>,
}

impl<'a> Ways<'a> {
    fn new(points: &'a [Point2], triangles: &[[u32; 3]]) -> Self {
        let inner: Vec<([u32; 2], [u32; 2])> = edges(triangles)
            .into_iter()
            .filter_map(|(ends, opposite)| Some((ends, <[u32; 2]>::try_from(opposite).ok()?)))
            .collect();
        let numbers = inner.iter().enumerate().map(|(number, (ends, _))| (*ends, number)).collect();
        let mut seen_from: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (number, (_, opposite)) in inner.iter().enumerate() {
            opposite.iter().for_each(|&corner| seen_from.entry(corner).or_default().push(number));
        }
        Self { points, inner, seen_from, numbers }
    }

    fn middle(&self, edge: usize) -> Point2 {
        let [a, b] = self.inner[edge].0.map(|vertex| self.points[vertex as usize]);
        [0, 1].map(|axis| 0.5 * (a[axis] + b[axis]))
    }

    fn seen_from(&self, vertex: u32) -> &[usize] {
        self.seen_from.get(&vertex).map_or(&[], Vec::as_slice)
    }

    /// Inner edges that share a triangle with one.
    fn next_to(&self, edge: usize) -> impl Iterator<Item = usize> + '_ {
        let (ends, opposite) = self.inner[edge];
        let sides = opposite.into_iter().flat_map(move |apex| ends.map(|end| [end.min(apex), end.max(apex)]));
        sides.filter_map(|side| self.numbers.get(&side).copied())
    }

    /// Dijkstra's algorithm.
    fn tree(&self, from: u32) -> Tree {
        let mut reached = vec![(f64::INFINITY, None); self.inner.len()];
        let mut queue = BinaryHeap::new();
        // Lengths are positive: their bits are in the order of their values.
        let key = |length: f64| Reverse(length.to_bits());
        for &edge in self.seen_from(from) {
            let length = distance(self.points[from as usize], self.middle(edge));
            reached[edge] = (length, None);
            queue.push((key(length), edge));
        }
        while let Some((Reverse(bits), edge)) = queue.pop() {
            let length = f64::from_bits(bits);
            if length > reached[edge].0 {
                continue;
            }
            for next in self.next_to(edge) {
                let longer = length + distance(self.middle(edge), self.middle(next));
                if longer < reached[next].0 {
                    reached[next] = (longer, Some(edge));
                    queue.push((key(longer), next));
                }
            }
        }
        Tree { from, reached }
    }

    /// Length of the shortest way to a vertex, and the last edge on it: none where an edge leads there.
    fn last(&self, tree: &Tree, to: u32) -> (f64, Option<usize>) {
        let end = self.points[to as usize];
        if self.numbers.contains_key(&[tree.from.min(to), tree.from.max(to)]) {
            return (distance(self.points[tree.from as usize], end), None);
        }
        let longer = |&edge: &usize| (tree.reached[edge].0 + distance(self.middle(edge), end), Some(edge));
        let ways = self.seen_from(to).iter().map(longer);
        ways.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, None))
    }

    /// The points on the way before its end.
    fn way(&self, tree: &Tree, mut last: Option<usize>) -> Vec<Point2> {
        let mut points = Vec::new();
        while let Some(edge) = last {
            points.push(self.middle(edge));
            last = tree.reached[edge].1;
        }
        points.reverse();
        points
    }
}

/// A cut from the outer to the inner ring, in both drawings.
pub(super) struct Cut {
    /// Vertex of the outer ring.
    pub from: u32,
    /// Vertex of the inner ring.
    pub to: u32,
    /// Points between, as many in both.
    pub between: [Vec<Point2>; 2],
}

/// The cut between two vertices that is shortest in both drawings together; none where no way leads through.
pub(super) fn cut(region: &Region, points: [&[Point2]; 2], triangles: [&[[u32; 3]]; 2]) -> Option<Cut> {
    let inner = region.inner.as_ref()?;
    let ways = [0, 1].map(|side| Ways::new(points[side], triangles[side]));
    let mut best: Option<(f64, Cut)> = None;
    for &from in &region.outer {
        let trees = [0, 1].map(|side| ways[side].tree(from));
        for &to in inner {
            let last = [0, 1].map(|side| ways[side].last(&trees[side], to));
            let length = last[0].0 + last[1].0;
            if length < best.as_ref().map_or(f64::INFINITY, |found| found.0) {
                let between = [0, 1].map(|side| ways[side].way(&trees[side], last[side].1));
                best = Some((length, Cut { from, to, between }));
            }
        }
    }
    let mut cut = best?.1;
    let count = cut.between.iter().map(Vec::len).max()?;
    for (between, points) in cut.between.iter_mut().zip(points) {
        divide(points[cut.from as usize], between, points[cut.to as usize], count);
    }
    Some(cut)
}

/// Halves the longest parts of a way until there are so many points between its ends.
fn divide(from: Point2, between: &mut Vec<Point2>, to: Point2, count: usize) {
    while between.len() < count {
        let place = |i: usize| match i.checked_sub(1) {
            None => from,
            Some(before) => between.get(before).copied().unwrap_or(to),
        };
        let length = |&i: &usize| distance(place(i), place(i + 1));
        let longest = (0..=between.len()).max_by(|i, j| length(i).total_cmp(&length(j))).unwrap_or(0);
        let middle = [0, 1].map(|axis| 0.5 * (place(longest)[axis] + place(longest + 1)[axis]));
        between.insert(longest, middle);
    }
}

fn distance([a, b]: Point2, [c, d]: Point2) -> f64 {
    (c - a).hypot(d - b)
}
