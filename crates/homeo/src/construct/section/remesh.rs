//! Triangles of about equal size: splits, collapses, flips and smoothing in turn.

use std::collections::BinaryHeap;

use super::editor::{Editor, Rank};
use super::operations::Target;
use super::shape::{area_vector, between, distance, normal, unit};
use super::simplify::check_angle;
use super::{Refusals, SectionError, TexturedSurface};
use crate::construct::crease::Kind;
use crate::construct::shell::directions::{dot, minus};
use crate::map::Shell;
use crate::progress::Progress;

type Point = [f64; 3];

/// Longer edges are split, relative to the wanted length.
const LONG: f64 = 4.0 / 3.0;

/// Shorter edges are collapsed, relative to the wanted length.
const SHORT: f64 = 4.0 / 5.0;

/// Edges are flipped if the cosine of the angle between their triangles is larger: others carry the shape.
const FLAT_COSINE: f64 = 0.85;

/// Steps of smoothing that are shorter, relative to the wanted length, are left out.
const SMALL_STEP: f64 = 3e-2;

/// What triangles are wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct RemeshParams {
    /// The wanted length of edges.
    pub edge_length: f64,
    /// Factors of the wanted length, one for each vertex of the surface to begin with.
    pub sizing: Option<Vec<f64>>,
    /// Edges are kept as chains if the normals of their triangles differ by more than this angle, in radians.
    pub feature_angle: Option<f64>,
    /// How often splits, collapses, flips and smoothing are done in turn.
    pub iterations: usize,
}

impl RemeshParams {
    /// Edges of one length, with 5 iterations.
    pub fn with_edge_length(edge_length: f64) -> Self {
        Self { edge_length, sizing: None, feature_angle: None, iterations: 5 }
    }
}

/// What happened during a remeshing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RemeshInfo {
    /// Triangles to begin with.
    pub first_triangles: usize,
    /// Triangles at the end.
    pub triangles: usize,
    /// Edges that were split.
    pub splits: usize,
    /// Edges that were collapsed.
    pub collapses: usize,
    /// Edges that were flipped.
    pub flips: usize,
    /// Vertices that were moved, all iterations together.
    pub moves: usize,
    /// Attempts that were refused.
    pub refusals: Refusals,
    /// Iterations that were finished; fewer than wanted if stopped from outside.
    pub iterations: usize,
}

/// A section with triangles of about equal size.
///
/// # Guarantee
/// As for [`simplify`](super::simplify): a section of the shell, with the boundary and the pinched vertices of `start`, and
/// nothing new turned over or overlapping in the texture. How near edges come to the wanted length is not guaranteed:
/// edges of the boundary stay, and so do others where the shell is too thin.
///
/// # Errors
/// When `start` is no section of the shell, or a parameter is out of range.
///
/// # Complexity
/// Proportional to iterations and edges; an exact evaluation of the shell's map for each vertex that is added or moved.
///
/// # References
/// Botsch and Kobbelt 2004, doi 10.1145/1057432.1057457.
///
/// # Example
/// ```
/// use homeo::construct::{section, shell};
/// use homeo::{input::SourceMesh, progress::Silent};
/// use homeo_core::mesh::SimplicialComplex;
///
/// let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let complex = SimplicialComplex::from_indices(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])?;
/// let source = SourceMesh::new(positions, complex);
/// let (shell, _) = shell::build(&source, &shell::ShellParams::default(), &Silent)?;
/// let params = section::RemeshParams {
///     feature_angle: Some(0.5),
///     ..section::RemeshParams::with_edge_length(0.3)
/// };
/// let (fine, info) = section::remesh(&shell, &source.into(), &params, &Silent)?;
/// assert!(info.splits > 10 && fine.surface.complex().cell_count() > 40);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn remesh(
    shell: &Shell,
    start: &TexturedSurface,
    params: &RemeshParams,
    progress: &dyn Progress,
) -> Result<(TexturedSurface, RemeshInfo), SectionError> {
    let factors = checked_factors(start, params)?;
    progress.stage("check");
    let editor = Editor::new(shell, start, params.feature_angle)?;
    let info = RemeshInfo { first_triangles: editor.surface.count, ..RemeshInfo::default() };
    let lengths = factors.into_iter().map(|factor| factor * params.edge_length).collect();
    let mut work = Remeshing { editor, lengths, info, progress };
    while work.info.iterations < params.iterations && !progress.is_cancelled() {
        progress.stage("remesh");
        work.split_long_edges();
        work.collapse_short_edges();
        work.flip_edges();
        work.smooth();
        work.info.iterations += usize::from(!progress.is_cancelled());
    }
    let (triangles, refusals) = (work.editor.surface.count, work.editor.refusals);
    Ok((work.editor.finished(), RemeshInfo { triangles, refusals, ..work.info }))
}

fn checked_factors(start: &TexturedSurface, params: &RemeshParams) -> Result<Vec<f64>, SectionError> {
    let is_length = |x: f64| x > 0.0 && x.is_finite();
    if !is_length(params.edge_length) {
        return Err(SectionError::Parameter("the edge length has to be a positive number"));
    }
    check_angle(params.feature_angle)?;
    let count = start.surface.positions().len();
    let factors = params.sizing.clone().unwrap_or_else(|| vec![1.0; count]);
    if factors.len() != count || !factors.iter().all(|&factor| is_length(factor)) {
        return Err(SectionError::Parameter("the sizing has to be one positive number for each vertex"));
    }
    Ok(factors)
}

struct Remeshing<'a> {
    editor: Editor<'a>,
    /// The wanted length at each vertex.
    lengths: Vec<f64>,
    info: RemeshInfo,
    progress: &'a dyn Progress,
}

impl Remeshing<'_> {
    /// How long an edge is, or would be, relative to what is wanted.
    fn stretch(&self, [a, b]: [u32; 2], [p, q]: [Point; 2]) -> f64 {
        distance(p, q) / (0.5 * (self.lengths[a as usize] + self.lengths[b as usize]))
    }

    fn stretch_of(&self, a: u32, b: u32) -> f64 {
        self.stretch([a, b], [self.editor.surface.point(a), self.editor.surface.point(b)])
    }

    /// Splits long edges, the longest first.
    fn split_long_edges(&mut self) {
        let mut queue = BinaryHeap::new();
        let long = |work: &Self, a: u32, b: u32| {
            let stretch = work.stretch_of(a, b);
            (stretch > LONG).then(|| (stretch.to_bits(), [a.min(b), a.max(b)]))
        };
        queue.extend(self.editor.surface.edges().into_iter().filter_map(|[a, b]| long(self, a, b)));
        while let Some((bits, [a, b])) = queue.pop() {
            if self.progress.is_cancelled() {
                return;
            }
            // The edge may be gone, or another one of its name longer or shorter.
            let is_same = long(self, a, b).is_some_and(|(now, _)| now == bits);
            if !is_same || self.editor.surface.both_sides(a, b).is_none() {
                continue;
            }
            if let Some(middle) = self.split(a, b) {
                self.info.splits += 1;
                let ring = self.editor.surface.neighbours(middle);
                queue.extend(ring.into_iter().filter_map(|other| long(self, middle, other)));
            }
        }
    }

    /// The new vertex lies on the source if that is possible, and else in the middle of the edge. Up to rounding the
    /// triangles are then parts of the old ones, which lie well in the shell; rounding is why they are checked.
    fn split(&mut self, a: u32, b: u32) -> Option<u32> {
        let middle = between(self.editor.surface.point(a), self.editor.surface.point(b), 0.5);
        self.lengths.push(0.5 * (self.lengths[a as usize] + self.lengths[b as usize]));
        let on_source = self.editor.on_source(middle);
        let done = on_source.and_then(|place| self.editor.split(a, b, place));
        let done = done.or_else(|| self.editor.split(a, b, middle));
        if done.is_none() {
            self.lengths.pop();
        }
        done
    }

    /// Collapses short edges, the shortest first, if no long ones arise.
    fn collapse_short_edges(&mut self) {
        let mut edges = self.editor.surface.edges();
        edges.retain(|&[a, b]| self.stretch_of(a, b) < SHORT);
        edges.sort_by(|x, y| self.stretch_of(x[0], x[1]).total_cmp(&self.stretch_of(y[0], y[1])).then(x.cmp(y)));
        for [a, b] in edges {
            if self.progress.is_cancelled() {
                return;
            }
            if self.editor.surface.both_sides(a, b).is_some() && self.stretch_of(a, b) < SHORT {
                self.info.collapses += usize::from(self.collapse(a, b));
            }
        }
    }

    fn collapse(&mut self, a: u32, b: u32) -> bool {
        let [p, q] = [a, b].map(|v| self.editor.surface.point(v));
        if [a, b].map(|v| self.editor.rank(v)) == [Rank::Free; 2] {
            // The way back onto the source is the dearest part, so it comes last.
            let middle = between(p, q, 0.5);
            if self.editor.surface.can_collapse(a, b) && self.stays_short(a, b, middle) {
                let place = self.editor.on_source(middle).unwrap_or(middle);
                if self.editor.collapse(a, b, Target::At(place)) {
                    return true;
                }
            }
        }
        [(a, b, q), (b, a, p)].into_iter().any(|(gone, kept, place)| {
            self.editor.may_go(gone, kept)
                && self.stays_short(gone, kept, place)
                && self.editor.collapse(gone, kept, Target::Kept)
        })
    }

    /// Whether no long edge arises if both ends of an edge go to a place.
    fn stays_short(&self, gone: u32, kept: u32, place: Point) -> bool {
        let surface = &self.editor.surface;
        let others = [gone, kept].map(|v| surface.neighbours(v)).concat();
        let mut others = others.into_iter().filter(|&v| v != gone && v != kept);
        others.all(|v| self.stretch([kept, v], [place, surface.point(v)]) < LONG)
    }

    /// Flips edges where that brings numbers of neighbours nearer to 6, and to 4 on the boundary.
    fn flip_edges(&mut self) {
        for [a, b] in self.editor.surface.edges() {
            if self.progress.is_cancelled() {
                return;
            }
            if self.is_worth_flipping(a, b) {
                self.info.flips += usize::from(self.editor.flip(a, b));
            }
        }
    }

    fn is_worth_flipping(&self, a: u32, b: u32) -> bool {
        let surface = &self.editor.surface;
        if self.editor.creases.kind(a, b).is_some() {
            return false;
        }
        let Some([left, right]) = surface.both_sides(a, b) else { return false };
        let (Some(c), Some(d)) = (surface.third(left, a, b), surface.third(right, a, b)) else { return false };
        if dot(normal(surface.points(left)), normal(surface.points(right))) < FLAT_COSINE {
            return false;
        }
        let excess = |v: u32, change: i64| {
            let is_boundary = self.editor.creases.at(v).iter().any(|(_, kind)| *kind == Kind::Boundary);
            let neighbours = surface.around[v as usize].len() as i64 + i64::from(is_boundary);
            (neighbours + change - if is_boundary { 4 } else { 6 }).pow(2)
        };
        let before: i64 = [a, b, c, d].into_iter().map(|v| excess(v, 0)).sum();
        let after: i64 = [(a, -1), (b, -1), (c, 1), (d, 1)].into_iter().map(|(v, change)| excess(v, change)).sum();
        after < before
    }

    /// Moves free vertices along the surface towards the middle of their neighbours, and back onto the source.
    fn smooth(&mut self) {
        for vertex in 0..self.editor.surface.positions.len() as u32 {
            if self.progress.is_cancelled() {
                return;
            }
            if !self.editor.surface.around[vertex as usize].is_empty() && self.editor.rank(vertex) == Rank::Free {
                self.info.moves += usize::from(self.smooth_vertex(vertex));
            }
        }
    }

    fn smooth_vertex(&mut self, vertex: u32) -> bool {
        let surface = &self.editor.surface;
        let here = surface.point(vertex);
        let ring = surface.neighbours(vertex);
        let sum = |value: &dyn Fn(u32) -> Point, of: &[u32]| {
            of.iter().fold([0.0; 3], |sum, &x| std::array::from_fn(|i| sum[i] + value(x)[i]))
        };
        let centre = sum(&|v| surface.point(v), &ring).map(|x| x / ring.len() as f64);
        let upright = unit(sum(&|t| area_vector(surface.points(t)), &surface.around[vertex as usize]));
        let step = minus(centre, here);
        let rise = dot(step, upright);
        let goal: Point = std::array::from_fn(|i| here[i] + step[i] - rise * upright[i]);
        let mean = ring.iter().map(|&v| self.lengths[v as usize]).sum::<f64>() / ring.len() as f64;
        if distance(here, goal) < SMALL_STEP * mean {
            return false;
        }
        let is_moved = [1.0, 0.5].into_iter().any(|share| {
            let place = self.editor.on_source(between(here, goal, share));
            place.is_some_and(|place| self.editor.shift(vertex, place))
        });
        if is_moved {
            self.lengths[vertex as usize] = 0.5 * (self.lengths[vertex as usize] + mean);
        }
        is_moved
    }
}
