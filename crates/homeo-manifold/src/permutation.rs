//! The permutations of the four corners of a tetrahedron.

use std::ops::Mul;

/// A permutation of 0, 1, 2, 3; `p.image(i)` is where `i` goes.
///
/// ```
/// use homeo_manifold::Permutation;
/// let turn = Permutation::new([1, 2, 0, 3]).unwrap();
/// assert_eq!(turn.image(0), 1);
/// assert!(turn.is_even());
/// assert_eq!(turn * turn.inverse(), Permutation::IDENTITY);
/// assert!(Permutation::new([0, 1, 1, 2]).is_none());
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Permutation([u8; 4]);

impl Permutation {
    /// Every corner stays.
    pub const IDENTITY: Self = Self([0, 1, 2, 3]);

    /// The permutation with these images of 0, 1, 2, 3; nothing if one is missing.
    pub fn new(images: [u8; 4]) -> Option<Self> {
        let seen = images.iter().fold(0_u32, |seen, &image| seen | 1_u32.checked_shl(u32::from(image)).unwrap_or(0));
        (seen == 0b1111).then_some(Self(images))
    }

    /// Swaps two corners, which must be among 0 to 3; equal ones give the identity.
    ///
    /// # Panics
    /// When a corner is above 3.
    pub fn transposition(a: u8, b: u8) -> Self {
        let mut images = [0, 1, 2, 3];
        images.swap(usize::from(a), usize::from(b));
        Self(images)
    }

    /// All 24, in the order of their images.
    ///
    /// ```
    /// use homeo_manifold::Permutation;
    /// assert_eq!(Permutation::all().count(), 24);
    /// assert_eq!(Permutation::all().filter(|p| p.is_even()).count(), 12);
    /// ```
    pub fn all() -> impl Iterator<Item = Self> {
        (0..256_u32).filter_map(|digits| Self::new([6, 4, 2, 0].map(|shift| (digits >> shift & 3) as u8)))
    }

    /// Where a corner goes.
    pub fn image(self, corner: u8) -> u8 {
        self.0[usize::from(corner)]
    }

    /// Where 0, 1, 2, 3 go.
    pub fn images(self) -> [u8; 4] {
        self.0
    }

    /// The permutation that undoes it.
    pub fn inverse(self) -> Self {
        let mut images = [0; 4];
        for corner in 0..4_u8 {
            images[usize::from(self.image(corner))] = corner;
        }
        Self(images)
    }

    /// Whether it is a product of an even number of swaps.
    pub fn is_even(self) -> bool {
        let inversions = (0..4).flat_map(|i| (i + 1..4).map(move |j| (i, j))).filter(|&(i, j)| self.0[i] > self.0[j]);
        inversions.count().is_multiple_of(2)
    }
}

impl Mul for Permutation {
    type Output = Self;

    /// The right one first, as with functions.
    fn mul(self, first: Self) -> Self {
        Self(first.0.map(|image| self.image(image)))
    }
}

impl std::fmt::Debug for Permutation {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.iter().try_for_each(|image| write!(formatter, "{image}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_parities_agree() {
        for p in Permutation::all() {
            assert_eq!(p * p.inverse(), Permutation::IDENTITY);
            for q in Permutation::all() {
                assert_eq!((p * q).is_even(), p.is_even() == q.is_even());
                for corner in 0..4 {
                    assert_eq!((p * q).image(corner), p.image(q.image(corner)));
                }
            }
        }
    }
}
