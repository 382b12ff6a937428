//! A polygon as coordinates see it: who follows whom, and what lies where as seen from a point.

use homeo_core::planar::PlanarDomain;
use homeo_core::predicate::{Sign, orient2d};

use super::CoordinateError;
use super::accurate::cross;
use super::real::Real;

/// Rings in one list, scaled by a power of two so that the bounding box has a diagonal between 1 and 2: no product of
/// lengths overflows, and nothing is rounded.
#[derive(Clone, Debug)]
pub(super) struct Outline {
    /// Vertices, ring after ring, scaled.
    pub vertices: Vec<[f64; 2]>,
    /// Where each ring begins and ends.
    pub rings: Vec<std::ops::Range<usize>>,
    /// The vertex after each, in its ring. Edge `i` is from vertex `i` to `next[i]`.
    pub next: Vec<usize>,
    /// The vertex before each.
    pub previous: Vec<usize>,
    /// What coordinates were multiplied by.
    pub scale: f64,
}

/// What is seen from a point: vectors to the vertices and their lengths; of each edge the cross and the dot product of
/// the vectors to its ends.
pub(super) struct Sight<T> {
    /// The point, scaled.
    pub point: [f64; 2],
    pub offset: Vec<[T; 2]>,
    pub distance: Vec<T>,
    pub cross: Vec<T>,
    pub dot: Vec<T>,
}

impl Outline {
    pub fn new(domain: &PlanarDomain) -> Self {
        let scale = 2f64.powi(-(domain.diagonal().log2().floor() as i32));
        let vertices: Vec<_> = domain.vertices().map(|p| p.map(|x| x * scale)).collect();
        let mut rings = Vec::new();
        let (mut next, mut previous) = (Vec::new(), Vec::new());
        let mut begin = 0;
        for n in domain.rings().iter().map(Vec::len) {
            next.extend((0..n).map(|i| begin + (i + 1) % n));
            previous.extend((0..n).map(|i| begin + (i + n - 1) % n));
            rings.push(begin..begin + n);
            begin += n;
        }
        Self { vertices, rings, next, previous, scale }
    }

    pub fn count(&self) -> usize {
        self.vertices.len()
    }

    /// A point in the scale of the vertices.
    pub fn local(&self, point: [f64; 2]) -> Result<[f64; 2], CoordinateError> {
        let local = point.map(|x| x * self.scale);
        let is_good = local.iter().all(|x| x.abs() < 1e70);
        if is_good { Ok(local) } else { Err(CoordinateError::NotFinite { point }) }
    }

    /// The vertex at a scaled point.
    pub fn vertex_at(&self, point: [f64; 2]) -> Option<usize> {
        self.vertices.iter().position(|&v| v == point)
    }

    /// The first vertex at which the domain has an inner angle of a half turn or more.
    pub fn first_not_convex(&self) -> Option<usize> {
        let turns = |i: usize| orient2d(self.vertices[self.previous[i]], self.vertices[i], self.vertices[self.next[i]]);
        (0..self.count()).find(|&i| turns(i) != Sign::Positive)
    }

    /// The vector from vertex `i` to vertex `j`.
    pub fn between(&self, i: usize, j: usize) -> [f64; 2] {
        [self.vertices[j][0] - self.vertices[i][0], self.vertices[j][1] - self.vertices[i][1]]
    }

    /// The cross product of the vectors from a scaled point to vertices `i` and `j`.
    pub fn cross<T: Real<2>>(&self, i: usize, j: usize, point: [f64; 2]) -> T {
        let [x, y] = self.between(i, j);
        T::variable(cross(self.vertices[i], self.vertices[j], point), [-y, x])
    }

    /// All that is seen from a scaled point that is no vertex.
    pub fn sight<T: Real<2>>(&self, point: [f64; 2]) -> Sight<T> {
        let offset: Vec<[T; 2]> = self
            .vertices
            .iter()
            .map(|v| [T::variable(v[0] - point[0], [-1.0, 0.0]), T::variable(v[1] - point[1], [0.0, -1.0])])
            .collect();
        let distance = offset.iter().map(|&s| length(s)).collect();
        let cross = (0..self.count()).map(|i| self.cross(i, self.next[i], point)).collect();
        let dot = (0..self.count()).map(|i| dot(offset[i], offset[self.next[i]])).collect();
        Sight { point, offset, distance, cross, dot }
    }
}

/// The length of a vector that is not zero; safe where the square is not.
pub(super) fn length<T: Real<2>>([x, y]: [T; 2]) -> T {
    let square = x * x + y * y;
    if square.value() > 1e-280 {
        return square.sqrt();
    }
    let size = x.value().hypot(y.value());
    (x * (x.value() / size) + y * (y.value() / size)).chain(size, 1.0)
}

/// The dot product.
pub(super) fn dot<T: Real<2>>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}
