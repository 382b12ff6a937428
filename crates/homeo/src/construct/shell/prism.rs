//! One prism of a shell against one triangle: the exact checks that the construction of shells (prisms change, the
//! surface stays) and that of sections (the surface changes, prisms stay) have in common.

use std::sync::OnceLock;

use homeo_core::predicate::{
    Sign, crossing_sign, orient3d, quick_crossing_sign, segment_meets_triangle, share_area, triangles_meet,
    triangles_meet_beyond_vertex,
};
use homeo_core::spatial::Aabb;

use super::directions::{dot, minus};

type Point = [f64; 3];

/// Bottom, middle and top of a column.
pub(in crate::construct) type Column = [Point; 3];

/// Lower and upper slab, as the levels of their low and high points.
pub(in crate::construct) const SLABS: [[usize; 2]; 2] = [[0, 1], [1, 2]];

/// A hypothesis that fails, and in which slab: 0 for the lower one, 1 for the upper one.
pub(in crate::construct) type FailureIn = (Failure, usize);

/// Which of the theorem's hypotheses fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::construct) enum Failure {
    /// L2: a tetrahedron is not positive.
    Volume,
    /// L3: the surface meets top or bottom.
    Cap,
    /// L4: a pillar crosses a triangle the wrong way.
    Crossing,
    /// The shell overlaps itself, and is not to.
    Skin,
    /// Two sheets of the surface lie in one prism.
    Sheet,
    /// L3: a wall over the boundary meets the surface off its edge.
    Wall,
    /// A pillar is farther from a triangle's normal than is wanted, which the theorem does not care about.
    Angle,
}

/// A prism with its points.
pub(in crate::construct) struct Prism {
    columns: [Column; 3],
    pinched: [bool; 3],
    /// What [`outer_walls`](Self::outer_walls) gives for each slab, once it was asked for.
    outer_walls: OnceLock<[Vec<[Point; 3]>; 2]>,
}

/// Whether a column has no length.
pub(in crate::construct) fn is_pinched([bottom, middle, top]: Column) -> bool {
    bottom == middle && middle == top
}

impl Prism {
    pub fn new(columns: [Column; 3]) -> Self {
        Self { columns, pinched: columns.map(is_pinched), outer_walls: OnceLock::new() }
    }

    /// The box that holds the prism.
    pub fn hull(&self) -> Aabb {
        Aabb::of(self.columns.as_flattened())
    }

    /// L2.
    pub fn check_volumes(&self) -> Result<(), FailureIn> {
        let is_positive = |[a, b, c, d]: [Point; 4]| orient3d(a, b, c, d) == Sign::Positive;
        let pinched = self.pinched.iter().filter(|pinched| **pinched).count();
        let holds = |slab: [usize; 2]| pinched <= 1 && self.tetrahedra(slab).all(is_positive);
        SLABS.iter().position(|&slab| !holds(slab)).map_or(Ok(()), |slab| Err((Failure::Volume, slab)))
    }

    /// The triangle at the far side of a slab: the bottom of the lower one, the top of the upper one.
    pub fn cap(&self, slab: usize) -> [Point; 3] {
        self.columns.map(|column| column[2 * slab])
    }

    /// L3 for a pair: whether a triangle stays off the cap of a slab, but for a pinched point that is a corner of both.
    pub fn is_off_cap(&self, slab: usize, triangle: [Point; 3]) -> bool {
        let cap = self.cap(slab);
        let pinched = self.pinched.iter().position(|pinched| *pinched);
        let apex = pinched.map(|k| cap[k]);
        match (pinched, triangle.iter().position(|p| Some(*p) == apex)) {
            (Some(k), Some(l)) => !triangles_meet_beyond_vertex(
                cap[k],
                [cap[(k + 1) % 3], cap[(k + 2) % 3]],
                [triangle[(l + 1) % 3], triangle[(l + 2) % 3]],
            ),
            _ => !triangles_meet(cap, triangle),
        }
    }

    /// Whether a triangle meets the walls over the side from column `k` to the next.
    pub fn meets_wall(&self, k: usize, triangle: [Point; 3]) -> bool {
        let region = Aabb::of(&triangle);
        let mut walls = self.walls_over(k).into_iter();
        walls.any(|(_, wall)| Aabb::of(&wall).meets(&region) && triangles_meet(wall, triangle))
    }

    /// The wall triangles of L3 over the side from column `k` to the next, counter-clockwise from outside, with their
    /// slabs; those with two equal points are left out.
    pub fn walls_over(&self, k: usize) -> Vec<(usize, [Point; 3])> {
        let walls =
            SLABS.into_iter().enumerate().flat_map(|(number, slab)| self.wall(slab, k).map(|wall| (number, wall)));
        walls.filter(|(_, wall)| wall[0] != wall[1] && wall[1] != wall[2] && wall[2] != wall[0]).collect()
    }

    /// The triangles with three corners of the side of a slab from column `k` to the next, counter-clockwise from outside.
    fn wall(&self, [low, high]: [usize; 2], k: usize) -> [[Point; 3]; 4] {
        let (a, b) = (self.columns[k], self.columns[(k + 1) % 3]);
        [[a[low], b[low], b[high]], [a[low], b[low], a[high]], [a[low], b[high], a[high]], [b[low], b[high], a[high]]]
    }

    /// All tetrahedra of a slab in any order of the columns: a pillar and a point of each other column.
    fn tetrahedra(&self, [low, high]: [usize; 2]) -> impl Iterator<Item = [Point; 4]> + '_ {
        (0..3).filter(|&i| !self.pinched[i]).flat_map(move |i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let [pillar, second, third] = [i, j, k].map(|column| self.columns[column]);
            // A pinched column has one point.
            let levels = move |column: usize| [low, high].into_iter().take(2 - usize::from(self.pinched[column]));
            levels(j).flat_map(move |x| levels(k).map(move |y| [pillar[low], pillar[high], second[x], third[y]]))
        })
    }

    /// Whether a triangle and one of the tetrahedra of a slab have an area in common.
    pub fn shares_area(&self, slab: usize, triangle: [Point; 3]) -> bool {
        self.tetrahedra(SLABS[slab]).any(|cell| share_area(cell, triangle))
    }

    /// Whether a closed segment meets one of the tetrahedra.
    pub fn meets_segment(&self, segment: [Point; 2]) -> bool {
        let region = Aabb::of(&segment);
        let is_met = |cell: [Point; 4]| {
            Aabb::of(&cell).meets(&region)
                && (contains(cell, segment[0])
                    || faces(cell).into_iter().any(|face| segment_meets_triangle(segment, face)))
        };
        self.hull().meets(&region) && SLABS.into_iter().any(|slab| self.tetrahedra(slab).any(is_met))
    }

    /// Whether a closed triangle meets one of the tetrahedra: then an edge of one meets the other.
    pub fn meets(&self, triangle: [Point; 3]) -> bool {
        let [a, b, c] = triangle;
        let has_edge_in = |[p, q, r, s]: [Point; 4]| {
            let edges = [[p, q], [p, r], [p, s], [q, r], [q, s], [r, s]];
            edges.into_iter().any(|edge| segment_meets_triangle(edge, triangle))
        };
        [[a, b], [b, c], [c, a]].into_iter().any(|edge| self.meets_segment(edge))
            || SLABS.into_iter().any(|slab| self.tetrahedra(slab).any(has_edge_in))
    }

    /// Whether the hull of some points is off the prism, for each slab beyond one of its outer walls; `false` says nothing.
    pub fn is_clearly_off(&self, points: &[Point]) -> bool {
        let is_beyond = |wall: &[Point; 3]| points.iter().all(|&p| side(*wall, p) == Sign::Positive);
        !self.hull().meets(&Aabb::of(points)) || self.outer_walls().iter().all(|walls| walls.iter().any(is_beyond))
    }

    /// Whether all pillars of a slab cross a triangle in the positive sense: with this, L4 holds for the pair.
    pub fn is_crossed(&self, slab: usize, triangle: [Point; 3]) -> bool {
        let [low, high] = SLABS[slab];
        let crosses = |column: &Column| crossing_sign(triangle, [column[low], column[high]]) == Sign::Positive;
        (0..3).filter(|&i| !self.pinched[i]).all(|i| crosses(&self.columns[i]))
    }

    /// Whether floating point can tell that all pillars of a slab cross a triangle in the positive sense.
    pub fn is_clearly_crossed(&self, slab: usize, triangle: [Point; 3]) -> bool {
        let [low, high] = SLABS[slab];
        let crosses =
            |column: &Column| quick_crossing_sign(triangle, [column[low], column[high]]) == Some(Sign::Positive);
        (0..3).filter(|&i| !self.pinched[i]).all(|i| crosses(&self.columns[i]))
    }

    /// The least cosine of the angle between a pillar of a slab and a unit normal; rounded.
    pub fn smallest_cosine(&self, slab: usize, normal: Point) -> f64 {
        let [low, high] = SLABS[slab];
        let cosine = |column: &Column| {
            let pillar = minus(column[high], column[low]);
            dot(pillar, normal) / dot(pillar, pillar).sqrt()
        };
        (0..3).filter(|&i| !self.pinched[i]).map(|i| cosine(&self.columns[i])).fold(1.0, f64::min)
    }

    /// Whether a slab lies on one closed side of a triangle's plane, with at most two of its points in it: they have
    /// then no area in common.
    pub fn is_beside(&self, slab: usize, triangle: [Point; 3]) -> bool {
        let mut seen = [0; 3];
        // The far points first: they mostly lie on either side where any do.
        for level in [2 * slab, 1] {
            for column in &self.columns {
                seen[side(triangle, column[level]) as usize] += 1;
                if seen[Sign::Zero as usize] > 2 || (seen[0] > 0 && seen[2] > 0) {
                    return false;
                }
            }
        }
        true
    }

    /// For each slab the planes through its sides, top and bottom that have all of it on their negative side.
    pub fn outer_walls(&self) -> &[Vec<[Point; 3]>; 2] {
        self.outer_walls.get_or_init(|| [0, 1].map(|slab| self.find_outer_walls(slab)))
    }

    fn find_outer_walls(&self, slab: usize) -> Vec<[Point; 3]> {
        let slab = SLABS[slab];
        let points: Vec<Point> = self.columns.iter().flat_map(|column| slab.map(|level| column[level])).collect();
        let is_outer = |wall: &[Point; 3]| {
            points.iter().all(|&p| side(*wall, p) != Sign::Positive)
                && points.iter().any(|&p| side(*wall, p) == Sign::Negative)
        };
        let [[a, b, c], high] = slab.map(|level| self.columns.map(|column| column[level]));
        (0..3).flat_map(|k| self.wall(slab, k)).chain([[c, b, a], high]).filter(is_outer).collect()
    }
}

/// L3 for a wall triangle over a boundary edge, counter-clockwise from outside, and a triangle: they meet in common
/// corners and the common edge only, and the triangle lies inside at that edge.
pub(in crate::construct) fn is_inside_wall(wall: [Point; 3], triangle: [Point; 3]) -> bool {
    let common: Vec<[usize; 2]> =
        (0..3).flat_map(|k| (0..3).map(move |l| [k, l])).filter(|&[k, l]| wall[k] == triangle[l]).collect();
    match common[..] {
        [] => !triangles_meet(wall, triangle),
        [[k, l]] => !triangles_meet_beyond_vertex(
            wall[k],
            [wall[(k + 1) % 3], wall[(k + 2) % 3]],
            [triangle[(l + 1) % 3], triangle[(l + 2) % 3]],
        ),
        [[_, l], [_, m]] => side(wall, triangle[3 - l - m]) == Sign::Negative,
        _ => false,
    }
}

/// Whether a point lies in a closed tetrahedron, which is positive.
fn contains([a, b, c, d]: [Point; 4], p: Point) -> bool {
    let parts = [[p, b, c, d], [a, p, c, d], [a, b, p, d], [a, b, c, p]];
    parts.iter().all(|&[a, b, c, d]| orient3d(a, b, c, d) != Sign::Negative)
}

fn faces([a, b, c, d]: [Point; 4]) -> [[Point; 3]; 4] {
    [[b, c, d], [a, c, d], [a, b, d], [a, b, c]]
}

/// Whether a triangle lies on the closed positive side of a plane, and not all in it.
pub(in crate::construct) fn is_outside(plane: [Point; 3], triangle: [Point; 3]) -> bool {
    let mut is_off = false;
    for p in triangle {
        match side(plane, p) {
            Sign::Negative => return false,
            Sign::Zero => {}
            Sign::Positive => is_off = true,
        }
    }
    is_off
}

/// On which side of a plane a point lies. That its own three points lie in it is seen at once: the predicate is slowest
/// for zero.
fn side(plane: [Point; 3], point: Point) -> Sign {
    if plane.contains(&point) { Sign::Zero } else { orient3d(plane[0], plane[1], plane[2], point) }
}

/// The sides of a triangle, as pairs of corners in its direction.
pub(in crate::construct) fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}
