//! 3-manifolds as tetrahedra that are glued along their faces.
//!
//! A mesh names the vertices of its cells; two cells meet where they share names, so two cells share at most one face
//! and a cell has four different vertices. Here it is the other way round: there are tetrahedra, their faces are
//! glued in pairs, and vertices and edges are what comes out. A tetrahedron may be glued to itself, a single vertex may be
//! all corners of the whole triangulation, and two tetrahedra are enough for manifolds of which a mesh needs thousands.
//!
//! | module | what it holds |
//! |---|---|
//! | [`permutation`] | the 24 permutations of the corners of a tetrahedron |
//! | [`triangulation`] | tetrahedra and the gluings of their faces |
//! | [`skeleton`] | the classes of vertices, edges and faces, and what is round each edge |
//! | [`link`] | the surfaces that cut off the vertices; orientation |
//! | [`group`] | the fundamental group: a generator for each face off a tree, a relation for each inner edge |
//! | [`homology`] | first homology, by Smith normal form |
//! | [`cover`] | coverings with few sheets |
//! | [`mesh`] | from meshes and back |
//! | [`subdivision`] | barycentric subdivision |
//! | [`record`] | reading and writing gluings as JSON |
//! | [`signature`](mod@signature) | isomorphism signatures, to and from |
//! | [`snappea`] | the gluings of the text files of SnapPea and SnapPy |
//! | [`enumerate`](mod@enumerate) | all closed triangulations of a few tetrahedra |
//! | [`bundle`] | circle bundles over surfaces, unit tangent bundles |
//! | [`hyperbolic`] | hyperbolic structures with geodesic boundary, with proofs |
//!
//! Source: Yin 2010, section 4.2.1. The class of a vertex whose link is no sphere is *truncated*: cut off, it leaves the
//! link as a component of the boundary.
//!
//! ```
//! use homeo_manifold::{Permutation, Skeleton, Triangulation};
//! // One tetrahedron, its faces glued in two pairs: a triangulation of the 3-sphere.
//! let folded = |a, b| Permutation::transposition(a, b);
//! let sphere = Triangulation::from_gluings(1, &[(0, 0, 0, folded(0, 1)), (0, 2, 0, folded(2, 3))])?;
//! let skeleton = Skeleton::new(&sphere);
//! assert_eq!(skeleton.vertex_count(), 2);
//! assert_eq!(skeleton.edges().len(), 3);
//! # Ok::<(), homeo_manifold::GluingError>(())
//! ```

pub mod bundle;
pub mod cover;
pub mod enumerate;
pub mod group;
pub mod homology;
pub mod hyperbolic;
pub mod link;
pub mod mesh;
pub mod permutation;
pub mod record;
#[cfg(test)]
mod sample;
pub mod signature;
pub mod simplify;
pub mod skeleton;
pub mod snappea;
pub mod subdivision;
pub mod triangulation;

pub use cover::{CoverError, covers};
pub use enumerate::{AllowedLinks, Enumerated, EnumerationError, enumerate};
pub use group::{FundamentalGroup, Letter};
pub use homology::Homology;
pub use link::{Link, Links};
pub use mesh::{MeshError, SubdividedMesh};
pub use permutation::Permutation;
pub use record::{Record, RecordError, read_record, read_record_of, read_records, write_record};
pub use signature::{SignatureError, automorphism_count, from_signature, signature};
pub use skeleton::{EdgeClass, EdgeCorner, Skeleton};
pub use snappea::{SnapPeaError, read_snappea, write_snappea};
pub use subdivision::subdivided;
pub use triangulation::{Gluing, GluingError, Triangulation};
