//! Bijective complex maps: each edge sends the plane along by a similarity, at a speed of its own.
//!
//! Theorem:     the Jacobian determinant of the map is positive in the open domain, and speeds increase => it is a
//!              homeomorphism of the closed domains that sends every edge onto its image by its speed.
//! Source:      Schneider 2017, chapter 7 and section 1.2; Weber, Ben-Chen, Gotsman, Hormann 2011 for shares of edges;
//!              Hormann, Floater 2006 for domains with holes.
//! Differences: the least determinant is maximized, and proved to be positive up to vertices and edges, where the source
//!              samples it; speeds that are mirrored need no search; domains may be of any shape.
//! Arithmetic:  domains are decided exactly; the determinant is bounded in affine forms, rounded outwards; the search for speeds is
//!              rounded and decides nothing.
//! Cost:        samples times vertices squared for the search, boxes times vertices for the proof.
//! Fails when:  no speeds of the degree are found that make it positive, or the proof reaches its limit -> [`ComplexError`].
//! See:         `docs/theory/complex.md`.

mod ascent;
mod error;
mod invert;
mod map;
mod optimize;
mod speed;
#[cfg(test)]
mod tests;

pub use error::{ComplexError, SpeedError};
pub use map::{ComplexInfo, ComplexMap, ComplexParams, bound_complex_jacobian};
pub use speed::EdgeSpeeds;
