//! A domain cut into triangles, certified.

use std::collections::HashSet;

use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::predicate::{Sign, orient2d};
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, Point2 as Position, RefinementParameters, Triangulation as _,
};

/// Why a domain was not cut into triangles, or why triangles do not cut it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TriangulationError {
    /// The triangulator refused a vertex, or merged two.
    #[error("the triangulation refuses vertex {0}: its coordinates are too small or too large")]
    Refused(u32),
    /// A triangle names a vertex that is none, or has no positive area.
    #[error("triangle {0} has no positive area")]
    NotPositive(u32),
    /// The edges of the triangles do not pair up but for those of the domain.
    #[error("the edge from vertex {0} to vertex {1} is not where one triangle, or the boundary, ends and one begins")]
    Unpaired(u32, u32),
    /// There is not one image for each vertex.
    #[error("{images} images were given for {vertices} vertices")]
    OtherCount {
        /// How many vertices there are.
        vertices: usize,
        /// How many images were given.
        images: usize,
    },
}

/// The next vertex of the same ring, for each vertex. Vertices are numbered ring after ring.
pub(super) fn next_vertices(domain: &PlanarDomain) -> Vec<u32> {
    let mut next = Vec::with_capacity(domain.vertex_count());
    for ring in domain.rings() {
        let first = next.len();
        next.extend((1..=ring.len()).map(|k| (first + k % ring.len()) as u32));
    }
    next
}

/// Triangles that tile a domain.
#[derive(Clone, Debug, PartialEq)]
pub struct Tiling {
    /// Corners inside the domain; numbered after the vertices of the domain, which are numbered ring after ring.
    pub added: Vec<Point2>,
    /// Corners run counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
}

/// Angles are made as large as this where edges of the domain, which are not split, allow it. The refinement is known to end
/// by itself for smaller ones; the number of added points is limited anyway.
const DEGREES: f64 = 25.0;
/// So many points are added for each vertex, at most.
const ADDED: usize = 12;

/// Cuts a domain into triangles: the constrained Delaunay triangulation, refined by points inside, not on edges. They become
/// larger away from the vertices.
///
/// # Guarantee
/// What is returned has passed [`check_tiling`]: it tiles the domain, exactly.
///
/// # Errors
/// When the triangulator refuses a vertex, or the result does not pass.
///
/// # Complexity
/// About `O(n log n)`.
///
/// ```
/// use homeo::composite::{check_tiling, triangulate};
/// use homeo_core::planar::PlanarDomain;
/// let square = PlanarDomain::new(vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]]).unwrap();
/// let tiling = triangulate(&square).unwrap();
/// assert!(tiling.triangles.len() >= 2 && check_tiling(&square, &tiling).is_ok());
/// ```
pub fn triangulate(domain: &PlanarDomain) -> Result<Tiling, TriangulationError> {
    let next = next_vertices(domain);
    let mut mesh = Mesh::new();
    let mut handles = Vec::with_capacity(next.len());
    for (number, [x, y]) in domain.vertices().enumerate() {
        let refused = TriangulationError::Refused(number as u32);
        let handle = mesh.insert(Position::new(x, y)).map_err(|_| refused.clone())?;
        if handle.index() != number {
            return Err(refused);
        }
        handles.push(handle);
    }
    for (from, &to) in next.iter().enumerate() {
        if mesh.can_add_constraint(handles[from], handles[to as usize]) {
            mesh.add_constraint(handles[from], handles[to as usize]);
        }
    }
    let plain = tiling_of(&mesh, &next);
    mesh.refine(
        RefinementParameters::new()
            .exclude_outer_faces(true)
            .keep_constraint_edges()
            .with_angle_limit(AngleLimit::from_deg(DEGREES))
            .with_max_additional_vertices(ADDED * next.len()),
    );
    let refined = tiling_of(&mesh, &next);
    if check_tiling(domain, &refined).is_ok() {
        return Ok(refined);
    }
    check_tiling(domain, &plain).map(|()| plain)
}

type Mesh = ConstrainedDelaunayTriangulation<Position<f64>>;

/// The part of a triangulation inside a domain.
fn tiling_of(mesh: &Mesh, next: &[u32]) -> Tiling {
    let added = mesh.vertices().skip(next.len()).map(|vertex| [vertex.position().x, vertex.position().y]).collect();
    Tiling { added, triangles: inner_triangles(mesh, next) }
}

/// The triangles that are reached from the left of boundary edges without crossing one, in order.
fn inner_triangles(mesh: &Mesh, next: &[u32]) -> Vec<[u32; 3]> {
    let mut is_inner = vec![false; mesh.num_all_faces()];
    let mut waiting = Vec::new();
    for edge in mesh.directed_edges() {
        if next.get(edge.from().index()).is_some_and(|&to| to as usize == edge.to().index()) && !edge.face().is_outer()
        {
            waiting.push(edge.face().fix());
        }
    }
    while let Some(face) = waiting.pop() {
        if std::mem::replace(&mut is_inner[face.index()], true) {
            continue;
        }
        for edge in mesh.face(face).as_inner().into_iter().flat_map(|inner| inner.adjacent_edges()) {
            let is_boundary = next.get(edge.from().index()).is_some_and(|&to| to as usize == edge.to().index());
            if !is_boundary && !edge.rev().face().is_outer() {
                waiting.push(edge.rev().face().fix());
            }
        }
    }
    let corners = mesh.inner_faces().filter(|face| is_inner[face.index()]);
    let mut triangles: Vec<[u32; 3]> =
        corners.map(|face| rotated(face.vertices().map(|vertex| vertex.index() as u32))).collect();
    triangles.sort_unstable();
    triangles
}

/// The same triangle with its least corner first.
fn rotated([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    }
}

/// Whether triangles tile a domain: each has a positive area, exactly; of their directed edges none occurs twice, and
/// those whose reverse does not occur are the edges of the domain.
///
/// # Guarantee
/// Then the triangles, as a chain, have the boundary of the domain as boundary. So almost every point of the domain is in
/// exactly one of them, and no point outside in any: the number of triangles round a point is the winding number of the
/// boundary round it. An added point that is a corner is inside the domain: triangles lie all round it.
///
/// # Errors
/// The first triangle or edge that is wrong.
///
/// # Complexity
/// Linear.
pub fn check_tiling(domain: &PlanarDomain, tiling: &Tiling) -> Result<(), TriangulationError> {
    let points: Vec<_> = domain.vertices().chain(tiling.added.iter().copied()).collect();
    let mut edges = HashSet::new();
    for (number, triangle) in tiling.triangles.iter().enumerate() {
        let is_positive = triangle.iter().all(|&corner| (corner as usize) < points.len()) && {
            let [a, b, c] = triangle.map(|corner| points[corner as usize]);
            orient2d(a, b, c) == Sign::Positive
        };
        if !is_positive {
            return Err(TriangulationError::NotPositive(number as u32));
        }
        for k in 0..3 {
            let edge = (triangle[k], triangle[(k + 1) % 3]);
            if !edges.insert(edge) {
                return Err(TriangulationError::Unpaired(edge.0, edge.1));
            }
        }
    }
    let boundary: HashSet<(u32, u32)> =
        next_vertices(domain).into_iter().enumerate().map(|(from, to)| (from as u32, to)).collect();
    let is_wrong = |&(from, to): &(u32, u32)| edges.contains(&(to, from)) == boundary.contains(&(from, to));
    let missing = boundary.iter().copied().filter(|edge| !edges.contains(edge));
    match edges.iter().copied().filter(is_wrong).chain(missing).min() {
        Some((from, to)) => Err(TriangulationError::Unpaired(from, to)),
        None => Ok(()),
    }
}
