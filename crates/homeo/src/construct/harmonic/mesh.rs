//! Triangulating a domain: constrained Delaunay, refined inside.

use std::collections::{HashMap, HashSet};

use homeo_core::planar::Point2;
use spade::{AngleLimit, ConstrainedDelaunayTriangulation, RefinementParameters, Triangulation};

use super::HarmonicError;

/// A triangulation whose first vertices are those of the boundary.
pub(super) struct Mesh {
    pub boundary: Vec<Point2>,
    pub inner: Vec<Point2>,
    pub triangles: Vec<[u32; 3]>,
}

/// Angles below this many degrees are refined away where the boundary lets them.
const LEAST_ANGLE: f64 = 25.0;

/// Triangulates what some rings bound; no vertices are added on the boundary.
pub(super) fn triangulate(
    rings: &[Vec<Point2>],
    largest_area: f64,
    most_vertices: usize,
) -> Result<Mesh, HarmonicError> {
    let failed = |what: &str| HarmonicError::Triangulation(what.to_owned());
    let boundary: Vec<Point2> = rings.iter().flatten().copied().collect();
    // Scaled by a power of two, which rounds nothing, coordinates of any size suit the triangulation.
    let scale = scale_of(&boundary);
    let scaled = |p: &Point2| p.map(|x| x * scale).map(|x| if x.abs() < LEAST_COORDINATE { 0.0 } else { x });
    let largest_area = largest_area * scale * scale;
    let mut constraints = Vec::with_capacity(boundary.len());
    let mut first = 0;
    for ring in rings {
        constraints.extend((0..ring.len()).map(|i| [first + i, first + (i + 1) % ring.len()]));
        first += ring.len();
    }
    let points = boundary.iter().map(scaled).map(|p| spade::Point2::new(p[0], p[1])).collect();
    let mut plane =
        ConstrainedDelaunayTriangulation::<spade::Point2<f64>>::try_bulk_load_cdt(points, constraints, |_| {})
            .map_err(|e| HarmonicError::Triangulation(e.to_string()))?;
    if plane.num_vertices() != boundary.len() {
        return Err(failed("points of the boundary are the same after rounding"));
    }
    let parameters = RefinementParameters::new()
        .exclude_outer_faces(true)
        .keep_constraint_edges()
        .with_angle_limit(AngleLimit::from_deg(LEAST_ANGLE))
        .with_max_allowed_area(largest_area)
        .with_max_additional_vertices(most_vertices);
    let refined = plane.refine(parameters);
    let outside: HashSet<usize> = refined.excluded_faces.iter().map(|face| face.index()).collect();
    let numbers: HashMap<[u64; 2], u32> =
        boundary.iter().enumerate().map(|(i, p)| (scaled(p).map(|x| (x + 0.0).to_bits()), i as u32)).collect();
    let mut inner = Vec::new();
    let mut number = vec![u32::MAX; plane.num_vertices()];
    for vertex in plane.vertices() {
        // Zero has two signs.
        let point = [vertex.position().x + 0.0, vertex.position().y + 0.0];
        number[vertex.index()] = numbers.get(&point.map(f64::to_bits)).copied().unwrap_or_else(|| {
            inner.push(point.map(|x| x / scale));
            (boundary.len() + inner.len() - 1) as u32
        });
    }
    let triangles = plane
        .inner_faces()
        .filter(|face| !outside.contains(&face.index()))
        .map(|face| face.vertices().map(|v| number[v.index()]))
        .collect();
    Ok(Mesh { boundary, inner, triangles })
}

/// Smaller coordinates, of a domain of about size 1, are taken for 0; what comes of it is tested exactly.
const LEAST_COORDINATE: f64 = 1e-40;

/// A power of two that makes the largest coordinate about 1.
fn scale_of(points: &[Point2]) -> f64 {
    let largest = points.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
    let exponent = -(largest.log2().round()).clamp(-900.0, 900.0);
    if exponent.is_finite() { 2f64.powi(exponent as i32) } else { 1.0 }
}

impl Mesh {
    /// How many vertices there are.
    pub fn len(&self) -> usize {
        self.boundary.len() + self.inner.len()
    }

    /// Where all vertices lie.
    pub fn positions(&self) -> Vec<Point2> {
        self.boundary.iter().chain(&self.inner).copied().collect()
    }

    /// Where a vertex lies.
    pub fn position(&self, vertex: u32) -> Point2 {
        match (vertex as usize).checked_sub(self.boundary.len()) {
            Some(inner) => self.inner[inner],
            None => self.boundary[vertex as usize],
        }
    }

    /// Splits inner edges whose ends, the lower one first, are so: mapped into one straight line they would leave triangles
    /// without area.
    pub fn split_chords(&mut self, is_chord: impl Fn([u32; 2]) -> bool) {
        let mut sides: HashMap<[u32; 2], usize> = HashMap::new();
        for [a, b, c] in &self.triangles {
            for [i, j] in [[a, b], [b, c], [c, a]] {
                *sides.entry([*i.min(j), *i.max(j)]).or_default() += 1;
            }
        }
        let mut chords: Vec<[u32; 2]> =
            sides.into_iter().filter(|&(ends, uses)| uses == 2 && is_chord(ends)).map(|(chord, _)| chord).collect();
        chords.sort_unstable();
        let middles: HashMap<[u32; 2], u32> = chords
            .into_iter()
            .map(|[i, j]| {
                let (p, q) = (self.position(i), self.position(j));
                self.inner.push([0, 1].map(|axis| 0.5 * (p[axis] + q[axis])));
                ([i, j], self.len() as u32 - 1)
            })
            .collect();
        let mut waiting = std::mem::take(&mut self.triangles);
        while let Some(corners) = waiting.pop() {
            let split = (0..3).find_map(|k| {
                let [i, j] = [corners[k], corners[(k + 1) % 3]];
                middles.get(&[i.min(j), i.max(j)]).map(|&middle| (k, middle))
            });
            let Some((k, middle)) = split else {
                self.triangles.push(corners);
                continue;
            };
            let [i, j, far] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
            waiting.extend([[i, middle, far], [middle, j, far]]);
        }
        self.triangles.reverse();
    }

    /// Cuts it open so that its boundary passes these vertices, one after the other, with the triangles to the left. One that
    /// is passed twice becomes two. None if the triangles between two of its passages do not form a fan.
    pub fn opened(&self, walk: &[u32]) -> Option<Self> {
        const NONE: u32 = u32::MAX;
        let mut left_of = HashMap::with_capacity(3 * self.triangles.len());
        for (t, &[a, b, c]) in self.triangles.iter().enumerate() {
            left_of.extend([([a, b], (t, 0)), ([b, c], (t, 1)), ([c, a], (t, 2))]);
        }
        let mut number = vec![NONE; self.len()];
        let mut inner = Vec::new();
        let passed: HashSet<u32> = walk.iter().copied().collect();
        for vertex in (0..self.len() as u32).filter(|vertex| !passed.contains(vertex)) {
            number[vertex as usize] = (walk.len() + inner.len()) as u32;
            inner.push(self.position(vertex));
        }
        let mut triangles: Vec<[u32; 3]> = self.triangles.iter().map(|t| t.map(|v| number[v as usize])).collect();
        for (i, &here) in walk.iter().enumerate() {
            let (before, mut spoke) = (walk[(i + walk.len() - 1) % walk.len()], walk[(i + 1) % walk.len()]);
            while spoke != before {
                let &(t, corner) = left_of.get(&[here, spoke])?;
                if std::mem::replace(&mut triangles[t][corner], i as u32) != NONE {
                    return None;
                }
                spoke = self.triangles[t][(corner + 2) % 3];
            }
        }
        let is_whole = !triangles.as_flattened().contains(&NONE);
        let boundary = walk.iter().map(|&vertex| self.position(vertex)).collect();
        is_whole.then_some(Self { boundary, inner, triangles })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_of_triangles_opens_along_a_cut() {
        let boundary = vec![[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [2.0, 2.0], [2.0, 3.0], [3.0, 2.0]];
        let triangles = vec![[0, 1, 3], [1, 5, 3], [1, 2, 5], [2, 4, 5], [2, 0, 4], [0, 3, 4]];
        let ring = Mesh { boundary, inner: Vec::new(), triangles };
        let open = ring.opened(&[0, 1, 2, 0, 3, 4, 5, 3]).unwrap();
        assert_eq!(open.triangles, [[0, 1, 7], [1, 6, 7], [1, 2, 6], [2, 5, 6], [2, 3, 5], [3, 4, 5]]);
        assert_eq!((open.boundary[3], open.boundary[7]), ([0.0, 0.0], [2.0, 2.0]));
        // The wrong way round the hole, and along a cut that is no edge.
        assert!(ring.opened(&[0, 1, 2, 0, 3, 5, 4, 3]).is_none());
        assert!(ring.opened(&[0, 1, 2, 0, 5, 3, 4, 5]).is_none());
    }
}
