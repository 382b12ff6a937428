//! Harmonic functions of planar domains, with holes or without, from what is given on the boundary.
//!
//! | method | type | inside | on the boundary |
//! |---|---|---|---|
//! | boundary elements | [`BoundaryElementFunctions`] | harmonic to rounding, with gradients | the data; the limit from inside misses it by the [defect](BoundaryElementFunctions::boundary_defect) |
//! | fundamental solutions | [`FundamentalSolutions`] | harmonic to rounding, with gradients; fast | missed by the least-squares residual |
//! | finite elements | [`FiniteElements`] | continuous, linear in triangles | the data, sampled at vertices |
//!
//! All implement [`HarmonicFunctions`]. None is exact: the difference of two harmonic functions is largest on the
//! boundary, so that what the first two miss there bounds what they miss inside.
//!
//! [`SmoothHarmonicMap`] composes two pairs of such functions to a smooth map between polygons, which is not certified.
//!
//! Source: Schneider 2017, sections 5.1, 5.2 and 5.4. Differences: boundary elements are integrated in closed form, so that
//! nothing breaks down near the boundary; normal derivatives are linear in each element and may jump between elements, as
//! they do at corners; elements get shorter towards corners.

mod boundary_element;
mod condition;
mod elements;
mod evaluate;
mod finite_element;
mod fundamental;
mod kernel;
mod mixed;
mod smooth_map;
#[cfg(test)]
mod smooth_tests;
#[cfg(test)]
mod tests;

pub use boundary_element::BoundaryElements;
pub use condition::{BoundaryData, EdgeCondition, Profile};
pub use elements::ElementParams;
pub use evaluate::BoundaryElementFunctions;
pub use finite_element::FiniteElements;
pub use fundamental::{FundamentalParams, FundamentalSolutions};
pub use mixed::solve_mixed;
pub use smooth_map::{SmoothHarmonicMap, SmoothImage, SmoothMapError, SmoothParams, SmoothVerdict};

use homeo_core::planar::Point2;

/// Some functions of a planar domain, harmonic as well as their method can.
pub trait HarmonicFunctions: Send + Sync {
    /// How many functions there are: #F.
    fn function_count(&self) -> usize;

    /// Values at a point of the closed domain, into `values` (#F).
    ///
    /// # Errors
    /// The point is not finite or lies outside, or `values` has another length.
    fn values_into(&self, point: Point2, values: &mut [f64]) -> Result<(), HarmonicFunctionError>;

    /// Values (#F) and gradients (#F by 2, per unit of length).
    ///
    /// # Errors
    /// As for the values, and where the method has no gradient.
    fn gradients_into(
        &self,
        point: Point2,
        values: &mut [f64],
        gradients: &mut [Point2],
    ) -> Result<(), HarmonicFunctionError>;
}

/// Why there is no harmonic function, or no value of it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HarmonicFunctionError {
    /// A coordinate is not finite.
    #[error("{point:?} has a coordinate that is not a finite number")]
    NotFinite {
        /// What was asked for.
        point: Point2,
    },
    /// The point is not in the closed domain, exactly.
    #[error("{point:?} lies outside the domain")]
    Outside {
        /// What was asked for.
        point: Point2,
    },
    /// Gradients are not bounded where elements meet.
    #[error("there is no gradient at {point:?}, where elements meet: take a point beside it")]
    NoGradient {
        /// What was asked for.
        point: Point2,
    },
    /// A buffer or a list has not the length that is needed.
    #[error("{expected} entries are needed, not {found}")]
    WrongLength {
        /// How many are needed.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// A number that is given is not finite.
    #[error("entry {entry} of the boundary data is {value}")]
    BadData {
        /// Which one.
        entry: usize,
        /// What it is.
        value: f64,
    },
    /// A parameter is out of its range.
    #[error("{name} is {value}: {range} is needed")]
    BadParameter {
        /// Its name.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// Too many elements for a dense matrix.
    #[error("{unknowns} unknowns are more than {most}: allow longer elements, or fewer on each edge")]
    TooLarge {
        /// How many there would be.
        unknowns: usize,
        /// How many there may be.
        most: usize,
    },
    /// The linear system has no solution in finite numbers.
    #[error("the linear system could not be solved: {0}")]
    Singular(&'static str),
    /// No edge has given values: functions are known up to a constant only.
    #[error("no edge has given values: give them on one edge at least")]
    NothingGiven,
    /// The domain could not be triangulated.
    #[error("finite elements: {0}")]
    Triangulation(String),
}

/// Refuses a list of another length.
fn check_length(found: usize, expected: usize) -> Result<(), HarmonicFunctionError> {
    if found == expected { Ok(()) } else { Err(HarmonicFunctionError::WrongLength { expected, found }) }
}
