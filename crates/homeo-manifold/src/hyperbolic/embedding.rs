//! A structure in hyperbolic space: one tetrahedron, the fundamental domain, pieces of the universal cover.
//!
//! Source: Yin 2010, section 4.4, which places tetrahedra by the circles in which their planes meet the boundary of the half-space.
//! Here they are placed in Minkowski space, where a plane is a vector, by their Gram matrices; isometries are matrices there,
//! and [`mobius`](super::minkowski::mobius) gives those of the source. All of this is computed in floating point; the residuals say
//! how well edges close.

use super::minkowski::{IDENTITY, Isometry, Vector, apply, compose, inverse, normalized, product};
use super::proof::Structure;
use crate::skeleton::{EDGES, Skeleton};
use crate::triangulation::Triangulation;
use std::collections::{HashMap, VecDeque};

/// A tetrahedron of the cover: which one, and the isometry that brings it from its own place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The tetrahedron.
    pub tetrahedron: u32,
    /// From the place of this tetrahedron in [`Embedding::planes`] to that of the piece.
    pub isometry: Isometry,
}

/// A pair of faces of the fundamental domain that are glued, and the isometry that does it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SidePairing {
    /// Tetrahedron and opposite corner of the first face.
    pub from: (u32, u8),
    /// Of the second.
    pub to: (u32, u8),
    /// Takes the second face, with its tetrahedron, to the first, with its tetrahedron on the other side.
    pub isometry: Isometry,
}

/// The tetrahedra of a fundamental domain in hyperbolic space.
///
/// # Example
/// ```
/// use homeo_manifold::hyperbolic::{Embedding, Structure};
/// use homeo_manifold::{Permutation, Skeleton, Triangulation};
/// let rows = [(0, [1, 2, 3, 0]), (1, [3, 0, 1, 2]), (2, [0, 3, 2, 1]), (3, [0, 2, 1, 3])];
/// let rows = rows.map(|(face, images)| (0, face, 1, Permutation::new(images).unwrap()));
/// let tripus = Triangulation::from_gluings(2, &rows)?;
/// let skeleton = Skeleton::new(&tripus);
/// let embedding = Embedding::new(&tripus, &skeleton, &Structure::find(&tripus, &skeleton)?).unwrap();
/// // Two tetrahedra glued along one face; the other three pairs of faces give isometries.
/// assert_eq!(embedding.side_pairings().len(), 3);
/// assert!(embedding.residuals(&skeleton)[0] < 1e-10);
/// assert_eq!(embedding.cover(1).len(), 2 + 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Embedding {
    /// The truncating planes of each tetrahedron in its place in the domain: outward unit normals.
    planes: Vec<[Vector; 4]>,
    /// For each face the isometry that brings the neighbour from its place to this face.
    across: Vec<[Isometry; 4]>,
    neighbours: Vec<[u32; 4]>,
    pairings: Vec<SidePairing>,
}

impl Embedding {
    /// Places the tetrahedra of a structure, the first with its middle in the middle of the ball, the others breadth first from
    /// face to face; nothing if the structure is that of another triangulation, or if a face is not glued.
    pub fn new(triangulation: &Triangulation, skeleton: &Skeleton, structure: &Structure) -> Option<Self> {
        if structure.cosh_lengths().len() != skeleton.edges().len() || !triangulation.is_closed() {
            return None;
        }
        let cosh = |t: u32| skeleton.edges_of(t).map(|edge| structure.cosh_lengths()[edge as usize].middle());
        let count = triangulation.len() as u32;
        let own: Vec<[Vector; 4]> = (0..count).map(|t| placed(cosh(t))).collect::<Option<_>>()?;
        let step = |t: u32, face: u8| beside(triangulation, &own, t, face);
        let (places, tree) = domain(triangulation, &step)?;
        let mut across = vec![[IDENTITY; 4]; own.len()];
        let mut neighbours = vec![[0; 4]; own.len()];
        let mut pairings = Vec::new();
        for (t, face) in triangulation.faces() {
            let gluing = triangulation.neighbour(t, face)?;
            let there = gluing.tetrahedron;
            let here = compose(&places[t as usize], &step(t, face)?);
            let isometry = compose(&here, &inverse(&places[there as usize]));
            across[t as usize][usize::from(face)] = isometry;
            neighbours[t as usize][usize::from(face)] = there;
            let to = (there, gluing.corners.image(face));
            if (t, face) < to && !tree.contains(&(t, face)) && !tree.contains(&to) {
                pairings.push(SidePairing { from: (t, face), to, isometry });
            }
        }
        let planes = own.iter().zip(&places).map(|(planes, place)| planes.map(|plane| apply(place, plane))).collect();
        Some(Self { planes, across, neighbours, pairings })
    }

    /// The truncating planes of each tetrahedron: `#T by 4` outward unit normals.
    pub fn planes(&self) -> &[[Vector; 4]] {
        &self.planes
    }

    /// The truncating planes of the neighbour across a face of a tetrahedron of the domain, where the two meet at this face: four
    /// outward unit normals, by the neighbour's corners. The face is named by its opposite corner.
    ///
    /// ```
    /// use homeo_manifold::hyperbolic::{Embedding, Structure, minkowski::product};
    /// use homeo_manifold::{Skeleton, from_signature};
    /// let tripus = from_signature("cPcbbbihq")?;
    /// let skeleton = Skeleton::new(&tripus);
    /// let embedding = Embedding::new(&tripus, &skeleton, &Structure::find(&tripus, &skeleton)?).unwrap();
    /// // Planes at the ends of an edge of the face have the hyperbolic cosine of its length as product, from either side.
    /// let [here, there] = [embedding.planes()[0], embedding.planes_across(0, 3)];
    /// assert!((product(here[0], here[1]) - product(there[0], there[1])).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn planes_across(&self, tetrahedron: u32, face: u8) -> [Vector; 4] {
        let (here, face) = (tetrahedron as usize, usize::from(face));
        self.planes[self.neighbours[here][face] as usize].map(|plane| apply(&self.across[here][face], plane))
    }

    /// The faces of the domain that are glued, with the isometries: generators of the fundamental group.
    pub fn side_pairings(&self) -> &[SidePairing] {
        &self.pairings
    }

    /// For each edge the largest entry of the isometry once round it, less the identity.
    pub fn residuals(&self, skeleton: &Skeleton) -> Vec<f64> {
        let round = |isometry: Isometry| {
            let gaps = isometry.as_flattened().iter().zip(IDENTITY.as_flattened()).map(|(a, b)| (a - b).abs());
            gaps.fold(0.0, f64::max)
        };
        let edges = skeleton.edges().iter();
        edges
            .map(|edge| {
                let steps = edge
                    .corners
                    .iter()
                    .map(|corner| self.across[corner.tetrahedron as usize][usize::from(corner.corners.image(2))]);
                round(steps.fold(IDENTITY, |product, step| compose(&product, &step)))
            })
            .collect()
    }

    /// The pieces of the universal cover that are at most `depth` faces away from the fundamental domain, the domain first.
    ///
    /// Pieces are told apart by the middles of their tetrahedra. Those of different pieces are some distance from one another, so
    /// points of the hyperboloid nearer than 1e-5 times their height are one, as rounding grows with the height of a point only.
    ///
    /// Cost: linear in the number of pieces, which grows exponentially with the depth.
    pub fn cover(&self, depth: usize) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = Vec::new();
        let mut seen = Middles::default();
        let mut waiting = VecDeque::new();
        for tetrahedron in 0..self.planes.len() as u32 {
            let piece = Piece { tetrahedron, isometry: IDENTITY };
            seen.insert(self.middle(&piece));
            pieces.push(piece);
            waiting.push_back((piece, 0));
        }
        while let Some((piece, steps)) = waiting.pop_front() {
            if steps == depth {
                continue;
            }
            for face in 0..4 {
                let number = piece.tetrahedron as usize;
                let isometry = compose(&piece.isometry, &self.across[number][face]);
                let next = Piece { tetrahedron: self.neighbours[number][face], isometry };
                if seen.insert(self.middle(&next)) {
                    pieces.push(next);
                    waiting.push_back((next, steps + 1));
                }
            }
        }
        pieces
    }

    /// A point inside of a piece: the sum of its planes' normals, on the hyperboloid.
    pub fn middle(&self, piece: &Piece) -> Vector {
        let planes = self.planes[piece.tetrahedron as usize];
        normalized(apply(&piece.isometry, [0, 1, 2, 3].map(|k| planes.iter().map(|plane| plane[k]).sum())))
    }

    /// The boundary of a piece: four hexagons, then four triangles, each divided into `parts^2` times as many small triangles,
    /// with vertices on the hyperboloid; in Minkowski space they are flat, so straight lines there are geodesics.
    ///
    /// `parts` of 0 counts as 1.
    pub fn surface(&self, piece: &Piece, parts: usize) -> Patches {
        let planes = self.planes[piece.tetrahedron as usize].map(|plane| apply(&piece.isometry, plane));
        // Where the edge ij meets the plane i: v_j + c_ij v_i.
        let corner = |i: usize, j: usize| {
            let cosh = -product(planes[i], planes[j]);
            normalized([0, 1, 2, 3].map(|k| planes[j][k] + cosh * planes[i][k]))
        };
        let mut patches = Patches::default();
        for face in 0..4 {
            let [a, b, c] = [1, 2, 3].map(|k| (face + k) % 4);
            let hexagon = [[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]].map(|[i, j]| corner(i, j));
            let middle = normalized([0, 1, 2, 3].map(|k| hexagon.iter().map(|point| point[k]).sum()));
            for side in 0..6 {
                patches.add([middle, hexagon[side], hexagon[(side + 1) % 6]], parts.max(1), face as u8);
            }
        }
        for vertex in 0..4 {
            let triangle = [1, 2, 3].map(|k| corner(vertex, (vertex + k) % 4));
            patches.add(triangle, parts.max(1), 4 + vertex as u8);
        }
        patches
    }
}

/// Triangles on geodesic planes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Patches {
    /// Vertices on the hyperboloid.
    pub positions: Vec<Vector>,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Of each triangle: 0 to 3 on the hexagon opposite this corner, 4 to 7 on the plane that cuts off corner 0 to 3.
    pub faces: Vec<u8>,
}

impl Patches {
    /// Divides a triangle; points are combined in Minkowski space.
    fn add(&mut self, corners: [Vector; 3], parts: usize, face: u8) {
        let first = self.positions.len() as u32;
        let number = |row: usize, column: usize| first + (row * (row + 1) / 2 + column) as u32;
        for row in 0..=parts {
            for column in 0..=row {
                let weights = [parts - row, row - column, column].map(|weight| weight as f64);
                self.positions.push(normalized([0, 1, 2, 3].map(|k| (0..3).map(|c| weights[c] * corners[c][k]).sum())));
            }
        }
        for row in 0..parts {
            for column in 0..=row {
                self.triangles.push([number(row, column), number(row + 1, column), number(row + 1, column + 1)]);
                if column < row {
                    self.triangles.push([number(row, column), number(row + 1, column + 1), number(row, column + 1)]);
                }
            }
        }
        self.faces.resize(self.triangles.len(), face);
    }
}

/// Points of the hyperboloid that were seen, in cells of their logarithmic height and of their places relative to it.
#[derive(Default)]
struct Middles {
    cells: HashMap<[i64; 3], Vec<Vector>>,
}

impl Middles {
    /// Adds a point unless it is there.
    fn insert(&mut self, point: Vector) -> bool {
        const SIDE: f64 = 1e-3;
        let ball = [1, 2, 3].map(|k| point[k] / (1.0 + point[0]));
        let cell = ball.map(|x| (x / SIDE).floor() as i64);
        let is_same = |other: &Vector| (0..4).all(|k| (other[k] - point[k]).abs() < 1e-5 * point[0]);
        for number in 0..27 {
            let near = std::array::from_fn(|k| cell[k] + [number % 3, number / 3 % 3, number / 9][k] - 1);
            if self.cells.get(&near).is_some_and(|points| points.iter().any(is_same)) {
                return false;
            }
        }
        self.cells.entry(cell).or_default().push(point);
        true
    }
}

/// The planes of a tetrahedron with its middle in the middle of the ball; nothing if there is none.
///
/// Rows of a factor of the Gram matrix: the sum of the planes' normals first, which is inside the light cone, then the
/// directions across it, one after the other.
fn placed(cosh: [f64; 6]) -> Option<[Vector; 4]> {
    let mut gram = [[1.0; 4]; 4];
    for (edge, [i, j]) in EDGES.map(|ends| ends.map(usize::from)).into_iter().enumerate() {
        (gram[i][j], gram[j][i]) = (-cosh[edge], -cosh[edge]);
    }
    let form = |a: [f64; 4], b: [f64; 4]| -> f64 {
        (0..4).map(|i| (0..4).map(|j| a[i] * gram[i][j] * b[j]).sum::<f64>()).sum()
    };
    // An orthonormal basis in coefficients of the normals, by Gram and Schmidt.
    let mut basis: Vec<[f64; 4]> = Vec::with_capacity(4);
    for start in [[1.0; 4], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] {
        let mut vector: [f64; 4] = start;
        for (number, known) in basis.iter().enumerate() {
            let share = form(vector, *known) * if number == 0 { -1.0 } else { 1.0 };
            vector = std::array::from_fn(|k| vector[k] - share * known[k]);
        }
        let square = form(vector, vector) * if basis.is_empty() { -1.0 } else { 1.0 };
        if !(square > 0.0 && square.is_finite()) {
            return None;
        }
        basis.push(vector.map(|x| x / square.sqrt()));
    }
    let unit = |k: usize| std::array::from_fn(|i| f64::from(u8::from(i == k)));
    let coordinate = |k: usize, axis: usize| form(unit(k), basis[axis]) * if axis == 0 { -1.0 } else { 1.0 };
    Some(std::array::from_fn(|k| std::array::from_fn(|axis| coordinate(k, axis))))
}

/// The isometry that brings the neighbour across a face from its own place to the place beside this tetrahedron's own.
fn beside(triangulation: &Triangulation, own: &[[Vector; 4]], tetrahedron: u32, face: u8) -> Option<Isometry> {
    let gluing = triangulation.neighbour(tetrahedron, face)?;
    let (here, there) = (own[tetrahedron as usize], own[gluing.tetrahedron as usize]);
    // Three truncating planes and the plane of the face, which looks out here and in there.
    let others: Vec<u8> = (0..4).filter(|&corner| corner != face).collect();
    let image = |corner: u8| usize::from(gluing.corners.image(corner));
    let face_here = across_normal(others.iter().map(|&c| here[usize::from(c)]), here[usize::from(face)]);
    let face_there = across_normal(others.iter().map(|&c| there[image(c)]), there[image(face)]);
    let mut from = [[0.0; 4]; 4];
    let mut to = [[0.0; 4]; 4];
    for (row, &corner) in others.iter().enumerate() {
        (from[row], to[row]) = (there[image(corner)], here[usize::from(corner)]);
    }
    (from[3], to[3]) = (face_there, face_here.map(|x| -x));
    // The matrix M with M from_k = to_k: the frames are alike, so M = Σ to_k (dual of from_k).
    let dual = invert(from)?;
    Some(std::array::from_fn(|row| std::array::from_fn(|column| (0..4).map(|k| to[k][row] * dual[column][k]).sum())))
}

/// The unit normal of the plane of a face, orthogonal to its three truncating planes, to the side of the fourth.
fn across_normal(planes: impl Iterator<Item = Vector>, fourth: Vector) -> Vector {
    let mut planes = planes;
    let [a, b, c] = std::array::from_fn(|_| planes.next().unwrap_or_default());
    let minor = |skip: usize| {
        let [p, q, r] = [0, 1, 2].map(|k| if k < skip { k } else { k + 1 });
        a[p] * (b[q] * c[r] - b[r] * c[q]) - a[q] * (b[p] * c[r] - b[r] * c[p]) + a[r] * (b[p] * c[q] - b[q] * c[p])
    };
    let normal = [-minor(0), -minor(1), minor(2), -minor(3)];
    let size = product(normal, normal).abs().sqrt();
    let size = if product(normal, fourth) < 0.0 { -size } else { size };
    normal.map(|x| x / size)
}

/// The inverse of a matrix, by elimination with pivots.
fn invert(mut matrix: [[f64; 4]; 4]) -> Option<[[f64; 4]; 4]> {
    let mut inverse = IDENTITY;
    for column in 0..4 {
        let pivot = (column..4).max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))?;
        matrix.swap(column, pivot);
        inverse.swap(column, pivot);
        let scale = 1.0 / matrix[column][column];
        if !scale.is_finite() {
            return None;
        }
        (matrix[column], inverse[column]) = (matrix[column].map(|x| x * scale), inverse[column].map(|x| x * scale));
        for row in (0..4).filter(|&row| row != column) {
            let factor = matrix[row][column];
            for k in 0..4 {
                matrix[row][k] -= factor * matrix[column][k];
                inverse[row][k] -= factor * inverse[column][k];
            }
        }
    }
    Some(inverse)
}

/// The places of all tetrahedra, breadth first from the first of each component, and the faces that were crossed.
type Domain = (Vec<Isometry>, Vec<(u32, u8)>);

fn domain(triangulation: &Triangulation, step: &impl Fn(u32, u8) -> Option<Isometry>) -> Option<Domain> {
    let mut places: Vec<Option<Isometry>> = vec![None; triangulation.len()];
    let mut tree = Vec::new();
    for first in 0..triangulation.len() as u32 {
        if places[first as usize].is_some() {
            continue;
        }
        places[first as usize] = Some(IDENTITY);
        let mut waiting = VecDeque::from([(first, IDENTITY)]);
        while let Some((tetrahedron, place)) = waiting.pop_front() {
            for face in 0..4 {
                let there = triangulation.neighbour(tetrahedron, face)?.tetrahedron;
                if places[there as usize].is_none() {
                    let next = compose(&place, &step(tetrahedron, face)?);
                    places[there as usize] = Some(next);
                    tree.push((tetrahedron, face));
                    waiting.push_back((there, next));
                }
            }
        }
    }
    Some((places.into_iter().collect::<Option<_>>()?, tree))
}

#[cfg(test)]
mod tests;
