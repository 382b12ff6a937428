//! A mesh and where it has moved to, vertex by vertex; linear on every cell.

use homeo_core::number::Rational;

use super::exact::{ExactLocation, fractions};
use super::foliation::DEFAULT_ACCURACY;
use super::locate::{FloatLocation, Located, Locator};
use super::{Bijection, Enclosed, EvaluationError, is_flat};
use crate::input::SourceMesh;
use crate::refine::RefinedMesh;

type Point3 = [f64; 3];

/// A few roundings, relative to the sum of the magnitudes.
const FEW: f64 = 16.0 * f64::EPSILON;
/// Signs are exact for coordinates that are zero or between this in magnitude, `2^-300`, and its inverse.
const LEAST: f64 = f64::from_bits((1023 - 300) << 52);

/// Before a mesh has moved, or after.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Before,
    After,
}

/// Why there is no map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MovedMeshError {
    /// There are not as many places as vertices.
    #[error("there are {found} places for {expected} vertices: give one for each")]
    WrongLength {
        /// How many vertices there are.
        expected: usize,
        /// How many places.
        found: usize,
    },
    /// A coordinate, before or after, for which signs are not exact.
    #[error("vertex {0} has a coordinate that is neither zero nor between 2^-300 and 2^300 in size: scale the mesh")]
    OutOfRange(usize),
    /// A cell without volume or area, before or after.
    #[error("cell {0} is flat")]
    Flat(usize),
}

/// A mesh of tetrahedra (`K = 4`) or a surface (`K = 3`), the same with its vertices elsewhere, and the map from the one onto
/// the other that is linear on every cell.
///
/// # Guarantee
/// None by itself: it is one-to-one if its certificate holds, and [`judge`](crate::cage::judge) finds out before one is
/// written. Then `inverse_exact(forward_exact(p)) == p` as rationals. In floating point a point just outside by rounding,
/// and one near a surface, stands for the nearest point of the mesh.
///
/// # Complexity
/// Memory linear in the mesh. A point takes the time of its search in a tree of boxes.
///
/// # Example
/// ```
/// use homeo::input::SourceMesh;
/// use homeo::map::{Bijection, MovedMesh};
/// use homeo_core::mesh::TetrahedronComplex;
/// use homeo_core::number::Rational;
/// let cells = TetrahedronComplex::from_indices(4, &[[0, 1, 2, 3]])?;
/// let before = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let after = vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 1.0]];
/// let map = MovedMesh::new(SourceMesh::new(before, cells), after)?;
/// let third = || &Rational::ONE / &Rational::from(3);
/// let image = map.forward_exact(&[third(), third(), third()])?;
/// assert_eq!(image, [Rational::ONE, third(), third()]);
/// assert_eq!(map.inverse_exact(&image)?, [third(), third(), third()]);
/// let near = map.forward([0.25, 0.25, 0.25])?;
/// assert!((near.point[0] - 0.75).abs() <= near.radius);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct MovedMesh<const K: usize> {
    before: Placed<K>,
    after: Placed<K>,
    /// What a point is located in: the cells as they are.
    unrefined: RefinedMesh<K>,
}

/// A mesh, and how its points are found.
#[derive(Debug)]
struct Placed<const K: usize> {
    mesh: SourceMesh<K>,
    locator: Locator<K>,
}

impl<const K: usize> MovedMesh<K> {
    /// Of a mesh and the places of its vertices after (#V by 3).
    ///
    /// # Errors
    /// The first thing that evaluation cannot do with: another number of places, a coordinate out of range, a flat cell.
    pub fn new(source: SourceMesh<K>, after: Vec<Point3>) -> Result<Self, MovedMeshError> {
        if after.len() != source.positions().len() {
            return Err(MovedMeshError::WrongLength { expected: source.positions().len(), found: after.len() });
        }
        let is_in_range = |x: &f64| *x == 0.0 || (LEAST..=1.0 / LEAST).contains(&x.abs());
        let places = source.positions().iter().zip(&after);
        if let Some(v) = places.into_iter().position(|(p, q)| !p.iter().chain(q).all(is_in_range)) {
            return Err(MovedMeshError::OutOfRange(v));
        }
        let is_flat_on =
            |points: &[Point3], cell: usize| is_flat(&source.complex().cells()[cell].map(|v| points[v.index()]));
        let mut cells = 0..source.complex().cell_count();
        if let Some(cell) = cells.find(|&cell| is_flat_on(source.positions(), cell) || is_flat_on(&after, cell)) {
            return Err(MovedMeshError::Flat(cell));
        }
        let moved = SourceMesh::new(after, source.complex().clone());
        let unrefined = RefinedMesh::unrefined(&source);
        let [before, after] = [source, moved].map(|mesh| Placed { locator: Locator::new(&mesh, &unrefined), mesh });
        Ok(Self { before, after, unrefined })
    }

    /// The mesh before it has moved.
    pub fn source(&self) -> &SourceMesh<K> {
        &self.before.mesh
    }

    /// The mesh after it has moved; its cells are those of the source.
    pub fn moved(&self) -> &SourceMesh<K> {
        &self.after.mesh
    }

    /// Where a point comes from, and where it goes to.
    fn ends(&self, from: Side) -> [&Placed<K>; 2] {
        if from == Side::Before { [&self.before, &self.after] } else { [&self.after, &self.before] }
    }

    fn carry(&self, from: Side, point: Point3) -> Result<Enclosed, EvaluationError> {
        let [here, there] = self.ends(from);
        let located = here.locator.float(&here.mesh, &self.unrefined, point).map_err(|error| named(from, error))?;
        if let Located::Float(at) = &located {
            let answer = there.enclosed(at);
            if answer.radius <= DEFAULT_ACCURACY * there.locator.diagonal() {
                return Ok(answer);
            }
        }
        let at = here.locator.exactly(&here.mesh, &self.unrefined, &located, point);
        let image = there.point(&at.map_err(|error| named(from, error))?).map(|x| x.to_f64());
        let size = image.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        Ok(Enclosed { point: image, radius: size * f64::EPSILON })
    }

    fn carry_exactly(&self, from: Side, point: &[Rational; 3]) -> Result<[Rational; 3], EvaluationError> {
        let [here, there] = self.ends(from);
        let at = here.locator.exact(&here.mesh, &self.unrefined, point).map_err(|error| named(from, error))?;
        Ok(there.point(&at))
    }
}

impl<const K: usize> Placed<K> {
    /// The point with given weights of the vertices of a cell.
    fn point(&self, at: &ExactLocation<K>) -> [Rational; 3] {
        let corners = self.mesh.complex().cell(at.cell).map(|v| self.mesh.positions()[v.index()]);
        let weights = fractions(&at.weights);
        let coordinate = |axis: usize| -> Rational {
            let exact = |i: usize| Rational::from_f64(corners[i][axis]).unwrap_or(Rational::ZERO);
            (0..K).map(|i| &weights[i] * &exact(i)).sum()
        };
        [0, 1, 2].map(coordinate)
    }

    /// The same in floating point: weights add up to 1 exactly, and are known up to errors.
    fn enclosed(&self, at: &FloatLocation<K>) -> Enclosed {
        let corners = self.mesh.complex().cell(at.cell).map(|v| self.mesh.positions()[v.index()]);
        let mut answer = Enclosed { point: corners[0], radius: 0.0 };
        for axis in 0..3 {
            let (mut error, mut magnitude) = (0.0, corners[0][axis].abs());
            for i in 1..K {
                let step = corners[i][axis] - corners[0][axis];
                answer.point[axis] += at.weights[i] * step;
                error += at.errors[i] * step.abs();
                magnitude += (at.weights[i] * step).abs();
            }
            answer.radius = answer.radius.max(error * (1.0 + FEW) + FEW * magnitude);
        }
        answer
    }
}

/// The error for a point, which is one of the mesh after it has moved where that is searched.
fn named(from: Side, error: EvaluationError) -> EvaluationError {
    match error {
        EvaluationError::OutsideSource if from == Side::After => EvaluationError::OutsideMoved,
        other => other,
    }
}

impl<const K: usize> Bijection for MovedMesh<K> {
    fn forward(&self, point: Point3) -> Result<Enclosed, EvaluationError> {
        self.carry(Side::Before, point)
    }

    fn inverse(&self, point: Point3) -> Result<Enclosed, EvaluationError> {
        self.carry(Side::After, point)
    }

    fn forward_exact(&self, point: &[Rational; 3]) -> Result<[Rational; 3], EvaluationError> {
        self.carry_exactly(Side::Before, point)
    }

    fn inverse_exact(&self, point: &[Rational; 3]) -> Result<[Rational; 3], EvaluationError> {
        self.carry_exactly(Side::After, point)
    }
}
