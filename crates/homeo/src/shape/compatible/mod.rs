//! One triangulation drawn twice: round and inside two polygons with corresponding vertices.

mod cut;
mod outline;
mod overlay;
mod region;

use homeo_core::planar::{PlanarDomain, Point2};
use homeo_core::predicate::{Sign, orient2d};

use crate::composite::{Tiling, TriangulationError, check_tiling};
use outline::Outline;
use overlay::Overlay;
use region::Region;

/// Why two shapes have no common triangulation. Vertices are numbered: 0 to 3 are the corners of the frame, then those of
/// the rings, ring after ring.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CompatibleError {
    /// Two vertices became one when the shape was moved to the middle of its frame, or the triangulator merged them.
    #[error("vertex {vertex} of the triangulation lies on another after rounding: move it away")]
    Merged {
        /// The vertex.
        vertex: u32,
    },
    /// An edge crosses another after rounding.
    #[error("the edge from vertex {from} to vertex {to} of the triangulation crosses another after rounding")]
    Crossed {
        /// Where it begins.
        from: u32,
        /// Where it ends.
        to: u32,
    },
    /// A triangle is turned over or flat after rounding.
    #[error("the triangle of vertices {corners:?} is flat after rounding: the shape is too narrow there")]
    Flat {
        /// Its corners.
        corners: [u32; 3],
    },
    /// The triangles of a region do not open into a polygon.
    #[error("the triangles to the left of the edge from vertex {from} to vertex {to} do not open into a polygon")]
    NotOpened {
        /// Where it begins.
        from: u32,
        /// Where it ends.
        to: u32,
    },
    /// The triangles do not tile the frame after rounding.
    #[error("the common triangles do not tile their frame after rounding: {0}")]
    NoTiling(#[from] TriangulationError),
}

/// A triangulation of a square frame, drawn round two shapes. Vertices 0 to 3 are the corners of the frame,
/// counter-clockwise; then come those of the rings, ring after ring, and last added ones.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Compatible {
    /// Where vertices are in each drawing.
    pub positions: [Vec<Point2>; 2],
    /// Corners run counter-clockwise, exactly, in both drawings.
    pub triangles: Vec<[u32; 3]>,
}

/// How many corners a frame has.
pub(super) const FRAME: usize = 4;

impl Compatible {
    /// Triangulates the frame with corners `(+-half, +-half)` and the rings of two domains in it, with at most one hole.
    ///
    /// Each region, cut open between its two rings if it has two, is triangulated in both drawings without further
    /// vertices. Both triangulations are those of one convex polygon, laid over one another there; crossings are put on
    /// chords of the first in the first drawing, of the second in the second. What is returned has passed
    /// [`check_tiling`], in both drawings.
    pub fn new(half: f64, rings: [&[Vec<Point2>]; 2]) -> Result<Self, CompatibleError> {
        let frame = [[-half, -half], [half, -half], [half, half], [-half, half]];
        let positions = rings.map(|rings| frame.into_iter().chain(rings.iter().flatten().copied()).collect());
        let mut first = FRAME as u32;
        let names = rings[0].iter().map(|ring| {
            first += ring.len() as u32;
            (first - ring.len() as u32..first).collect::<Vec<u32>>()
        });
        let names: Vec<Vec<u32>> = names.collect();
        let reversed = |ring: &Vec<u32>| ring.iter().rev().copied().collect::<Vec<u32>>();
        let outside = Region { outer: (0..FRAME as u32).collect(), inner: names.first().map(reversed) };
        let domain = names.first().map(|outer| Region { outer: outer.clone(), inner: names.get(1).cloned() });
        let holes = names[1..].iter().map(|ring| Region { outer: reversed(ring), inner: None });
        let mut whole = Self { positions, triangles: Vec::new() };
        for region in std::iter::once(outside).chain(domain).chain(holes) {
            whole.fill(&region)?;
        }
        let square = PlanarDomain::new(vec![frame.to_vec()])
            .map_err(|_| CompatibleError::NotOpened { from: 0, to: FRAME as u32 - 1 })?;
        for positions in &whole.positions {
            let tiling = Tiling { added: positions[FRAME..].to_vec(), triangles: whole.triangles.clone() };
            check_tiling(&square, &tiling)?;
        }
        Ok(whole)
    }

    /// Triangulates a region.
    fn fill(&mut self, region: &Region) -> Result<(), CompatibleError> {
        let mut cuts = Vec::new();
        let mut extra = Vec::new();
        if region.inner.is_some() {
            let plain = self.triangulated(region, &extra, &cuts)?;
            let [a, b] = &self.positions;
            let not_opened = CompatibleError::NotOpened { from: region.outer[0], to: region.outer[1] };
            let cut = cut::cut(region, [a, b], [&plain[0], &plain[1]]).ok_or(not_opened)?;
            let first = self.positions[0].len() as u32;
            for (positions, between) in self.positions.iter_mut().zip(&cut.between) {
                positions.extend(between);
            }
            extra = (first..self.positions[0].len() as u32).collect();
            let way: Vec<u32> = std::iter::once(cut.from).chain(extra.iter().copied()).chain([cut.to]).collect();
            cuts = way.windows(2).map(|link| [link[0], link[1]]).collect();
        }
        let triangles = self.triangulated(region, &extra, &cuts)?;
        let sides = region.sides();
        let walls: Vec<[u32; 2]> = sides.iter().chain(&cuts).copied().collect();
        let start = cuts.first().copied().unwrap_or(sides[0]);
        let [first, second] = &triangles;
        let outlines = [Outline::new(first, start, &walls)?, Outline::new(second, start, &walls)?];
        if outlines[0].names != outlines[1].names {
            return Err(CompatibleError::NotOpened { from: start[0], to: start[1] });
        }
        self.lay_over(&outlines);
        Ok(())
    }

    /// The region in triangles, in both drawings; the second takes as many edges of the first as it can.
    fn triangulated(
        &self,
        region: &Region,
        extra: &[u32],
        cuts: &[[u32; 2]],
    ) -> Result<[Vec<[u32; 3]>; 2], CompatibleError> {
        let first = region::triangulate(&self.positions[0], region, extra, cuts, &[])?;
        let near = region.vertices();
        let is_clear = |ends: &[u32; 2]| is_clear(&self.positions[1], *ends, near.iter().chain(extra));
        let wishes: Vec<[u32; 2]> = region::edges(&first).into_keys().filter(is_clear).collect();
        let second = region::triangulate(&self.positions[1], region, extra, cuts, &wishes)?;
        Ok([first, second])
    }

    /// Adds the common refinement of two triangulations of one polygon.
    fn lay_over(&mut self, outlines: &[Outline; 2]) {
        let names = &outlines[0].names;
        let overlay = Overlay::new(names.len(), [&outlines[0].triangles, &outlines[1].triangles]);
        let first = self.positions[0].len();
        for (side, positions) in self.positions.iter_mut().enumerate() {
            for crossing in &overlay.crossings {
                let [a, b] = crossing.chords[side].map(|corner| positions[names[corner as usize] as usize]);
                let share = crossing.shares[side];
                positions.push([0, 1].map(|axis| super::mix(share, a[axis], b[axis])));
            }
        }
        let name = |corner: u32| match names.get(corner as usize) {
            Some(&name) => name,
            None => (first + corner as usize - names.len()) as u32,
        };
        for cell in overlay.cells {
            let cell: Vec<u32> = cell.into_iter().map(name).collect();
            let fan = best_fan(&cell, &self.positions);
            self.triangles.extend(fan);
        }
    }
}

/// The first triangle that is not counter-clockwise, exactly.
pub(super) fn first_not_positive(positions: &[Point2], triangles: &[[u32; 3]]) -> Option<usize> {
    let is_positive = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        orient2d(a, b, c) == Sign::Positive
    };
    triangles.iter().position(|corners| !is_positive(corners))
}

/// The triangles of a convex cell from that corner from which the least triangle is the largest part of the cell, in the
/// worse of both drawings.
fn best_fan(cell: &[u32], positions: &[Vec<Point2>; 2]) -> Vec<[u32; 3]> {
    let n = cell.len();
    let fan = |apex: usize| (1..n - 1).map(move |i| [cell[apex], cell[(apex + i) % n], cell[(apex + i + 1) % n]]);
    let least = |apex: usize| {
        let part = |positions: &Vec<Point2>| {
            let areas = || fan(apex).map(|corners| area(corners.map(|corner| positions[corner as usize])));
            areas().fold(f64::INFINITY, f64::min) / areas().sum::<f64>()
        };
        positions.iter().map(part).fold(f64::INFINITY, f64::min)
    };
    let apex = (0..n).max_by(|&a, &b| least(a).total_cmp(&least(b)).then(b.cmp(&a))).unwrap_or(0);
    fan(apex).collect()
}

/// An edge of the first drawing is taken over only if no vertex is nearer to it than this part of its length: it would make
/// triangles that are flat but for rounding.
const CLEARANCE: f64 = 1.0 / 256.0;

/// Whether no vertex other than its ends is near an edge.
fn is_clear<'a>(positions: &[Point2], ends: [u32; 2], mut vertices: impl Iterator<Item = &'a u32>) -> bool {
    let [a, b] = ends.map(|end| positions[end as usize]);
    let (along, squared) = ([b[0] - a[0], b[1] - a[1]], (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2));
    vertices.all(|&vertex| {
        let point = positions[vertex as usize];
        let to = [point[0] - a[0], point[1] - a[1]];
        let share = ((along[0] * to[0] + along[1] * to[1]) / squared).clamp(0.0, 1.0);
        let distance = (to[0] - share * along[0]).hypot(to[1] - share * along[1]);
        ends.contains(&vertex) || distance * distance > CLEARANCE * CLEARANCE * squared
    })
}

/// Twice the area of a triangle, rounded.
fn area([a, b, c]: [Point2; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
