//! Straight elements on the edges of a domain, shorter towards its corners.

use faer::c64;
use homeo_core::planar::{PlanarDomain, Point2};

use super::HarmonicFunctionError;
use super::kernel::Local;

/// How edges are divided into elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementParams {
    /// Each half of an edge gets at least so many elements.
    pub per_half_edge: usize,
    /// And so many that, were they alike, none would be longer than this share of the domain's diagonal.
    pub longest: f64,
    /// Nodes of half an edge of length 1 lie at `(j / n)^grading`: 1 for equal elements. At a corner where the domain has
    /// an inner angle of up to a full turn, normal derivatives grow as the distance to the power `-1/2`: 3 to 4 make up for it.
    pub grading: f64,
}

impl Default for ElementParams {
    fn default() -> Self {
        Self { per_half_edge: 4, longest: 0.04, grading: 4.0 }
    }
}

impl ElementParams {
    fn check(&self) -> Result<(), HarmonicFunctionError> {
        let bad = |name, value, range| Err(HarmonicFunctionError::BadParameter { name, value, range });
        match self {
            Self { per_half_edge: 0, .. } => bad("per_half_edge", 0.0, "1 or more"),
            Self { longest, .. } if *longest <= 0.0 || longest.is_nan() => bad("longest", *longest, "a number above 0"),
            Self { grading, .. } if !(1.0..=16.0).contains(grading) => bad("grading", *grading, "1 to 16"),
            _ => Ok(()),
        }
    }
}

/// An edge of the domain, scaled.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    pub ends: [Point2; 2],
    /// Unit vector along it.
    pub direction: c64,
    pub length: f64,
    /// Numbers of both ends among all vertices.
    pub vertices: [usize; 2],
    /// Its elements.
    pub elements: std::ops::Range<usize>,
}

/// A part of an edge. Places are counted from the nearer end of the edge, so that those of short elements at either corner
/// are known to their last digits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    pub edge: usize,
    /// The end from which `middle` is counted: 0 or 1.
    pub from_end: usize,
    /// Where the middle lies along the edge, negative from the second end.
    pub middle: f64,
    /// Where both ends lie, and from which end of the edge that is counted: elements that meet agree on it to the last bit.
    ends: [(usize, f64); 2],
    pub half: f64,
    /// The element after it in its ring.
    pub next: usize,
}

impl Element {
    /// Where it lies on its edge: shares of the edge's length, of its middle and of half of it.
    pub fn shares(&self, edge: &Edge) -> [f64; 2] {
        let middle = self.middle / edge.length;
        [if self.from_end == 0 { middle } else { 1.0 + middle }, self.half / edge.length]
    }

    /// A point as it sees it.
    pub fn local(&self, sight: &Sight) -> Local {
        let [left, right] = self.ends.map(|(end, place)| (sight.along[end] - place) / self.half);
        Local { left, right, height: sight.height / self.half }
    }
}

/// A point as an edge sees it: how far along the edge from either end, and how far to its left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    pub along: [f64; 2],
    pub height: f64,
}

impl Edge {
    /// How the edge sees a scaled point that is a step away from another: what is known of both to the last digit stays so
    /// beside corners. Without a step the height has the exact sign; it is never `-0`.
    pub fn sight(&self, Place { base, step, .. }: Place) -> Sight {
        let (d, [x, y]) = (self.direction, step);
        let along = self.ends.map(|end| (base[0] - end[0]) * d.re + (base[1] - end[1]) * d.im + (x * d.re + y * d.im));
        let coord = |p: Point2| robust::Coord { x: p[0], y: p[1] };
        let height = robust::orient2d(coord(self.ends[0]), coord(self.ends[1]), coord(base)) / self.length;
        Sight { along, height: height + (d.re * y - d.im * x) + 0.0 }
    }

    /// How the edge sees its own point, so far from one end.
    fn sight_of_own(&self, from_end: usize, along: f64) -> Sight {
        let other = if from_end == 0 { along - self.length } else { along + self.length };
        Sight { along: if from_end == 0 { [along, other] } else { [other, along] }, height: 0.0 }
    }

    /// Where its own point lies, so far from one end, rounded.
    pub fn point(&self, from_end: usize, along: f64) -> Point2 {
        let end = self.ends[from_end];
        [end[0] + along * self.direction.re, end[1] + along * self.direction.im]
    }
}

/// A scaled point: a step away from another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    base: Point2,
    step: Point2,
    /// The edge on which it lies, the end from which the step goes, and how far.
    own: Option<(usize, usize, f64)>,
}

impl Place {
    /// A point that is known itself.
    pub fn new(point: Point2) -> Self {
        Self { base: point, step: [0.0; 2], own: None }
    }
}

/// All elements of a domain, in a scale in which the domain is smaller than 1: single layers are then never degenerate.
#[derive(Clone, Debug)]
pub(super) struct Elements {
    pub domain: PlanarDomain,
    /// What coordinates are multiplied by: a power of two.
    pub scale: f64,
    pub edges: Vec<Edge>,
    pub all: Vec<Element>,
}

/// The most unknowns of a dense system.
pub(super) const MOST_UNKNOWNS: usize = 20_000;

impl Elements {
    pub fn new(domain: &PlanarDomain, params: &ElementParams) -> Result<Self, HarmonicFunctionError> {
        params.check()?;
        let scale = 2f64.powi(-(domain.diagonal().log2().floor() as i32) - 2);
        let longest = params.longest * domain.diagonal() * scale;
        let mut elements = Self { domain: domain.clone(), scale, edges: Vec::new(), all: Vec::new() };
        let mut first = 0;
        for ring in domain.rings() {
            let begin = elements.all.len();
            for i in 0..ring.len() {
                let next = (i + 1) % ring.len();
                elements.push_edge([ring[i], ring[next]], [first + i, first + next], longest, params);
            }
            first += ring.len();
            let end = elements.all.len();
            (begin..end).for_each(|e| elements.all[e].next = if e + 1 == end { begin } else { e + 1 });
        }
        let unknowns = 2 * elements.all.len();
        if unknowns > MOST_UNKNOWNS {
            return Err(HarmonicFunctionError::TooLarge { unknowns, most: MOST_UNKNOWNS });
        }
        Ok(elements)
    }

    fn push_edge(&mut self, ends: [Point2; 2], vertices: [usize; 2], longest: f64, params: &ElementParams) {
        let ends = ends.map(|p| p.map(|x| x * self.scale));
        let [x, y] = [0, 1].map(|k| ends[1][k] - ends[0][k]);
        let length = x.hypot(y);
        // More than allowed in all is refused afterwards: no more are made for one edge.
        let by_length = (0.5 * length / longest).ceil().min(MOST_UNKNOWNS as f64) as usize;
        let n = params.per_half_edge.max(by_length).min(MOST_UNKNOWNS);
        let node = |j: usize| 0.5 * length * (j as f64 / n as f64).powf(params.grading);
        let (edge, begin) = (self.edges.len(), self.all.len());
        let element = |from_end: usize, j: usize| {
            let (near, far) = (node(j), node(j + 1));
            let (middle, half) = (0.5 * (near + far), 0.5 * (far - near));
            let ends = match from_end {
                0 => [(0, near), (0, far)],
                _ if j + 1 == n => [(0, far), (1, -near)],
                _ => [(1, -far), (1, -near)],
            };
            let middle = if from_end == 0 { middle } else { -middle };
            Element { edge, from_end, middle, ends, half, next: 0 }
        };
        self.all.extend((0..n).map(|j| element(0, j)).chain((0..n).rev().map(|j| element(1, j))));
        let direction = c64::new(x / length, y / length);
        self.edges.push(Edge { ends, direction, length, vertices, elements: begin..self.all.len() });
    }

    /// A point in the scale of the elements, if it is in the closed domain.
    pub fn scaled(&self, point: Point2) -> Result<Point2, HarmonicFunctionError> {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(HarmonicFunctionError::NotFinite { point });
        }
        match self.domain.contains(point) {
            true => Ok(point.map(|x| x * self.scale)),
            false => Err(HarmonicFunctionError::Outside { point }),
        }
    }

    /// The edge on which a scaled point of the closed domain lies, and at which share of it.
    pub fn edge_at(&self, point: Point2) -> Option<(usize, f64)> {
        self.edges.iter().enumerate().find_map(|(i, edge)| {
            let Sight { along: [from, to], height } = edge.sight(Place::new(point));
            let share = if from < -to { from / edge.length } else { 1.0 + to / edge.length };
            (height == 0.0 && from >= 0.0 && to <= 0.0).then_some((i, share.clamp(0.0, 1.0)))
        })
    }

    /// A point of an element, by its number in the element's frame.
    pub fn place(&self, element: usize, t: f64) -> Place {
        let Element { edge, from_end, middle, half, .. } = self.all[element];
        let (own, along) = (&self.edges[edge], middle + t * half);
        let step = [along * own.direction.re, along * own.direction.im];
        Place { base: own.ends[from_end], step, own: Some((edge, from_end, along)) }
    }

    /// Calls with the number of each element and the point in its frame. A point known to be on an edge is not rounded off
    /// it.
    pub fn for_each(&self, place: Place, mut visit: impl FnMut(usize, &Element, Local)) {
        for (i, edge) in self.edges.iter().enumerate() {
            let sight = match place.own {
                Some((own, from_end, along)) if own == i => edge.sight_of_own(from_end, along),
                _ => edge.sight(place),
            };
            for e in edge.elements.clone() {
                visit(e, &self.all[e], self.all[e].local(&sight));
            }
        }
    }
}

/// Where equations are set up, in the frame of an element: zeros of the second Legendre polynomial.
pub(super) const COLLOCATION: [f64; 2] = [-0.577_350_269_189_625_8, 0.577_350_269_189_625_8];
