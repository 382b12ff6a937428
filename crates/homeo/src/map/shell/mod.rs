//! The projection in a prismatic shell; what it is and why it is bijective: `docs/theory/shells.md`.

mod lines;
mod space;
mod surface;

use homeo_core::number::{Interval, Rational, Scalar};
use homeo_core::predicate::{Sign, orient3d};
use homeo_core::spatial::{Aabb, Tree};

use self::lines::Stop;
pub(crate) use self::surface::ShellSurface;
use super::Enclosed;
use crate::input::SourceMesh;

type Point = [f64; 3];
type ExactPoint = [Rational; 3];

/// The data that define a shell. Columns have a bottom, a middle and a top; a prism stands on three of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShellParts {
    /// Lowest points of the columns, `#P by 3`.
    pub bottom: Vec<Point>,
    /// Points of the middle surface, `#P by 3`.
    pub middle: Vec<Point>,
    /// Highest points, `#P by 3`.
    pub top: Vec<Point>,
    /// Columns of each prism, counter-clockwise seen from the top, `#Q by 3`.
    pub prisms: Vec<[u32; 3]>,
    /// Round a surface that may cross itself: the triangles of the source and the prisms that belong together, `#K by 2`,
    /// ascending. `None` where all do.
    pub pairs: Option<Vec<[u32; 2]>>,
    /// Whether it claims that it does not overlap itself anywhere in space. A section kept with it does not.
    pub is_embedded: bool,
}

impl ShellParts {
    /// Whether a column has no length.
    pub(crate) fn is_pinched(&self, column: u32) -> bool {
        let column = column as usize;
        self.bottom[column] == self.middle[column] && self.middle[column] == self.top[column]
    }

    /// Whether a triangle of the source belongs to a prism; where the surface does not cross itself all do.
    pub(crate) fn are_paired(&self, triangle: u32, prism: u32) -> bool {
        self.pairs.as_ref().is_none_or(|pairs| pairs.binary_search(&[triangle, prism]).is_ok())
    }
}

/// A point of a shell: a prism, barycentric weights in its middle triangle (in the prism's order, adding up to 1), and
/// a height from -1 (bottom) to 1 (top).
#[derive(Clone, Debug, PartialEq)]
pub struct ShellPoint<T> {
    /// The prism.
    pub prism: u32,
    /// Weights of its columns.
    pub weights: [T; 3],
    /// Height above the middle surface.
    pub height: T,
}

/// A point of a surface in the shell.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfacePoint<T> {
    /// A triangle of the surface.
    pub triangle: u32,
    /// Barycentric weights of its corners, adding up to 1.
    pub weights: [T; 3],
    /// The point of space.
    pub point: [T; 3],
}

/// Why a point has no image.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShellEvaluationError {
    /// The point lies in no prism.
    #[error("the point lies outside the shell")]
    Outside,
    /// The shell overlaps itself there.
    #[error("the point lies in prisms {0} and {1} of the shell, which overlap there")]
    Ambiguous(u32, u32),
    /// A coordinate is not finite.
    #[error("the point has a coordinate that is not a finite number")]
    NotFinite,
    /// No prism has this number, or the weights or the height are out of range.
    #[error("there is no such point in the shell")]
    NoSuchPoint,
}

/// A shell round a surface, with the projection along its pillars.
///
/// Of two points with equal prism and weights one lies above the other on the same pillar line (a polyline, parallel to
/// one pillar in each tetrahedron). The pillar lines join the source to the middle surface, and to any other *section*:
/// a surface that lies in the shell and is crossed by its pillars in the same sense. One section can be kept here; the map
/// of the shell then goes from the source onto it, and onto the middle surface otherwise.
///
/// Images in floating point are enclosures; where rounding leaves a branch open, they are computed exactly and rounded.
#[derive(Debug)]
pub struct Shell {
    pub(crate) source: ShellSurface,
    pub(crate) section: Option<ShellSurface>,
    parts: ShellParts,
    /// Over the slabs: `2 * prism` is the lower one, `2 * prism + 1` the upper one.
    slabs: Tree,
    /// Images that would be less certain than this are computed exactly.
    accuracy: f64,
}

/// Part of the shell's size.
const ACCURACY: f64 = 1e-10;

impl Shell {
    /// Joins the data of a shell. What they must satisfy is checked by the certificate, not here.
    ///
    /// # Panics
    /// If a prism has a column that does not exist, or the numbers of bottoms, middles and tops differ.
    pub fn from_parts(source: SourceMesh<3>, parts: ShellParts) -> Self {
        assert!(parts.bottom.len() == parts.middle.len() && parts.middle.len() == parts.top.len());
        let slab = |number: usize| {
            let levels = [[&parts.bottom, &parts.middle], [&parts.middle, &parts.top]][number % 2];
            let points = parts.prisms[number / 2].map(|v| levels.map(|level| level[v as usize]));
            Aabb::of(points.as_flattened())
        };
        let slabs: Vec<Aabb> = (0..2 * parts.prisms.len()).map(slab).collect();
        let hull = Aabb::of(&parts.middle);
        let size = (0..3).map(|axis| hull.high[axis] - hull.low[axis]).fold(0.0, f64::max);
        Self {
            slabs: Tree::new(&slabs),
            source: ShellSurface::new(source),
            section: None,
            accuracy: ACCURACY * size,
            parts,
        }
    }

    /// The same shell, with another section as the image of the source. For a shell of a surface that may cross itself
    /// the format knows no such map, and there is no theorem about it here.
    #[must_use]
    pub fn with_section(self, section: SourceMesh<3>) -> Self {
        Self { section: Some(ShellSurface::new(section)), ..self }
    }

    /// The surface round which the shell lies.
    pub fn source(&self) -> &SourceMesh<3> {
        &self.source.mesh
    }

    /// The other section, if there is one.
    pub fn section(&self) -> Option<&SourceMesh<3>> {
        self.section.as_ref().map(|section| &section.mesh)
    }

    /// The data that define the shell.
    pub fn parts(&self) -> &ShellParts {
        &self.parts
    }

    /// The prism, weights and height of a rational point, exactly.
    ///
    /// # Errors
    /// When the point lies in no prism, or in two that overlap there.
    pub fn project_exact(&self, point: &ExactPoint) -> Result<ShellPoint<Rational>, ShellEvaluationError> {
        let near = point.each_ref().map(Rational::to_f64);
        if !near.iter().all(|x| x.is_finite()) {
            return Err(ShellEvaluationError::NotFinite);
        }
        let region = Aabb { low: near.map(f64::next_down), high: near.map(f64::next_up) };
        self.locate(point, &region).map_err(certain)
    }

    /// The prism, weights and height of a point, enclosed.
    ///
    /// # Errors
    /// As for [`project_exact`](Self::project_exact).
    pub fn project(&self, point: Point) -> Result<ShellPoint<Interval>, ShellEvaluationError> {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(ShellEvaluationError::NotFinite);
        }
        match self.locate(&point.map(Interval::from_f64), &Aabb { low: point, high: point }) {
            Ok(at) => Ok(at),
            Err(Stop::None(error)) => Err(error),
            Err(Stop::Undecided) => {
                let at = self.project_exact(&exactly(point))?;
                let weights = at.weights.each_ref().map(Interval::around);
                Ok(ShellPoint { prism: at.prism, weights, height: Interval::around(&at.height) })
            }
        }
    }

    /// The point of space with the given prism, weights and height, exactly.
    ///
    /// # Errors
    /// When there is no such prism, a weight is negative, they do not add up to 1, or the height is not in `[-1, 1]`.
    pub fn unproject_exact(&self, at: &ShellPoint<Rational>) -> Result<ExactPoint, ShellEvaluationError> {
        self.check_point(at)?;
        self.point_at(at).map_err(|undecided| certain(undecided.into()))
    }

    /// The point of space with the given prism, weights and height, rounded from the exact one. The last weight is what is
    /// missing from the others to 1; the one given is not looked at.
    ///
    /// # Errors
    /// As for [`unproject_exact`](Self::unproject_exact).
    pub fn unproject(&self, at: &ShellPoint<f64>) -> Result<Enclosed, ShellEvaluationError> {
        let [a, b, _] = at.weights;
        if ![a, b, at.height].iter().all(|x| x.is_finite()) {
            return Err(ShellEvaluationError::NotFinite);
        }
        let [a, b, height] = exactly([a, b, at.height]);
        let rest = &(&Rational::ONE - &a) - &b;
        self.unproject_exact(&ShellPoint { prism: at.prism, weights: [a, b, rest], height }).map(|p| rounded(&p))
    }

    /// Where a point of the source, known by a triangle and barycentric weights, lies in the shell, exactly. Unlike
    /// [`project_exact`](Self::project_exact) this has one answer also where the surface crosses itself.
    ///
    /// # Errors
    /// When there is no such triangle, a weight is negative, they do not add up to 1, or the shell's certificate does not
    /// hold.
    pub fn lift_exact(
        &self,
        triangle: u32,
        weights: &[Rational; 3],
    ) -> Result<ShellPoint<Rational>, ShellEvaluationError> {
        let are_weights =
            weights.iter().all(|w| *w >= Rational::ZERO) && weights.iter().cloned().sum::<Rational>() == Rational::ONE;
        if !are_weights || triangle as usize >= self.source.mesh.complex().cell_count() {
            return Err(ShellEvaluationError::NoSuchPoint);
        }
        let corners = self.source.corners(triangle);
        let point = space::combination(weights, &corners.map(space::point_of));
        let slabs = self.slabs_near(&Aabb::of(&corners)).into_iter();
        let belongs = |slab: &usize| self.parts.are_paired(triangle, (slab / 2) as u32);
        self.locate_among(slabs.filter(belongs), &point).map_err(certain)
    }

    /// The point of the middle surface over or under which a rational point lies, exactly.
    ///
    /// # Errors
    /// As for [`project_exact`](Self::project_exact).
    pub fn to_middle_exact(&self, point: &ExactPoint) -> Result<ShellPoint<Rational>, ShellEvaluationError> {
        self.project_exact(point).map(|at| ShellPoint { height: Rational::ZERO, ..at })
    }

    /// The point of the source surface on the pillar line of a point of the shell, exactly: the inverse of
    /// [`to_middle_exact`](Self::to_middle_exact) on the source.
    ///
    /// # Errors
    /// When there is no such prism, the weights are out of range, or the shell's certificate does not hold.
    pub fn to_source_exact(&self, at: &ShellPoint<Rational>) -> Result<SurfacePoint<Rational>, ShellEvaluationError> {
        self.meet_exactly(&self.source, at)
    }

    /// The point of the other section on the pillar line of a point of the shell, exactly; of the middle surface where no
    /// section is kept (then its triangles are the prisms).
    ///
    /// # Errors
    /// As for [`to_source_exact`](Self::to_source_exact).
    pub fn to_section_exact(&self, at: &ShellPoint<Rational>) -> Result<SurfacePoint<Rational>, ShellEvaluationError> {
        match &self.section {
            Some(section) => self.meet_exactly(section, at),
            None => {
                self.check_point(at)?;
                let point = self.middle_at(at);
                Ok(SurfacePoint { triangle: at.prism, weights: at.weights.clone(), point })
            }
        }
    }

    /// The point of the middle surface on the pillar line of a point.
    ///
    /// # Errors
    /// As for [`project_exact`](Self::project_exact).
    pub fn to_middle(&self, point: Point) -> Result<Enclosed, ShellEvaluationError> {
        let near = enclosure(&self.middle_at(&self.project(point)?));
        if near.radius <= self.accuracy {
            return Ok(near);
        }
        Ok(rounded(&self.middle_at(&self.project_exact(&exactly(point))?)))
    }

    /// The point of the source surface on the pillar line of a point.
    ///
    /// # Errors
    /// As for [`project_exact`](Self::project_exact) and [`to_source_exact`](Self::to_source_exact).
    pub fn to_source(&self, point: Point) -> Result<Enclosed, ShellEvaluationError> {
        self.enclose_on(&self.source, point)
    }

    /// The triangle of the source on the pillar line of a point, and where in it, enclosed.
    ///
    /// # Errors
    /// As for [`to_source`](Self::to_source).
    pub fn on_source(&self, point: Point) -> Result<SurfacePoint<Interval>, ShellEvaluationError> {
        self.meet_closely(&self.source, point)
    }

    /// The point of the other section on the pillar line of a point, or of the middle surface where none is kept.
    ///
    /// # Errors
    /// As for [`to_source`](Self::to_source).
    pub fn to_section(&self, point: Point) -> Result<Enclosed, ShellEvaluationError> {
        match &self.section {
            Some(section) => self.enclose_on(section, point),
            None => self.to_middle(point),
        }
    }

    /// The slabs whose boxes meet a box: `2 * prism` is a lower one, `2 * prism + 1` an upper one.
    pub(crate) fn slabs_near(&self, region: &Aabb) -> Vec<usize> {
        let mut slabs = Vec::new();
        self.slabs.query_box(region, |slab| slabs.push(slab));
        slabs.sort_unstable();
        slabs
    }

    /// Whether a point lies in the shell, exactly: in one prism or in several.
    pub fn is_inside(&self, point: Point) -> bool {
        let mut is_inside = false;
        self.slabs.query_point(point, |slab| {
            is_inside = is_inside || self.slab_cells(slab).into_iter().any(|(_, cell)| contains(cell, point));
        });
        is_inside
    }

    /// Where the pillar line of a point meets a surface: by enclosing numbers if they decide everything and are accurate
    /// enough, or else exactly.
    fn meet_closely(
        &self,
        surface: &ShellSurface,
        point: Point,
    ) -> Result<SurfacePoint<Interval>, ShellEvaluationError> {
        let at = self.project(point)?;
        let met = self.fibre(&at).map_err(Stop::from).and_then(|line| self.meet(surface, at.prism, &line));
        // In a thin triangle the point may be certain and its weights not.
        let are_sharp = |met: &SurfacePoint<Interval>| enclosure(&met.weights).radius <= ACCURACY;
        let is_sharp = |met: &SurfacePoint<Interval>| enclosure(&met.point).radius <= self.accuracy && are_sharp(met);
        if let Some(met) = met.ok().filter(is_sharp) {
            return Ok(met);
        }
        let exact = self.meet_exactly(surface, &self.project_exact(&exactly(point))?)?;
        Ok(SurfacePoint {
            triangle: exact.triangle,
            weights: exact.weights.each_ref().map(Interval::around),
            point: exact.point.each_ref().map(Interval::around),
        })
    }

    /// The point where the pillar line of a point meets a surface.
    fn enclose_on(&self, surface: &ShellSurface, point: Point) -> Result<Enclosed, ShellEvaluationError> {
        let at = self.project(point)?;
        let line = self.fibre(&at).ok().filter(|line| line.len() > 1);
        let near = line.and_then(|line| self.enclose(surface, at.prism, &line)).map(|image| enclosure(&image));
        match near.filter(|near| near.radius <= self.accuracy) {
            Some(near) => Ok(near),
            None => self.meet_closely(surface, point).map(|met| enclosure(&met.point)),
        }
    }

    fn meet_exactly(
        &self,
        surface: &ShellSurface,
        at: &ShellPoint<Rational>,
    ) -> Result<SurfacePoint<Rational>, ShellEvaluationError> {
        self.check_point(at)?;
        let line = self.fibre(at).map_err(|undecided| certain(undecided.into()))?;
        self.meet(surface, at.prism, &line).map_err(certain)
    }

    /// Whether there is such a prism, the weights are possible, and the height is in range.
    fn check_point(&self, at: &ShellPoint<Rational>) -> Result<(), ShellEvaluationError> {
        let fits = (at.prism as usize) < self.parts.prisms.len()
            && at.weights.iter().all(|w| *w >= Rational::ZERO)
            && at.weights.iter().cloned().sum::<Rational>() == Rational::ONE
            && (-Rational::ONE..=Rational::ONE).contains(&at.height);
        if fits { Ok(()) } else { Err(ShellEvaluationError::NoSuchPoint) }
    }

    /// A point of a column: level 0 is the bottom, 1 the middle, 2 the top.
    fn level(&self, column: u32, level: usize) -> Point {
        [&self.parts.bottom, &self.parts.middle, &self.parts.top][level][column as usize]
    }

    fn is_pinched(&self, column: u32) -> bool {
        self.parts.is_pinched(column)
    }
}

/// Exact numbers leave nothing open.
fn certain(stop: Stop) -> ShellEvaluationError {
    match stop {
        Stop::None(error) => error,
        Stop::Undecided => {
            debug_assert!(false, "an exact sign was not decided");
            ShellEvaluationError::Outside
        }
    }
}

/// Finite numbers, exactly.
fn exactly<const N: usize>(numbers: [f64; N]) -> [Rational; N] {
    numbers.map(<Rational as Scalar>::from_f64)
}

/// The nearest doubles, with the bound that rounding to nearest has.
fn rounded(point: &ExactPoint) -> Enclosed {
    let point = point.each_ref().map(Rational::to_f64);
    let size = point.iter().fold(0.0f64, |size, x| size.max(x.abs()));
    Enclosed { point, radius: f64::EPSILON * size }
}

fn enclosure(image: &[Interval; 3]) -> Enclosed {
    let parts = image.each_ref().map(Interval::middle_and_radius);
    Enclosed { point: parts.map(|(middle, _)| middle), radius: parts.iter().fold(0.0, |r, part| r.max(part.1)) }
}

fn contains(cell: [Point; 4], point: Point) -> bool {
    let whole = orient3d(cell[0], cell[1], cell[2], cell[3]);
    whole != Sign::Zero
        && (0..4).all(|i| {
            let mut moved = cell;
            moved[i] = point;
            let sign = orient3d(moved[0], moved[1], moved[2], moved[3]);
            sign == whole || sign == Sign::Zero
        })
}
