//! Splitting edges and triangles of a surface, with a record of where the new vertices are.

use super::walls::{WallError, sides_by_ends};
use std::collections::HashMap;

/// Where a new vertex is: the middle of older ones with these weights, which are positive or belong to the first again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Carrier {
    /// Vertices of the surface, or new ones before this.
    pub vertices: [u32; 3],
    /// Their weights.
    pub weights: [u32; 3],
}

impl Carrier {
    /// The point, for the points of all older vertices, rounded.
    ///
    /// ```
    /// use homeo_manifold::bundle::Carrier;
    /// let third = Carrier { vertices: [0, 1, 0], weights: [2, 1, 0] };
    /// assert_eq!(third.point(&[[0.0, 0.0, 0.0], [3.0, 0.0, 6.0]]), [1.0, 0.0, 2.0]);
    /// ```
    ///
    /// # Panics
    /// When a vertex is not among the points.
    pub fn point(&self, points: &[[f64; 3]]) -> [f64; 3] {
        let total = f64::from(self.weights.iter().sum::<u32>());
        let at = |axis: usize| -> f64 {
            self.vertices.iter().zip(self.weights).map(|(&v, w)| points[v as usize][axis] * f64::from(w)).sum()
        };
        [0, 1, 2].map(|axis| at(axis) / total)
    }
}

/// A surface while it is refined.
#[derive(Debug, Clone)]
pub(super) struct Refined {
    pub triangles: Vec<[u32; 3]>,
    /// The triangle of the original surface that each lies in.
    pub parents: Vec<u32>,
    pub vertex_count: usize,
    pub added: Vec<Carrier>,
    /// The triangle that runs along each directed edge.
    along: HashMap<[u32; 2], u32>,
}

impl Refined {
    pub(super) fn new(triangles: &[[u32; 3]], vertex_count: usize) -> Result<Self, WallError> {
        let along = sides_by_ends(triangles)?.into_iter().map(|(ends, side)| (ends, side.triangle)).collect();
        let parents = (0..triangles.len() as u32).collect();
        Ok(Self { triangles: triangles.to_vec(), parents, vertex_count, added: Vec::new(), along })
    }

    /// Splits the edges of a path of vertices until it has at least `length` edges; the path with the new vertices.
    pub(super) fn lengthened(&mut self, path: &[u32], length: usize) -> Vec<u32> {
        let edges = path.len() - 1;
        let mut longer = Vec::with_capacity(length + 1);
        for (number, step) in path.windows(2).enumerate() {
            // As evenly as possible: edge `number` gets its share of all pieces.
            let pieces = ((number + 1) * length / edges - number * length / edges).max(1) as u32;
            longer.push(step[0]);
            let mut here = step[0];
            for piece in 1..pieces {
                let carrier = Carrier { vertices: [step[0], step[1], step[0]], weights: [pieces - piece, piece, 0] };
                here = self.split_edge([here, step[1]], carrier);
                longer.push(here);
            }
        }
        longer.extend(path.last());
        longer
    }

    /// Puts a vertex onto an edge; its number.
    fn split_edge(&mut self, [from, to]: [u32; 2], carrier: Carrier) -> u32 {
        let middle = self.add_vertex(carrier);
        for [start, end] in [[from, to], [to, from]] {
            let Some(triangle) = self.along.remove(&[start, end]) else { continue };
            let corners = self.triangles[triangle as usize];
            let Some(apex) = corners.into_iter().find(|&corner| corner != start && corner != end) else { continue };
            self.replace(triangle, [start, middle, apex]);
            self.add_triangle(triangle, [middle, end, apex]);
        }
        middle
    }

    /// Puts a vertex into the middle of a triangle.
    pub(super) fn split_triangle(&mut self, triangle: u32) {
        let [a, b, c] = self.triangles[triangle as usize];
        let middle = self.add_vertex(Carrier { vertices: [a, b, c], weights: [1; 3] });
        self.replace(triangle, [a, b, middle]);
        self.add_triangle(triangle, [b, c, middle]);
        self.add_triangle(triangle, [c, a, middle]);
    }

    fn add_vertex(&mut self, carrier: Carrier) -> u32 {
        self.added.push(carrier);
        self.vertex_count += 1;
        self.vertex_count as u32 - 1
    }

    fn replace(&mut self, triangle: u32, corners: [u32; 3]) {
        self.triangles[triangle as usize] = corners;
        self.register(triangle);
    }

    fn add_triangle(&mut self, within: u32, corners: [u32; 3]) {
        self.triangles.push(corners);
        self.parents.push(self.parents[within as usize]);
        self.register(self.triangles.len() as u32 - 1);
    }

    fn register(&mut self, triangle: u32) {
        let [a, b, c] = self.triangles[triangle as usize];
        for ends in [[a, b], [b, c], [c, a]] {
            self.along.insert(ends, triangle);
        }
    }
}
