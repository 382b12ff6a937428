//! Signs that are decided exactly.
//!
//! Every predicate answers with a [`Sign`] for the stored numbers, not for nearby ones. Coordinates
//! are `f64`, that is dyadic rationals; the fast path is floating point with an error bound and the
//! slow one an exact expansion (Shewchuk 1997, by the `robust` crate).
//! Coordinates must lie within `2^-300..2^300` in magnitude or be zero, so that products neither
//! overflow nor underflow; [`crate::topology`] reports others.

mod contact;
#[cfg(test)]
mod contact_tests;
mod crossing;
mod orientation;

pub use contact::{
    faithful_projection, segment_meets_triangle, segments_meet, triangles_meet, triangles_meet_beyond_edge,
    triangles_meet_beyond_vertex,
};
pub use crossing::{crossing_sign, quick_crossing_sign, share_area};
pub use orientation::{is_degenerate_triangle, orient2d, orient3d};

/// The exact sign of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sign {
    /// Below zero.
    Negative,
    /// Zero, exactly.
    Zero,
    /// Above zero.
    Positive,
}

impl Sign {
    /// Sign of a number that is itself exact.
    #[inline]
    pub fn of(value: f64) -> Self {
        if value > 0.0 {
            Self::Positive
        } else if value < 0.0 {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// The sign of the opposite quantity.
    #[inline]
    pub fn reversed(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }
}
