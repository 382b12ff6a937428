//! The faces of pieces of the universal cover, to be drawn.

use homeo_manifold::hyperbolic::minkowski::{Vector, in_ball, in_half_space, normalized, product};
use homeo_manifold::hyperbolic::{Embedding, Patches, Piece};
use std::collections::HashMap;

/// A model of hyperbolic space. Both keep angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// The unit ball about the origin; geodesic planes are parts of spheres at right angles to the unit sphere.
    Ball,
    /// The half-space of points with positive third coordinate; the middle of the ball is at `(0, 0, 1)`.
    HalfSpace,
}

impl Model {
    /// The place of a point of the hyperboloid.
    ///
    /// ```
    /// use homeo::export::Model;
    /// assert_eq!(Model::Ball.place([1.0, 0.0, 0.0, 0.0]), [0.0, 0.0, 0.0]);
    /// assert_eq!(Model::HalfSpace.place([1.0, 0.0, 0.0, 0.0]), [0.0, 0.0, 1.0]);
    /// ```
    pub fn place(self, point: Vector) -> [f64; 3] {
        match self {
            Self::Ball => in_ball(point),
            Self::HalfSpace => in_half_space(point),
        }
    }
}

/// What a face of a truncated tetrahedron is in the fundamental domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FaceKind {
    /// On the geodesic boundary: a triangle that cuts off a vertex.
    Boundary,
    /// A hexagon between two tetrahedra of the domain.
    Inner,
    /// A hexagon on the boundary of the domain, with the number of its side pairing.
    Side(u32),
}

/// Triangles on the faces of pieces of the universal cover, in coordinates of a model.
///
/// Pieces come in the order of [`Embedding::cover`], and so do triangles, lines and vertices: those of a smaller depth first.
///
/// # Example
/// ```
/// use homeo::export::{CoverPicture, Model};
/// use homeo_manifold::{Skeleton, from_signature, hyperbolic::{Embedding, Structure}};
/// let tripus = from_signature("cPcbbbihq")?;
/// let skeleton = Skeleton::new(&tripus);
/// let embedding = Embedding::new(&tripus, &skeleton, &Structure::find(&tripus, &skeleton)?).unwrap();
/// let picture = CoverPicture::new(&embedding, 0, Model::Ball, 3);
/// // Two tetrahedra with four hexagons of six parts and four triangles, each divided into nine.
/// assert_eq!(picture.triangles.len(), 2 * 28 * 9);
/// assert!(picture.positions.iter().all(|[x, y, z]| x * x + y * y + z * z < 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct CoverPicture {
    /// Vertices, `#V by 3`.
    pub positions: Vec<[f64; 3]>,
    /// Unit normals of the faces there, out of their piece, `#V by 3`.
    pub normals: Vec<[f64; 3]>,
    /// On what kind of face each vertex is, `#V`; no vertex is on two faces.
    pub kinds: Vec<FaceKind>,
    /// The piece of each vertex, `#V`.
    pub pieces: Vec<u32>,
    /// Corners of triangles, counterclockwise seen from outside of their piece, `#F by 3`.
    pub triangles: Vec<[u32; 3]>,
    /// Segments of the edges of hexagons, `#L by 2`.
    pub lines: Vec<[u32; 2]>,
    /// The middle of each piece, `#P by 3`.
    pub middles: Vec<[f64; 3]>,
}

impl CoverPicture {
    /// The faces of all pieces that are at most `depth` faces from the fundamental domain, each of 28 parts divided into `parts^2`
    /// triangles.
    ///
    /// Cost: linear in the triangles; pieces grow exponentially with the depth.
    pub fn new(embedding: &Embedding, depth: usize, model: Model, parts: usize) -> Self {
        let parts = parts.max(1);
        let kinds = kinds(embedding);
        let mut picture = Self::default();
        for piece in embedding.cover(depth) {
            picture.add_piece(embedding, &piece, &kinds, model, parts);
        }
        picture
    }

    fn add_piece(&mut self, embedding: &Embedding, piece: &Piece, kinds: &Kinds, model: Model, parts: usize) {
        let middle = embedding.middle(piece);
        let patches = embedding.surface(piece, parts);
        let (vertices, triangles) = ((parts + 1) * (parts + 2) / 2, parts * parts);
        let faces = patches.faces.iter().step_by(triangles);
        for (number, &face) in faces.enumerate() {
            let kind = if face < 4 {
                kinds.get(&(piece.tetrahedron, face)).copied().unwrap_or(FaceKind::Inner)
            } else {
                FaceKind::Boundary
            };
            let first = self.positions.len() as u32;
            let offset = first.wrapping_sub((number * vertices) as u32);
            self.add_patch(&patches.positions[number * vertices..][..vertices], middle, model);
            self.kinds.resize(self.positions.len(), kind);
            self.pieces.resize(self.positions.len(), self.middles.len() as u32);
            self.add_triangles(&patches, number * triangles..(number + 1) * triangles, offset);
            // The last row of a part of a hexagon is on its edge.
            if face < 4 {
                let end = first + vertices as u32 - 1;
                self.lines.extend((0..parts as u32).map(|step| [end - step - 1, end - step]));
            }
        }
        self.middles.push(model.place(middle));
    }

    /// Vertices of a part of a face with its normals: images of the normal of its plane, as the models keep angles.
    fn add_patch(&mut self, points: &[Vector], middle: Vector, model: Model) {
        let corners = [0, points.len() - rows(points.len()), points.len() - 1].map(|number| points[number]);
        let plane = plane_through(corners, middle);
        for &point in points {
            let place = model.place(point);
            let beside = model.place(normalized(std::array::from_fn(|k| point[k] + NEAR * plane[k])));
            let direction: [f64; 3] = std::array::from_fn(|k| beside[k] - place[k]);
            let size = direction.iter().map(|x| x * x).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
            self.positions.push(place);
            self.normals.push(direction.map(|x| x / size));
        }
    }

    fn add_triangles(&mut self, patches: &Patches, range: std::ops::Range<usize>, offset: u32) {
        for corners in &patches.triangles[range] {
            let [a, b, c] = corners.map(|corner| corner.wrapping_add(offset));
            let is_outward = self.side([a, b, c]) > 0.0;
            self.triangles.push(if is_outward { [a, b, c] } else { [a, c, b] });
        }
    }

    /// The triple product of two sides of a triangle and a normal.
    fn side(&self, corners: [u32; 3]) -> f64 {
        let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
        let normal = self.normals[corners[0] as usize];
        let [u, v]: [[f64; 3]; 2] = [b, c].map(|end| std::array::from_fn(|k| end[k] - a[k]));
        (0..3).map(|k| (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]) * normal[k]).sum()
    }
}

/// A step along a normal: far above rounding, far below what is seen.
const NEAR: f64 = 1e-5;

/// The points in the last row of a triangle of points.
fn rows(points: usize) -> usize {
    (1..).find(|rows| rows * (rows + 1) / 2 >= points).unwrap_or(1)
}

type Kinds = HashMap<(u32, u8), FaceKind>;

/// The kinds of the hexagons on the boundary of the domain.
fn kinds(embedding: &Embedding) -> Kinds {
    let pairings = embedding.side_pairings().iter().zip(0..);
    pairings.flat_map(|(side, number)| [side.from, side.to].map(|face| (face, FaceKind::Side(number)))).collect()
}

/// The unit normal of the plane through three points, away from another one.
fn plane_through([a, b, c]: [Vector; 3], inside: Vector) -> Vector {
    let minor = |skip: usize| {
        let [p, q, r] = [0, 1, 2].map(|k| if k < skip { k } else { k + 1 });
        a[p] * (b[q] * c[r] - b[r] * c[q]) - a[q] * (b[p] * c[r] - b[r] * c[p]) + a[r] * (b[p] * c[q] - b[q] * c[p])
    };
    // Orthogonal for the product of Minkowski space, in which times have the other sign.
    let normal = [-minor(0), -minor(1), minor(2), -minor(3)];
    let size = product(normal, normal).abs().sqrt();
    let size = if product(normal, inside) > 0.0 { -size } else { size };
    normal.map(|x| x / size)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use homeo_manifold::hyperbolic::Structure;
    use homeo_manifold::{Skeleton, from_signature};

    pub(crate) fn embedding(signature: &str) -> Embedding {
        let triangulation = from_signature(signature).expect("a signature");
        let skeleton = Skeleton::new(&triangulation);
        let structure = Structure::find(&triangulation, &skeleton).expect("a structure");
        Embedding::new(&triangulation, &skeleton, &structure).expect("an embedding")
    }

    /// The inverse point of the middle of the sphere that has a normal at a point and meets the unit sphere at right angles: with
    /// the middle `m = p + s n` this is `|m|^2 = 1 + s^2`. Planes through the origin give the origin.
    fn pole(p: [f64; 3], n: [f64; 3]) -> [f64; 3] {
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let size = 0.5 * (1.0 - dot(p, p)) / dot(p, n);
        let middle: [f64; 3] = std::array::from_fn(|k| p[k] + size * n[k]);
        middle.map(|x| x / dot(middle, middle))
    }

    /// How far the poles of the vertices of each part of a face are from one another, with places scaled.
    fn spreads(picture: &CoverPicture, scale: f64, per_part: usize) -> Vec<f64> {
        let poles: Vec<_> =
            picture.positions.iter().zip(&picture.normals).map(|(p, n)| pole(p.map(|x| scale * x), *n)).collect();
        let spread = |part: &[[f64; 3]]| {
            let gaps = part.iter().flat_map(|pole| (0..3).map(|k| (pole[k] - part[0][k]).abs()));
            gaps.fold(0.0, f64::max)
        };
        poles.chunks_exact(per_part).map(spread).collect()
    }

    #[test]
    fn faces_are_parts_of_spheres_at_right_angles_to_the_unit_sphere() {
        let picture = CoverPicture::new(&embedding("dLQbcccdefo"), 1, Model::Ball, 3);
        let found = spreads(&picture, 1.0, 10);
        assert!(found.len() > 300 && found.iter().all(|&spread| spread < 1e-3), "{found:?}");
        // Negative control: in a ball of another size they are not.
        let control = spreads(&picture, 0.9, 10);
        assert!(control.iter().filter(|&&spread| spread > 1e-2).count() > 100, "{control:?}");
    }

    #[test]
    fn smaller_depths_come_first_and_every_side_has_two_faces() {
        let embedding = embedding("cPcbbbihq");
        let [small, large] = [0, 1].map(|depth| CoverPicture::new(&embedding, depth, Model::HalfSpace, 2));
        assert_eq!(small.positions, large.positions[..small.positions.len()]);
        assert_eq!(small.triangles, large.triangles[..small.triangles.len()]);
        assert!(large.positions.iter().all(|point| point[2] > 0.0));
        for number in 0..3 {
            let count = small.kinds.iter().filter(|kind| **kind == FaceKind::Side(number)).count();
            // Two hexagons of six parts of six vertices.
            assert_eq!(count, 2 * 6 * 6);
        }
    }

    #[test]
    fn triangles_look_out_of_their_piece() {
        let picture = CoverPicture::new(&embedding("cPcbbbihq"), 1, Model::Ball, 4);
        assert!(picture.triangles.iter().all(|&corners| picture.side(corners) > 0.0));
        let is_outward = |v: usize| {
            let middle = picture.middles[picture.pieces[v] as usize];
            (0..3).map(|k| (picture.positions[v][k] - middle[k]) * picture.normals[v][k]).sum::<f64>() > 0.0
        };
        let outward = (0..picture.positions.len()).filter(|&v| is_outward(v)).count();
        // Faces are curved in the model, towards the unit sphere.
        assert!(outward * 10 > picture.positions.len() * 9, "{outward} of {}", picture.positions.len());
    }
}
