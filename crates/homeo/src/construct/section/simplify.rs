//! Fewer triangles: edge collapses in the order of their quadric errors.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::editor::{Editor, Rank};
use super::operations::Target;
use super::quadric::{Quadric, relative};
use super::shape::{area_vector, between, cross, distance, normal, unit};
use super::{Refusals, SectionError, TexturedSurface};
use crate::construct::shell::directions::{dot, minus};
use crate::construct::shell::prism::sides;
use crate::map::Shell;
use crate::progress::Progress;

type Point = [f64; 3];

/// Among collapses of no error, as in a plane, short edges come first: the weight of their squared length.
const LENGTH_WEIGHT: f64 = 1e-6;

/// When simplification is to end, and what is to be kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SimplifyParams {
    /// Stop when no more than this many triangles are left; 0 for as few as possible.
    pub triangles: usize,
    /// No vertex is put where the root of the mean squared distance to the planes of the triangles gathered in it is
    /// larger, in units of length. An estimate of how far the surface moves, not a bound. With it the surface is not
    /// loosened where no edge can be collapsed: flips do not keep to an error.
    pub largest_error: Option<f64>,
    /// Edges are kept as chains if the normals of their triangles differ by more than this angle, in radians.
    pub feature_angle: Option<f64>,
}

/// Why a simplification ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SimplifyEnd {
    /// There are no more triangles than wanted.
    Reached,
    /// No edge was left that could be collapsed.
    #[default]
    Exhausted,
    /// Stopped from outside.
    Cancelled,
}

/// What happened during a simplification.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SimplifyInfo {
    /// Triangles to begin with.
    pub first_triangles: usize,
    /// Triangles that are left.
    pub triangles: usize,
    /// Edges that were collapsed.
    pub collapses: usize,
    /// How often flips, moves and collapses were done in turn, after the first collapses came to an end.
    pub rounds: usize,
    /// Edges that were flipped, to make further collapses possible.
    pub flips: usize,
    /// Vertices that were moved for the same reason, all rounds together.
    pub moves: usize,
    /// Attempts that were refused.
    pub refusals: Refusals,
    /// The largest root of the mean squared distance at which a vertex was put.
    pub largest_error: f64,
    /// Why it ended.
    pub end: SimplifyEnd,
}

/// A section with fewer triangles.
///
/// # Guarantee
/// The result is a section of the shell whenever it ends; see the [module](super). Boundary edges, and vertices at
/// pinched columns, are those of `start`. No triangle that is made is turned over or flat in the texture, no charts come
/// to overlap, and seams remain chains of edges with the same ends. The result does not depend on the number of threads.
///
/// # Errors
/// When `start` is no section of the shell, or a parameter is out of range.
///
/// # Complexity
/// `O(n log n)` comparisons, and exact checks proportional to the attempts; where no edge can be collapsed any more up to
/// 30 rounds of attempts at all edges and vertices that are left. With texture also an exact evaluation of the
/// shell's map for each vertex that moves.
///
/// # References
/// Garland and Heckbert 1997, doi 10.1145/258734.258849.
///
/// # Example
/// ```
/// use homeo::construct::{section, shell};
/// use homeo::{input::SourceMesh, progress::Silent};
/// use homeo_core::mesh::SimplicialComplex;
///
/// // An octahedron, each side cut in four.
/// let mut positions: Vec<[f64; 3]> = vec![];
/// let mut number = |p: [f64; 3]| {
///     let found = positions.iter().position(|q| *q == p);
///     found.unwrap_or_else(|| { positions.push(p); positions.len() - 1 }) as u32
/// };
/// let mut triangles = vec![];
/// for signs in 0..8 {
///     let sign = |bit: u32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
///     let corners = [[2.0 * sign(0), 0.0, 0.0], [0.0, 2.0 * sign(1), 0.0], [0.0, 0.0, 2.0 * sign(2)]];
///     let half = |i: usize, j: usize| [0, 1, 2].map(|axis| (corners[i][axis] + corners[j][axis]) / 2.0);
///     let [a, b, c] = corners.map(&mut number);
///     let [ab, bc, ca] = [half(0, 1), half(1, 2), half(2, 0)].map(&mut number);
///     let outward = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
///     let turned = sign(0) * sign(1) * sign(2) < 0.0;
///     triangles.extend(outward.map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] }));
/// }
/// let complex = SimplicialComplex::from_indices(positions.len(), &triangles)?;
/// let source = SourceMesh::new(positions, complex);
/// let (shell, _) = shell::build(&source, &shell::ShellParams::default(), &Silent)?;
/// let params = section::SimplifyParams { triangles: 8, ..section::SimplifyParams::default() };
/// let (coarse, info) = section::simplify(&shell, &source.into(), &params, &Silent)?;
/// assert_eq!((coarse.surface.complex().cell_count(), info.end), (8, section::SimplifyEnd::Reached));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simplify(
    shell: &Shell,
    start: &TexturedSurface,
    params: &SimplifyParams,
    progress: &dyn Progress,
) -> Result<(TexturedSurface, SimplifyInfo), SectionError> {
    if params.largest_error.is_some_and(|error| error.is_nan() || error < 0.0) {
        return Err(SectionError::Parameter("the largest error has to be a number that is not negative"));
    }
    check_angle(params.feature_angle)?;
    progress.stage("check");
    let editor = Editor::new(shell, start, params.feature_angle)?;
    progress.stage("simplify");
    let first_triangles = editor.surface.count;
    let mut work = Simplification::new(editor, params.largest_error.unwrap_or(f64::INFINITY));
    work.run(params.triangles, progress);
    if params.largest_error.is_none() {
        work.loosen(params.triangles, progress);
    }
    let info = SimplifyInfo {
        first_triangles,
        triangles: work.editor.surface.count,
        refusals: work.editor.refusals,
        ..work.info
    };
    Ok((work.editor.finished(), info))
}

pub(super) fn check_angle(angle: Option<f64>) -> Result<(), SectionError> {
    match angle {
        Some(angle) if !(0.0..=std::f64::consts::PI).contains(&angle) => {
            Err(SectionError::Parameter("the feature angle has to lie between 0 and pi"))
        }
        _ => Ok(()),
    }
}

/// A way to collapse an edge.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    cost: f64,
    error: f64,
    gone: u32,
    kept: u32,
    target: Target,
}

/// An edge in the queue: the bits of its cost, which order as the costs do, its ends, and their versions.
type Entry = Reverse<(u64, [u32; 2], [u32; 2])>;

/// A simplification under way.
pub(super) struct Simplification<'a> {
    pub editor: Editor<'a>,
    pub origin: Point,
    pub quadrics: Vec<Quadric>,
    /// How often the quadric or the place of each vertex changed.
    versions: Vec<u32>,
    /// The neighbours with which each vertex was tried in vain since something round it changed.
    refused: Vec<Vec<u32>>,
    queue: BinaryHeap<Entry>,
    /// Whether collapses may look for a place.
    is_thorough: bool,
    pub largest_error: f64,
    pub info: SimplifyInfo,
}

impl<'a> Simplification<'a> {
    fn new(editor: Editor<'a>, largest_error: f64) -> Self {
        let count = editor.surface.positions.len();
        let origin = editor.surface.positions.first().copied().unwrap_or_default();
        let mut work = Self {
            quadrics: first_quadrics(&editor, origin),
            editor,
            origin,
            versions: vec![0; count],
            refused: vec![Vec::new(); count],
            queue: BinaryHeap::new(),
            is_thorough: false,
            largest_error,
            info: SimplifyInfo::default(),
        };
        work.push_all();
        work
    }

    fn push_all(&mut self) {
        for [a, b] in self.editor.surface.edges() {
            self.push(a, b);
        }
    }

    /// Forgets what was refused, and goes about further collapses more thoroughly.
    pub fn start_anew(&mut self) {
        self.queue.clear();
        self.refused.iter_mut().for_each(Vec::clear);
        self.is_thorough = true;
        self.push_all();
    }

    /// Collapses edges until there are few enough triangles or none can be.
    pub fn run(&mut self, enough: usize, progress: &dyn Progress) {
        while self.editor.surface.count > enough {
            if progress.is_cancelled() {
                self.info.end = SimplifyEnd::Cancelled;
                return;
            }
            let Some(Reverse((_, edge, versions))) = self.queue.pop() else {
                self.info.end = SimplifyEnd::Exhausted;
                return;
            };
            let [a, b] = edge;
            let is_old = edge.map(|v| self.versions[v as usize]) != versions;
            if !is_old && !self.refused[a as usize].contains(&b) {
                self.try_edge(a, b);
            }
        }
        self.info.end = SimplifyEnd::Reached;
    }

    fn try_edge(&mut self, a: u32, b: u32) {
        let is_done = |candidate: &Candidate, editor: &mut Editor<'_>| {
            editor.collapse(candidate.gone, candidate.kept, candidate.target)
        };
        let candidates = self.candidates(a, b);
        let done = candidates.into_iter().find(|candidate| is_done(candidate, &mut self.editor));
        let done = done.map(|candidate| (candidate.error, candidate.gone, candidate.kept));
        let somewhere = |work: &mut Self| work.collapse_somewhere(a, b).map(|error| (error, a, b));
        match done.or_else(|| if self.is_thorough { somewhere(self) } else { None }) {
            Some((error, gone, kept)) => {
                self.info.collapses += 1;
                self.info.largest_error = self.info.largest_error.max(error);
                self.settle(gone, kept);
            }
            None => {
                self.refused[a as usize].push(b);
                self.refused[b as usize].push(a);
            }
        }
    }

    /// Brings quadrics and queue up to date after a collapse.
    fn settle(&mut self, gone: u32, kept: u32) {
        self.quadrics[kept as usize] = self.quadrics[kept as usize].plus(&self.quadrics[gone as usize]);
        for v in [gone, kept] {
            self.versions[v as usize] += 1;
            self.forget(v);
        }
        let ring = self.editor.surface.neighbours(kept);
        ring.iter().for_each(|&other| self.push(kept, other));
        // What was refused near by may now be possible.
        for &v in &ring {
            for other in self.forget(v) {
                self.push(v, other);
            }
        }
    }

    /// Takes back the refusals at a vertex.
    fn forget(&mut self, vertex: u32) -> Vec<u32> {
        let others = std::mem::take(&mut self.refused[vertex as usize]);
        others.iter().for_each(|&other| self.refused[other as usize].retain(|&v| v != vertex));
        others
    }

    fn push(&mut self, a: u32, b: u32) {
        let edge = [a.min(b), a.max(b)];
        if let Some(best) = self.candidates(edge[0], edge[1]).first() {
            let versions = edge.map(|v| self.versions[v as usize]);
            self.queue.push(Reverse((best.cost.to_bits(), edge, versions)));
        }
    }

    /// All ways to collapse an edge that keeps, seams and the largest error allow, the best one first.
    fn candidates(&self, a: u32, b: u32) -> Vec<Candidate> {
        let surface = &self.editor.surface;
        let [p, q] = [surface.point(a), surface.point(b)];
        let sum = self.quadrics[a as usize].plus(&self.quadrics[b as usize]);
        let length_cost = LENGTH_WEIGHT * sum.weight * distance(p, q).powi(2);
        let mut found = Vec::with_capacity(4);
        let mut add = |gone: u32, kept: u32, target: Target, place: Point| {
            let place = relative(place, self.origin);
            let error = sum.distance(place);
            if error <= self.largest_error {
                found.push(Candidate { cost: sum.at(place) + length_cost, error, gone, kept, target });
            }
        };
        let ranks = [a, b].map(|v| self.editor.rank(v));
        if ranks == [Rank::Free; 2] {
            let middle = between(p, q, 0.5);
            if let Some(lowest) = sum.lowest(relative(middle, self.origin)) {
                let place = std::array::from_fn(|i| lowest[i] + self.origin[i]);
                add(a, b, Target::At(place), place);
            }
            add(a, b, Target::At(middle), middle);
        }
        for (gone, kept, place) in [(a, b, q), (b, a, p)] {
            if self.editor.may_go(gone, kept) {
                add(gone, kept, Target::Kept, place);
            }
        }
        found.sort_by(|one, other| one.cost.total_cmp(&other.cost));
        found
    }
}

/// The planes of the triangles at each vertex, and at kept edges the planes upright on them.
fn first_quadrics(editor: &Editor<'_>, origin: Point) -> Vec<Quadric> {
    let surface = &editor.surface;
    let mut quadrics = vec![Quadric::default(); surface.positions.len()];
    for t in surface.existing() {
        let (corners, points) = (surface.triangles[t as usize], surface.points(t));
        let (area, upright) = (area_vector(points), normal(points));
        let plane = Quadric::plane(relative(points[0], origin), upright, dot(area, area).sqrt() / 6.0);
        for v in corners {
            quadrics[v as usize] = quadrics[v as usize].plus(&plane);
        }
        for (k, [a, b]) in sides(corners).into_iter().enumerate() {
            if editor.creases.kind(a, b).is_some() {
                let step = minus(points[(k + 1) % 3], points[k]);
                let beside = unit(cross(upright, step));
                let wall = Quadric::plane(relative(points[k], origin), beside, dot(step, step) / 2.0);
                for v in [a, b] {
                    quadrics[v as usize] = quadrics[v as usize].plus(&wall);
                }
            }
        }
    }
    quadrics
}
