//! The Jacobian determinant of a mean value map, enclosed in boxes of charts up to edges and vertices.
//!
//! Formulas (0) to (4) of `docs/theory/composite.md`, in affine forms, differentiated forwards. A triangle of the tiling is cut
//! into charts `v + s (e0 + λ e1)`, `0 <= s, λ <= 1`, that hold no vertex of the domain but perhaps `v`, and touch no
//! edge but perhaps one along `λ = 0`. What is singular there cancels by hand:
//!
//! * every edge's half tangent is a quotient of `r r' + a . b`, or of `r r' - a . b`, and `a x b`; in an edge at `v` a factor
//!   `s` cancels;
//! * if the chart touches an edge, its half tangent times `λ` is finite, and everything is multiplied by `λ`.
//!
//! Complex maps add a sum over edges to the numerator: `speeds`.
//!
//! `M` is any matrix: the nearer it is to the derivative, the narrower the enclosure. So it is found in doubles.

mod fit;
mod speeds;

pub(crate) use speeds::{MOST_DEGREE, Speeds};

use crate::affine::{Dual, Form, Vector, cross, dot, length, vector};
use fit::Fit;
use speeds::Line;

type Point2 = [f64; 2];

/// A mean value map of a domain, or a complex map.
pub(crate) struct Step<'a> {
    /// Vertices of the domain, ring after ring.
    pub(crate) points: &'a [Point2],
    /// Where they go.
    pub(crate) images: &'a [Point2],
    /// Corners of triangles that are no vertices, numbered after these.
    pub(crate) added: &'a [Point2],
    /// The next vertex of the same ring.
    pub(crate) next: &'a [u32],
    pub(crate) previous: &'a [u32],
    /// Of a complex map whose speeds are not linear.
    pub(crate) speeds: Option<&'a Speeds>,
}

/// Which end of the edge that a chart touches the apex is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Touch {
    Nothing,
    Begin,
    End,
}

/// Part of a triangle of the tiling: the points `v + s (e0 + λ e1)`.
pub(crate) struct Chart {
    apex: u32,
    axes: [Vector; 2],
    touch: Touch,
}

impl Chart {
    pub(crate) fn apex(&self) -> u32 {
        self.apex
    }

    /// Where a point of it is, rounded.
    pub(crate) fn place(&self, apex: Point2, [s, lambda]: [f64; 2]) -> Point2 {
        let [e0, e1] = self.axes.map(|axis| axis.map(|x| x.middle));
        [0, 1].map(|k| apex[k] + s * (e0[k] + lambda * e1[k]))
    }
}

impl Step<'_> {
    pub(crate) fn corner(&self, number: u32) -> Point2 {
        let number = number as usize;
        self.points.get(number).copied().unwrap_or_else(|| self.added[number - self.points.len()])
    }

    fn is_vertex(&self, corner: u32) -> bool {
        (corner as usize) < self.points.len()
    }

    /// The charts of a triangle: with several vertices of the domain it is cut in the middle of the sides between them.
    pub(crate) fn charts(&self, triangle: [u32; 3]) -> Vec<Chart> {
        let [a, b, c] = triangle;
        let turned = [[a, b, c], [b, c, a], [c, a, b]];
        let find = |wanted: [bool; 3]| turned.into_iter().find(|t| t.map(|corner| self.is_vertex(corner)) == wanted);
        let fractions = |whole: f64, part: f64| Form::exact(whole) * Form::exact(part).inverse();
        let (one, half) = (Form::ONE, Form::exact(0.5));
        // Multiples of the sides from the apex: `e0 = f0 side`, `e1 = f1 side + f2 other`.
        let whole = [one, -one, one];
        let half_of = [half, -half, one];
        let sixth = [half, fractions(-1.0, 6.0), fractions(1.0, 3.0)];
        let both = |[v, from, to]: [u32; 3], parts: [Form; 3], back: [u32; 3]| {
            [self.chart([v, from, to], parts), self.chart(back, parts)]
        };
        if let Some(corners) = find([false; 3]).or_else(|| find([true, false, false])) {
            return vec![self.chart(corners, whole)];
        }
        if let Some([v, from, to]) = find([true, true, false]) {
            return both([v, from, to], half_of, [from, v, to]).into();
        }
        turned.into_iter().flat_map(|[v, from, to]| both([v, from, to], sixth, [v, to, from])).collect()
    }

    fn chart(&self, [v, from, to]: [u32; 3], [f0, f1, f2]: [Form; 3]) -> Chart {
        let [at, from_at, to_at] = [v, from, to].map(|corner| self.corner(corner));
        let side = difference(from_at, at);
        let other = difference(to_at, at);
        let axes = [side.map(|x| f0 * x), vector(|k| f1 * side[k] + f2 * other[k])];
        let is_edge = |a: u32, b: u32| self.is_vertex(a) && self.next[a as usize] == b;
        let touch = match (is_edge(v, from), is_edge(from, v)) {
            (true, _) => Touch::Begin,
            (_, true) => Touch::End,
            _ => Touch::Nothing,
        };
        Chart { apex: v, axes, touch }
    }
}

fn difference(a: Point2, b: Point2) -> Vector {
    vector(|k| Form::exact(a[k]) - Form::exact(b[k]))
}

/// A vertex as seen from a point of the domain.
#[derive(Clone, Copy)]
struct Seen {
    /// The vector to it.
    towards: Vector,
    distance: Dual,
    inverse: Dual,
}

/// A chart with what is computed once for all its boxes.
pub(crate) struct Frame<'a> {
    step: &'a Step<'a>,
    chart: &'a Chart,
    /// Whether the apex is a vertex of the domain.
    is_at_vertex: bool,
    /// Of each vertex: its place and its image, less those of the apex, or of the first vertex if the apex is none.
    offsets: Vec<[Vector; 2]>,
    /// Of each vertex: the vector to the next one.
    edges: Vec<Vector>,
    seen: Vec<Seen>,
    /// Of the edge from each vertex.
    tangents: Vec<Dual>,
    /// The same edges with their images, and where the point is along each; empty without speeds.
    lines: Vec<Line>,
    places: Vec<Dual>,
}

/// What is known in a box of a chart.
pub(crate) struct Enclosure {
    pub(crate) determinant: Form,
    /// Whether `λ` should be halved, or else `s`.
    pub(crate) splits_lambda: bool,
}

impl<'a> Frame<'a> {
    pub(crate) fn new(step: &'a Step<'a>, chart: &'a Chart) -> Frame<'a> {
        let is_at_vertex = step.is_vertex(chart.apex);
        let apex = step.corner(chart.apex);
        let image = step.images[if is_at_vertex { chart.apex as usize } else { 0 }];
        let offset = |(&p, &q): (&Point2, &Point2)| [difference(p, apex), difference(q, image)];
        let offsets: Vec<_> = step.points.iter().zip(step.images).map(offset).collect();
        let edge = |(&p, &next): (&Point2, &u32)| difference(step.points[next as usize], p);
        let edges = step.points.iter().zip(step.next).map(edge).collect();
        let nothing = Seen { towards: [Form::ZERO; 2], distance: Dual::ZERO, inverse: Dual::ZERO };
        let (seen, tangents) = (vec![nothing; offsets.len()], vec![Dual::ZERO; offsets.len()]);
        let line = |(i, &j): (usize, &u32)| {
            let ends = |points: &[Point2]| [points[i], points[j as usize]];
            Line::new(ends(step.points), ends(step.images))
        };
        let lines: Vec<Line> = step.speeds.map_or(vec![], |_| step.next.iter().enumerate().map(line).collect());
        let places = vec![Dual::ZERO; lines.len()];
        Frame { step, chart, is_at_vertex, offsets, edges, seen, tangents, lines, places }
    }

    /// Encloses the determinant over a box of `s` and `λ`.
    pub(crate) fn enclose(&mut self, s: [f64; 2], lambda: [f64; 2]) -> Enclosure {
        let [form_s, form_lambda] = [Form::between(s, 0), Form::between(lambda, 1)];
        let [e0, e1] = self.chart.axes;
        let along = vector(|k| e0[k] + form_lambda * e1[k]);
        let middle = [0, 1].map(|k| form_s.middle * along[k].middle);
        let (fit, nearest) = self.fit(middle);
        let determinant = match self.is_at_vertex {
            true => self.at_vertex(form_s, form_lambda, along, fit),
            false => self.inside(vector(|k| form_s * along[k]), fit),
        };
        let size = |v: Vector| v[0].middle.hypot(v[1].middle);
        let width = size(e1) * (lambda[1] - lambda[0]);
        let turned = if self.is_at_vertex { width / size(along) } else { 0.0 };
        let splits_lambda = (s[1] * width / nearest).max(turned) > size(along) * (s[1] - s[0]) / nearest;
        Enclosure { determinant, splits_lambda }
    }

    /// Formula (0), at `v + position`.
    fn inside(&mut self, position: Vector, fit: Fit) -> Form {
        let motion = [[Form::ONE, Form::ZERO], [Form::ZERO, Form::ONE]];
        self.look(position, motion, None);
        let [weight, x, y] = self.sums(None, fit);
        let rest = [x.over(weight), y.over(weight)];
        let column = |k: usize| vector(|row| Form::exact(fit.matrix[row][k]) + rest[row].0[k + 1]);
        cross(column(0), column(1))
    }

    /// Formula (4), at `v + s along`. In the place of `∂/∂λ` stands `∂/∂λ - c s ∂/∂s`, which goes almost across.
    fn at_vertex(&mut self, s: Form, lambda: Form, along: Vector, fit: Fit) -> Form {
        let [e0, e1] = self.chart.axes;
        let turn = cross(e0, e1);
        let skew = Form::exact(dot(e1, along).middle / dot(along, along).middle);
        let across = vector(|k| e1[k] - skew * along[k]);
        let motion = [along, across.map(|x| s * x)];
        let apex = self.chart.apex as usize;
        self.look(vector(|k| s * along[k]), motion, Some(apex));
        // `e` itself only depends on `λ`.
        let size = length(along);
        let length = Dual([size, Form::ZERO, dot(along, e1) * size.inverse()]);
        let by_length = Dual::constant(Form::ONE).over(length);
        let s_dual = Dual([s, Form::ONE, -(skew * s)]);
        let kappa = Dual([lambda, Form::ZERO, Form::ONE]);
        let (mut own, mut touched) = (Dual::ZERO, None);
        // By edges at the apex; by the one that is touched, times `λ`.
        let (mut added, mut added_touched) = ([Dual::ZERO; 2], [Dual::ZERO; 2]);
        for (touch, other, edge) in [
            (Touch::Begin, self.step.next[apex], apex),
            (Touch::End, self.step.previous[apex], self.step.previous[apex] as usize),
        ] {
            let is_touched = touch == self.chart.touch;
            let tangent = self.tangent_at_vertex(other as usize, touch, along, length, motion);
            let factor = if is_touched { kappa } else { Dual::constant(Form::ONE) };
            let more = self.added_at_apex([edge, other as usize], touch, along, [tangent, by_length, s_dual, factor]);
            if is_touched {
                touched = Some((tangent, other as usize));
                added_touched = more;
                self.tangents[edge] = Dual::ZERO;
            } else {
                self.tangents[edge] = tangent;
                own = own + tangent * by_length;
                added = [added[0] + more[0], added[1] + more[1]];
            }
        }
        let [weight, mut x, mut y] = self.sums(Some(apex), fit);
        [x, y] = [x + added[0], y + added[1]];
        let mut total = own + s_dual * weight;
        if let Some((tangent, other)) = touched {
            let inverse = self.seen[other].inverse;
            total = kappa * total + tangent * (by_length + s_dual * inverse);
            let residual = self.residual(other, fit);
            let share = tangent * inverse;
            x = kappa * x + share.scaled(residual[0]) + added_touched[0];
            y = kappa * y + share.scaled(residual[1]) + added_touched[1];
        }
        let rest = [x.over(total), y.over(total)];
        let g = vector(|k| rest[k].0[0] + s * rest[k].0[1]);
        let h = vector(|k| rest[k].0[2] - skew * rest[k].0[0]);
        let mixed = cross(fit.apply(along), h) + cross(g, fit.apply(across)) + cross(g, h);
        let [row, other] = fit.matrix.map(|row| row.map(Form::exact));
        cross(row, other) + mixed * turn.inverse()
    }

    /// Looks at all vertices from `v + position`, which moves by `motion`, but at the apex if it is a vertex; and at all edges
    /// but those at the apex.
    fn look(&mut self, position: Vector, motion: [Vector; 2], apex: Option<usize>) {
        for (i, [offset, _]) in self.offsets.iter().enumerate() {
            if apex == Some(i) {
                continue;
            }
            let towards = vector(|k| offset[k] - position[k]);
            let distance = length(towards);
            let inverse = distance.inverse();
            let [first, second] = motion.map(|moved| -(dot(towards, moved) * inverse));
            let square = -(inverse * inverse);
            self.seen[i] = Seen {
                towards,
                distance: Dual([distance, first, second]),
                inverse: Dual([inverse, first * square, second * square]),
            };
        }
        for (i, &next) in self.step.next.iter().enumerate() {
            let j = next as usize;
            if apex.is_none_or(|v| v != i && v != j) {
                self.tangents[i] = self.tangent(i, j, motion);
                if let Some(line) = self.lines.get(i) {
                    self.places[i] = line.place(&self.seen[i], motion);
                }
            }
        }
    }

    /// The half tangent of an edge that does not end at the apex.
    fn tangent(&self, i: usize, j: usize, motion: [Vector; 2]) -> Dual {
        let (a, b, edge) = (&self.seen[i], &self.seen[j], self.edges[i]);
        // a x b = a x edge; both `a` and `b` move against the point.
        let [first, second] = motion.map(|moved| cross(edge, moved));
        let sine = Dual([cross(a.towards, edge), first, second]);
        let sum = vector(|k| a.towards[k] + b.towards[k]);
        let [first, second] = motion.map(|moved| -dot(sum, moved));
        let cosine = Dual([dot(a.towards, b.towards), first, second]);
        half_tangent(sine, cosine, a.distance * b.distance)
    }

    /// That of an edge between the apex and another vertex, times `λ` if the chart touches it.
    fn tangent_at_vertex(&self, other: usize, touch: Touch, along: Vector, length: Dual, motion: [Vector; 2]) -> Dual {
        let [e0, e1] = self.chart.axes;
        let seen = &self.seen[other];
        let offset = self.offsets[other][0];
        let sign = |x: Form| if touch == Touch::Begin { x } else { -x };
        // The vector to the apex is `-s e`: what follows is divided by `s`, and `e x (vector to the other end)` is constant.
        let cosine =
            Dual([-dot(along, seen.towards), dot(along, motion[0]), dot(along, motion[1]) - dot(e1, seen.towards)]);
        let product = length * seen.distance;
        if touch == self.chart.touch {
            return (product - cosine).scaled((sign(cross(e0, e1)) * Form::exact(2.0)).inverse());
        }
        let sine = Dual([sign(cross(offset, along)), Form::ZERO, sign(cross(offset, e1))]);
        half_tangent(sine, cosine, product)
    }

    /// How far a vertex misses its image under the affine map.
    fn residual(&self, vertex: usize, fit: Fit) -> Vector {
        let [p, q] = self.offsets[vertex];
        let there = fit.apply(p);
        vector(|k| q[k] - Form::exact(fit.shift[k]) - there[k])
    }

    /// The sums of weights, and of weights times residuals, of all vertices but the apex; with what speeds add.
    fn sums(&self, apex: Option<usize>, fit: Fit) -> [Dual; 3] {
        let mut sums = [Dual::ZERO; 3];
        for i in (0..self.offsets.len()).filter(|&i| apex != Some(i)) {
            let before = self.step.previous[i] as usize;
            let weight = (self.tangents[before] + self.tangents[i]) * self.seen[i].inverse;
            let residual = self.residual(i, fit);
            sums[0] = sums[0] + weight;
            sums[1] = sums[1] + weight.scaled(residual[0]);
            sums[2] = sums[2] + weight.scaled(residual[1]);
        }
        let added = self.added_by_edges(apex);
        [sums[0], sums[1] + added[0], sums[2] + added[1]]
    }
}

/// `tan(α / 2)` by sine and cosine of `α`, both multiplied by the same positive number: of two equal formulas that whose divisor is
/// not small.
fn half_tangent(sine: Dual, cosine: Dual, one: Dual) -> Dual {
    match cosine.0[0].middle < 0.0 {
        true => (one - cosine).over(sine),
        false => sine.over(one + cosine),
    }
}
