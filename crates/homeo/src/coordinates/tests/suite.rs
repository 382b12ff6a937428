//! The laws that coordinates of every kind obey, and by how much they are missed.

use homeo_core::planar::{PlanarDomain, Point2};

use super::naive::Reference;
use super::shapes;
use crate::coordinates::PlanarCoordinates;

/// The worst errors, each relative to what it is an error of.
#[derive(Clone, Copy, Debug, Default)]
pub struct Misses {
    /// `sum phi = 1`.
    pub unity: f64,
    /// `sum phi v = x`.
    pub reproduction: f64,
    /// 1 at a vertex, 0 at others.
    pub lagrange: f64,
    /// Linear on edges.
    pub edge: f64,
    /// How negative coordinates are.
    pub negative: f64,
    /// Gradients sum to 0, and with vertices to the identity.
    pub gradient_laws: f64,
    /// Values against the reference, relative to the largest.
    pub value: f64,
    /// Values against the reference, each relative to itself.
    pub component: f64,
    /// Gradients against the reference, relative to the largest.
    pub gradient: f64,
}

/// All points at which a domain is tried: inside, and from `1e-3` to `1e-12` of the diagonal from edges and vertices.
pub fn points(domain: &PlanarDomain) -> Vec<Point2> {
    let mut all = shapes::inside(domain, 60);
    for share in [1e-3, 1e-6, 1e-9, 1e-12] {
        all.extend(shapes::near_edges(domain, share));
        all.extend(shapes::near_vertices(domain, share));
    }
    all
}

/// Tries a kind on a domain.
pub fn misses(kind: &dyn PlanarCoordinates, domain: &PlanarDomain, reference: Option<Reference>) -> Misses {
    let mut worst = Misses::default();
    let n = domain.vertex_count();
    assert_eq!(kind.vertex_count(), n);
    on_the_boundary(kind, domain, &mut worst);
    let vertices: Vec<Point2> = domain.vertices().collect();
    let (mut values, mut plain, mut gradients) = (vec![0.0; n], vec![0.0; n], vec![[0.0; 2]; n]);
    for point in points(domain) {
        kind.values_into(point, &mut plain).unwrap();
        kind.gradients_into(point, &mut values, &mut gradients).unwrap();
        let size: f64 = values.iter().map(|v| v.abs()).sum();
        grow(&mut worst.unity, (plain.iter().sum::<f64>() - 1.0).abs() / size);
        for k in 0..2 {
            let sum: f64 = plain.iter().zip(&vertices).map(|(v, p)| v * (p[k] - point[k])).sum();
            grow(&mut worst.reproduction, sum.abs() / (size * domain.diagonal()));
        }
        let (least, most) = plain.iter().fold((f64::MAX, 0.0), |(a, b), &v| (v.min(a), v.abs().max(b)));
        grow(&mut worst.negative, -least);
        let steepest = gradients.iter().flatten().fold(0.0, |a: f64, g| a.max(g.abs()));
        gradient_laws(&vertices, point, &gradients, steepest, domain.diagonal(), &mut worst);
        let Some(reference) = reference else { continue };
        let (true_values, true_gradients) = reference(domain, point);
        for i in 0..n {
            grow(&mut worst.value, (plain[i] - true_values[i]).abs() / most);
            grow(&mut worst.component, ((values[i] - true_values[i]) / true_values[i]).abs());
            for k in 0..2 {
                grow(&mut worst.gradient, (gradients[i][k] - true_gradients[i][k]).abs() / steepest);
            }
        }
    }
    worst
}

fn gradient_laws(
    vertices: &[Point2],
    point: Point2,
    gradients: &[[f64; 2]],
    steepest: f64,
    diagonal: f64,
    worst: &mut Misses,
) {
    for k in 0..2 {
        let sum: f64 = gradients.iter().map(|g| g[k]).sum();
        grow(&mut worst.gradient_laws, sum.abs() / steepest);
        for l in 0..2 {
            let sum: f64 = gradients.iter().zip(vertices).map(|(g, p)| g[k] * (p[l] - point[l])).sum();
            let truth = if k == l { 1.0 } else { 0.0 };
            grow(&mut worst.gradient_laws, (sum - truth).abs() / (steepest * diagonal).max(1.0));
        }
    }
}

fn on_the_boundary(kind: &dyn PlanarCoordinates, domain: &PlanarDomain, worst: &mut Misses) {
    let mut values = vec![0.0; domain.vertex_count()];
    for (vertex, point) in domain.vertices().enumerate() {
        kind.values_into(point, &mut values).unwrap();
        values[vertex] -= 1.0;
        values.iter().for_each(|v| grow(&mut worst.lagrange, v.abs()));
    }
    let mut first = 0;
    for ring in domain.rings() {
        for i in 0..ring.len() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            // Rounding moves points off short edges by too much for some kinds: the references judge there.
            if length < 1e-6 * domain.diagonal() {
                continue;
            }
            for share in [1e-6, 0.25, 0.5, 0.7] {
                let point = [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
                let place = (point[0] - a[0]).hypot(point[1] - a[1]) / length;
                let size = domain.vertices().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
                let slack = f64::max(1.0, size / (share * length) * 1e-3);
                if kind.values_into(point, &mut values).is_err() {
                    continue;
                }
                values[first + i] -= 1.0 - place;
                values[first + (i + 1) % ring.len()] -= place;
                values.iter().for_each(|v| grow(&mut worst.edge, v.abs() / slack));
            }
        }
        first += ring.len();
    }
}

/// The larger of two errors; what is not a number is infinite.
pub fn grow(worst: &mut f64, error: f64) {
    *worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
}
