//! Level sets of the target's coordinates, drawn in the source as in the figures of the literature.

use super::data::{CellMesh, TargetShape};
use super::marching::{Patch, zero_set};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Coordinates are cut at the multiples of 1/8, half angles at multiples of 22.5°.
const LEVELS: usize = 7;

/// A coordinate of the target whose level sets are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coordinate {
    /// Cartesian coordinate by its axis.
    Axis(usize),
    /// Distance from the centre of disk and ball.
    Radius,
    /// Lines through the centre of the disk, half planes about the z axis of the ball.
    Angle,
    /// Cones about the z axis of the ball.
    Latitude,
}

impl Coordinate {
    /// The coordinates of a target.
    pub fn of(target: TargetShape) -> &'static [Self] {
        match target {
            TargetShape::Square => &[Self::Axis(0), Self::Axis(1)],
            TargetShape::Cube => &[Self::Axis(0), Self::Axis(1), Self::Axis(2)],
            TargetShape::Disk => &[Self::Radius, Self::Angle],
            TargetShape::Ball => &[Self::Radius, Self::Angle, Self::Latitude],
            TargetShape::Middle | TargetShape::Section => &[],
        }
    }

    /// The name in the page's controls.
    pub fn name(self, target: TargetShape) -> &'static str {
        match self {
            Self::Axis(axis) => ["x", "y", "z"][axis],
            Self::Radius => "radius",
            Self::Angle if target == TargetShape::Ball => "longitude",
            Self::Angle => "angle",
            Self::Latitude => "latitude",
        }
    }

    /// Which of the three checkerboard coordinates of the page is constant on a level set.
    pub fn checker_axis(self) -> usize {
        match self {
            Self::Axis(axis) => axis,
            Self::Radius => 0,
            Self::Angle => 1,
            Self::Latitude => 2,
        }
    }

    /// The value of level `k`, `1 <= k <= LEVELS`, and how it reads.
    fn level(self, k: usize) -> (f64, String) {
        let share = k as f64 / (LEVELS + 1) as f64;
        match self {
            Self::Axis(_) | Self::Radius => (share, format!("{share}")),
            // A whole line (or plane) shows the angle and its opposite at once.
            Self::Angle => (PI * (share - 0.125), format!("{}° and {}°", 180.0 * share - 22.5, 180.0 * share + 157.5)),
            Self::Latitude => (PI * (share - 0.5), format!("{}°", 180.0 * share - 90.0)),
        }
    }

    /// A function of the image whose zero set is the level set.
    fn offset(self, level: f64, image: [f64; 3]) -> f64 {
        let [x, y, z] = image;
        match self {
            Self::Axis(axis) => image[axis] - level,
            Self::Radius => x.hypot(y).hypot(z) - level,
            Self::Angle => level.cos() * y - level.sin() * x,
            // Homogeneous of degree one, so that the cone's tip stays at the centre.
            Self::Latitude => level.cos() * z - level.sin() * x.hypot(y),
        }
    }
}

/// One level set.
#[derive(Clone, Debug)]
pub(super) struct LevelSet {
    /// Which coordinate is constant.
    pub coordinate: Coordinate,
    /// Its number among the levels of the coordinate, from 1.
    pub number: usize,
    /// Its value in words.
    pub label: String,
    /// Its picture.
    pub patch: Patch,
}

/// All level sets of all coordinates, coordinate by coordinate.
pub(super) fn level_sets(target: TargetShape, mesh: &CellMesh) -> Vec<LevelSet> {
    let wanted: Vec<(Coordinate, usize)> =
        Coordinate::of(target).iter().flat_map(|&c| (1..=LEVELS).map(move |k| (c, k))).collect();
    let sets = wanted.into_par_iter().map(|(coordinate, number)| {
        let (level, label) = coordinate.level(number);
        let values: Vec<f64> = mesh.images.iter().map(|&image| coordinate.offset(level, image)).collect();
        LevelSet { coordinate, number, label, patch: zero_set(mesh, &values) }
    });
    sets.collect()
}

/// Thins out the levels, evenly, until they fit into so many bytes. Returns whether any was left out.
pub(super) fn fit(sets: &mut Vec<LevelSet>, budget_bytes: usize) -> bool {
    let all = sets.len();
    for kept in [&[1, 2, 3, 4, 5, 6, 7][..], &[2, 4, 6], &[4], &[]] {
        sets.retain(|set| kept.contains(&set.number));
        if sets.iter().map(|set| set.patch.packed_bytes()).sum::<usize>() <= budget_bytes {
            break;
        }
    }
    sets.len() < all
}
