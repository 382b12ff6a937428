//! Where a point lies: its cell and barycentric weights, exactly or in floating point with bounds.

use dashu_base::Signed;
use dashu_int::IBig;
use homeo_core::mesh::CellId;
use homeo_core::number::Rational;
use homeo_core::predicate::{Sign, orient3d};
use homeo_core::spatial::{Aabb, Tree};

use super::EvaluationError;
use super::exact::{ExactLocation, whole};
use super::nearest::{Projection, exact_cross, exact_dot, minus, nearest_exactly};
use crate::input::SourceMesh;
use crate::refine::RefinedMesh;

/// Points of a volume this far outside, relative to the box's diagonal, are taken for rounded ones.
const ROUNDING: f64 = 1e-12;
/// Points this far off a surface, relative to the box's diagonal, stand for their nearest point.
const OFF_SURFACE: f64 = 1e-6;

/// A cell of the foliated mesh and weights in floating point.
#[derive(Clone, Copy, Debug)]
pub(super) struct FloatLocation<const K: usize> {
    pub cell: CellId,
    /// Barycentric coordinates, adding up to nearly 1.
    pub weights: [f64; K],
    /// Bounds of their errors. Where one is 0, the weight is exact.
    pub errors: [f64; K],
    /// Whether the point is *defined* by the weights (up to their sum), not by coordinates.
    pub is_exact: bool,
}

/// What a floating-point query finds.
pub(super) enum Located<const K: usize> {
    /// A location good enough to go on with.
    Float(FloatLocation<K>),
    /// Rounding cannot tell which cell it is: go on exactly from here.
    Exact(ExactLocation<K>),
}

/// Finds the source cell of a point, and the refined cell inside it.
#[derive(Debug)]
pub(super) struct Locator<const K: usize> {
    tree: Tree,
    diagonal: f64,
    /// Where the children of each source cell begin; one more entry than source cells.
    first_child: Vec<u32>,
}

impl<const K: usize> Locator<K> {
    pub fn new(source: &SourceMesh<K>, mesh: &RefinedMesh<K>) -> Self {
        let corners = |cell: &[homeo_core::mesh::VertexId; K]| cell.map(|v| source.positions()[v.index()]);
        let boxes: Vec<Aabb> = source.complex().cells().iter().map(|cell| Aabb::of(&corners(cell))).collect();
        let hull = boxes.iter().fold(Aabb::EMPTY, |hull, b| hull.joined(b));
        let diagonal = (0..3).map(|axis| (hull.high[axis] - hull.low[axis]).powi(2)).sum::<f64>().sqrt();
        let mut first_child = vec![0u32; source.complex().cell_count() + 1];
        for parent in mesh.parents() {
            if let Some(slot) = first_child.get_mut(parent.index() + 1) {
                *slot += 1;
            }
        }
        for i in 1..first_child.len() {
            first_child[i] += first_child[i - 1];
        }
        Self { tree: Tree::new(&boxes), diagonal, first_child }
    }

    /// Diagonal of the source's box.
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    fn children(&self, cell: CellId) -> impl ExactSizeIterator<Item = CellId> + use<K> {
        (self.first_child[cell.index()] as usize..self.first_child[cell.index() + 1] as usize).map(CellId::new)
    }

    /// The location of a rational point, exactly.
    pub fn exact(
        &self,
        source: &SourceMesh<K>,
        mesh: &RefinedMesh<K>,
        point: &[Rational; 3],
    ) -> Result<ExactLocation<K>, EvaluationError> {
        let near = [0, 1, 2].map(|axis| point[axis].to_f64());
        let region = Aabb { low: near.map(f64::next_down), high: near.map(f64::next_up) };
        let mut candidates = Vec::new();
        self.tree.query_box(&region, |cell| candidates.push(CellId::new(cell)));
        candidates.sort_unstable();
        let mut found: Option<(CellId, [IBig; K])> = None;
        for cell in candidates {
            let corners = source.complex().cell(cell).map(|v| source.positions()[v.index()]);
            let Some(weights) = exact_weights(&corners, point) else { continue };
            match &found {
                None => found = Some((cell, weights)),
                Some((first, known)) => {
                    if !same_point(source, *first, known, cell, &weights) {
                        return Err(EvaluationError::Ambiguous(first.raw(), cell.raw()));
                    }
                }
            }
        }
        let (cell, weights) = found.ok_or(EvaluationError::OutsideSource)?;
        self.child_exact(source, mesh, cell, &weights)
    }

    /// The child of a source cell that contains the point with the given weights.
    pub(super) fn child_exact(
        &self,
        source: &SourceMesh<K>,
        mesh: &RefinedMesh<K>,
        cell: CellId,
        weights: &[IBig; K],
    ) -> Result<ExactLocation<K>, EvaluationError> {
        let parent = source.complex().cell(cell);
        for child in self.children(cell) {
            let frame = ChildFrame::new(mesh, parent, child);
            let inner = frame.inner_exact(weights);
            if inner.iter().all(|w| !w.is_negative()) {
                return Ok(ExactLocation { cell: child, weights: inner });
            }
        }
        Err(EvaluationError::NotCovered(cell.raw()))
    }

    /// The location of a point in floating point.
    pub fn float(
        &self,
        source: &SourceMesh<K>,
        mesh: &RefinedMesh<K>,
        point: [f64; 3],
    ) -> Result<Located<K>, EvaluationError> {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(EvaluationError::NotFinite);
        }
        if K == 3 { self.float_on_surface(source, mesh, point) } else { self.float_in_volume(source, mesh, point) }
    }

    /// The exact location of a point that a floating-point query has found.
    pub fn exactly(
        &self,
        source: &SourceMesh<K>,
        mesh: &RefinedMesh<K>,
        located: &Located<K>,
        point: [f64; 3],
    ) -> Result<ExactLocation<K>, EvaluationError> {
        match located {
            Located::Exact(at) => Ok(at.clone()),
            Located::Float(at) if at.is_exact => {
                let weights = at.weights.map(|w| Rational::from_f64(w).unwrap_or(Rational::ZERO));
                Ok(ExactLocation { cell: at.cell, weights: whole(&weights) })
            }
            // A point near a surface stands for the nearest point of the surface.
            Located::Float(_) if K == 3 => self.nearest_exact(source, mesh, point),
            Located::Float(_) => self.exact(source, mesh, &rational_point(point)),
        }
    }

    fn float_in_volume(
        &self,
        source: &SourceMesh<K>,
        mesh: &RefinedMesh<K>,
        point: [f64; 3],
    ) -> Result<Located<K>, EvaluationError> {
        let mut found: Option<CellId> = None;
        self.tree.query_point(point, |index| {
            let cell = CellId::new(index);
            if found.is_none_or(|best| cell < best) && contains(&corners(source, cell), point) {
                found = Some(cell);
            }
        });
        if let Some(cell) = found {
            let (weights, errors) = volume_weights(&corners(source, cell), point);
            return Ok(match self.child_float(source, mesh, cell, weights, errors) {
                Some(at) => Located::Float(at),
                None => Located::Exact(self.exact(source, mesh, &rational_point(point))?),
            });
        }
        // Just outside by rounding: the nearest of the cells around, with weights clamped.
        let slack = self.diagonal * ROUNDING;
        let region = Aabb { low: point.map(|x| x - slack), high: point.map(|x| x + slack) };
        let mut best: Option<(f64, CellId, [f64; K])> = None;
        self.tree.query_box(&region, |index| {
            let cell = CellId::new(index);
            let corners = corners(source, cell);
            let (weights, _) = volume_weights(&corners, point);
            let clamped = clamp(weights);
            let moved = distance(combination(&corners, &clamped), point);
            if moved <= 2.0 * slack && best.is_none_or(|(least, known, _)| (moved, cell) < (least, known)) {
                best = Some((moved, cell, clamped));
            }
        });
        let (_, cell, weights) = best.ok_or(EvaluationError::OutsideSource)?;
        Ok(self.child_of_weights(source, mesh, cell, weights))
    }

    fn float_on_surface(
        &self,
        source: &SourceMesh<K>,
        mesh: &RefinedMesh<K>,
        point: [f64; 3],
    ) -> Result<Located<K>, EvaluationError> {
        let mut vertex: Option<(CellId, usize)> = None;
        let mut best: Option<(CellId, Projection<K>)> = None;
        let mut rival = f64::INFINITY;
        self.tree.query_box(&self.around(point), |index| {
            let cell = CellId::new(index);
            let corners = corners(source, cell);
            if let Some(i) = corners.iter().position(|&c| c == point) {
                vertex = Some(vertex.map_or((cell, i), |first| first.min((cell, i))));
            }
            let projection = Projection::new(&corners, point);
            let known = best.as_ref().map_or(f64::INFINITY, |(_, best)| best.distance_at_most);
            if projection.distance_at_most < known {
                rival = best.as_ref().map_or(rival, |(_, old)| rival.min(old.distance_at_least));
                best = Some((cell, projection));
            } else {
                rival = rival.min(projection.distance_at_least);
            }
        });
        if let Some((cell, i)) = vertex {
            return Ok(self.child_of_weights(source, mesh, cell, std::array::from_fn(|k| f64::from(k == i))));
        }
        if let Some((cell, p)) = best.filter(|(_, p)| p.distance_at_most < rival.min(self.off_surface()))
            && let Some(at) = self.child_float(source, mesh, cell, p.weights, p.errors)
        {
            return Ok(Located::Float(at));
        }
        self.nearest_exact(source, mesh, point).map(Located::Exact)
    }

    /// How far from a surface a point may be.
    fn off_surface(&self) -> f64 {
        self.diagonal * OFF_SURFACE
    }

    fn around(&self, point: [f64; 3]) -> Aabb {
        let slack = self.off_surface();
        Aabb { low: point.map(|x| (x - slack).next_down()), high: point.map(|x| (x + slack).next_up()) }
    }

    /// The location of the point of a surface that is nearest to a point, exactly; of several the one in the first cell.
    pub fn nearest_exact(
        &self,
        source: &SourceMesh<K>,
        mesh: &RefinedMesh<K>,
        point: [f64; 3],
    ) -> Result<ExactLocation<K>, EvaluationError> {
        let mut best: Option<(Rational, CellId, [Rational; K])> = None;
        let exact_point = rational_point(point);
        self.tree.query_box(&self.around(point), |index| {
            let cell = CellId::new(index);
            if let Some((off, weights)) = nearest_exactly(&corners(source, cell), &exact_point)
                && best.as_ref().is_none_or(|(least, known, _)| (&off, cell) < (least, *known))
            {
                best = Some((off, cell, weights));
            }
        });
        let slack = Rational::from_f64(self.off_surface()).unwrap_or(Rational::ZERO);
        let (_, cell, weights) =
            best.filter(|(off, ..)| *off <= &slack * &slack).ok_or(EvaluationError::OutsideSource)?;
        self.child_exact(source, mesh, cell, &whole(&weights))
    }

    /// The child that holds a point given by weights, which are taken for exact ones from here on.
    fn child_of_weights(
        &self,
        source: &SourceMesh<K>,
        mesh: &RefinedMesh<K>,
        cell: CellId,
        weights: [f64; K],
    ) -> Located<K> {
        let parent = source.complex().cell(cell);
        let mut best = (f64::NEG_INFINITY, cell, weights);
        for child in self.children(cell) {
            let (inner, _) = ChildFrame::new(mesh, parent, child).inner_float(&weights, &[0.0; K]);
            let least = inner.iter().copied().fold(f64::INFINITY, f64::min);
            if least > best.0 {
                best = (least, child, inner);
            }
        }
        let weights = clamp(best.2);
        let errors = weights.map(|w| 4.0 * f64::EPSILON * w);
        Located::Float(FloatLocation { cell: best.1, weights, errors, is_exact: true })
    }

    /// The child that holds a point of a cell, where rounding leaves no doubt.
    fn child_float(
        &self,
        source: &SourceMesh<K>,
        mesh: &RefinedMesh<K>,
        cell: CellId,
        weights: [f64; K],
        errors: [f64; K],
    ) -> Option<FloatLocation<K>> {
        let mut children = self.children(cell);
        if children.len() == 1 {
            return children.next().map(|cell| FloatLocation { cell, weights, errors, is_exact: false });
        }
        let parent = source.complex().cell(cell);
        children.find_map(|cell| {
            let (weights, errors) = ChildFrame::new(mesh, parent, cell).inner_float(&weights, &errors);
            let is_inside = weights.iter().zip(&errors).all(|(w, e)| w >= e);
            is_inside.then_some(FloatLocation { cell, weights, errors, is_exact: false })
        })
    }

    /// The source weights of an exact location, with the source cell that they refer to.
    pub fn source_weights_exact(
        &self,
        source: &SourceMesh<K>,
        mesh: &RefinedMesh<K>,
        location: &ExactLocation<K>,
    ) -> (CellId, [IBig; K]) {
        let cell = mesh.parents()[location.cell.index()];
        (cell, ChildFrame::new(mesh, source.complex().cell(cell), location.cell).outer_exact(&location.weights))
    }
}

/// A finite point, as rationals.
pub(super) fn rational_point(point: [f64; 3]) -> [Rational; 3] {
    point.map(|x| Rational::from_f64(x).unwrap_or(Rational::ZERO))
}

fn corners<const K: usize>(source: &SourceMesh<K>, cell: CellId) -> [[f64; 3]; K] {
    source.complex().cell(cell).map(|v| source.positions()[v.index()])
}

/// A child cell's vertices in weights of its parent's vertices.
struct ChildFrame<const K: usize> {
    /// `carriers[v][j]`: weight of parent vertex `j` in child vertex `v`.
    carriers: [[i64; K]; K],
    totals: [i64; K],
    is_parent: bool,
}

impl<const K: usize> ChildFrame<K> {
    fn new(mesh: &RefinedMesh<K>, parent: [homeo_core::mesh::VertexId; K], child: CellId) -> Self {
        let corners = mesh.complex().cell(child);
        if corners == parent {
            let carriers = std::array::from_fn(|v| std::array::from_fn(|j| i64::from(v == j)));
            return Self { carriers, totals: [1; K], is_parent: true };
        }
        let mut frame = Self { carriers: [[0; K]; K], totals: [0; K], is_parent: false };
        for (v, &vertex) in corners.iter().enumerate() {
            let carrier = mesh.carrier(vertex);
            frame.totals[v] = carrier.total();
            for (corner, weight) in carrier.terms() {
                if let Some(j) = parent.iter().position(|&p| p == corner) {
                    frame.carriers[v][j] = weight;
                }
            }
        }
        frame
    }

    /// Cofactors `c[v][j]` such that the weight of child vertex `v` is `total_v * sum_j c[v][j] w_j`,
    /// up to a common positive factor.
    fn cofactors(&self) -> [[i128; K]; K] {
        let matrix = self.carriers.map(|row| row.map(i128::from));
        let mut cofactors = [[0i128; K]; K];
        for (v, row) in cofactors.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let sign = if (v + j) % 2 == 0 { 1 } else { -1 };
                *entry = sign * minor(&matrix, v, j);
            }
        }
        let determinant: i128 = (0..K).map(|j| matrix[0][j] * cofactors[0][j]).sum();
        if determinant < 0 { cofactors.map(|row| row.map(|c| -c)) } else { cofactors }
    }

    fn inner_exact(&self, weights: &[IBig; K]) -> [IBig; K] {
        if self.is_parent {
            return weights.clone();
        }
        let cofactors = self.cofactors();
        let inner = std::array::from_fn(|v| {
            let sum: IBig = (0..K).map(|j| &weights[j] * IBig::from(cofactors[v][j])).sum();
            sum * IBig::from(self.totals[v])
        });
        super::exact::reduced(inner)
    }

    fn outer_exact(&self, weights: &[IBig; K]) -> [IBig; K] {
        if self.is_parent {
            return weights.clone();
        }
        let product: IBig = self.totals.iter().map(|&t| IBig::from(t)).product();
        let outer = std::array::from_fn(|j| {
            (0..K)
                .filter(|&v| self.carriers[v][j] != 0)
                .map(|v| &weights[v] * (&product / IBig::from(self.totals[v])) * IBig::from(self.carriers[v][j]))
                .sum()
        });
        super::exact::reduced(outer)
    }

    fn inner_float(&self, weights: &[f64; K], errors: &[f64; K]) -> ([f64; K], [f64; K]) {
        if self.is_parent {
            return (*weights, *errors);
        }
        let cofactors = self.cofactors();
        let determinant: f64 = (0..K).map(|j| self.carriers[0][j] as f64 * cofactors[0][j] as f64).sum();
        let (mut inner, mut bounds) = ([0.0; K], [0.0; K]);
        for v in 0..K {
            let scale = self.totals[v] as f64 / determinant;
            let (mut magnitude, mut error) = (0.0, 0.0);
            for j in 0..K {
                let factor = cofactors[v][j] as f64 * scale;
                inner[v] += factor * weights[j];
                magnitude += (factor * weights[j]).abs();
                error += factor.abs() * errors[j];
            }
            bounds[v] = error + 16.0 * f64::EPSILON * magnitude;
        }
        (inner, bounds)
    }
}

fn minor<const K: usize>(matrix: &[[i128; K]; K], row: usize, column: usize) -> i128 {
    let mut kept = [[0i128; 3]; 3];
    for (target, i) in (0..K).filter(|&i| i != row).enumerate() {
        for (slot, j) in (0..K).filter(|&j| j != column).enumerate() {
            kept[target][slot] = matrix[i][j];
        }
    }
    let [a, b, c] = kept;
    if K == 3 {
        return a[0] * b[1] - a[1] * b[0];
    }
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Whether weights in two cells stand for one point of the complex: equal on common vertices, 0 elsewhere.
fn same_point<const K: usize>(
    source: &SourceMesh<K>,
    first: CellId,
    known: &[IBig; K],
    second: CellId,
    weights: &[IBig; K],
) -> bool {
    let (here, there) = (source.complex().cell(first), source.complex().cell(second));
    let (sum_known, sum): (IBig, IBig) = (known.iter().sum(), weights.iter().sum());
    (0..K).all(|i| match there.iter().position(|&v| v == here[i]) {
        Some(j) => &known[i] * &sum == &weights[j] * &sum_known,
        None => known[i] == IBig::ZERO,
    })
}

/// Barycentric weights of a rational point in a cell, up to a positive factor; `None` when outside.
fn exact_weights<const K: usize>(corners: &[[f64; 3]; K], point: &[Rational; 3]) -> Option<[IBig; K]> {
    let mut exact = Vec::with_capacity(K);
    for corner in corners {
        let [x, y, z] = corner.map(Rational::from_f64);
        exact.push([x?, y?, z?]);
    }
    let mut weights: [Rational; K] = std::array::from_fn(|_| Rational::ZERO);
    if K == 4 {
        let spans = [1, 2, 3].map(|i| minus(&exact[i], &exact[0]));
        let offset = minus(point, &exact[0]);
        let normals =
            [exact_cross(&spans[1], &spans[2]), exact_cross(&spans[2], &spans[0]), exact_cross(&spans[0], &spans[1])];
        let volume = exact_dot(&spans[0], &normals[0]);
        (0..3).for_each(|i| weights[i + 1] = exact_dot(&normals[i], &offset));
        weights[0] = &volume - &weights[1..].iter().cloned().sum();
        return signed_weights(weights, volume.sign());
    }
    let spans = [1, 2].map(|i| minus(&exact[i], &exact[0]));
    let offset = minus(point, &exact[0]);
    let normal = exact_cross(&spans[0], &spans[1]);
    if exact_dot(&normal, &offset).sign() != Sign::Zero {
        return None;
    }
    weights[1] = exact_dot(&exact_cross(&offset, &spans[1]), &normal);
    weights[2] = exact_dot(&exact_cross(&spans[0], &offset), &normal);
    let square = exact_dot(&normal, &normal);
    weights[0] = &(&square - &weights[1]) - &weights[2];
    signed_weights(weights, square.sign())
}

fn signed_weights<const K: usize>(weights: [Rational; K], sign: Sign) -> Option<[IBig; K]> {
    if sign == Sign::Zero || weights.iter().any(|w| w.sign() == sign.reversed()) {
        return None;
    }
    let weights = whole(&weights);
    Some(if sign == Sign::Negative { weights.map(|w| -w) } else { weights })
}

/// Whether a tetrahedron contains a point, decided exactly.
fn contains<const K: usize>(corners: &[[f64; 3]; K], point: [f64; 3]) -> bool {
    let signs = facet_signs(corners, point);
    signs.iter().all(|&s| s != Sign::Negative) || signs.iter().all(|&s| s != Sign::Positive)
}

fn facet_signs<const K: usize>(corners: &[[f64; 3]; K], point: [f64; 3]) -> [Sign; K] {
    std::array::from_fn(|i| {
        let mut moved = *corners;
        moved[i] = point;
        orient3d(moved[0], moved[1], moved[2], moved[K - 1])
    })
}

/// Barycentric weights of a point in a tetrahedron with bounds of their errors, 0 where exact.
fn volume_weights<const K: usize>(corners: &[[f64; 3]; K], point: [f64; 3]) -> ([f64; K], [f64; K]) {
    let signs = facet_signs(corners, point);
    let (mut volumes, mut bounds) = ([0.0; K], [0.0; K]);
    for i in (0..K).filter(|&i| signs[i] != Sign::Zero) {
        let mut moved = *corners;
        moved[i] = point;
        (volumes[i], bounds[i]) = six_volumes([moved[0], moved[1], moved[2], moved[K - 1]]);
    }
    let sum: f64 = volumes.iter().sum();
    let sum_bound: f64 = bounds.iter().sum::<f64>() + 4.0 * f64::EPSILON * volumes.iter().map(|v| v.abs()).sum::<f64>();
    let safe = (sum.abs() - sum_bound).max(0.0);
    let weights = volumes.map(|v| v / sum);
    let errors = std::array::from_fn(|i| {
        if signs[i] == Sign::Zero {
            0.0
        } else {
            (bounds[i] + weights[i].abs() * sum_bound) / safe + 4.0 * f64::EPSILON * weights[i].abs()
        }
    });
    (weights, errors)
}

/// Six times the volume of a tetrahedron and a bound of the error (Shewchuk's stage A bound, doubled).
fn six_volumes([a, b, c, d]: [[f64; 3]; 4]) -> (f64, f64) {
    let [u, v, w] = [b, c, d].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    let mut volume = 0.0;
    let mut permanent = 0.0;
    for axis in 0..3 {
        let (y, z) = ((axis + 1) % 3, (axis + 2) % 3);
        volume += u[axis] * (v[y] * w[z] - v[z] * w[y]);
        permanent += u[axis].abs() * ((v[y] * w[z]).abs() + (v[z] * w[y]).abs());
    }
    (volume, 16.0 * f64::EPSILON * permanent)
}

fn clamp<const K: usize>(weights: [f64; K]) -> [f64; K] {
    let clamped = weights.map(|w| if w > 0.0 { w } else { 0.0 });
    let sum: f64 = clamped.iter().sum();
    clamped.map(|w| w / sum)
}

fn combination<const K: usize>(corners: &[[f64; 3]; K], weights: &[f64; K]) -> [f64; 3] {
    std::array::from_fn(|axis| (0..K).map(|i| weights[i] * corners[i][axis]).sum())
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
