//! What goes wrong, and what to do about it.

use homeo_core::planar::Point2;

use crate::composite::TriangulationError;

/// Why control values make no speeds.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SpeedError {
    /// Degrees go from 1 to 8.
    #[error("speeds of degree {degree}: degrees go from 1 to 8")]
    Degree {
        /// What was asked for.
        degree: usize,
    },
    /// An edge has another number of control values.
    #[error("edge {edge} needs {expected} inner control values, not {found}")]
    Count {
        /// The edge, numbered ring after ring.
        edge: usize,
        /// One less than the degree.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// There are not as many lists as edges.
    #[error("there are {edges} edges and control values for {found}")]
    Edges {
        /// Edges of the domain.
        edges: usize,
        /// How many lists there are.
        found: usize,
    },
    /// Control values do not increase from 0 to 1.
    #[error("the control values of edge {edge} do not increase strictly from 0 to 1")]
    NotIncreasing {
        /// The edge.
        edge: usize,
    },
}

/// Why there is no complex map that is proved to be one-to-one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ComplexError {
    /// Speeds are none, or do not fit the domain.
    #[error(transparent)]
    Speeds(#[from] SpeedError),
    /// The source was not cut into triangles.
    #[error(transparent)]
    Triangles(#[from] TriangulationError),
    /// The map of the best speeds that were found folds.
    #[error(
        "the map of the best speeds found folds at {point:?}: its determinant is {at_most:e} at most. Take a higher degree, \
         or a composite mean value map, which goes in several steps"
    )]
    Folds {
        /// A point of the source where that is proved.
        point: Point2,
        /// A negative number.
        at_most: f64,
    },
    /// Neither was proved.
    #[error(
        "undecided: the sign of the determinant near {point:?} is not proved with the boxes allowed. Allow more boxes, or a \
         higher degree"
    )]
    Undecided {
        /// Near where; an approximation.
        point: Point2,
    },
    /// The work was cancelled.
    #[error("stopped before the map was proved to be one-to-one")]
    Stopped,
}
