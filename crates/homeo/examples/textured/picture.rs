//! Meshes side by side, drawn with a depth buffer.

use std::collections::HashMap;
use std::error::Error;
use std::path::Path;

use homeo_core::io::{Element, MeshFile, Values, read_mesh};

use crate::{pattern, png};

type Point = [f64; 3];

/// Pixels of a panel, and samples along each side of a pixel.
const SIDE: usize = 500;
const SAMPLES: usize = 3;
/// Shades of each colour.
const SHADES: f64 = 25.0;
const PAPER: Point = [1.0; 3];
const LINE: Point = [0.13, 0.13, 0.15];
const SEAM: Point = [0.85, 0.05, 0.15];
/// Widths of lines, in pixels.
const LINE_WIDTH: f64 = 0.7;
const SEAM_WIDTH: f64 = 2.2;

/// A triangle with what is drawn on it.
struct Triangle {
    corners: [Point; 3],
    texture: Option<[[f64; 2]; 3]>,
    /// For the edge opposite to each corner.
    is_seam: [bool; 3],
}

/// Draws meshes, all at the scale of the first.
pub fn write(meshes: &[&str], image: &Path) -> Result<(), Box<dyn Error>> {
    let meshes: Vec<MeshFile> = meshes.iter().map(|path| read_mesh(Path::new(path))).collect::<Result<_, _>>()?;
    let seen = |mesh: &MeshFile| mesh.positions.iter().map(|&p| turned(p)).collect::<Vec<Point>>();
    let frame = frame(&seen(&meshes[0]));
    let panels: Vec<Vec<Point>> = meshes.iter().map(|mesh| panel(&triangles(mesh, &seen(mesh)), frame)).collect();
    save(&panels, image)
}

/// Draws patches, each at its own scale and from in front.
pub fn write_patches(meshes: &[&str], image: &Path) -> Result<(), Box<dyn Error>> {
    let meshes: Vec<MeshFile> = meshes.iter().map(|path| read_mesh(Path::new(path))).collect::<Result<_, _>>()?;
    let panel = |mesh: &MeshFile| {
        let side = if faces_away(mesh) { -1.0 } else { 1.0 };
        let points: Vec<Point> = mesh.positions.iter().map(|&[x, y, z]| turned([side * x, y, side * z])).collect();
        panel(&triangles(mesh, &points), frame(&points))
    };
    save(&meshes.iter().map(panel).collect::<Vec<_>>(), image)
}

/// Whether more of a mesh faces down the third axis than up.
fn faces_away(mesh: &MeshFile) -> bool {
    let doubled = |triangle: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[triangle[k] as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    mesh.polygons.iter().map(doubled).sum::<f64>() < 0.0
}

/// Writes panels side by side.
fn save(panels: &[Vec<Point>], image: &Path) -> Result<(), Box<dyn Error>> {
    let rows = (0..SIDE).flat_map(|y| panels.iter().flat_map(move |panel| &panel[y * SIDE..(y + 1) * SIDE]));
    // Few shades make a small file.
    let pixels: Vec<[u8; 3]> = rows.map(|pixel| pixel.map(|x| (255.0 * (SHADES * x).round() / SHADES) as u8)).collect();
    png::write(image, SIDE * panels.len(), &pixels)?;
    Ok(())
}

/// As seen from above and a little from the front: right, up, towards the eye.
fn turned([x, y, z]: Point) -> Point {
    let (sine, cosine) = 0.45f64.sin_cos();
    [x, cosine * y + sine * z, cosine * z - sine * y]
}

/// The middle of the picture, and pixels per unit.
fn frame(points: &[Point]) -> ([f64; 2], f64) {
    let ends = [0, 1].map(|axis| {
        let of_axis = || points.iter().map(|p| p[axis]);
        [of_axis().fold(f64::MAX, f64::min), of_axis().fold(f64::MIN, f64::max)]
    });
    let widest = ends.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
    (ends.map(|[low, high]| (low + high) / 2.0), 0.93 * SIDE as f64 / widest)
}

fn triangles(mesh: &MeshFile, points: &[Point]) -> Vec<Triangle> {
    let rows: Option<Vec<[f64; 2]>> =
        mesh.attribute("texture", Element::Corner).filter(|a| a.components == 2).and_then(|a| match &a.values {
            Values::F64(values) => Some(values.chunks_exact(2).map(|row| [row[0], row[1]]).collect()),
            _ => None,
        });
    let corner_rows = |t: usize| rows.as_ref().map(|rows| [rows[3 * t], rows[3 * t + 1], rows[3 * t + 2]]);
    let all: Vec<&[u32]> = mesh.polygons.iter().collect();
    // Both ends of each directed edge, in the texture.
    let mut sides = HashMap::new();
    for (t, corners) in all.iter().enumerate() {
        for (k, l) in [(1, 2), (2, 0), (0, 1)] {
            sides.insert((corners[k], corners[l]), corner_rows(t).map(|rows| [rows[k], rows[l]]));
        }
    }
    let is_seam = |a: u32, b: u32| match (sides.get(&(a, b)), sides.get(&(b, a))) {
        (Some(Some([p, q])), Some(Some([r, s]))) => [p, q] != [s, r],
        _ => false,
    };
    let one = |(t, corners): (usize, &&[u32])| Triangle {
        corners: [0, 1, 2].map(|k| points[corners[k] as usize]),
        texture: corner_rows(t),
        is_seam: [0, 1, 2].map(|k| is_seam(corners[(k + 1) % 3], corners[(k + 2) % 3])),
    };
    all.iter().enumerate().map(one).collect()
}

/// One picture, row by row.
fn panel(triangles: &[Triangle], ([x, y], scale): ([f64; 2], f64)) -> Vec<Point> {
    let size = SIDE * SAMPLES;
    let mut samples = vec![(f64::MIN, PAPER); size * size];
    for triangle in triangles {
        let place = |p: Point| {
            let [right, up] = [(p[0] - x) * scale, (p[1] - y) * scale];
            [right, -up].map(|pixels| (pixels + SIDE as f64 / 2.0) * SAMPLES as f64)
        };
        draw(triangle, triangle.corners.map(place), size, &mut samples);
    }
    let mean = |pixel: usize| {
        let (column, row) = (pixel % SIDE * SAMPLES, pixel / SIDE * SAMPLES);
        let places = (0..SAMPLES * SAMPLES).map(|i| (row + i / SAMPLES) * size + column + i % SAMPLES);
        let sum = places.fold([0.0; 3], |sum, at| [0, 1, 2].map(|k| sum[k] + samples[at].1[k]));
        sum.map(|x| x / (SAMPLES * SAMPLES) as f64)
    };
    (0..SIDE * SIDE).map(mean).collect()
}

fn draw(triangle: &Triangle, [a, b, c]: [[f64; 2]; 3], size: usize, samples: &mut [(f64, Point)]) {
    let doubled = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let area = doubled(a, b, c);
    // The rows go down, so what faces the eye is clockwise.
    if area >= 0.0 {
        return;
    }
    let range = |axis: usize| {
        let of_axis = [a, b, c].map(|p| p[axis]);
        let low = of_axis.iter().copied().fold(f64::MAX, f64::min).max(0.0) as usize;
        let high = of_axis.iter().copied().fold(f64::MIN, f64::max).clamp(0.0, size as f64 - 1.0) as usize;
        low..=high
    };
    let length = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
    let heights = [length(b, c), length(c, a), length(a, b)].map(|side| -area / (side * SAMPLES as f64));
    let light = light(triangle.corners);
    for (column, row) in range(1).flat_map(|row| range(0).map(move |column| (column, row))) {
        let at = [column as f64 + 0.5, row as f64 + 0.5];
        let weights = [doubled(at, b, c), doubled(at, c, a), doubled(at, a, b)].map(|part| part / area);
        if weights.iter().any(|&weight| weight < 0.0) {
            continue;
        }
        let depth = (0..3).map(|k| weights[k] * triangle.corners[k][2]).sum();
        let sample = &mut samples[row * size + column];
        if depth > sample.0 {
            *sample = (depth, shade(triangle, weights, heights, light));
        }
    }
}

/// From a light above the left shoulder.
fn light([a, b, c]: [Point; 3]) -> f64 {
    let [p, q] = [b, c].map(|end| [0, 1, 2].map(|k| end[k] - a[k]));
    let normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    let towards = (-0.40 * normal[0] + 0.46 * normal[1] + 0.79 * normal[2]) / length;
    0.42 + 0.58 * towards.max(0.0)
}

fn shade(triangle: &Triangle, weights: [f64; 3], heights: [f64; 3], light: f64) -> Point {
    let mixed = |over: Point, share: f64, under: Point| [0, 1, 2].map(|k| share * over[k] + (1.0 - share) * under[k]);
    let distance = |k: usize| weights[k] * heights[k];
    if (0..3).any(|k| triangle.is_seam[k] && distance(k) < SEAM_WIDTH) {
        return mixed(SEAM, 0.9, PAPER).map(|x| x * light);
    }
    let texture = triangle.texture.map(|rows| [0, 1].map(|axis| (0..3).map(|k| weights[k] * rows[k][axis]).sum()));
    let colour = texture.map_or([0.8; 3], pattern::colour).map(|x| x * light);
    let is_line = (0..3).any(|k| distance(k) < LINE_WIDTH / 2.0);
    if is_line { mixed(LINE, 0.6, colour) } else { colour }
}
