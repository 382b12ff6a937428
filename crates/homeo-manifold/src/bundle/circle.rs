//! Circle bundles with regular structure: a fibre of equal resolution over each vertex.
//!
//! # The theorem
//! Over each vertex stands a circle of `N` edges. Over an edge from `u` to `v` stands an annulus, cut by `2 N` edges that
//! join level `j` of `u` with the levels `j + m` and `j + m + 1` of `v`: `m`, counted modulo `N`, is the *slope*, and seen
//! from `v` it is `-m - 1`. Over a triangle the three annuli bound a solid torus. It is filled by `3 N` tetrahedra, without
//! further vertices, if and only if the three slopes round the triangle add up to `-1` or `-2` modulo `N`.
//!
//! With `h = m + 1/2` the slopes are an antisymmetric function of directed edges, and the sums round triangles are `-1/2`
//! and `1/2`: a connection with as little curvature in each triangle as there can be. Added up over a closed surface, they
//! are `N` times the *Euler number* of the bundle, which classifies it; that of the unit tangent bundle is the Euler
//! characteristic. The tetrahedra form a simplicial complex if the triangles do and `N` is at least 3.
//!
//! Proofs: `docs/theory/bundles.md`, theorems 2 to 4.

use super::walls::{Side, WallError, Walls};
use thiserror::Error;

/// A circle bundle over an oriented triangulated surface, with or without boundary.
///
/// # Example
/// ```
/// use homeo_manifold::bundle::CircleBundle;
/// // The solid torus over a square, with fibres of four edges.
/// let bundle = CircleBundle::product(&[[0, 1, 2], [0, 2, 3]], 4, 4, &[])?;
/// assert_eq!(bundle.tetrahedra().len(), 2 * 3 * 4);
/// assert_eq!(bundle.fibre(1).collect::<Vec<_>>(), [4, 5, 6, 7]);
/// # Ok::<(), homeo_manifold::bundle::BundleError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CircleBundle {
    triangles: Vec<[u32; 3]>,
    vertex_count: usize,
    layers: u32,
    slopes: Vec<[u32; 3]>,
}

/// Why there is no such bundle.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum BundleError {
    #[error(transparent)]
    Wall(#[from] WallError),
    #[error(transparent)]
    Obstruction(#[from] super::Obstruction),
    #[error("fibres of {layers} edges are too coarse: two vertices would be joined twice; take 3 or more")]
    TooFewLayers { layers: u32 },
    #[error("{vertices} vertices with fibres of {layers} edges are more than 2^32 - 1 vertices; take fewer layers")]
    TooMany { vertices: usize, layers: u32 },
    #[error("triangle {triangle} names vertex {vertex}, but there are {count} vertices")]
    NoVertex { triangle: u32, vertex: u32, count: usize },
    #[error("there are slopes for {given} triangles, but {count} triangles: give one row for each")]
    Slopes { given: usize, count: usize },
    #[error("the slopes of triangle {triangle} add up to {sum} modulo the {layers} layers, not to -1 or -2")]
    Curved { triangle: u32, sum: u32, layers: u32 },
    #[error("the slopes over the edge of triangles {first} and {second} differ: one must be -1 less the other")]
    Torn { first: u32, second: u32 },
    #[error(
        "the surface has a boundary, at triangle {triangle}: a unit tangent bundle as a closed manifold needs a closed surface"
    )]
    Open { triangle: u32 },
    #[error("triangle {triangle} is not connected with triangle 0: take the components one by one")]
    Apart { triangle: u32 },
    #[error("vertex {vertex} belongs to several fans of triangles, or to none: the surface is not manifold there")]
    NotManifold { vertex: u32 },
}

impl CircleBundle {
    /// A bundle with these slopes, one for each side of each triangle; they count modulo the number of layers.
    ///
    /// # Errors
    /// What keeps the slopes from being those of a bundle, or the triangles from being a surface.
    pub fn new(
        triangles: &[[u32; 3]],
        vertex_count: usize,
        layers: u32,
        slopes: Vec<[u32; 3]>,
    ) -> Result<Self, BundleError> {
        check_sizes(triangles, vertex_count, layers)?;
        if slopes.len() != triangles.len() {
            return Err(BundleError::Slopes { given: slopes.len(), count: triangles.len() });
        }
        let slopes: Vec<[u32; 3]> = slopes.into_iter().map(|row| row.map(|slope| slope % layers)).collect();
        let walls = Walls::new(triangles)?;
        for side in walls.sides() {
            if let Some(other) = walls.across(side) {
                let sum = at(&slopes, side) + at(&slopes, other) + 1;
                if !sum.is_multiple_of(layers) {
                    return Err(BundleError::Torn { first: side.triangle, second: other.triangle });
                }
            }
        }
        let bundle = Self { triangles: triangles.to_vec(), vertex_count, layers, slopes };
        for triangle in 0..bundle.triangles.len() as u32 {
            bundle.turns(triangle)?;
        }
        Ok(bundle)
    }

    /// The product of a surface and a circle, where the walls over boundary sides are cut as prescribed.
    ///
    /// Levels of all vertices over one number are a copy of the surface. Source: Yin 2010, section 5.1.
    ///
    /// # Errors
    /// Where there is no cutting pattern, and as [`CircleBundle::new`].
    pub fn product(
        triangles: &[[u32; 3]],
        vertex_count: usize,
        layers: u32,
        prescribed: &[(Side, super::Diagonal)],
    ) -> Result<Self, BundleError> {
        check_sizes(triangles, vertex_count, layers)?;
        let pattern = super::cutting_pattern(&Walls::new(triangles)?, prescribed)?;
        let slope = |diagonal| if diagonal == super::Diagonal::Rising { 0 } else { layers - 1 };
        Self::new(triangles, vertex_count, layers, pattern.into_iter().map(|sides| sides.map(slope)).collect())
    }

    /// The triangles of the surface (`#F by 3`).
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The number of vertices of the surface.
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// The number of edges of each fibre.
    pub fn layers(&self) -> u32 {
        self.layers
    }

    /// The slopes of the sides of each triangle, from 0 to the number of layers less one.
    pub fn slopes(&self) -> &[[u32; 3]] {
        &self.slopes
    }

    /// The vertex of the bundle on a level over a vertex of the surface.
    pub fn vertex(&self, below: u32, level: u32) -> u32 {
        below * self.layers + level % self.layers
    }

    /// The vertices over a vertex of the surface, in order; the last is joined with the first.
    pub fn fibre(&self, below: u32) -> impl Iterator<Item = u32> + use<> {
        let first = below * self.layers;
        first..first + self.layers
    }

    /// The tetrahedra (`3 #F N by 4`), all oriented alike.
    ///
    /// Those over triangle `t` are the `3 N` ones from `3 N t` on.
    pub fn tetrahedra(&self) -> Vec<[u32; 4]> {
        let mut tetrahedra = Vec::with_capacity(3 * self.triangles.len() * self.layers as usize);
        for (triangle, corners) in self.triangles.iter().enumerate() {
            let [first, _, last] = self.slopes[triangle];
            let levels = [0, first + 1, self.layers - last % self.layers];
            // Round the triangle, or the other way round.
            let is_forward = self.sum(triangle) == self.layers - 2;
            let turn = if is_forward { [0, 1, 2] } else { [0, 2, 1] };
            let place = |step: u32| {
                let corner = turn[(step % 3) as usize];
                self.vertex(corners[corner], levels[corner] + step / 3)
            };
            for step in 0..3 * self.layers {
                let mut tetrahedron = [0, 1, 2, 3].map(|next| place(step + next));
                if !is_forward {
                    tetrahedron.swap(0, 1);
                }
                tetrahedra.push(tetrahedron);
            }
        }
        tetrahedra
    }

    /// The Euler number; nothing for a surface with boundary.
    ///
    /// ```
    /// use homeo_manifold::bundle::CircleBundle;
    /// let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    /// let product = CircleBundle::product(&tetrahedron, 4, 3, &[])?;
    /// assert_eq!(product.euler_number(), Some(0));
    /// # Ok::<(), homeo_manifold::bundle::BundleError>(())
    /// ```
    pub fn euler_number(&self) -> Option<i64> {
        let is_closed = Walls::new(&self.triangles).ok()?.open_sides().next().is_none();
        let halves: i64 = (0..self.triangles.len() as u32).filter_map(|triangle| self.turns(triangle).ok()).sum();
        debug_assert!(
            !is_closed || halves % (2 * i64::from(self.layers)) == 0,
            "curvature {halves} / 2 is no multiple"
        );
        is_closed.then(|| halves / (2 * i64::from(self.layers)))
    }

    /// Twice the curvature of a triangle, 1 or -1.
    pub(crate) fn turns(&self, triangle: u32) -> Result<i64, BundleError> {
        match self.layers - self.sum(triangle as usize) {
            1 => Ok(1),
            2 => Ok(-1),
            rest => Err(BundleError::Curved { triangle, sum: self.layers - rest, layers: self.layers }),
        }
    }

    fn sum(&self, triangle: usize) -> u32 {
        self.slopes[triangle].iter().map(|slope| slope % self.layers).sum::<u32>() % self.layers
    }
}

fn at(slopes: &[[u32; 3]], side: Side) -> u32 {
    slopes[side.triangle as usize][usize::from(side.side)]
}

/// That indices are in range and stay so in the bundle.
pub(crate) fn check_sizes(triangles: &[[u32; 3]], vertex_count: usize, layers: u32) -> Result<(), BundleError> {
    if layers < 3 {
        return Err(BundleError::TooFewLayers { layers });
    }
    if (vertex_count as u64).saturating_mul(u64::from(layers)) >= u64::from(u32::MAX) {
        return Err(BundleError::TooMany { vertices: vertex_count, layers });
    }
    for (triangle, corners) in (0..).zip(triangles) {
        if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= vertex_count) {
            return Err(BundleError::NoVertex { triangle, vertex, count: vertex_count });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    #[test]
    fn slopes_of_another_number_are_told() {
        let refused = CircleBundle::new(&SQUARE, 4, 4, vec![[0, 0, 3]]);
        assert_eq!(refused, Err(BundleError::Slopes { given: 1, count: 2 }));
    }

    #[test]
    fn slopes_count_modulo_the_layers() {
        let product = CircleBundle::product(&SQUARE, 4, 4, &[]).unwrap();
        // The largest multiple of 4 that can be added to all.
        let lifted = product.slopes().iter().map(|row| row.map(|slope| slope + (u32::MAX - 3))).collect();
        assert_eq!(CircleBundle::new(&SQUARE, 4, 4, lifted).unwrap(), product);
        let torn = CircleBundle::new(&SQUARE, 4, 4, vec![[0, 0, 3], [1, 0, 2]]).unwrap_err();
        assert_eq!(torn, BundleError::Torn { first: 0, second: 1 });
    }
}
