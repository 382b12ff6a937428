//! Sections: one level over each vertex, and where such a section cannot be continued over triangles.
//!
//! # The theorem
//! Let `h = m + 1/2` for a slope `m`. Along an edge from `u` to `v` a section with levels `j` turns by a number that is
//! `j(v) - j(u) - h` modulo the number of layers `N`: the shortest, where only levels are given; that of a field of vectors,
//! where there is one. Round a triangle the turns add up to `-c` modulo `N`, where `c`, 1/2 or -1/2, is the sum of the `h`.
//! So the *index* of the triangle, (sum of turns + `c`) / `N`, is an integer; it is 0 exactly if the section over the sides,
//! run through with these turns, can be continued over the triangle. Turns are antisymmetric and cancel in the sum over a
//! closed surface: *the indices add up to the Euler number*, whatever the section (Poincaré and Hopf). The index of a vertex
//! without a level is that of the polygon of the triangles round it.
//!
//! Sections are not in Yin 2010. Proofs: `docs/theory/bundles.md`, theorems 3, 7 and 8; transport along edges is that of Crane,
//! Desbrun and Schröder 2010.

use super::circle::CircleBundle;
use super::field;
use super::tangent::TangentBundle;
use super::walls::{Side, Walls};
use std::collections::{BTreeMap, HashSet};
use thiserror::Error;

/// One level over each vertex of the surface below a bundle, but for singular ones, and a turn along each edge.
///
/// # Example
/// ```
/// use homeo_manifold::bundle::{Section, TangentBundle};
/// let sphere = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let bundle = TangentBundle::new(&sphere, 4, 8)?.bundle;
/// let levels = (0..bundle.vertex_count()).map(|v| (5 * v % 8) as u32).collect();
/// let section = Section::new(&bundle, levels)?;
/// let indices: i64 = section.singularities().map(|(_, index)| index).sum();
/// assert_eq!(Some(indices), bundle.euler_number());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Section<'b> {
    bundle: &'b CircleBundle,
    levels: Vec<Option<u32>>,
    /// Twice the turn along each side, an odd number; 0 where an end has no level.
    turns: Vec<[i64; 3]>,
}

/// Why levels are no section.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum SectionError {
    #[error("there are {given} values for the {count} vertices of the surface: give one for each")]
    Count { given: usize, count: usize },
    #[error("level {level} of vertex {vertex} is not below the {layers} layers")]
    NoLevel { vertex: u32, level: u32, layers: u32 },
    #[error("vertex {vertex} has no tangent plane, or its vector is not finite: move it, or give another vector")]
    NoDirection { vertex: u32 },
    #[error(
        "the vectors at vertices {first} and {second} are both zero, or normal to the surface, and they are neighbours: an index \
         belongs to a vertex only if all its neighbours have directions; give one of them a direction"
    )]
    Zeros { first: u32, second: u32 },
    #[error(
        "the vectors at the neighbours {first} and {second} are opposite, so that the field may turn either way between them: \
         change one of them, or split the edge"
    )]
    Opposite { first: u32, second: u32 },
    #[error("the triangles at vertex {vertex} have no angles: move it, or its neighbours, apart")]
    Flat { vertex: u32 },
    #[error("there are {given} vectors for the {count} triangles of the surface: give one for each")]
    TriangleCount { given: usize, count: usize },
    #[error(
        "triangle {triangle} has no area: a vector for it has no direction; collapse it, or give vectors at vertices"
    )]
    FlatTriangle { triangle: u32 },
    #[error(
        "the vector of triangle {triangle} is zero, normal to it, or not finite: give it a direction, as indices of such a field \
         belong to vertices"
    )]
    NoVector { triangle: u32 },
    #[error(
        "the vectors of the neighbouring triangles {first} and {second}, laid flat, are opposite, so that the field may turn \
         either way between them: change one of them"
    )]
    OppositeTriangles { first: u32, second: u32 },
    #[error(
        "triangle {triangle} is none of the surface of middles: make the bundle over the triangles of that surface"
    )]
    NotMiddles { triangle: u32 },
    #[error("the surface has a boundary, or is not connected, at triangle {triangle}")]
    NotClosed { triangle: u32 },
}

impl<'b> Section<'b> {
    /// The section with these levels, one for each vertex of the surface.
    ///
    /// # Errors
    /// Another number of levels; a level that there is not.
    pub fn new(bundle: &'b CircleBundle, levels: Vec<u32>) -> Result<Self, SectionError> {
        let (layers, count) = (bundle.layers(), bundle.vertex_count());
        if levels.len() != count {
            return Err(SectionError::Count { given: levels.len(), count });
        }
        if let Some((vertex, &level)) = (0..).zip(&levels).find(|&(_, &level)| level >= layers) {
            return Err(SectionError::NoLevel { vertex, level, layers });
        }
        let turn = |side: Side| shortest_turn(bundle, &levels, side);
        let sides = |triangle: u32| [0, 1, 2].map(|side| turn(Side::new(triangle, side)));
        let turns = (0..bundle.triangles().len() as u32).map(sides).collect();
        Ok(Self { bundle, levels: levels.into_iter().map(Some).collect(), turns })
    }

    /// The section of a field of vectors: for each vertex of the surface below the bundle its place and a vector
    /// (`#V by 3`), of which the part along the surface counts.
    ///
    /// # Guarantee
    /// The index of a triangle is that of the field as [`Section::of_field`] defines it. Cost: linear, but for at most 300
    /// rounds of smoothing, on which nothing but the lengths of paths depends.
    ///
    /// # Errors
    /// As [`Section::of_field`].
    pub fn from_vectors(
        bundle: &'b CircleBundle,
        places: &[[f64; 3]],
        vectors: &[[f64; 3]],
    ) -> Result<Self, SectionError> {
        field::section(bundle, &[], places, vectors)
    }

    /// The section of a field of vectors on a closed surface, given by the places of its vertices and a vector at each
    /// (`#V by 3`). Vertices that the bundle's surface has besides get directions between those at the ends of their edge.
    ///
    /// # Definition of the index
    /// A vector counts by its part along the surface: the normal is the mean of those of the triangles round the vertex,
    /// weighted by their angles there, and its direction is an angle, where the angles round the vertex are scaled to add up to 2π. A
    /// direction is transported along an edge by keeping its angle with it. Along an edge from `u` to `v` the field turns by
    /// `θ`, strictly between -π and π, against the transported direction of `u`. With `Ω`, what the scaled angles of a
    /// triangle exceed π by, its index is `(Σ θ + Ω) / 2π`. A vector that is zero, or normal to the surface, gives its vertex
    /// no level; the vertex has the index of the polygon of the triangles round it.
    ///
    /// # Guarantee
    /// The indices of the section are those, and they add up to the Euler characteristic: integers all along. Directions are
    /// computed in floating point; what they say is refused where a turn is nearer to half a turn than 1e-9, as rounding
    /// could decide it then.
    ///
    /// # Errors
    /// Another number of places or vectors; neighbours of opposite directions, or both without one; angles that are all zero.
    ///
    /// # Example
    /// ```
    /// use homeo_manifold::bundle::{Section, TangentBundle};
    /// let places = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    /// let tangent = TangentBundle::new(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], 4, 8)?;
    /// let section = Section::of_field(&tangent, &places, &[[0.3, -0.2, 0.9]; 4])?;
    /// assert_eq!(section.singularities().map(|(_, index)| index).sum::<i64>(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_field(
        tangent: &'b TangentBundle,
        places: &[[f64; 3]],
        vectors: &[[f64; 3]],
    ) -> Result<Self, SectionError> {
        field::section(&tangent.bundle, &tangent.added, places, vectors)
    }

    /// With levels and twice the turns, which go with them modulo twice the number of layers and are antisymmetric.
    pub(super) fn with_turns(bundle: &'b CircleBundle, levels: Vec<Option<u32>>, turns: Vec<[i64; 3]>) -> Self {
        Self { bundle, levels, turns }
    }

    /// The bundle that it is a section of.
    pub fn bundle(&self) -> &'b CircleBundle {
        self.bundle
    }

    /// The levels, one for each vertex of the surface that is not singular.
    pub fn levels(&self) -> &[Option<u32>] {
        &self.levels
    }

    /// Twice the turn along a side of a triangle, in levels: an odd number, and its opposite from the other side. It is 0
    /// where an end has no level.
    ///
    /// In a section of levels only it is at most `N` either way; where both ways are the shortest, which happens for odd `N`
    /// only, it is positive from the lesser vertex on.
    pub fn turn(&self, side: Side) -> i64 {
        self.turns[side.triangle as usize][usize::from(side.side)]
    }

    /// The index of a triangle; 0 where a corner has no level, see [`Section::singular_vertices`].
    pub fn index(&self, triangle: u32) -> i64 {
        if self.singular_corner(triangle).is_some() {
            return 0;
        }
        let turns: i64 = self.turns[triangle as usize].iter().sum();
        // A bundle has a curvature in each triangle.
        self.whole(turns + self.bundle.turns(triangle).unwrap_or_default())
    }

    /// The triangles with an index other than 0, and the index.
    pub fn singularities(&self) -> impl Iterator<Item = (u32, i64)> + '_ {
        let triangles = 0..self.bundle.triangles().len() as u32;
        triangles.map(|triangle| (triangle, self.index(triangle))).filter(|&(_, index)| index != 0)
    }

    /// The vertices without a level, in order, and their indices; 0 may be among them.
    pub fn singular_vertices(&self) -> Vec<(u32, i64)> {
        let mut sums = BTreeMap::new();
        for triangle in 0..self.bundle.triangles().len() as u32 {
            if let Some(vertex) = self.singular_corner(triangle) {
                // The turns of the sides at the vertex are 0: what is left is that of the opposite side.
                let turns: i64 = self.turns[triangle as usize].iter().sum();
                *sums.entry(vertex).or_insert(0) += turns + self.bundle.turns(triangle).unwrap_or_default();
            }
        }
        sums.into_iter().map(|(vertex, sum)| (vertex, self.whole(sum))).collect()
    }

    fn singular_corner(&self, triangle: u32) -> Option<u32> {
        let corners = self.bundle.triangles()[triangle as usize];
        corners.into_iter().find(|&vertex| self.levels[vertex as usize].is_none())
    }

    /// Twice a turn of the fibre as a number of whole ones.
    fn whole(&self, turns: i64) -> i64 {
        let twice = 2 * i64::from(self.bundle.layers());
        debug_assert_eq!(turns % twice, 0, "a closed path turns by {turns} / 2");
        turns / twice
    }

    /// A path of vertices of the bundle over a side of a triangle, from the section at its start to that at its end: one
    /// edge over the side, and steps along the fibre over the greater vertex, in the direction of the turn.
    ///
    /// Seen from the other side it is the same path, backwards. It is empty where an end has no level.
    ///
    /// ```
    /// use homeo_manifold::bundle::{CircleBundle, Section, Side};
    /// let bundle = CircleBundle::product(&[[0, 1, 2], [0, 2, 3]], 4, 6, &[])?;
    /// let section = Section::new(&bundle, vec![0, 3, 0, 0])?;
    /// let path = section.path(Side::new(0, 0));
    /// assert_eq!((path[0], path[path.len() - 1]), (bundle.vertex(0, 0), bundle.vertex(1, 3)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn path(&self, side: Side) -> Vec<u32> {
        let layers = self.bundle.layers();
        let [from, to] = super::charts::ends(self.bundle.triangles(), side);
        let slope = self.bundle.slopes()[side.triangle as usize][usize::from(side.side)] % layers;
        let (is_forward, turn) = (from < to, self.turn(side));
        let (lesser, greater) = if is_forward { (from, to) } else { (to, from) };
        let (slope, turn) = if is_forward { (slope, turn) } else { (layers - 1 - slope, -turn) };
        // The edge that leaves the fewer steps: the higher one where the section turns upwards.
        let Some(start) = self.levels[lesser as usize].filter(|_| turn != 0) else { return Vec::new() };
        let first = start + slope + u32::from(turn > 0);
        let steps = (turn.unsigned_abs() / 2) as u32;
        let step = if turn > 0 { 1 } else { layers - 1 };
        let mut path = vec![self.bundle.vertex(lesser, start)];
        let levels = (0..=steps).scan(first % layers, |level, _| {
            let here = *level;
            *level = (*level + step) % layers;
            Some(here)
        });
        path.extend(levels.map(|level| self.bundle.vertex(greater, level)));
        if !is_forward {
            path.reverse();
        }
        path
    }
}

impl Section<'_> {
    /// A path for each edge of which both ends have levels, as [`Section::path`] makes it, in the order of the triangles.
    pub fn paths(&self) -> Vec<Vec<u32>> {
        let triangles = self.bundle.triangles();
        let mut is_done = HashSet::new();
        let mut is_first = |&side: &Side| {
            let [from, to] = super::charts::ends(triangles, side);
            is_done.insert([from.min(to), from.max(to)])
        };
        let sides = (0..triangles.len() as u32).flat_map(|t| [0, 1, 2].map(|side| Side::new(t, side)));
        let sides: Vec<Side> = sides.filter(|side| is_first(side)).collect();
        sides.into_iter().map(|side| self.path(side)).filter(|path| !path.is_empty()).collect()
    }
}

/// Twice the shortest turn between two levels.
fn shortest_turn(bundle: &CircleBundle, levels: &[u32], side: Side) -> i64 {
    let layers = i64::from(bundle.layers());
    let [from, to] = super::charts::ends(bundle.triangles(), side);
    let level = |vertex: u32| i64::from(levels[vertex as usize]);
    let slope = i64::from(bundle.slopes()[side.triangle as usize][usize::from(side.side)]);
    let turn = (2 * (level(to) - level(from) - slope) - 1).rem_euclid(2 * layers);
    match turn.cmp(&layers) {
        std::cmp::Ordering::Less => turn,
        std::cmp::Ordering::Equal if from < to => turn,
        _ => turn - 2 * layers,
    }
}

/// The neighbours of the sides of the surface below a bundle, when it is closed.
pub(super) fn closed_walls(bundle: &CircleBundle) -> Result<Walls, SectionError> {
    // The triangles of a bundle are a surface.
    let walls = Walls::new(bundle.triangles()).map_err(|_| SectionError::NotClosed { triangle: 0 })?;
    let open = walls.open_sides().next();
    open.map_or(Ok(walls), |side| Err(SectionError::NotClosed { triangle: side.triangle }))
}

mod check;
#[cfg(test)]
mod field_tests;
#[cfg(test)]
mod middles_tests;
#[cfg(test)]
mod tests;

pub use check::{PathFault, WoundPaths};
