//! Regions of the plane between rings, cut into triangles without further vertices.

use std::collections::{BTreeMap, HashMap, HashSet};

use homeo_core::planar::Point2;
use homeo_core::predicate::{Sign, orient2d};
use spade::{ConstrainedDelaunayTriangulation, Point2 as Position, Triangulation as _};

use super::CompatibleError;

/// What lies to the left of a ring, or of two. Rings are numbers of vertices.
#[derive(Clone, Debug)]
pub(super) struct Region {
    /// Counter-clockwise.
    pub outer: Vec<u32>,
    /// Clockwise.
    pub inner: Option<Vec<u32>>,
}

impl Region {
    /// Directed edges of the boundary; the region is to the left of each.
    pub fn sides(&self) -> Vec<[u32; 2]> {
        let around = |ring: &Vec<u32>| (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]).collect();
        let mut sides: Vec<[u32; 2]> = around(&self.outer);
        sides.extend(self.inner.iter().flat_map(around));
        sides
    }

    /// The numbers of all its vertices.
    pub fn vertices(&self) -> Vec<u32> {
        self.outer.iter().chain(self.inner.iter().flatten()).copied().collect()
    }
}

type Plane = ConstrainedDelaunayTriangulation<Position<f64>>;

/// The constrained Delaunay triangulation of a region.
///
/// `cuts` are edges that it must have, between vertices of the region and `extra` ones; `wishes` are edges that it gets
/// where they cross none before them. Corners run counter-clockwise, exactly; they are numbers into `points`.
pub(super) fn triangulate(
    points: &[Point2],
    region: &Region,
    extra: &[u32],
    cuts: &[[u32; 2]],
    wishes: &[[u32; 2]],
) -> Result<Vec<[u32; 3]>, CompatibleError> {
    let names: Vec<u32> = region.vertices().into_iter().chain(extra.iter().copied()).collect();
    let mut plane = Plane::new();
    let mut handles = HashMap::new();
    for (number, &name) in names.iter().enumerate() {
        let [x, y] = points[name as usize].map(|x| if x.abs() < LEAST_COORDINATE { 0.0 } else { x });
        let merged = CompatibleError::Merged { vertex: name };
        let handle = plane.insert(Position::new(x, y)).map_err(|_| merged.clone())?;
        if handle.index() != number {
            return Err(merged);
        }
        handles.insert(name, handle);
    }
    let sides = region.sides();
    for (place, &[from, to]) in sides.iter().chain(cuts).chain(wishes).enumerate() {
        let (Some(&from_handle), Some(&to_handle)) = (handles.get(&from), handles.get(&to)) else { continue };
        if plane.can_add_constraint(from_handle, to_handle) {
            plane.add_constraint(from_handle, to_handle);
        } else if place < sides.len() + cuts.len() {
            return Err(CompatibleError::Crossed { from, to });
        }
    }
    let triangles = inside(&plane, &names, &sides);
    let is_flat = |[a, b, c]: &[u32; 3]| {
        orient2d(points[*a as usize], points[*b as usize], points[*c as usize]) != Sign::Positive
    };
    match triangles.iter().find(|corners| is_flat(corners)) {
        Some(&corners) => Err(CompatibleError::Flat { corners }),
        None => Ok(triangles),
    }
}

/// Smaller coordinates, of shapes of about size 1, are taken for 0 by the triangulator; what comes of it is tested exactly.
const LEAST_COORDINATE: f64 = 1e-40;

/// The triangles that are reached from the left of the sides without crossing one.
fn inside(plane: &Plane, names: &[u32], sides: &[[u32; 2]]) -> Vec<[u32; 3]> {
    let walls: HashSet<[u32; 2]> = sides.iter().copied().collect();
    let named = |[from, to]: [usize; 2]| [names[from], names[to]];
    let mut is_inside = vec![false; plane.num_all_faces()];
    let mut waiting = Vec::new();
    for edge in plane.directed_edges().filter(|edge| !edge.face().is_outer()) {
        if walls.contains(&named([edge.from().index(), edge.to().index()])) {
            waiting.push(edge.face().fix());
        }
    }
    while let Some(face) = waiting.pop() {
        if std::mem::replace(&mut is_inside[face.index()], true) {
            continue;
        }
        for edge in plane.face(face).as_inner().into_iter().flat_map(|inner| inner.adjacent_edges()) {
            let is_wall = walls.contains(&named([edge.from().index(), edge.to().index()]));
            if !is_wall && !edge.rev().face().is_outer() {
                waiting.push(edge.rev().face().fix());
            }
        }
    }
    let found = plane.inner_faces().filter(|face| is_inside[face.index()]);
    found.map(|face| face.vertices().map(|vertex| names[vertex.index()])).collect()
}

/// The edges of triangles, from the lower to the higher number, each with the corners that are opposite to it.
pub(super) fn edges(triangles: &[[u32; 3]]) -> BTreeMap<[u32; 2], Vec<u32>> {
    let mut edges: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for corners in triangles {
        for k in 0..3 {
            let [a, b, apex] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
            edges.entry([a.min(b), a.max(b)]).or_default().push(apex);
        }
    }
    edges
}
