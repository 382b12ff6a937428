//! The least string of a component.

use super::{BOUNDARY, CHARACTERS, KNOWN, LARGE, NEW};
use crate::permutation::Permutation;
use crate::triangulation::Triangulation;
use std::cmp::Ordering;

const UNSEEN: u32 = u32::MAX;

/// Labels of a component from a first tetrahedron on, and the string that they give. Kept for reuse.
pub(super) struct Search<'a> {
    triangulation: &'a Triangulation,
    /// The new number of each tetrahedron, and the new names of its corners.
    number: Vec<u32>,
    names: Vec<Permutation>,
    /// The tetrahedra by their new numbers.
    order: Vec<u32>,
    joins: Vec<(u32, u8)>,
    text: Vec<u8>,
    permutations: Vec<Permutation>,
}

impl<'a> Search<'a> {
    pub(super) fn new(triangulation: &'a Triangulation) -> Self {
        Self {
            triangulation,
            number: vec![UNSEEN; triangulation.len()],
            names: vec![Permutation::IDENTITY; triangulation.len()],
            order: Vec::new(),
            joins: Vec::new(),
            text: Vec::new(),
            permutations: Permutation::all().collect(),
        }
    }

    /// The least string, and the number of labellings that give it.
    pub(super) fn least(&mut self, component: &[u32]) -> (String, usize) {
        let mut best = Vec::new();
        let mut count = 0;
        for &first in component {
            for which in 0..24 {
                let names = self.permutations[which];
                let comparison = self.compare(first, names, component.len(), &best);
                self.order.iter().for_each(|&tetrahedron| self.number[tetrahedron as usize] = UNSEEN);
                match comparison {
                    Ordering::Less => {
                        std::mem::swap(&mut best, &mut self.text);
                        count = 1;
                    }
                    Ordering::Equal => count += 1,
                    Ordering::Greater => {}
                }
            }
        }
        (best.into_iter().map(char::from).collect(), count)
    }

    /// Compares the string of a labelling with the best one, which is empty at first. Leaves the whole string in `text`
    /// if it is less, and a part of it otherwise.
    fn compare(&mut self, first: u32, names: Permutation, size: usize, best: &[u8]) -> Ordering {
        self.text.clear();
        self.joins.clear();
        self.order.clear();
        self.label(first, names);
        let width = self.write_size(size);
        let mut so_far = if best.is_empty() { Ordering::Less } else { Ordering::Equal };
        let (mut packed, mut trits) = (0, 0);
        let mut next = 0;
        while let Some(&tetrahedron) = self.order.get(next) {
            next += 1;
            for face in 0..4 {
                let Some(action) = self.action(tetrahedron, face) else { continue };
                packed |= usize::from(action) << (2 * trits);
                trits += 1;
                if trits == 3 {
                    so_far = self.push(packed, so_far, best);
                    (packed, trits) = (0, 0);
                    if so_far.is_gt() {
                        return so_far;
                    }
                }
            }
        }
        if trits > 0 {
            so_far = self.push(packed, so_far, best);
        }
        self.write_joins(width, so_far, best)
    }

    /// What is across a face in new names; nothing if it was seen from the other side.
    fn action(&mut self, tetrahedron: u32, face: u8) -> Option<u8> {
        let names = self.names[tetrahedron as usize];
        let old_face = names.inverse().image(face);
        let Some(there) = self.triangulation.neighbour(tetrahedron, old_face) else { return Some(BOUNDARY) };
        let (here, number) = (self.number[tetrahedron as usize], self.number[there.tetrahedron as usize]);
        if number == UNSEEN {
            self.label(there.tetrahedron, names * there.corners.inverse());
            return Some(NEW);
        }
        let in_new_names = self.names[there.tetrahedron as usize] * there.corners * names.inverse();
        if (number, in_new_names.image(face)) < (here, face) {
            return None;
        }
        self.joins.push((number, index(in_new_names)));
        Some(KNOWN)
    }

    fn label(&mut self, tetrahedron: u32, names: Permutation) {
        self.number[tetrahedron as usize] = self.order.len() as u32;
        self.names[tetrahedron as usize] = names;
        self.order.push(tetrahedron);
    }

    /// Writes the number of tetrahedra, which is the same for all labellings; the characters of a number.
    fn write_size(&mut self, size: usize) -> usize {
        let mut width = 1;
        if size >= LARGE {
            width = (usize::BITS - size.leading_zeros()).div_ceil(6) as usize;
            self.text.extend([CHARACTERS[LARGE], CHARACTERS[width]]);
        }
        self.text.extend(digits(size, width));
        width
    }

    fn write_joins(&mut self, width: usize, mut so_far: Ordering, best: &[u8]) -> Ordering {
        let joins = std::mem::take(&mut self.joins);
        for &(destination, _) in &joins {
            for digit in (0..width).map(|place| destination as usize >> (6 * place) & 63) {
                so_far = self.push(digit, so_far, best);
            }
        }
        for &(_, permutation) in &joins {
            so_far = self.push(usize::from(permutation), so_far, best);
        }
        self.joins = joins;
        // Strings of equal beginning are as long as one another: the beginning tells how many joins there are.
        so_far
    }

    /// Writes one more value, and compares the string with the best one.
    fn push(&mut self, value: usize, so_far: Ordering, best: &[u8]) -> Ordering {
        let character = CHARACTERS[value];
        let place = self.text.len();
        self.text.push(character);
        match best.get(place) {
            Some(other) => so_far.then(character.cmp(other)),
            None => so_far,
        }
    }
}

/// A number in characters, the lowest six bits first.
fn digits(value: usize, width: usize) -> impl Iterator<Item = u8> {
    (0..width).map(move |place| CHARACTERS[value >> (6 * place) & 63])
}

/// The place of a permutation among all, by their images.
fn index(permutation: Permutation) -> u8 {
    let [a, b, c, d] = permutation.images();
    6 * a + 2 * (b - u8::from(b > a)) + u8::from(c > d)
}
