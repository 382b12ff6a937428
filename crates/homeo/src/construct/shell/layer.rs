//! A shell under construction: columns, prisms, and which source triangles each prism may contain.

use std::collections::HashSet;

use homeo_core::predicate::{Sign, crossing_sign, orient3d, share_area, triangles_meet, triangles_meet_beyond_vertex};
use homeo_core::spatial::{Aabb, Tree};
use rayon::prelude::*;

use super::directions::{dot, minus, triangles_around};
use crate::input::SourceMesh;
use crate::map::ShellParts;

type Point = [f64; 3];

/// Bottom, middle and top of a column.
pub(super) type Column = [Point; 3];

/// With fewer pairs of triangles and prisms than this, one thread is faster than several.
const WORTH_SHARING: usize = 400;

/// Lower and upper slab, as the levels of their low and high points.
const SLABS: [[usize; 2]; 2] = [[0, 1], [1, 2]];

/// The source surface, as the checks need it.
pub(super) struct Surface {
    corners: Vec<[Point; 3]>,
    tree: Tree,
}

impl Surface {
    pub fn new(source: &SourceMesh<3>) -> Self {
        let corner = |v: &homeo_core::mesh::VertexId| source.positions()[v.index()];
        let corners: Vec<[Point; 3]> =
            source.complex().cells().iter().map(|cell| std::array::from_fn(|k| corner(&cell[k]))).collect();
        let boxes: Vec<Aabb> = corners.iter().map(|triangle| Aabb::of(triangle)).collect();
        Self { tree: Tree::new(&boxes), corners }
    }

    /// L3: whether the surface stays off a triangle of top or bottom, but for pinched points.
    fn is_clear_of(&self, cap: [Point; 3], pinched: Option<usize>) -> bool {
        let apart = |triangle: [Point; 3]| {
            let apex = pinched.map(|k| cap[k]);
            match (pinched, triangle.iter().position(|p| Some(*p) == apex)) {
                (Some(k), Some(l)) => !triangles_meet_beyond_vertex(
                    cap[k],
                    [cap[(k + 1) % 3], cap[(k + 2) % 3]],
                    [triangle[(l + 1) % 3], triangle[(l + 2) % 3]],
                ),
                _ => !triangles_meet(cap, triangle),
            }
        };
        let mut is_clear = true;
        self.tree.query_box(&Aabb::of(&cap), |t| is_clear = is_clear && apart(self.corners[t]));
        is_clear
    }

    /// L3 for a wall triangle over a boundary edge, counter-clockwise from outside: the surface meets it in common corners
    /// and the common edge only, and lies inside at that edge.
    fn is_inside_of(&self, wall: [Point; 3]) -> bool {
        let fits = |triangle: [Point; 3]| {
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
        };
        let mut is_inside = true;
        self.tree.query_box(&Aabb::of(&wall), |t| is_inside = is_inside && fits(self.corners[t]));
        is_inside
    }
}

/// See the module's documentation.
pub(super) struct Layer {
    pub surface: Surface,
    pub columns: Vec<Column>,
    pub prisms: Vec<[u32; 3]>,
    /// Whether each prism still exists.
    pub exists: Vec<bool>,
    /// Edges of prisms on the boundary of the surface, in the prisms' direction.
    boundary: HashSet<[u32; 2]>,
    /// Columns on the boundary, which stay as they are.
    pub is_frozen: Vec<bool>,
    /// The prisms at each column.
    pub around: Vec<Vec<u32>>,
    /// For each prism all source triangles with which it has an area in common, and perhaps others near it, ascending.
    contents: Vec<Vec<u32>>,
}

/// A hypothesis that fails, and in which slab: 0 for the lower one, 1 for the upper one.
pub(super) type FailureIn = (Failure, usize);

/// Which of the theorem's hypotheses fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Failure {
    /// L2: a tetrahedron is not positive.
    Volume,
    /// L3: the surface meets top or bottom.
    Cap,
    /// L4: a pillar crosses a triangle the wrong way.
    Crossing,
    /// L3: a wall over the boundary meets the surface off its edge.
    Wall,
}

impl Layer {
    /// The layer of the given columns over the triangles of the source, nothing checked yet.
    pub fn new(source: &SourceMesh<3>, columns: Vec<Column>) -> Self {
        let prisms: Vec<[u32; 3]> = source.complex().cells().iter().map(|cell| cell.map(|v| v.raw())).collect();
        let mut boundary: HashSet<[u32; 2]> = prisms.iter().flat_map(|&p| sides(p)).collect();
        let all: Vec<[u32; 2]> = boundary.iter().copied().collect();
        for [a, b] in all {
            if boundary.contains(&[b, a]) {
                boundary.remove(&[a, b]);
                boundary.remove(&[b, a]);
            }
        }
        let mut is_frozen = vec![false; columns.len()];
        boundary.iter().flatten().for_each(|&v| is_frozen[v as usize] = true);
        Self {
            surface: Surface::new(source),
            boundary,
            is_frozen,
            columns,
            exists: vec![true; prisms.len()],
            around: triangles_around(source.complex()),
            contents: vec![Vec::new(); prisms.len()],
            prisms,
        }
    }

    pub fn is_pinched(&self, column: u32) -> bool {
        let [bottom, middle, top] = self.columns[column as usize];
        bottom == middle && middle == top
    }

    fn prism(&self, corners: [u32; 3]) -> Prism {
        let columns = corners.map(|v| self.columns[v as usize]);
        Prism { columns, pinched: corners.map(|v| self.is_pinched(v)) }
    }

    /// Finds the contents of a prism among all source triangles and checks everything (L2 to L4).
    pub fn fill(&mut self, prism: u32) -> Result<(), FailureIn> {
        let corners = self.prisms[prism as usize];
        let body = self.prism(corners);
        body.check(&self.surface)?;
        for (k, side) in sides(corners).into_iter().enumerate() {
            if self.boundary.contains(&side) {
                body.check_wall(&self.surface, k)?;
            }
        }
        let mut near = Vec::new();
        self.surface.tree.query_box(&Aabb::of(body.columns.as_flattened()), |t| near.push(t as u32));
        near.sort_unstable();
        self.contents[prism as usize] = body.contents(&self.surface, &near)?;
        Ok(())
    }

    /// Replaces prisms by others over the same part of the surface if the new ones satisfy L2 to L4; `columns` may have
    /// been changed before. Their common side walls must be as before, so what the old ones held the new ones hold.
    /// Returns the new prisms' numbers: as many of the old ones as are needed.
    pub fn replace(&mut self, old: &[u32], new: &[[u32; 3]]) -> Result<(), FailureIn> {
        debug_assert!(new.len() <= old.len());
        let bodies: Vec<Prism> = new.iter().map(|&corners| self.prism(corners)).collect();
        bodies.iter().try_for_each(Prism::check_volumes)?;
        let mut held: Vec<u32> = old.iter().flat_map(|&p| self.contents[p as usize].iter().copied()).collect();
        held.sort_unstable();
        held.dedup();
        let find = |body: &Prism| body.contents(&self.surface, &held);
        let contents: Vec<Vec<u32>> = if held.len() * bodies.len() < WORTH_SHARING {
            bodies.iter().map(find).collect::<Result<_, _>>()?
        } else {
            bodies.par_iter().map(find).collect::<Result<_, _>>()?
        };
        bodies.iter().try_for_each(|body| body.check_caps(&self.surface))?;
        for &prism in old {
            for column in self.prisms[prism as usize] {
                self.around[column as usize].retain(|&other| other != prism);
            }
            self.exists[prism as usize] = false;
            self.contents[prism as usize] = Vec::new();
        }
        for ((&prism, &corners), contents) in old.iter().zip(new).zip(contents) {
            self.exists[prism as usize] = true;
            self.prisms[prism as usize] = corners;
            self.contents[prism as usize] = contents;
            corners.iter().for_each(|&column| self.around[column as usize].push(prism));
        }
        Ok(())
    }

    /// Accepts a column that was changed, if its prisms satisfy L2 to L4.
    pub fn recheck(&mut self, column: u32) -> Result<(), FailureIn> {
        let prisms = self.around[column as usize].clone();
        let corners: Vec<[u32; 3]> = prisms.iter().map(|&p| self.prisms[p as usize]).collect();
        self.replace(&prisms, &corners)
    }

    /// A column like `wanted` with its middle where it meets the surface, with the lengths of the present column;
    /// `None` if it does not meet what the prisms round it hold.
    pub fn with_middle_on_surface(&self, column: u32, wanted: Column) -> Option<Column> {
        let [from, _, to] = wanted;
        let held = self.around[column as usize].iter().flat_map(|&p| &self.contents[p as usize]);
        let share = held.filter_map(|&t| hit(from, to, self.surface.corners[t as usize])).next()?;
        let at = |share: f64| [0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        let [bottom, middle, top] = self.columns[column as usize];
        let length = |a: Point, b: Point| minus(a, b).iter().map(|x| x * x).sum::<f64>().sqrt();
        let (down, up, whole) = (length(bottom, middle), length(top, middle), length(from, to));
        Some([at(share - down / whole), at(share), at(share + up / whole)])
    }

    /// Columns that share a prism with the given one, ascending.
    pub fn neighbours(&self, column: u32) -> Vec<u32> {
        let corners = self.around[column as usize].iter().flat_map(|&p| self.prisms[p as usize]);
        let mut found: Vec<u32> = corners.filter(|&other| other != column).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// How many prisms there are.
    pub fn count(&self) -> usize {
        self.exists.iter().filter(|exists| **exists).count()
    }

    /// The finished shell, with columns numbered anew.
    pub fn into_parts(self) -> ShellParts {
        let mut number = vec![u32::MAX; self.columns.len()];
        let mut parts = ShellParts::default();
        for (corners, _) in self.prisms.iter().zip(&self.exists).filter(|(_, exists)| **exists) {
            for &column in corners {
                if number[column as usize] == u32::MAX {
                    number[column as usize] = parts.middle.len() as u32;
                    let [bottom, middle, top] = self.columns[column as usize];
                    parts.bottom.push(bottom);
                    parts.middle.push(middle);
                    parts.top.push(top);
                }
            }
            parts.prisms.push(corners.map(|column| number[column as usize]));
        }
        parts
    }
}

/// A prism with its points.
struct Prism {
    columns: [Column; 3],
    pinched: [bool; 3],
}

impl Prism {
    fn check(&self, surface: &Surface) -> Result<(), FailureIn> {
        self.check_volumes()?;
        self.check_caps(surface)
    }

    /// L2.
    fn check_volumes(&self) -> Result<(), FailureIn> {
        let is_positive = |[a, b, c, d]: [Point; 4]| orient3d(a, b, c, d) == Sign::Positive;
        let pinched = self.pinched.iter().filter(|pinched| **pinched).count();
        let holds = |slab: [usize; 2]| pinched <= 1 && self.tetrahedra(slab).all(is_positive);
        SLABS.iter().position(|&slab| !holds(slab)).map_or(Ok(()), |slab| Err((Failure::Volume, slab)))
    }

    /// L3.
    fn check_caps(&self, surface: &Surface) -> Result<(), FailureIn> {
        let pinched = self.pinched.iter().position(|pinched| *pinched);
        let holds = |level: usize| surface.is_clear_of(self.columns.map(|c| c[level]), pinched);
        (0..2).find(|slab| !holds(2 * slab)).map_or(Ok(()), |slab| Err((Failure::Cap, slab)))
    }

    /// L3 for the wall over the side from column `k` to the next, in the boundary.
    fn check_wall(&self, surface: &Surface, k: usize) -> Result<(), FailureIn> {
        for (number, slab) in SLABS.into_iter().enumerate() {
            for wall in self.wall(slab, k) {
                let has_repeated = wall[0] == wall[1] || wall[1] == wall[2] || wall[2] == wall[0];
                if !has_repeated && !surface.is_inside_of(wall) {
                    return Err((Failure::Wall, number));
                }
            }
        }
        Ok(())
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

    /// The source triangles among `near` that may have an area in common with the prism; L4 for those that have.
    fn contents(&self, surface: &Surface, near: &[u32]) -> Result<Vec<u32>, FailureIn> {
        let hull = Aabb::of(self.columns.as_flattened());
        let walls: [Vec<[Point; 3]>; 2] = [self.outer_walls(SLABS[0]), self.outer_walls(SLABS[1])];
        let mut contents = Vec::new();
        for &t in near {
            let triangle = surface.corners[t as usize];
            if !hull.meets(&Aabb::of(&triangle)) {
                continue;
            }
            let mut is_inside = false;
            for (number, (slab, walls)) in SLABS.into_iter().zip(&walls).enumerate() {
                if walls.iter().any(|wall| is_outside(*wall, triangle)) {
                    continue;
                }
                is_inside = true;
                if !self.is_crossed(slab, triangle) && self.tetrahedra(slab).any(|cell| share_area(cell, triangle)) {
                    return Err((Failure::Crossing, number));
                }
            }
            if is_inside {
                contents.push(t);
            }
        }
        Ok(contents)
    }

    /// Whether all pillars of a slab cross a triangle in the positive sense.
    fn is_crossed(&self, [low, high]: [usize; 2], triangle: [Point; 3]) -> bool {
        let crosses = |column: &Column| crossing_sign(triangle, [column[low], column[high]]) == Sign::Positive;
        (0..3).filter(|&i| !self.pinched[i]).all(|i| crosses(&self.columns[i]))
    }

    /// Planes through sides of a slab with all of it on their negative side.
    fn outer_walls(&self, slab: [usize; 2]) -> Vec<[Point; 3]> {
        let points: Vec<Point> = self.columns.iter().flat_map(|column| slab.map(|level| column[level])).collect();
        let is_outer = |wall: &[Point; 3]| {
            points.iter().all(|&p| side(*wall, p) != Sign::Positive)
                && points.iter().any(|&p| side(*wall, p) == Sign::Negative)
        };
        (0..3).flat_map(|k| self.wall(slab, k)).filter(is_outer).collect()
    }
}

/// The sides of a triangle, as pairs of corners in its direction.
fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// On which side of a plane a point lies. That its own three points lie in it is seen at once: the predicate is slowest
/// for zero.
fn side(plane: [Point; 3], point: Point) -> Sign {
    if plane.contains(&point) { Sign::Zero } else { orient3d(plane[0], plane[1], plane[2], point) }
}

/// Whether a triangle lies on the closed positive side of a plane, and not all in it.
fn is_outside(plane: [Point; 3], triangle: [Point; 3]) -> bool {
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

/// Where a segment meets a triangle, as a share of it; rounded, and no decision rests on it.
fn hit(from: Point, to: Point, [a, b, c]: [Point; 3]) -> Option<f64> {
    let (u, v, step, base) = (minus(b, a), minus(c, a), minus(to, from), minus(from, a));
    let cross = |p: Point, q: Point| [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let normal = cross(u, v);
    let speed = dot(normal, step);
    let share = -dot(normal, base) / speed;
    let place = [0, 1, 2].map(|axis| base[axis] + share * step[axis]);
    let size = dot(normal, normal);
    let (x, y) = (dot(cross(place, v), normal) / size, dot(cross(u, place), normal) / size);
    (x >= -1e-9 && y >= -1e-9 && x + y <= 1.0 + 1e-9 && (0.0..=1.0).contains(&share)).then_some(share)
}

/// Twice the area of a triangle, and the sum of its squared sides.
pub(super) fn area_and_sides([a, b, c]: [Point; 3]) -> (f64, f64) {
    let (u, v, w) = (minus(b, a), minus(c, a), minus(c, b));
    let square = |x: Point| x.iter().map(|c| c * c).sum::<f64>();
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    (square(cross).sqrt(), square(u) + square(v) + square(w))
}
