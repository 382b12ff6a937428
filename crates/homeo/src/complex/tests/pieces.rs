//! Pieces cover the domain, and enclosures in them hold samples.

use homeo_core::planar::Point2;
use homeo_core::predicate::{Sign, orient2d};

use super::{Random, pairs};
use crate::complex::chart::Cover;
use crate::complex::frame::{Chart, Frame, Outline};
use crate::complex::guide::Guide;
use crate::composite::number::Form;

/// Whether a ball with its radius times `factor` holds a number, but for rounding of the number itself.
fn holds(ball: Form, value: f64, factor: f64, slack: f64) -> bool {
    (ball.middle - value).abs() <= ball.radius() * factor + slack
}

#[test]
fn enclosures_hold_samples() {
    let mut random = Random(11);
    let (mut known, mut missed) = (0, 0);
    for (name, pair) in pairs() {
        let outline = Outline::new(&pair.source, &pair.target);
        let speeds = random.speeds(outline.count(), 4);
        let cover = Cover::new(&outline, &pair.source);
        let mut wide = Frame::<Form>::new(&outline, &speeds);
        let mut exact = Frame::<f64>::new(&outline, &speeds);
        for piece in &cover.pieces {
            for size in [0.2, 0.02, 1e-3] {
                let sides: [[f64; 2]; 2] = std::array::from_fn(|k| {
                    let [low, high] = piece.sides[k];
                    let from =
                        low + (high - low) * (1.0 - size) * random.unit().min(0.9) * f64::from(random.unit() > 0.3);
                    [from, from + size * (high - low)]
                });
                let middle = sides.map(|[a, b]| 0.5 * (a + b));
                let point = piece.place(&outline, middle);
                let guide = Guide::at(&outline, point, piece.vertex(), piece.direction(middle[1]));
                let found = wide.evaluate(
                    &piece.chart,
                    [0, 1].map(|k| Form::between(sides[k][0], sides[k][1]).along(k)),
                    &guide,
                );
                if !found.determinant().radius().is_finite() {
                    continue;
                }
                known += 1;
                for _ in 0..8 {
                    let at = sides.map(|[a, b]| a + (b - a) * random.unit());
                    let sample = exact.evaluate(&piece.rounded(), at, &guide);
                    let pairs = [
                        (found.value[0], sample.value[0]),
                        (found.along[0][1], sample.along[0][1]),
                        (found.along[1][0], sample.along[1][0]),
                        (found.determinant(), sample.determinant()),
                    ];
                    for (ball, value) in pairs {
                        assert!(holds(ball, value, 1.0, 1e-10 * (1.0 + value.abs())), "{name} {at:?} {ball:?} {value}");
                        missed += usize::from(!holds(ball, value, 0.05, 0.0));
                    }
                }
            }
        }
    }
    assert!(known > 800, "{known} boxes have enclosures");
    assert!(missed > 100, "balls a twentieth as large miss samples: {missed}");
}

/// Within its disk a vertex's corner is in the triangles; in one that is too large it is not.
#[test]
fn corners_are_covered() {
    let mut random = Random(3);
    let (mut inside, mut beyond) = (0, 0);
    for (name, pair) in pairs() {
        let outline = Outline::new(&pair.source, &pair.target);
        let cover = Cover::new(&outline, &pair.source);
        assert!(cover.disks.iter().all(|radius| *radius > 0.0), "{name}: {:?}", cover.disks);
        for vertex in 0..outline.count() {
            let v = outline.vertices[vertex];
            for _ in 0..200 {
                let (y, x) = (std::f64::consts::TAU * random.unit()).sin_cos();
                let r = cover.disks[vertex] * random.unit() * 2.5;
                let point = [v[0] + r * x, v[1] + r * y];
                let is_in = |[p, q]: [Point2; 2]| {
                    let corners = [v, p, q];
                    (0..3).all(|k| orient2d(corners[k], corners[(k + 1) % 3], point) != Sign::Negative)
                };
                let triangles = cover.pieces.iter().filter_map(|piece| match piece.chart {
                    Chart::Corner { vertex: own, a, b } if own == vertex => {
                        Some([a, b].map(|e| [0, 1].map(|k| v[k] + e[k].middle)))
                    }
                    _ => None,
                });
                let is_covered = triangles.into_iter().any(is_in);
                let is_far = outline.vertices[vertex].iter().any(|c| c.abs() > 5.0);
                if !pair.source.contains(point) || is_far {
                    continue;
                }
                if r < cover.disks[vertex] {
                    assert!(is_covered, "{name} {vertex} {point:?}");
                    inside += 1;
                } else {
                    beyond += usize::from(!is_covered);
                }
            }
        }
    }
    assert!(inside > 500 && beyond > 100, "{inside} {beyond}");
}
