//! References: the formulas of the source (1.8) as they stand, in numbers of 32 digits.

use super::double::Dual;
use homeo_core::planar::PlanarDomain;

/// Values and gradients of a kind, or none where there is no reference.
pub type Reference = fn(&PlanarDomain, [f64; 2]) -> (Vec<f64>, Vec<[f64; 2]>);

pub fn wachspress(domain: &PlanarDomain, x: [f64; 2]) -> (Vec<f64>, Vec<[f64; 2]>) {
    three_point(domain, x, |_| Dual::constant(1.0))
}

pub fn mean_value(domain: &PlanarDomain, x: [f64; 2]) -> (Vec<f64>, Vec<[f64; 2]>) {
    three_point(domain, x, |r| r)
}

pub fn discrete_harmonic(domain: &PlanarDomain, x: [f64; 2]) -> (Vec<f64>, Vec<[f64; 2]>) {
    three_point(domain, x, |r| r * r)
}

pub fn half(domain: &PlanarDomain, x: [f64; 2]) -> (Vec<f64>, Vec<[f64; 2]>) {
    three_point(domain, x, Dual::sqrt)
}

pub fn minus_one(domain: &PlanarDomain, x: [f64; 2]) -> (Vec<f64>, Vec<[f64; 2]>) {
    three_point(domain, x, |r| Dual::constant(1.0) / r)
}

/// `(r_{i+1}^p A_{i-1} - r_i^p B_i + r_{i-1}^p A_i) / (A_{i-1} A_i)`, divided by the sum.
fn three_point(domain: &PlanarDomain, x: [f64; 2], power: fn(Dual) -> Dual) -> (Vec<f64>, Vec<[f64; 2]>) {
    let point = [Dual::variable(x[0], 0), Dual::variable(x[1], 1)];
    let mut weights = Vec::new();
    for ring in domain.rings() {
        let n = ring.len();
        let s: Vec<[Dual; 2]> =
            ring.iter().map(|v| [Dual::constant(v[0]) - point[0], Dual::constant(v[1]) - point[1]]).collect();
        let r: Vec<Dual> = s.iter().map(|[a, b]| power((*a * *a + *b * *b).sqrt())).collect();
        let area = |i: usize, j: usize| s[i][0] * s[j][1] - s[i][1] * s[j][0];
        for i in 0..n {
            let (h, j) = ((i + n - 1) % n, (i + 1) % n);
            let numerator = r[j] * area(h, i) - r[i] * area(h, j) + r[h] * area(i, j);
            weights.push(numerator / (area(h, i) * area(i, j)));
        }
    }
    normalised(&weights)
}

pub fn normalised(weights: &[Dual]) -> (Vec<f64>, Vec<[f64; 2]>) {
    let total = weights.iter().fold(Dual::constant(0.0), |a, &b| a + b);
    let all: Vec<Dual> = weights.iter().map(|&w| w / total).collect();
    (all.iter().map(|d| d.value.0).collect(), all.iter().map(|d| d.gradient.map(|g| g.0)).collect())
}
