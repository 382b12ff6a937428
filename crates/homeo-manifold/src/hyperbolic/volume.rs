//! The volume of a truncated tetrahedron.
//!
//! Source: Murakami and Yano 2005, and Ushijima 2006 for truncated ones. With `a = exp(i A)` and so on, `A`, `B`, `C` the
//! dihedral angles at the edges of one corner and `D`, `E`, `F` at those opposite,
//!
//! ```text
//! U(z) = ½ (Li(z) + Li(abde z) + Li(acdf z) + Li(bcef z) - Li(-abc z) - Li(-aef z) - Li(-bdf z) - Li(-cde z))
//! z±   = -2 (sin A sin D + sin B sin E + sin C sin F ± sqrt(det g)) / (ad + be + cf + abf + ace + bcd + def + abcdef)
//! V    = ½ Im (U(z-) - U(z+)),
//! ```
//!
//! `Li` the dilogarithm and `g` the Gram matrix of the angles. As `det g < 0`, `z±` have absolute value 1, so that the
//! imaginary parts are values of Clausen's function at real angles. In the quantities of [`Tetrahedron`],
//! `det g = -Δ³ / (D_0 D_1 D_2 D_3)`.

use super::clausen::Clausen;
use super::enclosure::{Enclosure, Real};
use super::tetrahedron::Tetrahedron;

/// A complex number.
#[derive(Clone, Copy)]
struct Complex([Enclosure; 2]);

impl Complex {
    fn times(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.0, other.0);
        Self([a * c - b * d, a * d + b * c])
    }

    fn plus(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }
}

/// Volumes of tetrahedra; holds the coefficients of series.
///
/// # Example
/// ```
/// use homeo_manifold::hyperbolic::{Enclosure, Tetrahedron, Volumes};
/// // Short edges: near the regular ideal octahedron, of volume 8 Λ(π/4) = 3.66386...
/// let short = Tetrahedron::new([Enclosure::exact(1.0 + 1e-9); 6]);
/// let volume = Volumes::new().of(&short);
/// assert!((volume.middle() - 3.663_862).abs() < 1e-5);
/// ```
pub struct Volumes {
    clausen: Clausen,
}

impl Default for Volumes {
    fn default() -> Self {
        Self::new()
    }
}

impl Volumes {
    /// Computes the coefficients.
    pub fn new() -> Self {
        Self { clausen: Clausen::new() }
    }

    /// The volume of a tetrahedron whose discriminant is positive.
    pub fn of(&self, tetrahedron: &Tetrahedron<Enclosure>) -> Enclosure {
        let angles = tetrahedron.angles();
        let units = tetrahedron.directions().map(Complex);
        let [a, b, c, f, e, d] = [0, 1, 2, 3, 4, 5];
        let product = |edges: &[usize]| edges.iter().map(|&edge| units[edge]).reduce(Complex::times);
        let terms: [&[usize]; 8] =
            [&[a, d], &[b, e], &[c, f], &[a, b, f], &[a, c, e], &[b, c, d], &[d, e, f], &[a, b, c, d, e, f]];
        let below = terms.into_iter().filter_map(product).reduce(Complex::plus);
        let Some(below) = below else { return Enclosure::WHOLE };
        let sines = |x: usize, y: usize| units[x].0[1] * units[y].0[1];
        let root = tetrahedron.angle_root();
        let above = Enclosure::angle(sines(a, d) + sines(b, e) + sines(c, f), root);
        let half_turn = Enclosure::pi();
        let middle = half_turn - Enclosure::angle(below.0[0], below.0[1]);
        let sum = |edges: &[usize]| edges.iter().fold(Enclosure::exact(0.0), |sum, &edge| sum + angles[edge]);
        let plus: [&[usize]; 4] = [&[], &[a, b, d, e], &[a, c, d, f], &[b, c, e, f]];
        let minus: [&[usize]; 4] = [&[a, b, c], &[a, e, f], &[b, d, f], &[c, d, e]];
        let mut volume = Enclosure::exact(0.0);
        for (argument, is_first) in [(middle - above, true), (middle + above, false)] {
            let value = |edges: &[usize], turn| self.clausen.at(argument + sum(edges) + turn);
            let gained =
                plus.iter().fold(Enclosure::exact(0.0), |total, edges| total + value(edges, Enclosure::exact(0.0)));
            let lost = minus.iter().fold(Enclosure::exact(0.0), |total, edges| total + value(edges, half_turn));
            volume = if is_first { volume + gained - lost } else { volume - gained + lost };
        }
        volume * Enclosure::exact(0.25)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn volume(volumes: &Volumes, lengths: [f64; 6]) -> Enclosure {
        volumes.of(&Tetrahedron::new(lengths.map(|length| Enclosure::exact(length.cosh()))))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        /// Schläfli: `dV = -½ Σ l dθ` along a segment of lengths, by Gauss' rule with five points.
        #[test]
        fn volumes_differ_as_schlaefli_says(start in proptest::array::uniform6(0.4..1.6_f64), by in proptest::array::uniform6(-0.05..0.05_f64)) {
            const NODES: [(f64, f64); 5] = [
                (0.0, 0.568_888_888_888_888_9),
                (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
                (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
                (0.906_179_845_938_664, 0.236_926_885_056_189_08),
                (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
            ];
            let at = |t: f64| std::array::from_fn(|k| start[k] + t * by[k]);
            let proper = |t| Tetrahedron::new(at(t).map(f64::cosh)).discriminant() > 0.3;
            prop_assume!(proper(-1.0) && proper(0.0) && proper(1.0));
            let integral: f64 = NODES.iter().map(|&(t, weight)| {
                let lengths: [f64; 6] = at(t);
                let jacobian = Tetrahedron::new(lengths.map(f64::cosh)).jacobian();
                let turn = |edge: usize| (0..6).map(|k| jacobian[edge][k] * by[k]).sum::<f64>();
                weight * (0..6).map(|edge| -0.5 * lengths[edge] * turn(edge)).sum::<f64>()
            }).sum();
            let volumes = Volumes::new();
            let found = volume(&volumes, at(1.0)) - volume(&volumes, at(-1.0));
            prop_assert!((found.middle() - integral).abs() < 1e-9 + found.width(), "{found:?} {integral}");
            prop_assert!(found.width() < 1e-9, "{found:?}");
            let total = volume(&volumes, start);
            prop_assert!(total.low() > 0.0 && total.high() < 3.67, "{total:?}");
        }
    }
}
