//! Changes of a section: one that is accepted leaves a section, and one that is refused leaves everything as it was.

use super::atlas::Atlas;
use super::outline::Detour;
use super::shape::{energy, normal};
use super::stage::Stage;
use super::surface::Surface;
use super::{Refusals, SectionError, TexturedSurface};
use crate::construct::crease::{Creases, Kind};
use crate::construct::shell::directions::dot;
use crate::map::Shell;

type Point = [f64; 3];

/// Triangles with a larger energy are not made, unless there were such before.
const LARGEST_ENERGY: f64 = 30.0;

/// The cosine between a triangle and the one that it replaces is at least this.
const SMALLEST_COSINE: f64 = 0.3;

/// A triangle to be made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub corners: [u32; 3],
    /// Texture indices; without meaning where there is no texture.
    pub marks: [u32; 3],
    /// The triangle whose chart it takes over, and whose normal it has to be near.
    pub parent: u32,
}

/// Texture coordinates that a change sets.
#[derive(Clone, Debug, Default)]
pub(super) enum Marking {
    /// None.
    #[default]
    Keep,
    /// Of the index, from the first texture at the place of the vertex that moves.
    FromFirst(u32),
    /// Of these indices.
    Given(Vec<(u32, [f64; 2])>),
}

/// A local change of the surface: triangles that go, and triangles that come in their stead.
#[derive(Clone, Debug, Default)]
pub(super) struct Change {
    pub old: Vec<u32>,
    pub new: Vec<Face>,
    /// A vertex that moves, or is added.
    pub moved: Option<(u32, Point)>,
    pub marking: Marking,
    /// Short cuts of the charts' boundaries; if a vertex is added they are taken back to front.
    pub detours: Vec<Detour>,
}

/// How a vertex may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rank {
    /// In any way.
    Free,
    /// It may go into a neighbour on its chain of kept edges.
    Chain,
    /// Not at all.
    Fixed,
}

/// A section under change.
pub(super) struct Editor<'a> {
    pub shell: &'a Shell,
    pub surface: Surface,
    pub creases: Creases,
    pub atlas: Option<Atlas>,
    pub refusals: Refusals,
    pub stage: Stage,
}

impl<'a> Editor<'a> {
    /// Takes a section over, if it is one.
    pub fn new(shell: &'a Shell, start: &TexturedSurface, feature_angle: Option<f64>) -> Result<Self, SectionError> {
        let stage = Stage::new(shell.parts());
        let surface = Surface::new(&start.surface);
        super::check_start(&stage, &surface, start, shell)?;
        let atlas = start.texture.as_ref().map(|texture| Atlas::new(shell, start, texture, &surface));
        let creases = creases(&surface, atlas.as_ref(), feature_angle);
        Ok(Self { shell, surface, creases, atlas, refusals: Refusals::default(), stage })
    }

    pub fn rank(&self, vertex: u32) -> Rank {
        match self.creases.at(vertex) {
            _ if self.stage.is_pinched(self.surface.point(vertex)) => Rank::Fixed,
            [] => Rank::Free,
            [(_, first), (_, second)] if first == second && *first != Kind::Boundary => Rank::Chain,
            _ => Rank::Fixed,
        }
    }

    /// The point of the source on the pillar line of a point; rounded.
    pub fn on_source(&self, point: Point) -> Option<Point> {
        self.shell.to_source(point).ok().map(|found| found.point)
    }

    /// The point of the middle surface on the pillar line of a point; rounded.
    pub fn on_middle(&self, point: Point) -> Option<Point> {
        self.shell.to_middle(point).ok().map(|found| found.point)
    }

    /// The texture index of a vertex in a triangle; 0 without texture.
    pub fn mark(&self, triangle: u32, vertex: u32) -> u32 {
        self.atlas.as_ref().and_then(|atlas| atlas.mark(&self.surface, triangle, vertex)).unwrap_or(0)
    }

    pub fn marks(&self, triangle: u32) -> [u32; 3] {
        self.atlas.as_ref().map_or([0; 3], |atlas| atlas.corners[triangle as usize])
    }

    /// Makes a change if what it makes is part of a section, and fit in space and in the texture. That the result is a
    /// surface by its links is up to the caller.
    pub fn apply(&mut self, mut change: Change) -> bool {
        if !self.is_shapely(&change) {
            self.refusals.shape += 1;
            return false;
        }
        // At a pinched column the theorem allows one vertex, which is there already.
        let is_doubled = change.moved.is_some_and(|(_, place)| self.stage.is_pinched(place));
        if is_doubled || change.new.iter().any(|face| self.stage.check(self.points(&change, face)).is_err()) {
            self.refusals.shell += 1;
            return false;
        }
        if !self.fits_texture(&mut change) {
            self.refusals.texture += 1;
            return false;
        }
        self.commit(&change);
        true
    }

    pub fn points(&self, change: &Change, face: &Face) -> [Point; 3] {
        face.corners.map(|v| match change.moved {
            Some((moved, place)) if moved == v => place,
            _ => self.surface.point(v),
        })
    }

    /// Neither slivers nor folds, as far as there were none.
    fn is_shapely(&self, change: &Change) -> bool {
        let before = change.old.iter().map(|&t| energy(self.surface.points(t))).fold(0.0, f64::max);
        let most = before.max(LARGEST_ENERGY);
        change.new.iter().all(|face| {
            let points = self.points(change, face);
            energy(points) <= most && dot(normal(points), normal(self.surface.points(face.parent))) > SMALLEST_COSINE
        })
    }

    /// Whether the change is right in the texture, exactly; finds the coordinates that it asks for. Makes the changes of
    /// the outline, if it is.
    fn fits_texture(&mut self, change: &mut Change) -> bool {
        let Some(atlas) = &mut self.atlas else { return true };
        let stands = |t: &u32| atlas.fits(atlas.charts[*t as usize], atlas.corners[*t as usize], |i| atlas.place(i));
        if !change.old.iter().all(stands) {
            return false;
        }
        if let (Marking::FromFirst(index), Some((_, point))) = (&change.marking, change.moved) {
            let chart = atlas.charts[change.old[0] as usize];
            match atlas.first_texture(point).filter(|(found, _)| *found == chart) {
                Some((_, place)) => change.marking = Marking::Given(vec![(*index, place)]),
                None => return false,
            }
        }
        let given: &[(u32, [f64; 2])] = match &change.marking {
            Marking::Given(given) => given,
            _ => &[],
        };
        let known = &atlas.coordinates;
        let place = |index: u32| {
            given.iter().find(|(set, _)| *set == index).map_or_else(|| known[index as usize], |(_, place)| *place)
        };
        if !change.new.iter().all(|face| atlas.fits(atlas.charts[face.parent as usize], face.marks, place)) {
            return false;
        }
        // One after the other: the second side of a seam has to go well with the first one as it will be.
        let is_longer = change.new.len() > change.old.len();
        for (done, &detour) in change.detours.iter().enumerate() {
            if !atlas.outline.is_clear(detour, place) {
                let outline = &mut atlas.outline;
                let undo = |d: &Detour| if is_longer { outline.shorten(*d) } else { outline.lengthen(*d) };
                change.detours[..done].iter().for_each(undo);
                return false;
            }
            if is_longer { atlas.outline.lengthen(detour) } else { atlas.outline.shorten(detour) }
        }
        true
    }

    fn commit(&mut self, change: &Change) {
        if let Some((vertex, place)) = change.moved {
            self.surface.place(vertex, place);
        }
        if let (Some(atlas), Marking::Given(given)) = (&mut self.atlas, &change.marking) {
            for &(index, place) in given {
                if index as usize == atlas.coordinates.len() {
                    atlas.coordinates.push(place);
                }
                atlas.coordinates[index as usize] = place;
            }
        }
        change.old.iter().for_each(|&t| self.surface.remove(t));
        let charts: Vec<u32> = match &self.atlas {
            Some(atlas) => change.new.iter().map(|face| atlas.charts[face.parent as usize]).collect(),
            None => Vec::new(),
        };
        for (k, face) in change.new.iter().enumerate() {
            let number = change.old.get(k).copied().unwrap_or(self.surface.triangles.len() as u32);
            self.surface.put(number, face.corners);
            if let Some(atlas) = &mut self.atlas {
                if number as usize == atlas.corners.len() {
                    atlas.corners.push(face.marks);
                    atlas.charts.push(charts[k]);
                }
                atlas.corners[number as usize] = face.marks;
                atlas.charts[number as usize] = charts[k];
            }
        }
    }

    /// The section as it is now.
    pub fn finished(&self) -> TexturedSurface {
        let (surface, kept) = self.surface.finished();
        TexturedSurface { surface, texture: self.atlas.as_ref().map(|atlas| atlas.finished(&kept)) }
    }
}

/// The edges that stay: boundary, seams, and where the normals differ by more than an angle.
fn creases(surface: &Surface, atlas: Option<&Atlas>, feature_angle: Option<f64>) -> Creases {
    let is_feature = |left: u32, right: u32| {
        let cosine = dot(normal(surface.points(left)), normal(surface.points(right)));
        feature_angle.is_some_and(|angle| cosine < angle.cos())
    };
    let kind = |[a, b]: [u32; 2]| match surface.both_sides(a, b) {
        None => Some(Kind::Boundary),
        Some(sides) if atlas.is_some_and(|atlas| atlas.is_seam(surface, [a, b], sides)) => Some(Kind::Seam),
        Some([left, right]) => is_feature(left, right).then_some(Kind::Feature),
    };
    let kept = surface.edges().into_iter().filter_map(|edge| Some((edge, kind(edge)?)));
    Creases::new(surface.positions.len(), kept)
}
