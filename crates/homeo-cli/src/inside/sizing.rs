//! How long the edges of a remeshed surface are to be.

use homeo::construct::section::lengths_by_curvature;
use homeo::input::SourceMesh;
use homeo_core::io::{Element, MeshFile, Values};
use serde_json::json;

use super::texture;
use crate::args::RemeshArgs;
use crate::failure::{Failure, Result};

/// The shortest edges of adaptive remeshing, relative to the longest ones.
const SHORTEST: f64 = 0.1;

/// A length, and factors of it at the vertices where it is not the same everywhere.
///
/// # Errors
/// When the file has no such field, or a length is not positive.
pub fn wanted(options: &RemeshArgs, surface: &SourceMesh<3>, file: &MeshFile) -> Result<(f64, Option<Vec<f64>>)> {
    let relative = |lengths: Vec<f64>, to: f64| (to, Some(lengths.into_iter().map(|length| length / to).collect()));
    if let Some(name) = &options.sizing {
        let lengths = field(name, file)?;
        let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
        return Ok(relative(lengths, mean));
    }
    let longest = options.edge.unwrap_or_else(|| texture::mean_edge(surface));
    let Some(error) = options.adaptive else { return Ok((longest, None)) };
    let angle = options.common.features.map(f64::to_radians);
    Ok(relative(lengths_by_curvature(surface, error, [SHORTEST * longest, longest], angle), longest))
}

/// An attribute of vertices with one positive number each.
fn field(name: &str, file: &MeshFile) -> Result<Vec<f64>> {
    let wrong = |what: String| Failure::input("no-sizing", what);
    let found = file.attribute(name, Element::Vertex).filter(|field| field.components == 1);
    let values: Vec<f64> = match found.map(|field| &field.values) {
        Some(Values::F64(values)) => values.clone(),
        Some(Values::F32(values)) => values.iter().map(|&x| f64::from(x)).collect(),
        _ => return Err(wrong(format!("{name} is no attribute of vertices with one floating-point number each"))),
    };
    match values.iter().position(|length| !(*length > 0.0 && length.is_finite())) {
        Some(vertex) => {
            let message = format!("{name} is no positive number at vertex {vertex}");
            Err(wrong(message).with("elements", json!([vertex])))
        }
        None => Ok(values),
    }
}
