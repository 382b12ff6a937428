//! Floating-point evaluation: fast leaves, and exact ones where rounding cannot decide.

use homeo_core::mesh::{CellId, Facet};
use homeo_core::number::Rational;
use homeo_core::predicate::Sign;

use super::evaluate::{diamond_coordinates, tetrahedral_coordinates};
use super::exact::{Sense, whole};
use super::fast::{FastLeaf, Undecided};
use super::locate::{FloatLocation, Located, rational_point};
use super::target::BALL_CORNERS;
use super::{Enclosed, EvaluationError, Foliation, Section, Target};

/// A few roundings of numbers of magnitude 1.
const ULPS: f64 = 16.0 * f64::EPSILON;

/// A number and a bound of its error.
#[derive(Clone, Copy, Debug)]
struct Bounded {
    value: f64,
    error: f64,
}

/// Where a leaf that starts in the source region is to be followed to.
#[derive(Clone, Copy, Debug)]
enum Goal {
    /// This fraction of the leaf.
    Fraction(f64),
    /// This distance from the centroid, as a fraction of the whole leaf with its part in the centre.
    FromCentre(f64),
}

impl<const K: usize> Foliation<K> {
    pub(super) fn forward_float(&self, point: [f64; 3]) -> Result<Enclosed, EvaluationError> {
        let located = self.locator.float(self.source(), &self.parts().mesh, point)?;
        let fast = self.fast_start(&located).and_then(|at| self.fast_image(at).ok());
        self.forward_from(&located, fast, point)
    }

    /// Where a fast leaf through a point begins, if one may be tried.
    pub(super) fn fast_start<'l>(&self, located: &'l Located<K>) -> Option<&'l FloatLocation<K>> {
        match located {
            Located::Float(at) if !self.is_centre(at.cell) => Some(at),
            _ => None,
        }
    }

    /// The answer of a fast leaf if it is good enough, or else of an exact one.
    pub(super) fn forward_from(
        &self,
        located: &Located<K>,
        fast: Option<Enclosed>,
        point: [f64; 3],
    ) -> Result<Enclosed, EvaluationError> {
        if let Some(enclosed) = fast.filter(|enclosed| enclosed.radius <= self.accuracy()) {
            return Ok(enclosed);
        }
        let at = self.locator.exactly(self.source(), &self.parts().mesh, located, point)?;
        Ok(self.rounded_image(&self.image_exact(&at)))
    }

    pub(super) fn fast_image(&self, at: &FloatLocation<K>) -> Result<Enclosed, Undecided> {
        let (mut back, mut ahead) = (FastLeaf::new(self, at), FastLeaf::new(self, at));
        let [start, _] = FastLeaf::follow_both(self, &mut back, &mut ahead)?;
        self.image_of_ends(start, &back, &ahead)
    }

    /// The image of the point from which two leaves were followed to their ends.
    pub(super) fn image_of_ends(
        &self,
        start: Facet,
        back: &FastLeaf<K>,
        ahead: &FastLeaf<K>,
    ) -> Result<Enclosed, Undecided> {
        let radius = f64::from(self.parts().centre.map_or(0, |c| c.length));
        let part = match self.parts().target {
            Target::Square | Target::Cube => Bounded { value: back.length, error: back.length_error },
            Target::Disk => Bounded { value: ahead.length + radius, error: ahead.length_error },
            Target::Ball => Bounded { value: back.length + radius, error: back.length_error },
        };
        let whole = back.length + ahead.length + radius;
        let whole_error = back.length_error + ahead.length_error + ULPS * whole;
        let safe = whole - whole_error;
        if safe <= 0.0 {
            return Err(Undecided);
        }
        let fraction =
            Bounded { value: (part.value / whole).clamp(0.0, 1.0), error: (part.error + whole_error) / safe + ULPS };
        Ok(self.assembled(self.section_float(start, back), fraction))
    }

    /// The section value at the source end of a leaf.
    fn section_float(&self, start: Facet, leaf: &FastLeaf<K>) -> ([f64; 3], f64) {
        let others = || (0..K).filter(|&k| k != start.opposite());
        let sum: f64 = others().map(|k| leaf.weights[k].max(0.0)).sum();
        let share = |k: usize| leaf.weights[k].max(0.0) / sum;
        let mut value = [0.0; 3];
        let mut error = 0.0;
        if let Section::Centre = self.parts().section {
            let step = self.steps.of(start.cell());
            for k in others() {
                let corner = BALL_CORNERS[step.renumbered(start.opposite(), k)];
                (0..3).for_each(|axis| value[axis] += share(k) * f64::from(corner[axis]) / 2.0);
                error += leaf.error(k);
            }
            return (value, error + ULPS);
        }
        let corners: Vec<_> = self.parts().mesh.complex().facet_vertices(start.cell(), start.opposite()).collect();
        let values = self.section_index.values(&self.parts().section, &corners);
        let mut size = 0.0f64;
        for (k, v) in others().zip(&values) {
            (0..2).for_each(|axis| value[axis] += share(k) * v[axis]);
            let from_first = (v[0] - values[0][0]).abs().max((v[1] - values[0][1]).abs());
            error += leaf.error(k) * from_first;
            size = size.max(v[0].abs()).max(v[1].abs());
        }
        (value, error + ULPS * size)
    }

    /// The image from the section value and the fraction of the leaf.
    fn assembled(&self, (section, error): ([f64; 3], f64), fraction: Bounded) -> Enclosed {
        let t = fraction.value;
        match self.parts().target {
            Target::Square => {
                Enclosed { point: [section[0].clamp(0.0, 1.0), t, 0.0], radius: error.max(fraction.error) }
            }
            Target::Cube => Enclosed {
                point: [section[0].clamp(0.0, 1.0), section[1].clamp(0.0, 1.0), t],
                radius: error.max(fraction.error),
            },
            Target::Disk => {
                let (sin, cos) = (section[0] * std::f64::consts::FRAC_PI_2).sin_cos();
                let radius = fraction.error + t * std::f64::consts::FRAC_PI_2 * error + ULPS;
                Enclosed { point: within_ball([t * cos, t * sin, 0.0]), radius }
            }
            Target::Ball => {
                let size = norm(section);
                // The tetrahedron's boundary is at least 0.288 from its centre.
                let radius = fraction.error + t * 8.0 * error + ULPS;
                Enclosed { point: within_ball(section.map(|x| t * x / size)), radius }
            }
        }
    }

    /// The rounded (and, for disk and ball, round) form of an exact image.
    pub(super) fn rounded_image(&self, image: &[Rational; 3]) -> Enclosed {
        let near = [0, 1, 2].map(|axis| image[axis].to_f64());
        match self.parts().target {
            Target::Square | Target::Cube => Enclosed { point: near, radius: f64::EPSILON },
            Target::Disk => {
                let (theta, r) = diamond_coordinates(&image[0], &image[1]);
                let exactly = Bounded { value: r.to_f64(), error: f64::EPSILON };
                self.assembled(([theta.to_f64(), 0.0, 0.0], 4.0 * f64::EPSILON), exactly)
            }
            Target::Ball => {
                let (_, r) = tetrahedral_coordinates(image);
                if r.is_zero() {
                    return Enclosed { point: [0.0; 3], radius: 0.0 };
                }
                let section = [0, 1, 2].map(|axis| (&image[axis] / &r).to_f64());
                self.assembled((section, f64::EPSILON), Bounded { value: r.to_f64(), error: f64::EPSILON })
            }
        }
    }

    pub(super) fn inverse_float(&self, point: [f64; 3]) -> Result<Enclosed, EvaluationError> {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(EvaluationError::NotFinite);
        }
        let (exact, fast) = match self.parts().target {
            Target::Square | Target::Cube => (rational_point(point), self.fast_start_in_box(point)?),
            Target::Disk => self.fast_start_in_disk(point)?,
            Target::Ball => self.fast_start_in_ball(point)?,
        };
        if let Some((at, goal)) = fast {
            match self.fast_preimage(&at, goal) {
                Ok(enclosed) if enclosed.radius <= self.accuracy() * self.locator.diagonal() => return Ok(enclosed),
                _ => {}
            }
        }
        let position = self.position_exact(&self.preimage_exact(&exact)?);
        let point = position.map(|x| x.to_f64());
        let size = point.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        Ok(Enclosed { point, radius: size * f64::EPSILON })
    }

    fn fast_start_in_box(&self, q: [f64; 3]) -> Result<Option<(FloatLocation<K>, Goal)>, EvaluationError> {
        let is_square = self.parts().target == Target::Square;
        let outside = EvaluationError::OutsideTarget(self.parts().target);
        if q.iter().any(|x| !(0.0..=1.0).contains(x)) || (is_square && q[2] != 0.0) {
            return Err(outside);
        }
        let (at, t) =
            if is_square { (self.fast_on_edge(q[0]), q[1]) } else { (self.fast_on_triangle([q[0], q[1]]), q[2]) };
        Ok(at.map(|at| (at, Goal::Fraction(t))))
    }

    fn fast_on_edge(&self, s: f64) -> Option<FloatLocation<K>> {
        let (facet, [a, b]) = self.section_index.edge_at(self.parts(), |p| p <= s)?;
        let along = ((s - a) / (b - a)).clamp(0.0, 1.0);
        let on_vertex = [s == b, s == a];
        let shares = [(1.0 - along, on_vertex[0]), (along, on_vertex[1])];
        Some(self.fast_on_facet(facet, shares.into_iter().map(|(w, zero)| if zero { (0.0, 0.0) } else { (w, ULPS) })))
    }

    fn fast_on_triangle(&self, q: [f64; 2]) -> Option<FloatLocation<K>> {
        let (facet, signs) = self.section_index.triangle_at(self.parts(), q)?;
        let [a, b, c] = self.section_index.facet_values(self.parts(), facet);
        let area = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
            let (first, second) = ((b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0]));
            (first - second, ULPS * (first.abs() + second.abs()))
        };
        let (whole, whole_error) = area(a, b, c);
        let safe = whole.abs() - whole_error;
        if safe <= 0.0 {
            return None;
        }
        let parts = [area(q, b, c), area(a, q, c), area(a, b, q)];
        let shares = parts.into_iter().zip(signs).map(|((part, error), sign)| {
            if sign == Sign::Zero {
                (0.0, 0.0)
            } else {
                ((part / whole).clamp(0.0, 1.0), (error + whole_error) / safe + ULPS)
            }
        });
        Some(self.fast_on_facet(facet, shares))
    }

    fn fast_on_facet(&self, facet: Facet, shares: impl Iterator<Item = (f64, f64)>) -> FloatLocation<K> {
        let (mut weights, mut errors) = ([0.0; K], [0.0; K]);
        for (k, (weight, error)) in (0..K).filter(|&k| k != facet.opposite()).zip(shares) {
            (weights[k], errors[k]) = (weight, error);
        }
        FloatLocation { cell: facet.cell(), weights, errors, is_exact: false }
    }

    /// The polyhedral point that a point of the round disk is taken for, and where its leaf begins.
    #[allow(clippy::type_complexity)]
    fn fast_start_in_disk(
        &self,
        q: [f64; 3],
    ) -> Result<([Rational; 3], Option<(FloatLocation<K>, Goal)>), EvaluationError> {
        let r = q[0].hypot(q[1]);
        if r > 1.0 + 4.0 * f64::EPSILON || q[2] != 0.0 {
            return Err(EvaluationError::OutsideTarget(Target::Disk));
        }
        let r = r.min(1.0);
        let quarter_turns = q[1].atan2(q[0]) / std::f64::consts::FRAC_PI_2;
        let theta = if quarter_turns < 0.0 { (quarter_turns + 4.0).min(4.0f64.next_down()) } else { quarter_turns };
        let (exact_theta, exact_r) = (super::evaluate::exact(theta), super::evaluate::exact(r));
        let [x, y] = super::evaluate::diamond_point(&exact_theta);
        let exact = [&x * &exact_r, &y * &exact_r, Rational::ZERO];
        Ok((exact, self.fast_on_edge(theta).map(|at| (at, Goal::FromCentre(r)))))
    }

    /// The polyhedral point that a point of the round ball is taken for, and where its leaf begins.
    #[allow(clippy::type_complexity)]
    fn fast_start_in_ball(
        &self,
        q: [f64; 3],
    ) -> Result<([Rational; 3], Option<(FloatLocation<K>, Goal)>), EvaluationError> {
        let size = norm(q);
        if size > 1.0 + 4.0 * f64::EPSILON {
            return Err(EvaluationError::OutsideTarget(Target::Ball));
        }
        let Some(centre) = self.parts().centre.filter(|_| size > 0.0) else {
            return Ok(([Rational::ZERO, Rational::ZERO, Rational::ZERO], None));
        };
        let along = |corner: [i32; 3]| (0..3).map(|axis| q[axis] * f64::from(corner[axis])).sum::<f64>() / size;
        let heights: [f64; K] = std::array::from_fn(|i| along(BALL_CORNERS[i]));
        let least = (0..K).min_by(|&a, &b| heights[a].total_cmp(&heights[b])).unwrap_or(0);
        // Proportional to the barycentric coordinates of the point of the boundary in this direction.
        let weights: [f64; K] = std::array::from_fn(|i| if i == least { 0.0 } else { heights[i] - heights[least] });
        let sum: f64 = weights.iter().sum();
        let r = size.min(1.0);
        let exact_weights = whole(&weights.map(|w| super::evaluate::exact(w.max(0.0))));
        let boundary = self.tetrahedron_point(&exact_weights);
        let exact_r = super::evaluate::exact(r);
        let exact = boundary.map(|x| &x * &exact_r);
        let far = self.adjacency().across(centre.cell, least);
        let step = self.steps.of(centre.cell);
        let (mut outside, mut errors) = ([0.0; K], [0.0; K]);
        for k in (0..K).filter(|&k| k != least) {
            outside[step.renumbered(least, k)] = weights[k] / sum;
            errors[step.renumbered(least, k)] = if weights[k] == 0.0 { 0.0 } else { ULPS };
        }
        let at = FloatLocation { cell: far.cell(), weights: outside, errors, is_exact: false };
        Ok((exact, Some((at, Goal::FromCentre(r)))))
    }

    fn fast_preimage(&self, at: &FloatLocation<K>, goal: Goal) -> Result<Enclosed, Undecided> {
        let mut ahead = FastLeaf::new(self, at);
        ahead.follow(self, Sense::Forward)?;
        let radius = f64::from(self.parts().centre.map_or(0, |c| c.length));
        let (length, error) = (ahead.length, ahead.length_error);
        let wanted = match goal {
            Goal::Fraction(t) => t * length,
            Goal::FromCentre(r) => {
                let part = r * (length + radius) - radius;
                if part <= error + ULPS * (length + radius) {
                    // In the centre, or too near to tell.
                    return Err(Undecided);
                }
                if self.parts().target == Target::Ball { part } else { length - part }
            }
        };
        let wanted = wanted.clamp(0.0, length);
        let mut leaf = FastLeaf::new(self, at);
        let errors = leaf.follow_for(self, wanted, error + ULPS * (length + radius))?;
        Ok(self.position_float(leaf.cell(self), &leaf.weights, &errors))
    }

    fn position_float(&self, cell: CellId, weights: &[f64; K], errors: &[f64; K]) -> Enclosed {
        let corners = self.parts().mesh.complex().cell(cell).map(|v| self.parts().mesh.positions()[v.index()]);
        let sum: f64 = weights.iter().sum();
        let mut point = [0.0; 3];
        let (mut radius, mut size) = (0.0f64, 0.0f64);
        for axis in 0..3 {
            point[axis] = (0..K).map(|k| weights[k] / sum * corners[k][axis]).sum();
            let spread: f64 = (0..K).map(|k| errors[k] * (corners[k][axis] - corners[0][axis]).abs()).sum();
            radius = radius.max(spread);
            size = corners.iter().fold(size, |m, c| m.max(c[axis].abs()));
        }
        Enclosed { point, radius: 1.0001 * radius + ULPS * size }
    }
}

fn norm(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

/// Draws a point that rounding put outside the unit ball back into it.
fn within_ball(point: [f64; 3]) -> [f64; 3] {
    let size = norm(point);
    if size > 1.0 { point.map(|x| x / size * (1.0 - f64::EPSILON)) } else { point }
}
