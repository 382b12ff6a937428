//! What the map looks like: the stretch of the linear interpolation between images of vertices.
//!
//! The interpolation is linear in each cell of the foliated mesh. It is a picture of the map, not the
//! map: numbers from here are called sampled.

use homeo::certificate::FoliationMap;
use homeo::map::{Bijection, Foliation, distortions};
use serde_json::{Value, json};

/// How many centroids are evaluated for the bound of the error.
const CENTROIDS: usize = 1000;

/// Images and stretches.
pub struct Sampled {
    /// Images of the source's vertices; NaN where a vertex lies in no cell.
    pub images: Vec<[f64; 3]>,
    /// For each cell of the source the ratio of the largest to the smallest singular value.
    pub source_stretch: Vec<f64>,
    /// The same for the cells of the foliated mesh, in ascending order.
    sorted_stretch: Vec<f64>,
    /// The largest error bound of an image, at the centroids that were tried.
    pub max_radius: f64,
    /// Vertices without an image.
    pub missing: usize,
}

/// Evaluates the map at all vertices and at some centroids.
pub fn sample(map: &FoliationMap) -> Sampled {
    match map {
        FoliationMap::Surface(map) => sample_foliation(map),
        FoliationMap::Volume(map) => sample_foliation(map),
    }
}

fn sample_foliation<const K: usize>(map: &Foliation<K>) -> Sampled
where
    Foliation<K>: Bijection,
{
    let (source, mesh) = (map.source(), &map.parts().mesh);
    let images = map.vertex_images();
    let mut sorted_stretch = distortions(mesh.complex().cells(), mesh.positions(), &images);
    sorted_stretch.sort_by(f64::total_cmp);
    let source_stretch = distortions(source.complex().cells(), source.positions(), &images);
    let cells = source.complex().cells();
    let centroids: Vec<[f64; 3]> = cells
        .iter()
        .step_by((cells.len() / CENTROIDS).max(1))
        .map(|cell| {
            std::array::from_fn(|axis| {
                cell.iter().map(|v| source.positions()[v.index()][axis]).sum::<f64>() / cell.len() as f64
            })
        })
        .collect();
    let max_radius = map.forward_batch(&centroids).iter().flatten().map(|a| a.radius).fold(0.0, f64::max);
    let images = images[..source.positions().len()].to_vec();
    let missing = images.iter().filter(|p| p[0].is_nan()).count();
    Sampled { images, source_stretch, sorted_stretch, max_radius, missing }
}

impl Sampled {
    /// The `sampled` part of `quality`.
    pub fn quality(&self) -> Value {
        json!({
            "what": "linear interpolation between the images of the vertices of the foliated mesh",
            "cells": self.sorted_stretch.len(),
            "stretch_ratio": {
                "median": self.quantile(0.5), "p90": self.quantile(0.9), "p99": self.quantile(0.99),
                "max": self.quantile(1.0),
            },
            "max_radius": self.max_radius,
            "vertices_in_no_cell": self.missing,
        })
    }

    /// A quantile of the stretch.
    pub fn quantile(&self, share: f64) -> f64 {
        match self.sorted_stretch.len() {
            0 => f64::NAN,
            n => self.sorted_stretch[((n - 1) as f64 * share).round() as usize],
        }
    }
}
