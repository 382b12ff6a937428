//! A bumpy tube along a trefoil knot, its texture cut along three loops round the tube and one along it.

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use homeo_core::io::{Attribute, Element, Encoding, MeshFile, Values, WriteOptions, write_mesh};

use crate::pattern::{self, SQUARES};
use crate::png;

type Point = [f64; 3];

/// Quads along the tube, and round it.
const ALONG: usize = 96;
const ROUND: usize = 12;
/// Charts, one after the other along the tube.
const CHARTS: usize = 3;
/// Squares of the pattern along and across a chart; from its left side, and from one chart to the next.
const LONG: f64 = 24.0;
const WIDE: f64 = 8.0;
const LEFT: f64 = 2.0;
const NEXT: f64 = 10.0;

/// Writes the mesh as OBJ with material and image, and as PLY with fields.
pub fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    // Multiples of 1/1024: as decimals they are exact, in both files.
    let points: Vec<Point> =
        (0..ALONG * ROUND).map(|v| point(v / ROUND, v % ROUND).map(|x| (1024.0 * x).round() / 1024.0)).collect();
    let quads: Vec<[usize; 2]> = (0..ALONG * ROUND).map(|q| [q / ROUND, q % ROUND]).collect();
    let corners = |[i, j]: [usize; 2]| [[[i, j], [i + 1, j + 1], [i + 1, j]], [[i, j], [i, j + 1], [i + 1, j + 1]]];
    std::fs::write(folder.join("knot.obj"), obj(&points, quads.iter().flat_map(|&quad| corners(quad)))?)?;
    std::fs::write(folder.join("knot.mtl"), "newmtl checker\nKd 1 1 1\nmap_Kd knot.png\n")?;
    png::write(&folder.join("knot.png"), 16 * SQUARES, &pattern::image(16 * SQUARES))?;
    let triangles: Vec<[u32; 3]> =
        quads.iter().flat_map(|&quad| corners(quad)).map(|t| t.map(|place| vertex(place) as u32)).collect();
    let mesh = MeshFile { attributes: fields(&points, &triangles), ..MeshFile::from_triangles(points, &triangles) };
    write_mesh(&folder.join("knot.ply"), &mesh, &WriteOptions { encoding: Encoding::Binary })?;
    Ok(())
}

fn vertex([i, j]: [usize; 2]) -> usize {
    i % ALONG * ROUND + j % ROUND
}

/// A point of the tube: round the knot in the plane across it.
fn point(i: usize, j: usize) -> Point {
    let (t, angle) = (TAU * i as f64 / ALONG as f64, TAU * j as f64 / ROUND as f64);
    let along = [t.cos() + 4.0 * (2.0 * t).cos(), 4.0 * (2.0 * t).sin() - t.sin(), -3.0 * (3.0 * t).cos()];
    let bend = [-t.sin() - 8.0 * (2.0 * t).sin(), 8.0 * (2.0 * t).cos() - t.cos(), 9.0 * (3.0 * t).sin()];
    let second = unit(cross(along, bend));
    let first = cross(second, unit(along));
    let radius = 0.55 * (1.0 + 0.14 * (9.0 * t + 2.0 * angle).sin());
    let middle = [t.sin() + 2.0 * (2.0 * t).sin(), t.cos() - 2.0 * (2.0 * t).cos(), -(3.0 * t).sin()];
    std::array::from_fn(|k| middle[k] + radius * (angle.cos() * first[k] + angle.sin() * second[k]))
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Point) -> Point {
    let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.map(|x| x / length)
}

fn obj(points: &[Point], triangles: impl Iterator<Item = [[usize; 2]; 3]>) -> Result<String, std::fmt::Error> {
    let mut text = String::from("# A bumpy tube along a trefoil knot, made for this project (CC0).\nmtllib knot.mtl\n");
    for [x, y, z] in points {
        writeln!(text, "v {x} {y} {z}")?;
    }
    let steps = ALONG / CHARTS;
    for chart in 0..CHARTS {
        for (i, j) in (0..=steps).flat_map(|i| (0..=ROUND).map(move |j| (i, j))) {
            let u = (LEFT + LONG * i as f64 / steps as f64) / SQUARES as f64;
            // Downwards, so that the texture is not mirrored.
            let v = (NEXT * chart as f64 + WIDE - WIDE * j as f64 / ROUND as f64) / SQUARES as f64;
            writeln!(text, "vt {u:.5} {v:.5}")?;
        }
    }
    writeln!(text, "usemtl checker")?;
    for triangle in triangles {
        // The quad of a triangle begins with its first corner, which says the chart.
        let chart = triangle[0][0] / steps;
        let place = |[i, j]: [usize; 2]| chart * (steps + 1) * (ROUND + 1) + (i - chart * steps) * (ROUND + 1) + j;
        let corner = triangle.map(|at| format!("{}/{}", vertex(at) + 1, place(at) + 1));
        writeln!(text, "f {} {} {}", corner[0], corner[1], corner[2])?;
    }
    Ok(text)
}

/// A temperature at vertices; for triangles a load per area and the number of their chart.
fn fields(points: &[Point], triangles: &[[u32; 3]]) -> Vec<Attribute> {
    let attribute = |name: &str, element, values| Attribute { name: name.to_owned(), element, components: 1, values };
    let temperature = points.iter().map(|[x, y, z]| 20.0 + 5.0 * x - 3.0 * y + 2.0 * z * z).collect();
    let height = |t: &[u32; 3]| t.iter().map(|&v| points[v as usize][2]).sum::<f64>() / 3.0;
    let load = triangles.iter().map(|t| 1.0 + height(t).max(0.0)).collect();
    let chart = (0..triangles.len()).map(|t| (t * CHARTS / triangles.len()) as i64).collect();
    vec![
        attribute("temperature", Element::Vertex, Values::F64(temperature)),
        attribute("load", Element::Polygon, Values::F64(load)),
        attribute("chart", Element::Polygon, Values::I64(chart)),
    ]
}
