//! Map files: writing a map with everything that its proof needs, and reading it back.
//!
//! The format is documented in `docs/certificate-format-v1.md`. Nothing is checked here beyond what
//! evaluation needs to be safe; the proof is re-established by the separate program `homeo-verify`.

mod bundle;
mod npy;
mod read;
mod read_hyperbolic;
mod write;

pub use bundle::{StoredSection, write_bundle};
pub use read::{MapFileError, read_map};
pub use read_hyperbolic::{StoredStructure, kind_of, read_hyperbolic};
pub use write::{
    content_sha256, write_cages, write_complex, write_composite, write_harmonic, write_hyperbolic, write_map,
    write_moved, write_planar, write_shell,
};

use homeo_core::number::Rational;

use crate::cage::CageMap;
use crate::complex::ComplexMap;
use crate::composite::CompositeMap;
use crate::map::{
    Bijection, Enclosed, EvaluationError, Foliation, HarmonicMap, MovedMesh, PlanarBijection, Shell, Target,
};

/// What a map file holds.
#[derive(Debug)]
#[allow(clippy::large_enum_variant)] // there is one at a time, and its arrays are elsewhere
pub enum StoredMap {
    /// A map onto a standard shape.
    Foliation(FoliationMap),
    /// A shell with its projection.
    Shell(Shell),
    /// A map between planar domains.
    Planar(PlanarMap),
    /// A mesh in space that has moved.
    Moved(MovedMap),
    /// A map between the insides of cages.
    Cages(CageMap),
}

/// A map between planar domains.
#[derive(Debug)]
#[allow(clippy::large_enum_variant)] // there is one at a time, and its arrays are elsewhere
pub enum PlanarMap {
    /// A composite harmonic map, or one by landmarks: piecewise linear.
    Harmonic(HarmonicMap),
    /// A composite mean value map: smooth inside.
    Composite(CompositeMap),
    /// A complex map with speeds: smooth inside, in one step.
    Complex(ComplexMap),
}

impl PlanarMap {
    /// The map, to be evaluated.
    pub fn as_bijection(&self) -> &dyn PlanarBijection {
        match self {
            Self::Harmonic(map) => map,
            Self::Composite(map) => map,
            Self::Complex(map) => map,
        }
    }
}

impl From<HarmonicMap> for PlanarMap {
    fn from(map: HarmonicMap) -> Self {
        Self::Harmonic(map)
    }
}

impl From<CompositeMap> for PlanarMap {
    fn from(map: CompositeMap) -> Self {
        Self::Composite(map)
    }
}

impl From<ComplexMap> for PlanarMap {
    fn from(map: ComplexMap) -> Self {
        Self::Complex(map)
    }
}

/// A mesh in space and where it has moved to.
#[derive(Debug)]
pub enum MovedMap {
    /// Of triangles.
    Surface(MovedMesh<3>),
    /// Of tetrahedra.
    Volume(MovedMesh<4>),
}

impl MovedMap {
    /// The map, to be evaluated.
    pub fn as_bijection(&self) -> &dyn Bijection {
        match self {
            Self::Surface(map) => map,
            Self::Volume(map) => map,
        }
    }
}

impl From<MovedMesh<3>> for MovedMap {
    fn from(map: MovedMesh<3>) -> Self {
        Self::Surface(map)
    }
}

impl From<MovedMesh<4>> for MovedMap {
    fn from(map: MovedMesh<4>) -> Self {
        Self::Volume(map)
    }
}

/// A foliation map of a surface or of a volume.
#[derive(Debug)]
pub enum FoliationMap {
    /// Of a disk, onto square or disk.
    Surface(Foliation<3>),
    /// Of a ball, onto cube or ball.
    Volume(Foliation<4>),
}

impl From<Foliation<3>> for FoliationMap {
    fn from(map: Foliation<3>) -> Self {
        Self::Surface(map)
    }
}

impl From<Foliation<4>> for FoliationMap {
    fn from(map: Foliation<4>) -> Self {
        Self::Volume(map)
    }
}

/// Where a map comes from; no claim rests on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    /// File name of the source mesh.
    pub source_name: String,
    /// Program and version.
    pub program: String,
    /// Options of the construction.
    pub options: serde_json::Value,
}

macro_rules! either {
    ($map:expr, $inner:ident => $body:expr) => {
        match $map {
            FoliationMap::Surface($inner) => $body,
            FoliationMap::Volume($inner) => $body,
        }
    };
}
pub(crate) use either;

impl FoliationMap {
    /// What the mesh is mapped onto.
    pub fn target(&self) -> Target {
        either!(self, map => map.target())
    }
}

impl Bijection for FoliationMap {
    fn forward(&self, point: [f64; 3]) -> Result<Enclosed, EvaluationError> {
        either!(self, map => map.forward(point))
    }

    fn inverse(&self, point: [f64; 3]) -> Result<Enclosed, EvaluationError> {
        either!(self, map => map.inverse(point))
    }

    fn forward_batch(&self, points: &[[f64; 3]]) -> Vec<Result<Enclosed, EvaluationError>> {
        either!(self, map => map.forward_batch(points))
    }

    fn forward_exact(&self, point: &[Rational; 3]) -> Result<[Rational; 3], EvaluationError> {
        either!(self, map => map.forward_exact(point))
    }

    fn inverse_exact(&self, point: &[Rational; 3]) -> Result<[Rational; 3], EvaluationError> {
        either!(self, map => map.inverse_exact(point))
    }
}
