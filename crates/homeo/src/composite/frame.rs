//! A mean value map in a chart, with its derivatives: in doubles and in affine forms by one text.

use homeo_core::planar::Point2;

use super::chart::{Chart, Step, Touch};
use super::guide::{Guide, Linear};
use super::line::Line;
use super::number::{Edge, Motion, Number, Sight, half_tangent};
use super::vector::{Dual, Vector, cross, dot, minus, of, opposite, plus, scaled};

/// A chart and all vertices as seen from its own.
pub(crate) struct Frame<'a, T> {
    pub step: &'a Step,
    pub chart: &'a Chart,
    /// `p - v` and `q - p`.
    pub axes: [Vector<T>; 2],
    pub turn: T,
    /// Of each vertex: where it is, and where it goes, less where `v` is, and where it or, if it is no vertex, the
    /// first vertex goes.
    pub offsets: Vec<[Vector<T>; 2]>,
    /// By their first vertices.
    edges: Vec<Edge<T>>,
    /// The same edges, if the images of points run along them at speeds; or nothing.
    pub(super) lines: Vec<Line<T>>,
    pub(super) sights: Vec<Sight<T>>,
    /// Of each edge, by its first vertex: the half tangent and its gradient.
    pub(super) tangents: Vec<[T; 3]>,
}

/// A mean value map near a point of a chart.
#[derive(Clone, Copy)]
pub(crate) struct Local<T> {
    /// Where the point goes.
    pub image: Vector<T>,
    /// The determinant of the derivative.
    pub determinant: T,
    /// Two vectors.
    pub axes: [Vector<T>; 2],
    /// Their images under the derivative.
    pub columns: [Vector<T>; 2],
    /// The determinant of the two vectors.
    pub turn: T,
}

impl<'a, T: Number> Frame<'a, T> {
    pub fn new(step: &'a Step, chart: &'a Chart) -> Self {
        let [v, from, to] = chart.corners.map(|corner| of::<T>(step.corner(corner)));
        let image = of::<T>(step.base_image(chart));
        let (side, other) = (minus(from, v), minus(to, v));
        let [a, b, c] = chart.part.factors().map(|[above, below]| T::of(above) / T::of(below));
        let axes = [scaled(a, side), plus(scaled(b - a, side), scaled(c, other))];
        let offset = |(&at, &to): (&Point2, &Point2)| [minus(of(at), v), minus(of(to), image)];
        let offsets: Vec<_> = step.points.iter().zip(&step.images).map(offset).collect();
        let edge = |(from, &to): (&Point2, &u32)| {
            let [x, y] = minus(of::<T>(*from), of(step.points[to as usize]));
            Edge { vector: [x, y.opposite()], length: T::length(x, y).most() }
        };
        let edges = step.points.iter().zip(&step.next).map(edge).collect();
        let sights = vec![nothing(); offsets.len()];
        let tangents = vec![[T::of(0.0); 3]; offsets.len()];
        Self { step, chart, axes, turn: T::of_form(chart.turn), offsets, edges, lines: step.lines(), sights, tangents }
    }

    /// Two coordinates of a point: `s`, and `s λ`.
    pub fn coordinates(&self, point: Vector<T>) -> Vector<T> {
        let v = of(self.step.corner(self.chart.corners[0]));
        let offset = minus(point, v);
        [cross(offset, self.axes[1]) / self.turn, cross(self.axes[0], offset) / self.turn]
    }

    /// The map and its derivative at `v + s e(λ)`; unknown where a divisor may be zero.
    ///
    /// Any guide gives the same exact result.
    pub fn evaluate(&mut self, s: T, lambda: T, guide: &Guide) -> Local<T> {
        let view = self.look(s, lambda);
        let sums = self.sums(&view, guide);
        self.local(&view, &sums, guide)
    }

    /// The apex, if it is a vertex of the domain.
    pub fn apex(&self) -> Option<usize> {
        let v = self.chart.corners[0];
        self.step.is_vertex(v).then_some(v as usize)
    }

    /// Looks at all vertices and edges from `v + s e(λ)`.
    pub fn look(&mut self, s: T, lambda: T) -> View<T> {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let along = plus(self.axes[0], scaled(lambda, self.axes[1]));
        let position = scaled(s, along);
        let Some(apex) = self.apex() else {
            self.look_from(position, None);
            let [along, across] = [[one, zero], [zero, one]];
            return View {
                position,
                s: one,
                along,
                across,
                skew: zero,
                length: Dual([one, zero, zero]),
                at_apex: None,
            };
        };
        let towards = T::sight(along, &T::motion(along)).unit;
        // Instead of ∂/∂λ the derivative almost across e, lest determinants be differences of large numbers.
        let skew = T::of(dot(self.axes[1], along).near() / dot(along, along).near());
        let across = minus(self.axes[1], scaled(skew, along));
        let length = Dual([T::length(along[0], along[1]), zero, dot(towards, self.axes[1])]);
        self.look_from(position, Some((apex, opposite(towards))));
        let view = View { position, s, along, across, skew, length, at_apex: None };
        let at_apex = [Touch::Next, Touch::Previous].map(|touch| self.edge_at_apex(touch, &view, lambda));
        View { at_apex: Some(at_apex), ..view }
    }

    /// Sums of all vertices and edges.
    pub fn sums(&self, view: &View<T>, guide: &Guide) -> Sums<T> {
        let factor = view.factor();
        let [mut weight, first, second] =
            self.regular_sums(guide).map(|[value, x, y]| view.chain(value, [x, y]).with(factor));
        let mut sums = Sums { total: Dual([T::of(0.0); 3]), numerator: [first, second] };
        for edge in view.edges() {
            let tangent = view.tangent(edge);
            let share = tangent.times(self.inverse(view, edge.end));
            weight = weight.plus(share);
            let residual = self.residual(edge.end, guide);
            for (sum, c) in sums.numerator.iter_mut().zip(residual) {
                *sum = sum.plus(share.times_constant(c));
            }
            sums.total = sums.total.plus(tangent.over(view.length));
        }
        // With an apex everything is divided by `s` but its own weight.
        sums.total = if view.at_apex.is_none() { weight } else { sums.total.plus(view.along_dual().times(weight)) };
        for (edge, line) in self.lines.iter().enumerate() {
            let [x, y] = self.added(view, edge, line);
            sums.numerator = [sums.numerator[0].plus(x), sums.numerator[1].plus(y)];
        }
        sums
    }

    /// From sums to the map.
    pub fn local(&self, view: &View<T>, sums: &Sums<T>, guide: &Guide) -> Local<T> {
        let rest = sums.numerator.map(|sum| sum.over(sums.total));
        let axes = [view.along, view.across];
        let added = view.columns(rest);
        let [along, across] = axes.map(|axis| apply(&guide.linear, axis));
        // det(M e + g, M e' + h), where det(M e, M e') is det M times that of the axes, which is constant.
        let mixed = cross(along, added[1]) + cross(added[0], across) + cross(added[0], added[1]);
        let own = cross(of::<T>(guide.linear[0]), of(guide.linear[1]));
        let base = plus(of(self.step.base_image(self.chart)), of(guide.shift));
        let moved = plus(apply(&guide.linear, view.position), scaled(view.s, rest.map(|c| c.0[0])));
        let columns = [plus(along, added[0]), plus(across, added[1])];
        let image = plus(base, moved);
        if view.at_apex.is_none() {
            return Local { image, determinant: own + mixed, axes, columns, turn: T::of(1.0) };
        }
        Local { image, determinant: own + mixed / self.turn, axes, columns, turn: self.turn }
    }

    /// The other end of an edge at the apex.
    fn neighbour(&self, touch: Touch) -> usize {
        let v = self.chart.corners[0] as usize;
        (if touch == Touch::Next { self.step.next[v] } else { self.step.previous[v] }) as usize
    }

    /// How far a vertex misses its image under the linear map.
    #[inline(always)]
    fn residual(&self, vertex: usize, guide: &Guide) -> Vector<T> {
        let [offset, image] = self.offsets[vertex];
        minus(minus(image, of(guide.shift)), apply(&guide.linear, offset))
    }

    /// One over the distance of a vertex.
    pub(super) fn inverse(&self, view: &View<T>, vertex: usize) -> Dual<T> {
        let Sight { inverse, pull, .. } = self.sights[vertex];
        view.chain(inverse, scaled(inverse, pull))
    }

    /// Looks from `v + offset`; at the apex, if that is one, in a direction, and not at its edges.
    fn look_from(&mut self, offset: Vector<T>, apex: Option<(usize, Vector<T>)>) {
        let motion = T::motion(offset);
        for (sight, [at, _]) in self.sights.iter_mut().zip(&self.offsets) {
            *sight = T::sight(minus(*at, offset), &motion);
        }
        if let Some((v, unit)) = apex {
            self.sights[v] = Sight { unit, ..nothing() };
        }
        for (i, tangent) in self.tangents.iter_mut().enumerate() {
            let k = self.step.next[i] as usize;
            *tangent = match apex {
                Some((v, _)) if i == v || k == v => [T::of(0.0); 3],
                _ => tangent_of([&self.sights[i], &self.sights[k]], &self.edges[i], &motion),
            };
        }
    }

    /// Sums of weights, and of weights times both coordinates of residuals, with gradients in the plane.
    fn regular_sums(&self, guide: &Guide) -> [[T; 3]; 3] {
        let apex = self.apex();
        let mut sums = [[T::of(0.0); 3]; 3];
        for (i, sight) in self.sights.iter().enumerate() {
            if apex == Some(i) {
                continue;
            }
            let (before, after) = (&self.tangents[self.step.previous[i] as usize], &self.tangents[i]);
            let [value, x, y]: [T; 3] = std::array::from_fn(|k| before[k] + after[k]);
            let weight = [value, x + value * sight.pull[0], y + value * sight.pull[1]].map(|c| sight.inverse * c);
            let [x, y] = self.residual(i, guide);
            for k in 0..3 {
                sums[0][k] = sums[0][k] + weight[k];
                sums[1][k] = sums[1][k] + weight[k].times_constant(x);
                sums[2][k] = sums[2][k] + weight[k].times_constant(y);
            }
        }
        sums
    }

    /// An edge that ends at the apex; if the chart touches it, times `λ`, which cancels.
    fn edge_at_apex(&self, touch: Touch, view: &View<T>, lambda: T) -> AtApex<T> {
        let end = self.neighbour(touch);
        let Sight { unit, inverse, pull, .. } = self.sights[end];
        let View { position, s, along, across, skew, length: Dual([size, _, growth]), .. } = *view;
        if self.chart.touch == touch {
            // (|e| r + e . there) / |2 turn|.
            let there = minus(self.offsets[end][0], position);
            let distance = T::of(1.0) / inverse;
            let value = size * distance + dot(along, there);
            let by_s = (size * dot(unit, along) + size * size).opposite();
            let side = self.axes[1];
            let by_lambda = growth * distance - s * (size * dot(unit, side)) + dot(side, there) - s * dot(along, side);
            let by_across = by_lambda - skew * (s * by_s);
            let sign = if touch == Touch::Next { 2.0 } else { -2.0 };
            let divisor = self.turn.by(sign);
            let factor = Some(Dual([lambda, T::of(0.0), T::of(1.0)]));
            return AtApex { touch, factor, tangent: Dual([value, by_s, by_across].map(|c| c / divisor)), end };
        }
        let towards = self.sights[self.chart.corners[0] as usize].unit;
        let turning = s * cross(across, pull) - self.turn / (size * size);
        let angle = [cross(along, pull), turning];
        let (from, to, [by_s, by_across]) = match touch {
            Touch::Next => (towards, unit, angle),
            _ => (unit, towards, angle.map(T::opposite)),
        };
        let t = half_tangent(from, to);
        let rate = T::of(0.5) + (t * t).by(0.5);
        AtApex { touch, factor: None, tangent: Dual([t, rate * by_s, rate * by_across]), end }
    }
}

fn nothing<T: Number>() -> Sight<T> {
    Sight { unit: of([0.0; 2]), inverse: T::of(0.0), pull: of([0.0; 2]), slack: 0.0, left: 1.0 }
}

/// The half tangent of an edge, with its gradient in the plane.
fn tangent_of<T: Number>([from, to]: [&Sight<T>; 2], edge: &Edge<T>, motion: &Motion) -> [T; 3] {
    let swing = T::swing(from, to, edge, motion);
    let t = T::half_tangent(from, to, &swing);
    let rate = T::of(0.5) + (t * t).by(0.5);
    [t, rate * swing.pull[1], (rate * swing.pull[0]).opposite()]
}

/// An edge that ends at the apex.
#[derive(Clone, Copy)]
pub(super) struct AtApex<T> {
    /// Whether it begins there, or ends.
    pub touch: Touch,
    /// What all other edges are multiplied by, if the chart touches it.
    pub factor: Option<Dual<T>>,
    /// Its half tangent, times the factor.
    pub tangent: Dual<T>,
    /// Its other end.
    pub end: usize,
}

/// Sums over vertices, times the factor of the edge that is touched, and, with an apex, `s`.
pub(crate) struct Sums<T> {
    /// Of weights.
    pub total: Dual<T>,
    /// Of weights times residuals, and of what speeds add.
    pub numerator: [Dual<T>; 2],
}

/// Where one looks from.
pub(crate) struct View<T> {
    /// Less the apex.
    pub(super) position: Vector<T>,
    /// 1 without an apex; then the two vectors below are the axes of the plane.
    pub(super) s: T,
    /// `e`, and `q - p - skew e`.
    pub(super) along: Vector<T>,
    across: Vector<T>,
    skew: T,
    /// Of `e`.
    pub(super) length: Dual<T>,
    /// Both edges at the apex, if that is a vertex.
    at_apex: Option<[AtApex<T>; 2]>,
}

impl<T: Number> View<T> {
    /// A function of the plane by `s` and `λ`, or by the coordinates of the plane.
    pub(super) fn chain(&self, value: T, gradient: Vector<T>) -> Dual<T> {
        Dual([value, dot(self.along, gradient), self.s * dot(self.across, gradient)])
    }

    /// The edges at the apex.
    pub(super) fn edges(&self) -> impl Iterator<Item = &AtApex<T>> {
        self.at_apex.iter().flatten()
    }

    /// `s`, with an apex.
    pub(super) fn along_dual(&self) -> Dual<T> {
        Dual([self.s, T::of(1.0), (self.skew * self.s).opposite()])
    }

    /// What everything is multiplied by.
    pub(super) fn factor(&self) -> Option<Dual<T>> {
        self.edges().find_map(|edge| edge.factor)
    }

    /// The half tangent of an edge at the apex, times the factor.
    pub(super) fn tangent(&self, edge: &AtApex<T>) -> Dual<T> {
        edge.tangent.with(self.factor().filter(|_| edge.factor.is_none()))
    }

    /// What a quotient of sums adds to the images of both vectors under the derivative.
    pub fn columns(&self, rest: [Dual<T>; 2]) -> [Vector<T>; 2] {
        if self.at_apex.is_none() {
            return [1, 2].map(|k| rest.map(|c| c.0[k]));
        }
        [rest.map(|c| c.0[0] + self.s * c.0[1]), rest.map(|c| c.0[2] - self.skew * c.0[0])]
    }
}

pub(super) fn apply<T: Number>(linear: &Linear, vector: Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| vector[0].by(linear[k][0]) + vector[1].by(linear[k][1]))
}
