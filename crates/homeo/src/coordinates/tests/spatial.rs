//! The laws of coordinates of polyhedra, one suite for every kind.

use super::solids::{self, Point3, Solid, mix};
use crate::coordinates::face_view::{Face, Weights};
use crate::coordinates::real::{Jet, Real};
use crate::coordinates::vectors::{minus, norm, scalar_product};
use crate::coordinates::*;

const TOLERANCE: f64 = 1e-12;

/// The worst errors, each relative to what it is an error of.
#[derive(Clone, Copy, Debug, Default)]
pub struct Misses {
    pub unity: f64,
    pub reproduction: f64,
    pub lagrange: f64,
    pub face: f64,
    pub negative: f64,
    pub gradient_laws: f64,
    value: f64,
    gradient: f64,
}

fn grow(worst: &mut f64, miss: f64) {
    *worst = if miss.is_nan() { f64::INFINITY } else { worst.max(miss) };
}

/// Tries a kind; with a reference at points inside.
fn misses(kind: &dyn SpatialCoordinates, solid: &Solid, has_reference: bool) -> Misses {
    let mut worst = Misses::default();
    on_the_boundary(kind, solid, &mut worst);
    let mut points = if has_reference { solid.deep_inside(20) } else { Vec::new() };
    let far = points.len();
    points.extend(solid.inside(60, 5));
    [1e-3, 1e-6, 1e-9, 1e-12].iter().for_each(|&share| points.extend(solid.beside(share)));
    let n = solid.vertices.len();
    let (mut values, mut plain, mut gradients) = (vec![0.0; n], vec![0.0; n], vec![[0.0; 3]; n]);
    for (number, &point) in points.iter().enumerate() {
        kind.values_into(point, &mut plain).unwrap();
        kind.gradients_into(point, &mut values, &mut gradients).unwrap();
        laws(solid, point, &plain, &gradients, &mut worst);
        let size = values.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
        let apart = values.iter().zip(&plain).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        grow(&mut worst.value, apart / size);
        if has_reference && number < far {
            let (truth, slopes) = reference(solid, point);
            let steepest = slopes.iter().flatten().fold(0.0, |a: f64, v| a.max(v.abs()));
            for i in 0..n {
                grow(&mut worst.value, (truth[i] - plain[i]).abs() / size);
                (0..3).for_each(|k| grow(&mut worst.gradient, (slopes[i][k] - gradients[i][k]).abs() / steepest));
            }
        }
    }
    assert!(points.len() > 100, "{} points were tried", points.len());
    worst
}

pub fn laws(solid: &Solid, point: Point3, values: &[f64], gradients: &[Point3], worst: &mut Misses) {
    let (diagonal, vertices) = (solid.diagonal(), &solid.vertices);
    let size: f64 = values.iter().map(|v| v.abs()).sum();
    grow(&mut worst.unity, (values.iter().sum::<f64>() - 1.0).abs() / size);
    let steepest = gradients.iter().flatten().fold(0.0, |a: f64, g| a.max(g.abs()));
    for k in 0..3 {
        let place: f64 = values.iter().zip(vertices).map(|(v, p)| v * (p[k] - point[k])).sum();
        grow(&mut worst.reproduction, place.abs() / (size * diagonal));
        let sum: f64 = gradients.iter().map(|g| g[k]).sum();
        grow(&mut worst.gradient_laws, sum.abs() / steepest);
        for l in 0..3 {
            let slope: f64 = gradients.iter().zip(vertices).map(|(g, p)| g[l] * (p[k] - point[k])).sum();
            let truth = if k == l { 1.0 } else { 0.0 };
            grow(&mut worst.gradient_laws, (slope - truth).abs() / (steepest * diagonal).max(1.0));
        }
    }
    let (least, most) = values.iter().fold((f64::MAX, 0.0), |(a, b), &v: &f64| (v.min(a), v.abs().max(b)));
    // Beside vertices some points are outside.
    if solid.winding(point) > 0.5 {
        grow(&mut worst.negative, -least / most);
    }
}

pub fn on_the_boundary(kind: &dyn SpatialCoordinates, solid: &Solid, worst: &mut Misses) {
    let mut values = vec![0.0; solid.vertices.len()];
    for (vertex, &place) in solid.vertices.iter().enumerate() {
        kind.values_into(place, &mut values).unwrap();
        for (i, v) in values.iter().enumerate() {
            grow(&mut worst.lagrange, (v - if i == vertex { 1.0 } else { 0.0 }).abs());
        }
    }
    for (number, corners) in solid.triangles.iter().enumerate() {
        for shares in [[0.25, 0.5, 0.25], [0.5, 0.5, 0.0], [0.125, 0.0, 0.875], [0.9, 0.06, 0.04]] {
            kind.values_into(mix(&solid.corners(number), &shares), &mut values).unwrap();
            for (i, v) in values.iter().enumerate() {
                let own = corners.iter().position(|&c| c as usize == i).map_or(0.0, |k| shares[k]);
                grow(&mut worst.face, (v - own).abs());
            }
        }
    }
}

/// The formula of Ju, Schaefer and Warren as it stands, with dual numbers: the integral of unit normals over a spherical
/// triangle is half the sum of its sides times the normals of their planes, and a sum of the vectors to its corners.
fn reference(solid: &Solid, x: Point3) -> (Vec<f64>, Vec<Point3>) {
    type J = Jet<3>;
    let n = solid.vertices.len();
    let mut weights = vec![J::constant(0.0); n];
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let cross = |a: [J; 3], b: [J; 3]| [[1, 2], [2, 0], [0, 1]].map(|[k, l]| a[k] * b[l] - a[l] * b[k]);
    let dot = |a: [J; 3], b: [J; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    for corners in &solid.triangles {
        let p = corners
            .map(|v| [0, 1, 2].map(|k| J::variable(solid.vertices[v as usize][k] - x[k], axes[k].map(|e: f64| -e))));
        let mut mean = [J::constant(0.0); 3];
        for k in 0..3 {
            let (a, b) = (p[(k + 1) % 3], p[(k + 2) % 3]);
            let normal = cross(a, b);
            let (length, along) = (dot(normal, normal).sqrt(), dot(a, b));
            let (s, c) = (length.value(), along.value());
            let squares = s * s + c * c;
            let slope = |k: usize| (c * length.gradient[k] - s * along.gradient[k]) / squares;
            let angle = J::variable(s.atan2(c), [0, 1, 2].map(slope));
            (0..3).for_each(|m| mean[m] = mean[m] + normal[m] / length * angle * 0.5);
        }
        let volume = dot(p[0], cross(p[1], p[2]));
        for k in 0..3 {
            let part = dot(mean, cross(p[(k + 1) % 3], p[(k + 2) % 3])) / volume;
            weights[corners[k] as usize] = weights[corners[k] as usize] + part;
        }
    }
    let total = weights.iter().fold(J::constant(0.0), |a, &b| a + b);
    weights.iter().map(|&w| w / total).map(|j| (j.value, j.gradient)).unzip()
}

fn is_sound(worst: &Misses, tolerance: f64) -> bool {
    let all = [worst.unity, worst.reproduction, worst.lagrange, worst.face, worst.gradient_laws, worst.value];
    all.iter().all(|&miss| miss < tolerance) && worst.gradient < 10.0 * tolerance
}

#[test]
fn mean_value_obeys_the_laws_in_space() {
    let mut tried = 0;
    for solid in solids::convex().iter().chain(&solids::general()) {
        let kind = MeanValuePolyhedron::new(&solid.vertices, &solid.triangles).unwrap();
        // The naive formula has no digits left in a body that is as thin as the needle.
        let worst = misses(&kind, solid, solid.name != "needle");
        assert!(is_sound(&worst, TOLERANCE), "{} {worst:?}", solid.name);
        tried += 1;
    }
    for solid in solids::convex() {
        let kind = MeanValuePolyhedron::new(&solid.vertices, &solid.triangles).unwrap();
        assert!(misses(&kind, &solid, false).negative < TOLERANCE, "{}", solid.name);
    }
    assert_eq!(tried, 8);
}

/// Against the integral itself, by a rule of Gauss, for a triangle in whose plane the point all but lies.
#[test]
fn weights_of_far_triangles_hold_at_every_height() {
    let places = [[1.0, 0.2, 0.0], [2.1, -0.3, 0.0], [1.4, 0.9, 0.0]];
    let face = Face::new([0, 1, 2], places);
    let mut tried = 0;
    for foot in [[0.3, 0.1], [2.8, 0.4], [1.0, 0.9], [-0.1, 0.7]] {
        for height in [0.0, 1e-300, 1e-15, 1e-12, 1e-8, 1e-4, 1e-2, 0.03] {
            let point = [foot[0], foot[1], -height];
            let Weights::Low(weights) = face.view::<Jet<3>>(point).weights(&face) else { panic!("{point:?}") };
            for (i, weight) in weights.iter().enumerate() {
                let (value, slope) = integral(&face, i, point);
                assert!((weight.value - value).abs() < 1e-12 * value.abs(), "{point:?} {weight:?} {value}");
                for k in 0..3 {
                    assert!(
                        (weight.gradient[k] - slope[k]).abs() < 1e-11 * norm(slope),
                        "{point:?} {weight:?} {slope:?}"
                    );
                }
                tried += 1;
            }
        }
    }
    assert_eq!(tried, 96);
}

/// The integral of `lambda_i / r^4` over a triangle, and its gradient, by a product rule.
fn integral(face: &Face, i: usize, point: Point3) -> (f64, Point3) {
    let rule = gauss(40);
    let [a, b, c] = face.places;
    let (mut value, mut slope) = (0.0, [0.0; 3]);
    for &(s, v) in &rule {
        for &(t, w) in &rule {
            let (x, y) = (s, t * (1.0 - s));
            let shares = [1.0 - x - y, x, y];
            let place = [0, 1, 2].map(|k| shares[0] * a[k] + shares[1] * b[k] + shares[2] * c[k]);
            let offset = minus(place, point);
            let square = scalar_product(offset, offset);
            let part = v * w * (1.0 - s) * face.double_area * shares[i] / (square * square);
            value += part;
            (0..3).for_each(|k| slope[k] += 4.0 * part * offset[k] / square);
        }
    }
    (value, slope)
}

/// Nodes and weights of the rule of Gauss on `[0, 1]`.
fn gauss(n: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..100 {
            let (mut p, mut last) = (x, 1.0);
            for k in 2..=n {
                let k = k as f64;
                (p, last) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * last) / k, p);
            }
            slope = n as f64 * (x * p - last) / (x * x - 1.0);
            x -= p / slope;
        }
        (0.5 * (x + 1.0), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

/// Right coordinates with one thing wrong.
struct Wrong {
    right: MeanValuePolyhedron,
    fault: fn(&mut [f64], &mut [Point3]),
}

impl SpatialCoordinates for Wrong {
    fn vertex_count(&self) -> usize {
        self.right.vertex_count()
    }

    fn values_into(&self, point: Point3, values: &mut [f64]) -> Result<(), CoordinateError> {
        self.right.values_into(point, values)?;
        (self.fault)(values, &mut []);
        Ok(())
    }

    fn gradients_into(&self, point: Point3, values: &mut [f64], slopes: &mut [Point3]) -> Result<(), CoordinateError> {
        self.right.gradients_into(point, values, slopes)?;
        (self.fault)(values, slopes);
        Ok(())
    }
}

#[test]
fn wrong_coordinates_fail_the_suite_in_space() {
    let solid = solids::octahedron();
    let tried = |fault| {
        let right = MeanValuePolyhedron::new(&solid.vertices, &solid.triangles).unwrap();
        misses(&Wrong { right, fault }, &solid, true)
    };
    assert!(is_sound(&tried(|_, _| {}), TOLERANCE));
    let scaled = tried(|values, _| values.iter_mut().for_each(|v| *v *= 1.0 + 1e-11));
    assert!(scaled.unity > TOLERANCE && scaled.lagrange > TOLERANCE && scaled.face > TOLERANCE);
    let moved = tried(|values, _| (values[0], values[1]) = (values[0] + 1e-11, values[1] - 1e-11));
    assert!(moved.unity < TOLERANCE && moved.reproduction > TOLERANCE && moved.negative > TOLERANCE);
    let steep = tried(|_, slopes| slopes.iter_mut().for_each(|g| g[0] *= 1.0 + 1e-10));
    assert!(steep.gradient > TOLERANCE && steep.gradient_laws > TOLERANCE && steep.value < TOLERANCE);
    let other = WachspressPolyhedron::new(&solid.vertices, &solid.triangles).unwrap();
    assert!(misses(&other, &solid, true).value > 1e-3);
}

/// Limits from inside, the same as beside the face; none on edges and at vertices.
#[test]
fn gradients_reach_faces_but_not_edges() {
    let solid = solids::corner_box();
    let kind = MeanValuePolyhedron::new(&solid.vertices, &solid.triangles).unwrap();
    let n = solid.vertices.len();
    let (mut values, mut on, mut beside) = (vec![0.0; n], vec![[0.0; 3]; n], vec![[0.0; 3]; n]);
    kind.gradients_into([0.5, 0.25, 0.0], &mut values, &mut on).unwrap();
    kind.gradients_into([0.5, 0.25, 1e-13], &mut values, &mut beside).unwrap();
    for (a, b) in on.iter().flatten().zip(beside.iter().flatten()) {
        assert!((a - b).abs() < 1e-11, "{a} {b}");
    }
    let edge = kind.gradients_into([0.5, 0.0, 0.0], &mut values, &mut on);
    assert_eq!(edge, Err(CoordinateError::NoGradientOnEdge { from: 0, to: 1 }));
    assert_eq!(
        kind.gradients_into([2.0, 0.0, 1.0], &mut values, &mut on),
        Err(CoordinateError::NoGradient { vertex: 7 })
    );
    assert!(kind.values_into([f64::NAN, 0.0, 0.0], &mut values).is_err());
    let mut open = solid.triangles.clone();
    open.pop();
    assert!(matches!(MeanValuePolyhedron::new(&solid.vertices, &open), Err(PolyhedronError::NotClosed { .. })));
    let mut flat = solid.vertices.clone();
    flat[3] = [1.0, 0.0, 0.0];
    let error = MeanValuePolyhedron::new(&flat, &solid.triangles).unwrap_err();
    assert_eq!(error, PolyhedronError::NoArea { triangle: 0 });
}

/// Many points at once give what each gives alone, to the last bit.
#[test]
fn many_points_at_once_are_as_single_ones() {
    let solid = solids::torus();
    let kind = MeanValuePolyhedron::new(&solid.vertices, &solid.triangles).unwrap();
    let points = solid.inside(40, 3);
    let images = kind.combine(&solid.vertices, &points).unwrap();
    let mut values = vec![0.0; solid.vertices.len()];
    for (point, image) in points.iter().zip(&images) {
        kind.values_into(*point, &mut values).unwrap();
        let sum = [0, 1, 2].map(|k| values.iter().zip(&solid.vertices).map(|(v, p)| v * p[k]).sum::<f64>());
        assert_eq!(sum, *image);
        assert!(norm(minus(sum, *point)) < 1e-13);
    }
    assert!(kind.combine(&solid.vertices[1..], &points).is_err());
}
