//! Laws of transfinite mean value coordinates and of their maps, with controls that must fail.

use std::f64::consts::TAU;

use homeo::coordinates::{
    ClosedCurve, MeanValue, PlanarCoordinates, TransfiniteComposite, TransfiniteError, TransfiniteMeanValue,
    TransfiniteParams,
};
use homeo_core::planar::PlanarDomain;

/// A curve by its distance from the origin, `1 + size cos(teeth v)`, stretched by 2 and moved.
#[derive(Clone, Copy, Debug)]
struct Flower {
    size: f64,
    teeth: f64,
    /// The velocity is multiplied by 1 plus this times the sine: not zero is wrong.
    defect: f64,
}

impl ClosedCurve for Flower {
    fn at(&self, parameter: f64) -> [[f64; 2]; 2] {
        let v = TAU * parameter;
        let ((s, c), (sn, cn)) = (v.sin_cos(), (self.teeth * v).sin_cos());
        let (r, slope) = (1.0 + self.size * cn, -self.size * self.teeth * sn);
        let factor = TAU * (1.0 + self.defect * s);
        let velocity = [factor * 2.0 * (slope * c - r * s), factor * (slope * s + r * c)];
        [[3.0 + 2.0 * r * c, r * s - 1.0], velocity]
    }
}

const ELLIPSE: Flower = Flower { size: 0.0, teeth: 1.0, defect: 0.0 };
/// Not convex.
const FLOWER: Flower = Flower { size: 0.3, teeth: 5.0, defect: 0.0 };

/// Points at parts of the way from the centre to the curve.
fn points(curve: &Flower, parts: &[f64]) -> Vec<(f64, f64, [f64; 2])> {
    let at = |part: f64, u: f64| [3.0 + part * (curve.at(u)[0][0] - 3.0), -1.0 + part * (curve.at(u)[0][1] + 1.0)];
    parts
        .iter()
        .flat_map(|&part| (0..17).map(move |k| (part, f64::from(k) / 17.0, at(part, f64::from(k) / 17.0))))
        .collect()
}

fn reproduced(curve: Flower) -> f64 {
    let kind = TransfiniteMeanValue::new(curve, TransfiniteParams::default());
    let parts = [0.0, 0.3, 0.7, 0.99, 1.0 - 1e-5, 1.0 - 1e-9, 1.0 - 1e-12];
    let missed = |(_, _, point): (f64, f64, [f64; 2])| {
        let [x, y] = kind.interpolate(point, |u| curve.at(u)[0]).unwrap();
        (x - point[0]).hypot(y - point[1])
    };
    points(&curve, &parts).into_iter().map(missed).fold(0.0, f64::max)
}

#[test]
fn the_point_is_reproduced_up_to_the_curve() {
    for curve in [ELLIPSE, FLOWER] {
        assert!(reproduced(curve) < 1e-9, "{curve:?}: {:e}", reproduced(curve));
        let wrong = Flower { defect: 0.1, ..curve };
        assert!(reproduced(wrong) > 1e-3, "a control: {:e}", reproduced(wrong));
    }
}

#[test]
fn data_are_interpolated() {
    let data = |u: f64| [(3.0 * TAU * u).sin(), (TAU * u).cos().powi(3)];
    for curve in [ELLIPSE, FLOWER] {
        let kind = TransfiniteMeanValue::new(curve, TransfiniteParams::default());
        for (part, u, point) in points(&curve, &[1.0 - 1e-4, 1.0 - 1e-8, 1.0 - 1e-12, 1.0]) {
            let ([x, y], [a, b]) = (kind.interpolate(point, data).unwrap(), data(u));
            let miss = (x - a).hypot(y - b);
            assert!(miss <= 200.0 * (1.0 - part) + 1e-9, "{part} {u}: missed by {miss:e}");
        }
        let middle = kind.interpolate([3.0, -1.0], data).unwrap();
        assert!((middle[1] - data(0.0)[1]).abs() > 0.5, "inside it is something else: a control");
    }
}

/// The greatest difference from coordinates of an inscribed polygon.
fn against_polygon(curve: Flower, vertices: u32) -> f64 {
    let parameter = |i: usize| i as f64 / f64::from(vertices);
    let ring: Vec<[f64; 2]> = (0..vertices as usize).map(|i| curve.at(parameter(i))[0]).collect();
    let polygon = MeanValue::new(&PlanarDomain::new(vec![ring]).unwrap());
    let kind = TransfiniteMeanValue::new(curve, TransfiniteParams::default());
    let data = |u: f64| [(2.0 * TAU * u).cos(), (TAU * u).sin().powi(3)];
    let mut values = vec![0.0; vertices as usize];
    let mut missed = |(_, _, point): (f64, f64, [f64; 2])| {
        polygon.values_into(point, &mut values).unwrap();
        let sum = |k: usize| values.iter().enumerate().map(|(i, value)| value * data(parameter(i))[k]).sum::<f64>();
        let [x, y] = kind.interpolate(point, data).unwrap();
        (x - sum(0)).hypot(y - sum(1))
    };
    points(&curve, &[0.0, 0.4, 0.8]).into_iter().map(&mut missed).fold(0.0, f64::max)
}

#[test]
fn coordinates_of_inscribed_polygons_tend_to_those_of_the_curve() {
    for curve in [ELLIPSE, FLOWER] {
        let [coarse, fine] = [200, 800].map(|vertices| against_polygon(curve, vertices));
        let order = (coarse / fine).log2() / 2.0;
        assert!(fine < 1e-3 && (1.9..2.1).contains(&order), "{curve:?}: {coarse:e} {fine:e}, order {order}");
    }
}

#[test]
fn what_is_wrong_is_said() {
    let params = TransfiniteParams::default();
    let kind = TransfiniteMeanValue::new(FLOWER, params);
    let nothing = |_: f64| [0.0, 1.0];
    assert!(matches!(kind.interpolate([9.0, 0.0], nothing), Err(TransfiniteError::NotInside { .. })));
    let clockwise = |u: f64| {
        let [point, [x, y]] = ELLIPSE.at(1.0 - u);
        [point, [-x, -y]]
    };
    let kind = TransfiniteMeanValue::new(clockwise, params);
    assert!(matches!(kind.interpolate([3.0, -1.0], nothing), Err(TransfiniteError::NotInside { .. })));
    let hasty = TransfiniteMeanValue::new(FLOWER, TransfiniteParams { pieces: 9, ..params });
    let near = [3.0 + 2.6 * (1.0 - 1e-3), -1.0];
    let found = hasty.interpolate(near, |u| FLOWER.at(u)[0]);
    assert!(matches!(found, Err(TransfiniteError::NotReached { estimate, .. }) if estimate > 1e-9), "{found:?}");
    assert!(TransfiniteComposite::new(vec![ELLIPSE], params).is_err());
}

/// How far random points are from where they come back to.
fn there_and_back(steps: u32) -> f64 {
    let between = |k: u32| Flower { size: 0.3 * f64::from(k) / f64::from(steps), ..FLOWER };
    let params = TransfiniteParams { tolerance: 1e-8, ..TransfiniteParams::default() };
    let map = TransfiniteComposite::new((0..=steps).map(between).collect(), params).unwrap();
    let missed = |(_, _, point): (f64, f64, [f64; 2])| {
        let [x, y] = map.backward(map.forward(point).unwrap()).unwrap();
        (x - point[0]).hypot(y - point[1])
    };
    points(&ELLIPSE, &[0.5, 0.9]).into_iter().map(missed).fold(0.0, f64::max)
}

#[test]
fn composites_there_and_back_tend_to_the_identity() {
    let [coarse, fine] = [4, 16].map(there_and_back);
    let order = (coarse / fine).log2() / 2.0;
    assert!(coarse > 1e-4 && (0.8..1.3).contains(&order), "{coarse:e} {fine:e}, order {order}");
}
