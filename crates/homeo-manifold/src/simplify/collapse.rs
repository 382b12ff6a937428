//! Edges that are contracted to points without a change of the manifold.
//!
//! # The theorem
//! Let an edge `e` join two different vertices, of which one at least has a sphere as link; let the tetrahedra round it be
//! different ones; let the graph whose nodes are edges, and which has for each triangle at `e` an arc between its other two edges, have no cycle; and
//! likewise the graph whose nodes are triangles, with an arc for each tetrahedron at `e` between its two triangles that do not contain `e`. Take
//! all these tetrahedra away and glue, for each, what was across the two triangles. The result is homeomorphic, also with
//! all vertices cut off that are not inner points.
//!
//! Proof: `docs/theory/triangulations.md`. The source merges vertices "keeping the topology" (section 4.2.2) and does not say
//! when that is so.

use super::editor::{Editor, Joined};
use crate::permutation::Permutation;
use crate::skeleton::EdgeCorner;

/// Collapses an edge onto its end `corners.image(1)`, if the theorem allows it; whether it did.
pub(super) fn collapse(editor: &mut Editor, edge: EdgeCorner, most: usize) -> bool {
    let [from, to, ..] = edge.corners.images().map(|corner| editor.vertex(edge.tetrahedron, corner));
    if from == to || editor.is_truncated(from) {
        return false;
    }
    let Some(ring) = editor.ring(edge, most) else { return false };
    let ends = [from, to];
    let keeps_some = ring.len() < editor.len();
    if !keeps_some
        || !are_different(&ring)
        || !bigons_are_trees(editor, &ring, ends)
        || !pillows_are_trees(editor, &ring, ends)
    {
        return false;
    }
    let star = editor.star(edge.tetrahedron, edge.corners.image(0));
    for corner in ring {
        flatten(editor, corner);
    }
    editor.rename(&star, to);
    true
}

fn are_different(ring: &[EdgeCorner]) -> bool {
    let mut numbers: Vec<_> = ring.iter().map(|corner| corner.tetrahedron).collect();
    numbers.sort_unstable();
    numbers.windows(2).all(|pair| pair[0] != pair[1])
}

/// Whether the triangles round the edge join their other edges without a cycle.
fn bigons_are_trees(editor: &Editor, ring: &[EdgeCorner], [from, to]: [u32; 2]) -> bool {
    let edges = |corner: &EdgeCorner| {
        let [a, b, _, third] = corner.corners.images();
        [a, b].map(|end| editor.edge_name(corner.tetrahedron, end, third))
    };
    let third = |corner: &EdgeCorner| merged(editor, corner, 3, from, to);
    are_trees(ring.iter().map(|corner| (third(corner), *corner)).collect(), edges)
}

/// Whether the tetrahedra round the edge join their other triangles without a cycle.
fn pillows_are_trees(editor: &Editor, ring: &[EdgeCorner], [from, to]: [u32; 2]) -> bool {
    let faces = |corner: &EdgeCorner| {
        let [a, b, ..] = corner.corners.images();
        [a, b].map(|face| editor.face_name(corner.tetrahedron, face))
    };
    let opposite = |corner: &EdgeCorner| {
        let [c, d] = [2, 3].map(|number| merged(editor, corner, number, from, to));
        [c.min(d), c.max(d)]
    };
    are_trees(ring.iter().map(|corner| (opposite(corner), *corner)).collect(), faces)
}

/// The vertex at a corner after the collapse.
fn merged(editor: &Editor, corner: &EdgeCorner, number: u8, from: u32, to: u32) -> u32 {
    let vertex = editor.vertex(corner.tetrahedron, corner.corners.image(number));
    if vertex == from { to } else { vertex }
}

/// Whether arcs between nodes form no cycle. Only arcs with the same key can: after the collapse all nodes of a
/// cycle have the same vertices. Nodes are expensive to name, and most keys are single; the two ends of an arc differ, as
/// they differ in a vertex.
fn are_trees<K: Ord, T: PartialEq>(mut arcs: Vec<(K, EdgeCorner)>, nodes: impl Fn(&EdgeCorner) -> [T; 2]) -> bool {
    arcs.sort_unstable_by(|a, b| a.0.cmp(&b.0));
    arcs.chunk_by(|a, b| a.0 == b.0).filter(|chunk| chunk.len() > 1).all(|chunk| {
        let mut joined = Joined::new();
        chunk.iter().map(|(_, corner)| nodes(corner)).all(|[a, b]| joined.join(a, b))
    })
}

/// Takes away a tetrahedron and glues what was across its faces opposite both ends of the edge.
fn flatten(editor: &mut Editor, corner: EdgeCorner) {
    let [a, b, ..] = corner.corners.images();
    let (beyond_a, beyond_b) = (editor.open(corner.tetrahedron, a), editor.open(corner.tetrahedron, b));
    let through = beyond_b.corners * Permutation::transposition(a, b) * beyond_a.corners.inverse();
    editor.kill(corner.tetrahedron);
    editor.glue(beyond_a.tetrahedron, beyond_a.corners.image(a), beyond_b.tetrahedron, through);
}
