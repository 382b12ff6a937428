//! Generalized barycentric coordinates of polygons and polyhedra, with gradients.
//!
//! | kind | where | holes |
//! |---|---|---|
//! | [`MeanValue`] | the plane | yes |
//! | [`Wachspress`], [`DiscreteHarmonic`], [`ThreePoint`] | strictly convex polygons | no |
//! | [`PositiveMeanValue`], [`MaximumEntropy`] | the closed domain | yes |
//! | [`HarmonicCoordinates`] (approximate: see its page) | the closed domain | yes |
//! | [`TransfiniteMeanValue`] (data along a closed curve; its own interface) | inside | no |
//! | [`Cauchy`], [`Green`] (complex, with normals; their own interface) | inside | yes |
//! | [`ComplexCoordinates`] (complex shares of edges; their own interface) | as their [`ComplexFamily`] | mean value, Cauchy |
//! | [`WachspressPolyhedron`] | convex polyhedra | no |
//! | [`MeanValuePolyhedron`] | space, closed meshes of any genus | yes |
//! | [`MaximumEntropyPolyhedron`] | the inside of closed meshes of any genus | yes |
//!
//! Those of polygons implement [`PlanarCoordinates`] but for the complex ones, those of polyhedra [`SpatialCoordinates`]:
//! `#V` functions that sum to 1, reproduce the point from the vertices, are linear on edges (in space on triangles) and 1 at
//! their own vertex. None of them gives a map that is injective for every pair of polygons or polyhedra.
//! `docs/methods/coordinates.md` says which to choose.
//!
//! ```
//! use homeo::coordinates::{MeanValue, PlanarCoordinates};
//! use homeo_core::planar::PlanarDomain;
//! let square = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
//! let kind = MeanValue::new(&PlanarDomain::new(vec![square])?);
//! let (mut values, mut gradients) = ([0.0; 4], [[0.0; 2]; 4]);
//! kind.gradients_into([1.0, 1e-15], &mut values, &mut gradients)?;
//! assert!((values[0] - 0.5).abs() < 1e-14 && (gradients[0][0] + 0.5).abs() < 1e-13);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod accurate;
mod complex;
mod complex_family;
mod face_mesh;
mod face_view;
mod gauss_kronrod;
mod harmonic;
mod maximum_entropy;
mod maximum_entropy_polyhedron;
mod mean_value;
mod mean_value_batch;
mod mean_value_polyhedron;
mod mean_value_vertex;
mod outline;
mod positive;
mod real;
mod space;
mod spatial;
mod three_point;
mod transfinite;
pub(crate) mod vectors;
mod weighted;

#[cfg(test)]
mod tests;

pub use complex::{Cauchy, Complex, Green};
pub use complex_family::{ComplexCoordinates, ComplexFamily};
pub use harmonic::HarmonicCoordinates;
pub use maximum_entropy::MaximumEntropy;
pub use maximum_entropy_polyhedron::MaximumEntropyPolyhedron;
pub use mean_value::MeanValue;
pub use mean_value_polyhedron::MeanValuePolyhedron;
pub use mean_value_vertex::mean_value_derivative_at_vertex;
pub use positive::PositiveMeanValue;
pub use space::{PolyhedronError, WachspressPolyhedron};
pub use spatial::SpatialCoordinates;
pub use three_point::{DiscreteHarmonic, ThreePoint, Wachspress};
pub use transfinite::{ClosedCurve, TransfiniteComposite, TransfiniteError, TransfiniteMeanValue, TransfiniteParams};

/// Coordinates of points with respect to the vertices of a planar domain, ring after ring.
pub trait PlanarCoordinates: Send + Sync {
    /// How many vertices there are: #V.
    fn vertex_count(&self) -> usize;

    /// Values at a point of the closed domain, into `values` (#V).
    ///
    /// # Errors
    /// The point is not finite or the kind is not defined there, or `values` has another length.
    fn values_into(&self, point: [f64; 2], values: &mut [f64]) -> Result<(), CoordinateError>;

    /// Values (#V) and gradients (#V by 2).
    ///
    /// # Errors
    /// As for the values, and where the kind has no gradient: most have none at vertices.
    fn gradients_into(
        &self,
        point: [f64; 2],
        values: &mut [f64],
        gradients: &mut [[f64; 2]],
    ) -> Result<(), CoordinateError>;
}

/// Why there are no coordinates.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CoordinateError {
    /// A point or direction is not finite, or more than `1e70` diagonals away.
    #[error("{point:?} is not finite or too far away")]
    NotFinite {
        /// What was asked for.
        point: [f64; 2],
    },
    /// The point lies where the kind is not defined: outside, or where the weights sum to zero.
    #[error("the coordinates are not defined at {point:?}")]
    Undefined {
        /// What was asked for.
        point: [f64; 2],
    },
    /// The point lies outside the polyhedron, or is not finite.
    #[error("{point:?} is not in the polyhedron")]
    OutsidePolyhedron {
        /// What was asked for.
        point: [f64; 3],
    },
    /// The point is not finite or too far away, or the weights sum to zero there.
    #[error("the coordinates are not defined at {point:?}")]
    UndefinedInSpace {
        /// What was asked for.
        point: [f64; 3],
    },
    /// There is no gradient on an edge of a polyhedron.
    #[error("there is no gradient on the edge {from} to {to}: take a point beside it")]
    NoGradientOnEdge {
        /// One end.
        from: usize,
        /// The other.
        to: usize,
    },
    /// The kind is for strictly convex polygons.
    #[error("the polygon is not strictly convex at vertex {vertex}: take mean value coordinates")]
    NotConvex {
        /// The first vertex with an inner angle of a half turn or more.
        vertex: usize,
    },
    /// The kind is for polygons without holes.
    #[error("the domain has holes: take mean value coordinates")]
    HasHoles,
    /// There is no gradient at a vertex.
    #[error("there is no gradient at vertex {vertex}: take derivatives by direction, or a point beside it")]
    NoGradient {
        /// The vertex.
        vertex: usize,
    },
    /// An iteration did not come to its end.
    #[error("no convergence at {point:?} after {steps} steps")]
    NotConverged {
        /// What was asked for.
        point: [f64; 2],
        /// How many steps were made.
        steps: usize,
    },
    /// The same for a point in space.
    #[error("no convergence at {point:?} after {steps} steps: the point lies outside, or the polyhedron is too thin")]
    NotConvergedInSpace {
        /// What was asked for.
        point: [f64; 3],
        /// How many steps were made.
        steps: usize,
    },
    /// A parameter of a kind is not finite.
    #[error("the exponent {exponent} is not finite")]
    BadExponent {
        /// What was given.
        exponent: f64,
    },
    /// There is no vertex of this number.
    #[error("there is no vertex {vertex}: there are {count}")]
    NoSuchVertex {
        /// What was asked for.
        vertex: usize,
        /// How many there are.
        count: usize,
    },
    /// A buffer or list has not one entry for each vertex or point.
    #[error("{expected} entries are needed, not {found}")]
    WrongLength {
        /// How many are needed.
        expected: usize,
        /// How many there are.
        found: usize,
    },
}
