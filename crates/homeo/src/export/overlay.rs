//! The triangles of a shell's source cut along its tetrahedra: on each part the projection is linear.
//!
//! Cutting is done in floating point, for display. Which side of a face a vertex is on is decided exactly, so that no
//! part is drawn twice and none is missing where triangles lie in faces, as in shells whose middle is the source.

use std::collections::HashMap;

use homeo_core::predicate::{Sign, orient3d};
use homeo_core::spatial::Aabb;
use rayon::prelude::*;

use super::data::{CellList, CellMesh};
use crate::map::{Shell, distortions};

type Point = [f64; 3];

/// Parts below this share of their triangle's area are not drawn.
const SLIVER: f64 = 1e-9;
/// Source triangles that are cut by one worker at a time.
const PIECE: usize = 4096;

/// Parts of the source's triangles, each in one prism.
#[derive(Clone, Debug)]
pub(super) struct Overlay {
    /// The parts, with their places on the middle surface. Parts in different prisms have no vertex in common.
    pub mesh: CellMesh,
    /// For each part its prism.
    pub prisms: Vec<u32>,
    /// For each part the ratio of the largest to the smallest stretch of the projection.
    pub distortion: Vec<f64>,
}

/// A convex part of a triangle, with the places of its corners on the middle surface.
struct Part {
    prism: u32,
    corners: Vec<(Point, Point)>,
    distortion: f64,
}

/// A corner of a part while it is cut: weights in the source triangle and in the tetrahedron.
type Cut = ([f64; 3], [f64; 4]);

/// Cuts the source along the shell.
///
/// # Complexity
/// Linear in the pairs of a triangle and a slab whose boxes meet.
pub(super) fn overlay(shell: &Shell) -> Overlay {
    let cells = shell.source().complex().cells();
    let corners = |t: usize| cells[t].map(|v| shell.source().positions()[v.index()]);
    let pieces: Vec<Vec<Part>> = (0..cells.len().div_ceil(PIECE))
        .into_par_iter()
        .map(|k| (k * PIECE..cells.len().min((k + 1) * PIECE)).flat_map(|t| parts_of(shell, t, corners(t))).collect())
        .collect();
    let mut numbers: HashMap<(u32, [u64; 3]), u32> = HashMap::new();
    let (mut positions, mut images, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    let (mut prisms, mut distortion) = (Vec::new(), Vec::new());
    for part in pieces.into_iter().flatten() {
        let mut number = |(position, image): (Point, Point)| {
            *numbers.entry((part.prism, position.map(f64::to_bits))).or_insert_with(|| {
                positions.push(position);
                images.push(image);
                positions.len() as u32 - 1
            })
        };
        let corners: Vec<u32> = part.corners.iter().map(|&corner| number(corner)).collect();
        for k in 1..corners.len() - 1 {
            let triangle = [corners[0], corners[k], corners[k + 1]];
            if triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0] {
                triangles.push(triangle);
                prisms.push(part.prism);
                distortion.push(part.distortion);
            }
        }
    }
    Overlay { mesh: CellMesh { positions, images, cells: CellList::Triangles(triangles) }, prisms, distortion }
}

fn parts_of(shell: &Shell, number: usize, triangle: [Point; 3]) -> Vec<Part> {
    let mut parts = Vec::new();
    let belongs = |slab: &usize| shell.parts().are_paired(number as u32, (slab / 2) as u32);
    for slab in shell.slabs_near(&Aabb::of(&triangle)).into_iter().filter(belongs) {
        for (columns, cell) in shell.slab_cells(slab) {
            let Some((cut, weights)) = cut(&triangle, &cell) else { continue };
            let prism = (slab / 2) as u32;
            let middle = shell.parts().prisms[prism as usize].map(|v| shell.parts().middle[v as usize]);
            let on_columns = |weights: &[f64; 4]| {
                let mut sums = [0.0; 3];
                columns.iter().zip(weights).for_each(|(&column, weight)| sums[column] += weight);
                sums
            };
            let corners = cut.iter().map(|(share, weights)| {
                let inside = on_columns(weights).map(|weight| weight.clamp(0.0, 1.0));
                let sum: f64 = inside.iter().sum();
                (combine(share, &triangle), combine(&inside.map(|weight| weight / sum), &middle))
            });
            let images = weights.map(|weights| combine(&on_columns(&weights), &middle));
            let ratio = distortions(&[[0, 1, 2].map(homeo_core::mesh::VertexId::new)], &triangle, &images)[0];
            parts.push(Part { prism, corners: corners.collect(), distortion: ratio });
        }
    }
    parts
}

/// The part of a triangle in a tetrahedron, and the weights of the triangle's corners in the tetrahedron. `None` where
/// they have no area in common, where the tetrahedron is flat, and where the triangle lies in its lower side (then the
/// tetrahedron below has the part).
fn cut(triangle: &[Point; 3], cell: &[Point; 4]) -> Option<(Vec<Cut>, [[f64; 4]; 3])> {
    let whole = orient3d(cell[0], cell[1], cell[2], cell[3]);
    if whole == Sign::Zero {
        return None;
    }
    let mut weights = [[0.0; 4]; 3];
    for face in 0..4 {
        let signs = triangle.map(|corner| {
            let mut moved = *cell;
            moved[face] = corner;
            orient3d(moved[0], moved[1], moved[2], moved[3])
        });
        if signs == [Sign::Zero; 3] {
            if lies_above(triangle, cell[face]) {
                return None;
            }
        } else if signs.iter().all(|&sign| sign != whole) {
            return None;
        }
        for (corner, sign) in signs.into_iter().enumerate() {
            let weight = weight_of(cell, face, triangle[corner]);
            weights[corner][face] = match sign {
                Sign::Zero => 0.0,
                inside if inside == whole => weight.max(f64::MIN_POSITIVE),
                _ => weight.min(-f64::MIN_POSITIVE),
            };
        }
    }
    let unit = |k: usize| std::array::from_fn(|i| f64::from(u8::from(i == k)));
    let mut part: Vec<Cut> = (0..3).map(|k| (unit(k), weights[k])).collect();
    for face in 0..4 {
        part = keep_positive(&part, face);
    }
    (share_of_area(&part) > SLIVER).then_some((part, weights))
}

/// Cuts a convex part along a face of the tetrahedron.
fn keep_positive(part: &[Cut], face: usize) -> Vec<Cut> {
    let mut kept = Vec::with_capacity(part.len() + 1);
    for (k, &(share, weights)) in part.iter().enumerate() {
        let (next_share, next_weights) = part[(k + 1) % part.len()];
        let (here, next) = (weights[face], next_weights[face]);
        if here >= 0.0 {
            kept.push((share, weights));
        }
        if (here > 0.0 && next < 0.0) || (here < 0.0 && next > 0.0) {
            let t = here / (here - next);
            let mut between: [f64; 4] = std::array::from_fn(|i| weights[i] + t * (next_weights[i] - weights[i]));
            between[face] = 0.0;
            kept.push((std::array::from_fn(|i| share[i] + t * (next_share[i] - share[i])), between));
        }
    }
    kept
}

/// The area of a part by that of its triangle.
fn share_of_area(part: &[Cut]) -> f64 {
    let corner = |k: usize| [part[k].0[1], part[k].0[2]];
    (2..part.len())
        .map(|k| {
            let ([ax, ay], [bx, by], [cx, cy]) = (corner(0), corner(k - 1), corner(k));
            (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        })
        .sum()
}

/// The barycentric weight of one corner of a tetrahedron at a point.
fn weight_of(cell: &[Point; 4], corner: usize, point: Point) -> f64 {
    let [a, b, c] = [1, 2, 3].map(|k| cell[(corner + k) % 4]);
    let normal = cross(minus(b, a), minus(c, a));
    dot(normal, minus(point, a)) / dot(normal, minus(cell[corner], a))
}

fn lies_above(triangle: &[Point; 3], point: Point) -> bool {
    let [a, b, c] = *triangle;
    dot(cross(minus(b, a), minus(c, a)), minus(point, a)) > 0.0
}

fn combine(weights: &[f64; 3], points: &[Point; 3]) -> Point {
    // Corners stay what they are.
    if let Some(k) = (0..3).find(|&k| weights[k] == 1.0) {
        return points[k];
    }
    std::array::from_fn(|axis| (0..3).map(|k| weights[k] * points[k][axis]).sum())
}

/// Barycentric weights, adding up to 1, of the point of a triangle's plane that is nearest to a point.
pub(super) fn weights_near(triangle: &[Point; 3], point: Point) -> [f64; 3] {
    let [a, b, c] = *triangle;
    let normal = cross(minus(b, a), minus(c, a));
    let size = dot(normal, normal);
    if size == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let of_b = dot(cross(minus(point, a), minus(c, a)), normal) / size;
    let of_c = dot(cross(minus(b, a), minus(point, a)), normal) / size;
    [1.0 - of_b - of_c, of_b, of_c]
}

fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
