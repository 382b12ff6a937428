//! The section of a field of vectors on a surface in space: its directions, how they turn along edges, and their levels.

use super::charts::ends;
use super::circle::CircleBundle;
use super::identification::{Identification, pairs};
use super::polar::{Polar, corner_angles, reduced};
use super::refine::Carrier;
use super::section::{Section, SectionError, closed_walls};
use super::vector::{Vector, near_one};
use super::walls::{Side, Walls, sides_by_ends};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// Directions that are nearer to opposite than this are: rounding is far less where triangles have angles at all.
const TIE: f64 = 1e-9;

/// See [`Section::of_field`]; `places` and `vectors` are those of the vertices that are not added.
pub(super) fn section<'b>(
    bundle: &'b CircleBundle,
    added: &[Carrier],
    places: &[Vector],
    vectors: &[Vector],
) -> Result<Section<'b>, SectionError> {
    let count = bundle.vertex_count() - added.len().min(bundle.vertex_count());
    if let Some(given) = [places.len(), vectors.len()].into_iter().find(|&given| given != count) {
        return Err(SectionError::Count { given, count });
    }
    let walls = closed_walls(bundle)?;
    // Neither the size of the surface nor that of a vector matters, only directions do.
    let mut all = near_one(places);
    for carrier in added {
        all.push(carrier.point(&all));
    }
    let polar = Polar::new(bundle, &walls, corner_angles(bundle, &all))?;
    let given =
        (0..).zip(vectors).map(|(vertex, &vector)| polar.direction(bundle, &all, vertex, near_one(&[vector])[0]));
    let field = Field::new(bundle, &walls, &polar, given.collect::<Result<_, _>>()?, added)?;
    let identification = Identification::new(bundle, &walls, &polar)?;
    Ok(field.section(&identification))
}

/// Directions at the vertices of the surface below a bundle.
pub(super) struct Field<'a, 'b> {
    bundle: &'b CircleBundle,
    walls: &'a Walls,
    polar: &'a Polar,
    /// Angles; nothing where the field is zero.
    directions: Vec<Option<f64>>,
}

impl<'a, 'b> Field<'a, 'b> {
    /// The field with these directions, and with ones between them at the added vertices.
    ///
    /// # Errors
    /// Neighbours that have opposite directions, or both none.
    pub fn new(
        bundle: &'b CircleBundle,
        walls: &'a Walls,
        polar: &'a Polar,
        directions: Vec<Option<f64>>,
        added: &[Carrier],
    ) -> Result<Self, SectionError> {
        let given = directions.len() as u32;
        let mut field = Self { bundle, walls, polar, directions };
        for (side, back) in pairs(walls) {
            let [first, second] = ends(bundle.triangles(), side);
            if first.max(second) < given {
                let turn = field.turn(side, back);
                unless_tied(turn, [first, second])?;
            }
        }
        field.directions.resize(bundle.vertex_count(), None);
        // Triangles of a bundle are a surface.
        let sides = sides_by_ends(bundle.triangles()).map_err(|_| SectionError::NotClosed { triangle: 0 })?;
        let same = |a: &Carrier, b: &Carrier| a.vertices == b.vertices && a.weights[2] == 0 && b.weights[2] == 0;
        let mut next = given;
        for group in added.chunk_by(same) {
            field.continue_along(group, next, &sides)?;
            next += group.len() as u32;
        }
        Ok(field)
    }

    /// Directions at vertices that were added to one edge, or at one in a triangle; `first` is the number of the first.
    fn continue_along(
        &mut self,
        group: &[Carrier],
        first: u32,
        sides: &HashMap<[u32; 2], Side>,
    ) -> Result<(), SectionError> {
        let Carrier { vertices: [start, end, third], weights } = group[0];
        if weights[2] > 0 {
            // In a triangle nothing is prescribed: the direction of a corner, straight on.
            let corner = [start, end, third].into_iter().find(|&corner| self.directions[corner as usize].is_some());
            let from = corner.unwrap_or(start);
            self.spread(&[from, first], self.relative(from, first, sides), 0.0, &[1.0], sides);
            return Ok(());
        }
        let path: Vec<u32> = [start].into_iter().chain(first..first + group.len() as u32).chain([end]).collect();
        let before = self.relative(start, first, sides);
        let after = self.relative(end, first + group.len() as u32 - 1, sides).map(|angle| angle + PI);
        let turn = before.zip(after).map(|(before, after)| reduced(after - before));
        unless_tied(turn.or(before.or(after).map(|_| 0.0)), [start, end])?;
        let share = |carrier: &Carrier| f64::from(carrier.weights[1]) / f64::from(carrier.weights.iter().sum::<u32>());
        let shares: Vec<f64> = group.iter().map(share).collect();
        self.spread(&path, before.or(after), turn.unwrap_or(0.0), &shares, sides);
        Ok(())
    }

    /// Gives the vertices of a straight path after its first directions that turn evenly against it.
    fn spread(&mut self, path: &[u32], angle: Option<f64>, turn: f64, shares: &[f64], sides: &HashMap<[u32; 2], Side>) {
        for (step, share) in path.windows(2).zip(shares) {
            // The way on is opposite to the way back.
            let back = sides.get(&[step[1], step[0]]).map(|&side| self.polar.angle(side) + PI);
            self.directions[step[1] as usize] = angle.zip(back).map(|(angle, back)| back + angle + share * turn);
        }
    }

    /// The angle of the direction at a vertex from the edge to another.
    fn relative(&self, from: u32, to: u32, sides: &HashMap<[u32; 2], Side>) -> Option<f64> {
        Some(self.directions[from as usize]? - self.polar.angle(*sides.get(&[from, to])?))
    }

    /// What the field turns by along a side, from -π to π: nothing where both ends are zeros, 0 where one is.
    pub fn turn(&self, side: Side, back: Side) -> Option<f64> {
        let [from, to] = ends(self.bundle.triangles(), side).map(|vertex| self.directions[vertex as usize]);
        match (from, to) {
            (Some(from), Some(to)) => Some(reduced(to - from - self.polar.transport(side, back))),
            (None, None) => None,
            _ => Some(0.0),
        }
    }

    /// Levels next to the directions, and turns that go with those of the field.
    pub fn section(&self, identification: &Identification) -> Section<'b> {
        let layers = self.bundle.layers();
        let count = f64::from(layers);
        let exact: Vec<Option<f64>> = (self.directions.iter().zip(&identification.zeros))
            .map(|(direction, zero)| direction.map(|direction| (direction - zero) * count / TAU))
            .collect();
        let mut turns = vec![[0; 3]; self.bundle.triangles().len()];
        for (side, back) in pairs(self.walls) {
            let [from, to] = ends(self.bundle.triangles(), side);
            let (Some(start), Some(end)) = (exact[from as usize], exact[to as usize]) else { continue };
            let of_field = self.turn(side, back).unwrap_or(0.0) * count / TAU + identification.lag(side);
            let turn = of_field + (end.round() - end) - (start.round() - start);
            // Turns go in steps of a whole fibre.
            let slope = self.bundle.slopes()[side.triangle as usize][usize::from(side.side)];
            let least = 2.0 * (end.round() - start.round() - f64::from(slope)) - 1.0;
            let twice = least + 2.0 * count * ((2.0 * turn - least) / (2.0 * count)).round();
            debug_assert!((twice - 2.0 * turn).abs() < 0.1, "a turn by {turn} is not {twice} / 2");
            turns[side.triangle as usize][usize::from(side.side)] = twice as i64;
            turns[back.triangle as usize][usize::from(back.side)] = -twice as i64;
        }
        // At most the number of layers, so exact.
        let level = |x: f64| (x.round().rem_euclid(count) as u32) % layers;
        Section::with_turns(self.bundle, exact.into_iter().map(|x| x.map(level)).collect(), turns)
    }
}

/// Refuses a turn by half a turn, and the turn between two zeros.
fn unless_tied(turn: Option<f64>, [first, second]: [u32; 2]) -> Result<(), SectionError> {
    match turn {
        None => Err(SectionError::Zeros { first, second }),
        Some(turn) if turn.abs() > PI - TIE => Err(SectionError::Opposite { first, second }),
        Some(_) => Ok(()),
    }
}
