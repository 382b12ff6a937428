//! Enclosures hold what is computed otherwise, and charts cover the inside.

use super::chart::{Cell, Chart, main_axis};
use super::cover::{Cover, Outcome};
use super::determinant::{Enclosure, Fit, Frame};
use super::outline::{Outline, Point};

#[path = "../../tests/support/spatial.rs"]
mod spatial;

/// A block with a notch: an edge and two vertices where it is not convex, and faces in one plane.
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
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 11) as f64 / 2f64.powi(53)
    }
}

fn level(chart: Chart) -> usize {
    match chart {
        Chart::Open => 0,
        Chart::Vertex { .. } => 1,
        Chart::Edge { .. } => 2,
    }
}

/// Cells of all charts, many of them across planes of faces and some across faces. They are narrow: without the slopes a quarter
/// would not hold what they should.
#[test]
fn determinants_lie_in_their_enclosures() {
    let (points, triangles) = notched();
    let images = bent(&points);
    let outline = Outline::new(&points, &images, &triangles);
    let cover = Cover::new(&outline);
    let mut random = Random(5);
    let (mut known, mut without_slopes) = ([0; 3], [0; 3]);
    for (chart, cell) in cover.cells() {
        let frame = Frame::new(&outline, chart);
        for width in [3e-3, 3e-3, 1e-2, 3e-2] {
            let small: Cell = cell.map(|[low, high]| {
                let from = low + (high - low) * (1.0 - width) * (0.05 + 0.95 * random.unit());
                [from, from + width * (high - low)]
            });
            let middle = small.map(|[low, high]| [0.5 * low + 0.5 * high; 2]);
            let Some(Enclosure { fit, .. }) = frame.enclose(&middle, &Fit::IDENTITY) else { continue };
            let Some(Enclosure { determinant: found, .. }) = frame.enclose(&small, &fit) else { continue };
            let at = [0, 1, 2].map(|_| if random.unit() < 0.5 { 0.0 } else { 1.0 });
            let corner = [0, 1, 2].map(|k| small[k][0] + (small[k][1] - small[k][0]) * at[k]);
            let place = chart.place(&outline, &corner.map(|x| [x, x]));
            let origin = chart.origin(&outline);
            let x = [0, 1, 2].map(|k| origin[k] + place.position[k].value.middle);
            if !found.deviation().is_finite() || spatial::winding(&points, &triangles, x) < 0.5 {
                continue;
            }
            let expected = spatial::determinant([&points, &images], &triangles, x, 1e-4);
            let there = found.middle + (0..3).map(|k| found.slopes[k] * (2.0 * at[k] - 1.0)).sum::<f64>();
            let miss = (there - expected).abs();
            assert!(miss < found.radius + 2e-6, "{chart:?} {small:?} {x:?} {found:?} {expected}");
            known[level(chart)] += 1;
            without_slopes[level(chart)] += usize::from((found.middle - expected).abs() > found.radius + 2e-6);
        }
    }
    let is_telling = |(&known, without): (&usize, usize)| known > 30 && 4 * without > known;
    assert!(known.iter().zip(without_slopes).all(is_telling), "{known:?} {without_slopes:?}");
}

/// What is left to a chart of a vertex or an edge is in one.
#[test]
fn charts_hold_what_is_left_to_them() {
    let (points, triangles) = notched();
    let outline = Outline::new(&points, &points, &triangles);
    let cover = Cover::new(&outline);
    let cells = cover.cells();
    let is_in_chart = |at: Point| {
        cells.iter().any(|(chart, [r, s, _])| {
            let origin = chart.origin(&outline);
            let from = [0, 1, 2].map(|k| at[k] - origin[k]);
            let far = from.iter().fold(0.0, |far: f64, x| x.abs().max(far));
            match *chart {
                Chart::Open => false,
                Chart::Vertex { axis, side, .. } => far == side * from[axis] && far <= r[1],
                Chart::Edge { axis, side, .. } => {
                    let Some(along) = chart.along_edge(&outline) else { return false };
                    let along = along.map(|x| x.middle);
                    let (main, sign) = main_axis(along);
                    let t = from[main] / sign;
                    let across = [0, 1, 2].map(|k| from[k] - t * along[k]);
                    let most = across.iter().fold(0.0, |far: f64, x| x.abs().max(far));
                    t > 0.0 && t <= r[1] && most == side * across[axis] && most <= s[1] * t
                }
            }
        })
    };
    let (mut random, mut covered) = (Random(9), 0);
    for _ in 0..4000 {
        let at = [2.0, 2.0, 1.5].map(|size| size * random.unit());
        let about = at.map(|x| [x - 1e-12, x + 1e-12]);
        if cover.is_covered(Chart::Open, &about) {
            assert!(is_in_chart(at), "{at:?}");
            covered += 1;
        }
    }
    assert!((100..3900).contains(&covered), "{covered}");
}

/// One cell of each kind of a map that does not fold, and one that does.
#[test]
fn cells_are_decided() {
    let (points, triangles) = notched();
    let images = bent(&points);
    let outline = Outline::new(&points, &images, &triangles);
    let cover = Cover::new(&outline);
    let open = [[0.9, 1.1], [0.9, 1.1], [0.6, 0.8]];
    assert!(matches!(cover.bound(Chart::Open, open, 2000), Outcome::Positive(1..)));
    let beyond = [[1.2, 1.4], [1.6, 1.8], [0.6, 0.8]];
    assert!(matches!(cover.bound(Chart::Open, beyond, 100), Outcome::Positive(0)));
    let corner = Chart::Vertex { vertex: 9, axis: 1, side: -1.0 };
    let below = [[0.0, 0.1], [-0.5, -0.4], [-0.1, 0.0]];
    assert!(matches!(cover.bound(corner, below, 300), Outcome::Positive(1..)));
    let mirrored: Vec<Point> = points.iter().map(|&[x, y, z]| [-x, y, z]).collect();
    let outline = Outline::new(&points, &mirrored, &triangles);
    let cover = Cover::new(&outline);
    assert!(cover.sampled_fold().is_some());
    assert!(matches!(cover.bound(Chart::Open, open, 100), Outcome::Negative(_)));
    assert!(matches!(cover.bound(corner, below, 300), Outcome::Negative(_)));
}
