//! Composite harmonic maps (Schneider 2017, chapter 5), in the piecewise-linear form that can be certified.
//!
//! Source and target are triangulated and flattened, each by a discrete harmonic map, onto one convex polygon, or onto
//! one flat cylinder if they have a hole. `docs/theory/polygons.md` says why this gives a homeomorphism.

mod boundary;
mod flatten;
mod landmarks;
mod mesh;
mod middle;
mod optimize;
mod turns;

pub use landmarks::{Landmark, LandmarkError, landmark_map};

use homeo_core::planar::{DomainPair, PlanarDomain, Point2};

use crate::map::{BoundaryPoint, Distortion, Half, HalfParts, HarmonicMap, Middle};
use crate::progress::Progress;
pub(crate) use flatten::{Laplace, Weights};

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
    /// weights fail at the end and equal ones are taken. Domains with a hole: as averaged lengths.
    Optimized(Distortion),
}

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HarmonicParams {
    /// About how many triangles source and target get, each; more where they are narrow.
    pub triangles: usize,
    /// The domain between them.
    pub middle: MiddleShape,
    /// For domains with a hole: by how many degrees the inner ring turns against the outer one. Rounded to what the
    /// vertices allow; `None` for the least turn.
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
    /// More than one hole.
    #[error("the domain has {0} holes; composite harmonic maps are made for none or one")]
    TooManyHoles(usize),
    /// The domain could not be triangulated.
    #[error("the domain could not be triangulated: {0}")]
    Triangulation(String),
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
    if holes > 1 {
        return Err(HarmonicError::TooManyHoles(holes));
    }
    progress.stage("prepare");
    let turns = turns::of_pair(pair, params.turn_degrees);
    let mut middle = middle::middle(pair, params.middle, turns.ahead);
    let is_cylinder = middle.is_cylinder();
    let triangulate = |domain| Triangulated::new(domain, params.triangles, is_cylinder, progress);
    let (source, target) = (triangulate(&pair.source)?, triangulate(&pair.target)?);
    if let (MiddleShape::Optimized(energy), false) = (params.middle, is_cylinder) {
        progress.stage("optimize");
        middle = optimize::optimized(&[&source, &target], &middle.rings()[0], energy, progress)?;
    }
    progress.stage("harmonic");
    let source = source.flatten(&middle, 0, "source", progress)?;
    Ok(HarmonicMap::new(middle.clone(), source, target.flatten(&middle, turns.of_target, "target", progress)?))
}

fn go_on(progress: &impl Progress) -> Result<(), HarmonicError> {
    if progress.is_cancelled() { Err(HarmonicError::Cancelled) } else { Ok(()) }
}

/// A domain that is triangulated, not yet flattened.
pub(crate) struct Triangulated {
    pub domain: PlanarDomain,
    /// Vertices on the boundary, which come first.
    pub boundary: Vec<BoundaryPoint>,
    /// Where they lie, ring by ring.
    rings: Vec<Vec<Point2>>,
    /// Where all vertices lie, rounded.
    pub positions: Vec<Point2>,
    mesh: mesh::Mesh,
}

impl Triangulated {
    /// About so many triangles, more where the domain is narrow; no edge joins two vertices of one ring if it `is_cylinder`.
    pub fn new(
        domain: &PlanarDomain,
        triangles: usize,
        is_cylinder: bool,
        progress: &impl Progress,
    ) -> Result<Self, HarmonicError> {
        progress.stage("triangulate");
        let largest_area = area(domain) / triangles.max(1) as f64;
        // Triangles with equal sides and this area.
        let spacing = (largest_area * 4.0 / 3f64.sqrt()).sqrt();
        let boundary = boundary::boundary_points(domain, spacing, 2 * triangles + 8 * domain.vertex_count() + 2_000);
        go_on(progress)?;
        let mut rings: Vec<Vec<Point2>> = vec![Vec::new(); domain.rings().len()];
        for point in &boundary {
            let ring = &domain.rings()[point.ring as usize];
            let (a, b) = (ring[point.edge as usize], ring[(point.edge as usize + 1) % ring.len()]);
            let share = point.fraction();
            let there = if point.share == 0 { a } else { [0, 1].map(|x| a[x] * (1.0 - share) + b[x] * share) };
            rings[point.ring as usize].push(there);
        }
        let mut mesh = mesh::triangulate(&rings, largest_area, 10 * (triangles + boundary.len()))?;
        if is_cylinder {
            mesh.split_chords(rings[0].len());
        }
        go_on(progress)?;
        let positions: Vec<Point2> = mesh.boundary.iter().chain(&mesh.inner).copied().collect();
        Ok(Self { domain: domain.clone(), boundary, rings, positions, mesh })
    }

    /// Corners of all triangles, counter-clockwise.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.mesh.triangles
    }

    /// Flattens it; on a cylinder the inner ring is put `turns` turns ahead.
    fn flatten(
        self,
        middle: &Middle,
        turns: i8,
        side: &'static str,
        progress: &impl Progress,
    ) -> Result<HalfParts, HarmonicError> {
        let Self { domain, boundary, rings, positions, mesh } = self;
        let shifts = match middle.is_cylinder() {
            true => turns::shifts(&domain, &mesh, &rings, turns),
            false => Vec::new(),
        };
        let fixed: Vec<Point2> = boundary.iter().map(|point| middle.point(point)).collect();
        let mut first_flipped = 0;
        for weights in [Weights::Cotangent, Weights::Equal] {
            go_on(progress)?;
            let images = Laplace::new(&positions, fixed.len(), &mesh.triangles, &shifts, weights)?.solve(&fixed);
            let parts = HalfParts {
                domain: domain.clone(),
                boundary: boundary.clone(),
                inner: mesh.inner.clone(),
                images,
                triangles: mesh.triangles.clone(),
                shifts: shifts.clone(),
            };
            match Half::new(parts, middle).into_parts_if_positive(middle) {
                Ok(parts) => return Ok(parts),
                Err(triangle) => first_flipped = triangle,
            }
            log::info!("{side}: triangle {first_flipped} is turned over with {weights:?} weights");
        }
        Err(HarmonicError::Flipped { side, triangle: first_flipped })
    }
}

fn area(domain: &PlanarDomain) -> f64 {
    let origin = domain.rings()[0][0];
    domain
        .edges()
        .map(|[a, b]| 0.5 * ((a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0])))
        .sum()
}
