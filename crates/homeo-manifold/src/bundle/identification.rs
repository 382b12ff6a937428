//! A bundle as that of the unit tangent vectors of a surface with angles.
//!
//! Level `j` over a vertex stands for the direction `zero + 2π j / N`. Over an edge the two transports, that of the surface
//! and that of the bundle, take a direction to levels which differ by the edge's *lag*, a real number of levels that is
//! determined modulo `N` by the zeros. With lags that round each triangle add up to its curvature on the surface, in levels,
//! less that of the bundle, the identification of circles over vertices goes on over edges and triangles. Such lags exist
//! because both curvatures add up to the same: theorem 8 of `docs/theory/bundles.md`.

use super::charts::ends;
use super::circle::CircleBundle;
use super::polar::Polar;
use super::section::SectionError;
use super::walls::{Side, Walls};
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// Steps of the descent towards small lags; any number of them gives an identification.
const STEPS: usize = 300;

/// Zeros of vertices and lags of edges.
pub(super) struct Identification {
    /// The direction of level 0 at each vertex.
    pub zeros: Vec<f64>,
    /// The lag along each side; from the other side it is the opposite.
    lags: Vec<[f64; 3]>,
}

impl Identification {
    /// One with lags about as small as may be. Cost: linear for each step of the descent.
    ///
    /// # Errors
    /// A surface that is not connected.
    pub fn new(bundle: &CircleBundle, walls: &Walls, polar: &Polar) -> Result<Self, SectionError> {
        let zeros = zeros(bundle, walls, polar)?;
        let mut made = Self { zeros, lags: vec![[0.0; 3]; bundle.triangles().len()] };
        let layers = f64::from(bundle.layers());
        for (side, back) in pairs(walls) {
            let [from, to] = ends(bundle.triangles(), side).map(|vertex| made.zeros[vertex as usize]);
            let lag = (polar.transport(side, back) + from - to) * layers / TAU - slope(bundle, side);
            made.add(side, back, lag - layers * (lag / layers).round());
        }
        made.balance(bundle, walls, polar);
        made.relax(bundle, walls);
        Ok(made)
    }

    /// The lag along a side, in levels.
    pub fn lag(&self, side: Side) -> f64 {
        self.lags[side.triangle as usize][usize::from(side.side)]
    }

    fn add(&mut self, side: Side, back: Side, lag: f64) {
        self.lags[side.triangle as usize][usize::from(side.side)] += lag;
        self.lags[back.triangle as usize][usize::from(back.side)] -= lag;
    }

    /// Makes the sum of lags right round each triangle: what is wrong, turns of the whole fibre, goes from the leaves of a
    /// tree of triangles to its root, where nothing is left.
    fn balance(&mut self, bundle: &CircleBundle, walls: &Walls, polar: &Polar) {
        let layers = f64::from(bundle.layers());
        let wrong = |triangle: u32| {
            let sum: f64 = self.lags[triangle as usize].iter().sum();
            let of_bundle = bundle.turns(triangle).unwrap_or_default() as f64 / 2.0;
            ((sum + of_bundle) / layers - polar.curvature(triangle) / TAU).round()
        };
        let mut surplus: Vec<f64> = (0..bundle.triangles().len() as u32).map(wrong).collect();
        for (exit, entry) in tree(walls).into_iter().rev() {
            let turns = std::mem::take(&mut surplus[exit.triangle as usize]);
            self.add(exit, entry, -layers * turns);
            surplus[entry.triangle as usize] += turns;
        }
        debug_assert!(surplus.iter().all(|&turns| turns == 0.0), "curvatures of surface and bundle differ");
    }

    /// Moves zeros so that the squares of lags add up to less: conjugate gradients.
    fn relax(&mut self, bundle: &CircleBundle, walls: &Walls) {
        let edges: Vec<[u32; 2]> = pairs(walls).map(|(side, _)| ends(bundle.triangles(), side)).collect();
        let mut slack = vec![0.0; bundle.vertex_count()];
        for ((side, _), [from, to]) in pairs(walls).zip(&edges) {
            slack[*from as usize] -= self.lag(side);
            slack[*to as usize] += self.lag(side);
        }
        let shifts = least_squares(&edges, slack);
        for ((side, back), [from, to]) in pairs(walls).zip(&edges) {
            self.add(side, back, shifts[*from as usize] - shifts[*to as usize]);
        }
        let layers = f64::from(bundle.layers());
        for (zero, shift) in self.zeros.iter_mut().zip(shifts) {
            *zero += shift * TAU / layers;
        }
    }
}

/// The `x` with `L x = right` nearly, for the Laplacian `L` of a graph.
fn least_squares(edges: &[[u32; 2]], right: Vec<f64>) -> Vec<f64> {
    let product = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let mut solution = vec![0.0; right.len()];
    let (mut direction, mut rest, mut image) = (right.clone(), right, vec![0.0; solution.len()]);
    let mut size = product(&rest, &rest);
    for _ in 0..STEPS {
        image.fill(0.0);
        for [a, b] in edges.iter().map(|edge| edge.map(|vertex| vertex as usize)) {
            let difference = direction[a] - direction[b];
            image[a] += difference;
            image[b] -= difference;
        }
        let steepness = product(&direction, &image);
        // A level less on all edges together is nothing that shows.
        if !(steepness > 0.0 && size > 1e-12) {
            break;
        }
        let step = size / steepness;
        for vertex in 0..solution.len() {
            solution[vertex] += step * direction[vertex];
            rest[vertex] -= step * image[vertex];
        }
        let before = std::mem::replace(&mut size, product(&rest, &rest));
        for (direction, rest) in direction.iter_mut().zip(&rest) {
            *direction = rest + *direction * size / before;
        }
    }
    solution
}

/// The direction of level 0 at each vertex: along a breadth-first tree of edges the transports agree.
fn zeros(bundle: &CircleBundle, walls: &Walls, polar: &Polar) -> Result<Vec<f64>, SectionError> {
    let mut zeros = vec![None; bundle.vertex_count()];
    let mut waiting = VecDeque::from([0_u32]);
    if let Some(first) = zeros.first_mut() {
        *first = Some(0.0);
    }
    while let Some(here) = waiting.pop_front() {
        for &side in &polar.fans[here as usize] {
            let [_, there] = ends(bundle.triangles(), side);
            let (Some(zero), None, Some(back)) = (zeros[here as usize], zeros[there as usize], walls.across(side))
            else {
                continue;
            };
            let of_bundle = slope(bundle, side) * TAU / f64::from(bundle.layers());
            zeros[there as usize] = Some((zero + polar.transport(side, back) - of_bundle).rem_euclid(TAU));
            waiting.push_back(there);
        }
    }
    let apart = |vertex: usize| SectionError::NotClosed {
        triangle: polar.fans[vertex].first().map_or(0, |side| side.triangle),
    };
    zeros.into_iter().enumerate().map(|(vertex, zero)| zero.ok_or_else(|| apart(vertex))).collect()
}

/// The slope along a side, and a half.
pub(super) fn slope(bundle: &CircleBundle, side: Side) -> f64 {
    f64::from(bundle.slopes()[side.triangle as usize][usize::from(side.side)]) + 0.5
}

/// Each edge of a closed surface once, from both sides.
pub(super) fn pairs(walls: &Walls) -> impl Iterator<Item = (Side, Side)> + '_ {
    walls.sides().filter_map(|side| walls.across(side).map(|back| (side, back))).filter(|(side, back)| side < back)
}

/// A breadth-first tree of the triangles: for all but the first the side to the one before, and the same from there.
fn tree(walls: &Walls) -> Vec<(Side, Side)> {
    let mut is_reached = vec![false; walls.len()];
    let (mut tree, mut next) = (Vec::with_capacity(walls.len()), 0);
    let mut here = 0;
    if let Some(first) = is_reached.first_mut() {
        *first = true;
    }
    loop {
        for entry in (0..3).map(|side| Side::new(here, side)) {
            let Some(exit) = walls.across(entry) else { continue };
            if !std::mem::replace(&mut is_reached[exit.triangle as usize], true) {
                tree.push((exit, entry));
            }
        }
        let Some(&(exit, _)) = tree.get(next) else { return tree };
        (here, next) = (exit.triangle, next + 1);
    }
}
