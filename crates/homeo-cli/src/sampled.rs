//! What the map looks like: images of the vertices, and the stretch of the interpolation between them.
//!
//! The interpolation is linear in each cell of the source. It is a picture of the map, not the map:
//! numbers from here are called sampled.

use homeo::certificate::FoliationMap;
use homeo::map::Bijection;
use homeo_core::mesh::SimplicialComplex;
use rayon::prelude::*;
use serde_json::{Value, json};

/// Images and stretches.
pub struct Sampled {
    /// Image of each vertex; NaN where it lies in no cell.
    pub images: Vec<[f64; 3]>,
    /// For each cell the ratio of the largest to the smallest singular value.
    pub stretch: Vec<f64>,
    /// The largest error bound of an image.
    pub max_radius: f64,
    /// Vertices without an image.
    pub missing: usize,
    /// Cells that the interpolation turns the other way than most.
    pub reversed: usize,
}

/// Evaluates the map at all vertices.
pub fn sample(map: &FoliationMap) -> Sampled {
    let positions = match map {
        FoliationMap::Surface(map) => map.source().positions(),
        FoliationMap::Volume(map) => map.source().positions(),
    };
    let answers = map.forward_batch(positions);
    let max_radius = answers.iter().flatten().map(|a| a.radius).fold(0.0, f64::max);
    let missing = answers.iter().filter(|a| a.is_err()).count();
    let images: Vec<[f64; 3]> = answers.into_iter().map(|a| a.map_or([f64::NAN; 3], |a| a.point)).collect();
    let (stretch, reversed) = match map {
        FoliationMap::Surface(map) => stretches(map.source().complex(), positions, &images),
        FoliationMap::Volume(map) => stretches(map.source().complex(), positions, &images),
    };
    Sampled { images, stretch, max_radius, missing, reversed }
}

impl Sampled {
    /// The `sampled` part of `quality`.
    pub fn quality(&self) -> Value {
        json!({
            "what": "linear interpolation between the images of the source's vertices",
            "cells": self.stretch.len(),
            "reversed_cells": self.reversed,
            "stretch_ratio": {
                "median": self.quantile(0.5), "p90": self.quantile(0.9), "p99": self.quantile(0.99),
                "max": self.quantile(1.0),
            },
        })
    }

    /// A quantile of the stretch.
    pub fn quantile(&self, share: f64) -> f64 {
        let mut sorted = self.stretch.clone();
        sorted.sort_by(f64::total_cmp);
        match sorted.len() {
            0 => f64::NAN,
            n => sorted[((n - 1) as f64 * share).round() as usize],
        }
    }
}

fn stretches<const K: usize>(
    complex: &SimplicialComplex<K>,
    positions: &[[f64; 3]],
    images: &[[f64; 3]],
) -> (Vec<f64>, usize) {
    let of_cell = |cell: &[homeo_core::mesh::VertexId; K]| {
        let edges = |points: &[[f64; 3]]| -> [[f64; 3]; 3] {
            std::array::from_fn(|i| {
                let [a, b] = [cell[0], cell[(i + 1).min(K - 1)]].map(|v| points[v.index()]);
                if i + 1 < K { [0, 1, 2].map(|k| b[k] - a[k]) } else { [0.0; 3] }
            })
        };
        linear_map(edges(positions), edges(images), K - 1)
    };
    let maps: Vec<(f64, bool)> = complex.cells().par_iter().map(of_cell).collect();
    let positive = maps.iter().filter(|m| m.1).count();
    (maps.iter().map(|m| m.0).collect(), positive.min(maps.len() - positive))
}

/// Ratio of the singular values of the linear map that takes `source` edges to `image` edges, and whether it
/// keeps the orientation.
fn linear_map(source: [[f64; 3]; 3], image: [[f64; 3]; 3], dimension: usize) -> (f64, bool) {
    let (mut source, mut image) = (source, image);
    if dimension == 2 {
        // A unit step across the plane stands still in both.
        source[2] = normalized(cross(source[0], source[1]));
        image[2] = [0.0, 0.0, 1.0];
    }
    let volume = dot(source[0], cross(source[1], source[2]));
    let dual = [cross(source[1], source[2]), cross(source[2], source[0]), cross(source[0], source[1])]
        .map(|v| v.map(|x| x / volume));
    // Rows of the map: sum over the edges of image times dual.
    let mut columns: [[f64; 3]; 3] =
        std::array::from_fn(|c| std::array::from_fn(|r| (0..3).map(|e| image[e][r] * dual[e][c]).sum()));
    let keeps = volume * dot(image[0], cross(image[1], image[2])) > 0.0;
    let (axes, flat) = if dimension == 2 { plane_axes(source) } else { ([[0.0; 3]; 2], false) };
    if dimension == 2 && !flat {
        // In the plane of the triangle, so that the third direction does not count.
        let along =
            |axis: [f64; 3]| -> [f64; 3] { std::array::from_fn(|r| (0..3).map(|c| columns[c][r] * axis[c]).sum()) };
        columns = [along(axes[0]), along(axes[1]), [0.0; 3]];
    }
    (singular_ratio(columns, dimension), keeps)
}

fn plane_axes(source: [[f64; 3]; 3]) -> ([[f64; 3]; 2], bool) {
    let first = normalized(source[0]);
    let second = cross(source[2], first);
    ([first, second], first.iter().any(|x| !x.is_finite()))
}

/// One-sided Jacobi rotations: columns become orthogonal, their lengths the singular values.
fn singular_ratio(mut columns: [[f64; 3]; 3], dimension: usize) -> f64 {
    for _ in 0..30 {
        let mut worst = 0.0f64;
        for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().filter(|&(_, q)| q < dimension) {
            let (alpha, beta, gamma) =
                (dot(columns[p], columns[p]), dot(columns[q], columns[q]), dot(columns[p], columns[q]));
            if gamma == 0.0 {
                continue;
            }
            worst = worst.max(gamma.abs() / (alpha * beta).sqrt());
            let zeta = (beta - alpha) / (2.0 * gamma);
            let t = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            let s = c * t;
            for r in 0..3 {
                let (x, y) = (columns[p][r], columns[q][r]);
                (columns[p][r], columns[q][r]) = (c * x - s * y, s * x + c * y);
            }
        }
        if worst < 1e-14 {
            break;
        }
    }
    let lengths = columns[..dimension].iter().map(|c| dot(*c, *c).sqrt());
    let (low, high) = lengths.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
    if low > 0.0 { high / low } else { f64::INFINITY }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn normalized(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretch_of_known_maps() {
        let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let scaled = [[2.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 3.0]];
        let (ratio, keeps) = linear_map(unit, scaled, 3);
        assert!((ratio - 3.0).abs() < 1e-12 && keeps);
        let sheared = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0]];
        let (ratio, keeps) = linear_map([unit[0], unit[1], [0.0; 3]], sheared, 2);
        // The golden ratio, squared.
        assert!((ratio - (3.0 + 5f64.sqrt()) / 2.0).abs() < 1e-12 && keeps);
        assert!(!linear_map(unit, [unit[1], unit[0], unit[2]], 3).1);
    }
}
