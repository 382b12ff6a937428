//! What makes enclosures narrow: chosen in doubles for each box, without influence on exact results.

use homeo_core::planar::Point2;

use super::frame::Outline;

/// A linear map near the map, which is reproduced exactly and not left to sums of enclosures, and the edge whose weight
/// dominates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guide {
    pub linear: [[f64; 2]; 2],
    /// The linear map is about this point; the vertex, in a corner.
    pub origin: Point2,
    /// And sends it here.
    pub image: Point2,
    /// The edge that is seen at the widest angle, if that is more than a right one.
    pub wide: Option<usize>,
}

impl Guide {
    /// For a box round a point; for a corner if `vertex` is given, seen from the direction of the point.
    pub fn at(outline: &Outline, point: Point2, vertex: Option<usize>, direction: Point2) -> Self {
        let wide = widest(outline, point, vertex, direction);
        let mut this = Self { linear: [[1.0, 0.0], [0.0, 1.0]], origin: point, image: point, wide };
        let weights: Vec<f64> = outline.vertices.iter().map(|v| inverse_square(*v, point).powi(2)).collect();
        let centre = |points: &[Point2]| {
            let total: f64 = weights.iter().sum();
            [0, 1].map(|k| weights.iter().zip(points).map(|(w, p)| w * p[k]).sum::<f64>() / total)
        };
        (this.origin, this.image) = match vertex {
            Some(v) => (outline.vertices[v], outline.images[v]),
            None => (centre(&outline.vertices), centre(&outline.images)),
        };
        this.fit(outline, &weights, vertex);
        let numbers = this.linear.iter().flatten().chain(&this.origin).chain(&this.image);
        if numbers.into_iter().all(|x| x.is_finite()) {
            return this;
        }
        let (origin, image) = vertex.map_or((point, point), |v| (outline.vertices[v], outline.images[v]));
        Self { linear: [[0.0; 2]; 2], origin, image, wide }
    }

    /// Least squares, with a little of the identity where vertices are almost in line.
    fn fit(&mut self, outline: &Outline, weights: &[f64], vertex: Option<usize>) {
        let (mut normal, mut mixed) = ([[0.0; 2]; 2], [[0.0; 2]; 2]);
        for (i, weight) in weights.iter().enumerate().filter(|(i, _)| Some(*i) != vertex) {
            for k in 0..2 {
                let from = outline.vertices[i][k] - self.origin[k];
                for l in 0..2 {
                    normal[l][k] += weight * from * (outline.vertices[i][l] - self.origin[l]);
                    mixed[l][k] += weight * from * (outline.images[i][l] - self.image[l]);
                }
            }
        }
        let ridge = 1e-6 * (normal[0][0] + normal[1][1]);
        for k in 0..2 {
            normal[k][k] += ridge;
            mixed[k][k] += ridge;
        }
        let [[a, b], [_, d]] = normal;
        let determinant = a * d - b * b;
        self.linear = mixed.map(|[x, y]| [(x * d - y * b) / determinant, (y * a - x * b) / determinant]);
    }
}

fn inverse_square(a: Point2, b: Point2) -> f64 {
    let (x, y) = (a[0] - b[0], a[1] - b[1]);
    1.0 / (x * x + y * y)
}

/// The edge with the widest angle, if more than a right one. A corner's own vertex is seen against `direction`.
fn widest(outline: &Outline, point: Point2, vertex: Option<usize>, direction: Point2) -> Option<usize> {
    let unit = |i: usize| {
        let v = outline.vertices[i];
        let offset = if vertex == Some(i) { direction.map(|c| -c) } else { [v[0] - point[0], v[1] - point[1]] };
        let length = offset[0].hypot(offset[1]);
        offset.map(|c| c / length)
    };
    let mut best = (0.0, None);
    for i in 0..outline.count() {
        let (u, v) = (unit(i), unit(outline.next[i]));
        let cosine = u[0] * v[0] + u[1] * v[1];
        if cosine < best.0 {
            best = (cosine, Some(i));
        }
    }
    best.1
}
