//! Room for further collapses where none is possible any more.
//!
//! Nearly always a collapse is refused then because a pillar would cross one of its triangles the wrong way. So triangles
//! are turned towards the pillars, by flips and by moves of vertices, and collapses look for a place where they can be
//! done. All of it is guided by one number, the *steepness*: the smallest cosine of the angles between triangles and the
//! pillars that have to cross them. It decides nothing: what is done is checked as any other change is.

use super::editor::{Change, Editor, Rank};
use super::operations::Target;
use super::quadric::relative;
use super::shape::{area_vector, between, cross, distance, unit};
use super::simplify::{Simplification, SimplifyEnd};
use crate::construct::shell::directions::{dot, minus};
use crate::progress::Progress;

type Point = [f64; 3];

/// How often flips, moves and collapses are done in turn at most.
const MOST_ROUNDS: usize = 30;

/// After so many rounds one after the other that take away less than one triangle in [`FEW`], it ends.
const IDLE_ROUNDS: usize = 4;

/// See [`IDLE_ROUNDS`].
const FEW: usize = 100;

/// A flip or a move has to raise the steepness by this.
const LEAST_GAIN: f64 = 1e-3;

/// Steps of a vertex in search of a place, relative to the mean length of its edges.
const STEPS: [f64; 3] = [0.3, 0.1, 0.03];

/// A place for a collapsed edge is looked for if the steepness in its middle is at least this.
const LEAST_HOPE: f64 = -0.5;

impl Simplification<'_> {
    /// Loosens the surface and goes on collapsing edges, in turn, while that helps. Not to be used with a bound for the
    /// error: flips do not keep to it.
    pub(super) fn loosen(&mut self, enough: usize, progress: &dyn Progress) {
        let mut idle = 0;
        while self.info.end == SimplifyEnd::Exhausted && self.info.rounds < MOST_ROUNDS && idle < IDLE_ROUNDS {
            progress.stage("loosen");
            self.info.rounds += 1;
            let before = self.editor.surface.count;
            self.info.flips += self.editor.flip_to_pillars(progress);
            if idle > 0 {
                self.info.moves += self.spread(progress);
            }
            self.info.moves += self.move_to_pillars(progress);
            self.start_anew();
            self.run(enough, progress);
            let is_idle = (before - self.editor.surface.count) * FEW < before;
            idle = if is_idle { idle + 1 } else { 0 };
        }
    }

    /// Moves free vertices to where the triangles round them are steeper. Returns how many moved.
    fn move_to_pillars(&mut self, progress: &dyn Progress) -> usize {
        self.move_free(Self::move_vertex, progress)
    }

    /// Moves free vertices amid their neighbours, wherever that leaves a section, so that the next search begins elsewhere.
    /// Returns how many moved.
    fn spread(&mut self, progress: &dyn Progress) -> usize {
        self.move_free(Self::spread_vertex, progress)
    }

    fn move_free(&mut self, step: impl Fn(&mut Self, u32) -> bool, progress: &dyn Progress) -> usize {
        let mut moves = 0;
        for vertex in 0..self.editor.surface.positions.len() as u32 {
            if progress.is_cancelled() {
                break;
            }
            if !self.editor.surface.around[vertex as usize].is_empty() && self.editor.rank(vertex) == Rank::Free {
                moves += usize::from(step(self, vertex));
            }
        }
        moves
    }

    fn spread_vertex(&mut self, vertex: u32) -> bool {
        let surface = &self.editor.surface;
        let (here, ring) = (surface.point(vertex), surface.neighbours(vertex));
        let centre = mean(&ring.iter().map(|&v| surface.point(v)).collect::<Vec<_>>());
        [1.0, 0.5, 0.25].into_iter().any(|share| self.shift(vertex, between(here, centre, share)))
    }

    fn move_vertex(&mut self, vertex: u32) -> bool {
        let editor = &self.editor;
        let Some(mut change) = editor.shift_change(vertex, editor.surface.point(vertex)) else { return false };
        let least = editor.steepness(&change, -1.0) + LEAST_GAIN;
        let mut steepness_at = |place: Point| {
            change.moved = Some((vertex, place));
            editor.steepness(&change, least)
        };
        let places = editor.places(vertex).into_iter().map(|place| (steepness_at(place), place));
        let mut better: Vec<(f64, Point)> = places.filter(|(steepness, _)| *steepness > least).collect();
        better.sort_by(|one, other| other.0.total_cmp(&one.0));
        better.into_iter().any(|(_, place)| self.shift(vertex, place))
    }

    /// Collapses an edge between free vertices into a place that is looked for, if there is one. Returns the error there.
    pub(super) fn collapse_somewhere(&mut self, a: u32, b: u32) -> Option<f64> {
        if [a, b].map(|v| self.editor.rank(v)) != [Rank::Free; 2] {
            return None;
        }
        let place = self.editor.roomy_place(a, b)?;
        let sum = self.quadrics[a as usize].plus(&self.quadrics[b as usize]);
        let is_done = self.editor.collapse(a, b, Target::At(place));
        is_done.then(|| sum.distance(relative(place, self.origin)))
    }

    /// Moves a vertex if that leaves a section.
    fn shift(&mut self, vertex: u32, place: Point) -> bool {
        let is_done = self.editor.shift(vertex, place);
        if is_done {
            let error = self.quadrics[vertex as usize].distance(relative(place, self.origin));
            self.info.largest_error = self.info.largest_error.max(error);
        }
        is_done
    }
}

impl Editor<'_> {
    /// The steepness of the triangles that a change makes, or at most `floor` if it is not larger; rounded.
    fn steepness(&self, change: &Change, floor: f64) -> f64 {
        let mut smallest = 1.0f64;
        for face in &change.new {
            if smallest <= floor {
                break;
            }
            smallest = smallest.min(self.stage.steepness(self.points(change, face), floor));
        }
        smallest
    }

    /// Flips edges where the two triangles are steeper then. Returns how many were.
    pub fn flip_to_pillars(&mut self, progress: &dyn Progress) -> usize {
        let mut flips = 0;
        for [a, b] in self.surface.edges() {
            if progress.is_cancelled() {
                break;
            }
            flips += usize::from(self.is_steeper_flipped(a, b) && self.flip(a, b));
        }
        flips
    }

    fn is_steeper_flipped(&self, a: u32, b: u32) -> bool {
        let Some(change) = self.flip_change(a, b) else { return false };
        let now = change.old.iter().map(|&t| self.stage.steepness(self.surface.points(t), -1.0));
        let least = now.fold(1.0, f64::min) + LEAST_GAIN;
        self.steepness(&change, least) > least
    }

    /// Where a vertex may be better: on the middle surface, amid its neighbours, and a step in six directions.
    fn places(&self, vertex: u32) -> Vec<Point> {
        let here = self.surface.point(vertex);
        let ring: Vec<Point> = self.surface.neighbours(vertex).into_iter().map(|v| self.surface.point(v)).collect();
        let centre = mean(&ring);
        let mut places: Vec<Point> = [here, centre].into_iter().filter_map(|p| self.on_middle(p)).collect();
        places.extend([centre, between(here, centre, 0.5)]);
        let (length, axes) = self.frame(here, &ring, &self.surface.around[vertex as usize]);
        for step in &STEPS[..2] {
            places.extend(steps(here, step * length, &axes));
        }
        places
    }

    /// A place into which an edge between free vertices can be collapsed as far as pillars are concerned: the middle, or
    /// what a search from there finds, step by step to where the triangles are steeper.
    fn roomy_place(&self, a: u32, b: u32) -> Option<Point> {
        let middle = between(self.surface.point(a), self.surface.point(b), 0.5);
        let mut change = self.collapse_change(a, b, Target::At(middle))?;
        let value = |change: &mut Change, place: Point, floor: f64| {
            change.moved = Some((b, place));
            self.steepness(change, floor)
        };
        let start = [Some(middle), self.on_middle(middle), self.on_source(middle)];
        let (mut best, mut here) = (LEAST_HOPE, None);
        for place in start.into_iter().flatten() {
            let steepness = value(&mut change, place, best);
            if steepness > best {
                (best, here) = (steepness, Some(place));
            }
        }
        let mut here = here?;
        let ring: Vec<Point> = self.surface.neighbours(a).into_iter().map(|v| self.surface.point(v)).collect();
        let (length, axes) = self.frame(here, &ring, &change.old);
        for step in STEPS {
            for place in steps(here, step * length, &axes) {
                if best > 0.0 {
                    return Some(here);
                }
                let steepness = value(&mut change, place, best);
                if steepness > best {
                    (best, here) = (steepness, place);
                }
            }
        }
        (best > 0.0).then_some(here)
    }

    /// The mean distance of points from a place, and three axes there, of which the first is upright on triangles.
    fn frame(&self, here: Point, ring: &[Point], triangles: &[u32]) -> (f64, [Point; 3]) {
        let length = ring.iter().map(|&p| distance(here, p)).sum::<f64>() / ring.len().max(1) as f64;
        let upright = unit(sum(triangles.iter().map(|&t| area_vector(self.surface.points(t)))));
        let out = minus(ring.first().copied().unwrap_or(here), here);
        let rise = dot(out, upright);
        let first = unit(std::array::from_fn(|i| out[i] - rise * upright[i]));
        (length, [upright, first, cross(upright, first)])
    }
}

fn sum(points: impl Iterator<Item = Point>) -> Point {
    points.fold([0.0; 3], |sum, p| std::array::from_fn(|i| sum[i] + p[i]))
}

fn mean(points: &[Point]) -> Point {
    sum(points.iter().copied()).map(|x| x / points.len().max(1) as f64)
}

/// The six places at a distance along axes.
fn steps(here: Point, length: f64, axes: &[Point; 3]) -> impl Iterator<Item = Point> {
    let step = move |axis: Point| [length, -length].map(|by| std::array::from_fn(|i| here[i] + by * axis[i]));
    axes.map(step).into_iter().flatten()
}
