//! Moves that change few tetrahedra and not the manifold: 2-3, 3-2, 4-4, 2-0 and 2-1.

use super::editor::{Editor, Joined, corner_at};
use crate::permutation::Permutation;
use crate::skeleton::EdgeCorner;
use crate::triangulation::Gluing;

/// Replaces the two tetrahedra at a face by three round a new edge, if they are different; the new ones.
pub(super) fn two_to_three(editor: &mut Editor, tetrahedron: u32, face: u8) -> Option<Vec<u32>> {
    let gluing = editor.across(tetrahedron, face);
    if gluing.tetrahedron == tetrahedron {
        return None;
    }
    // The upper tetrahedron has its corners named as they are; the lower one by those above.
    let (upper, lower, down) = (tetrahedron, gluing.tetrahedron, gluing.corners);
    let ring = (0..4).filter(|&corner| corner != face).collect::<Vec<_>>();
    let (top, bottom) = (editor.vertex(upper, face), editor.vertex(lower, down.image(face)));
    let outside: Vec<_> =
        ring.iter().map(|&c| [(upper, c), (lower, down.image(c))].map(|(t, f)| Outside::of(editor, t, f))).collect();
    let around: Vec<u32> = ring.iter().map(|&corner| editor.vertex(upper, corner)).collect();
    editor.kill(upper);
    editor.kill(lower);
    // New tetrahedra: corner 0 is the top, 1 the bottom, 2 and 3 two of the three in between; one for each that is missing.
    let new: Vec<_> = (0..3).map(|i| editor.add([top, bottom, around[(i + 1) % 3], around[(i + 2) % 3]])).collect();
    for i in 0..3 {
        // Across the face without the corner 2, the next has its corners 3 where this has 2... and the reverse.
        editor.glue(new[i], 2, new[(i + 1) % 3], Permutation::transposition(2, 3));
    }
    let mut places = Places::default();
    for i in 0..3 {
        let (missing, second, third) = (ring[i], ring[(i + 1) % 3], ring[(i + 2) % 3]);
        // The face of the upper tetrahedron without `missing` is that of the new one without the bottom.
        let from_upper = images(&[(missing, 1), (face, 0), (second, 2), (third, 3)]);
        let from_lower =
            images(&[(down.image(missing), 0), (down.image(face), 1), (down.image(second), 2), (down.image(third), 3)]);
        places.put((upper, missing), new[i], from_upper);
        places.put((lower, down.image(missing)), new[i], from_lower);
    }
    let all: Vec<_> = outside.into_iter().flatten().collect();
    places.glue(editor, &all);
    Some(new)
}

/// Replaces three different tetrahedra round an edge by two; whether it did.
pub(super) fn three_to_two(editor: &mut Editor, edge: EdgeCorner) -> bool {
    let Some(ring) = editor.ring(edge, 3) else { return false };
    let numbers: Vec<_> = ring.iter().map(|corner| corner.tetrahedron).collect();
    if ring.len() != 3 || numbers[0] == numbers[1] || numbers[1] == numbers[2] || numbers[0] == numbers[2] {
        return false;
    }
    let [start, end, ..] = edge.corners.images().map(|corner| editor.vertex(edge.tetrahedron, corner));
    // Corner 3 of one is corner 2 of the next: vertex i of the triangle between is corner 2 of tetrahedron i.
    let around: Vec<_> = ring.iter().map(|corner| editor.vertex(corner.tetrahedron, corner.corners.image(2))).collect();
    let ends = |corner: &EdgeCorner| {
        let [a, b, ..] = corner.corners.images();
        [(corner.tetrahedron, a), (corner.tetrahedron, b)]
    };
    let outside: Vec<_> = ring.iter().flat_map(ends).map(|(t, f)| Outside::of(editor, t, f)).collect();
    numbers.iter().for_each(|&number| editor.kill(number));
    // Corners 0, 1, 2 are the triangle, 3 is an end.
    let upper = editor.add([around[0], around[1], around[2], start]);
    let lower = editor.add([around[0], around[1], around[2], end]);
    editor.glue(upper, 3, lower, Permutation::IDENTITY);
    let mut places = Places::default();
    for (i, corner) in (0_u8..).zip(&ring) {
        let [a, b, c, d] = corner.corners.images();
        // Tetrahedron i has the vertices i and i + 1 of the triangle at its corners 2 and 3.
        let (here, next, other) = (i, (i + 1) % 3, (i + 2) % 3);
        places.put((corner.tetrahedron, b), upper, images(&[(a, 3), (b, other), (c, here), (d, next)]));
        places.put((corner.tetrahedron, a), lower, images(&[(b, 3), (a, other), (c, here), (d, next)]));
    }
    places.glue(editor, &outside);
    true
}

/// Replaces four different tetrahedra round an edge by four round another; whether it did.
///
/// The four form an octahedron with the edge as diagonal; the other is the one that joins the corner 3 of `edge` with the vertex
/// opposite. It is a move 2-3 at a face of the edge, which then has three tetrahedra, and a move 3-2.
pub(super) fn four_to_four(editor: &mut Editor, edge: EdgeCorner) -> bool {
    let Some(ring) = editor.ring(edge, 4) else { return false };
    let mut numbers: Vec<_> = ring.iter().map(|corner| corner.tetrahedron).collect();
    numbers.sort_unstable();
    numbers.dedup();
    if ring.len() != 4 || numbers.len() != 4 {
        return false;
    }
    // The face between the first two; the third keeps its place at the edge.
    if two_to_three(editor, edge.tetrahedron, edge.corners.image(2)).is_none() {
        return false;
    }
    let done = three_to_two(editor, ring[2]);
    debug_assert!(done, "the edge has three tetrahedra now");
    done
}

/// Flattens the two tetrahedra at an edge that has two, if this is no change of the manifold; whether it did.
///
/// The segments between the edges opposite, and between the triangles that have one end of the edge, must form no cycles;
/// compare [`super::collapse`].
pub(super) fn two_to_zero(editor: &mut Editor, edge: EdgeCorner) -> bool {
    let Some(ring) = editor.ring(edge, 2) else { return false };
    let [first, second] = ring[..] else { return false };
    if first.tetrahedron == second.tetrahedron || editor.len() == 2 {
        return false;
    }
    let opposite = |corner: &EdgeCorner| {
        let [_, _, c, d] = corner.corners.images();
        editor.edge_name(corner.tetrahedron, c, d)
    };
    let faces = [0, 1].map(|end| [first, second].map(|at| (at.tetrahedron, at.corners.image(end))));
    let mut joined = Joined::new();
    let apart = faces
        .iter()
        .all(|[one, other]| joined.join(editor.face_name(one.0, one.1), editor.face_name(other.0, other.1)));
    if !apart || opposite(&first) == opposite(&second) {
        return false;
    }
    // From the first to the second: ends to ends, and corner 2 of one is corner 3 of the other.
    let between = second.corners * Permutation::transposition(2, 3) * first.corners.inverse();
    for [one, other] in faces {
        let (beyond, behind) = (editor.open(one.0, one.1), editor.open(other.0, other.1));
        let through = behind.corners * between * beyond.corners.inverse();
        editor.glue(beyond.tetrahedron, beyond.corners.image(one.1), behind.tetrahedron, through);
    }
    editor.kill(first.tetrahedron);
    editor.kill(second.tetrahedron);
    true
}

/// Takes away an edge that only one tetrahedron has, with this tetrahedron, if that is no change of the manifold; whether it did.
///
/// The tetrahedron is glued to itself round the edge. A move 2-3 at a face that has one end of the edge gives the edge a second
/// tetrahedron, and a move 2-0 flattens the two; if it may not be made, the first move is undone.
pub(super) fn two_to_one(editor: &mut Editor, edge: EdgeCorner) -> bool {
    if editor.ring(edge, 1).is_none() {
        return false;
    }
    let [start, end, ..] = edge.corners.images();
    for (kept, off) in [(start, end), (end, start)] {
        let Some(new) = two_to_three(editor, edge.tetrahedron, off) else { continue };
        // The edge goes from corner 0 of the new ones to the corner that `kept` is now: see there.
        let place = (0..4).filter(|&corner| corner != off).position(|corner| corner == kept).unwrap_or(0);
        if two_to_zero(editor, corner_at(new[(place + 1) % 3], 0, 3)) {
            return true;
        }
        let is_undone = three_to_two(editor, corner_at(new[0], 0, 1));
        debug_assert!(is_undone, "the new edge has three tetrahedra");
        // It has other names now.
        return false;
    }
    false
}

/// The move with two tetrahedra more or fewer that an edge of a tetrahedron allows, if any reduces their number.
pub(super) fn reduce_at(editor: &mut Editor, tetrahedron: u32, a: u8, b: u8) -> bool {
    let edge = corner_at(tetrahedron, a, b);
    two_to_zero(editor, edge) || three_to_two(editor, edge) || two_to_one(editor, edge)
}

/// The permutation with these images.
fn images(pairs: &[(u8, u8); 4]) -> Permutation {
    let mut images = [0; 4];
    for &(from, to) in pairs {
        images[usize::from(from)] = to;
    }
    let permutation = Permutation::new(images);
    debug_assert!(permutation.is_some(), "{pairs:?}");
    permutation.unwrap_or(Permutation::IDENTITY)
}

/// A face of the tetrahedra that are replaced, and what is across it.
struct Outside {
    face: (u32, u8),
    gluing: Gluing,
}

impl Outside {
    fn of(editor: &Editor, tetrahedron: u32, face: u8) -> Self {
        Self { face: (tetrahedron, face), gluing: editor.across(tetrahedron, face) }
    }
}

/// Where the outer faces of replaced tetrahedra are afterwards.
#[derive(Default)]
struct Places(Vec<((u32, u8), u32, Permutation)>);

impl Places {
    /// The face is on `tetrahedron` now, with its corners renamed.
    fn put(&mut self, face: (u32, u8), tetrahedron: u32, names: Permutation) {
        self.0.push((face, tetrahedron, names));
    }

    fn find(&self, face: (u32, u8)) -> Option<(u32, Permutation)> {
        self.0.iter().find(|place| place.0 == face).map(|&(_, tetrahedron, names)| (tetrahedron, names))
    }

    /// Glues all outer faces to what was across them, which may be one of them.
    fn glue(&self, editor: &mut Editor, outside: &[Outside]) {
        for &Outside { face, gluing } in outside {
            let Some((here, names)) = self.find(face) else { continue };
            let across = (gluing.tetrahedron, gluing.corners.image(face.1));
            let (there, corners) = match self.find(across) {
                Some((there, other_names)) => (there, other_names * gluing.corners * names.inverse()),
                None => (gluing.tetrahedron, gluing.corners * names.inverse()),
            };
            if editor.is_open(here, names.image(face.1)) {
                editor.glue(here, names.image(face.1), there, corners);
            }
        }
    }
}
