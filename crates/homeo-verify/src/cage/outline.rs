//! A cage: a closed triangle mesh, with what is computed once for all its charts.

use super::jet::{Form, Vector, cross, difference, dot, size, three, times};
use std::collections::BTreeMap;

pub(super) type Point = [f64; 3];

pub(super) struct Edge {
    /// From `a` to `b`.
    pub ends: [u32; 2],
    pub along: Vector<Form>,
    pub length: Form,
    pub by_square: Form,
}

pub(super) struct Face {
    pub corners: [u32; 3],
    /// The edge that is opposite to each corner.
    pub edges: [u32; 3],
    /// Of length 1, towards the inside of the cage.
    pub normal: Vector<Form>,
    /// For each edge in the plane of the face: across the edge and of length 1, towards the inside of the face.
    pub inward: [Vector<Form>; 3],
    /// The inverse heights.
    pub by_height: [Form; 3],
    /// The products of the vectors `inward`.
    pub products: [[Form; 3]; 3],
}

/// Where a cage is, and where its vertices go.
pub(super) struct Outline<'a> {
    pub points: &'a [Point],
    pub images: &'a [Point],
    pub edges: Vec<Edge>,
    pub faces: Vec<Face>,
}

impl<'a> Outline<'a> {
    /// Of triangles that are counter-clockwise as seen from outside of the cage.
    pub fn new(points: &'a [Point], images: &'a [Point], triangles: &[[u32; 3]]) -> Outline<'a> {
        let mut numbers = BTreeMap::new();
        for corners in triangles {
            for k in 0..3 {
                let [a, b] = [corners[k], corners[(k + 1) % 3]];
                let count = numbers.len() as u32;
                numbers.entry([a.min(b), a.max(b)]).or_insert(count);
            }
        }
        let mut ends = vec![[0; 2]; numbers.len()];
        numbers.iter().for_each(|(&pair, &number)| ends[number as usize] = pair);
        let at = |v: u32| points[v as usize];
        let edges = ends.iter().map(|&[a, b]| edge(at(a), at(b), [a, b])).collect();
        let faces = triangles
            .iter()
            .map(|&corners| {
                let number = |a: u32, b: u32| numbers[&[a.min(b), a.max(b)]];
                let [a, b, c] = corners;
                face(corners.map(at), corners, [number(b, c), number(c, a), number(a, b)])
            })
            .collect();
        Outline { points, images, edges, faces }
    }
}

fn edge(a: Point, b: Point, ends: [u32; 2]) -> Edge {
    let along = difference(b, a);
    Edge { ends, along, length: size(along), by_square: dot(along, along).inverse() }
}

fn face(points: [Point; 3], corners: [u32; 3], edges: [u32; 3]) -> Face {
    let sides = three(|k| difference(points[(k + 2) % 3], points[(k + 1) % 3]));
    let across = cross(sides[0], sides[1]);
    let twice_area = size(across);
    let outward = times(twice_area.inverse(), across);
    let inward = sides.map(|side| times(size(side).inverse(), cross(outward, side)));
    let by_height = sides.map(|side| size(side) * twice_area.inverse());
    let products = inward.map(|a| inward.map(|b| dot(a, b)));
    Face { corners, edges, normal: outward.map(|x| -x), inward, by_height, products }
}
