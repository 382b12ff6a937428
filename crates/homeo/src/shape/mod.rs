//! Intermediate shapes: what lies between two polygons, or two closed curves, at a time `t` from 0 to 1.
//!
//! | path | of | keeps |
//! |---|---|---|
//! | [`LinearPath`] | rings with corresponding vertices | edges parallel where they are parallel in both |
//! | [`LengthsAndAngles`] | one ring with corresponding vertices | turning angles linear, lengths nearly so |
//! | [`CurvatureBlend`] | two sampled closed curves | curvature nearly linear, length linear |
//! | [`CurvaturePath`] | one ring with corresponding vertices | parts of the length linear, turning angles nearly so |
//! | [`SimplePath`] | rings with corresponding vertices, one hole at most | shapes simple |
//! | [`StraightPolyhedra`] | two polyhedra with the same triangles | edges parallel where they are parallel in both |
//! | [`TurningPolyhedra`] | the same | rotations of triangles even, stretches linear, nearly so |
//!
//! [`fit_closed_spline`] makes a ring smooth: a closed cubic B-spline near its vertices.
//!
//! *Source*: Schneider 2017, chapter 3; *differences* are with each path and in `docs/methods/shapes.md`.
//! *Arithmetic*: floating point; [`check_simple`] decides exactly, on the stored numbers. Only [`SimplePath`] keeps shapes
//! simple; on other paths [`first_not_simple`] looks.
//!
//! ```
//! use homeo::shape::{LengthsAndAngles, LinearPath, ShapePath};
//! let square = vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
//! let turned = vec![[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
//! let rigid = LengthsAndAngles::new(square.clone(), turned.clone())?.at(0.5)?;
//! let linear = LinearPath::new(vec![square], vec![turned])?.at(0.5)?;
//! assert!((rigid[0][0][1] + 2f64.sqrt()).abs() < 1e-14);
//! assert_eq!(linear[0][0], [0.0, -1.0]);
//! # Ok::<(), homeo::shape::ShapeError>(())
//! ```

mod bent;
mod blend;
mod closing;
mod combinations;
mod compatible;
mod curvature;
mod curvature_path;
mod lengths_and_angles;
mod linear;
mod polyhedron;
mod ring;
mod rotation;
mod simple;
mod simple_path;
mod spline;
mod turning;

#[cfg(test)]
mod curvature_path_tests;
#[cfg(test)]
mod polyhedron_tests;
#[cfg(test)]
mod tests;

pub use blend::CurvatureBlend;
pub use compatible::CompatibleError;
pub use curvature::{CurvatureProfile, sample_closed};
pub use curvature_path::CurvaturePath;
pub use lengths_and_angles::LengthsAndAngles;
pub use linear::LinearPath;
pub use polyhedron::{PolyhedronPath, PolyhedronPathError, StraightPolyhedra, TurningPolyhedra};
pub use simple::{NotSimple, check_simple, first_not_simple};
pub use simple_path::SimplePath;
pub use spline::{ClosedSpline, SplineError, SplineFit, SplineParams, fit_closed_spline};
pub use turning::TurningPath;

/// Shapes from a source to a target.
pub trait ShapePath: Send + Sync {
    /// The rings at a time from 0 to 1: the stored source at 0, the stored target at 1, bit for bit.
    ///
    /// # Errors
    /// The time is not in `[0, 1]`, or the shape could not be closed.
    ///
    /// # Example
    /// See [the module](self).
    fn at(&self, t: f64) -> Result<Vec<Vec<[f64; 2]>>, ShapeError>;
}

/// Why there is no path, or no shape on it. Rings and vertices are numbered from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// The time is not in `[0, 1]`.
    #[error("the time {t} is not between 0 and 1")]
    OutsideTime {
        /// What was asked for.
        t: f64,
    },
    /// There are not as many rings here as there.
    #[error("the source has {here} rings and the target {there}: they correspond by number")]
    RingCounts {
        /// How many in the source.
        here: usize,
        /// How many in the target.
        there: usize,
    },
    /// A ring has not as many vertices here as there.
    #[error("ring {ring} has {here} vertices in the source and {there} in the target: they correspond by number")]
    VertexCounts {
        /// The ring.
        ring: usize,
        /// How many in the source.
        here: usize,
        /// How many in the target.
        there: usize,
    },
    /// A ring has fewer than three vertices.
    #[error("a ring has {count} vertices; three are needed")]
    TooFewVertices {
        /// How many it has.
        count: usize,
    },
    /// A coordinate is not finite, or not zero and below 1e-90 or above 1e90 in size.
    #[error("vertex {vertex} is {point:?}: coordinates must be 0 or between 1e-90 and 1e90 in size")]
    OutOfRange {
        /// The vertex.
        vertex: usize,
        /// Where it is.
        point: [f64; 2],
    },
    /// Two neighbours lie on the same point, so that their edge has no direction.
    #[error("vertex {vertex} lies on the next one: remove it, with the one that corresponds to it")]
    EdgeOfLengthZero {
        /// The first vertex of the edge.
        vertex: usize,
    },
    /// An edge runs back on the one before, so that the turning angle has no sign.
    #[error("the ring turns back on itself at vertex {vertex}: move it")]
    TurnsBack {
        /// The vertex.
        vertex: usize,
    },
    /// Source and target do not turn as often, or not at all.
    #[error("the source turns {here} times and the target {there} times: both must turn the same number of times")]
    TurningNumbers {
        /// How often the source turns, counter-clockwise.
        here: i64,
        /// How often the target does.
        there: i64,
    },
    /// Neither turns: lengths that close the shape are not known to exist.
    #[error("source and target turn 0 times, like an eight: for such rings take another path")]
    DoesNotTurn,
    /// The correction that closes the shape was not found.
    #[error(
        "no correction was found that closes the shape at time {t}: the last try leaves {residual:e} of its length open"
    )]
    NotClosed {
        /// The time.
        t: f64,
        /// What is left open, as a part of the perimeter.
        residual: f64,
    },
    /// More than one hole.
    #[error("there are {count} holes; simple paths are made for one or none: take another path")]
    TooManyHoles {
        /// How many.
        count: usize,
    },
    /// The shapes could not be triangulated alike.
    #[error("the shapes could not be triangulated alike: {0}")]
    NotTriangulated(#[from] CompatibleError),
    /// The linear system was not solved.
    #[error("the places of vertices at time {t} could not be solved for")]
    Unsolved {
        /// The time.
        t: f64,
    },
    /// Rounding turned a triangle over.
    #[error(
        "rounding turned triangle {triangle} over at time {t}: take shapes that are less unlike, or with fewer vertices"
    )]
    TurnedOver {
        /// The time.
        t: f64,
        /// The triangle.
        triangle: usize,
    },
}

/// Refuses times that are none.
fn check_time(t: f64) -> Result<(), ShapeError> {
    match (0.0..=1.0).contains(&t) {
        true => Ok(()),
        false => Err(ShapeError::OutsideTime { t }),
    }
}

/// `a` at time 0 and `b` at time 1.
fn mix(t: f64, a: f64, b: f64) -> f64 {
    (1.0 - t) * a + t * b
}
