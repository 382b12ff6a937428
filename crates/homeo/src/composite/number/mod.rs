//! Numbers that a chart is evaluated with: doubles, and forms that hold the exact result over a box.

mod form;

use std::ops::{Add, Div, Mul, Sub};

pub(crate) use form::Form;

/// What the formulas of a chart need: the four operations, lengths, and what is seen of vertices and edges.
pub(crate) trait Number:
    Copy + Send + Sync + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// A stored number, exactly.
    fn of(value: f64) -> Self;
    /// A number that is known by an enclosure.
    fn of_form(value: Form) -> Self;
    /// The product with a stored number.
    fn by(self, factor: f64) -> Self;
    /// The product with a number that does not depend on where in the box the point is.
    fn times_constant(self, constant: Self) -> Self;
    /// Its opposite.
    fn opposite(self) -> Self;
    /// Length of a vector.
    fn length(x: Self, y: Self) -> Self;
    /// How a point moves over the box.
    fn motion(point: [Self; 2]) -> Motion;
    /// What is seen of a vertex that lies by `vector`, not zero, from a point with this motion.
    fn sight(vector: [Self; 2], motion: &Motion) -> Sight<Self>;
    /// What is seen of the edge from one vertex to another, neither of which moves.
    fn swing(from: &Sight<Self>, to: &Sight<Self>, edge: &Edge<Self>, motion: &Motion) -> Swing<Self>;
    /// `tan(α / 2)` of the angle of an edge.
    fn half_tangent(from: &Sight<Self>, to: &Sight<Self>, swing: &Swing<Self>) -> Self;
    /// A number that is not smaller.
    fn most(self) -> f64;
    /// A number near it, by which one of two equal formulas is chosen.
    fn near(self) -> f64;
}

/// How a point moves over a box: linearly, and by a rest.
#[derive(Clone, Copy, Default)]
pub(crate) struct Motion {
    /// Along each coordinate of the box, from its middle to its end.
    pub slopes: [[f64; 2]; 2],
    /// By how much more, in each coordinate of the plane.
    pub rest: [f64; 2],
    /// No less than the length of that.
    pub rest_length: f64,
    /// It is no further from where it is in the middle than this.
    pub reach: f64,
}

/// What of a vertex is seen from a point.
#[derive(Clone, Copy)]
pub(crate) struct Sight<T> {
    /// Unit vector towards it.
    pub unit: [T; 2],
    /// One over its distance.
    pub inverse: T,
    /// The product of both: the gradient of `log (1 / distance)`; turned by a right angle, that of the direction.
    pub pull: [T; 2],
    /// By how large an angle its direction may be off for other reasons than where the point is.
    pub slack: f64,
    /// The distance is at least this part of that in the middle of the box.
    pub left: f64,
}

/// An edge between two vertices.
#[derive(Clone, Copy)]
pub(crate) struct Edge<T> {
    /// Its vector, reversed and conjugated.
    pub vector: [T; 2],
    /// No less than its length.
    pub length: f64,
}

/// What of an edge is seen from a point.
#[derive(Clone, Copy)]
pub(crate) struct Swing<T> {
    /// The difference of the pulls of its ends: turned back by a right angle, the gradient of its angle.
    pub pull: [T; 2],
    /// By how much its angle differs from the one in the middle of the box.
    pub angle: T,
}

/// `tan(α / 2)` of the angle from one unit vector to another, by that of two equal formulas whose divisor is not small.
#[inline(always)]
pub(crate) fn half_tangent<T: Number>(from: [T; 2], to: [T; 2]) -> T {
    let (sine, cosine) = (from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
    let one = T::of(1.0);
    if cosine.near() < 0.0 { (one - cosine) / sine } else { sine / (one + cosine) }
}

/// The product of complex numbers.
#[inline(always)]
pub(crate) fn times<T: Number>(a: [T; 2], b: [T; 2]) -> [T; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

impl Number for f64 {
    fn of(value: f64) -> Self {
        value
    }
    fn of_form(value: Form) -> Self {
        value.middle
    }
    fn by(self, factor: f64) -> Self {
        self * factor
    }
    fn times_constant(self, constant: Self) -> Self {
        self * constant
    }
    fn opposite(self) -> Self {
        -self
    }
    fn length(x: Self, y: Self) -> Self {
        (x * x + y * y).sqrt()
    }
    fn motion(_: [Self; 2]) -> Motion {
        Motion::default()
    }
    fn sight([x, y]: [Self; 2], _: &Motion) -> Sight<Self> {
        let inverse = 1.0 / Self::length(x, y);
        let unit = [x * inverse, y * inverse];
        Sight { unit, inverse, pull: unit.map(|c| c * inverse), slack: 0.0, left: 1.0 }
    }
    #[inline(always)]
    fn swing(from: &Sight<Self>, to: &Sight<Self>, edge: &Edge<Self>, _: &Motion) -> Swing<Self> {
        // As a product: far edges are seen to be small.
        Swing { pull: times(times(from.pull, to.pull), edge.vector), angle: 0.0 }
    }
    #[inline(always)]
    fn half_tangent(from: &Sight<Self>, to: &Sight<Self>, _: &Swing<Self>) -> Self {
        half_tangent(from.unit, to.unit)
    }
    fn most(self) -> f64 {
        self
    }
    fn near(self) -> f64 {
        self
    }
}
