//! Rules Y1-Y4: the gluing is that of an oriented manifold whose cut-off vertices have negative Euler characteristic.

use super::angles::EDGES;
use crate::verdict::{Checked, check};

/// Tetrahedra whose faces are glued in pairs; rule Y1 holds.
pub(super) struct Gluing {
    /// For each face of each tetrahedron the other tetrahedron and where the corners go.
    to: Vec<(usize, [usize; 4])>,
}

/// The edges of a gluing.
pub(super) struct Edges {
    /// The edges of each tetrahedron, in the order of [`EDGES`].
    pub(super) of: Vec<[u32; 6]>,
    /// How many there are.
    pub(super) count: usize,
    /// A tetrahedron and the ends, for each edge.
    first: Vec<(usize, [usize; 2])>,
}

impl Gluing {
    /// Rule Y1: there are tetrahedra, rows are permutations, and each gluing is undone from the other side.
    pub(super) fn new(rows: &[[u32; 5]]) -> Checked<Self> {
        check(!rows.is_empty(), "Y1", "there are no tetrahedra", &[], &[])?;
        let mut to = Vec::with_capacity(rows.len());
        for (number, &[other, a, b, c, d]) in rows.iter().enumerate() {
            let mut sorted = [a, b, c, d];
            sorted.sort_unstable();
            let is_right = sorted == [0, 1, 2, 3] && (other as usize) < rows.len() / 4;
            let message = format!("face {} goes to no tetrahedron, or by no permutation", number % 4);
            check(is_right, "Y1", &message, &[number / 4], &[])?;
            to.push((other as usize, [a, b, c, d].map(|image| image as usize)));
        }
        for (number, &(other, images)) in to.iter().enumerate() {
            let (tetrahedron, face) = (number / 4, number % 4);
            let there = 4 * other + images[face];
            let (back, returned) = to[there];
            let is_undone =
                back == tetrahedron && (0..4).all(|corner| returned[images[corner]] == corner) && there != number;
            let message = format!("face {face} is glued to itself, or another way from its other side");
            check(is_undone, "Y1", &message, &[tetrahedron, other], &[])?;
        }
        Ok(Self { to })
    }

    fn count(&self) -> usize {
        self.to.len() / 4
    }

    /// All faces, tetrahedron by tetrahedron, each with the one it is glued to.
    pub(super) fn faces(&self) -> impl Iterator<Item = ((usize, usize), (usize, usize))> {
        self.to.iter().enumerate().map(|(number, &(there, images))| {
            let face = number % 4;
            ((number / 4, face), (there, images[face]))
        })
    }

    /// Rule Y3: tetrahedra can be turned so that each gluing changes the orientation of its face.
    pub(super) fn check_orientation(&self) -> Checked {
        let mut turned = vec![None; self.count()];
        for first in 0..self.count() {
            if turned[first].is_some() {
                continue;
            }
            turned[first] = Some(false);
            let mut waiting = vec![first];
            while let Some(here) = waiting.pop() {
                for &(there, images) in &self.to[4 * here..4 * here + 4] {
                    let wanted = turned[here].map(|turned: bool| turned == is_odd(images));
                    if turned[there].is_none() {
                        turned[there] = wanted;
                        waiting.push(there);
                    }
                    check(turned[there] == wanted, "Y3", "the tetrahedra cannot be oriented", &[here, there], &[])?;
                }
            }
        }
        Ok(())
    }

    /// Rule Y2: the edges, numbered as they appear; none is glued to itself end for end.
    pub(super) fn edges(&self) -> Checked<Edges> {
        const NONE: u32 = u32::MAX;
        // One place for each edge with a direction: from corner a to corner b of a tetrahedron at 16 t + 4 a + b.
        let mut class = vec![NONE; 16 * self.count()];
        let mut edges = Edges { of: vec![[0; 6]; self.count()], count: 0, first: vec![] };
        for tetrahedron in 0..self.count() {
            for (edge, [start, end]) in EDGES.into_iter().enumerate() {
                let [place, reverse] = [[start, end], [end, start]].map(|[a, b]| 16 * tetrahedron + 4 * a + b);
                let known = if class[place] == NONE { class[reverse] } else { class[place] };
                if known != NONE {
                    edges.of[tetrahedron][edge] = known;
                    continue;
                }
                let number = edges.count as u32;
                self.spread(&mut class, (tetrahedron, [start, end]), number);
                let message = format!("edge {number} is glued to itself end for end");
                check(class[reverse] == NONE, "Y2", &message, &[tetrahedron], &[])?;
                edges.of[tetrahedron][edge] = number;
                edges.first.push((tetrahedron, [start, end]));
                edges.count += 1;
            }
        }
        Ok(edges)
    }

    /// Marks all that is glued to an edge with a direction.
    fn spread(&self, class: &mut [u32], first: (usize, [usize; 2]), number: u32) {
        let mut waiting = vec![first];
        while let Some((tetrahedron, [a, b])) = waiting.pop() {
            let place = &mut class[16 * tetrahedron + 4 * a + b];
            if *place == number {
                continue;
            }
            *place = number;
            for face in (0..4).filter(|&face| face != a && face != b) {
                let (there, images) = self.to[4 * tetrahedron + face];
                waiting.push((there, [images[a], images[b]]));
            }
        }
    }

    /// Rule Y4: as many vertices as stated, each with a link of negative Euler characteristic.
    pub(super) fn check_links(&self, edges: &Edges, stated: usize) -> Checked {
        let (of, count) = self.vertices();
        check(count == stated, "Y4", &format!("there are {count} vertices, not as many as stated"), &[], &[])?;
        // Triangles less sides, three for each two triangles, plus corners: twice the Euler characteristic.
        let mut doubled = vec![0_i64; count];
        of.iter().for_each(|&vertex| doubled[vertex] -= 1);
        for &(tetrahedron, ends) in &edges.first {
            ends.into_iter().for_each(|end| doubled[of[4 * tetrahedron + end]] += 2);
        }
        for (corner, &vertex) in of.iter().enumerate() {
            let message = format!("the link of vertex {vertex} has Euler characteristic {}", doubled[vertex] / 2);
            check(doubled[vertex] < 0, "Y4", &message, &[corner / 4], &[])?;
        }
        Ok(())
    }

    /// The vertex of each corner of each tetrahedron, and how many there are.
    fn vertices(&self) -> (Vec<usize>, usize) {
        let (mut of, mut count) = (vec![usize::MAX; self.to.len()], 0);
        for first in 0..self.to.len() {
            if of[first] != usize::MAX {
                continue;
            }
            let mut waiting = vec![first];
            while let Some(place) = waiting.pop() {
                if of[place] == count {
                    continue;
                }
                of[place] = count;
                let (tetrahedron, corner) = (place / 4, place % 4);
                for face in (0..4).filter(|&face| face != corner) {
                    let (there, images) = self.to[4 * tetrahedron + face];
                    waiting.push(4 * there + images[corner]);
                }
            }
            count += 1;
        }
        (of, count)
    }
}

fn is_odd(images: [usize; 4]) -> bool {
    let inversions = EDGES.iter().filter(|[i, j]| images[*i] > images[*j]).count();
    !inversions.is_multiple_of(2)
}
