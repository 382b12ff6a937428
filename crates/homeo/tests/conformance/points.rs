//! Rational points of a mesh and of a target, and where they lie, exactly.

use homeo::input::SourceMesh;
use homeo::map::{Foliation, Target};
use homeo_core::mesh::{Adjacency, CellId, VertexId};
use homeo_core::number::Rational;

use crate::random::Random;

pub type Point = [Rational; 3];

pub fn rational(numerator: i64, denominator: i64) -> Rational {
    &Rational::from(numerator) / &Rational::from(denominator)
}

pub fn exact(point: [f64; 3]) -> Point {
    point.map(|x| Rational::from_f64(x).expect("finite"))
}

pub fn rounded(point: &Point) -> [f64; 3] {
    point.each_ref().map(Rational::to_f64)
}

/// A point of the mesh, and whether it lies on the boundary.
#[derive(Clone, Debug)]
pub struct SourcePoint {
    pub at: Point,
    pub on_boundary: bool,
}

/// Where vertices and boundary of a source mesh are.
pub struct Places<'m, const K: usize> {
    source: &'m SourceMesh<K>,
    boundary: Vec<Vec<VertexId>>,
}

impl<'m, const K: usize> Places<'m, K> {
    pub fn new(source: &'m SourceMesh<K>) -> Self {
        let adjacency: Adjacency<K> = source.complex().adjacency().expect("a manifold");
        let facet = |f: homeo_core::mesh::Facet| source.complex().facet_vertices(f.cell(), f.opposite()).collect();
        Self { source, boundary: adjacency.boundary_facets().map(facet).collect() }
    }

    /// The point with the given weights on vertices of one cell.
    fn point(&self, terms: &[(VertexId, Rational)]) -> SourcePoint {
        let total: Rational = terms.iter().map(|(_, w)| w.clone()).sum();
        let coordinate = |axis: usize| {
            let value = |v: VertexId| Rational::from_f64(self.source.positions()[v.index()][axis]).expect("finite");
            let sum: Rational = terms.iter().map(|(v, w)| w * &value(*v)).sum();
            &sum / &total
        };
        let at = [coordinate(0), coordinate(1), coordinate(2)];
        let carried = |facet: &Vec<VertexId>| terms.iter().all(|(v, w)| w.is_zero() || facet.contains(v));
        SourcePoint { at, on_boundary: self.boundary.iter().any(carried) }
    }

    /// Whether a point of the mesh lies on its boundary, by trying every boundary facet.
    pub fn is_on_boundary(&self, point: &Point) -> bool {
        self.boundary.iter().any(|facet| {
            let corners: Vec<Point> = facet.iter().map(|v| exact(self.source.positions()[v.index()])).collect();
            is_in_simplex(&corners, point)
        })
    }

    /// A point of a cell of the foliated mesh from weights of its corners.
    fn in_foliated_cell(&self, map: &Foliation<K>, cell: CellId, weights: [i64; K]) -> SourcePoint {
        let mut terms: Vec<(VertexId, Rational)> = Vec::new();
        for (vertex, weight) in map.parts().mesh.complex().cell(cell).into_iter().zip(weights) {
            let carrier = map.parts().mesh.carrier(vertex);
            for (v, part) in carrier.terms() {
                let share = rational(weight * part, carrier.total());
                match terms.iter_mut().find(|(known, _)| *known == v) {
                    Some((_, sum)) => *sum = &*sum + &share,
                    None => terms.push((v, share)),
                }
            }
        }
        self.point(&terms)
    }

    /// Vertices, edge midpoints, points of facets and of the inside of cells, and of the centre.
    pub fn sample(&self, map: &Foliation<K>, count: usize, seed: u64) -> Vec<SourcePoint> {
        let mut random = Random::new(seed);
        let cells = map.parts().mesh.complex().cell_count() as u64;
        let mut points = Vec::new();
        for number in 0..count {
            let cell = CellId::new(random.below(cells) as usize);
            points.push(self.in_foliated_cell(map, cell, weights_of_kind(number, &mut random)));
        }
        // All kinds in the centre and next to it, where leaves begin or end.
        for centre in map.parts().centre.iter() {
            let around = (0..K).map(|i| map.adjacency().across(centre.cell, i).cell());
            for cell in [centre.cell].into_iter().chain(around) {
                for kind in 0..3 * KINDS {
                    points.push(self.in_foliated_cell(map, cell, weights_of_kind(kind, &mut random)));
                }
                points.push(self.in_foliated_cell(map, cell, [1; K]));
            }
        }
        points.extend(self.boundary_sample(&mut random, count / 4));
        points
    }

    /// The same of the cells of the mesh itself.
    pub fn sample_cells(&self, count: usize, seed: u64) -> Vec<SourcePoint> {
        let mut random = Random::new(seed);
        let cells = self.source.complex().cells();
        let mut points: Vec<SourcePoint> = (0..count)
            .map(|number| {
                let cell = cells[random.below(cells.len() as u64) as usize];
                let weights: [i64; K] = weights_of_kind(number, &mut random);
                self.point(&cell.into_iter().zip(weights.map(Rational::from)).collect::<Vec<_>>())
            })
            .collect();
        points.extend(self.boundary_sample(&mut random, count / 4));
        points
    }

    /// Whether a point lies in the mesh, by trying every cell.
    pub fn is_in_mesh(&self, point: &Point) -> bool {
        self.source.complex().cells().iter().any(|cell| {
            let corners = cell.map(|v| exact(self.source.positions()[v.index()]));
            if K == 3 { is_in_simplex(&corners, point) } else { is_in_tetrahedron(&corners, point) }
        })
    }

    /// Points beyond all others along each axis.
    pub fn far_points(&self) -> Vec<[f64; 3]> {
        let size = self.source.positions().iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        (0..3).map(|axis| std::array::from_fn(|k| if k == axis { 3.0 * size } else { 0.0 })).collect()
    }

    fn boundary_sample(&self, random: &mut Random, count: usize) -> Vec<SourcePoint> {
        (0..count)
            .map(|_| {
                let facet = &self.boundary[random.below(self.boundary.len() as u64) as usize];
                let weight = |random: &mut Random| Rational::from(random.below(5) as i64);
                let mut terms: Vec<_> = facet.iter().map(|&v| (v, weight(random))).collect();
                terms[0].1 = Rational::ONE;
                self.point(&terms)
            })
            .collect()
    }
}

/// Kinds of points of a cell: vertices, edge midpoints, facet points, inside points.
const KINDS: usize = 6;

fn weights_of_kind<const K: usize>(number: usize, random: &mut Random) -> [i64; K] {
    let mut weights = [0; K];
    let mut corners: Vec<usize> = (0..K).collect();
    random.shuffle(&mut corners);
    match number % KINDS {
        0 => weights[corners[0]] = 1,
        1 => (weights[corners[0]], weights[corners[1]]) = (1, 1),
        2 => corners[1..].iter().for_each(|&k| weights[k] = 1 + random.below(9) as i64),
        3 => (weights[corners[0]], weights[corners[1]]) = (1, 1_000_003),
        _ => weights = weights.map(|_| 1 + random.below(1000) as i64),
    }
    weights
}

fn minus(a: &Point, b: &Point) -> Point {
    [0, 1, 2].map(|axis| &a[axis] - &b[axis])
}

fn dot(a: &Point, b: &Point) -> Rational {
    (0..3).map(|axis| &a[axis] * &b[axis]).sum()
}

fn cross(a: &Point, b: &Point) -> Point {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &(&a[i] * &b[j]) - &(&a[j] * &b[i]))
}

/// Whether a point lies in a segment or triangle.
fn is_in_simplex(corners: &[Point], point: &Point) -> bool {
    let within = |w: &Rational| *w >= Rational::ZERO && *w <= Rational::ONE;
    let offset = minus(point, &corners[0]);
    let first = minus(&corners[1], &corners[0]);
    if corners.len() == 2 {
        let along = &dot(&offset, &first) / &dot(&first, &first);
        return within(&along) && minus(&offset, &first.map(|x| &x * &along)).iter().all(Rational::is_zero);
    }
    let second = minus(&corners[2], &corners[0]);
    let normal = cross(&first, &second);
    let square = dot(&normal, &normal);
    let weights = [&dot(&cross(&offset, &second), &normal) / &square, &dot(&cross(&first, &offset), &normal) / &square];
    dot(&normal, &offset).is_zero() && weights.iter().all(within) && within(&(&weights[0] + &weights[1]))
}

/// Whether it lies in a tetrahedron: on no outer side of a face.
fn is_in_tetrahedron(corners: &[Point], point: &Point) -> bool {
    let side = |i: usize, p: &Point| {
        let [a, b, c] = [1, 2, 3].map(|k| &corners[(i + k) % 4]);
        dot(&minus(p, a), &cross(&minus(b, a), &minus(c, a)))
    };
    (0..4).all(|i| &side(i, &corners[i]) * &side(i, point) >= Rational::ZERO)
}

/// Heights of a point above the sides of the exact target: all of them at least 0 inside, one 0 on the boundary.
fn heights(target: Target, q: &Point) -> Vec<Rational> {
    let one = &Rational::ONE;
    let sum = |signs: [i64; 3]| -> Rational { (0..3).map(|axis| &Rational::from(signs[axis]) * &q[axis]).sum() };
    match target {
        Target::Square | Target::Cube => q.iter().take(target.dimension()).flat_map(|x| [x.clone(), one - x]).collect(),
        Target::Disk => [[1, 1, 0], [1, -1, 0], [-1, 1, 0], [-1, -1, 0]].map(|s| one - &sum(s)).to_vec(),
        Target::Ball => [[1, 1, 1], [1, -1, -1], [-1, -1, 1], [-1, 1, -1]].map(|s| &rational(1, 2) + &sum(s)).to_vec(),
    }
}

/// Whether a point lies in the exact target.
pub fn is_in_target(target: Target, q: &Point) -> bool {
    let is_flat = target.dimension() == 3 || q[2].is_zero();
    is_flat && heights(target, q).iter().all(|h| *h >= Rational::ZERO)
}

/// Whether a point of the exact target lies on its boundary.
pub fn is_on_target_boundary(target: Target, q: &Point) -> bool {
    heights(target, q).iter().any(Rational::is_zero)
}

/// Corners of the exact target.
fn corners(target: Target) -> Vec<Point> {
    let point = |x: i64, y: i64, z: i64, d: i64| [rational(x, d), rational(y, d), rational(z, d)];
    let unit_box = |k: i64| point(k & 1, k >> 1 & 1, k >> 2, 1);
    match target {
        Target::Square => (0..4).map(unit_box).collect(),
        Target::Cube => (0..8).map(unit_box).collect(),
        Target::Disk => vec![point(1, 0, 0, 1), point(0, 1, 0, 1), point(-1, 0, 0, 1), point(0, -1, 0, 1)],
        Target::Ball => [[1, 1, 1], [1, -1, -1], [-1, -1, 1], [-1, 1, -1]].map(|[x, y, z]| point(x, y, z, 2)).to_vec(),
    }
}

fn between(a: &Point, b: &Point, part: &Rational) -> Point {
    [0, 1, 2].map(|axis| &a[axis] + &(part * &(&b[axis] - &a[axis])))
}

/// Corners, edges, faces, diagonals, the middle, and points inside.
pub fn target_sample(target: Target, count: usize, seed: u64) -> Vec<Point> {
    let mut random = Random::new(seed);
    let corners = corners(target);
    let mut points = corners.clone();
    let half = rational(1, 2);
    for (i, a) in corners.iter().enumerate() {
        for b in &corners[..i] {
            points.push(between(a, b, &half));
            points.push(between(a, b, &rational(1 + random.below(99) as i64, 100)));
        }
    }
    let mut share = || rational(random.below(1001) as i64, 1000);
    for _ in 0..count {
        // Convex combinations of corners, the last step at times none.
        let mut point = corners[0].clone();
        for corner in &corners[1..] {
            point = between(&point, corner, &share());
        }
        points.push(point);
    }
    if target.is_radial() {
        let inside = points.clone();
        for (k, q) in inside.iter().enumerate() {
            let scale = [rational(1, 1_000_000), rational(1, 7), rational(999_999, 1_000_000)][k % 3].clone();
            points.push(q.each_ref().map(|x| x * &scale));
        }
    }
    points
}
