//! Sections: one level over each vertex, and where such a section cannot be continued over triangles.
//!
//! # The theorem
//! Let `h = m + 1/2` for a slope `m`. Along an edge from `u` to `v` a section with levels `j` turns by `j(v) - j(u) - h`,
//! reduced modulo the number of layers `N` to the shortest turn. Round a triangle the turns add up to `-c` modulo `N`,
//! where `c`, 1/2 or -1/2, is the sum of the `h`. So the *index* of the triangle, (sum of turns + `c`) / `N`, is an integer;
//! it is 0 exactly if the section over the sides, run through the shortest ways, can be continued over the triangle. Turns
//! are antisymmetric and cancel in the sum over a closed surface: *the indices add up to the Euler number*, whatever the
//! section (Poincaré and Hopf).
//!
//! Sections are not in Yin 2010. Proofs: `docs/theory/bundles.md`, theorem 3; transport along edges is that of Crane,
//! Desbrun and Schröder 2010.

use super::circle::CircleBundle;
use super::walls::{Side, Walls};
use thiserror::Error;

/// One level over each vertex of the surface below a bundle.
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
    levels: Vec<u32>,
}

/// Why levels are no section.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum SectionError {
    #[error("there are {given} values for the {count} vertices of the surface: give one for each")]
    Count { given: usize, count: usize },
    #[error("level {level} of vertex {vertex} is not below the {layers} layers")]
    NoLevel { vertex: u32, level: u32, layers: u32 },
    #[error(
        "the vector at vertex {vertex} has no direction along the surface: give one that is not zero or normal to it"
    )]
    NoDirection { vertex: u32 },
    #[error("the triangles at vertex {vertex} have no angles: move it, or its neighbours, apart")]
    Flat { vertex: u32 },
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
        match (0..).zip(&levels).find(|&(_, &level)| level >= layers) {
            Some((vertex, &level)) => Err(SectionError::NoLevel { vertex, level, layers }),
            None => Ok(Self { bundle, levels }),
        }
    }

    /// The section nearest to a field of vectors: for each vertex of the surface below the bundle its place and a vector
    /// (`#V by 3`), which is projected to the surface.
    ///
    /// Angles round a vertex are scaled to add up to 2π. A level stands for a direction at the first vertex, and at the
    /// others for that to which the transport of the bundle and that of the surface lead along a tree of edges.
    ///
    /// # Guarantee
    /// Indices add up to the Euler number. Which triangles have them depends on the tree too: they are those of the field up
    /// to the difference of the two transports round loops. Cost: linear.
    ///
    /// # Errors
    /// Another number of places or vectors; a vector without a direction along the surface; angles that are all zero; a
    /// surface with a boundary.
    pub fn from_vectors(
        bundle: &'b CircleBundle,
        places: &[[f64; 3]],
        vectors: &[[f64; 3]],
    ) -> Result<Self, SectionError> {
        let levels = super::field::levels(bundle, places, vectors)?;
        Self::new(bundle, levels)
    }

    /// The levels, one for each vertex of the surface.
    pub fn levels(&self) -> &[u32] {
        &self.levels
    }

    /// Twice the turn along a side of a triangle, in levels: an odd number, at most `N` either way, and its opposite from the
    /// other side.
    ///
    /// Where both ways are the shortest, which happens for odd `N` only, it is positive from the lesser vertex on.
    pub fn turn(&self, side: Side) -> i64 {
        let layers = i64::from(self.bundle.layers());
        let [from, to] = super::charts::ends(self.bundle.triangles(), side);
        let level = |vertex: u32| i64::from(self.levels[vertex as usize]);
        let slope = i64::from(self.bundle.slopes()[side.triangle as usize][usize::from(side.side)]);
        let turn = (2 * (level(to) - level(from) - slope) - 1).rem_euclid(2 * layers);
        match turn.cmp(&layers) {
            std::cmp::Ordering::Less => turn,
            std::cmp::Ordering::Equal if from < to => turn,
            _ => turn - 2 * layers,
        }
    }

    /// The index of a triangle: -1, 0 or 1.
    pub fn index(&self, triangle: u32) -> i64 {
        let turns: i64 = [0, 1, 2].map(|side| self.turn(Side::new(triangle, side))).into_iter().sum();
        // A bundle has a curvature in each triangle.
        let curvature = self.bundle.turns(triangle).unwrap_or_default();
        let twice = 2 * i64::from(self.bundle.layers());
        debug_assert_eq!((turns + curvature) % twice, 0, "triangle {triangle} turns by {turns} / 2");
        (turns + curvature) / twice
    }

    /// The triangles with an index other than 0, and the index.
    pub fn singularities(&self) -> impl Iterator<Item = (u32, i64)> + '_ {
        let triangles = 0..self.bundle.triangles().len() as u32;
        triangles.map(|triangle| (triangle, self.index(triangle))).filter(|&(_, index)| index != 0)
    }

    /// A path of vertices of the bundle over a side of a triangle, from the section at its start to that at its end: one
    /// edge over the side, and steps along the fibre over the greater vertex, in the direction of the turn.
    ///
    /// Seen from the other side it is the same path, backwards.
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
        let first = self.levels[lesser as usize] + slope + u32::from(turn > 0);
        let steps = (turn.unsigned_abs() / 2) as u32;
        let step = if turn > 0 { 1 } else { layers - 1 };
        let mut path = vec![self.bundle.vertex(lesser, self.levels[lesser as usize])];
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

/// The neighbours of the sides of the surface below a bundle, when it is closed.
pub(super) fn closed_walls(bundle: &CircleBundle) -> Result<Walls, SectionError> {
    // The triangles of a bundle are a surface.
    let walls = Walls::new(bundle.triangles()).map_err(|_| SectionError::NotClosed { triangle: 0 })?;
    let open = walls.open_sides().next();
    open.map_or(Ok(walls), |side| Err(SectionError::NotClosed { triangle: side.triangle }))
}

#[cfg(test)]
mod tests;
