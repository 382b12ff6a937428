//! Composite harmonic maps (Schneider 2017, chapter 5), in the piecewise-linear form that can be certified.
//!
//! Source and target are triangulated and flattened, each by a discrete harmonic map, onto one convex polygon, or onto
//! one flat cylinder if they have a hole. With several holes both are first slit open along seams with the same ends.
//! `docs/theory/polygons.md` says why this gives a homeomorphism.

mod boundary;
mod flatten;
mod landmarks;
mod mesh;
mod middle;
mod optimize;
mod seams;
mod triangulated;
mod turns;

pub use landmarks::{Landmark, LandmarkError, landmark_map};

use homeo_core::planar::DomainPair;

use crate::map::{Distortion, HarmonicMap};
use crate::progress::Progress;
pub(crate) use flatten::{Laplace, Weights};
pub(crate) use triangulated::Triangulated;

/// Which convex polygon lies between source and target, or how the rings of the cylinder are divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MiddleShape {
    /// All edges alike (section 5, the text's default).
    Regular,
    /// Arcs in proportion to the averages of the edges' lengths in source and target, with a tenth shared out equally
    /// (section 5.3).
    #[default]
    AveragedLengths,
    /// Begun with averaged lengths, then moved to where the map distorts less (section 5.3): its mean distortion, in the
    /// sense of [`HarmonicMap::distortion`] and to rounding, is never larger than with averaged lengths, unless cotangent
    /// weights fail at the end and equal ones are taken. Domains with one hole: as averaged lengths.
    Optimized(Distortion),
}

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HarmonicParams {
    /// About how many triangles source and target get, each; more where they are narrow.
    pub triangles: usize,
    /// The domain between them.
    pub middle: MiddleShape,
    /// For domains with one hole: by how many degrees the inner ring turns against the outer one. Rounded to what the
    /// vertices allow; `None` for the least turn. Refused with several holes.
    pub turn_degrees: Option<f64>,
}

impl Default for HarmonicParams {
    fn default() -> Self {
        Self { triangles: 10_000, middle: MiddleShape::default(), turn_degrees: None }
    }
}

/// Why there is no map.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HarmonicError {
    /// A turn is asked for, and there are several holes.
    #[error("the domain has {0} holes: by how much a hole turns can be asked for one hole only")]
    TurnOfSeveralHoles(usize),
    /// The domain could not be triangulated.
    #[error("the domain could not be triangulated: {0}")]
    Triangulation(String),
    /// No way was left for a seam between two rings.
    #[error("the domain could not be slit open between its rings; more triangles may help")]
    Seams,
    /// The linear system could not be solved.
    #[error("the discrete Laplace equation could not be solved")]
    Solve,
    /// Rounding turned triangles over, whatever was tried.
    #[error(
        "triangle {triangle} of the {side}'s triangulation is turned over or flat after rounding; more triangles may help"
    )]
    Flipped {
        /// `source` or `target`.
        side: &'static str,
        /// The first one.
        triangle: usize,
    },
    /// Asked to stop.
    #[error("stopped")]
    Cancelled,
}

/// The composite harmonic map of a pair of domains.
///
/// With several holes seams are laid along short ways between near vertices of different rings, which are near in source and
/// target taken together. Of the maps that differ by how holes go round one another it is the one that takes these ways to
/// each other.
///
/// # Guarantee
/// Every triangle is counter-clockwise in its domain and in the middle, decided exactly on the numbers that are returned.
///
/// # Errors
/// [`HarmonicError`].
///
/// # Complexity
/// Two triangulations and two sparse factorizations: `O(n^1.5)` for `n` triangles.
///
/// ```
/// use homeo::construct::harmonic::{HarmonicParams, harmonic_map};
/// use homeo::map::PlanarBijection;
/// use homeo::progress::Silent;
/// use homeo_core::planar::DomainPair;
/// let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let arrow = vec![[0.0, 0.0], [1.0, 0.0], [0.4, 0.3], [0.0, 1.0]];
/// let pair = DomainPair::new(vec![square], vec![arrow]).unwrap();
/// let params = HarmonicParams { triangles: 100, ..HarmonicParams::default() };
/// let map = harmonic_map(&pair, params, &Silent).unwrap();
/// let image = map.forward([0.5, 0.5]).unwrap();
/// let back = map.inverse(image.point).unwrap();
/// assert!((back.point[0] - 0.5).abs() < 1e-12);
/// ```
pub fn harmonic_map(
    pair: &DomainPair,
    params: HarmonicParams,
    progress: &impl Progress,
) -> Result<HarmonicMap, HarmonicError> {
    let holes = pair.source.rings().len() - 1;
    if holes > 1 && params.turn_degrees.is_some() {
        return Err(HarmonicError::TurnOfSeveralHoles(holes));
    }
    progress.stage("prepare");
    let turns = turns::of_pair(pair, params.turn_degrees);
    let triangulate = |domain| Triangulated::new(domain, params.triangles, holes == 1, progress);
    let (mut source, mut target) = (triangulate(&pair.source)?, triangulate(&pair.target)?);
    let mut middle = match holes {
        0 | 1 => middle::middle(pair, params.middle, turns.ahead),
        _ => {
            progress.stage("seams");
            let (circuit, lengths) = triangulated::slit([&mut source, &mut target])?;
            middle::slit(circuit, lengths, params.middle)
        }
    };
    if let (MiddleShape::Optimized(energy), false) = (params.middle, middle.is_cylinder()) {
        progress.stage("optimize");
        let polygon = optimize::optimized(&[&source, &target], &middle.rings()[0], energy, progress)?;
        middle = middle.with_polygon(polygon);
    }
    progress.stage("harmonic");
    let source = source.flatten(&middle, 0, "source", progress)?;
    Ok(HarmonicMap::new(middle.clone(), source, target.flatten(&middle, turns.of_target, "target", progress)?))
}

fn go_on(progress: &impl Progress) -> Result<(), HarmonicError> {
    if progress.is_cancelled() { Err(HarmonicError::Cancelled) } else { Ok(()) }
}
