//! Enclosures hold what is computed otherwise.

use super::chart::{Cell, Chart};
use super::cover::{Cover, Outcome};
use super::determinant::{Enclosure, Fit, Frame};
use super::outline::{Outline, Point};

/// Weights of vertices by angles and normals of spherical triangles (Ju, Schaefer, Warren 2005; Floater, Kos, Reimers 2005),
/// where no point lies in the plane of a face.
fn map(points: &[Point], images: &[Point], triangles: &[[u32; 3]], x: Point) -> Point {
    let sub = |a: Point, b: Point| [0, 1, 2].map(|k| a[k] - b[k]);
    let dot = |a: Point, b: Point| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: Point, b: Point| [(1, 2), (2, 0), (0, 1)].map(|(k, l)| a[k] * b[l] - a[l] * b[k]);
    let (mut total, mut sum) = (0.0, [0.0; 3]);
    for triangle in triangles {
        let to = triangle.map(|v| sub(points[v as usize], x));
        let mut mean = [0.0; 3];
        let mut normals = [[0.0; 3]; 3];
        for k in 0..3 {
            let [a, b] = [to[(k + 1) % 3], to[(k + 2) % 3]];
            let normal = cross(a, b);
            let size = dot(normal, normal).sqrt();
            normals[k] = normal.map(|c| c / size);
            let angle = size.atan2(dot(a, b));
            (0..3).for_each(|l| mean[l] += 0.5 * angle * normals[k][l]);
        }
        for k in 0..3 {
            let weight = dot(normals[k], mean) / dot(normals[k], to[k]);
            let image = images[triangle[k] as usize];
            total += weight;
            (0..3).for_each(|l| sum[l] += weight * image[l]);
        }
    }
    sum.map(|c| c / total)
}

fn determinant_by_differences(points: &[Point], images: &[Point], triangles: &[[u32; 3]], x: Point, h: f64) -> f64 {
    let column = |k: usize| {
        let at = |by: f64| {
            let mut y = x;
            y[k] += by;
            map(points, images, triangles, y)
        };
        let [a, b, c, d] = [at(h), at(-h), at(2.0 * h), at(-2.0 * h)];
        [0, 1, 2].map(|l| (8.0 * (a[l] - b[l]) - (c[l] - d[l])) / (12.0 * h))
    };
    let [a, b, c] = [0, 1, 2].map(column);
    (0..3).map(|k| a[k] * (b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3])).sum()
}

/// A cube with a notch: an edge and two vertices where it is not convex.
fn notched() -> (Vec<Point>, Vec<[u32; 3]>) {
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.25], [1.0, 2.0], [0.0, 2.0]];
    let points = [0.0, 1.5].iter().flat_map(|&z| outline.map(|[x, y]| [x, y, z])).collect();
    let top = [[6, 7, 9], [7, 8, 9], [6, 9, 11], [9, 10, 11]];
    let bottom = top.map(|[a, b, c]: [u32; 3]| [a - 6, c - 6, b - 6]);
    let sides = (0..6u32).flat_map(|k| {
        let next = (k + 1) % 6;
        [[k, next, next + 6], [k, next + 6, k + 6]]
    });
    (points, top.into_iter().chain(bottom).chain(sides).collect())
}

fn bent(points: &[Point]) -> Vec<Point> {
    let bend = |&[x, y, z]: &Point| [x + 0.2 * y * z, y - 0.15 * x * x + 0.1 * z, z + 0.1 * x * y];
    points.iter().map(bend).collect()
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 11) as f64 / 2f64.powi(53)
    }
}

#[test]
fn determinants_lie_in_their_enclosures() {
    let (points, triangles) = notched();
    let images = bent(&points);
    let outline = Outline::new(&points, &images, &triangles);
    let cover = Cover::new(&outline);
    let mut random = Random(5);
    let mut known = [0; 3];
    for (number, (chart, cell)) in cover.cells().into_iter().enumerate().filter(|(n, _)| n % 3 == 0) {
        let frame = Frame::new(&outline, chart);
        let level = match chart {
            Chart::Open => 0,
            Chart::Vertex { .. } => 1,
            Chart::Edge { .. } => 2,
        };
        for width in [1e-3, 3e-2] {
            let small: Cell = cell.map(|[low, high]| {
                let from = low + (high - low) * (1.0 - width) * (0.05 + 0.95 * random.next());
                [from, from + width * (high - low)]
            });
            let Some(Enclosure { determinant: found, .. }) = frame.enclose(&small, &Fit::IDENTITY) else { continue };
            if !found.deviation().is_finite() {
                continue;
            }
            known[level] += 1;
            let at = small.map(|[low, high]| low + (high - low) * random.next());
            let place = chart.place(&outline, &at.map(|x| [x, x]));
            let origin = chart.origin(&outline);
            let x = [0, 1, 2].map(|k| origin[k] + place.position[k].value.middle);
            let expected = determinant_by_differences(&points, &images, &triangles, x, 1e-4);
            let miss = (found.middle - expected).abs() - found.deviation();
            assert!(miss < 1e-5 * (1.0 + expected.abs()), "{number} {chart:?} {small:?} {x:?} {found:?} {expected}");
        }
    }
    assert!(known.iter().all(|&count| count > 20), "{known:?}");
}

#[test]
fn bends_are_proved() {
    let (points, triangles) = notched();
    let images = bent(&points);
    let outline = Outline::new(&points, &images, &triangles);
    let cover = Cover::new(&outline);
    let mut counts = [0; 3];
    let mut all = Vec::new();
    let n: usize = std::env::var("NTH").map_or(1, |x| x.parse().unwrap());
    let begin = std::time::Instant::now();
    for (chart, cell) in cover.cells().into_iter().enumerate().filter(|(k, _)| k % n == 0).map(|(_, x)| x) {
        let level = match chart {
            Chart::Open => 0,
            Chart::Vertex { .. } => 1,
            Chart::Edge { .. } => 2,
        };
        match cover.bound(chart, cell, 30_000) {
            Outcome::Positive(count) => {
                counts[level] += count;
                all.push((count, level, format!("{chart:?} {cell:?}")));
            }
            other => all.push((3000, level, format!("{chart:?} {cell:?} {other:?}"))),
        }
    }
    all.sort_by(|a, b| b.0.cmp(&a.0));
    for line in &all[..all.len().min(30)] {
        println!("{line:?}");
    }
    let count = |level: usize| all.iter().filter(|x| x.1 == level).count();
    println!("{counts:?} of {:?} {:?}", [0, 1, 2].map(count), begin.elapsed());
}

#[test]
fn explore() {
    let (points, triangles) = notched();
    let images = bent(&points);
    let outline = Outline::new(&points, &images, &triangles);
    let cover = Cover::new(&outline);
    let mut random = Random(7);
    for (chart, cell) in cover.cells().into_iter().enumerate().filter(|(n, _)| n % 37 == 0).map(|(_, x)| x) {
        let frame = Frame::new(&outline, chart);
        let middle = cell.map(|[low, high]| low + (high - low) * random.next());
        print!("{chart:?} {middle:?}: ");
        for width in [0.2, 0.1, 0.05, 0.02, 0.01, 0.001] {
            let small = [0, 1, 2].map(|k| {
                let half = 0.5 * width * (cell[k][1] - cell[k][0]);
                [middle[k] - half, middle[k] + half]
            });
            let begin = std::time::Instant::now();
            let Some(Enclosure { fit, .. }) = frame.enclose(&middle.map(|x| [x, x]), &Fit::IDENTITY) else { continue };
            let Some(Enclosure { determinant: found, .. }) = frame.enclose(&small, &fit) else {
                print!("none ");
                continue;
            };
            print!(
                "{:.3}+-{:.1e} (slopes {:.1e}; {:?}) ",
                found.middle,
                found.radius,
                found.deviation() - found.radius,
                begin.elapsed() / 2
            );
        }
        println!();
    }
}

#[test]
fn local() {
    let (points, images, triangles) = bars();
    let outline = Outline::new(&points, &images, &triangles);
    let cover = Cover::new(&outline);
    for (chart, cell) in cover.cells().into_iter().enumerate().filter(|(k, _)| k % 31 == 0).map(|(_, x)| x) {
        if matches!(chart, Chart::Open) || matches!(chart, Chart::Vertex { .. }) {
            continue;
        }
        let frame = Frame::new(&outline, chart);
        println!("{chart:?} {cell:?}");
        for share in [0.25, 0.5] {
            let middle = [0, 1, 2].map(|k| cell[k][0] + [0.4, 0.5, share][k] * (cell[k][1] - cell[k][0]));
            let Some(Enclosure { fit, determinant, .. }) = frame.enclose(&middle.map(|x| [x, x]), &Fit::IDENTITY)
            else {
                continue;
            };
            print!("  {middle:?} {:.3}+-{:.1e}:", determinant.middle, determinant.radius);
            for axis in 0..4 {
                print!(" | ");
                for width in [0.4, 0.2, 0.1, 0.05] {
                    let small = [0, 1, 2].map(|k: usize| {
                        let half = if k == axis || axis == 3 { 0.5 * width * (cell[k][1] - cell[k][0]) } else { 0.0 };
                        [middle[k] - half, middle[k] + half]
                    });
                    match frame.enclose(&small, &fit) {
                        Some(found) => print!(" {:.1e}", found.determinant.radius),
                        None => print!(" none"),
                    }
                }
            }
            println!();
        }
    }
}

fn bars() -> (Vec<Point>, Vec<Point>, Vec<[u32; 3]>) {
    let read = |name: &str| {
        let text = std::fs::read_to_string(format!("../../testdata/cages/{name}.obj")).unwrap();
        let rows = |kind: &str| -> Vec<Vec<f64>> {
            let kind = kind.to_owned();
            text.lines()
                .filter(|l| l.starts_with(&kind))
                .map(|l| l.split_whitespace().skip(1).map(|x| x.split('/').next().unwrap().parse().unwrap()).collect())
                .collect()
        };
        let points: Vec<Point> = rows("v ").iter().map(|r| [r[0], r[1], r[2]]).collect();
        let faces: Vec<[u32; 3]> = rows("f ").iter().map(|r| [0, 1, 2].map(|k| r[k] as u32 - 1)).collect();
        (points, faces)
    };
    let (points, triangles) = read("bar");
    (points, read("bar_twisted").0, triangles)
}

#[test]
fn bar() {
    let (points, images, triangles) = bars();
    let steps: f64 = std::env::var("STEPS").map_or(1.0, |x| x.parse().unwrap());
    let images: Vec<Point> =
        points.iter().zip(&images).map(|(a, b)| [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) / steps)).collect();
    let outline = Outline::new(&points, &images, &triangles);
    let cover = Cover::new(&outline);
    let n: usize = std::env::var("NTH").map_or(1, |x| x.parse().unwrap());
    let begin = std::time::Instant::now();
    println!("fold: {:?}", cover.sampled_fold());
    let mut all = Vec::new();
    let mut counts = [0; 3];
    for (chart, cell) in cover.cells().into_iter().enumerate().filter(|(k, _)| k % n == 0).map(|(_, x)| x) {
        let level = match chart {
            Chart::Open => 0,
            Chart::Vertex { .. } => 1,
            Chart::Edge { .. } => 2,
        };
        match cover.bound(chart, cell, 4_000) {
            Outcome::Positive(count) => {
                counts[level] += count;
                all.push((count, level, format!("{chart:?} {cell:?}")));
            }
            other => all.push((4000, level, format!("{chart:?} {cell:?} {other:?}"))),
        }
    }
    all.sort_by(|a, b| b.0.cmp(&a.0));
    for line in &all[..all.len().min(40)] {
        println!("{line:?}");
    }
    let count = |level: usize| all.iter().filter(|x| x.1 == level).count();
    println!("{counts:?} of {:?} {:?}", [0, 1, 2].map(count), begin.elapsed());
}
