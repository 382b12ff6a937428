//! The Jacobian determinant of a mean value map between cages, enclosed in cells of charts.
//!
//! Formulas (1) to (6) of `docs/theory/cages.md`. What belongs to an edge or a face that the chart ends at is divided by the
//! power of `r` and `s` that it vanishes with, its level; all fields are such quotients.

use super::arctangent::{arctangent, quotient};
use super::chart::{Cell, Chart, Level, Place, main_axis};
use super::jet::{
    Form, Jet, Vector, across, along, cross, determinant, difference, dot, length, minus, plus, three, times,
};
use super::outline::{Edge, Face, Outline};

/// What a distance from a plane is of that from an edge, at most, where the difference quotient is taken.
const LOW: f64 = 0.4;

/// An affine map near the mean value map, by doubles: what it misses of the images is little.
#[derive(Clone, Copy)]
pub(super) struct Fit {
    pub matrix: [[f64; 3]; 3],
    /// Zero at a vertex, which goes to its image.
    pub shift: [f64; 3],
}

impl Fit {
    pub const IDENTITY: Fit = Fit { matrix: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], shift: [0.0; 3] };
}

/// What is known of a cell.
pub(super) struct Enclosure {
    pub determinant: Form,
    /// The affine map at the middle.
    pub fit: Fit,
}

/// A vertex as seen from a cell.
#[derive(Clone, Copy)]
struct Seen {
    /// The vector to it, divided by `r` if it is the vertex of the chart.
    to: Vector<Jet>,
    far: Jet,
}

/// An edge as seen from a cell.
#[derive(Clone, Copy)]
struct Sight {
    /// Both ends; the vertex of the chart first.
    ends: [Seen; 2],
    /// Whether the angle is obtuse.
    is_wide: bool,
    /// The angle over the distance from its line.
    angle: Jet,
}

/// A face as seen from a cell.
#[derive(Clone, Copy)]
struct View {
    /// From the plane, towards the inside of the cage.
    height: Jet,
    /// From its edges in the plane, towards its inside.
    inside: [Jet; 3],
}

/// How the quotient of solid moment and height is found.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// By dividing.
    Divide,
    /// By a difference quotient: the plane is crossed outside of the face.
    Cross,
    /// Not at all: everything is multiplied by the height.
    Multiply,
}

/// A chart with what is computed once for all its cells.
pub(super) struct Frame<'a> {
    outline: &'a Outline<'a>,
    pub chart: Chart,
    /// Of each vertex: its place and its image, less those of the vertex of the chart.
    offsets: Vec<[Vector<Form>; 2]>,
    edge_levels: Vec<Level>,
    /// Of faces.
    levels: Vec<Level>,
}

impl<'a> Frame<'a> {
    pub fn new(outline: &'a Outline<'a>, chart: Chart) -> Frame<'a> {
        let origin = chart.origin(outline);
        let image = chart.vertex().map_or([0.0; 3], |v| outline.images[v as usize]);
        let offset = |(&p, &q): (&[f64; 3], &[f64; 3])| [difference(p, origin), difference(q, image)];
        let offsets = outline.points.iter().zip(outline.images).map(offset).collect();
        let edge_levels: Vec<Level> =
            (0..outline.edges.len() as u32).map(|edge| chart.edge_level(outline, edge)).collect();
        let level = |face: &Face| face.edges.iter().map(|&edge| edge_levels[edge as usize]).max().unwrap_or(0);
        let levels = outline.faces.iter().map(level).collect();
        Frame { outline, chart, offsets, edge_levels, levels }
    }

    /// Whether no face meets a cell. If the answer is no, one still may not.
    pub fn is_clear(&self, cell: &Cell) -> bool {
        let place = self.chart.place(self.outline, cell);
        (0..self.levels.len()).all(|face| self.view(&place, face).misses())
    }

    /// Encloses the determinant; none if too much of the cage is near.
    pub fn enclose(&self, cell: &Cell, fit: &Fit) -> Option<Enclosure> {
        let place = self.chart.place(self.outline, cell);
        let views: Vec<View> = (0..self.levels.len()).map(|face| self.view(&place, face)).collect();
        let ways = self.ways(&place, &views)?;
        let matrix = self.matrix(fit);
        let seen: Vec<Seen> = (0..self.offsets.len() as u32).map(|vertex| self.seen(&place, vertex)).collect();
        let sights: Vec<Sight> = (0..self.edge_levels.len()).map(|edge| self.sight(&place, &seen, edge)).collect();
        let (mut total, mut weights) = (Jet::ZERO, vec![Jet::ZERO; self.offsets.len()]);
        let near = ways.iter().position(|&way| way == Way::Multiply);
        for face in (0..ways.len()).filter(|&face| Some(face) != near) {
            total = total + self.add(&place, &sights, face, views[face], ways[face], &mut weights);
        }
        if let Some(face) = near {
            let height = views[face].height;
            weights.iter_mut().for_each(|weight| *weight = height * *weight);
            total = height * total + self.add(&place, &sights, face, views[face], Way::Multiply, &mut weights);
        }
        let mut rest = [Jet::ZERO; 3];
        for (weight, offset) in weights.iter().zip(&self.offsets) {
            let missed = residual(offset, &matrix, fit.shift);
            rest = three(|k| rest[k] + weight.scaled(missed[k]));
        }
        let inverse = total.inverse();
        let rest = rest.map(|x| x * inverse);
        let (determinant, fit) = self.conclude(&place, &matrix, fit.shift, rest);
        Some(Enclosure { determinant, fit })
    }

    /// The matrix of an affine map near the given one; at an edge one that takes it to its image.
    fn matrix(&self, fit: &Fit) -> [Vector<Form>; 3] {
        let mut matrix = fit.matrix.map(|row| row.map(Form::exact));
        if let (Some(vertex), Some(edge)) = (self.chart.vertex(), self.chart.edge()) {
            let [a, b] = self.outline.edges[edge as usize].ends;
            let [from, to] = self.offsets[if vertex == a { b } else { a } as usize];
            let (axis, _) = main_axis(from.map(|x| x.middle));
            let inverse = from[axis].inverse();
            for (row, to) in matrix.iter_mut().zip(to) {
                row[axis] = row[axis] + (to - dot(*row, from)) * inverse;
            }
        }
        matrix
    }

    /// Times what vanishes at the greater level, over what vanishes at the lower one.
    fn lowered(&self, place: &Place, x: Jet, [greater, lower]: [Level; 2]) -> Jet {
        match (greater, lower) {
            (1, 0) => place.r * x,
            (2, 0) => place.r * (place.s * x),
            (2, 1) => place.s * x,
            _ => x,
        }
    }

    fn view(&self, place: &Place, face: usize) -> View {
        let it = &self.outline.faces[face];
        let from = |corner: u32| minus(place.position, self.offsets[corner as usize][0].map(Jet::constant));
        let distance = |level: Level, corner: u32, unit: Vector<Form>| match level {
            0 => along(from(corner), unit),
            1 => along(place.y, unit),
            _ => along(place.z, unit),
        };
        let inside = |k: usize| distance(self.edge_levels[it.edges[k] as usize], it.corners[(k + 1) % 3], it.inward[k]);
        View { height: distance(self.levels[face], it.corners[0], it.normal), inside: [0, 1, 2].map(inside) }
    }

    /// How each face is looked at: the nearest plane that may be met inside of its face is multiplied by. None if several are near.
    fn ways(&self, place: &Place, views: &[View]) -> Option<Vec<Way>> {
        let (mut ways, mut nearest, mut is_decided) = (Vec::with_capacity(views.len()), None, true);
        for (face, view) in views.iter().enumerate() {
            let crosses = (0..3).any(|k| {
                let inside = view.inside[k].value;
                let level = self.edge_levels[self.outline.faces[face].edges[k] as usize];
                let height = self.lowered(place, view.height, [self.levels[face], level]).value.middle;
                inside.is_negative() && height.abs() < LOW * inside.middle.abs()
            });
            ways.push(if crosses { Way::Cross } else { Way::Divide });
            if crosses {
                continue;
            }
            let height = view.height.value;
            let share = height.middle.abs() / height.deviation();
            is_decided &= share > 1.0 || nearest.is_none_or(|(other, _)| other > 1.0);
            if nearest.is_none_or(|(other, _)| share < other) {
                nearest = Some((share, face));
            }
        }
        if let Some((_, face)) = nearest {
            ways[face] = Way::Multiply;
        }
        is_decided.then_some(ways)
    }

    fn seen(&self, place: &Place, vertex: u32) -> Seen {
        if self.chart.vertex() == Some(vertex) {
            return Seen::new(place.y.map(|x| -x));
        }
        let [offset, _] = self.offsets[vertex as usize];
        Seen::new(minus(offset.map(Jet::constant), place.position))
    }

    /// Formula (2): an edge.
    fn sight(&self, place: &Place, seen: &[Seen], edge: usize) -> Sight {
        let it = &self.outline.edges[edge];
        let level = self.edge_levels[edge];
        let ends = self.ends(it).map(|v| seen[v as usize]);
        let is_wide = level == 2 || dot(ends[0].to, ends[1].to).value.middle < 0.0;
        let mut sight = Sight { ends, is_wide, angle: Jet::ZERO };
        let across = across(if level == 2 { place.z } else { ends[0].to }, it.along);
        let square = (across[0].square() + across[1].square() + across[2].square()).scaled(it.by_square);
        let kappa = sight.kappa(it.length);
        let kappa = if level == 2 { place.s * kappa } else { kappa };
        let part = (kappa * arctangent(kappa.square() * square)).doubled();
        sight.angle = if is_wide { length(across).inverse().scaled(it.length * pi()) - part } else { part };
        sight
    }

    /// Both ends; the vertex of the chart first.
    fn ends(&self, edge: &Edge) -> [u32; 2] {
        let [a, b] = edge.ends;
        if self.chart.vertex() == Some(b) { [b, a] } else { [a, b] }
    }

    /// Formulas (1), (3) and (4): the weights of a face are added; its share of the total is returned.
    fn add(&self, place: &Place, sights: &[Sight], face: usize, view: View, way: Way, weights: &mut [Jet]) -> Jet {
        let (it, level) = (&self.outline.faces[face], self.levels[face]);
        let angles = three(|k| sights[it.edges[k] as usize].angle);
        let over_height = match way {
            Way::Divide => dot(view.inside, angles).halved().over(view.height),
            Way::Multiply => dot(view.inside, angles).halved(),
            Way::Cross => view.height * self.crossing(place, sights, face, view),
        };
        let height = if way == Way::Multiply { view.height.square() } else { view.height }.halved();
        let turned = three(|k| self.lowered(place, angles[k], [level, self.edge_levels[it.edges[k] as usize]]));
        for k in (0..3).filter(|&k| self.edge_levels[it.edges[k] as usize] == level) {
            let products = it.products[k];
            let sum = turned[0].scaled(products[0]) + turned[1].scaled(products[1]) + turned[2].scaled(products[2]);
            let weight = (view.inside[k] * over_height + height * sum).scaled(it.by_height[k]);
            weights[it.corners[k] as usize] = weights[it.corners[k] as usize] + weight;
        }
        self.lowered(place, over_height, [self.top(), level])
    }

    /// The level of the chart.
    fn top(&self) -> Level {
        match self.chart {
            Chart::Open => 0,
            Chart::Vertex { .. } => 1,
            Chart::Edge { .. } => 2,
        }
    }

    /// Formula (5): the moment over the square of the height, where the foot of the height is outside of the face.
    fn crossing(&self, place: &Place, sights: &[Sight], face: usize, view: View) -> Jet {
        let it = &self.outline.faces[face];
        let slope = |k: usize| {
            let edge = it.edges[k] as usize;
            let levels = [self.levels[face], self.edge_levels[edge]];
            let height = self.lowered(place, view.height, levels);
            let slope = self.slope(place, &sights[edge], edge, view.inside[k], height, it.normal);
            self.lowered(place, self.lowered(place, slope, levels), levels)
        };
        dot(view.inside, [0, 1, 2].map(slope)).halved()
    }

    /// The quotient of the difference of `sight.angle` from its value at the foot of the height, and the square of the height.
    fn slope(&self, place: &Place, sight: &Sight, edge: usize, inside: Jet, height: Jet, normal: Vector<Form>) -> Jet {
        let scale = if self.edge_levels[edge] == 2 { place.s } else { Jet::ONE };
        let part = scale * scale.square() * self.part_slope(place, sight, edge, scale * inside, scale * height, normal);
        if !sight.is_wide {
            return part;
        }
        let size = if inside.value.middle < 0.0 { -inside } else { inside };
        // Both are across the edge; so this is the distance from it.
        let far = length([inside, height, Jet::ZERO]);
        -(far * size * (far + size)).inverse().scaled(pi()) - part
    }

    /// The same for the part of the angle that is an arctangent.
    fn part_slope(
        &self,
        place: &Place,
        sight: &Sight,
        edge: usize,
        inside: Jet,
        height: Jet,
        normal: Vector<Form>,
    ) -> Jet {
        let length_of_edge = self.outline.edges[edge].length;
        let kappa = sight.kappa(length_of_edge);
        let ratio = if self.edge_levels[edge] == 0 { Jet::ONE } else { place.r };
        let foot = self.at_foot(sight, height, ratio, normal);
        let other = foot.kappa(length_of_edge);
        let squares = [height, foot.ends[0].far, foot.ends[1].far, ratio].map(Jet::square);
        let sum = squares[2] + squares[3] * (squares[1] + squares[0]);
        let by = sum.over(sight.product() + foot.product());
        let by = if sight.is_wide { by - ratio } else { by + ratio };
        let turn = -(kappa * other * by).scaled(length_of_edge.inverse());
        let square = inside.square();
        let rise = kappa.square() + turn * (kappa + other) * square;
        let at = kappa.square() * (square + squares[0]);
        let at_foot = other.square() * square;
        (turn * arctangent(at) + other * rise * quotient(at, at_foot)).doubled()
    }

    /// The same edge from the foot of a height, which is that of the first end; of the second it is `ratio` times as much.
    fn at_foot(&self, sight: &Sight, height: Jet, ratio: Jet, normal: Vector<Form>) -> Sight {
        let step = normal.map(|x| height.scaled(x));
        let [first, second] = sight.ends.map(|end| end.to);
        let ends = [Seen::new(plus(first, step)), Seen::new(plus(second, times(ratio, step)))];
        Sight { ends, ..*sight }
    }

    /// Formula (6): the determinant, and the affine map at the middle of the cell.
    fn conclude(&self, place: &Place, matrix: &[Vector<Form>; 3], shift: [f64; 3], rest: Vector<Jet>) -> (Form, Fit) {
        let image = |v: Vector<Form>| three(|k| dot(matrix[k], v));
        let [r, s] = [place.r.value, place.s.value];
        let values = rest.map(|x| x.value);
        let slope = |axis: usize| rest.map(|x| x.slopes[axis]);
        let added = match self.top() {
            0 => [0, 1, 2].map(slope),
            1 => [plus(values, times(r, slope(0))), slope(1), slope(2)],
            _ => [times(s, plus(values, times(r, slope(0)))), plus(values, times(s, slope(1))), slope(2)],
        };
        let columns = three(|k| plus(image(place.columns[k]), added[k]));
        let turn = determinant(place.columns);
        let result = determinant(columns) * turn.inverse();
        let scale = [Form::ONE, r, r * s][self.top()].middle;
        let missed = values.map(|x| scale * x.middle);
        let fit = fit(place, columns.map(|c| c.map(|x| x.middle)), missed, (matrix, shift), self.top() == 0);
        (result, fit)
    }
}

/// The affine map with the value and the derivative at the middle of a cell; without a shift at vertices.
fn fit(
    place: &Place,
    columns: [[f64; 3]; 3],
    missed: [f64; 3],
    (matrix, shift): (&[Vector<Form>; 3], [f64; 3]),
    is_open: bool,
) -> Fit {
    let own = place.columns.map(|c| c.map(|x| x.middle));
    let rows = [cross(own[1], own[2]), cross(own[2], own[0]), cross(own[0], own[1])];
    let size = dot(own[0], rows[0]);
    let derivative: [[f64; 3]; 3] = [0, 1, 2]
        .map(|row| [0, 1, 2].map(|column| (0..3).map(|k| columns[k][row] * rows[k][column]).sum::<f64>() / size));
    let at = place.position.map(|x| x.value.middle);
    let moved = three(|k| {
        let before = dot(matrix[k].map(|x| x.middle), at);
        if is_open { shift[k] + missed[k] + before - dot(derivative[k], at) } else { 0.0 }
    });
    let is_finite = derivative.iter().flatten().chain(&moved).all(|x| x.is_finite());
    if is_finite { Fit { matrix: derivative, shift: moved } } else { Fit::IDENTITY }
}

impl View {
    /// Whether the face is missed by all points of the cell but those where the chart ends.
    fn misses(&self) -> bool {
        let height = self.height.value;
        height.is_positive() || height.is_negative() || self.inside.iter().any(|x| x.value.is_negative())
    }
}

impl Seen {
    fn new(to: Vector<Jet>) -> Seen {
        Seen { to, far: length(to) }
    }
}

impl Sight {
    /// Of the distances of both ends.
    fn product(&self) -> Jet {
        self.ends[0].far * self.ends[1].far
    }

    /// The tangent of half the angle over the distance from the line; the cotangent if the angle is obtuse.
    fn kappa(&self, length_of_edge: Form) -> Jet {
        let cosine = dot(self.ends[0].to, self.ends[1].to);
        (if self.is_wide { self.product() - cosine } else { self.product() + cosine }).inverse().scaled(length_of_edge)
    }
}

/// How far a vertex misses its image under an affine map.
fn residual(offset: &[Vector<Form>; 2], matrix: &[Vector<Form>; 3], shift: [f64; 3]) -> Vector<Form> {
    let [from, to] = offset;
    three(|k| to[k] - Form::exact(shift[k]) - dot(matrix[k], *from))
}

fn pi() -> Form {
    Form::exact(std::f64::consts::PI).widened(1e-15)
}
