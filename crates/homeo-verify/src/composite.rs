//! Rules D and C1-C3: a composite mean value map is a homeomorphism between planar domains.
//!
//! *Theorem.* Let the vertices of two domains correspond, and let the Jacobian determinant of the mean value map be
//! positive at every point of the open first domain. Then the map is a homeomorphism of the closed domains, linear on every
//! edge: it takes the rings to the rings, so its degree over a point is 1 inside the second domain and 0 outside; every
//! preimage counts +1. So is a composition of such maps. (Proof, and the formulas near edges and vertices:
//! `docs/theory/composite.md`.)

use crate::map_file::CompositeData;
use crate::mean_value::{Chart, Frame, Step};
use crate::number::{Point, orientation_2d};
use crate::parallel::in_parallel;
use crate::rings::Rings;
use crate::verdict::{Checked, Obstacle, Stop, check, refuted};
use std::cmp::Ordering;
use std::collections::{BTreeSet, VecDeque};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// So many boxes of one chart are bounded at most: some ten seconds of work for a few hundred vertices.
const BOXES_PER_CHART: u32 = 300_000;
/// Charts that are bounded before it is seen whether one fails: a fixed number, so that the first one found does not
/// depend on the number of threads.
const CHUNK: usize = 256;

/// Applies the rules and counts what was checked.
pub(crate) fn check_composite(data: &CompositeData) -> Checked<Vec<(&'static str, u64)>> {
    let is_finite = |points: &[Point]| points.iter().flatten().all(|x| x.is_finite());
    let all_finite = data.stages.iter().all(|points| is_finite(points));
    check(all_finite, "C1", "a vertex of a polygon is not finite", &[], &[])?;
    for (number, points) in data.stages.iter().enumerate() {
        Rings { points, sizes: &data.ring_sizes }.check_domain(&format!("domain {number}"))?;
    }
    let rings = Rings { points: &data.stages[0], sizes: &data.ring_sizes };
    let boundary: Vec<[u32; 2]> = rings.edges().collect();
    for (number, tiling) in data.tilings.iter().enumerate() {
        check(is_finite(&tiling.added), "C1", &format!("an added point of step {number} is not finite"), &[], &[])?;
        let corners: Vec<Point> = data.stages[number].iter().chain(&tiling.added).copied().collect();
        check_tiling("C2", &format!("step {number}"), &corners, &tiling.triangles, &boundary)?;
    }
    let mut boxes = 0;
    for number in 0..data.tilings.len() {
        boxes += check_step(data, number, &boundary)?;
    }
    let triangles = data.tilings.iter().map(|tiling| tiling.triangles.len() as u64 / 3).sum();
    Ok(vec![
        ("edges of all domains that meet in common ends only (rule D)", (data.stages.len() * boundary.len()) as u64),
        ("triangles that tile the domains, edge to edge (rule C2)", triangles),
        ("steps whose Jacobian determinant is positive everywhere (rule C3)", data.tilings.len() as u64),
        ("boxes that it is bounded in (rule C3)", boxes),
    ])
}

/// Rule C2, and K2: all triangles are counter-clockwise, no two use an edge alike, and those used once only are the boundary's.
pub(crate) fn check_tiling(
    name: &'static str,
    of: &str,
    corners: &[Point],
    triangles: &[u32],
    boundary: &[[u32; 2]],
) -> Checked {
    let mut edges = BTreeSet::new();
    for (t, triangle) in triangles.as_chunks::<3>().0.iter().enumerate() {
        let rule = |holds: bool, what: &str| check(holds, name, &format!("{what} ({of})"), &[t], triangle);
        let exist = triangle.iter().all(|&v| (v as usize) < corners.len());
        rule(exist, "a triangle has a corner that does not exist")?;
        let [a, b, c] = triangle.map(|v| corners[v as usize]);
        rule(orientation_2d(a, b, c) == Ordering::Greater, "a triangle is turned over or flat")?;
        for k in 0..3 {
            rule(edges.insert([triangle[k], triangle[(k + 1) % 3]]), "two triangles use an edge alike")?;
        }
    }
    let mut expected: BTreeSet<_> = boundary.iter().copied().collect();
    for &[a, b] in &edges {
        let is_expected = expected.remove(&[a, b]);
        let message = format!("an edge is neither between two triangles nor on the boundary, or both ({of})");
        check(edges.contains(&[b, a]) != is_expected, name, &message, &[], &[a, b])?;
    }
    let message = format!("an edge of the domain belongs to no triangle ({of})");
    check(expected.is_empty(), name, &message, &[], expected.first().map_or(&[], |edge| &edge[..]))
}

/// What is known of a chart: how many boxes it took, or where it fails or is undecided.
enum Outcome {
    Positive(u64),
    Negative([f64; 2]),
    Undecided([f64; 2]),
}

/// Rule C3: the determinant is positive in all charts. Counts the boxes.
fn check_step(data: &CompositeData, number: usize, boundary: &[[u32; 2]]) -> Checked<u64> {
    let tiling = &data.tilings[number];
    let [points, images, added] = [&data.stages[number], &data.stages[number + 1], &tiling.added].map(|p| flat(p));
    let [next, previous] = neighbours(boundary);
    let step = Step { points: &points, images: &images, added: &added, next: &next, previous: &previous, speeds: None };
    let map = format!("the mean value map of step {number}");
    check_determinant(&step, &tiling.triangles, "C3", &map, "more domains between source and target")
}

/// Points of the plane without their third coordinates.
pub(crate) fn flat(points: &[Point]) -> Vec<[f64; 2]> {
    points.iter().map(|&[x, y, _]| [x, y]).collect()
}

/// The next and the previous vertex of each, by all edges.
pub(crate) fn neighbours(boundary: &[[u32; 2]]) -> [Vec<u32>; 2] {
    let (mut next, mut previous) = (vec![0; boundary.len()], vec![0; boundary.len()]);
    boundary.iter().for_each(|&[a, b]| (next[a as usize], previous[b as usize]) = (b, a));
    [next, previous]
}

/// Rules C3 and K3: the determinant of a map, which is named in messages, is positive in all charts. Counts the boxes.
pub(crate) fn check_determinant(
    step: &Step,
    triangles: &[u32],
    rule: &'static str,
    map: &str,
    remedy: &str,
) -> Checked<u64> {
    let triangles = triangles.as_chunks::<3>().0;
    let charts: Vec<(usize, Chart)> = triangles
        .iter()
        .enumerate()
        .flat_map(|(t, &corners)| step.charts(corners).into_iter().map(move |c| (t, c)))
        .collect();
    let place = |chart: &Chart, at: [f64; 2]| chart.place(step.corner(chart.apex()), at);
    let fold = |t: usize, chart: &Chart, at: [f64; 2]| {
        let message = format!("{map} folds round the point {:?}", place(chart, at));
        Err(refuted(rule, message, &[t], &triangles[t]))
    };
    // What folds a lot shows at once; else all other charts would be bounded first.
    for (t, chart) in &charts {
        if let Some(at) = sampled_fold(step, chart) {
            return fold(*t, chart, at);
        }
    }
    let (mut boxes, failed) = (0, AtomicUsize::new(usize::MAX));
    // The first chart that fails is the answer: none after one that has failed matters.
    let bound_unless_failed = |&number: &usize| {
        if number > failed.load(Relaxed) {
            return Outcome::Undecided([0.0; 2]);
        }
        let outcome = bound(step, &charts[number].1);
        if !matches!(outcome, Outcome::Positive(_)) {
            failed.fetch_min(number, Relaxed);
        }
        outcome
    };
    let numbers: Vec<usize> = (0..charts.len()).collect();
    for chunk in numbers.chunks(CHUNK) {
        for (outcome, &number) in in_parallel(chunk, bound_unless_failed).into_iter().zip(chunk) {
            let (t, chart) = &charts[number];
            match outcome {
                Outcome::Positive(count) => boxes += count,
                Outcome::Negative(at) => return fold(*t, chart, at),
                Outcome::Undecided(at) => {
                    return Err(Stop::Undecided(Obstacle {
                        message: format!(
                            "rule {rule}: the sign of the Jacobian determinant of {map} near {:?} is not known after \
                             {BOXES_PER_CHART} boxes",
                            place(chart, at)
                        ),
                        remedy: remedy.to_owned(),
                    }));
                }
            }
        }
    }
    Ok(boxes)
}

/// A point inside a chart at which the determinant is enclosed and negative, among a few.
fn sampled_fold(step: &Step, chart: &Chart) -> Option<[f64; 2]> {
    let mut frame = Frame::new(step, chart);
    let shares = [0.01, 0.25, 0.5, 0.75, 0.99];
    let mut points = shares.iter().flat_map(|&s| shares.map(|lambda| [s, lambda]));
    points.find(|&[s, lambda]| frame.enclose([s; 2], [lambda; 2]).determinant.is_negative())
}

/// Bounds the determinant in a chart, halving boxes until its sign is known.
fn bound(step: &Step, chart: &Chart) -> Outcome {
    let mut frame = Frame::new(step, chart);
    // Large boxes first: a fold shows before the places where it ends are bisected without end.
    let mut waiting = VecDeque::from([[[0.0, 1.0], [0.0, 1.0]]]);
    let mut boxes = 0;
    while let Some([s, lambda]) = waiting.pop_front() {
        let middle = [s, lambda].map(|[low, high]| 0.5 * (low + high));
        if boxes == BOXES_PER_CHART {
            return Outcome::Undecided(middle);
        }
        boxes += 1;
        let found = frame.enclose(s, lambda);
        if found.determinant.is_negative() {
            return Outcome::Negative(middle);
        }
        if !found.determinant.is_positive() {
            match found.splits_lambda {
                true => waiting.extend([[s, [lambda[0], middle[1]]], [s, [middle[1], lambda[1]]]]),
                false => waiting.extend([[[s[0], middle[0]], lambda], [[middle[0], s[1]], lambda]]),
            }
        }
    }
    Outcome::Positive(boxes.into())
}
