//! The projection in a prismatic shell; what it is and why it is bijective: `docs/theory/shells.md`.

use homeo_core::number::Rational;
use homeo_core::predicate::{Sign, orient3d};
use homeo_core::spatial::{Aabb, Tree};

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
}

impl ShellParts {
    /// Whether a column has no length.
    pub(crate) fn is_pinched(&self, column: u32) -> bool {
        let column = column as usize;
        self.bottom[column] == self.middle[column] && self.middle[column] == self.top[column]
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

/// A point of the source surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfacePoint {
    /// A triangle of the source.
    pub triangle: u32,
    /// The point, exactly.
    pub point: ExactPoint,
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
/// one pillar in each tetrahedron).
#[derive(Debug)]
pub struct Shell {
    source: SourceMesh<3>,
    parts: ShellParts,
    /// Over the slabs: `2 * prism` is the lower one, `2 * prism + 1` the upper one.
    slabs: Tree,
    triangles: Tree,
}

/// A corner of a tetrahedron of a slab: which column of the prism (0 to 2), and whether its high point.
type Corner = (usize, bool);

impl Shell {
    /// Joins the data of a shell. What they must satisfy is checked by the certificate, not here.
    ///
    /// # Panics
    /// If a prism has a column that does not exist, or the numbers of bottoms, middles and tops differ.
    pub fn from_parts(source: SourceMesh<3>, parts: ShellParts) -> Self {
        assert!(parts.bottom.len() == parts.middle.len() && parts.middle.len() == parts.top.len());
        let slab = |number: usize| {
            let points = parts.prisms[number / 2].map(|v| level_pair(&parts, v as usize, number % 2));
            Aabb::of(points.as_flattened())
        };
        let slabs: Vec<Aabb> = (0..2 * parts.prisms.len()).map(slab).collect();
        let corner = |v: homeo_core::mesh::VertexId| source.positions()[v.index()];
        let triangles: Vec<Aabb> = source.complex().cells().iter().map(|cell| Aabb::of(&cell.map(corner))).collect();
        Self { slabs: Tree::new(&slabs), triangles: Tree::new(&triangles), source, parts }
    }

    /// The surface round which the shell lies.
    pub fn source(&self) -> &SourceMesh<3> {
        &self.source
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
        let mut candidates = Vec::new();
        self.slabs.query_box(&region, |slab| candidates.push(slab));
        candidates.sort_unstable();
        let mut found: Option<ShellPoint<Rational>> = None;
        for slab in candidates {
            let Some(here) = self.project_in_slab(slab, point) else { continue };
            match &found {
                None => found = Some(here),
                Some(first) if self.is_same(first, &here) => {}
                Some(first) => return Err(ShellEvaluationError::Ambiguous(first.prism, here.prism)),
            }
        }
        found.ok_or(ShellEvaluationError::Outside)
    }

    /// The point of space with the given prism, weights and height, exactly.
    ///
    /// # Errors
    /// When there is no such prism, a weight is negative, they do not add up to 1, or the height is not in `[-1, 1]`.
    pub fn unproject_exact(&self, at: &ShellPoint<Rational>) -> Result<ExactPoint, ShellEvaluationError> {
        self.check_point(at)?;
        let upper = at.height >= Rational::ZERO;
        let height = if upper { at.height.clone() } else { &at.height + &Rational::ONE };
        let slab = 2 * at.prism as usize + usize::from(upper);
        // How much of each column's weight is at its high point: the columns with the largest numbers rise first.
        let mut high = [Rational::ZERO, Rational::ZERO, Rational::ZERO];
        let mut left = &height * &self.lifted(at);
        for k in self.rising(at.prism) {
            high[k] = if left < at.weights[k] { left.clone() } else { at.weights[k].clone() };
            left = &left - &high[k];
        }
        let columns = self.parts.prisms[slab / 2].map(|v| level_pair(&self.parts, v as usize, slab % 2));
        Ok(std::array::from_fn(|axis| {
            let terms = (0..3).map(|k| {
                let low = &at.weights[k] - &high[k];
                &(&low * &exact(columns[k][0][axis])) + &(&high[k] * &exact(columns[k][1][axis]))
            });
            terms.sum()
        }))
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
    pub fn to_source_exact(&self, at: &ShellPoint<Rational>) -> Result<SurfacePoint, ShellEvaluationError> {
        let fibre = self.fibre(at)?;
        let near: Vec<Point> = fibre.iter().map(|p| p.each_ref().map(Rational::to_f64)).collect();
        let hull = Aabb::of(&near);
        let region = Aabb { low: hull.low.map(f64::next_down), high: hull.high.map(f64::next_up) };
        let mut candidates = Vec::new();
        self.triangles.query_box(&region, |t| candidates.push(t as u32));
        candidates.sort_unstable();
        if let [pinched] = fibre.as_slice() {
            let is_corner = |t: &u32| {
                self.source.complex().cells()[*t as usize].iter().any(|v| self.source.positions()[v.index()] == near[0])
            };
            let triangle = candidates.into_iter().find(is_corner).ok_or(ShellEvaluationError::Outside)?;
            return Ok(SurfacePoint { triangle, point: pinched.clone() });
        }
        for t in candidates {
            let corners =
                self.source.complex().cells()[t as usize].map(|v| self.source.positions()[v.index()].map(exact));
            for ends in fibre.windows(2) {
                if let Some(point) = crossing(&ends[0], &ends[1], &corners) {
                    return Ok(SurfacePoint { triangle: t, point });
                }
            }
        }
        Err(ShellEvaluationError::Outside)
    }

    /// The point of the middle surface on the pillar line of a point, rounded from the exact one.
    ///
    /// # Errors
    /// As for [`project_exact`](Self::project_exact).
    pub fn to_middle(&self, point: Point) -> Result<Enclosed, ShellEvaluationError> {
        let at = self.to_middle_exact(&rational(point)?)?;
        Ok(rounded(&self.unproject_exact(&at)?))
    }

    /// The point of the source surface on the pillar line of a point, rounded from the exact one.
    ///
    /// # Errors
    /// As for [`project_exact`](Self::project_exact) and [`to_source_exact`](Self::to_source_exact).
    pub fn to_source(&self, point: Point) -> Result<Enclosed, ShellEvaluationError> {
        let at = self.project_exact(&rational(point)?)?;
        Ok(rounded(&self.to_source_exact(&at)?.point))
    }

    /// The corners of the pillar line through a point, from bottom to top; one point where it has no length.
    fn fibre(&self, at: &ShellPoint<Rational>) -> Result<Vec<ExactPoint>, ShellEvaluationError> {
        self.check_point(at)?;
        let lifted = self.lifted(at);
        if lifted.is_zero() {
            return Ok(vec![self.unproject_exact(&ShellPoint { height: Rational::ZERO, ..at.clone() })?]);
        }
        // The line turns where a column has risen.
        let mut heights = vec![Rational::ZERO];
        for k in self.rising(at.prism) {
            let next = heights.last().map_or(Rational::ZERO, |last| last + &(&at.weights[k] / &lifted));
            heights.push(next);
        }
        let lower = heights.iter().map(|h| h - &Rational::ONE);
        let heights: Vec<Rational> = lower.chain(heights.iter().skip(1).cloned()).collect();
        let point = |height| self.unproject_exact(&ShellPoint { prism: at.prism, weights: at.weights.clone(), height });
        heights.into_iter().map(point).collect()
    }

    /// Whether there is such a prism, the weights are possible, and the height is in range.
    fn check_point(&self, at: &ShellPoint<Rational>) -> Result<(), ShellEvaluationError> {
        let fits = (at.prism as usize) < self.parts.prisms.len()
            && at.weights.iter().all(|w| *w >= Rational::ZERO)
            && at.weights.iter().cloned().sum::<Rational>() == Rational::ONE
            && (-Rational::ONE..=Rational::ONE).contains(&at.height);
        if fits { Ok(()) } else { Err(ShellEvaluationError::NoSuchPoint) }
    }

    /// The positions, in a prism, of its columns in ascending order of their numbers.
    fn order(&self, prism: u32) -> [usize; 3] {
        let columns = self.parts.prisms[prism as usize];
        let mut order = [0, 1, 2];
        order.sort_unstable_by_key(|&k| columns[k]);
        order
    }

    /// The positions of the columns that have a length, by descending numbers.
    fn rising(&self, prism: u32) -> impl Iterator<Item = usize> + '_ {
        let columns = self.parts.prisms[prism as usize];
        let order = self.order(prism);
        order.into_iter().rev().filter(move |&k| !self.is_pinched(columns[k]))
    }

    fn is_pinched(&self, column: u32) -> bool {
        self.parts.is_pinched(column)
    }

    /// The weight of the columns that have a length: 1 where none is pinched.
    fn lifted(&self, at: &ShellPoint<Rational>) -> Rational {
        self.rising(at.prism).map(|k| at.weights[k].clone()).sum()
    }

    /// The tetrahedra of the slabs of a prism; see `docs/theory/shells.md`.
    fn tetrahedra(&self, prism: u32) -> [[Corner; 4]; 3] {
        let [i, j, k] = self.order(prism);
        [
            [(i, false), (j, false), (k, false), (k, true)],
            [(i, false), (j, false), (j, true), (k, true)],
            [(i, false), (i, true), (j, true), (k, true)],
        ]
    }

    /// The slabs whose boxes meet a box: `2 * prism` is a lower one, `2 * prism + 1` an upper one.
    pub(crate) fn slabs_near(&self, region: &Aabb) -> Vec<usize> {
        let mut slabs = Vec::new();
        self.slabs.query_box(region, |slab| slabs.push(slab));
        slabs.sort_unstable();
        slabs
    }

    /// The tetrahedra of a slab: for each corner the position of its column in the prism, and the corners.
    pub(crate) fn slab_cells(&self, slab: usize) -> [([usize; 4], [Point; 4]); 3] {
        let columns = self.parts.prisms[slab / 2].map(|v| level_pair(&self.parts, v as usize, slab % 2));
        self.tetrahedra((slab / 2) as u32).map(|cell| {
            (cell.map(|(column, _)| column), cell.map(|(column, is_high)| columns[column][usize::from(is_high)]))
        })
    }

    fn project_in_slab(&self, slab: usize, point: &ExactPoint) -> Option<ShellPoint<Rational>> {
        let prism = (slab / 2) as u32;
        let columns = self.parts.prisms[slab / 2].map(|v| level_pair(&self.parts, v as usize, slab % 2));
        self.tetrahedra(prism).into_iter().find_map(|cell| {
            let corners = cell.map(|(column, is_high)| columns[column][usize::from(is_high)].map(exact));
            let inside = weights_in(&corners, point)?;
            let mut at = ShellPoint { prism, weights: [0, 1, 2].map(|_| Rational::ZERO), height: Rational::ZERO };
            for ((column, is_high), weight) in cell.into_iter().zip(&inside) {
                at.weights[column] = &at.weights[column] + weight;
                if is_high && !self.is_pinched(self.parts.prisms[slab / 2][column]) {
                    at.height = &at.height + weight;
                }
            }
            let lifted = self.lifted(&at);
            if lifted.is_zero() {
                at.height = Rational::ZERO; // a pinched point
            } else {
                at.height = &(&at.height / &lifted) - &if slab % 2 == 1 { Rational::ZERO } else { Rational::ONE };
            }
            Some(at)
        })
    }

    /// Whether two locations are the same point of the shell, seen from neighbouring prisms.
    fn is_same(&self, a: &ShellPoint<Rational>, b: &ShellPoint<Rational>) -> bool {
        let terms = |at: &ShellPoint<Rational>| {
            let columns = self.parts.prisms[at.prism as usize];
            let mut terms: Vec<(u32, Rational)> =
                columns.into_iter().zip(at.weights.iter().cloned()).filter(|(_, w)| !w.is_zero()).collect();
            terms.sort_unstable_by_key(|(column, _)| *column);
            terms
        };
        a.height == b.height && terms(a) == terms(b)
    }

    /// Whether a point lies in the shell, exactly: in one prism or in several.
    pub fn is_inside(&self, point: Point) -> bool {
        let mut is_inside = false;
        self.slabs.query_point(point, |slab| is_inside = is_inside || self.slab_contains(slab, point));
        is_inside
    }

    fn slab_contains(&self, slab: usize, point: Point) -> bool {
        let columns = self.parts.prisms[slab / 2].map(|v| level_pair(&self.parts, v as usize, slab % 2));
        self.tetrahedra((slab / 2) as u32).into_iter().any(|cell| {
            let corners = cell.map(|(column, is_high)| columns[column][usize::from(is_high)]);
            let whole = orient3d(corners[0], corners[1], corners[2], corners[3]);
            whole != Sign::Zero
                && (0..4).all(|i| {
                    let mut moved = corners;
                    moved[i] = point;
                    let sign = orient3d(moved[0], moved[1], moved[2], moved[3]);
                    sign == whole || sign == Sign::Zero
                })
        })
    }
}

/// Low and high point of a column in the lower (0) or upper (1) slab.
fn level_pair(parts: &ShellParts, column: usize, slab: usize) -> [Point; 2] {
    let levels = [parts.bottom[column], parts.middle[column], parts.top[column]];
    [levels[slab], levels[slab + 1]]
}

fn rational(point: Point) -> Result<ExactPoint, ShellEvaluationError> {
    if point.iter().all(|x| x.is_finite()) { Ok(point.map(exact)) } else { Err(ShellEvaluationError::NotFinite) }
}

/// The nearest doubles, with the bound that rounding to nearest has.
fn rounded(point: &ExactPoint) -> Enclosed {
    let point = point.each_ref().map(Rational::to_f64);
    let size = point.iter().fold(0.0f64, |size, x| size.max(x.abs()));
    Enclosed { point, radius: f64::EPSILON * size }
}

/// A finite number, exactly.
fn exact(value: f64) -> Rational {
    Rational::from_f64(value).unwrap_or(Rational::ZERO)
}

fn difference(a: &ExactPoint, b: &ExactPoint) -> ExactPoint {
    [0, 1, 2].map(|axis| &a[axis] - &b[axis])
}

fn determinant(u: &ExactPoint, v: &ExactPoint, w: &ExactPoint) -> Rational {
    let minor = |y: usize, z: usize| &(&v[y] * &w[z]) - &(&v[z] * &w[y]);
    [(0, 1, 2), (1, 2, 0), (2, 0, 1)].into_iter().map(|(x, y, z)| &u[x] * &minor(y, z)).sum()
}

/// Barycentric weights of a point of a tetrahedron; `None` outside, and for flat tetrahedra.
fn weights_in(corners: &[ExactPoint; 4], point: &ExactPoint) -> Option<[Rational; 4]> {
    let [u, v, w] = [1, 2, 3].map(|k| difference(&corners[k], &corners[0]));
    let p = difference(point, &corners[0]);
    let whole = determinant(&u, &v, &w);
    if whole.is_zero() {
        return None;
    }
    let parts = [determinant(&p, &v, &w), determinant(&u, &p, &w), determinant(&u, &v, &p)].map(|part| &part / &whole);
    let rest = &Rational::ONE - &parts.iter().cloned().sum::<Rational>();
    let [b, c, d] = parts;
    let weights = [rest, b, c, d];
    weights.iter().all(|weight| *weight >= Rational::ZERO).then_some(weights)
}

/// Where a segment, not parallel to it, meets a triangle.
fn crossing(from: &ExactPoint, to: &ExactPoint, corners: &[ExactPoint; 3]) -> Option<ExactPoint> {
    let (u, v) = (difference(&corners[1], &corners[0]), difference(&corners[2], &corners[0]));
    let (step, base) = (difference(to, from), difference(from, &corners[0]));
    let speed = determinant(&u, &v, &step);
    if speed.is_zero() {
        return None;
    }
    // from + t step = corners[0] + x u + y v
    let t = &-determinant(&u, &v, &base) / &speed;
    if t < Rational::ZERO || t > Rational::ONE {
        return None;
    }
    let point: ExactPoint = std::array::from_fn(|axis| &from[axis] + &(&t * &step[axis]));
    let p = difference(&point, &corners[0]);
    let (x, y) = (&determinant(&p, &v, &step) / &determinant(&u, &v, &step), &determinant(&u, &p, &step) / &speed);
    let is_inside = x >= Rational::ZERO && y >= Rational::ZERO && &x + &y <= Rational::ONE;
    is_inside.then_some(point)
}
