//! Adaptive integration with an estimate of the error.

/// Places of the rule of 15 points from -1 to 1: the positive ones, outermost first, then 0.
const PLACES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_48,
    0.0,
];
/// Weights of these places (Kronrod).
const WEIGHTS: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_56,
    0.104_790_010_322_250_19,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_42,
    0.204_432_940_075_298_89,
    0.209_482_141_084_727_82,
];
/// Weights of every second place, the rule of seven points (Gauss).
const INNER: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_64, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

/// The integral of some functions over an interval, and by how much the rule of seven points differs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<const F: usize> {
    ends: [f64; 2],
    pub value: [f64; F],
    pub difference: [f64; F],
}

impl<const F: usize> Piece<F> {
    fn new(ends: [f64; 2], integrand: &impl Fn(f64) -> [f64; F]) -> Self {
        let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
        let (mut value, mut other) = ([0.0; F], [0.0; F]);
        for (number, (&place, &weight)) in PLACES.iter().zip(&WEIGHTS).enumerate() {
            let sides = if place == 0.0 { &[1.0][..] } else { &[-1.0, 1.0][..] };
            for side in sides {
                let here = integrand(middle + side * half * place);
                for f in 0..F {
                    value[f] += half * weight * here[f];
                    other[f] += if number % 2 == 1 { half * INNER[number / 2] * here[f] } else { 0.0 };
                }
            }
        }
        Self { ends, value, difference: std::array::from_fn(|f| (value[f] - other[f]).abs()) }
    }
}

/// Sums of the pieces of an interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Integral<const F: usize> {
    pub value: [f64; F],
    pub difference: [f64; F],
}

/// Integrates between given places, bisecting the piece of the largest `error` until `is_enough` or there are `limit` pieces.
/// Sums are made anew each time, in a fixed order.
pub(super) fn integrate<const F: usize>(
    places: &[f64],
    limit: usize,
    integrand: impl Fn(f64) -> [f64; F],
    error: impl Fn(&Piece<F>) -> f64,
    is_enough: impl Fn(&Integral<F>) -> bool,
) -> Integral<F> {
    let mut pieces: Vec<_> = places.windows(2).map(|ends| Piece::new([ends[0], ends[1]], &integrand)).collect();
    loop {
        let sum = |part: &dyn Fn(&Piece<F>) -> [f64; F]| {
            pieces.iter().map(part).fold([0.0; F], |all, here| std::array::from_fn(|f| all[f] + here[f]))
        };
        let integral = Integral { value: sum(&|piece| piece.value), difference: sum(&|piece| piece.difference) };
        let worst = (0..pieces.len()).max_by(|&a, &b| error(&pieces[a]).total_cmp(&error(&pieces[b])));
        let Some(worst) = worst.filter(|_| pieces.len() < limit && !is_enough(&integral)) else { return integral };
        let [from, to] = pieces[worst].ends;
        let middle = 0.5 * (from + to);
        pieces[worst] = Piece::new([from, middle], &integrand);
        pieces.push(Piece::new([middle, to], &integrand));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly_up_to_the_degrees_of_both_rules() {
        let missed = |degree: i32| {
            let piece = Piece::new([0.0, 2.0], &|x: f64| [(x - 1.0).powi(degree)]);
            ((piece.value[0] - 2.0 / f64::from(degree + 1)).abs(), piece.difference[0])
        };
        for degree in (0..=22).step_by(2) {
            assert!(missed(degree).0 < 1e-14, "degree {degree}: {:?}", missed(degree));
        }
        assert!((0..=12).step_by(2).all(|degree| missed(degree).1 < 1e-14), "the inner rule has degree 13");
        assert!(missed(14).1 > 1e-6 && missed(24).0 > 1e-10, "and no more: a control");
    }

    #[test]
    fn a_peak_is_found_and_a_limit_is_kept() {
        let peak = |x: f64| [1e-6 / (x * x + 1e-12)];
        let run =
            |limit| integrate(&[-1.0, 0.1, 1.0], limit, peak, |p| p.difference[0], |all| all.difference[0] < 1e-10);
        let exact = 2.0 * 1e6f64.atan();
        assert!((run(200).value[0] - exact).abs() < 1e-10, "{:?}", run(200));
        assert!(run(5).difference[0] > 1e-8, "five pieces are not enough, and this is seen");
    }
}
