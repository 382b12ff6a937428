//! Texture coordinates on their way from the file into a construction, and back.

use std::collections::HashMap;

use homeo::construct::section::Texture;
use homeo::input::SourceMesh;
use homeo::transfer::{Status, Transferred};
use homeo_core::io::{Attribute, Element, MeshFile, Values};
use homeo_core::predicate::{Sign, orient2d};
use serde_json::{Value, json};

/// The texture of a file of triangles, and how many entries it has per corner; `None` if there is none, or if some corners
/// have no coordinates.
pub fn of_file(file: &MeshFile) -> Option<(Texture, &Attribute)> {
    let attribute = file.attribute("texture", Element::Corner).filter(|a| a.components == 2)?;
    let rows: Vec<[f64; 2]> = match &attribute.values {
        Values::F64(values) => values.chunks_exact(2).map(|row| [row[0], row[1]]).collect(),
        Values::F32(values) => values.chunks_exact(2).map(|row| [row[0].into(), row[1].into()]).collect(),
        Values::I64(_) | Values::Text(_) => return None,
    };
    if rows.iter().flatten().any(|x| !x.is_finite()) {
        return None;
    }
    let mut texture = Texture::default();
    let mut numbers = HashMap::new();
    for (polygon, corners) in file.polygons.iter().enumerate() {
        texture.corners.push(std::array::from_fn(|k| {
            let row = rows[3 * polygon + k];
            // Corners of one vertex with the same coordinates lie on one side of a seam.
            *numbers.entry((corners[k], row.map(f64::to_bits))).or_insert_with(|| {
                texture.coordinates.push(row);
                texture.coordinates.len() as u32 - 1
            })
        }));
    }
    Some((texture, attribute))
}

/// The texture of a surface as an attribute like the one in the file.
pub fn carried(texture: &Texture, like: &Attribute) -> Transferred {
    let rows = || texture.corners.iter().flatten().flat_map(|&corner| texture.coordinates[corner as usize]);
    let values = match like.values {
        Values::F32(_) => Values::F32(rows().map(|x| x as f32).collect()),
        _ => Values::F64(rows().collect()),
    };
    let status = vec![Status::Interpolated; 3 * texture.corners.len()];
    Transferred { attribute: Attribute { values, ..like.clone() }, status }
}

/// How many triangles of a texture are counter-clockwise, clockwise, and flat, exactly.
pub fn orientations(texture: &Texture) -> Value {
    let mut counts = [0; 3];
    for corners in &texture.corners {
        let [a, b, c] = corners.map(|corner| texture.coordinates[corner as usize]);
        counts[match orient2d(a, b, c) {
            Sign::Positive => 0,
            Sign::Negative => 1,
            Sign::Zero => 2,
        }] += 1;
    }
    json!({"counter_clockwise": counts[0], "clockwise": counts[1], "flat": counts[2]})
}

/// The mean length of the edges of a surface.
pub fn mean_edge(surface: &SourceMesh<3>) -> f64 {
    let sides = surface.complex().cells().iter().flat_map(|cell| [0, 1, 2].map(|k| [cell[k], cell[(k + 1) % 3]]));
    let (sum, count) = sides.fold((0.0, 0.0), |(sum, count), ends| {
        let [a, b] = ends.map(|v| surface.positions()[v.index()]);
        let squared: f64 = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum();
        (sum + squared.sqrt(), count + 1.0)
    });
    sum / count
}
