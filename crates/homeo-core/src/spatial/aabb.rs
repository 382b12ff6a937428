//! A box with sides along the axes.

/// A closed box, given by its lowest and its highest corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Lowest coordinates.
    pub low: [f64; 3],
    /// Highest coordinates.
    pub high: [f64; 3],
}

impl Aabb {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };

    /// The smallest box that holds all `points`.
    ///
    /// ```
    /// use homeo_core::spatial::Aabb;
    /// let hull = Aabb::of(&[[0.0, 1.0, 2.0], [3.0, -1.0, 2.0]]);
    /// assert_eq!(hull, Aabb { low: [0.0, -1.0, 2.0], high: [3.0, 1.0, 2.0] });
    /// ```
    #[inline]
    pub fn of(points: &[[f64; 3]]) -> Self {
        points.iter().fold(Self::EMPTY, |hull, &point| hull.joined(&Self { low: point, high: point }))
    }

    /// The smallest box that holds both.
    #[inline]
    pub fn joined(&self, other: &Self) -> Self {
        let mut hull = *self;
        for axis in 0..3 {
            hull.low[axis] = hull.low[axis].min(other.low[axis]);
            hull.high[axis] = hull.high[axis].max(other.high[axis]);
        }
        hull
    }

    /// Whether the two boxes share a point; touching counts.
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        // All comparisons are made: which one fails cannot be predicted, and trees ask millions of times.
        (0..3).fold(true, |meets, axis| {
            meets & (self.low[axis] <= other.high[axis]) & (other.low[axis] <= self.high[axis])
        })
    }

    /// Whether the point lies in the box; its surface counts.
    #[inline]
    pub fn contains(&self, point: [f64; 3]) -> bool {
        (0..3).all(|axis| self.low[axis] <= point[axis] && point[axis] <= self.high[axis])
    }

    /// Whether `other` lies in the interior of this box.
    pub fn surrounds(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.low[axis] < other.low[axis] && other.high[axis] < self.high[axis])
    }

    /// Twice the centre, rounded; only ever used to order boxes.
    #[inline]
    pub(super) fn doubled_centre(&self, axis: usize) -> f64 {
        self.low[axis] + self.high[axis]
    }
}
