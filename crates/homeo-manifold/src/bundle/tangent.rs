//! Unit tangent bundles of closed surfaces.
//!
//! # Construction
//! The surface is cut into two disks along a closed path if it is a sphere, and into one along paths that meet at their
//! ends otherwise. Over the disks stand products: the levels of a disk are copies of it, and its frame is level 0. Across
//! the cuts the levels are shifted, and the shift changes by one along each of the *twisted* edges: along the closed path
//! of a sphere by `2 N` in all, with `N` levels; along each of `2 g - 2` of the paths otherwise by `-N`, so that it is 0
//! modulo `N` at their ends. Over a twisted edge the base edges of one side are the diagonals of the other, which
//! prescribes the same diagonal to both; all other walls are cut by [`cutting_pattern`]. Paths that are too short have
//! their edges split.
//!
//! Source: Yin 2010, chapters 6 and 7; `docs/theory/bundles.md` says where this differs, and proves it.

use super::charts::{cuts, ends};
use super::circle::{BundleError, CircleBundle, check_sizes};
use super::cutting::{Diagonal, cutting_pattern};
use super::refine::{Carrier, Refined};
use super::walls::{Side, Walls, sides_by_ends};
use std::collections::HashMap;

/// The unit tangent bundle of a closed surface, with the disks from which it is glued.
///
/// # Example
/// ```
/// use homeo_manifold::bundle::TangentBundle;
/// let sphere = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let tangent = TangentBundle::new(&sphere, 4, 4)?;
/// assert_eq!(tangent.bundle.euler_number(), Some(2));
/// assert_eq!(tangent.cuts.len(), 1);
/// # Ok::<(), homeo_manifold::bundle::BundleError>(())
/// ```
#[derive(Debug, Clone)]
pub struct TangentBundle {
    /// The bundle, over the surface with its edges split where this was necessary.
    pub bundle: CircleBundle,
    /// The vertices that were added to the surface, after its own.
    pub added: Vec<Carrier>,
    /// The triangle of the surface that each triangle below the bundle lies in.
    pub parents: Vec<u32>,
    /// The vertices of the paths along which the disks meet.
    pub cuts: Vec<Vec<u32>>,
    /// The levels, over the corners of each triangle, of the frame of the disk that the triangle is in.
    pub frame: Vec<[u32; 3]>,
}

impl TangentBundle {
    /// The unit tangent bundle of a closed, connected, consistently oriented surface, with fibres of `layers` edges.
    ///
    /// Cost: linear, but for a logarithm; `3 #F layers` tetrahedra.
    ///
    /// # Guarantee
    /// The Euler number is the Euler characteristic of the surface, so the bundle is isomorphic to the unit tangent
    /// bundle; see [`CircleBundle`].
    ///
    /// # Errors
    /// Triangles that are not such a surface; fewer than three layers; more vertices than 32 bits can name.
    pub fn new(triangles: &[[u32; 3]], vertex_count: usize, layers: u32) -> Result<Self, BundleError> {
        check_sizes(triangles, vertex_count, layers)?;
        let walls = Walls::new(triangles)?;
        check_fans(triangles, &walls, vertex_count)?;
        let cuts = cuts(triangles, &walls)?;
        let mut refined = Refined::new(triangles, vertex_count)?;
        let edges = 3 * triangles.len() / 2;
        let characteristic = vertex_count as i64 - edges as i64 + triangles.len() as i64;
        let twist = Twist::new(&mut refined, cuts, characteristic, layers);
        loop {
            match twist.bundle(&refined, layers) {
                // A sphere whose disks have no vertex inside: one is added.
                Err(BundleError::Obstruction(obstruction)) => refined.split_triangle(obstruction.triangles[0]),
                other => {
                    let (bundle, frame) = other?;
                    let (added, parents) = (refined.added, refined.parents);
                    debug_assert_eq!(bundle.euler_number(), Some(characteristic));
                    return Ok(Self { bundle, added, parents, cuts: twist.cuts, frame });
                }
            }
        }
    }
}

/// How the levels shift across the cuts.
struct Twist {
    cuts: Vec<Vec<u32>>,
    /// Of each cut, how many twisted edges there are before each of its vertices.
    shifts: Vec<Vec<u32>>,
    /// What the walls over twisted edges are, from both sides.
    diagonal: Diagonal,
}

impl Twist {
    fn new(refined: &mut Refined, mut cuts: Vec<Vec<u32>>, characteristic: i64, layers: u32) -> Self {
        // Longest first, so that few edges are split.
        cuts.sort_by_key(|path| std::cmp::Reverse(path.len()));
        let diagonal = if characteristic > 0 { Diagonal::Rising } else { Diagonal::Falling };
        // All of a sphere's turns are along the only path.
        let turns = if characteristic > 0 { 2 } else { 1 };
        let twisted_cuts = characteristic.unsigned_abs() as usize / turns;
        let mut shifts = Vec::with_capacity(cuts.len());
        for (number, path) in cuts.iter_mut().enumerate() {
            let twisted = if number < twisted_cuts { turns * layers as usize } else { 0 };
            if path.len() - 1 < twisted {
                *path = refined.lengthened(path, twisted);
            }
            let edges = path.len() - 1;
            shifts.push((0..=edges).map(|vertex| (vertex * twisted / edges) as u32).collect());
        }
        Self { cuts, shifts, diagonal }
    }

    fn bundle(&self, refined: &Refined, layers: u32) -> Result<(CircleBundle, Vec<[u32; 3]>), BundleError> {
        let triangles = &refined.triangles;
        let walls = Walls::new(triangles)?;
        let sides = sides_by_ends(triangles)?;
        let (mut open, mut prescribed) = (walls.clone(), Vec::new());
        let mut crossings = HashMap::new();
        for (path, shifts) in self.cuts.iter().zip(&self.shifts) {
            for (step, shift) in path.windows(2).zip(shifts.windows(2)) {
                let Some(&left) = sides.get(&[step[0], step[1]]) else { continue };
                let Some(right) = walls.across(left) else { continue };
                crossings.insert(left, [shift[0], shift[1]].map(|s| self.signed(s, layers)));
                crossings
                    .insert(right, [shift[1], shift[0]].map(|s| self.signed((layers - s % layers) % layers, layers)));
                if shift[0] != shift[1] {
                    open.cut(left);
                    prescribed.extend([left, right].map(|side| (side, self.diagonal)));
                }
            }
        }
        let pattern = cutting_pattern(&open, &prescribed)?;
        let frame = frames(triangles, &walls, &crossings, refined.vertex_count, layers);
        let slope = |side: Side| {
            let level = |corner: u8| frame[side.triangle as usize][usize::from(corner % 3)];
            let in_frame = if pattern[side.triangle as usize][usize::from(side.side)] == Diagonal::Rising {
                0
            } else {
                layers - 1
            };
            (in_frame + level(side.side + 1) + layers - level(side.side)) % layers
        };
        let slopes = (0..triangles.len() as u32).map(|t| [0, 1, 2].map(|side| slope(Side::new(t, side)))).collect();
        Ok((CircleBundle::new(triangles, refined.vertex_count, layers, slopes)?, frame))
    }

    /// What is added to a level in the frame on the left to have it in the frame on the right.
    fn signed(&self, shift: u32, layers: u32) -> u32 {
        match self.diagonal {
            Diagonal::Falling => shift % layers,
            Diagonal::Rising => (layers - shift % layers) % layers,
        }
    }
}

/// The levels of the frames over the corners of all triangles: what is added to a level in the frame to have that of the bundle.
///
/// `crossings` has for sides at cuts what is added, at the side's start and end, to levels when it is crossed.
fn frames(
    triangles: &[[u32; 3]],
    walls: &Walls,
    crossings: &HashMap<Side, [u32; 2]>,
    vertex_count: usize,
    layers: u32,
) -> Vec<[u32; 3]> {
    const UNSEEN: u32 = u32::MAX;
    let mut levels = vec![[UNSEEN; 3]; triangles.len()];
    let mut is_done = vec![false; vertex_count];
    for triangle in 0..triangles.len() as u32 {
        for corner in 0..3_u8 {
            let vertex = triangles[triangle as usize][usize::from(corner)] as usize;
            if std::mem::replace(&mut is_done[vertex], true) {
                continue;
            }
            // Round the vertex, by the side that ends at the corner, until the first triangle comes again.
            let (mut here, mut level) = (Side::new(triangle, corner), 0);
            loop {
                let slot = &mut levels[here.triangle as usize][usize::from(here.side)];
                if *slot != UNSEEN {
                    debug_assert_eq!(*slot, level, "the shifts round vertex {vertex} do not add up to 0");
                    break;
                }
                *slot = level;
                let before = Side::new(here.triangle, (here.side + 2) % 3);
                let Some(other) = walls.across(before) else { break };
                let shift = crossings.get(&before).map_or(0, |shift| shift[1]);
                level = (level + layers - shift) % layers;
                here = other;
            }
        }
    }
    levels
}

/// That the triangles at each vertex follow one another round it.
fn check_fans(triangles: &[[u32; 3]], walls: &Walls, vertex_count: usize) -> Result<(), BundleError> {
    let mut corners = vec![0_u32; vertex_count];
    let mut first = vec![None; vertex_count];
    for side in walls.sides() {
        let [vertex, _] = ends(triangles, side);
        corners[vertex as usize] += 1;
        first[vertex as usize].get_or_insert(side);
    }
    for vertex in 0..vertex_count as u32 {
        let Some(start) = first[vertex as usize] else { return Err(BundleError::NotManifold { vertex }) };
        let (mut here, mut count) = (start, 0);
        loop {
            count += 1;
            let Some(next) = walls.across(Side::new(here.triangle, (here.side + 2) % 3)) else { break };
            here = next;
            if here == start || count > corners[vertex as usize] {
                break;
            }
        }
        if count != corners[vertex as usize] {
            return Err(BundleError::NotManifold { vertex });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::surfaces::{glued_handles, torus};
    use super::*;

    fn vertices(triangles: &[[u32; 3]]) -> usize {
        triangles.iter().flatten().max().map_or(0, |&most| most as usize + 1)
    }

    #[test]
    fn euler_numbers_are_euler_characteristics() {
        let sphere = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let surfaces = [(sphere, 2), (torus(4, 3), 0), (glued_handles(2), -2), (glued_handles(4), -6)];
        for (triangles, characteristic) in surfaces {
            for layers in [3, 4, 7, 24] {
                let tangent = TangentBundle::new(&triangles, vertices(&triangles), layers).unwrap();
                assert_eq!(tangent.bundle.euler_number(), Some(characteristic), "{layers} layers");
            }
        }
    }

    #[test]
    fn a_vertex_of_two_fans_is_told() {
        // Two tetrahedra that share a vertex only.
        let sphere = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let other = sphere.map(|corners| corners.map(|v: u32| if v == 0 { 0 } else { v + 3 }));
        let both = [sphere, other].concat();
        let walls = Walls::new(&both).unwrap();
        assert_eq!(check_fans(&both, &walls, 7), Err(BundleError::NotManifold { vertex: 0 }));
    }
}
