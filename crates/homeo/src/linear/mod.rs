//! Sparse linear algebra for fields on meshes.
//!
//! All fields here only guide a construction: no claim rests on their accuracy. Weights are kept
//! positive, so that a discrete harmonic field has its extrema on the boundary (maximum principle).

mod grounded;
mod laplacian;

pub use grounded::GroundedLaplacian;
pub use laplacian::{GraphLaplacian, SolveError};
