//! A polygon with holes that is known to be one.

use std::ops::RangeInclusive;

use super::{Point2, meeting::EdgeId, meeting_edges};
use crate::number::Rational;
use crate::predicate::{Sign, orient2d};

/// Magnitudes on which signs are exact.
const EXACT_RANGE: RangeInclusive<f64> = 1e-90..=1e90;

/// What a simple polygon bounds, less the insides of polygons in it.
///
/// # Invariants
/// Every ring has three vertices or more and is simple; rings do not meet; the outer one, ring 0, runs counter-clockwise
/// and contains the others, which run clockwise and contain none. All exactly, on the stored numbers.
///
/// ```
/// use homeo_core::planar::PlanarDomain;
/// let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let domain = PlanarDomain::new(vec![square]).unwrap();
/// assert_eq!(domain.vertex_count(), 4);
/// assert!(domain.contains([0.5, 0.0]) && !domain.contains([0.5, -1e-300]));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PlanarDomain {
    rings: Vec<Vec<Point2>>,
}

/// Why rings bound no domain. Rings and vertices are numbered from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DomainError {
    /// There is no ring.
    #[error("there is no polygon")]
    Empty,
    /// A ring has one or two vertices.
    #[error("ring {ring} has {count} vertices; a polygon needs three")]
    TooFewVertices {
        /// The ring.
        ring: usize,
        /// How many it has.
        count: usize,
    },
    /// A coordinate is not finite, or so large or small that signs of products are not exact.
    #[error("vertex {vertex} of ring {ring} is {point:?}: coordinates must be 0 or between 1e-90 and 1e90 in size")]
    OutOfRange {
        /// The ring.
        ring: usize,
        /// The vertex in it.
        vertex: usize,
        /// Where it is.
        point: Point2,
    },
    /// Edges meet: the polygon is not simple, or rings touch.
    #[error(
        "edge {} of ring {} and edge {} of ring {} meet ({count} such pairs): move vertices until none do",
        first[0].edge, first[0].ring, first[1].edge, first[1].ring
    )]
    EdgesMeet {
        /// The first pair.
        first: [EdgeId; 2],
        /// How many pairs; no more than 100 are counted.
        count: usize,
    },
    /// A ring runs the wrong way round.
    #[error("ring {ring} runs {runs}: reverse the order of its vertices")]
    WrongWay {
        /// The ring; 0 is the outer one.
        ring: usize,
        /// How it runs.
        runs: &'static str,
    },
    /// A hole lies outside the outer ring or inside another hole.
    #[error("ring {ring} does not lie inside the outer ring and outside the other holes")]
    Misplaced {
        /// The ring.
        ring: usize,
    },
}

impl PlanarDomain {
    /// The domain of some rings: the outer one, counter-clockwise, then those of the holes, clockwise.
    ///
    /// # Errors
    /// The first thing that is wrong with them.
    pub fn new(rings: Vec<Vec<Point2>>) -> Result<Self, DomainError> {
        if rings.is_empty() {
            return Err(DomainError::Empty);
        }
        for (ring, points) in rings.iter().enumerate() {
            if points.len() < 3 {
                return Err(DomainError::TooFewVertices { ring, count: points.len() });
            }
            let is_good = |x: &f64| *x == 0.0 || EXACT_RANGE.contains(&x.abs());
            if let Some(vertex) = points.iter().position(|p| !p.iter().all(is_good)) {
                return Err(DomainError::OutOfRange { ring, vertex, point: points[vertex] });
            }
        }
        let meeting = meeting_edges(&rings, 100);
        if let Some(&first) = meeting.first() {
            return Err(DomainError::EdgesMeet { first, count: meeting.len() });
        }
        for (ring, points) in rings.iter().enumerate() {
            let (wanted, runs) = match ring {
                0 => (Sign::Positive, "clockwise"),
                _ => (Sign::Negative, "counter-clockwise, as no hole may"),
            };
            if turn(points) != wanted {
                return Err(DomainError::WrongWay { ring, runs });
            }
        }
        // Rings that do not meet are inside or outside one another as a whole.
        let is_in = |ring: usize, other: usize| winding(&rings[other], rings[ring][0]) != 0;
        let is_misplaced = |&ring: &usize| !is_in(ring, 0) || (1..rings.len()).any(|o| o != ring && is_in(ring, o));
        match (1..rings.len()).find(is_misplaced) {
            Some(ring) => Err(DomainError::Misplaced { ring }),
            None => Ok(Self { rings }),
        }
    }

    /// The rings: the outer one, then the holes.
    pub fn rings(&self) -> &[Vec<Point2>] {
        &self.rings
    }

    /// How many vertices all rings have.
    pub fn vertex_count(&self) -> usize {
        self.rings.iter().map(Vec::len).sum()
    }

    /// All vertices, ring after ring.
    pub fn vertices(&self) -> impl Iterator<Item = Point2> + '_ {
        self.rings.iter().flatten().copied()
    }

    /// All edges, ring after ring; the domain is to the left of each.
    pub fn edges(&self) -> impl Iterator<Item = [Point2; 2]> + '_ {
        self.rings.iter().flat_map(|ring| (0..ring.len()).map(move |i| [ring[i], ring[(i + 1) % ring.len()]]))
    }

    /// The least and the greatest coordinates.
    pub fn bounds(&self) -> [Point2; 2] {
        let around = |[low, high]: [Point2; 2], p: &Point2| {
            [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
        };
        self.rings[0].iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], around)
    }

    /// Length of the diagonal of the bounding box.
    pub fn diagonal(&self) -> f64 {
        let [low, high] = self.bounds();
        (high[0] - low[0]).hypot(high[1] - low[1])
    }

    /// Whether a point lies inside or on the boundary, exactly.
    ///
    /// # Complexity
    /// Linear in the number of edges.
    pub fn contains(&self, point: Point2) -> bool {
        let is_between = |p: Point2, q: Point2, k: usize| p[k].min(q[k]) <= point[k] && point[k] <= p[k].max(q[k]);
        let on =
            |[p, q]: [Point2; 2]| is_between(p, q, 0) && is_between(p, q, 1) && orient2d(p, q, point) == Sign::Zero;
        self.edges().any(on) || self.rings.iter().map(|ring| winding(ring, point)).sum::<i32>() != 0
    }
}

/// The exact sign of the area that a polygon bounds, counted by windings.
pub fn turn(points: &[Point2]) -> Sign {
    let exact = |x: f64| Rational::from_f64(x).unwrap_or(Rational::ZERO);
    let n = points.len();
    let area: Rational = (0..n)
        .map(|i| {
            let ([ax, ay], [bx, by]) = (points[i].map(exact), points[(i + 1) % n].map(exact));
            ax * by - bx * ay
        })
        .sum();
    area.sign()
}

/// How often a closed polygon winds round a point that is not on it, exactly.
fn winding(points: &[Point2], point: Point2) -> i32 {
    let n = points.len();
    let turns = |i: usize| {
        let (a, b) = (points[i], points[(i + 1) % n]);
        match (a[1] <= point[1], b[1] <= point[1]) {
            (true, false) if orient2d(a, b, point) == Sign::Positive => 1,
            (false, true) if orient2d(a, b, point) == Sign::Negative => -1,
            _ => 0,
        }
    };
    (0..n).map(turns).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(r: f64) -> Vec<Point2> {
        vec![[-r, -r], [r, -r], [r, r], [-r, r]]
    }

    fn reversed(mut ring: Vec<Point2>) -> Vec<Point2> {
        ring.reverse();
        ring
    }

    #[test]
    fn rings_are_refused_for_what_is_wrong() {
        let new = PlanarDomain::new;
        assert_eq!(new(vec![]), Err(DomainError::Empty));
        assert_eq!(new(vec![vec![[0.0; 2]; 2]]), Err(DomainError::TooFewVertices { ring: 0, count: 2 }));
        assert!(matches!(new(vec![reversed(square(1.0))]), Err(DomainError::WrongWay { ring: 0, .. })));
        assert!(matches!(new(vec![square(2.0), square(1.0)]), Err(DomainError::WrongWay { ring: 1, .. })));
        assert_eq!(new(vec![square(1.0), reversed(square(2.0))]), Err(DomainError::Misplaced { ring: 1 }));
        let nested = vec![square(3.0), reversed(square(2.0)), reversed(square(1.0))];
        assert_eq!(new(nested), Err(DomainError::Misplaced { ring: 2 }));
        let infinite = vec![vec![[0.0, 0.0], [f64::INFINITY, 0.0], [0.0, 1.0]]];
        assert!(matches!(new(infinite), Err(DomainError::OutOfRange { vertex: 1, .. })));
        let crossing = vec![vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]];
        assert!(matches!(new(crossing), Err(DomainError::EdgesMeet { count: 1, .. })));
    }

    #[test]
    fn points_are_located_exactly() {
        let ring = PlanarDomain::new(vec![square(2.0), reversed(square(1.0))]).unwrap();
        for inside in [[1.0, 1.0], [1.5, 0.0], [2.0, 2.0], [0.0, -1.0], [-2.0, 0.3]] {
            assert!(ring.contains(inside), "{inside:?}");
        }
        for outside in [[0.0, 0.0], [1.0f64.next_down(), 0.0], [2.0f64.next_up(), 0.0], [3.0, 1.0], [3.0, 2.0]] {
            assert!(!ring.contains(outside), "{outside:?}");
        }
    }

    #[test]
    fn orientation_is_exact() {
        assert_eq!(turn(&square(1.0)), Sign::Positive);
        assert_eq!(turn(&reversed(square(1.0))), Sign::Negative);
        assert_eq!(turn(&[[0.0, 0.0], [0.1, 0.1], [0.3, 0.3]]), Sign::Zero);
    }
}
