//! One half of a composite harmonic map: a triangulated domain, flattened onto the middle.

use std::collections::HashMap;
use std::ops::Range;

use homeo_core::number::{Interval, Rational, Scalar};
use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::predicate::Sign;
use homeo_core::spatial::{Aabb, Tree};

use super::layout::Layout;
use super::middle::{Middle, SHARE_BITS, bounds};

/// A vertex of a triangulation that lies on an edge of the domain, or on one side of a seam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundaryPoint {
    /// Ring of the edge; 0 on a circuit.
    pub ring: u32,
    /// Number of the edge in its ring, which is that of its first vertex, or of the side of the circuit.
    pub edge: u32,
    /// How far along the edge, in units of `2^-30`: 0 is the edge's first vertex. Below `2^30`.
    pub share: u32,
}

impl BoundaryPoint {
    /// How far along the edge, as a number from 0 to below 1.
    pub(crate) fn fraction(&self) -> f64 {
        f64::from(self.share) / f64::from(1 << SHARE_BITS)
    }
}

/// The numbers that define a half.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfParts {
    /// What is triangulated.
    pub domain: PlanarDomain,
    /// Vertices on the boundary, in its order, ring after ring; every vertex of the domain is one. They come first. Those
    /// on seams are there once for each side.
    pub boundary: Vec<BoundaryPoint>,
    /// Where the points inside seams lie, seam after seam, from its first end to its second; the others are where their
    /// shares say.
    pub seam_points: Vec<Point2>,
    /// The other vertices.
    pub inner: Vec<Point2>,
    /// Their images in the middle.
    pub images: Vec<Point2>,
    /// Corners, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// On a cylinder: how many turns the corners of a triangle's image are ahead of the images of the vertices.
    pub shifts: Vec<[i8; 3]>,
}

/// A triangulated domain with its flattening, ready to be evaluated.
#[derive(Clone, Debug)]
pub struct Half {
    layout: Layout,
    /// Over the triangles in the domain, and over their images.
    trees: [Tree; 2],
    /// Corners of the triangles on both sides, rounded.
    rounded: [Vec<[Point2; 3]>; 2],
    /// Across the edge opposite each corner; `u32::MAX` on the boundary.
    neighbours: Vec<[u32; 3]>,
    is_cylinder: bool,
}

/// Images are never spread over more turns: shifts are small.
const MOST_TURNS: f64 = 600.0;

/// Where a triangulation is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Domain,
    Image,
}

impl Half {
    /// Prepares a half for evaluation.
    pub fn new(parts: HalfParts, middle: &Middle) -> Self {
        let layout = Layout::new(parts, middle);
        let count = layout.parts.triangles.len();
        let tree = |side: Side| {
            let boxes: Vec<Aabb> = (0..count)
                .map(|t| {
                    let [low, high] = bounds(&layout.corners::<Interval>(middle, side, t));
                    Aabb { low: [low[0], low[1], 0.0], high: [high[0], high[1], 0.0] }
                })
                .collect();
            Tree::new(&boxes)
        };
        let trees = [tree(Side::Domain), tree(Side::Image)];
        let rounded = [Side::Domain, Side::Image].map(|side| {
            let corners = |t| layout.corners::<Interval>(middle, side, t).map(|p| p.map(|x| x.near()));
            (0..count).map(corners).collect()
        });
        let neighbours = neighbours(&layout.parts.triangles);
        Self { layout, trees, rounded, neighbours, is_cylinder: middle.is_cylinder() }
    }

    pub(super) fn is_cylinder(&self) -> bool {
        self.is_cylinder
    }

    pub(super) fn tree(&self, side: Side) -> &Tree {
        &self.trees[usize::from(side == Side::Image)]
    }

    /// Corners of a triangle, rounded.
    pub(super) fn rounded(&self, side: Side, triangle: usize) -> [Point2; 3] {
        self.rounded[usize::from(side == Side::Image)][triangle]
    }

    /// The triangle across the edge opposite a corner.
    pub(super) fn neighbour(&self, triangle: usize, corner: usize) -> Option<usize> {
        let there = self.neighbours[triangle][corner];
        (there != u32::MAX).then_some(there as usize)
    }

    /// The least and the greatest first coordinate of the images.
    pub(super) fn reach(&self) -> [f64; 2] {
        let hull = self.trees[1].hull();
        [hull.low[0], hull.high[0]]
    }

    /// The numbers that define it.
    pub fn parts(&self) -> &HalfParts {
        &self.layout.parts
    }

    /// How many vertices the triangulation has.
    pub fn vertex_count(&self) -> usize {
        self.parts().boundary.len() + self.parts().inner.len()
    }

    /// Where a vertex lies in the domain, rounded.
    pub fn position(&self, vertex: u32) -> Point2 {
        self.layout.position::<Interval>(vertex).map(|x| x.near())
    }

    /// Where the corners of a triangle go in the middle, rounded.
    pub fn image(&self, triangle: usize) -> [Point2; 3] {
        self.rounded(Side::Image, triangle)
    }

    /// Whether all triangles and all their images are counter-clockwise, exactly; the first that is not.
    pub fn first_flipped(&self, middle: &Middle) -> Option<usize> {
        (0..self.parts().triangles.len()).find(|&t| {
            [Side::Domain, Side::Image].into_iter().any(|side| {
                let quick = self.layout.corners::<Interval>(middle, side, t);
                let sign = cross(&quick[0], &quick[1], &quick[2]).sign().unwrap_or_else(|| {
                    let [a, b, c] = self.layout.corners::<Rational>(middle, side, t);
                    cross(&a, &b, &c).sign()
                });
                sign != Sign::Positive
            })
        })
    }

    /// Its numbers, if all triangles and images are counter-clockwise; the first triangle that is not.
    pub(crate) fn into_parts_if_positive(self, middle: &Middle) -> Result<HalfParts, usize> {
        match self.first_flipped(middle) {
            None => Ok(self.layout.parts),
            Some(triangle) => Err(triangle),
        }
    }

    /// By how many turns a point of a cylinder may have to go on to meet the images of the triangles.
    pub(super) fn turns_to_try<T: Scalar>(&self, middle: &Middle, turn: &T) -> Range<i32> {
        if !middle.is_cylinder() {
            return 0..1;
        }
        let (at, [low, high]) = (turn.enclosure(), self.reach());
        let [first, last] = [(low - at.high()).ceil(), (high - at.low()).floor()];
        // Nothing is tried where nothing is known, or images are spread over so many turns as in damaged files only.
        if last - first < MOST_TURNS { first as i32..last as i32 + 1 } else { 0..0 }
    }

    /// Takes a point from one side to the other by the triangle that holds it. `None` where rounding leaves open in which
    /// triangle it lies; an empty answer where it lies in none.
    pub(super) fn carry<T: Scalar>(&self, middle: &Middle, from: Side, point: &[T; 2]) -> Option<Option<[T; 2]>> {
        let [x, y] = point.each_ref().map(Scalar::enclosure);
        let region = Aabb { low: [x.low(), y.low(), 0.0], high: [x.high(), y.high(), 0.0] };
        let mut answer = Some(None);
        self.tree(from).query_box(&region, |triangle| {
            if matches!(answer, Some(None)) {
                answer = self.carry_by(middle, from, triangle, point);
            }
        });
        answer
    }

    fn carry_by<T: Scalar>(
        &self,
        middle: &Middle,
        from: Side,
        triangle: usize,
        point: &[T; 2],
    ) -> Option<Option<[T; 2]>> {
        let to = if from == Side::Domain { Side::Image } else { Side::Domain };
        let [a, b, c] = self.layout.corners::<T>(middle, from, triangle);
        let weights = [cross(point, &b, &c), cross(&a, point, &c), cross(&a, &b, point)];
        let signs = weights.each_ref().map(Scalar::sign);
        if signs.contains(&Some(Sign::Negative)) {
            return Some(None);
        }
        if signs.contains(&None) {
            return None;
        }
        let total = weights[0].plus(&weights[1]).plus(&weights[2]);
        if total.sign() != Some(Sign::Positive) {
            // Flat, in a damaged file.
            return Some(None);
        }
        let there = self.layout.corners::<T>(middle, to, triangle);
        let coordinate = |axis: usize| {
            let sum = (0..3).map(|i| weights[i].times(&there[i][axis])).reduce(|x, y| x.plus(&y));
            sum.unwrap_or_else(|| T::from_f64(0.0)).divide(&total)
        };
        Some(Some([coordinate(0), coordinate(1)]))
    }
}

/// Across the edge opposite each corner.
pub(crate) fn neighbours(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut edges = HashMap::with_capacity(3 * triangles.len());
    for (t, corners) in triangles.iter().enumerate() {
        (0..3).for_each(|k| {
            edges.insert([corners[(k + 1) % 3], corners[(k + 2) % 3]], t as u32);
        });
    }
    let across = |corners: &[u32; 3], k: usize| edges.get(&[corners[(k + 2) % 3], corners[(k + 1) % 3]]);
    triangles.iter().map(|corners| [0, 1, 2].map(|k| across(corners, k).copied().unwrap_or(u32::MAX))).collect()
}

/// Twice the area of a triangle.
fn cross<T: Scalar>(a: &[T; 2], b: &[T; 2], c: &[T; 2]) -> T {
    let step = |p: &[T; 2], axis: usize| p[axis].minus(&a[axis]);
    step(b, 0).times(&step(c, 1)).minus(&step(b, 1).times(&step(c, 0)))
}
