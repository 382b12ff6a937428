//! Mean value coordinates of many points, fast.
//!
//! Edge `i` adds `t_i / r_i` to the weight of its first end and `t_i / r_{i+1}` to that of the second. With
//! `t_i = N / D`, both are a product with `N / (D r_i r_{i+1})`: one division for an edge, one root for a vertex. Four
//! points are done at a time, in arrays that the compiler turns into vector registers; what a point gets does not depend
//! on its company. Where an edge is seen under nearly a half turn the point is done again, with care.

use rayon::prelude::*;

use super::mean_value::MeanValue;
use super::weighted::{self, Weighted, check_length};
use super::{CoordinateError, PlanarCoordinates};

/// How many points are done together.
const LANES: usize = 4;

/// Points given to a thread at a time.
const BLOCK: usize = 1024;

/// Tangents of half angles above this lose too many digits here: an error of `256 eps`.
const GREATEST_TANGENT: f64 = 256.0;

type Lanes = [f64; LANES];

/// What vertices are as seen from each of the points.
#[derive(Clone, Copy)]
struct Seen {
    x: Lanes,
    y: Lanes,
    r: Lanes,
}

impl MeanValue {
    /// Sums `sum_i phi_i(x) data_i` at many points: a map where `data` (#V by 2) are images of the vertices. Coordinates
    /// are not stored. Runs on all threads of the pool; the result is the same on any number.
    ///
    /// # Errors
    /// `data` has not one row for each vertex; a point is not finite.
    ///
    /// # Complexity
    /// Linear in #V for each point.
    ///
    /// ```
    /// use homeo::coordinates::MeanValue;
    /// use homeo_core::planar::PlanarDomain;
    /// let triangle = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    /// let kind = MeanValue::new(&PlanarDomain::new(vec![triangle])?);
    /// let images = kind.apply(&[[0.25, 0.25]], &[[0.0, 0.0], [4.0, 0.0], [0.0, 8.0]])?;
    /// assert!((images[0][0] - 1.0).abs() < 1e-14 && (images[0][1] - 2.0).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn apply<const K: usize>(
        &self,
        points: &[[f64; 2]],
        data: &[[f64; K]],
    ) -> Result<Vec<[f64; K]>, CoordinateError> {
        check_length(self.vertex_count(), data.len())?;
        let mut images = vec![[0.0; K]; points.len()];
        points.par_chunks(BLOCK).zip(images.par_chunks_mut(BLOCK)).try_for_each(|(points, images)| {
            points.chunks(LANES).zip(images.chunks_mut(LANES)).try_for_each(|(p, i)| self.apply_to_lanes(p, data, i))
        })?;
        Ok(images)
    }

    /// Coordinates of many points (#points by #V), row after row. Runs on all threads of the pool.
    ///
    /// # Errors
    /// `values` has not #points times #V entries; a point is not finite.
    ///
    /// # Complexity
    /// Linear in #V for each point.
    pub fn values_of_many(&self, points: &[[f64; 2]], values: &mut [f64]) -> Result<(), CoordinateError> {
        let n = self.vertex_count();
        check_length(n * points.len(), values.len())?;
        points.par_chunks(BLOCK).zip(values.par_chunks_mut(BLOCK * n)).try_for_each(|(points, values)| {
            let mut weights = vec![[0.0; LANES]; n];
            let mut pairs = points.chunks(LANES).zip(values.chunks_mut(LANES * n));
            pairs.try_for_each(|(p, v)| self.values_of_lanes(p, &mut weights, v))
        })
    }

    fn apply_to_lanes<const K: usize>(
        &self,
        points: &[[f64; 2]],
        data: &[[f64; K]],
        images: &mut [[f64; K]],
    ) -> Result<(), CoordinateError> {
        let [x, y] = self.lanes(points)?;
        let (mut total, mut sums, mut widest) = ([0.0; LANES], [[0.0; LANES]; K], [0.0; LANES]);
        self.each_edge(x, y, |i, j, p, q| {
            let share = edge_share(p, q, &mut widest);
            for l in 0..LANES {
                total[l] += share[l] * (p.r[l] + q.r[l]);
            }
            for k in 0..K {
                for l in 0..LANES {
                    sums[k][l] += share[l] * (q.r[l] * data[i][k] + p.r[l] * data[j][k]);
                }
            }
        });
        let mut values = Vec::new();
        for (l, image) in images.iter_mut().enumerate() {
            if is_good(total[l], widest[l]) {
                *image = std::array::from_fn(|k| sums[k][l] / total[l]);
            } else {
                values.resize(self.vertex_count(), 0.0);
                weighted::values(self, points[l], &mut values)?;
                *image = std::array::from_fn(|k| values.iter().zip(data).map(|(v, d)| v * d[k]).sum());
            }
        }
        Ok(())
    }

    fn values_of_lanes(
        &self,
        points: &[[f64; 2]],
        weights: &mut [Lanes],
        values: &mut [f64],
    ) -> Result<(), CoordinateError> {
        let [x, y] = self.lanes(points)?;
        let (mut total, mut widest) = ([0.0; LANES], [0.0; LANES]);
        weights.fill([0.0; LANES]);
        self.each_edge(x, y, |i, j, p, q| {
            let share = edge_share(p, q, &mut widest);
            for l in 0..LANES {
                total[l] += share[l] * (p.r[l] + q.r[l]);
                weights[i][l] += share[l] * q.r[l];
                weights[j][l] += share[l] * p.r[l];
            }
        });
        for (l, row) in values.chunks_mut(weights.len()).enumerate() {
            if is_good(total[l], widest[l]) {
                let factor = 1.0 / total[l];
                row.iter_mut().zip(&*weights).for_each(|(value, weight)| *value = weight[l] * factor);
            } else {
                weighted::values(self, points[l], row)?;
            }
        }
        Ok(())
    }

    /// The first coordinates of up to four points and the second, scaled; the last point fills what is left.
    fn lanes(&self, points: &[[f64; 2]]) -> Result<[Lanes; 2], CoordinateError> {
        let mut lanes = [[0.0; LANES]; 2];
        for l in 0..LANES {
            let local = self.outline().local(points[l.min(points.len() - 1)])?;
            (lanes[0][l], lanes[1][l]) = (local[0], local[1]);
        }
        Ok(lanes)
    }

    /// Calls with the ends of each edge, by number and as they are seen.
    fn each_edge(&self, x: Lanes, y: Lanes, mut visit: impl FnMut(usize, usize, &Seen, &Seen)) {
        for ring in &self.outline().rings {
            let vertices = &self.outline().vertices[ring.clone()];
            let mut i = vertices.len() - 1;
            let mut p = seen(vertices[i], &x, &y);
            for (j, &vertex) in vertices.iter().enumerate() {
                let q = seen(vertex, &x, &y);
                visit(ring.start + i, ring.start + j, &p, &q);
                (i, p) = (j, q);
            }
        }
    }

    /// Values at one scaled point; false where more care is needed.
    pub(super) fn quick_values(&self, [x, y]: [f64; 2], values: &mut [f64]) -> bool {
        let (mut total, mut widest) = (0.0, 0.0);
        for ring in &self.outline().rings {
            let vertices = &self.outline().vertices[ring.clone()];
            let values = &mut values[ring.clone()];
            values.fill(0.0);
            let see = |[vx, vy]: [f64; 2]| {
                let (sx, sy) = (vx - x, vy - y);
                (sx, sy, (sx * sx + sy * sy).sqrt())
            };
            let mut i = vertices.len() - 1;
            let mut p = see(vertices[i]);
            for (j, &vertex) in vertices.iter().enumerate() {
                let q = see(vertex);
                let (share, tangent) = share(p, q);
                widest = f64::max(widest, tangent);
                total += share * (p.2 + q.2);
                values[i] += share * q.2;
                values[j] += share * p.2;
                (i, p) = (j, q);
            }
        }
        let factor = 1.0 / total;
        values.iter_mut().for_each(|value| *value *= factor);
        is_good(total, widest)
    }
}

/// Whether sums are sound: no half angle was too wide, and nothing vanished.
fn is_good(total: f64, widest: f64) -> bool {
    widest < GREATEST_TANGENT && total.abs() < f64::INFINITY && total != 0.0
}

#[inline(always)]
fn seen([vx, vy]: [f64; 2], x: &Lanes, y: &Lanes) -> Seen {
    let mut seen = Seen { x: [0.0; LANES], y: [0.0; LANES], r: [0.0; LANES] };
    for l in 0..LANES {
        let (sx, sy) = (vx - x[l], vy - y[l]);
        (seen.x[l], seen.y[l], seen.r[l]) = (sx, sy, (sx * sx + sy * sy).sqrt());
    }
    seen
}

#[inline(always)]
fn edge_share(p: &Seen, q: &Seen, widest: &mut Lanes) -> Lanes {
    let mut shares = [0.0; LANES];
    for l in 0..LANES {
        let (share, tangent) = share((p.x[l], p.y[l], p.r[l]), (q.x[l], q.y[l], q.r[l]));
        shares[l] = share;
        widest[l] = if tangent > widest[l] { tangent } else { widest[l] };
    }
    shares
}

/// `t / (r r')` of an edge, and `|t|`, from vectors to its ends and their lengths.
#[inline(always)]
fn share(p: (f64, f64, f64), q: (f64, f64, f64)) -> (f64, f64) {
    let cross = p.0 * q.1 - p.1 * q.0;
    let dot = p.0 * q.0 + p.1 * q.1;
    let lengths = p.2 * q.2;
    let safe = lengths + dot.abs();
    let (over, under) = if dot < 0.0 { (safe, cross) } else { (cross, safe) };
    let share = over / (under * lengths);
    (share, (share * lengths).abs())
}
