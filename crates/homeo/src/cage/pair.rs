//! Two cages with corresponding vertices.

use homeo_core::mesh::TriangleComplex;
use homeo_core::topology::{Intersections, Options, Severity, Violation, analyse_triangles};

use super::inside::contains;
use crate::coordinates::{MeanValuePolyhedron, PolyhedronError};

type Point3 = [f64; 3];

/// Which of two cages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CageSide {
    /// The one before.
    Source,
    /// The one after.
    Target,
}

impl std::fmt::Display for CageSide {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str(if *self == Self::Source { "source" } else { "target" })
    }
}

/// Why two meshes are no cages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CageError {
    /// The cages have different numbers of vertices.
    #[error("the source cage has {here} vertices and the target cage {there}: they correspond by number")]
    VertexCounts {
        /// How many in the source.
        here: usize,
        /// How many in the target.
        there: usize,
    },
    /// The cages have different triangles.
    #[error("triangle {triangle} of the cages has other corners before than after: they must have the same triangles")]
    OtherTriangles {
        /// The first triangle that differs, or is in one of them only.
        triangle: usize,
    },
    /// A cage is not closed, or has triangles without area.
    #[error("the {side} cage: {error}")]
    NotClosed {
        /// Which.
        side: CageSide,
        /// What is wrong.
        error: PolyhedronError,
    },
    /// A cage is no embedded surface.
    #[error("the {side} cage: {}: {}", .violation.code, .violation.message)]
    NotEmbedded {
        /// Which.
        side: CageSide,
        /// What is wrong, with the first elements.
        violation: Violation,
    },
}

/// Two closed, consistently oriented, embedded triangle meshes with the same triangles.
#[derive(Clone, Debug)]
pub struct CagePair {
    source: Vec<Point3>,
    target: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
}

impl CagePair {
    /// Of vertices before and after (#V by 3) and triangles (#F by 3), which may run either way round.
    ///
    /// # Errors
    /// The first thing that is wrong: the numbers of vertices; an edge that has other than two triangles in opposite
    /// directions; triangles without area or that meet, decided exactly.
    ///
    /// # Complexity
    /// `O(n log n)` in the number of triangles.
    pub fn new(source: Vec<Point3>, target: Vec<Point3>, triangles: Vec<[u32; 3]>) -> Result<Self, CageError> {
        if source.len() != target.len() {
            return Err(CageError::VertexCounts { here: source.len(), there: target.len() });
        }
        check(CageSide::Source, &source, &triangles)?;
        check(CageSide::Target, &target, &triangles)?;
        Ok(Self { source, target, triangles })
    }

    /// Of two meshes, each with its triangles: these must be the same, in the same order.
    ///
    /// # Errors
    /// As [`new`](Self::new), and the first triangle that differs.
    pub fn of_meshes(
        [source, target]: [Vec<Point3>; 2],
        [before, after]: [Vec<[u32; 3]>; 2],
    ) -> Result<Self, CageError> {
        if source.len() != target.len() {
            return Err(CageError::VertexCounts { here: source.len(), there: target.len() });
        }
        let differs = before.iter().zip(&after).position(|(a, b)| a != b);
        let shorter = before.len().min(after.len());
        match differs.or((before.len() != after.len()).then_some(shorter)) {
            Some(triangle) => Err(CageError::OtherTriangles { triangle }),
            None => Self::new(source, target, before),
        }
    }

    /// Vertices before, #V by 3.
    pub fn source(&self) -> &[Point3] {
        &self.source
    }

    /// Vertices after, #V by 3.
    pub fn target(&self) -> &[Point3] {
        &self.target
    }

    /// Triangles, #F by 3.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Whether a point is inside of the source or on it, exactly. Coordinates must be zero or between `2^-300` and `2^300` in
    /// size.
    ///
    /// # Complexity
    /// Linear in the number of triangles.
    ///
    /// ```
    /// use homeo::cage::CagePair;
    /// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
    /// let cages = CagePair::new(corners.clone(), corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
    /// assert!(cages.contains([1.0, 1.0, 1.0]) && cages.contains([0.0, 0.0, 1.0]));
    /// assert!(!cages.contains([2.0, 2.0, 2.0]));
    /// # Ok::<(), homeo::cage::CageError>(())
    /// ```
    pub fn contains(&self, point: Point3) -> bool {
        contains(&self.source, &self.triangles, point)
    }
}

fn check(side: CageSide, vertices: &[Point3], triangles: &[[u32; 3]]) -> Result<(), CageError> {
    MeanValuePolyhedron::new(vertices, triangles).map_err(|error| CageError::NotClosed { side, error })?;
    match first_fault(vertices, triangles) {
        Some(violation) => Err(CageError::NotEmbedded { side, violation }),
        None => Ok(()),
    }
}

/// What keeps a closed mesh from being an embedded surface, decided exactly.
pub(super) fn first_fault(vertices: &[Point3], triangles: &[[u32; 3]]) -> Option<Violation> {
    // Corners were looked at before.
    let complex = TriangleComplex::from_indices(vertices.len(), triangles).ok()?;
    let report = analyse_triangles(vertices, &complex, Options { intersections: Intersections::Find });
    // Vertices at one point would be stuck together, which is only a warning elsewhere.
    let is_fault = |v: &Violation| v.severity == Severity::Error || v.code == "coincident-vertices";
    report.violations.into_iter().find(is_fault)
}
