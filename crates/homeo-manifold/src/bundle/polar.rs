//! Directions along a surface: angles round vertices that are scaled to a full turn, and transport straight on along edges.

use super::circle::CircleBundle;
use super::section::SectionError;
use super::vector::{Vector, cross, dot, plus};
use super::walls::{Side, Walls};
use std::f64::consts::{PI, TAU};

/// Angles of the sides that start at a vertex, scaled to add up to a full turn.
pub(super) struct Polar {
    /// The angle at its start of each side, counter-clockwise from the first of the fan.
    angles: Vec<[f64; 3]>,
    /// The scaled angles of the corners; the start of a side is its corner.
    corners: Vec<[f64; 3]>,
    /// The sides that start at each vertex, in order round it.
    pub fans: Vec<Vec<Side>>,
}

impl Polar {
    /// For the angles of the corners of all triangles.
    pub fn new(bundle: &CircleBundle, walls: &Walls, mut corners: Vec<[f64; 3]>) -> Result<Self, SectionError> {
        let mut angles = vec![[0.0; 3]; bundle.triangles().len()];
        let mut fans = vec![Vec::new(); bundle.vertex_count()];
        for side in walls.sides() {
            let vertex = bundle.triangles()[side.triangle as usize][usize::from(side.side)];
            if fans[vertex as usize].is_empty() {
                fans[vertex as usize] = fan(walls, side);
            }
        }
        for (vertex, fan) in (0..).zip(&fans) {
            let total: f64 = fan.iter().map(|&side| *at(&mut corners, side)).sum();
            if !(total.is_finite() && total > 0.0) {
                return Err(SectionError::Flat { vertex });
            }
            let mut sum = 0.0;
            for &side in fan {
                let corner = at(&mut corners, side);
                *corner *= TAU / total;
                *at(&mut angles, side) = sum;
                sum += *corner;
            }
        }
        Ok(Self { angles, corners, fans })
    }

    /// The scaled angle at the start of a side from the first side there.
    pub fn angle(&self, side: Side) -> f64 {
        self.angles[side.triangle as usize][usize::from(side.side)]
    }

    /// What is added to the angle of a direction when it is taken along a side, which is `back` from its other end.
    pub fn transport(&self, side: Side, back: Side) -> f64 {
        self.angle(back) - self.angle(side) + PI
    }

    /// The curvature of a triangle: what its scaled angles exceed π by.
    pub fn curvature(&self, triangle: u32) -> f64 {
        self.corners[triangle as usize].iter().sum::<f64>() - PI
    }

    /// The angle of a vector at a vertex, once it and the edges there are projected along the mean normal; nothing where
    /// nothing of the vector is left.
    pub fn direction(
        &self,
        bundle: &CircleBundle,
        places: &[Vector],
        vertex: u32,
        vector: Vector,
    ) -> Result<Option<f64>, SectionError> {
        let fan = &self.fans[vertex as usize];
        let at = |side: Side| edges_at(bundle, places, side);
        // By angles, so that it is the same when triangles are divided.
        let normal = fan.iter().fold([0.0; 3], |sum, &side| {
            let [first, second] = at(side);
            let across = cross(first, second);
            let size = dot(across, across).sqrt();
            if size > 0.0 { plus(sum, across, size.atan2(dot(first, second)) / size) } else { sum }
        });
        let square = dot(normal, normal);
        if !(square > 0.0 && vector.iter().all(|x| x.is_finite())) {
            return Err(SectionError::NoDirection { vertex });
        }
        let project = |v: Vector| plus(v, normal, -dot(v, normal) / square);
        let along = project(vector);
        // What rounding leaves of a normal vector is no direction.
        if dot(along, along) <= 1e-24 * dot(vector, vector) {
            return Ok(None);
        }
        // The turn from the first vector to the second as seen from outside, from -π to π.
        let turn = |a: Vector, b: Vector| dot(cross(a, b), normal).atan2(dot(a, b) * square.sqrt());
        let mut nearest = (f64::INFINITY, 0.0);
        for (number, &side) in fan.iter().enumerate() {
            let [first, second] = at(side).map(project);
            let (whole, part) = (turn(first, second), turn(first, along));
            let end = fan.get(number + 1).map_or(TAU, |&next| self.angle(next));
            if part >= 0.0 && part <= whole {
                let share = if whole > 0.0 { part / whole } else { 0.0 };
                return Ok(Some(self.angle(side) + (end - self.angle(side)) * share));
            }
            // A fan that is folded over may leave a gap when it is projected: then the nearest side counts.
            if part.abs() < nearest.0 {
                nearest = (part.abs(), self.angle(side));
            }
        }
        Ok(Some(nearest.1))
    }
}

/// The angles of the corners of all triangles, for places of their vertices.
pub(super) fn corner_angles(bundle: &CircleBundle, places: &[Vector]) -> Vec<[f64; 3]> {
    let angle = |side: Side| {
        let [first, second] = edges_at(bundle, places, side);
        let across = cross(first, second);
        dot(across, across).sqrt().atan2(dot(first, second))
    };
    (0..bundle.triangles().len() as u32).map(|t| [0, 1, 2].map(|side| angle(Side::new(t, side)))).collect()
}

/// An angle less full turns, from -π to π.
pub(super) fn reduced(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
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

fn at(values: &mut [[f64; 3]], side: Side) -> &mut f64 {
    &mut values[side.triangle as usize][usize::from(side.side)]
}
