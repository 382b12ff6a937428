//! What makes enclosures narrow: chosen in doubles for each box, without influence on exact results.

use homeo_core::planar::Point2;

use super::chart::Touch;
use super::frame::Frame;
use super::number::Ball;
use super::vector::dot;

/// A box is bounded in the plane if it is not larger than this part of its distance from the apex, by each coordinate.
const OFF_APEX: f64 = 0.15;
/// The distance of the nearest vertex is factored out if its square is less than this part of that of the next one: where
/// no weight dominates, a factor only widens.
const MUCH_NEARER: f64 = 0.4;

/// A linear map near the map: what of it is reproduced exactly is not left to sums of enclosures.
pub(super) type Linear = [[f64; 2]; 2];

/// What makes enclosures narrow; nothing depends on it in exact arithmetic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guide {
    /// A linear map that takes vertices nearby close to their images,
    pub linear: Linear,
    /// after which one goes by so much further: nothing, if the apex is a vertex.
    pub shift: Point2,
    /// Whether the box is so far from the apex that it is bounded by gradients in the plane, if that is a vertex too.
    pub is_off_apex: bool,
    /// The edge, by its first vertex, that is seen at the largest angle, if more than a right one: its weight dominates,
    /// and is factored out.
    pub near_edge: Option<usize>,
    /// The nearest vertex but `v`, if it is by far: its distance is factored out as well.
    pub near_vertex: Option<usize>,
    /// How near the nearest vertex is.
    pub nearest: f64,
}

impl Guide {
    /// No help.
    pub const NONE: Self = Self {
        linear: [[1.0, 0.0], [0.0, 1.0]],
        shift: [0.0; 2],
        is_off_apex: false,
        near_edge: None,
        near_vertex: None,
        nearest: 1.0,
    };
}

impl Frame<'_, Ball> {
    /// A guide for a box of the chart.
    pub fn guide(&self, s_ball: Ball, lambda_ball: Ball) -> Guide {
        let (s, lambda) = (s_ball.middle, lambda_ball.middle);
        let is_off_apex = s_ball.radius < OFF_APEX * s && self.axes_turned(lambda_ball) < OFF_APEX;
        let axis = |axis: usize, k: usize| self.axes[axis][k].middle;
        let at: Point2 = std::array::from_fn(|k| s * (axis(0, k) + lambda * axis(1, k)));
        let there = |i: usize| -> Point2 { std::array::from_fn(|k| self.offsets[i][0][k].middle - at[k]) };
        let (linear, shift, near_vertex, nearest) = self.fit(at, is_off_apex);
        let mut near = (0.0, None);
        for i in 0..self.offsets.len() {
            let k = self.step.next[i] as usize;
            let (a, b) = (there(i), there(k));
            let product = dot(a, b);
            if product < 0.0 {
                let square = product * product / (dot(a, a) * dot(b, b));
                let is_touched = match self.chart.touch {
                    Touch::Nothing => false,
                    touch => self.edge_at_vertex(touch) == i,
                };
                if square > near.0 && (is_off_apex || !is_touched) {
                    near = (square, Some(i));
                }
            }
        }
        Guide { linear, shift, is_off_apex, near_edge: near.1, near_vertex, nearest }
    }

    /// How far `e` is from its middle, in lengths of it.
    fn axes_turned(&self, lambda: Ball) -> f64 {
        let [from, across] = self.axes.map(|axis| axis.map(|c| c.middle));
        let length = (from[0] + lambda.middle * across[0]).hypot(from[1] + lambda.middle * across[1]);
        across[0].hypot(across[1]) * lambda.radius / length
    }

    /// A linear map that takes vertices near a point close to their images, what it is shifted by, and which vertex but `v`
    /// is nearest, and how near. Least squares, weighted by the inverse fourth power of distances.
    fn fit(&self, at: Point2, is_off_apex: bool) -> (Linear, Point2, Option<usize>, f64) {
        let v = (!is_off_apex).then_some(self.chart.corners[0] as usize);
        let (mut nearest, mut second) = ((f64::INFINITY, None), f64::INFINITY);
        let mut moments = Moments::default();
        for (i, &[offset, image]) in self.offsets.iter().enumerate() {
            if v == Some(i) {
                continue;
            }
            let (offset, image) = (offset.map(|c| c.middle), image.map(|c| c.middle));
            let (x, y) = (offset[0] - at[0], offset[1] - at[1]);
            let square = x * x + y * y;
            second = second.min(square.max(nearest.0));
            if square < nearest.0 {
                nearest = (square, Some(i));
            }
            moments.add(1.0 / (square * square), offset, image);
        }
        let (linear, shift) = moments.solve(is_off_apex || !self.step.is_vertex(self.chart.corners[0]));
        (linear, shift, nearest.1.filter(|_| nearest.0 < MUCH_NEARER * second), nearest.0.sqrt())
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
