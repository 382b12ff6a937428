//! What makes enclosures narrow: chosen in doubles for each box, without influence on exact results.

use homeo_core::planar::Point2;

use super::frame::Frame;
use super::number::Form;

/// A linear map near the map: what of it is reproduced exactly is not left to sums of enclosures.
pub(crate) type Linear = [[f64; 2]; 2];

/// What makes enclosures narrow; nothing depends on it in exact arithmetic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Guide {
    /// A linear map that takes vertices nearby close to their images,
    pub linear: Linear,
    /// after which one goes by so much further: nothing, if the apex is a vertex.
    pub shift: Point2,
    /// How near the nearest vertex but the apex is.
    pub nearest: f64,
}

impl Guide {
    /// No help.
    pub const NONE: Self = Self { linear: [[1.0, 0.0], [0.0, 1.0]], shift: [0.0; 2], nearest: 1.0 };
}

impl Frame<'_, Form> {
    /// A guide for a box round a point of the chart: least squares, weighted by the inverse fourth power of distances.
    pub fn guide(&self, s: f64, lambda: f64) -> Guide {
        let axis = |axis: usize, k: usize| self.axes[axis][k].middle;
        let at: Point2 = std::array::from_fn(|k| s * (axis(0, k) + lambda * axis(1, k)));
        let apex = self.apex();
        let mut nearest = f64::INFINITY;
        let mut moments = Moments::default();
        for (i, &[offset, image]) in self.offsets.iter().enumerate() {
            if apex == Some(i) {
                continue;
            }
            let (offset, image) = (offset.map(|c| c.middle), image.map(|c| c.middle));
            let (x, y) = (offset[0] - at[0], offset[1] - at[1]);
            let square = x * x + y * y;
            nearest = nearest.min(square);
            moments.add(1.0 / (square * square), offset, image);
        }
        let (linear, shift) = moments.solve(apex.is_none());
        Guide { linear, shift, nearest: nearest.sqrt() }
    }
}

/// Weighted sums of points and images, and of their products.
#[derive(Default)]
struct Moments {
    weight: f64,
    points: Point2,
    images: Point2,
    /// `x x`, `x y` and `y y` of points.
    normal: [f64; 3],
    /// Rows of products of one coordinate of images.
    mixed: [Point2; 2],
}

impl Moments {
    fn add(&mut self, weight: f64, [x, y]: Point2, image: Point2) {
        let (wx, wy) = (weight * x, weight * y);
        self.weight += weight;
        self.points = [self.points[0] + wx, self.points[1] + wy];
        self.normal = [self.normal[0] + wx * x, self.normal[1] + wx * y, self.normal[2] + wy * y];
        for k in 0..2 {
            self.images[k] += weight * image[k];
            self.mixed[k] = [self.mixed[k][0] + image[k] * wx, self.mixed[k][1] + image[k] * wy];
        }
    }

    /// The same round the mean of all points.
    fn centred(mut self) -> Self {
        let [x, y] = self.points;
        let products = [x * x, x * y, y * y];
        self.normal = std::array::from_fn(|k| self.normal[k] - products[k] / self.weight);
        for k in 0..2 {
            let image = self.images[k] / self.weight;
            self.mixed[k] = [self.mixed[k][0] - image * x, self.mixed[k][1] - image * y];
        }
        self
    }

    /// The linear map, and its shift if it may have one.
    fn solve(self, may_shift: bool) -> (Linear, Point2) {
        let Self { normal, mut mixed, weight, points, images } = if may_shift { self.centred() } else { self };
        // A little of the identity, where vertices are almost in line.
        let ridge = 1e-6 * (normal[0] + normal[2]);
        let [a, b, c] = [normal[0] + ridge, normal[1], normal[2] + ridge];
        mixed[0][0] += ridge;
        mixed[1][1] += ridge;
        let determinant = a * c - b * b;
        let row = |m: [f64; 2]| [(m[0] * c - m[1] * b) / determinant, (m[1] * a - m[0] * b) / determinant];
        let linear = mixed.map(row);
        let shift: Point2 =
            std::array::from_fn(|k| (images[k] - linear[k][0] * points[0] - linear[k][1] * points[1]) / weight);
        if !linear.iter().flatten().chain(&shift).all(|x| x.is_finite()) {
            return (Guide::NONE.linear, [0.0; 2]);
        }
        (linear, if may_shift { shift } else { [0.0; 2] })
    }
}
