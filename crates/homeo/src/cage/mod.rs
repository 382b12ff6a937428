//! Meshes that move with a cage: mean value deformation in space, with an exact check of what came out.
//!
//! A *cage* is a closed triangle mesh; when its vertices move, every point `x` moves by `sum phi_i(x) u_i`, with mean value
//! coordinates `phi` and the displacements `u` of the vertices ([`deform`]). No such map is injective for every pair of
//! cages, in one step or in many. So the *moved mesh* is judged, exactly on the stored numbers ([`judge`]): of a
//! tetrahedral mesh it is decided whether the piecewise linear map from the mesh to the moved mesh is a homeomorphism; of a
//! surface whether it meets itself. `docs/theory/cages.md` has the theorem.
//!
//! The smooth map between two cages is a [`CageMap`]; written to a file
//! ([`write_cages`](crate::certificate::write_cages)) it is proved or refuted by the independent checker, and
//! evaluated both ways with bounds of the errors by a [`CageEvaluator`].
//!
//! [`harmonic_extension`] moves the inside of a tetrahedral mesh when its boundary is given.
//!
//! *Source*: Schneider 2017, sections 4.4.2 and 5.5. *Difference*: the source relies on enough steps, or on experience;
//! here the mesh that came out is checked, and more steps are made until it is sound.
//!
//! ```
//! use homeo::cage::{CagePair, Moved, Steps, Verdict, deform};
//! use homeo::progress::Silent;
//! use homeo::shape::StraightPolyhedra;
//! use homeo_core::mesh::TetrahedronComplex;
//! let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
//! let higher = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 8.0]];
//! let cages = CagePair::new(corners, higher, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
//! let path = StraightPolyhedra::new(cages.source().to_vec(), cages.target().to_vec())?;
//! let mesh = TetrahedronComplex::from_indices(4, &[[0, 1, 2, 3]])?;
//! let places = [[0.5, 0.5, 0.5], [1.5, 0.5, 0.5], [0.5, 1.5, 0.5], [0.5, 0.5, 1.5]];
//! let moved = deform(&cages, &path, Moved::Volume(&mesh), &places, Steps::default(), &Silent)?;
//! assert_eq!((moved.verdict, moved.steps), (Verdict::Embedded, 1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod deform;
mod enclosure;
mod evaluate;
mod harmonic;
mod inside;
mod map;
mod pair;
#[cfg(test)]
mod tests;
mod verdict;

pub use deform::{DeformError, Deformed, Steps, deform};
pub use evaluate::{CageEvaluationError, CageEvaluator};
pub use harmonic::{ExtensionError, harmonic_extension};
pub use map::{CageMap, StagesError};
pub use pair::{CageError, CagePair, CageSide};
pub use verdict::{Moved, Verdict, judge};
