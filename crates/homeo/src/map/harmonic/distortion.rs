//! How much a composite harmonic map distorts.

use homeo_core::planar::Point2;

use super::HarmonicMap;
use super::half::Side;
use super::walk::Walk;

/// A two by two matrix, row by row.
pub(crate) type Matrix = [[f64; 2]; 2];

/// What distortion is, by the singular values `s1 >= s2` of the Jacobian.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Distortion {
    /// `s1 / s2 + s2 / s1`: 2 where angles are kept, whatever the size (Hormann, Greiner 2000).
    #[default]
    Conformal,
    /// `max(s1, 1 / s2)`: 1 where lengths are kept (Sorkine et al. 2002).
    Isometric,
}

/// Mean and maximum of a distortion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistortionSummary {
    /// Mean over the source, by area.
    pub mean: f64,
    /// The largest.
    pub largest: f64,
}

impl Distortion {
    /// Of a Jacobian, rows `[df/dx, df/dy]`; infinite where it does not keep orientation.
    ///
    /// ```
    /// use homeo::map::Distortion::{Conformal, Isometric};
    /// let stretched = [[2.0, 0.0], [0.0, 1.0]];
    /// assert_eq!([Conformal.of(stretched), Isometric.of(stretched)], [2.5, 2.0]);
    /// assert_eq!(Conformal.of([[-1.0, 0.0], [0.0, 1.0]]), f64::INFINITY);
    /// ```
    pub fn of(self, jacobian: Matrix) -> f64 {
        let [[a, b], [c, d]] = jacobian;
        let determinant = a * d - b * c;
        if determinant <= 0.0 || determinant.is_nan() {
            return f64::INFINITY;
        }
        match self {
            Self::Conformal => (a * a + b * b + c * c + d * d) / determinant,
            Self::Isometric => {
                let largest = largest_singular_value(jacobian);
                largest.max(largest / determinant)
            }
        }
    }

    /// Its derivatives by the entries of a Jacobian that keeps orientation; of the larger part where it is a maximum.
    pub(crate) fn gradient(self, jacobian: Matrix) -> Matrix {
        let [[a, b], [c, d]] = jacobian;
        let determinant = a * d - b * c;
        let cofactors = [[d, -c], [-b, a]];
        let combine =
            |x: f64, first: Matrix, y: f64| [0, 1].map(|i| [0, 1].map(|j| x * first[i][j] + y * cofactors[i][j]));
        match self {
            Self::Conformal => {
                let squares = a * a + b * b + c * c + d * d;
                combine(2.0 / determinant, jacobian, -squares / (determinant * determinant))
            }
            Self::Isometric => {
                let largest = largest_singular_value(jacobian);
                let steepest = gradient_of_largest(jacobian);
                match determinant >= 1.0 {
                    true => steepest,
                    false => combine(1.0 / determinant, steepest, -largest / (determinant * determinant)),
                }
            }
        }
    }
}

/// Half sums of what turns and of what mirrors: their lengths add up to the larger singular value.
fn parts([[a, b], [c, d]]: Matrix) -> [[f64; 2]; 2] {
    [[0.5 * (a + d), 0.5 * (c - b)], [0.5 * (a - d), 0.5 * (c + b)]]
}

fn largest_singular_value(jacobian: Matrix) -> f64 {
    parts(jacobian).iter().map(|[x, y]| x.hypot(*y)).sum()
}

fn gradient_of_largest(jacobian: Matrix) -> Matrix {
    let [turn, mirror] = parts(jacobian).map(|[x, y]| {
        let size = x.hypot(y);
        if size > 0.0 { [0.5 * x / size, 0.5 * y / size] } else { [0.0; 2] }
    });
    [[turn[0] + mirror[0], mirror[1] - turn[1]], [turn[1] + mirror[1], turn[0] - mirror[0]]]
}

/// The matrix of the sides of a triangle from its first corner, as columns.
pub(crate) fn sides([a, b, c]: [Point2; 3]) -> Matrix {
    [0, 1].map(|axis| [b[axis] - a[axis], c[axis] - a[axis]])
}

pub(crate) fn determinant([[a, b], [c, d]]: Matrix) -> f64 {
    a * d - b * c
}

pub(crate) fn inverse(matrix: Matrix) -> Matrix {
    let ([[a, b], [c, d]], scale) = (matrix, 1.0 / determinant(matrix));
    [[d * scale, -b * scale], [-c * scale, a * scale]]
}

pub(crate) fn product(a: Matrix, b: Matrix) -> Matrix {
    [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

pub(crate) fn transposed([[a, b], [c, d]]: Matrix) -> Matrix {
    [[a, c], [b, d]]
}

impl HarmonicMap {
    /// Mean and maximum of a distortion, in floating point: each triangle of the source is taken at its centroid, with
    /// its area. A sampled figure: the target's triangles divide those of the source further.
    ///
    /// ```
    /// use homeo::construct::harmonic::{HarmonicParams, harmonic_map};
    /// use homeo::{map::Distortion, progress::Silent};
    /// use homeo_core::planar::DomainPair;
    /// let square = |s: f64| vec![vec![[0.0, 0.0], [s, 0.0], [s, s], [0.0, s]]];
    /// let pair = DomainPair::new(square(1.0), square(2.0)).unwrap();
    /// let map = harmonic_map(&pair, HarmonicParams { triangles: 100, ..HarmonicParams::default() }, &Silent).unwrap();
    /// assert!((map.distortion(Distortion::Conformal).mean - 2.0).abs() < 1e-9);
    /// assert!((map.distortion(Distortion::Isometric).largest - 2.0).abs() < 1e-9);
    /// ```
    pub fn distortion(&self, kind: Distortion) -> DistortionSummary {
        let mut walk = Walk::new(&self.target, Side::Image);
        let (mut sum, mut total, mut largest) = (0.0, 0.0, 0.0f64);
        for t in 0..self.source.parts().triangles.len() {
            let (here, image) = (self.source.rounded(Side::Domain, t), self.source.rounded(Side::Image, t));
            let centroid = [0, 1].map(|axis| image.iter().map(|p| p[axis]).sum::<f64>() / 3.0);
            let area = determinant(sides(here));
            // Rounding may leave a point on the boundary of the middle outside all triangles.
            let Some(found) = walk.find(centroid) else { continue };
            let to = self.target.rounded(Side::Domain, found);
            let from = self.target.rounded(Side::Image, found);
            let first = product(sides(image), inverse(sides(here)));
            let value = kind.of(product(product(sides(to), inverse(sides(from))), first));
            sum += area * value;
            total += area;
            largest = largest.max(value);
        }
        DistortionSummary { mean: sum / total, largest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_are_derivatives() {
        let mut tried = 0;
        for kind in [Distortion::Conformal, Distortion::Isometric] {
            for jacobian in [[[1.3, 0.4], [-0.2, 0.9]], [[0.5, 0.1], [0.3, 0.8]], [[3.0, -1.0], [2.0, 2.5]]] {
                let gradient = kind.gradient(jacobian);
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let at = |step: f64| {
                        let mut moved = jacobian;
                        moved[i][j] += step;
                        kind.of(moved)
                    };
                    let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
                    assert!((slope - gradient[i][j]).abs() < 1e-7, "{kind:?} {jacobian:?} {i} {j}: {slope}");
                    tried += 1;
                }
            }
        }
        assert_eq!(tried, 24);
    }
}
