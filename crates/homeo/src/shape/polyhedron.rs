//! Polyhedra between two with the same triangles.

use faer::Mat;
use homeo_core::predicate::is_degenerate_triangle;

use super::rotation::{
    Matrix, add, apply, exponential, gradient, identity, logarithm, polar, scaled, times, transposed,
};
use crate::linear::{GroundedLaplacian, SolveError};

type Point3 = [f64; 3];

/// Why there is no path of polyhedra, or no polyhedron on it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PolyhedronPathError {
    /// The time is not in `[0, 1]`.
    #[error("the time {t} is not between 0 and 1")]
    OutsideTime {
        /// What was asked for.
        t: f64,
    },
    /// There are not as many vertices here as there.
    #[error("the source has {here} vertices and the target {there}: they correspond by number")]
    VertexCounts {
        /// How many in the source.
        here: usize,
        /// How many in the target.
        there: usize,
    },
    /// A coordinate is not finite.
    #[error("vertex {vertex} is not finite")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A corner is no vertex.
    #[error("triangle {triangle} has a corner that is no vertex")]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
    },
    /// A triangle has no area, so that its rotation is not known.
    #[error("triangle {triangle} has no area: move one of its corners, or take the straight path")]
    NoArea {
        /// The triangle.
        triangle: usize,
    },
    /// The triangles do not hang together, or the system could not be solved.
    #[error("{0}; take the straight path")]
    Solve(#[from] SolveError),
}

/// Polyhedra from a source to a target with the same triangles.
pub trait PolyhedronPath: Send + Sync {
    /// The vertices (#V by 3) at a time from 0 to 1: the stored source at 0, the stored target at 1, bit for bit.
    ///
    /// # Errors
    /// The time is not in `[0, 1]`.
    fn at(&self, t: f64) -> Result<Vec<Point3>, PolyhedronPathError>;
}

/// Every vertex moves straight and evenly: `(1 - t) a + t b`.
///
/// Depends on how the polyhedra are placed; one that is turned by a half turn goes flat on the way.
///
/// # References
/// Schneider 2017, sections 3.1 and 3.2.
///
/// # Example
/// ```
/// use homeo::shape::{PolyhedronPath, StraightPolyhedra};
/// let path = StraightPolyhedra::new(vec![[0.0; 3]], vec![[1.0, 2.0, 4.0]])?;
/// assert_eq!(path.at(0.5)?, [[0.5, 1.0, 2.0]]);
/// # Ok::<(), homeo::shape::PolyhedronPathError>(())
/// ```
#[derive(Clone, Debug)]
pub struct StraightPolyhedra {
    source: Vec<Point3>,
    target: Vec<Point3>,
}

impl StraightPolyhedra {
    /// Between vertices that correspond by number, #V by 3 each.
    ///
    /// # Errors
    /// The numbers differ, or a coordinate is not finite.
    pub fn new(source: Vec<Point3>, target: Vec<Point3>) -> Result<Self, PolyhedronPathError> {
        if source.len() != target.len() {
            return Err(PolyhedronPathError::VertexCounts { here: source.len(), there: target.len() });
        }
        let is_bad = |p: &Point3| p.iter().any(|x| !x.is_finite());
        match source.iter().zip(&target).position(|(a, b)| is_bad(a) || is_bad(b)) {
            Some(vertex) => Err(PolyhedronPathError::NotFinite { vertex }),
            None => Ok(Self { source, target }),
        }
    }

    /// The ends, which are not computed.
    fn end(&self, t: f64) -> Result<Option<Vec<Point3>>, PolyhedronPathError> {
        match t {
            0.0 => Ok(Some(self.source.clone())),
            1.0 => Ok(Some(self.target.clone())),
            t if t > 0.0 && t < 1.0 => Ok(None),
            t => Err(PolyhedronPathError::OutsideTime { t }),
        }
    }

    fn between(&self, t: f64) -> Vec<Point3> {
        let mix = |(a, b): (&Point3, &Point3)| [0, 1, 2].map(|k| (1.0 - t) * a[k] + t * b[k]);
        self.source.iter().zip(&self.target).map(mix).collect()
    }
}

impl PolyhedronPath for StraightPolyhedra {
    fn at(&self, t: f64) -> Result<Vec<Point3>, PolyhedronPathError> {
        Ok(self.end(t)?.unwrap_or_else(|| self.between(t)))
    }
}

/// Triangles turn evenly and stretch linearly, and are put together by least squares.
///
/// The affine map of each triangle (with its unit normal) is a rotation times a stretch, `G = R S`; at time `t` it is
/// `R_0^t exp(t log R_0^-1 R) (I + t (S - I))`, with the rotation `R_0` of the mean of all `G`. The vertices are those whose
/// edges come closest, in the sense of least squares, to the images of the edges of the source; their mean moves straight.
///
/// A rotation of the whole by less than a half turn is reproduced, and so is a similarity; parts may turn by less than a
/// half turn relative to the whole. Polyhedra on the way may meet themselves: test them.
///
/// # References
/// Schneider 2017, section 3.2, of the two ways named there the second: Sumner, Popović 2004. *Difference*: the common
/// rotation is split off first, so that a large rotation of the whole does no harm.
///
/// # Complexity
/// One sparse factorization for all times; then linear in the number of triangles for each.
///
/// # Example
/// ```
/// use homeo::shape::{PolyhedronPath, TurningPolyhedra};
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// // A quarter turn about the third axis.
/// let turned = corners.iter().map(|p: &[f64; 3]| [-p[1], p[0], p[2]]).collect();
/// let path = TurningPolyhedra::new(corners, turned, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let middle = path.at(0.5)?;
/// assert!((middle[1][0] - middle[0][0] - 0.5f64.sqrt()).abs() < 1e-14);
/// # Ok::<(), homeo::shape::PolyhedronPathError>(())
/// ```
#[derive(Debug)]
pub struct TurningPolyhedra {
    ends: StraightPolyhedra,
    triangles: Vec<[u32; 3]>,
    /// Logarithm of the common rotation.
    common: Point3,
    /// Of each triangle the logarithm of its rotation relative to the common one, and its stretch.
    parts: Vec<(Point3, Matrix)>,
    laplacian: GroundedLaplacian,
}

impl TurningPolyhedra {
    /// Between vertices that correspond by number (#V by 3 each), with triangles (#F by 3) that hang together.
    ///
    /// # Errors
    /// As for straight paths; a triangle without area, or a vertex that triangles do not join to the others.
    pub fn new(source: Vec<Point3>, target: Vec<Point3>, triangles: &[[u32; 3]]) -> Result<Self, PolyhedronPathError> {
        let ends = StraightPolyhedra::new(source, target)?;
        check_triangles(&ends, triangles)?;
        let gradients: Vec<Matrix> = triangles
            .iter()
            .map(|corners| {
                let of = |points: &[Point3]| corners.map(|v| points[v as usize]);
                gradient(of(&ends.source), of(&ends.target))
            })
            .collect();
        let zero = [[0.0; 3]; 3];
        let mean = gradients.iter().fold(zero, |sum, g| add(&sum, &scaled(g, 1.0 / gradients.len().max(1) as f64)));
        // A mean that is singular has no rotation; then none is split off.
        let common = polar(&mean).map_or(identity(), |(rotation, _)| rotation);
        let back = transposed(&common);
        let part = |(triangle, g): (usize, &Matrix)| {
            let (rotation, stretch) = polar(g).ok_or(PolyhedronPathError::NoArea { triangle })?;
            Ok((logarithm(&times(&back, &rotation)), stretch))
        };
        let parts = gradients.iter().enumerate().map(part).collect::<Result<_, PolyhedronPathError>>()?;
        let laplacian = GroundedLaplacian::of_triangles(ends.source.len(), triangles)?;
        Ok(Self { ends, triangles: triangles.to_vec(), common: logarithm(&common), parts, laplacian })
    }

    fn between(&self, t: f64) -> Vec<Point3> {
        let common = exponential(self.common.map(|x| t * x));
        let mut load = Mat::<f64>::zeros(self.ends.source.len(), 3);
        for (corners, (turn, stretch)) in self.triangles.iter().zip(&self.parts) {
            let stretched = add(&scaled(&identity(), 1.0 - t), &scaled(stretch, t));
            let map = times(&common, &times(&exponential(turn.map(|x| t * x)), &stretched));
            for k in 0..3 {
                let (i, j) = (corners[k] as usize, corners[(k + 1) % 3] as usize);
                let (a, b) = (self.ends.source[i], self.ends.source[j]);
                let edge = apply(&map, [0, 1, 2].map(|m| b[m] - a[m]));
                for m in 0..3 {
                    load[(i, m)] -= edge[m];
                    load[(j, m)] += edge[m];
                }
            }
        }
        let mut places = self.laplacian.solve(load);
        let straight = self.ends.between(t);
        let count = places.len().max(1) as f64;
        let shift = [0, 1, 2].map(|m| straight.iter().zip(&places).map(|(a, b)| a[m] - b[m]).sum::<f64>() / count);
        places.iter_mut().for_each(|place| (0..3).for_each(|m| place[m] += shift[m]));
        places
    }
}

impl PolyhedronPath for TurningPolyhedra {
    fn at(&self, t: f64) -> Result<Vec<Point3>, PolyhedronPathError> {
        Ok(self.ends.end(t)?.unwrap_or_else(|| self.between(t)))
    }
}

fn check_triangles(ends: &StraightPolyhedra, triangles: &[[u32; 3]]) -> Result<(), PolyhedronPathError> {
    for (triangle, corners) in triangles.iter().enumerate() {
        if corners.iter().any(|&v| v as usize >= ends.source.len()) {
            return Err(PolyhedronPathError::NoSuchVertex { triangle });
        }
        for points in [&ends.source, &ends.target] {
            let [a, b, c] = corners.map(|v| points[v as usize]);
            if is_degenerate_triangle(a, b, c) {
                return Err(PolyhedronPathError::NoArea { triangle });
            }
        }
    }
    Ok(())
}
