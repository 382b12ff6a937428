//! Levels that are nearest to vectors on a surface in space.

use super::circle::CircleBundle;
use super::section::{SectionError, closed_walls};
use super::walls::{Side, Walls};
use std::collections::VecDeque;
use std::f64::consts::TAU;

type Vector = [f64; 3];

/// The levels of a field; see [`super::Section::from_vectors`].
pub(super) fn levels(bundle: &CircleBundle, places: &[Vector], vectors: &[Vector]) -> Result<Vec<u32>, SectionError> {
    let count = bundle.vertex_count();
    if let Some(given) = [places.len(), vectors.len()].into_iter().find(|&given| given != count) {
        return Err(SectionError::Count { given, count });
    }
    let walls = closed_walls(bundle)?;
    let polar = Polar::new(bundle, &walls, places)?;
    let zeros = polar.zeros(bundle, &walls)?;
    let layers = bundle.layers();
    let level = |vertex: u32| {
        let direction = polar.direction(bundle, places, vertex, vectors[vertex as usize])?;
        let level = f64::from(layers) * (direction - zeros[vertex as usize]) / TAU;
        // At most the number of layers, so exact.
        Ok((level.round().rem_euclid(f64::from(layers)) as u32) % layers)
    };
    (0..count as u32).map(level).collect()
}

/// Angles of the sides that start at a vertex, scaled to add up to a full turn.
struct Polar {
    /// The angle at its start of each side.
    angles: Vec<[f64; 3]>,
    /// The sides that start at each vertex, in order round it.
    fans: Vec<Vec<Side>>,
}

impl Polar {
    fn new(bundle: &CircleBundle, walls: &Walls, places: &[Vector]) -> Result<Self, SectionError> {
        let mut polar =
            Self { angles: vec![[0.0; 3]; bundle.triangles().len()], fans: vec![Vec::new(); bundle.vertex_count()] };
        for side in walls.sides() {
            let vertex = bundle.triangles()[side.triangle as usize][usize::from(side.side)];
            if polar.fans[vertex as usize].is_empty() {
                polar.fans[vertex as usize] = fan(walls, side);
            }
        }
        for (vertex, fan) in (0..).zip(&polar.fans) {
            let corners: Vec<f64> = fan.iter().map(|&side| corner_angle(bundle, places, side)).collect();
            let total: f64 = corners.iter().sum();
            if !(total.is_finite() && total > 0.0) {
                return Err(SectionError::Flat { vertex });
            }
            let mut sum = 0.0;
            for (&side, corner) in fan.iter().zip(corners) {
                polar.angles[side.triangle as usize][usize::from(side.side)] = sum * TAU / total;
                sum += corner;
            }
        }
        Ok(polar)
    }

    fn angle(&self, side: Side) -> f64 {
        self.angles[side.triangle as usize][usize::from(side.side)]
    }

    /// The direction of level 0 at each vertex: transported along a breadth-first tree of edges.
    fn zeros(&self, bundle: &CircleBundle, walls: &Walls) -> Result<Vec<f64>, SectionError> {
        let mut zeros = vec![None; bundle.vertex_count()];
        let mut waiting = VecDeque::from([0_u32]);
        if let Some(first) = zeros.first_mut() {
            *first = Some(0.0);
        }
        while let Some(here) = waiting.pop_front() {
            for &side in &self.fans[here as usize] {
                let there = bundle.triangles()[side.triangle as usize][usize::from(side.side + 1) % 3];
                let (Some(zero), None, Some(back)) = (zeros[here as usize], zeros[there as usize], walls.across(side))
                else {
                    continue;
                };
                let slope = f64::from(bundle.slopes()[side.triangle as usize][usize::from(side.side)]) + 0.5;
                let of_surface: f64 = self.angle(back) - self.angle(side) + TAU / 2.0;
                let of_bundle = slope * TAU / f64::from(bundle.layers());
                zeros[there as usize] = Some((zero + of_surface - of_bundle).rem_euclid(TAU));
                waiting.push_back(there);
            }
        }
        let apart = |vertex: usize| SectionError::NotClosed {
            triangle: self.fans[vertex].first().map_or(0, |side| side.triangle),
        };
        zeros.into_iter().enumerate().map(|(vertex, zero)| zero.ok_or_else(|| apart(vertex))).collect()
    }

    /// The angle of a vector at a vertex, between the sides that it points between once both are projected.
    fn direction(
        &self,
        bundle: &CircleBundle,
        places: &[Vector],
        vertex: u32,
        vector: Vector,
    ) -> Result<f64, SectionError> {
        let fan = &self.fans[vertex as usize];
        let at = |side: Side| edges_at(bundle, places, side);
        let normal = fan.iter().fold([0.0; 3], |sum, &side| {
            let [first, second] = at(side);
            plus(sum, cross(first, second), 1.0)
        });
        let square = dot(normal, normal);
        let project = |v: Vector| plus(v, normal, -dot(v, normal) / square);
        let along = project(vector);
        if !(square > 0.0 && dot(along, along) > 1e-24 * dot(vector, vector)) {
            return Err(SectionError::NoDirection { vertex });
        }
        // The turn from the first vector to the second as seen from outside, from -π to π.
        let turn = |a: Vector, b: Vector| dot(cross(a, b), normal).atan2(dot(a, b) * square.sqrt());
        let mut nearest = (f64::INFINITY, 0.0);
        for (number, &side) in fan.iter().enumerate() {
            let [first, second] = at(side).map(project);
            let (whole, part) = (turn(first, second), turn(first, along));
            let end = fan.get(number + 1).map_or(TAU, |&next| self.angle(next));
            if part >= 0.0 && part <= whole {
                return Ok(self.angle(side) + (end - self.angle(side)) * if whole > 0.0 { part / whole } else { 0.0 });
            }
            // A fan that is folded over may leave a gap when it is projected: then the nearest side counts.
            if part.abs() < nearest.0 {
                nearest = (part.abs(), self.angle(side));
            }
        }
        Ok(nearest.1)
    }
}

/// The sides that start at the start of a side, counter-clockwise.
fn fan(walls: &Walls, first: Side) -> Vec<Side> {
    let mut fan = vec![first];
    let mut here = first;
    while let Some(next) = walls.across(Side::new(here.triangle, (here.side + 2) % 3)).filter(|&next| next != first) {
        fan.push(next);
        here = next;
    }
    fan
}

/// The two edges at the start of a side, in order.
fn edges_at(bundle: &CircleBundle, places: &[Vector], side: Side) -> [Vector; 2] {
    let corners = bundle.triangles()[side.triangle as usize];
    let place = |k: u8| places[corners[usize::from(side.side + k) % 3] as usize];
    [1, 2].map(|k| plus(place(k), place(0), -1.0))
}

fn corner_angle(bundle: &CircleBundle, places: &[Vector], side: Side) -> f64 {
    let [first, second] = edges_at(bundle, places, side);
    let across = cross(first, second);
    dot(across, across).sqrt().atan2(dot(first, second))
}

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn plus(a: Vector, b: Vector, factor: f64) -> Vector {
    [0, 1, 2].map(|k| a[k] + factor * b[k])
}
