//! Fields with a vector for each triangle, as sections over the surface of the triangles' middles.
//!
//! Each triangle gets a vertex in its middle, and each edge is turned to join the two middles beside it, straight across the
//! two triangles laid flat. So nothing changes but the triangulation; vectors are at middles, the vertices of the source have
//! none, and the index of each is the turning of the vectors along the polygon of the triangles round it, more by 2π less its angles.
//! Theorem 7 of `docs/theory/bundles.md` holds as it stands; the index is that of Crane, Desbrun and Schröder 2010.

use super::field::Field;
use super::identification::Identification;
use super::polar::Polar;
use super::refine::Carrier;
use super::section::{Section, SectionError, closed_walls};
use super::tangent::TangentBundle;
use super::vector::{Vector, cross, dot, plus};
use super::walls::{Side, Walls};

/// A closed surface with a vertex in the middle of each triangle, and its edges turned to join these.
///
/// Vertices are those of the source and then, for each of its triangles, the middle: the centre of the inscribed circle, so that
/// the turned edge crosses the old one between its ends. Triangle `3 t + k` has corner `k` of triangle `t` of the source, the
/// middle across the side that starts there, and the middle of `t`.
///
/// # Example
/// ```
/// use homeo_manifold::bundle::{MiddleSurface, TangentBundle};
/// let places = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let middles = MiddleSurface::new(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], 4)?;
/// let tangent = TangentBundle::new(middles.triangles(), middles.vertex_count(), 8)?;
/// let vectors = [[0.3, -0.2, 0.9], [0.3, -0.2, 0.9], [0.1, 0.5, 0.2], [0.3, -0.2, 0.9]];
/// let section = middles.section(&tangent, &places, &vectors)?;
/// let indices = middles.indices(&tangent, &section);
/// assert_eq!((indices.len(), indices.iter().sum::<i64>()), (4, 2));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct MiddleSurface {
    source: Vec<[u32; 3]>,
    walls: Walls,
    /// The vertices of the source.
    count: usize,
    triangles: Vec<[u32; 3]>,
}

impl MiddleSurface {
    /// For the triangles of a closed, consistently oriented surface. Cost: linear, but for a logarithm.
    ///
    /// # Errors
    /// A side without a triangle across; triangles that are no surface.
    pub fn new(triangles: &[[u32; 3]], vertex_count: usize) -> Result<Self, SectionError> {
        let walls = Walls::new(triangles).map_err(|_| SectionError::NotClosed { triangle: 0 })?;
        let middle = |triangle: u32| vertex_count as u32 + triangle;
        let turned = |side: Side| {
            let across = walls.across(side).ok_or(SectionError::NotClosed { triangle: side.triangle })?;
            let corner = triangles[side.triangle as usize][usize::from(side.side)];
            Ok([corner, middle(across.triangle), middle(side.triangle)])
        };
        let sides = (0..triangles.len() as u32).flat_map(|triangle| [0, 1, 2].map(|k| Side::new(triangle, k)));
        let turned = sides.map(turned).collect::<Result<_, SectionError>>()?;
        Ok(Self { source: triangles.to_vec(), count: vertex_count, triangles: turned, walls })
    }

    /// Its triangles, three for each of the source.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The number of its vertices: those of the source, and a middle for each of its triangles.
    pub fn vertex_count(&self) -> usize {
        self.count + self.source.len()
    }

    /// The places of its vertices, for those of the source (`#V by 3`), to be shown.
    ///
    /// # Errors
    /// Another number of places.
    pub fn places(&self, places: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, SectionError> {
        self.check_count(places)?;
        let middle = |corners: &[u32; 3]| {
            let at = |k: usize| places[corners[k % 3] as usize];
            let opposite = [0, 1, 2].map(|k| length(plus(at(k + 2), at(k + 1), -1.0)));
            let sum: f64 = opposite.iter().sum();
            let weights = if sum > 0.0 { opposite.map(|x| x / sum) } else { [1.0 / 3.0; 3] };
            (0..3).fold([0.0; 3], |point, k| plus(point, at(k), weights[k]))
        };
        Ok(places.iter().copied().chain(self.source.iter().map(middle)).collect())
    }

    /// The section of a field of vectors, one for each triangle of the source (`#F by 3`), of which the part along the triangle
    /// counts; `tangent` is the bundle over [`MiddleSurface::triangles`], `places` are those of the source (`#V by 3`).
    ///
    /// # Definition of the index
    /// Across an edge the field turns by `θ`, strictly between -π and π, when its two triangles are laid flat. A vertex has the
    /// index (sum of the `θ` once round it + 2π - sum of its angles) / 2π, an integer.
    ///
    /// # Guarantee
    /// [`MiddleSurface::indices`] of the section are those, and they add up to the Euler characteristic: integers all along.
    /// Directions are computed in floating point; a turn nearer to half a turn than 1e-9 is refused.
    ///
    /// # Errors
    /// Other numbers of places or vectors, or another bundle; triangles without an area, or whose vector is zero, normal to them
    /// or not finite; neighbours of opposite vectors.
    pub fn section<'b>(
        &self,
        tangent: &'b TangentBundle,
        places: &[[f64; 3]],
        vectors: &[[f64; 3]],
    ) -> Result<Section<'b>, SectionError> {
        self.check_count(places)?;
        let (given, count) = (vectors.len(), self.source.len());
        if given != count {
            return Err(SectionError::TriangleCount { given, count });
        }
        let bundle = &tangent.bundle;
        if bundle.vertex_count() != self.vertex_count() + tangent.added.len() {
            return Err(SectionError::NotMiddles { triangle: 0 });
        }
        let flat = Flat::new(self, tangent, places)?;
        let walls = closed_walls(bundle)?;
        let polar = Polar::new(bundle, &walls, flat.corner_angles()?)?;
        let mut directions = vec![None; self.count];
        for (triangle, &vector) in (0..).zip(vectors) {
            directions.push(Some(flat.direction(&polar, triangle, vector)?));
        }
        let field =
            Field::new(bundle, &walls, &polar, directions, &tangent.added).map_err(|error| self.named(error))?;
        Ok(field.section(&Identification::new(bundle, &walls, &polar)?))
    }

    /// The indices at the vertices of the source, of a section over this surface: all that is singular round each.
    pub fn indices(&self, tangent: &TangentBundle, section: &Section) -> Vec<i64> {
        let mut indices = vec![0; self.count];
        let triangles = section.singularities().map(|(triangle, index)| {
            let parent = tangent.parents[triangle as usize];
            (self.triangles[parent as usize][0], index)
        });
        for (vertex, index) in triangles.chain(section.singular_vertices()) {
            indices[vertex as usize] += index;
        }
        indices
    }

    fn check_count(&self, places: &[Vector]) -> Result<(), SectionError> {
        let (given, count) = (places.len(), self.count);
        if given == count { Ok(()) } else { Err(SectionError::Count { given, count }) }
    }

    /// Middles by the triangles that they are of.
    fn named(&self, error: SectionError) -> SectionError {
        let triangle = |vertex: u32| vertex.checked_sub(self.count as u32);
        if let SectionError::Opposite { first, second } = error
            && let (Some(first), Some(second)) = (triangle(first), triangle(second))
        {
            return SectionError::OppositeTriangles { first, second };
        }
        error
    }
}

/// The triangles of a surface of middles, each laid flat: corner at the origin, the old edge along the first axis.
struct Flat<'a> {
    surface: &'a MiddleSurface,
    tangent: &'a TangentBundle,
    places: &'a [Vector],
    /// For each triangle of the source the radius of its inscribed circle, and how far from each corner this touches.
    circles: Vec<(f64, [f64; 3])>,
    /// The added vertices as means of those of the surface.
    added: Vec<Vec<(u32, f64)>>,
}

impl<'a> Flat<'a> {
    fn new(surface: &'a MiddleSurface, tangent: &'a TangentBundle, places: &'a [Vector]) -> Result<Self, SectionError> {
        let circle = |(triangle, corners): (u32, &[u32; 3])| {
            let edge = |k: usize| plus(places[corners[(k + 1) % 3] as usize], places[corners[k % 3] as usize], -1.0);
            let lengths = [0, 1, 2].map(|k| length(edge(k)));
            let (area, sum) = (length(cross(edge(0), edge(1))), lengths.iter().sum::<f64>());
            let radius = area / sum;
            // The side after a corner, the one before it, less the opposite one.
            let touches = [0, 1, 2].map(|k| (lengths[k] + lengths[(k + 2) % 3] - lengths[(k + 1) % 3]) / 2.0);
            let is_triangle = radius > 0.0 && sum.is_finite();
            is_triangle.then_some((radius, touches)).ok_or(SectionError::FlatTriangle { triangle })
        };
        let circles = (0..).zip(&surface.source).map(circle).collect::<Result<_, _>>()?;
        let mut flat = Self { surface, tangent, places, circles, added: Vec::with_capacity(tangent.added.len()) };
        for carrier in &tangent.added {
            let mean = flat.mean(carrier);
            flat.added.push(mean);
        }
        Ok(flat)
    }

    fn mean(&self, carrier: &Carrier) -> Vec<(u32, f64)> {
        let total = f64::from(carrier.weights.iter().sum::<u32>());
        let parts = carrier.vertices.into_iter().zip(carrier.weights).filter(|(_, weight)| *weight > 0);
        parts.flat_map(|(vertex, weight)| self.shares(vertex, f64::from(weight) / total)).collect()
    }

    fn shares(&self, vertex: u32, share: f64) -> Vec<(u32, f64)> {
        match self.added.get((vertex as usize).wrapping_sub(self.surface.vertex_count())) {
            Some(mean) => mean.iter().map(|&(of, part)| (of, part * share)).collect(),
            None => vec![(vertex, share)],
        }
    }

    /// The corners of a triangle of the surface, laid flat.
    fn corners(&self, parent: u32) -> Option<[[f64; 2]; 3]> {
        let side = Side::new(parent / 3, (parent % 3) as u8);
        let across = self.surface.walls.across(side)?;
        let (radius, touches) = self.circles[side.triangle as usize];
        let (radius_across, touches_across) = self.circles[across.triangle as usize];
        // The side from across ends at the corner.
        let after = (usize::from(across.side) + 1) % 3;
        Some([[0.0; 2], [touches_across[after], -radius_across], [touches[usize::from(side.side)], radius]])
    }

    /// Where a vertex of the base lies in a triangle of the surface, laid flat; nothing where it does not.
    fn place(&self, vertex: u32, parent: u32) -> Option<[f64; 2]> {
        let (corners, names) = (self.corners(parent)?, self.surface.triangles.get(parent as usize)?);
        let mut place = [0.0; 2];
        for (of, share) in self.shares(vertex, 1.0) {
            let [x, y] = corners[names.iter().position(|&name| name == of)?];
            place = [place[0] + share * x, place[1] + share * y];
        }
        Some(place)
    }

    /// The angles of the corners of the base.
    fn corner_angles(&self) -> Result<Vec<[f64; 3]>, SectionError> {
        let angles = |(triangle, (corners, &parent)): (u32, (&[u32; 3], &u32))| {
            let [a, b, c] = corners.map(|vertex| self.place(vertex, parent));
            let (Some(a), Some(b), Some(c)) = (a, b, c) else { return Err(SectionError::NotMiddles { triangle }) };
            Ok([[a, b, c], [b, c, a], [c, a, b]].map(|[v, a, b]| turn(minus(a, v), minus(b, v)).abs()))
        };
        let base = self.tangent.bundle.triangles();
        (0..).zip(base.iter().zip(&self.tangent.parents)).map(angles).collect()
    }

    /// The angle of a vector at the middle of a triangle of the source.
    fn direction(&self, polar: &Polar, triangle: u32, vector: Vector) -> Result<f64, SectionError> {
        let middle = (self.surface.count + triangle as usize) as u32;
        // Only where this triangle is laid flat itself, and not across an edge.
        let is_own = |side: &&Side| self.tangent.parents[side.triangle as usize] / 3 == triangle;
        let not_middles = SectionError::NotMiddles { triangle };
        let side = polar.fans[middle as usize].iter().find(is_own).ok_or(not_middles.clone())?;
        let parent = self.tangent.parents[side.triangle as usize];
        let [from, to] = super::charts::ends(self.tangent.bundle.triangles(), *side);
        let (Some(from), Some(to)) = (self.place(from, parent), self.place(to, parent)) else {
            return Err(not_middles);
        };
        let [along, across] = self.axes(parent);
        let flat = [dot(vector, along), dot(vector, across)];
        // What rounding leaves of a normal vector is no direction.
        let is_direction = flat[0] * flat[0] + flat[1] * flat[1] > 1e-24 * dot(vector, vector);
        if !(is_direction && vector.iter().all(|x| x.is_finite())) {
            return Err(SectionError::NoVector { triangle });
        }
        Ok(polar.angle(*side) + turn(minus(to, from), flat))
    }

    /// Unit vectors along the old edge of a triangle of the surface, and into the triangle of the source.
    fn axes(&self, parent: u32) -> [Vector; 2] {
        let corners = self.surface.source[parent as usize / 3];
        let at = |k: u32| self.places[corners[((parent % 3 + k) % 3) as usize] as usize];
        let [edge, other] = [plus(at(1), at(0), -1.0), plus(at(2), at(0), -1.0)];
        let across = cross(cross(edge, other), edge);
        [edge, across].map(|v| v.map(|x| x / length(v)))
    }
}

fn length(v: Vector) -> f64 {
    dot(v, v).sqrt()
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// The turn from the first vector to the second, from -π to π.
fn turn(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}
