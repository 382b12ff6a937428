//! Maps by coordinates are not always injective: what the source says of them.

use super::shapes;
use crate::coordinates::*;
use homeo_core::planar::{PlanarDomain, Point2};

fn kinds(domain: &PlanarDomain) -> Vec<(&'static str, Box<dyn PlanarCoordinates>)> {
    vec![
        ("mean value", Box::new(MeanValue::new(domain))),
        ("Wachspress", Box::new(Wachspress::new(domain).unwrap())),
        ("harmonic", Box::new(DiscreteHarmonic::new(domain).unwrap())),
        ("p = 1/2", Box::new(ThreePoint::new(domain, 0.5).unwrap())),
        ("positive", Box::new(PositiveMeanValue::new(domain))),
        ("entropy", Box::new(MaximumEntropy::new(domain))),
    ]
}

/// The image of a point, and the determinant of the map there.
fn image(kind: &dyn PlanarCoordinates, target: &[Point2], point: Point2) -> (Point2, f64) {
    let n = target.len();
    let (mut values, mut gradients) = (vec![0.0; n], vec![[0.0; 2]; n]);
    kind.gradients_into(point, &mut values, &mut gradients).unwrap();
    let sum = |f: &dyn Fn(usize) -> f64| (0..n).map(f).sum::<f64>();
    let d = |k: usize, l: usize| sum(&|i| gradients[i][l] * target[i][k]);
    let place = [sum(&|i| values[i] * target[i][0]), sum(&|i| values[i] * target[i][1])];
    (place, d(0, 0) * d(1, 1) - d(0, 1) * d(1, 0))
}

/// Section 2.1.2 (after Jacobson 2012): of a square round the origin one corner is moved, `v_3` to `w`. As the others stay,
/// `f(0) = phi_3 (w - v_3)`, which is `w` itself for `w = -phi_3 / (1 - phi_3) v_3`: the origin goes where a vertex goes.
/// That is the case `phi_3 < 1/2` of the source; by symmetry `phi_3 = 1/4` for every kind.
#[test]
fn every_kind_has_a_quadrilateral_where_its_map_is_not_injective() {
    let source = vec![[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let domain = shapes::domain(vec![source.clone()]);
    for (name, kind) in kinds(&domain) {
        let mut values = [0.0; 4];
        kind.values_into([0.0, 0.0], &mut values).unwrap();
        let share = values[2];
        let w = [share / (1.0 - share), 0.0];
        let target = vec![source[0], source[1], w, source[3]];
        assert!(PlanarDomain::new(vec![target.clone()]).is_ok(), "{name}");
        let (place, _) = image(&*kind, &target, [0.0, 0.0]);
        // An inner point goes where a vertex goes already.
        assert!((place[0] - w[0]).hypot(place[1] - w[1]) < 1e-14, "{name}: {place:?} {w:?}");
        let folds = shapes::inside(&domain, 2000).into_iter().any(|p| image(&*kind, &target, p).1 < -1e-3);
        assert!(folds, "{name}");
    }
}
