//! Coordinates of polyhedra with triangular faces.

use std::collections::HashMap;

use homeo_core::predicate::{Sign, orient3d};

use super::CoordinateError;
use super::real::{Jet, Real};
use super::spatial::SpatialCoordinates;
use super::weighted::{check_length, lagrange, normalise};

/// Why triangles bound no polyhedron that a kind is for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PolyhedronError {
    /// A corner is no vertex.
    #[error("triangle {triangle} has a corner that is none of the {count} vertices")]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// How many vertices there are.
        count: usize,
    },
    /// A coordinate is not finite.
    #[error("vertex {vertex} is not finite")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// An edge has not exactly two triangles that run along it in opposite directions.
    #[error("edge {from} to {to} is not that of one triangle, and of one other the other way round")]
    NotClosed {
        /// The first vertex.
        from: u32,
        /// The second.
        to: u32,
    },
    /// A vertex lies on the outer side of a triangle.
    #[error("vertex {vertex} lies outside triangle {triangle}: the polyhedron is not convex, or turned inside out")]
    NotConvex {
        /// The vertex.
        vertex: usize,
        /// The triangle.
        triangle: usize,
    },
    /// A triangle has no area.
    #[error("triangle {triangle} has no area: take it away, or move one of its corners")]
    NoArea {
        /// The triangle.
        triangle: usize,
    },
    /// A vertex is no corner of the polyhedron: all its triangles lie in one or two planes.
    #[error("vertex {vertex} is no corner: its triangles lie in fewer than three planes")]
    NoCorner {
        /// The vertex.
        vertex: usize,
    },
}

type Point3 = [f64; 3];

/// Wachspress coordinates of a convex polyhedron (Warren 1996; in the form of Floater, Gillette, Sukumar 2014), given by
/// a closed mesh of triangles that are counter-clockwise as seen from outside; triangles in one plane make one face.
///
/// The weight of a vertex is the sum of `det(n_a, n_b, n_c) / (h_a h_b h_c)` over a fan of the planes at it, `n` the unit
/// normals and `h` the distances of the point from the planes. All are multiplied by the three smallest distances: linear
/// on faces that are triangles, and smooth up to faces and edges. Positive inside.
///
/// # Complexity
/// Linear in the number of triangles.
///
/// ```
/// use homeo::coordinates::{SpatialCoordinates, WachspressPolyhedron};
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let kind = WachspressPolyhedron::new(&corners, &triangles)?;
/// let (mut values, mut gradients) = ([0.0; 4], [[0.0; 3]; 4]);
/// kind.gradients_into([0.2, 0.3, 0.1], &mut values, &mut gradients)?;
/// assert!((values[1] - 0.2).abs() < 1e-14 && (gradients[1][0] - 1.0).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct WachspressPolyhedron {
    vertices: Vec<Point3>,
    /// Of each plane the inner unit normal and a vertex on it.
    planes: Vec<(Point3, Point3)>,
    /// Of each vertex the terms of its weight: three planes and the determinant of their normals.
    terms: Vec<Vec<([usize; 3], f64)>>,
    diagonal: f64,
}

impl WachspressPolyhedron {
    /// Of a closed convex mesh.
    ///
    /// # Errors
    /// What is wrong with the mesh, the first thing found.
    ///
    /// # Complexity
    /// The number of vertices times that of triangles, to decide exactly whether it is convex.
    pub fn new(vertices: &[Point3], triangles: &[[u32; 3]]) -> Result<Self, PolyhedronError> {
        let next = followers(vertices, triangles)?;
        check_convex(vertices, triangles)?;
        let plane_of = planes_of(vertices, triangles, &next);
        let corner = |t: usize| triangles[t].map(|v| vertices[v as usize]);
        let planes: Vec<_> = (0..triangles.len()).map(|t| (inner_normal(corner(t)), corner(t)[0])).collect();
        let mut terms = Vec::with_capacity(vertices.len());
        for vertex in 0..vertices.len() {
            let fan = fan_of(vertex as u32, triangles, &next, &plane_of);
            if fan.len() < 3 {
                return Err(PolyhedronError::NoCorner { vertex });
            }
            let term = |k: usize| {
                let three = [fan[0], fan[k], fan[k + 1]];
                // Planes are met clockwise as the inner normals see them.
                (three, determinant(three.map(|plane| planes[plane].0)).abs())
            };
            terms.push((1..fan.len() - 1).map(term).collect());
        }
        let range = |k: usize| {
            let all = || vertices.iter().map(|v| v[k]);
            all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
        };
        let diagonal = range(0).hypot(range(1)).hypot(range(2));
        Ok(Self { vertices: vertices.to_vec(), planes, terms, diagonal })
    }

    fn weights<T: Real<3>>(&self, point: Point3) -> Result<Vec<T>, CoordinateError> {
        let distance = |(normal, on): &(Point3, Point3)| {
            let height: f64 = (0..3).map(|k| normal[k] * (point[k] - on[k])).sum();
            T::variable(height / self.diagonal, normal.map(|x| x / self.diagonal))
        };
        let heights: Vec<T> = self.planes.iter().map(distance).collect();
        let used = self.terms.iter().flatten().flat_map(|(planes, _)| planes.iter().copied());
        let mut smallest: Vec<usize> = used.collect();
        smallest.sort_unstable();
        smallest.dedup();
        smallest.sort_by(|&i, &j| heights[i].value().total_cmp(&heights[j].value()));
        smallest.truncate(3);
        if !point.iter().all(|x| x.is_finite()) || heights[smallest[0]].value() < -1e-12 {
            return Err(CoordinateError::OutsidePolyhedron { point });
        }
        let share = |(planes, determinant): &([usize; 3], f64)| {
            let mut share = T::constant(*determinant);
            for &plane in smallest.iter().filter(|plane| !planes.contains(plane)) {
                share = share * heights[plane];
            }
            planes.iter().filter(|plane| !smallest.contains(plane)).fold(share, |share, &plane| share / heights[plane])
        };
        let sum = |terms: &Vec<_>| terms.iter().map(share).fold(T::constant(0.0), |a, b| a + b);
        Ok(self.terms.iter().map(sum).collect())
    }
}

impl SpatialCoordinates for WachspressPolyhedron {
    fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    fn values_into(&self, point: Point3, values: &mut [f64]) -> Result<(), CoordinateError> {
        check_length(self.vertices.len(), values.len())?;
        if let Some(vertex) = self.vertices.iter().position(|&v| v == point) {
            lagrange(vertex, values);
            return Ok(());
        }
        let weights = self.weights::<f64>(point)?;
        let total: f64 = weights.iter().sum();
        values.iter_mut().zip(&weights).for_each(|(value, weight)| *value = weight / total);
        check_space(total, point)
    }

    fn gradients_into(
        &self,
        point: Point3,
        values: &mut [f64],
        gradients: &mut [Point3],
    ) -> Result<(), CoordinateError> {
        check_length(self.vertices.len(), values.len())?;
        check_length(self.vertices.len(), gradients.len())?;
        if let Some(vertex) = self.vertices.iter().position(|&v| v == point) {
            return Err(CoordinateError::NoGradient { vertex });
        }
        let weights = self.weights::<Jet<3>>(point)?;
        check_space(normalise(&weights, values, gradients), point)
    }
}

fn check_space(total: f64, point: Point3) -> Result<(), CoordinateError> {
    if total > 0.0 && total.is_finite() { Ok(()) } else { Err(CoordinateError::OutsidePolyhedron { point }) }
}

/// Refuses what is not a closed mesh in which neighbours agree on orientation.
pub(super) fn check_closed(vertices: &[Point3], triangles: &[[u32; 3]]) -> Result<(), PolyhedronError> {
    followers(vertices, triangles).map(|_| ())
}

/// Of each directed edge its triangle.
fn followers(vertices: &[Point3], triangles: &[[u32; 3]]) -> Result<HashMap<(u32, u32), usize>, PolyhedronError> {
    if let Some(vertex) = vertices.iter().position(|v| !v.iter().all(|x| x.is_finite())) {
        return Err(PolyhedronError::NotFinite { vertex });
    }
    let mut found = HashMap::new();
    for (triangle, corners) in triangles.iter().enumerate() {
        if corners.iter().any(|&v| v as usize >= vertices.len()) {
            return Err(PolyhedronError::NoSuchVertex { triangle, count: vertices.len() });
        }
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            if found.insert((from, to), triangle).is_some() {
                return Err(PolyhedronError::NotClosed { from, to });
            }
        }
    }
    let mut open: Vec<(u32, u32)> = found.keys().copied().filter(|&(a, b)| !found.contains_key(&(b, a))).collect();
    open.sort_unstable();
    match open.first() {
        Some(&(from, to)) => Err(PolyhedronError::NotClosed { from, to }),
        None => Ok(found),
    }
}

/// Which side of a triangle a vertex is on; positive inside.
fn side(vertices: &[Point3], corners: [u32; 3], vertex: usize) -> Sign {
    let [a, b, c] = corners.map(|v| vertices[v as usize]);
    orient3d(a, b, c, vertices[vertex])
}

fn check_convex(vertices: &[Point3], triangles: &[[u32; 3]]) -> Result<(), PolyhedronError> {
    // What `orient3d` calls positive is found out by a tetrahedron that is known.
    let inside = orient3d([0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    for (triangle, &corners) in triangles.iter().enumerate() {
        let outside = |&vertex: &usize| side(vertices, corners, vertex) == inside.reversed();
        if let Some(vertex) = (0..vertices.len()).find(outside) {
            return Err(PolyhedronError::NotConvex { vertex, triangle });
        }
    }
    Ok(())
}

/// Of each triangle the first triangle in its plane, found over edges.
fn planes_of(vertices: &[Point3], triangles: &[[u32; 3]], next: &HashMap<(u32, u32), usize>) -> Vec<usize> {
    let mut plane = vec![usize::MAX; triangles.len()];
    for first in 0..triangles.len() {
        if plane[first] != usize::MAX {
            continue;
        }
        let mut waiting = vec![first];
        plane[first] = first;
        while let Some(t) = waiting.pop() {
            for k in 0..3 {
                let other = next[&(triangles[t][(k + 1) % 3], triangles[t][k])];
                let is_flat = triangles[other].iter().all(|&v| side(vertices, triangles[t], v as usize) == Sign::Zero);
                if plane[other] == usize::MAX && is_flat {
                    plane[other] = first;
                    waiting.push(other);
                }
            }
        }
    }
    plane
}

/// The planes round a vertex, in order, each once.
fn fan_of(vertex: u32, triangles: &[[u32; 3]], next: &HashMap<(u32, u32), usize>, plane: &[usize]) -> Vec<usize> {
    let Some(first) = triangles.iter().position(|t| t.contains(&vertex)) else { return Vec::new() };
    let (mut fan, mut t) = (Vec::new(), first);
    loop {
        if fan.last() != Some(&plane[t]) {
            fan.push(plane[t]);
        }
        let k = triangles[t].iter().position(|&v| v == vertex).unwrap_or(0);
        t = next[&(vertex, triangles[t][(k + 2) % 3])];
        if t == first {
            break;
        }
    }
    if fan.len() > 1 && fan.last() == fan.first() {
        fan.pop();
    }
    fan
}

fn inner_normal([a, b, c]: [Point3; 3]) -> Point3 {
    let (p, q) = ([0, 1, 2].map(|k| c[k] - a[k]), [0, 1, 2].map(|k| b[k] - a[k]));
    let normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let length = normal[0].hypot(normal[1]).hypot(normal[2]);
    normal.map(|x| x / length)
}

fn determinant([a, b, c]: [Point3; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}
