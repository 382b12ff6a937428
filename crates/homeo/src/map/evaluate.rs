//! Forward and inverse evaluation of a foliation map.

use dashu_int::IBig;
use homeo_core::mesh::{CellId, Facet, VertexId};
use homeo_core::number::Rational;
use homeo_core::predicate::Sign;

use super::exact::{ExactLeaf, ExactLocation, Sense, fractions, ratio, reduced, whole};
use super::target::BALL_CORNERS;
use super::{Bijection, Enclosed, EvaluationError, Foliation, Section, Target};

/// Where a leaf begins and how long it is, for a point at a known place on it.
struct LeafCoordinates {
    /// Image of the leaf in the section: square coordinates, a loop parameter, or a point of the
    /// tetrahedron's boundary.
    section: [Rational; 3],
    /// Square and cube: length before the point. Disk and ball: length to the centroid of the centre.
    part: Rational,
    /// Length of the whole leaf, the part inside the centre included.
    whole: Rational,
}

impl<const K: usize> Foliation<K> {
    fn radius(&self) -> Rational {
        Rational::from(self.parts().centre.map_or(0, |c| i64::from(c.length)))
    }

    fn vertices_of(&self, facet: Facet) -> Vec<VertexId> {
        self.parts().mesh.complex().facet_vertices(facet.cell(), facet.opposite()).collect()
    }

    /// Weights of the vertices of a facet, for a point on it.
    fn facet_weights<'w>(&self, facet: Facet, weights: &'w [IBig; K]) -> Vec<&'w IBig> {
        (0..K).filter(|&k| k != facet.opposite()).map(|k| &weights[k]).collect()
    }

    /// The section value at a point of a source facet.
    fn section_exact(&self, facet: Facet, weights: &[IBig; K]) -> [Rational; 3] {
        if let Section::Centre = self.parts().section {
            return self.tetrahedron_point(&self.inside_centre(facet, weights));
        }
        let values = self.section_index.values(&self.parts().section, &self.vertices_of(facet));
        let weights = self.facet_weights(facet, weights);
        let sum: IBig = weights.iter().copied().sum();
        let coordinate = |axis: usize| -> Rational {
            let total: Rational =
                weights.iter().zip(&values).map(|(w, v)| &Rational::from((*w).clone()) * &exact(v[axis])).sum();
            &total / &Rational::from(sum.clone())
        };
        [coordinate(0), coordinate(1), Rational::ZERO]
    }

    /// Weights in the centre cell of a point on a facet that the centre shares.
    fn inside_centre(&self, facet: Facet, weights: &[IBig; K]) -> [IBig; K] {
        let step = self.steps.of(facet.cell());
        let mut inside: [IBig; K] = std::array::from_fn(|_| IBig::ZERO);
        for k in (0..K).filter(|&k| k != facet.opposite()) {
            inside[step.renumbered(facet.opposite(), k)] = weights[k].clone();
        }
        inside
    }

    /// The point of the leaf just outside the centre, for a point on the centre's boundary.
    fn out_of_centre(&self, centre: CellId, weights: &[IBig; K]) -> ExactLocation<K> {
        let i = (0..K).find(|&i| weights[i] == IBig::ZERO).expect("on the boundary a weight is 0 (please report this)");
        let far = self.adjacency().across(centre, i);
        let step = self.steps.of(centre);
        let mut outside: [IBig; K] = std::array::from_fn(|_| IBig::ZERO);
        for k in (0..K).filter(|&k| k != i) {
            outside[step.renumbered(i, k)] = weights[k].clone();
        }
        ExactLocation { cell: far.cell(), weights: outside }
    }

    pub(super) fn tetrahedron_point(&self, weights: &[IBig; K]) -> [Rational; 3] {
        let fractions = fractions(weights);
        std::array::from_fn(|axis| {
            let doubled: Rational =
                fractions.iter().zip(BALL_CORNERS).map(|(w, c)| w * &Rational::from(i64::from(c[axis]))).sum();
            &doubled / &Rational::from(2)
        })
    }

    /// Both ends of the leaf through a location.
    fn leaf_exact(&self, at: &ExactLocation<K>) -> LeafCoordinates {
        if self.is_centre(at.cell) {
            return self.leaf_from_centre(at);
        }
        let mut back = ExactLeaf::new(at.clone());
        let start = back.follow(self, Sense::Backward);
        let mut ahead = ExactLeaf::new(at.clone());
        ahead.follow(self, Sense::Forward);
        let section = self.section_exact(start, &back.at.weights);
        let (before, after) = (back.travelled(), ahead.travelled());
        let radius = self.radius();
        let whole = &(&before + &after) + &radius;
        let part = match self.parts().target {
            Target::Square | Target::Cube => before,
            Target::Disk => &after + &radius,
            Target::Ball => &before + &radius,
        };
        LeafCoordinates { section, part, whole }
    }

    fn leaf_from_centre(&self, at: &ExactLocation<K>) -> LeafCoordinates {
        let sum: IBig = at.weights.iter().sum();
        let least = at.weights.iter().min().cloned().unwrap_or(IBig::ZERO);
        // p = (1 - u) centroid + u s, and the least weight of s is 0.
        let outward = ratio(&sum - &least * IBig::from(K), sum);
        if outward.is_zero() {
            let zero = || Rational::ZERO;
            return LeafCoordinates { section: [zero(), zero(), zero()], part: zero(), whole: Rational::ONE };
        }
        let on_boundary = reduced(std::array::from_fn(|i| &at.weights[i] - &least));
        let mut leaf = ExactLeaf::new(self.out_of_centre(at.cell, &on_boundary));
        let section = if self.parts().target == Target::Ball {
            leaf.follow(self, Sense::Forward);
            self.tetrahedron_point(&on_boundary)
        } else {
            let start = leaf.follow(self, Sense::Backward);
            self.section_exact(start, &leaf.at.weights)
        };
        let radius = self.radius();
        LeafCoordinates { section, part: &outward * &radius, whole: &leaf.travelled() + &radius }
    }

    /// Image of an exact location.
    pub(super) fn image_exact(&self, at: &ExactLocation<K>) -> [Rational; 3] {
        let LeafCoordinates { section, part, whole } = self.leaf_exact(at);
        let fraction = &part / &whole;
        let [x, y, z] = section;
        match self.parts().target {
            Target::Square => [x, fraction, Rational::ZERO],
            Target::Cube => [x, y, fraction],
            Target::Ball => [&x * &fraction, &y * &fraction, &z * &fraction],
            Target::Disk => {
                let [x, y] = diamond_point(&x);
                [&x * &fraction, &y * &fraction, Rational::ZERO]
            }
        }
    }

    /// The source-side location of a point of the exact target.
    pub(super) fn preimage_exact(&self, q: &[Rational; 3]) -> Result<ExactLocation<K>, EvaluationError> {
        let outside = || EvaluationError::OutsideTarget(self.parts().target);
        let in_unit = |t: &Rational| *t >= Rational::ZERO && *t <= Rational::ONE;
        match self.parts().target {
            Target::Square | Target::Cube => {
                let is_square = self.parts().target == Target::Square;
                let t = if is_square { &q[1] } else { &q[2] };
                if !in_unit(&q[0]) || !in_unit(&q[1]) || !in_unit(&q[2]) || (is_square && !q[2].is_zero()) {
                    return Err(outside());
                }
                let at = if is_square { self.on_source_edge(&q[0]) } else { self.on_source_triangle(q) };
                let at = at.ok_or_else(outside)?;
                let mut ahead = ExactLeaf::new(at.clone());
                ahead.follow(self, Sense::Forward);
                Ok(self.along(at, &(t * &ahead.travelled())))
            }
            Target::Disk => self.preimage_in_disk(q),
            Target::Ball => self.preimage_in_ball(q),
        }
    }

    fn along(&self, at: ExactLocation<K>, wanted: &Rational) -> ExactLocation<K> {
        let mut leaf = ExactLeaf::new(at);
        leaf.follow_for(self, wanted);
        leaf.at
    }

    fn on_facet(&self, facet: Facet, weights: impl Iterator<Item = IBig>) -> ExactLocation<K> {
        let mut all: [IBig; K] = std::array::from_fn(|_| IBig::ZERO);
        for (k, weight) in (0..K).filter(|&k| k != facet.opposite()).zip(weights) {
            all[k] = weight;
        }
        ExactLocation { cell: facet.cell(), weights: all }
    }

    fn on_source_edge(&self, s: &Rational) -> Option<ExactLocation<K>> {
        let (facet, [a, b]) = self.section_index.edge_at(self.parts(), |p| exact(p) <= *s)?;
        let (a, b) = (exact(a), exact(b));
        let toward_b = &(s - &a) / &(&b - &a);
        let weights = whole(&[&Rational::ONE - &toward_b, toward_b]);
        Some(self.on_facet(facet, weights.into_iter()))
    }

    fn on_source_triangle(&self, q: &[Rational; 3]) -> Option<ExactLocation<K>> {
        let plane = [q[0].clone(), q[1].clone()];
        let (facet, weights) = self.section_index.triangle_at_exact(self.parts(), &plane)?;
        Some(self.on_facet(facet, weights.into_iter()))
    }

    /// A point at `part` of the way from the centroid along a leaf whose boundary point of the centre
    /// has the given weights.
    fn in_centre(&self, on_boundary: &[IBig; K], part: &Rational) -> ExactLocation<K> {
        let outward = part / &self.radius();
        let share = &(&Rational::ONE - &outward) / &Rational::from(K as i64);
        let fractions = fractions(on_boundary);
        let weights = whole(&std::array::from_fn(|i| &share + &(&outward * &fractions[i])));
        ExactLocation { cell: self.parts().centre.map_or(CellId::new(0), |c| c.cell), weights }
    }

    fn centroid(&self) -> ExactLocation<K> {
        let cell = self.parts().centre.map_or(CellId::new(0), |c| c.cell);
        ExactLocation { cell, weights: std::array::from_fn(|_| IBig::ONE) }
    }

    fn preimage_in_ball(&self, q: &[Rational; 3]) -> Result<ExactLocation<K>, EvaluationError> {
        let (fractions, r) = tetrahedral_coordinates(q);
        if r > Rational::ONE {
            return Err(EvaluationError::OutsideTarget(Target::Ball));
        }
        if r.is_zero() {
            return Ok(self.centroid());
        }
        let quarter = &Rational::ONE / &Rational::from(4);
        let on_boundary = whole(&std::array::from_fn::<_, K, _>(|i| &quarter + &(&(&fractions[i] - &quarter) / &r)));
        let centre = self.centroid().cell;
        let at = self.out_of_centre(centre, &on_boundary);
        let mut ahead = ExactLeaf::new(at.clone());
        ahead.follow(self, Sense::Forward);
        let part = &r * &(&ahead.travelled() + &self.radius());
        if part <= self.radius() {
            return Ok(self.in_centre(&on_boundary, &part));
        }
        Ok(self.along(at, &(&part - &self.radius())))
    }

    fn preimage_in_disk(&self, q: &[Rational; 3]) -> Result<ExactLocation<K>, EvaluationError> {
        let outside = || EvaluationError::OutsideTarget(Target::Disk);
        let (theta, r) = diamond_coordinates(&q[0], &q[1]);
        if r > Rational::ONE || !q[2].is_zero() {
            return Err(outside());
        }
        if r.is_zero() {
            return Ok(self.centroid());
        }
        let at = self.on_source_edge(&theta).ok_or_else(outside)?;
        let mut ahead = ExactLeaf::new(at.clone());
        let end = ahead.follow(self, Sense::Forward);
        let length = ahead.travelled();
        let part = &r * &(&length + &self.radius());
        if part <= self.radius() {
            return Ok(self.in_centre(&self.inside_centre(end, &ahead.at.weights), &part));
        }
        Ok(self.along(at, &(&length - &(&part - &self.radius()))))
    }

    /// Coordinates of an exact location.
    pub(super) fn position_exact(&self, at: &ExactLocation<K>) -> [Rational; 3] {
        let (cell, weights) = self.locator.source_weights_exact(self.source(), &self.parts().mesh, at);
        let fractions = fractions(&weights);
        let corners = self.source().complex().cell(cell).map(|v| self.source().positions()[v.index()]);
        std::array::from_fn(|axis| fractions.iter().zip(&corners).map(|(w, c)| w * &exact(c[axis])).sum())
    }

    /// How many cells the leaf of a point crosses, both ways (for benchmarks).
    ///
    /// # Errors
    /// When the point does not lie in the mesh.
    pub fn leaf_cells(&self, point: &[Rational; 3]) -> Result<usize, EvaluationError> {
        let at = self.locator.exact(self.source(), &self.parts().mesh, point)?;
        if self.is_centre(at.cell) {
            return Ok(1);
        }
        let steps = [Sense::Backward, Sense::Forward].map(|sense| {
            let mut leaf = ExactLeaf::new(at.clone());
            leaf.follow(self, sense);
            leaf.steps
        });
        Ok(steps[0] + steps[1])
    }
}

/// A finite number, exactly.
pub(super) fn exact(value: f64) -> Rational {
    Rational::from_f64(value).unwrap_or(Rational::ZERO)
}

/// The point of the diamond's boundary at parameter `theta` in `[0, 4]`.
pub(super) fn diamond_point(theta: &Rational) -> [Rational; 2] {
    let along = |from: i64| theta - &Rational::from(from);
    let one = Rational::ONE;
    if *theta <= Rational::ONE {
        [&one - theta, along(0)]
    } else if *theta <= Rational::from(2) {
        [-along(1), &one - &along(1)]
    } else if *theta <= Rational::from(3) {
        [&along(2) - &one, -along(2)]
    } else {
        [along(3), &along(3) - &one]
    }
}

/// Parameter and size of a point of the diamond.
pub(super) fn diamond_coordinates(x: &Rational, y: &Rational) -> (Rational, Rational) {
    let magnitude = |v: &Rational| if v.sign() == Sign::Negative { -v.clone() } else { v.clone() };
    let r = &magnitude(x) + &magnitude(y);
    if r.is_zero() {
        return (Rational::ZERO, r);
    }
    let (x, y) = (x / &r, y / &r);
    let theta = match (x.sign(), y.sign()) {
        (Sign::Positive, Sign::Zero | Sign::Positive) => y,
        (Sign::Zero | Sign::Negative, Sign::Positive) => &Rational::ONE - &x,
        (Sign::Negative, _) => &Rational::from(2) - &y,
        _ => &Rational::from(3) + &x,
    };
    (theta, r)
}

/// Barycentric coordinates of a point in the exact ball, and its size: 0 in the centre, 1 on the boundary.
pub(super) fn tetrahedral_coordinates(q: &[Rational; 3]) -> ([Rational; 4], Rational) {
    // The corners are c / 2 with c . c = 3 and sum 0, so the coordinate of corner c is 1/4 + (q . c) / 2.
    let quarter = &Rational::ONE / &Rational::from(4);
    let fractions: [Rational; 4] = std::array::from_fn(|i| {
        let along: Rational = (0..3).map(|axis| &q[axis] * &Rational::from(i64::from(BALL_CORNERS[i][axis]))).sum();
        &quarter + &(&along / &Rational::from(2))
    });
    let least = fractions.iter().min().cloned().unwrap_or(Rational::ZERO);
    let size = &Rational::ONE - &(&Rational::from(4) * &least);
    (fractions, size)
}

impl<const K: usize> Bijection for Foliation<K> {
    fn forward(&self, point: [f64; 3]) -> Result<Enclosed, EvaluationError> {
        self.forward_float(point)
    }

    fn inverse(&self, point: [f64; 3]) -> Result<Enclosed, EvaluationError> {
        self.inverse_float(point)
    }

    fn forward_batch(&self, points: &[[f64; 3]]) -> Vec<Result<Enclosed, EvaluationError>> {
        self.forward_all(points)
    }

    fn forward_exact(&self, point: &[Rational; 3]) -> Result<[Rational; 3], EvaluationError> {
        let at = self.locator.exact(self.source(), &self.parts().mesh, point)?;
        Ok(self.image_exact(&at))
    }

    fn inverse_exact(&self, point: &[Rational; 3]) -> Result<[Rational; 3], EvaluationError> {
        Ok(self.position_exact(&self.preimage_exact(point)?))
    }
}
