//! Forms hold exact results, in rationals.

use homeo_core::number::Rational;

use super::super::{Edge, Number};
use super::Form;

/// Numbers from -1 to 1, from a fixed seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / 2f64.powi(52) - 1.0
    }

    /// Of a magnitude up to `2^most`, or as small.
    fn number(&mut self, most: f64) -> f64 {
        self.next() * 2f64.powi((self.next() * most) as i32)
    }

    fn form(&mut self, most: f64) -> Form {
        let size = self.number(most);
        let part = [0.0, 1e-6, 0.1, 0.6][(self.next().abs() * 4.0) as usize % 4];
        let slopes = [self.next() * part * size, self.next() * part * size];
        Form { middle: size, slopes, radius: (self.next() * part * part * size).abs() }
    }

    /// A place in the box, and of each operand in its radius: ends more often than not.
    fn place(&mut self) -> [f64; 2] {
        [0, 1].map(|_| if self.next() < 0.3 { self.next() } else { self.next().signum() })
    }
}

fn exact(x: f64) -> Rational {
    Rational::from_f64(x).unwrap()
}

fn linear(form: Form, at: [f64; 2]) -> Rational {
    let [a, b] = [0, 1].map(|k| exact(form.slopes[k]) * exact(at[k]));
    exact(form.middle) + (a + b)
}

/// One of the numbers that the form stands for at a place.
fn sample(form: Form, at: [f64; 2], error: f64) -> Rational {
    linear(form, at) + exact(form.radius) * exact(error)
}

/// By how much of its radius, rounded, a number is off at a place; `None` if nothing is known.
fn off(form: Form, at: [f64; 2], value: &Rational) -> Option<f64> {
    let off = value - &linear(form, at);
    form.radius.is_finite().then(|| (off / exact(form.radius)).to_f64().abs())
}

/// Counts how often something is known, and how often it would not be held with a radius ten times smaller.
#[derive(Default)]
struct Count {
    known: usize,
    sharp: usize,
}

impl Count {
    fn see(&mut self, what: &str, form: Form, at: [f64; 2], value: &Rational) {
        if let Some(off) = off(form, at, value) {
            assert!(off <= 1.0, "{what}: {form:?} at {at:?} is off by {off} of its radius");
            self.known += 1;
            self.sharp += usize::from(off > 0.1);
        }
    }
}

#[test]
fn operations_hold_exact_results() {
    let mut random = Random(7);
    let (mut count, mut quotients) = (Count::default(), Count::default());
    for round in 0..4000 {
        let most = if round % 2 == 0 { 3.0 } else { 100.0 };
        let (f, g, factor) = (random.form(most), random.form(most), random.number(most));
        for _ in 0..4 {
            let at = random.place();
            let errors = random.place();
            let (a, b) = (sample(f, at, errors[0]), sample(g, at, errors[1]));
            count.see("sum", f + g, at, &(&a + &b));
            count.see("difference", f - g, at, &(&a - &b));
            count.see("product", f * g, at, &(&a * &b));
            count.see("square", f * f, at, &(&a * &a));
            count.see("multiple", f.by(factor), at, &(&a * &exact(factor)));
            if !b.is_zero() {
                quotients.see("quotient", f / g, at, &(&a / &b));
            }
            let range = f.range();
            assert!(exact(range.low()) <= a && a <= exact(range.high()), "{f:?}");
        }
    }
    assert!(count.sharp > 10_000 && quotients.known > 5_000 && quotients.sharp > 2_000);
}

#[test]
fn lengths_and_what_is_seen_hold_exact_results() {
    let mut random = Random(13);
    let (mut lengths, mut pulls, mut swings) = (Count::default(), Count::default(), Count::default());
    for _ in 0..4000 {
        let ends = [0, 1].map(|_| [random.number(4.0), random.number(4.0)]);
        let position = [random.form(2.0), random.form(2.0)];
        let motion = Form::motion(position);
        let towards = ends.map(|end| [0, 1].map(|k| Form::of(end[k]) - position[k]));
        let [from, to] = towards.map(|vector| Form::sight(vector, &motion));
        let [x, y] = [0, 1].map(|k| Form::of(ends[0][k]) - Form::of(ends[1][k]));
        let edge = Edge { vector: [x, y.opposite()], length: Form::length(x, y).high() };
        let swing = Form::swing(&from, &to, &edge, &motion);
        let length = Form::length(towards[0][0], towards[0][1]);
        for _ in 0..4 {
            let (at, errors) = (random.place(), random.place());
            let point = [0, 1].map(|k| sample(position[k], at, errors[k]));
            let vectors = ends.map(|end| [0, 1].map(|k| &exact(end[k]) - &point[k]));
            let square = |v: &[Rational; 2]| &v[0] * &v[0] + &v[1] * &v[1];
            let squares = [square(&vectors[0]), square(&vectors[1])];
            if squares.iter().any(Rational::is_zero) {
                continue;
            }
            let pull = |end: usize, k: usize| &vectors[end][k] / &squares[end];
            for k in 0..2 {
                pulls.see("pull", from.pull[k], at, &pull(0, k));
                swings.see("swing", swing.pull[k], at, &(pull(1, k) - pull(0, k)));
            }
            // Roots to 60 digits more than a double has.
            let root = |square: &Rational| root(square);
            let distance = root(&squares[0]);
            lengths.see("length", length, at, &distance);
            lengths.see("inverse", from.inverse, at, &(&Rational::ONE / &distance));
            lengths.see("unit", from.unit[0], at, &(&vectors[0][0] / &distance));
            // tan(α / 2) = sin α / (1 + cos α), both times both distances.
            let [[a, b], [c, d]] = &vectors;
            let both = root(&squares[0]) * root(&squares[1]);
            let (sine, one) = (a * d - b * c, both + (a * c + b * d));
            if !one.is_zero() {
                swings.see("half tangent", Form::half_tangent(&from, &to, &swing), at, &(sine / one));
            }
        }
    }
    assert!(lengths.sharp > 5_000 && pulls.sharp > 2_000 && swings.sharp > 2_000);
}

/// A root, to twice the digits of a double and more, by Newton's method in rationals.
fn root(square: &Rational) -> Rational {
    let mut root = exact(square.to_f64().sqrt());
    for _ in 0..2 {
        root = (&root + &(square / &root)) / exact(2.0);
    }
    root
}

#[test]
fn what_is_unknown_stays_so() {
    let unknown = Form::of(1.0) / Form { middle: 1.0, slopes: [0.5, 0.0], radius: 0.5 };
    let [zero, large] = [0.0, 1e300].map(Form::of);
    assert!(unknown.radius().is_nan());
    for other in [zero, large, Form { middle: 1.0, slopes: [0.0; 2], radius: f64::INFINITY }] {
        for result in [unknown + other, other - unknown, unknown * other, other / unknown, Form::length(unknown, other)]
        {
            assert!(!(result.low() > 0.0) && !(result.high() < 0.0), "{result:?}");
        }
    }
    let infinite = large * large;
    assert!(!(infinite.low() > 0.0), "an overflow is no number: {infinite:?}");
    let motion = Form::motion([unknown, zero]);
    let sight = Form::sight([large, unknown], &motion);
    assert!(sight.inverse.radius().is_nan() && sight.unit[0].range().along(1).radius().is_nan());
}
