//! Pictures of the universal cover as glTF 2.0, binary or with everything in the text.

use super::cover::{CoverPicture, FaceKind};
use super::pack::write_base64;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Writes a picture as `.glb`: positions, normals and triangles, with one material for the geodesic boundary, one for faces inside
/// of the fundamental domain, and one for each side pairing. Coordinates are single precision, in those of the model.
///
/// Source: glTF 2.0 specification (Khronos 2021), sections 3.6 and 4.4.
///
/// # Errors
/// When `out` cannot be written, and for pictures of 4 GiB and more.
///
/// # Example
/// ```
/// use homeo::export::{CoverPicture, Model, write_glb};
/// use homeo_manifold::{Skeleton, from_signature, hyperbolic::{Embedding, Structure}};
/// let tripus = from_signature("cPcbbbihq")?;
/// let skeleton = Skeleton::new(&tripus);
/// let embedding = Embedding::new(&tripus, &skeleton, &Structure::find(&tripus, &skeleton)?).unwrap();
/// let mut file = Vec::new();
/// write_glb(&CoverPicture::new(&embedding, 0, Model::Ball, 2), &mut file)?;
/// assert!(file.starts_with(b"glTF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_glb(picture: &CoverPicture, out: &mut impl Write) -> io::Result<()> {
    let (mut document, bytes) = document(picture);
    document["buffers"] = json!([{"byteLength": bytes.len()}]);
    let mut text = serde_json::to_vec(&document).map_err(io::Error::other)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + text.len() + 8 + bytes.len();
    let length = |size: usize| u32::try_from(size).map_err(|_| io::Error::other("the picture has 4 GiB or more"));
    out.write_all(b"glTF")?;
    [2, length(total)?, length(text.len())?].iter().try_for_each(|word| out.write_all(&word.to_le_bytes()))?;
    out.write_all(b"JSON")?;
    out.write_all(&text)?;
    out.write_all(&length(bytes.len())?.to_le_bytes())?;
    out.write_all(b"BIN\0")?;
    out.write_all(&bytes)
}

/// Writes a picture as `.gltf`, in one file; see [`write_glb`].
///
/// # Errors
/// When `out` cannot be written.
///
/// # Example
/// ```
/// # use homeo_manifold::{Skeleton, from_signature, hyperbolic::{Embedding, Structure}};
/// use homeo::export::{CoverPicture, Model, write_gltf};
/// # let tripus = from_signature("cPcbbbihq")?;
/// # let skeleton = Skeleton::new(&tripus);
/// # let embedding = Embedding::new(&tripus, &skeleton, &Structure::find(&tripus, &skeleton)?).unwrap();
/// let mut file = Vec::new();
/// write_gltf(&CoverPicture::new(&embedding, 0, Model::HalfSpace, 1), &mut file)?;
/// let document: serde_json::Value = serde_json::from_slice(&file)?;
/// assert_eq!(document["asset"]["version"], "2.0");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_gltf(picture: &CoverPicture, out: &mut impl Write) -> io::Result<()> {
    let (mut document, bytes) = document(picture);
    let mut uri = b"data:application/octet-stream;base64,".to_vec();
    write_base64(&bytes, &mut uri)?;
    let uri = String::from_utf8(uri).map_err(io::Error::other)?;
    document["buffers"] = json!([{"byteLength": bytes.len(), "uri": uri}]);
    serde_json::to_writer(&mut *out, &document).map_err(io::Error::other)?;
    out.write_all(b"\n")
}

/// Little-endian unsigned integers of 32 bits, and floats, as glTF numbers them.
const UNSIGNED: u32 = 5125;
const FLOAT: u32 = 5126;

/// The document but for its buffer, and the bytes of that.
fn document(picture: &CoverPicture) -> (Value, Vec<u8>) {
    let mut bytes = Vec::new();
    let mut views = Vec::new();
    let mut accessors = Vec::new();
    let mut add = |data: Vec<[u8; 4]>, target: u32, accessor: Value| {
        views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": 4 * data.len(), "target": target}));
        bytes.extend(data.into_iter().flatten());
        let mut accessor = accessor;
        accessor["bufferView"] = json!(accessors.len());
        accessors.push(accessor);
        accessors.len() - 1
    };
    let count = picture.positions.len();
    let [low, high] = bounds(&picture.positions);
    let vectors = json!({"componentType": FLOAT, "count": count, "type": "VEC3"});
    let mut places = vectors.clone();
    (places["min"], places["max"]) = (json!(low), json!(high));
    let (position, normal) =
        (add(floats(&picture.positions), 34962, places), add(floats(&picture.normals), 34962, vectors));
    let mut materials = Vec::new();
    let mut primitives = Vec::new();
    for (kind, indices) in by_kind(picture) {
        let accessor = json!({"componentType": UNSIGNED, "count": indices.len(), "type": "SCALAR"});
        let indices = add(indices.into_iter().map(u32::to_le_bytes).collect(), 34963, accessor);
        primitives.push(json!({
            "attributes": {"POSITION": position, "NORMAL": normal}, "indices": indices, "material": materials.len(),
        }));
        materials.push(material(kind));
    }
    let document = json!({
        "asset": {"version": "2.0", "generator": concat!("homeo ", env!("CARGO_PKG_VERSION"))},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"name": "truncated tetrahedra", "primitives": primitives}],
        "materials": materials, "accessors": accessors, "bufferViews": views,
    });
    (document, bytes)
}

fn floats(points: &[[f64; 3]]) -> Vec<[u8; 4]> {
    points.iter().flatten().map(|&x| (x as f32).to_le_bytes()).collect()
}

fn bounds(points: &[[f64; 3]]) -> [[f32; 3]; 2] {
    let mut bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    for point in points {
        for (axis, &x) in point.iter().enumerate() {
            bounds[0][axis] = bounds[0][axis].min(x as f32);
            bounds[1][axis] = bounds[1][axis].max(x as f32);
        }
    }
    bounds
}

/// Corners of the triangles of each kind.
fn by_kind(picture: &CoverPicture) -> BTreeMap<FaceKind, Vec<u32>> {
    let mut indices: BTreeMap<FaceKind, Vec<u32>> = BTreeMap::new();
    for corners in &picture.triangles {
        indices.entry(picture.kinds[corners[0] as usize]).or_default().extend(corners);
    }
    indices
}

fn material(kind: FaceKind) -> Value {
    let name = match kind {
        FaceKind::Boundary => "geodesic boundary".to_owned(),
        FaceKind::Inner => "inside of the domain".to_owned(),
        FaceKind::Side(number) => format!("side pairing {number}"),
    };
    let [r, g, b] = colour(kind).map(|x| f64::from(x) / 255.0).map(|x| (x.powf(2.2) * 1e4).round() / 1e4);
    json!({
        "name": name, "doubleSided": true,
        "pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.7},
    })
}

/// The colour of a kind of faces, red, green, blue: grey for the boundary, dark for faces inside, hues for sides, those that follow far
/// from one another.
pub(super) fn colour(kind: FaceKind) -> [u8; 3] {
    match kind {
        FaceKind::Boundary => [226, 222, 210],
        FaceKind::Inner => [120, 130, 145],
        FaceKind::Side(number) => {
            let hue = (0.58 + f64::from(number) * 0.618_033_988_749_895).fract() * 6.0;
            let channel = |shift: f64| {
                let ramp = (((hue + shift) % 6.0) - 3.0).abs() - 1.0;
                (70.0 + 155.0 * ramp.clamp(0.0, 1.0)).round() as u8
            };
            [channel(0.0), channel(4.0), channel(2.0)]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::cover::{Model, tests::embedding};
    use super::*;

    fn word(file: &[u8], at: usize) -> usize {
        u32::from_le_bytes([file[at], file[at + 1], file[at + 2], file[at + 3]]) as usize
    }

    /// Reads the file by the definition of the format.
    #[test]
    fn all_triangles_are_in_the_file_with_their_corners() {
        let picture = CoverPicture::new(&embedding("cPcbbbihq"), 1, Model::Ball, 2);
        let mut file = Vec::new();
        write_glb(&picture, &mut file).expect("memory can be written");
        assert_eq!((word(&file, 4), word(&file, 8)), (2, file.len()));
        let text = word(&file, 12);
        let document: Value = serde_json::from_slice(&file[20..20 + text]).expect("JSON");
        let buffer = &file[28 + text..];
        assert_eq!(word(&file, 20 + text), buffer.len());
        assert_eq!(document["buffers"][0]["byteLength"], buffer.len());
        let number = |value: &Value| value.as_u64().expect("a number") as usize;
        let start = |accessor: &Value| number(&document["bufferViews"][number(&accessor["bufferView"])]["byteOffset"]);
        let mut triangles = Vec::new();
        let primitives = document["meshes"][0]["primitives"].as_array().expect("primitives");
        for primitive in primitives {
            let accessor = &document["accessors"][number(&primitive["indices"])];
            let indices: Vec<_> =
                (0..number(&accessor["count"])).map(|k| word(buffer, start(accessor) + 4 * k) as u32).collect();
            triangles.extend(indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]));
        }
        let mut expected = picture.triangles.clone();
        expected.sort_unstable();
        triangles.sort_unstable();
        assert_eq!(triangles, expected);
        // Boundary, faces inside, three side pairings.
        assert_eq!(primitives.len(), 5);
        let places = start(&document["accessors"][0]);
        let x = f32::from_le_bytes(std::array::from_fn(|k| buffer[places + 12 * 7 + k]));
        assert_eq!(x, picture.positions[7][0] as f32);
    }

    #[test]
    fn the_text_holds_the_same_bytes() {
        let picture = CoverPicture::new(&embedding("cPcbbbihq"), 0, Model::HalfSpace, 1);
        let mut file = Vec::new();
        write_gltf(&picture, &mut file).expect("memory can be written");
        let document: Value = serde_json::from_slice(&file).expect("JSON");
        let uri = document["buffers"][0]["uri"].as_str().expect("a buffer");
        let digits = uri.split(',').nth(1).expect("base64").trim_end_matches('=').len();
        assert_eq!(document["buffers"][0]["byteLength"], digits * 3 / 4);
    }

    #[test]
    fn sides_have_colours_of_their_own() {
        let colours: std::collections::BTreeSet<_> = (0..12).map(|number| colour(FaceKind::Side(number))).collect();
        assert_eq!(colours.len(), 12);
    }
}
