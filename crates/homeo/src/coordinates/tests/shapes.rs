//! Domains by class, and points in them.

use homeo_core::planar::{PlanarDomain, Point2};

/// Numbers from a fixed seed (xorshift).
pub struct Random(pub u64);

impl Random {
    /// A number between 0 and 1.
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

pub fn domain(rings: Vec<Vec<Point2>>) -> PlanarDomain {
    PlanarDomain::new(rings).unwrap()
}

/// Points on an ellipse, turned; strictly convex.
pub fn ellipse(n: usize, long: f64, short: f64, turn: f64, seed: u64) -> Vec<Point2> {
    let mut random = Random(seed);
    let place = |i: usize| {
        let t = (i as f64 + 0.7 * random.unit()) * std::f64::consts::TAU / n as f64;
        let (x, y) = (long * t.cos(), short * t.sin());
        [x * turn.cos() - y * turn.sin(), x * turn.sin() + y * turn.cos()]
    };
    (0..n).map(place).collect()
}

/// Strictly convex polygons.
pub fn convex() -> Vec<(&'static str, PlanarDomain)> {
    vec![
        ("square", domain(vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]])),
        ("triangle", domain(vec![vec![[0.1, 0.2], [3.3, -0.4], [1.7, 2.9]]])),
        ("pentagon", domain(vec![ellipse(5, 1.0, 0.8, 0.3, 7)])),
        ("flat octagon", domain(vec![ellipse(8, 30.0, 2.0, 1.1, 11)])),
        (
            "far away",
            domain(vec![ellipse(7, 2.0, 1.5, 0.2, 5).iter().map(|p| [p[0] + 1000.0, p[1] - 300.0]).collect()]),
        ),
        ("twenty", domain(vec![ellipse(20, 1e-3, 7e-4, 0.5, 13)])),
        (
            "nearly coincident",
            domain(vec![vec![[0.0, 0.0], [1.0, 0.0], [1.3, 0.6], [1.3 - 4e-10, 0.6 + 9e-10], [0.4, 1.2]]]),
        ),
    ]
}

/// Polygons that are not strictly convex, and such with holes.
pub fn general() -> Vec<(&'static str, PlanarDomain)> {
    let square = |r: f64| vec![[-r, -r], [r, -r], [r, r], [-r, r]];
    let clockwise = |mut ring: Vec<Point2>| {
        ring.reverse();
        ring
    };
    let star = (0..12).map(|i| {
        let (t, r) = (i as f64 * std::f64::consts::TAU / 12.0, if i % 2 == 0 { 1.0 } else { 0.45 });
        [r * t.cos(), r * t.sin()]
    });
    vec![
        (
            "collinear",
            domain(vec![vec![[0.0, 0.0], [0.3, 0.0], [1.0, 0.0], [1.0, 0.5], [1.0, 1.0], [0.5, 1.0], [0.0, 1.0]]]),
        ),
        ("corner", domain(vec![vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.1], [0.9, 2.0], [0.0, 2.0]]])),
        ("star", domain(vec![star.collect()])),
        (
            "comb",
            domain(vec![vec![
                [0.0, 0.0],
                [5.0, 0.0],
                [5.0, 3.0],
                [4.0, 3.1],
                [4.1, 1.0],
                [3.0, 1.1],
                [2.9, 3.0],
                [2.0, 3.0],
                [2.1, 1.2],
                [1.0, 1.0],
                [0.9, 3.0],
                [0.0, 3.1],
            ]]),
        ),
        (
            "close dent",
            domain(vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5 + 1e-9, 0.4], [0.5, 0.4], [0.0, 1.0]]]),
        ),
        ("ring", domain(vec![square(3.0), clockwise(square(1.0))])),
        (
            "two holes",
            domain(vec![
                ellipse(9, 4.0, 3.0, 0.1, 3),
                clockwise(vec![[-2.0, -0.5], [-1.0, -0.4], [-1.3, 0.7]]),
                clockwise(vec![[1.0, 0.0], [1.8, -0.3], [1.5, 0.8], [1.5 - 1e-9, 0.8]]),
            ]),
        ),
    ]
}

/// Points inside, anywhere.
pub fn inside(domain: &PlanarDomain, count: usize) -> Vec<Point2> {
    let mut random = Random(42);
    let [low, high] = domain.bounds();
    let mut points = Vec::new();
    while points.len() < count {
        let point = [0, 1].map(|k| low[k] + (high[k] - low[k]) * random.unit());
        if domain.contains(point) {
            points.push(point);
        }
    }
    points
}

/// Points that are `share` of the diagonal from edges.
pub fn near_edges(domain: &PlanarDomain, share: f64) -> Vec<Point2> {
    let step = share * domain.diagonal();
    let along = |[a, b]: [Point2; 2]| {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let normal = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
        [0.03, 0.37, 0.81].map(|u| [0, 1].map(|k| a[k] + u * (b[k] - a[k]) + step * normal[k]))
    };
    domain.edges().flat_map(along).filter(|&p| domain.contains(p)).collect()
}

/// Points that are `share` of the diagonal from vertices, in directions inside.
pub fn near_vertices(domain: &PlanarDomain, share: f64) -> Vec<Point2> {
    let step = share * domain.diagonal();
    let round = |v: Point2| {
        (0..8).map(move |i| 0.1 + 0.8 * i as f64).map(move |t| [v[0] + step * t.cos(), v[1] + step * t.sin()])
    };
    domain.vertices().flat_map(round).filter(|&p| domain.contains(p)).collect()
}
