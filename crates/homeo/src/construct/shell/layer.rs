//! A shell under construction: columns, prisms, and which source triangles each prism may contain.

use std::collections::HashSet;

use homeo_core::spatial::{Aabb, Tree};
use rayon::prelude::*;

use super::ShellParams;
use super::directions::{dot, minus, triangles_around, unit_normal};
use super::kept::Kept;
use super::prism::{Column, Failure, FailureIn, Prism, is_inside_wall, is_outside, is_pinched, sides};
use super::sheets::Sheets;
use super::skin::{Face, Skin};
use crate::input::SourceMesh;
use crate::map::ShellParts;

type Point = [f64; 3];

/// With fewer pairs of triangles and prisms than this, one thread is faster than several.
const WORTH_SHARING: usize = 400;

/// Triangles that belong to a prism; `None` where all do that come near it.
pub(super) type Among<'t> = Option<&'t [u32]>;

/// The source surface, as the checks need it.
pub(super) struct Surface {
    triangles: Vec<[u32; 3]>,
    pub corners: Vec<[Point; 3]>,
    /// Unit normals, rounded.
    normals: Vec<Point>,
    /// No operation makes an angle between a pillar and a normal whose cosine is less, but where there was such an angle.
    least_cosine: f64,
    tree: Tree,
}

impl Surface {
    pub fn new(source: &SourceMesh<3>, least_cosine: f64) -> Self {
        let triangles: Vec<[u32; 3]> = source.complex().cells().iter().map(|cell| cell.map(|v| v.raw())).collect();
        let corners: Vec<[Point; 3]> =
            triangles.iter().map(|cell| cell.map(|v| source.positions()[v as usize])).collect();
        let boxes: Vec<Aabb> = corners.iter().map(|triangle| Aabb::of(triangle)).collect();
        Self {
            least_cosine,
            tree: Tree::new(&boxes),
            normals: corners.iter().map(|&c| unit_normal(c)).collect(),
            triangles,
            corners,
        }
    }

    /// Whether something holds for all triangles near some points; for those among the given ones, if there are any.
    fn all_near(&self, points: &[Point], among: Among<'_>, holds: impl Fn([Point; 3]) -> bool) -> bool {
        let region = Aabb::of(points);
        let mut do_hold = true;
        let mut visit = |t: usize| do_hold = do_hold && holds(self.corners[t]);
        match among {
            None => self.tree.query_box(&region, visit),
            Some(some) => {
                let near = some.iter().map(|&t| t as usize).filter(|&t| region.meets(&Aabb::of(&self.corners[t])));
                near.for_each(&mut visit);
            }
        }
        do_hold
    }

    /// L3: whether the surface stays off the caps of a prism.
    fn check_caps(&self, prism: &Prism, among: Among<'_>) -> Result<(), FailureIn> {
        let holds = |slab: usize| self.all_near(&prism.cap(slab), among, |triangle| prism.is_off_cap(slab, triangle));
        (0..2).find(|&slab| !holds(slab)).map_or(Ok(()), |slab| Err((Failure::Cap, slab)))
    }

    /// L3 for the wall over the side of a prism from its column `k` to the next, in the boundary.
    fn check_wall(&self, prism: &Prism, k: usize, among: Among<'_>) -> Result<(), FailureIn> {
        let holds = |wall: [Point; 3]| self.all_near(&wall, among, |triangle| is_inside_wall(wall, triangle));
        let failed = prism.walls_over(k).into_iter().find(|&(_, wall)| !holds(wall));
        failed.map_or(Ok(()), |(slab, _)| Err((Failure::Wall, slab)))
    }

    /// The triangles among `near` that may have an area in common with a prism; L4 for those that have.
    pub fn contents(&self, prism: &Prism, near: &[u32]) -> Result<Contents, FailureIn> {
        let hull = prism.hull();
        let walls = prism.outer_walls();
        let mut contents = Contents::default();
        for &t in near {
            let triangle = self.corners[t as usize];
            if !hull.meets(&Aabb::of(&triangle)) {
                continue;
            }
            let mut is_inside = false;
            for (slab, walls) in walls.iter().enumerate() {
                if walls.iter().any(|wall| is_outside(*wall, triangle)) {
                    continue;
                }
                // Mostly one of the first two will do, and spares slow exact signs.
                let is_fine = prism.is_clearly_crossed(slab, triangle);
                if !is_fine && prism.is_beside(slab, triangle) {
                    continue;
                }
                is_inside = true;
                if !is_fine && !prism.is_crossed(slab, triangle) {
                    if prism.shares_area(slab, triangle) {
                        return Err((Failure::Crossing, slab));
                    }
                    continue;
                }
                let cosine = prism.smallest_cosine(slab, self.normals[t as usize]);
                // A triangle that is only near does not count where that matters.
                if cosine < contents.cosine && (cosine >= self.least_cosine || prism.shares_area(slab, triangle)) {
                    contents.cosine = cosine;
                }
            }
            if is_inside {
                contents.triangles.push(t);
            }
        }
        Ok(contents)
    }

    /// Whether what a prism over a triangle holds is one piece of the surface round that triangle. Another sheet may be
    /// crossed in the positive sense too, where sheets of one orientation lie over one another.
    fn check_one_sheet(&self, prism: &Prism, triangle: u32, contents: &[u32]) -> Result<(), FailureIn> {
        let touches =
            |t: u32, u: u32| self.triangles[t as usize].iter().any(|v| self.triangles[u as usize].contains(v));
        let mut others: Vec<u32> = contents.iter().copied().filter(|&t| t != triangle).collect();
        let mut reached = vec![triangle];
        while let Some(t) = reached.pop() {
            reached.extend(others.extract_if(.., |other| touches(t, *other)));
        }
        let is_held = |slab: usize| others.iter().any(|&t| prism.shares_area(slab, self.corners[t as usize]));
        (0..2).find(|&slab| is_held(slab)).map_or(Ok(()), |slab| Err((Failure::Sheet, slab)))
    }
}

/// What of the surface lies in a prism.
#[derive(Clone)]
pub(super) struct Contents {
    /// All source triangles with which it has an area in common, and perhaps others near it, ascending; where the surface
    /// may cross itself, those that belong to it.
    pub triangles: Vec<u32>,
    /// The least cosine of the angle between one of its pillars and the normal of one of them (above the bound also of one
    /// near it); rounded.
    pub cosine: f64,
}

impl Default for Contents {
    fn default() -> Self {
        Self { triangles: Vec::new(), cosine: 1.0 }
    }
}

/// See the module's documentation.
pub(super) struct Layer {
    pub surface: Surface,
    pub columns: Vec<Column>,
    pub prisms: Vec<[u32; 3]>,
    /// Whether each prism still exists.
    pub exists: Vec<bool>,
    /// Edges of prisms on the boundary of the surface, in the prisms' direction.
    boundary: HashSet<[u32; 2]>,
    /// Columns on the boundary, which stay as they are.
    pub is_frozen: Vec<bool>,
    /// The prisms at each column.
    pub around: Vec<Vec<u32>>,
    /// What each prism holds.
    pub contents: Vec<Contents>,
    /// Whether operations may make columns shorter.
    pub may_shorten: bool,
    /// Bottoms, tops and walls, if the shell is not to overlap itself.
    skin: Option<Skin>,
    /// What is to stay, apart from the boundary.
    pub kept: Kept,
    /// Round surfaces that may cross themselves.
    pub sheets: Option<Sheets>,
}

impl Layer {
    /// The layer of the given columns over the triangles of `base`, which is the source or nearly so; nothing checked yet.
    pub fn new(source: &SourceMesh<3>, base: &SourceMesh<3>, columns: Vec<Column>, params: &ShellParams) -> Self {
        let prisms: Vec<[u32; 3]> = base.complex().cells().iter().map(|cell| cell.map(|v| v.raw())).collect();
        let mut boundary: HashSet<[u32; 2]> = prisms.iter().flat_map(|&p| sides(p)).collect();
        let all: Vec<[u32; 2]> = boundary.iter().copied().collect();
        for [a, b] in all {
            if boundary.contains(&[b, a]) {
                boundary.remove(&[a, b]);
                boundary.remove(&[b, a]);
            }
        }
        let mut is_frozen = vec![false; columns.len()];
        boundary.iter().flatten().for_each(|&v| is_frozen[v as usize] = true);
        Self {
            surface: Surface::new(source, params.largest_angle.cos()),
            boundary,
            is_frozen,
            columns,
            exists: vec![true; prisms.len()],
            around: triangles_around(base.complex()),
            contents: vec![Contents::default(); prisms.len()],
            may_shorten: false,
            skin: None,
            kept: Kept::new(base, &params.frozen, params.feature_angle),
            sheets: None,
            prisms,
        }
    }

    pub fn is_pinched(&self, column: u32) -> bool {
        is_pinched(self.columns[column as usize])
    }

    pub fn prism(&self, corners: [u32; 3]) -> Prism {
        Prism::new(corners.map(|v| self.columns[v as usize]))
    }

    /// L2 for a prism.
    pub fn check_volumes(&self, prism: u32) -> Result<(), FailureIn> {
        self.prism(self.prisms[prism as usize]).check_volumes()
    }

    /// Finds the contents of prisms that satisfy L2 among all source triangles, and checks L3, L4 and that they are one
    /// sheet round the triangles over which the prisms stand, their `parents`. Returns those that fail, in the order given,
    /// with what fails first.
    pub fn fill(&mut self, prisms: &[u32], parents: &[u32]) -> Vec<(u32, FailureIn)> {
        if self.sheets.is_some() {
            return self.fill_by_sheets(prisms, parents);
        }
        let find = |&prism: &u32| {
            let contents = self.find_contents(prism)?;
            let body = self.prism(self.prisms[prism as usize]);
            self.surface.check_one_sheet(&body, parents[prism as usize], &contents.triangles)?;
            Ok(contents)
        };
        let found: Vec<_> = prisms.par_iter().map(find).collect();
        let mut failures = Vec::new();
        for (&prism, found) in prisms.iter().zip(found) {
            match found {
                Ok(contents) => self.contents[prism as usize] = contents,
                Err(failure) => failures.push((prism, failure)),
            }
        }
        failures
    }

    /// L2 to L4 for a prism, from scratch.
    pub fn is_valid(&self, prism: u32) -> bool {
        let is_filled = || match self.sheets {
            None => self.find_contents(prism).is_ok(),
            Some(_) => self.check_belonging(prism).is_ok() && self.is_complete(prism),
        };
        self.check_volumes(prism).is_ok() && is_filled()
    }

    /// The contents of a prism among all source triangles, if they satisfy L3 and L4.
    fn find_contents(&self, prism: u32) -> Result<Contents, FailureIn> {
        let corners = self.prisms[prism as usize];
        let body = self.prism(corners);
        self.check_l3(&body, corners, None)?;
        let mut near = Vec::new();
        self.surface.tree.query_box(&body.hull(), |t| near.push(t as u32));
        near.sort_unstable();
        self.surface.contents(&body, &near)
    }

    /// L3 for a prism, caps and walls.
    pub fn check_l3(&self, body: &Prism, corners: [u32; 3], among: Among<'_>) -> Result<(), FailureIn> {
        self.surface.check_caps(body, among)?;
        let walls = sides(corners).into_iter().enumerate().filter(|(_, side)| self.boundary.contains(side));
        walls.map(|(k, _)| k).try_for_each(|k| self.surface.check_wall(body, k, among))
    }

    /// Replaces prisms by others over the same part of the surface if the new ones satisfy L2 to L4; `columns` may have
    /// been changed before. Their common side walls must be as before, so what the old ones held the new ones hold.
    /// Returns the new prisms' numbers: as many of the old ones as are needed.
    pub fn replace(&mut self, old: &[u32], new: &[[u32; 3]]) -> Result<(), FailureIn> {
        debug_assert!(new.len() <= old.len());
        let bodies: Vec<Prism> = new.iter().map(|&corners| self.prism(corners)).collect();
        bodies.iter().try_for_each(Prism::check_volumes)?;
        let mut held: Vec<u32> =
            old.iter().flat_map(|&p| self.contents[p as usize].triangles.iter().copied()).collect();
        held.sort_unstable();
        held.dedup();
        let find = |body: &Prism| match self.sheets {
            None => self.surface.contents(body, &held),
            Some(_) => self.belonging(body, &held),
        };
        let contents: Vec<Contents> = if held.len() * bodies.len() < WORTH_SHARING {
            bodies.iter().map(find).collect::<Result<_, _>>()?
        } else {
            bodies.par_iter().map(find).collect::<Result<_, _>>()?
        };
        self.check_angles(old, &contents)?;
        match self.sheets {
            None => bodies.iter().try_for_each(|body| self.surface.check_caps(body, None))?,
            Some(_) => self.check_replaced(old, &bodies, new, &contents)?,
        }
        self.replace_skin(old, new)?;
        for &prism in old {
            for column in self.prisms[prism as usize] {
                self.around[column as usize].retain(|&other| other != prism);
            }
            self.exists[prism as usize] = false;
            self.contents[prism as usize] = Contents::default();
        }
        for ((&prism, &corners), contents) in old.iter().zip(new).zip(contents) {
            self.exists[prism as usize] = true;
            self.prisms[prism as usize] = corners;
            self.contents[prism as usize] = contents;
            corners.iter().for_each(|&column| self.around[column as usize].push(prism));
        }
        Ok(())
    }

    /// Whether new contents are met by pillars at angles that are allowed, or no larger than before.
    fn check_angles(&self, old: &[u32], new: &[Contents]) -> Result<(), FailureIn> {
        let before = old.iter().map(|&prism| self.contents[prism as usize].cosine).fold(1.0, f64::min);
        let after = new.iter().map(|contents| contents.cosine).fold(1.0, f64::min);
        if after < before.min(self.surface.least_cosine) { Err((Failure::Angle, 0)) } else { Ok(()) }
    }

    /// The largest angle between a pillar of a prism and the normal of a triangle in it, in radians (below the bound also
    /// of a triangle near it); rounded.
    pub fn largest_angle(&self) -> f64 {
        let existing = self.contents.iter().zip(&self.exists).filter(|(_, exists)| **exists);
        existing.map(|(contents, _)| contents.cosine).fold(1.0, f64::min).acos()
    }

    /// Gives the new prisms, which get numbers of the old ones in their order, their places in the skin, if there is one and
    /// it does not meet itself then.
    fn replace_skin(&mut self, old: &[u32], new: &[[u32; 3]]) -> Result<(), FailureIn> {
        let Some(skin) = &mut self.skin else { return Ok(()) };
        let caps: Vec<[Face; 2]> =
            old.iter().zip(new).map(|(&prism, &corners)| Face::caps(prism, corners, &self.columns)).collect();
        if !skin.admits(old, &caps) {
            return Err((Failure::Skin, 0));
        }
        skin.replace(old, caps);
        Ok(())
    }

    /// From now on the shell must not overlap itself. Returns the prisms that are too thick for that, and their slabs,
    /// ascending; if there are any, nothing is kept.
    pub fn keep_apart(&mut self) -> Vec<(u32, usize)> {
        let skin = Skin::new(&self.prisms, &self.columns, |side| self.boundary.contains(&side));
        let mut clashing: Vec<(u32, usize)> = skin.clashing().map(|face| (face.owner.prism(), face.slab)).collect();
        clashing.sort_unstable();
        clashing.dedup();
        self.skin = clashing.is_empty().then_some(skin);
        clashing
    }

    /// Accepts a column that was changed, if its prisms satisfy L2 to L4.
    pub fn recheck(&mut self, column: u32) -> Result<(), FailureIn> {
        let prisms = self.around[column as usize].clone();
        let corners: Vec<[u32; 3]> = prisms.iter().map(|&p| self.prisms[p as usize]).collect();
        self.replace(&prisms, &corners)
    }

    /// A column like `wanted` with its middle where it meets the surface, with the lengths of the present column;
    /// `None` if it does not meet what the prisms round it hold.
    pub fn with_middle_on_surface(&self, column: u32, wanted: Column) -> Option<Column> {
        let [from, _, to] = wanted;
        let held = self.around[column as usize].iter().flat_map(|&p| &self.contents[p as usize].triangles);
        let share = held.filter_map(|&t| hit(from, to, self.surface.corners[t as usize])).next()?;
        let at = |share: f64| [0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        let [bottom, middle, top] = self.columns[column as usize];
        let length = |a: Point, b: Point| minus(a, b).iter().map(|x| x * x).sum::<f64>().sqrt();
        let (down, up, whole) = (length(bottom, middle), length(top, middle), length(from, to));
        Some([at(share - down / whole), at(share), at(share + up / whole)])
    }

    /// Columns that share a prism with the given one, ascending.
    pub fn neighbours(&self, column: u32) -> Vec<u32> {
        let corners = self.around[column as usize].iter().flat_map(|&p| self.prisms[p as usize]);
        let mut found: Vec<u32> = corners.filter(|&other| other != column).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// How many prisms there are.
    pub fn count(&self) -> usize {
        self.exists.iter().filter(|exists| **exists).count()
    }

    /// The finished shell, with columns numbered anew.
    pub fn into_parts(self) -> ShellParts {
        let mut number = vec![u32::MAX; self.columns.len()];
        let mut parts = ShellParts::default();
        for (corners, _) in self.prisms.iter().zip(&self.exists).filter(|(_, exists)| **exists) {
            for &column in corners {
                if number[column as usize] == u32::MAX {
                    number[column as usize] = parts.middle.len() as u32;
                    let [bottom, middle, top] = self.columns[column as usize];
                    parts.bottom.push(bottom);
                    parts.middle.push(middle);
                    parts.top.push(top);
                }
            }
            parts.prisms.push(corners.map(|column| number[column as usize]));
        }
        parts.is_embedded = self.skin.is_some();
        parts.pairs = self.sheets.is_some().then(|| self.pairs());
        parts
    }
}

/// Where a segment meets a triangle, as a share of it; rounded, and no decision rests on it.
fn hit(from: Point, to: Point, [a, b, c]: [Point; 3]) -> Option<f64> {
    let (u, v, step, base) = (minus(b, a), minus(c, a), minus(to, from), minus(from, a));
    let cross = |p: Point, q: Point| [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let normal = cross(u, v);
    let speed = dot(normal, step);
    let share = -dot(normal, base) / speed;
    let place = [0, 1, 2].map(|axis| base[axis] + share * step[axis]);
    let size = dot(normal, normal);
    let (x, y) = (dot(cross(place, v), normal) / size, dot(cross(u, place), normal) / size);
    (x >= -1e-9 && y >= -1e-9 && x + y <= 1.0 + 1e-9 && (0.0..=1.0).contains(&share)).then_some(share)
}

/// Twice the area of a triangle, and the sum of its squared sides.
pub(in crate::construct) fn area_and_sides([a, b, c]: [Point; 3]) -> (f64, f64) {
    let (u, v, w) = (minus(b, a), minus(c, a), minus(c, b));
    let square = |x: Point| x.iter().map(|c| c * c).sum::<f64>();
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    (square(cross).sqrt(), square(u) + square(v) + square(w))
}
