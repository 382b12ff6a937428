//! Location in the slabs of a shell and along pillar lines, for exact and for enclosing numbers.
//!
//! Each step is stated once; with [`Interval`](homeo_core::number::Interval) it stops with `Undecided` where rounding
//! leaves a sign open, and the caller asks again with rationals. So fast and exact images never differ in a branch.

use homeo_core::number::{Interval, Scalar};
use homeo_core::predicate::Sign;
use homeo_core::spatial::Aabb;

use super::space::{Undecided, combination, crossing, point_of, possible_crossing, sum, weights_in, zero};
use super::surface::hull;
use super::{Shell, ShellEvaluationError, ShellPoint, ShellSurface, SurfacePoint};

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Stop {
    /// Rounding leaves it open.
    Undecided,
    /// There is none.
    None(ShellEvaluationError),
}

impl From<Undecided> for Stop {
    fn from(Undecided: Undecided) -> Self {
        Self::Undecided
    }
}

impl From<ShellEvaluationError> for Stop {
    fn from(error: ShellEvaluationError) -> Self {
        Self::None(error)
    }
}

/// A corner of a tetrahedron of a slab: which column of the prism (0 to 2), and whether its high point.
type Corner = (usize, bool);

/// The points of a pillar line where it turns, from bottom to top; one point where it has no length.
pub(super) type Fibre<T> = Vec<[T; 3]>;

impl Shell {
    /// The prism, weights and height of a point that lies in the box.
    pub(super) fn locate<T: Scalar>(&self, point: &[T; 3], region: &Aabb) -> Result<ShellPoint<T>, Stop> {
        self.locate_among(self.slabs_near(region), point)
    }

    /// The same among some slabs.
    pub(super) fn locate_among<T: Scalar>(
        &self,
        slabs: impl IntoIterator<Item = usize>,
        point: &[T; 3],
    ) -> Result<ShellPoint<T>, Stop> {
        let mut found: Option<ShellPoint<T>> = None;
        for slab in slabs {
            let Some(here) = self.locate_in_slab(slab, point)? else { continue };
            match &found {
                None => found = Some(here),
                Some(first) if self.is_same(first, &here)? => {}
                Some(first) => return Err(ShellEvaluationError::Ambiguous(first.prism, here.prism).into()),
            }
        }
        found.ok_or(ShellEvaluationError::Outside.into())
    }

    fn locate_in_slab<T: Scalar>(&self, slab: usize, point: &[T; 3]) -> Result<Option<ShellPoint<T>>, Stop> {
        let prism = (slab / 2) as u32;
        let columns = self.parts.prisms[slab / 2];
        for cell in self.tetrahedra(prism) {
            let corners = cell.map(|(k, is_high)| point_of(self.level(columns[k], slab % 2 + usize::from(is_high))));
            let Some(inside) = weights_in(&corners, point)? else { continue };
            let weight = |k: usize, counts: &dyn Fn(bool) -> bool| {
                let parts = cell.iter().zip(&inside).filter(|((column, is_high), _)| *column == k && counts(*is_high));
                sum(parts.map(|(_, weight)| weight))
            };
            let weights: [T; 3] = std::array::from_fn(|k| weight(k, &|_| true));
            let free: Vec<usize> = (0..3).filter(|&k| !self.is_pinched(columns[k])).collect();
            let high: Vec<T> = free.iter().map(|&k| weight(k, &|is_high| is_high)).collect();
            let height = match self.lifted(prism, &weights) {
                None => sum(&high),
                // A point of a pinched column has no height.
                Some(lifted) if lifted.sign().ok_or(Undecided)? == Sign::Zero => {
                    return Ok(Some(ShellPoint { prism, weights, height: zero() }));
                }
                Some(lifted) => sum(&high).divide(&lifted),
            };
            let height = if slab % 2 == 1 { height } else { height.minus(&T::from_f64(1.0)) };
            return Ok(Some(ShellPoint { prism, weights, height }));
        }
        Ok(None)
    }

    /// Whether two locations are the same point of the shell, seen from neighbouring prisms.
    fn is_same<T: Scalar>(&self, a: &ShellPoint<T>, b: &ShellPoint<T>) -> Result<bool, Undecided> {
        let is_equal = |x: &T, y: &T| x.minus(y).sign().ok_or(Undecided).map(|sign| sign == Sign::Zero);
        let weight_at = |at: &ShellPoint<T>, column: u32| {
            let k = self.parts.prisms[at.prism as usize].iter().position(|&other| other == column);
            k.map_or_else(zero, |k| at.weights[k].clone())
        };
        let [p, q] = [a, b].map(|at| self.parts.prisms[at.prism as usize]);
        for column in p.into_iter().chain(q) {
            if !is_equal(&weight_at(a, column), &weight_at(b, column))? {
                return Ok(false);
            }
        }
        is_equal(&a.height, &b.height)
    }

    /// The point of space with the given prism, weights and height.
    pub(super) fn point_at<T: Scalar>(&self, at: &ShellPoint<T>) -> Result<[T; 3], Undecided> {
        let one = T::from_f64(1.0);
        let is_upper = at.height.sign().ok_or(Undecided)? != Sign::Negative;
        let height = if is_upper { at.height.clone() } else { at.height.plus(&one) };
        let lifted = self.lifted(at.prism, &at.weights).unwrap_or(one);
        // How much of each column's weight is at its high point: the columns with the largest numbers rise first.
        let mut high: [T; 3] = std::array::from_fn(|_| zero());
        let mut left = height.times(&lifted);
        for k in self.rising(at.prism) {
            let is_less = left.minus(&at.weights[k]).sign().ok_or(Undecided)? == Sign::Negative;
            high[k] = if is_less { left.clone() } else { at.weights[k].clone() };
            left = left.minus(&high[k]);
        }
        let columns = self.parts.prisms[at.prism as usize];
        let low_level = usize::from(is_upper);
        let weights: [T; 6] =
            std::array::from_fn(|i| if i < 3 { at.weights[i].minus(&high[i]) } else { high[i - 3].clone() });
        let corners: [[T; 3]; 6] = std::array::from_fn(|i| point_of(self.level(columns[i % 3], low_level + i / 3)));
        Ok(combination(&weights, &corners))
    }

    /// The point of the middle surface with the given weights.
    pub(super) fn middle_at<T: Scalar>(&self, at: &ShellPoint<T>) -> [T; 3] {
        let columns = self.parts.prisms[at.prism as usize];
        combination(&at.weights, &columns.map(|v| point_of(self.level(v, 1))))
    }

    /// The pillar line through a point: one column after the other rises, in each slab.
    pub(super) fn fibre<T: Scalar>(&self, at: &ShellPoint<T>) -> Result<Fibre<T>, Undecided> {
        let columns = self.parts.prisms[at.prism as usize];
        let mut levels = [0; 3];
        let corner = |levels: [usize; 3]| {
            let corners: [[T; 3]; 3] = std::array::from_fn(|k| point_of(self.level(columns[k], levels[k])));
            combination(&at.weights, &corners)
        };
        let mut line = vec![corner(levels)];
        let has_length = match self.lifted(at.prism, &at.weights) {
            None => true,
            Some(lifted) => lifted.sign().ok_or(Undecided)? != Sign::Zero,
        };
        if has_length {
            for k in self.rising(at.prism).chain(self.rising(at.prism)) {
                levels[k] += 1;
                line.push(corner(levels));
            }
        }
        Ok(line)
    }

    /// The triangles of a section that a pillar line of a prism may meet, ascending.
    fn candidates<T: Scalar>(&self, surface: &ShellSurface, prism: u32, line: &Fibre<T>) -> Vec<u32> {
        let mut candidates = surface.near(line);
        // Pairs are about the source; another section is asked for as a whole.
        let is_source = std::ptr::eq(surface, &self.source);
        candidates.retain(|&triangle| !is_source || self.parts.are_paired(triangle, prism));
        candidates
    }

    /// The point of a section on a pillar line of a prism.
    pub(super) fn meet<T: Scalar>(
        &self,
        surface: &ShellSurface,
        prism: u32,
        line: &Fibre<T>,
    ) -> Result<SurfacePoint<T>, Stop> {
        let candidates = self.candidates(surface, prism, line);
        if let [pinched] = line.as_slice() {
            return surface
                .at_vertex(&candidates, pinched.each_ref().map(T::near), pinched)
                .ok_or(ShellEvaluationError::Outside.into());
        }
        let boxes: Vec<Aabb> = line.windows(2).map(hull).collect();
        let mut is_open = false;
        for triangle in candidates {
            let place = Aabb::of(&surface.corners(triangle));
            let corners = surface.corners(triangle).map(point_of);
            for (ends, _) in line.windows(2).zip(&boxes).filter(|(_, region)| region.meets(&place)) {
                match crossing([&ends[0], &ends[1]], &corners) {
                    Ok(None) => {}
                    Ok(Some(weights)) => {
                        let point = combination(&weights, &corners);
                        return Ok(SurfacePoint { triangle, weights, point });
                    }
                    // The certificate says that the line meets the surface once: another triangle may be certain.
                    Err(Undecided) => is_open = true,
                }
            }
        }
        Err(if is_open { Stop::Undecided } else { ShellEvaluationError::Outside.into() })
    }

    /// An enclosure of the point of a section on a pillar line, also where it is open which of several triangles has it: the
    /// certificate says that the line meets the section once. `None` where nothing good is known.
    pub(super) fn enclose(&self, surface: &ShellSurface, prism: u32, line: &Fibre<Interval>) -> Option<[Interval; 3]> {
        let boxes: Vec<Aabb> = line.windows(2).map(hull).collect();
        let mut met: Option<[Interval; 3]> = None;
        for triangle in self.candidates(surface, prism, line) {
            let place = Aabb::of(&surface.corners(triangle));
            let corners = surface.corners(triangle).map(point_of);
            for (ends, _) in line.windows(2).zip(&boxes).filter(|(_, region)| region.meets(&place)) {
                if let Some(weights) = possible_crossing([&ends[0], &ends[1]], &corners).ok()? {
                    let point = combination(&weights, &corners);
                    met = Some(match met {
                        None => point,
                        Some(known) => std::array::from_fn(|axis| known[axis].hull_with(&point[axis])),
                    });
                }
            }
        }
        met
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

    /// The weight of the columns that have a length; `None` for 1, where none is pinched.
    fn lifted<T: Scalar>(&self, prism: u32, weights: &[T; 3]) -> Option<T> {
        let columns = self.parts.prisms[prism as usize];
        let is_free = |k: &usize| !self.is_pinched(columns[*k]);
        let free: Vec<&T> = (0..3).filter(is_free).map(|k| &weights[k]).collect();
        (free.len() < 3).then(|| sum(free))
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

    /// The tetrahedra of a slab: for each corner the position of its column in the prism, and the corners.
    pub(crate) fn slab_cells(&self, slab: usize) -> [([usize; 4], [[f64; 3]; 4]); 3] {
        let columns = self.parts.prisms[slab / 2];
        let point = |(k, is_high): Corner| self.level(columns[k], slab % 2 + usize::from(is_high));
        self.tetrahedra((slab / 2) as u32).map(|cell| (cell.map(|(column, _)| column), cell.map(point)))
    }
}
