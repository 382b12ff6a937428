//! Images under whatever a map file holds.

use std::fmt;

use homeo::cage::{CageEvaluationError, CageEvaluator};
use homeo::certificate::{PlanarMap, StoredMap};
use homeo::map::{
    Bijection, Enclosed, Enclosed2, EvaluationError, HarmonicMap, PlanarEvaluationError, Shell, ShellEvaluationError,
};
use homeo_core::number::Rational;
use rayon::prelude::*;

/// Which way points go.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From the mesh or polygon onto the target; in a shell, onto its other section, or onto the middle surface.
    Forward,
    /// Back to it; in a shell, onto the source surface.
    Inverse,
}

/// Why a point has no image.
pub enum NoImage {
    Map(EvaluationError),
    Shell(ShellEvaluationError),
    Planar(PlanarEvaluationError),
    Cages(CageEvaluationError),
    /// It has one that is no rational number.
    NotRational,
}

impl NoImage {
    /// Whether the point has several.
    pub fn is_ambiguous(&self) -> bool {
        matches!(self, Self::Map(EvaluationError::Ambiguous(..)) | Self::Shell(ShellEvaluationError::Ambiguous(..)))
    }
}

impl fmt::Display for NoImage {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Map(error) => error.fmt(formatter),
            Self::Shell(error) => error.fmt(formatter),
            Self::Planar(error) => error.fmt(formatter),
            Self::Cages(error) => error.fmt(formatter),
            Self::NotRational => formatter.write_str("the image is not rational"),
        }
    }
}

/// An image or none.
pub type Image<I> = Result<I, NoImage>;

/// Images in floating point, in parallel; the order is that of the points.
pub fn floating(map: &StoredMap, direction: Direction, points: &[[f64; 3]]) -> Vec<Image<Enclosed>> {
    match map {
        StoredMap::Foliation(map) => floating_in_map(map, direction, points),
        StoredMap::Shell(shell) => {
            let one = |&point: &[f64; 3]| match direction {
                Direction::Forward => shell.to_section(point),
                Direction::Inverse => shell.to_source(point),
            };
            points.par_iter().map(|point| one(point).map_err(NoImage::Shell)).collect()
        }
        StoredMap::Moved(map) => floating_in_map(map.as_bijection(), direction, points),
        StoredMap::Cages(map) => {
            let evaluator = CageEvaluator::new(map);
            let one = |&point: &[f64; 3]| match direction {
                Direction::Forward => evaluator.forward(point),
                Direction::Inverse => evaluator.inverse(point),
            };
            points.par_iter().map(|point| one(point).map_err(NoImage::Cages)).collect()
        }
        StoredMap::Planar(map) => {
            let map = map.as_bijection();
            let one = |&[x, y, _]: &[f64; 3]| match direction {
                Direction::Forward => map.forward([x, y]),
                Direction::Inverse => map.inverse([x, y]),
            };
            let in_space = |Enclosed2 { point: [x, y], radius }| Enclosed { point: [x, y, 0.0], radius };
            points.par_iter().map(|point| one(point).map(in_space).map_err(NoImage::Planar)).collect()
        }
    }
}

/// Images in rationals, likewise.
pub fn exact(map: &StoredMap, direction: Direction, points: &[[Rational; 3]]) -> Vec<Image<[Rational; 3]>> {
    let one = |point: &[Rational; 3]| match map {
        StoredMap::Foliation(map) => exact_in_map(map, direction, point).map_err(NoImage::Map),
        StoredMap::Moved(map) => exact_in_map(map.as_bijection(), direction, point).map_err(NoImage::Map),
        StoredMap::Shell(shell) => exact_in_shell(shell, direction, point).map_err(NoImage::Shell),
        StoredMap::Planar(PlanarMap::Harmonic(map)) => exact_in_plane(map, direction, point).map_err(NoImage::Planar),
        StoredMap::Planar(PlanarMap::Composite(_) | PlanarMap::Complex(_)) | StoredMap::Cages(_) => {
            Err(NoImage::NotRational)
        }
    };
    points.par_iter().map(one).collect()
}

fn floating_in_map(map: &dyn Bijection, direction: Direction, points: &[[f64; 3]]) -> Vec<Image<Enclosed>> {
    let images = match direction {
        Direction::Forward => map.forward_batch(points),
        Direction::Inverse => map.inverse_batch(points),
    };
    images.into_iter().map(|image| image.map_err(NoImage::Map)).collect()
}

fn exact_in_map(
    map: &dyn Bijection,
    direction: Direction,
    point: &[Rational; 3],
) -> Result<[Rational; 3], EvaluationError> {
    match direction {
        Direction::Forward => map.forward_exact(point),
        Direction::Inverse => map.inverse_exact(point),
    }
}

fn exact_in_plane(
    map: &HarmonicMap,
    direction: Direction,
    [x, y, _]: &[Rational; 3],
) -> Result<[Rational; 3], PlanarEvaluationError> {
    let point = [x.clone(), y.clone()];
    let [x, y] = match direction {
        Direction::Forward => map.forward_exact(&point),
        Direction::Inverse => map.inverse_exact(&point),
    }?;
    Ok([x, y, Rational::ZERO])
}

fn exact_in_shell(
    shell: &Shell,
    direction: Direction,
    point: &[Rational; 3],
) -> Result<[Rational; 3], ShellEvaluationError> {
    match direction {
        Direction::Forward => Ok(shell.to_section_exact(&shell.project_exact(point)?)?.point),
        Direction::Inverse => Ok(shell.to_source_exact(&shell.project_exact(point)?)?.point),
    }
}
