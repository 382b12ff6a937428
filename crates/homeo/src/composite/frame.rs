//! A mean value map in a chart, with its derivatives: in doubles and in balls by one text.

use homeo_core::planar::Point2;

use super::chart::{Chart, Step, Touch};
use super::guide::{Guide, Linear};
use super::number::{Number, Sight, half_tangent, sine_cosine};
use super::vector::{Dual, Vector, cross, dot, minus, of, opposite, plus, scaled, times};

/// A chart and all vertices as seen from its own.
pub(super) struct Frame<'a, T> {
    pub step: &'a Step,
    pub chart: &'a Chart,
    /// `p - v` and `q - p`.
    pub axes: [Vector<T>; 2],
    pub turn: T,
    /// Of each vertex: where it is, and where it goes, less where `v` is, and where it or, if it is no vertex, the
    /// first vertex goes.
    pub offsets: Vec<[Vector<T>; 2]>,
    /// Of each edge, by its first vertex: its vector, reversed and conjugated.
    edges: Vec<Vector<T>>,
    /// Of each edge: no less than its length.
    lengths: Vec<f64>,
    sights: Vec<Sight<T>>,
    /// Of each edge, by its first vertex: the half tangent and its gradient.
    tangents: Vec<[T; 3]>,
}

/// A mean value map near a point of a chart.
#[derive(Clone, Copy)]
pub(super) struct Local<T> {
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
            [x, y.opposite()]
        };
        let edges: Vec<Vector<T>> = step.points.iter().zip(&step.next).map(edge).collect();
        let lengths = edges.iter().map(|&[x, y]| T::length(x, y).most()).collect();
        let nothing = Sight { unit: of([0.0; 2]), inverse: T::of(0.0), pull: of([0.0; 2]), slack: 0.0, width: 0.0 };
        let sights = vec![nothing; offsets.len()];
        let tangents = vec![[T::of(0.0); 3]; offsets.len()];
        Self { step, chart, axes, turn: T::of_ball(chart.turn), offsets, edges, lengths, sights, tangents }
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
        let along = plus(self.axes[0], scaled(lambda, self.axes[1]));
        if self.apex(guide).is_none() {
            return self.evaluate_at(scaled(s, along), guide);
        }
        let towards = T::sight(along, along).unit;
        let length = T::length(along[0], along[1]);
        // Instead of ∂/∂λ the derivative almost across e, lest determinants be differences of large numbers.
        let skew = T::of(dot(self.axes[1], along).near() / dot(along, along).near());
        let across = minus(self.axes[1], scaled(skew, along));
        let length = Dual([length, T::of(0.0), dot(towards, self.axes[1])]);
        let view = View { position: scaled(s, along), s, along, across, skew, length };
        self.look(view.position, opposite(towards), guide);
        let mut edges = Vec::with_capacity(3);
        for touch in [Touch::Next, Touch::Previous] {
            let edge = self.edge_at_vertex(touch);
            edges.push(self.special_at_vertex(touch, &view, lambda, guide.near_edge == Some(edge)));
        }
        if let Some(edge) = guide.near_edge.filter(|&edge| !self.is_at_vertex(edge)) {
            edges.push(self.special_edge(edge, &view));
        }
        let [weight, first, second, own] = self.sums(&edges, &view, guide);
        let total = own.plus(Dual([s, T::of(1.0), (skew * s).opposite()]).times(weight));
        let rest = [first.over(total), second.over(total)];
        self.assemble(&view, rest, &guide.linear)
    }

    /// The vertex of the domain at which a box is seen along directions: the apex, if it is one and the box is near.
    pub fn apex(&self, guide: &Guide) -> Option<usize> {
        let v = self.chart.corners[0];
        (self.step.is_vertex(v) && !guide.is_off_apex).then_some(v as usize)
    }

    /// The map and its derivative at `v + position`, which is no vertex of the domain, and on no edge but the near one.
    fn evaluate_at(&mut self, position: Vector<T>, guide: &Guide) -> Local<T> {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let axes = [[one, zero], [zero, one]];
        let [along, across] = axes;
        let view = View { position, s: one, along, across, skew: zero, length: Dual([one, zero, zero]) };
        self.look(position, along, guide);
        let edges: Vec<_> = guide.near_edge.map(|edge| self.special_edge(edge, &view)).into_iter().collect();
        let [weight, first, second, _] = self.sums(&edges, &view, guide);
        let rest = [first.over(weight), second.over(weight)];
        let slope = |k: usize| -> Vector<T> { std::array::from_fn(|row| rest[row].0[k + 1]) };
        let columns: [Vector<T>; 2] = std::array::from_fn(|k| plus(apply(&guide.linear, axes[k]), slope(k)));
        let mixed = cross(apply(&guide.linear, along), slope(1))
            + cross(slope(0), apply(&guide.linear, across))
            + cross(slope(0), slope(1));
        let own = cross(of::<T>(guide.linear[0]), of(guide.linear[1]));
        let base = plus(of(self.step.base_image(self.chart)), of(guide.shift));
        let moved = plus(apply(&guide.linear, position), rest.map(|c| c.0[0]));
        Local { image: plus(base, moved), determinant: own + mixed, axes, columns, turn: one }
    }

    /// Sums of weights, and of weights times residuals, of all vertices but `v`; and the weight of `v`, times `s`. All
    /// times the factors of all special edges.
    fn sums(&self, edges: &[Special<T>], view: &View<T>, guide: &Guide) -> [Dual<T>; 4] {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let distance = guide.near_vertex.map(|vertex| {
            let [x, y] = minus(self.offsets[vertex][0], view.position);
            view.chain(T::length(x, y), opposite(self.sights[vertex].unit))
        });
        let whole = edges.iter().fold(Dual([one, zero, zero]), |all, edge| all.with(edge.factor));
        let [others, near] = self.regular_sums(guide);
        let chained = |[value, x, y]: [T; 3]| view.chain(value, [x, y]);
        let regular = |k: usize| whole.times(chained(others[k]).with(distance).plus(chained(near[k])));
        let [mut weight, mut first, mut second] = [regular(0), regular(1), regular(2)];
        let mut own = Dual([zero; 3]);
        for (number, edge) in edges.iter().enumerate() {
            let factors = edges.iter().enumerate().filter(|(other, _)| *other != number);
            let tangent = factors.fold(edge.tangent, |product, (_, other)| product.with(other.factor));
            for k in edge.ends.into_iter().flatten() {
                let Sight { inverse, pull, .. } = self.sights[k];
                let share = if guide.near_vertex == Some(k) {
                    tangent
                } else {
                    tangent.times(view.chain(inverse, scaled(inverse, pull)).with(distance))
                };
                let [x, y] = self.residual(k, guide);
                weight = weight.plus(share);
                first = first.plus(share.times_constant(x));
                second = second.plus(share.times_constant(y));
            }
            if edge.ends.iter().flatten().count() == 1 {
                own = own.plus(tangent.over(view.length).with(distance));
            }
        }
        [weight, first, second, own]
    }

    /// From `G` to the map: `f = image of v + s (M e + G)`.
    fn assemble(&self, view: &View<T>, rest: [Dual<T>; 2], linear: &Linear) -> Local<T> {
        let s = view.s;
        let value: Vector<T> = std::array::from_fn(|k| rest[k].0[0]);
        let by_s: Vector<T> = std::array::from_fn(|k| rest[k].0[0] + s * rest[k].0[1]);
        let by_across: Vector<T> = std::array::from_fn(|k| rest[k].0[2] - view.skew * rest[k].0[0]);
        let axes = [view.along, view.across];
        let [along, across] = axes.map(|axis| apply(linear, axis));
        // det(M e + g, M e' + h), where det(M e, M e') is det M times that of the axes, which is constant.
        let mixed = cross(along, by_across) + cross(by_s, across) + cross(by_s, by_across);
        let own = cross(of::<T>(linear[0]), of(linear[1]));
        let at = of::<T>(self.step.images[self.chart.corners[0] as usize]);
        Local {
            image: plus(at, scaled(s, plus(along, value))),
            determinant: own + mixed / self.turn,
            columns: [plus(along, by_s), plus(across, by_across)],
            axes,
            turn: self.turn,
        }
    }

    pub fn neighbour(&self, touch: Touch) -> usize {
        let v = self.chart.corners[0] as usize;
        (if touch == Touch::Next { self.step.next[v] } else { self.step.previous[v] }) as usize
    }

    /// The number of an edge at `v`: that of its first vertex.
    pub fn edge_at_vertex(&self, touch: Touch) -> usize {
        if touch == Touch::Next { self.chart.corners[0] as usize } else { self.neighbour(touch) }
    }

    fn is_at_vertex(&self, edge: usize) -> bool {
        let v = self.chart.corners[0] as usize;
        edge == v || self.step.next[edge] as usize == v
    }

    /// How far a vertex misses its image under the linear map.
    #[inline(always)]
    fn residual(&self, vertex: usize, guide: &Guide) -> Vector<T> {
        let [offset, image] = self.offsets[vertex];
        minus(minus(image, of(guide.shift)), apply(&guide.linear, offset))
    }

    /// Looks at all vertices and edges from `v + offset`; at `v` itself in the direction `towards`.
    fn look(&mut self, offset: Vector<T>, towards: Vector<T>, guide: &Guide) {
        let v = self.apex(guide);
        for (sight, [at, _]) in self.sights.iter_mut().zip(&self.offsets) {
            *sight = T::sight(minus(*at, offset), offset);
        }
        if let Some(v) = v {
            self.sights[v] = Sight { unit: towards, inverse: T::of(0.0), pull: of([0.0; 2]), slack: 0.0, width: 0.0 };
        }
        let (half, reach) = (T::of(0.5), T::reach(offset));
        for (i, tangent) in self.tangents.iter_mut().enumerate() {
            let k = self.step.next[i] as usize;
            // Treated by themselves; what another box left here must go.
            if v.is_some_and(|v| i == v || k == v) || guide.near_edge == Some(i) {
                *tangent = [T::of(0.0); 3];
                continue;
            }
            let (from, to) = (&self.sights[i], &self.sights[k]);
            // The difference of pulls 1 / conj(z) as a product: far edges are seen to be small.
            let turning = times(times(from.pull, to.pull), self.edges[i]);
            let t = T::half_tangent(from, to, self.lengths[i], reach);
            let rate = half + half * (t * t);
            *tangent = [t, rate * turning[1], (rate * turning[0]).opposite()];
        }
    }

    /// Sums over all other vertices, of edges that are not special only: of the weights, and of weights times residuals; each
    /// with its gradient in the plane. First those of all vertices but a near one, then those of this, times its distance.
    fn regular_sums(&self, guide: &Guide) -> [[[T; 3]; 3]; 2] {
        let v = self.apex(guide);
        let mut sums = [[[T::of(0.0); 3]; 3]; 2];
        for (i, sight) in self.sights.iter().enumerate() {
            if v == Some(i) {
                continue;
            }
            let (before, after) = (&self.tangents[self.step.previous[i] as usize], &self.tangents[i]);
            let tangent: [T; 3] = std::array::from_fn(|k| before[k] + after[k]);
            let is_near = guide.near_vertex == Some(i);
            let weight = if is_near {
                tangent
            } else {
                let [value, x, y] = tangent;
                [value, x + value * sight.pull[0], y + value * sight.pull[1]].map(|c| sight.inverse * c)
            };
            let [x, y] = self.residual(i, guide);
            let sums = &mut sums[usize::from(is_near)];
            for k in 0..3 {
                sums[0][k] = sums[0][k] + weight[k];
                sums[1][k] = sums[1][k] + weight[k] * x;
                sums[2][k] = sums[2][k] + weight[k] * y;
            }
        }
        sums
    }

    /// An edge that does not end at `v`, times the sine of its angle.
    fn special_edge(&self, edge: usize, view: &View<T>) -> Special<T> {
        let other = self.step.next[edge] as usize;
        let (from, to) = (&self.sights[edge], &self.sights[other]);
        let turning = times(times(from.pull, to.pull), self.edges[edge]);
        let [sine, cosine] = T::sine_cosine(from, to, self.lengths[edge], T::reach(view.position));
        let angle = view.chain(T::of(0.0), [turning[1], turning[0].opposite()]);
        Special::near(sine, cosine, angle, [Some(edge), Some(other)])
    }

    /// An edge that ends at `v`; if the chart touches it, times `λ`, which cancels.
    fn special_at_vertex(&self, touch: Touch, view: &View<T>, lambda: T, is_near: bool) -> Special<T> {
        let k = self.neighbour(touch);
        let ends = [Some(k), None];
        let Sight { unit, inverse, pull, .. } = self.sights[k];
        let View { position, s, along, across, skew, length: Dual([size, _, growth]) } = *view;
        if self.chart.touch == touch {
            // (|e| r + e . there) / |2 turn|.
            let there = minus(self.offsets[k][0], position);
            let distance = T::of(1.0) / inverse;
            let value = size * distance + dot(along, there);
            let by_s = (size * dot(unit, along) + size * size).opposite();
            let side = self.axes[1];
            let by_lambda = growth * distance - s * (size * dot(unit, side)) + dot(side, there) - s * dot(along, side);
            let by_across = by_lambda - skew * (s * by_s);
            let sign = if touch == Touch::Next { 2.0 } else { -2.0 };
            let divisor = T::of(sign) * self.turn;
            let factor = Some(Dual([lambda, T::of(0.0), T::of(1.0)]));
            return Special { factor, tangent: Dual([value, by_s, by_across].map(|c| c / divisor)), ends };
        }
        let towards = self.sights[self.chart.corners[0] as usize].unit;
        let turning = s * cross(across, pull) - self.turn / (size * size);
        let angle = Dual([T::of(0.0), cross(along, pull), turning]);
        let (from, to, angle) = match touch {
            Touch::Next => (towards, unit, angle),
            _ => (unit, towards, Dual(angle.0.map(T::opposite))),
        };
        if is_near {
            let [sine, cosine] = sine_cosine(from, to);
            return Special::near(sine, cosine, angle, ends);
        }
        let t = half_tangent(from, to);
        let rate = T::of(0.5) + T::of(0.5) * (t * t);
        Special { factor: None, tangent: Dual([t, rate * angle.0[1], rate * angle.0[2]]), ends }
    }
}

/// An edge that is treated by itself: its half tangent times a factor that makes it smooth.
struct Special<T> {
    /// What all other edges are multiplied by; `None` for one.
    factor: Option<Dual<T>>,
    /// The half tangent times the factor.
    tangent: Dual<T>,
    /// Its ends but `v`.
    ends: [Option<usize>; 2],
}

impl<T: Number> Special<T> {
    /// With the sine as factor: `sin α tan(α / 2) = 1 - cos α`.
    fn near(sine: T, cosine: T, Dual([_, by_s, by_lambda]): Dual<T>, ends: [Option<usize>; 2]) -> Self {
        let factor = Some(Dual([sine, cosine * by_s, cosine * by_lambda]));
        Self { factor, tangent: Dual([T::of(1.0) - cosine, sine * by_s, sine * by_lambda]), ends }
    }
}

/// Where one looks from.
struct View<T> {
    /// Less the apex.
    position: Vector<T>,
    s: T,
    /// `e`, and `q - p - skew e`.
    along: Vector<T>,
    across: Vector<T>,
    skew: T,
    /// Of `e`.
    length: Dual<T>,
}

impl<T: Number> View<T> {
    /// A function of the plane by `s` and `λ`.
    fn chain(&self, value: T, gradient: Vector<T>) -> Dual<T> {
        Dual([value, dot(self.along, gradient), self.s * dot(self.across, gradient)])
    }
}

fn apply<T: Number>(linear: &Linear, vector: Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| T::of(linear[k][0]) * vector[0] + T::of(linear[k][1]) * vector[1])
}
