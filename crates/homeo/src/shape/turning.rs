//! Paths on which every ring turns about its middle.

use homeo_core::planar::DomainPair;

use super::linear::check_rings;
use super::{ShapeError, ShapePath, check_time, mix};

/// Every ring is turned evenly about the mean of its vertices, which moves straight; what is left of the change moves straight
/// in the turning frame.
///
/// So a ring that is only turned keeps its shape on the way, however far it turns: on [straight](super::LinearPath) paths it
/// shrinks, by a half turn to a point. By how much a ring turns is known from its vertices up to whole turns.
///
/// # References
/// Alexa, Cohen-Or, Levin 2000 (doi 10.1145/344779.344859), the rotation and the rest of a linear map apart; here whole rings
/// at a time, as holes turn against the outer ring in Schneider 2017, figure 4.6.
///
/// # Example
/// ```
/// use homeo::shape::{ShapePath, TurningPath};
/// let square = vec![[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
/// let mut turned = square.clone();
/// turned.rotate_left(1);
/// let path = TurningPath::new(vec![square], vec![turned], &[450.0])?;
/// assert_eq!(path.turns_in_degrees(), [450.0]);
/// let [x, y] = path.at(0.5)?[0][0];
/// assert!(x.abs() < 1e-12 && (y + 2f64.sqrt()).abs() < 1e-12, "225 degrees further than 45: {x} {y}");
/// # Ok::<(), homeo::shape::ShapeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TurningPath {
    source: Vec<Vec<[f64; 2]>>,
    target: Vec<Vec<[f64; 2]>>,
    rings: Vec<Turning>,
}

/// A ring that turns.
#[derive(Clone, Debug, PartialEq)]
struct Turning {
    middles: [[f64; 2]; 2],
    /// In radians.
    turn: f64,
    /// The source, and the target turned back, both less their middle.
    ends: [Vec<[f64; 2]>; 2],
}

impl TurningPath {
    /// The path between rings whose vertices correspond by number. Each ring turns by the angle nearest to the given one, in
    /// degrees, among those that its vertices allow: they differ by whole turns. Rings for which nothing is given turn as little
    /// as possible.
    ///
    /// # Errors
    /// Numbers of rings or vertices differ, or coordinates are out of range.
    pub fn new(source: Vec<Vec<[f64; 2]>>, target: Vec<Vec<[f64; 2]>>, degrees: &[f64]) -> Result<Self, ShapeError> {
        check_rings(&source, &target)?;
        let wanted = degrees.iter().map(|angle| angle.to_radians()).chain(std::iter::repeat(0.0));
        let rings = source.iter().zip(&target).zip(wanted).map(|((a, b), wanted)| Turning::new(a, b, wanted)).collect();
        Ok(Self { source, target, rings })
    }

    /// The path between the rings of two domains; see [`new`](Self::new).
    ///
    /// # Errors
    /// Coordinates are out of range.
    pub fn between(pair: &DomainPair, degrees: &[f64]) -> Result<Self, ShapeError> {
        Self::new(pair.source.rings().to_vec(), pair.target.rings().to_vec(), degrees)
    }

    /// By how much each ring turns, counter-clockwise.
    pub fn turns_in_degrees(&self) -> Vec<f64> {
        self.rings.iter().map(|ring| ring.turn.to_degrees()).collect()
    }
}

impl Turning {
    fn new(source: &[[f64; 2]], target: &[[f64; 2]], wanted: f64) -> Self {
        let middles = [middle(source), middle(target)];
        let [a, b] = [(source, middles[0]), (target, middles[1])]
            .map(|(ring, middle)| ring.iter().map(|p| [p[0] - middle[0], p[1] - middle[1]]).collect::<Vec<_>>());
        // The rotation that brings the source nearest to the target, in the sense of least squares.
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (p, q) in a.iter().zip(&b) {
            cosine += p[0] * q[0] + p[1] * q[1];
            sine += p[0] * q[1] - p[1] * q[0];
        }
        let least = f64::atan2(sine, cosine);
        let turn = least + std::f64::consts::TAU * ((wanted - least) / std::f64::consts::TAU).round();
        let back = b.iter().map(|&p| turned(p, -turn)).collect();
        Self { middles, turn, ends: [a, back] }
    }

    fn at(&self, t: f64) -> Vec<[f64; 2]> {
        let [a, b] = &self.ends;
        let middle = [0, 1].map(|k| mix(t, self.middles[0][k], self.middles[1][k]));
        let place = |(p, q): (&[f64; 2], &[f64; 2])| {
            let [x, y] = turned([mix(t, p[0], q[0]), mix(t, p[1], q[1])], t * self.turn);
            [middle[0] + x, middle[1] + y]
        };
        a.iter().zip(b).map(place).collect()
    }
}

fn middle(ring: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|k| ring.iter().map(|p| p[k] / ring.len() as f64).sum())
}

fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    [cosine * x - sine * y, sine * x + cosine * y]
}

impl ShapePath for TurningPath {
    fn at(&self, t: f64) -> Result<Vec<Vec<[f64; 2]>>, ShapeError> {
        check_time(t)?;
        if t == 0.0 || t == 1.0 {
            return Ok(if t == 0.0 { self.source.clone() } else { self.target.clone() });
        }
        Ok(self.rings.iter().map(|ring| ring.at(t)).collect())
    }
}
