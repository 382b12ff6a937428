//! Complex shares of edges: their laws, and derivatives against numbers of 32 digits.

use homeo_core::planar::{PlanarDomain, Point2};

use super::double::Dual;
use super::shapes;
use super::suite::{grow, points};
use crate::coordinates::*;

const ONE: Complex = Complex { re: 1.0, im: 0.0 };

fn sum(terms: impl Iterator<Item = Complex>) -> Complex {
    terms.fold(Complex::default(), |a, b| a + b)
}

/// Relative errors, the worst of each law.
#[derive(Debug, Default)]
struct Misses {
    unity: f64,
    similarity: f64,
    vertices: f64,
    derivative_laws: f64,
    value: f64,
    derivative: f64,
    conjugate: f64,
    points: usize,
}

type Power = fn(Dual) -> Dual;

/// `γ_i` of the source with `r^p` as given, over their sum, each part with its gradient.
fn reference(domain: &PlanarDomain, x: Point2, power: Power) -> Vec<[Dual; 2]> {
    let point = [Dual::variable(x[0], 0), Dual::variable(x[1], 1)];
    let mut all = Vec::new();
    for ring in domain.rings() {
        let n = ring.len();
        let rho: Vec<[Dual; 2]> =
            ring.iter().map(|v| [Dual::constant(v[0]) - point[0], Dual::constant(v[1]) - point[1]]).collect();
        // r^p / ρ = r^p conj(ρ) / r^2.
        let over: Vec<[Dual; 2]> = rho
            .iter()
            .map(|&[a, b]| {
                let square = a * a + b * b;
                let factor = power(square.sqrt()) / square;
                [factor * a, Dual::constant(0.0) - factor * b]
            })
            .collect();
        for i in 0..n {
            let k = (i + 1) % n;
            let cross = rho[i][0] * rho[k][1] - rho[i][1] * rho[k][0];
            let (e, d) = ([0, 1].map(|l| (rho[k][l] - rho[i][l]) / cross), [0, 1].map(|l| over[k][l] - over[i][l]));
            all.push([e[0] * d[0] - e[1] * d[1], e[0] * d[1] + e[1] * d[0]]);
        }
    }
    let total = all.iter().fold(Dual::constant(0.0), |a, b| a + b[0]);
    all.into_iter().map(|[a, b]| [a / total, b / total]).collect()
}

/// Tries shares on a domain; `fault` makes them wrong, for controls.
fn misses(
    kind: &ComplexCoordinates,
    domain: &PlanarDomain,
    power: Option<Power>,
    fault: fn(&mut [Complex], &mut [Complex]),
) -> Misses {
    let n = kind.vertex_count();
    let mut worst = Misses::default();
    let mut next = Vec::new();
    for ring in domain.rings() {
        let begin = next.len();
        next.extend((0..ring.len()).map(|i| begin + (i + 1) % ring.len()));
    }
    let mut previous = vec![0; n];
    next.iter().enumerate().for_each(|(i, &k)| previous[k] = i);
    let vertices: Vec<Complex> = domain.vertices().map(Complex::new).collect();
    let zero = vec![Complex::default(); n];
    let (mut shares, mut by_z, mut by_conjugate, mut values) = (zero.clone(), zero.clone(), zero.clone(), zero);
    for point in points(domain) {
        if domain.vertices().any(|v| v == point)
            || kind.derivatives_into(point, &mut shares, &mut by_z, &mut by_conjugate).is_err()
        {
            continue;
        }
        worst.points += 1;
        fault(&mut shares, &mut by_z);
        let z = Complex::new(point);
        let size: f64 = shares.iter().map(|g| g.size()).sum();
        grow(&mut worst.unity, (sum(shares.iter().copied()) - ONE).size() / size);
        // A similarity, sent through the shares as data of edges.
        let (factor, shift) = (Complex::new([0.3, -1.2]), Complex::new([2.0, 0.7]));
        let image = |i: usize| factor * (vertices[i] - z) + shift;
        let side = |i: usize| {
            let e = vertices[next[i]] - vertices[i];
            (image(i), (image(next[i]) - image(i)) * (z - vertices[i]) / e)
        };
        let sent = sum((0..n).map(|i| shares[i] * (side(i).0 + side(i).1)));
        let largest = (0..n).map(|i| shares[i].size() * side(i).0.size().max(side(i).1.size())).fold(1.0, f64::max);
        grow(&mut worst.similarity, (sent - shift).size() / largest);
        // By vertices: what the kinds have that are made for it.
        kind.values_into(point, &mut values).unwrap();
        for i in 0..n {
            let (h, k) = (previous[i], next[i]);
            let after = (vertices[k] - z) / (vertices[k] - vertices[i]);
            let before = (vertices[h] - z) / (vertices[i] - vertices[h]);
            let miss = shares[i] * after - shares[h] * before - values[i];
            // Shares of short edges are divided by their lengths.
            grow(&mut worst.vertices, miss.size() / (size * (1.0 + after.size() + before.size())));
        }
        let steep: f64 = by_z.iter().chain(&by_conjugate).map(|d| d.size()).sum();
        grow(&mut worst.derivative_laws, sum(by_z.iter().copied()).size() / steep);
        grow(&mut worst.derivative_laws, sum(by_conjugate.iter().copied()).size() / steep);
        grow(&mut worst.conjugate, by_conjugate.iter().map(|d| d.size()).fold(0.0, f64::max) / steep);
        let Some(power) = power else { continue };
        let truth = reference(domain, point, power);
        for i in 0..n {
            let [re, im] = truth[i];
            grow(&mut worst.value, (shares[i] - Complex::new([re.value.0, im.value.0])).size() / size);
            let ([a, b], [c, d]) = (re.gradient.map(|g| g.0), im.gradient.map(|g| g.0));
            let (z_part, other) =
                (Complex::new([0.5 * (a + d), 0.5 * (c - b)]), Complex::new([0.5 * (a - d), 0.5 * (c + b)]));
            grow(&mut worst.derivative, (by_z[i] - z_part).size() / steep);
            grow(&mut worst.derivative, (by_conjugate[i] - other).size() / steep);
        }
    }
    worst
}

fn assert_laws(name: &str, worst: &Misses, tolerance: f64) {
    let Misses { unity, similarity, vertices, derivative_laws, value, derivative, .. } = *worst;
    let laws = [unity, similarity, vertices, derivative_laws, value, derivative];
    assert!(laws.iter().all(|&miss| miss <= tolerance), "{name}: {worst:?}");
    assert!(worst.points > 60, "{name}: {worst:?}");
}

#[test]
fn complex_mean_value_obeys_the_laws_on_every_domain() {
    for (shape, domain) in shapes::convex().into_iter().chain(shapes::general()) {
        let kind = ComplexCoordinates::new(&domain, ComplexFamily::ThreePoint(1.0)).unwrap();
        assert_laws(shape, &misses(&kind, &domain, Some(|r| r), |_, _| ()), 1e-12);
    }
}

#[test]
fn complex_three_point_family_obeys_the_laws_on_convex_polygons() {
    let family: [(f64, Power); 4] =
        [(0.0, |_| Dual::constant(1.0)), (0.5, Dual::sqrt), (2.0, |r| r * r), (-1.0, |r| Dual::constant(1.0) / r)];
    for (shape, domain) in shapes::convex() {
        for (p, power) in family {
            let kind = ComplexCoordinates::new(&domain, ComplexFamily::ThreePoint(p)).unwrap();
            assert_laws(&format!("{shape}, p = {p}"), &misses(&kind, &domain, Some(power), |_, _| ()), 1e-12);
        }
    }
}

#[test]
fn shares_of_cauchy_are_holomorphic_and_make_his_coordinates() {
    for (shape, domain) in shapes::convex().into_iter().chain(shapes::general()) {
        let kind = ComplexCoordinates::new(&domain, ComplexFamily::Cauchy).unwrap();
        let worst = misses(&kind, &domain, None, |_, _| ());
        assert_laws(shape, &worst, 1e-12);
        assert!(worst.conjugate < 1e-12, "{shape}: {worst:?}");
    }
    // Those of mean value are not.
    let (_, domain) = shapes::convex().remove(0);
    let other = ComplexCoordinates::new(&domain, ComplexFamily::ThreePoint(1.0)).unwrap();
    assert!(misses(&other, &domain, None, |_, _| ()).conjugate > 1e-2);
}

#[test]
fn on_an_edge_its_own_share_is_all() {
    for (shape, domain) in shapes::convex().into_iter().take(4) {
        for p in [0.0, 0.5, 1.0, 2.0] {
            let kind = ComplexCoordinates::new(&domain, ComplexFamily::ThreePoint(p)).unwrap();
            let mut shares = vec![Complex::default(); kind.vertex_count()];
            for (number, [a, b]) in domain.edges().enumerate() {
                for share in [0.01, 0.5, 0.8] {
                    let point = [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
                    kind.shares_into(point, &mut shares).unwrap();
                    shares[number] = shares[number] - ONE;
                    assert!(shares.iter().all(|g| g.size() < 1e-12), "{shape}, p = {p}: {shares:?}");
                }
            }
            assert!(kind.shares_into(domain.rings()[0][0], &mut shares).is_err(), "there are none at a vertex");
        }
    }
}

#[test]
fn wrong_shares_break_the_laws() {
    let (_, domain) = shapes::convex().remove(2);
    let kind = ComplexCoordinates::new(&domain, ComplexFamily::ThreePoint(1.0)).unwrap();
    let tried = |fault| misses(&kind, &domain, Some(|r| r), fault);
    let scaled = tried(|shares, _| shares[0].re *= 1.0 + 1e-10);
    assert!(scaled.unity > 1e-12 && scaled.value > 1e-12 && scaled.vertices > 1e-12);
    let turned = tried(|shares, _| shares.rotate_left(1));
    assert!(turned.unity < 1e-12 && turned.similarity < 1e-12 && turned.vertices > 1e-2);
    // Conjugate shares are those of the reflected polygon.
    let reflected = tried(|shares, _| shares.iter_mut().for_each(|g| g.im = -g.im));
    assert!(reflected.unity < 1e-12 && reflected.vertices > 1e-2);
    let steep = tried(|_, slopes| slopes[0].re += 1e-9 * (1.0 + slopes[0].size()));
    assert!(steep.derivative > 1e-12 && steep.derivative_laws > 1e-12 && steep.value < 1e-12);
}
