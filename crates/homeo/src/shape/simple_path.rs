//! Paths on which polygons stay simple, by interpolated convex combinations.

use faer::Mat;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use homeo_core::planar::{DomainPair, PlanarDomain, Point2};

use super::combinations::Combinations;
use super::compatible::{Compatible, FRAME, first_not_positive};
use super::{ShapeError, ShapePath, check_time, mix};

/// Half the side of the frame, for shapes with a bounding box of diagonal 1.
const HALF_FRAME: f64 = 1.5;

/// A path between two simple polygons on which every shape is simple.
///
/// Both shapes, brought to the same place and size, lie in one square frame. Frame and shapes are triangulated alike
/// ([`Self::triangles`]); in both drawings every vertex that is no corner of the frame is a convex combination of its
/// neighbours, by mean value weights. At time `t` the weights are mixed evenly, and vertices are where they fulfil them;
/// place and size are put back, mixed evenly. Domains may have one hole.
///
/// # Guarantee
/// In exact arithmetic every shape is simple: by Floater's theorem every triangle is counter-clockwise at all times. Of
/// the shapes that are returned it is decided exactly, on their stored numbers. The path is continuous; at times 0 and 1
/// it is the stored shapes bit for bit, of which the shapes near are rounded.
///
/// Depends on the direction of the target, not on its place and size. Turned parts may shrink on the way, as on
/// straight paths, and shapes between are crowded where the triangulations have little in common.
///
/// # References
/// Gotsman, Surazhsky 2001; Floater 2003 for the theorem and the weights; Aronov, Seidel, Souvaine 1993 for common
/// triangulations. See `docs/methods/shapes.md`.
///
/// # Example
/// ```
/// use homeo::shape::{LinearPath, ShapePath, SimplePath, first_not_simple};
/// use homeo_core::planar::DomainPair;
/// // The notch goes through to the other side.
/// let source = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 0.5], [0.0, 3.0]];
/// let target = vec![[0.0, 0.0], [1.0, 3.0], [-4.0, 3.0], [-4.0, 0.0], [-2.0, 2.5]];
/// let pair = DomainPair::new(vec![source], vec![target])?;
/// assert!(first_not_simple(&LinearPath::between(&pair)?, 64)?.is_some());
/// assert_eq!(first_not_simple(&SimplePath::between(&pair)?, 64)?, None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimplePath {
    rings: [Vec<Vec<Point2>>; 2],
    places: [Place; 2],
    drawings: [Vec<Point2>; 2],
    triangles: Vec<[u32; 3]>,
    combinations: Combinations,
    symbolic: SymbolicLu<usize>,
}

impl SimplePath {
    /// The path between two domains with one hole or none.
    ///
    /// # Errors
    /// There are more holes, or the common triangulation fails in rounding.
    ///
    /// # Complexity
    /// For `n` vertices and `k` crossings of diagonals of one shape with those of the other, at most `n^2`: `O(n^2 + k)`
    /// and a symbolic factorization; with a hole `O(n^2 log n)`. Each shape takes a sparse factorization of `n + k` rows.
    pub fn between(pair: &DomainPair) -> Result<Self, ShapeError> {
        let holes = pair.source.rings().len() - 1;
        if holes > 1 {
            return Err(ShapeError::TooManyHoles { count: holes });
        }
        let places = [&pair.source, &pair.target].map(Place::of);
        let middle = |domain: &PlanarDomain, place: &Place| {
            let ring = |ring: &Vec<Point2>| ring.iter().map(|&point| place.remove(point)).collect();
            domain.rings().iter().map(ring).collect::<Vec<Vec<Point2>>>()
        };
        let [source, target] = [middle(&pair.source, &places[0]), middle(&pair.target, &places[1])];
        let Compatible { positions, triangles } = Compatible::new(HALF_FRAME, [&source, &target])?;
        let combinations = Combinations::new(&positions, &triangles)?;
        let unsolved = |_| ShapeError::Unsolved { t: 0.5 };
        let symbolic = SymbolicLu::try_new(matrix(&combinations, 0.5)?.symbolic()).map_err(unsolved)?;
        let rings = [pair.source.rings().to_vec(), pair.target.rings().to_vec()];
        Ok(Self { rings, places, drawings: positions, triangles, combinations, symbolic })
    }

    /// The triangles of all drawings (#T by 3), counter-clockwise: numbers of vertices as in [`Self::drawing`].
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Where all vertices are at a time (#V by 2): the corners of the frame, those of the rings, ring after ring, and
    /// added ones.
    ///
    /// # Guarantee
    /// Every triangle is counter-clockwise, exactly, and the frame is a rectangle: so the triangles tile it.
    ///
    /// # Errors
    /// The time is not in `[0, 1]`, or rounding turned a triangle over.
    pub fn drawing(&self, t: f64) -> Result<Vec<Point2>, ShapeError> {
        check_time(t)?;
        let place = Place::between(t, &self.places);
        let end = [0.0, 1.0].iter().position(|&end| t == end);
        let drawing = end.map_or_else(|| self.solved(t), |end| Ok(self.drawings[end].clone()))?;
        let mut drawing: Vec<Point2> = drawing.into_iter().map(|point| place.put(point)).collect();
        if let Some(end) = end {
            let stored = self.rings[end].iter().flatten();
            drawing[FRAME..].iter_mut().zip(stored).for_each(|(point, stored)| *point = *stored);
        }
        match first_not_positive(&drawing, &self.triangles) {
            Some(triangle) => Err(ShapeError::TurnedOver { t, triangle }),
            None => Ok(drawing),
        }
    }

    /// Where vertices fulfil the mixed combinations, in the frame.
    fn solved(&self, t: f64) -> Result<Vec<Point2>, ShapeError> {
        let unsolved = ShapeError::Unsolved { t };
        let matrix = matrix(&self.combinations, t)?;
        let factor = Lu::try_new_with_symbolic(self.symbolic.clone(), matrix.as_ref()).map_err(|_| unsolved.clone())?;
        let mut drawing = self.drawings[0][..FRAME].to_vec();
        let mut right = Mat::<f64>::zeros(self.combinations.count(), 2);
        self.combinations.for_each(t, |row, vertex, weight| {
            if let Some(corner) = drawing.get(vertex) {
                (0..2).for_each(|axis| right[(row, axis)] += weight * corner[axis]);
            }
        });
        let solution = factor.solve(&right);
        drawing.extend((0..solution.nrows()).map(|row| [solution[(row, 0)], solution[(row, 1)]]));
        match drawing.iter().flatten().all(|x| x.is_finite()) {
            true => Ok(drawing),
            false => Err(unsolved),
        }
    }
}

/// Identity less the mixed weights among vertices that are no corners of the frame.
fn matrix(combinations: &Combinations, t: f64) -> Result<SparseColMat<usize, f64>, ShapeError> {
    let count = combinations.count();
    let mut triplets: Vec<_> = (0..count).map(|row| Triplet::new(row, row, 1.0)).collect();
    combinations.for_each(t, |row, vertex, weight| {
        if let Some(column) = vertex.checked_sub(FRAME) {
            triplets.push(Triplet::new(row, column, -weight));
        }
    });
    SparseColMat::try_new_from_triplets(count, count, &triplets).map_err(|_| ShapeError::Unsolved { t })
}

impl ShapePath for SimplePath {
    /// # Errors
    /// As [`Self::drawing`].
    ///
    /// # Complexity
    /// A sparse factorization.
    fn at(&self, t: f64) -> Result<Vec<Vec<Point2>>, ShapeError> {
        check_time(t)?;
        if t == 0.0 || t == 1.0 {
            return Ok(self.rings[t as usize].clone());
        }
        let drawing = self.drawing(t)?;
        let mut rest = drawing[FRAME..].iter().copied();
        Ok(self.rings[0].iter().map(|ring| rest.by_ref().take(ring.len()).collect()).collect())
    }
}

/// Where a shape is, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    centre: Point2,
    size: f64,
}

/// Smaller coordinates become 0, so that signs of triangles are exact.
const LEAST_COORDINATE: f64 = 1e-90;

impl Place {
    fn of(domain: &PlanarDomain) -> Self {
        let [low, high] = domain.bounds();
        Self { centre: [0, 1].map(|axis| mix(0.5, low[axis], high[axis])), size: domain.diagonal() }
    }

    fn between(t: f64, [a, b]: &[Self; 2]) -> Self {
        let centre = [0, 1].map(|axis| mix(t, a.centre[axis], b.centre[axis]));
        Self { centre, size: mix(t, a.size, b.size) }
    }

    fn remove(&self, point: Point2) -> Point2 {
        [0, 1].map(|axis| (point[axis] - self.centre[axis]) / self.size)
    }

    fn put(&self, point: Point2) -> Point2 {
        let put = [0, 1].map(|axis| point[axis] * self.size + self.centre[axis]);
        put.map(|x| if x.abs() < LEAST_COORDINATE { 0.0 } else { x })
    }
}

#[cfg(test)]
mod tests;
