//! Polyhedra by class, and points in and about them.

use super::shapes::Random;
use crate::coordinates::vectors::{minus, norm, scalar_product, vector_product};

pub type Point3 = [f64; 3];

/// A closed triangle mesh with a name.
pub struct Solid {
    pub name: &'static str,
    pub vertices: Vec<Point3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Solid {
    pub fn corners(&self, triangle: usize) -> [Point3; 3] {
        self.triangles[triangle].map(|v| self.vertices[v as usize])
    }

    pub fn diagonal(&self) -> f64 {
        let range = |k: usize| {
            let all = || self.vertices.iter().map(|v| v[k]);
            all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min)
        };
        norm([range(0), range(1), range(2)])
    }

    fn normal(&self, triangle: usize) -> Point3 {
        let [a, b, c] = self.corners(triangle);
        let normal = vector_product(minus(b, a), minus(c, a));
        normal.map(|x| x / norm(normal))
    }

    /// The winding number: the sum of solid angles (van Oosterom, Strackee 1983), in full turns.
    pub fn winding(&self, x: Point3) -> f64 {
        let angle = |triangle: usize| {
            let p = self.corners(triangle).map(|v| minus(v, x));
            let r = p.map(norm);
            let volume = scalar_product(p[0], vector_product(p[1], p[2]));
            let dot = |i: usize, j: usize| scalar_product(p[i], p[j]);
            2.0 * volume.atan2(r[0] * r[1] * r[2] + dot(0, 1) * r[2] + dot(1, 2) * r[0] + dot(2, 0) * r[1])
        };
        (0..self.triangles.len()).map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
    }

    /// Random points inside.
    pub fn inside(&self, count: usize, seed: u64) -> Vec<Point3> {
        self.inside_where(count, seed, |_| true)
    }

    /// Random points inside that keep away from the planes of all triangles.
    pub fn deep_inside(&self, count: usize) -> Vec<Point3> {
        let height = |t: usize, point: Point3| scalar_product(self.normal(t), minus(point, self.corners(t)[0])).abs();
        let is_away = |point: Point3| (0..self.triangles.len()).all(|t| height(t, point) > 0.003 * self.diagonal());
        self.inside_where(count, 31, is_away)
    }

    fn inside_where(&self, count: usize, seed: u64, is_wanted: impl Fn(Point3) -> bool) -> Vec<Point3> {
        let mut random = Random(seed);
        let mut found = Vec::new();
        for _ in 0..100_000 {
            let t = ((random.unit() * self.triangles.len() as f64) as usize).min(self.triangles.len() - 1);
            let on = mix(&self.corners(t), &[random.unit(), random.unit(), random.unit()]);
            let (normal, depth) = (self.normal(t), 0.4 * random.unit() * self.diagonal());
            let point = [0, 1, 2].map(|k| on[k] - depth * normal[k]);
            if self.winding(point) > 0.5 && is_wanted(point) {
                found.push(point);
                if found.len() == count {
                    return found;
                }
            }
        }
        panic!("{}: only {} of {count} points were found", self.name, found.len());
    }

    /// Points at a share of the diagonal behind triangles, edges and vertices.
    pub fn beside(&self, share: f64) -> Vec<Point3> {
        let mut points = Vec::new();
        let step = share * self.diagonal();
        let inwards = |on: Point3, normals: &[Point3]| {
            let sum = [0, 1, 2].map(|k| normals.iter().map(|n| n[k]).sum::<f64>());
            [0, 1, 2].map(|k| on[k] - step * sum[k] / norm(sum))
        };
        let has = |t: usize, v: u32| self.triangles[t].contains(&v);
        let count = self.triangles.len();
        for t in 0..count {
            let corners = self.corners(t);
            points.push(inwards(mix(&corners, &[0.2, 0.5, 0.3]), &[self.normal(t)]));
            let [u, v, _] = self.triangles[t];
            let both: Vec<Point3> = (0..count).filter(|&t| has(t, u) && has(t, v)).map(|t| self.normal(t)).collect();
            points.push(inwards(mix(&corners, &[0.6, 0.4, 0.0]), &both));
        }
        for v in 0..self.vertices.len() as u32 {
            let around: Vec<Point3> = (0..count).filter(|&t| has(t, v)).map(|t| self.normal(t)).collect();
            // A little aside, so that no point lies on an edge.
            let on = self.vertices[v as usize];
            let near = inwards(on, &around);
            points.push([near[0] + 0.011 * step, near[1] - 0.007 * step, near[2] + 0.003 * step]);
        }
        points
    }
}

/// The mean with weights.
pub fn mix(points: &[Point3], shares: &[f64]) -> Point3 {
    let total: f64 = shares.iter().sum();
    [0, 1, 2].map(|k| points.iter().zip(shares).map(|(p, s)| p[k] * s / total).sum())
}

pub fn cube() -> Solid {
    let vertices = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1].map(f64::from)).collect();
    let triangles = vec![
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    Solid { name: "cube", vertices, triangles }
}

pub fn octahedron() -> Solid {
    let vertices =
        vec![[1.0, 0.1, 0.0], [-1.1, 0.0, 0.2], [0.0, 1.3, 0.0], [0.1, -1.0, 0.0], [0.0, 0.0, 1.2], [0.0, 0.1, -0.9]];
    let triangles = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    Solid { name: "octahedron", vertices, triangles }
}

pub fn tetrahedron() -> Solid {
    let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.2, 0.0], [0.0, 1.0, 0.3], [0.1, 0.0, 1.0]];
    Solid { name: "tetrahedron", vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] }
}

/// With a face that is a thousand times as long as high.
pub fn needle() -> Solid {
    let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.4, 1e-3, 0.0], [0.5, 0.3, 1.0]];
    Solid { name: "needle", vertices, ..tetrahedron() }
}

/// A prism over an L: not convex, with coplanar triangles, planes of which run through the inside.
pub fn corner_box() -> Solid {
    let ring = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let vertices = [0.0, 1.0].iter().flat_map(|&z| ring.iter().map(move |p| [p[0], p[1], z])).collect();
    let cap = [[0, 1, 3], [1, 2, 3], [0, 3, 5], [3, 4, 5]];
    let mut triangles: Vec<[u32; 3]> = cap.iter().flat_map(|&[a, b, c]| [[a, c, b], [a + 6, b + 6, c + 6]]).collect();
    for i in 0..6 {
        let j = (i + 1) % 6;
        triangles.extend([[i, j, j + 6], [i, j + 6, i + 6]]);
    }
    Solid { name: "corner box", vertices, triangles }
}

/// A torus of genus 1.
pub fn torus() -> Solid {
    let (around, across) = (8, 5);
    let place = |i: u32, j: u32| {
        let (s, t) = (f64::from(i) * std::f64::consts::TAU / 8.0, f64::from(j) * std::f64::consts::TAU / 5.0);
        let r = 2.0 + 0.8 * t.cos();
        [r * s.cos(), r * s.sin(), 0.8 * t.sin()]
    };
    let number = |i: u32, j: u32| (i % around) * across + j % across;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..around {
        for j in 0..across {
            vertices.push(place(i, j));
            let (a, b, c, d) = (number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Solid { name: "torus", vertices, triangles }
}

/// An octahedron with a dent in each face.
pub fn star() -> Solid {
    let Solid { mut vertices, triangles: faces, .. } = octahedron();
    let mut triangles = Vec::new();
    for [a, b, c] in faces {
        let middle = vertices.len() as u32;
        let [p, q, r] = [a, b, c].map(|v| vertices[v as usize]);
        vertices.push([0, 1, 2].map(|k| 0.2 * (p[k] + q[k] + r[k])));
        triangles.extend([[a, b, middle], [b, c, middle], [c, a, middle]]);
    }
    Solid { name: "star", vertices, triangles }
}

/// Far from the origin and small.
pub fn far_away() -> Solid {
    let Solid { vertices, triangles, .. } = corner_box();
    let moved = |p: &Point3| [1e-2 * p[0] + 3.0, 2e-2 * p[1] - 1.0, 1e-2 * p[2]];
    Solid { name: "far away", vertices: vertices.iter().map(moved).collect(), triangles }
}

pub fn convex() -> Vec<Solid> {
    vec![cube(), octahedron(), tetrahedron()]
}

pub fn general() -> Vec<Solid> {
    vec![needle(), corner_box(), torus(), star(), far_away()]
}
