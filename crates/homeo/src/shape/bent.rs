//! What paths by curvature have in common: the two ends, and shapes of given edges that are bent as given.

use super::closing::closing_turns;
use super::ring::{Measures, place_at, ring_of_edges, shorter_way};
use super::{ShapeError, mix};

/// Two rings that turn as often as each other.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ends {
    rings: [Vec<[f64; 2]>; 2],
    source: Measures,
    target: Measures,
    /// The turn from one mean direction to the other, less whole turns.
    rotation: f64,
}

impl Ends {
    /// Measures both.
    pub fn new(source: Vec<[f64; 2]>, target: Vec<[f64; 2]>) -> Result<Self, ShapeError> {
        let (a, b) = (Measures::new(&source)?, Measures::new(&target)?);
        if a.turning_number != b.turning_number {
            return Err(ShapeError::TurningNumbers { here: a.turning_number, there: b.turning_number });
        }
        let rotation = shorter_way(b.mean_direction() - a.mean_direction());
        Ok(Self { rotation, rings: [source, target], source: a, target: b })
    }

    /// What source and target are made of.
    pub fn measures(&self) -> [&Measures; 2] {
        [&self.source, &self.target]
    }

    /// The ring as it was given, at times 0 and 1.
    pub fn stored(&self, t: f64) -> Option<Vec<[f64; 2]>> {
        (t == 0.0 || t == 1.0).then(|| self.rings[t as usize].clone())
    }

    /// Turning angles near the wanted ones that close the shape of edges of given lengths.
    pub fn closed(&self, t: f64, wanted: &[f64], weights: &[f64], lengths: &[f64]) -> Result<Vec<f64>, ShapeError> {
        closing_turns(wanted, weights, lengths, self.source.turning_number as f64)
            .map_err(|open| ShapeError::NotClosed { t, residual: open.0 })
    }

    /// The shape of given edges and turning angles, its mean direction, perimeter and centroid between those of the ends.
    pub fn ring(&self, t: f64, lengths: &[f64], turns: &[f64]) -> Vec<[f64; 2]> {
        let turned = |direction: &mut f64, turn: &f64| {
            *direction += turn;
            Some(*direction)
        };
        let mut directions: Vec<f64> = turns.iter().scan(0.0, turned).collect();
        let mean: f64 = lengths.iter().zip(&directions).map(|(length, direction)| length * direction).sum();
        let shift = self.source.mean_direction() + t * self.rotation - mean;
        directions.iter_mut().for_each(|direction| *direction += shift);
        let perimeter = mix(t, self.source.perimeter, self.target.perimeter);
        ring_of_edges(lengths, &directions, perimeter, place_at(t, &self.source, &self.target))
    }
}

/// Half the length of both edges at each vertex; edge `i` begins in vertex `i`.
pub(super) fn half_edges(lengths: &[f64]) -> Vec<f64> {
    let n = lengths.len();
    (0..n).map(|i| 0.5 * (lengths[(i + n - 1) % n] + lengths[i])).collect()
}
