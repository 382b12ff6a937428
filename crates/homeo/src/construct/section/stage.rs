//! The fixed prisms of a shell, and whether a triangle may be part of a section.

use homeo_core::predicate::is_degenerate_triangle;
use homeo_core::spatial::{Aabb, Tree};

use super::Fault;
use super::shape::normal;
use crate::construct::shell::prism::{Prism, is_inside_wall, is_outside, is_pinched, sides};
use crate::map::ShellParts;

type Point = [f64; 3];

/// A prism with what the checks of many triangles have in common.
struct Body {
    prism: Prism,
    caps: [Aabb; 2],
    slabs: [Aabb; 2],
}

/// The prisms of a shell, which stay as they are while the surface in them changes.
pub(super) struct Stage {
    bodies: Vec<Body>,
    tree: Tree,
    walls: Vec<[Point; 3]>,
    wall_tree: Tree,
    /// Points of pinched columns, as [`key`]s, ascending.
    pinched: Vec<[u64; 3]>,
}

/// A point as numbers that are equal exactly where its coordinates are.
pub(super) fn key<const N: usize>(point: [f64; N]) -> [u64; N] {
    // Adding zero turns -0 into 0.
    point.map(|x| (x + 0.0).to_bits())
}

impl Stage {
    pub fn new(parts: &ShellParts) -> Self {
        let column = |v: u32| [&parts.bottom, &parts.middle, &parts.top].map(|level| level[v as usize]);
        let body = |corners: &[u32; 3]| {
            let columns = corners.map(column);
            let slab = |low: usize| Aabb::of(columns.map(|c| [c[low], c[low + 1]]).as_flattened());
            let prism = Prism::new(columns);
            let caps = [0, 1].map(|number| Aabb::of(&prism.cap(number)));
            Body { prism, caps, slabs: [slab(0), slab(1)] }
        };
        let bodies: Vec<Body> = parts.prisms.iter().map(body).collect();
        let hulls: Vec<Aabb> = bodies.iter().map(|body| body.prism.hull()).collect();
        let directed: std::collections::HashSet<[u32; 2]> = parts.prisms.iter().flat_map(|&p| sides(p)).collect();
        let mut walls = Vec::new();
        for (body, &corners) in bodies.iter().zip(&parts.prisms) {
            for (k, [a, b]) in sides(corners).into_iter().enumerate() {
                if !directed.contains(&[b, a]) {
                    walls.extend(body.prism.walls_over(k).into_iter().map(|(_, wall)| wall));
                }
            }
        }
        let wall_boxes: Vec<Aabb> = walls.iter().map(|wall| Aabb::of(wall)).collect();
        let columns = (0..parts.middle.len() as u32).map(column);
        let mut pinched: Vec<[u64; 3]> = columns.filter(|&c| is_pinched(c)).map(|[_, middle, _]| key(middle)).collect();
        pinched.sort_unstable();
        Self { tree: Tree::new(&hulls), bodies, wall_tree: Tree::new(&wall_boxes), walls, pinched }
    }

    /// Whether a point is that of a pinched column.
    pub fn is_pinched(&self, point: Point) -> bool {
        self.pinched.binary_search(&key(point)).is_ok()
    }

    /// Whether a triangle may be part of a section, exactly: it has an area and, with each prism, satisfies L3 and L4.
    /// Nothing else than the triangle and the shell matters.
    pub fn check(&self, triangle: [Point; 3]) -> Result<(), Fault> {
        let is_finite = triangle.as_flattened().iter().all(|x| x.is_finite());
        if !is_finite || is_degenerate_triangle(triangle[0], triangle[1], triangle[2]) {
            return Err(Fault::NoArea);
        }
        let hull = Aabb::of(&triangle);
        let mut outcome = Ok(());
        self.wall_tree.query_box(&hull, |w| {
            if outcome.is_ok() && !is_inside_wall(self.walls[w], triangle) {
                outcome = Err(Fault::Wall);
            }
        });
        self.tree.query_box(&hull, |p| {
            if outcome.is_ok() {
                outcome = self.bodies[p].check(triangle, &hull);
            }
        });
        outcome
    }

    /// The smallest cosine of the angles between the normal of a triangle and the pillars that have to cross it, or at
    /// most `floor` if it is not larger; rounded.
    pub fn steepness(&self, triangle: [Point; 3], floor: f64) -> f64 {
        let hull = Aabb::of(&triangle);
        let upright = normal(triangle);
        let mut smallest = 1.0;
        self.tree.query_box(&hull, |p| {
            let body = &self.bodies[p];
            for slab in 0..2 {
                let cosine = body.prism.smallest_cosine(slab, upright);
                let may_lower = smallest > floor && cosine < smallest && body.slabs[slab].meets(&hull);
                if may_lower && !body.is_apart(slab, triangle) {
                    smallest = cosine;
                }
            }
        });
        smallest
    }
}

impl Body {
    fn check(&self, triangle: [Point; 3], hull: &Aabb) -> Result<(), Fault> {
        for slab in 0..2 {
            if self.slabs[slab].meets(hull) && !self.is_crossed_well(slab, triangle) {
                return Err(Fault::Crossing);
            }
            if self.caps[slab].meets(hull) && !self.prism.is_off_cap(slab, triangle) {
                return Err(Fault::Cap);
            }
        }
        Ok(())
    }

    /// L4. The signs of the pillars decide nearly always.
    fn is_crossed_well(&self, slab: usize, triangle: [Point; 3]) -> bool {
        self.prism.is_crossed(slab, triangle) || self.is_apart(slab, triangle)
    }

    /// Whether a triangle and a slab have no area in common.
    fn is_apart(&self, slab: usize, triangle: [Point; 3]) -> bool {
        let walls = self.prism.outer_walls();
        walls[slab].iter().any(|wall| is_outside(*wall, triangle)) || !self.prism.shares_area(slab, triangle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::construct::shell::{ShellParams, build};
    use crate::input::SourceMesh;
    use crate::progress::Silent;
    use homeo_core::mesh::SimplicialComplex;

    #[test]
    fn steepness_tells_triangles_from_those_turned_over() {
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let complex = SimplicialComplex::from_indices(4, &triangles).expect("a surface");
        let source = SourceMesh::new(positions.clone(), complex);
        let (shell, _) = build(&source, &ShellParams::default(), &Silent).expect("a shell");
        let stage = Stage::new(shell.parts());
        for corners in triangles {
            let [a, b, c] = corners.map(|v| positions[v as usize]);
            assert_eq!(stage.check([a, b, c]), Ok(()));
            let steepness = stage.steepness([a, b, c], -1.0);
            assert!(steepness > 0.0 && steepness < 1.0, "{steepness}");
            // A floor below it changes nothing, one above it is not exceeded.
            assert_eq!(stage.steepness([a, b, c], 0.5 * steepness), steepness);
            assert!(stage.steepness([a, b, c], 0.5 + 0.5 * steepness) <= 0.5 + 0.5 * steepness);
            assert_eq!(stage.check([a, c, b]), Err(Fault::Crossing));
            assert!(stage.steepness([a, c, b], -1.0) < 0.0);
        }
        // Far away no pillar has to cross it.
        let far = positions[1..].iter().map(|p| p.map(|x| x + 10.0)).collect::<Vec<_>>();
        assert_eq!(stage.steepness([far[0], far[1], far[2]], -1.0), 1.0);
    }
}
