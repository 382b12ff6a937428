//! Negative controls: each law must notice a map that breaks it.

use homeo::map::{Bijection, Enclosed, EvaluationError, Foliation, Target};
use homeo_core::number::Rational;

use crate::laws;
use crate::points::{Places, Point, rational, target_sample};
use crate::shapes::disks;

/// What is wrong with a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Defect {
    /// Nothing.
    None,
    /// All points go to one.
    Constant,
    /// Two halves lie on one another.
    Folded,
    /// Images leave the target.
    TooLarge,
    /// The boundary goes inside.
    TooSmall,
    /// The inverse is off by very little.
    InverseOff,
    /// Floating point gives what is no number.
    NotANumber,
    /// Errors are larger than stated.
    NoRadius,
    /// Nothing is outside.
    TakesAll,
}

struct Broken<'m> {
    map: &'m Foliation<3>,
    defect: Defect,
}

impl Broken<'_> {
    fn changed(&self, q: Point) -> Point {
        let scaled = |factor: Rational| q.each_ref().map(|x| x * &factor);
        match self.defect {
            Defect::Constant => [0, 1, 2].map(|axis| rational(i64::from(axis < 2), 3)),
            Defect::Folded if q[0] > rational(1, 2) => [&Rational::ONE - &q[0], q[1].clone(), q[2].clone()],
            Defect::TooLarge => scaled(rational(1_000_001, 1_000_000)),
            Defect::TooSmall => scaled(rational(999_999, 1_000_000)),
            _ => q,
        }
    }

    fn disturbed(&self, answer: Result<Enclosed, EvaluationError>) -> Result<Enclosed, EvaluationError> {
        let mut answer = answer?;
        match self.defect {
            Defect::NotANumber => answer.point[1] = f64::NAN,
            Defect::NoRadius => {
                answer.point[0] += 1e-9;
                answer.radius = 0.0;
            }
            _ => {}
        }
        Ok(answer)
    }
}

impl Bijection for Broken<'_> {
    fn forward(&self, point: [f64; 3]) -> Result<Enclosed, EvaluationError> {
        let all = Enclosed { point: [0.5, 0.5, 0.0], radius: 1.0 };
        if self.defect == Defect::TakesAll { Ok(all) } else { self.disturbed(self.map.forward(point)) }
    }

    fn inverse(&self, point: [f64; 3]) -> Result<Enclosed, EvaluationError> {
        self.disturbed(self.map.inverse(point))
    }

    fn forward_exact(&self, point: &Point) -> Result<Point, EvaluationError> {
        self.map.forward_exact(point).map(|q| self.changed(q))
    }

    fn inverse_exact(&self, point: &Point) -> Result<Point, EvaluationError> {
        let mut p = self.map.inverse_exact(point)?;
        if self.defect == Defect::InverseOff {
            p[0] = &p[0] + &Rational::from_f64(1e-200).expect("finite");
        }
        Ok(p)
    }
}

/// The laws that a map breaks, by number.
fn broken_laws(map: &Foliation<3>, defect: Defect) -> Vec<usize> {
    let broken = Broken { map, defect };
    let places = Places::new(map.source());
    let from = places.sample(map, 60, 5);
    let to = target_sample(Target::Square, 60, 6);
    let answers = [
        laws::source_points_come_back(&broken, &Target::Square, &from),
        laws::target_points_come_back(&broken, &Target::Square, &to, &|p| places.is_on_boundary(p)),
        laws::floating_images_enclose(&broken, &Target::Square, &from).map(|_| ()),
        laws::floating_preimages_enclose(&broken, &Target::Square, &to),
        laws::outside_is_refused(&broken, &Target::Square, [99.0, 0.0, 0.0]),
        laws::answers_are_the_same([map, &broken], &Target::Square, &from, &to),
    ];
    answers.iter().enumerate().filter(|(_, answer)| answer.is_err()).map(|(law, _)| law).collect()
}

#[test]
fn laws_notice_broken_maps() {
    let map = crate::built(&disks::grid(4, 4).mesh(), Target::Square);
    assert_eq!(broken_laws(&map, Defect::None), [0; 0]);
    for (defect, law) in [
        (Defect::Constant, 0),
        (Defect::Constant, 1),
        (Defect::Folded, 0),
        (Defect::TooLarge, 0),
        (Defect::TooSmall, 1),
        (Defect::InverseOff, 0),
        (Defect::InverseOff, 1),
        (Defect::NotANumber, 2),
        (Defect::NotANumber, 3),
        (Defect::NoRadius, 2),
        (Defect::NoRadius, 3),
        (Defect::TakesAll, 4),
        (Defect::InverseOff, 5),
    ] {
        assert!(broken_laws(&map, defect).contains(&law), "law {law} does not notice {defect:?}");
    }
}
