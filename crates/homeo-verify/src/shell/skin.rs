//! Rules E1 and E2: a shell that claims not to overlap itself anywhere in space.
//!
//! Its *skin* are the bottoms, the tops and the walls over boundary edges. If the skin does not cross or touch itself, and the
//! shell covers it once, the shell covers every point once at most.

use super::{Corner, Shell, edge, try_weights};
use crate::complex::UnionFind;
use crate::triangles::{BoxTree, Triangle, bounds, do_clash};
use crate::verdict::{Checked, check};
use std::collections::BTreeMap;

/// A triangle of the skin by its corners, and its prism.
type Face = ([Corner; 3], usize);

impl Shell<'_> {
    /// E1 and E2. Returns the number of triangles of the skin.
    pub(super) fn check_skin(&self) -> Checked<u64> {
        let faces = self.skin();
        let triangles: Vec<Triangle> = faces.iter().map(|(corners, _)| corners.map(|c| self.point(c))).collect();
        let boxes: Vec<_> = triangles.iter().map(|triangle| bounds(triangle)).collect();
        let tree = BoxTree::new(&boxes);
        for a in 0..faces.len() {
            for b in tree.meeting(&boxes[a]).into_iter().filter(|&b| b < a) {
                if do_clash([&faces[a].0, &faces[b].0], |corner| self.point(corner)) {
                    return Err(self.refuted("E1", "bottoms, tops or walls of the shell meet", faces[a].1));
                }
            }
        }
        self.check_covers(&faces, &triangles)?;
        Ok(faces.len() as u64)
    }

    /// Bottoms, tops, and the walls over boundary edges with the diagonal of the decomposition.
    fn skin(&self) -> Vec<Face> {
        let named = |(v, level): Corner| if self.is_pinched(v) { (v, 0) } else { (v, level) };
        let mut faces: Vec<Face> = vec![];
        for (q, cell) in self.prisms.cells().enumerate() {
            faces.extend([0, 2].map(|level| ([0, 1, 2].map(|i| named((cell[i], level))), q)));
        }
        for &[_, slot] in &self.boundary {
            let ends = edge(&self.prisms, slot);
            let (i, j) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            for low in [0, 1] {
                let walls = [[(i, low), (j, low), (j, low + 1)], [(i, low), (i, low + 1), (j, low + 1)]];
                faces.extend(walls.map(|wall| (wall.map(named), slot / 3)));
            }
        }
        faces.retain(|([a, b, c], _)| a != b && b != c && c != a);
        faces
    }

    /// E2: a point of each part of the skin has no other preimage in the shell. Parts are joined by edges.
    fn check_covers(&self, faces: &[Face], triangles: &[Triangle]) -> Checked {
        let mut parts = UnionFind::new(faces.len());
        let mut at_edge = BTreeMap::new();
        for (f, ([a, b, c], _)) in faces.iter().enumerate() {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let other = *at_edge.entry([from.min(to), from.max(to)]).or_insert(f);
                parts.join(f, other);
            }
        }
        let boxes: Vec<_> = (0..self.slab_count()).map(|slab| bounds(&self.slab_points(slab))).collect();
        let slabs = BoxTree::new(&boxes);
        for f in (0..faces.len()).filter(|&f| parts.find(f) == f) {
            let near = slabs.meeting(&bounds(&triangles[f]));
            try_weights(|weights| {
                let count = self.carriers_over(&triangles[f], weights, &near).len();
                let message = format!("a point of the shell's surface has {count} preimages in it");
                if count == 1 { Ok(true) } else { Err(self.refuted("E2", &message, faces[f].1)) }
            })?;
        }
        check(!faces.is_empty(), "E2", "the shell has no surface", &[], &[])
    }
}
