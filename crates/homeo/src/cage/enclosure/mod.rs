//! Mean value maps between cages, enclosed in affine forms on small cubes.
//!
//! Formulas (1), (2), (3) and (5) of `docs/theory/cages.md`: weights of triangles by sights of their edges; the nearest face is
//! multiplied by; where the plane of a face is crossed outside of it there is a difference quotient.

mod arctangent;
mod form;

use std::collections::BTreeMap;

use arctangent::{arctangent, quotient};
pub(super) use form::Form;
use form::{cross, dot, minus, times};

type Point3 = [f64; 3];
type Vector = [Form; 3];

/// What a distance from a plane is of that from an edge, at most, where the difference quotient is taken.
const LOW: f64 = 0.4;

/// A cage and where its vertices go.
#[derive(Clone, Debug)]
pub(super) struct Step {
    points: Vec<Point3>,
    images: Vec<Point3>,
    edges: Vec<Edge>,
    faces: Vec<Face>,
}

#[derive(Clone, Debug)]
struct Edge {
    ends: [u32; 2],
    along: Vector,
    length: Form,
    by_length: Form,
}

#[derive(Clone, Debug)]
struct Face {
    corners: [u32; 3],
    /// Opposite to each corner.
    edges: [usize; 3],
    /// A unit vector.
    normal: Vector,
    /// For each edge the unit vector across it in the plane, towards the inside of the face.
    inward: [Vector; 3],
    /// The inverse heights.
    by_height: [Form; 3],
    /// The products of the vectors `inward`.
    products: [Vector; 3],
}

/// A vertex as seen from a point.
#[derive(Clone, Copy)]
struct Seen {
    to: Vector,
    far: Form,
}

/// An edge as seen from a point.
#[derive(Clone, Copy)]
struct Sight {
    ends: [Seen; 2],
    length: Form,
    by_length: Form,
    is_wide: bool,
    /// Its angle over the distance from its line.
    angle: Form,
}

/// A face as seen from a point: the height over its plane, and how far the foot is from the edges, towards the inside.
#[derive(Clone, Copy)]
struct View {
    height: Form,
    inside: [Form; 3],
}

/// How the quotient of solid moment and height is found.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Divide,
    Cross,
    /// Not at all: everything is multiplied by the height.
    Multiply,
}

impl Step {
    pub fn new(points: &[Point3], images: &[Point3], triangles: &[[u32; 3]]) -> Self {
        let mut numbers = BTreeMap::new();
        let mut edges = Vec::new();
        let mut number_of = |a: u32, b: u32| {
            let ends = [a.min(b), a.max(b)];
            *numbers.entry(ends).or_insert_with(|| {
                let along = between(points, ends[0], ends[1]);
                let length = Form::length(along);
                edges.push(Edge { ends, along, length, by_length: length.inverse() });
                edges.len() - 1
            })
        };
        let face =
            |&[a, b, c]: &[u32; 3]| Face::new(points, [a, b, c], [number_of(b, c), number_of(c, a), number_of(a, b)]);
        let faces = triangles.iter().map(face).collect();
        Self { points: points.to_vec(), images: images.to_vec(), edges, faces }
    }

    /// The image of a cube or of less; coordinates are unknown if too much of the cage is near.
    pub fn enclose(&self, at: Vector) -> Vector {
        let views: Vec<View> = self.faces.iter().map(|face| face.view(&self.points, at)).collect();
        let Some(ways) = ways(&views) else { return [Form::UNKNOWN; 3] };
        let seen: Vec<Seen> = self.points.iter().map(|p| Seen::new(minus(p.map(Form::exact), at))).collect();
        let sights: Vec<Sight> = self.edges.iter().map(|edge| Sight::new(edge, &seen)).collect();
        let (mut total, mut weights) = (Form::ZERO, vec![Form::ZERO; self.points.len()]);
        let near = ways.iter().position(|&way| way == Way::Multiply);
        let others = (0..self.faces.len()).filter(|&face| Some(face) != near);
        for face in others.chain(near) {
            if Some(face) == near {
                let height = views[face].height;
                weights.iter_mut().for_each(|weight| *weight = height * *weight);
                total = height * total;
            }
            total = total + self.faces[face].add(&sights, views[face], ways[face], &mut weights);
        }
        // From the image of a vertex that is near, so that sizes of coordinates do not matter.
        let nearest = (0..seen.len()).min_by(|&a, &b| seen[a].far.middle.total_cmp(&seen[b].far.middle)).unwrap_or(0);
        let origin = self.images[nearest].map(Form::exact);
        let mut sum = [Form::ZERO; 3];
        for (weight, image) in weights.iter().zip(&self.images) {
            let offset = minus(image.map(Form::exact), origin);
            sum = [0, 1, 2].map(|k| sum[k] + *weight * offset[k]);
        }
        let inverse = total.inverse();
        [0, 1, 2].map(|k| origin[k] + sum[k] * inverse)
    }

    /// Whether no face meets a cube. If the answer is no, one still may not.
    pub fn is_clear(&self, at: Vector) -> bool {
        let misses = |view: View| view.height.has_sign() || view.inside.iter().any(|x| x.is_negative());
        self.faces.iter().all(|face| misses(face.view(&self.points, at)))
    }
}

/// How each face is looked at; none if several are near.
fn ways(views: &[View]) -> Option<Vec<Way>> {
    let (mut ways, mut nearest, mut is_decided) = (Vec::with_capacity(views.len()), None, true);
    for (face, view) in views.iter().enumerate() {
        let height = view.height;
        let crosses = |x: &Form| x.is_negative() && height.middle.abs() < LOW * x.middle.abs();
        if view.inside.iter().any(crosses) {
            ways.push(Way::Cross);
            continue;
        }
        ways.push(Way::Divide);
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

impl Face {
    fn new(points: &[Point3], corners: [u32; 3], edges: [usize; 3]) -> Self {
        let [a, b, c] = corners;
        // Towards the inside of the cage: triangles are counter-clockwise from outside.
        let sides = [between(points, b, c), between(points, c, a), between(points, a, b)];
        let across = cross(sides[1], sides[0]);
        let twice_area = Form::length(across);
        let normal = times(twice_area.inverse(), across);
        let inward = sides.map(|side| times(Form::length(side).inverse(), cross(side, normal)));
        let by_height = sides.map(|side| Form::length(side) * twice_area.inverse());
        let products = inward.map(|a| inward.map(|b| dot(a, b)));
        Self { corners, edges, normal, inward, by_height, products }
    }

    fn view(&self, points: &[Point3], at: Vector) -> View {
        let from = self.corners.map(|v| minus(at, points[v as usize].map(Form::exact)));
        View { height: dot(from[0], self.normal), inside: [0, 1, 2].map(|k| dot(from[(k + 1) % 3], self.inward[k])) }
    }

    /// Formulas (1) and (3): the weights of the face are added; its share of the total is returned.
    fn add(&self, sights: &[Sight], view: View, way: Way, weights: &mut [Form]) -> Form {
        let half = Form::exact(0.5);
        let angles = self.edges.map(|edge| sights[edge].angle);
        let over_height = match way {
            Way::Divide => half * dot(view.inside, angles) * view.height.inverse(),
            Way::Multiply => half * dot(view.inside, angles),
            Way::Cross => view.height * self.crossing(sights, view),
        };
        let height = half * if way == Way::Multiply { view.height.square() } else { view.height };
        for (k, &corner) in self.corners.iter().enumerate() {
            let weight = (view.inside[k] * over_height + height * dot(angles, self.products[k])) * self.by_height[k];
            weights[corner as usize] = weights[corner as usize] + weight;
        }
        over_height
    }

    /// Formula (5): the moment over the square of the height.
    fn crossing(&self, sights: &[Sight], view: View) -> Form {
        let slope = |k: usize| sights[self.edges[k]].slope(view.inside[k], view.height, self.normal);
        Form::exact(0.5) * dot(view.inside, [0, 1, 2].map(slope))
    }
}

impl Seen {
    fn new(to: Vector) -> Self {
        Self { to, far: Form::length(to) }
    }
}

impl Sight {
    /// Formula (2).
    fn new(edge: &Edge, seen: &[Seen]) -> Self {
        let ends = edge.ends.map(|v| seen[v as usize]);
        let is_wide = dot(ends[0].to, ends[1].to).middle < 0.0;
        let mut sight = Self { ends, length: edge.length, by_length: edge.by_length, is_wide, angle: Form::ZERO };
        let distance = times(edge.by_length, cross(ends[0].to, edge.along));
        let part = sight.part(distance[0].square() + distance[1].square() + distance[2].square());
        sight.angle = if is_wide { pi() * Form::length(distance).inverse() - part } else { part };
        sight
    }

    /// The part of the angle that is an arctangent.
    fn part(&self, square: Form) -> Form {
        let kappa = self.kappa();
        Form::exact(2.0) * kappa * arctangent(kappa.square() * square)
    }

    fn product(&self) -> Form {
        self.ends[0].far * self.ends[1].far
    }

    /// The tangent of half the angle over the distance from the line; the cotangent if the angle is obtuse.
    fn kappa(&self) -> Form {
        let cosine = dot(self.ends[0].to, self.ends[1].to);
        let sum = if self.is_wide { self.product() - cosine } else { self.product() + cosine };
        sum.inverse() * self.length
    }

    /// The quotient of the difference of `angle` from its value at the foot of a height, and the square of the height.
    fn slope(&self, inside: Form, height: Form, normal: Vector) -> Form {
        let part = self.part_slope(inside, height, normal);
        if !self.is_wide {
            return part;
        }
        let size = if inside.middle < 0.0 { -inside } else { inside };
        // Both are across the edge; so this is the distance from it.
        let far = Form::length([inside, height, Form::ZERO]);
        -(pi() * (far * size * (far + size)).inverse()) - part
    }

    fn part_slope(&self, inside: Form, height: Form, normal: Vector) -> Form {
        let step = times(height, normal);
        let ends = self.ends.map(|end| Seen::new([0, 1, 2].map(|k| end.to[k] + step[k])));
        let foot = Self { ends, ..*self };
        let [kappa, other] = [self.kappa(), foot.kappa()];
        let squares = [height, foot.ends[0].far, foot.ends[1].far].map(Form::square);
        let by = (squares[0] + squares[1] + squares[2]) * (self.product() + foot.product()).inverse();
        let by = if self.is_wide { by - Form::ONE } else { by + Form::ONE };
        let turn = -(kappa * other * by * self.by_length);
        let square = inside.square();
        let rise = kappa.square() + turn * (kappa + other) * square;
        let at = kappa.square() * (square + squares[0]);
        let at_foot = other.square() * square;
        Form::exact(2.0) * (turn * arctangent(at) + other * rise * quotient(at, at_foot))
    }
}

fn between(points: &[Point3], a: u32, b: u32) -> Vector {
    minus(points[b as usize].map(Form::exact), points[a as usize].map(Form::exact))
}

/// Between two neighbouring doubles.
fn pi() -> Form {
    Form::exact(std::f64::consts::PI).widened(4e-16)
}
