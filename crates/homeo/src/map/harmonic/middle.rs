//! The domain between source and target of a composite harmonic map.

use homeo_core::number::{Interval, Scalar};
use homeo_core::planar::Point2;

use super::circuit::Circuit;
use super::half::BoundaryPoint;

/// The domain that both triangulations are flattened onto: a convex polygon, or a flat cylinder for domains with one hole.
///
/// Its boundary is given by one point for each vertex of the domain, ring by ring; an edge of the domain goes to the
/// segment between two of them, linearly. Domains with several holes are slit open: there is one ring, with a point for
/// each corner of the [`Circuit`].
#[derive(Clone, Debug, PartialEq)]
pub struct Middle {
    rings: Vec<Vec<Point2>>,
    circuit: Option<Circuit>,
}

impl Middle {
    /// Of images of the vertices, ring by ring.
    ///
    /// # Preconditions
    /// One ring: a strictly convex polygon, counter-clockwise. Two rings: a cylinder whose first coordinate counts modulo
    /// 1; the outer ring has the second coordinate 0 and goes once round, the inner one has 1 and goes once backwards.
    /// Neither is checked here; the certificate says whether it is so.
    pub fn new(rings: Vec<Vec<Point2>>) -> Self {
        Self { rings, circuit: None }
    }

    /// Of domains that are slit open, by images of the circuit's corners: a strictly convex polygon, counter-clockwise, which
    /// is not checked here.
    pub fn slit(circuit: Circuit, polygon: Vec<Point2>) -> Self {
        Self { rings: vec![polygon], circuit: Some(circuit) }
    }

    /// How domains with several holes are slit open.
    pub fn circuit(&self) -> Option<&Circuit> {
        self.circuit.as_ref()
    }

    /// The same with another polygon.
    pub(crate) fn with_polygon(self, polygon: Vec<Point2>) -> Self {
        Self { rings: vec![polygon], ..self }
    }

    /// Images of the vertices, ring by ring, or of the corners of the circuit.
    pub fn rings(&self) -> &[Vec<Point2>] {
        &self.rings
    }

    /// Whether it is a cylinder.
    pub fn is_cylinder(&self) -> bool {
        self.rings.len() == 2
    }

    /// By how much a ring's end is ahead of its beginning, in the first coordinate.
    fn advance(&self, ring: usize) -> f64 {
        match (self.is_cylinder(), ring) {
            (false, _) => 0.0,
            (true, 0) => 1.0,
            (true, _) => -1.0,
        }
    }

    /// Where a point of the boundary goes, rounded.
    pub(crate) fn point(&self, point: &BoundaryPoint) -> Point2 {
        between(&self.edge::<Interval>(point.ring as usize, point.edge as usize), point.share).map(|x| x.near())
    }

    /// Both ends of the image of an edge.
    pub(crate) fn edge<T: Scalar>(&self, ring: usize, edge: usize) -> [[T; 2]; 2] {
        let points = &self.rings[ring];
        let begin = points[edge].map(T::from_f64);
        let mut end = points[(edge + 1) % points.len()].map(T::from_f64);
        if edge + 1 == points.len() {
            end[0] = end[0].plus(&T::from_f64(self.advance(ring)));
        }
        [begin, end]
    }
}

/// A point between two others, at a share of the way in units of `2^-30`.
pub(crate) fn between<T: Scalar>([a, b]: &[[T; 2]; 2], share: u32) -> [T; 2] {
    if share == 0 {
        return a.clone();
    }
    let unit = f64::from(1 << SHARE_BITS);
    let (here, there) = (T::from_f64(1.0 - f64::from(share) / unit), T::from_f64(f64::from(share) / unit));
    [0, 1].map(|axis| a[axis].times(&here).plus(&b[axis].times(&there)))
}

/// Shares of an edge are whole multiples of two to minus this.
pub const SHARE_BITS: u32 = 30;

/// An interval in each coordinate as plain bounds: low ends, then high ends.
pub(crate) fn bounds(points: &[[Interval; 2]]) -> [Point2; 2] {
    let low = |axis: usize| points.iter().map(|p| p[axis].low()).fold(f64::INFINITY, f64::min);
    let high = |axis: usize| points.iter().map(|p| p[axis].high()).fold(f64::NEG_INFINITY, f64::max);
    [[low(0), low(1)], [high(0), high(1)]]
}
