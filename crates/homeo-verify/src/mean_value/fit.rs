//! What makes enclosures narrow: an affine map that is taken off, chosen in doubles, without influence on exact results.

use super::{Form, Frame, Point2, Vector, vector};

/// An affine map near the mean value map, by doubles: what it misses of the images is little.
#[derive(Clone, Copy)]
pub(super) struct Fit {
    pub(super) matrix: [Point2; 2],
    /// Zero at a vertex, which goes to its image.
    pub(super) shift: Point2,
}

impl Fit {
    /// What it does to a vector.
    pub(super) fn apply(&self, v: Vector) -> Vector {
        vector(|k| Form::exact(self.matrix[k][0]) * v[0] + Form::exact(self.matrix[k][1]) * v[1])
    }
}

impl Frame<'_> {
    /// An affine map that takes the vertices near a point close to their images, by least squares with the inverse fourth
    /// powers of distances as weights; and how near the nearest vertex is.
    pub(super) fn fit(&self, at: Point2) -> (Fit, f64) {
        let apex = self.is_at_vertex.then_some(self.chart.apex as usize);
        let weighted = || {
            let others = self.offsets.iter().enumerate().filter(|(i, _)| apex != Some(*i));
            others.map(|(_, offset)| {
                let [p, q] = offset.map(|vector| vector.map(|x| x.middle));
                let square = (p[0] - at[0]).powi(2) + (p[1] - at[1]).powi(2);
                (1.0 / (square * square), square, p, q)
            })
        };
        let (mut total, mut means, mut nearest) = (0.0, [[0.0; 2]; 2], f64::INFINITY);
        for (weight, square, p, q) in weighted() {
            total += weight;
            (0..2)
                .for_each(|k| (means[0][k], means[1][k]) = (means[0][k] + weight * p[k], means[1][k] + weight * q[k]));
            nearest = square.min(nearest);
        }
        let [p0, q0] = means.map(|sum| sum.map(|x| if self.is_at_vertex { 0.0 } else { x / total }));
        let (mut normal, mut mixed) = ([0.0; 3], [[0.0; 2]; 2]);
        for (weight, _, p, q) in weighted() {
            let [x, y] = [p[0] - p0[0], p[1] - p0[1]];
            let products = [x * x, x * y, y * y];
            (0..3).for_each(|k| normal[k] += weight * products[k]);
            (0..2).for_each(|k| {
                let to = weight * (q[k] - q0[k]);
                mixed[k] = [mixed[k][0] + to * x, mixed[k][1] + to * y];
            });
        }
        // A little of the identity, where vertices are almost in line.
        let ridge = 1e-6 * (normal[0] + normal[2]);
        let [a, b, c] = [normal[0] + ridge, normal[1], normal[2] + ridge];
        (0..2).for_each(|k| mixed[k][k] += ridge);
        let matrix = mixed.map(|[x, y]| [x * c - y * b, y * a - x * b].map(|m| m / (a * c - b * b)));
        let shift = [0, 1].map(|k| q0[k] - matrix[k][0] * p0[0] - matrix[k][1] * p0[1]);
        let fit = Fit { matrix, shift };
        let is_finite = matrix.iter().flatten().chain(&shift).all(|x| x.is_finite());
        (if is_finite { fit } else { Fit { matrix: [[1.0, 0.0], [0.0, 1.0]], shift: [0.0; 2] } }, nearest.sqrt())
    }
}
