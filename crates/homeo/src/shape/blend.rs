//! Paths of closed curves by curvature.

use super::bent::{Ends, half_edges};
use super::curvature::CurvatureProfile;
use super::{ShapeError, ShapePath, check_time, mix};

/// Nodes of the joint partition that are closer than this part of the mean distance become one.
const CLOSE_NODES: f64 = 1e-6;

/// Curvature and length of two closed curves move evenly, but for a least correction that closes the curve.
///
/// The curves are given by samples, the denser the better, each by as many as one likes; first samples correspond, and
/// points at the same part of the length. Nodes of the joint partition are where either has a sample. The edges between
/// nodes keep their parts of the length; turning angles are those of the mixed curvature, corrected so that
/// `sum (b - a)^2 / w`, the square of the change of curvature in the mean, is least: then the change is linear in the
/// place. The mean direction (whole turns taken off as for
/// [`LengthsAndAngles`](super::LengthsAndAngles)), the length and the centroid of the edges move evenly.
///
/// # Guarantee
/// Shapes close to `1e-12` of their length and turn as often as the curves; the correction is a stationary point of the
/// least-squares problem. Between times 0 and 1 there is a vertex for each node, [`Self::vertex_count`]; at 0 and 1
/// there are the samples as given. Where the curves have different nodes the path so jumps at 0 and 1, by second order
/// in the distance of samples; where they have the same, it does not. Shapes may meet themselves: see
/// [`first_not_simple`](super::first_not_simple).
///
/// # References
/// Schneider 2017, section 3.3. There the mean lacks the weights of nodes, the angle between the last edge and the
/// first is free, and the start moves evenly with a tangent that vanishes between opposite ones.
///
/// # Example
/// ```
/// use std::f64::consts::TAU;
/// use homeo::shape::{CurvatureBlend, ShapePath, sample_closed};
/// let ellipse = |a: f64, b: f64| move |u: f64| [a * (TAU * u).cos(), b * (TAU * u).sin()];
/// let path = CurvatureBlend::new(sample_closed(ellipse(2.0, 1.0), 90), sample_closed(ellipse(1.0, 2.0), 120))?;
/// assert_eq!(path.at(0.5)?[0].len(), path.vertex_count());
/// assert!(path.correction(0.5)? < 0.1);
/// # Ok::<(), homeo::shape::ShapeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CurvatureBlend {
    ends: Ends,
    /// Parts of the length from node to node.
    lengths: Vec<f64>,
    /// Half the length of both edges at each node.
    weights: Vec<f64>,
    /// Curvatures at the nodes.
    curvatures: [Vec<f64>; 2],
}

impl CurvatureBlend {
    /// The path between two sampled closed curves.
    ///
    /// # Errors
    /// Coordinates are out of range; an edge has length zero or runs back on the one before; the curves do not turn the
    /// same number of times.
    ///
    /// # Complexity
    /// That of sorting the nodes.
    pub fn new(source: Vec<[f64; 2]>, target: Vec<[f64; 2]>) -> Result<Self, ShapeError> {
        let ends = Ends::new(source, target)?;
        let profiles = ends.measures().map(CurvatureProfile::of);
        let nodes = joint_partition(&profiles);
        let m = nodes.len() - 1;
        let lengths: Vec<f64> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
        Ok(Self {
            weights: half_edges(&lengths),
            curvatures: profiles.map(|profile| nodes[..m].iter().map(|&node| profile.at(node)).collect()),
            lengths,
            ends,
        })
    }

    /// How many nodes the joint partition has, and shapes between have vertices: as many as both curves have samples,
    /// less those at the same part of the length.
    pub fn vertex_count(&self) -> usize {
        self.lengths.len()
    }

    /// The parts of the length from node to node, and so of the edges of all shapes between (#vertices).
    pub fn parts_of_length(&self) -> &[f64] {
        &self.lengths
    }

    /// By how much the curvature is corrected, in the mean: the root of the integral of the squared change, for length
    /// 1. Compare with `TAU`, the curvature of a circle.
    ///
    /// # Errors
    /// The time is not in `[0, 1]`, or the shape could not be closed.
    pub fn correction(&self, t: f64) -> Result<f64, ShapeError> {
        check_time(t)?;
        let (wanted, turns) = (self.wanted(t), self.closed(t)?);
        let square = |i: usize| (turns[i] - wanted[i]).powi(2) / self.weights[i];
        Ok((0..turns.len()).map(square).sum::<f64>().sqrt())
    }

    /// Turning angles of the mixed curvature.
    fn wanted(&self, t: f64) -> Vec<f64> {
        let [a, b] = &self.curvatures;
        (0..self.weights.len()).map(|i| self.weights[i] * mix(t, a[i], b[i])).collect()
    }

    /// Turning angles that close the shape.
    fn closed(&self, t: f64) -> Result<Vec<f64>, ShapeError> {
        self.ends.closed(t, &self.wanted(t), &self.weights, &self.lengths)
    }
}

impl ShapePath for CurvatureBlend {
    /// # Complexity
    /// Linear for each step of the iteration: ten steps, as a rule.
    fn at(&self, t: f64) -> Result<Vec<Vec<[f64; 2]>>, ShapeError> {
        check_time(t)?;
        match self.ends.stored(t) {
            Some(ring) => Ok(vec![ring]),
            None => Ok(vec![self.ends.ring(t, &self.lengths, &self.closed(t)?)]),
        }
    }
}

/// The nodes of both, from 0 to 1, but of close ones the first.
fn joint_partition(profiles: &[CurvatureProfile; 2]) -> Vec<f64> {
    let mut all: Vec<f64> = profiles.iter().flat_map(|profile| profile.nodes().iter().copied()).collect();
    all.sort_by(f64::total_cmp);
    let close = CLOSE_NODES / all.len() as f64;
    let mut nodes = vec![0.0];
    for node in all {
        if node - nodes[nodes.len() - 1] > close && 1.0 - node > close {
            nodes.push(node);
        }
    }
    nodes.push(1.0);
    nodes
}
