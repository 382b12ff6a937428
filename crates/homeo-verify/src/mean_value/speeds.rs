//! What speeds along the edges add to a mean value map: the sum over edges in (1) of `docs/theory/complex.md`.
//!
//! An edge from a vertex to the next one, with images `h` and `h'`, adds `γ (h' - h) (σ(x) - x)` to the numerator: `x` is
//! the place of the point along the line of the edge, and with the half tangent `t` and the distances `r`, `r'` of the ends
//!
//! * `γ = t (1/r + 1/r') + i (1/r' - 1/r)`;
//! * `σ(x) - x = x (1 - x) q(x)`, as speeds `σ` keep 0 and 1; `q` is a polynomial in Bernstein form.
//!
//! At an end of the edge `s γ` and `(σ(x) - x) / s` stand in their place, which are finite up to `s = 0`.

use super::{Dual, Form, Frame, Seen, Touch, Vector, difference, dot, vector};

/// Degrees of speeds go up to this.
pub(crate) const MOST_DEGREE: usize = 8;

/// The polynomials `q` of all edges.
pub(crate) struct Speeds {
    /// Of each edge, for each order: the differences of the Bernstein coefficients, times a binomial coefficient.
    differences: Vec<Vec<Vec<Form>>>,
}

impl Speeds {
    /// Of the control values of all edges, one edge after the other, `degree + 1` each; the degree is 2 at least.
    pub(crate) fn new(control_values: &[f64], degree: usize) -> Speeds {
        let of_edge = |values: &[f64]| differences(coefficients(values, degree));
        Speeds { differences: control_values.chunks_exact(degree + 1).map(of_edge).collect() }
    }

    /// `q` of an edge, by its derivatives at the middle of what is known of `x`: so small numbers are raised to powers.
    fn quotient(&self, edge: usize, x: Dual) -> Dual {
        let middle = Form::exact(x.0[0].middle);
        let step = x - Dual::constant(middle);
        let add = |sum: Dual, row: &Vec<Form>| sum * step + Dual::constant(in_bernstein_form(row, middle));
        self.differences[edge].iter().rev().fold(Dual::ZERO, add)
    }
}

/// The Bernstein coefficients of `(σ(x) - x) / (x (1 - x))`, of degree `d - 2`: those of `σ(x) - x` are `c_k - k / d`, and
/// binomial coefficients of `d` over those of `d - 2` make the factors.
fn coefficients(values: &[f64], degree: usize) -> Vec<Form> {
    let number = |n: usize| Form::exact(n as f64);
    let of = |k: usize| {
        let deviation = number(degree) * Form::exact(values[k]) - number(k);
        deviation * number(degree - 1) * (number(k) * number(degree - k)).inverse()
    };
    (1..degree).map(of).collect()
}

/// Row `k`: the derivative of order `k` over `k!`, in Bernstein form.
fn differences(coefficients: Vec<Form>) -> Vec<Vec<Form>> {
    let count = coefficients.len();
    let mut rows = vec![coefficients];
    for k in 1..count {
        let factor = Form::exact((count - k) as f64) * Form::exact(k as f64).inverse();
        let row = rows[k - 1].windows(2).map(|pair| factor * (pair[1] - pair[0])).collect();
        rows.push(row);
    }
    rows
}

/// De Casteljau's algorithm.
fn in_bernstein_form(coefficients: &[Form], x: Form) -> Form {
    let mut points = [Form::ZERO; MOST_DEGREE];
    points[..coefficients.len()].copy_from_slice(coefficients);
    let rest = Form::ONE - x;
    for count in (1..coefficients.len()).rev() {
        for k in 0..count {
            points[k] = rest * points[k] + x * points[k + 1];
        }
    }
    points[0]
}

/// An edge on which the image has a speed of its own.
pub(super) struct Line {
    /// The edge over its squared length: a product with it measures places along the edge.
    measure: Vector,
    /// The vector from the image of its first vertex to that of the second one.
    image: Vector,
}

impl Line {
    /// From the vertices of an edge, and from their images.
    pub(super) fn new([from, to]: [[f64; 2]; 2], [image, next]: [[f64; 2]; 2]) -> Line {
        let edge = difference(to, from);
        let by_square = dot(edge, edge).inverse();
        Line { measure: vector(|k| edge[k] * by_square), image: difference(next, image) }
    }

    /// Where the point is along the edge, seen from it; the point moves by `motion`.
    pub(super) fn place(&self, seen: &Seen, motion: [Vector; 2]) -> Dual {
        let [first, second] = motion.map(|moved| dot(moved, self.measure));
        Dual([-dot(seen.towards, self.measure), first, second])
    }

    /// `γ (h' - h) (σ(x) - x)`.
    fn term(&self, [real, imaginary]: [Dual; 2], deviation: Dual) -> [Dual; 2] {
        let ([re, im], [x, y]) = ([real * deviation, imaginary * deviation], self.image);
        [re.scaled(x) - im.scaled(y), re.scaled(y) + im.scaled(x)]
    }
}

impl Frame<'_> {
    /// The sum over all edges but those at the apex.
    pub(super) fn added_by_edges(&self, apex: Option<usize>) -> [Dual; 2] {
        let mut sums = [Dual::ZERO; 2];
        let Some(speeds) = self.step.speeds else { return sums };
        for (i, line) in self.lines.iter().enumerate() {
            let j = self.step.next[i] as usize;
            if apex.is_none_or(|v| v != i && v != j) {
                let (before, after) = (self.seen[i].inverse, self.seen[j].inverse);
                let x = self.places[i];
                let deviation = x * (Dual::constant(Form::ONE) - x) * speeds.quotient(i, x);
                let [re, im] = line.term([self.tangents[i] * (before + after), after - before], deviation);
                sums = [sums[0] + re, sums[1] + im];
            }
        }
        sums
    }

    /// That of an edge between the apex and another vertex. What is given: its half tangent, `1 / |e|`, `s`, and a factor, by
    /// which the tangent is multiplied already.
    pub(super) fn added_at_apex(
        &self,
        [edge, other]: [usize; 2],
        end: Touch,
        along: Vector,
        [tangent, by_length, s, factor]: [Dual; 4],
    ) -> [Dual; 2] {
        let Some(speeds) = self.step.speeds else { return [Dual::ZERO; 2] };
        let (line, one) = (&self.lines[edge], Dual::constant(Form::ONE));
        let rate = Dual([dot(along, line.measure), Form::ZERO, dot(self.chart.axes[1], line.measure)]);
        let rate = if end == Touch::Begin { rate } else { -rate };
        // The distance from the apex along the edge is `s` times the rate.
        let from_apex = s * rate;
        let x = if end == Touch::Begin { from_apex } else { one - from_apex };
        let deviation = rate * (one - from_apex) * speeds.quotient(edge, x);
        let far = s * self.seen[other].inverse;
        let turned = factor * (far - by_length);
        let turned = if end == Touch::Begin { turned } else { -turned };
        line.term([tangent * (by_length + far), turned], deviation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the definition: the sum of control values times Bernstein polynomials.
    fn speed(values: &[f64], x: f64) -> f64 {
        let degree = values.len() - 1;
        let mut binomial = 1.0;
        let mut sum = 0.0;
        for (k, value) in values.iter().enumerate() {
            sum += binomial * value * x.powi(k as i32) * (1.0 - x).powi((degree - k) as i32);
            binomial *= (degree - k) as f64 / (k + 1) as f64;
        }
        sum
    }

    #[test]
    fn quotients_hold_what_the_definition_gives() {
        let values: &[&[f64]] =
            &[&[0.0, 0.3, 1.0], &[0.0, 0.5, 0.6, 0.9, 1.0], &[0.0, 0.01, 0.02, 0.3, 0.4, 0.7, 0.8, 0.9, 1.0]];
        let mut count = 0;
        for values in values {
            let speeds = Speeds::new(values, values.len() - 1);
            for k in -7..14 {
                let x = f64::from(k) / 5.0 + 0.03;
                let known = Dual([Form::between([x - 0.01, x + 0.01], 0), Form::ONE, Form::ZERO]);
                let found = speeds.quotient(0, known).0;
                let quotient = |x: f64| (speed(values, x) - x) / (x * (1.0 - x));
                let slope = |x: f64| (quotient(x + 1e-5) - quotient(x - 1e-5)) / 2e-5;
                for at in [x - 0.01, x, x + 0.01] {
                    let errors = [quotient(at) - found[0].middle, slope(at) - found[1].middle];
                    let allowed =
                        [found[0].deviation(), found[1].deviation()].map(|radius| radius + 1e-6 * (1.0 + radius));
                    assert!(
                        errors[0].abs() <= allowed[0] && errors[1].abs() <= allowed[1],
                        "{values:?} {at}: {found:?}"
                    );
                    count += 1;
                }
                // Not so where the control values are others.
                let wrong = Speeds::new(&values.iter().map(|c| c * c).collect::<Vec<_>>(), values.len() - 1);
                let off = wrong.quotient(0, Dual::constant(Form::exact(x))).0[0].middle - quotient(x);
                assert!(off.abs() > 1e-6, "{values:?} {x}");
            }
        }
        assert_eq!(count, 189);
    }
}
