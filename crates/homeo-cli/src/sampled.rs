//! What the map looks like: the stretch of the linear interpolation between images of vertices.
//!
//! The interpolation is linear in each cell of the source. It is a picture of the map, not the map:
//! numbers from here are called sampled.

use homeo::certificate::FoliationMap;
use homeo::map::{Bijection, Foliation, distortions};
use homeo_core::mesh::VertexId;
use serde_json::{Value, json};

/// How many cells are tried where not all are asked for.
const CELLS: usize = 2000;

/// Stretches and errors at some cells.
pub struct Sampled {
    /// Ratio of the largest to the smallest singular value, in ascending order; finite.
    stretch: Vec<f64>,
    /// Cells that the interpolation makes flat: their corners go to one side of the target, say.
    pub flat: usize,
    /// The largest error bound of an image.
    pub max_radius: f64,
}

/// Images of all vertices, and stretches of all cells of the source.
pub struct Images {
    /// NaN where a vertex lies in no cell.
    pub images: Vec<[f64; 3]>,
    /// One for each cell.
    pub stretch: Vec<f64>,
}

/// Evaluates the map at the corners of some cells.
pub fn sample(map: &FoliationMap) -> Sampled {
    match map {
        FoliationMap::Surface(map) => sample_cells(map),
        FoliationMap::Volume(map) => sample_cells(map),
    }
}

fn sample_cells<const K: usize>(map: &Foliation<K>) -> Sampled
where
    Foliation<K>: Bijection,
{
    let cells = map.source().complex().cells();
    let chosen = cells.iter().step_by(cells.len().div_ceil(CELLS).max(1));
    let mut numbers: Vec<VertexId> = chosen.clone().flatten().copied().collect();
    numbers.sort_unstable();
    numbers.dedup();
    let positions: Vec<[f64; 3]> = numbers.iter().map(|v| map.source().positions()[v.index()]).collect();
    let answers = map.forward_batch(&positions);
    let images: Vec<[f64; 3]> = answers.iter().map(|a| a.as_ref().map_or([f64::NAN; 3], |a| a.point)).collect();
    let renumbered: Vec<[VertexId; K]> =
        chosen.map(|cell| cell.map(|v| VertexId::new(numbers.binary_search(&v).unwrap_or_default()))).collect();
    let mut stretch = distortions(&renumbered, &positions, &images);
    let tried = stretch.len();
    stretch.retain(|ratio| ratio.is_finite());
    stretch.sort_by(f64::total_cmp);
    Sampled {
        flat: tried - stretch.len(),
        stretch,
        max_radius: answers.iter().flatten().map(|a| a.radius).fold(0.0, f64::max),
    }
}

/// Evaluates the map at all vertices.
pub fn all(map: &FoliationMap) -> Images {
    match map {
        FoliationMap::Surface(map) => all_cells(map),
        FoliationMap::Volume(map) => all_cells(map),
    }
}

fn all_cells<const K: usize>(map: &Foliation<K>) -> Images {
    let source = map.source();
    let mut images = map.vertex_images();
    images.truncate(source.positions().len());
    let stretch = distortions(source.complex().cells(), source.positions(), &images);
    Images { images, stretch }
}

impl Sampled {
    /// The `sampled` part of `quality`.
    pub fn quality(&self) -> Value {
        json!({
            "what": "linear interpolation between the images of the corners of some cells of the source",
            "cells": self.stretch.len() + self.flat,
            "flat_cells": self.flat,
            "stretch_ratio": {
                "median": self.quantile(0.5), "p90": self.quantile(0.9), "p99": self.quantile(0.99),
                "max": self.quantile(1.0),
            },
            "max_radius": self.max_radius,
        })
    }

    /// A quantile of the stretch.
    pub fn quantile(&self, share: f64) -> f64 {
        match self.stretch.len() {
            0 => f64::NAN,
            n => self.stretch[((n - 1) as f64 * share).round() as usize],
        }
    }
}
