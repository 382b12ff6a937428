//! Random triangulations for tests, the same for each seed.

use crate::permutation::Permutation;
use crate::triangulation::Triangulation;

/// Numbers that look random (splitmix64).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A number below a bound.
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }

    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }

    pub(crate) fn permutation(&mut self) -> Permutation {
        let mut images = [0, 1, 2, 3];
        self.shuffle(&mut images);
        Permutation::new(images).unwrap()
    }
}

/// Tetrahedra whose faces are glued at random, but for some that stay open.
pub(crate) fn random_gluings(random: &mut Random, tetrahedra: usize, open_pairs: usize) -> Triangulation {
    let mut faces: Vec<_> = Triangulation::new(tetrahedra).faces().collect();
    random.shuffle(&mut faces);
    let mut triangulation = Triangulation::new(tetrahedra);
    for pair in faces.chunks_exact(2).skip(open_pairs) {
        let [(tetrahedron, face), (other, other_face)] = [pair[0], pair[1]];
        let corners = std::iter::repeat_with(|| random.permutation()).find(|p| p.image(face) == other_face).unwrap();
        triangulation.glue(tetrahedron, face, other, corners).unwrap();
    }
    triangulation
}

/// The same with other names of tetrahedra and corners.
pub(crate) fn relabelled(random: &mut Random, triangulation: &Triangulation) -> Triangulation {
    let mut order: Vec<u32> = (0..triangulation.len() as u32).collect();
    random.shuffle(&mut order);
    let names: Vec<_> = order.iter().map(|_| random.permutation()).collect();
    let mut renamed = Triangulation::new(triangulation.len());
    for (tetrahedron, face) in triangulation.faces() {
        let Some(there) = triangulation.neighbour(tetrahedron, face) else { continue };
        let (here, other) = (tetrahedron as usize, there.tetrahedron as usize);
        let corners = names[other] * there.corners * names[here].inverse();
        let new_face = names[here].image(face);
        if renamed.neighbour(order[here], new_face).is_none() {
            renamed.glue(order[here], new_face, order[other], corners).unwrap();
        }
    }
    renamed
}

/// The same with two corners of the first glued face swapped.
pub(crate) fn with_one_gluing_turned(triangulation: &Triangulation) -> Option<Triangulation> {
    let (tetrahedron, face) = triangulation.faces().find(|&(t, f)| triangulation.neighbour(t, f).is_some())?;
    let mut turned = triangulation.clone();
    let gluing = turned.unglue(tetrahedron, face)?;
    let others: Vec<_> = (0..4).filter(|&corner| corner != face).collect();
    let swap = Permutation::transposition(others[0], others[1]);
    turned.glue(tetrahedron, face, gluing.tetrahedron, gluing.corners * swap).ok()?;
    Some(turned)
}
