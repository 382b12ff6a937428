//! A prismatic shell round a surface, as the domain of a bijective projection.
//!
//! Theorem:     with positive prisms, the surface between bottom and top and crossed by all pillars in one sense, and one
//!              point with one preimage and one fibre that meets it once per component, the projection is a homeomorphism.
//! Source:      Jiang, Schneider, Zorin, Panozzo 2020 (doi 10.1145/3414685.3417769), sections 3.1 to 3.4.
//! Differences: no beveling: triangles that only touch a prism do not count, which is decided exactly; boundary
//!              columns are fixed; directions by the point of a convex hull nearest to the origin.
//! Arithmetic:  every accepted operation is decided by exact signs; directions, lengths and energies only guide.
//! Cost:        about proportional to the triangles, times what a prism comes to hold.
//! Fails when:  the surface crosses or touches itself (where it may: round one vertex), or two singular vertices are
//!              neighbours on the boundary -> [`ShellError`].
//! See:         `docs/theory/shells.md`.

mod base;
pub(in crate::construct) mod directions;
mod kept;
pub(in crate::construct) mod layer;
pub(in crate::construct) mod prism;
mod sheets;
mod simplify;
mod skin;

use crate::input::SourceMesh;
use crate::map::Shell;
use crate::progress::Progress;

use base::Base;
use layer::Layer;
use prism::{Column, Failure, FailureIn};
use sheets::Sheets;

/// What shell is wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct ShellParams {
    /// Largest distance of top and bottom from the middle, relative to the longest side of the surface's box.
    pub thickness: f64,
    /// Stop when no more than this many prisms are left; 0 for as few as possible.
    pub prisms: usize,
    /// Rounds of simplification at most; with 0 the middle surface is the source itself.
    pub rounds: usize,
    /// Whether the surface may cross itself in space. The shell is then one of the abstract surface: it says which
    /// triangles belong to which prisms, and sheets that cross do not see each other.
    pub immersed: bool,
    /// Whether the shell must not overlap itself anywhere in space: bottoms, tops and walls do not meet.
    pub embedded: bool,
    /// Whether operations may make columns shorter, once they come to change little without. It gives fewer prisms and a
    /// thinner shell; for sections a thicker one with more prisms is better, as they keep nearer to the source in it.
    pub may_thin: bool,
    /// No operation makes an angle between a pillar and the normal of a triangle that it crosses larger than this, in
    /// radians, but where there was such an angle. Nowhere a right one; less than that bounds how the projection stretches.
    pub largest_angle: f64,
    /// Edges of the source whose triangles' normals differ by more than this, in radians, stay in the middle surface as
    /// chains of fewer edges.
    pub feature_angle: Option<f64>,
    /// Vertices of the source that stay vertices of the middle surface, in their place.
    pub frozen: Vec<u32>,
}

impl Default for ShellParams {
    fn default() -> Self {
        Self {
            thickness: 0.1,
            prisms: 0,
            rounds: 30,
            immersed: false,
            embedded: false,
            may_thin: true,
            largest_angle: LARGEST_ANGLE.to_radians(),
            feature_angle: None,
            frozen: Vec::new(),
        }
    }
}

/// In degrees; as in the source.
const LARGEST_ANGLE: f64 = 89.95;

/// What happened during a construction.
#[derive(Clone, Debug, Default)]
pub struct ShellInfo {
    /// Vertices without an extrusion direction, where the shell has no thickness.
    pub pinched: usize,
    /// Prisms of the first shell.
    pub first_prisms: usize,
    /// Prisms of the last one.
    pub prisms: usize,
    /// Columns that were taken away.
    pub collapses: usize,
    /// Edges of the middle surface that were flipped.
    pub flips: usize,
    /// Rounds of simplification.
    pub rounds: usize,
    /// The largest angle between a pillar of a prism and the normal of a triangle in it, in radians; below the bound
    /// also of a triangle that is only near it.
    pub largest_angle: f64,
}

/// Why no shell was made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShellError {
    /// The thickness is no positive number.
    #[error("the thickness has to be a positive number")]
    Thickness,
    /// An angle is not between 0 and a right one (`largest_angle`) or a straight one (`feature_angle`).
    #[error("the largest angle has to be between 0 and 90 degrees, that of features between 0 and 180")]
    Angle,
    /// `immersed` and `embedded` are both set: a shell in which sheets cross overlaps itself.
    #[error("a shell of a surface that may cross itself cannot be kept from overlapping itself")]
    Contradiction,
    /// A vertex to be kept does not exist.
    #[error("there is no vertex {0} to be kept")]
    NoSuchVertex(u32),
    /// No positive thickness was found at a triangle.
    #[error(
        "no shell was found at triangle {triangle}: {reason}; split the triangles there, or remove self-intersections"
    )]
    Stuck {
        /// A source triangle.
        triangle: u32,
        /// What stays wrong however thin the shell is.
        reason: &'static str,
    },
    /// Stopped from outside (time limit, interrupt).
    #[error("stopped before a shell was found")]
    Cancelled,
}

/// A column is given up when it is shorter than this part of what it began with.
const SHORTEST: f64 = 1e-13;

/// Builds a shell round a surface. Columns on its boundary keep their place.
///
/// # Preconditions
/// The triangles form an oriented surface by their links, with or without boundary, none has area zero, and it does not
/// cross or touch itself, unless `immersed` is set; no two vertices are at one point.
///
/// # Errors
/// See [`ShellError`].
///
/// # Example
/// ```
/// use homeo::{construct::shell::{ShellParams, build}, input::SourceMesh, progress::Silent};
/// use homeo_core::mesh::SimplicialComplex;
///
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let complex = SimplicialComplex::from_indices(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
/// let params = ShellParams { thickness: 0.05, embedded: true, ..ShellParams::default() };
/// let (shell, info) = build(&SourceMesh::new(corners, complex), &params, &Silent)?;
/// assert!(info.prisms == 4 && shell.parts().is_embedded);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn build(
    source: &SourceMesh<3>,
    params: &ShellParams,
    progress: &dyn Progress,
) -> Result<(Shell, ShellInfo), ShellError> {
    check_params(source, params)?;
    let target = params.thickness * longest_side(source.positions());
    progress.stage("directions");
    let mut base = Base::new(source);
    progress.stage("thickness");
    let mut layer = first_layer(source, &mut base, params, target, progress)?;
    let mut info = ShellInfo {
        pinched: (0..layer.columns.len() as u32)
            .filter(|&v| !layer.around[v as usize].is_empty() && layer.is_pinched(v))
            .count(),
        first_prisms: layer.count(),
        ..ShellInfo::default()
    };
    progress.stage("simplify");
    simplify(&mut layer, params, target, progress, &mut info);
    info.prisms = layer.count();
    info.largest_angle = layer.largest_angle();
    // What the operations kept up piece by piece, from scratch.
    debug_assert!((0..layer.prisms.len() as u32).all(|p| !layer.exists[p as usize] || layer.is_valid(p)));
    Ok((Shell::from_parts(source.clone(), layer.into_parts()), info))
}

fn check_params(source: &SourceMesh<3>, params: &ShellParams) -> Result<(), ShellError> {
    if !(params.thickness > 0.0 && params.thickness.is_finite()) {
        return Err(ShellError::Thickness);
    }
    if params.immersed && params.embedded {
        return Err(ShellError::Contradiction);
    }
    let is_sharp = params.feature_angle.is_none_or(|angle| (0.0..=std::f64::consts::PI).contains(&angle));
    if !is_sharp || !(0.0..=std::f64::consts::FRAC_PI_2).contains(&params.largest_angle) {
        return Err(ShellError::Angle);
    }
    let count = source.positions().len();
    let missing = params.frozen.iter().find(|&&v| v as usize >= count);
    missing.map_or(Ok(()), |&v| Err(ShellError::NoSuchVertex(v)))
}

fn longest_side(positions: &[[f64; 3]]) -> f64 {
    let hull = homeo_core::spatial::Aabb::of(positions);
    (0..3).map(|axis| hull.high[axis] - hull.low[axis]).fold(0.0, f64::max)
}

/// The shell whose middle is the source: columns as long as the edges round them at first, and halved where the
/// theorem's hypotheses fail.
///
/// Prisms are positive everywhere before the surface near any of them is looked at: the one needs a few signs, the other
/// many, and most halvings come from the first. Then all prisms that changed are filled at a time. Where a column has to be
/// given up beside one without length, the edge between them is split, and it begins again.
fn first_layer(
    source: &SourceMesh<3>,
    base: &mut Base,
    params: &ShellParams,
    target: f64,
    progress: &dyn Progress,
) -> Result<Layer, ShellError> {
    for _ in 0..MOST_BEGINNINGS {
        let stuck = match thinned(source, base, params, target, progress)? {
            Thinned::Layer(layer) => return Ok(*layer),
            Thinned::Stuck(stuck) => stuck,
        };
        if base.split(&stuck.edges) == 0 {
            return Err(ShellError::Stuck { triangle: stuck.triangle, reason: reason(stuck.failure) });
        }
    }
    let reason = "short columns keep meeting";
    Err(ShellError::Stuck { triangle: 0, reason })
}

/// How often the first layer is begun anew, with more edges split, before it is given up.
const MOST_BEGINNINGS: usize = 6;

/// What shortening columns leads to.
enum Thinned {
    Layer(Box<Layer>),
    Stuck(Stuck),
}

/// A column is too short, and a neighbour has no length.
struct Stuck {
    /// The triangle of the source.
    triangle: u32,
    failure: Failure,
    /// The edges to such neighbours.
    edges: Vec<[u32; 2]>,
}

fn thinned(
    source: &SourceMesh<3>,
    base: &Base,
    params: &ShellParams,
    target: f64,
    progress: &dyn Progress,
) -> Result<Thinned, ShellError> {
    let mut thinning = Thinning::new(source, base, first_lengths(&base.mesh, target), params);
    if params.immersed {
        thinning.layer.sheets = Some(Sheets::new(source)?);
    }
    loop {
        if let Some(stuck) = thinning.make_positive(progress)? {
            return Ok(Thinned::Stuck(stuck));
        }
        let unfilled: Vec<u32> = (0..).zip(&thinning.is_filled).filter(|(_, full)| !**full).map(|(p, _)| p).collect();
        if unfilled.is_empty() {
            let clashing = if params.embedded { thinning.layer.keep_apart() } else { Vec::new() };
            if clashing.is_empty() {
                return Ok(Thinned::Layer(Box::new(thinning.layer)));
            }
            for (prism, slab) in clashing {
                if let Some(stuck) = thinning.shorten(prism, (Failure::Skin, slab)) {
                    return Ok(Thinned::Stuck(stuck));
                }
            }
            continue;
        }
        let mut failures = Vec::new();
        for some in unfilled.chunks(FILLED_AT_A_TIME) {
            if progress.is_cancelled() {
                return Err(ShellError::Cancelled);
            }
            failures.extend(thinning.layer.fill(some, &base.parents));
        }
        unfilled.iter().for_each(|&prism| thinning.is_filled[prism as usize] = true);
        failures.iter().for_each(|&(prism, _)| thinning.is_filled[prism as usize] = false);
        for (prism, failure) in failures {
            // Not if a neighbour has just been given shorter columns: that may do.
            if !thinning.is_waiting[prism as usize]
                && let Some(stuck) = thinning.shorten(prism, failure)
            {
                return Ok(Thinned::Stuck(stuck));
            }
        }
    }
}

/// Prisms that are filled between two looks at whether to stop.
const FILLED_AT_A_TIME: usize = 4096;

/// The first layer while its columns become shorter.
struct Thinning<'a> {
    base: &'a Base,
    /// How long the columns were at first, on either side.
    lengths: Vec<f64>,
    /// How long they are, below and above.
    reaches: Vec<[f64; 2]>,
    layer: Layer,
    /// Prisms of which L2 is not known, the next one last.
    waiting: Vec<u32>,
    is_waiting: Vec<bool>,
    /// Prisms of which L3 and L4 are known.
    is_filled: Vec<bool>,
}

impl<'a> Thinning<'a> {
    fn new(source: &SourceMesh<3>, base: &'a Base, lengths: Vec<f64>, params: &ShellParams) -> Self {
        let reaches: Vec<[f64; 2]> = lengths.iter().map(|&length| [length; 2]).collect();
        let columns = (0..).zip(&reaches).map(|(v, &reach)| column(base, v, reach)).collect();
        let layer = Layer::new(source, &base.mesh, columns, params);
        let count = layer.prisms.len();
        Self {
            base,
            lengths,
            reaches,
            layer,
            waiting: (0..count as u32).rev().collect(),
            is_waiting: vec![true; count],
            is_filled: vec![false; count],
        }
    }

    /// Shortens columns until all prisms satisfy L2.
    fn make_positive(&mut self, progress: &dyn Progress) -> Result<Option<Stuck>, ShellError> {
        while let Some(prism) = self.waiting.pop() {
            self.is_waiting[prism as usize] = false;
            let Err(failure) = self.layer.check_volumes(prism) else { continue };
            if progress.is_cancelled() {
                return Err(ShellError::Cancelled);
            }
            if let Some(stuck) = self.shorten(prism, failure) {
                return Ok(Some(stuck));
            }
        }
        Ok(None)
    }

    /// Halves the longest columns of a prism in the slab in which something fails; the prisms round them wait.
    /// `Some` if one of them becomes too short beside a neighbour without length.
    fn shorten(&mut self, prism: u32, (failure, slab): FailureIn) -> Option<Stuck> {
        let corners = self.layer.prisms[prism as usize];
        // The longest ones: short ones do less harm, and a fan of thin triangles would wear them out.
        let longest = corners.iter().map(|&v| self.reaches[v as usize][slab]).fold(0.0, f64::max);
        for v in corners.map(|v| v as usize) {
            if self.reaches[v][slab] > 0.6 * longest {
                self.reaches[v][slab] /= 2.0;
                self.layer.columns[v] = column(self.base, v, self.reaches[v]);
            }
            if self.reaches[v][slab] < SHORTEST * self.lengths[v] {
                // Too short to be of use: without thickness, if the prisms round it can bear that.
                let neighbours = self.layer.neighbours(v as u32).into_iter();
                let pinched: Vec<u32> = neighbours.filter(|&other| self.layer.is_pinched(other)).collect();
                if !pinched.is_empty() || self.layer.is_pinched(v as u32) {
                    let edges = pinched.into_iter().map(|other| [v as u32, other]).collect();
                    return Some(Stuck { triangle: self.base.parents[prism as usize], failure, edges });
                }
                self.layer.columns[v] = [self.base.mesh.positions()[v]; 3];
                self.reaches[v] = [0.0; 2];
            }
        }
        for &touched in corners.iter().flat_map(|&v| &self.layer.around[v as usize]) {
            self.is_filled[touched as usize] = false;
            if !self.is_waiting[touched as usize] {
                self.is_waiting[touched as usize] = true;
                self.waiting.push(touched);
            }
        }
        None
    }
}

/// The column of a vertex of the source, as long as wanted below and above; without length at a singular one.
fn column(base: &Base, v: usize, reach: [f64; 2]) -> Column {
    let middle = base.mesh.positions()[v];
    let moved = |by: f64| match base.directions[v] {
        Some(direction) => [0, 1, 2].map(|axis| middle[axis] + by * direction[axis]),
        None => middle,
    };
    [moved(-reach[0]), middle, moved(reach[1])]
}

fn reason(failure: Failure) -> &'static str {
    match failure {
        Failure::Volume => "its prism does not become positive",
        Failure::Cap | Failure::Sheet | Failure::Skin => "the surface comes too close to itself",
        Failure::Crossing => "a triangle near it is crossed the wrong way",
        Failure::Wall => "the surface comes too close to its boundary",
        Failure::Angle => "a triangle near it is nearly parallel to a pillar",
    }
}

/// Half the mean length of the edges at each vertex, at most `target`.
fn first_lengths(source: &SourceMesh<3>, target: f64) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); source.positions().len()];
    for cell in source.complex().cells() {
        for k in 0..3 {
            let (v, w) = (cell[k].index(), cell[(k + 1) % 3].index());
            let edge = directions::minus(source.positions()[v], source.positions()[w]);
            let length = edge.iter().map(|x| x * x).sum::<f64>().sqrt();
            for end in [v, w] {
                sums[end] = (sums[end].0 + length, sums[end].1 + 1.0);
            }
        }
    }
    sums.into_iter().map(|(sum, count): (f64, f64)| (0.5 * sum / count.max(1.0)).min(target)).collect()
}

/// Rounds of flips, collapses and growth until they change little.
fn simplify(layer: &mut Layer, params: &ShellParams, target: f64, progress: &dyn Progress, info: &mut ShellInfo) {
    while info.rounds < params.rounds && layer.count() > params.prisms {
        if progress.is_cancelled() {
            // What there is, is valid.
            return;
        }
        info.rounds += 1;
        let before = layer.count();
        info.flips += simplify::flip_edges(layer);
        simplify::smooth(layer, progress);
        simplify::thicken(layer, target);
        info.collapses += simplify::collapse_edges(layer, params.prisms, progress);
        if layer.count() as f64 > 0.999 * before as f64 && info.rounds > 3 {
            if layer.may_shorten || !params.may_thin {
                break;
            }
            // Only now: what lies in a thick shell can be coarser.
            layer.may_shorten = true;
        }
    }
}
