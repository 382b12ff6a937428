//! Cells of charts that cover the inside of a cage, and the sign of the determinant in each.
//!
//! All cells of the box about the cage are covered. A cell is done with if it is outside; if it lies where a chart of a vertex or
//! an edge stands; or if the determinant is positive in it. A chart of a vertex covers a cube about it, one of an edge a
//! cone about the nearer part of the edge; they too have cells outside, and those of a vertex leave what is about edges to
//! their charts. How large cubes and cones are is a matter of speed only.

use super::chart::{Cell, Chart, main_axis};
use super::determinant::{Enclosure, Fit, Frame};
use super::inside::is_inside;
use super::jet::{cross, dot, minus};
use super::outline::{Outline, Point};
use crate::parallel::in_parallel;
use std::collections::VecDeque;

/// So far along an edge its charts go from either end, in parts of it: beyond the middle, so that they overlap.
const REACH: f64 = 0.6;
/// Of distances that are rounded.
const SPARE: f64 = 1e-9;
/// Parts of the box about the cage that are begun with, along each axis.
const PARTS: usize = 8;
/// After so many cuts it is looked afresh along which parameter the determinant bends.
const AFRESH: u32 = 6;

/// How large cubes at vertices are, and cones at edges.
pub(super) struct Cover<'a> {
    outline: &'a Outline<'a>,
    /// Half of the side.
    cubes: Vec<f64>,
    /// For each edge from either end: the slope in the coordinates across its main axis.
    cones: Vec<[f64; 2]>,
}

/// A cell that waits.
struct Waiting {
    cell: Cell,
    fit: Fit,
    is_inside: bool,
    /// How much the determinant bends along each parameter.
    bends: [f64; 3],
    depth: u32,
}

/// How a chart's cell ends.
#[derive(Debug)]
pub(super) enum Outcome {
    /// After so many enclosures.
    Positive(u64),
    /// At a point inside the cage.
    Negative(Point),
    /// Near a point.
    Undecided(Point),
}

impl<'a> Cover<'a> {
    pub fn new(outline: &'a Outline<'a>) -> Cover<'a> {
        let at = |v: u32| outline.points[v as usize];
        let ends = |edge: usize| outline.edges[edge].ends.map(at);
        let others = |v: u32| (0..outline.edges.len()).filter(move |&e| !outline.edges[e].ends.contains(&v));
        let cube = |v: u32| {
            let far = |edge: usize| 0.7 * distance([at(v), at(v)], ends(edge)) / 3f64.sqrt();
            let own = (0..outline.edges.len()).filter(|&e| outline.edges[e].ends.contains(&v));
            let along = own.map(|edge| 0.5 * main_axis(minus(ends(edge)[0], ends(edge)[1])).1.abs());
            others(v).map(far).chain(along).fold(f64::INFINITY, f64::min)
        };
        let cone = |edge: usize, turned: bool| {
            let [a, b] = outline.edges[edge].ends;
            let [a, b] = if turned { [b, a] } else { [a, b] };
            let along = minus(at(b), at(a));
            let end = [0, 1, 2].map(|k| at(a)[k] + REACH * along[k]);
            let slope = (0..outline.edges.len()).filter(|&e| e != edge).map(|e| {
                let [c, d] = outline.edges[e].ends;
                if ![c, d].contains(&a) {
                    return 0.8 * distance([at(a), end], ends(e)) / (1.5 * REACH * main_axis(along).1.abs());
                }
                let other = minus(at(if c == a { d } else { c }), at(a));
                let [sine, cosine] = [norm(cross(along, other)), dot(along, other)];
                0.6 * if cosine > 0.0 { sine / (norm(along) * norm(other)) } else { 1.0 }
            });
            slope.fold(0.5, f64::min)
        };
        let cubes = (0..outline.points.len() as u32).map(cube).collect();
        let cones = (0..outline.edges.len()).map(|edge| [false, true].map(|turned| cone(edge, turned))).collect();
        Cover { outline, cubes, cones }
    }

    /// Charts with cells that cover the inside.
    pub fn cells(&self) -> Vec<(Chart, Cell)> {
        let mut cells = Vec::new();
        let ends = |k: usize| {
            let all = self.outline.points.iter().map(|p| p[k]);
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [x.min(low), x.max(high)])
        };
        let cuts = [0, 1, 2].map(ends).map(|[low, high]| {
            let cut = |i: usize| if i == PARTS { high } else { low + (high - low) * (i as f64 / PARTS as f64) };
            (0..=PARTS).map(cut).collect::<Vec<f64>>()
        });
        let parts = |k: usize| cuts[k].windows(2).map(|pair| [pair[0], pair[1]]);
        for x in parts(0) {
            parts(1).for_each(|y| parts(2).for_each(|z| cells.push((Chart::Open, [x, y, z]))));
        }
        for vertex in 0..self.outline.points.len() as u32 {
            for (axis, side) in (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
                let cell = [[0.0, self.cubes[vertex as usize]], [-1.0, 1.0], [-1.0, 1.0]];
                cells.push((Chart::Vertex { vertex, axis, side }, cell));
            }
        }
        for (edge, it) in (0..).zip(&self.outline.edges) {
            let [main, far] = self.reach(edge);
            for (vertex, slope) in it.ends.into_iter().zip(self.cones[edge as usize]) {
                let across = (0..3).filter(|&axis| axis as f64 != main).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]);
                let cell = [[0.0, far], [0.0, slope], [-1.0, 1.0]];
                cells.extend(across.map(|(axis, side)| (Chart::Edge { vertex, edge, axis, side }, cell)));
            }
        }
        cells
    }

    /// The main axis of an edge, and how far its charts reach along it.
    fn reach(&self, edge: u32) -> [f64; 2] {
        let [a, b] = self.outline.edges[edge as usize].ends.map(|v| self.outline.points[v as usize]);
        let (axis, far) = main_axis(minus(b, a));
        [axis as f64, REACH * far.abs()]
    }

    /// Whether the charts of vertices and edges cover a cell of another one.
    pub fn is_covered(&self, chart: Chart, cell: &Cell) -> bool {
        match chart {
            Chart::Open => {
                let corners = corners(cell);
                let from = |v: usize| corners.map(|corner| minus(corner, self.outline.points[v]));
                (0..self.cubes.len()).any(|v| {
                    let half = self.cubes[v] * (1.0 - SPARE);
                    from(v).iter().flatten().all(|x| x.abs() <= half)
                }) || (0..self.cones.len()).any(|edge| self.is_in_cones(edge, from))
            }
            Chart::Vertex { vertex, axis, side } => {
                let [_, first, second] = *cell;
                let mut intervals = [[side; 2]; 3];
                [intervals[(axis + 1) % 3], intervals[(axis + 2) % 3]] = [first, second];
                // No farther along than the chart of the edge goes.
                let corners = corners(&intervals).map(|corner| corner.map(|x| x * self.cubes[vertex as usize]));
                let own = (0..self.cones.len()).filter(|&edge| self.outline.edges[edge].ends.contains(&vertex));
                own.into_iter().any(|edge| self.is_in_cone(edge, vertex, &corners))
            }
            Chart::Edge { .. } => false,
        }
    }

    fn is_in_cones(&self, edge: usize, from: impl Fn(usize) -> [Point; 8]) -> bool {
        self.outline.edges[edge].ends.iter().any(|&v| self.is_in_cone(edge, v, &from(v as usize)))
    }

    /// Whether points, given from one end, lie in the cone of an edge at that end.
    fn is_in_cone(&self, edge: usize, end: u32, points: &[Point; 8]) -> bool {
        let [a, b] = self.outline.edges[edge].ends;
        let turned = end == b;
        let [from, to] = if turned { [b, a] } else { [a, b] }.map(|v| self.outline.points[v as usize]);
        let along = minus(to, from);
        let (axis, far) = main_axis(along);
        let slope = self.cones[edge][usize::from(turned)] * (1.0 - SPARE);
        points.iter().all(|point| {
            let t = point[axis] / far;
            let is_near = (0..3).all(|k| (point[k] - t * along[k]).abs() <= slope * point[axis].abs());
            t > 0.0 && t <= REACH * (1.0 - SPARE) && is_near
        })
    }

    /// The first of some points at which the determinant is negative: middles of cells, and near edges and vertices, where a
    /// map folds first.
    pub fn sampled_fold(&self) -> Option<Point> {
        let fold = |(chart, cell): &(Chart, Cell)| {
            let frame = Frame::new(self.outline, *chart);
            let folds = |at: &Cell| {
                let is_negative = |found: Enclosure| found.determinant.is_negative();
                self.side(&frame, at) == Some(true) && frame.enclose(at, &Fit::IDENTITY).is_some_and(is_negative)
            };
            samples(*chart, cell).iter().find(|at| folds(at)).map(|at| self.middle(*chart, at))
        };
        in_parallel(&self.cells(), fold).into_iter().flatten().next()
    }

    /// The side on which a cell that no face meets lies; none if that is not clear.
    fn is_inside(&self, chart: Chart, cell: &Cell) -> Option<bool> {
        let middle = self.middle(chart, cell);
        let size = middle.iter().chain(self.outline.points.iter().flatten()).fold(0.0, |size, x| x.abs().max(size));
        // The point of the cell is in this box.
        let about = middle.map(|x| [x - SPARE * SPARE.sqrt() * size, x + SPARE * SPARE.sqrt() * size]);
        let corner = |v: u32| self.outline.points[v as usize];
        let triangles = self.outline.faces.iter().map(|face| face.corners.map(corner));
        Frame::new(self.outline, Chart::Open).is_clear(&about).then(|| is_inside(triangles, middle))
    }

    /// The point in the middle of a cell, rounded.
    fn middle(&self, chart: Chart, cell: &Cell) -> Point {
        let middle = cell.map(|[low, high]| [0.5 * low + 0.5 * high; 2]);
        let place = chart.place(self.outline, &middle);
        let origin = chart.origin(self.outline);
        [0, 1, 2].map(|k| origin[k] + place.position[k].value.middle)
    }

    /// Bounds the determinant in a cell, halving it until its sign is known, with no more enclosures than `most`.
    pub fn bound(&self, chart: Chart, cell: Cell, most: u64) -> Outcome {
        let frame = Frame::new(self.outline, chart);
        let even = cell.map(|[low, high]| 1.0 / (high - low));
        // Large cells first: a fold shows before the places where it ends are bisected without end.
        let mut waiting =
            VecDeque::from([Waiting { cell, fit: Fit::IDENTITY, is_inside: false, bends: even, depth: 0 }]);
        let mut count = 0;
        while let Some(Waiting { cell, mut fit, is_inside, mut bends, depth }) = waiting.pop_front() {
            if self.is_covered(chart, &cell) {
                continue;
            }
            let is_inside = is_inside
                || match self.side(&frame, &cell) {
                    Some(false) => continue,
                    known => known == Some(true),
                };
            if count == most {
                return Outcome::Undecided(self.middle(chart, &cell));
            }
            count += 1;
            let mut is_known = false;
            if let Some(found) = frame.enclose(&cell, &fit) {
                if found.determinant.is_positive() {
                    continue;
                }
                if found.determinant.is_negative() && is_inside {
                    return Outcome::Negative(self.middle(chart, &cell));
                }
                is_known = found.determinant.deviation().is_finite();
                fit = found.fit;
            }
            if depth % AFRESH == 0 {
                bends = self::bends(&frame, &cell).unwrap_or(bends);
            }
            // Where nothing is known what bends is not what matters.
            let by = if is_known { bends } else { even };
            let shares = [0, 1, 2].map(|k| by[k] * (cell[k][1] - cell[k][0]));
            for half in halves(&cell, shares) {
                waiting.push_back(Waiting { cell: half, fit, is_inside, bends, depth: depth + 1 });
            }
        }
        Outcome::Positive(count)
    }

    fn side(&self, frame: &Frame, cell: &Cell) -> Option<bool> {
        if frame.is_clear(cell) { self.is_inside(frame.chart, cell) } else { None }
    }
}

/// Some points of a cell that is begun with.
fn samples(chart: Chart, cell: &Cell) -> Vec<Cell> {
    let counts = match chart {
        Chart::Open => [1; 3],
        Chart::Vertex { .. } => [1, 4, 4],
        Chart::Edge { .. } => [3, 1, 4],
    };
    let at = |axis: usize, number: usize| {
        let [low, high] = cell[axis];
        // What vanishes at the end of the chart is small.
        let is_small = counts[axis] == 1 && !matches!(chart, Chart::Open);
        let part = if is_small { 0.1 } else { (number as f64 + 0.5) / counts[axis] as f64 };
        [low + part * (high - low); 2]
    };
    let numbers = (0..counts[0]).flat_map(|i| (0..counts[1]).flat_map(move |j| (0..counts[2]).map(move |k| [i, j, k])));
    numbers.map(|numbers| [0, 1, 2].map(|axis| at(axis, numbers[axis]))).collect()
}

/// How much the determinant bends along each parameter: what is not known of it on a line through the middle grows with
/// the square of its length.
fn bends(frame: &Frame, cell: &Cell) -> Option<[f64; 3]> {
    let middle = cell.map(|[low, high]| [0.5 * low + 0.5 * high; 2]);
    let fit = frame.enclose(&middle, &Fit::IDENTITY)?.fit;
    let mut bends = [0.0; 3];
    for axis in 0..3 {
        let mut line = middle;
        let [low, high] = cell[axis];
        line[axis] = [0.55 * low + 0.45 * high, 0.45 * low + 0.55 * high];
        bends[axis] = frame.enclose(&line, &fit)?.determinant.radius.sqrt() / (high - low);
    }
    bends.iter().all(|x| x.is_finite()).then_some(bends)
}

/// Cut across the side with the greatest share.
fn halves(cell: &Cell, shares: [f64; 3]) -> [Cell; 2] {
    let axis = (1..3).fold(0, |best, k| if shares[k] > shares[best] { k } else { best });
    let [low, high] = cell[axis];
    let middle = 0.5 * low + 0.5 * high;
    let with = |interval: [f64; 2]| {
        let mut half = *cell;
        half[axis] = interval;
        half
    };
    [with([low, middle]), with([middle, high])]
}

fn corners(cell: &Cell) -> [Point; 8] {
    [0, 1, 2, 3, 4, 5, 6, 7].map(|n| [cell[0][n & 1], cell[1][n >> 1 & 1], cell[2][n >> 2]])
}

fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// Between two segments, rounded: at a critical point of the lines, or from an end.
fn distance(first: [Point; 2], second: [Point; 2]) -> f64 {
    let [u, v] = [minus(first[1], first[0]), minus(second[1], second[0])];
    let w = minus(second[0], first[0]);
    let [uu, uv, vv, uw, vw] = [dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)];
    let size = uu * vv - uv * uv;
    let [s, t] = [(uw * vv - uv * vw) / size, (uw * uv - uu * vw) / size];
    let unit = 0.0..=1.0;
    if unit.contains(&s) && unit.contains(&t) {
        return norm([0, 1, 2].map(|k| w[k] + t * v[k] - s * u[k]));
    }
    let to = |p: Point, [a, b]: [Point; 2]| {
        let [d, e] = [minus(b, a), minus(p, a)];
        let t = (dot(d, e) / dot(d, d)).clamp(0.0, 1.0);
        let t = if t.is_nan() { 0.0 } else { t };
        norm([0, 1, 2].map(|k| e[k] - t * d[k]))
    };
    let ends = first.map(|p| to(p, second)).into_iter().chain(second.map(|p| to(p, first)));
    ends.fold(f64::INFINITY, f64::min)
}
